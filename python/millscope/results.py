"""A directory of `millscope analyze`: results.h5, every value with its uncertainty."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import Any, Iterator

import h5py
import numpy
import pandas

from .errors import Error, UnknownName
from .files import PathLike, existing, open_hdf5
from .units import suffix, with_unit

COMES_FROM = "millscope analyze SOURCE -o OUT"
DOUBTS = {1: "few blocks", 2: "correlated blocks", 4: "often undefined", 8: "no uncertainty"}  # docs/analysis.md says what they mean


def _place(name: str) -> str:
    """Of a result in results.h5."""
    return "analyzers/" + name.replace(".", "/", 1)


class Result:
    """One result: a number, a curve or a map.

    value: array of the result's shape (shape () for a number); NaN: undefined. sem, low, high: standard error and 90 % interval, of
    the same shape; NaN without uncertainty, None for an axis, which is exact. effective_blocks: independent blocks behind each value.
    flags: bits, see `doubts`. unit, doc: texts. axes: for each dimension the Result with its edges or centres, or None for a count.
    """

    def __init__(self, name: str, group: h5py.Group, axes: list[Result | None]):
        def read(item: str) -> numpy.ndarray | None:
            return numpy.asarray(group[item][()]) if item in group else None

        self.name, self.axes = name, axes
        self.unit, self.doc = str(group.attrs["unit"]), str(group.attrs["doc"])
        self.is_axis = bool(group.attrs["is_axis"])
        self.value = numpy.asarray(group["value"][()])
        self.sem, self.low, self.high = read("sem"), read("low"), read("high")
        self.effective_blocks, self.flags = read("effective_blocks"), read("flags")
        self._file = group.file.filename

    @property
    def draws(self) -> numpy.ndarray:
        """[K, the result's shape]: resamples less `value`. Draw k of every result comes from the same blocks, so functions of several
        results have an error, too. All are widened alike for the memory of blocks, `sem` for that of its own value. Error where there are none (one block, or more than 50 000 values)."""
        with open_hdf5(self._file, "millscope results", COMES_FROM) as file:
            group = file[_place(self.name)]
            if "draws" not in group:
                raise Error(f"{self._file}: {self.name} has no draws: it is an axis, has more than 50000 values, or the data are one block")
            return group["draws"][:]

    def doubts(self) -> list[str]:
        """What is doubtful of any of its values, in words."""
        bits = int(numpy.bitwise_or.reduce(self.flags, axis=None)) if self.flags is not None and self.flags.size else 0
        return [text for bit, text in DOUBTS.items() if bits & bit]

    def table(self) -> pandas.DataFrame:
        """A row per value: where it is (X_from, X_to for cells, X for points, index_0 for a count), the value, its sem, low, high.
        Each name ends with its unit."""
        short = self.name.partition(".")[2]
        places = {}
        index = numpy.indices(self.value.shape)
        for dimension, axis in enumerate(self.axes):
            places.update(_places(dimension, axis, index[dimension].ravel(), self.value.shape[dimension]))
        values, stem = {with_unit(short, self.unit): self.value.ravel()}, short.removesuffix("_" + suffix(self.unit))
        for word in ("sem", "low", "high"):
            if getattr(self, word) is not None:
                values[with_unit(f"{stem}_{word}", self.unit)] = getattr(self, word).ravel()
        return pandas.DataFrame({**places, **values})

    def __repr__(self) -> str:
        if self.value.ndim:
            return f"Result('{self.name}', shape={self.value.shape}, unit='{self.unit}')"
        sem = "" if self.sem is None or numpy.isnan(self.sem) else f" ± {self.sem:.2g}"
        return f"Result('{self.name}', {self.value:.5g}{sem} {self.unit})"


def _places(dimension: int, axis: Result | None, rows: numpy.ndarray, count: int) -> dict[str, numpy.ndarray]:
    if axis is None:
        return {f"index_{dimension}": rows}
    word = axis.name.partition(".")[2].removesuffix("_" + suffix(axis.unit)).removesuffix("_edges")
    if len(axis.value) == count + 1:
        return {with_unit(f"{word}_from", axis.unit): axis.value[rows], with_unit(f"{word}_to", axis.unit): axis.value[rows + 1]}
    return {with_unit(word, axis.unit): axis.value[rows]}


class Analysis(Mapping[str, Result]):
    """Results by name, `analysis["power.power_gravity"]`: the analyzer, a point, the result."""

    def __init__(self, path: PathLike):
        self.path = existing(path, COMES_FROM)
        self.file = self.path / "results.h5" if self.path.is_dir() else self.path
        with self._open() as file:
            groups = [(int(group.attrs["order"]), f"{analyzer}.{name}") for analyzer, results in file["analyzers"].items() for name, group in results.items()]
        self._names = dict.fromkeys(name for _, name in sorted(groups))

    def _open(self) -> h5py.File:
        return open_hdf5(self.file, "millscope results", COMES_FROM)

    def __getitem__(self, name: str) -> Result:
        if name not in self._names:
            analyzer, _, short = name.rpartition(".")
            near = sorted((known for known in self._names if short in known), key=lambda known: not known.startswith(analyzer))
            raise UnknownName(f"{self.file}: there is no result '{name}'; " + (f"near it: {', '.join(near[:5])}" if near else "list(analysis) has all names"))
        with self._open() as file:
            return self._read(file, name)

    def _read(self, file: h5py.File, name: str) -> Result:
        group, analyzer = file[_place(name)], name.partition(".")[0]
        axes = [self._read(file, f"{analyzer}.{axis}") if axis else None for axis in map(str, group.attrs.get("axes", []))]
        return Result(name, group, axes)

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    @cached_property
    def meta(self) -> dict[str, Any]:
        """Source, description, context of the mill, settings, inputs and plugins with their hashes, notes, what was left out."""
        with self._open() as file:
            text = file["meta"][()]
        return json.loads(text)

    @property
    def notes(self) -> list[str]:
        """What `analyze` had to say beside the numbers."""
        return list(self.meta.get("notes", []))

    def numbers(self) -> pandas.DataFrame:
        """All single numbers, a row each, by name: value, sem, low, high (90 % interval), unit, effective_blocks, doubts."""
        with self._open() as file:
            found = [self._read(file, name) for name in self._names if file[_place(name) + "/value"].shape == ()]
        rows = {r.name: {"value": float(r.value), **{word: _number(getattr(r, word)) for word in ("sem", "low", "high")}, "unit": r.unit,
                         "effective_blocks": _number(r.effective_blocks), "doubts": ", ".join(r.doubts())} for r in found}
        return pandas.DataFrame.from_dict(rows, orient="index", columns=["value", "sem", "low", "high", "unit", "effective_blocks", "doubts"])

    def covariance(self) -> pandas.DataFrame:
        """[E, E] of all numbers and short curves, each in its own unit, by name (`A.R` or `A.R[i]`)."""
        with self._open() as file:
            names = [str(name) for name in file["covariance"].attrs["names"]]
            return pandas.DataFrame(file["covariance/matrix"][:], names, names)

    def __repr__(self) -> str:
        return f"Analysis('{self.path}', {len(self)} results)"


def _number(value: numpy.ndarray | None) -> float:
    return numpy.nan if value is None else float(value)


def open_analysis(path: PathLike) -> Analysis:
    """A directory of `millscope analyze`, or its results.h5. Raises Error where it is none."""
    return Analysis(path)
