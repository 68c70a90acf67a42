"""The simulated limb of host_sim: loading records, joint tests, the rig, the double-precision reference."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from brace.model import LimbModel
from brace.native.c_data import CData
from brace.native.library_types import Columns
from brace.native.limb import plant_error, plant_model
from brace.native.loader import Library, library

READINGS = ("fx_n", "fz_n", "enc1_rad", "enc2_rad", "base_x_mm", "base_z_mm")
_JOINT_INDEX = {"coxa": 0, "femur": 1, "tibia": 2}
NO_CONVERGENCE = -9


def _point_at(
    native: Library, struct: CData, field: str, values: np.ndarray, kind: type = np.float64
) -> tuple[np.ndarray, CData]:
    """Points a struct's field at a column. The column lives as long as what is returned."""
    array: np.ndarray = np.ascontiguousarray(values, dtype=kind)
    pointer = native.ffi.from_buffer("int32_t[]" if kind is np.int32 else "double[]", array)
    setattr(struct, field, pointer)
    return array, pointer


class LoadingPlayer:
    """One record's load sequence, ready to be played on many models.

    small_displacements: the limb does not turn as it is displaced, and weights load its joints only.
    held_at_rest: displacements count from where the limb hangs under its weight."""

    def __init__(self, columns: Columns, *, small_displacements: bool = False, held_at_rest: bool = False) -> None:
        self._native = library()
        ffi = self._native.ffi
        self.count = len(columns["t_s"])
        self._rows = ffi.new("brace_loading_rows_t *")
        self._rows.count = self.count
        self._rows.small_displacements = int(small_displacements)
        self._rows.held_at_rest = int(held_at_rest)
        inputs = ("theta1_rad", "theta2_rad", "t_s", "temp_degc", "dx_mm", "dz_mm", "preload_x_n", "preload_z_n")
        self._keep = [_point_at(self._native, self._rows, "run", columns["run"], np.int32)]
        self._keep += [
            _point_at(self._native, self._rows, name, columns[name]) for name in inputs if name in columns
        ]

    def play(self, model: LimbModel, readings: Sequence[str] = ("fx_n", "fz_n")) -> dict[str, np.ndarray]:
        """What the rig would read on this limb: one array of `count` per reading, before resolution and noise."""
        ffi, lib = self._native.ffi, self._native.lib
        out = {name: np.empty(self.count) for name in readings}
        reading = ffi.new("brace_loading_reading_t *")
        pointers = {name: ffi.from_buffer("double[]", values) for name, values in out.items()}
        for name, pointer in pointers.items():
            setattr(reading, name, pointer)
        unsolved = ffi.new("size_t *")
        status = lib.brace_plant_loading(plant_model(self._native, model), self._rows, reading, unsolved)
        if status:
            raise plant_error(
                self._native,
                status,
                model,
                f"be played ({unsolved[0]} rows unsolved)" if status == NO_CONVERGENCE else "be played",
            )
        return out


class JointPlayer:
    """A joint test's sequence: the imposed deflection [rad], or the imposed torque [N mm]."""

    def __init__(self, columns: Columns, joint: str, *, torque_imposed: bool = False) -> None:
        self._native = library()
        ffi = self._native.ffi
        self._rows = ffi.new("brace_joint_rows_t *")
        self._rows.count = self.count = len(columns["t_s"])
        self._rows.torque_imposed = int(torque_imposed)
        self._rows.joint_index = _JOINT_INDEX[joint]
        imposed = columns["torque_n_mm" if torque_imposed else "angle_rad"]
        self._keep = [
            _point_at(self._native, self._rows, "t_s", columns["t_s"]),
            _point_at(self._native, self._rows, "input", imposed),
        ]
        if "test" in columns:
            self._keep.append(_point_at(self._native, self._rows, "test", columns["test"], np.int32))
        if "temp_degc" in columns:
            self._keep.append(_point_at(self._native, self._rows, "temp_degc", columns["temp_degc"]))

    def play(
        self, model: LimbModel, reversal_rad: float = 0.0, start_torque_n_mm: np.ndarray | None = None
    ) -> np.ndarray:
        """Torque [N mm] for an imposed deflection, deflection [rad] for an imposed torque; `reversal_rad` is the
        turning over which friction changes sign. `start_torque_n_mm` (one entry a row) states how far friction is
        strained where each test starts; without it it starts relaxed."""
        ffi = self._native.ffi
        self._rows.reversal_rad = reversal_rad
        self._start_from(start_torque_n_mm)
        out = np.empty(self.count)
        status = self._native.lib.brace_plant_joint(
            plant_model(self._native, model), self._rows, ffi.from_buffer("double[]", out)
        )
        if status:
            raise plant_error(self._native, status, model, "be played")
        return out

    def _start_from(self, torque_n_mm: np.ndarray | None) -> None:
        self._rows.start_torque_n_mm = self._native.ffi.NULL
        if torque_n_mm is not None:
            self._begun = _point_at(self._native, self._rows, "start_torque_n_mm", torque_n_mm)


def reference_planar(model: LimbModel, theta1_rad: np.ndarray, theta2_rad: np.ndarray) -> np.ndarray:
    """The linear limb in double precision at true angles: count x 9, columns k_xx k_xz k_zz [N/mm], c_xx c_xz c_zz
    [mm/N], lambda_min lambda_max [N/mm], stiff axis [rad]. For fits, which need smooth derivatives; a K that is
    shown comes from the firmware."""
    native = library()
    ffi = native.ffi
    theta1, theta2 = (np.ascontiguousarray(theta, dtype=float) for theta in (theta1_rad, theta2_rad))
    out = np.empty((theta1.size, 9))
    status = native.lib.brace_reference_planar(
        plant_model(native, model),
        theta1.size,
        ffi.from_buffer("double[]", theta1),
        ffi.from_buffer("double[]", theta2),
        ffi.from_buffer("double[]", out),
    )
    if status:
        raise plant_error(native, status, model, "be evaluated")
    return out


def play_rig(model: LimbModel | None, design: Mapping[str, object]) -> dict[str, np.ndarray]:
    """Plays a rig design (fields of brace_rig_design_t by name, theta1_rad and theta2_rad as arrays) on a limb;
    None plays the sequence alone. Returns the dataset's columns."""
    native = library()
    ffi, lib = native.ffi, native.lib
    c_design = ffi.new("brace_rig_design_t *")
    lib.brace_rig_design_default(c_design)
    keep = []
    for name, value in design.items():
        if isinstance(value, np.ndarray):
            value = ffi.from_buffer("double[]", np.ascontiguousarray(value, dtype=float))
            keep.append(value)
        setattr(c_design, name, value)
    c_design.config_count = np.size(np.asarray(design["theta1_rad"]))
    rows = lib.brace_rig_row_count(c_design)
    columns: dict[str, np.ndarray] = {}
    record = ffi.new("brace_rig_record_t *")
    for name in ("run", "config", "axis", "rep", "step"):
        columns[name] = np.zeros(rows, np.int32)
        pointer = ffi.from_buffer("int32_t[]", columns[name])
        keep.append(pointer)
        setattr(record, name, pointer)
    for name in ("theta1_rad", "theta2_rad", "t_s", "temp_degc", "dx_mm", "dz_mm", *READINGS):
        columns[name] = np.zeros(rows)
        pointer = ffi.from_buffer("double[]", columns[name])
        keep.append(pointer)
        setattr(record, name, pointer)
    plant = ffi.NULL if model is None else plant_model(native, model)
    status = lib.brace_rig_play(c_design, plant, record)
    if status:
        from brace.ground.errors import BadFileError

        if model is None:
            raise BadFileError(
                "the rig's design is not sound", why=f"status {status}", next_step="check rig.toml"
            )
        raise plant_error(native, status, model, "be played on this rig")
    return columns


def zero_force_shift_mm(
    model: LimbModel, theta1_rad: float, theta2_rad: float, axis: str, step_mm: float, steps: int
) -> float:
    """Fig. 12's number: how far apart the limb finds zero force after unloading from both sides [mm]."""
    native: Library = library()
    shift = native.ffi.new("double *")
    status = native.lib.brace_rig_zero_force_shift(
        plant_model(native, model), theta1_rad, theta2_rad, int(axis == "z"), step_mm, steps, shift
    )
    if status:
        raise plant_error(native, status, model, "be cycled")
    return float(shift[0])
