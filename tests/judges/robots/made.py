"""Legs made at random: the model's shape in frames that lie anyhow, the same a little off, and what it cannot have."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from chain import Array, X, Y, Z, about

KINDS = ("exact", "a little off", "knee leans", "rolls in its plane", "beside", "leans", "two hinges", "leaning plane",
         "three in the plane", "slide", "mimic", "four hinges", "knee crosses")  # fmt: skip


def write(path: Path, kind: str, draw: np.random.Generator) -> str:
    """Writes a URDF; returns the foot's link."""
    small = {"a little off": 0.02, "knee leans": 0.0}.get(kind, 0.0)
    mount = about(Z, draw.uniform(-math.pi, math.pi))
    if kind == "leaning plane":
        mount = mount @ about(X, draw.uniform(0.3, 1.2))
    lean = {"leans": draw.uniform(0.1, 0.8)}.get(kind, small * draw.uniform(0.0, 1.0))
    direction = draw.uniform(-math.pi, math.pi)
    yaw_axis = about(math.cos(direction) * X + math.sin(direction) * Y, lean) @ Z
    if kind == "rolls in its plane":
        yaw_axis = about(Y, draw.uniform(0.2, 1.6)) @ Z
    if kind == "three in the plane":
        yaw_axis = about(Z, draw.uniform(-0.3, 0.3)) @ Y
    knee_axis = about(X, draw.uniform(0.005, 0.03)) @ Y if kind == "knee leans" else Y
    if kind == "knee crosses":
        knee_axis = about(X, draw.uniform(0.1, 1.5)) @ Y
    coxa, femur, tibia = draw.uniform(0.0, 0.1), draw.uniform(0.08, 0.4), draw.uniform(0.08, 0.4)
    most = 0.012 * (coxa + femur + tibia)
    aside = draw.uniform(0.02, 0.1) if kind == "beside" else (small > 0.0) * draw.uniform(-1.0, 1.0) * most
    bend, turn = draw.uniform(-math.pi, math.pi), draw.uniform(-2.5, 2.5)
    hip = coxa * X + aside * Y + draw.uniform(-0.05, 0.05) * Z
    knee = hip + about(Y, bend) @ X * femur + (small > 0.0) * draw.uniform(-0.2, 0.2) * most * Y
    foot = knee + about(Y, bend + turn) @ X * tibia
    joints = [("yaw", np.zeros(3), yaw_axis, "revolute"), ("hip", hip, Y, "revolute"),
              ("knee", knee, knee_axis, "revolute"), ("foot", foot, X, "fixed")]  # fmt: skip
    if kind == "rolls in its plane":  # the plane has the axis in it: it is moved along it, too
        joints[0] = ("yaw", -0.3 * draw.uniform() * yaw_axis, yaw_axis, "revolute")
    if kind == "two hinges":
        del joints[0]
    if kind == "slide":
        joints.insert(int(draw.integers(1, 4)), ("shock", (hip + knee) / 2, X, "prismatic"))
    if kind == "four hinges":
        joints.insert(3, ("ankle", (knee + foot) / 2, Y, "revolute"))
    mimic = "knee" if kind == "mimic" else ""
    path.write_text(_text(mount, joints, mimic, draw))
    return "foot_link"


def _text(mount: Array, joints: list[tuple[str, Array, Array, str]], mimic: str, draw: np.random.Generator) -> str:
    """Every link's frame is turned at random; axes may point either way."""
    text, parent = '<link name="body"/>', "body"
    place, turn = mount @ draw.uniform(-0.2, 0.2, 3), np.eye(3)
    origin = place
    for name, at, axis, kind in joints:
        new_place = origin + mount @ at
        new_turn = about(_unit(draw), draw.uniform(-3.0, 3.0))
        step, turned = turn.T @ (new_place - place), turn.T @ new_turn
        along = new_turn.T @ mount @ axis * draw.choice([-1.0, 1.0])
        low = draw.uniform(-1.5, 0.5)
        text += (
            f'<link name="{name}_link"/><joint name="{name}" type="{kind}"><parent link="{parent}"/>'
            f'<child link="{name}_link"/><origin xyz="{_numbers(step)}" rpy="{_numbers(_rpy(turned))}"/>'
            f'<axis xyz="{_numbers(along)}"/>'
            f'<limit lower="{low!r}" upper="{low + draw.uniform(0.5, 2.0)!r}" effort="1" velocity="1"/>'
            f'{"<mimic joint=" + chr(34) + "hip" + chr(34) + "/>" if name == mimic else ""}</joint>'
        )
        parent, place, turn = f"{name}_link", new_place, new_turn
    return f'<robot name="made">{text}</robot>'


def _unit(draw: np.random.Generator) -> Array:
    axis = draw.normal(size=3)
    unit: Array = axis / np.linalg.norm(axis)
    return unit


def _numbers(vector: Array) -> str:
    return " ".join(f"{part:.15g}" for part in vector)


def _rpy(turn: Array) -> Array:
    pitch = math.asin(-max(-1.0, min(1.0, turn[2, 0])))
    return np.array([math.atan2(turn[2, 1], turn[2, 2]), pitch, math.atan2(turn[1, 0], turn[0, 0])])
