"""The paper's Fig. 12: force over displacement in a cyclic test, and how far the zero-force point moves."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from brace.plots.figure import INK, SOFT, STIFF, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def cyclic_figure(displacement_mm: np.ndarray, force_n: np.ndarray, without_play_n: np.ndarray, shift_mm: float,
                  crossings_mm: tuple[float, float], title: str) -> Figure:
    """Displacement and force along the axis, in the order of the test; without_play_n: the same limb without gaps.
    crossings_mm: where the force crosses zero coming from either side."""
    figure = new_figure(7.4, 4.6)
    axes = figure.subplots()
    axes.axhline(0.0, color=INK, linewidth=0.8)
    # to and fro on one line: dashes drawn twice would look solid
    once = np.unique(displacement_mm, return_index=True)[1]
    axes.plot(displacement_mm[once], without_play_n[once], color=SOFT, linewidth=1.0, linestyle="--",
              label="the same limb without play")
    axes.plot(displacement_mm, force_n, color=STIFF, marker="o", markersize=3.2, linewidth=1.1, label="limb with play")
    low, high = sorted(crossings_mm)
    axes.axvspan(low, high, color=STIFF, alpha=0.12, linewidth=0)
    height = 0.45 * float(force_n.max())
    axes.annotate("", (low, height), (high, height), arrowprops={"arrowstyle": "<->", "color": INK})
    axes.annotate(f"zero-force shift {shift_mm:.2f} mm", ((low + high) / 2, height), xytext=(0, 4),
                  textcoords="offset points", ha="center")
    axes.set(xlabel="displacement of the tip along z [mm]", ylabel="force on the limb along z [N]")
    axes.set_title(title, loc="left", fontsize=10)
    axes.legend(loc="upper left")
    return figure
