"""What a library doubts is said to the person, one line each, once."""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Iterator
from typing import TextIO

from brace.cli.streams import say
from brace.ground.errors import ModelDoubt


@contextlib.contextmanager
def doubts_said() -> Iterator[None]:
    """Warnings of ours become messages; all others stay as they are."""
    said: set[str] = set()
    with warnings.catch_warnings():
        shown = warnings.showwarning
        warnings.simplefilter("always", ModelDoubt)

        def show(
            message: Warning | str,
            category: type[Warning],
            filename: str,
            lineno: int,
            file: TextIO | None = None,
            line: str | None = None,
        ) -> None:
            if not issubclass(category, ModelDoubt):
                shown(message, category, filename, lineno, file, line)
            elif str(message) not in said:
                said.add(str(message))
                say(f"brace: {message}")

        warnings.showwarning = show
        yield
