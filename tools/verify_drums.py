"""The long checks on two measured drums, for verify.py, and what verify_granudrum.py shares with them; what is not there is not run."""

import csv
import hashlib
import math
import sys

from public_data import DATA, ROOT
from verify_rows import absent, row

sys.path.insert(0, str(ROOT / "python"))
SOURCES = {  # in DATA: where they are public, and their licence
    "granudrum/dem_grid_surface_angles.csv": "read off the pictures of github.com/anicusan/InteractiveGranuDrumCalibration, GPL-3.0",
    **{"granudrum/gd_nature_%drpm_averaged.bmp" % rpm: "github.com/uob-positron-imaging-centre/ACCES-GranuDrum-Calibration, GPL-3.0" for rpm in (10, 15, 30, 45)},
    "rotating_drum/alizadeh2013_free_surface_velocity.csv":
        "github.com/chaos-polymtl/lethe, examples/dem/3d-rotating-drum/free_surface_velocity.dat, Apache-2.0 with LLVM exception or LGPL-2.1-or-later",
}

DEPTH = 0.006  # two beads: how deep the surface of Alizadeh's drum is looked at, m
HOW = "Angles are of a straight line through the middle half of the drum, where the density along the axis is half that of the bed."
SCATTER = 0.1  # of the points of its free surface, of their greatest speed


def not_run(folder):
    """Why an item cannot be run, as its only row; none: it can be."""
    lacking = [name for name in SOURCES if name.startswith(folder) and not (DATA / name).exists()]
    if lacking:
        return absent(", ".join(lacking), "absent from the folder of MILLSCOPE_DATA: not run")
    try:
        import h5py, numpy, pandas, yaml  # noqa: E401, F401
    except ImportError as reason:
        return absent("the analysis of frames", "%s: not run; it needs python3-h5py, python3-pandas, python3-yaml" % reason)
    return []


def sources(folder):
    """Where the data come from, and which they were, as Markdown."""
    known = [(name, hashlib.sha256((DATA / name).read_bytes()).hexdigest(), whence) for name, whence in SOURCES.items() if name.startswith(folder)]
    return "Data that are not ours, below the folder of `MILLSCOPE_DATA`:\n\n" + "\n".join("- `%s`, sha256 `%s`: %s." % line for line in known)


def table(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


def frames_of(folder):
    """What the drum's frames hold: place and velocity [frame, bead, 3], radius of each bead, angular speed."""
    import millscope
    frames = millscope.open_run(folder).frames
    return frames.position_m[:], frames.velocity_m_per_s[:], frames.beads.radius_m.to_numpy(), float(frames.angular_velocity_rad_per_s[-1])


def angle_of(folder, bore, band=None):
    """What drum_surface.surface() says, and how the shell carries the bed; `band`: only of beads so near to z = 0 or to the other end, (m, m)."""
    import drum_surface
    positions, velocities, radii, speed = frames_of(folder)
    if band:
        near, length = band
        positions[(positions[..., 2] > near) & (positions[..., 2] < length - near)] = 2 * bore  # out of the picture
    mean = positions.mean(axis=(0, 1))
    return dict(drum_surface.surface(*drum_surface.pictures(positions, radii, bore), bore), centre=math.degrees(math.atan2(mean[0], -mean[1])),
                slip=drum_surface.wall_slip(positions, velocities, radii, bore, speed))


def shown(found):
    return "%.1f ± %.1f°" % (found["angle"], found["error"])


def lost(summaries):
    """The energy that the steps made or lost, at worst, against what the walls gave."""
    worst = max(abs(s["energy"]["imbalance_fraction"]) for s in summaries)
    return row("energy not accounted for, at most", "%.2g %% of what the walls gave" % (100 * worst), "< 5 %", worst < 0.05)


def beads6000(bench):
    """6000 beads in a drum whose surface was measured at 26 degrees"""
    bore, length, grid = 0.138, 0.185, "granudrum/dem_grid_surface_angles.csv"
    if not_run(grid):
        return not_run(grid)
    s = bench.run("beads6000", "configs/measured_drums/beads6000.yaml")
    found = angle_of(bench.folder / "beads6000", bore)
    ends = angle_of(bench.folder / "beads6000", bore, (0.0225, length))
    theirs = [float(r["angle_mid_half_deg"]) for r in table(DATA / grid) if (r["rpm"], r["sliding"], r["rolling"]) in (("30", "0.3", "0.01"), ("30", "0.3", "0.05"))]
    bench.say("The frictions are those with which the authors of lethe match the measured angle in their own program. Left out: how the angle was measured, "
              "which is not public, and its error. " + HOW, sources(grid))
    return [row("surface angle", shown(found), "26° (measured), within 1.5", abs(found["angle"] - 26) < 1.5),
            row("the same within 22.5 mm of the ends, where lethe's authors read theirs", shown(ends), "26° (measured)"),
            row("LIGGGHTS in another drum, sliding 0.3, rolling 0.01 and 0.05, Froude number 0.042 (here 0.034)", "%.1f and %.1f°" % tuple(theirs)),
            row("the shell carries the beads that touch it at", "%.0f %% of its speed" % found["slip"]), lost([s])]


def alizadeh(bench):
    """A slice of Alizadeh's drum: the measured velocity along its free surface"""
    file, bore = "rotating_drum/alizadeh2013_free_surface_velocity.csv", 0.24
    if not_run(file):
        return not_run(file)
    import drum_pictures
    import drum_surface
    import numpy
    points = [(float(r["x_over_R"]), float(r["vx_over_vmax"])) for r in table(DATA / file)]
    s = bench.run("alizadeh", "configs/measured_drums/alizadeh.yaml")
    found = angle_of(bench.folder / "alizadeh", bore)
    positions, velocities, radii, speed = frames_of(bench.folder / "alizadeh")
    rows = [row("surface angle", "%.1f ± %.1f°" % (found["angle"], found["error"]), "27° (measured), within 1.5", abs(found["angle"] - 27) < 1.5),
            row("the shell carries the beads that touch it at", "%.0f %% of its speed" % found["slip"])]
    for depth in (DEPTH / 2, DEPTH, 2 * DEPTH):
        place, down, error = drum_surface.along(positions, velocities, radii, bore, found["angle"], depth)
        fastest = down.max()
        ways = {way: numpy.array([v - numpy.interp(x, sign * place[::sign], down[::sign] / fastest) for x, v in points])
                for way, sign in (("down the surface", 1), ("up it", -1))}
        said = "; ".join("%.3f (mean %+.3f) if their x points %s" % (math.sqrt((d ** 2).mean()), d.mean(), way) for way, d in ways.items())
        best = min(math.sqrt((d ** 2).mean()) for d in ways.values())
        rows.append(row("measured less ours, rms, beads down to %.0f mm below the surface" % (1e3 * depth), said,
                        "as the points' scatter: within %.2g" % (1.5 * SCATTER) if depth == DEPTH else "", best < 1.5 * SCATTER if depth == DEPTH else None))
        if depth == DEPTH:
            drawn = place, down / fastest
            rows.append(row("greatest speed along the surface", "%.3f ± %.3f m/s, %.1f times the shell's" % (fastest, error[down.argmax()], fastest / (speed * bore / 2)),
                            "not in the data"))
    drum_pictures.free_surface(ROOT / "docs" / "drum_free_surface.svg", points, drawn)
    bench.say("![Measured points and our line of the velocity along the free surface](drum_free_surface.svg)")
    bench.say("Left out: the drum's length of 360 mm and its end faces (here a periodic slice of 12 mm, beads of the real 3 mm, and small ribs for a rough shell), "
              "the beads' true stiffness. The points are read off a figure; which way their x runs is not said. " + HOW, sources(file))
    return rows + [lost([s])]
