"""A figure without pyplot: no display, no global state, quick to import; the same bytes every time."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

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


def new_figure(width_in: float, height_in: float) -> Figure:
    """An empty figure in the house style."""
    from matplotlib.figure import Figure

    matplotlib.rcParams.update(_STYLE)  # type: ignore[arg-type]
    return Figure(figsize=(width_in, height_in), layout="constrained")


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
