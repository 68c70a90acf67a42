"""A loading test that the controller runs: started, waited for, fetched."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from brace.bus.entries import number_of
from brace.bus.ownership import entry_of
from brace.bus.session import Session
from brace.dataset.columns import LOADING
from brace.ground.errors import DeviceFaultError, NoDeviceError
from brace.wire.codes import LOADING_OUTCOME, MODE

POLL_S = 0.2
BACK_POLL_S = 0.05
BACK_S = 20.0  # far more than any way back
SERVO_S = 3.0  # what the controller grants its servos at each step
QUICK_SERVO_S = 0.4  # what simulated ones take of it
COLUMNS = tuple(column.name for column in LOADING)[:15]
RUNNING, DONE, STOPPED = 1, 2, 3

SMALLER = "a smaller --step-mm or fewer --steps; the tip must stand on something that does not yield"
AFTER_A_STOP = "the limb stands where it was stopped; brace let-go when it may move, then the test again"


@dataclass(frozen=True)
class Plan:
    """What the controller is asked to do."""

    axis: str
    steps_per_side: int
    step_mm: float
    dwell_s: float

    @property
    def rows(self) -> int:
        """From nothing to one side, over to the other, and back."""
        return 4 * self.steps_per_side + 1

    @property
    def quick_s(self) -> float:
        """How long it takes with servos that settle as quickly as the simulated ones."""
        return self.rows * (self.dwell_s + QUICK_SERVO_S)

    @property
    def most_s(self) -> float:
        """Past this time something is wrong."""
        return self.rows * (2.0 * (self.dwell_s + 0.05) + SERVO_S) + 5.0


def run(session: Session, plan: Plan, advance: Callable[[int], None]) -> None:
    """Until it is done and the limb is back; ended when we are. DeviceFaultError says how it failed."""
    with session.living():
        outcome = _run(session, plan, advance)
    if outcome != DONE:
        said = LOADING_OUTCOME.find(outcome)
        raise DeviceFaultError(
            f"the loading test along {plan.axis} failed, and nothing was written",
            where=session.where,
            why=f"outcome {outcome}" if said is None else said.text.rstrip("."),
            next_step=AFTER_A_STOP if outcome == STOPPED else SMALLER,
        )


def _run(session: Session, plan: Plan, advance: Callable[[int], None]) -> int:
    request = {
        "axis": "xz".index(plan.axis),
        "steps_per_side": plan.steps_per_side,
        "step": plan.step_mm,
        "dwell_ms": round(plan.dwell_s * 1000),
    }
    session.ask("loading_test_start", request, 0.5)
    limit_s = time.monotonic() + plan.most_s
    try:
        while True:
            session.listen(POLL_S)
            outcome = _outcome(session)
            if outcome != RUNNING:
                break
            advance(0)
            if time.monotonic() > limit_s:
                raise NoDeviceError(
                    "the loading test does not end",
                    where=session.where,
                    why=f"{plan.rows} rows are past their time",
                    next_step="brace monitor shows mode and faults",
                )
    except BaseException:
        try:
            session.ask("write_entry", {"index": entry_of("end_test"), "value": 1})
            _go_back(session)
        except Exception:  # what went wrong first is what matters
            pass
        raise
    _go_back(session)
    return outcome


def _go_back(session: Session) -> None:
    """Waits until the limb is where the test began."""
    until = time.monotonic() + BACK_S
    while MODE.name_of(_entry(session, "mode")) == "LOADING_TEST" and time.monotonic() < until:
        session.listen(BACK_POLL_S)


def _outcome(session: Session) -> int:
    return int(session.ask("loading_test_result", {"item": 0})["outcome"] or 0)


def fetch(session: Session, runs: int, advance: Callable[[int], None]) -> dict[str, np.ndarray]:
    """The rows of the newest `runs` tests, as columns of data.csv, with the forces on the tip as they were; a column that
    is nowhere known is left out."""
    count = int(number_of("loading_rows", _entry(session, "loading_rows")))
    if count == 0:
        raise DeviceFaultError(
            "the controller holds no rows",
            where=session.where,
            why="no loading test since its start",
            next_step="--loading-test runs one",
        )
    newest = _cell(session, count - 1, 0)
    first = count - 1
    while first > 0 and _cell(session, first - 1, 0) > newest - runs:
        first -= 1
    table = np.full((count - first, len(COLUMNS)), np.nan)
    for row in range(first, count):
        for column in range(len(COLUMNS)):
            table[row - first, column] = _cell(session, row, column)
        advance(row - first + 1)
    columns: dict[str, np.ndarray] = {}
    for index, known in enumerate(LOADING[: len(COLUMNS)]):
        values = table[:, index]
        if not known.required and np.isnan(values).any():
            continue
        columns[known.name] = values.astype(int) if known.kind in ("int", "axis") else values
    return columns


def _entry(session: Session, name: str) -> int:
    from brace.bus.entries import index_of

    return int(session.ask("read_entry", {"index": index_of(name)})["value"] or 0)


def _cell(session: Session, row: int, column: int) -> float:
    for _ in range(3):
        answer = session.ask("fetch_row", {"row": row, "column": column})
        if answer["row"] == row & 0x3FF and answer["column"] == column:
            value = answer["value"]
            return float("nan") if value is None else float(value)
    raise NoDeviceError(
        "rows come mixed up", where=session.where, why="answers to other questions", next_step="try again"
    )
