"""How right anybody could be: the best answer where the truth is drawn from what `brace stance load` believes.

    .venv/bin/python tests/judges/stance/ceiling.py --seed 11 --count 40
    .venv/bin/python tests/judges/stance/ceiling.py --seed 11 --count 40 --noise-alone

Geometry, payloads, moved tips and lifted feet are as the judge draws them, and so is what makes a case; what is hidden
is drawn by brace.stance itself. No error of its law is left then, and its draws are the posterior: the share of them
that is near the best value is what an answer can hope for. The truth beside it shows that the draws are honest. Judges
nothing.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import baselines
import numpy as np
from brace.stance.limb_law import JOINTS
from brace.stance.posterior import likely_forces
from brace.stance.stance_file import Stance, load_stance
from brace.stance.statics import State
from brace.stance.world import Measured, NoStanceError, Standing, World, believed, drawn
from judge import MOST, MOVES_MM, SLIPS_AT, SPARE_BEFORE
from limbs import Array
from world import SENSOR_N, Hidden, draw, unit, write

DRAWS = 100
FACTOR_MOST = 1000.0
NEAR, NEAR_CHANGE = 0.1, 0.05  # of the payload's factor; of the payload
NOT_HIDDEN = {"uncertainty.compliance_rel": 0.0, "uncertainty.angle_rad": 0.0}


def truth(stance: Stance, chance: np.random.Generator) -> tuple[Stance, World, Standing] | None:
    """The stance with its payload scaled as the judge scales it, a world, and the body in it; None: no case."""
    world = drawn(stance, believed(stance), chance)
    try:
        standing = world.stand()
    except NoStanceError:
        return None
    margins = [standing.statics.margin_n(limb, force) for limb, force in enumerate(standing.state.force_n)]
    slip = world.first_slip(standing, MOST)
    if min(margins) < SPARE_BEFORE * stance.weight_n or slip.limb < 0 or not slip.factor > 0.0:
        return None
    scale = slip.factor / chance.uniform(*SLIPS_AT)
    stance = replace(stance, payload_n=scale * stance.payload_n)
    world = replace(world, payload=(stance.payload_n, stance.payload_at_mm))
    return stance, world, replace(standing, world=world)


def _without_payload(standing: Standing) -> Standing:
    world = replace(standing.world, payload=(np.zeros(3), np.zeros(3)))
    return replace(standing, world=world)


def _changed(before: Standing, after: State) -> Array:
    change: Array = after.force_n - before.state.force_n
    return change


def _by_payload(standing: Standing) -> Array:
    world = standing.world
    slip = world.first_slip(standing, FACTOR_MOST)
    _, after = world.load(standing, [world.payload], slip.under_payload_n)
    return _changed(standing, after)


def _by_move(way_mm: Array) -> Callable[[Standing], Array]:
    def change(standing: Standing) -> Array:
        bare = _without_payload(standing)
        return _changed(standing, bare.world.moved(bare, way_mm).state)

    return change


def _by_lift(foot: int) -> Callable[[Standing], Array]:
    def change(standing: Standing) -> Array:
        return _changed(standing, standing.world.lifted(standing.state, foot, []))

    return change


@dataclass
class Changes:
    """Of one kind, feet of all stances: the best answer's share, whether the median is right."""

    best: list[float] = field(default_factory=list)
    right: list[bool] = field(default_factory=list)

    def count(self, by: Callable[[Standing], Array], true: Standing, draws: list[Standing], feet: list[int]) -> None:
        """One change of one stance, in the truth and in the draws; nothing where the truth has no rest after it."""
        try:
            change = by(true)
        except NoStanceError:
            return
        changes = []
        for one in draws:
            try:
                changes.append(by(one))
            except NoStanceError:
                continue
        if len(changes) < DRAWS / 2:
            return
        found = np.array(changes)[:, feet]
        near_n = NEAR_CHANGE * float(np.linalg.norm(true.world.payload[0]))
        apart = np.linalg.norm(found[:, None] - found, axis=3)
        self.best += [best(apart[:, :, foot] <= near_n) for foot in range(len(feet))]
        self.right += (np.linalg.norm(np.median(found, axis=0) - change[feet], axis=1) <= near_n).tolist()


def best(near: Array) -> float:
    """near[i, j]: draw j is near enough to draw i. The share that the best of them as an answer would have right."""
    return float(near.mean(axis=1).max())


def _lifted(number: int, seed: int, standing: Standing) -> int | None:
    """The foot that the judge lets go: the first, in a drawn order, without which the body stands."""
    drawn_stance = draw(seed, number, Hidden(tells_play=True))
    bare = replace(drawn_stance, world=replace(drawn_stance.world, payload_n=np.zeros(3)))
    for foot in np.random.default_rng([seed, number, 2]).permutation(len(standing.state.force_n)):
        if baselines.may_stand(bare, int(foot)):
            try:
                standing.world.lifted(standing.state, int(foot), [])
                return int(foot)
            except NoStanceError:
                continue
    return None


def _posterior(stance: Stance, standing: Standing, chance: np.random.Generator) -> list[Standing]:
    """What else the same readings allow."""
    force = standing.state.force_n
    measured = Measured(force + chance.normal(0, SENSOR_N, force.shape), (SENSOR_N**2 * np.eye(3),) * len(force))
    middle = believed(stance, SENSOR_N)
    found = []
    worlds = [drawn(stance, middle, chance) for _ in range(DRAWS)]
    for world, at in zip(*likely_forces(worlds, middle, measured, chance)):
        try:
            found.append(world.rest_at(at))
        except NoStanceError:
            continue
    return found


def main() -> int:
    """Prints a line for the payload at the first slip, and one for each kind of change."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--noise-alone", action="store_true", help="no play; compliances and zeros are known")
    options = parser.parse_args()
    chance = np.random.default_rng(options.seed)
    factor_best: list[float] = []
    factor_right: list[bool] = []
    inside: list[bool] = []
    changes = {kind: Changes() for kind in ("payload", "set-point", "lift")}
    number = 0
    while len(factor_right) < options.count:
        with tempfile.TemporaryDirectory() as name:
            stance = load_stance(write(draw(options.seed, number, Hidden(tells_play=True)), Path(name)))
        number += 1
        if options.noise_alone:
            known = NOT_HIDDEN | {f"joint.{joint}.gap_rad": 0.0 for joint in JOINTS}
            limbs = [replace(limb, model=limb.model.with_values(known)) for limb in stance.limbs]
            stance = replace(stance, limbs=tuple(limbs))
        if (case := truth(stance, chance)) is None:
            continue
        stance, world, standing = case
        found = _posterior(stance, standing, chance)
        factor = world.first_slip(standing, FACTOR_MOST).factor
        factors = np.array([one.world.first_slip(one, FACTOR_MOST).factor for one in found])
        factors = factors[np.isfinite(factors)]
        factor_best.append(best(np.abs(factors[:, None] / factors - 1) <= NEAR))
        factor_right.append(bool(abs(np.median(factors) / factor - 1) <= NEAR))
        low, high = np.percentile(factors, [5, 95])
        inside.append(bool(low <= factor <= high))
        feet = list(range(len(stance.limbs)))
        changes["payload"].count(_by_payload, standing, found, feet)
        way = np.zeros((len(feet), 3))
        way[chance.integers(len(feet))] = chance.uniform(*MOVES_MM) * unit(chance.normal(size=3))
        changes["set-point"].count(_by_move(way), standing, found, feet)
        if (foot := _lifted(number - 1, options.seed, standing)) is not None:
            changes["lift"].count(_by_lift(foot), standing, found, [one for one in feet if one != foot])
    said = [100 * float(np.mean(one)) for one in (factor_best, factor_right, inside)]
    print("{} stances. Payload at the first slip within 10 %: at best {:.0f} %, the median {:.0f} %; its 90 % interval "
          "holds in {:.0f} %.".format(len(inside), *said))
    for kind, one in changes.items():
        print("Change by a {} within 5 % of the payload, {} feet: at best {:.0f} %, the median {:.0f} %.".format(
            kind, len(one.right), 100 * float(np.mean(one.best)), 100 * float(np.mean(one.right))))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
