"""K at many postures, by the firmware's own C."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import overload

import numpy as np

from brace.ground.errors import BadFileError, UsageError
from brace.model import LimbModel
from brace.native import Library, library
from brace.native.c_data import CData
from brace.native.limb import firmware_limb, refused_limb, status_text
from brace.stiffness.names import PLANAR_C, PLANAR_K, PLANAR_REST, SPATIAL_C, SPATIAL_K, SPATIAL_REST
from brace.wire.codes import FLAG

ARITHMETICS = ("f32", "fixed", "general")
E_RANGE, E_UNREACHABLE, E_SINGULAR, E_UNSUPPORTED = -3, -4, -6, -8
Q28 = float(1 << 28)
FIXED_LIMIT_RAD = 7.99999999

_PLANAR = np.dtype([(name, "f4") for name in (*PLANAR_K, *PLANAR_REST)] + [("flags", "u4")])
_PLANAR_ALL = np.dtype(
    [(name, "f4") for name in (*PLANAR_K, *PLANAR_REST, *PLANAR_C)] + [("flags", np.dtype("u4"))]
)
_SPATIAL = np.dtype([(name, "f4") for name in (*SPATIAL_K, *SPATIAL_REST)] + [("flags", "u4")])
SIGMA = (
    "sigma_k_xx_n_per_mm",
    "sigma_k_xz_n_per_mm",
    "sigma_k_zz_n_per_mm",
    "sigma_lambda_min_n_per_mm",
    "sigma_lambda_max_n_per_mm",
    "sigma_stiff_axis_rad",
)


ACROSS = (
    "joint.coxa.compliance_rad_per_n_mm",
    *(f"link.{link}.lateral_mm_per_n" for link in ("coxa", "femur", "tibia")),
    *(f"link.{link}.torsion_rad_per_n_mm" for link in ("coxa", "femur")),
)


class PostureError(Exception):
    """Posture number `index` was refused with `status`; the caller knows where it came from."""

    def __init__(self, index: int, status: int, text: str) -> None:
        super().__init__(text)
        self.index, self.status, self.text = index, status, text


def flag_names(flags: int) -> list[str]:
    """The names of the quality bits that are set."""
    return list(FLAG.names_of_bits(flags))


@overload
def within_half_turn(angle_rad: float) -> float: ...
@overload
def within_half_turn(angle_rad: np.ndarray) -> np.ndarray: ...
def within_half_turn(angle_rad: float | np.ndarray) -> float | np.ndarray:
    """The same direction in [-pi, pi]; what lies there already is left as it is, bit for bit."""
    turned = np.remainder(np.asarray(angle_rad) + np.pi, 2 * np.pi) - np.pi
    kept = np.where(np.abs(angle_rad) <= np.pi, angle_rad, turned)
    return kept if np.ndim(angle_rad) else float(kept)


@dataclass(frozen=True)
class PlanarLimb:
    """A limb ready to give K in its plane. `path` says which of the firmware's functions answers."""

    native: Library
    limb: CData
    chain: CData
    path: str
    _evaluate: Callable[[float, float, CData], int]

    def true_angles(self, theta1_rad: np.ndarray, theta2_rad: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Commanded angles with the joints' zero offsets added."""
        offset = [self.native.lib.brace_limb_true_angle(self.limb, joint, 0.0) for joint in (1, 2)]
        return theta1_rad + offset[0], theta2_rad + offset[1]

    def stiffness(self, theta1_rad: np.ndarray, theta2_rad: np.ndarray) -> np.ndarray:
        """Structured array, one entry per posture of true angles [rad]: K, eigenvalues, axis, flags and C.
        Raises PostureError for the first posture that is refused."""
        batch = self._by_the_chain(theta1_rad, theta2_rad)
        if self.path != "general":
            self._replace_k(batch, theta1_rad, theta2_rad)
        lost = np.isnan(batch["k_xx_n_per_mm"])
        if lost.any():
            self._refuse(int(np.argmax(lost)), theta1_rad, theta2_rad)
        return batch

    def _by_the_chain(self, theta1_rad: np.ndarray, theta2_rad: np.ndarray) -> np.ndarray:
        """K and C of the compliance chain; NaN where it refuses."""
        ffi, count = self.native.ffi, len(theta1_rad)
        columns = {name: np.empty(count, np.float32) for name in (*PLANAR_K, *PLANAR_REST, *PLANAR_C)}
        flags = np.empty(count, np.uint32)
        pointers = {name: ffi.from_buffer("float[]", column) for name, column in columns.items()}
        angles = [np.ascontiguousarray(angle, np.float32) for angle in (theta1_rad, theta2_rad)]
        self.native.lib.brace_chain_batch(
            self.chain,
            count,
            *(ffi.from_buffer("float[]", angle) for angle in angles),
            ffi.new("brace_stiffness_soa_t *", {name: pointers[name] for name in (*PLANAR_K, *PLANAR_REST)}),
            ffi.new("brace_compliance_soa_t *", {name: pointers[name] for name in PLANAR_C}),
            ffi.from_buffer("uint32_t[]", flags),
        )
        result = np.empty(count, _PLANAR_ALL)
        for name, column in columns.items():
            result[name] = column
        result["flags"] = flags
        return result

    def _replace_k(self, result: np.ndarray, theta1_rad: np.ndarray, theta2_rad: np.ndarray) -> None:
        """K and all that follows from it as the chosen arithmetic gives it; C stays the chain's."""
        k = self.native.ffi.new("brace_stiffness_t[]", len(result))
        evaluate = self._evaluate
        for index, (theta1, theta2) in enumerate(zip(theta1_rad.tolist(), theta2_rad.tolist())):
            status = evaluate(theta1, theta2, k + index)
            if status:
                raise PostureError(index, status, status_text(self.native, status))
        values = _array(self.native, k, _PLANAR)
        for name in _PLANAR.names or ():
            result[name] = values[name]

    def _refuse(self, index: int, theta1_rad: np.ndarray, theta2_rad: np.ndarray) -> None:
        single = self.native.ffi.new("brace_stiffness_t *")
        status = self._evaluate(float(theta1_rad[index]), float(theta2_rad[index]), single)
        raise PostureError(index, status, status_text(self.native, status))

    def sigma(self, theta1_rad: float, theta2_rad: float) -> dict[str, float]:
        """One sigma of each entry, from the model's [uncertainty]; true angles [rad]. Empty where there is no K."""
        found = self._with_sigma(theta1_rad, theta2_rad)
        return {} if found is None else {name: float(getattr(found[1], name.removeprefix("sigma_"))) for name in SIGMA}

    def relative_sigmas(self, theta1_rad: float, theta2_rad: float) -> tuple[float, float] | None:
        """One sigma of lambda_min and of lambda_max, each as a fraction of it; None where there is no K. Ten times as
        fast as `sigma` and `stiffness`, for a page that shows moving limbs."""
        found = self._with_sigma(theta1_rad, theta2_rad)
        if found is None:
            return None
        k, sigma = found
        return sigma.lambda_min_n_per_mm / k.lambda_min_n_per_mm, sigma.lambda_max_n_per_mm / k.lambda_max_n_per_mm

    def _with_sigma(self, theta1_rad: float, theta2_rad: float) -> tuple[CData, CData] | None:
        stiffness = self.native.ffi.new("brace_stiffness_t *")
        sigma = self.native.ffi.new("brace_stiffness_sigma_t *")
        status = self._evaluate(
            theta1_rad, theta2_rad, stiffness
        ) or self.native.lib.brace_uncertainty_stiffness(self.limb, theta1_rad, theta2_rad, stiffness, sigma)
        return None if status else (stiffness, sigma)

    def posture(self, r_mm: float, phi_rad: float, knee: str) -> tuple[float, float]:
        """True angles that put the tip at polar (r, phi). Raises PostureError."""
        ffi, lib = self.native.ffi, self.native.lib
        polar = ffi.new("brace_polar_t *", {"r_mm": r_mm, "phi_rad": phi_rad})
        theta = ffi.new("float[2]")
        branch = lib.BRACE_KNEE_UP if knee == "up" else lib.BRACE_KNEE_DOWN
        status = lib.brace_kinematics_inverse_polar(self.limb, polar[0], branch, theta, theta + 1)
        if status:
            raise PostureError(0, status, status_text(self.native, status))
        return float(theta[0]), float(theta[1])

    def postures(self, places_mm: np.ndarray, knee: np.ndarray) -> np.ndarray:
        """True angles [rad] that put the tip at places x, z, one row each, each with a knee "up" or "down"; NaN where
        it does not reach."""
        ffi, lib = self.native.ffi, self.native.lib
        bends = np.where(knee == "up", lib.BRACE_KNEE_UP, lib.BRACE_KNEE_DOWN).astype(np.uint8)
        columns = [np.ascontiguousarray(column, np.float32) for column in places_mm.T]
        found = np.empty((2, len(places_mm)), np.float32)
        lib.brace_kinematics_inverse_batch(
            self.limb,
            len(places_mm),
            *(ffi.from_buffer("float[]", column) for column in columns),
            ffi.from_buffer("uint8_t[]", bends),
            *(ffi.from_buffer("float[]", column) for column in found),
        )
        return found.T.astype(float)

    def pose(self, theta1_rad: float, theta2_rad: float) -> tuple[tuple[float, float], tuple[float, float]]:
        """Where knee and tip are at true angles, x and z each [mm]. Raises PostureError."""
        pose = self.native.ffi.new("brace_pose_t *")
        status = self.native.lib.brace_kinematics_forward(self.limb, theta1_rad, theta2_rad, pose)
        if status:
            raise PostureError(0, status, status_text(self.native, status))
        return (float(pose.knee.x_mm), float(pose.knee.z_mm)), (float(pose.tip.x_mm), float(pose.tip.z_mm))

    def polar(self, theta1_rad: float, theta2_rad: float) -> tuple[float, float]:
        """(r [mm], phi [rad]) of the tip at true angles."""
        ffi, lib = self.native.ffi, self.native.lib
        pose, polar = ffi.new("brace_pose_t *"), ffi.new("brace_polar_t *")
        status = lib.brace_kinematics_forward(
            self.limb, theta1_rad, theta2_rad, pose
        ) or lib.brace_kinematics_polar(pose.tip, polar)
        if status:
            raise PostureError(0, status, status_text(self.native, status))
        return float(polar.r_mm), float(polar.phi_rad)


def planar_limb(model: LimbModel, arithmetic: str = "f32") -> PlanarLimb:
    """Prepares the limb. f32 is the controller's path, or the general one for a limb that needs it; fixed is the
    path without FPU; general evaluates the compliance chain directly."""
    native = library()
    ffi, lib = native.ffi, native.lib
    limb = firmware_limb(native, model)
    chain = ffi.new("brace_chain_t *")
    status = lib.brace_chain_build(limb, chain)
    path = "general" if status else arithmetic

    def general(theta1: float, theta2: float, out: CData) -> int:
        return int(lib.brace_chain_stiffness(chain, theta1, theta2, out))

    evaluate = general
    if path == "f32":
        planar = ffi.new("brace_planar_t *")
        status = lib.brace_planar_collapse(limb, planar)
        path = "f32" if status == 0 else "general"
        if status == 0:

            def evaluate(theta1: float, theta2: float, out: CData) -> int:
                return int(lib.brace_planar_stiffness(planar, theta1, theta2, out))

        elif status == E_UNSUPPORTED:
            status = 0
    elif path == "fixed":
        fixed = ffi.new("brace_planar_fixed_t *")
        status = lib.brace_planar_fixed_collapse(limb, fixed)

        def evaluate(theta1: float, theta2: float, out: CData) -> int:
            if max(abs(theta1), abs(theta2)) > FIXED_LIMIT_RAD:
                return E_RANGE
            return int(lib.brace_planar_fixed_stiffness(fixed, round(theta1 * Q28), round(theta2 * Q28), out))

    if status == E_UNSUPPORTED:
        raise UsageError(
            f"--arith {arithmetic} cannot serve this limb",
            where=model.where(),
            why=status_text(native, status),
            next_step="--arith f32 or general",
        )
    if status:
        raise refused_limb(native, model, status)
    return PlanarLimb(native, limb, chain, path, evaluate)


def spatial_stiffness(
    model: LimbModel, theta0_rad: np.ndarray, theta1_rad: np.ndarray, theta2_rad: np.ndarray
) -> np.ndarray:
    """The same in space, commanded angles; C is K's inverse. Raises PostureError."""
    native = library()
    ffi, lib = native.ffi, native.lib
    limb = firmware_limb(native, model)
    require_yield_across(model)
    spatial = ffi.new("brace_spatial_t *")
    status = lib.brace_spatial_collapse(limb, spatial)
    if status:
        raise refused_limb(native, model, status)
    offset = [lib.brace_limb_true_angle(limb, joint, 0.0) for joint in range(3)]
    theta0_rad, theta1_rad = theta0_rad + offset[0], within_half_turn(theta1_rad + offset[1])
    theta2_rad = theta2_rad + offset[2]
    k = ffi.new("brace_stiffness_spatial_t[]", len(theta0_rad))
    for index, angles in enumerate(zip(theta0_rad.tolist(), theta1_rad.tolist(), theta2_rad.tolist())):
        status = lib.brace_spatial_stiffness(spatial, *angles, k + index)
        if status:
            raise PostureError(index, status, status_text(native, status))
    values = _array(native, k, _SPATIAL)
    return joined(values, spatial_compliance(values))


def yields_across(model: LimbModel) -> bool:
    """Whether something yields out of the limb's plane: such a limb has K in space."""
    return any(np.float32(model.number(key)) > 0.0 for key in ACROSS)


def require_yield_across(model: LimbModel) -> None:
    """Refuses a limb that is rigid across its plane."""
    if yields_across(model):
        return
    raise BadFileError(
        "this limb has no K in space: nothing yields out of its plane",
        where=model.where("joint.coxa"),
        why="its lateral compliances and the coxa joint's are zero, so K across the plane is infinite",
        next_step="add [joint.coxa] compliance_rad_per_n_mm or [link.femur] lateral_mm_per_n (any link), or leave "
        "theta0 out for K in the plane",
    )


def spatial_compliance(k: np.ndarray) -> np.ndarray:
    """C, the inverse of K in space."""
    xx, xy, xz, yy, yz, zz = (k[name].astype(float) for name in SPATIAL_K)
    full = np.stack([np.stack([xx, xy, xz], -1), np.stack([xy, yy, yz], -1), np.stack([xz, yz, zz], -1)], -2)
    inverse = np.linalg.inv(full)
    result = np.empty(len(k), np.dtype([(name, "f8") for name in SPATIAL_C]))
    for name, (row, column) in zip(SPATIAL_C, ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))):
        result[name] = inverse[:, row, column]
    return result


def _array(native: Library, structs: CData, kind: np.dtype[np.void]) -> np.ndarray:
    return np.frombuffer(native.ffi.buffer(structs), dtype=kind).copy()


def joined(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Two structured arrays side by side, flags last."""
    source = {name: array for array in (first, second) for name in array.dtype.names or () if name != "flags"}
    kinds = [(name, array.dtype[name]) for name, array in source.items()] + [("flags", np.dtype("u4"))]
    joined = np.empty(len(first), np.dtype(kinds))
    for name, array in source.items():
        joined[name] = array[name]
    joined["flags"] = first["flags"]
    return joined
