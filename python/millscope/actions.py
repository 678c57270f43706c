"""Commands as functions. Each calls `millscope`, shows how far it is, and returns what the command left; Error has its line if it fails.

`options`: further words of the command line, e.g. `options=["--engine", "liggghts"]`; `millscope COMMAND --help` has them all.
`settings`: what --set takes, `{"mill.speed": "60 %critical", "time.end_s": 4}`. `force=True` replaces what is there.
`progress`: True shows the command's lines on stderr, a function is called with each of them, False shows nothing.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Iterable, Mapping, Sequence, Union

from .cases import text_of, write_case
from .command import Progress, call, tell
from .errors import Error
from .files import PathLike, path_of
from .findings import Calibration, Comparison, Diagnosis
from .results import Analysis
from .runs import Run

Source = Union[PathLike, Run, Analysis, Any]
OURS = "# Written by millscope's Python package for the run beside it; the next one of that name replaces it.\n"


def _set(settings: Mapping[str, Any] | None) -> list[str]:
    return [word for path, value in (settings or {}).items() for word in ("--set", f"{path}={text_of(value, inline=True)}")]


def _named(**options: Any) -> list[object]:
    """Options that are given: --name value, or --name alone for True."""
    words: list[object] = []
    for name, value in options.items():
        if value is not None and value is not False:
            words += ["--" + name.replace("_", "-")] + ([] if value is True else [value])
    return words


def _case_file(case: PathLike | Mapping[str, Any], out: Path) -> Path:
    """The file of a case; a dictionary is written beside `out`, where it can be looked at and run again."""
    if not isinstance(case, Mapping):
        return Path(case)
    path = out.with_name(out.name + ".yaml")
    if path.exists() and not path.read_text(encoding="utf-8", errors="replace").startswith(OURS):
        raise Error(f"{path} is there already and was not written here; save the case with save_case under another name, and run that file")
    return write_case(case, path, force=True, head=OURS)


def run(case: PathLike | Mapping[str, Any], out: PathLike, *, settings: Mapping[str, Any] | None = None, threads: int | None = None,
        force: bool = False, options: Sequence[object] = (), progress: Progress = True) -> Run:
    """`millscope run`: simulates a case, a file or a dictionary, into the new directory `out`.

    A dictionary is written to OUT.yaml first, and that file is run.
    """
    out = Path(out)
    printed = call("run", _case_file(case, out), "-o", out, *_named(threads=threads, force=force), *_set(settings), *options, progress=progress)
    tell(printed, progress)  # where the results are, and what there is to doubt
    return Run(out)


def analyze(source: Source, out: PathLike, *, settings: Mapping[str, Any] | None = None, analyzers: Iterable[str] | None = None,
            tracer: Iterable[int] | str | None = None, from_s: float | None = None, to_s: float | None = None, pictures: bool = True,
            threads: int | None = None, force: bool = False, options: Sequence[object] = (), progress: Progress = True) -> Analysis:
    """`millscope analyze`: a Run, a Recording or a path of either, through the analyzers, into the directory `out`.

    tracer: ids of beads of tracks.h5, or 'all', to follow in place of the whole charge. from_s, to_s: a span of time, in s.
    """
    beads = tracer if tracer is None or isinstance(tracer, str) else ",".join(map(str, tracer))
    words = _named(analyzers=",".join(analyzers) if analyzers else None, tracer=beads, to=to_s, threads=threads, force=force,
                   no_pictures=not pictures, **{"from": from_s})
    call("analyze", _source(source), "-o", out, *words, *_set(settings), *options, progress=progress)
    return Analysis(out)


def _source(source: Source) -> str:
    if getattr(source, "path", source) is None:
        raise Error("this recording came from memory and has no file; write it with write_pept and analyze that file")
    return path_of(source)


def compare(a: Source, b: Source, out: PathLike, *, only: Iterable[str] = (), without: Iterable[str] = (), level_percent: float | None = None,
            force: bool = False, options: Sequence[object] = (), progress: Progress = True) -> Comparison:
    """`millscope compare`: what differs between two analyses, b less a, with one error rate for everything (5 %)."""
    names = [word for option, values in (("--only", only), ("--without", without)) for name in values for word in (option, name)]
    call("compare", path_of(a), path_of(b), "-o", out, *names, *_named(level=level_percent, force=force), *options, progress=progress)
    return Comparison(out)


def calibrate(study: PathLike, out: PathLike, *, settings: Mapping[str, Any] | None = None, cache: PathLike | None = None,
              slots: int | None = None, options: Sequence[object] = (), progress: Progress = True) -> Calibration:
    """`millscope calibrate`: contact parameters from recordings. Called again, it goes on where it stopped."""
    call("calibrate", study, "-o", out, *_named(cache=cache, slots=slots), *_set(settings), *options, progress=progress)
    return Calibration(out)


def diagnose(study: PathLike, out: PathLike, *, settings: Mapping[str, Any] | None = None, cache: PathLike | None = None,
             slots: int | None = None, options: Sequence[object] = (), progress: Progress = True) -> Diagnosis:
    """`millscope diagnose`: which physics a base case left out. Called again, it goes on where it stopped and computes nothing twice."""
    call("diagnose", study, "-o", out, *_named(cache=cache, slots=slots), *_set(settings), *options, progress=progress)
    return Diagnosis(out)


def report(outs: Iterable[Source], page: PathLike, *, title: str | None = None, force: bool = False, options: Sequence[object] = (),
           progress: Progress = True) -> Path:
    """`millscope report`: one HTML page of everything that was found; returns its path."""
    call("report", *map(path_of, outs), "-o", page, *_named(title=title, force=force), *options, progress=progress)
    return Path(page)


def inspect(recording: PathLike) -> dict[str, Any]:
    """`millscope pept inspect --json`: how good a recording is, where its mill stands and turns; units are in the names of the keys."""
    return json.loads(call("pept", "inspect", path_of(recording), "--json"))


def synthesize(run: Source, out: PathLike, *, camera: PathLike | None = None, like: PathLike | None = None, bead: int | None = None,
               seed: int | None = None, settings: Mapping[str, Any] | None = None, force: bool = False, options: Sequence[object] = (),
               progress: Progress = True) -> Path:
    """`millscope pept synthesize`: what a camera would have recorded of the beads that a run followed. `out` ends with .a.

    camera: a camera file; like: a recording whose camera is taken. Returns the path of the recording.yaml that was written.
    """
    call("pept", "synthesize", path_of(run), "-o", out, *_named(camera=camera, like=like, bead=bead, seed=seed, force=force), *_set(settings),
         *options, progress=progress)
    return Path(out).with_suffix(".yaml")
