#!/usr/bin/env python3
"""The picture of the rooms holds each room and points downward; a cycle and a page that lags behind end the command with 1."""

import contextlib
import io
import re
import sys
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from unittest import mock

sys.dont_write_bytecode = True
HERE = Path(__file__).resolve()
sys.path[:0] = [str(HERE.parents[0]), str(HERE.parents[1]), str(HERE.parents[2] / "tools")]
import include_graph  # noqa: E402
import rooms  # noqa: E402
import rooms_picture  # noqa: E402
from self_test import PAGE, SOUND, TABLE  # noqa: E402
from small_tree import SmallTreeTest  # noqa: E402

SVG = "{http://www.w3.org/2000/svg}"


def run(*words):
    said = io.StringIO()
    with mock.patch.object(sys, "argv", ["rooms.py", *map(str, words)]), contextlib.redirect_stdout(said):
        return rooms.main(), said.getvalue()


class Rooms(SmallTreeTest):
    sound = SOUND

    def test_a_sound_tree_is_drawn(self):
        code, said = run("--root", self.root, self.root / "rooms.svg")
        self.assertEqual(code, 0, said)
        self.assertIn("10 rooms, 9 arrows, without a cycle, 0 differences", said)
        picture = ElementTree.parse(self.root / "rooms.svg").getroot()
        labels = [text.text for text in picture.iter(SVG + "text")]
        self.assertEqual(sorted(labels), sorted(["sdk", "plugins", "geometry", "config", "dem", "run", "compare", "diagnose/naming", "diagnose", "app"]))
        arrows = [path.get("d") for path in picture.iter(SVG + "path") if path.get("class") == "arrow"]
        self.assertEqual(len(arrows), 8)  # app uses compare through diagnose
        for arrow in arrows:
            heights = [float(y) for y in re.findall(r",(-?[\d.]+)", arrow)]
            self.assertEqual(heights, sorted(heights))

    def test_boxes_do_not_overlap(self):
        graph = {"app": {"a", "b", "c", "d", "e"}, "a": {"sdk"}, "b": {"sdk"}, "c": {"a"}, "d": {"b", "sdk"}, "e": {"sdk"}, "sdk": set()}
        layout = rooms_picture.Layout(graph)
        for row in layout.rows:
            for left, right in zip(row, row[1:]):
                self.assertGreaterEqual(layout.x[right] - layout.x[left], layout.apart(left, right) - 1e-9)
        self.assertEqual(layout.crossings(), 0)

    def test_a_cycle_ends_with_1(self):
        self.write("kernel/dem/back.cpp", "#include \"kernel/run/simulation.hpp\"\n")
        code, said = run("--root", self.root, self.root / "rooms.svg")
        self.assertEqual(code, 1)
        self.assertIn("a cycle: kernel/dem → kernel/run → kernel/dem", said)
        self.assertFalse((self.root / "rooms.svg").exists())

    def test_a_page_that_lags_behind_is_updated(self):
        self.write("kernel/run/more.cpp", "#include \"kernel/config/error.hpp\"\n#include <nlohmann/json.hpp>\n")
        self.write(PAGE, TABLE.replace("| | `fcl` |", "| `sdk` | `fcl` |"))
        code, said = run("--root", self.root)
        self.assertEqual(code, 1)
        self.assertIn("3 differences", said)
        code, said = run("--root", self.root, "--update")
        self.assertEqual(code, 0, said)
        self.assertIn("| `kernel/run` | runs | `config`, `dem` | `nlohmann` |", (self.root / PAGE).read_text())
        self.assertEqual(list(include_graph.faults_of(self.root)), [])


if __name__ == "__main__":
    unittest.main()
