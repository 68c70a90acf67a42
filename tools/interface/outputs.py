"""Which files the generator writes, and whether they are as it would write them."""

from __future__ import annotations

from pathlib import Path

from interface.c_table import list_header, table_header, table_source
from interface.dictionary import Dictionary, load
from interface.keys_page import keys_page
from interface.python_names import names_module

PROJECT = Path(__file__).resolve().parents[2]
DICTIONARY = PROJECT / "firmware" / "interface" / "dictionary.toml"


def outputs(dictionary: Dictionary) -> dict[str, str]:
    """Path below the project -> text."""
    return {
        "firmware/interface/generated/brace/parameter_list.h": list_header(dictionary),
        "firmware/interface/generated/parameter_table.h": table_header(dictionary),
        "firmware/interface/generated/parameter_table.c": table_source(dictionary),
        "tools/brace/wire/names.py": names_module(dictionary),
        "docs/limb-keys.md": keys_page(dictionary),
    }


def drifted(project: Path = PROJECT) -> list[str]:
    """Files that are not what the dictionary says."""
    wanted = outputs(load(DICTIONARY))
    return [name for name, text in wanted.items() if not (project / name).is_file() or (project / name).read_text() != text]


def write(project: Path = PROJECT) -> list[str]:
    """Writes what has drifted; returns its names."""
    wanted = outputs(load(DICTIONARY))
    changed = drifted(project)
    for name in changed:
        (project / name).parent.mkdir(parents=True, exist_ok=True)
        (project / name).write_text(wanted[name])
    return changed
