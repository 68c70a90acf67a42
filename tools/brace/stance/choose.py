"""What `brace stance choose` says: which of several footholds a limb should take next, and with which knee."""

from __future__ import annotations

import csv
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from brace.ground.errors import BadFileError, place
from brace.ground.files import TOML_LIMIT_BYTES, read_text
from brace.model.travel import travel_rad
from brace.stance.limb_law import JOINTS, shape_of
from brace.stance.stance_file import Limb, Stance
from brace.stance.statics import SLIDES
from brace.stance.world import NoStanceError, believed

PLACE = ("x_mm", "y_mm", "z_mm")
NORMAL = ("nx", "ny", "nz")
_GROUND = ("friction", "grip_n")
_FACTOR_MOST = 1000.0


@dataclass(frozen=True)
class Foothold:
    """A place that a limb may take, in the body's frame."""

    name: str
    place_mm: np.ndarray
    normal: np.ndarray
    friction_ratio: float
    grip_n: float


@dataclass(frozen=True)
class Choice:
    """A foothold with a posture. `reason`: why the limb cannot take it, or the body does not stand so; then the rest
    says nothing. payload_factor: at which the first foot moves, infinite: none."""

    foothold: str
    theta_rad: np.ndarray
    reason: str = ""
    margin_n: float = -np.inf
    margin_limb: str = ""
    payload_factor: float = -np.inf
    slip_limb: str | None = None
    sag_mm: float = np.inf

    def as_json(self) -> dict[str, object]:
        """One entry, the best first."""
        stands = not self.reason
        return {
            "foothold": self.foothold,
            "theta_rad": self.theta_rad if self.theta_rad.size else None,
            "stands": stands,
            "reason": self.reason or None,
            "least_margin_n": self.margin_n if stands else None,
            "least_margin_limb": self.margin_limb if stands else None,
            "first_slip": {"limb": self.slip_limb, "payload_factor": self.payload_factor} if stands else None,
            "sag_mm": self.sag_mm if stands else None,
        }


AIMS: dict[str, Callable[[Choice], float]] = {
    "slip": lambda one: -one.payload_factor,
    "margin": lambda one: -one.margin_n,
    "sag": lambda one: one.sag_mm,
}


def load_footholds(path: Path, limb: Limb) -> list[Foothold]:
    """Reads and checks foothold,x_mm,y_mm,z_mm; with nx,ny,nz, friction or grip_n where they differ from the limb's."""
    rows = list(csv.reader(read_text(path, TOML_LIMIT_BYTES, "table of footholds").splitlines()))
    header = [name.strip() for name in rows[0]] if rows else []
    if not {"foothold", *PLACE} <= set(header) or 0 < len(set(NORMAL) & set(header)) < len(NORMAL):
        raise BadFileError(
            "no footholds",
            where=place(path, 1),
            why=f"the header has {', '.join(header) or 'nothing'}",
            next_step="foothold,x_mm,y_mm,z_mm in the body's frame; nx,ny,nz, friction, grip_n may follow",
        )
    found = []
    for line, row in enumerate(rows[1:], 2):
        if any(cell.strip() for cell in row):
            cells = dict(zip(header, (cell.strip() for cell in row)))
            found.append(_foothold(path, line, cells, limb))
    if not found:
        raise BadFileError(
            "no footholds", where=place(path, 2), why="the table has a header alone", next_step="add a row for each"
        )
    return found


def _foothold(path: Path, line: int, cells: dict[str, str], limb: Limb) -> Foothold:
    def number(column: str, default: float) -> float:
        if column not in cells:
            return default
        try:
            value = float(cells[column])
        except ValueError:
            value = np.nan
        if not np.isfinite(value) or (column in _GROUND and value < 0.0):
            raise BadFileError(
                f"{column} = {cells[column]!r} is no place, direction or limit",
                where=place(path, line),
                why="places are in mm, a grip in N and friction a ratio, both not negative",
                next_step="write a number with a point",
            )
        return value

    normal = np.array([number(column, own) for column, own in zip(NORMAL, limb.normal, strict=True)])
    length = float(np.linalg.norm(normal))
    if not length > 0.0:
        raise BadFileError(
            "nx, ny, nz have no direction", where=place(path, line), why="all are zero", next_step="write 0,0,1 or so"
        )
    at_mm = np.array([number(column, 0.0) for column in PLACE])
    friction, grip_n = number("friction", limb.friction_ratio), number("grip_n", limb.grip_n)
    return Foothold(cells["foothold"], at_mm, normal / length, friction, grip_n)


def choose(stance: Stance, name: str, footholds: list[Foothold], aim: str) -> list[Choice]:
    """Each foothold with each posture that reaches it, the best first. What is best has many hills: K's smallest
    eigenvalue alone is quasi-convex along a limb's reach, margins of a body are not, so all are tried."""
    index = next(i for i, limb in enumerate(stance.limbs) if limb.name == name)
    found = []
    for foothold in footholds:
        postures = reaching_rad(stance.limbs[index], foothold.place_mm)
        if not postures:
            found.append(Choice(foothold.name, np.zeros(0), "out of reach"))
        found += [_tried(stance, index, foothold, theta) for theta in postures]
    return sorted(found, key=lambda one: (bool(one.reason), AIMS[aim](one)))


def _tried(stance: Stance, index: int, foothold: Foothold, theta_rad: np.ndarray) -> Choice:
    limb = replace(
        stance.limbs[index],
        theta_rad=theta_rad,
        normal=foothold.normal,
        friction_ratio=foothold.friction_ratio,
        grip_n=foothold.grip_n,
        offset_mm=np.zeros(3),
    )
    beyond = [
        joint
        for joint, angle in zip(JOINTS, theta_rad, strict=True)
        for low, high in [travel_rad(limb.model, joint)]
        if not low <= angle <= high
    ]
    if beyond:
        return Choice(foothold.name, theta_rad, f"{beyond[0]} leaves its travel")
    true_rad = theta_rad + [limb.model.number(f"joint.{joint}.zero_offset_rad") for joint in JOINTS]
    if float(foothold.normal @ (shape_of(limb, limb.model, true_rad).knee_mm - foothold.place_mm)) < 0.0:
        return Choice(foothold.name, theta_rad, "the knee is below the ground")
    world = believed(replace(stance, limbs=(*stance.limbs[:index], limb, *stance.limbs[index + 1 :])))
    try:
        standing = world.stand()
        if SLIDES in standing.state.contact:
            slid = stance.limbs[standing.state.contact.index(SLIDES)].name
            return Choice(foothold.name, theta_rad, f"under the weight {slid} slides")
        slip = world.first_slip(standing, _FACTOR_MOST)
        statics, state = world.load(standing, [world.payload])
    except NoStanceError as error:
        return Choice(foothold.name, theta_rad, error.why)
    margins = [statics.margin_n(i, force) for i, force in enumerate(state.force_n)]
    least = int(np.argmin(margins))
    sag = float(stance.down @ state.displacement_mm)
    first = None if slip.limb < 0 else stance.limbs[slip.limb].name
    return Choice(foothold.name, theta_rad, "", margins[least], stance.limbs[least].name, slip.factor, first, sag)


def reaching_rad(limb: Limb, place_mm: np.ndarray) -> list[np.ndarray]:
    """The commanded angles that bring the tip there without load: knee up, knee down; none where it is out of reach."""
    x, y, z = limb.turn.T @ (place_mm - limb.mount_mm)
    coxa, femur, tibia = (limb.model.number(f"geometry.{link}_mm") for link in JOINTS)
    zeros = np.array([limb.model.number(f"joint.{joint}.zero_offset_rad") for joint in JOINTS])
    out = float(np.hypot(x, y)) - coxa
    cosine = (out**2 + z**2 - femur**2 - tibia**2) / (2.0 * femur * tibia)
    if not abs(cosine) < 1.0:
        return []
    found = []
    for flexion in (np.arccos(cosine), -np.arccos(cosine)):
        raised = np.arctan2(z, out) + np.arctan2(tibia * np.sin(flexion), femur + tibia * np.cos(flexion))
        found.append(np.array([np.arctan2(y, x), raised, flexion]) - zeros)
    return found
