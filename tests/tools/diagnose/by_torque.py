"""Joint tests written from the physics, nothing of the tool's plant is used: a torque is imposed, the angle follows."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import joint_cases
from brace.dataset import load_dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.options import Options
from brace.diagnose.run import diagnose

LEG = 260  # readings of a test


def triangle(count: int = LEG) -> np.ndarray:
    """0, 1, -1, 0."""
    return np.asarray(np.interp(np.linspace(0, 4, count), [0, 1, 3, 4], [0, 1, -1, 0]))


def found_in(folder: Path, tests: list[tuple[np.ndarray, np.ndarray]]) -> Diagnosis:
    """The diagnosis of these pairs of angle [rad] and torque [N mm]."""
    return diagnose(load_dataset(recorded(folder, tests)), None, Options())


def recorded(folder: Path, tests: list[tuple[np.ndarray, np.ndarray]]) -> Path:
    """These pairs as a dataset."""
    angle, torque = (np.concatenate([pair[place] for pair in tests]) for place in (0, 1))
    number = np.repeat(np.arange(len(tests)), [pair[0].size for pair in tests])
    columns = {"t_s": 0.02 * np.arange(angle.size), "angle_rad": angle, "torque_n_mm": torque, "test": number}
    return joint_cases.Case("", {}, columns).write(folder)


def under_torque(torque: np.ndarray, gap_rad: float, friction_n_mm: float, compliance: float) -> np.ndarray:
    """Angles of a joint with play and dry friction whose torque is imposed: it stays until friction lets it slip."""

    def carried(spring: float) -> float:
        return float(compliance * spring + 0.5 * gap_rad * np.sign(spring))

    angle, angles = 0.0, []
    for one in torque:
        angle = float(np.clip(angle, carried(one - friction_n_mm), carried(one + friction_n_mm)))
        angles.append(angle)
    return np.array(angles)
