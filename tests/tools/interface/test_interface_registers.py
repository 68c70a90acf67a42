"""Places on the wires: Modbus registers and limbs of version 0.1 still mean what they meant."""

from __future__ import annotations

import csv
import re
import struct
import sys
from pathlib import Path

import pytest

from brace.bus.entries import index_of
from brace.ground.errors import VersionMismatchError
from brace.model import load_limb
from brace.params import pack
from brace.params.block import unpack
from brace.wire.measured import MEASURED
from brace.wire.names import PARAMETERS
from command_bench import PROJECT

sys.path.insert(0, str(PROJECT / "tools"))
from interface.codes import load_codes  # noqa: E402
from interface.dictionary import DictionaryError, load  # noqa: E402
from interface.measured import load_values  # noqa: E402
from interface.messages import load_wire  # noqa: E402
from interface.outputs import DICTIONARY, MESSAGES  # noqa: E402
from interface.questions import load_questions  # noqa: E402

DATA = Path(__file__).with_name("data")
REGISTERS = PROJECT / "firmware" / "interface" / "modbus.csv"
FROZEN = ("table", "address", "registers", "type", "unit", "scale", "access")


def rows(path: Path) -> dict[str, dict[str, str]]:
    with path.open(newline="") as file:
        return {row["name"]: row for row in csv.DictReader(file)}


def test_every_value_of_version_0_1_stands_where_it_stood() -> None:
    before, now = rows(DATA / "modbus-0.1.csv"), rows(REGISTERS)
    assert len(before) == 199
    moved = {name: now.get(name) for name, row in before.items()
             if name not in now or any(row[column] != now[name][column] for column in FROZEN)}
    assert not moved, "masters have stored these addresses: give new values free registers instead"


def test_no_two_values_share_a_register() -> None:
    for table in ("input", "holding"):
        taken = [int(row["address"]) for row in rows(REGISTERS).values() if row["table"] == table]
        assert len(set(taken)) == len(taken) and not any(address % 2 for address in taken)


def test_numbers_on_can_are_half_the_registers() -> None:
    now = rows(REGISTERS)
    for parameter in PARAMETERS:
        assert 2 * index_of(parameter.key) == int(now[parameter.key]["address"])
    for entry in MEASURED:
        assert 2 * (entry.index - 0x1000) == int(now[entry.name]["address"])


def test_k_in_space_and_its_posture_are_one_read() -> None:
    """One Modbus read is one snapshot, of at most 125 registers."""
    places = [int(row["address"]) for name, row in rows(REGISTERS).items()
              if name in ("theta1", "theta2", "k_is_in_space", "theta0", "k_across", "parameter_crc", "play_coxa")
              or name.startswith("space_")]
    assert max(places) + 2 - min(places) <= 125


def test_a_block_of_version_0_1_is_refused_and_its_limb_means_what_it_meant() -> None:
    """Its layout is another one, which the schema tells; its limb.toml makes a block of now with the same values."""
    content = bytes.fromhex((DATA / "parameters-0.1.hex").read_text())
    with pytest.raises(VersionMismatchError, match="71660dc3"):
        unpack(content, "version 0.1")
    block = pack(load_limb(DATA / "parameters-0.1.toml"))
    now = {parameter.key: int(block.words[parameter.index]) for parameter in PARAMETERS}
    places = {name: int(row["address"]) // 2 for name, row in rows(DATA / "modbus-0.1.csv").items() if name in now}
    assert sorted(places.values()) == list(range(108))
    for key, place in places.items():
        assert now[key] == struct.unpack_from("<I", content, 20 + 4 * place)[0], key


def altered(tmp_path: Path, before: str, after: str) -> Path:
    text = DICTIONARY.read_text()
    assert before in text
    path = tmp_path / "dictionary.toml"
    path.write_text(text.replace(before, after, 1))
    return path


@pytest.mark.parametrize(
    ("before", "after", "why"),
    [
        ('name = "coxa_mm"\nregister = 0', 'name = "coxa_mm"\nregister = 2',
         "coxa_mm has register 2; the first that is free is 0"),  # fmt: skip
        ("register = [6, 18, 30]", "register = [6, 18, 31]", "has register 31; the first that is free is 30"),
        ("register = [6, 18, 30]", "register = [6, 18]", "list of 3"),
        ("register = [6, 18, 30]", "register = 6", "list of 3"),
        ('name = "modbus_baud"\nregister = 214', 'name = "modbus_baud"\nregister = 300', "register"),
        ('name = "modbus_baud"\nregister = 214', 'name = "modbus_baud"\nregister = 206',
         "parameters: register 206 has two values: controller.heartbeat_hz and controller.modbus_baud; "
         "the first that is free is 214$"),
        ('[[group.entry]]\nname = "bus_load_ratio"',
         '[[group.entry]]\nname = "gait_hz"\nregister = 206\nunit = "Hz"\nrange = [0, 9]\ndefault = 0\n'
         'description = "a rate"\n\n[[group.entry]]\nname = "bus_load_ratio"',
         "controller.gait_hz and controller.heartbeat_hz; the first that is free is \\d+$"),
    ],
)
def test_bad_parameter_registers_are_refused(before: str, after: str, why: str, tmp_path: Path) -> None:
    with pytest.raises(DictionaryError, match=why):
        load(altered(tmp_path, before, after))


@pytest.mark.parametrize(
    ("before", "after", "why"),
    [
        ('name = "k_xx"\nregister = 20', 'name = "k_xx"\nregister = 22',
         "measured: .* has register 22; the first that is free is 20"),  # fmt: skip
        ('name = "take_up_tibia"\nregister = 198', 'name = "take_up_tibia"\nregister = 1980',
         "the first that is free is 198"),  # fmt: skip
        ('name = "asked_k_xx"\nregister = 4096', 'name = "asked_k_xx"\nregister = 4095',
         "answered: asked_k_xx has register 4095; the first that is free is 4096"),
        ('name = "k_xz"\nregister = 22', 'name = "k_xx"\nregister = 20', "^k_xx stands there twice"),
        ('name = "asked_friction"\nregister = 16416', 'name = "asked_friction"\nregister = 16414', "commands"),
    ],
)
def test_bad_registers_are_refused(before: str, after: str, why: str, tmp_path: Path) -> None:
    with pytest.raises(DictionaryError, match=why):
        load_values(altered(tmp_path, before, after), load_codes(DICTIONARY))


@pytest.mark.parametrize(
    ("before", "after", "why"),
    [
        ('asks = ["asked_dx", "asked_dz"]', 'asks = ["asked_dz", "asked_dx"]', "follow one another"),
        ('requests = ["sag_for_load"]', 'requests = ["contact_force"]', "types and units"),
        ('requests = ["sag_for_load"]', 'requests = ["sag"]', "there is no sag"),
        ('asks = ["asked_load_x", "asked_load_z"]', 'asks = ["asked_load_x", "asked_load"]', "there is no asked_load"),
        ('requests = ["k_at_tip_knee_up", "k_at_tip_knee_down"]', 'requests = ["k_at_tip_knee_up"]', "types and units"),
        ('requests = ["k_at_posture"]', 'requests = ["k_at_posture"]\nquestion = 1', "unknown question"),
        ('"asked_angle_left", "asked_contact"]', '"asked_angle_left"]', "types and units"),
    ],
)
def test_bad_questions_are_refused(before: str, after: str, why: str, tmp_path: Path) -> None:
    codes = load_codes(DICTIONARY)
    wire, values = load_wire(MESSAGES, codes), load_values(DICTIONARY, codes)
    with pytest.raises(DictionaryError, match=why):
        load_questions(altered(tmp_path, before, after), values, wire)


def test_every_value_of_a_question_belongs_to_one(tmp_path: Path) -> None:
    codes = load_codes(DICTIONARY)
    wire, values = load_wire(MESSAGES, codes), load_values(DICTIONARY, codes)
    path = tmp_path / "dictionary.toml"
    margin = r'\[\[question\]\]\nrequests = \["friction_margin"\].*?\n\n'
    path.write_text(re.sub(margin, "", DICTIONARY.read_text(), flags=re.S))
    with pytest.raises(DictionaryError, match="belongs to one question"):
        load_questions(path, values, wire)


def test_a_gap_may_be_declared(tmp_path: Path) -> None:
    """A value that is gone leaves its registers to nobody."""
    reserved = '\n[[reserved]]\narea = "measured"\nregister = 198\nvalues = 1\ndescription = "a value of version 0.1"\n'
    path = altered(tmp_path, 'name = "take_up_tibia"\nregister = 198', 'name = "take_up_tibia"\nregister = 318')
    path.write_text(path.read_text() + reserved)
    values = load_values(path, load_codes(DICTIONARY))
    assert (values.measured[-1].name, values.measured[-1].index) == ("take_up_tibia", 159)


def test_the_order_in_the_file_does_not_matter(tmp_path: Path) -> None:
    """Registers do not follow from places in the file: the first measured value is moved to the end of its list."""
    text = DICTIONARY.read_text()
    first, second = re.findall(r"\[\[measured\]\]\nname.*?(?=\n\[\[)", text, re.S)[:2]
    path = tmp_path / "dictionary.toml"
    path.write_text(text.replace(first, "", 1).replace(second, second + "\n" + first, 1))
    codes = load_codes(DICTIONARY)
    assert load_values(path, codes) == load_values(DICTIONARY, codes)
