"""What goes wrong while a run goes on: full disks, explosions."""
import os
import subprocess
import unittest

from support import PATIENCE, CliTest, tree_of

UNSTABLE = ("--set", "time.step_fraction=1", "--set", "run.allow_unstable=true")


class Explosion(CliTest):
    def test_it_names_time_bead_and_cause(self):
        result = self.millscope("run", "case.yaml", "-o", "out", "-q", *UNSTABLE, "--set", "time.end_s=5")
        self.assert_one_line(result, r"at t = \S+ s bead \d+", r"centre \(.*\) m, velocity \(.*\) m/s", "time step too long", "lower time.step_fraction",
                             "no checkpoint had been written to out")
        self.assertFalse((self.folder / "out/checkpoint.h5").exists())
        self.assertFalse((self.folder / "out/summary.json").exists())
        self.assert_one_line(self.millscope("resume", "out"), "no checkpoint")

    def test_a_step_too_long_for_the_damping_is_halved_before_the_analysis_begins(self):
        words = ("run", "case.yaml", "-q", "--set", "pairs.default.restitution=0.02", "--set", "pairs.default.static_friction=0.8", "--set", "fill.settle_s=0.2")
        result = self.succeed(*words, "-o", "out")
        self.assertIn("Starting again with half the time step: time.step_fraction=0.1", result.stderr)
        halvings = result.stderr.count("Starting again")
        self.assertAlmostEqual(self.summary("out")["dt_rayleigh_fraction"], 0.2 / 2**halvings, 9)
        self.assertIn("step_fraction: %g" % (0.2 / 2**halvings), (self.folder / "out/case.resolved.yaml").read_text())
        self.assertEqual(self.succeed(*words, "-o", "again").stderr.count("Starting again"), halvings)
        self.assertEqual(self.summary("again")["state_hash"], self.summary("out")["state_hash"])
        known = self.millscope(*words, "-o", "known", "--set", "run.allow_unstable=true")
        self.assert_one_line(known, "moved more than half its radius")

    def test_the_last_checkpoint_is_kept(self):
        """A sound run until the first bead is lifted out of the domain."""
        self.write_case(("periodic: {z: [0, 26 mm]}", "periodic: {z: [0, 26 mm]}\n  high: {y: 20 mm}"))
        result = self.millscope("run", "case.yaml", "-o", "lost", "-q", "--set", "output.checkpoint.every_wall_s=0.001", "--set", "time.end_s=5")
        self.assert_one_line(result, r"bead \d+ has left the domain", r"the checkpoint at \S+ s is kept in lost")
        self.assertFalse((self.folder / "lost/summary.json").exists())
        self.assert_one_line(self.millscope("resume", "lost", "-q"), r"bead \d+ has left the domain", "kept in lost")

    def test_beads_outside_from_the_start(self):
        result = self.millscope("run", "case.yaml", "-o", "out", "-q", "--set", "domain.high={y: -60 mm}")
        self.assert_one_line(result, "domain|fit")
        self.assertFalse((self.folder / "out").exists())


@unittest.skipUnless(os.geteuid() == 0, "only root can make a small disk to fill")
class FullDisk(CliTest):
    def disk(self, size):
        place = self.folder / "disk"
        place.mkdir()
        made = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(place)], capture_output=True, text=True, check=False)
        if made.returncode != 0:
            self.skipTest("mount is not allowed here: " + made.stderr.strip())
        self.addCleanup(subprocess.run, ["umount", "-l", str(place)], check=False)
        return place

    def test_too_small_from_the_start(self):
        place = self.disk("1m")
        self.assert_one_line(self.millscope("run", "case.yaml", "-o", "disk/out"), "the run will write about", "make room", code=4)
        self.assertEqual(tree_of(place), {})

    def test_read_only(self):
        place = self.disk("20m")
        subprocess.run(["mount", "-o", "remount,ro", str(place)], check=True)
        self.assert_one_line(self.millscope("run", "case.yaml", "-o", "disk/out"), "disk/out", "cannot be written", "-o", code=4)
        self.assertEqual(tree_of(place), {})

    def test_full_in_the_run_and_resumed(self):
        self.write_case(("end_s: 0.1, analyze_from_s: 0.05", "end_s: 0.3, analyze_from_s: 0.1"))
        self.run_case("whole")
        place = self.disk("12m")
        process = self.start("run", "case.yaml", "-o", "disk/out", "-q", "--set", "output.checkpoint.every_wall_s=0.05")
        self.wait_for("disk/out/checkpoint.h5", process)
        self.wait_for("disk/out/vtk/beads_000004.vtp", process)
        with open(place / "ballast", "wb", buffering=0) as ballast:
            try:
                while True:
                    ballast.write(b"x" * 4096)
            except OSError:
                pass
        out, err = process.communicate(timeout=PATIENCE)
        result = subprocess.CompletedProcess("run", process.returncode, out, err)
        self.assert_one_line(result, "the disk is full", "the last checkpoint is intact", "make room, then 'millscope resume disk/out'", code=4)
        self.assertEqual([p for p in tree_of(place) if p.endswith(".tmp")], [])
        self.assertFalse((place / "out/summary.json").exists())
        os.remove(place / "ballast")
        self.resume("disk/out")
        self.assert_same_run("whole", "disk/out")

    def test_an_estimate_beyond_the_disk(self):
        place = self.disk("20m")
        result = self.millscope("run", "case.yaml", "-o", "disk/out", "--set", "output.vtk.every_s=1e-5")
        self.assert_one_line(result, r"will write about [\d.]+ [kMG]B", "write less often", code=4)
        self.assertEqual(tree_of(place), {})

    def test_full_before_the_first_step(self):
        """There is room when the run asks for it, and no inode when it makes its files."""
        place = self.disk("20m,nr_inodes=4")
        self.assert_one_line(self.millscope("run", "case.yaml", "-o", "disk/out"), "disk", code=4)
        self.assertEqual(tree_of(place), {})


if __name__ == "__main__":
    unittest.main()
