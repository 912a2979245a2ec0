"""Certified workspace verification of parallel machines.

    import orthocert as oc
    design = oc.Design.of(
        title="A printer",
        mechanism=oc.linear_delta(radius="174.75", arm=333),
        workspace={"cylinder": {"center": [0, 0], "radius": 80, "z": [0, 200]}},
        requirements={"transmission": {"min": "1/2", "max": "3/2"}},
    )
    oc.verify(design)                 # certified, refuted, or undecided; with the certificate
    oc.limit(design, "workspace.cylinder.radius", gap="1e-3").upper.certified

Every function runs the program `orthocert`, which the package brings, and answers as it does: verdicts are those of
its exact checker, and errors its own sentences. Functions take a `Design`, a file's path, TOML text, or a dictionary.
"""

from __future__ import annotations

import json
import threading
from fractions import Fraction
from pathlib import Path
from typing import Any, Mapping, Optional, Sequence, Union

from ._answers import (
    Bound,
    Bounds,
    Check,
    Counterexample,
    LargestCube,
    Limit,
    Paving,
    Report,
    Requirement,
    Side,
    Size,
    Summary,
    Tolerance,
    Value,
    Verification,
    Widest,
    _exact,
    _point,
)
from ._design import Design, Number, _plain, arm, as_design, folder_of, linear_delta, planar, plus_minus, slider, strut
from ._program import DesignError, OrthocertError, Progress, Unfinished, answer, program, run

AnyDesign = Union[Design, str, Path, Mapping[str, Any]]

__all__ = [
    "Bound", "Bounds", "Check", "Counterexample", "Design", "DesignError", "LargestCube", "Limit", "OrthocertError",
    "Paving", "Report", "Requirement", "Side", "Size", "Summary", "Tolerance", "Unfinished", "Value",
    "Verification", "Widest", "arm", "bounds", "check", "largest_cube", "limit", "linear_delta", "pave", "planar",
    "plus_minus", "program", "report", "size", "slider", "strut", "summary", "tolerance", "verify", "version",
]  # fmt: skip


def version() -> str:
    """The program's version."""
    return run(["--version"])[1].split()[-1]


def _flags(**options: Optional[Any]) -> list[str]:
    """`max_boxes=100` as `--max-boxes 100`, and so on; what is None is left out."""
    flags: list[str] = []
    for name, value in options.items():
        if value is True:
            flags.append("--" + name.replace("_", "-"))
        elif value is not None and value is not False:
            flags += ["--" + name.replace("_", "-"), _plain(value)]
    return flags


def _asked(
    command: str,
    design: AnyDesign,
    *arguments: str,
    progress: Optional[Progress],
    cancel: Optional[threading.Event],
    **options: Optional[Any],
) -> dict[str, Any]:
    """What a command answers about a design."""
    with folder_of(as_design(design)) as (folder, file):
        called = [command, file.name, *arguments, *_flags(**options)]
        return answer(called, folder=folder, progress=progress, cancel=cancel)


def _counterexample(found: Optional[Mapping[str, Any]]) -> Optional[Counterexample]:
    if not found:
        return None
    bodies = ((near["body"], tuple(near["point"]) if "point" in near else None) for near in found.get("bodies", ()))
    point = _point(found.get("point"))
    return Counterexample(found["violated"], found["value"], point, found.get("machine"), tuple(bodies))


def verify(
    design: AnyDesign,
    *,
    max_boxes: Optional[int] = None,
    timeout: Optional[Number] = None,
    threads: Optional[int] = None,
    figure: bool = True,
    progress: Optional[Progress] = None,
    cancel: Optional[threading.Event] = None,
) -> Verification:
    """Proves or refutes a design. `timeout` is in seconds; `figure` draws the machine for notebooks."""
    flags = _flags(max_boxes=max_boxes, timeout=timeout, threads=threads)
    with folder_of(as_design(design)) as (folder, file):
        found = answer(["verify", file.name, *flags], folder=folder, progress=progress, cancel=cancel)
        written = found.get("certificate")
        certificate = (folder / written["path"]).read_bytes() if written else None
        drawing = ""
        if figure and written:
            run(["report", written["path"], "--svg", "figures"], folder=folder, cancel=cancel)
            svg = folder / "figures" / "design.svg"
            drawing = svg.read_text(encoding="utf-8") if svg.is_file() else ""
    requirements = tuple(
        Requirement(
            r["requirement"], r["bound"], r.get("worst_found"), tuple(r["at"]) if r.get("at") else None, r.get("unit")
        )
        for r in found.get("requirements", [])
    )
    return Verification(
        found["verdict"], found.get("title"), tuple(found.get("coordinates", ())), requirements,
        _counterexample(found.get("counterexample")), found.get("boxes_tried", 0), found["seconds"], certificate, found, drawing,
    )  # fmt: skip


def bounds(
    design: AnyDesign,
    *,
    relative: Number = "1e-6",
    max_boxes: Optional[int] = None,
    timeout: Optional[Number] = None,
    threads: Optional[int] = None,
    progress: Optional[Progress] = None,
    cancel: Optional[threading.Event] = None,
) -> Bounds:
    """The extremes of every quantity of a design, enclosed to a relative width."""
    found = _asked(
        "bounds", design, relative=relative,
        max_boxes=max_boxes, timeout=timeout, threads=threads, progress=progress, cancel=cancel,
    )  # fmt: skip
    every = tuple(
        Bound(
            b["quantity"], b["end"], _exact(b.get("min")), _exact(b.get("max")), _point(b.get("point")), b.get("unit")
        )
        for b in found["bounds"]
    )
    return Bounds(every, found)


def limit(
    design: AnyDesign,
    key: str,
    *,
    gap: Number = "1e-6",
    direction: Optional[str] = None,
    max_boxes: Optional[int] = None,
    timeout: Optional[Number] = None,
    threads: Optional[int] = None,
    progress: Optional[Progress] = None,
    cancel: Optional[threading.Event] = None,
) -> Limit:
    """How far one number of a design can go, by its dotted key; `gap` is relative, `direction` "up" or "down" alone."""
    found = _asked(
        "limit", design, key, gap=gap, direction=direction,
        max_boxes=max_boxes, timeout=timeout, threads=threads, progress=progress, cancel=cancel,
    )  # fmt: skip

    def value(end: Optional[Mapping[str, Any]]) -> Optional[Fraction]:
        return Fraction(end["value"]) if end else None

    sides = tuple(
        Side(
            s["side"],
            value(s["certified"]),
            value(s["refuted"]),
            _counterexample(s["limited_by"]),
            (s["ends"] or {}).get("reason"),
        )
        for s in found["limits"]
    )
    return Limit(found["key"], found["own"], sides, found)


def tolerance(
    design: AnyDesign,
    *,
    on: Optional[Sequence[str]] = None,
    by_leg: bool = False,
    gap: Number = "0.1",
    each: Optional[Number] = None,
    max_boxes: Optional[int] = None,
    timeout: Optional[Number] = None,
    threads: Optional[int] = None,
    progress: Optional[Progress] = None,
    cancel: Optional[threading.Event] = None,
) -> Tolerance:
    """The widest tolerances with which a design is still certified; `on` names kinds, as `["leg_length", "anchor"]`."""
    kinds = None if on is None else ",".join(on)
    found = _asked(
        "tolerance", design, on=kinds, by_leg=by_leg, gap=gap, each=each,
        max_boxes=max_boxes, timeout=timeout, threads=threads, progress=progress, cancel=cancel,
    )  # fmt: skip
    rows = tuple(
        Widest(
            tuple(row["on"]), row.get("leg"), row["measure"], _exact(row["certified"]), _exact(row["refuted"]),
            _counterexample(row.get("counterexample")),
        )
        for row in found["tolerances"]
    )  # fmt: skip
    return Tolerance(rows, found)


def size(
    design: AnyDesign,
    cube: Number,
    *,
    gap: Optional[Number] = None,
    max_boxes: Optional[int] = None,
    timeout: Optional[Number] = None,
    threads: Optional[int] = None,
    progress: Optional[Progress] = None,
    cancel: Optional[threading.Event] = None,
) -> Size:
    """How large a machine of a design's proportions has to be for a cube of that side."""
    found = _asked(
        "size", design, cube=cube, gap=gap,
        max_boxes=max_boxes, timeout=timeout, threads=threads, progress=progress, cancel=cancel,
    )  # fmt: skip
    return Size(
        found["unknown"], _exact(found.get("certified")), _exact(found.get("refuted")), _exact(found.get("excluded")),
        _point(found.get("centre")), _counterexample(found.get("limited_by")), found,
    )  # fmt: skip


def largest_cube(
    design: AnyDesign,
    *,
    gap: Optional[Number] = None,
    max_boxes: Optional[int] = None,
    timeout: Optional[Number] = None,
    threads: Optional[int] = None,
    progress: Optional[Progress] = None,
    cancel: Optional[threading.Event] = None,
) -> LargestCube:
    """The largest axis-aligned cube whose centre is in a design's box; of platforms that turn, in every orientation."""
    found = _asked(
        "largest-cube", design, gap=gap,
        max_boxes=max_boxes, timeout=timeout, threads=threads, progress=progress, cancel=cancel,
    )  # fmt: skip
    return LargestCube(
        found.get("min"), _point(found.get("centre")), found.get("max") or found.get("refuted_here"),
        _counterexample(found.get("limited_by")), found,
    )  # fmt: skip


def summary(
    design: AnyDesign,
    *,
    speed: Optional[Number] = None,
    force: Optional[Number] = None,
    acceleration: Optional[Number] = None,
    max_boxes: Optional[int] = None,
    timeout: Optional[Number] = None,
    threads: Optional[int] = None,
    progress: Optional[Progress] = None,
    cancel: Optional[threading.Event] = None,
) -> Summary:
    """What a designer reads first: strokes, speeds, forces and accelerations of the joints for those of the tool."""
    found = _asked(
        "summary", design, speed=speed, force=force, acceleration=acceleration,
        max_boxes=max_boxes, timeout=timeout, threads=threads, progress=progress, cancel=cancel,
    )  # fmt: skip
    values = tuple(
        Value(v["words"], v["quantity"], v["end"], _exact(v.get("certified")), _exact(v.get("reached")), v.get("unit"))
        for v in found.get("values", [])
    )
    return Summary(found["verdict"], found.get("title"), found.get("nearest"), values, found)


def pave(
    design: AnyDesign,
    *,
    coordinates: Optional[Sequence[str]] = None,
    volume_gap: Optional[Number] = None,
    precision: Optional[Number] = None,
    max_boxes: Optional[int] = None,
    threads: Optional[int] = None,
    progress: Optional[Progress] = None,
    cancel: Optional[threading.Event] = None,
) -> Paving:
    """Cuts the workspace into cells where all requirements hold, where some fails, and the rest; or the box of up to
    three `coordinates`, for all values of the others."""
    flags = _flags(volume_gap=volume_gap, precision=precision, max_boxes=max_boxes, threads=threads)
    flags += [] if coordinates is None else ["--coordinates", ",".join(coordinates)]
    with folder_of(as_design(design)) as (folder, file):
        output = ["-o", "result.paving"]
        found = answer(["pave", file.name, *output, *flags], folder=folder, progress=progress, cancel=cancel)
        data = (folder / "result.paving").read_bytes()
    inner, outer, undecided = (Fraction(found[part]["share"]) for part in ("inner", "outer", "boundary"))
    volume = found["inner"].get("volume")
    return Paving(inner, outer, undecided, None if volume is None else Fraction(volume), data, found)


def _certificate(certificate: Union[Verification, Paving, bytes, str, Path]) -> bytes:
    if isinstance(certificate, Verification):
        if certificate.certificate is None:
            raise ValueError("an undecided design has no certificate")
        return certificate.certificate
    if isinstance(certificate, Paving):
        return certificate.file
    return certificate if isinstance(certificate, bytes) else Path(certificate).read_bytes()


def check(
    certificate: Union[Verification, Paving, bytes, str, Path],
    *,
    design: Optional[AnyDesign] = None,
    progress: Optional[Progress] = None,
    cancel: Optional[threading.Event] = None,
) -> Check:
    """Re-proves a certificate or a paving in exact arithmetic; with `design`, also that it is about that one."""
    data = _certificate(certificate)
    with folder_of(as_design(design) if design is not None else Design("")) as (folder, file):
        (folder / "a.cert.json").write_bytes(data)
        of = ["--design", file.name] if design is not None else []
        code, out = run(
            ["check", "a.cert.json", *of, "--format", "json"],
            folder=folder, progress=progress, cancel=cancel, accepted=(0, 1, 5),
        )  # fmt: skip
    found = json.loads(out)
    return Check(
        code != 5, found.get("verdict"), found.get("statement"), found.get("reason") or found.get("error"), found
    )


def report(certificate: Union[Verification, Paving, bytes, str, Path], *, title: Optional[str] = None) -> Report:
    """The page about a certificate or a paving."""
    data = _certificate(certificate)
    with folder_of(Design("")) as (folder, _):
        name = "a.cert.json" if data.startswith(b'{"format":"orthocert/') else "a.paving"
        (folder / name).write_bytes(data)
        run(["report", name, "-o", "a.html", *_flags(title=title)], folder=folder)
        return Report((folder / "a.html").read_text(encoding="utf-8"))
