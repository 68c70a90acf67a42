"""A few legs of each kind, made at random; all legs of real robots, where their package is installed."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("mujoco")

import made
import robots
from legs import Leg

LEAST_ROBOTS = 14  # with legs that the model can have


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def _wrong(found: dict[str, list[list[Leg]]]) -> list[str]:
    legs = [(name, leg) for name, ends in found.items() for tries in ends for leg in tries]
    return [f"{name} {leg.end}: {leg.wrong[0]}" for name, leg in legs if leg.wrong]


def test_legs_made_at_random(tmp_path: Path) -> None:
    found = robots.made_at_random(3, robots.SEED + 1, tmp_path)
    assert not _wrong(found)
    for kind in ("exact", "knee leans", "rolls in its plane", "leaning plane"):
        assert all(any(leg.became == "space" for leg in tries) for tries in found[kind]), kind
    for kind in ("three in the plane", "slide", "mimic", "four hinges", "knee crosses"):
        assert all(leg.became == "refused" for tries in found[kind] for leg in tries), kind
    assert all(leg.became != "space" for tries in found["beside"] for leg in tries)  # not even where its share is said
    assert set(found) == set(made.KINDS)


@pytest.mark.minutes
def test_real_robots(tmp_path: Path) -> None:
    if not (paths := robots.packaged()):
        pytest.skip("example-robot-data is not installed: pip install -e 'tools[robots]'")
    found = robots.real(paths, tmp_path)
    assert not _wrong(found)
    has_limb = [name for name, ends in found.items() if any(leg.became != "refused" for tries in ends for leg in tries)]
    assert len(has_limb) >= LEAST_ROBOTS, has_limb
    assert not list(tmp_path.glob("*.TXT"))
