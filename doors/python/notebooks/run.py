"""Runs every notebook of this folder; a cell that fails is an error. `cargo xtask python --notebooks` calls it.

Texts of a notebook that is kept with its outputs must be those that it prints. RNE_WRITE_DOCUMENTS=1 writes them.
"""

import copy
import os
import pathlib
import sys

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError


def texts(notebook):
    """What cells print and return as text; plots have more digits than another machine computes."""
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    return [output.get("text") or output.get("data", {}).get("text/plain") for output in outputs]


failed = False
for path in sorted(pathlib.Path(__file__).parent.glob("*.ipynb")):
    kept = nbformat.read(path, as_version=4)
    notebook = copy.deepcopy(kept)
    try:
        NotebookClient(notebook, timeout=300, kernel_name="python3", record_timing=False).execute()
        print(f"{path.name}: {len(notebook.cells)} cells")
    except CellExecutionError as error:
        print(f"{path.name}: {error}")
        failed = True
        continue
    if texts(kept) and "RNE_WRITE_DOCUMENTS" in os.environ:
        notebook.metadata = kept.metadata
        nbformat.write(notebook, path)
    elif texts(kept) and texts(kept) != texts(notebook):
        print(f"{path.name}: outputs are not those that are kept; RNE_WRITE_DOCUMENTS=1 writes them")
        failed = True
sys.exit(failed)
