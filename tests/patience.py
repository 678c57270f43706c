"""How a test waits for what another process does."""
import os
import pathlib

# A test waits so long for what takes a moment on a free machine; under a sanitizer longer (CMakePresets.json).
PATIENCE = float(os.environ.get("MILLSCOPE_PATIENCE", 240))  # s


def files_below(folder, pattern):
    """Files whose path ends as `pattern` says, while another process makes, renames and removes folders there.

    Path.rglob fails where a folder goes away between being listed and being opened.
    """
    return [path for at, _, names in os.walk(folder) for path in (pathlib.Path(at) / name for name in names) if path.match(pattern)]
