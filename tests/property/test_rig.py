"""The rig: its sequence, its instruments, and what the paper takes from its tests."""
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from host_library import Model, Refused, check, column, doubles, ffi, lib, planar_reference, play
from limbs import PAPER, geometry, limb

POSE = (1.0, 1.4)
INTEGERS = ("run", "config", "axis", "rep", "step")
REALS = ("theta1_rad", "theta2_rad", "t_s", "temp_degc", "dx_mm", "dz_mm", "fx_n", "fz_n", "enc1_rad",
         "enc2_rad", "base_x_mm", "base_z_mm")


def record(model: Model | None, poses: Any = (POSE,), only: tuple[str, ...] = INTEGERS + REALS,
           **design: Any) -> dict[str, Any]:
    """The rig's test at these poses as columns; keywords change the paper's design."""
    theta = np.ascontiguousarray(np.array(poses, dtype=np.float64).T)
    test = ffi.new("brace_rig_design_t *")
    lib.brace_rig_design_default(test)
    keep = [theta[0].copy(), theta[1].copy()]
    test.config_count, test.theta1_rad, test.theta2_rad = len(poses), doubles(keep[0]), doubles(keep[1])
    for key, value in design.items():
        setattr(test, key, value)
    count = lib.brace_rig_row_count(test)
    out: dict[str, Any] = {name: np.zeros(count, dtype=np.int32) for name in INTEGERS if name in only}
    out |= {name: np.zeros(count) for name in REALS if name in only}
    columns = ffi.new("brace_rig_record_t *", {
        name: ffi.from_buffer("int32_t[]" if name in INTEGERS else "double[]", values)
        for name, values in out.items()})
    check(lib.brace_rig_play(test, ffi.NULL if model is None else model.c, columns))
    return out


def test_sequence_of_the_papers_test() -> None:
    """0 -> +n -> 0 -> -n -> 0 along x twice, then z twice, pose by pose; dwell and pause between."""
    rows = record(None, poses=((0.7, 1.0), (0.2, 0.5)), steps_per_side=2, temp_rise_degc=3.0)
    assert rows["run"].size == 2 * 2 * 2 * 9
    np.testing.assert_array_equal(rows["run"], np.repeat(np.arange(1, 9), 9))
    np.testing.assert_array_equal(rows["config"], np.repeat([1, 2], 36))
    np.testing.assert_array_equal(rows["axis"], np.tile(np.repeat([0, 1], 18), 2))
    np.testing.assert_array_equal(rows["rep"], np.tile(np.repeat([1, 2], 9), 4))
    np.testing.assert_array_equal(rows["step"], np.tile(np.arange(9), 8))
    moved = 0.635 * np.array([0, 1, 2, 1, 0, -1, -2, -1, 0])
    along = np.where(rows["axis"] == 0, rows["dx_mm"], rows["dz_mm"])
    np.testing.assert_allclose(along, np.tile(moved, 8))
    np.testing.assert_array_equal(np.where(rows["axis"] == 0, rows["dz_mm"], rows["dx_mm"]), 0)
    np.testing.assert_array_equal(rows["t_s"], np.concatenate(
        [56 * n + 4.0 * np.arange(9) for n in range(8)]))
    np.testing.assert_allclose(rows["temp_degc"], 22 + 3 * (1 - np.exp(-rows["t_s"] / 600)))
    np.testing.assert_array_equal(rows["theta1_rad"], np.repeat([0.7, 0.2], 36))


def test_cyclic_test_of_figure_12() -> None:
    """First to the negative side, up through zero, back and to zero again."""
    rows = record(None, steps_per_side=2, cyclic=1, axes=2, repeats=1, step_mm=1.0)
    np.testing.assert_array_equal(rows["dz_mm"], [0, -1, -2, -1, 0, 1, 2, 1, 0, -1, -2, -1, 0])


def test_shuffled_runs_are_the_same_runs() -> None:
    """Every (config, axis, rep) once, in another order; time runs on."""
    plain = record(None, poses=((0.7, 1.0), (0.2, 0.5)))
    mixed = record(None, poses=((0.7, 1.0), (0.2, 0.5)), shuffled=1, seed=5)
    keys = [set(zip(*(rows[name] for name in ("config", "axis", "rep", "step")))) for rows in (plain, mixed)]
    assert keys[0] == keys[1]
    assert not np.array_equal(plain["config"], mixed["config"])
    np.testing.assert_array_equal(plain["t_s"], mixed["t_s"])


def test_instruments() -> None:
    """Without noise the readings are the plant's, rounded; with it they scatter by sigma, seed by seed."""
    keys = PAPER | {"base.x_mm_per_n": 1e-3}
    exact = record(limb(keys), resolution_n=0.0)
    played = play(limb(keys), *POSE, exact["dx_mm"], exact["dz_mm"], run=exact["run"], t_s=exact["t_s"],
                  small=False)
    for name, values in played.items():
        np.testing.assert_array_equal(exact[name], values)
    rounded = record(limb(keys))
    np.testing.assert_array_equal(rounded["fx_n"], np.round(exact["fx_n"] * 16) / 16)
    np.testing.assert_array_equal(record(limb(keys), range_n=3.0, resolution_n=0.0)["fx_n"],
                                  np.clip(exact["fx_n"], -3, 3))
    scatter: dict[str, Any] = {"noise_n": 0.1, "resolution_n": 0.0, "encoder_noise_rad": 1e-5,
                               "base_noise_mm": 1e-3, "repeats": 500}
    noisy = {seed: record(limb(keys), **scatter, seed=seed) for seed in (1, 2)}
    quiet = record(limb(keys), resolution_n=0.0, repeats=500)
    for name, sigma in (("fx_n", 0.1), ("fz_n", 0.1), ("enc1_rad", 1e-5), ("enc2_rad", 1e-5),
                        ("base_x_mm", 1e-3)):
        noise = (noisy[1][name] - quiet[name]) / sigma
        # 17,000 readings: mean and variance within five sigma of their own
        assert abs(noise.mean()) < 5 / np.sqrt(noise.size)
        assert abs(noise.var() - 1) < 5 * np.sqrt(2 / noise.size)
        assert abs(np.mean(noise[1:] * noise[:-1])) < 5 / np.sqrt(noise.size)
        assert abs(np.mean(noise**4) - 3) < 5 * np.sqrt(96 / noise.size)
        assert not np.array_equal(noisy[1][name], noisy[2][name])
    alone = record(limb(keys), **scatter, seed=1, only=("fz_n",))
    np.testing.assert_array_equal(alone["fz_n"], noisy[1]["fz_n"])


def test_zeroed_readings_start_at_nothing() -> None:
    """Zeroed per run, each run's first reading is 0 and the others are less the same."""
    model = limb(PAPER | {"gravity.tibia_n": 5.0})
    plain, zeroed = record(model, resolution_n=0.0), record(model, resolution_n=0.0, zeroed=1)
    first = plain["step"] == 0
    assert np.all(plain["fz_n"][first] != 0) and np.all(zeroed["fz_n"][first] == 0)
    np.testing.assert_array_equal(zeroed["fz_n"], plain["fz_n"] - plain["fz_n"][first][plain["run"] - 1])


def slopes(model: Model, least_squares: bool, steps: int = 4, step_mm: float = 0.635) -> Any:
    """k_xx k_xz k_zx k_zz by slopes at POSE."""
    theta1, theta2, k = column(POSE[0], 1), column(POSE[1], 1), np.zeros(4)
    check(lib.brace_rig_slopes(model.c, 1, doubles(theta1), doubles(theta2), step_mm, steps,
                               int(least_squares), doubles(k)))
    return k


def test_slopes_of_a_linear_limb_are_its_k() -> None:
    """Both rules, all four entries; k_xz is the force along x from a step along z. Steps of 0.01 mm turn the limb by
    1e-4 rad at most; what that adds to one side's slope it takes from the other's, but for its square."""
    k = planar_reference(limb(PAPER), *POSE)[0, [0, 1, 1, 2]]
    for rule in (False, True):
        np.testing.assert_allclose(slopes(limb(PAPER), rule, step_mm=0.01), k, rtol=1e-7)
    mixed = slopes(limb(PAPER | {"sensor.crosstalk_xz": 0.1}), True, step_mm=0.01)
    np.testing.assert_allclose(mixed, [k[0] + 0.1 * k[2], k[1] + 0.1 * k[3], k[2], k[3]], rtol=1e-7)


def test_mean_of_ratios_weighs_the_small_steps() -> None:
    """On a cubic force the two rules differ as their formulas do."""
    keys = {"joint.femur.compliance_rad_per_n_mm": 1e-4, "joint.femur.hardening_n_mm_per_rad3": 1e8,
            "link.femur.axial_mm_per_n": 0.5, "link.femur.bending_mm_per_n": 0.5}
    steps = np.array([0, 1, 2, 3, 4, 3, 2, 1, 0, -1, -2, -3, -4, -3, -2, -1, 0])
    f = play(limb(keys), *POSE, 0.0, 0.635 * steps, small=False)["fz_n"][steps != 0]
    d = 0.635 * steps[steps != 0]
    assert slopes(limb(keys), False)[3] == pytest.approx(np.mean(f / d), rel=1e-9)
    assert slopes(limb(keys), True)[3] == pytest.approx(np.sum(f * d) / np.sum(d * d), rel=1e-9)


def shift(model: Model, axis: int, steps: int = 400, step_mm: float = 0.02) -> float:
    """The cyclic test's zero-force shift [mm]."""
    out = np.zeros(1)
    check(lib.brace_rig_zero_force_shift(model.c, *POSE, axis, step_mm, steps, doubles(out)))
    return float(out[0])


def test_zero_force_shift() -> None:
    """Play: gap times lever. Friction: 2 compliance torque lever. Neither: nothing. The test moves the tip by up to 10 mm
    of a lever of some 300 mm, and the square of that turn changes the lever: by 1e-3 of itself."""
    g = geometry(limb(PAPER), *POSE)
    gap, tau = np.radians(20 / 60), 50.0
    for joint, lever in (("femur", "p1"), ("tibia", "p2")):
        for axis in (0, 1):
            arm = abs(g[lever][axis])
            assert shift(limb(PAPER | {f"joint.{joint}.gap_rad": gap}),
                         axis) == pytest.approx(gap * arm, rel=1e-3)
            s = PAPER[f"joint.{joint}.compliance_rad_per_n_mm"]
            rubbed = shift(limb(PAPER | {f"joint.{joint}.coulomb_n_mm": tau}), axis)
            assert rubbed == pytest.approx(2 * s * tau * arm, rel=1e-3)
    assert shift(limb(PAPER), 1) == pytest.approx(0, abs=1e-8)  # rest to 1e-9 N, and 0.4 N/mm
    paper = np.zeros(1)
    model = limb(PAPER | {"joint.femur.gap_rad": gap})
    pose = np.radians([70, 50])
    check(lib.brace_rig_zero_force_shift(model.c, *pose, 1, 0.05, 200, doubles(paper)))
    wanted = gap * (185 * np.cos(np.radians(70)) + 313.5 * np.cos(np.radians(20)))
    assert paper[0] == pytest.approx(wanted, rel=1e-3)
    with pytest.raises(Refused):
        shift(limb(PAPER | {"joint.femur.gap_rad": 0.4}), 1, steps=4)


def test_unsound_designs_are_refused() -> None:
    """No rows, and E_RANGE, for what no rig does."""
    for change in ({"axes": 0}, {"axes": 4}, {"repeats": 0}, {"step_mm": 0.0}, {"step_mm": np.nan},
                   {"range_n": 0.0}, {"dwell_s": - \
                       1.0}, {"noise_n": np.inf}, {"poses": ((np.nan, 1.0),)},
                   {"temp_time_constant_s": 0.0}, {"repeats": 1000, "steps_per_side": 10000}):
        with pytest.raises(Refused):
            record(limb(PAPER), **change)
