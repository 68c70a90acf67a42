"""docs/protocol.md: the frames of the wire, for people."""

from __future__ import annotations

from collections.abc import Sequence

from interface.measured import Values
from interface.messages import BASIC_IDS, NODES, REFUSED, Frame, Multiplexed, Signal, Wire
from interface.registers import COMMAND_ENTRY, MEASURED_ENTRY

WRITTEN_AS_ENTRIES = ("stop", "end_test", "seal_mac")  # wire/answers/parameters.c

_HEAD = """# Frames on CAN

Written by tools/interface from the dictionary; do not edit. As CAN databases: `firmware/interface/brace.dbc`,
and `brace_fd.dbc` for the frame of CAN FD.

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
    parts = [_HEAD,
             f"Protocol {wire.protocol}, dictionary 0x{dictionary_hash:08x}.\n\n", _identifiers(wire),
             "\n## What a controller sends by itself\n"]
    for frame in wire.messages:
        often = f" As often as `{frame.rate}` says." if frame.rate else ""
        parts.append(f"\n### {frame.name}, 0x{frame.identifier:03x} + node\n\n{_sentence(frame.description)}"
                     f"{often}\n\n")
        parts.append(_table(frame))
    parts += [_parts(message) for message in wire.classic]
    parts.append(_FD)
    for frame in wire.fd_messages:
        parts.append(f"\n### {frame.name}, 0x{frame.identifier:03x} + node, {frame.bytes} bytes\n\n"
                     f"{_sentence(frame.description)}")
        parts.append(f" As often as `{frame.rate}` says.\n\n")
        parts.append(_table(frame))
    parts += [_parts(message) for message in wire.fd]
    parts.append(
        f"\n## What it answers\n\nAsked on 0x{wire.request_id:03x} + node, answered on 0x{wire.answer_id:03x} + node. "
        "Byte 0 of a request is its code. An answer has one frame or several; byte 0 of each is a number that no other"
        " frame of any answer has. Byte 1 is a token that comes back in every frame of the answer. The fields begin at"
        " bit 16. The token's upper four bits say which master of the bus asks: masters are answered"
        " in turn, and what a master has begun (a force that was told, a download) is that master's. A stop is obeyed"
        " before anything else, commands go before questions, and each port answers one question a tick."
        f" The number {REFUSED} is a refusal, of whatever request:\n\n"
    )
    parts.append(_table(wire.refusal))
    for request in wire.requests:
        parts.append(f"\n### {request.code} {request.name}\n\n{_sentence(request.description)}\n\n")
        parts.append(_table(request.question) if request.question.signals else "Nothing more is asked.\n")
        for answer in request.answers:
            parts.append(f"\nAnswer, number {answer.command}:\n\n" + _table(answer))
    parts.append(
        "\n## Entries\n\nFor `read_entry` and `write_entry` parameters have the numbers that"
        " [limb.toml's keys](limb-keys.md) are listed with, half their Modbus addresses; for `read_entry`"
        f" measured values count from {MEASURED_ENTRY}:\n\n| number | name | type | unit |\n|---|---|---|---|\n"
    )
    parts += [f"| {MEASURED_ENTRY + v.index} | `{v.name}` | {v.type} | {v.unit} |\n" for v in values.measured]
    parts.append(
        "\n`write_entry` takes four commands, too, in every mode that allows them. Its answer's value is then the"
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


def _parts(message: Multiplexed) -> str:
    size = f", {message.bytes} bytes" if message.is_fd else ""
    text = [f"\n### {message.name}, 0x{message.identifier:03x} + node{size}\n\n{_sentence(message.description)} "
            f"Every frame has\n\n{_signals(message.common)}"]
    for group in message.groups:
        often = f" As often as `{group.rate}` says." if group.rate else ""
        text.append(f"\n#### {group.name}\n\n{_sentence(group.description)}{often}\n")
        text += [f"\nPart {frame.part}:\n\n{_signals(message.own(frame))}" for frame in group.parts]
    return "".join(text)


def _sentence(words: str) -> str:
    return words[0].upper() + words[1:] + "."


def _table(frame: Frame) -> str:
    return _signals(frame.signals)


def _signals(signals: Sequence[Signal]) -> str:
    rows = [f"| {s.start} | {s.bits} | `{s.name}` | {_kind(s)} | {s.description}{_meanings(s)} |\n" for s in signals]
    return "| bit | bits | name | what it counts | what it is |\n|---|---|---|---|---|\n" + "".join(rows)


def _kind(signal: Signal) -> str:
    sign = "signed" if signal.signed else "unsigned"
    if signal.kind == "value":
        unit = "" if signal.unit in ("", "1") else f" {signal.unit}"
        return f"steps of {signal.step:.10g}{unit}, {sign}"
    return "float" if signal.kind == "f32" else f"a number, {sign}"


def _meanings(signal: Signal) -> str:
    if signal.names:
        return ": " + ", ".join(f"{number} {name}" for number, name in sorted(signal.names.items()))
    if signal.bit_names:
        return "; bits from 0: " + ", ".join(signal.bit_names)
    return ""
