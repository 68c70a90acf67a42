"""A controller whose joints are servos: simulated ones in its process, and foreign ones at a serial device."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from brace.model import load_limb
from brace.sim.node import LimbSetup, Node
from brace.sim.servos import ServoLine

ROOT = Path(__file__).resolve().parents[2]
LIMB = ROOT / "tools" / "brace" / "data" / "paper-limb.toml"
BRACE = (sys.executable, "-m", "brace")
READY = 3
K_NAMES = ("k_xx_n_per_mm", "k_xz_n_per_mm", "k_zz_n_per_mm")
COUNT_RAD = 2 * math.pi / 4096


def end_of(*options: str) -> dict[str, Any]:
    """What the limb reports at the end of a run."""
    command = (*BRACE, "sim", "--model", str(LIMB), "--can", "none", "--modbus", "none", "--json", *options)
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    end: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])["limbs"][0]
    return end


def valid_end_of(*options: str) -> dict[str, Any]:
    """The same of a run in real time. A loaded machine may hold a servo's answer back for longer than the 20 ms after
    which K is stale, just at the end; then it runs again."""
    for _ in range(5):
        end = end_of(*options)
        if end["k_is_valid"]:
            break
    return end


def test_k_over_simulated_servos_is_that_of_the_limb() -> None:
    press = ("--press", "2.0,-3.0", "--fast", "--seconds", "2")
    direct, servos = end_of("--link-encoders", *press), end_of("--servos", "sim", *press)
    assert servos["k_is_valid"] and not servos["faults"] and not servos["flag_names"]
    for name in K_NAMES:
        # an angle is off by half a step of the servo's encoder: K changes by less than its own size times that angle
        largest = abs(direct["lambda_max_n_per_mm"])
        assert servos[name] == pytest.approx(direct[name], abs=2 * COUNT_RAD * largest + 1e-3 * largest)


def node_over_servos() -> Node:
    model = load_limb(LIMB)
    return Node([LimbSetup(model, model, servos="sim")])


def test_every_servo_is_sampled_at_least_500_times_a_second_and_all_is_counted() -> None:
    with node_over_servos() as node:
        node.step(1.0)
        before = [node.servo(0, joint)["samples"] for joint in (1, 2)]
        node.step(10.0)
        for joint, samples in zip((1, 2), before, strict=True):
            reported = node.servo(0, joint)
            assert reported["state"] == READY and reported["model"] == 321
            assert (reported["samples"] - samples) / 10 >= 500
            assert reported["lost"] == reported["damaged"] == reported["restarts"] == 0
        assert node.servo(0, 0)["state"] == 0  # a limb in a plane has no coxa joint


def test_a_move_of_the_posture_goes_through_the_servos() -> None:
    end = end_of("--servos", "sim", "--contact", "free", "--posture", "1.0,1.4", "--posture", "0.8,1.2@0.5",
                 "--fast", "--seconds", "3")  # fmt: skip
    droop_rad = 200.0 / 6e4  # friction of the simulated servo by its gain
    assert end["theta1_rad"] == pytest.approx(0.8, abs=2 * COUNT_RAD + droop_rad)
    assert end["theta2_rad"] == pytest.approx(1.2, abs=2 * COUNT_RAD + droop_rad)


def test_servos_at_a_device_are_read_and_left_alone() -> None:
    with ServoLine((11, 12, 13)) as line:
        line.shaft(1, math.pi + 1.0)
        line.shaft(2, math.pi + 1.4)
        end = valid_end_of("--servos", line.place, "--seconds", "2")
        assert end["k_is_valid"] and not end["faults"]
        assert end["theta1_rad"] == pytest.approx(1.0, abs=COUNT_RAD)
        assert end["theta2_rad"] == pytest.approx(1.4, abs=COUNT_RAD)
        assert [line.peek(place, 64, 1) for place in range(3)] == [0, 0, 0]  # nobody's torque was switched on


def test_servos_at_a_device_are_commanded_to_hold_when_asked_so() -> None:
    with ServoLine((11, 12, 13)) as line:
        line.shaft(1, math.pi + 1.0)
        line.shaft(2, math.pi + 1.4)
        end = valid_end_of("--servos", line.place, "--servos-hold", "--seconds", "2")
        assert end["k_is_valid"]
        assert [line.peek(place, 64, 1) for place in (1, 2)] == [1, 1]
        assert line.peek(1, 116, 4) == 2048 + round(1.0 / COUNT_RAD)


def test_no_k_without_its_servos() -> None:
    with ServoLine((11, 12)) as line:  # the tibia's is missing
        end = end_of("--servos", line.place, "--seconds", "1.5")
        assert not end["k_is_valid"] and end["k_xx_n_per_mm"] is None
        assert end["faults"]


@pytest.mark.parametrize("options", [("--servo-ids", "1,1,2"), ("--servo-ids", "1,2"), ("--servo-ids", "1,2,253")])
def test_ids_that_cannot_be_are_refused(options: tuple[str, ...]) -> None:
    command = (*BRACE, "sim", "--model", str(LIMB), "--servos", "sim", *options)
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 2 and "ids" in done.stderr


def test_a_device_that_is_not_there_is_refused() -> None:
    command = (*BRACE, "sim", "--model", str(LIMB), "--can", "none", "--modbus", "none", "--servos", "/dev/ttyNONE9")
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 4 and "/dev/ttyNONE9" in done.stderr
