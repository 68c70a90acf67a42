"""`brace stance choose`: postures that reach a foothold, and which is best."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from brace.stance.answer import answer
from brace.stance.choose import AIMS, Foothold, choose, reaching_rad
from brace.stance.limb_law import LimbLaw
from brace.stance.stance_file import load_stance
from command_bench import PROJECT, Outcome

EXAMPLE = PROJECT / "examples" / "stance" / "stance.toml"
STANCE = load_stance(EXAMPLE)
HEADER = "foothold,x_mm,y_mm,z_mm,friction\n"


def _foothold(name: str, at_mm: np.ndarray, friction_ratio: float = 0.7) -> Foothold:
    return Foothold(name, at_mm, np.array([0.0, 0.0, 1.0]), friction_ratio, 0.0)


def test_every_posture_brings_the_tip_to_the_foothold() -> None:
    chance, reached = np.random.default_rng(2), 0
    for limb in STANCE.limbs:
        for _ in range(20):
            at_mm = limb.mount_mm + limb.turn @ chance.uniform([80.0, -120.0, -150.0], [280.0, 120.0, 60.0])
            for theta_rad in reaching_rad(limb, at_mm):
                tip_mm = LimbLaw(replace(limb, theta_rad=theta_rad), STANCE.down).tip_mm
                assert tip_mm == pytest.approx(at_mm, abs=1e-9)
                reached += 1
    assert reached > 80


def test_the_foothold_of_now_is_the_stance_of_now() -> None:
    limb = STANCE.limbs[0]
    now = Foothold("now", LimbLaw(limb, STANCE.down).tip_mm, limb.normal, limb.friction_ratio, limb.grip_n)
    best = choose(STANCE, limb.name, [now], "slip")[0]
    assert best.theta_rad == pytest.approx(limb.theta_rad, abs=1e-9)
    assert best.payload_factor == pytest.approx(answer(STANCE, draws=20).first_slip.payload_factor, rel=1e-6)


@pytest.mark.parametrize("aim", AIMS)
def test_the_best_comes_first(aim: str) -> None:
    footholds = [_foothold(f"{x}", np.array([x, 210.0, -85.0])) for x in (200.0, 225.0, 250.0)]
    found = choose(STANCE, "front left", footholds, aim)
    values = [AIMS[aim](one) for one in found if not one.reason]
    assert len(values) == 3 and values == sorted(values)
    assert [one.reason for one in found if one.reason] == ["the knee is below the ground"] * 3


def test_what_cannot_be_taken_says_why(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    table = tmp_path / "footholds.csv"
    table.write_text(HEADER + "good,230,200,-90,0.7\nslick,230,200,-90,0.1\nmoon,900,0,0,1\n")
    asked = ("stance", "choose", EXAMPLE, "--limb", "front left", "--footholds", table)
    choices = json.loads(brace(*asked, "--json").out)["choices"]
    why = {one["foothold"]: one["reason"] for one in reversed(choices)}  # the best of each
    assert why["good"] is None and "slides" in why["slick"] and why["moon"] == "out of reach"
    assert choices[0]["foothold"] == "good" and choices[0]["first_slip"]["payload_factor"] > 1.0
    words = brace(*asked).out
    assert words.index("good") < words.index("moon") and "no: out of reach" in words


@pytest.mark.parametrize(
    ("content", "said"),
    [("name,x\n", "no footholds"), (HEADER, "no footholds"), (HEADER + "a,1,2,east,1\n", "z_mm = 'east'"),
     (HEADER + "a,1,2,3,-1\n", "friction = '-1'")],
)  # fmt: skip
def test_a_table_that_is_wrong_is_refused(
    brace: Callable[..., Outcome], tmp_path: Path, content: str, said: str
) -> None:
    table = tmp_path / "footholds.csv"
    table.write_text(content)
    outcome = brace("stance", "choose", EXAMPLE, "--limb", "front left", "--footholds", table)
    assert outcome.code == 3 and said in outcome.err
    assert brace("stance", "choose", EXAMPLE, "--limb", "nobody", "--footholds", table).code == 2
