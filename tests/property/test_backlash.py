"""The preload state machine keeps its bounds on fewer histories than the report's, and on other seeds."""
from __future__ import annotations

import ctypes
import os
from pathlib import Path

import pytest

import backlash_floor as floor
import backlash_histories as bench
import backlash_measured as measured

SEED, COUNT = 2_000_001, 150


@pytest.fixture(scope="module")
def lib() -> ctypes.CDLL:
    return bench.library()


@pytest.mark.parametrize("exact", [False, True])
@pytest.mark.parametrize("expecting", [False, True])
def test_histories(lib: ctypes.CDLL, exact: bool, expecting: bool) -> None:
    counts = bench.histories(lib, SEED, COUNT, exact, expecting)
    missed = [name for name, met in bench.history_bounds(counts).items() if not met]
    assert not missed
    assert counts.excluded < 0.2 * counts.ticks and counts.withheld < 0.12 * counts.judged
    assert bench.percentile(counts.all, 0.95) < 0.6 and bench.beyond_a_tenth(counts.all) < 0.14
    assert counts.valid > 0.35 * counts.ticks and counts.valid_wrong == 0


def test_a_gear_that_sticks(lib: ctypes.CDLL) -> None:
    """What it takes to break away is up to twice the friction in motion: allowed for, nothing is decided that is not so; not
    allowed for, that is seen."""
    allowed, unknown = (bench.histories(lib, SEED, COUNT, False, False, breakaway)
                        for breakaway in (bench.STICKS_ALLOWED, bench.STICKS_UNKNOWN))
    assert allowed.wrong <= 0.002 * allowed.judged and allowed.valid_wrong == 0 and allowed.late_valid == 0
    assert bench.percentile(allowed.decided, 0.95) <= 0.1 and bench.percentile(allowed.valid_only, 0.95) <= 0.1
    assert 10.0 * allowed.wrong <= min(allowed.cnc_command_wrong, allowed.cnc_encoder_wrong)
    assert allowed.valid > 0.25 * allowed.ticks
    assert unknown.wrong > 3.0 * allowed.wrong


REAL = Path(os.environ.get("BRACE_REAL_DATA", ""))


@pytest.mark.skipif(not os.environ.get("BRACE_REAL_DATA") or not (REAL / "cycloidal_base").is_dir(),
                    reason="BRACE_REAL_DATA names no folder with cycloidal_base, cycloidal_preloaded, cycloidal_polymer")
@pytest.mark.parametrize("record", measured.RECORDS)
def test_measured_joints(lib: ctypes.CDLL, record: str) -> None:
    """The same bounds on gears that nobody here made."""
    judged = {(setting, full): j for setting, full, j in measured.judge(lib, REAL / record)}
    for full in (False, True):
        allowing = judged[measured.ALLOWING, full]
        assert allowing.wrong <= 0.002 * allowing.touching
        assert allowing.valid_wrong == 0 and allowing.late_valid == 0
        assert 10 * allowing.wrong <= allowing.direction_wrong
    loaded = judged[measured.ALLOWING, True]
    assert loaded.percentile(loaded.decided_errors) <= 0.1 + 1e-3  # a gap exactly 20 % off either way
    assert loaded.valid > 0.6 * loaded.ticks
    as_found = [judged[measured.AS_FOUND, full] for full in (False, True)]
    assert sum(j.late_valid for j in as_found) > 0  # or there would be nothing to allow for


def test_takeups(lib: ctypes.CDLL) -> None:
    held, free = (bench.takeups(lib, SEED, COUNT, h) for h in (True, False))
    assert all(bench.takeup_bounds(held, free, COUNT).values())


def test_the_oracle_does_better_and_still_not_well(lib: ctypes.CDLL) -> None:
    """Else it would say nothing of what is attainable."""
    machine = bench.histories(lib, SEED, 6, exact=False, expecting=False)
    oracle = floor.oracle(lib, SEED, 6, 400, exact=False, known=False)
    assert oracle.ticks == machine.ticks
    assert 0.02 < oracle.beyond_a_tenth / oracle.ticks < bench.beyond_a_tenth(machine.all)


@pytest.mark.minutes
def test_a_motor_that_feels_for_the_flank_shows_more(lib: ctypes.CDLL) -> None:
    """So does a filter that knows only what a controller may know."""
    looking, feeling = (floor.oracle(lib, SEED, 8, 400, exact=False, known=False, joint_exact=False, reach_gaps=reach)
                        for reach in (0.0, 1.5))
    assert looking.beyond_a_tenth > 0.05 * looking.ticks  # else the line would be in reach of looking on
    assert feeling.beyond_a_tenth < 0.75 * looking.beyond_a_tenth
