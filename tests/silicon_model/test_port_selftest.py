"""The port self-test (hal/selftest) on the layer over all register models at once: what the door promises,
end to end."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest

from chip import SOFT_FLOAT, Image
from silicon import Maker, Silicon
from usart_model import Usart

PASS, FAIL = 0, 2


@pytest.fixture(scope="module")
def image(tmp_path_factory: pytest.TempPathFactory) -> Image:
    """Stands in for the other tests' image in this file."""
    folder: Path = tmp_path_factory.mktemp("selftest")
    return Image(folder, "selftest.c", SOFT_FLOAT, beside="selftest")


def findings(chip: Silicon) -> list[tuple[int, str, str, int]]:
    """Verdict, entry, what, value."""
    table = []
    for index in range(chip.chip.words("finding_count", 1)[0]):
        raw = chip.chip.get("findings", 132 * (index + 1))[132 * index :]
        verdict, entry, what, value = struct.unpack("<I24s100si", raw)
        table.append((verdict, entry.rstrip(b"\0").decode(), what.rstrip(b"\0").decode(), value))
    return table


def run(chip: Silicon) -> list[tuple[int, str, str, int]]:
    chip.chip.slice = (500, 1500)
    chip.timer.read_takes_us = 5.0
    Usart(chip.chip, 0x40011000, 37, "usart1_handler", 84e6, None)
    failed = chip.run_selftest()
    table = findings(chip)
    assert failed == sum(row[0] == FAIL for row in table)
    return table


def test_a_sound_chip_passes(silicon: Maker) -> None:
    chip = silicon()
    table = run(chip)
    assert [entry for entry in table if entry[0] == FAIL] == []
    passed = {f"{entry}: {what}" for verdict, entry, what, _ in table if verdict == PASS}
    for wanted in ("now_us: ", "nvm_erase: ", "nvm_write: ", "can: loopback", "joint_read(1): ", "serial_"):
        assert any(line.startswith(wanted) for line in passed), (wanted, sorted(passed))
    assert chip.watchdog.bites_at_us == []
    assert chip.bus.seen == []  # loopback stays inside


def test_a_chip_without_its_parts_is_reported(silicon: Maker) -> None:
    chip = silicon()
    chip.can.obeys = False
    chip.flash.protected = {11}
    faults = {entry for verdict, entry, *_ in run(chip) if verdict == FAIL}
    assert any(entry.startswith("can_setup") for entry in faults), faults
    assert any(entry.startswith("nvm_") for entry in faults), faults
