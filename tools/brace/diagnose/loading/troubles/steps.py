"""From which reading on an instrument reads otherwise: every reading of the record is tried at once."""

from __future__ import annotations

import numpy as np

from brace.identify.record import Record
from brace.diagnose.loading.screen import Remover

LEAST_SHARE = 1e-6  # of a step's own length, that the fitted limb must leave of it


def best_rows(record: Record, remover: Remover, left: np.ndarray, values: np.ndarray, most: int) -> list[int]:
    """The rows (from 0) from which on `values` (channels x rows x sizes, whitened) explain most of `left`, the readings
    and pulls that a fit leaves: the best one, the best beside that one, and so on up to `most`. One pass over the
    readings costs rows x parameters of the fit."""
    readings, pulls = record.measured.size, left.size - record.measured.size
    out = np.vstack([record.taken_out, np.zeros((pulls, record.taken_out.shape[1]))])
    basis, rest, found = np.hstack([remover.basis, _beside(remover.basis, out)]), left, []
    for _ in range(most):
        gains = _gains(record, basis, rest, values)
        row = int(np.argmax(gains))
        if gains[row] <= 0.0:
            break
        found.append(row)
        step = values.copy()
        step[:, :row] = 0.0
        columns = np.vstack([step.reshape(readings, -1), np.zeros((pulls, values.shape[2]))])
        added = _beside(basis, columns)
        basis, rest = np.hstack([basis, added]), rest - added @ (added.T @ rest)
    return found


def _beside(basis: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """What columns hold beside a basis, orthonormal."""
    added, _ = np.linalg.qr(columns - basis @ (basis.T @ columns))
    return np.asarray(added)


def _gains(record: Record, basis: np.ndarray, left: np.ndarray, values: np.ndarray) -> np.ndarray:
    """What chi squared loses by a step at each row, with all that `basis` spans refitted."""
    shape, readings = record.measured.shape, record.measured.size
    along = _from_here_on(np.einsum("crs,cr->rs", values, left[:readings].reshape(shape)))
    inside = _from_here_on(np.einsum("crk,crs->rks", basis[:readings].reshape(*shape, -1), values))
    whole = _from_here_on(np.einsum("crs,crt->rst", values, values))
    power = whole - np.einsum("rks,rkt->rst", inside, inside)
    seen = np.all(np.diagonal(power - LEAST_SHARE * whole, axis1=1, axis2=2) > 0.0, axis=1)
    seen[0] = False  # from the first reading on: no step
    gains = np.zeros(shape[1])
    solved = np.linalg.pinv(power[seen], rcond=LEAST_SHARE, hermitian=True)
    gains[seen] = np.einsum("rs,rst,rt->r", along[seen], solved, along[seen])
    return gains


def _from_here_on(by_row: np.ndarray) -> np.ndarray:
    """Sums over the rows from each one to the last."""
    return np.asarray(np.cumsum(by_row[::-1], axis=0)[::-1])
