"""brace/can_frames.h: lists of all messages, from which a controller builds its tables."""

from __future__ import annotations

from collections.abc import Sequence

from interface.messages import Frame, Wire

_MADE = "/* Written by tools/interface from messages.toml; do not edit. */\n"
_HEAD = """
/* Every message of messages.toml, as lists for the preprocessor. A controller makes its tables from them, so a new
 * message needs no hand-written line.
 *
 * BRACE_CAN_PROCESS(X)     X(identifier, name, rate, coxa): classic frames of measured values, name as in
 *                          brace_can_make_<name>; rate is the member of brace_controller_t that says how often; coxa is
 *                          1 where only a limb whose coxa joint is fitted sends the frame, else 0. Each part of a
 *                          multiplexed message stands by itself, in order.
 * BRACE_CAN_PROCESS_FD(X)  the same of CAN FD
 * BRACE_CAN_BY_HAND(X)     X(identifier, name): classic frames that hand-written code fills and sends
 * BRACE_CAN_FRAMES(X)      X(name, bytes): every frame there is, requests and answers too; name as in
 *                          brace_can_pack_<name>
 */
#include "brace/can_messages.h"
"""


def dispatch_header(wire: Wire) -> str:
    """generated/brace/can_frames.h"""
    classic = [frame for frame in wire.process_frames if not frame.is_fd]
    identifiers = {part.name: message.name for message in wire.multiplexed for part in message.parts}
    lists = [
        ("BRACE_CAN_PROCESS", _rated(classic, identifiers)),
        ("BRACE_CAN_PROCESS_FD", _rated([frame for frame in wire.process_frames if frame.is_fd], identifiers)),
        ("BRACE_CAN_BY_HAND",
         [f"X({_identifier(frame, identifiers)}, {frame.name})" for frame in classic if not frame.is_measured]),
        ("BRACE_CAN_FRAMES", [f"X({frame.name}, {frame.bytes})" for frame in wire.frames]),
    ]
    parts = [_MADE, "#ifndef BRACE_CAN_FRAMES_H\n#define BRACE_CAN_FRAMES_H\n", _HEAD]
    parts += [f"\n#define {name}(X) \\\n    " + " \\\n    ".join(items) + "\n" for name, items in lists]
    return "".join(parts) + "\n#endif\n"


def _rated(frames: Sequence[Frame], identifiers: dict[str, str]) -> list[str]:
    return [
        f"X({_identifier(frame, identifiers)}, {frame.name}, {frame.rate.removeprefix('controller.')}, "
        f"{frame.needs_coxa:d})"
        for frame in frames if frame.is_measured
    ]


def _identifier(frame: Frame, identifiers: dict[str, str]) -> str:
    return f"BRACE_CAN_ID_{identifiers.get(frame.name, frame.name).upper()}"
