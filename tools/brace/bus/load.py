"""The load that a controller's K counts, what it does to the limb, and K without it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from brace.wire.layout import Value

LOAD_ENTRIES = (
    "unloaded_k_xx", "unloaded_k_xz", "unloaded_k_zz", "counted_force_x", "counted_force_z", "moved_x", "moved_z",
    "buckling_factor", "gravity_direction", "gravity_lean",
)  # fmt: skip


@dataclass(frozen=True)
class Load:
    """None: not known, or no load is counted."""

    values: Mapping[str, Value]  # by LOAD_ENTRIES; buckling_factor: infinite where there is none

    @property
    def is_counted(self) -> bool:
        """K is the one under this load."""
        return self.values["counted_force_x"] is not None

    def as_json(self) -> dict[str, object]:
        """Names with units. An infinite buckling factor is null beside `is_counted`."""
        v = self.values
        factor = v["buckling_factor"]
        return {
            "is_counted": self.is_counted,
            "force_x_n": v["counted_force_x"],
            "force_z_n": v["counted_force_z"],
            "moved_x_mm": v["moved_x"],
            "moved_z_mm": v["moved_z"],
            "buckling_factor": None if factor is None or math.isinf(factor) else factor,
            "gravity_direction_rad": v["gravity_direction"],
            "gravity_lean_rad": v["gravity_lean"],
            "unloaded_k_xx_n_per_mm": v["unloaded_k_xx"],
            "unloaded_k_xz_n_per_mm": v["unloaded_k_xz"],
            "unloaded_k_zz_n_per_mm": v["unloaded_k_zz"],
        }

    def lines(self) -> list[str]:
        """For people."""
        if not self.is_counted:
            return ["no load is counted"]
        v = {name: math.nan if value is None else value for name, value in self.values.items()}
        told = "none" if math.isinf(v["buckling_factor"]) else f"{v['buckling_factor']:.2f}"
        without = [v[name] for name in LOAD_ENTRIES[:3]]
        return [
            f"load {v['counted_force_x']:.3f} {v['counted_force_z']:.3f} N and the weight: the tip moved "
            f"{v['moved_x']:.3f} {v['moved_z']:.3f} mm, buckling factor {told}",
            "without load K = [{0:.4f} {1:.4f}; {1:.4f} {2:.4f}] N/mm".format(*without),
        ]
