"""Loading records on the plant: whether a record's limb turned as it was displaced, and the player for it.

A real limb turns, so force is not proportional to displacement even where every spring is linear. Some simulations
leave that out. A record may say so in its meta.toml (`displacements`). Where it does not, the readings tell: the part of
the forces that is curved over the displacement is compared with the one that the believed limb shows as it turns. Their
ratio is near 1 for most limbs that turn and 0 for one that does not. A tibia that is a beam, or a joint much softer than
believed, may bring it near 0 for a limb that turns: then the record is taken for one that does not."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from brace.dataset import Dataset
from brace.model import LimbModel
from brace.native.plant_batch import LoadingBatchPlayer, model_numbers

FORCES = ("fx_n", "fz_n")
NOT_TURNED = 0.25  # a record with at most this ratio may come from a limb that does not turn
MUST_DIFFER = 6.0  # sigmas of the ratio that it has to lie below 1 then


def player_of(dataset: Dataset, readings: Sequence[str], *, zeroed: bool = False) -> LoadingBatchPlayer:
    """Plays the record's displacements as its limb made them."""
    return LoadingBatchPlayer(
        dataset.columns,
        readings,
        zeroed=zeroed,
        small_displacements=dataset.small_displacements,
        held_at_rest=dataset.meta.held_at_rest,
    )


def settled(dataset: Dataset, believed: LimbModel) -> Dataset:
    """The record, with `small_displacements` as its meta.toml says or its readings tell. In doubt the limb turned."""
    if dataset.meta.displacements:
        return dataset
    return replace(dataset, small_displacements=_never_turned(dataset, believed))


def _never_turned(dataset: Dataset, believed: LimbModel) -> bool:
    turning = replace(dataset, small_displacements=False)
    played = player_of(turning, FORCES).play_numbers(model_numbers(believed)[None])[0]
    measured = np.stack([np.asarray(dataset[name], float) for name in FORCES])
    if not (np.isfinite(played).all() and np.isfinite(measured).all()):
        return False
    expected, found = (_curved(dataset.columns, forces).ravel() for forces in (played, measured))
    power = float(expected @ expected)
    if power == 0.0:
        return False
    ratio = float(expected @ found) / power
    left = found - ratio * expected
    sigma = float(np.sqrt(left @ left / left.size / power))
    return abs(ratio) <= NOT_TURNED and 1.0 - ratio > MUST_DIFFER * sigma


def _curved(columns: Mapping[str, np.ndarray], forces: np.ndarray) -> np.ndarray:
    """What a constant force and a stiffness of each configuration leave of the forces (forces x rows)."""
    left = np.empty_like(forces)
    for config in np.unique(columns["config"]):
        rows = columns["config"] == config
        linear = np.column_stack([np.ones(np.count_nonzero(rows)), columns["dx_mm"][rows], columns["dz_mm"][rows]])
        fitted, *_ = np.linalg.lstsq(linear, forces[:, rows].T, rcond=None)
        left[:, rows] = forces[:, rows] - (linear @ fitted).T
    return left
