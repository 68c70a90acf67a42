"""Numbers of the dictionary that never change, because masters have stored them: registers, identifiers, numbers of
parts and answers, codes of requests, and what numbers and bits mean."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from sources import ROOT

DICTIONARY, MESSAGES = "firmware/interface/dictionary.toml", "firmware/interface/messages.toml"
ON_PURPOSE = "tests/discipline/moved_on_purpose.toml"
LINKS = ("coxa", "femur", "tibia")


def numbers(dictionary: Mapping[str, Any], messages: Mapping[str, Any]) -> Iterator[tuple[str, int]]:
    """Each with whose it is and what it is: "controller.load_hz register"."""
    for group in dictionary["group"]:
        for entry in group["entry"]:
            key = f"{entry.get('table', group['table'])}.{entry['name']} register"
            registers = entry.get("register", [])
            if isinstance(registers, int):
                yield key, registers
            else:
                yield from ((key.replace("*", link), one) for link, one in zip(LINKS, registers))
    for kind in ("measured", "answered", "command"):
        yield from ((f"{value['name']} register", value["register"]) for value in dictionary[kind])
    for kind, what in (("enum", "number"), ("bits", "bit")):
        for table in dictionary[kind]:
            number = -1
            for value in table["values"]:
                number = value.get("number", number + 1)
                yield f"{table['name']}.{value['name']} {what}", number
                if "emergency" in value:
                    yield f"{table['name']}.{value['name']} emergency", value["emergency"]
    for kind in ("message", "multiplexed", "fd_message"):
        for message in messages.get(kind, []):
            yield f"{message['name']} id", message["id"]
            for group in message.get("group", []):
                for place, part in enumerate(group["part"]):
                    yield f"{message['name']}.{group['name']}_{place} number", part["number"]
    for request in messages["request"]:
        yield f"{request['name']} code", request["code"]
        answers = request.get("answer_numbers", [answer["number"] for answer in request.get("answer", [])])
        yield from ((f"{request['name']}_answer_{place} number", number) for place, number in enumerate(answers))


def stored(dictionary: str, messages: str) -> dict[str, int]:
    """The numbers in the texts of the two files."""
    return dict(numbers(tomllib.loads(dictionary), tomllib.loads(messages)))


def moved(before: Mapping[str, int], now: Mapping[str, int], on_purpose: Mapping[str, int]) -> list[str]:
    """A sentence for each number that is another now. What has no number any more, or had none, has not moved."""
    return [
        f"{whose.replace(' ', ' had ')} {_word(whose, number)}, now {_word(whose, now[whose])}: masters have stored "
        "it. Give the new value another number; or if it moves on purpose, write "
        f'"{whose}" = {_word(whose, now[whose])} in {ON_PURPOSE}'
        for whose, number in before.items()
        if now.get(whose, number) not in (number, on_purpose.get(whose))
    ]


def twice(names: Iterable[str]) -> str:
    """A sentence for the first name that stands there twice; empty: none does."""
    seen: set[str] = set()
    for whose in names:
        if whose in seen:
            return f"{whose.rpartition(' ')[0]} stands there twice; give one of them another name"
        seen.add(whose)
    return ""


def compared(before: tuple[str, str], now: tuple[str, str], on_purpose: Mapping[str, int]) -> list[str]:
    """What has moved between the texts of the two files. A name that now stands twice is said alone: which of its two
    numbers it had before, nobody knows."""
    dictionary, messages = map(tomllib.loads, now)
    doubled = twice(whose for whose, _ in numbers(dictionary, messages))
    return [doubled] if doubled else moved(stored(*before), stored(*now), on_purpose)


def _word(whose: str, number: int) -> str:
    return f"0x{number:03x}" if whose.endswith((" id", " emergency")) else str(number)


def moved_since(before: tuple[str, str]) -> list[str]:
    """The same for the project's files; `before` are the texts that they had. Empty texts: nobody knows them."""
    if not all(before):
        return []
    now = (ROOT / DICTIONARY).read_text(), (ROOT / MESSAGES).read_text()
    return compared(before, now, tomllib.loads((ROOT / ON_PURPOSE).read_text()))
