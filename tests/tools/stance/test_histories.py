"""The range of a foot's force over every history: against statics done by hand, and against what the command says of
one history."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from brace.stance.answer import answer
from brace.stance.histories import FACES, Ranges, ranges
from brace.stance.stance_file import Stance, load_stance
from brace.stance.world import NoStanceError, believed
from command_bench import Outcome

EXAMPLE = Path(__file__).parents[3] / "examples/stance/stance.toml"
STANCE = load_stance(EXAMPLE)
WIDE = 1.0 / math.cos(math.pi / FACES)  # of the cones' faces


def flat(stance: Stance, friction: float, limbs: int = 4) -> Stance:
    """The first limbs on a floor without slope, weight and payload straight down."""
    down = np.array([0.0, 0.0, -1.0])
    feet = tuple(replace(limb, normal=-down, friction_ratio=friction, grip_n=0.0) for limb in stance.limbs[:limbs])
    return replace(stance, limbs=feet, down=down, payload_n=5.0 * down)


def test_one_history_lies_within() -> None:
    found, said = ranges(STANCE), answer(STANCE)
    assert np.all(found.low_n - 0.2 < said.force_n) and np.all(said.force_n < found.high_n + 0.2)  # feet move a little
    assert np.all(found.high_n - found.low_n > 1.0)


def test_without_friction_a_floor_bears_upwards_alone() -> None:
    found = ranges(flat(STANCE, 0.0))
    assert np.allclose(found.low_n[:, :2], 0.0, atol=1e-6) and np.allclose(found.high_n[:, :2], 0.0, atol=1e-6)
    assert np.allclose(found.low_n[:, 2], found.pressing_low_n)


def test_three_feet_on_a_floor_press_as_moments_say() -> None:
    """Sideways they may squeeze, but feet at one height cannot lift each other with that."""
    stance = flat(STANCE, 0.5, limbs=3)
    world = believed(stance)
    feet = np.array([law.tip_mm + offset for law, offset in zip(world.laws, world.offset_mm, strict=True)])
    assert np.ptp(feet[:, 2]) < 1e-9
    loads = [*world.weight, world.payload]
    vertical = np.vstack([np.ones(3), feet[:, 0], feet[:, 1]])
    pressing = np.linalg.solve(vertical, -sum(force[2] * np.array([1.0, at[0], at[1]]) for force, at in loads))
    if pressing.min() < 0.0:
        with pytest.raises(NoStanceError):
            ranges(stance)
        centre = feet.mean(axis=0)
        stance = replace(stance, com_mm=centre, payload_at_mm=centre)
        world = believed(stance)
        loads = [*world.weight, world.payload]
        pressing = np.linalg.solve(vertical, -sum(force[2] * np.array([1.0, at[0], at[1]]) for force, at in loads))
    found = ranges(stance)
    assert np.allclose(found.pressing_low_n, pressing, atol=1e-6)
    assert np.allclose(found.pressing_high_n, pressing, atol=1e-6)
    assert np.all(found.high_n[:, 0] <= WIDE * 0.5 * pressing + 1e-6)


def test_walls_that_face_each_other_have_no_end() -> None:
    inwards = [np.array([-np.sign(law.tip_mm[0]), 0.0, 0.0]) for law in believed(STANCE).laws]
    limbs = tuple(replace(limb, normal=normal, friction_ratio=0.8)
                  for limb, normal in zip(STANCE.limbs, inwards, strict=True))  # fmt: skip
    found = ranges(replace(STANCE, limbs=limbs))
    assert np.all(np.isinf(found.pressing_high_n)) and np.all(np.isfinite(found.pressing_low_n))
    assert [limb["pressing_n"][1] for limb in _limbs(found)] == [None] * 4


def _limbs(found: Ranges) -> list[dict[str, list[float | None]]]:
    limbs: list[dict[str, list[float | None]]] = json.loads(json.dumps(found.as_json(), default=float))["limbs"]
    return limbs


def test_the_most_payload_and_no_forces(brace: Callable[..., Outcome]) -> None:
    stance = flat(STANCE, 0.6)
    sideways = replace(stance, payload_n=np.array([5.0, 0.0, 0.0]), payload_at_mm=_height_of_feet(stance))
    weight = sum(-force[2] for force, _ in believed(sideways).weight)
    found = ranges(sideways)
    assert found.payload_factor is not None
    assert 0.6 * weight / 5.0 * 0.999 < found.payload_factor < WIDE * 0.6 * weight / 5.0 * 1.001
    with pytest.raises(NoStanceError) as caught:
        ranges(replace(sideways, payload_n=100.0 * sideways.payload_n))
    assert caught.value.is_payload and caught.value.share == pytest.approx(found.payload_factor / 100.0, rel=1e-6)
    said = brace("stance", "range", EXAMPLE, "--json")
    assert said.code == 0 and [limb["name"] for limb in json.loads(said.out)["limbs"]] == [
        limb.name for limb in STANCE.limbs
    ]
    words = brace("stance", "range", EXAMPLE)
    assert words.code == 0 and all(limb.name in words.out for limb in STANCE.limbs)


def _height_of_feet(stance: Stance) -> np.ndarray:
    """Over the load's own place, so that a pull there turns nothing over."""
    return np.array([0.0, 0.0, believed(stance).laws[0].tip_mm[2]])
