"""When a foot's margin becomes an alarm, and when the alarm ends."""

from __future__ import annotations

from pathlib import Path
from typing import cast

import numpy as np
from brace.stance.observer import Observer
from brace.stance.stance_file import load_stance
from brace.stance.watching import Alarms

STANCE = load_stance(Path(__file__).parents[3] / "examples/stance/stance.toml")
NAMES = [limb.name for limb in STANCE.limbs]


class Margins:
    """In place of an observer."""

    def __init__(self) -> None:
        self.margin_n = np.full(4, 5.0)

    def margins(self) -> tuple[np.ndarray, np.ndarray]:
        return self.margin_n, np.full(4, 0.1)


def test_a_low_margin_that_stays_is_an_alarm_and_one_that_does_not_is_none() -> None:
    alarms, seen, time_s = Alarms(STANCE, 1.0), Margins(), 0.0
    begun: list[list[str]] = []
    for margin_n in (0.5, 5.0, 0.5, 5.0, 0.5, 5.0, 0.5, 0.5, 0.5, 1.3, 1.3, 1.3, 5.0, 5.0):
        seen.margin_n[2], time_s = margin_n, time_s + 0.1
        begun.append(alarms.begin(cast(Observer, seen), time_s))
        if margin_n == 1.3:  # between the level and one and a half times it
            assert alarms.limbs == (NAMES[2],)
    assert [bool(names) for names in begun].index(True) == 7 and begun[7] == [NAMES[2]]
    assert sum(map(len, begun)) == 1 and alarms.limbs == ()


def test_what_comes_within_a_twentieth_of_a_second_is_looked_at_once() -> None:
    alarms, seen = Alarms(STANCE, 1.0), Margins()
    seen.margin_n[0] = 0.0
    assert [alarms.begin(cast(Observer, seen), time_s) for time_s in (0.0, 0.01, 0.02, 0.03, 0.04)] == [[]] * 5
    assert alarms.begin(cast(Observer, seen), 0.06) == [NAMES[0]]
