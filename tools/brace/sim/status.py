"""What a person sees of a running simulation: one line while it runs, one per limb when it ends."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from brace.sim.node import LimbState

from brace.stiffness.names import SPATIAL_K


def line_of(state: LimbState) -> str:
    """A limb in a line."""
    if state["k_is_valid"]:
        k = "K {k_xx_n_per_mm:.3f} {k_xz_n_per_mm:.3f} {k_zz_n_per_mm:.3f} N/mm".format_map(state)
    else:
        k = "K not valid"
    space = state.get("space")
    if space is not None:
        k += f", {_in_space(space)}"
    k += f", {_load_words(state['load'])}"
    notes = [*state["flag_names"], *(f"fault {name}" for name in state["faults"])]
    return f"limb {state['limb']}: {state['mode']}, {k}" + (f" ({', '.join(notes)})" if notes else "")


def _load_words(load: Mapping[str, object]) -> str:
    if not load["is_counted"]:
        return "no load counted"
    factor = load["buckling_factor"]
    buckling = "none" if factor is None else f"{factor:.2f}"
    return (
        "load {force_x_n:.2f} {force_z_n:.2f} N, moved {moved_x_mm:.2f} {moved_z_mm:.2f} mm, "
        "buckling factor {buckling}, K without load "
        "{unloaded_k_xx_n_per_mm:.3f} {unloaded_k_xz_n_per_mm:.3f} {unloaded_k_zz_n_per_mm:.3f} N/mm"
    ).format_map({**load, "buckling": buckling})


def _in_space(space: Mapping[str, object]) -> str:
    if not space["k_is_valid"]:
        return "K in space not valid"
    entries = " ".join(f"{{{name}:.3f}}" for name in SPATIAL_K)
    return f"K in space {entries} N/mm".format_map(space)


class LiveLine:
    """One line on stderr, written over itself, if stderr is a terminal."""

    def __init__(self) -> None:
        self._shown = False
        self.wanted = sys.stderr is not None and sys.stderr.isatty()

    def show(self, time_s: float, states: Sequence[LimbState], stats: dict[str, int]) -> None:
        """Anew."""
        if not self.wanted:
            return
        parts = [f"{time_s:8.1f} s", *(line_of(state) for state in states)]
        parts.append(f"{stats['can_clients']} CAN clients, {stats['can_sent']} frames")
        if stats["slipped_us"]:
            parts.append(f"{stats['slipped_us'] / 1e6:.1f} s behind the clock")
        width = shutil.get_terminal_size().columns - 1
        sys.stderr.write("\r\x1b[K" + " | ".join(parts)[:width])
        sys.stderr.flush()
        self._shown = True

    def clear(self) -> None:
        """Leaves the terminal clean."""
        if self._shown:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()
            self._shown = False
