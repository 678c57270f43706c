"""The command `diagnose` as a user meets it: what cannot work is refused in one line before anything is simulated or written."""
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
  pairs.glass~glass.static_friction: {range: [0.1, 0.6]}
nuisances:
  fill.filling: {range: [30.4 %%, 32.2 %%], sigma: 0.3 %%}
hypotheses:
  rolling_resistance: {}
""" % (CONFIGS / "mill10" / "case.yaml")


class Diagnose(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)
        (self.folder / "study.yaml").write_text(STUDY)
        (self.folder / "r.csv").write_text("t,x,y,z\n" + "".join("%d,%d,%d,10\n" % (5 * i, i, -100 + i) for i in range(60)))
        (self.folder / "r.yaml").write_text("files: [r.csv]\ncondition: {mill_diameter: 300 mm, bead_diameter: 10 mm}\n")

    def call(self, *words):
        return subprocess.run([COMMAND, *words], cwd=self.folder, capture_output=True, text=True, timeout=PATIENCE)

    def refused(self, *words):
        done = self.call("diagnose", *words)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertFalse((self.folder / "out").exists(), "nothing may be written")
        return done.stderr

    def test_help_has_an_example(self):
        done = self.call("diagnose", "--help")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("millscope diagnose configs/mill10/diagnose.yaml -o diagnosis", done.stdout)
        self.assertIn("--draws", done.stdout)
        self.assertTrue((CONFIGS / "mill10" / "diagnose.yaml").exists())

    def test_no_study_no_output(self):
        self.assertIn("no such file", self.refused("gone.yaml", "-o", "out"))
        self.assertIn("--output is missing", self.refused("study.yaml"))
        self.assertIn("STUDY.yaml is missing", self.refused("-o", "out"))

    def test_a_recording_that_is_not_there(self):
        (self.folder / "r.yaml").unlink()
        self.assertIn("study.yaml:3: 'conditions.dry.recording' is 'r.yaml': no such file", self.refused("study.yaml", "-o", "out"))

    def test_a_recording_of_another_mill(self):
        (self.folder / "r.yaml").write_text("files: [r.csv]\ncondition: {mill_diameter: 460 mm, bead_diameter: 10 mm}\n")
        self.assertIn("a mill diameter of 460 mm", self.refused("study.yaml", "-o", "out"))

    def test_an_unknown_hypothesis(self):
        (self.folder / "study.yaml").write_text(STUDY.replace("rolling_resistance", "roling_resistance"))
        said = self.refused("study.yaml", "-o", "out")
        self.assertIn("study.yaml:9: 'hypotheses.roling_resistance' is no hypothesis of a loaded plugin; known: ", said)
        self.assertIn("rolling_resistance", said)

    def test_a_nuisance_that_is_known_exactly(self):
        said = self.refused("study.yaml", "-o", "out", "--set", "nuisances.fill.filling.sigma=0")
        self.assertIn("'nuisances.fill.filling.sigma' is not above 0; leave out what is known exactly", said)

    def test_a_range_that_does_not_hold_the_null(self):
        said = self.refused("study.yaml", "-o", "out", "--set", "hypotheses.rolling_resistance.range=[0.05, 0.2]")
        self.assertIn("does not hold 0, where it vanishes", said)

    def test_too_few_draws_and_slots(self):
        self.assertIn("--draws 10: give 100 or more", self.refused("study.yaml", "-o", "out", "--draws", "10"))
        self.assertIn("--slots 0: give 1 or more", self.refused("study.yaml", "-o", "out", "--slots", "0"))


if __name__ == "__main__":
    unittest.main()
