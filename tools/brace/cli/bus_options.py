"""--bus, --node, --bit-rate: what the commands on a bus share."""

from __future__ import annotations

import argparse
import contextlib
import signal
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from brace.cli import common
from brace.cli.options import refused
from brace.ground.units import amount

if TYPE_CHECKING:
    from brace.bus.controller import Controller
    from brace.bus.session import Session
    from brace.bus.url import BusUrl

_KILO = {"": 1, "bit/s": 1, "bps": 1, "k": 1000, "kbit/s": 1000, "kbps": 1000, "kbit": 1000, "m": 1000000,
         "mbit/s": 1000000, "mbps": 1000000, "mbit": 1000000}  # fmt: skip
_LEAST_BPS, _MOST_BPS = 10000, 1000000


def bit_rate(text: str) -> int:
    """500000, 500k, 500kbit/s or 1M, in bit/s."""
    found = amount(text)
    factor = None if found is None else _KILO.get(found[1].lower())
    if found is None or factor is None:
        raise refused(f"{text[:40]!r} is no bit rate", "a number is wanted, in bit/s, k or M", "OPTION 500k")
    rate = round(found[0] * factor)
    if not _LEAST_BPS <= rate <= _MOST_BPS:
        raise refused(f"{text} is {rate} bit/s, out of range", "CAN through SLCAN has 10k to 1M", "OPTION 500k")
    return rate


def add_bus(parser: argparse.ArgumentParser, required: bool = True) -> None:
    """--bus URL and what belongs to it."""
    parser.add_argument(
        "--bus",
        required=required,
        metavar="URL",
        help="can0, slcan:/dev/ttyACM0[@BAUD], tcp://HOST:PORT (SLCAN), modbus:/dev/ttyUSB0[@BAUD][/UNIT], "
        "modbus-tcp://HOST:PORT[/UNIT], log:FILE",
    )
    parser.add_argument(
        "--node",
        type=common.count(0, 127),
        metavar="N",
        help="CAN node; default: the only one on the bus. 0: a controller without a number, over its own SLCAN port",
    )
    parser.add_argument(
        "--key",
        type=Path,
        metavar="FILE",
        help="key of a guarded controller, for commands: 32 hexadecimal digits. Reading needs none",
    )
    parser.add_argument(
        "--bit-rate",
        type=bit_rate,
        default=1000000,
        metavar="BPS",
        help="of CAN through SLCAN, e.g. 500k; default 1000000. A SocketCAN interface has its own",
    )


def bus_url(arguments: argparse.Namespace, frames_for: str = "", answers: bool = False) -> BusUrl:
    """The URL; refused where frames are needed and it has registers, and where answers are and it is a log."""
    from brace.bus.url import parse
    from brace.ground.errors import UsageError

    url = parse(arguments.bus)
    if frames_for and url.is_modbus:
        raise UsageError(
            f"{frames_for} over Modbus",
            where=url.text,
            why="it needs the frames of a CAN bus",
            next_step="--bus can0, slcan:DEVICE or tcp://HOST:PORT; brace query and monitor work over Modbus",
        )
    if answers and url.kind == "log":
        from brace.bus.log import no_answers

        raise no_answers(url.text)
    return url


def key_of(arguments: argparse.Namespace) -> bytes | None:
    """--key, read."""
    from brace.bus.ownership import load_key

    return None if arguments.key is None else load_key(arguments.key)


@contextlib.contextmanager
def session(arguments: argparse.Namespace, url: BusUrl) -> Iterator[Session]:
    """A CAN session with the node asked for, or the only one."""
    from brace.bus.open import open_bus
    from brace.bus.session import Session

    key = key_of(arguments)
    bus = open_bus(url, arguments.bit_rate)
    try:
        yield Session(bus, arguments.node, key)
    finally:
        bus.close()


@contextlib.contextmanager
def controller(arguments: argparse.Namespace) -> Iterator[Controller]:
    """A controller that speaks our dictionary, on whatever wire."""
    url = bus_url(arguments, answers=True)
    if url.is_modbus:
        from brace.bus.modbus_controller import ModbusController

        device = ModbusController(url, key_of(arguments))
        try:
            yield device
        finally:
            device.close()
        return
    from brace.bus.can_controller import CanController

    with session(arguments, url) as opened:
        yield CanController(opened)


class Ended:
    """Which signal has asked for the end. It has no lock: a handler may come in the middle of another one."""

    def __init__(self) -> None:
        self.by: int | None = None

    def is_set(self) -> bool:
        """The end is asked for."""
        return self.by is not None

    def take(self, number: int, _frame: object) -> None:
        """The signals' handler; the first one counts."""
        if self.by is None:
            self.by = number


@contextlib.contextmanager
def ended_by_signal(*signals: signal.Signals) -> Iterator[Ended]:
    """Yields an event that SIGTERM sets, or each of the signals given, so that a command can end in order. The signal
    raises no exception, so nothing is cut in its middle. A signal that this process ignores stays ignored: a shell lets
    the background jobs of a script ignore Ctrl-C."""
    ended = Ended()
    if threading.current_thread() is not threading.main_thread():
        yield ended
        return
    before = {}
    for number in signals or (signal.SIGTERM,):
        if signal.getsignal(number) != signal.SIG_IGN:
            before[number] = signal.signal(number, ended.take)
    try:
        yield ended
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextlib.contextmanager
def undone_by_signal() -> Iterator[None]:
    """SIGTERM ends as Ctrl-C does, so that what was begun is undone."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
