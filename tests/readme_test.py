#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""README.md's terminal session is what the commands print today.

    readme_test.py ARTICAP [--update]

Runs the lines after "$ " of the ```console blocks, in order, in an empty folder that sees
recordings/, and compares what they print, errors included; --update writes it into the README.
"""

import difflib
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
README = ROOT / "README.md"
BLOCK = re.compile(r"(?<=^```console\n)(.*?)(?=^```)", re.MULTILINE | re.DOTALL)


def run_session(articap, text):
    """The README with what its commands print now."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "recordings").symlink_to(ROOT / "recordings")
        environment = {**os.environ, "PATH": f"{articap.parent}:{os.environ['PATH']}",
                       "LC_ALL": "C.UTF-8"}

        def answer(block):
            commands = [line for line in block[1].split("\n") if line.startswith("$ ")]
            session = ""
            for command in commands:
                result = subprocess.run(["bash", "-c", command[2:]], cwd=folder, env=environment,
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
                session += command + "\n" + result.stdout
            return session

        return BLOCK.sub(answer, text)


def main():
    articap = pathlib.Path(sys.argv[1]).resolve()
    written = README.read_text()
    printed = run_session(articap, written)
    if "--update" in sys.argv[2:]:
        README.write_text(printed)
        return 0
    if not BLOCK.search(written):
        print("README.md has lost its terminal session")
        return 1
    if printed != written:
        print("README.md shows what the commands no longer print; look at the difference, then run\n"
              "  tests/readme_test.py build/release/articap --update\n")
        print("".join(difflib.unified_diff(written.splitlines(True), printed.splitlines(True),
                                           "README.md", "printed now")))
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
