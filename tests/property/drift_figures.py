"""What the drift check sees and when, on simulated limbs: false alarms, delays, names and sizes of losses.

Each limb is learned from 14 rounds of nine postures along both axes (4,284 readings, the temperature through half its
swing of +-10 degC), then either watched unchanged, or a link loses stiffness somewhere in a run and every reading from
there to the alarm counts. Check runs are at the posture and along the axis the check's own outlook finds best for the
link, among the nine or, where it says of its choice, among all those within reach; mixed runs are at all nine postures
and both axes in random order. `python drift_figures.py` prints the figures, `--only` some of them,
exit code 1 when a bound is not met.
"""
from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

import limbs
from drift_record import (DRIFTED, PRACTICE, RUN_STEPS, STEP_MM, THERMAL_PER_DEGC, WATCHING, Check, Outlook, Record,
                          commissioning, measured, mixed, random_believed, random_postures, runs, split_at_reversals,
                          true_limb, with_loss)
from host_library import play

LINKS = ("femur", "tibia")
SECOND = {"geometry.femur_mm": 200.0, "geometry.tibia_mm": 200.0, "link.femur.axial_mm_per_n": 0.001,
          "link.femur.bending_mm_per_n": 0.05, "link.tibia.axial_mm_per_n": 0.001, "link.tibia.bending_mm_per_n": 0.08,
          "joint.femur.compliance_rad_per_n_mm": 1.3e-5, "joint.tibia.compliance_rad_per_n_mm": 1.3e-5}
"""The other limb of the practice records."""
NAMED = {"paper": limbs.PAPER, "second": SECOND}
WITHIN, LONGEST_RUNS, OPERATED_RUNS = 30, 60, 1200
KNEE_LEAST_RAD = 0.4
"""How far the knee stays from straight and from folded where a limb chooses; others: `--only margin`."""
FORCE_MOST_N = 100.0
"""Of a check run, by the model; the sensor ends at 145 N."""
LOSS_SWING_DEGC = 4.0
"""Temperature about the reference while a link goes, as in the practice records."""


def whole(record: Record) -> Record:
    return record


@dataclass
class Limb:
    """A limb, its postures, and a check that has learned it."""
    true: dict[str, float]
    postures: np.ndarray
    check: Check
    rng: np.random.Generator
    fed: Callable[[Record], Record]  # as the check gets a record
    choices: list[tuple[np.ndarray, np.ndarray]]  # posture and axis of each check run it may make


def within_reach(believed: dict[str, float], knee_least_rad: float) -> list[tuple[np.ndarray, np.ndarray]]:
    """Postures [theta1, theta2, rad] and axes at which a check run stays within the force allowed, by the model."""
    reach = np.stack([angle.ravel() for angle in np.meshgrid(
        np.linspace(-0.5, 2.2, 19), np.linspace(knee_least_rad, np.pi - knee_least_rad, 19))], 1)
    choices = []
    for axis in np.eye(2):
        far = 4 * STEP_MM * axis
        reading = play(limbs.limb(believed), reach[:, 0], reach[:, 1], *(np.full(len(reach), part) for part in far),
                       temp_degc=np.full(len(reach), 22.0), run=np.arange(len(reach), dtype=np.int32))
        choices += [(theta, axis) for theta in reach[np.hypot(reading["fx_n"], reading["fz_n"]) < FORCE_MOST_N]]
    return choices


def of_its_choice(limb: Limb, rehearsed: bool, knee_least_rad: float = KNEE_LEAST_RAD) -> Limb:
    """The limb with the check posture of each link chosen from all within reach, by what was learned at its postures.
    Rehearsed: it is commissioned again, with a run at each of the two in every round."""
    limb = replace(limb, choices=within_reach(limb.check.believed, knee_least_rad))
    limb = replace(limb, choices=[best_run(limb, link)[:2] for link in (0, 1)])
    if rehearsed:
        limb.check.learn()
        repeats = 20 if limb.fed is split_at_reversals else 14
        usual = [(theta, axis) for theta in limb.postures for axis in np.eye(2)]
        theta, axis = (np.tile(np.array([run[i] for run in usual + limb.choices]), (repeats, 1)) for i in (0, 1))
        record = runs(theta, axis, limb.rng, period=2.0 * len(theta) * len(RUN_STEPS))
        limb.check.watch(limb.fed(record), measured(limb.true, record, limb.rng))
    return limb


def check_runs(limb: Limb, rounds: int) -> Record:
    """Rounds of runs at the check postures of both links, the temperature through its swing as at commissioning."""
    theta, axis = (np.tile(np.array([choice[i] for choice in limb.choices]), (rounds, 1)) for i in (0, 1))
    return runs(theta, axis, limb.rng, period=2.0 * rounds * len(limb.choices) * len(RUN_STEPS))


FRICTION = {"joint.femur.coulomb_n_mm": 8.3, "joint.tibia.coulomb_n_mm": 18.6}
"""The largest of the practice records."""


def learned(seed: int, believed: dict[str, float] | None = None, postures: np.ndarray | None = None,
            friction: bool = False) -> Limb:
    """A named limb, or without arguments a random one at random postures. With friction,
    a run ends at each reversal."""
    rng = np.random.default_rng(seed)
    believed = random_believed(rng) if believed is None else believed
    postures = random_postures(rng) if postures is None else postures
    true = true_limb(believed, rng, THERMAL_PER_DEGC) | (FRICTION if friction else {})
    limb = Limb(true, postures, Check(believed), rng, split_at_reversals if friction else whole,
                [(theta, axis) for theta in postures for axis in np.eye(2)])
    record = commissioning(postures, rng, repeats=20 if friction else 14)
    limb.check.watch(limb.fed(record), measured(true, record, rng))
    return limb


def quiet(seed: int, believed: dict[str, float] | None, postures: np.ndarray | None, readings: int,
          friction: bool = False) -> tuple[bool, int]:
    """Whether an unchanged limb, learning included, raised an alarm, and the readings it was watched for."""
    limb = learned(seed, believed, postures, friction)
    taken, left = 0, readings
    while left > 0 and limb.check.state.state != DRIFTED:
        record = mixed(limb.postures, min(left, 250_000) // len(RUN_STEPS) + 1, limb.rng)
        taken += limb.check.watch(limb.fed(record), measured(limb.true, record, limb.rng))[0]
        left -= len(record)
    return limb.check.state.state == DRIFTED, taken


def best_run(limb: Limb, link: int) -> tuple[np.ndarray, np.ndarray, Outlook]:
    """Posture, direction and outlook where the check expects to see this link's loss first."""
    all_runs = [(theta, axis, limb.check.outlook(theta, axis, LOSS_SWING_DEGC / 2**0.5))
                for theta, axis in limb.choices]
    return min(all_runs, key=lambda run: (run[2].steps_needed[link], run[2].sigma_of_loss_ratio[link]))


def quiet_at_choice(seed: int, believed: dict[str, float] | None, postures: np.ndarray | None, readings: int,
                    rehearsed: bool, friction: bool = False) -> tuple[bool, int]:
    """As quiet, half of the readings in check runs at postures of the limb's choice."""
    limb = of_its_choice(learned(seed, believed, postures, friction), rehearsed)
    taken, left = 0, readings
    while left > 0 and limb.check.state.state != DRIFTED:
        for record in (mixed(limb.postures, 600, limb.rng), check_runs(limb, 300)):
            taken += limb.check.watch(limb.fed(record), measured(limb.true, record, limb.rng))[0]
            left -= len(record)
    return limb.check.state.state == DRIFTED, taken


def quiet_when_the_knee_scatters(seed: int, knee_rad: float, chosen: bool) -> bool:
    """Whether the unchanged paper limb raised an alarm in 10,200 readings of check runs, at the best of the nine
    postures or those of its choice, its knee off by another angle (one sigma) at each run; learned without that."""
    limb = learned(seed, limbs.PAPER, PRACTICE)
    limb = of_its_choice(limb, True) if chosen else replace(limb, choices=[best_run(limb, link)[:2] for link in (0, 1)])
    record = check_runs(limb, 300)
    off = knee_rad * limb.rng.standard_normal(record.run[-1] + 1)[record.run]
    limb.check.watch(record, measured(limb.true, replace(record, theta=record.theta + off[:, None] * [0.0, 1.0]),
                                      limb.rng))
    return bool(limb.check.state.state == DRIFTED)


@dataclass
class Flagged:
    """One loss and what became of it."""
    delay: int  # readings, the one with the alarm included; the record's length where there was none
    alarm: bool
    named: bool  # the link is the likeliest cause
    possible: bool  # or among those nearly as likely
    loss: float
    sigma: float
    steps_needed: int


def lose(limb: Limb, link: int, loss: float, check_run: bool, axial_too: bool = False) -> Flagged:
    """A loss in the middle of a run."""
    check, rng = limb.check.copy(), limb.rng
    theta, axis, outlook = best_run(limb, link)
    if check_run:
        record = runs(np.tile(theta, (LONGEST_RUNS, 1)), np.tile(axis, (LONGEST_RUNS, 1)), rng,
                      swing_degc=LOSS_SWING_DEGC)
    else:
        record = mixed(limb.postures, 5 * LONGEST_RUNS, rng, swing_degc=LOSS_SWING_DEGC)
    onset = int(rng.integers(len(RUN_STEPS)))
    force = measured(with_loss(limb.true, LINKS[link], loss, axial_too), record, rng)
    if onset:
        force[:onset] = measured(limb.true, record.part(slice(0, onset)), rng)
    taken, _ = check.watch(limb.fed(record), force)
    report = check.report()
    alarm = report.state == DRIFTED
    return Flagged(taken - onset, alarm, alarm and report.cause == link, alarm and bool(report.could_be >> link & 1),
                   report.loss_ratio, report.loss_sigma_ratio, outlook.steps_needed[link])


def named_losses(name: str, seed: int, link: int, loss: float, check_run: bool, repeats: int,
                 axial_too: bool = False, friction: bool = False, operated: int = 0,
                 rehearsed: bool | None = None, knee_least_rad: float = KNEE_LEAST_RAD) -> list[Flagged]:
    """Losses of a practice limb, after so many ordinary runs since commissioning; check runs at postures of its
    choice unless `rehearsed` is None."""
    limb = learned(seed, NAMED[name], PRACTICE, friction)
    if rehearsed is not None:
        limb = of_its_choice(limb, rehearsed, knee_least_rad)
    if operated:
        record = mixed(PRACTICE, operated, limb.rng)
        limb.check.watch(limb.fed(record), measured(limb.true, record, limb.rng))
    return [lose(limb, link, loss, check_run, axial_too) for _ in range(repeats)]


@dataclass
class Case:
    """A random limb at random postures: watched unchanged for 5,000 readings, and each link losing a tenth."""
    watching: bool
    false_alarm: bool
    check_run: list[Flagged]
    mixed_runs: list[Flagged]


def random_case(seed: int) -> Case:
    limb = learned(seed)
    watching = limb.check.state.state == WATCHING
    losses = [[lose(limb, link, 0.10, check_run) for link in (0, 1)] if watching else [] for check_run in (True, False)]
    record = mixed(limb.postures, 5_000 // len(RUN_STEPS), limb.rng)
    limb.check.watch(record, measured(limb.true, record, limb.rng))
    return Case(watching, limb.check.state.state == DRIFTED, *losses)


def random_choice(seed: int, rehearsed: bool,
                  knee_least_rad: float = KNEE_LEAST_RAD) -> tuple[bool, bool, list[Flagged]]:
    """Whether a random limb had learned; whether it raised an alarm unchanged, in 5,000 readings; each link losing a
    tenth. Check runs at postures of its choice."""
    limb = of_its_choice(learned(seed), rehearsed, knee_least_rad)
    watching = limb.check.state.state == WATCHING
    losses = [lose(limb, link, 0.10, True) for link in (0, 1)] if watching else []
    for record in (mixed(limb.postures, 147, limb.rng), check_runs(limb, 74)):
        limb.check.watch(record, measured(limb.true, record, limb.rng))
    return watching, limb.check.state.state == DRIFTED, losses


def text(found: list[Flagged]) -> str:
    """Delay quantiles, share within WITHIN, names, size."""
    delay = np.quantile([f.delay for f in found], [0.1, 0.5, 0.9, 0.99])
    alarms = [f for f in found if f.alarm] or found
    size = np.median([f.loss for f in alarms])
    return (f"delay 10/50/90/99 %: {delay[0]:.0f}/{delay[1]:.0f}/{delay[2]:.0f}/{delay[3]:.0f}, within {WITHIN}: "
            f"{within(found):.1%}, never {1 - np.mean([f.alarm for f in found]):.1%}, likeliest cause right "
            f"{np.mean([f.named for f in alarms]):.0%}, among the possible "
            f"{np.mean([f.possible for f in alarms]):.0%}, loss found (median) {size:.3f}")


def within(found: list[Flagged]) -> float:
    """Share flagged within WITHIN readings."""
    return float(np.mean([f.alarm and f.delay <= WITHIN for f in found]))


Bound = Callable[[str, bool], None]
"""Prints whether what is named is met, and keeps it for the exit code."""


def at_nine(pool: ProcessPoolExecutor, seed: int, sequences: int, bound: Bound) -> None:
    """Check runs at the best of the nine postures, and mixed runs."""
    print("unchanged limbs, temperature +-10 degC, thermal rate 20 % off")
    quiet_jobs = [pool.submit(quiet, seed + i, NAMED[name], PRACTICE, 1_000_000) for name in NAMED for i in range(3)]
    alarms = [job.result() for job in quiet_jobs]
    print(f"  practice limbs: {sum(a for a, _ in alarms)} alarms in {sum(n for _, n in alarms):,} readings")
    bound("no false alarm in 10^6 readings", not any(a for a, _ in alarms))
    cases = list(pool.map(random_case, range(seed + 1000, seed + 1000 + sequences), chunksize=20))
    ready = [case for case in cases if case.watching]
    print(f"  random limbs: {sum(case.false_alarm for case in cases)} of {len(cases)} raised an alarm within 5,000 "
          f"readings; {len(ready)} had learned after 4,284")
    quiet_jobs = [pool.submit(quiet, seed + 200_000 + i, limbs.PAPER, PRACTICE, 500_000, True) for i in range(2)]
    alarms = [job.result() for job in quiet_jobs]
    print(f"  paper limb with friction: {sum(a for a, _ in alarms)} alarms in {sum(n for _, n in alarms):,} readings")
    bound("no false alarm by friction in 10^6 readings", not any(a for a, _ in alarms))
    for kind, axial_too, friction in (("bending and axial compliance", True, False), ("with friction", False, True)):
        for link in (0, 1):
            jobs = [pool.submit(named_losses, "paper", seed + i, link, 0.10, True, 10, axial_too, friction)
                    for i in range(20)]
            found = [f for job in jobs for f in job.result()]
            print(f"check runs, paper, {LINKS[link]} loses 10%, {kind}: {text(found)}")
    for check_run in (True, False):
        print("check runs" if check_run else "mixed runs")
        for name in NAMED:
            for link in (0, 1):
                for loss in (0.03, 0.05, 0.10, 0.20):
                    jobs = [pool.submit(named_losses, name, seed + i, link, loss, check_run, 10) for i in range(20)]
                    found = [f for job in jobs for f in job.result()]
                    needed = int(np.median([f.steps_needed for f in found]))
                    print(f"  {name}, {LINKS[link]} loses {loss:.0%} (outlook for 10 %: {needed}): {text(found)}")
                    if check_run and loss == 0.10:
                        bound(f"{name}, {LINKS[link]}, just commissioned: within {WITHIN} readings in 85 %",
                              within(found) >= 0.85)
                        jobs = [pool.submit(named_losses, name, seed + i, link, loss, True, 10,
                                            operated=OPERATED_RUNS) for i in range(20)]
                        found = [f for job in jobs for f in job.result()]
                        print(f"  {name}, {LINKS[link]} loses {loss:.0%} after 20,400 readings of mixed runs: "
                              f"{text(found)}")
                        bound(f"{name}, {LINKS[link]}, in operation: within {WITHIN} readings in 95 %",
                              within(found) >= 0.95)
        for link in (0, 1):
            found = [(case.check_run if check_run else case.mixed_runs)[link] for case in ready]
            print(f"  random limbs, {LINKS[link]} loses 10%: {text(found)}")
            if check_run:
                for low, high in ((0, 10), (10, 15), (15, 30), (30, 100), (100, 65535)):
                    part = [f for f in found if low < f.steps_needed <= high]
                    if part:
                        print(f"    outlook {low + 1} to {high} readings, {len(part)} limbs: {text(part)}")
                part = [f for f in found if f.steps_needed <= WITHIN / 2]
                bound(f"outlook at most {WITHIN // 2}: within {WITHIN} in 95 %", within(part) >= 0.95)


def when_the_knee_scatters(pool: ProcessPoolExecutor, seed: int, sequences: int, bound: Bound) -> None:
    """False alarms where the knee's angle is another one at each run."""
    for knee_rad in (0.25e-3, 0.5e-3, 1e-3):
        alarms = [sum(pool.map(quiet_when_the_knee_scatters, range(seed, seed + 5), [knee_rad] * 5, [chosen] * 5))
                  for chosen in (False, True)]
        print(f"knee off by {1e3 * knee_rad} mrad from run to run, unchanged limbs with an alarm: {alarms[0]} of 5 at "
              f"the best of the nine postures, {alarms[1]} of 5 at those of its choice")


def at_choice(pool: ProcessPoolExecutor, seed: int, sequences: int, bound: Bound, rehearsed: bool = True) -> None:
    """Check runs at postures of the limb's choice; rehearsed: commissioned there as well."""
    sequences = min(sequences, 600)
    print("check runs at the posture of its choice, " + ("commissioned there" if rehearsed else "never there before"))
    for name, friction in (("paper", False), ("second", False), ("paper", True)):
        what = f"{name}{' with friction' if friction else ''}"
        for link, operated in ((0, 0), (1, 0), (1, OPERATED_RUNS)):
            jobs = [pool.submit(named_losses, name, seed + i, link, 0.10, True, 10, friction=friction,
                                operated=operated, rehearsed=rehearsed) for i in range(40)]
            found = [f for job in jobs for f in job.result()]
            print(f"  {what}, {LINKS[link]} loses 10%{', after operation' if operated else ''} (outlook "
                  f"{np.median([f.steps_needed for f in found]):.0f}): {text(found)}", flush=True)
            if rehearsed:
                bound(f"{what}, {LINKS[link]}: within {WITHIN} readings in 98 %", within(found) >= 0.98)
        watched = [pool.submit(quiet_at_choice, seed + i, NAMED[name], PRACTICE, 500_000, rehearsed, friction)
                   for i in range(2)]
        ends = [job.result() for job in watched]
        print(f"  {what}, unchanged: {sum(a for a, _ in ends)} alarms in {sum(n for _, n in ends):,} readings",
              flush=True)
        if rehearsed:
            bound(f"{what}: no false alarm in 10^6 readings", not any(a for a, _ in ends))
    cases = list(pool.map(random_choice, range(seed + 1000, seed + 1000 + sequences), [rehearsed] * sequences,
                          chunksize=20))
    ready = [losses for watching, _, losses in cases if watching]
    false_alarms = sum(alarm for _, alarm, _ in cases)
    print(f"  random limbs: {false_alarms} of {len(cases)} raised an alarm unchanged; {len(ready)} had learned")
    if rehearsed:
        bound("random limbs: no false alarm", false_alarms == 0)
    for link in (0, 1):
        found = [losses[link] for losses in ready]
        print(f"  random limbs, {LINKS[link]} loses 10%: {text(found)}")
        for low, high in ((0, 15), (15, 65535)):
            part = [f for f in found if low < f.steps_needed <= high]
            if part:
                print(f"    outlook {low + 1} to {high}, {len(part)} limbs: {text(part)}")


def never_there_before(pool: ProcessPoolExecutor, seed: int, sequences: int, bound: Bound) -> None:
    """The same where the limb was commissioned at the nine only."""
    at_choice(pool, seed, sequences, bound, rehearsed=False)


def at_margins(pool: ProcessPoolExecutor, seed: int, sequences: int, bound: Bound) -> None:
    """The same as at_choice where the knee may come nearer to straight and to folded, or less near."""
    sequences = min(sequences, 600)
    for knee_least_rad in (0.2, 0.3, 0.5):
        print(f"check runs at the posture of its choice, knee {knee_least_rad} rad or more from straight and folded")
        for friction in (False, True):
            jobs = [pool.submit(named_losses, "paper", seed + i, 1, 0.10, True, 10, friction=friction, rehearsed=True,
                                knee_least_rad=knee_least_rad) for i in range(40)]
            print(f"  paper{' with friction' if friction else ''}, tibia loses 10%: "
                  f"{text([f for job in jobs for f in job.result()])}", flush=True)
        cases = list(pool.map(random_choice, range(seed + 1000, seed + 1000 + sequences), [True] * sequences,
                              [knee_least_rad] * sequences, chunksize=20))
        print(f"  random limbs: {sum(alarm for _, alarm, _ in cases)} of {len(cases)} raised an alarm unchanged; "
              f"{sum(watching for watching, _, _ in cases)} had learned")
        print(f"  random limbs, either link loses 10%: {text([f for _, _, losses in cases for f in losses])}",
              flush=True)


PARTS = {"nine": (at_nine, 0), "scatter": (when_the_knee_scatters, 400_000), "choice": (at_choice, 400_000),
         "never-there": (never_there_before, 400_000), "margin": (at_margins, 400_000)}
"""What `--only` names: who prints it, and where its seeds begin."""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=5_000_001, help="1,000,001 was used while the check was made")
    parser.add_argument("--sequences", type=int, default=2000,
                        help="random limbs, at most 600 at postures of their choice")
    parser.add_argument("--only", nargs="+", choices=PARTS, default=list(PARTS), help="these parts")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    options = parser.parse_args()
    met = True

    def bound(name: str, reached: bool) -> None:
        nonlocal met
        met = met and reached
        print(f"  {'met    ' if reached else 'NOT MET'} {name}", flush=True)

    with ProcessPoolExecutor(options.jobs) as pool:
        for part in options.only:
            show, first = PARTS[part]
            show(pool, options.seed + first, options.sequences, bound)
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())
