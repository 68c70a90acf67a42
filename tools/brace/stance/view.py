"""What `brace stance show` says: where the feet are, each limb's K, how stiffly the body stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from brace.stance.stance_file import Stance
from brace.stance.world import believed

N_MM_PER_N_M = 1000.0


@dataclass(frozen=True)
class View:
    """Arrays have a row a limb. `give`: 6 x 6, the body's displacement [mm, rad] by force and moment [N, N mm]."""

    stance: Stance
    foot_mm: np.ndarray
    k_n_per_mm: np.ndarray
    force_n: np.ndarray
    give: np.ndarray

    def as_json(self) -> dict[str, object]:
        """Under the weight alone."""
        return {
            "limbs": [
                {
                    "name": limb.name,
                    "foot_mm": self.foot_mm[i],
                    "k_n_per_mm": self.k_n_per_mm[i],
                    "eigenvalues_n_per_mm": np.linalg.eigvalsh(self.k_n_per_mm[i]),
                    "force_n": self.force_n[i],
                }
                for i, limb in enumerate(self.stance.limbs)
            ],
            "body": {"compliance": self.give},
        }


def view(stance: Stance) -> View:
    """The stance under its weight. Raises NoStanceError where it has no equilibrium."""
    world = believed(stance)
    state = world.stand().state
    springs = [law.spring(force) for law, force in zip(world.laws, state.force_n, strict=True)]
    k = np.array([spring.k_n_per_mm for spring in springs])
    feet = np.array([law.tip_mm for law in world.laws])
    stiffness = np.zeros((6, 6))
    for one, foot, contact in zip(k, feet, state.contact, strict=True):
        if contact > 1:  # off the ground
            continue
        arm = np.array([[0.0, -foot[2], foot[1]], [foot[2], 0.0, -foot[0]], [-foot[1], foot[0], 0.0]])
        lever = np.hstack([np.eye(3), -arm])
        stiffness += lever.T @ one @ lever
    return View(stance, feet, k, state.force_n, np.linalg.inv(stiffness))
