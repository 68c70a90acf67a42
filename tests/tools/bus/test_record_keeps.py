"""`brace record` replaces nothing that was recorded, and keeps what a person wrote into a record."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from bus_bench import adapter, limb_on_tcp, obliging
from command_bench import LIMB, Outcome

from brace.bus.loading_added import meta_of_both
from brace.dataset import load_dataset

Brace = Callable[..., Outcome]
LOG = "(1700000000.000000) can0 181#0102030405060708\n" * 3
TEST = ("--loading-test", "--axis", "x", "--steps", 2, "--step-mm", 0.5, "--add")


def test_a_log_is_not_replaced(brace: Brace, tmp_path: Path) -> None:
    """Neither one that is there, nor what a recording left that was cut off, nor the log that is read."""
    log = tmp_path / "run.log"
    log.write_text(LOG)
    same = brace("record", "--bus", f"log:{log}", "--out", log)
    assert same.code == 2 and "replace an input" in same.err
    other = tmp_path / "other.log"
    other.write_text("kept")
    there = brace("record", "--bus", f"log:{log}", "--out", other)
    assert there.code == 2 and "replace a log that is there" in there.err
    part = tmp_path / "third.log.part"
    part.write_text(LOG)
    left = brace("record", "--bus", f"log:{log}", "--out", tmp_path / "third.log")
    assert left.code == 2 and f"--bus log:{part}" in left.err
    assert (log.read_text(), other.read_text(), part.read_text()) == (LOG, "kept", LOG)
    done = brace("record", "--bus", f"log:{part}", "--out", tmp_path / "fourth.log")
    assert done.code == 0 and (tmp_path / "fourth.log").read_text().count("181#") == 3, done.err


def test_frames_that_are_left_out_are_counted(brace: Brace, tmp_path: Path) -> None:
    """29-bit identifiers and remote frames: of a log, and of an adapter."""
    log = tmp_path / "all.log"
    log.write_text(LOG + "(1.1) can0 18FFEE00#00\n(1.2) can0 123#R\n(1.3) can0 18FFEE00#0102\n")
    done = brace("record", "--bus", f"log:{log}", "--out", tmp_path / "a.log")
    assert done.code == 0 and "left out, with 29-bit identifiers or remote: 3 of the frames heard" in done.err
    told = json.loads(brace("record", "--bus", f"log:{log}", "--out", tmp_path / "again.log", "--json").out)
    assert told["frames"] == 3 and told["frames_left_out"] == 3
    with adapter(obliging, sends=b"t18110A\rT18FFEE00100\rr1230\r") as url:
        done = brace("record", "--bus", url, "--out", tmp_path / "b.log", "--seconds", 0.5, "--json")
    told = json.loads(done.out)
    one_more = told["frames"] + 1  # came, and was not written any more
    assert done.code == 0 and 0 < 2 * told["frames"] <= told["frames_left_out"] <= 2 * one_more, done.err
    done = brace("record", "--bus", f"log:{tmp_path / 'b.log'}", "--out", tmp_path / "c.log")
    assert done.code == 0 and "left out" not in done.err


@pytest.mark.minutes
def test_a_long_gap_of_a_log_is_told_before_it_is_waited_for(brace: Brace, tmp_path: Path) -> None:
    log = tmp_path / "gap.log"
    log.write_text("(1.0) can0 181#00\n(3601.0) can0 181#01\n")
    with adapter(obliging) as url:
        done = brace("replay", log, "--bus", url, "--speed", 500)
        assert done.code == 0 and "the log's next frame comes in 7 s; --speed F goes faster" in done.err, done.err
        done = brace("replay", log, "--bus", url, "--speed", 10000)
        assert done.code == 0 and "next frame" not in done.err, done.err


def test_what_a_person_added_to_a_record_stays(brace: Brace, tmp_path: Path) -> None:
    limb, out = tmp_path / "limb.toml", tmp_path / "test"
    limb.write_text(LIMB)
    with limb_on_tcp(limb, "--posture=1.0,1.4", "--speed", 5) as url:
        assert brace("record", "--bus", url, *TEST, "--out", out).code == 0
        meta = out / "meta.toml"
        meta.write_text('held = "at rest"\n' + meta.read_text() + '[source]\noperator = "M. Keller"\n')
        outcome = brace("record", "--bus", url, *TEST, "--out", out)
        assert outcome.code == 0, outcome.err
        kept = tomllib.loads(meta.read_text())
        assert kept["held"] == "at rest" and kept["source"] == {"operator": "M. Keller"}
        assert load_dataset(out)["run"].max() == 2
        data = out / "data.csv"
        lines = data.read_text().splitlines()
        data.write_text("\n".join([lines[0] + ",base_x_mm", *(line + ",0.01" for line in lines[1:])]) + "\n")
        before = data.read_bytes()
        refused = brace("record", "--bus", url, *TEST, "--out", out)
        assert refused.code == 2 and "--add would delete base_x_mm" in refused.err
        assert data.read_bytes() == before


@pytest.mark.parametrize(
    ("entry", "words"),
    [("when = 2024-05-01", "cannot keep when"), ("zeroed = 'never'", "zeroed = 'never'"),
     ("[rig]\nzeroed = 'never'", "'never'")],
)  # fmt: skip
def test_what_cannot_be_kept_is_refused_before_anything_moves(
    brace: Brace, tmp_path: Path, entry: str, words: str
) -> None:
    from command_bench import loading_rows, write_loading

    rows = loading_rows()
    record = write_loading(tmp_path / "record", rows, meta=f'format = 1\nkind = "loading"\n{entry}\n')
    refused = brace("record", "--bus", "tcp://127.0.0.1:9", *TEST, "--out", record)
    assert refused.code == 2 and words in refused.err, refused.err


def test_the_records_own_entries_win() -> None:
    before = {"title": "mine", "sensor": {"resolution_n": 0.01}, "rig": {"step_mm": 0.5, "note": "new foot"}, "x": 1}
    new = {"title": "theirs", "sensor": {"resolution_n": 0.0, "range_n": 9.0}, "rig": {"step_mm": 0.7}}
    assert meta_of_both(before, new) == {
        "title": "mine", "sensor": {"resolution_n": 0.01, "range_n": 9.0}, "rig": {"step_mm": 0.7, "note": "new foot"},
        "x": 1,
    }  # fmt: skip
