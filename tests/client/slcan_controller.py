"""A controller on SLCAN over TCP, in Python, that can be made to misbehave.
Shares no code with the C on either side."""

from __future__ import annotations

import socket
import struct
import threading
import time
from collections.abc import Callable
from pathlib import Path
from types import TracebackType

import cantools

from brace.wire.frames import DICTIONARY_HASH, PROTOCOL, REQUESTS

IDENTIFY, READ_ENTRY, CONTACT_FORCE = 20, 1, 6
# The numbers of the frames that answer a request, by its code. No frame of write_entry's answer is one of them.
ANSWER_NUMBERS = {IDENTIFY: (32, 33, 34, 35, 36), READ_ENTRY: (1,), CONTACT_FORCE: (15, 16), 2: (2,), 15: (27,),
                  16: (28,), 18: (30,), 32: (67,)}  # fmt: skip
REFUSED = 255
COMMANDS = [REQUESTS[name].command for name in ("take_up", "let_go", "write_entry", "loading_test_stop", "sign_of_life")]
DATABASE = Path(__file__).resolve().parents[2] / "firmware" / "interface" / "brace.dbc"
STREAM_S = 0.02


class SlcanController:
    """Heartbeats, and answers to identify, read_entry and contact_force. One connection at a time."""

    def __init__(
        self,
        node: int = 1,
        hash_: int = DICTIONARY_HASH,
        speaks: bool = True,
        answers: bool = True,
        errors: int = 0,
        garbage: bytes = b"",
        flood: bytes = b"",
        hangs_up: bool = False,
        echo_first: bool = False,
        refuses_force: tuple[int, int] | None = None,
        noise_first: bytes = b"",
        entries: Callable[[int], int | None] | None = None,
        streams: Callable[[float], int | None] | None = None,
        numbers_answers: bool = True,
    ) -> None:
        """entries: values of entries, which else are 12345.5; None: no answer. streams: numbers of the snapshots whose
        K is sent every 20 ms, from the seconds since a client has come; None: nothing is sent. numbers_answers: as
        protocol 2 does; else an answer's first byte is the code and 32 times its part, as protocol 1 did."""
        self.node, self.hash, self.speaks, self.answers, self.errors = node, hash_, speaks, answers, errors
        self.garbage, self.flood, self.hangs_up, self.echo_first = garbage, flood, hangs_up, echo_first
        self.refuses_force, self.noise_first = refuses_force, noise_first  # status and detail; sent once
        self.entries, self.streams, self.numbers_answers = entries, streams, numbers_answers
        self.database = cantools.database.load_file(DATABASE) if streams else None
        self.requests: list[bytes] = []
        self.heard_s: list[float] = []
        self.forced: list[float] = []
        self._server = socket.create_server(("127.0.0.1", 0))
        self._server.settimeout(0.1)
        self._ends = False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self.url = f"tcp://127.0.0.1:{self._server.getsockname()[1]}"

    def __enter__(self) -> SlcanController:
        self._thread.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None,
                 trace: TracebackType | None) -> None:
        self._ends = True
        self._thread.join(timeout=5)
        self._server.close()

    def _run(self) -> None:
        while not self._ends:
            try:
                line, _ = self._server.accept()
            except TimeoutError:
                continue
            with line:
                line.settimeout(0.02)
                line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                try:
                    self._serve(line)
                except OSError:
                    pass  # the client has gone

    def _serve(self, line: socket.socket) -> None:
        rest, beat, came, sent = b"", 0.0, time.monotonic(), 0.0
        line.sendall(self.noise_first)
        if self.flood:  # faster than it can be read
            line.settimeout(5.0)
            while not self._ends:
                line.sendall(self.flood)
        while not self._ends:
            if time.monotonic() >= beat:
                beat = time.monotonic() + 0.1
                if self.speaks:
                    self._frame(line, 0x700 + self.node, struct.pack("<BBBBI", 5, 1, 1, PROTOCOL, self.hash))
                if self.garbage:
                    line.sendall(self.garbage)
            if self.streams and time.monotonic() >= sent:
                sent = time.monotonic() + STREAM_S
                self._stiffness(line, self.streams(time.monotonic() - came))
            try:
                part = line.recv(4096)
            except TimeoutError:
                continue
            if not part:
                return
            *commands, rest = (rest + part).split(b"\r")
            for command in commands:
                if command == b"F":
                    line.sendall(b"F%02X\r" % self.errors)
                elif command.startswith(b"t"):
                    if self.hangs_up:
                        return
                    self._request(line, int(command[1:4], 16), bytes.fromhex(command[5:].decode()))

    def _request(self, line: socket.socket, identifier: int, data: bytes) -> None:
        if identifier != 0x600 + self.node or not self.answers:
            return
        self.requests.append(data)
        self.heard_s.append(time.monotonic())
        code, token = data[0], data[1]
        if self.echo_first and len(self.requests) == 2:  # another client asks the same; the answer is to it
            self._frame(line, 0x600 + self.node, data)
            for part in range(len(ANSWER_NUMBERS[code])):
                self._answer(line, code, part, token, b"\x11" * 6)
            return
        if code == IDENTIFY:
            for part, fields in enumerate((
                struct.pack("<BBBBBB", 1, 2, 3, PROTOCOL, self.node, 0),
                struct.pack("<IH", self.hash, 0),
                struct.pack("<IH", 0xAABBCCDD, 0),
                struct.pack("<IBB", 0x12345678, 2, 0),
                struct.pack("<IBB", 0, 1, 1),
            )):  # fmt: skip
                self._answer(line, code, part, token, fields)
        elif code == READ_ENTRY:
            index = int.from_bytes(data[2:4], "little")
            if self.entries:
                value = self.entries(index)
                if value is not None:
                    self._answer(line, code, 0, token, struct.pack("<HI", index, value))
            elif index == 77:
                self._refuse(line, code, token, -3, index)
            elif index == 78:  # an older answer of another token comes first, then a foreign code
                self._answer(line, code, 0, (token - 1) & 255, struct.pack("<HI", index, 111))
                self._answer(line, 2, 0, token, struct.pack("<HI", index, 222))
                self._answer(line, code, 0, token, struct.pack("<HI", index, 333))
            else:
                self._answer(line, code, 0, token, struct.pack("<Hf", index, 12345.5))
        elif code == CONTACT_FORCE and self.refuses_force:
            self._refuse(line, code, token, *self.refuses_force)
        elif code == CONTACT_FORCE:  # each try is another tick; of the first, half an answer
            tick = len(self.forced) + 1.0
            self.forced.append(tick)
            step = round(tick * 1000)
            self._answer(line, code, 0, token, step.to_bytes(3, "little") * 2)
            if tick > 1.0:
                self._answer(line, code, 1, token, step.to_bytes(3, "little") * 2)

        elif code in COMMANDS:
            self._answer(line, code, 0, token, data[2:8])

    def _stiffness(self, line: socket.socket, number: int | None) -> None:
        """Both frames of K."""
        for name in ("stiffness_a", "stiffness_b") if number is not None else ():
            message = self.database.get_message_by_name(name)
            values = {signal.name: 0 for signal in message.signals} | {"sequence": number}
            self._frame(line, message.frame_id + self.node - 1, message.encode(values, strict=False))

    def _answer(self, line: socket.socket, code: int, part: int, token: int, fields: bytes) -> None:
        number = ANSWER_NUMBERS[code][part] if self.numbers_answers else code + 32 * part
        self._frame(line, 0x580 + self.node, bytes((number, token)) + fields)

    def _refuse(self, line: socket.socket, code: int, token: int, status: int, detail: int) -> None:
        self._frame(line, 0x580 + self.node, bytes((REFUSED, token, code)) + struct.pack("<bI", status, detail))

    @staticmethod
    def _frame(line: socket.socket, identifier: int, data: bytes) -> None:
        line.sendall(b"t%03X%d%s\r" % (identifier, len(data), data.hex().upper().encode()))
