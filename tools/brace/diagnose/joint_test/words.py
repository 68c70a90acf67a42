"""The sentences of a joint test's diagnosis, and what to measure next."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from brace.diagnose.diagnosis import NamedEffect, NextExperiment
from brace.diagnose.joint_test.shapes import (
    ASYMMETRY,
    COG_COS,
    COG_PERIOD,
    COG_SIN,
    LATER,
    LATER_TURN,
    SLIP,
    SLIP_FREE,
    SLIP_TURN,
    SOFT,
    SOFT_OVER,
    STOP,
    STOP_AT,
    TORQUE_DRIFT,
)
from brace.diagnose.plain_words import effect
from brace.identify.parameters import LAG, VISCOUS


_SHAPES = {
    "asymmetric_spring": "a spring that is stiffer on one side",
    "end_stop": "a stop on one side",
    "later_friction": "friction that turns over two angles",
    "series_slip": "free travel in series with a slider",
    "soft_middle": "a spring that is softer in its middle or under load",
    "torque_drift": "a torque reading whose zero drifts",
}


def listed(names: Sequence[str]) -> str:
    """`a, b and c`."""
    names = [_SHAPES.get(name) or effect(name) for name in names]
    return names[0] if len(names) == 1 else ", ".join(names[:-1]) + " and " + names[-1]


def shape(name: str, values: Mapping[str, float]) -> str:
    """A shape that no effect has, with its size."""
    if name == "cogging":
        size = math.hypot(values[COG_SIN], values[COG_COS])
        return (
            f"a torque that repeats every {values[COG_PERIOD]:.3g} rad of the angle, amplitude {size:.3g} N"
            " mm (as cogging or tooth errors do)"
        )
    if name == "asymmetric_spring":
        return (
            f"a spring that is {abs(values[ASYMMETRY]):.0%}"
            f" {'stiffer' if values[ASYMMETRY] > 0 else 'softer'} on one side"
        )
    if name == "viscous_friction":
        return f"viscous friction: a torque that grows with speed, {values[VISCOUS]:.3g} N mm s/rad"
    if name == "lag":
        return f"a lag: the torque is read {1e3 * values[LAG]:.3g} ms late"
    if name == "end_stop":
        side = "positive" if values[STOP] > 0.0 else "negative"
        return (
            f"a stop on the {side} side: beyond {values[STOP_AT]:.3g} rad the torque rises by another"
            f" {abs(values[STOP]):.3g} N mm/rad"
        )
    if name == "soft_middle":
        if values[SOFT] < 0.0:
            return f"a spring that softens under load, over {values[SOFT_OVER]:.3g} rad"
        return f"a spring that is softer in its middle, over {values[SOFT_OVER]:.3g} rad, and is no play"
    if name == "series_slip":
        free = 2.0 * values[SLIP_FREE] * values[SLIP_TURN]
        return f"free travel of {free:.3g} rad in series with a slider that slips at {values[SLIP]:.3g} N mm"
    if name == "later_friction":
        return f"friction of which {values[LATER]:.3g} N mm turn over {values[LATER_TURN]:.3g} rad"
    if name == "fading_friction":
        fade = next(value for key, value in values.items() if key.endswith("coulomb_load_fade_per_n_mm"))
        return (
            f"friction that grows ever less with the load: by half of its first share at {7.0 / fade:.3g} N mm"
            " (as elastic contacts do)"
        )
    if name == "torque_drift":
        return f"a torque reading whose zero moves by {values[TORQUE_DRIFT]:.3g} N mm/s"
    return name.replace("_", " ")


def withheld(labels: Sequence[str], unexplained: float) -> str:
    """Why names are not said that explain a part only."""
    names = listed([label.partition("@")[0] for label in labels])
    return f"{unexplained:.0%} of the torque is left by the nearest model, which has {names}"


def not_named(names: Sequence[str], values: Mapping[str, float]) -> str:
    """Why limb.toml has more than was named; `values` are its numbers by key."""
    numbers = "; ".join(f"{key.rpartition('.')[2]} {value:.3g}" for key, value in values.items())
    return (
        f"no model was given, so limb.toml also has {listed(names)} ({numbers}): it brings the model nearer to the"
        " record, but the record does not distinguish it from other causes, so it is not named"
    )


def as_well(could_be: Sequence[str]) -> str:
    """What the headline says of rivals."""
    sets = [listed([label.partition("@")[0] for label in one.split(" + ")]) for one in could_be]
    return f" The readings held out are predicted about as well by {', or by '.join(sets)} alone."


def sentence(
    verdict: str,
    effects: Sequence[NamedEffect],
    before: float,
    after: float,
    noise: float,
    shapes: Sequence[str],
) -> str:
    """The whole in one or two sentences, forces in N mm."""
    rest = f" What stays also shows {'; '.join(shapes)}: no effect of the catalogue." if shapes else ""
    if verdict == "effect":
        return (
            f"The joint lacks {listed([effect.name for effect in effects])}; with "
            f"{'it' if len(effects) == 1 else 'them'} the misfit falls from {before:.4g} to {after:.4g} N mm "
            f"(noise {noise:.3g} N mm)."
            + rest
        )
    if verdict == "none":
        return (
            f"Nothing is missing that this record can show: the misfit is {before:.4g} N mm, noise {noise:.3g}"
            " N mm."
        )
    return (
        f"Model and record disagree by {before:.4g} N mm (noise {noise:.3g} N mm), and no effect of the"
        " catalogue explains it."
        + rest
    )


def next_experiment(
    effects: Sequence[NamedEffect], shapes: Sequence[str], could_be: Sequence[str], minutes: float
) -> NextExperiment:
    """One step further on the same bench."""
    weakest = min((effect.confidence for effect in effects), default=0.5)
    labels = tuple(effect.label for effect in effects)
    if "cogging" in shapes:
        return NextExperiment(
            "the same ramps with the output locked half a tooth further: what repeats with the angle moves"
            " along, play, friction and hardening stay",
            ("cogging", *labels[:1]),
            0.9,
            minutes,
        )
    if "asymmetric_spring" in shapes:
        return NextExperiment(
            "the same ramps with the joint mounted the other way round: a one-sided spring changes sides, a"
            " sensor's fault stays",
            ("asymmetric_spring", *labels[:1]),
            0.9,
            minutes,
        )
    if "creep" in "".join((*labels, *could_be)) or "viscous_friction" in shapes:
        return NextExperiment(
            "hold the torque for a minute at both ends and at zero, then repeat the ramps at a quarter of the"
            " speed: creep goes on while held, friction does not",
            ("creep@creep", "coulomb_friction"),
            0.9,
            minutes + 4.0,
        )
    return NextExperiment(
        "repeat the ramps at a third and at three times the torque: play stays what it is, friction's"
        " constant and growing parts and hardening come apart",
        labels or tuple(could_be[:2]),
        max(0.5, min(0.99, weakest)),
        2.0 * minutes,
    )
