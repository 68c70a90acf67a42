"""What numbers mean and what parameters may be: said once in the dictionary, and the same in C and in Python."""

from __future__ import annotations

import math
import re
import sys
from pathlib import Path
from typing import Any

import cffi
import pytest

from brace.native import loader
from brace.native.cdef import declarations
from brace.wire.code import CodeTable
from brace.wire.codes import FAULT, FLAG, MODE, TABLES, TAKE_UP_OUTCOME
from brace.wire.names import PARAMETERS
from command_bench import PROJECT

sys.path.insert(0, str(PROJECT / "tools"))
from interface.c_answering import answering_source  # noqa: E402
from interface.c_snapshot import snapshot_source  # noqa: E402
from interface.codes import load_codes  # noqa: E402
from interface.dictionary import DictionaryError, load  # noqa: E402
from interface.measured import load_values  # noqa: E402
from interface.messages import check_rates, load_wire  # noqa: E402
from interface.outputs import DICTIONARY, MESSAGES  # noqa: E402

GENERATED = PROJECT / "firmware" / "interface" / "generated"
CORE = PROJECT / "firmware" / "core" / "include"
# Hand-written sources that once listed names or ranges of their own.
SOURCES = (
    "firmware/boards/common/stiffness_words.c",
    "tools/brace/stiffness/at_rest.py",
    "tools/brace/bus/snapshot.py",
)


@pytest.fixture(scope="module")
def c() -> tuple[Any, Any]:
    ffi = cffi.FFI()
    headers = [GENERATED / "brace" / name for name in ("codes.h", "code_names.h")]
    ffi.cdef(declarations(headers, [GENERATED, CORE]))
    return ffi, ffi.dlopen(str(loader._find_library()))


@pytest.mark.parametrize("table", TABLES.values(), ids=lambda table: table.name)
def test_c_and_python_say_the_same_of_every_number(table: CodeTable, c: tuple[Any, Any]) -> None:
    ffi, lib = c
    for number in range(-130, 260):
        code = next((code for code in table.codes if code.number == number), None)
        for what in ("name", "text"):
            said = ffi.string(getattr(lib, f"brace_{table.name}_{what}")(number)).decode()
            assert said == ("?" if code is None else getattr(code, what)), (table.name, number)


def test_constants_are_the_dictionary_s(c: tuple[Any, Any]) -> None:
    _, lib = c
    for code in MODE.codes:
        assert getattr(lib, f"BRACE_MODE_{code.name}") == code.number
    for code in FAULT.codes:
        assert getattr(lib, f"BRACE_FAULT_{code.name}") == 1 << code.number
    assert [code.name for code in FAULT.codes].index("SENSOR_COXA") == 9


def test_a_code_has_one_sentence() -> None:
    for table in TABLES.values():
        for code in table.codes:
            assert re.fullmatch(r"[A-Z0-9][^\n\"\\]*\.", code.text), (table.name, code.name)


def test_negative_numbers_are_found_in_an_unsigned_value() -> None:
    assert TAKE_UP_OUTCOME.name_of(-2) == TAKE_UP_OUTCOME.name_of(254) == "TRAVEL"
    assert TAKE_UP_OUTCOME.name_of(100) == "100" and TAKE_UP_OUTCOME.find(100) is None


def test_a_bit_without_a_name_is_told_by_its_place() -> None:
    assert FLAG.names_of_bits(0b1001) == ("UNCALIBRATED", "GAP_OPEN")
    assert FLAG.names_of_bits(1 << 20) == ("BIT_20",)


@pytest.mark.parametrize("source", SOURCES)
def test_names_of_codes_stand_in_the_dictionary_alone(source: str) -> None:
    text = (PROJECT / source).read_text()
    names = {code.name for table in (FLAG, FAULT) for code in table.codes}
    assert not [name for name in names if f'"{name}"' in text]


@pytest.mark.parametrize(
    ("before", "after", "why"),
    [
        ("emergency = 0x6100", "emergency = 0x16100", "fault.TICK_LATE: its emergency is no number from 0x0001"),
        ("emergency = 0x6100", "emergency = 0", "fault.TICK_LATE: its emergency is no number"),
        ("emergency = 0x6100", 'emergency = "0x6100"', "fault.TICK_LATE: its emergency is no number"),
        ('"TICK_LATE", emergency = 0x6100,', '"TICK_LATE",', "fault: TICK_LATE lacks an emergency"),
    ],
)
def test_a_bad_emergency_is_refused(before: str, after: str, why: str, tmp_path: Path) -> None:
    path = tmp_path / "dictionary.toml"
    path.write_text(DICTIONARY.read_text().replace(before, after, 1))
    with pytest.raises(DictionaryError, match=why):
        load_codes(path)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ('{name = "MONITOR", text', '{name = "START", text'),
        ('{name = "STOPPED", number = 4,', '{name = "STOPPED", number = 0,'),
        ('{name = "STOPPED", number = 4,', '{name = "STOPPED", number = 400,'),
        ('{name = "SATURATED", text', '{name = "SATURATED", number = 2, text'),
        ('constant = "BRACE_FAULT_"', 'constant = "BRACE_FAULT_"\nheader = "brace/status.h"'),
        ('constant = "BRACE_FAULT_"', 'constant = "BRACE_FAULT_"\ntype = "brace_fault_t"'),
        ('name = "heartbeat_state"', 'name = "contact"'),
        ('constant = "BRACE_DRIFT_NEXT_"', 'constant = "BRACE_MODE_"\ntypo = 1'),
    ],
)
def test_bad_codes_are_refused(before: str, after: str, tmp_path: Path) -> None:
    text = DICTIONARY.read_text()
    assert before in text
    path = tmp_path / "dictionary.toml"
    path.write_text(text.replace(before, after, 1))
    with pytest.raises(DictionaryError):
        load_codes(path)


@pytest.mark.parametrize(
    ("before", "after", "why"),
    [
        ('"JUMP_TIBIA"', '"JUMP_COXA"', "fault: two values are JUMP_COXA; give one of them another"),
        ('"JUMP_TIBIA", emergency = 0x7305', '"JUMP_COXA"', "fault: two values are JUMP_COXA"),
        ('"STOPPED", number = 4', '"BOOT", number = 0', "heartbeat_state: two values are BOOT;"),
    ],
)
def test_a_name_that_stands_twice_is_said_first(before: str, after: str, why: str, tmp_path: Path) -> None:
    text = DICTIONARY.read_text()
    assert before in text
    path = tmp_path / "dictionary.toml"
    path.write_text(text.replace(before, after, 1))
    with pytest.raises(DictionaryError, match=why):
        load_codes(path)


def test_a_code_that_is_not_there_is_refused(tmp_path: Path) -> None:
    codes = load_codes(DICTIONARY)
    values, wire = tmp_path / "dictionary.toml", tmp_path / "messages.toml"
    values.write_text(DICTIONARY.read_text().replace('names = "mode"', 'names = "mood"', 1))
    with pytest.raises(DictionaryError, match="mode.*mood"):
        load_values(values, codes)
    wire.write_text(MESSAGES.read_text().replace('bit_names = "fault"', 'bit_names = "mode"', 1))
    with pytest.raises(DictionaryError, match=r"\[\[bits\]\]"):
        load_wire(wire, codes)


@pytest.mark.parametrize(
    ("before", "after", "why"),
    [
        ('name = "part"\nbits = 8', 'name = "part"\nbits = 2', "0 to 3"),
        ('name = "part"\nbits = 8', 'name = "place"\nbits = 8', "one signal named 'part'"),
        (
            'name = "play_coxa"\nbits = 4',
            'name = "sequence"\nbits = 4',
            "sequence: every frame of details has a signal",
        ),
        ('name = "load_across"', 'name = "load"', "load: two groups of details have this name"),
        ('name = "stiffness_b"', 'name = "stiffness_a"', "stiffness_a: two frames have this name"),
        ("number = 17", "number = 16", "space_1: 16 is that of space_0; .*the first that is free is 1"),
        ("number = 16", "number = 256", "space_0: 256 does not fit"),
        ('name = "k_xz"\nfrom', 'name = "k_xx"\nfrom', "space_1.k_xx: the database calls it space_k_xx"),
        (
            "number = 16\n",
            'number = 16\n[[multiplexed.group.part.signal]]\nname = "more"\nbits = 14\ndescription = "it"\n',
            "space_0: its signals have 62 bits, its frame has room for 48",
        ),  # fmt: skip
        ('name = "load_fd"', 'name = "frost"', "frost: .* put the group frost into details, and call it frost_fd"),
        ('name = "load_fd"', 'name = "frost_fd"', "frost_fd: .* put the group frost into details"),
        ("code = 2\n", "code = 1\n", "write_entry: 1 is that of read_entry; codes of requests"),
        ("code = 2\n", "code = 0\n", "write_entry: 0 does not fit: codes of requests are 1 to 255"),
        ("number = 2\n", "number = 1\n", "write_entry_answer_0: 1 is that of read_entry_answer_0; numbers of answers"),
        ("number = 2\n", "number = 255\n", "write_entry_answer_0: 255 does not fit: numbers of answers are 1 to 254"),
        ("answer_numbers = [24, 25]", "answer_numbers = [24]", "rollback.*one for each of the 2"),
        ("id = 0x200", "id = 0x180", "that of stiffness_a; free identifiers: 0x100, 0x200, "),
        ("id = 0x200", "id = 0x201", "no multiple of 0x80"),
        ('rate = "controller.stiffness_hz"', 'rate = "motor.stiffness_hz"', "rate"),
        ("by_hand = true", "", "emergency: it has neither a rate nor by_hand = true"),
        (
            'rate = "controller.heartbeat_hz"\nby_hand = true',
            'rate = "controller.heartbeat_hz"',
            "heartbeat: what goes out at a rate has the signal 'sequence'",
        ),  # fmt: skip
        ('name = "sequence"', 'name = "number"', "stiffness_a: what goes out at a rate has the signal 'sequence'"),
        ("wraps = true\n", "", "stiffness_a.sequence: .*stand still"),
        ('name = "sequence"\nbits = 8', 'name = "sequence"\nbits = 6', "stiffness_a.sequence: .*at least 8"),
        ('name = "sequence"\nbits = 8', 'name = "sequence"\nbits = 8\nsigned = true', "sequence: it is an unsigned"),
        ('name = "space"\nrate = "controller.stiffness_hz"', 'name = "space"', "space_0: it has neither a rate nor"),
        ("id = 0x180", "id = 0x800", "stiffness_a: its identifier 0x800 is more than the 11 bits"),
        ("id = 0x180", 'id = "0x180"', "stiffness_a: id = '0x180' is not a whole number"),
        ("coxa = true", 'coxa = "yes"', "coxa = 'yes' is not true or false"),
        ("wraps = true", "wraps = 1", "stiffness_a.sequence: wraps = 1 is not true or false"),
        ("bits = 24", "bits = true", "stiffness_a.k_xx: bits = True is not a whole number"),
        ("step = 0.001", "step = 0", "step are above 0"),
        ("step = 0.001", "step = -0.001", "step are above 0"),
        ("step = 0.001", 'step = "0.001"', "step = '0.001' is not a number"),
        ("bits = 24", "bits = 0", "bits and step are above 0"),
        ('name = "k_xz"', 'name = "k_xx"', "stiffness_a.k_xx stands there twice; give one"),
        ('name = "stiffness_a"', 'name = "stiffness a"', "stiffness a: a name begins with a small letter"),
        ('name = "k_xx"', 'name = "K_xx"', "stiffness_a.K_xx: a name begins with a small letter"),
        (
            'signed = true\nkind = "value"\nstep = 0.0005\nunit = "N/mm"',
            'kind = "value"\nstep = 0.01\nunit = "degC"',
            "stiffness_a.k_xx: a temperature in degC may be below 0 and would be sent as 0; write signed = true",
        ),
        ('unit = "N/mm"', 'unit = "N/m"', "no unit 'N/m'; units are"),
        ('rate = "controller.stiffness_hz"', 'rates = "controller.stiffness_hz"', "message stiffness_a: unknown rates"),
        ("coxa = true", "cox = true", "group .*: unknown cox; it has .* and may have rate, by_hand, coxa"),
        ("code = 2\n", "", "request write_entry: it lacks code"),
        ('name = "drift_cause"\nbits = 4', 'name = "drift_cause"\nbits = 2', "do not hold"),
        ('answers_as = "commit"', 'answers_as = "comit"', "rollback.*answers_as"),
        ('answers_as = "commit"', "", "rollback.*answers_as"),
    ],
)
def test_bad_messages_are_refused(before: str, after: str, why: str, tmp_path: Path) -> None:
    text = MESSAGES.read_text()
    assert before in text
    path = tmp_path / "messages.toml"
    path.write_text(text.replace(before, after, 1))
    with pytest.raises(DictionaryError, match=why):
        load_wire(path, load_codes(DICTIONARY))


@pytest.mark.parametrize(
    ("before", "after", "why"),
    [
        ('from = "space_k_xx"', 'from = "space_k_ww"', "space_0.k_xx: no measured value is named 'space_k_ww'"),
        ('from = "space_k_xx"', 'from = "theta0"', "space_0.k_xx: theta0 is f32 in 'rad'"),
        ('from = "space_flags"', 'from = "force_x"', "space_4.flags: force_x is f32"),
        ('saturated_by = ["stiffness_a"', 'saturated_by = ["emergency"', "stiffness_b.flags.*emergency"),
        ('bit_names = "flag"\nsaturated_by', "saturated_by", "stiffness_b.flags.*SATURATED"),
    ],
)
def test_process_data_that_is_not_measured_is_refused(before: str, after: str, why: str, tmp_path: Path) -> None:
    text = MESSAGES.read_text()
    assert before in text
    path = tmp_path / "messages.toml"
    path.write_text(text.replace(before, after, 1))
    wire = load_wire(path, load_codes(DICTIONARY))
    with pytest.raises(DictionaryError, match=why):
        snapshot_source(wire, load_values(DICTIONARY, load_codes(DICTIONARY)))


@pytest.mark.parametrize("rate", ["controller.tick_us", "controller.heartbeat_hz"])
def test_a_rate_that_no_parameter_is_is_refused(tmp_path: Path, rate: str) -> None:
    """The heartbeat's rate is one for what is sent by hand alone."""
    path = tmp_path / "messages.toml"
    path.write_text(MESSAGES.read_text().replace("controller.stiffness_hz", rate, 1))
    keys = {entry.key: entry.unit for entry in load(DICTIONARY).parameters}
    check_rates(load_wire(MESSAGES, load_codes(DICTIONARY)), keys)
    with pytest.raises(DictionaryError, match=f"stiffness_a: {rate} is no rate of process data; rates are"):
        check_rates(load_wire(path, load_codes(DICTIONARY)), keys)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ('bit_names = "flag"\nsaturated_by = ["answer"]', 'saturated_by = ["answer"]'),
        ('\nsaturated_by = ["answer"]', '\nsaturated_by = ["stiffness_a"]'),
    ],
)
def test_an_answer_that_cannot_tell_what_was_limited_is_refused(before: str, after: str, tmp_path: Path) -> None:
    text = MESSAGES.read_text()
    assert before in text
    path = tmp_path / "messages.toml"
    path.write_text(text.replace(before, after, 1))
    with pytest.raises(DictionaryError, match="k_at_posture.flags: saturated_by"):
        answering_source(load_wire(path, load_codes(DICTIONARY)))


def test_ranges_in_c_are_those_of_the_dictionary() -> None:
    """Every constant is the bound that Python checks limb.toml with, as a float."""
    text = (CORE / "brace" / "ranges.h").read_text()
    known = {"FLT_MAX": math.inf, "INFINITY": math.inf, "-FLT_MAX": -math.inf, "-INFINITY": -math.inf, "0x1p-149f": 0.0}
    constants = {
        name: known.get(value, None) if value in known else float(value.rstrip("fu"))
        for name, value in re.findall(r"^#define (BRACE_RANGE_\w+) (\S+)$", text, re.M)
    }
    stems = {
        struct.type: struct.type.removeprefix("brace_").removesuffix("_t").upper()
        for struct in load(DICTIONARY).structs
    }
    bounds = {parameter.key: (parameter.low, parameter.high) for parameter in PARAMETERS}
    seen = 0
    for struct in load(DICTIONARY).structs:
        for entry in struct.fields:
            name = f"BRACE_RANGE_{stems[struct.type]}_{entry.field.upper()}"
            if entry.numbers:
                assert name + "_MIN" not in constants
                continue
            assert (constants[name + "_MIN"], constants[name + "_MAX"]) == bounds[entry.key], name
            seen += 2
    assert seen == len(constants)
