"""Lengths and travel of a leg of two or three joints out of a URDF, read with MuJoCo's parser.

Ours: x outwards, z up; theta1 of the femur from +x, theta2 of the knee, 0 for a straight leg."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from brace.ground.errors import BadFileError, UsageError
from brace.ground.files import TOML_LIMIT_BYTES, read_text

WHAT = "URDF"
PARALLEL = 0.9995
LEAST_MM = 1.0
MOST_MM = 3000.0


@dataclass(frozen=True)
class _Hinge:
    """A revolute joint with all joints at zero: place [m] and axis in the robot's frame, travel [rad] or None."""

    name: str
    place: np.ndarray
    axis: np.ndarray
    travel: tuple[float, float] | None


def read_chain(path: Path, tip: str = "") -> dict[str, object]:
    """Options of `brace new` that the file answers: femur, tibia, coxa, their travel. tip: the link whose origin is the
    foot; by default the only end of a chain of two or three hinges."""
    hinges, foot, end = _chain(path, tip)
    for hinge in hinges:
        _travel_can_be(path, hinge)
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
    out = _outwards(yaw, hip, foot, np.cross(across, up))
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
        away = hip.place - yaw[0].place
        found["coxa"] = f"{1e3 * math.hypot(away[0], away[1]):.6g}mm"
        if yaw[0].travel:
            found["coxa_travel"] = [f"{end:.6g}rad" for end in yaw[0].travel]
    for option, hinge, zero, way in (
        ("femur_travel", hip, theta1, sign[hip.name]),
        ("tibia_travel", knee, theta2, -sign[knee.name]),
    ):
        if hinge.travel:
            found[option] = [f"{end:.6g}rad" for end in sorted(zero + way * limit for limit in hinge.travel)]
    return found


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
    away = (
        hip.place - yaw[0].place if yaw and np.linalg.norm((hip.place - yaw[0].place)[:2]) > 1e-6 else foot - hip.place
    )
    return out if float(out @ away) >= 0.0 else -out


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
    text = re.sub(r"<(visual|collision)\b.*?</\1>", "", text, flags=re.DOTALL)  # shapes and their meshes play no part
    try:
        spec = mujoco.MjSpec.from_string(text)
    except (ValueError, RuntimeError) as error:
        raise _refused(
            path, "this is no URDF", str(error).splitlines()[0][:200] if str(error) else "it cannot be read"
        ) from None
    chains = {}
    for body in spec.bodies:
        if body.name != "world" and (body.name == tip if tip else not body.bodies):
            hinges, foot = _walk(mujoco, body)
            if len(hinges) in (2, 3):
                chains[body.name] = hinges, foot
    if len(chains) != 1:
        ends = ", ".join(chains) or "none"
        raise _refused(
            path,
            f"{len(chains)} chains of two or three hinges end in this robot",
            f"their ends: {ends}" if chains else "a limb has a hip and a knee, and perhaps a yaw joint before them",
            f"--urdf-tip {next(iter(chains))}" if chains else "--urdf-tip LINK names the foot's link",
        )
    end, (hinges, foot) = next(iter(chains.items()))
    return hinges, foot, end


def _walk(mujoco: object, body: object) -> tuple[list[_Hinge], np.ndarray]:
    """The hinges from the root to a body, and the body's place."""
    chain = []
    while body is not None and body.name != "world":  # type: ignore[attr-defined]
        chain.append(body)
        body = body.parent  # type: ignore[attr-defined]
    place, turn = np.zeros(3), np.eye(3)
    hinges = []
    for each in reversed(chain):
        place = place + turn @ np.asarray(each.pos)  # type: ignore[attr-defined]
        turn = turn @ _rotation(np.asarray(each.quat))  # type: ignore[attr-defined]
        for joint in each.joints:  # type: ignore[attr-defined]
            if joint.type != mujoco.mjtJoint.mjJNT_HINGE:  # type: ignore[attr-defined]
                continue
            low, high = (float(end) for end in joint.range)
            axis = turn @ np.asarray(joint.axis)
            hinges.append(
                _Hinge(
                    joint.name, place + turn @ np.asarray(joint.pos), axis / np.linalg.norm(axis),
                    (low, high) if low != high else None,
                )
            )  # fmt: skip
    return hinges, place


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
