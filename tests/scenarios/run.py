# SPDX-License-Identifier: MIT
"""Runs one scenario of the command line: makes its inputs, runs its steps, checks what they leave.

    run.py ARTICAP SCENARIO.toml [PICTURES]

A scenario is a file of

    description = "what happens to whom"
    needs = "animface/jaw.trc"          # optional: real data; skipped (exit code 77) without them
    needs_program = "ffmpeg"            # optional, the same for a program
    needs_pictures = true               # optional: the folder PICTURES, where the tests of
                                        # articap_calibration_pictures put what it makes

    [[input]]                           # files in the scenario's own empty folder
    name = "take.csv"
    text = "..."                        # or hex = "...", or
    ffmpeg = "-f lavfi -i testsrc"      # what ffmpeg makes by these arguments, or
    pictures = "lens/camera1"           # a folder: a copy of one of PICTURES, or of only = [0, 3]
                                        # in the order of their names, or
    from = "other.csv"                  # an earlier input, a file of the source tree, of PICTURES,
                                        # or of the real data; changed by the operations of edits.py
    edits = [{scale = 100}]

    [[step]]
    run = ["convert", "take.csv", "out.trc"]     # arguments of articap; {root} is the source tree,
                                        # {data} the folder of real data, {pictures} PICTURES
    exit_code = 1                       # default 0
    stdout = ["every text that must appear"]
    warnings = [["chin", "glued"]]      # for each list a warning that says all of it
    stderr = ["take.csv:3:"]
    not_stderr = ["texts that must not"]
    json = ["figures.frames"]           # keys of the JSON that stdout must be
    files = ["out.trc"]                 # all files that the step makes; none where it is left out
    same = [["a.trc", "b.trc"]]         # pairs of files with the same bytes; `differ`: with others
    keys = {"out/report.json" = ["fit.figures.frames"]}

Every step must end by itself with one of the exit codes 0, 1, 2, and say why on stderr where it is
not 0. Its new files are exactly those listed: nothing half-written stays.
"""

import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import tomllib

import edits

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77
TIMEOUT_S = 240


class Failure(Exception):
    pass


def test_data():
    return pathlib.Path(os.environ.get("ARTICAP_TEST_DATA", ROOT.parent / "shared" / "data"))


def calibration_pictures():
    return pathlib.Path(sys.argv[3]).resolve() if len(sys.argv) > 3 else ROOT / "no_pictures"


def in_place(argument):
    return (argument.replace("{root}", str(ROOT)).replace("{data}", str(test_data()))
            .replace("{pictures}", str(calibration_pictures())))


def find_source(name, folder):
    for base in (folder, ROOT, calibration_pictures(), test_data()):
        if (base / name).is_file():
            return base / name
    raise Failure(f"there is no {name} to make an input from")


def copy_pictures(spec, path):
    pictures = sorted((calibration_pictures() / spec["pictures"]).iterdir())
    path.mkdir(parents=True, exist_ok=True)
    for number in spec.get("only", range(len(pictures))):
        shutil.copy(pictures[number], path)


def make_input(spec, folder):
    path = folder / spec["name"]
    path.parent.mkdir(parents=True, exist_ok=True)
    if "pictures" in spec:
        copy_pictures(spec, path)
        return
    if "text" in spec:
        data = spec["text"].encode()
    elif "hex" in spec:
        data = bytes.fromhex(spec["hex"])
    elif "ffmpeg" in spec:
        arguments = shlex.split(in_place(spec["ffmpeg"]))
        subprocess.run(["ffmpeg", "-nostdin", "-loglevel", "error", *arguments, path.name],
                       cwd=path.parent, check=True)
        data = path.read_bytes()
    else:
        data = find_source(spec["from"], folder).read_bytes()
    path.write_bytes(edits.apply(data, spec.get("edits", [])))


def files_in(folder):
    return {path.relative_to(folder).as_posix(): path.stat().st_mtime_ns
            for path in folder.rglob("*") if path.is_file()}


def check_fragments(what, text, wanted, unwanted):
    flat = re.sub(r"\s+", " ", text)
    for fragment in wanted:
        if fragment not in text and fragment not in flat:
            raise Failure(f"{what} lacks {fragment!r}:\n{text}")
    for fragment in unwanted:
        if fragment in text:
            raise Failure(f"{what} must not say {fragment!r}:\n{text}")


def check_warnings(stdout, wanted):
    lines = [line for line in stdout.split("\n") if line.strip().startswith("warning: ")]
    for fragments in wanted:
        if not any(all(fragment in line for fragment in fragments) for line in lines):
            raise Failure(f"no warning says {fragments}; there are\n" + "\n".join(lines))


def check_keys(what, text, keys):
    try:
        document = json.loads(text)
    except ValueError as error:
        raise Failure(f"{what} is no JSON ({error}):\n{text}") from error
    for key in keys:
        value = document
        for part in key.split("."):
            if not isinstance(value, dict) or part not in value:
                raise Failure(f"{what} has no {key}")
            value = value[part]


def run_step(articap, step, folder):
    before = files_in(folder)
    result = subprocess.run([articap, *map(in_place, step["run"])], cwd=folder, capture_output=True,
                            timeout=TIMEOUT_S)
    stdout = result.stdout.decode(errors="replace")
    stderr = result.stderr.decode(errors="replace")
    said = f"stdout:\n{stdout}\nstderr:\n{stderr}"
    if result.returncode != step.get("exit_code", 0):
        raise Failure(f"exit code {result.returncode}, not {step.get('exit_code', 0)}\n{said}")
    if result.returncode != 0 and "articap: error: " not in stderr and "Usage:" not in stderr:
        raise Failure(f"fails without an error message\n{said}")
    if "a mistake in articap itself" in stderr:
        raise Failure(f"reports a mistake of its own\n{said}")
    check_fragments("stdout", stdout, step.get("stdout", []), step.get("not_stdout", []))
    check_warnings(stdout, step.get("warnings", []))
    check_fragments("stderr", stderr, step.get("stderr", []), step.get("not_stderr", []))
    after = files_in(folder)
    made = sorted(name for name in after if after[name] != before.get(name))
    if made != sorted(step.get("files", [])):
        raise Failure(f"made the files {made}, not {sorted(step.get('files', []))}\n{said}")
    for name, keys in step.get("keys", {}).items():
        check_keys(name, (folder / name).read_text(), keys)
    for wanted, pairs in ((True, step.get("same", [])), (False, step.get("differ", []))):
        for first, second in pairs:
            if ((folder / first).read_bytes() == (folder / second).read_bytes()) != wanted:
                raise Failure(f"{first} and {second} {'differ' if wanted else 'are the same'}")
    if "json" in step:
        check_keys("stdout", stdout, step["json"])


def main():
    articap = pathlib.Path(sys.argv[1]).resolve()
    scenario = tomllib.loads(pathlib.Path(sys.argv[2]).read_text())
    if "needs" in scenario and not (test_data() / scenario["needs"]).exists():
        print(f"{test_data() / scenario['needs']} is not there; set ARTICAP_TEST_DATA to run this")
        return SKIPPED
    if "needs_pictures" in scenario and not calibration_pictures().is_dir():
        print("the pictures to calibrate from are not there; ctest makes them before this test")
        return SKIPPED
    if "needs_program" in scenario and not shutil.which(scenario["needs_program"]):
        print(f"the program {scenario['needs_program']} is not there; install it to run this")
        return SKIPPED
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        number = 0
        for item in scenario.get("input", []):
            make_input(item, folder)
        for number, step in enumerate(scenario["step"], start=1):
            for item in step.get("input", []):
                make_input(item, folder)
            try:
                run_step(articap, step, folder)
            except Failure as failure:
                print(f"{scenario['description']}\nstep {number}, articap {' '.join(step['run'])}:")
                print(failure)
                return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
