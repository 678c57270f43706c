"""The long checks of `diagnose` on mills with hidden physics, for verify.py: the small mill of configs/story, its bank shared by all."""

import json
import os
from dataclasses import dataclass
from pathlib import Path

from verify_recorded import recorded
from verify_rows import row

ROOT = Path(__file__).resolve().parent.parent
SPEEDS = (75, 60, 50)
FRICTION = {"bead_friction": 0.34, "wall_friction": 0.3}
POOL = "body_forces.fluid_pool={kind: fluid_pool, fluid_density: 1000}"  # water up to 50 mm below the axis: a third of the radius deep


@dataclass(frozen=True)
class Mill:
    """A mill that is recorded, and the study that is asked about it."""

    study: str
    case: str
    wall: str  # pair of bead and liner
    beads: int
    seconds: float
    settled: float  # s
    numerics: tuple  # other stiffness than that of the fitted mill, and another rule for the tangential force


STORY = Mill("configs/story/challenge_study.yaml", "configs/story/mill.yaml", "glass~hdpe", 60, 10, 1, ("stiffness_factor=0.005", "contact.law.cap=sum"))
LARGE = Mill("configs/mill10/ends.yaml", "configs/mill10/case.yaml", "glass~liner", 100, 8, 2,
             ("stiffness_factor=0.003", "contact.law.cap=sum", "fill.vessel.length=120 mm", "geometry.liner.length=120 mm"))


def recording(bench, folder, name, speed, *hidden, camera=(), frame=None, mill=STORY, seed=2026):
    """recording.yaml of a mill with hidden settings, as a camera would have seen it; made once."""
    run = "diagnose_%s_%d" % (name.split("_")[0], speed)
    friction = ["pairs.%s.static_friction=%g" % f for f in zip(("glass~glass", mill.wall), FRICTION.values())]
    summary = bench.run(run, mill.case, "mill.speed=%d %%critical" % speed, "seed=%d" % (seed + speed), *mill.numerics, *friction,
                        "time={end_s: %d, analyze_from_s: %d}" % (mill.settled + mill.seconds, mill.settled),
                        "output.tracks={beads: %d, every_s: 0.0005}" % mill.beads, *hidden)
    power = summary["power_W"]["com"], summary["power_W"]["com_sem"]
    return recorded(bench, run, folder / name / ("r%d" % speed), power, *(["frame: {axis: %s}" % frame] if frame else []), camera=camera)


def diagnosis_of(bench, folder, name, study, recordings, *settings):
    """diagnosis.json that a study makes of its recordings (condition: path from the root); all studies of a folder share one bank."""
    out = folder / name
    sets = ["conditions.%s.recording=%s" % r for r in recordings.items()] + list(settings)
    bench.call("diagnose", study, "-o", os.path.relpath(out, ROOT), "--cache", os.path.relpath(folder / "cache", ROOT), "-q", *(w for s in sets for w in ("--set", s)))
    return json.loads((out / "diagnosis.json").read_text())


def diagnosed(bench, folder, name, recordings, *settings, mill=STORY):
    """diagnosis.json of a mill's recordings at every speed."""
    return diagnosis_of(bench, folder, name + "/diagnosis", mill.study, {"speed%d" % s: recordings[s] for s in SPEEDS}, *settings)


def text_of(p):
    return "%.3f" % p["value"] if p["low90"] is None else "%.3f (%.3f … %.3f)" % (p["value"], p["low90"], p["high90"])


def friction_rows(found, truths=FRICTION, right="unmasked"):
    """Friction retuned and unmasked against the truth, which the model that is right has to hold, and fitted to each speed alone."""
    rows = []
    for name, truth in truths.items():
        for kind, values in found["contact_parameters"].items():
            p = (values or {}).get(name)
            if p:
                rows.append(row("%s, %s" % (name, kind), text_of(p), "%.2f" % truth, p["low90"] <= truth <= p["high90"] if kind == right else None))
        for kind in ("before", "after"):
            each = [c[kind][name]["value"] for c in found["per_speed_friction"] if c.get(kind)]
            if each:
                rows.append(row("%s fitted to each speed alone, %s" % (name, kind), ", ".join("%.3f" % v for v in each) + "; apart by %.3f" % (max(each) - min(each))))
    return rows


def held_rows(found):
    """What the models make of the condition that was not fitted."""
    rows = []
    for held in found["held_out"]:
        for m in held["models"]:
            gain = m.get("improvement_of_corrected")
            rows.append(row("%s: %s" % (held["condition"], m["model"]), "misfit %.2f, power %+.1f %%" % (m["misfit"], m["power_percent"])
                            + ("" if gain is None else "; the corrected one is better by %.2f (%.2f … %.2f)" % (gain["value"], gain["low90"], gain["high90"])),
                            "" if gain is None else "above 0", None if gain is None else gain["low90"] > 0))
    return rows


def verdict_rows(found, wanted):
    named = ", ".join(found["named"]) or "nothing"
    rows = [row("verdict", "%s: %s" % (found["verdict"], named), wanted, named == wanted), row("in its words", found["sentence"])]
    return rows + [row("where it differs most from the retuned base", m["sentence"]) for m in found["mismatch"][:3]]


def ends(bench):
    """A periodic slice of 300 mm as the base, the same mill with end faces and 120 mm long recorded, then three times more with other seeds"""
    folder = bench.folder / "diagnose"

    def found_in(name, **seed):
        return diagnosed(bench, folder, name, {s: recording(bench, folder, name, s, mill=LARGE, **seed) for s in SPEEDS}, mill=LARGE)

    found = found_in("long")
    rows = verdict_rows(found, "end_faces") + held_rows(found) + friction_rows(found)
    for again in (1, 2, 3):
        more = verdict_rows(found_in("ends%d" % again, seed=5000 * again), "end_faces")[:2]
        rows += [dict(r, what="other seeds, %d: %s" % (again, r["what"])) for r in more]
    return rows


def wet(bench):
    """A wet mill that a dry base was retuned to"""
    folder = bench.folder / "diagnose"
    found = diagnosed(bench, folder, "wet", {s: recording(bench, folder, "wet", s, POOL) for s in SPEEDS})
    return verdict_rows(found, "fluid_pool") + held_rows(found) + friction_rows(found)


# What a camera may do to a recording, and the nuisance that stands for it: range, prior, and a value far beyond the prior, m, rad, 1.
AXIS = "[1.4 mm, -0.9 mm]"  # where the camera's file says that the mill's axis is
DOUBTS = {"offset_x": ("[-6 mm, 6 mm]", "1 mm", 0.0045), "tilt_z": ("[-0.06, 0.06]", "0.01", 0.045), "clock": ("[-0.03, 0.03]", "0.005", 0.022)}


def doubts(bench):
    """A camera that stands aside, is not level, or whose clock goes wrong"""
    folder = bench.folder / "diagnose"
    priors = ["nuisances.camera.frame_error.%s={range: %s, sigma: %s, name: %s}" % (name, span, sigma, name) for name, (span, sigma, _) in DOUBTS.items()]
    rows = doubted(bench, folder, "dry", "as it was", "nothing", priors)[0]
    for name, (_, _, value) in DOUBTS.items():
        more, found = doubted(bench, folder, "dry_" + name, name, name, priors, "observations.spike={kind: frame_error, %s: %g}" % (name, value))
        p = next(h for h in found["hypotheses"] if h["name"] == name)["parameters"][name]
        rows += more + [row("%s, as fitted" % name, text_of(p), "%g" % value, p["low90"] is not None and p["low90"] <= value <= p["high90"])]
    return rows


def doubted(bench, folder, mill, title, wanted, priors, *camera):
    """Verdict and diagnosis of a dry mill through a camera with more links."""
    found = diagnosed(bench, folder, mill, {s: recording(bench, folder, mill, s, camera=camera, frame=AXIS) for s in SPEEDS}, *priors)
    return [dict(r, what="%s: %s" % (title, r["what"])) for r in verdict_rows(found, wanted)[:2]], found
