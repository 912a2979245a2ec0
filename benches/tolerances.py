#!/usr/bin/env python3
"""How tightly machines with tolerances are enclosed: the tables of benches/runs/tolerances.md.

    python3 benches/tolerances.py bounds orthocert tests/designs/*.toml tests/designs/kernel/*.toml
    python3 benches/tolerances.py tolerance orthocert tests/designs/*.toml --on direction

`bounds --relative 1e-4` of every design that has tolerances: the extremes whose enclosures are wider than that, with
their relative widths. `tolerance --gap 0.01` of every design: of each row the certified and the refuted tolerance, and
the gap. What follows the designs is passed on. Times are the processor's, of one thread.
"""

import json
import resource
import subprocess
import sys
import tomllib
from fractions import Fraction
from pathlib import Path

ASKED = {
    "bounds": ["--relative", "1e-4", "--timeout", "120"],
    "tolerance": ["--gap", "0.01", "--timeout", "60"],
}


def has_tolerances(part):
    if isinstance(part, dict):
        return set(part) == {"min", "max"} or any(map(has_tolerances, part.values()))
    if isinstance(part, list):
        return any(map(has_tolerances, part))
    return isinstance(part, str) and "±" in part


def answer(kind, program, design, flags):
    """The answer's rows, or what was said instead, and the time that it took."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    command = [program, kind, design, *ASKED[kind], "--threads", "1", "--format", "json", *flags]
    done = subprocess.run(command, capture_output=True, text=True)
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    try:
        return json.loads(done.stdout)["bounds" if kind == "bounds" else "tolerances"], seconds
    except (ValueError, KeyError):
        return done.stderr.strip(), seconds


def wide(bound):
    """An extreme that is enclosed less tightly than asked for."""
    if bound.get("min") is None or bound.get("max") is None:
        return f"{bound['quantity']} {bound['end']} not enclosed"
    if float(bound["relative"]) > 1e-4:
        return f"{bound['quantity']} {bound['end']} {bound['relative']}"
    return None


def row(tolerance):
    certified, refuted = (tolerance.get(end) for end in ("certified", "refuted"))
    ends = ["none" if end is None else f"{float(Fraction(end)):.4g}" for end in (certified, refuted)]
    return f"{', '.join(tolerance['on'])} {ends[0]} of {ends[1]}, gap {tolerance.get('gap')}"


def main():
    kind, program, *rest = sys.argv[1:]
    designs = [Path(name) for name in rest if name.endswith(".toml")]
    flags = [flag for flag in rest if not flag.endswith(".toml")]
    print("| design | processor, s | |\n|---|---|---|")
    for design in designs:
        mechanism = tomllib.loads(design.read_text())["mechanism"]
        if kind == "bounds" and not has_tolerances(mechanism):
            continue
        found, seconds = answer(kind, program, str(design), flags)
        if isinstance(found, list):
            cells = filter(None, map(wide, found)) if kind == "bounds" else map(row, found)
            found = "; ".join(cells) or "all within 1e-4"
        print(f"| {design.stem} | {seconds:.1f} | {found.replace('|', chr(92) + '|')} |", flush=True)


if __name__ == "__main__":
    main()
