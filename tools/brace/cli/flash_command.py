"""`brace flash`: an image onto a board, by the tool that the probe at hand needs."""

from __future__ import annotations

import argparse
import re
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from brace.cli import common
from brace.cli.options import Subcommands, refused
from brace.cli.subcommands import SUBCOMMANDS
from brace.flash.usb import DFU
from brace.ground.errors import UsageError

if TYPE_CHECKING:
    from brace.flash.usb import Probe


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "flash",
        help=SUBCOMMANDS["flash"],
        description="Writes a firmware image with OpenOCD, st-flash or dfu-util. Before that: the image is whole, "
        "is the one that SHA256SUMS beside it lists, and is for that board; something answers. Parameters on the "
        "board stay.",
    )
    parser.add_argument(
        "image", metavar="IMAGE|BOARD", help="an .elf, .hex or .bin; or a board, for the image built for it"
    )
    parser.add_argument("--board", metavar="BOARD", help="refuse an image that is for another board")
    parser.add_argument(
        "--tool",
        choices=("openocd", "st-flash", "dfu-util"),
        help="default: chosen by the probe or board that is plugged in",
    )
    parser.add_argument(
        "--probe", type=_plain, metavar="SERIAL", help="serial number of the probe, when there are several"
    )
    parser.add_argument(
        "--interface",
        type=_plain,
        metavar="NAME",
        help="OpenOCD's name of a probe that is not known here (ftdi/minimodule, say)",
    )
    parser.add_argument(
        "--port",
        type=common.path,
        metavar="TTY",
        help="console of the board: ask it afterwards what runs on it",
    )
    parser.add_argument(
        "--dry-run", action="store_true", help="print command, SHA-256 and target; touch nothing"
    )
    parser.add_argument("--unlisted", action="store_true", help="take an image that no SHA256SUMS lists")
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.flash import checks, console, programmers
    from brace.flash.image import read_image
    from brace.flash.usb import Probe, probes

    probe: Probe | None

    path, wanted = _which(arguments.image, arguments.board)
    image = read_image(path)
    board = checks.board_of(image, wanted)
    address = checks.check_fits(image, board)
    checks.check_listed(image, arguments.unlisted)
    if board.machine:
        raise _emulated(path, board.machine)
    if arguments.interface:
        probe = Probe(arguments.interface, arguments.interface, "")
        tool = "openocd"
    else:
        fitting = [found for found in probes() if _speaks(arguments.tool, found.kind)]
        probe = _chosen(fitting, arguments.probe)
        tool = programmers.choose_tool(arguments.tool, probe)
    plan = programmers.make_plan(tool, image, board, probe, arguments.probe)
    assert image.info is not None
    reported: dict[str, object] = {
        "image": str(plan.file),
        "sha256": read_image(plan.file).sha256,
        "version": image.info.version,
        "hash": image.info.hash,
        "build": image.info.build,
        "board": board.name,
        "target": board.chip,
        "address": f"{address:#010x}",
        "size_bytes": image.end - image.start,
        "tool": tool,
        "command": list(plan.command),
        "probe": probe.name if probe else None,
        "written": False,
    }
    if image.info.hash.endswith("-dirty"):
        common.say("this image was built from sources that were changed and not committed")
    if not arguments.dry_run:
        programmers.check_installed(tool)
        if probe is None:
            raise programmers.nothing_attached(tool, "no debug probe and no boot loader is seen on USB")
        programmers.connect(plan)
        common.say(f"writing {plan.file.name} to the {board.chip}")
        reported["duration_s"] = round(programmers.program(plan), 2)
        reported["written"] = True
        if arguments.port:
            reported["running"] = console.check_running(arguments.port, image.info)
    if arguments.json:
        common.print_json(reported)
    else:
        common.emit(_text(reported, plan.command))
    return 0


def _plain(text: str) -> str:
    """A name that means nothing to a shell or to OpenOCD's own language."""
    if not re.fullmatch(r"[A-Za-z0-9_./:-]+", text):
        raise refused(
            f"{text!r} is no such name",
            "letters, digits and . _ / : - make it up",
            "brace doctor lists probes",
        )
    return text


def _speaks(tool: str | None, kind: str) -> bool:
    """Whether a tool can use such a probe; any tool will do when none was asked for."""
    if tool == "openocd":
        return kind != DFU
    return tool is None or kind == {"st-flash": "stlink", "dfu-util": DFU}[tool]


def _which(named: str, wanted: str | None) -> tuple[Path, str | None]:
    """The image's file and the board it has to be for."""
    from brace.flash.boards import BOARDS
    from brace.flash.checks import known_board

    if wanted:
        known_board(wanted)
    if Path(named).suffix.lower() in (".elf", ".hex", ".bin") or "/" in named:
        return Path(named), wanted
    board = known_board(named)
    if wanted and wanted != named:
        raise UsageError(
            f"--board {wanted} contradicts {named}",
            where="flash",
            why="one board at a time",
            next_step=f"brace flash {named}",
        )
    assert board.name in BOARDS
    path = Path(__file__).resolve().parents[3] / "build" / "m4f" / "images" / f"brace-{board.name}.elf"
    if not path.is_file():
        raise UsageError(
            f"no image for {board.name} is built",
            where=str(path),
            why="brace flash BOARD takes the image of this checkout's build",
            next_step="./dev setup in a checkout; else name an image file, as firmware/brace-stm32f405.elf of a release",
        )
    return path, board.name


def _emulated(path: Path, machine: str) -> UsageError:
    return UsageError(
        f"{machine} is an emulated board",
        where=str(path),
        why="there is nothing to write: the emulator starts with the image",
        next_step=f"qemu-system-arm -machine {machine} -nographic -kernel "
        + shlex.quote(str(path.with_suffix(".elf"))),
    )


def _chosen(found: list[Probe], serial: str | None) -> Probe | None:
    """The probe to use; None when there is none. Several need a serial number."""
    if serial:
        matching = [probe for probe in found if probe.serial == serial]
        if found and not matching:
            raise UsageError(
                f"no probe {serial}",
                where="flash",
                why="seen: " + ", ".join(f"{probe.name} {probe.serial}" for probe in found),
                next_step=f"--probe {found[0].serial}",
            )
        return matching[0] if matching else None
    if len(found) > 1:
        raise UsageError(
            f"{len(found)} probes are plugged in",
            where="flash",
            why=", ".join(f"{probe.name} {probe.serial}" for probe in found),
            next_step=f"--probe {found[0].serial}, or unplug the others",
        )
    return found[0] if found else None


def _text(reported: dict[str, object], command: Sequence[str]) -> str:
    lines = [
        f"image    {reported['image']}",
        f"sha256   {reported['sha256']}",
        f"version  {reported['version']} ({reported['hash']}, {reported['build']})",
        f"target   {reported['board']}: {reported['target']}, {reported['size_bytes']} bytes at {reported['address']}",
        f"command  {shlex.join(command)}",
    ]
    if reported["written"]:
        lines.append(f"written and checked in {reported['duration_s']:g} s by {reported['tool']}")
    else:
        lines.append("dry run: nothing was written")
    if "running" in reported:
        lines.append(f"running  {reported['running']}")
    return "\n".join(lines)
