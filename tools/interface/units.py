"""The units of all that the dictionary lists, and how a name says them: the last part of a key in limb.toml, and of a C
member. This is the one list: a new unit is a line here."""

from __future__ import annotations

UNIT_SUFFIX = {
    "": "", "1": "_ratio", "us": "", "ms": "_ms", "s": "_s", "Hz": "_hz", "bit/s": "",
    "mm": "_mm", "rad": "_rad", "N": "_n", "N mm": "_n_mm", "N/s": "_n_per_s",
    "N/mm": "_n_per_mm", "mm/N": "_mm_per_n", "rad/(N mm)": "_rad_per_n_mm", "1/(N mm)": "_per_n_mm",
    "N mm/rad^3": "_n_mm_per_rad3", "N mm s^2/rad": "_n_mm_s2_per_rad",
    "degC": "_degc", "1/degC": "_per_degc", "1/degC^2": "_per_degc2",
}  # fmt: skip


def unit_fault(unit: str) -> str:
    """Why there is no such unit; empty: there is."""
    if unit in UNIT_SUFFIX:
        return ""
    units = ", ".join(repr(one) for one in UNIT_SUFFIX)
    return f"no unit {unit!r}; units are {units}, and a new one is a line of tools/interface/units.py"


def name_fault(name: str, unit: str) -> str:
    """Why a name does not say its unit; empty: it does. A plain number's name ends in no unit."""
    ends = [one for one, suffix in UNIT_SUFFIX.items() if suffix not in ("", "_ratio") and name.endswith(suffix)]
    said = max(ends, key=lambda one: len(UNIT_SUFFIX[one]), default="")
    wanted = UNIT_SUFFIX[unit]
    if said and said != unit:
        return f"its name says {said!r}, its unit is {unit!r}"
    return f"its unit is {unit!r}, so its name ends in {wanted}" if wanted and not name.endswith(wanted) else ""
