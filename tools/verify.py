#!/usr/bin/env python3
"""The long checks: tools/verify.py [ITEM …]. Writes docs/validation.md, each figure beside the command that gives it.

Runs are kept in BUILD/verify: one that is complete is not repeated (--fresh repeats it), one that was interrupted is resumed. An item
that is not run keeps what docs/validation.md says of it.
"""

import argparse
import hashlib
import json
import math
import os
import platform
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

sys.dont_write_bytecode = True
import round_robin_files
from verify_calibrate import calibrate
from verify_camera import bbosa, camera, roundtrip
from verify_compare import differences
from verify_diagnose import doubts, ends, wet
from verify_drums import alizadeh, beads6000
from verify_granudrum import cellulose, granudrum, rolling
from verify_powers import SLICE_60S, powers
from verify_real import drum, uct, worked
from verify_round_robin import round_robin
from verify_rows import Absent, NotRun, power, row, show, three_powers
from verify_silhouettes import silhouettes

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "validation.md"
SLICE, PARAMETRIC, FULL = "configs/crosscheck/slice.yaml", "configs/crosscheck/slice_parametric.yaml", "configs/chagas2015/full_75.yaml"
LINER = "configs/crosscheck/liner.stl"

# An independent DEM code (LIGGGHTS 3.8) on the case of configs/crosscheck/slice.yaml; mean over t = 2.5 to 4 s.
REFERENCE = {"particles": 4259, "power_W": 2.220, "power_sem_W": 0.006, "com_x_mm": 53.1}
STUDY_POWER_W = 30.1  # Chagas 2015, whole mill at 75 % of critical, dry


class Failure(Exception):
    """Something the user can put right."""


class Bench:
    """Runs millscope and keeps what it found."""

    def __init__(self, build, threads, fresh, kept=False):
        self.binary = build / "bin" / "millscope"
        if not self.binary.exists():
            raise Failure("%s does not exist; 'make verify' builds it" % self.binary)
        self.folder = build / "verify"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.threads, self.fresh, self.kept, self.commands, self.below = threads, fresh, kept, [], []

    def call(self, *arguments):
        """Runs the command from the root of the repository; returns what it printed and its peak memory in bytes."""
        self.commands.append(["millscope"] + [str(a) for a in arguments])
        command = [str(self.binary)] + [str(a) for a in arguments]
        print("  millscope " + " ".join(command[1:]), flush=True)
        with open(self.folder / "stdout.txt", "w+") as out, open(self.folder / "stderr.txt", "w+") as err:
            process = subprocess.Popen(command, cwd=ROOT, stdout=out, stderr=err)
            _, status, usage = os.wait4(process.pid, 0)
            out.seek(0), err.seek(0)
            if os.waitstatus_to_exitcode(status) != 0:
                raise Failure("'millscope %s' failed: %s" % (" ".join(command[1:]), (err.read().strip().splitlines() or ["no message"])[-1]))
            return out.read(), usage.ru_maxrss * 1024

    def study(self, *arguments):
        """What a study program beside millscope found."""
        command = [str(self.binary.parent / "millscope_camera_study")] + [str(a) for a in arguments]
        self.commands.append(["millscope_camera_study"] + command[1:])
        print("  " + " ".join(self.commands[-1]), flush=True)
        done = subprocess.run(command, cwd=ROOT, text=True, capture_output=True)
        if done.returncode != 0:
            raise Failure(done.stderr.strip() or "%s failed" % command[0])
        return json.loads(done.stdout)

    def say(self, *paragraphs):
        """What belongs below the item's table, as Markdown: a picture, what a case leaves out, where data come from."""
        self.below += paragraphs

    def export_liner(self):
        self.call("geometry", "export", PARAMETRIC, "-o", LINER, "--force")

    def run(self, name, case, *settings, options=()):
        """Summary of a run, from the cache where the same command has been completed."""
        out = self.folder / name
        wanted = ["run", case, "-o", os.path.relpath(out, ROOT)] + [w for s in settings for w in ("--set", s)] + list(options)
        if "--threads" not in wanted and "--engine" not in wanted and self.threads:
            wanted += ["--threads", str(self.threads)]
        note = self.folder / (name + ".json")
        kept = json.loads(note.read_text()) if note.exists() else {}
        same = not self.fresh and kept.get("command") == wanted and kept.get("inputs") == self.inputs(case)
        if same and (out / "summary.json").exists():
            self.commands.append(["millscope"] + wanted)
            return dict(json.loads((out / "summary.json").read_text()), peak_bytes=kept.get("peak_bytes"))
        if self.kept:
            raise NotRun(name)
        if same and ((out / "checkpoint.h5").exists() or (out / "engine").exists()):
            _, peak = self.call("resume", os.path.relpath(out, ROOT))
            self.commands[-1] = ["millscope"] + wanted
        else:
            shutil.rmtree(out, ignore_errors=True)
            note.write_text(json.dumps({"command": wanted, "inputs": self.inputs(case)}))
            _, peak = self.call(*wanted)
        note.write_text(json.dumps({"command": wanted, "inputs": self.inputs(case), "peak_bytes": peak}))
        return dict(json.loads((out / "summary.json").read_text()), peak_bytes=peak)

    def inputs(self, case):
        """Hash of what a result depends on: the command, its plugins, the cases."""
        files = [self.binary] + sorted((self.binary.parent.parent / "lib" / "millscope").rglob("*.so"))
        files += sorted((ROOT / "configs").rglob("*.yaml")) + ([ROOT / LINER] if case == SLICE else [])
        files += [] if case.startswith("configs/") else sorted(p for p in (ROOT / case).parent.iterdir() if p.is_file())
        total = hashlib.sha256()
        for f in files:
            total.update(f.read_bytes())
        return total.hexdigest()[:16]


def against(first, second, kind, unit="W"):
    a, b = power(first, kind), power(second, kind)
    apart = abs(a[0] - b[0]) / math.hypot(a[1], b[1])
    return row("power by %s" % kind, "%s and %s: %.1f combined standard errors apart" % (show(*a, unit), show(*b, unit), apart), "< 3", apart < 3)


def crosscheck(bench):
    """The cross-check slice, liner as mesh, against an independent DEM code"""
    bench.export_liner()
    s = bench.run("crosscheck", SLICE)
    rows = [row("beads", s["particles"], REFERENCE["particles"], s["particles"] == REFERENCE["particles"])]
    for kind in ("torque", "com", "dissipation"):
        value, error = power(s, kind)
        off = value / REFERENCE["power_W"] - 1
        rows.append(row("power by " + kind, "%s (%+.2f %%)" % (show(value, error, "W"), 100 * off),
                        "%.3f ± %.3f W, within 1.5 %%" % (REFERENCE["power_W"], REFERENCE["power_sem_W"]), abs(off) < 0.015))
    x, error = 1e3 * s["com_m"][0], 1e3 * s["com_m_sem"][0]
    rows.append(row("centre of mass ⟨x⟩", show(x, error, "mm"), "%.1f mm, within 0.7" % REFERENCE["com_x_mm"], abs(x - REFERENCE["com_x_mm"]) < 0.7))
    rows.append(three_powers(s))
    imbalance = abs(s["energy"]["imbalance_fraction"])
    rows.append(row("energy not accounted for", "%.2f %%" % (100 * imbalance), "< 0.5 %", imbalance < 0.005))
    rows.append(row("steady", "yes" if s["steady"] else "no", "yes", bool(s["steady"])))
    return rows


def parametric(bench):
    """The parametric liner against the same liner as mesh, 10 s"""
    bench.export_liner()
    until = ("time.end_s=10", "time.analyze_from_s=2.5")
    exact, mesh = bench.run("parametric_mill", PARAMETRIC, *until), bench.run("parametric_mesh", SLICE, *until)
    rows = [against(exact, mesh, kind) for kind in ("torque", "com", "dissipation")]
    apart = abs(exact["com_m"][0] - mesh["com_m"][0]) / math.hypot(exact["com_m_sem"][0], mesh["com_m_sem"][0])
    rows.append(row("⟨x⟩", "%.2f and %.2f mm: %.1f combined standard errors apart" % (1e3 * exact["com_m"][0], 1e3 * mesh["com_m"][0], apart), "< 3", apart < 3))
    return rows


def full(bench):
    """The whole mill of Chagas 2015 at 75 % of critical"""
    s = bench.run("full_75", FULL)
    rows = [row("beads", s["particles"], "about 57 500", abs(s["particles"] / 57500 - 1) < 0.01)]
    for kind in ("torque", "com", "dissipation"):
        value, error = power(s, kind)
        off = value / STUDY_POWER_W - 1
        rows.append(row("power by " + kind, "%s (%+.1f %%)" % (show(value, error, "W"), 100 * off), "%.1f W (study), within 5 %%" % STUDY_POWER_W, abs(off) < 0.05))
    rows += [three_powers(s), row("stiffness factor", s["stiffness_factor"]), row("wall time", "%.0f min, %d threads" % (s["wall_s"] / 60, s["threads"]))]
    return rows


def softening(bench):
    """What softening changes: the parametric slice with bodies four times as stiff"""
    soft, stiff = bench.run("softening_1", PARAMETRIC), bench.run("softening_4", PARAMETRIC, "stiffness_factor=0.004")
    rows = []
    for kind in ("torque", "com"):
        a, b = power(soft, kind), power(stiff, kind)
        change = b[0] / a[0] - 1
        rows.append(row("power by %s, factor 0.001 and 0.004" % kind, "%s and %s (%+.1f %%)" % (show(*a, "W"), show(*b, "W"), 100 * change), "within 3 %", abs(change) < 0.03))
    return rows


def timestep(bench):
    """The time step: the parametric slice at 10, 20, 30 % of the Rayleigh time"""
    runs = {p: bench.run("timestep_%d" % p, PARAMETRIC, "time.step_fraction=%d %%" % p) for p in (10, 20, 30)}
    rows = [row("power by com at %d %%" % p, show(*power(s, "com"), "W")) for p, s in runs.items()]
    rows += [row("energy not accounted for at %d %%" % p, "%.2f %%" % (100 * abs(s["energy"]["imbalance_fraction"]))) for p, s in runs.items()]
    return rows + [dict(against(runs[10], runs[20], "com"), what="10 and 20 %")]


def hashes(bench):
    """Bitwise equality over threads and instruction sets"""
    flags = set(re.search(r"^flags\s*:(.*)$", Path("/proc/cpuinfo").read_text(), re.M).group(1).split())
    levels = ["v2"] + (["v3"] if "avx2" in flags else []) + (["v4"] if "avx512vl" in flags else [])
    cases = [("1", levels[-1]), ("2", levels[-1]), ("3", levels[-1])] + [("2", level) for level in levels[:-1]]
    found = {}
    for threads, level in cases:
        s = bench.run("hash_%s_%s" % (threads, level), PARAMETRIC, "fill.settle_s=0.1", "time.end_s=0.2", "time.analyze_from_s=0.1",
                      options=("--threads", threads, "--instruction-set", level))
        found[threads, level] = s["state_hash"]
    same = len(set(found.values())) == 1
    return [row("state_hash, %s threads, x86-64-%s" % k, h, "all equal", same) for k, h in found.items()]


def memory(bench):
    """Peak memory per bead, parametric liner, settled bed, one thread"""
    sizes = {}
    for length in (20, 270):
        s = bench.run("memory_%d" % length, PARAMETRIC, "fill.vessel.length=%d mm" % length, "geometry.liner.length=%d mm" % length,
                      "domain.periodic.z=[0, %d mm]" % length, "time.end_s=0.1", "time.analyze_from_s=0", options=("--threads", "1"))
        sizes[s["particles"]] = s["peak_bytes"]
    (small, few), (large, many) = sorted(sizes.items())
    per_bead = (many - few) / (large - small)
    return [row("peak at %d and %d beads" % (small, large), "%.1f and %.1f MB" % (1e-6 * few, 1e-6 * many)),
            row("per bead beyond the base", "%.0f B" % per_bead, "≤ 800 B", per_bead <= 800)]


def ergodicity(bench):
    """One bead against the whole charge: a minute of a slice at 75 %, and a centrifuging charge"""
    rows, found = [], {}
    for name, case in (("ergodic", SLICE_60S), ("centrifuge", "configs/ergodicity/centrifuge.yaml")):
        bench.run(name, case)
        out = bench.folder / (name + "-analysis")
        bench.call("analyze", os.path.relpath(bench.folder / name, ROOT), "-o", os.path.relpath(out, ROOT), "--force", "--quiet", "--analyzers", "ergodicity,free_flight")
        found[name] = json.loads((out / "results.json").read_text())["numbers"]
    mixed, stuck, flight = found["ergodic"]["ergodicity"], found["centrifuge"]["ergodicity"], found["ergodic"]["free_flight"]
    rows.append(row("verdict on the slice at 75 % (1 ergodic, 0 cannot tell, -1 not)", mixed["verdict"]["value"], "1", mixed["verdict"]["value"] == 1))
    rows.append(row("verdict on the centrifuging charge", stuck["verdict"]["value"], "-1", stuck["verdict"]["value"] == -1))
    rows.append(row("spread of the power from single beads over 60 s", "%.1f %%" % (100 * mixed["single_power_error"]["value"])))
    for percent in (1, 2, 5):
        needed = mixed["time_for_power_%d_percent" % percent]
        rows.append(row("time to follow one bead for a power within %d %%" % percent, show(needed["value"], needed["sem"], "s")))
    hour = mixed["power_error_in_an_hour"]["value"]
    rows.append(row("standard error of the power from one bead in an hour, extrapolated", "%.2f %%" % (100 * hour),
                    "the study's three beads are off by 1.0, 3.4 and 0.7 %"))
    rows.append(row("time for a typical cell of 6 mm within 10 %", "%.0f s" % mixed["typical_cell_time_10_percent"]["value"]))
    pull = flight["gravity_size"]["value"]
    rows.append(row("gravity from the slice's free flights", "%.4f m/s²" % pull, "9.81, within 0.01 %", abs(pull / 9.81 - 1) < 1e-4))
    return rows


ITEMS = {f.__name__: f for f in (crosscheck, parametric, full, softening, timestep, hashes, memory, powers, ergodicity, camera, roundtrip, bbosa, differences, calibrate, wet, ends, doubts, worked, drum, uct, beads6000, alizadeh, granudrum, cellulose, rolling, silhouettes, round_robin)}
QUICK = ("crosscheck", "hashes", "memory")


def commit():
    done = subprocess.run(["git", "describe", "--always", "--dirty"], cwd=ROOT, text=True, capture_output=True)
    return done.stdout.strip() or "no git"


def processor():
    found = re.search(r"^model name\s*:\s*(.*)$", Path("/proc/cpuinfo").read_text(), re.M)
    return found.group(1) if found else platform.processor()


def shell(words):
    return " ".join("'%s'" % w if re.search(r"[^\w./=~:-]", w) else w for w in words)


def section(name, result):
    """One item as Markdown, between marks by which the next run finds it."""
    lines = ["<!-- %s -->" % name, "## " + ITEMS[name].__doc__, "", "    tools/verify.py %s" % name, ""]
    if result is None:
        lines += ["Not run yet."]
    else:
        lines += ["    " + shell(c) for c in result["commands"]] + ["", "| what | found | wanted | |", "|---|---|---|---|"]
        verdict = {True: "✓", False: "**no**", None: ""}
        lines += ["| %s | %s | %s | %s |" % (r["what"], r["found"], r["wanted"], verdict[r["good"]]) for r in result["rows"]]
        lines += ["\n" + paragraph for paragraph in result.get("below", [])]
        picture = PAGE.with_name("validation_%s.svg" % name)
        lines += ["", "![%s](%s)" % (ITEMS[name].__doc__, picture.name)] if picture.exists() else []
        lines += ["", "%s, millscope %s, %s, %d cores." % (result["date"], result["commit"], result["processor"], result["cores"])]
    return "\n".join(lines) + "\n<!-- end %s -->\n" % name


def write_page(folder):
    before = PAGE.read_text() if PAGE.exists() else ""
    parts = ["# Validation\n\nWritten by `make verify`: each figure stands beside the command that gives it. `tools/verify.py ITEM` repeats one item,\n"
             "`tools/verify.py --quick` those of minutes. The tests (`make test`) hold the laws against theory; this page holds the whole\n"
             "mill against other codes and measurements.\n"]
    for name in ITEMS:
        kept = folder / ("result_%s.json" % name)
        old = re.search(r"<!-- %s -->.*?<!-- end %s -->\n" % (name, name), before, re.S)
        if kept.exists() or old is None:
            parts.append(section(name, json.loads(kept.read_text()) if kept.exists() else None))
        else:
            parts.append(old.group(0))
    PAGE.write_text("\n".join(parts))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], epilog="Items: " + "; ".join("%s: %s" % (n, f.__doc__) for n, f in ITEMS.items()))
    parser.add_argument("items", nargs="*", metavar="ITEM", help="which (default: all)")
    parser.add_argument("--build", type=Path, default=ROOT / "build" / "release", help="build directory (default build/release)")
    parser.add_argument("--quick", action="store_true", help="only " + ", ".join(QUICK))
    parser.add_argument("--threads", type=int, default=0, help="threads of each run (default: all cores)")
    parser.add_argument("--fresh", action="store_true", help="repeat runs that are complete")
    parser.add_argument("--kept", action="store_true", help="use complete runs only, and say what was not run")
    options = parser.parse_args()
    names = options.items or (QUICK if options.quick else list(ITEMS))
    bad = 0
    try:
        for name in names:
            if name not in ITEMS:
                raise Failure("there is no item '%s'; known: %s" % (name, ", ".join(ITEMS)))
        for name in names:
            print(ITEMS[name].__doc__, flush=True)
            bench = Bench(options.build.resolve(), options.threads, options.fresh, options.kept)
            rows = ITEMS[name](bench)
            bad += sum(r["good"] is False for r in rows)
            for r in rows:
                print("    %-4s %s: %s %s" % ({True: "ok", False: "NO", None: ""}[r["good"]], r["what"], r["found"], "(wanted: %s)" % r["wanted"] if r["wanted"] else ""))
            if any(isinstance(r, Absent) for r in rows):
                continue
            result = {"rows": rows, "commands": bench.commands, "date": time.strftime("%Y-%m-%d"), "commit": commit(), "processor": processor(),
                      "cores": os.cpu_count(), "below": bench.below}
            (bench.folder / ("result_%s.json" % name)).write_text(json.dumps(result, indent=1))
            write_page(bench.folder)
    except (Failure, round_robin_files.Failure) as e:
        print("verify: %s" % e, file=sys.stderr)
        return 2
    except NotRun as e:
        print("verify: the run '%s' is not complete, and --kept forbids to run it; leave --kept out" % e, file=sys.stderr)
        return 2
    print("see docs/validation.md" if bad == 0 else "%d figures are not as wanted; see docs/validation.md" % bad)
    return 0 if bad == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
