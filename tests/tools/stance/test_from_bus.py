"""Where a limb's tip would stand, from the angles that its controller sends."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from brace.bus.watch import NodeState
from brace.stance.from_bus import BusReader, _Noise
from brace.stance.limb_law import shape_of
from brace.stance.stance_file import load_stance

STANCE = load_stance(Path(__file__).parents[3] / "examples/stance/stance.toml")
LIMB = STANCE.limbs[0]


def state_at(theta_rad: np.ndarray, time_s: float) -> NodeState:
    """Of a controller that sends angles and no load."""
    state = SimpleNamespace(
        snapshot=SimpleNamespace(time_s=time_s),
        space=None,
        posture=SimpleNamespace(theta1=theta_rad[1], theta2=theta_rad[2]),
        load=None,
        interval=None,
        sigma=None,
    )
    return cast(NodeState, state)


@pytest.mark.parametrize("apart_s", [0.02, 1.0])
def test_the_tip_follows_angles_without_a_load(apart_s: float) -> None:
    """A joint that moves on slowly, however often its angle comes; then it stands, and the last angles count."""
    reader, theta, time_s = BusReader(STANCE, 0.3), np.array(LIMB.theta_rad, float), 10.0
    began_mm = tip_mm = np.zeros(3)
    for step in range(200):
        theta[1] += 1e-3 if 20 <= step < 120 else 0.0
        time_s += apart_s
        reading = reader.read({LIMB.node: state_at(theta + 1e-9 * step, time_s)}, time_s)[0].reading
        assert reading is not None
        tip_mm, began_mm = reading.tip_mm, reading.tip_mm if step == 19 else began_mm
    expected_mm = shape_of(LIMB, LIMB.model, theta).tip_mm
    assert np.linalg.norm(expected_mm - began_mm) > 10.0
    assert tip_mm == pytest.approx(expected_mm, abs=0.02)  # 0.9^80 of a lag of ten readings


def test_what_came_just_after_a_shape_is_not_forgotten() -> None:
    reader, theta = BusReader(STANCE, 0.3), np.array(LIMB.theta_rad, float)
    moved = theta + np.array([0.0, 1e-3, 0.0])
    for time_s, at in ((1.0, theta), (1.02, moved), (1.04, moved), (2.0, moved)):
        reading = reader.read({LIMB.node: state_at(at, time_s)}, time_s)[0].reading
    assert reading is not None
    assert np.linalg.norm(reading.tip_mm - shape_of(LIMB, LIMB.model, theta).tip_mm) > 0.05


def test_a_force_is_as_noisy_as_its_readings_show() -> None:
    """From the controller's interval to what neighbouring readings differ by; never less than the sensor's own noise.
    A load that comes at once is hardly noise."""
    noise, still = _Noise(0.09), np.array([1.0, 2.0, 3.0])
    assert noise.of(still, np.full(3, 4.0)) == pytest.approx(np.full(3, 4.0))
    for _ in range(300):
        found = noise.of(still, np.full(3, 4.0))
    assert found == pytest.approx(np.full(3, 0.09))
    assert np.all(noise.of(still + 100.0, np.zeros(3)) < 0.15)
    chance = np.random.default_rng(1)
    shown = [noise.of(still + 2.0 * chance.standard_normal(3), np.zeros(3)) for _ in range(2000)]
    assert np.mean(shown[200:], axis=0) == pytest.approx(np.full(3, 4.0), rel=0.1)


@pytest.mark.parametrize(("age_s", "words"), [(0.01, set()), (0.05, {"late"}), (5.0, {"K is old"})])
def test_a_k_is_late_before_it_is_old(age_s: float, words: set[str]) -> None:
    """What is late still counts; what is old is replaced by the model's."""
    reader, state = BusReader(STANCE, 0.3), state_at(np.array(LIMB.theta_rad, float), 1.0)
    valid = SimpleNamespace(is_valid=True, k=(9.0, 0.0, 0.0, 9.0, 0.0, 9.0), flags=(), theta0=LIMB.theta_rad[0])
    sent = {"space": SimpleNamespace(space=valid, time_s=1.0, age_ms=0.0)}
    seen = cast(NodeState, SimpleNamespace(**(vars(state) | sent)))
    news = reader.read({LIMB.node: seen}, 1.0 + age_s)[0]
    assert news.reading is not None and news.age_s == pytest.approx(age_s)
    assert set(news.why) - {"no load sent"} == words
    assert (np.linalg.norm(news.reading.k_n_per_mm - 9.0 * np.eye(3)) < 1e-9) == ("K is old" not in words)
