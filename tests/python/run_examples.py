#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs the Python examples of Markdown files on sample results in ./out.

    run_examples.py ARTICAP_SAMPLE_RESULTS FILE.md...

The fenced python blocks of a file run one after another in one namespace, warnings as errors. Then
what the examples of docs/python.md read from the CSV and from the HDF5 file is compared.
"""

import contextlib
import io
import os
import re
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

try:
    import h5py  # noqa: F401
    import numpy as np
    import pandas as pd
except ImportError as missing:
    print(f"the Python examples were not run: {missing}")
    sys.exit(77)

BLOCK = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)


def run_blocks(path):
    """The namespace that the file's blocks leave behind, and what they printed."""
    text = path.read_text(encoding="utf-8")
    namespace = {"__name__": "__example__"}
    printed = io.StringIO()
    count = 0
    for block in BLOCK.finditer(text):
        # Line numbers of the file, so that an error points at the example.
        line = text.count("\n", 0, block.start(1))
        with contextlib.redirect_stdout(printed):
            exec(compile("\n" * line + block.group(1), str(path), "exec"), namespace)
        count += 1
    print(f"{path.name}: {count} examples ran")
    return count, namespace, printed.getvalue()


def check_documentation(namespace, printed):
    """CSV and HDF5 say the same, and the examples printed something of it."""
    table = pd.read_csv("out/parameters.csv", keep_default_na=False, na_values=[""])
    columns = [f"{name}[{unit}]" for name, unit in zip(namespace["names"], namespace["units"])]
    np.testing.assert_allclose(namespace["Y"], table[columns].to_numpy(), atol=1e-6)
    np.testing.assert_allclose(namespace["time_s"], table["time_s"], atol=1e-9)
    assert list(namespace["statuses"]) == list(table["status"])
    assert list(namespace["phones"]) == list(table["phone"].fillna(""))
    assert np.isnan(namespace["Y"][namespace["statuses"] == "no_head_pose"]).all()
    assert "stabilize is usable" in printed and "warning: 48 frames" in printed


def main():
    sample_results, *files = [Path(argument).resolve() for argument in sys.argv[1:]]
    warnings.simplefilter("error")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        subprocess.run([sample_results, "out", "1000"], check=True)
        for path in files:
            if not path.exists():
                print(f"{path.name} is not there")
                continue
            count, namespace, printed = run_blocks(path)
            if path.name == "python.md":
                assert count >= 4, "docs/python.md has lost its examples"
                check_documentation(namespace, printed)
        os.chdir("/")


if __name__ == "__main__":
    main()
