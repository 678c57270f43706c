"""The commands `calibrate` and `validate` as a user meets them: what cannot work is refused in one line before anything is simulated."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from patience import PATIENCE  # noqa: E402

COMMAND = os.environ["MILLSCOPE"]
CONFIGS = pathlib.Path(__file__).resolve().parents[2] / "configs"
STUDY = """base: %s
conditions:
  dry: {recording: r.yaml, role: fit}
parameters:
  pairs.glass~glass.static_friction: {range: [0.1, 0.8]}
budget: {simulations: 6}
""" % (CONFIGS / "chagas2015" / "slice_75.yaml")


class Calibrate(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)
        (self.folder / "study.yaml").write_text(STUDY)
        (self.folder / "r.csv").write_text("t,x,y,z\n" + "".join("%d,%d,%d,10\n" % (5 * i, i, -100 + i) for i in range(60)))
        (self.folder / "r.yaml").write_text("files: [r.csv]\ncondition: {mill_diameter: 460 mm, bead_diameter: 5 mm}\n")

    def refused(self, *words):
        done = subprocess.run([COMMAND, *words], cwd=self.folder, capture_output=True, text=True, timeout=PATIENCE)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertFalse((self.folder / "out").exists(), "nothing may be written")
        return done.stderr

    def test_a_recording_of_another_mill(self):
        said = self.refused("calibrate", "study.yaml", "-o", "out")
        self.assertIn("study.yaml:3: condition 'dry':", said)
        self.assertIn("a mill diameter of 460 mm", said)

    def test_an_unknown_parameter_by_set(self):
        (self.folder / "r.yaml").write_text("files: [r.csv]\n")
        said = self.refused("calibrate", "study.yaml", "-o", "out", "--set", "parameters.pairs.glass~glass.static_frction.range=[0.1, 0.8]")
        self.assertIn("unknown key 'static_frction'", said)
        self.assertIn("did you mean 'static_friction'?", said)

    def test_ranges_that_contradict(self):
        self.assertIn("is not below the upper one", self.refused("calibrate", "study.yaml", "-o", "out", "--set", "parameters.pairs.glass~glass.static_friction.range=[0.8, 0.1]"))

    def test_sections_of_diagnose_are_known_and_said_to_be_unused(self):
        (self.folder / "study.yaml").write_text(STUDY + "hypotheses: {rolling_resistance: {}}\nnuisances: {fill.filling: {range: [0.3, 0.4]}}\n")
        done = subprocess.run([COMMAND, "calibrate", "study.yaml", "-o", "out"], cwd=self.folder, capture_output=True, text=True, timeout=PATIENCE)
        self.assertIn("section 'hypotheses' is for diagnose and is not used here", done.stdout)
        self.assertIn("section 'nuisances' is for diagnose", done.stdout)
        self.assertIn("a mill diameter of 460 mm", done.stderr)

    def test_no_study_no_output_no_calibration(self):
        self.assertIn("no such file", self.refused("calibrate", "gone.yaml", "-o", "out"))
        self.assertIn("output", self.refused("calibrate", "study.yaml"))
        self.assertIn("gone.json: cannot be read", self.refused("validate", "study.yaml", "--calibration", "gone.json", "-o", "out"))


if __name__ == "__main__":
    unittest.main()
