"""Logs: a reading's time is when its sample was taken, each reading keeps its value, and what is no clock is refused."""

from __future__ import annotations

import json
import math
import re
import struct
from collections.abc import Callable
from pathlib import Path

import can
import numpy as np
import pytest
from can.io.canutils import CanutilsLogWriter
from command_bench import Outcome

from brace.dataset import load_dataset
from brace.importing.logs.can_formats import are_distances
from brace.importing.stamps import stamp_s

pytest.importorskip("cantools")
Brace = Callable[..., Outcome]
START_S = 1_700_000_000.0
DBC = """VERSION ""
NS_ :
BS_:
BU_: RIG
BO_ 256 RIGDATA: 8 RIG
 SG_ Fz : 0|16@1- (0.01,0) [-300|300] "N" RIG
 SG_ PosZ : 16|16@1- (0.001,0) [-30|30] "mm" RIG
 SG_ Hip : 32|16@1- (0.01,0) [-180|180] "%s" RIG
 SG_ Knee : 48|16@1- (0.01,0) [-180|180] "%s" RIG
BO_ 2147483652 OTHER: 8 RIG
 SG_ Fx : 0|16@1- (0.01,0) [-300|300] "N" RIG
"""
SAID = ("--set", "axis=z", "--yes")


def frames(count: int = 400, of_each: int = 1) -> list[bytes]:
    """Two runs of a spring of 2 N/mm; each reading has a force of its own."""
    made = []
    for at in range(count):
        dz = 2.0 * math.sin(4 * math.pi * at / count)
        made.append(struct.pack("<hhhh", round(200 * dz) + at % 7, round(1000 * dz), 5730, 8021))
    return made


def written(folder: Path, times: list[float], form: str = "({:.6f})", unit: str = "deg") -> tuple[Path, Path]:
    log, dbc = folder / "rig.log", folder / "rig.dbc"
    dbc.write_text(DBC.replace("%s", unit), encoding="utf-8")
    lines = (f"{form.format(t)} can0 100#{data.hex().upper()}" for t, data in zip(times, frames(len(times))))
    log.write_text("\n".join(lines) + "\n")
    return log, dbc


def forces() -> np.ndarray:
    return np.array([struct.unpack("<hhhh", data)[0] * 0.01 for data in frames()])


@pytest.mark.parametrize("step_s", [0.010, 0.015625, 1.0])
def test_readings_that_share_a_stamp_keep_their_values(brace: Brace, tmp_path: Path, step_s: float) -> None:
    """All readings of one stamp were replaced by the first of them."""
    log, dbc = written(tmp_path, [START_S + math.floor(at * 0.01 / step_s + 1e-6) * step_s for at in range(400)])
    done = brace("import", log, "--dbc", dbc, *SAID, "--out", tmp_path / "out")
    assert done.code == 0, done.err
    assert load_dataset(tmp_path / "out")["fz_n"] == pytest.approx(forces(), abs=1e-6)
    assert ("readings share a stamp" in done.err) == (step_s > 0.01), done.err


def test_sources_that_share_stamps_are_joined_in_their_order(brace: Brace, tmp_path: Path) -> None:
    """Force and displacement in messages of their own, ten of each a stamp."""
    split = (
        DBC.replace("%s", "deg")
        .replace(' SG_ Fz : 0|16@1- (0.01,0) [-300|300] "N" RIG\n', "")
        .replace("BO_ 2147483652 OTHER", "BO_ 257 CELL")
        .replace("Fx", "Fz")
    )
    (tmp_path / "rig.dbc").write_text(split)
    lines = []
    for at, data in enumerate(frames()):
        t = START_S + at // 10 * 0.01
        lines += [f"({t:.6f}) can0 101#{data[:2].hex()}000000000000", f"({t:.6f}) can0 100#{data.hex()}"]
    (tmp_path / "rig.log").write_text("\n".join(lines) + "\n")
    done = brace(
        "import", tmp_path / "rig.log", "--dbc", tmp_path / "rig.dbc", *SAID, "--out", tmp_path / "out"
    )
    assert done.code == 0, done.err
    assert load_dataset(tmp_path / "out")["fz_n"] == pytest.approx(forces(), abs=1e-6)


def test_times_that_are_distances_are_refused(brace: Brace, tmp_path: Path) -> None:
    """candump -td: constant, slow and of bursts."""
    random = np.random.default_rng(3)
    slow = [0.0, *(4.0 + 0.3 * random.standard_normal(399)).tolist()]
    for times in ([0.0] + [0.05] * 399, slow, [0.0] + ([0.0001] * 9 + [0.05]) * 40, [0.0, *random.exponential(9, 300)]):
        log, dbc = written(tmp_path, times, "({:010.6f})")
        refused = brace("import", log, "--dbc", dbc, *SAID, "--out", tmp_path / "out")
        assert refused.code == 3 and "distances from frame to frame" in refused.err, refused.err
        assert not (tmp_path / "out").exists()


def test_clocks_are_not_taken_for_distances() -> None:
    rising = np.cumsum(np.random.default_rng(3).exponential(0.01, 500))
    stray = rising.copy()
    stray[100] = 0.0
    for times in (rising, np.floor(rising * 4) / 4, np.tile(np.arange(9.0), 12), stray, np.sort(rising[:6]), rising[:3]):
        assert not are_distances(times)


@pytest.mark.parametrize("form", ["date", "raw length", "degree sign"])
def test_other_ways_to_write_a_log(brace: Brace, tmp_path: Path, form: str) -> None:
    times = [START_S + 0.05 * at for at in range(400)]
    log, dbc = written(tmp_path, times, unit="\u00b0" if form == "degree sign" else "deg")
    if form == "date":
        text = re.sub(
            r"\((\d+)(\.\d+)\)",
            lambda found: f"(2023-11-14 22:{13 + (int(found[1]) - 1699999980) // 60:02d}:"
            f"{(int(found[1]) - 1699999980) % 60:02d}{found[2]})",
            log.read_text(),
        )
        log.write_text(text)
    if form == "raw length":
        log.write_text(re.sub(r"(?m)$(?<=\w)", "_B", log.read_text()))
    done = brace("import", log, "--dbc", dbc, *SAID, "--out", tmp_path / "out")
    assert done.code == 0, done.err
    data = load_dataset(tmp_path / "out")
    assert data["fz_n"] == pytest.approx(forces(), abs=1e-6) and data["theta1_rad"][0] == pytest.approx(1.0, abs=1e-3)
    assert data["t_s"][-1] - data["t_s"][0] == pytest.approx(19.95, abs=1e-5)


@pytest.mark.parametrize("identifier", ["20000004", "20000088", "3FFFFFFF", "A0000004"])
def test_error_frames_are_counted_and_never_decoded(brace: Brace, tmp_path: Path, identifier: str) -> None:
    """0x20000004 is an error of the controller; without its bit 29 it is frame 4 of 29 bits, which the DBC has."""
    log, dbc = written(tmp_path, [START_S + 0.05 * at for at in range(400)])
    lines = log.read_text().splitlines()
    lines[5:5] = [f"({START_S + 0.21:.6f}) can0 {identifier}#0004000000000000"] * 3
    log.write_text("\n".join(lines) + "\n")
    done = brace("import", log, "--dbc", dbc, *SAID, "--out", tmp_path / "out")
    assert done.code == 0 and "3 error frames" in done.err, done.err
    assert "OTHER" not in done.err.replace("never came: OTHER", "")
    assert load_dataset(tmp_path / "out")["fz_n"] == pytest.approx(forces(), abs=1e-6)


@pytest.mark.parametrize("ending", [".asc", ".blf", ".trc"])
def test_logs_of_other_programs(brace: Brace, tmp_path: Path, ending: str) -> None:
    _, dbc = written(tmp_path, [START_S])
    path = tmp_path / f"rig{ending}"
    with can.Logger(path) as writer:
        for at, data in enumerate(frames()):
            writer(can.Message(timestamp=START_S + 0.05 * at, arbitration_id=0x100, is_extended_id=False, data=data,
                               channel=1))  # fmt: skip
    done = brace("import", path, "--dbc", dbc, *SAID, "--out", tmp_path / "out")
    assert done.code == 0 and f"{ending} log, decoded by rig.dbc" in done.err, done.err
    read = load_dataset(tmp_path / "out")
    assert read["fz_n"] == pytest.approx(forces(), abs=1e-6) and np.diff(read["t_s"]) == pytest.approx(0.05, abs=1e-3)
    if ending == ".asc":
        path.write_text(path.read_text().replace("timestamps absolute", "timestamps relative"))
        refused = brace("import", path, "--dbc", dbc, *SAID, "--out", tmp_path / "other")
        assert refused.code == 3 and "timestamps relative" in refused.err, refused.err
    if ending == ".blf":
        path.write_bytes(path.read_bytes()[:100] + b"\0" * 400)
        broken = brace("import", path, "--dbc", dbc, *SAID, "--out", tmp_path / "other")
        assert broken.code == 3 and "can.logconvert" in broken.err, broken.err


def test_other_formats_are_named(brace: Brace, tmp_path: Path) -> None:
    for head, words in ((b"#ROSBAG V2.0\n", "ROS 1 bag"), (b"MDF     4.10", "ASAM"), (b"PAR1\0", "Parquet")):
        path = tmp_path / "x"
        path.write_bytes(head + bytes(200))
        refused = brace("import", path, "--yes", "--out", tmp_path / "out")
        assert refused.code == 3 and words in refused.err and "try:" in refused.err, refused.err


def test_what_the_writer_of_these_tests_writes_is_read(tmp_path: Path) -> None:
    """python-can's own writer gives error frames the form that is looked for above."""
    with (tmp_path / "a.log").open("w") as file:
        CanutilsLogWriter(file)(can.Message(timestamp=1.0, is_error_frame=True, channel="can0"))
    assert re.search(r"can0 200000[0-9A-F]{2}#", (tmp_path / "a.log").read_text())


@pytest.mark.parametrize("names", [("sec", "nanosec"), ("secs", "nsecs"), ("seconds", "nanos")])
def test_a_stamp_has_seconds_and_nanoseconds_by_any_of_their_names(names: tuple[str, str]) -> None:
    stamp = dict(zip(names, (1_700_000_000, 250_000_000)))
    assert stamp_s({"header": {"stamp": stamp}}) == stamp_s({"stamp": stamp}) == 1_700_000_000.25


def mcap(path: Path, force_late_s: float, stamp: Callable[[str, float], object]) -> Path:
    """A tracker and a force of a spring, 100 Hz; the force comes late into the log."""
    from mcap.writer import Writer

    messages = []
    for at in range(800):
        t = START_S + at * 0.01
        dz = 2.0 * math.sin(math.pi * at / 200)
        messages.append((t, "/tip", {"z_mm": dz}, t))
        messages.append((t + force_late_s, "/ft", {"Fz_N": 2.0 * dz}, t))
        messages.append((t, "/legs", {"femur_rad": 1.0, "knee_rad": 1.4}, t))
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        schema = writer.register_schema("any", "jsonschema", b"{}")
        channels = {name: writer.register_channel(name, "json", schema) for name in ("/tip", "/ft", "/legs")}
        for logged, topic, content, t in sorted(messages, key=lambda each: each[0]):
            found = stamp(topic, t)
            entry = {**content, **({"header": {"stamp": found}} if found is not None else {})}
            writer.add_message(channels[topic], round(logged * 1e9), json.dumps(entry).encode(), round(logged * 1e9))
        writer.finish()  # type: ignore[no-untyped-call]
    return path


def at(t: float) -> dict[str, int]:
    return {"sec": int(t), "nanosec": round((t - int(t)) * 1e9)}


@pytest.mark.parametrize(
    ("stamp", "words", "used"),
    [
        (lambda topic, t: at(t), "/ft: its stamps are used; the log has its 800 messages 250 ms to 250 ms later", True),
        (lambda topic, t: None, "", False),
        (lambda topic, t: at(0.0), "", False),
        (lambda topic, t: at(START_S), "/ft: the stamps of its messages do not advance (1 different", False),
        (lambda topic, t: {"sec": int(t), "nanosec": 0}, "do not advance", False),
        (lambda topic, t: at(t - START_S + 60.0 if topic == "/ft" else t), "are of several clocks", False),
        (lambda topic, t: at(t + 0.62 if topic == "/ft" else t), "the clock of those stamps is ahead", False),
        (lambda topic, t: at(t + 0.002), "/tip: its stamps are used", True),
    ],
)  # fmt: skip
def test_a_samples_time_is_the_stamp_of_its_header(
    brace: Brace, tmp_path: Path, stamp: Callable[[str, float], object], words: str, used: bool
) -> None:
    """Taken at the times of the log, a spring without friction has a loop of 1.5 N."""
    pytest.importorskip("mcap")
    log = mcap(tmp_path / "a.mcap", 0.25, stamp)
    done = brace("import", log, *SAID, "--out", tmp_path / "out")
    assert done.code == 0 and words in done.err, done.err
    data = load_dataset(tmp_path / "out")
    loop = float(np.abs(data["fz_n"] - 2.0 * data["dz_mm"]).max())
    assert (loop < 1e-3) if used else (loop > 1.0), loop


def without_half(topic: str, t: float) -> object:
    return at(t) if topic != "/ft" or round((t - START_S) * 100) % 2 else at(0.0)


def without_all(topic: str, t: float) -> object:
    return at(t) if topic == "/ft" else None


@pytest.mark.parametrize(
    ("stamp", "words"),
    [
        (without_half, "/ft: 400 of 800 messages have no stamp: left out"),
        (without_all, "without usable stamps, at the times of the log: /legs, /tip"),
    ],
)
def test_topics_by_two_clocks_are_asked(
    brace: Brace, tmp_path: Path, stamp: Callable[[str, float], object], words: str
) -> None:
    """The one topic was taken at its stamps, the other at the times of the log: a loop of 1.5 N that no limb has."""
    pytest.importorskip("mcap")
    log, out, mapping = mcap(tmp_path / "a.mcap", 0.25, stamp), tmp_path / "out", tmp_path / "m.toml"
    asked = brace("import", log, *SAID, "--out", out)
    assert asked.code == 2 and not out.exists() and "clock: when were the samples taken? " in asked.err, asked.err
    assert "1 open question:" in asked.err and "--set clock=stamp" in asked.err and "250 ms later" in asked.err, asked.err
    for clock, right in (("stamp", True), ("log", False)):
        done = brace("import", log, *SAID, "--set", f"clock={clock}", "--out", out)
        assert done.code == 0 and f"as was said (clock = {clock})" in done.err and (words in done.err) == right, done.err
        data = load_dataset(out)
        loop = float(np.abs(data["fz_n"] - 2.0 * data["dz_mm"]).max())
        assert (loop < 1e-3) if right else (loop > 1.0), loop
    brace("import", log, *SAID, "--draft", mapping)
    draft = mapping.read_text()
    for value, code in (("?", 2), ("moon", 3), ("stamp", 0)):
        mapping.write_text(re.sub(r'(is = "clock"\nvalue = )"\?"', rf'\1"{value}"', draft))
        assert brace("import", log, "--mapping", mapping, "--out", out).code == code
    mapping.write_text(draft[: draft.index('[[constant]]\nis = "clock"')] + '[[constant]]\nis = "axis"\nvalue = "z"\n')
    assert 'is = "axis"' in draft
    refused = brace("import", log, "--mapping", mapping, "--out", out)
    assert refused.code == 2 and "the log has messages by two clocks" in refused.err, refused.err


@pytest.mark.parametrize(
    ("late_s", "stamp"),
    [
        (0.25, lambda topic, t: None if topic == "/legs" else at(t)),  # a posture stands for long
        (0.005, without_half), (0.005, without_all),  # as near as synchronised clocks are
    ],
)  # fmt: skip
def test_clocks_that_change_nothing_are_not_asked(
    brace: Brace, tmp_path: Path, late_s: float, stamp: Callable[[str, float], object]
) -> None:
    pytest.importorskip("mcap")
    done = brace("import", mcap(tmp_path / "a.mcap", late_s, stamp), *SAID, "--out", tmp_path / "out")
    assert done.code == 0 and "clock:" not in done.err, done.err
    data = load_dataset(tmp_path / "out")
    assert float(np.abs(data["fz_n"] - 2.0 * data["dz_mm"]).max()) < 4.0 * math.pi / 2.0 * 0.0051  # its rate times 5 ms


def test_a_clock_that_changes_nothing_is_refused(brace: Brace, tmp_path: Path) -> None:
    log, dbc = written(tmp_path, [START_S + 0.05 * at for at in range(400)])
    refused = brace("import", log, "--dbc", dbc, *SAID, "--set", "clock=log", "--out", tmp_path / "out")
    assert refused.code == 2 and "--set clock would change nothing" in refused.err, refused.err


def test_a_log_of_one_time_is_refused(brace: Brace, tmp_path: Path) -> None:
    log, dbc = written(tmp_path, [START_S] * 400)
    refused = brace("import", log, "--dbc", dbc, *SAID, "--out", tmp_path / "out")
    assert refused.code == 3 and "all 400 readings of RIGDATA have one time" in refused.err, refused.err
