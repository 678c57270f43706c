"""The code samples of the how-tos: each is taken from its page, built out of tree against the installed SDK, tested and described."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("MILLSCOPE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
COMMAND = os.environ.get("MILLSCOPE", str(SOURCE / "build/release/bin/millscope"))
BUILD = os.environ.get("MILLSCOPE_BINARY_DIR", str(SOURCE / "build/release"))
CMAKE, CTEST, COMPILER = (os.environ.get(name, default) for name, default in (("CMAKE", "cmake"), ("CTEST", "ctest"), ("CXX", "g++")))
STRICT = "-Wall -Wextra -Wpedantic -Wconversion -Werror"


def samples_of(page):
    return re.findall(r"^```cpp\n(.*?)^```$", (SOURCE / "docs" / page).read_text(encoding="utf-8"), re.M | re.S)


class Samples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.folder.name)
        cls.run_command(CMAKE, "--install", BUILD, "--component", "sdk", "--prefix", cls.root / "sdk")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @staticmethod
    def run_command(*words):
        done = subprocess.run([str(w) for w in words], capture_output=True, text=True)
        if done.returncode != 0:
            raise AssertionError(f"{words}: {done.stdout}{done.stderr}")
        return done.stdout

    def build(self, kind, name, source, test=None):
        """A scaffold with the page's source (and its test) in the place of the template's; what `describe` says of it."""
        self.run_command(COMMAND, "plugin", "new", kind, name, "--directory", self.root)
        project, built = self.root / name, self.root / name / "build"
        (project / f"{name}.cpp").write_text(source)
        if test:
            (project / "test.cpp").write_text(test)
        self.run_command(CMAKE, "-S", project, "-B", built, f"-DCMAKE_CXX_COMPILER={COMPILER}", f"-DCMAKE_CXX_FLAGS={STRICT}",
                         f"-DCMAKE_PREFIX_PATH={self.root / 'sdk'}")
        self.run_command(CMAKE, "--build", built)
        self.run_command(CTEST, "--test-dir", built, "--output-on-failure", "--no-tests=error")
        return self.run_command(COMMAND, "describe", name, "--plugin-dir", built / "lib/millscope/plugins")

    def test_the_analyzer(self):
        source, test = samples_of("adding_an_analyzer.md")
        page = self.build("analyzer", "height_profile", source, test)
        self.assertIn("Bins from the bottom of the shell to its top.", page)

    def test_the_description_of_any_plugin(self):
        """It is that of the geometry's template."""
        (sample,) = samples_of("adding_a_plugin.md")
        template = (SOURCE / "sdk/template/geometry/NAME.cpp.in").read_text().replace("@CLASS@", "MyFloor").replace("@NAME@", "my_floor")
        for part in sample.strip().split("\n\n"):
            self.assertIn(part, template)

    def test_the_hypothesis(self):
        (source,) = samples_of("adding_a_hypothesis.md")
        page = self.build("body_force", "mist", source)
        self.assertIn("Hypothesis mist\n  A mist in the mill slows every bead by its speed. Parameter viscosity: vanishes at 0, prior 0 to 0.5 (Stokes 1851).", page)

    def test_the_parameters_of_the_contact_law(self):
        """They are those of the template, which tests/host builds; the page must not drift from it."""
        template = (SOURCE / "sdk/template/contact_law/NAME.cpp.in").read_text()
        parameters, force, info = samples_of("adding_a_contact_law.md")
        self.assertIn(parameters.strip(), template)
        for line in (force.strip().rstrip(";") + "\n" + info.strip()).splitlines():
            self.assertIn(" ".join(line.split()), " ".join(template.split()))


if __name__ == "__main__":
    unittest.main()
