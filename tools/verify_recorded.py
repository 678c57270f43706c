"""What a virtual camera makes of a run, told as a user of the real mill would know it; for the items of verify.py that play a recording."""

import os
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CAMERA = "configs/cameras/study.yaml"


def recorded(bench, run, out, power, *lines, camera=()):
    """recording.yaml beside r.a in `out`, made once: without geometry and exact power, with the measured power (value, standard error, W) and
    further lines of the file, those of `condition` first; `camera`: settings of its file."""
    out.mkdir(parents=True, exist_ok=True)
    file = out / "r.yaml"
    if bench.fresh or not file.exists() or file.stat().st_mtime < (bench.folder / run / "summary.json").stat().st_mtime:
        bench.call("pept", "synthesize", os.path.relpath(bench.folder / run, ROOT), "-o", os.path.relpath(out / "r.a", ROOT), "--camera", CAMERA, "--force",
                   *(word for setting in camera for word in ("--set", setting)))
        known = [line for line in file.read_text().splitlines() if not line.strip().startswith(("power:", "geometry:"))]
        file.write_text("\n".join(known + ["  power: {value: %.9g W, sem: %.3g W}" % power, *lines]) + "\n")
    return os.path.relpath(file, ROOT)
