"""SocketCAN, through python-can."""

from __future__ import annotations

import errno
import socket
import time
from functools import partial
from pathlib import Path
from typing import Any

from brace.bus.frame import Frame
from brace.bus.url import BusUrl
from brace.ground.errors import MissingLibraryError, NoDeviceError

SEND_S = 1.0
SKIPPED_MOST = 4096  # frames of other kinds that one call passes over
_INTERFACES = Path("/sys/class/net")


class SocketCanBus:
    """A CAN interface of the kernel; its bit rate is the system's to set."""

    def __init__(self, url: BusUrl) -> None:
        self.url = url.text
        self.bit_rate: int | None = None
        self.other_frames = 0
        self._errors = 0
        refuse_absent(url)
        try:
            import can
        except ImportError as error:
            raise MissingLibraryError(
                "python-can is not installed",
                why=str(error),
                next_step="pip install python-can, or ./dev setup",
            ) from None
        self._can = can
        try:
            self._bus: Any = can.Bus(interface="socketcan", channel=url.place, fd=True)
        except (OSError, can.CanError) as error:
            raise self._lost(error) from None

    def receive(self, timeout_s: float) -> Frame | None:
        """The next frame; error frames are counted. Frames of other kinds do not hide those behind them."""
        until_s = time.monotonic() + timeout_s
        for _ in range(SKIPPED_MOST):
            try:
                message = self._bus.recv(max(0.0, until_s - time.monotonic()))
            except (OSError, self._can.CanError) as error:
                raise self._lost(error) from None
            if message is None:
                return None
            if message.is_error_frame:
                self._errors += 1
            elif message.is_extended_id or message.is_remote_frame:
                self.other_frames += 1
            else:
                return Frame(message.timestamp, message.arbitration_id, bytes(message.data))
        return None

    def receive_all(self) -> list[Frame]:
        """Those that have come."""
        return list(iter(partial(self.receive, 0.0), None))

    def send(self, identifier: int, data: bytes) -> None:
        """One frame."""
        message = self._can.Message(arbitration_id=identifier, data=data, is_extended_id=False)
        try:
            self._bus.send(message, timeout=SEND_S)
        except (OSError, self._can.CanError) as error:
            raise self._lost(error) from None

    def silence(self) -> tuple[str, str]:
        """Error frames show another bit rate."""
        if self._errors:
            return (
                f"{self._errors} error frames were heard: the interface's bit rate is not the "
                f"controller's, or the "
                f"wiring",
                f"ip -details link show {self.url}; ip link set {self.url} down; "
                f"ip link set {self.url} type can bitrate 1000000",
            )
        return (
            f"{self.url} is up, and nothing is on the bus",
            "check the controller's power, wiring and bit rate; a controller whose node_id is 0 only listens",
        )

    def close(self) -> None:
        """For good."""
        self._bus.shutdown()

    def _lost(self, error: Exception) -> NoDeviceError:
        number = getattr(error, "error_code", None) or getattr(error, "errno", None)
        if number == errno.ENETDOWN:
            why = "the interface is down"
            rate = "" if self.url.startswith("vcan") else " type can bitrate 1000000"
            way = f"ip link set {self.url} up{rate}"
        elif number == errno.ENOBUFS:
            why, way = (
                "the interface takes no more frames: nobody on the bus acknowledges them",
                "check wiring and bit rate",
            )
        else:
            why, way = str(error), f"ip -details link show {self.url}"
        return NoDeviceError("the CAN interface does not work", where=self.url, why=why, next_step=way)


def refuse_absent(url: BusUrl) -> None:
    """No CAN in the kernel, no such interface, an interface that is down: each in its own words."""
    family = getattr(socket, "AF_CAN", None)
    try:
        if family is None:
            raise OSError(errno.EAFNOSUPPORT, "no SocketCAN on this system")
        socket.socket(family, socket.SOCK_RAW, getattr(socket, "CAN_RAW", 1)).close()
    except OSError as error:
        raise NoDeviceError(
            "this kernel has no CAN",
            where=url.text,
            why=f"SocketCAN is not there ({error.strerror or error})",
            next_step="modprobe can_raw; or --bus slcan:/dev/ttyACM0 or tcp://HOST:PORT, which need none",
        ) from None
    if _INTERFACES.is_dir() and not (_INTERFACES / url.place).exists():
        known = sorted(entry.name for entry in _INTERFACES.iterdir() if _kind(entry) == "280")
        raise NoDeviceError(
            "no such CAN interface",
            where=url.text,
            why=f"CAN interfaces here: {', '.join(known) or 'none'}",
            next_step=(
                f"--bus {known[0]}"
                if known
                else f"ip link add dev {url.place} type vcan && ip link set {url.place} up, or plug the adapter in"
            ),
        )
    if (_INTERFACES / url.place).is_dir() and _kind(_INTERFACES / url.place) != "280":
        raise NoDeviceError(
            "not a CAN interface",
            where=url.text,
            why="it is a network interface of another kind",
            next_step="ip -brief link",
        )


def _kind(entry: Path) -> str:
    try:
        return (entry / "type").read_text().strip()
    except OSError:
        return ""
