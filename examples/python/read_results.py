#!/usr/bin/env python3
"""Reads what millscope writes, with h5py and numpy; draws it where matplotlib is installed.

    millscope run configs/demo.yaml -o demo-out
    millscope analyze demo-out
    examples/python/read_results.py demo-out demo-out-analysis --pictures pictures

The parts between the # %% lines are cells in editors that know them. All files: docs/format.md.
"""

# %% What is read
import argparse
import json
import sys
from pathlib import Path

try:
    import h5py
    import numpy as np
except ImportError as missing:
    sys.exit(f"read_results: {missing.name} is not installed; on Debian: apt-get install python3-h5py python3-numpy")

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("run", type=Path, nargs="?", default=Path("demo-out"), help="directory of 'millscope run'")
parser.add_argument("analysis", type=Path, nargs="?", help="directory of 'millscope analyze' (default: RUN-analysis)")
parser.add_argument("--pictures", type=Path, help="draw PNG files into this directory")
arguments = parser.parse_args()
run = arguments.run
analysis = arguments.analysis or run.with_name(run.name + "-analysis")
for file, command in ((run / "summary.json", f"millscope run CASE.yaml -o {run}"), (run / "frames.h5", "a case with 'output: {frames: {every_s: 0.01}}'"),
                      (analysis / "results.h5", f"millscope analyze {run} -o {analysis}")):
    if not file.exists():
        sys.exit(f"read_results: there is no {file}; it comes from: {command}")

# %% summary.json: means of the whole run with standard errors
summary = json.loads((run / "summary.json").read_text())
power = summary["power_W"]
print(f"{summary['name']}: {summary['particles']} beads, window {summary['window_s'][0]:.3g} to {summary['window_s'][1]:.3g} s, steady: {summary['steady']}")
for way in ("torque", "com", "dissipation"):
    print(f"  power by {way:12} {power[way]:9.4g} +- {power[way + '_sem']:.2g} W")

# %% frames.h5: every bead, every few milliseconds
with h5py.File(run / "frames.h5", swmr=True) as f:  # swmr: also while the run is going on
    count = min(len(f["time"]), len(f["position"]))
    time = f["time"][:count]
    mass = f["beads/mass"][:]
    x_of_charge = np.array([np.average(f["position"][k, :, 0], weights=mass) for k in range(count)])  # m, frame by frame: never all at once
    speed = np.linalg.norm(f["velocity"][count - 1], axis=1)  # m/s, of the last frame
print(f"{count} frames from {time[0]:.3g} to {time[-1]:.3g} s; fastest bead of the last one {speed.max():.3g} m/s")

# The power from it, by hand: M g <x> Omega over the window of the summary.
window = (time >= summary["window_s"][0]) & (time <= summary["window_s"][1])
by_hand = mass.sum() * 9.81 * x_of_charge[window].mean() * summary["mill_speed_rad_per_s"]
print(f"  M g <x> Omega from the frames: {by_hand:.4g} W")

# %% results.h5: every value of every analyzer with its uncertainty, and how they hang together
with h5py.File(analysis / "results.h5") as f:
    def result(path):
        """value, standard error and unit of ANALYZER/RESULT."""
        group = f["analyzers/" + path]
        return group["value"][()], group["sem"][()] if "sem" in group else None, group.attrs["unit"]

    gravity, gravity_sem, unit = result("power/power_gravity")
    shoulder, shoulder_sem, _ = result("charge_features/departure_shoulder")
    print(f"power_gravity {gravity:.4g} +- {gravity_sem:.2g} {unit}, shoulder {shoulder:.4g} +- {shoulder_sem:.2g} degrees past 6 o'clock")

    occupancy, occupancy_sem, _ = result("pept_grid/occupancy")  # [y, x]
    x_edges, y_edges = result("pept_grid/x_edges")[0], result("pept_grid/y_edges")[0]

    # All results come from the same resamples, so anything that is made of several has an error, too: here a ratio.
    if "draws" not in f["analyzers/power/power_bbosa"]:
        sys.exit("read_results: the data are too short for resamples; run longer (time.end_s) and analyze again")
    draws = f["analyzers/power/power_bbosa/draws"][:] + f["analyzers/power/power_bbosa/value"][()]
    ratio = draws / (f["analyzers/power/power_gravity/draws"][:] + gravity)
    print(f"Bbosa's power over M g <x> Omega: {np.nanmean(ratio):.4f} +- {np.nanstd(ratio):.4f}")

    names = list(f["covariance"].attrs["names"])
    pair = [names.index("power.power_gravity"), names.index("power.power_bbosa")]
    covariance = f["covariance/matrix"][:][np.ix_(pair, pair)]
print(f"correlation of the two: {covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1]):.2f}")
visited = occupancy > 0
print(f"occupancy: {visited.sum()} of {visited.size} cells visited, {np.nanmedian(occupancy_sem[visited] / occupancy[visited]):.1%} usual standard error")

# %% Pictures
if arguments.pictures:
    try:
        import matplotlib
    except ImportError:
        sys.exit("read_results: matplotlib is not installed, so nothing is drawn; on Debian: apt-get install python3-matplotlib")
    matplotlib.use("Agg")  # into files, without a display
    import matplotlib.pyplot as plt

    arguments.pictures.mkdir(parents=True, exist_ok=True)

    figure, axes = plt.subplots(figsize=(5, 4.4), constrained_layout=True)
    shown = axes.pcolormesh(1e3 * x_edges, 1e3 * y_edges, np.where(visited, 100 * occupancy, np.nan), cmap="viridis")
    axes.set(xlabel="x (mm)", ylabel="y (mm)", title=f"{summary['name']}: occupancy", aspect="equal")
    figure.colorbar(shown, label="share of the charge's time in a cell (%)")
    figure.savefig(arguments.pictures / "occupancy.png", dpi=150)

    series = np.genfromtxt(run / "series.csv", delimiter=",", names=True)
    figure, axes = plt.subplots(figsize=(6, 3.6), constrained_layout=True)
    axes.plot(series["time_s"], series["power_torque_W"], lw=0.6, label="shell torque × Ω")
    axes.plot(series["time_s"], series["power_com_W"], label="M g x Ω")
    axes.axhspan(power["torque"] - power["torque_sem"], power["torque"] + power["torque_sem"], alpha=0.3, label="mean by torque ± standard error")
    axes.axvline(summary["window_s"][0], color="0.5", ls=":")
    axes.set(xlabel="time (s)", ylabel="power (W)", title=f"{summary['name']}: power")
    axes.legend()
    figure.savefig(arguments.pictures / "power.png", dpi=150)
    print(f"drawn: {arguments.pictures / 'occupancy.png'}, {arguments.pictures / 'power.png'}")
