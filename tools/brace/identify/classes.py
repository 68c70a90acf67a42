"""Which parameters of a limb this record cannot tell apart, whether they were fitted or not.

Each candidate has a signature: the change of every reading with it. A candidate belongs to a class when the
signatures of a few others, in some mixture, make up its own; then no noise level and no cleverness tells them
apart in this record."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from brace.identify.fit import STEP, Problem
from brace.identify.parameters import BASE_COMPLIANCES, COMPLIANCES, natural_scale
from brace.errors import BadFileError
from brace.model import LimbModel
from brace.model.keys import KEY_BY_NAME

CANDIDATES = (*COMPLIANCES, "link.femur.moment_transfer", *BASE_COMPLIANCES, "sensor.gain", "sensor.rotation_rad",
              "sensor.crosstalk_xz", "sensor.crosstalk_zx")
TABLE_CANDIDATES = (*COMPLIANCES, "link.femur.moment_transfer", *BASE_COMPLIANCES)
LEFT_OVER = 0.01  # share of a signature that the others may leave unexplained
MAX_MEMBERS = 8
# Readings need some compliance to bend: signatures are taken with every candidate a little present.
_PRESENCE = 0.05


@dataclass(frozen=True)
class Confusion:
    """`members` make the same readings in some mixture; `left_over` is the share of the first one's signature that
    the others leave."""

    members: tuple[str, ...]
    left_over: float
    told_apart_by: str


def confusions(problem: Problem, model: LimbModel, nuisances: dict[str, float], candidates: Sequence[str],
               needed: Iterable[str] = ()) -> list[Confusion]:
    """The classes of this record around this model, smallest first. `needed` keys were fitted as nuisances and may
    always help."""
    keys = [key for key in candidates if key in KEY_BY_NAME]
    around = _present(model, keys)
    columns = {key: column for key in keys if (column := _signature(problem, around, nuisances, key)) is not None}
    found: dict[frozenset[str], Confusion] = {}
    for key, column in columns.items():
        others = {name: values for name, values in columns.items() if name != key}
        members, left_over = _explain(column, others)
        group = frozenset((key, *members))
        if members and left_over < LEFT_OVER and group not in found:
            found[group] = Confusion((key, *members), left_over, remedy(group))
    smallest_first = sorted(found.items(), key=lambda item: (len(item[0]), sorted(item[0])))
    kept: list[tuple[frozenset[str], Confusion]] = []
    for group, confusion in smallest_first:
        if not any(smaller < group for smaller, _ in kept):
            kept.append((group, confusion))
    return [confusion for _, confusion in kept]


def remedy(members: Iterable[str]) -> str:
    """The measurement that separates such a class."""
    group = set(members)
    ways = []
    if any(key.startswith("base.") or "moment_transfer" in key for key in group):
        ways.append("a dial gauge on the base")
    if any(key.startswith("joint.") for key in group) and any(key.startswith("link.") for key in group):
        ways.append("output-side encoders at the joints")
    if "sensor.gain" in group:
        ways.append("a known mass hung on the tip")
    if any(key.startswith(("sensor.rotation", "sensor.crosstalk")) for key in group):
        ways.append("the sensor turned by 90 degrees")
    return " and ".join(ways) or "postures further apart"


def _present(model: LimbModel, keys: Sequence[str]) -> LimbModel:
    """The model with absent candidates a little present, so that every signature exists."""
    changes = {key: _PRESENCE * natural_scale(key) for key in keys
               if key.startswith(("link.", "joint.", "base.")) and model.number(key) == 0.0
               and "moment_transfer" not in key}
    return model.with_values(changes)


def _signature(problem: Problem, model: LimbModel, nuisances: dict[str, float], key: str) -> np.ndarray | None:
    """Change of the whitened readings per natural scale of the key, unit length; None when nothing changes."""
    entry, step = KEY_BY_NAME[key], STEP * 10 * natural_scale(key)
    value = model.number(key)
    up, down = min(value + step, entry.high), max(value - step, entry.low)
    try:
        change = problem.residual(model.with_values({key: up}), nuisances) \
            - problem.residual(model.with_values({key: down}), nuisances)
    except BadFileError:
        return None
    length = float(np.linalg.norm(change))
    return change / length if length > 1e-9 * step else None


def _explain(column: np.ndarray, others: dict[str, np.ndarray]) -> tuple[list[str], float]:
    """The fewest others whose mixture leaves less than LEFT_OVER: chosen one by one, then thinned out."""
    chosen: list[str] = []
    size = 1.0
    while size >= LEFT_OVER and len(chosen) < MAX_MEMBERS and len(chosen) < len(others):
        gains = {name: _left_over(column, [others[item] for item in (*chosen, name)])
                 for name in others if name not in chosen}
        best = min(gains, key=lambda name: (round(gains[name], 9), name))
        if gains[best] > size - 1e-9:
            break
        chosen.append(best)
        size = gains[best]
    if size >= LEFT_OVER:
        return [], size
    for name in list(chosen):
        rest = [item for item in chosen if item != name]
        if rest and (thinner := _left_over(column, [others[item] for item in rest])) < LEFT_OVER:
            chosen, size = rest, thinner
    return chosen, size


def _left_over(column: np.ndarray, basis: list[np.ndarray]) -> float:
    matrix = np.column_stack(basis)
    mixture = np.linalg.lstsq(matrix, column, rcond=1e-8)[0]
    return float(np.linalg.norm(column - matrix @ mixture))
