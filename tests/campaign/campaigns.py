"""What the tests of the command `campaign` share: a small case, a list of simulations, a look into the cache."""
import csv
import fcntl
import json
import os
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from support import CASE, COMMAND, PATIENCE, CliTest, tree_of  # noqa: E402  (what the tests below import from here)

__all__ = ["COMMAND", "PATIENCE", "CampaignTest", "tree_of"]

INTERVAL = 0.1  # s of wall time between checkpoints


class CampaignTest(CliTest):
    """A folder with case.yaml, about 160 beads; a simulated second takes about a second."""

    def setUp(self):
        super().setUp()
        text = CASE.replace("filling: 30 %", "filling: 15 %")
        text = text.replace("  frames: {every_s: 0.01, from_s: 0.02}\n  tracks: {beads: 2, every_s: 0.001}\n  vtk: {every_s: 0.02}\n",
                            f"  checkpoint: {{every_wall_s: {INTERVAL}}}\n")
        self.assertIn("checkpoint", text)
        self.write("case.yaml", text)

    def tasks(self, simulations, end=0.06, name="tasks.yaml"):
        """tasks.yaml from {label: [settings]}."""
        lines = "".join(f"  {label}: {{set: [{', '.join(settings)}]}}\n" for label, settings in simulations.items())
        self.write(name, f"schema_version: 1\ncase: case.yaml\nset: [time.end_s={end}]\nsimulations:\n{lines}")

    def table(self, out="out"):
        with open(self.folder / out / "campaign.csv", newline="", encoding="utf-8") as file:
            return {row["label"]: row for row in csv.DictReader(file)}

    def tasks_of(self, cache):
        """label → (folder, task.json) of every simulation in a cache."""
        found = {}
        for file in sorted((self.folder / cache).glob("*/task.json")):
            task = json.loads(file.read_text(encoding="utf-8"))
            found[task["label"]] = (file.parent, task)
        return found

    def hashes(self, out="out"):
        """label → state_hash, of a campaign in which all is done."""
        table = self.table(out)
        self.assertEqual({row["state"] for row in table.values()}, {"done"}, table)
        return {label: self.run_summary(row["folder"])["state_hash"] for label, row in table.items()}

    def run_summary(self, folder):
        return json.loads((pathlib.Path(folder) / "summary.json").read_text(encoding="utf-8"))

    def wait_until(self, condition, what):
        end = time.monotonic() + PATIENCE
        while not condition():
            self.assertLess(time.monotonic(), end, f"waited in vain until {what}")
            time.sleep(0.01)

    def is_writing(self, run):
        """Whether a process holds this run."""
        try:
            with open(run / ".lock", "r+", encoding="utf-8") as file:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                return False
        except FileNotFoundError:
            return False
        except OSError:
            return True

    def children_of(self, pid):
        """Process numbers of those simulations that a head has started."""
        found = []
        for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
            try:
                fields = stat.read_text(encoding="utf-8", errors="replace").rsplit(")", 1)[1].split()
                words = (stat.parent / "cmdline").read_bytes().split(b"\0")
            except OSError:
                continue
            if int(fields[1]) == pid and b"campaign-task" in words:
                found.append(int(stat.parent.name))
        return found


def environment(**changes):
    return {**os.environ, **changes}
