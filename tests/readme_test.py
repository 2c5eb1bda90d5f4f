#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the ```console sessions of README.md, whose output must be what stands there.
tests/python/run_examples.py runs its Python.

    tests/readme_test.py ARTICAP            check
    tests/readme_test.py ARTICAP --update   write today's output into README.md
"""

import difflib
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
README = ROOT / "README.md"
BLOCK = re.compile(r"^```console\n(.*?)^```$", re.M | re.S)


def run_console(block, folder, environment):
    """The block as it would look today: its commands, each followed by what it prints."""
    shown = []
    for line in block.split("\n"):
        if not line.startswith("$ "):
            continue
        result = subprocess.run(["bash", "-c", line[2:]], cwd=folder, env=environment,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if result.returncode != 0:
            sys.exit(f"README.md: '{line[2:]}' exits with {result.returncode}:\n{result.stdout}")
        shown.append(line + "\n" + result.stdout)
    return "".join(shown)


def main():
    articap, update = pathlib.Path(sys.argv[1]).resolve(), "--update" in sys.argv
    before = README.read_text()
    with tempfile.TemporaryDirectory() as folder:
        for name in ("recordings", "maps"):
            os.symlink(ROOT / name, pathlib.Path(folder) / name)
        environment = dict(os.environ, PATH=f"{articap.parent}:{os.environ['PATH']}")

        def today(match):
            return f"```console\n{run_console(match[1], folder, environment)}```"

        after = BLOCK.sub(today, before)
    if update:
        README.write_text(after)
    elif after != before:
        difference = difflib.unified_diff(before.splitlines(), after.splitlines(), "README.md",
                                          "what the commands print today", lineterm="")
        sys.exit("\n".join(difference) + "\nRun tests/readme_test.py ARTICAP --update")


main()
