"""Options of the command line: values with units, and refusals that say why and what to try."""

from __future__ import annotations

import argparse
import math
import re
import shlex
import shutil
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, TypeAlias, cast

from brace.cli.streams import emit, say
from brace.ground.errors import UsageError, did_you_mean
from brace.ground.slips import slip
from brace.ground.units import FORCE_MOST_N, OWN, UNITS, amount, unit_of

_FULL_TURN_RAD = 2 * math.pi

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
        raise self._refusal("", message, way=self._completed(self._given))

    def _completed(self, given: Sequence[str]) -> str:
        """The command line with a value for everything that must be there and is not."""
        model = next((text for text in given if text.endswith(".toml")), "")
        words, missing = list(given), []
        for action in self._actions:
            names = [text.partition("=")[0] for text in given]
            if not action.required or any(option in names for option in action.option_strings):
                continue
            if "--model" in action.option_strings and model:  # the file was named, its option was not
                words[words.index(model):words.index(model)] = ["--model"]
                continue
            if action.option_strings:
                missing += [action.option_strings[0], *_example_of(action)]
            elif not any(not text.startswith("-") for text in given):
                missing += _example_of(action)
        return " ".join([self.prog, *(shlex.quote(word) for word in words), *missing])

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
            option = action.option_strings[0] if action.option_strings else ""
            way = " ".join(["e.g.", option, *_example_of(action)]).replace("  ", " ")
            raise self._refusal(_name_of(action), what, "the option takes a value", way) from None

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


_EXAMPLES = {"LIMB.toml": "limb.toml", "RIG.toml": "rig.toml", "URL": "can0", "DIR": "out", "JOINT+|JOINT-": "femur+"}


def _example_of(action: argparse.Action) -> list[str]:
    """Values that an option or argument may have: a quantity's example, else its metavar."""
    shown = action.metavar if isinstance(action.metavar, tuple) else (action.metavar or action.dest.upper(),)
    shown = tuple(_EXAMPLES.get(name, name) for name in shown)
    if isinstance(action.type, Quantity):
        return [action.type.example] * len(shown)
    if action.choices is not None:
        return [str(next(iter(action.choices)))]
    return list(shown)


def _name_of(action: argparse.Action) -> str:
    """The option's name as argparse writes it."""
    return argparse.ArgumentError(action, "").argument_name or ""


def number(text: str, example: str = "1.25") -> float:
    """A finite number; -0 is 0. A refusal shows the example."""
    try:
        value = float(text) if "_" not in text else math.nan
    except ValueError:
        why, meant = slip(text)
        if meant:
            raise refused(f"{text!r} is not a number", why, f"OPTION {meant}") from None
        raise refused(f"{text!r} is not a number", "a number is wanted", f"e.g. OPTION {example}") from None
    if not math.isfinite(value):
        raise refused(f"{text!r} is not a finite number", "nothing follows from it", f"e.g. OPTION {example}")
    return value + 0.0


# --- numbers with units -----------------------------------------------------------------------------------------------

Check: TypeAlias = Callable[[float, str, bool], None]  # value, the text, whether it says its unit; raises RefusedValue


@dataclass(frozen=True)
class Quantity:
    """The type of an option that takes a number with a unit; without one it is in ours. Called by argparse."""

    of: str  # as in brace.ground.units, or "ratio"
    example: str  # a value with its unit
    least: float = -math.inf
    most: float = math.inf
    is_positive: bool = False  # above zero
    check: Check | None = None

    @property
    def units(self) -> dict[str, tuple[float, float]]:
        """Factor and offset of each unit's name."""
        if self.of == "ratio":
            return {"": (1.0, 0.0), "%": (0.01, 0.0)}
        return {unit.text: (unit.factor, unit.offset) for unit in UNITS.values() if unit.quantity == self.of}

    @property
    def own(self) -> str:
        """The unit of a number without one."""
        return OWN.get(self.of, "")

    def __call__(self, text: str) -> float:
        found = amount(text)
        if found is None or not found[1]:
            value, has_unit = number(text, self.example), False
        else:
            factor, offset = self._unit(text, found[1])
            value, has_unit = factor * found[0] + offset + 0.0, True
        if not math.isfinite(value):
            raise refused(f"{text!r} is not a finite number", "nothing follows from it", f"e.g. OPTION {self.example}")
        if self.is_positive and value <= 0.0:
            raise refused(f"{text!r} is not positive", "it must be above zero", f"e.g. OPTION {self.example}")
        if not self.least <= value <= self.most:
            raise refused(
                f"{text!r} is {value:.6g} {self.own}".rstrip() + ", out of range",
                f"{_a(self.of)} of {self.least:g} to {self.most:g} {self.own}".rstrip() + " is wanted",
                f"e.g. OPTION {self.example}",
            )
        if self.check is not None:
            self.check(value, text, has_unit)
        return value

    def _unit(self, text: str, unit_text: str) -> tuple[float, float]:
        """Factor and offset."""
        if self.of == "ratio" and unit_text in self.units:
            return self.units[unit_text]
        if re.match(r",\d", unit_text):
            pointed = text.replace(",", ".")
            raise refused(f"{text!r} is not a number", "the decimal sign is a point", f"OPTION {pointed}")
        unit = unit_of(unit_text, self.of)
        if unit is not None and unit.quantity == self.of:
            return unit.factor, unit.offset
        known = ", ".join(name for name in self.units if name)
        raise refused(
            f"{text!r} is {_a(unit.quantity)}" if unit else f"{text!r} is not a number with a unit of {self.of}",
            f"{_a(self.of)} is wanted, in {known}; a number without a unit is "
            + (f"in {self.own}" if self.own else "the ratio itself: 0.5 is 50%"),
            f"OPTION {self.example}",
        )


def _a(noun: str) -> str:
    return f"{'an' if noun[0] in 'aeiou' else 'a'} {noun}"


def at_most_a_turn(value_rad: float, text: str, has_unit: bool) -> None:
    """Refuses an angle beyond a full turn either way."""
    if abs(value_rad) > _FULL_TURN_RAD + 1e-5:
        raise refused(
            f"{value_rad:.6g} rad is more than a full turn",
            "it may turn once" if has_unit else "an angle is in rad, not in degrees, where its unit is not said",
            "e.g. OPTION 57deg" if has_unit else f"OPTION {math.radians(value_rad):.6g} if {text} are degrees",
        )


def _at_most_folded(value_rad: float, text: str, has_unit: bool) -> None:
    at_most_a_turn(value_rad, text, has_unit)
    if abs(value_rad) > math.pi + 1e-5:
        raise refused(
            f"{value_rad:.6g} rad is beyond the folded knee",
            "the knee's angle lies in [-pi, pi] rad, 0 is straight",
            "OPTION 3.14159 for the folded knee",
        )


def _on_a_tip(value_n: float, text: str, has_unit: bool) -> None:
    if abs(value_n) > FORCE_MOST_N:
        raise refused(
            f"{text} is no force on a tip" if has_unit else f"{text} N is no force on a tip",
            f"it lies within +-{FORCE_MOST_N:g} N", "OPTION 10N",
        )  # fmt: skip


angle = Quantity("angle", "57deg", check=at_most_a_turn)  # at most a full turn either way
flexion = Quantity("angle", "57deg", check=_at_most_folded)  # of a knee, from folded one way to folded the other
force = Quantity("force", "10N", check=_on_a_tip)  # on the tip
weight = Quantity("force", "10N")  # kg and lb are weights here
positive_force = Quantity("force", "10N", is_positive=True)
length = Quantity("length", "1.5mm")
positive_length = Quantity("length", "1.5mm", is_positive=True)
duration = Quantity("time", "2s", is_positive=True)
moment = Quantity("time", "2s", least=0.0)  # since the start
stiffness = Quantity("stiffness", "1.5N/mm")
positive_stiffness = Quantity("stiffness", "1.5N/mm", is_positive=True)
temperature = Quantity("temperature", "30degC")
ratio = Quantity("ratio", "50%")
positive_ratio = Quantity("ratio", "50%", is_positive=True)


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
