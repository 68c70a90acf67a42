"""`brace take-up` and `brace let-go` on a simulated limb, over CAN and Modbus; and what they say when it fails."""

from __future__ import annotations

import contextlib
import json
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from conftest import LIMB, Outcome, spawn
from test_sim_command import FREE, running

from brace.bus import taking_up
from brace.bus.taking_up import Flank, let_go, take_up
from brace.errors import DeviceFaultError, NoDeviceError
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
        assert stopped.code == 0 and json.loads(stopped.out)["nodes"] == [1], stopped.err
        moving.communicate(timeout=60.0)
        assert brace("stop", "--bus", urls[wire]).code == 0
        assert brace("stop", "--bus", urls[wire], *(["--node", 1] if wire == "can" else [])).code == 0


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
