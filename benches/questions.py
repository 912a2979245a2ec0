#!/usr/bin/env python3
"""Everyday questions of a designer, one command or one Python call each: what is answered, and in what time.

    python3 benches/questions.py [--runs 5] ORTHOCERT

ORTHOCERT is the program; the designs are those of tests/designs and what is changed in them below. Prints, as Markdown,
each question, the command or call, the lines of the answer that answer it (or how many there are), and the median of its processor time and time
on the clock. The Python call needs the package (`pip install .`) in the interpreter that runs this.
"""

import argparse
import pathlib
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

DESIGNS = pathlib.Path(__file__).resolve().parent.parent / "tests" / "designs"
DELTA = "linear-delta-klipper-cylinder.toml"
TRANSMISSION = r"(?m)^transmission = .*$"
STOPS = r"(?m)^joint_range = .*\n?"
BUILT = r"(?m)^length = 333$"

# A file, the design that it is made of, and what is changed in that.
MADE = [
    ("half.toml", DELTA, [(TRANSMISSION, 'transmission = { min = "1/2", max = 2 }'), (STOPS, "")]),
    ("third.toml", DELTA, [(TRANSMISSION, 'transmission = { min = "1/3", max = 3 }'), (STOPS, "")]),
    ("built.toml", DELTA, [(BUILT, 'length = "333 ± 0.05"'), (TRANSMISSION, "accuracy = { joint_error = 0.01, max = 1 }")]),
    ("own.toml", DELTA, []),
    ("27.toml", "orthoglide-as-built.toml", []),
    ("whole.toml", "orthoglide-prototype-whole.toml", []),
    ("hexapod.toml", "kernel/hexapod-linuxcnc.toml", []),
    ("map.toml", "../atlases/linear-delta-2.toml", []),
]

# A question, its command, and how the lines of the answer begin that answer it.
QUESTIONS = [
    ("Largest cylinder, psi in [1/2, 2]?", "limit half.toml workspace.cylinder.radius --direction up --gap 1e-4",
     ["certified", "refuted", "limited by"]),
    ("Largest cylinder, psi in [1/3, 3]?", "limit third.toml workspace.cylinder.radius --direction up --gap 1e-4",
     ["certified", "refuted", "limited by"]),
    ("Arm length for a cube of 300 mm?", "size third.toml --cube 300 --gap 1e-3", ["leg length", "limited by"]),
    ("Which tolerance matters most?", "summary built.toml", ["length of leg 1", "joint errors"]),
    ("Joint ranges and speeds at 1 m/s?", "summary own.toml --speed 1000", ["stroke", "joint speed"]),
    ("The worst point, with a picture?", "verify own.toml -o own.cert.json && report own.cert.json", ["least psi", "own.report"]),
    ("A machine of 27 errors, in 20 lines?", "verify 27.toml", []),
    ("How accurate, with drives of 10 micrometres?", "summary built.toml", ["off by, joint"]),
    ("Forces and acceleration?", "summary whole.toml --speed 1200 --force 56 --acceleration 14000",
     ["joint force", "joint acceleration"]),
    ("The best of two parameters?", "atlas map.toml", ["best", "greatest"]),
    ("The same from Python?", "import orthocert as oc; print(oc.limit('half.toml', 'workspace.cylinder.radius', "
     "direction='up', gap='1e-4').upper.certified)", [""]),
    ("A hexapod?", "verify hexapod.toml", ["CERTIFIED", "proof"]),
]


def make(folder):
    for name, source, changes in MADE:
        text = (DESIGNS / source).read_text()
        for old, new in changes:
            text, count = re.subn(old, new, text)
            assert count, (name, old)
        (folder / name).write_text(text)


def ask(program, folder, command):
    """One answer, its processor time and its time on the clock, in seconds."""
    if command.startswith("import "):
        calls = [[sys.executable, "-c", command]]
    else:
        calls = [[program, *call.split()] for call in command.split(" && ")]
    before, start, text = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter(), ""
    for call in calls:
        run = subprocess.run(call, cwd=folder, capture_output=True, text=True)
        if run.returncode not in (0, 3):
            sys.exit(f"{command}: exit code {run.returncode}\n{run.stderr}")
        text += run.stdout
    wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return text, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, wall


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("orthocert")
    arguments = parser.parse_args()
    program = shutil.which(arguments.orthocert) or sys.exit(f"{arguments.orthocert}: no program")
    print("| question | command or call | answer | processor, s | clock, s |\n|---|---|---|---|---|")
    for question, command, wanted in QUESTIONS:
        all_runs = []
        for _ in range(arguments.runs):
            with tempfile.TemporaryDirectory() as folder:
                make(pathlib.Path(folder))
                all_runs.append(ask(pathlib.Path(program).resolve(), folder, command))
        lines = [" ".join(line.split()) for line in all_runs[0][0].splitlines()]
        answer = [line for line in lines if any(line.startswith(start) for start in wanted)]
        if not wanted:
            answer = [f"{lines[0]}, {len(lines)} lines"]
        if not answer:
            sys.exit(f"{command}: no answer in\n{all_runs[0][0]}")
        processor, clock = (statistics.median(run[k] for run in all_runs) for k in (1, 2))
        print(f"| {question} | `{command}` | {'; '.join(answer)} | {processor:.2f} | {clock:.2f} |", flush=True)


if __name__ == "__main__":
    main()
