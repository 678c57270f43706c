#!/usr/bin/env python3
"""Whether two programs see the same: bench/look_bias.py BUILD OTHER_LOOK_BENCH [--seeds 30] [--looks 4].

The mill of the story is simulated with each seed, and both programs look at each simulation some times. For every summary: by how much its
mean over the seeds and its scatter between them differ, against the standard error that a look states. Beside it by how much
farther from the recording the simulations lie, the recording too as each program sees it. `bench/look.sh BUILD` comes first.
"""

import argparse
import math
import os
import statistics
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


class Failure(Exception):
    """Something the user can put right."""


def run(command):
    done = subprocess.run([str(c) for c in command], text=True, capture_output=True)
    if done.returncode != 0:
        raise Failure("%s failed (%d): %s" % (" ".join(str(c) for c in command), done.returncode, done.stderr.strip()))


def simulate(build, folder, seed):
    out = folder / ("seed%d" % seed)
    if not (out / "summary.json").exists():
        run([build / "bin/millscope", "run", ROOT / "configs/story/mill.yaml", "-o", out, "--threads", 1, "--quiet", "--set", "seed=%d" % seed,
             "--set", "time={end_s: 4, analyze_from_s: 1}", "--set", "output.frames.every_s=0.005"])
    return out


def seen(file):
    """{summary: [value of each look]}, {summary: [standard error of each look]}, {summary: value of the recording}. A line: look or
    "recorded", name, value, its row of the covariance. Of "bin" and "resampled" nothing."""
    values, errors, recorded, names = {}, {}, {}, []
    for line in file.read_text().splitlines():
        words = line.split()
        if len(words) > 1 and words[-4:-3] == ["blocks"]:
            names = []
            continue
        if words[1] in ("bin", "resampled"):
            continue
        numbers = len(names) + 2
        name = " ".join(words[1:-numbers])
        names.append(name)
        if words[0] == "recorded":
            recorded[name] = float(words[-numbers])
            continue
        values.setdefault(name, []).append(float(words[-numbers]))
        errors.setdefault(name, []).append(math.sqrt(float(words[-1])))
    return values, errors, recorded


def looks(program, build, folder, count, label, out):
    file = out / ("values-%s.txt" % label)
    run([program, folder / "study.yaml", "--run", out, "--looks", count, "--values", file, "--threads", 1])
    return seen(file)


def row(name, one, other):
    """`one`, `other`: for each seed the values and errors of the looks, and the values of the recording."""
    means = [[statistics.mean(values[name]) for values, _, _ in side] for side in (one, other)]
    error = statistics.mean(e for side in (one, other) for _, errors, _ in side for e in errors[name])
    differences = [b - a for a, b in zip(*means)]
    spread = [math.sqrt(statistics.mean(statistics.variance(values[name][k] for values, _, _ in side) for k in range(len(side[0][0][name])))) for side in (one, other)]
    stated = [statistics.mean(e for _, errors, _ in side for e in errors[name]) for side in (one, other)]
    of_recording = (other[0][2][name] - one[0][2][name]) / error
    return {"name": name, "shift": statistics.mean(differences) / error, "of": statistics.stdev(differences) / math.sqrt(len(differences)) / error,
            "farther": statistics.mean(differences) / error - of_recording, "scatter": spread[1] / spread[0], "stated": stated[1] / stated[0]}


def main():
    parser = argparse.ArgumentParser(prog="bench/look_bias.py", description="Whether two programs see the same in the same simulations.")
    parser.add_argument("build", type=Path, help="build directory, e.g. build/release")
    parser.add_argument("other", type=Path, help="millscope_look_bench of another build")
    parser.add_argument("--seeds", type=int, default=30)
    parser.add_argument("--looks", type=int, default=4, help="looks at each simulation, with another chance of the camera each (default 4)")
    options = parser.parse_args()
    folder = options.build.resolve() / "bench-look"
    try:
        if not (folder / "study.yaml").exists():
            raise Failure("%s is missing; run bench/look.sh %s first" % (folder / "study.yaml", options.build))
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            runs = list(pool.map(lambda seed: simulate(options.build, folder / "seeds", seed), range(1, options.seeds + 1)))
            sides = [list(pool.map(lambda out: looks(program, options.build, folder, options.looks, label, out), runs))
                     for label, program in (("other", options.other.resolve()), ("now", options.build.resolve() / "bin/millscope_look_bench"))]
    except Failure as e:
        print("look_bias: %s" % e, file=sys.stderr)
        return 2
    rows = [row(name, *sides) for name in sides[0][0][0]]
    print("| summary | shift of the mean, in standard errors of a look | less the shift of the recording | scatter between seeds | standard error that a look states |")
    print("|---|---|---|---|---|")
    for r in rows:
        print("| %s | %+.3f ± %.3f | %+.3f | × %.3f | × %.3f |" % (r["name"], r["shift"], r["of"], r["farther"], r["scatter"], r["stated"]))
    beyond = sum(abs(r["shift"]) > 0.1 for r in rows)
    chance = math.sqrt(statistics.mean((r["shift"] / r["of"]) ** 2 for r in rows if r["of"] > 0))
    print("%d summaries, %d of them shifted by more than a tenth of a standard error; shifts over their own errors: %.2f (1: chance alone); "
          "scatter × %.3f in the mean, stated errors × %.3f" % (len(rows), beyond, chance, statistics.mean(r["scatter"] for r in rows), statistics.mean(r["stated"] for r in rows)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
