"""A frame is lost on the way to a guarded board, the seal of a command or the sign of life that opens the session: both
clients find out, and go on. The answer to a seal is not taken for the answer to its command."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import Sim
from relay import relayed
from test_commanding import KEY, RUNNING, acts, guarded, keys, wait_for_the_end_of_the_session, with_play  # noqa: F401

from brace.bus.modbus_controller import ModbusController
from brace.bus.ownership import entry_of
from brace.bus.session import Session
from brace.bus.url import parse
from brace.ground.errors import DeviceFaultError
from brace.wire.codes import SETTING
from brace.wire.frames import ANSWERS, REQUESTS

GUARDED = next(code.number for code in SETTING.codes if code.name == "GUARDED")
LIFE, WRITE = "sign_of_life", REQUESTS["write_entry"].command


class Loser:
    """Loses the nth write to an entry, or the nth sign of life."""

    def __init__(self, entry: str, nth: int) -> None:
        self._index, self._left = None if entry == LIFE else entry_of(entry), nth

    def __call__(self, data: bytes) -> bool:
        if self._index is None and data[0] == REQUESTS[LIFE].command:
            self._left -= 1
            return self._left == 0
        if self._index is not None and data[0] == WRITE and struct.unpack_from("<H", data, 2)[0] == self._index:
            self._left -= 1
            return self._left == 0
        return False


LOSSES = [("seal_mac", 1), ("seal_mac", 2), (LIFE, 1)]


@pytest.fixture
def limb(guarded: Sim) -> Iterator[str]:  # noqa: F811
    wait_for_the_end_of_the_session(guarded.can)
    yield guarded.can


@pytest.mark.parametrize(("entry", "nth"), LOSSES)
def test_python_goes_on(limb: str, entry: str, nth: int) -> None:
    from brace.bus.open import open_bus

    with relayed(limb, loses=Loser(entry, nth)) as relay:
        bus = open_bus(parse(relay.url))
        try:
            session = Session(bus, 1, KEY)
            for _ in range(3):
                session.ask("set_gravity", {"direction": -1.5, "lean": 0.0})
        finally:
            bus.close()


@pytest.mark.parametrize(("entry", "nth"), LOSSES)
def test_c_goes_on(limb: str, keys: tuple[Path, Path], entry: str, nth: int) -> None:  # noqa: F811
    with relayed(limb, loses=Loser(entry, nth)) as relay:
        done, why = acts(relay.url, "gravity:-1.5:0", "gravity:-1.5:0", "gravity:-1.5:0", key=keys[0])
    assert [act.status for act in done] == [0, 0, 0], why


def test_python_moves_on_with_the_session_it_has(limb: str) -> None:
    """A lost seal in the midst of a motion: signs of life go on, and the next command is taken."""
    from brace.bus.open import open_bus

    with relayed(limb, loses=Loser("seal_mac", 2)) as relay:
        bus = open_bus(parse(relay.url))
        try:
            session = Session(bus, 1, KEY)
            with session.living():
                session.ask("take_up", {"joint": 2, "flank": -1})
                session.listen(0.1)
                session.ask("let_go")
        finally:
            bus.close()


OF_MODBUS = {
    "clear": lambda device: device.clear(0),
    "gravity": lambda device: device.set_gravity(-1.5, 0.0),
}


class Silent:
    """A Modbus line that loses the nth request of one kind: its answer comes, and the controller has not seen it."""

    def __init__(self, device: ModbusController, command: str, nth: int) -> None:
        self._show, self._command, self._left = device._show, command, nth
        self.lost = 0

    def __call__(self, first: str, counter: int, check: int) -> None:
        self._left -= first == self._command
        if first == self._command and self._left == 0:
            self.lost += 1
        else:
            self._show(first, counter, check)


@pytest.mark.parametrize("act", ["clear", "gravity"])
@pytest.mark.parametrize(("lost", "nth"), [("seal_counter", 1), ("seal_counter", 2), ("life_heard", 1)])
def test_python_goes_on_over_modbus(
    guarded: Sim, limb: str, monkeypatch: pytest.MonkeyPatch, act: str, lost: str, nth: int  # noqa: F811
) -> None:
    """The session is opened anew, once for each command."""
    device = ModbusController(parse(guarded.modbus), KEY)
    line = Silent(device, lost, nth)
    monkeypatch.setattr(device, "_show", line)
    try:
        for _ in range(3):
            OF_MODBUS[act](device)
        assert line.lost == 1
    finally:
        device.close()


def test_python_moves_on_over_modbus_with_the_session_it_has(
    guarded: Sim, limb: str, monkeypatch: pytest.MonkeyPatch  # noqa: F811
) -> None:
    device = ModbusController(parse(guarded.modbus), KEY)
    line = Silent(device, "seal_counter", 2)
    monkeypatch.setattr(device, "_show", line)
    try:
        with device.living():
            device.take_up("tibia", -1)
            device.stay(0.1)
            device.let_go()
        assert line.lost == 1
    finally:
        device.close()


def test_a_program_that_follows_another_waits_until_its_session_has_ended(limb: str) -> None:
    """The first one has left its session open, and the second one has the same key. The first connection stays, as
    an interface of SocketCAN does: a closed one ends the session at once."""
    from brace.bus.open import open_bus

    first, second = open_bus(parse(limb)), open_bus(parse(limb))
    try:
        for bus, commands in ((first, 3), (second, 1)):
            session = Session(bus, 1, KEY)
            for _ in range(commands):
                session.ask("clear", {"faults": 0})
    finally:
        first.close()
        second.close()


def test_the_session_is_opened_anew_only_once(
    guarded: Sim, limb: str, monkeypatch: pytest.MonkeyPatch  # noqa: F811
) -> None:
    """Where every seal is lost, a command ends with what the controller says."""
    device = ModbusController(parse(guarded.modbus), KEY)
    show, openings = device._show, list[int]()

    def loses_seals(first: str, counter: int, check: int) -> None:
        if first == "life_heard":
            openings.append(counter)
            show(first, counter, check)

    monkeypatch.setattr(device, "_show", loses_seals)
    try:
        with pytest.raises(DeviceFaultError, match="refuses"):
            device.clear(0)
        assert len(openings) <= 2
    finally:
        device.close()


class Scripted:
    """A bus whose controller answers each seal, and a command never."""

    url, bit_rate = "scripted", None

    def __init__(self) -> None:
        self.answers: list[bytes] = []

    def send(self, identifier: int, data: bytes) -> None:
        index = struct.unpack_from("<H", data, 2)[0]
        if index == entry_of("seal_mac"):
            self.answers.append(ANSWERS["write_entry"][0].encode({"index": index, "value": 0}, data[1]))

    def receive(self, timeout_s: float) -> object:
        from brace.bus.frame import Frame

        return Frame(0.0, 0x581, self.answers.pop()) if self.answers else None

    def silence(self) -> tuple[str, str]:
        return "", ""

    def close(self) -> None:
        return


def test_the_answer_to_a_seal_is_not_the_answer_to_its_command() -> None:
    from brace.ground.errors import NoDeviceError

    bus = Scripted()
    session = Session(bus, 1, KEY)  # type: ignore[arg-type]
    session.owner.begin(GUARDED, 1, 2, "")
    assert session.owner.is_open
    with pytest.raises(NoDeviceError):
        session.ask("write_entry", {"index": entry_of("end_test"), "value": 1}, 0.02)
