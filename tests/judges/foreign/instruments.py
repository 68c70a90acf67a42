"""Loading records of the engine's limbs by instruments that misbehave: nothing else hidden, or one effect."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from designs import Design, Rng
from files import Table, noisy, table_of
from generate import Retry, make_none, make_single
from plant import INDEX, Array
from worlds import World, world_called

Whole = npt.NDArray[np.intp]
RUN, TH1, TH2, TIME, DX, DZ = 0, 1, 2, 3, 5, 6
HIDDEN_S = (25.0, 60.0)  # how detectable the effect is that is hidden beside a trouble


@dataclass(frozen=True)
class Trouble:
    """What one trouble does to a record, at each of the places where a rig or a recorder can do it: to the test's
    design, to what is moved, to the true rig, to clean readings, to the file. All numbers are drawn first, so that
    they are the same for the believed limb, by which its trace is measured, and for the true one."""

    design: Callable[[Design], Design] = lambda d: d
    moved: Callable[[Array], Array] = lambda rows: rows
    limb: Callable[[Array], Array] = lambda p: p
    readings: Callable[[Design, Array], Array] = lambda _d, r: r
    file: Callable[[Design, Table], None] = lambda _d, _t: None
    about: tuple[tuple[str, float], ...] = ()


def _runs(design: Design) -> tuple[Whole, Whole]:
    """Each row's run, from 0; and the first row of each."""
    _, first, back = np.unique(design.rows[:, RUN], return_index=True, return_inverse=True)
    return back.ravel().astype(np.intp), first.astype(np.intp)


def gain_step(rng: Rng, design: Design) -> Trouble:
    """From some reading on, half of them between two runs, the gain is 4 to 6 % another one."""
    factor = 1.0 + rng.choice([-1.0, 1.0]) * rng.uniform(0.04, 0.06)
    at = int(rng.uniform(0.25, 0.75) * len(design.rows))
    if rng.random() < 0.5:
        at = int(_runs(design)[1][_runs(design)[0][at]])

    def readings(_d: Design, r: Array) -> Array:
        out = r.copy()
        out[at:, :2] *= factor
        return out

    return Trouble(readings=readings, about=(("factor", factor), ("row", at)))


def zero_per_part(rng: Rng, design: Design) -> Trouble:
    """Two to four parts of the record, each with zeros of its own: 0.2 to 1 N."""
    if design.zeroed:
        raise Retry("a sensor that is zeroed before each run has no such zeros")
    run, first = _runs(design)
    parts = int(rng.integers(2, 5))
    cuts = np.sort(rng.choice(np.arange(1, len(first)), parts - 1, replace=False))
    part = np.searchsorted(cuts, run, side="right")
    zeros = rng.uniform(0.2, 1.0) * rng.standard_normal((parts, 2))
    zeros[0] = 0.0

    def readings(_d: Design, r: Array) -> Array:
        out = r.copy()
        out[:, :2] += zeros[part]
        return out

    return Trouble(readings=readings, about=(("parts", parts),))


def pose_error(rng: Rng, design: Design) -> Trouble:
    """In each run both joints stand 3 mrad (one sigma) off."""
    run, first = _runs(design)
    off = 0.003 * rng.standard_normal((len(first), 2))

    def moved(rows: Array) -> Array:
        out = rows.copy()
        out[:, TH1 : TH2 + 1] += off[run]
        return out

    return Trouble(moved=moved)


def lag(rng: Rng, _design: Design) -> Trouble:
    """A rig that moves without a stop and reads every 0.1 to 0.3 s; forces are 20 to 100 ms late."""
    interval_s, late_s = round(rng.uniform(0.1, 0.3), 3), rng.uniform(0.02, 0.1)

    def design(d: Design) -> Design:
        run, first = _runs(d)
        rows = d.rows.copy()
        rows[:, TIME] = np.round(np.arange(len(rows)) * interval_s + 2.0 * run, 6)
        return replace(d, rows=rows, dwell_s=interval_s)

    def readings(d: Design, r: Array) -> Array:
        out = r.copy()
        run, _ = _runs(d)
        for number in np.unique(run):
            here = np.flatnonzero(run == number)
            t = d.rows[here, TIME]
            for column in (0, 1):
                out[here, column] = np.interp(t - late_s, t, r[here, column])
        return out

    return Trouble(design=design, readings=readings, about=(("late_s", late_s), ("interval_s", interval_s)))


def clock_origin(rng: Rng, _design: Design) -> Trouble:
    """The clock counts from the machine's start, or from 1970."""
    start_s = 1e4 if rng.random() < 0.5 else float(round(rng.uniform(1.6e9, 1.75e9)))

    def file(_d: Design, table: Table) -> None:
        table["t_s"] = [start_s + t for t in table["t_s"]]

    return Trouble(file=file, about=(("start_s", start_s),))


def outliers(rng: Rng, design: Design) -> Trouble:
    """Five of 800 readings are off by a tenth to a half of the largest force."""
    count = max(3, round(5 * len(design.rows) / 800))
    at = rng.choice(len(design.rows), count, replace=False)
    axes = rng.integers(2, size=count)
    off = rng.choice([-1.0, 1.0], count) * rng.uniform(0.1, 0.5, count)

    def file(_d: Design, table: Table) -> None:
        for row, axis, share in zip(at, axes, off, strict=True):
            values = table["fx_n" if axis == 0 else "fz_n"]
            values[row] += float(share * np.max(np.abs(values)))

    return Trouble(file=file, about=(("count", count),))


def coarse_resolution(rng: Rng, _design: Design) -> Trouble:
    """Forces in whole steps of 0.25 to 1 N, joint encoders of 16 to 18 bits; meta.toml says so of half
    of the forces."""
    step_n, count_rad = float(rng.choice([0.25, 0.5, 1.0])), 2.0 * np.pi / 2 ** int(rng.integers(16, 19))
    is_stated = rng.random() < 0.5

    def design(d: Design) -> Design:
        return replace(d, noise=replace(d.noise, rounding_n=step_n), resolution_n=step_n if is_stated else d.resolution_n)

    def file(_d: Design, table: Table) -> None:
        for name in ("enc1_rad", "enc2_rad"):
            if name in table:
                table[name] = [round(v / count_rad) * count_rad for v in table[name]]

    return Trouble(design=design, file=file, about=(("step_n", step_n), ("told", float(is_stated))))


def _limb(key: str, value: float) -> Trouble:
    def limb(p: Array) -> Array:
        out = p.copy()
        out[INDEX[key]] = value
        return out

    return Trouble(limb=limb, about=((key, value),))


def rig_rotation(rng: Rng, _design: Design) -> Trouble:
    """The rig's axes are turned by 30 to 50 mrad."""
    return _limb("outside.rig_turn_rad", float(rng.choice([-1.0, 1.0])) * rng.uniform(0.03, 0.05))


def rig_compliance(rng: Rng, _design: Design) -> Trouble:
    """The rig yields by 0.005 to 0.04 mm/N."""
    return _limb("outside.rig_mm_per_n", rng.uniform(0.005, 0.04))


def posture_clearance(rng: Rng, design: Design) -> Trouble:
    """At one posture the tip is held with a clearance of 10 to 40 % of the stroke; the tip lies on the side to which
    the force presses it."""
    stroke = float(np.max(np.abs(design.rows[:, DX : DZ + 1])))
    half = 0.5 * stroke * rng.uniform(0.1, 0.4)
    here = design.config == int(rng.choice(np.unique(design.config)))

    def moved(rows: Array) -> Array:
        out = rows.copy()
        d = rows[here, DX : DZ + 1]
        out[here, DX : DZ + 1] = np.sign(d) * np.maximum(0.0, np.abs(d) - half)
        return out

    return Trouble(moved=moved, about=(("clearance_mm", 2.0 * half),))


TROUBLES: dict[str, Callable[[Rng, Design], Trouble]] = {
    kind.__name__: kind
    for kind in (
        gain_step, zero_per_part, pose_error, lag, clock_origin, outliers, coarse_resolution, rig_rotation,
        rig_compliance, posture_clearance,
    )
}  # fmt: skip


@dataclass
class Loaded:
    """A loading case: what the tool sees, and the truth."""

    design: Design
    table: Table
    case: dict[str, Any]
    truth: dict[str, Any]


def make(rng: Rng, trouble: str, hidden: int | None) -> Loaded:
    """A record with a trouble ("" for none), and the effect of that number of the catalogue (None for none)."""
    world = world_called("engine")
    if hidden is None:
        case = make_none(world, rng)
    else:
        case = make_single(world, rng, hidden, float(rng.choice(HIDDEN_S)))
    shown: Design = case["shown"]
    one = TROUBLES[trouble](rng, shown) if trouble else Trouble()
    design = one.design(shown)

    def played(p: Array) -> Array:
        rows = one.moved(design.rows)
        return one.readings(design, world.play(one.limb(p), rows))

    truth = dict(case["truth"])
    truth |= {"trouble": trouble, "about": dict(one.about), "trouble_s": _trace(world, case, design, one, played)}
    table = table_of(design, noisy(rng, design, played(case["limb"])))
    one.file(design, table)
    return Loaded(design, table, case, truth)


def _trace(
    world: World, case: dict[str, Any], design: Design, one: Trouble, played: Callable[[Array], Array]
) -> float | None:
    """How many sigmas a trouble leaves of the believed limb's record after refitting the base. None where only the
    file or the noise changes: that is not measured in sigmas."""
    if one.moved is Trouble().moved and one.limb is Trouble().limb and one.readings is Trouble().readings:
        return None
    judge = world.bench(design, case["believed"], case["trust"])
    return round(float(judge.s_of_record(judge.in_sigmas(played(case["believed"])))), 2)


def drawn(seed: list[int], trouble: str, hidden: int | None) -> Loaded:
    """As make, drawn again where a limb or an effect cannot be made as wanted."""
    for attempt in range(40):
        try:
            return make(np.random.default_rng([*seed, attempt]), trouble, hidden)
        except (Retry, np.linalg.LinAlgError, ArithmeticError, ValueError):
            continue
    raise RuntimeError(f"no record with {trouble or 'no trouble'} and effect {hidden}")
