"""Limbs pressed inward, from the tip towards the base: whether the core finds the rest that the reference finds, how
far its K is off there, and what it flags."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from brace.native.loader import library
from cases import MOST_OF_REACH, Case, moved_of_reach, off, pressed_cases
from test_core_in_space_under_load import CoreLimb
from test_core_under_load import core_limb

NEAR = 0.3  # of the reach: rests that count as near at hand
WORST = {"float": 6e-3, "fixed": 6e-3, "space": 1e-2}  # of K, unflagged, within the promise
REFUSED_MOST = 2e-3  # near at hand, in integers; 0 in float
FLAGGED_MOST = 0.01  # share of the limbs within the promise


class Judged(NamedTuple):
    """One limb: how far its tip moves of its reach; K's error, NaN where refused; whether K is flagged."""

    moved: float
    error: float
    is_flagged: bool


def in_plane(case: Case, path: str) -> tuple[np.ndarray, int] | None:
    """K and its flags, as a batch of the tools has them; None: refused."""
    native = library()
    ffi, lib = native.ffi, native.lib
    loaded, load, limb = core_limb(case)
    result = ffi.new("brace_loaded_stiffness_t *")
    columns = [ffi.new("float[1]", [value]) for value in (*case.theta_rad[1:], *case.force_n)]
    if path == "fixed":
        fixed = ffi.new("brace_loaded_fixed_t *")
        lib.brace_loaded_fixed_collapse(loaded, fixed)
        refused = lib.brace_loaded_fixed_batch(fixed, limb.femur_mm + limb.tibia_mm, load, 1, *columns, result)
    else:
        refused = lib.brace_loaded_batch(loaded, load, 1, *columns, result)
    k = result.stiffness
    k_n_per_mm = np.array([[k.k_xx_n_per_mm, k.k_xz_n_per_mm], [k.k_xz_n_per_mm, k.k_zz_n_per_mm]])
    return None if refused else (k_n_per_mm, k.flags)


def in_space(case: Case) -> tuple[np.ndarray, int] | None:
    """The same in space."""
    core = CoreLimb(case, goes_on=True)
    if not core.is_answered:
        return None
    reach_mm = case.keys["geometry.femur_mm"] + case.keys["geometry.tibia_mm"]
    flags = library().lib.brace_loaded_space_flags(core.result, core.buckling_factor, reach_mm)
    return core.k_n_per_mm, flags


@pytest.mark.parametrize("path", ["float", "fixed", "space"])
def test_pressed_inward(limbs: int, seed: int, path: str) -> None:
    """What brace/loaded.h, loaded_fixed.h and loaded_space.h promise."""
    softened = library().lib.BRACE_FLAG_SOFTENED
    judged = []
    for case, found in pressed_cases(seed + 1, 10 * limbs, in_space=path == "space"):
        answer = in_space(case) if path == "space" else in_plane(case, path)
        off_by = np.nan if answer is None else off(answer[0], found.k_n_per_mm[0])
        is_flagged = answer is not None and (answer[1] & ~softened) != 0
        judged.append(Judged(moved_of_reach(case, found), off_by, is_flagged))
    moved, error = (np.array([getattr(one, name) for one in judged]) for name in ("moved", "error"))
    flagged = np.array([one.is_flagged for one in judged])
    refused, near, promised = np.isnan(error), moved <= NEAR, moved <= MOST_OF_REACH
    unflagged = error[promised & ~refused & ~flagged]
    print(
        f"{path}, {len(judged)} limbs pressed inward: refused {np.sum(refused & near)} of {np.sum(near)} whose tip "
        f"moves by at most {NEAR:g} of the reach, {np.sum(refused & ~near)} of {np.sum(~near)} others; in the promise "
        f"({np.sum(promised)}): K worst {unflagged.max():.1e}, beyond 1 % {np.sum(unflagged > 0.01)}, flagged "
        f"{np.sum(flagged & promised)}; beyond it and reported without a flag {np.sum(~promised & ~refused & ~flagged)}"
    )
    assert np.sum(refused & near) <= (2 + REFUSED_MOST * len(judged) if path == "fixed" else 0)
    assert unflagged.max() <= WORST[path]
    few = 2.0 * np.sqrt(FLAGGED_MOST * np.sum(promised))  # of a few limbs some more may be among them by chance
    assert np.sum(flagged & promised) <= FLAGGED_MOST * np.sum(promised) + few
