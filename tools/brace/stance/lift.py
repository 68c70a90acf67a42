"""What `brace stance lift` says: what the others bear when a foot lets go."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from brace.stance.stance_file import Stance
from brace.stance.statics import SLIDES, State
from brace.stance.world import Measured, NoStanceError, Standing, World, believed


@dataclass(frozen=True)
class Lifted:
    """With one foot off the ground. `reason`: why the body does not stand so; then the rest is empty."""

    stance: Stance
    name: str
    reason: str
    force_n: np.ndarray
    change_n: np.ndarray
    margin_n: list[float]
    slides: list[str]
    moved_mm: np.ndarray

    def as_json(self) -> dict[str, object]:
        """One foot's entry."""
        stands = not self.reason
        others = [
            {"name": limb.name, "force_n": self.force_n[i], "change_n": self.change_n[i], "margin_n": self.margin_n[i]}
            for i, limb in enumerate(self.stance.limbs)
            if stands and limb.name != self.name
        ]
        return {
            "name": self.name,
            "stands": stands,
            "reason": self.reason or None,
            "limbs": others,
            "slides": self.slides,
            "body": {"displacement_mm": self.moved_mm if stands else None},
        }


def lift(stance: Stance, name: str | None = None, measured: Measured | None = None) -> list[Lifted]:
    """Each foot, or the named one, taken off the ground under weight and payload, forces before the payload measured or
    not. Raises NoStanceError where the body does not even stand on all of them."""
    world = believed(stance)
    standing = world.stand(measured)
    _, under_all = world.load(standing, [world.payload])
    return [
        _without(stance, world, standing, index, under_all)
        for index, limb in enumerate(stance.limbs)
        if name in (None, limb.name)
    ]


def _without(stance: Stance, world: World, standing: Standing, index: int, before: State) -> Lifted:
    lifted = Standing(world, standing.statics, standing.state.copy())
    lifted.state.lift(index)
    name = stance.limbs[index].name
    try:
        statics, state = world.load(lifted, [world.payload])
    except NoStanceError as error:
        return Lifted(stance, name, error.why, np.zeros((0, 3)), np.zeros((0, 3)), [], [], np.zeros(3))
    forces = state.force_n
    return Lifted(
        stance,
        name,
        "",
        forces,
        forces - before.force_n,
        [statics.margin_n(i, force) for i, force in enumerate(forces)],
        [limb.name for limb, contact in zip(stance.limbs, state.contact, strict=True) if contact == SLIDES],
        state.displacement_mm - before.displacement_mm,
    )
