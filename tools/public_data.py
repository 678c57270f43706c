"""Where data that are not ours are looked for."""

import os
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DATA = Path(os.environ.get("MILLSCOPE_DATA") or ROOT.parent / "shared" / "public_cases" / "data")
