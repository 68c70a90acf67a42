"""The loaded limb of the double-precision reference: rest state and K at finite displacements."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from brace.model import LimbModel
from brace.native.c_data import CData
from brace.native.limb import plant_model
from brace.native.loader import Library, library

DOWN_RAD = -np.pi / 2
DOWN = (0.0, 0.0, -1.0)
_ROWS = {  # function: struct of its cases, struct of its results
    "under_force": ("brace_loaded_case_t", "brace_loaded_result_t"),
    "under_displacement": ("brace_loaded_case_t", "brace_loaded_result_t"),
    "space_under_force": ("brace_loaded_space_case_t", "brace_loaded_space_result_t"),
}


class LoadedLimbs:
    """Results of a batch: `limbs["k_xx"]` has one number a case (fields of the C struct). A case without an answer has
    a negative `status` and NaN everywhere."""

    def __init__(self, rows: np.ndarray, status: np.ndarray) -> None:
        self.rows = rows
        self.status = status

    def __getitem__(self, field: str) -> np.ndarray:
        return np.asarray(self.rows[field])

    def __len__(self) -> int:
        return len(self.rows)

    def _vectors(self, names: tuple[str, ...]) -> np.ndarray:
        return np.stack([self.rows[name] for name in names], -1)

    @property
    def in_space(self) -> bool:
        """Whether the batch was asked in space."""
        return "k_yy" in (self.rows.dtype.names or ())

    @property
    def displacement_mm(self) -> np.ndarray:
        """Of the tip, from its place without force and weight: count x 2 (x, z), or x 3 in space."""
        return self._vectors(("dx_mm", "dy_mm", "dz_mm") if self.in_space else ("dx_mm", "dz_mm"))

    @property
    def force_n(self) -> np.ndarray:
        """Of the ground on the tip: count x 2, or x 3 in space."""
        return self._vectors(("fx_n", "fy_n", "fz_n") if self.in_space else ("fx_n", "fz_n"))

    @property
    def k_n_per_mm(self) -> np.ndarray:
        """K at rest: count x 2 x 2, or x 3 x 3 in space."""
        if self.in_space:
            names = ("k_xx", "k_xy", "k_xz", "k_xy", "k_yy", "k_yz", "k_xz", "k_yz", "k_zz")
            return self._vectors(names).reshape(-1, 3, 3)
        return self._vectors(("k_xx", "k_xz", "k_xz", "k_zz")).reshape(-1, 2, 2)


def _layout(native: Library, struct: str) -> np.dtype[np.void]:
    """A struct of doubles as numpy has it."""
    return np.dtype([(name, np.float64) for name, _ in native.ffi.typeof(struct).fields])


def loaded_rows(
    native: Library, function: str, model: CData, cases: Mapping[str, ArrayLike], parts: int
) -> LoadedLimbs:
    """Calls brace_reference_<function>; `cases` has numbers or arrays of one shape for fields of its struct, the others
    are 0. ValueError: a call that is wrong as a whole."""
    case_struct, result_struct = _ROWS[function]
    columns = np.broadcast_arrays(*(np.atleast_1d(np.asarray(value, dtype=float)) for value in cases.values()))
    given = np.zeros(columns[0].shape, _layout(native, case_struct))
    for name, column in zip(cases, columns):
        given[name] = column
    results = np.full(given.shape, np.nan, _layout(native, result_struct))
    status = np.zeros(given.shape, np.int32)
    ffi = native.ffi
    answer = getattr(native.lib, f"brace_reference_{function}")(
        model,
        given.size,
        ffi.cast(f"{case_struct} *", ffi.from_buffer(given)),
        parts,
        ffi.cast(f"{result_struct} *", ffi.from_buffer(results)),
        ffi.from_buffer("int32_t[]", status),
    )
    if answer and not status.any():
        raise ValueError(native.ffi.string(native.lib.brace_host_status_text(answer)).decode())
    return LoadedLimbs(results, status)


def _columns(vector: ArrayLike, names: tuple[str, ...]) -> dict[str, np.ndarray]:
    """A vector (or count of them) as columns."""
    array = np.asarray(vector, dtype=float)
    return {name: array[..., i] for i, name in enumerate(names)}


def under_force(
    model: LimbModel,
    theta1_rad: ArrayLike,
    theta2_rad: ArrayLike,
    force_n: ArrayLike,
    gravity_rad: ArrayLike = DOWN_RAD,
    parts: int = 0,
) -> LoadedLimbs:
    """The limb in its plane under forces of the ground on its tip (count x 2: x, z). Angles are those without
    deflection; zero offsets are not added."""
    imposed = _columns(force_n, ("fx_n", "fz_n"))
    return _in_plane("under_force", model, theta1_rad, theta2_rad, imposed, gravity_rad, parts)


def under_displacement(
    model: LimbModel,
    theta1_rad: ArrayLike,
    theta2_rad: ArrayLike,
    displacement_mm: ArrayLike,
    gravity_rad: ArrayLike = DOWN_RAD,
    parts: int = 0,
) -> LoadedLimbs:
    """The same with the tip held at displacements from its place without force and weight (count x 2)."""
    imposed = _columns(displacement_mm, ("dx_mm", "dz_mm"))
    return _in_plane("under_displacement", model, theta1_rad, theta2_rad, imposed, gravity_rad, parts)


def _in_plane(
    function: str,
    model: LimbModel,
    theta1_rad: ArrayLike,
    theta2_rad: ArrayLike,
    imposed: Mapping[str, np.ndarray],
    gravity_rad: ArrayLike,
    parts: int,
) -> LoadedLimbs:
    native = library()
    cases = {"theta1_rad": theta1_rad, "theta2_rad": theta2_rad, "gravity_rad": gravity_rad, **imposed}
    return loaded_rows(native, function, plant_model(native, model), cases, parts)


def space_under_force(
    model: LimbModel, theta_rad: ArrayLike, force_n: ArrayLike, gravity: ArrayLike = DOWN, parts: int = 0
) -> LoadedLimbs:
    """The limb in space: angles theta0, theta1, theta2 and forces in the robot's base frame, count x 3 each; `gravity`
    is the unit vector in which the weights pull."""
    return _in_space("space_under_force", model, theta_rad, _columns(force_n, ("fx_n", "fy_n", "fz_n")), gravity, parts)


def _in_space(
    function: str,
    model: LimbModel,
    theta_rad: ArrayLike,
    imposed: Mapping[str, np.ndarray],
    gravity: ArrayLike,
    parts: int,
) -> LoadedLimbs:
    native = library()
    cases = {
        **_columns(theta_rad, ("theta0_rad", "theta1_rad", "theta2_rad")),
        **_columns(gravity, ("gravity_x", "gravity_y", "gravity_z")),
        **imposed,
    }
    return loaded_rows(native, function, plant_model(native, model), cases, parts)
