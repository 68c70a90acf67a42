"""Every signal of the CAN database, both ways: encoded by the firmware's C and decoded by cantools, and the reverse."""

from __future__ import annotations

import math
import random
import re
from decimal import Decimal
from pathlib import Path
from typing import Any

import cantools.database
import cffi
import pytest

from brace.native.cdef import declarations
from interface.units import UNIT_SUFFIX
from brace.native import loader
from brace.wire import frames
from brace.wire.layout import Field, Layout

PROJECT = Path(__file__).resolve().parents[3]
HEADER = PROJECT / "firmware" / "interface" / "generated" / "brace" / "can_messages.h"
DBC = PROJECT / "firmware" / "interface" / "brace.dbc"
DBC_FD = DBC.with_name("brace_fd.dbc")
RANDOM = 250  # codes of each signal: all its bits have been 0 and 1 long before


@pytest.fixture(scope="module")
def c() -> tuple[Any, Any]:
    ffi = cffi.FFI()
    ffi.cdef(declarations([HEADER], [HEADER.parents[1]]))
    return ffi, ffi.dlopen(str(loader._find_library()))


@pytest.fixture(scope="module")
def database() -> Any:
    loaded: Any = cantools.database.load_file(DBC, strict=True)
    loaded.add_dbc_file(DBC_FD)
    return loaded


def layouts() -> list[tuple[Layout, str, str]]:
    """Each layout with its message in the database and what its signals' names begin with there."""
    listed = [(layout, name, "") for name, layout in (*frames.MESSAGES.items(), *frames.FD_MESSAGES.items())]
    for message, groups in (("details", frames.GROUPS), ("details_fd", frames.FD_GROUPS)):
        for name, parts in groups.items():
            listed += [(layout, message, name.removesuffix("_fd") + "_") for layout in parts]
    listed += [(layout, "request", name + "_") for name, layout in frames.REQUESTS.items()]
    for name, parts in frames.ANSWERS.items():
        listed += [(layout, "answer", f"{name}_{part}_") for part, layout in enumerate(parts)]
    return [*listed, (frames.REFUSAL, "answer", "refused_")]


def signal_of(layout: Layout, prefix: str, name: str) -> str:
    """What a field is called in the database: of a frame in parts, the sequence is common to all."""
    return name if layout.part is not None and name == "sequence" else prefix + name


def codes(field: Field, dice: random.Random) -> list[int]:
    """Smallest and largest code of a value, and random ones between."""
    low = -(1 << (field.bits - 1)) if field.signed else 0
    high = (1 << (field.bits - 1)) - 1 if field.signed else (1 << field.bits) - 1
    if field.kind == "value":
        low, high = (low + 1, high) if field.signed else (low, high - 1)
    return [low, high, *(dice.randint(low, high) for _ in range(RANDOM))]


def value_of(field: Field, code: int) -> float | int:
    return code * field.step if field.kind == "value" else code


def others(layout: Layout, prefix: str) -> dict[str, float | int]:
    """A frame in which every signal is 0."""
    values: dict[str, float | int] = {signal_of(layout, prefix, field.name): 0 for field in layout.fields}
    if layout.command is not None:
        values |= {"number" if layout.identifier == frames.ANSWER_ID else "code": layout.command, "token": 0}
    if layout.part is not None:
        values |= {"part": layout.part}
    return values


def close(field: Field, got: float, wanted: float) -> bool:
    """Within one step, and a float's rounding where floats carry it."""
    if field.kind == "number":
        return got == wanted
    return abs(got - wanted) <= field.step * 1.0001 + 1.2e-7 * abs(wanted)


@pytest.mark.parametrize(("layout", "message", "prefix"), layouts(), ids=lambda value: getattr(value, "name", None))
def test_every_signal(layout: Layout, message: str, prefix: str, c: tuple[Any, Any], database: Any) -> None:
    ffi, lib = c
    known = database.get_message_by_name(message)
    identifier = layout.identifier + 1
    assert known.frame_id == identifier
    pack = getattr(lib, f"brace_can_pack_{layout.name}")
    unpack = getattr(lib, f"brace_can_unpack_{layout.name}")
    struct, data = ffi.new(f"brace_can_{layout.name}_t *"), ffi.new("uint8_t[]", layout.size)
    dice = random.Random(layout.name)
    for field in layout.fields:
        member, signal = field.name + UNIT_SUFFIX[field.unit], signal_of(layout, prefix, field.name)
        listed = codes(field, dice) if field.kind != "f32" else None
        values = (
            [value_of(field, code) for code in listed]
            if listed is not None
            else [0.0, 3.4e38, -3.4e38, *(dice.uniform(-1e6, 1e6) for _ in range(RANDOM))]
        )
        for value in values:
            setattr(struct, member, value)
            assert pack(struct, data) == 0, f"{signal}: {value} is limited"
            read = known.decode(bytes(data), decode_choices=False)
            assert close(field, read[signal], value), f"{signal}: C wrote {value}, cantools reads {read[signal]}"

            sent = known.encode({**others(layout, prefix), signal: value}, strict=True, padding=False)
            ffi.memmove(data, bytes(sent).ljust(layout.size, b"\0"), layout.size)
            unpack(data, struct)
            got = getattr(struct, member)
            assert close(field, got, value), f"{signal}: cantools wrote {value}, C reads {got}"
            by_python = layout.decode(bytes(sent))[field.name]
            assert by_python is not None and close(field, by_python, value)
        setattr(struct, member, 0)
        check_unknown(field, signal, member, struct, data, known, layout, pack, unpack)
        check_limits(field, member, struct, data, layout, pack)


def check_unknown(
    field: Field, signal: str, member: str, struct: Any, data: Any, known: Any, layout: Layout, pack: Any, unpack: Any
) -> None:
    """NaN travels as the code that the database calls NOT_KNOWN, and never as zero."""
    if field.kind == "number":
        return
    setattr(struct, member, math.nan)
    assert pack(struct, data) == 0
    if field.kind == "f32":
        assert math.isnan(known.decode(bytes(data), decode_choices=False)[signal])
        assert layout.decode(bytes(data))[field.name] is None
        setattr(struct, member, 0)
        return
    assert str(known.decode(bytes(data))[signal]) == "NOT_KNOWN"
    assert layout.decode(bytes(data))[field.name] is None
    unpack(data, struct)
    assert math.isnan(getattr(struct, member))
    setattr(struct, member, 0)


def check_limits(field: Field, member: str, struct: Any, data: Any, layout: Layout, pack: Any) -> None:
    """Beyond its range a value is limited, and that is told."""
    if field.kind != "value":
        return
    for value, bound in ((1e30, max), (-1e30, min)):
        setattr(struct, member, value)
        assert pack(struct, data) == 1
        limit = bound(value_of(field, code) for code in codes(field, random.Random(0))[:2])
        assert layout.decode(bytes(data))[field.name] == pytest.approx(limit)
    setattr(struct, member, 0)


STEPS = {field.step for layout, _, _ in layouts() for field in layout.fields if field.kind == "value"}


@pytest.mark.parametrize("step", sorted(STEPS))
def test_a_value_has_no_more_digits_than_its_step(step: float) -> None:
    """13 steps of 2e-05 are 0.00026: the double nearest to it, not 0.00026000000000000003."""
    field = Field("x", 0, 24, kind="value", signed=True, step=step)
    decode = field.decoder()
    for code in [13, *codes(field, random.Random(7))]:
        assert decode(code & 0xFFFFFF) == float(code * Decimal(str(step)))


def test_the_frame_of_can_fd_is_one_in_its_database() -> None:
    """As the attributes of the format have it, with the rate switched; and the other database has none."""
    fd: Any = cantools.database.load_file(DBC_FD, strict=True)
    assert [message.name for message in fd.messages if message.is_fd] == [*frames.FD_MESSAGES, "details_fd"]
    assert [(message.frame_id, message.length) for message in fd.messages] == [(0x501, 64), (0x301, 64)]
    for message in fd.messages:
        assert str(message.dbc.attributes["VFrameFormat"].value) in ("StandardCAN_FD", "14")
        assert str(message.dbc.attributes["CANFD_BRS"].value) == "1"
    plain: Any = cantools.database.load_file(DBC, strict=True)
    assert not any(message.is_fd for message in plain.messages)


def test_database_has_the_promised_names(database: Any) -> None:
    signals = {s.name: s for m in database.messages for s in m.signals}
    for name in ("k_xx", "k_xz", "k_zz", "lambda_min", "lambda_max"):
        assert signals[name].unit == "N/mm"
    for name in ("stiff_axis", "theta1", "theta2"):
        assert signals[name].unit == "rad"


def test_a_multiplexed_message_says_which_part_it_is(c: tuple[Any, Any], database: Any) -> None:
    """The number that C packs is what C, cantools and Python find; cantools then shows that part's signals alone."""
    ffi, lib = c
    for name, groups in (("details", frames.GROUPS), ("details_fd", frames.FD_GROUPS)):
        known = database.get_message_by_name(name)
        for layout, group in [(layout, group) for group in groups for layout in groups[group]]:
            number, prefix = layout.part, group.removesuffix("_fd") + "_"
            struct, data = ffi.new(f"brace_can_{layout.name}_t *", {"sequence": 77}), ffi.new("uint8_t[]", layout.size)
            getattr(lib, f"brace_can_pack_{layout.name}")(struct, data)
            assert getattr(lib, f"brace_can_{name}_part")(data) == number
            read = known.decode(bytes(data), decode_choices=False)
            assert (read.pop("part"), read["sequence"]) == (number, 77)
            assert set(read) == {signal_of(layout, prefix, field.name) for field in layout.fields}


def test_the_page_s_example_is_what_it_says() -> None:
    page = (PROJECT / "docs" / "protocol.md").read_text()
    sent, told = (bytes.fromhex(text) for text in re.findall(r"`(?:cansend can0 601|581)#(\w+)`", page))
    request, answer = frames.REQUESTS["k_at_posture"], frames.ANSWERS["k_at_posture"]
    assert (sent[0], sent[1], request.decode(sent)) == (request.command, 9, {"theta1": 0.5, "theta2": 1.2})
    assert (told[0], told[1], answer[0].decode(told)) == (answer[0].command, 9, {"k_xx": 3.924, "k_xz": -1.908})
    assert len(answer) == 4
