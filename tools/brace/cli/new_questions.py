"""The questions of `brace new` at a terminal."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping

from brace.ground.errors import UsageError


def has_terminal() -> bool:
    """Whether somebody can answer."""
    return all(stream is not None and stream.isatty() for stream in (sys.stdin, sys.stderr))


def ask(
    arguments: argparse.Namespace, questions: Mapping[str, tuple[str, str]], check: Callable[[str, str], object]
) -> None:
    """Asks for each option that is not given, again until the answer can be."""
    for name, (what, example) in questions.items():
        if getattr(arguments, name) is not None:
            continue
        optional = name.endswith(("_play", "_travel"))
        while True:
            sys.stderr.write(f"{what[0].upper()}{what[1:]} (e.g. {example}{'; empty: unknown' if optional else ''}): ")
            sys.stderr.flush()
            line = sys.stdin.readline()
            if not line:
                raise UsageError("no answer: nothing was written", why="the input ended", next_step="brace new --help")
            text = line.strip().strip("'\"") or ("unknown" if optional else "")
            try:
                value = check(name, text)
            except UsageError as error:
                sys.stderr.write(f"  {error.what}: {error.why}\n")
                continue
            if value is not None:
                setattr(arguments, name, text)
            break
