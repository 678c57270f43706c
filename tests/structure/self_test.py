#!/usr/bin/env python3
"""The structure check finds each kind of violation in a tiny tree, and nothing in a sound one."""

import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path[:0] = [str(folder) for folder in Path(__file__).resolve().parents[:2]]
import check_structure  # noqa: E402
from small_tree import SmallTreeTest  # noqa: E402

SOUND = {
    "sdk/include/millscope/pack.hpp": "#include <cmath>\n#include \"millscope/abi.hpp\"\n",
    "plugins/laws/mine.cpp": "#include <array>\n#include \"options.hpp\"\n#include \"millscope/pack.hpp\"\n",
    "plugins/laws/options.hpp": "",
    "plugins/CMakeLists.txt": "millscope_add_plugin(mine SOURCES laws/mine.cpp)\n",
    "geometry/mesh.cpp": "#include <fcl/fcl.h>\n#include <unistd.h>\n#include \"geometry/soup.hpp\"\n",
    "kernel/dem/step.cpp": "#include <vector>\n#include \"kernel/config/error.hpp\"\n#include \"millscope/geometry.hpp\"\n",
    "studies/compare.cpp": "#include \"kernel/run/simulation.hpp\"\n",
    "tests/mine_test.cpp": 'TEST_CASE("one, a \\"two\\" (three: [4, 5]),") { f("a; b ["); }\nTEST_CASE("long: "\n          "two lines", "[.slow]") {}\n',
    "app/main.cpp": "#include <boost/program_options.hpp>\n#include \"studies/compare.hpp\"\n",
}

# (file, text, part of the message)
WRONG = [
    ("sdk/include/millscope/a.hpp", "#include \"kernel/dem/lines.hpp\"\n", "sdk may not include kernel/dem/lines.hpp"),
    ("sdk/include/millscope/b.hpp", "#include <fmt/core.h>\n", "sdk may not include fmt/core.h"),
    ("plugins/laws/a.cpp", "#include \"kernel/config/case.hpp\"\n", "plugins may not include"),
    ("plugins/laws/b.cpp", "#include \"geometry/mesh/mesh.hpp\"\n", "plugins may not include"),
    ("plugins/laws/c.cpp", "#include \"../../kernel/dem/lines.hpp\"\n", "plugins may not include"),
    ("plugins/laws/d.cpp", "#include <Eigen/Dense>\n", "plugins may not include"),
    ("geometry/a.cpp", "#include \"kernel/dem/lines.hpp\"\n", "geometry may not include"),
    ("analyzers/a.cpp", "#include \"studies/compare.hpp\"\n", "analyzers may not include"),
    ("kernel/dem/a.cpp", "#include \"geometry/mesh/mesh.hpp\"\n", "kernel/dem may not include"),
    ("kernel/run/a.cpp", "#include \"plugins/laws/options.hpp\"\n", "kernel/run may not include"),
    ("kernel/config/a.cpp", "#include \"kernel/dem/system.hpp\"\n", "kernel/config may not include"),
    ("studies/a.cpp", "#include \"app/commands.hpp\"\n", "studies may not include"),
    ("plugins/deep/CMakeLists.txt", "target_link_libraries(mine_plugin PRIVATE millscope_dem)\n", "no plugin links the kernel"),
    ("docs/a.md", "Look at /" + "home/someone/mill.yaml\n", "a path of one machine"),
    ("tests/a_test.cpp", 'TEST_CASE("one; two") {}\n', "a ; splits it"),
    ("tests/b_test.cpp", 'TEST_CASE("one "\n          "more; two") {}\n', "'one more; two' would never run"),
    ("tests/c_test.cpp", 'TEST_CASE("from [0, 1) on") {}\n', "an unbalanced [ or ]"),
    ("tests/d_test.cpp", 'TEST_CASE("from 0, 1] on") {}\n', "an unbalanced [ or ]"),
    ("tests/e_test.cpp", 'TEST_CASE("a \\\\ b", "[.slow]") {}\n', "a backslash"),
    ("tests/f_test.cpp", 'TEST_CASE("~ about") {}\n', "~ means every other"),
    ("app/a.cpp", "// TO" + "DO later\n", "a marker"),
    ("app/long.cpp", "int x;\n" * 401, "401 lines"),
]


class StructureCheck(SmallTreeTest):
    sound = SOUND

    def test_sound_tree_passes(self):
        self.assertEqual(list(check_structure.check_tree(self.root)), [])

    def test_each_violation_is_found_alone(self):
        for name, text, message in WRONG:
            with self.subTest(name):
                self.write(name, text)
                found = list(check_structure.check_tree(self.root))
                (self.root / name).unlink()
                self.assertEqual(len(found), 1, found)
                self.assertIn(message, found[0])
                self.assertIn(name, found[0])

    def test_link_lines_of_a_build(self):
        self.write("build.ninja", "build lib/millscope/plugins/libgood.so: LINK a.o | lib/libmillscope_shapes.a\n"
                                  "build lib/millscope/plugins/libbad.so: LINK a.o | lib/libmillscope_dem.a\n")
        found = list(check_structure.check_build(self.root))
        self.assertEqual(len(found), 1, found)
        self.assertIn("libbad.so", found[0])


if __name__ == "__main__":
    unittest.main()
