"""`brace clear`: a latched fault, over every wire; others are left alone."""

from __future__ import annotations

import contextlib
import json
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from command_bench import FREE, LIMB, Outcome, running

from brace.bus.drift import Drift, drift_of
from brace.cli import clear_command
from brace.wire.codes import FAULT

FAULTS = FAULT.names
MODEL_DRIFT, CRASHED, ENCODER_STUCK, OLD_PARAMETERS, JUMP_COXA, JUMP_FEMUR, JUMP_TIBIA = (
    1 << FAULTS.index(name)
    for name in ("MODEL_DRIFT", "CRASHED", "ENCODER_STUCK", "OLD_PARAMETERS", "JUMP_COXA", "JUMP_FEMUR", "JUMP_TIBIA")
)


@pytest.fixture
def limb(tmp_path: Path) -> Path:
    path = tmp_path / "limb.toml"
    path.write_text(LIMB)
    return path


def faults_on(brace: Callable[..., Outcome], url: str) -> list[str]:
    outcome = brace("query", "--bus", url, "--entry", "faults", "--json")
    assert outcome.code == 0, outcome.err
    found: list[str] = json.loads(outcome.out)["entries"]["faults"]["value"]
    return found


@pytest.mark.parametrize("wire", ["can", "modbus_tcp"])
def test_a_crash_is_told_until_it_is_cleared(brace: Callable[..., Outcome], limb: Path, wire: str) -> None:
    with running(limb, *FREE, "--fault", "crash@0.2") as (_, ready):
        url = ready["limbs"][0][wire]
        until = time.monotonic() + 20.0
        while faults_on(brace, url) != ["CRASHED"]:
            assert time.monotonic() < until
        outcome = brace("clear", "crash", "--bus", url, "--json")
        assert outcome.code == 0, outcome.err
        assert json.loads(outcome.out) == {"node": 1, "cleared": ["crashed"], "faults": []}
        assert faults_on(brace, url) == []
        outcome = brace("clear", "crashed", "drift", "--bus", url)  # the dictionary's name does too
        assert outcome.code == 0 and "crashed is not there, nothing to clear" in outcome.err
        assert "model_drift is not there, nothing to clear" in outcome.err and "faults now: none" in outcome.err


@pytest.mark.parametrize("wire", ["can", "modbus_tcp"])
def test_other_faults_are_left_alone(brace: Callable[..., Outcome], limb: Path, wire: str) -> None:
    with running(limb, *FREE, "--fault", "crash@0.2", "--fault", "sensor_dead:tibia@0.2") as (_, ready):
        url = ready["limbs"][0][wire]
        until = time.monotonic() + 20.0
        while faults_on(brace, url) != ["SENSOR_TIBIA", "CRASHED"]:
            assert time.monotonic() < until
        outcome = brace("clear", "drift", "crash", "crash", "--bus", url)
        assert outcome.code == 0 and "cleared crashed" in outcome.err and "faults now: sensor_tibia" in outcome.err
        assert faults_on(brace, url) == ["SENSOR_TIBIA"]


class Controller:
    """What a controller is to the command: faults, of which some come back at once."""

    url, node = "can0", 5

    def __init__(self, faults: int, lasting: int = 0) -> None:
        self.faults, self.lasting, self.asked = faults, lasting, 0

    def read_entry(self, name: str) -> int:
        assert name == "faults"
        return self.faults

    def drift(self) -> Drift:
        assert self.faults & MODEL_DRIFT  # before it is cleared
        return drift_of({"state": 2, "cause": 1, "could_be": 1, "next_step": 4, "evidence": 30.0, "loss": 0.1,
                         "loss_sigma": 0.01, "since_readings": 9, "readings": 500})

    def clear(self, faults: int) -> int:
        self.asked |= faults
        self.faults &= ~faults | self.lasting
        return self.faults


@pytest.fixture
def given(monkeypatch: pytest.MonkeyPatch) -> Callable[[Controller], Controller]:
    def give(device: Controller) -> Controller:
        @contextlib.contextmanager
        def controller(_arguments: object) -> Iterator[Controller]:
            yield device

        monkeypatch.setattr(clear_command, "controller", controller)
        return device

    return give


def test_what_is_asked_for_is_cleared_and_nothing_that_is_not_there(
    brace: Callable[..., Outcome], given: Callable[[Controller], Controller]
) -> None:
    device = given(Controller(MODEL_DRIFT | CRASHED | 1))
    outcome = brace("clear", "drift", "--bus", "can0", "--json")
    assert outcome.code == 0 and device.asked == MODEL_DRIFT == 1 << 7
    told = json.loads(outcome.out)
    assert told["faults"] == ["sensor_femur", "crashed"] and told["drift_cause"] == "femur_link"
    given(Controller(MODEL_DRIFT))
    outcome = brace("clear", "drift", "--bus", "can0")
    assert "likeliest cause was femur_link: The femur's bending has changed." in outcome.err
    device = given(Controller(ENCODER_STUCK))
    assert brace("clear", "encoder", "--bus", "can0").code == 0 and device.asked == ENCODER_STUCK == 1 << 2
    device = given(Controller(CRASHED))  # the drift check's evidence is not thrown away for nothing
    assert brace("clear", "drift", "--bus", "can0").code == 0 and device.asked == 0


def test_jumps_are_cleared_together_or_one_by_one(
    brace: Callable[..., Outcome], given: Callable[[Controller], Controller]
) -> None:
    device = given(Controller(JUMP_COXA | JUMP_TIBIA | CRASHED))
    outcome = brace("clear", "jump", "--bus", "can0", "--json")
    assert outcome.code == 0 and device.asked == JUMP_COXA | JUMP_TIBIA == 1 << 13 | 1 << 15
    assert json.loads(outcome.out) == {"node": 5, "cleared": ["jump_coxa", "jump_tibia"], "faults": ["crashed"]}
    device = given(Controller(JUMP_FEMUR | JUMP_TIBIA))
    outcome = brace("clear", "jump_tibia", "--bus", "can0")
    assert outcome.code == 0 and device.asked == JUMP_TIBIA and "faults now: jump_femur" in outcome.err
    device = given(Controller(0))
    outcome = brace("clear", "jump", "--bus", "can0")
    assert outcome.code == 0 and device.asked == 0
    assert "jump_coxa or jump_femur or jump_tibia is not there, nothing to clear" in outcome.err


def test_an_older_set_is_taken(brace: Callable[..., Outcome], given: Callable[[Controller], Controller]) -> None:
    device = given(Controller(OLD_PARAMETERS))
    outcome = brace("clear", "parameters", "--bus", "can0")
    assert outcome.code == 0 and device.asked == OLD_PARAMETERS == 1 << 12 and "cleared old_parameters" in outcome.err
    assert brace("clear", "jump_everywhere", "--bus", "can0").code == 2


def test_a_fault_that_is_back_at_once_is_told(
    brace: Callable[..., Outcome], given: Callable[[Controller], Controller]
) -> None:
    given(Controller(MODEL_DRIFT | CRASHED, lasting=MODEL_DRIFT))
    outcome = brace("clear", "crash", "drift", "--bus", "can0")
    assert outcome.code == 5 and "model_drift cleared, and there again" in outcome.err and "try:" in outcome.err


def test_what_cannot_be_cleared_is_refused(brace: Callable[..., Outcome]) -> None:
    outcome = brace("clear", "sensor_femur", "--bus", "can0")
    assert outcome.code == 2 and "ends with its cause" in outcome.err and "docs/errors.md" in outcome.err
    assert brace("clear", "--bus", "can0").code == 2
    assert brace("clear", "drift").code == 2
