"""A quiet sensor's readings are off by what it rounds: no noise, with a shape of its own, and nothing of the limb."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from brace.diagnose.loading.fit import Fit
from brace.diagnose.loading.noise import FAR_SIGMAS
from brace.diagnose.loading.record import Record
from brace.diagnose.loading.search import Hypothesis


def rounds_to_record(record: Record, fitted: Fit) -> bool:
    """Whether the sensor would read this very record off the fitted limb, as well as a fit can know it: then nothing in
    the record contradicts it. Never where it is noise that decides."""
    rounds_n = np.array([record.noise[name].rounds_n for name in record.channels])
    if not rounds_n.all():
        return False
    fit_share = np.sqrt(fitted.space.size / record.readings)  # of a reading's sigma, that the fit is uncertain by
    reach = rounds_n[:, None] + FAR_SIGMAS * fit_share * record.sigma
    off = record.measured - record.player.play_numbers(fitted.model[None])[0]
    return bool((np.abs(off) <= reach).all())


def asked_for(record: Record, hypotheses: Sequence[Hypothesis]) -> list[Hypothesis]:
    """Those whose every effect the record asks for: where fewer effects round to it,
    more of them fit what was rounded."""
    enough = [item.labels for item in hypotheses if rounds_to_record(record, item.fit)]
    return [item for item in hypotheses if not any(labels < item.labels for labels in enough)]
