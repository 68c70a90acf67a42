"""Many simulated limbs at once: models as rows of numbers, as fits and searches need them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache

import numpy as np

from brace.model import LimbModel
from brace.native.library_types import Columns
from brace.native.limb import plant_layout, plant_model
from brace.native.loader import Library, library
from brace.native.c_data import CData
from brace.native.plant import JointPlayer, LoadingPlayer


def model_numbers(model: LimbModel) -> np.ndarray:
    """The model as the plant holds it: one double per key of limb.toml that the plant knows, in its own order."""
    native = library()
    plant = plant_model(native, model)
    return np.frombuffer(bytes(native.ffi.buffer(plant)), dtype=np.float64).copy()


@cache
def number_index() -> Mapping[str, int]:
    """Where each key of limb.toml stands in `model_numbers`."""
    positions, keys = plant_layout(library())
    return dict(zip(keys, positions))


class LoadingBatchPlayer(LoadingPlayer):
    """One record's load sequence, played on many models at once. `zeroed` takes each run's first reading off."""

    def __init__(
        self,
        columns: Columns,
        readings: Sequence[str],
        *,
        zeroed: bool = False,
        small_displacements: bool = False,
        held_at_rest: bool = False,
    ) -> None:
        super().__init__(columns, small_displacements=small_displacements, held_at_rest=held_at_rest)
        self.readings = tuple(readings)
        self._rows.zeroed_per_run = int(zeroed)

    def play_numbers(self, models: np.ndarray, *, settled: bool = False) -> np.ndarray:
        """`models` (models x numbers) to readings (models x readings x rows), before resolution and noise; NaN for a
        model that no limb can have. A row that did not settle keeps its best state; with `settled`, its model is NaN
        too."""
        native = self._native
        ffi = native.ffi
        count = len(models)
        out = np.empty((len(self.readings), count, self.count))
        whole = ffi.new("brace_loading_reading_t *")
        pointers = [ffi.from_buffer("double[]", part) for part in out]
        for name, pointer in zip(self.readings, pointers):
            setattr(whole, name, pointer)
        status = np.zeros(count, np.int32)
        native.lib.brace_plant_loading_many(
            _structs(native, models), count, self._rows, whole, ffi.from_buffer("int32_t[]", status)
        )
        if settled:
            out[:, status != 0] = np.nan
        return out.transpose(1, 0, 2)


class JointBatchPlayer(JointPlayer):
    """A joint test's imposed deflections [rad], played on many models at once. `start_torque_n_mm` has one entry a row:
    the torque that its test starts with, as it was read."""

    def __init__(self, columns: Columns, joint: str, start_torque_n_mm: np.ndarray) -> None:
        super().__init__(columns, joint)
        self._start_torque_n_mm = start_torque_n_mm

    def play_numbers(
        self, models: np.ndarray, reversal_rad: np.ndarray, torque_offset_n_mm: np.ndarray
    ) -> np.ndarray:
        """`models` (models x numbers) to torque as read [N mm] (models x rows); NaN for a model that no limb can have.
        Each model has its own turn over which friction changes sign, and its own reading of no torque."""
        native = self._native
        self._start_from(self._start_torque_n_mm)
        out = np.empty((len(models), self.count))
        native.lib.brace_plant_joint_many(
            _structs(native, models),
            len(models),
            self._rows,
            _doubles(native, reversal_rad),
            _doubles(native, torque_offset_n_mm),
            native.ffi.from_buffer("double[]", out),
            native.ffi.NULL,
        )
        return out


def reference_planar_many(models: np.ndarray, angles_rad: np.ndarray) -> np.ndarray:
    """`reference_planar` of `models` (models x numbers), each at its own true angles (models x rows x 2): models x rows
    x 9; NaN for a model that no limb can have or that does not yield."""
    native = library()
    out = np.empty((*angles_rad.shape[:2], 9))
    native.lib.brace_reference_planar_many(
        _structs(native, models),
        len(models),
        angles_rad.shape[1],
        _doubles(native, angles_rad[:, :, 0]),
        _doubles(native, angles_rad[:, :, 1]),
        native.ffi.from_buffer("double[]", out),
        native.ffi.NULL,
    )
    return out


def _doubles(native: Library, values: np.ndarray) -> CData:
    return native.ffi.from_buffer("double[]", np.ascontiguousarray(values, dtype=np.float64))


def _structs(native: Library, models: np.ndarray) -> CData:
    """Rows of numbers as an array of plants. It holds on to the rows for as long as it lives."""
    return native.ffi.from_buffer("brace_plant_model_t[]", np.ascontiguousarray(models, dtype=np.float64))
