"""Options of the command line: values with units, and refusals that say why and what to try."""

from __future__ import annotations

import argparse
import math
import re
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NoReturn

from brace.cli.streams import emit, say
from brace.errors import UsageError, did_you_mean
from brace.slips import slip

_PART = "\x1f"  # between what, why and try of a refused value, through argparse and back
_FULL_TURN_RAD = 2 * math.pi
_DEGREES = re.compile(r"\s*([-+]?[\d.]+(?:e[-+]?\d+)?)\s*(?:deg|degrees?|\u00b0)\s*", re.IGNORECASE)
_REFUSED_VALUE = re.compile(r"argument ([^:]+): (.*)", re.DOTALL)
_CHOICE = re.compile(r"invalid choice: '(.*)' \(choose from (.*)\)", re.DOTALL)


class OptionParser(argparse.ArgumentParser):
    """argparse with messages in the form of all others: what, why, and the next thing to try."""

    _given: Sequence[str] = ()

    @property
    def _command(self) -> str:
        """The subcommand's name, for messages that begin with the program's."""
        return self.prog.partition(" ")[2]

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:  # the entry of subcommands too
        if args is not None:
            self._given = list(args)
        values, rest = super().parse_known_args(args, namespace)
        if rest:
            raise self._unknown(rest)
        return values, rest

    def error(self, message: str) -> NoReturn:
        """Every refusal of argparse arrives here."""
        unknown = [text for text in self._given if self._is_unknown_option(text)]
        if message.startswith("the following arguments are required") and unknown:
            raise self._unknown(unknown)
        raise self._explained(message)

    def _print_message(self, message: str, file: Any = None) -> None:  # --help, --version; a lost one is an error
        if message and (file is None or file is sys.stdout):
            emit(message.rstrip("\n"))
        elif message:
            say(message.rstrip("\n"))

    def _is_unknown_option(self, text: str) -> bool:
        name = text.partition("=")[0]
        known = self._option_string_actions
        return name.startswith("--") and len(name) > 2 and not any(option.startswith(name) for option in known)

    def _unknown(self, rest: Sequence[str]) -> UsageError:
        first = next((text for text in rest if text.startswith("-")), rest[0])
        name = first.partition("=")[0]
        if not name.startswith("-"):
            return UsageError(
                f"{first!r} is one argument too many",
                where=self._command,
                why="nothing is expected there",
                next_step=f"{self.prog} --help; a value with blanks needs quotes",
            )
        given = {text.partition("=")[0] for text in self._given}
        near = did_you_mean(name, [option for option in self._option_string_actions if option not in given])
        return UsageError(
            f"unknown option {name}",
            where=self._command,
            why="a misspelt option would silently do nothing",
            next_step=f"did you mean {near}?" if near else f"{self.prog} --help lists the options",
        )

    def _explained(self, message: str) -> UsageError:
        found = _REFUSED_VALUE.fullmatch(message)
        option, text = found.groups() if found else ("", message)
        what, _, rest = text.partition(_PART)
        why, _, way = rest.partition(_PART)
        choice = _CHOICE.fullmatch(what)
        if choice:
            known = re.findall(r"'([^']*)'", choice.group(2))
            near = did_you_mean(choice.group(1), known)
            what = f"{choice.group(1)!r} is no choice"
            why = f"known: {', '.join(known)}"
            way = f"did you mean {near}?" if near else f"{self.prog} --help"
        elif what.startswith("expected"):
            what, why = f"a value is missing, or there are too many ({what})", "the option takes a value"
        return UsageError(
            f"{option}: {what}" if option else what,
            where=self._command,
            why=why or "the command line is not complete or not clear",
            next_step=way.replace("OPTION", option) or f"{self.prog} --help",
        )


def refused(what: str, why: str, way: str) -> argparse.ArgumentTypeError:
    """A value that an option does not take; OPTION in `way` becomes its name."""
    return argparse.ArgumentTypeError(_PART.join((what, why, way)))


def number(text: str) -> float:
    """A finite number; -0 is 0."""
    try:
        value = float(text) if "_" not in text else math.nan
    except ValueError:
        if degrees := _DEGREES.fullmatch(text):
            radians = math.radians(float(degrees.group(1)))
            raise refused(
                f"{text!r} is not a number", "angles are plain numbers in rad", f"OPTION {radians:.6g}"
            ) from None
        why, meant = slip(text)
        if meant:
            raise refused(f"{text!r} is not a number", why, f"OPTION {meant}") from None
        raise refused(f"{text!r} is not a number", "a plain number is wanted", "OPTION 1.25, say") from None
    if not math.isfinite(value):
        raise refused(f"{text!r} is not a finite number", "nothing follows from it", "OPTION 1.25, say")
    return value + 0.0


def angle(text: str) -> float:
    """An angle [rad] of at most a full turn either way."""
    value = number(text)
    if abs(value) > _FULL_TURN_RAD + 1e-5:
        raise refused(
            f"{text} rad is more than a full turn",
            "angles are in rad, not in degrees",
            f"OPTION {math.radians(value):.6g} if {text} are degrees",
        )
    return value


def flexion(text: str) -> float:
    """A knee angle [rad], from folded one way to folded the other."""
    value = angle(text)
    if abs(value) > math.pi + 1e-5:
        raise refused(
            f"{text} rad is beyond the folded knee",
            "the knee's angle lies in [-pi, pi] rad, 0 is straight",
            "OPTION 3.14159 for the folded knee",
        )
    return value


def positive(text: str) -> float:
    """A finite number above zero."""
    value = number(text)
    if value <= 0:
        raise refused(f"{text!r} is not positive", "it must be above zero", "OPTION 1.25, say")
    return value


def count(low: int, high: int) -> Callable[[str], int]:
    """A whole number in [low, high]."""

    def parse(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            raise refused(f"{text[:40]!r} is not a whole number", "it counts something", f"OPTION {low}") from None
        if not low <= value <= high:
            raise refused(f"{text} is out of range", f"it lies in [{low}, {high}]", f"OPTION {low}, say")
        return value

    return parse


def path(text: str) -> Path:
    """The name of a file or folder."""
    if not text.strip():
        raise refused("an empty name", "a file or folder is named there", "OPTION NAME; is a shell variable empty?")
    if "\0" in text:
        raise refused("a name with a zero byte", "no file has such a name", "OPTION NAME")
    return Path(text)
