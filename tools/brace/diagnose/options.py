"""How to diagnose: what a person may set."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

Advance = Callable[[float, str], None]
"""Called with the share done [0, 1] and what is being tried."""


def silent(_share: float, _doing: str) -> None:
    """Shows nothing."""


def idle() -> None:
    """Does nothing."""


@dataclass(frozen=True)
class Options:
    """`seed` fixes every random draw; `faults` is what to do about faulty entries that have one repair: "repair" says
    so and goes on to physics where the fault is one that the record itself corrects, "stop" ends at the fault. `take`
    is the member of an ambiguous verdict whose limb is exported; `processes` may work at once. `meanwhile` is done here
    while a second process has the rest of the work."""

    seed: int = 0
    faults: str = "repair"
    take: str | None = None
    processes: int = 1
    meanwhile: Callable[[], None] = idle
