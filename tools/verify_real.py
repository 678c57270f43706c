"""The long checks of `diagnose` on recordings of real mills and of an independent code's, for verify.py; what is not there is not checked."""

import json
import math
import os
import re
from pathlib import Path

from verify_diagnose import diagnosis_of, friction_rows, held_rows, text_of, verdict_rows
from verify_rows import absent, row

ROOT = Path(__file__).resolve().parent.parent
RECORDINGS = ROOT.parent / "shared" / "recordings"
PROFILE, TRACK = RECORDINGS / "alizadeh2013_depth_velocity.csv", RECORDINGS / "uct_mill_part1.a"
# What the track's own rides along the shell tell (millscope pept inspect): axis in mm, speed in rpm, diameter in mm with a bead of 10 mm.
AXIS, RPM, DIAMETER = (-3.14, 13.18), 35.9, 470.6


def candidate_rows(found):
    """Every candidate: how much it helps, and how often chance would."""
    rows = []
    for h in found["hypotheses"]:
        values = "; ".join("%s %s" % (n, text_of(v)) for n, v in h["parameters"].items() if isinstance(v, dict))
        rows.append(row(h["name"], "delta Q %.1f, p %.2g%s" % (h["delta_q"], h["p_value"], "; " + values if values else "")))
    return rows


def drum(bench):
    """A published velocity profile of a drum against coarse-bead drums whose end faces stand still, though the real ones turned"""
    if not PROFILE.exists():
        return absent("the drum's profile", "absent: not checked")
    folder = bench.folder / "drum"
    folder.mkdir(exist_ok=True)
    text = (ROOT / "configs/drum/profile.yaml").read_text().replace("points.csv", os.path.relpath(PROFILE, folder))
    (folder / "profile.yaml").write_text(text)
    found = diagnosis_of(bench, folder, "diagnosis", "configs/drum/study.yaml", {"drum": os.path.relpath(folder / "profile.yaml", ROOT)})
    best = min(found["hypotheses"], key=lambda h: h["p_value"])
    return [row("the candidate that helps most", "%s (p %.2g)" % (best["name"], best["p_value"]), "turning_ends", best["name"] == "turning_ends")] \
        + verdict_rows(found, "turning_ends")[1:] + candidate_rows(found)


def turned(x, y, angle):
    dx, dy = x - AXIS[0], y - AXIS[1]
    return AXIS[0] + math.cos(angle) * dx - math.sin(angle) * dy, AXIS[1] + math.sin(angle) * dx + math.cos(angle) * dy


def spiked(change):
    """The lines of the track, each location (t ms, x, y, z mm) changed."""
    out = []
    for line in TRACK.read_text().splitlines():
        words = line.split()
        try:
            place = [float(w) for w in words[:4]]
        except ValueError:
            place = []
        if len(place) < 4 or len(words) < 8:
            out.append(line)
            continue
        place = change(*place)
        if place is not None:
            out.append(" ".join(["%.4f" % v for v in place] + words[4:]))
    return "\n".join(out) + "\n"


def thinned(keep=0.3, fast=0.7):
    """Of locations that lie farther from the one before than a slow bead goes only some are kept, by the last digit of their time."""
    last = [None]

    def change(t, x, y, z):
        before, last[0] = last[0], (t, x, y, z)
        if before is None or not 0 < t - before[0] < 50:
            return t, x, y, z
        speed = math.dist((x, y, z), before[1:]) / (t - before[0])
        return None if speed > fast and (int(10 * t) * 7919) % 1000 > 1000 * keep else (t, x, y, z)

    return change


FRAME = ("axis_x", "axis_y", "tilt", "clock")
SPIKES = {
    "as it is": (lambda *p: p, ""),
    "shifted by 9 mm along x": (lambda t, x, y, z: (t, x + 9, y, z), "axis_x"),
    "tilted by 80 mrad": (lambda t, x, y, z: (t, *turned(x, y, 0.08), z), "tilt"),
    "stretched by 2.5 % in time": (lambda t, x, y, z: (1.025 * t, x, y, z), "clock"),
    "thinned where fast": (thinned(), ""),
}


def kept_when_fast(found):
    """% of the locations that a camera keeps at twice the shell's speed of those at rest, and the line that says so; 100: none does."""
    for line in found["notes"]:
        known = re.search(r"loses fast beads.* (\d+) % at twice", line)
        if known:
            return int(known.group(1)), line
    return 100, "no loss of fast beads"


def uct(bench):
    """A real recording of 92 s of one tracer in a mill of which little is known: as it is, and with errors that were put in"""
    if not TRACK.exists():
        return absent("the recording", "absent: not checked")
    folder = bench.folder / "uct"
    folder.mkdir(exist_ok=True)
    rows, kept_as_is = [], 100
    for k, (name, (change, wanted)) in enumerate(SPIKES.items()):
        (folder / ("track%d.a" % k)).write_text(spiked(change))
        recording = folder / ("track%d.yaml" % k)
        recording.write_text("files: [track%d.a]\nformat: ctrack\ncondition: {speed: %g rpm, direction: clockwise, mill_diameter: %g mm}\n"
                             "frame: {axis: [%g mm, %g mm]}\n" % (k, RPM, DIAMETER, *AXIS))
        found = diagnosis_of(bench, folder, "diagnosis%d" % k, "configs/mill470/study.yaml", {"mill": os.path.relpath(recording, ROOT)})
        seen = [h["name"] for h in found["hypotheses"] if h["p_value"] <= 0.05]
        # Of the file as it is one bead in a mill of guesses may at most ask for another frame.
        good = seen == [wanted] if wanted else all(s in FRAME for s in seen)
        rows.append(row("%s: significant" % name, ", ".join(seen) or "nothing", wanted or "nothing but the camera's frame", good))
        kept, said = kept_when_fast(found)
        if name == "as it is":
            kept_as_is = kept
        more = kept < kept_as_is - 10 if name.startswith("thinned") else None
        rows.append(row("%s: of the camera" % name, said, "" if more is None else "that it loses more of them than as it is", more))
        rows.append(row("%s: in its words" % name, "%s: %s" % (found["verdict"], found["sentence"])))
        rows += [dict(r, what="%s: %s" % (name, r["what"])) for r in candidate_rows(found)]
    rows.append(stretched(bench, folder))
    return rows


# The worked example's mills (an independent DEM code, ../shared/recordings/README.md): power at each speed of them, W; what is hidden; frictions.
FRICTION_B = {"bead_friction": 0.2, "wall_friction": 0.3}
WORKED = {
    "A": ("mill10_A_%d_*.a", {75: 7.335, 60: 5.801, 50: 4.664}, "", {"bead_friction": 0.34, "wall_friction": 0.3}),
    "B": ("mill10_B_%d_*.a", {75: 7.323, 60: 5.986, 50: 4.860}, "rolling_resistance", FRICTION_B),
    "B, six times as long": ("mill10_long/mill10_B_%d_*.a.gz", {75: 7.336, 60: 5.982, 50: 4.860}, "rolling_resistance", FRICTION_B),
}
ROLLING = 0.1  # rolling friction of B, elastic-plastic


def worked(bench):
    """An independent code's mill, as it is (A) and with rolling friction that the power at 75 % conceals (B)"""
    if not list(RECORDINGS.glob("mill10_A_75_*.a")):
        return absent("the recordings", "absent: not checked")
    rows = []
    for name, (files, powers, hidden, friction) in WORKED.items():
        found = diagnosed_mill10(bench, name, [files], powers)
        rows.append(worked_verdict(name, found, hidden))
        more = [row("in its words", found["sentence"])] + candidate_rows(found) + friction_rows(found, friction, "unmasked" if hidden else "retuned")
        if hidden:
            p = next(h for h in found["hypotheses"] if h["name"] == hidden)["parameters"]["rolling_friction"]
            more += held_rows(found) + [row("rolling friction", text_of(p), "%g" % ROLLING, p["low90"] is not None and p["low90"] <= ROLLING <= p["high90"])]
        more += [row("where it differs most from the retuned base", m["sentence"]) for m in found["mismatch"][:2]]
        rows += [dict(r, what="%s: %s" % (name, r["what"])) for r in more]
    return rows + parts_of_b(bench)


def worked_verdict(name, found, hidden):
    right = (hidden in found["named"] and len(found["named"]) <= 3) if hidden else found["verdict"] == "no_mismatch"
    wanted = "%s in a class of at most three" % hidden if hidden else "no_mismatch"
    return row("%s: verdict" % name, "%s: %s" % (found["verdict"], ", ".join(found["named"]) or "nothing"), wanted, right)


def parts_of_b(bench):
    """B's long recording in six parts of 200 s, each diagnosed alone: how far the word hangs on the recording."""
    files, powers, hidden, _ = WORKED["B, six times as long"]
    rows = []
    for part in range(6):
        beads = [files.replace("*", "%02d" % n) for n in range(10 * part + 1, 10 * part + 11)]
        found = diagnosed_mill10(bench, "B_part%d" % part, beads, powers)
        rows.append(worked_verdict("B, part %d of 6" % (part + 1), found, hidden))
    return rows


def diagnosed_mill10(bench, name, files, powers):
    """diagnosis.json of one of the mills; all share one bank."""
    folder = bench.folder / "mill10"
    key = re.sub(r"\W+", "_", name)
    (folder / key).mkdir(parents=True, exist_ok=True)
    recordings = {}
    for speed, power in powers.items():
        text = (ROOT / "configs/mill10/recording.yaml").read_text()
        text = text.replace('"run*.a"', ", ".join('"%s"' % os.path.relpath(RECORDINGS / (f % speed), folder / key) for f in files))
        text = text.replace("speed: 75 %critical", "speed: %d %%critical" % speed).replace("7.335 W", "%g W" % power)
        file = folder / key / ("r%d.yaml" % speed)
        file.write_text(text)
        recordings["speed%d" % speed] = os.path.relpath(file, ROOT)
    return diagnosis_of(bench, folder, key + "/diagnosis", "configs/mill10/diagnose.yaml", recordings)


def stretched(bench, folder):
    """A clock that is 5 % slow contradicts the speed that is stated: reading refuses it before anything is diagnosed."""
    (folder / "stretched.a").write_text(spiked(lambda t, x, y, z: (1.05 * t, x, y, z)))
    found = json.loads(bench.call("pept", "inspect", os.path.relpath(folder / "stretched.a", ROOT), "--json")[0])
    rpm = [found["mill"]["angular_speed_rad_per_s"][k] * 30 / math.pi for k in ("value", "low", "high")]
    return row("stretched by 5 % in time: speed from its own rides", "%.2f (%.2f … %.2f) rpm" % tuple(rpm), "%.2f rpm, not %.2f" % (RPM / 1.05, RPM), rpm[2] < RPM)
