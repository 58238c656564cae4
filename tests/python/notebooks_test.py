"""The notebooks of examples/ run from beginning to end, in a kernel of Jupyter."""

import pathlib
import sys
import tempfile
import unittest

from support import ROOT, SKIPPED

try:
    import ipykernel  # noqa: F401
    import matplotlib  # noqa: F401
    import nbclient
    import nbformat
except ImportError as error:
    print(f"skipped: {error} (python3-nbclient, python3-ipykernel, python3-matplotlib)")
    sys.exit(SKIPPED)


def run(path):
    """The notebook with the outputs of its cells; raises CellExecutionError where one fails."""
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3",
                            resources={"metadata": {"path": str(path.parent)}}).execute()
    return notebook


def outputs(notebook):
    return [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]


class Notebooks(unittest.TestCase):

    def test_each_runs_and_draws_a_picture(self):
        paths = sorted((ROOT / "examples").glob("*.ipynb"))
        self.assertEqual([path.name for path in paths], ["first_frame.ipynb", "fog.ipynb"])
        for path in paths:
            with self.subTest(path.name):
                made = outputs(run(path))
                self.assertEqual(sum("image/png" in output.get("data", {}) for output in made), 1)
                self.assertFalse([output for output in made if output.get("name") == "stderr"])

    def test_they_are_kept_without_outputs(self):
        for path in sorted((ROOT / "examples").glob("*.ipynb")):
            self.assertEqual(outputs(nbformat.read(path, as_version=4)), [], path.name)

    def test_a_failing_cell_fails(self):
        broken = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("raise ValueError")])
        path = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory())) / "broken.ipynb"
        nbformat.write(broken, path)
        with self.assertRaises(nbclient.exceptions.CellExecutionError):
            run(path)


if __name__ == "__main__":
    unittest.main()
