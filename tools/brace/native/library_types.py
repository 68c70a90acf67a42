"""Types that travel between datasets and the library."""

from __future__ import annotations

from typing import Protocol

import numpy as np


class Columns(Protocol):
    """Named arrays with one entry per row: a Dataset, or a plain dict."""

    def __getitem__(self, column: str, /) -> np.ndarray: ...

    def __contains__(self, column: object, /) -> bool: ...
