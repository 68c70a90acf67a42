"""The numbers that tip data do determine: C = a11 p1 p1' + a12 (p1 p2' + p2 p1') + a22 p2 p2' + the links' axial
parts, with p1, p2 the levers of the joints. Springs, bending, base rotation and moment transfer enter only here.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from brace.identify.fit import STEP, Fit
from brace.identify.information import Estimate, Information
from brace.model import LimbModel


def a11(model: LimbModel) -> float:
    """[rad/(N mm)] all that turns about the femur joint."""
    return (
        model.number("joint.femur.compliance_rad_per_n_mm")
        + model.number("base.rotation_rad_per_n_mm")
        + _per_square(model, "femur")
    )


def a22(model: LimbModel) -> float:
    """[rad/(N mm)] all that turns about the knee."""
    return (
        model.number("joint.tibia.compliance_rad_per_n_mm")
        + _per_square(model, "femur")
        + _per_square(model, "tibia")
    )


def a12(model: LimbModel) -> float:
    """[rad/(N mm)] the coupling; negative for ellipsoids and springs, positive for beams that transfer moments."""
    return _per_square(model, "femur") * (1.5 * model.number("link.femur.moment_transfer") - 1.0)


COMBINATIONS: dict[str, Callable[[LimbModel], float]] = {
    "a11_rad_per_n_mm": a11,
    "a12_rad_per_n_mm": a12,
    "a22_rad_per_n_mm": a22,
}
MEANING = {
    "a11_rad_per_n_mm": "femur spring + base rotation + femur bending/L1^2",
    "a12_rad_per_n_mm": "femur bending/L1^2 x (1.5 moment transfer - 1)",
    "a22_rad_per_n_mm": "knee spring + femur bending/L1^2 + tibia bending/L2^2",
}


def combination_estimates(information: Information) -> dict[str, Estimate]:
    """Each combination with its interval."""
    return {
        name: information.of_function(gradient(information.fit, function), function(information.fit.model))
        for name, function in COMBINATIONS.items()
    }


def gradient(fit: Fit, function: Callable[[LimbModel], float]) -> np.ndarray:
    """Of a function of the limb, by x / scale; central differences."""
    scale, low, high = (fit.parameters.array(name) for name in ("scale", "low", "high"))
    result = np.empty(len(fit.x))
    for index in range(len(fit.x)):
        up, down = fit.x.copy(), fit.x.copy()
        up[index] = min(up[index] + STEP * scale[index], high[index])
        down[index] = max(down[index] - STEP * scale[index], low[index])
        result[index] = (
            (function(fit.parameters.model(up)) - function(fit.parameters.model(down)))
            / (up[index] - down[index])
            * scale[index]
        )
    return result


def _per_square(model: LimbModel, link: str) -> float:
    return model.number(f"link.{link}.bending_mm_per_n") / model.number(f"geometry.{link}_mm") ** 2
