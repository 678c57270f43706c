"""A small run that the tests of `report` and `watch` share, and the data that a page holds."""
import json
import os
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from patience import PATIENCE  # noqa: E402

COMMAND = os.environ["MILLSCOPE"]
CONFIGS = pathlib.Path(__file__).resolve().parents[2] / "configs"
SMALL = ["--set", "fill.filling=5 %", "--set", "time.end_s=0.3", "--set", "time.analyze_from_s=0.1", "--set", "output.vtk=~", "--set", "output.frames={every_s: 0.02, from_s: 0}"]


def call(folder, *words, code=0):
    done = subprocess.run([COMMAND, *words], cwd=folder, capture_output=True, text=True, timeout=PATIENCE)
    assert done.returncode == code, done.stderr
    return done


def simulate(folder, name="out", *more):
    call(folder, "run", str(CONFIGS / "demo.yaml"), "-o", name, "-q", *SMALL, *more)


def data_of(page):
    text = pathlib.Path(page).read_text()
    found = re.search(r'<script type="application/json" id="millscope-data">(.*?)</script>', text, re.S)
    return json.loads(found.group(1))
