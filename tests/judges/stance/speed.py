"""How long the statics of six limbs take beside DAQP, which solves a convex law on the same stance; in one run.

    .venv/bin/python tests/judges/stance/speed.py --count 300 --seed 1
    .venv/bin/python tests/judges/stance/speed.py --count 300 --seed 1 --beside 50

From no load to weight and payload in one implicit step. Prints times and their ratios: feet that stick (friction 5) and
feet that slide (0.35). DAQP's is the time that it says itself, ours that of the C call, less that of one that does
nothing.

With --beside the first stances also go to two others. Siconos solves problems of friction, the body against soft
springs, one after the other until the body balances, as the judge's truth does. Its time is that of its own functions,
and its forces are compared with ours. MuJoCo takes a step of the same springs (elliptic cones, ten iterations without
slip) when the body has come to rest.
"""

from __future__ import annotations

import argparse
import sys
import time

import daqp  # type: ignore[import-untyped, import-not-found, unused-ignore]
import mujoco  # type: ignore[import-untyped, import-not-found, unused-ignore]
import numpy as np
from brace.native import library
from brace.native.c_data import CData
from scipy.spatial.transform import Rotation
from truth import Siconos

LIMBS, FACES, REPEATS = 6, 24, 30
OK = 0
PROBLEMS_MOST = 100
BALANCED_N = 1e-6
SAME_N = 1e-3


def _draw(rng: np.random.Generator, friction: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Feet (6, 3), K (6, 3, 3), offsets (6, 3) and friction."""
    angle = np.arange(LIMBS) * np.pi / 3 + rng.normal(0, 0.1, LIMBS)
    feet = np.stack([250 * np.cos(angle), 250 * np.sin(angle), rng.normal(-100, 10, LIMBS)], -1)
    turns = np.linalg.qr(rng.normal(size=(LIMBS, 3, 3)))[0]
    k = turns @ (np.exp(rng.uniform(np.log(0.5), np.log(20), (LIMBS, 3)))[:, :, None] * turns.transpose(0, 2, 1))
    return feet, k, rng.normal(0, 0.5, (LIMBS, 3)), friction


def _stance(feet: np.ndarray, k: np.ndarray, friction: float) -> tuple[CData, CData]:
    """The stance and its load for the C library."""
    native = library()
    stance = native.ffi.new("brace_stance_t *", {"limb_count": LIMBS})
    load = native.ffi.new("brace_stance_load_t *")
    for i in range(LIMBS):
        one = stance.limb[i]
        one.foot_mm, one.k_n_per_mm, one.normal = feet[i].tolist(), k[i].ravel().tolist(), [0.0, 0.0, 1.0]
        one.friction_ratio = friction
    native.lib.brace_stance_load_add(load, [0.0, 0.0, -30.0], [0.0, 0.0, 0.0])
    native.lib.brace_stance_load_add(load, [3.0, 0.0, -5.0], [30.0, 0.0, 0.0])
    return stance, load


def _ours(feet: np.ndarray, k: np.ndarray, offset: np.ndarray, friction: float) -> tuple[float, int]:
    """Seconds, and how many feet slide; -1: no rest was found."""
    (stance, load), ffi, lib = _stance(feet, k, friction), library().ffi, library().lib
    begun, state = ffi.new("brace_stance_state_t *"), ffi.new("brace_stance_state_t *")
    assert lib.brace_stance_place(stance, offset.ravel().tolist(), begun) == OK
    best = np.inf
    for _ in range(REPEATS):
        state[0] = begun[0]
        start = time.perf_counter()
        status = lib.brace_stance_settle(stance, load, 1, state, ffi.NULL)
        best = min(best, time.perf_counter() - start)
        if status != OK:
            return best, -1
    return best, sum(state.foot[i].contact == 1 for i in range(LIMBS))


def _our_forces_n(feet: np.ndarray, k: np.ndarray, offset: np.ndarray, friction: float) -> np.ndarray:
    """Without the loads' turning, which Siconos' problem has not."""
    (stance, load), ffi, lib = _stance(feet, k, friction), library().ffi, library().lib
    load.turning_n_mm = [0.0] * 9
    state = ffi.new("brace_stance_state_t *")
    lib.brace_stance_place(stance, offset.ravel().tolist(), state)
    lib.brace_stance_settle(stance, load, 1, state, ffi.NULL)
    return np.array([list(state.foot[i].force_n) for i in range(LIMBS)])


def _daqp(feet: np.ndarray, k: np.ndarray, offset: np.ndarray, friction: float) -> float:
    """Least energy of forces within cones of 24 faces that balance the load."""
    angle = 2 * np.pi * np.arange(FACES) / FACES
    mu = friction * np.cos(np.pi / FACES)
    one = np.stack([np.cos(angle), np.sin(angle), np.full(FACES, -mu)], -1)
    faces, energy, levers = np.kron(np.eye(LIMBS), one), np.zeros((18, 18)), np.zeros((6, 18))
    for i in range(LIMBS):
        x, y, z = feet[i]
        energy[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] = np.linalg.inv(k[i])
        arm = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        levers[:, 3 * i : 3 * i + 3] = np.concatenate([np.eye(3), arm / 100])
    load = np.array([3.0, 0.0, -35.0, 0.0, 150.0 / 100, 0.0])
    rows = np.concatenate([levers, faces])
    upper = np.concatenate([-load, np.zeros(len(faces))])
    lower = np.concatenate([-load, np.full(len(faces), -1e30)])
    sense = np.array([5] * 6 + [0] * len(faces), dtype=np.int32)
    best = np.inf
    for _ in range(REPEATS):
        _, _, flag, info = daqp.solve(energy, -offset.ravel(), rows, upper, lower, sense)
        best = min(best, info["solve_time"] + info["setup_time"])
        assert flag == 1
    return float(best)


def _siconos(
    solver: Siconos, feet: np.ndarray, k: np.ndarray, offset: np.ndarray, friction: float
) -> tuple[float, np.ndarray] | None:
    """Seconds and forces. A problem has gap, slip and slip of each foot, the body against soft springs as in `step` of
    truth.py; None: it came to no end."""
    frame = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    levers, own, stiff = np.zeros((6, 3 * LIMBS)), np.zeros((3 * LIMBS, 3 * LIMBS)), np.zeros(6)
    for i, (x, y, z) in enumerate(feet):
        foot = slice(3 * i, 3 * i + 3)
        levers[:, foot] = np.vstack([np.eye(3), [[0, -z, y], [z, 0, -x], [-y, x, 0]]]) @ frame.T
        own[foot, foot] = frame @ np.linalg.inv(k[i]) @ frame.T
        stiff += np.diag(levers[:, foot] @ np.linalg.inv(own[foot, foot]) @ levers[:, foot].T)
    load, soft = np.array([3.0, 0.0, -35.0, 0.0, 150.0, 0.0]), 0.03 * stiff
    w, away = own + levers.T @ (levers / soft[:, None]), (offset @ frame.T).ravel()
    force, body, sum_s = np.zeros(3 * LIMBS), np.zeros(6), 0.0
    for _ in range(PROBLEMS_MOST):
        q = levers.T @ (body + load / soft) - away
        took_s = solver.seconds(w, q, np.full(LIMBS, friction), force, REPEATS)
        if took_s is None:
            return None
        sum_s += took_s
        force = solver(w, q, np.full(LIMBS, friction), force)
        left = load + levers @ force
        body = body + left / soft
        if np.abs(left / [1, 1, 1, 100, 100, 100]).max() < BALANCED_N:
            return sum_s, force.reshape(-1, 3) @ frame
    return None


def _mujoco(feet: np.ndarray, k: np.ndarray, offset: np.ndarray, friction: float) -> float:
    """A step [s] of a body whose feet hang on three springs each, along K's axes; SI units."""
    limbs = []
    for i in range(LIMBS):
        stiffness, axes = np.linalg.eigh(k[i])
        axes *= np.sign(np.linalg.det(axes))
        w, x, y, z = np.roll(Rotation.from_matrix(axes).as_quat(), 1)
        x_m, y_m, z_m = 1e-3 * (feet[i] - offset[i])
        slides = "".join(
            f'<joint type="slide" axis="{axis}" stiffness="{1e3 * stiffness[at]}" damping="{30 * stiffness[at] ** 0.5}"/>'
            for at, axis in enumerate(("1 0 0", "0 1 0", "0 0 1"))
        )
        limbs.append(
            f'<body pos="{x_m} {y_m} {z_m}" quat="{w} {x} {y} {z}">{slides}'
            f'<geom type="sphere" size="0.001" mass="0.02" friction="{friction} 0.005 0.0001"/></body>'
        )
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><option timestep="0.001" cone="elliptic" noslip_iterations="10" integrator="implicitfast"/><worldbody>'
        f'<geom type="plane" size="1 1 1" friction="{friction} 0.005 0.0001" condim="3"/>'
        '<body pos="0 0 0.101"><freejoint/><inertial pos="0 0 0" mass="2.94" diaginertia="0.02 0.02 0.03"/>'
        + "".join(limbs) + "</body></worldbody></mujoco>"  # fmt: skip
    )
    data = mujoco.MjData(model)
    data.xfrc_applied[1] = [3.0, 0.0, -5.0, 0.0, 0.15, 0.0]
    for _ in range(1000):
        mujoco.mj_step(model, data)
    best = np.inf
    for _ in range(REPEATS):
        start = time.perf_counter()
        mujoco.mj_step(model, data, 10)
        best = min(best, (time.perf_counter() - start) / 10)
    return float(best)


def _beside(seed: int, count: int) -> str:
    """Siconos and MuJoCo on the first stances of both kinds, and ours."""
    rng, call, lines = np.random.default_rng(seed), _empty_call(), []
    try:
        solver = Siconos()
    except OSError as error:
        return str(error)
    for words, friction in (("feet stick", 5.0), ("feet slide", 0.35)):
        drawn = [_draw(rng, friction) for _ in range(count)]
        mine = 1e6 * float(np.median([_ours(*one)[0] - call for one in drawn]))
        solved = [(one, found) for one in drawn if (found := _siconos(solver, *one)) is not None]
        theirs = 1e6 * float(np.median([took_s for _, (took_s, _) in solved]))
        same = sum(np.abs(_our_forces_n(*one) - force).max() < SAME_N for one, (_, force) in solved)
        step = 1e6 * float(np.median([_mujoco(*one) for one in drawn]))
        lines.append(
            f"{words}, the first {count}: {mine:.1f} us; Siconos {theirs:.0f} us, {theirs / mine:.0f} times as long, the "
            f"same forces in {same} of {len(solved)} that it solves; a step of MuJoCo {step:.0f} us"
        )
    solver.close()
    return "\n".join(lines)


def _empty_call() -> float:
    """Seconds that Python needs to call C."""
    lib, best = library().lib, np.inf
    for _ in range(1000):
        start = time.perf_counter()
        lib.brace_stance_status_text(OK)
        best = min(best, time.perf_counter() - start)
    return float(best)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--beside", type=int, default=0, help="so many stances go to Siconos and MuJoCo, too")
    asked = parser.parse_args()
    rng, call = np.random.default_rng(asked.seed), _empty_call()
    for words, friction in (("feet stick", 5.0), ("feet slide", 0.35)):
        times: list[tuple[float, float]] = []
        slides = without = 0
        while len(times) < asked.count:
            drawn = _draw(rng, friction)
            ours, sliding = _ours(*drawn)
            if sliding < 0:
                without += 1
                continue
            slides += sliding
            times.append((ours - call, _daqp(*drawn)))
        mine, theirs = 1e6 * np.array(times).T
        print(f"{words}: {np.median(mine):.1f} us, worst {mine.max():.1f}; DAQP {np.median(theirs):.1f}, worst "
              f"{theirs.max():.1f}; median ratio {np.median(theirs / mine):.1f}, of the worst "
              f"{theirs.max() / mine.max():.1f}; {slides / asked.count:.2f} of {LIMBS} feet slide; {without} without a rest")
    if asked.beside:
        print(_beside(asked.seed, asked.beside))
    return 0


if __name__ == "__main__":
    sys.exit(main())
