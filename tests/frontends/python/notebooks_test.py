#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The notebooks of docs/notebooks, run cell by cell; each must come to its end.

usage: PYTHONPATH=build/release/python notebooks_test.py TAKT SOURCE_FOLDER
"""
import pathlib
import sys

try:
    import nbclient
    import nbformat
    import pandas  # noqa: F401
    from jupyter_client import kernelspec
    kernelspec.get_kernel_spec("python3")
except Exception as missing:
    print(f"not tested: {missing}")
    sys.exit(77)

FOLDER = pathlib.Path(sys.argv[2]) / "docs" / "notebooks"
files = sorted(FOLDER.glob("*.ipynb"))
assert len(files) >= 2, files
for file in files:
    notebook = nbformat.read(file, as_version=4)
    nbclient.NotebookClient(notebook, timeout=900, kernel_name="python3", resources={"metadata": {"path": str(FOLDER)}}).execute()
    outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    assert any("image/svg+xml" in output.get("data", {}) or "<svg" in output.get("data", {}).get("text/html", "") for output in outputs), file
    print(f"{file.name}: {len(outputs)} outputs")
