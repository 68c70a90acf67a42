"""How much a record says: independent readings, gains that agree between its parts, intervals of parameters.

Residuals of a real joint hang together for many readings. If each counted as independent, any shape would be
significant. So a gain counts independent readings only, and a record drawn anew is made of whole stretches."""

from __future__ import annotations

import numpy as np

from brace.diagnose.diagnosis import Interval
from brace.diagnose.joint_test.fit import Fitted, Fitter
from brace.diagnose.joint_test.record import JointRecord
from brace.identify.noise import robust_sigma

DRAWS = 400
MIN_STRETCHES = 10
FEIGNED = 0.1  # of the misfit that stays: as much as a term of a wrong shape takes of it by chance
LOW, HIGH = 0.05, 0.95  # of a 90 % interval


def gain(record: JointRecord, poorer: Fitted, richer: Fitted, count: float) -> float:
    """Twice the log-likelihood that the richer fit gains over `count` independent readings."""
    floor = record.noise_n_mm**2 * np.count_nonzero(record.fitted)
    small = max(richer.rss, 1e-6 * floor, 1e-12 * record.size.torque_n_mm**2)
    return count * float(np.log(max(poorer.rss, small) / small))


def feigned(record: JointRecord, poorer: Fitted, richer: Fitted) -> float:
    """The probability that the richer fit only follows what no model here explains: what it gains is set beside the
    misfit that it leaves. A gain of a tenth of that is as likely feigned as not, one of ten times that hardly ever."""
    misfit = richer.rss - record.noise_n_mm**2 * float(np.sum(record.root_weight[record.fitted] ** 2))
    gained = max(poorer.rss - richer.rss, 1e-30)
    return float(min(1.0, 0.5 * FEIGNED * max(misfit, 0.0) / gained))


def stretches(record: JointRecord, off_n_mm: np.ndarray) -> np.ndarray:
    """Number of the stretch that each fitted reading belongs to: ramps, cut where they are fewer than enough,
    never shorter than what hangs together."""
    ramp = record.ramp[record.fitted]
    _, number = np.unique(ramp, return_inverse=True)
    count = int(number.max()) + 1
    together = int(np.ceil(ramp.size / record.independent(off_n_mm)))
    while count < MIN_STRETCHES:
        sizes = np.bincount(number)
        largest = int(np.argmax(sizes))
        if sizes[largest] < 2 * max(together, 4):
            break
        members = np.flatnonzero(number == largest)
        number[members[members.size // 2 :]] = count
        count += 1
    return np.asarray(number)


def agreement(record: JointRecord, poorer: Fitted, richer: Fitted, random: np.random.Generator) -> float:
    """Share of the records drawn anew from stretches in which the richer fit is the better one."""
    better = (poorer.off_n_mm**2 - richer.off_n_mm**2)[record.fitted]
    sums = np.bincount(stretches(record, richer.off_n_mm), weights=better)
    drawn = random.multinomial(sums.size, np.full(sums.size, 1.0 / sums.size), size=DRAWS)
    return float(np.mean(drawn @ sums > 0.0))


def intervals(
    fitter: Fitter, fitted: Fitted, random: np.random.Generator
) -> dict[str, tuple[float, float, float]]:
    """value, low, high (90 %) of every parameter: stretches drawn anew, the fit moved by its slope."""
    record = fitter.record
    slope = fitter.slope_n_mm(fitted)
    off = fitted.off_n_mm[record.fitted]
    number = stretches(record, fitted.off_n_mm)
    scale, low, high = (fitted.parameters.array(name) for name in ("scale", "low", "high"))
    free = np.linalg.norm(slope, axis=0) > 1e-12
    count = int(number.max()) + 1
    ridge = 1e-9 * np.diag(np.einsum("ij,ij->j", slope, slope))
    squares = np.stack([slope[number == i].T @ slope[number == i] for i in range(count)])
    pushes = np.stack([slope[number == i].T @ off[number == i] for i in range(count)])
    drawn = random.multinomial(count, np.full(count, 1.0 / count), size=DRAWS).astype(float)
    # few stretches scatter too little by themselves: n / (n - 1), and one parameter's share of the readings
    widen = np.sqrt(count / max(count - 1.0, 1.0)) if count > 1 else 1.0
    moved = np.zeros((DRAWS, fitted.x.size))
    for row, weights in enumerate(drawn):
        normal = np.tensordot(weights, squares, 1)[np.ix_(free, free)] + ridge[np.ix_(free, free)]
        try:
            moved[row, free] = -np.linalg.solve(normal, (weights @ pushes)[free])
        except np.linalg.LinAlgError:
            moved[row, free] = 0.0
    x = fitted.x + widen * (moved - np.median(moved, axis=0)) * scale
    result = {}
    for place, key in enumerate(fitted.parameters.keys):
        value = float(fitted.x[place])
        if not free[place]:
            result[key] = (value, float(low[place]), float(high[place]))
            continue
        ends = np.clip(np.quantile(x[:, place], [LOW, HIGH]), low[place], high[place])
        result[key] = (value, float(min(ends[0], value)), float(max(ends[1], value)))
    return result


def left_n_mm(fitter: Fitter, fitted: Fitted) -> float:
    """What the fit leaves beyond the noise, as one sigma. The few readings while a gap is crossed do not count: there a
    torque is known no better than the angle."""
    weight = fitter.root_weight[fitter.record.fitted]
    off = fitted.off_n_mm[fitter.record.fitted][weight > 0.0] / weight[weight > 0.0]
    return float(np.sqrt(max(0.0, robust_sigma(off) ** 2 - fitter.record.noise_n_mm**2)))


def beside_what_is_left(key: str, interval: Interval, left: float, compliance_rad_per_n_mm: float) -> Interval:
    """What a model leaves may be play or dry friction of that size, so that their intervals hold it. `left`: N mm.
    Noise and a law of friction that is not the model's have nothing to do with one another: both add as squares do."""
    share = {"coulomb_n_mm": 1.0, "gap_rad": compliance_rad_per_n_mm}.get(key.rsplit(".", 1)[-1], 0.0) * left
    low = interval.value - np.hypot(interval.value - interval.low, share)
    high = interval.value + np.hypot(interval.high - interval.value, share)
    return Interval(interval.value, float(max(low, min(interval.low, 0.0))), float(high))
