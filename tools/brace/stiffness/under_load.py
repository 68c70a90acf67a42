"""K under a load at the limb's equilibrium, by the firmware's own C (brace/loaded.h)."""

from __future__ import annotations

import numpy as np

from brace.model import LimbModel
from brace.native import library
from brace.native.c_data import CData
from brace.native.limb import firmware_limb, status_text
from brace.stiffness.at_rest import E_SINGULAR, PostureError
from brace.stiffness.names import PLANAR_C, PLANAR_K, PLANAR_REST
from brace.stiffness.hardening import Spring, settle
from brace.stiffness.sigma import sigma_in_plane

DISPLACEMENT = ("tip_dx_mm", "tip_dz_mm")
LOADED_REST = (*PLANAR_REST, *DISPLACEMENT, "buckling_factor")
NO_REST = (
    "no rest was found: the load may fold the limb or move it further than these equations go, or nothing yields in "
    "some direction"
)
_TIBIA = ("tibia_x_mm", "tibia_z_mm")
_RESULT = np.dtype(
    [(name, "f4") for name in (*PLANAR_K, *PLANAR_REST)]
    + [("flags", "u4")]
    + [(name, "f4") for name in (*DISPLACEMENT, *_TIBIA, "hip_turn_rad", "knee_turn_rad", "buckling_factor")]
)  # brace_loaded_stiffness_t
_ALL = np.dtype(
    [(name, "f4") for name in (*PLANAR_K, *PLANAR_REST, *DISPLACEMENT, "buckling_factor")]
    + [(name, "f8") for name in PLANAR_C]
    + [("flags", np.dtype("u4"))]
)


class LoadedLimb:
    """A limb ready to give K under forces on its tip, in its plane; the weights of [gravity] and the springs' hardening
    count too."""

    def __init__(self, model: LimbModel, arithmetic: str = "f32") -> None:
        """arithmetic: f32, or fixed for the integers of a controller without an FPU."""
        native = library()
        ffi, lib = native.ffi, native.lib
        limb, weights = firmware_limb(native, model), ffi.new("brace_gravity_t *")
        for part in ("femur_n", "knee_n", "tibia_n"):
            setattr(weights, part, model.number(f"gravity.{part}"))
        self._native, self._limb, self._weights = native, limb, weights
        self._loaded, self._joints = ffi.new("brace_loaded_t *"), ffi.new("brace_load_t *")
        lib.brace_loaded_collapse(limb, weights, self._loaded)
        self._is_fixed = arithmetic == "fixed"
        self._fixed = ffi.new("brace_loaded_fixed_t *")
        lib.brace_loaded_fixed_collapse(self._loaded, self._fixed)
        self._reach_mm = limb.femur_mm + limb.tibia_mm
        direction_rad, in_plane = model.number("gravity.direction_rad"), np.cos(model.number("gravity.lean_rad"))
        self._joints.down.x, self._joints.down.z = in_plane * np.cos(direction_rad), in_plane * np.sin(direction_rad)
        self._springs = (
            Spring("hip_turn_rad", self._joints.hip, model, "femur", model.number("base.rotation_rad_per_n_mm")),
            Spring("knee_turn_rad", self._joints.knee, model, "tibia", 0.0),
        )

    def stiffness(
        self, theta1_rad: np.ndarray, theta2_rad: np.ndarray, fx_n: np.ndarray, fz_n: np.ndarray
    ) -> np.ndarray:
        """Structured array, one entry per commanded posture (true angles [rad], the joints not yet turned by the load)
        and force of the ground on the tip [N]. tip_dx_mm, tip_dz_mm: how far force and weight move the tip.
        buckling_factor: infinite where it is above 16, and where it may be above 11. NaN: refused; with the flags
        NEAR_SINGULAR and SOFTENED where no rest is near, with none where the inputs are out of range; see `refusal`."""
        columns = [np.ascontiguousarray(column, np.float32) for column in (theta1_rad, theta2_rad, fx_n, fz_n)]
        if not any(spring.hardens for spring in self._springs):
            return _with_compliance(self._batch(columns))
        rows = ([column[row : row + 1] for column in columns] for row in range(len(columns[0])))
        settled = [settle(self._springs, lambda row=row: self._batch(row)) for row in rows]  # type: ignore[misc]
        return _with_compliance(np.concatenate([np.empty(0, _RESULT), *settled]))

    def sigma(self, theta1_rad: float, theta2_rad: float, fx_n: float, fz_n: float) -> dict[str, float | None]:
        """One sigma of K at a posture and load, from the model's [uncertainty]."""
        self.stiffness(*(np.array([value]) for value in (theta1_rad, theta2_rad, fx_n, fz_n)))  # springs harden so
        self._joints.tip.x_n, self._joints.tip.z_n = fx_n, fz_n
        return sigma_in_plane(self._native, self._limb, self._weights, theta1_rad, theta2_rad, self._joints)

    def _batch(self, columns: list[np.ndarray]) -> np.ndarray:
        ffi, lib = self._native.ffi, self._native.lib
        found = np.empty(len(columns[0]), _RESULT)
        rows = (
            self._joints,
            len(found),
            *(ffi.from_buffer("float[]", column) for column in columns),
            ffi.cast("brace_loaded_stiffness_t *", ffi.from_buffer(found)),
        )
        if self._is_fixed:
            lib.brace_loaded_fixed_batch(self._fixed, self._reach_mm, *rows)
        else:
            lib.brace_loaded_batch(self._loaded, *rows)
        return found

    def rest_at(self, theta_rad: tuple[float, float], force_n: tuple[float, float]) -> tuple[CData, CData, CData]:
        """brace_loaded_stiffness_t at true angles under a force on the tip, the load, and the weights. Raises
        PostureError where there is no rest."""
        ffi = self._native.ffi
        row = [np.array([value], np.float32) for value in (*theta_rad, *force_n)]
        hardens = any(spring.hardens for spring in self._springs)
        found = settle(self._springs, lambda: self._batch(row)) if hardens else self._batch(row)
        if np.isnan(found["k_xx_n_per_mm"][0]):
            raise self.refusal(0, *theta_rad, *force_n)
        self._joints.tip.x_n, self._joints.tip.z_n = force_n
        rest = ffi.new("brace_loaded_stiffness_t *")
        ffi.memmove(rest, ffi.from_buffer(found), ffi.sizeof("brace_loaded_stiffness_t"))
        return rest, self._joints, self._weights

    def refusal(self, index: int, theta1_rad: float, theta2_rad: float, fx_n: float, fz_n: float) -> PostureError:
        """Why a posture has no K; `index` is its place among others."""
        for spring in self._springs:
            spring.carries(0.0)
        single, lib = self._native.ffi.new("brace_loaded_stiffness_t *"), self._native.lib
        self._joints.tip.x_n, self._joints.tip.z_n = fx_n, fz_n
        given = (theta1_rad, theta2_rad, self._joints, single)
        if self._is_fixed:
            status = lib.brace_loaded_fixed_stiffness(self._fixed, *given)
        else:
            status = lib.brace_loaded_stiffness(self._loaded, *given)
        if status == E_SINGULAR:
            return PostureError(index, status, NO_REST)
        return PostureError(index, status, status_text(self._native, status))


def stiffness_under_load(
    model: LimbModel,
    theta1_rad: np.ndarray,
    theta2_rad: np.ndarray,
    fx_n: np.ndarray,
    fz_n: np.ndarray,
    *,
    arithmetic: str = "f32",
) -> np.ndarray:
    """LoadedLimb.stiffness; raises PostureError for the first posture or force that is out of range. A row without a
    rest has NaN and the flags that say so."""
    limb = LoadedLimb(model, arithmetic)
    found = limb.stiffness(theta1_rad, theta2_rad, fx_n, fz_n)
    beyond = without_rest(found) & (found["flags"] == 0)
    if beyond.any():
        first = int(np.argmax(beyond))
        raise limb.refusal(first, *(float(column[first]) for column in (theta1_rad, theta2_rad, fx_n, fz_n)))
    return found


def without_rest(found: np.ndarray) -> np.ndarray:
    """Which rows have no K."""
    return np.asarray(np.isnan(found["k_xx_n_per_mm"]))


def _with_compliance(found: np.ndarray) -> np.ndarray:
    """C is K's inverse."""
    result = np.empty(len(found), _ALL)
    for name in (*PLANAR_K, *LOADED_REST, "flags"):
        result[name] = found[name]
    xx, xz, zz = (found[name].astype(float) for name in PLANAR_K)
    det = xx * zz - xz * xz
    for name, entry in zip(PLANAR_C, (zz, -xz, xx)):
        result[name] = entry / det
    return result
