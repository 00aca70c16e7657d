"""Runs every notebook of this folder; a cell that fails is an error. `cargo xtask python --notebooks` calls it."""

import pathlib
import sys

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

failed = False
for path in sorted(pathlib.Path(__file__).parent.glob("*.ipynb")):
    notebook = nbformat.read(path, as_version=4)
    try:
        NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
        print(f"{path.name}: {len(notebook.cells)} cells")
    except CellExecutionError as error:
        print(f"{path.name}: {error}")
        failed = True
sys.exit(failed)
