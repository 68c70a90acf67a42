"""A quiet sensor's readings are off by what it rounds: no noise, with a shape of its own, and nothing of the limb."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from brace.diagnose.loading.fit import Fit
from brace.identify.noise import FAR_SIGMAS
from brace.identify.record import NOT_MEASURED, Record
from brace.diagnose.loading.search import Hypothesis


def rounds_to_record(record: Record, fitted: Fit) -> bool:
    """Whether the instruments would read this very record off the fitted limb, as well as a fit can know it: then
    nothing in the record contradicts it. Never where it is noise that decides."""
    return bool(_rounding(record, fitted).all())


def blurred(record: Record, fitted: Fit) -> tuple[Record, Fit]:
    """The record and its fit without the channels that round to what they should read: what is left of those is the
    shape of their rounding, and says nothing."""
    silent = _rounding(record, fitted)
    if not silent.any():
        return record, fitted
    sigma = np.where(silent[:, None], NOT_MEASURED, record.sigma)
    speaks = np.repeat(~silent, record.rows)
    left = fitted.residual * speaks
    cost = fitted.cost - fitted.chi2 + float(left @ left)
    kept = replace(fitted, residual=left, jacobian=fitted.jacobian * speaks[:, None], cost=cost)
    return replace(record, sigma=sigma), kept


def _rounding(record: Record, fitted: Fit) -> np.ndarray:
    """By channel: whether its rounding hides its noise, and the fitted limb would give every one of its readings."""
    rounds_n = np.array([record.noise[name].rounds_n for name in record.channels])
    fit_share = np.sqrt(fitted.space.size / record.readings)  # of a reading's sigma, that the fit is uncertain by
    reach = rounds_n[:, None] + FAR_SIGMAS * fit_share * record.sigma
    off = np.abs(record.measured - record.player.play_numbers(fitted.model[None])[0])
    taken = record.sigma < NOT_MEASURED
    return np.asarray((rounds_n > 0.0) & ((off <= reach) | ~taken).all(axis=1))


def asked_for(record: Record, hypotheses: Sequence[Hypothesis]) -> list[Hypothesis]:
    """Those whose every effect the record asks for: where fewer effects round to it,
    more of them fit what was rounded."""
    enough = [item.labels for item in hypotheses if rounds_to_record(record, item.fit)]
    return [item for item in hypotheses if not any(labels < item.labels for labels in enough)]
