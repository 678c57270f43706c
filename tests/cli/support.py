"""What the tests of the command share: a small case, running the command, comparing runs, reading HDF5 without h5py."""
import ctypes
import filecmp
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from patience import PATIENCE, files_below  # noqa: E402, F401: for the tests that import this

SOURCE = pathlib.Path(os.environ.get("MILLSCOPE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
COMMAND = os.environ.get("MILLSCOPE", str(SOURCE / "build/release/bin/millscope"))

# 324 beads of 8 mm in a slice of a 150 mm mill with six lifters, softened so far that a second takes 16 000 steps.
CASE = """\
schema_version: 1
name: Small mill
include: [materials/glass.yaml, materials/hdpe.yaml]
seed: 1
stiffness_factor: 0.0002
beads:
  glass8: {material: glass, diameter: 8 mm}
fill:
  filling: 30 %
  vessel: {diameter: 150 mm, length: 26 mm}
  settle_s: 0.02
contact:
  law: {kind: hertz_mindlin}
pairs:
  default: {restitution: 0.6, static_friction: 0.3}
body_forces:
  gravity: {kind: gravity}
mill: {diameter: 150 mm, speed: 75 %critical, direction: counter_clockwise}
geometry:
  liner:
    kind: mill
    diameter: 150 mm
    length: 26 mm
    lifters: 6
    lifter_height: 6 mm
    lifter_width: 14 mm
    lifter_face_angle: 60 deg
    material: hdpe
    motion: mill
domain:
  periodic: {z: [0, 26 mm]}
time: {end_s: 0.1, analyze_from_s: 0.05}
output:
  series: {every_s: 0.01}
  frames: {every_s: 0.01, from_s: 0.02}
  tracks: {beads: 2, every_s: 0.001}
  vtk: {every_s: 0.02}
run: {threads: 1}
"""


class CliTest(unittest.TestCase):
    """A test with a folder of its own, in which the small case lies as case.yaml."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="millscope-cli-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        shutil.copytree(SOURCE / "configs/materials", self.folder / "materials")
        self.write("case.yaml", CASE)

    def write(self, name, text):
        mode = {"mode": "wb"} if isinstance(text, bytes) else {"mode": "w", "encoding": "utf-8"}
        with open(self.folder / name, **mode) as file:
            file.write(text)
        return self.folder / name

    def write_case(self, *changes, name="case.yaml"):
        """The small case with (old, new) pairs of text replaced."""
        text = CASE
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        return self.write(name, text)

    def start(self, *words, **options):
        options = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "cwd": self.folder} | options
        process = subprocess.Popen([COMMAND, *map(str, words)], **options)
        self.addCleanup(end, process)
        return process

    def millscope(self, *words, **options):
        """Runs the command to its end; the result has returncode, stdout, stderr."""
        process = self.start(*words, **options)
        out, err = process.communicate(timeout=PATIENCE)
        return subprocess.CompletedProcess(words, process.returncode, out, err)

    def succeed(self, *words, **options):
        result = self.millscope(*words, **options)
        self.assertEqual(result.returncode, 0, f"{words}: {result.stderr}")
        return result

    def run_case(self, out, *words, case="case.yaml"):
        self.succeed("run", case, "-o", out, "--quiet", *words)
        return self.summary(out)

    def resume(self, out, *words):
        self.succeed("resume", out, "--quiet", *words)
        return self.summary(out)

    def summary(self, out):
        return json.loads((self.folder / out / "summary.json").read_text(encoding="utf-8"))

    def assert_one_line(self, result, *parts, code=2):
        """A refusal: the exit code, one line on stderr that begins with the program's name, nothing on stdout."""
        self.assertEqual(result.returncode, code, f"{result.args}: {result.stderr}")
        lines = result.stderr.splitlines()
        self.assertEqual(len(lines), 1, f"{result.args}: {result.stderr}")
        self.assertRegex(lines[0], r"^millscope: ")
        for sign in ("terminate", "std::", "what()", "internal error", "Assertion", "HDF5-DIAG"):
            self.assertNotIn(sign, lines[0])
        for part in parts:
            self.assertRegex(lines[0], part)
        self.assertEqual(result.stdout, "")
        return lines[0]

    def assert_same_run(self, first, second):
        """All that two runs of one case have in common, to the last bit."""
        a, b = self.folder / first, self.folder / second
        one, other = self.summary(first), self.summary(second)
        for summary in (one, other):
            for key in ("wall_s", "particle_steps_per_s", "threads", "provenance"):
                summary.pop(key)
        self.assertEqual(one, other)
        self.assertEqual((a / "series.csv").read_text(), (b / "series.csv").read_text())
        with Hdf5(a / "frames.h5") as f, Hdf5(b / "frames.h5") as g:
            for name in ("time", "wall_angle", "angular_velocity", "wall_work", "dissipation", "position", "velocity", "spin"):
                self.assertEqual(f.read(name), g.read(name), name)
        with Hdf5(a / "tracks.h5") as f, Hdf5(b / "tracks.h5") as g:
            for track in f.names():
                for name in ("t", "position"):
                    self.assertEqual(f.read(f"{track}/{name}"), g.read(f"{track}/{name}"))
        pictures = sorted(p.name for p in (a / "vtk").iterdir())
        self.assertEqual(pictures, sorted(p.name for p in (b / "vtk").iterdir()))
        self.assertEqual(filecmp.cmpfiles(a / "vtk", b / "vtk", pictures, shallow=False)[1:], ([], []))

    def wait_for(self, path, process):
        """Until a file is there, while the process lives."""
        end_of_patience = time.monotonic() + PATIENCE
        while not (self.folder / path).exists():
            self.assertIsNone(process.poll(), f"the run ended before {path} was there")
            self.assertLess(time.monotonic(), end_of_patience, f"{path} never came")
            time.sleep(0.002)


def end(process):
    if process.poll() is None:
        process.kill()
        process.wait()
    for pipe in (process.stdout, process.stderr):
        if pipe:
            pipe.close()


def tree_of(folder):
    """Every file below with its bytes: to see that nothing was touched."""
    return {str(p.relative_to(folder)): p.read_bytes() if p.is_file() else None for p in sorted(pathlib.Path(folder).rglob("*"))}


class Hdf5:
    """Enough of HDF5 to read arrays of numbers, through the very library that the command is linked with."""

    _library = None

    @classmethod
    def library(cls):
        if cls._library is None:
            listing = subprocess.run(["ldd", COMMAND], capture_output=True, text=True, check=True).stdout
            found = re.search(r"=> (\S*libhdf5\S*\.so\S*)", listing)
            if not found:
                raise unittest.SkipTest("the command is not linked with a shared HDF5")
            lib = ctypes.CDLL(found.group(1))
            hid, size = ctypes.c_int64, ctypes.c_uint64
            lib.H5Fopen.argtypes, lib.H5Fopen.restype = [ctypes.c_char_p, ctypes.c_uint, hid], hid
            lib.H5Dopen2.argtypes, lib.H5Dopen2.restype = [hid, ctypes.c_char_p, hid], hid
            lib.H5Dget_space.argtypes, lib.H5Dget_space.restype = [hid], hid
            lib.H5Sget_simple_extent_npoints.argtypes, lib.H5Sget_simple_extent_npoints.restype = [hid], ctypes.c_int64
            lib.H5Dread.argtypes = [hid, hid, hid, hid, hid, ctypes.c_void_p]
            lib.H5Lget_name_by_idx.argtypes = [hid, ctypes.c_char_p, ctypes.c_int, ctypes.c_int, size, ctypes.c_char_p, ctypes.c_size_t, hid]
            lib.H5Lget_name_by_idx.restype = ctypes.c_ssize_t
            for call in (lib.H5Fclose, lib.H5Dclose, lib.H5Sclose):
                call.argtypes = [hid]
            lib.H5open()
            cls._library = lib
        return cls._library

    def __init__(self, path):
        self.lib = self.library()
        self.file = self.lib.H5Fopen(str(path).encode(), 0, 0)
        if self.file < 0:
            raise OSError(f"{path} is no readable HDF5 file")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.lib.H5Fclose(self.file)

    def names(self):
        found = []
        while True:
            name = ctypes.create_string_buffer(256)
            silent = self.lib.H5Eset_auto2(ctypes.c_int64(0), None, None)  # the end is told by an error
            if silent < 0 or self.lib.H5Lget_name_by_idx(self.file, b".", 0, 0, len(found), name, 256, 0) < 0:
                return found
            found.append(name.value.decode())

    def read(self, name):
        """A dataset as a flat list of floats."""
        data = self.lib.H5Dopen2(self.file, name.encode(), 0)
        if data < 0:
            raise KeyError(name)
        space = self.lib.H5Dget_space(data)
        values = (ctypes.c_double * self.lib.H5Sget_simple_extent_npoints(space))()
        double = ctypes.c_int64.in_dll(self.lib, "H5T_NATIVE_DOUBLE_g")
        status = self.lib.H5Dread(data, double, 0, 0, 0, values)
        self.lib.H5Sclose(space)
        self.lib.H5Dclose(data)
        if status < 0:
            raise OSError(f"{name} cannot be read")
        return list(values)
