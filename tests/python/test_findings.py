"""What calibrate, validate and diagnose left: the project's own fixtures of the report page."""
import json
import unittest

from support import SOURCE, needs_package

try:
    import millscope
except ImportError:
    pass

FIXTURES = SOURCE / "tests/report/fixtures"


@needs_package
class Findings(unittest.TestCase):
    def test_a_diagnosis(self):
        found = millscope.open_diagnosis(FIXTURES / "diagnosis")
        data = json.loads((FIXTURES / "diagnosis/diagnosis.json").read_text())
        self.assertEqual((found.verdict, found.named, found.sentence), ("named", ["rolling_resistance"], data["sentence"]))
        self.assertEqual(len(found.hypotheses), len(data["hypotheses"]))
        self.assertEqual(found.hypotheses.loc["rolling_resistance", "class"], "best")
        friction = found.contact_parameters.set_index(["fit", "parameter"])["value"]
        self.assertEqual(friction["unmasked", "bead_friction"], data["contact_parameters"]["unmasked"]["bead_friction"]["value"])
        strength = found.strengths.set_index(["hypothesis", "parameter"]).loc[("rolling_resistance", "rolling_friction")]
        self.assertLess(strength["low90"], strength["value"])
        self.assertEqual(len(found.mismatch), len(data["mismatch"]))
        self.assertEqual(len(found.held_out), sum(len(condition["models"]) for condition in data["held_out"]))
        self.assertIn("corrected", set(found.held_out["model"]))

    def test_a_calibration(self):
        found = millscope.open_calibration(FIXTURES / "retuned")
        data = json.loads((FIXTURES / "retuned/calibration.json").read_text())
        self.assertEqual(found.parameters["value"].tolist(), data["best"])
        self.assertEqual(found.parameters.index.tolist(), [p["name"] for p in data["parameters"]])
        if (FIXTURES / "retuned/runs.csv").exists():
            self.assertIn("objective", found.runs)

    def test_a_validation(self):
        found = millscope.open_validation(FIXTURES / "validated")
        data = json.loads((FIXTURES / "validated/validation.json").read_text())
        self.assertEqual(found.passed, data["pass"])
        self.assertEqual(len(found.judgements), sum(len(c.get("observables", [])) for c in data["conditions"].values()))
        self.assertFalse(found.judgements["unit"].isna().any())
        self.assertEqual(bool(found.at_once["pass"].all()), data["at_once"])
        self.assertEqual(found.at_once["numbers"].sum(), len(found.judgements))

    def test_what_is_not_there_names_its_command(self):
        for opened, command in ((millscope.open_diagnosis, "millscope diagnose"), (millscope.open_calibration, "millscope calibrate"),
                                (millscope.open_validation, "millscope validate"), (millscope.open_comparison, "millscope compare")):
            with self.subTest(command), self.assertRaisesRegex(millscope.Error, f"there is no .*; it comes from: {command}"):
                opened(FIXTURES)


if __name__ == "__main__":
    unittest.main()
