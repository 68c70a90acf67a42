"""`brace stance`: a body on several limbs: who carries what, which foot lets go first."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from brace.cli import common, stance_watch
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS
from brace.ground.errors import EXIT_DEVICE_FAULT, EXIT_OK, EXIT_USAGE, UsageError

if TYPE_CHECKING:
    import numpy as np

    from brace.stance.stance_file import Stance
    from brace.stance.world import Measured, NoStanceError

SENSOR_SD_N = 0.3


def add(commands: Subcommands) -> None:
    """Declares the subcommand and its actions."""
    parser = commands.add_parser(
        "stance",
        help=SUBCOMMANDS["stance"],
        description="A body that is braced by several limbs is statically indeterminate: the limbs' stiffness decides "
        "who carries what. stance.toml says where the limbs are mounted, their models and angles, the ground under "
        "each foot, the weight and the payload (docs/stance.md). Forces are the ground's on the feet, in the body's "
        "frame: x forward, y left, z up.",
        epilog="Exit codes: 0 done, 2 usage, 3 bad file, 5 no such stance: the body would slide, fall or turn.",
    )
    actions = parser.add_subparsers(metavar="ACTION", dest="action")
    _add_show(actions)
    _add_load(actions)
    _add_lift(actions)
    _add_range(actions)
    _add_set(actions)
    _add_choose(actions)
    stance_watch.add(actions, SENSOR_SD_N)
    parser.set_defaults(run=lambda _arguments: _help(parser))


def _help(parser: argparse.ArgumentParser) -> int:
    parser.print_help(sys.stderr)
    return EXIT_USAGE


def _add_show(actions: Subcommands) -> None:
    parser = actions.add_parser(
        "show",
        help="the feet, each limb's K, how stiffly the body stands",
        description="Each foot's place and K [N/mm] in the body's frame, and how far the body gives way to a newton in "
        "x, y and z, and to a newton metre about them, while every foot sticks.",
    )
    parser.add_argument("stance", type=common.path, metavar="STANCE.toml", help="the stance")
    common.add_json(parser)
    parser.set_defaults(run=_show)


def _add_load(actions: Subcommands) -> None:
    parser = actions.add_parser(
        "load",
        help="what each foot bears under the payload, and which lets go first",
        description="The ground's force on each foot under weight and payload, what the payload changes, how the body "
        "moves, the payload at which the first foot slides or lets go. Intervals hold the truth with 90 %: they "
        "follow from what stance.toml and [uncertainty] of limb.toml say of footholds, zeros, lengths, compliances "
        "and friction. Absolute forces hang on the last millimetre of the footholds; --measured forces before the "
        "payload make them good, and K says what the payload changes.",
    )
    parser.add_argument(
        "stances",
        type=common.path,
        nargs="+",
        metavar="STANCE.toml",
        help="the stance; of several one line of JSON each",
    )
    parser.add_argument(
        "--measured",
        type=common.path,
        nargs="+",
        metavar="CSV",
        help="forces before the payload: limb,fx_n,fy_n,fz_n in the body's frame, or the joints' torques "
        "limb,tau0_n_mm,tau1_n_mm,tau2_n_mm; as many files as stances",
    )
    parser.add_argument(
        "--measured-sd",
        type=common.positive_force,
        default=SENSOR_SD_N,
        metavar="N",
        help=f"one sigma of a measured force's components; default {SENSOR_SD_N:g}",
    )
    parser.add_argument(
        "--draws", type=common.count(20, 10_000), default=100, metavar="N",
        help="of what is not known, for the intervals; default 100",
    )  # fmt: skip
    parser.add_argument(
        "--picture", type=common.path, metavar="PNG", help="body, limbs, forces, each foot's friction cone"
    )
    common.add_json(parser)
    parser.set_defaults(run=_load)


def _add_lift(actions: Subcommands) -> None:
    parser = actions.add_parser(
        "lift",
        help="what is left when a foot lets go, for each foot",
        description="Takes each foot in turn, or the named one, off the ground under weight and payload: what the "
        "others bear then, and whether the body still stands.",
    )
    parser.add_argument("stance", type=common.path, metavar="STANCE.toml", help="the stance")
    parser.add_argument("--limb", metavar="NAME", help="this one alone")
    _add_measured(parser)
    common.add_json(parser)
    parser.set_defaults(run=_lift)


def _add_range(actions: Subcommands) -> None:
    parser = actions.add_parser(
        "range",
        help="the least and the most that each foot may bear, whatever has slipped before",
        description="Where nobody knows what has slipped before and no forces are measured: the least and the most of "
        "each foot's force over every history, and the largest payload that any forces bear. Stiffness does not come "
        "into it. `load` says what a foot bears of all this when the feet were put down without load.",
    )
    parser.add_argument("stance", type=common.path, metavar="STANCE.toml", help="the stance")
    common.add_json(parser)
    parser.set_defaults(run=_range)


def _add_measured(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--measured", type=common.path, metavar="CSV", help="forces before the payload, as for load")
    parser.add_argument(
        "--measured-sd", type=common.positive_force, default=SENSOR_SD_N, metavar="N", help="as for load"
    )


def _add_set(actions: Subcommands) -> None:
    parser = actions.add_parser(
        "set",
        help="how to move the tips' set-points: for the largest margin, wanted forces, or no sag",
        description="A position-controlled limb cannot choose its force, but its set-point does. Prints how far to "
        "move each tip's set-point under weight and payload, the angles to command for it, and the forces then. Forces "
        "that are --measured before the payload make the answer good, as for load. K is not known exactly: measure "
        "again --with-payload where the set-points have moved, with the new theta_rad and the printed offset_mm in "
        "stance.toml, and ask again.",
    )
    parser.add_argument("stance", type=common.path, metavar="STANCE.toml", help="the stance")
    parser.add_argument(
        "--for",
        dest="aim",
        choices=("margin", "forces", "sag"),
        default="margin",
        help="the largest smallest margin (default), the forces of --wanted, or the body where it is without load",
    )
    parser.add_argument(
        "--move",
        metavar="LIMB:X,Y,Z",
        nargs="+",
        help="instead: moves the set-points of these tips [mm, body's frame] and says what changes",
    )
    parser.add_argument("--wanted", type=common.path, metavar="CSV", help="with --for forces: limb,fx_n,fy_n,fz_n")
    parser.add_argument(
        "--travel", type=common.positive_length, default=5.0, metavar="MM", help="most way in x, y and z; default 5"
    )
    _add_measured(parser)
    parser.add_argument("--with-payload", action="store_true", help="--measured was read under the payload")
    common.add_json(parser)
    parser.set_defaults(run=_set)


def _add_choose(actions: Subcommands) -> None:
    parser = actions.add_parser(
        "choose",
        help="which of several footholds a limb should take next, and with which knee",
        description="Tries each foothold of the table with each posture of the limb that reaches it, the other feet "
        "where they are, and sorts: by the payload at which the first foot moves, by the smallest margin under the "
        "payload, or by how far the body sags.",
    )
    parser.add_argument("stance", type=common.path, metavar="STANCE.toml", help="the stance, its limb at any angles")
    parser.add_argument("--limb", required=True, metavar="NAME", help="which limb takes a foothold")
    parser.add_argument(
        "--footholds",
        type=common.path,
        required=True,
        metavar="CSV",
        help="foothold,x_mm,y_mm,z_mm in the body's frame; nx,ny,nz, friction, grip_n where they are not the limb's",
    )
    parser.add_argument(
        "--for", dest="aim", choices=("slip", "margin", "sag"), default="slip", help="what is best; default slip"
    )
    common.add_json(parser)
    parser.set_defaults(run=_choose)


def _show(arguments: argparse.Namespace) -> int:
    from brace.stance.text import shown
    from brace.stance.view import view

    def ask(stance: Stance) -> dict[str, object] | str:
        found = view(stance)
        return found.as_json() if arguments.json else shown(found)

    return _answer_or_reason(arguments, ask, arguments.stance)


def _load(arguments: argparse.Namespace) -> int:
    from brace.stance.answer import answer
    from brace.stance.text import loaded

    files: list[Path | None] = [None] * len(arguments.stances)
    if arguments.measured:
        if len(arguments.measured) != len(arguments.stances):
            raise UsageError(
                f"{len(arguments.measured)} tables for {len(arguments.stances)} stances",
                why="each stance has its own measured forces",
                next_step="as many --measured files as stances, in the same order",
            )
        files = list(arguments.measured)
    if arguments.picture and len(arguments.stances) > 1:
        raise UsageError(
            "--picture of several stances",
            why="a picture shows one",
            next_step="name one stance, or leave --picture out",
        )
    worst = EXIT_OK
    for path, measured in zip(arguments.stances, files, strict=True):

        def ask(stance: Stance, measured: Path | None = measured) -> dict[str, object] | str:
            found = answer(stance, _measured(arguments, stance, measured), arguments.draws)
            if arguments.picture:
                from brace.ground.files import write_file
                from brace.stance.picture import picture

                write_file(arguments.picture, picture(found), arguments.stances)
            return found.as_json() if arguments.json else loaded(found)

        worst = max(worst, _answer_or_reason(arguments, ask, path, is_one=len(files) == 1))
    return worst


def _measured(arguments: argparse.Namespace, stance: Stance, path: Path | None) -> Measured | None:
    if path is None:
        return None
    from brace.stance.measured import load_measured
    from brace.stance.world import believed

    return load_measured(path, stance, believed(stance), arguments.measured_sd)


def _lift(arguments: argparse.Namespace) -> int:
    from brace.stance.lift import lift
    from brace.stance.text import lifted

    def ask(stance: Stance) -> dict[str, object] | str:
        names = [limb.name for limb in stance.limbs]
        if arguments.limb is not None and arguments.limb not in names:
            raise UsageError(
                f"no limb {arguments.limb!r}",
                why=f"the stance has {', '.join(names)}",
                next_step="name one of them, or leave --limb out for all",
            )
        found = lift(stance, arguments.limb, _measured(arguments, stance, arguments.measured))
        return {"lifted": [one.as_json() for one in found]} if arguments.json else lifted(found)

    return _answer_or_reason(arguments, ask, arguments.stance)


def _range(arguments: argparse.Namespace) -> int:
    from brace.stance.histories import ranges
    from brace.stance.text import ranged

    def ask(stance: Stance) -> dict[str, object] | str:
        found = ranges(stance)
        return found.as_json() if arguments.json else ranged(found)

    return _answer_or_reason(arguments, ask, arguments.stance)


def _set(arguments: argparse.Namespace) -> int:
    from brace.stance import setpoints
    from brace.stance.text import set_points

    if (arguments.aim == "forces") != (arguments.wanted is not None):
        raise UsageError(
            "--for forces and --wanted CSV belong together",
            why="the table says which forces are wanted",
            next_step="give both, or neither",
        )

    if arguments.move and arguments.aim != "margin":
        raise UsageError(
            f"--move and --for {arguments.aim}",
            why="--move says how the tips move, --for asks for it",
            next_step="leave one of them out",
        )
    if arguments.with_payload and arguments.measured is None:
        raise UsageError(
            "--with-payload without --measured",
            why="it says how the measured forces were read",
            next_step="give --measured CSV, or leave --with-payload out",
        )

    def ask(stance: Stance) -> dict[str, object] | str:
        measured = _measured(arguments, stance, arguments.measured)
        begun = setpoints.Begun(stance, measured, arguments.with_payload)
        if arguments.move:
            found = setpoints.moved(begun, _ways_mm(stance, arguments.move))
        elif arguments.aim == "forces":
            wanted = _measured(arguments, stance, arguments.wanted)
            assert wanted is not None
            found = setpoints.wanted_forces(begun, wanted.force_n, arguments.travel)
        elif arguments.aim == "sag":
            found = setpoints.least_sag(begun)
        else:
            found = setpoints.largest_margin(begun, arguments.travel)
        return found.as_json() if arguments.json else set_points(found)

    return _answer_or_reason(arguments, ask, arguments.stance)


def _ways_mm(stance: Stance, moves: Sequence[str]) -> np.ndarray:
    """A row a limb."""
    import numpy as np

    names = [limb.name for limb in stance.limbs]
    ways = np.zeros((len(names), 3))
    for move in moves:
        name, _, said = move.rpartition(":")
        try:
            way = np.array([float(part) for part in said.split(",")])
        except ValueError:
            way = np.zeros(0)
        if name not in names or way.shape != (3,) or not np.all(np.isfinite(way)):
            raise UsageError(
                f"--move {move!r}",
                why=f"it takes one of {', '.join(names)}, a colon, and three numbers [mm]",
                next_step=f"for instance --move {names[0] + ':0,0,0.5'!r}",
            )
        ways[names.index(name)] += way
    return ways


def _choose(arguments: argparse.Namespace) -> int:
    from brace.stance.choose import choose, load_footholds
    from brace.stance.text import chosen

    def ask(stance: Stance) -> dict[str, object] | str:
        names = [limb.name for limb in stance.limbs]
        if arguments.limb not in names:
            raise UsageError(
                f"--limb {arguments.limb!r}",
                why=f"the stance has {', '.join(names)}",
                next_step=f"--limb {names[0]!r}, or another of these names",
            )
        limb = stance.limbs[names.index(arguments.limb)]
        found = choose(stance, arguments.limb, load_footholds(arguments.footholds, limb), arguments.aim)
        return {"choices": [one.as_json() for one in found]} if arguments.json else chosen(found)

    return _answer_or_reason(arguments, ask, arguments.stance)


def _answer_or_reason(
    arguments: argparse.Namespace,
    ask: Callable[[Stance], dict[str, object] | str],
    path: Path,
    is_one: bool = True,
) -> int:
    """Prints what is asked, or why there is no such stance."""
    from brace.stance.stance_file import load_stance
    from brace.stance.world import NoStanceError

    try:
        found = ask(load_stance(path))
    except NoStanceError as error:
        return _no_stance(arguments, path, error, is_one)
    if isinstance(found, str):
        common.emit(found)
    else:
        _print(found, is_one)
    return EXIT_OK


def _no_stance(arguments: argparse.Namespace, path: Path, error: NoStanceError, is_one: bool) -> int:
    from brace.stance.text import reason

    if arguments.json:
        _print(error.as_json(), is_one)
    else:
        common.say(reason(str(path), error))
    return EXIT_DEVICE_FAULT


def _print(found: dict[str, object], is_one: bool) -> None:
    if is_one:
        common.print_json(found)
    else:
        common.emit(json.dumps(common.json_ready(found)))
