"""Which files the generator writes, and whether they are as it would write them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from interface.c_answering import answering_header, answering_source, asking_source
from interface.c_codes import code_names_header, codes_header, codes_source
from interface.c_dispatch import dispatch_header
from interface.c_measured import measured_header
from interface.c_messages import messages_header, messages_sources
from interface.c_snapshot import snapshot_header, snapshot_source
from interface.c_structs import limb_fields_header, parameter_fields_header, ranges_header
from interface.c_table import list_header, table_header, table_source
from interface.codes import Codes, load_codes
from interface.dbc import dbc, dbc_fd
from interface.dictionary import Dictionary, load
from interface.keys_page import keys_page
from interface.measured import Values, load_values
from interface.messages import Wire, check_rates, dictionary_hash, load_wire
from interface.plant_model import key_table, model_header
from interface.protocol_page import protocol_page
from interface.python_codes import codes_module
from interface.python_messages import frames_module
from interface.python_names import names_module
from interface.questions import Question, load_questions, questions_header, questions_source
from interface.registers import measured_module, registers, registers_csv, registers_module
from interface.servo_table import servo_table

PROJECT = Path(__file__).resolve().parents[2]
DICTIONARY = PROJECT / "firmware" / "interface" / "dictionary.toml"
MESSAGES = PROJECT / "firmware" / "interface" / "messages.toml"


def outputs(
    dictionary: Dictionary, codes: Codes, wire: Wire, values: Values, questions: Sequence[Question]
) -> dict[str, str]:
    """Path below the project -> text."""
    check_rates(wire, {entry.key: entry.unit for entry in dictionary.parameters})
    language = dictionary_hash(wire, dictionary.schema + dictionary.numbers + codes.schema + values.schema)
    rows = registers(dictionary, values)
    return {
        "firmware/interface/brace.dbc": dbc(wire, language),
        "firmware/interface/brace_fd.dbc": dbc_fd(wire, language),
        "tools/brace/data/can/brace.dbc": dbc(wire, language),
        "tools/brace/data/can/brace_fd.dbc": dbc_fd(wire, language),
        "firmware/interface/generated/brace/can_messages.h": messages_header(wire, language),
        **{f"firmware/interface/generated/{name}.c": text for name, text in messages_sources(wire).items()},
        "firmware/interface/generated/brace/can_frames.h": dispatch_header(wire),
        "firmware/interface/generated/brace/answering.h": answering_header(wire),
        "firmware/interface/generated/can_asking.c": asking_source(wire),
        "firmware/interface/generated/can_answering.c": answering_source(wire),
        "firmware/interface/generated/brace/can_snapshot.h": snapshot_header(wire),
        "firmware/interface/generated/can_snapshot.c": snapshot_source(wire, values),
        "firmware/interface/generated/brace/codes.h": codes_header(codes),
        "firmware/interface/generated/brace/code_names.h": code_names_header(codes),
        "firmware/interface/generated/codes.c": codes_source(codes),
        "firmware/interface/generated/brace/measured.h": measured_header(values),
        "firmware/interface/generated/brace/questions.h": questions_header(questions),
        "firmware/interface/generated/questions.c": questions_source(questions, values),
        "firmware/interface/modbus.csv": registers_csv(rows),
        "docs/protocol.md": protocol_page(wire, values, language),
        "tools/brace/wire/codes.py": codes_module(codes),
        "tools/brace/wire/registers.py": registers_module(rows),
        "tools/brace/wire/measured.py": measured_module(values),
        "tools/brace/wire/frames.py": frames_module(wire, language),
        "firmware/core/include/brace/limb_fields.h": limb_fields_header(dictionary),
        "firmware/core/include/brace/ranges.h": ranges_header(dictionary),
        "firmware/interface/generated/brace/parameter_fields.h": parameter_fields_header(dictionary),
        "firmware/interface/generated/brace/parameter_list.h": list_header(dictionary),
        "firmware/interface/generated/parameter_table.h": table_header(dictionary),
        "firmware/interface/generated/parameter_table.c": table_source(dictionary),
        "tools/brace/wire/names.py": names_module(dictionary),
        "docs/limb-keys.md": keys_page(dictionary),
        "host_sim/api/brace_plant_model.h": model_header(dictionary),
        "host_sim/plant/model_key_table.h": key_table(dictionary),
        "hal/dynamixel/src/dxl_model_table.h": servo_table(PROJECT / "tools" / "brace" / "data" / "servos.toml"),
    }


def wanted_outputs() -> dict[str, str]:
    """What the two files of the dictionary say: path below the project -> text."""
    codes = load_codes(DICTIONARY)
    wire, values = load_wire(MESSAGES, codes), load_values(DICTIONARY, codes)
    return outputs(load(DICTIONARY), codes, wire, values, load_questions(DICTIONARY, values, wire))


def drifted(project: Path = PROJECT) -> list[str]:
    """Files that are not what the dictionary says."""
    wanted = wanted_outputs()
    return [name for name, text in wanted.items() if not (project / name).is_file()
            or (project / name).read_text() != text]


def write(project: Path = PROJECT) -> list[str]:
    """Writes what has drifted; returns its names."""
    wanted = wanted_outputs()
    changed = drifted(project)
    for name in changed:
        (project / name).parent.mkdir(parents=True, exist_ok=True)
        (project / name).write_text(wanted[name])
    return changed
