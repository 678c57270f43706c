#!/usr/bin/env python3
"""Holds the repository to its architecture: check_structure.py ROOT [--build BUILD]; exit code 1 and one line per violation.

docs/architecture.md says what may use what, and why.
"""

import argparse
import re
import subprocess
import sys
from pathlib import Path

KERNEL_LIBRARIES = ("config", "host", "dem", "output", "run")
SYSTEM_HEADER = re.compile(r"(sys/|experimental/)?[a-z0-9_]+(\.h)?")  # <vector>, <unistd.h>, <sys/stat.h>
NOT_SYSTEM = {"hdf5.h"}

# Folder → (beginnings of project headers it may include, libraries it may include beside the standard ones; None: any).
MAY_INCLUDE = {
    "sdk": (("millscope/",), ()),
    "plugins": (("millscope/", "plugins/"), ()),
    "analyzers": (("millscope/", "analyzers/"), ()),
    "geometry": (("millscope/", "geometry/"), ("assimp/", "fcl/", "Eigen/")),
    "kernel/config": (("millscope/", "kernel/config/"), ("fmt/", "nlohmann/", "yaml-cpp/")),
    "kernel/host": (("millscope/", "kernel/config/", "kernel/host/"), ("fmt/", "nlohmann/", "boost/dll")),
    "kernel/dem": (("millscope/", "kernel/config/", "kernel/dem/"), ("fmt/",)),
    "kernel/output": (("millscope/", "kernel/config/", "kernel/output/"), ("fmt/", "nlohmann/", "hdf5.h", "hdf5/")),
    "kernel/run": (("millscope/", "kernel/"), ("fmt/", "nlohmann/")),
    "studies": (("millscope/", "kernel/", "studies/"), None),
    "app": (("millscope/", "kernel/", "studies/", "app/"), None),
}
PLUGIN_FOLDERS = ("plugins", "geometry", "analyzers")

LONGEST = 400
LONG_FILES = {  # path → why it may be longer
}
CODE = {".cpp", ".hpp", ".in", ".py", ".sh"}
TEXT = CODE | {".md", ".yaml", ".yml", ".txt", ".cmake", ".json", ""}
MACHINE_PATH = re.compile(r"(?<![\w.$}>)])/(home|root|work|Users|mnt)/\w")
MARKER = re.compile(r"\b(" + "TO" + "DO|FIX" + r"ME|XX" + r"X)\b")
INCLUDE = re.compile(r'^\s*#\s*include\s+(["<])([^">]+)[">]', re.M)
TEST_CASE = re.compile(r'\bTEST_CASE\s*\(\s*((?:"(?:[^"\\\n]|\\.)*"\s*)+)')  # the name may be several literals
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')


def files_of(root):
    """What git tracks; in a tree without git, everything but builds."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=root, capture_output=True) if (root / ".git").exists() else None
    if listed is not None and listed.returncode == 0:
        paths = [root / p for p in listed.stdout.decode().split("\0") if p]
    else:
        paths = [p for p in root.rglob("*") if p.relative_to(root).parts[0] not in ("build", ".git")]
    return sorted(p for p in paths if p.is_file() and p.suffix in TEXT)


def folder_of(relative):
    return next((f for f in MAY_INCLUDE if relative.startswith(f + "/")), None)


def is_standard(header):
    return SYSTEM_HEADER.fullmatch(header) is not None and header not in NOT_SYSTEM


def check_includes(root, relative, text):
    folder, here = folder_of(relative), (root / relative).parent
    if folder is None or not relative.endswith((".cpp", ".hpp", ".in")):
        return
    project, libraries = MAY_INCLUDE[folder]
    for found in INCLUDE.finditer(text):
        mark, header = found.groups()
        if mark == "<":
            allowed = is_standard(header) or libraries is None or any(header.startswith(library) for library in libraries)
        else:
            beside = (here / header).resolve()  # named relative to the including file
            own = beside.exists() and beside.is_relative_to(root) and folder_of(beside.relative_to(root).as_posix()) == folder
            allowed = own or header.startswith(project)
        if not allowed:
            line = text.count("\n", 0, found.start(1)) + 1
            yield "%s:%d: %s may not include %s; it may use %s" % (relative, line, folder, header, ", ".join(project + (libraries or ())))


def check_links(relative, text):
    if relative.split("/")[0] in PLUGIN_FOLDERS and relative.endswith("CMakeLists.txt"):
        for library in re.findall(r"millscope_(?:%s)\b" % "|".join(KERNEL_LIBRARIES), text):
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


def check_tree(root):
    root = root.resolve()
    for path in files_of(root):
        relative = path.relative_to(root).as_posix()
        try:
            text = path.read_text(encoding="utf-8")
        except (UnicodeDecodeError, FileNotFoundError):
            continue
        yield from check_includes(root, relative, text)
        yield from check_links(relative, text)
        yield from check_names(relative, text)
        yield from check_text(relative, path, text)


def check_build(build):
    """The link lines of the plugins as they are built."""
    ninja = build / "build.ninja"
    if not ninja.exists():
        return
    for statement in re.findall(r"^build (lib/millscope/plugins/\S+\.so): (.*)$", ninja.read_text(), re.M):
        found = re.search(r"libmillscope_(?:%s)\.a" % "|".join(KERNEL_LIBRARIES), statement[1])
        if found:
            yield "%s links %s; no plugin links the kernel" % (statement[0], found.group(0))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("root", type=Path)
    parser.add_argument("--build", type=Path)
    options = parser.parse_args()
    violations = list(check_tree(options.root.resolve())) + (list(check_build(options.build)) if options.build else [])
    for violation in violations:
        print(violation)
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
