"""The page's colours are those of the pictures: tests/picture/colours.json holds both."""
import json
import os
import pathlib
import shutil
import subprocess
import unittest

AGREED = pathlib.Path(__file__).resolve().parents[1] / "picture" / "colours.json"
COLOURS = pathlib.Path(os.environ["MILLSCOPE_PAGE_SOURCES"]) / "colours.js"  # beside the palette that the build has made
ASK = """
import { readFileSync } from "node:fs";
const { channels, colouring, line } = await import(process.argv[1]);
const agreed = JSON.parse(readFileSync(process.argv[2], "utf8"));
const shares = (name) => agreed[name].map(([share]) => channels(name, share));
const ends = ({ name, low, high }) => [name === "diverging", low, high];
console.log(JSON.stringify({ sequential: shares("sequential"), diverging: shares("diverging"), distinct: agreed.distinct.map((_, index) => line(index)),
  scales: agreed.scales.map(({ values, signed }) => ends(colouring(values, { signed: signed ?? undefined }))) }));
"""


@unittest.skipIf(not shutil.which("node"), "without node the page's programs do not run")
class Colours(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.agreed = json.loads(AGREED.read_text(encoding="utf-8"))
        done = subprocess.run(["node", "--input-type=module", "-e", ASK, str(COLOURS), str(AGREED)], capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, done.stderr
        cls.found = json.loads(done.stdout)

    def near(self, found, agreed, what):
        for one, other in zip(found, agreed, strict=True):
            self.assertAlmostEqual(one, other, delta=1, msg=f"{what}: {found}, agreed {agreed}")

    def test_scales(self):
        for name in ("sequential", "diverging"):
            for found, (share, agreed) in zip(self.found[name], self.agreed[name], strict=True):
                self.near(found, agreed, f"{name} at {share}")

    def test_lines_and_names(self):
        for index, (found, agreed) in enumerate(zip(self.found["distinct"], self.agreed["distinct"], strict=True)):
            self.assertEqual([int(found[at:at + 2], 16) for at in (1, 3, 5)], agreed, f"line {index}")

    def test_ends_of_a_map(self):
        for found, agreed in zip(self.found["scales"], self.agreed["scales"], strict=True):
            self.assertEqual(found[0], agreed["diverging"], agreed["what"])
            self.assertAlmostEqual(found[1], agreed["low"], msg=agreed["what"])
            self.assertAlmostEqual(found[2], agreed["high"], msg=agreed["what"])


if __name__ == "__main__":
    unittest.main()
