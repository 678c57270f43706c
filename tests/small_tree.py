"""A small tree of files in a folder of its own, for the tests of what checks the repository."""

import tempfile
import unittest
from pathlib import Path


class SmallTreeTest(unittest.TestCase):
    sound = {}  # name → text of each file that a test begins with

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        for name, text in self.sound.items():
            self.write(name, text)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
