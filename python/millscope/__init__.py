"""millscope from Python: runs, recordings and results as arrays and tables, cases as dictionaries, and the commands as functions.

    import millscope
    run = millscope.run("case.yaml", "first", settings={"time.end_s": 4})
    run.series.plot("time_s", "power_com_W")
    analysis = millscope.analyze(run, "first-maps")
    speed = analysis["pept_grid.speed"]              # .value, .sem, .low, .high: arrays; .unit: 'm/s'

Units: the name of a column or an array ends with its unit (`time_s`, `position_m`, `velocity_m_per_s`). Where one name stands for
numbers of several units, there is an attribute or a column `unit` beside it. All is SI but what says otherwise.

The computing is done by the command `millscope`: the one that MILLSCOPE names, else the one on PATH.
"""

from .actions import analyze, calibrate, compare, diagnose, inspect, report, run, synthesize
from .cases import Case, load_case, save_case
from .command import call
from .errors import Error
from .findings import (Calibration, Comparison, Diagnosis, Validation, open_calibration, open_comparison, open_diagnosis, open_validation)
from .pept_layout import from_pept, to_pept, write_pept
from .recordings import Recording, open_recording
from .results import Analysis, Result, open_analysis
from .runs import Frames, Run, open_run
from .tracks import Track, Tracks, open_tracks
from .up4_layout import read_up4, write_up4, write_up4_csv

__all__ = [
    "Analysis", "Calibration", "Case", "Comparison", "Diagnosis", "Error", "Frames", "Recording", "Result", "Run", "Track", "Tracks", "Validation",
    "analyze", "calibrate", "call", "compare", "diagnose", "from_pept", "inspect", "load_case", "open_analysis", "open_calibration",
    "open_comparison", "open_diagnosis", "open_recording", "open_run", "open_tracks", "open_validation", "read_up4", "report", "run",
    "save_case", "synthesize", "to_pept", "write_pept", "write_up4", "write_up4_csv",
]
