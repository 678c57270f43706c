"""What others read millscope's files with: the Python example on a run of a small mill, and VTK's own reader on its pictures.

tests/cli holds the pictures' structure against the format; here the library that ParaView is made of reads them, where it is installed.
"""
import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xml.dom.minidom

SOURCE = pathlib.Path(os.environ.get("MILLSCOPE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
COMMAND = os.environ.get("MILLSCOPE", str(SOURCE / "build/release/bin/millscope"))
EXAMPLE = SOURCE / "examples/python/read_results.py"
SETTINGS = ["time.end_s=1.2", "time.analyze_from_s=0.4", "fill.filling=15 %", "fill.settle_s=0.1", "stiffness_factor=0.0005"]


def has(*modules):
    return all(importlib.util.find_spec(module) for module in modules)


class SmallRun(unittest.TestCase):
    """A second of a small mill, once for each class."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.folder.name)
        words = [word for setting in SETTINGS for word in ("--set", setting)]
        cls.run_command("run", SOURCE / "configs/demo.yaml", "-o", cls.root / "out", "-q", *words)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @staticmethod
    def run_command(*words):
        done = subprocess.run([COMMAND, *words], capture_output=True, text=True)
        if done.returncode != 0:
            raise AssertionError(done.stderr)


@unittest.skipUnless(has("h5py", "numpy"), "h5py or numpy is not installed: apt-get install python3-h5py python3-numpy")
class PythonExample(SmallRun):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.run_command("analyze", cls.root / "out", "-q", "--no-pictures", "--analyzers", "power,pept_grid,charge_features")

    def example(self, *words):
        return subprocess.run([sys.executable, "-B", EXAMPLE, *words], capture_output=True, text=True)

    def test_it_reads_a_run_and_its_analysis(self):
        pictures = self.root / "pictures"
        done = self.example(self.root / "out", self.root / "out-analysis", *(["--pictures", pictures] if has("matplotlib") else []))
        self.assertEqual(done.returncode, 0, done.stderr)
        by_window = float(re.search(r"power by com +(\S+)", done.stdout).group(1))
        by_hand = float(re.search(r"from the frames: (\S+) W", done.stdout).group(1))
        self.assertGreater(by_window, 0)
        self.assertAlmostEqual(by_hand, by_window, delta=0.03 * by_window)  # frames are further apart than the window's steps
        self.assertRegex(done.stdout, r"occupancy: [1-9]\d* of 2500 cells visited")
        if has("matplotlib"):
            for name in ("occupancy.png", "power.png"):
                self.assertEqual((pictures / name).read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def test_it_says_what_is_missing(self):
        done = self.example(self.root / "nothing")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"^read_results: there is no .*summary\.json; it comes from: millscope run CASE\.yaml")
        self.assertEqual(done.stderr.count("\n"), 1)


@unittest.skipUnless(has("vtkmodules"), "VTK's Python is not installed: apt-get install python3-vtk9")
class VtkReader(SmallRun):
    def read(self, file):
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
        reader = vtkXMLPolyDataReader()
        self.assertTrue(reader.CanReadFile(str(file)))
        reader.SetFileName(str(file))
        reader.Update()
        self.assertEqual(reader.GetErrorCode(), 0, file)
        return reader.GetOutput()

    def files(self, series):
        sets = xml.dom.minidom.parse(str(self.root / "out/vtk" / f"{series}.pvd")).getElementsByTagName("DataSet")
        self.assertGreater(len(sets), 5)
        return [self.root / "out/vtk" / s.getAttribute("file") for s in sets]

    def test_beads(self):
        for file in self.files("beads"):
            beads = self.read(file)
            data = beads.GetPointData()
            self.assertEqual(beads.GetNumberOfPoints(), beads.GetNumberOfVerts())
            self.assertGreater(beads.GetNumberOfPoints(), 100)
            self.assertEqual(sorted(data.GetArrayName(k) for k in range(data.GetNumberOfArrays())), ["id", "material", "radius", "speed", "spin", "velocity"])
            self.assertAlmostEqual(data.GetArray("radius").GetValue(0), 2.5e-3, delta=1e-9)
            self.assertLess(max(map(abs, beads.GetBounds()[:4])), 0.0751)  # inside the shell of 150 mm, but for the softened beads' overlap
            x, y, z = data.GetArray("velocity").GetTuple3(7)
            self.assertAlmostEqual((x * x + y * y + z * z) ** 0.5, data.GetArray("speed").GetValue(7), delta=1e-6)

    def test_liner(self):
        work = []
        for file in self.files("mesh"):
            liner = self.read(file)
            cells = liner.GetCellData()
            self.assertGreater(liner.GetNumberOfPolys(), 100)
            self.assertTrue(all(liner.GetCellType(k) == 5 for k in range(liner.GetNumberOfCells())))  # 5: triangles
            impact = cells.GetArray("impact_work")
            work.append(sum(impact.GetValue(k) for k in range(liner.GetNumberOfCells())))
        self.assertEqual(work, sorted(work))
        self.assertGreater(work[-1], work[0])


if __name__ == "__main__":
    unittest.main()
