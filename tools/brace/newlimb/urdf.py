"""Lengths and travel of a leg of two or three joints out of a URDF, read with MuJoCo's parser.

Ours: x outwards, z up; theta1 of the femur from +x, theta2 of the knee, 0 for a straight leg."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from brace.ground.errors import BadFileError, UsageError
from brace.ground.files import TOML_LIMIT_BYTES, read_text

WHAT = "URDF"
PARALLEL = 0.9995
LEAST_MM = 1.0
MOST_MM = 3000.0
LEVEL_M = 1e-6  # a shorter level distance is rounding, and shows no direction
ASIDE_RATIO = 0.01  # of the reach: so far aside a joint may stand; K in space is then off by about as much
NO_LIMIT_RAD = (20.0, 360.0)  # limits beyond a turn each way, up to the first or above the second, mean: none


@dataclass(frozen=True)
class _Hinge:
    """A revolute joint with all joints at zero: place [m] and axis in the robot's frame, travel [rad] or None."""

    name: str
    place: np.ndarray
    axis: np.ndarray
    travel: tuple[float, float] | None
    is_unlimited: bool = False


def read_chain(path: Path, tip: str = "", in_space: bool = False) -> tuple[dict[str, object], list[str]]:
    """Options of `brace new` that the file answers (femur, tibia, coxa, their travel), and sentences about what was
    understood. tip: the link whose origin is the foot; by default the only end of a chain of two or three hinges.
    in_space: refuse a first joint that is not the model's yaw. Otherwise such a leg is a planar limb: its other joints
    do not move the foot across the plane, so K in the plane does not depend on the first joint."""
    notes: list[str] = []
    hinges, foot, end = _chain(path, tip)
    for hinge in hinges:
        _travel_can_be(path, hinge)
        if hinge.is_unlimited:
            notes.append(f"{hinge.name}: limits beyond a whole turn each way are taken for no limits")
    *yaw, hip, knee = hinges
    if abs(float(hip.axis @ knee.axis)) < PARALLEL:
        raise _refused(
            path,
            f"{hip.name} and {knee.name} do not turn in one plane",
            "the hip's and the knee's axis must be parallel",
        )
    across, up = hip.axis, np.array([0.0, 0.0, 1.0])
    if abs(float(across @ up)) > 0.1:
        raise _refused(
            path, f"{hip.name}'s axis is not level", "the limb's plane stands upright, so its axes must lie level"
        )
    if yaw and abs(float(yaw[0].axis @ across)) > 0.1:
        raise _refused(
            path, f"{yaw[0].name}, {hip.name} and {knee.name} turn in one plane",
            "the model has two joints in the plane and a yaw joint before them",
        )  # fmt: skip
    out = _outwards(yaw, hip, foot, np.cross(across, up))
    notes.append(f"x (outwards) is the robot's ({out[0]:.3g}, {out[1]:.3g}, {out[2]:.3g}) with all joints at zero")
    left = np.cross(up, out)  # x, left, z are right-handed; theta1 grows from x to z, about -left
    sign = {hinge.name: -float(np.sign(hinge.axis @ left)) for hinge in (hip, knee)}
    thigh, shank = ((vector @ out, vector @ up) for vector in (knee.place - hip.place, foot - knee.place))
    femur_mm, tibia_mm = (1e3 * math.hypot(*vector) for vector in (thigh, shank))
    if max(femur_mm, tibia_mm) > MOST_MM:
        longest = max(femur_mm, tibia_mm) * 1e-3
        raise _refused(
            path, f"a link of {longest:.6g} m", "lengths of a URDF are in metres",
            f"{longest:.6g} mm are {longest * 1e-3:.6g} there; or give the lengths as options",
        )  # fmt: skip
    if min(femur_mm, tibia_mm) < LEAST_MM:
        raise _refused(
            path, f"{end} lies on an axis", f"femur {femur_mm:.3g} mm, tibia {tibia_mm:.3g} mm: name the foot's link"
        )
    theta1 = math.atan2(thigh[1], thigh[0])
    theta2 = math.remainder(theta1 - math.atan2(shank[1], shank[0]), 2 * math.pi)
    found: dict[str, object] = {"femur": f"{femur_mm:.6g}mm", "tibia": f"{tibia_mm:.6g}mm"}
    if yaw:
        coxa_mm = max(0.0, 1e3 * float((hip.place - yaw[0].place) @ out))
        aside_mm = [1e3 * float((place - yaw[0].place) @ left) for place in (hip.place, knee.place, foot)]
        reason = _no_yaw(yaw[0], aside_mm, ASIDE_RATIO * (coxa_mm + femur_mm + tibia_mm))
        if reason and in_space:
            raise _refused(
                path, reason, "K in space would be wrong; K in the plane is right without this joint",
                "leave out --coxa, --coxa-link, --coxa-joint, --coxa-play and --coxa-travel",
            )  # fmt: skip
        if reason:
            notes.append(f"{reason}; so this is a planar limb: K in its plane, {yaw[0].name} left out")
        else:
            found["coxa"] = f"{coxa_mm:.6g}mm"
            if yaw[0].travel:
                turned = 1.0 if yaw[0].axis[2] > 0.0 else -1.0
                found["coxa_travel"] = [f"{end:.6g}rad" for end in sorted(turned * end for end in yaw[0].travel)]
            lean_rad = math.acos(min(1.0, abs(float(yaw[0].axis[2]))))
            if max(map(abs, aside_mm)) > LEAST_MM or lean_rad > 1e-3:
                notes.append(
                    f"{yaw[0].name} leans by {math.degrees(lean_rad):.2g} deg; hip, knee and foot stand "
                    + ", ".join(f"{each:.3g}" for each in aside_mm) + " mm aside of it: K in space leaves this out"
                )  # fmt: skip
    for option, hinge, zero, way in (
        ("femur_travel", hip, theta1, sign[hip.name]),
        ("tibia_travel", knee, theta2, -sign[knee.name]),
    ):
        if hinge.travel:
            found[option] = [f"{end:.6g}rad" for end in sorted(zero + way * limit for limit in hinge.travel)]
    return found, notes


def _no_yaw(first: _Hinge, aside_mm: list[float], most_mm: float) -> str:
    """Why the first joint is not the model's yaw; nothing where it is."""
    if abs(float(first.axis[2])) < PARALLEL:
        lean = math.degrees(math.acos(min(1.0, abs(float(first.axis[2])))))
        x, y, z = first.axis
        axis = f"({x:.3g}, {y:.3g}, {z:.3g})"
        return f"{first.name} turns about {axis}, {lean:.3g} deg from the vertical axis of a yaw joint"
    for name, aside in zip(("hip", "knee", "foot"), aside_mm, strict=True):
        if abs(aside) > most_mm:
            return f"the {name} stands {abs(aside):.3g} mm beside the plane through {first.name}'s axis"
    return ""


def _travel_can_be(path: Path, hinge: _Hinge) -> None:
    """MuJoCo reads a travel that ends before it begins as none at all."""
    low, high = hinge.travel or (0.0, 0.0)
    if low > high:
        raise _refused(
            path, f"{hinge.name}: lower {low:g} is above upper {high:g}", "no angle lies between",
            "exchange the two if they are turned",
        )  # fmt: skip
    if max(abs(low), abs(high)) > 2.0 * math.pi:
        raise _refused(
            path, f"{hinge.name}: its travel of {low:g} to {high:g} rad is more than a turn",
            "angles of a URDF are in radians",
            f"in degrees they would be {math.radians(low):.4g} and {math.radians(high):.4g} there",
        )  # fmt: skip


def _outwards(yaw: list[_Hinge], hip: _Hinge, foot: np.ndarray, level: np.ndarray) -> np.ndarray:
    """The level direction that is across the hip's axis and points away from the body."""
    out: np.ndarray = level / np.linalg.norm(level)
    if out[int(np.argmax(np.abs(out)))] < 0.0:  # the robot's own direction, where nothing below decides
        out = -out
    away = (
        hip.place - yaw[0].place if yaw and abs(float(out @ (hip.place - yaw[0].place))) > LEVEL_M else foot - hip.place
    )
    return (out if float(out @ away) >= -LEVEL_M else -out) + 0.0  # no minus zero


def _chain(path: Path, tip: str) -> tuple[list[_Hinge], np.ndarray, str]:
    try:
        import mujoco
    except ImportError:
        raise UsageError(
            "reading a URDF needs MuJoCo's parser",
            where=str(path),
            why="it is not installed",
            next_step="pip install mujoco",
        ) from None
    text = read_text(path, TOML_LIMIT_BYTES, WHAT)
    try:
        robot = ElementTree.fromstring(text)
        for link in robot.iter("link"):  # shapes and their meshes play no part
            for shape in [*link.findall("visual"), *link.findall("collision")]:
                link.remove(shape)
        mimics = {str(joint.get("name")) for joint in robot.iter("joint") if joint.find("mimic") is not None}
        spec = mujoco.MjSpec.from_string(ElementTree.tostring(robot, encoding="unicode"))
    except (ElementTree.ParseError, ValueError, RuntimeError) as error:
        raise _refused(
            path, "this is no URDF", str(error).splitlines()[0][:200] if str(error) else "it cannot be read"
        ) from None
    chains = {}
    for body in spec.bodies:
        if body.name != "world" and (body.name == tip if tip else not body.bodies):
            hinges, foot, others = _walk(mujoco, body)
            if len(hinges) in (2, 3):
                chains[body.name] = hinges, foot, others
    if len(chains) != 1:
        ends = ", ".join(chains) or "none"
        raise _refused(
            path,
            f"{len(chains)} chains of two or three hinges end in this robot",
            f"their ends: {ends}" if chains else "a limb has a hip and a knee, and perhaps a yaw joint before them",
            f"--urdf-tip {next(iter(chains))}" if chains else "--urdf-tip LINK names the foot's link",
        )
    end, (hinges, foot, others) = next(iter(chains.items()))
    if others:
        raise _refused(
            path, f"{', '.join(others)}: a slide or ball joint between body and foot", "the model has hinges alone",
            "make it a fixed joint where it does not move; else the limb is not this model's",
        )  # fmt: skip
    if bound := [hinge.name for hinge in hinges if hinge.name in mimics]:
        raise _refused(
            path, f"{', '.join(bound)} mimics another joint", "the model's joints turn each for itself",
            "remove <mimic> where the joint has a drive of its own",
        )  # fmt: skip
    return hinges, foot, end


def _walk(mujoco: object, body: object) -> tuple[list[_Hinge], np.ndarray, list[str]]:
    """The hinges from the root to a body, its place, and what else moves between, but for a floating root."""
    chain = []
    while body is not None and body.name != "world":  # type: ignore[attr-defined]
        chain.append(body)
        body = body.parent  # type: ignore[attr-defined]
    place, turn = np.zeros(3), np.eye(3)
    hinges, others = [], []
    for each in reversed(chain):
        place = place + turn @ np.asarray(each.pos)  # type: ignore[attr-defined]
        turn = turn @ _rotation(np.asarray(each.quat))  # type: ignore[attr-defined]
        for joint in each.joints:  # type: ignore[attr-defined]
            if joint.type != mujoco.mjtJoint.mjJNT_HINGE:  # type: ignore[attr-defined]
                if joint.type != mujoco.mjtJoint.mjJNT_FREE:  # type: ignore[attr-defined]
                    others.append(joint.name)
                continue
            low, high = (float(end) for end in joint.range)
            axis = turn @ np.asarray(joint.axis)
            hinges.append(
                _Hinge(
                    joint.name, place + turn @ np.asarray(joint.pos), axis / np.linalg.norm(axis),
                    (low, high) if low != high and not _is_none(low, high) else None, _is_none(low, high),
                )
            )  # fmt: skip
    return hinges, place, others


def _is_none(low: float, high: float) -> bool:
    """Limits that are written where none are meant; +-90 is more likely a travel in degrees."""
    most = max(-low, high)
    return -low > 2.0 * math.pi < high and not NO_LIMIT_RAD[0] < most <= NO_LIMIT_RAD[1]


def _rotation(quaternion: np.ndarray) -> np.ndarray:
    w, x, y, z = quaternion / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _refused(path: Path, what: str, why: str, way: str = "give the lengths as options instead") -> BadFileError:
    return BadFileError(what, where=str(path), why=why, next_step=way)
