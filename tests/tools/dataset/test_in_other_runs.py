"""A reading that stands aside in every run at the same place is of the limb; one that does so once may be a slip."""

from __future__ import annotations

import numpy as np

from brace.dataset.check_runs import in_other_runs

RUNS, ROWS, REVERSAL = 4, 9, 5
TYPICAL = 0.02


def aside(runs: tuple[int, ...], size: float = -1.4) -> np.ndarray:
    """How far rows stand aside: by `size` at the reversal of these runs, elsewhere by what is usual."""
    out = TYPICAL * np.resize([1.0, -1.0, 0.5], RUNS * ROWS)
    out[[run * ROWS + REVERSAL for run in runs]] = size
    return out


def found(values: np.ndarray, axis: tuple[int, ...] = (0, 0, 0, 0), run: int = 1) -> bool:
    """Whether another run agrees with the reading at the reversal of this one."""
    of_run = np.repeat(np.arange(RUNS), ROWS)
    return in_other_runs(values, TYPICAL, of_run, np.repeat(axis, ROWS), run * ROWS + REVERSAL)


def test_a_turn_of_friction_comes_again() -> None:
    assert found(aside((1, 3)))


def test_one_slip_stands_alone() -> None:
    assert not found(aside((1,)))


def test_another_side_is_no_agreement() -> None:
    """A slip beside a turn of friction to the other side stays a slip."""
    values = aside((1,))
    values[3 * ROWS + REVERSAL] = 1.4
    assert not found(values)


def test_another_axis_is_no_agreement() -> None:
    assert not found(aside((1, 3)), axis=(0, 0, 1, 1))


def test_another_place_of_the_pass_is_no_agreement() -> None:
    values = aside((1,))
    values[3 * ROWS + REVERSAL + 1] = -1.4
    assert not found(values)


def test_what_is_usual_is_no_agreement() -> None:
    """Other runs must stand aside by more than rows usually do, and by a good part of this reading's size."""
    values = aside((1,))
    values[3 * ROWS + REVERSAL] = -0.3 * 1.4 * 0.9
    assert not found(values)
