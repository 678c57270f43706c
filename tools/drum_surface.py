"""The free surface of a drum's charge as a camera before its end face sees it, from the frames of a run or from a picture; for verify_drums.py.

All numbers: x to the right and y up, metres, from the drum's axis. Angles are in degrees, above 0 where the surface rises to the right.
"""

import numpy

CELLS = 200  # over the drum's bore: 0.42 mm in a drum of 84 mm, as in the pictures of the grid of runs
BLOCKS = 4  # of time, from which standard errors come


def read_bmp(path):
    """Grey picture of 8 bits, [row from the top, column]."""
    data = path.read_bytes()
    start, width, height, bits = (int.from_bytes(data[a:a + n], "little", signed=True) for a, n in ((10, 4), (18, 4), (22, 4), (28, 2)))
    if data[:2] != b"BM" or bits != 8:
        raise ValueError("%s: is no BMP of 8 bits" % path)
    stride = (width + 3) // 4 * 4
    rows = numpy.frombuffer(data, numpy.uint8, stride * abs(height), start).reshape(abs(height), stride)[:, :width]
    palette = numpy.frombuffer(data, numpy.uint8, start - 54, 54)[::4]  # its blue is its grey
    return palette[rows[::-1] if height > 0 else rows].astype(float)


def pictures(positions, radii, bore, turned=0.0):
    """Two pictures [row from the top, column] of frames [frame, bead, 3], each cell a mean over time, by blocks: [block, row, column].

    Density: length of bead along the line of sight, m. Silhouette: share of the frames in which a bead is in the way. `turned`: the picture
    turned clockwise by so many degrees.
    """
    at = (numpy.arange(CELLS) + 0.5) * bore / CELLS - bore / 2
    density, silhouette = (numpy.zeros((BLOCKS, CELLS, CELLS)) for _ in range(2))
    c, s = numpy.cos(numpy.radians(turned)), numpy.sin(numpy.radians(turned))
    edges = numpy.linspace(0, len(positions), BLOCKS + 1).astype(int)
    for block in range(BLOCKS):
        for frame in range(edges[block], edges[block + 1]):
            x, y = c * positions[frame, :, 0] + s * positions[frame, :, 1], c * positions[frame, :, 1] - s * positions[frame, :, 0]
            seen = chords(x, y, radii, at, bore)
            density[block] += seen
            silhouette[block] += seen > 0
        count = max(1, edges[block + 1] - edges[block])
        density[block] /= count
        silhouette[block] /= count
    return density, silhouette


def chords(x, y, radii, at, bore):
    """Length of bead along the line of sight through each cell's middle, [row from the top, column]."""
    total = numpy.zeros(CELLS * CELLS)
    cell, reach = bore / CELLS, int(numpy.ceil(radii.max() / (bore / CELLS))) + 1
    column, row = ((x + bore / 2) / cell).astype(int), ((bore / 2 - y) / cell).astype(int)
    for down in range(-reach, reach + 1):
        for right in range(-reach, reach + 1):
            i, j = row + down, column + right
            inside = (i >= 0) & (i < CELLS) & (j >= 0) & (j < CELLS)
            i, j = i[inside], j[inside]
            square = radii[inside] ** 2 - (at[j] - x[inside]) ** 2 - (-at[i] - y[inside]) ** 2
            hit = square > 0
            total += numpy.bincount(i[hit] * CELLS + j[hit], 2 * numpy.sqrt(square[hit]), CELLS * CELLS)
    return total.reshape(CELLS, CELLS)


def heights(picture, bore, share=0.5):
    """x of the columns in the middle `share` of the bore, and y at which the picture, from above, first passes half."""
    count = picture.shape[0]
    middle, size = (count - 1) / 2, count / 2
    found = []
    for column in range(count):
        x = column - middle
        if abs(x) > share * size:
            continue
        deepest = numpy.sqrt(size ** 2 - x ** 2) - 2
        rows = numpy.flatnonzero(numpy.abs(numpy.arange(count) - middle) < deepest)
        grey = picture[rows, column]
        first = int(numpy.argmax(grey > 0.5))
        if grey[first] <= 0.5:
            continue
        back = (grey[first] - 0.5) / (grey[first] - grey[first - 1]) if first else 0.0
        found.append((x, middle - rows[first] + back))
    return numpy.array(found).T * bore / count


def slope(picture, bore):
    """Angle of a straight line over the middle half of the bore, deg, and the surface's distance from it (rms), m."""
    x, y = heights(picture, bore)
    line = numpy.polyfit(x, y, 1)
    return float(numpy.degrees(numpy.arctan(line[0]))), float(numpy.std(y - numpy.polyval(line, x)))


def scaled(density):
    """A density by its median in the bed: half is the surface."""
    return density / numpy.median(density[density > 0.3 * density.max()])


def surface(density, silhouette, bore):
    """Angles by density and by silhouette with standard errors (deg), the line's misfit (m), the share of the drum that is covered, by density."""
    grey = scaled(density.mean(axis=0))
    angle, misfit = slope(grey, bore)
    outline, _ = slope(silhouette.mean(axis=0), bore)
    errors = [numpy.std([slope(p, bore)[0] for p in parts], ddof=1) / numpy.sqrt(BLOCKS) for parts in ([scaled(d) for d in density], silhouette)]
    return {"angle": angle, "error": float(errors[0]), "misfit": misfit, "outline": outline, "outline_error": float(errors[1]),
            "covered": float((grey > 0.5).sum() / (numpy.pi * (grey.shape[0] / 2) ** 2))}


def along(positions, velocities, radii, bore, angle, depth):
    """Speed down the surface against the place on it, from its middle downwards: bins of a fortieth of the bore, means and standard errors.

    `angle`: of the surface; beads count down to `depth` below it.
    """
    x, y = heights(scaled(pictures(positions, radii, bore, angle)[0].mean(axis=0)), bore, 0.97)
    c, s = numpy.cos(numpy.radians(angle)), numpy.sin(numpy.radians(angle))
    right, up = c * positions[..., 0] + s * positions[..., 1], c * positions[..., 1] - s * positions[..., 0]
    near = (up > numpy.interp(right, x, y) - depth) & (numpy.abs(right) < 0.97 * bore / 2)
    down = -(c * velocities[..., 0] + s * velocities[..., 1])
    edges = numpy.linspace(-1, 1, 41) * bore / 2
    parts = numpy.array_split(numpy.arange(len(positions)), BLOCKS)
    with numpy.errstate(invalid="ignore", divide="ignore"):
        sums = [numpy.histogram(-right[part][near[part]], edges, weights=w)[0]
                for part in parts for w in (down[part][near[part]], None)]
        means = numpy.array(sums[::2]) / numpy.array(sums[1::2])
    seen = numpy.isfinite(means).all(axis=0)
    middles = (edges[1:] + edges[:-1]) / bore
    return middles[seen], means[:, seen].mean(axis=0), means[:, seen].std(axis=0, ddof=1) / numpy.sqrt(BLOCKS)


def wall_slip(positions, velocities, radii, bore, speed):
    """Mean speed along the shell of the beads that touch it below the bed, over the shell's there, in %."""
    distance = numpy.hypot(positions[..., 0], positions[..., 1])
    below = (distance > bore / 2 - 1.1 * radii) & (numpy.abs(numpy.arctan2(positions[..., 0], -positions[..., 1])) < 0.8)
    around = (positions[..., 0] * velocities[..., 1] - positions[..., 1] * velocities[..., 0])[below] / distance[below]
    return float(100 * around.mean() / (speed * distance[below].mean()))
