"""`millscope export` and `check --engine`: what LIGGGHTS gets, what it is refused, and that it moves the beads as this program does."""
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
        self.assertEqual(sorted(tree_of(self.folder / "out")), ["README.md", "beads.data", "in.liggghts", "meshes", "meshes/wall0.stl", "post"])
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
        steps = [int(words[0]) for words in words_of(script, "run")]
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
        self.assert_one_line(self.millscope("export", "case.yaml", "-o", "out", "--engine", "ligghts"), "'ligghts' is not known", "liggghts")
        (self.folder / "out").mkdir()
        self.assert_one_line(self.millscope("export", "case.yaml", "-o", "out", "--engine", "liggghts"), "exists already")


@unittest.skipUnless(shutil.which("liggghts"), "liggghts is not installed")
class Alike(CliTest):
    def test_both_engines_move_the_beads_alike(self):
        """A fall of 40 ms: later chaos parts the two. (This LIGGGHTS crashes with -screen none.)"""
        words = ["--set", "stiffness_factor=0.01", "--set", "fill.settle_s=0.02", "--set", "time={end_s: 0.025, analyze_from_s: 0.01}", "--set", "output.frames={every_s: 0.01, from_s: 0}"]
        # The same flat walls for both, stiff and of few triangles: in LIGGGHTS a bead that sinks in touches several, each of which pushes.
        self.succeed("geometry", "export", "case.yaml", "-o", "liner.stl", "--set", "geometry.liner.facet=12 mm")
        text = (self.folder / "case.yaml").read_text()
        liner = text[text.index("    kind: mill"):text.index("    material: hdpe")]
        self.write("case.yaml", text.replace(liner, "    kind: mesh\n    file: liner.stl\n    unit: m\n    period: 26 mm\n"))
        self.succeed("export", "case.yaml", "-o", "theirs", "--engine", "liggghts", *words)
        done = subprocess.run(["liggghts", "-in", "in.liggghts"], cwd=self.folder / "theirs", capture_output=True, text=True, timeout=PATIENCE)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        frames = sorted((self.folder / "theirs/post").glob("frame_*.txt"), key=lambda p: int(p.stem.split("_")[1]))
        self.assertEqual(len(frames), 3)  # at 0, 10 and 20 ms
        theirs = [[float(w) for w in line.split()[2:5]] for line in frames[-1].read_text().splitlines()[9:]]
        self.run_case("ours", *words)
        with Hdf5(self.folder / "ours/frames.h5") as f:
            self.assertEqual(len(f.read("time")), 3)
            last = f.read("position")[-3 * len(theirs):]
        ours = [last[3 * i:3 * i + 3] for i in range(len(theirs))]
        off = sorted(max(abs(a - b) for a, b in zip(p, q)) for p, q in zip(ours, theirs))
        self.assertLess(off[len(off) // 2], 2.5e-4)
        fallen = sum(p[1] for p in ours) / len(ours) - sum(p[1] for p in theirs) / len(theirs)
        self.assertLess(abs(fallen), 1e-4)  # of 7.8 mm


if __name__ == "__main__":
    unittest.main()
