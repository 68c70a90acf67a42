"""`brace record --loading-test`: the controller's own loading test as a dataset."""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from brace.cli import common
from brace.cli.bus_options import bus_url, session, undone_by_signal

if TYPE_CHECKING:
    from brace.bus.controller import Controller
    from brace.dataset import Dataset

_FILES = ("meta.toml", "data.csv")


def record_loading(arguments: argparse.Namespace) -> int:
    """Runs, fetches, writes."""
    from brace.bus.can_controller import CanController
    from brace.bus.loading_added import meta_of_both, refuse_what_would_go
    from brace.bus.loading_rows import PRELOADS, added, counted_from_first, on_one_clock, with_motor_angles
    from brace.bus.loading_test import Plan, fetch, run
    from brace.dataset.write import write_dataset
    from brace.ground.errors import UsageError
    from brace.ground.files import check_folder

    if arguments.out.suffix in (".log", ".mcap"):
        raise UsageError(
            "a dataset is a folder",
            where=f"--out {arguments.out}",
            why="it has meta.toml and data.csv",
            next_step="--out DIR",
        )
    check_folder(arguments.out, _FILES)  # before anything moves
    if not arguments.add:
        _refuse_record(arguments.out)
    axes = "xz" if arguments.axis == "both" else arguments.axis
    before = _record_before(arguments.out) if arguments.add and arguments.out.exists() else None
    if before is not None:
        refuse_what_would_go(arguments.out, before.meta.document.content)
    started: list[float] = []
    with undone_by_signal(), session(arguments, bus_url(arguments, "a loading test", answers=True)) as opened:
        device = CanController(opened)
        meta = _meta(arguments, device)
        if before is not None:
            _refuse_other_limb(arguments.out, before.meta.document.content, meta)
        plans = [Plan(axis, arguments.steps, arguments.step_mm, arguments.dwell_s) for axis in axes]
        common.say(
            f"{_runs(axes)}, {sum(plan.rows for plan in plans)} readings: about {sum(plan.quick_s for plan in plans):.0f} s "
            f"with servos that settle quickly, at most {sum(plan.most_s for plan in plans):.0f} s"
        )
        with common.progress("loading test") as advance:
            for plan in plans:
                started.append(time.time())
                run(opened, plan, advance)
        with common.progress("fetching its rows") as advance:
            columns = fetch(opened, len(axes), advance)
        with common.progress("reading its parameters") as advance:
            model = device.download(advance).model  # it computed the displacements with them
    columns = counted_from_first(with_motor_angles(on_one_clock(columns, started), model))
    rows = len(columns["run"])
    if before is not None:
        ended_s = before.meta.document.content.get("ended_unix_s")
        pause_s = started[0] - ended_s if isinstance(ended_s, (int, float)) else None
        lost = sorted(set(before.columns) - set(columns) - set(PRELOADS))
        columns = added(dict(before.columns), columns, pause_s)
        for name in lost:
            common.say(f"note: {name} is left out: this test has none, and a record has each column in all of its runs")
        meta = meta_of_both(before.meta.document.content, meta)
        meta["title"] = arguments.title or before.meta.title
    meta.pop("ended_unix_s", None)
    meta = {"ended_unix_s": round(time.time(), 3), **meta}
    write_dataset(arguments.out, meta, columns)
    found = _refuse_unsound(arguments)
    config, total = int(columns["config"][-1]), len(set(columns["config"].tolist()))
    if arguments.json:
        common.print_json(
            {
                "out": arguments.out,
                "rows": rows,
                "runs": len(axes),
                "node": device.node,
                "config": config,
                "configs": total,
                "faults": found,
            }
        )
    else:
        many = f" as configuration {config}; {total} in all" if arguments.add else ""
        common.say(
            f"{arguments.out}: {_runs(axes)}, {rows} rows{many}; brace "
            f"diagnose {arguments.out} --model LIMB.toml --out DIR"
        )
    return 0


def _runs(axes: str) -> str:
    return "1 run" if len(axes) == 1 else f"{len(axes)} runs"


def _refuse_record(folder: Path) -> None:
    """What was measured is added to, never replaced."""
    from brace.ground.errors import UsageError

    for name in _FILES:
        if (folder / name).exists():
            raise UsageError(
                "the output would replace a record that is there",
                where=str(folder / name),
                why="a test may not come out the same again",
                next_step="--add makes this one its next configuration or repeat; or choose another --out",
            )


def _record_before(folder: Path) -> Dataset:
    """The record to which a posture is added."""
    from brace.dataset import load_dataset
    from brace.ground.errors import UsageError

    dataset = load_dataset(folder)
    if dataset.kind != "loading":
        raise UsageError(
            f"--add to a {dataset.kind.replace('_', ' ')} record",
            where=str(folder),
            why="a loading test is added to a loading record",
            next_step="--out another folder",
        )
    return dataset


def _refuse_other_limb(folder: Path, before: Mapping[str, object], now: Mapping[str, object]) -> None:
    """One record is of one limb with one set of parameters."""
    from brace.ground.errors import UsageError

    for name, meaning in (("parameter_crc", "set of parameters"), ("firmware", "firmware")):
        if before.get(name) != now[name]:
            raise UsageError(
                f"the controller has another {meaning} than when the record was begun",
                where=str(folder),
                why=f"{name} was {before.get(name, 'not known')}, is {now[name]}; postures of one record "
                "belong together",
                next_step="--out another folder",
            )


def _meta(arguments: argparse.Namespace, device: Controller) -> dict[str, object]:
    from brace.bus.entries import number_of

    sensed = bool(device.read_entry("force_is_sensed"))
    limit = number_of("sensor.saturation_n", device.read_entry("sensor.saturation_n"))
    sensor: dict[str, object] = {"resolution_n": 0.0, "source": "tip sensor" if sensed else "joint loads"}
    if math.isfinite(limit):
        sensor["range_n"] = limit
    identity = device.identify()
    return {
        "format": 1,
        "kind": "loading",
        "title": arguments.title or f"loading test of node {device.node}",
        "zeroed": "per_run",  # a row counts from the first reading
        "parameter_crc": f"{identity.parameter_crc:08x}",
        "firmware": identity.version,
        "sensor": sensor,
        "rig": {"step_mm": arguments.step_mm, "dwell_s": arguments.dwell_s, "moved_by": "motors"},
    }


def _refuse_unsound(arguments: argparse.Namespace) -> list[str]:
    """What intake would report of it, at once."""
    from brace.dataset.intake import load_dataset

    found = [f"row {fault.row}, {fault.field}: {fault.why}" for fault in load_dataset(arguments.out).faults]
    for text in found[:5]:
        common.say(f"note: {text}")
    return found
