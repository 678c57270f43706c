#!/usr/bin/env python3
"""One concealed set of the proof, at the speed that was held out: tools/proof_concealed.py docs/proof/BATCH/set_001 -o docs/proof_concealed.svg

Simulates the truth of an opened set again, and once each model of its diagnosis at that speed. One camera records all of them, and each model is
held against the recording of the truth (`millscope compare`). A disc is the mill's section. Each region has the colour of the difference in the
beads' speed; those with a rim differ surely. Power is that of the diagnosis. Takes some minutes; what lies in the work folder is kept for the same
cases, camera and program.
"""

import argparse
import csv
import json
import math
import re
import subprocess
import sys
from html import escape
from pathlib import Path

from proof_picture import FAINT, INK, text

ROOT = Path(__file__).resolve().parent.parent
BASES = {"retuned to power": "friction retuned to its power", "retuned to all observables": "refitted to everything"}
SLOWER, FASTER = (0, 114, 178), (213, 94, 0)
WIDTH, RADIUS, TOP = 330, 130, 128  # of a panel and its disc; pixels
FULL = 10.0  # standard errors that have the full colour
SURE = 0.05  # for all regions together
REGION = re.compile(r"([\d.]+)–([\d.]+) R, ([\d.]+)–([\d.]+)° (before|past) 6 o'clock")
SPEED = "pept_grid.speed by region"


class Set:
    """An opened set with one effect, its diagnosis and the condition that was held out."""

    def __init__(self, folder):
        read = lambda path: json.loads(path.read_text())
        self.name = "%s set %d" % (folder.parent.name, int(folder.name.rsplit("_")[-1]))
        self.answer = read(folder.parent / "answers" / (folder.name + ".json"))
        diagnosis = read(folder / "diagnosis" / "diagnosis.json")
        if len(self.answer["effects"]) != 1 or len(diagnosis["named"]) != 1 or not diagnosis["held_out"]:
            sys.exit("proof_concealed: %s: has not one effect, one name and a held-out condition; give a set that has" % folder)
        self.effect, self.held = self.answer["effects"][0], diagnosis["held_out"][0]
        self.best = next(each for each in diagnosis["hypotheses"] if each["name"] == diagnosis["named"][0])
        self.models = {model["model"]: model for model in self.held["models"]}
        self.settings = self.answer["made"][self.held["condition"]]["settings"]
        self.empty = {setting.split("=", 1)[0] for other in self.without_effect(folder.parent) for setting in other}
        last = dict(each.split("=", 1) for each in self.settings)  # of a key that is there twice the last counts
        self.seconds = float(last["time.end_s"]) - float(last["time.analyze_from_s"])
        self.beads = int(re.search(r"beads: (\d+)", last["output.tracks"]).group(1))

    def without_effect(self, batch):
        """Settings of the sets of its batch in which nothing is hidden, at its condition."""
        answers = [json.loads(path.read_text()) for path in sorted((batch / "answers").glob("*.json"))]
        return [each["made"][self.held["condition"]]["settings"] for each in answers if each["kind"] == "none"]

    def key_of(self, parameter):
        """The path in the case that a parameter of the study sets: the one that has the truth's value."""
        truth = self.answer["theta"][parameter]
        keys = {key for key, value in (setting.split("=", 1) for setting in self.settings) if value == "%.4g" % truth}
        if len(keys) != 1:
            sys.exit("proof_concealed: %d settings of the truth have the value of %s; give another set" % (len(keys), parameter))
        return keys.pop()

    def effect_at(self, value):
        """The settings that only its effect makes, those of its strength replaced."""
        own = [(key, old) for key, old in (setting.split("=", 1) for setting in self.settings) if key not in self.empty]
        strengths = {key for key, _ in own if key.endswith("." + self.effect["parameter"])}
        if not strengths:
            sys.exit("proof_concealed: no setting of the truth is the strength of %s; give another set" % self.effect["hypothesis"])
        return ["%s=%s" % (key, "%.4g" % value if key in strengths else old) for key, old in own]

    def settings_of(self, model):
        """What the truth and the study have in common, what the model fitted, and the effect where it has one. Its numerics are the study's."""
        common = ("time.end_s=", "time.analyze_from_s=", "mill.speed=", "output.")
        out = [each for each in self.settings if each.startswith(common)]
        out += ["%s=%.4g" % (self.key_of(name), value) for name, value in self.models[model]["parameters"].items() if name in self.answer["theta"]]
        if model == "corrected":
            out += self.effect_at(self.best["parameters"][self.effect["parameter"]]["value"])
        return out + ["output.tracks={beads: 150, every_s: 0.0005}", "seed=1"]


def base_case(batch):
    """That of the study of the batch's challenge."""
    said = lambda file, key: file.parent / re.search(r"^%s: *(\S+)" % key, file.read_text(), re.M).group(1)
    return said(said(ROOT / "configs/proof" / (re.sub(r"_\d+$", "", batch) + ".yaml"), "study"), "base")


def recorded(work, name, settings, options):
    """The analysis of what the camera sees of a case; kept for the same words."""
    words = [str(options.case), "--force", "--quiet", *(word for each in settings for word in ("--set", each))]
    analysis, made_by = work / name / "analysis", work / name / "made_by.json"
    asked = json.dumps([words, str(options.camera), options.program], indent=1)
    if made_by.exists() and made_by.read_text() == asked:
        return analysis
    run = lambda *words: subprocess.run([str(options.millscope), *map(str, words)], check=True, stdout=subprocess.DEVNULL)
    print("%s …" % name, flush=True)
    run("run", *words, "-o", work / name / "run")
    run("pept", "synthesize", work / name / "run", "-o", work / name / "bead.a", "--camera", options.camera, "--force")
    run("analyze", work / name / "bead.yaml", "-o", analysis, "--force", "--quiet", "--no-pictures")
    made_by.write_text(asked)
    return analysis


def compared(truth, model, options):
    """How many observables there are, how many differ, and of each region the speeds, their difference in errors and whether it is sure."""
    folder = model.parent / "compared"
    subprocess.run([str(options.millscope), "compare", truth, model, "-o", folder, "--force", "--quiet"], check=True, stdout=subprocess.DEVNULL)
    rows = lambda name: list(csv.DictReader((folder / name).read_text().splitlines()))
    observables = rows("observables.csv")
    regions = [row for row in rows("elements.csv") if row["observable"] == SPEED]
    return {"observables": len(observables), "differ": sum(row["differs"] == "1" for row in observables), "regions": regions}


def colour(errors):
    """Of a difference: white is none."""
    share, end = min(1.0, abs(errors) / FULL), FASTER if errors > 0 else SLOWER
    return "#%02x%02x%02x" % tuple(round(255 + share * (part - 255)) for part in end)


def sector(x, y, region):
    """The mill turns clockwise: past 6 o'clock is on the left."""
    inner, outer, low, high = (float(part) for part in region.groups()[:4])
    side = -1 if region.group(5) == "past" else 1
    at = lambda radius, degrees: (x + side * RADIUS * radius * math.sin(math.radians(degrees)), y + RADIUS * radius * math.cos(math.radians(degrees)))
    points = [at(outer, low + k * (high - low) / 24) for k in range(25)] + [at(inner, high - k * (high - low) / 24) for k in range(25)]
    return " ".join("%.1f,%.1f" % point for point in points)


def panel(x, title, model, found):
    y, middle = TOP + RADIUS, x + WIDTH / 2
    parts = [text(middle, TOP - 34, title, text_anchor="middle", font_weight="bold"),
             text(middle, TOP - 14, "power %+.1f %%" % model["power_percent"], text_anchor="middle", fill=FAINT),
             '<circle cx="%.1f" cy="%.1f" r="%d" fill="#f4f6f8" stroke="%s"/>' % (middle, y, RADIUS, INK)]
    sure = lambda row: float(row["adjusted_p"]) < SURE
    for row in sorted(found["regions"], key=sure):  # rims last, so that none is covered
        where = REGION.fullmatch(row["where"])
        errors = float(row["difference"]) / float(row["error"])
        rim = 'stroke="%s" stroke-width="2.5"' % INK if sure(row) else 'stroke="#d5dbe1"'
        parts.append('<polygon points="%s" fill="%s" %s><title>%s: %+.1f %%, %+.1f errors</title></polygon>'
                     % (sector(middle, y, where), colour(errors), rim, escape(row["where"]), 100 * float(row["difference"]) / float(row["a"]), errors))
    parts.append(text(middle, y + RADIUS + 34, "%d of %d quantities differ" % (found["differ"], found["observables"]), text_anchor="middle", font_size=18))
    return parts


def picture(one, panels):
    width, height = WIDTH * len(panels) + 40, TOP + 2 * RADIUS + 118
    title = "%s: what each model says of the speed that nobody fitted" % one.name
    parts = [text(20, 36, title, font_weight="bold", font_size=19),
             text(20, 62, "Hidden: %s. Recording: %d beads for %g s." % (one.effect["hypothesis"].replace("_", " "), one.beads, one.seconds), fill=FAINT)]
    for k, each in enumerate(panels):
        parts += panel(20 + WIDTH * k, *each)
    left = width / 2 - 160
    parts += ['<rect x="%.1f" y="%d" width="16" height="16" fill="%s" stroke="#d5dbe1"/>' % (left + 32 * k, height - 40, colour(errors)) for k, errors in enumerate((-10, -5, -2, 0, 2, 5, 10))]
    parts += [text(left - 10, height - 27, "beads slower, −%g errors" % FULL, text_anchor="end", fill=FAINT), text(left + 220, height - 27, "faster, +%g errors; rim: sure at %g %% for all regions" % (FULL, 100 * SURE), fill=FAINT)]
    return ('<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d" viewBox="0 0 %d %d" role="img" aria-label="%s" font-family="system-ui, Helvetica, Arial, sans-serif" '
            'font-size="15" fill="%s">\n<rect width="%d" height="%d" rx="12" fill="#fff"/>\n%s\n</svg>\n' % (width, height, width, height, escape(title), INK, width, height, "\n".join(parts)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("set", type=Path, help="an opened set below docs/proof")
    parser.add_argument("-o", "--output", type=Path, required=True, help="the SVG file")
    parser.add_argument("--camera", type=Path, default=ROOT / "configs/cameras/study.yaml")
    parser.add_argument("--millscope", type=Path, default=ROOT / "build/release/bin/millscope")
    parser.add_argument("--work", type=Path, default=ROOT / "build/proof_concealed")
    options = parser.parse_args()
    try:
        draw(options)
    except FileNotFoundError as missing:
        sys.exit("proof_concealed: %s is missing; give a set below docs/proof whose answers are open, and a build by --millscope" % missing.filename)
    except subprocess.CalledProcessError as failed:
        sys.exit("proof_concealed: '%s' failed, see above" % " ".join(failed.cmd[:3]))


def draw(options):
    one = Set(options.set)
    options.case = base_case(options.set.parent.name)
    options.program = subprocess.run([str(options.millscope), "--version"], check=True, capture_output=True, text=True).stdout
    work = options.work / options.set.parent.name / options.set.name
    work.mkdir(parents=True, exist_ok=True)
    truth = recorded(work, "truth", one.settings, options)
    words = dict(BASES, corrected="corrected: with %s" % one.best["name"].replace("_", " "))
    panels = []
    for name, title in words.items():
        model = recorded(work, name.replace(" ", "_"), one.settings_of(name), options)
        panels.append((title, one.models[name], compared(truth, model, options)))
        print("%s: %d of %d differ" % (name, panels[-1][2]["differ"], panels[-1][2]["observables"]))
    options.output.write_text(picture(one, panels))


if __name__ == "__main__":
    main()
