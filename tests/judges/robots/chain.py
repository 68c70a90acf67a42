"""A robot's URDF by plain XML and rotations: the joints up to a link, and where they are at any angles.

Shares nothing with tools/brace/newlimb: neither its parser nor its frames."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
X, Y, Z = np.eye(3)
HINGES = ("revolute", "continuous")


@dataclass(frozen=True)
class Joint:
    """One joint of the file: its place in the parent link [m], rotation, axis in its own frame, limits [rad]."""

    name: str
    kind: str
    place: Array
    turn: Array
    axis: Array
    limits: tuple[float, float] | None
    mimics: bool


@dataclass(frozen=True)
class Robot:
    """Links, and the joint above each link but the root."""

    path: Path
    links: list[str]
    above: dict[str, tuple[str, Joint]]

    def joints_up_to(self, link: str) -> list[Joint]:
        """From the root to a link, fixed ones included."""
        found: list[Joint] = []
        while link in self.above:
            link, joint = self.above[link]
            found.append(joint)
        return found[::-1]

    def moving_up_to(self, link: str) -> list[Joint]:
        """The same without fixed ones and a floating root."""
        return [joint for joint in self.joints_up_to(link) if joint.kind not in ("fixed", "floating")]

    def ends(self) -> list[str]:
        """The links with joints that no other end has more of: feet, hands, heads, but no camera on a thigh."""
        parents = {parent for parent, _ in self.above.values()}
        found: dict[tuple[str, ...], str] = {}
        for link in self.links:
            moving = tuple(joint.name for joint in self.moving_up_to(link))
            if link not in parents and moving:
                found[moving] = link  # of several at the same joints the last
        return [
            link for moving, link in found.items()
            if not any(more[: len(moving)] == moving != more for more in found)
        ]  # fmt: skip


def read(path: Path) -> Robot:
    root = ElementTree.parse(path).getroot()
    above = {}
    for each in root.findall("joint"):
        parent, child = each.find("parent"), each.find("child")
        if parent is not None and child is not None:
            above[str(child.get("link"))] = str(parent.get("link")), _joint(each)
    return Robot(path, [str(link.get("name")) for link in root.findall("link")], above)


def _joint(each: ElementTree.Element) -> Joint:
    origin, axis, limit = each.find("origin"), each.find("axis"), each.find("limit")
    roll, pitch, yaw = _three(origin, "rpy", "0 0 0")
    direction = _three(axis, "xyz", "1 0 0")
    kind = str(each.get("type"))
    limits = None
    if limit is not None and kind != "continuous":
        low, high = float(limit.get("lower", 0.0)), float(limit.get("upper", 0.0))
        limits = (low, high) if low != high else None
    return Joint(
        str(each.get("name")), kind, _three(origin, "xyz", "0 0 0"),
        about(Z, yaw) @ about(Y, pitch) @ about(X, roll),
        direction / np.linalg.norm(direction) if direction.any() else direction, limits, each.find("mimic") is not None,
    )  # fmt: skip


def _three(element: ElementTree.Element | None, name: str, default: str) -> Array:
    return np.array([float(part) for part in (default if element is None else element.get(name, default)).split()])


def about(axis: Array, angle_rad: float) -> Array:
    """Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turned: Array = np.eye(3) + np.sin(angle_rad) * cross + (1.0 - np.cos(angle_rad)) * cross @ cross
    return turned


def at(joints: list[Joint], angles_rad: dict[str, float]) -> tuple[list[tuple[Array, Array]], Array]:
    """Place [mm] and axis of every moving hinge in the root's frame, and the place of the last link's origin."""
    place, turn = np.zeros(3), np.eye(3)
    found = []
    for joint in joints:
        place, turn = place + turn @ joint.place, turn @ joint.turn
        if joint.kind in HINGES:
            found.append((1e3 * place, turn @ joint.axis))
            turn = turn @ about(joint.axis, angles_rad.get(joint.name, 0.0))
    return found, 1e3 * place
