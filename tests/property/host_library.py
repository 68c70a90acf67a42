"""The simulated limb's C interface for the property tests: libbrace_host through cffi."""
from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import cffi
import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[2]
HEADERS = [ROOT / "host_sim" / "api" / name for name in ("brace_plant_model.h", "brace_host.h")]
Array = NDArray[np.float64]

ffi = cffi.FFI()
ffi.cdef("\n".join(line for header in HEADERS for line in header.read_text().splitlines() if not line.startswith("#")))


def open_library() -> Any:
    """The library at $BRACE_LIBRARY, else the host build's; FileNotFoundError says what to do."""
    path = Path(os.environ.get("BRACE_LIBRARY", ROOT / "build" / "host" / "host_sim" / "libbrace_host.so"))
    if not path.is_file():
        raise FileNotFoundError(f"{path}: build it (./dev setup) or set BRACE_LIBRARY")
    return ffi.dlopen(str(path))


lib = open_library()


class Model:
    """One brace_plant_model_t, its keys set and read by their names in limb.toml."""

    def __init__(self, **keys: float) -> None:
        """Start from the zero effect everywhere; keywords hold limb.toml's keys with '__' for the dots."""
        self.c = ffi.new("brace_plant_model_t *")
        lib.brace_plant_model_default(self.c)
        for key, value in keys.items():
            self[key.replace("__", ".")] = value

    def _at(self, key: str) -> Any:
        offset = lib.brace_plant_key_offset(key.encode())
        if offset < 0:
            raise KeyError(key)
        return ffi.cast("double *", ffi.cast("char *", self.c) + offset)

    def __setitem__(self, key: str, value: float) -> None:
        self._at(key)[0] = value

    def __getitem__(self, key: str) -> float:
        return float(self._at(key)[0])


def doubles(array: Array) -> Any:
    """A contiguous float64 array as C sees it; the result keeps it alive, a struct it is put into not."""
    assert array.dtype == np.float64
    return ffi.from_buffer("double[]", array)


def column(values: Any, count: int) -> Array:
    """A float64 column of this many rows from a number or an array."""
    return np.ascontiguousarray(np.broadcast_to(np.asarray(values, dtype=np.float64), (count,)))


class Refused(Exception):
    """A call of the library answered with a negative status."""

    def __init__(self, status: int) -> None:
        super().__init__(ffi.string(lib.brace_host_status_text(status)).decode())
        self.status = status


def check(status: int) -> None:
    """Raise Refused for anything but OK."""
    if status != 0:
        raise Refused(status)


def planar_reference(model: Model, theta1_rad: Any, theta2_rad: Any) -> Array:
    """Rows of k_xx k_xz k_zz c_xx c_xz c_zz lambda_min lambda_max stiff_axis, shape (n, 9); true angles."""
    count = max(np.size(theta1_rad), np.size(theta2_rad))
    theta1, theta2 = column(theta1_rad, count), column(theta2_rad, count)
    out = np.full((count, 9), np.nan)
    check(lib.brace_reference_planar(model.c, count, doubles(theta1), doubles(theta2), doubles(out)))
    return out


def spatial_reference(model: Model, theta0_rad: Any, theta1_rad: Any, theta2_rad: Any) -> Array:
    """Rows as brace_reference_spatial writes them, shape (n, 18)."""
    count = max(np.size(theta0_rad), np.size(theta1_rad), np.size(theta2_rad))
    angles = [column(each, count) for each in (theta0_rad, theta1_rad, theta2_rad)]
    out = np.full((count, 18), np.nan)
    check(lib.brace_reference_spatial(model.c, count, *map(doubles, angles), doubles(out)))
    return out


def play(model: Model, theta1_rad: Any, theta2_rad: Any, dx_mm: Any, dz_mm: Any, *, t_s: Any = None,
         temp_degc: Any = None, run: Any = 1, free_axis: Any = 0, creep_runs_on: bool = False,
         zeroed: bool = False, small: bool = True, held_at_rest: bool = False) -> dict[str, Array]:
    """A loading record on the plant: forces, encoders and base deflections, one entry a row."""
    count = max(map(np.size, (theta1_rad, dx_mm, dz_mm)))
    columns = {name: column(values, count) for name, values in {
        "theta1_rad": theta1_rad, "theta2_rad": theta2_rad, "dx_mm": dx_mm, "dz_mm": dz_mm,
        "t_s": np.arange(count) * 4.0 if t_s is None else t_s,
        "temp_degc": model["thermal.reference_degc"] if temp_degc is None else temp_degc}.items()}
    runs = np.ascontiguousarray(np.broadcast_to(np.asarray(run, dtype=np.int32), (count,)))
    free = np.ascontiguousarray(np.broadcast_to(np.asarray(free_axis, dtype=np.int32), (count,)))
    rows = ffi.new("brace_loading_rows_t *", {name: doubles(values) for name, values in columns.items()})
    rows.count = count
    rows.run = ffi.cast("int32_t *", runs.ctypes.data)
    rows.free_axis = ffi.cast("int32_t *", free.ctypes.data)
    rows.creep_runs_on, rows.zeroed_per_run = int(creep_runs_on), int(zeroed)
    rows.small_displacements, rows.held_at_rest = int(small), int(held_at_rest)
    out = {name: np.full(count, np.nan) for name in
           ("fx_n", "fz_n", "enc1_rad", "enc2_rad", "base_x_mm", "base_z_mm")}
    reading = ffi.new("brace_loading_reading_t *", {name: doubles(values) for name, values in out.items()})
    check(lib.brace_plant_loading(model.c, rows, reading, ffi.NULL))
    return out


def loaded_reference(model: Model, theta1_rad: float, theta2_rad: float, *, displacement_mm: Any = None,
                     force_n: Any = None, parts: int = 0) -> dict[str, Array]:
    """The reference's rest states under displacements or forces (n, 2), at true angles and under its weight: the fields
    of brace_loaded_result_t."""
    by_force = displacement_mm is None
    given = np.atleast_2d(np.asarray(force_n if by_force else displacement_mm, dtype=np.float64))
    names = ("fx_n", "fz_n") if by_force else ("dx_mm", "dz_mm")
    cases = ffi.new("brace_loaded_case_t[]", [
        {"theta1_rad": theta1_rad, "theta2_rad": theta2_rad, "gravity_rad": model["gravity.direction_rad"],
         names[0]: x, names[1]: z}
        for x, z in given])
    results = ffi.new("brace_loaded_result_t[]", len(given))
    solve = lib.brace_reference_under_force if by_force else lib.brace_reference_under_displacement
    check(solve(model.c, len(given), cases, parts, results, ffi.NULL))
    return {name: np.array([getattr(each, name) for each in results])
            for name, _ in ffi.typeof("brace_loaded_result_t").fields}


def play_joint(model: Model, angle_or_torque: Any, *, torque_imposed: bool = False, t_s: Any = None,
               joint: int = 1, reversal_rad: float = 0.0, test: Any = 1,
               start_torque: float | None = None) -> Array:
    """A joint test: torque for imposed angles, or angles for imposed torques, one entry a row."""
    given = np.ascontiguousarray(angle_or_torque, dtype=np.float64)
    times = column(np.arange(given.size) if t_s is None else t_s, given.size)
    tests = np.ascontiguousarray(np.broadcast_to(np.asarray(test, dtype=np.int32), given.shape))
    rows = ffi.new("brace_joint_rows_t *", {
        "count": given.size, "t_s": doubles(times), "input": doubles(given), "joint_index": joint,
        "test": ffi.cast("int32_t *", tests.ctypes.data), "torque_imposed": int(torque_imposed),
        "reversal_rad": reversal_rad})
    if start_torque is not None:
        begun = np.full(given.size, start_torque)
        rows.start_torque_n_mm = doubles(begun)
    out = np.full(given.size, np.nan)
    check(lib.brace_plant_joint(model.c, rows, doubles(out)))
    return out
