"""What is taken from a SocketCAN interface: a list stands in for python-can's bus, which not every kernel has."""

from __future__ import annotations

import can

from brace.bus.socketcan import SocketCanBus


class Queue:
    """python-can's recv, from a list."""

    def __init__(self, *messages: can.Message) -> None:
        self.messages = list(messages)

    def recv(self, timeout_s: float) -> can.Message | None:
        return self.messages.pop(0) if self.messages else None


def test_frames_of_other_kinds_do_not_hide_those_behind_them() -> None:
    bus = SocketCanBus.__new__(SocketCanBus)
    bus.url, bus._can, bus._errors, bus.other_frames = "can0", can, 0, 0
    bus._bus = Queue(
        can.Message(arbitration_id=0x12345, is_extended_id=True),
        can.Message(arbitration_id=0x181, is_extended_id=False, data=b"1"),
        can.Message(arbitration_id=0x181, is_extended_id=False, is_remote_frame=True),
        can.Message(is_error_frame=True),
        can.Message(arbitration_id=0x281, is_extended_id=False, data=b"2"),
        can.Message(arbitration_id=0x12345, is_extended_id=True),
    )
    assert [(frame.identifier, frame.data) for frame in bus.receive_all()] == [(0x181, b"1"), (0x281, b"2")]
    assert (bus._errors, bus.other_frames) == (1, 3) and bus.receive(0.01) is None
