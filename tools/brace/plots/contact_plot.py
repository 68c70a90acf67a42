"""The paper's Fig. 2: the same sag, two postures; one foot holds and the other slides."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from brace.plots.figure import FAINT, INK, MODEL, STIFF, new_figure
from brace.plots.limb_plot import draw_links

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Footing:
    """points: 3 x 2, femur axis, knee and tip [mm]; force_n: (x, z) of the ledge on the foot; margin_n as the
    firmware's friction-cone margin."""

    title: str
    points: np.ndarray
    force_n: np.ndarray
    margin_n: float
    holds: bool


def contact_figure(footings: Sequence[Footing], friction_ratio: float, sag_mm: float, r_mm: np.ndarray,
                   height_mm: np.ndarray, needed_ratio: np.ndarray) -> Figure:
    """Two postures on a ledge, and over the workspace the friction that a sag needs: needed_ratio is
    rows (theta2) x columns (theta1), at the tip's r_mm and height_mm of the same shape."""
    figure = new_figure(4.0 * len(footings) + 4.6, 4.6)
    panels = figure.subplots(1, len(footings) + 1, width_ratios=[1.0] * len(footings) + [1.25])
    for axes, footing in zip(panels, footings):
        _draw_footing(axes, footing, friction_ratio)
    plane = panels[-1]
    mesh = plane.pcolormesh(r_mm, height_mm, np.minimum(needed_ratio, 2.0), shading="gouraud", cmap="RdYlGn_r",
                            vmin=0.0, vmax=2.0 * friction_ratio, rasterized=True)
    plane.contour(r_mm, height_mm, needed_ratio, levels=[friction_ratio], colors=[INK], linewidths=1.0)
    plane.set(xlabel="x of the foot [mm]", ylabel="z of the foot [mm]", aspect="equal")
    plane.set_title("friction needed, |K_xz| / K_zz; line: what there is", loc="left", fontsize=9)
    figure.colorbar(mesh, ax=plane, shrink=0.8)
    figure.suptitle(f"Choice of stiffness: the body sags {sag_mm:g} mm, friction ratio {friction_ratio:g}", x=0.01,
                    ha="left", fontsize=10)
    return figure


def _draw_footing(axes: Axes, footing: Footing, friction_ratio: float) -> None:
    draw_links(axes, footing.points)
    tip = footing.points[2]
    half = np.arctan(friction_ratio)
    length = 150.0
    for side in (-1.0, 1.0):
        axes.plot([tip[0], tip[0] + side * length * np.sin(half)], [tip[1], tip[1] + length * np.cos(half)], color=INK,
                  linewidth=0.8, linestyle="--")
    axes.plot([tip[0] - 130, tip[0] + 130], [tip[1], tip[1]], color=FAINT, linewidth=8, zorder=0)
    size = float(np.linalg.norm(footing.force_n))
    arrow = footing.force_n / size * length
    colour = MODEL if footing.holds else STIFF
    axes.annotate("", tip + arrow, tip, arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 2.2})
    axes.annotate(f"{size:.1f} N", tip + arrow, xytext=(4, 4), textcoords="offset points", color=colour)
    axes.set(aspect="equal", xlabel="x [mm]", ylabel="z [mm]")
    word = "holds" if footing.holds else "slides"
    axes.set_title(f"{footing.title}\n{word}: margin {footing.margin_n:+.2f} N", loc="left", fontsize=9)
    axes.margins(0.15)
