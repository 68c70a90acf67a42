"""What can be asked of a simulation: the faults it can make, and postures from a time on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from brace.model import LimbModel

JOINTS = ("coxa", "femur", "tibia")
LIFT_MM = 20.0  # a lifted foot, out of its ground
FAULTS = {  # name as in brace_node.h: whether it is a joint's, unit of its value, value unless given
    "encoder_stuck": (True, "", 0.0),
    "sensor_dead": (True, "", 0.0),
    "sensor_nan": (True, "", 0.0),
    "current_offset": (True, "N mm", None),
    "force_dead": (False, "", 0.0),
    "force_offset": (False, "N", None),
    "nvm_fails": (False, "", 0.0),
    "nvm_forgets": (False, "", 0.0),
    "bus_off": (False, "", 0.0),
    "tick_late": (False, "ms", 5.0),
    "tip_lost": (False, "", 0.0),
    "crash": (False, "", 0.0),
    "joint_soft": (True, "shares of its stiffness", None),
}


@dataclass(frozen=True)
class Fault:
    """Something that goes wrong in some limbs at some time."""

    kind: int  # brace_node_fault_t
    limb: int | None  # from 0; None: all
    joint: int
    value: float
    at_s: float
    for_s: float  # inf: for good


@dataclass(frozen=True)
class Payload:
    """The payload's factor from a time on, reached within another."""

    factor: float
    at_s: float
    ramp_s: float


@dataclass(frozen=True)
class Move:
    """A limb's set-points moved from a time on; the limb by its name, or by its number from 1."""

    limb: str
    by_rad: tuple[float, float, float]
    at_s: float


@dataclass(frozen=True)
class Lift:
    """A limb's foot off the ground from a time on, for a while; the limb as of Move."""

    limb: str
    at_s: float
    for_s: float  # inf: for good


@dataclass(frozen=True)
class OneLimb:
    """A limb, its controller's CAN node, and where it stands: coxa, femur, tibia."""

    believed: LimbModel
    plant: LimbModel
    node: int
    theta_rad: tuple[float, float, float]


@dataclass(frozen=True)
class Posture:
    """Set-points from a time on."""

    theta1_rad: float
    theta2_rad: float
    at_s: float
