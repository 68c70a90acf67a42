"""docs/loaded.svg: what a load does to a limb. Ellipses of compliance along a reach under 0, 10 and 20 N, and a map of the
buckling factor. K is the firmware's own (brace/loaded.h), of the paper's limb with beams for links."""

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import numpy as np  # noqa: E402
from matplotlib import pyplot as plt  # noqa: E402
from matplotlib.patches import Ellipse  # noqa: E402

from brace.model import LimbModel, load_limb  # noqa: E402
from brace.stiffness.at_rest import PlanarLimb, planar_limb  # noqa: E402
from brace.stiffness.under_load import LoadedLimb  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]
STYLE: dict[Any, Any] = {"svg.hashsalt": "brace", "svg.fonttype": "none", "font.size": 9.0, "axes.spines.top": False,
                         "axes.spines.right": False}
FORCES_N = ((0.0, "#555555"), (10.0, "#1b6ca8"), (20.0, "#c8553d"))
HEIGHT_MM, REACH_MM = -100.0, np.arange(200.0, 470.0, 60.0)
DRAWN_TIMES = 8.0
PUSH_N = 20.0
LEVELS = (2.0, 3.0, 4.0, 5.0, 6.0, 8.0)


def limb() -> LimbModel:
    """The paper's limb with beams for links."""
    model = load_limb(ROOT / "tools" / "brace" / "data" / "paper-limb.toml")
    return model.with_values({f"link.{link}.moment_transfer": True for link in ("femur", "tibia")})


def _true_angles(planar: PlanarLimb, x_mm: np.ndarray, z_mm: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    angles = planar.postures(np.stack([x_mm, z_mm], 1), np.full(len(x_mm), "up"))
    return angles[:, 0], angles[:, 1]


def _ellipses(axes: Any, planar: PlanarLimb, loaded: LoadedLimb) -> None:
    angles = _true_angles(planar, REACH_MM, np.full(len(REACH_MM), HEIGHT_MM))
    for force_n, colour in FORCES_N:
        k = loaded.stiffness(*angles, np.zeros(len(REACH_MM)), np.full(len(REACH_MM), force_n))
        for x, row in zip(REACH_MM, k):
            width, height = (2.0 * DRAWN_TIMES / row[f"lambda_{which}_n_per_mm"] for which in ("max", "min"))
            centre = (x + row["tip_dx_mm"], HEIGHT_MM + row["tip_dz_mm"])
            axes.add_patch(Ellipse(centre, width, height, angle=float(np.degrees(row["stiff_axis_rad"])), fill=False,
                                   edgecolor=colour, linewidth=1.2))
            axes.plot(*centre, ".", color=colour, markersize=3)
        axes.plot([], [], color=colour, label=f"{force_n:g} N upwards")
    axes.set(xlim=(150, 500), ylim=(-160, 60), aspect="equal", xlabel="x, mm", ylabel="z, mm",
             title=f"what 1 N moves the tip, drawn {DRAWN_TIMES:g} times as large")
    axes.legend(frameon=False, fontsize=8, loc="upper left")


def _map(axes: Any, figure: Any, planar: PlanarLimb, loaded: LoadedLimb) -> None:
    x_mm, z_mm = np.meshgrid(np.linspace(60.0, 495.0, 88), np.linspace(-400.0, 400.0, 161))
    theta1, theta2 = _true_angles(planar, x_mm.ravel(), z_mm.ravel())
    k = loaded.stiffness(theta1, theta2, np.full(x_mm.size, -PUSH_N), np.zeros(x_mm.size))
    factor = np.minimum(k["buckling_factor"], 11.0).reshape(x_mm.shape)
    filled = axes.contourf(x_mm, z_mm, np.ma.masked_invalid(factor), levels=(1.0, *LEVELS, 11.0), cmap="RdYlBu")
    axes.contour(x_mm, z_mm, np.ma.masked_invalid(factor), levels=(3.0,), colors="black", linewidths=0.8)
    axes.set(aspect="equal", xlabel="x, mm", title=f"buckling factor where a wall ahead\npushes with {PUSH_N:g} N (line: 3)")
    figure.colorbar(filled, ax=axes, shrink=0.8)


def draw(path: Path) -> None:
    """Write the picture."""
    planar, loaded = planar_limb(limb()), LoadedLimb(limb())
    with matplotlib.rc_context(STYLE):
        figure = plt.figure(figsize=(9.0, 4.6), layout="constrained")
        left, right = figure.subplots(1, 2, width_ratios=[1.7, 1.0])
        _ellipses(left, planar, loaded)
        _map(right, figure, planar, loaded)
        figure.savefig(path, metadata={"Date": None, "Creator": None})
        plt.close(figure)


if __name__ == "__main__":
    draw(ROOT / "docs" / "loaded.svg")
