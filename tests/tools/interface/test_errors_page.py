"""docs/errors.md names every exit code, status, refusal, fault and flag that there is, with its number,
and no other."""

from __future__ import annotations

import re

import pytest

from brace.bus import refusal
from brace.ground import errors
from command_bench import PROJECT

FIRMWARE = PROJECT / "firmware"
PAGE = (PROJECT / "docs" / "errors.md").read_text()
STATUS = (FIRMWARE / "core/include/brace/status.h").read_text()
REFUSALS = (FIRMWARE / "app/include/brace/refusals.h").read_text()
STORE = (FIRMWARE / "store/include/brace/store_types.h").read_text()
CODES = (FIRMWARE / "interface/generated/brace/codes.h").read_text()


def rows(heading: str) -> list[list[str]]:
    """Cells of the table below a heading that begins so, its own heading left out."""
    section = re.split(r"^##? ", PAGE, flags=re.M)
    (text,) = (part for part in section if part.startswith(heading))
    table = [line for line in text.splitlines() if line.startswith("|")]
    return [[cell.strip(" `") for cell in line.strip("|").split("|")] for line in table[2:]]


def numbers(heading: str) -> dict[str, int]:
    return {row[1]: int(row[0]) for row in rows(heading)}


def enumerated(text: str, prefix: str) -> dict[str, int]:
    return {name: int(value) for name, value in re.findall(rf"\b({prefix}\w*) = (-?\d+)\b", text)}


def bits(text: str, prefix: str) -> dict[str, int]:
    return {name: int(bit) for name, bit in re.findall(rf"\b{prefix}(\w+) = 1u << (\d+)", text)}


def test_exit_codes() -> None:
    known = {value for name, value in vars(errors).items() if name.startswith("EXIT_")}
    assert {int(row[0]) for row in rows("Errors")} == known


def test_statuses() -> None:
    assert numbers("Statuses") == enumerated(STATUS, "BRACE_OK") | enumerated(STATUS, "BRACE_E_")


def test_refusals_are_those_of_the_firmware_and_brace_has_words_for_each() -> None:
    beside = enumerated(REFUSALS, "BRACE_REFUSED_")
    base = beside.pop("BRACE_REFUSED_STORE")
    store = {name: base + value for name, value in enumerated(STORE, "BRACE_STORE_E_").items()}
    assert len(store) == 7 and numbers("Refusals") == beside | store
    assert base == refusal.STORE
    statuses = set(enumerated(STATUS, "BRACE_E_").values()) - {-1}  # a null pointer cannot be asked for
    for value in statuses | set(beside.values()) | set(store.values()):
        text = refusal.error_of("it", value, 0, "here").render()
        assert "no reason" not in text and f"it: status {value}" not in text, value


def test_faults_and_their_emergency_codes() -> None:
    codes = [int(code, 16) for code in re.findall(r"X\(BRACE_FAULT_\w+, (0x[0-9a-f]{4})\)", CODES)]
    faults = bits(CODES, "BRACE_FAULT_")
    assert len(codes) == len(faults)
    known = {(bit, name, f"0x{codes[bit]:04x}") for name, bit in faults.items()}
    listed = {(int(row[0]), row[1], row[2]) for row in rows("Faults")}
    lacking = [f"| {bit} | `{name}` | {code} |" for bit, name, code in sorted(known - listed)]
    assert not lacking, f"docs/errors.md: the table of faults lacks the rows that begin so: {lacking}"
    assert listed <= known, f"docs/errors.md: no such fault, or another number: {sorted(listed - known)}"
    described = (FIRMWARE / "interface/brace.dbc").read_text()
    (said,) = re.findall(r'SG_ 129 error_code "([^"]*)"', described)
    assert {int(code, 16) for code in re.findall(r"0x[0-9a-f]{4}", said)} == {*codes, 0x1000, 0}


def words_of(folder: str) -> set[str]:
    return {word for path in (PROJECT / folder).rglob("*.c") for word in re.findall(r"\w+", path.read_text())}


def test_each_fault_has_a_cause_and_a_test() -> None:
    faults = {f"BRACE_FAULT_{name}" for name in bits(CODES, "BRACE_FAULT_")}
    caused, tested = words_of("firmware/app/src"), words_of("tests/unit") | words_of("tests/attack")
    assert not faults - caused, "nothing in firmware/app/src sets these: see 'Adding a fault' in docs/adding.md"
    assert not faults - tested, "no test in tests/unit names these: see 'Adding a fault' in docs/adding.md"


@pytest.mark.parametrize("heading, text, prefix", [("Flags", STATUS, "BRACE_FLAG_")])
def test_flags(heading: str, text: str, prefix: str) -> None:
    assert numbers(heading) == bits(text, prefix)
