"""What a controller's refusal means to the person who asked."""

from __future__ import annotations

from brace.ground.errors import BraceError, DeviceFaultError, UsageError

_STATUS = {  # brace_status_t: what, and whether the question was at fault
    -2: ("a value that is not finite", True),
    -3: ("out of range", True),
    -4: ("out of the limb's reach", True),
    -5: ("values that no limb can have", True),
    -6: ("K has no answer there: the compliance is singular", True),
    -7: ("too few samples for an answer", False),
    -8: ("not there on this controller", False),
    -10: ("not a parameter block", False),
    -11: ("a parameter block of another format", False),
    -12: ("bytes are missing or too many", False),
    -13: ("the CRC does not fit", False),
    -14: ("a parameter block for another list of parameters", False),
    -15: ("not in this mode", False),
    -64: ("it knows no such request", False),  # refusals.h
    -65: ("without its key", False),
    -66: ("it is storing a set, judging a loading test, or on its way back from one", False),
    -67: ("words came out of order", False),
    -68: ("the set in force has changed meanwhile", False),
    -69: ("it can only be read", True),
    -70: ("it does not know us: there is no session, or the key is another one", False),
    -71: ("the command came twice", False),
    -72: ("somebody else moves the limb or writes to it", False),
    -73: ("it is guarded, and has no key yet", False),
    -74: ("beyond what its board allows", True),
    -75: ("less than 10 s after the commit before: each wears its memory", False),
    -76: ("so many of our questions wait there already", False),
    -77: ("the sign of life carries an old number of the controller's: the link is slow", False),
    -81: ("the memory refused to read, write or erase", False),
    -82: ("the memory is not blank after an erase", False),
    -83: ("what was written is not what reads back", False),
    -84: ("there is no set to go back to", False),
    -85: ("the store is full of interrupted updates", False),
    -86: ("the memory is too small for a set", False),
    -87: ("a value is out of range, or values contradict each other", True),
}
_IN_SPACE = "k_in_space_at_posture"
_UNSUPPORTED, _MODE = -8, -15
_OF_NOW = ("contact_force", "sag_for_load")  # asked of the K of now; the detail is its flags
_GAP_OPEN = 8
BUSY = -66
ORDER = -67
_SINGULAR = -6
STORE = -80  # plus what the store says, -1 to -7
_WAYS = {
    -3: "values inside the range that the firmware's dictionary names",
    -4: "a place nearer than the straight limb reaches, and not nearer than the folded one",
    -64: "flash the firmware of this version (brace flash)",
    -68: "once more",
    -70: "--key FILE with the key of this controller",
    -72: "wait until it is done; brace query --entry owner reports by which port",
    -74: "the detail is the number of the parameter (docs/limb-keys.md); the ceilings stand in the board's own file",
    -84: "brace params push FILE stores one",
    -15: "brace query shows its mode; a loading test, play being taken up or a fault stands in the way",
}


def no_equilibrium(where: str, why: str) -> UsageError:
    """There is no K under that force."""
    return UsageError(
        "there is no K under this force: it folds the limb there",
        where=where,
        why=f"no stable equilibrium is near ({why})",
        next_step="a smaller force or another place; brace plan finds places that carry a load",
    )


def no_coxa_joint(where: str, why: str) -> UsageError:
    """There is no K in space."""
    return UsageError(
        f"the controller refuses {_IN_SPACE}: the limb has no coxa joint",
        where=where,
        why=f"its coxa joint gives no samples, so K is that of the limb's plane ({why})",
        next_step="ask without --theta0",
    )


def error_of(what: str, status: int, detail: int, where: str) -> BraceError:
    """An error with its exit code: 2 where the question was at fault, 5 where the device is."""
    if what in _OF_NOW and status == -3 and detail & _GAP_OPEN:
        return DeviceFaultError(
            f"the controller refuses {what}: a joint's play is open, so nothing carries the tip in some direction",
            where=where,
            why=f"status {status}, detail {detail}: K of now is flagged GAP_OPEN",
            next_step="take up the backlash first (brace take-up), or ask for K with the play "
            "closed: --theta1 --theta2",
        )
    if what == "let_go" and status == _MODE:
        return DeviceFaultError(
            "nothing is taken up, and no loading test runs: there is nothing to let go",
            where=where,
            why=f"status {status}",
            next_step="brace query shows how the last take-up of each joint went",
        )
    if what == "take_up" and status == _UNSUPPORTED:
        return DeviceFaultError(
            "there is no play to take up: the joint's gap_rad is 0, or nothing moves the joint",
            where=where,
            why=f"the controller refuses take_up with status {status}",
            next_step="brace params pull shows gap_rad of each joint; brace params push stores another one",
        )
    if what == _IN_SPACE and status == _UNSUPPORTED:
        return no_coxa_joint(where, f"status {status}")
    if (what == _IN_SPACE or what.startswith("k_under_load_")) and status == _SINGULAR:
        return no_equilibrium(where, f"status {status}")
    reason, asked_wrong = _STATUS.get(status, (f"status {status}", False))
    kind = UsageError if asked_wrong else DeviceFaultError
    return kind(
        f"the controller refuses {what}: {reason}",
        where=where,
        why=f"status {status}, detail {detail}",
        next_step=_WAYS.get(status, "brace query shows mode, faults and parameters"),
    )
