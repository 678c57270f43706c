#!/usr/bin/env python3
"""Are the errors of many beads that one mill is seen by at once as large as said? tools/tracer_errors.py CASE.yaml -o FOLDER [--seeds 24] [--beads 8,60,150]

Simulates the case from many starts. For each number of followed beads it holds the scatter of the results between the starts against the standard errors
that `analyze` gives each of them. Beads of one mill share its room: where one is, no other can be. So many of them tell more than as many
from as many mills, and the ratio falls below 1: without any memory, to √(1 − n/N) for n of N beads.
"""

import argparse
import csv
import json
import math
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def millscope(binary, *words):
    subprocess.run([str(binary)] + [str(w) for w in words], check=True, stdout=subprocess.DEVNULL)


def values_of(binary, out, run, beads, total):
    """{name: (value, standard error)} of the centre and of the bins of x and y, of every total/beads-th bead."""
    ids = ",".join(str(k * total // beads) for k in range(beads))
    millscope(binary, "analyze", run, "-o", out, "--force", "--quiet", "--tracer", ids, "--analyzers", "power,distributions",
              "--set", "analyzers.distributions.bins_x=8", "--set", "analyzers.distributions.bins_y=8")
    found = {}
    for name, n in json.loads((out / "results.json").read_text())["numbers"]["power"].items():
        if name.startswith("centre_of_mass"):
            found[name] = (n["value"], n["sem"])
    for axis in "xy":
        with open(out / "tables" / ("distributions.%s_edges.csv" % axis), encoding="utf-8", newline="") as file:
            for k, row in enumerate(csv.DictReader(file)):
                if row[axis + "_percent_sem"]:
                    found["%s bin %d" % (axis, k)] = (float(row[axis + "_percent [%]"]), float(row[axis + "_percent_sem"]))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case")
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--binary", type=Path, default=ROOT / "build" / "release" / "bin" / "millscope")
    parser.add_argument("--seeds", type=int, default=24)
    parser.add_argument("--beads", default="8,60,150")
    parser.add_argument("--set", action="append", default=[], metavar="path=value", help="of the case, e.g. time.end_s=11")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    print("%-7s %-9s %-42s %s" % ("beads", "numbers", "scatter / standard error (rms over numbers)", "sqrt(1 - n/N)"))
    runs = []
    for seed in range(1, options.seeds + 1):
        run = options.output / ("seed_%d" % seed)
        if not (run / "summary.json").exists():
            millscope(options.binary, "run", options.case, "-o", run, "--force", "--quiet", "--threads", "1", "--set", "seed=%d" % (1000 + seed),
                      *(w for s in options.set for w in ("--set", s)))
        runs.append(run)
    total = json.loads((runs[0] / "summary.json").read_text())["particles"]
    for beads in (int(b) for b in options.beads.split(",")):
        seen = [values_of(options.binary, options.output / "analysis", run, beads, total) for run in runs]
        names = [n for n in seen[0] if all(n in s for s in seen)]
        squares = []
        for name in names:
            scatter = statistics.variance(s[name][0] for s in seen)
            error = statistics.mean(s[name][1] ** 2 for s in seen)
            if error > 0:
                squares.append(scatter / error)
                print("        %-40s %.2f" % (name, math.sqrt(squares[-1])))
        print("%-7d %-9d %-42.2f %.2f" % (beads, len(squares), math.sqrt(statistics.mean(squares)), math.sqrt(max(0, 1 - beads / total))))
    return 0


if __name__ == "__main__":
    sys.exit(main())
