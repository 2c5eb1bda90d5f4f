# SPDX-License-Identifier: MIT
"""Installs a build into a folder, and configures, builds and runs a consumer against it.

    install_test.py CMAKE BUILD_FOLDER ARTICAP
"""

import pathlib
import subprocess
import sys
import tempfile

CONSUMER = pathlib.Path(__file__).resolve().parent / "consumer"


def run(*command):
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{result.stdout}{result.stderr}")
    return result.stdout


def main():
    cmake, build_folder, _ = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        prefix = folder / "installed"
        run(cmake, "--install", build_folder, "--prefix", prefix)
        run(cmake, "-G", "Ninja", "-S", CONSUMER, "-B", folder / "build", "-DCMAKE_BUILD_TYPE=Debug",
            f"-DCMAKE_PREFIX_PATH={prefix}")
        run(cmake, "--build", folder / "build")
        said = run(folder / "build" / "consumer")
        version = run(prefix / "bin" / "articap", "--version")
        if said not in version:
            sys.exit(f"the consumer says {said!r}, the installed program {version!r}")


if __name__ == "__main__":
    main()
