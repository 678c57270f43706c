"""The commit that the command tells: looked up in every build, written where it has changed."""
import pathlib
import re
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "app" / "commit.cmake"


class Commit(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name).resolve()
        self.output = self.folder / "commit.cpp"

    def git(self, *words):
        subprocess.run(["git", "-C", self.folder / "sources", "-c", "user.name=a", "-c", "user.email=a@b", *words], check=True, capture_output=True)

    def sources(self, name="sources"):
        (self.folder / name).mkdir(parents=True)
        (self.folder / name / "law.cpp").write_text("int law = 1;\n")
        return self.folder / name

    def commit_of(self, sources):
        done = subprocess.run(["cmake", f"-DSOURCES={sources}", f"-DOUTPUT={self.output}", "-P", SCRIPT], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return re.search(r'return "(.*)";', self.output.read_text()).group(1)

    def test_a_commit_is_told_and_what_differs_from_it(self):
        sources = self.sources()
        self.git("init", "-q")
        self.git("add", ".")
        self.git("commit", "-qm", "one")
        first = self.commit_of(sources)
        self.assertRegex(first, r"^[0-9a-f]{12}$")
        (sources / "law.cpp").write_text("int law = 2;\n")
        self.assertEqual(self.commit_of(sources), first + "-dirty")
        self.git("commit", "-qam", "two")
        second = self.commit_of(sources)
        self.assertRegex(second, r"^[0-9a-f]{12}$")
        self.assertNotEqual(second, first)

    def test_the_file_is_left_alone_where_nothing_has_changed(self):
        sources = self.sources()
        self.commit_of(sources)
        before = self.output.stat().st_mtime_ns
        self.commit_of(sources)
        self.assertEqual(self.output.stat().st_mtime_ns, before)

    def test_sources_without_git_have_none_nor_that_of_a_repository_around_them(self):
        self.assertEqual(self.commit_of(self.sources("unpacked")), "")
        self.sources()
        self.git("init", "-q")
        self.git("add", ".")
        self.git("commit", "-qm", "one")
        self.assertEqual(self.commit_of(self.sources("sources/unpacked")), "")


if __name__ == "__main__":
    unittest.main()
