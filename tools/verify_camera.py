"""The long checks of the virtual camera, for verify.py; docs/virtual_camera.md says what they mean."""

import json
import os
import shutil
from pathlib import Path

from verify_rows import row

ROOT = Path(__file__).resolve().parent.parent
CAMERA_CASE, CAMERA = "configs/cameras/closed_mill.yaml", "configs/cameras/study.yaml"
# What configs/cameras/study.yaml says, in the units of `pept camera --json`.
CAMERA_TRUTH = {"rate_per_s": 220, "noise.white_mm.x": 0.29, "noise.white_mm.z": 0.29, "noise.correlated_mm.x": 0.21,
                "noise.correlated_mm.z": 0.21, "noise.correlation_time_ms": 8, "noise.growth_per_m": 11, "losses.at_rest": 7.5 / 1.3,
                "losses.per_distance_per_m": 35 / 1.3, "losses.per_speed_s_per_m": 2.9 / 1.3, "axis_mm.x": 1.4, "axis_mm.y": -0.9}


def numbers(tree, path):
    for key in path.split("."):
        tree = tree[key]
    return tree


def camera(bench):
    """The camera estimated from recordings that a known camera made (24 recordings of two runs of 40 s)"""
    bench.run("camera", CAMERA_CASE)
    run, seen = bench.folder / "camera", bench.folder / "camera_seen"
    shutil.rmtree(seen, ignore_errors=True)
    seen.mkdir()
    bench.call("pept", "synthesize", os.path.relpath(run, ROOT), "-o", os.path.relpath(seen / "bead.a", ROOT), "--camera", CAMERA)
    found = {key: [] for key in CAMERA_TRUTH}
    for k in range(24):
        pair = seen / ("pair_%d.yaml" % k)
        pair.write_text("files: [bead_%d.a, bead_%d.a]\nformat: ctrack\n" % (2 * k + 1, 2 * k + 2))
        estimate = json.loads(bench.call("pept", "camera", "--json", os.path.relpath(pair, ROOT))[0])
        for key in found:
            if key.startswith("axis") and "axis_mm" not in estimate:
                continue
            found[key].append(numbers(estimate, key))
    bench.commands = bench.commands[:3]
    rows = []
    for key, truth in CAMERA_TRUTH.items():
        sure = [(f["value"], f["standard_error"]) for f in found[key] if f["standard_error"] is not None and f["standard_error"] > 0]
        within = sum(abs(v - truth) <= 2 * e for v, e in sure) / len(sure)
        values = sorted(v for v, _ in sure)
        errors = sorted(e for _, e in sure)
        rows.append(row(key.replace(".", " "), "median %.3g, usual standard error %.2g; within two of them %.0f %% of %d"
                        % (values[len(values) // 2], errors[len(errors) // 2], 100 * within, len(sure)),
                        "%.3g in at least 80 %%" % truth, within >= 0.8))
    return rows


def without_frame_error(bench):
    """The camera with its frame in the mill's, as the studies of fields want it."""
    text = (ROOT / CAMERA).read_text()
    plain = bench.folder / "camera_in_the_mills_frame.yaml"
    plain.write_text("".join(line for line in text.splitlines(True) if "frame_error" not in line))
    return os.path.relpath(plain, ROOT)


def roundtrip(bench):
    """A simulated bead through the virtual camera and back: fields against those of the whole charge (48 beads of 40 s)"""
    bench.run("camera", CAMERA_CASE)
    found = bench.study("fields", os.path.relpath(bench.folder / "camera", ROOT), without_frame_error(bench), 30, 48)
    rows = []
    for key, what in (("cells_by_mean_visits", "cells that a bead visits ten times on average"), ("cells_by_own_visits", "cells that the bead itself visited ten times")):
        for name, f in found[key].items():
            wanted = key == "cells_by_mean_visits"
            rows.append(row("%s: the 90 %% interval holds the truth, %s" % (name, what), "%.1f %% of %d" % (100 * f["coverage"], f["cells"]),
                            "85 to 95 %" if wanted else "", 0.85 <= f["coverage"] <= 0.95 if wanted else None))
    rows.append(row("bias of the mean speed in a cell", "%+.1f mm/s, %+.2f %%" % (1e3 * found["speed"]["bias_m_per_s"], 100 * found["speed"]["relative"])))
    for c in found["speed"]["classes"]:
        rows.append(row("… where beads go %g to %g m/s (%.0f %% of the time)" % (c["from_m_per_s"], c["to_m_per_s"], 100 * c["share"]),
                        "%+.1f mm/s, %+.2f %%" % (1e3 * c["bias_m_per_s"], 100 * c["relative"])))
    return rows


def bbosa(bench):
    """Bbosa's power over the exact one, by noise and cell size (48 beads of 40 s)"""
    bench.run("camera", CAMERA_CASE)
    found = bench.study("power", os.path.relpath(bench.folder / "camera", ROOT), without_frame_error(bench))
    sizes = sorted(found["whole_charge"], key=int)

    def line(cells, kind):
        return ", ".join("%.3f" % cells[n][kind]["over_exact"] for n in sizes)

    heads = "cells across: " + ", ".join(sizes)
    rows = [row("exact power of the charge, of the beads", "%.4g W, %.4g W" % (found["exact_W"], found["beads_W"])),
            row("whole charge, exact (%s)" % heads, line(found["whole_charge"], "bbosa")),
            row("beads followed, exact", line(found["beads"], "bbosa")), row("… |⟨ω⟩| for ⟨|ω|⟩", line(found["beads"], "bbosa_of_mean")),
            row("… signed", line(found["beads"], "bbosa_signed"))]
    for s in found["seen"]:
        rows.append(row("seen with %g times the noise, %s spline" % (s["noise"], s["spline"]), line(s["cells"], "bbosa")))
        rows.append(row("… M g ⟨x⟩ Ω", line(s["cells"], "gravity")))
    return rows
