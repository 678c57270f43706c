"""To and from the Python package `pept` (Birmingham): columns t x y z error label, t in ms, lengths in mm.

Read from its sources, version 0.5.2 (pept/base/point_data.py): PointData has `points` [n, 4 or more], the first four columns t, x, y, z,
and `columns`; its to_csv writes them with blanks below a line `# t x y z error`. `pept` itself is not needed here.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any, Mapping

import numpy
import pandas

from .errors import Error
from .files import PathLike, written
from .recordings import Recording, read
from .tracks import Track

UNITS = {"t": "ms", "x": "mm", "y": "mm", "z": "mm", "error": "mm", "label": "1"}


def to_pept(tracks: Mapping[str, Track], error_mm: float | None = None) -> pandas.DataFrame:
    """All points as rows of t (ms), x, y, z (mm), error (mm, where `error_mm` is given) and label (0, 1, …: the tracks in order).

    The names are those that pept asks for, without units; these stand in `.attrs["units"]`. With pept:
    `pept.PointData(table.to_numpy(), columns=list(table.columns))`.
    """
    parts = []
    for label, track in enumerate(tracks.values()):
        columns = {"t": 1e3 * track.time_s, **{axis: 1e3 * track.position_m[:, k] for k, axis in enumerate("xyz")}}
        if error_mm is not None:
            columns["error"] = numpy.full(len(track.time_s), float(error_mm))
        parts.append(pandas.DataFrame({**columns, "label": float(label)}))
    if not parts:
        raise Error("there are no tracks to write; give the tracks of a run or a recording")
    table = pandas.concat(parts, ignore_index=True)
    table.attrs["units"] = {column: UNITS[column] for column in table.columns}
    return table


def write_pept(tracks: Mapping[str, Track], path: PathLike, error_mm: float | None = None, force: bool = False) -> Path:
    """Writes what `to_pept` gives as pept's `PointData.to_csv` does; `millscope` reads such a file as a recording, too.

    With pept: `pept.read_csv(path, skiprows=1)`, for it does not know the line of heads.
    """
    table = to_pept(tracks, error_mm)
    with written(path, force) as beside:
        numpy.savetxt(beside, table.to_numpy(), header=" ".join(table.columns))
    return Path(path)


def from_pept(points: Any, columns: list[str] | None = None) -> Recording:
    """A Recording from a pept.PointData, a DataFrame or an array with `columns`; a file of to_csv goes to `open_recording`.

    t, x, y, z are needed (ms, mm); error and label are used where they are there, other columns are not. An error column with values
    that are not finite is left out, so that its rows stay. Raises Error where columns lack, and with the program's line where the
    points are no recording (docs/recordings.md#what-happens-to-the-rows).
    """
    if isinstance(points, pandas.DataFrame):
        columns, array = [str(column) for column in points.columns], points.to_numpy(float)
    else:
        columns = list(columns if columns is not None else getattr(points, "columns", ["t", "x", "y", "z"]))
        array = numpy.asarray(getattr(points, "points", points), float)
    if array.ndim != 2 or array.shape[1] != len(columns):
        raise Error(f"the points have shape {array.shape} and {len(columns)} columns are named; give one name for each column")
    missing = [name for name in "txyz" if name not in columns]
    if missing:
        raise Error(f"the points have no column {', '.join(missing)}; there are: {', '.join(columns)}")
    chosen = [name for name in UNITS if name in columns]
    if "error" in chosen and not numpy.isfinite(array[:, columns.index("error")]).all():
        chosen.remove("error")
    with tempfile.TemporaryDirectory(prefix="millscope-") as folder:
        path = Path(folder) / "points.csv"
        formats = ["%d" if name == "label" else "%.17g" for name in chosen]
        numpy.savetxt(path, array[:, [columns.index(name) for name in chosen]], fmt=formats, header=" ".join(chosen))
        try:
            return read(path, None)
        except Error as reason:  # its line names a file that is gone by then
            raise Error(str(reason).replace(str(path), "the points"), reason.exit_code, reason.command) from None
