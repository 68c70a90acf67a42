"""From a URL to a bus."""

from __future__ import annotations

from pathlib import Path

from brace.bus.frame import Bus
from brace.bus.url import BusUrl

DEFAULT_BIT_RATE = 1_000_000


def open_bus(url: BusUrl, bit_rate: int = DEFAULT_BIT_RATE) -> Bus:
    """A CAN bus or a log; NoDeviceError within some two seconds when it is not there."""
    if url.kind == "can":
        from brace.bus.socketcan import SocketCanBus

        return SocketCanBus(url)
    if url.kind == "log":
        from brace.bus.log import LogBus

        return LogBus(url.text, Path(url.place))
    from brace.bus.lines import SerialLine, TcpLine
    from brace.bus.slcan import SlcanBus, check_bit_rate

    check_bit_rate(bit_rate)
    return SlcanBus(url, TcpLine(url) if url.kind == "tcp" else SerialLine(url), bit_rate)
