"""What a page has to know of a limb besides what its controller sends: lengths, and how far K is trusted."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from brace.ground.errors import BraceError
from brace.model import LimbModel
from brace.stiffness.at_rest import PlanarLimb, planar_limb

# After this turn K's relative uncertainty is computed anew. Until then it changes by less than a tenth of itself, near
# the straight and the folded limb by up to a sixth.
MOVED_RAD = 0.01
JOINTS = ("coxa", "femur", "tibia")
LENGTHS = ("geometry.coxa_mm", "geometry.femur_mm", "geometry.tibia_mm")

Sigmas = tuple[float, float]


@dataclass(eq=False)  # two cards are never equal, so that a card can be the key of the words that are kept for it
class Card:
    """Of one limb. `lengths_mm` are coxa, femur, tibia; None: nobody has given them."""

    lengths_mm: tuple[float, float, float] | None = None
    name: str = ""
    why_not: str = ""  # why the lengths are not known
    tight_joints: frozenset[str] = frozenset()  # those without backlash
    _limb: PlanarLimb | None = None
    _at_rad: tuple[float, float] = (math.inf, math.inf)
    _relative: Sigmas | None = field(default=None)

    def relative_sigmas(self, theta1_rad: float, theta2_rad: float) -> Sigmas | None:
        """One sigma of lambda_min and of lambda_max, each as a fraction of it, from the limb's [uncertainty]. None: not
        known. Worked out anew where the limb has moved."""
        if self._limb is None:
            return None
        if math.dist(self._at_rad, (theta1_rad, theta2_rad)) > MOVED_RAD:
            self._at_rad = (theta1_rad, theta2_rad)
            self._relative = self._limb.relative_sigmas(theta1_rad, theta2_rad)
        return self._relative


def card_of(model: LimbModel) -> Card:
    """From a limb model, be it a file's or a controller's, which has no name."""
    coxa_mm, femur_mm, tibia_mm = (model.number(key) for key in LENGTHS)
    tight = frozenset(joint for joint in JOINTS if model.number(f"joint.{joint}.gap_rad") == 0.0)
    name = model.name if model.document else ""
    return Card((coxa_mm, femur_mm, tibia_mm), name, tight_joints=tight, _limb=planar_limb(model))


def card_from(ask: Callable[[], LimbModel]) -> Card:
    """From whoever can be asked for the model; without an answer the card says why it is empty."""
    try:
        return card_of(ask())
    except BraceError as error:
        return Card(why_not=str(error))
