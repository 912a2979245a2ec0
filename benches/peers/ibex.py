"""The same paving and questions for `ibexsolve`, with the constraints of `peers.py` written out.

The paving: all constraints at once; solution boxes meet them everywhere, boundary and unknown boxes
are undecided, the rest of the box is outside. A question: whether a point violates a constraint,
each constraint by itself, up to the first box that is found. No box for any constraint: yes. A
solution box: no. Else the answer is left open.

Built from its sources (github.com/ibex-team/ibex-lib, release 2.9.1) with cmake and Debian's coinor-libclp-dev, flex and
bison. A pointer of its wrapper of Clp is never set, with which it crashes sooner or later; the second command sets it.

    cd ibex-lib
    sed -i 's/^    mode_ = mode;/& statistics = NULL;/' lp_lib_wrapper/clp/ibex_LPLibWrapper.cpp
    cmake -S . -B ../build -DLP_LIB=clp -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=$HOME/ibex
    make -C ../build install && PATH=$HOME/ibex/bin:$PATH
"""

import re
import resource
import shutil
import subprocess
from math import prod
from pathlib import Path

NUMBER = r"[-+0-9.eE]+"
BOX = re.compile(r"(solution|boundary|unknown|pending) n°\d+ = "
                 rf"\(\[({NUMBER}), ({NUMBER})\] ; \[({NUMBER}), ({NUMBER})\] ; "
                 rf"\[({NUMBER}), ({NUMBER})\]\)")
PRECISION = 1e-3  # edge of the boxes that a question is given up at


def available():
    return shutil.which("ibexsolve") is not None


def version():
    run = subprocess.run(["ibexsolve", "--version"], capture_output=True, text=True)
    return (run.stdout or run.stderr).strip().splitlines()[0]


def constraints():
    """Texts of what is >= 0 exactly where the requirements are met."""
    q = ["(1-y^2-z^2)", "(1-x^2-z^2)", "(1-x^2-y^2)"]
    s = [f"sqrt({q_i})" for q_i in q]
    a = f"({s[0]}*x+{s[1]}*y+z^2)"
    b = f"({s[0]}*x+{s[2]}*z+y^2)"
    c = f"({s[1]}*y+{s[2]}*z+x^2)"
    texts = list(q)
    for l, sign in (("0.25", 1), ("4", -1)):
        d, e, f = (f"(1-{l}*{q_i})" if sign > 0 else f"({l}*{q_i}-1)" for q_i in q)
        if sign < 0:
            texts += [d, e, f]
        texts += [f"{d}*{e}-{a}^2", f"{d}*{f}-{b}^2", f"{e}*{f}-{c}^2"]
        # The determinant of [[d, +-a, +-b], [+-a, e, +-c], [+-b, +-c, f]] by its first row.
        t = "-" if sign > 0 else "+"
        u = "+" if sign > 0 else "-"
        texts += [f"{d}*({e}*{f}-{c}^2)-{a}*({a}*{f}{t}{b}*{c}){u}{b}*({a}*{c}{t}{e}*{b})"]
    return texts


def run(folder, problem, options):
    """What `ibexsolve` prints of a problem, and the processor time of the whole process."""
    Path(folder, "problem.mbx").write_text(problem)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(["ibexsolve", "problem.mbx", *options], cwd=folder, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert "results written in" in done.stdout, f"ibexsolve: exit code {done.returncode}"
    return done.stdout, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def solved(folder, ends, needed, options):
    """The boxes by kind, and the processor time."""
    low, high = ends
    variables = "".join(f"  {name} in [{low}, {high}];\n" for name in "xyz")
    problem = f"Variables\n{variables}Constraints\n" + "".join(f"  {c};\n" for c in needed) + "end\n"
    printed, spent = run(folder, problem, ["--sols", *options])
    boxes = {"solution": [], "boundary": [], "unknown": [], "pending": []}
    for kind, *found in BOX.findall(printed):
        boxes[kind].append([float(x) for x in found])
    named = sum(printed.count(f"{kind} n°") for kind in boxes)
    assert named == sum(map(len, boxes.values())), "a box was not understood"
    return boxes, spent


def volume(boxes):
    return sum(prod(box[k + 1] - box[k] for k in (0, 2, 4)) for box in boxes)


def paving(folder, ends, edge):
    """Time, gap and number of the boxes that are left, for undecided boxes of at most that edge."""
    boxes, spent = solved(folder, ends, [f"{c} >= 0" for c in constraints()],
                          [f"--eps-min={edge}"])
    inner = boxes["solution"]
    undecided = boxes["boundary"] + boxes["unknown"] + boxes["pending"]
    gap = volume(undecided) / volume(inner) if inner else float("inf")
    return spent, gap, len(inner) + len(undecided)


def answer(folder, ends, patience):
    """Yes, no or neither, and the time for all constraints that were asked for."""
    spent, open_ones = 0, 0
    for constraint in constraints():
        options = [f"--eps-min={PRECISION}", "--stop-at-first", f"--timeout={patience}"]
        boxes, seconds = solved(folder, ends, [f"{constraint} < 0"], options)
        spent += seconds
        if boxes["solution"]:
            return "no", spent
        open_ones += any(boxes.values())
    return ("undecided" if open_ones else "yes"), spent
