"""A leg of two or three hinges out of a URDF as the model's limb: lengths, travel, frame.

Ours: x outwards, z up; theta1 of the femur from +x, theta2 of the knee, 0 for a straight leg. The coxa joint turns the
limb's plane about z. With y across the plane and the tip at (rho, aside) from the coxa joint's axis, that joint moves
the tip by (-aside, rho) in (x, y); the model has aside = 0, and its plane is then one of symmetry. K of a leg that
stands aside is S' K S with S = 1 + d y', d = aside/rho along x: off by 2 |d| of K's norm at most, and d squared."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from brace.newlimb.urdf_chain import Chain, Hinge, read_chain, refused

PARALLEL = 0.9995  # the cosine of 1.8 degrees: so far a joint may lean
IN_ONE_PLANE = 0.5  # the sine of a first axis's lean out of the limb's plane from which on it moves the foot within it
LEAST_MM = 1.0
MOST_MM = 3000.0
LEVEL_M = 1e-6  # a shorter distance is rounding, and shows no direction
LEVEL_RAD = 1e-6  # a smaller lean is rounding
SEEN_RAD = 1e-3  # a smaller lean is not worth a sentence
ASIDE_RATIO = 0.01  # of the reach: so far aside a joint may stand
NO_LIMIT_RAD = (20.0, 360.0)  # limits beyond a turn each way, up to the first or above the second, mean: none
FRAMES = ("robot", "leg")  # z of the limb: the robot's z, or the first joint's axis
NO_COXA = "leave out --coxa, --coxa-link, --coxa-joint, --coxa-play and --coxa-travel"
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Frame:
    """The limb's axes in the robot's frame, with all joints at zero: x outwards, y to the left, z up."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray


@dataclass(frozen=True)
class Angle:
    """theta = zero_rad + sign * angle of the URDF's joint."""

    joint: str
    sign: int
    zero_rad: float


@dataclass(frozen=True)
class UrdfLeg:
    """Options of `brace new` that the file answers, how it was read, and whose angles the limb's are."""

    options: dict[str, object]
    notes: list[str]
    frame: Frame
    angles: dict[str, Angle] = field(default_factory=dict)
    down: tuple[float, float] | None = None  # gravity.direction_rad and lean_rad, where down is not -z


def read_leg(
    path: Path, tip: str = "", in_space: bool = False, frame: str = "robot", said: Collection[str] = ()
) -> UrdfLeg:
    """tip: the link whose origin is the foot; by default the only end of a chain of two or three hinges. in_space:
    refuse a first joint that is not the model's yaw. Otherwise such a leg is a planar limb: its other joints do not
    move the foot across the plane, so K in the plane with the foot held across it does not depend on the first joint.
    frame: one of FRAMES. said: options given by hand, which the file need not answer."""
    chain = read_chain(path, tip)
    *first, hip, knee = chain.hinges
    _check_plane(path, first, hip, knee)
    across = hip.axis
    femur_mm, tibia_mm = (
        1e3 * float(np.linalg.norm(step - across * (across @ step)))
        for step in (knee.place - hip.place, chain.foot - knee.place)
    )
    _check_lengths(path, chain.end, femur_mm, tibia_mm)
    if not first and in_space and "coxa" not in said:
        raise refused(
            path, f"{hip.name} and {knee.name} are all hinges up to {chain.end}",
            "a limb in space has a joint before them",
            f"--coxa MM is the distance of its axis from {hip.name}, where the file leaves it out; or {NO_COXA}",
        )  # fmt: skip
    notes: list[str] = []
    axes = _axes(path, chain, frame, notes)
    if SEEN_RAD < (lean := _lean(across, knee.axis)):
        # the knee moves the tip across by lean * tibia; a way of 1 turns it by reach / (femur * tibia * sin(theta2))
        share = lean * (femur_mm + tibia_mm) / femur_mm
        notes.append(
            f"{knee.name}'s axis leans by {math.degrees(lean):.2g} deg from {hip.name}'s: K leaves this out, and is "
            f"off by up to 2 x {share:.3g} / sin(theta2) of its largest eigenvalue"
        )
    out, left, up = axes.x, axes.y, axes.z
    thigh, shank = ((vector @ out, vector @ up) for vector in (knee.place - hip.place, chain.foot - knee.place))
    theta1 = math.atan2(thigh[1], thigh[0])
    theta2 = math.remainder(theta1 - math.atan2(shank[1], shank[0]), 2 * math.pi)
    # theta1 grows from x to z, about -left, theta2 the other way
    angles = {
        "femur": Angle(hip.name, -int(np.sign(hip.axis @ left)), theta1),
        "tibia": Angle(knee.name, int(np.sign(knee.axis @ left)), theta2),
    }
    options: dict[str, object] = {"femur": f"{femur_mm:.9g}mm", "tibia": f"{tibia_mm:.9g}mm"}
    if first:
        coxa_mm, reason, way, left_out = _coxa(chain, axes, femur_mm + tibia_mm, 2.0 * lean * tibia_mm)
        if reason and in_space:
            raise refused(
                path, reason, "K in space would be wrong; K in the plane is right without this joint", way or NO_COXA
            )
        if reason:
            notes.append(
                f"{reason}; so this is a planar limb: K in its plane with the foot held across it, {first[0].name} "
                f"left out{'; for K in space: ' + way if way else ''}"
            )
        else:
            options["coxa"] = f"{coxa_mm:.9g}mm"
            angles = {"coxa": Angle(first[0].name, 1 if first[0].axis @ up > 0.0 else -1, 0.0), **angles}
            notes += left_out
    for name, hinge in zip(reversed(angles), (knee, hip, *first), strict=False):
        if f"{name}_travel" not in said:
            travel = _travel(path, f"--{name}-travel", hinge, angles[name], notes)
            if travel:
                options[f"{name}_travel"] = travel
    notes.append(
        "angles [rad] from the robot's: "
        + ", ".join(
            f"theta{number} = {_sum(angle)}"
            for number, name in enumerate(("coxa", "femur", "tibia"))
            if (angle := angles.get(name))
        )
    )
    return UrdfLeg(options, notes, axes, angles, _down(axes))


def _check_plane(path: Path, first: list[Hinge], hip: Hinge, knee: Hinge) -> None:
    """Hip and knee turn in one plane, and no third joint in it."""
    if abs(float(hip.axis @ knee.axis)) < PARALLEL:
        raise refused(
            path,
            f"{hip.name} and {knee.name} do not turn in one plane: {_degrees(hip.axis, knee.axis):.3g} deg lie between",
            "the hip's and the knee's axis must be parallel",
        )
    if first and abs(float(first[0].axis @ hip.axis)) > IN_ONE_PLANE:
        raise refused(
            path,
            f"{first[0].name}, {hip.name} and {knee.name} turn in one plane, within "
            f"{_degrees(first[0].axis, hip.axis):.3g} deg",
            "the model has two joints in the plane and a yaw joint before them",
        )  # fmt: skip


def _check_lengths(path: Path, end: str, femur_mm: float, tibia_mm: float) -> None:
    if max(femur_mm, tibia_mm) > MOST_MM:
        longest = max(femur_mm, tibia_mm) * 1e-3
        raise refused(
            path, f"a link of {longest:.6g} m", "lengths of a URDF are in metres",
            f"{longest:.6g} mm are {longest * 1e-3:.6g} there; or give the lengths as options",
        )  # fmt: skip
    if min(femur_mm, tibia_mm) < LEAST_MM:
        raise refused(
            path, f"{end} lies on an axis", f"femur {femur_mm:.3g} mm, tibia {tibia_mm:.3g} mm",
            "--urdf-tip LINK names the foot's link, or give the lengths as options instead",
        )  # fmt: skip


def _axes(path: Path, chain: Chain, frame: str, notes: list[str]) -> Frame:
    """The limb's plane is the one across the hip's axis; z in it is the robot's z, or the first joint's axis."""
    *first, hip, knee = chain.hinges
    across = hip.axis
    leaning = abs(math.asin(min(1.0, abs(float(across @ UP)))))
    if frame == "robot" and leaning > math.acos(PARALLEL):
        raise refused(
            path, f"{hip.name}'s axis is not level: it leans by {math.degrees(leaning):.3g} deg",
            "the limb's plane stands upright, so its axes must lie level",
            "--urdf-frame leg takes the leg's own plane, wherever it lies",
        )  # fmt: skip
    wanted = [UP, np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])]
    if frame == "leg" and first:
        # a hip roll's axis points forwards
        axis = first[0].axis
        forwards = axis * (1.0 if axis[2] > LEVEL_RAD or abs(axis[2]) <= LEVEL_RAD and sum(axis) > 0.0 else -1.0)
        wanted = [forwards, *wanted]
    up = next(part for each in wanted if np.linalg.norm(part := each - across * (across @ each)) > 0.1)
    up = up / np.linalg.norm(up)
    out = _outwards(first, hip, chain.foot, up, np.cross(across, up))
    axes = Frame(out, np.cross(up, out), up)
    notes.append(f"x (outwards) is the robot's {_vector(out)} with all joints at zero")
    if abs(float(up @ UP)) < math.cos(SEEN_RAD):
        notes.append(
            f"z is the robot's {_vector(up)}, {_degrees(up, UP):.3g} deg from its vertical: K, angles and forces count "
            "along x and z"
        )
    return axes


def _outwards(first: list[Hinge], hip: Hinge, foot: np.ndarray, up: np.ndarray, level: np.ndarray) -> np.ndarray:
    """The direction across the hip's axis and z that points away from the body."""
    out: np.ndarray = level / np.linalg.norm(level)
    if out[int(np.argmax(np.abs(out)))] < 0.0:  # the robot's own direction, where nothing below decides
        out = -out
    from_axis = hip.place - _foot_of(first[0], hip, up) if first else np.zeros(3)
    away = from_axis if abs(float(out @ from_axis)) > LEVEL_M else foot - hip.place
    return (out if float(out @ away) >= -LEVEL_M else -out) + 0.0  # no minus zero


def _foot_of(first: Hinge, hip: Hinge, up: np.ndarray) -> np.ndarray:
    """The point of the first joint's axis at the height of the hip."""
    climb = float(first.axis @ up)
    if abs(climb) < 0.1:
        return first.place
    point: np.ndarray = first.place + first.axis * float((hip.place - first.place) @ up) / climb
    return point


def _coxa(chain: Chain, axes: Frame, leg_mm: float, swing_mm: float) -> tuple[float, str, str, list[str]]:
    """The coxa's length; why the first joint is not the model's yaw, and the option by which it becomes one; what the
    model leaves out. swing_mm: so far a leaning knee moves the foot across the plane."""
    first, hip, knee = chain.hinges
    centre = _foot_of(first, hip, axes.z)
    coxa_mm = 1e3 * float((hip.place - centre) @ axes.x)
    coxa_mm = coxa_mm if coxa_mm > 1e3 * LEVEL_M else 0.0
    lean = _lean(first.axis, axes.z)
    if abs(float(first.axis @ axes.z)) < PARALLEL:
        out_of_plane = math.asin(min(1.0, abs(float(first.axis @ axes.y))))
        reason = (
            f"{first.name} turns about {_vector(first.axis)}, {math.degrees(lean):.3g} deg from the vertical axis of a "
            "yaw joint"
        )
        in_own = _in_own_plane(chain, axes.y, leg_mm)
        if out_of_plane > math.acos(PARALLEL):
            reason += f", and {math.degrees(out_of_plane):.3g} deg out of the leg's plane"
        elif in_own:
            reason += f"; {in_own}"
        else:
            return coxa_mm, reason, "--urdf-frame leg gives it along the leg's own axes, z along this joint's", []
        return coxa_mm, reason, "", []
    aside_mm = [1e3 * float((place - centre) @ axes.y) for place in (hip.place, knee.place, chain.foot)]
    reason = _beside(first.name, aside_mm, ASIDE_RATIO * (coxa_mm + leg_mm))
    if reason:
        return coxa_mm, reason, "", []
    left_out = []
    if max(swing_mm, *map(abs, aside_mm)) > LEAST_MM or lean > SEEN_RAD:
        reach_mm = coxa_mm + leg_mm
        off_mm = abs(aside_mm[2]) + swing_mm + 2.0 * lean * reach_mm
        left_out.append(
            f"{first.name} leans by {math.degrees(lean):.2g} deg; hip, knee and foot stand "
            + ", ".join(f"{each:.3g}" for each in aside_mm)
            + " mm aside of it"
            + (f", and the foot swings {swing_mm:.3g} mm across as the knee bends" if swing_mm > LEAST_MM else "")
            + ": K in space leaves this out, and is off by up to "
            f"2 x {off_mm:.3g} mm / (tip's distance from its axis) of its largest eigenvalue: "
            f"{200.0 * off_mm / (0.5 * reach_mm):.2g} % at half the reach"
        )
    return coxa_mm, "", "", left_out


def _in_own_plane(chain: Chain, across: np.ndarray, leg_mm: float) -> str:
    """Why the first joint's axis does not lie in the leg's plane, though it may be parallel to it."""
    first, hip, knee = chain.hinges
    aside_mm = [1e3 * float((place - first.place) @ across) for place in (hip.place, knee.place, chain.foot)]
    axis = first.axis - across * float(first.axis @ across)
    level = np.cross(axis / np.linalg.norm(axis), across)
    coxa_mm = 1e3 * abs(float((hip.place - first.place) @ level))
    return _beside(first.name, aside_mm, ASIDE_RATIO * (coxa_mm + leg_mm))


def _beside(first: str, aside_mm: list[float], most_mm: float) -> str:
    for name, aside in zip(("hip", "knee", "foot"), aside_mm, strict=True):
        if abs(aside) > most_mm:
            return f"the {name} stands {abs(aside):.3g} mm beside the plane through {first}'s axis"
    return ""


def _travel(path: Path, option: str, hinge: Hinge, angle: Angle, notes: list[str]) -> list[str] | None:
    """Limits as the model's angles; MuJoCo reads a travel that ends before it begins as none at all."""
    if hinge.limits is None:
        return None
    low, high = hinge.limits
    if _is_none(low, high):
        notes.append(f"{hinge.name}: limits beyond a whole turn each way are taken for no limits")
        return None
    if low > high:
        raise refused(
            path, f"{hinge.name}: lower {low:g} is above upper {high:g}", "no angle lies between",
            f"exchange the two if they are turned, or give {option}",
        )  # fmt: skip
    if max(abs(low), abs(high)) > 2.0 * math.pi:
        raise refused(
            path, f"{hinge.name}: its travel of {low:g} to {high:g} rad is more than a turn",
            "angles of a URDF are in radians",
            f"in degrees they would be {math.radians(low):.4g} and {math.radians(high):.4g} there; or give {option}",
        )  # fmt: skip
    ends = sorted(angle.zero_rad + angle.sign * limit for limit in (low, high))
    turns = 2.0 * math.pi * round(sum(ends) / (4.0 * math.pi))  # the same directions, about zero
    return [f"{end - turns:.9g}rad" for end in ends]


def _is_none(low: float, high: float) -> bool:
    """Limits that are written where none are meant; +-90 is more likely a travel in degrees."""
    most = max(-low, high)
    return -low > 2.0 * math.pi < high and not NO_LIMIT_RAD[0] < most <= NO_LIMIT_RAD[1]


def _down(axes: Frame) -> tuple[float, float] | None:
    """Where down is, from x, and how far it leans out of the plane to the left, with the coxa joint at zero."""
    if float(axes.z @ UP) > math.cos(SEEN_RAD):
        return None
    x, y, z = (float(-UP @ axis) for axis in (axes.x, axes.y, axes.z))
    return math.atan2(z, x), math.asin(max(-1.0, min(1.0, y)))


def _lean(one: np.ndarray, other: np.ndarray) -> float:
    return math.acos(min(1.0, abs(float(one @ other))))


def _degrees(one: np.ndarray, other: np.ndarray) -> float:
    return math.degrees(_lean(one, other))


def _vector(axis: np.ndarray) -> str:
    x, y, z = (round(float(part), 4) + 0.0 for part in axis)
    return f"({x:.3g}, {y:.3g}, {z:.3g})"


def _sum(angle: Angle) -> str:
    sign = "-" if angle.sign < 0 else ""
    if abs(angle.zero_rad) < LEVEL_RAD:
        return f"{sign}{angle.joint}"
    return f"{angle.zero_rad:.6g} {sign or '+'} {angle.joint}"
