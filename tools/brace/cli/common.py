"""What the subcommands share: --model, --json, notices, progress."""

from __future__ import annotations

import argparse
import contextlib
import math
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from brace.cli.options import (
    angle,
    count,
    duration,
    flexion,
    force,
    length,
    moment,
    number,
    path,
    positive_force,
    positive_length,
    positive_ratio,
    positive_stiffness,
    ratio,
    stiffness,
    temperature,
    weight,
)
from brace.cli.streams import emit, is_quiet
from brace.cli.streams import say as _say

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

__all__ = [
    "add_json",
    "add_model",
    "angle",
    "count",
    "duration",
    "emit",
    "flexion",
    "force",
    "json_ready",
    "length",
    "moment",
    "number",
    "path",
    "positive_force",
    "positive_length",
    "positive_ratio",
    "positive_stiffness",
    "print_json",
    "progress",
    "ratio",
    "say",
    "stiffness",
    "temperature",
    "weight",
]

PROGRESS_AFTER_S = 2.0
LINE_EVERY_S = 10.0


class Advance(Protocol):
    """Called with the work done so far."""

    def __call__(self, done: int, doing: str = "") -> None: ...


def add_model(
    parser: argparse._ActionsContainer, meaning: str = "the limb model", required: bool = True
) -> None:
    """--model limb.toml"""
    parser.add_argument("--model", type=path, required=required, metavar="LIMB.toml", help=meaning)


def add_json(parser: argparse.ArgumentParser) -> None:
    """--json"""
    parser.add_argument(
        "--json", action="store_true", help="print one JSON object on stdout; messages stay on stderr"
    )


def print_json(data: dict[str, object]) -> None:
    """One JSON object on stdout; what is not finite becomes null, since JSON has no word for it."""
    import json  # here, so that the command line's help need not load it

    emit(json.dumps(json_ready(data), indent=1))


def json_ready(value: object) -> object:
    """numpy scalars and arrays to plain values, non-finite numbers to null."""
    if isinstance(value, dict):
        return {str(key): json_ready(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [json_ready(item) for item in value]
    if hasattr(value, "tolist"):
        return json_ready(value.tolist())
    if isinstance(value, float):
        return value + 0.0 if math.isfinite(value) else None  # -0 is 0
    if isinstance(value, Path):
        return str(value)
    return value


def say(text: str) -> None:
    """A message for the person, on stderr, unless --quiet."""
    if not is_quiet():
        _say(f"brace: {text}")


@contextlib.contextmanager
def progress(label: str, total: int | None = None) -> Iterator[Advance]:
    """Yields a function to call with the work done so far, and what is being done if that changes. Draws a bar on a
    terminal once two seconds are up; says a line every ten seconds where stderr is a pipe or a file."""
    if is_quiet() or sys.stderr is None:
        yield lambda done, doing="": None
        return
    if not sys.stderr.isatty():
        with _lines(label, total) as report_lines:
            yield report_lines
        return
    started = time.monotonic()
    bar: list[tuple[Progress, TaskID]] = []

    def advance(done: int, doing: str = "") -> None:
        if time.monotonic() - started < PROGRESS_AFTER_S:
            return
        if not bar:
            from rich.console import Console
            from rich.progress import Progress

            shown = Progress(console=Console(stderr=True), transient=True)
            shown.start()
            bar.append((shown, shown.add_task(label, total=total)))
        shown, task = bar[0]
        shown.update(task, completed=done, description=f"{label}: {doing}" if doing else label)

    try:
        yield advance
    finally:
        if bar:
            bar[0][0].stop()


@contextlib.contextmanager
def _lines(label: str, total: int | None) -> Iterator[Advance]:
    """For a log: what is being done, how long it has taken, and how far it is. A thread says it, because a step may be
    longer than the time between two lines."""
    import threading  # here, so that the command line's help need not load it

    started, ended = time.monotonic(), threading.Event()
    doing_now, done_now = "", 0

    def advance(done: int, doing: str = "") -> None:
        nonlocal doing_now, done_now
        doing_now, done_now = doing, done

    def report_lines() -> None:
        while not ended.wait(LINE_EVERY_S):
            what = f"{label}: {doing_now}" if doing_now else label
            share = f", {100 * done_now // total} % done" if total else ""
            say(f"{what}: {time.monotonic() - started:.0f} s so far{share}")

    reporter = threading.Thread(target=report_lines, daemon=True)
    reporter.start()
    try:
        yield advance
    finally:
        ended.set()
        reporter.join()
