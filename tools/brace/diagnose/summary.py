"""A diagnosis in a few lines, for the terminal."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose import plain_words as words
from brace.diagnose.diagnosis import Diagnosis, StiffnessChange
from brace.diagnose.digits import number, percent, unit
from brace.diagnose.limb_change import inspections
from brace.model import LimbModel

MOST_FAULTS = 5
SURE = 0.9  # confidence from which a name is not called one of several


def lines(found: Diagnosis, believed: LimbModel | None = None) -> Iterator[str]:
    """The sentence, then a short table. `believed` is the model that the diagnosis was given."""
    yield found.sentence
    for fault in found.data_faults[:MOST_FAULTS]:
        place = fault.field if fault.row is None else f"row {fault.row}, {fault.field}"
        hint = "" if fault.suggestion is None else f"; probably {fault.suggestion}"
        yield f"  fault      {place}: {fault.why}{hint}"
    for effect in found.effects:
        yield f"  {percent(effect.confidence):10} {effect.label}: {words.meaning(effect.name)}"
        for key, held in effect.parameters.items():
            value = words.value_with_unit(key, held.value)
            yield f"             {key} = {value}, 90 %: {words.interval(held)}"
    for members in found.indistinguishable:
        is_sure = any(one.label in members and one.confidence >= SURE for one in found.effects)
        yield f"  {'alike' if is_sure else 'one of':10} {', '.join(members)}"
    for one in found.members:
        k = one.k
        yield (
            f"  K          {one.label}, {percent(one.probability)}: "
            f"{number(k.k_xx_n_per_mm)}, {number(k.k_xz_n_per_mm)}, {number(k.k_zz_n_per_mm)} N/mm "
            f"(xx, xz, zz at {k.theta1_rad:.3f}, {k.theta2_rad:.3f} rad)"
        )
    if found.stiffness is not None and not found.members:
        yield _k_change(found.stiffness)
    if found.joint is not None:
        yield f"  joint      {'; '.join(words.joint_sizes(found.joint))}"
    named = {member for members in found.indistinguishable for member in members}
    if further := [label for label in found.could_be if label not in named]:
        yield f"  could be   {', '.join(further)}"
    for spot in found.localised[:3]:
        share = "" if spot.share is None else f" ({percent(spot.share)} of it)"
        yield f"  where      {spot.where}{share}"
    if found.gap is not None:
        gap = found.gap
        yield f"  misfit     before {words.gap_pair(gap.before, gap.unit)}"
        yield f"             after  {words.gap_pair(gap.after, gap.unit)}"
        yield f"             noise floor {number(gap.noise_floor)} {unit(gap.unit)}"
    for part in found.held_out:
        yield f"  held out   {words.held_out(part, found.gap.unit if found.gap else 'n')}"
    if found.unexplained is not None and found.unexplained.structured:
        yield f"  left       {found.unexplained.description}"
    for order in inspections(believed, found):
        yield f"  first      {order[:1].lower()}{order[1:]}"
    if found.next_experiment is not None:
        yield f"  next       {found.next_experiment.action}"
    for note in found.notes:
        yield f"  note       {note}"


def _k_change(change: StiffnessChange) -> str:
    """K of the believed and of the exported model."""
    believed, exported = (
        ", ".join(number(k) for k in (at.k_xx_n_per_mm, at.k_xz_n_per_mm, at.k_zz_n_per_mm))
        for at in (change.believed, change.exported)
    )
    at = f"{change.believed.theta1_rad:.3f}, {change.believed.theta2_rad:.3f} rad"
    return f"  K          {believed} -> {exported} N/mm (xx, xz, zz at {at}, where it changes most)"
