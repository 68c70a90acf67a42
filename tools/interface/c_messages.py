"""The C side of the frames: can_messages.h and the sources of the codecs."""

from __future__ import annotations

from collections.abc import Sequence

from interface.c_comment import c_comment
from interface.messages import CODES, FRAME_BITS, REFUSED, Frame, Multiplexed, Signal, Wire

_MADE = "/* Written by tools/interface from messages.toml; do not edit. */\n"
_HEAD = """
/* The frames of the wire, for the controller and for whoever speaks to it. Formats: docs/protocol.md.
 *
 * A value that is not known is NaN here and a code of its own on the wire, never zero. brace_can_pack_... limits what
 * does not fit and answers how many values it limited; the frame's bytes are always written. The greatest value that a
 * message's signal can carry is BRACE_CAN_<MESSAGE>_<MEMBER>_MOST; a signed one goes as far down. brace_can_unpack_...
 * always writes the struct: every bit pattern means something. Pure functions, no libm; any thread.
 * accuracy: half a step, and a float's rounding.
 * cost on a Cortex-M4F: below 120 instructions each; of the CAN FD frame 250.
 */
"""


def messages_header(wire: Wire, dictionary_hash: int) -> str:
    """generated/brace/can_messages.h"""
    parts = [
        _MADE, "#ifndef BRACE_CAN_MESSAGES_H\n#define BRACE_CAN_MESSAGES_H\n", _HEAD,
        "#include <stdint.h>\n\n",
        "/* Of every frame, entry and parameter, with types, steps and units: what two ends must agree on. */\n",
        f"#define BRACE_DICTIONARY_HASH 0x{dictionary_hash:08x}u\n",
        f"#define BRACE_PROTOCOL {wire.protocol}u\n\n",
        "/* Identifiers of node 0; a controller adds its node number, 1-127. */\nenum {\n",
        *(f"    BRACE_CAN_ID_{frame.name.upper()} = 0x{frame.identifier:03x},\n"
          for frame in wire.process),
        f"    BRACE_CAN_ID_REQUEST = 0x{wire.request_id:03x},\n    BRACE_CAN_ID_ANSWER = 0x{wire.answer_id:03x}\n"
        "};\n\n",
        "/* First byte of a request. */\nenum {\n",
        *(f"    BRACE_REQUEST_{request.name.upper()} = {request.code},\n" for request in wire.requests),
        "};\n\n/* First byte of an answer: the number of this frame, which no other answer has. */\nenum {\n",
        *(f"    BRACE_{frame.name.upper()} = {frame.command},\n"
          for request in wire.requests for frame in request.answers),
        f"    BRACE_ANSWER_REFUSED = {REFUSED}\n}};\n\n",
        "/* Frames of the answer, by the request's code; 0: no such request. */\n",
        f"extern const uint8_t brace_can_answer_parts[{CODES}];\n\n",
        "/* Whose answer's frame a number is, and which of its frames, counted from 0; parts of 0: nobody's. */\n",
        "typedef struct {\n    uint8_t code, part, parts;\n} brace_can_answer_frame_t;\n",
        f"extern const brace_can_answer_frame_t brace_can_answer_frames[{CODES}];\n",
    ]
    for message in wire.multiplexed:
        parts.append(_part_of(message))
    for frame in wire.frames:
        parts += ["\n", _struct(frame), _prototypes(frame)]
    return "".join(parts) + "\n#endif\n"


def messages_sources(wire: Wire) -> dict[str, str]:
    """generated/can_process.c, can_questions.c, can_answers.c: what a controller sends by itself, what it is asked, and
    what it answers."""
    counts = "".join(f"    [BRACE_REQUEST_{request.name.upper()}] = {len(request.answers)},\n"
                     for request in wire.requests)
    rows = "".join(
        f"    [BRACE_{frame.name.upper()}] = "
        f"{{BRACE_REQUEST_{request.name.upper()}, {part}, {len(request.answers)}}},\n"
        for request in wire.requests for part, frame in enumerate(request.answers)
    )
    return {
        "can_process": _source(
            wire.process_frames, after="".join(_part_source(message) for message in wire.multiplexed)
        ),
        "can_questions": _source([request.question for request in wire.requests]),
        "can_answers": _source(
            [*(frame for request in wire.requests for frame in request.answers), wire.refusal],
            f"const uint8_t brace_can_answer_parts[{CODES}] = {{\n{counts}}};\n\n"
            f"const brace_can_answer_frame_t brace_can_answer_frames[{CODES}] = {{\n{rows}}};\n",
        ),
    }


def _source(frames: Sequence[Frame], before: str = "", after: str = "") -> str:
    codecs = [text for frame in frames for text in ("\n", _pack(frame), "\n", _unpack(frame))]
    head = f'{_MADE}#include "brace/can_messages.h"\n\n#include "can_bits.h"\n'
    return "".join([head, "\n" if before else "", before, *codecs, after])


def _struct(frame: Frame) -> str:
    lines = [c_comment(frame.description) if frame.command is None else "", "typedef struct {\n"]
    if frame.command is not None:
        lines.append("    uint32_t token;\n")
    for signal in frame.signals:
        unit = ""
        if signal.kind == "value":
            unit = f" [{signal.unit}, {signal.least * signal.step:g} to {signal.greatest * signal.step:g}]"
        lines.append(c_comment(signal.description + unit, "    ") + f"    {c_type(signal)} {signal.member};\n")
    return "".join(lines) + f"}} brace_can_{frame.name}_t;\n" + ("" if frame.command is not None else _limits(frame))


def _limits(frame: Frame) -> str:
    """The greatest value that each signal of a message can carry."""
    most = {most_of(frame, s): float(f"{s.greatest * s.step:.9g}") for s in frame.signals if s.kind == "value"}
    return "".join(f"#define {name} {value!r}f\n" for name, value in most.items())


def most_of(frame: Frame, signal: Signal) -> str:
    """The C name of the greatest value that a message's signal can carry."""
    return f"BRACE_CAN_{frame.name.upper()}_{signal.member.upper()}_MOST"


def _part_of(message: Multiplexed) -> str:
    numbers = "".join(f"    {part_of(frame)} = {frame.part},\n" for frame in message.parts)
    return (
        f"\n/* Which frame of {message.name} it is: BRACE_CAN_PART_..., or a number that this list lacks. */\n"
        f"enum {{\n{numbers}}};\n"
        f"uint32_t brace_can_{message.name}_part(const uint8_t *data);\n"
    )


def part_of(frame: Frame) -> str:
    """The C name of a part's number."""
    return f"BRACE_CAN_PART_{frame.name.upper()}"


def _part_source(message: Multiplexed) -> str:
    return (
        f"\nuint32_t brace_can_{message.name}_part(const uint8_t *data)\n{{\n"
        f"    return brace_value_number(brace_bits_load(data), {_reach(message.selector)});\n}}\n"
    )


def _head(head: str, first: str, second: str) -> str:
    """A function's head, within 120 columns."""
    one_line = f"{head}({first}, {second})"
    return one_line if len(one_line) < 120 else f"{head}({first},\n    {second})"


def _pack_head(frame: Frame) -> str:
    return _head(
        f"uint32_t brace_can_pack_{frame.name}", f"const brace_can_{frame.name}_t *message",
        f"uint8_t data[{frame.bytes}]",
    )


def _unpack_head(frame: Frame) -> str:
    return _head(
        f"void brace_can_unpack_{frame.name}", f"const uint8_t data[{frame.bytes}]",
        f"brace_can_{frame.name}_t *message",
    )


def _prototypes(frame: Frame) -> str:
    return f"{_pack_head(frame)};\n{_unpack_head(frame)};\n"


def c_type(signal: Signal) -> str:
    """The type of a signal in a struct."""
    if signal.kind != "number":
        return "float"
    return "int32_t" if signal.signed else "uint32_t"


def _reach(signal: Signal) -> str:
    return f"{signal.start % FRAME_BITS}u, {signal.bits}u"


def _words(frame: Frame) -> list[tuple[str, list[Signal]]]:
    """Where each eight bytes lie, and the signals in them."""
    return [
        (f"data + {8 * word}" if word else "data", [s for s in frame.signals if s.start // FRAME_BITS == word])
        for word in range(frame.bytes * 8 // FRAME_BITS)
    ]


def _pack(frame: Frame) -> str:
    lines = [
        f"{_pack_head(frame)}\n{{\n",
        "    uint32_t limited = 0u;\n    uint64_t bits = 0u;\n",
    ]
    if frame.command is not None:
        lines.append(f"    bits = {frame.fixed}u | (uint64_t)(message->token & 0xffu) << 8;\n")
    elif frame.fixed:
        lines.append(f"    bits = {frame.fixed}u;\n")
    for number, (place, signals) in enumerate(_words(frame)):
        if number:
            lines.append("    bits = 0u;\n")
        lines += [f"    bits |= {packed(signal, f'message->{signal.member}')};\n" for signal in signals]
        lines.append(f"    brace_bits_store(bits, {place});\n")
    return "".join(lines) + "    return limited;\n}\n"


def packed(signal: Signal, value: str) -> str:
    """The signal's bits of a value."""
    if signal.kind == "value":
        whole = "signed" if signal.signed else "unsigned"
        return f"brace_bits_{whole}({value}, {_per_step(signal)}, {_reach(signal)}, &limited)"
    if signal.kind == "f32":
        return f"brace_bits_float({value}, {signal.start % FRAME_BITS}u)"
    return f"brace_bits_{'whole' if signal.signed else 'number'}({value}, {_reach(signal)}, &limited)"


def _unpack(frame: Frame) -> str:
    several = frame.bytes * 8 > FRAME_BITS
    lines = [
        f"{_unpack_head(frame)}\n{{\n",
        f"    {'' if several else 'const '}uint64_t bits = brace_bits_load(data);\n",
    ]
    if frame.command is not None:
        lines.append("    message->token = (uint32_t)(bits >> 8) & 0xffu;\n")
    elif not frame.signals:
        lines.append("    (void)bits;\n")
    for number, (place, signals) in enumerate(_words(frame)):
        if number:
            lines.append(f"    bits = brace_bits_load({place});\n")
        lines += [f"    message->{signal.member} = {unpacked(signal)};\n" for signal in signals]
    return "".join(lines) + "}\n"


def unpacked(signal: Signal) -> str:
    """The signal's value, from the bits of its frame."""
    if signal.kind == "value":
        whole = "signed" if signal.signed else "unsigned"
        return f"brace_value_{whole}(bits, {_reach(signal)}, {signal.step!r}f)"
    if signal.kind == "f32":
        return f"brace_value_float(bits, {signal.start % FRAME_BITS}u)"
    return f"brace_value_{'whole' if signal.signed else 'number'}(bits, {_reach(signal)})"


def _per_step(signal: Signal) -> str:
    per_step = 1.0 / signal.step
    rounded = round(per_step)
    return f"{float(rounded) if abs(per_step - rounded) < 1e-6 * per_step else per_step!r}f"


assert FRAME_BITS == 64  # the codecs put a frame into one uint64_t
