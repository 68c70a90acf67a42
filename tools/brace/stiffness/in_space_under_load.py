"""K in space under a load at the limb's equilibrium, by the firmware's own C (brace/loaded_space.h)."""

from __future__ import annotations

import math

import numpy as np

from brace.model import LimbModel
from brace.native import library
from brace.native.c_data import CData
from brace.native.limb import firmware_limb, status_text
from brace.stiffness.at_rest import (
    E_SINGULAR,
    PostureError,
    joined,
    require_yield_across,
    spatial_compliance,
    within_half_turn,
)
from brace.stiffness.hardening import Spring, settle
from brace.stiffness.names import SPATIAL_K, SPATIAL_REST
from brace.stiffness.sigma import sigma_in_space
from brace.stiffness.under_load import NO_REST

DISPLACEMENT = ("tip_dx_mm", "tip_dy_mm", "tip_dz_mm")
LOADED_SPACE_REST = (*SPATIAL_REST, *DISPLACEMENT, "buckling_factor")
_TURNS = ("yaw_turn_rad", "hip_turn_rad", "knee_turn_rad")
_RESULT = np.dtype(
    [(name, "f4") for name in (*SPATIAL_K, *LOADED_SPACE_REST, *_TURNS)] + [("flags", "u4"), ("status", "i4")]
)


class LoadedLimbInSpace:
    """A limb ready to give K in space under forces on its tip; the weights of [gravity] and the springs' hardening
    count too."""

    def __init__(self, model: LimbModel, is_weightless: bool = False) -> None:
        require_yield_across(model)
        native = library()
        ffi, lib = native.ffi, native.lib
        limb, weights = firmware_limb(native, model), ffi.new("brace_gravity_t *")
        for part in ("femur_n", "knee_n", "tibia_n"):
            setattr(weights, part, 0.0 if is_weightless else model.number(f"gravity.{part}"))
        self._native, self._limb, self._weights = native, limb, weights
        self._loaded, self._load = ffi.new("brace_loaded_space_t *"), ffi.new("brace_space_load_t *")
        self._rest, self._found = ffi.new("brace_space_rest_t *"), ffi.new("brace_space_result_t *")
        self._turned = ffi.new("brace_stiffness_spatial_t *")
        lib.brace_loaded_space_collapse(limb, weights, self._loaded)
        direction_rad, lean_rad = model.number("gravity.direction_rad"), model.number("gravity.lean_rad")
        down = self._load.down
        down.x, down.z = np.cos(lean_rad) * np.cos(direction_rad), np.cos(lean_rad) * np.sin(direction_rad)
        down.y = np.sin(lean_rad)
        joints = (self._load.yaw, self._load.hip, self._load.knee)
        self._springs = [
            Spring(turn, joint, model, part, 0.0)
            for turn, joint, part in zip(_TURNS, joints, ("coxa", "femur", "tibia"))
        ]
        self._reach_mm = limb.femur_mm + limb.tibia_mm
        self._offset_rad = [lib.brace_limb_true_angle(limb, joint, 0.0) for joint in range(3)]

    def stiffness(self, theta_rad: np.ndarray, force_n: np.ndarray) -> np.ndarray:
        """Structured array, one entry per row of theta_rad (commanded theta0, theta1, theta2; the zero offsets are
        added) and of force_n (force of the ground on the tip in the limb's plane: outwards, to the left of it, up).

        K, eigenvalues, stiff axis and C are in the robot's frame; tip_dx_mm, tip_dy_mm, tip_dz_mm, how far force and
        weight move the tip, in the plane's. buckling_factor: infinite where it is above 16, and where it may be above
        11. A row without a rest has NaN and the flags NEAR_SINGULAR and SOFTENED. Raises PostureError for the first
        posture or force that is out of range."""
        true_rad = self._true(theta_rad)
        hardens = any(spring.hardens for spring in self._springs)
        rows = []
        for index, (theta, force) in enumerate(zip(true_rad.tolist(), np.asarray(force_n, float).tolist())):
            found = settle(self._springs, lambda: self._one(theta, force)) if hardens else self._one(theta, force)
            status = int(found["status"][0])
            if status not in (0, E_SINGULAR):
                raise PostureError(index, status, status_text(self._native, status))
            rows.append(found if status == 0 else self._without_rest())
        result = np.concatenate([np.empty(0, _RESULT), *rows])
        return joined(result[[*SPATIAL_K, *LOADED_SPACE_REST, "flags"]], spatial_compliance(result))

    def _true(self, theta_rad: np.ndarray) -> np.ndarray:
        true_rad: np.ndarray = np.asarray(theta_rad, float) + self._offset_rad
        true_rad[:, 1] = within_half_turn(true_rad[:, 1])
        return true_rad

    def rest_at(self, theta_rad: np.ndarray, force_n: np.ndarray) -> tuple[list[float], CData, CData, CData, CData]:
        """At the one row of theta_rad and force_n: true angles, limb, weights, load, and brace_space_result_t. Raises
        PostureError where there is no rest."""
        found = self.stiffness(theta_rad, force_n)
        if np.isnan(found[SPATIAL_K[0]][0]):
            raise self.refusal(0)
        return self._true(theta_rad)[0].tolist(), self._limb, self._weights, self._load, self._found

    def sigma(self, theta_rad: np.ndarray, force_n: np.ndarray) -> dict[str, float | None]:
        """One sigma of K, from the model's [uncertainty], at the one row of theta_rad and force_n."""
        self.stiffness(theta_rad, force_n)  # springs harden so
        load = self._load
        load.tip_n.x, load.tip_n.y, load.tip_n.z = (float(part) for part in force_n[0])
        return sigma_in_space(self._native, self._limb, self._weights, self._true(theta_rad)[0].tolist(), load)

    def spring(self, theta_rad: np.ndarray, force_n: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
        """At one posture and force as `stiffness` has them: K's entries (xx, xy, xz, yy, yz, zz) and the tip's
        displacement, both in the limb's plane's frame; None where it has no rest. A third of `stiffness`'s time:
        nothing else is worked out. Raises PostureError."""
        if any(spring.hardens for spring in self._springs):
            if np.isnan(self.stiffness(theta_rad[None, :], force_n[None, :])[SPATIAL_K[0]][0]):
                return None
        else:
            true_rad = (theta_rad + self._offset_rad).tolist()
            true_rad[2] = math.remainder(true_rad[2], 2.0 * math.pi)
            status = self._settle(true_rad, force_n.tolist())
            if status == E_SINGULAR:
                return None
            if status:
                raise PostureError(0, status, status_text(self._native, status))
        k, moved = self._found.k, self._found.displacement_mm
        entries = (k.xx_n_per_mm, k.xy_n_per_mm, k.xz_n_per_mm, k.yy_n_per_mm, k.yz_n_per_mm, k.zz_n_per_mm)
        return np.array(entries), np.array((moved.x, moved.y, moved.z))

    def refusal(self, index: int) -> PostureError:
        """Why a row without a rest has no K."""
        return PostureError(index, E_SINGULAR, NO_REST)

    def _without_rest(self) -> np.ndarray:
        lib = self._native.lib
        result = np.zeros(1, _RESULT)
        for name in (*SPATIAL_K, *LOADED_SPACE_REST, *_TURNS):
            result[name] = np.nan
        result["flags"] = lib.BRACE_FLAG_NEAR_SINGULAR | lib.BRACE_FLAG_SOFTENED
        return result

    def _settle(self, theta_rad: list[float], force_n: list[float]) -> int:
        """Writes self._found; returns a status."""
        lib, load, rest = self._native.lib, self._load, self._rest
        load.tip_n.x, load.tip_n.y, load.tip_n.z = force_n
        status = lib.brace_loaded_space_settle(self._loaded, theta_rad[1], theta_rad[2], load, rest)
        if status in (0, E_SINGULAR):  # nobody waits: on to what is rounded away, or to a rest that four steps miss
            status = lib.brace_loaded_space_settle_on(self._loaded, rest)
        return int(status or lib.brace_loaded_space_stiffness(self._loaded, rest, self._found))

    def _one(self, theta_rad: list[float], force_n: list[float]) -> np.ndarray:
        """One posture; where it is refused, a status."""
        lib, rest, found, turned = self._native.lib, self._rest, self._found, self._turned
        result = np.zeros(1, _RESULT)
        status = self._settle(theta_rad, force_n)
        status = status or lib.brace_loaded_space_turn(theta_rad[0], self._native.ffi.addressof(found.k), turned)
        result["status"] = status
        if status == 0:
            for name in SPATIAL_K:
                result[name] = getattr(turned, name)
            for part, names in (("lambda_n_per_mm", SPATIAL_REST[:3]), ("stiff_axis", SPATIAL_REST[3:])):
                for i, name in enumerate(names):
                    result[name] = getattr(turned, part)[i]
            moved = found.displacement_mm
            for name, value in zip(DISPLACEMENT, (moved.x, moved.y, moved.z)):
                result[name] = value
            for name in _TURNS:
                result[name] = getattr(found, name)
            factor = lib.brace_loaded_space_buckling_factor(self._loaded, rest)
            result["buckling_factor"] = factor
            result["flags"] = turned.flags | lib.brace_loaded_space_flags(found, factor, self._reach_mm)
        return result
