"""Limbs drawn as two links with ellipses: the paper's Fig. 9."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from brace.plots.figure import FAINT, INK, MODEL, SOFT, STIFF, new_figure, round_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class PosedLimb:
    """points: 3 x 2, femur axis, knee and tip [mm]. Each compliance is 2 x 2 [mm/N]."""

    title: str
    points: np.ndarray
    femur: np.ndarray
    tibia: np.ndarray
    whole: np.ndarray


def ellipse_figure(limbs: Sequence[PosedLimb]) -> Figure:
    """Compliance ellipses of the links and of the whole limb at some postures, one scale for all."""
    from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar  # type: ignore[import-untyped]

    figure = new_figure(3.6 * len(limbs), 4.3)
    largest = max(np.sqrt(np.linalg.eigvalsh(limb.whole).max()) for limb in limbs)
    scale = 120.0 / largest
    for axes, limb in zip(figure.subplots(1, len(limbs), sharex=True, sharey=True), limbs):
        draw_links(axes, limb.points)
        middle_femur, middle_tibia = limb.points[:2].mean(axis=0), limb.points[1:].mean(axis=0)
        _ellipse(axes, middle_femur, limb.femur, scale, MODEL, "femur link")
        _ellipse(axes, middle_tibia, limb.tibia, scale, SOFT, "tibia link")
        _ellipse(axes, limb.points[2], limb.whole, scale, STIFF, "whole limb, joints too")
        axes.set(aspect="equal", xlabel="x [mm]")
        axes.set_title(limb.title, loc="left", fontsize=9)
        axes.autoscale_view()
        axes.margins(0.08)
    figure.axes[0].set_ylabel("z [mm]")
    figure.axes[0].legend(loc="lower left", fontsize=8)
    round_mm_per_n = round_below(largest**2)
    figure.axes[0].add_artist(
        AnchoredSizeBar(
            figure.axes[0].transData,
            scale * np.sqrt(round_mm_per_n),
            f"semi-axis of {round_mm_per_n:g} mm/N",
            "center right",
            frameon=False,
            size_vertical=3.0,
            color=STIFF,
            sep=3,
        )
    )
    figure.suptitle("Compliance ellipses as the limb reaches out (semi-axes as the root of the compliance)",
                    x=0.01, ha="left", fontsize=10)
    return figure


def draw_links(axes: Axes, points: np.ndarray, colour: str = FAINT) -> None:
    """The limb as a line with its joints."""
    axes.plot(points[:, 0], points[:, 1], color=colour, linewidth=5, solid_capstyle="round", zorder=1)
    axes.plot(points[:2, 0], points[:2, 1], "o", color=INK, markersize=5, zorder=3)


def _ellipse(axes: Axes, centre: np.ndarray, compliance: np.ndarray, scale: float, colour: str, label: str) -> None:
    values, vectors = np.linalg.eigh(compliance)
    turn = np.linspace(0.0, 2 * np.pi, 121)
    outline = vectors @ (scale * np.sqrt(np.maximum(values, 0.0))[:, None] * np.vstack([np.cos(turn), np.sin(turn)]))
    axes.fill(
        centre[0] + outline[0], centre[1] + outline[1], facecolor=colour + "35", edgecolor=colour, label=label, zorder=2
    )
