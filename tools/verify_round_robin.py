"""The round robin of Dosta 2024 for verify.py: LIGGGHTS and millscope mix the same beads of two sizes."""

import math
import os
import shutil
import subprocess

import round_robin_files
from public_data import ROOT
from round_robin_picture import picture
from verify_rows import absent, row

PICTURE = ROOT / "docs" / "validation_round_robin.svg"
OURS, THEIRS, HALF, STIFF = "millscope", "LIGGGHTS", "half the step", "true stiffness"
STEP = 1.5e-5  # s, of configs/round_robin/common.yaml
END, STIFF_END = 1.25, 0.26  # s; published are 5 s, of which each second costs LIGGGHTS a quarter of an hour of one core
SOFT = ("time.end_s=%g" % END, "time.analyze_from_s=%g" % (END / 2))
HARD = ("stiffness_factor=1", "time.step_s=2.4e-6", "time.end_s=%g" % STIFF_END, "time.analyze_from_s=0.1", "output.frames.every_s=0.025")
# Of each run its settings and options.
RUNS = {OURS: (SOFT, ()), THEIRS: (SOFT, ("--engine", "liggghts")), HALF: (SOFT + ("time.step_s=7.5e-6",), ()), STIFF: (HARD, ())}
INSTANTS = [0.25 * k for k in range(1, int(END / 0.25))] + [END - 0.05]  # s; the last frame lies at or just behind END - 0.05
STIFF_INSTANTS = (0.1, 0.15, 0.2, 0.25)
SIZES, ZONES = {"2 mm": 0.001, "4 mm": 0.002}, {"zone 1": 1, "zone 2": -1}  # radius, m; the sign of x and y
PAIRS, SHORT, LONG = 3, 300, 1800  # of cost: interleaved pairs, steps of the two runs whose difference counts


class Counts:
    """Beads of each size in each zone against time."""

    def __init__(self, folder):
        import h5py
        with h5py.File(folder / "frames.h5", "r", swmr=True) as f:
            self.time = [float(t) for t in f["time"]]
            radius = f["beads/radius"][:]
            self.of = {(s, z): [] for s in SIZES for z in ZONES}
            for k in range(len(self.time)):
                x, y = f["position"][k, :, 0], f["position"][k, :, 1]
                for (s, z), series in self.of.items():
                    sign = ZONES[z]
                    series.append(int(((abs(radius - SIZES[s]) < 1e-6) & (sign * x > 0) & (sign * y > 0)).sum()))

    def at(self, key, time):
        """Between two frames: in proportion."""
        k = max(1, min(len(self.time) - 1, sum(t < time for t in self.time)))
        part = (time - self.time[k - 1]) / (self.time[k] - self.time[k - 1])
        return self.of[key][k - 1] + part * (self.of[key][k] - self.of[key][k - 1])


def one_run(bench, name):
    """The run's folder."""
    case = bench.folder / "round_robin" / "case.yaml"
    settings, options = RUNS[name]
    out = "round_robin_" + name.replace(" ", "_")
    bench.run(out, os.path.relpath(case, ROOT), *settings, options=options)
    return bench.folder / out


def table(found):
    rows = []
    for time in INSTANTS:
        for key in found[OURS].of:
            values = "; ".join("%s %.0f" % (name, found[name].at(key, time)) for name in (OURS, THEIRS, HALF))
            rows.append(row("%s beads in %s at %.4g s" % (*key, time), values))
    return rows


def apart(first, second, key):
    """Mean and root mean square of second − first at the frames of first from the first instant on, and the mean of first."""
    frames = [k for k, t in enumerate(first.time) if INSTANTS[0] <= t <= INSTANTS[-1]]
    gaps = [second.at(key, first.time[k]) - first.of[key][k] for k in frames]
    mean = sum(first.of[key][k] for k in frames) / len(frames)
    return sum(gaps) / len(gaps), math.sqrt(sum(g * g for g in gaps) / len(gaps)), mean


def agreement(found):
    rows = []
    for key in found[OURS].of:
        offset, scatter, count = apart(found[OURS], found[HALF], key)
        rows.append(row("%s beads in %s: half the step less the step" % key, "mean %+.0f, rms %.0f of %.0f; √N %.0f" % (offset, scatter, count, math.sqrt(count)),
                        "rms within 2 √N", scatter < 2 * math.sqrt(count)))
        offset, rms, count = apart(found[OURS], found[THEIRS], key)
        limit = 2 * max(scatter, math.sqrt(count))
        rows.append(row("%s beads in %s: LIGGGHTS less millscope" % key, "mean %+.0f, rms %.0f of %.0f (%.1f %%)" % (offset, rms, count, 100 * rms / count),
                        "rms within twice the larger of √N and the step's: %.0f" % limit, rms < limit))
    return rows


def softening(found):
    rows = []
    for time in STIFF_INSTANTS:
        for key in found[OURS].of:
            soft, hard = found[OURS].at(key, time), found[STIFF].at(key, time)
            rows.append(row("%s beads in %s at %.4g s, true stiffness" % (*key, time), "%.0f; softened %.0f (%+.0f)" % (hard, soft, soft - hard)))
    return rows


def developed(bench, frames):
    """A case that begins with the places, velocities and spins of a run's last frame, for both engines alike."""
    import h5py
    out = bench.folder / "round_robin_cost"
    out.mkdir(exist_ok=True)
    with h5py.File(frames, "r", swmr=True) as f:
        last = len(f["time"]) - 1
        columns = [f[name][last] for name in ("position", "velocity", "spin")]
        radius = f["beads/radius"][:]
    lines = ["x,y,z,vx,vy,vz,wx,wy,wz,radius,material"]
    for k, r in enumerate(radius):
        lines.append(",".join("%.9g" % v for c in columns for v in c[k]) + ",%.9g,%s" % (r, round_robin_files.MATERIAL[round(float(r), 6)]))
    (out / "beads.csv").write_text("\n".join(lines) + "\n")
    for name in ("drum.stl", "case.yaml"):
        shutil.copy(bench.folder / "round_robin" / name, out)
    return out / "case.yaml"


def core_seconds(command, folder):
    """User and system time of a command that has one thread."""
    process = subprocess.Popen([str(c) for c in command], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise round_robin_files.Failure("'%s' failed in %s" % (" ".join(str(c) for c in command), folder))
    return usage.ru_utime + usage.ru_stime


def cost(bench, frames):
    """Particle-steps of each engine in a second of one core, from the same developed bed, in interleaved pairs."""
    case, spent = developed(bench, frames), {OURS: [], THEIRS: []}
    settings = {n: ["--set", "time.end_s=%.9g" % (n * STEP), "--set", "time.analyze_from_s=0", "--set", "output.frames=off"] for n in (SHORT, LONG)}
    for n, words in settings.items():
        out = case.parent / ("steps_%d" % n)
        shutil.rmtree(out, ignore_errors=True)
        bench.call("export", os.path.relpath(case, ROOT), "-o", os.path.relpath(out, ROOT), "--engine", "liggghts", *words)
    for _ in range(PAIRS):
        theirs = {n: core_seconds(["liggghts", "-in", "in.liggghts"], case.parent / ("steps_%d" % n)) for n in settings}
        ours = {n: core_seconds([bench.binary, "run", case, "-o", case.parent / "run", "--force", "--quiet", "--threads", "1"] + words, ROOT)
                for n, words in settings.items()}
        spent[OURS].append(ours[LONG] - ours[SHORT])
        spent[THEIRS].append(theirs[LONG] - theirs[SHORT])
    done = 1e-6 * 38000 * (LONG - SHORT)
    ratios = sorted(t / o for t, o in zip(spent[THEIRS], spent[OURS]))
    rows = [row("million particle-steps in a core-second, %s" % name, ", ".join("%.2f" % (done / s) for s in seconds)) for name, seconds in spent.items()]
    return rows + [row("time of LIGGGHTS over that of millscope, same bed, %d pairs" % PAIRS, "%.2f (%.2f to %.2f)" % (ratios[len(ratios) // 2], ratios[0], ratios[-1]))]


def round_robin(bench):
    """The round robin of Dosta 2024: beads of two sizes mix in a drum, in LIGGGHTS and in millscope (three quarters of an hour of one core)"""
    data = round_robin_files.data_folder()
    if data is None:
        return absent("beads and walls", "absent: not run")
    try:
        import h5py  # noqa: F401
    except ImportError:
        return absent("the counts", "Python has no h5py: not run")
    round_robin_files.write(data, bench.folder / "round_robin")
    folders = {name: one_run(bench, name) for name in RUNS}
    found = {name: Counts(folder) for name, folder in folders.items()}
    picture(PICTURE, {name: (c.time, c.of) for name, c in found.items()})
    rows = table(found) + agreement(found) + softening(found)
    return rows + cost(bench, folders[OURS] / "frames.h5")
