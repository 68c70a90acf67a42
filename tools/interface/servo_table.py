"""The driver's table of servos, from the one list of them."""

from __future__ import annotations

import tomllib
from pathlib import Path


def servo_table(path: Path) -> str:
    """hal/dynamixel/src/dxl_model_table.h"""
    rows = "".join(
        f'    {{{servo["number"]}, "{servo["name"]}", {servo["current_step_ma"]!r}f, '
        f"{1e3 * servo['stall_torque_n_m'] / servo['stall_current_a']:.0f}.0f}}, \\\n"
        for servo in tomllib.loads(path.read_text())["servo"]
    )
    return (
        "/* The servos that the driver knows. Written by tools/interface from tools/brace/data/servos.toml, which has\n"
        " * the sources; do not edit. */\n"
        "/* clang-format off */\n"
        "#ifndef DXL_MODEL_TABLE_H\n#define DXL_MODEL_TABLE_H\n\n"
        "/* Rows of dxl_model_t. */\n"
        f"#define DXL_MODEL_TABLE \\\n{rows}\n#endif\n"
    )
