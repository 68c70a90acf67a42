"""What every baseline is given of a record: one whitened column per way of an effect, with the base taken out.

Everything comes from the tool's own steps (its noise, its believed limb refitted under its priors, its catalogue and
plant), so that a baseline loses nothing by its inputs. A column is the change of the model's whitened readings when an
effect sets in at a typical size: as far as its key's tries go, else a small step of the key. All columns have norm 1,
so coefficients are in sigmas of the whole record.

Only triangular factors are kept: least squares on `root` are least squares on all the rows."""

from __future__ import annotations

import pickle
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

HIDDEN = 1e-3  # share of a column that must stay when the base is taken out
TWINS = 0.995  # cosine from which two tries of one key are one column
BLOCKS = 16  # groups of runs that bagging draws from
MOST_LINK_TIMES = 20


@dataclass(frozen=True)
class Column:
    """`point` are the keys' values at the try; `length` is its norm in sigmas at that size; `one_sided` where the size
    cannot be negative."""

    label: str
    keys: tuple[str, ...]
    believed: tuple[float, ...]
    point: tuple[float, ...]
    settings: tuple[tuple[str, float], ...]
    length: float
    one_sided: bool

    def values(self, coefficient: float) -> dict[str, float]:
        """Values of the keys at so many sigmas: the first key is scaled, the rest (a time, say) stands."""
        out = dict(zip(self.keys, self.point, strict=True))
        if self.keys:
            out[self.keys[0]] = self.believed[0] + (self.point[0] - self.believed[0]) * coefficient / self.length
        return out


@dataclass(frozen=True)
class Signatures:
    """`root` is triangular, of [columns, left]: `left` is what the refitted base leaves. `screened` are the columns
    that explain `left` best among the tries of their key; `blocks` are roots of those over groups of runs, the last one
    of the priors."""

    columns: tuple[Column, ...]
    root: Array
    screened: NDArray[np.int64]
    blocks: tuple[Array, ...]
    readings: int

    @property
    def matrix(self) -> Array:
        """Columns, after rotation."""
        return self.root[:, :-1]

    @property
    def left(self) -> Array:
        """What the base leaves, after the same rotation."""
        return self.root[:, -1]

    @property
    def labels(self) -> tuple[str, ...]:
        """Label of each column."""
        return tuple(column.label for column in self.columns)


def triangle(rows: Array) -> Array:
    """The triangular factor: least squares on it are least squares on the rows."""
    return np.asarray(np.linalg.qr(rows, mode="r"), float)


def prepared(case: Path) -> Any:
    """(given, record, trust, fitted base) of a case; None where the tool's own gate stops it."""
    from brace.diagnose.loading.fit import fit
    from brace.diagnose.loading.data_faults.gate import gate
    from brace.diagnose.loading.noise_after_base import with_known_noise
    from brace.identify.record import load_record
    from brace.diagnose.loading.space import space_of, trust_of
    from brace.diagnose.one import load
    from brace.diagnose.options import Options
    from brace.identify.turning import settled

    given = load(case, case / "limb.toml")
    assert given.believed is not None
    dataset = settled(given.dataset, given.believed)
    if gate(dataset, given.believed, Options()) is not None:
        return None
    trust = trust_of(given.believed, turns=not dataset.small_displacements)
    record = with_known_noise(load_record(dataset), trust)
    space = space_of(trust, ())
    return given, record, trust, fit(record, space, space.mean)


def signatures_of(case: Path) -> Signatures | None:
    """The columns of one case; None where the tool's gate stops it before any physics."""
    ready = prepared(case)
    if ready is None:
        return None
    given, record, trust, base = ready
    from brace.effects import all_variants
    from brace.identify.record import setting_of
    from brace.diagnose.loading.screen import Remover

    remover = Remover(base)
    left = remover.augmented(base.residual[None])[0]
    found, raw = [], []
    seen: set[tuple[Any, ...]] = set()
    for variant in all_variants(setting_of(record, given.believed)):
        for column, change in _changes(record, trust, base, variant):
            name = (column.label, column.keys, column.point, column.settings)
            if name not in seen:
                seen.add(name)
                found.append(column)
                raw.append(change)
    bare = remover.columns(np.array(raw).T)
    columns, kept = _unlike(found, np.array(raw).T, bare)
    whole = np.column_stack([kept, left])
    root = triangle(whole)
    screened = _best_tries(columns, kept, left)
    few = np.column_stack([kept[:, screened], left])
    _, run = np.unique(record.dataset["run"], return_inverse=True)
    group = np.concatenate([np.tile(run % BLOCKS, len(record.channels)), np.full(len(left) - base.residual.size, -1)])
    blocks = tuple(triangle(few[group == g]) for g in (*range(BLOCKS), -1))
    return Signatures(tuple(columns), root, screened, blocks, record.readings)


def _changes(record: Any, trust: Any, base: Any, variant: Any) -> list[tuple[Column, Array]]:
    """Columns of one variant, each with its change of the whitened model readings."""
    from brace.diagnose.loading.fit import residuals
    from brace.diagnose.loading.space import space_of
    from brace.identify.parameters import natural_scale

    space = space_of(trust, (variant,))
    start = space.mean.copy()
    known = dict(zip(base.space.keys, base.x, strict=True))
    for i, key in enumerate(space.keys):
        start[i] = min(max(known.get(key, start[i]), space.low[i]), space.high[i])
    settings = tuple(sorted(variant.settings.items()))
    tried = [freedom for freedom in variant.freedoms if freedom.tries]
    points, keys = [], []
    if tried:
        for values in product(*(_thinned(freedom) for freedom in tried)):
            point = start.copy()
            for freedom, value in zip(tried, values, strict=True):
                place = space.keys.index(freedom.key)
                point[place] = min(max(value, space.low[place]), space.high[place])
            points.append(point)
            keys.append(tuple(freedom.key for freedom in tried))
    for freedom in variant.freedoms:
        if freedom.tries:
            continue
        place = space.keys.index(freedom.key)
        step = max(1e-3 * abs(start[place]), 1e-3 * natural_scale(freedom.key))
        point = start.copy()
        point[place] += -step if start[place] + step > space.high[place] else step
        points.append(point)
        keys.append((freedom.key,))
    if not variant.freedoms:
        points.append(start.copy())
        keys.append(())
    moved = base.residual - residuals(record, space, np.array(points))
    out = []
    for one, point, change in zip(keys, points, moved, strict=True):
        places = [space.keys.index(key) for key in one]
        believed = tuple(float(start[place]) for place in places)
        sided = not places or one[0].endswith("saturation_n")
        if places:
            sided |= bool(start[places[0]] <= space.low[places[0]] or start[places[0]] >= space.high[places[0]])
        values = tuple(float(point[place]) for place in places)
        out.append((Column(variant.label, one, believed, values, settings, 1.0, sided), np.asarray(change, float)))
    return out


def _thinned(freedom: Any) -> tuple[float, ...]:
    """A freedom's tries; not every run's start."""
    tries = tuple(freedom.tries)
    return tries[:: max(1, len(tries) // MOST_LINK_TIMES)] if freedom.stepwise else tries


def _unlike(found: list[Column], raw: Array, bare: Array) -> tuple[list[Column], Array]:
    """Columns that the base cannot make up, none twice, each of norm 1."""
    whole, length = np.linalg.norm(raw, axis=0), np.linalg.norm(bare, axis=0)
    columns: list[Column] = []
    kept: list[Array] = []
    for i in np.flatnonzero((length > HIDDEN * np.maximum(whole, 1e-300)) & (length > 1e-9) & (length < 1e7)):
        unit = bare[:, i] / length[i]
        of_key = [k for k, other in enumerate(columns) if other.label == found[i].label and other.keys == found[i].keys]
        if any(float(kept[k] @ unit) > TWINS for k in of_key):
            continue
        one = found[i]
        columns.append(
            Column(one.label, one.keys, one.believed, one.point, one.settings, float(length[i]), one.one_sided)
        )
        kept.append(unit)
    return columns, np.array(kept).T


def _best_tries(columns: list[Column], units: Array, left: Array) -> NDArray[np.int64]:
    """Of every key of every label the try that explains most of what is left."""
    along = units.T @ left
    best: dict[tuple[str, tuple[str, ...]], int] = {}
    for i, column in enumerate(columns):
        worth = along[i] if column.one_sided else abs(along[i])
        name = (column.label, column.keys)
        before = best.get(name)
        if before is None or worth > (along[before] if columns[before].one_sided else abs(along[before])):
            best[name] = i
    return np.array(sorted(best.values()), dtype=np.int64)


def cached(case: Path, folder: Path) -> Signatures | None:
    """A case's columns, kept in `folder` once made."""
    path = folder / f"{case.name}.pickle"
    if path.exists():
        kept: Signatures | None = pickle.loads(path.read_bytes())
        return kept
    found = signatures_of(case)
    folder.mkdir(parents=True, exist_ok=True)
    part = path.with_suffix(".part")
    part.write_bytes(pickle.dumps(found))
    part.replace(path)
    return found
