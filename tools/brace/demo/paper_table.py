"""The paper's table through the gate and the fit: its faults, its eigenvalues with intervals, the limb behind it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from brace.dataset import load_dataset
from brace.dataset.check_table import eigenvalues, half_units, lambda_min_interval, stiffness
from brace.demo.convexity import bent_rows, quasi_convex_breaks
from brace.identify.faults import settle
from brace.identify.parameters import TIP_HEIGHT
from brace.identify.run import Identification, Options, identify
from brace.model import LimbModel, load_limb
from brace.plots.eigenvalue_plot import Measured

DATA = Path(__file__).resolve().parents[1] / "data"


@dataclass(frozen=True)
class PaperTable:
    """Rows in rising r. `corrected` marks rows with a repaired entry."""

    faults: list[str]
    repairs: list[str]
    r_mm: np.ndarray
    largest: Measured
    smallest: Measured
    corrected: np.ndarray
    k: np.ndarray  # rows x (k_xx, k_xz, k_zz) [N/mm]
    identification: Identification

    @property
    def limb(self) -> LimbModel:
        """The limb that fits the table best."""
        return self.identification.model

    @property
    def tip_height_mm(self) -> float:
        """The one tip height that the rows share in this fit (an inference)."""
        return float(self.identification.fit.nuisances[TIP_HEIGHT])


def coupling_low_ratio(k: np.ndarray, lambda_min: np.ndarray) -> float:
    """By how much of itself |K_xz| would have to be smaller for K to have this smallest eigenvalue, all else as it is;
    the median of the rows. From det(K - lambda I) = 0; below zero where it would have to be larger."""
    square = np.maximum((k[:, 0] - lambda_min) * (k[:, 2] - lambda_min), 0.0)
    return float(np.nanmedian(1.0 - np.sqrt(square) / np.abs(k[:, 1])))


def examine(advance: Callable[[int], None]) -> PaperTable:
    """Everything the demo says of the table."""
    start = load_limb(DATA / "paper-limb.toml")
    table = load_dataset(DATA / "paper_table1")
    settled, repairs = settle(table, "repair")
    result = identify(table, start, Options(), advance)
    k = stiffness(settled.columns)
    half = half_units(settled.columns, settled.decimals or table.decimals)
    value = eigenvalues(k)
    smallest_interval, largest_interval = lambda_min_interval(k, half), _lambda_max_interval(k, half)
    undetermined = {fault.row or 0 for fault in table.faults if fault.field == "lambda_min"}
    repaired = {fault.row or 0 for fault in table.faults if fault.blocking and fault.repair}
    rows = np.arange(1, len(k) + 1)
    known = ~np.isin(rows, list(undetermined))
    everywhere = np.ones(len(k), dtype=bool)
    r_mm = settled["r_mm"].astype(float)
    largest = Measured(value[:, 1], largest_interval[:, 0], largest_interval[:, 1], everywhere,
                       bent_rows(r_mm, value[:, 1]), quasi_convex_breaks(value[:, 1], *largest_interval.T))
    smallest = Measured(value[:, 0], smallest_interval[:, 0], smallest_interval[:, 1], known, ~everywhere, ~everywhere)
    return PaperTable([fault.sentence(Path("paper_table1/data.csv")) for fault in table.faults], repairs, r_mm, largest,
                      smallest, np.isin(rows, list(repaired)), k, result)


def _lambda_max_interval(k: np.ndarray, half_unit: np.ndarray) -> np.ndarray:
    """rows x (low, high) [N/mm]: the larger eigenvalue rises with k_xx, k_zz and |k_xz|."""
    towards = np.sign(k[:, 1])
    step = half_unit * np.column_stack([np.ones(len(k)), towards, np.ones(len(k))])
    return np.column_stack([eigenvalues(k - step)[:, 1], eigenvalues(k + step)[:, 1]])
