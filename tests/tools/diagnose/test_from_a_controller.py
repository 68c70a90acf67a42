"""What a controller's own loading tests say of its limb, with sensors good enough to see every shortcut on the way."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from bus_bench import limb_on_tcp
from command_bench import LIMB, Outcome

POSTURES = ((1.0, 1.4), (0.4, 1.0), (1.2, 2.0), (-0.2, 1.7))
TRUE_RAD_PER_N_MM = 2.6e-5
SOFT = LIMB.replace("compliance_rad_per_n_mm = 1.0e-5", f"compliance_rad_per_n_mm = {TRUE_RAD_PER_N_MM}")


@pytest.mark.parametrize(
    "encoders",
    [pytest.param((), marks=pytest.mark.minutes), ("--link-encoders",)],
    ids=["tip force only", "link encoders"],
)
def test_a_soft_drive_is_named(brace: Callable[..., Outcome], tmp_path: Path, encoders: tuple[str, ...]) -> None:
    """From the tip alone it is one of a class; encoders behind the drives tell it from the rest, with its size."""
    believed, true = tmp_path / "believed.toml", tmp_path / "true.toml"
    believed.write_text(LIMB)
    true.write_text(SOFT + "[sensor]\nnoise_n = 0.02\n")
    record, found = tmp_path / "record", tmp_path / "found"
    for theta1, theta2 in POSTURES:
        with limb_on_tcp(
            believed, "--plant", true, f"--posture={theta1},{theta2}", "--speed", 8, *encoders
        ) as url:
            outcome = brace(
                *("record", "--bus", url, "--loading-test", "--add", "--steps", 3, "--step-mm", 0.6, "--out", record)
            )
            assert outcome.code == 0, outcome.err
    outcome = brace("diagnose", record, "--model", believed, "--out", found)
    assert outcome.code == 0, outcome.err
    said = json.loads((found / "diagnosis.json").read_text())
    names = [f"{effect['name']}@{effect['where']}" for effect in said["effects"]]
    assert "joint_compliance@joint.femur" in names, said["sentence"]
    assert not said["data_faults"] and not said["unexplained"]["structured"]
    assert said["gap"]["after"]["held_out"] < 0.1 * said["gap"]["before"]["held_out"]
    if encoders:
        assert (said["verdict"], names) == ("effect", ["joint_compliance@joint.femur"])
        size = said["effects"][0]["parameters"]["joint.femur.compliance_rad_per_n_mm"]
        assert size["high"] < 1.1 * size["low"]
        # the interval holds 90 %: its half is 1.6 sigma, and 5 sigma no run of this test ever sees
        assert abs(size["value"] - TRUE_RAD_PER_N_MM) < 5.0 / 1.64 * 0.5 * (size["high"] - size["low"])


@pytest.mark.minutes
def test_a_sound_limb_is_sound_at_a_posture_that_is_repeated(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    """Motors that go to the same angles again are off by the same rounding again: that is no effect of the limb's."""
    believed, record, found = tmp_path / "believed.toml", tmp_path / "record", tmp_path / "found"
    believed.write_text(LIMB)
    with limb_on_tcp(believed, "--speed", 8) as url:
        for _ in range(2):
            outcome = brace("record", "--bus", url, "--loading-test", "--add", "--out", record)
            assert outcome.code == 0, outcome.err
    outcome = brace("diagnose", record, "--model", believed, "--out", found)
    assert outcome.code == 0, outcome.err
    said = json.loads((found / "diagnosis.json").read_text())
    assert said["verdict"] == "none", said["sentence"]
    assert not said["unexplained"]["structured"]
