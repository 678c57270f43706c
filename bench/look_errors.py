#!/usr/bin/python3
"""Are the errors right by which a diagnosis weighs a recording? bench/look_errors.py BUILD -o FOLDER [--beads 24,60] [--starts 40]
[--case CASE.yaml] [--percent 75] [--seconds 10]

The mill of the proof is simulated from many starts (at 75 % of critical, or another speed), and each is looked at as a recording of some of
its beads. All show one mill, so that they differ from their mean by chance alone. The misfit of one recording is the mean square of that,
d' C^-1 d/n with its n numbers. It is 1 where the errors C are right, less where they are taken for too large. Four C: the recording's own, its
correlations shrunk; what simulations of 3 s with 150 beads have, as large as the recording's own along their own directions (nearly what a
diagnosis takes); the same, as large as the recording's own in the median of the numbers; the same, as large as simulations say by the second
of a bead. Debian's python3, for numpy.
"""

import argparse
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parent.parent
STUDY = """base: %s
conditions:
  speed: {set: {mill.speed: %d %%critical, time.end_s: %d, time.analyze_from_s: 1}, recording: recording.yaml, role: fit}
parameters: {pairs.glass~glass.static_friction: {range: [0.1, 0.6]}}
observe: {beads: %d}
"""


def call(*command):
    done = subprocess.run([str(c) for c in command], text=True, capture_output=True)
    if done.returncode != 0:
        raise RuntimeError("%s failed (%d): %s" % (" ".join(map(str, command)), done.returncode, done.stderr.strip()))


def simulate(how, out, seed, seconds, output):
    if not (out / "summary.json").exists():
        settings = ["seed=%d" % seed, "mill.speed=%d %%critical" % how.percent, "time={end_s: %d, analyze_from_s: 1}" % (1 + seconds)]
        settings += ["output." + setting for setting in output]
        call(how.build / "bin/millscope", "run", how.case, "-o", out, "--force", "--quiet", "--threads", 1,
             *(word for setting in settings for word in ("--set", setting)))
    return out


class Look:
    """What was seen of one run: values, covariance of all errors, what resampling says of it, bead-seconds, blocks."""

    def __init__(self, file):
        values, rows, resampled = [], [], []
        for line in file.read_text().splitlines():
            words = line.split()
            if words[0] != "0" or words[1] == "bin":
                continue
            if words[1] == "resampled":
                resampled.append([float(w) for w in words[2:]])
            elif words[-4:-3] == ["blocks"]:
                self.blocks, self.seconds = float(words[-3]), float(words[-1])
            else:
                rows.append([float(w) for w in words[-len(rows) - 1:]])
                values.append(float(words[-len(rows) - 1]))
        full = lambda lower: numpy.array([r + [0.0] * (len(lower) - len(r)) for r in lower])
        self.values = numpy.array(values)
        self.covariance, self.resampled = (m + numpy.tril(m, -1).T for m in (full(rows), full(resampled)))


def look(how, beads, run):
    folder = how.output
    file = folder / ("%s-%d.txt" % (run.name, beads))
    if not file.exists():
        study = folder / ("study-%d.yaml" % beads)
        study.write_text(STUDY % (how.case, how.percent, 1 + how.seconds, beads))
        call(how.build / "bin/millscope_look_bench", study, "--run", run, "--looks", 1, "--values", file.with_suffix(".new"))
        os.replace(file.with_suffix(".new"), file)
    return Look(file)


def misfits(looks, pool):
    mean = numpy.mean([o.values for o in looks], axis=0)
    deviations = [(o.values - mean) * (len(looks) / (len(looks) - 1)) ** 0.5 for o in looks]
    second = numpy.mean([o.seconds * o.resampled for o in pool], axis=0)
    tracked = numpy.diag(second) > 0

    kept = numpy.ix_(tracked, tracked)

    def along(o):
        return numpy.trace(numpy.linalg.solve(second[kept], o.resampled[kept])) / tracked.sum()

    def median(o):
        return numpy.median(numpy.diag(o.resampled)[tracked] / numpy.diag(second)[tracked])

    for name, covariance in (("the recording's own", lambda o: o.covariance), ("simulations', the recording's size", lambda o: along(o) * second),
                             ("simulations', its size by the median number", lambda o: median(o) * second),
                             ("simulations'", lambda o: second / o.seconds)):
        yield name, [d[tracked] @ numpy.linalg.solve(covariance(o)[kept], d[tracked]) / tracked.sum() for o, d in zip(looks, deviations)]


def main():
    parser = argparse.ArgumentParser(prog="bench/look_errors.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--beads", default="24,60", help="as many are seen in a recording, from 20")
    parser.add_argument("--starts", type=int, default=40)
    parser.add_argument("--case", type=lambda name: Path(name).resolve(), default=ROOT / "configs/proof/story.yaml", help="the mill")
    parser.add_argument("--percent", type=int, default=75, help="of the critical speed")
    parser.add_argument("--seconds", type=int, default=10, help="of a recording")
    how = parser.parse_args()
    folder = how.output
    folder.mkdir(parents=True, exist_ok=True)
    frames = ["frames.every_s=0.005", "tracks=~", "vtk=~"]
    try:
        if not (folder / "recording.yaml").exists():
            simulate(how, folder / "recorded", 1, how.seconds, ["tracks={beads: 60, every_s: 0.0005}", "frames=~", "vtk=~"])
            call(how.build / "bin/millscope", "pept", "synthesize", folder / "recorded", "-o", folder / "recording.a", "--camera",
                 ROOT / "configs/cameras/study.yaml")
        with ThreadPoolExecutor(os.cpu_count()) as threads:
            starts = list(threads.map(lambda k: simulate(how, folder / ("start-%d" % k), 1000 + k, how.seconds, frames), range(how.starts)))
            short = list(threads.map(lambda k: simulate(how, folder / ("short-%d" % k), 2000 + k, 3, frames), range(how.starts)))
            pool = list(threads.map(lambda run: look(how, 150, run), short))
            print("| beads seen for %d s | errors | misfit of a recording | scatter of it | largest |\n|---|---|---|---|---|" % how.seconds)
            for beads in (int(b) for b in how.beads.split(",")):
                looks = list(threads.map(lambda run: look(how, beads, run), starts))
                for name, found in misfits(looks, pool):
                    print("| %d | %s | %.2f | %.2f | %.2f |" % (beads, name, numpy.mean(found), numpy.std(found, ddof=1), max(found)), flush=True)
    except RuntimeError as e:
        print("look_errors: %s" % e, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
