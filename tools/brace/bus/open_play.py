"""Which joint's play leaves K open, and the command that takes it up."""

from __future__ import annotations

from collections.abc import Sequence

from brace.wire.layout import Value

_JOINTS = ("femur", "tibia")


def open_joints(flags: Sequence[str], play: Sequence[str]) -> tuple[str, ...]:
    """Joints of the plane whose gap K counts as open; () while none is. play: of femur and tibia, as the controller
    sends it. A joint without play is sent as one whose side is not known; where both have a side, the load
    holds neither."""
    if "GAP_OPEN" not in flags or len(play) != len(_JOINTS):
        return ()
    without_side = tuple(joint for joint, side in zip(_JOINTS, play, strict=True) if not side.startswith("engaged"))
    return without_side or _JOINTS


def open_play_lines(
    flags: Sequence[str], play: Sequence[str], bus: str, engaged_k: tuple[Value, Value, Value] | None = None
) -> list[str]:
    """What a person should do about it, and K xx, xz, zz once all is taken up, where it is sent."""
    joints = open_joints(flags, play)
    if not joints:
        return []
    command = f"brace take-up {joints[-1]}- --bus {bus} (or {joints[-1]}+) takes it up"
    if len(joints) == 1:
        lines = [f"the gap of the {joints[0]} is open: {command}"]
    else:
        lines = [f"a gap is open, of the femur or the tibia, whichever has play: {command}"]
    if engaged_k is not None and None not in engaged_k:
        xx, xz, zz = engaged_k
        lines.append(f"once all is taken up K = [{xx:.4f} {xz:.4f}; {xz:.4f} {zz:.4f}] N/mm")
    return lines
