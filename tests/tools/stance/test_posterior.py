"""What the feet may bear, once their forces were measured: against a Gaussian's formula, and against drawn truths."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from brace.stance.answer import answer
from brace.stance.limb_law import JOINTS, side_of
from brace.stance.posterior import likely_forces
from brace.stance.stance_file import Stance, load_stance
from brace.stance.world import Measured, NoStanceError, Standing, World, believed, drawn

EXAMPLE = load_stance(Path(__file__).parents[3] / "examples/stance/stance.toml")
SENSOR_N = 0.3
NOISE_N2 = (SENSOR_N**2 * np.eye(3),) * 4


def _stance(gap_rad: float, grip_n: float, **known: float) -> Stance:
    values = {f"joint.{joint}.gap_rad": gap_rad for joint in JOINTS}
    values |= {f"uncertainty.{key}": value for key, value in known.items()}
    limbs = (
        replace(
            limb,
            friction_ratio=1.5,
            grip_n=grip_n,
            model=limb.model.with_values(values),
        )
        for limb in EXAMPLE.limbs
    )
    return replace(EXAMPLE, limbs=tuple(limbs))


def _read(force_n: np.ndarray, chance: np.random.Generator) -> Measured:
    return Measured(force_n + chance.normal(0.0, SENSOR_N, force_n.shape), NOISE_N2)


def test_without_play_it_is_the_gaussian_of_the_linear_law() -> None:
    """Mean and covariance by the gain of a Kalman filter, from the statics' own stiffness."""
    stance = _stance(0.0, 100.0, compliance_rel=0.0, gain_rel=0.0, length_mm=0.0)
    middle, chance = believed(stance), np.random.default_rng(1)
    pushed_n = 0.5 * np.array([[1, 1, 1], [-1, 1, -1], [1, -1, -1], [-1, -1, 1]])
    measured = _read(middle.stand().state.force_n + pushed_n, chance)
    _, forces = likely_forces([middle] * 800, middle, measured, chance)
    standing = middle.stand(measured, measured.force_n)
    at_rest, stiffness = standing.statics.linear(standing.state, middle.weight)
    places = np.zeros((12, 12))
    for limb, block in enumerate(middle.place_covariance):
        places[3 * limb : 3 * limb + 3, 3 * limb : 3 * limb + 3] = block
    prior = stiffness @ places @ stiffness.T
    covariance = prior - prior @ np.linalg.inv(prior + SENSOR_N**2 * np.eye(12)) @ prior
    sigma = np.sqrt(np.diag(covariance))
    found = forces.reshape(800, 12)
    assert np.all(np.abs(found.mean(axis=0) - at_rest) < 4.0 * sigma / np.sqrt(800.0) + 0.01)
    assert found.std(axis=0) == pytest.approx(sigma, rel=4.0 / np.sqrt(1600.0))


@pytest.mark.parametrize("grip_n", [0.0, 1.0])
def test_a_foot_bears_what_its_friction_holds(grip_n: float) -> None:
    """Where the readings lie beyond the cone of friction, the forces end at it, to a tenth of a reading's sigma."""
    stance = _stance(0.0, 100.0, compliance_rel=0.0, gain_rel=0.0, length_mm=0.0)
    force_n = believed(stance).stand().state.force_n
    measured = _read(force_n, np.random.default_rng(1))
    friction = 0.95 * float(np.mean(np.hypot(force_n[:, 0], force_n[:, 1]) / (force_n[:, 2] + grip_n)))
    limbs = tuple(replace(limb, grip_n=grip_n, friction_ratio=friction) for limb in stance.limbs)
    middle = believed(replace(stance, limbs=limbs))
    _, forces = likely_forces([middle] * 100, middle, measured, np.random.default_rng(2))
    beyond = np.hypot(forces[..., 0], forces[..., 1]) - friction * (forces[..., 2] + grip_n)
    assert np.all(np.abs(beyond.max(axis=0)) < 0.5 * SENSOR_N)


def _truths(stance: Stance, count: int) -> list[tuple[World, Standing]]:
    chance, middle = np.random.default_rng(3), believed(stance)
    found: list[tuple[World, Standing]] = []
    while len(found) < count:
        world = drawn(stance, middle, chance)
        try:
            standing = world.stand()
        except NoStanceError:
            continue
        if not any(standing.state.contact):
            found.append((world, standing))
    return found


def _open(world: World, force_n: np.ndarray) -> int:
    """How many joints lie within their play."""
    return sum(int(np.sum(side_of(law.sides(one)) == 0.0)) for law, one in zip(world.laws, force_n, strict=True))


def test_with_play_as_many_joints_are_open_as_in_truth() -> None:
    """A force alone hardly says that a joint is open: that many places lead to it does."""
    stance = _stance(0.01, 100.0, angle_rad=0.003)
    middle, chance = believed(stance, SENSOR_N), np.random.default_rng(4)
    true, expected, variance, inside = 0, 0.0, 0.0, []
    for world, standing in _truths(stance, 20):
        force_n = standing.state.force_n
        true += _open(world, force_n)
        worlds = [drawn(stance, middle, chance) for _ in range(30)]
        those, forces = likely_forces(worlds, middle, _read(force_n, chance), chance)
        counts = [_open(one, at) for one, at in zip(those, forces, strict=True)]
        expected, variance = (
            expected + float(np.mean(counts)),
            variance + float(np.var(counts)),
        )
        low, high = np.percentile(forces, [5.0, 95.0], axis=0)
        inside += ((low <= force_n) & (force_n <= high)).ravel().tolist()
    assert abs(true - expected) < 3.0 * np.sqrt(variance)
    few = 3.0 * float(np.sqrt(0.09 / 120))  # 20 truths, each of six ways in which four feet's forces balance
    assert np.mean(inside) == pytest.approx(0.9, abs=few)


def _hanging(grip_n: float) -> Stance:
    """Under a ceiling, one foot with another grip."""
    stance = _stance(0.006, 30.0)
    limbs = [replace(limb, grip_n=grip_n if limb.name == "front right" else 30.0) for limb in stance.limbs]
    return replace(
        stance,
        limbs=tuple(limbs),
        down=np.array([0.0, 0.0, 1.0]),
        com_mm=np.array([-30.0, 25.0, 0.0]),
    )


def test_a_foot_that_was_pulled_off_its_grip_is_known_by_its_force() -> None:
    """It bears nothing, and nothing under the payload; one that cannot have been pulled off is held."""
    stance = _hanging(9.0)
    world = believed(stance)
    standing = world.stand()
    standing.state.lift(1)
    standing.statics.settle(standing.state, world.weight, 1)
    measured = _read(standing.state.force_n, np.random.default_rng(5))
    found = answer(stance, measured, draws=30)
    assert found.state[1] == "open" and not found.force_n[1].any()
    assert any(flag.startswith("let_go: front right") for flag in found.flags)
    held = answer(_hanging(1000.0), measured, draws=30)
    assert held.state[1] != "open" and not any(flag.startswith("let_go") for flag in held.flags)


def test_a_load_that_comes_at_once_is_the_one_that_comes_in_steps() -> None:
    """Feet that stick have no history: what the way to the first slip says of the payload's forces is taken at once."""
    stance = replace(_stance(0.006, 100.0), payload_n=np.array([6.0, 0.0, -3.0]))
    for world, standing in _truths(stance, 5):
        slip = world.first_slip(standing, 20.0)
        assert slip.factor > 1.0 and slip.under_payload_n is not None
        _, in_steps = world.load(standing, [world.payload])
        _, at_once = world.load(standing, [world.payload], slip.under_payload_n)
        assert at_once.force_n == pytest.approx(in_steps.force_n, abs=1e-3 * float(np.linalg.norm(stance.payload_n)))
        assert world.first_slip(standing, 0.1).limb == -1  # a joint crosses its play beyond this bound
