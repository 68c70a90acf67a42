"""What `--out` may replace, and the rows that `k --csv` keeps."""

from __future__ import annotations

import csv
import json
import os
import stat
from collections.abc import Callable
from pathlib import Path

import pytest

from command_bench import LIMB, Outcome, loading_rows, physics_k, write_loading

Brace = Callable[..., Outcome]


@pytest.fixture
def postures(tmp_path: Path) -> Path:
    path = tmp_path / "in.csv"
    path.write_text("theta1_rad,theta2_rad\n1.0,1.4\n")
    return path


def test_devices_and_pipes_are_not_replaced(
    brace: Brace, paper_limb: Path, postures: Path, tmp_path: Path
) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    to_null = tmp_path / "to-null"
    to_null.symlink_to("/dev/null")
    for out in (pipe, "/dev/null", to_null):
        outcome = brace("k", "--model", paper_limb, "--csv", postures, "--out", out)
        assert outcome.code == 2 and "no regular file" in outcome.err and "try:" in outcome.err
    assert stat.S_ISFIFO(pipe.stat().st_mode) and to_null.is_symlink()
    assert stat.S_ISCHR(os.stat("/dev/null").st_mode)


def test_links_are_written_through(brace: Brace, paper_limb: Path, postures: Path, tmp_path: Path) -> None:
    (tmp_path / "far").mkdir()
    target = tmp_path / "far" / "result.csv"
    for old in ("old", None):  # to a file that is there, and to one that is not yet
        link = tmp_path / f"link-{old}"
        if old:
            target.write_text(old)
        else:
            target.unlink()
        link.symlink_to(target)
        assert brace("k", "--model", paper_limb, "--csv", postures, "--out", link).code == 0
        assert link.is_symlink() and "k_xx_n_per_mm" in target.read_text()
    loop = tmp_path / "loop"
    loop.symlink_to(loop)
    assert brace("k", "--model", paper_limb, "--csv", postures, "--out", loop).code == 2


def test_inputs_are_not_replaced(brace: Brace, tmp_path: Path, postures: Path) -> None:
    model = tmp_path / "limb.toml"
    model.write_text(LIMB)
    rig = tmp_path / "rig.toml"
    rig.write_text("format = 1\n[[configuration]]\ntheta1_rad = 0.5\ntheta2_rad = 1.0\n")
    data = write_loading(tmp_path / "data", loading_rows())
    alias = tmp_path / "alias"
    alias.symlink_to(data / "data.csv")
    kept = {path: path.read_bytes() for path in (model, postures, data / "data.csv", data / "meta.toml")}
    for arguments in (
        ("k", "--csv", postures, "--out", postures),
        ("k", "--csv", postures, "--out", model),
        ("predict", data, "--out", data / "data.csv"),
        ("predict", data, "--out", alias),
        ("predict", data, "--out", model),
        ("identify", data, "--out", model),
        ("identify", data, "--out", data / "meta.toml"),
    ):
        outcome = brace(*arguments, "--model", model)
        assert outcome.code == 2 and "replace an input" in outcome.err, arguments
        assert all(path.read_bytes() == content for path, content in kept.items())


def test_measured_datasets_are_not_simulated_over(brace: Brace, paper_limb: Path, tmp_path: Path) -> None:
    rig = tmp_path / "rig.toml"
    rig.write_text("format = 1\n[[configuration]]\ntheta1_rad = 0.5\ntheta2_rad = 1.0\n")
    data = write_loading(tmp_path / "data", loading_rows())
    before = (data / "data.csv").read_bytes()
    outcome = brace("simulate", "--model", paper_limb, "--rig", rig, "--out", data)
    assert outcome.code == 2 and "not simulated" in outcome.err and (data / "data.csv").read_bytes() == before
    meta = (data / "meta.toml").read_text()
    for what in ("imported", "a rig", "simulated elsewhere"):
        (data / "meta.toml").write_text(f'{meta}\n[source]\nwhat = "{what}"\n')
        assert brace("simulate", "--model", paper_limb, "--rig", rig, "--out", data).code == 2, what
        assert (data / "data.csv").read_bytes() == before
    (data / "meta.toml").unlink()  # records without a meta.toml are somebody's too
    assert brace("simulate", "--model", paper_limb, "--rig", rig, "--out", data).code == 2
    for _ in range(2):  # its own are written anew
        assert brace("simulate", "--model", paper_limb, "--rig", rig, "--out", tmp_path / "own").code == 0


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_rows_keep_their_bytes(brace: Brace, paper_limb: Path, tmp_path: Path, end: str) -> None:
    source, out = tmp_path / "in.csv", tmp_path / "out.csv"
    rows = [
        b"label,theta1_rad,theta2_rad",
        b"plain ,1.0, 1.4",
        b" blanks around,1.0,1.4  ",
        b'"a,b",1.0,1.4',
        b"caf\xe9,1.0,1.4",  # Latin-1
        "café,1.0,1.4".encode(),
        b'"said ""so""",1.0,"1.4"',
    ]
    source.write_bytes(end.encode().join(rows) + end.encode())
    assert brace("k", "--model", paper_limb, "--csv", source, "--out", out).code == 0
    found = out.read_bytes().split(end.encode())
    assert found.pop() == b"" and len(found) == len(rows)
    for row, line in zip(rows, found):
        assert line.startswith(row + b",")
    assert found[0][len(rows[0]) :].startswith(b",k_xx_n_per_mm,")
    expected = physics_k(1.0, 1.4)
    parsed = list(csv.DictReader(out.read_text("latin-1").splitlines()))
    for fields in parsed:
        assert float(fields["k_xx_n_per_mm"]) == pytest.approx(expected[0, 0], rel=1e-5)
    assert parsed[2]["label"] == "a,b"


def test_a_quoted_line_end_stays_in_its_row(brace: Brace, paper_limb: Path, tmp_path: Path) -> None:
    source, out = tmp_path / "in.csv", tmp_path / "out.csv"
    source.write_bytes(b'note,theta1_rad,theta2_rad\n"two\nlines",1.0,1.4\nx,1.0,9\n')
    outcome = brace("k", "--model", paper_limb, "--csv", source, "--out", out)
    assert outcome.code == 3 and "in.csv:4 (row 2), theta2_rad" in outcome.err and not out.exists()
    source.write_bytes(b'note,theta1_rad,theta2_rad\n"two\nlines",1.0,1.4\n')
    assert brace("k", "--model", paper_limb, "--csv", source, "--out", out).code == 0
    assert b'"two\nlines",1.0,1.4,3.96' in out.read_bytes()
    source.write_bytes(b'note,theta1_rad,theta2_rad\n"open,1.0,1.4\n')
    assert "does not end" in brace("k", "--model", paper_limb, "--csv", source, "--out", out).err


def test_bad_tables_are_not_called_datasets(brace: Brace, paper_limb: Path, tmp_path: Path) -> None:
    source = tmp_path / "in.csv"
    for text, words in (
        ("", "no rows"),
        ("theta1_rad,theta2_rad\n", "no rows"),
        ("theta1_rad,theta2_rad\n1,57\n", "0.994838 if the column is in degrees"),
        ("theta1_rad,theta2_rad\n1,3.15\n", ":2 (row 1), theta2_rad"),
        ("theta1_rad,theta2_rad\n1,\n", "an entry is empty"),
        ("theta1_rad,theta2_rad\n1,1_0\n", "is not a number"),
        ("theta1_rad,theta2_rad\n\u22121.0,1\n", "'\u22121.0' is not a number"),
        ("theta1_rad,theta2_rad\n\u22121.0,1\n", "write -1.0"),
        ("theta1_rad,theta2_rad\n1,1,1\n", "has 3 fields, the header 2"),
        ("theta1_rad;theta2_rad\n1;1\n", "not separated by commas"),
        ("theta1_rad,theta2_deg\n1,1\n", "theta2_deg"),
        ("theta1_rad,theta2_rad,theta1_rad\n1,1,1\n", "there twice"),
    ):
        source.write_text(text)
        outcome = brace("k", "--model", paper_limb, "--csv", source, "--out", tmp_path / "out.csv")
        assert outcome.code == 3 and words in outcome.err and "data.csv" not in outcome.err, outcome.err
    outcome = brace("k", "--model", paper_limb, "--csv", tmp_path / "nothere.csv", "--out", tmp_path / "out.csv")
    assert outcome.code == 3 and "table of postures" in outcome.err


def test_no_minus_zero(brace: Brace, paper_limb: Path) -> None:
    """Straight along x nothing couples x and z."""
    text = ("k", "--model", paper_limb, "--theta1", "-0", "--theta2", 0)
    values = json.loads(brace(*text, "--json").out)
    assert not [key for key, value in values.items() if value == 0 and str(value).startswith("-")]
    assert " -0 " not in brace(*text).out and "-0\n" not in brace(*text).out
