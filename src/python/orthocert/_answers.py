"""What the commands answer. Exact numbers are `Fraction`s; sampled ones are floats."""

from __future__ import annotations

import html
from dataclasses import dataclass, field
from decimal import MAX_PREC, ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from fractions import Fraction
from typing import Any, Optional, Sequence, Tuple

import numpy as np

from . import _paving

Point = tuple[Fraction, ...]


def _exact(text: Optional[str]) -> Optional[Fraction]:
    return None if text is None else Fraction(text)


def _point(numbers: Optional[Sequence[str]]) -> Optional[Point]:
    """A point in exact numbers; none where one of them has roots."""
    try:
        return None if numbers is None else tuple(Fraction(x) for x in numbers)
    except ValueError:
        return None


def _table(head: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    def line(tag: str, cells: Sequence[Any]) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(str(x))}</{tag}>" for x in cells) + "</tr>"

    return "<table>" + line("th", head) + "".join(line("td", row) for row in rows) + "</table>"


def _decimal(x: Any) -> str:
    return "" if x is None else f"{float(x):.7g}"


def _rounded(x: Optional[Fraction], rounding: str) -> str:
    """Seven digits of an exact number, on the side of it that proves no more than it does."""
    if x is None:
        return ""
    found = Context(prec=7, rounding=rounding).divide(Decimal(x.numerator), Decimal(x.denominator))
    return format(found.normalize(), "f" if -7 < found.adjusted() < 12 else "e")


def _below(x: Optional[Fraction]) -> str:
    return _rounded(x, ROUND_FLOOR)


def _above(x: Optional[Fraction]) -> str:
    return _rounded(x, ROUND_CEILING)


def _written(x: Optional[Fraction]) -> str:
    """An exact number as it is: a decimal, or a fraction."""
    if x is None:
        return ""
    places = 0
    while x.denominator > 1 and places < 40:
        scaled = x * 10**places
        if scaled.denominator == 1:
            return format(Decimal(scaled.numerator).scaleb(-places, Context(prec=MAX_PREC)), "f")
        places += 1
    return str(x)


def _unit(unit: Optional[str], answer: dict[str, Any]) -> str:
    """A unit, with the design's for lengths."""
    return (unit or "").replace("length", answer.get("length_unit") or "length")


def _titled(verdict: str, title: Optional[str]) -> str:
    return verdict.upper() + (f": {html.escape(title)}" if title else "")


@dataclass(frozen=True)
class Requirement:
    """One requirement, and the worst value that sampling found: it proves nothing."""

    requirement: str
    bound: str
    worst_found: Optional[float]
    at: Optional[tuple[float, ...]]
    unit: Optional[str] = None


@dataclass(frozen=True)
class Counterexample:
    """Why a design is refuted: proved, at this point."""

    violated: str
    value: str
    point: Optional[Point]
    machine: Any = None
    #: Of bodies that are too near: what they are, and nearly where, if that is one place.
    bodies: Tuple[Tuple[str, Optional[Tuple[float, ...]]], ...] = ()


def _limit(found: Optional[Counterexample]) -> str:
    return f"<p>limited by {html.escape(found.violated)}</p>" if found else ""


@dataclass(frozen=True)
class Verification:
    """The verdict on a design, with its certificate: "certified", "refuted" or "undecided"."""

    verdict: str
    title: Optional[str]
    coordinates: tuple[str, ...]
    requirements: tuple[Requirement, ...]
    counterexample: Optional[Counterexample]
    boxes: int
    seconds: float
    certificate: Optional[bytes]
    """The certificate's bytes: none of an undecided design."""
    answer: dict[str, Any] = field(repr=False)
    """All that the program answered."""
    figure: str = field(default="", repr=False)
    """A drawing of the machine, an SVG; empty where there is none."""

    def __bool__(self) -> bool:
        """Whether it is certified."""
        return self.verdict == "certified"

    def save(self, path: Any) -> None:
        """Writes the certificate."""
        if self.certificate is None:
            raise ValueError("an undecided design has no certificate")
        with open(path, "wb") as file:
            file.write(self.certificate)

    def _repr_html_(self) -> str:
        colour = {"certified": "#0b6b3a", "refuted": "#a3261b"}.get(self.verdict, "#8a6100")
        out = f"<p style='font-weight:bold;color:{colour}'>{_titled(self.verdict, self.title)}</p>"
        if self.counterexample:
            at = ", ".join(_decimal(x) for x in self.counterexample.point or ())
            out += f"<p>{html.escape(self.counterexample.value)} at ({at})</p>"
        rows = [
            (r.requirement, r.bound, _decimal(r.worst_found), ", ".join(_decimal(x) for x in r.at or ()))
            for r in self.requirements
        ]
        return out + _table(("requirement", "bound", "worst found", "at"), rows) + self.figure

    def plot(self, ax: Any = None) -> Any:
        """How near the worst found is to each bound, as a share of it; matplotlib's axes."""
        shares, names = [], []
        for r in self.requirements:
            words = r.bound.split()
            try:
                bound = float(Fraction(words[-1]))
            except (ValueError, IndexError, ZeroDivisionError):
                continue
            if r.worst_found is None or bound == 0:
                continue
            room = (
                (bound - r.worst_found) / abs(bound)
                if words[0].startswith("<")
                else (r.worst_found - bound) / abs(bound)
            )
            shares.append(100 * room)
            names.append(f"{r.requirement} {r.bound}")
        ax = ax or _axes()
        ax.barh(names, shares, color=["#0b6b3a" if s >= 0 else "#a3261b" for s in shares])
        ax.axvline(0, color="black", linewidth=1)
        ax.set_xlabel("room to the bound, % (sampled)")
        ax.invert_yaxis()
        ax.set_title(f"{self.title or 'design'}: {self.verdict}")
        return ax


@dataclass(frozen=True)
class Bound:
    """An extreme of a quantity: proved to lie between `min` and `max`, one end of which is reached at `point`."""

    quantity: str
    end: str
    min: Optional[Fraction]
    max: Optional[Fraction]
    point: Optional[Point]
    unit: Optional[str] = None


@dataclass(frozen=True)
class Bounds(Sequence[Bound]):
    """The extremes of all quantities of a design."""

    bounds: tuple[Bound, ...]
    answer: dict[str, Any] = field(repr=False)

    def __len__(self) -> int:
        return len(self.bounds)

    def __getitem__(self, at: Any) -> Any:
        return self.bounds[at]

    def of(self, quantity: str, end: str) -> Bound:
        """That of a quantity, `end` "least" or "greatest"."""
        for bound in self.bounds:
            if (bound.quantity, bound.end) == (quantity, end):
                return bound
        raise KeyError(f"{end} {quantity}: there are {', '.join(f'{b.end} {b.quantity}' for b in self.bounds)}")

    def to_numpy(self) -> np.ndarray:
        """The enclosures, nearest doubles: an array of shape (bounds, 2)."""
        nan = float("nan")
        return np.array([[nan if x is None else float(x) for x in (b.min, b.max)] for b in self.bounds]).reshape(-1, 2)

    def _repr_html_(self) -> str:
        rows = [
            (
                f"{b.end} {b.quantity}",
                _below(b.min),
                _above(b.max),
                _unit(b.unit, self.answer),
                ", ".join(_decimal(x) for x in b.point or ()),
            )
            for b in self.bounds
        ]
        return _table(("extreme", "at least", "at most", "unit", "at"), rows)


@dataclass(frozen=True)
class Side:
    """One side of a limit: a certified value, and a refuted one beyond it."""

    side: str
    certified: Optional[Fraction]
    refuted: Optional[Fraction]
    limited_by: Optional[Counterexample]
    reason: Optional[str]
    """Why the search ended where nothing is refuted."""


@dataclass(frozen=True)
class Limit:
    """How far one number of a design can go."""

    key: str
    own: str
    sides: tuple[Side, ...]
    answer: dict[str, Any] = field(repr=False)

    @property
    def lower(self) -> Optional[Side]:
        """The lower side, if it was searched."""
        return next((s for s in self.sides if s.side == "lower"), None)

    @property
    def upper(self) -> Optional[Side]:
        """The upper side, if it was searched."""
        return next((s for s in self.sides if s.side == "upper"), None)

    def _repr_html_(self) -> str:
        rows = [
            (
                s.side,
                _written(s.certified),
                _written(s.refuted),
                s.limited_by.violated if s.limited_by else s.reason or "",
            )
            for s in self.sides
        ]
        return f"<p>{html.escape(self.key)}, {html.escape(self.own)} in the design</p>" + _table(
            ("side", "certified", "refuted", "limited by"), rows
        )

    def plot(self, ax: Any = None) -> Any:
        """The certified values on a line, between which nothing is claimed, and the refuted ones beyond;
        matplotlib's axes."""
        ax = ax or _axes()
        ends = [float(s.certified) for s in self.sides if s.certified is not None]
        ax.axhline(0, color="#00000030", linewidth=1, zorder=0)
        if ends:
            ax.plot(ends, [0] * len(ends), "o", color="#0b6b3a", markersize=9, linestyle="none", label="certified")
        for s in self.sides:
            if s.refuted is not None:
                ax.plot(float(s.refuted), 0, "x", color="#a3261b", markersize=12, label=f"refuted, {s.side}")
        ax.set_yticks([])
        ax.set_xlabel(self.key)
        ax.legend()
        return ax


@dataclass(frozen=True)
class Widest:
    """The widest tolerance of parameters of some kinds: a certified one, and a refuted one beyond it."""

    on: tuple[str, ...]
    leg: Optional[int]
    """The leg whose parameters these are, counted from one; none where those of all legs are widened."""
    measure: str
    """What the numbers are: "length" in the design's unit, "component" of a direction, "share" of the other rows."""
    certified: Optional[Fraction]
    refuted: Optional[Fraction]
    limited_by: Optional[Counterexample]


@dataclass(frozen=True)
class Tolerance(Sequence[Widest]):
    """The widest tolerances with which a design is still certified, kind by kind."""

    rows: tuple[Widest, ...]
    answer: dict[str, Any] = field(repr=False)

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, at: Any) -> Any:
        return self.rows[at]

    def _repr_html_(self) -> str:
        rows = [
            (
                ", ".join(w.on) + (f" of leg {w.leg}" if w.leg else "") + f", {w.measure}",
                _written(w.certified),
                _written(w.refuted),
                w.limited_by.violated if w.limited_by else "",
            )
            for w in self.rows
        ]
        return _table(("tolerance, plus or minus", "certified", "refuted", "limited by"), rows)


@dataclass(frozen=True)
class Size:
    """The smallest size of a machine for a cube: a leg length where that is its size, else a scale of the whole."""

    unknown: str
    certified: Optional[Fraction]
    refuted: Optional[Fraction]
    """A size that is refuted for the cube's place, or for every one, as `answer["refuted_for"]` says."""
    excluded: Optional[Fraction]
    """A size that is refuted for every axis-aligned place of the cube, where that was asked too."""
    centre: Optional[Point]
    limited_by: Optional[Counterexample]
    answer: dict[str, Any] = field(repr=False)

    def _repr_html_(self) -> str:
        rows = [(name, _written(getattr(self, name))) for name in ("certified", "refuted", "excluded")]
        return _table((self.unknown, ""), rows) + _limit(self.limited_by)


@dataclass(frozen=True)
class LargestCube:
    """The largest axis-aligned cube in a workspace: a side that fits, and one that does not."""

    certified: Optional[str]
    """Exact: a decimal, a fraction, or an expression, as in a design file."""
    centre: Optional[Point]
    refuted: Optional[str]
    """A side that fits nowhere; of platforms that turn, one that does not fit about this centre."""
    limited_by: Optional[Counterexample]
    answer: dict[str, Any] = field(repr=False)

    def _repr_html_(self) -> str:
        return _table(("certified side", "refuted side"), [(self.certified or "", self.refuted or "")]) + _limit(self.limited_by)


@dataclass(frozen=True)
class Value:
    """A line of a summary: what is certified, and what some point reaches."""

    words: str
    quantity: str
    end: str
    certified: Optional[Fraction]
    reached: Optional[Fraction]
    unit: Optional[str] = None


@dataclass(frozen=True)
class Summary:
    """What a designer reads first."""

    verdict: str
    title: Optional[str]
    nearest: Optional[dict[str, Any]]
    values: tuple[Value, ...]
    answer: dict[str, Any] = field(repr=False)

    def _repr_html_(self) -> str:
        out = f"<p><b>{_titled(self.verdict, self.title)}</b></p>"
        if self.nearest:
            out += f"<p>nearest to its limit: {html.escape(str(self.nearest.get('requirement')))} {html.escape(str(self.nearest.get('bound')))}</p>"
        rows = []
        for v in self.values:
            # What is certified holds everywhere, what is reached does somewhere.
            outward, inward = (_below, _above) if v.end == "least" else (_above, _below)
            rows.append((f"{v.end} {v.words}", outward(v.certified), inward(v.reached), _unit(v.unit, self.answer)))
        return out + _table(("value", "certified", "reached", "unit"), rows)


@dataclass(frozen=True)
class Paving:
    """A box cut into cells where all requirements hold, where some fails, and the rest."""

    inner_share: Fraction
    outer_share: Fraction
    undecided_share: Fraction
    inner_volume: Optional[Fraction]
    file: bytes = field(repr=False)
    """The paving's file, which `orthocert check` re-proves."""
    answer: dict[str, Any] = field(repr=False)

    def save(self, path: Any) -> None:
        """Writes the file."""
        with open(path, "wb") as file:
            file.write(self.file)

    def boxes(self) -> dict[str, np.ndarray]:
        """Arrays of shape (boxes, coordinates, 2), "inner", "outer", "undecided", and "mirrored": those that are
        left out because the machine and its box are symmetric. Boxes that planes cut are in boxes of a quarter
        of their edges, so that less is inner than `inner_share` says."""
        return _paving.boxes(self.file)

    def _repr_html_(self) -> str:
        rows = [
            ("inner", _below(self.inner_share), _below(self.inner_volume)),
            ("outer", _below(self.outer_share), ""),
            ("undecided", _above(self.undecided_share), ""),
        ]
        return _table(("part", "share", "volume"), rows)

    def plot(self, ax: Any = None, *, across: int = -1, at: Optional[float] = None) -> Any:
        """The cells in a section: of three coordinates that across one, at a value (the middle of the box
        without); of a symmetric paving, the part that is kept. matplotlib's axes."""
        from matplotlib.collections import PolyCollection

        ax = ax or _axes()
        cells = self.boxes()
        every = np.concatenate([c for c in cells.values() if len(c)])
        count = every.shape[1]
        shown = [k for k in range(count) if count < 3 or k != across % count][:2]
        if count == 3:
            k = across % 3
            at = float((every[:, k, 0].min() + every[:, k, 1].max()) / 2) if at is None else at
        colours = {"inner": "#7cc49a", "outer": "#e7a29b", "undecided": "#f2d48a", "mirrored": "#eeeeee"}
        for kind, boxes in cells.items():
            if count == 3 and len(boxes):
                boxes = boxes[(boxes[:, k, 0] <= at) & (at <= boxes[:, k, 1])]
            if not len(boxes):
                continue
            x = boxes[:, shown[0]]
            y = boxes[:, shown[1]] if len(shown) > 1 else np.tile([0.0, 1.0], (len(boxes), 1))
            corners = np.stack(
                [np.stack([x[:, i], y[:, j]], axis=1) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))], axis=1
            )
            ax.add_collection(
                PolyCollection(
                    list(corners), facecolors=colours[kind], edgecolors="#00000030", linewidths=0.3, label=kind
                )
            )
        ax.autoscale()
        if len(shown) > 1:
            ax.set_aspect("equal")
        ax.legend()
        return ax


@dataclass(frozen=True)
class Check:
    """What the exact checker says of a certificate."""

    accepted: bool
    verdict: Optional[str]
    statement: Optional[str]
    """The theorem, in words."""
    reason: Optional[str]
    """Why it is rejected."""
    answer: dict[str, Any] = field(repr=False)

    def __bool__(self) -> bool:
        """Whether the certificate is accepted and certifies."""
        return self.accepted and self.verdict == "certified"

    def _repr_html_(self) -> str:
        word = self.verdict.upper() if self.accepted and self.verdict else "REJECTED"
        return f"<p><b>{word}</b></p><pre>{html.escape(self.statement or self.reason or '')}</pre>"


@dataclass(frozen=True)
class Report:
    """A page about a certificate: one HTML file that proves itself again when it is opened."""

    html: str = field(repr=False)

    def save(self, path: Any) -> None:
        """Writes the page."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.html)

    def _repr_html_(self) -> str:
        return f'<iframe sandbox="allow-scripts" style="width:100%;height:700px;border:0" srcdoc="{html.escape(self.html)}"></iframe>'


def _axes() -> Any:
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ImportError("plot() needs matplotlib: pip install 'orthocert[plot]'") from error
    return plt.subplots(figsize=(7, 4))[1]
