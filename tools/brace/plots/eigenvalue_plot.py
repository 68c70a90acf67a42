"""The paper's Fig. 13 over its Fig. 10: measured eigenvalues with intervals, the model's curves, and convexity."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from brace.plots.figure import FAINT, INK, SOFT, STIFF, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Measured:
    """One eigenvalue of each table row: value, low, high [N/mm]; `sound` is false where the entry was corrected,
    `determined` is false where print rounding leaves it open, `bent` true where the sequence is not convex,
    `breaks` where it is not even quasi-convex beyond print rounding."""

    value: np.ndarray
    low: np.ndarray
    high: np.ndarray
    determined: np.ndarray
    bent: np.ndarray
    breaks: np.ndarray


def eigenvalue_figure(r_mm: np.ndarray, largest: Measured, smallest: Measured, corrected: np.ndarray,
                      curve_r_mm: np.ndarray, curve_largest: np.ndarray, curve_smallest: np.ndarray,
                      band_r_mm: np.ndarray, band_largest: np.ndarray, band_smallest: np.ndarray, *,
                      coupling_low_ratio: float) -> Figure:
    """r_mm: rows; corrected: rows, true where an entry was repaired; curves: the identified limb over r; bands: its
    90 % band, points x (low, high). coupling_low_ratio: by how much of itself a typical row's |K_xz| would have to be
    smaller for its lambda_min to be the curve's."""
    figure = new_figure(8.2, 7.0)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(1.25, 1))
    _draw(upper, r_mm, largest, corrected, curve_r_mm, curve_largest, STIFF)
    _draw_band(upper, band_r_mm, band_largest)
    upper.set(ylabel="lambda_max [N/mm]", yscale="log", yticks=(2, 3, 5, 10, 20, 30, 50))
    upper.yaxis.set_major_formatter("{x:g}")
    upper.yaxis.set_minor_formatter("")
    upper.set_title("Larger eigenvalue of K over the reach, and where convexity and quasi-convexity fail", loc="left",
                    fontsize=10)
    _draw(lower, r_mm, smallest, corrected, curve_r_mm, curve_smallest, SOFT)
    _draw_band(lower, band_r_mm, band_smallest)
    top = max(1.6 * float(smallest.value.max()), 1.6 * float(curve_smallest.max()), 1.05 * float(band_smallest.max()))
    lower.set(ylabel="lambda_min [N/mm]", xlabel="r [mm]", ylim=(-0.1 * top, top))
    low_here = np.interp(r_mm, band_r_mm, band_smallest[:, 0])
    below = int(np.sum(smallest.value <= low_here))
    lower.set_title("Smaller eigenvalue: bars are print rounding alone, hollow = not determined\n"
                    f"{below} of {r_mm.size} lie at or below the band: the fit weighs the entries of K, and lambda_min is "
                    "what they leave.\nBeside its own K_xx and K_zz, the table's |K_xz| is "
                    f"{100 * coupling_low_ratio:.0f} % (median) larger than the curve's lambda_min allows.",
                    loc="left", fontsize=9)
    return figure


def _draw_band(axes: Axes, r_mm: np.ndarray, band: np.ndarray) -> None:
    axes.fill_between(r_mm, band[:, 0], band[:, 1], color=INK, alpha=0.12, linewidth=0, zorder=0.5)


def _draw(axes: Axes, r_mm: np.ndarray, measured: Measured, corrected: np.ndarray, curve_r_mm: np.ndarray,
          curve: np.ndarray, colour: str) -> None:
    axes.plot(curve_r_mm, curve, color=INK, linewidth=1.3, label="identified limb, 90 % band")
    low, high = measured.value - measured.low, measured.high - measured.value
    axes.errorbar(
        r_mm, measured.value, yerr=np.vstack([low, high]), fmt="none", ecolor=colour, elinewidth=1.2, capsize=3
    )
    solid = measured.determined
    axes.plot(r_mm[solid], measured.value[solid], "o", color=colour, label="Table I")
    axes.plot(r_mm[~solid], measured.value[~solid], "o", color=colour, markerfacecolor="white")
    axes.plot(r_mm[corrected], measured.value[corrected], "s", color=colour, markersize=11, markerfacecolor="none",
              label="row with a corrected misprint")
    for r in r_mm[measured.bent]:
        axes.axvline(r, color=FAINT, linewidth=5, alpha=0.5, zorder=0)
    if measured.bent.any():
        axes.plot([], [], color=FAINT, linewidth=5, alpha=0.5, label="not strictly convex here")
    axes.plot(r_mm[measured.breaks], measured.value[measured.breaks], "v", color=INK, markersize=6, linestyle="none",
              label="falls after the minimum: not quasi-convex" if measured.breaks.any() else "_")
    axes.legend(loc="best")
