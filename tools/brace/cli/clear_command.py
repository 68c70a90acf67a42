"""`brace clear`: clears latched faults of a controller."""

from __future__ import annotations

import argparse

from brace.cli import common
from brace.cli.bus_options import add_bus, controller
from brace.cli.options import Subcommands, refused
from brace.cli.subcommands import SUBCOMMANDS

# said on the command line: the faults' names in the dictionary
STAYING = {
    "drift": ("model_drift",),
    "crash": ("crashed",),
    "encoder": ("encoder_stuck",),
    "jump": ("jump_coxa", "jump_femur", "jump_tibia"),
    "parameters": ("old_parameters",),
}
DRIFT = "model_drift"


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "clear",
        help=SUBCOMMANDS["clear"],
        description="drift (model_drift): the limb is again what it was commissioned as; the check watches on from the "
        "baseline it holds. A limb that is another one now wants its parameters instead: brace identify, brace params "
        "push. crash (crashed): the crash has been looked into; its record is gone afterwards, so read the console's "
        "banner first. encoder (encoder_stuck): the joint stands and its encoder works; one that does not is "
        "seen again. jump (jump_coxa, jump_femur, jump_tibia, or one of them by its name): the joint stands where its "
        "encoders say, so look at it first; what they say next is believed. parameters (old_parameters): the set in "
        "force is taken until the next start, though another one was stored after it; brace params push ends it for "
        "good. All other faults end with their cause.",
        epilog="Exit codes: 0 it is not there (any more), 2 a fault that cannot be cleared, 4 no answer, 5 the device "
        "refuses or the fault is back at once, 6 another dictionary.",
    )
    parser.add_argument("faults", nargs="+", type=_staying, metavar="FAULT", help=", ".join(STAYING))
    add_bus(parser)
    common.add_json(parser)
    parser.set_defaults(run=run)


def _staying(text: str) -> tuple[str, ...]:
    """Faults that are cleared on request, by either name."""
    name = text.lower()
    names = STAYING.get(name, (name,))
    if not any(set(names) <= set(known) for known in STAYING.values()):
        raise refused(
            f"{text!r} is not a latched fault",
            f"the latched faults are {', '.join(STAYING)}; every other fault ends with its cause",
            "brace query shows which faults are there, docs/errors.md what each of them wants",
        )
    return names


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.bus.drift import cause_text
    from brace.ground.errors import DeviceFaultError

    with controller(arguments) as device:
        before = _names(device.read_entry("faults"))
        wanted = list(dict.fromkeys(name for names in arguments.faults for name in names))
        asked = [name for name in wanted if name in before]
        absent = [" or ".join(names) for names in dict.fromkeys(arguments.faults) if not set(names) & set(before)]
        cause = device.drift().cause if DRIFT in asked else "none"  # before it is cleared
        faults = _names(device.clear(_bits(asked))) if asked else before
        where = f"{device.url}, node {device.node}"
    back = [name for name in asked if name in faults]
    if back:
        raise DeviceFaultError(
            f"{' and '.join(back)} cleared, and there again",
            where=where,
            why="its cause is still there",
            next_step="docs/errors.md says what each fault wants; brace monitor shows when it comes",
        )
    if arguments.json:
        reported = {"drift_cause": cause} if DRIFT in asked else {}
        common.print_json({"node": device.node, "cleared": asked, "faults": faults, **reported})
        return 0
    for name in asked:
        common.say(f"{where}: cleared {name}")
    for name in absent:
        common.say(f"{where}: {name} is not there, nothing to clear")
    if cause != "none":
        common.say(f"the drift's likeliest cause was {cause_text(cause)}")
    common.say(f"faults now: {' '.join(faults) or 'none'}")
    return 0


def _names(bits: int) -> list[str]:
    from brace.bus.entries import names_of

    return [name.lower() for name in names_of("faults", bits)]


def _bits(names: list[str]) -> int:
    from brace.wire.codes import FAULT

    return sum(1 << fault.number for fault in FAULT.codes if fault.name.lower() in names)
