"""A whole calibration of the story's small mill: killed at any moment it ends with the same answer, on Slurm too."""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1]), str(pathlib.Path(__file__).resolve().parents[1] / "campaign")]
import slurm_machine  # noqa: E402
from patience import PATIENCE, files_below  # noqa: E402

COMMAND = os.environ["MILLSCOPE"]
CONFIGS = pathlib.Path(__file__).resolve().parents[2] / "configs"
STORY = CONFIGS / "story"
SHORT = "{mill.speed: 75 %critical, stiffness_factor: 0.0002, time.end_s: 1.5, time.analyze_from_s: 0.5}"
LACKING = slurm_machine.lacking()


class Campaign(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.folder = pathlib.Path(cls.scratch.name)
        cls.run_command("run", STORY / "mill.yaml", "-o", "mill", "-q", "--set", "stiffness_factor=0.0003", "--set", "time={end_s: 3, analyze_from_s: 1}",
                        "--set", "output.tracks={beads: 40, every_s: 0.0005}")
        cls.run_command("pept", "synthesize", "mill", "-o", "r75.a", "--camera", CONFIGS / "cameras" / "study.yaml")
        (cls.folder / "study.yaml").write_text(
            f"base: {STORY / 'mill.yaml'}\n"
            f"conditions:\n  dry: {{set: {SHORT}, recording: r75.yaml, role: fit}}\n"
            "parameters:\n  pairs.glass~glass.static_friction: {name: bead_friction, range: [0.1, 0.8]}\n"
            "method: emulator\nobjective: chagas2015\nbudget: {simulations: 6}\nobserve: {beads: 40}\n")
        cls.run_command(*cls.calibrate("whole"))
        cls.expected = cls.answer("whole")

    @classmethod
    def calibrate(cls, name):
        return ("calibrate", "study.yaml", "-o", name, "--cache", name + "-cache")

    @classmethod
    def run_command(cls, *words, **options):
        done = subprocess.run([COMMAND, *map(str, words)], cwd=cls.folder, capture_output=True, text=True, timeout=PATIENCE, **options)
        assert done.returncode == 0, done.stderr
        return done

    @classmethod
    def answer(cls, name):
        return json.loads((cls.folder / name / "calibration.json").read_text())

    def finished(self, name):
        return len(files_below(self.folder / (name + "-cache"), "run/summary.json"))

    def test_it_is_a_calibration(self):
        self.assertIn(self.expected["simulations"], (5, 6))  # it may stop before the budget ends where nothing is left to gain
        self.assertEqual(self.expected["failed"], [])
        self.assertTrue(0.1 <= self.expected["parameters"][0]["value"] <= 0.8)

    def test_killed_at_any_moment(self):
        name = "killed"
        for wanted in (0, 2, 4):  # so many simulations are done when it is killed
            process = subprocess.Popen([COMMAND, *self.calibrate(name)], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
            end = time.monotonic() + PATIENCE
            while self.finished(name) < wanted and process.poll() is None and time.monotonic() < end:
                time.sleep(0.02)
            time.sleep(0.4)
            self.assertIsNone(process.poll(), "it was over before it could be killed")
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            self.assertFalse((self.folder / name / "calibration.json").exists())
        self.run_command(*self.calibrate(name))
        self.assertEqual(self.answer(name), self.expected)

    @unittest.skipIf(LACKING, LACKING)
    def test_on_slurm(self):
        machine = slurm_machine.SlurmMachine()
        self.addCleanup(machine.stop)
        self.run_command(*self.calibrate("slurm"), "--runner", "slurm", env=machine.environment)
        self.assertEqual(self.answer("slurm"), self.expected)
        self.assertTrue(list((self.folder / "slurm-cache" / "slurm").glob("*")), "no batch was handed to Slurm")


if __name__ == "__main__":
    unittest.main()
