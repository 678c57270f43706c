"""`millscope run --engine liggghts`: another engine moves the beads, the files are those of a run; and what is said where it does not."""
import json
import os
import re
import shutil
import signal
import subprocess
import time
import unittest

from support import COMMAND, PATIENCE, CliTest, Hdf5, files_below, tree_of

SHORT = ["--set", "fill.settle_s=0.01", "--set", "time={end_s: 0.15, analyze_from_s: 0.05}", "--set", "output.frames={every_s: 0.02, from_s: 0.05}"]


class Made(CliTest):
    """An engine that is a few lines of shell, found before any that is installed."""

    def engine(self, text, name="liggghts", version="3.8.0"):
        folder = self.folder / "bin"
        folder.mkdir(exist_ok=True)
        greeting = "case $1 in -h|--version) echo 'LIGGGHTS (Version LIGGGHTS-PUBLIC %s)'; exit;; esac\n" % version
        (folder / name).write_text("#!/bin/sh\n" + greeting + text)
        (folder / name).chmod(0o755)
        self.addCleanup(os.environ.__setitem__, "PATH", os.environ["PATH"])
        os.environ["PATH"] = "%s:%s" % (folder, os.environ["PATH"])

    def refused(self, *parts, words=()):
        done = self.millscope("run", "case.yaml", "-o", "out", "-q", "--engine", "liggghts", *words, *SHORT)
        self.assert_one_line(done, *parts)
        return done

    def test_lost_beads(self):
        self.engine("echo 'ERROR: Lost atoms: original 324 current 323 (thermo.cpp:438)' >> log.liggghts; exit 1\n")
        self.refused("engine/log.liggghts: ERROR: Lost atoms: original 324 current 323", "take a smaller time step")

    def test_a_rank_that_is_killed(self):
        self.engine("printf '    Step  Time  Atoms  KinEng\\n     200 0.01 324 0.1\\n' > log.liggghts; kill -9 $$\n")
        self.refused("ended by signal 9 after step [0-9]+ of [0-9]+", "messages.txt")
        self.engine("echo 'mpirun noticed that process rank 1 exited on signal 9'; exit 137\n", "mpirun")
        self.refused("ended with code 137", words=["--ranks", "2", "--force"])

    def test_an_engine_that_leaves_nothing(self):
        self.engine("exit 0\n")
        self.refused("ended with code 0 after step 0 of [0-9]+")
        self.assertFalse((self.folder / "out/summary.json").exists())

    def test_a_full_disk(self):
        small = self.folder / "small"
        small.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", str(small)], capture_output=True).returncode != 0:
            self.skipTest("no small disk can be made here")
        self.addCleanup(subprocess.run, ["umount", "-l", str(small)])
        told = "printf '    Step  Time  Atoms  KinEng\\n     200 0.01 324 0.1\\n' > log.liggghts; "
        self.engine(told + "echo whole > post/restart.100; echo cut > post/restart.200; cat /dev/zero > post/frame_0.txt 2> /dev/null; : > post/restart.300; exit 0\n")
        done = self.millscope("run", "case.yaml", "-o", "small/out", "-q", "--engine", "liggghts", *SHORT)
        self.assert_one_line(done, "small/out/engine: the disk is full; make room", code=4)
        self.assertEqual(sorted(file.name for file in (small / "out/engine/post").glob("restart.*")), ["restart.100"])

    def test_none_is_installed(self):
        self.addCleanup(os.environ.__setitem__, "PATH", os.environ["PATH"])
        os.environ["PATH"] = str(self.folder)
        self.refused("liggghts: not found on this machine", "apt install liggghts")
        self.assertFalse((self.folder / "out").exists())

    def test_another_version(self):
        self.engine("exit 0\n", version="2.3.2")
        self.refused("LIGGGHTS-PUBLIC 2.3.2", "3.8 is needed")
        self.assertFalse((self.folder / "out").exists())

    def test_ctrl_c_stops_it_too(self):
        self.engine("echo $$ > pid; exec sleep 1000\n")
        run = subprocess.Popen([COMMAND, "run", "case.yaml", "-o", "out", "--engine", "liggghts", *SHORT], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        started = time.monotonic()
        pid = self.folder / "out/engine/pid"
        while not (pid.exists() and pid.read_text().strip()) and time.monotonic() - started < PATIENCE:
            time.sleep(0.05)
        run.send_signal(signal.SIGINT)
        self.assertIn("continue with: millscope resume out", run.communicate(timeout=PATIENCE)[1])
        self.assertEqual(run.returncode, 3)
        with self.assertRaises(ProcessLookupError):
            os.kill(int(pid.read_text()), 0)
        self.assertFalse((self.folder / "out/summary.json").exists())

    def test_words_that_do_not_go_together(self):
        for words, part in ((["--ranks", "2"], "is for another engine; add 'engine: liggghts'"), (["--engine", "liggghts", "--threads", "2"], "--threads is for runs of millscope"),
                            (["--engine", "liggghts", "--ranks", "0"], "run.ranks")):
            self.assert_one_line(self.millscope("run", "case.yaml", "-o", "out", *words), part)
        self.refused("cap is 'sum'", words=["--set", "contact.law.cap=sum"])
        self.assertFalse((self.folder / "out").exists())

    def test_an_earlier_run_stays_where_the_new_one_is_refused(self):
        self.engine("exit 0\n")
        self.refused("ended with code 0")
        for words in (["output.tracks={beads: 9999}"], ["fill.filling=99 %"], ["contact.law.cap=sum"]):
            self.assertEqual(self.millscope("run", "case.yaml", "-o", "out", "--force", "-q", "--engine", "liggghts", "--set", *words).returncode, 2)
            self.assertTrue((self.folder / "out/engine/messages.txt").exists())


@unittest.skipUnless(shutil.which("liggghts"), "liggghts is not installed")
class Real(CliTest):
    def test_the_files_of_a_run(self):
        done = self.succeed("run", "case.yaml", "-o", "out", "--engine", "liggghts", *SHORT)
        self.assertIn("done; see out/summary.json", done.stdout)
        self.assertFalse((self.folder / "log.liggghts").exists())  # what is asked of the engine leaves nothing behind
        self.assertEqual(sorted(n for n in tree_of(self.folder / "out") if "/" not in n), ["case.resolved.yaml", "engine", "frames.h5", "series.csv", "summary.json", "tracks.h5", "vtk"])
        self.run_case("ours", *SHORT)
        for name in ("beads.pvd", "mesh.pvd"):  # the same instants, the walls at the same places
            self.assertEqual((self.folder / "out/vtk" / name).read_text(), (self.folder / "ours/vtk" / name).read_text())
        points = [re.search(rb'<AppendedData encoding="raw">\s*_(.*)', (self.folder / run / "vtk/liner_000007.vtp").read_bytes(), re.S).group(1) for run in ("out", "ours")]
        self.assertIn(points[0][1608:2000], points[1])
        summary = self.summary("out")
        self.assertIn("3.8", summary["engine"]["version"])
        self.assertEqual(summary["engine"]["ranks"], 1)
        self.assertGreater(summary["power_W"]["torque"], 0)
        self.assertGreater(summary["wall_s"], 0)
        self.succeed("report", "out", "-o", "page.html")
        page = (self.folder / "page.html").read_text()
        data = json.loads(re.search(r'<script type="application/json" id="millscope-data">(.*?)</script>', page, re.S).group(1))
        self.assertEqual([s["kind"] for s in data["sections"]], ["run"])  # the engine's folder is no second one
        self.assertEqual(data["sections"][0]["summary"]["engine"]["name"], "liggghts")
        self.assert_one_line(self.millscope("run", "case.yaml", "-o", "out", "--engine", "liggghts"), "is not empty and is not overwritten")
        self.succeed("run", "case.yaml", "-o", "out", "--force", "-q", "--engine", "liggghts", *SHORT)

    def test_a_killed_run_goes_on(self):
        words = ["--set", "fill.settle_s=0.01", "--set", "time={end_s: 0.6, analyze_from_s: 0.1}", "--set", "output.frames={every_s: 0.05, from_s: 0.1}"]
        post = self.folder / "out/engine/post"
        self.killed(["run", "case.yaml", "-o", "out", "-q", "--engine", "liggghts", *words], lambda: len(files_below(post, "restart.*")) > 1)
        self.assertFalse((self.folder / "out/summary.json").exists())
        self.assert_one_line(self.millscope("resume", "out", "--set", "time.end_s=9"), "leave --set out")
        self.assert_one_line(self.millscope("resume", "out", "--threads", "2"), "--threads is for runs of millscope")
        self.succeed("resume", "out", "-q")
        summary = self.summary("out")
        self.assertAlmostEqual(summary["simulated_s"], 0.6, delta=0.02)
        self.assertEqual(len(list(post.glob("series*.txt"))), 2)
        times = [float(line.split(",")[0]) for line in (self.folder / "out/series.csv").read_text().splitlines()[1:]]
        steps = [b - a for a, b in zip(times, times[1:])]
        self.assertLess(max(steps) - min(steps), 1e-9)
        with Hdf5(self.folder / "out/tracks.h5") as f:
            t = f.read(f.names()[0] + "/t")
            self.assertTrue(all(0 < b - a < 0.0011 for a, b in zip(t, t[1:])))
        self.assert_one_line(self.millscope("resume", "out"), "is finished")
        self.assertEqual(len(summary["engine"]["resumed_at_s"]), 1)

    def test_a_campaigns_task_goes_on(self):
        self.write("tasks.yaml", "schema_version: 1\ncase: case.yaml\nsimulations:\n  one: {set: [run.engine=liggghts, fill.settle_s=0.01, "
                                 "time.end_s=0.6, time.analyze_from_s=0.1, output.frames=~]}\n")
        runs = lambda pattern: files_below(self.folder / "out", pattern)  # noqa: E731
        self.killed(["campaign", "tasks.yaml", "-o", "out", "-q"], lambda: len(runs("restart.*")) > 1)
        self.succeed("campaign", "tasks.yaml", "-o", "out", "-q")
        self.assertEqual(len(runs("series.*.txt")), 1)
        self.assertEqual(len(runs("summary.json")), 1)

    def killed(self, words, ready):
        """A run whose millscope and engine are killed as soon as `ready` holds."""
        run = subprocess.Popen([COMMAND, *words], cwd=self.folder)
        started = time.monotonic()
        try:
            while not ready() and run.poll() is None and time.monotonic() - started < PATIENCE:
                time.sleep(0.005)
        finally:
            run.kill()
            run.wait()
        time.sleep(0.5)  # the engine hears of it

    def test_killed_while_settling_and_again_after_the_resume(self):
        words = ["--set", "fill.settle_s=0.3", "--set", "time={end_s: 0.3, analyze_from_s: 0.1}", "--set", "output.frames=~"]
        post = self.folder / "out/engine/post"
        self.killed(["run", "case.yaml", "-o", "out", "-q", "--engine", "liggghts", *words], lambda: len(files_below(post, "restart.*")) > 1)
        self.killed(["resume", "out", "-q"], lambda: any(f.stat().st_size > 500 for f in files_below(post, "series.*.txt")))
        self.succeed("resume", "out", "-q")
        with Hdf5(self.folder / "out/tracks.h5") as f:
            t = f.read(f.names()[0] + "/t")
        self.assertAlmostEqual(t[0], 0, places=9)
        self.assertLess(max(b - a for a, b in zip(t, t[1:])) - min(b - a for a, b in zip(t, t[1:])), 1e-9)
        self.assertAlmostEqual(t[-1], 0.3, delta=0.002)

    def test_stopped_from_outside(self):
        words = ["--set", "fill.settle_s=0.01", "--set", "time={end_s: 5, analyze_from_s: 0.1}", "--set", "output.frames=~"]
        for delay in (0.1, 0.6):  # while it prepares, while the engine runs
            shutil.rmtree(self.folder / "out", ignore_errors=True)
            run = subprocess.Popen([COMMAND, "run", "case.yaml", "-o", "out", "-q", "--engine", "liggghts", *words], cwd=self.folder)
            time.sleep(delay)
            run.send_signal(signal.SIGINT)
            self.assertEqual(run.wait(PATIENCE), 3)
            self.assertFalse((self.folder / "out/summary.json").exists())

    @unittest.skipUnless(shutil.which("mpirun"), "mpirun is not installed")
    def test_two_ranks(self):
        wide = ["--set", "geometry.liner.length=52 mm", "--set", "fill.vessel.length=52 mm", "--set", "domain.periodic.z=[0, 52 mm]"]
        wide += ["--set", "beads.glass8.diameter=6 mm"]
        for ranks in ("1", "2"):
            self.succeed("run", "case.yaml", "-o", "out" + ranks, "-q", "--engine", "liggghts", "--ranks", ranks, *wide, *SHORT)
        one, two = self.summary("out1"), self.summary("out2")
        self.assertEqual(two["engine"]["ranks"], 2)
        self.assertIn("1 by 1 by 2 MPI processor grid", (self.folder / "out2/engine/log.liggghts").read_text())
        self.assertAlmostEqual(one["kinetic_energy_J"], two["kinetic_energy_J"], delta=0.1 * one["kinetic_energy_J"])


if __name__ == "__main__":
    unittest.main()
