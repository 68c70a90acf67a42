"""Requests that Modbus asks by writing commands: read from dictionary.toml, and the table that a controller answers
from: brace/questions.h and questions.c."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, TypedDict, TypeVar

from interface.c_answering import answer_signals
from interface.dictionary import DictionaryError
from interface.measured import QUESTION, Measured, Values
from interface.messages import Request, Signal, Wire
from interface.units import UNIT_SUFFIX

_MADE = "/* Written by tools/interface from dictionary.toml; do not edit. */\n"
_HEAD = """
/* Requests that are asked over Modbus by writing commands, and answered in registers. */
#include <stdbool.h>
#include <stdint.h>

#include "brace/measured.h"

typedef struct {
    uint8_t first, count;  /* the commands that are written in one request: place in brace_commands_t, how many */
    uint8_t fields;        /* so many of them are the request's fields; the next one's value picks one of `code` */
    uint8_t codes;         /* how many requests there are to pick from */
    uint8_t code[2];       /* BRACE_REQUEST_...: all with the same fields and the same answer */
    uint8_t answer_first, answer_count; /* the values that take the answer: place in brace_answered_t, how many */
    bool none_is_an_answer; /* values that are not known say that the limb has none */
    uint8_t begin_code, begin_fields; /* a request that is asked before, with the first of the commands; 0: none */
} brace_question_t;

"""
_UNKNOWN = """extern const brace_question_t brace_questions[BRACE_QUESTION_COUNT];

/* Nothing has been asked: values of questions and answers are not known, all others are zero. */
extern const brace_commands_t brace_commands_unknown;
extern const brace_answered_t brace_answered_unknown;

#endif
"""


class _Raw(TypedDict, total=False):
    """A [[question]] as it stands in the file."""

    requests: list[str]
    asks: list[str]
    answers: list[str]
    none_is_an_answer: bool
    begins_with: str


class _Named(Protocol):
    @property
    def name(self) -> str: ...


_One = TypeVar("_One", bound=_Named)


@dataclass(frozen=True)
class Question:
    """One row: requests of one shape, and the commands and registers that stand for their fields and answers."""

    requests: tuple[Request, ...]
    asks: tuple[Measured, ...]
    answers: tuple[Measured, ...]
    none_is_an_answer: bool
    begins_with: Request | None


def load_questions(path: Path, values: Values, wire: Wire) -> tuple[Question, ...]:
    """Reads and checks the list."""
    questions = tuple(_question(raw, values, wire) for raw in tomllib.loads(path.read_text())["question"])
    asked = [value for question in questions for value in question.asks]
    if set(asked) != {value for value in values.commands if value.name.startswith(QUESTION)} or \
            len(set(asked)) != len(asked):
        raise DictionaryError(f"every command {QUESTION}... belongs to one question")
    if {value for question in questions for value in question.answers} != set(values.answered):
        raise DictionaryError("every answered value belongs to a question")
    return questions


def _question(raw: _Raw, values: Values, wire: Wire) -> Question:
    where = f"question {raw.get('requests')}"
    if set(raw) - set(_Raw.__annotations__):
        raise DictionaryError(f"{where}: unknown {', '.join(sorted(set(raw) - set(_Raw.__annotations__)))}")
    requests = tuple(_picked(wire.requests, raw["requests"], where))
    asks = tuple(_picked(values.commands, raw["asks"], where))
    answers = tuple(_picked(values.answered, raw["answers"], where))
    first = _picked(wire.requests, [raw["begins_with"]], where)[0] if "begins_with" in raw else None
    first_signals = first.question.signals if first else ()
    for request in requests:
        fields = (*first_signals, *request.question.signals)
        _match(f"{where}, fields", asks[: len(asks) - (len(requests) > 1)], fields)
        _match(f"{where}, answer", answers, answer_signals(request))
    if len(requests) > 2 or (len(requests) == 2 and asks[-1].type != "u32"):
        raise DictionaryError(f"{where}: a whole number picks one of two requests")
    if len(asks) < 2:
        raise DictionaryError(f"{where}: a single value is a command, not a question")
    return Question(requests, asks, answers, raw.get("none_is_an_answer", False), first)


def _picked(listed: Sequence[_One], names: Sequence[str], where: str) -> list[_One]:
    by_name = {one.name: one for one in listed}
    missing = [name for name in names if name not in by_name]
    if missing:
        raise DictionaryError(f"{where}: there is no {', '.join(missing)}")
    return [by_name[name] for name in names]


def _match(where: str, values: Sequence[Measured], signals: Sequence[Signal]) -> None:
    """The values follow one another, and are of the fields' types and units."""
    if [value.index for value in values] != list(range(values[0].index, values[0].index + len(values))):
        raise DictionaryError(f"{where}: registers follow one another")
    kinds = [(value.type == "f32", UNIT_SUFFIX[value.unit]) for value in values]
    wanted = [(signal.kind != "number", signal.member.removeprefix(signal.name).replace("_ratio", ""))
              for signal in signals]
    if kinds != wanted:
        raise DictionaryError(f"{where}: {', '.join(v.name for v in values)} are not of the fields' types and units")


def questions_header(questions: Sequence[Question]) -> str:
    """generated/brace/questions.h"""
    return (f"{_MADE}#ifndef BRACE_QUESTIONS_H\n#define BRACE_QUESTIONS_H\n{_HEAD}"
            f"enum {{ BRACE_QUESTION_COUNT = {len(questions)} }};\n{_UNKNOWN}")


def questions_source(questions: Sequence[Question], values: Values) -> str:
    """generated/questions.c"""
    rows = "".join(f"    {_row(question)},\n" for question in questions)
    asked = [value for value in values.commands if value.name.startswith(QUESTION)]
    return (f'{_MADE}#include "brace/questions.h"\n\n#include "brace/can_messages.h"\n\n'
            f"const brace_question_t brace_questions[BRACE_QUESTION_COUNT] = {{\n{rows}}};\n"
            + _unknown("commands", asked) + _unknown("answered", values.answered))


def _row(question: Question) -> str:
    codes = ", ".join(f"BRACE_REQUEST_{request.name.upper()}" for request in question.requests)
    first = question.begins_with
    first_fields = len(first.question.signals) if first else 0
    first_code = f"BRACE_REQUEST_{first.name.upper()}" if first else "0"
    fields = len(question.asks) - (len(question.requests) > 1) - first_fields
    none = "true" if question.none_is_an_answer else "false"
    return (f"{{{question.asks[0].index}, {len(question.asks)}, {fields}, {len(question.requests)}, {{{codes}}}, "
            f"{question.answers[0].index}, {len(question.answers)}, {none}, "
            f"{first_code}, {first_fields}}}")


def _unknown(name: str, values: Sequence[Measured]) -> str:
    members = "".join(
        f"    .{value.member} = {'__builtin_nanf(' + chr(34) * 2 + ')' if value.type == 'f32' else 'UINT32_MAX'},\n"
        for value in values)
    return f"\nconst brace_{name}_t brace_{name}_unknown = {{\n{members}}};\n"
