"""Where nothing is missing: did the refit move the limb's stiffness, or does the force sensor read too much?

Both scale every force, and a calibration that trusts compliances to some per cent lets the refit follow a sensor that
is off by many sigma of its own trust, without an effect that could be named. K would be wrong by the sensor's error.
A gain that is left open takes strain from the compliances. Where it takes more than in 95 of 100 sound calibrations, and
no other single effect is likelier, limb.toml keeps its scale: its numbers are refitted with the gain left open, and the
gain is not exported. Where another is likelier, as a link that is softer than its trust allows, the gain would only
stand in for it, and K would move away from the limb."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from brace.diagnose.digits import percent
from brace.diagnose.loading.fit import Fit, fit
from brace.diagnose.loading.limb_of import limb_of
from brace.diagnose.stiffness_change import apart, k_at, postures
from brace.identify.record import Record
from brace.model import LimbModel

if TYPE_CHECKING:
    from brace.diagnose.loading.search_pass import Pass

GAIN = "sensor.gain"
STRAIN = 4.0  # of cost that a free gain saves: two sigma


def gain_instead(final: Pass) -> Fit | None:
    """The refit with the gain left open, where nothing is named, it takes so much strain, and no other single effect
    is likelier; else None."""
    if final.decision.verdict != "none":
        return None
    singles = [one for one in final.sets if len(one.labels) == 1]
    likeliest = max(singles, key=lambda one: one.posterior).best.fit if singles else None
    if likeliest is None or not _is_gain(likeliest):
        return None
    freed = fit(final.record, likeliest.space, likeliest.x)
    return freed if final.base.fit.cost - freed.cost > STRAIN else None


def _is_gain(fitted: Fit) -> bool:
    space = fitted.space
    return space.keys[space.size - space.own :] == (GAIN,)


def with_its_scale(believed: LimbModel, freed: Fit) -> LimbModel:
    """What is exported: the refitted limb, the sensor as believed."""
    return limb_of(believed, freed.model).with_values({GAIN: believed.number(GAIN)})


def in_words(record: Record, believed: LimbModel, followed: LimbModel, kept: LimbModel, freed: Fit) -> str:
    """The two explanations, which one K follows, and what shows the right one. `followed`: the limb if the sensor reads
    right; `kept`: if it does not."""
    at_rad = postures(record.dataset)
    off = float(np.median(apart(k_at(followed, at_rad), k_at(kept, at_rad))))
    ratio = freed.value(GAIN) / believed.number(GAIN)
    more, stiffer = ("much", "stiffer") if ratio > 1.0 else ("little", "softer")
    return (
        f"A force sensor that reads {percent(abs(ratio - 1.0))} too {more} explains this record at least as well as a "
        f"limb that is {percent(off)} {stiffer} than limb.toml has it, so K keeps limb.toml's scale: hang a known "
        "weight on the tip to see which it is."
    )
