"""Drawings of panels with axes, in plain SVG; for drum_pictures.py and round_robin_picture.py."""

WIDTH, HEIGHT, LEFT, TOP = 260, 300, 52, 40  # of a panel; its margins: pixels


class Panel:
    """Axes at a place of a drawing: what is put in in the units of the data comes out in pixels."""

    def __init__(self, place, title, x, y, names):
        (self.x0, self.x1), (self.y0, self.y1) = x, y
        self.place, self.parts = place, []
        left, top = place[0] + LEFT, place[1] + TOP
        right, bottom = left + WIDTH, top + HEIGHT
        self.parts.append('<rect x="%d" y="%d" width="%d" height="%d" fill="none" stroke="#8a94a0"/>' % (left, top, WIDTH, HEIGHT))
        self.text((left + right) / 2, top - 12, title, "middle")
        self.text((left + right) / 2, bottom + 40, names[0], "middle")
        self.parts.append('<text transform="translate(%d,%d) rotate(-90)" text-anchor="middle">%s</text>' % (left - 36, (top + bottom) / 2, names[1]))

    def at(self, x, y):
        return self.place[0] + LEFT + WIDTH * (x - self.x0) / (self.x1 - self.x0), self.place[1] + TOP + HEIGHT * (self.y1 - y) / (self.y1 - self.y0)

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
    width, height = (max(panel.place[axis] for panel in panels) + size for axis, size in ((0, WIDTH + 2 * LEFT + 130), (1, TOP + HEIGHT + 56)))
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
