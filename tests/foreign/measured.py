"""Public measured joint tests: what their authors report, and the largest amplitude predicted from the others.

BRACE_REAL_DATA names their folder (README.md there says whose they are and what is known of them). They are never
copied into the repository; without the folder this part is left out, and the page says so."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import diagnoser
import five
import numpy as np
import numpy.typing as npt
from actuator import Record, write
from plant import Array
from scipy.optimize import minimize_scalar
from verdicts import intervals

Rows = npt.NDArray[np.bool_]
GEARS = ("cycloidal_base", "cycloidal_base_pos5", "cycloidal_base_pos6")
OTHERS = ("cycloidal_preloaded", "cycloidal_polymer", "cycloidal_split_reassembled")
DAMPER = "friction_damper"
SETS = (*GEARS, *OTHERS, DAMPER)
AUTHORS = {"gap_rad": 0.0446, "compliance_rad_per_n_mm": 1.47e-6}  # of the three gear positions together


def folder() -> Path | None:
    """Where they lie, if they do."""
    named = os.environ.get("BRACE_REAL_DATA", "")
    return Path(named) if named and Path(named).is_dir() else None


def columns_of(path: Path) -> dict[str, Array]:
    """data.csv by columns."""
    with (path / "data.csv").open() as file:
        names = file.readline().strip().split(",")
        table = np.genfromtxt(file, delimiter=",")
    return {name: table[:, i] for i, name in enumerate(names)}


def some(columns: dict[str, Array], which: Rows) -> dict[str, Array]:
    """Some rows."""
    return {name: values[which] for name, values in columns.items()}


def large_tests(columns: dict[str, Array]) -> Rows:
    """Which rows are of the tests of the largest amplitude: of at least 0.8 of the largest angle's swing."""
    test = columns["test"]
    swing = {t: np.ptp(columns["angle_rad"][test == t]) for t in np.unique(test)}
    most = max(swing.values())
    return np.isin(test, [t for t, s in swing.items() if s > 0.8 * most])


@dataclass
class LeftOut:
    """rms on the amplitude that was left out [N mm]: of the tool's model, of the five-parameter fit."""

    name: str
    side: str
    tool: float
    five: float
    deviation: float  # of the torque there

    @property
    def ratio(self) -> float:
        """At most 1.05 is wanted."""
        return self.tool / self.five


def _averaged(points: five.Points, shift: float, out: Path) -> Path:
    """Points as a record for `brace predict`, the angle counted from a zero."""
    record = Record()
    for i, test in enumerate(points.tests):
        angle = points.angle[i] - shift
        record.add(t_s=np.arange(len(angle)) * 0.1 + 1e3 * i, angle_rad=angle, torque_n_mm=points.torque[i],
                   test=np.full(len(angle), float(test)))  # fmt: skip
    write(out, "averaged", record)
    return out


def _played(points: five.Points, limb: Path, shift: float, work: Path) -> Array:
    from brace.dataset import load_dataset
    from brace.model import load_limb
    from brace.predict import predict

    columns = predict(load_dataset(_averaged(points, shift, work)), load_limb(limb)).columns
    return np.asarray(columns["torque_n_mm"], dtype=float).reshape(points.angle.shape)


def leave_out(name: str, columns: dict[str, Array], left: Rows, side: str, work: Path) -> LeftOut:
    """Both models learn from the rest; their zeros of angle (and the tool's of torque) are the rest's, too."""
    rest, unseen = some(columns, ~left), some(columns, left)
    record = Record(dict(rest))
    write(work / "rest", f"{name} without its {side} amplitude", record)
    diagnoser.diagnose(work / "rest", work / "out", report=False)
    learnt, judged = five.points_of(rest), five.points_of(unseen)
    numbers, _ = five.fit(learnt)
    best = five.rms(numbers, judged)
    limb = work / "out" / "limb.toml"
    if not limb.exists():
        return LeftOut(name, side, float("inf"), best, float(np.std(judged.torque)))

    def off(shift: float) -> Array:
        return _played(learnt, limb, shift, work / "played") - learnt.torque

    def cost(shift: float) -> float:
        return float(np.std(off(shift)[learnt.counts]))

    reach = 0.5 * float(np.ptp(learnt.angle))
    middle = 0.5 * float(learnt.angle.max() + learnt.angle.min())
    shifts = middle + reach * np.linspace(-0.6, 0.6, 13)
    start = float(shifts[int(np.argmin([cost(s) for s in shifts]))])
    zero = float(minimize_scalar(cost, bounds=(start - 0.1 * reach, start + 0.1 * reach), method="bounded",
                                 options={"maxiter": 14}).x)  # fmt: skip
    torque_zero = float(np.mean(off(zero)[learnt.counts]))
    missed = _played(judged, limb, zero, work / "played") - torque_zero - judged.torque
    tool = float(np.sqrt(np.mean(missed[judged.counts] ** 2)))
    return LeftOut(name, side, tool, best, float(np.std(judged.torque)))


def _values(found: dict[str, Any], leaf: str) -> list[float]:
    out = []
    for effect in found.get("effects", []):
        for key, value in (effect.get("parameters") or {}).items():
            if key.endswith(leaf):
                out.append(float(value["value"]))
    return out


def _sure(found: dict[str, Any], name: str, confidence: float = 0.8) -> bool:
    return any(e["name"] == name and e["confidence"] >= confidence for e in found.get("effects", []))


def _checks(found: dict[str, dict[str, Any]], swings: dict[str, float]) -> list[tuple[str, str, bool]]:
    """Set, what its authors (or the record itself) say, and whether the diagnosis agrees."""
    out = []
    for name in GEARS:
        told = list(intervals(found[name]))
        for leaf, value in AUTHORS.items():
            here = [low <= value <= high for n, low, high in told if n == leaf]
            out.append((name, f"an interval of {leaf} holds the authors' {value:g}", any(here)))
    names = [sorted(e["name"] for e in found[name].get("effects", []) if e["confidence"] >= 0.9) for name in GEARS]
    out.append((" ".join(GEARS), "the same names with 0.9 or more at three gear positions", names[0] == names[1] == names[2]))
    out.append(("cycloidal_base", "the drive's limit is told", bool(found["cycloidal_base"].get("data_faults"))))
    for name in (*GEARS, *OTHERS):
        gaps = _values(found[name], "gap_rad")
        out.append((name, f"no gap above the swing of its {swings[name] * 1e3:.0f} mrad", all(g < swings[name] for g in gaps)))
    small = _values(found["cycloidal_split_reassembled"], "gap_rad")
    out.append(("cycloidal_split_reassembled", "no gap above the 31 mrad of its small ramps", all(g < 0.031 for g in small)))
    preloaded = _values(found["cycloidal_preloaded"], "gap_rad")
    base = [g for name in GEARS for g in _values(found[name], "gap_rad")]
    smaller = bool(base) and (not preloaded or max(preloaded) < float(np.median(base)))
    out.append(("cycloidal_preloaded", "less play than without preload", smaller))
    rubs = _values(found["cycloidal_preloaded"], "coulomb_n_mm")
    usual = [f for name in GEARS for f in _values(found[name], "coulomb_n_mm")]
    out.append(("cycloidal_preloaded", "more friction than without preload", bool(rubs and usual) and max(rubs) > float(np.median(usual))))
    polymer = _values(found["cycloidal_polymer"], "gap_rad")
    out.append(("cycloidal_polymer", "no gap of 9 to 20 degrees", all(g < 0.15 for g in polymer)))
    out.append((DAMPER, "no hardening with 0.8 or more", not _sure(found[DAMPER], "joint_hardening")))
    slips = any(e["name"] in ("series_slip", "backlash") for e in found[DAMPER].get("effects", []))
    out.append((DAMPER, "free travel is named, or the verdict is unknown", slips or found[DAMPER].get("verdict") == "unknown"))
    return out


def _position_left_out(where: Path, work: Path) -> list[tuple[str, bool | None]]:
    """Two gear positions in one record; do its intervals hold what the five-parameter fit of the third gives?"""
    out: list[tuple[str, bool | None]] = []
    every = {name: columns_of(where / name) for name in GEARS}
    for left in GEARS:
        record = Record()
        for i, name in enumerate(n for n in GEARS if n != left):
            columns = dict(every[name])
            columns["test"] = columns["test"] + 1000.0 * i
            columns["t_s"] = columns["t_s"] + 1e4 * i
            record.add(**columns)
        write(work / f"without-{left}", f"without {left}", record)
        diagnoser.diagnose(work / f"without-{left}", work / f"without-{left}-out", report=False)
        told = list(intervals(read(work / f"without-{left}-out")))
        numbers, _ = five.fit(five.points_of(every[left]))
        for leaf, value in zip(("compliance_rad_per_n_mm", "gap_rad", "coulomb_n_mm"),
                               (1.0 / numbers[0], numbers[1], numbers[2]), strict=True):  # fmt: skip
            here = [low <= value <= high for n, low, high in told if n == leaf]
            out.append((f"{left}: {leaf} {value:.3g}", any(here) if here else None))
    return out


def read(out: Path) -> dict[str, Any]:
    """A diagnosis, or nothing."""
    path = out / "diagnosis.json"
    return dict(json.loads(path.read_text())) if path.exists() else {}


def all_of(where: Path, work: Path, progress: Callable[[str], None]) -> dict[str, Any]:
    """Everything of this part; kept in `work`."""
    kept = work / "measured.json"
    if kept.exists():
        return dict(json.loads(kept.read_text()))
    found, left, swings = {}, [], {}
    for name in SETS:
        progress(name)
        if not (where / name / "data.csv").exists():
            continue
        diagnoser.diagnose(where / name, work / name / "whole", report=False)
        found[name] = read(work / name / "whole")
        columns = columns_of(where / name)
        swings[name] = float(np.ptp(columns["angle_rad"]))
        large = large_tests(columns)
        for side, rows in (("largest", large), ("smaller", ~large)):
            one = leave_out(name, columns, rows, side, work / name / side)
            left.append({"set": name, "left out": side, "tool": one.tool, "five": one.five, "ratio": one.ratio,
                         "deviation": one.deviation})  # fmt: skip
    result = {
        "left_out": left,
        "checks": _checks(found, swings) if set(SETS) <= set(found) else [],
        "positions": _position_left_out(where, work) if set(GEARS) <= set(found) else [],
        "said": {name: {"verdict": d.get("verdict"), "effects": [(e["name"], e["confidence"]) for e in d.get("effects", [])]}
                 for name, d in found.items()},
    }  # fmt: skip
    kept.write_text(json.dumps(result, indent=1) + "\n")
    return dict(json.loads(kept.read_text()))
