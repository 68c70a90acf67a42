"""The workspace: eigenvalues over r as in the paper's Fig. 10, and the ellipses of K where the tip can be."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from brace.plots.figure import FAINT, INK, SOFT, STIFF, new_figure, round_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def workspace_figure(
    name: str,
    r_mm: np.ndarray,
    lambda_min: np.ndarray,
    lambda_max: np.ndarray,
    ellipses: dict[str, np.ndarray],
    links: np.ndarray,
) -> Figure:
    """lambda_min, lambda_max: rows x (low, middle, high) [N/mm] at r [mm]; ellipses: x_mm, z_mm, lambda_min_n_per_mm,
    lambda_max_n_per_mm, stiff_axis_rad, one entry each; links: postures x 3 points x (x, z) [mm] to draw."""
    figure = new_figure(10.5, 4.8)
    curves, plane = figure.subplots(1, 2, width_ratios=(1.15, 1))
    draw_eigenvalues(curves, r_mm, lambda_min, lambda_max)
    curves.set_title(f"{name}: eigenvalues of K over the reach", loc="left", fontsize=10)
    draw_ellipses(plane, ellipses, links)
    plane.set_title("ellipses of K", loc="left", fontsize=10)
    return figure


def draw_eigenvalues(axes: Axes, r_mm: np.ndarray, lambda_min: np.ndarray, lambda_max: np.ndarray) -> None:
    """Both eigenvalues over r; a band where they depend on theta1, as with a yielding base."""
    for values, colour, label in ((lambda_max, STIFF, "lambda_max"), (lambda_min, SOFT, "lambda_min")):
        axes.plot(r_mm, values[:, 1], color=colour, label=label)
        if np.any(values[:, 2] > values[:, 0] * 1.001):
            axes.fill_between(r_mm, values[:, 0], values[:, 2], color=colour, alpha=0.2, linewidth=0)
    axes.set(yscale="log", xlabel="r [mm]", ylabel="eigenvalues of K [N/mm]")
    axes.legend()


def draw_ellipses(axes: Axes, ellipses: dict[str, np.ndarray], links: np.ndarray) -> None:
    """One ellipse per posture, long axis along the stiff direction, scaled to the picture."""
    from matplotlib.collections import EllipseCollection, LineCollection

    axes.add_collection(LineCollection(list(links), colors=FAINT, linewidths=2.0, capstyle="round"))
    long_axis, short_axis = (np.sqrt(ellipses[f"lambda_{which}_n_per_mm"]) for which in ("max", "min"))
    if not long_axis.size:
        return
    span = max(np.ptp(ellipses["x_mm"]), np.ptp(ellipses["z_mm"]), 1.0)
    scale = 0.14 * span / float(np.median(long_axis)) if long_axis.size else 1.0
    longest = 0.3 * span
    factor = np.minimum(scale, longest / long_axis)
    axes.add_collection(
        EllipseCollection(
            long_axis * factor,
            short_axis * factor,
            np.degrees(ellipses["stiff_axis_rad"]),
            units="xy",
            offsets=np.column_stack([ellipses["x_mm"], ellipses["z_mm"]]),
            offset_transform=axes.transData,
            facecolors=STIFF + "30",
            edgecolors=STIFF,
            linewidths=0.9,
        )
    )
    axes.plot([0], [0], "o", color=INK, markersize=4, label="femur joint")
    room = 0.53 * longest * np.array([-1.0, 1.0])
    x_limits, z_limits = (
        np.array([min(ellipses[name].min(), 0.0), ellipses[name].max()]) + room for name in ("x_mm", "z_mm")
    )
    axes.set(xlabel="x [mm]", ylabel="z [mm]", aspect="equal", xlim=x_limits, ylim=z_limits)
    _draw_scale(axes, scale, float(np.median(long_axis)) ** 2)


def _draw_scale(axes: Axes, mm_per_root: float, typical_n_per_mm: float) -> None:
    """How long an ellipse of a round stiffness is, and what the grey lines are. Ellipses of more than twice the typical
    length are drawn shorter."""
    round_n_per_mm = round_below(typical_n_per_mm)
    axes.plot([], [], color=FAINT, linewidth=2.0, label="femur and tibia at some postures")
    axes.plot([], [], color=STIFF, linewidth=0.9, label=f"axes as the root of eigenvalues; bar: {round_n_per_mm:g} N/mm")
    low_x, low_z = axes.get_xlim()[0], axes.get_ylim()[0]
    room = 0.04 * (axes.get_xlim()[1] - low_x)
    length = mm_per_root * np.sqrt(round_n_per_mm)
    axes.plot([low_x + room, low_x + room + length], [low_z + room, low_z + room], color=STIFF, linewidth=2.5)
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, -0.14), fontsize=8, ncols=1)
