"""measured.csv: what sensors or servos say of the feet before the payload."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from brace.ground.errors import BadFileError, place
from brace.ground.files import TOML_LIMIT_BYTES, read_text
from brace.native import library
from brace.stance.stance_file import Limb, Stance
from brace.stance.limb_law import JOINTS
from brace.stance.world import Measured, World

FORCES = ("fx_n", "fy_n", "fz_n")
TORQUES = ("tau0_n_mm", "tau1_n_mm", "tau2_n_mm")
# Where a load lies in the band that friction leaves it, as shares of half the band. A load that grew until its joint
# slipped stands at the outer end, beyond what the motor gives; others anywhere: as many of either have a mean of 0.5
# outwards, and one sigma of 0.65. Loads that have come back from a larger one, and stand at the inner end, make it more;
# and the joints of a limb, which have borne the same forces one after the other, stand at like ends.
_OUTWARDS, _SD_OF_BAND = 0.5, 1.0


def load_measured(path: Path, stance: Stance, middle: World, sd_n: float) -> Measured:
    """Reads and checks the file: a row a limb, in any order. `sd_n`: the noise of a measured force's components."""
    rows = list(csv.reader(read_text(path, TOML_LIMIT_BYTES, "table of measured forces").splitlines()))
    header = [name.strip() for name in rows[0]] if rows else []
    columns = next((names for names in (FORCES, TORQUES) if set(names) <= set(header)), None)
    if "limb" not in header or columns is None:
        raise BadFileError(
            "no forces of limbs",
            where=place(path, 1),
            why=f"the header has {', '.join(header) or 'nothing'}",
            next_step=f"limb,{','.join(FORCES)} for forces, or limb,{','.join(TORQUES)} for the joints' torques",
        )
    found: dict[str, np.ndarray] = {}
    names = [limb.name for limb in stance.limbs]
    for line, row in enumerate(rows[1:], 2):
        if not any(cell.strip() for cell in row):
            continue
        cells = dict(zip(header, (cell.strip() for cell in row)))
        name = cells.get("limb", "")
        if name not in names or name in found:
            raise BadFileError(
                f"limb {name!r}" + (" twice" if name in found else " is none of this stance"),
                where=place(path, line),
                why=f"the stance has {', '.join(names)}",
                next_step="one row for each limb, named as in stance.toml",
            )
        found[name] = _numbers(path, line, cells, columns)
    missing = [name for name in names if name not in found]
    if missing:
        raise BadFileError(
            f"no row for {missing[0]}",
            where=place(path, len(rows)),
            why="every limb that bears the body counts",
            next_step="add its row; a foot in the air has zeros",
        )
    values = [found[name] for name in names]
    if columns == FORCES:
        return Measured(np.array(values), tuple(sd_n**2 * np.eye(3) for _ in values))
    return _from_torques(stance, middle, values, sd_n)


def _numbers(path: Path, line: int, cells: dict[str, str], columns: tuple[str, ...]) -> np.ndarray:
    values = []
    for column in columns:
        try:
            value = float(cells.get(column, ""))
        except ValueError:
            value = np.nan
        if not np.isfinite(value):
            raise BadFileError(
                f"{column} = {cells.get(column, '')!r} is no number",
                where=place(path, line),
                why="forces are in N, torques in N mm",
                next_step="write a number with a point",
            )
        values.append(value)
    return np.array(values)


def _from_torques(stance: Stance, middle: World, torques: list[np.ndarray], sd_n: float) -> Measured:
    """The joints' torques as forces; friction in the gears hides a part of each."""
    forces, covariances = [], []
    for limb, law, torque in zip(stance.limbs, middle.laws, torques, strict=True):
        by_torque = law.force_by_torque()
        center, half = np.array([_band_n_mm(limb, joint, one) for joint, one in zip(JOINTS, torque, strict=True)]).T
        gain, noise = (
            np.array([_given(limb, f"motor.{joint}.{key}") for joint in JOINTS])
            for key in ("torque_gain_rel", "torque_noise_n_mm")
        )
        variance = (_SD_OF_BAND * half) ** 2 + (gain * center) ** 2 + noise**2
        forces.append(law.force_of_torques_n(center + _OUTWARDS * np.clip(center, -half, half)))
        covariances.append((by_torque * variance) @ by_torque.T + sd_n**2 * np.eye(3))
    return Measured(np.array(forces), tuple(covariances))


def _band_n_mm(limb: Limb, joint: str, torque_n_mm: float) -> tuple[float, float]:
    """The load behind a gear whose motor gives a torque: the middle of its band, and half of its width."""
    native, number = library(), limb.model.number
    gear = native.ffi.new(
        "brace_gear_t *",
        {
            "friction_n_mm": number(f"motor.{joint}.friction_n_mm"),
            "per_torque_ratio": number(f"motor.{joint}.friction_per_torque_ratio"),
            "per_load_ratio": number(f"motor.{joint}.friction_per_load_ratio"),
            "tolerance_ratio": _given(limb, f"motor.{joint}.friction_tolerance_ratio"),
            "sliding_ratio": 1.0,  # the joint stands
            "joint_n_mm": number(f"joint.{joint}.coulomb_n_mm"),
            "joint_per_load_ratio": number(f"joint.{joint}.coulomb_per_load_ratio"),
        },
    )
    band = native.ffi.new("brace_load_band_t *")
    native.lib.brace_load_band(gear, torque_n_mm, 0.0, False, band)
    return float(band.middle_n_mm), float(band.half_n_mm)


def _given(limb: Limb, key: str) -> float:
    """What limb.toml says; a torque of which it says nothing is taken as exact, as a model without [uncertainty] is."""
    return limb.model.number(key) if key in limb.model.given else 0.0
