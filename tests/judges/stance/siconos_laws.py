"""Coulomb's law at several feet, solved by Siconos. Runs in the Python that Debian's python3-siconos is for.

A line of JSON in: `w` [mm/N], `q` [mm], `friction`, the first guess `r` [N]. A line out: `r` [N], where u = w r + q is
each foot's (gap, slip, slip) and r its (pressing, sideways, sideways). With `repeats` [1] in it the line out is instead
the least time of so many solutions [s], null where none is found.
"""

import json
import sys
import time

import numpy as np
import siconos.numerics as sn  # type: ignore[import-not-found]

TOLERANCE = 1e-13  # relative to q; the judge works out the law's residual by itself


def solve(w: np.ndarray, q: np.ndarray, friction: np.ndarray, guess: np.ndarray) -> np.ndarray:
    problem = sn.FrictionContactProblem(3, w, q, friction)
    r, u = guess.copy(), w @ guess + q
    options = sn.SolverOptions(sn.SICONOS_FRICTION_3D_NSN_AC)
    options.iparam[0], options.dparam[0] = 100, TOLERANCE
    if sn.fc3d_nonsmooth_Newton_AlartCurnier(problem, r, u, options) == 0:
        return r
    options = sn.SolverOptions(sn.SICONOS_FRICTION_3D_NSGS)
    options.iparam[0], options.dparam[0] = 20000, TOLERANCE
    r, u = guess.copy(), w @ guess + q
    sn.fc3d_nsgs(problem, r, u, options)
    return r


def seconds(w: np.ndarray, q: np.ndarray, friction: np.ndarray, guess: np.ndarray, repeats: int) -> float | None:
    """Of the quicker of Siconos' two methods, to 1e-6 of q."""
    problem, best = sn.FrictionContactProblem(3, w, q, friction), float("inf")
    methods = ((sn.SICONOS_FRICTION_3D_NSN_AC, 100, sn.fc3d_nonsmooth_Newton_AlartCurnier),
               (sn.SICONOS_FRICTION_3D_NSGS, 1000, sn.fc3d_nsgs))  # fmt: skip
    for number, most, method in methods:
        options = sn.SolverOptions(number)
        options.iparam[0], options.dparam[0] = most, 1e-6
        for _ in range(repeats):
            r, u = guess.copy(), w @ guess + q
            start = time.perf_counter()
            status = method(problem, r, u, options)
            best = min(best, time.perf_counter() - start) if status == 0 else best
    return best if np.isfinite(best) else None


print("ready", flush=True)
for line in sys.stdin:
    ask = {key: np.array(value, dtype=float) for key, value in json.loads(line).items()}
    if "repeats" in ask:
        print(json.dumps(seconds(ask["w"], ask["q"], ask["friction"], ask["r"], int(ask["repeats"][0]))), flush=True)
        continue
    print(json.dumps(solve(ask["w"], ask["q"], ask["friction"], ask["r"]).tolist()), flush=True)
