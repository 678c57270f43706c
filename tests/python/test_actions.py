"""The commands as functions: found, followed, stopped, and failing with the program's own line."""
import os
import signal
import threading
import time
import unittest
from unittest import mock

from support import SOURCE, FolderTest, needs_package

try:
    import millscope
    from millscope import command
except ImportError:
    pass


@needs_package
class Finding(unittest.TestCase):
    def test_the_variable_comes_before_the_path(self):
        with mock.patch.dict(os.environ, {"MILLSCOPE": "/bin/true", "PATH": "/nowhere"}):
            self.assertEqual(command.find(), "/bin/true")

    def test_it_says_what_to_do_where_there_is_none(self):
        with mock.patch.dict(os.environ, {"MILLSCOPE": "/nowhere/millscope"}), self.assertRaisesRegex(millscope.Error, "MILLSCOPE is '/nowhere/millscope'"):
            millscope.call("--version")
        with mock.patch.dict(os.environ, {"PATH": "/nowhere"}), self.assertRaisesRegex(millscope.Error, "no command 'millscope' on PATH; install it, or set MILLSCOPE"):
            del os.environ["MILLSCOPE"]
            millscope.call("--version")


@needs_package
class Actions(FolderTest):
    def test_a_case_from_a_dictionary_to_a_comparison(self):
        case = millscope.load_case(self.folder / "case.yaml")
        case["seed"] = 3
        said = []
        run = millscope.run(case, self.folder / "out", settings=self.SMALL, progress=said.append)
        self.assertEqual(run.case["seed"], 3)
        self.assertEqual(run.case["output"]["vtk"], "off")
        self.assertIn("Demo mill: ", said[0])
        self.assertTrue([line for line in said if line.startswith("running ")])
        self.assertTrue([line for line in said if line.startswith("doubt: ")])
        self.assertEqual(millscope.load_case(self.folder / "out.yaml")["seed"], 3)
        few = {"analyzers": ["power", "pept_grid"], "pictures": False, "progress": False}
        one = millscope.analyze(run, self.folder / "one", from_s=0.4, to_s=0.8, **few)
        other = millscope.analyze(run.path, self.folder / "other", from_s=0.8, **few)
        self.assertEqual({name.split(".")[0] for name in one}, {"power", "pept_grid"})
        self.assertLess(one.meta["context"]["end"], 0.81)
        comparison = millscope.compare(one, other, self.folder / "difference", only=["power"], progress=False)
        self.assertIn(comparison.verdict, ("no_difference", "differ", "cannot_tell"))
        self.assertTrue(comparison.sentence)
        page = millscope.report([run, one], self.folder / "page.html", title="A mill", progress=False)
        self.assertIn("<title>A mill", page.read_text(encoding="utf-8"))
        recording = millscope.synthesize(run, self.folder / "bead.a", settings={"observations": {"rate": {"kind": "sampling", "rate": "200 Hz"}}},
                                         options=["--camera", self.camera()], progress=False)
        self.assertEqual(len(millscope.open_recording(recording)), 2)

    def camera(self):
        return millscope.save_case({"schema_version": 1, "observations": {}}, self.folder / "camera.yaml", force=True)

    def test_a_failure_is_the_programs_own_line(self):
        case = millscope.load_case(self.folder / "case.yaml")
        case["mill"]["sped"] = 1
        said = []
        with self.assertRaises(millscope.Error) as caught:
            millscope.run(case, self.folder / "wrong", progress=said.append)
        self.assertRegex(str(caught.exception), r"^.*wrong\.yaml:\d+: unknown key 'sped' in 'mill'; did you mean 'speed'\?$")
        self.assertEqual(caught.exception.exit_code, 2)
        self.assertEqual(caught.exception.command[1], "run")
        self.assertEqual(said, [])  # it is said once
        self.assertFalse((self.folder / "wrong").exists())

    def test_a_file_of_somebody_else_is_not_overwritten(self):
        (self.folder / "mine.yaml").write_text("mine: 1\n")
        with self.assertRaisesRegex(millscope.Error, "mine.yaml is there already and was not written here"):
            millscope.run({"schema_version": 1}, self.folder / "mine", progress=False)
        self.assertEqual((self.folder / "mine.yaml").read_text(), "mine: 1\n")

    def test_a_run_that_is_interrupted_leaves_a_checkpoint(self):
        out = self.folder / "interrupted"

        def interrupt():
            while not (out / "frames.h5").exists():
                time.sleep(0.01)
            os.kill(os.getpid(), signal.SIGINT)

        threading.Thread(target=interrupt, daemon=True).start()
        with self.assertRaises(KeyboardInterrupt):
            millscope.run(self.folder / "case.yaml", out, settings={**self.SMALL, "time.end_s": 500}, progress=False)
        self.assertTrue((out / "checkpoint.h5").exists())
        self.assertFalse((out / ".lock").exists())

    def test_a_command_that_is_killed_is_said_to_be(self):
        script = self.folder / "millscope"
        for text, line in (("echo almost >&2; kill -9 $$", "'.*millscope run' was ended by signal 9; it last said: almost"),
                           ("exit 3", "'.*millscope run' ended with exit code 3 and said nothing"),
                           ("echo 'millscope: first' >&2; echo 'millscope: µ is wrong' >&2; exit 2", "^µ is wrong$")):
            script.write_text(f"#!/bin/sh\n{text}\n")
            script.chmod(0o755)
            with self.subTest(text), mock.patch.dict(os.environ, {"MILLSCOPE": str(script)}), self.assertRaisesRegex(millscope.Error, line):
                millscope.call("run", "x")

    def test_the_words_of_studies(self):
        """A stand-in writes down its words and leaves a fixture: the real ones take hours."""
        fixtures, script = SOURCE / "tests/report/fixtures", self.folder / "millscope"
        for action, left, opened in ((millscope.diagnose, "diagnosis", millscope.Diagnosis), (millscope.calibrate, "retuned", millscope.Calibration)):
            script.write_text(f"#!/bin/sh\nprintf '%s\\n' \"$@\" > {self.folder}/words\ncp -r {fixtures}/{left} \"$4\"\n")
            script.chmod(0o755)
            with self.subTest(left), mock.patch.dict(os.environ, {"MILLSCOPE": str(script)}):
                found = action("study.yaml", self.folder / left, settings={"budget.simulations": 80, "a.range": [0.1, "5 mm"]}, slots=2, options=["--draws", 99])
                self.assertIsInstance(found, opened)
            words = (self.folder / "words").read_text().splitlines()
            self.assertEqual(words, [action.__name__, "study.yaml", "-o", str(self.folder / left), "--slots", "2", "--set", "budget.simulations=80",
                                     "--set", "a.range=[0.1, 5 mm]", "--draws", "99"])
        for action in (millscope.diagnose, millscope.calibrate):
            with self.assertRaisesRegex(millscope.Error, "nothing.yaml"):
                action(self.folder / "nothing.yaml", self.folder / "no", progress=False)

    def test_what_is_drawn_over_and_what_stays(self):
        script = self.folder / "millscope"
        script.write_text("#!/bin/sh\nprintf 'head\\n' >&2; printf '\\r\\033[K1 of 2' >&2; sleep 0.2; printf '\\r\\033[K2 of 2' >&2; sleep 0.2\n"
                          "printf '\\r\\033[Kmillscope: warning: hot\\n' >&2; printf '\\r\\033[K3 of 3' >&2; sleep 0.2; printf '\\r\\033[K' >&2; printf 'done\\n'; exit 0\n")
        script.chmod(0o755)
        said = []
        with mock.patch.dict(os.environ, {"MILLSCOPE": str(script)}):
            self.assertEqual(millscope.call("x", progress=said.append), "done\n")
        self.assertEqual([line for line in said if " of " not in line], ["head", "millscope: warning: hot"])
        self.assertLessEqual({line for line in said if " of " in line}, {"1 of 2", "2 of 2", "3 of 3"})  # a slow reader misses some
        self.assertEqual(len(said), len(set(said)))


if __name__ == "__main__":
    unittest.main()
