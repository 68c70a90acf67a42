"""What a person wrote is not replaced, and a run that is killed leaves nothing behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from command_bench import LIMB, Outcome, loading_rows, write_loading

from brace.ground.errors import UsageError
from brace.ground.files import OutputSet, is_unchanged, marked, refuse_written

Brace = Callable[..., Outcome]
HAND = "# my own notes\n" + LIMB


def test_a_file_is_known_by_the_sum_in_its_last_line() -> None:
    text = marked("a = 1\n\n[b]\nc = 2\n")
    assert is_unchanged(text.encode()) and text.startswith("a = 1\n\n[b]\nc = 2\n")
    assert marked(text) == text
    for changed in (text.replace("a = 1", "a = 2"), "# mine\n" + text, text + "d = 3\n", "", HAND, text[:-1]):
        assert not is_unchanged(changed.encode()), changed


@pytest.fixture
def record(tmp_path: Path) -> tuple[Path, Path]:
    model = tmp_path / "start.toml"
    model.write_text(LIMB)
    return write_loading(tmp_path / "data", loading_rows()), model


def test_identify_replaces_only_what_it_wrote(brace: Brace, tmp_path: Path, record: tuple[Path, Path]) -> None:
    data, model = record
    out = tmp_path / "limb.toml"
    asked = ("identify", data, "--model", model, "--only", "joint.femur.compliance_rad_per_n_mm", "--out", out)
    out.write_text(HAND)
    refused = brace(*asked)
    assert refused.code == 2 and "a file that somebody wrote or changed" in refused.err and "try:" in refused.err
    assert out.read_text() == HAND
    out.unlink()
    for _ in range(2):  # its own is written anew
        done = brace(*asked)
        assert done.code == 0, done.err
    assert is_unchanged(out.read_bytes())
    out.write_text(out.read_text().replace("[geometry]", "[geometry]  # measured again"))
    changed = out.read_text()
    assert brace(*asked).code == 2 and out.read_text() == changed


@pytest.mark.parametrize("name", ["limb.toml", "diagnosis.json", "report.html"])
def test_diagnose_refuses_before_its_work(
    brace: Brace, tmp_path: Path, record: tuple[Path, Path], name: str
) -> None:
    data, model = record
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / name).write_text(HAND)
    refused = brace("diagnose", data, "--model", model, "--out", tmp_path / "out")
    assert refused.code == 2 and "somebody wrote or changed" in refused.err, refused.err
    assert sorted(each.name for each in (tmp_path / "out").iterdir()) == [name]
    assert (tmp_path / "out" / name).read_text() == HAND


def test_diagnose_knows_its_own_files(brace: Brace, tmp_path: Path, record: tuple[Path, Path]) -> None:
    from brace.diagnose.write import check_folder

    data, model = record
    brace("diagnose", data, "--model", model, "--out", tmp_path / "out")
    assert len(list((tmp_path / "out").iterdir())) == 3
    check_folder(tmp_path / "out", ())
    with pytest.raises(UsageError):
        (tmp_path / "out" / "limb.toml").write_text("a = 1\n")
        refuse_written(tmp_path / "out" / "limb.toml")


KILLED = """
import os, signal, sys
from pathlib import Path
from brace.ground.files import OutputSet
with OutputSet() as outputs:
    outputs.add(Path(sys.argv[1]) / "out" / "meta.toml", "a = 1")
    outputs.add(Path(sys.argv[1]) / "out" / "data.csv", "a")
    os.kill(os.getpid(), int(sys.argv[2]))
"""


@pytest.mark.parametrize("by", [signal.SIGKILL, signal.SIGTERM])
def test_a_killed_run_leaves_nothing(tmp_path: Path, by: signal.Signals) -> None:
    """A hidden .meta.toml.x8k2 stayed."""
    if not hasattr(os, "O_TMPFILE"):
        pytest.skip("files without a name are Linux's")
    (tmp_path / "out").mkdir()
    done = subprocess.run([sys.executable, "-c", KILLED, str(tmp_path), str(int(by))], timeout=60)
    assert done.returncode == -by and list((tmp_path / "out").iterdir()) == []


@pytest.mark.parametrize("named", [False, True])
def test_files_appear_whole_with_their_permissions(
    tmp_path: Path, named: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where the file system has no files without a name."""
    if named:
        monkeypatch.delattr(os, "O_TMPFILE")
    (tmp_path / "old").write_text("old")
    (tmp_path / ".old.new").write_text("left by a run that was killed")
    with OutputSet() as outputs:
        outputs.add(tmp_path / "old", "new")
        outputs.add(tmp_path / "deep" / "er" / "file", b"x" * 100_000)
        assert (tmp_path / "old").read_text() == "old"
        outputs.commit()
    assert (tmp_path / "old").read_text() == "new" and (tmp_path / "deep/er/file").stat().st_size == 100_000
    assert (tmp_path / "old").stat().st_mode & 0o777 == 0o666 & ~os.umask(os.umask(0o022) or 0o022)
    if not named:
        assert sorted(each.name for each in tmp_path.iterdir()) == ["deep", "old"]
