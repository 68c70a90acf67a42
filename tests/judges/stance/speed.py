"""How long the statics of six limbs take beside DAQP, which solves a convex law on the same stance; in one run.

    .venv/bin/python tests/judges/stance/speed.py --count 300 --seed 1

From no load to weight and payload in one implicit step. Prints times and their ratios: feet that stick (friction 5) and
feet that slide (0.35). DAQP's is the time that it says itself, ours that of the C call, less that of one that does
nothing.
"""

from __future__ import annotations

import argparse
import sys
import time

import daqp  # type: ignore[import-untyped, import-not-found, unused-ignore]
import numpy as np
from brace.native import library

LIMBS, FACES, REPEATS = 6, 24, 30
OK = 0


def _draw(rng: np.random.Generator, friction: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Feet (6, 3), K (6, 3, 3), offsets (6, 3) and friction."""
    angle = np.arange(LIMBS) * np.pi / 3 + rng.normal(0, 0.1, LIMBS)
    feet = np.stack([250 * np.cos(angle), 250 * np.sin(angle), rng.normal(-100, 10, LIMBS)], -1)
    turns = np.linalg.qr(rng.normal(size=(LIMBS, 3, 3)))[0]
    k = turns @ (np.exp(rng.uniform(np.log(0.5), np.log(20), (LIMBS, 3)))[:, :, None] * turns.transpose(0, 2, 1))
    return feet, k, rng.normal(0, 0.5, (LIMBS, 3)), friction


def _ours(feet: np.ndarray, k: np.ndarray, offset: np.ndarray, friction: float) -> tuple[float, int]:
    """Seconds, and how many feet slide; -1: no rest was found."""
    native = library()
    ffi, lib = native.ffi, native.lib
    stance, load = ffi.new("brace_stance_t *", {"limb_count": LIMBS}), ffi.new("brace_stance_load_t *")
    for i in range(LIMBS):
        one = stance.limb[i]
        one.foot_mm, one.k_n_per_mm, one.normal = feet[i].tolist(), k[i].ravel().tolist(), [0.0, 0.0, 1.0]
        one.friction_ratio = friction
    lib.brace_stance_load_add(load, [0.0, 0.0, -30.0], [0.0, 0.0, 0.0])
    lib.brace_stance_load_add(load, [3.0, 0.0, -5.0], [30.0, 0.0, 0.0])
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
    return 0


if __name__ == "__main__":
    sys.exit(main())
