#!/usr/bin/env python3
"""How often the mean power of a part of a run lies within its own standard errors of the whole run's: window_errors.py FOLDER

The run's analysis window is cut into windows of so many turns. The standard error is that of kernel/run/statistics.cpp.
"""
import csv
import json
import math
import pathlib
import sys


def mean_and_error(series):
    """As correlated_mean()."""
    count = len(series)
    mean = sum(series) / count
    deviation = [value - mean for value in series]
    variance = sum(d * d for d in deviation) / count
    time = 0.5
    for lag in range(1, count // 2):
        time += sum(a * b for a, b in zip(deviation, deviation[lag:])) / count / variance
        if lag >= 5 * time:
            break
    time = max(time * (1 + (2 * lag + 1) / count), 0.5)
    return mean, math.sqrt(2 * time * variance / count)


def main(folder):
    summary = json.loads((folder / "summary.json").read_text())
    with open(folder / "series.csv", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if float(row["time_s"]) >= summary["window_s"][0]]
    power = [float(row["power_com_W"]) for row in rows]
    turn = 2 * math.pi / abs(summary["mill_speed_rad_per_s"]) / (float(rows[1]["time_s"]) - float(rows[0]["time_s"]))  # in samples
    whole = sum(power) / len(power)
    print("turns  windows  within 1.645 errors  scatter over error")
    for turns in (0.5, 1, 2, 4):
        length = int(turns * turn)
        parts = [mean_and_error(power[at:at + length]) for at in range(0, len(power) - length + 1, length)]
        within = sum(abs(mean - whole) < 1.645 * error for mean, error in parts) / len(parts)
        scatter = math.sqrt(sum(((mean - whole) / error) ** 2 for mean, error in parts) / len(parts))
        print(f"{turns:5}  {len(parts):7}  {100 * within:17.0f} %  {scatter:18.1f}")


main(pathlib.Path(sys.argv[1]))
