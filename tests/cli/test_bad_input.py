"""Every refusal: one line, where, why, what to do; exit code 2; nothing written."""
import os
import shutil
import struct
import unittest

from support import CASE, COMMAND, CliTest, pathlib, tree_of


def line_of(text, part):
    """The number of the line of the small case that begins (after blanks) with `part`."""
    return next(k for k, line in enumerate(text.splitlines(), 1) if line.strip().startswith(part))


class Refusals(CliTest):
    def refuse(self, words, *parts, code=2):
        """`run` refuses, `check` says the same, and neither writes anything."""
        before = tree_of(self.folder)
        line = self.assert_one_line(self.millscope("run", "case.yaml", "-o", "out", *words), *parts, code=code)
        self.assertEqual(before, tree_of(self.folder))
        return line

    def refuse_case(self, changes, begins, *parts):
        """The small case with changes; the message names case.yaml and the line that begins with `begins`."""
        self.write_case(*changes)
        text = (self.folder / "case.yaml").read_text()
        line = self.refuse((), rf"case\.yaml:{line_of(text, begins)}: ", *parts)
        self.assertEqual(line, self.assert_one_line(self.millscope("check", "case.yaml")))


class Keys(Refusals):
    def test_unknown_key(self):
        self.refuse_case([("  filling: 30 %", "  fillling: 30 %")], "fillling", "did you mean 'filling'")
        self.refuse_case([("lifters: 6", "lifter: 6")], "lifter:", "did you mean 'lifters'")
        self.refuse_case([("seed: 1", "sede: 1")], "sede", "did you mean 'seed'")
        self.refuse_case([("static_friction: 0.3", "static_frictoin: 0.3")], "default", "static_friction")

    def test_missing_key(self):
        self.refuse_case([("end_s: 0.1, ", "")], "time", "end_s", "e.g.")
        self.refuse_case([("restitution: 0.6, ", "")], "default", "restitution")
        self.refuse_case([("{kind: hertz_mindlin}", "{}")], "law", "kind")

    def test_duplicate_key(self):
        self.refuse_case([("seed: 1\n", "seed: 1\nseed: 2\n")], "seed: 2", "seed", "twice|again|already|duplicate|remove")

    def test_no_yaml(self):
        for text in ("", "{", "- 1\n- 2\n", "time: [1\n", "\t: 1\n", "a: b: c\n", b"\xff\xfe\x00\x01" * 100, b"\0" * 1000, "x: &a [*a, *a]\n"):
            self.write("case.yaml", text)
            self.refuse((), "case.yaml")

    def test_missing_files(self):
        os.remove(self.folder / "materials/hdpe.yaml")
        self.refuse((), r"case\.yaml:3: ", "hdpe.yaml", "path|no such file")
        os.remove(self.folder / "case.yaml")
        self.refuse((), "case.yaml: no such file", "check the path")
        (self.folder / "case.yaml").mkdir()
        self.refuse((), "case.yaml")

    def test_an_endless_include(self):
        self.write_case(("include: [materials", "include: [case.yaml, materials"))
        self.refuse((), "case.yaml")

    def test_set(self):
        for override, parts in {"nonsense": ["path.to.key=value"], "=1": ["path.to.key=value"], "time..end_s=1": ["empty segment"],
                                "time.end=1": ["did you mean 'end_s'"], "geometry.linr.lifters=3": ["did you mean 'liner'"],
                                "time.end_s=[1": ["--set"], "time.end_s.x=1": ["--set", "no keys"], "tme.end_s=1": ["tme|time"]}.items():
            self.refuse(("--set", override), *parts)


class Values(Refusals):
    def test_wrong_unit(self):
        self.refuse_case([("diameter: 8 mm", "diameter: 8 kg")], "glass8", "8 kg", "expected: length")
        self.refuse_case([("end_s: 0.1", "end_s: 100 mm")], "time", "expected: time")
        self.refuse_case([("75 %critical", "75 furlongs")], "mill:", "furlongs")

    def test_out_of_range(self):
        for old, new, begins in (("diameter: 8 mm", "diameter: -8 mm", "glass8"), ("diameter: 8 mm", "diameter: 0", "glass8"),
                                 ("filling: 30 %", "filling: 130 %", "filling"), ("restitution: 0.6", "restitution: 1.6", "default"),
                                 ("restitution: 0.6", "restitution: 0", "default"), ("static_friction: 0.3", "static_friction: -1", "default"),
                                 ("end_s: 0.1", "end_s: 0", "time"), ("analyze_from_s: 0.05", "analyze_from_s: 0.1", "time"),
                                 ("every_s: 0.001", "every_s: 0", "tracks"), ("lifters: 6", "lifters: -6", "lifters"),
                                 ("stiffness_factor: 0.0002", "stiffness_factor: 2", "stiffness_factor"), ("threads: 1", "threads: -1", "run:")):
            self.refuse_case([(old, new)], begins, "must|greater|above|below|at least|between|reach")

    def test_not_a_number(self):
        for word in ("nan", ".nan", "inf", "-.inf", "1e999", "five", "''", "~", "[1]", "{a: 1}", "0x10", "1,5"):
            self.refuse_case([("end_s: 0.1", f"end_s: {word}")], "time", "end_s|finite|decimal")
            self.refuse(("--set", f"fill.filling={word}"))
        self.write_case()
        for word in ("nan", "inf"):
            self.refuse(("--set", f"time.step_s={word}"), "a number is expected")

    def test_poisson_ratio_of_the_study(self):
        glass = self.folder / "materials/glass.yaml"
        text = glass.read_text()
        number = line_of(text, "poisson_ratio")
        lines = text.splitlines()
        lines[number - 1] = lines[number - 1].split(":")[0] + ": 0.76"
        glass.write_text("\n".join(lines) + "\n")
        self.refuse((), rf"glass\.yaml:{number}: ", "0.76", "below 0.5", "no isotropic solid")

    def test_beads_that_cannot_be_followed(self):
        self.refuse_case([("tracks: {beads: 2", "tracks: {beads: [0, 324]")], "tracks", "324", "0 to 323")
        self.refuse_case([("tracks: {beads: 2", "tracks: {beads: [7, 7]")], "tracks", "twice", "once")
        self.refuse_case([("tracks: {beads: 2", "tracks: {beads: 400")], "tracks", "only 324")
        self.refuse_case([("glass8: {material: glass, diameter: 8 mm}", "glass8: {material: glass, diameter: 8 mm, share: 99 %}\n"
                           "  marked: {material: glass, density: 5000, diameter: 8 mm, share: 1 %, tracer: true}"), ("tracks: {beads: 2", "tracks: {beads: 4")],
                         "tracks", "only 1 like", "tracer: true", "larger share")

    def test_beads_that_do_not_fit(self):
        self.refuse_case([("filling: 30 %", "filling: 95 %")], "fill", "only", "fit", "lower the filling")

    def test_beads_too_large_for_the_period(self):
        self.refuse(("--set", "beads.glass8.diameter=12 mm"), "period", "lengthen the slice")

    def test_huge_numbers_of_beads(self):
        self.refuse(("--set", "fill.filling=~", "--set", "fill.count=4000000000"), "fit|memory")
        self.refuse(("--set", "fill.filling=~", "--set", "fill.count=4e12"), "count")

    def test_unstable_time_step(self):
        self.refuse_case([("analyze_from_s: 0.05", "analyze_from_s: 0.05, step_fraction: 0.9")], "time", "90 % of the Rayleigh", "lower")
        self.refuse_case([("analyze_from_s: 0.05", "analyze_from_s: 0.05, step_s: 0.01")], "time", "Rayleigh", "lower")
        self.refuse_case([("analyze_from_s: 0.05", "analyze_from_s: 0.05, step_s: 1e300")], "time", "step_s")


class Plugins(Refusals):
    def test_misspelt_kind(self):
        self.refuse_case([("hertz_mindlin", "hertz_mindlim")], "law", "did you mean 'hertz_mindlin'", "--plugin-dir")
        self.refuse_case([("kind: gravity", "kind: gravty")], "gravity", "did you mean 'gravity'")
        self.refuse_case([("kind: mill\n", "kind: mll\n")], "liner", "did you mean 'mill'")

    def test_missing_kind(self):
        self.refuse_case([("hertz_mindlin", "plastic")], "law", "no contact_law is called 'plastic'", "hertz_mindlin|--plugin-dir")
        self.refuse_case([("kind: gravity", "kind: jkr")], "gravity", "no body_force is called 'jkr'")

    def test_directories(self):
        self.refuse(("--plugin-dir", "nowhere"), "nowhere", "does not exist")
        (self.folder / "empty").mkdir()
        self.refuse(("--plugin-dir", "empty"), "empty", "no plugin")
        self.refuse(("--plugin-dir", "case.yaml"), "case.yaml", "no directory")

    def test_a_directory_that_others_can_write(self):
        library = pathlib.Path(COMMAND).parent.parent / "lib/millscope/plugins/libgravity.so"
        shared = self.folder / "shared"
        shared.mkdir()
        shutil.copy(library, shared / library.name)
        shared.chmod(0o777)
        self.refuse(("--plugin-dir", "shared"), "shared", "others|writ", "chmod")

    def test_no_library(self):
        (self.folder / "fake").mkdir()
        self.write("fake/libfake.so", b"\x7fELF" + b"\0" * 100)
        self.refuse(("--plugin-dir", "fake"), "libfake.so")

    def test_never_from_the_working_directory(self):
        self.write("libfake.so", b"not a library")
        self.succeed("plugins")


class Meshes(Refusals):
    def setUp(self):
        super().setUp()
        text = CASE
        begin, end = text.index("    kind: mill\n"), text.index("    material: hdpe")
        self.text = text[:begin] + "    kind: mesh\n    file: liner.stl\n    unit: m\n    period: 26 mm\n" + text[end:]
        self.succeed("geometry", "export", "case.yaml", "-o", "liner.stl")
        self.succeed("geometry", "export", "case.yaml", "-o", "binary.stl", "--binary")
        self.write("case.yaml", self.text)

    def refuse_mesh(self, *parts):
        self.refuse((), r"case\.yaml:\d+: ", "mesh", *parts)

    def test_the_good_one_is_taken(self):
        self.succeed("check", "case.yaml")

    def test_missing(self):
        os.remove(self.folder / "liner.stl")
        self.refuse_mesh("liner.stl", "check the path")

    def test_empty(self):
        self.write("liner.stl", "")
        self.refuse_mesh("liner.stl", "empty|no triangle|too short")
        self.write("liner.stl", "solid x\nendsolid x\n")
        self.refuse_mesh("liner.stl")

    def test_truncated(self):
        binary = (self.folder / "binary.stl").read_bytes()
        self.write("liner.stl", binary[:len(binary) // 2])
        self.refuse_mesh("liner.stl")

    def test_not_numbers(self):
        text = (self.folder / "liner.stl").read_text()
        at = text.index("vertex") + len("vertex ")
        for word in ("nan", "inf", "1e300"):
            self.write("liner.stl", text[:at] + word + text[text.index(" ", at):])
            self.refuse_mesh("liner.stl")

    def test_a_huge_claim(self):
        binary = bytearray((self.folder / "binary.stl").read_bytes())
        binary[80:84] = struct.pack("<I", 0xFFFFFFFF)
        self.write("liner.stl", bytes(binary))
        self.refuse_mesh("liner.stl")

    def test_rubbish(self):
        for data in (b"\x00" * 200, b"<html></html>", bytes(range(256)) * 40):
            self.write("liner.stl", data)
            self.refuse_mesh("liner.stl")

    def test_wrong_unit(self):
        self.write("case.yaml", self.text.replace("unit: m\n", "unit: mm\n"))
        self.refuse((), "mm|unit|fit|period", "unit|period|lower")


class Places(Refusals):
    def test_a_run_is_there(self):
        self.run_case("out")
        self.refuse((), "not overwritten", "resume", "--force")

    def test_other_files_are_there(self):
        (self.folder / "out").mkdir()
        self.write("out/thesis.tex", "years of work")
        self.refuse((), "not overwritten")
        self.refuse(("--force",), "thesis.tex", "another -o")

    def test_an_empty_directory_is_fine(self):
        (self.folder / "out").mkdir()
        self.run_case("out")

    def test_a_file_is_there(self):
        self.write("out", "")
        self.refuse((), "is a file", "another -o")
        before = tree_of(self.folder)
        self.assert_one_line(self.millscope("run", "case.yaml", "-o", "out/below"), "out", "-o", code=4)
        self.assertEqual(before, tree_of(self.folder))

    def test_a_place_where_nobody_may_write(self):
        self.assert_one_line(self.millscope("run", "case.yaml", "-o", "/proc/out"), "/proc/out", "-o", code=4)
        if os.geteuid() == 0:
            self.skipTest("root may write everywhere else")
        (self.folder / "closed").mkdir(mode=0o500)
        self.assert_one_line(self.millscope("run", "case.yaml", "-o", "closed/out"), "closed/out", "cannot be written", "-o", code=4)

    def test_names_that_are_awkward(self):
        for name in ("with space", "ümläut", "'quoted'", "deep/er/still"):
            self.run_case(name)


if __name__ == "__main__":
    unittest.main()
