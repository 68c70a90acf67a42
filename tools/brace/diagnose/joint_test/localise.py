"""Where a model disagrees with a joint test: fixed contrasts of the residuals, with one family-wise level.

If nothing disagreed, each stretch's residuals could as well have the other sign. So this step draws signs anew, and the
largest of all contrasts sets the level."""

from __future__ import annotations

import numpy as np

from brace.diagnose.diagnosis import Localised
from brace.diagnose.joint_test.evidence import stretches
from brace.diagnose.joint_test.record import JointRecord

DRAWS = 999
LEVEL = 0.05
SHOWN = 6


def localise(record: JointRecord, off_n_mm: np.ndarray, random: np.random.Generator) -> tuple[Localised, ...]:
    """The contrasts that stand out, strongest first."""
    used = record.fitted
    off = -off_n_mm[used]  # measured less model
    names, columns = _contrasts(record)
    weights = np.column_stack([column[used] for column in columns]).astype(float)
    spread = np.linalg.norm(weights, axis=0)
    weights, names = weights[:, spread > 0.0], [n for n, s in zip(names, spread) if s > 0.0]
    weights /= np.linalg.norm(weights, axis=0)
    number = stretches(record, off_n_mm)
    parts = np.zeros((int(number.max()) + 1, weights.shape[1]))
    np.add.at(parts, number, weights * off[:, None])
    scale = np.sqrt((parts**2).sum(axis=0)) + 1e-12
    seen = np.abs(parts.sum(axis=0)) / scale
    signs = random.choice([-1.0, 1.0], size=(DRAWS, parts.shape[0]))
    most = (np.abs(signs @ parts) / scale).max(axis=1)
    p = (1.0 + (most[:, None] >= seen[None, :] - 1e-9).sum(axis=0)) / (DRAWS + 1.0)
    size = np.abs(weights.T @ off) / np.sqrt((weights != 0.0).sum(axis=0))
    found = [Localised(name, float(p[i]), float(size[i])) for i, name in enumerate(names) if p[i] <= LEVEL]
    return tuple(sorted(found, key=lambda one: (one.p, -one.size))[:SHOWN])


def _contrasts(record: JointRecord) -> tuple[list[str], list[np.ndarray]]:
    """Each a column of weights over all averaged readings."""
    columns = record.columns
    angle, test, time = columns["angle_rad"], columns["test"], columns["t_s"]
    place = 2.0 * (angle - angle.min()) / max(float(np.ptp(angle)), 1e-30) - 1.0
    starts = np.concatenate([[True], np.diff(test) != 0])
    branch = np.sign(np.where(starts, 0.0, np.diff(angle, prepend=angle[0])))
    side = np.sign(place)
    outward, inward = branch * side > 0.0, branch * side < 0.0
    middle = np.abs(place) < 1.0 / 3.0
    far = np.abs(place) > 2.0 / 3.0
    late = np.where(time > np.median(time), 1.0, -1.0)
    level = np.abs(columns["torque_n_mm"])
    high = level > np.quantile(level, 0.66)
    listed: list[tuple[str, np.ndarray]] = [
        ("with the direction of motion", branch),
        ("with the direction of motion, under high load only", branch * high),
        ("with the direction of motion, near zero load only", branch * (level < np.quantile(level, 0.33))),
        ("only while loading, away from the middle", outward * side),
        ("only while unloading", inward * side),
        ("in the middle of the range, by which the torque rises there", middle * place),
        ("far from the middle, more than in proportion", far * side - middle * place),
        ("on one side more than on the other", place**2 - np.mean(place**2)),
        ("with time over the record", late),
        ("with time within the range's outer parts", late * far * side),
    ]
    for label in np.unique(test)[:12]:
        if np.unique(test).size > 1:
            listed.append((f"in test {label} against the others", (test == label) - np.mean(test == label)))
    if "temp_degc" in columns:
        warm = columns["temp_degc"] - columns["temp_degc"].mean()
        listed.append(("with temperature, in proportion to the load", warm * place))
    return [name for name, _ in listed], [np.asarray(values, dtype=float) for _, values in listed]
