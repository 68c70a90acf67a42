"""Does something that the catalogue lacks explain the record better than what it has?

A number of the limb may change while the record is taken: with time, with temperature, from posture to posture, with
the sign or the size of the load, between the way out and the way back. Each number of the catalogue or the calibration,
changed in each of these ways, is a hypothesis with one more freedom. It stands alone or beside a part of the best set
of effects, and the same evidence judges both. A change that looks like an effect of the catalogue in this record is no
rival of that effect."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from brace.dataset.check_runs import run_starts
from brace.diagnose.loading.choose import LabelSet
from brace.diagnose.loading.evidence import evidence, freedoms, score
from brace.diagnose.loading.fit import Fit
from brace.identify.noise import FORCES
from brace.identify.record import Record, levers
from brace.diagnose.loading.rounding import rounds_to_record
from brace.diagnose.loading.screen import Remover
from brace.effects import Variant
from brace.effects.catalogue import STILL_KEYS, TIME_KEYS
from brace.identify.parameters import natural_scale
from brace.model.keys import KEY_BY_NAME
from brace.native.plant_batch import number_index

PRIOR_OUTSIDE = 0.05  # of anything outside the catalogue, against nothing missing: a tenth of what is in it
SAME_COSINE = 0.95  # from which a change is an effect of the catalogue by another name
MUST_LEAD = 6.0  # nats, 400 to 1, to be reported where nothing is missing
TAKES_BACK = 0.0  # nats, even odds, to take back what would be named; below that, the odds only lower the confidence
PROBE_SIGMAS = 3.0  # of the whole record: how far a number is turned to see what it does
HIDDEN = 0.02  # share of a change that must stay when all that the hypothesis turns is taken out
LEAST_RANGE_DEGC = 0.1
LEAST_LOAD = 1e-6  # of the largest load: less is a limb at rest
UNCHANGING = TIME_KEYS | STILL_KEYS  # numbers that are a change themselves, or a moment or a limit
OWN_LOAD = ("joint.femur", "joint.tibia", "sensor")  # parts that know their own load; others go by the load at the tip


@dataclass(frozen=True)
class Outside:
    """`lead` of everything outside the catalogue over the best of it, nats; `words` for what it most looks like;
    with a lead above `must_lead` the verdict is unknown."""

    lead: float
    words: str
    must_lead: float = MUST_LEAD

    @property
    def likely(self) -> bool:
        """Likely enough for the verdict unknown. A name that is wrong more often than right helps nobody; a sound limb
        that is called faulty costs trust, so that nothing missing stands longer."""
        return self.lead > self.must_lead

    @property
    def probability(self) -> float:
        return float(1.0 / (1.0 + np.exp(-np.clip(self.lead, -700.0, 700.0))))


def outside(record: Record, sets: Sequence[LabelSet], variants: Sequence[Variant]) -> Outside:
    """Everything outside the catalogue against the best set; `sets` are sorted, and one of them has no labels."""
    known = {item.labels: item for item in sets}
    best, base = sets[0], known[frozenset()].best.fit
    if rounds_to_record(record, best.best.fit):
        return Outside(-np.inf, "")
    rests = [frozenset[str](), *(best.labels - {label} for label in sorted(best.labels)), best.labels]
    found: list[tuple[float, str]] = []
    for rest in dict.fromkeys(rests):
        if rest in known:
            fitted = known[rest].best.fit
            for words, gain in changes(record, fitted, variants):
                found.append((_score(record, fitted, base, gain), words))
    if not found:
        return Outside(-np.inf, "")
    scores = np.array([value for value, _ in found]) + np.log(PRIOR_OUTSIDE / len({words for _, words in found}))
    top = float(scores.max())
    whole = top + float(np.log(np.sum(np.exp(scores - top))))
    against = score(best.best.fit, base, record.readings, record.noise_freedom) - float(np.log(best.posterior))
    return Outside(whole - against, found[int(np.argmax(scores))][1], TAKES_BACK if best.labels else MUST_LEAD)


def _score(record: Record, fitted: Fit, base: Fit, gain: float) -> float:
    """Log evidence of a hypothesis with one changed number that takes so much off its cost."""
    own, effects = freedoms(fitted) + 1, len(fitted.space.variants)
    return evidence(fitted.cost - gain, base.cost, own, effects, record.readings, record.noise_freedom)


def changes(record: Record, fitted: Fit, variants: Sequence[Variant]) -> list[tuple[str, float]]:
    """(words, what it takes off chi squared) of every number changed in every way, small as it is."""
    remover = Remover(fitted)
    left = remover.augmented(fitted.residual[None])[0]
    plain = _columns(record, fitted, variants)
    names, raw = [], []
    for owner, ways in _ways(record, fitted).items():
        for key, column in plain.items():
            if owner != next((name for name in OWN_LOAD if key.startswith(name)), "") or key in UNCHANGING:
                continue
            for words, way in ways.items():
                names.append(f"{key} {words}")
                raw.append((column * way).ravel())
    whole = np.array(raw).T
    bare = remover.columns(whole)
    power, before = np.einsum("ij,ij->j", bare, bare), np.einsum("ij,ij->j", whole, whole)
    safe = np.where(power > 0.0, power, 1.0)
    foreign = _alike(remover, plain, variants, bare / np.sqrt(safe)) < SAME_COSINE
    seen = (power > HIDDEN**2 * before) & (power > 1e-4) & foreign
    gains = (left @ bare) ** 2 / safe
    return [(names[place], float(gains[place])) for place in np.flatnonzero(seen)]


def _alike(
    remover: Remover, plain: Mapping[str, np.ndarray], variants: Sequence[Variant], bare: np.ndarray
) -> np.ndarray:
    """Of each change (unit columns), the largest cosine with what one effect of the catalogue can make."""
    largest = np.zeros(bare.shape[1])
    for label in sorted({variant.label for variant in variants}):
        keys = {freedom.key for variant in variants if variant.label == label for freedom in variant.freedoms}
        own = [plain[key].ravel() for key in sorted(keys) if key in plain]
        if own:
            columns = remover.columns(np.array(own).T)
            lengths = np.linalg.norm(columns, axis=0)
            basis, _ = np.linalg.qr(columns[:, lengths > 1e-3] / lengths[lengths > 1e-3])
            largest = np.maximum(largest, np.linalg.norm(basis.T @ bare, axis=0))
    return largest


def _columns(record: Record, fitted: Fit, variants: Sequence[Variant]) -> dict[str, np.ndarray]:
    """By key, the change of the whitened readings (channels x rows) as it is turned a little from the fit on."""
    index, numbers = number_index(), fitted.model
    tries = {freedom.key: freedom for variant in variants for freedom in variant.freedoms if not freedom.stepwise}
    keys = [key for key in dict.fromkeys((*fitted.space.keys, *tries)) if key not in STILL_KEYS]
    turned = np.array([1e-2 * natural_scale(key) for key in keys])
    for place, key in enumerate(keys):
        value = numbers[index[key]]
        if value > 0.0 and not key.endswith(("zero_offset_rad", "tilt_rad")):
            turned[place] = 1e-2 * value
        elif key in tries and tries[key].tries:
            turned[place] = tries[key].tries[0]
    models = np.tile(numbers, (len(keys), 1))
    places = (np.arange(len(keys)), [index[key] for key in keys])
    highest = np.array([KEY_BY_NAME[key].high for key in keys])
    for last in (False, True):
        models[places] = numbers[places[1]] + np.where(numbers[places[1]] + turned > highest, -turned, turned)
        moved = fitted.residual - record.residuals(models)
        moved[~np.isfinite(moved).all(axis=1)] = 0.0  # no limb can have such numbers
        lengths = np.linalg.norm(moved, axis=1)
        if not last:
            turned *= np.clip(PROBE_SIGMAS / np.clip(lengths, 1e-6, None), 1e-3, 1e3)
    shape = record.measured.shape
    return {key: moved[place].reshape(shape) for place, key in enumerate(keys) if 1e-2 < lengths[place] < 1e4}


def _ways(record: Record, fitted: Fit) -> dict[str, dict[str, np.ndarray]]:
    """How a number may change, by who carries the load that it may change with; 0 to 1, rows or channels x rows."""
    data = record.dataset
    along = np.where(data["axis"] == 1, data["dz_mm"], data["dx_mm"])
    time = (data["t_s"] - data["t_s"][0]) / max(float(np.ptp(data["t_s"])), 1e-9)
    common = {
        "grew with time": time,
        "faded with time": 1.0 - time,
        "differed between the way out and the way back": _way(record, along),
    }
    warmth = data["temp_degc"] - data["temp_degc"][0] if "temp_degc" in data else np.zeros(data.rows)
    if float(np.ptp(warmth)) > LEAST_RANGE_DEGC:
        common["followed the temperature"] = warmth / np.abs(warmth).max()
    for name, words in (("theta1_rad", "femur angle"), ("theta2_rad", "knee angle")):
        off = data[name] - data[name].mean()
        common[f"changed with the {words}"] = off / max(float(np.abs(off).max()), 1e-9)
    played = record.measured - fitted.residual.reshape(record.measured.shape) * record.sigma
    played[len(FORCES) :] = 0.0  # the force sensor's numbers act on its own readings only
    index = number_index()
    femur_mm, tibia_mm = (fitted.model[index[f"geometry.{link}_mm"]] for link in ("femur", "tibia"))
    arms = levers(femur_mm, tibia_mm, data["theta1_rad"], data["theta2_rad"])
    carried = {f"joint.{joint}": np.sum(arms[joint] * played[: len(FORCES)], axis=0) for joint in arms}
    return {owner: common | _by_load(load) for owner, load in {"": along, "sensor": played, **carried}.items()}


def _by_load(load: np.ndarray) -> dict[str, np.ndarray]:
    size = np.abs(load) / max(float(np.quantile(np.abs(load), 0.99)), 1e-12)
    loaded = size > LEAST_LOAD  # where the limb rests, rounding makes the sign, and that follows the reading
    return {
        "acted under positive load only": np.where(loaded & (load > 0.0), 1.0, 0.0),
        "acted under negative load only": np.where(loaded & (load < 0.0), 1.0, 0.0),
        "grew with the load": size,
        "grew with the square of the load": size**2,
    }


def _way(record: Record, along: np.ndarray) -> np.ndarray:
    """+1 while the load grows, -1 while it goes back."""
    out = np.zeros(along.size)
    starts = run_starts(record.dataset["run"])
    for begin, end in zip(starts[:-1], starts[1:]):
        out[begin:end] = np.sign(np.diff(np.abs(along[begin:end]), prepend=abs(along[begin])))
    return out
