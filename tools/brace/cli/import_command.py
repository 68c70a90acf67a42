"""`brace import`: a dataset from somebody's own files, by a mapping that a person has confirmed."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from brace.cli import common
from brace.cli.options import Subcommands, refused
from brace.cli.subcommands import SUBCOMMANDS
from brace.ground.errors import BadFileError, BraceError, UsageError

if TYPE_CHECKING:
    from brace.dataset import DataFault
    from brace.importing.build import Built
    from brace.importing.mapping import Constant, MappingTable
    from brace.importing.part import Part

KINDS = ("loading", "joint_test", "stiffness_table")
_SHORT = {"theta1": "theta1_rad", "theta2": "theta2_rad", "dwell": "dwell_s", "temp": "temp_degc"}
DECIMALS = 9


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "import",
        help=SUBCOMMANDS["import"],
        description="Finds the tables in the files, says what each column seems to be, asks for what it cannot know, "
        "and writes a dataset in our units. Without a terminal nothing is asked: --draft writes the mapping with a ? "
        "for each open question, --mapping reads the answers, --yes accepts a table without open questions.",
        epilog="Exit codes: 0 written, 2 a question is open (the table is printed), 3 a file cannot be read, or no "
        "limb has such values.",
    )
    parser.add_argument(
        "files", type=common.path, nargs="+", metavar="FILE", help="text with columns, .xlsx, a log (candump -l, MCAP)"
    )
    parser.add_argument("--out", type=common.path, metavar="DIR", help="folder of the dataset")
    parser.add_argument("--mapping", type=common.path, metavar="FILE.toml", help="what each column is; made by --draft")
    parser.add_argument("--draft", type=common.path, metavar="FILE.toml", help="write the mapping as guessed, and end")
    parser.add_argument("--yes", action="store_true", help="accept the table as shown, if no question is open")
    parser.add_argument("--kind", choices=KINDS, help="the kind of record; default: by the columns")
    parser.add_argument(
        "--set", type=_constant, action="append", default=[], metavar="[FILE:]NAME=VALUE",
        help="what stands in no column: theta1=42deg, theta2=1.4rad, axis=z, dwell=4s (between readings), temp=21degC, "
        "clock=stamp (of a log; or log)",
    )  # fmt: skip
    parser.add_argument(
        "--dbc", type=common.path, action="append", default=[], metavar="FILE.dbc",
        help="decodes the CAN frames of a log; once for each database",
    )  # fmt: skip
    parser.add_argument(
        "--signals", action="append", default=[], metavar="NAME",
        help="of a log: takes these alone; a message, a topic, or a signal's name, where * stands for any letters",
    )  # fmt: skip
    parser.add_argument("--sheet", default="", metavar="NAME", help="of a workbook")
    parser.add_argument("--decimal", choices=(".", ","), default="", help="the decimal sign; default: by the numbers")
    parser.add_argument(
        "--separator", type=_separator, metavar="CHAR", help="between columns (tab, blank); default: by the lines"
    )
    common.add_json(parser)
    parser.set_defaults(run=run)


def _separator(text: str) -> str:
    named = {"tab": "\t", "blank": " ", "comma": ",", "semicolon": ";"}.get(text, text)
    if len(named) != 1:
        raise refused(f"{text!r} is no separator", "it is one character", 'OPTION ";"')
    return named


def _constant(text: str) -> Constant:
    import re

    from brace.importing.mapping import CHOICES, CONSTANTS, checked_constant

    match = re.fullmatch(
        r"(?:(?P<file>.+):)?(?P<name>\w+)\s*=\s*(?P<value>[-+\d.eE]+|x|z|log|stamp)\s*(?P<unit>.*)", text.strip()
    )
    if not match:
        raise refused(
            f"{text!r} is no constant",
            "it is NAME=VALUE, the value a number with its unit; an axis is x or z, a clock log or stamp",
            "OPTION theta1=42deg, or OPTION axis=x",
        )
    name = _SHORT.get(match["name"], match["name"])
    known = {each for group in CONSTANTS.values() for each in group}
    if name not in known:
        raise refused(f"{match['name']!r} is no constant", f"known: {', '.join(sorted(known))}", "OPTION theta1=42deg")
    unit = match["unit"] or _own_unit(match["name"])
    if name not in CHOICES and not unit:
        raise refused(f"{text}: in which unit?", "an angle may be in deg or in rad", f"OPTION {text}deg")
    try:
        return checked_constant(name, match["value"], unit, match["file"] or "")
    except UsageError as error:
        raise refused(error.what, error.why, f"OPTION {match['name']}={error.next_step}") from None


def _own_unit(name: str) -> str:
    """A name of ours says its unit: theta1_rad=0.74."""
    return {"theta1_rad": "rad", "theta2_rad": "rad", "dwell_s": "s", "temp_degc": "degC"}.get(name, "")


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.ground.files import write_file
    from brace.importing import constants, guess, mapping, words
    from brace.importing.build import build, sources
    from brace.importing.files import read_all

    _check_usage(arguments)
    parts = read_all(
        arguments.files, sheet=arguments.sheet, decimal=arguments.decimal, separator=arguments.separator or "",
        databases=arguments.dbc, signals=arguments.signals,
    )
    inputs = [*sources(parts), *arguments.dbc, *([arguments.mapping] if arguments.mapping else [])]
    if arguments.mapping:
        table = mapping.read(arguments.mapping)
        _refuse_strange_names(parts, table, arguments.mapping)
    else:
        table = guess.draft(parts, arguments.kind or "")
    table = table.with_constants(arguments.set, [part.places for part in parts])
    constants.refuse_without_effect(parts, table, arguments.set)
    table = replace(table, notes=tuple(constants.against_remarks(parts, table, arguments.set)))
    shown = words.lines(parts, table)
    if arguments.draft is not None:
        _refuse_answered(arguments.draft, mapping.to_toml(table))
        write_file(arguments.draft, mapping.to_toml(table), inputs)
        _show(shown)
        common.say(f"-> {arguments.draft}; answer every ? in it, then --mapping {arguments.draft} --out DIR")
        return 0
    if not arguments.mapping or table.questions:
        _show(shown)
    if not arguments.mapping and not arguments.yes:
        table = _confirmed(table, arguments)
    elif table.questions:
        raise _open(table, arguments)
    _refuse_measured(arguments.out)
    built = build(parts, table)
    faults = _faults(built)
    _write(arguments.out, built, inputs)
    _report(arguments, built, faults, table)
    return 0


def _check_usage(arguments: argparse.Namespace) -> None:
    if arguments.out is None and arguments.draft is None:
        raise UsageError(
            "neither --out nor --draft",
            why="the result is a folder, or the mapping as guessed",
            next_step="--out DIR, or --draft mapping.toml",
        )
    if arguments.mapping is not None and arguments.kind is not None:
        raise UsageError("--kind with --mapping", why="the mapping says the kind", next_step="drop --kind")


def _show(lines: Sequence[str]) -> None:
    from brace.cli.streams import say

    for line in lines:
        say(line)


def _confirmed(table: MappingTable, arguments: argparse.Namespace) -> MappingTable:
    """What the person says at the terminal; without one, nothing is asked."""
    from brace.cli.import_questions import ask, has_terminal

    if not has_terminal():
        raise _open(table, arguments)
    return ask(table)


def _open(table: MappingTable, arguments: argparse.Namespace) -> UsageError:
    questions = table.questions
    name = arguments.mapping or "mapping.toml"
    if not questions:
        return UsageError(
            "the table above is a guess that nobody has confirmed",
            why="there is no terminal to ask at",
            next_step="the same command with --yes if it is right; else --draft mapping.toml, correct it, --mapping "
            "mapping.toml",
        )
    return UsageError(
        f"the table above has {len(questions)} open question{'s' if len(questions) > 1 else ''}",
        where=str(arguments.mapping or ""),
        why=questions[0],
        next_step=f"answer each ? in {name}"
        if arguments.mapping
        else f"the same command with --draft {name}; answer each ? in it (what stands in no column: --set NAME=VALUE, "
        f"too); then the same with --mapping {name} --out DIR",
    )


def _refuse_strange_names(parts: Sequence[Part], table: MappingTable, path: Path) -> None:
    """Names of the mapping that no file has: a mapping of other files, or a slip."""
    from brace.ground.errors import did_you_mean

    known = {name for part in parts for name in part.names}
    for use in table.columns:
        if use.used and use.name not in known:
            near = did_you_mean(use.name, known)
            raise BadFileError(
                f"no file has a column {use.name!r}",
                where=str(path),
                why=f"the files have {', '.join(sorted(known))[:200]}",
                next_step=f"did you mean {near!r}?"
                if near
                else "name a column that is there, or draft the mapping anew",
            )


def _refuse_answered(draft: Path, text: str) -> None:
    """A mapping that is there may hold a person's answers; only the same draft is written over."""
    try:
        if draft.read_text(encoding="utf-8") == text:
            return
    except FileNotFoundError:
        return
    except (OSError, UnicodeDecodeError):
        pass  # no draft of ours, or none that can be read
    raise UsageError(
        "the draft would replace a file that is there",
        where=str(draft),
        why="it may hold answers that somebody has written",
        next_step=f"--mapping {draft} to use it; another --draft, or delete it, to begin anew",
    )


def _refuse_measured(folder: Path) -> None:
    """A dataset that was imported may be imported anew; any other is never replaced."""
    from brace import toml

    present = [folder / name for name in ("meta.toml", "data.csv") if (folder / name).exists()]
    if not present:
        return
    try:
        source = toml.read(folder / "meta.toml", "dataset's meta.toml").content.get("source")
    except BraceError:
        source = None
    if not (isinstance(source, dict) and source.get("what") == "imported"):
        raise UsageError(
            "the output would replace a dataset that was not imported",
            where=str(present[0]),
            why='its meta.toml does not say [source] what = "imported"',
            next_step="choose another --out",
        )


def _write(folder: Path, built: Built, inputs: Sequence[Path]) -> None:
    from brace.dataset.write import write_dataset
    from brace.ground.files import check_folder

    check_folder(folder, ("meta.toml", "data.csv"), inputs)
    write_dataset(folder, built.meta, built.columns, dict.fromkeys(built.columns, DECIMALS))


def _faults(built: Built) -> Sequence[DataFault]:
    """What the dataset's own gate says. A column that can be of no limb is refused: a unit or a sign is wrong."""
    import tempfile  # here, so that the command line's help need not load it

    from brace.dataset import load_dataset
    from brace.dataset.write import write_dataset

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "dataset"
        write_dataset(folder, built.meta, built.columns, dict.fromkeys(built.columns, DECIMALS))
        faults = load_dataset(folder, keep_unreadable=True).faults
    whole = [fault for fault in faults if fault.row is None and fault.blocking]
    if whole:
        fault = whole[0]
        raise BadFileError(
            f"{fault.field} cannot be right" + (f" (and {len(whole) - 1} more)" if whole[1:] else ""),
            why=fault.why,
            next_step=(f"{fault.suggestion}: " if fault.suggestion is not None else "")
            + "correct unit, sign or column in the mapping; nothing was written",
        )
    return faults


def _report(arguments: argparse.Namespace, built: Built, faults: Sequence[DataFault], table: MappingTable) -> None:
    rows = len(next(iter(built.columns.values())))
    runs = len(set(built.columns["run"].tolist())) if "run" in built.columns else None
    poses = len(set(built.columns["config"].tolist())) if "config" in built.columns else None
    if arguments.json:
        common.print_json(
            {
                "out": arguments.out, "kind": table.kind, "rows": rows, "runs": runs, "configurations": poses,
                "columns": list(built.columns), "notes": list(built.notes),
                "data_faults": [fault.as_json() for fault in faults],
            }
        )  # fmt: skip
        return
    for note in built.notes:
        common.say(note)
    for fault in faults:
        common.say(f"data: {fault.sentence(arguments.out / 'data.csv')}")
    counted = f", {runs} runs at {poses} pose{'s' if poses != 1 else ''}" if runs else ""
    common.say(f"{rows} rows{counted} -> {arguments.out}; meta.toml has every conversion")
