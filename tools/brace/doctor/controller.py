"""A controller on a wire: its faults, and the troubles that it only counts."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from brace.doctor.finding import CONTROLLER, FAULTY, NOTE, OK, Finding
from brace.wire.codes import FAULT

_JUMP = "look at that joint: encoder, magnet, wires, drive; once it stands where its encoder says: brace clear jump"
#: fault -> what to do; of the others docs/errors.md says it
_FAULTS = {
    "PARAMETERS": "brace params push FILE",
    "OLD_PARAMETERS": "brace params push FILE stores the set again; brace clear parameters takes the older one for now",
    "MODEL_DRIFT": "brace query says the likeliest cause; docs/drift.md",
    "CRASHED": "read the console's banner, then: brace clear crash",
    "ENCODER_STUCK": "free the joint and look at its encoder; one that works: brace clear encoder",
    "JUMP_COXA": _JUMP,
    "JUMP_FEMUR": _JUMP,
    "JUMP_TIBIA": _JUMP,
}

#: counter -> what it means where it is not 0, and what to do
_COUNTERS = {
    "ticks_late": ("ticks came late", "set a longer controller.tick_us"),
    "samples_bad": ("samples of joints were refused", "look at the drives' wires, and at jumps of their angles"),
    "frames_refused": ("CAN frames were not taken by the bus", "look at wires, termination and bit rate"),
    "frames_unknown": ("CAN frames had no known form", "compare the dictionary of whoever sends them: brace query"),
    "frames_lost": ("requests over CAN found no room", "ask less often: a request each millisecond"),
    "questions_busy": ("questions were refused as busy", "ask again after an answer; eight of one asker may wait"),
    "requests_lost": ("requests or answers found no room", "look who floods the bus, and whether answers are read"),
    "commands_failed": ("commands were refused by a drive", "look at the drive's own errors"),
    "strangers_refused": (
        "commands came without the key, or from somebody who is not the owner", "look who else is on the bus: docs/security.md"
    ),
    "replays_refused": ("sealed commands came twice", "look for a repeater, or for somebody who records: docs/security.md"),
    "silences": ("times the limb stopped because its owner fell silent", "give a sign of life each 100 ms: docs/security.md"),
    "commits_refused": ("commits were refused as too soon or of another set", "10 s between two; brace params push waits"),
    "modbus_broken": ("Modbus frames had a wrong check", "look at wires, baud rate and parity"),
    "modbus_refused": ("Modbus requests were answered with an exception", "docs/modbus.md says what each means"),
}


def controller(where: str, read_entry: Callable[[str], int]) -> Iterator[Finding]:
    """What is wrong with it. `read_entry` reads a measured value by its name."""
    bits = read_entry("faults")
    for code in FAULT.codes:
        if bits >> code.number & 1:
            next_step = _FAULTS.get(code.name, "docs/errors.md says what to do")
            yield Finding(CONTROLLER, code.name.lower(), FAULTY, code.text, next_step)
    if not bits:
        yield Finding(CONTROLLER, "faults", OK, f"{where}: none")
    for name, (meaning, next_step) in _COUNTERS.items():
        count = read_entry(name)
        if count:
            yield Finding(CONTROLLER, name, NOTE, f"{count} {meaning} since start", next_step)
