"""How right anybody could be: the best answer where the truth is drawn from what `brace stance load` believes.

    .venv/bin/python tests/judges/stance/ceiling.py --seed 11 --count 40
    .venv/bin/python tests/judges/stance/ceiling.py --seed 11 --count 40 --noise-alone

Geometry and payloads are the judge's, and so is what makes a case; what is hidden is drawn by brace.stance itself. No
error of its law is left then, and its draws are the posterior: the share of them that is near the best value is what an
answer can hope for. The truth beside it shows that the draws are honest. Judges nothing.
"""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from brace.stance.limb_law import JOINTS
from brace.stance.posterior import likely_forces
from brace.stance.stance_file import Stance, load_stance
from brace.stance.world import Measured, NoStanceError, Standing, World, believed, drawn
from judge import MOST, SLIPS_AT, SPARE_BEFORE
from limbs import Array
from world import SENSOR_N, Hidden, draw, write

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


def answers(standing: Standing) -> tuple[float, Array | None]:
    """The payload's factor at the first slip, and the change of each foot's force; None: the body falls."""
    world = standing.world
    slip = world.first_slip(standing, FACTOR_MOST)
    try:
        _, after = world.load(standing, [world.payload], slip.under_payload_n)
    except NoStanceError:
        return slip.factor, None
    return slip.factor, after.force_n - standing.state.force_n


def best(near: Array) -> float:
    """near[i, j]: draw j is near enough to draw i. The share that the best of them as an answer would have right."""
    return float(near.mean(axis=1).max())


def main() -> int:
    """Prints two lines."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--noise-alone", action="store_true", help="no play; compliances and zeros are known")
    options = parser.parse_args()
    chance = np.random.default_rng(options.seed)
    factor_best: list[float] = []
    change_best: list[float] = []
    factor_right: list[bool] = []
    change_right: list[bool] = []
    inside: list[bool] = []
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
        factor, change = answers(standing)
        force = standing.state.force_n
        measured = Measured(force + chance.normal(0, SENSOR_N, force.shape), (SENSOR_N**2 * np.eye(3),) * len(force))
        middle = believed(stance, SENSOR_N)
        found = []
        worlds = [drawn(stance, middle, chance) for _ in range(DRAWS)]
        for one, at in zip(*likely_forces(worlds, middle, measured, chance)):
            try:
                found.append(answers(one.rest_at(at)))
            except NoStanceError:
                continue
        factors = np.array([one for one, _ in found])
        factors = factors[np.isfinite(factors)]
        factor_best.append(best(np.abs(factors[:, None] / factors - 1) <= NEAR))
        factor_right.append(bool(abs(np.median(factors) / factor - 1) <= NEAR))
        low, high = np.percentile(factors, [5, 95])
        inside.append(bool(low <= factor <= high))
        changes = np.array([one for _, one in found if one is not None])
        if change is None or len(changes) < DRAWS / 2:
            continue
        near_n = NEAR_CHANGE * float(np.linalg.norm(stance.payload_n))
        apart = np.linalg.norm(changes[:, None] - changes, axis=3)
        change_best += [best(apart[:, :, foot] <= near_n) for foot in range(len(force))]
        change_right += (np.linalg.norm(np.median(changes, axis=0) - change, axis=1) <= near_n).tolist()
    said = [100 * float(np.mean(one)) for one in (factor_best, factor_right, inside, change_best, change_right)]
    print("{} stances. Payload at the first slip within 10 %: at best {:.0f} %, the median {:.0f} %; its 90 % interval "
          "holds in {:.0f} %.".format(len(inside), *said[:3]))
    print("Change within 5 % of the payload, {} feet: at best {:.0f} %, the median {:.0f} %.".format(
        len(change_right), *said[3:]))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
