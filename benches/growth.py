"""How time, boxes and memory of a paving grow with its precision. Prints Markdown.

usage: python3 benches/growth.py target/release/orthocert [--depths D...] [--gaps G...]

The Orthoglide with L = 1, transmission factors within [1/2, 2], in [-0.7, 0.7]^3. A paving of depth
d splits undecided boxes to edges of 1.4 * 2^(-d/3) in the geometric mean. Processor time is user and
system of the whole process, the exact check of every box included; where the machine has other work,
it is steadier than the clock's. Exponents are of power laws fitted to the logarithms.
"""

import argparse
import json
import os
import subprocess
import tempfile
import time
from math import log
from pathlib import Path

DESIGN = """
[mechanism]
kind = "orthoglide"
leg_length = 1
[workspace]
min = [-0.7, -0.7, -0.7]
max = [0.7, 0.7, 0.7]
[requirements]
transmission = { min = "1/2", max = 2 }
"""


def run(*goal, threads=1):
    """The answer, and the process's clock time, processor time and greatest memory in MB."""
    started = time.monotonic()
    command = [orthocert, "pave", "d.toml", *goal, "--threads", str(threads), "--format", "json"]
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL)
    text = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    clock = time.monotonic() - started
    assert status == 0, (goal, status)
    return json.loads(text), clock, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def boxes_of(answer):
    return sum(answer[kind]["boxes"] for kind in ("inner", "outer", "boundary"))


def exponent(xs, ys):
    u, v = [log(x) for x in xs], [log(y) for y in ys]
    a, b = sum(u) / len(u), sum(v) / len(v)
    return sum((s - a) * (t - b) for s, t in zip(u, v)) / sum((s - a) ** 2 for s in u)


parser = argparse.ArgumentParser()
parser.add_argument("orthocert")
parser.add_argument("--depths", type=int, nargs="+", default=[18, 21, 24, 27, 30])
parser.add_argument("--gaps", nargs="+", default=["0.1", "0.05", "0.01", "0.002"])
arguments = parser.parse_args()
orthocert, depths = str(Path(arguments.orthocert).resolve()), arguments.depths
version = subprocess.run([orthocert, "--version"], capture_output=True, text=True).stdout.strip()
processor = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo")
                  if line.startswith("model name")), os.uname().machine)
print("# Growth of a paving with its precision\n")
print(f"`benches/growth.py --depths {' '.join(map(str, depths))} --gaps {' '.join(arguments.gaps)}`; "
      f"{version}, "
      f"{processor}, {os.cpu_count()} cores, load at the start "
      f"{os.getloadavg()[0]:.1f}. What is measured: the head of `benches/growth.py`.\n")
with tempfile.TemporaryDirectory() as folder:
    Path(folder, "d.toml").write_text(DESIGN)
    print("| depth | edge | gap | boxes | file | processor time | boxes/s per core | memory "
          "| clock, 1 thread | clock, 2 threads | processor time, 2 threads |")
    print("|---|---|---|---|---|---|---|---|---|---|---|", flush=True)
    rows = []
    for depth in depths:
        edge = 1.4 * 2 ** (-depth / 3)
        # A hair more: the depth is the least at which edges are at most so long.
        goal = ("--precision", f"{edge * 1.0001:.9f}")
        answer, clock, spent, memory = run(*goal)
        assert answer["depth"] == depth, answer["depth"]
        _, clock2, spent2, _ = run(*goal, threads=2)
        boxes = boxes_of(answer)
        rows.append((edge, boxes, spent, answer["bytes"]))
        print(f"| {depth} | {edge:.5f} | {answer['gap']:.4f} | {boxes:,} "
              f"| {answer['bytes'] / 1e6:.2f} MB | {spent:.2f} s | {boxes / spent:,.0f} "
              f"| {memory:.0f} MB | {clock:.2f} s | {clock2:.2f} s | {spent2:.2f} s |", flush=True)
    edges, boxes, times, sizes = zip(*rows)
    for what, values in (("boxes", boxes), ("processor time", times), ("bytes", sizes)):
        print(f"{'' if what != 'boxes' else chr(10)}* {what} ~ edge^{exponent(edges, values):.3f}")
    print("\n| gap asked for | reached | depth | boxes | processor time | memory | clock, 2 threads |")
    print("|---|---|---|---|---|---|---|", flush=True)
    for gap in arguments.gaps:
        answer, clock, spent, memory = run("--volume-gap", gap, threads=2)
        print(f"| {gap} | {answer['gap']:.5f} | {answer['depth']} | {boxes_of(answer):,} "
              f"| {spent:.2f} s | {memory:.0f} MB | {clock:.2f} s |", flush=True)
