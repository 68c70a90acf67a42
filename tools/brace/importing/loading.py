"""A loading record out of converted tables: posture, axis, runs, repeats, clock; what was not measured stays unread."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from brace.ground.errors import BadFileError
from brace.ground.units import unit_of
from brace.importing.along import Columns, axis_of, displacements, forces
from brace.importing.mapping import MappingTable
from brace.importing.part import Table
from brace.importing.runs import ANGLE_JUMP_RAD, boundaries, numbers_of_poses, without_turns

SAME_RAD = 1e-3
HELD_RAD = 0.06  # a commanded angle that is read back moves by so much at most while the limb is loaded
OPTIONAL = ("enc1_rad", "enc2_rad", "base_x_mm", "base_z_mm")
LOADED_RATIO = 0.05  # of the largest work along an axis: less is a row at rest
SOFT_AXIS_RATIO = 3e-3  # of the largest work on the tip: less is noise at a displacement, or friction at rest
OTHER_AXIS_RATIO = 10.0  # work across over work along: a limb that is free across its axis has no force there
FEW_RATIO = 0.05  # of the rows: so many may be slips
SIDEWAYS_RATIO = 0.3  # of a step along the axis: what a gauge across it may read of a tip that does not move there


def assembled(tables: Sequence[Table], mapping: MappingTable, notes: list[str]) -> tuple[Columns, dict[str, object]]:
    """Columns of data.csv, and tables of meta.toml."""
    pieces = [_piece(table, mapping, notes) for table in _joined(tables, notes)]
    _same_clock(pieces, notes)
    names = ["t_s", "theta1_rad", "theta2_rad", "axis", "dx_mm", "dz_mm", "fx_n", "fz_n", "begins"]
    names += [name for name in (*OPTIONAL, "temp_degc") if all(name in piece for piece in pieces)]
    for name in (*OPTIONAL, "temp_degc"):
        if name not in names and any(name in piece for piece in pieces):
            notes.append(f"{name} is left out: it is not in every file")
    joined = {name: np.concatenate([piece[name] for piece in pieces]) for name in names}
    begins = joined.pop("begins").astype(bool)
    run = np.cumsum(begins).astype(np.int32)
    joined = _held_angles(joined, run, notes)
    joined, run = _without_single_blanks(joined, run, notes)
    starts = np.flatnonzero(np.diff(run, prepend=0))
    _relative(joined, run, mapping, notes)
    joined["config"] = numbers_of_poses(joined["theta1_rad"], joined["theta2_rad"], SAME_RAD)
    rep, step = _repeats_and_steps(joined, run, starts)
    if "temp_degc" in joined:
        joined["temp_degc"] = _held_temperature(joined["temp_degc"], notes)
    else:
        notes.append("no temperature was recorded: its effect cannot be judged")
    if rep.max() == 1:
        notes.append("no run was repeated: the noise is estimated from how smooth each run is")
    for axis, name in ((0, "fx_n"), (1, "fz_n")):
        unread = np.isnan(joined[name])
        if unread.all():
            notes.append(f"{name} was not measured: its column is empty")
        elif unread.any():
            notes.append(f"{name} was not measured in {len(np.unique(run[unread]))} of {len(starts)} runs: empty there")
    extra: dict[str, object] = {}
    weights = any("weight_n" in table.columns for table in tables)
    if weights or _moves_across(joined, run):
        extra["rig"] = {"moved_by": "weights" if weights else "motors"}
        if not weights:
            notes.append("the tip also moves across the axis of its run: meta.toml says so (moved_by)")
    if _zeroed(joined, starts):
        extra["zeroed"] = "per_run"
        notes.append('every run\'s first force is 0: taken as zeroed before each run (zeroed = "per_run")')
    order = ("run", "config", "theta1_rad", "theta2_rad", "axis", "rep", "step", "t_s", "temp_degc", "dx_mm", "dz_mm",
             "fx_n", "fz_n", *OPTIONAL)  # fmt: skip
    joined |= {"run": run, "rep": rep, "step": step, "axis": joined["axis"].astype(np.int32)}
    both = {name: joined[name] for name in order if name in joined}
    for name in ("fx_n", "fz_n"):
        if np.isnan(both[name]).all():
            del both[name]
    return both, extra


def _moves_across(joined: Columns, run: np.ndarray) -> bool:
    """Whether the tip moves across the axis by more than a share of a step."""
    along, across = (np.where((joined["axis"] == 1) == way, joined["dz_mm"], joined["dx_mm"]) for way in (True, False))
    steps = np.abs(np.diff(along))[np.diff(run) == 0]
    steps = steps[steps > 1e-9]
    most = max(
        (float(np.abs(across[rows] - np.median(across[rows])).max()) for rows in _of_each(run)), default=0.0
    )
    return bool(steps.size) and most > SIDEWAYS_RATIO * float(np.median(steps))


def _of_each(numbers: np.ndarray) -> list[np.ndarray]:
    """The rows of each number, in the order of the numbers."""
    order = np.argsort(numbers, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(numbers[order])) + 1) if len(order) else []


def _joined(tables: Sequence[Table], notes: list[str]) -> list[Table]:
    """Tables side by side where one has what the other lacks and both have the same clock; else as they are."""
    whole = [table for table in tables if _moves(table) and _pushes(table)]
    if len(whole) == len(tables):
        return list(tables)
    lacking = next(table for table in tables if table not in whole)
    has, lacks = ("forces", "displacements") if _pushes(lacking) else ("displacements", "forces")
    if not _pushes(lacking) and not _moves(lacking):
        has, lacks = "neither", "displacements and forces"
    partners = [table for table in tables if table is not lacking and len(table.part.rows) == len(lacking.part.rows)]
    for other in partners:
        if "t_s" in other.columns and "t_s" in lacking.columns and len(tables) == 2:
            a, b = other.columns["t_s"], lacking.columns["t_s"]
            if len(a) == len(b) and np.allclose(a, b, rtol=0, atol=1e-6 + 0.01 * float(np.median(np.abs(np.diff(a))))):
                notes.append(f"{lacking.part.path.name} and {other.part.path.name} have one clock: joined row by row")
                first = tables[0]
                return [type(first)(first.part, {**lacking.columns, **other.columns}, {**lacking.texts, **other.texts})]
    raise BadFileError(
        f"{lacks} are missing",
        where=lacking.part.where,
        why=f"a loading record has displacement and force side by side, and this table has {has}"
        + ("; its rows are not those of the other file, by their clocks" if len(tables) > 1 else ""),
        next_step="join the tables by time into one before importing, or map the column that holds them",
    )


def _moves(table: Table) -> bool:
    return bool({"dx_mm", "dz_mm", "d_mm"} & set(table.columns))


def _pushes(table: Table) -> bool:
    return bool({"fx_n", "fz_n", "f_n", "weight_n"} & set(table.columns))


def _piece(table: Table, mapping: MappingTable, notes: list[str]) -> Columns:
    """One table: all columns that a loading record has, and `begins`, 1 where a run begins."""
    columns = table.columns
    rows = len(next(iter(columns.values())))
    out: Columns = {name: columns[name] for name in (*OPTIONAL, "temp_degc") if name in columns}
    for name in ("theta1_rad", "theta2_rad"):
        out[name] = columns[name] if name in columns else np.full(rows, _constant(table, mapping, name))
        out[name], turns = without_turns(out[name])
        if turns:
            times = "once" if turns == 1 else f"{turns} times"
            notes.append(
                f"{table.part.places[0]}: {name} leaps by a whole turn {times}: the same angle, taken as going on from "
                "the reading before"
            )
    if "temp_degc" not in out and (degc := mapping.constant(table.part.places, "temp_degc")) and degc.value != "?":
        out["temp_degc"] = np.full(rows, _constant(table, mapping, "temp_degc"))
    out["t_s"] = columns["t_s"] if "t_s" in columns else _constant(table, mapping, "dwell_s") * np.arange(rows)
    if "t_s" not in columns:
        notes.append(f"{table.part.places[0]}: there is no time; t_s is the row number times dwell_s")
    given = np.zeros(rows, bool)
    given[0] = True
    for name in ("run", "rep", "config"):
        if name in table.texts:
            texts = table.texts[name]
            given[1:] |= np.array([a != b for a, b in zip(texts[:-1], texts[1:])], bool)
    for name in ("theta1_rad", "theta2_rad"):
        given[1:] |= np.abs(np.diff(out[name])) > ANGLE_JUMP_RAD
    given[1:] |= np.diff(out["t_s"]) < 0.0
    axis = axis_of(table, mapping, rows, np.cumsum(given) if "yes" in _relatives(mapping) else np.ones(rows, int))
    given[1:] |= np.diff(axis) != 0
    out |= displacements(table, axis, rows, notes)
    along = np.where(axis == 1, out["dz_mm"], out["dx_mm"])
    group = np.cumsum(given)
    middle = along - along[np.searchsorted(group, group)] if "yes" in _relatives(mapping) else along
    numbered = len(set(table.texts.get("run", ()))) > 1
    out["begins"] = given if numbered else boundaries(middle, given)
    out["axis"] = axis
    out |= forces(table, axis, rows, notes)
    if len({"dx_mm", "dz_mm", "d_mm"} & set(columns)) > 1 and "weight_n" not in columns:
        _loaded_as_said(table, axis, out, group)
    return out


def _loaded_as_said(table: Table, axis: np.ndarray, out: Columns, group: np.ndarray) -> None:
    """Refuses an axis that the readings contradict. A load does its work along its own axis, whether the tip is held
    or free across it; a limb that is loaded along x and z by turns does it along the other in the other's rows."""
    efforts = []
    unread = any(np.isnan(out[name]).any() for name in ("fx_n", "fz_n"))
    firsts = np.searchsorted(group, group)  # the first row of each row's group, where it was unloaded
    for moved, pushed in (("dx_mm", "fx_n"), ("dz_mm", "fz_n")):
        d = out[moved] - out[moved][firsts]
        efforts.append(d * d if unread else np.abs(d * (out[pushed] - out[pushed][firsts])))
    along, across = (np.where((axis == 1) == way, efforts[1], efforts[0]) for way in (True, False))
    other = (across > OTHER_AXIS_RATIO * along) & (across > LOADED_RATIO * float(across.max()))
    other &= across > SOFT_AXIS_RATIO * max(float(np.max(efforts)), 1e-12)
    loaded = other | (along > LOADED_RATIO * float(along.max()))
    if np.count_nonzero(other) < 3 or np.count_nonzero(other) <= FEW_RATIO * np.count_nonzero(loaded):
        return
    said = "z" if axis[np.flatnonzero(other)[0]] else "x"
    raise BadFileError(
        f"the axis is said to be {said}, and {np.count_nonzero(other)} of {np.count_nonzero(loaded)} loaded rows are "
        f"loaded along {'x' if said == 'z' else 'z'}",
        where=table.part.where,
        why="a run is loaded along one axis",
        next_step="a column that says x or z in each row, or one file for each axis with --set FILE:axis=x",
    )


def _relatives(mapping: MappingTable) -> list[str]:
    return [use.relative for use in mapping.columns if use.used and {"dx_mm", "dz_mm", "d_mm"} & set(use.targets)]


def _constant(table: Table, mapping: MappingTable, target: str) -> float:
    found = mapping.constant(table.part.places, target)
    if found is None or found.value == "?":
        ask = {
            "theta1_rad": "--set theta1=42deg", "theta2_rad": "--set theta2=80deg", "dwell_s": "--set dwell=4s",
        }.get(target, f"--set {target}=VALUE")  # fmt: skip
        what = {"dwell_s": "time between readings"}.get(target, target)
        raise BadFileError(
            f"the {what} is not given",
            where=table.part.where,
            why="no column holds it, and "
            + ("K depends on the posture" if "theta" in target else "creep, drift and friction follow the time"),
            next_step=f"{ask}, or a [[constant]] in the mapping file",
        )
    unit = unit_of(found.unit)
    value = float(found.value)
    return value if unit is None else unit.factor * value + unit.offset


def _same_clock(pieces: list[Columns], notes: list[str]) -> None:
    """One clock for all pieces and runs: one that begins anew goes on where the last one ended."""
    late, again = -math.inf, 0
    for piece in pieces:
        t, begins = piece["t_s"].copy(), piece["begins"].astype(bool)
        steps = np.diff(t)
        usual = float(np.median(steps[steps > 0])) if np.any(steps > 0) else 1.0
        shift = 0.0
        for row in range(len(t)):
            before = late if row == 0 else t[row - 1]
            if begins[row] and t[row] + shift < before:
                shift = before + usual - t[row]
                again += 1
            t[row] += shift
        late = float(t[-1])
        piece["t_s"] = t
    if again:
        notes.append(
            f"the clock begins anew {'once' if again == 1 else f'{again} times'}: nobody knows how long the pause was; "
            "it is written as the time between two readings"
        )


def _held_angles(joined: Columns, run: np.ndarray, notes: list[str]) -> Columns:
    """The commanded angle is one number a run: where it was read back, its median stands for it."""
    for name in ("theta1_rad", "theta2_rad"):
        values = joined[name].copy()
        most = 0.0
        for rows in _of_each(run):
            spread = float(np.ptp(values[rows]))
            if 0.0 < spread <= HELD_RAD:
                most = max(most, spread)
                values[rows] = np.median(values[rows])
        if most > 1e-6:
            notes.append(
                f"{name} varies by up to {most:.2g} rad within a run: the run's median is taken as the commanded angle"
            )
        joined[name] = values
    poses = numbers_of_poses(joined["theta1_rad"], joined["theta2_rad"], 5 * SAME_RAD)
    for name in ("theta1_rad", "theta2_rad"):
        for pose, rows in enumerate(_of_each(poses), start=1):
            if 0.0 < np.ptp(joined[name][rows]):
                notes.append(
                    f"{name} of pose {pose} differs by {np.ptp(joined[name][rows]):.2g} rad between runs: their median "
                    "is taken"
                )
                joined[name][rows] = np.median(joined[name][rows])
    return joined


def _without_single_blanks(joined: Columns, run: np.ndarray, notes: list[str]) -> tuple[Columns, np.ndarray]:
    """A force, encoder or gauge that is blank through a run was not read there; single blank entries take their row."""
    drop = np.zeros(len(run), bool)
    for name in ("fx_n", "fz_n", *OPTIONAL):
        if name not in joined:
            continue
        blank = np.isnan(joined[name])
        whole = np.isin(run, [run[rows[0]] for rows in _of_each(run) if blank[rows].all()])
        single = blank & ~whole & ~drop
        if single.any():
            count = int(single.sum())
            notes.append(
                f"{count} row{'s' if count > 1 else ''} left out: {name} is blank there and not in all of the run"
            )
        drop |= single
    if not drop.any():
        return joined, run
    kept = run[~drop]
    return {name: values[~drop] for name, values in joined.items()}, kept


def _relative(joined: Columns, run: np.ndarray, mapping: MappingTable, notes: list[str]) -> None:
    if "yes" not in _relatives(mapping):
        return
    for use in mapping.columns:
        if use.relative != "yes":
            continue
        for name in ("dx_mm", "dz_mm") if "d_mm" in use.targets else tuple(set(use.targets) & {"dx_mm", "dz_mm"}):
            for rows in _of_each(run):
                joined[name][rows] -= joined[name][rows[0]]


def _repeats_and_steps(joined: Columns, run: np.ndarray, starts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    rep, step = np.zeros(len(run), np.int32), np.zeros(len(run), np.int32)
    seen: dict[tuple[int, int], int] = {}
    for first, last in zip(starts, [*starts[1:], len(run)]):
        key = int(joined["config"][first]), int(joined["axis"][first])
        seen[key] = seen.get(key, 0) + 1
        rep[first:last] = seen[key]
        step[first:last] = np.arange(last - first)
    return rep, step


def _held_temperature(degc: np.ndarray, notes: list[str]) -> np.ndarray:
    blank = np.isnan(degc)
    if not blank.any():
        return degc
    notes.append(f"temp_degc is blank in {int(blank.sum())} of {blank.size} rows: the reading before is taken there")
    known = np.flatnonzero(~blank)
    return np.asarray(degc[known[np.clip(np.searchsorted(known, np.arange(degc.size), "right") - 1, 0, None)]])


def _zeroed(joined: Columns, starts: np.ndarray) -> bool:
    """Every run's first force is exactly 0, and others are not."""
    first = np.concatenate([joined[name][starts] for name in ("fx_n", "fz_n")])
    first = first[~np.isnan(first)]
    return len(starts) >= 3 and first.size > 0 and not np.any(first)
