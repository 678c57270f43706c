"""The command `bank` as a user meets it: what is planned, done, failed and waiting; what is missing is run, once; no recording is asked for."""
import pathlib
import re
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from support import CASE, CliTest  # noqa: E402

STUDY = """base: case.yaml
conditions:
  fast: {set: {mill.speed: 75 %critical, time.end_s: 0.03, time.analyze_from_s: 0.01}, recording: not_yet.yaml, role: fit}
  slow: {set: {mill.speed: 60 %critical, time.end_s: 0.03, time.analyze_from_s: 0.01}, recording: not_yet.yaml, role: held_out}
parameters:
  pairs.glass~glass.static_friction: {range: [0.2, 0.4]}
hypotheses:
  lifter_wear: {}
bank: {base: 8, each: 1}
"""
ROW = re.compile(r"^(\S+) +(fast|slow|) +(\d+) +(\d+) +(\d+) +(\d+) +(\d+) +(\S.*)$", re.MULTILINE)


class Bank(CliTest):
    def setUp(self):
        super().setUp()
        few = CASE.replace("filling: 30 %", "filling: 4 %").replace("settle_s: 0.02", "settle_s: 0.005")
        few = few.replace("  default: {", "  glass~hdpe: {restitution: 0.6, static_friction: 0.3}\n  glass~glass: {")
        self.write("case.yaml", few[:few.index("output:")] + "run: {threads: 1}\n")
        self.write("study.yaml", STUDY)

    def bank(self, *words, code=0):
        done = self.millscope("bank", *words)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stdout if code == 0 else done.stderr

    def rows(self, *words):
        """(group, condition) → (planned, done, failed, running, waiting)."""
        text = self.bank("status", "study.yaml", "--cache", "cache", *words)
        return {(m[1], m[2]): tuple(int(n) for n in m.groups()[2:7]) for m in ROW.finditer(text)}, text

    def test_a_bank_is_empty_then_whole_and_nothing_is_computed_twice(self):
        rows, text = self.rows()
        planned = {("base", "fast"): 8, ("base", "slow"): 8, ("again", "fast"): 8, ("again", "slow"): 8, ("lifter_wear", "fast"): 1, ("all", ""): 33}
        self.assertEqual(rows, {place: (n, 0, 0, 0, n) for place, n in planned.items()})
        self.assertIn("none is done yet", text)
        self.assertFalse((self.folder / "cache").exists(), "status writes nothing")
        self.assertIn("33 simulations in cache, 33 computed now, 0 failed", self.bank("extend", "study.yaml", "--cache", "cache"))
        rows, text = self.rows()
        self.assertEqual(rows[("all", "")], (33, 33, 0, 0, 0))
        self.assertIn("the bank is whole", text)
        rows, text = self.rows("--set", "bank.each=3")
        self.assertEqual(rows[("lifter_wear", "fast")], (3, 1, 0, 0, 2))
        self.assertEqual(rows[("all", "")], (35, 33, 0, 0, 2))
        self.assertRegex(text, r"the rest takes about \d+ s on one core, \d+ s with \d+ at once, by the times of the 33 that are done")
        said = self.bank("extend", "study.yaml", "--cache", "cache", "--set", "bank.each=3")
        self.assertIn("35 simulations in cache, 2 computed now, 0 failed", said)

    def test_where_the_base_is_too_small_candidates_are_planned_in_held_out_conditions_too(self):
        second = "parameters.pairs.glass~hdpe.static_friction={range: [0.2, 0.4]}"  # six coefficients, and eight sets
        rows, _ = self.rows("--set", second)
        self.assertEqual(rows[("lifter_wear", "slow")], (1, 0, 0, 0, 1))
        rows, _ = self.rows("--set", second, "--set", "bank.base=12")
        self.assertNotIn(("lifter_wear", "slow"), rows)

    def test_help_explains_with_an_example(self):
        self.assertIn("millscope bank status configs/mill10/diagnose.yaml --cache diagnosis/cache", self.bank("--help"))
        for action in ("status", "extend"):
            self.assertIn("millscope bank %s configs/mill10/diagnose.yaml" % action, self.bank(action, "--help"))

    def test_bad_input_is_one_line(self):
        for words, part in [(("status", "study.yaml"), "--cache is missing; give that of 'millscope diagnose'"),
                            (("status", "gone.yaml", "--cache", "c"), "no such file"),
                            (("statis", "study.yaml"), "did you mean 'status'?"),
                            (("extend", "study.yaml", "--cache", "c", "--slots", "0"), "--slots 0: give 1 or more"),
                            (("status", "study.yaml", "--cache", "c", "--set", "bank.base=4"), "'bank.base'")]:
            said = self.bank(*words, code=2)
            self.assertIn(part, said)
            self.assertEqual(said.count("\n"), 1, said)
        self.assertFalse((self.folder / "c").exists())


if __name__ == "__main__":
    unittest.main()
