"""The long check of `calibrate`, for verify.py: recordings made with a known set of parameters, and whether the study finds them again."""

import json
import os
import time
from pathlib import Path

from verify_recorded import recorded
from verify_rows import row

ROOT = Path(__file__).resolve().parent.parent
STUDY = "configs/chagas2015/study.yaml"
SPEEDS = (75, 60, 50)
BEADS, SECONDS, SETTLED = 60, 20, 2  # a third of the study's hour, at each speed
TRUTH = {"CRPP": 0.80, "CFPP": 0.34, "CRPG": 0.55, "CFPG": 0.30}
# Recordings and simulations alike are four times softer than the study's slice, which halves the time that they take.
SOFTER = "stiffness_factor=0.0025"
FEWER = 16  # simulations of the emulator; both designs take 24 to 31
LONGEST_MIN = 75  # of both designs and the validation on two cores
# The recordings are of the slice: told as the whole mill, power and mass are those of 270 mm.
SLICE_LENGTH, MILL_LENGTH = 0.020, 0.270


def recording(bench, folder, speed):
    """recording.yaml of the study's own set at a speed, as a camera would have seen it; made once."""
    end = SETTLED + SECONDS
    summary = bench.run("calibrate_truth_%d" % speed, "configs/chagas2015/slice_%d.yaml" % speed, "seed=2015", SOFTER, "time.end_s=%d" % end, "time.analyze_from_s=%d" % SETTLED,
                        "output.frames=~", "output.tracks={beads: %d, every_s: 0.0005}" % BEADS)
    factor = MILL_LENGTH / SLICE_LENGTH
    power = tuple(factor * summary["power_W"][key] for key in ("com", "com_sem"))
    return recorded(bench, "calibrate_truth_%d" % speed, folder / ("r%d" % speed), power, "  mill_length: %g mm" % (1e3 * MILL_LENGTH))


def found(bench, folder, name, *settings):
    """calibration.json and validation.json of the study with these settings, seconds that it took, simulations that were there before."""
    out = folder / name
    common = [w for s in settings for w in ("--set", s)] + ["--cache", os.path.relpath(folder / "cache", ROOT)]
    known = len(list((folder / "cache").glob("*/task.json")))
    start = time.monotonic()
    bench.call("calibrate", STUDY, "-o", os.path.relpath(out, ROOT), *common, "-q")
    bench.call("validate", STUDY, "--calibration", os.path.relpath(out / "calibration.json", ROOT), "-o", os.path.relpath(out / "validation", ROOT), *common, "-q")
    return json.loads((out / "calibration.json").read_text()), json.loads((out / "validation" / "validation.json").read_text()), time.monotonic() - start, known


def rows_of(name, calibration, validation):
    rows = []
    for p in calibration["parameters"]:
        interval = p.get("posterior")
        text = "%.3f" % p["value"] + ("" if interval is None else "; 90 %%: %.3f … %.3f, %s determined" % (interval["low90"], interval["high90"], interval["determined"]))
        covers = None if interval is None else interval["low90"] <= TRUTH[p["name"]] <= interval["high90"]
        rows.append(row("%s: %s" % (name, p["name"]), text, "interval holds %.2f" % TRUTH[p["name"]], covers))
    rows.append(row("%s: Eq. 4.3 at the optimum" % name, "%.3f" % calibration["at_best"]["chagas2015"]["value"]))
    for condition, v in validation["conditions"].items():
        rows.append(row("%s: power at %s" % (name, condition), "%+.2f %%" % v["power"]["percent"], "pass", v["power"]["pass"]))
        rows.append(row("%s: misfit of all observables at %s" % (name, condition), "%.3g of %d, p %.2g" % (v["misfit"], len(v["observables"]), v["p"]), "pass", v["pass"]))
    rows.append(row("%s: observables of the validation that pass one by one" % name, "%d of %d" % (validation["passed"], validation["judged"])))
    return rows


def calibrate(bench):
    """The study from recordings to parameters: a known set is found again"""
    folder = bench.folder / "calibrate"
    recordings = [s for speed in SPEEDS
                  for s in ("conditions.dry%d.recording=%s" % (speed, recording(bench, folder, speed)), "conditions.dry%d.set.%s" % (speed, SOFTER))]
    classic, held, seconds, known = found(bench, folder, "response_surface", *recordings)
    friction = next(p for p in classic["parameters"] if p["name"] == "CFPP")
    place = classic["surface"]["stationary"]
    open_end = place["kind"] != "minimum" or not place["inside"]
    rows = [row("dominant factor of the screening", classic["screening"]["kept"][0], "CFPP", classic["screening"]["kept"][0] == "CFPP"),
            row("CFPP at the least value of the surface of Eq. 4.3", "%.3f" % friction["value"], "0.34 ± 0.05, or a surface that says that it has no minimum",
                abs(friction["value"] - TRUTH["CFPP"]) <= 0.05 or open_end),
            row("what the surface says of that", place["sentence"]),
            row("lack of fit of the surface", classic["surface"]["lack_of_fit_means"]),
            row("wall time of designs and validation", "%.0f min, %d simulations from the cache" % (seconds / 60, known), "< %d min on two cores with none" % LONGEST_MIN,
                None if known else seconds < 60 * LONGEST_MIN)]
    rows += rows_of("response surface", classic, held)
    modern, held, _, _ = found(bench, folder, "emulator", *recordings, "method=emulator", "budget.simulations=%d" % FEWER)
    better = modern["at_best"]["chagas2015"]["value"] < classic["at_best"]["chagas2015"]["value"]
    rows.append(row("emulator, Eq. 4.3 with %d simulations" % FEWER, "%.3f" % modern["at_best"]["chagas2015"]["value"], "less than the surface's", better))
    return rows + rows_of("emulator", modern, held)
