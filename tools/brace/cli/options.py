"""Options of the command line: values with units, and refusals that say why and what to try."""

from __future__ import annotations

import argparse
import math
import re
import shutil
import sys
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, TypeAlias, cast

from brace.cli.streams import emit, say
from brace.ground.errors import UsageError, did_you_mean
from brace.ground.slips import slip

_FULL_TURN_RAD = 2 * math.pi
_WITH_UNIT = re.compile(r"\s*([-+]?[\d.]+(?:e[-+]?\d+)?)\s*(?:(deg|degrees?|\u00b0)|rad)\s*", re.IGNORECASE)


if TYPE_CHECKING:
    Subcommands: TypeAlias = "argparse._SubParsersAction[OptionParser]"
else:
    Subcommands = object  # argparse has no public name for what add_subparsers returns


class RefusedValue(argparse.ArgumentTypeError):
    """A value that an option does not take; OPTION in `way` becomes the option's name."""

    def __init__(self, what: str, why: str, way: str) -> None:
        super().__init__(what)
        self.what = what
        self.why = why
        self.way = way


def refused(what: str, why: str, way: str) -> RefusedValue:
    """For `raise` in a type function of argparse."""
    return RefusedValue(what, why, way)


class OptionParser(argparse.ArgumentParser):
    """argparse with messages in the form of all others: what, why, and the next thing to try.

    argparse words its own errors differently from version to version, so nothing here reads their text: a refused
    value is known by its exception, a wrong choice and a missing value by the method that finds them.
    """

    _given: Sequence[str] = ()

    def __init__(self, *arguments: Any, **settings: Any) -> None:
        super().__init__(*arguments, **{**settings, "exit_on_error": False})  # then parsing raises ArgumentError

    @property
    def _command(self) -> str:
        """The subcommand's name, for messages that begin with the program's."""
        return self.prog.partition(" ")[2]

    def _get_formatter(self) -> argparse.HelpFormatter:
        """argparse makes one for each option that is added, and each would ask for the terminal's width anew."""
        formatter = cast("type[argparse.HelpFormatter]", self.formatter_class)
        return formatter(prog=self.prog, width=_help_columns())

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:  # the entry of subcommands too
        if args is not None:
            self._given = list(args)
        try:
            values, rest = super().parse_known_args(args, namespace)
        except argparse.ArgumentError as error:
            raise self._explained(error) from None
        if rest:
            raise self._unknown(rest)
        return values, rest

    def error(self, message: str) -> NoReturn:
        """What argparse refuses without naming an argument: one is missing, or an abbreviation is not clear."""
        unknown = [text for text in self._given if self._is_unknown_option(text)]
        if unknown:
            raise self._unknown(unknown)
        model = next((text for text in self._given if text.endswith(".toml")), "")
        forgotten = bool(model) and "--model" in message and "--model" in self._option_string_actions
        raise self._refusal("", message, way=f"--model {model}; {self.prog} --help has the rest" if forgotten else "")

    def _check_value(self, action: argparse.Action, value: object) -> None:
        """argparse calls this for each value of an option with choices."""
        if action.choices is None or value in action.choices:
            return
        known = [str(choice) for choice in action.choices]
        near = did_you_mean(str(value), known)
        raise self._refusal(
            _name_of(action),
            f"{str(value)!r} is no choice",
            f"known: {', '.join(known)}",
            f"did you mean {near}?" if near else f"{self.prog} --help",
        )

    def _match_argument(self, action: argparse.Action, arg_strings_pattern: str) -> int:
        """argparse calls this to count the values that follow an option; it raises when they are too few."""
        try:
            return super()._match_argument(action, arg_strings_pattern)
        except argparse.ArgumentError as error:
            what = f"a value is missing, or there are too many ({error.message})"
            raise self._refusal(_name_of(action), what, "the option takes a value") from None

    def _print_message(self, message: str, file: object = None) -> None:  # --help, --version; a lost one is an error
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

    def _explained(self, error: argparse.ArgumentError) -> UsageError:
        """argparse raises its ArgumentError while it handles the type function's, which `__context__` therefore is."""
        option = error.argument_name or ""
        value = error.__context__
        if isinstance(value, RefusedValue):
            return self._refusal(option, value.what, value.why, value.way.replace("OPTION", option))
        if not option:
            self.error(error.message)
        return self._refusal(option, error.message)

    def _refusal(self, option: str, what: str, why: str = "", way: str = "") -> UsageError:
        return UsageError(
            f"{option}: {what}" if option else what,
            where=self._command,
            why=why or "the command line is not complete or not clear",
            next_step=way or f"{self.prog} --help",
        )


@cache
def _help_columns() -> int:
    return shutil.get_terminal_size().columns - 2


def _name_of(action: argparse.Action) -> str:
    """The option's name as argparse writes it."""
    return argparse.ArgumentError(action, "").argument_name or ""


def number(text: str) -> float:
    """A finite number; -0 is 0."""
    try:
        value = float(text) if "_" not in text else math.nan
    except ValueError:
        why, meant = slip(text)
        if meant:
            raise refused(f"{text!r} is not a number", why, f"OPTION {meant}") from None
        raise refused(f"{text!r} is not a number", "a plain number is wanted", "e.g. OPTION 1.25") from None
    if not math.isfinite(value):
        raise refused(f"{text!r} is not a finite number", "nothing follows from it", "e.g. OPTION 1.25")
    return value + 0.0


def angle(text: str) -> float:
    """An angle of at most a full turn either way [rad]; rad where no unit is said."""
    said = _WITH_UNIT.fullmatch(text)
    value = number(said[1] if said else text)
    if said and said[2]:
        value = math.radians(value)
    if abs(value) > _FULL_TURN_RAD + 1e-5:
        raise refused(
            f"{value:.6g} rad is more than a full turn",
            "it may turn once" if said else "an angle is in rad, not in degrees, where its unit is not said",
            "e.g. OPTION 57deg" if said else f"OPTION {math.radians(value):.6g} if {text} are degrees",
        )
    return value


def flexion(text: str) -> float:
    """A knee angle [rad], from folded one way to folded the other."""
    value = angle(text)
    if abs(value) > math.pi + 1e-5:
        raise refused(
            f"{value:.6g} rad is beyond the folded knee",
            "the knee's angle lies in [-pi, pi] rad, 0 is straight",
            "OPTION 3.14159 for the folded knee",
        )
    return value


def positive(text: str) -> float:
    """A finite number above zero."""
    value = number(text)
    if value <= 0:
        raise refused(f"{text!r} is not positive", "it must be above zero", "e.g. OPTION 1.25")
    return value


def count(low: int, high: int) -> Callable[[str], int]:
    """A whole number in [low, high]."""

    def parse(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            raise refused(f"{text[:40]!r} is not a whole number", "it counts something", f"OPTION {low}") from None
        if not low <= value <= high:
            nearest = min(max(value, low), high)
            raise refused(f"{text} is out of range", f"it lies in [{low}, {high}]", f"OPTION {nearest}")
        return value

    return parse


def path(text: str) -> Path:
    """The name of a file or folder."""
    if not text.strip():
        raise refused("an empty name", "a file or folder is named there", "OPTION NAME; is a shell variable empty?")
    if "\0" in text:
        raise refused("a name with a zero byte", "no file has such a name", "OPTION NAME")
    return Path(text)
