#!/usr/bin/env python3
"""The rooms of the sources and the arrows between them: draws what they include, and compares it with docs/architecture.md.

    tools/rooms.py                    # what differs from the page's table; exit code 1 where anything does, or on a cycle
    tools/rooms.py rooms.svg          # and the picture
    tools/rooms.py --update           # writes what the sources include into the table; the diff is yours to judge
"""

import argparse
import sys
from pathlib import Path

import include_graph
import rooms_picture

ROOT = Path(__file__).resolve().parents[1]


def updated(root):
    """The page with the last two columns of its table as the sources have them. A row for each room is there already."""
    table = include_graph.Table(root)
    graph, libraries = include_graph.graph_of(root, table), include_graph.libraries_of(root, table)
    lines = (root / include_graph.PAGE).read_text(encoding="utf-8").split("\n")
    for room in table.rooms.values():
        cells = lines[room.line - 1].strip().strip("|").split("|")[:2]
        used = [table.short(other) for other in table.rooms if other in graph[room.folder]]
        for names in (used, libraries[room.folder]):
            cells.append(" %s " % ", ".join("`%s`" % name for name in names))
        lines[room.line - 1] = "|%s|" % "|".join(cells)
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture", type=Path, nargs="?", help="the SVG file to write")
    parser.add_argument("--update", action="store_true", help="write what the sources include into the page's table")
    parser.add_argument("--root", type=Path, default=ROOT, help="the repository (this one)")
    options = parser.parse_args()
    if options.update:
        text = updated(options.root)
        (options.root / include_graph.PAGE).write_text(text, encoding="utf-8")
    table = include_graph.Table(options.root)
    graph = include_graph.graph_of(options.root, table)
    faults = list(include_graph.faults_of(options.root))
    cycle = include_graph.find_cycle(graph)
    if cycle:
        faults.append("a cycle: " + " → ".join(cycle))
    for fault in faults:
        print(fault)
    arrows = sum(len(used) for used in graph.values())
    print("%d rooms, %d arrows, %s a cycle, %d differences from %s"
          % (len(graph), arrows, "with" if cycle else "without", len(faults), include_graph.PAGE))
    if options.picture and not cycle:
        options.picture.write_text(rooms_picture.draw(table, graph), encoding="utf-8")
        print("drawn in %s" % options.picture)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
