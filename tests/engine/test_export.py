"""`millscope export`, `import` and `check --engine`: what LIGGGHTS gets, what it is refused, that it moves the beads as this program does."""
import shutil
import subprocess
import unittest

from support import PATIENCE, CliTest, Hdf5, tree_of


def words_of(script, command):
    """The words behind each line of a script that begins with this command."""
    return [line.split()[1:] for line in script.splitlines() if line.split()[:1] == [command]]


class Export(CliTest):
    def script(self, *words, case="case.yaml"):
        self.succeed("export", case, "-o", "out", "--engine", "liggghts", *words)
        return (self.folder / "out/in.liggghts").read_text(encoding="utf-8")

    def test_what_is_written(self):
        script = self.script()
        self.assertEqual(sorted(tree_of(self.folder / "out")), ["README.md", "beads.data", "case.resolved.yaml", "in.liggghts", "meshes", "meshes/wall0.stl", "post"])
        data = (self.folder / "out/beads.data").read_text(encoding="utf-8")
        beads = data.split("Atoms")[1].split("Velocities")[0].split("\n")[2:-2]
        self.assertIn("%d atoms" % len(beads), data)
        self.assertGreater(len(beads), 100)
        self.assertEqual({line.split()[2] for line in beads}, {"0.008"})
        self.assertEqual(words_of(script, "boundary"), [["f", "f", "p"]])
        fixes = {words[0]: words[1:] for words in words_of(script, "fix")}
        self.assertEqual(fixes["young"][3:4], ["peratomtype"])
        self.assertEqual(len(fixes["coefficientRestitution"]), 3 + 2 + 4)
        self.assertIn("wall0", fixes["walls"])
        self.assertEqual(fixes["turn_wall0"][3:5], ["wall0", "rotate"])
        steps = [int(words[0]) - int(words_of(script, "reset_timestep")[0][0]) for words in words_of(script, "run")]
        step = float(words_of(script, "timestep")[0][0])
        self.assertAlmostEqual(steps[0] * step, 0.02, delta=step)  # settle_s

    def test_softened_materials_and_both_rollings(self):
        script = self.script("--set", "contact.interactions={r: {kind: rolling_epsd, damping_ratio: 0.3}}", "--set", "pairs.default.rolling_friction=0.05")
        self.assertIn("gran model hertz tangential history rolling_friction epsd", script)
        fixes = {words[0]: words[1:] for words in words_of(script, "fix")}
        self.assertEqual(fixes["coefficientRollingFriction"][5], "0.05")
        self.assertEqual(fixes["coefficientRollingViscousDamping"][5], "0.3")

    def test_a_ramp_is_a_formula(self):
        script = self.script("--set", "geometry.liner.motion={rotation: {speed: mill, start_s: 0.01, ramp_s: 0.1}}")
        self.assertIn("rotate/variable", script)
        self.assertIn("v_omega_wall0", script)

    def test_all_that_cannot_be_played_is_told_at_once_and_nothing_is_written(self):
        refused = self.millscope("export", "case.yaml", "-o", "out", "--engine", "liggghts", "--set", "contact.law.cap=sum", "--set",
                                 "contact.interactions={l: {kind: lubrication, viscosity: 0.001 Pa s}}", "--set",
                                 "body_forces.pool={kind: fluid_pool, level: 0 m}")
        self.assertEqual(refused.returncode, 2)
        for part in ("cap is 'sum'", "LIGGGHTS has no 'lubrication'", "only gravity is handed to LIGGGHTS"):
            self.assertIn(part, refused.stderr)
        self.assertFalse((self.folder / "out").exists())
        self.assertEqual(self.millscope("check", "case.yaml", "--engine", "liggghts", "--set", "contact.law.cap=sum").returncode, 2)
        self.assertIn("can play this case", self.succeed("check", "case.yaml", "--engine", "liggghts").stdout)

    def test_bad_words(self):
        self.assert_one_line(self.millscope("export", "case.yaml", "-o", "out", "--engine", "ligghts"), "'ligghts' is no engine that is known", "liggghts")
        (self.folder / "out").mkdir()
        self.assert_one_line(self.millscope("export", "case.yaml", "-o", "out", "--engine", "liggghts"), "exists already")


class Import(CliTest):
    """Results as LIGGGHTS writes them, made up: a tenth of a second in which nothing moves and the torque is 0.2 N m."""

    def setUp(self):
        super().setUp()
        self.succeed("export", "case.yaml", "-o", "theirs", "--engine", "liggghts", "--set", "mill.direction=clockwise", "--set",
                     "time={end_s: 0.4, analyze_from_s: 0.2}", "--set", "output.frames={every_s: 0.1, from_s: 0.2}", "--set", "output.tracks={beads: [3, 7], every_s: 0.1}", "--set", "output.vtk=~")
        script = (self.folder / "theirs/in.liggghts").read_text(encoding="utf-8")
        self.step = float(words_of(script, "timestep")[0][0])
        self.beads = [line.split() for line in (self.folder / "theirs/beads.data").read_text().split("Atoms")[1].split("Velocities")[0].splitlines() if line]
        dumps = {words[0]: words for words in words_of(script, "dump")}
        self.often = int(dumps["frames"][3])
        self.assertEqual(words_of(script, "group"), [["tracked", "id", "4", "8"]])
        self.track_often = int(dumps["tracks"][3])
        runs = [int(words[0]) for words in words_of(script, "run")]
        self.zero, self.end = runs[0], runs[-1] - runs[0]
        self.row = next(int(words[5]) for words in words_of(script, "fix") if words[0] == "series")
        self.post = self.folder / "theirs/post"
        self.write_series()
        self.write_tracks()
        for k in range(2, 1 + self.end // self.often):
            self.write_frame(k * self.often)

    def write_series(self, leave_out=range(0)):
        steps = [self.row * (self.zero // self.row + 1 + k) for k in range(self.end // self.row)]
        lines = ["%d 1e-3 2e-3 0.01 -0.03 0.013 0 0 0.2" % step for k, step in enumerate(steps) if k not in leave_out]
        (self.post / "series.txt").write_text("# head\n# more\n" + "\n".join(lines) + "\n")

    def write_tracks(self, beads=(3, 7)):
        head = "ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n%d\nITEM: BOX BOUNDS ff ff pp\n0 1\n0 1\n0 1\nITEM: ATOMS id x y z \n"
        text = ""
        for step in range(self.zero, self.zero + self.end + 1, self.track_often):
            text += head % (step, len(beads)) + "".join("%d 0.01 -0.02 %g\n" % (b + 1, -0.001) for b in beads)
        (self.post / "tracks.txt").write_text(text)

    def write_frame(self, step, beads=None):
        head = ("ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n%d\nITEM: BOX BOUNDS ff ff pp\n0 1\n0 1\n0 1\n"
                "ITEM: ATOMS id type x y z vx vy vz omegax omegay omegaz radius density \n")
        rows = ["%s 1 %s %s %s 0 0 0 0 0 1 0.004 2500" % (b[0], *b[4:7]) for b in (beads or self.beads)]
        (self.post / ("frame_%d.txt" % (self.zero + step))).write_text(head % (self.zero + step, len(rows)) + "\n".join(rows) + "\n")

    def test_files_as_of_a_run(self):
        self.succeed("import", "theirs", "-o", "out")
        self.assertEqual(sorted(tree_of(self.folder / "out")), ["case.resolved.yaml", "frames.h5", "series.csv", "summary.json", "tracks.h5"])
        summary = self.summary("out")
        speed = summary["mill_speed_rad_per_s"]
        self.assertLess(speed, 0)
        self.assertAlmostEqual(summary["power_W"]["torque"], -0.2 * speed, places=9)
        mass = len(self.beads) * 2500 * 4 / 3 * 3.141592653589793 * 0.004**3
        self.assertAlmostEqual(summary["power_W"]["com"], mass * 9.81 * 0.01 * speed, places=6)
        self.assertNotIn("dissipation", summary["power_W"])
        self.assertEqual(summary["engine"]["name"], "liggghts")
        self.assertIsNone(summary["com_m"][2])  # along a periodic axis there is none
        with Hdf5(self.folder / "out/frames.h5") as f:
            self.assertAlmostEqual(f.read("time")[0], 2 * self.often * self.step)
            self.assertAlmostEqual(f.read("position")[1], float(self.beads[0][5]), places=6)
            self.assertAlmostEqual(f.read("wall_angle")[0], speed * 2 * self.often * self.step)
            self.assertEqual(f.read("spin")[:3], [0, 0, 1])
        with Hdf5(self.folder / "out/tracks.h5") as f:
            self.assertEqual(sorted(f.names()), ["bead_3", "bead_7"])
            self.assertAlmostEqual(f.read("bead_7/t")[1], self.track_often * self.step, places=9)
            self.assertAlmostEqual(f.read("bead_7/position")[2], 0.025)  # -1 mm, in a slice of 26 mm that repeats

    def refused(self, *parts):
        self.assert_one_line(self.millscope("import", "theirs", "-o", "out"), *parts)
        self.assertFalse((self.folder / "out").exists())

    def test_a_run_that_did_not_end_or_began_anew(self):
        self.write_series(range(20, 99))
        self.refused("series.txt: ends at 0\\.[0-9]+ s of 0.4 s", "let LIGGGHTS run to its end")
        self.write_series(range(5, 9))
        self.refused("series.txt:8: nothing stands from", "in one go")

    def test_beads_that_are_lost_or_in_another_order(self):
        self.write_frame(3 * self.often, self.beads[1:])
        self.refused("frame_[0-9]+.txt:4: holds [0-9]+ beads of [0-9]+: LIGGGHTS has lost the others")
        self.write_frame(3 * self.often, self.beads[1:] + self.beads[:1])
        self.refused("frame_[0-9]+.txt:10: bead 2 stands where 1 is expected")

    def test_tracks_that_are_cut_short_or_of_other_beads(self):
        text = (self.post / "tracks.txt").read_text()
        (self.post / "tracks.txt").write_text(text[:-40])
        self.refused("tracks.txt:[0-9]+: the tracks are cut short")
        (self.post / "tracks.txt").write_text(text[::-1].replace("8", "9", 1)[::-1])
        self.refused("tracks.txt:[0-9]+: bead 9 stands where another is expected")
        (self.post / "tracks.txt").unlink()
        self.refused("tracks.txt: cannot be read")

    def test_frames_that_are_missing_cut_short_or_blown_up(self):
        frame = self.post / ("frame_%d.txt" % (self.zero + 3 * self.often))
        text = frame.read_text()
        frame.write_text(text[:len(text) // 2])
        self.refused("the frame is cut short after")
        frame.write_text(text.replace(" 0.004 2500", " nan 2500", 1))
        self.refused("frame_[0-9]+.txt:10:", "no finite number")
        frame.unlink()
        self.refused("frame_[0-9]+.txt: cannot be read")

    def test_results_of_another_case(self):
        text = (self.post / "series.txt").read_text()
        (self.post / "series.txt").write_text(text.replace(" 0 0 0.2", " 0 0 0.2 0 0 0.1"))
        self.refused("series.txt:3: holds 12 numbers, 9 are expected")

    def test_nothing_there(self):
        (self.post / "series.txt").unlink()
        self.refused("series.txt: cannot be read", "liggghts -in in.liggghts")
        self.assert_one_line(self.millscope("import", "materials", "-o", "out"), "case.resolved.yaml: there is none", "millscope export")


@unittest.skipUnless(shutil.which("liggghts"), "liggghts is not installed")
class Alike(CliTest):
    def test_it_takes_every_script(self):
        """Rolling, cohesion, a limited force, a ramp and a ripple, two materials of walls: a few steps of each."""
        rolling = "contact.interactions={r: {kind: rolling_epsd, damping_ratio: 0.3}, c: {kind: cohesion_sjkr}}"
        torque = "contact.interactions={r: {kind: rolling_constant_torque}}"
        coefficients = ["--set", "pairs.default.rolling_friction=0.05", "--set", "pairs.default.cohesion_energy_density=1000 J/m^3"]
        motion = "geometry.liner.motion={rotation: {speed: mill, start_s: 1 ms, ramp_s: 2 ms, ripple: {amplitude: 5 %, frequency: 50 Hz}}}"
        cases = {"rolling": [rolling, *coefficients], "torque": [torque, *coefficients[:2]], "limited": ["contact.law.allow_tension=false"],
                 "motion": [motion], "walls": ["geometry.liner.material=", "--set", "geometry.liner.materials={shell: hdpe, lifter: glass}"]}
        for name, words in cases.items():
            with self.subTest(name):
                self.succeed("export", "case.yaml", "-o", name, "--engine", "liggghts", "--set", "fill.settle_s=0.001", "--set",
                             "time={end_s: 0.005, analyze_from_s: 0}", "--set", "output.frames=~", "--set", words[0], *words[1:])
                done = subprocess.run(["liggghts", "-in", "in.liggghts"], cwd=self.folder / name, capture_output=True, text=True, timeout=PATIENCE)
                self.assertEqual(done.returncode, 0, done.stdout[-600:] + done.stderr[-600:])

    def test_both_engines_move_the_beads_alike(self):
        """A fall of 40 ms: later chaos parts the two. (This LIGGGHTS crashes with -screen none.)"""
        words = ["--set", "stiffness_factor=0.01", "--set", "fill.settle_s=0.02", "--set", "time={end_s: 0.25, analyze_from_s: 0.1}", "--set", "output.frames={every_s: 0.01, from_s: 0}"]
        # The same flat walls for both, stiff and of few triangles: in LIGGGHTS a bead that sinks in touches several, each of which pushes.
        self.succeed("geometry", "export", "case.yaml", "-o", "liner.stl", "--set", "geometry.liner.facet=12 mm")
        text = (self.folder / "case.yaml").read_text()
        liner = text[text.index("    kind: mill"):text.index("    material: hdpe")]
        self.write("case.yaml", text.replace(liner, "    kind: mesh\n    file: liner.stl\n    unit: m\n    period: 26 mm\n"))
        self.succeed("export", "case.yaml", "-o", "theirs", "--engine", "liggghts", *words)
        done = subprocess.run(["liggghts", "-in", "in.liggghts"], cwd=self.folder / "theirs", capture_output=True, text=True, timeout=PATIENCE)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.succeed("import", "theirs", "-o", "imported")
        self.assertGreater(self.summary("imported")["power_W"]["torque"], 0)
        frames = sorted((self.folder / "theirs/post").glob("frame_*.txt"), key=lambda p: int(p.stem.split("_")[1]))
        theirs = [[float(w) for w in line.split()[2:5]] for line in frames[2].read_text().splitlines()[9:]]
        self.run_case("ours", *words)
        with Hdf5(self.folder / "imported/frames.h5") as f, Hdf5(self.folder / "ours/frames.h5") as g:
            for one, other in zip(f.read("time"), g.read("time")):
                self.assertAlmostEqual(one, other, places=9)
        with Hdf5(self.folder / "ours/frames.h5") as f:
            self.assertAlmostEqual(f.read("time")[2], 0.02, places=4)
            last = f.read("position")[6 * len(theirs):9 * len(theirs)]
        ours = [last[3 * i:3 * i + 3] for i in range(len(theirs))]
        off = sorted(max(abs(a - b) for a, b in zip(p, q)) for p, q in zip(ours, theirs))
        self.assertLess(off[len(off) // 2], 2.5e-4)
        fallen = sum(p[1] for p in ours) / len(ours) - sum(p[1] for p in theirs) / len(theirs)
        self.assertLess(abs(fallen), 1e-4)  # of 7.8 mm


if __name__ == "__main__":
    unittest.main()
