"""`brace query`: what a controller says, once."""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from brace.cli import common
from brace.cli.bus_options import add_bus, controller
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS

if TYPE_CHECKING:
    from brace.bus.controller import Controller


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "query",
        help=SUBCOMMANDS["query"],
        description="Asks a controller: the K of now with the load that it counts, what its drift check knows and how "
        "take-ups went; K at a posture or tip position that the limb need not be in, under its weight and, with --fx "
        "--fz, a force; or any entry of the dictionary. A limb whose coxa joint "
        "is fitted reports K in space too.",
        epilog="Exit codes: 0 a valid K (or the entry), 4 no answer, 5 K is not valid or the device refuses, "
        "6 another dictionary.",
    )
    add_bus(parser)
    parser.add_argument(
        "--theta0",
        type=common.angle,
        metavar="RAD",
        help="true coxa angle: K in space; with --theta1 --theta2, of a limb whose coxa joint is fitted",
    )
    parser.add_argument("--theta1", type=common.angle, metavar="RAD", help="true femur angle; with --theta2")
    parser.add_argument("--theta2", type=common.flexion, metavar="RAD", help="true knee angle")
    parser.add_argument(
        "--x", type=common.length, metavar="MM", help="tip outwards from the femur axis; with --z"
    )
    parser.add_argument("--z", type=common.length, metavar="MM", help="tip above the femur axis")
    parser.add_argument("--knee", choices=("up", "down"), help="for --x --z; default up")
    parser.add_argument(
        "--fx", type=common.force, metavar="N", help="force of the ground on the tip there, outwards; with --fz"
    )
    parser.add_argument("--fz", type=common.force, metavar="N", help="the same upwards")
    parser.add_argument(
        "--fy", type=common.force, metavar="N", help="the same across the limb's plane, to the left; with --theta0"
    )
    parser.add_argument(
        "--load",
        nargs=2,
        type=common.force,
        metavar=("FX", "FZ"),
        help="how far the tip yields to a force [N]",
    )
    parser.add_argument(
        "--sag",
        nargs=2,
        type=common.length,
        metavar=("DX", "DZ"),
        help="what force a displacement meets [mm]",
    )
    parser.add_argument(
        "--entry",
        action="append",
        default=[],
        metavar="NAME",
        help="a value of the dictionary; may be repeated",
    )
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    _check(arguments)
    with controller(arguments) as device:
        if arguments.entry:
            return _entries(arguments, device)
        if arguments.theta0 is not None:
            return _asked_in_space(arguments, device)
        if arguments.theta1 is not None or arguments.x is not None:
            return _asked(arguments, device)
        if arguments.load is not None or arguments.sag is not None:
            return _yielding(arguments, device)
        return _live(arguments, device)


def _check(arguments: argparse.Namespace) -> None:
    from brace.bus.entries import index_of
    from brace.ground.errors import UsageError

    for one, other in (("theta1", "theta2"), ("x", "z"), ("fx", "fz")):
        if (getattr(arguments, one) is None) != (getattr(arguments, other) is None):
            raise UsageError(
                f"--{one} and --{other} belong together",
                where="query",
                why="one of them alone is no place",
                next_step="give both, or none for the K of now",
            )
    if arguments.theta0 is not None and arguments.theta1 is None:
        raise UsageError(
            "--theta0 without --theta1 --theta2",
            where="query",
            why="the coxa joint alone is no posture",
            next_step="give all three, or --theta1 --theta2 for K in the limb's plane",
        )
    places = [getattr(arguments, name) is not None for name in ("theta1", "x", "load", "sag")]
    places.append(bool(arguments.entry))
    if sum(places) > 1:
        raise UsageError(
            "one question at a time",
            where="query",
            why="posture, tip, load, sag and entries exclude each other",
            next_step="two commands",
        )
    if arguments.fx is not None and arguments.theta1 is None and arguments.x is None:
        raise UsageError(
            "--fx --fz without a place",
            where="query",
            why="the K of now counts the force of now",
            next_step="give --theta1 --theta2 or --x --z too",
        )
    in_space = arguments.theta0 is not None and arguments.fx is not None
    if (arguments.fy is not None) != in_space:
        raise UsageError(
            "--fy belongs to --theta0 with --fx --fz",
            where="query",
            why="a force on a limb in space has three parts, one on a limb in its plane two",
            next_step="give --theta0, --fx, --fy and --fz, or drop --fy" if not in_space else "give --fy, 0 for none",
        )
    if arguments.knee and arguments.x is None:
        raise UsageError(
            "--knee without --x --z", where="query", why="angles say it already", next_step="drop --knee"
        )
    for name in arguments.entry:
        index_of(name)


def _entries(arguments: argparse.Namespace, device: Controller) -> int:
    from brace.bus.entries import unit_of, value_of

    values = {name: value_of(name, device.read_entry(name)) for name in arguments.entry}
    if arguments.json:
        common.print_json(
            {
                "node": device.node,
                "entries": {name: {"value": v, "unit": unit_of(name)} for name, v in values.items()},
            }
        )
        return 0
    for name, value in values.items():
        common.emit(f"{name} = {'not known' if value is None else _text(value)} {unit_of(name)}".rstrip())
    return 0


def _text(value: object) -> str:
    if isinstance(value, list):
        return " ".join(value) or "none"
    return f"{value:.7g}" if isinstance(value, float) else str(value)


def _asked(arguments: argparse.Namespace, device: Controller) -> int:
    from brace.bus.load import factor_words
    from brace.ground.errors import EXIT_DEVICE_FAULT, EXIT_OK

    force = None if arguments.fx is None else (arguments.fx, arguments.fz)
    if arguments.x is not None:
        answer = device.k_at_tip(arguments.x, arguments.z, arguments.knee != "down", force)
        place = {"x_mm": arguments.x, "z_mm": arguments.z, "knee": arguments.knee or "up"}
    else:
        answer = device.k_at_posture(arguments.theta1, arguments.theta2, force)
        place = {"theta1_rad": arguments.theta1, "theta2_rad": arguments.theta2}
    if force is not None:
        place |= {"fx_n": force[0], "fz_n": force[1]}
    valid = None not in (answer.k_xx, answer.k_xz, answer.k_zz)
    k = {
        "k_xx_n_per_mm": answer.k_xx,
        "k_xz_n_per_mm": answer.k_xz,
        "k_zz_n_per_mm": answer.k_zz,
        "lambda_min_n_per_mm": answer.lambda_min,
        "lambda_max_n_per_mm": answer.lambda_max,
        "stiff_axis_rad": answer.stiff_axis,
        "flag_names": list(answer.flags),
    }
    if force is not None:
        k |= {
            "tip_dx_mm": answer.moved_x,
            "tip_dz_mm": answer.moved_z,
            "buckling_factor": None if answer.buckling_factor == math.inf else answer.buckling_factor,
        }
    if arguments.json:
        common.print_json({"node": device.node, **place, "k_is_valid": valid, **k})
    else:
        reported = ", ".join(
            f"{name} {value:g}" if isinstance(value, float) else f"{name} {value}"
            for name, value in place.items()
        )
        common.emit(f"node {device.node} at {reported}")
        _emit_k(k, valid)
        if force is not None and None not in (answer.moved_x, answer.moved_z):
            common.emit(f"force and weight move the tip by {answer.moved_x:.3f} {answer.moved_z:.3f} mm")
            common.emit(f"buckling factor {factor_words(answer.buckling_factor)}")
    if not valid:
        _say_invalid(
            device, "K there is not known", ", ".join(answer.flags) or "the controller does not say why"
        )
    return EXIT_OK if valid else EXIT_DEVICE_FAULT


def _asked_in_space(arguments: argparse.Namespace, device: Controller) -> int:
    from brace.bus.controller import NO_FORCE
    from brace.cli.space_text import space_lines
    from brace.ground.errors import EXIT_DEVICE_FAULT, EXIT_OK

    angles = {name: getattr(arguments, name) for name in ("theta0", "theta1", "theta2")}
    force = NO_FORCE if arguments.fx is None else (arguments.fx, arguments.fy, arguments.fz)
    place = {f"{name}_rad": value for name, value in angles.items()}
    answer = device.k_in_space_at_posture(**place, force_n=force)
    if arguments.fx is not None:
        place |= dict(zip(("fx_n", "fy_n", "fz_n"), force, strict=True))
    if arguments.json:
        moved = dict(zip(("tip_dx_mm", "tip_dy_mm", "tip_dz_mm"), answer.moved_mm, strict=True))
        common.print_json({"node": device.node, **place, **answer.as_json(), **moved})
    else:
        common.emit(f"node {device.node} at {', '.join(f'{name} {value:g}' for name, value in place.items())}")
        for line in space_lines(answer):
            common.emit(line)
        if None not in answer.moved_mm:
            moved_text = " ".join(f"{value:.2f}" for value in answer.moved_mm if value is not None)
            common.emit(f"force and weight move the tip by {moved_text} mm in the limb's plane's frame")
    if not answer.is_valid:
        why = ", ".join(answer.flags) or "the controller does not say why"
        _say_invalid(device, "K in space there is not known", why)
    return EXIT_OK if answer.is_valid else EXIT_DEVICE_FAULT


def _yielding(arguments: argparse.Namespace, device: Controller) -> int:
    from brace.ground.errors import EXIT_DEVICE_FAULT, EXIT_OK

    if arguments.load is not None:
        given = dict(zip(("fx_n", "fz_n"), arguments.load))
        answer = device.sag_for_load(*arguments.load)
    else:
        given = dict(zip(("dx_mm", "dz_mm"), arguments.sag))
        answer = device.contact_force(*arguments.sag)
    known = None not in answer.values()
    if arguments.json:
        common.print_json({"node": device.node, "given": given, **answer})
    else:
        common.emit(
            ", ".join(
                f"{name} {'not known' if v is None else format(v, '.4f')}" for name, v in answer.items()
            )
        )
    if not known:
        _say_invalid(
            device, "there is no answer", "K is not valid now, or the answer is beyond the frame's range"
        )
    return EXIT_OK if known else EXIT_DEVICE_FAULT


def _live(arguments: argparse.Namespace, device: Controller) -> int:
    from brace.bus.drift import take_up_lines
    from brace.bus.open_play import open_play_lines
    from brace.cli.space_text import coxa_lines, space_lines
    from brace.ground.errors import EXIT_DEVICE_FAULT, EXIT_OK

    identity = device.identify()
    snapshot = device.live()
    entry = snapshot.as_json() | {
        "firmware_version": identity.version,
        "dictionary_hash": f"{identity.dictionary_hash:08x}",
        "parameters": identity.origin,
        "parameter_crc": f"{identity.parameter_crc:08x}",
    }
    load = snapshot.load if snapshot.load is not None else device.load()
    sigma = snapshot.sigma if snapshot.sigma is not None else device.sigma()
    interval = snapshot.interval if snapshot.interval is not None else device.interval()
    entry |= sigma.as_json() | {"interval": interval.as_json()}
    drift, take_ups = device.drift(), device.take_ups()
    faults = snapshot.faults or ()
    if arguments.json:
        common.print_json(entry | {"load": load.as_json(), "drift": drift.as_json(), "take_up": take_ups})
    else:
        common.emit(
            f"node {snapshot.node}, firmware {identity.version}: {entry.get('mode', 'mode not sent')}"
        )
        _emit_k(entry, snapshot.is_valid)
        if snapshot.is_valid:
            common.emit(sigma.line((snapshot.k_xx, snapshot.k_xz, snapshot.k_zz), "GAP_OPEN" in snapshot.flags))
        if snapshot.has_posture and None not in (snapshot.theta1, snapshot.theta2):
            common.emit(f"theta1 {snapshot.theta1:.5f} rad, theta2 {snapshot.theta2:.5f} rad")
        for line in load.lines((snapshot.k_xx, snapshot.k_xz, snapshot.k_zz), "GAP_OPEN" in snapshot.flags):
            common.emit(line)
        for line in interval.words():
            common.emit(line)
        age = "over 127 ms" if snapshot.age_ms is None else f"{snapshot.age_ms:g} ms"
        common.emit(f"age {age}; play femur {snapshot.play[0]}, tibia " f"{snapshot.play[1]}")
        engaged = device.engaged_k() if "GAP_OPEN" in snapshot.flags else None
        for line in open_play_lines(snapshot.flags, snapshot.play, str(device.url), engaged):
            common.emit(line)
        common.emit(
            f"faults {' '.join(faults) or 'none'}; "
            f"parameters {identity.origin}, CRC {identity.parameter_crc:08x}"
        )
        if snapshot.space is not None:
            for line in [*space_lines(snapshot.space), *coxa_lines(snapshot.space)]:
                common.emit(line)
        for line in [*take_up_lines(take_ups), *drift.lines()]:
            common.emit(line)
    if not snapshot.is_valid:
        _say_invalid(device, "K is not valid", ", ".join([f"mode {snapshot.mode}", *faults, *snapshot.flags]))
    return EXIT_OK if snapshot.is_valid else EXIT_DEVICE_FAULT


def _emit_k(entry: Mapping[str, object], valid: bool) -> None:
    if not valid:
        common.emit("K not valid")
        _emit_flags(entry)
        return
    common.emit(
        "K = [{k_xx_n_per_mm:.4f} {k_xz_n_per_mm:.4f}; {k_xz_n_per_mm:.4f} {k_zz_n_per_mm:.4f}] N/mm".format_map(entry)
    )
    if None not in (
        entry.get("lambda_min_n_per_mm"),
        entry.get("lambda_max_n_per_mm"),
        entry.get("stiff_axis_rad"),
    ):
        common.emit(
            "eigenvalues {lambda_min_n_per_mm:.4f} and {lambda_max_n_per_mm:.4f} N/mm, "
            "stiff axis {stiff_axis_rad:.4f} rad".format_map(entry)
        )
    _emit_flags(entry)


def _emit_flags(entry: Mapping[str, object]) -> None:
    from brace.wire.codes import FLAG

    flags = entry["flag_names"]
    for line in FLAG.texts_of(flags if isinstance(flags, list) else []):
        common.emit(f"flag {line}")


def _say_invalid(device: Controller, what: str, why: str) -> None:
    from brace.ground.errors import DeviceFaultError

    common.say(
        DeviceFaultError(
            what,
            where=f"{device.url}, node {device.node}",
            why=why,
            next_step="brace monitor shows when it comes back",
        )
        .render()
        .removeprefix("brace: ")
    )
