"""One record of a fleet, as it travels to the process that diagnoses it, and what comes back."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from brace.diagnose.options import Options
from brace.ground.errors import EXIT_BAD_FILE, EXIT_CHECK_FAILED, BraceError
from brace.ground.files import DATA_LIMIT_BYTES, TOML_LIMIT_BYTES, read_bytes

_RECORD = ("meta.toml", "data.csv")


@dataclass(frozen=True)
class Job:
    """`carried` holds the files themselves where the other side cannot read ours (a cluster); else it is
    empty."""

    name: str  # of the results' folder
    folder: Path
    model: Path | None
    options: Options
    carried: Mapping[str, bytes] = field(default_factory=dict)

    def with_files(self) -> Job:
        """The same with its files in it."""
        files = {
            name: read_bytes(self.folder / name, DATA_LIMIT_BYTES, f"dataset's {name}") for name in _RECORD
        }
        if self.model is not None:
            files["limb.toml"] = read_bytes(self.model, TOML_LIMIT_BYTES, "limb model")
        return replace(self, carried=files)


@dataclass(frozen=True)
class Outcome:
    """`files`, `data` (diagnosis.json) and `cautions` of a record that was diagnosed; `error` of one that was not; the
    exit code of either."""

    name: str
    files: Mapping[str, bytes] = field(default_factory=dict)
    data: Mapping[str, Any] = field(default_factory=dict)
    error: str = ""
    code: int = 0
    cautions: tuple[str, ...] = ()

    @property
    def done(self) -> bool:
        """Was it diagnosed?"""
        return not self.error


def run_job(job: Job) -> Outcome:
    """Diagnoses one record. Never raises what would end the others."""
    try:
        if not job.carried:
            return _diagnosed(job)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name) / job.folder.name
            folder.mkdir()
            for leaf, content in job.carried.items():
                (folder / leaf).write_bytes(content)
            there = replace(job, folder=folder, model=folder / "limb.toml" if job.model else None)
            found = _diagnosed(there)
            return replace(found, error=found.error.replace(str(folder), str(job.folder)))
    except MemoryError:
        return Outcome(job.name, error="brace: out of memory", code=EXIT_CHECK_FAILED)


def _diagnosed(job: Job) -> Outcome:
    from brace.diagnose.one import diagnosed, load

    try:
        found, written = diagnosed(load(job.folder, job.model), job.options)
    except BraceError as error:
        return Outcome(job.name, error=error.render(), code=error.exit_code)
    except MemoryError:
        raise
    except Exception as error:  # a defect of ours must not end the others
        if os.environ.get("BRACE_DEBUG"):
            raise
        return Outcome(
            job.name, error=f"brace: internal error: {type(error).__name__}: {error}", code=EXIT_CHECK_FAILED
        )
    return Outcome(job.name, written.files, written.json_ready, code=found.exit_code, cautions=found.cautions)


def jobs_of(folders: Sequence[Path], model: Path | None, options: Options) -> list[Job]:
    """One job a folder, each with a name of its own."""
    from brace.diagnose.one import model_of

    jobs: list[Job] = []
    taken: set[str] = {"fleet.html", "fleet.json"}
    for folder in folders:
        name = folder.name or folder.resolve().name
        if name in taken:
            name = f"{folder.resolve().parent.name}-{name}"
        plain, number = name, 2
        while name in taken:
            name, number = f"{plain}-{number}", number + 1
        taken.add(name)
        jobs.append(Job(name, folder, model_of(folder, model), options))
    return jobs


def lost(job: Job, why: str) -> Outcome:
    """The process that had the record is gone."""
    what = f"brace: {job.folder}: the process that diagnosed it ended"
    text = f"{what}\n  why: {why}\n  try: brace diagnose on it alone"
    return Outcome(job.name, error=text, code=EXIT_CHECK_FAILED)


def unreadable(job: Job, error: BraceError) -> Outcome:
    """The record cannot even be read."""
    return Outcome(job.name, error=error.render(), code=error.exit_code or EXIT_BAD_FILE)
