"""`brace import`: tables as loggers of robots write them, in other units and names: right, or a question."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_bench import Outcome
from foreign_files import LBF_N, POSES_DEG, Record, shown, text

from brace.dataset import load_dataset

Brace = Callable[..., Outcome]
RECORD = Record(poses=POSES_DEG[:2], repeats=1)
COLUMNS = {name: shown(RECORD[name], "%.6f") for name in ("t", "theta1", "theta2", "dx", "dz", "fx", "fz")}
ANGLES = [COLUMNS["theta1"], COLUMNS["theta2"]]
REST = [COLUMNS[name] for name in ("dx", "dz", "fx", "fz")]
H = "dx [mm],dz [mm],Fx [N],Fz [N]"
ROWS = RECORD.rows
LATE = RECORD["t"] + 0.2 * np.random.default_rng(5).random(ROWS)
STAMPS = [[str(1_700_000_000 + int(t)) for t in RECORD["t"] + 0.25], ["250000000"] * ROWS]
RIGHT: list[tuple[str, list[list[str]]]] = [
    ("t [s],hip [gon],knee [gon]," + H,
     [COLUMNS["t"], *(shown(RECORD[name] / 0.9, "%.6f") for name in ("theta1", "theta2")), *REST]),
    ("t [s],hip [rev],knee [rev]," + H,
     [COLUMNS["t"], *(shown(RECORD[name] / 360, "%.8f") for name in ("theta1", "theta2")), *REST]),
    ("t [min],hip [deg],knee [deg]," + H, [shown(RECORD["t"] / 60, "%.8f"), *ANGLES, *REST]),
    ("t [s],hip [deg],knee [deg],dx ['],dz [\"],Fx [lb],Fz [lb]",
     [COLUMNS["t"], *ANGLES, shown(RECORD["dx"] / 304.8, "%.9f"), shown(RECORD["dz"] / 25.4, "%.8f"),
      *(shown(RECORD[name] / LBF_N, "%.7f") for name in ("fx", "fz"))]),
    ("t [s],hip [deg],knee [deg],dx [mils],dz [mils],Fx [N],Fz [N]",
     [COLUMNS["t"], *ANGLES, *(shown(RECORD[name] / 0.0254, "%.5f") for name in ("dx", "dz")), *REST[2:]]),
    ("t [s],hip_goal [deg],hip_present [deg],knee_goal [deg],knee_present [deg]," + H,
     [COLUMNS["t"], ANGLES[0], shown(RECORD["theta1"] + 0.05), ANGLES[1], shown(RECORD["theta2"] + 0.05), *REST]),
    ("t [s],hip [deg],knee [deg],hip velocity [deg/s],dx vel [mm/s],acc_x [g]," + H,
     [COLUMNS["t"], *ANGLES, *([["1"] * ROWS] * 3), *REST]),
    ("Time,header.seq,header.stamp.secs,header.stamp.nsecs,hip_deg,knee_deg," + H,
     [shown(LATE), [str(n) for n in range(ROWS)], *STAMPS, *ANGLES, *REST]),
]  # fmt: skip


@pytest.mark.parametrize(("header", "cells"), RIGHT, ids=[header[:24] for header, _ in RIGHT])
def test_tables_that_are_read(brace: Brace, tmp_path: Path, header: str, cells: list[list[str]]) -> None:
    path = tmp_path / "a.csv"
    path.write_text(text([header], cells, ","))
    done = brace("import", path, "--yes", "--out", tmp_path / "out")
    assert done.code == 0, done.err
    data = load_dataset(tmp_path / "out")
    for name, expected in (("dx_mm", "dx"), ("dz_mm", "dz"), ("fx_n", "fx"), ("fz_n", "fz")):
        assert data[name] == pytest.approx(RECORD[expected], abs=1e-3)
    assert data["theta2_rad"] == pytest.approx(np.radians(RECORD["theta2"]), abs=1e-5)
    assert data["t_s"] - data["t_s"][0] == pytest.approx(RECORD["t"] - RECORD["t"][0], abs=1e-3)


@pytest.mark.parametrize(
    ("header", "cells", "words"),
    [
        ("%time,field.header.stamp,hip_deg,knee_deg," + H, [shown(LATE * 1e9, "%.0f"), shown(RECORD["t"] * 1e9, "%.0f"), *ANGLES, *REST],
         "'field.header.stamp': in which unit?"),
        ("t [s],hip [deg],knee [deg],dx [mm],dz [mm],Fx_min [N],Fx_max [N],Fz [N]", [COLUMNS["t"], *ANGLES, *REST[:3], *REST[2:]],
         "a least, largest or mean value"),
        ("t_s,hip_deg,knee_deg,dx_mm,dz_mm,fx_counts,fz_counts", [COLUMNS["t"], *ANGLES, *REST], "in which unit?"),
        ("t_s,hip_deg,knee_deg,enc1_deg," + H, [COLUMNS["t"], *ANGLES, shown((RECORD["fz"] * 0.01) % 360), *REST], "has it gone round?"),
        ("dt [s],hip [deg],knee [deg]," + H, [["4.0"] * ROWS, *ANGLES, *REST], "distances from reading to reading"),
        ("t [s],Present Position 1 [deg],Present Position 2 [deg],Present Current 1 [mA]," + H,
         [COLUMNS["t"], *ANGLES, ["3"] * ROWS, *REST], "which joint's angle?"),
        ("t [s],hip [deg],knee [deg],dx [mm],dz [mm],Fx [N],Fx raw [N],Fz [N]", [COLUMNS["t"], *ANGLES, *REST[:3], *REST[2:]],
         "a raw or a filtered reading"),
        ("t [s],q3 [deg],q2 [deg]," + H, [COLUMNS["t"], *ANGLES, *REST], "the joints are numbered"),
    ],
)  # fmt: skip
def test_tables_that_are_asked(brace: Brace, tmp_path: Path, header: str, cells: list[list[str]], words: str) -> None:
    path = tmp_path / "a.csv"
    path.write_text(text([header], cells, ","))
    asked = brace("import", path, "--yes", "--out", tmp_path / "out")
    assert asked.code == 2 and words in asked.err and not (tmp_path / "out").exists(), asked.err
