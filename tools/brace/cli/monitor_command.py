"""`brace monitor`: what controllers report, as it comes."""

from __future__ import annotations

import argparse
import json
import sys
import time
from typing import TYPE_CHECKING, Any

from brace.cli import common
from brace.cli.bus_options import add_bus, bus_url, ended_by_signal

if TYPE_CHECKING:
    from brace.bus.watch import NodeState, Watch

_POLL_S = 0.1
_SILENCE_S = 1.5  # a heartbeat comes each second
_REDRAW_S = 0.2
_LINE_S = 1.0


def add(commands: Any) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "monitor",
        help="live K, ellipse, states, rates, age",
        description="Shows what the controllers of a bus send by themselves, until --seconds, Ctrl-C or "
        "the end of a log; "
        "listens only (over Modbus it asks). A terminal gets a picture, a pipe a line a second, --json a line for "
        "every snapshot, posture, heartbeat and emergency.",
        epilog="Exit codes: 0, 4 nothing heard, 5 the last K is not valid, 6 another dictionary, 130 Ctrl-C.",
    )
    add_bus(parser)
    parser.add_argument("--seconds", type=common.positive, metavar="S", help="how long; default until Ctrl-C")
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    url = bus_url(arguments)
    if url.is_modbus:
        from brace.cli.monitor_modbus import monitor_modbus

        return monitor_modbus(arguments, url)
    from brace.bus.open import open_bus
    from brace.bus.watch import Watch

    watch = Watch(url.text, arguments.node)
    bus = open_bus(url, arguments.bit_rate)
    try:
        with ended_by_signal() as ended:
            follow(arguments, bus, watch, ended)
    finally:
        bus.close()
    return end(arguments, watch)


def follow(arguments: argparse.Namespace, bus: Any, watch: Watch, ended: Any) -> None:
    """Frames from the bus to the display; until the time, SIGTERM, or the end of a log."""
    from brace.bus.frame import EndOfLog
    from brace.bus.watch import as_json

    display = Display(arguments.json)
    started = time.monotonic()
    seconds = getattr(arguments, "seconds", None)
    until = started + seconds if seconds is not None else float("inf")
    try:
        while not ended.is_set() and (now := time.monotonic()) < until:
            frame = bus.receive(min(_POLL_S, until - now))
            event = watch.add(frame) if frame is not None else None
            if event is not None and arguments.json:
                common.emit(json.dumps(common.json_ready(as_json(event))))
            if not watch.nodes and now - started > _SILENCE_S:
                break
            display.show(watch)
    except EndOfLog:
        pass
    finally:
        display.close()
        if arguments.json and sys.stdout is not None:
            sys.stdout.flush()
    if not watch.nodes and not ended.is_set():
        raise _silence(arguments, bus)


def _silence(arguments: argparse.Namespace, bus: Any) -> Exception:
    from brace.errors import NoDeviceError

    why, way = bus.silence()
    who = "no controller is" if arguments.node is None else f"node {arguments.node} is not"
    return NoDeviceError(f"{who} heard", where=bus.url, why=why, next_step=way)


def end(arguments: argparse.Namespace, watch: Watch) -> int:
    """The last word on each node; 5 when a K that is sent is not valid."""
    from brace.errors import EXIT_DEVICE_FAULT, EXIT_OK

    if not arguments.json:
        for node, state in sorted(watch.nodes.items()):
            common.emit(line_of(node, state))
        if watch.joiner.unmatched:
            common.say(
                f"note: {watch.joiner.unmatched} halves of a K came without the other half and were not shown"
            )
    last = [state.snapshot for state in watch.nodes.values() if state.snapshot is not None]
    return EXIT_OK if all(snapshot.is_valid for snapshot in last) else EXIT_DEVICE_FAULT


def line_of(node: int, state: NodeState) -> str:
    """A node in a line."""
    parts = [f"node {node}:"]
    parts.append(
        state.heartbeat.mode
        if state.heartbeat
        else state.posture.mode if state.posture else "no heartbeat yet"
    )
    k = state.snapshot
    if k is None:
        parts.append("K not sent")
    elif k.is_valid:
        parts.append(f"K {k.k_xx:.4f} {k.k_xz:.4f} {k.k_zz:.4f} N/mm")
    else:
        parts.append("K not valid")
    if k is not None:
        parts.append(f"age {'over 127' if k.age_ms is None else format(k.age_ms, 'g')} ms")
        parts.append(f"{state.rate_hz:.0f} Hz")
        parts += k.flags
    faults = state.heartbeat.faults if state.heartbeat else ()
    return " ".join([*parts, *(f"fault {name}" for name in faults)])


class Display:
    """A picture on a terminal, a line a second on a pipe, nothing with --json."""

    def __init__(self, as_json: bool) -> None:
        self._next_s = time.monotonic() + (_LINE_S if not _terminal() else 0.0)
        self._quiet = as_json
        self._live: Any = None
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

    def close(self) -> None:
        """Leaves the terminal clean."""
        if self._live:
            self._live.stop()


def _terminal() -> bool:
    return sys.stdout is not None and sys.stdout.isatty()


def picture(watch: Watch) -> Any:
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
    k, posture, beat = state.snapshot, state.posture, state.heartbeat
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
        lines += ellipse(k.k_xx, k.k_xz, k.k_zz)
    if posture is not None and None not in (posture.lambda_min, posture.lambda_max, posture.stiff_axis):
        lines.append(f"eigenvalues {posture.lambda_min:.4f}, {posture.lambda_max:.4f} N/mm")
        lines.append(f"stiff axis {posture.stiff_axis:.4f} rad")
    if posture is not None and None not in (posture.theta1, posture.theta2):
        lines.append(f"theta1 {posture.theta1:.4f}, theta2 {posture.theta2:.4f} rad")
    if k is not None:
        lines.append(
            f"age {'over 127' if k.age_ms is None else format(k.age_ms, 'g')} ms, {state.rate_hz:.0f} Hz"
        )
        lines.append(f"play {k.play[0]}, {k.play[1]}" if len(k.play) == 2 else "play not sent")
        lines.append(f"flags {' '.join(k.flags) or 'none'}")
    if beat is not None:
        lines.append(f"{beat.mode} ({beat.state}), faults {' '.join(beat.faults) or 'none'}")
    return lines
