"""A figure without pyplot: no display, no global state, quick to import; the same bytes every time."""

from __future__ import annotations

import io
import math
from typing import TYPE_CHECKING, Literal

import matplotlib

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Apart for every kind of colour blindness, in hue or in lightness: vermilion, blue, light purple, grey.
INK, STIFF, SOFT, MODEL, FAINT = "#22303c", "#c8553d", "#2d6a8e", "#a98fc4", "#b8c0c8"

_STYLE: dict[str, object] = {
    "font.size": 9.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "legend.frameon": False,
    "svg.hashsalt": "brace",
    "svg.fonttype": "none",
    "axes.grid": True,
    "grid.color": "#e6e9ec",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "lines.linewidth": 1.6,
}


def new_figure(width_in: float, height_in: float, layout: Literal["constrained"] | None = "constrained") -> Figure:
    """An empty figure in the house style. Without a layout of its own it needs `place_panels`."""
    from matplotlib.figure import Figure

    matplotlib.rcParams.update(_STYLE)  # type: ignore[arg-type]
    return Figure(figsize=(width_in, height_in), layout=layout)


def load() -> None:
    """Loads what figures are drawn with, which takes half a second."""
    import matplotlib.backends.backend_svg
    import matplotlib.figure  # noqa: F401


def place_panels(
    figure: Figure,
    rows: int,
    columns: int,
    *,
    left_in: float,
    top_in: float,
    bottom_in: float,
    beside_in: float = 0.0,
    above_in: float = 0.0,
) -> None:
    """Fixed room around panels [inches]: left of, above and below all of them, and between neighbours. Measuring all
    texts instead takes longer than drawing them."""
    width_in, height_in = figure.get_size_inches()
    right_in = 0.12
    panel_width_in = (width_in - left_in - right_in - beside_in * (columns - 1)) / columns
    panel_height_in = (height_in - top_in - bottom_in - above_in * (rows - 1)) / rows
    figure.subplots_adjust(
        left=left_in / width_in,
        right=1.0 - right_in / width_in,
        top=1.0 - top_in / height_in,
        bottom=bottom_in / height_in,
        wspace=beside_in / panel_width_in,
        hspace=above_in / panel_height_in,
    )


def round_below(value: float) -> float:
    """1, 2 or 5 times a power of ten, for a scale's bar: the largest not above `value` > 0."""
    power = 10.0 ** math.floor(math.log10(value))
    return power * max(step for step in (1.0, 2.0, 5.0) if step * power <= value)


def png_bytes(figure: Figure, dpi: int = 110) -> bytes:
    """The figure as PNG."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=dpi, metadata={"Software": "brace"})
    return buffer.getvalue()


def svg_bytes(figure: Figure) -> bytes:
    """The figure as SVG with searchable text. The same bytes as by savefig, which draws everything twice."""
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    canvas = FigureCanvasSVG(figure)
    figure.set_dpi(72)  # of the canvas: what the layout is made for
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine("none")
    buffer = io.BytesIO()
    canvas.print_svg(buffer, metadata={"Date": None, "Creator": "brace"})  # type: ignore[no-untyped-call]
    return buffer.getvalue()
