"""tracks.h5: single beads that a run followed, or a recording, in one layout."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Iterator

import h5py
import numpy
import pandas

from .errors import UnknownName
from .files import PathLike, open_hdf5

COMES_FROM = "millscope run with 'output: {tracks: {beads: 3}}', or millscope pept convert RECORDING -o tracks.h5"


@dataclass(frozen=True)
class Track:
    """One bead's way. time_s: [n], increasing; position_m: [n, 3], x, y, z; diameter and density: NaN where they are unknown."""

    name: str
    time_s: numpy.ndarray
    position_m: numpy.ndarray
    bead: int = 0
    diameter_m: float = numpy.nan
    density_kg_per_m3: float = numpy.nan
    source: str = ""

    def table(self) -> pandas.DataFrame:
        """n rows of time_s, x_m, y_m, z_m."""
        return pandas.DataFrame({"time_s": self.time_s, **{f"{axis}_m": self.position_m[:, k] for k, axis in enumerate("xyz")}})


class Tracks(Mapping[str, Track]):
    """Tracks by name: `tracks["bead_42"]`, `for name in tracks`, `len(tracks)`."""

    def __init__(self, tracks: Mapping[str, Track]):
        self._tracks = dict(tracks)

    def __getitem__(self, name: str) -> Track:
        try:
            return self._tracks[name]
        except KeyError:
            raise UnknownName(f"there is no track '{name}'; there are: {', '.join(self._tracks) or 'none'}") from None

    def __contains__(self, name: object) -> bool:
        return name in self._tracks

    def __iter__(self) -> Iterator[str]:
        return iter(self._tracks)

    def __len__(self) -> int:
        return len(self._tracks)

    def table(self) -> pandas.DataFrame:
        """All points of all tracks, one after the other: track, time_s, x_m, y_m, z_m."""
        parts = [track.table().assign(track=name)[["track", "time_s", "x_m", "y_m", "z_m"]] for name, track in self.items()]
        return pandas.concat(parts, ignore_index=True) if parts else pandas.DataFrame(columns=["track", "time_s", "x_m", "y_m", "z_m"])

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}: {len(track.time_s)} points' for name, track in self.items())})"


def _track(name: str, group: h5py.Group) -> Track:
    time = group["t"][:]
    count = min(len(time), len(group["position"]))  # what `t` lists is complete
    known = {key: group.attrs[key] for key in ("bead", "diameter", "density", "source") if key in group.attrs}
    return Track(name, time[:count], group["position"][:count], int(known.get("bead", 0)), float(known.get("diameter", numpy.nan)),
                 float(known.get("density", numpy.nan)), str(known.get("source", "")))


def open_tracks(path: PathLike) -> Tracks:
    """Reads a tracks.h5 whole. Raises Error where it is not there or is another file."""
    with open_hdf5(path, "millscope tracks", COMES_FROM) as file:
        return Tracks({name: _track(name, group) for name, group in file.items()})
