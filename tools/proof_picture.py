#!/usr/bin/env python3
"""One picture of the proof: tools/proof_picture.py docs/proof/BATCH … -o docs/proof.svg

    millscope challenge score docs/proof/BATCH …      # writes what this reads

A row for each set with physics hidden, found or not. On the speed that was held out it shows the misfit of three models: the base whose friction was retuned
to its power (the practice), the base that was refitted to all that was recorded, and the corrected model where there is one. Bands: what the two
bases come out as in nine of ten sets where nothing is hidden. A star: practice sees nothing of it at the speed where it tuned.
"""

import argparse
import json
import math
import sys
from html import escape
from pathlib import Path

MODELS = {"retuned to power": ("#d55e00", "retuned to its power"), "retuned to all observables": ("#8a6d00", "refitted to everything"), "corrected": ("#0072b2", "corrected")}
INK, FAINT = "#1b2733", "#8a97a3"
LEFT, WIDTH, ROW, TOP = 392, 320, 24, 122


def text(x, y, words, **attributes):
    more = "".join(' %s="%s"' % (name.replace("_", "-"), value) for name, value in attributes.items())
    return '<text x="%.1f" y="%.1f"%s>%s</text>' % (x, y, more, escape(words))


def misfits_of(diagnosis):
    held = diagnosis.get("held_out") or [{"models": []}]
    return {model["model"]: model["misfit"] for model in held[0]["models"] if model["model"] in MODELS}


def rows_of(batch):
    """[(what is hidden and said of it, {model: misfit})] of the sets with effects, and [{model: misfit}] of those with nothing hidden."""
    found, empty = [], []
    for one in json.loads((batch / "score.json").read_text())["every_set"]:
        file = batch / one["set"] / "diagnosis" / "diagnosis.json"
        diagnosis = json.loads(file.read_text()) if file.exists() else {"verdict": "failed"}
        if one["truth"] == "none":
            empty.append(misfits_of(diagnosis))
        elif not one["truth"].startswith(("decoy:", "outside:")):
            seen = [one["practice"][tuned] or {} for tuned in ("to_power", "to_all")]  # empty without long runs: then nothing is marked
            concealed = any(each.get("unsuspicious", False) for each in seen)
            listed = {"named": "", "ambiguous": "listed"}.get(diagnosis["verdict"], "missed")
            if listed != "missed" and one["missed"]:
                listed = "in part" if set(one["truth"].split(" + ")) & set(diagnosis["named"]) else "wrong"
            name = ("★ " if concealed else "") + one["truth"].replace("_", " ") + (" (%s)" % listed if listed else "")
            found.append((name, misfits_of(diagnosis)))
    return found, empty


def band(empty, model):
    """Where nine of ten lie."""
    values = sorted(row[model] for row in empty if model in row)
    return (values[int(0.05 * (len(values) - 1))], values[math.ceil(0.95 * (len(values) - 1))]) if len(values) > 19 else None


def picture(rows, empty):
    rows = sorted((row for row in rows if row[1]), key=lambda row: -row[1].get("retuned to power", 0))
    bands = {model: wide for model in MODELS if (wide := band(empty, model)) is not None}
    values = [misfit for _, misfits in rows for misfit in misfits.values()] + [end for wide in bands.values() for end in wide]
    first = math.floor(math.log10(min(values)))
    ends = first, max(first + 1, math.ceil(math.log10(max(values))))
    px = lambda misfit: LEFT + WIDTH * (math.log10(misfit) - ends[0]) / (ends[1] - ends[0])
    bottom = TOP + ROW * len(rows)
    parts = [text(20, 32, "The speed that nobody fitted: misfit a number; about 1 is chance", font_weight="bold", font_size=18)]
    for k, (model, (colour, words)) in enumerate(MODELS.items()):
        parts.append('<circle cx="%d" cy="56" r="5" fill="%s"/>' % (28 + 210 * k, colour) + text(40 + 210 * k, 61, words))
        if (wide := bands.get(model)) is not None:
            parts.append('<rect x="%.1f" y="%d" width="%.1f" height="%d" fill="%s" opacity="0.1"/>' % (px(wide[0]), TOP - 12, px(wide[1]) - px(wide[0]), bottom - TOP + 12, colour))
    told = "Bands: the same two bases where nothing is hidden (nine of ten sets). " if bands else ""
    parts.append(text(20, 86, told + "★ concealed from practice.", fill=FAINT, font_size=14))
    for power in range(ends[0], ends[1] + 1):
        parts.append('<path d="M%.1f %dV%d" stroke="#e3e8ec"/>' % (px(10.0**power), TOP - 12, bottom) + text(px(10.0**power), bottom + 20, "%g" % 10.0**power, text_anchor="middle", fill=FAINT))
    parts.append('<path d="M%.1f %dV%d" stroke="%s" stroke-dasharray="5 4"/>' % (px(1), TOP - 12, bottom, INK))
    for k, (name, misfits) in enumerate(rows):
        y = TOP + ROW * k + 6
        parts.append(text(LEFT - 14, y + 5, name, text_anchor="end", font_size=14))
        parts.append('<path d="M%.1f %dH%.1f" stroke="%s" stroke-width="1.5"/>' % (px(min(misfits.values())), y, px(max(misfits.values())), FAINT))
        parts += ['<circle cx="%.1f" cy="%d" r="5" fill="%s"/>' % (px(misfits[model]), y, colour) for model, (colour, _) in MODELS.items() if model in misfits]
    return ('<svg xmlns="http://www.w3.org/2000/svg" width="740" height="%d" viewBox="0 0 740 %d" role="img" aria-label="Misfit on the held-out speed of two retuned bases '
            'and of the corrected model, set by set" font-family="system-ui, Helvetica, Arial, sans-serif" font-size="15" fill="%s">\n<rect width="740" height="%d" rx="12" fill="#fff"/>\n%s\n</svg>\n'
            % (bottom + 36, bottom + 36, INK, bottom + 36, "\n".join(parts)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("batches", type=Path, nargs="+", help="folders below docs/proof that are scored")
    parser.add_argument("-o", "--output", type=Path, required=True, help="the SVG file")
    arguments = parser.parse_args()
    try:
        read = [rows_of(batch) for batch in arguments.batches]
    except FileNotFoundError as missing:
        sys.exit("proof_picture: %s is missing; run 'millscope challenge score' on these batches first" % missing.filename)
    rows, empty = (sum(parts, []) for parts in zip(*read))
    if not any(misfits for _, misfits in rows):
        sys.exit("proof_picture: no set of these batches has physics hidden and a held-out condition; give another batch")
    arguments.output.write_text(picture(rows, empty))


if __name__ == "__main__":
    main()
