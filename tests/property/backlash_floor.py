"""How small can the angle error be at all? A particle filter that knows far more than any controller (backlash_oracle.c):
every parameter of joint and link, the gap to the last digit, the motor's motion without quantisation.

On the same histories as backlash_histories.py, four times: current with its noise or without, the world's doings unknown
or known (save the torques' size). The machine, which knows the gap to 20 % and nothing of the link, is printed beside it.
What comes out of it: with the gap open and the motor at rest within its friction nothing reaches the motor's side.

With --feel the motor may leave its setpoint, to touch what it cannot find from where it stands: by half a gap, which is
what a side shifts the link by, by one gap, by more. Once with an oracle that knows the joint exactly, once with one
that knows no more than a controller may: gap, friction and inertia as the machine, the link's to 20 %, encoder and current
as read.
"""
from __future__ import annotations

import argparse
import ctypes

import numpy as np

import backlash_histories as bench


REACHES_GAPS = (0.0, 0.5, 1.0, 1.5, 3.0)


class OracleCounts(ctypes.Structure):
    _fields_ = [("ticks", ctypes.c_double), ("beyond_a_tenth", ctypes.c_double), ("open_beyond_a_tenth", ctypes.c_double),
                ("judged", ctypes.c_double), ("flank_wrong", ctypes.c_double), ("error", ctypes.c_double * bench.BINS)]


def oracle(lib: ctypes.CDLL, first: int, count: int, particles: int, exact: bool, known: bool, joint_exact: bool = True,
           reach_gaps: float = 0.0, shares: list[float] | None = None) -> OracleCounts:
    """All histories' counts.

    exact: the current has no noise. known: it knows what the world does, save the torques' size. joint_exact: the joint's
    parameters and the motor's motion are known exactly; else what a controller may know: gap, friction and inertia as the
    machine believes them, the link's to 20 %, and of the motor what encoder and current read. reach_gaps: how far the
    motor may leave its setpoint to feel for a side. shares (out): of each history's ticks those beyond a
    tenth of the gap.
    """
    counts = OracleCounts()
    for seed in range(first, first + count):
        beyond, ticks = counts.beyond_a_tenth, counts.ticks
        status = lib.backlash_oracle(ctypes.c_uint64(seed), particles, int(exact), int(known), int(joint_exact),
                                     ctypes.c_double(reach_gaps), ctypes.byref(counts))
        assert status == 0, f"seed {seed}: status {status}"
        if shares is not None:
            shares.append((counts.beyond_a_tenth - beyond) / (counts.ticks - ticks))
    return counts


def report_machine(c: bench.HistoryCounts) -> None:
    print(f"machine: 95 % within {bench.percentile(c.all, 0.95):.3f} gaps, beyond a tenth "
          f"{100.0 * bench.beyond_a_tenth(c.all):.1f} % of {c.ticks:.0f} ticks; gap open "
          f"{100.0 * c.open / c.ticks:.1f} %; outside the crossing side wrong at every tick, guesses too, "
          f"{100.0 * c.best_wrong / c.judged:.2f} %")


def report_oracle(name: str, c: OracleCounts, shares: list[float]) -> None:
    error = np.std(shares, ddof=1) / len(shares) ** 0.5 if len(shares) > 1 else float("nan")
    print(f"oracle, {name}: 95 % within {bench.percentile(c.error, 0.95):.3f} gaps, beyond a tenth "
          f"{100.0 * c.beyond_a_tenth / c.ticks:.1f} % +- {100.0 * error:.1f} % (with the gap open "
          f"{100.0 * c.open_beyond_a_tenth / c.ticks:.1f} %), outside the crossing side wrong "
          f"{100.0 * c.flank_wrong / c.judged:.2f} %", flush=True)


def seeing(lib: ctypes.CDLL, first: int, count: int, particles: int) -> None:
    """What can be found by looking on."""
    report_machine(bench.histories(lib, first, count, exact=False, expecting=False))
    for exact in (False, True):
        for known in (False, True):
            shares: list[float] = []
            c = oracle(lib, first, count, particles, exact, known, shares=shares)
            report_oracle(f"current {'exact' if exact else 'noisy'}, world {'known' if known else 'unknown'}", c, shares)


def feeling(lib: ctypes.CDLL, first: int, count: int, particles: int) -> None:
    """What can be found when the motor may leave its setpoint; noisy current, world unknown."""
    for reach_gaps in REACHES_GAPS:
        print(f"motor sent off its setpoint by up to {reach_gaps:g} gaps:")
        report_machine(bench.histories(lib, first, count, exact=False, expecting=False, reach_gaps=reach_gaps))
        for joint_exact in (True, False):
            shares: list[float] = []
            c = oracle(lib, first, count, particles, False, False, joint_exact, reach_gaps, shares)
            report_oracle(f"joint and motion {'exact' if joint_exact else 'as a controller may know them'}", c, shares)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=bench.REPORTED_SEED)
    parser.add_argument("--particles", type=int, default=2000)
    parser.add_argument("--feel", action="store_true", help="the motor may leave its setpoint to feel for a side")
    options = parser.parse_args()
    (feeling if options.feel else seeing)(bench.library(), options.seed, options.count, options.particles)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
