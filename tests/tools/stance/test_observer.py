"""The observer: forces with honest intervals, and events that name what has happened. The truth here is a stance with
every unknown drawn; its forces come from tools/stance, so these tests judge the filter, tests/judges/stance the law."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from brace.stance.limb_law import LimbLaw
from brace.stance.observer import Event, Observer, Reading, _Change
from brace.stance.stance_file import load_stance
from brace.stance.world import (
    NoStanceError,
    World,
    believed,
    drawn,
    place_covariance_mm2,
)

STANCE = load_stance(Path(__file__).parents[3] / "examples/stance/stance.toml")
MIDDLE = believed(STANCE)
SENSOR_N = 0.3
TICK_S = 0.01


class Robot:
    """A true stance, its sensors, and an observer that sees them alone."""

    def __init__(
        self,
        seed: int,
        hidden_n: float = 0.0,
        scale_rel: float = 0.0,
        world: World | None = None,
    ) -> None:
        self.chance = np.random.default_rng(seed)
        self.world = world or _holding(self.chance)
        self.standing = self.world.stand()
        self.force_n = self.standing.state.force_n
        self.zero_n = hidden_n * self.chance.standard_normal((4, 3))
        self.scale = 1.0 + scale_rel * self.chance.standard_normal(4)
        self.hidden_n2, self.scale_rel = hidden_n**2 * np.eye(3), scale_rel
        self.unmeasured: set[int] = set()
        self.laws = MIDDLE.laws
        self.time_s = 0.0
        places = [place_covariance_mm2(limb, law) for limb, law in zip(STANCE.limbs, MIDDLE.laws, strict=True)]
        self.observer = Observer(STANCE, MIDDLE.weight, places, self.readings(), 0.0)

    def readings(self) -> list[Reading]:
        noise = SENSOR_N * self.chance.standard_normal((4, 3))
        read = self.scale[:, None] * self.force_n + self.zero_n + noise
        return [
            Reading(law.tip_mm, law.spring(force).k_n_per_mm, 0.1, None if i in self.unmeasured else one,
                    SENSOR_N**2 * np.eye(3), self.hidden_n2, self.scale_rel)
            for i, (law, force, one) in enumerate(zip(self.laws, self.force_n, read, strict=True))
        ]  # fmt: skip

    def run(self, ticks: int) -> list[Event]:
        events = []
        for _ in range(ticks):
            self.time_s += TICK_S
            events += self.observer.update(self.readings(), self.time_s)
        return events

    def under(self, factor: float) -> np.ndarray:
        """The true forces under so much of the payload."""
        _, state = self.world.load(self.standing, [(factor * STANCE.payload_n, STANCE.payload_at_mm)])
        return state.force_n

    def covered(self) -> list[bool]:
        estimate = self.observer.estimate()
        return list(np.ravel((estimate.force_low_n <= self.force_n) & (self.force_n <= estimate.force_high_n)))


def _holding(chance: np.random.Generator) -> World:
    """A draw whose feet all hold, the payload too."""
    while True:
        world = drawn(STANCE, MIDDLE, chance)
        try:
            standing = world.stand()
            _, state = world.load(standing, [world.payload])
        except NoStanceError:
            continue
        if not any(standing.state.contact) and not any(state.contact):
            return world


def test_intervals_of_measured_feet_hold_the_truth_in_nine_of_ten() -> None:
    covered = []
    for seed in range(40):
        robot = Robot(seed)
        robot.run(10)
        covered += robot.covered()
    # 480 components, those of a foot not independent: as 40 * 6 of them, two sigmas are 4 %
    assert 0.84 <= np.mean(covered) <= 0.96


def test_many_readings_say_more_than_one() -> None:
    robot = Robot(3)
    robot.run(50)
    assert robot.observer.estimate().force_sigma_n.max() < SENSOR_N / 2
    assert np.abs(robot.observer.estimate().force_n - robot.force_n).max() < SENSOR_N


def test_a_payload_that_is_hung_on_is_an_event_with_its_force() -> None:
    robot = Robot(3)
    assert robot.run(50) == []
    robot.force_n = robot.under(1.0)
    events = robot.run(30)
    assert [event.kind for event in events] == ["load"]
    estimate = robot.observer.estimate()
    off = np.abs(estimate.carried_n[:3] - STANCE.payload_n) / estimate.carried_sigma_n[:3]
    assert off.max() < 4.0


def test_a_foot_that_slips_is_named() -> None:
    robot = Robot(5)
    robot.run(50)
    offset_mm = robot.world.offset_mm.copy()
    offset_mm[2] += [2.0, 1.0, 0.0]
    robot.force_n = replace(robot.world, offset_mm=offset_mm).stand().state.force_n
    events = robot.run(40)
    assert ("moved", STANCE.limbs[2].name) in [(event.kind, event.limb) for event in events]


def test_a_set_point_that_moves_is_no_event() -> None:
    """Its force is measured before its angles come."""
    robot = Robot(4, world=MIDDLE)
    robot.run(50)
    limb = STANCE.limbs[0]
    moved = LimbLaw(
        replace(limb, theta_rad=np.array(limb.theta_rad) + [0.0, 0.0, 0.02]),
        STANCE.down,
    )
    laws, offset_mm = (moved, *MIDDLE.laws[1:]), MIDDLE.offset_mm.copy()
    offset_mm[0] += MIDDLE.laws[0].tip_mm - moved.tip_mm
    before_n = robot.force_n
    robot.force_n = replace(MIDDLE, laws=laws, offset_mm=offset_mm).stand().state.force_n
    assert np.abs(robot.force_n - before_n).max() > 10 * SENSOR_N
    assert robot.run(2) == []
    robot.laws = laws
    assert robot.run(40) == []
    assert np.abs(robot.observer.estimate().force_n - robot.force_n).max() < 3 * SENSOR_N


def test_what_a_limb_measures_after_a_change_is_where_it_is_last_and_its_mean_force() -> None:
    robot = Robot(4, world=MIDDLE)
    first, last = (replace(robot.readings()[0], tip_mm=np.full(3, x), force_n=np.full(3, x)) for x in (1.0, 3.0))
    change = _Change(-10.0, np.zeros(0), np.zeros((0, 0)), [[]])
    for reading in (first, last):
        change.take([reading], 0.0)
    (found,) = change.means()
    assert found is not None and found.force_n is not None
    assert found.tip_mm.tolist() == [3.0] * 3 and found.force_n.tolist() == [2.0] * 3


def test_a_lift_and_a_landing_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """The search for soft limbs begins again with each of them."""
    robot = Robot(4, world=MIDDLE)
    begun: list[bool] = []  # whether the foot was down
    softness, estimate = robot.observer._softness, robot.observer.estimate
    monkeypatch.setattr(softness, "disturbed", lambda: begun.append(bool(estimate().is_down[2])))
    before_n = robot.force_n = robot.under(1.0)
    robot.run(30)
    robot.standing.state.lift(2)  # `brace stance lift` says that it stands so
    robot.force_n = robot.under(1.0)
    lifted = robot.run(30)
    assert ("lifted", STANCE.limbs[2].name) in [(event.kind, event.limb) for event in lifted]
    assert not robot.observer.estimate().is_down[2]
    robot.force_n = before_n
    landed = robot.run(30)
    assert ("landed", STANCE.limbs[2].name) in [(event.kind, event.limb) for event in landed]
    assert np.abs(robot.observer.estimate().force_n - before_n).max() < 3 * SENSOR_N
    assert begun == [False, True]


def test_a_foot_without_a_sensor_is_told_by_the_others_and_k() -> None:
    errors, covered = [], []
    for seed in range(12):
        robot = Robot(seed)
        robot.run(30)
        robot.unmeasured = {1}
        robot.run(5)
        robot.force_n = robot.under(1.0)
        robot.run(40)
        estimate = robot.observer.estimate()
        errors.append(np.abs(estimate.force_n[1] - robot.force_n[1]).max())
        low, high = estimate.force_low_n[1], estimate.force_high_n[1]
        covered += list((low <= robot.force_n[1]) & (robot.force_n[1] <= high))
    assert np.median(errors) < 0.1 * float(np.linalg.norm(STANCE.payload_n)) + SENSOR_N
    assert np.mean(covered) > 0.75  # 36 components: nine of ten less three sigmas


def test_what_a_current_hides_stays_in_the_interval() -> None:
    """Friction and a torque constant's doubt do not fall with the number of readings."""
    covered = []
    for seed in range(25):
        robot = Robot(seed, hidden_n=1.0, scale_rel=0.15)
        robot.run(40)
        covered += robot.covered()
    assert 0.80 <= np.mean(covered) <= 0.98


def test_margins_have_an_interval_and_a_foot_near_its_cone_is_no_surprise() -> None:
    robot = Robot(6)
    robot.run(40)
    margin_n, sigma_n = robot.observer.margins()
    true_n = [robot.standing.statics.margin_n(i, force) for i, force in enumerate(robot.force_n)]
    assert np.all(np.abs(margin_n - true_n) < 4.0 * sigma_n + 1e-9)


@pytest.mark.parametrize("lost", [{0}, {0, 1}])
def test_fewer_sensors_widen_the_answer(lost: set[int]) -> None:
    full, fewer = Robot(7), Robot(7)
    fewer.unmeasured = lost
    full.run(40), fewer.run(40)
    wide, narrow = (robot.observer.estimate().force_sigma_n for robot in (fewer, full))
    assert all(wide[i].max() > narrow[i].max() for i in lost)


def test_a_foot_that_bears_is_on_the_ground_however_unsure_its_sensor() -> None:
    robot = Robot(4)
    robot.hidden_n2 = 4.0 * np.eye(3)  # three sigmas are more than the foot bears
    assert "lifted" not in [event.kind for event in robot.run(40)]


def test_an_interval_that_comes_after_the_first_forces_is_used() -> None:
    late, begun_with = Robot(8, hidden_n=0.2), Robot(8, hidden_n=0.2)
    late.hidden_n2 = 4.0 * np.eye(3)
    late.observer = Observer(STANCE, MIDDLE.weight, [place_covariance_mm2(limb, law) for limb, law in zip(
        STANCE.limbs, MIDDLE.laws, strict=True)], late.readings(), 0.0)  # fmt: skip
    late.run(100)
    assert late.observer.estimate().force_sigma_n.max() > 0.5
    late.hidden_n2 = begun_with.hidden_n2
    late.run(1), begun_with.run(101)
    ratio = late.observer.estimate().force_sigma_n / begun_with.observer.estimate().force_sigma_n
    assert 0.9 < ratio.min() and ratio.max() < 1.3
    late.run(100)
    assert np.mean(late.covered()) > 0.6


@pytest.mark.parametrize("first", [{0, 1}, {2, 3}, {0}])
def test_limbs_that_send_one_change_at_different_moments_are_no_foot_that_moves(first: set[int]) -> None:
    robot = Robot(3, hidden_n=0.1)
    robot.run(50)
    before, after = robot.force_n.copy(), robot.under(1.0)
    events = []
    for share in (0.3, 0.6, 0.9, 1.0):
        for earlier in (True, False):
            for i in range(4):
                if earlier == (i in first):
                    robot.force_n = robot.force_n.copy()
                    robot.force_n[i] = before[i] + share * (after[i] - before[i])
            events += robot.run(1)
    events += robot.run(50)
    assert [event.kind for event in events] == ["load"]


def test_a_grip_that_bears_nothing_for_a_while_has_not_let_go() -> None:
    gripping = replace(STANCE, limbs=tuple(replace(limb, grip_n=20.0) for limb in STANCE.limbs))
    robot = Robot(4)
    places = [place_covariance_mm2(limb, law) for limb, law in zip(STANCE.limbs, MIDDLE.laws, strict=True)]
    robot.observer = Observer(gripping, MIDDLE.weight, places, robot.readings(), 0.0)
    full = robot.force_n.copy()
    events = []
    for share in (*np.linspace(1.0, 0.0, 300), *np.zeros(50), *np.linspace(0.0, 1.0, 300)):
        robot.force_n = full + (1.0 - share) * full[2] / 3.0  # the others bear what it does not
        robot.force_n[2] = share * full[2]
        events += robot.run(1)
    assert not {"lifted", "landed"} & {event.kind for event in events}
    robot.force_n = full + full[2] / 3.0
    robot.force_n[2] = 0.0
    assert "lifted" in [event.kind for event in robot.run(40)]
