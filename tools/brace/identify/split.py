"""How much of the tip's compliance is the links' and how much the joints', and how well that is known."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from brace.ground.errors import BadFileError
from brace.identify.fit import Fit, Nuisances, Problem, columns_of, fit
from brace.identify.information import Z90
from brace.identify.parameters import COMPLIANCES, JOINT_COMPLIANCES, NUISANCES, ParameterSet, free_parameter
from brace.model import LimbModel
from brace.native.plant_batch import model_numbers, number_index, reference_planar_many

TARGETS = (0.0, 0.25, 0.5, 0.75, 1.0)
REFINEMENTS = 6
FLAT = 0.3
_SHARE_KEYS = ("geometry.femur_mm", "geometry.tibia_mm", *JOINT_COMPLIANCES)


@dataclass(frozen=True)
class Split:
    """Share of the structure (links, base) in the trace of C, mean over the configurations. `allowed` is the 90 %
    interval by the data alone, every compliance free; `profile` is (share, chi2) along it."""

    structure_share: float
    allowed: tuple[float, float]
    profile: tuple[tuple[float, float], ...]


def structure_shares(models: np.ndarray, angles_rad: np.ndarray) -> np.ndarray:
    """1 - (trace of the joints' part of C) / (trace of C), mean over the configurations, of many models, each at its
    own angles (models x configurations x 2). Refuses a model that does not yield."""
    whole = reference_planar_many(models, angles_rad)
    if np.isnan(whole).any():
        raise BadFileError(
            "the share of the structure cannot be found",
            why="nothing yields in some direction",
            next_step="give link or joint compliances",
        )
    index = number_index()
    femur, tibia, femur_joint, tibia_joint = models[:, [index[key] for key in _SHARE_KEYS]].T[:, :, np.newaxis]
    r_squared = femur**2 + tibia**2 + 2 * femur * tibia * np.cos(angles_rad[:, :, 1])
    joints = femur_joint * r_squared + tibia_joint * tibia**2
    return np.asarray(np.mean(1.0 - joints / (whole[:, :, 3] + whole[:, :, 5]), axis=1))


def split(problem: Problem, best: Fit, advance: Callable[[int], None] = lambda _done: None) -> Split:
    """The share at the fit, and the range that the data allow when no prior holds any compliance."""
    base = best.model
    kept = tuple(
        parameter
        for parameter in best.parameters.parameters
        if parameter.key not in COMPLIANCES
        and (parameter.key in NUISANCES or math.isfinite(parameter.prior_sigma))
    )
    loose = ParameterSet(base, tuple(free_parameter(base, key) for key in COMPLIANCES) + kept)

    def held_at(target: float | None) -> tuple[float, float]:
        """(share reached, chi2) of the best fit held near a share; one point of the profile wherever it ends up."""

        def off(models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
            return structure_shares(models, problem.angles(models, nuisances)) - (target or 0.0)

        found = fit(
            problem,
            loose,
            starts=() if target is None else [_towards(loose, target)],
            constraint=None if target is None else off,
        )
        return _share_of(problem, found.model, found.nuisances), found.chi2

    profile = [held_at(None)]
    for number, target in enumerate(TARGETS):
        with contextlib.suppress(BadFileError):  # no limb has that share at these postures
            profile.append(held_at(target))
        advance(number + 1)
    dof = max(1, best.readings - len(COMPLIANCES))
    for round_number in range(REFINEMENTS):
        for side in (-1, 1):
            edge, closed = _edge(profile, side, dof)
            if not closed:
                with contextlib.suppress(BadFileError):
                    profile.append(held_at(edge))
        advance(len(TARGETS) + round_number + 1)
    share = _share_of(problem, base, best.nuisances)
    allowed = (_edge(profile, -1, dof)[0], _edge(profile, 1, dof)[0])
    return Split(share, allowed, tuple(sorted(profile)))


def _share_of(problem: Problem, model: LimbModel, nuisances: dict[str, float]) -> float:
    models = model_numbers(model)[np.newaxis]
    return float(structure_shares(models, problem.angles(models, columns_of(nuisances)))[0])


def _towards(parameters: ParameterSet, share: float) -> np.ndarray:
    """A start in which links and joints divide their present sum in this ratio."""
    start = parameters.array("start")
    scale = parameters.array("scale")
    for index, key in enumerate(parameters.keys):
        if key.startswith("joint."):
            start[index] = max(start[index], scale[index]) * 2 * (1.0 - share)
        elif key.startswith("link."):
            start[index] = max(start[index], scale[index]) * 2 * share
    return start


def _edge(profile: list[tuple[float, float]], side: int, dof: int) -> tuple[float, bool]:
    """Where the profile leaves the 90 % interval on one side (-1 down, 1 up): the share, and whether it is the end
    of what can be reached. Between points the root of chi2's rise is taken as straight, as it is for a parabola.
    """
    least = min(chi2 for _, chi2 in profile)
    limit = Z90 * math.sqrt(max(1.0, least / dof))
    rise = sorted((side * share, math.sqrt(max(0.0, chi2 - least))) for share, chi2 in profile)
    inside = max(place for place, (_, height) in enumerate(rise) if height <= limit)
    if inside == len(rise) - 1:
        return side * rise[-1][0], True
    (near, low), (far, high) = rise[inside], rise[inside + 1]
    if low < FLAT * limit < limit < high / FLAT:  # flat up to a wall, where a compliance meets zero: halve
        return side * 0.5 * (near + far), False
    return side * (near + (limit - low) / (high - low) * (far - near)), False
