"""The dictionary and what is generated from it: nothing has drifted, and a bad dictionary is refused."""

from __future__ import annotations

import math
import re
import sys
import zlib
from pathlib import Path

import pytest

from brace.model import LIMB_KEYS
from brace.model.keys import KEY_BY_NAME
from brace.wire.measured import MEASURED
from brace.wire.names import OF_THE_MODEL, PARAMETERS, SCHEMA_HASH
from brace.wire.registers import REGISTERS
from command_bench import PROJECT

sys.path.insert(0, str(PROJECT / "tools"))
from interface.codes import load_codes  # noqa: E402
from interface.dictionary import DictionaryError, load  # noqa: E402
from interface.measured import load_values  # noqa: E402
from interface.messages import load_wire  # noqa: E402
from interface.outputs import DICTIONARY, MESSAGES, drifted, outputs  # noqa: E402
from interface.questions import load_questions  # noqa: E402


def test_what_is_checked_in_is_what_the_generator_writes() -> None:
    assert drifted() == [], "run tools/interface: cd tools && ../.venv/bin/python -m interface"


def test_a_changed_dictionary_changes_what_is_generated(tmp_path: Path) -> None:
    changed = tmp_path / "dictionary.toml"
    coxa = 'name = "coxa_{}"\nregister = 0\nunit = "{}"'
    changed.write_text(DICTIONARY.read_text().replace(coxa.format("mm", "mm"), coxa.format("rad", "rad")))
    before, after = load(DICTIONARY), load(changed)
    assert before.schema_hash == SCHEMA_HASH != after.schema_hash
    codes = load_codes(DICTIONARY)
    wire, values = load_wire(MESSAGES, codes), load_values(DICTIONARY, codes)
    beside = codes, wire, values, load_questions(DICTIONARY, values, wire)
    texts = outputs(before, *beside), outputs(after, *beside)
    for ending in ("parameter_list.h", "parameter_table.c", "wire/names.py", "limb-keys.md"):
        (name,) = (name for name in texts[0] if name.endswith(ending))
        assert texts[0][name] != texts[1][name], name


def test_pages_have_the_numbers_of_the_wire() -> None:
    """What read_entry, write_entry and fetch_row are asked for by is what people read."""
    tables = (PROJECT / "docs" / "limb-keys.md").read_text().split("## `[")[1:]
    listed = {
        f"{table.partition(']')[0]}.{key}": int(number)
        for table in tables
        for number, key in re.findall(r"^\| (\d+) \| `(\w+)` \|", table, re.M)
    }
    assert listed == {p.key: p.number for p in PARAMETERS}
    recorder = (PROJECT / "firmware/app/src/jobs/loading/recorder.c").read_text()
    assert {entry.name: entry.index for entry in MEASURED} == {
        register.name: 0x1000 + register.address // 2
        for register in REGISTERS if register.table == "input" and register.address < 4096
    }  # fmt: skip
    database = (PROJECT / "firmware" / "interface" / "brace.dbc").read_text()
    (row,) = re.findall(r'^CM_ SG_ \d+ fetch_row_column "(.*)"', database, re.M)
    columns = re.findall(r"case (\d+): \*value = row->(\w+);", recorder)
    assert len(columns) == 15
    for number, column in columns:
        assert re.search(rf"\b{number} {column}\b", row), column


def test_schema_hash_is_of_keys_types_and_units() -> None:
    text = "".join(f"{p.key} {p.type} {p.unit}\n" for p in PARAMETERS)
    assert zlib.crc32(text.encode()) == SCHEMA_HASH


def test_every_key_of_the_file_is_a_parameter() -> None:
    of_the_model = {p.key for p in OF_THE_MODEL}
    assert {key.name for key in LIMB_KEYS} == {p.key for p in PARAMETERS} | of_the_model | {"format", "name"}
    assert all(p.default == 0.0 for p in OF_THE_MODEL), "a controller, which has none of them, is told of no effect"
    tables = [key.name.rpartition(".")[0] for key in LIMB_KEYS]
    for table in set(tables):  # a table is written once
        places = [i for i, name in enumerate(tables) if name == table]
        assert places == list(range(places[0], places[-1] + 1))
    assert [p.index for p in PARAMETERS] == list(range(len(PARAMETERS)))


def test_c_has_the_names_of_the_file() -> None:
    """A number of limb.toml is found in C under its own name; where tables share a struct, behind the table's name."""
    members = re.findall(r"^\s+(?:float|uint32_t) (\w+);", "".join(
        (PROJECT / header).read_text()
        for header in ("firmware/core/include/brace/limb_fields.h",
                       "firmware/interface/generated/brace/parameter_fields.h")
    ), re.M)  # fmt: skip
    for parameter in PARAMETERS:
        table, leaf = parameter.key.split(".")[0], parameter.key.split(".")[-1]
        assert leaf in members or f"{table}_{leaf}" in members, parameter.key
        assert parameter.member.rpartition(".")[2] in (leaf, f"{table}_{leaf}"), parameter.key


# contracts.md, as printed there: the file's defaults are the zero effect.
CONTRACT = {
    "joint.femur.gap_rad": (0.0, "rad"),
    "joint.tibia.coulomb_n_mm": (0.0, "N mm"),
    "joint.femur.hardening_n_mm_per_rad3": (0.0, "N mm/rad^3"),
    "base.rotation_rad_per_n_mm": (0.0, "rad/(N mm)"),
    "gravity.knee_n": (0.0, "N"),
    "sensor.gain": (1.0, ""),
    "sensor.saturation_n": (math.inf, "N"),
    "creep.ratio": (0.0, ""),
    "creep.time_constant_s": (1.0, "s"),
    "thermal.reference_degc": (22.0, "degC"),
    "contact.play_mm": (0.0, "mm"),
    "change.at_s": (math.inf, "s"),
    "change.link": ("tibia", ""),
    "change.bending_factor": (1.0, ""),
    "link.femur.moment_transfer": (0.0, ""),
}


@pytest.mark.parametrize("key", CONTRACT)
def test_defaults_are_those_of_the_format(key: str) -> None:
    assert (KEY_BY_NAME[key].default, KEY_BY_NAME[key].unit) == CONTRACT[key]


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("range = [0.0, 1e4]", "rnage = [0.0, 1e4]"),
        ('name = "tibia_mm"', 'name = "femur_mm"'),
        ("safe = 185.0", "safe = 0.5"),
        ('type = "u32"', 'type = "u16"'),
        ("default = inf", "default = nan"),
        ("format = 1", "format = 2"),
        ('name = "gap_rad"', 'name = "gap_mm"'),
        ('unit = "rad/(N mm)"', 'unit = "rad"'),
        ('unit = "degC"\nrange', 'unit = ""\nrange'),
        ('unit = "mm"\nrange', 'unit = "inch"\nrange'),
        ('unit = "mm"\nrange', "range"),
        ("range = [0.0, 1e4]\n", ""),
        ("required = true\nsafe = 185.0", "required = true"),
        ('field = "creep_ratio"', 'field = "creep_strength_ratio"'),
    ],
)
def test_a_bad_dictionary_is_refused(before: str, after: str, tmp_path: Path) -> None:
    text = DICTIONARY.read_text()
    assert before in text
    path = tmp_path / "dictionary.toml"
    path.write_text(text.replace(before, after, 1))
    with pytest.raises((DictionaryError, KeyError)):
        load(path)


@pytest.mark.parametrize(
    ("before", "after", "why"),
    [
        (
            "range = [-273.15, 1e3]\ndefault = 22.0",
            "range = [-55, 150]\ndefault = -80.0",
            "thermal.reference_degc: its default, -80.0, lies outside its range, -55 to 150",
        ),
        (
            "open_low = true\ndefault = 0.0625",
            "open_low = true\ndefault = 0.0",
            "controller.bus_load_ratio: its default, 0.0, lies outside its range, above 0.0, at most 1.0",
        ),
        ("safe = 185.0", "safe = 0.5", "its safe value, 0.5, lies outside its range, "),
        (
            "range = [-273.15, 1e3]\n",
            "",
            r"thermal.reference_degc: it lacks range; write range = \[least, most\]$",
        ),
        (
            'name = "heartbeat_hz"\nregister = 206',
            'name = "load_hz"\nregister = 206',
            "^controller.load_hz stands there twice; give one of them another name$",
        ),
    ],
)  # fmt: skip
def test_a_bad_dictionary_is_refused_with_the_way_out(before: str, after: str, why: str, tmp_path: Path) -> None:
    text = DICTIONARY.read_text()
    assert before in text
    path = tmp_path / "dictionary.toml"
    path.write_text(text.replace(before, after, 1))
    with pytest.raises(DictionaryError, match=why):
        load(path)


def test_a_range_with_the_greatest_first_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "dictionary.toml"
    path.write_text(DICTIONARY.read_text().replace("range = [0.0, 1e4]", "range = [1e4, 0.0]", 1))
    with pytest.raises(DictionaryError, match=r"its range \[10000.0, 0.0\] has the greatest first"):
        load(path)
