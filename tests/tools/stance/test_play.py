"""Play of a stance's joints is solved to its end: the forces are those that belong to where the joints lie."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from brace.stance import setpoints
from brace.stance.limb_law import JOINTS
from brace.stance.setpoints import Begun, largest_margin, moved, wanted_forces
from brace.stance.stance_file import Stance, load_stance
from brace.stance.statics import SLIDES, LooseError, State, Statics
from brace.stance.world import Measured, NoStanceError, Standing, World, believed, drawn

EXAMPLE = load_stance(Path(__file__).parents[3] / "examples/stance/stance.toml")
EXACT_N2 = (1e-6 * np.eye(3),) * 4


def _with_play(gap_rad: float, **known: float) -> Stance:
    values = {f"joint.{joint}.gap_rad": gap_rad for joint in JOINTS}
    values |= {f"uncertainty.{key}": value for key, value in known.items()}
    limbs = (replace(limb, friction_ratio=1.5, model=limb.model.with_values(values)) for limb in EXAMPLE.limbs)
    return replace(EXAMPLE, limbs=tuple(limbs))


def _draws(stance: Stance, count: int) -> list[tuple[World, Standing, State]]:
    """Worlds whose feet hold, how they stand, and the state under the payload."""
    chance, middle = np.random.default_rng(8), believed(stance)
    found: list[tuple[World, Standing, State]] = []
    while len(found) < count:
        world = drawn(stance, middle, chance)
        try:
            standing = world.stand()
            _, state = world.load(standing, [world.payload])
        except NoStanceError:
            continue
        if SLIDES not in standing.state.contact + state.contact:
            found.append((world, standing, state))
    return found


@pytest.mark.parametrize("gap_rad", [0.002, 0.006, 0.02])
def test_forces_are_those_of_their_own_springs(gap_rad: float) -> None:
    """One more step from the answer, with the springs and sides that it says, changes nothing."""
    settled = []
    for world, _, state in _draws(_with_play(gap_rad), 10):
        before_n = state.force_n
        world.statics_at(state).settle(state, [*world.weight, world.payload], 1)
        settled.append(float(np.abs(state.force_n - before_n).max()) < 0.05)
    assert np.mean(settled) >= 0.9  # 0.4 before joints changed their places one at a time


def test_exact_forces_before_the_payload_say_what_it_changes() -> None:
    """A sensor without noise and limbs that are known: only a joint within its play leaves a doubt."""
    stance = _with_play(0.006, compliance_rel=0.0, length_mm=0.0, angle_rad=0.003)
    middle = believed(stance, unsure_n=0.0)
    errors = []
    for _, standing, under in _draws(stance, 12):
        measured = Measured(standing.state.force_n, EXACT_N2)
        here = middle.stand(measured, measured.force_n)
        _, state = middle.load(here, [middle.payload])
        errors += list(np.abs((state.force_n - here.state.force_n) - (under.force_n - measured.force_n)).max(axis=1))
    size_n = float(np.linalg.norm(stance.payload_n))
    assert np.mean(np.array(errors) < 0.05 * size_n) > 0.85


def test_the_first_slip_lies_where_the_loaded_feet_say() -> None:
    """Followed from crossing to crossing, and found by loads one after the other."""
    for world, standing, _ in _draws(replace(_with_play(0.006), payload_n=np.array([6.0, 0.0, -3.0])), 4):
        slip = world.first_slip(standing, 20.0)
        limb, factor = slip.limb, slip.factor
        if limb < 0:
            continue
        force, at = world.payload
        statics, before = world.load(standing, [(0.97 * factor * force, at)])
        margins = [statics.margin_n(i, one) for i, one in enumerate(before.force_n)]
        assert not any(before.contact) and int(np.argmin(margins)) == limb
        assert margins[limb] < 0.06 * factor * float(np.linalg.norm(force)) + 0.05


def test_set_points_are_sought_across_the_play() -> None:
    """A law made linear where the body stands does not see a joint cross its play on the way."""
    begun = Begun(_with_play(0.006))
    chance, lacks_n = np.random.default_rng(6), []
    for _ in range(6):
        made = moved(begun, chance.uniform(-1.0, 1.0, (4, 3)), draws=0)
        found = wanted_forces(begun, made.after_n, 3.0)
        lacks_n.append(float(np.abs(found.after_n - made.after_n).max()))
    assert np.max(lacks_n) < 0.3, lacks_n


@pytest.mark.parametrize("seed", [1, 2, 5, 6, 11])
def test_set_points_that_hardly_move_change_no_force(seed: int) -> None:
    """The body stands where its feet have slid to: put down again, load by load, they would slide elsewhere, 0.5 N."""
    stance, offsets_mm = _with_play(0.006), np.random.default_rng(seed).normal(0.0, 1.0, (4, 3))
    limbs = (
        replace(limb, friction_ratio=0.8, offset_mm=offset_mm)
        for limb, offset_mm in zip(stance.limbs, offsets_mm, strict=True)
    )
    begun = Begun(replace(stance, limbs=tuple(limbs)))
    _, state = begun.under_load()
    found = wanted_forces(begun, state.force_n, 3.0)
    assert float(np.abs(found.after_n - state.force_n).max()) < 0.01


@pytest.mark.parametrize(("per_mm_n", "moves"), [(-1.0, False), (0.0, True), (1.0, True)])
def test_ways_are_judged_by_what_may_be(monkeypatch: pytest.MonkeyPatch, per_mm_n: float, moves: bool) -> None:
    """Where every drawn world says that ways take margin, none is made; where none of them tells, the believed best."""
    monkeypatch.setattr(setpoints, "_margin_after_n", lambda _, way_mm: per_mm_n * float(np.abs(way_mm).sum()))
    found = largest_margin(Begun(_with_play(0.006)), 3.0)
    assert bool(np.abs(found.way_mm).max() > 0.1) == moves


def test_a_foot_that_is_let_go_leaves_its_force_to_the_others() -> None:
    """Without play and slip the way there does not count: one step to the end has the same forces."""
    stance = _with_play(0.0)
    world = believed(replace(stance, limbs=tuple(replace(limb, grip_n=100.0) for limb in stance.limbs)))
    _, state = world.load(world.stand(), [world.payload])
    assert SLIDES not in state.contact
    faded = world.lifted(state, 1, [world.payload])
    at_once = state.copy()
    at_once.lift(1)
    world.statics_at(faded).settle(at_once, [*world.weight, world.payload], 1)
    assert SLIDES not in faded.contact and not np.any(faded.force_n[1])
    assert float(np.abs(faded.force_n - at_once.force_n).max()) < 0.01


def test_set_points_for_the_margin_make_none_smaller() -> None:
    for gap_rad in (0.002, 0.006, 0.02):
        found = largest_margin(Begun(_with_play(gap_rad)), 3.0)
        assert min(found.margin_after_n) > min(found.margin_before_n) + 0.5


def test_a_body_that_gives_way_before_a_foot_does_is_no_defect(monkeypatch: pytest.MonkeyPatch) -> None:
    """The springs of the forces that were reached may hold the body no more; `load` then says what is borne."""

    def gives_way(*_: object) -> None:
        raise LooseError("the limbs do not hold the body")

    world = believed(_with_play(0.006))
    standing = world.stand()
    monkeypatch.setattr(Statics, "first_slip", gives_way)
    assert world.first_slip(standing, 20.0).limb < 0
