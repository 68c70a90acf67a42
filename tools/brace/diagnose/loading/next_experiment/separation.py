"""How well a loading test that was not made yet would tell fitted hypotheses apart.

Each hypothesis is played on the test with its own fit. What a rival could make up by refitting is taken
out of the difference: refitting costs it what the record so far and calibration's priors know of its
parameters. What stays is lambda^2, the expected gain of twice the log-likelihood: the log-likelihood ratio
is then normal with mean lambda^2 / 2 and standard deviation lambda."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from brace.diagnose.loading.choose import LabelSet
from brace.diagnose.loading.fit import BIG, PROBE, Fit
from brace.identify.record import Record

WIN_NATS = 3.0  # by which the right one must lead to count as separated
LEAST_ODDS = -8.0  # log odds below the best from which a set is no rival of its own accord
LEAST_RIVALS = 3  # that even a sure name is tested against
MOST_HYPOTHESES = 6
NESTED_SHARE = 0.02  # of the posterior, from which a set with one effect more than a rival is a rival too
LEAD_BELIEVED = 0.5  # of today's lead: evidence is never quite what it says
TEMPER = 0.3  # how far posterior shares are believed when hypotheses are weighed


@dataclass(frozen=True)
class Contender:
    """A hypothesis with its fit; `log_odds` against the best (<= 0); `known` is the information of record
    and priors about the fit's parameters, by x / scale."""

    labels: frozenset[str]
    label: str
    fit: Fit
    log_odds: float
    known: np.ndarray


def contenders(sets: Sequence[LabelSet]) -> list[Contender]:
    """The best set and what else the record leaves possible; for a sure name the nearest of the others all
    the same."""
    odds = [
        float(np.log(max(item.posterior, 1e-300)) - np.log(max(sets[0].posterior, 1e-300))) for item in sets
    ]
    chosen: list[int] = []
    for place, item in enumerate(sets):
        wanted = odds[place] > LEAST_ODDS or len(chosen) <= LEAST_RIVALS
        larger = any(sets[other].labels < item.labels for other in chosen)
        if wanted and (not larger or item.posterior >= NESTED_SHARE) and np.isfinite(item.best.fit.cost):
            chosen.append(place)
        if len(chosen) == MOST_HYPOTHESES:
            break
    return [
        Contender(
            sets[place].labels,
            sets[place].label,
            sets[place].best.fit,
            min(odds[place], 0.0),
            _known(sets[place].best.fit),
        )
        for place in chosen
    ]


def _known(fitted: Fit) -> np.ndarray:
    """What the record and the priors say of a fit's parameters. A little is added everywhere: a fit is
    linear only so far (a parameter without any information still stays within a hundred of its scales)."""
    weight = np.where(np.isinf(fitted.space.sigma), 0.0, fitted.scale / fitted.space.sigma)
    normal = fitted.jacobian.T @ fitted.jacobian + np.diag(weight**2)
    return np.asarray(normal + 1e-4 * np.eye(len(normal)))


def weights(hypotheses: Sequence[Contender]) -> np.ndarray:
    """How much each counts as the possible truth."""
    share = np.exp(TEMPER * np.array([item.log_odds for item in hypotheses]))
    return np.asarray(share / share.sum())


@dataclass(frozen=True)
class Played:
    """A test played by all hypotheses, as sums over blocks of readings (blocks: one for each channel group
    and configuration): `square[a, b]` of the differences, `slope[b][a]` their products with b's
    derivatives, `normal[b]` of those with each other. Sums of independent readings add up."""

    square: np.ndarray  # groups x configs x truths x rivals
    slope: list[np.ndarray]  # per rival: groups x configs x truths x size
    normal: list[np.ndarray]  # per rival: groups x configs x size x size


def play(test: Record, hypotheses: Sequence[Contender], groups: Sequence[Sequence[int]]) -> Played:
    """`test.measured` does not matter. `groups` are places of channels that are read together or not at
    all."""
    points, steps = [], []
    for item in hypotheses:
        x, space = item.fit.x, item.fit.space
        step = PROBE * item.fit.scale
        step = np.where(x + step > space.high, -step, step)
        steps.append(step)
        points.append(space.models(np.vstack([x, x + np.diag(step)])))
    read = test.residuals(np.vstack(points))
    read = np.nan_to_num(read, nan=BIG, posinf=BIG, neginf=-BIG).reshape(len(read), len(test.channels), -1)
    begins = np.concatenate([[0], np.cumsum([len(some) for some in points])])
    own = read[begins[:-1]]
    _, config = np.unique(test.dataset["config"], return_inverse=True)
    count, configs = len(hypotheses), int(config.max()) + 1
    order = np.argsort(config, kind="stable")
    bounds = np.searchsorted(config[order], np.arange(configs))
    square = np.zeros((len(groups), configs, count, count))
    slope, normal = [], []
    for b, item in enumerate(hypotheses):
        first, last = begins[b] + 1, begins[b + 1]
        derivative = (own[b] - read[first:last]) * (item.fit.scale / steps[b])[:, None, None]
        away = own[b] - own  # what truth a reads more than rival b
        size = item.fit.space.size
        slope.append(np.zeros((len(groups), configs, count, size)))
        normal.append(np.zeros((len(groups), configs, size, size)))
        for g, channels in enumerate(groups):
            for c in range(configs):
                rows = order[bounds[c] : bounds[c + 1] if c + 1 < configs else None]
                d = away[:, channels][:, :, rows].reshape(count, -1)
                j = derivative[:, channels][:, :, rows].reshape(size, -1)
                square[g, c, :, b] = np.einsum("ij,ij->i", d, d)
                slope[b][g, c] = d @ j.T
                normal[b][g, c] = j @ j.T
    return Played(square, slope, normal)


def lambda_squared(played: Played, hypotheses: Sequence[Contender], amount: np.ndarray) -> np.ndarray:
    """tests x truths x rivals. `amount` (tests x groups x configs) says how often each block is read."""
    found = np.zeros((len(amount), len(hypotheses), len(hypotheses)))
    for b, item in enumerate(hypotheses):
        square = np.einsum("tgc,gca->ta", amount, played.square[..., b])
        slope = np.einsum("tgc,gcas->tas", amount, played.slope[b])
        normal = item.known + np.einsum("tgc,gcsr->tsr", amount, played.normal[b])
        made_up = np.einsum("tas,tsa->ta", slope, np.linalg.solve(normal, np.swapaxes(slope, 1, 2)))
        found[:, :, b] = np.maximum(square - made_up, 0.0)
    return found


def chance_to_win(found: np.ndarray, lead: np.ndarray | float = 0.0) -> np.ndarray:
    """Probability of a log-likelihood ratio above WIN_NATS, from lambda^2 and the lead [nats] that there
    is already."""
    from scipy.special import ndtr

    size = np.sqrt(np.maximum(found, 1e-12))
    return np.asarray(ndtr((0.5 * found + lead - WIN_NATS) / size))


def separated(found: np.ndarray, hypotheses: Sequence[Contender]) -> np.ndarray:
    """tests x truths x rivals: probability that the truth ends ahead of the rival by WIN_NATS. A lead that
    it has today counts by half, a lag in full. A set that only adds to the truth is no rival: it loses by
    its cost."""
    odds = np.array([item.log_odds for item in hypotheses])
    lead = odds[:, None] - odds[None, :]
    lead = np.where(lead > 0.0, LEAD_BELIEVED * lead, lead)
    return np.asarray(np.where(no_rivals(hypotheses), 1.0, chance_to_win(found, lead)))


def no_rivals(hypotheses: Sequence[Contender]) -> np.ndarray:
    """truths x rivals: True where the rival is the truth itself or has it within."""
    return np.array([[truth.labels <= rival.labels for rival in hypotheses] for truth in hypotheses])


def power(found: np.ndarray, hypotheses: Sequence[Contender]) -> np.ndarray:
    """Per test: probability that the right one, whichever it is, ends ahead of all others."""
    worst = separated(found, hypotheses).min(axis=2)
    judged = ~no_rivals(hypotheses).all(axis=1)
    share = weights(hypotheses) * judged
    return np.asarray(worst @ share / max(float(share.sum()), 1e-300))


def pairs_separated(found: np.ndarray, hypotheses: Sequence[Contender]) -> np.ndarray:
    """Per test: share of rivals that the right one, whichever it is, ends ahead of: what a test is worth
    where it cannot settle everything."""
    pair = np.where(no_rivals(hypotheses), 0.0, weights(hypotheses)[:, None])
    return np.asarray(np.einsum("tab,ab->t", separated(found, hypotheses), pair) / max(float(pair.sum()), 1e-300))
