"""The graph of rooms as a picture: a layer above all layers it uses, arrows downward, in plain SVG.

Arrows that follow from others are left out: where A uses B and B uses C, one from A to C says nothing new. What a pointer rests on lists all.
The layout is the usual one of Sugiyama, Tagawa and Toda (1981): layers by the longest path, empty places where an arrow passes a layer,
order by the mean place of the neighbours, then coordinates.
"""

from xml.sax.saxutils import escape

WIDTH, HEIGHT, GAP, LAYER = 128, 32, 18, 70  # of a room; between rooms; from layer to layer: pixels
PASSING = 10  # width of the empty place where an arrow passes a layer
HEAD = 5  # of an arrow, behind the end of its line
MARGIN = 24
SWEEPS = 24
FILLS = {"sdk": "#e8e8e8", "plugins": "#fce5cd", "geometry": "#fce5cd", "analyzers": "#fce5cd", "kernel": "#cfe2f3", "studies": "#d9ead3"}
PROGRAM = "#fff2cc"  # rooms that make programs


def layers_of(graph):
    """room → its layer: 0 for what uses nothing."""
    layers = {}

    def layer(room):
        if room not in layers:
            layers[room] = max((layer(used) + 1 for used in graph[room]), default=0)
        return layers[room]

    for room in graph:
        layer(room)
    return layers


def below(graph):
    """room → all that it uses, directly or not."""
    reached = {}

    def reach(room):
        if room not in reached:
            reached[room] = set(graph[room]).union(*(reach(used) for used in graph[room]))
        return reached[room]

    for room in graph:
        reach(room)
    return reached


def needed(graph):
    """The arrows that follow from no others."""
    reached = below(graph)
    return [(room, used) for room in graph for used in graph[room]
            if not any(used in reached[other] for other in graph[room] if other != used)]


class Layout:
    """Places: rooms, and points (room, used, layer) where an arrow passes a layer."""

    def __init__(self, graph):
        self.layer = layers_of(graph)
        self.rows = [[] for _ in range(max(self.layer.values(), default=-1) + 1)]
        for room in graph:
            self.rows[self.layer[room]].append(room)
        self.paths = {}
        for room, used in needed(graph):
            passed = [(room, used, layer) for layer in range(self.layer[room] - 1, self.layer[used], -1)]
            for point in passed:
                self.rows[point[2]].append(point)
            self.paths[room, used] = [room, *passed, used]
        self.up, self.down = {}, {}
        for path in self.paths.values():
            for high, low in zip(path, path[1:]):
                self.down.setdefault(high, []).append(low)
                self.up.setdefault(low, []).append(high)
        self.x = {}
        self.order()
        for sweep in range(SWEEPS):
            self.settle(sweep)

    @staticmethod
    def width(place):
        return WIDTH if isinstance(place, str) else PASSING

    def order(self):
        for row in self.rows:
            self.spread(row)
        best = None
        for sweep in range(SWEEPS):
            rising = sweep % 2 == 0
            for row in self.rows if rising else reversed(self.rows):
                sides = self.down if rising else self.up
                wanted = {place: self.mean(place, sides) for place in row}
                row.sort(key=wanted.get)
                self.spread(row)
            crossed = self.crossings()
            if best is None or crossed < best[0]:
                best = (crossed, [list(row) for row in self.rows])
        self.rows = best[1] if best else []
        for row in self.rows:
            self.spread(row)

    def mean(self, place, sides):
        near = sides.get(place, [])
        return sum(self.x[other] for other in near) / len(near) if near else self.x[place]

    def spread(self, row):
        """Side by side, the middle at 0."""
        at = -sum(self.width(place) + GAP for place in row) / 2
        for place in row:
            self.x[place] = at + (self.width(place) + GAP) / 2
            at += self.width(place) + GAP

    def crossings(self):
        count = 0
        for row in self.rows:
            lines = [(self.x[high], self.x[low]) for high in row for low in self.down.get(high, [])]
            count += sum((a[0] - b[0]) * (a[1] - b[1]) < 0 for k, a in enumerate(lines) for b in lines[:k])
        return count

    def settle(self, sweep):
        """Each place moves towards its neighbours as far as its row's order allows, from the left and from the right in turn."""
        for row in self.rows if sweep % 2 == 0 else reversed(self.rows):
            wanted = []
            for place in row:
                near = self.down.get(place, []) + self.up.get(place, [])
                wanted.append(sum(self.x[other] for other in near) / len(near) if near else self.x[place])
            left, right = list(wanted), list(wanted)
            for k in range(1, len(row)):
                left[k] = max(left[k], left[k - 1] + self.apart(row[k - 1], row[k]))
            for k in range(len(row) - 2, -1, -1):
                right[k] = min(right[k], right[k + 1] - self.apart(row[k], row[k + 1]))
            for place, a, b in zip(row, left, right):
                self.x[place] = (a + b) / 2

    def apart(self, a, b):
        return (self.width(a) + self.width(b)) / 2 + GAP


def draw(table, graph):
    layout = Layout({room: set(used) for room, used in graph.items()})
    x0 = min((x - layout.width(place) / 2 for place, x in layout.x.items()), default=0) - MARGIN
    x1 = max((x + layout.width(place) / 2 for place, x in layout.x.items()), default=0) + MARGIN
    top = len(layout.rows) - 1

    def at(place):
        layer = layout.layer[place] if isinstance(place, str) else place[2]
        return layout.x[place] - x0, MARGIN + (top - layer) * LAYER + HEIGHT / 2

    parts = [curve([at(place) for place in path]) for path in layout.paths.values()]
    parts += [box(table.rooms[room], graph[room], *at(room)) for room in graph]
    return FRAME % {"width": x1 - x0, "height": 2 * MARGIN + top * LAYER + HEIGHT, "parts": "\n".join(parts)}


def box(room, uses, x, y):
    """Rooms of the kernel and the studies go by the rest of their names; the colour says which they are."""
    first, _, rest = room.folder.partition("/")
    title = "%s: %s. Uses %s" % (room.folder, room.holds, ", ".join(used.split("/", 1)[-1] for used in uses) or "no other room")
    return ('<g><title>%s</title><rect x="%.1f" y="%.1f" width="%d" height="%d" rx="5" fill="%s"/><text x="%.1f" y="%.1f">%s</text></g>'
            % (escape(title), x - WIDTH / 2, y - HEIGHT / 2, WIDTH, HEIGHT, FILLS.get(first, PROGRAM), x, y + 4, escape(rest or first)))


def curve(points):
    """From below the first room to above the last, upright at every point."""
    points = [(points[0][0], points[0][1] + HEIGHT / 2), *points[1:-1], (points[-1][0], points[-1][1] - HEIGHT / 2 - HEAD)]
    text = "M%.1f,%.1f" % points[0]
    for (xa, ya), (xb, yb) in zip(points, points[1:]):
        middle = (ya + yb) / 2
        text += "C%.1f,%.1f %.1f,%.1f %.1f,%.1f" % (xa, middle, xb, middle, xb, yb)
    return '<path class="arrow" d="%s"/>' % text


FRAME = """<svg xmlns="http://www.w3.org/2000/svg" width="%(width).0f" height="%(height).0f" viewBox="0 0 %(width).0f %(height).0f">
<style>
text { font: 13px sans-serif; text-anchor: middle; fill: #222 }
rect { stroke: #555 }
path { fill: none }
.arrow { stroke: #444; stroke-width: 1.2; marker-end: url(#head) }
</style>
<defs><marker id="head" viewBox="0 0 10 10" refX="5" refY="5" markerWidth="7" markerHeight="7" orient="auto"><path d="M0,0 L10,5 L0,10 z" style="fill: #444"/></marker></defs>
<rect width="100%%" height="100%%" style="fill: white; stroke: none"/>
%(parts)s
</svg>
"""
