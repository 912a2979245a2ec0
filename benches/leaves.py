#!/usr/bin/env python3
"""Leaves of proofs of bounds some percent beyond the worst value that `sampled.py` finds.

    python3 benches/leaves.py ORTHOCERT

ORTHOCERT is the program. Prints a table: machine, quantity, the sampled worst, and for each part beyond it
the leaves of the certificate that `verify` writes, and its processor time. Needs numpy.
"""

import argparse
import json
import os
import tempfile

import numpy as np

import sampled

CUBE = "min = [-73, -73, -73]\nmax = [126, 126, 126]"
SLAB = "min = [-60, -60, 0]\nmax = [60, 60, 1]"
ROOT3 = [("0", "1"), ("sqrt(3)/2", "-1/2"), ("-sqrt(3)/2", "-1/2")]


def legs(all_legs):
    return "\n".join("[[mechanism.legs]]\n" + "\n".join(f"{k} = {v}" for k, v in leg.items()) for leg in all_legs)


def orthoglide(length="310.7", tolerance="", rods=False):
    unit = lambda i, x: [x if i == j else f"0{tolerance}" for j in range(3)]  # noqa: E731
    each = [{"drive": '"slider"', "direction": [int(i == j) for j in range(3)],
             "anchor": json.dumps(unit(i, f"-383.8{tolerance}"), ensure_ascii=False),
             "length": json.dumps(length + tolerance, ensure_ascii=False), "mode": '"+"'} for i in range(3)]
    for i, leg in enumerate(each if rods else []):
        axis = [int(j == (i + 1) % 3) for j in range(3)]
        leg["platform"] = json.dumps([-40 if j == i else 0 for j in range(3)])
        leg["rod"] = f"{{ radius = 5, trim = [0, 0], spread = 40, axis = {axis} }}"
    return legs(each)


def delta(tolerance="", rods=False):
    each = [{"drive": '"slider"', "direction": [0, 0, 1],
             "anchor": json.dumps([f"(174.75*{x}){tolerance}", f"(174.75*{y}){tolerance}", f"0{tolerance}"],
                                  ensure_ascii=False),
             "length": json.dumps("333" + tolerance, ensure_ascii=False), "mode": '"-"'} for x, y in ROOT3]
    for leg, (x, y) in zip(each if rods else [], ROOT3):
        leg["platform"] = json.dumps([f"40*{x}", f"40*{y}", "0"])
        leg["rod"] = f'{{ radius = 5, trim = [0, 0], spread = 50, axis = ["-({y})", "{x}", 0] }}'
    return legs(each)


def struts(tolerance=""):
    anchors = ["-300", "-180", "0"], ["310", "-170", "10"], ["5", "340", "-5"]
    return legs({"drive": '"strut"', "anchor": json.dumps([x + tolerance for x in a], ensure_ascii=False)} for a in anchors)


def rotary(half):
    each = []
    for x, y in ROOT3:
        across = f"-({y})", x
        each.append({"drive": '"arm"', "anchor": json.dumps([f"10*{x}", f"10*{y}", "0"]),
                     "axis": json.dumps([across[0], across[1], "0"]), "reference": json.dumps([x, y, "0"]),
                     "arm": 10, "length": 14, "platform": json.dumps([f"6*{x}", f"6*{y}", "0"]), "mode": '"-"'})
    return legs(each), f"min = [-{half}, -{half}, -14]\nmax = [{half}, {half}, -10]"


BOX = "min = [-60, -60, 180]\nmax = [60, 60, 260]"
LESS = "min = [-71, -71, -71]\nmax = [119, 119, 119]"
FORCE, OFF = "joint_force = {{ tool = 1, max = {} }}", "accuracy = {{ joint_error = 0.01, max = {} }}"
ROWS = [
    ("Orthoglide", orthoglide(), CUBE, "joint force", FORCE, [10, 1, 0.1], [10, 15, 21]),
    ("linear Delta", delta(), SLAB, "joint force", FORCE, [10, 1, 0.1], [8, 32, 76]),
    ("struts", struts(), BOX, "joint force", FORCE, [10, 1, 0.1], [12, 81, 166]),
    ("Orthoglide, ±0.02", orthoglide(tolerance=" ± 0.02"), LESS, "accuracy", OFF, [10, 2, 1], [8, 14, 16]),
    ("linear Delta, ±0.02", delta(" ± 0.02"), SLAB, "accuracy", OFF, [10, 2, 1], [10, 34, 58]),
    ("struts, ±0.02", struts(" ± 0.02"), BOX, "accuracy", OFF, [10, 2, 1], [12, 43, 74]),
    ("Orthoglide, rods", orthoglide(rods=True), LESS, "clearance", "clearance = {{ min = {} }}",
     [10, 3, 1], [52, 169, 422]),
    ("linear Delta, rods", delta(rods=True), SLAB, "clearance", "clearance = {{ min = {} }}",
     [10, 3, 1], [1, 1, 1]),
]
ONE = [
    ("Orthoglide, [-72, 125]^3", orthoglide("310.7"), "min = [-72, -72, -72]\nmax = [125, 125, 125]", 1),
    ("Orthoglide, [-124, 175]^3", orthoglide("310.7"), "min = [-124, -124, -124]\nmax = [175, 175, 175]", 5),
    ("linear Delta", delta(), "min = [-80, -80, 0]\nmax = [80, 80, 200]", 1),
    *[(f"rotary Delta, ±{half}", *rotary(half), most) for half, most in [(3, 8), (7, 133)]],
]


def design(machine, workspace, require):
    return f'[mechanism]\nkind = "translational"\n{machine}\n[workspace]\n{workspace}\n[requirements]\n{require}\n'


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    program = parser.parse_args().program
    print("| machine | quantity | sampled worst | beyond, % | leaves | prototype | s |\n|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name, machine, workspace, quantity, require, parts, known in ROWS:
            path = os.path.join(folder, "own.toml")
            with open(path, "w", encoding="utf-8") as file:
                file.write(design(machine, workspace, require.format(1)))
            own, rng = sampled.Design(path), np.random.default_rng(1)
            end = "least" if quantity == "clearance" else "greatest"
            f, size, corners = sampled.quantities(own, [(quantity, end)])[quantity, end]
            _, worst, _, _ = sampled.worst(own, quantity, end, f, size, corners, 20_000, rng)
            for i, part in enumerate(parts):
                bound = worst * (1 + part / 100 if end == "greatest" else 1 - part / 100)
                text = design(machine, workspace, require.format(repr(float(bound))))
                verdict, leaves, seconds = sampled.verify(program, text, folder, 600)
                said = leaves if verdict == "certified" else verdict
                print(f"| {name} | {quantity} | {worst:.6g} | {part:g} | {said} | {known[i] if known else ''} | {seconds:.2f} |",
                      flush=True)
        for name, machine, workspace, known in ONE:
            verdict, leaves, seconds = sampled.verify(program, design(machine, workspace, "one_to_one = true"), folder, 600)
            said = leaves if verdict == "certified" else verdict
            print(f"| {name} | one to one | | | {said} | {known} | {seconds:.2f} |", flush=True)


if __name__ == "__main__":
    main()
