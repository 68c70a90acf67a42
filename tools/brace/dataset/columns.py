"""The columns of each kind of dataset: name, unit, range that an entry can have at all."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Column:
    """A column of data.csv; entries lie in [-limit, limit], and in [0, limit] when `positive`. `beyond` says what an
    entry outside may be. Of columns with the same `one_of`, every row has an entry in one at least."""

    name: str
    unit: str
    meaning: str
    required: bool = True
    kind: str = "float"  # float, int, axis
    limit: float = 1e9
    positive: bool = False
    beyond: str = ""
    one_of: str = ""


def _optional(name: str, unit: str, meaning: str, kind: str = "float", **more: float) -> Column:
    return Column(name, unit, meaning, required=False, kind=kind, limit=more.get("limit", 1e9))


TIME = Column(
    "t_s", "s", "time from any origin", limit=1e11, beyond=": of milliseconds since 1970, divide all by 1000"
)

LOADING = (
    Column("run", "", "number of the pass", kind="int"),
    Column("config", "", "number of the pose", kind="int"),
    Column("theta1_rad", "rad", "commanded femur angle", limit=1e4),
    Column("theta2_rad", "rad", "commanded knee angle", limit=1e4),
    Column("axis", "", "x or z, the axis of the imposed displacement", kind="axis"),
    Column("rep", "", "repeat of the same pass", kind="int"),
    Column("step", "", "step within the pass", kind="int"),
    TIME,
    _optional("temp_degc", "degC", "temperature", limit=1e4),
    Column("dx_mm", "mm", "imposed displacement of the tip", limit=1e6),
    Column("dz_mm", "mm", "imposed displacement of the tip", limit=1e6),
    Column("fx_n", "N", "force on the limb", required=False, one_of="force"),
    Column("fz_n", "N", "force on the limb", required=False, one_of="force"),
    _optional("enc1_rad", "rad", "output-side deflection of joint 1"),
    _optional("enc2_rad", "rad", "output-side deflection of joint 2"),
    _optional("base_x_mm", "mm", "dial gauge on the base"),
    _optional("base_z_mm", "mm", "dial gauge on the base"),
    _optional("preload_x_n", "N", "force on the limb at the run's first reading, from which displacements count"),
    _optional("preload_z_n", "N", "force on the limb at the run's first reading, from which displacements count"),
)

STIFFNESS_TABLE = (
    _optional("row", "", "number of the row", kind="int"),
    Column("r_mm", "mm", "distance of the tip from the femur axis", limit=1e6, positive=True),
    Column("k_xx", "N/mm", "stiffness"),
    Column("k_xz", "N/mm", "stiffness"),
    Column("k_zx", "N/mm", "stiffness"),
    Column("k_zz", "N/mm", "stiffness"),
    _optional("lambda_min", "N/mm", "smaller eigenvalue"),
    _optional("lambda_max", "N/mm", "larger eigenvalue"),
    _optional("theta1_rad", "rad", "commanded femur angle", limit=1e4),
    _optional("theta2_rad", "rad", "commanded knee angle", limit=1e4),
    _optional("z_mm", "mm", "height of the tip", limit=1e6),
)

JOINT_TEST = (
    TIME,
    Column("angle_rad", "rad", "deflection of the joint", limit=1e4),
    Column("torque_n_mm", "N mm", "torque in the joint", limit=1e12),
    _optional("command_n_mm", "N mm", "commanded torque", limit=1e12),
    _optional("test", "", "number of the test", kind="int"),
    _optional("temp_degc", "degC", "temperature", limit=1e4),
)

KINDS: dict[str, tuple[Column, ...]] = {
    "loading": LOADING,
    "stiffness_table": STIFFNESS_TABLE,
    "joint_test": JOINT_TEST,
}

MAX_INT = 2**31 - 1
FULL_TURN_RAD = 2 * math.pi
ANGLE_LIMIT_RAD = {"theta1_rad": FULL_TURN_RAD, "theta2_rad": math.pi}  # a femur turns round, a knee half
