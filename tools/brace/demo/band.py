"""How far the identified limb's curves are known: limbs drawn from the fit's covariance, evaluated by the firmware."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from brace.demo.postures import curve
from brace.ground.errors import BraceError
from brace.identify.information import Information
from brace.identify.parameters import TIP_HEIGHT
from brace.stiffness.at_rest import PostureError

DRAWS = 150
SEED = 4


@dataclass(frozen=True)
class Band:
    """5th and 95th percentile of both eigenvalues of K [N/mm] at each r [mm]: rows x (low, high)."""

    r_mm: np.ndarray
    largest: np.ndarray
    smallest: np.ndarray


def band(known: Information, r_mm: np.ndarray) -> Band:
    """The band of the fit at distances r. Directions about which the table says nothing leave K as it is and stay
    out; compliances below zero are set to zero; a drawn limb that cannot reach or has no K is drawn again."""
    fit = known.fit
    scale, low, high = (fit.parameters.array(name) for name in ("scale", "low", "high"))
    values, vectors = np.linalg.eigh(known.covariance * fit.inflation)
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    random = np.random.default_rng(SEED)
    largest, smallest = [], []
    for _ in range(4 * DRAWS):
        x = np.clip(fit.x + scale * (root @ random.standard_normal(len(fit.x))), low, high)
        height_mm = fit.parameters.nuisances(x)[TIP_HEIGHT]
        if abs(height_mm) >= r_mm.min():
            continue
        try:
            drawn = curve(fit.parameters.model(x), height_mm, r_mm)
        except (BraceError, PostureError):
            continue
        largest.append(drawn.largest)
        smallest.append(drawn.smallest)
        if len(largest) == DRAWS:
            break
    return Band(r_mm, np.percentile(largest, (5, 95), axis=0).T, np.percentile(smallest, (5, 95), axis=0).T)
