"""A fleet on a Dask cluster: the records travel to the workers, the results travel back."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from typing import Any

from brace.diagnose.fleet.job import Job, Outcome, lost, run_job, unreadable
from brace.diagnose.provenance import versions
from brace.ground.errors import BraceError, NoDeviceError, UsageError, VersionMismatchError

CONNECT_S = 10.0
WORKERS_S = 20.0
_POLL_S = 1.0


def run_on_cluster(jobs: Sequence[Job], address: str) -> Iterator[Outcome]:
    """Outcomes as they come."""
    client, distributed = _connected(address)
    try:
        _refuse_other_versions(client, address)
        futures: dict[Any, Job] = {}
        for job in jobs:
            try:
                carried = job.with_files()
            except BraceError as error:
                yield unreadable(job, error)
                continue
            futures[client.submit(run_job, carried, pure=False)] = job
        yield from _outcomes(client, distributed, futures, address)
    finally:
        client.close(timeout=CONNECT_S)


def _outcomes(client: Any, distributed: Any, futures: dict[Any, Job], address: str) -> Iterator[Outcome]:
    pending, alone_since = set(futures), time.monotonic()
    while pending:
        try:
            finished, pending = distributed.wait(pending, timeout=_POLL_S, return_when="FIRST_COMPLETED")
        except (TimeoutError, distributed.TimeoutError):
            finished = set()
        for future in finished:
            error = future.exception()
            yield (
                future.result()
                if error is None
                else lost(futures[future], f"{type(error).__name__}: {error}")
            )
        if finished or client.status != "running" or client.scheduler_info()["workers"]:
            alone_since = time.monotonic() if client.status == "running" else alone_since
        if time.monotonic() - alone_since > WORKERS_S:
            raise NoDeviceError(
                "the cluster has no workers any more",
                where=address,
                why=f"{len(pending)} of {len(futures)} records are not diagnosed",
                next_step="start workers and run the command again; without --scheduler it runs on this "
                "machine",
            )


def _connected(address: str) -> tuple[Any, Any]:
    try:
        import distributed
    except ImportError:
        raise UsageError(
            "--scheduler needs Dask",
            why="dask.distributed is not installed",
            next_step="pip install 'brace[cluster]', or leave --scheduler out: it runs on this machine's "
            "cores",
        ) from None
    if "://" not in address:
        raise UsageError(
            f"--scheduler {address}", why="an address has a protocol", next_step="--scheduler tcp://HOST:8786"
        )
    try:
        client = distributed.Client(address, timeout=CONNECT_S)
    except (OSError, TimeoutError, ValueError) as error:
        raise NoDeviceError(
            "no Dask scheduler there",
            where=address,
            why=str(error).partition("\n")[0] or "no answer",
            next_step="dask scheduler starts one and prints its address; dask worker ADDRESS joins it",
        ) from None
    try:
        client.wait_for_workers(1, timeout=WORKERS_S)
    except (TimeoutError, distributed.TimeoutError):
        client.close(timeout=CONNECT_S)
        raise NoDeviceError(
            "the cluster has no workers",
            where=address,
            why=f"none came in {WORKERS_S:.0f} s",
            next_step="dask worker " + address,
        ) from None
    return client, distributed


def _refuse_other_versions(client: Any, address: str) -> None:
    """Every worker must compute what this machine would."""
    ours = versions()
    try:
        theirs = client.run(versions)
    except Exception as error:  # a worker without brace fails with whatever its import fails with
        raise VersionMismatchError(
            "a worker cannot run brace",
            where=address,
            why=f"{type(error).__name__}: {error}",
            next_step="install the same brace where the workers run",
        ) from None
    for worker, found in theirs.items():
        if found != ours:
            odd = next(name for name in ours if found.get(name) != ours[name])
            raise VersionMismatchError(
                f"a worker has {odd} {found.get(odd)}, this machine {ours[odd]}",
                where=str(worker),
                why="the same data and seed would not give the same bytes",
                next_step="install the same versions where the workers run",
            )
