"""How much of the tip's compliance is the links' and how much the joints', and how well that is known."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from brace.identify.fit import Fit, Problem, fit
from brace.identify.information import Z90
from brace.identify.parameters import COMPLIANCES, NUISANCES, ParameterSet, free_parameter
from brace.model import LimbModel
from brace.native.plant import reference_planar

TARGETS = np.linspace(0.0, 1.0, 11)


@dataclass(frozen=True)
class Split:
    """Share of the structure (links, base) in the trace of C, mean over the configurations. `allowed` is the 90 %
    interval by the data alone, every compliance free; `profile` is (share, chi2) along it."""

    structure_share: float
    allowed: tuple[float, float]
    profile: tuple[tuple[float, float], ...]


def structure_share(model: LimbModel, angles_rad: np.ndarray) -> float:
    """1 - (trace of the joints' part of C) / (trace of C), mean over configurations x (theta1, theta2)."""
    theta1, theta2 = angles_rad[:, 0], angles_rad[:, 1]
    whole = reference_planar(model, theta1, theta2)
    femur, tibia = model.number("geometry.femur_mm"), model.number("geometry.tibia_mm")
    r_squared = femur**2 + tibia**2 + 2 * femur * tibia * np.cos(theta2)
    joints = model.number("joint.femur.compliance_rad_per_n_mm") * r_squared \
        + model.number("joint.tibia.compliance_rad_per_n_mm") * tibia**2
    return float(np.mean(1.0 - joints / (whole[:, 3] + whole[:, 5])))


def split(problem: Problem, best: Fit, advance: Callable[[int], None] = lambda _done: None) -> Split:
    """The share at the fit, and the range that the data allow when no prior holds any compliance."""
    base = best.model
    kept = tuple(parameter for parameter in best.parameters.parameters if parameter.key not in COMPLIANCES
                 and (parameter.key in NUISANCES or math.isfinite(parameter.prior_sigma)))
    loose = ParameterSet(base, tuple(free_parameter(base, key) for key in COMPLIANCES) + kept)
    shares: list[tuple[float, float]] = []
    for number, target in enumerate(TARGETS):
        def off(model: LimbModel, nuisances: dict[str, float], target: float = target) -> float:
            return structure_share(model, problem.angles(model, nuisances)) - target
        found = fit(problem, loose, starts=[_towards(loose, target)], constraint=off)
        reached = structure_share(found.model, problem.angles(found.model, found.nuisances))
        shares.append((reached, found.chi2))
        advance(number + 1)
    dof = max(1, best.readings - len(COMPLIANCES))
    smallest = min(chi2 for _, chi2 in shares)
    limit = smallest + Z90**2 * max(1.0, smallest / dof)
    share = structure_share(base, problem.angles(base, best.nuisances))
    return Split(share, _crossings(sorted(shares), limit), tuple(sorted(shares)))


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


def _crossings(profile: list[tuple[float, float]], limit: float) -> tuple[float, float]:
    """Where the profile's chi2 crosses the limit on either side of its least; the ends where it does not."""
    share, chi2 = (np.array(values) for values in zip(*profile))
    inside = np.flatnonzero(chi2 <= limit)
    first, last = int(inside[0]), int(inside[-1])

    def crossing(outer: int, inner: int) -> float:
        part = (limit - chi2[inner]) / (chi2[outer] - chi2[inner])
        return float(share[inner] + part * (share[outer] - share[inner]))

    low = crossing(first - 1, first) if first > 0 else float(share[first])
    high = crossing(last + 1, last) if last < len(share) - 1 else float(share[last])
    return low, high
