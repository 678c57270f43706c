#!/usr/bin/env python3
"""Times this build against that of an earlier commit, in interleaved pairs: bench/against.py BUILD_DIR COMMIT [--only PART …].

The commit is built once and kept under BUILD_DIR/bench/against. Each pair runs the earlier program, then the present one, pinned to one
core; what counts is CPU time (of 'set' the wall time, on all cores). Only ratios within one pair mean anything: machines drift.
"""

import argparse
import json
import os
import resource
import shutil
import statistics
import subprocess
import sys
import time
from pathlib import Path

import run as bench

CASES = bench.HERE / "cases"
STORY = Path("configs/story")


def story_mill(setup):
    return ["configs/story/mill.yaml", "--until", 1, "--steps", 20000]


def mill10(setup):
    return ["configs/mill10/case.yaml", "--until", 1, "--steps", 5000]


def one_case(name, until, steps):
    return lambda setup: [CASES / (name + ".yaml"), "--until", until, "--steps", steps]


def slice_case(mesh):
    def words(setup):
        bed = bench.slice_bed(setup, mesh)
        return bench.case_words(setup, mesh, bench.SLICE_MM) + ["--load", bed, "--steps", 4000, "--warm-up", 500]
    return words


def full_case(setup):
    bed = bench.full_bed(setup, "fine")
    return bench.case_words(setup, "fine", bench.FULL_MM, True) + ["--load", bed, "--steps", 600, "--warm-up", 200]


# What a particle-step costs: the words for millscope_bench, relative paths from the sources of either program.
STEPS = {"story": story_mill, "mill10": mill10, "slice-coarse": slice_case("coarse"), "slice-fine": slice_case("fine"), "full": full_case,
         "rosin_rammler": one_case("rosin_rammler", 0.3, 3000), "ball_charge": one_case("ball_charge", 0.3, 3000)}
# The same charges with one size: at two moments, so that their cost is known for any number of contacts.
ONE_SIZE = {"rosin_rammler": one_case("rosin_rammler_one_size", 0.3, 3000), "ball_charge": one_case("ball_charge_one_size", 0.3, 3000)}


class Program:
    """A build and the sources that it was made of."""

    def __init__(self, sources, build):
        self.sources, self.build = sources, build

    def step_time(self, setup, words):
        words = [w if not str(w).startswith("configs/") else self.sources / w for w in words]
        text = bench.run(setup.pin + [self.build / "bin" / "millscope_bench"] + words)
        return json.loads(text.splitlines()[-1])


def built(setup, commit):
    """The program of a commit, built once."""
    name = bench.run(["git", "-C", bench.ROOT, "rev-parse", "--short=10", commit + "^{commit}"]).strip()
    sources = setup.work / "against" / name
    build = sources / "build" / "release"
    whole = sources / "built"
    if not whole.exists():
        bench.say("building %s (once, minutes) …" % name)
        sources.mkdir(parents=True, exist_ok=True)
        archive = sources / "sources.tar"
        bench.run(["git", "-C", bench.ROOT, "archive", "-o", archive, name])
        bench.run(["tar", "-x", "-C", sources, "-f", archive])
        bench.run(["cmake", "--preset", "release"], cwd=sources)
        bench.run(["cmake", "--build", "--preset", "release", "-j", os.cpu_count()], cwd=sources)
        whole.touch()
    return Program(sources, build)


def summary(name, unit, rows):
    ratios = [before / now for before, now in rows]
    row = {"what": name, "unit": unit, "before": statistics.median(b for b, _ in rows), "now": statistics.median(n for _, n in rows),
           "ratio": statistics.median(ratios), "low": min(ratios), "high": max(ratios)}
    bench.say("%-16s %10.4g %10.4g %-22s ratio %.3f (%.3f to %.3f)" % (name, row["before"], row["now"], unit, row["ratio"], row["low"], row["high"]))
    return row


def compare_steps(setup, name, before, now, pairs):
    words = STEPS[name](setup)
    rows = [(before.step_time(setup, words)["ns_per_particle_step"], now.step_time(setup, words)["ns_per_particle_step"]) for _ in range(pairs)]
    return summary(name, "ns a particle-step", rows)


def cost_of_sizes(setup, now):
    """A distribution of sizes against one size with as many contacts a bead, on the line through two such beds."""
    beds = [now.step_time(setup, ONE_SIZE[name](setup)) for name in ONE_SIZE]
    (c0, t0), (c1, t1) = sorted((b["contacts_per_bead"], b["ns_per_particle_step"]) for b in beds)
    rows = {}
    for name in ONE_SIZE:
        bed = now.step_time(setup, STEPS[name](setup))
        alike = t0 + (t1 - t0) * (bed["contacts_per_bead"] - c0) / (c1 - c0)
        rows[name] = bed["ns_per_particle_step"] / alike
        bench.say("%-16s %.1f ns at %.2f contacts a bead, one size with as many: %.1f ns, ratio %.2f (at most 1.5 wanted)" %
                  (name, bed["ns_per_particle_step"], bed["contacts_per_bead"], alike, rows[name]))
    return rows


def compare_looks(before, now):
    """Looks at one simulation of the story's mill, in pairs of their own (bench/look.sh)."""
    other = before.build / "bin" / "millscope_look_bench"
    if not other.exists():
        bench.say("look: that commit has no millscope_look_bench yet; left out")
        return []
    text = bench.run(["sh", bench.HERE / "look.sh", now.build, other])
    rows = [[float(w) for w in line.replace(" s before, ", " ").replace(" s now, ratio ", " ").split()[:2]] for line in text.splitlines() if " s before, " in line]
    bench.say(text.splitlines()[-1])
    return [summary("look", "core-s", rows)]


def child_seconds(command, **more):
    """CPU seconds of a command and all that it starts, on any core, and its wall time."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    bench.run(command, **more)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime, time.monotonic() - start


def compare_banks(setup, before, now, pairs):
    """A part of the bank of the story's challenge, as the earlier commit's study has it, but with every condition fitted and every simulation
    from rest: what programs plan in a held-out one and where they begin differs."""
    study = before.sources / STORY / "challenge_study.yaml"
    from_rest = ["--set", "bank.develop_turns=0"] if "develop_turns" in study.read_text() else []
    rows = []
    for _ in range(pairs):
        times = []
        for program in (before, now):
            cache = setup.work / "bank-of-pair"
            shutil.rmtree(cache, ignore_errors=True)
            words = ["bank", "extend", study, "--cache", cache, "--set", "bank.base=8", "--set", "bank.each=1",
                     "--set", "conditions.speed50.role=fit"] + from_rest
            times.append(child_seconds([program.build / "bin" / "millscope"] + words)[0])
        rows.append(times)
    return summary("bank, a part", "core-s", rows)


def compare_sets(setup, before, now):
    """One set of the earlier commit's challenge of the story, diagnosed when its bank is there: that takes minutes, once for each."""
    times = []
    for program in (before, now):
        folder = setup.work / ("set-" + program.sources.name)
        millscope = program.build / "bin" / "millscope"
        if not (folder / "manifest.json").exists():
            shutil.rmtree(folder, ignore_errors=True)
            bench.run([millscope, "challenge", "make", before.sources / STORY / "challenge.yaml", "-o", folder, "--set", "seed=28",
                       "--set", "sets=[{kind: effect, hypothesis: rolling_resistance, strength: [0.5, 1], count: 1}]"])
        bench.say("the bank of %s, unless it is there (minutes) …" % program.sources.name)
        for timed in (False, True):
            out = setup.work / "set-out"
            shutil.rmtree(out, ignore_errors=True)
            shutil.rmtree(folder / "cache" / "observations", ignore_errors=True)
            seconds = child_seconds([millscope, "diagnose", folder / "set_001" / "study.yaml", "-o", out, "--cache", folder / "cache"])[1]
        times.append(seconds)
    return summary("set, bank there", "s on all cores", [tuple(times)])


def main():
    parts = list(STEPS) + ["sizes", "look", "bank", "set"]
    parser = argparse.ArgumentParser(prog="bench/against.py", description="Times this build against that of an earlier commit.")
    parser.add_argument("build", type=Path, help="build directory, e.g. build/release")
    parser.add_argument("commit", help="the earlier commit")
    parser.add_argument("--pairs", type=int, default=5, help="interleaved pairs (default 5)")
    parser.add_argument("--core", type=int, default=max(os.sched_getaffinity(0)), help="core to pin to")
    parser.add_argument("--only", choices=parts, action="append", help="only these parts (default: all but 'set')")
    options = parser.parse_args()
    chosen = options.only or [p for p in parts if p != "set"]
    try:
        setup = bench.Setup(options.build, options.core)
        now, before = Program(bench.ROOT, options.build.resolve()), built(setup, options.commit)
        results = {"commit": options.commit, "machine": bench.machine(), "rows": []}
        for part in chosen:
            if part in STEPS:
                results["rows"].append(compare_steps(setup, part, before, now, options.pairs))
            elif part == "sizes":
                results["sizes"] = cost_of_sizes(setup, now)
            elif part == "look":
                results["rows"] += compare_looks(before, now)
            elif part == "bank":
                results["rows"].append(compare_banks(setup, before, now, max(1, options.pairs // 2)))
            else:
                results["rows"].append(compare_sets(setup, before, now))
            (setup.work / "against.json").write_text(json.dumps(results, indent=1) + "\n")
        bench.say("wrote %s" % (setup.work / "against.json"))
        return 0
    except bench.Failure as e:
        print("bench: %s" % e, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
