"""Forward selection: the column that gains most, as long as an information criterion says that it pays."""

from __future__ import annotations

import math

import numpy as np

from baselines.answer import Answer, answer, refitted
from baselines.knobs import Knobs, Space, between, evenly, one_of
from baselines.signatures import Signatures

SPACE = Space(
    {"penalty": 1.0, "library": 0.0, "noise": "given", "most": 6, "backward": False, "screened": False,
     "signed": True, "unknown_p": 0.0},
    {
        "penalty": between(0.5, 4.0),
        "library": evenly(0.0, 2.0),
        "noise": one_of("given", "estimated"),
        "most": one_of(3, 4, 6),
        "backward": one_of(False, True),
        "screened": one_of(False, True),
        "signed": one_of(True, True, False),
        "unknown_p": one_of(0.0, 1e-12, 1e-8, 1e-5, 1e-3),
    },
)  # fmt: skip


def forward_bic(sig: Signatures, knobs: Knobs) -> Answer:
    """BIC times `penalty`, with the extended criterion's share for the size of the library."""
    allowed = sig.screened if knobs["screened"] else np.arange(len(sig.columns))
    price = knobs["penalty"] * math.log(sig.readings) + 2.0 * knobs["library"] * math.log(len(allowed))
    one_sided = np.array([sig.columns[i].one_sided for i in allowed])
    columns = sig.matrix[:, allowed]
    chosen: list[int] = []
    off, basis = sig.left, np.empty((len(sig.left), 0))
    squares = float(off @ off)
    while len(chosen) < knobs["most"]:
        bare = columns - basis @ (basis.T @ columns)
        length = np.linalg.norm(bare, axis=0)
        along = np.divide(bare.T @ off, length, out=np.zeros(len(allowed)), where=length > 1e-2)
        if knobs["signed"]:
            along[one_sided & (along < 0.0)] = 0.0
        best = int(np.argmax(np.abs(along)))
        after = squares - float(along[best]) ** 2
        if _worth(squares, after, sig.readings, knobs["noise"]) < price:
            break
        chosen.append(int(allowed[best]))
        basis = np.column_stack([basis, bare[:, best] / length[best]])
        off, squares = off - basis[:, -1] * along[best], after
        if knobs["backward"]:
            chosen, dropped = _dropped(sig, chosen, price, knobs["noise"])
            if dropped:
                basis, _ = np.linalg.qr(sig.matrix[:, chosen])
                off = sig.left - basis @ (basis.T @ sig.left)
                squares = float(off @ off)
                break  # what was dropped would come back
    return answer(sig, chosen, knobs["unknown_p"], knobs["signed"])


def _worth(before: float, after: float, readings: int, noise: str) -> float:
    """Twice the gain in log likelihood, with the noise as given or as what is left."""
    return before - after if noise == "given" else readings * math.log(before / after)


def _dropped(sig: Signatures, chosen: list[int], price: float, noise: str) -> tuple[list[int], bool]:
    """Without those that do not pay any more."""
    dropped = False
    while len(chosen) > 1:
        squares = refitted(sig, chosen)[1]
        without = [refitted(sig, [i for i in chosen if i != one])[1] for one in chosen]
        worst = int(np.argmin(without))
        if _worth(without[worst], squares, sig.readings, noise) >= price:
            break
        chosen = [i for k, i in enumerate(chosen) if k != worst]
        dropped = True
    return chosen, dropped
