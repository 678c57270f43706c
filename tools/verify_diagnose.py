"""The long checks of `diagnose` on mills with hidden physics, for verify.py: the small mill of configs/story, its bank shared by all."""

import json
import os
from pathlib import Path

from verify_rows import row

ROOT = Path(__file__).resolve().parent.parent
STUDY, MILL, CAMERA = "configs/story/challenge_study.yaml", "configs/story/mill.yaml", "configs/cameras/study.yaml"
SPEEDS = (75, 60, 50)
BEADS, SECONDS, SETTLED = 60, 10, 1
# The mills that are recorded have ten times the stiffness of the fitted one and another rule for the tangential force.
OTHER = ("stiffness_factor=0.005", "contact.law.cap=sum")
FRICTION = {"bead_friction": ("pairs.glass~glass.static_friction", 0.34), "wall_friction": ("pairs.glass~hdpe.static_friction", 0.3)}
POOL = "body_forces.fluid_pool={kind: fluid_pool, fluid_density: 1000}"  # water up to 50 mm below the axis: a third of the radius deep
CLOSED = ("fill.vessel.length=120 mm", "geometry.liner.length=120 mm", "geometry.liner.end_faces=true", "domain=~")
CLOSED_AS_MAP = "{fill: {vessel: {length: 120 mm}}, geometry: {liner: {length: 120 mm, end_faces: true}}, domain: '~'}"


def recording(bench, folder, name, speed, *hidden, camera=(), frame=None):
    """recording.yaml of a mill with hidden settings, as a camera would have seen it; made once."""
    run = "diagnose_%s_%d" % (name.split("_")[0], speed)
    summary = bench.run(run, MILL, "mill.speed=%d %%critical" % speed, "seed=%d" % (2026 + speed), *OTHER, *("%s=%g" % f for f in FRICTION.values()),
                        "time={end_s: %d, analyze_from_s: %d}" % (SETTLED + SECONDS, SETTLED), "output.tracks={beads: %d, every_s: 0.0005}" % BEADS, *hidden)
    out = folder / name / ("r%d" % speed)
    out.mkdir(parents=True, exist_ok=True)
    if bench.fresh or not (out / "r.yaml").exists():
        bench.call("pept", "synthesize", os.path.relpath(bench.folder / run, ROOT), "-o", os.path.relpath(out / "r.a", ROOT), "--camera", CAMERA, "--force",
                   *(w for c in camera for w in ("--set", c)))
        # What a user knows: no geometry, the power with the meter's error.
        lines = [line for line in (out / "r.yaml").read_text().splitlines() if not line.strip().startswith(("power:", "geometry:"))]
        lines += ["  power: {value: %.9g W, sem: %.3g W}" % (summary["power_W"]["com"], summary["power_W"]["com_sem"])]
        (out / "r.yaml").write_text("\n".join(lines + (["frame: {axis: %s}" % frame] if frame else [])) + "\n")
    return os.path.relpath(out / "r.yaml", ROOT)


def diagnosed(bench, folder, name, recordings, *settings):
    """diagnosis.json of the recordings; all mills share one bank."""
    out = folder / name / "diagnosis"
    sets = ["conditions.speed%d.recording=%s" % (s, recordings[s]) for s in SPEEDS] + list(settings)
    bench.call("diagnose", STUDY, "-o", os.path.relpath(out, ROOT), "--cache", os.path.relpath(folder / "cache", ROOT), "-q", *(w for s in sets for w in ("--set", s)))
    return json.loads((out / "diagnosis.json").read_text())


def text_of(p):
    return "%.3f (%.3f … %.3f)" % (p["value"], p["low90"], p["high90"])


def friction_rows(found):
    """Friction retuned and unmasked against the truth, and fitted to each speed alone."""
    rows = []
    for name, (_, truth) in FRICTION.items():
        for kind, values in found["contact_parameters"].items():
            p = (values or {}).get(name)
            if p:
                rows.append(row("%s, %s" % (name, kind), text_of(p), "%.2f" % truth, p["low90"] <= truth <= p["high90"] if kind == "unmasked" else None))
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
    """A periodic slice as the base, a closed mill of 120 mm recorded"""
    folder = bench.folder / "diagnose"
    recordings = {s: recording(bench, folder, "closed", s, *CLOSED) for s in SPEEDS}
    found = diagnosed(bench, folder, "closed", recordings, "hypotheses.end_faces={sentence: The mill has end faces that turn with it., set: %s}" % CLOSED_AS_MAP)
    return verdict_rows(found, "end_faces") + held_rows(found) + friction_rows(found)


def wet(bench):
    """A wet mill that a dry base was retuned to"""
    folder = bench.folder / "diagnose"
    found = diagnosed(bench, folder, "wet", {s: recording(bench, folder, "wet", s, POOL) for s in SPEEDS})
    return verdict_rows(found, "fluid_pool") + held_rows(found) + friction_rows(found)


# What a camera may do to a recording, and the nuisance that stands for it; far beyond the priors.
AXIS = "[1.4 mm, -0.9 mm]"  # where the camera's file says that the mill's axis is
DOUBTS = {"offset_x": ("[-6 mm, 6 mm]", "1 mm", "4.5 mm", 0.0045), "tilt_z": ("[-0.06, 0.06]", "0.01", "0.045", 0.045), "clock": ("[-0.03, 0.03]", "0.005", "0.022", 0.022)}


def doubts(bench):
    """A camera that stands aside, is not level, or whose clock goes wrong"""
    folder = bench.folder / "diagnose"
    priors = ["nuisances.camera.frame_error.%s={range: %s, sigma: %s, name: %s}" % (name, span, sigma, name) for name, (span, sigma, _, _) in DOUBTS.items()]
    rows = []
    for spiked in [None, *DOUBTS]:
        camera = () if spiked is None else ("observations.spike={kind: frame_error, %s: %s}" % (spiked, DOUBTS[spiked][2]),)
        recordings = {s: recording(bench, folder, "dry" if spiked is None else "dry_" + spiked, s, camera=camera, frame=AXIS) for s in SPEEDS}
        found = diagnosed(bench, folder, "dry" if spiked is None else "dry_" + spiked, recordings, *priors)
        rows += [row("%s: %s" % (spiked or "as it was", r["what"]), *(r[k] for k in ("found", "wanted", "good"))) for r in verdict_rows(found, spiked or "nothing")[:2]]
        for h in found["hypotheses"]:
            if h["name"] == spiked and h.get("parameters", {}).get(spiked):
                p = h["parameters"][spiked]
                rows.append(row("%s, as fitted" % spiked, text_of(p), "%g" % DOUBTS[spiked][3], p["low90"] <= DOUBTS[spiked][3] <= p["high90"]))
    return rows
