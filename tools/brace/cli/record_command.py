"""`brace record`: a bus to a log, or a loading test to a dataset."""

from __future__ import annotations

import argparse
import signal
import time
from pathlib import Path
from typing import TYPE_CHECKING

from brace.cli import common
from brace.cli.bus_options import add_bus, bus_url, ended_by_signal
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS

if TYPE_CHECKING:
    from brace.bus.recording import Recording
    from brace.bus.watch import Watch


_POLL_S = 0.1
_SILENCE_S = 1.5


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "record",
        help=SUBCOMMANDS["record"],
        description="Writes the frames of a CAN bus to --out FILE.log (as candump -L) or FILE.mcap, "
        "until --seconds, Ctrl-C "
        "or SIGTERM; frames with 29-bit identifiers and remote frames are none of a controller's and are only "
        "counted. While it is written it is called FILE.part, and what has come is in it after any end. "
        "With "
        "--loading-test the controller presses the limb's tip in steps, and its rows become the dataset "
        "--out DIR.",
    )
    add_bus(parser)
    parser.add_argument(
        "--out",
        type=common.path,
        required=True,
        metavar="FILE",
        help=".log, .mcap; with --loading-test a folder",
    )
    parser.add_argument("--seconds", type=common.duration, metavar="S", help="how long; default until Ctrl-C")
    parser.add_argument("--loading-test", action="store_true", help="start one, wait for it, fetch it")
    parser.add_argument(
        "--axis", choices=("x", "z", "both"), default="both", help="of the loading test; default both"
    )
    parser.add_argument(
        "--steps", type=common.count(2, 60), default=6, metavar="N", help="to each side; default 6"
    )
    parser.add_argument(
        "--step-mm", type=common.positive_length, default=0.5, metavar="MM", help="of the tip; default 0.5"
    )
    parser.add_argument(
        "--dwell-s", type=common.duration, default=0.1, metavar="S", help="at each step; default 0.1"
    )
    parser.add_argument(
        "--add",
        action="store_true",
        help="to the loading record that --out already is, as its next configuration (another posture) or "
        "repeat",
    )
    parser.add_argument("--title", default="", metavar="TEXT", help="of the dataset")
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    if arguments.loading_test:
        from brace.cli.record_loading import record_loading

        return record_loading(arguments)
    return _record(arguments)


def _record(arguments: argparse.Namespace) -> int:
    from brace.bus.frame import EndOfLog
    from brace.bus.open import open_bus
    from brace.bus.recording import Recording
    from brace.bus.watch import Watch
    from brace.ground.errors import EXIT_INTERRUPTED, EXIT_OK, BraceError, NoDeviceError

    url = bus_url(arguments, "record")
    inputs = [Path(url.place)] if url.kind == "log" else []
    recording = Recording(arguments.out, url.place if url.kind == "can" else "can0", inputs)
    watch = Watch(url.text, any_dictionary=True)  # frames are kept as they are
    bus = open_bus(url, arguments.bit_rate)
    try:
        # Until the log is in its place no signal raises anything: it would cut a frame that is being written.
        with ended_by_signal(signal.SIGTERM, signal.SIGINT) as ended:
            with common.progress(f"recording {arguments.out}") as advance:
                started = time.monotonic()
                until = started + arguments.seconds if arguments.seconds is not None else float("inf")
                while not ended.is_set() and (now := time.monotonic()) < until:
                    try:
                        frame = bus.receive(min(_POLL_S, until - now))
                    except EndOfLog:
                        break
                    if frame is None:
                        if not recording.frames and now - started > _SILENCE_S:
                            why, way = bus.silence()
                            raise NoDeviceError("nothing is heard", where=url.text, why=why, next_step=way)
                        continue
                    if arguments.node is None or frame.node == arguments.node:
                        recording.add(frame)
                        watch.add(frame)
                        advance(recording.frames)
            recording.finish()
            _say_end(arguments, recording, watch, bus.other_frames)
    except BraceError as error:
        recording.leave()
        if recording.frames:
            error.next_step += f"; the {recording.frames} frames until then are in {recording.part}"
        raise
    finally:
        bus.close()
    return EXIT_INTERRUPTED if ended.by == signal.SIGINT else EXIT_OK


def _say_end(arguments: argparse.Namespace, recording: Recording, watch: Watch, left_out: int) -> None:
    snapshots = {node: state.snapshots for node, state in sorted(watch.nodes.items())}
    in_space = {node: state.in_space for node, state in sorted(watch.nodes.items()) if state.in_space}
    seconds = watch.last_s - watch.first_s
    if arguments.json:
        reported = {"out": recording.path, "frames": recording.frames, "seconds": seconds, "snapshots": snapshots}
        reported["frames_left_out"] = left_out
        common.print_json(reported | ({"snapshots_in_space": in_space} if in_space else {}))
        return
    nodes = ", ".join(
        f"node {node}: {count} K" + (f", {in_space[node]} in space too" if node in in_space else "")
        for node, count in snapshots.items()
    )
    common.say(
        f"{recording.path}: {recording.frames} frames in {seconds:.1f} s; {nodes or 'no K among them'}"
    )
    if left_out:
        common.say(
            f"left out, with 29-bit identifiers or remote: {left_out} of the frames heard; a controller sends none of "
            "these, and candump -L records them"
        )
