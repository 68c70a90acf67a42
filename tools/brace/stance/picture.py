"""The picture of `brace stance load --picture`."""

from __future__ import annotations

from brace.plots.figure import png_bytes
from brace.plots.stance_plot import PlacedLimb, stance_figure
from brace.stance.answer import Answer
from brace.stance.text import first_slip_words
from brace.stance.world import believed


def picture(answer: Answer) -> bytes:
    """PNG: the body on its limbs, the forces, each in its cone."""
    stance = answer.stance
    limbs = []
    for i, (limb, law) in enumerate(zip(stance.limbs, believed(stance).laws, strict=True)):
        before = answer.force_n[i] - answer.change_n[i]
        pressing = float(limb.normal @ before)
        along = float(((before - pressing * limb.normal) ** 2).sum() ** 0.5)
        limbs.append(
            PlacedLimb(
                limb.name,
                law.points_mm(),
                answer.force_n[i],
                answer.pressing_n[i],
                answer.along_n[i],
                (pressing, along),
                limb.friction_ratio,
                limb.grip_n,
                answer.state[i],
            )
        )
    title = f"{stance.name}: {first_slip_words(answer.first_slip)}"
    return png_bytes(stance_figure(title, limbs, stance.com_mm, stance.payload_at_mm))
