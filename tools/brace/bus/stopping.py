"""Stopping limbs: anybody may, and nothing is asked before."""

from __future__ import annotations

import contextlib
import time

from brace.bus.frame import Bus
from brace.bus.session import Session
from brace.bus.url import BusUrl
from brace.errors import DeviceFaultError, NoDeviceError
from brace.wire.frames import REQUEST_ID, REQUESTS

STOP_ID = 1  # of the frame that stops every limb of a bus: controller.stop_id, unless set otherwise
HEAR_S = 1.2  # a heartbeat comes each second
AGAIN_S = 0.02
_STOP = "loading_test_stop"


def stop_on(bus: Bus, node: int | None) -> list[int]:
    """Sends the stop at once and again until every limb that is heard stands; one limb where a node is given. returns their
    nodes. NoDeviceError where none answers."""
    _send(bus, node)
    session = Session(bus, node or 0)
    until = time.monotonic() + HEAR_S
    while node is None and time.monotonic() < until:
        session.listen(AGAIN_S)
        _send(bus, node)
    nodes = sorted(session.heard) if node is None else [node]
    if not nodes:
        why, way = bus.silence()
        raise NoDeviceError("the stop is sent, and no controller is heard", where=bus.url, why=why, next_step=way)
    for one in nodes:
        with contextlib.suppress(DeviceFaultError):  # refused where nothing moves
            Session(bus, one).ask(_STOP)
    return nodes


def _send(bus: Bus, node: int | None) -> None:
    if node is None:
        bus.send(STOP_ID, b"")
    else:
        bus.send(REQUEST_ID + node, REQUESTS[_STOP].encode({}, 0))


def stop_by_register(url: BusUrl) -> int:
    """The same for one unit of Modbus. returns the unit"""
    from brace.bus.modbus_line import connected
    from brace.bus.ownership import register_of

    line = connected(url)
    try:
        answer = line.write(register_of("stop"), [0, 1])
    finally:
        line.close()
    if answer.isError() and getattr(answer, "exception_code", 0) != 1:  # 1: nothing moves
        raise DeviceFaultError(
            "the unit does not take the stop",
            where=url.text,
            why=f"Modbus exception {getattr(answer, 'exception_code', 0)}",
            next_step="check host, port and unit; brace query shows who answers there",
        )
    return url.unit
