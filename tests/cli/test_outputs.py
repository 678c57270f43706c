"""What a run writes: summary, tables, frames, tracks, pictures, the resolved case, independence of threads and instruction sets."""
import csv
import math
import shutil
import unittest
import xml.dom.minidom

from support import SOURCE, CliTest, Hdf5, tree_of

SUMMARY_KEYS = ("particles", "steps", "dt_s", "simulated_s", "wall_s", "particle_steps_per_s", "threads", "state_hash", "steady", "power_W", "com_m",
                "kinetic_energy_J", "provenance", "schema_version")
COLUMNS = ("time_s", "translational_energy_J", "rotational_energy_J", "elastic_energy_J", "potential_energy_J", "wall_work_J", "dissipated_J", "torque_N_m",
           "power_torque_W", "power_com_W", "com_x_m", "com_y_m", "com_z_m", "contacts")


class Outputs(CliTest):
    @classmethod
    def setUpClass(cls):
        cls.kept = cls("make")
        cls.addClassCleanup(cls.kept.doCleanups)
        CliTest.setUp(cls.kept)
        cls.kept.run_case("out")

    def make(self):
        """Not a test: makes the object whose folder all tests of this class read."""

    def setUp(self):
        self.folder = self.kept.folder
        self.out = self.folder / "out"

    def test_exactly_these_files(self):
        self.assertEqual(sorted(p.name for p in self.out.iterdir()),
                         ["case.resolved.yaml", "checkpoint.h5", "frames.h5", "series.csv", "summary.json", "tracks.h5", "vtk"])

    def test_summary(self):
        s = self.summary("out")
        for key in SUMMARY_KEYS:
            self.assertIn(key, s)
        for key in ("torque", "com", "dissipation"):
            for name in (key, key + "_sem"):
                self.assertTrue(math.isfinite(s["power_W"][name]), name)
        self.assertEqual(s["particles"], 324)
        self.assertEqual(len(s["com_m"]), 3)
        self.assertAlmostEqual(s["simulated_s"], 0.1, delta=s["dt_s"])
        self.assertAlmostEqual(s["steps"] * s["dt_s"], 0.12, delta=2 * s["dt_s"])  # settling counts as steps, not as time
        self.assertRegex(s["state_hash"], "^[0-9a-f]{16}$")
        self.assertIsInstance(s["steady"], bool)
        self.assertEqual(s["threads"], 1)
        self.assertGreater(s["particle_steps_per_s"], 0)
        self.assertGreater(s["wall_s"], 0)
        for key in ("version", "compiler", "host", "processor", "cores", "date_utc", "command_line", "plugins"):
            self.assertIn(key, s["provenance"])
        self.assertIn("case.yaml", s["provenance"]["command_line"])
        self.assertIn("hertz_mindlin", [p["name"] for p in s["provenance"]["plugins"]])

    def test_every_name_is_documented(self):
        text = (SOURCE / "docs/format.md").read_text(encoding="utf-8")
        summary = self.summary("out")
        for name in COLUMNS + tuple(summary) + tuple(summary["energy"]) + tuple(summary["contact"]) + tuple(summary["pairs"][0]):
            self.assertRegex(text, r"[`.]%s[`.\[]" % name.removesuffix("_sem"))

    def test_series(self):
        with open(self.out / "series.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        self.assertEqual(tuple(rows[0]), COLUMNS)
        self.assertEqual(len(rows), 1 + 10)
        numbers = [[float(x) for x in row] for row in rows[1:]]
        self.assertEqual(numbers[0][0], 0)
        for k, row in enumerate(numbers):
            self.assertEqual(len(row), len(COLUMNS))
            self.assertTrue(all(map(math.isfinite, row)))
            self.assertAlmostEqual(row[0], 0.01 * k, delta=1e-3)

    def test_frames(self):
        with Hdf5(self.out / "frames.h5") as f:
            times, n = f.read("time"), 324
            self.assertEqual(len(times), 8)  # 0.02, 0.03 … 0.09 s
            self.assertAlmostEqual(times[0], 0.02, delta=1e-3)
            for name in ("position", "velocity", "spin"):
                self.assertEqual(len(f.read(name)), len(times) * n * 3)
            self.assertEqual(f.read("beads/id"), list(range(n)))
            self.assertEqual(set(f.read("beads/radius")), {0.004})
            position = f.read("position")
            for k in range(0, len(position), 3):
                self.assertLess(math.hypot(position[k], position[k + 1]), 0.075 - 0.002)  # the beads are soft
                self.assertTrue(-1e-6 <= position[k + 2] <= 0.026 + 1e-6)  # float32
            speed = self.summary("out")["mill_speed_rad_per_s"]
            for time, angle in zip(times, f.read("wall_angle")):
                self.assertAlmostEqual(angle, speed * time, places=9)

    def test_tracks(self):
        with Hdf5(self.out / "tracks.h5") as f:
            self.assertEqual(len(f.names()), 2)
            for name in f.names():
                times = f.read(name + "/t")
                self.assertAlmostEqual(len(times), 100, delta=3)
                self.assertEqual(times, sorted(times))
                self.assertEqual(len(f.read(name + "/position")), 3 * len(times))

    def test_pictures(self):
        for series in ("beads", "mesh"):
            sets = xml.dom.minidom.parse(str(self.out / "vtk" / f"{series}.pvd")).getElementsByTagName("DataSet")
            times = [float(s.getAttribute("timestep")) for s in sets]
            self.assertEqual(len(times), 5)
            for k, time in enumerate(times):
                self.assertAlmostEqual(time, 0.02 * k, delta=1e-3)
            for s in sets:
                head, _, data = (self.out / "vtk" / s.getAttribute("file")).read_bytes().partition(b'<AppendedData encoding="raw">\n_')
                document = xml.dom.minidom.parseString(head + b"</VTKFile>")
                offsets = [int(a.getAttribute("offset")) for a in document.getElementsByTagName("DataArray")]
                at = 0
                for offset in offsets:
                    self.assertEqual(offset, at)
                    at += 8 + int.from_bytes(data[at:at + 8], "little")
                self.assertEqual(data[at:], b"\n</AppendedData>\n</VTKFile>\n")
        beads = (self.out / "vtk/beads_000000.vtp").read_bytes()
        self.assertIn(b'NumberOfPoints="324"', beads)

    def test_the_resolved_case_gives_the_same_run(self):
        shutil.copy(self.out / "case.resolved.yaml", self.folder / "again.yaml")
        self.run_case("again", case="again.yaml")
        self.assert_same_run("out", "again")
        self.assertEqual((self.out / "case.resolved.yaml").read_text(), (self.folder / "again/case.resolved.yaml").read_text())

    def test_two_threads_give_the_same_bits(self):
        for threads in (1, 2):
            summary = self.run_case("threads%d" % threads, "--threads", threads, "--set", "run.partitions=2")
            self.assertEqual(summary["threads"], threads)
        self.assert_same_run("threads1", "threads2")

    def test_every_instruction_set_moves_the_beads_alike(self):
        """To the last bit; the sums of the ledger are taken in another order."""
        here = self.summary("out")
        for level in ("v2", "v3", "v4"):
            result = self.millscope("run", "case.yaml", "-o", level, "-q", "--instruction-set", level)
            if result.returncode == 2 and "this machine" in result.stderr:
                continue  # it says so, and there is nothing to compare
            self.assertEqual(result.returncode, 0, result.stderr)
            there = self.summary(level)
            self.assertEqual(here["state_hash"], there["state_hash"])
            for key, value in here["power_W"].items():
                self.assertAlmostEqual(value, there["power_W"][key], delta=1e-9 * abs(value))

    def test_another_seed_gives_another_run(self):
        self.assertNotEqual(self.run_case("seed", "--set", "seed=2")["state_hash"], self.summary("out")["state_hash"])

    def test_outputs_do_not_change_the_run(self):
        bare = self.run_case("bare", "--set", "output.series=off", "--set", "output.frames=off", "--set", "output.tracks=off", "--set", "output.vtk=off",
                             "--set", "output.checkpoint=off")
        self.assertEqual(bare["state_hash"], self.summary("out")["state_hash"])
        self.assertEqual(bare["power_W"], self.summary("out")["power_W"])
        self.assertEqual(sorted(p.name for p in (self.folder / "bare").iterdir()), ["case.resolved.yaml", "checkpoint.h5", "summary.json"])

    def test_force_replaces_a_run_and_nothing_else(self):
        self.run_case("forced")
        self.assert_one_line(self.millscope("run", "case.yaml", "-o", "forced"), "not overwritten", "--force")
        self.run_case("forced", "--force")
        self.assert_same_run("out", "forced")
        self.write("forced/letter.txt", "mine")
        before = tree_of(self.folder / "forced")
        self.assert_one_line(self.millscope("run", "case.yaml", "-o", "forced", "--force"), "letter.txt", "move it away")
        self.assertEqual(before, tree_of(self.folder / "forced"))

    def test_a_mesh_is_found_from_the_resolved_case(self):
        self.succeed("geometry", "export", "case.yaml", "-o", "liner.stl")
        text = (self.folder / "case.yaml").read_text()
        begin, end = text.index("    kind: mill\n"), text.index("    material: hdpe")
        self.write("mesh.yaml", text[:begin] + "    kind: mesh\n    file: liner.stl\n    unit: m\n    period: 26 mm\n" + text[end:])
        self.run_case("meshed", case="mesh.yaml")
        shutil.copytree(self.folder / "meshed", self.folder / "elsewhere/meshed")
        self.resume("elsewhere/meshed", "--set", "time.end_s=0.11")
        self.write("liner.stl", (self.folder / "liner.stl").read_text().replace("vertex 0.0", "vertex 0.1", 1))
        self.assert_one_line(self.millscope("resume", "meshed", "--set", "time.end_s=0.11"), "no longer what the checkpoint was written with")


class Tracers(CliTest):
    def test_only_beads_of_a_tracer_class_are_followed(self):
        self.write_case(("glass8: {material: glass, diameter: 8 mm}", "glass8: {material: glass, diameter: 8 mm, share: 95 %}\n"
                         "  marked: {material: glass, density: 5000, diameter: 8 mm, share: 5 %, tracer: true}"),
                        ("settle_s: 0.02", "settle_s: 0.02\n  shares_by: number"), ("tracks: {beads: 2", "tracks: {beads: 16"))
        self.run_case("out")
        with Hdf5(self.folder / "out" / "tracks.h5") as f:
            followed = {int(name.removeprefix("bead_")) for name in f.names()}
        with Hdf5(self.folder / "out" / "frames.h5") as f:
            mass = dict(zip((int(i) for i in f.read("beads/id")), f.read("beads/mass")))
        self.assertEqual(len(followed), 16)
        heavy = 5000 * math.pi / 6 * 0.008**3
        for bead in followed:
            self.assertAlmostEqual(mass[bead] / heavy, 1, 5)
        self.assertEqual(sum(1 for m in mass.values() if m > 0.9 * heavy), 16)
        with open(self.folder / "out" / "case.resolved.yaml") as resolved:
            self.assertIn("tracer: true", resolved.read())


if __name__ == "__main__":
    unittest.main()
