"""The round robin's counts against time, for verify_round_robin.py: a panel for each size in each zone, a line for each run."""

import math

from svg_panels import HEIGHT, LEFT, TOP, WIDTH, Panel, save

STYLES = {"millscope": ("#3b6fb6", ""), "LIGGGHTS": ("#d1495b", ""), "half the step": ("#3b6fb6", "4 3"), "true stiffness": ("#1b2733", "1 3")}


def ticks(low, high, about=5):
    """Round numbers between two: 1, 2 or 5 times a power of ten apart."""
    power = 10 ** math.floor(math.log10((high - low) / about))
    step = power * min((1, 2, 5, 10), key=lambda k: abs(k * power - (high - low) / about))
    return [k * step for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def picture(path, runs):
    """`runs`: name to (times in s, counts of each (size, zone))."""
    end = max(times[-1] for times, _ in runs.values())
    panels = []
    for k, key in enumerate(next(iter(runs.values()))[1]):
        values = [v for _, counts in runs.values() for v in counts[key]]
        room = 0.06 * (max(values) - min(values) or 1)
        low, high = max(0, min(values) - room), max(values) + room
        panel = Panel((k % 2 * (WIDTH + 1.5 * LEFT), k // 2 * (HEIGHT + TOP + 60)), "%s beads in %s" % key, (0, end), (low, high), ("time, s", ""))
        panel.ticks([(t, "%g" % t) for t in ticks(0, end)], ticks(low, high))
        for name, (times, counts) in runs.items():
            panel.line(list(zip(times, counts[key])), *STYLES[name])
        panels.append(panel)
    legend = [(colour, "dashes" if dashes else "line", name) for name, (colour, dashes) in STYLES.items() if name in runs]
    save(path, "Beads of each size in two zones of the drum against time", panels, legend)
