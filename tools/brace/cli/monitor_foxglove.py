"""`brace monitor --foxglove`: every K as it comes, for Foxglove and PlotJuggler on this computer."""

from __future__ import annotations

import argparse
import json
import sys
import time
from typing import TYPE_CHECKING

from brace.bus.frame import EndOfLog
from brace.bus.log import LogBus
from brace.bus.open import open_bus
from brace.bus.snapshot import Joiner
from brace.cli import common
from brace.cli.bus_options import Ended, ended_by_signal
from brace.ground.errors import EXIT_OK, UsageError

if TYPE_CHECKING:
    from brace.bus.frame import Bus
    from brace.bus.url import BusUrl

HOST = "127.0.0.1"
_POLL_S = 0.1
_NS = 1_000_000_000


def monitor_foxglove(arguments: argparse.Namespace, url: BusUrl) -> int:
    """Until --seconds, Ctrl-C or SIGTERM; of a log until its end, in its own time."""
    try:
        import foxglove
    except ModuleNotFoundError as error:
        raise UsageError(
            "Foxglove cannot be served", where="--foxglove", why=str(error), next_step="pip install foxglove-sdk"
        ) from None
    if url.is_modbus:
        raise UsageError(
            "--foxglove over Modbus", where=url.text, why="it sends on what comes by itself, as over CAN",
            next_step="--bus can0, slcan:DEVICE, tcp://HOST:PORT or log:FILE",
        )
    bus = open_bus(url, arguments.bit_rate)
    try:
        server = foxglove.start_server(name="brace", host=HOST, port=arguments.foxglove)
    except (OSError, RuntimeError) as error:
        bus.close()
        raise UsageError(
            f"port {arguments.foxglove} of {HOST} cannot be opened", where="--foxglove", why=str(error),
            next_step="--foxglove 0 takes any free port, and prints which",
        ) from None
    try:
        with ended_by_signal() as ended:
            common.emit(f"open ws://{HOST}:{server.port} in Foxglove or PlotJuggler; Ctrl-C ends it")
            if sys.stdout is not None:
                sys.stdout.flush()
            _follow(arguments, bus, ended)
    except EndOfLog:
        pass
    finally:
        server.stop()
        bus.close()
    return EXIT_OK


def _follow(arguments: argparse.Namespace, bus: Bus, ended: Ended) -> None:
    """Topics and messages as `brace record --out FILE.mcap` has them."""
    from foxglove import Channel

    joiner, topics = Joiner(), dict[int, Channel]()
    until = time.monotonic() + (arguments.seconds if arguments.seconds is not None else float("inf"))
    behind_s: float | None = None  # of a log: how far its clock is behind this computer's
    while not ended.is_set() and time.monotonic() < until:
        frame = bus.receive(_POLL_S)
        if frame is None or (arguments.node is not None and frame.node != arguments.node):
            continue
        if isinstance(bus, LogBus):
            behind_s = time.time() - frame.time_s if behind_s is None else behind_s
            time.sleep(max(0.0, frame.time_s + behind_s - time.time()))
        snapshot = joiner.add(frame)
        if snapshot is None:
            continue
        if snapshot.node not in topics:
            topics[snapshot.node] = Channel(f"/limb_{snapshot.node}/stiffness", message_encoding="json")
        message = json.dumps(common.json_ready(snapshot.as_json())).encode()
        topics[snapshot.node].log(message, log_time=round(snapshot.time_s * _NS))
