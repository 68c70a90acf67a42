"""One sigma of K under a load and in space, from a model's [uncertainty], by the firmware's own C
(brace/uncertainty_causes.h)."""

from __future__ import annotations

from brace.native import Library
from brace.native.c_data import CData

_ENTRIES = tuple(f"k_{axes}_n_per_mm" for axes in ("xx", "xy", "xz", "yy", "yz", "zz"))
SIGMA_IN_SPACE = (
    *(f"sigma_{name}" for name in _ENTRIES),
    *(f"sigma_lambda_{which}_n_per_mm" for which in ("min", "mid", "max")),
)
SIGMA_UNDER_LOAD = (
    *(f"sigma_k_{entry}_n_per_mm" for entry in ("xx", "xz", "zz")),
    *(f"sigma_lambda_{which}_n_per_mm" for which in ("min", "max")),
    "sigma_stiff_axis_rad",
)


def sigma_in_plane(
    native: Library, limb: CData, weights: CData, theta1_rad: float, theta2_rad: float, load: CData
) -> dict[str, float | None]:
    """Of K in the limb's plane under a load (brace_load_t), at true angles. None: not known, because K so near has no
    rest under this load."""
    sigma = native.ffi.new("brace_stiffness_sigma_t *")
    if native.lib.brace_uncertainty_loaded(limb, weights, theta1_rad, theta2_rad, load, sigma):
        return dict.fromkeys(SIGMA_UNDER_LOAD)
    return {name: float(getattr(sigma, name.removeprefix("sigma_"))) for name in SIGMA_UNDER_LOAD}


def sigma_in_space(
    native: Library, limb: CData, weights: CData, theta_rad: list[float], load: CData
) -> dict[str, float | None]:
    """Of K in the robot's frame under a load (brace_space_load_t), at true angles. None: as above."""
    ffi, sigma = native.ffi, native.ffi.new("brace_k_sigma_t *")
    if native.lib.brace_uncertainty_loaded_space(limb, weights, ffi.new("float[3]", theta_rad), load, sigma):
        return dict.fromkeys(SIGMA_IN_SPACE)
    space = sigma.space
    entries = [float(getattr(space, name)) for name in _ENTRIES]
    return dict(zip(SIGMA_IN_SPACE, [*entries, *(float(value) for value in space.lambda_n_per_mm)], strict=True))
