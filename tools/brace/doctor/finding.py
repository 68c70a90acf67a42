"""One thing looked at, and where things are looked for."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[3]

OK, MISSING, OLD, NOTE, FAULTY = "ok", "missing", "old", "note", "fault"
CONTROLLER = "controller"

#: What things are for; the first two are what everybody needs.
PURPOSES = {
    "tools": "the brace command",
    "build": "building for this machine",
    "images": "building and emulating firmware images",
    "flash": "putting images on boards",
    "wire": "talking to controllers",
    CONTROLLER: "the controller at --bus",
}
ALWAYS_NEEDED = ("tools", "build")


@dataclass(frozen=True)
class Finding:
    """`state`: ok, missing, old (there, but older than what it is made from), note (nothing is wrong), fault."""

    purpose: str
    name: str
    state: str
    found: str
    next_step: str = ""

    @property
    def is_good(self) -> bool:
        """Nothing needs to be done."""
        return self.state in (OK, NOTE)


@dataclass(frozen=True)
class Machine:
    """Where to look; tests look elsewhere."""

    project: Path = PROJECT
    sys: Path = Path("/sys")
    dev: Path = Path("/dev")
    modules: Path = field(default_factory=lambda: Path("/lib/modules") / _kernel())
    native: Path = Path(__file__).resolve().parents[1] / "_native"  # the library of an installed package

    @property
    def is_installed(self) -> bool:
        """The command was installed from a package with the library inside: nothing has to be built."""
        return self.native.is_dir()

    @property
    def needed(self) -> tuple[str, ...]:
        """The purposes without which nothing works here."""
        return ALWAYS_NEEDED[:1] if self.is_installed else ALWAYS_NEEDED


def _kernel() -> str:
    import platform

    return platform.release()


def first_line(command: list[str], limit_s: float = 3.0) -> str:
    """The first line a program says; empty when it says nothing in time."""
    import subprocess  # here, so that the command line's help need not load it

    try:
        done = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, timeout=limit_s, check=False, text=True,
            errors="replace",
        )  # fmt: skip
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return next((line.strip() for line in (done.stdout + done.stderr).splitlines() if line.strip()), "")
