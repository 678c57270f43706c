"""Drawings for docs/validation.md, in plain SVG; for the files that verify drums."""

from svg_panels import LEFT, WIDTH, Panel, save

COLOURS = ("#4b2e83", "#3b6fb6", "#2a9d8f", "#8ab17d", "#e9a23b", "#d1495b")


def angles(path, grid, ours, measured):
    """grid: (rpm, sliding, rolling) → angle of theirs; ours: the same → (angle, error); measured: rpm → angle."""
    slidings, rollings = sorted({k[1] for k in grid}), sorted({k[2] for k in grid})
    panels = []
    for number, rpm in enumerate(sorted({k[0] for k in grid})):
        panel = Panel((number * (WIDTH + LEFT), 0), "%d rpm" % rpm, (-0.03, 0.9), (15, 60), ("rolling friction", "surface angle, deg" if number == 0 else ""))
        panel.ticks([(r ** 0.5, "%g" % r) for r in rollings if r not in (0.01, 0.05)], range(20, 61, 10))
        for colour, sliding in zip(COLOURS, slidings):
            panel.line([(r ** 0.5, grid[rpm, sliding, r]) for r in rollings], colour)
            for (at, s, r), (angle, error) in ours.items():
                if (at, s) == (rpm, sliding):
                    panel.dot((r ** 0.5, angle), colour, error)
        if rpm in measured:
            panel.line([(-0.03, measured[rpm]), (0.9, measured[rpm])], "#1b2733", "5 4")
        panels.append(panel)
    legend = [(c, "line", "sliding %g" % s) for c, s in zip(COLOURS, slidings)] + [("#ffffff", "dot", "ours")] * bool(ours) + [("#1b2733", "dashes", "measured")]
    save(path, "Surface angle of a drum: another group's runs (lines)%s, measured beads (dashed)" % (", ours (dots)" if ours else ""), panels, legend)


def free_surface(path, points, ours):
    """points: measured (place over R, speed over its greatest); ours: place, speed, error, all over the same."""
    panel = Panel((0, 0), "velocity along the free surface", (-1.05, 1.05), (0, 1.25), ("place along the surface, over R", "speed over its greatest"))
    panel.ticks([(x, "%g" % x) for x in (-1, -0.5, 0, 0.5, 1)], (0, 0.2, 0.4, 0.6, 0.8, 1, 1.2))
    for point in points:
        panel.dot(point, "#e9a23b", size=3)
    panel.line(list(zip(ours[0], ours[1])), "#3b6fb6")
    save(path, "Velocity along the free surface of Alizadeh's drum: measured (dots) and ours (line)", [panel], [("#e9a23b", "dot", "measured"), ("#3b6fb6", "line", "ours")])


def speeds(path, measured, angles, fitted):
    """measured: rpm → angle; angles: (model, rpm) → angle, error; fitted: rpm."""
    panel = Panel((0, 0), "surface of the bed", (5, 50), (30, 56), ("rpm; fitted: " + ", ".join("%d" % rpm for rpm in fitted), "angle, deg"))
    panel.ticks([(rpm, "%d" % rpm) for rpm in sorted(measured)], range(30, 56, 5))
    legend = []
    models = list(dict.fromkeys(model for model, _ in angles))
    kinds = list(dict.fromkeys(model.split(",")[0] for model in models))
    for model in models:
        colour = COLOURS[2 * kinds.index(model.split(",")[0])]
        panel.line([(rpm, angles[model, rpm][0]) for rpm in sorted(measured)], colour, "5 4" if "finer" in model else "")
        for rpm in measured:
            panel.dot((rpm, angles[model, rpm][0]), colour, angles[model, rpm][1], size=2.5)
        legend.append((colour, "dashes" if "finer" in model else "line", model.replace("_", " ")))
    for rpm, angle in measured.items():
        panel.dot((rpm, angle), "#e9a23b", 0.5)
    save(path, "Surface angle of a drum at four speeds: measured (dots) and simulated (lines)", [panel], legend + [("#e9a23b", "dot", "measured")])
