"""How large a record is: what a row of the catalogue may know of it, to set limits and first tries."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from brace.model.keys import KEY_BY_NAME


@dataclass(frozen=True)
class LoadingSize:
    """A loading record: the believed limb's numbers by key, and the sizes that the record reaches."""

    believed: Mapping[str, float]
    joint_torque_n_mm: Mapping[str, float]  # largest over the record, by joint ("femur", "tibia")
    joint_deflection_rad: Mapping[str, float]  # elastic, at that torque
    displacement_mm: float  # largest imposed
    force_n: np.ndarray  # |reading| of both axes, sorted
    force_sigma_n: float
    run_starts_s: Sequence[float]
    duration_s: float
    dwell_s: float
    temperature_range_degc: float
    zeroed: bool
    turns: bool  # played on a limb that turns as it is displaced


@dataclass(frozen=True)
class LoadingPlace:
    """A loading record, seen from one number at one place of the limb (`joint.tibia`)."""

    size: LoadingSize
    where: str
    key: str

    @property
    def believed(self) -> float:
        """What limb.toml says of the number."""
        return self.size.believed[self.key]

    @property
    def range(self) -> tuple[float, float]:
        """What limb.toml allows for the number, by the controller's dictionary."""
        entry = KEY_BY_NAME[self.key]
        return entry.low, entry.high

    @property
    def part(self) -> str:
        """`tibia` of joint.tibia."""
        return self.where.rpartition(".")[2]

    @property
    def torque_n_mm(self) -> float:
        """The joint's largest torque, never nothing."""
        return max(self.size.joint_torque_n_mm[self.part], 1.0)

    @property
    def deflection_rad(self) -> float:
        """The joint's elastic deflection under that torque, never nothing."""
        return max(self.size.joint_deflection_rad[self.part], 1e-6)

    @property
    def dwell_s(self) -> float:
        """The time between readings, never nothing."""
        return max(self.size.dwell_s, 1e-3)


@dataclass(frozen=True)
class JointTestSize:
    """A joint test: ranges of angle [rad] and torque [N mm], length [s], range of temperature [degC], speed, and the
    least swing [rad] that reached both flanks of a gap (inf: none is known)."""

    angle_rad: float
    torque_n_mm: float
    length_s: float
    temp_degc: float
    speed_rad_per_s: float
    swing_rad: float

    @property
    def stiffness_n_mm_per_rad(self) -> float:
        """Of a straight line through the record."""
        return self.torque_n_mm / self.angle_rad


@dataclass(frozen=True)
class JointTestBench:
    """A joint test with what else decides which effects it can show. `given`: a model was given, so its spring can be
    wrong. `rests`: the record dwells or changes its speed; at one steady speed creep makes a loop as friction does."""

    size: JointTestSize
    given: bool
    rests: bool
