"""One knee of the robot goes soft: the forces' changes name the limb, a loading test of that limb is diagnosed, and
with the mended model forces are foretold again. The robot's mechanics share nothing with what is believed of it."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from brace.demo.four_limbs import SENSOR_N, Scene
from brace.demo.wire_loop import run, shown
from brace.model import load_limb
from brace.sim.robot import Robot
from brace.sim.spec import FAULTS, JOINTS, Fault
from brace.stance.limb_law import LimbLaw
from brace.stance.observer import Observer, Reading
from brace.stance.softness import Soft
from brace.stance.stance_file import Stance
from brace.stance.world import Measured, believed, place_covariance_mm2

LIMB, JOINT, RATIO = 0, "tibia", 0.4  # the front left knee keeps so much of its stiffness
PAYLOAD = 1.5
SEED = 12  # of the sensors' noise
MOVES_RAD = (-0.04, 0.04, -0.04, 0.04)  # of that limb's knee, and back
TICK_S, LASTS_S = 0.04, 2.0
_NAME = "front-left"
_RIG = """# A short loading test of one limb.
format = 1
seed = 1
[rig]
step_mm = 0.635
steps = 3
repeats = 1
axes = ["x", "z"]
dwell_s = 4.0
pause_s = 20.0
zeroed = "never"
[sensor]
noise_n = 0.1
resolution_n = 0.0625
range_n = 145.0
[[configuration]]
r_mm = 176.0
phi_rad = -0.7738
[[configuration]]
r_mm = 236.0
phi_rad = -0.5482
[[configuration]]
r_mm = 330.0
phi_rad = -0.3800
[[configuration]]
r_mm = 400.0
phi_rad = -0.3100
"""


@dataclass(frozen=True)
class Mended:
    """named: the limb's name, what the forces said of it and when; None: it was not named. off_n: how far the foretold
    changes of force under a payload are from the true ones, root of the mean square over all components, believed and
    mended."""

    named: tuple[str, Soft, float] | None
    off_before_n: float
    off_after_n: float


def play(scene: Scene, folder: Path) -> Generator[str, None, Mended]:
    """Writes models, record and diagnosis of the limb into `folder`; yields what a person reads."""
    limb = scene.stance.limbs[LIMB]
    yield f"   {limb.name}: its {JOINT} joint is left with {RATIO:g} of its stiffness; K is still the model's"
    named = _watch(scene)
    if named is None:
        yield "   no limb was named"
    else:
        name, soft, at_s = named
        what = "the limb" if soft.joint is None else f"its {soft.joint} joint"
        yield (
            f"   after {at_s:.1f} s the forces' changes say: {name} is soft, {what} has {soft.ratio:.2f} of its "
            f"stiffness ({soft.low:.2f} to {soft.high:.2f})"
        )
    true = scene.hidden.limbs[LIMB].model
    key = f"joint.{JOINT}.compliance_rad_per_n_mm"
    softened = true.with_values({key: true.number(key) / RATIO})
    (folder / f"{_NAME}.toml").write_text(limb.model.to_toml(["what is believed of the limb"]))
    (folder / f"{_NAME}-true.toml").write_text(softened.to_toml(["what is true"]))
    (folder / "rig.toml").write_text(_RIG)
    simulate = ("simulate", "--model", f"{_NAME}-true.toml", "--rig", "rig.toml", "--out", "record")
    diagnose = ("diagnose", "record", "--model", f"{_NAME}.toml", "--out", "diagnosis")
    yield shown(simulate)
    run(folder, simulate)
    yield shown(diagnose)
    yield from ("     " + line for line in run(folder, diagnose).splitlines()[:3])
    mended = replace(limb, model=load_limb(folder / "diagnosis" / "limb.toml"))
    limbs = (*scene.stance.limbs[:LIMB], mended, *scene.stance.limbs[LIMB + 1 :])
    before, change = _true_change(scene)
    off = [_off_n(stance, before, change) for stance in (scene.stance, replace(scene.stance, limbs=limbs))]
    yield (
        f"   {PAYLOAD:g} times the payload hung on: foretold changes of the feet's forces are off by {off[0]:.2f} N "
        f"with the old model, by {off[1]:.2f} N with the mended one (root mean square)"
    )
    return Mended(named, *off)


def _soften(robot: Robot) -> None:
    kind = tuple(FAULTS).index("joint_soft")
    robot.add_fault(Fault(kind, LIMB, JOINTS.index(JOINT), RATIO, 0.0, np.inf))


def _watch(scene: Scene) -> tuple[str, Soft, float] | None:
    """The payload comes, then the limb's own set-points go to and fro; the observer sees the forces."""
    stance, chance = scene.stance, np.random.default_rng(SEED)
    middle = believed(stance)
    laws = list(middle.laws)
    theta = np.array(stance.limbs[LIMB].theta_rad)
    places = [place_covariance_mm2(limb, law) for limb, law in zip(stance.limbs, laws, strict=True)]
    observer: Observer | None = None
    with scene.robot() as robot:
        _soften(robot)
        robot.set_payload(0.0, 0.0, 0.0)
        robot.set_payload(LASTS_S, PAYLOAD, 0.3)
        per_move = round(LASTS_S / TICK_S)
        for tick in range((2 + len(MOVES_RAD)) * per_move):
            forces = [np.array(limb["force_n"]) for limb in robot.robot_truth()["limbs"]]
            readings = [_reading(law, force, chance) for law, force in zip(laws, forces, strict=True)]
            if observer is None:
                observer = Observer(stance, middle.weight, places, readings, 0.0)
            for event in observer.update(readings, tick * TICK_S):
                if event.soft is not None and event.limb is not None:
                    return event.limb, event.soft, event.time_s
            move, within = divmod(tick, per_move)
            if within == 0 and move >= 2:
                theta = theta + [0.0, 0.0, MOVES_RAD[move - 2]]
                robot.set_points(LIMB, tick * TICK_S, theta.tolist())
                laws[LIMB] = LimbLaw(replace(stance.limbs[LIMB], theta_rad=theta), stance.down)
            robot.step(TICK_S)
    return None


def _reading(law: LimbLaw, force_n: np.ndarray, chance: np.random.Generator) -> Reading:
    read, noise, nothing = force_n + chance.normal(0.0, SENSOR_N, 3), SENSOR_N**2 * np.eye(3), np.zeros((3, 3))
    k = law.spring(force_n).k_n_per_mm
    return Reading(law.tip_mm, k, 0.1, read, noise, nothing, turns_mm_per_rad=law.turns_in_body())


def _true_change(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """The soft robot's forces without a payload, and what the payload adds."""
    with scene.robot() as robot:
        _soften(robot)
        robot.set_payload(0.0, 0.0, 0.0)
        robot.set_payload(1.0, PAYLOAD, 0.3)
        forces = []
        for _ in range(2):
            robot.step(0.9)
            forces.append(np.array([limb["force_n"] for limb in robot.robot_truth()["limbs"]]))
        return forces[0], forces[1] - forces[0]


def _off_n(stance: Stance, before_n: np.ndarray, change_n: np.ndarray) -> float:
    world = believed(stance)
    standing = world.stand(Measured(before_n, (SENSOR_N**2 * np.eye(3),) * len(before_n)), before_n)
    force, at = world.payload
    _, state = world.load(standing, [(PAYLOAD * force, at)])
    return float(np.sqrt(np.mean((state.force_n - standing.state.force_n - change_n) ** 2)))
