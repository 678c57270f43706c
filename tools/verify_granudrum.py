"""The long checks on a small drum, for verify.py: another group's LIGGGHTS runs, the beads that it was made for, what rolling friction does."""

import math

from verify_drums import DATA, HOW, ROOT, angle_of, lost, not_run, shown, sources, table
from verify_rows import NotRun, row

GRID = "granudrum/dem_grid_surface_angles.csv"
GRANUDRUM, BORE = "configs/measured_drums/granudrum.yaml", 0.084  # m
WINDOWS = {10: (1.6, 3.2), 15: (1.4, 2.6), 30: (1.1, 2.0), 45: (1.0, 1.8), 50: (1.0, 1.8)}  # rpm → from, to, s: its start swings out in a second
SIZE = "beads.cellulose.diameter=%g mm"
MIDDLE = (30, 0.5, 0.1)  # rpm, sliding, rolling
POINTS = [(rpm, sliding, rolling) for rpm in (50, 10) for sliding in (0.15, 1.0) for rolling in (0, 0.7)] \
    + [MIDDLE, (30, 0.3, 0.4), (50, 0.5, 0.1), (10, 0.5, 0.1)]
FITTED = (0.562, 0.291)  # sliding and rolling, by the owners of the measurement, to 15 and 45 rpm
POWDER, AIR = 22, 247  # grey of the measured pictures


def run_granudrum(bench, rpm, sliding, rolling, *more):
    """Summary of a run at a point of the grid, and what its surface is."""
    start, end = WINDOWS[rpm]
    name = "_".join(["granudrum", "%d" % rpm, "%g" % sliding, "%g" % rolling] + [m.split("=")[1].split()[0] for m in more])
    settings = ("mill.speed=%d rpm" % rpm, "pairs.default.static_friction=%g" % sliding, "pairs.default.rolling_friction=%g" % rolling,
                "time.end_s=%g" % end, "time.analyze_from_s=%g" % start, "output.frames.from_s=%g" % start, "output.frames.every_s=%g" % ((end - start) / 50))
    return bench.run(name, GRANUDRUM, *settings, *more), angle_of(bench.folder / name, BORE)


def complete(bench, wanted):
    """name → (summary, surface) of the runs {name: arguments of run_granudrum()} that there are, and rows for the others (verify.py --kept)."""
    runs, rows = {}, []
    for name, arguments in wanted.items():
        try:
            runs[name] = run_granudrum(bench, *arguments)
        except NotRun:
            rows.append(row(words_of(arguments), "not run"))
    return runs, rows


def words_of(point):
    """rpm, sliding, rolling and settings as words."""
    return "%d rpm, sliding %g, rolling %g" % point[:3] + "".join(", " + setting for setting in point[3:])


def grid_of(column):
    """(rpm, sliding, rolling) → that column of the grid of their runs."""
    return {(int(r["rpm"]), float(r["sliding"]), float(r["rolling"])): float(r[column]) for r in table(DATA / GRID)}


def granudrum(bench):
    """Surface angles of a small drum against another group's LIGGGHTS runs, twelve of their 126"""
    if not_run(GRID):
        return not_run(GRID)
    grid, covered = grid_of("angle_mid_half_deg"), grid_of("bright_fraction_of_disc")
    runs, rows = complete(bench, {point: point for point in sorted(POINTS)})
    for point, (_, found) in runs.items():
        rows.append(row(words_of(point), "%s, covers %.2f" % (shown(found), found["covered"]),
                        "%.1f° (theirs, ± 0.5), within 2; covers %.2f" % (grid[point], covered[point]), abs(found["angle"] - grid[point]) < 2))
    off = [found["angle"] - grid[point] for point, (_, found) in runs.items()]
    if not runs:
        return rows
    rows.append(row("ours less theirs, %d points" % len(runs), "mean %+.1f°, rms %.1f°, from %+.1f° to %+.1f°"
                    % (sum(off) / len(off), math.sqrt(sum(d * d for d in off) / len(off)), min(off), max(off))))
    centre = [found["centre"] - found["angle"] for _, found in runs.values()]
    rows.append(row("the angle of the charge's centre, as of bed_profile, less that of the line", "%+.1f to %+.1f°" % (min(centre), max(centre))))
    rows += size_and_stiffness(bench, runs) + [lost([s for s, _ in runs.values()])]
    draw(bench, "drum_angles.svg", {point: (found["angle"], found["error"]) for point, (_, found) in runs.items()})
    bench.say("Left out: beads of 1.1 mm (here 2.2 mm), their stiffness (here a tenth), the facets of their mesh. LIGGGHTS resists the bead's own spin at a wall, "
              "here its spin against the wall; what else differs is in [another engine](engines.md). How many beads they put in is not public: here the bed covers "
              "about as much of the drum as in their pictures. Not run: the other 114 points of the grid, beads of 1.1 mm. " + HOW, sources(GRID))
    return rows


def cellulose(bench):
    """Measured beads that are not round, at four speeds, with the frictions that their owners fitted to two of them"""
    if not_run("granudrum"):
        return not_run("granudrum")
    measured = pictured_angles()
    runs, rows = complete(bench, {rpm: (rpm, *FITTED) for rpm in measured})
    for rpm, (_, found) in runs.items():
        angle = measured[rpm]
        rows.append(row("%d rpm (%s)" % (rpm, "used for their fit" if rpm in (15, 45) else "held out"),
                        "%s by density, %.1f ± %.1f° by silhouette" % (shown(found), found["outline"], found["outline_error"]),
                        "%.1f° (measured silhouette), within 2" % angle, abs(found["angle"] - angle) < 2))
    bench.say("Left out: sizes of 1.05 to 1.5 mm (here 2.2 mm), a restitution that their owners set to 0.3 (here 0.5), and shape. " + HOW, sources("granudrum/gd"))
    return rows


def rolling(bench):
    """What rolling friction does to the surface of a drum, by another group's 126 runs and by measured beads that are not round"""
    if not_run("granudrum"):
        return not_run("granudrum")
    draw(bench, "drum_rolling.svg", {})
    bench.say("No run of ours is in this. [Media that are not round](not_round.md) draws its advice from it.", sources("granudrum"))
    return grid_facts(grid_of("angle_mid_half_deg"), grid_of("bright_fraction_of_disc"), pictured_angles())


def size_and_stiffness(bench, runs):
    """What beads of another size and stiffer ones change."""
    others, rows = complete(bench, {"beads of 3.2 in the place of 2.2 mm": (*MIDDLE, SIZE % 3.2), "beads of 1.6 in the place of 2.2 mm": (*MIDDLE, SIZE % 1.6),
                                    "four times as stiff": (*MIDDLE, "stiffness_factor=0.4")})
    for words, (_, found) in others.items():
        if MIDDLE in runs:
            change = found["angle"] - runs[MIDDLE][1]["angle"]
            rows.append(row("%s (%s)" % (words, words_of(MIDDLE)), "%s: %+.1f°" % (shown(found), change), "within 1.5", abs(change) < 1.5))
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


def draw(bench, name, ours):
    """`ours`: (rpm, sliding, rolling) → (angle, error)."""
    import drum_pictures
    drum_pictures.angles(ROOT / "docs" / name, grid_of("angle_mid_half_deg"), ours, pictured_angles())
    bench.say("![Surface angles: another group's runs as lines%s, the measured beads dashed](%s)" % (", ours as dots" if ours else "", name))
