"""docs/limb-keys.md: every key of limb.toml that the controller keeps."""

from __future__ import annotations

from interface.dictionary import Dictionary, Entry

_HEAD = """# Keys of limb.toml

Written by `tools/interface` from `firmware/interface/dictionary.toml`; do not edit. Besides these a file has `format = 1`
and may have a `name`. What is not written has its default, the zero effect; unknown keys are refused. Every key but
those of the last section is one member of the controller's parameter block (`brace params pack`), a float or a whole
number of 32 bits. Its number is what `read_entry` and `write_entry` on CAN call it by, and half its Modbus register; it
never changes.
The last column is what a controller uses that has no valid block; it then flags every K `UNCALIBRATED`.

"""


_OF_THE_MODEL = """## Of the simulated limb alone

No controller keeps these: `brace params pack` passes them over. What the controller reckons with instead is on the safe
side: friction whose growth does not fade is the larger one.

"""


def keys_page(dictionary: Dictionary) -> str:
    """Tables of limb.toml in the order of the struct."""
    tables: dict[str, list[Entry]] = {}
    for entry in dictionary.parameters:
        tables.setdefault(entry.key.rpartition(".")[0], []).append(entry)
    text = _HEAD
    for table, entries in tables.items():
        text += f"## `[{table}]`\n\n| number | key | unit | range | default | means | without a block |\n"
        text += "|---|---|---|---|---|---|---|\n"
        text += "".join(_row(entry) for entry in entries) + "\n"
    text += _OF_THE_MODEL + "| key | unit | range | default | means |\n|---|---|---|---|---|\n"
    text += "".join(
        f"| `{entry.key}` | {entry.unit} | {_range(entry)} | {_number(entry, entry.default)} | {entry.description} |\n"
        for entry in dictionary.of_the_model
    )
    return text


def _row(entry: Entry) -> str:
    name = entry.key.rpartition(".")[2]
    default = "must be given" if entry.default is None else _number(entry, entry.default)
    safe = f'"{entry.texts[int(entry.safe)]}"' if entry.texts else _number(entry, entry.safe)
    means = entry.description
    return f"| {entry.number} | `{name}` | {entry.unit} | {_range(entry)} | {default} | {means} | {safe} |\n"


def _range(entry: Entry) -> str:
    if entry.texts:
        return ", ".join(f'"{text}"' for text in entry.texts)
    if entry.numbers:
        return ", ".join(str(number) for number in entry.numbers)
    left = "(" if entry.open_low or entry.low == -float("inf") else "["
    right = ")" if entry.high == float("inf") and not entry.infinite else "]"
    also = ", or true/false" if entry.ratio else ""
    return f"{left}{entry.low:g}, {entry.high:g}{right}{also}"


def _number(entry: Entry, value: object) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    return str(value) if entry.type == "u32" else f"{value:g}"
