#!/usr/bin/env python3
"""Holds the repository to its architecture: check_structure.py ROOT [--build BUILD]; exit code 1 and one line per violation.

docs/architecture.md says what may use what, and why; tools/include_graph.py reads its table and holds the includes to it.
"""

import argparse
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import include_graph  # noqa: E402
from function_lengths import functions_of  # noqa: E402

PLUGIN_FOLDERS = ("plugins", "geometry", "analyzers")

DIGESTS = "kernel/base/CMakeLists.txt"
# What calibrate chooses, spreads and draws with; what is seen of a simulation does not come from there.
CHOOSING = {"studies/picture", "studies/doe", "studies/emulate", "studies/campaign"}

LONGEST = 400
LONG_FILES = {  # path → why it may be longer
}
LONGEST_FUNCTION = 60
LONG_FUNCTIONS = set()  # (path, name): to be cut; one whose function is short again is a violation, so that the list empties
CODE = {".cpp", ".hpp", ".in", ".py", ".sh"}
TEXT = CODE | {".md", ".yaml", ".yml", ".txt", ".cmake", ".json", ""}
MACHINE_PATH = re.compile(r"(?<![\w.$}>)])/(home|root|work|Users|mnt)/\w")
MARKER = re.compile(r"\b(" + "TO" + "DO|FIX" + r"ME|XX" + r"X)\b")
TEST_CASE = re.compile(r'\bTEST_CASE\s*\(\s*((?:"(?:[^"\\\n]|\\.)*"\s*)+)')  # the name may be several literals
HIDDEN = re.compile(r'"(?:\[[^\]"]*\])*(\[\.[^\]"]*\])')
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')


def kernel_libraries(root):
    """A pattern for the libraries of the kernel's rooms."""
    rooms = [folder.split("/")[1] for folder in include_graph.Table(root).rooms if folder.startswith("kernel/")]
    return r"millscope_(?:%s)\b" % "|".join(rooms)


def check_links(relative, text, libraries):
    if relative.split("/")[0] in PLUGIN_FOLDERS and relative.endswith("CMakeLists.txt"):
        for library in re.findall(libraries, text):
            yield "%s: names %s; no plugin links the kernel" % (relative, library)


def check_text(relative, path, text):
    for number, line in enumerate(text.splitlines(), 1):
        if MACHINE_PATH.search(line):
            yield "%s:%d: a path of one machine: %s" % (relative, number, line.strip()[:80])
        if MARKER.search(line):
            yield "%s:%d: a marker for work to be done: do it, or say in the documentation what is missing" % (relative, number)
    lines = text.count("\n")
    if path.suffix in CODE and lines > LONGEST and relative not in LONG_FILES:
        yield "%s: %d lines, more than %d: split it, or give the reason in LONG_FILES" % (relative, lines, LONGEST)


def long_functions(relative, text):
    """(path, name) → line and length of each function that does not fit a screen."""
    if not relative.endswith((".cpp", ".hpp", ".in")):
        return {}
    return {(relative, name): (line, lines) for name, line, lines in functions_of(text) if lines > LONGEST_FUNCTION}


def check_functions(found):
    for (path, name), (line, lines) in sorted(found.items()):
        if (path, name) not in LONG_FUNCTIONS:
            yield "%s:%d: %s has %d lines, more than %d: cut it where its steps part" % (path, line, name, lines, LONGEST_FUNCTION)
    for path, name in sorted(LONG_FUNCTIONS - set(found)):
        yield "%s: %s has at most %d lines now: take it out of LONG_FUNCTIONS" % (path, name, LONGEST_FUNCTION)


def check_names(relative, text):
    """Names that Catch2's discovery (CatchAddTests.cmake) hands to ctest broken. ctest then asks for a test that is not there, and Catch2
    reports that as passed. The names stand in one CMake list, where only ; [ ] and a backslash mean something; commas are safe."""
    if not relative.endswith((".cpp", ".hpp", ".in")):
        return
    for found in TEST_CASE.finditer(text):
        name = "".join(LITERAL.findall(found.group(1))).replace('\\"', '"')
        if ";" in name:
            why = "a ; splits it into two tests that are not there"
        elif name.count("[") != name.count("]"):
            why = "an unbalanced [ or ] joins it with the names after it"
        elif "\\\\" in name:
            why = "a backslash is an escape to Catch2"
        elif name.startswith("~"):
            why = "~ means every other test"
        else:
            continue
        line = text.count("\n", 0, found.start()) + 1
        yield "%s:%d: the test '%s' would never run: %s; write it otherwise" % (relative, line, name, why)


def check_hidden(relative, text, makefile):
    """Tests that ctest does not see; what nobody runs cannot fail."""
    if relative.startswith("tests/") and relative.endswith(".cpp"):
        for found in HIDDEN.finditer(text):
            if '"%s"' % found.group(1) not in makefile:
                line = text.count("\n", 0, found.start()) + 1
                yield "%s:%d: ctest does not see a test of %s, and no target of the Makefile runs it" % (relative, line, found.group(1))


def check_tree(root):
    root = root.resolve()
    yield from include_graph.faults_of(root)
    libraries, long = kernel_libraries(root), {}
    makefile = (root / "Makefile").read_text(encoding="utf-8") if (root / "Makefile").exists() else ""
    for path in include_graph.files_of(root):
        if path.suffix not in TEXT:
            continue
        relative = path.relative_to(root).as_posix()
        try:
            text = path.read_text(encoding="utf-8")
        except (UnicodeDecodeError, FileNotFoundError):
            continue
        yield from check_links(relative, text, libraries)
        yield from check_names(relative, text)
        yield from check_hidden(relative, text, makefile)
        yield from check_text(relative, path, text)
        long.update(long_functions(relative, text))
    yield from check_functions(long)


def reached(table, room):
    """A room and all that it may use, and what that may use."""
    rooms = {room}
    for used in table.rooms[room].uses:
        rooms |= reached(table, used)
    return rooms


def check_digests(table, text):
    """The folders whose code decides what caches may give (kernel/base/CMakeLists.txt) are those that the numbers come from."""
    def listed(name):
        found = re.search(r"^set\(%s ([^)]*)\)" % name, text, re.M)
        return {folder.removesuffix("/include") for folder in found.group(1).split()} if found else set()

    simulating, observing = listed("simulating_folders"), listed("observing_folders")
    simulated, seen = reached(table, "kernel/run"), reached(table, "studies/calibrate")
    for room in sorted(simulating ^ simulated):
        yield "%s: simulating_folders: %s is one of what kernel/run is made of, and listed, or neither" % (DIGESTS, room)
    for room in sorted(observing - seen):
        yield "%s: observing_folders: studies/calibrate does not use %s; take it out" % (DIGESTS, room)
    for room in sorted(seen - observing - simulated - CHOOSING):
        yield "%s: observing_folders: studies/calibrate uses %s; list it, or say in CHOOSING that no number comes from it" % (DIGESTS, room)


def check_build(root, build):
    """The link lines of the plugins as they are built."""
    ninja = build / "build.ninja"
    statements = re.findall(r"^build (lib/millscope/plugins/\S+\.so): (.*)$", ninja.read_text(), re.M) if ninja.exists() else []
    if not statements:
        yield "%s: no statement that links a plugin; --build takes a build folder that Ninja was configured for" % ninja
    libraries = kernel_libraries(root)
    for plugin, statement in statements:
        found = re.search(r"lib%s\.a" % libraries, statement)
        if found:
            yield "%s links %s; no plugin links the kernel" % (plugin, found.group(0))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("root", type=Path)
    parser.add_argument("--build", type=Path)
    options = parser.parse_args()
    table, digests = include_graph.Table(options.root), (options.root / DIGESTS).read_text(encoding="utf-8")
    violations = list(check_tree(options.root.resolve())) + list(check_digests(table, digests)) + (list(check_build(options.root, options.build)) if options.build else [])
    for violation in violations:
        print(violation)
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
