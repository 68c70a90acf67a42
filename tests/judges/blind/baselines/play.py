"""A baseline's chosen effects, fitted on the plant like the tool's own, played on configurations it never saw."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from baselines.answer import Answer
from baselines.signatures import Array, Signatures

FORCES = ("fx_n", "fz_n")


class Unseen:
    """The hold-out of one case: its rows and its forces, noise-free [N]."""

    def __init__(self, folder: Path) -> None:
        from brace.dataset import load_dataset
        from brace.identify.playing import player_of

        self.data = load_dataset(folder)
        self.forces = np.stack([np.asarray(self.data[name], float) for name in FORCES])
        self._player = player_of(self.data, FORCES, zeroed=self.data.meta.zeroed_per_run)

    def played(self, numbers: Array) -> Array:
        """Forces of a limb's numbers, 2 x rows [N]."""
        return np.asarray(self._player.play_numbers(numbers[None])[0], float)

    def gap_n(self, forces: Array) -> float:
        """rms over both axes [N]; infinite where the limb cannot be played."""
        gap = float(np.sqrt(np.mean((forces - self.forces) ** 2)))
        return gap if np.isfinite(gap) else np.inf


def fitted_numbers(ready: Any, sig: Signatures, said: Answer) -> Array:
    """The believed limb with the chosen effects, fitted on the record from the sizes that least squares gave them."""
    from brace.effects import Variant, all_variants
    from brace.diagnose.loading.fit import fit
    from brace.identify.record import setting_of
    from brace.diagnose.loading.space import compatible, space_of

    given, record, trust, base = ready
    catalogue = all_variants(setting_of(record, given.believed))
    chosen = sorted(zip(said.chosen, said.coefficients, strict=True), key=lambda pair: -abs(pair[1]))
    values = dict(zip(base.space.keys, (float(x) for x in base.x), strict=True))
    wanted: dict[str, set[str]] = {}
    for i, coefficient in reversed(chosen):  # the strongest try of a key has the last word
        column = sig.columns[i]
        values.update(column.values(coefficient))
    for i, _ in chosen:
        wanted.setdefault(sig.columns[i].label, set()).update(sig.columns[i].keys)
    variants: list[Variant] = []
    for label, keys in wanted.items():
        fitting = [v for v in catalogue if v.label == label and keys <= {f.key for f in v.freedoms}]
        if fitting:
            best = min(fitting, key=lambda v: len(v.freedoms))
            if compatible((*variants, best)):
                variants.append(best)
    if not variants:
        return np.asarray(base.model, float)
    space = space_of(trust, variants)
    start = np.array([values.get(key, mean) for key, mean in zip(space.keys, space.mean, strict=True)])
    return np.asarray(fit(record, space, start, final=False).model, float)
