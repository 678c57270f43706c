#!/usr/bin/env python3
"""The structure check finds each kind of violation in a tiny tree, and nothing in a sound one."""

import sys
import unittest
from pathlib import Path
from unittest import mock

sys.dont_write_bytecode = True
sys.path[:0] = [str(folder) for folder in Path(__file__).resolve().parents[:2]]
import check_structure  # noqa: E402
import include_graph  # noqa: E402
from function_lengths import functions_of  # noqa: E402
from small_tree import SmallTreeTest  # noqa: E402

PAGE = "docs/architecture.md"
TABLE = """# Architecture

## Rooms and arrows

| room | holds | may use | libraries |
|---|---|---|---|
| `sdk/` | the boundary | | |
| `plugins/` | laws | `sdk` | |
| `geometry/` | walls | | `fcl` |
| `kernel/config` | cases | | |
| `kernel/dem` | the step | `sdk`, `config` | |
| `kernel/run` | runs | `dem` | |
| `studies/compare` | what differs | `run` | |
| `studies/diagnose/naming` | a method | | `Eigen` |
| `studies/diagnose` | what is missing | `naming`, `studies/compare` | |
| `app/` | the command | `compare`, `diagnose` | `boost` |

Not of the table: `kernel/run`.
"""

SOUND = {
    PAGE: TABLE,
    "sdk/include/millscope/pack.hpp": "#include <cmath>\n#include \"millscope/abi.hpp\"\n",
    "plugins/laws/mine.cpp": "#include <array>\n#include \"options.hpp\"\n#include \"millscope/pack.hpp\"\n",
    "plugins/laws/options.hpp": "",
    "plugins/CMakeLists.txt": "millscope_add_plugin(mine SOURCES laws/mine.cpp)\n",
    "geometry/mesh.cpp": "#include <fcl/fcl.h>\n#include <unistd.h>\n#include \"geometry/soup.hpp\"\n",
    "kernel/dem/step.cpp": "#include <vector>\n#include \"kernel/config/error.hpp\"\n#include \"millscope/geometry.hpp\"\n",
    "kernel/config/error.hpp": "",
    "kernel/run/simulation.hpp": "#include \"kernel/dem/step.hpp\"\n",
    "kernel/run/CMakeLists.txt": "",
    "kernel/CMakeLists.txt": "",
    "studies/compare/compare.cpp": "#include \"../../kernel/run/simulation.hpp\"\n",
    "studies/compare/study/study.cpp": "#include \"studies/compare/compare.hpp\"\n",
    "studies/diagnose/diagnosis.cpp": "#include \"naming/naming.hpp\"\n#include \"studies/compare/compare.hpp\"\n",
    "studies/diagnose/naming/naming.hpp": "#include <Eigen/Dense>\n",
    "tests/mine_test.cpp": 'TEST_CASE("one, a \\"two\\" (three: [4, 5]),") { f("a; b ["); }\nTEST_CASE("long: "\n          "two lines", "[x][.slow]") {}\n',
    "Makefile": 'figures:\n\tmine_test "[.slow]"\n',
    "app/main.cpp": "#include <boost/program_options.hpp>\n#include \"studies/compare/compare.hpp\"\n"
                    "#include \"studies/diagnose/outputs.hpp\"\n",
}

# (row as it is, row as it is not, part of the message)
WRONG_ROWS = [
    ("| `sdk`, `config` |", "| `config` |", "kernel/dem may not include millscope/geometry.hpp; it may use kernel/config"),
    ("| `dem` |", "| `dem`, `config` |", "the row of kernel/run allows kernel/config, which nothing there includes"),
    ("| | `fcl` |", "| | `fcl`, `assimp` |", "the row of geometry allows assimp, which nothing there includes"),
    ("| `dem` |", "| `dem`, `report` |", "kernel/run may use report, which is no room of the table"),
    ("| `app/` |", "| `studies/report` | pages | | |\n| `app/` |", "the row of studies/report matches no source"),
    ("| `app/` |", "| `app/` | | | |\n| `app/` |", "app has a row above already"),
    ("| `run` | |", "| `run` |", "a row is | `folder/` | holds | may use | libraries |"),
]

# (file, text, part of the message)
WRONG = [
    ("sdk/include/millscope/a.hpp", "#include \"kernel/dem/lines.hpp\"\n", "sdk may not include kernel/dem/lines.hpp"),
    ("sdk/include/millscope/b.hpp", "#include <fmt/core.h>\n", "sdk may not include fmt/core.h"),
    ("plugins/laws/a.cpp", "#include \"kernel/config/case.hpp\"\n", "plugins may not include"),
    ("plugins/laws/b.cpp", "#include \"geometry/mesh/mesh.hpp\"\n", "plugins may not include"),
    ("plugins/laws/c.cpp", "#include \"../../kernel/dem/lines.hpp\"\n", "plugins may not include"),
    ("plugins/laws/d.cpp", "#include <Eigen/Dense>\n", "plugins may not include"),
    ("geometry/a.cpp", "#include \"kernel/dem/lines.hpp\"\n", "geometry may not include"),
    ("kernel/dem/a.cpp", "#include \"geometry/mesh/mesh.hpp\"\n", "kernel/dem may not include"),
    ("kernel/run/a.cpp", "#include \"plugins/laws/options.hpp\"\n", "kernel/run may not include"),
    ("kernel/config/a.cpp", "#include \"kernel/dem/system.hpp\"\n", "kernel/config may not include"),
    ("kernel/run/c.cpp", "#include <png.h>\n", "kernel/run may not include png.h"),
    ("kernel/run/b.cpp", "#include \"nowhere.hpp\"\n", "kernel/run may not include nowhere.hpp; it may use kernel/dem"),
    ("studies/compare/a.cpp", "#include \"app/commands.hpp\"\n", "studies/compare may not include"),
    ("studies/compare/b.cpp", "#include \"studies/diagnose/outputs.hpp\"\n", "studies/compare may not include"),
    ("studies/compare/c.cpp", "#include <zlib.h>\n", "studies/compare may not include zlib.h"),
    ("studies/diagnose/naming/a.cpp", "#include \"studies/diagnose/diagnosis.hpp\"\n", "studies/diagnose/naming may not include"),
    ("studies/diagnose/a.cpp", "#include <Eigen/Dense>\n", "studies/diagnose may not include"),
    ("analyzers/a.cpp", "", "is a room (analyzers/a.cpp) without a row"),
    ("studies/a.cpp", "#include \"app/commands.hpp\"\n", "is a room (studies/a.cpp) without a row"),
    ("studies/new/a.cpp", "", "is a room (studies/new/a.cpp) without a row"),
    ("studies/diagnose/bank/a.cpp", "", "is a room (studies/diagnose/bank/a.cpp) without a row"),
    ("kernel/base/CMakeLists.txt", "", "is a room (kernel/base/CMakeLists.txt) without a row"),
    ("studies/compare/deep/CMakeLists.txt", "", "is a room (studies/compare/deep/CMakeLists.txt) without a row"),
    ("geometry/CMakeLists.txt", "target_link_libraries(mine_plugin PRIVATE millscope_dem)\n", "no plugin links the kernel"),
    ("docs/a.md", "Look at /" + "home/someone/mill.yaml\n", "a path of one machine"),
    ("tests/a_test.cpp", 'TEST_CASE("one; two") {}\n', "a ; splits it"),
    ("tests/b_test.cpp", 'TEST_CASE("one "\n          "more; two") {}\n', "'one more; two' would never run"),
    ("tests/c_test.cpp", 'TEST_CASE("from [0, 1) on") {}\n', "an unbalanced [ or ]"),
    ("tests/d_test.cpp", 'TEST_CASE("from 0, 1] on") {}\n', "an unbalanced [ or ]"),
    ("tests/e_test.cpp", 'TEST_CASE("a \\\\ b", "[.slow]") {}\n', "a backslash"),
    ("tests/f_test.cpp", 'TEST_CASE("~ about") {}\n', "~ means every other"),
    ("tests/g_test.cpp", 'TEST_CASE("a", "[.quick]") {}\n', "no target of the Makefile runs it"),
    ("app/a.cpp", "// TO" + "DO later\n", "a marker"),
    ("app/b.cpp", "int f(int x) {\n" + "  ++x;\n" * 59 + "}\n", "app/b.cpp:1: f has 61 lines"),
    ("app/long.cpp", "int x;\n" * 401, "401 lines"),
]


# Each function of it and its number of lines.
FUNCTIONS = [("f", 1), ("g", 2), ("Pool::Pool", 5), ("~Small", 1), ("operator()", 1), ("operator==", 1), ("h", 4), ("TEST_CASE", 3)]
FUNCTIONS_TEXT = """
#define OPEN(x) \\
  { (
namespace a::b {
template <class T, class U = std::vector<T>>
struct [[gnu::aligned(64)]] Pool final : public Base<T> {
  int size = f(1), rows[2] = {1, g(2)};
  int f() const { return size; }  // {
  std::vector<int> g(const char* text = "({")
  noexcept { return {'{', 1'000}; }
};
const std::map<int, F> kTable = {
    {1, f(1)},
};
Pool::Pool(int n)
    : size_{n},
      each_(n, [](int x) { return x; }), other_(Point{1}.x) {
  for (int i = 0; i < n; ++i) { f(i); }
}
struct Small { ~Small() { /* { */ } bool operator()(int x) { return x; } bool operator==(Small) const { return true; } };
template <class T>
auto h(T x) -> std::pair<int, int> requires(sizeof(T) > 1) {
  auto raw = R"x({ ")x";
  return {x, x};
}
int declared(int x);
}  // namespace a::b
TEST_CASE("one {", "[.slow]") {
  CHECK(1);
}
"""


class FunctionLengths(unittest.TestCase):
    def test_functions_of_a_text(self):
        self.assertEqual([(name, lines) for name, _, lines in functions_of(FUNCTIONS_TEXT)], FUNCTIONS)


class StructureCheck(SmallTreeTest):
    sound = SOUND

    def setUp(self):
        super().setUp()
        self.enterContext(mock.patch.object(check_structure, "LONG_FUNCTIONS", set()))

    def test_an_exception_that_is_not_needed_is_a_violation(self):
        self.write("app/b.cpp", "int f(int x) {\n" + "  ++x;\n" * 59 + "}\n")
        with mock.patch.object(check_structure, "LONG_FUNCTIONS", {("app/b.cpp", "f")}):
            self.assertEqual(list(check_structure.check_tree(self.root)), [])
            self.write("app/b.cpp", "int f(int x) {}\n")
            self.assertEqual(list(check_structure.check_tree(self.root)), ["app/b.cpp: f has at most 60 lines now: take it out of LONG_FUNCTIONS"])

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

    def test_each_wrong_row_is_found(self):
        for row, wrong, message in WRONG_ROWS:
            with self.subTest(wrong):
                self.assertEqual(TABLE.count(row), 1)
                self.write(PAGE, TABLE.replace(row, wrong))
                found = list(check_structure.check_tree(self.root))
                self.assertTrue(any(message in line for line in found), found)

    def test_a_page_without_table_is_a_violation(self):
        for page in ("", TABLE.replace("## Rooms", "## Halls")):
            self.write(PAGE, page)
            self.assertIn("no table behind '## Rooms and arrows'", next(check_structure.check_tree(self.root)))

    def test_two_rooms_that_need_each_other_fit_no_order_of_rows(self):
        self.write("kernel/dem/back.cpp", "#include \"kernel/run/simulation.hpp\"\n")
        self.write(PAGE, TABLE.replace("| `sdk`, `config` |", "| `sdk`, `config`, `run` |"))
        found = list(check_structure.check_tree(self.root))
        self.assertEqual(len(found), 1, found)
        self.assertIn("kernel/dem may use run, whose row does not stand above its own", found[0])

    def test_the_folders_that_caches_go_by_are_those_of_the_rooms(self):
        self.write(PAGE, TABLE.replace("| `studies/compare` | what differs | `run` | |",
                                       "| `studies/recording` | reads | `run` | |\n| `studies/doe` | plans | | |\n"
                                       "| `studies/calibrate` | fits | `doe`, `recording` | |\n| `studies/compare` | what differs | `run` | |"))
        table = include_graph.Table(self.root)
        right = "set(simulating_folders sdk/include kernel/config kernel/dem kernel/run)\nset(observing_folders studies/recording studies/calibrate)\n"
        self.assertEqual(list(check_structure.check_digests(table, right)), [])
        for old, new, message in [(" kernel/dem", "", "simulating_folders: kernel/dem is"), ("kernel/run)", "kernel/run app)", "simulating_folders: app is"),
                                  (" studies/recording", "", "uses studies/recording; list it"),
                                  ("studies/calibrate)", "studies/calibrate studies/compare)", "does not use studies/compare; take it out")]:
            found = list(check_structure.check_digests(table, right.replace(old, new)))
            self.assertEqual(len(found), 1, found)
            self.assertIn(message, found[0])

    def test_a_cycle_is_found(self):
        graph = {"app": ["run"], "run": ["dem", "output"], "dem": ["config"], "output": ["config", "run"], "config": []}
        self.assertEqual(include_graph.find_cycle(graph), ["output", "run", "output"])
        graph["output"] = ["config"]
        self.assertEqual(include_graph.find_cycle(graph), [])

    def test_link_lines_of_a_build(self):
        good = "build lib/millscope/plugins/libgood.so: LINK a.o | lib/libmillscope_shapes.a\n"
        self.write("build.ninja", good + "build lib/millscope/plugins/libbad.so: LINK a.o | lib/libmillscope_dem.a\n")
        found = list(check_structure.check_build(self.root, self.root))
        self.assertEqual(len(found), 1, found)
        self.assertIn("libbad.so", found[0])
        self.write("build.ninja", good)
        self.assertEqual(list(check_structure.check_build(self.root, self.root)), [])

    def test_a_build_without_plugins_is_a_violation(self):
        self.assertIn("no statement that links a plugin", next(check_structure.check_build(self.root, self.root)))
        self.write("build.ninja", "build lib/libmillscope_dem.a: LINK a.o\n")
        self.assertIn("no statement that links a plugin", next(check_structure.check_build(self.root, self.root)))


if __name__ == "__main__":
    unittest.main()
