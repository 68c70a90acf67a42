"""The simulated limb: what each effect must do, by arguments that do not use the plant's own solver."""
from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

from host_library import Model, Refused, planar_reference, play
from limbs import PAPER, geometry, limb, random_limb, symmetric

SEEDS = range(8)
POSE = (1.0, 1.4)


def compliance(model: Model, pose: tuple[float, float] = POSE) -> Any:
    """C of the limb's springs at a pose, from the reference."""
    return symmetric(*planar_reference(model, *pose)[0, 3:6])


def locked(keys: dict[str, float]) -> dict[str, float]:
    """The same limb with rigid joints: its structure."""
    return {key: value for key, value in keys.items() if not key.startswith("joint.")}


def forces(played: dict[str, Any]) -> Any:
    """Read forces, shape (n, 2)."""
    return np.stack([played["fx_n"], played["fz_n"]], axis=1)


def there_and_back(most: float, steps: int) -> Any:
    """0 -> +most -> 0 -> -most -> 0 in steps."""
    up = np.linspace(0, most, steps + 1)
    return np.concatenate([up, up[-2::-1], -up[1:], -up[-2::-1]])


# ------------------------------------------------------------------------------------------------ linear --


@pytest.mark.parametrize("seed", SEEDS)
def test_linear_limb_is_the_references_k(seed: int) -> None:
    """f = K d to 1e-9 of the force, zero offsets added, for tilted links, moment transfer and base."""
    draw = np.random.default_rng(seed)
    keys = random_limb(draw)
    offsets = draw.uniform(-0.1, 0.1, 2)
    zero = {"joint.femur.zero_offset_rad": offsets[0], "joint.tibia.zero_offset_rad": offsets[1]}
    model = limb(keys | zero)
    theta1, theta2 = draw.uniform(-3, 3, 40), draw.uniform(0.1, 3.0, 40)
    d = draw.normal(size=(40, 2))
    rows = planar_reference(limb(keys), theta1 + offsets[0], theta2 + offsets[1])
    wanted = np.einsum("nij,nj->ni", symmetric(*rows[:, :3].T), d)
    played = play(model, theta1, theta2, d[:, 0], d[:, 1])
    assert np.all(np.abs(forces(played) - wanted) <= 1e-9 * rows[:, 7, None])
    base = np.array([keys["base.x_mm_per_n"], keys["base.z_mm_per_n"]])
    np.testing.assert_allclose(np.stack([played["base_x_mm"], played["base_z_mm"]], 1), base * forces(played))


def test_deflections_add_up_to_the_displacement() -> None:
    """Structure's share C f plus levers times joint deflections is the imposed displacement."""
    draw = np.random.default_rng(1)
    keys = random_limb(draw)
    model, structure = limb(keys), limb(locked(keys))
    played = play(model, *POSE, [1.0, -0.4], [0.3, 2.0])
    g = geometry(model, *POSE)
    for row, (f, d) in enumerate(zip(forces(played), [[1.0, 0.3], [-0.4, 2.0]])):
        turned = g["p1"] * played["enc1_rad"][row] + g["p2"] * played["enc2_rad"][row]
        total = compliance(structure) @ f + turned
        np.testing.assert_allclose(total, d, atol=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
def test_reciprocal_and_conservative(seed: int) -> None:
    """Maxwell-Betti for the linear limb; with play and hardening too, work round a closed path is nothing."""
    draw = np.random.default_rng(50 + seed)
    keys = random_limb(draw)
    unit = play(limb(keys), *POSE, [1, 0], [0, 1])
    assert unit["fz_n"][0] == pytest.approx(unit["fx_n"][1], rel=1e-9, abs=1e-12 * abs(unit["fx_n"][0]))
    for joint in ("femur", "tibia"):
        keys[f"joint.{joint}.gap_rad"] = draw.uniform(0, 4e-3)
        keys[f"joint.{joint}.hardening_n_mm_per_rad3"] = 10 ** draw.uniform(6, 9)
    angle = np.linspace(0, 2 * np.pi, 4001)
    path = np.stack([2 * np.cos(angle), 1.5 * np.sin(angle)], 1)
    f = forces(play(limb(keys), *POSE, path[:, 0], path[:, 1]))
    work = np.sum(0.5 * (f[1:] + f[:-1]) * np.diff(path, axis=0))
    stored = np.abs(np.einsum("ni,ni->n", f, path)).max()
    # the trapezoid's error over 4000 steps of a piecewise smooth force
    assert abs(work) <= 1e-4 * stored


# ------------------------------------------------------------------------- energy, by other searches --


def energy(keys: dict[str, float], before: Any, q: Any, d: Any, load: Any) -> Any:
    """What the limb minimises, for deflections q of shape (2, ...), written out from physics.md."""
    g = geometry(limb(keys), *POSE)
    stiffness = np.linalg.inv(compliance(limb(locked(keys))))
    left = [d[axis] - g["p1"][axis] * q[0] - g["p2"][axis] * q[1] for axis in (0, 1)]
    total = 0.5 * (stiffness[0, 0] * left[0] ** 2 + 2 * stiffness[0, 1] * left[0] * left[1]
                   + stiffness[1, 1] * left[1] ** 2)
    for i, joint in enumerate(("femur", "tibia")):
        def of(name: str) -> float:
            return keys.get(f"joint.{joint}.{name}", 0.0)

        beyond = np.maximum(np.abs(q[i]) - of("gap_rad") / 2, 0.0)
        total = total + beyond**2 / 2 / of("compliance_rad_per_n_mm")
        total = total + of("hardening_n_mm_per_rad3") * beyond**4 / 4
        total = total + of("coulomb_n_mm") * np.abs(q[i] - before[i]) - load[i] * q[i]

        def carried(deflection: Any) -> Any:  # the spring's torque summed up to a deflection, its size taken
            past = np.maximum(np.abs(deflection) - of("gap_rad") / 2, 0.0)
            size = past**2 / 2 / of("compliance_rad_per_n_mm") + of("hardening_n_mm_per_rad3") * past**4 / 4
            return np.sign(deflection) * size

        total = total + of("coulomb_per_load_ratio") * np.abs(carried(q[i]) - carried(before[i]))
    return total


def random_drive(draw: np.random.Generator) -> dict[str, float]:
    """A limb with every drive effect at both joints, sized to matter within a few mm."""
    keys = random_limb(draw)
    rubbing = np.random.default_rng(int(1e6 * keys["geometry.femur_mm"]))
    for joint in ("femur", "tibia"):
        keys |= {f"joint.{joint}.gap_rad": draw.choice([0.0, draw.uniform(0, 6e-3)]),
                 f"joint.{joint}.coulomb_n_mm": draw.choice([0.0, 10 ** draw.uniform(0, 3)]),
                 f"joint.{joint}.coulomb_per_load_ratio": rubbing.choice([0.0, rubbing.uniform(0, 0.9)]),
                 f"joint.{joint}.hardening_n_mm_per_rad3": draw.choice([0.0, 10 ** draw.uniform(6, 10)])}
    return keys


@pytest.mark.parametrize("seed", range(20))
def test_rest_state_has_the_least_energy(seed: int) -> None:
    """No other deflections near or far have less; a grid refined about its best finds the same place.

    Along a wandering path, so that friction remembers. The searches know nothing of Newton's method.
    """
    draw = np.random.default_rng(1000 + seed)
    keys = random_drive(draw)
    d = np.cumsum(draw.normal(size=(8, 2)), axis=0)
    weights = draw.choice([0.0, 1.0]) * draw.uniform(0, 5, 3)
    keys |= dict(zip(("gravity.femur_n", "gravity.tibia_n", "gravity.knee_n"), weights))
    g = geometry(limb(keys), *POSE)
    # moments of the weights, which act along -z
    load = [-(weights[0] * g["a"][0] / 2 + weights[2] * g["a"][0] + weights[1] * (g["a"] + g["w"] / 2)[0]),
            -weights[1] * g["w"][0] / 2]
    played = play(limb(keys), *POSE, d[:, 0], d[:, 1])
    before = np.zeros(2)
    for row in range(len(d)):
        q = np.array([played["enc1_rad"][row], played["enc2_rad"][row]])
        least = energy(keys, before, q, d[row], load)
        slack = 1e-9 * (abs(least) + 1e-3)
        for size in (1e-1, 1e-3, 1e-5):
            others = q[:, None] + size * draw.normal(size=(2, 400))
            assert energy(keys, before, others, d[row], load).min() >= least - slack
            for i in (0, 1):  # one joint alone, where friction's kinks are
                alone = q[:, None] + np.zeros(200)
                alone[i] += size * draw.normal(size=200)
                assert energy(keys, before, alone, d[row], load).min() >= least - slack
        centre, width = q + 0.01 * draw.normal(size=2), 0.1
        for _ in range(60):
            grid = np.array(list(itertools.product(*(c + width * np.linspace(-1, 1, 9) for c in centre)))).T
            centre, width = grid[:, np.argmin(energy(keys, before, grid, d[row], load))], 0.75 * width
        assert energy(keys, before, centre, d[row], load) >= least - slack
        before = q


@pytest.mark.parametrize("seed", range(6))
def test_every_record_is_solved(seed: int) -> None:
    """Limbs at the edges of what limb.toml admits: each play is solved, or refused as singular; never NaN."""
    draw = np.random.default_rng(2000 + seed)
    solved = 0
    for _ in range(60):
        keys = random_drive(draw)
        for key in list(keys):
            if "geometry" not in key and "tilt" not in key and draw.uniform() < 0.3:
                keys[key] = 0.0
        if draw.uniform() < 0.3:
            keys["joint.femur.coulomb_n_mm"] = 10 ** draw.uniform(-6, 8)
            keys["joint.tibia.hardening_n_mm_per_rad3"] = 10 ** draw.uniform(-3, 16)
            keys["joint.tibia.gap_rad"] = draw.choice([1e-12, 0.5])
        keys |= {"gravity.tibia_n": draw.choice([0.0, 100.0]), "contact.play_mm": draw.choice([0.0, 0.5]),
                 "creep.ratio": draw.choice([0.0, 1.0])}
        theta1, theta2 = draw.uniform(-3, 3), draw.choice([0.0, np.pi, draw.uniform(-3, 3)])
        d = np.cumsum(draw.normal(size=(40, 2)), axis=0)
        try:
            played = play(limb(keys), theta1, theta2, d[:, 0], d[:, 1])
        except Refused as refused:
            assert "yields" in str(refused), keys
            continue
        solved += 1
        assert all(np.all(np.isfinite(column)) for column in played.values()), keys
    assert solved > 20


# ------------------------------------------------------------------------------------ one effect at a time --


def test_play_leaves_a_dead_zone_of_gap_times_lever() -> None:
    """Tip free across z: no force within +-gap/2 of lever, the limb's own slope beyond; both ways."""
    for joint, lever in (("femur", "p1"), ("tibia", "p2")):
        gap = 0.004
        model = limb(PAPER | {f"joint.{joint}.gap_rad": gap})
        half = abs(geometry(model, *POSE)[lever][1]) * gap / 2
        dz = there_and_back(3 * half, 30)
        played = play(model, *POSE, 0 * dz, dz, free_axis=1)
        beyond = np.sign(dz) * np.maximum(np.abs(dz) - half, 0)
        np.testing.assert_allclose(played["fz_n"], beyond / compliance(limb(PAPER))[1, 1], atol=1e-9)
        np.testing.assert_array_equal(played["fx_n"], 0)


def test_friction_makes_a_loop_of_constant_height() -> None:
    """Tip free across z, one sliding joint: forces up and down differ by 2 tau / lever; nothing moves before.

    While the joint sticks the structure alone yields: the first steps have its slope. The torque is then
    spring + tau on the way up and spring - tau on the way down.
    """
    tau = 150.0
    for joint, lever in (("femur", "p1"), ("tibia", "p2")):
        model = limb(PAPER | {f"joint.{joint}.coulomb_n_mm": tau})
        arm = abs(geometry(model, *POSE)[lever][1])
        c_all = compliance(limb(PAPER))[1, 1]
        own = f"joint.{joint}.compliance_rad_per_n_mm"
        rigid = {key: value for key, value in PAPER.items() if key != own}
        c_stuck = compliance(limb(rigid))[1, 1]
        dz = there_and_back(3.0, 300)
        f = play(model, *POSE, 0 * dz, dz, free_axis=1)["fz_n"]
        small = dz[:300] < 0.9 * c_stuck * tau / arm
        np.testing.assert_allclose(f[:300][small], dz[:300][small] / c_stuck, atol=1e-9)
        # sliding: d = c_stuck f + (c_all - c_stuck) (f -+ tau/arm)
        for d in (-1.0, -0.5, -0.1):
            down, up = f[300 + round((3 - d) * 100)], f[900 + round((d + 3) * 100)]
            assert down == pytest.approx((d - (c_all - c_stuck) * tau / arm) / c_all, abs=1e-9)
            assert up == pytest.approx((d + (c_all - c_stuck) * tau / arm) / c_all, abs=1e-9)


def test_sliding_joints_on_rigid_links() -> None:
    """Joints alone yield: the displacement imposes their deflections q, and each carries k q + tau.

    The plant gives rigid links a billionth of the limb's compliance, so the force is right to that.
    """
    tau = np.array([30.0, 20.0])
    model = limb({"joint.femur.compliance_rad_per_n_mm": 1e-5, "joint.tibia.compliance_rad_per_n_mm": 2e-5,
                  "joint.femur.coulomb_n_mm": tau[0], "joint.tibia.coulomb_n_mm": tau[1]})
    g = geometry(model, *POSE)
    levers = np.stack([g["p1"], g["p2"]], axis=1)
    q = np.outer(np.linspace(0, 1, 6), [0.01, 0.02])
    d = q @ levers.T
    torque = q[1:] / [1e-5, 2e-5] + tau
    f = forces(play(model, *POSE, d[:, 0], d[:, 1]))[1:]
    np.testing.assert_allclose(f, np.linalg.solve(levers.T, torque.T).T, rtol=1e-6)


def test_rigid_joint_with_play_is_a_pair_of_stops() -> None:
    """Tip free across z: beyond the play the structure alone yields, but for the stop's 1e-8 of it."""
    keys = {key: value for key, value in PAPER.items() if key != "joint.femur.compliance_rad_per_n_mm"}
    model = limb(keys | {"joint.femur.gap_rad": 0.004})
    half = abs(geometry(model, *POSE)["p1"][1]) * 0.002
    dz = there_and_back(3 * half, 12)
    f = play(model, *POSE, 0 * dz, dz, free_axis=1)["fz_n"]
    beyond = np.sign(dz) * np.maximum(np.abs(dz) - half, 0)
    np.testing.assert_allclose(f, beyond / compliance(limb(keys))[1, 1], rtol=1e-7, atol=1e-9)


def test_refined_steps_end_in_the_same_state() -> None:
    """A path along a straight line, then back: 4, 40 or 400 steps a leg end with the same force.

    One sliding joint: its deflection depends on the turning points only.
    """
    model = limb(PAPER | {"joint.tibia.coulomb_n_mm": 100.0, "joint.tibia.gap_rad": 0.003,
                          "joint.femur.hardening_n_mm_per_rad3": 1e8})
    ends = []
    for steps in (4, 40, 400):
        d = np.concatenate([np.linspace(0, 2, steps + 1), np.linspace(2, -1, steps + 1)[1:]])
        ends.append(forces(play(model, *POSE, 0.3 * d, d))[-1])
    np.testing.assert_allclose(ends[1:], [ends[0]] * 2, atol=1e-8)


def test_hardening_is_the_cubic() -> None:
    """Tip free across z: displacement = structure's part + lever times the root of k q + h q^3 = torque."""
    h = 3e8
    keys = PAPER | {"joint.femur.hardening_n_mm_per_rad3": h}
    del keys["joint.tibia.compliance_rad_per_n_mm"]
    dz = np.linspace(-4, 4, 41)
    f = play(limb(keys), *POSE, 0 * dz, dz, free_axis=1)["fz_n"]
    arm = geometry(limb(keys), *POSE)["p1"][1]
    k = 1 / keys["joint.femur.compliance_rad_per_n_mm"]
    q = (dz - compliance(limb(locked(keys)))[1, 1] * f) / arm
    np.testing.assert_allclose(arm * f, k * q + h * q**3, rtol=1e-8, atol=1e-7)
    assert np.abs(h * q**2).max() > 0.2 * k  # it matters here


def test_creep_relaxes_with_its_time_constant() -> None:
    """Rigid links: the joint's total deflection is imposed, the force falls to 1/(1 + ratio) at the rate
    (1 + ratio)/T; a step of dt leaves an error of order dt in the rate."""
    ratio, time_constant, dt = 0.3, 50.0, 0.05
    keys = {"joint.femur.compliance_rad_per_n_mm": 1e-5, "joint.tibia.compliance_rad_per_n_mm": 2e-5,
            "creep.ratio": ratio, "creep.time_constant_s": time_constant}
    t = np.arange(0, 300, dt)
    f = forces(play(limb(keys), *POSE, np.full(t.size, 0.7), 1.0, t_s=t))
    wanted = f[0] * (1 + ratio * np.exp(-(1 + ratio) * t[:, None] / time_constant)) / (1 + ratio)
    np.testing.assert_allclose(f, wanted, rtol=0, atol=np.abs(f).max() * dt / time_constant)


def test_creep_rests_between_runs_unless_asked() -> None:
    """A new run begins with no force at no displacement; with creep_runs_on it does not."""
    keys = PAPER | {"creep.ratio": 0.2, "creep.time_constant_s": 30.0}
    run = np.repeat([1, 2], 10)
    d = np.concatenate([np.ones(10), np.zeros(10)])
    rested = forces(play(limb(keys), *POSE, d, d, run=run))
    running = forces(play(limb(keys), *POSE, d, d, run=run, creep_runs_on=True))
    np.testing.assert_array_equal(rested[10:], 0)
    assert np.abs(running[10]).min() > 1e-3
    np.testing.assert_array_equal(rested[:10], running[:10])


def test_warm_joints_yield_more() -> None:
    """At reference + 10 degC, K is that of joints softer by 1 + 10 rate; links stay."""
    rate = 0.02
    warm = {key: value * (1.2 if key.startswith("joint") else 1) for key, value in PAPER.items()}
    f = forces(play(limb(PAPER | {"thermal.joint_compliance_per_degc": rate}), *POSE, [1, 0], [0, 1],
                    temp_degc=[32.0, 22.0]))
    np.testing.assert_allclose(f[0], np.linalg.inv(compliance(limb(warm)))[:, 0], rtol=1e-12)
    np.testing.assert_allclose(f[1], np.linalg.inv(compliance(limb(PAPER)))[:, 1], rtol=1e-12)


def test_gravity_is_the_slope_of_potential_energy() -> None:
    """At a held tip f = -K (displacement that the weights' torques would make); torques by differences."""
    weights = {"gravity.femur_n": 3.0, "gravity.tibia_n": 2.0, "gravity.knee_n": 1.5}
    l1, l2 = 185.0, 313.5

    def potential(q1: float, q2: float) -> Any:
        knee = l1 * np.sin(POSE[0] + q1)
        tip = knee + l2 * np.sin(POSE[0] - POSE[1] + q1 + q2)
        return 3.0 * knee / 2 + 1.5 * knee + 2.0 * (knee + tip) / 2

    step = 1e-5
    torque = [-(potential(step, 0) - potential(-step, 0)) / 2 / step,
              -(potential(0, step) - potential(0, -step)) / 2 / step]
    model = limb(PAPER)
    g = geometry(model, *POSE)
    sag = 1.0e-5 * torque[0] * g["p1"] + 1.6e-5 * torque[1] * g["p2"]
    wanted = -np.linalg.solve(compliance(model), sag)
    f = forces(play(limb(PAPER | weights), *POSE, 0.0, 0.0))[0]
    np.testing.assert_allclose(f, wanted, rtol=1e-7)
    assert sag[1] < 0  # it hangs down


def test_contact_drags_the_tip() -> None:
    """The force is that of the displacement less half the clearance to the side moved to; none until then."""
    play_mm = 0.3
    d = there_and_back(1.0, 20)
    f = forces(play(limb(PAPER | {"contact.play_mm": play_mm}), *POSE, d, 0.0))
    tip, at = [], 0.0
    for socket in d:
        at = min(max(at, socket - play_mm / 2), socket + play_mm / 2)
        tip.append(at)
    wanted = np.outer(tip, np.linalg.inv(compliance(limb(PAPER)))[:, 0])
    np.testing.assert_allclose(f, wanted, atol=1e-12)


def test_link_changes_at_its_time() -> None:
    """From at_s on, that row included, the link is as the model has it; before, its bending is multiplied. Without a
    time it never changed."""
    for link in ("femur", "tibia"):
        changed = PAPER | {f"link.{link}.bending_mm_per_n": 2 * PAPER[f"link.{link}.bending_mm_per_n"]}
        model = limb(PAPER | {"change.at_s": 8.0, "change.link": {"femur": 1, "tibia": 2}[link],
                              "change.bending_factor": 2.0})
        f = forces(play(model, *POSE, np.ones(4), 0.0))
        for row, keys in enumerate((changed, changed, PAPER, PAPER)):
            np.testing.assert_allclose(f[row], np.linalg.inv(compliance(limb(keys)))[:, 0], rtol=1e-12)
        never = limb(PAPER | {"change.link": {"femur": 1, "tibia": 2}[link], "change.bending_factor": 2.0})
        np.testing.assert_array_equal(forces(play(never, *POSE, np.ones(4), 0.0)),
                                      forces(play(limb(PAPER), *POSE, np.ones(4), 0.0)))


def test_sensor_in_its_order() -> None:
    """bias + drift t + gain R crosstalk f, then clipped, axis by axis."""
    sensor = {"bias_x_n": 0.3, "bias_z_n": -0.2, "gain": 1.1, "rotation_rad": 0.2, "crosstalk_xz": 0.05,
              "crosstalk_zx": -0.03, "drift_x_n_per_s": 1e-3, "drift_z_n_per_s": -2e-3, "saturation_n": 6.0}
    d = np.linspace(-2, 2, 9)
    t = np.arange(9) * 10.0
    true = forces(play(limb(PAPER), *POSE, d, -d))
    c, s = np.cos(0.2), np.sin(0.2)
    read = 1.1 * true @ np.array([[1, 0.05], [-0.03, 1]]).T @ np.array([[c, -s], [s, c]]).T
    read = np.clip(read + [0.3, -0.2] + np.outer(t, [1e-3, -2e-3]), -6.0, 6.0)
    model = limb(PAPER | {f"sensor.{key}": value for key, value in sensor.items()})
    played = play(model, *POSE, d, -d, t_s=t)
    np.testing.assert_allclose(forces(played), read, atol=1e-12)
    assert np.any(np.abs(read) == 6.0) and np.any(np.abs(read) < 5.0)
    zeroed = forces(play(model, *POSE, d, -d, t_s=t, zeroed=True, run=np.repeat([1, 2, 3], 3)))
    np.testing.assert_allclose(zeroed, read - np.repeat(read[::3], 3, axis=0), atol=1e-12)


def test_runs_start_centred_and_relaxed() -> None:
    """The same run twice reads the same, whatever the first left behind."""
    memory = {"joint.tibia.coulomb_n_mm": 80.0, "joint.femur.gap_rad": 0.002, "contact.play_mm": 0.1}
    model = limb(PAPER | memory)
    once = there_and_back(1.0, 4)[:-3]
    f = forces(play(model, *POSE, np.tile(once, 2), 0.2, run=np.repeat([1, 2], once.size)))
    np.testing.assert_array_equal(f[:once.size], f[once.size:])


def test_refusals() -> None:
    """Each fault has its status, and no output is touched: play() would show NaN turned into numbers."""
    def status(**change: Any) -> int:
        arguments: dict[str, Any] = {"dx_mm": [0.0, 1.0], "dz_mm": 0.0} | change
        keys = PAPER | arguments.pop("keys", {})
        with pytest.raises(Refused) as refused:
            play(limb(keys), *POSE, arguments.pop("dx_mm"), arguments.pop("dz_mm"), **arguments)
        return int(refused.value.status)

    assert status(dx_mm=[0.0, np.nan]) == -2
    assert status(temp_degc=np.inf) == -2
    assert status(t_s=[1.0, 0.0]) == -3
    assert status(free_axis=3) == -3
    assert status(keys={"joint.femur.gap_rad": -1e-9}) == -5
    assert status(keys={"sensor.gain": 0.0}) == -5
    assert status(keys={"change.link": 1.5}) == -5
    assert status(keys={key: 0.0 for key in PAPER}) == -6
