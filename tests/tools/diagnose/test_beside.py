"""A second process beside the first gives what one process gives, and nothing waits for it in vain."""

from __future__ import annotations

import os
import re
import signal
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from brace.diagnose.beside import beside
from brace.diagnose.diagnosis import NextExperiment
from brace.diagnose.loading import outcome
from brace.diagnose.one import diagnosed, load
from brace.diagnose.options import Options
from brace.diagnose.report import pictures
from brace.ground.errors import UsageError
from brace.plots import figure


def _never() -> int:
    raise AssertionError("done here, though a second process was there")


def test_the_work_is_done_in_another_process() -> None:
    with beside(os.getpid, _never, 2) as found:
        assert found() != os.getpid()


def test_with_one_process_it_is_done_here_and_only_when_asked() -> None:
    done: list[int] = []
    with beside(_never, lambda: done.append(1) or 5, 1) as found:  # type: ignore[func-returns-value]
        assert not done
        assert found() == 5


def test_its_error_is_raised_here_with_all_it_says() -> None:
    def refuse() -> int:
        raise UsageError("no rows", where="data.csv", why="all are locked", next_step="lock fewer")

    with beside(refuse, _never, 2) as found, pytest.raises(UsageError) as raised:
        found()
    assert "all are locked" in raised.value.render() and "lock fewer" in raised.value.render()


def test_a_killed_process_is_replaced_by_this_one() -> None:
    def die() -> int:
        os.kill(os.getpid(), signal.SIGKILL)
        return 0

    with beside(die, lambda: 7, 2) as found:
        assert found() == 7


def test_leaving_ends_it() -> None:
    begun = time.monotonic()
    with pytest.raises(RuntimeError), beside(lambda: time.sleep(600), _never, 2):
        raise RuntimeError("something else went wrong")
    assert time.monotonic() - begun < 60.0


@pytest.fixture
def record(brace: Callable[..., Any], tmp_path: Path, paper_limb: Path, paper_rig: Path) -> Path:
    """Of a limb with play."""
    hidden = re.sub(r"(?m)^(\[joint\.tibia\].*)$", r"\1\ngap_rad = 0.006", paper_limb.read_text())
    assert "gap_rad = 0.006" in hidden
    (tmp_path / "hidden.toml").write_text(hidden)
    record = tmp_path / "record"
    assert brace("simulate", "--model", tmp_path / "hidden.toml", "--rig", paper_rig, "--out", record).code == 0
    return record


@pytest.mark.minutes
def test_one_process_and_two_write_the_same_bytes(
    brace: Callable[..., Any], tmp_path: Path, paper_limb: Path, record: Path
) -> None:
    for jobs in (1, 2):
        arguments = ("diagnose", record, "--model", paper_limb, "--out", tmp_path / str(jobs), "--jobs", jobs)
        assert brace(*arguments).code == 0
    for leaf in ("diagnosis.json", "limb.toml", "report.html"):
        assert (tmp_path / "1" / leaf).read_bytes() == (tmp_path / "2" / leaf).read_bytes()


@pytest.mark.minutes
def test_the_second_process_plans_and_draws_while_the_first_loads_and_draws(
    monkeypatch: pytest.MonkeyPatch, paper_limb: Path, record: Path
) -> None:
    loading: list[int] = []
    monkeypatch.setattr(figure, "load", lambda: loading.append(os.getpid()))
    monkeypatch.setattr(outcome, "next_experiment", lambda *_: NextExperiment(str(os.getpid()), (), 1.0, 1.0))
    for name in ("disagreement", "misfit"):
        monkeypatch.setattr(pictures, name, lambda *_: [f"{os.getpid()}"])
    here = str(os.getpid())
    found, written = diagnosed(load(record, paper_limb), Options(processes=2))
    assert found.next_experiment is not None and found.next_experiment.action != here
    assert loading == [os.getpid()]
    drawn = re.findall(r"<div class=\"pic\">(\d+)", written.files["report.html"].decode())
    assert drawn[:-1] == [here, here] and drawn[-1] != here and len(drawn) == 3, drawn
