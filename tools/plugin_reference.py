#!/usr/bin/env python3
"""Writes docs/plugins.md from what the plugins say of themselves.

    tools/plugin_reference.py --millscope build/release/bin/millscope            # writes docs/plugins.md
    tools/plugin_reference.py --millscope build/release/bin/millscope --check    # compares; exit code 1 where it is out of date
"""

import argparse
import difflib
import json
import os
import re
import subprocess
import sys
from pathlib import Path

PAGE = Path(__file__).resolve().parent.parent / "docs" / "plugins.md"
COMMAND = "tools/plugin_reference.py --millscope build/release/bin/millscope"

# Kind → (heading, where it is given in a case or file, in one sentence).
KINDS = {
    "contact_law": ("Contact laws", "One in a case, under `contact.law`: the normal and the tangential force of a contact."),
    "interaction": ("Interactions", "Any number, under `contact.interactions`: adhesion and films before the law, rolling resistance after it."),
    "pair_parameter": ("Pair parameters", "Under `contact.pair_parameters`: restitution or friction that depends on the contact's own state."),
    "wear_law": ("Wear laws", "Any number, under `contact.wear`: how much of a wall a bead takes away ([wear](wear.md)). They move nothing."),
    "body_force": ("Body forces", "Under `body_forces`: what acts on each bead alone."),
    "geometry": ("Geometries", "Under `geometry`: walls ([importing a liner](importing_a_liner.md))."),
    "observation": ("Observations", "Under `observations` of a camera file: what a camera does to a track ([virtual camera](virtual_camera.md))."),
    "analyzer": ("Analyzers", "Under `analyzers` of the settings of `analyze`. What each result is: [analyzers](analyzers.md)."),
}


def ask(command, *words):
    done = subprocess.run([command, *words], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"plugin_reference: '{command} {' '.join(words)}' failed: {done.stderr.strip() or done.returncode}; build millscope first")
    return done.stdout


def plain(text):
    """What a plugin says, with the signs that Markdown would take for its own made harmless."""
    return re.sub(r"([*<>])", lambda sign: {"*": "\\*", "<": "&lt;", ">": "&gt;"}[sign.group()], text)


def cell(text):
    return plain(text).replace("|", "\\|")


def code(text):
    return f"`{text}`" if text else ""


def number(value):
    return f"{value:g}"


def default_of(p):
    if p["required"]:
        return "required"
    value = p.get("default")
    if value is None:
        return "none"
    if isinstance(value, bool):
        return code(str(value).lower())
    return code(value) if isinstance(value, str) else number(value)


def range_of(p):
    if p["type"] == "choice":
        return ", ".join(code(c) for c in p["choices"].split("|"))
    if p["type"] not in ("number", "integer", "vector"):
        return p["type"]
    low, high, word = p["minimum"], p["maximum"], "" if p["type"] == "number" else p["type"] + " "
    if low is not None and high is not None:
        return f"{word}{number(low)} … {number(high)}"
    if low is not None:
        return f"{word}from {number(low)}"
    return f"{word}up to {number(high)}" if high is not None else (word + "any").strip()


def table_of(parameters, title):
    if not parameters:
        return []
    lines = ["", f"| {title} | unit | default | values | meaning |", "|---|---|---|---|---|"]
    for p in parameters:
        unit = "" if p["unit"] == "1" else p["unit"]
        meaning = p["doc"] + (f" ({p['citation']})" if p["citation"] else "")
        lines.append("| " + " | ".join([code(p["name"]), unit, default_of(p), range_of(p), cell(meaning)]) + " |")
    return lines


def hypothesis_of(h):
    low, high = h["prior"]
    text = [f"**Hypothesis `{h['name']}`**: {plain(h['sentence'])}", f"`{h['equation']}`, with `{h['parameter']}` from {number(low)} to {number(high)};",
            f"{number(h['null_value'])} is without the effect{', two-sided' if h['two_sided'] else ''}."]
    if h["excludes"]:
        text.append(f"Not together with `{h['excludes']}`.")
    return " ".join(text)


def role_of(command, plugin):
    """When it acts, or what it gives: only the text has it, and only these kinds."""
    if plugin["kind"] not in ("interaction", "pair_parameter"):
        return None
    return re.search(r"\([a-z_]+; ([^,]*), version", ask(command, "describe", plugin["name"]).splitlines()[0])


def section(plugin, says):
    lines = ["", f"### {plugin['name']}", "", plain(plugin["doc"]) + (f" It {says.group(1)}." if says else "")]
    if plugin["equation"]:
        lines += ["", "    " + plugin["equation"]]
    if plugin["citation"]:
        lines += ["", plain(plugin["citation"]) + "."]
    for scope, title in (("instance", "parameter"), ("pair", "under `pairs`")):
        lines += table_of([p for p in plugin["parameters"] if p["scope"] == scope], title)
    if plugin["history"]:
        lines += ["", "Kept per contact: " + ", ".join(code(h["name"]) for h in plugin["history"]) + "."]
    if plugin["channels"]:
        roles = zip(plugin["channels"], plugin["channel_roles"])
        lines += ["", "Energy goes to: " + ", ".join(f"{code(name)} ({role['part']}, {role['nature']})" for name, role in roles) + "."]
    for h in plugin["hypotheses"]:
        lines += ["", hypothesis_of(h)]
    return lines


def page_of(command):
    listed = [line.split()[:2] for line in ask(command, "plugins").splitlines() if line and not line.startswith("searched:")]
    unknown = {kind for kind, _ in listed} - set(KINDS)
    if unknown or not listed:
        sys.exit(f"plugin_reference: unknown kinds {sorted(unknown)}; add them to KINDS" if listed else "plugin_reference: no plugin is loaded")
    lines = ["# Plugins", "", "    millscope plugins                    # what is loaded, and from where", "    millscope describe hertz_mindlin     # one of them", "",
             f"All physics, shapes, cameras and measurements that come with millscope, as they describe themselves. Written by",
             f"`{COMMAND}`; do not edit it. Values are SI; a case may give other units ([cases](cases.md#numbers-and-files)). A hypothesis is what",
             "[`diagnose`](diagnose.md) can name. One of your own: [a plugin of any kind](adding_a_plugin.md), [a contact law](adding_a_contact_law.md),",
             "[an analyzer](adding_an_analyzer.md), [a hypothesis](adding_a_hypothesis.md)."]
    for kind, (heading, where) in KINDS.items():
        lines += ["", f"## {heading}", "", where]
        for name in [n for k, n in listed if k == kind]:
            plugin = json.loads(ask(command, "describe", name, "--json"))
            lines += section(plugin, role_of(command, plugin))
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--millscope", required=True, help="the command that is asked")
    parser.add_argument("--check", action="store_true", help="write nothing; exit code 1 where the page is out of date")
    parser.add_argument("--page", type=Path, default=PAGE, help="the page (default: docs/plugins.md)")
    arguments = parser.parse_args()
    wanted = page_of(arguments.millscope)
    if not arguments.check:
        aside = arguments.page.with_suffix(".tmp")
        aside.write_text(wanted, encoding="utf-8")
        os.replace(aside, arguments.page)
        return 0
    found = arguments.page.read_text(encoding="utf-8") if arguments.page.exists() else ""
    if found == wanted:
        return 0
    changes = [line for line in difflib.unified_diff(found.splitlines(), wanted.splitlines(), "docs/plugins.md", "the plugins", lineterm="", n=0)]
    print("\n".join(changes[:20]))
    print(f"{arguments.page.name} is out of date; write it again with: {COMMAND}")
    return 1


if __name__ == "__main__":
    sys.exit(main())
