"""Orthocert against its peers: a paving, and yes/no questions. Prints Markdown.

The region: the Orthoglide with L = 1, transmission factors within [1/2, 2], in [-0.7, 0.7]^3.
Codac is given it without divisions. With q_i = s_i^2, A_i the rows of A (|A_i| = 1), l = 1/4 or 4,

    H(l) = A A^T - l diag(q) = diag(s) (M M^T - l I) diag(s),    A_1 . A_2 = s_1 x + s_2 y + z^2, ...

the claim is q_i > 0, H(1/4) >= 0 and -H(4) >= 0, which hold if and only if all principal minors are
>= 0. (Those of order one of H(1/4), 1 - q_i/4, are positive wherever q_i <= 1, and left out.)
Each minor is a `SepInverse` of an `AnalyticFunction`; their intersection is given to `pave`. Of the
formulations that were tried, that had the least gap and the least time for it: leading minors alone,
the coefficients of the characteristic polynomials, and all nine leading minors as one vector function
were no better. IBEX has the same constraints, see ibex.py.

Codac and ibexsolve are rounded outward, but nothing re-checks them; orthocert's time includes the
exact check of every box. Times are processor time of one thread, user and system, of the call to
`pave` for Codac and of the whole process for orthocert and ibexsolve: on a loaded machine they are steadier than
the clock's.
"""

import importlib.metadata
import json
import platform
import resource
import subprocess
import sys
import tempfile
import time
from math import log
from pathlib import Path

import ibex
from codac import (AnalyticFunction, Interval, IntervalVector, PavingInOut, SepInverse, VectorVar,
                   oo, pave, sqr, sqrt)

QUESTIONS = [
    ("[-0.2, 0.3]^3", [-0.2, 0.3]),
    ("[-0.23, 0.4]^3", [-0.23, 0.4]),
    ("[-0.235, 0.408]^3", [-0.235, 0.408]),
    ("[-0.25, 0.3]^3", [-0.25, 0.3]),
    ("[-0.236, 0.3]^3", [-0.236, 0.3]),
]
PATIENCE = 10  # seconds
REPEATS = 5


def minors():
    p = VectorVar(3)
    x, y, z = p[0], p[1], p[2]
    q = [1 - sqr(y) - sqr(z), 1 - sqr(x) - sqr(z), 1 - sqr(x) - sqr(y)]
    s = [sqrt(q_i) for q_i in q]
    a = s[0] * x + s[1] * y + sqr(z)
    b = s[0] * x + s[2] * z + sqr(y)
    c = s[1] * y + s[2] * z + sqr(x)
    constraints = list(q)
    for l, sign in ((0.25, 1), (4, -1)):
        d, e, f = (sign * (1 - l * q_i) for q_i in q)
        if sign < 0:
            constraints += [d, e, f]
        constraints += [d * e - sqr(a), d * f - sqr(b), e * f - sqr(c)]
        constraints += [d * e * f + sign * 2 * a * b * c - d * sqr(c) - e * sqr(b) - f * sqr(a)]
    return p, constraints


def separator():
    p, constraints = minors()
    first, *others = (SepInverse(AnalyticFunction([p], c), Interval(0, oo)) for c in constraints)
    for other in others:
        first = first & other
    return first


def codac_paving(region, ends, edge):
    started = time.process_time()
    paving = pave(IntervalVector([ends] * 3), region, edge)
    seconds = time.process_time() - started
    kinds = (PavingInOut.inner, PavingInOut.bound, PavingInOut.outer_complem)
    boxes = [paving.boxes(kind) for kind in kinds]
    inner, bound, outer = (sum(box.volume() for box in some) for some in boxes)
    whole = (ends[1] - ends[0]) ** 3
    assert abs(inner + bound + outer - whole) < 1e-6 * whole, "the boxes do not make up the whole"
    return seconds, inner, bound, sum(map(len, boxes)), outer


def codac_answer(region, ends):
    """Yes or no, or neither within PATIENCE, and the time of the last paving alone."""
    spent, edge = 0, ends[1] - ends[0]
    while spent < PATIENCE:
        edge /= 2
        seconds, _, bound, _, outer = codac_paving(region, ends, edge)
        spent += seconds
        if outer > 0:
            return "no", seconds
        if bound == 0:
            return "yes", seconds
    return f"undecided at edges of {edge:.1g}", seconds


def design(ends, top=None):
    return (
        '[mechanism]\nkind = "orthoglide"\nleg_length = 1\n[workspace]\n'
        f"min = [{ends[0]}, {ends[0]}, {ends[0]}]\nmax = [{ends[1]}, {ends[1]}, {top or ends[1]}]\n"
        '[requirements]\ntransmission = { min = "1/2", max = 2 }\n'
    )


def measured(command):
    """The least processor time of some runs, the exit code and the answer."""
    best = float("inf")
    for _ in range(REPEATS):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        run = subprocess.run(command, capture_output=True, text=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
        best = min(best, spent)
    return best, run.returncode, json.loads(run.stdout)


def orthocert_paving(name, gap):
    """The paving that is asked for with that gap."""
    command = [orthocert, "pave", name, "--volume-gap", f"{gap:.9f}", "--threads", "1",
               "--format", "json"]
    seconds, _, answer = measured(command)
    boxes = sum(answer[kind]["boxes"] for kind in ("inner", "outer", "boundary"))
    return seconds, answer["gap"], boxes


def orthocert_answer(name):
    seconds, code, _ = measured([orthocert, "verify", name, "--threads", "1", "--format", "json"])
    return {0: "yes", 1: "no", 3: "undecided"}[code], seconds


def exponent(xs, ys):
    """Of the power law fitted to the logarithms."""
    u, v = [log(x) for x in xs], [log(y) for y in ys]
    a, b = sum(u) / len(u), sum(v) / len(v)
    return sum((s - a) * (t - b) for s, t in zip(u, v)) / sum((s - a) ** 2 for s in u)


orthocert = str(Path(sys.argv[1]).resolve())
edges = [float(edge) for edge in sys.argv[2:]] or [0.2, 0.1, 0.05]
processor = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo")
                  if line.startswith("model name")), platform.machine())
version = subprocess.run([orthocert, "--version"], capture_output=True, text=True).stdout.strip()
print("# Orthocert and its peers\n")
print(f"`benches/peers/run.sh {' '.join(sys.argv[2:])}`; {version}, "
      f"Codac {importlib.metadata.version('codac')} (PyPI), Python {platform.python_version()}, "
      f"{processor}, one thread each, processor time. Load of the machine at the start: "
      f"{Path('/proc/loadavg').read_text().split()[0]}. Formulations: `benches/peers/peers.py`.\n")
with_ibex = ibex.available()
if with_ibex:
    print(f"IBEX: {ibex.version()}.\n")
else:
    print("IBEX: `ibexsolve` is not on PATH here; it is not compared.\n")

print("## The paving\n\nGap: volume of the undecided boxes over that of the inner ones. Orthocert's "
      "paving is that of `--volume-gap` with the other's gap. It paves a "
      "sixth of the box, by symmetry, which the others are not told: \"whole box\" is the same "
      "machine with the box 1e-6 higher in z, which has no symmetry.")


def compared(name, runs, folder):
    """A table of pavings by another program; returns its times and gaps."""
    print(f"\n| {name}: edge | boxes | gap | time | orthocert: gap | boxes | time | ratio "
          "| whole box: gap | boxes | time | ratio |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|", flush=True)
    found = []
    for edge in edges:
        seconds, gap, boxes = runs(edge)
        found.append((gap, seconds))
        row = f"| {edge} | {boxes:,} | {gap:.3f} | {seconds:.2f} s "
        for box in ("sixth.toml", "whole.toml"):
            ours, reached, count = orthocert_paving(str(Path(folder, box)), gap)
            row += f"| {reached:.3f} | {count:,} | {1000 * ours:.0f} ms | {seconds / ours:,.0f} "
        print(row + "|", flush=True)
    return found


def with_codac(edge):
    seconds, inner, bound, boxes, _ = codac_paving(region, [-0.7, 0.7], edge)
    return seconds, bound / inner, boxes


region = separator()
with tempfile.TemporaryDirectory() as folder:
    for name, top in (("sixth.toml", None), ("whole.toml", "0.700001")):
        Path(folder, name).write_text(design([-0.7, 0.7], top))
    found = compared("Codac", with_codac, folder)
    if len(edges) > 1:
        print(f"\nCodac's time grows with its gap to the power {exponent(*zip(*found)):.2f}.")
    if with_ibex:
        compared("IBEX", lambda edge: ibex.paving(folder, [-0.7, 0.7], edge), folder)

    print(f"\n## Questions\n\nDo all points of the cube have their transmission factors within [1/2, 2]? "
          f"Codac paves with edges of a half, a quarter, ... of the cube's, until all is decided or an "
          f"outer box is found, and starts no further paving after {PATIENCE} s; the time is that of the "
          f"last paving alone, as if its edge had been known. IBEX is asked for a point that violates a "
          f"constraint, one constraint after the other, each for at most {PATIENCE} s. Orthocert's answers are "
          f"certificates, accepted by the exact checker.\n")
    names = ["Codac", "IBEX"] if with_ibex else ["Codac"]
    print("| cube | orthocert | time |" + "".join(f" {name} | time | ratio |" for name in names))
    print("|---|---|---|" + "---|---|---|" * len(names), flush=True)
    for text, ends in QUESTIONS:
        Path(folder, "question.toml").write_text(design(ends))
        ours, spent = orthocert_answer(str(Path(folder, "question.toml")))
        row = f"| {text} | {ours} | {1000 * spent:.0f} ms |"
        others = [codac_answer(region, ends)]
        if with_ibex:
            others.append(ibex.answer(folder, ends, PATIENCE))
        for answer, seconds in others:
            row += f" {answer} | {seconds:.2f} s | {seconds / spent:,.0f} |"
        print(row, flush=True)
