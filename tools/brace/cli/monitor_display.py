"""How `brace monitor` shows what it hears: a picture on a terminal, a line a second on a pipe."""

from __future__ import annotations

import argparse
import sys
import time
from typing import TYPE_CHECKING

from brace.cli import common
from brace.ground.errors import located

if TYPE_CHECKING:
    from rich.columns import Columns
    from rich.live import Live

    from brace.bus.load import Load
    from brace.bus.sigma import Sigma
    from brace.bus.snapshot import Emergency, Snapshot
    from brace.bus.watch import NodeState, Watch

_REDRAW_S = 0.2
_LINE_S = 1.0
_LOAD_LATE_S = 2.0  # it may come more seldom than K
_SPACE_LATE_S = 1.0  # K in space comes within milliseconds of K in the plane


_FLAG_WORDS = {  # shorter than the dictionary's, for a panel
    "UNCALIBRATED": "not this limb's parameters",
    "NEAR_SINGULAR": "accuracy not promised here",
    "SATURATED": "a value did not fit its frame",
    "GAP_OPEN": "a joint's play may be open",
    "STALE": "too old, or a mode without K",
    "OUT_OF_RANGE": "posture outside the model's range",
    "LOAD_UNKNOWN": "no load counted",
    "SOFTENED": "the load makes it much softer",
    "MOVED_FAR": "the load moves the tip too far for its accuracy",
    "PLAY_ASSUMED": "the load holds a joint's play; not proven",
}


def end(arguments: argparse.Namespace, watch: Watch) -> int:
    """The last word on each node; 5 when a K that is sent is not valid."""
    from brace.ground.errors import EXIT_DEVICE_FAULT, EXIT_OK

    if not arguments.json:
        for node, state in sorted(watch.nodes.items()):
            common.emit(line_of(node, state))
        if watch.joiner.unmatched:
            common.say(
                f"note: {watch.joiner.unmatched} times some frames of a K came without the others; that K is not shown"
            )
    last = [state.snapshot for state in watch.nodes.values() if state.snapshot is not None]
    return EXIT_OK if all(snapshot.is_valid for snapshot in last) else EXIT_DEVICE_FAULT


def line_of(node: int, state: NodeState) -> str:
    """A node in a line."""
    parts = [f"node {node}:"]
    parts.append(state.mode or "no heartbeat yet")
    k = shown(state)
    if k is None:
        parts.append("K not sent")
    elif k.is_valid:
        parts.append(f"K {k.k_xx:.4f} {k.k_xz:.4f} {k.k_zz:.4f} N/mm")
    else:
        parts.append("K not valid")
    sigma = _sigma(state)
    if k is not None and k.is_valid and sigma is not None:
        parts.append(f"({sigma.words('GAP_OPEN' in k.flags)})")
    if k is not None and k.space is not None:
        from brace.cli.space_text import space_words

        parts += space_words(k.space)
    if k is not None:
        parts.append(f"age {'over 127' if k.age_ms is None else format(k.age_ms, 'g')} ms")
        parts.append(f"{state.rate_hz:.0f} Hz")
        parts += k.flags
    load = _load(state)
    line = " ".join([*parts, *(f"fault {name}" for name in fault_words(state))])
    return "; ".join([line, *([] if load is None else [", ".join(load.words())]), *_interval_words(state)])


def shown(state: NodeState) -> Snapshot | None:
    """The newest snapshot with all that the node sends of K: what is shown together is of one tick."""
    space, newest = state.space, state.snapshot
    has_space = space is not None and newest is not None and newest.time_s - space.time_s < _SPACE_LATE_S
    return space if has_space else newest


def _load(state: NodeState) -> Load | None:
    """The newest load; None: none has come lately."""
    reported, newest = state.load, state.snapshot
    if reported is None or newest is None or newest.time_s - reported.time_s > _LOAD_LATE_S:
        return None
    return reported.load


def _interval_words(state: NodeState) -> list[str]:
    """The newest; nothing where none has come lately."""
    reported, newest = state.interval, state.snapshot
    is_late = reported is None or newest is None or newest.time_s - reported.time_s > _LOAD_LATE_S
    return [] if reported is None or reported.interval is None or is_late else reported.interval.words()


def _sigma(state: NodeState) -> Sigma | None:
    """The newest uncertainty; None: none has come lately."""
    reported, newest = state.sigma, state.snapshot
    if reported is None or newest is None or newest.time_s - reported.time_s > _LOAD_LATE_S:
        return None
    return reported.sigma


def fault_words(state: NodeState) -> list[str]:
    """Names of the faults that are there, a drift with its cause where it has been reported."""
    names = list(state.faults or ())
    cause = state.drift_cause
    return [f"{name} ({cause})" if name == "model_drift" and cause not in ("", "none") else name for name in names]


def emergency_line(emergency: Emergency) -> str:
    """What has changed, and of a drift its cause."""
    from brace.bus.drift import cause_text

    faults = f"faults now: {' '.join(emergency.faults)}" if emergency.faults else "all faults are over"
    line = f"node {emergency.node}: {faults}"
    if emergency.drift_cause != "none":
        line += f"; the drift's likeliest cause is {cause_text(emergency.drift_cause)}"
    return line


class Display:
    """A picture on a terminal, a line a second on a pipe, nothing with --json."""

    def __init__(self, as_json: bool) -> None:
        self._next_s = time.monotonic() + (_LINE_S if not _terminal() else 0.0)
        self._quiet = as_json
        self._live: Live | None = None
        if not as_json and _terminal():
            from rich.live import Live

            self._live = Live(refresh_per_second=10, transient=True)
            self._live.start()

    def show(self, watch: Watch) -> None:
        """When it is time."""
        now = time.monotonic()
        if self._quiet or now < self._next_s:
            return
        self._next_s = now + (_REDRAW_S if self._live else _LINE_S)
        if self._live:
            self._live.update(picture(watch))
            return
        for node, state in sorted(watch.nodes.items()):
            common.emit(line_of(node, state))
        if sys.stdout is not None:
            sys.stdout.flush()

    def print_line(self, line: str) -> None:
        """A line of its own, at once."""
        if self._quiet:
            return
        if self._live:
            self._live.console.print(line, markup=False, highlight=False)
        else:
            common.emit(line)
            if sys.stdout is not None:
                sys.stdout.flush()

    def close(self) -> None:
        """Leaves the terminal clean."""
        if self._live:
            self._live.stop()


def _terminal() -> bool:
    return sys.stdout is not None and sys.stdout.isatty()


def picture(watch: Watch) -> Columns:
    """All nodes side by side."""
    from rich.columns import Columns
    from rich.panel import Panel

    panels = []
    for node, state in sorted(watch.nodes.items()):
        silent = time.time() - state.last_s
        title = f"node {node}" + (f" - silent for {silent:.0f} s" if silent > 2.0 else "")
        panels.append(Panel("\n".join(_lines(state)), title=title, expand=False))
    return Columns(panels)


def _lines(state: NodeState) -> list[str]:
    from brace.bus.open_play import open_play_lines

    k, posture, beat = shown(state), state.posture, state.heartbeat
    lines = []
    if k is None:
        lines.append("K not sent")
    elif (
        not k.is_valid
        or not isinstance(k.k_xx, float)
        or not isinstance(k.k_xz, float)
        or not isinstance(k.k_zz, float)
    ):
        lines.append("K not valid")
    else:
        from brace.cli.ellipse import ellipse

        lines += [f"K  {k.k_xx:10.4f} {k.k_xz:10.4f}", f"   {k.k_xz:10.4f} {k.k_zz:10.4f}  N/mm"]
        sigma = _sigma(state)
        lines += [] if sigma is None else [sigma.words("GAP_OPEN" in k.flags)]
        lines += ellipse(k.k_xx, k.k_xz, k.k_zz)
    if k is not None and k.space is not None:
        from brace.cli.space_text import coxa_lines, space_lines

        lines += [*space_lines(k.space), *coxa_lines(k.space)]
    if posture is not None and None not in (posture.lambda_min, posture.lambda_max, posture.stiff_axis):
        lines.append(f"eigenvalues {posture.lambda_min:.4f}, {posture.lambda_max:.4f} N/mm")
        lines.append(f"stiff axis {posture.stiff_axis:.4f} rad")
    load = _load(state)
    if load is not None:
        lines += load.words()
    lines += _interval_words(state)
    if posture is not None and None not in (posture.theta1, posture.theta2):
        lines.append(f"theta1 {posture.theta1:.4f}, theta2 {posture.theta2:.4f} rad")
    if k is not None:
        lines.append(
            f"age {'over 127' if k.age_ms is None else format(k.age_ms, 'g')} ms, {state.rate_hz:.0f} Hz"
        )
        lines.append(f"play {k.play[0]}, {k.play[1]}" if len(k.play) == 2 else "play not sent")
        lines += open_play_lines(k.flags, k.play, "URL")
        lines += [f"flag {name}: {_FLAG_WORDS.get(name, located('docs/errors.md'))}" for name in k.flags] or ["flags none"]
    if beat is not None:
        faults = "not heard yet" if state.faults is None else " ".join(fault_words(state)) or "none"
        lines.append(f"{state.mode} ({beat.state}), faults {faults}")
    return lines
