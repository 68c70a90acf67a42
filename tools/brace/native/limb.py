"""A limb model as the firmware's struct (brace_limb_t) and as the plant's (brace_plant_model_t)."""

from __future__ import annotations

from array import array
from functools import cache
from typing import cast

from brace.ground.errors import BadFileError
from brace.model import LIMB_KEYS, LimbModel
from brace.model.keys import LINKS
from brace.native.c_data import CData
from brace.native.loader import Library
from brace.wire.names import PARAMETERS

# The members of brace_limb_t, which begins the controller's parameters, in its order.
_LIMB_KEYS = tuple(parameter.key for parameter in PARAMETERS if parameter.member.startswith("limb."))
STATUS_SINGULAR = -6


def status_text(native: Library, status: int) -> str:
    """The firmware's sentence for a status."""
    return str(native.ffi.string(native.lib.brace_status_text(status)).decode())


def firmware_limb(native: Library, model: LimbModel) -> CData:
    """`brace_limb_t *` with the model's values in float; refused when the firmware would refuse it."""
    limb = native.ffi.new("brace_limb_t *")
    members = array("f", (model.number(key) for key in _LIMB_KEYS))
    native.ffi.memmove(limb, members, members.itemsize * len(members))
    status = native.lib.brace_limb_check(limb)
    if status != 0:
        raise refused_limb(native, model, status)
    return limb


# Sources of compliance in the plane, the ones to suggest first.
_SOURCES = (
    "link.tibia.bending_mm_per_n",
    "joint.femur.compliance_rad_per_n_mm",
    "link.femur.bending_mm_per_n",
    "joint.tibia.compliance_rad_per_n_mm",
    "link.tibia.axial_mm_per_n",
    "link.femur.axial_mm_per_n",
    "base.x_mm_per_n",
    "base.z_mm_per_n",
    "base.rotation_rad_per_n_mm",
)
_ON_ONE_LINE = (
    {"link.tibia.bending_mm_per_n", "joint.tibia.compliance_rad_per_n_mm"},
    {"joint.femur.compliance_rad_per_n_mm", "base.rotation_rad_per_n_mm"},
)
_SHORTEST_COXA_MM = 1.0


def refused_limb(native: Library, model: LimbModel, status: int) -> BadFileError:
    """Why the firmware refuses this limb: which field, and what to write there. The format's ranges are the
    firmware's own, so what is left is what fields say together."""
    coxa, transfer = model.number("geometry.coxa_mm"), "link.coxa.moment_transfer"
    if model.number(transfer) > 0.0 and coxa < _SHORTEST_COXA_MM:
        return BadFileError(
            f"the firmware refuses this limb: geometry.coxa_mm = {coxa:g} with {transfer}",
            where=model.where(transfer),
            why=f"moment transfer divides by the link's length, at least {_SHORTEST_COXA_MM:g} mm",
            next_step=f"geometry.coxa_mm = 57.0, or {transfer} = false",
        )
    present = [key for key in _SOURCES if array("f", [model.number(key)])[0] > 0.0]
    alone = {next((i for i, line in enumerate(_ON_ONE_LINE) if key in line), key) for key in present}
    if len(alone) < 2:
        line = next((line for line in _ON_ONE_LINE if set(present) & line), set())
        missing = next(key for key in _SOURCES if key not in present and key not in line)
        table, _, leaf = missing.rpartition(".")
        return BadFileError(
            "the firmware refuses this limb: C is singular",
            where=model.where(present[0] if present else "link"),
            why=f"only {' and '.join(present) or 'nothing'} yields, along one line, so K across it is infinite"
            + ("" if len(present) else " (a float holds no smaller compliance than 1e-45)"),
            next_step=f"add [{table}] {leaf}, how far it yields, or another compliance of the plane",
        )
    return BadFileError(
        "the firmware refuses this limb",
        where=model.where("geometry"),
        why=status_text(native, status),
        next_step="check lengths and compliances against a measured limb, e.g. brace/data/paper-limb.toml",
    )


def plant_model(native: Library, model: LimbModel) -> CData:
    """`brace_plant_model_t *` with every key of limb.toml."""
    plant = native.ffi.new("brace_plant_model_t *")
    native.lib.brace_plant_model_default(plant)
    fill_plant(native, plant[0], model)
    return plant


def fill_plant(native: Library, plant: CData, model: LimbModel) -> None:
    """Writes a model into a plant struct (one of an array, say), every key of limb.toml at its own place."""
    positions, keys = plant_layout(native)
    link = LINKS.index(str(model.values["change.link"]))
    numbers = cast("dict[str, float]", {**model.values, "change.link": link})
    members = memoryview(native.ffi.buffer(native.ffi.addressof(plant))).cast("d")
    for position, key in zip(positions, keys, strict=True):
        members[position] = numbers[key]


@cache
def plant_layout(native: Library) -> tuple[list[int], list[str]]:
    """Index of each key's double in brace_plant_model_t, from the library's own list of keys."""
    keys, positions = [], []
    for key in LIMB_KEYS:
        offset = int(native.lib.brace_plant_key_offset(key.name.encode()))
        if offset >= 0:  # format, name and the calibration's trust are no part of the plant
            keys.append(key.name)
            positions.append(offset // 8)
    return positions, keys


def plant_error(native: Library, status: int, model: LimbModel, doing: str) -> BadFileError:
    """The refusal for a negative status of the plant."""
    text = native.ffi.string(native.lib.brace_host_status_text(status)).decode()
    next_step = "give link or joint compliances" if status == STATUS_SINGULAR else "check the model's values"
    return BadFileError(
        f"the simulated limb cannot {doing}", where=model.where(), why=text, next_step=next_step
    )
