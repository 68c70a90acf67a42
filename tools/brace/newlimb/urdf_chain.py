"""The joints between a robot's body and one of its links, out of a URDF, read with MuJoCo's parser."""

from __future__ import annotations

import difflib
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from brace.ground.errors import BadFileError, UsageError
from brace.ground.files import TOML_LIMIT_BYTES, read_text

WHAT = "URDF"
_COMMENT = re.compile("<!--.*?-->", re.DOTALL)
GIVE_LENGTHS = "give the lengths as options instead"


@dataclass(frozen=True)
class Hinge:
    """A revolute joint with all joints at zero: place [m] and unit axis in the robot's frame, limits [rad] or None."""

    name: str
    place: np.ndarray
    axis: np.ndarray
    limits: tuple[float, float] | None


@dataclass(frozen=True)
class Chain:
    """Two or three hinges from body to foot, and the place of the foot [m] in the robot's frame."""

    hinges: list[Hinge]
    foot: np.ndarray
    end: str


@dataclass(frozen=True)
class _Walked:
    hinges: list[Hinge]
    foot: np.ndarray
    others: list[str]  # slides and ball joints


def refused(path: Path, what: str, why: str, way: str = GIVE_LENGTHS) -> BadFileError:
    """A URDF whose leg is not the model's."""
    return BadFileError(what, where=str(path), why=why, next_step=way)


def read_chain(path: Path, tip: str) -> Chain:
    """The chain that ends at the link `tip`; with no tip named, the only end that has two or three hinges."""
    spec, mimics = _parsed(path)
    import mujoco

    bodies = [body for body in spec.bodies if body.name != "world"]  # type: ignore[attr-defined]
    if tip:
        named = [body for body in bodies if body.name == tip]
        if not named:
            raise _no_such_link(path, tip, [body.name for body in bodies])
        chains = {tip: _walk(mujoco, named[0])}
    else:
        ends = {body.name: _walk(mujoco, body) for body in bodies if not body.bodies}
        chains = {end: walked for end, walked in ends.items() if len(walked.hinges) in (2, 3)}
        if len(chains) != 1:
            raise _not_one(path, ends, chains)
    end, walked = next(iter(chains.items()))
    if walked.others:
        raise refused(
            path, f"{', '.join(walked.others)}: a slide or ball joint between body and foot",
            "the model has hinges alone",
            "make it a fixed joint where it does not move; else the limb is not this model's",
        )  # fmt: skip
    if len(walked.hinges) not in (2, 3):
        names = [hinge.name for hinge in walked.hinges]
        raise refused(
            path, f"{len(names)} hinges lie between body and {end}{': ' if names else ''}{', '.join(names)}",
            "a limb has a hip and a knee, and perhaps a yaw joint before them",
            "make those fixed joints that a brake or the task holds still; else the limb is not this model's"
            if len(names) > 3 else "--urdf-tip LINK names the foot's link, or " + GIVE_LENGTHS,
        )  # fmt: skip
    if bound := [hinge.name for hinge in walked.hinges if hinge.name in mimics]:
        raise refused(
            path, f"{', '.join(bound)} mimics another joint", "the model's joints turn each for itself",
            "remove <mimic> where the joint has a drive of its own",
        )  # fmt: skip
    return Chain(walked.hinges, walked.foot, end)


def _parsed(path: Path) -> tuple[object, set[str]]:
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
    live = _COMMENT.sub("", text)  # a URDF that xacro has made may keep its macros' words in comments
    if "<xacro:" in live or "${" in live:
        raise refused(
            path, "this is a xacro file, from which a URDF is made", "it has xacro's macros or ${...}",
            f"xacro {path.name} > robot.urdf, and give robot.urdf",
        )  # fmt: skip
    try:
        robot = ElementTree.fromstring(text)
        for link in robot.iter("link"):  # shapes and their meshes play no part
            for shape in [*link.findall("visual"), *link.findall("collision")]:
                link.remove(shape)
        mimics = {str(joint.get("name")) for joint in robot.iter("joint") if joint.find("mimic") is not None}
        mujoco.set_mju_user_warning(lambda _: None)  # else it leaves a MUJOCO_LOG.TXT where the user stands
        return mujoco.MjSpec.from_string(ElementTree.tostring(robot, encoding="unicode")), mimics
    except (ElementTree.ParseError, ValueError, RuntimeError) as error:
        raise refused(
            path, "this is no URDF", str(error).splitlines()[0][:200] if str(error) else "it cannot be read"
        ) from None
    finally:
        mujoco.set_mju_user_warning(None)


def _no_such_link(path: Path, tip: str, names: list[str]) -> BadFileError:
    near = difflib.get_close_matches(tip, names, 1)
    return refused(
        path, f"no link {tip!r} hangs on this robot's body", f"its links: {', '.join(names) or 'none'}"[:400],
        f"--urdf-tip {near[0] if near else 'LINK'}",
    )  # fmt: skip


def _not_one(path: Path, ends: dict[str, _Walked], chains: dict[str, _Walked]) -> BadFileError:
    if chains:
        why, way = f"their ends: {', '.join(chains)}", "--urdf-tip LINK names the foot's link, one of these"
    else:
        counted = ", ".join(f"{end} {len(walked.hinges)}" for end, walked in ends.items()) or "none"
        why = f"a limb has a hip and a knee, and perhaps a yaw joint before them; hinges up to each end: {counted}"
        why = why[:400]
        way = "--urdf-tip LINK names the foot's link, or " + GIVE_LENGTHS
    return refused(path, f"{len(chains)} chains of two or three hinges end in this robot", why, way)


def _walk(mujoco: object, body: object) -> _Walked:
    """What moves between the root and a body, but for a floating root."""
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
                Hinge(
                    joint.name, place + turn @ np.asarray(joint.pos), axis / np.linalg.norm(axis),
                    (low, high) if low != high else None,
                )
            )  # fmt: skip
    return _Walked(hinges, place, others)


def _rotation(quaternion: np.ndarray) -> np.ndarray:
    w, x, y, z = quaternion / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
