"""Fixtures for the tests of the `brace` command. They need the built library: ./dev setup."""

from __future__ import annotations

import signal
from collections.abc import Callable
from pathlib import Path

from brace.ground import one_thread  # noqa: F401  before numpy is loaded
import pytest

from brace.cli import main
from command_bench import DATA, Outcome

# A shell starts what it puts in the background with Ctrl-C ignored, and children would inherit that.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def paper_limb() -> Path:
    return DATA / "paper-limb.toml"


@pytest.fixture
def paper_table() -> Path:
    return DATA / "paper_table1"


@pytest.fixture
def paper_rig() -> Path:
    return DATA / "paper-rig.toml"


@pytest.fixture
def brace(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Callable[..., Outcome]:
    """Runs the command in this process."""
    monkeypatch.delenv("BRACE_DEBUG", raising=False)

    def run(*arguments: object) -> Outcome:
        capsys.readouterr()
        try:
            code = main([str(argument) for argument in arguments])
        except SystemExit as stop:  # argparse: usage, --help
            code = int(stop.code or 0)
        streams = capsys.readouterr()
        assert "Traceback" not in streams.err, streams.err
        assert "internal error" not in streams.err, streams.err
        return Outcome(code, streams.out, streams.err)

    return run
