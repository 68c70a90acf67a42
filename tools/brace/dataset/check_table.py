"""What can be wrong with a table of stiffness matrices, and what its print rounding leaves undetermined."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from brace.dataset.faults import DataFault
from brace.dataset.meta import Meta

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
    return [
        *_unit(columns, meta),
        *_duplicates(columns),
        *_asymmetry(columns, decimals),
        *_eigenvalues(columns, decimals),
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
    """Does the unit that the source prints make sense with the sensor and with a servo's spring?"""
    k = np.abs(np.concatenate([columns["k_xx"], columns["k_zz"]]))
    typical = float(np.median(k[k > 0])) if (k > 0).any() else 0.0
    resolution_n = meta.number("sensor.resolution_n") or DEFAULT_RESOLUTION_N
    unit = meta.unit_as_printed.replace(" ", "")
    if unit in ("N/m", "Nm^-1", "N/metre", "N/meter"):
        force_n = typical * 1e-3 * LOADING_STROKE_MM
        if force_n < resolution_n:
            yield DataFault(
                None,
                "unit",
                f"printed in N/m, but then the typical force at {LOADING_STROKE_MM} mm would "
                f"be {force_n:.2g} N, below the sensor's resolution of {resolution_n:.3g} N, and a servo's "
                "spring (about 6e4 N mm/rad) at these levers gives 0.3 to 2.6 N/mm",
                "N/mm",
                repair=True,
                blocking=False,
            )
            return
    low, high = PLAUSIBLE_N_PER_MM
    if typical and not low <= typical <= high:
        fits = "N/m" if typical > high else "N/um"
        yield DataFault(
            None,
            "unit",
            f"the typical stiffness is {typical:.3g} N/mm: no limb that a servo holds has it; "
            f"the columns fit only in {fits}",
            f"{fits}: multiply by {1e-3 if fits == 'N/m' else 1e3:g}",
        )


def _duplicates(columns: Columns) -> Iterator[DataFault]:
    table = np.column_stack([values.astype(float) for name, values in columns.items() if name != "row"])
    _, first, inverse = np.unique(table, axis=0, return_index=True, return_inverse=True)
    for row in np.flatnonzero(first[inverse.ravel()] != np.arange(len(table)))[:20]:
        yield DataFault(
            int(row) + 1, "r_mm", f"the row repeats row {first[inverse.ravel()[row]] + 1} entry by entry"
        )


def _asymmetry(columns: Columns, decimals: Mapping[str, int]) -> Iterator[DataFault]:
    allowed = 0.5 * 10.0 ** -decimals.get("k_xz", 0) + 0.5 * 10.0 ** -decimals.get("k_zx", 0)
    size = np.sqrt(np.abs(columns["k_xx"] * columns["k_zz"])) + np.abs(columns["k_xz"])
    apart = np.abs(columns["k_xz"] - columns["k_zx"])
    for row in np.flatnonzero(apart > allowed + 0.5 * size):
        yield DataFault(
            int(row) + 1,
            "k_zx",
            f"k_zx = {columns['k_zx'][row]:g} and k_xz = {columns['k_xz'][row]:g}: K "
            "of an elastic limb is symmetric",
        )
    for row in np.flatnonzero((apart > allowed * (1 + 1e-9)) & (apart <= allowed + 0.5 * size)):
        yield DataFault(
            int(row) + 1,
            "k_zx",
            f"differs from k_xz by {apart[row]:.3g} N/mm: cross-talk, a turned sensor "
            "or noise; their mean is used",
            blocking=False,
        )


def _eigenvalues(columns: Columns, decimals: Mapping[str, int]) -> Iterator[DataFault]:
    k = stiffness(columns)
    own = eigenvalues(k)
    printed = "lambda_min" in columns and "lambda_max" in columns
    for row in range(len(k)):
        indefinite = own[row, 0] <= 0.0
        stated = np.array([columns["lambda_min"][row], columns["lambda_max"][row]]) if printed else None
        contradicted = stated is not None and _contradicts(own[row], stated, decimals)
        if not indefinite and not contradicted:
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
