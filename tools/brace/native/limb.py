"""A limb model as the firmware's struct (brace_limb_t) and as the plant's (brace_plant_model_t)."""

from __future__ import annotations

from typing import Any

from brace.errors import BadFileError
from brace.model import LimbModel
from brace.model.keys import LINKS
from brace.native.loader import Library

_LINK_FIELDS = {"axial_mm_per_n": "axial_mm_per_n", "bending_mm_per_n": "bending_mm_per_n", "tilt_rad": "tilt_rad",
                "lateral_mm_per_n": "lateral_mm_per_n", "torsion_rad_per_n_mm": "torsion_rad_per_n_mm",
                "moment_transfer": "moment_transfer_ratio"}
_PLANT_TABLES = ("geometry", "base", "gravity", "sensor", "creep", "thermal", "contact", "change")
STATUS_SINGULAR = -6


def status_text(native: Library, status: int) -> str:
    """The firmware's sentence for a status."""
    return str(native.ffi.string(native.lib.brace_status_text(status)).decode())


def firmware_limb(native: Library, model: LimbModel) -> Any:
    """`brace_limb_t *` with the model's values in float; refused when the firmware would refuse it."""
    limb = native.ffi.new("brace_limb_t *")
    for length in ("coxa_mm", "femur_mm", "tibia_mm"):
        setattr(limb, length, model.number(f"geometry.{length}"))
    for index, name in enumerate(LINKS):
        for key, field in _LINK_FIELDS.items():
            setattr(limb.link[index], field, model.number(f"link.{name}.{key}"))
        for field in ("compliance_rad_per_n_mm", "gap_rad", "zero_offset_rad"):
            setattr(limb.joint[index], field, model.number(f"joint.{name}.{field}"))
    for field in ("x_mm_per_n", "z_mm_per_n", "rotation_rad_per_n_mm"):
        setattr(limb.base, field, model.number(f"base.{field}"))
    for field in ("length_mm", "angle_rad", "compliance_rel", "gain_rel"):
        setattr(limb.uncertainty, field, model.number(f"uncertainty.{field}"))
    status = native.lib.brace_limb_check(limb)
    if status != 0:
        raise BadFileError("the firmware refuses this limb", where=model.where(), why=status_text(native, status),
                           next_step="check lengths and compliances; something must yield in each direction")
    return limb


def plant_model(native: Library, model: LimbModel) -> Any:
    """`brace_plant_model_t *` with every key of limb.toml."""
    plant = native.ffi.new("brace_plant_model_t *")
    native.lib.brace_plant_model_default(plant)
    fill_plant(plant, model)
    return plant


def fill_plant(plant: Any, model: LimbModel) -> None:
    """Writes a model into a plant struct (one of an array, say)."""
    for key, value in model.values.items():
        table, _, field = key.rpartition(".")
        group, _, name = table.partition(".")
        if group == "link":
            setattr(plant.link[LINKS.index(name)], _LINK_FIELDS[field], value)
        elif group == "joint":
            setattr(plant.joint[LINKS.index(name)], field, value)
        elif key == "change.link":
            plant.change.link_index = LINKS.index(value)
        elif group in _PLANT_TABLES:
            setattr(getattr(plant, group), field, value)


def plant_error(native: Library, status: int, model: LimbModel, doing: str) -> BadFileError:
    """The refusal for a negative status of the plant."""
    text = native.ffi.string(native.lib.brace_host_status_text(status)).decode()
    next_step = "give link or joint compliances" if status == STATUS_SINGULAR else "check the model's values"
    return BadFileError(f"the simulated limb cannot {doing}", where=model.where(), why=text, next_step=next_step)
