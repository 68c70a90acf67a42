"""One CAN frame with the time it was received."""

from __future__ import annotations

from typing import NamedTuple, Protocol

NODE_MASK = 0x7F
BROADEST_BYTES = 8


class Frame(NamedTuple):
    """Eleven-bit identifier, up to eight bytes; with more it is one of CAN FD."""

    time_s: float  # since 1970, on this computer's clock
    identifier: int
    data: bytes

    @property
    def is_fd(self) -> bool:
        """More than classic CAN can carry."""
        return len(self.data) > BROADEST_BYTES

    @property
    def node(self) -> int:
        """Whose frame it is, where the identifier is one of ours; 0: nobody's."""
        return self.identifier & NODE_MASK


class Bus(Protocol):
    """Where frames come from and go to. One caller; every call ends in time."""

    url: str
    bit_rate: int | None  # None: set elsewhere
    other_frames: int  # passed over so far: of 29-bit identifiers, or remote

    def receive(self, timeout_s: float) -> Frame | None:
        """The next frame; None when none came in time. EndOfLog after a log's last."""

    def receive_all(self) -> list[Frame]:
        """Those that have come, without waiting; of a log, some. EndOfLog after a log's last."""

    def send(self, identifier: int, data: bytes) -> None:
        """One frame; NoDeviceError when the bus does not take it."""

    def silence(self) -> tuple[str, str]:
        """Why nothing may be heard here, and what to try."""

    def close(self) -> None:
        """Twice is once."""


class EndOfLog(Exception):
    """A log has no further frame."""
