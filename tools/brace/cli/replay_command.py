"""`brace replay`: a log once more, to the person or onto a bus."""

from __future__ import annotations

import argparse
import time

from brace.cli import common
from brace.cli.bus_options import bit_rate, ended_by_signal
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS

_SLICE_S = 0.1
_LONG_GAP_S = 5.0


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "replay",
        help=SUBCOMMANDS["replay"],
        description="Decodes a candump or MCAP log as brace monitor does a live bus: --json gives the same lines. With "
        "--bus its frames are sent again, in their own time.",
    )
    parser.add_argument("file", type=common.path, metavar="FILE", help=".log (candump -L) or .mcap")
    parser.add_argument("--bus", metavar="URL", help="can0, slcan:DEVICE or tcp://HOST:PORT to send to")
    parser.add_argument("--bit-rate", type=bit_rate, default=1000000, metavar="BPS", help="of SLCAN, e.g. 500k")
    parser.add_argument("--node", type=common.count(1, 127), metavar="N", help="only this node's frames")
    parser.add_argument(
        "--speed", type=common.positive_ratio, default=1.0, metavar="F", help="with --bus: times faster; default 1"
    )
    common.add_json(parser)
    parser.set_defaults(run=run, seconds=None)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    if arguments.bus is not None:
        return _send(arguments)
    from brace.bus.log import LogBus
    from brace.bus.watch import Watch
    from brace.cli.monitor_command import follow
    from brace.cli.monitor_display import end

    bus = LogBus(f"log:{arguments.file}", arguments.file)
    watch = Watch(str(arguments.file), arguments.node)
    with ended_by_signal() as ended:
        follow(arguments, bus, watch, ended)
    return end(arguments, watch)


def _say_gap(wait_s: float) -> None:
    """Says how long the command will wait, where it waits so long that it seems to hang."""
    if wait_s > _LONG_GAP_S:
        common.say(f"the log's next frame comes in {wait_s:.0f} s; --speed F goes faster, Ctrl-C ends")


def _send(arguments: argparse.Namespace) -> int:
    from brace.bus.frame import NODE_MASK
    from brace.bus.log import read
    from brace.bus.open import open_bus
    from brace.cli.bus_options import bus_url
    from brace.ground.errors import UsageError

    url = bus_url(arguments, "replay")
    if url.kind == "log":
        raise UsageError(
            "a log onto a log", where="--bus", why="frames are sent to a bus", next_step="--bus can0"
        )
    frames = read(arguments.file)
    first = next(frames, None)
    bus = open_bus(url, arguments.bit_rate)
    count, lasted_s = 0, 0.0
    try:
        with ended_by_signal() as ended:
            started = time.monotonic()
            frame = first
            while frame is not None and first is not None and not ended.is_set():
                lasted_s = frame.time_s - first.time_s
                _say_gap(lasted_s / arguments.speed - (time.monotonic() - started))
                while (
                    wait := lasted_s / arguments.speed - (time.monotonic() - started)
                ) > 0 and not ended.is_set():
                    bus.receive(min(wait, _SLICE_S))  # what others send meanwhile must not fill a buffer
                if arguments.node is None or frame.identifier & NODE_MASK == arguments.node:
                    bus.send(frame.identifier, frame.data)
                    count += 1
                frame = next(frames, None)
    finally:
        bus.close()
    if arguments.json:
        common.print_json({"file": arguments.file, "bus": url.text, "frames": count, "seconds": lasted_s})
    else:
        common.say(f"{arguments.file} -> {url.text}: {count} frames, {lasted_s:.3f} s")
    return 0
