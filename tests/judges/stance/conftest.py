"""What both suites need: the solver, once a module."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from truth import Siconos


@pytest.fixture(scope="module")
def solver() -> Iterator[Siconos]:
    try:
        siconos = Siconos()
    except OSError as error:
        pytest.skip(str(error))
    yield siconos
    siconos.close()
