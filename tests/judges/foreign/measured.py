"""Public measured joint tests: what their authors report, and the largest amplitude predicted from the others.

BRACE_REAL_DATA names their folder (README.md there says whose they are and what is known of them). They are never
copied into the repository; without the folder this part is left out, and the page says so."""

from __future__ import annotations

import hashlib
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
from verdicts import intervals

HERE = Path(__file__).resolve().parent
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


def amplitudes(columns: dict[str, Array]) -> list[Rows]:
    """The rows of each amplitude: tests whose command swings by the same, within a fifth; whose angle does, where no
    command was recorded."""
    test = columns["test"]
    asked = columns.get("command_n_mm", columns["angle_rad"])
    swing = {t: float(np.ptp(asked[test == t])) for t in np.unique(test)}
    groups: list[list[float]] = []
    for t in sorted(swing, key=lambda t: swing[t]):
        if groups and swing[t] < 1.2 * swing[groups[-1][0]]:
            groups[-1].append(t)
        else:
            groups.append([t])
    return [np.isin(test, group) for group in groups]


@dataclass
class LeftOut:
    """rms on the amplitude that was left out [N mm]: of the tool's model, of the five-parameter fit."""

    name: str
    swing_rad: float  # the angle's, of the amplitude left out
    tool: float | None  # None: its model cannot be played
    five: float
    deviation: float  # of the torque there

    @property
    def ratio(self) -> float | None:
        """At most 1.05 is wanted."""
        return None if self.tool is None else self.tool / self.five


def _predicted(part: dict[str, Array], limb: Path, work: Path) -> Array:
    """`brace predict` of some rows, averaged as the points are. Nothing where it refuses."""
    from brace.dataset import load_dataset
    from brace.ground.errors import BraceError
    from brace.model import load_limb
    from brace.rig.predict import predict

    write(work, "left out", Record(dict(part)))
    try:
        torque = predict(load_dataset(work), load_limb(limb)).columns["torque_n_mm"]
    except BraceError:
        return np.empty(0)
    own = {"angle_rad": part["angle_rad"], "torque_n_mm": np.asarray(torque, dtype=float), "test": part["test"]}
    return five.points_of(own).torque


def leave_out(name: str, columns: dict[str, Array], left: Rows, work: Path) -> LeftOut:
    """Both models learn from the rest. What is a record's own, not a joint's, is fitted to the rows that judge, for
    both: the zeros of angle and torque, and the angle over which friction turns."""
    rest, unseen = some(columns, ~left), some(columns, left)
    write(work / "rest", f"{name} without one amplitude", Record(dict(rest)))
    diagnoser.diagnose(work / "rest", work / "out", report=False)
    judged = five.points_of(unseen)
    numbers, _ = five.fit(five.points_of(rest))
    best = five.aligned_rms(numbers, judged)
    limb = work / "out" / "limb.toml"
    tool: float | None = None
    if limb.exists():
        torque = _predicted(unseen, limb, work / "played")
        if len(torque):
            tool = float(np.sqrt(np.mean((torque - judged.torque)[judged.counts] ** 2)))
    swing = max(float(np.ptp(unseen["angle_rad"][unseen["test"] == t])) for t in np.unique(unseen["test"]))
    return LeftOut(name, swing, tool, best, float(np.std(judged.torque)))


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
        found_here = list(intervals(found[name]))
        for leaf, value in AUTHORS.items():
            here = [low <= value <= high for n, low, high in found_here if n == leaf]
            out.append((name, f"an interval of {leaf} holds the authors' {value:g}", any(here)))
    names = [sorted(e["name"] for e in found[name].get("effects", []) if e["confidence"] >= 0.9) for name in GEARS]
    out.append(
        (" ".join(GEARS), "the same names with 0.9 or more at three gear positions", names[0] == names[1] == names[2])
    )
    out.append(("cycloidal_base", "the drive's limit is reported", bool(found["cycloidal_base"].get("data_faults"))))
    for name in (*GEARS, *OTHERS):
        gaps = _values(found[name], "gap_rad")
        out.append(
            (name, f"no gap above the swing of its {swings[name] * 1e3:.0f} mrad", all(g < swings[name] for g in gaps))
        )
    small = _values(found["cycloidal_split_reassembled"], "gap_rad")
    out.append(
        ("cycloidal_split_reassembled", "no gap above the 31 mrad of its small ramps", all(g < 0.031 for g in small))
    )
    preloaded = _values(found["cycloidal_preloaded"], "gap_rad")
    base = [g for name in GEARS for g in _values(found[name], "gap_rad")]
    smaller = bool(base) and (not preloaded or max(preloaded) < float(np.median(base)))
    out.append(("cycloidal_preloaded", "less play than without preload", smaller))
    rubs = _values(found["cycloidal_preloaded"], "coulomb_n_mm")
    usual = [f for name in GEARS for f in _values(found[name], "coulomb_n_mm")]
    out.append(
        (
            "cycloidal_preloaded",
            "more friction than without preload",
            bool(rubs and usual) and max(rubs) > float(np.median(usual)),
        )
    )
    polymer = _values(found["cycloidal_polymer"], "gap_rad")
    out.append(("cycloidal_polymer", "no gap of 9 to 20 degrees", all(g < 0.15 for g in polymer)))
    out.append((DAMPER, "no hardening with 0.8 or more", not _sure(found[DAMPER], "joint_hardening")))
    slips = any(e["name"] in ("series_slip", "backlash") for e in found[DAMPER].get("effects", []))
    out.append(
        (DAMPER, "free travel is named, or the verdict is unknown", slips or found[DAMPER].get("verdict") == "unknown")
    )
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
        found_here = list(intervals(read(work / f"without-{left}-out")))
        numbers, _ = five.fit(five.points_of(every[left]))
        for leaf, value in zip(("compliance_rad_per_n_mm", "gap_rad", "coulomb_n_mm"),
                               (1.0 / numbers[0], numbers[1], numbers[2]), strict=True):  # fmt: skip
            here = [low <= value <= high for n, low, high in found_here if n == leaf]
            out.append((f"{left}: {leaf} {value:.3g}", any(here) if here else None))
    return out


def read(out: Path) -> dict[str, Any]:
    """A diagnosis, or nothing."""
    path = out / "diagnosis.json"
    return dict(json.loads(path.read_text())) if path.exists() else {}


def all_of(where: Path, work: Path, progress: Callable[[str], None]) -> dict[str, Any]:
    """Everything of this part; kept in `work`."""
    made_by = b"".join((HERE / name).read_bytes() for name in ("measured.py", "five.py"))
    kept = work / f"measured-{hashlib.sha256(made_by).hexdigest()[:8]}.json"
    if kept.exists():
        return dict(json.loads(kept.read_text()))
    work.mkdir(parents=True, exist_ok=True)
    found, left, swings = {}, [], {}
    for name in SETS:
        progress(name)
        if not (where / name / "data.csv").exists():
            continue
        diagnoser.diagnose(where / name, work / name / "whole", report=False)
        found[name] = read(work / name / "whole")
        columns = columns_of(where / name)
        swings[name] = float(np.ptp(columns["angle_rad"]))
        for number, rows in enumerate(amplitudes(columns)):
            one = leave_out(name, columns, rows, work / name / str(number))
            left.append({"set": name, "left_out_mrad": 1e3 * one.swing_rad, "tool": one.tool, "five": one.five,
                         "ratio": one.ratio, "deviation": one.deviation})  # fmt: skip
    result = {
        "left_out": left,
        "checks": _checks(found, swings) if set(SETS) <= set(found) else [],
        "positions": _position_left_out(where, work) if set(GEARS) <= set(found) else [],
        "said": {
            name: {"verdict": d.get("verdict"), "effects": [(e["name"], e["confidence"]) for e in d.get("effects", [])]}
            for name, d in found.items()
        },
    }  # fmt: skip
    kept.write_text(json.dumps(result, indent=1) + "\n")
    return dict(json.loads(kept.read_text()))
