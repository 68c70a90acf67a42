"""Draws stances whose truth is hidden, and writes what the command may know: stance.toml, limb.toml, forces."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import servos
from limbs import Array, Limbs, compliance, small
from scipy.spatial.transform import Rotation
from truth import World

SENSOR_N = 0.3
PLAY_RAD = np.radians(0.33)  # full play of each joint, of which limb.toml says nothing
ZERO_RAD = 0.003
OFFSET_MM = 1.0
COMPLIANCE_REL = 0.10  # one sigma of every spring and link
SOFTEST_N_PER_MM, STIFFEST_N_PER_MM = 0.5, 30.0


@dataclass(frozen=True)
class Hidden:
    """What the command does not know, in its unit; the default is the judged world, Hidden.none() the exact one."""

    zero_rad: float = ZERO_RAD
    offset_mm: float = OFFSET_MM
    play_rad: float = PLAY_RAD
    compliance_rel: float = COMPLIANCE_REL
    sensor_n: float = SENSOR_N
    friction_rel: float = 0.0
    tells_play: bool = False  # limb.toml says how wide the play is; where in it a joint lies stays hidden
    currents: bool = False  # no sensor at the tips: servos' currents, whose friction limb.toml tells

    @staticmethod
    def none() -> Hidden:
        return Hidden(0, 0, 0, 0, 0, 0)


@dataclass(frozen=True)
class Stance:
    """`nominal` are the limbs that limb.toml has; `friction` what stance.toml says of the footholds."""

    name: str
    world: World
    nominal: Limbs
    rpy_rad: Array
    friction: Array
    hidden: Hidden
    noise_n: Array

    def names(self) -> list[str]:
        return [f"limb {i}" for i in range(len(self.friction))]


def _limbs(rng: np.random.Generator, n: int) -> Limbs:
    """Limbs of about the paper's robot's size whose K at the tip lies between the softest and the stiffest."""
    made: list[Limbs] = []
    while len(made) < n:
        length = np.array([55.0, 110.0, 130.0]) * rng.uniform(0.7, 1.3, 3)
        theta = np.array([rng.uniform(-0.5, 0.5), rng.uniform(-0.2, 0.9), rng.uniform(1.0, 2.1)])
        joint = np.exp(rng.uniform(np.log(3e-6), np.log(4e-5), 3))
        along = np.exp(rng.uniform(np.log(5e-4), np.log(5e-3), 2))
        across = np.exp(rng.uniform(np.log(0.01), np.log(0.15), 2))
        link = np.stack([along, across * rng.uniform(0.7, 1.4, 2), across], axis=1)
        one = Limbs(length[None], theta[None], joint[None], link[None], np.zeros((1, 3)))
        stiffness = 1 / np.linalg.eigvalsh(compliance(one)[0])
        if stiffness.min() > SOFTEST_N_PER_MM and stiffness.max() < STIFFEST_N_PER_MM:
            made.append(one)
    return Limbs(**{name: np.concatenate([getattr(limb, name) for limb in made]) for name in vars(made[0])})


def unit(v: Array) -> Array:
    unit: Array = v / np.linalg.norm(v, axis=-1, keepdims=True)
    return unit


def draw(seed: int, number: int, hidden: Hidden = Hidden(), finite: bool = True) -> Stance:
    """Stance `number` of a seed: 3 to 6 limbs around a body on a floor, a slope, a wall or under a ceiling."""
    rng = np.random.default_rng([seed, number])
    n = int(rng.integers(3, 7))
    nominal = _limbs(rng, n)
    yaw = 2 * np.pi * (np.arange(n) + rng.uniform(-0.2, 0.2, n) + rng.uniform()) / n
    radius = rng.uniform(70, 130)
    mount = np.stack([radius * np.cos(yaw), radius * np.sin(yaw), rng.uniform(-15, 15, n)], axis=1)
    rpy = np.stack([rng.normal(0, 0.1, n), rng.normal(0, 0.1, n), np.arctan2(np.sin(yaw), np.cos(yaw))], axis=1)
    turn = Rotation.from_euler("xyz", rpy).as_matrix()
    tip = mount + np.einsum("nab,nb->na", turn, small(nominal, np.zeros((n, 3)))[0])
    where = str(rng.choice(["floor", "slope", "wall", "ceiling"], p=[0.4, 0.15, 0.25, 0.2]))
    leans = {"floor": rng.uniform(0, 0.1), "slope": rng.uniform(0.1, 0.3), "wall": np.pi / 2, "ceiling": np.pi}[where]
    heading = rng.uniform(0, 2 * np.pi)
    down = np.array([np.sin(leans) * np.cos(heading), np.sin(leans) * np.sin(heading), -np.cos(leans)])
    grips = where in ("wall", "ceiling")
    normal = unit(np.array([0, 0, 1.0]) + np.c_[rng.normal(0, 0.1, (n, 2)), np.zeros(n)])
    friction = rng.uniform(0.6, 1.1, n)
    pull = unit(down + rng.normal(0, 0.15, 3)) if rng.uniform() < 0.5 else unit(rng.normal(size=3))
    world = World(
        limbs=nominal, zero_rad=rng.normal(0, 1, (n, 3)) * hidden.zero_rad, mount_mm=mount, turn=turn, commanded_mm=tip,
        offset_mm=rng.normal(0, 1, (n, 3)) * hidden.offset_mm, normal=normal,
        friction=friction * (1 + hidden.friction_rel * np.clip(rng.normal(size=n), -2, 2)),
        grip_n=rng.uniform(10, 30, n) if grips else np.zeros(n), weight_n=30 * down, com_mm=rng.normal(0, 10, 3),
        payload_n=10 * pull, payload_at_mm=rng.uniform(-60, 60, 3), finite=finite)
    factor = 1 + hidden.compliance_rel * np.clip(rng.normal(size=(n, 9)), -2.5, 2.5)
    limbs = replace(nominal, joint_rad_per_n_mm=nominal.joint_rad_per_n_mm * factor[:, :3],
                    link_mm_per_n=nominal.link_mm_per_n * factor[:, 3:].reshape(n, 2, 3),
                    gap_rad=np.full((n, 3), hidden.play_rad))
    return Stance(f"{where} {seed}-{number}", replace(world, limbs=limbs), nominal, rpy, friction, hidden,
                  rng.normal(0, 1, (n, 3)) * hidden.sensor_n)


def moved_rad(stance: Stance, way_mm: Array) -> Array:
    """(n, 3): the angles to command, by the limbs that limb.toml has, for tips that move by `way_mm` (n, 3) in the
    body's frame."""
    limbs, nothing = stance.nominal, np.zeros_like(way_mm)
    theta, own = limbs.theta_rad.copy(), np.einsum("nab,na->nb", stance.world.turn, way_mm)
    wanted = small(limbs, nothing)[0] + own
    for _ in range(20):
        tip = small(replace(limbs, theta_rad=theta), nothing)[0]
        slope = np.stack([(small(replace(limbs, theta_rad=theta + 1e-6 * one), nothing)[0] - tip) / 1e-6
                          for one in np.eye(3)], axis=2)
        theta = theta + np.linalg.solve(slope, (wanted - tip)[..., None])[..., 0]
    return theta


def _list(values: Array) -> str:
    return "[" + ", ".join(repr(float(value)) for value in values) + "]"


def _limb_toml(limbs: Limbs, i: int, hidden: Hidden) -> str:
    length, joint, link = limbs.length_mm[i], limbs.joint_rad_per_n_mm[i], limbs.link_mm_per_n[i]
    lines = ["format = 1", f'name = "limb {i}"', "[geometry]"]
    lines += [f"{name}_mm = {float(value)!r}" for name, value in zip(("coxa", "femur", "tibia"), length)]
    for name, (along, across, within) in zip(("femur", "tibia"), link):
        lines += [f"[link.{name}]", f"axial_mm_per_n = {float(along)!r}", f"lateral_mm_per_n = {float(across)!r}",
                  f"bending_mm_per_n = {float(within)!r}"]
    for name, value in zip(("coxa", "femur", "tibia"), joint):
        lines += [f"[joint.{name}]", f"compliance_rad_per_n_mm = {float(value)!r}"]
        lines += [f"gap_rad = {float(hidden.play_rad)!r}"] * hidden.tells_play
    if hidden.currents:
        lines += [line for name in ("coxa", "femur", "tibia") for line in servos.toml(name)]
    lines += ["[uncertainty]", f"angle_rad = {max(hidden.zero_rad, 1e-6)!r}",
              f"compliance_rel = {max(hidden.compliance_rel, 1e-6)!r}", "length_mm = 0.001"]
    return "\n".join(lines) + "\n"


def write(stance: Stance, folder: Path, offset_mm: Array | None = None) -> Path:
    """stance.toml and its limbs' files; returns the stance's path. offset_mm: what is said of the footholds' places."""
    folder.mkdir(parents=True, exist_ok=True)
    world = stance.world
    weight = float(np.linalg.norm(world.weight_n))
    lines = ["format = 1", f'name = "{stance.name}"', "[body]", f"weight_n = {weight!r}",
             f"com_mm = {_list(world.com_mm)}",
             f"down = {_list(world.weight_n / weight)}"]
    for i, name in enumerate(stance.names()):
        (folder / f"limb{i}.toml").write_text(_limb_toml(stance.nominal, i, stance.hidden))
        offset = [] if offset_mm is None else [f"offset_mm = {_list(offset_mm[i])}"]
        lines += ["[[limb]]", f'name = "{name}"', f'model = "limb{i}.toml"', f"mount_mm = {_list(world.mount_mm[i])}",
                  f"mount_rpy_rad = {_list(stance.rpy_rad[i])}", f"theta_rad = {_list(stance.nominal.theta_rad[i])}",
                  "[limb.foothold]", f"normal = {_list(world.normal[i])}", f"friction = {float(stance.friction[i])!r}",
                  f"grip_n = {float(world.grip_n[i])!r}", f"offset_sd_mm = {stance.hidden.offset_mm!r}", *offset]
    lines += ["[payload]", f"force_n = {_list(world.payload_n)}", f"at_mm = {_list(world.payload_at_mm)}"]
    path = folder / "stance.toml"
    path.write_text("\n".join(lines) + "\n")
    return path


def write_measured(stance: Stance, read_n: Array, path: Path) -> None:
    """What the tips' sensors read before the payload (n, 3), in the body's frame."""
    _write_table("limb,fx_n,fy_n,fz_n", stance, read_n, path)


def write_torques(stance: Stance, read_n_mm: Array, path: Path) -> None:
    """What the joints' motors give before the payload (n, 3), by their currents."""
    _write_table("limb,tau0_n_mm,tau1_n_mm,tau2_n_mm", stance, read_n_mm, path)


def _write_table(header: str, stance: Stance, values: Array, path: Path) -> None:
    rows = [f"{name}," + ",".join(repr(float(value)) for value in row) for name, row in zip(stance.names(), values)]
    path.write_text(header + "\n" + "\n".join(rows) + "\n")
