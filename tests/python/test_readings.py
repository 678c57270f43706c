"""tools/power_readings.py: readings of Bbosa's sum on motions with known answers, and against the analyzer."""
import json
import subprocess
import sys
import unittest

from support import SOURCE, FolderTest, needs_package

try:
    import numpy

    import millscope
except ImportError:
    pass

sys.path.insert(0, str(SOURCE / "tools"))
import power_readings  # noqa: E402

OMEGA, RADIUS = 6.0, 0.15


def turning_beads(x, y, turning):
    return [numpy.asarray(a, float) for a in (x, y, -numpy.multiply(turning, y), numpy.multiply(turning, x))]


def specific(beads, sense=1):
    """Reading → W/kg."""
    cells = power_readings.Cells(*beads, sense * OMEGA, RADIUS)
    return {name: cells.specific_power(*parts) for name, parts in power_readings.READINGS.items()}


@needs_package
class Readings(unittest.TestCase):
    def test_where_all_rises_with_the_shell_every_sum_over_x_is_exact(self):
        random = numpy.random.default_rng(1)
        x, y = random.uniform(0.02, 0.1, 20000), random.uniform(-0.1, 0.1, 20000)
        for sense in (1, -1):
            found = specific(turning_beads(sense * x, y, sense * OMEGA), sense)
            exact = 9.81 * x.mean() * OMEGA
            for name, watts in found.items():
                with self.subTest(name=name, sense=sense):
                    if name.startswith("r, ") or "x̄" in name:  # other arms than x
                        self.assertNotAlmostEqual(watts / exact, 1, delta=0.05)
                    else:
                        self.assertAlmostEqual(watts / exact, 1, delta=0.005)  # a cell stands for its middle

    def test_a_layer_that_runs_back_tells_the_readings_apart(self):
        # Four beads of a quarter each at |x| = 63 mm: one rises at Ω, one runs back at 2 Ω; two share a cell on the other side, one each way.
        found = specific(turning_beads([0.063, 0.063, -0.063, -0.063], [0.003, 0.063, 0.003, 0.003], [OMEGA, -2 * OMEGA, OMEGA, -OMEGA]))
        unit = 9.81 * 0.063 * OMEGA / 4
        for name, times in {"M g ⟨x⟩ Ω, exact": 0, "x, ⟨|ω|⟩": 1, "x, |⟨ω⟩|": 3, "x, ⟨ω⟩ with its sign": -1, "|x|, ⟨|ω|⟩": 5, "|x|, |⟨ω⟩|": 3,
                            "|x|, ⟨ω⟩ with its sign": -1, "|x|, Ω of the shell": 4, "rising cells only: x, ⟨|ω|⟩": 1, "cells with x > 0 only: x, ⟨|ω|⟩": 3}.items():
            with self.subTest(name=name):
                self.assertAlmostEqual(found[name], times * unit, delta=1e-9)


@needs_package
class OfARun(FolderTest):
    def test_the_analyzers_sum_is_among_them(self):
        run = millscope.run(self.folder / "case.yaml", self.folder / "run", settings=self.SMALL)
        numbers = millscope.analyze(run, self.folder / "maps", analyzers=["power"])
        done = self.readings(run.path, "--from", "0.4", "--scale", "2", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        found = json.loads(done.stdout)
        self.assertAlmostEqual(found["x, ⟨|ω|⟩"]["power_W"] / float(numbers["power.power_bbosa"].value), 2, delta=0.002)
        self.assertAlmostEqual(found["M g ⟨x⟩ Ω, exact"]["power_W"] / float(numbers["power.power_gravity"].value), 2, delta=0.01)
        late = self.readings(run.path, "--from", "99")
        self.assertEqual((late.returncode, late.stderr.count("\n")), (1, 1), late.stderr)
        self.assertIn("has 0 frames from 99 s on, fewer than 5; give --from an earlier time", late.stderr)

    def test_what_is_no_run_is_refused_in_a_line(self):
        done = self.readings(self.folder)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)
        self.assertIn("is no directory of a run", done.stderr)

    @staticmethod
    def readings(*words):
        return subprocess.run([sys.executable, "-B", SOURCE / "tools/power_readings.py", *words], capture_output=True, text=True)


if __name__ == "__main__":
    unittest.main()
