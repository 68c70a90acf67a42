"""Bytes over TCP and over serial devices, none of them waited for for ever."""

from __future__ import annotations

import os
import select
import socket
from typing import Any

from brace.bus.slcan import CONNECT_S, SEND_S
from brace.bus.url import BusUrl
from brace.ground.errors import NoDeviceError

_CHUNK = 65536


class TcpLine:
    """A connection."""

    def __init__(self, url: BusUrl) -> None:
        try:
            self._socket = socket.create_connection((url.place, url.port), timeout=CONNECT_S)
        except OSError as error:
            raise _no_connection(url, error) from None
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._socket.settimeout(SEND_S)

    def read(self, timeout_s: float) -> bytes:
        """What has come."""
        if not select.select([self._socket], [], [], timeout_s)[0]:
            return b""
        part = self._socket.recv(_CHUNK)
        if not part:
            raise OSError(0, "the other end has closed the connection")
        return part

    def write(self, data: bytes) -> None:
        """All of it."""
        self._socket.sendall(data)

    def close(self) -> None:
        """For good."""
        self._socket.close()


class SerialLine:
    """A tty or pty."""

    def __init__(self, url: BusUrl) -> None:
        import serial

        try:
            self._port: Any = serial.Serial(
                url.place,
                url.baud,
                timeout=0,
                write_timeout=SEND_S,
                exclusive=True,
                dsrdtr=False,
                rtscts=False,
            )
        except (OSError, ValueError) as error:
            raise no_serial(url, error) from None

    def read(self, timeout_s: float) -> bytes:
        """What has come."""
        if not select.select([self._port.fileno()], [], [], timeout_s)[0]:
            return b""
        part = bytes(os.read(self._port.fileno(), 4096))
        if not part:
            raise OSError(0, "the device has gone")
        return part

    def write(self, data: bytes) -> None:
        """All of it."""
        try:
            self._port.write(data)
        except Exception as error:  # serial's own time-out is no OSError in every version
            raise OSError(0, str(error)) from None

    def close(self) -> None:
        """For good."""
        self._port.close()


def _no_connection(url: BusUrl, error: OSError) -> NoDeviceError:
    if isinstance(error, ConnectionRefusedError):
        why, way = (
            f"nobody listens there, on port {url.port}",
            "start brace sim (it prints its ports), or check the port's number",
        )
    elif isinstance(error, TimeoutError):
        why, way = f"no answer within {CONNECT_S:g} s", "check host name and network"
    elif isinstance(error, socket.gaierror):
        why, way = f"no host is called {url.place}", "check the name, or give its address"
    else:
        why, way = error.strerror or str(error), "check host and port"
    return NoDeviceError("no connection", where=url.text, why=why, next_step=way)


def no_serial(url: BusUrl, error: Exception) -> NoDeviceError:
    """Why a serial device cannot be opened."""
    number = getattr(error, "errno", None)
    if number == 2 or "No such file" in str(error):
        why, way = f"there is no {url.place}", "ls /dev/tty*; is the adapter plugged in?"
    elif number == 13 or "Permission" in str(error):
        why, way = "no rights to it", "sudo usermod -aG dialout $USER, and log in again"
    elif number in (11, 16) or "exclusive" in str(error).lower():
        why, way = "another program has it", f"fuser {url.place} names the program; end it"
    else:
        why, way = str(error), "check that it is a serial device, and its baud rate"
    return NoDeviceError("the serial device cannot be opened", where=url.text, why=why, next_step=way)
