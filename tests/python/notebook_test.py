"""Executes the notebook of the classroom, and compares what it prints with what it shows. `notebook_test.py update` writes the outputs."""
import os
import sys
import unittest

import nbclient
import nbformat

from common import SOURCE

NOTEBOOK = os.path.join(SOURCE, "examples", "python", "classroom.ipynb")


def execute():
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs = []
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3", record_timing=False).execute()
    return notebook


def texts(notebook):
    return ["".join(output.text for output in cell.outputs if output.output_type == "stream")
            for cell in notebook.cells if cell.cell_type == "code"]


def pictures(notebook):
    return [sum("image/svg+xml" in output.get("data", {}) for output in cell.outputs)
            for cell in notebook.cells if cell.cell_type == "code"]


class Notebook(unittest.TestCase):
    def test_shows_what_it_computes(self):
        shown, computed = nbformat.read(NOTEBOOK, as_version=4), execute()
        self.assertEqual(texts(computed), texts(shown))
        self.assertEqual(pictures(computed), pictures(shown))
        self.assertGreaterEqual(sum(pictures(shown)), 5)


if __name__ == "__main__":
    if sys.argv[1:] == ["update"]:
        nbformat.write(execute(), NOTEBOOK)
    else:
        unittest.main()
