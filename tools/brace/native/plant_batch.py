"""Many simulated limbs on one loading record: models as rows of numbers, as fits and searches need them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from brace.model import LimbModel
from brace.native.library_types import Columns
from brace.native.limb import plant_layout, plant_model
from brace.native.loader import library
from brace.native.plant import LoadingPlayer


def model_numbers(model: LimbModel) -> np.ndarray:
    """The model as the plant holds it: one double per key of limb.toml that the plant knows, in its own order."""
    native = library()
    plant = plant_model(native, model)
    return np.frombuffer(bytes(native.ffi.buffer(plant)), dtype=np.float64).copy()


def number_index() -> Mapping[str, int]:
    """Where each key of limb.toml stands in `model_numbers`."""
    positions, keys = plant_layout(library())
    return dict(zip(keys, (int(position) for position in positions)))


class LoadingBatchPlayer(LoadingPlayer):
    """One record's load sequence, played on many models at once. `zeroed` takes each run's first reading off."""

    def __init__(self, columns: Columns, readings: Sequence[str], *, zeroed: bool = False) -> None:
        super().__init__(columns)
        self.readings = tuple(readings)
        self._rows.zeroed_per_run = int(zeroed)

    def play_numbers(self, models: np.ndarray) -> np.ndarray:
        """`models` (models x numbers) to readings (models x readings x rows), before resolution and noise; NaN for a
        model that no limb can have. A row that did not settle keeps its best state."""
        native = self._native
        ffi = native.ffi
        models = np.ascontiguousarray(models, dtype=np.float64)
        count = len(models)
        out = np.empty((len(self.readings), count, self.count))
        whole = ffi.new("brace_loading_reading_t *")
        pointers = [ffi.from_buffer("double[]", part) for part in out]
        for name, pointer in zip(self.readings, pointers):
            setattr(whole, name, pointer)
        structs = ffi.cast("brace_plant_model_t *", ffi.from_buffer("double[]", models))
        native.lib.brace_plant_loading_many(structs, count, self._rows, whole, ffi.NULL)
        return np.moveaxis(out, 0, 1)
