"""Where a limb and a table disagree: by entry, folded against stretched; signs drawn anew row by row."""

from __future__ import annotations

import numpy as np

from brace.diagnose.diagnosis import Localised

DRAWS = 1999
LEVEL = 0.05


def localise(
    off_n_per_mm: np.ndarray, sigma: np.ndarray, r_mm: np.ndarray, random: np.random.Generator
) -> tuple[Localised, ...]:
    """The contrasts that stand out at one family-wise level, strongest first."""
    size = off_n_per_mm / sigma
    reach = np.argsort(np.argsort(r_mm)) / max(len(r_mm) - 1, 1) * 2.0 - 1.0
    parts, names, sizes = [], [], []
    for place, entry in enumerate(("k_xx", "k_xz", "k_zz")):
        column = size[:, place]
        sign = "too soft" if column.sum() > 0 else "too stiff"
        for name, weight in (
            (
                (
                    f"{entry} at all postures: the model is {sign}"
                    if entry != "k_xz"
                    else f"{entry} at all postures"
                ),
                1.0,
            ),
            (f"{entry}, one way when folded and the other when stretched", reach),
            (f"{entry}, most when folded", np.maximum(-reach, 0.0)),
            (f"{entry}, most when stretched", np.maximum(reach, 0.0)),
        ):
            weights = np.broadcast_to(np.asarray(weight, dtype=float), column.shape)
            parts.append(weights * column)
            names.append(name)
            used = weights != 0.0
            sizes.append(float(np.sqrt(np.mean(off_n_per_mm[used, place] ** 2))))
    table = np.column_stack(parts)
    scale = np.sqrt((table**2).sum(axis=0)) + 1e-12
    seen = np.abs(table.sum(axis=0)) / scale
    signs = random.choice([-1.0, 1.0], size=(DRAWS, len(table)))
    most = (np.abs(signs @ table) / scale).max(axis=1)
    p = (1.0 + (most[:, None] >= seen[None, :] - 1e-9).sum(axis=0)) / (DRAWS + 1.0)
    found = [Localised(name, float(p[i]), sizes[i]) for i, name in enumerate(names) if p[i] <= LEVEL]
    return tuple(sorted(found, key=lambda one: (one.p, -one.size)))
