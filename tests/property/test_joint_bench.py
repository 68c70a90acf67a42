"""One joint on the bench: spring, play, friction, hardening, creep; angle imposed or torque imposed."""
from __future__ import annotations

import numpy as np
import pytest

from host_library import Array, Model, Refused, play_joint
from limbs import limb

K, GAP, TAU, H = 1e5, 0.006, 120.0, 4e9


def joint(**keys: float) -> Model:
    """The femur's joint with these keys."""
    given = {"compliance_rad_per_n_mm": 1 / K} | keys
    return limb({f"joint.femur.{key}": value for key, value in given.items()})


def ramp(most: float, steps: int = 50) -> Array:
    """0 -> most -> -most -> most."""
    return np.concatenate([np.linspace(0, most, steps), np.linspace(most, -most, 2 * steps)[1:],
                           np.linspace(-most, most, 2 * steps)[1:]])


def spring(angle: Array) -> Array:
    """k q + h q^3 beyond the play."""
    q: Array = np.sign(angle) * np.maximum(np.abs(angle) - GAP / 2, 0)
    return K * q + H * q**3


def test_torque_of_imposed_angles() -> None:
    """Spring beyond play, plus friction against the motion."""
    angle = ramp(0.02)
    model = joint(gap_rad=GAP, coulomb_n_mm=TAU, hardening_n_mm_per_rad3=H)
    wanted = spring(angle) + TAU * np.sign(np.concatenate([[0.0], np.diff(angle)]))
    np.testing.assert_allclose(play_joint(model, angle), wanted, atol=1e-9)


def test_friction_keeps_where_nothing_moves_and_turns_over_a_width() -> None:
    """Held angle: friction stays. With a reversal width it turns in proportion, fully after twice."""
    model = joint(coulomb_n_mm=TAU)
    held = play_joint(model, [0.0, 0.01, 0.01, 0.01])
    np.testing.assert_allclose(held, [0.0, *[0.01 * K + TAU] * 3])
    width = 0.001
    turned = play_joint(model, [0.0, 0.01, 0.0095, 0.009, 0.008, 0.0], reversal_rad=width)
    np.testing.assert_allclose(turned - K * np.array([0.0, 0.01, 0.0095, 0.009, 0.008, 0.0]),
                               [0, TAU, TAU / 2, 0, -TAU, -TAU], atol=1e-9)


def test_friction_may_start_strained() -> None:
    """What the spring does not carry of the first torque, friction does, up to all it can."""
    model = joint(coulomb_n_mm=TAU, gap_rad=GAP)
    angle = np.array([0.0, 1e-5, 2e-5])
    for start, share in ((60.0, 0.5), (-60.0, -0.5), (500.0, 1.0), (0.0, 0.0)):
        played = play_joint(model, angle, reversal_rad=1e-3, start_torque=start)
        np.testing.assert_allclose(played, TAU * np.minimum(share + angle / 1e-3, 1.0), atol=1e-9)


def test_friction_that_grows_with_the_load() -> None:
    """On top of the constant: a share of what the spring carries, against the motion; none within play."""
    angle = ramp(0.02)
    model = joint(gap_rad=GAP, coulomb_n_mm=TAU, coulomb_per_load_ratio=0.2, hardening_n_mm_per_rad3=H)
    sense = np.sign(np.concatenate([[0.0], np.diff(angle)]))
    wanted = spring(angle) + (TAU + 0.2 * np.abs(spring(angle))) * sense
    np.testing.assert_allclose(play_joint(model, angle), wanted, atol=1e-9)


def test_friction_whose_growth_fades() -> None:
    """The share is divided by the cube root of one plus the load over a load: all of it at no load, half at seven such
    loads, and the two-thirds power of the load far beyond."""
    angle, fade = ramp(0.02), 1.0 / 150.0
    model = joint(gap_rad=GAP, coulomb_n_mm=TAU, coulomb_per_load_ratio=0.8, coulomb_load_fade_per_n_mm=fade)
    sense = np.sign(np.concatenate([[0.0], np.diff(angle)]))
    carried = play_joint(joint(gap_rad=GAP), angle)
    wanted = carried + (TAU + 0.8 * np.abs(carried) / (1.0 + fade * np.abs(carried)) ** (1.0 / 3.0)) * sense
    np.testing.assert_allclose(play_joint(model, angle), wanted, atol=1e-9)


@pytest.mark.parametrize("gap", [0.0, GAP])
@pytest.mark.parametrize("tau", [0.0, TAU])
@pytest.mark.parametrize(("ratio", "fade"), [(0.0, 0.0), (0.25, 0.0), (0.25, 1e-3), (0.89, 1.0), (0.89, 1e-2)])
def test_imposed_torque_undoes_imposed_angle(gap: float, tau: float, ratio: float, fade: float) -> None:
    """Angles that a torque history makes, imposed in turn, need that torque wherever the joint moves."""
    model = joint(gap_rad=gap, coulomb_n_mm=tau, coulomb_per_load_ratio=ratio, hardening_n_mm_per_rad3=H,
                  coulomb_load_fade_per_n_mm=fade)
    torque = ramp(1500.0, 37)
    angle = play_joint(model, torque, torque_imposed=True)
    back = play_joint(model, angle)
    moving = np.concatenate([[False], np.abs(np.diff(angle)) > 1e-9]) & (np.abs(torque) > tau + 1e-6)
    assert moving.sum() > 100
    np.testing.assert_allclose(back[moving], torque[moving], atol=1e-7)


def test_small_torque_moves_nothing() -> None:
    """Within friction the deflection stays; within play without friction it stays where it was."""
    np.testing.assert_array_equal(
        play_joint(joint(coulomb_n_mm=TAU), [0.0, 100.0, -119.0, 119.9], torque_imposed=True), 0.0)
    stays = play_joint(joint(gap_rad=GAP), [0.0, 10.0, 0.0, -10.0, 0.0], torque_imposed=True)
    np.testing.assert_allclose(stays, [0, GAP / 2 + 10 / K, GAP / 2, -GAP / 2 - 10 / K, -GAP / 2], atol=1e-15)


def test_creep_under_constant_torque() -> None:
    """The angle grows by ratio times the elastic deflection, exactly exponentially."""
    model = joint()
    model["creep.ratio"], model["creep.time_constant_s"] = 0.25, 40.0
    t = np.array([0.0, 1.0, 7.0, 50.0, 400.0])
    angle = play_joint(model, np.full(5, 500.0), torque_imposed=True, t_s=t)
    np.testing.assert_allclose(angle, 500.0 / K * (1 + 0.25 * (1 - np.exp(-t / 40.0))), rtol=1e-13)


def test_offset_and_tests_of_their_own() -> None:
    """Deflection = angle + offset; every test starts relaxed."""
    model = joint(zero_offset_rad=0.002, coulomb_n_mm=TAU)
    angle = np.array([0.0, 0.01, 0.0, 0.01])
    torque = play_joint(model, angle, test=[1, 1, 2, 2], t_s=[0.0, 1.0, 0.0, 1.0])
    np.testing.assert_allclose(torque, K * (angle + 0.002) + [0, TAU, 0, TAU])


def test_refusals() -> None:
    """Time backwards, a rigid joint with its angle imposed, a joint that does not exist."""
    for change, status in (({"t_s": [1.0, 0.0]}, -3), ({"joint": 3}, -3), ({"joint": 2}, -6),
                           ({"reversal_rad": -1.0}, -3)):
        with pytest.raises(Refused) as refused:
            play_joint(joint(), [0.0, 0.1], **change)
        assert refused.value.status == status
