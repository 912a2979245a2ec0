"""One question about hexapods for orthocert and Codac: is M regular all over a workspace of six dimensions?

    benches/peers/run.sh --hexapods

The workspace is a box of positions and of roll, pitch and yaw, the latter by their half-angle tangents, so that
everything is rational. M without its divisors has the rows (u, r x u) with r = R b and u = P + r - a, enclosed as
r x (P - a), which is the same and narrower. A box is regular by

* the determinant: Codac's `det` of the matrix of formulas, enclosed over the box, has no zero;
* Neumann: with C the inverse at the middle, in doubles, the norm of I - C M is below 1, each norm by rows or columns;
  R is enclosed first, then M, and the product is an interval matrix of Codac's. This is the test that the literature uses.

Boxes that are not are halved along the side over which M changes most at first order, by differences of C M, or, for
the determinant, along the widest. The work is given up after PATIENCE seconds. Times are processor time of one thread:
of Codac of the loop alone, of orthocert of the whole process, with its exact check. Codac's loop is in Python: the
numbers of boxes are what does not depend on that. Needs numpy.
"""

import importlib.metadata
import json
import platform
import resource
import subprocess
import sys
import tempfile
import time
from math import cos, radians, sin, tan
from pathlib import Path

import numpy as np
from codac import AnalyticFunction, EvalMode, Interval, IntervalMatrix, IntervalVector, Matrix, VectorVar, det, mat, sqr, vec

PATIENCE = 5  # seconds


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


def rotation(v):
    """R_z R_y R_x, by columns, from half-angle tangents that are anything with + - * /."""
    r = [[1 if i == j else 0 for j in range(3)] for i in range(3)]
    for axis, t in ((2, v[2]), (1, v[1]), (0, v[0])):
        w = 1 + sqr(t)
        c, s = (1 - sqr(t)) / w, 2 * t / w
        i, j = (axis + 1) % 3, (axis + 2) % 3
        for row in r:
            row[i], row[j] = row[i] * c + row[j] * s, row[j] * c - row[i] * s
    return list(zip(*r))


def matrix(a, b, p, r):
    """Entries of M without divisors, from a position and a rotation by columns."""
    rows = []
    for a_i, b_i in zip(a, b):
        at = [sum((r[j][k] * b_i[j] for j in range(3) if b_i[j]), 0 * r[0][0]) for k in range(3)]
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
    print("# Orthocert and Codac: is a hexapod regular?\n")
    print(f"`benches/peers/run.sh --hexapods`; {version}, Codac {importlib.metadata.version('codac')} (PyPI), Python "
          f"{platform.python_version()}, {processor}, one thread each, processor time. Load of the machine at the start: "
          f"{Path('/proc/loadavg').read_text().split()[0]}. Formulations: `benches/peers/hexapod.py`.\n")
    print("Codac's work is given up after " f"{PATIENCE} s; the ratio is then a lower bound.")
    print("\n| workspace | orthocert | leaves | time | Neumann | boxes | time | ratio | determinant | boxes | time | ratio |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|", flush=True)
    for name, a, b, half, height, angle in QUESTIONS:
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "hexapod.toml").write_text(design(a, b, half, height, angle))
            run, ours = spent([orthocert, "verify", "hexapod.toml", "--threads", "1", "--format", "json"], folder)
        answer = json.loads(run.stdout)
        row = f"| {name} | {answer['verdict']} | {answer['proof']['leaves']} | {1000 * ours:.0f} ms |"
        t = tan(radians(angle) / 2)
        box = IntervalVector([[-half, half], [-half, half], [height - half, height + half]] + [[-t, t]] * 3)
        for test in (by_neumann, by_determinant):
            is_regular, tried, seconds = codac(a, b, box, test)
            least = "" if is_regular else "> "
            row += (f" {'regular' if is_regular else 'not decided'} | {tried:,} | {seconds:.2f} s | "
                    f"{least}{seconds / ours:,.0f} |")
        print(row, flush=True)


if __name__ == "__main__":
    main()
