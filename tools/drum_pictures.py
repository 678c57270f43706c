"""Two drawings for docs/validation.md, in plain SVG; for verify_drums.py."""

WIDTH, HEIGHT, LEFT, TOP = 260, 300, 52, 40  # of a panel; its margins: pixels
COLOURS = ("#4b2e83", "#3b6fb6", "#2a9d8f", "#8ab17d", "#e9a23b", "#d1495b")


class Panel:
    """Axes at a place of a drawing: what is put in in the units of the data comes out in pixels."""

    def __init__(self, place, title, x, y, names):
        (self.x0, self.x1), (self.y0, self.y1) = x, y
        self.place, self.parts = place, []
        left, right, top, bottom = place + LEFT, place + LEFT + WIDTH, TOP, TOP + HEIGHT
        self.parts.append('<rect x="%d" y="%d" width="%d" height="%d" fill="none" stroke="#8a94a0"/>' % (left, top, WIDTH, HEIGHT))
        self.text((left + right) / 2, top - 12, title, "middle")
        self.text((left + right) / 2, bottom + 40, names[0], "middle")
        self.parts.append('<text transform="translate(%d,%d) rotate(-90)" text-anchor="middle">%s</text>' % (left - 36, (top + bottom) / 2, names[1]))

    def at(self, x, y):
        return self.place + LEFT + WIDTH * (x - self.x0) / (self.x1 - self.x0), TOP + HEIGHT * (self.y1 - y) / (self.y1 - self.y0)

    def text(self, x, y, words, anchor="start"):
        self.parts.append('<text x="%.1f" y="%.1f" text-anchor="%s">%s</text>' % (x, y, anchor, words))

    def ticks(self, across, up):
        for x, name in across:
            at, bottom = self.at(x, self.y0)
            self.parts.append('<path d="M%.1f %.1fv5" stroke="#8a94a0"/>' % (at, bottom))
            self.text(at, bottom + 20, name, "middle")
        for y in up:
            left, at = self.at(self.x0, y)
            self.parts.append('<path d="M%.1f %.1fh-5" stroke="#8a94a0"/>' % (left, at))
            self.text(left - 8, at + 4, "%g" % y, "end")

    def line(self, points, colour, dashes=""):
        way = " ".join("%.1f,%.1f" % self.at(*p) for p in points)
        self.parts.append('<polyline points="%s" fill="none" stroke="%s" stroke-width="1.6" stroke-dasharray="%s"/>' % (way, colour, dashes or "none"))

    def dot(self, point, colour, error=0.0, size=4.5):
        x, y = self.at(*point)
        if error:
            self.parts.append('<path d="M%.1f %.1fV%.1f" stroke="%s"/>' % (x, self.at(0, point[1] - error)[1], self.at(0, point[1] + error)[1], colour))
        self.parts.append('<circle cx="%.1f" cy="%.1f" r="%g" fill="%s" stroke="#1b2733"/>' % (x, y, size, colour))


def save(path, title, panels, legend):
    """`legend`: (colour, dot or line or dashes, words) each."""
    width, height = LEFT + sum(WIDTH + LEFT for _ in panels) + 130, TOP + HEIGHT + 56
    lines = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" role="img" font-family="system-ui, Helvetica, Arial, sans-serif" '
             'font-size="13" fill="#1b2733">' % (width, height), "<title>%s</title>" % title, '<rect width="100%" height="100%" fill="#ffffff"/>']
    for panel in panels:
        lines += panel.parts
    for k, (colour, kind, words) in enumerate(legend):
        x, y = width - 150, TOP + 8 + 22 * k
        lines.append('<circle cx="%d" cy="%d" r="4.5" fill="%s" stroke="#1b2733"/>' % (x + 10, y, colour) if kind == "dot" else
                     '<path d="M%d %dh20" stroke="%s" stroke-width="1.6" stroke-dasharray="%s"/>' % (x, y, colour, "5 4" if kind == "dashes" else "none"))
        lines.append('<text x="%d" y="%d">%s</text>' % (x + 27, y + 4, words))
    path.write_text("\n".join(lines + ["</svg>", ""]))


def angles(path, grid, ours, measured):
    """grid: (rpm, sliding, rolling) → angle of theirs; ours: the same → (angle, error); measured: rpm → angle."""
    slidings, rollings = sorted({k[1] for k in grid}), sorted({k[2] for k in grid})
    panels = []
    for number, rpm in enumerate(sorted({k[0] for k in grid})):
        panel = Panel(number * (WIDTH + LEFT), "%d rpm" % rpm, (-0.03, 0.9), (15, 60), ("rolling friction", "surface angle, deg" if number == 0 else ""))
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
    panel = Panel(0, "velocity along the free surface", (-1.05, 1.05), (0, 1.25), ("place along the surface, over R", "speed over its greatest"))
    panel.ticks([(x, "%g" % x) for x in (-1, -0.5, 0, 0.5, 1)], (0, 0.2, 0.4, 0.6, 0.8, 1, 1.2))
    for point in points:
        panel.dot(point, "#e9a23b", size=3)
    panel.line(list(zip(ours[0], ours[1])), "#3b6fb6")
    save(path, "Velocity along the free surface of Alizadeh's drum: measured (dots) and ours (line)", [panel], [("#e9a23b", "dot", "measured"), ("#3b6fb6", "line", "ours")])
