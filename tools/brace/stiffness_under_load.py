"""K under a load at the limb's equilibrium, by the firmware's own C (brace/loaded.h)."""

from __future__ import annotations

import numpy as np

from brace.model import LimbModel
from brace.native import library
from brace.native.c_data import CData
from brace.native.limb import firmware_limb, status_text
from brace.stiffness import E_SINGULAR, PLANAR_C, PLANAR_K, PLANAR_REST, PostureError

DISPLACEMENT = ("tip_dx_mm", "tip_dz_mm")
LOADED_REST = (*PLANAR_REST, *DISPLACEMENT, "buckling_factor")
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


_ROUNDS, _SETTLED = 20, 1e-5  # of hardening springs: at most so many, and by how much one may still move


class LoadedLimb:
    """A limb ready to give K under forces on its tip, in its plane; the weights of [gravity] and the springs' hardening
    count too."""

    def __init__(self, model: LimbModel) -> None:
        native = library()
        ffi, lib = native.ffi, native.lib
        limb, weights = firmware_limb(native, model), ffi.new("brace_gravity_t *")
        for part in ("femur_n", "knee_n", "tibia_n"):
            setattr(weights, part, model.number(f"gravity.{part}"))
        self._native = native
        self._loaded, self._joints = ffi.new("brace_loaded_t *"), ffi.new("brace_load_t *")
        lib.brace_loaded_collapse(limb, weights, self._loaded)
        direction_rad, in_plane = model.number("gravity.direction_rad"), np.cos(model.number("gravity.lean_rad"))
        self._joints.down.x, self._joints.down.z = in_plane * np.cos(direction_rad), in_plane * np.sin(direction_rad)
        self._springs = (
            _Spring("hip_turn_rad", self._joints.hip, model, "femur", model.number("base.rotation_rad_per_n_mm")),
            _Spring("knee_turn_rad", self._joints.knee, model, "tibia", 0.0),
        )
        for spring in self._springs:
            spring.carries(0.0)

    def stiffness(
        self, theta1_rad: np.ndarray, theta2_rad: np.ndarray, fx_n: np.ndarray, fz_n: np.ndarray
    ) -> np.ndarray:
        """Structured array, one entry per commanded posture (true angles [rad], the joints not yet turned by the load)
        and force of the ground on the tip [N]. tip_dx_mm, tip_dz_mm: how far force and weight move the tip.
        buckling_factor: infinite where it is above 16, and where it may be above 11. NaN: refused, see `refusal`."""
        columns = [np.ascontiguousarray(column, np.float32) for column in (theta1_rad, theta2_rad, fx_n, fz_n)]
        if not any(spring.hardens for spring in self._springs):
            return _with_compliance(self._batch(columns))
        rows = ([column[row : row + 1] for column in columns] for row in range(len(columns[0])))
        return _with_compliance(np.concatenate([np.empty(0, _RESULT), *(self._hardened(row) for row in rows)]))

    def _hardened(self, columns: list[np.ndarray]) -> np.ndarray:
        """One posture: how far a hardening spring yields depends on its torque, that a little on how far it yields."""
        for spring in self._springs:
            spring.carries(0.0)
        found = self._batch(columns)
        for _ in range(_ROUNDS):
            moved = [spring.carries(spring.torque_n_mm(found)) for spring in self._springs]
            if not max(moved) > _SETTLED:
                break
            found = self._batch(columns)
        return found

    def _batch(self, columns: list[np.ndarray]) -> np.ndarray:
        ffi = self._native.ffi
        found = np.empty(len(columns[0]), _RESULT)
        self._native.lib.brace_loaded_batch(
            self._loaded,
            self._joints,
            len(found),
            *(ffi.from_buffer("float[]", column) for column in columns),
            ffi.cast("brace_loaded_stiffness_t *", ffi.from_buffer(found)),
        )
        return found

    def refusal(self, index: int, theta1_rad: float, theta2_rad: float, fx_n: float, fz_n: float) -> PostureError:
        """Why a posture has no K; `index` is its place among others."""
        for spring in self._springs:
            spring.carries(0.0)
        single = self._native.ffi.new("brace_loaded_stiffness_t *")
        self._joints.tip.x_n, self._joints.tip.z_n = fx_n, fz_n
        status = self._native.lib.brace_loaded_stiffness(self._loaded, theta1_rad, theta2_rad, self._joints, single)
        if status == E_SINGULAR:
            why = "no stable equilibrium is near: the load folds the limb, or nothing yields in some direction"
            return PostureError(index, status, why)
        return PostureError(index, status, status_text(self._native, status))


class _Spring:
    """A joint's spring, torque = deflection / compliance + hardening deflection^3, as the firmware's C wants it."""

    def __init__(self, turn: str, joint: CData, model: LimbModel, part: str, base_rad_per_n_mm: float) -> None:
        self._turn, self._joint, self._base_rad_per_n_mm = turn, joint, base_rad_per_n_mm
        self._compliance_rad_per_n_mm = model.number(f"joint.{part}.compliance_rad_per_n_mm")
        self._hardening_n_mm_per_rad3 = model.number(f"joint.{part}.hardening_n_mm_per_rad3")

    @property
    def hardens(self) -> bool:
        return self._hardening_n_mm_per_rad3 > 0.0 and self._compliance_rad_per_n_mm > 0.0

    def torque_n_mm(self, found: np.ndarray) -> float:
        """That turned the joint, and with the hip the base."""
        yields = self._joint.yields_by_rad_per_n_mm + self._base_rad_per_n_mm
        return float(found[self._turn][0]) / yields if yields > 0.0 else 0.0

    def carries(self, torque_n_mm: float) -> float:
        """Sets how the joint yields under a torque; by what share that differs from before."""
        slope = yields = self._compliance_rad_per_n_mm
        if self.hardens and torque_n_mm != 0.0 and np.isfinite(torque_n_mm):
            cubic = [self._hardening_n_mm_per_rad3, 0.0, 1.0 / self._compliance_rad_per_n_mm, -torque_n_mm]
            roots = np.roots(cubic)
            deflection_rad = float(roots[np.argmin(np.abs(roots.imag))].real)  # the only real one
            yields = deflection_rad / torque_n_mm
            stiffer_n_mm_per_rad = 3.0 * self._hardening_n_mm_per_rad3 * deflection_rad**2
            slope = 1.0 / (1.0 / self._compliance_rad_per_n_mm + stiffer_n_mm_per_rad)
        moved = abs(yields - self._joint.yields_by_rad_per_n_mm) / yields if yields > 0.0 else 0.0
        self._joint.yields_by_rad_per_n_mm, self._joint.slope_rad_per_n_mm = yields, slope
        return moved


def stiffness_under_load(
    model: LimbModel, theta1_rad: np.ndarray, theta2_rad: np.ndarray, fx_n: np.ndarray, fz_n: np.ndarray
) -> np.ndarray:
    """LoadedLimb.stiffness; raises PostureError for the first posture that is refused."""
    limb = LoadedLimb(model)
    found = limb.stiffness(theta1_rad, theta2_rad, fx_n, fz_n)
    lost = np.isnan(found["k_xx_n_per_mm"])
    if lost.any():
        first = int(np.argmax(lost))
        raise limb.refusal(first, *(float(column[first]) for column in (theta1_rad, theta2_rad, fx_n, fz_n)))
    return found


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
