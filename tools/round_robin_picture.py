"""The round robin's counts against time as an SVG: a field for each size in each zone, a line for each run."""

import math

WIDTH, HEIGHT, LEFT, TOP, GAP = 340, 210, 62, 66, 74  # of a field, px; margins; between fields
STYLES = {"millscope": "stroke:#1f5fa8;stroke-width:2", "LIGGGHTS": "stroke:#d9622b;stroke-width:2",
          "half the step": "stroke:#1f5fa8;stroke-width:1.2;stroke-dasharray:4 3", "true stiffness": "stroke:#222;stroke-width:2;stroke-dasharray:1 3"}


def tick_of(span, about):
    """1, 2 or 5 times a power of ten."""
    raw = span / about
    power = 10 ** math.floor(math.log10(raw))
    return power * min((1, 2, 5, 10), key=lambda k: abs(k * power - raw))


def ticks(low, high, about=5):
    step = tick_of(high - low, about)
    return [k * step for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def text(x, y, words, anchor="middle", more=""):
    return '<text x="%.1f" y="%.1f" text-anchor="%s"%s>%s</text>' % (x, y, anchor, more, words)


def field(left, top, title, lines, end):
    """One field: `lines` is a list of (style, times, counts)."""
    values = [v for _, _, counts in lines for v in counts]
    room = 0.06 * (max(values) - min(values) or 1)
    low, high = max(0, min(values) - room), max(values) + room

    def place(t, v):
        return left + WIDTH * t / end, top + HEIGHT * (1 - (v - low) / (high - low))

    out = [text(left + WIDTH / 2, top - 10, title, more=' font-weight="bold"')]
    for v in ticks(low, high):
        y = place(0, v)[1]
        out += ['<path d="M%g %.1fh%g" class="grid"/>' % (left, y, WIDTH), text(left - 6, y + 4, "%g" % v, "end")]
    for t in ticks(0, end):
        x = place(t, low)[0]
        out += ['<path d="M%.1f %gv%g" class="grid"/>' % (x, top, HEIGHT), text(x, top + HEIGHT + 16, "%g" % t)]
    out.append('<rect x="%g" y="%g" width="%g" height="%g" class="frame"/>' % (left, top, WIDTH, HEIGHT))
    for style, times, counts in lines:
        out.append('<polyline points="%s" style="%s"/>' % (" ".join("%.1f,%.1f" % place(t, v) for t, v in zip(times, counts)), style))
    return out


def picture(runs):
    """`runs`: name to (times in s, counts of each (size, zone))."""
    keys = list(next(iter(runs.values()))[1])
    end = max(times[-1] for times, _ in runs.values())
    wide, high = LEFT + 2 * WIDTH + GAP + 20, TOP + 2 * HEIGHT + GAP + 46
    out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" width="%d" height="%d" font-family="sans-serif" font-size="12" fill="#222">' % (wide, high, wide, high),
           "<title>Beads of each size in two zones of the drum against time</title>",
           "<style>polyline{fill:none}.grid{stroke:#ddd}.frame{fill:none;stroke:#888}</style>", '<rect width="100%" height="100%" fill="#fff"/>']
    for k, name in enumerate(runs):
        x = LEFT + 175 * k
        out += ['<path d="M%d 20h34" style="%s"/>' % (x, STYLES[name]), text(x + 40, 24, name, "start")]
    for k, key in enumerate(keys):
        left, top = LEFT + (k % 2) * (WIDTH + GAP), TOP + (k // 2) * (HEIGHT + GAP)
        out += field(left, top, "%s beads in %s" % key, [(STYLES[name], times, counts[key]) for name, (times, counts) in runs.items()], end)
    out += [text(LEFT + i * (WIDTH + GAP) + WIDTH / 2, high - 12, "time, s") for i in (0, 1)]
    return "\n".join(out + ["</svg>", ""])
