#!/usr/bin/env python3
"""Readings of Bbosa's sum, P = M g Σ x_i l_i |ω_i| (Chagas 2015, Eq. 3.20), of a run: power_readings.py RUN [--from 2.5] [--scale 13.5] [--json]

The sum is over cells i of the x–y plane, l_i is a cell's share of the charge's time. x and ω are counted positive as the mill turns and
lifts. The study does not say what x is on the falling side, nor whether v is a bead's speed or its tangential part. Needs the packages of the Python package.
"""
import argparse
import json
import math
import statistics
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "python"))

GRAVITY = 9.81
LEAST_RADIUS = 1e-7  # m: a bead on the axis
PARTS = 5            # of the time, for the errors
EXACT, OF_SAMPLES = "M g ⟨x⟩ Ω, exact", "x, ⟨|ω|⟩"
# name: (weight of a cell, its turning speed) of `Cells`
READINGS = {
    EXACT: ("x", "shell"),
    OF_SAMPLES: ("x", "magnitude"),
    "x, |⟨ω⟩|": ("x", "of_mean"),
    "x, |⟨v_θ⟩|/r_i": ("x", "of_mean_tangential"),
    "x, ⟨|v_θ|⟩/r_i": ("x", "tangential"),
    "x, ⟨ω⟩ with its sign": ("x", "signed"),
    "x, ⟨|v|/r⟩": ("x", "speed"),
    "x, ⟨|v|⟩/r_i": ("x", "mean_speed"),
    "|x|, ⟨|ω|⟩": ("width", "magnitude"),
    "|x|, |⟨ω⟩|": ("width", "of_mean"),
    "|x|, |⟨v_θ⟩|/r_i": ("width", "of_mean_tangential"),
    "|x|, ⟨|v_θ|⟩/r_i": ("width", "tangential"),
    "|x|, ⟨ω⟩ with its sign": ("width", "signed"),
    "|x|, ⟨|v|/r⟩": ("width", "speed"),
    "|x|, ⟨|v|⟩/r_i": ("width", "mean_speed"),
    "|x|, Ω of the shell": ("width", "shell"),
    "|x − x̄|, ⟨|ω|⟩": ("width_about_centre", "magnitude"),
    "r, ⟨|ω|⟩": ("radius", "magnitude"),
    "rising cells only: x, ⟨|ω|⟩": ("x_rising", "magnitude"),
    "rising cells only: |x|, ⟨|ω|⟩": ("width_rising", "magnitude"),
    "cells with x > 0 only: x, ⟨|ω|⟩": ("x_ahead", "magnitude"),
    "cells with x > 0 only: x, ⟨ω⟩ with its sign": ("x_ahead", "signed"),
}


class Cells:
    """Means over the cells of the x–y plane, of samples with equal masses; NaN where no bead was."""

    def __init__(self, x, y, vx, vy, shell_speed, shell_radius, count=50):
        import numpy
        sense = numpy.sign(shell_speed)
        width = 2 * shell_radius / count
        column, row = (numpy.clip(((a + shell_radius) // width).astype(int), 0, count - 1) for a in (x, y))
        cell = row * count + column
        visits = numpy.bincount(cell, minlength=count * count)

        def mean(values):
            with numpy.errstate(invalid="ignore"):
                return numpy.bincount(cell, weights=values, minlength=count * count) / visits

        radius = numpy.maximum(numpy.hypot(x, y), LEAST_RADIUS)
        tangential, speed = sense * (x * vy - y * vx) / radius, numpy.hypot(vx, vy)
        middle = (numpy.arange(count) + 0.5) * width - shell_radius
        self.share = visits / visits.sum()
        self.x = sense * numpy.tile(middle, count)
        self.radius = numpy.hypot(self.x, numpy.repeat(middle, count))
        self.width, self.width_about_centre = abs(self.x), abs(self.x - (self.share * self.x).sum())
        self.shell = numpy.full(count * count, abs(shell_speed))
        self.signed, self.magnitude, self.speed = mean(tangential / radius), mean(abs(tangential) / radius), mean(speed / radius)
        self.of_mean = abs(self.signed)
        self.tangential, self.of_mean_tangential, self.mean_speed = (v / self.radius for v in (mean(abs(tangential)), abs(mean(tangential)), mean(speed)))
        rising, ahead = self.signed > 0, self.x > 0
        self.x_rising, self.width_rising, self.x_ahead = self.x * rising, self.width * rising, self.x * ahead

    def specific_power(self, arm, turning):
        """W per kg of the charge."""
        import numpy
        return GRAVITY * float(numpy.nansum(self.share * getattr(self, arm) * getattr(self, turning)))


def samples(run, start):
    """Places, velocities [frame, bead] from a time on, Ω, mass of the charge, radius of the shell."""
    try:
        import millscope
    except ImportError as missing:
        raise SystemExit("power_readings: %s; apt-get install python3-h5py python3-pandas python3-yaml" % missing) from missing
    try:
        opened = millscope.open_run(run)
        frames = opened.frames
    except millscope.Error as refused:
        raise SystemExit("power_readings: %s" % refused) from refused
    first = int((frames.time_s < start - 1e-9).sum())
    place, velocity = frames.position_m[first:].astype(float), frames.velocity_m_per_s[first:].astype(float)
    if len(place) < PARTS:
        raise SystemExit("power_readings: %s has %d frames from %g s on, fewer than %d; give --from an earlier time" % (run, len(place), start, PARTS))
    axes = [place[..., 0], place[..., 1], velocity[..., 0], velocity[..., 1]]
    return axes, float(frames.angular_velocity_rad_per_s[first:].mean()), float(frames.beads.mass_kg.sum()), float(opened.case["mill"]["diameter"]) / 2


def readings(run, start):
    """Reading → W of the run's whole charge and its standard error, from PARTS spans of time."""
    axes, turning, mass, radius = samples(run, start)
    spans = [slice(len(axes[0]) * part // PARTS, len(axes[0]) * (part + 1) // PARTS) for part in range(PARTS)]
    whole, *parts = (Cells(*(a[span].ravel() for a in axes), turning, radius) for span in [slice(None)] + spans)
    return {name: (mass * whole.specific_power(*how), mass * statistics.stdev([part.specific_power(*how) for part in parts]) / math.sqrt(PARTS))
            for name, how in READINGS.items()}


def bead_readings(run, start):
    """Reading → W of the whole charge as each bead alone tells it."""
    axes, turning, mass, radius = samples(run, start)
    found = {name: [] for name in READINGS}
    for bead in range(axes[0].shape[1]):
        cells = Cells(*(a[:, bead] for a in axes), turning, radius)
        for name, how in READINGS.items():
            found[name].append(mass * cells.specific_power(*how))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", type=Path, help="directory of millscope run")
    parser.add_argument("--from", dest="start", type=float, default=2.5, help="first time that counts, s (default 2.5)")
    parser.add_argument("--scale", type=float, default=1, help="length of the mill over that of the run: 13.5 for the study's slice")
    parser.add_argument("--json", action="store_true", help="as JSON")
    options = parser.parse_args()
    found = {name: tuple(options.scale * number for number in pair) for name, pair in readings(options.run, options.start).items()}
    if options.json:
        print(json.dumps({name: {"power_W": watts, "sem_W": error} for name, (watts, error) in found.items()}, indent=1, ensure_ascii=False))
        return
    for name, (watts, error) in found.items():
        print("%-46s %8.3f ± %.3f W  %+6.1f %%" % (name, watts, error, 100 * (watts / found[EXACT][0] - 1)))


if __name__ == "__main__":
    main()
