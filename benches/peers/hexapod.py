"""One question about hexapods for orthocert, Codac and IBEX: is M regular all over a workspace of six dimensions?

    benches/peers/run.sh --hexapods

The workspace is a box of positions and of roll, pitch and yaw, the latter by their half-angle tangents, so that
everything is rational. M without its divisors has the rows (u, r x u) with r = R b and u = P + r - a, enclosed as
r x (P - a), which is the same and narrower. A box is regular by

* the determinant: Codac's `det` of the matrix of formulas, enclosed over the box, has no zero;
* Neumann: with C the inverse at the middle, in doubles, the norm of I - C M is below 1, each norm by rows or columns;
  R is enclosed first, then M, and the product is an interval matrix of Codac's. This is the test that the literature uses.

Boxes that are not are halved along the side over which M changes most at first order, by differences of C M, or, for
the determinant, along the widest.

`ibexsolve` (how to get it: ibex.py; without it these columns are left out) is asked for a singular pose, with the
contractors and the bisection that it chooses itself (HC4, ACID, Newton where it is square, polytope hulls by Clp; smear),
in two ways; both were as good or better with half-angle tangents as with sines and cosines, and the second one as with
M^T v = 0:

* the determinant is 0, by the minors of the last rows, each once;
* M v = 0 with |v|^2 = 1 and v_6 >= 0: twelve unknowns, seven equations.

No pose is an answer: M is regular. The work is given up after PATIENCE seconds. Times are processor time of one thread:
of Codac of the loop alone, of orthocert, with its exact check, and ibexsolve of the whole process. Codac's loop is in
Python: the numbers of boxes are what does not depend on that. Needs numpy.
"""

import importlib.metadata
import json
import platform
import re
import resource
import subprocess
import sys
import tempfile
import time
from functools import reduce
from itertools import combinations
from math import cos, radians, sin, tan
from operator import add
from pathlib import Path

import ibex
import numpy as np
from codac import AnalyticFunction, EvalMode, Interval, IntervalMatrix, IntervalVector, Matrix, VectorVar, det, mat, sqr, vec

PATIENCE = 10  # seconds


def circle(radius, degrees):
    return [round(radius * cos(radians(degrees)), 6), round(radius * sin(radians(degrees)), 6), 0]


A = [circle(1, third + s * 10) for third in (0, 120, 240) for s in (-1, 1)]
B = [circle(0.5, third + s * 50) for third in (0, 120, 240) for s in (-1, 1)]
LINUXCNC = (
    [[-22.95, 13.25, 0], [22.95, 13.25, 0], [22.95, 13.25, 0], [0, -26.5, 0], [0, -26.5, 0], [-22.95, 13.25, 0]],
    [[-1, 11.5, 0], [1, 11.5, 0], [10.459, -4.884, 0], [9.459, -6.616, 0], [-9.459, -6.616, 0], [-10.459, -4.884, 0]],
)
QUESTIONS = [
    ("1/0.5, ±0.05, ±3 degrees", A, B, 0.05, 1, 3),
    ("1/0.5, ±0.1, ±8 degrees", A, B, 0.1, 1, 8),
    ("1/0.5, ±0.2, ±15 degrees", A, B, 0.2, 1, 15),
    ("1/0.5, ±0.2, ±25 degrees", A, B, 0.2, 1, 25),
    ("LinuxCNC's, ±4 in, ±15 degrees", *LINUXCNC, 4, 20, 15),
]


class Text:
    """An expression of ibexsolve's, without terms and factors that change nothing."""

    def __init__(self, text):
        self.text = text

    def __str__(self):
        return self.text

    def __add__(self, other):
        return self if other == 0 else Text(f"({self}+{other})")

    def __sub__(self, other):
        return self if other == 0 else Text(f"({self}-({other}))")

    def __mul__(self, other):
        return Text(f"{self}*({other})")

    def __truediv__(self, other):
        return Text(f"({self}/{other})")

    def __radd__(self, other):
        return self if other == 0 else Text(f"({other}+{self})")

    def __rsub__(self, other):
        return Text(f"(-{self})" if other == 0 else f"({other}-{self})")

    def __rmul__(self, other):
        return other if other == 0 else self if other == 1 else Text(f"{other}*{self}")


def squared(x):
    return Text(f"{x}^2") if isinstance(x, Text) else sqr(x)


def rotation(v):
    """R_z R_y R_x, by columns, from half-angle tangents that are anything with + - * /."""
    r = [[1 if i == j else 0 for j in range(3)] for i in range(3)]
    for axis, t in ((2, v[2]), (1, v[1]), (0, v[0])):
        w = 1 + squared(t)
        c, s = (1 - squared(t)) / w, 2 * t / w
        i, j = (axis + 1) % 3, (axis + 2) % 3
        for row in r:
            row[i], row[j] = row[i] * c + row[j] * s, row[j] * c - row[i] * s
    return list(zip(*r))


def matrix(a, b, p, r):
    """Entries of M without divisors, from a position and a rotation by columns."""
    rows = []
    for a_i, b_i in zip(a, b):
        at = [reduce(add, (r[j][k] * b_i[j] for j in range(3) if b_i[j])) for k in range(3)]
        e = [p[k] - a_i[k] for k in range(3)]
        moment = [at[(k + 1) % 3] * e[(k + 2) % 3] - at[(k + 2) % 3] * e[(k + 1) % 3] for k in range(3)]
        rows.append([at[k] + e[k] for k in range(3)] + moment)
    return rows


def codac(a, b, box, test):
    """Whether all boxes are regular, how many were tried, and seconds."""
    f = test(a, b)
    started, tried, work = time.process_time(), 0, [box]
    while work:
        if time.process_time() - started > PATIENCE:
            return False, tried, time.process_time() - started
        box, tried = work.pop(), tried + 1
        is_regular, axis = f(box)
        if not is_regular:
            work.extend(box.bisect(axis))
    return True, tried, time.process_time() - started


def by_determinant(a, b):
    v = VectorVar(6)
    m = matrix(a, b, v, rotation([v[3], v[4], v[5]]))
    f = AnalyticFunction([v], det(mat(*(vec(*column) for column in zip(*m)))))
    return lambda box: (not f.eval(EvalMode.NATURAL, box).contains(0), box.max_diam_index())


def by_neumann(a, b):
    v = VectorVar(3)
    turned = AnalyticFunction([v], mat(*(vec(*column) for column in rotation(v))))

    def enclosed(box):
        r = turned.eval(EvalMode.NATURAL, IntervalVector([box[3], box[4], box[5]]))
        columns = [[r[k, j] for k in range(3)] for j in range(3)]
        return matrix(a, b, [box[k] for k in range(3)], columns)

    def doubles(rows):
        return np.array([[x.mid() for x in row] for row in rows])

    def tested(box):
        middle = IntervalVector(box.mid())
        inverse = np.linalg.inv(doubles(enclosed(middle)))
        product = IntervalMatrix(Matrix(inverse)) * IntervalMatrix(enclosed(box))
        off = (product - IntervalMatrix(Matrix(np.eye(6)))).mag()
        off = np.array([[off[i, j] for j in range(6)] for i in range(6)])
        if off.sum(axis=0).max() < 1 - 1e-12 or off.sum(axis=1).max() < 1 - 1e-12:
            return True, 0
        widths = []
        for k in range(6):
            ends = []
            for end in (box[k].lb(), box[k].ub()):
                at = IntervalVector(middle)
                at[k] = Interval(end)
                ends.append(doubles(enclosed(at)))
            widths.append(np.abs(inverse @ (ends[1] - ends[0])).sum(axis=1).max())
        return False, int(np.argmax(widths))

    return tested


def determinant():
    """That of six rows as a function of ibexsolve's, by the minors of the last rows."""
    lines = ["function det(" + ",".join(f"m{i}{j}" for i in range(6) for j in range(6)) + ")"]
    for size in range(2, 7):
        i = 6 - size
        for columns in combinations("012345", size):
            below = ("".join(columns).replace(c, "") for c in columns)
            minors = (f"m5{b}" if size == 2 else f"d{b}" for b in below)
            terms = (f"{'+-'[k % 2]}m{i}{c}*{minor}" for k, (c, minor) in enumerate(zip(columns, minors)))
            value = "".join(terms)[1:]
            lines.append(f"return {value};" if size == 6 else f"d{''.join(columns)}={value};")
    return "\n".join([*lines, "end\n"])


def ibexsolve(folder, a, b, box, is_determinant):
    """Whether no pose of the box is singular, how many boxes were tried, and seconds."""
    names = [f"p{k}" for k in range(6)]
    unknown = "".join(f"{name} in [{low!r},{high!r}];\n" for name, (low, high) in zip(names, box))
    v = [Text(name) for name in names]
    rows = matrix(a, b, v[:3], rotation(v[3:]))
    if is_determinant:
        functions = determinant()
        constraints = "det(" + ",".join(str(entry) for row in rows for entry in row) + ")=0;\n"
    else:
        unknown += "".join(f"v{k} in [{0 if k == 5 else -1},1];\n" for k in range(6))
        functions = ""
        constraints = "".join("+".join(f"{entry}*v{k}" for k, entry in enumerate(row)) + "=0;\n" for row in rows)
        constraints += "+".join(f"v{k}^2" for k in range(6)) + "=1;\n"
    problem = f"Variables\n{unknown}{functions}Constraints\n{constraints}end\n"
    printed, seconds = ibex.run(folder, problem, [f"--timeout={PATIENCE}"])
    return "infeasible problem" in printed, int(re.search(r"number of cells:\s*(\d+)", printed)[1]), seconds


def spent(command, folder, timeout=None):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run = subprocess.run(command, capture_output=True, text=True, cwd=folder, timeout=timeout)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return run, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def design(a, b, half, height, angle):
    legs = "".join(f'[[mechanism.legs]]\ndrive = "strut"\nanchor = {p}\nplatform = {q}\n' for p, q in zip(a, b))
    turned = ", ".join(f"{key} = [-{angle}, {angle}]" for key in ("roll", "pitch", "yaw"))
    return (f'[mechanism]\nkind = "spatial"\n{legs}[workspace]\nmin = [-{half}, -{half}, {height - half}]\n'
            f"max = [{half}, {half}, {height + half}]\norientation = {{ {turned} }}\n"
            "[requirements]\njoint_range = { min = 0 }\n")


def main():
    orthocert = str(Path(sys.argv[1]).resolve())
    version = subprocess.run([orthocert, "--version"], capture_output=True, text=True).stdout.strip()
    processor = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo")
                      if line.startswith("model name")), platform.machine())
    with_ibex = ibex.available()
    programs = f"Codac {importlib.metadata.version('codac')} (PyPI), " + (f"{ibex.version()}, " if with_ibex else "")
    print("# Orthocert and its peers: is a hexapod regular?\n")
    print(f"`benches/peers/run.sh --hexapods`; {version}, {programs}Python "
          f"{platform.python_version()}, {processor}, one thread each, processor time. Load of the machine at the start: "
          f"{Path('/proc/loadavg').read_text().split()[0]}. Formulations: `benches/peers/hexapod.py`.\n")
    if not with_ibex:
        print("IBEX: `ibexsolve` is not on PATH here; it is not compared.\n")
    print(f"The peers' work is given up after {PATIENCE} s; the ratio is then a lower bound.")
    peers = ["Codac, Neumann", "Codac, determinant"] + ["IBEX, determinant", "IBEX, M v = 0"] * with_ibex
    print("\n| workspace | orthocert | leaves | time |" + "".join(f" {p} | boxes | time | ratio |" for p in peers))
    print("|---|---|---|---|" + "---|---|---|---|" * len(peers), flush=True)
    for name, a, b, half, height, angle in QUESTIONS:
        t = tan(radians(angle) / 2)
        box = [[-half, half], [-half, half], [height - half, height + half]] + [[-t, t]] * 3
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "hexapod.toml").write_text(design(a, b, half, height, angle))
            run, ours = spent([orthocert, "verify", "hexapod.toml", "--threads", "1", "--format", "json"], folder)
            answer = json.loads(run.stdout)
            row = f"| {name} | {answer['verdict']} | {answer['proof']['leaves']} | {1000 * ours:.0f} ms |"
            others = [codac(a, b, IntervalVector(box), test) for test in (by_neumann, by_determinant)]
            if with_ibex:
                others += [ibexsolve(folder, a, b, box, is_determinant) for is_determinant in (True, False)]
        for is_regular, tried, seconds in others:
            least = "" if is_regular else "> "
            row += (f" {'regular' if is_regular else 'not decided'} | {tried:,} | {seconds:.2f} s | "
                    f"{least}{seconds / ours:,.0f} |")
        print(row, flush=True)


if __name__ == "__main__":
    main()
