"""What a stiffness table can say about which kind of limb it came from: several families, fitted alike."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from brace.ground.errors import BadFileError
from brace.identify.fit import Fit, fit
from brace.identify.parameters import (
    COMPLIANCES,
    JOINT_COMPLIANCES,
    LINK_COMPLIANCES,
    TIP_HEIGHT,
    ParameterSet,
    free_parameter,
)
from brace.identify.table import TableProblem
from brace.model import LimbModel

STARTS = 8
_TILTS = ("link.femur.tilt_rad", "link.tibia.tilt_rad")


@dataclass(frozen=True)
class Family:
    """A kind of limb: which parameters are free; the other compliances are zero."""

    name: str
    keys: tuple[str, ...]
    moment_transfer: float = 0.0


FAMILIES = (
    Family("ellipsoids only (the paper's model)", LINK_COMPLIANCES),
    Family("two joint springs only", JOINT_COMPLIANCES),
    Family("ellipsoids and springs", COMPLIANCES),
    Family("beams with moment transfer", LINK_COMPLIANCES, 1.0),
    Family("beams with moment transfer, and springs", COMPLIANCES, 1.0),
    Family("tilted ellipsoids", LINK_COMPLIANCES + _TILTS),
)


@dataclass(frozen=True)
class FamilyFit:
    """One family's best fit."""

    family: Family
    fit: Fit

    @property
    def chi2_per_entry(self) -> float:
        return self.fit.chi2 / self.fit.readings

    @property
    def tip_height_mm(self) -> float | None:
        return self.fit.nuisances.get(TIP_HEIGHT)


def fit_family(problem: TableProblem, base: LimbModel, family: Family) -> FamilyFit:
    """The family's best fit from many starts (always the same ones)."""
    zeroed = base.with_values(
        {
            **dict.fromkeys((*COMPLIANCES, *_TILTS), 0.0),
            "link.femur.moment_transfer": family.moment_transfer,
            **{key: free_parameter(base, key).scale for key in family.keys if key not in _TILTS},
        }
    )
    parameters = [free_parameter(zeroed, key) for key in family.keys]
    if problem.poses.needs_height:
        parameters.append(problem.height_parameter())
    chosen = ParameterSet(zeroed, tuple(parameters))
    return FamilyFit(family, fit(problem, chosen, scattered_starts(chosen)))


def compare_families(
    problem: TableProblem, base: LimbModel, advance: Callable[[int], None] = lambda _done: None
) -> list[FamilyFit]:
    """All families, in the order of FAMILIES; one that cannot be at these postures (springs alone at a straight
    limb) is left out."""
    results = []
    for number, family in enumerate(FAMILIES):
        with contextlib.suppress(BadFileError):
            results.append(fit_family(problem, base, family))
        advance(number + 1)
    return results


def scattered_starts(parameters: ParameterSet, count: int = STARTS) -> list[np.ndarray]:
    """Starts spread over two decades of each compliance and over the heights; the same in every call."""
    random = np.random.default_rng(20240607)
    starts = []
    low, high = parameters.array("low"), parameters.array("high")
    for _ in range(count):
        point = parameters.array("start")
        for index, parameter in enumerate(parameters.parameters):
            if parameter.key == TIP_HEIGHT:
                point[index] = random.uniform(0.9 * low[index], 0.3 * high[index])
            elif parameter.low == 0.0:
                point[index] = parameter.scale * 10.0 ** random.uniform(-1.0, 1.3)
            else:
                point[index] = parameter.start + 2 * parameter.scale * random.standard_normal()
        starts.append(np.clip(point, low, high))
    return starts
