"""Functions of C++ sources and how many lines they have, by counting braces. No compiler: what a macro hides is not seen."""

import re

# Comments, strings and characters: braces in them do not count. Between R"x( and )x" a quote means nothing.
DEAF = re.compile(r"""//[^\n]*|/\*.*?\*/|\bR"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"|"(?:[^"\\\n]|\\.)*"|(?<![0-9a-fA-F])'(?:[^'\\\n]|\\.)+'"""
                  r"""|^[ \t]*\#(?:[^\n]*\\\n)*[^\n]*""", re.S | re.M)
TEMPLATE = re.compile(r"\btemplate\s*<(?:[^<>]|<[^<>]*>)*>")
CONTAINER = re.compile(r"\b(?:namespace|class|struct|union|enum|extern)\b[^()=]*(?:\([^()]*\)[^()=]*)?$")
NAME = re.compile(r"((?:~?\w+\s*::\s*)*(?:operator\s*\(\s*\)|operator\s*[^\s\w(]+|~?\w+))\s*\(")


def blank(match):
    """Spaces for what a pattern found, its lines kept."""
    return re.sub(r"[^\n]", " ", match.group(0))


def closing(text, opening):
    """Where the brace at `opening` is closed."""
    depth = 0
    for found in re.compile(r"[{}]").finditer(text, opening):
        depth += 1 if found.group(0) == "{" else -1
        if depth == 0:
            return found.start()
    return len(text)


def functions_of(text):
    """(name, line of the name, lines to the closing brace) of each function; one inside another counts as part of the outer."""
    text = TEMPLATE.sub(blank, DEAF.sub(blank, text))
    start, at = 0, 0  # of the words before a brace; of the search
    while True:
        found = re.compile(r"[{};]").search(text, at)
        if not found:
            return
        at = found.end()
        before = text[start:found.start()]
        if found.group(0) == ";" and before.count("(") > before.count(")"):
            continue  # of a `for`
        if found.group(0) != "{" or (CONTAINER.search(before) and not before.rstrip().endswith((")", "const"))):
            start = at
            continue
        end = closing(text, found.start())
        follows = text[end + 1:].lstrip()[:1]  # an initialiser, a lambda among them: the body comes later
        name = NAME.search(before)
        if name and not before.rstrip().endswith("=") and (not follows or follows not in ",{).("):
            begins = start + name.start()
            yield name.group(1).replace(" ", ""), text.count("\n", 0, begins) + 1, text.count("\n", begins, end) + 1
            start = end + 1
        elif not name:
            start = end + 1  # of a variable
        at = end + 1
