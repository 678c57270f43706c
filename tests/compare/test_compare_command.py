"""The command `compare` as a user meets it, on recordings that are made up here."""
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from patience import PATIENCE  # noqa: E402

COMMAND = os.environ["MILLSCOPE"]
YAML = """files: [%s.csv]
format: table
columns: {t: ms, x: mm, y: mm, z: mm}
frame: {axis: [0, 0], ends: [0, 60 mm]}
condition: {speed: %g rad/s, direction: clockwise, filling: 30 %%, porosity: 0.4, bead_diameter: 5 mm, bead_density: 2500, mill_diameter: 300 mm,
            mill_length: 60 mm}
"""


def loops(seed, speed, seconds=60, rate=150):
    """A bead on loops of changing size round a point of its own, clockwise; rows of t in ms and x, y, z in mm."""
    dice, rows, angle, size, z = random.Random(seed), [], 0.0, 40.0, 30.0
    for i in range(seconds * rate):
        angle -= speed / rate
        size = min(60.0, max(20.0, size + dice.gauss(0, 1.5)))
        z = min(55.0, max(5.0, z + dice.gauss(0, 0.5)))
        rows.append("%.3f,%.4f,%.4f,%.4f" % (1000 * i / rate, -60 + size * math.cos(angle) + dice.gauss(0, 0.3),
                                             -60 + size * math.sin(angle) + dice.gauss(0, 0.3), z + dice.gauss(0, 0.3)))
    return "\n".join(rows) + "\n"


class Compare(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        for name, seed, speed in (("one", 1, 6.0), ("two", 2, 6.0), ("fast", 3, 7.5)):
            (cls.folder / (name + ".csv")).write_text(loops(seed, speed))
            (cls.folder / (name + ".yaml")).write_text(YAML % (name, 6.0))
            done = cls.call("analyze", name + ".yaml", "-o", name, "--no-pictures", "-q", "--analyzers", "pept_grid,power,distributions")
            assert done.returncode == 0, done.stderr

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @classmethod
    def call(cls, *arguments):
        return subprocess.run([COMMAND, *arguments], cwd=cls.folder, text=True, capture_output=True, timeout=PATIENCE)

    def test_alike(self):
        done = self.call("compare", "one", "two", "-q")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"^no difference at 5 % family-wise in \d+ observables\n$")

    def test_unlike_with_files(self):
        done = self.call("compare", "one", "fast/results.h5", "-o", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"\d+ of \d+ observables differ at 5 % family-wise; strongest: ")
        found = json.loads((self.folder / "out" / "comparison.json").read_text())
        speed = next(o for o in found["observables"] if o["name"] == "pept_grid.speed by region")
        self.assertTrue(speed["differs"])
        self.assertGreater(speed["strongest"]["difference"], 0)
        self.assertTrue((self.folder / "out" / "pictures" / "pept_grid.speed.png").read_bytes().startswith(b"\x89PNG"))
        self.assertIn("observable", (self.folder / "out" / "elements.csv").read_text())
        again = self.call("compare", "one", "fast", "-o", "out")
        self.assertEqual(again.returncode, 2)
        self.assertIn("comparison.json", again.stderr)
        (self.folder / "out" / "pictures" / "mine.png").write_text("mine")
        self.assertEqual(self.call("compare", "one", "fast", "-o", "out", "--force", "-q", "--only", "power").returncode, 0)
        left = [f.name for f in (self.folder / "out" / "pictures").iterdir() if not f.name.startswith("power.")]
        self.assertEqual(left, ["mine.png"])  # nothing of the earlier comparison, all of the user's

    def test_json(self):
        done = self.call("compare", "one", "two", "--json", "--only", "power")
        self.assertEqual(json.loads(done.stdout)["verdict"], "no_difference")

    def test_bad_input(self):
        for arguments, part in ((("one",), "B is missing"), (("one", "nowhere"), "nowhere"), (("one", "two", "--only", "powr"), "neither of the results has it"),
                                (("one", "two", "--level", "0"), "--level 0"), (("one.yaml", "two"), "one.yaml")):
            done = self.call("compare", *arguments)
            self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
            self.assertIn(part, done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)


if __name__ == "__main__":
    unittest.main()
