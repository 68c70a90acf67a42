"""What can be wrong with a table of stiffness matrices, and what its print rounding leaves undetermined."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from brace.dataset.columns import ANGLE_LIMIT_RAD, FULL_TURN_RAD
from brace.dataset.faults import DataFault
from brace.dataset.meta import Meta
from brace.dataset.unit_slips import STIFFNESS_UNITS
from brace.ground.errors import did_you_mean

Columns = Mapping[str, np.ndarray]

# A tip held by servo springs at the levers of a limb of some hundred millimetres: K lies well inside this.
PLAUSIBLE_N_PER_MM = (1e-3, 1e3)
LOADING_STROKE_MM = 2.5  # largest deflection that a test of such a limb imposes
DEFAULT_RESOLUTION_N = 1 / 16


def printed_decimals(path: Path, rows: Sequence[bytes]) -> dict[str, int]:
    """The most decimals with which each column is printed."""
    header = path.read_bytes().partition(b"\n")[0].decode("utf-8-sig", "replace").split(",")
    decimals = dict.fromkeys((name.strip().strip('"') for name in header), 0)
    for row in rows:
        for name, text in zip(decimals, row.split(b",")):
            mantissa = text.strip().lower().partition(b"e")
            places = len(mantissa[0].partition(b".")[2])
            exponent = int(mantissa[2] or 0) if mantissa[2].lstrip(b"+-").isdigit() else 0
            decimals[name] = max(decimals[name], min(places - exponent, 17))
    return decimals


def faults(columns: Columns, decimals: Mapping[str, int], meta: Meta) -> list[DataFault]:
    """Every fault found, and the rows whose smaller eigenvalue the rounding leaves open (not blocking)."""
    asymmetric = list(_asymmetry(columns, decimals))
    contradictory = {fault.row for fault in asymmetric if fault.blocking and fault.row is not None}
    return [
        *_unit(columns, meta),
        *_angles(columns),
        *_duplicates(columns),
        *asymmetric,
        *_eigenvalues(columns, decimals, contradictory),
        *_undetermined(columns, decimals),
    ]


def stiffness(columns: Columns) -> np.ndarray:
    """K as printed, made symmetric: rows x (k_xx, k_xz, k_zz) [N/mm]."""
    return np.column_stack([columns["k_xx"], 0.5 * (columns["k_xz"] + columns["k_zx"]), columns["k_zz"]])


def eigenvalues(k: np.ndarray) -> np.ndarray:
    """rows x (smaller, larger) eigenvalue of rows x (k_xx, k_xz, k_zz)."""
    middle, half = 0.5 * (k[..., 0] + k[..., 2]), np.hypot(0.5 * (k[..., 0] - k[..., 2]), k[..., 1])
    return np.stack([middle - half, middle + half], axis=-1)


def lambda_min_interval(k: np.ndarray, half_unit: np.ndarray) -> np.ndarray:
    """rows x (low, high) [N/mm] of the smaller eigenvalue when each entry may be off by its half unit of print.
    It rises with k_xx and k_zz and falls with |k_xz|, so two corners of the box bound it."""
    towards = np.sign(k[:, 1])
    low = k + np.column_stack([-half_unit[:, 0], towards * half_unit[:, 1], -half_unit[:, 2]])
    shrunk = towards * np.maximum(np.abs(k[:, 1]) - half_unit[:, 1], 0.0)
    high = np.column_stack([k[:, 0] + half_unit[:, 0], shrunk, k[:, 2] + half_unit[:, 2]])
    return np.column_stack([eigenvalues(low)[:, 0], eigenvalues(high)[:, 0]])


def half_units(columns: Columns, decimals: Mapping[str, int]) -> np.ndarray:
    """rows x 3: half a unit of the last printed decimal of k_xx, k_xz, k_zz."""
    units = [0.5 * 10.0 ** -decimals.get(name, 0) for name in ("k_xx", "k_xz", "k_zz")]
    return np.tile(units, (columns["k_xx"].size, 1))


def _unit(columns: Columns, meta: Meta) -> Iterator[DataFault]:
    """The columns are in N/mm. Does what the source says of them agree, and with the sensor and a servo's spring?"""
    k = np.abs(np.concatenate([columns["k_xx"], columns["k_zz"]]))
    typical = float(np.median(k[k > 0])) if (k > 0).any() else 0.0
    resolution_n = meta.number("sensor.resolution_n") or DEFAULT_RESOLUTION_N
    low, high = PLAUSIBLE_N_PER_MM
    unit = meta.unit_as_printed.replace(" ", "")
    factor = STIFFNESS_UNITS.get(unit, 1.0)
    if unit and unit not in STIFFNESS_UNITS:
        near = did_you_mean(unit, STIFFNESS_UNITS)
        yield DataFault(
            None,
            "unit",
            f"source.unit_as_printed = {meta.unit_as_printed!r} is no unit of stiffness that is known here",
            near or "N/mm, once the columns are in it",
        )
        return
    force_n = typical * factor * LOADING_STROKE_MM
    if (
        factor != 1.0
        and typical
        and low <= typical <= high
        and not resolution_n <= force_n <= high * LOADING_STROKE_MM
    ):
        beyond = (
            f"below the sensor's resolution of {resolution_n:.3g} N"
            if force_n < resolution_n
            else "more than any servo holds"
        )
        yield DataFault(
            None,
            "unit",
            f"printed in {unit}, but then the typical force at {LOADING_STROKE_MM} mm would "
            f"be {force_n:.2g} N, {beyond}, and a servo's "
            "spring (about 6e4 N mm/rad) at these levers gives 0.3 to 2.6 N/mm",
            "N/mm",
            repair=True,
            blocking=False,
        )
        return
    if factor != 1.0 and typical:
        yield DataFault(
            None,
            "unit",
            f"source.unit_as_printed says {unit}, which fits (a typical stiffness of {typical * factor:.3g} N/mm); the "
            "columns of data.csv are in N/mm",
            f"{unit}: multiply k and lambda by {factor:.6g}, then drop unit_as_printed",
        )
        return
    if typical and not low <= typical <= high:
        fits = "N/m" if typical > high else "N/um"
        yield DataFault(
            None,
            "unit",
            f"the typical stiffness is {typical:.3g} N/mm: no limb that a servo holds has it; "
            f"the columns fit only in {fits}",
            f"{fits}: multiply by {1e-3 if fits == 'N/m' else 1e3:g}",
        )


def _angles(columns: Columns) -> Iterator[DataFault]:
    """Both angles or none, and in radians."""
    given = [name for name in ANGLE_LIMIT_RAD if name in columns]
    if len(given) == 1:
        yield DataFault(
            None,
            given[0],
            "one angle does not make a posture: without the other the column would be ignored",
            "both theta1_rad and theta2_rad, or neither (r_mm and z_mm then place the tip)",
        )
        return
    for name in given:
        size = np.abs(columns[name])
        beyond = np.flatnonzero(size > ANGLE_LIMIT_RAD[name] + 1e-6)
        what = "more than a turn" if name == "theta1_rad" else "further than a knee can bend"
        if beyond.size > 0.3 * size.size and FULL_TURN_RAD < size.max() <= 360.0:
            yield DataFault(
                None,
                name,
                f"{size.max():g} is {what}; the column fits only in degrees",
                "degrees: multiply by pi/180",
            )
            continue
        for row in beyond[:20]:
            yield DataFault(int(row) + 1, name, f"{columns[name][row]:g} is {what}")


def _duplicates(columns: Columns) -> Iterator[DataFault]:
    table = np.column_stack([values.astype(float) for name, values in columns.items() if name != "row"])
    _, first, inverse = np.unique(table, axis=0, return_index=True, return_inverse=True)
    for row in np.flatnonzero(first[inverse.ravel()] != np.arange(len(table)))[:20]:
        yield DataFault(
            int(row) + 1, "r_mm", f"the row repeats row {first[inverse.ravel()[row]] + 1} entry by entry"
        )


def _asymmetry(columns: Columns, decimals: Mapping[str, int]) -> Iterator[DataFault]:
    """k_xz and k_zx are one number. Where they are not, the printed eigenvalues, or else positive definiteness and
    the sign that the other rows have, show which of the two is the misprint."""
    allowed = 0.5 * 10.0 ** -decimals.get("k_xz", 0) + 0.5 * 10.0 ** -decimals.get("k_zx", 0)
    size = np.sqrt(np.abs(columns["k_xx"] * columns["k_zz"])) + np.minimum(
        np.abs(columns["k_xz"]), np.abs(columns["k_zx"])
    )
    apart = np.abs(columns["k_xz"] - columns["k_zx"])
    own = eigenvalues(stiffness(columns))
    for row in np.flatnonzero(apart > allowed * (1 + 1e-9)):
        stated = _stated(columns, row)
        mean_fits = stated is None or not _contradicts(own[row], stated, decimals)
        if apart[row] <= allowed + 0.5 * size[row] and mean_fits:
            yield DataFault(
                int(row) + 1,
                "k_zx",
                f"differs from k_xz by {apart[row]:.3g} N/mm: cross-talk, a turned sensor "
                "or noise; their mean is used",
                blocking=False,
            )
            continue
        field, value, proven = _wrong_cross_entry(columns, int(row), decimals)
        yield DataFault(
            int(row) + 1,
            field,
            f"k_zx = {columns['k_zx'][row]:g} and k_xz = {columns['k_xz'][row]:g}: K "
            "of an elastic limb is symmetric"
            + (f"; the printed eigenvalues fit {value:g}" if proven else ""),
            value,
            repair=proven,
        )


def _wrong_cross_entry(
    columns: Columns, row: int, decimals: Mapping[str, int]
) -> tuple[str, float | None, bool]:
    """(the misprinted one of k_xz and k_zx, what it should read, whether printed eigenvalues prove it)."""
    entries = {
        "k_zx": float(columns["k_xz"][row]),
        "k_xz": float(columns["k_zx"][row]),
    }  # wrong one -> its value
    main = (float(columns["k_xx"][row]), float(columns["k_zz"][row]))
    own = {field: eigenvalues(np.array([main[0], value, main[1]])) for field, value in entries.items()}
    stated = _stated(columns, row)
    if stated is not None:
        fits = [field for field in entries if not _contradicts(own[field], stated, decimals)]
        if len(fits) == 1:
            return fits[0], entries[fits[0]], True
    if stated is None or len(fits) == 2:
        definite = [field for field in entries if own[field][0] > 0.0]
        if len(definite) == 1:
            return definite[0], entries[definite[0]], False
        others = np.delete(np.sign(columns["k_xz"] + columns["k_zx"]), row)
        usual = float(np.mean(others)) if others.size >= 3 else 0.0
        agree = [field for field, value in entries.items() if value * usual > 0]
        if abs(usual) > 0.6 and len(agree) == 1:
            return agree[0], entries[agree[0]], False
    return "k_zx", None, False


def _stated(columns: Columns, row: int | np.intp) -> np.ndarray | None:
    """(smaller, larger) eigenvalue as printed, if they are."""
    if "lambda_min" not in columns or "lambda_max" not in columns:
        return None
    return np.array([columns["lambda_min"][row], columns["lambda_max"][row]])


def _eigenvalues(columns: Columns, decimals: Mapping[str, int], skip: set[int]) -> Iterator[DataFault]:
    """`skip` holds rows (1-based) whose cross entries contradict each other."""
    k = stiffness(columns)
    own = eigenvalues(k)
    for row in range(len(k)):
        indefinite = own[row, 0] <= 0.0
        stated = _stated(columns, row)
        contradicted = stated is not None and _contradicts(own[row], stated, decimals)
        if row + 1 in skip or not (indefinite or contradicted):
            continue
        why = (
            f"K is not positive definite (eigenvalues {own[row, 0]:.3g}, {own[row, 1]:.3g} N/mm)"
            if indefinite
            else f"K has eigenvalues {own[row, 0]:.4g}, {own[row, 1]:.4g} N/mm"
        )
        if stated is not None and contradicted:
            why += f"; the printed eigenvalues are {stated[0]:g}, {stated[1]:g}"
            field, value = _single_repair(k[row], stated, decimals)
            yield DataFault(row + 1, field or "k_xx", why, value, repair=value is not None)
        else:
            yield DataFault(row + 1, "k_xx", why + ": no elastic limb has such a K; noise or a misprint")


def _contradicts(own: np.ndarray, stated: np.ndarray, decimals: Mapping[str, int]) -> bool:
    """Are the eigenvalues further apart than the rounding of all numbers involved can explain?"""
    entries = sum(0.5 * 10.0 ** -decimals.get(name, 0) for name in ("k_xx", "k_xz", "k_zz")) / 1.5
    rounding = 0.5 * 10.0 ** -min(decimals.get("lambda_min", 0), decimals.get("lambda_max", 0))
    return bool(np.max(np.abs(own - stated)) > entries + rounding)


def _single_repair(
    k: np.ndarray, stated: np.ndarray, decimals: Mapping[str, int]
) -> tuple[str, float | None]:
    """The one entry, and its value, that alone brings K to the stated eigenvalues; value None when there is none
    or more than one."""
    trace, product = float(stated.sum()), float(stated.prod())
    candidates: list[tuple[str, float]] = []
    for field, place in (("k_xx", 0), ("k_zz", 2)):
        mended = k.copy()
        mended[place] = round(trace - k[2 - place], decimals.get(field, 1))
        if not _contradicts(eigenvalues(mended), stated, decimals):
            candidates.append((field, float(mended[place])))
    square = k[0] * k[2] - product
    if square >= 0.0:
        mended = k.copy()
        mended[1] = round(math.copysign(math.sqrt(square), k[1] or -1.0), decimals.get("k_xz", 1))
        if not _contradicts(eigenvalues(mended), stated, decimals):
            candidates.append(("k_xz", float(mended[1])))
    return candidates[0] if len(candidates) == 1 else ("", None)


def _undetermined(columns: Columns, decimals: Mapping[str, int]) -> Iterator[DataFault]:
    k = stiffness(columns)
    sound = eigenvalues(k)[:, 0] > 0.0
    interval = lambda_min_interval(k, half_units(columns, decimals))
    for row in np.flatnonzero(sound & (interval[:, 0] <= 0.0)):
        yield DataFault(
            int(row) + 1,
            "lambda_min",
            "not determined: the rounding of K alone allows "
            f"{interval[row, 0]:.3g} to {interval[row, 1]:.3g} N/mm",
            blocking=False,
        )
