"""Taking up the backlash of joints and letting them go, waited for to its end."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Sequence
from dataclasses import dataclass

from brace.bus.controller import Controller
from brace.ground.errors import DeviceFaultError, NoDeviceError
from brace.wire.codes import MODE, TAKE_UP_OUTCOME

POLL_S = 0.05
_NOT_ENDED = ("none", "running")


@dataclass(frozen=True)
class Flank:
    """A joint, and the side of its backlash that shall be loaded, +1 or -1."""

    joint: str
    side: int

    @property
    def text(self) -> str:
        """`femur+`."""
        return f"{self.joint}{'+' if self.side > 0 else '-'}"


def take_up(device: Controller, flanks: Sequence[Flank], wait_s: float) -> None:
    """One joint after the other, each until its side is verified. If one fails, the controller lets all of them go.
    Raises DeviceFaultError with the reason, NoDeviceError after `wait_s` for one joint."""
    with device.living():
        _take_up(device, flanks, wait_s)


def _take_up(device: Controller, flanks: Sequence[Flank], wait_s: float) -> None:
    for flank in flanks:
        device.take_up(flank.joint, flank.side)
        until = time.monotonic() + wait_s
        while (outcome := device.take_ups()[flank.joint]) in _NOT_ENDED:
            _check(until, f"{flank.text}: the take-up has not ended within {wait_s:g} s", "brace let-go ends it")
            device.stay(POLL_S)
        if outcome != "held":
            with contextlib.suppress(NoDeviceError):
                _until_back(device, wait_s)
            why = next((code.text for code in TAKE_UP_OUTCOME.codes if code.name.lower() == outcome), outcome)
            raise DeviceFaultError(
                f"{flank.text} is not taken up",
                where=f"{device.url}, node {device.node}",
                why=f"{outcome}: {why}",
                next_step="all joints are let go; brace query shows their state, docs/backlash.md how a take-up goes",
            )


def let_go(device: Controller, wait_s: float) -> None:
    """Until every joint is back where it was. Raises NoDeviceError after `wait_s`."""
    with device.living():
        device.let_go()
        _until_back(device, wait_s)


def _until_back(device: Controller, wait_s: float) -> None:
    until = time.monotonic() + wait_s
    while MODE.name_of(device.read_entry("mode")) in ("TAKING_UP", "LOADING_TEST"):
        _check(until, f"the joints are not back within {wait_s:g} s", "brace monitor shows what moves")
        device.stay(POLL_S)


def _check(until: float, what: str, next_step: str) -> None:
    if time.monotonic() > until:
        raise NoDeviceError(what, why="the limb moves slowly, or its drives do not follow", next_step=next_step)
