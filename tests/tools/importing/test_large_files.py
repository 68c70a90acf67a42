"""`brace import`: a file that is no record by its size ends in a sentence, at once and without the machine's memory."""

from __future__ import annotations

import io
import os
import struct
import subprocess
import sys
import time
import zipfile
from collections.abc import Callable, Iterable
from pathlib import Path

import pytest
from command_bench import Outcome
from foreign_files import workbook

from brace.dataset import load_dataset

Brace = Callable[..., Outcome]
MEMORY_MOST_KB = 500_000
PROCESSOR_MOST_S = 5.0
SHEET = b'<worksheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><sheetData>'
END = b"</sheetData></worksheet>"


def refused(path: Path, words: str, *options: str, code: int = 3) -> None:
    """In a process of its own: what it prints, its processor time, its memory."""
    peak = path.parent / "peak"  # of this process alone: getrusage counts what its parent held, too
    program = (
        "import atexit, pathlib, sys; from brace.cli import main\n"
        "status = pathlib.Path('/proc/self/status')\n"
        f"atexit.register(lambda: pathlib.Path({str(peak)!r}).write_text(status.read_text()))\n"
        "sys.exit(main())"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", program, "import", str(path), *options, "--yes", "--out", str(path.parent / "out")],
        stderr=subprocess.PIPE,
    )
    assert process.stderr is not None
    said = process.stderr.read().decode()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == code and words in said and "try:" in said and len(said.splitlines()) == 3, said
    peak_kb = int(peak.read_text().partition("VmHWM:")[2].split()[0])
    assert peak_kb < MEMORY_MOST_KB and usage.ru_utime + usage.ru_stime < PROCESSOR_MOST_S, (peak_kb, usage)


def sheet(path: Path, parts: Iterable[bytes]) -> Path:
    source = zipfile.ZipFile(io.BytesIO(workbook([["a", "b"], [1.0, 2.0], [2.0, 3.0]])))
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as out:
        for name in source.namelist():
            if not name.endswith("sheet1.xml"):
                out.writestr(name, source.read(name))
                continue
            with out.open(name, "w") as file:
                for part in (SHEET, *parts, END):
                    file.write(part)
    return path


def cell(at: str) -> bytes:
    return f'<c r="{at}"><v>1</v></c>'.encode()


@pytest.mark.minutes
def test_workbooks_of_millions_of_rows_and_columns(tmp_path: Path) -> None:
    pytest.importorskip("openpyxl")
    refused(sheet(tmp_path / "rows.xlsx", [b"<row/>" * 10_000] * 3_000), "rows in this file")
    wide = [b'<row r="%d">%b</row>' % (row, cell(f"ZZZ{row}")) for row in range(1, 3000)]
    refused(sheet(tmp_path / "wide.xlsx", wide), "columns in this file")
    full = [b'<row r="%d">%b</row>' % (row, cell(f"XFD{row}")) for row in range(1, 3000)]
    refused(sheet(tmp_path / "full.xlsx", full), "cells in this file")
    text = [b'<row><c t="inlineStr"><is><t>', *[b"x" * (1 << 20)] * 600, b"</t></is></c></row>"]
    refused(sheet(tmp_path / "text.xlsx", text), "this workbook unpacks to")


def test_a_workbook_and_a_table_of_a_million_rows(tmp_path: Path) -> None:
    """Those that are written soonest. The tests of minutes beside this one have files of 100 MB."""
    pytest.importorskip("openpyxl")
    gap = [b'<row r="1">', cell("A1"), cell("B1"), b'</row><row r="30000000">', cell("A30000000"), b"</row>"]
    refused(sheet(tmp_path / "gap.xlsx", gap), "rows in this file")
    (tmp_path / "rows.csv").write_bytes(b"t;f\r" + b"0;1\r" * 3_000_000)
    refused(tmp_path / "rows.csv", "3000001 rows in this file")


@pytest.mark.minutes
def test_tables_of_millions_of_rows_and_columns(tmp_path: Path) -> None:
    (tmp_path / "rows.csv").write_bytes(b"t,f\n" + b"0,1\n" * 30_000_000)
    refused(tmp_path / "rows.csv", "30000001 rows in this file")
    (tmp_path / "rows.csv").unlink()
    for separator in (",", "\t", ";"):
        line = separator.join(["1.5"] * 1_000_000)
        (tmp_path / "columns.csv").write_text("a remark\n" + "\n".join([line] * 3) + "\n")
        refused(tmp_path / "columns.csv", "1000000 columns in this file")


def record(kind: int, data: bytes, length: int | None = None) -> bytes:
    return bytes([kind]) + struct.pack("<Q", len(data) if length is None else length) + data


def chunk(data: bytes, unpacked: int, compression: bytes, length: int | None = None) -> bytes:
    head = struct.pack("<QQQII", 0, 0, unpacked, 0, len(compression)) + compression
    return record(6, head + struct.pack("<Q", len(data) if length is None else length) + data)


@pytest.mark.parametrize("case", ["record", "chunk zstd", "chunk lz4", "records", "inner", "bomb", "bomb that lies"])
def test_lengths_of_an_mcap_that_no_log_has(tmp_path: Path, case: str) -> None:
    """2^62 bytes ended in advice about postures, exit 1."""
    pytest.importorskip("mcap")
    lz4, zstandard = pytest.importorskip("lz4.frame"), pytest.importorskip("zstandard")
    huge, small = 1 << 62, bytes(1000)
    of = {
        "record": lambda: record(6, b"abc", huge),
        "chunk zstd": lambda: chunk(zstandard.compress(small), huge, b"zstd"),
        "chunk lz4": lambda: chunk(lz4.compress(small), huge, b"lz4"),
        "records": lambda: chunk(b"abc", 10, b"", huge),
        "inner": lambda: chunk(record(5, b"abc", huge), 20, b""),
        "bomb": lambda: chunk(zstandard.compress(bytes(1 << 29)), 1 << 29, b"zstd"),
        "bomb that lies": lambda: chunk(zstandard.compress(bytes(1 << 29)), 1000, b"zstd"),
    }
    path = tmp_path / "a.mcap"
    path.write_bytes(b"\x89MCAP0\r\n" + record(1, struct.pack("<II", 0, 0)) + of[case]())
    is_length = case in ("record", "chunk zstd", "chunk lz4", "bomb")
    refused(path, "a length that no log has" if is_length else "a broken MCAP log: 0 messages")


def test_columns_take_time_in_proportion(brace: Brace, tmp_path: Path) -> None:
    """16,000 took 41 s: each was looked for among all. Eight times as many take some eight times as long."""
    took = []
    for count in (2_000, 16_000):
        path = tmp_path / f"{count}.csv"
        path.write_text(",".join(f"c{n}" for n in range(count)) + "\n" + (",".join(["1.5"] * count) + "\n") * 3)
        before = time.process_time()
        asked = brace("import", path, "--yes", "--out", tmp_path / "out")
        took.append(time.process_time() - before)
        assert asked.code == 2, asked.err[-500:]
    assert took[1] < 20.0 * took[0], took


MESSAGES = 1000


@pytest.fixture(scope="module")
def vehicle(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A log of 8,000 signals, all of them forces by their unit, and the rig's own message among them."""
    pytest.importorskip("cantools")
    folder = tmp_path_factory.mktemp("vehicle")
    log, dbc = folder / "v.log", folder / "v.dbc"
    lines = ['VERSION ""', "NS_ :", "BS_:", "BU_: RIG"]
    for number in range(1, MESSAGES + 1):
        lines.append(f"BO_ {number} M{number}: 8 RIG")
        lines += [f' SG_ S{at} : {8 * at}|8@1- (1,0) [0|0] "N" RIG' for at in range(8)]
    lines.append("BO_ 1500 RIGDATA: 8 RIG")
    for at, (name, unit) in enumerate((("Fz", "N"), ("PosZ", "mm"), ("Hip", "deg"), ("Knee", "deg"))):
        lines.append(f' SG_ {name} : {16 * at}|16@1- (0.01,0) [0|0] "{unit}" RIG')
    dbc.write_text("\n".join(lines) + "\n")
    frames = []
    for at in range(30 * MESSAGES):
        frames.append(f"({0.001 * at:.6f}) can0 {at % MESSAGES + 1:03X}#0102030405060708")
        if at % 100 == 0:
            z = [0, 50, 100, 150, 100, 50][at // 100 % 6]
            data = b"".join(value.to_bytes(2, "little") for value in (2 * z, z, 5730, 8021))
            frames.append(f"({0.001 * at + 0.0005:.6f}) can0 5DC#{data.hex()}")
    log.write_text("\n".join(frames) + "\n")
    return log, dbc


def test_a_log_of_thousands_of_signals_asks_which(vehicle: tuple[Path, Path]) -> None:
    """Each of them was a question."""
    log, dbc = vehicle
    refused(log, "more than 500 signals of this log are taken", "--dbc", str(dbc), code=2)


def test_of_thousands_of_signals_those_that_are_named_are_taken(
    brace: Brace, vehicle: tuple[Path, Path], tmp_path: Path
) -> None:
    log, dbc = vehicle
    given = (log, "--dbc", dbc, "--set", "axis=z", "--yes", "--out", tmp_path / "out")
    begun = time.process_time()
    done = brace("import", *given, "--signals", "RIGDATA")
    assert done.code == 0 and time.process_time() - begun < PROCESSOR_MOST_S, done.err
    assert "8000 signals are left out by --signals" in done.err, done.err
    data = load_dataset(tmp_path / "out")
    assert len(data["fz_n"]) == 300 and data["fz_n"] == pytest.approx(2.0 * data["dz_mm"], abs=1e-6)
    strange = brace("import", *given, "--signals", "RIGDATA.*", "--signals", "Fx")
    assert strange.code == 2 and "no signal of this log is called Fx" in strange.err, strange.err


def test_signals_of_a_table_are_not_chosen(brace: Brace, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("t [s],dx [mm],Fx [N]\n0,0,0\n1,1,2\n2,2,4\n3,1,2\n")
    asked = brace("import", tmp_path / "a.csv", "--signals", "Fx", "--yes", "--out", tmp_path / "out")
    assert asked.code == 2 and "--signals, and no file is a log" in asked.err, asked.err
