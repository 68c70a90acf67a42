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
ACROSS_ENTRIES = ("counted_force_y", "moved_y", "unloaded_k_across")  # of a limb with a coxa joint


Matrix = tuple[float, float, float]  # xx, xz, zz [N/mm]


@dataclass(frozen=True)
class Load:
    """None: not known, or no load is counted."""

    values: Mapping[str, Value]  # by LOAD_ENTRIES, and ACROSS_ENTRIES; buckling_factor: infinite where there is none

    @property
    def is_counted(self) -> bool:
        """K is the one under this load."""
        return self.values["counted_force_x"] is not None

    def as_json(self) -> dict[str, object]:
        """Names with units, those across the plane only where they are known. An infinite buckling factor is null
        beside `is_counted`."""
        v = self.values
        names = zip(("force_y_n", "moved_y_mm", "unloaded_k_across_n_per_mm"), ACROSS_ENTRIES, strict=True)
        across = {name: v[entry] for name, entry in names if v.get(entry) is not None}
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
            **across,
        }

    @property
    def _unloaded(self) -> Matrix | None:
        xx, xz, zz = (self.values[name] for name in LOAD_ENTRIES[:3])
        return None if xx is None or xz is None or zz is None else (float(xx), float(xz), float(zz))

    def lines(self, k: tuple[Value, Value, Value] = (None, None, None), is_open: bool = False) -> list[str]:
        """For people.
        k: K under this load, in the order xx, xz, zz
        is_open: a gap takes stiffness away from this K, so the load is not what changes it"""
        v, unloaded = self.values, self._unloaded
        if not self.is_counted:
            return ["no load is counted: this K is the one without load"]
        force, moved = (_pair(v, name) for name in ("counted_force", "moved"))
        lines = [
            f"load counted: force of the ground on the tip {force} N, and the limb's weight; they move the tip by "
            f"{moved} mm",
            f"buckling factor {factor_words(v['buckling_factor'])}",
        ]
        if unloaded is not None:
            changes = f"; the load changes K by {_change(k, unloaded):.1%}"
            changes = "; with every gap closed" if is_open else "" if None in k else changes
            lines.append("K without load = [{0:.4f} {1:.4f}; {1:.4f} {2:.4f}] N/mm".format(*unloaded) + changes)
        return lines + self._lines_across()

    def _lines_across(self) -> list[str]:
        force, moved, k = (self.values.get(name) for name in ACROSS_ENTRIES)
        if force is None or moved is None:
            return []
        unloaded = "" if k is None else f"; K across it without load {k:.4f} N/mm"
        return [f"across the limb's plane, to the left: {force:.3f} N counted, tip moved by {moved:.3f} mm{unloaded}"]

    def words(self) -> list[str]:
        """The same in few words, for a line that has more to report."""
        v, unloaded = self.values, self._unloaded
        if not self.is_counted:
            return ["no load counted"]
        words = [
            f"load {_all(v, 'counted_force')} N",
            f"moved {_all(v, 'moved')} mm",
            f"buckling factor {factor_text(v['buckling_factor'])}",
        ]
        if unloaded is not None:
            words.append(f"K without load {' '.join(f'{value:.4f}' for value in unloaded)} N/mm")
        return words


def load_of(values: Mapping[str, Value]) -> Load:
    """From values that may be more; a number that is not one is not known."""
    found = {name: values[name] for name in LOAD_ENTRIES}
    found |= {name: values[name] for name in ACROSS_ENTRIES if name in values}
    return Load({name: None if isinstance(v, float) and math.isnan(v) else v for name, v in found.items()})


def factor_text(factor: Value) -> str:
    """A buckling factor as a number; none where there is none."""
    return "not known" if factor is None else "none" if math.isinf(factor) else f"{factor:.2f}"


def factor_words(factor: Value) -> str:
    """A buckling factor and what it means."""
    if factor is None:
        return "not known"
    if math.isinf(factor):
        return "none: this load is far from taking the limb's stiffness"
    softened = "; below 3 a limb is much softer than without load" if factor < 3.0 else ""
    return (
        f"{factor:.2f}: held as it stands, the limb would have no stiffness left in some direction under "
        f"{factor:.2f} times this load{softened}"
    )


def _pair(values: Mapping[str, Value], name: str) -> str:
    return _numbers(values[f"{name}_x"], values[f"{name}_z"])


def _all(values: Mapping[str, Value], name: str) -> str:
    """With what is across the plane, where it is known, in the middle."""
    across = values.get(f"{name}_y")
    return _pair(values, name) if across is None else _numbers(values[f"{name}_x"], across, values[f"{name}_z"])


def _numbers(*values: Value) -> str:
    return " ".join("not known" if v is None else f"{v:.3f}" for v in values)


def _change(k: tuple[Value, Value, Value], unloaded: Matrix) -> float:
    """Frobenius norm of the difference, as a fraction of that without load."""
    xx, xz, zz = (float(one or 0.0) - other for one, other in zip(k, unloaded, strict=True))
    return _size((xx, xz, zz)) / _size(unloaded)


def _size(k: Matrix) -> float:
    return math.sqrt(k[0] ** 2 + 2 * k[1] ** 2 + k[2] ** 2)
