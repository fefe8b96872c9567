"""Runs the notebooks, each in a folder of its own; with ``--write`` their new outputs are stored."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import nbformat
from nbclient import NotebookClient


def outputs(notebook: nbformat.NotebookNode) -> list[nbformat.NotebookNode]:
    """Those of all cells."""
    return [output for cell in notebook.cells for output in cell.get("outputs", [])]


for path in sorted(Path(__file__).parent.glob("*.ipynb")):
    notebook = nbformat.read(path, as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        client = NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": folder}})
        client.execute()
    pictures = sum("image/png" in output.get("data", {}) for output in outputs(notebook))
    print(f"{path.name}: {len(notebook.cells)} cells, {pictures} pictures")
    if "--write" in sys.argv:
        for cell in notebook.cells:
            cell.metadata.pop("execution", None)
            # Without progress bars.
            if cell.cell_type == "code":
                cell.outputs = [output for output in cell.outputs if output.get("name") != "stderr"]
        nbformat.write(notebook, path)
