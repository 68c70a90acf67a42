"""`brace record --loading-test`: the controller's own loading test as a dataset."""

from __future__ import annotations

import argparse
import math
from typing import Any

from brace.cli import common
from brace.cli.bus_options import bus_url, session, undone_by_signal


def record_loading(arguments: argparse.Namespace) -> int:
    """Runs, fetches, writes."""
    from brace.bus.can_controller import CanController
    from brace.bus.loading_test import Plan, fetch, run
    from brace.dataset.write import write_dataset
    from brace.errors import UsageError

    if arguments.out.suffix in (".log", ".mcap"):
        raise UsageError(
            "a dataset is a folder",
            where=f"--out {arguments.out}",
            why="it has meta.toml and data.csv",
            next_step="--out DIR",
        )
    axes = "xz" if arguments.axis == "both" else arguments.axis
    with undone_by_signal(), session(arguments, bus_url(arguments, "a loading test")) as opened:
        device = CanController(opened)
        with common.progress("loading test") as advance:
            for axis in axes:
                run(opened, Plan(axis, arguments.steps, arguments.step_mm, arguments.dwell_s), advance)
        with common.progress("fetching its rows") as advance:
            columns = fetch(opened, len(axes), advance)
        meta = _meta(arguments, device)
    rows = len(columns["run"])
    write_dataset(arguments.out, meta, columns)
    found = _refuse_unsound(arguments)
    if arguments.json:
        common.print_json(
            {"out": arguments.out, "rows": rows, "runs": len(axes), "node": device.node, "faults": found}
        )
    else:
        common.say(
            f"{arguments.out}: {len(axes)} run{'s' if len(axes) > 1 else ''}, {rows} rows; brace "
            f"identify {arguments.out} --model LIMB.toml"
        )
    return 0


def _meta(arguments: argparse.Namespace, device: Any) -> dict[str, Any]:
    from brace.bus.entries import value_of

    sensed = bool(device.read_entry("force_is_sensed"))
    limit = value_of("sensor.saturation_n", device.read_entry("sensor.saturation_n"))
    sensor: dict[str, Any] = {"resolution_n": 0.0, "source": "tip sensor" if sensed else "joint loads"}
    if limit is not None and math.isfinite(limit):
        sensor["range_n"] = float(limit)
    identity = device.identify()
    return {
        "format": 1,
        "kind": "loading",
        "title": arguments.title or f"loading test of node {device.node}",
        "zeroed": "per_run",  # a row counts from the first reading
        "parameter_crc": f"{identity.parameter_crc:08x}",
        "firmware": identity.version,
        "sensor": sensor,
        "rig": {"step_mm": arguments.step_mm, "dwell_s": arguments.dwell_s},
    }


def _refuse_unsound(arguments: argparse.Namespace) -> list[str]:
    """What intake would say of it, told at once."""
    from brace.dataset.intake import load_dataset

    found = [f"row {fault.row}, {fault.field}: {fault.why}" for fault in load_dataset(arguments.out).faults]
    for text in found[:5]:
        common.say(f"note: {text}")
    return found
