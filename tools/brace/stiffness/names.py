"""Names of K's entries and of what comes with them. They stand apart because `brace sim` starts without numpy."""

from __future__ import annotations

PLANAR_K = ("k_xx_n_per_mm", "k_xz_n_per_mm", "k_zz_n_per_mm")
PLANAR_C = ("c_xx_mm_per_n", "c_xz_mm_per_n", "c_zz_mm_per_n")
PLANAR_REST = ("lambda_min_n_per_mm", "lambda_max_n_per_mm", "stiff_axis_rad")
SPATIAL_K = tuple(f"k_{axes}_n_per_mm" for axes in ("xx", "xy", "xz", "yy", "yz", "zz"))
SPATIAL_C = tuple(f"c_{axes}_mm_per_n" for axes in ("xx", "xy", "xz", "yy", "yz", "zz"))
SPATIAL_REST = (
    "lambda_min_n_per_mm",
    "lambda_mid_n_per_mm",
    "lambda_max_n_per_mm",
    "stiff_axis_x",
    "stiff_axis_y",
    "stiff_axis_z",
)
