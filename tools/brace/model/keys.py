"""Every key of limb.toml: unit, range, default (the zero effect), meaning; as the controller's dictionary has them."""

from __future__ import annotations

from brace.toml import Key
from brace.wire.names import OF_THE_MODEL, PARAMETERS
from brace.wire.parameter import Parameter

LINKS = ("coxa", "femur", "tibia")


def _key(parameter: Parameter) -> Key:
    whole = parameter.type == "u32"
    return Key(
        parameter.key,
        parameter.default,
        parameter.description,
        parameter.unit,
        parameter.low,
        parameter.high,
        open_low=parameter.open_low,
        infinite=parameter.infinite,
        kind="text" if parameter.texts else "integer" if whole else "ratio" if parameter.ratio else "number",
        choices=parameter.texts,
        numbers=parameter.numbers,
    )


def _by_table(keys: list[Key]) -> list[Key]:
    """Keys of one table side by side, as a file needs them; tables in the order of their first key."""
    tables: dict[str, list[Key]] = {}
    for key in keys:
        tables.setdefault(key.name.rpartition(".")[0], []).append(key)
    return [key for table in tables.values() for key in table]


LIMB_KEYS: tuple[Key, ...] = (
    Key("format", None, "the version of the file's format, 1", "", 1, 1, kind="integer"),
    Key("name", "", "a name for the limb", kind="text"),
    *_by_table([_key(parameter) for parameter in (*PARAMETERS, *OF_THE_MODEL)]),
)

KEY_BY_NAME = {key.name: key for key in LIMB_KEYS}

# What a controller is given of its motors, its noise and its own manners: no part of the simulated limb.
CONTROLLER_KEYS = frozenset(
    key.name for key in LIMB_KEYS if key.name.startswith(("motor.", "controller.")) or key.name == "sensor.noise_n"
)

# Something must yield: at least one of these is positive in a limb that can be pushed.
PLANAR_COMPLIANCES = tuple(
    key.name
    for key in LIMB_KEYS
    if key.name.endswith(("_mm_per_n", "_rad_per_n_mm"))
    and "coxa" not in key.name
    and not key.name.endswith(("lateral_mm_per_n", "torsion_rad_per_n_mm"))
)
