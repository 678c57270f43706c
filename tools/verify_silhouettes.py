"""Which physics do measured pictures of a drum ask for? For verify.py: the study of configs/measured_drums/silhouettes, with finer beads as a check."""

import os
import re
import shutil

import drum_pictures
from verify_diagnose import diagnosis_of
from verify_drums import DATA, ROOT, angle_of, not_run, sources
from verify_granudrum import BORE, WINDOWS, pictured_angles
from verify_rows import row

CONFIGS = ROOT / "configs" / "measured_drums" / "silhouettes"
FITTED, HELD_OUT = (15, 45), (10, 30)  # rpm
PATHS = {"bead_friction": "pairs.default.static_friction", "filling": "fill.filling", "disc_friction": "pairs.cellulose~disc.static_friction"}
KINDS = {"rolling_friction": "rolling_constant_torque", "bead_shape": "bead_shape"}  # of candidates, the plugin
FINER = "beads.cellulose.diameter=2 mm"
ERRORS = {"camera": 0.5, "size": 2}  # degrees, of a picture's directions: how level its camera stood; what beads of another size change beside it
PICTURE = "gd_nature_%drpm_averaged.bmp"


def folder_of(bench):
    """Case, study, pictures and the recordings that tell of them, side by side."""
    folder = bench.folder / "silhouettes"
    folder.mkdir(exist_ok=True)
    for file in CONFIGS.iterdir():
        shutil.copy(file, folder)
    for rpm in FITTED + HELD_OUT:
        shutil.copy(DATA / "granudrum" / (PICTURE % rpm), folder)
        for name, error in ERRORS.items():
            (folder / ("%s_%drpm.yaml" % (name, rpm))).write_text(
                "silhouette: {file: %s, angle_error: %g deg}\ncondition: {speed: %d rpm, mill_diameter: 84 mm}\n" % (PICTURE % rpm, error, rpm))
    return folder


def diagnosis_with(bench, folder, name):
    """diagnosis.json with the recordings of a name in ERRORS; both share one bank."""
    recordings = {"rpm%d" % rpm: os.path.relpath(folder / ("%s_%drpm.yaml" % (name, rpm)), ROOT) for rpm in FITTED + HELD_OUT}
    return diagnosis_of(bench, folder, "diagnosis_" + name, os.path.relpath(folder / "study.yaml", ROOT), recordings)


def slope(bench, case, name, rpm, *settings):
    """Angle of the bed's outline in a run and its standard error, degrees; read as the pictures are."""
    out = "silhouettes_%s_%d" % (name, rpm)
    start, end = WINDOWS[rpm]
    bench.run(out, os.path.relpath(case, ROOT), "mill.speed=%d rpm" % rpm, "time.end_s=%g" % end, "time.analyze_from_s=%g" % start,
              "output={frames: {every_s: 0.02, from_s: %g}}" % start, *settings)
    found = angle_of(bench.folder / out, BORE)
    return found["outline"], found["outline_error"]


def hypothesis_rows(found):
    rows = [row("verdict", found["verdict"] + ": " + found["sentence"]), row("p of the retuned base", "%.2g" % found["base"]["p_value"])]
    for h in found["hypotheses"]:
        strength = ", ".join("%s %.3g" % (name, p["value"]) for name, p in h["parameters"].items())
        rows.append(row("%s (%s)" % (h["name"], strength), "ΔQ %.3g, p %.2g; %s" % (h["delta_q"], h["p_value"], h["class"])))
    for held in found["held_out"]:
        misfits = ", ".join("%s %.3g%s" % (m["model"], m["misfit"], " (simulated)" if m["simulated"] else "") for m in held["models"])
        rows.append(row("%s, held out: misfit a number" % held["condition"], misfits, "about 1 where only chance is left"))
    return rows


def settings_of(parameters):
    return ["%s=%.6g" % (PATHS[name], p["value"]) for name, p in parameters.items()]


def angle_rows(bench, folder, found):
    """The surface of the retuned base and of the best candidate as fitted, with the beads of the study and with finer ones."""
    best, case = max((h for h in found["hypotheses"] if h["name"] in KINDS), key=lambda h: h["delta_q"]), folder / "drum.yaml"
    effect = ["contact.interactions={it: {kind: %s}}" % KINDS[best["name"]]] \
        + ["pairs.%s.%s=%.6g" % (pair, name, p["value"]) for pair in ("default", "cellulose~disc") for name, p in best["parameters"].items()]
    models = {"base": settings_of(found["contact_parameters"]["retuned"]), best["name"]: effect + settings_of(best["contact_parameters"])}
    models.update({model + ", finer": settings + [FINER] for model, settings in list(models.items())})
    angles = {(model, rpm): slope(bench, case, re.sub(r"\W+", "_", model), rpm, *settings) for rpm in FITTED + HELD_OUT for model, settings in models.items()}
    measured = pictured_angles()
    drum_pictures.speeds(ROOT / "docs" / "drum_silhouettes.svg", measured, angles, FITTED)
    return [row("surface at %d rpm (%s)" % (rpm, "fitted" if rpm in FITTED else "held out"), "; ".join("%s %.1f ± %.1f°" % (m, *angles[m, rpm]) for m in models),
                "%.1f° (measured)" % measured[rpm]) for rpm in FITTED + HELD_OUT]


def silhouettes(bench):
    """Which physics four measured pictures of beads that are not round ask for (two hours of two cores)"""
    if not_run("granudrum"):
        return not_run("granudrum")
    folder = folder_of(bench)
    found = {name: diagnosis_with(bench, folder, name) for name in ERRORS}
    bench.say("Beads of 2.8 mm stand for 1.0 to 1.5 mm; those of 2 mm say what that changes. Left out: the sizes' spread, humidity, cohesion (contacts this soft do not "
              "bear it: such runs made energy). The same bank is asked twice. With ± 0.5° only the camera may stand aside. With ± 2° the coarse beads may lie otherwise, too.",
              sources("granudrum/gd"))
    rows = [dict(r, what="± %g°: %s" % (error, r["what"])) for name, error in ERRORS.items() for r in hypothesis_rows(found[name])]
    return rows + angle_rows(bench, folder, found["size"])
