"""`millscope pept` as a user meets it."""

import json
import math
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from patience import PATIENCE  # noqa: E402


def millscope(*words):
    return subprocess.run([os.environ["MILLSCOPE"], *map(str, words)], capture_output=True, text=True, timeout=PATIENCE)


def write_rotor(file, rows=6000, step_ms=10.0):
    """A tracer at 30 rpm on a radius of 25 mm, in the layout of `.a`."""
    lines = ["", "", "Separation=", "", "f(opt) :  0.500", "", "", "Fixed slices:    250 events/slice,    1 locations/slice", ""]
    for i in range(rows):
        t = i * step_ms
        angle = math.pi * t / 1000
        wobble = 0.2 * math.sin(12.9898 * i * i)
        lines.append("%10.1f %9.1f %9.1f %9.1f %9.1f %9.1f %9.2f %4d" % (t, 25 * math.cos(angle) + wobble, 25 * math.sin(angle) - wobble, 40 + wobble, 2.5, 0, 0, 125))
    file.write_text("\n".join(lines) + "\n")


class PeptInspect(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.rotor = Path(self.folder.name) / "rotor.a"
        write_rotor(self.rotor)

    def test_text_and_json_tell_the_same(self):
        text, data = millscope("pept", "inspect", self.rotor), millscope("pept", "inspect", self.rotor, "--json")
        self.assertEqual((text.returncode, data.returncode), (0, 0), text.stderr + data.stderr)
        rotor = json.loads(data.stdout)["rotor"]
        self.assertAlmostEqual(rotor["radius_m"]["value"], 0.025, delta=1e-4)
        speed = rotor["plateaus"][0]["angular_speed_rad_per_s"]["value"]
        self.assertAlmostEqual(speed, math.pi, delta=0.01)
        self.assertIn("%.2f rpm" % (speed * 30 / math.pi), text.stdout)
        self.assertIn("What it supports", text.stdout)

    def test_convert_writes_tracks_that_are_read_back(self):
        out = Path(self.folder.name) / "rotor.h5"
        done = millscope("pept", "convert", self.rotor, "-o", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("(6000 points of 1 run)", done.stdout)
        again = millscope("pept", "convert", self.rotor, "-o", out)
        self.assertEqual(again.returncode, 2)
        self.assertIn("exists already", again.stderr)
        self.assertEqual(millscope("pept", "convert", self.rotor, "-o", out, "--force").returncode, 0)
        back = json.loads(millscope("pept", "inspect", out, "--json").stdout)
        self.assertEqual(back["recording"]["points"], 6000)
        self.assertIn("tracks.h5", back["formats"][0])
        self.assertAlmostEqual(back["rotor"]["radius_m"]["value"], 0.025, delta=1e-4)

    def test_help(self):
        for words in (["pept", "--help"], ["pept", "inspect", "--help"]):
            shown = millscope(*words)
            self.assertEqual(shown.returncode, 0)
            self.assertIn("millscope pept inspect run1.a", shown.stdout)

    def test_bad_input_is_one_line_and_exit_2(self):
        missing = Path(self.folder.name) / "no.a"
        empty = Path(self.folder.name) / "empty.a"
        empty.write_text("\n" * 9)
        for words, part in (
            (["pept"], None),
            (["pept", "inspekt", self.rotor], "did you mean 'inspect'"),
            (["pept", "inspect"], "RECORDING is missing"),
            (["pept", "inspect", missing], "no.a"),
            (["pept", "inspect", empty], "empty.a"),
            (["pept", "inspect", self.rotor, "--jsn"], "--json"),
        ):
            with self.subTest(words=words):
                shown = millscope(*words)
                self.assertEqual(shown.returncode, 2, shown.stderr)
                if part:
                    self.assertEqual(shown.stderr.count("\n"), 1, shown.stderr)
                    self.assertIn(part, shown.stderr)
                    self.assertEqual(shown.stdout, "")


if __name__ == "__main__":
    unittest.main()
