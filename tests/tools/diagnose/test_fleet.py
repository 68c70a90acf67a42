"""Many records at once: on processes, on a Dask cluster; a broken one is told, the others go on; the worst
comes first."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import re
import select
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from command_bench import LIMB, Outcome, loading_rows, spawn, write_loading

from brace.diagnose.fleet import local, overview
from brace.diagnose.fleet.job import Job, jobs_of, run_job
from brace.diagnose.fleet.job import Outcome as Diagnosed
from brace.diagnose.options import Options

FILES = ("diagnosis.json", "limb.toml", "report.html")
LIMIT_S = 400.0


def _joint_test(folder: Path, gap_rad: float, noise_n_mm: float = 40.0, seed: int = 1) -> Path:
    """Slow ramps of a joint with play: a record that is diagnosed in a second or two."""
    random = np.random.default_rng(seed)
    folder.mkdir(parents=True)
    (folder / "meta.toml").write_text(f'format = 1\nkind = "joint_test"\ntitle = "{folder.name}"\n')
    lines, clock = ["t_s,angle_rad,torque_n_mm,test"], 0.0
    for test in range(1, 4):
        for phase in np.linspace(0.0, 4.0 * np.pi, 160):
            angle = 0.03 * np.sin(phase)
            bent = np.sign(angle) * max(abs(angle) - gap_rad / 2, 0.0)
            torque = 3e5 * bent + noise_n_mm * random.standard_normal()
            lines.append(f"{clock:.2f},{angle:.6f},{torque:.3f},{test}")
            clock += 0.05
        clock += 10.0
    (folder / "data.csv").write_text("\n".join(lines) + "\n")
    return folder


@pytest.fixture(scope="module")
def fleet(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Three joints: tight, loose, looser; and one record that is none."""
    root = tmp_path_factory.mktemp("fleet")
    sound = [_joint_test(root / name, gap) for name, gap in (("tight", 0.0), ("loose", 0.01), ("looser", 0.02))]
    broken = root / "broken"
    broken.mkdir()
    (broken / "meta.toml").write_text('format = 1\nkind = "joint_test"\n')
    (broken / "data.csv").write_text("t_s,angle_rad\n1,2\n")
    return [*sound, broken]


def _run(*arguments: object) -> Outcome:
    process = spawn("diagnose", *arguments)
    try:
        out, err = process.communicate(timeout=LIMIT_S)
    finally:
        process.kill()
    assert "Traceback" not in err and "internal error" not in err, err
    return Outcome(process.returncode, out, err)


def _hashes(folder: Path) -> dict[str, str]:
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


@pytest.fixture(scope="module")
def locally(fleet: list[Path], tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Outcome]:
    out = tmp_path_factory.mktemp("local") / "out"
    return out, _run(*fleet, "--out", out, "--jobs", 2)


@pytest.mark.minutes
def test_a_broken_one_is_told_and_the_others_are_written(fleet: list[Path], locally: tuple[Path, Outcome]) -> None:
    out, outcome = locally
    assert outcome.code == 3 and "broken: not diagnosed" in outcome.err and "torque_n_mm" in outcome.err
    for name in ("tight", "loose", "looser"):
        assert sorted(path.name for path in (out / name).iterdir()) == sorted(FILES)
    assert not (out / "broken").exists()
    assert sorted(path.name for path in out.iterdir()) == [
        "fleet.html",
        "fleet.json",
        "loose",
        "looser",
        "tight",
    ]


def test_the_worst_comes_first(locally: tuple[Path, Outcome]) -> None:
    out, outcome = locally
    summary = json.loads((out / "fleet.json").read_text())
    assert [limb["name"] for limb in summary["limbs"]] == ["looser", "loose", "tight"]
    assert [limb["name"] for limb in summary["broken"]] == ["broken"]
    page = (out / "fleet.html").read_text()
    assert page.index("looser/report.html") < page.index("loose/report.html") < page.index("tight/report.html")
    assert "torque_n_mm" in page
    rows = [line.split()[0] for line in outcome.out.splitlines()]
    assert rows == ["limb", "looser", "loose", "tight"]


def test_the_same_as_one_by_one(fleet: list[Path], locally: tuple[Path, Outcome], tmp_path: Path) -> None:
    out, _ = locally
    assert _run(fleet[1], "--out", tmp_path / "alone").code == 0
    assert _hashes(tmp_path / "alone") == _hashes(out / "loose")


def test_without_a_broken_one_it_ends_with_0(
    brace: Callable[..., Outcome], fleet: list[Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(local, "run_local", lambda jobs, _n: iter([_fake(job.name, 1.0, 0.5) for job in jobs]))
    outcome = brace("diagnose", fleet[0], fleet[1], "--out", tmp_path / "out", "--json")
    assert outcome.code == 0, outcome.err
    assert json.loads(outcome.out)["broken"] == [] and len(json.loads(outcome.out)["limbs"]) == 2


# ---------------------------------------------------------------------------------------------- pieces


def test_every_record_has_a_folder_of_its_own(tmp_path: Path) -> None:
    folders = [tmp_path / "a" / "x", tmp_path / "b" / "x", tmp_path / "b" / "x", tmp_path / "fleet.json"]
    names = [job.name for job in jobs_of(folders, None, Options())]
    assert names[:2] == ["x", "b-x"] and len(set(names)) == 4 and "fleet.json" not in names


def test_each_folder_s_own_model_or_the_one_given(tmp_path: Path) -> None:
    own = write_loading(tmp_path / "own", loading_rows())
    (own / "limb.toml").write_text(LIMB)
    bare = write_loading(tmp_path / "bare", loading_rows())
    assert [job.model for job in jobs_of([own, bare], None, Options())] == [own / "limb.toml", None]
    given = tmp_path / "limb.toml"
    assert [job.model for job in jobs_of([own, bare], given, Options())] == [given, given]
    assert "only a joint test" in run_job(Job("bare", bare, None, Options())).error


def test_files_that_travel_are_spoken_of_by_our_names(fleet: list[Path]) -> None:
    carried = Job("broken", fleet[3], None, Options()).with_files()
    error = run_job(carried).error
    assert str(fleet[3]) in error and "/tmp/tmp" not in error.replace(str(fleet[3]), "")


def _kills_itself(job: Job) -> Diagnosed:
    if job.name == "killer":
        time.sleep(0.3)
        os.kill(os.getpid(), signal.SIGKILL)
    time.sleep(0.05)
    return Diagnosed(job.name, {"x": b""}, {"verdict": "none"})


def test_a_process_that_dies_costs_its_own_record_only(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(local, "run_job", _kills_itself)
    jobs = [Job(name, tmp_path, None, Options()) for name in ("a", "killer", "b", "c", "d")]
    found = {outcome.name: outcome.done for outcome in local.run_local(jobs, 2)}
    assert found == {"a": True, "b": True, "c": True, "d": True, "killer": False}


def _fake(name: str, before: float, noise: float, verdict: str = "effect") -> Diagnosed:
    gap: Any = {
        "unit": "n",
        "noise_floor": noise,
        "before": {"fitted": before, "held_out": None},
        "after": {"fitted": noise, "held_out": None},
    }
    if verdict == "data_fault":
        gap = None
    data = {"verdict": verdict, "title": "<b>", "sentence": "S.", "effects": [], "gap": gap}
    return Diagnosed(name, {}, data)


def test_ranking_is_by_noise_floors_and_faulty_records_lead() -> None:
    outcomes = [_fake("near", 1.0, 0.5), _fake("far", 0.5, 0.01), _fake("odd", 0.0, 1.0, "data_fault")]
    assert [line.name for line in overview.ranked(outcomes)] == ["odd", "far", "near"]
    page = overview.page(outcomes)
    assert "<b></span>" not in page and "&lt;b&gt;" in page
    assert overview.as_json(outcomes)["limbs"][0]["gap_in_noise_floors"] is None


def _children(parent: int) -> list[str]:
    return Path(f"/proc/{parent}/task/{parent}/children").read_text().split()


def _worked_s(parent: int) -> float:
    """Processor time of a process' children."""
    after_name = [Path(f"/proc/{child}/stat").read_text().rpartition(")")[2].split() for child in _children(parent)]
    return sum(int(words[11]) + int(words[12]) for words in after_name) / os.sysconf("SC_CLK_TCK")


def _diagnosing(fleet: list[Path], out: Path) -> subprocess.Popen[str]:
    """A fleet whose two processes are at their records."""
    process = spawn("diagnose", *(fleet[:3] * 6), "--out", out, "--jobs", 2)
    end = time.monotonic() + 60.0
    while _worked_s(process.pid) < 3.0:  # two processes spend one of these on their imports; then they diagnose
        assert time.monotonic() < end and process.poll() is None
        time.sleep(0.1)
    return process


def test_ctrl_c_ends_a_fleet(fleet: list[Path], tmp_path: Path) -> None:
    process = _diagnosing(fleet, tmp_path / "out")
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=120)
    assert process.returncode == 130 and "interrupted" in err and "Traceback" not in err, err


@pytest.mark.parametrize("by", [signal.SIGTERM, signal.SIGKILL])
def test_a_killed_fleet_leaves_no_process_behind(fleet: list[Path], tmp_path: Path, by: signal.Signals) -> None:
    process = _diagnosing(fleet, tmp_path / "out")
    workers = _children(process.pid)
    process.send_signal(by)
    process.wait(timeout=60)
    end = time.monotonic() + 20.0  # the processes end at once; those that do not, wait for ever
    while left := [worker for worker in workers if _runs(worker)]:
        assert time.monotonic() < end, left
        time.sleep(0.1)


def _runs(process: str) -> bool:
    """Neither gone nor a zombie that nobody waits for."""
    stat = Path(f"/proc/{process}/stat")
    with contextlib.suppress(OSError):
        return stat.read_text().rpartition(")")[2].split()[0] != "Z"
    return False


# --------------------------------------------------------------------------------------------- cluster


def _started(*arguments: str, says: str) -> tuple[subprocess.Popen[str], str]:
    """A program of the cluster, once it has said what is waited for."""
    process = subprocess.Popen(
        [sys.executable, "-m", *arguments], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True
    )
    assert process.stderr is not None
    until, said = time.monotonic() + 60.0, ""
    while time.monotonic() < until and process.poll() is None:
        if select.select([process.stderr], [], [], 1.0)[0]:
            # all that is there: a line left in a buffer of Python's would be one that select never tells of
            said += os.read(process.stderr.fileno(), 65536).decode(errors="replace")
            if found := re.search(says + r"\s", said):
                return process, found.group(1)
    process.kill()
    raise AssertionError(said)


@contextlib.contextmanager
def cluster(workers: int) -> Iterator[str]:
    """A scheduler and its workers on this machine; the scheduler's address."""
    pytest.importorskip("distributed")
    quiet = ("--no-dashboard", "--host", "127.0.0.1")
    processes = []
    try:
        scheduler, address = _started(
            "distributed.cli.dask_scheduler", "--port", "0", *quiet, says=r"Scheduler at:\s+(tcp://\S+)"
        )
        processes.append(scheduler)
        for _ in range(workers):
            worker, _ = _started(
                "distributed.cli.dask_worker",
                address,
                "--nthreads",
                "1",
                *quiet,
                says=r"Registered to:\s+(tcp://\S+)",
            )
            processes.append(worker)
        yield address
    finally:
        for process in reversed(processes):
            process.terminate()
        for process in processes:
            try:
                process.wait(timeout=10)
            except subprocess.TimeoutExpired:
                process.kill()


@pytest.mark.minutes
def test_on_a_cluster_the_same_bytes(fleet: list[Path], locally: tuple[Path, Outcome], tmp_path: Path) -> None:
    with cluster(1) as address:
        outcome = _run(*fleet, "--out", tmp_path / "out", "--scheduler", address)
    assert outcome.code == 3 and "broken: not diagnosed" in outcome.err, outcome.err
    assert _hashes(tmp_path / "out") == _hashes(locally[0])


@pytest.mark.minutes
def test_no_cluster_there_is_told_in_time(fleet: list[Path], tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    outcome = _run(*fleet, "--out", tmp_path / "out", "--scheduler", f"tcp://127.0.0.1:{port}")
    assert outcome.code == 4 and "no Dask scheduler" in outcome.err and "dask scheduler" in outcome.err
    assert _run(*fleet, "--out", tmp_path / "out", "--scheduler", "somewhere").code == 2
    assert not (tmp_path / "out").exists()


def test_a_cluster_without_workers_is_told_in_time(
    fleet: list[Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, brace: Callable[..., Outcome]
) -> None:
    from brace.diagnose.fleet import cluster as there

    monkeypatch.setattr(there, "WORKERS_S", 1.0)
    with cluster(0) as address:
        outcome = brace("diagnose", *fleet, "--out", tmp_path / "out", "--scheduler", address)
    assert outcome.code == 4 and "no workers" in outcome.err and "dask worker" in outcome.err


def test_workers_have_time_to_come(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ten seconds at least; the command without workers is tested with less."""
    from brace.diagnose.fleet import cluster as there

    class Client:
        def __init__(self, address: str, timeout: float) -> None:
            self.address, self.timeout_s = address, timeout

        def wait_for_workers(self, count: int, timeout: float) -> None:
            if count != 1 or not 10.0 <= timeout < 60.0:
                raise TimeoutError

        def close(self, timeout: float) -> None:
            pass

    monkeypatch.setitem(sys.modules, "distributed", SimpleNamespace(Client=Client, TimeoutError=TimeoutError))
    client, _ = there._connected("tcp://somewhere:8786")
    assert client.address == "tcp://somewhere:8786" and 1.0 <= client.timeout_s < 60.0


def test_a_faulty_record_is_not_counted_as_a_limb_that_differs() -> None:
    from brace.diagnose.fleet.overview import Line, _sentence

    def line(name: str, verdict: str) -> Line:
        return Line(name, {"verdict": verdict, "gap": None})

    lines = [line("a", "data_fault"), line("b", "effect"), line("c", "none")]
    assert _sentence(lines, 0) == "1 of 3 limbs differs from its model; b most. 1 record is faulty."
    told = "0 of 1 limb differs from its model. 1 record is faulty. 1 could not be diagnosed."
    assert _sentence(lines[:1], 1) == told
