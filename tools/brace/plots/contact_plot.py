"""The paper's Fig. 2: the same sag, two postures; one foot holds and the other slides."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from brace.plots.figure import FAINT, INK, SOFT, STIFF, new_figure
from brace.plots.limb_plot import draw_links

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


LEDGE_MM = 260.0
MARGIN_MM = 0.5 * LEDGE_MM + 20.0


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
    figure = new_figure(4.4 * len(footings) + 4.4, 4.2)
    panels = figure.subplots(1, len(footings) + 1)
    corners = np.concatenate([footing.points for footing in footings])
    low, high = corners.min(axis=0) - MARGIN_MM, corners.max(axis=0) + MARGIN_MM
    for axes, footing in zip(panels, footings):
        _draw_footing(axes, footing, friction_ratio, sag_mm)
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    plane = panels[-1]
    mesh = plane.pcolormesh(r_mm, height_mm, np.minimum(needed_ratio, 2.0), shading="gouraud", cmap="RdYlBu_r",
                            vmin=0.0, vmax=2.0 * friction_ratio, rasterized=True)
    plane.contour(r_mm, height_mm, needed_ratio, levels=[friction_ratio], colors=[INK], linewidths=1.0)
    plane.set(xlabel="x of the foot [mm]", ylabel="z of the foot [mm]", aspect="equal")
    plane.set_title(f"friction that any sag needs, |K_xz| / K_zz\nblue holds, red slides; line: the friction there is, "
                    f"{friction_ratio:g}",
                    loc="left", fontsize=9)
    figure.colorbar(mesh, ax=plane, shrink=0.8, label="|K_xz| / K_zz = friction needed", extend="max")
    return figure


def _draw_footing(axes: Axes, footing: Footing, friction_ratio: float, sag_mm: float) -> None:
    draw_links(axes, footing.points)
    tip = footing.points[2]
    half = np.arctan(friction_ratio)
    length = 150.0
    for side in (-1.0, 1.0):
        axes.plot([tip[0], tip[0] + side * length * np.sin(half)], [tip[1], tip[1] + length * np.cos(half)], color=INK,
                  linewidth=0.8, linestyle="--")
    axes.plot([tip[0] - 0.5 * LEDGE_MM, tip[0] + 0.5 * LEDGE_MM], [tip[1], tip[1]], color=FAINT, linewidth=8, zorder=0)
    size = float(np.linalg.norm(footing.force_n))
    arrow = footing.force_n / size * length
    colour = SOFT if footing.holds else STIFF
    axes.annotate("", tip + arrow, tip, arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 2.2})
    axes.annotate(f"{size:.1f} N", tip + arrow, xytext=(4, 4), textcoords="offset points", color=colour)
    axes.set(aspect="equal", xlabel="x [mm] (arrow: direction of the force only)", ylabel="z [mm]")
    word = "holds" if footing.holds else "slides"
    axes.set_title(f"{footing.title}, body sags {sag_mm:g} mm\n{word}: margin {footing.margin_n:+.2f} N", loc="left",
                   fontsize=9)
