"""Opening what millscope wrote, and saying in one line what is wrong with it."""

from __future__ import annotations

import contextlib
import json
import os
from pathlib import Path
from typing import Any, Iterator, Union

import h5py
import pandas

from .errors import Error

PathLike = Union[str, "os.PathLike[str]"]
VERSIONS = {"millscope frames": 1, "millscope tracks": 1, "millscope results": 2}  # docs/format.md


def existing(path: PathLike, comes_from: str) -> Path:
    """The path, if there is such a file; Error that names the command it comes from otherwise."""
    path = Path(path)
    if not path.exists():
        raise Error(f"there is no {path}; it comes from: {comes_from}")
    return path


def open_hdf5(path: PathLike, kind: str, comes_from: str) -> h5py.File:
    """An HDF5 file of millscope, open for reading, also while a run still writes it. `kind`: its attribute `format`."""
    path = existing(path, comes_from)
    try:
        file = _open(path)
    except OSError as reason:
        raise Error(f"{path}: cannot be opened as HDF5 ({reason}); take a file that millscope wrote") from reason
    written, version = file.attrs.get("format"), file.attrs.get("schema_version")
    if written == kind and version == VERSIONS[kind]:
        return file
    file.close()
    if written != kind:
        raise Error(f"{path}: its format is '{written}', not '{kind}'; take a file from: {comes_from}")
    raise Error(f"{path}: is of schema version {version}, this package reads {VERSIONS[kind]}; write it again with the millscope of this package")


def _open(path: Path) -> h5py.File:
    try:
        return h5py.File(path, "r", swmr=True)  # frames.h5, tracks.h5 of a run that may be going on
    except (OSError, ValueError):
        return h5py.File(path, "r")  # written whole: HDF5 gives these no readers beside a writer


def read_json(path: PathLike, comes_from: str) -> dict[str, Any]:
    path = existing(path, comes_from)
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except ValueError as reason:
        raise Error(f"{path}: is no JSON ({reason}); write it again: {comes_from}") from reason


def read_csv(path: PathLike, comes_from: str) -> pandas.DataFrame:
    """A table, its numbers to the last bit; an empty cell of a column of words is ''."""
    path = existing(path, comes_from)
    try:
        table = pandas.read_csv(path, float_precision="round_trip")
    except ValueError as reason:  # pandas' own errors are ValueErrors
        raise Error(f"{path}: is no table ({reason}); write it again: {comes_from}") from reason
    words = table.select_dtypes(object).columns
    table[words] = table[words].fillna("")
    return table


def path_of(thing: Any) -> str:
    """The path of a Run, a Recording or an Analysis, or what is a path already."""
    return os.fspath(getattr(thing, "path", thing))


@contextlib.contextmanager
def written(path: PathLike, force: bool) -> Iterator[Path]:
    """A name beside `path` to write to; what is whole is renamed, what fails is removed, so that nothing half-written is left."""
    path = Path(path)
    if path.exists() and not force:
        raise Error(f"{path} is there already; take another name, or force=True to replace it")
    beside = path.with_name(path.name + ".tmp")
    try:
        yield beside
        os.replace(beside, path)
    except OSError as reason:
        why = reason.strerror or str(reason)
        raise Error(f"{path} cannot be written ({why}); check that its folder is there and may be written, and the room on its disk") from reason
    finally:
        beside.unlink(missing_ok=True)
