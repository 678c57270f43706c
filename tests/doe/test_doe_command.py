"""The command `doe` as a user meets it, on the published tables and on tables that are made up here."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from patience import PATIENCE  # noqa: E402

COMMAND = os.environ["MILLSCOPE"]
DATA = pathlib.Path(os.environ["MILLSCOPE_SOURCE_DIR"]) / "tests/doe/data"


class Doe(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def call(self, *arguments):
        return subprocess.run([COMMAND, "doe", *map(str, arguments)], cwd=self.folder, text=True, capture_output=True, timeout=PATIENCE)

    def succeed(self, *arguments):
        done = self.call(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def assert_refused(self, done, *parts):
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertRegex(done.stderr, r"^millscope: [^\n]*\n$")
        for part in parts:
            self.assertIn(part, done.stderr)

    def test_screening(self):
        text = self.succeed("analyze", DATA / "factorial_75.csv", "--generators", "CFPG=CRPP*CFPP*CRPG")
        self.assertIn("two-level plan, 8 factorial runs, 3 centre runs, resolution IV", text)
        self.assertIn("CRPP*CFPP = CRPG*CFPG; CRPP*CRPG = CFPP*CFPG; CRPP*CFPG = CFPP*CRPG", text)
        self.assertRegex(text, r"CFPP +0\.7625 +0\.1300 +1\.163 +1 +1\.163 +34\.40 +0\.0020 +99\.8 %")
        self.assertRegex(text, r"curvature +0\.1158 +1")
        self.assertIn("steepest descent", text)

    def test_screening_against_print(self):
        text = self.succeed("analyze", DATA / "factorial_75.csv", "--printed", DATA / "factorial_75_printed.csv")
        self.assertRegex(text, r"objective, CFPP +p +0\.003 +0\.002\d+ +differs +0\.002\d+, so the printed p is wrong")
        self.assertRegex(text, r"objective, curvature +p +0\.128 +0\.1234 +differs +0\.128\d\n")
        self.assertIn("4 printed p do not follow from their F", text)
        found = json.loads(self.succeed("analyze", DATA / "factorial_75.csv", "--printed", DATA / "factorial_75_printed.csv", "--json"))
        self.assertEqual([f["term"] for f in found["printed"] if f["contradicts_F"]], ["CFPP", "CRPG", "CRPP", "CFPG"])
        (self.folder / "printed.csv").write_text("response,term,figure,printed\nobjective,CFPX,SS,1.18\n")
        self.assert_refused(self.call("analyze", DATA / "factorial_75.csv", "--printed", "printed.csv"), "printed.csv:2", "CFPX/SS")

    def test_surface_with_files(self):
        text = self.succeed("analyze", DATA / "ccd_75.csv", "-o", "ccd.json", "--pictures", "pictures")
        self.assertIn("axial runs at ±1.4142 steps", text)
        self.assertIn("lack of fit F(3,4) = 21.0, p = 0.0066: the quadratic is rejected", text)
        self.assertRegex(text, r"14 +power_W")
        self.assertRegex(text, r"13 +objective")
        self.assertRegex(text, r"17 +objective")
        json_file = json.loads((self.folder / "ccd.json").read_text())
        objective = json_file["responses"][0]
        self.assertEqual(objective["stationary_point"]["kind"], "minimum")
        self.assertAlmostEqual(objective["stationary_point"]["natural"]["CFPP"], 0.335, places=3)
        self.assertAlmostEqual(objective["stationary_point"]["natural"]["CRPG"], 0.540, places=3)
        self.assertTrue(objective["rejected"])
        flagged = {(r["name"], x["run"]) for r in json_file["responses"] for x in r["residuals"] if x["stands_out"]}
        self.assertEqual(flagged, {("objective", "13"), ("objective", "17"), ("power_W", "14")})
        self.assertTrue((self.folder / "pictures/ccd_75-objective.svg").read_text().startswith("<?xml"))
        self.assert_refused(self.call("analyze", DATA / "ccd_75.csv", "-o", "ccd.json"), "ccd.json")
        self.succeed("analyze", DATA / "ccd_75.csv", "-o", "ccd.json", "--force", "-q")

    def test_json_on_stdout(self):
        found = json.loads(self.succeed("analyze", DATA / "factorial_75.csv", "--json", "--model", "interactions"))
        self.assertEqual(found["plan"]["resolution"], "IV")
        effects = {e["name"]: e for e in found["responses"][0]["effects"]}
        self.assertAlmostEqual(effects["CRPP*CRPG"]["sum_of_squares"], 0.0741125)
        self.assertEqual(effects["CRPP*CRPG"]["alias"], "CFPP*CFPG")

    def test_a_plan_goes_round(self):
        self.succeed("design", "central-composite", "-f", "speed=40:80", "-f", "friction=0.2:0.4", "--centre-points", "5", "-o", "plan.csv")
        rows = (self.folder / "plan.csv").read_text().splitlines()
        filled = [rows[0] + ",power"]
        for row in rows[1:]:
            speed, friction = map(float, row.split(",")[2:])
            filled.append(f"{row},{20 + (speed / 60 - 1) ** 2 * 9 + (friction - 0.31) ** 2 * 50 + 0.01 * (len(filled) ** 2 % 5):.5f}")
        (self.folder / "done.csv").write_text("\n".join(filled) + "\n")
        found = json.loads(self.succeed("analyze", "done.csv", "--json"))
        place = found["responses"][0]["stationary_point"]
        self.assertEqual(place["kind"], "minimum")
        self.assertAlmostEqual(place["natural"]["speed"], 60, delta=1)
        self.assertAlmostEqual(place["natural"]["friction"], 0.31, delta=0.01)

    def test_plans_on_stdout(self):
        text = self.succeed("design", "two-level", *(f"--factor={n}=1:2" for n in "ABCD"), "--generators", "D=A*B*C")
        self.assertIn("# resolution: IV", text)
        self.assertEqual(len([row for row in text.splitlines() if row[0].isdigit()]), 11)
        self.assertEqual(self.succeed("design", "latin-hypercube", "-f", "A=0:1", "-f", "B=0:1", "--runs", "5", "--seed", "3"),
                         self.succeed("design", "latin-hypercube", "-f", "A=0:1", "-f", "B=0:1", "--runs", "5", "--seed", "3"))

    def test_refusals(self):
        def analyze(text, *options):
            (self.folder / "t.csv").write_text(text)
            return self.call("analyze", "t.csv", *options)

        self.assert_refused(self.call("analyze", "missing.csv"), "missing.csv", "cannot be read")
        self.assert_refused(analyze("A,y\n1,2\n2,two\n1,3\n2,3\n"), "t.csv:3", "'two'")
        self.assert_refused(analyze("A,B,y\n1,1,1\n2,2,2\n1,1,3\n2,2,4\n", "--factors", "A,B"), "vary together")
        self.assert_refused(analyze("A,B,y\n1,5,1\n2,5,2\n1,5,3\n2,5,4\n", "--factors", "A,B"), "B has one value")
        self.assert_refused(analyze("A,B,y\n1,1,1\n2,1,1\n1,2,1\n2,2,1\n", "--factors", "A,B", "--responses", "y"), "nothing to explain")
        self.assert_refused(analyze("A,B,y\n1,1,1\n2,1,2\n1,2,3\n2,2,4\n", "--factors", "A,B", "--model", "cubic"), "--model 'cubic'")
        self.assert_refused(analyze("A,B,y\n1,1,1\n2,1,2\n1,2,3\n2,2,4\n", "--factors", "A,C"), "no column 'C'")
        self.assert_refused(self.call("design", "box", "-f", "A=1:2"), "'doe design box' is no plan")
        self.assert_refused(self.call("design", "sobol", "-f", "A=1:2"), "--runs is missing")
        self.assert_refused(self.call("design", "two-level", "-f", "A=2:1"), "above the low one")
        self.assert_refused(self.call("analyse"), "analyze")

    def test_help(self):
        for action in ("analyze", "design"):
            self.assertIn("Example:", self.succeed(action, "--help"))


if __name__ == "__main__":
    unittest.main()
