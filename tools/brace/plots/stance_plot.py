"""A body on its limbs from above and from its left, the forces on its feet, and each force in its friction cone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from brace.plots.figure import FAINT, INK, MODEL, SOFT, STIFF, new_figure, round_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LONGEST_ARROW = 0.45  # of the stance's width
_CONES_A_ROW = 4


@dataclass(frozen=True)
class PlacedLimb:
    """points_mm: 4 x 3, mount, hip, knee and foot in the body's frame. pressing_n and along_n: the ground's force out
    of the ground and along it: low, most probable, high; begun_n: both before the payload."""

    name: str
    points_mm: np.ndarray
    force_n: np.ndarray
    pressing_n: np.ndarray
    along_n: np.ndarray
    begun_n: tuple[float, float]
    friction_ratio: float
    grip_n: float
    state: str


def stance_figure(title: str, limbs: Sequence[PlacedLimb], com_mm: np.ndarray, payload_at_mm: np.ndarray) -> Figure:
    """Views with one scale of length and of force; a cone for each foot."""
    rows = -(-len(limbs) // _CONES_A_ROW)
    figure = new_figure(10.0, 4.2 + 2.5 * rows)
    parts = figure.add_gridspec(2, 1, height_ratios=[4.2, 2.5 * rows])
    views, cones = figure.add_subfigure(parts[0]), figure.add_subfigure(parts[1])
    above, aside = views.subplots(1, 2)
    points = np.concatenate([limb.points_mm for limb in limbs])
    longest = max(float(np.linalg.norm(limb.force_n)) for limb in limbs)
    mm_per_n = _LONGEST_ARROW * float(np.ptp(points[:, :2], axis=0).max()) / longest
    for axes, (across, up), words in ((above, (0, 1), "from above"), (aside, (0, 2), "from its right")):
        for limb in limbs:
            _draw_limb(axes, limb, across, up, mm_per_n)
        axes.plot(com_mm[across], com_mm[up], "o", color=INK, markersize=6, label="centre of mass")
        axes.plot(payload_at_mm[across], payload_at_mm[up], "v", color=MODEL, markersize=7, label="payload")
        axes.set(aspect="equal", xlabel=f"{'xyz'[across]} [mm]", ylabel=f"{'xyz'[up]} [mm]")
        axes.set_title(words, loc="left", fontsize=9)
        axes.margins(0.12)
    scale_n = round_below(0.6 * longest)
    above.plot([], [], color=STIFF, label="the ground's force on the foot")
    above.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=3, fontsize=8)
    low_x, low_y = above.get_xlim()[0], above.get_ylim()[0]
    above.plot([low_x, low_x + scale_n * mm_per_n], [low_y, low_y], color=STIFF, linewidth=2.0, clip_on=False)
    above.annotate(f"{scale_n:g} N", (low_x, low_y), (2, 4), textcoords="offset points", fontsize=8, color=STIFF)
    grid = cones.subplots(rows, _CONES_A_ROW, squeeze=False)
    for axes in grid.flat[len(limbs) :]:
        axes.set_axis_off()
    for axes, limb in zip(grid.flat, limbs):
        _draw_cone(axes, limb)
    grid[0, 0].legend(loc="lower right", fontsize=7)
    for row in grid:
        row[0].set_ylabel("along the ground [N]")
    figure.suptitle(title, x=0.01, ha="left", fontsize=10)
    return figure


def _draw_limb(axes: Axes, limb: PlacedLimb, across: int, up: int, mm_per_n: float) -> None:
    points = limb.points_mm[:, [across, up]]
    axes.plot(points[:, 0], points[:, 1], color=FAINT, linewidth=4, solid_capstyle="round", zorder=1)
    axes.plot(points[:-1, 0], points[:-1, 1], "o", color=INK, markersize=4, zorder=3)
    tip = points[-1] + mm_per_n * limb.force_n[[across, up]]
    axes.annotate("", tip, points[-1], arrowprops={"arrowstyle": "-|>", "color": STIFF, "shrinkA": 0, "shrinkB": 0})
    axes.plot(*tip, alpha=0.0)  # so that the axes hold the arrow
    if up == 1:
        axes.annotate(limb.name, points[-1], (5, 5), textcoords="offset points", fontsize=8)


def _draw_cone(axes: Axes, limb: PlacedLimb) -> None:
    most = 1.25 * max(float(limb.pressing_n.max()), limb.begun_n[0], 1e-3)
    least = min(-limb.grip_n, 0.0)
    pressing = np.array([least, most])
    axes.fill_between(
        pressing, limb.friction_ratio * (pressing + limb.grip_n), color=SOFT + "25", edgecolor=SOFT, linewidth=1.2
    )
    low, middle, high = limb.pressing_n
    low_along, along, high_along = limb.along_n
    axes.plot([limb.begun_n[0], middle], [limb.begun_n[1], along], color=MODEL, zorder=2)
    axes.plot(*limb.begun_n, "o", color=MODEL, markersize=4, zorder=2, label="before the payload")
    axes.errorbar(
        middle, along, [[max(along - low_along, 0.0)], [max(high_along - along, 0.0)]],
        [[max(middle - low, 0.0)], [max(high - middle, 0.0)]], fmt="o", color=STIFF, markersize=5, zorder=3,
        label="under it, with 90 %",
    )  # fmt: skip
    axes.set_xlim(least, most)
    axes.set_ylim(0.0, 1.15 * max(limb.friction_ratio * (most + limb.grip_n), high_along))
    axes.set_xlabel("out of the ground [N]")
    axes.set_title(f"{limb.name}: {limb.state}", loc="left", fontsize=9)
