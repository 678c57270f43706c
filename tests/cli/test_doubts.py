"""A run says what there is to doubt of it: each doubt provoked by a case, and none in a sound one."""
import unittest

from support import CliTest

SOUND = ["fill.filling=8 %", "stiffness_factor=0.01", "time.analyze_from_s=0.8", "time.end_s=2.4", "output.vtk=~", "output.frames=~", "output.tracks=~"]


class Doubts(CliTest):
    def doubts(self, *settings):
        """By name, of a run of the sound case with other settings; and what the terminal said."""
        words = [word for setting in (*SOUND, *settings) for word in ("--set", setting)]
        said = self.succeed("run", "case.yaml", "-o", "out", "--force", *words).stdout
        found = self.summary("out")["doubts"]
        lines = [line for line in said.splitlines() if line.startswith("doubt: ")]
        self.assertEqual(lines, [f"doubt: {d['finding']}; {d['may_change']}; {d['remedy']}" for d in found])
        for line in lines:
            self.assertLess(len(line), 240, line)
        return {d["name"]: d for d in found}

    def test_a_sound_run_says_nothing(self):
        self.assertEqual(self.doubts(), {})

    def test_soft_beads(self):
        found = self.doubts("stiffness_factor=0.00002", "time.step_fraction=10 %")
        self.assertEqual(list(found), ["overlap"])
        pairs = {pair["pair"]: pair["largest_overlap_of_effective_radius"] for pair in self.summary("out")["pairs"]}
        self.assertEqual(found["overlap"]["of"], "glass~hdpe (wall)")
        self.assertEqual(found["overlap"]["value"], pairs["glass~hdpe (wall)"])
        self.assertGreater(found["overlap"]["value"], 0.3)
        self.assertRegex(found["overlap"]["remedy"], r"^raise stiffness_factor to 0\.0\d+, at about \d+ times the time$")

    def test_a_coarse_step(self):
        found = self.doubts("time.step_fraction=55 %", "run.allow_unstable=true")
        self.assertEqual(list(found), ["contact_steps"])
        self.assertEqual(found["contact_steps"]["value"], self.summary("out")["contact"]["steps_per_shortest_contact"])
        self.assertLess(found["contact_steps"]["value"], 10)

    def test_a_short_window(self):
        found = self.doubts("time.end_s=1.7")
        self.assertEqual(list(found), ["short_window"])
        self.assertAlmostEqual(found["short_window"]["value"], 0.9 * self.summary("out")["mill_speed_rad_per_s"] / 6.2832, 2)

    def test_a_window_without_means(self):
        found = self.doubts("time.end_s=0.805")
        self.assertEqual(found["short_window"]["value"], 0)
        self.assertEqual(found["short_window"]["finding"], "the analysis window is too short for any mean")

    def test_a_mill_at_rest(self):
        self.assertEqual(self.doubts("geometry.liner.motion=~", "mill=~", "time.end_s=1.2"), {})

    def test_a_mill_that_gathers_speed(self):
        found = self.doubts("geometry.liner.motion={rotation: {speed: mill, ramp_s: 2.4}}")
        self.assertEqual(list(found), ["not_steady"])
        self.assertGreater(found["not_steady"]["value"], 3)
        self.assertFalse(self.summary("out")["steady"])

    def test_narrow_gaps(self):
        found = self.doubts("geometry.liner.lifters=19")
        self.assertEqual(list(found), ["lifter_gap"])
        self.assertEqual(found["lifter_gap"]["of"], "liner")
        self.assertGreater(found["lifter_gap"]["value"], 0.5)

    def test_quiet(self):
        self.assertEqual(self.succeed("run", "case.yaml", "-o", "quiet", "--quiet").stdout, "")
        self.assertIn("short_window", [d["name"] for d in self.summary("quiet")["doubts"]])


if __name__ == "__main__":
    unittest.main()
