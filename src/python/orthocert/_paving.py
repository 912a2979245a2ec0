"""The boxes of a paving: section 18 of FORMAT.md, without what proves them."""

from __future__ import annotations

import ast
import json
import math
from fractions import Fraction
from typing import Any

import numpy as np

from ._program import OrthocertError


class _Bytes:
    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 0

    def byte(self) -> int:
        self.at += 1
        return self.data[self.at - 1]

    def integer(self) -> None:
        while self.byte() & 0x80:
            pass

    def list(self) -> None:
        for _ in range(self.byte()):
            self.integer()

    def matrix(self) -> None:
        self.byte()
        self.lists()

    def lists(self) -> None:
        for _ in range(self.byte()):
            self.list()


def _steps(nodes: _Bytes) -> int:
    """Skips a node's steps; its kind's byte."""
    while True:
        kind = nodes.byte()
        if 0x10 <= kind < 0x20:
            continue
        if kind != 0x09:
            return kind
        nodes.integer()
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
    box = header["claim"]["machine"]["workspace"]["box"]
    least = [_value(x) for x in box["min"]]
    width = [_value(y) - _value(x) for x, y in zip(box["min"], box["max"])]
    found: dict[str, list[list[tuple[float, float]]]] = {"inner": [], "outer": [], "undecided": [], "mirrored": []}
    nodes = _Bytes(rest)
    whole = [(0, 0)] * len(least)
    waiting = [whole]
    short = ["inner", "undecided", "mirrored", "outer", "outer"]

    def edge(k: int, i: int, level: int) -> tuple[float, float]:
        return float(least[k] + width[k] * i / 2**level), float(least[k] + width[k] * (i + 1) / 2**level)

    def add(kind: str, cell: list[tuple[int, int]]) -> None:
        found[kind].append([edge(k, i, level) for k, (i, level) in enumerate(cell)])

    while waiting:
        cell = waiting.pop()
        kind = _steps(nodes)
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
        if kind == 0x07:
            nodes.integer()
            nodes.integer()
        elif kind == 0x08:
            nodes.integer()
            nodes.lists()
        name = {3: "inner", 4: "undecided", 5: "mirrored"}.get(kind, "outer")
        add(name, cell)
    shape = (-1, len(least), 2)
    return {kind: np.array(cells, dtype=float).reshape(shape) for kind, cells in found.items()}


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
