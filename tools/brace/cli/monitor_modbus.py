"""`brace monitor` over Modbus: asked again and again, shown as what comes by itself over CAN."""

from __future__ import annotations

import argparse
import json
import time
from typing import TYPE_CHECKING

from brace.cli import common
from brace.cli.bus_options import ended_by_signal
from brace.cli.monitor_display import Display, end

if TYPE_CHECKING:
    from brace.bus.modbus_controller import ModbusController
    from brace.bus.url import BusUrl
    from brace.bus.watch import NodeState

_PERIOD_S = 0.05


def monitor_modbus(arguments: argparse.Namespace, url: BusUrl) -> int:
    """Until --seconds, Ctrl-C or SIGTERM."""
    from brace.bus.modbus_controller import ModbusController
    from brace.bus.watch import NodeState, Watch, as_json

    watch = Watch(url.text)
    device = ModbusController(url)
    state = watch.nodes.setdefault(device.node, NodeState())
    display = Display(arguments.json)
    until = time.monotonic() + (arguments.seconds if arguments.seconds is not None else float("inf"))
    try:
        with ended_by_signal() as ended:
            while not ended.is_set() and time.monotonic() < until:
                snapshot = device.live()._replace(
                    load=device.load(), sigma=device.sigma(), interval=device.interval()
                )
                state.last_s = snapshot.time_s
                watch.take(state, snapshot)
                if arguments.json:
                    common.emit(json.dumps(common.json_ready(as_json(snapshot))))
                _report_drift(arguments, device, state, display)
                display.show(watch)
                time.sleep(_PERIOD_S)
    finally:
        display.close()
        device.close()
    return end(arguments, watch)


def _report_drift(arguments: argparse.Namespace, device: ModbusController, state: NodeState, display: Display) -> None:
    """The cause of a drift, when it comes, changes or goes."""
    from brace.bus.drift import cause_text

    has_drifted = "model_drift" in (state.faults or ())
    drift = device.drift() if has_drifted else None
    cause = drift.cause if drift is not None else "none"
    before = state.drift_cause or "none"
    state.drift_cause = cause
    if cause == before:
        return
    if arguments.json:
        reported = drift.as_json() if drift is not None else {"cause": cause}
        common.emit(json.dumps(common.json_ready({"event": "drift", "node": device.node, **reported})))
    elif drift is None:
        display.print_line(f"node {device.node}: the drift has been cleared")
    else:
        display.print_line(f"node {device.node}: model_drift; its likeliest cause is {cause_text(cause)}")
