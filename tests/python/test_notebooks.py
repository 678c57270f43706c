"""The notebooks of examples/notebooks run from the first cell to the last, and draw what they say."""
import json
import os
import subprocess
import sys
import unittest

from support import PACKAGE, PATIENCE, SOURCE, FolderTest, needs

NOTEBOOKS = SOURCE / "examples/notebooks"


class Notebook(FolderTest):
    def execute(self, name):
        """The cells of an executed copy; what fails in a cell ends nbconvert with that cell's own error."""
        environment = {**os.environ, "PYTHONPATH": str(PACKAGE), "PYTHONDONTWRITEBYTECODE": "1", "TMPDIR": str(self.folder)}
        done = subprocess.run([sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--ExecutePreprocessor.kernel_name=python3",
                               f"--ExecutePreprocessor.timeout={max(900, PATIENCE):.0f}", "--output-dir", self.folder, NOTEBOOKS / name], env=environment, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr[-3000:])
        return json.loads((self.folder / name).read_text(encoding="utf-8"))["cells"]

    def check(self, name, pictures, *words):
        cells = self.execute(name)
        outputs = [output for cell in cells for output in cell.get("outputs", [])]
        self.assertEqual(sum("image/png" in output.get("data", {}) for output in outputs), pictures)
        text = "".join("".join(output.get("text", output.get("data", {}).get("text/plain", ""))) for output in outputs)
        for word in words:
            self.assertRegex(text, word)

    def check_empty(self, name):
        """In the repository no outputs stand: they would differ with every machine."""
        for cell in json.loads((NOTEBOOKS / name).read_text(encoding="utf-8"))["cells"]:
            self.assertFalse(cell.get("outputs"), cell["source"])
            self.assertIsNone(cell.get("execution_count"))


needed = needs("python3-h5py", "python3-pandas", "python3-yaml", "python3-matplotlib", "python3-nbconvert", "python3-ipykernel")


@needed
class FirstMill(Notebook):
    def test_it_runs(self):
        self.check_empty("1_first_mill.ipynb")
        self.check("1_first_mill.ipynb", 3, r"dissipation +0\.3", r"500 frames of 591 beads", r"power\.power_gravity +0\.3", r"first\.html")


@needed
class Recording(Notebook):
    def test_it_runs(self):
        self.check_empty("2_a_recording.ipynb")
        self.check("2_a_recording.ipynb", 2, r"turns counter_clockwise|turns counter-clockwise", r"bead_6: 1\d\d\d points", r"(?s)largest difference.*largest difference")


@needed
class SimulationAndRecording(Notebook):
    def test_it_runs(self):
        self.check_empty("3_simulation_and_recording.ipynb")
        self.check("3_simulation_and_recording.ipynb", 2, r"[1-9]\d* of \d+ observables differ", r"(charge_features|circulation|mean_acceleration|pept_grid)\.\w+")


del Notebook  # no test of its own

if __name__ == "__main__":
    unittest.main()
