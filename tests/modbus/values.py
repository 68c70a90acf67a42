"""Values of the register map by name, two registers each, high word first: from modbus.csv,
as a stranger would read it."""

from __future__ import annotations

import csv
import struct
import sys
import time
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(PROJECT / "tests" / "socketcan"))

from clients import Client  # noqa: E402

with (PROJECT / "firmware" / "interface" / "modbus.csv").open(newline="") as _file:
    MAP = {row["name"]: row for row in csv.DictReader(_file)}

CONFIGURE, MONITOR, GO = 0xC0DE0002, 0xC0DE0001, 0xC0DE0001
MODES = {"MONITOR": 1, "CONFIGURATION": 2}


def registers_of(value: float, kind: str) -> list[int]:
    """A value as two registers."""
    return list(struct.unpack(">HH", struct.pack(">f" if kind == "f32" else ">I", value)))


def value_of(registers: list[int], kind: str) -> float:
    """And back."""
    found: float = struct.unpack(">f" if kind == "f32" else ">I", struct.pack(">HH", *registers))[0]
    return found


def get(client: Client, name: str) -> float:
    """One value."""
    row = MAP[name]
    return value_of(client.read(row["table"], int(row["address"]), 2), row["type"])


def put(client: Client, name: str, value: float) -> None:
    """Writes one."""
    row = MAP[name]
    client.write(int(row["address"]), registers_of(value, row["type"]))


def block(client: Client, first: str, last: str) -> dict[str, float]:
    """Values from one to another in one request."""
    rows = [row for row in MAP.values() if row["table"] == MAP[first]["table"]]
    start, end = int(MAP[first]["address"]), int(MAP[last]["address"]) + 2
    found = client.read(rows[0]["table"], start, end - start)
    assert len(found) == end - start
    values = {}
    for row in rows:
        place = int(row["address"]) - start
        if 0 <= place < len(found):
            values[row["name"]] = value_of(found[place : place + 2], row["type"])
    return values


def enter(client: Client, mode: str) -> None:
    """Asks for a mode and waits for it."""
    put(client, "set_mode", CONFIGURE if mode == "CONFIGURATION" else MONITOR)
    end = time.monotonic() + 10.0
    while get(client, "mode") != MODES[mode]:
        assert time.monotonic() < end, f"not in {mode} within 10 s"


def store(client: Client, command: str) -> None:
    """Commit or rollback, until it has ended."""
    put(client, command, GO)
    end = time.monotonic() + 10.0
    while (state := get(client, command)) == 1:
        assert time.monotonic() < end, f"{command}: not done within 10 s"
        time.sleep(0.02)
    assert state == 0, f"{command}: {state}"
