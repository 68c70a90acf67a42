"""How much of the gap anybody could close: the truth's own parameters fitted to the noisy record, played elsewhere.

Noise and the calibration's slack leave a gap on unseen configurations even to somebody who knows what is
hidden. What a tool closes is shown beside that."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
from generate import clean_readings, ingredients
from worlds import world_called


def gaps(root: Path, name: str) -> dict[str, float]:
    """rms of force on the holdout [N]: of the believed limb, and of the truth's effects fitted to the record."""
    kept = root / "best" / f"{name}.json"
    if kept.exists():
        found: dict[str, float] = json.loads(kept.read_text())
        return found
    answer = root / "answers" / name
    truth: dict[str, Any] = json.loads((answer / "truth.json").read_text())
    world, case = world_called(truth["world"]), ingredients(answer)
    shown, held, believed = case["shown"], case["held"], case["believed"]
    bench = world.bench(shown, believed, case["trust"])
    with (root / "cases" / name / "data.csv").open(newline="") as file:
        record = np.array([[float(row[c]) for c in shown.readings] for row in csv.DictReader(file)])
    fitted = bench.fit((record / bench.sigma).ravel(), case["limb"], truth["keys"], rounds=20)[1]
    real = held.seen(clean_readings(case, held.rows, world)[:, held.columns])[:, :2]
    found = {
        which: math.sqrt(float(np.mean((held.seen(world.play(limb, held.rows)[:, held.columns])[:, :2] - real) ** 2)))
        for which, limb in (("believed", believed), ("best", fitted))
    }
    kept.parent.mkdir(exist_ok=True)
    kept.write_text(json.dumps(found))
    return found
