"""`brace take-up` and `brace let-go` on a simulated limb, over CAN and Modbus; and what they say when it fails."""

from __future__ import annotations

import contextlib
import json
import socket
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from bus_bench import adapter
from command_bench import FREE, LIMB, Outcome, running, spawn

from brace.bus import stopping, taking_up
from brace.bus.open import DEFAULT_BIT_RATE, open_bus
from brace.bus.taking_up import Flank, let_go, take_up
from brace.bus.url import parse
from brace.ground.errors import DeviceFaultError, NoDeviceError
from brace.wire.codes import MODE

WIRES = ("can", "modbus_tcp")


@pytest.fixture
def with_play(tmp_path: Path) -> Path:
    path = tmp_path / "play.toml"
    path.write_text(LIMB.replace("[joint.tibia]", "[joint.tibia]\ngap_rad = 0.006"))
    return path


@pytest.mark.parametrize("wire", WIRES)
def test_a_flank_is_held_and_let_go(brace: Callable[..., Outcome], with_play: Path, wire: str) -> None:
    with running(with_play, *FREE) as (_, ready):
        url = ready["limbs"][0][wire]
        held = brace("take-up", "tibia-", "--bus", url, "--json")
        assert held.code == 0 and json.loads(held.out)["held"] == ["tibia-"], held.err
        live = json.loads(brace("query", "--bus", url, "--json").out)
        assert live["take_up"]["tibia"] == "held" and live["play"][1] == "engaged_negative"
        assert live["mode"] == "taking_up"
        assert brace("let-go", "--bus", url).code == 0
        assert json.loads(brace("query", "--bus", url, "--json").out)["mode"] == "monitor"
        nothing = brace("let-go", "--bus", url)
        assert nothing.code == 5 and (wire != "can" or "nothing to let go" in nothing.err), nothing.err
        refused = brace("take-up", "femur+", "--bus", url)  # it has no play
        assert refused.code == 5 and "refuses" in refused.err and "try:" in refused.err
        assert wire != "can" or "no play to take up" in refused.err, refused.err


@pytest.mark.parametrize("wire", WIRES)
def test_a_stop_by_somebody_else(brace: Callable[..., Outcome], with_play: Path, wire: str) -> None:
    """While another program takes up play; and once more, where nothing moves."""
    with running(with_play, *FREE) as (_, ready):
        urls = ready["limbs"][0]
        moving = spawn("take-up", "tibia-", "--wait", "3", "--bus", urls["can"])
        until = time.monotonic() + 20.0
        mode = ""
        while mode != "taking_up" and time.monotonic() < until:
            mode = json.loads(brace("query", "--bus", urls["modbus_tcp"], "--json").out)["mode"]
        stopped = brace("stop", "--bus", urls[wire], "--json")
        assert stopped.code == 0 and json.loads(stopped.out)["held"] == [1], stopped.err
        moving.communicate(timeout=60.0)
        assert brace("stop", "--bus", urls[wire]).code == 0
        assert brace("stop", "--bus", urls[wire], *(["--node", 1] if wire == "can" else [])).code == 0


@contextlib.contextmanager
def two_taking_up(brace: Callable[..., Outcome], model: Path) -> Iterator[str]:
    """The play of two limbs on one bus is being taken up. Yields their URL."""
    with running(model, *FREE, "--limbs", 2) as (_, ready):
        url = ready["limbs"][0]["can"]
        moving = [spawn("take-up", "tibia-", "--wait", 3, "--bus", url, "--node", node) for node in (1, 2)]
        try:
            until = time.monotonic() + 20.0
            while {live(brace, url, node)["mode"] for node in (1, 2)} != {"taking_up"}:
                assert time.monotonic() < until, "nothing moves"
            yield url
        finally:
            for process in moving:
                process.communicate(timeout=60.0)


def live(brace: Callable[..., Outcome], url: str, node: int) -> dict[str, Any]:
    values: dict[str, Any] = json.loads(brace("query", "--bus", url, "--node", node, "--json").out)
    return values


def is_held(brace: Callable[..., Outcome], url: str, node: int) -> bool:
    asked = brace("query", "--bus", url, "--node", node, "--entry", "is_held", "--json")
    return bool(json.loads(asked.out)["entries"]["is_held"]["value"] == 1)


def test_two_limbs_of_one_bus_stand(brace: Callable[..., Outcome], with_play: Path) -> None:
    with two_taking_up(brace, with_play) as url:
        one = brace("stop", "--bus", url, "--node", 2, "--json")
        assert one.code == 0 and json.loads(one.out) == {"nodes": [2], "held": [2], "stopped": True}, one.err
        assert is_held(brace, url, 2) and live(brace, url, 1)["mode"] == "taking_up"
        both = brace("stop", "--bus", url, "--json")
        assert both.code == 0 and json.loads(both.out)["held"] == [1, 2], both.err
        assert is_held(brace, url, 1) and is_held(brace, url, 2)


def test_a_bus_with_another_stop(brace: Callable[..., Outcome], with_play: Path) -> None:
    """The identifier is named, or learnt from a limb that answers."""
    text = with_play.read_text()
    assert "[controller]" not in text
    with_play.write_text(text + "\n[controller]\nstop_id = 5\n")
    with two_taking_up(brace, with_play) as url:
        for given in (5, stopping.STOP_ID):
            with contextlib.closing(open_bus(parse(url), DEFAULT_BIT_RATE)) as bus:
                sent: list[int] = []
                send = bus.send

                def watched(identifier: int, data: bytes, sent: list[int] = sent, send: Any = send) -> None:
                    sent.append(identifier)
                    send(identifier, data)

                bus.send = watched  # type: ignore[method-assign]
                assert stopping.stop_on(bus, None, given) == {1: True, 2: True}
                assert sent[0] == given and 5 in sent
        assert brace("stop", "--bus", url, "--stop-id", 127).code == 0
        assert brace("stop", "--bus", url, "--stop-id", 128).code == 2


def test_a_stop_that_nobody_answers(brace: Callable[..., Outcome], with_play: Path) -> None:
    with adapter(lambda line: b"\r") as url:
        outcome = brace("stop", "--bus", url)
        assert outcome.code == 4 and "no controller is heard" in outcome.err and "try:" in outcome.err, outcome.err
    with running(with_play, *FREE) as (_, ready):
        urls = ready["limbs"][0]
        assert brace("stop", "--bus", urls["can"], "--node", 7).code == 4
        refused = brace("stop", "--bus", urls["modbus_tcp"], "--stop-id", 5)
        assert refused.code == 2 and "a register stops it" in refused.err
    with socket.socket() as nobody:
        nobody.bind(("127.0.0.1", 0))
        assert brace("stop", "--bus", f"modbus-tcp://127.0.0.1:{nobody.getsockname()[1]}").code == 4


def test_a_limb_that_moves_on_is_told() -> None:
    moving = {"is_held": 0, "mode": next(code.number for code in MODE.codes if code.name == "TAKING_UP")}
    with pytest.raises(DeviceFaultError, match="moves on"):
        stopping._is_held(lambda name: moving[name], "here")


def test_what_is_no_flank_is_refused(brace: Callable[..., Outcome]) -> None:
    for text in ("tibia", "knee+", "+"):
        outcome = brace("take-up", text, "--bus", "can0")
        assert outcome.code == 2 and "coxa, femur, tibia" in outcome.err, outcome.err
    assert brace("take-up", "--bus", "can0").code == 2
    assert brace("let-go").code == 2


class Controller:
    """Each take-up ends as it is told to."""

    url, node = "can0", 3

    def __init__(self, **outcomes: str) -> None:
        self.outcomes, self.asked, self.mode = outcomes, list[tuple[str, int]](), "TAKING_UP"

    def take_up(self, joint: str, flank: int) -> None:
        self.asked.append((joint, flank))

    def take_ups(self) -> dict[str, str]:
        return {joint: "none" for joint in ("coxa", "femur", "tibia")} | self.outcomes

    def let_go(self) -> None: ...

    def living(self) -> contextlib.AbstractContextManager[None]:
        return contextlib.nullcontext()

    def stay(self, seconds: float) -> None:
        assert seconds >= 0.0

    def read_entry(self, name: str) -> int:
        assert name == "mode"
        return next(code.number for code in MODE.codes if code.name == self.mode)


def test_joints_follow_one_another_and_a_failure_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(taking_up, "POLL_S", 0.0)
    flanks = [Flank("femur", 1), Flank("tibia", -1)]
    device = Controller(femur="held", tibia="held")
    take_up(device, flanks, 1.0)  # type: ignore[arg-type]
    assert device.asked == [("femur", 1), ("tibia", -1)]
    device = Controller(femur="torque")
    with pytest.raises(DeviceFaultError) as failed:
        take_up(device, flanks, 1.0)  # type: ignore[arg-type]
    assert "femur+ is not taken up" in failed.value.render() and "torque passed its bound" in failed.value.render()
    assert device.asked == [("femur", 1)]


def test_nobody_waits_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(taking_up, "POLL_S", 0.0)
    with pytest.raises(NoDeviceError) as late:
        take_up(Controller(femur="running"), [Flank("femur", 1)], 0.05)  # type: ignore[arg-type]
    assert "brace let-go" in late.value.render()
    with pytest.raises(NoDeviceError):
        let_go(Controller(), 0.05)  # type: ignore[arg-type]
