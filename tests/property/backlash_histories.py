"""The preload state machine against a simulated joint, beside direction-of-motion compensation.

1,000 random histories of 6 s at 1 kHz: rest, point-to-point moves, swings, pressing on a held link, slow load drifts,
impacts; random gap (0.1-1.5 degrees, believed 20 % wrong), Coulomb friction before and behind the gap, gravity, current
noise of 5 % of range (one sigma a tick), an offset of 0.5 %. The simulation (backlash_plant.c) shares no code with the
firmware. The crossing itself, from the simulation's truth: the ticks with the gap open, and after each the stated
detection time (52 ms). All other ticks are judged; where no flank is decided is counted apart ("withheld"), and once more by the
best guess (the sign of the offset), which is always there.

The motor's friction is the same at rest as in motion there. Gears stick (backlash_measured.py): two more runs take up to twice as
much to break away, once with a machine that knows nothing of it, once with one that is given it as docs/backlash.md says.

The report has the angle error of five sets of ticks: all of them, those in which a side touches, those outside the
crossing, those in which the machine decides a side, and those that it calls valid. With the gap believed 20 % wrong the
right side alone leaves up to a tenth of the gap. Over all ticks, those with an open gap among them, there is no
bound: a machine that only watches the joint cannot reach a tenth (backlash_floor.py).

Seeds 1-1000 were used while the machine was made; the figures reported come from seeds 1,000,001 on. Exit code 1 when
a bound is not met.
"""
from __future__ import annotations

import argparse
import ctypes
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
CORE = HERE.parents[1] / "firmware" / "core"
SOURCES = [*sorted((CORE / "src").glob("backlash/backlash*.c")), CORE / "src" / "base" / "check.c",
           *(HERE / f"backlash_{name}.c" for name in ("plant", "history", "run", "oracle", "measured"))]
BINS = 12_000
HISTORY_FIELDS = ["ticks", "open", "excluded", "judged", "wrong", "withheld", "best_wrong", "valid", "valid_wrong",
                  "late_valid", "longest_valid_open_us", "cnc_command_wrong", "cnc_encoder_wrong", "detection_us_max",
                  "open_longest_us"]
ERROR_FIELDS = {"all": "all ticks", "touching": "a side touching", "outside_crossing": "outside the crossing",
                "decided": "a side decided", "valid_only": "reported valid", "cnc_command": "by commanded direction, all ticks",
                "cnc_encoder": "by the encoder's direction, all ticks"}
TRACE_FIELDS = ["t_s", "offset_rad", "corrected_rad", "cnc_command_rad", "cnc_encoder_rad", "load_n_mm", "truth", "flank",
                "valid", "kind"]
HISTORY_TICKS = 6000
TAKEUP_FIELDS = ["done", "really_done", "ok", "torque", "travel", "reach", "time", "verify", "lost", "fault",
                 "torque_over", "travel_over", "time_over", "not_idle", "preload_error", "preload_error_max"]
REPORTED_SEED = 1_000_001
SLIPS, STICKS_UNKNOWN, STICKS_ALLOWED = range(3)  # breakaway_t


class HistoryCounts(ctypes.Structure):
    _fields_ = [*((name, ctypes.c_double) for name in HISTORY_FIELDS),
                *((name, ctypes.c_double * BINS) for name in ERROR_FIELDS)]


class TakeupCounts(ctypes.Structure):
    _fields_ = [(name, ctypes.c_double) for name in TAKEUP_FIELDS]


def library() -> ctypes.CDLL:
    """Machine and simulation, compiled with $CC (cc)."""
    with tempfile.TemporaryDirectory(prefix="brace-backlash-") as folder:
        path = Path(folder) / "libbacklash.so"
        subprocess.run([os.environ.get("CC", "cc"), "-std=c11", "-O2", "-ffp-contract=off", "-fno-math-errno", "-fPIC",
                        "-shared", f"-I{CORE / 'include'}", f"-I{CORE / 'src'}", *map(str, SOURCES), "-o", str(path),
                        "-lm"], check=True)
        return ctypes.CDLL(str(path))


def percentile(bins: ctypes.Array[ctypes.c_double], share: float) -> float:
    """In gaps, to 0.0001."""
    total = np.cumsum(np.array(bins))
    return float(np.searchsorted(total, share * total[-1])) / 10_000.0


def beyond_a_tenth(bins: ctypes.Array[ctypes.c_double]) -> float:
    """Share of the errors above a tenth of the gap."""
    count = np.array(bins)
    return float(count[1001:].sum() / count.sum())


def histories(lib: ctypes.CDLL, first: int, count: int, exact: bool, expecting: bool, breakaway: int = SLIPS,
              reach_gaps: float = 0.0) -> HistoryCounts:
    """reach_gaps: how far the motor may leave its setpoint to feel for a flank, in gaps."""
    counts = HistoryCounts()
    for seed in range(first, first + count):
        status = lib.backlash_history(ctypes.c_uint64(seed), int(exact), int(expecting), breakaway,
                                      ctypes.c_double(reach_gaps), ctypes.byref(counts), None)
        assert status == 0, f"seed {seed}: status {status}"
    return counts


def trace(lib: ctypes.CDLL, seed: int) -> dict[str, np.ndarray]:
    """One history, tick by tick."""
    rows = np.zeros((HISTORY_TICKS, len(TRACE_FIELDS)))
    status = lib.backlash_history(ctypes.c_uint64(seed), 0, 0, SLIPS, ctypes.c_double(0.0), ctypes.byref(HistoryCounts()),
                                  ctypes.c_void_p(rows.ctypes.data))
    assert status == 0, f"seed {seed}: status {status}"
    return dict(zip(TRACE_FIELDS, rows.T, strict=True))


def takeups(lib: ctypes.CDLL, first: int, count: int, held: bool) -> TakeupCounts:
    counts = TakeupCounts()
    for seed in range(first, first + count):
        status = lib.backlash_takeup(ctypes.c_uint64(seed), int(held), ctypes.byref(counts))
        assert status == 0, f"seed {seed}: status {status}"
    return counts


def history_bounds(c: HistoryCounts) -> dict[str, bool]:
    """Each bound and whether it is met."""
    cnc = min(c.cnc_command_wrong, c.cnc_encoder_wrong)
    return {
        "flank wrong <= 0.2 % of judged ticks": c.wrong <= 0.002 * c.judged,
        "never valid with the gap open past detection": c.late_valid == 0,
        "angle error <= a tenth of the gap at the 95th percentile, reported valid": percentile(c.valid_only, 0.95) <= 0.1,
        "angle error <= a tenth of the gap at the 95th percentile, a side decided": percentile(c.decided, 0.95) <= 0.1,
        "angle error <= a tenth of the gap at the 95th percentile, a side touching":
            percentile(c.touching, 0.95) <= 0.1,
        "angle error <= a tenth of the gap at the 95th percentile, outside the crossing":
            percentile(c.outside_crossing, 0.95) <= 0.1,
        "ten times fewer wrong ticks than by direction": 10.0 * c.wrong <= cnc,
        "ten times fewer wrong ticks than by direction, guessing at every tick too": 10.0 * c.best_wrong <= cnc,
    }


def takeup_bounds(held: TakeupCounts, free: TakeupCounts, count: int) -> dict[str, bool]:
    over = [getattr(c, name) for c in (held, free) for name in ("torque_over", "travel_over", "time_over", "not_idle")]
    return {"take-up succeeds in >= 99.9 %": held.really_done >= 0.999 * count,
            "no take-up reported done that is not": held.done == held.really_done and free.done == free.really_done,
            "bounded in the rest": not any(over)}


def report_histories(c: HistoryCounts) -> None:
    def share(value: float, of: float) -> str:
        return f"{100.0 * value / of:.3f} %"

    print(f"  gap open {share(c.open, c.ticks)}, excluded as crossing {share(c.excluded, c.ticks)}, longest open "
          f"{c.open_longest_us / 1000.0:.0f} ms, stated detection time {c.detection_us_max / 1000.0:.0f} ms")
    print(f"  flank wrong {share(c.wrong, c.judged)}, withheld {share(c.withheld, c.judged)}, best guess wrong "
          f"{share(c.best_wrong, c.judged)}")
    print(f"  valid {share(c.valid, c.ticks)}, valid and wrong {share(c.valid_wrong, c.judged)}, valid past detection "
          f"{c.late_valid:.0f} ticks, longest valid with open gap {c.longest_valid_open_us / 1000.0:.0f} ms")
    print(f"  by direction of motion: commanded {share(c.cnc_command_wrong, c.judged)}, encoder "
          f"{share(c.cnc_encoder_wrong, c.judged)} wrong")
    for field, name in ERROR_FIELDS.items():
        bins = getattr(c, field)
        print(f"  angle error, {name}: 50/90/95/99 % at " +
              ", ".join(f"{percentile(bins, s):.3f}" for s in (0.5, 0.9, 0.95, 0.99)) +
              f" gaps; beyond a tenth {100.0 * beyond_a_tenth(bins):.1f} % of them")


def report_takeups(name: str, c: TakeupCounts, count: int) -> None:
    print(f"take-up, {name}: " + ", ".join(f"{field} {getattr(c, field):.0f}" for field in TAKEUP_FIELDS[:14]) +
          f" of {count}")
    if c.done > 0.5 * count:
        print(f"  preload off by {100.0 * c.preload_error / max(c.done, 1.0):.1f} % of range, at most "
          f"{100.0 * c.preload_error_max:.1f} %")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=REPORTED_SEED)
    options = parser.parse_args()
    lib = library()
    met = True
    for name, exact, expecting, breakaway in (
            ("gap within 20 %", False, False, SLIPS), ("gap exactly 20 % off", True, False, SLIPS),
            ("gap within 20 %, gravity expected", False, True, SLIPS),
            ("gap within 20 %, sticking, and nobody knows", False, False, STICKS_UNKNOWN),
            ("gap within 20 %, sticking, friction trusted to 100 %", False, False, STICKS_ALLOWED)):
        counts = histories(lib, options.seed, options.count, exact, expecting, breakaway)
        print(f"histories, {name}: {options.count}")
        report_histories(counts)
        for bound, reached in history_bounds(counts).items() if breakaway == SLIPS else ():
            print(f"  {'met    ' if reached else 'NOT MET'} {bound}")
            met = met and reached
    held, free = (takeups(lib, options.seed, options.count, h) for h in (True, False))
    report_takeups("link held", held, options.count)
    report_takeups("link free", free, options.count)
    for bound, reached in takeup_bounds(held, free, options.count).items():
        print(f"  {'met    ' if reached else 'NOT MET'} {bound}")
        met = met and reached
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())
