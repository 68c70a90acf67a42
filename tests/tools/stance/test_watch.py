"""`brace stance watch` on the bus of a simulated robot, whose mechanics share no code with it."""

from __future__ import annotations

import contextlib
import csv
import json
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_bench import PROJECT, Outcome, spawn

EXAMPLE = PROJECT / "examples" / "stance"
NAMES = ["front left", "front right", "rear left", "rear right"]
SECONDS = 13  # a busy machine begins late


@pytest.fixture
def stance(tmp_path: Path) -> Path:
    for name in ("stance.toml", "limb.toml"):
        shutil.copy(EXAMPLE / name, tmp_path / name)
    return tmp_path / "stance.toml"


@contextlib.contextmanager
def robot(stance: Path, *options: object) -> Iterator[str]:
    """A simulated robot in step with the clock; where its bus is."""
    process = spawn(
        "sim",
        "--stance",
        stance,
        "--json",
        "--modbus",
        "none",
        "--can",
        "tcp://127.0.0.1:0",
        *options,
    )
    try:
        assert process.stdout is not None
        ready = json.loads(process.stdout.readline())
        yield ready["limbs"][0]["can"]
    finally:
        process.kill()
        process.wait()


def events(outcome: Outcome) -> dict[str, list[Any]]:
    found: dict[str, list[Any]] = {}
    for line in outcome.out.splitlines():
        event = json.loads(line)
        found.setdefault(event["event"], []).append(event)
    return found


def test_what_is_hung_on_and_who_bears_it(
    brace: Callable[..., Outcome], stance: Path, tmp_path: Path
) -> None:
    truth, log = tmp_path / "truth.csv", tmp_path / "bus.log"
    with robot(stance, "--payload", "2@8", "--truth", truth, "--seconds", 60) as bus:
        recorded = brace("record", "--bus", bus, "--out", log, "--seconds", SECONDS)
    assert recorded.code == 0, recorded.err
    said = brace("stance", "watch", stance, "--bus", f"log:{log}", "--json")
    assert said.code == 0, said.err
    found = events(said)
    assert "load" in found and not {"lifted", "landed", "moved", "soft"} & set(found)
    assert len(found["stance"]) <= SECONDS + 1  # one each second
    last = found["stance"][-1]
    assert [limb["name"] for limb in last["limbs"]] == NAMES
    with truth.open() as file:
        after = [row for row in csv.DictReader(file) if float(row["t_s"]) > 9.0][:4]
    true_n = np.array([[float(row[f"f{axis}_n"]) for axis in "xyz"] for row in after])
    low, high = (
        np.array([limb[f"force_{end}_n"] for limb in last["limbs"]])
        for end in ("low", "high")
    )
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    assert np.all(np.abs(middle - true_n) < 3.0 * half)  # five sigmas of the filter: friction is no Gaussian
    assert np.all(half[:, 2] < 1.0)
    carried, sigma_n = (
        np.array(last["carried"][key]) for key in ("force_n", "force_sigma_n")
    )
    assert np.all(np.abs(carried - [8.0, 0.0, -4.0]) < 4.0 * sigma_n) and np.all(
        sigma_n < 2.0
    )
    assert all(limb["age_ms"] is not None for limb in last["limbs"])
    with truth.open() as file:
        moved = {
            float(row["t_s"]): [float(row[f"body_{axis}_mm"]) for axis in "xyz"]
            for row in csv.DictReader(file)
        }
    true_mm = np.array(moved[9.0]) - moved[7.0]
    # joints that the load turns are no set-points that moved: they would add half as much again
    assert np.abs(np.array(last["body"]["displacement_mm"]) - true_mm).max() < 0.25


def test_a_lift_is_an_event_and_an_alarm_may_end_it(
    brace: Callable[..., Outcome], stance: Path, tmp_path: Path
) -> None:
    log = tmp_path / "bus.log"
    with robot(stance, "--lift", "rear left@8", "--seconds", 60) as bus:
        recorded = brace("record", "--bus", bus, "--out", log, "--seconds", SECONDS)
        live = brace("stance", "watch", stance, "--bus", bus, "--seconds", 1)
    assert recorded.code == 0, recorded.err
    assert live.code == 0 and "rear left" in live.out, live.err
    said = brace("stance", "watch", stance, "--bus", f"log:{log}", "--json")
    assert said.code == 0, said.err
    found = events(said)
    assert [event["limb"] for event in found["lifted"]] == ["rear left"]
    assert [limb["state"] for limb in found["stance"][-1]["limbs"]] == [
        "sticks",
        "sticks",
        "open",
        "sticks",
    ]
    words = brace("stance", "watch", stance, "--bus", f"log:{log}").out
    assert "rear left: has left the ground" in words and "in the air" in words
    alarm = brace(
        "stance",
        "watch",
        stance,
        "--bus",
        f"log:{log}",
        "--alarm",
        "100",
        "--alarm-ends",
    )
    assert alarm.code == 1 and "ALARM" in alarm.out


def test_a_limb_that_is_not_heard_is_named(
    brace: Callable[..., Outcome], stance: Path
) -> None:
    stranger = stance.with_name("other.toml")
    stranger.write_text(
        stance.read_text().replace('name = "rear left"', 'name = "rear left"\nnode = 9')
    )
    with robot(stance, "--seconds", 60) as bus:
        said = brace("stance", "watch", stranger, "--bus", bus, "--seconds", 20)
        assert (
            said.code == 4 and "rear left" in said.err and "front left" not in said.err
        )
        assert brace("stance", "watch", stance, "--bus", bus, "--node", 1).code == 2
