"""How many random limbs are asked about, and which."""

import os
import sys
from pathlib import Path

import pytest

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy is there: its threads would wait for one another


def pytest_addoption(parser: pytest.Parser) -> None:
    """More than ./dev test takes the time for."""
    parser.addoption("--limbs", type=int, default=None, help="random limbs in the plane; in space a quarter of them")
    parser.addoption("--seed", type=int, default=31, help="of the limbs by which the core is judged")


sys.path.append(str(Path(__file__).resolve().parents[1] / "blind"))  # the benchmark whose second world is here


@pytest.fixture
def limbs(request: pytest.FixtureRequest) -> int:
    """Random limbs in the plane."""
    return int(request.config.getoption("--limbs", default=None) or 60)


@pytest.fixture
def seed(request: pytest.FixtureRequest) -> int:
    """Of the limbs by which the core is judged."""
    return int(request.config.getoption("--seed", default=31))
