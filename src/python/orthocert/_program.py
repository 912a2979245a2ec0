"""Runs the program `orthocert` that the package brings, and reads its answers."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import threading
import time
from pathlib import Path
from typing import Any, Callable, Optional, Sequence

Progress = Callable[[float], None]
"""Is told the seconds since the start, about five times a second, while a command runs."""


class OrthocertError(Exception):
    """A command that gave no answer; the message is the program's own sentence."""


class DesignError(OrthocertError):
    """Bad input: the message names file, line and key, what was found and what is accepted."""


class Unfinished(OrthocertError):
    """A command that could not finish: files that cannot be written, or an interruption."""


def program() -> Path:
    """The program: that of the variable `ORTHOCERT`, of the package, or on the `PATH`."""
    name = "orthocert" + (sysconfig.get_config_var("EXE") or "")
    candidates = [os.environ.get("ORTHOCERT")]
    schemes = [None, f"{os.name}_user"]
    for scheme in schemes:
        folder = sysconfig.get_path("scripts", scheme) if scheme else sysconfig.get_path("scripts")
        candidates.append(os.path.join(folder, name))
    # Of `pip install --target`.
    candidates.append(str(Path(__file__).parent.parent / "bin" / name))
    candidates.append(shutil.which(name))
    for candidate in candidates:
        if candidate and os.path.isfile(candidate):
            return Path(candidate)
    raise OrthocertError("the program orthocert is not found: install the package with pip, or set ORTHOCERT")


def _in_notebook() -> bool:
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return getattr(shell, "kernel", None) is not None


class _Notebook:
    """A line below the cell that tells the time, from the second second on."""

    def __init__(self, command: str) -> None:
        self.command = command
        self.handle: Any = None

    def __call__(self, seconds: float) -> None:
        from IPython.display import display

        if seconds >= 1:
            text = {"text/plain": f"orthocert {self.command}: {seconds:.0f} s"}
            if self.handle is None:
                self.handle = display(text, raw=True, display_id=True)
            else:
                self.handle.update(text, raw=True)

    def end(self) -> None:
        if self.handle is not None:
            self.handle.update({"text/plain": ""}, raw=True)


def run(
    arguments: Sequence[str],
    *,
    folder: Optional[Path] = None,
    progress: Optional[Progress] = None,
    cancel: Optional[threading.Event] = None,
    accepted: Sequence[int] = (0, 1, 3),
) -> tuple[int, str]:
    """Runs a command; its exit code and standard output.

    It ends when `cancel` is set or the wait is interrupted, as a kernel's stop button does: the program
    is asked to stop, and leaves no half-written file.
    """
    notebook = _Notebook(arguments[0]) if progress is None and _in_notebook() else None
    told = progress or notebook
    process = subprocess.Popen(
        [str(program()), *arguments],
        cwd=folder,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
    )
    start = time.monotonic()
    try:
        while True:
            try:
                out, err = process.communicate(timeout=0.2)
                break
            except subprocess.TimeoutExpired:
                if cancel is not None and cancel.is_set():
                    process.terminate()
                    process.communicate()
                    raise Unfinished("cancelled") from None
                if told is not None:
                    told(time.monotonic() - start)
    except BaseException:
        process.terminate()
        process.communicate()
        raise
    finally:
        if notebook is not None:
            notebook.end()
    code = process.returncode
    if code in accepted:
        return code, out
    message = err.strip().removeprefix("orthocert: ") or f"orthocert {arguments[0]}: exit code {code}"
    raise {2: DesignError, 4: Unfinished}.get(code, OrthocertError)(message)


def answer(arguments: Sequence[str], **options: Any) -> dict[str, Any]:
    """The JSON answer of a command."""
    _, out = run([*arguments, "--format", "json"], **options)
    found: dict[str, Any] = json.loads(out)
    return found
