"""`brace doctor`: what of this machine is there, what is missing, and how to get it."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from brace.cli import common
from brace.cli.bus_options import add_bus
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS
from brace.ground.errors import EXIT_CHECK_FAILED, EXIT_OK, located

if TYPE_CHECKING:
    from brace.doctor.finding import Finding


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    from brace.doctor.finding import ALWAYS_NEEDED, CONTROLLER, PURPOSES

    parser = commands.add_parser(
        "doctor",
        help=SUBCOMMANDS["doctor"],
        description="Looks at compilers, emulator, programmers, probes, serial ports, CAN, Python packages, and "
        "whether library and images are built and fresh; with --bus also at a controller's faults and counters. Exit "
        "code 1 when something needed is missing or old, or the controller has a fault: of "
        f"{' and '.join(ALWAYS_NEEDED)} always, of the rest when --needed names it. Changes nothing.",
    )
    of_machine = {name: meaning for name, meaning in PURPOSES.items() if name != CONTROLLER}
    parser.add_argument(
        "--needed", nargs="+", choices=tuple(of_machine), default=[], metavar="FOR",
        help="also needed: " + ", ".join(f"{name} ({meaning})" for name, meaning in of_machine.items()),
    )  # fmt: skip
    add_bus(parser, required=False)
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.doctor.builds import builds
    from brace.doctor.finding import CONTROLLER, Machine
    from brace.doctor.hardware import hardware
    from brace.doctor.programs import programs, python_packages

    machine = Machine()
    findings: list[Finding] = []
    for look in (python_packages, programs, hardware, builds):
        findings += look(machine)
    needed = {*machine.needed, *arguments.needed}
    if arguments.bus is not None:
        findings += _of_controller(arguments)
        needed.add(CONTROLLER)
    lacking = [finding for finding in findings if finding.purpose in needed and not finding.is_good]
    if arguments.json:
        common.print_json({
            "good": not lacking,
            "needed": sorted(needed),
            "findings": [{"for": f.purpose, "name": f.name, "state": f.state, "found": f.found, "try": f.next_step}
                         for f in findings],
        })  # fmt: skip
    else:
        common.emit(_text(findings, needed, len(lacking)))
    return EXIT_CHECK_FAILED if lacking else EXIT_OK


def _of_controller(arguments: argparse.Namespace) -> list[Finding]:
    from brace.cli.bus_options import controller
    from brace.doctor.controller import controller as looked_at

    with controller(arguments) as device:
        return list(looked_at(f"{device.url}, node {device.node}", device.read_entry))


def _text(findings: list[Finding], needed: set[str], lacking: int) -> str:
    from brace.doctor.finding import PURPOSES

    lines = []
    there = {finding.purpose for finding in findings}
    for purpose, meaning in ((name, text) for name, text in PURPOSES.items() if name in there):
        lines += ["", f"{meaning}{'' if purpose in needed else ' (optional)'}"]
        for finding in (finding for finding in findings if finding.purpose == purpose):
            lines.append(f"  {finding.state:<8} {finding.name:<22} {finding.found}")
            if finding.next_step:
                lines.append(f"  {'':<8} {'':<22} try: {located(finding.next_step)}")
    missing = f"{lacking} of the things that are needed: missing, too old or faulty, see 'try' above"
    lines += ["", missing if lacking else "everything needed is there"]
    return "\n".join(lines[1:])
