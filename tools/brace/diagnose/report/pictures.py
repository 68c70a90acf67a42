"""The report's pictures, as SVG text: one panel each, so that a narrow page sets them below each other."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np

from brace.diagnose.digits import number
from brace.diagnose.report.views import View
from brace.plots.figure import FAINT, INK, SOFT, STIFF, new_figure, place_panels, svg_bytes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

NARROW_IN, WIDE_IN = 3.3, 4.7  # of three panels in a row, and of two
Y_LABEL_IN, X_LABEL_IN, TITLE_IN = 0.72, 0.5, 0.3  # with the numbers at the ticks
POINTS = 1400  # drawn in one panel at most
LOOP_POINTS = 400
BEFORE, AFTER, FLOOR = STIFF, SOFT, FAINT
TITLE: dict[str, Any] = {"loc": "left", "fontsize": 9.5}
_BINS = 12
_EVERY_POINT: dict[Any, Any] = {"path.simplify": False}
_SHORTER = re.compile(r"(\d+\.\d{2})\d+")


def disagreement(view: View, off: np.ndarray, name: str) -> list[str]:
    """Measured less model by load and branch, by configuration, by time. `off` is one of the view's misfits; `name`
    keeps its pictures apart from others'."""
    panels = [
        _panel(NARROW_IN, 2.8, f"{name}-load", partial(_by_load, view=view, off=off)),
        _panel(NARROW_IN, 2.8, f"{name}-group", partial(_by_group, view=view, off=off)),
    ]
    if np.isfinite(view.time_s).all() and np.ptp(view.time_s) > 0:
        panels.append(_panel(NARROW_IN, 2.8, f"{name}-time", partial(_by_time, view=view, off=off)))
    return panels


def loops(view: View) -> list[str]:
    """One run that was fitted and one that was held out, where the believed model did worst: measured, believed,
    found."""
    return [
        _panel(WIDE_IN, 3.5, f"loops-{place}", partial(_loop, view=view, words=words, rows=_worst_run(view, rows)))
        for place, (words, rows) in enumerate(_sides(view))
    ]


def misfit(view: View) -> list[str]:
    """Measured less model in the record's order, before above after, fitted beside held out, on the same axes."""
    limit = 1.08 * float(np.nanmax(np.abs(view.before[np.isfinite(view.before)]), initial=view.noise_floor))
    limit = max(limit, 3.2 * view.noise_floor, 1e-12)
    panels = []
    for off, rms, colour, when in (
        (view.before, view.rms_before, BEFORE, "before"),
        (view.after, view.rms_after, AFTER, "after"),
    ):
        for place, (words, rows) in enumerate(_sides(view)):
            title = f"{words}, {when}" + ("" if (size := rms[place]) is None else f": rms {number(size)} {view.unit}")
            draw = partial(_in_order, view=view, off=off, colour=colour, title=title, rows=rows, limit=limit)
            panels.append(_panel(WIDE_IN, 2.4, f"misfit-{when}-{place}", draw))
    return panels


def svg(figure: Figure, name: str) -> str:
    """Inline SVG; `name` keeps its ids apart from the other pictures'."""
    with matplotlib.rc_context(_EVERY_POINT):
        text = svg_bytes(figure).decode()
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    text = re.sub(r'\bid="', f'id="{name}-', text)
    text = text.replace("url(#", f"url(#{name}-").replace('href="#', f'href="#{name}-')
    text = re.sub(r'(<svg[^>]*?) width="[^"]*"', r"\1", text, count=1)
    text = re.sub(r'(<svg[^>]*?) height="[^"]*"', r"\1", text, count=1)
    text = re.sub(r"<!--.*?-->\s*", "", text, flags=re.DOTALL)
    return re.sub(r'\b(?:d|x|y|transform)="[^"]*"', lambda found: _SHORTER.sub(r"\1", found.group()), text)


def _panel(width_in: float, height_in: float, name: str, draw: Callable[[Axes], None]) -> str:
    figure = new_figure(width_in, height_in, None)
    place_panels(figure, 1, 1, left_in=Y_LABEL_IN, top_in=TITLE_IN, bottom_in=X_LABEL_IN)
    draw(figure.subplots())
    return svg(figure, name)


def _loop(axes: Axes, view: View, words: str, rows: np.ndarray) -> None:
    rows = rows[_thin(len(rows), LOOP_POINTS)]
    x = view.imposed[rows]
    axes.plot(x, view.believed[rows], color=BEFORE, linewidth=1.3, label=view.given)
    axes.plot(x, view.corrected[rows], color=AFTER, linewidth=1.3, label="the model as found")
    small = 3.4 if len(rows) < 60 else 1.6
    axes.plot(x, view.measured[rows], "o", color=INK, markersize=small, markeredgewidth=0, label="measured")
    axes.set(xlabel=view.names[0], ylabel=view.names[1])
    axes.locator_params(axis="x", nbins=7)
    group = f"{view.names[2]} {view.group[rows[0]]}"
    run = "" if view.kind == "joint_test" else f", run {view.run[rows[0]]}"
    axes.set_title(f"{words}: {group}{run}", **TITLE)
    axes.legend(loc="best")


def _in_order(
    axes: Axes, view: View, off: np.ndarray, colour: str, title: str, rows: np.ndarray, limit: float
) -> None:
    _draw_floor(axes, view)
    drawn = _thin(len(rows), POINTS)
    _dots(axes, drawn, off[rows][drawn], colour, size=2.2 if len(drawn) > 80 else 5.0)
    _mark_groups(axes, view.group[rows])
    axes.set_title(title, **TITLE)
    axes.set(
        xlabel="reading" if view.kind != "stiffness_table" else "entry",
        ylabel=f"measured − model [{view.unit}]",
        ylim=(-limit, limit),
    )


def _by_load(axes: Axes, view: View, off: np.ndarray) -> None:
    _draw_floor(axes, view)
    branches = ((1, STIFF, "loading"), (-1, SOFT, "unloading"), (0, INK, "neither"))
    load, axis = (view.measured, view.names[1]) if view.kind == "joint_test" else (view.imposed, view.names[0])
    for sign, colour, words in branches:
        rows = np.flatnonzero((view.branch == sign) & np.isfinite(off))
        if not rows.size or (sign == 0 and view.kind != "stiffness_table"):
            continue
        drawn = rows[_thin(rows.size, POINTS // 2)]
        _dots(axes, load[drawn], off[drawn], colour, 0.45)
        if rows.size >= 3 * _BINS:
            axes.plot(*_means(load[rows], off[rows]), color=colour, linewidth=1.8, label=words if sign else None)
    axes.locator_params(axis="x", nbins=5)
    axes.set(xlabel=axis, ylabel=f"measured − model [{view.unit}]")
    by = {"joint_test": "by torque and branch", "stiffness_table": "by distance"}
    axes.set_title(by.get(view.kind, "by displacement and branch"), **TITLE)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="best", fontsize=8)


def _by_group(axes: Axes, view: View, off: np.ndarray) -> None:
    groups = np.unique(view.group)
    sizes = np.array([_rms(off[view.group == group]) for group in groups])
    held = np.array([view.held_out[view.group == group].mean() > 0.5 for group in groups])
    place = np.arange(len(groups))
    axes.bar(place[~held], sizes[~held], color=STIFF, width=0.75, label="fitted")
    if held.any():
        axes.bar(
            place[held],
            sizes[held],
            color=STIFF,
            alpha=0.45,
            width=0.75,
            hatch="///",
            edgecolor="white",
            linewidth=0,
            label="held out",
        )
    axes.axhline(view.noise_floor, color=INK, linewidth=1.0, linestyle="--")
    every = max(1, -(-len(groups) // 8))
    axes.set_xticks(place[::every], [str(group) for group in groups[::every]])
    axes.set(xlabel=view.names[2], ylabel=f"rms [{view.unit}]")
    axes.grid(False, axis="x")
    axes.set_title(f"by {view.names[2]}; noise floor dashed", **TITLE)
    if held.any():
        axes.set_ylim(0.0, 1.25 * max(float(sizes.max()), view.noise_floor))
        axes.legend(loc="upper right", fontsize=8, ncols=2)


def _by_time(axes: Axes, view: View, off: np.ndarray) -> None:
    _draw_floor(axes, view)
    minutes = (view.time_s - view.time_s.min()) / 60.0
    rows = np.flatnonzero(np.isfinite(off))
    drawn = rows[_thin(rows.size, POINTS)]
    _dots(axes, minutes[drawn], off[drawn], STIFF, 0.45)
    if rows.size >= 3 * _BINS:
        axes.plot(*_means(minutes[rows], off[rows]), color=INK, linewidth=1.6)
    axes.set(xlabel="time [min]", ylabel=f"measured − model [{view.unit}]")
    axes.set_title("by time; line: mean", **TITLE)


def _draw_floor(axes: Axes, view: View) -> None:
    """The band of two noise floors around zero."""
    axes.axhspan(-2 * view.noise_floor, 2 * view.noise_floor, color=FLOOR, alpha=0.45, linewidth=0)
    axes.axhline(0.0, color=INK, linewidth=0.6)


def _dots(
    axes: Axes, x: np.ndarray, y: np.ndarray, colour: str, opacity: float = 1.0, size: float = 2.2
) -> None:
    """Points as one path of strokes without length and with round ends: a tenth of the bytes of markers."""
    strokes = []
    for values in (x, y):
        spread = np.repeat(np.asarray(values, dtype=float), 3)
        spread[2::3] = np.nan
        strokes.append(spread)
    (line,) = axes.plot(*strokes, color=colour, alpha=opacity, linewidth=size, solid_capstyle="round")
    with matplotlib.rc_context(_EVERY_POINT):
        line.recache(always=True)


def _sides(view: View) -> list[tuple[str, np.ndarray]]:
    """Rows that were fitted, and those that took no part, if any."""
    sides = [("fitted", np.flatnonzero(~view.held_out)), ("held out", np.flatnonzero(view.held_out))]
    return [(words, rows) for words, rows in sides if rows.size] or [("all", np.arange(len(view.before)))]


def _worst_run(view: View, rows: np.ndarray) -> np.ndarray:
    runs = np.unique(view.run[rows])
    sizes = [_rms(view.before[rows[view.run[rows] == run]]) for run in runs]
    worst = runs[int(np.argmax(sizes))]
    chosen: np.ndarray = rows[view.run[rows] == worst]
    return chosen


def _mark_groups(axes: Axes, group: np.ndarray) -> None:
    """Thin lines where one configuration ends and the next begins."""
    edges = np.flatnonzero(np.diff(group) != 0)
    if len(edges) <= 40:
        for edge in edges:
            axes.axvline(edge + 0.5, color="#dfe3e7", linewidth=0.7, zorder=0)
    axes.grid(False, axis="x")


def _means(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Means of y at each level of x, or in bins of equal width where x has many levels."""
    levels, index = np.unique(np.round(x, 6), return_inverse=True)
    if len(levels) > 3 * _BINS:
        edges = np.linspace(x.min(), x.max(), _BINS + 2)
        index = np.clip(np.searchsorted(edges, x, side="right") - 1, 0, _BINS)
        levels = 0.5 * (edges[1:] + edges[:-1])
    counts = np.bincount(index, minlength=len(levels))
    some = counts > 0
    return levels[some], np.bincount(index, weights=y, minlength=len(levels))[some] / counts[some]


def _thin(count: int, most: int) -> np.ndarray:
    """Indices of at most `most` entries, evenly spread."""
    return np.arange(count) if count <= most else np.linspace(0, count - 1, most).astype(int)


def _rms(values: np.ndarray) -> float:
    values = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0
