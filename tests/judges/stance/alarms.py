"""Alarms of `brace stance watch` while a payload grows: none where every foot holds with 5 % of the load to spare, one
before a foot slips.

    .venv/bin/python tests/judges/stance/alarms.py --seed 1 --hold 200 --slip 100 --jobs 2

Seeds below 1000 are for practice. The truth is the judge's world of small displacements, with all that judge.py hides.
Up to the first slip every foot sticks, so a step is solved without Siconos; the law's residual says whether they do.
What is judged is in-process: ten thousand starts of the command would take a day. Limbs send every 20 ms, each at its
own moment, and what has come is taken every PERIOD_S, as the command does; the payload grows for ten seconds.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from brace.stance.observer import Observer, Reading
from brace.stance.stance_file import load_stance
from brace.stance.watching import ALARM_SHARE, PERIOD_S, Alarms
from brace.stance.world import believed, place_covariance_mm2
from judge import COLLAPSES_N, MOST, share
from limbs import Array
from truth import NoStance, State, World, begin, first_slip, margins, step
from world import SENSOR_N, Hidden, Stance, draw, write

SPARE = 0.05  # of the load
SENDS_S = 0.02
REST_S, GROWS_S = 1.0, 10.0  # as in the demo: a payload that is hung on
STEPS = 8  # of the payload; between two of them forces go straight
BEYOND_CONE_TRIES = 12


class Sticking:
    """In place of Siconos: every foot sticks. NoStance soon where one cannot."""

    def __init__(self) -> None:
        self._beyond = 0

    def __call__(self, w: Array, q: Array, friction: Array, guess: Array) -> Array:
        force: Array = np.reshape(np.linalg.solve(w, -q), (-1, 3)).astype(np.float64)
        beyond = np.linalg.norm(force[:, 1:], axis=1) > friction * force[:, 0]
        self._beyond = self._beyond + 1 if beyond.any() else 0
        if self._beyond > BEYOND_CONE_TRIES:
            self._beyond = 0
            raise NoStance("a foot slips")
        flat: Array = force.ravel()
        return flat


@dataclass(frozen=True)
class Case:
    """slips: whether a foot is to slip. alarm_share: how much of the payload was there at the alarm; None: none."""

    number: int
    kind: str
    slips: bool
    alarm_share: float | None
    events: list[str]


def _grow(world: World, state: State, most: float) -> list[State]:
    """The states while the payload grows to `most`, in equal steps; the first is that before it."""
    states = [state]
    for k in range(STEPS):
        states.append(step(world, Sticking(), states[-1], 1.0, most * (k + 1) / STEPS))
    return states


def _spare(world: World, state: State, factor: float) -> bool:
    load = np.linalg.norm(world.weight_n + factor * world.payload_n)
    return bool(margins(world, state.force_n).min() > SPARE * load)


def _truth(stance: Stance, slips: bool, rng: np.random.Generator) -> list[State] | None:
    """States while the payload grows, to a slip or to a load that all feet hold; None where the stance is no case."""
    world, state = stance.world, begin(stance.world)
    try:
        for k in range(4):
            state = step(world, Sticking(), state, (k + 1) / 4, 0.0)
        if not _spare(world, state, 0.0):
            return None
        slip = first_slip(world, Sticking(), state, MOST)
        if slips:
            if slip is None or margins(world, slip.before.force_n)[slip.foot] > COLLAPSES_N:
                return None
            return _grow(world, state, slip.factor * (1 - 1e-3))
        most = (MOST if slip is None else slip.factor) * rng.uniform(0.3, 1.0)
        for _ in range(12):
            if _spare(world, step(world, Sticking(), state, 1.0, most), most):  # while all stick, the way is no matter
                return _grow(world, state, most)
            most *= 0.9
    except NoStance:
        pass
    return None


def _share(time_s: float) -> float:
    """Of the payload."""
    return float(np.clip((time_s - REST_S) / GROWS_S, 0.0, 1.0))


def _forces(states: list[State], time_s: float) -> Array:
    at = _share(time_s) * STEPS
    low = min(int(at), STEPS - 1)
    force: Array = states[low].force_n + (at - low) * (states[low + 1].force_n - states[low].force_n)
    return force


def case(seed: int, number: int, slips: bool) -> Case | None:
    stance = draw(seed, number, replace(Hidden(), tells_play=True), finite=False)
    rng = np.random.default_rng([seed, number, 2])
    states = _truth(stance, slips, rng)
    if states is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        asked = load_stance(write(stance, Path(folder)))
        middle = believed(asked)
    n = len(asked.limbs)

    k_n_per_mm = [[law.spring(one.force_n[i]).k_n_per_mm for i, law in enumerate(middle.laws)] for one in states]

    def reading(i: int, time_s: float) -> Reading:
        force_n = _forces(states, time_s)[i] + rng.normal(0, SENSOR_N, 3)
        k = k_n_per_mm[round(_share(time_s) * STEPS)][i]
        return Reading(middle.laws[i].tip_mm, k, 0.1, force_n, SENSOR_N**2 * np.eye(3), np.zeros((3, 3)))

    places = [place_covariance_mm2(limb, law) for limb, law in zip(asked.limbs, middle.laws, strict=True)]
    observer = Observer(asked, middle.weight, places, [reading(i, 0.0) for i in range(n)], 0.0)
    alarms = Alarms(asked, ALARM_SHARE * float(np.linalg.norm(stance.world.weight_n)))
    first_s, events = rng.uniform(0.0, SENDS_S, n), []
    for period in range(1, int((2 * REST_S + GROWS_S) / PERIOD_S) + 1):
        time_s = period * PERIOD_S
        if slips and time_s > REST_S + GROWS_S:
            break
        came = [reading(i, time_s - (time_s - first_s[i]) % SENDS_S) for i in range(n)]
        events += [event.kind for event in observer.update(came, time_s)]
        if alarms.begin(observer, time_s):
            return Case(number, stance.name.split()[0], slips, _share(time_s), events)
    return Case(number, stance.name.split()[0], slips, None, events)


def _work(ask: tuple[int, int, bool]) -> Case | None:
    return case(*ask)


def run(seed: int, first: int, slips: bool, count: int, jobs: int) -> Iterator[Case]:
    """The first `count` cases from number `first` on, in order."""
    with ProcessPoolExecutor(jobs) as pool:
        found = 0
        while found < count:
            asked = [(seed, number, slips) for number in range(first, first + 32 * jobs)]
            for one in pool.map(_work, asked, chunksize=4):
                if one is not None and found < count:
                    found += 1
                    yield one
            first += 32 * jobs


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--hold", type=int, default=200)
    parser.add_argument("--slip", type=int, default=100)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--out", type=Path, help="a line of JSON a case")
    options = parser.parse_args()
    cases: list[Case] = []
    with (options.out or Path("/dev/null")).open("w") as out:
        for first, slips, count in ((0, False, options.hold), (10_000_000, True, options.slip)):
            for one in run(options.seed, first, slips, count, options.jobs):
                cases.append(one)
                print(json.dumps(vars(one)), file=out, flush=True)
                if sys.stderr.isatty():
                    print(f"\r{len(cases)} of {options.hold + options.slip}", end="", file=sys.stderr, flush=True)
    held, slipped = [one for one in cases if not one.slips], [one for one in cases if one.slips]
    print(f"no alarm where all hold: {share([one.alarm_share is None for one in held])}")
    print(f"an alarm before the slip: {share([one.alarm_share is not None for one in slipped])}")
    early = [one.alarm_share for one in slipped if one.alarm_share is not None]
    if early:
        middle, low = np.quantile(early, [0.5, 0.05])
        print(f"of the payload at the alarm: median {middle:.2f}, 5th percentile {low:.2f}")
    print(f"a foot called moved before it did: {share(['moved' in one.events for one in cases])}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
