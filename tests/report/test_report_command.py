"""`report` as a user meets it: what stands in the page is what the files say; bad input is one line and no page."""
import json
import pathlib
import tempfile
import unittest

from support import call, data_of, simulate


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        simulate(cls.folder, "out", "--set", "name=<script>alert(1)</script>")
        call(cls.folder, "analyze", "out", "-o", "an", "-q", "--no-pictures")

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def refused(self, *words):
        said = call(self.folder, "report", *words, code=2).stderr
        self.assertEqual(said.count("\n"), 1, said)
        return said

    def test_a_run_and_its_analysis(self):
        done = call(self.folder, "report", "out", "an", "-o", "page.html", "--title", "A <b> mill")
        self.assertIn("wrote page.html", done.stdout)
        page = (self.folder / "page.html").read_text()
        self.assertNotIn("<script>alert(1)", page)
        self.assertIn("A &lt;b&gt; mill", page)
        data = data_of(self.folder / "page.html")
        self.assertEqual([s["kind"] for s in data["sections"]], ["run", "analysis"])
        run, analysis = data["sections"]
        summary = json.loads((self.folder / "out" / "summary.json").read_text())
        self.assertEqual(run["summary"], summary)
        self.assertEqual(run["state"], "done")
        self.assertEqual(run["title"], "<script>alert(1)</script>")
        self.assertEqual(run["movie"]["beads"], summary["particles"])
        self.assertGreaterEqual(run["movie"]["frames"], 15)
        self.assertTrue(run["liner"]["bodies"][0]["turns"])
        self.assertAlmostEqual(run["mill"]["radius_m"], 0.075)
        self.assertEqual(len(run["series"]["time_s"]), len(run["series"]["power_com_W"]))
        by_name = {(r["analyzer"], r["name"]): r for r in analysis["results"]}
        results = json.loads((self.folder / "an" / "results.json").read_text())
        self.assertEqual(analysis["meta"]["blocks"], results["blocks"])
        grid = by_name["pept_grid", "occupancy"]
        self.assertEqual(grid["shape"], [50, 50])
        self.assertAlmostEqual(sum(v or 0 for v in grid["value"]), 1, 3)
        self.assertEqual(len(grid["axes"][0]["values"]), 51)
        self.assertEqual(analysis["shell"]["radius_m"], 0.075)
        self.assertGreater(len(analysis["shell"]["segments_m"]), 10)

    def test_a_folder_of_results_is_gone_through(self):
        call(self.folder, "report", ".", "-o", "all.html", "-q")
        self.assertEqual([s["kind"] for s in data_of(self.folder / "all.html")["sections"]], ["run", "analysis"])

    def test_never_overwritten_unless_asked(self):
        (self.folder / "mine.html").write_text("mine")
        self.assertIn("mine.html", self.refused("out", "-o", "mine.html"))
        self.assertEqual((self.folder / "mine.html").read_text(), "mine")
        call(self.folder, "report", "out", "-o", "mine.html", "--force", "-q")
        self.assertEqual(len(data_of(self.folder / "mine.html")["sections"]), 1)

    def test_bad_input(self):
        (self.folder / "empty").mkdir(exist_ok=True)
        self.assertIn("holds no result", self.refused("empty", "-o", "x.html"))
        self.assertIn("no such folder", self.refused("gone", "-o", "x.html"))
        self.assertIn("is a file", self.refused("out/summary.json", "-o", "x.html"))
        self.assertIn("--movie-mb", self.refused("out", "-o", "x.html", "--movie-mb", "-1"))
        (self.folder / "broken").mkdir(exist_ok=True)
        (self.folder / "broken" / "diagnosis.json").write_text("{")
        self.assertIn("diagnosis.json: is damaged", self.refused("broken", "-o", "x.html"))
        (self.folder / "broken" / "diagnosis.json").unlink()
        for name, version, change in (("diagnosis.json", 2, "'strength'"), ("score.json", 3, "each engine"), ("validation.json", 2, "at once")):
            (self.folder / "broken" / name).write_text('{"schema_version": %d}' % (version - 1))
            said = self.refused("broken", "-o", "x.html")
            self.assertIn(name + ": is of another schema_version than %d" % version, said)
            self.assertIn(change, said)
            (self.folder / "broken" / name).unlink()
        self.assertFalse((self.folder / "x.html").exists())


if __name__ == "__main__":
    unittest.main()
