"""The boxes of a paving: section 18 of FORMAT.md, without what proves them."""

from __future__ import annotations

import ast
import json
import math
from fractions import Fraction
from typing import Any

import numpy as np

from ._program import OrthocertError


# How often a cell that planes cut is halved.
_CUT_LEVELS = 6


class _Bytes:
    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 0

    def byte(self) -> int:
        self.at += 1
        return self.data[self.at - 1]

    def integer(self) -> int:
        n, shift = 0, 0
        while True:
            byte = self.byte()
            n |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                return n >> 1 if n % 2 == 0 else -(n >> 1) - 1

    def list(self) -> list[int]:
        return [self.integer() for _ in range(self.byte())]

    def matrix(self) -> None:
        self.byte()
        self.lists()

    def lists(self) -> None:
        for _ in range(self.byte()):
            self.list()


def _steps(nodes: _Bytes) -> int:
    """Skips a node's steps, and the values of other coordinates; its kind's byte."""
    while True:
        kind = nodes.byte()
        if 0x10 <= kind < 0x20:
            continue
        if kind == 0x0A:
            nodes.list()
            continue
        if kind != 0x09:
            return kind
        nodes.byte()
        tag = nodes.byte()
        while tag in (9, 10, 11):
            nodes.list()
            tag = nodes.byte()
        if tag in (2, 3, 4, 7):
            nodes.matrix()
        elif tag in (5, 6):
            nodes.matrix()
            nodes.list()
        elif tag not in (0, 1, 8):
            raise OrthocertError(f"a paving with the evidence {tag:#x}")


def boxes(data: bytes) -> dict[str, Any]:
    """Arrays of shape (boxes, coordinates, 2) by kind, in the design's unit, nearest doubles."""
    first, _, rest = data.partition(b"\n")
    header = json.loads(first)
    if header.get("format") != "orthocert-paving/3":
        raise OrthocertError(f"no paving of the format orthocert-paving/3: {header.get('format')!r}")
    ranges = _ranges(header["claim"]["machine"], header.get("coordinates"))
    least = [_value(x) for x, _ in ranges]
    width = [_value(y) - _value(x) for x, y in ranges]
    found: dict[str, list[list[tuple[float, float]]]] = {"inner": [], "outer": [], "undecided": [], "mirrored": []}
    nodes = _Bytes(rest)
    whole = [(0, 0)] * len(least)
    waiting = [whole]
    short = ["inner", "undecided", "mirrored", "outer", "outer"]

    def edge(k: int, i: int, level: int) -> tuple[float, float]:
        return float(least[k] + width[k] * i / 2**level), float(least[k] + width[k] * (i + 1) / 2**level)

    def add(kind: str, cell: list[tuple[int, int]]) -> None:
        found[kind].append([edge(k, i, level) for k, (i, level) in enumerate(cell)])

    def add_cut(cell: list[tuple[int, int]], normal: list[int], ends: list[int], levels: int, sides: Any) -> None:
        """Adds a cell that planes cut: in boxes before the one, beyond the other, and between them."""
        least = sum(min(n * lo, n * hi) for n, (lo, hi) in zip(normal, sides))
        most = sum(max(n * lo, n * hi) for n, (lo, hi) in zip(normal, sides))
        if most <= ends[0] or least >= ends[1] or levels == 0:
            add("inner" if most <= ends[0] else "outer" if least >= ends[1] else "undecided", cell)
            return
        k = max(range(len(cell)), key=lambda k: abs(normal[k]) * (sides[k][1] - sides[k][0]))
        (i, level), (lo, hi) = cell[k], sides[k]
        for upper, side in enumerate(((lo, (lo + hi) / 2), ((lo + hi) / 2, hi))):
            half = cell[:k] + [(2 * i + upper, level + 1)] + cell[k + 1 :]
            add_cut(half, normal, ends, levels - 1, sides[:k] + [side] + sides[k + 1 :])

    while waiting:
        cell = waiting.pop()
        kind = _steps(nodes)
        if 0x20 <= kind < 0x25:  # In parts: inner, whatever these are in.
            parts_left = 2
            while parts_left:
                parts_left += 1 if 0x20 <= _steps(nodes) < 0x25 else -1
            kind = 3
        if kind <= 2 or kind >= 0x80:
            k, halves = (kind, None) if kind <= 2 else ((kind - 0x80) // 25, (kind - 0x80) % 25)
            i, level = cell[k]
            parts = [cell[:k] + [(2 * i + upper, level + 1)] + cell[k + 1 :] for upper in (0, 1)]
            if halves is None:
                waiting += reversed(parts)
            else:
                add(short[halves // 5], parts[0])
                add(short[halves % 5], parts[1])
            continue
        if kind == 0x0C:
            normal, ends = nodes.list(), nodes.list()
            nodes.byte()
            add_cut(cell, normal, ends, _CUT_LEVELS, [(-1.0, 1.0)] * len(cell))
            continue
        if kind == 0x07:
            nodes.byte()
            nodes.byte()
        elif kind == 0x08:
            nodes.byte()
            nodes.lists()
        name = {3: "inner", 4: "undecided", 5: "mirrored"}.get(kind, "outer")
        add(name, cell)
    shape = (-1, len(least), 2)
    return {kind: np.array(cells, dtype=float).reshape(shape) for kind, cells in found.items()}


def _ranges(claim: dict[str, Any], coordinates: list[str] | None) -> list[tuple[str, str]]:
    """The ends of what is paved, angles in degrees."""
    workspace = claim["workspace"]
    if coordinates is None:
        return list(zip(workspace["box"]["min"], workspace["box"]["max"]))
    found: dict[str, tuple[str, str]] = {}
    if "box" in workspace:
        formulas = claim["mechanism"].get("formulas")
        names = formulas["coordinates"] if formulas else "xyz"
        found.update(zip(names, zip(workspace["box"]["min"], workspace["box"]["max"])))
    else:
        found["z"] = tuple(workspace["cylinder"]["z"])
    turned = claim.get("orientation", {})
    found.update({name: tuple(ends) for name, ends in turned.get("roll_pitch_yaw", {}).items()})
    if "range" in turned:
        found["angle"] = tuple(turned["range"])
    return [found[name] for name in coordinates]


def _value(number: str) -> Fraction:
    """A number of a claim; with roots, as a nearby double, since boxes are for looking at."""
    try:
        return Fraction(number)
    except ValueError:
        return Fraction(_evaluated(ast.parse(number.replace("^", "**"), mode="eval").body))


def _evaluated(node: ast.expr) -> float:
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
        return float(node.value)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return -_evaluated(node.operand)
    if isinstance(node, ast.BinOp):
        a, b = _evaluated(node.left), _evaluated(node.right)
        if isinstance(node.op, ast.Add):
            return a + b
        if isinstance(node.op, ast.Sub):
            return a - b
        if isinstance(node.op, ast.Mult):
            return a * b
        if isinstance(node.op, ast.Div):
            return a / b
        if isinstance(node.op, ast.Pow):
            return math.pow(a, b)
    if (
        isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id == "sqrt"
        and len(node.args) == 1
    ):
        return math.sqrt(_evaluated(node.args[0]))
    raise OrthocertError("a number of the paving's claim cannot be read")
