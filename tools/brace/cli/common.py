"""What the subcommands share: options, --json, notices, progress."""

from __future__ import annotations

import argparse
import contextlib
import json
import math
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

PROGRESS_AFTER_S = 2.0


def add_model(parser: argparse.ArgumentParser, meaning: str = "the limb model") -> None:
    """--model limb.toml"""
    parser.add_argument("--model", type=Path, required=True, metavar="LIMB.toml", help=meaning)


def add_json(parser: argparse.ArgumentParser) -> None:
    """--json"""
    parser.add_argument(
        "--json", action="store_true", help="print one JSON object on stdout; messages stay on stderr"
    )


def number(text: str) -> float:
    """A finite number from the command line."""
    try:
        value = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r} is not finite")
    return value


def positive(text: str) -> float:
    """A finite number above zero."""
    value = number(text)
    if value <= 0:
        raise argparse.ArgumentTypeError(f"{text!r} is not positive")
    return value


def count(low: int, high: int) -> Callable[[str], int]:
    """A whole number in [low, high]."""

    def parse(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{text!r} is not a whole number") from None
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"{value} is not in [{low}, {high}]")
        return value

    return parse


def print_json(data: dict[str, Any]) -> None:
    """One JSON object on stdout; what is not finite becomes null, since JSON has no word for it."""
    print(json.dumps(json_ready(data), indent=1))


def json_ready(value: Any) -> Any:
    """numpy scalars and arrays to plain values, non-finite numbers to null."""
    if isinstance(value, dict):
        return {str(key): json_ready(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [json_ready(item) for item in value]
    if hasattr(value, "tolist"):
        return json_ready(value.tolist())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Path):
        return str(value)
    return value


def say(text: str) -> None:
    """A message for the person, on stderr."""
    print(f"brace: {text}", file=sys.stderr)


@contextlib.contextmanager
def progress(label: str, total: int | None = None) -> Iterator[Callable[[int], None]]:
    """Yields a function to call with the work done so far. Draws a bar on a terminal once two seconds are up."""
    started = time.monotonic()
    bar: list[Any] = []

    def advance(done: int) -> None:
        if not sys.stderr.isatty() or time.monotonic() - started < PROGRESS_AFTER_S:
            return
        if not bar:
            from rich.console import Console
            from rich.progress import Progress

            shown = Progress(console=Console(stderr=True), transient=True)
            shown.start()
            bar.extend([shown, shown.add_task(label, total=total)])
        bar[0].update(bar[1], completed=done)

    try:
        yield advance
    finally:
        if bar:
            bar[0].stop()
