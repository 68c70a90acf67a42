"""What `brace stance lift` says: what the others bear when a foot lets go."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from brace.stance.draws import DRAWS, before_payload, span
from brace.stance.stance_file import Stance
from brace.stance.statics import SLIDES, State
from brace.stance.world import Measured, NoStanceError, Standing


@dataclass(frozen=True)
class Lifted:
    """With one foot off the ground; arrays have a row a limb, low and high hold the truth with 90 %. `reason`: why the
    body does not stand so; then the rest is empty. `stands_in`: the share of what may be in which it stands."""

    stance: Stance
    name: str
    stands_in: float
    reason: str
    force_n: np.ndarray
    force_low_n: np.ndarray
    force_high_n: np.ndarray
    change_n: np.ndarray
    change_low_n: np.ndarray
    change_high_n: np.ndarray
    margin_n: list[float]
    slides: list[str]
    moved_mm: np.ndarray

    def as_json(self) -> dict[str, object]:
        """One foot's entry."""
        stands = not self.reason
        values = ("force_n", "force_low_n", "force_high_n", "change_n", "change_low_n", "change_high_n", "margin_n")
        others = [
            {"name": limb.name, **{value: getattr(self, value)[i] for value in values}}
            for i, limb in enumerate(self.stance.limbs)
            if stands and limb.name != self.name
        ]
        return {
            "name": self.name,
            "stands": stands,
            "probability": self.stands_in,
            "reason": self.reason or None,
            "limbs": others,
            "slides": self.slides,
            "body": {"displacement_mm": self.moved_mm if stands else None},
        }


def lift(
    stance: Stance, name: str | None = None, measured: Measured | None = None, draws: int = DRAWS
) -> list[Lifted]:
    """Each foot, or the named one, taken off the ground under weight and payload, forces before the payload measured or
    not. What is believed, or the draws' median, and intervals, as in `answer`. Raises NoStanceError where the body does
    not even stand on all of them.

    Cost: 1 s on one x86 core for 100 draws, and as much for each foot."""
    standings, is_median = before_payload(stance, measured, draws)
    under_all: list[tuple[Standing, State]] = []
    for standing in standings:
        try:
            under_all.append((standing, standing.world.load(standing, [standing.world.payload])[1]))
        except NoStanceError:
            if standing is standings[0]:
                raise
    return [
        _without(stance, under_all, index, is_median)
        for index, limb in enumerate(stance.limbs)
        if name in (None, limb.name)
    ]


def _without(stance: Stance, under_all: Sequence[tuple[Standing, State]], index: int, is_median: bool) -> Lifted:
    """under_all: the body on all its feet, before the payload and under it: first as it is believed, then each draw."""
    name = stance.limbs[index].name
    found: list[tuple[State, State]] = []
    reasons: dict[int, str] = {}
    for number, (standing, before) in enumerate(under_all):
        try:
            found.append((before, standing.world.lifted(before, index, [standing.world.payload])))
        except NoStanceError as error:
            reasons[number] = error.why
    stands_in = len(found) / len(under_all)
    if (stands_in < 0.5) if is_median else (0 in reasons):
        none = np.zeros((0, 3))
        reason = reasons[min(reasons)]
        return Lifted(stance, name, stands_in, reason, none, none, none, none, none, none, [], [], np.zeros(3))
    those = found if is_median else found[:1]
    forces = np.median([after.force_n for _, after in those], axis=0)
    statics = under_all[0][0].statics
    slid = np.mean([[contact == SLIDES for contact in after.contact] for _, after in those], axis=0) > 0.5
    return Lifted(
        stance,
        name,
        stands_in,
        "",
        forces,
        *span(after.force_n for _, after in found),
        np.median([after.force_n - before.force_n for before, after in those], axis=0),
        *span(after.force_n - before.force_n for before, after in found),
        [statics.margin_n(i, force) for i, force in enumerate(forces)],
        [limb.name for limb, slides in zip(stance.limbs, slid, strict=True) if slides],
        np.median([after.displacement_mm - before.displacement_mm for before, after in those], axis=0),
    )
