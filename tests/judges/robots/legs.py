"""One leg of a robot through `brace new --urdf` and `brace k`, as a stranger types them, and what is wrong with it."""

from __future__ import annotations

import contextlib
import csv
import io
import json
import math
import re
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from brace.cli import main
from chain import Array, Robot, about, at
from reasons import NUMBER, judged
from truth import Engine, stiffness

POSTURES = 24
JOINT_N_M_PER_RAD = {"coxa": 40.0, "femur": 50.0, "tibia": 62.5}  # their compliances have two digits
PLANE = ("--femur-link", "rigid", "--tibia-link", "rigid", "--femur-joint", "50", "--tibia-joint", "62.5",
         "--femur-play", "none", "--tibia-play", "none")  # fmt: skip
SPACE = (*PLANE, "--coxa-link", "rigid", "--coxa-joint", "40", "--coxa-play", "none")
OWN = ("--urdf-frame", "leg")
EXACT = 1e-6  # of K's norm
ROUNDED_RAD = 2.0**-22  # a step of float32 beyond 2 rad: the controller's angles are not finer
STRETCHED = 0.05  # sine of the knee below which K is near its singular posture
TOLD_OFF = rf"off by up to 2 x {NUMBER} mm / "
TOLD_LEAN = rf"off by up to 2 x {NUMBER} / sin\(theta2\) of its largest eigenvalue"


@dataclass
class Leg:
    """What became of it. space, plane, refused; error: the largest of K's norm; told: what the command says it leaves
    out, at the same posture."""

    robot: str
    end: str
    became: str
    why: str = ""
    error: float = 0.0
    told: float = 0.0
    wrong: list[str] = field(default_factory=list)
    own_frame: bool = False


def brace(*arguments: object) -> tuple[int, str, str]:
    """Exit code and streams of the command."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            code = main([str(each) for each in arguments])
        except SystemExit as stop:
            code = int(stop.code or 0)
    return code, out.getvalue(), err.getvalue()


def judge(robot: Robot, link: str, folder: Path, seed: int = 0) -> list[Leg]:
    """In space; where that is refused, every way on that a refusal names, until one is gone or all are refused."""
    waiting, tried, found = [(True, False)], set(), []
    while waiting:
        in_space, own = waiting.pop(0)
        tried.add((in_space, own))
        leg = _one(robot, link, folder, seed, (*(SPACE if in_space else PLANE), *(OWN if own else ())))
        found.append(leg)
        if leg.became == "refused":
            ways = [(in_space, True)] if OWN[0] in leg.why else []
            ways += [(False, own)] if in_space and (ways or "leave out --coxa" in leg.why) else []
            waiting += [way for way in ways if way not in tried and way not in waiting]
    if len(found) > 1 and all(leg.became == "refused" for leg in found):
        found[-1].wrong.append("no way on goes")
    return found


def _one(robot: Robot, link: str, folder: Path, seed: int, options: tuple[str, ...]) -> Leg:
    limb = folder / "limb.toml"
    limb.unlink(missing_ok=True)
    code, out, err = brace("new", "--out", limb, "--urdf", robot.path, "--urdf-tip", link, *options, "--json")
    leg = Leg(robot.path.stem, link, "refused", own_frame=OWN[0] in options)
    if code != 0:
        sentence = err.splitlines()[0].partition(f"{robot.path}: ")[2] if err else ""
        kind, true = judged(robot, link, sentence)
        leg.why = f"{kind}: {sentence}\n{err}"
        if code != 3 or not true or "  why: " not in err or "  try: " not in err:
            leg.wrong.append(f"exit {code}, {kind}, not true: {err}")
        return leg
    said = json.loads(out)
    leg.became = "space" if "[joint.coxa]" in limb.read_text() else "plane"
    _check_notes(robot, link, said, leg)
    try:
        _check_k(robot, link, limb, said, leg, np.random.default_rng(seed))
    except (KeyError, AssertionError, ValueError) as trouble:
        leg.wrong.append(f"{type(trouble).__name__}: {trouble}")
    return leg


def _check_notes(robot: Robot, link: str, said: dict[str, Any], leg: Leg) -> None:
    reasons = [note.partition("; so this is a planar limb")[0] for note in said["guesses"] if "planar limb" in note]
    if len(robot.moving_up_to(link)) == 3 and "coxa" not in said["urdf"]["angles"] and not reasons:
        leg.wrong.append("the first joint is left out without a word")
    for reason in reasons:
        leg.why, true = judged(robot, link, reason)
        leg.why += f": {reason}"
        if not true:
            leg.wrong.append(f"not true: {reason}")


def _check_k(robot: Robot, link: str, limb: Path, said: dict[str, Any], leg: Leg, draw: np.random.Generator) -> None:
    """At postures within the limits: the limb's angles by geometry, and its K by MuJoCo's Jacobian."""
    engine, joints = Engine(robot), robot.moving_up_to(link)
    x, y, z = (np.array(said["urdf"]["axes_of_robot"][name]) for name in "xyz")
    assert np.allclose(np.cross(x, y), z, atol=1e-9) and np.isclose(x @ x, 1.0), "the axes are no right-handed frame"
    text = " ".join(said["guesses"])
    aside_mm = float(match[1]) if (match := re.search(TOLD_OFF, text)) else 0.0
    lean = float(match[1]) if (match := re.search(TOLD_LEAN, text)) else 0.0
    motors = tomllib.loads(limb.read_text()).get("motor", {})
    postures: list[list[float]] = []
    truths: list[tuple[Array, float]] = []
    while len(postures) < POSTURES:
        q = {each.name: float(draw.uniform(*_limits(each.limits))) for each in joints}
        theta, axes = _angles(robot, link, q, x, y, z, "coxa" in said["urdf"]["angles"])
        if abs(math.sin(theta[2])) < STRETCHED and draw.random() < 0.99:
            continue
        _check_angles(said["urdf"]["angles"], q, theta, motors, aside_mm + lean > 0.0)
        k = _true_k(engine.jacobian(robot, link, q), axes, leg.became == "space")
        moved = 0.0  # by a step of float32 in each angle
        for each in joints:
            turned = {**q, each.name: q[each.name] + ROUNDED_RAD}
            near = _true_k(engine.jacobian(robot, link, turned), axes, leg.became == "space")
            moved += float(np.linalg.norm(near - k, 2) / np.linalg.norm(k, 2))
        postures.append(theta)
        truths.append((k, moved))
    for theta, (k, moved), ours in zip(postures, truths, _our_k(limb, postures, leg.became), strict=True):
        if leg.became == "space":
            turn = np.column_stack([x, y, z])
            ours = turn @ ours @ turn.T
        size = np.linalg.norm(k, 2)
        error = float(np.linalg.norm(ours - k, 2) / size)
        off = aside_mm / _from_axis_mm(limb, theta) + lean / max(abs(math.sin(theta[2])), 1e-9)
        told = 2.0 * off + off**2  # the second order is left unsaid
        allowed = EXACT + moved + told
        if error > leg.error:
            leg.error, leg.told = error, told
        if not error <= allowed:
            at_rad = np.round(theta, 4).tolist()
            leg.wrong.append(f"K off by {error:.2g} of its norm at {at_rad}, allowed {allowed:.2g}")


def _limits(limits: tuple[float, float] | None) -> tuple[float, float]:
    low, high = limits or (-math.pi, math.pi)
    return (low, high) if high - low < 2.0 * math.pi else (-math.pi, math.pi)


def _angles(
    robot: Robot, link: str, q: dict[str, float], x: Array, y: Array, z: Array, in_space: bool
) -> tuple[list[float], tuple[Array, Array, Array]]:
    """theta0, theta1, theta2 where the robot's parts are, and the axes of the limb's plane there."""
    hinges, foot = at(robot.joints_up_to(link), q)
    theta0 = 0.0
    if len(hinges) == 3:
        rest = at(robot.joints_up_to(link), {})[0][0][1]
        name = robot.moving_up_to(link)[0].name
        turned = about(rest, q[name])
        x, y, z = turned @ x, turned @ y, turned @ z
        theta0 = q[name] * math.copysign(1.0, rest @ z) if in_space else 0.0
    (hip, across), (knee, _) = hinges[-2:]
    assert abs(abs(across @ y) - 1.0) < 1e-3, "y is not across the leg's plane"
    thigh, shank = knee - hip, foot - knee
    theta1 = math.atan2(thigh @ z, thigh @ x)
    theta2 = theta1 - math.atan2(shank @ z, shank @ x)
    return [math.remainder(angle, 2 * math.pi) for angle in (theta0, theta1, theta2)], (x, y, z)


def _check_angles(
    told: dict[str, Any], q: dict[str, float], theta: list[float], motors: dict[str, Any], roughly: bool
) -> None:
    """The told sums are these angles, and the travel has them."""
    for angle, name in zip(theta, ("coxa", "femur", "tibia"), strict=True):
        if name not in told:
            continue
        said = told[name]["zero_rad"] + told[name]["sign"] * q[told[name]["joint"]]
        off = abs(math.remainder(said - angle, 2 * math.pi))
        assert off < (0.05 if roughly else 1e-6), f"{name}: {said} is said, {angle} is true"
        if name in motors:
            low, high = motors[name]["angle_min_rad"], motors[name]["angle_max_rad"]
            near = (low + high) / 2 + math.remainder(angle - (low + high) / 2, 2 * math.pi)
            slack = 0.05 * roughly + 2e-5  # the file has six digits
            assert low - slack <= near <= high + slack, f"{name}: {angle} outside {low}, {high}"


def _true_k(jacobian: Array, axes: tuple[Array, Array, Array], in_space: bool) -> Array:
    """K in the robot's axes, or in the plane's."""
    names = ("coxa", "femur", "tibia")
    springs = np.array([1e3 * JOINT_N_M_PER_RAD[name] for name in names])[-jacobian.shape[1] :]
    x, _, z = axes
    plane = np.vstack([x, z])
    if jacobian.shape[1] == 2:
        return stiffness(plane @ jacobian, springs)
    k = stiffness(jacobian, springs)
    return k if in_space else plane @ k @ plane.T


def _from_axis_mm(limb: Path, theta: list[float]) -> float:
    """The tip's distance from the coxa joint's axis, as the model has it."""
    lengths = tomllib.loads(limb.read_text())["geometry"]
    reach = lengths["femur_mm"] * math.cos(theta[1]) + lengths["tibia_mm"] * math.cos(theta[1] - theta[2])
    return float(max(abs(lengths.get("coxa_mm", 0.0) + reach), 1e-9))


def _our_k(limb: Path, postures: list[list[float]], became: str) -> list[Array]:
    """`brace k` of many postures, in the limb's axes."""
    names = ["theta0_rad", "theta1_rad", "theta2_rad"][0 if became == "space" else 1 :]
    given, table = limb.with_suffix(".csv"), limb.with_suffix(".k.csv")
    with given.open("w", newline="") as file:
        csv.writer(file).writerows([names, *([repr(angle) for angle in theta[-len(names) :]] for theta in postures)])
    code, _, err = brace("k", "--model", limb, "--csv", given, "--out", table)
    if code != 0:
        raise ValueError(f"brace k: {err}")
    axes = "xyz" if became == "space" else "xz"
    with table.open() as file:
        rows = list(csv.DictReader(file))
    return [
        np.array([[float(row[f"k_{''.join(sorted(one + other))}_n_per_mm"]) for one in axes] for other in axes])
        for row in rows
    ]
