"""docs/protocol.md: the frames of the wire, for people."""

from __future__ import annotations

from collections.abc import Sequence

from interface.measured import Values
from interface.messages import BASIC_IDS, NODES, REFUSED, Frame, Multiplexed, Signal, Wire
from interface.registers import COMMAND_ENTRY, MEASURED_ENTRY

WRITTEN_AS_ENTRIES = ("stop", "end_test", "seal_mac")  # wire/answers/parameters.c

_HEAD = """# Frames on CAN

Written by tools/interface from the dictionary; do not edit. This page lists the frames and what each is for. Where a field
lies in its frame, its step, its unit, its codes and what it means stand in the CAN databases
[brace.dbc](../firmware/interface/brace.dbc) and, for the frames of CAN FD,
[brace_fd.dbc](../firmware/interface/brace_fd.dbc), of node 1. The line `SG_ k_xx : 8|24@1- (0.0005,0)` of such a file
says: 24 bits from bit 8 on, signed (`+`: unsigned), in steps of 0.0005. A field that occurs in a group, a request or an
answer has that one's name before its own there: `space_k_xx`, `k_at_posture_theta1`.
`brace dbc --nodes 1 2 3` writes databases for other nodes.

Classic CAN, 11-bit identifiers shaped like CANopen's, eight bytes a frame, least significant bit first (Intel). A
controller adds its node number, 1 to 127, to the identifiers below; without a number it only listens. A value that is not
known has a code of its own, never zero: the most negative one of a signed value, all ones of an unsigned one. A value
beyond its range is limited; where one of K is, it carries the flag SATURATED.

A frame of the identifier 0x001, with or without data, is a stop for every controller of the bus: set-points stay where
they are. Anybody may send it. `controller.stop_id` can be another number, from 0x001 to 0x07f.

All frames of one snapshot carry the same sequence: put together only what agrees. Two ends that do not have the same
dictionary hash (heartbeat, `identify`) speak different languages and have to say so. Pass over a part or an answer whose
number you do not know.

An example: `cansend can0 601#030920A107804F12` asks node 1 for K at theta1 = 0.5 rad and theta2 = 1.2 rad (request 3),
with the token 9. The answer has four frames. `581#0309A81E0018F1FF` is the first (number 3): k_xx is 3.924 N/mm, k_xz
is -1.908 N/mm.

## Identifiers

"""

_FD = """
## In one frame, where CAN FD is

With `controller.can_fd_bit_rate` set, and from the next start on, a controller whose CAN can do it sends each snapshot as one
frame of CAN FD with bit-rate switch; all else stays classic. Everything in it is of one tick; its numbers are floats as the
controller has them, NaN where a value is not known. Where the controller's CAN is classic only (bxCAN), or the interface's
MTU is (SocketCAN, 16), it goes on with classic frames. Over SLCAN snapshots are classic too.

"""


def protocol_page(wire: Wire, values: Values, dictionary_hash: int) -> str:
    """The whole page."""
    classic, fd = wire.classic, wire.fd
    parts = [_HEAD,
             f"Protocol {wire.protocol}, dictionary 0x{dictionary_hash:08x}.\n\n", _identifiers(wire),
             "\n## What a controller sends by itself\n\n", _sent(wire.messages, classic),
             *(_groups(message) for message in classic),
             _FD, _sent(wire.fd_messages, fd), *(_groups(message) for message in fd)]
    parts.append(
        f"\n## What it answers\n\nAsked on 0x{wire.request_id:03x} + node, answered on 0x{wire.answer_id:03x} + node. "
        "Byte 0 of a request is its code. An answer has one frame or several; byte 0 of each is a number that no other"
        " frame of any answer has. Byte 1 is a token that comes back in every frame of the answer. The fields begin at"
        " bit 16. The token's upper four bits say which master of the bus asks: masters are answered"
        " in turn, and what a master has begun (a force that was sent, a download) is that master's. A stop is obeyed"
        " before anything else, commands go before questions, and each port answers one question a tick."
        f" The number {REFUSED} is a refusal, of whatever request: {_names(wire.refusal.signals)}"
        " ([statuses and refusals](errors.md)).\n\n"
        "| code | request | what it does | asked with | answered with, by number |\n|---|---|---|---|---|\n"
    )
    for request in wire.requests:
        answers = "; ".join(f"{one.command}: {_names(one.signals) or 'nothing more'}" for one in request.answers)
        asked = _names(request.question.signals) or "nothing more"
        parts.append(f"| {request.code} | `{request.name}` | {_sentence(request.description)} | {asked} | {answers} |\n")
    parts.append(
        "\n## Entries\n\n`read_entry` and `write_entry` call parameters by the numbers that"
        " [limb.toml's keys](limb-keys.md) are listed with, half their Modbus addresses. For `read_entry` a measured value"
        f" has the number {MEASURED_ENTRY} and half its address in [modbus.csv](../firmware/interface/modbus.csv).\n"
        "\n`write_entry` takes these commands, too, in every mode that allows them. Its answer's value is then the"
        " controller's setting: bench or guarded ([security.md](security.md)).\n\n| number | name | what it does |\n"
        "|---|---|---|\n"
    )
    parts += [f"| {COMMAND_ENTRY + v.index} | `{v.name}` | {v.description} |\n"
              for v in values.commands if v.name in WRITTEN_AS_ENTRIES]  # fmt: skip
    return "".join(parts)


def _identifiers(wire: Wire) -> str:
    """Every identifier, and which are free."""
    used = {message.identifier: f"`{message.name}`" for message in wire.process}
    used |= {wire.request_id: "requests", wire.answer_id: "answers"}
    rows = [f"| 0x{one:03x} + node | {used.get(one, 'free')} |\n" for one in range(NODES, BASIC_IDS, NODES)]
    return "| identifier | what it is |\n|---|---|\n| 0x001 | stop |\n" + "".join(rows)


def _sent(frames: Sequence[Frame], multiplexed: Sequence[Multiplexed]) -> str:
    """Messages of one frame, and what all frames of the others have."""
    rows = [f"| `{frame.name}` | {_sentence(frame.description)}{_often(frame.rate)} | {_names(frame.signals)} |\n"
            for frame in frames]  # fmt: skip
    rows += [f"| `{message.name}` | {_sentence(message.description)} | in every part: {_names(message.common)} |\n"
             for message in multiplexed]  # fmt: skip
    return "| message | what it is | fields |\n|---|---|---|\n" + "".join(rows)


def _groups(message: Multiplexed) -> str:
    text = [f"\nThe parts of `{message.name}`, by number:\n\n| group | what it is | fields |\n|---|---|---|\n"]
    for group in message.groups:
        fields = "; ".join(f"{frame.part}: {_names(message.own(frame))}" for frame in group.parts)
        text.append(f"| `{group.name}` | {_sentence(group.description)}{_often(group.rate)} | {fields} |\n")
    return "".join(text)


def _often(rate: str) -> str:
    return f" As often as `{rate}` says." if rate else ""


def _sentence(words: str) -> str:
    return words[0].upper() + words[1:] + "."


def _names(signals: Sequence[Signal]) -> str:
    return ", ".join(f"`{signal.name}`" for signal in signals)
