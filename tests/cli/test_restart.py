"""Stopped, killed, continued: always the run that was never interrupted."""
import os
import pathlib
import shutil
import signal
import time
import unittest

from support import PATIENCE, CliTest, tree_of

LONG = [("settle_s: 0.02", "settle_s: 0.05"), ("end_s: 0.1, analyze_from_s: 0.05", "end_s: 0.5, analyze_from_s: 0.1")]
INTERVAL = 0.1  # s of wall time between checkpoints


class Restart(CliTest):
    """All compare with one run that goes through."""

    @classmethod
    def setUpClass(cls):
        cls.kept = cls("make")
        cls.addClassCleanup(cls.kept.doCleanups)
        CliTest.setUp(cls.kept)
        cls.kept.write_case(*LONG)
        cls.kept.run_case("whole")

    def make(self):
        """Not a test: makes the object whose folder all tests of this class share."""

    def setUp(self):
        self.folder = self.kept.folder

    def interrupted(self, out, number, picture, *words):
        """A run that got `number` when its picture of that number appeared."""
        process = self.start("run", "case.yaml", "-o", out, *words)
        self.wait_for(f"{out}/vtk/beads_{picture:06d}.vtp", process)
        process.send_signal(number)
        _, err = process.communicate(timeout=PATIENCE)
        return process.returncode, err

    def test_a_signal_before_or_in_the_window_makes_a_checkpoint(self):
        for number, picture in ((signal.SIGINT, 2), (signal.SIGTERM, 9)):
            out = f"stopped-{number}"
            code, err = self.interrupted(out, number, picture)
            self.assertEqual(code, 3, err)
            self.assertIn(f"millscope resume {out}", err)
            self.assertFalse((self.folder / out / "summary.json").exists())
            resumed = self.resume(out)
            self.assert_same_run("whole", out)
            self.assertGreater(resumed["wall_s"], 0)

    def test_a_signal_while_settling(self):
        process = self.start("run", "case.yaml", "-o", "settling", "-q", "--set", "fill.settle_s=5")
        self.wait_for("settling/vtk", process)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=PATIENCE)
        self.assertEqual((process.returncode, out, err), (3, "", ""))
        self.assertTrue((self.folder / "settling/checkpoint.h5").exists())

    def test_stopped_twice(self):
        self.assertEqual(self.interrupted("twice", signal.SIGINT, 3)[0], 3)
        process = self.start("resume", "twice")
        self.wait_for("twice/vtk/beads_000007.vtp", process)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 3)
        self.resume("twice", "--threads", 2)
        self.assert_same_run("whole", "twice")

    def test_kill_loses_at_most_one_interval(self):
        settings = ("--quiet", "--set", f"output.checkpoint.every_wall_s={INTERVAL}")
        process = self.start("run", "case.yaml", "-o", "killed", *settings)
        checkpoint = self.folder / "killed/checkpoint.h5"
        self.wait_for("killed/checkpoint.h5", process)
        self.wait_for("killed/vtk/beads_000006.vtp", process)
        process.send_signal(signal.SIGKILL)
        killed_at = time.time()
        process.wait(60)
        self.assertLess(killed_at - checkpoint.stat().st_mtime, INTERVAL + 2)  # the machine may be busy
        self.resume("killed")
        self.assert_same_run("whole", "killed")

    def test_kill_without_a_checkpoint_says_what_to_do(self):
        process = self.start("run", "case.yaml", "-o", "bare", "-q", "--set", "output.checkpoint=off")
        self.wait_for("bare/vtk/beads_000001.vtp", process)
        process.kill()
        process.wait(60)
        self.assert_one_line(self.millscope("resume", "bare"), "no checkpoint", "start the run")
        self.run_case("bare", "--force")
        self.assert_same_run("whole", "bare")

    def test_a_second_run_in_the_same_place_is_refused(self):
        process = self.start("run", "case.yaml", "-o", "shared", "-q", "--set", "time.end_s=5")
        self.wait_for("shared/vtk/beads_000001.vtp", process)
        self.assert_one_line(self.millscope("run", "case.yaml", "-o", "shared", "--force"), "another run is writing there")
        process.send_signal(signal.SIGINT)
        process.wait(60)
        self.assertEqual(process.returncode, 3)

    def test_a_finished_run_goes_on_to_a_later_end(self):
        self.run_case("later", "--set", "time.end_s=0.2")
        self.resume("later", "--set", "time.end_s=0.5")
        self.assert_same_run("whole", "later")

    def test_a_new_window(self):
        self.run_case("window", "--set", "time.analyze_from_s=0.2")
        self.run_case("moved", "--set", "time.end_s=0.15")
        self.resume("moved", "--set", "time.end_s=0.5", "--set", "time.analyze_from_s=0.2")
        for key in ("power_W", "com_m", "state_hash", "window_s", "pairs"):
            self.assertEqual(self.summary("moved")[key], self.summary("window")[key])
        before = tree_of(self.folder / "moved")
        self.assert_one_line(self.millscope("resume", "moved", "--set", "time.end_s=0.6", "--set", "time.analyze_from_s=0.3"), "samples are gone")
        self.assertEqual(before, tree_of(self.folder / "moved"))

    def test_a_run_cut_off_before_its_summary_gets_one(self):
        shutil.copytree(self.folder / "whole", self.folder / "nosummary")
        os.remove(self.folder / "nosummary/summary.json")
        self.resume("nosummary")
        self.assert_same_run("whole", "nosummary")

    def test_an_unfinished_continuation_has_no_summary(self):
        shutil.copytree(self.folder / "whole", self.folder / "open")
        process = self.start("resume", "open", "-q", "--set", "time.end_s=5")
        self.wait_for("open/vtk/beads_000026.vtp", process)
        process.send_signal(signal.SIGINT)
        process.wait(60)
        self.assertFalse((self.folder / "open/summary.json").exists())


class Refused(Restart):
    """Resumes that must not be, on copies of the finished run."""

    def copy(self, name):
        shutil.copytree(self.folder / "whole", self.folder / name)
        return self.folder / name

    def refuse(self, out, words, *parts):
        before = tree_of(self.folder / out)
        self.assert_one_line(self.millscope("resume", out, *words), *parts)
        self.assertEqual(before, tree_of(self.folder / out))

    def test_the_end_has_been_reached(self):
        self.refuse("whole", (), "reached its end", "--set time.end_s=")
        self.refuse("whole", ("--set", "time.end_s=0.25"), "reached its end")
        self.refuse("whole", ("--set", "time.end_s=0.05"), "analyze_from_s")

    def test_other_physics(self):
        for change in ("pairs.default.restitution=0.3", "mill.speed=10", "stiffness_factor=0.001", "fill.filling=0.2", "time.step_fraction=0.1", "seed=2"):
            self.refuse("whole", ("--set", "time.end_s=0.6", "--set", change), "would change the run", "start a new run")

    def test_an_edited_case(self):
        case = self.copy("edited") / "case.resolved.yaml"
        case.write_text(case.read_text().replace("restitution: 0.6", "restitution: 0.5"))
        self.refuse("edited", ("--set", "time.end_s=0.6"), r"case\.resolved\.yaml", "put it back")

    def test_missing_parts(self):
        for part, remedy in (("case.resolved.yaml", "no such file"), ("series.csv", "put it back"), ("frames.h5", "frames.h5"), ("tracks.h5", "tracks.h5")):
            out = self.copy("without-" + part)
            os.remove(out / part)
            result = self.millscope("resume", out.name, "--set", "time.end_s=0.6")
            self.assertIn(result.returncode, (2, 4), result.stderr)
            self.assertRegex(self.assert_one_line(result, code=result.returncode), part)
            self.assertRegex(result.stderr, remedy)

    def test_no_run(self):
        (self.folder / "empty").mkdir(exist_ok=True)
        self.refuse("empty", (), "no checkpoint", "millscope run")
        self.assert_one_line(self.millscope("resume", "nowhere"), "no such directory", "-o")
        self.assert_one_line(self.millscope("resume", "case.yaml"), "no such directory")

    def test_damaged_checkpoints(self):
        def cut(data):
            return data[:len(data) // 2]

        def flip(data):
            return data[:5000] + bytes([data[5000] ^ 1]) + data[5001:]

        for k, damage in enumerate((cut, flip, lambda data: b"", lambda data: b"x" * 4096)):
            out = self.copy(f"damaged-{k}")
            newest = out / "checkpoint.h5"
            newest.write_bytes(damage(newest.read_bytes()))
            self.refuse(out.name, ("--set", "time.end_s=0.6"), r"checkpoint\.h5", "start the run again")

    def test_the_checkpoint_before_a_damaged_one_is_used(self):
        _, err = self.interrupted("fallback", signal.SIGINT, 9, "--set", "output.checkpoint.every_wall_s=0.02")
        newest, previous = self.folder / "fallback/checkpoint.h5", self.folder / "fallback/checkpoint.previous.h5"
        self.assertTrue(previous.exists(), err)
        newest.write_bytes(newest.read_bytes()[:-100])
        result = self.succeed("resume", "fallback")
        self.assertIn("is damaged; continuing from the one before it", result.stderr)
        self.assert_same_run("whole", "fallback")

    def test_both_damaged(self):
        out = self.copy("both")
        for name in ("checkpoint.h5", "checkpoint.previous.h5"):
            (out / name).write_bytes(b"no")
        self.refuse("both", (), "neither", "start the run again")


# The tests of Restart run once, not again under Refused.
for name in [n for n in vars(Restart) if n.startswith("test_")]:
    if name not in vars(Refused):
        setattr(Refused, name, None)

if __name__ == "__main__":
    unittest.main()
