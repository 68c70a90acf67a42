"""What to measure next: of the loading tests that the rig could make, the shortest that tells the named
effect from its rivals about as well as any of them could."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from brace.diagnose.diagnosis import NextExperiment
from brace.diagnose.loading.next_experiment.by_hand import orders
from brace.diagnose.loading.next_experiment.menu import (
    BEFORE_S,
    CHANNELS,
    ENCODER_NOISE_RAD,
    ENCODERS,
    GAUGE,
    GAUGE_NOISE_MM,
    GROUPS,
    Condition,
    as_record,
    conditions,
    postures,
)
from brace.identify.record import Record
from brace.diagnose.loading.next_experiment.separation import (
    Contender,
    Played,
    contenders,
    lambda_squared,
    no_rivals,
    pairs_separated,
    play,
    power,
    weights,
)
from brace.diagnose.loading.troubles.kinds import ZERO_STEP, ZEROS
from brace.diagnose.options import Options
from brace.model import LimbModel

if TYPE_CHECKING:
    from brace.diagnose.loading.search_pass import Pass

POSTURES_AND_REPEATS = ((3, 1), (5, 1), (8, 1), (8, 2), (8, 4))
GOOD_ENOUGH = 0.99  # a test that is as sure as this need not be surer
NEAR_BEST = 0.01  # of worth that is given up for a shorter test
NO_POWER = 0.05  # below it nothing is separated
LIKELY = 0.8  # power below which the report also says what else to do


@dataclass(frozen=True)
class Plan:
    """A test in full. `worth` [0, 1]: the mean of its power and of the share of pairs that it tells apart."""

    condition: Condition
    angles: np.ndarray
    repeats: int
    encoders: bool
    gauge: bool
    minutes: float
    worth: float


def next_experiment(
    record: Record, final: Pass, believed: LimbModel, options: Options
) -> NextExperiment | None:
    """None where the best set has no rival at all."""
    record = final.record  # the same rows, with the noise that the fits were made with
    hypotheses = contenders(final.sets)
    if no_rivals(hypotheses).all():
        return None
    first = hypotheses[0].fit.model
    limits = {f"motor.{joint}.angle_{end}_rad": believed.number(f"motor.{joint}.angle_{end}_rad")
              for joint in ("femur", "tibia") for end in ("min", "max")}  # fmt: skip
    angles = postures(record, limits)
    plans = [
        plan
        for condition in conditions(record, [item.fit for item in hypotheses], wanders=_zero_wanders(final))
        for plan in _plans(record, hypotheses, condition, angles, first)
    ]
    best = _shortest_of_the_best(plans)
    test = as_record(record, best.condition, best.angles, first)
    played = play(test, hypotheses, GROUPS)
    amount = (
        best.repeats * _read(best.encoders, best.gauge)[None, :, None] * np.ones((1, 1, len(best.angles)))
    )
    found = lambda_squared(played, hypotheses, amount)
    chance = float(power(found, hypotheses)[0])
    separates = _separated(hypotheses)
    other = "; or ".join(orders(separates)) if chance < LIKELY else ""
    if chance < NO_POWER:
        return NextExperiment(
            f"nothing on this rig's menu separates {' and '.join(separates)}: other postures, larger, "
            "smaller, slower, preloaded or repeated runs, warmth, encoders and a dial gauge would all read "
            f"the same{f'. Instead, {other}' if other else ''}",
            separates,
            chance,
            best.minutes,
        )
    return NextExperiment(
        _in_words(record, best, separates) + (f". Surer still: {other}" if other else ""),
        separates,
        chance,
        round(best.minutes, 1),
        _rig_toml(record, best, options.seed),
    )


def _zero_wanders(final: Pass) -> bool:
    """Whether the sensor's zero moved in this record, or may have."""
    return any(one is not None and one.name in (ZERO_STEP, ZEROS) for one in (*final.troubles, final.rival))


def _plans(
    record: Record,
    hypotheses: Sequence[Contender],
    condition: Condition,
    angles: np.ndarray,
    first: np.ndarray,
) -> Iterator[Plan]:
    """The best postures for each choice of instruments, in several numbers."""
    played = play(as_record(record, condition, angles, first), hypotheses, GROUPS)
    for encoders, gauge in _instruments(record):
        order = _best_postures(played, hypotheses, _read(encoders, gauge), POSTURES_AND_REPEATS[-1][0])
        sizes = [(count, repeats) for count, repeats in POSTURES_AND_REPEATS if count <= len(order)]
        amount = np.zeros((len(sizes), len(GROUPS), len(angles)))
        for row, (count, repeats) in enumerate(sizes):
            amount[row][:, order[:count]] = repeats * _read(encoders, gauge)[:, None]
        found = lambda_squared(played, hypotheses, amount)
        worths = 0.5 * (power(found, hypotheses) + pairs_separated(found, hypotheses))
        for (count, repeats), worth in zip(sizes, worths):
            minutes = condition.minutes(count, repeats, encoders, gauge, record)
            yield Plan(condition, angles[order[:count]], repeats, encoders, gauge, minutes, float(worth))


def _instruments(record: Record) -> list[tuple[bool, bool]]:
    """(encoders, gauge); what the record has stays on."""
    return [
        (encoders, gauge)
        for encoders in ((True,) if ENCODERS[0] in record.channels else (False, True))
        for gauge in ((True,) if set(GAUGE) & set(record.channels) else (False, True))
    ]


def _read(encoders: bool, gauge: bool) -> np.ndarray:
    """Which of GROUPS are read."""
    return np.array([1.0, float(encoders), float(gauge)])


def _best_postures(played: Played, hypotheses: Sequence[Contender], read: np.ndarray, most: int) -> list[int]:
    """One after the other, the posture that separates most together with those before it."""
    share = weights(hypotheses)
    none = no_rivals(hypotheses)
    configs = played.square.shape[1]
    chosen: list[int] = []
    while len(chosen) < min(most, configs):
        left = [place for place in range(configs) if place not in chosen]
        amount = np.zeros((len(left), len(GROUPS), configs))
        amount[:, :, chosen] = read[:, None]
        for row, place in enumerate(left):
            amount[row, :, place] = read
        found = np.log1p(lambda_squared(played, hypotheses, amount))
        worst = np.where(none, np.inf, found).min(axis=2)
        worth = np.where(np.isfinite(worst), worst, 0.0) @ share
        chosen.append(left[int(np.argmax(worth))])
    return chosen


def _shortest_of_the_best(plans: Sequence[Plan]) -> Plan:
    """Gain per minute, where gain beyond enough is worth nothing. Of equal ones the first: the record's way."""
    enough = min(GOOD_ENOUGH, max(plan.worth for plan in plans) - NEAR_BEST)
    return min((plan for plan in plans if plan.worth >= enough), key=lambda plan: plan.minutes)


def _separated(hypotheses: Sequence[Contender]) -> tuple[str, ...]:
    """The best set and its rivals."""
    return tuple(dict.fromkeys(item.label for item in hypotheses))


def _in_words(record: Record, plan: Plan, separates: Sequence[str]) -> str:
    angles = "; ".join(f"{one:.3f}, {two:.3f}" for one, two in plan.angles)
    rig = plan.condition.rig
    often = {1: "once", 2: "twice"}.get(plan.repeats, f"{plan.repeats} times")
    words = (
        f"load the limb at {len(plan.angles)} postures (theta1, theta2 [rad]: {angles}), along x and z, "
        f"{often} each, {rig['rig.steps']} steps of {rig['rig.step_mm']:g} mm to each side, "
        f"{rig['rig.dwell_s']:g} s before each reading"
    )
    newly_zeroed = rig["rig.zeroed"] == "per_run" and not record.dataset.meta.zeroed_per_run
    if newly_zeroed:
        words += ", the sensor zeroed before each run"
    if plan.condition.name != "again":
        words += f", {plan.condition.words}"
    mounted = []
    if plan.encoders and ENCODERS[0] not in record.channels:
        mounted.append("encoders on the joints' output sides")
    if plan.gauge and not set(GAUGE) & set(record.channels):
        mounted.append("a dial gauge on the base along x and z")
    if mounted:
        words += f", with {' and '.join(mounted)} besides"
    # a record is zeroed before every run or before none
    then = "diagnose the new runs by themselves" if newly_zeroed else "add the rows to this record and diagnose again"
    return f"{words}: about {plan.minutes:.0f} min; {then}"


def _rig_toml(record: Record, plan: Plan, seed: int) -> str:
    """What `brace simulate --rig` plays, with this record's noise."""
    meta = record.dataset.meta
    noise = record.noise
    values: dict[str, dict[str, object]] = {
        "": {"format": 1, "title": "the next experiment", "seed": seed + 1},
        "rig": {
            **{
                key.removeprefix("rig."): value
                for key, value in plan.condition.rig.items()
                if key.startswith("rig.")
            },
            "repeats": plan.repeats,
            "start_s": round(float(record.dataset["t_s"][-1]) + BEFORE_S, 3),
        },
        "sensor": {
            "noise_n": float(f"{np.hypot(noise['fx_n'].floor, noise['fz_n'].floor) / np.sqrt(2.0):.3g}"),
            "resolution_n": _resolution_n(record),
            "range_n": meta.number("sensor.range_n"),
            "encoders": plan.encoders,
            "encoder_noise_rad": _floor(record, ENCODERS[0], ENCODER_NOISE_RAD),
            "base_gauge": plan.gauge,
            "base_noise_mm": _floor(record, GAUGE[0], GAUGE_NOISE_MM),
        },
        "temperature": {
            key.removeprefix("temperature."): value
            for key, value in plan.condition.rig.items()
            if key.startswith("temperature.")
        },
    }
    lines = []
    for table, entries in values.items():
        lines += [f"\n[{table}]"] if table else []
        lines += [f"{key} = {_toml(value)}" for key, value in entries.items()]
    for theta1, theta2 in plan.angles:
        lines += ["\n[[configuration]]", f"theta1_rad = {theta1:.6f}", f"theta2_rad = {theta2:.6f}"]
    return "\n".join(lines) + "\n"


def _resolution_n(record: Record) -> float:
    """What readings are rounded to: the sensor's resolution, or nothing where the rig gives averages."""
    step = record.dataset.meta.number("sensor.resolution_n")
    if step <= 0.0:
        return 0.0
    off = np.abs(record.measured[:2] / step - np.round(record.measured[:2] / step))
    return step if float(np.median(off)) * step < 1e-5 else 0.0


def _floor(record: Record, channel: str, stated: float) -> float:
    assert channel in CHANNELS
    return float(f"{record.noise[channel].floor:.3g}") if channel in record.noise else stated


def _toml(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, float) and np.isinf(value):
        return "inf"
    return repr(value)
