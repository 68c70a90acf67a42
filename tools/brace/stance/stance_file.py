"""stance.toml: a body, where its limbs are mounted, their footholds, and the payload."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from brace import toml
from brace.ground.errors import BadFileError
from brace.model import LimbModel, load_limb

WHAT = "stance file"
LIMBS_MOST = 8  # BRACE_STANCE_LIMBS
_TURN = 2.0 * np.pi


def _vector(name: str, meaning: str, unit: str, most: float, default: list[float] | None) -> toml.Key:
    return toml.Key(name, default, meaning, unit, -most, most, kind="vector")


KEYS = (
    toml.Key("format", None, "the format of this file", low=1, high=1, kind="integer"),
    toml.Key("name", "", "a name for people", kind="text"),
    toml.Key("body.weight_n", None, "the weight of the body without its limbs", "N", 0.0, 1e5),
    _vector("body.com_mm", "the body's centre of mass", "mm", 1e4, [0.0, 0.0, 0.0]),
    _vector("body.down", "where gravity points, in the body's frame", "", 1e3, [0.0, 0.0, -1.0]),
    _vector("payload.force_n", "the force of the payload on the body", "N", 1e5, [0.0, 0.0, 0.0]),
    _vector("payload.at_mm", "where the payload pulls", "mm", 1e4, [0.0, 0.0, 0.0]),
)
LIMB_KEYS = (
    toml.Key("name", None, "the limb's name", kind="text"),
    toml.Key("model", None, "its limb.toml, beside this file", kind="text"),
    toml.Key("node", 0, "the CAN node of its controller; 0: its place in this file, from 1", "", 0, 127, kind="integer"),
    _vector("mount_mm", "where the limb's first axis stands", "mm", 1e4, None),
    _vector("mount_rpy_rad", "the turn of the limb's frame into the body's: roll, pitch, yaw", "rad", _TURN, [0.0] * 3),
    _vector("theta_rad", "the commanded angles of coxa, femur and tibia", "rad", _TURN, None),
    _vector("foothold.normal", "the direction out of the ground", "", 1e3, [0.0, 0.0, 1.0]),
    toml.Key("foothold.friction", None, "the friction coefficient of foot and ground", "", 0.0, 10.0),
    toml.Key("foothold.friction_sd", 0.0, "how well that is known, one sigma", "", 0.0, 10.0),
    toml.Key("foothold.grip_n", 0.0, "how hard the foot may be pulled; 0: it only presses", "N", 0.0, 1e5),
    toml.Key("foothold.offset_sd_mm", 1.0, "how well the foothold's place is known, one sigma each", "mm", 0.0, 100.0),
    _vector("foothold.offset_mm", "where it is, seen from where the tip stands without load", "mm", 100.0, [0.0] * 3),
)  # fmt: skip


@dataclass(frozen=True)
class Limb:
    """One limb; vectors in the body's frame."""

    name: str
    model: LimbModel
    mount_mm: np.ndarray
    turn: np.ndarray  # 3 x 3: from the limb's frame into the body's
    theta_rad: np.ndarray
    normal: np.ndarray
    friction_ratio: float
    friction_sd: float
    grip_n: float
    offset_sd_mm: float
    offset_mm: np.ndarray
    node: int


@dataclass(frozen=True)
class Stance:
    """A body on its limbs, and the payload."""

    name: str
    limbs: tuple[Limb, ...]
    weight_n: float
    com_mm: np.ndarray
    down: np.ndarray  # unit vector
    payload_n: np.ndarray
    payload_at_mm: np.ndarray


def load_stance(path: Path) -> Stance:
    """Reads and checks a stance.toml and the limb models that it names; refuses with file:line, field and reason."""
    document = toml.read(path, WHAT)
    content = dict(document.content)
    listed = content.pop("limb", None)
    values = toml.check(document, KEYS, WHAT, content=content)
    if not isinstance(listed, list) or not listed or not all(isinstance(entry, dict) for entry in listed):
        raise BadFileError(
            "no limbs",
            where=document.where("limb"),
            why="a stance lists the limbs that the body stands on",
            next_step="add a [[limb]] for each, with name, model, mount_mm, theta_rad and [limb.foothold]",
        )
    if len(listed) > LIMBS_MOST:
        raise BadFileError(
            f"{len(listed)} limbs",
            where=document.where(f"limb.{LIMBS_MOST}"),
            why=f"at most {LIMBS_MOST} limbs bear one body here",
            next_step="leave out those that are in the air",
        )
    models: dict[Path, LimbModel] = {}
    limbs = tuple(_limb(document, index, entry, models) for index, entry in enumerate(listed))
    _refuse_twice(document, limbs)
    _refuse_node_twice(document, limbs)
    return Stance(
        str(values["name"]) or path.stem,
        limbs,
        toml.number(values, "body.weight_n"),
        _array(values, "body.com_mm"),
        _unit(document, values, "body.down"),
        _array(values, "payload.force_n"),
        _array(values, "payload.at_mm"),
    )


def _limb(document: toml.Document, index: int, entry: Mapping[str, object], models: dict[Path, LimbModel]) -> Limb:
    prefix = f"limb.{index}."
    values = toml.check(document, LIMB_KEYS, WHAT, prefix=prefix, content=entry)
    path = document.path.parent / str(values["model"])
    if path not in models:
        models[path] = load_limb(path)
    return Limb(
        str(values["name"]),
        models[path],
        _array(values, "mount_mm"),
        turn_of(*_array(values, "mount_rpy_rad")),
        _array(values, "theta_rad"),
        _unit(document, values, "foothold.normal", prefix),
        toml.number(values, "foothold.friction"),
        toml.number(values, "foothold.friction_sd"),
        toml.number(values, "foothold.grip_n"),
        toml.number(values, "foothold.offset_sd_mm"),
        _array(values, "foothold.offset_mm"),
        int(toml.number(values, "node")) or index + 1,
    )


def _refuse_twice(document: toml.Document, limbs: tuple[Limb, ...]) -> None:
    names = [limb.name for limb in limbs]
    for index, name in enumerate(names):
        if name in names[:index]:
            raise BadFileError(
                f"two limbs are named {name!r}",
                where=document.where(f"limb.{index}.name"),
                why="answers and measurements name a limb",
                next_step="give each limb its own name",
            )


def _refuse_node_twice(document: toml.Document, limbs: tuple[Limb, ...]) -> None:
    nodes = [limb.node for limb in limbs]
    for index, node in enumerate(nodes):
        if node in nodes[:index]:
            raise BadFileError(
                f"two limbs have node {node}",
                where=document.where(f"limb.{index}.node"),
                why="each limb has its own controller; a limb without `node` has its place in the file, from 1",
                next_step="give each limb the node of its controller",
            )


def turn_of(roll_rad: float, pitch_rad: float, yaw_rad: float) -> np.ndarray:
    """The rotation matrix of roll about x, then pitch about the fixed y, then yaw about the fixed z, as URDF has it."""
    (sr, sp, sy), (cr, cp, cy) = np.sin([roll_rad, pitch_rad, yaw_rad]), np.cos([roll_rad, pitch_rad, yaw_rad])
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def _array(values: Mapping[str, toml.Value], key: str) -> np.ndarray:
    return np.array(values[key], dtype=float)


def _unit(document: toml.Document, values: Mapping[str, toml.Value], key: str, prefix: str = "") -> np.ndarray:
    vector = _array(values, key)
    length = float(np.linalg.norm(vector))
    if not length > 0.0:
        raise BadFileError(
            f"{prefix}{key} has no direction",
            where=document.where(prefix + key),
            why="all three numbers are zero",
            next_step="write a vector such as [0.0, 0.0, 1.0]; its length does not matter",
        )
    return vector / length
