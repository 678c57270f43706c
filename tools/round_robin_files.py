#!/usr/bin/env python3
"""The round robin's files as a case: tools/round_robin_files.py [-o FOLDER]. Writes beads.csv, drum.stl and case.yaml.

Dosta et al. 2024 (Comput. Phys. Commun. 296, 109066) published beads and walls: PartCoordinates.txt and walls.txt, in metres, axis along y,
gravity along -z. Here z is the axis and gravity points along -y. So x stays, their z becomes y, and their y becomes -z: a turn about x. Beads with x > 0
and z > 0 there are those with x > 0 and y > 0 here.

The files are looked for in the folder that MILLSCOPE_DATA names, and beside it (default ../shared/public_cases/data).
"""

import argparse
import gzip
import hashlib
import math
import os
import sys
from pathlib import Path

from public_data import DATA, ROOT

COMMON = ROOT / "configs" / "round_robin" / "common.yaml"
NAME = "round_robin_drum"
# sha256 of the files that the results in docs/validation.md are of; the first unpacked, for gzip's own bytes vary.
KNOWN = {"PartCoordinates.txt": "ab73759dd1c1537e33dcf5b8bca664b795b6d8ffa2bfeef902e0e27e572272b4", "walls.txt": "03d598fd2e3d60b91fa512ce5cea58c7812c680a98b9a015a3d2e42c2e57e5b7"}
MATERIAL = {0.001: "m1", 0.002: "m2"}  # by radius, m


class Failure(Exception):
    """Something the user can put right."""


def data_folder():
    """Where the authors' files lie, or None."""
    for folder in (DATA / NAME, DATA.parent / NAME):
        if folder.is_dir():
            return folder
    return None


def text_of(folder, name):
    """A file's text, packed or not, and its sha256."""
    plain, packed = folder / name, folder / (name + ".gz")
    if not plain.exists() and not packed.exists():
        raise Failure("%s: there is no %s nor %s.gz in it" % (folder, name, name))
    content = plain.read_bytes() if plain.exists() else gzip.decompress(packed.read_bytes())
    found = hashlib.sha256(content).hexdigest()
    if found != KNOWN[name]:
        raise Failure("%s: sha256 of %s is %s, not %s; take the authors' file" % (folder, name, found, KNOWN[name]))
    return content.decode("ascii")


def numbers(text, columns):
    """The rows behind the head."""
    rows = [[float(w) for w in line.split()] for line in text.splitlines()[1:] if line.strip()]
    wrong = next((k for k, r in enumerate(rows) if len(r) != columns), None)
    if wrong is not None:
        raise Failure("row %d has %d numbers, not %d" % (wrong + 2, len(rows[wrong]), columns))
    return rows


def turned(x, y, z):
    """A place in the frame of millscope."""
    return x, z, -y


def beads(text):
    """The file that `fill: {file: …}` reads."""
    lines = ["x [m],y [m],z [m],radius [m],material"]
    for radius, *place in numbers(text, 4):
        lines.append("%.12g,%.12g,%.12g,%g,%s" % (*turned(*place), radius, MATERIAL[radius]))
    return "\n".join(lines) + "\n"


def solid(text):
    """The walls as a text STL."""
    lines = ["solid drum"]
    for row in numbers(text, 9):
        corners = [turned(*row[k:k + 3]) for k in (0, 3, 6)]
        lines += ["facet normal 0 0 0", "outer loop"] + ["vertex %.9g %.9g %.9g" % c for c in corners] + ["endloop", "endfacet"]
    return "\n".join(lines + ["endsolid drum", ""])


def write(folder, out):
    """beads.csv, drum.stl and case.yaml; returns the case."""
    out.mkdir(parents=True, exist_ok=True)
    case = "schema_version: 1\ninclude: [%s]\nfill: {file: beads.csv}\ngeometry: {drum: {file: drum.stl}}\n" % os.path.relpath(COMMON, out)
    texts = {"beads.csv": beads(text_of(folder, "PartCoordinates.txt")), "drum.stl": solid(text_of(folder, "walls.txt")), "case.yaml": case}
    for name, text in texts.items():
        if not (out / name).exists() or (out / name).read_text() != text:
            (out / name).write_text(text)
    return out / "case.yaml"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "build" / "round_robin", help="folder to write into (default build/round_robin)")
    options = parser.parse_args()
    try:
        folder = data_folder()
        if folder is None:
            raise Failure("there is no folder %s beside or in MILLSCOPE_DATA; docs/engines.md says where it comes from" % NAME)
        print("wrote %s, beads.csv, drum.stl" % write(folder, options.output))
        return 0
    except Failure as e:
        print("round_robin_files: %s" % e, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
