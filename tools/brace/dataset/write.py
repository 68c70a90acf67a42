"""A dataset on disk: meta.toml and data.csv, in place together or not at all."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from brace.ground.files import OutputSet

_DECIMALS = {"theta1_rad": 6, "theta2_rad": 6, "enc1_rad": 7, "enc2_rad": 7}
_DEFAULT_DECIMALS = 6


def csv_text(columns: Mapping[str, np.ndarray], decimals: Mapping[str, int] | None = None) -> str:
    """Columns as CSV; whole numbers stay whole, `axis` becomes x or z, the rest gets a fixed number of
    decimals, and is left empty where it is NaN: not read."""
    places = {**_DECIMALS, **(decimals or {})}
    texts: list[list[str]] = []
    for name, values in columns.items():
        if name == "axis":
            texts.append(["z" if value else "x" for value in values.tolist()])
        elif values.dtype.kind in "iu":
            texts.append([str(value) for value in values.tolist()])
        else:
            form = f"%.{places.get(name, _DEFAULT_DECIMALS)}f"
            texts.append([form % value if value == value else "" for value in (values + 0.0).tolist()])
    lines = [",".join(columns), *(",".join(row) for row in zip(*texts))]
    return "\n".join(lines) + "\n"


def meta_text(tables: Mapping[str, object]) -> str:
    """meta.toml from plain values and one level of tables."""
    plain = [f"{key} = {_value(value)}" for key, value in tables.items() if not isinstance(value, Mapping)]
    for name, table in tables.items():
        if isinstance(table, Mapping):
            plain += [f"[{name}]", *(f"{key} = {_value(value)}" for key, value in table.items())]
    return "\n".join(plain) + "\n"


def write_dataset(
    folder: Path,
    meta: Mapping[str, object],
    columns: Mapping[str, np.ndarray],
    decimals: Mapping[str, int] | None = None,
    extra: Sequence[tuple[str, str]] = (),
) -> None:
    """Writes FOLDER/meta.toml and FOLDER/data.csv (and `extra` name, content pairs)."""
    with OutputSet() as outputs:
        outputs.add(folder / "meta.toml", meta_text(meta))
        outputs.add(folder / "data.csv", csv_text(columns, decimals))
        for name, content in extra:
            outputs.add(folder / name, content)
        outputs.commit()


def _value(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
        return f'"{escaped}"'
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(item) for item in value) + "]"
    return repr(value)
