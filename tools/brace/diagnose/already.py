"""What a named effect means where the model has it already: it is not missing, its size is another one."""

from __future__ import annotations

from brace.diagnose import plain_words as words
from brace.diagnose.diagnosis import Diagnosis, Interval, NamedEffect
from brace.diagnose.digits import number
from brace.model import LimbModel
from brace.model.keys import KEY_BY_NAME

# Every limb has these numbers. The effect's own words say that they are others than believed.
OTHER_THAN_BELIEVED = frozenset(
    (
        "joint_compliance", "joint_zero_offset", "sensor_gain",
        "link_change", "link_compliance_error", "link_length_error",
    )
)  # fmt: skip


def already(believed: LimbModel | None, effect: NamedEffect) -> dict[str, tuple[float, Interval]]:
    """By key: the size that the model has of this effect, and the one found. Empty where it has none of it."""
    if believed is None or effect.name in OTHER_THAN_BELIEVED:
        return {}
    return {
        key: (believed.number(key), held)
        for key, held in effect.parameters.items()
        if key in KEY_BY_NAME and KEY_BY_NAME[key].default == 0.0 and believed.number(key) != 0.0
    }


def only_sizes(believed: LimbModel | None, found: Diagnosis) -> bool:
    """Whether the model has every named effect already."""
    return bool(found.effects) and all(already(believed, effect) for effect in found.effects)


def sentences(believed: LimbModel | None, found: Diagnosis) -> list[str]:
    """One for each effect that the model has already."""
    if found.verdict not in ("effect", "ambiguous"):
        return []
    return [
        f"The model has {words.named(effect)} already: the record shows "
        + ", ".join(
            f"{_compared(held.value, size)} of it, {key} = {number(held.value)} and not "
            f"{words.value_with_unit(key, size)}"
            for key, (size, held) in sizes.items()
        )
        + "."
        for effect in found.effects
        if (sizes := already(believed, effect))
    ]


def _compared(found: float, believed: float) -> str:
    if found * believed < 0.0:
        return "the opposite"
    return "less" if abs(found) < abs(believed) else "more"
