"""The long check of `compare`, for verify.py: recordings of mills that are alike and of mills that are not."""

import json
import os
from pathlib import Path

from verify_rows import absent, row

ROOT = Path(__file__).resolve().parent.parent
LONG = ROOT.parent / "shared" / "recordings" / "mill10_long"
# Of sixty tracer runs of 20 s of each mill at each speed the first and the number of those in one recording; neighbours are compared.
EQUAL = ((1, 15), (16, 15), (31, 15), (46, 15))
UNEQUAL = ((1, 6), (7, 24), (31, 6), (37, 24))
SPEEDS = (75, 60, 50)
TRUE_POWER = {75: 0.0, 60: 0.186, 50: 0.199}  # W, B − A, from all beads
CONDITION = """condition: {speed: %d %%critical, direction: clockwise, filling: 31.3 %%, porosity: 0.37, bead_diameter: 10 mm, bead_density: 2500,
            mill_diameter: 300 mm, mill_length: 60 mm}
"""


def analyse(bench, folder, mill, speed, first, count):
    """`count` of a mill's sixty runs at a speed, analysed once."""
    name = "%s%d_%02d-%02d" % (mill, speed, first, first + count - 1)
    out = folder / name
    if bench.fresh or not (out / "results.h5").exists():
        files = [os.path.relpath(LONG / ("mill10_%s_%d_%02d.a.gz" % (mill, speed, first + i)), folder) for i in range(count)]
        recording = folder / (name + ".yaml")
        recording.write_text("files: [%s]\n%s" % (", ".join(files), CONDITION % speed))
        bench.call("analyze", os.path.relpath(recording, ROOT), "-o", os.path.relpath(out, ROOT), "--force", "--no-pictures", "-q")
    return os.path.relpath(out, ROOT)


def alarms_of(bench, folder, parts):
    """Pairs of the same mill in which something differs, and how many observables each pair has."""
    alarms, judged = 0, []
    for mill in "AB":
        for speed in SPEEDS:
            for k in (0, 2):
                pair = [analyse(bench, folder, mill, speed, *parts[k + i]) for i in (0, 1)]
                found = json.loads(bench.call("compare", *pair, "--json")[0])
                alarms += found["verdict"] == "differ"
                judged.append(len(found["observables"]))
    return alarms, judged


def differences(bench):
    """Comparisons of recordings: of the same mill twelve pairs of 300 s and twelve of 120 s against 480 s; three pairs of mills that differ in rolling friction"""
    if not LONG.exists():
        return absent("recordings of the mill", "absent: not checked")
    folder = bench.folder / "compare"
    folder.mkdir(exist_ok=True)
    rows = []
    for what, parts in (("of 300 s each", EQUAL), ("of 120 s against 480 s", UNEQUAL)):
        alarms, judged = alarms_of(bench, folder, parts)
        rows.append(row("pairs of the same mill, %s, in which something differs at 5 %% family-wise" % what,
                        "%d of 12 (%d to %d observables)" % (alarms, min(judged), max(judged)), "at most 3 (99 % of the binomial distribution at 5 %)", alarms <= 3))
    for speed in SPEEDS:
        pair = [analyse(bench, folder, mill, speed, *EQUAL[0]) for mill in "AB"]
        found = json.loads(bench.call("compare", *pair, "--json")[0])
        first = found["observables"][0]
        rows.append(row("mills with and without rolling friction at %d %%" % speed,
                        "%d of %d observables differ; strongest %s, %s" % (sum(o["differs"] for o in found["observables"]), len(found["observables"]), first["name"],
                                                                         first["strongest"]["where"]),
                        "some", found["verdict"] == "differ"))
        power = next((o for o in found["observables"] if o["name"] == "power.power_gravity"), None)
        if power is not None:
            rows.append(row("power there, B − A, 90 % interval", "%.2f … %.2f W" % (power["strongest"]["low"], power["strongest"]["high"]),
                            "true: %+.2f W" % TRUE_POWER[speed]))
    bench.commands = bench.commands[:3]
    return rows
