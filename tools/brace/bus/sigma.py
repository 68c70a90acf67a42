"""How sure a controller is of its K: one sigma of each value."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from brace.wire.layout import Value

SIGMA_ENTRIES = ("k_xx", "k_xz", "k_zz", "lambda_min", "lambda_max", "stiff_axis")
SPACE_ENTRIES = (
    *(f"space_k_{name}" for name in ("xx", "xy", "xz", "yy", "yz", "zz")),
    *(f"space_lambda_{number}" for number in (1, 2, 3)), "k_across",
)  # fmt: skip


@dataclass(frozen=True)
class Sigma:
    """One sigma of K in the limb's plane, and of a limb with a coxa joint of K in space; None: not known."""

    values: Mapping[str, Value]  # by SIGMA_ENTRIES: N/mm, stiff_axis in rad
    space: Mapping[str, Value] | None = None  # by SPACE_ENTRIES: N/mm; None: it has not come (yet)

    @property
    def k(self) -> tuple[Value, Value, Value]:
        """Of the entries of K: xx, xz, zz [N/mm]."""
        return (self.values["k_xx"], self.values["k_xz"], self.values["k_zz"])

    @property
    def is_known(self) -> bool:
        """The entries of K have one."""
        return None not in self.k

    def words(self, is_open: bool = False) -> str:
        """One sigma of the entries of K, in a line.
        is_open: a gap takes stiffness away from this K, and the uncertainty is that of K once it has closed"""
        if not self.is_known:
            return "one sigma of K not known"
        closed = " with every gap closed" if is_open else ""
        return "one sigma of K{} {:.4f} {:.4f} {:.4f} N/mm".format(closed, *self.k)

    def line(self, k: tuple[Value, Value, Value], is_open: bool = False) -> str:
        """K with it, for people.
        k: in the order xx, xz, zz"""
        if None in k or is_open or not self.is_known:
            return self.words(is_open)
        reported = zip(SIGMA_ENTRIES, k, self.k, strict=False)
        return ", ".join(f"{name} {value:.4f} +- {sigma:.4f}" for name, value, sigma in reported) + " N/mm (one sigma)"

    def as_json(self) -> dict[str, object]:
        """Names with units."""
        units = ("n_per_mm",) * 5 + ("rad",)
        reported: dict[str, object] = {
            f"sigma_{name}_{unit}": self.values[name] for name, unit in zip(SIGMA_ENTRIES, units, strict=True)
        }
        return reported | {f"sigma_{name}_n_per_mm": value for name, value in (self.space or {}).items()}


def sigma_of(values: Mapping[str, Value], prefix: str = "") -> Sigma:
    """From the fields of frames, or from measured values, whose names begin with a prefix. That of K in space is there
    where one of its values is known."""
    plane, space = (
        {name: _known(values.get(prefix + name)) for name in names} for names in (SIGMA_ENTRIES, SPACE_ENTRIES)
    )
    return Sigma(plane, space if any(value is not None for value in space.values()) else None)


def _known(value: Value) -> Value:
    return None if isinstance(value, float) and math.isnan(value) else value
