"""A set of parameters to a controller: stored, read back, compared; rolled back when it is not the same."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from brace.bus.controller import Advance, Controller, Stored
from brace.ground.errors import BraceError, NotVerifiedError
from brace.params import Block, differences


@contextlib.contextmanager
def configuration(device: Controller) -> Iterator[None]:
    """In CONFIGURATION; back in MONITOR whatever happens, if the controller still hears us."""
    try:
        device.enter_configuration()
        yield
    except BaseException:
        with contextlib.suppress(BraceError):
            device.leave_configuration()
        raise
    device.leave_configuration()


def push(device: Controller, block: Block, advance: Advance) -> Stored:
    """Uploads, commits, reads back, compares. NotVerifiedError when what is in force afterwards is not the block; the
    set before is then in force again, if the controller lets it."""
    before = device.identify().parameter_crc
    with configuration(device):
        device.upload(block, advance)
        try:
            stored = device.commit(block)
        except BraceError as error:
            stored = _after_lost_commit(device, block, before, error)
        difference = _difference(device, block)
        if difference or stored.crc != block.identity:
            raise _rolled_back(
                device, before, difference or f"its CRC is {stored.crc:08x}, ours {block.identity:08x}"
            )
    return stored


def _after_lost_commit(device: Controller, block: Block, before: int, error: BraceError) -> Stored:
    """The answer was lost, or the commit refused: which set is in force says it."""
    now = device.identify().parameter_crc
    if now == block.identity:
        return Stored(0, now)
    if now == before:
        raise NotVerifiedError(
            "the set was not stored; the one before is in force",
            where=device.url,
            why=f"{error.what} ({error.why})",
            next_step="brace query shows faults (STORE: the memory does not keep what is written); push again",
        ) from None
    raise _rolled_back(device, before, f"after {error.what}, neither set is in force") from None


def _difference(device: Controller, block: Block) -> str:
    """Empty when the values in force are the block's."""
    try:
        found = differences(block, device.download(lambda _done: None))
    except BraceError as error:
        return f"it cannot be read back: {error.what}"
    if not found:
        return ""
    first = found[0]
    more = f" and {len(found) - 1} more" if len(found) > 1 else ""
    return f"{first.key} is {first.second} {first.unit}, not {first.first}{more}".replace("  ", " ")


def _rolled_back(device: Controller, before: int, why: str) -> NotVerifiedError:
    try:
        crc = device.rollback().crc
        end = (
            "rolled back"
            if crc == before
            else f"rolled back to another set, CRC {crc:08x} (before: {before:08x})"
        )
    except BraceError as error:
        end = f"and the roll-back failed: {error.what}"
    return NotVerifiedError(
        f"what is in force is not what was written; {end}",
        where=device.url,
        why=why,
        next_step="check the bus (brace monitor) and the controller's faults (brace query), and push again",
    )
