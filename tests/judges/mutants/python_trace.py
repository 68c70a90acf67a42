"""A plugin of pytest that notes which test runs which line of the Python tools, and how long each test takes.

What a child process runs counts for the test that started it: swap/sitecustomize.py begins to count there. What a
fixture runs that several tests share counts for each test that asks for the fixture. What is run while a module is
imported has the context IMPORT.
"""

from __future__ import annotations

import json
import os
import resource
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

IMPORT = "import"
CONTEXT = "BRACE_MUTANT_CONTEXT"  # what a child's lines count for
TIMES = "BRACE_MUTANT_TIMES"  # where the times go
SETTINGS = "BRACE_MUTANT_SETTINGS"  # coverage's
MOST = "BRACE_MUTANT_MOST_S"  # no test begins after so long


def spent_s() -> float:
    """Processor time of this process and of its children that have ended."""
    own, children = resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN)
    return own.ru_utime + own.ru_stime + children.ru_utime + children.ru_stime


class Trace:
    """What runs now, and the times."""

    def __init__(self) -> None:
        import coverage  # here: the judge's own tests run without it

        # mypy takes our own coverage.py for it
        self.cover = coverage.Coverage(config_file=os.environ[SETTINGS], data_suffix=True)  # type: ignore[attr-defined]
        # Python runs its own handler of SIGTERM late. A forked process that gets SIGTERM before that would not end, so
        # coverage leaves the signal to the system.
        self.cover.set_option("run:sigterm", False)
        os.environ["COVERAGE_PROCESS_START"] = os.environ[SETTINGS]  # of what the tests start, not of this process
        self.context = ""
        self.began_s = time.monotonic()
        self.shared_s: dict[str, tuple[float, float]] = {}
        self.taken = (0.0, 0.0)  # by shared fixtures during the test that runs
        self.passes = True
        self.cover.start()
        self.turn_to(IMPORT)

    def turn_to(self, context: str) -> str:
        """From here on lines count for this context. returns the one before"""
        before, self.context = self.context, context
        self.cover.switch_context(context)
        os.environ[CONTEXT] = context
        return before

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        if time.monotonic() - self.began_s > float(os.environ[MOST]):
            item.session.shouldstop = "the time for this room is over"
        self.taken, self.passes = (0.0, 0.0), True
        before = self.turn_to(item.nodeid)
        cpu_s, wall_s = spent_s(), time.monotonic()
        try:
            return (yield)
        finally:
            self.turn_to(before)
            fixtures = [name for name in self.shared_s if shared_by(name, item)]
            note = {
                "test": item.nodeid,
                "passes": self.passes,
                "cpu_s": round(spent_s() - cpu_s - self.taken[0] + sum(self.shared_s[n][0] for n in fixtures), 3),
                "wall_s": round(
                    time.monotonic() - wall_s - self.taken[1] + sum(self.shared_s[n][1] for n in fixtures), 3
                ),
                "fixtures": fixtures,
            }
            with Path(os.environ[TIMES]).open("a") as out:
                out.write(json.dumps(note) + "\n")

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self.passes = self.passes and (report.passed or report.when != "call") and not report.failed
        self.passes = self.passes and not report.skipped

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(
        self, fixturedef: pytest.FixtureDef[object], request: pytest.FixtureRequest
    ) -> Iterator[None]:
        if fixturedef.scope == "function" or self.context.startswith("fixture "):
            return (yield)
        name = f"fixture {request.node.nodeid} {fixturedef.argname}"
        before = self.turn_to(name)
        cpu_s, wall_s = spent_s(), time.monotonic()
        try:
            return (yield)
        finally:
            self.turn_to(before)
            took = (spent_s() - cpu_s, time.monotonic() - wall_s)
            self.shared_s[name] = took
            self.taken = (self.taken[0] + took[0], self.taken[1] + took[1])

    def pytest_sessionfinish(self) -> None:
        self.cover.stop()
        self.cover.save()


def shared_by(fixture: str, item: pytest.Item) -> bool:
    """Does the test ask for the fixture, of its own module or of all?"""
    _, place, name = fixture.rsplit(" ", 2) if fixture.count(" ") == 2 else ("", "?", "?")
    return name in getattr(item, "fixturenames", ()) and item.nodeid.startswith(place)


def pytest_configure(config: pytest.Config) -> None:
    config.pluginmanager.register(Trace(), "brace-trace")
