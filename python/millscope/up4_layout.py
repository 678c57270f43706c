"""To and from `up4` (Birmingham), which draws fields of particle data: its HDF5 layout and its CSV input. SI, as here.

Read from its sources of 31 May 2024 (src/converter.rs, src/datamanager/tdata.rs and pdata.rs), not tried with up4 itself.
A file with `hdf5_up4_type` 1 has a group `timestep k` per frame, with 2 a group `particle k` per particle.
"""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy

from .errors import Error
from .files import PathLike, existing, written
from .runs import Run
from .tracks import Track, Tracks


class _Extent:
    """What up4 keeps of a whole file: extents, and least, mean and largest velocity."""

    def __init__(self) -> None:
        self.low, self.high, self.count = numpy.full(3, numpy.inf), numpy.full(3, -numpy.inf), 0
        self.least, self.sum, self.most = numpy.full(4, numpy.inf), numpy.zeros(4), numpy.full(4, -numpy.inf)

    def add(self, position: numpy.ndarray, velocity: numpy.ndarray) -> None:
        four = numpy.column_stack([velocity, numpy.linalg.norm(velocity, axis=1)])  # vx, vy, vz, speed
        self.low, self.high = numpy.minimum(self.low, position.min(0)), numpy.maximum(self.high, position.max(0))
        self.least, self.most = numpy.minimum(self.least, four.min(0)), numpy.maximum(self.most, four.max(0))
        self.sum, self.count = self.sum + four.sum(0), self.count + len(four)

    def write(self, file: h5py.File) -> None:
        velocity = numpy.column_stack([self.least, self.sum / self.count, self.most])  # rows vx, vy, vz, speed; columns min, mean, max
        file.attrs["dimensions"] = numpy.array([self.low, self.high])
        file.attrs["velocity"], file.attrs["velocity magnitude"] = velocity[:3], velocity[3]


def write_up4(run: Run, path: PathLike, every: int = 1, force: bool = False) -> Path:
    """Writes every `every`-th frame of a run as up4.Data reads it: position (m), velocity (m/s), radius (m), density (kg/m³), id, type.

    Ids are those of millscope plus 1, for up4 takes 0 for "all"; `particletype` counts the materials from 1.
    """
    if every < 1:
        raise Error(f"every is {every}; give 1 for all frames, 2 for every second one")
    frames = run.frames
    time = frames.time_s
    chosen = range(0, len(time), every)
    if not chosen:
        raise Error(f"{frames.path}: has no frames yet; let the run go on")
    beads = frames.beads.sort_values("id", kind="stable")
    radius = beads["radius_m"].to_numpy()
    fixed = {"id": beads["id"] + 1.0, "radius": radius, "density": beads["mass_kg"] / (4 / 3 * numpy.pi * radius**3),
             "particletype": beads["material"].astype("category").cat.codes + 1.0, "ppcloud": numpy.ones(len(beads))}
    extent, position, velocity, order = _Extent(), frames.position_m, frames.velocity_m_per_s, beads.index.to_numpy()
    with written(path, force) as beside, h5py.File(beside, "w") as file:
        for k, frame in enumerate(chosen):
            group = file.create_group(f"timestep {k}")
            moving = {"position": position[frame][order].astype(float), "velocity": velocity[frame][order].astype(float)}
            for name, values in {"time": time[frame], **moving, **fixed}.items():
                group[name] = values
            extent.add(**moving)
        _describe(file, time[::every], len(beads))
        extent.write(file)
    return Path(path)


def _describe(file: h5py.File, time: numpy.ndarray, particles: int) -> None:
    file.attrs.create("hdf5_up4_type", 1, dtype="u1")
    file.attrs.create("particle number", particles, dtype="u8")
    file.attrs.create("timesteps", len(time), dtype="u8")
    file["time array"] = time
    file.attrs["time"] = time[[0, -1]]
    file.attrs["sample rate"] = float(time[-1] - time[-2]) if len(time) > 1 else 0.0  # what up4 calls so: the last interval


def write_up4_csv(track: Track, path: PathLike, force: bool = False) -> Path:
    """Writes one track as t,x,y,z in s and m below a line of heads, from which up4 makes its own file and finds the velocities:

        up4.Converter.csv(path, "bead.hdf5", columns=[0, 1, 2, 3], header=True, vel=True, interpolate=True, radius=…)

    One file per track: up4 passes over rows that go back in time.
    """
    with written(path, force) as beside:
        track.table().set_axis(["t", "x", "y", "z"], axis=1).to_csv(beside, index=False)
    return Path(path)


def read_up4(path: PathLike) -> Tracks:
    """The particles of an up4 file of single particles (`hdf5_up4_type` 2) as they stand there, in s and m.

    Raises Error for other files, and where times do not increase.
    """
    path = existing(path, "up4.Converter.csv(…)")
    try:
        file = h5py.File(path, "r")
    except OSError as reason:
        raise Error(f"{path}: cannot be opened as HDF5 ({reason}); take a file that up4.Converter wrote") from reason
    with file:
        kind = file.attrs.get("hdf5_up4_type")
        if kind is None or int(kind) != 2:
            raise Error(f"{path}: hdf5_up4_type is {'missing' if kind is None else int(kind)}, not 2; take a file of single particles, from up4.Converter.csv")
        names = sorted((name for name in file if name.startswith("particle ")), key=lambda name: int(name.split()[1]))
        return Tracks({name.replace(" ", "_"): _particle(path, name, file[name]) for name in names})


def _particle(path: Path, name: str, group: h5py.Group) -> Track:
    time, position = group["time"][:].astype(float), group["position"][:].astype(float)
    back = numpy.flatnonzero(numpy.diff(time) <= 0)
    if len(back):
        row = back[0] + 1
        raise Error(f"{path}: {name}: time {time[row]:g} s in row {row} is not after {time[row - 1]:g} s; convert its source again with one particle")
    return Track(name.replace(" ", "_"), time, position, diameter_m=2 * float(group["radius"][0]) or numpy.nan, source=str(path))
