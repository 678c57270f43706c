"""What the tests of the Python package share: where it is, what it needs, a folder of one's own, a small run."""
import importlib.util
import os
import pathlib
import shutil
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("MILLSCOPE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
PACKAGE = SOURCE / "python"
os.environ.setdefault("MILLSCOPE", str(SOURCE / "build/release/bin/millscope"))
sys.path[:0] = [str(PACKAGE), str(SOURCE / "tests")]
from patience import PATIENCE  # noqa: E402, F401: for the tests that import this


def needs(*packages):
    """Skips a class where Debian packages are missing, which it names."""
    modules = {"python3-h5py": "h5py", "python3-pandas": "pandas", "python3-yaml": "yaml", "python3-matplotlib": "matplotlib",
               "python3-nbconvert": "nbconvert", "python3-ipykernel": "ipykernel"}
    missing = [package for package in packages if importlib.util.find_spec(modules[package]) is None]
    return unittest.skipIf(missing, f"not installed: apt-get install {' '.join(missing)}")


needs_package = needs("python3-h5py", "python3-pandas", "python3-yaml")


class FolderTest(unittest.TestCase):
    """A folder for each class, with the small mill in it as case.yaml."""

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="millscope-python-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        shutil.copytree(SOURCE / "configs/materials", cls.folder / "materials")
        shutil.copy(SOURCE / "configs/demo.yaml", cls.folder / "case.yaml")

    # 340 beads, softened so far that a second takes a second or two.
    SMALL = {"time.end_s": 1.2, "time.analyze_from_s": 0.4, "fill.filling": "15 %", "fill.settle_s": 0.1, "stiffness_factor": 0.0005,
             "output.tracks.beads": 2, "output.vtk": "off"}
