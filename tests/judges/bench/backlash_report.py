"""The preload state machine beside direction-of-motion compensation: figures, limits and backlash.svg.

Runs the histories of tests/property/backlash_histories.py on the reported seeds, and its oracle on the first of them.
"""

import ctypes
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "property"))

import backlash_floor as floor  # noqa: E402
import backlash_histories as histories  # noqa: E402
from backlash_picture import draw  # noqa: E402
from extra import Extra  # noqa: E402
from limits import Check  # noqa: E402

HISTORIES = 1000
ORACLE_HISTORIES, PARTICLES = 20, 1000
EXAMPLE_SEED = histories.REPORTED_SEED + 12
SHARES = (0.5, 0.9, 0.95, 0.99)

NOTE = """\
# Backlash: which side is loaded

A simulated joint with a gap of 0.1-1.5 degrees, friction, gravity, 5 % noise on the current, 1,000 random histories
of rest, moves, swings, pressing, drifting loads and impacts; the machine believes a gap up to 20 % wrong. Beside it what
machine tools do: half the gap against the last direction of motion, commanded or read from the encoder. The crossing:
the ticks with the gap open, and 52 ms after each. With the gap believed 20 % wrong, the right side alone leaves up to
0.1 gaps.

At every tick at which the machine decides a side, 95 % of the errors are within a tenth of the gap. The same holds at
every tick at which a side touches, decided or not. Where the machine decides none, its guess is applied all the same: over
all ticks the errors are larger, and there is no limit on them, because nobody who only looks on can keep one. The oracle
shows it: a particle filter that knows every parameter of joint and link exactly, the gap too, and the motor's motion
without quantisation, but not what the world does. While the gap is open and the motor rests within its friction, nothing
of the link reaches the motor's side. What a motor could find that leaves its setpoint to feel for the side:
[backlash.md](backlash.md).

![wrong sides, angle errors, one history](backlash.svg)"""


@dataclass(frozen=True)
class Comparison:
    """What one run found."""

    counts: histories.HistoryCounts
    off: histories.HistoryCounts  # the gap exactly 20 % off
    oracle: floor.OracleCounts
    held: histories.TakeupCounts
    free: histories.TakeupCounts
    example: dict[str, np.ndarray]


def compare() -> Comparison:
    """Compile, run."""
    lib, first = histories.library(), histories.REPORTED_SEED
    return Comparison(histories.histories(lib, first, HISTORIES, exact=False, expecting=False),
                      histories.histories(lib, first, HISTORIES, exact=True, expecting=False),
                      floor.oracle(lib, first, ORACLE_HISTORIES, PARTICLES, exact=False, known=False),
                      histories.takeups(lib, first, HISTORIES, held=True),
                      histories.takeups(lib, first, HISTORIES, held=False), histories.trace(lib, EXAMPLE_SEED))


def _percentiles(bins: "ctypes.Array[ctypes.c_double]") -> list[float]:
    return [histories.percentile(bins, share) for share in SHARES]


def _errors(c: Comparison) -> dict[str, tuple["ctypes.Array[ctypes.c_double]", float]]:
    """Name -> errors, and of how many ticks they are."""
    out = {f"machine, {histories.ERROR_FIELDS[field]}": getattr(c.counts, field)
           for field in ("valid_only", "decided", "outside_crossing", "touching", "all")}
    out["oracle, all ticks"] = c.oracle.error
    out["by direction, commanded, all ticks"] = c.counts.cnc_command
    out["by direction, encoder, all ticks"] = c.counts.cnc_encoder
    return {name: (bins, float(np.sum(bins))) for name, bins in out.items()}


def _checks(c: Comparison) -> list[Check]:
    n = c.counts
    wrong, cnc = 100.0 * n.wrong / n.judged, 100.0 * min(n.cnc_command_wrong, n.cnc_encoder_wrong) / n.judged
    valid, decided, touching, outside, off = (
        histories.percentile(bins, 0.95)
        for bins in (n.valid_only, n.decided, n.touching, n.outside_crossing, c.off.outside_crossing))
    late = n.late_valid + c.off.late_valid
    done, count = c.held.really_done, float(HISTORIES)
    over = sum(getattr(t, name) for t in (c.held, c.free) for name in ("torque_over", "travel_over", "time_over", "not_idle"))
    return [
        Check("backlash: side wrong, of the ticks outside the crossing", f"{wrong:.3f} %", "at most 0.2 %",
              wrong <= 0.2),
        Check("backlash: times fewer wrong ticks than by direction of motion", f"{cnc / wrong:,.0f}", "at least 10",
              cnc >= 10.0 * wrong),
        Check(f"backlash: ticks valid with the gap open beyond {n.detection_us_max / 1000.0:.0f} ms", f"{late:.0f}", "none",
              late == 0.0),
        Check("backlash: angle error reported valid, 95th percentile", f"{valid:.3f} gaps", "at most 0.1 gaps", valid <= 0.1),
        Check("backlash: angle error at every tick with a side decided, 95th percentile", f"{decided:.3f} gaps",
              "at most 0.1 gaps", decided <= 0.1),
        Check("backlash: angle error at every tick with a side touching, 95th percentile", f"{touching:.3f} gaps",
              "at most 0.1 gaps", touching <= 0.1),
        Check("backlash: angle error outside the crossing, 95th percentile", f"{outside:.3f} gaps", "at most 0.1 gaps",
              outside <= 0.1),
        Check("backlash: outside the crossing, the gap believed exactly 20 % off", f"{off:.3f} gaps", "at most 0.1 gaps", off <= 0.1),
        Check("backlash: take-ups that succeed", f"{100.0 * done / count:.1f} %", "at least 99.9 %", done >= 0.999 * count),
        Check("backlash: take-ups beyond a bound", f"{over:.0f}", "none", over == 0.0),
    ]


def extra(folder: Path) -> Extra:
    """Everything of it for the bench; draws backlash.svg into the folder."""
    c = compare()
    n = c.counts
    draw(n, c.oracle, c.example, folder / "backlash.svg")
    flanks = [("machine, decided", n.wrong), ("machine, decided or guessed, at every tick", n.best_wrong),
              ("by direction, commanded", n.cnc_command_wrong), ("by direction, encoder", n.cnc_encoder_wrong)]
    errors = _errors(c)
    tables = [
        ("Which side is loaded: wrong, of the ticks outside the crossing", ["who says it", "wrong"],
         [[name, f"{100.0 * value / n.judged:.3f} %"] for name, value in flanks] +
         [["oracle, at every tick", f"{100.0 * c.oracle.flank_wrong / c.oracle.judged:.3f} %"],
          ["machine, not decided", f"{100.0 * n.withheld / n.judged:.1f} %"]]),
        ("Angle error from backlash, in gaps", ["who, where", *(f"{100 * s:.0f} % within" for s in SHARES), "beyond a tenth",
                                               "of the ticks"],
         [[name, *(f"{p:.3f}" for p in _percentiles(bins)), f"{100.0 * histories.beyond_a_tenth(bins):.1f} %",
           f"{total / (c.oracle.ticks if 'oracle' in name else n.ticks) * 100.0:.0f} %"]
          for name, (bins, total) in errors.items()]),
    ]
    data: dict[str, object] = {
        "histories": HISTORIES, "first_seed": histories.REPORTED_SEED, "oracle_histories": ORACLE_HISTORIES,
        "open_ratio": round(n.open / n.ticks, 5), "valid_ratio": round(n.valid / n.ticks, 5),
        "wrong_ratio": {name: round(value / n.judged, 7) for name, value in flanks},
        "angle_error_gaps": {name: dict(zip([f"p{100 * s:.0f}" for s in SHARES], _percentiles(bins), strict=True))
                             for name, (bins, _) in errors.items()},
        "takeups_done_ratio": c.held.really_done / HISTORIES,
    }
    return Extra("backlash", NOTE, tables, _checks(c), data)


if __name__ == "__main__":
    found = extra(Path.cwd())
    for title, heads, rows in found.tables:
        print(title, heads, *rows, sep="\n  ")
    for check in found.checks:
        print(check.verdict, check.name, check.measured, check.required)
    sys.exit(any(not check.passed for check in found.checks))
