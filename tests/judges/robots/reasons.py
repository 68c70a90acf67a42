"""Is the reason true that `brace new --urdf` gives? Each kind of sentence, and how it is found out anew."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import numpy as np
from chain import HINGES, Array, Robot, at

Judge = Callable[[Robot, str, re.Match[str]], bool]
LEAN_DEG = 1.82  # so far a joint may lean from the model's shape
ASIDE = 0.01  # of the reach
NUMBER = r"([-+.\de]+)"


def _near(said: str, true: float, digits: float = 6e-3) -> bool:
    """Three digits are said."""
    return abs(float(said) - true) <= digits * abs(true) + 1e-3


def _between_deg(one: Array, other: Array) -> float:
    """The smaller angle between two lines."""
    return math.degrees(math.atan2(float(np.linalg.norm(np.cross(one, other))), abs(float(one @ other))))


class _Shape:
    """The chain with all joints at zero."""

    def __init__(self, robot: Robot, link: str) -> None:
        self.hinges, self.foot = at(robot.joints_up_to(link), {})
        self.names = [joint.name for joint in robot.moving_up_to(link) if joint.kind in HINGES]
        self.first, self.hip, self.knee = self.hinges[0], self.hinges[-2], self.hinges[-1]

    def beside_mm(self, place: Array, vertical: bool) -> float:
        """From the plane that has the first joint's axis in it and the hip's across. vertical: where that axis is the
        limb's z, its point at the hip's height counts."""
        (origin, axis), across = self.first, self.hip[1]
        if vertical:
            origin = origin + axis * (self.hip[0] - origin)[2] / axis[2]
        return abs(float((place - origin) @ across))

    def reach_mm(self) -> float:
        across = self.hip[1]
        steps = [self.knee[0] - self.hip[0], self.foot - self.knee[0]]
        along = self.first[1] - across * (self.first[1] @ across)
        apart = np.cross(along / np.linalg.norm(along), self.hip[0] - self.first[0])
        coxa = abs(float(apart @ across))
        return coxa + sum(float(np.linalg.norm(step - across * (step @ across))) for step in steps)


def _count(robot: Robot, link: str, said: re.Match[str]) -> bool:
    names = [joint.name for joint in robot.moving_up_to(link) if joint.kind in HINGES]
    told = [part for part in (said[3] or "").split(", ") if part]
    return len(names) not in (2, 3) and int(said[1]) == len(names) and said[2] == link and told == names


def _others(robot: Robot, link: str, said: re.Match[str]) -> bool:
    others = [joint.name for joint in robot.moving_up_to(link) if joint.kind not in HINGES]
    return bool(others) and said[1].split(", ") == others


def _mimics(robot: Robot, link: str, said: re.Match[str]) -> bool:
    bound = [joint.name for joint in robot.moving_up_to(link) if joint.mimics]
    return bool(bound) and said[1].split(", ") == bound


def _not_parallel(robot: Robot, link: str, said: re.Match[str]) -> bool:
    shape = _Shape(robot, link)
    apart = _between_deg(shape.hip[1], shape.knee[1])
    return [said[1], said[2]] == shape.names[-2:] and apart > 1.8 and _near(said[3], apart)


def _one_plane(robot: Robot, link: str, said: re.Match[str]) -> bool:
    shape = _Shape(robot, link)
    apart = _between_deg(shape.first[1], shape.hip[1])
    return [said[1], said[2], said[3]] == shape.names and apart < 60.0 and _near(said[4], apart)


def _not_level(robot: Robot, link: str, said: re.Match[str]) -> bool:
    shape = _Shape(robot, link)
    lean = math.degrees(math.asin(min(1.0, abs(float(shape.hip[1][2])))))
    return said[1] == shape.names[-2] and lean > 1.8 and _near(said[2], lean)


def _no_yaw(robot: Robot, link: str, said: re.Match[str]) -> bool:
    shape = _Shape(robot, link)
    axis = shape.first[1]
    lean = _between_deg(axis, np.array([0.0, 0.0, 1.0]))
    out_of_plane = 90.0 - _between_deg(axis, shape.hip[1])
    told = np.array([float(part) for part in said[2].split(", ")])
    true = said[1] == shape.names[0] and lean > 1.8 and _near(said[3], lean) and np.allclose(told, axis, atol=6e-3)
    places = {"hip": shape.hip[0], "knee": shape.knee[0], "foot": shape.foot}
    beside = {name: shape.beside_mm(place, False) for name, place in places.items()}
    most = ASIDE * shape.reach_mm()
    if said[4]:
        return true and out_of_plane > 1.8 and _near(said[4], out_of_plane)
    if said[5]:
        return true and _near(said[6], beside[said[5]]) and beside[said[5]] > 0.999 * most
    # else it says that the leg is the model's along its own axes
    return true and out_of_plane < LEAN_DEG and max(beside.values()) < 1.001 * most


def _beside(robot: Robot, link: str, said: re.Match[str]) -> bool:
    shape = _Shape(robot, link)
    place = {"hip": shape.hip[0], "knee": shape.knee[0], "foot": shape.foot}[said[1]]
    upright = abs(shape.first[1][2]) > 0.999
    beside = shape.beside_mm(place, upright)
    return said[3] == shape.names[0] and _near(said[2], beside) and beside > 0.999 * ASIDE * shape.reach_mm()


def _on_axis(robot: Robot, link: str, said: re.Match[str]) -> bool:
    shape = _Shape(robot, link)
    across = shape.hip[1]
    steps = [shape.knee[0] - shape.hip[0], shape.foot - shape.knee[0]]
    return said[1] == link and min(float(np.linalg.norm(np.cross(step, across))) for step in steps) < 1.0


def _two_hinges(robot: Robot, link: str, said: re.Match[str]) -> bool:
    return [said[1], said[2]] == _Shape(robot, link).names and said[3] == link


def _turn(robot: Robot, link: str, said: re.Match[str]) -> bool:
    limits = {joint.name: joint.limits for joint in robot.moving_up_to(link)}[said[1]]
    return limits is not None and max(map(abs, limits)) > 2 * math.pi and _near(said[2], limits[0])


BESIDE = rf"the (hip|knee|foot) stands {NUMBER} mm beside the plane through "
REASONS: dict[str, tuple[str, Judge]] = {
    "count": (r"(\d+) hinges lie between body and ([^\s:]+)(?:: (.*))?$", _count),
    "slide": (r"(.+): a slide or ball joint between body and foot$", _others),
    "mimic": (r"(.+) mimics another joint$", _mimics),
    "hip and knee": (rf"(\S+) and (\S+) do not turn in one plane: {NUMBER} deg lie between$", _not_parallel),
    "three in the plane": (rf"(\S+), (\S+) and (\S+) turn in one plane, within {NUMBER} deg$", _one_plane),
    "leaning plane": (rf"(\S+)'s axis is not level: it leans by {NUMBER} deg$", _not_level),
    "no yaw": (
        rf"(\S+) turns about \(([^)]*)\), {NUMBER} deg from the vertical axis of a yaw joint"
        rf"(?:, and {NUMBER} deg out of the leg's plane|; {BESIDE}\S+'s axis)?$",
        _no_yaw,
    ),
    "aside": (rf"{BESIDE}(\S+)'s axis$", _beside),
    "on an axis": (r"(\S+) lies on an axis$", _on_axis),
    "two hinges": (r"(\S+) and (\S+) are all hinges up to (\S+)$", _two_hinges),
    "travel": (rf"(\S+): its travel of {NUMBER} to {NUMBER} rad is more than a turn$", _turn),
}


def judged(robot: Robot, link: str, sentence: str) -> tuple[str, bool]:
    """The kind of a reason and whether it is true; no kind is never true."""
    for kind, (words, judge) in REASONS.items():
        if said := re.match(words, sentence):
            return kind, judge(robot, link, said)
    return "unknown", False
