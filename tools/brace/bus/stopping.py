"""Stopping limbs: anybody may, and nothing is asked before."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable

from brace.bus.entries import index_of
from brace.bus.frame import Bus
from brace.bus.session import Session
from brace.bus.url import BusUrl
from brace.ground.errors import DeviceFaultError, NoDeviceError
from brace.wire.codes import MODE
from brace.wire.frames import REQUEST_ID, REQUESTS

STOP_ID = 1  # of the frame that stops every limb of a bus: controller.stop_id, unless set otherwise
HEAR_S = 1.2  # a heartbeat comes each second
AGAIN_S = 0.02
STANDS_S = 0.3  # within which a controller that has heard the stop reports it
_STOP, _STOP_ID_ENTRY = "loading_test_stop", "controller.stop_id"
_MOVING = ("TAKING_UP", "LOADING_TEST")


def stop_on(bus: Bus, node: int | None, stop_id: int = STOP_ID) -> dict[int, bool]:
    """Sends the stop at once and again until every limb that is heard stands; one limb where a node is given. A limb
    that obeys another identifier gets that one, too. returns of each node whether something is held there; elsewhere
    nothing moves. NoDeviceError where none answers, DeviceFaultError where one moves on."""
    _send(bus, node, stop_id)
    session = Session(bus, node or 0)
    until = time.monotonic() + HEAR_S
    while node is None and time.monotonic() < until:
        session.listen(AGAIN_S)
        _send(bus, node, stop_id)
    nodes = sorted(session.heard) if node is None else [node]
    if not nodes:
        why, way = bus.silence()
        raise NoDeviceError("the stop is sent, and no controller is heard", where=bus.url, why=why, next_step=way)
    for one in nodes:
        _send(bus, one, stop_id)  # each its own, before one of them is waited for
    return {one: _stop_one(bus, one, stop_id, is_alone=node is not None) for one in nodes}


def _stop_one(bus: Bus, node: int, stop_id: int, is_alone: bool) -> bool:
    """Of one limb that is heard. returns whether something is held"""
    session = Session(bus, node)

    def entry(name: str) -> int:
        return int(session.ask("read_entry", {"index": index_of(name)})["value"] or 0)

    with contextlib.suppress(DeviceFaultError):  # refused where nothing moves
        session.ask(_STOP)
    own_id = entry(_STOP_ID_ENTRY)
    if not is_alone and own_id != stop_id:
        bus.send(own_id, b"")
    return _is_held(entry, session.where)


def _is_held(entry: Callable[[str], int], where: str) -> bool:
    """As the controller measures it. False: nothing is held, and nothing moves."""
    until = time.monotonic() + STANDS_S
    while True:
        is_held, mode = entry("is_held") == 1, MODE.name_of(entry("mode"))
        if is_held or mode not in _MOVING:
            return is_held
        if time.monotonic() >= until:
            raise DeviceFaultError(
                "the stop is sent, and the limb moves on",
                where=where,
                why=f"its mode is {mode.lower()}, and it does not report that it is held",
                next_step="take the drives' power away; then brace doctor --bus URL",
            )
        time.sleep(AGAIN_S)


def _send(bus: Bus, node: int | None, stop_id: int) -> None:
    if node is None:
        bus.send(stop_id, b"")
    else:
        bus.send(REQUEST_ID + node, REQUESTS[_STOP].encode({}, 0))


def stop_by_register(url: BusUrl) -> dict[int, bool]:
    """The same for one unit of Modbus."""
    from brace.bus.modbus_line import connected
    from brace.bus.ownership import register_of

    line = connected(url)

    def entry(name: str) -> int:
        high, low = line.read("input", register_of(name), 2).registers
        return int(high) << 16 | int(low)

    try:
        answer = line.write(register_of("stop"), [0, 1])
        if answer.isError() and getattr(answer, "exception_code", 0) != 1:  # 1: nothing moves
            raise DeviceFaultError(
                "the unit does not take the stop",
                where=url.text,
                why=f"Modbus exception {getattr(answer, 'exception_code', 0)}",
                next_step="check host, port and unit; brace query shows who answers there",
            )
        return {url.unit: _is_held(entry, url.text)}
    finally:
        line.close()
