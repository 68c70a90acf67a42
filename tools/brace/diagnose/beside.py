"""Work in a second process beside this one."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection
from typing import TypeVar

T = TypeVar("T")


def cores() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def beside(there: Callable[[], T], here: Callable[[], T], processes: int) -> Iterator[Callable[[], T]]:
    """Begins `there` in a second process where `processes` allows one, and yields a function that returns its result or
    raises its error. Where no second process can be had, or it was killed, `here` does the same work in this one when
    the result is asked for. The second process is a copy of this one, so that nothing is loaded or read again; `there`
    must do without what a thread of this process may hold, the terminal above all. Leaving the context ends it."""
    begun = _begun(there) if processes > 1 and "fork" in multiprocessing.get_all_start_methods() else None
    if begun is None:
        yield here
        return
    process, answer = begun

    def result() -> T:
        try:
            found, error = answer.recv()
        except EOFError:  # it was killed, for lack of memory say
            return here()
        if error is not None:
            raise error
        return found  # type: ignore[no-any-return]

    try:
        yield result
    finally:
        process.terminate()
        process.join()
        answer.close()


def _begun(work: Callable[[], T]) -> tuple[multiprocessing.process.BaseProcess, Connection] | None:
    fork = multiprocessing.get_context("fork")
    answer, sender = fork.Pipe(duplex=False)
    process = fork.Process(target=_do, args=(work, answer, sender), daemon=True)
    try:
        process.start()
    except OSError:  # too many processes, or no memory for one
        answer.close()
        return None
    finally:
        sender.close()  # the other side's own stays open until it ends
    return process, answer


def _do(work: Callable[[], object], answer: Connection, sender: Connection) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C ends the first process, which ends this one
    answer.close()  # so that writing fails, and does not wait, once the first process is gone
    try:
        outcome: tuple[object, Exception | None] = (work(), None)
    except Exception as error:
        outcome = (None, error)
    sender.send(outcome)
