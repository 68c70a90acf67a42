"""`brace monitor` over Modbus: asked again and again, shown as what comes by itself over CAN."""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import replace
from typing import TYPE_CHECKING

from brace.cli import common
from brace.cli.bus_options import ended_by_signal
from brace.cli.monitor_command import Display, end

if TYPE_CHECKING:
    from brace.bus.url import BusUrl

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
                snapshot = device.live()
                state.posture = snapshot
                state.last_s = snapshot.time_s
                watch.count(state, replace(snapshot, has_posture=False))
                if arguments.json:
                    common.emit(json.dumps(common.json_ready(as_json(snapshot))))
                display.show(watch)
                ended.wait(_PERIOD_S)
    finally:
        display.close()
        device.close()
    return end(arguments, watch)
