"""Four limbs under one body: a payload hung on step by step, the foot that will slip named before it does; and one limb
lifted while the others bear. The robot's mechanics share nothing with the statics that foretell it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from brace.dataset.write import csv_text
from brace.demo.paper_table import DATA
from brace.model import LimbModel, load_limb
from brace.sim.node import LimbSetup
from brace.sim.robot import Robot, RobotTruth
from brace.sim.spec import JOINTS, Lift, Payload
from brace.stance.answer import Answer, answer
from brace.stance.lift import Lifted, lift
from brace.stance.simulated import SERVO_N_MM_PER_RAD, SimulatedStance
from brace.stance.stance_file import Limb, Stance, turn_of
from brace.stance.world import Measured, NoStanceError, Standing, believed

SEED = 11  # of what is hidden and of the sensors' noise
SENSOR_N, OFFSET_MM, ZERO_RAD, COMPLIANCE_REL = 0.3, 1.0, 0.003, 0.1  # one sigma
MOVED_MM = 0.01  # a foot that went so far has slid
STEPS = 6  # of the payload, to what the named foot is to bear
STEP_S, HANGS_S = 1.0, 0.5  # a step, and within it until the payload hangs
_CORNERS = {"front left": (1, 1), "front right": (1, -1), "rear left": (-1, 1), "rear right": (-1, -1)}
NAMES = tuple(_CORNERS)
_SPRINGS = ("joint.{}.compliance_rad_per_n_mm", "link.{}.bending_mm_per_n", "link.{}.lateral_mm_per_n")


@dataclass(frozen=True)
class Step:
    """The named foot's margin to its friction cone under a payload: foretold (None: no stance), and true."""

    factor: float
    foretold_n: float | None
    true_n: float
    slid: tuple[str, ...]


@dataclass(frozen=True)
class Slid:
    """The first foot that slid, and the payload's factor then."""

    limb: str
    factor: float


class Scene:
    """What the main computer believes, the robot as it is, and what the tips' sensors read before the payload."""

    def __init__(self) -> None:
        chance = np.random.default_rng(SEED)
        limb = _paper_limb_in_space()
        self.stance = Stance("four on a floor", tuple(_limb(name, limb, i) for i, name in enumerate(_CORNERS)), 40.0,
                             np.array([40.0, 30.0, 0.0]), np.array([0.0, 0.0, -1.0]), np.array([10.0, 4.0, -2.0]),
                             np.array([60.0, 0.0, 40.0]))  # fmt: skip
        hidden = [
            replace(one, model=_hidden(one.model, chance), offset_mm=chance.normal(0.0, OFFSET_MM, 3))
            for one in self.stance.limbs
        ]
        self._simulated = SimulatedStance(self.stance, replace(self.stance, limbs=tuple(hidden)))
        with self.robot() as robot:
            read = _forces_n(robot.robot_truth()) + chance.normal(0.0, SENSOR_N, (len(hidden), 3))
        self.measured = Measured(read, (SENSOR_N**2 * np.eye(3),) * len(hidden))

    @property
    def hidden(self) -> Stance:
        """The robot as it is."""
        return self._simulated.true

    def robot(self) -> Robot:
        """A new one, put down."""
        drive = {"servo_n_mm_per_rad": SERVO_N_MM_PER_RAD}
        setups = [
            LimbSetup(one.believed, one.plant, {"controller.node_id": one.node}, theta_rad=one.theta_rad, drive=drive)
            for one in self._simulated.limbs
        ]
        return Robot(self._simulated.body, setups)

    @cached_property
    def foretold(self) -> Answer:
        """Of the payload at the factor 1, and which foot slides first."""
        return answer(self.stance, self.measured)

    @cached_property
    def _standing(self) -> Standing:
        return believed(self.stance).stand(self.measured, self.measured.force_n)

    def hang_on(self) -> tuple[list[Step], Slid | None]:
        """The payload step by step, past what the named foot is said to bear."""
        first = self.foretold.first_slip
        assert first.limb is not None and first.payload_factor is not None
        watched = list(_CORNERS).index(first.limb)
        factors = first.payload_factor * np.arange(1, STEPS + 3) / STEPS
        steps: list[Step] = []
        slid: Slid | None = None
        with self.robot() as robot:
            began = _places_mm(robot.robot_truth())
            for number, factor in enumerate(factors.tolist()):
                robot.set_payload(number * STEP_S, factor, HANGS_S)
                robot.step(STEP_S)
                for truth in robot.log():
                    gone = _moved(truth, began)
                    slid = slid or (Slid(gone[0], truth["payload_factor"]) if gone else None)
                truth = robot.robot_truth()
                true_n = self._margin_n(watched, truth)
                steps.append(Step(factor, self._foretold_margin_n(watched, factor), true_n, _moved(truth, began)))
        return steps, slid

    def _foretold_margin_n(self, watched: int, factor: float) -> float | None:
        world, (force, at) = self._standing.world, self._standing.world.payload
        try:
            statics, state = world.load(self._standing, [(factor * force, at)])
        except NoStanceError:
            return None
        return statics.margin_n(watched, state.force_n[watched])

    def _margin_n(self, limb: int, truth: RobotTruth) -> float:
        foot = self._simulated.true.limbs[limb]
        force_n = Rotation.from_rotvec(truth["rotation_rad"]).apply(truth["limbs"][limb]["force_n"])  # in the world
        pressing = float(foot.normal @ force_n)
        return float(foot.friction_ratio * pressing - np.linalg.norm(force_n - pressing * foot.normal))

    def lift_one(self) -> tuple[Lifted, np.ndarray, np.ndarray]:
        """The foot that the others spare best, off the ground without a payload: foretold, the true forces before and
        then, a row a limb."""
        stance = replace(self.stance, payload_n=np.zeros(3))
        foretold = max(
            (one for one in lift(stance, measured=self.measured) if not one.reason),
            key=lambda one: min(m for limb, m in zip(stance.limbs, one.margin_n, strict=True) if limb.name != one.name),
        )
        with self.robot() as robot:
            before = _forces_n(robot.robot_truth())
            self._simulated.happen(robot, [Payload(0.0, 0.0, 0.0)], [], [Lift(foretold.name, 0.1, np.inf)])
            robot.step(1.5)
            return foretold, before, _forces_n(robot.robot_truth())


def table(steps: list[Step]) -> str:
    """A row a step."""
    none = float("nan")
    foretold = np.array([none if step.foretold_n is None else step.foretold_n for step in steps])
    return csv_text({
        "payload_factor": np.array([step.factor for step in steps]), "margin_foretold_n": foretold,
        "margin_true_n": np.array([step.true_n for step in steps]),
        "feet_slipped": np.array([len(step.slid) for step in steps]),
    }, {})  # fmt: skip


def _paper_limb_in_space() -> LimbModel:
    """The paper's limb with a coxa joint like its others, links that bend across its plane as in it, and weights."""
    limb = load_limb(DATA / "paper-limb.toml")
    lateral = {f"link.{link}.lateral_mm_per_n": limb.number(f"link.{link}.bending_mm_per_n") for link in JOINTS[1:]}
    known = {"uncertainty.angle_rad": ZERO_RAD, "uncertainty.compliance_rel": COMPLIANCE_REL,
             "uncertainty.length_mm": 0.2}  # fmt: skip
    weights = {"gravity.femur_n": 1.0, "gravity.knee_n": 1.5, "gravity.tibia_n": 0.8}
    coxa = {"joint.coxa.compliance_rad_per_n_mm": limb.number("joint.femur.compliance_rad_per_n_mm")}
    return limb.with_values({**lateral, **known, **weights, **coxa})


def _limb(name: str, model: LimbModel, index: int) -> Limb:
    x, y = _CORNERS[name]
    return Limb(name, model, np.array([120.0 * x, 90.0 * y, 0.0]), turn_of(0.0, 0.0, float(np.arctan2(y, x))),
                np.array([0.0, 0.6, 1.9]), np.array([0.0, 0.0, 1.0]), 0.8, 0.0, 0.0, OFFSET_MM, np.zeros(3),
                index + 1)  # fmt: skip


def _hidden(model: LimbModel, chance: np.random.Generator) -> LimbModel:
    """A limb as it is."""
    keys = [spring.format(part) for part in JOINTS for spring in _SPRINGS]
    springs = {key: model.number(key) * float(np.exp(chance.normal(0.0, COMPLIANCE_REL))) for key in keys}
    zeros = {f"joint.{joint}.zero_offset_rad": float(chance.normal(0.0, ZERO_RAD)) for joint in JOINTS}
    return model.with_values({**{key: value for key, value in springs.items() if value > 0.0}, **zeros})


def _forces_n(truth: RobotTruth) -> np.ndarray:
    return np.array([limb["force_n"] for limb in truth["limbs"]])


def _places_mm(truth: RobotTruth) -> np.ndarray:
    return np.array([limb["foot_mm"] for limb in truth["limbs"]])


def _moved(truth: RobotTruth, began_mm: np.ndarray) -> tuple[str, ...]:
    ways = np.linalg.norm(_places_mm(truth) - began_mm, axis=1)
    return tuple(limb["name"] for limb, way in zip(truth["limbs"], ways, strict=True) if way > MOVED_MM)
