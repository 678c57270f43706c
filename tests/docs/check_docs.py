#!/usr/bin/env python3
"""Holds the documentation to the repository: check_docs.py ROOT --millscope COMMAND; exit code 1 and one line per fault.

- every relative link leads to a file, and its anchor to a heading of that file, on a forge as on the site of `make docs`;
- every `millscope COMMAND ACTION --option` is one that the command's own --help knows;
- every command has its row in docs/commands.md;
- every configs/… path is there, or a page writes it with -o;
- every page of docs/ is in the navigation of mkdocs.yml, and nothing else is;
- every folder of tests/ has its place in the table of CONTRIBUTING.md, and nothing else has.
"""

import argparse
import re
import shlex
import subprocess
import sys
from pathlib import Path

LINK = re.compile(r"(?<!!)\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^()\s]+(?:\([^()]*\))?)\)|!\[[^\]]*\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#{1,6}\s+(.*?)\s*#*$")
CONFIG = re.compile(r"(?<![\w/.])(?:\.\./)?(configs/[\w./{},*-]*[\w/}*])")
WRITTEN = re.compile(r"-o\s+(configs/[\w./-]+)")
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]*")
SPAN = re.compile(r"(`+)(.+?)\1")
HIDDEN = ("manual",)  # commands that work and are not in the list of `millscope --help`
FORMATS = {"millscope " + name for name in ("frames", "tracks", "archive", "results")}  # what HDF5 files call themselves
# Programs other than millscope whose options pages mention.
OTHERS = ("cmake", "ctest", "make", "git", "python3", "apt-get", "tools/", "bench/", "build/", "millscope_", "sbatch", "column", "docker", "mkdocs")


class Help:
    """What `millscope --help` and the pages below it say: commands, actions, options."""

    def __init__(self, ask):
        """`ask(words)` returns the page of `millscope WORDS --help`."""
        self.commands = self.named(ask([]))
        self.options, self.actions = {}, {}
        for command in self.commands + [name for name in HIDDEN if self.answers(ask, name)]:
            page = ask([command])
            if re.search(r"^usage: .* ACTION …", page, re.M):
                self.actions[command] = self.named(page)
                for action in self.actions[command]:
                    self.options[command, action] = set(OPTION.findall(ask([command, action])))
            else:
                listed = re.search(r"^  ACTION\s+(.*)$", page, re.M)
                self.actions[command] = re.findall(r"[a-z]+", listed.group(1).replace(" or ", " ")) if listed else []
                for action in [None] + self.actions[command]:
                    self.options[command, action] = set(OPTION.findall(page))
        self.every = set().union(*self.options.values()) | {"--help", "--version"}

    @staticmethod
    def answers(ask, name):
        try:
            return bool(ask([name]))
        except (subprocess.CalledProcessError, KeyError):
            return False

    @staticmethod
    def named(page):
        """The words of a list, which ends before the line that points to the other pages."""
        return re.findall(r"^  ([a-z]+) +\S", re.split(r"^'millscope ", page, flags=re.M)[0], re.M)


def ask_command(command):
    def ask(words):
        return subprocess.run([command, *words, "--help"], capture_output=True, text=True, check=True).stdout
    return ask


def lines_of(text):
    """(number, line, is code) of a page; commands that go on after a backslash are one line."""
    fenced, joined, start = False, "", 0
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
            continue
        code = fenced or line.startswith("    ")
        if code and line.endswith("\\"):
            joined, start = joined + line[:-1] + " ", start or number
            continue
        yield start or number, joined + line, code
        joined, start = "", 0


def plain(heading):
    """A heading's text without its markup."""
    heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    return heading.replace("`", "").replace("*", "")


def anchors_of(text):
    """Anchors that both kinds of page have: those of a forge and those of the site."""
    forge, site = {}, {}
    for _, line, code in lines_of(text):
        found = None if code else HEADING.match(line)
        if not found:
            continue
        kept = re.sub(r"[^\w\s-]", "", plain(found.group(1)).strip().lower())
        for names, slug, between in ((forge, re.sub(r"\s", "-", kept), "-"), (site, re.sub(r"[\s-]+", "-", kept), "_")):
            count = names.setdefault(slug, 0)
            names[slug] += 1
            if count:
                names[slug + between + str(count)] = 1
    return set(forge) & set(site)


def check_links(root, page, text):
    for number, line, code in lines_of(text):
        if code:
            continue
        for found in LINK.finditer(line):
            target = found.group(1) or found.group(2)
            if re.match(r"[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            file = (page.parent / path).resolve() if path else page
            where = f"{page.relative_to(root)}:{number}: link to {target}"
            if not file.is_relative_to(root) or not file.exists():
                yield f"{where}: there is no such file; paths are relative to the page"
            elif anchor and file.suffix == ".md" and anchor not in anchors_of(file.read_text(encoding="utf-8")):
                yield f"{where}: {file.relative_to(root)} has no such heading, or its anchor differs between forge and site"


def command_words(text):
    """The words of a command line, cut at what the shell would begin another one with; None where quotes do not close."""
    text = re.split(r"\s#\s|\s#$", text)[0]
    try:
        lexer = shlex.shlex(text, posix=True, punctuation_chars="|;&<>()")
        lexer.whitespace_split, lexer.commenters = True, ""
        words = list(lexer)
    except ValueError:
        words = text.split()
    return words


def commands_in(text):
    """Lists of words, each beginning behind `millscope`."""
    words, found = command_words(text), []
    for k, word in enumerate(words):
        if word == "millscope" or word.endswith("bin/millscope"):
            found.append([])
        elif found and re.fullmatch(r"[|;&<>()]+", word):
            found.append(None)
        elif found and found[-1] is not None:
            found[-1].append(word)
    return [words for words in found if words]


def check_command(words, help_pages, where):
    command = words[0]
    if command.startswith("-") or not re.fullmatch(r"[a-z]+", command):
        return
    if command not in help_pages.actions:
        yield f"{where}: 'millscope {command}' is no command; known: {', '.join(help_pages.commands)}"
        return
    actions, action = help_pages.actions[command], None
    if actions and len(words) > 1 and re.fullmatch(r"[a-z|]+", words[1]):
        for action in words[1].split("|"):
            if action not in actions:
                yield f"{where}: 'millscope {command} {action}' is no action; known: {', '.join(actions)}"
                return
    known = help_pages.options.get((command, action)) or set().union(*(o for (c, _), o in help_pages.options.items() if c == command))
    for word in words[1:]:
        option = OPTION.match(word)
        if option and option.group(0) not in known | {"--help"}:
            yield f"{where}: 'millscope {command}' has no {option.group(0)}; see 'millscope {command} --help'"


def check_row(line, spans, help_pages, where):
    """A row of a table that begins with a command lists that command's options."""
    first = re.match(r"\|\s*`(?:millscope )?([a-z]+)\b", line)
    if not first or first.group(1) not in help_pages.commands or f"`millscope {first.group(1)}`" in line:
        return
    for span in spans[1:]:
        if span.startswith("--"):
            action = next(iter(re.findall(r"^(?:millscope )?[a-z]+ ([a-z|\\]+)", spans[0])), "").replace("\\", "")
            yield from check_command([first.group(1), *([action] if action else []), *span.split()], help_pages, where)


def check_commands(name, text, help_pages):
    for number, line, code in lines_of(text):
        where = f"{name}:{number}"
        spans = [line.strip()] if code else [s.group(2) for s in SPAN.finditer(line)]
        yield from check_row(line, spans, help_pages, where)
        for span in spans:
            found = [] if span in FORMATS else commands_in(span)
            for words in found:
                yield from check_command(words, help_pages, where)
            if found or any(w.startswith(OTHERS) for w in span.split()):
                continue
            for option in OPTION.findall(re.sub(r"\"[^\"]*\"|'[^']*'", "", span)):
                if option not in help_pages.every:
                    yield f"{where}: no command of millscope has {option}"


def check_configs(root, name, text, written):
    for number, line, _ in lines_of(text):
        for path in CONFIG.findall(line):
            choices = re.search(r"\{([^}]*)\}", path)
            for one in [path.replace(choices.group(0), c) for c in choices.group(1).split(",")] if choices else [path]:
                if one not in written and not any(root.glob(one.rstrip("/"))):
                    yield f"{name}:{number}: there is no {one}"


def check_navigation(root):
    text = (root / "mkdocs.yml").read_text(encoding="utf-8")
    listed = set(re.findall(r":\s+([\w/.-]+\.md)\s*$", text, re.M))
    there = {p.relative_to(root / "docs").as_posix() for p in (root / "docs").rglob("*.md")}
    for page in sorted(there - listed):
        yield f"mkdocs.yml: docs/{page} is not in nav; add it to a group"
    for page in sorted(listed - there):
        if not (root / page).exists():
            yield f"mkdocs.yml: nav has {page}, which is not in docs/; remove it or write it"


def check_listed(root, help_pages):
    page = root / "docs/commands.md"
    rows = page.read_text(encoding="utf-8") if page.exists() else ""
    for command in help_pages.commands:
        if not re.search(rf"^\| (?:`[^`]*`, )*`{command}\b", rows, re.M):
            yield f"docs/commands.md: 'millscope {command}' has no row in the table; add one"


def check_areas(root):
    """The table of tests names every area, one or more in a row."""
    page = root / "CONTRIBUTING.md"
    rows = [line for line in page.read_text(encoding="utf-8").splitlines() if line.startswith("|")] if page.exists() else []
    listed = {area for row in rows for area in re.findall(r"`tests/(\w+)`", row)}
    there = {p.parent.name for p in (root / "tests").glob("*/CMakeLists.txt")}
    for area in sorted(there - listed):
        yield f"CONTRIBUTING.md: tests/{area} is not in the table of tests; say there what it is about"
    for area in sorted(listed - there):
        yield f"CONTRIBUTING.md: the table of tests has tests/{area}, which is not there"


def pages_of(root):
    named = [root / n for n in ("README.md", "CONTRIBUTING.md", "configs/README.md")]
    return [p for p in named if p.exists()] + sorted((root / "docs").rglob("*.md"))


def check_all(root, help_pages):
    root = root.resolve()
    texts = {page: page.read_text(encoding="utf-8") for page in pages_of(root)}
    written = {path for text in texts.values() for path in WRITTEN.findall(text)}
    for page, text in texts.items():
        name = page.relative_to(root).as_posix()
        yield from check_links(root, page, text)
        yield from check_commands(name, text, help_pages)
        yield from check_configs(root, name, text, written)
    yield from check_navigation(root)
    yield from check_listed(root, help_pages)
    yield from check_areas(root)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", type=Path)
    parser.add_argument("--millscope", required=True, help="the command whose --help counts")
    arguments = parser.parse_args()
    faults = list(check_all(arguments.root, Help(ask_command(arguments.millscope))))
    for fault in faults:
        print(fault)
    pages = len(pages_of(arguments.root))
    print(f"{pages} pages, {len(faults)} faults" if pages else "no pages")
    return 1 if faults or not pages else 0


if __name__ == "__main__":
    sys.exit(main())
