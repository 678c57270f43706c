"""The pages in a browser: what `report` and `watch` write is opened, looked at, clicked through and printed (browser/*.mjs)."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from support import call, data_of, simulate

FIXTURES = pathlib.Path(__file__).resolve().parent / "fixtures"
REFERENCES = pathlib.Path(__file__).resolve().parent / "references"
PAGE = pathlib.Path(__file__).resolve().parents[2] / "studies" / "report" / "page"
BROWSER_TESTS = pathlib.Path(os.environ["MILLSCOPE_BROWSER_TESTS"])
MISSING = [name for name in ("node", "chromium") if not shutil.which(name)] + ([] if (BROWSER_TESTS / "copied").exists() else ["the browser's driver"])


def looked_at(program, *pages):
    return subprocess.run(["node", str(BROWSER_TESTS / program), *map(str, pages)], capture_output=True, text=True, timeout=800)


@unittest.skipIf(MISSING, f"without {', '.join(MISSING)} no page can be opened")
class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.folder = pathlib.Path(cls.scratch.name)
        simulate(cls.folder, "out", "--set", "name=<script>alert(1)</script>")


class StaticPages(Pages):
    def test_every_kind_of_section(self):
        call(self.folder, "analyze", "out", "-o", "an", "-q", "--no-pictures")
        kinds = [str(FIXTURES / name) for name in ("difference", "crosschecked", "worn", "campaign", "surface", "retuned", "validated", "diagnosis", "scored")]
        call(self.folder, "report", "out", "an", "-o", "run.html", "-q")
        call(self.folder, "report", *kinds, "-o", "studies.html", "-q")
        shown = [section["kind"] for page in ("run.html", "studies.html") for section in data_of(self.folder / page)["sections"]]
        self.assertEqual(shown, ["run", "analysis", "diagnosis", "challenge", "calibration", "calibration", "validation", "comparison", "crosscheck", "wear", "campaign"])
        known = re.search(r"const KINDS = \{ (.*?) \};", (PAGE / "src" / "main.js").read_text())
        self.assertEqual(set(shown), set(known.group(1).split(", ")), "a kind of section that the page knows is not looked at here")
        done = looked_at("check.mjs", self.folder / "run.html")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        # The fixtures are the same on every machine, so their charts can be held against pictures.
        done = looked_at("check.mjs", self.folder / "studies.html", "--compare", REFERENCES)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_faults_are_found(self):
        call(self.folder, "report", str(FIXTURES / "scored"), "-o", "whole.html", "-q")
        text = (self.folder / "whole.html").read_text()
        (self.folder / "asks.html").write_text(text.replace("</body>", '<img alt="" src="http://127.0.0.1:9/picture.png"></body>'))
        self.assertIn("asks for http://127.0.0.1:9", looked_at("check.mjs", self.folder / "asks.html").stdout)

    def test_a_changed_chart_is_found(self):
        call(self.folder, "report", str(FIXTURES / "campaign"), "-o", "made.html", "-q")
        looked_at("check.mjs", self.folder / "made.html", "--keep", self.folder / "kept")
        text = (self.folder / "made.html").read_text()
        changed = re.sub(r'"state":"done"', '"state":"failed"', re.sub(r'"done":\d+', '"done":0', text))
        self.assertNotEqual(changed, text)
        (self.folder / "made.html").write_text(changed)
        self.assertRegex(looked_at("check.mjs", self.folder / "made.html", "--compare", self.folder / "kept").stdout, "differs from its picture")

    def test_a_calibration_that_fits_nothing_says_so_first(self):
        call(self.folder, "report", str(FIXTURES / "retuned"), str(FIXTURES / "surface"), "-o", "fits.html", "-q")
        lines = looked_at("contents.mjs", self.folder / "fits.html").stdout.splitlines()
        self.assertRegex(lines[0], "^No parameters fit \\(misfit 130 for 35 numbers, p = 3 × 10⁻¹³\\)")
        self.assertRegex(lines[1], "^Bead friction 0.4113, weakly determined; .* The most probable set fits")

    def answers(self, **changes):
        """What stands on the page of a diagnosis with these changes, from above; given last, with a run before it."""
        folder = self.folder / "changed"
        shutil.copytree(FIXTURES / "diagnosis", folder, dirs_exist_ok=True)
        diagnosis = json.loads((FIXTURES / "diagnosis" / "diagnosis.json").read_text())
        (folder / "diagnosis.json").write_text(json.dumps(diagnosis | changes))
        call(self.folder, "report", "out", str(FIXTURES / "retuned"), "changed", "-o", "answer.html", "-q", "--force")
        return looked_at("answer.mjs", self.folder / "answer.html").stdout.splitlines(), diagnosis

    def test_the_answer_comes_first_and_the_run_last(self):
        lines, diagnosis = self.answers()
        begin = [re.split("[:|]", line)[0] for line in lines]
        self.assertEqual(begin[0], "The answer")
        self.assertRegex(lines[1], r"^The simulation leaves out rolling resistance: rolling friction 0\.\d+ \(90 %: 0\.\d+ … 0\.\d+\); p = 0\.003\.$")
        self.assertEqual(lines[2], "Next: Run the corrected case: millscope run changed/corrected/case.yaml -o corrected")
        self.assertEqual(lines[3:5], ["Before and after, at speed55", "The corrected simulation predicts this recording better than every other model that was tried."])
        held = diagnosis["held_out"][0]
        rows = lines[5].split(" / ")
        self.assertEqual([row.split("|")[0] for row in rows], ["table ", "recorded", "retuned to the power alone", "retuned to all numbers", "corrected"])
        power = {row.split("|")[0]: float(row.split("|")[1].split()[0]) for row in rows[1:]}
        self.assertAlmostEqual(power["recorded"], 1000 * held["recorded_power_W"], delta=0.06)
        self.assertAlmostEqual(power["corrected"], 1000 * held["models"][0]["power_W"], delta=0.06)
        self.assertRegex(lines[6], "^chart retuned to the power alone: misfit .* corrected: misfit ")
        self.assertEqual(lines[7], "Friction, retuned and unmasked")
        self.assertEqual(lines[9], diagnosis["moved_by_practice"][0].replace("bead_friction", "Bead friction") + ".")
        self.assertEqual(begin[10:], ["chart Contact parameters", "table parameter", "contents", "section diagnosis", "section calibration", "Bead friction was retuned to 0.2213, outside its own interval (0.7923 … 0.7999)", "section run"])

    def test_every_verdict_has_its_sentence(self):
        candidates = ["rolling_resistance", "air_drag", "lifter_wear"]
        for changes, sentence in [
            ({"verdict": "ambiguous", "named": candidates, "next_experiment": "Look at air_drag and pairs.glass~hdpe.static_friction."},
             "Something is left out (p = 0.003), but these recordings cannot tell which: rolling resistance, air drag or lifter wear."),
            ({"verdict": "ambiguous"}, "Rolling resistance may be left out (p = 0.003), but the held-out recording does not confirm it."),
            ({"verdict": "ambiguous", "named": candidates[:2], "named_together": True, "two_effects": [{"first": "rolling_resistance", "second": "air_drag", "p_second": 0.01, "p_first": 0.002}]},
             "The simulation leaves out two things together: rolling resistance and air drag (p = 0.01 for the second beside the first)."),
            ({"verdict": "outside_library", "named": []},
             "Something is left out that is not among the candidates: rolling resistance helps most, but does not suffice (p < 0.001 for the retuned simulation)."),
            ({"verdict": "outside_library", "named": [], "hypotheses": [], "sentence": "Something is missing. air_drag comes nearest."},
             "Something is missing. air drag comes nearest."),
            ({"verdict": "no_mismatch", "named": [], "base": {"p_value": 0.4}}, "Nothing is left out that these recordings could show: once retuned, the simulation describes them (p = 0.4)."),
            ({"verdict": "undetectable", "named": []}, "These recordings cannot tell: no candidate could be seen in them, at any strength."),
        ]:
            lines, diagnosis = self.answers(**changes)
            self.assertEqual(lines[1], sentence)
            if changes["verdict"] in ("no_mismatch", "undetectable"):  # the fixture's retuned base does not describe the held-out condition
                self.assertRegex(lines[2], "^But something differs where it was not fitted: speed55 \\(p < 0.001\\).$")
            if "next_experiment" in changes:
                self.assertEqual(lines[2], "Next: Look at air drag and pairs.glass~hdpe.static_friction.")

    def test_a_page_without_a_diagnosis_begins_with_its_contents(self):
        call(self.folder, "report", "out", str(FIXTURES / "retuned"), "-o", "plain.html", "-q")
        self.assertEqual(looked_at("answer.mjs", self.folder / "plain.html").stdout.splitlines(), ["contents", "section run", "section calibration",
            "Bead friction was retuned to 0.2213, outside its own interval (0.7923 … 0.7999): that moves it where the recordings as a whole do not want it."])

    def test_doubts_are_told_in_the_contents_and_below_the_first_sentence(self):
        doubt = {"name": "overlap", "of": "glass~steel (wall)", "value": 0.2, "limit": 0.05, "unit": "bead radii", "finding": "beads sink in by <20 %>",
                 "may_change": "power may be off", "remedy": "stiffer contacts", "said_by": 3, "simulations": 48}
        for name, file in (("retuned", "calibration.json"), ("diagnosis", "diagnosis.json")):
            shutil.copytree(FIXTURES / name, self.folder / f"{name}-doubted")
            path = self.folder / f"{name}-doubted" / file
            path.write_text(json.dumps(json.loads(path.read_text()) | {"doubts": [doubt]}))
        call(self.folder, "report", "out", "retuned-doubted", "diagnosis-doubted", str(FIXTURES / "surface"), "-o", "doubted.html", "-q")
        lines = looked_at("contents.mjs", self.folder / "doubted.html").stdout.splitlines()
        self.assertEqual([line.endswith(" Doubts: 1.") for line in lines], [True, True, False, True], lines)
        told = looked_at("doubts.mjs", self.folder / "doubted.html").stdout.splitlines()
        self.assertEqual(len(told), 3, told)
        self.assertRegex(told[2], "^means are over 0.28 turns of the mill, under 2; .*Remedy: raise time.end_s by")
        self.assertEqual(told[:2], ["3 of 48 simulations, the worst: beads sink in by <20 %>; power may be off. Remedy: stiffer contacts."] * 2)


class LivePage(Pages):
    def test_it_follows_and_says_when_the_server_is_gone(self):
        call(self.folder, "report", "out", "-o", "page.html", "-q")
        text = (self.folder / "page.html").read_text()
        data = data_of(self.folder / "page.html")
        data["live"] = True
        data["sections"][0].update(state="running", progress={"time_s": 0.2, "end_s": 0.3})
        body = json.dumps(data).replace("<", "\\u003c")
        (self.folder / "live.html").write_text(re.sub(r'(id="millscope-data">).*?(</script>)', lambda m: m[1] + body + m[2], text, flags=re.S))
        done = looked_at("live.mjs", self.folder / "live.html")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
