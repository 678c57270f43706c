"""Recordings as millscope reads them: the rows that it uses, and how many it set aside by which rule (docs/recordings.md)."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import Any

from .command import call
from .files import PathLike
from .tracks import Tracks, open_tracks


class Recording(Tracks):
    """The runs of a recording by name, each a Track with the points that millscope uses, in the file's frame after `axes`.

    path: what was read; None where it came from memory. inspection: what `millscope pept inspect --json` says.
    """

    def __init__(self, tracks: Tracks, inspection: dict[str, Any], path: Path | None):
        super().__init__(tracks)
        self.inspection, self.path = inspection, path

    @property
    def set_aside(self) -> dict[str, int]:
        """Rows that are not used, by the rule that set them aside."""
        return dict(self.inspection["recording"]["rows_set_aside"])


def read(source: PathLike, path: Path | None) -> Recording:
    """Reads through `millscope pept`, so that Python and the program see the same points."""
    with tempfile.TemporaryDirectory(prefix="millscope-") as folder:
        points = Path(folder) / "tracks.h5"
        call("pept", "convert", source, "-o", points)
        tracks = open_tracks(points)
    return Recording(tracks, json.loads(call("pept", "inspect", source, "--json")), path)


def open_recording(path: PathLike) -> Recording:
    """Reads a tracker's file (.a, table, pept's to_csv, each also gzipped), a recording.yaml or a tracks.h5.

    Raises Error with the program's line where it is none, or where its units cannot be meant.
    """
    return read(path, Path(path))
