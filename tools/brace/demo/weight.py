"""A weight hung on the tip: the K that the controller reports, the limb's own, and the one without load."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from brace.model import LimbModel
from brace.native import loaded
from brace.sim.node import LimbSetup, Node

POSTURE_RAD = (0.3, 0.6)
WEIGHTS_N = (0.0, 5.0, 10.0, 20.0)
STRING_N_PER_MM = 0.02  # a weight hangs on so soft a spring that its force hardly follows the tip
SETTLED_S = 3.0


@dataclass(frozen=True)
class Hung:
    """K [N/mm] is k_xx, k_xz, k_zz. `sag_mm`: how far the weight moves the tip; `reported` is the controller's."""

    weight_n: float
    carried_n: float  # what of it the string, which has slackened as the limb gave way, still puts on the tip
    reported: np.ndarray
    truth: np.ndarray
    unloaded: np.ndarray
    reported_sag_mm: float
    sag_mm: float

    def off(self, k: np.ndarray) -> float:
        """How far a K is from the limb's own: Frobenius norm of the difference over the limb's own."""
        parts = np.array([1.0, 2.0, 1.0])
        return float(np.sqrt(np.sum(parts * (k - self.truth) ** 2) / np.sum(parts * self.truth**2)))


def hang(model: LimbModel, weight_n: float) -> Hung:
    """The limb holds its posture with a weight on its tip. Its own K is the reference's, at the angles at which its
    motors stand and under the force that its contact has."""
    setup = LimbSetup(
        model,
        model,
        theta_rad=(0.0, *POSTURE_RAD),
        hold_n_per_mm=STRING_N_PER_MM,
        press_mm=(0.0, -weight_n / STRING_N_PER_MM),
        force_noise_n=0.0,
    )
    with Node([setup]) as node:
        node.step(SETTLED_S)
        reported, truth = node.raw_snapshot(), node.raw_truth()
    force_n = np.array([truth.force_x_n, truth.force_z_n])
    own = loaded.under_force(model, truth.motor_rad[1], truth.motor_rad[2], force_n)
    k = own.k_n_per_mm[0]
    return Hung(
        weight_n,
        float(np.linalg.norm(force_n)),
        _entries(reported.stiffness.engaged),
        np.array([k[0, 0], k[0, 1], k[1, 1]]),
        _entries(reported.load.unloaded),
        float(np.hypot(reported.load.moved_x_mm, reported.load.moved_z_mm)),
        float(np.linalg.norm(own.displacement_mm[0])),
    )


def _entries(k: object) -> np.ndarray:
    return np.array([getattr(k, f"k_{entry}_n_per_mm") for entry in ("xx", "xz", "zz")], float)
