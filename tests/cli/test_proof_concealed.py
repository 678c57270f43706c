"""tools/proof_concealed.py: which cases it simulates for a set of the proof, and what it draws."""

import contextlib
import io
import json
import os
import sys
import unittest
from pathlib import Path
from xml.etree import ElementTree

SOURCE = Path(os.environ.get("MILLSCOPE_SOURCE_DIR", Path(__file__).resolve().parents[2]))
sys.dont_write_bytecode = True
sys.path.insert(0, str(SOURCE / "tools"))
import proof_concealed as tool  # noqa: E402

NAMED = SOURCE / "docs/proof/a_long_2/set_016"  # a pool of 666.8 kg/m3; 576.3 were found


def named(folder):
    """The one effect of an opened set that is named; else None."""
    answer = json.loads((folder.parent / "answers" / (folder.name + ".json")).read_text())
    diagnosis = json.loads((folder / "diagnosis" / "diagnosis.json").read_text())
    effects = [effect["hypothesis"] for effect in answer["effects"]]
    return effects[0] if diagnosis["verdict"] == "named" and diagnosis["named"] == effects else None


class Cases(unittest.TestCase):
    def setUp(self):
        self.one = tool.Set(NAMED)

    def test_a_base_has_the_fitted_values_and_neither_effect_nor_numerics_of_the_truth(self):
        settings = self.one.settings_of("retuned to power")
        self.assertIn("pairs.glass~glass.static_friction=0.2354", settings)
        self.assertIn("stiffness_factor=0.002", settings)
        self.assertIn("time.end_s=21", settings)
        for part in ("fluid_pool", "contact.law.cap", "time.step_fraction", "=0.3236", "seed=910769103"):
            self.assertFalse([each for each in settings if part in each], part)

    def test_the_corrected_model_has_the_effect_at_the_strength_that_was_found(self):
        settings = self.one.settings_of("corrected")
        self.assertIn("body_forces.fluid_pool.kind=fluid_pool", settings)
        self.assertIn("body_forces.fluid_pool.fluid_density=576.3", settings)
        self.assertEqual(1, sum("fluid_density" in each for each in settings))

    def test_every_setting_of_an_effect_is_kept(self):
        rolling = tool.Set(next(folder for folder in sorted((SOURCE / "docs/proof/b_fresh_1").glob("set_*")) if named(folder) == "rolling_resistance"))
        settings = rolling.settings_of("corrected")
        self.assertTrue([each for each in settings if each.startswith("contact.interactions.") and ".kind=" in each])
        strengths = {each.split("=")[1] for each in settings if each.split("=")[0].endswith(".rolling_friction")}
        self.assertEqual(1, len(strengths))
        self.assertNotIn("%.4g" % rolling.effect["value"], strengths)
        for part in ("run.engine", "facet", "step_fraction"):  # numerics of the truth
            self.assertFalse([each for each in settings if part in each], part)

    def test_the_base_case_is_that_of_the_batch(self):
        self.assertEqual("light.yaml", tool.base_case("a_light_1").name)
        self.assertEqual("story.yaml", tool.base_case("b_fresh_5").name)

    def test_the_recording_is_as_long_as_it_was(self):
        self.assertEqual(20, self.one.seconds)

    def test_the_recording_has_as_many_beads_as_it_had(self):
        few = next(folder for folder in sorted((SOURCE / "docs/proof").glob("a_few_*/set_*")) if named(folder))
        self.assertEqual((60, 12), (self.one.beads, tool.Set(few).beads))

    def test_a_set_without_a_name_is_refused(self):
        with contextlib.redirect_stderr(io.StringIO()), self.assertRaisesRegex(SystemExit, "give a set that has"):
            tool.Set(SOURCE / "docs/proof/a_long_2/set_005")


class Drawing(unittest.TestCase):
    def test_past_6_o_clock_is_left_where_a_clockwise_mill_lifts_its_beads(self):
        corners = lambda words: [tuple(map(float, point.split(","))) for point in tool.sector(0, 0, tool.REGION.fullmatch(words)).split()]
        left, right = corners("0.8–1 R, 45–90° past 6 o'clock"), corners("0–0.5 R, 0–45° before 6 o'clock")
        self.assertTrue(all(x < 0 <= y + 1e-6 for x, y in left))
        self.assertTrue(all(x >= -1e-6 for x, _ in right))
        self.assertAlmostEqual(tool.RADIUS, max((x * x + y * y) ** 0.5 for x, y in left), 0)

    def test_colours_grow_with_the_difference(self):
        self.assertEqual("#ffffff", tool.colour(0))
        self.assertEqual(tool.colour(tool.FULL), tool.colour(3 * tool.FULL))
        self.assertNotEqual(tool.colour(5), tool.colour(-5))

    def test_a_picture_is_sound_xml_with_every_region(self):
        one = tool.Set(NAMED)
        row = {"where": "0–0.5 R, 0–45° before 6 o'clock", "a": "0.5", "difference": "0.1", "error": "0.02", "adjusted_p": "0.001"}
        found = {"observables": 119, "differ": 16, "regions": [row, dict(row, where="0.5–0.8 R, 90–135° past 6 o'clock", adjusted_p="0.4")]}
        root = ElementTree.fromstring(tool.picture(one, [("corrected", one.models["corrected"], found)]))
        words = [each.text for each in root.iter("{http://www.w3.org/2000/svg}text")]
        self.assertIn("16 of 119 quantities differ", words)
        self.assertEqual(2, len(list(root.iter("{http://www.w3.org/2000/svg}polygon"))))


if __name__ == "__main__":
    unittest.main()
