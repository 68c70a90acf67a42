"""What a controller asks of whoever moves its limb or writes to it: signs of life that carry back a number it has sent
lately and, on a guarded board, checks and seals (docs/security.md)."""

from __future__ import annotations

import struct
import time
from pathlib import Path

from brace.bus.siphash import KEY_BYTES, siphash
from brace.ground.errors import DeviceFaultError, UsageError
from brace.wire.codes import SETTING
from brace.wire.registers import REGISTERS

LIFE_S = 0.04  # between two signs of life; the controller wants one each 0.1 s
BEGIN_S = 0.12  # so long the controller waits for the sign of life with which a motion begins; it waits 10 ms longer
EARLY = -75  # a commit came too soon after the one before
LATE = -77  # a sign of life with an old number; the detail is the number of now
# There is no session any more, or another one, or a command came without its seal: the session can be opened anew, or
# goes on. Where a session is open, a command without a seal is refused as somebody else's (-72).
NOT_OPEN = (-70, -71, -72)
REPLAY = -71  # so is refused what comes while a session is open that another program with the key has left
LEFT_S = 1.5  # a session that a program has left ends within 1 s
LEFT_POLL_S = 0.05
UNKNOWN = 0xFFFFFFFF  # of a half of the challenge: the next one is being made; of begin_number: no motion waits
COMMANDS = frozenset((
    "take_up", "let_go", "loading_test_start", "set_mode", "write_entry", "upload_begin", "upload_word", "commit",
    "rollback", "clear", "set_gravity",
))  # fmt: skip
_KIND_LIFE, _KIND_COMMAND = 1, 2
_COMMAND_ENTRY, _COMMAND_REGISTER = 0x2000, 0x4000
_ADDRESSES = {register.name: register.address for register in REGISTERS}


def entry_of(command: str) -> int:
    """A command's number on CAN."""
    return _COMMAND_ENTRY + (_ADDRESSES[command] - _COMMAND_REGISTER) // 2


def register_of(command: str) -> int:
    """A command's first register."""
    return _ADDRESSES[command]


class Owner:
    """The numbers that the controller has sent, the counter and the checks of one session. Without a key there are no
    checks."""

    def __init__(self, key: bytes | None) -> None:
        self._key = key
        self._challenge = 0
        self._counter = 0
        self._is_accepted = False  # a command has been taken in the session of this challenge
        self._number: int | None = None  # that the controller has sent last
        self.begin_number: int | None = None  # with which the motion begins that waits
        self.is_open = False  # a session has been begun

    def forget(self) -> None:
        """The controller may have ended it; `begin` finds out."""
        self.is_open = False

    def accepted(self) -> None:
        """The controller has taken a command."""
        self._is_accepted = self.is_open

    def begin(self, setting: int, low: int, high: int, where: str) -> bool:
        """Whether a sign of life has to open a session: not on a bench, and not where our session goes on. With the
        challenge of before the counter goes on, too: the controller takes none twice.
        setting, low, high: as the controller reports them"""
        name = SETTING.name_of(setting)
        if name == "BENCH":
            return False
        if name != "GUARDED":
            raise DeviceFaultError(
                "the controller lets nobody command it: it is guarded, and has no key yet",
                where=where,
                why=f"its setting is {name}",
                next_step="docs/security.md says how a board gets its key",
            )
        if self._key is None:
            raise UsageError(
                "the controller is guarded: commands need its key",
                where=where,
                why="only whoever has the key may move the limb or write",
                next_step="--key FILE; reading needs none",
            )
        self.is_open = True
        if high << 32 | low != self._challenge:
            self._challenge, self._counter, self._is_accepted = high << 32 | low, 0, False
        return not self._is_accepted

    def hears(self, number: int) -> None:
        """The controller has sent a number."""
        self._number = number

    def life(self) -> tuple[int, int] | None:
        """Number and check of the next sign of life; on a bench the check is the number. None: the controller has sent no
        number yet."""
        number = self._number if self.begin_number is None else self.begin_number
        if number is None:
            return None
        return number, self._check(_KIND_LIFE, b"", number) if self.is_open else number

    def next_counter(self) -> int:
        """Of the next command."""
        self._counter += 1
        return self._counter

    def seal(self, command: bytes) -> int:
        """The check of the command that has the counter of next_counter."""
        return self._check(_KIND_COMMAND, command, self._counter)

    def _check(self, kind: int, content: bytes, counter: int) -> int:
        assert self._key is not None
        return siphash(self._key, struct.pack("<QII", self._challenge, counter, kind) + content) & 0xFFFFFFFF


class Reopening:
    """Of one command that is not taken: whether its session is to be opened anew. Once, because a seal may have been
    lost; and until the session has ended that another program with the key has left: its counter is beyond ours."""

    def __init__(self) -> None:
        self._tries = 0
        self._was_replay = False
        self._until_s = time.monotonic() + LEFT_S

    def wait_s(self, status: int) -> float | None:
        """How long to wait before it is opened; None: the command has failed."""
        if status not in NOT_OPEN:
            return None
        self._tries += 1
        self._was_replay |= status == REPLAY
        if self._tries == 1:
            return 0.0
        return LEFT_POLL_S if self._was_replay and time.monotonic() < self._until_s else None


def load_key(path: Path) -> bytes:
    """A key file: 32 hexadecimal digits."""
    try:
        key = bytes.fromhex(path.read_text())
    except (OSError, ValueError) as error:
        raise UsageError(
            "no key can be read", where=str(path), why=str(error), next_step="a file with 32 hexadecimal digits"
        ) from None
    if len(key) != KEY_BYTES:
        raise UsageError(
            f"a key of {len(key)} bytes", where=str(path), why="keys have 16 bytes", next_step="32 hexadecimal digits"
        )
    return key
