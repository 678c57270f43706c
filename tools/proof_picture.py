#!/usr/bin/env python3
"""One picture of a set of the proof: tools/proof_picture.py docs/proof/BATCH SET -o docs/proof.svg

Above, what practice sees at the speed where friction was retuned, by long runs, beside the limits of practice. Below, the speed that was held out: the
recording, the retuned base and the corrected model, where the bead is and how fast.
"""

import argparse
import json
import re
import sys
from html import escape
from pathlib import Path

LIMITS = {"power_percent": ("power", 1.0, "%"), "shoulder_deg": ("shoulder", 1.5, "°"), "toe_deg": ("toe", 1.5, "°")}
MODELS = (("retuned to power", "base, friction retuned to its power", "#d55e00"), ("corrected", "corrected model", "#0072b2"))
FAMILIES = (("x", "where: across the mill", "mm"), ("y", "where: up the mill", "mm"), ("speed", "how fast", "of the shell's speed"))
INK, FAINT = "#1b2733", "#8a97a3"


def bins_of(observables, family):
    """[(low, high, observable)] of a distribution, in its order."""
    found = []
    for one in observables:
        match = re.fullmatch(family + r" (-?[\d.]+) to (-?[\d.]+)\b.*", one["observable"])
        if match and "R," not in one["observable"]:
            found.append((float(match.group(1)), float(match.group(2)), one))
    return found


def text(x, y, words, **attributes):
    more = "".join(' %s="%s"' % (name.replace("_", "-"), value) for name, value in attributes.items())
    return '<text x="%.1f" y="%.1f"%s>%s</text>' % (x, y, more, escape(words))


def practice(concealed, top):
    """Differences at the tuned speed, each as a part of its limit."""
    parts = [text(20, top, "At the speed where friction was retuned, practice sees nothing:", font_weight="bold")]
    for k, (key, (name, limit, unit)) in enumerate(LIMITS.items()):
        x, y, value = 20 + 230 * k, top + 22, concealed[key]
        at = x + 105 + 75 * max(-1.2, min(1.2, value / limit))
        parts.append('<rect x="%d" y="%d" width="150" height="12" fill="#dfe6ec"/><path d="M%d %dv12" stroke="%s"/>' % (x + 30, y, x + 105, y, FAINT))
        parts.append('<circle cx="%.1f" cy="%d" r="6" fill="%s"/>' % (at, y + 6, MODELS[0][2]))
        parts.append(text(x + 105, y + 30, "%s %+.2f %s of ±%g" % (name, value, unit, limit), text_anchor="middle", font_size=14))
    return parts


def panel(observables, family, title, unit, box):
    """Recorded as dots, the models as staircases."""
    left, top, width, height = box
    bins = bins_of(observables, family)
    if not bins:
        return []
    factor = 1 / sum(one["recorded"] for _, _, one in bins)
    low, high = bins[0][0], bins[-1][1]
    density = lambda one, name, span: factor * one[name] / span
    most = 1.1 * max(density(one, name, b - a) for a, b, one in bins for name in ("recorded", "corrected", "retuned to power"))
    px = lambda v: left + width * (v - low) / (high - low)
    py = lambda v: top + height * (1 - v / most)
    parts = ['<path d="M%.1f %.1fV%.1fH%.1f" fill="none" stroke="%s"/>' % (left, top, top + height, left + width, FAINT), text(left, top - 8, title, font_size=15)]
    for name, _, colour in MODELS:
        steps = "".join("%s%.1f %.1fH%.1f" % ("M" if k == 0 else "V%.1fL" % py(density(one, name, b - a)), px(a), py(density(one, name, b - a)), px(b))
                        for k, (a, b, one) in enumerate(bins))
        parts.append('<path d="%s" fill="none" stroke="%s" stroke-width="2.5"/>' % (steps, colour))
    for a, b, one in bins:
        parts.append('<circle cx="%.1f" cy="%.1f" r="4.5" fill="%s"/>' % (px(0.5 * (a + b)), py(density(one, "recorded", b - a)), INK))
    for value in (low, high):
        parts.append(text(px(value), top + height + 16, "%g" % value, text_anchor="middle", font_size=13, fill=FAINT))
    parts.append(text(left + width / 2, top + height + 32, unit, text_anchor="middle", font_size=13, fill=FAINT))
    return parts


def picture(batch, name):
    diagnosis = json.loads((batch / name / "diagnosis" / "diagnosis.json").read_text())
    concealment = json.loads((batch / "concealment.json").read_text())
    answer = json.loads((batch / "answers" / (name + ".json")).read_text())
    held = diagnosis["held_out"][0]
    misfits = {one["model"]: one["misfit"] for one in held["models"]}
    hidden = " and ".join(one["hypothesis"].replace("_", " ") for one in answer["effects"])
    verdict = ", ".join(one["hypothesis"] if isinstance(one, dict) else one for one in diagnosis["named"]).replace("_", " ")
    parts = [text(20, 32, "Hidden: %s. Found: %s (%s, %s)." % (hidden, verdict or diagnosis["verdict"].replace("_", " "), batch.name, name), font_weight="bold", font_size=18)]
    parts += practice(concealment["sets"][name], 68)
    parts.append(text(20, 150, "At the speed that was held out, one of the two is right:", font_weight="bold"))
    for k, (family, title, unit) in enumerate(FAMILIES):
        parts += panel(held["observables"], family, title, unit, (30 + 232 * k, 186, 196, 180))
    x = 20
    parts.append('<circle cx="%d" cy="436" r="4.5" fill="%s"/>' % (x + 6, INK) + text(x + 18, 441, "recording", font_size=15))
    for k, (model, words, colour) in enumerate(MODELS):
        at = 130 + 330 * k
        parts.append('<path d="M%d 436h26" stroke="%s" stroke-width="2.5"/>' % (at, colour) + text(at + 34, 441, "%s: misfit %.2g a number" % (words, misfits[model]), font_size=15))
    label = "What practice sees of a mill whose physics is hidden, and what the held-out speed shows"
    return ('<svg xmlns="http://www.w3.org/2000/svg" width="720" height="460" viewBox="0 0 720 460" role="img" aria-label="%s" '
            'font-family="system-ui, Helvetica, Arial, sans-serif" font-size="16" fill="%s">\n<rect width="720" height="460" rx="12" fill="#fff"/>\n%s\n</svg>\n' %
            (label, INK, "\n".join(parts)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("batch", type=Path, help="a folder below docs/proof that is open")
    parser.add_argument("set", help="e.g. set_024")
    parser.add_argument("-o", "--output", type=Path, required=True, help="the SVG file")
    arguments = parser.parse_args()
    try:
        drawn = picture(arguments.batch, arguments.set)
    except FileNotFoundError as missing:
        sys.exit("proof_picture: %s is missing; give a batch that is open and a set of it" % missing.filename)
    except (KeyError, IndexError):
        sys.exit("proof_picture: %s of %s has no held-out speed or no concealment; give a set with physics hidden" % (arguments.set, arguments.batch))
    arguments.output.write_text(drawn)


if __name__ == "__main__":
    main()
