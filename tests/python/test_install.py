"""What `cmake --install` leaves of the package: the component `python` alone is whole, and is imported from where it lies."""
import os
import pathlib
import subprocess
import sys
import unittest

from support import PACKAGE, FolderTest, needs_package

BUILD = os.environ.get("MILLSCOPE_BINARY_DIR", "")


@needs_package
@unittest.skipUnless((pathlib.Path(BUILD) / "cmake_install.cmake").exists(), "no build directory: set MILLSCOPE_BINARY_DIR")
class Install(FolderTest):
    def test_the_component_is_imported_from_its_place(self):
        prefix = self.folder / "prefix"
        subprocess.run([os.environ.get("CMAKE", "cmake"), "--install", BUILD, "--component", "python", "--prefix", prefix], check=True, capture_output=True)
        place = prefix / "lib/python3/dist-packages"
        files = sorted(path.relative_to(place) for path in prefix.rglob("*") if path.is_file())
        self.assertEqual(files, sorted(path.relative_to(PACKAGE) for path in PACKAGE.rglob("*.py")))
        done = subprocess.run([sys.executable, "-B", "-c", "import millscope; print(millscope.__file__)"], env={**os.environ, "PYTHONPATH": str(place)}, cwd=self.folder,
                              capture_output=True, text=True, check=True)
        self.assertEqual(pathlib.Path(done.stdout.strip()), place / "millscope/__init__.py")


if __name__ == "__main__":
    unittest.main()
