"""The long checks on drums that others measured or simulated, for verify.py; what is not there is not run."""

import csv
import hashlib
import math
import os
import sys
from pathlib import Path

from verify_rows import row

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "python"))
DATA = Path(os.environ.get("MILLSCOPE_DATA", ROOT.parent / "shared" / "public_cases" / "data"))
SOURCES = {  # in DATA: where they are public, and their licence
    "granudrum/dem_grid_surface_angles.csv": "read off the pictures of github.com/anicusan/InteractiveGranuDrumCalibration, GPL-3.0",
    **{"granudrum/gd_nature_%drpm_averaged.bmp" % rpm: "github.com/uob-positron-imaging-centre/ACCES-GranuDrum-Calibration, GPL-3.0" for rpm in (10, 15, 30, 45)},
    "rotating_drum/alizadeh2013_free_surface_velocity.csv":
        "github.com/chaos-polymtl/lethe, examples/dem/3d-rotating-drum/free_surface_velocity.dat, Apache-2.0 with LLVM exception or LGPL-2.1-or-later",
}

GRANUDRUM, BORE = "configs/measured_drums/granudrum.yaml", 0.084  # m
WINDOWS = {10: (1.2, 2.4), 15: (0.9, 1.9), 30: (0.7, 1.5), 45: (0.55, 1.3), 50: (0.5, 1.2)}  # rpm → from, to, s
MIDDLE = (30, 0.5, 0.1)  # rpm, sliding, rolling
POINTS = [(rpm, sliding, rolling) for rpm in (50, 10) for sliding in (0.15, 1.0) for rolling in (0, 0.7)] \
    + [MIDDLE, (30, 0.3, 0.4), (50, 0.5, 0.1), (10, 0.5, 0.1)]
FITTED = (0.562, 0.291)  # sliding and rolling, by the owners of the measurement, to 15 and 45 rpm
POWDER, AIR = 22, 247  # grey of the measured pictures
DEPTH = 0.006  # two beads: how deep the surface of Alizadeh's drum is looked at, m
SCATTER = 0.1  # of the points of its free surface, of their greatest speed


def not_run(folder):
    """Why an item cannot be run, as its only row; none: it can be."""
    lacking = [name for name in SOURCES if name.startswith(folder) and not (DATA / name).exists()]
    if lacking:
        return [row(", ".join(lacking), "absent from the folder of MILLSCOPE_DATA: not run")]
    try:
        import h5py, numpy, pandas, yaml  # noqa: E401, F401
    except ImportError as reason:
        return [row("the analysis of frames", "%s: not run; it needs python3-h5py, python3-pandas, python3-yaml" % reason)]
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


def drums(bench):
    """Two measured drums: the angle of 6000 beads, and the velocity along a free surface"""
    measured = DATA / "rotating_drum" / "alizadeh2013_free_surface_velocity.csv"
    if not_run("rotating_drum"):
        return not_run("rotating_drum")
    points = [(float(r["x_over_R"]), float(r["vx_over_vmax"])) for r in table(measured)]
    few, rows = few_beads(bench)
    many = bench.run("alizadeh", "configs/measured_drums/alizadeh.yaml")
    rows += alizadeh(bench, points) + [lost(few + [many])]
    bench.say("Left out: the beads' true stiffness, and of Alizadeh's drum its length of 360 mm and its end faces (a periodic slice of 12 mm, beads of the "
              "real 3 mm). His points are read off a figure; the angles come without an error. Angles are of a straight line through the middle half of the "
              "drum, where the density along the axis is half that of the bed.", sources("rotating_drum"))
    return rows


def few_beads(bench):
    """Summaries and rows of the drum of 6000 beads."""
    bore, length, case = 0.138, 0.185, "configs/measured_drums/beads6000.yaml"
    runs = [bench.run("beads6000", case), bench.run("beads6000_smoother", case, "pairs.default.static_friction=0.15")]
    found, smoother = (angle_of(bench.folder / name, bore) for name in ("beads6000", "beads6000_smoother"))
    ends = angle_of(bench.folder / "beads6000", bore, (0.0225, length))
    return runs, [
        row("6000 beads: surface angle", shown(found), "26° (measured), within 1.5", abs(found["angle"] - 26) < 1.5),
        row("6000 beads: within 22.5 mm of its ends, where lethe's authors read theirs", shown(ends), "26° (measured)"),
        row("6000 beads: with a sliding friction of 0.15 for 0.3", shown(smoother), "26° (measured)"),
        row("6000 beads: its shell carries the beads that touch it at", "%.0f and %.0f %% of its speed" % (found["slip"], smoother["slip"]))]


def alizadeh(bench, points):
    """Rows of the slice of Alizadeh's drum; its picture."""
    import drum_pictures
    import drum_surface
    import numpy
    bore = 0.24
    found = angle_of(bench.folder / "alizadeh", bore)
    positions, velocities, radii, speed = frames_of(bench.folder / "alizadeh")
    rows = [row("Alizadeh: surface angle", "%.1f ± %.1f°" % (found["angle"], found["error"]), "27° (measured), within 1.5", abs(found["angle"] - 27) < 1.5),
            row("Alizadeh: the shell carries the beads that touch it at", "%.0f %% of its speed" % found["slip"])]
    for depth in (DEPTH / 2, DEPTH, 2 * DEPTH):
        place, down, error = drum_surface.along(positions, velocities, radii, bore, found["angle"], depth)
        fastest = down.max()
        ways = {way: numpy.array([v - numpy.interp(x, sign * place[::sign], down[::sign] / fastest) for x, v in points])
                for way, sign in (("down the surface", 1), ("up it", -1))}
        said = "; ".join("%.3f (mean %+.3f) if their x points %s" % (math.sqrt((d ** 2).mean()), d.mean(), way) for way, d in ways.items())
        best = min(math.sqrt((d ** 2).mean()) for d in ways.values())
        rows.append(row("Alizadeh: measured less ours, rms, beads down to %.0f mm below the surface" % (1e3 * depth), said,
                        "as the points' scatter: within %.2g" % (1.5 * SCATTER) if depth == DEPTH else "", best < 1.5 * SCATTER if depth == DEPTH else None))
        if depth == DEPTH:
            drawn = place, down / fastest
            rows.append(row("Alizadeh: greatest speed along the surface", "%.3f ± %.3f m/s, %.1f times the shell's" % (fastest, error[down.argmax()], fastest / (speed * bore / 2)),
                            "not in the data"))
    drum_pictures.free_surface(ROOT / "docs" / "drum_free_surface.svg", points, drawn)
    bench.say("![Measured points and our line of the velocity along the free surface](drum_free_surface.svg)")
    return rows


def run_granudrum(bench, rpm, sliding, rolling, *more):
    """Summary of a run at a point of the grid, and what its surface is."""
    start, end = WINDOWS[rpm]
    name = "_".join(["granudrum", "%d" % rpm, "%g" % sliding, "%g" % rolling] + [m.split("=")[1].split()[0] for m in more])
    settings = ("mill.speed=%d rpm" % rpm, "pairs.default.static_friction=%g" % sliding, "pairs.default.rolling_friction=%g" % rolling,
                "time.end_s=%g" % end, "time.analyze_from_s=%g" % start, "output.frames.from_s=%g" % start, "output.frames.every_s=%g" % ((end - start) / 50))
    return bench.run(name, GRANUDRUM, *settings, *more), angle_of(bench.folder / name, BORE)


def granudrum(bench):
    """Surface angles of a small drum against another group's LIGGGHTS runs and against its measured beads"""
    file = DATA / "granudrum" / "dem_grid_surface_angles.csv"
    if not_run("granudrum"):
        return not_run("granudrum")
    grid = {(int(r["rpm"]), float(r["sliding"]), float(r["rolling"])): float(r["angle_mid_half_deg"]) for r in table(file)}
    covered = {(int(r["rpm"]), float(r["sliding"]), float(r["rolling"])): float(r["bright_fraction_of_disc"]) for r in table(file)}
    measured, rows = pictured_angles(), []
    runs = {point: run_granudrum(bench, *point) for point in POINTS}
    for point in sorted(runs):
        found = runs[point][1]
        rows.append(row("%d rpm, sliding %g, rolling %g" % point, "%s, covers %.2f" % (shown(found), found["covered"]),
                        "%.1f° (theirs, ± 0.5), within 2; covers %.2f" % (grid[point], covered[point]), abs(found["angle"] - grid[point]) < 2))
    off = [found["angle"] - grid[point] for point, (_, found) in runs.items()]
    rows.append(row("ours less theirs, twelve points", "mean %+.1f°, rms %.1f°, from %+.1f° to %+.1f°"
                    % (sum(off) / len(off), math.sqrt(sum(d * d for d in off) / len(off)), min(off), max(off))))
    centre = [found["centre"] - found["angle"] for _, found in runs.values()]
    rows.append(row("the angle of the charge's centre, as of bed_profile, less that of the line", "%+.1f to %+.1f°" % (min(centre), max(centre))))
    rows += size_and_stiffness(bench, runs[MIDDLE][1])
    rows += grid_facts(grid, covered, measured)
    rows += fitted_rows(bench, measured)
    rows.append(lost([s for s, _ in runs.values()]))
    draw(bench, grid, runs, measured)
    bench.say("Left out: beads of 1.1 mm (here 2.5 mm), their stiffness (here a tenth), the facets of their mesh. LIGGGHTS resists the bead's own spin at a wall, "
              "here its spin against the wall; what else differs is in [another engine](engines.md). How many beads they put in is not public: here the bed covers "
              "as much of the drum as in their pictures. The measured beads have sizes of 1.05 to 1.5 mm and a restitution that their owners set to 0.3 (here 0.5). "
              "Not run: the other 114 points of the grid, beads of 1.1 mm.", sources("granudrum"))
    return rows


def size_and_stiffness(bench, as_it_is):
    rows = []
    for setting, words in (("beads.cellulose.diameter=3.5 mm", "beads of 3.5 in the place of 2.5 mm"),
                           ("beads.cellulose.diameter=1.8 mm", "beads of 1.8 in the place of 2.5 mm"), ("stiffness_factor=0.4", "four times as stiff")):
        found = run_granudrum(bench, *MIDDLE, setting)[1]
        change = found["angle"] - as_it_is["angle"]
        rows.append(row("%s (%d rpm, sliding %g, rolling %g)" % ((words,) + MIDDLE), "%s: %+.1f°" % (shown(found), change), "within 1.5", abs(change) < 1.5))
    return rows


def pictured_angles():
    """rpm → angle of the measured silhouettes, read as the runs are."""
    import drum_surface
    found = {}
    for rpm in (10, 15, 30, 45):
        file = DATA / "granudrum" / ("gd_nature_%drpm_averaged.bmp" % rpm)
        # The measured drum turns the other way round: its surface falls to the right.
        found[rpm] = -drum_surface.slope((AIR - drum_surface.read_bmp(file)) / (AIR - POWDER), BORE)[0]
    return found


def between(grid, rpm, sliding, rolling):
    """What the grid says between two of its rolling frictions."""
    known = sorted(k[2] for k in grid if k[:2] == (rpm, sliding))
    low = max(r for r in known[:-1] if r <= rolling)
    high = known[known.index(low) + 1]
    return grid[rpm, sliding, low] + (grid[rpm, sliding, high] - grid[rpm, sliding, low]) * (rolling - low) / (high - low)


def rolling_for(grid, rpm, sliding, angle):
    """Rolling friction at which the grid has this angle; None: at none."""
    known = sorted(k[2] for k in grid if k[:2] == (rpm, sliding))
    for low, high in zip(known, known[1:]):
        a, b = grid[rpm, sliding, low], grid[rpm, sliding, high]
        if a <= angle <= b:
            return low + (high - low) * (angle - a) / (b - a)
    return None


def grid_facts(grid, covered, measured):
    """What their runs alone say of rolling friction: docs/not_round.md quotes these."""
    slidings, rollings = sorted({k[1] for k in grid}), sorted({k[2] for k in grid})
    rows = [row("theirs: what rolling friction from 0 to 0.7 adds to the angle at 10 rpm",
                "; ".join("sliding %g: %.1f to %.1f°" % (s, grid[10, s, rollings[0]], grid[10, s, rollings[-1]]) for s in slidings)),
            row("theirs: what it adds to the share of the drum that the bed covers at 10 rpm, at most",
                "%.1f %%" % max(100 * (covered[10, s, r] / covered[10, s, 0] - 1) for s in slidings for r in rollings)),
            row("theirs: rise of the angle from 10 to 30 rpm, all frictions", "%.1f to %.1f°" % tuple(
                f(grid[30, s, r] - grid[10, s, r] for s in slidings for r in rollings) for f in (min, max)))]
    for angle in (30, 35, 40):
        given = {s: rolling_for(grid, 10, s, angle) for s in slidings}
        rows.append(row("theirs: what has %d° at 10 rpm" % angle, "; ".join("sliding %g, rolling %.2g" % pair for pair in given.items() if pair[1] is not None)))
    if 10 in measured and 30 in measured:
        fits = {s: rolling_for(grid, 10, s, measured[10]) for s in slidings}
        told = ["sliding %g, rolling %.2f: %.1f° at 30 rpm" % (s, r, between(grid, 30, s, r)) for s, r in fits.items() if r is not None]
        rows.append(row("measured rise from 10 to 30 rpm", "%.1f°" % (measured[30] - measured[10])))
        rows.append(row("theirs: pairs that have the measured %.1f° at 10 rpm" % measured[10], "; ".join(told), "%.1f° at 30 rpm (measured)" % measured[30]))
    return rows


def fitted_rows(bench, measured):
    """Ours with the frictions that the owners of the measurement found."""
    rows = []
    for rpm, angle in measured.items():
        found = run_granudrum(bench, rpm, *FITTED)[1]
        rows.append(row("measured beads, %d rpm, frictions as their owners fitted them (%s)" % (rpm, "used for it" if rpm in (15, 45) else "held out"),
                        "%s by density, %.1f ± %.1f° by silhouette" % (shown(found), found["outline"], found["outline_error"]),
                        "%.1f° (measured silhouette)" % angle))
    return rows


def draw(bench, grid, runs, measured):
    import drum_pictures
    ours = {point: (found["angle"], found["error"]) for point, (_, found) in runs.items()}
    drum_pictures.angles(ROOT / "docs" / "drum_angles.svg", grid, ours, measured)
    bench.say("![Surface angles: another group's runs as lines, ours as dots, the measured beads dashed](drum_angles.svg)")
