"""A body before its payload, many times: as it is believed, and draws of all that is not known."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from brace.stance.posterior import likely_forces
from brace.stance.stance_file import Stance
from brace.stance.statics import LET_GO
from brace.stance.world import Measured, NoStanceError, Standing, World, believed, carrying, drawn

DRAWS = 100
_LOW_HIGH = (5.0, 95.0)
_SEED = 20  # the same question has the same answer


def before_payload(
    stance: Stance, measured: Measured | None, draws: int, with_payload: bool = False
) -> tuple[list[Standing], bool]:
    """What is believed first, then the draws that have an equilibrium; and whether the draws' median is the answer, for
    where forces were measured and joints have play, or a foot may have let go, no one world is likely. Raises
    NoStanceError where what is believed has no equilibrium. with_payload: the payload is a part of the weight."""
    middle = believed(stance, measured.sigma_n) if measured else believed(stance)
    middle = carrying(middle) if with_payload else middle
    standing = middle.stand(measured, measured.force_n if measured else None)
    standings = [standing, *_drawn(stance, middle, standing, measured, draws, with_payload)]
    is_median = measured is not None and any(one.world.has_play or LET_GO in one.state.contact for one in standings)
    return standings, is_median


def span(values: Iterable[np.ndarray | float]) -> tuple[np.ndarray, np.ndarray]:
    """Between which of them 90 % lie."""
    low, high = np.percentile(np.array(list(values)), _LOW_HIGH, axis=0)
    return low, high


def _drawn(
    stance: Stance, middle: World, standing: Standing, measured: Measured | None, draws: int, with_payload: bool
) -> list[Standing]:
    """What else may be."""
    chance = np.random.default_rng(_SEED)
    worlds = [drawn(stance, middle, chance) for _ in range(draws)]
    worlds = [carrying(world) for world in worlds] if with_payload else worlds
    forces_n = np.array([standing.state.force_n] * draws)
    if measured:
        worlds, forces_n = likely_forces(worlds, middle, measured, chance)
    found = []
    for world, force_n in zip(worlds, forces_n, strict=True):
        try:
            found.append(world.rest_at(force_n) if measured else world.stand(near_n=force_n))
        except NoStanceError:
            continue
    return found
