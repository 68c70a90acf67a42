"""What can go wrong, as the person at the keyboard will read it.

Every error says what, where (file:line, column or field), why, and the next thing to try, and carries the
exit code that scripts test for.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

EXIT_OK = 0
EXIT_CHECK_FAILED = 1
EXIT_USAGE = 2
EXIT_BAD_FILE = 3
EXIT_NO_DEVICE = 4
EXIT_DEVICE_FAULT = 5
EXIT_VERSION = 6
EXIT_NOT_VERIFIED = 7
EXIT_INTERRUPTED = 130

_INSTALLED = Path(__file__).resolve().parents[1] / "docs"  # a wheel has the pages inside
_PAGE = re.compile(r"(?<![\w/])docs/(?=[a-z-]+\.md\b)")


class BraceError(Exception):
    """An error with its place, its reason and a way on."""

    exit_code = EXIT_CHECK_FAILED

    def __init__(self, what: str, *, where: str = "", why: str = "", next_step: str = "") -> None:
        super().__init__(what)
        self.what = what
        self.where = where
        self.why = why
        self.next_step = next_step

    def render(self) -> str:
        """The message as printed on stderr: one line, then the reason and the way on."""
        lines = [": ".join(part for part in ("brace", self.where, self.what) if part)]
        if self.why:
            lines.append(f"  why: {self.why}")
        if self.next_step:
            lines.append(f"  try: {self.next_step}")
        return "\n".join(printable(located(line)) for line in lines)


def located(text: str) -> str:
    """The text, with the folder of its pages where they are installed; in the project they are in docs/."""
    if "docs/" not in text or not _INSTALLED.is_dir():
        return text
    return _PAGE.sub(f"{_INSTALLED}/", text)


def printable(text: str) -> str:
    """Text with what would steer a terminal (escape sequences in names, say) written out."""
    if text.isprintable():
        return text
    return "".join(
        character if character.isprintable() or character == "\n" else character.encode("unicode_escape").decode()
        for character in text
    )


class UsageError(BraceError):
    """The command line asks for something that cannot be."""

    exit_code = EXIT_USAGE


class MissingLibraryError(UsageError):
    """The firmware's own C is not where it is looked for."""


class BadFileError(BraceError):
    """A model, rig or data file that is wrong, missing, contradictory or hostile."""

    exit_code = EXIT_BAD_FILE


class NoDeviceError(BraceError):
    """No device, port or bus to talk to, or one that does not answer in time."""

    exit_code = EXIT_NO_DEVICE


class DeviceFaultError(BraceError):
    """A device that answers, and has a fault, refuses, or has no valid K."""

    exit_code = EXIT_DEVICE_FAULT


class NotVerifiedError(BraceError):
    """What was written is not what is found afterwards."""

    exit_code = EXIT_NOT_VERIFIED


class VersionMismatchError(BraceError):
    """Two ends that do not speak of the same list of parameters, or not in the same format."""

    exit_code = EXIT_VERSION


class ModelDoubt(UserWarning):
    """A sentence about a model's value that is used all the same."""


def place(path: Path | str, line: int | None = None) -> str:
    """`file:line`, or the file alone when the line is not known."""
    return f"{path}:{line}" if line else str(path)


def did_you_mean(word: str, known: Iterable[str], likeness: float = 0.65) -> str:
    """The known word nearest to a misspelt one, or an empty string when none is at least so like it."""
    import difflib  # here, so that a command without a slip starts at once

    choices = list(known)
    lowered = {choice.lower(): choice for choice in choices}
    near = difflib.get_close_matches(word.lower(), list(lowered), n=1, cutoff=likeness)
    return lowered[near[0]] if near else ""
