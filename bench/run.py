#!/usr/bin/env python3
"""Times millscope against LIGGGHTS on the cross-check case: bench/run.sh BUILD_DIR [--quick].

Both start from the same developed bed (positions, velocities, spins, wall angle), take the same step, run pinned to one core, one after
the other; what counts is the CPU time of the steps after a warm-up (of two threads the wall time, on all cores). Only ratios within one run of this script mean anything: machines
drift.
"""

import argparse
import hashlib
import json
import math
import os
import platform
import shutil
import statistics
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
CROSSCHECK = ROOT / "configs" / "crosscheck"

SLICE_MM = 20
FULL_MM = 270
FULL_COPIES = 14          # of the slice; what the end faces would touch falls away
FILLING = "31.3 %"
FULL_FILLING = "31.9 %"   # of the slice that the full mill is cut from: 57 500 beads are left
DEVELOPED_S = 2.0         # when the bed is called developed
RELAX_S = 0.05            # on the mesh of the comparison, between the end faces

# The liner as this project exports it, and with so few triangles that LIGGGHTS, whose cost grows with them, is at its best.
MESHES = {"fine": "3 mm", "coarse": "25 mm"}  # longest chord


PARTS = ("slice", "full", "threads", "sizes")


class Failure(Exception):
    """Something the user can put right."""


def say(text):
    print(text, flush=True)


def run(command, **more):
    """Runs a command and returns what it printed."""
    done = subprocess.run([str(c) for c in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **more)
    if done.returncode != 0:
        last = (done.stderr.strip() or done.stdout.strip()).splitlines()[-3:]
        raise Failure("%s failed (%d): %s" % (" ".join(str(c) for c in command), done.returncode, " | ".join(last)))
    return done.stdout


def install_liggghts():
    if shutil.which("liggghts"):
        return
    say("installing Debian's liggghts …")
    prefix = [] if os.geteuid() == 0 else ["sudo"]
    environment = dict(os.environ, DEBIAN_FRONTEND="noninteractive")
    run(prefix + ["apt-get", "update"], env=environment)
    run(prefix + ["apt-get", "install", "-y", "--no-install-recommends", "liggghts"], env=environment)


def liggghts_version():
    if not shutil.which("dpkg-query"):
        return "unknown"
    return run(["dpkg-query", "-W", "-f", "${Version}", "liggghts"]).strip()


class Setup:
    """Where things lie, and the two programs."""

    def __init__(self, build, core):
        self.work = (build / "bench").resolve()
        self.bench_program = build / "bin" / "millscope_bench"
        self.program = build / "bin" / "millscope"
        for p in (self.bench_program, self.program):
            if not p.exists():
                raise Failure("%s is missing; build it first: cmake --build %s" % (p, build))
        self.work.mkdir(parents=True, exist_ok=True)
        self.pin = ["taskset", "-c", str(core)]
        # Beds are kept as long as the cases that they come from stay as they are.
        text = b"".join(p.read_bytes() for p in sorted(CROSSCHECK.glob("*.yaml")) + [ROOT / "configs/materials/glass.yaml"])
        self.key = hashlib.sha256(text + repr((MESHES, DEVELOPED_S, FILLING, FULL_FILLING, RELAX_S)).encode()).hexdigest()[:10]

    def file(self, name):
        return self.work / ("%s-%s" % (self.key, name))


def liner(setup, mesh, length_mm, ends):
    """The liner as STL, made once by `millscope geometry export`."""
    file = setup.file("liner-%s-%g%s.stl" % (mesh, length_mm, "-ends" if ends else ""))
    if not file.exists():
        sets = ["geometry.liner.length=%g mm" % length_mm, "geometry.liner.facet=" + MESHES[mesh]]
        if ends:
            sets += ["geometry.liner.end_faces=true", "domain.periodic="]
        else:
            sets += ["domain.periodic.z=[0, %g mm]" % length_mm]
        part = file.with_suffix(".part.stl")
        part.unlink(missing_ok=True)
        run([setup.program, "geometry", "export", CROSSCHECK / "slice_parametric.yaml", "-o", part] + [w for s in sets for w in ("--set", s)])
        part.rename(file)
    return file


def case_words(setup, mesh, length_mm, ends=False):
    """The cross-check case with the liner as this mesh, as words of a command line."""
    words = [CROSSCHECK / "slice.yaml", "--set", "geometry.liner.file=%s" % liner(setup, mesh, length_mm, ends),
             "--set", "fill.vessel.length=%g mm" % length_mm]
    if ends:
        return words + ["--set", "geometry.liner.period=", "--set", "domain.periodic="]
    return words + ["--set", "geometry.liner.period=%g mm" % length_mm, "--set", "domain.periodic.z=[0, %g mm]" % length_mm]


def bed_file(setup, name, command):
    """A bed and its LIGGGHTS data file, made once by millscope_bench."""
    bed = setup.file(name + ".bed")
    data = bed.with_suffix(".data")
    if not (bed.exists() and data.exists()):
        say("making the bed '%s' …" % name)
        run([setup.bench_program] + command + ["--save", bed, "--liggghts", data])
    return bed


def developed(setup, name, filling):
    """A slice from filling to a developed state; the coarse mesh lies inside the fine one, so that its bed suits both."""
    return bed_file(setup, name, case_words(setup, "coarse", SLICE_MM) + ["--set", "fill.filling=" + filling, "--until", DEVELOPED_S])


def slice_bed(setup, mesh):
    source = developed(setup, "source-slice", FILLING)
    return bed_file(setup, "slice-" + mesh, case_words(setup, mesh, SLICE_MM) + ["--load", source, "--until", DEVELOPED_S + RELAX_S])


def full_bed(setup, mesh):
    source = developed(setup, "source-full", FULL_FILLING)
    return bed_file(setup, "full-" + mesh, case_words(setup, mesh, FULL_MM, True) +
                    ["--load", source, "--replicate-z", FULL_COPIES, "--until", DEVELOPED_S + RELAX_S, "--threads", os.cpu_count()])


def header(bed):
    with open(bed) as f:
        words = f.readline().split()
    names = ("beads", "time", "time_step", "angle", "omega", "radius", "density", "period")
    return dict(zip(names, (float(w) for w in words[1:])))


def time_millscope(setup, words, bed, steps, warm_up, copies=1):
    command = setup.pin + [setup.bench_program] + words + ["--load", bed, "--replicate-z", copies, "--steps", steps, "--warm-up", warm_up]
    return json.loads(run(command).splitlines()[-1])


def run_liggghts(setup, script, bed, mesh_file, steps, warm_up, extra=()):
    """Runs a script of bench/liggghts; returns the CPU seconds of the steps and what it printed."""
    marks = setup.work / "marks"
    marks.unlink(missing_ok=True)
    h = header(bed)
    variables = {"folder": HERE / "liggghts", "data": bed.with_suffix(".data"), "liner": mesh_file, "angle": repr(math.degrees(h["angle"]) % 360),
                 "period": repr(2 * math.pi / abs(h["omega"])), "dt": repr(h["time_step"]), "warm_up": warm_up, "steps": steps,
                 "marks": marks, "log": "none", "thermo": steps}
    words = ["-in", HERE / "liggghts" / script, "-echo", "none"]
    for name, value in list(variables.items()) + list(extra):
        words += ["-var", name, value]
    # The shell's id becomes that of LIGGGHTS, which reads its own CPU time under it.
    text = run(setup.pin + ["sh", "-c", 'exec liggghts "$@" -var pid $$', "sh"] + words, cwd=setup.work)
    nanoseconds = [int(line.split()[0]) for line in marks.read_text().splitlines()]
    if len(nanoseconds) != 2:
        raise Failure("LIGGGHTS left no CPU times in %s" % marks)
    return 1e-9 * (nanoseconds[1] - nanoseconds[0]), text


def compare(setup, name, script, bed, mesh, length_mm, ends, pairs, steps, warm_up):
    """Interleaved pairs: LIGGGHTS, millscope, LIGGGHTS, …"""
    words = case_words(setup, mesh, length_mm, ends)
    mesh_file = liner(setup, mesh, length_mm, ends)
    beads = int(header(bed)["beads"])
    triangles = mesh_file.read_text().count("endfacet")
    rows = []
    for k in range(pairs):
        peer, _ = run_liggghts(setup, script, bed, mesh_file, steps, warm_up)
        ours = time_millscope(setup, words, bed, steps, warm_up)
        rows.append({"liggghts_cpu_s": peer, "millscope_cpu_s": ours["cpu_s"], "ratio": peer / ours["cpu_s"],
                     "liggghts_M": 1e-6 * beads * steps / peer, "millscope_M": ours["M_particle_steps_per_cpu_s"]})
        say("  %s, %s mesh, pair %d: LIGGGHTS %.2f M/s, millscope %.2f M/s, ratio %.2f"
            % (name, mesh, k + 1, rows[-1]["liggghts_M"], rows[-1]["millscope_M"], rows[-1]["ratio"]))
    ratios = [r["ratio"] for r in rows]
    return {"case": name, "mesh": mesh, "triangles": triangles, "beads": beads, "steps": steps, "pairs": rows, "ratio_median": statistics.median(ratios),
            "ratio_min": min(ratios), "ratio_max": max(ratios), "liggghts_M_median": statistics.median(r["liggghts_M"] for r in rows),
            "millscope_M_median": statistics.median(r["millscope_M"] for r in rows), "steps_per_rebuild": ours["steps_per_rebuild"],
            "contacts_per_bead": ours["contacts_per_bead"]}


def start_millscope(setup, words, bed, steps, warm_up, threads):
    command = [setup.bench_program] + words + ["--load", bed, "--steps", steps, "--warm-up", warm_up, "--threads", threads]
    return subprocess.Popen([str(c) for c in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def outcome(process):
    text, complaint = process.communicate()
    if process.returncode != 0:
        raise Failure("millscope_bench failed (%d): %s" % (process.returncode, complaint.strip()))
    return json.loads(text.splitlines()[-1])


def threads(setup, name, words, bed, pairs, steps, warm_up):
    """Two threads against two programs of one thread at once, by wall time: what the machine has is the same for both. The states must be
    the same to the last bit."""
    rows, hashes = [], set()
    for k in range(pairs):
        two = outcome(start_millscope(setup, words, bed, steps, warm_up, 2))
        both = [outcome(p) for p in [start_millscope(setup, words, bed, steps, warm_up, 1) for _ in range(2)]]
        rows.append(two["M_particle_steps_per_wall_s"] / sum(b["M_particle_steps_per_wall_s"] for b in both))
        hashes |= {r["state_hash"] for r in both + [two]}
        say("  %s, threads, pair %d: two threads reach %.3f of two programs" % (name, k + 1, rows[-1]))
    return {"case": name, "pairs": rows, "share_median": statistics.median(rows), "share_min": min(rows), "share_max": max(rows),
            "same_hash": len(hashes) == 1, "state_hash": sorted(hashes)}


def sizes(setup, bed, repeats):
    """The slice replicated along z: cost per particle-step and peak memory per bead beyond what the smallest needs."""
    rows = []
    for copies, steps in ((1, 6000), (14, 600), (117, 100)):
        words = case_words(setup, "fine", SLICE_MM * copies)
        times = [time_millscope(setup, words, bed, steps, 60, copies=copies) for _ in range(repeats)]
        best = min(times, key=lambda t: t["ns_per_particle_step"])
        rows.append({"beads": best["beads"], "ns_per_particle_step": statistics.median(t["ns_per_particle_step"] for t in times),
                     "steps_per_rebuild": best["steps_per_rebuild"], "contacts_per_bead": best["contacts_per_bead"],
                     "peak_bytes": max(t["peak_bytes"] for t in times), "system_bytes_per_bead": best["system_bytes_per_bead"]})
        say("  %7d beads: %.1f ns per particle-step" % (rows[-1]["beads"], rows[-1]["ns_per_particle_step"]))
    small = rows[0]
    for row in rows[1:]:
        row["peak_bytes_per_bead"] = (row["peak_bytes"] - small["peak_bytes"]) / (row["beads"] - small["beads"])
    return rows


def reference(setup, bed, end):
    """The peer's own power and centre of mass, from the torque on its liner."""
    h = header(bed)
    steps = round((end - h["time"]) / h["time_step"])
    warm_up = round(0.5 / h["time_step"])
    run_liggghts(setup, "slice_torque.in", bed, liner(setup, "fine", SLICE_MM, False), steps - warm_up, warm_up)
    rows = []
    for line in (setup.work / "marks.torque").read_text().splitlines():
        if not line.startswith("#"):
            rows.append([float(w) for w in line.split()])
    rows = [r for r in rows if r[0] > warm_up]
    mass = h["beads"] * 4 / 3 * math.pi * h["radius"] ** 3 * h["density"]
    com = statistics.mean(r[2] for r in rows)
    return {"from_s": h["time"] + 0.5, "to_s": end, "power_torque_W": -statistics.mean(r[1] for r in rows) * h["omega"],
            "power_com_W": mass * 9.81 * com * h["omega"], "com_x_m": com}


def machine():
    name = platform.processor() or platform.machine()
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            name = line.split(":", 1)[1].strip()
            break
    return {"cpu": name, "cores": os.cpu_count(), "load_before": os.getloadavg()[0]}


def markdown(results):
    m = results["machine"]
    lines = ["# Benchmarks", "", "Written by `make bench` on %s: %s, %d cores, load %.1f before the run; LIGGGHTS %s (Debian)." %
             (results["date"], m["cpu"], m["cores"], m["load_before"], results["liggghts_version"]), "",
             "One core, developed bed, liner mesh with lifters, millscope's energy ledger on; CPU time of the same number of steps from the same state, "
             "in interleaved pairs. Both codes take the same mesh. The *fine* one is what `millscope geometry export` writes; the *coarse* one has so "
             "few triangles (lifters exact, shell in chords of 13 mm) that LIGGGHTS is at its fastest. Machines drift: compare ratios, not speeds, between runs."]
    if results["against_liggghts"]:
        lines += ["", "| case | beads | mesh (triangles) | pairs | LIGGGHTS, M particle-steps/s | millscope, M particle-steps/s | ratio: median | min | max |",
                  "|---|---|---|---|---|---|---|---|---|"]
    for c in results["against_liggghts"]:
        lines.append("| %s | %d | %s (%d) | %d | %.2f | %.2f | **%.2f** | %.2f | %.2f |" %
                     (c["case"], c["beads"], c["mesh"], c["triangles"], len(c["pairs"]), c["liggghts_M_median"], c["millscope_M_median"],
                      c["ratio_median"], c["ratio_min"], c["ratio_max"]))
    for t in results.get("threads", []):
        lines += ["", "Two threads of one program against two programs of one thread at once. Wall time on the %s: median **%.3f** (%.3f to %.3f) of %d pairs; "
                  "state hash of all: %s." % (t["case"], t["share_median"], t["share_min"], t["share_max"], len(t["pairs"]),
                                              "the same" if t["same_hash"] else "**different**")]
    if "sizes" in results:
        lines += ["", "Developed slice replicated along z, one core:", "",
                  "| beads | ns per particle-step | steps per list rebuild | contacts per bead | peak memory, B per bead beyond the base |", "|---|---|---|---|---|"]
        for r in results["sizes"]:
            memory = "%.0f" % r["peak_bytes_per_bead"] if "peak_bytes_per_bead" in r else "(the base)"
            lines.append("| %d | %.1f | %.1f | %.2f | %s |" % (r["beads"], r["ns_per_particle_step"], r["steps_per_rebuild"], r["contacts_per_bead"], memory))
    if "reference" in results:
        r = results["reference"]
        lines += ["", "LIGGGHTS on the slice, t = %.1f to %.1f s: power %.3f W by torque, %.3f W by M g ⟨x⟩ Ω; ⟨x⟩ = %.2f mm." %
                  (r["from_s"], r["to_s"], r["power_torque_W"], r["power_com_W"], 1e3 * r["com_x_m"])]
    return "\n".join(lines) + "\n"


def verdict(results):
    """What the project promises, each line with what was found. Returns whether all that was measured holds."""
    wanted = {"slice": 5, "full mill": 4}
    found = [("%s, %s mesh: ratio %.2f, at least %g wanted" % (c["case"], c["mesh"], c["ratio_median"], wanted[c["case"]]),
              c["ratio_median"] >= wanted[c["case"]]) for c in results["against_liggghts"]]
    share = {"slice": 0.9, "full mill": 0.95}
    for t in results.get("threads", []):
        found.append(("%s, two threads: %.3f of two programs, at least %g wanted" % (t["case"], t["share_median"], share[t["case"]]),
                      t["share_median"] >= share[t["case"]]))
        found.append(("%s: same state hash at one and two threads" % t["case"], t["same_hash"]))
    if "sizes" in results:
        peak = results["sizes"][-1]["peak_bytes_per_bead"]
        found.append(("peak memory: %.0f B per bead, at most 800 wanted" % peak, peak <= 800))
    for text, good in found:
        say("%s  %s" % ("ok  " if good else "MISS", text))
    return all(good for _, good in found)


def main():
    parser = argparse.ArgumentParser(prog="bench/run.sh", description="Times millscope against LIGGGHTS; see docs/benchmarks.md for what it found.")
    parser.add_argument("build", type=Path, help="build directory, e.g. build/release")
    parser.add_argument("--quick", action="store_true", help="one pair, slice only")
    parser.add_argument("--pairs", type=int, default=5, help="interleaved pairs (default 5)")
    parser.add_argument("--core", type=int, default=max(os.sched_getaffinity(0)), help="core to pin to")
    parser.add_argument("--mesh", choices=sorted(MESHES), action="append", help="which liner mesh (default: both)")
    parser.add_argument("--only", choices=PARTS, action="append", help="only these parts")
    parser.add_argument("--reference", action="store_true", help="also LIGGGHTS' own power on the slice (minutes)")
    options = parser.parse_args()
    parts = ["slice"] if options.quick else options.only or list(PARTS)
    pairs = 1 if options.quick else options.pairs
    meshes = options.mesh or ["coarse", "fine"]
    try:
        install_liggghts()
        setup = Setup(options.build, options.core)
        results = {"date": time.strftime("%Y-%m-%d"), "machine": machine(), "liggghts_version": liggghts_version(), "against_liggghts": []}
        for mesh in meshes:
            if "slice" in parts:
                bed = slice_bed(setup, mesh)
                results["against_liggghts"].append(compare(setup, "slice", "slice.in", bed, mesh, SLICE_MM, False, pairs, 4000, 500))
        for mesh in meshes:
            if "full" in parts:
                bed = full_bed(setup, mesh)
                results["against_liggghts"].append(compare(setup, "full mill", "full.in", bed, mesh, FULL_MM, True, pairs, 600, 200))
        if "threads" in parts:
            full = case_words(setup, "fine", FULL_MM, True), full_bed(setup, "fine")
            part = case_words(setup, "coarse", SLICE_MM), slice_bed(setup, "coarse")
            results["threads"] = [threads(setup, "slice", *part, pairs, 8000, 500), threads(setup, "full mill", *full, pairs, 1200, 200)]
        if "sizes" in parts:
            results["sizes"] = sizes(setup, slice_bed(setup, "fine"), min(3, pairs))
        if options.reference:
            results["reference"] = reference(setup, slice_bed(setup, "fine"), 4.0)
        (setup.work / "results.json").write_text(json.dumps(results, indent=1) + "\n")
        (setup.work / "benchmarks.md").write_text(markdown(results))
        say("\n" + markdown(results))
        good = verdict(results)
        say("wrote %s" % (setup.work / "results.json"))
        if set(parts) == set(PARTS) and not options.mesh:
            say("to publish: cp %s docs/benchmarks.md" % (setup.work / "benchmarks.md"))
        return 0 if good or options.quick else 1
    except Failure as e:
        print("bench: %s" % e, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
