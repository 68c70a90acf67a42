"""`brace record` and `brace replay`: what was on the bus, bit for bit, in the ecosystem's own formats."""

from __future__ import annotations

import json
import os
import re
import signal
import struct
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bus_bench import limb_on_tcp, told_in_time, wait_for_mode
from command_bench import LIMB, PROJECT, Outcome, spawn

from brace.bus.frame import Frame
from brace.bus.loading_test import Plan
from brace.bus.log import read
from brace.bus.recording import Recording
from brace.bus.session import Session
from brace.bus.slcan import SlcanBus
from brace.bus.lines import TcpLine
from brace.bus.url import parse

WRAP = 256  # of a snapshot's sequence number on the bus
MATRIX = ("k_xx_n_per_mm", "k_xz_n_per_mm", "k_zz_n_per_mm")


@pytest.fixture
def limb(tmp_path: Path) -> Path:
    path = tmp_path / "limb.toml"
    path.write_text(LIMB)
    return path


def events(text: str, kind: str) -> list[dict[str, Any]]:
    return [entry for line in text.splitlines() if (entry := json.loads(line))["event"] == kind]


def key(entry: dict[str, Any]) -> tuple[Any, ...]:
    """A K with all its bits."""
    bits = tuple(struct.pack("<d", entry[name]) for name in MATRIX)
    return (entry["node"], entry["sequence"], *bits, tuple(entry["flag_names"]))


@pytest.fixture
def moving(limb: Path) -> Iterator[str]:
    """Two limbs that move, so that no two K are the same."""
    postures = [f"{0.9 + 0.3 * (index % 2)},{1.5 - 0.4 * (index % 2)}@{0.6 * index}" for index in range(10)]
    given = [word for posture in postures for word in ("--posture", posture)]
    with limb_on_tcp(limb, "--limbs", 2, "--contact", "free", *given) as url:
        yield url


def test_replay_of_a_log_gives_the_same_k_bit_for_bit(
    brace: Callable[..., Outcome], moving: str, tmp_path: Path
) -> None:
    live = spawn("monitor", "--bus", moving, "--json", "--seconds", 4.0)
    with ThreadPoolExecutor(1) as reading:  # a full pipe would stop it in the middle of a set, which it then drops
        told = reading.submit(live.communicate, timeout=60)
        time.sleep(1.2)  # it listens before the recording begins, and after it ends
        outcome = brace("record", "--bus", moving, "--out", tmp_path / "a.log", "--seconds", 1.0, "--json")
        assert outcome.code == 0, outcome.err
        seen, said = told.result()
    assert live.returncode == 0, said
    heard = [key(entry) for entry in events(seen, "stiffness")]
    replayed = brace("replay", tmp_path / "a.log", "--json")
    assert replayed.code == 0, replayed.err
    again = [key(entry) for entry in events(replayed.out, "stiffness")]
    assert len(again) == sum(json.loads(outcome.out)["snapshots"].values())
    assert len(again) > 100  # of 400: a busy machine simulates slower than the clock
    assert len({entry[2] for entry in again}) > 50  # K changed
    for node in (1, 2):
        _agree([e for e in heard if e[0] == node], [e for e in again if e[0] == node])

    assert brace("record", "--bus", f"log:{tmp_path / 'a.log'}", "--out", tmp_path / "a.mcap").code == 0
    assert brace("replay", tmp_path / "a.mcap", "--json").out == replayed.out
    assert brace("monitor", "--bus", f"log:{tmp_path / 'a.mcap'}", "--json").out == replayed.out
    _as_other_tools_read_it(tmp_path, again)


def _agree(live: list[tuple[Any, ...]], logged: list[tuple[Any, ...]]) -> None:
    """Of each tick that both listeners have, the same bits. On a busy machine either may miss ticks, and the one may
    begin late: most are in both all the same."""
    first, other = _by_tick(live), _by_tick(logged)
    shifts = range(-8 * WRAP, 9 * WRAP, WRAP)
    shift = max(shifts, key=lambda by: sum(first.get(tick + by) == entry for tick, entry in other.items()))
    common = [tick for tick in other if tick + shift in first]
    assert len(common) > 0.5 * len(other)
    assert [other[tick] for tick in common] == [first[tick + shift] for tick in common]


def _by_tick(entries: list[tuple[Any, ...]]) -> dict[int, tuple[Any, ...]]:
    """By sequence number, its wraps undone."""
    ticks: dict[int, tuple[Any, ...]] = {}
    tick = entries[0][1]
    for entry in entries:
        tick += (entry[1] - tick) % WRAP
        ticks[tick] = entry
    assert len(ticks) == len(entries)  # no K twice
    return ticks


def _as_other_tools_read_it(folder: Path, ours: list[tuple[Any, ...]]) -> None:
    """python-can reads the candump log, cantools and our DBC decode it, the mcap package reads the other."""
    can, cantools = pytest.importorskip("can"), pytest.importorskip("cantools")
    database = cantools.database.load_file(PROJECT / "firmware" / "interface" / "brace.dbc")
    halves: dict[int, dict[str, Any]] = {}
    theirs = []
    for message in can.CanutilsLogReader(str(folder / "a.log")):
        node, function = message.arbitration_id & 0x7F, message.arbitration_id & 0x780
        if function == 0x180:
            halves[node] = database.decode_message(0x181, message.data, decode_choices=False)
        elif function == 0x280 and node in halves:
            b, a = database.decode_message(0x281, message.data, decode_choices=False), halves.pop(node)
            values = {
                name.split("_", 2)[-1] if name.startswith("stiffness_") else name: v for name, v in {**a, **b}.items()
            }
            theirs.append((node, *(values[name] for name in ("k_xx", "k_xz", "k_zz"))))
    assert [entry[0] for entry in theirs] == [entry[0] for entry in ours]
    # cantools multiplies by what a step is, rounded; brace divides by the steps of a unit: the last place may differ.
    k_ours = [struct.unpack("<3d", b"".join(entry[2:5])) for entry in ours]
    np.testing.assert_allclose([entry[1:] for entry in theirs], k_ours, rtol=2.0 * np.finfo(float).eps, atol=0.0)

    from mcap.reader import make_reader

    with (folder / "a.mcap").open("rb") as file:
        frames = [json.loads(message.data) for _, _, message in make_reader(file).iter_messages(topics=["/can"])]
    assert [(f["id"], f["data"]) for f in frames] == [(f.identifier, f.data.hex()) for f in read(folder / "a.log")]


@pytest.mark.parametrize("ending", [".log", ".mcap"])
def test_sigterm_ends_a_recording_well_and_ctrl_c_with_130(limb: Path, tmp_path: Path, ending: str) -> None:
    with limb_on_tcp(limb) as url:
        for sent, code in ((signal.SIGTERM, 0), (signal.SIGINT, 130)):
            path = tmp_path / f"{code}{ending}"
            process = spawn("record", "--bus", url, "--out", path)
            part = path.with_name(path.name + ".part")
            _wait_for(lambda: part.exists() and part.stat().st_size > 20_000)
            process.send_signal(sent)
            _, said = process.communicate(timeout=60)
            assert process.returncode == code, said
            assert len(list(read(path))) > 50
            assert os.listdir(tmp_path).count(path.name + ".part") == 0


@pytest.mark.parametrize("lost", [1, 10, 40, 80, 90, 100])
def test_an_mcap_that_was_cut_off_anywhere_ends_there(tmp_path: Path, lost: int) -> None:
    recording = Recording(tmp_path / "a.mcap", "can0")
    for number in range(20):
        recording.add(Frame(1.7e9 + number, 0x181, bytes(8)))
    recording.leave()
    whole = recording.part.read_bytes()
    end = whole.index(b"}", whole.rindex(b'{"bus": "can0"')) + 1
    recording.part.write_bytes(whole[: end - lost])
    assert len(list(read(recording.part))) == 19


@pytest.mark.parametrize("moment", ["in a frame", "at the end"])
@pytest.mark.parametrize(("sent", "code"), [(signal.SIGTERM, 0), (signal.SIGINT, 130)])
def test_a_signal_cuts_nothing_whenever_it_comes(
    brace: Callable[..., Outcome], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, moment: str, sent: int, code: int
) -> None:
    """A signal in the middle of a record of MCAP, and one while the file is being closed, twice each."""
    from mcap.data_stream import RecordBuilder

    folder, name = (RecordBuilder, "write8") if moment == "in a frame" else (os, "fsync")
    real, calls = getattr(folder, name), [0]

    def interrupted(*given: Any) -> Any:
        calls[0] += 1
        if moment == "at the end" or calls[0] == 1001:
            signal.raise_signal(sent)
            signal.raise_signal(sent)
        return real(*given)

    (tmp_path / "a.log").write_text("".join(f"({1 + i * 1e-3:.6f}) can0 181#{i % 256:02X}00\n" for i in range(3000)))
    monkeypatch.setattr(folder, name, interrupted)
    outcome = brace("record", "--bus", f"log:{tmp_path / 'a.log'}", "--out", tmp_path / "a.mcap", "--json")
    assert calls[0] > 0 and outcome.code == code, outcome.err
    assert sorted(os.listdir(tmp_path)) == ["a.log", "a.mcap"]
    frames = len(list(read(tmp_path / "a.mcap")))
    assert frames == json.loads(outcome.out)["frames"] > 100
    assert (frames == 3000) == (moment == "at the end")


@pytest.mark.parametrize("ending", [".log", ".mcap"])
def test_what_was_recorded_outlives_a_kill(limb: Path, tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"a{ending}"
    with limb_on_tcp(limb) as url:
        process = spawn("record", "--bus", url, "--out", path)
        part = path.with_name(path.name + ".part")
        _wait_for(lambda: part.exists() and part.stat().st_size > 20_000)
        process.kill()
        process.wait()
    frames = list(read(part))
    assert len(frames) > 50 and {frame.node for frame in frames} == {1}
    assert not path.exists()


def test_a_bus_that_goes_away_keeps_what_came(limb: Path, tmp_path: Path) -> None:
    path = tmp_path / "a.log"
    with limb_on_tcp(limb) as url:
        process = spawn("record", "--bus", url, "--out", path)
        part = path.with_name(path.name + ".part")
        _wait_for(lambda: part.exists() and part.stat().st_size > 5_000)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 4 and "the connection is lost" in said and str(part) in said
    assert len(list(read(part))) > 50 and not path.exists()


def _wait_for(found: Callable[[], bool]) -> None:
    until = time.monotonic() + 60
    while not found():
        assert time.monotonic() < until
        time.sleep(0.02)


def test_nothing_to_record_leaves_nothing(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    from bus_bench import adapter, obliging

    with adapter(obliging) as url:
        told_in_time(4, "record", "--bus", url, "--out", tmp_path / "a.log")
    assert brace("record", "--bus", "tcp://127.0.0.1:9", "--out", tmp_path / "a.txt").code == 2
    assert brace("record", "--bus", "modbus-tcp://127.0.0.1:9/1", "--out", tmp_path / "a.log").code == 2
    assert os.listdir(tmp_path) == []


def test_replay_onto_a_bus(brace: Callable[..., Outcome], limb: Path, tmp_path: Path) -> None:
    """Frames of node 1, sent onto a bus where node 9 lives, arrive there in order and in time."""
    with limb_on_tcp(limb) as url:
        assert brace("record", "--bus", url, "--out", tmp_path / "a.log", "--seconds", 0.6).code == 0
    recorded = list(read(tmp_path / "a.log"))
    with limb_on_tcp(limb, "--node", 9) as url:
        place = parse(url)
        listener = SlcanBus(place, TcpLine(place), 1_000_000)
        started = time.monotonic()
        outcome = brace("replay", tmp_path / "a.log", "--bus", url, "--json")
        assert outcome.code == 0 and json.loads(outcome.out)["frames"] == len(recorded)
        assert 0.5 < time.monotonic() - started < 10.0  # as long as it took, not at once; the rest is the machine's
        heard: list[tuple[int, bytes]] = []
        while (frame := listener.receive(0.3)) is not None and len(heard) < 10_000:
            if frame.node == 1:
                heard.append((frame.identifier, frame.data))
            if len(heard) == len(recorded):
                break
        listener.close()
    assert heard == [(frame.identifier, frame.data) for frame in recorded]


def test_logs_that_are_none(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    path = tmp_path / "a.log"
    path.write_text("(1.0) can0 181#0102030405060708\n(1.1) can0 18FFEE00#00\n(1.2) can0 123#R\nnonsense\n")
    outcome = brace("replay", path)
    assert outcome.code == 3 and f"{path}:4" in outcome.err
    path.write_text("(1.0) can0 181#0102030405060708\n(1.1) can0 181#0102")  # cut off while it was written
    assert [frame.data.hex() for frame in read(path)][0] == "0102030405060708"
    assert brace("replay", tmp_path / "none.log").code == 3
    (tmp_path / "b.mcap").write_bytes(b"\x89MCAP0\r\nrubbish" + bytes(100))
    assert brace("replay", tmp_path / "b.mcap").code in (3, 4)
    (tmp_path / "empty.log").write_text("")
    assert brace("replay", tmp_path / "empty.log").code == 4


@pytest.mark.parametrize("text", ["", "(1.0) can0 123#00\n", "(1.0) can0 701#05010000DDCCBBAA\n"])
@pytest.mark.parametrize("asks", ["query", "clear drift", "params pull", "params rollback", "record --loading-test"])
def test_a_log_is_not_asked_whoever_is_in_it(
    brace: Callable[..., Outcome], tmp_path: Path, asks: str, text: str
) -> None:
    path, out = tmp_path / "a.log", tmp_path / "out"
    path.write_text(text)
    written = ("--out", out) if asks in ("params pull", "record --loading-test") else ()
    outcome = brace(*asks.split(), "--bus", f"log:{path}", *written)
    assert outcome.code == 2 and "a log answers no requests" in outcome.err and "brace replay" in outcome.err
    assert not out.exists()


def test_another_dictionary_in_a_log_is_6(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    path = tmp_path / "a.log"
    path.write_text("(1.0) can0 701#05010000DDCCBBAA\n")
    outcome = brace("replay", path)
    assert outcome.code == 6 and "aabbccdd" in outcome.err


@pytest.mark.parametrize("node", [1, 32, 127])
def test_a_session_over_a_log_asks_nobody(tmp_path: Path, node: int) -> None:
    from brace.bus.log import LogBus
    from brace.ground.errors import UsageError

    path = tmp_path / "a.log"
    path.write_text(f"(1.0) can0 {0x700 + node:X}#05010000DDCCBBAA\n")
    session = Session(LogBus(f"log:{path}", path))
    assert session.node == node
    with pytest.raises(UsageError):
        session.ask("identify")


@pytest.mark.minutes
def test_a_loading_test_becomes_a_dataset(brace: Callable[..., Outcome], limb: Path, tmp_path: Path) -> None:
    """The slope along x of what was fetched is K's first column, as the physics has it."""
    import numpy as np
    from command_bench import physics_k

    from brace.dataset import load_dataset

    with limb_on_tcp(limb) as url:
        given = ("--loading-test", "--axis", "x", "--steps", 3, "--step-mm", 0.5, "--dwell-s", 0.1)
        outcome = brace("record", "--bus", url, *given, "--out", tmp_path / "test", "--json")
        assert outcome.code == 0, outcome.err
        assert json.loads(outcome.out)["rows"] == 13
        said = re.search(r"1 run, 13 readings: about (\d+) s .* at most (\d+) s", outcome.err)
        assert said is not None, outcome.err
        live = json.loads(brace("query", "--bus", url, "--json").out)
        refused = brace("record", "--bus", url, "--loading-test", "--step-mm", 70, "--out", tmp_path / "no")
        assert refused.code == 2 and not (tmp_path / "no").exists()
        measured = (tmp_path / "test" / "data.csv").read_bytes()
        refused = brace("record", "--bus", url, *given, "--out", tmp_path / "test")  # measured, and not again
        assert refused.code == 2 and "--add" in refused.err
        assert (tmp_path / "test" / "data.csv").read_bytes() == measured
    dataset = load_dataset(tmp_path / "test")
    dataset.require_sound()
    assert dataset["step"].tolist() == list(range(13)) and set(dataset["run"].tolist()) == {1}
    lasted_s = dataset["t_s"][-1] - dataset["t_s"][0]
    assert 0.5 * float(said[1]) < lasted_s < 1.5 * float(said[1]) < float(said[2])
    k = physics_k(live["theta1_rad"], live["theta2_rad"])
    for column, expected in (("fx_n", k[0, 0]), ("fz_n", k[1, 0])):
        slope = np.polyfit(dataset["dx_mm"], dataset[column], 1)[0]
        assert abs(slope - expected) < 0.02 * k[0, 0]  # sensor noise 0.02 N over 1 mm; motor play in the readings
    outcome = brace("identify", tmp_path / "test", "--model", limb, "--out", tmp_path / "fitted.toml")
    assert outcome.code == 0, outcome.err


def test_how_long_a_loading_test_takes() -> None:
    """Three steps to each side are 13 readings, each after a dwell and up to a second for the servos."""
    plan = Plan("x", 3, 0.5, 0.1)
    assert plan.rows == 13
    assert 13 * 0.2 < plan.quick_s < 13 * 1.1
    assert 2.0 * plan.quick_s < plan.most_s < 60.0


def test_an_interrupted_loading_test_is_stopped(limb: Path, tmp_path: Path) -> None:
    with limb_on_tcp(limb) as url:
        process = spawn("record", "--bus", url, "--loading-test", "--axis", "x", "--out", tmp_path / "test")
        wait_for_mode(url, "loading_test")
        process.send_signal(signal.SIGTERM)
        _, said = process.communicate(timeout=60)
        assert process.returncode == 130, said
        process = spawn("query", "--bus", url, "--entry", "loading_outcome", "--json")
        out, _ = process.communicate(timeout=60)
        assert json.loads(out)["entries"]["loading_outcome"]["value"] == 3  # stopped on request
    assert not (tmp_path / "test").exists()
