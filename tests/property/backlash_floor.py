"""How small can the angle error be at all? A particle filter that knows far more than any controller (backlash_oracle.c):
every parameter of joint and link, the gap to the last digit, the motor's motion without quantisation.

On the same histories as backlash_histories.py, four times: current with its noise or without, the world's doings unknown
or told (save the torques' size). The machine, which knows the gap to 20 % and nothing of the link, is printed beside it.
What comes out of it: with the gap open and the motor at rest within its friction nothing reaches the motor's side.
"""
from __future__ import annotations

import argparse
import ctypes

import numpy as np

import backlash_histories as bench


class OracleCounts(ctypes.Structure):
    _fields_ = [("ticks", ctypes.c_double), ("beyond_a_tenth", ctypes.c_double), ("open_beyond_a_tenth", ctypes.c_double),
                ("judged", ctypes.c_double), ("flank_wrong", ctypes.c_double), ("error", ctypes.c_double * bench.BINS)]


def oracle(lib: ctypes.CDLL, first: int, count: int, particles: int, exact: bool, told: bool,
           shares: list[float] | None = None) -> OracleCounts:
    """All histories' counts. shares (out): of each history's ticks those beyond a tenth of the gap."""
    counts = OracleCounts()
    for seed in range(first, first + count):
        beyond, ticks = counts.beyond_a_tenth, counts.ticks
        status = lib.backlash_oracle(ctypes.c_uint64(seed), particles, int(exact), int(told), ctypes.byref(counts))
        assert status == 0, f"seed {seed}: status {status}"
        if shares is not None:
            shares.append((counts.beyond_a_tenth - beyond) / (counts.ticks - ticks))
    return counts


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=bench.REPORTED_SEED)
    parser.add_argument("--particles", type=int, default=2000)
    options = parser.parse_args()
    lib = bench.library()
    machine = bench.histories(lib, options.seed, options.count, exact=False, expecting=False)
    print(f"machine: 95 % within {bench.percentile(machine.all, 0.95):.3f} gaps, beyond a tenth "
          f"{100.0 * bench.beyond_a_tenth(machine.all):.1f} % of {machine.ticks:.0f} ticks; gap open "
          f"{100.0 * machine.open / machine.ticks:.1f} %; outside the crossing flank wrong at every tick, guesses too, "
          f"{100.0 * machine.best_wrong / machine.judged:.2f} %")
    for exact in (False, True):
        for told in (False, True):
            shares: list[float] = []
            c = oracle(lib, options.seed, options.count, options.particles, exact, told, shares)
            error = np.std(shares, ddof=1) / len(shares) ** 0.5 if len(shares) > 1 else float("nan")
            print(f"oracle, current {'exact' if exact else 'noisy'}, world {'told' if told else 'unknown'}: 95 % within "
                  f"{bench.percentile(c.error, 0.95):.3f} gaps, beyond a tenth {100.0 * c.beyond_a_tenth / c.ticks:.1f} % "
                  f"+- {100.0 * error:.1f} % (with the gap open {100.0 * c.open_beyond_a_tenth / c.ticks:.1f} %), outside the crossing flank wrong "
                  f"{100.0 * c.flank_wrong / c.judged:.2f} %", flush=True)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
