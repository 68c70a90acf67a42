"""`brace import`: of two columns, units or constants for one of ours, none is taken in silence."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from conftest import Outcome
from foreign_files import Record, shown, text

Brace = Callable[..., Outcome]
NAMES = ("t", "theta1", "theta2", "dx", "dz", "fx", "fz")
HEADER = "t [s],theta1 [deg],theta2 [deg],dx [mm],dz [mm],Fx [N],Fz [N]"


def with_column(folder: Path, name: str, values: np.ndarray, record: Record) -> Path:
    path = folder / "two.csv"
    columns = [*(shown(record[each]) for each in NAMES), shown(values)]
    path.write_text(text([f"{HEADER},{name}"], columns, ","))
    return path


@pytest.mark.parametrize(
    ("name", "first", "second", "target", "one"),
    [("Resultant force [N]", "fx", "fz", "f_n", "fx_n"), ("Displacement [mm]", "dx", "dz", "d_mm", "dx_mm")],
)
def test_a_resultant_beside_its_parts_is_asked(
    brace: Brace, tmp_path: Path, name: str, first: str, second: str, target: str, one: str
) -> None:
    r = Record()
    path = with_column(tmp_path, name, np.hypot(r[first], r[second]), r)
    asked = brace("import", path, "--yes", "--out", tmp_path / "out")
    assert asked.code == 2 and f"{name!r}: what is it? ({target}, along the motion, or a resultant" in asked.err
    mapping = tmp_path / "m.toml"
    brace("import", path, "--draft", mapping)
    mapping.write_text(mapping.read_text().replace('is = "?"', f'is = "{target}"'))
    refused = brace("import", path, "--mapping", mapping, "--out", tmp_path / "out")
    assert refused.code == 3 and f"{target} and {one} are both of the motion along x" in refused.err, refused.err


def test_two_columns_for_one_target_are_refused(brace: Brace, tmp_path: Path) -> None:
    """The last one won."""
    r = Record()
    path, mapping = with_column(tmp_path, "Fx2 [N]", 2.0 * r["fx"], r), tmp_path / "m.toml"
    brace("import", path, "--draft", mapping)
    mapping.write_text(mapping.read_text().replace('is = "?"', 'is = "fx_n"'))
    refused = brace("import", path, "--mapping", mapping, "--out", tmp_path / "out")
    assert refused.code == 3 and "2 columns are fx_n: 'Fx [N]', 'Fx2 [N]'" in refused.err, refused.err
