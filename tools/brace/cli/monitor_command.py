"""`brace monitor`: what controllers report, as it comes."""

from __future__ import annotations

import argparse
import json
import sys
import time
from typing import TYPE_CHECKING

from brace.cli import common
from brace.cli.bus_options import Ended, add_bus, bus_url, ended_by_signal
from brace.cli.monitor_display import Display, emergency_line, end
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS
from brace.ground.errors import UsageError

if TYPE_CHECKING:
    from brace.bus.frame import Bus
    from brace.bus.watch import Watch

WEB_PORT = 8417
FOXGLOVE_PORT = 8765  # the one that Foxglove and PlotJuggler propose
_POLL_S = 0.1
_SILENCE_S = 1.5  # a heartbeat comes each second


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "monitor",
        help=SUBCOMMANDS["monitor"],
        description="Shows what the controllers of a bus send by themselves, until --seconds, Ctrl-C or "
        "the end of a log; "
        "listens only (over Modbus it asks). A terminal gets a picture, a pipe a line a second, --json a line for "
        "every snapshot, K in space, posture, heartbeat and emergency. An emergency is a line of its own, a drift with "
        "its likeliest cause.",
        epilog="Exit codes: 0, 4 nothing heard, 5 the last K is not valid, 6 another dictionary, 130 Ctrl-C.",
    )
    add_bus(parser)
    parser.add_argument("--seconds", type=common.duration, metavar="S", help="how long; default until Ctrl-C")
    parser.add_argument(
        "--web",
        nargs="?",
        type=common.count(0, 65535),
        const=WEB_PORT,
        metavar="PORT",
        help=f"a page for a browser on this computer instead, at http://127.0.0.1:{WEB_PORT}/; port 0: any free one. "
        "It draws each limb to scale: a controller is asked once for its parameters, a log needs --model",
    )
    parser.add_argument(
        "--foxglove",
        nargs="?",
        type=common.count(0, 65535),
        const=FOXGLOVE_PORT,
        metavar="PORT",
        help="Foxglove's WebSocket on this computer instead, for Foxglove and PlotJuggler; default port "
        f"{FOXGLOVE_PORT}",
    )
    parser.add_argument(
        "--model",
        action="append",
        default=[],
        metavar="[NODE=]LIMB.toml",
        help="with --web: lengths and trust of a limb, or of all; may be repeated",
    )
    parser.add_argument(
        "--stance",
        type=common.path,
        metavar="STANCE.toml",
        help="with --web: what each foot of this body bears, above its limbs (docs/stance.md)",
    )
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    url = bus_url(arguments)
    if arguments.stance is not None and arguments.web is None:
        raise UsageError(
            "--stance without --web",
            why="the page shows a stance",
            next_step="--web, or brace stance watch STANCE.toml for a terminal",
        )
    if arguments.web is not None:
        from brace.cli.monitor_web import monitor_web

        return monitor_web(arguments, url)
    if arguments.foxglove is not None:
        from brace.cli.monitor_foxglove import monitor_foxglove

        return monitor_foxglove(arguments, url)
    if url.is_modbus:
        from brace.cli.monitor_modbus import monitor_modbus

        return monitor_modbus(arguments, url)
    from brace.bus.open import open_bus
    from brace.bus.watch import Watch

    watch = Watch(url.text, arguments.node)
    bus = open_bus(url, arguments.bit_rate)
    try:
        with ended_by_signal() as ended:
            follow(arguments, bus, watch, ended)
    finally:
        bus.close()
    return end(arguments, watch)


def follow(arguments: argparse.Namespace, bus: Bus, watch: Watch, ended: Ended) -> None:
    """Frames from the bus to the display; until the time, SIGTERM, or the end of a log."""
    from brace.bus.frame import EndOfLog
    from brace.bus.snapshot import Emergency
    from brace.bus.watch import as_json

    display = Display(arguments.json)
    started = time.monotonic()
    seconds = getattr(arguments, "seconds", None)
    until = started + seconds if seconds is not None else float("inf")
    try:
        while not ended.is_set() and (now := time.monotonic()) < until:
            frame = bus.receive(min(_POLL_S, until - now))
            event = watch.add(frame) if frame is not None else None
            if event is not None and arguments.json:
                common.emit(json.dumps(common.json_ready(as_json(event))))
            if isinstance(event, Emergency):
                display.print_line(emergency_line(event))
            if not watch.nodes and now - started > _SILENCE_S:
                break
            display.show(watch)
    except EndOfLog:
        pass
    finally:
        display.close()
        if arguments.json and sys.stdout is not None:
            sys.stdout.flush()
    if not watch.nodes and not ended.is_set():
        raise _silence(arguments, bus)


def _silence(arguments: argparse.Namespace, bus: Bus) -> Exception:
    from brace.ground.errors import NoDeviceError

    why, way = bus.silence()
    who = "no controller is" if arguments.node is None else f"node {arguments.node} is not"
    return NoDeviceError(f"{who} heard", where=bus.url, why=why, next_step=way)
