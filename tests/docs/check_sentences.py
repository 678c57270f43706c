#!/usr/bin/env python3
"""Holds the pages to plain English: check_sentences.py ROOT [--sentences]; exit code 1 and one line per fault.

On each page a sentence has at most 18 words on average, and never more than 40. A paragraph and an item of a list end the sentence
that they begin. Tables, code blocks, headings and targets of links do not count; a formula or a piece of code within a sentence is
one word. --sentences prints average and longest of every page.
"""

import argparse
import re
import sys
from pathlib import Path

sys.dont_write_bytecode = True
from check_docs import lines_of, pages_of  # noqa: E402

AVERAGE, LONGEST = 18, 40
# Pages that a program writes: their sentences are mended there.
WRITTEN = {
    "docs/plugins.md": "tools/plugin_reference.py writes it from what the plugins say",
    "docs/validation.md": "tools/verify.py writes it",
    "docs/proof.md": "millscope challenge score writes it",
}
ITEM = re.compile(r"\s*(?:[-*+]|\d+[.)])\s+")
APART = re.compile(r"^\s*(?:#{1,6}\s|\||<!--|-{3,}\s*$|\[[^\]]+\]:\s)")  # headings, tables, comments, rules, targets
LINK = re.compile(r"!?\[((?:[^\[\]]|\[[^\]]*\])*)\]\([^()\s]*(?:\([^()]*\))?[^()\s]*\)")
CODE = re.compile(r"(`+).+?\1|\$[^$]+\$")
# A stop ends a sentence where what follows can begin one.
END = re.compile(r"""[.!?][)\]"'”’*_]*\s+(?=[("'“‘*_\[]*(?:[A-Z0-9Α-Ωα-ω§]|millscope\b))""")
SHORT = re.compile(r"(?:\b(?:e\.g|i\.e|[Ee]q|[Ff]ig|al|vs|cf|[Nn]o|[Pp]p|[A-Z])\.)$")


def blocks_of(text):
    """(number of its first line, text) of each paragraph and item."""
    words, start = [], 0
    for number, line, code in lines_of(text):
        item = ITEM.match(line)
        if words and (code or item or not line.strip() or APART.match(line)):
            yield start, " ".join(words)
            words = []
        if code or not line.strip() or APART.match(line):
            continue
        if not words:
            start = number
        words.append((line[item.end():] if item else line).lstrip("> ").strip())
    if words:
        yield start, " ".join(words)


def sentences_of(text):
    """(number of the line where its paragraph begins, sentence)."""
    for number, block in blocks_of(text):
        block = LINK.sub(lambda found: found.group(1), CODE.sub("Code", block))
        begin = 0
        for end in END.finditer(block):
            if not SHORT.search(block[begin:end.start() + 1]):
                yield number, block[begin:end.end()].strip()
                begin = end.end()
        if block[begin:].strip():
            yield number, block[begin:].strip()


def length(sentence):
    return sum(any(letter.isalnum() for letter in word) for word in sentence.split())


def measured(root):
    """Name → [(words, line, sentence)] of each page that a person writes."""
    found = {}
    for page in pages_of(root):
        name = page.relative_to(root).as_posix()
        if name not in WRITTEN:
            found[name] = [(length(s), number, s) for number, s in sentences_of(page.read_text(encoding="utf-8")) if length(s)]
    return found


def average(sentences):
    return sum(words for words, _, _ in sentences) / max(len(sentences), 1)


def check(root):
    for name, sentences in measured(root).items():
        for words, number, sentence in sentences:
            if words > LONGEST:
                yield f"{name}:{number}: a sentence of {words} words, at most {LONGEST} are allowed; divide it: \"{' '.join(sentence.split()[:8])} …\""
        if average(sentences) > AVERAGE:
            yield f"{name}: {average(sentences):.1f} words per sentence on average, at most {AVERAGE} are allowed; one thought a sentence"
    for name in sorted(WRITTEN):
        if not (root / name).exists():
            yield f"{name}: is an exception of check_sentences.py and not there; take it off the list"


def table(root):
    yield f"{'page':40} {'sentences':>9} {'average':>8} {'longest':>8}"
    for name, sentences in measured(root).items():
        yield f"{name:40} {len(sentences):9} {average(sentences):8.1f} {max((words for words, _, _ in sentences), default=0):8}"
    for name, reason in WRITTEN.items():
        yield f"{name:40} not counted: {reason}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", type=Path)
    parser.add_argument("--sentences", action="store_true", help="print average and longest sentence of every page")
    arguments = parser.parse_args()
    root = arguments.root.resolve()
    if arguments.sentences:
        print("\n".join(table(root)))
    faults = list(check(root))
    for fault in faults:
        print(fault)
    pages = len(measured(root))
    print(f"{pages} pages, {len(faults)} faults" if pages else "no pages")
    return 1 if faults or not pages else 0


if __name__ == "__main__":
    sys.exit(main())
