"""`brace import`: a column of clock times."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_bench import Outcome
from foreign_files import POSES_DEG, Record, shown, text

from brace.dataset import load_dataset
from brace.ground.units import unit_of
from brace.importing import numerals

Brace = Callable[..., Outcome]


def with_clock(folder: Path, clock: Callable[[int], str]) -> Path:
    r = Record(poses=POSES_DEG[:1], axes="x", repeats=1)
    columns = [[clock(int(t)) for t in r["t"]], *(shown(r[name]) for name in ("theta1", "theta2", "dx", "fx"))]
    path = folder / "clock.csv"
    path.write_text(text(["time,theta1 [deg],theta2 [deg],dx [mm],Fx [N]"], columns, ","))
    return path


@pytest.mark.parametrize(("unit", "seconds"), [("min", 4.0), ("h", 240.0)])
def test_times_of_two_parts_are_asked(brace: Brace, tmp_path: Path, unit: str, seconds: float) -> None:
    """Minutes and seconds were read as hours and minutes."""
    path, mapping = with_clock(tmp_path, lambda t: f"{t // 60:02d}:{t % 60:02d}"), tmp_path / "m.toml"
    asked = brace("import", path, "--yes", "--out", tmp_path / "out")
    assert asked.code == 2 and "'time': in which unit? Its entries go from 00:00 to 01:04 (h: hours" in asked.err
    brace("import", path, "--draft", mapping)
    draft = mapping.read_text()
    mapping.write_text(draft.replace('unit = "?"', 'unit = "s"'))
    refused = brace("import", path, "--mapping", mapping, "--out", tmp_path / "out")
    assert refused.code == 3 and "hours and minutes, or minutes and seconds" in refused.err, refused.err
    mapping.write_text(draft.replace('unit = "?"', f'unit = "{unit}"'))
    assert brace("import", path, "--mapping", mapping, "--out", tmp_path / "out").code == 0
    assert np.diff(load_dataset(tmp_path / "out")["t_s"]) == pytest.approx(seconds)


@pytest.mark.parametrize(
    "clock",
    [
        lambda t: f"{t // 60:02d}:{t % 60:02d}.0", lambda t: f"2024-05-01T10:{t // 60:02d}:{t % 60:02d}.000+02:00",
        lambda t: f"2024-05-01 10:{t // 60:02d}:{t % 60:02d} UTC",
    ],
)  # fmt: skip
def test_minutes_with_a_fraction_and_times_with_a_zone(
    brace: Brace, tmp_path: Path, clock: Callable[[int], str]
) -> None:
    done = brace("import", with_clock(tmp_path, clock), "--yes", "--out", tmp_path / "out")
    assert done.code == 0, done.err
    assert np.diff(load_dataset(tmp_path / "out")["t_s"]) == pytest.approx(4.0)


def test_a_zone_that_changes_is_no_pause() -> None:
    before, after = numerals.clocks_s(["2024-10-27T02:59:58+02:00", "2024-10-27T02:00:02+01:00"])
    assert after - before == 4.0
    nano = unit_of("ns")
    assert nano is not None and nano.quantity == "time" and nano.factor == 1e-9
