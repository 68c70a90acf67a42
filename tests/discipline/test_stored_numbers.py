"""No number that masters have stored is another than where this branch left main."""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path

import pytest

from stored_numbers import DICTIONARY, MESSAGES, compared, moved, numbers, stored

PROJECT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(PROJECT / "tests"))

from check import base, moved_numbers  # noqa: E402

NOW = ((PROJECT / DICTIONARY).read_text(), (PROJECT / MESSAGES).read_text())
FAULT = '    {name = "TICK_LATE"'


def test_none_has_moved() -> None:
    said = moved_numbers(base())
    assert not said, "\n".join(said)


def swapped(text: str, a: str, b: str) -> str:
    return re.sub(f"{a}\\b|{b}\\b", lambda found: b if found[0] == a else a, text)


@pytest.mark.parametrize(
    ("file", "before", "after", "said"),
    [
        (0, "register = 220", "register = 252", "controller.load_hz had register 220, now 252: masters have stored it"),
        (0, "register = [6, 18, 30]", "register = [6, 18, 252]", " had register 30, now 252"),
        (
            0,
            FAULT,
            '    {name = "NEW", emergency = 0x4210, text = "It is new."},\n' + FAULT,
            "fault.TICK_LATE had bit 3, now 4",
        ),  # fmt: skip
        (0, '"TICK_LATE", emergency = 0x6100', '"TICK_LATE", emergency = 0x6101', "TICK_LATE had emergency"),
        (1, "number = 113\n", "number = 150\n", " had number 113, now 150"),
        (1, "code = 2\n", "code = 200\n", "write_entry had code 2, now 200"),
        (1, "number = 2\n", "number = 200\n", "write_entry_answer_0 had number 2, now 200"),
        (1, "answer_numbers = [24, 25]", "answer_numbers = [24, 250]", "rollback_answer_1 had number 25, now 250"),
        (1, "id = 0x180", "id = 0x100", "stiffness_a had id 0x180, now 0x100"),
    ],
)
def test_one_that_moves_is_named(file: int, before: str, after: str, said: str) -> None:
    texts = list(NOW)
    assert before in texts[file]
    texts[file] = texts[file].replace(before, after, 1)
    sentences = moved(stored(*NOW), stored(*texts), {})
    assert said in sentences[0]
    (whose,) = re.findall(r'write "(.*?)" = (\w+)', sentences[0])
    assert len(moved(stored(*NOW), stored(*texts), {whose[0]: int(whose[1], 0)})) == len(sentences) - 1


def test_two_that_change_places_are_named() -> None:
    texts = swapped(NOW[0], "register = 248", "register = 250"), NOW[1]
    assert len(moved(stored(*NOW), stored(*texts), {})) >= 2


@pytest.mark.parametrize(
    ("file", "before", "after", "name"),
    [
        (0, '"modbus_baud"', '"load_hz"', "controller.load_hz"),
        (0, '"JUMP_TIBIA"', '"JUMP_COXA"', "fault.JUMP_COXA"),
        (0, FAULT, '    {name = "JUMP_COXA", emergency = 0x4210, text = "It is new."},\n' + FAULT, "fault.JUMP_COXA"),
        (1, 'name = "eigenvalues"', 'name = "stiffness_a"', "stiffness_a"),
        (1, 'name = "load"', 'name = "space"', "details.space_0"),
    ],
)
def test_a_name_that_stands_twice_is_said_alone(file: int, before: str, after: str, name: str) -> None:
    texts = list(NOW)
    assert before in texts[file]
    texts[file] = texts[file].replace(before, after, 1)
    said = [f"{name} stands there twice; give one of them another name"]
    assert compared(NOW, (texts[0], texts[1]), {}) == said


def test_each_is_called_by_a_name_of_its_own() -> None:
    names = [name for name, _ in numbers(*map(tomllib.loads, NOW))]
    assert len(names) > 600 and len(set(names)) == len(names)


def test_what_is_new_or_gone_has_not_moved() -> None:
    assert moved({"a register": 1}, {"b register": 1}, {}) == []
