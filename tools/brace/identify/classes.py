"""Which parameters of a limb this record cannot tell apart, whether they were fitted or not.

Each candidate has a signature: the change of every reading with it. A candidate belongs to a class when the
signatures of a few others, in some mixture, make up its own; then the record cannot separate them at any noise
level."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from brace.ground.errors import BadFileError
from brace.identify.fit import STEP, Problem, residual_of
from brace.identify.parameters import BASE_COMPLIANCES, COMPLIANCES, natural_scale
from brace.model import LimbModel
from brace.model.keys import KEY_BY_NAME

CANDIDATES = (
    *COMPLIANCES,
    "link.femur.moment_transfer",
    *BASE_COMPLIANCES,
    "sensor.gain",
    "sensor.rotation_rad",
    "sensor.crosstalk_xz",
    "sensor.crosstalk_zx",
)
TABLE_CANDIDATES = (*COMPLIANCES, "link.femur.moment_transfer", *BASE_COMPLIANCES)
# Share of a signature that the others may leave unexplained: small classes may be near misses, large ones must be
# exact, or everything would be like everything.
LEFT_OVER_SMALL, SMALL, LEFT_OVER_LARGE = 0.02, 3, 1e-3
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


def confusions(
    problem: Problem, model: LimbModel, nuisances: dict[str, float], candidates: Sequence[str]
) -> list[Confusion]:
    """The classes of this record around this model, smallest first."""
    keys = [key for key in candidates if key in KEY_BY_NAME]
    around = _present(model, keys)
    columns = {
        key: column for key in keys if (column := _signature(problem, around, nuisances, key)) is not None
    }
    found: list[Confusion] = []
    for key in keys:  # pairs first: of two that are one, only the first takes part in larger classes
        twins = [
            other
            for other in columns
            if other != key
            and key in columns
            and _left_over(columns[other], [columns[key]]) < LEFT_OVER_SMALL
        ]
        for twin in twins:
            found.append(
                Confusion((key, twin), _left_over(columns[twin], [columns[key]]), remedy((key, twin)))
            )
            del columns[twin]
    larger: dict[frozenset[str], Confusion] = {}
    for key, column in columns.items():
        members, left_over = _explain(
            column, {name: values for name, values in columns.items() if name != key}
        )
        group = frozenset((key, *members))
        if members and group not in larger:
            larger[group] = Confusion((key, *members), left_over, remedy(group))
    for group in sorted(larger, key=lambda item: (len(item), sorted(item))):
        if not any(smaller < group for smaller in larger):
            found.append(larger[group])
    return found


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
    changes = {
        key: _PRESENCE * natural_scale(key)
        for key in keys
        if key.startswith(("link.", "joint.", "base."))
        and model.number(key) == 0.0
        and "moment_transfer" not in key
    }
    return model.with_values(changes)


def _signature(
    problem: Problem, model: LimbModel, nuisances: dict[str, float], key: str
) -> np.ndarray | None:
    """Change of the whitened readings per natural scale of the key, unit length; None when nothing changes."""
    entry, step = KEY_BY_NAME[key], STEP * 10 * natural_scale(key)
    value = model.number(key)
    up, down = min(value + step, entry.high), max(value - step, entry.low)
    try:
        change = residual_of(problem, model.with_values({key: up}), nuisances) - residual_of(
            problem, model.with_values({key: down}), nuisances
        )
    except BadFileError:
        return None
    length = float(np.linalg.norm(change))
    return change / length if length > 1e-9 * step else None


def _explain(column: np.ndarray, others: dict[str, np.ndarray]) -> tuple[list[str], float]:
    """The fewest others whose mixture makes up the column: chosen one by one, then thinned out; none if no few do."""
    chosen: list[str] = []
    size = 1.0
    while size >= _allowed(len(chosen) + 1) and len(chosen) < min(MAX_MEMBERS, len(others)):
        gains = {
            name: _left_over(column, [others[item] for item in (*chosen, name)])
            for name in others
            if name not in chosen
        }
        best = min(gains, key=lambda name: (round(gains[name], 9), name))
        chosen.append(best)
        size = gains[best]
    if size >= _allowed(len(chosen) + 1):
        return [], size
    for name in list(chosen):
        rest = [item for item in chosen if item != name]
        if rest and (thinner := _left_over(column, [others[item] for item in rest])) < _allowed(
            len(rest) + 1
        ):
            chosen, size = rest, thinner
    return chosen, size


def _allowed(members: int) -> float:
    return LEFT_OVER_SMALL if members <= SMALL else LEFT_OVER_LARGE


def _left_over(column: np.ndarray, basis: list[np.ndarray]) -> float:
    matrix = np.column_stack(basis)
    mixture = np.linalg.lstsq(matrix, column, rcond=1e-8)[0]
    return float(np.linalg.norm(column - matrix @ mixture))
