#!/usr/bin/env python3
"""One picture of the proof: tools/proof_picture.py docs/proof/BATCH … -o docs/proof.svg

    millscope challenge score docs/proof/BATCH …      # writes what this reads

A row for each set with physics hidden that a diagnosis names, or lists in a class. On the speed that was held out it shows the misfit of the base whose
friction was retuned to its power (the practice), and that of the corrected model. Below 1 nothing is left beyond chance. A star: practice sees nothing
of it at the speed where it tuned.
"""

import argparse
import json
import math
import sys
from html import escape
from pathlib import Path

BASE, CORRECTED, INK, FAINT = "#d55e00", "#0072b2", "#1b2733", "#8a97a3"
LEFT, WIDTH, ROW, TOP = 362, 320, 26, 96


def text(x, y, words, **attributes):
    more = "".join(' %s="%s"' % (name.replace("_", "-"), value) for name, value in attributes.items())
    return '<text x="%.1f" y="%.1f"%s>%s</text>' % (x, y, more, escape(words))


def rows_of(batch):
    """[(hidden, verdict, concealed, misfit of the base, misfit corrected)] of a batch that is scored."""
    found = []
    for one in json.loads((batch / "score.json").read_text())["every_set"]:
        diagnosis = json.loads((batch / one["set"] / "diagnosis" / "diagnosis.json").read_text())
        effects = one["truth"] != "none" and not one["truth"].startswith(("decoy:", "outside:"))
        if not effects or not diagnosis.get("held_out") or diagnosis["verdict"] not in ("named", "ambiguous"):
            continue
        misfits = {model["model"]: model["misfit"] for model in diagnosis["held_out"][0]["models"]}
        if "corrected" not in misfits or "retuned to power" not in misfits:
            continue
        concealed = (one.get("concealment") or {}).get("unsuspicious", False)  # without long runs not known: then nothing is marked
        found.append((one["truth"].replace("_", " "), diagnosis["verdict"], concealed, misfits["retuned to power"], misfits["corrected"]))
    return found


def picture(rows):
    rows = sorted(rows, key=lambda row: -row[3])
    low, high = min(min(r[3:]) for r in rows), max(max(r[3:]) for r in rows)
    ends = math.floor(math.log10(low)), math.ceil(math.log10(high))
    px = lambda misfit: LEFT + WIDTH * (math.log10(misfit) - ends[0]) / (ends[1] - ends[0])
    bottom = TOP + ROW * len(rows)
    parts = [text(20, 32, "The speed that nobody fitted: misfit a number", font_weight="bold", font_size=18),
             '<circle cx="28" cy="56" r="6" fill="%s"/>' % BASE + text(42, 61, "base, friction retuned to its power"),
             '<circle cx="322" cy="56" r="6" fill="%s"/>' % CORRECTED + text(336, 61, "corrected model"),
             text(486, 61, "★ concealed from practice")]
    for power in range(ends[0], ends[1] + 1):
        parts.append('<path d="M%.1f %dV%d" stroke="#e3e8ec"/>' % (px(10.0**power), TOP - 12, bottom) + text(px(10.0**power), bottom + 20, "%g" % 10.0**power, text_anchor="middle", fill=FAINT))
    parts.append('<path d="M%.1f %dV%d" stroke="%s" stroke-dasharray="5 4"/>' % (px(1), TOP - 12, bottom, INK))
    for k, (hidden, verdict, concealed, base, corrected) in enumerate(rows):
        y = TOP + ROW * k + 6
        name = ("★ " if concealed else "") + hidden + ("" if verdict == "named" else " (in a class)")
        parts.append(text(LEFT - 14, y + 5, name, text_anchor="end", font_size=14))
        parts.append('<path d="M%.1f %dH%.1f" stroke="%s" stroke-width="2"/>' % (px(base), y, px(corrected), FAINT))
        parts += ['<circle cx="%.1f" cy="%d" r="6" fill="%s"/>' % (px(v), y, colour) for v, colour in ((base, BASE), (corrected, CORRECTED))]
    return ('<svg xmlns="http://www.w3.org/2000/svg" width="720" height="%d" viewBox="0 0 720 %d" role="img" aria-label="Misfit on the held-out speed of the retuned base '
            'and of the corrected model, set by set" font-family="system-ui, Helvetica, Arial, sans-serif" font-size="15" fill="%s">\n<rect width="720" height="%d" rx="12" fill="#fff"/>\n%s\n</svg>\n'
            % (bottom + 36, bottom + 36, INK, bottom + 36, "\n".join(parts)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("batches", type=Path, nargs="+", help="folders below docs/proof that are scored")
    parser.add_argument("-o", "--output", type=Path, required=True, help="the SVG file")
    arguments = parser.parse_args()
    try:
        rows = [row for batch in arguments.batches for row in rows_of(batch)]
    except FileNotFoundError as missing:
        sys.exit("proof_picture: %s is missing; run 'millscope challenge score' on these batches first" % missing.filename)
    if not rows:
        sys.exit("proof_picture: no set of these batches has something hidden that was found; give another batch")
    arguments.output.write_text(picture(rows))


if __name__ == "__main__":
    main()
