"""Designs as Python objects: numbers stay as they are written, and nothing is rounded."""

from __future__ import annotations

import re
import tempfile
from contextlib import contextmanager
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any, Iterator, Mapping, Sequence, Union

Number = Union[int, str, Decimal, Fraction, float]
"""An exact number. A string may be a fraction, an expression (`"174.75*sqrt(3)/2"`) or a tolerance. A float
is accepted where it is exactly the decimal that Python prints for it, as 80.5 is, and 0.1 is not."""

Vector = Sequence[Number]


def plus_minus(value: Number, tolerance: Number) -> str:
    """The tolerance `value ± tolerance`."""
    return f"{_plain(value)} ± {_plain(tolerance)}"


def _plain(x: Number) -> str:
    """The text of a number in a design."""
    if isinstance(x, bool):
        raise TypeError(f"{x} is no number")
    if isinstance(x, str):
        return x
    if isinstance(x, int):
        return str(x)
    if isinstance(x, Fraction):
        return str(x)
    if isinstance(x, Decimal):
        if not x.is_finite():
            raise ValueError(f"{x} is no number")
        return format(x, "f")
    # numpy's scalars are told by what they are equal to.
    if hasattr(x, "item"):
        return _plain(x.item())
    if isinstance(x, float):
        if x != x or x in (float("inf"), float("-inf")):
            raise ValueError(f"{x} is no number")
        if Fraction(x) != Fraction(repr(x)):
            raise TypeError(
                f"{x!r} is a float, which is not the decimal that it is written as: "
                f"write '{x!r}', Decimal('{x!r}') or a Fraction"
            )
        return format(Decimal(repr(x)), "f")
    raise TypeError(f"{x!r} is no number")


_BARE = re.compile(r"[A-Za-z0-9_-]+\Z")


def _quoted(text: str) -> str:
    escaped = "".join(
        f"\\u{ord(c):04x}" if ord(c) < 32 or ord(c) == 127 else "\\" + c if c in '"\\' else c for c in text
    )
    return f'"{escaped}"'


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(k)} = {_toml(v)}" for k, v in value.items()) + " }"
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, (list, tuple)) and value and all(isinstance(item, Mapping) for item in value):
        return "[\n" + "".join(f"    {_toml(item)},\n" for item in value) + "]"
    if isinstance(value, (list, tuple)) or (hasattr(value, "tolist") and getattr(value, "ndim", 0) == 1):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    text = _plain(value)
    return text if re.match(r"-?[0-9]+(\.[0-9]+)?\Z", text) else _quoted(text)


def _key(key: str) -> str:
    return key if _BARE.match(key) else _quoted(key)


def slider(*, direction: Vector, anchor: Vector, length: Number, mode: str, **more: Any) -> dict[str, Any]:
    """A leg of fixed length on a linear guide."""
    return dict(drive="slider", direction=direction, anchor=anchor, length=length, mode=mode, **more)


def strut(*, anchor: Vector, platform: Vector, **more: Any) -> dict[str, Any]:
    """An extensible leg."""
    return dict(drive="strut", anchor=anchor, platform=platform, **more)


def arm(*, anchor: Vector, arm: Number, length: Number, mode: str, **more: Any) -> dict[str, Any]:
    """A leg of fixed length on an arm that a motor turns; `axis` and `reference` in space."""
    return dict(drive="arm", anchor=anchor, arm=arm, length=length, mode=mode, **more)


def planar(*, direction: Vector) -> dict[str, Any]:
    """A leg with a constant row."""
    return dict(drive="planar", direction=direction)


def linear_delta(*, radius: Number, arm: Number, platform: Number = 0) -> dict[str, Any]:
    """Three vertical guides, 120 degrees apart, the first at `+y`: the mechanism of 3-D printers.

    `radius` is that of the towers, `platform` that of the platform's joints, `arm` the legs' length.
    """
    r = f"({_plain(radius)})-({_plain(platform)})" if platform != 0 else _plain(radius)
    corners = [["0", r], [f"-({r})*sqrt(3)/2", f"-({r})/2"], [f"({r})*sqrt(3)/2", f"-({r})/2"]]
    legs = [slider(direction=[0, 0, 1], anchor=[x, y, 0], length=arm, mode="-") for x, y in corners]
    return dict(kind="translational", legs=legs)


@dataclass(frozen=True)
class Design:
    """A design: TOML text, or a file.

    Made by `Design.read`, `Design.parse`, or from tables with the keys of a design file, as
    `Design.of(mechanism={...}, workspace={...}, requirements={...})`.
    """

    toml: str
    """The text."""
    path: Path | None = None
    """The file, of designs that were read."""

    @staticmethod
    def read(path: Union[str, Path]) -> "Design":
        """The design of a file."""
        path = Path(path)
        return Design(path.read_text(encoding="utf-8"), path)

    @staticmethod
    def parse(toml: str) -> "Design":
        """The design of a text."""
        return Design(toml)

    @staticmethod
    def of(
        *,
        mechanism: Mapping[str, Any],
        workspace: Mapping[str, Any],
        requirements: Mapping[str, Any],
        title: str | None = None,
        unit: str | None = None,
    ) -> "Design":
        """A design of tables, with the keys of a design file. Their numbers are exact: see `Number`."""
        names = dict(title=title, unit=unit)
        tables = dict(mechanism=mechanism, workspace=workspace, requirements=requirements)
        return Design.from_dict({**{name: text for name, text in names.items() if text is not None}, **tables})

    @staticmethod
    def from_dict(tables: Mapping[str, Any]) -> "Design":
        """A design of one dictionary, as a TOML reader gives it: what is none, the program says of it."""
        lines = [f"{_key(key)} = {_toml(value)}" for key, value in tables.items() if not isinstance(value, Mapping)]
        for name, table in tables.items():
            if isinstance(table, Mapping):
                lines += ["", f"[{_key(name)}]"]
                lines += [f"{_key(key)} = {_toml(value)}" for key, value in table.items()]
        return Design("\n".join([*lines, ""]))

    def write(self, path: Union[str, Path]) -> "Design":
        """Writes the design, and returns that of the file."""
        path = Path(path)
        path.write_text(self.toml, encoding="utf-8")
        return Design(self.toml, path)

    def _repr_html_(self) -> str:
        import html

        return f"<pre>{html.escape(self.toml)}</pre>"


def as_design(design: Union[Design, str, Path, Mapping[str, Any]]) -> Design:
    """A design: itself, a file's path, TOML text (which has a line feed), or tables."""
    if isinstance(design, Design):
        return design
    if isinstance(design, Mapping):
        return Design.from_dict(design)
    if isinstance(design, str) and "\n" in design:
        return Design.parse(design)
    return Design.read(design)


@contextmanager
def folder_of(design: Design) -> Iterator[tuple[Path, Path]]:
    """A folder for what a command writes, and the design's file in it."""
    with tempfile.TemporaryDirectory(prefix="orthocert-") as folder:
        file = Path(folder) / (design.path.name if design.path else "design.toml")
        file.write_text(design.toml, encoding="utf-8")
        yield Path(folder), file
