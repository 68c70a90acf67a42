"""backlash.svg: wrong sides, angle errors and one history, the machine beside compensation by direction of motion.

The same figures give the same bytes.
"""

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import numpy as np  # noqa: E402
from matplotlib import pyplot as plt  # noqa: E402

MACHINE, GUESS, COMMAND, ENCODER, ORACLE = "#1b6ca8", "#7fb2d9", "#c8553d", "#e0a458", "#555555"
STYLE: dict[Any, Any] = {"svg.hashsalt": "brace", "svg.fonttype": "none", "font.size": 9.0, "axes.spines.top": False,
                         "axes.spines.right": False, "path.simplify_threshold": 0.5}


def _wrong(axes: Any, n: Any) -> None:
    rows = [("machine, decided", n.wrong, MACHINE), ("machine, guessed\nat every tick", n.best_wrong, GUESS),
            ("by commanded\ndirection", n.cnc_command_wrong, COMMAND), ("by the encoder's\ndirection", n.cnc_encoder_wrong, ENCODER)]
    shares = [100.0 * value / n.judged for _, value, _ in rows]
    bars = axes.barh(range(len(rows)), shares, color=[colour for _, _, colour in rows])
    axes.bar_label(bars, [f"{share:.2g} %" for share in shares], padding=3)
    axes.axvline(0.2, color="black", linewidth=0.8, linestyle=":")
    axes.set(xscale="log", xlim=(0.01, 300.0),
             xlabel="wrong side, % of the ticks outside the crossing\n(dotted: allowed)")
    axes.set_yticks(range(len(rows)), [name for name, _, _ in rows])
    axes.invert_yaxis()


def _distribution(axes: Any, n: Any, oracle: Any) -> None:
    rows = [("machine, reported valid", n.valid_only, MACHINE, "-."), ("machine, outside the crossing", n.outside_crossing, MACHINE, "--"),
            ("machine, all ticks", n.all, MACHINE, "-"), ("oracle, all ticks", oracle.error, ORACLE, ":"),
            ("by commanded direction", n.cnc_command, COMMAND, "-"), ("by the encoder's direction", n.cnc_encoder, ENCODER, "-")]
    for name, bins, colour, line in rows:
        share = np.cumsum(np.array(bins))[::100][:121]
        axes.plot(np.arange(len(share)) / 100.0, 100.0 * share / np.sum(bins), line, color=colour, label=name, linewidth=1.3)
    axes.axvline(0.1, color="black", linewidth=0.8, linestyle=":")
    axes.axhline(95.0, color="black", linewidth=0.8, linestyle=":")
    axes.set(xlim=(0.0, 1.1), ylim=(0.0, 101.0), xlabel="angle error, in gaps", ylabel="% of ticks within")
    axes.legend(fontsize=7.5, loc="lower right", frameon=False)


def _history(axes: Any, trace: dict[str, np.ndarray]) -> None:
    t, every = trace["t_s"], slice(None, None, 10)
    scale = 1e3
    axes.fill_between(t[every], 0, 1, where=trace["truth"][every] == 0, transform=axes.get_xaxis_transform(), color="#eeeeee",
                      step="mid", linewidth=0, label="gap open")
    axes.fill_between(t[every], 0, 0.03, where=trace["valid"][every] > 0, transform=axes.get_xaxis_transform(), color="#6aa84f",
                      step="mid", linewidth=0, label="reported valid")
    for name, key, colour, width in (("by commanded direction", "cnc_command_rad", COMMAND, 0.9),
                                     ("machine", "corrected_rad", MACHINE, 1.5), ("truth", "offset_rad", "black", 0.8)):
        axes.plot(t[every], scale * trace[key][every], color=colour, linewidth=width, label=name)
    axes.set(xlim=(t[0], t[-1]), xlabel="s", ylabel="joint less motor angle\nwithin the gap, mrad")
    axes.legend(fontsize=7.5, ncols=5, loc="upper center", bbox_to_anchor=(0.5, 1.2), frameon=False)


def draw(counts: Any, oracle: Any, trace: dict[str, np.ndarray], path: Path) -> None:
    """Write the picture."""
    with matplotlib.rc_context(STYLE):
        figure = plt.figure(figsize=(9.0, 6.4), layout="constrained")
        grid = figure.add_gridspec(2, 2, height_ratios=[1.2, 1.0])
        _wrong(figure.add_subplot(grid[0, 0]), counts)
        _distribution(figure.add_subplot(grid[0, 1]), counts, oracle)
        _history(figure.add_subplot(grid[1, :]), trace)
        figure.savefig(path, metadata={"Date": None, "Creator": None})
        plt.close(figure)
