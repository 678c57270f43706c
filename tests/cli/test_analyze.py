"""analyze as a user meets it: what it prints and writes, what it does not overwrite, what it refuses."""
import csv
import json
import unittest

from support import CliTest

POWER = ("--analyzers", "power,pept_grid", "--set", "analyzers.pept_grid.cells_x=10", "--set", "analyzers.pept_grid.cells_y=10")


class Analyze(CliTest):
    @classmethod
    def setUpClass(cls):
        cls.kept = cls("make")
        cls.addClassCleanup(cls.kept.doCleanups)
        CliTest.setUp(cls.kept)
        cls.kept.run_case("out")
        cls.kept.printed = cls.kept.succeed("analyze", "out", "-o", "results", *POWER).stdout

    def make(self):
        """Not a test: makes the object whose folder all tests of this class read."""

    def setUp(self):
        self.folder = self.kept.folder

    def results(self, name="results"):
        return json.loads((self.folder / name / "results.json").read_text(encoding="utf-8"))

    def test_help(self):
        page = self.succeed("analyze", "--help").stdout
        for word in ("--analyzers", "--settings", "--tracer", "--from", "--to", "--force", "Example:"):
            self.assertIn(word, page)
        self.assertIn("analyze", self.succeed("--help").stdout)

    def test_files(self):
        names = sorted(p.name for p in (self.folder / "results").iterdir())
        self.assertEqual(names, ["pictures", "results.h5", "results.json", "tables"])
        with open(self.folder / "results/tables/numbers.csv", encoding="utf-8") as file:
            rows = {row["name"]: row for row in csv.DictReader(file)}
        self.assertEqual(rows["power_gravity"]["unit"], "W")
        with open(self.folder / "results/tables/pept_grid.y_edges.x_edges.csv", encoding="utf-8") as file:
            cells = list(csv.DictReader(file))
        self.assertEqual(len(cells), 100)
        self.assertAlmostEqual(sum(float(c["occupancy [1]"]) for c in cells), 1, delta=0.01)
        self.assertTrue((self.folder / "results/pictures/pept_grid.occupancy.svg").exists())

    def test_numbers_are_those_of_the_run(self):
        found = self.results()["numbers"]["power"]
        summary = self.summary("out")
        # The frames begin before the window of the summary, and it is a short one: the same power within a few percent of its scale.
        scale = abs(summary["power_W"]["com"])
        self.assertAlmostEqual(found["turning_speed"]["value"], summary["mill_speed_rad_per_s"], places=6)
        self.assertLess(abs(found["power_gravity"]["value"] - summary["power_W"]["com"]), 0.5 * scale)
        self.assertIn("power_gravity", self.kept.printed)

    def test_provenance(self):
        results = self.results()
        self.assertEqual([p["name"] for p in results["provenance"]["plugins"]], ["pept_grid", "power"])
        self.assertEqual(results["provenance"]["analyzers"]["pept_grid"]["cells_x"], 10)
        self.assertEqual([f["file"].split("/")[-1] for f in results["inputs"]], ["frames.h5", "case.resolved.yaml"])
        for file in results["inputs"]:
            self.assertRegex(file["hash"], "^[0-9a-f]{16}$")

    def test_no_influence_of_threads(self):
        self.succeed("analyze", "out", "-o", "one", "--threads", "1", "--no-pictures", "-q", *POWER)
        self.succeed("analyze", "out", "-o", "three", "--threads", "3", "--no-pictures", "-q", *POWER)
        for name in ("numbers.csv", "pept_grid.y_edges.x_edges.csv"):
            self.assertEqual((self.folder / "one/tables" / name).read_text(), (self.folder / "three/tables" / name).read_text())

    def test_never_overwritten_unasked(self):
        self.assert_one_line(self.millscope("analyze", "out", "-o", "results", *POWER), "exists already")
        self.assertEqual(self.succeed("analyze", "out", "-o", "results", "--force", "-q", *POWER).stdout, "")

    def test_force_leaves_nothing_of_the_earlier_results_and_all_of_the_users(self):
        self.succeed("analyze", "out", "-o", "twice", "-q", *POWER)
        mine = [self.folder / "twice" / name for name in ("tables/mine.csv", "pictures/mine.png", "pictures/pept_grid.txt", "notes.md")]
        for file in mine:
            file.write_text("mine")
        self.assertTrue((self.folder / "twice/pictures/pept_grid.occupancy.png").exists())
        self.succeed("analyze", "out", "-o", "twice", "--force", "-q", "--analyzers", "power", "--no-pictures")
        left = sorted(str(f.relative_to(self.folder / "twice")) for f in (self.folder / "twice").rglob("*") if f.is_file())
        self.assertEqual([f for f in left if "pept_grid." in f or f.endswith((".svg", ".png"))], ["pictures/mine.png", "pictures/pept_grid.txt"])
        self.assertIn("tables/numbers.csv", left)
        self.assertTrue(all(file.exists() for file in mine))

    def test_tracers(self):
        page = self.succeed("analyze", "out", "-o", "beads", "--tracer", "all", "--analyzers", "power", "--no-pictures").stdout
        self.assertIn("2 beads followed", page)

    def test_refusals(self):
        self.write("settings.yaml", "analyzers:\n  power: {cels_x: 4}\n")
        for words, part in ((("analyze",), "SOURCE is missing"),
                            (("analyze", "nowhere"), "no such file"),
                            (("analyze", "out", "-o", "x", "--analyzers", "powr"), "did you mean 'power'"),
                            (("analyze", "out", "-o", "x", "--settings", "settings.yaml"), r"settings\.yaml:2.*cells_x"),
                            (("analyze", "out", "-o", "x", "--from", "0.09", "--to", "0.02"), "the span is empty"),
                            (("analyze", "out", "-o", "x", "--from", "7"), "frames go from"),
                            (("analyze", "out", "-o", "x", "--tracer", "99999"), "follows no such bead"),
                            (("analyze", "out", "-o", "x", "--threads", "0"), "1 to 1024"),
                            (("analyze", "out", "-o", "case.yaml"), "is a file"),
                            (("analyze", "out", "-o", "x", "--set", "resampling.draws=2"), "draws")):
            with self.subTest(words=words):
                self.assert_one_line(self.millscope(*words), part)
        self.assertFalse((self.folder / "x").exists())


if __name__ == "__main__":
    unittest.main()
