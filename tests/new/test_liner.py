"""`millscope new --liner`: a mesh of one's own becomes a mill, or is refused with a remedy."""
import math
import os
import re
import shutil
import unittest

from support import CASE, CliTest, tree_of

NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")
BEADS = ("--bead-size", "8 mm")


def moved(stl, change):
    """The text of an ASCII STL with every vertex changed."""
    def line(text):
        if not text.strip().startswith("vertex"):
            return text
        return "vertex %.9g %.9g %.9g" % change(*map(float, NUMBER.findall(text)))
    return "\n".join(map(line, stl.splitlines())) + "\n"


class Liner(CliTest):
    def setUp(self):
        super().setUp()
        self.succeed("geometry", "export", "case.yaml", "-o", "liner.stl")  # 150 mm, six lifters, 26 mm long, open ends, in metres
        self.stl = (self.folder / "liner.stl").read_text(encoding="utf-8")

    def case(self, name="my_mill"):
        return (self.folder / name / "case.yaml").read_text(encoding="utf-8")

    def refuse(self, *words, parts):
        before = tree_of(self.folder)
        self.assert_one_line(self.millscope("new", "my_mill", *words), *parts)
        self.assertEqual(before, tree_of(self.folder))

    def test_size_from_the_mesh_and_a_copy_of_it(self):
        text = self.succeed("new", "my_mill", "--liner", "liner.stl", "--liner-unit", "m", *BEADS).stdout
        os.remove(self.folder / "liner.stl")
        shutil.move(self.folder / "my_mill", self.folder / "moved")
        self.assertEqual(re.search(r"^beads +(\d+)", self.succeed("check", "moved/case.yaml").stdout, re.M).group(1),
                         re.search(r"^beads +(\d+)", text, re.M).group(1))
        case = self.case("moved")
        for line in ("diameter: 150 mm", "length: 26 mm", "unit: m ", "period: 0.026 ", "z: [0, 0.026]"):
            self.assertIn(line, case)
        summary = self.run_case("out", "--set", "time.end_s=0.02", "--set", "time.analyze_from_s=0.01", case="moved/case.yaml")
        self.assertGreater(summary["particles"], 100)

    def test_end_faces_for_a_mesh_without(self):
        self.succeed("new", "my_mill", "--liner", "liner.stl", "--liner-unit", "m", "--ends", "closed", *BEADS)
        case = self.case()
        self.assertEqual(case.count("kind: plane"), 2)
        self.assertNotIn("periodic:", case)
        self.run_case("out", "--set", "time.end_s=0.1", "--set", "time.analyze_from_s=0.05", case="my_mill/case.yaml")  # loses no bead

    def test_a_mesh_with_end_faces_is_closed(self):
        self.write("closed.yaml", CASE.replace("    lifters: 6\n", "    lifters: 6\n    end_faces: true\n").replace("domain:\n  periodic: {z: [0, 26 mm]}\n", ""))
        self.succeed("geometry", "export", "closed.yaml", "-o", "closed.stl")
        self.succeed("new", "my_mill", "--liner", "closed.stl", "--liner-unit", "m", *BEADS)
        self.assertNotIn("plane", self.case())
        self.assertNotIn("periodic:", self.case())
        shutil.rmtree(self.folder / "my_mill")
        self.refuse("--liner", "closed.stl", "--liner-unit", "m", "--ends", "periodic", parts=("the liner has an end wall", "--ends closed"))

    def test_an_axis_elsewhere_is_found(self):
        self.write("away.stl", moved(self.stl, lambda x, y, z: (1000 * z + 40, 1000 * x - 900, 1000 * y + 70)))
        self.succeed("new", "my_mill", "--liner", "away.stl", "--liner-unit", "mm", *BEADS)
        for line in ("axis: auto", "centre: true", "diameter: 150 mm"):
            self.assertIn(line, self.case())
        self.succeed("check", "my_mill/case.yaml")

    def test_what_is_no_liner(self):
        self.refuse("--liner", "nowhere.stl", "--liner-unit", "m", parts=("nowhere.stl",))
        self.write("cut.stl", self.stl[:len(self.stl) // 2])
        self.refuse("--liner", "cut.stl", "--liner-unit", "m", parts=("cut.stl",))
        self.write("text.stl", "not a mesh")
        self.refuse("--liner", "text.stl", "--liner-unit", "m", parts=("text.stl",))
        self.refuse("--liner", "case.yaml", "--liner-unit", "m", parts=("case.yaml",))

    def test_lengths_of_many_digits(self):
        self.write("odd.stl", moved(self.stl, lambda x, y, z: (1.0237 * x, 1.0237 * y, 1.027 * z)))
        self.succeed("new", "my_mill", "--liner", "odd.stl", "--liner-unit", "m", *BEADS)
        self.assertIn("length: 26.702 mm", self.case())

    def test_one_segment_of_a_liner(self):
        kept = [facet for facet in re.findall(r"facet.*?endfacet", self.stl, re.S)
                if all(abs(math.atan2(float(y), float(x))) < 0.5 for x, y in re.findall(r"vertex (\S+) (\S+) \S+", facet))]
        self.assertGreater(len(kept), 10)
        self.write("segment.stl", "solid shell\n" + "\n".join(kept) + "\nendsolid shell\n")
        self.refuse("--liner", "segment.stl", "--liner-unit", "m", parts=("segment.stl", "no ring round an axis", "repeat"))

    def test_the_unit(self):
        self.refuse("--liner", "liner.stl", parts=("--liner-unit is missing", "mm, cm, m or inch"))
        self.refuse("--liner", "liner.stl", "--liner-unit", "furlong", parts=("--liner-unit 'furlong'", "known: mm, m, cm, inch"))
        self.refuse("--liner", "liner.stl", "--liner-unit", "mm", parts=("liner.stl",))
        self.refuse("--liner-unit", "mm", parts=("there is no --liner",))

    def test_sizes_that_are_not_the_meshs(self):
        self.refuse("--liner", "liner.stl", "--liner-unit", "m", "--diameter", "300 mm", parts=("--diameter 300 mm: the liner's diameter is 150 mm",))
        self.refuse("--liner", "liner.stl", "--liner-unit", "m", *BEADS, "--length", "50 mm", parts=("--length 50 mm: the liner's length is 26 mm",))
        self.refuse("--liner", "liner.stl", "--liner-unit", "m", "--lifters", "8", parts=("--lifters: the lifters are in the liner's file",))

    def test_a_step_drawing(self):
        if " step " not in self.succeed("plugins").stdout:
            self.skipTest("this test is skipped: millscope was built without OpenCASCADE")
        drawing = os.path.join(os.environ["MILLSCOPE_SOURCE_DIR"], "examples/liner.step")
        self.refuse("--liner", drawing, "--liner-unit", "mm", parts=("--liner-unit: ", "says its unit itself"))
        self.succeed("new", "my_mill", "--liner", drawing, "--bead-size", "16 mm")
        case = self.case()
        for line in ("diameter: 300 mm", "length: 80 mm", "kind: step", "period: 0.08 "):
            self.assertIn(line, case)
        self.assertNotIn("unit:", case)
        self.assertTrue((self.folder / "my_mill/liner.step").exists())
        summary = self.run_case("out", "--set", "time.end_s=0.02", "--set", "time.analyze_from_s=0.01", case="my_mill/case.yaml")
        self.assertGreater(summary["particles"], 100)
        self.assertIn("solids: 2 (lifter, shell)", self.succeed("geometry", "report", drawing).stdout)

    def test_names_of_files(self):
        name = 'my "liner": #1.stl'
        shutil.copy(self.folder / "liner.stl", self.folder / name)
        self.succeed("new", "my_mill", "--liner", name, "--liner-unit", "m", *BEADS)
        self.assertTrue((self.folder / "my_mill/liner.stl").exists())


if __name__ == "__main__":
    unittest.main()
