"""Prints tests/unit/bench/loaded_space_rows.h: limbs in space under loads, as the reference computes them.

    .venv/bin/python tests/judges/engine/print_rows.py > tests/unit/bench/loaded_space_rows.h

Of random limbs with weights whose buckling factor lies from 2 to 9, those whose tips move least: there the firmware's
two steps leave least, so that the suites may ask for most. The reference alone chooses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from brace.native.loaded import LoadedLimbs

import cases
from engine_chain import Array

SEED, DRAWN, ROWS = 20261126, 12000, 40
LINKS = ("coxa", "femur", "tibia")
OF_A_LINK = ("axial_mm_per_n", "bending_mm_per_n", "tilt_rad", "lateral_mm_per_n", "torsion_rad_per_n_mm")
KEYS = (
    *(f"geometry.{link}_mm" for link in LINKS),
    *(f"link.{link}.{key}" for link in LINKS for key in (*OF_A_LINK, "moment_transfer")),
    *(f"joint.{link}.compliance_rad_per_n_mm" for link in LINKS),
    *(f"base.{key}" for key in ("x_mm_per_n", "z_mm_per_n", "rotation_rad_per_n_mm")),
    *(f"gravity.{part}_n" for part in ("femur", "knee", "tibia")),
)


def in_single(case: cases.Case) -> cases.Case:
    """The same in numbers that floats hold, in the frame of the limb's plane."""

    def single(numbers: object) -> Array:
        return np.asarray(numbers, np.float32).astype(float)

    keys = dict(zip(case.keys, map(float, single(list(case.keys.values())))))
    theta_rad = single((0.0, *case.theta_rad[1:]))
    return replace(
        case,
        keys=keys,
        theta_rad=(0.0, float(theta_rad[1]), float(theta_rad[2])),
        force_n=single(case.force_n),
        gravity=single(case.gravity),
    )


def reference(case: cases.Case) -> LoadedLimbs:
    """With the direction of the weight as a unit vector again."""
    return cases.reference(replace(case, gravity=case.gravity / np.linalg.norm(case.gravity)))


def row(case: cases.Case, found: LoadedLimbs) -> str:
    """One limb's numbers, in the order of KEYS, then the load, then what the reference says."""
    k = found.k_n_per_mm[0]
    numbers = [case.keys.get(key, 0.0) for key in KEYS]
    numbers += [*case.gravity, *case.theta_rad[1:], *case.force_n]
    numbers += [k[0, 0], k[0, 1], k[0, 2], k[1, 1], k[1, 2], k[2, 2]]
    numbers += [*found.displacement_mm[0], found["buckling_factor"][0]]
    lines, line = [], "    {"
    for number in numbers:
        word = f"{number:.9g}, "
        if len(line) + len(word) > 118:
            lines.append(line.rstrip())
            line = "     "
        line += word
    return "\n".join([*lines, line.rstrip(", ") + "},"])


def main() -> None:
    draw = np.random.default_rng(SEED)
    chosen: list[tuple[float, int, cases.Case, LoadedLimbs]] = []
    for _ in range(DRAWN):
        case = in_single(cases._draw(draw, True))
        found = reference(case)
        reach_mm = case.keys["geometry.femur_mm"] + case.keys["geometry.tibia_mm"]
        moved = float(np.linalg.norm(found.displacement_mm[0])) / reach_mm
        if found.status[0] == 0 and 2.0 <= found["buckling_factor"][0] <= 9.0 and "gravity.femur_n" in case.keys:
            chosen.append((moved, len(chosen), case, found))
    print("/* Written by tests/judges/engine/print_rows.py from the double-precision reference; do not edit. In each row")
    print(" * the limb, the direction of its weight, theta1, theta2, the tip's force; then K, the tip's displacement")
    print(" * and the buckling factor, all in the limb's plane's frame. */")
    print("#ifndef LOADED_SPACE_ROWS_H\n#define LOADED_SPACE_ROWS_H\n")
    print(f"enum {{ LOADED_SPACE_ROWS = {ROWS}, LOADED_SPACE_NUMBERS = {len(KEYS) + 18} }};\n")
    print("static const double loaded_space_rows[LOADED_SPACE_ROWS][LOADED_SPACE_NUMBERS] = {")
    for _, _, case, found in sorted(chosen, key=lambda item: item[:2])[:ROWS]:
        print(row(case, found))
    print("};\n\n#endif")


if __name__ == "__main__":
    main()
