"""Cases as dictionaries: what is loaded, changed and saved means to millscope what it meant before."""
import pathlib
import unittest

from support import SOURCE, FolderTest, needs_package

try:
    import numpy
    import yaml

    import millscope
except ImportError:
    pass


@needs_package
class Cases(FolderTest):
    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def load(self, text):
        return millscope.load_case(self.write("loaded.yaml", text))

    def test_words_and_numbers_are_those_of_millscope(self):
        case = self.load("a: off\nb: 1e-5\nc: 60 %critical\nd: true\ne: ~\nf: '12'\ng: 012\nh: 3\ni: [1, 2.5, 3 mm]\nj: no\nk:\n")
        self.assertEqual(dict(case), {"a": "off", "b": 1e-5, "c": "60 %critical", "d": True, "e": None, "f": "12", "g": "012", "h": 3,
                                      "i": [1, 2.5, "3 mm"], "j": "no", "k": None})

    def test_what_is_saved_is_loaded_again(self):
        content = {"off": "off", "text": "12", "number": 1e-5, "tiny": 4.9e-324, "whole": -3, "yes": True, "nothing": None, "empty": "", "tilde": "~",
                   "mu": "µ = 0,3: #1", "long": "word " * 60, "list": [[1, 2], {"a": [3.5]}], "nested": {"a~b": {"c": 0.1 + 0.2}}}
        path = millscope.save_case(content, self.folder / "again.yaml", force=True)
        self.assertEqual(dict(millscope.load_case(path)), content)
        self.assertNotIn("&", path.read_text(encoding="utf-8"))

    def test_numbers_of_numpy_are_numbers(self):
        shared = [1, 2]
        path = millscope.save_case({"a": numpy.float64(0.1), "b": numpy.float32(0.002), "c": numpy.int64(7), "d": numpy.arange(3.0), "e": numpy.bool_(True),
                                    "f": pathlib.Path("x/y"), "g": shared, "h": shared}, self.folder / "numpy.yaml", force=True)
        self.assertEqual(yaml.safe_load(path.read_text()), {"a": 0.1, "b": 0.002, "c": 7, "d": [0, 1, 2], "e": True, "f": "x/y", "g": [1, 2], "h": [1, 2]})

    def test_every_case_of_the_project_survives(self):
        # That millscope reads the copy as it reads the original is asked of itself, through the liner that it draws of each.
        for name in ("demo", "story/mill", "crosscheck/slice_parametric"):
            with self.subTest(name):
                case = millscope.load_case(SOURCE / f"configs/{name}.yaml")
                (self.folder / "elsewhere").mkdir(exist_ok=True)
                copy = millscope.save_case(case, self.folder / "elsewhere" / "copy.yaml", force=True)
                for file in (SOURCE / f"configs/{name}.yaml", copy):
                    millscope.call("geometry", "export", file, "-o", self.folder / f"{file.stem}.stl", "--force")
                first, second = ((self.folder / f"{file.stem}.stl").read_text() for file in (SOURCE / f"configs/{name}.yaml", copy))
                self.assertEqual(first, second)

    def test_relative_paths_go_along(self):
        case = millscope.load_case(self.write("here/case.yaml", "include: [../materials/glass.yaml]\nstart: {run: first}\nfill: {file: beads.csv}\n"
                                              "geometry: {a: {file: /abs/liner.stl}, b: {file: sub/liner.stl}}\n"))
        (self.folder / "there/deep").mkdir(parents=True, exist_ok=True)
        moved = millscope.load_case(millscope.save_case(case, self.folder / "there/deep/case.yaml", force=True))
        self.assertEqual(moved["include"], ["../../materials/glass.yaml"])
        self.assertEqual(moved["start"], {"run": "../../here/first"})
        self.assertEqual(moved["fill"], {"file": "../../here/beads.csv"})
        self.assertEqual(moved["geometry"], {"a": {"file": "/abs/liner.stl"}, "b": {"file": "../../here/sub/liner.stl"}})
        self.assertEqual(case["fill"], {"file": "beads.csv"})  # the loaded one stays as it was

    def test_paths_of_studies_and_recordings_go_along(self):
        (self.folder / "far").mkdir(exist_ok=True)
        study = self.write("near/study.yaml", "base: case.yaml\nconditions: {a: {recording: a.yaml, set: {geometry.liner.file: l.stl, mill.speed: 60 %critical}}}\n"
                           "observe: {camera: recording}\nbank: {base: 24}\n")
        moved = millscope.load_case(millscope.save_case(millscope.load_case(study), self.folder / "far/study.yaml", force=True))
        self.assertEqual(moved, {"base": "../near/case.yaml", "observe": {"camera": "recording"}, "bank": {"base": 24}, "conditions": {
            "a": {"recording": "../near/a.yaml", "set": {"geometry.liner.file": "../near/l.stl", "mill.speed": "60 %critical"}}}})
        recording = self.write("near/recording.yaml", "files: ['run_*.a', /data/b.a]\ncondition: {geometry: case.yaml, speed: 3 rad/s}\n")
        moved = millscope.load_case(millscope.save_case(millscope.load_case(recording), self.folder / "far/recording.yaml", force=True))
        self.assertEqual(moved, {"files": ["../near/run_*.a", "/data/b.a"], "condition": {"geometry": "../near/case.yaml", "speed": "3 rad/s"}})

    def test_refusals_are_one_line_with_the_place(self):
        for text, line in (("a: 1\nb: 2\na: 3\n", r"loaded\.yaml:3: 'a' is given twice"), ("a: [1\nb: 2\n", r"loaded\.yaml:\d+: is no YAML"),
                           ("- 1\n", r"loaded\.yaml: holds no map"), ("a: !!python/object:x {}\n", r"loaded\.yaml:1: is no YAML")):
            with self.subTest(text), self.assertRaisesRegex(millscope.Error, line) as caught:
                self.load(text)
            self.assertNotIn("\n", str(caught.exception))
        with self.assertRaisesRegex(millscope.Error, "there is no .*nothing.yaml"):
            millscope.load_case(self.folder / "nothing.yaml")

    def test_nothing_is_written_that_no_case_may_hold(self):
        for value, words in ((float("nan"), "nan"), (float("inf"), "inf"), (object(), "cannot hold")):
            with self.subTest(value), self.assertRaisesRegex(millscope.Error, words):
                millscope.save_case({"a": value}, self.folder / "bad.yaml")
            self.assertFalse(list(self.folder.glob("bad.yaml*")))
        with self.assertRaisesRegex(millscope.Error, "no/where.yaml cannot be written .*check that its folder is there"):
            millscope.save_case({"a": 1}, self.folder / "no/where.yaml")
        path = self.write("kept.yaml", "a: 1\n")
        with self.assertRaisesRegex(millscope.Error, "is there already"):
            millscope.save_case({"a": 2}, path)
        self.assertEqual(path.read_text(), "a: 1\n")


if __name__ == "__main__":
    unittest.main()
