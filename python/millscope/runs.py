"""A directory of `millscope run`."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import Any

import h5py
import numpy
import pandas

from .cases import Case, load_case
from .errors import Error
from .files import PathLike, existing, open_hdf5, read_csv, read_json
from .tracks import Tracks, open_tracks
from .units import with_unit

COMES_FROM = "millscope run CASE.yaml -o OUT"


class FrameArray:
    """A dataset of frames.h5 that is read when it is indexed, never all at once: `array[-1]`, `array[10:20, :, 0]`.

    shape: of the complete frames; unit: as text.
    """

    def __init__(self, frames: Frames, name: str):
        self._frames, self._name = frames, name
        with frames.open() as file:
            if name not in file:
                raise Error(f"{frames.path}: has no '{name}'; a case of an earlier version, or one in which there is nothing of it")
            self.shape = (frames.count(file), *file[name].shape[1:])
            self.unit = str(file[name].attrs["unit"])

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, index: Any) -> numpy.ndarray:
        """What numpy would give of the whole array; only the frames between the first and the last that are asked for are read."""
        given = index if isinstance(index, tuple) else (index,)
        first, *others = given if given and given[0] is not None and given[0] is not Ellipsis else (slice(None), *given)
        chosen = numpy.arange(self.shape[0])[first]  # frames from the end count from the last complete one
        low, high = (numpy.min(chosen), numpy.max(chosen) + 1) if numpy.size(chosen) else (0, 0)
        with self._frames.open() as file:
            block = file[self._name][low:high]
        if len(others) == len(given):  # it began with '...' or a new axis: all frames
            return block[index]
        return block[(slice(None, None, first.step) if isinstance(first, slice) else chosen - low, *others)]

    def __array__(self, dtype: Any = None) -> numpy.ndarray:
        return numpy.asarray(self[:], dtype)

    def __repr__(self) -> str:
        return f"FrameArray('{self._name}', shape={self.shape}, unit='{self.unit}')"


class Frames:
    """frames.h5: n frames of N beads; also of a run that is going on, n is then what is complete now.

    time_s, wall_angle_rad, angular_velocity_rad_per_s: [n]; position_m, velocity_m_per_s, spin_rad_per_s: FrameArray [n, N, 3],
    in the order of `beads`.
    """

    def __init__(self, path: PathLike):
        self.path = Path(path)
        with self.open() as file:
            self._beads = self._read_beads(file)

    def open(self) -> h5py.File:
        """The file itself, for what is not below."""
        return open_hdf5(self.path, "millscope frames", "a case with 'output: {frames: {every_s: 0.01}}'")

    @staticmethod
    def count(file: h5py.File) -> int:
        """How many frames are complete: `time` is written last."""
        return min(len(file["time"]), len(file["position"]))

    @staticmethod
    def _read_beads(file: h5py.File) -> pandas.DataFrame:
        names = numpy.asarray(file["beads/material"].attrs["names"], dtype=object)
        return pandas.DataFrame({"id": file["beads/id"][:], "radius_m": file["beads/radius"][:], "mass_kg": file["beads/mass"][:],
                                 "material": names[file["beads/material"][:]]})

    def __len__(self) -> int:
        with self.open() as file:
            return self.count(file)

    def _per_frame(self, name: str) -> numpy.ndarray:
        with self.open() as file:
            return file[name][:self.count(file)]

    def _columns(self, name: str) -> pandas.DataFrame:
        with self.open() as file:
            time = pandas.Index(file["time"][:self.count(file)], name="time_s")
            if name not in file:
                return pandas.DataFrame(index=time)
            data = file[name]
            columns = [with_unit(str(column), str(data.attrs["unit"])) for column in data.attrs["columns"]]
            return pandas.DataFrame(data[:len(time)], time, columns)

    @property
    def beads(self) -> pandas.DataFrame:
        """N rows: id, radius_m, mass_kg, material."""
        return self._beads

    @property
    def time_s(self) -> numpy.ndarray:
        return self._per_frame("time")

    @property
    def wall_angle_rad(self) -> numpy.ndarray:
        """Angle of the mill about z since the start."""
        return self._per_frame("wall_angle")

    @property
    def angular_velocity_rad_per_s(self) -> numpy.ndarray:
        return self._per_frame("angular_velocity")

    @property
    def position_m(self) -> FrameArray:
        return FrameArray(self, "position")

    @property
    def velocity_m_per_s(self) -> FrameArray:
        return FrameArray(self, "velocity")

    @property
    def spin_rad_per_s(self) -> FrameArray:
        return FrameArray(self, "spin")

    @property
    def wall_work(self) -> pandas.DataFrame:
        """n rows over time_s: what each body has given to the charge since the start, BODY_J."""
        return self._columns("wall_work")

    @property
    def dissipation(self) -> pandas.DataFrame:
        """n rows over time_s: what is lost since the start, PAIR:CHANNEL_J."""
        return self._columns("dissipation")

    def impacts(self, frame: int = -1) -> pandas.DataFrame:
        """Collisions since the start up to a frame, by impact energy: energy_from_J, energy_to_J, one column per pair of materials."""
        counts = FrameArray(self, "impacts")[frame]
        with self.open() as file:
            edges, pairs = file["impact_energy_edge"][:], [str(pair) for pair in file["impacts"].attrs["pairs"]]
        return pandas.DataFrame({"energy_from_J": edges[:-1], "energy_to_J": edges[1:], **dict(zip(pairs, counts))})


class Run:
    """A directory of `millscope run`. What a case did not ask for is not there: then Error says which lines to add to the case."""

    def __init__(self, path: PathLike):
        self.path = existing(path, COMES_FROM)
        if not (self.path / "case.resolved.yaml").exists():
            raise Error(f"{self.path} is no directory of a run: it has no case.resolved.yaml; it comes from: {COMES_FROM}")

    @cached_property
    def summary(self) -> dict[str, Any]:
        """summary.json: means with standard errors, doubts, provenance; written at the end of a run."""
        return read_json(self.path / "summary.json", f"millscope resume {self.path}, which ends the run")

    @property
    def series(self) -> pandas.DataFrame:
        """series.csv: a row per instant; the columns carry their units (time_s, power_torque_W, …)."""
        return read_csv(self.path / "series.csv", "a case with 'output: {series: {every_s: 0.01}}'")

    @property
    def frames(self) -> Frames:
        return Frames(self.path / "frames.h5")

    @property
    def tracks(self) -> Tracks:
        return open_tracks(self.path / "tracks.h5")

    @property
    def case(self) -> Case:
        """The case as it was run, every default written out."""
        return load_case(self.path / "case.resolved.yaml")

    @property
    def power(self) -> pandas.DataFrame:
        """Rows torque, com and dissipation: power_W and its standard error sem_W. In a steady mill they are equal.

        Of beads that another program moved only the rows that it tells.

        Error where the window was too short for means.
        """
        if "power_W" not in self.summary:
            raise Error(f"{self.path}: has no means: {self.summary.get('steady_reason', 'its window is too short')}; run longer (time.end_s)")
        means = self.summary["power_W"]
        ways = [name for name in means if not name.endswith("_sem")]
        return pandas.DataFrame({"power_W": [means[way] for way in ways], "sem_W": [means[way + "_sem"] for way in ways]}, index=ways, dtype=float)

    @property
    def doubts(self) -> pandas.DataFrame:
        """What the run gives cause to doubt, a row each; no rows: nothing."""
        columns = ["name", "of", "value", "limit", "unit", "finding", "may_change", "remedy"]
        return pandas.DataFrame(self.summary["doubts"], columns=columns)

    def __repr__(self) -> str:
        return f"Run('{self.path}')"


def open_run(path: PathLike) -> Run:
    """A directory of `millscope run`, also one whose run is going on. Raises Error where it is none."""
    return Run(path)
