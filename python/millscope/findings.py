"""What compare, calibrate, validate and diagnose found: the JSON file as `.data` (docs/format.md names every key), and tables of it."""

from __future__ import annotations

from typing import Any

import pandas

from .files import PathLike, existing, read_csv, read_json


class _Finding:
    FILE = COMES_FROM = ""

    def __init__(self, path: PathLike):
        """`path`: the directory that the command wrote."""
        self.path = existing(path, self.COMES_FROM)
        self.data: dict[str, Any] = read_json(self.path / self.FILE, self.COMES_FROM)

    def __repr__(self) -> str:
        return f"{type(self).__name__}('{self.path}')"


class _Judged(_Finding):
    @property
    def verdict(self) -> str:
        return self.data["verdict"]

    @property
    def sentence(self) -> str:
        """The verdict in words."""
        return self.data["sentence"]


class Comparison(_Judged):
    """What differs between two analyses, B less A. `verdict`: 'no_difference', 'differ' or 'cannot_tell'; `sentence`: in words."""

    FILE, COMES_FROM = "comparison.json", "millscope compare A B -o OUT"

    @property
    def notes(self) -> list[str]:
        return self.data["notes"]

    @property
    def observables(self) -> pandas.DataFrame:
        """The ranked table, a row per observable; a, b, difference, error, low and high are in the row's `unit`."""
        return read_csv(self.path / "observables.csv", self.COMES_FROM)

    @property
    def elements(self) -> pandas.DataFrame:
        """Every judged number, bin, cell and region, in the row's `unit`."""
        return read_csv(self.path / "elements.csv", self.COMES_FROM)


class Calibration(_Finding):
    """The parameters with which simulations look like the recordings, in SI."""

    FILE, COMES_FROM = "calibration.json", "millscope calibrate STUDY.yaml -o OUT"

    @property
    def parameters(self) -> pandas.DataFrame:
        """A row per parameter, by name: value, low90, high90 (NaN where there was no posterior), determined, path. SI."""
        rows = {p["name"]: {"value": p["value"], **{key: p.get("posterior", {}).get(key) for key in ("low90", "high90", "determined")}, "path": p["path"]}
                for p in self.data["parameters"]}
        return pandas.DataFrame.from_dict(rows, orient="index", columns=["value", "low90", "high90", "determined", "path"])

    @property
    def runs(self) -> pandas.DataFrame:
        """runs.csv: a row per trial; the units stand in the names of the columns."""
        return read_csv(self.path / "runs.csv", self.COMES_FROM)


class Validation(_Finding):
    """A calibrated set held against recordings that were not fitted."""

    FILE, COMES_FROM = "validation.json", "millscope validate STUDY.yaml --calibration calibration.json -o OUT"

    @property
    def passed(self) -> bool:
        """Every number one by one, in each condition all of them at once, and no simulation failed."""
        return bool(self.data["pass"])

    @property
    def at_once(self) -> pandas.DataFrame:
        """A row per simulated condition, for all its numbers at once: condition, numbers, misfit, p, pass."""
        rows = [{"condition": condition, "numbers": len(found.get("observables", [])), **{key: found[key] for key in ("misfit", "p", "pass")}}
                for condition, found in self.data["conditions"].items() if "failed" not in found]
        return pandas.DataFrame(rows, columns=["condition", "numbers", "misfit", "p", "pass"])

    @property
    def judgements(self) -> pandas.DataFrame:
        """A row per number: condition, name, recorded, simulated, difference, error, low90, high90 (in the row's `unit`), p, pass."""
        rows = [{"condition": condition, **judgement} for condition, found in self.data["conditions"].items() for judgement in found.get("observables", [])]
        columns = ["condition", "name", "unit", "recorded", "simulated", "difference", "error", "low90", "high90", "p", "pass"]
        return pandas.DataFrame(rows, columns=columns)


class Diagnosis(_Judged):
    """Which physics a base case left out. `verdict`: 'no_mismatch', 'named', 'ambiguous', 'outside_library' or 'undetectable'."""

    FILE, COMES_FROM = "diagnosis.json", "millscope diagnose STUDY.yaml -o OUT"

    @property
    def named(self) -> list[str]:
        return self.data["named"]

    @property
    def hypotheses(self) -> pandas.DataFrame:
        """A row per candidate, by name: kind, class, p_value, delta_q, kappa, lambda, undetectable; all without unit."""
        columns = ["kind", "class", "p_value", "delta_q", "kappa", "lambda", "undetectable"]
        rows = {h["name"]: {column: h.get(column) for column in columns} for h in self.data["hypotheses"]}
        return pandas.DataFrame.from_dict(rows, orient="index", columns=columns)

    @property
    def strengths(self) -> pandas.DataFrame:
        """How much of each candidate there is: hypothesis, parameter, value, low90, high90 in the row's `unit`."""
        rows = [{"hypothesis": h["name"], "parameter": name, **interval} for h in self.data["hypotheses"] for name, interval in h.get("parameters", {}).items()]
        return pandas.DataFrame(rows, columns=["hypothesis", "parameter", "value", "low90", "high90", "unit"])

    @property
    def contact_parameters(self) -> pandas.DataFrame:
        """θ, SI: fit ('retuned': the base; 'unmasked': with the best candidate), parameter, value, low90, high90."""
        rows = [{"fit": fit, "parameter": name, **interval} for fit, found in self.data["contact_parameters"].items() for name, interval in found.items()]
        return pandas.DataFrame(rows, columns=["fit", "parameter", "value", "low90", "high90"])

    @property
    def mismatch(self) -> pandas.DataFrame:
        """Every number beside what the retuned base gives, the farthest first: condition, observable, z (standard deviations), p_value."""
        return pandas.DataFrame(self.data["mismatch"], columns=["condition", "observable", "z", "p_value", "sentence"])

    @property
    def held_out(self) -> pandas.DataFrame:
        """How each model does on conditions that were not fitted: condition, model, misfit, power_W, power_percent, simulated."""
        rows = [{"condition": found["condition"], **model} for found in self.data["held_out"] for model in found["models"]]
        return pandas.DataFrame(rows, columns=["condition", "model", "misfit", "power_W", "power_percent", "simulated"])


def open_comparison(path: PathLike) -> Comparison:
    """A directory of `millscope compare`. Error where it is none."""
    return Comparison(path)


def open_calibration(path: PathLike) -> Calibration:
    """A directory of `millscope calibrate`. Error where it is none."""
    return Calibration(path)


def open_validation(path: PathLike) -> Validation:
    """A directory of `millscope validate`. Error where it is none."""
    return Validation(path)


def open_diagnosis(path: PathLike) -> Diagnosis:
    """A directory of `millscope diagnose`. Error where it is none."""
    return Diagnosis(path)
