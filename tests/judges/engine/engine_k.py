"""K under load that a named diagnosis exports, against the engine's limb: nearer than the believed one?"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import diagnoser
import numpy as np
from engine_plant import k_under_load
from many_rests import NoRest
from plant import INDEX, LINKS, NEUTRAL, Array

POSTURES = 15
THETA_RAD = (-0.3, 0.5), (1.7, 2.6)  # least, most of both angles
FORCE_N = 4.0, 20.0
MOST_OFF_ROUND = 60.0  # of K's eigenvalues; beyond it and near giving way no figures are promised
SEED = 9_041


def limb_of(parameters: dict[str, Any]) -> Array:
    """A limb from an answer's true parameters."""
    p = NEUTRAL.copy()
    for key, value in parameters.items():
        p[INDEX[key]] = float(LINKS.index(value)) if key == "change.link" else float(value)
    return p


def postures(p: Array, draw: np.random.Generator) -> tuple[Array, Array, Array]:
    """Commanded angles, forces on the tip, and the true K there, of rests that do not give way."""
    theta, force, k = [], [], []
    for _ in range(40 * POSTURES):
        at = draw.uniform(*THETA_RAD)[None, :]
        angle = draw.uniform(0.0, 2.0 * np.pi)
        push = draw.uniform(*FORCE_N) * np.array([[np.cos(angle), np.sin(angle)]])
        try:
            loaded, free = k_under_load(p, at, push)[0], k_under_load(p, at, 0.0 * push)[0]
        except (NoRest, np.linalg.LinAlgError):
            continue
        least, most = np.linalg.eigvalsh(loaded)
        if 0.5 * np.linalg.eigvalsh(free)[0] < least and most < MOST_OFF_ROUND * least:
            theta.append(at[0])
            force.append(push[0])
            k.append(loaded)
        if len(k) == POSTURES:
            break
    return np.array(theta), np.array(force), np.array(k)


def errors(truth: dict[str, Any], believed: Path, exported: Path) -> dict[str, float]:
    """Median over loaded postures of how far K is off (Frobenius, relative), as believed and as exported."""
    draw = np.random.default_rng([SEED, truth["seed"], truth["index"]])
    theta, force, true_k = postures(limb_of(truth["true_parameters"]), draw)
    size = np.linalg.norm(true_k, axis=(1, 2))
    found = {}
    for which, limb in (("believed", believed), ("exported", exported)):
        off = np.linalg.norm(diagnoser.k_under_load(limb, theta, force) - true_k, axis=(1, 2)) / size
        found[which] = float(np.median(np.nan_to_num(off, nan=1.0)))
    return found


def judge(root: Path, name: str, out: Path) -> None:
    """Of a single effect or a pair that was named and exported: writes k_under_load.json beside the diagnosis."""
    truth = json.loads((root / "answers" / name / "truth.json").read_text())
    said = out / "diagnosis.json"
    if truth["kind"] not in ("single", "pair") or not said.exists():
        return
    diagnosis = json.loads(said.read_text())
    if diagnosis["verdict"] in ("effect", "ambiguous") and diagnosis["exported"]:
        found = errors(truth, root / "cases" / name / "limb.toml", out / "limb.toml")
        (out / "k_under_load.json").write_text(json.dumps(found))
