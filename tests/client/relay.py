"""A way to a controller that writes down what a client sends, and may send it twice or lose some of it."""

from __future__ import annotations

import contextlib
import socket
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field


@dataclass
class Relay:
    """What has passed, with its time, in the pieces in which it came."""

    url: str
    sent: list[tuple[float, bytes]] = field(default_factory=list)

    def frames(self) -> list[tuple[float, bytes]]:
        """The data of the client's SLCAN frames; the time is that of a frame's end."""
        found: list[tuple[float, bytes]] = []
        rest = b""
        for at_s, part in self.sent:
            *lines, rest = (rest + part).split(b"\r")
            found += [(at_s, bytes.fromhex(line[5:].decode())) for line in lines if line.startswith(b"t")]
        return found

    def requests(self) -> list[tuple[float, bytes]]:
        """The client's Modbus TCP requests, from the function on."""
        stream = b"".join(part for _, part in self.sent)
        ends, total = [], 0
        for at_s, part in self.sent:
            total += len(part)
            ends.append((total, at_s))
        found: list[tuple[float, bytes]] = []
        while stream:
            length = int.from_bytes(stream[4:6], "big")
            done = total - len(stream) + 6 + length
            found.append((next(at_s for end, at_s in ends if end >= done), stream[7 : 6 + length]))
            stream = stream[6 + length :]
        return found


def _doubled(part: bytes) -> bytes:
    """Every SLCAN frame twice; other lines once."""
    lines = part.split(b"\r")
    return b"\r".join(line + b"\r" + line if line.startswith(b"t") else line for line in lines)


def kept(part: bytes, loses: Callable[[bytes], bool]) -> bytes:
    """Without the SLCAN frames whose data is to be lost."""
    lines = part.split(b"\r")
    return b"\r".join(
        line for line in lines if not (line[:1] == b"t" and loses(bytes.fromhex(line[5:21].decode())))
    )


@contextlib.contextmanager
def relayed(
    url: str,
    doubles: bool = False,
    loses: Callable[[bytes], bool] | None = None,
    drops: Callable[[int], bool] | None = None,
) -> Iterator[Relay]:
    """To the controller at this URL, for one client at a time. drops: which of its pieces, by number from 1."""
    scheme, _, place = url.partition("://")
    host, _, port = place.rpartition(":")
    with socket.create_server(("127.0.0.1", 0)) as server:
        relay = Relay(f"{scheme}://127.0.0.1:{server.getsockname()[1]}")

        def pump(source: socket.socket, sink: socket.socket, is_client: bool) -> None:
            rest = b""
            with contextlib.suppress(OSError):
                while part := source.recv(65536):
                    if is_client:
                        relay.sent.append((time.monotonic(), part))
                    if is_client and drops and drops(len(relay.sent)):
                        continue
                    if is_client and doubles:  # whole lines
                        lines, mark, rest = (rest + part).rpartition(b"\r")
                        part = _doubled(lines) + mark
                    if is_client and loses:
                        lines, mark, rest = (rest + part).rpartition(b"\r")
                        part = kept(lines, loses) + mark
                    sink.sendall(part)
            with contextlib.suppress(OSError):
                sink.shutdown(socket.SHUT_WR)

        def run() -> None:
            with contextlib.suppress(OSError):
                while True:
                    ours, theirs = server.accept()[0], socket.create_connection((host, int(port)))
                    for one, other, is_client in ((ours, theirs, True), (theirs, ours, False)):
                        one.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                        threading.Thread(target=pump, args=(one, other, is_client), daemon=True).start()

        threading.Thread(target=run, daemon=True).start()
        yield relay
