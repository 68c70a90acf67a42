"""Prints the first table of docs/loaded.md: how far K without load is from K under it, by the double-precision reference,
of the paper's limb with beams for links."""

from __future__ import annotations

import numpy as np
from loaded_picture import limb

from brace.native import loaded

CASES = (
    ((1.0, 1.4), (0.0, 10.0)), ((1.0, 1.4), (0.0, -20.0)), ((1.0, 1.4), (-20.0, 0.0)), ((0.3, 0.6), (0.0, 10.0)),
    ((0.3, 0.6), (0.0, 20.0)), ((0.3, 0.6), (-20.0, 0.0)), ((0.5, 2.0), (20.0, 0.0)),
)  # fmt: skip
MOST_TOLD = 11.0  # a controller tells larger buckling factors as none


def row(posture_rad: tuple[float, float], force_n: tuple[float, float]) -> str:
    """One line of the table."""
    under, without = (loaded.under_force(limb(), *posture_rad, [force]) for force in (force_n, (0.0, 0.0)))
    k, k_without = under.k_n_per_mm[0], without.k_n_per_mm[0]
    off = np.linalg.norm(k_without - k) / np.linalg.norm(k)
    softest, softest_without = (np.linalg.eigvalsh(each)[0] for each in (k, k_without))
    factor = float(under["buckling_factor"][0])
    moved = ", ".join(f"{value:.1f}" for value in under.displacement_mm[0])
    told = f"{factor:.1f}" if factor < MOST_TOLD else "none"
    angles, force = ", ".join(map(str, posture_rad)), "({:g}, {:g})".format(*force_n)
    return f"| {angles} | {force} | {moved} | {off:.0%} | {softest_without / softest - 1.0:.0%} | {told} |"


if __name__ == "__main__":
    print("\n".join(row(*case) for case in CASES).replace("%", " %"))
