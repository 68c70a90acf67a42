"""The report's pictures, as SVG text: where model and measurement disagreed, and the gap before and after."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np

from brace.diagnose.diagnosis import Gap
from brace.diagnose.plain_words import number, unit
from brace.diagnose.report.views import View
from brace.plots.figure import FAINT, INK, MODEL, SOFT, STIFF, new_figure, place_panels, svg_bytes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH_IN = 9.4
Y_LABEL_IN, X_LABEL_IN, TITLE_IN = 0.85, 0.5, 0.32  # with the numbers at the ticks
LETTER_IN = 0.073  # of the house's letters, a wide one
POINTS = 1400  # drawn in one panel at most
LOOP_POINTS = 400
BEFORE, AFTER, FLOOR = STIFF, SOFT, FAINT
_BINS = 12
_EVERY_POINT: dict[Any, Any] = {"path.simplify": False}
_SHORTER = re.compile(r"(\d+\.\d{2})\d+")


def disagreement(view: View, gap: Gap) -> str:
    """The gap by load and branch, by configuration, by time; of the model refitted within its trust, where
    told."""
    with_time = bool(np.isfinite(view.time_s).all()) and np.ptp(view.time_s) > 0
    figure = new_figure(WIDTH_IN, 3.0, None)
    columns = 3 if with_time else 2
    place_panels(figure, 1, columns, left_in=Y_LABEL_IN, top_in=TITLE_IN, bottom_in=X_LABEL_IN, beside_in=Y_LABEL_IN)
    panels = figure.subplots(1, columns, sharey=False)
    _by_load(panels[0], view, gap)
    _by_group(panels[1], view, gap)
    if with_time:
        _by_time(panels[2], view, gap)
    return svg(figure, "where")


def loops(view: View) -> str:
    """One run that was fitted and one that was held out, where the believed model did worst: measured,
    believed, corrected."""
    chosen = [(words, _worst_run(view, rows)) for words, rows in _sides(view)]
    figure = new_figure(WIDTH_IN, 3.6, None)
    columns = len(chosen)
    place_panels(figure, 1, columns, left_in=Y_LABEL_IN, top_in=TITLE_IN, bottom_in=X_LABEL_IN, beside_in=Y_LABEL_IN)
    panels = figure.subplots(1, columns, squeeze=False)[0]
    for axes, (words, rows) in zip(panels, chosen, strict=True):
        rows = rows[_thin(len(rows), LOOP_POINTS)]
        x = view.imposed[rows]
        axes.plot(x, view.believed[rows], color=BEFORE, linewidth=1.3, label="model before")
        axes.plot(x, view.corrected[rows], color=AFTER, linewidth=1.3, label="model after")
        small = 3.4 if len(rows) < 60 else 1.6
        axes.plot(
            x, view.measured[rows], "o", color=INK, markersize=small, markeredgewidth=0, label="measured"
        )
        axes.set(xlabel=view.names[0], ylabel=view.names[1])
        axes.locator_params(axis="x", nbins=7)
        group = f"{view.names[2]} {view.group[rows[0]]}"
        axes.set_title(
            f"{words}: {group}" + ("" if view.kind == "joint_test" else f", run {view.run[rows[0]]}"),
            loc="left",
            fontsize=9.5,
        )
    panels[0].legend(loc="best")
    return svg(figure, "loops")


def gap(view: View, found: Gap) -> str:
    """Measured less model in the record's order, before above after, fitted beside held out, on the same
    axes."""
    sides = _sides(view)
    figure = new_figure(WIDTH_IN, 4.4, None)
    room = {"left_in": Y_LABEL_IN, "top_in": TITLE_IN, "bottom_in": X_LABEL_IN, "beside_in": 0.2, "above_in": TITLE_IN}
    place_panels(figure, 2, len(sides), **room)
    panels: Any = figure.subplots(2, len(sides), sharey=True, squeeze=False, sharex="col")
    limit = 1.08 * float(np.nanmax(np.abs(view.before[np.isfinite(view.before)]), initial=found.noise_floor))
    limit = max(limit, 3.2 * found.noise_floor, 1e-12)
    pairs = ((found.before, view.before, BEFORE, "before"), (found.after, view.after, AFTER, "after"))
    for row, (pair, values, colour, when) in enumerate(pairs):
        for column, (words, rows) in enumerate(sides):
            axes: Axes = panels[row][column]
            axes.axhspan(-2 * found.noise_floor, 2 * found.noise_floor, color=FLOOR, alpha=0.45, linewidth=0)
            axes.axhline(0.0, color=INK, linewidth=0.6)
            drawn = _thin(len(rows), POINTS)
            _dots(axes, drawn, values[rows][drawn], colour, size=2.2 if len(drawn) > 80 else 5.0)
            _mark_groups(axes, view.group[rows])
            rms = pair.fitted if column == 0 else pair.held_out
            said = "" if rms is None else f": rms {number(rms)} {unit(found.unit)}"
            axes.set_title(f"{words}, {when}{said}", loc="left", fontsize=9.5)
            if row == 1:
                axes.set_xlabel("reading" if view.kind != "stiffness_table" else "entry")
        panels[row][0].set_ylabel(f"measured − model [{unit(found.unit)}]")
    panels[0][0].set_ylim(-limit, limit)
    return svg(figure, "gap")


def steps(found: Gap, first: str) -> str:
    """The gap of `first`, then as one thing after the other was added to it; the noise floor below."""
    stages = [(first, found.before), *((step.added, step.gap) for step in found.steps)]
    if stages[-1][1] != found.after:
        stages.append(("the model as written", found.after))
    names = [words if len(words) < 60 else words[:57] + "…" for words, _ in stages]
    figure = new_figure(WIDTH_IN, 0.85 + 0.46 * len(stages), None)
    left_in = 0.2 + LETTER_IN * max(map(len, names))
    place_panels(figure, 1, 1, left_in=left_in, top_in=TITLE_IN, bottom_in=X_LABEL_IN)
    axes = figure.subplots()
    at = np.arange(len(stages))[::-1]
    held = [pair.held_out for _, pair in stages]
    several = any(value is not None for value in held)
    width = 0.36 if several else 0.6
    fitted = [pair.fitted for _, pair in stages]
    _bars(axes, at + (width / 2 if several else 0), fitted, width, SOFT, "fitted", found.unit)
    if several:
        _bars(axes, at - width / 2, [value or 0.0 for value in held], width, MODEL, "held out", found.unit)
    axes.axvline(found.noise_floor, color=INK, linewidth=1.0, linestyle="--")
    axes.set_title(
        f"noise floor {number(found.noise_floor)} {unit(found.unit)}, dashed", loc="left", fontsize=9.5
    )
    axes.set_yticks(at, names)
    axes.set_xlabel(f"rms of measured − model [{unit(found.unit)}]")
    axes.grid(False, axis="y")
    axes.margins(x=0.08)
    if several:
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, borderaxespad=0.2)
    return svg(figure, "steps")


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


def _by_load(axes: Axes, view: View, found: Gap) -> None:
    floor(axes, found)
    branches = ((1, STIFF, "loading"), (-1, SOFT, "unloading"), (0, INK, "neither"))
    load, axis = (
        (view.measured, view.names[1]) if view.kind == "joint_test" else (view.imposed, view.names[0])
    )
    for sign, colour, words in branches:
        rows = np.flatnonzero((view.branch == sign) & np.isfinite(view.localised))
        if not rows.size or (sign == 0 and view.kind != "stiffness_table"):
            continue
        drawn = rows[_thin(rows.size, POINTS // 2)]
        _dots(axes, load[drawn], view.localised[drawn], colour, 0.45)
        if rows.size >= 3 * _BINS:
            axes.plot(
                *_means(load[rows], view.localised[rows]),
                color=colour,
                linewidth=1.8,
                label=words if sign else None,
            )
    axes.locator_params(axis="x", nbins=5)
    axes.set(xlabel=axis, ylabel=f"measured − model [{unit(found.unit)}]")
    axes.set_title(
        "by load" + (" and branch" if view.kind != "stiffness_table" else ""), loc="left", fontsize=9.5
    )
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="best", fontsize=8)


def _by_group(axes: Axes, view: View, found: Gap) -> None:
    groups = np.unique(view.group)
    sizes = np.array([_rms(view.localised[view.group == group]) for group in groups])
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
    axes.axhline(found.noise_floor, color=INK, linewidth=1.0, linestyle="--")
    every = max(1, len(groups) // 14)
    axes.set_xticks(place[::every], [str(group) for group in groups[::every]])
    axes.set(xlabel=view.names[2], ylabel=f"rms [{unit(found.unit)}]")
    axes.grid(False, axis="x")
    axes.set_title(f"by {view.names[2]}; noise floor dashed", loc="left", fontsize=9.5)
    if held.any():
        axes.set_ylim(0.0, 1.25 * max(float(sizes.max()), found.noise_floor))
        axes.legend(loc="upper right", fontsize=8, ncols=2)


def _by_time(axes: Axes, view: View, found: Gap) -> None:
    floor(axes, found)
    minutes = (view.time_s - view.time_s.min()) / 60.0
    rows = np.flatnonzero(np.isfinite(view.localised))
    drawn = rows[_thin(rows.size, POINTS)]
    _dots(axes, minutes[drawn], view.localised[drawn], STIFF, 0.45)
    if rows.size >= 3 * _BINS:
        axes.plot(*_means(minutes[rows], view.localised[rows]), color=INK, linewidth=1.6)
    axes.set(xlabel="time [min]")
    axes.set_title("by time; line: mean", loc="left", fontsize=9.5)


def floor(axes: Axes, found: Gap) -> None:
    """The band of two noise floors around zero."""
    axes.axhspan(-2 * found.noise_floor, 2 * found.noise_floor, color=FLOOR, alpha=0.45, linewidth=0)
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


def _bars(
    axes: Axes, at: np.ndarray, values: list[float], width: float, colour: str, words: str, kind: str
) -> None:
    axes.barh(at, values, height=width, color=colour, label=words)
    for place, value in zip(at, values, strict=True):
        axes.annotate(
            number(value), (value, place), xytext=(3, 0), textcoords="offset points", va="center", fontsize=8
        )


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
