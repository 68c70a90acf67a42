"""A fleet on this machine: as many processes as asked for, a broken one costs its own record only."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool

from brace.diagnose.fleet.job import Job, Outcome, lost, run_job
from brace.ground import one_thread


def run_local(jobs: Sequence[Job], processes: int) -> Iterator[Outcome]:
    """Outcomes as they come. When a process dies (out of memory, say) all that were under way are tried
    again, one at a time, so that only the one that kills its process is lost."""
    suspects: list[Job] = []
    waiting = list(jobs)
    with _one_thread_each():
        while waiting:
            under_way, waiting = waiting, []
            for job, outcome in _run(under_way, processes):
                if outcome is not None:
                    yield outcome
                else:
                    suspects.append(job)
        for job in suspects:
            for _, outcome in _run([job], 1):
                yield outcome if outcome is not None else lost(job, "it was killed, or ran out of memory")


def _run(jobs: Sequence[Job], processes: int) -> Iterator[tuple[Job, Outcome | None]]:
    """Each job with its outcome, None where the pool broke before."""
    pool = ProcessPoolExecutor(
        min(processes, len(jobs)),
        mp_context=multiprocessing.get_context("spawn"),
        initializer=_follow_parent,
    )
    futures: dict[Future[Outcome], Job] = {}
    try:
        for job in jobs:
            futures[pool.submit(run_job, job)] = job
        pending = set(futures)
        while pending:
            finished, pending = wait(pending, return_when=FIRST_COMPLETED)
            for future in finished:
                yield futures[future], (
                    None
                    if isinstance(future.exception(), BrokenProcessPool)
                    else _outcome(futures[future], future)
                )
        pool.shutdown()
    finally:
        for process in list((pool._processes or {}).values()):
            process.terminate()
        pool.shutdown(wait=False, cancel_futures=True)


def _outcome(job: Job, future: Future[Outcome]) -> Outcome:
    error = future.exception()
    return future.result() if error is None else lost(job, f"{type(error).__name__}: {error}")


def _follow_parent() -> None:
    """A process of the pool ignores Ctrl-C, which its parent handles. The process ends when its parent has ended: a
    parent that was killed sends neither a record nor the end, and the process would wait for ever."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_after_parent, daemon=True).start()


def _end_after_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


@contextlib.contextmanager
def _one_thread_each() -> Iterator[None]:
    """Processes side by side, one thread each; they inherit it."""
    before = {name: os.environ.get(name) for name in one_thread.NAMES}
    os.environ.update(dict.fromkeys(one_thread.NAMES, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
