"""`brace import`: files that no program should end at."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_bench import Outcome
from foreign_files import POSES_DEG, Record, one_axis, shown, text

from brace.dataset import load_dataset

Brace = Callable[..., Outcome]


def test_a_pipe_is_refused(brace: Brace, tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.csv"
    os.mkfifo(pipe)
    refused = brace("import", pipe, "--yes", "--out", tmp_path / "out")
    assert refused.code == 3 and "not a regular file" in refused.err


def test_a_line_of_any_length_is_text(brace: Brace, tmp_path: Path) -> None:
    path = one_axis(tmp_path)[0]
    path.write_text(path.read_text() + "x" * 200_000 + "\n")
    done = brace("import", path, "--yes", "--out", tmp_path / "out")
    assert done.code == 0 and "1 line among or below the readings left out" in done.err, done.err[-2000:]


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ("number = 1", 'number = "nine"', "number = 'nine' is no place"), ("number = 1", "number = 1.5", "no place"),
        ('kind = "loading"', 'kind = ["loading"]', "is no kind of record"),
        ('is = "t_s"', "is = []", "is = [] says nothing"), ("sign = 1", "sign = 1\noffset = nan", "is not a number"),
        ('value = "x"', 'value = "inf"\nunit = "deg"', "no axis"),
    ],
)  # fmt: skip
def test_a_mapping_of_other_types_is_refused_with_its_line(
    brace: Brace, tmp_path: Path, before: str, after: str, words: str
) -> None:
    r = Record(poses=POSES_DEG[:1], axes="x", repeats=1)
    path, mapping = tmp_path / "a.csv", tmp_path / "m.toml"
    columns = [shown(r[name]) for name in ("t", "theta1", "theta2", "dx", "fx")]
    path.write_text(text(["t [s],theta1 [deg],theta2 [deg],d [mm],F [N]"], columns, ","))
    brace("import", path, "--set", "axis=x", "--draft", mapping)
    assert before in mapping.read_text()
    mapping.write_text(mapping.read_text().replace(before, after, 1))
    refused = brace("import", path, "--mapping", mapping, "--out", tmp_path / "out")
    assert refused.code == 3 and words in refused.err and f"{mapping}:" in refused.err, refused.err


def mcap(path: Path, others: list[tuple[str, float, bytes]]) -> Path:
    """A log of JSON topics of one run, and other messages among them."""
    from mcap.writer import Writer

    r = Record(poses=POSES_DEG[:1], axes="x", repeats=1)
    messages = list(others)
    for t, dx, fx in zip(r["t"], r["dx"], r["fx"]):
        messages.append(("/rig", float(t), json.dumps({"dx_mm": dx, "Fx_N": fx}).encode()))
    names = [f"m{n}" for n in range(40)] + ["femur", "knee"]
    angles = [0.0] * 40 + np.radians(POSES_DEG[0]).tolist()
    for t in np.arange(-1.0, float(r["t"][-1]) + 1.0, 0.5):
        messages.append(("/legs", float(t), json.dumps({"name": names, "angle_rad": angles}).encode()))
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        schema = writer.register_schema("any", "jsonschema", b'{"type":"object"}')
        channels = {topic: writer.register_channel(topic, "json", schema) for topic, _, _ in messages}
        for topic, t, data in sorted(messages, key=lambda each: each[1]):
            time_ns = int((t + 100.0) * 1e9)
            writer.add_message(channels[topic], log_time=time_ns, publish_time=time_ns, data=data)
        writer.finish()  # type: ignore[no-untyped-call]
    return path


def test_messages_that_cannot_be_read_are_counted(brace: Brace, tmp_path: Path) -> None:
    """And so is a list that is too long; one with a name for each entry is read, of any length."""
    pytest.importorskip("mcap")
    others = [
        ("/log", 5.0, b"not json"), ("/log", 6.0, b"nor this"), ("/deep", 7.0, b"[" * 100_000 + b"]" * 100_000),
        ("/id", 8.0, b'{"serial": 1' + b"0" * 400 + b"}"), ("/scan", 9.0, json.dumps({"ranges": [1.5] * 50}).encode()),
        ("/goal", 10.0, b'{"tip_position": {"x_mm": 5.0}}'),
    ]  # fmt: skip
    asked = brace("import", mcap(tmp_path / "a.mcap", others), "--yes", "--out", tmp_path / "out")
    for words in ("topic /log: 2 messages cannot be read", "topic /deep: 1 message cannot be read",
                  "/scan.ranges is left out: a list of more than 32", "/legs.angle_rad.knee",
                  "17 rows", "what was asked for, not what was done"):  # fmt: skip
        assert words in asked.err, asked.err
    assert "Traceback" not in asked.err and asked.code in (0, 2), asked.err


def test_a_remark_above_the_frames_of_a_log(brace: Brace, tmp_path: Path) -> None:
    import logs_of_a_rig as rig

    pytest.importorskip("cantools")
    log, dbc = rig.candump(tmp_path, Record()), rig.database(tmp_path)
    log.write_text("# recorded by me\n" + log.read_text())
    done = brace("import", log, "--dbc", dbc, "--out", tmp_path / "out", "--yes")
    assert done.code == 0 and "1 line with # in front left out" in done.err, done.err
    assert load_dataset(tmp_path / "out").rows == Record().rows
