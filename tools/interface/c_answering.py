"""What a controller answers, each request's whole answer as one struct: can_answering.h and can_answering.c."""

from __future__ import annotations

from interface.c_messages import c_type, packed
from interface.dictionary import DictionaryError
from interface.messages import Frame, Request, Signal, Wire, saturated_constant

WHOLE = "answer"  # what saturated_by names here: all values of the answer
_MADE = "/* Written by tools/interface from messages.toml; do not edit. */\n"
_HEAD = """
/* The whole answer to each request: the fields of all its parts, and the packer that makes its frames. What the fields
 * are is said at the parts, brace_can_<name>_answer_<part>_t.
 *   parts (out): brace_can_answer_parts[code] frames of eight bytes
 * Where an answer has flags for it, they get SATURATED when a value of the answer is limited.
 * cost on a Cortex-M4F: below 120 instructions for each part. */
"""


def answering_header(wire: Wire) -> str:
    """generated/brace/can_answering.h"""
    most = max(len(request.answers) for request in wire.requests)
    parts = [
        _MADE, "#ifndef BRACE_CAN_ANSWERING_H\n#define BRACE_CAN_ANSWERING_H\n", _HEAD,
        '#include <stdint.h>\n\n#include "brace/can_messages.h"\n\n',
        f"enum {{ BRACE_CAN_ANSWER_PARTS_MOST = {most} }}; /* frames of one answer */\n",
    ]
    for request in wire.requests:
        parts += ["\n", _struct(request), f"{_head(request)};\n"]
    return "".join(parts) + "\n#endif\n"


def answering_source(wire: Wire) -> str:
    """generated/can_answering.c"""
    parts = [_MADE, '#include "brace/can_answering.h"\n\n#include "brace/status.h"\n#include "can_bits.h"\n']
    for request in wire.requests:
        parts += ["\n", _pack(request)]
    return "".join(parts)


def _struct(request: Request) -> str:
    name = f"brace_can_{request.name}_answer_t"
    if request.answers_as:
        return f"typedef brace_can_{request.answers_as}_answer_t {name};\n"
    signals = [signal for frame in request.answers for signal in frame.signals]
    if len({signal.name for signal in signals}) != len(signals):
        raise DictionaryError(f"{request.name}: two fields of its answer have one name")
    members = "".join(f"    {c_type(signal)} {signal.member};\n" for signal in signals)
    return f"typedef struct {{\n{members}}} {name};\n"


def _head(request: Request) -> str:
    name = f"brace_can_pack_{request.name}_answer"
    return f"void {name}(const brace_can_{request.name}_answer_t *answer,\n    uint32_t token, uint8_t (*parts)[8])"


def _pack(request: Request) -> str:
    lines = [f"{_head(request)}\n{{\n    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;\n",
             "    uint32_t limited = 0u;\n    uint64_t bits;\n"]
    for number, frame in enumerate(request.answers):
        lines.append(f"    bits = {frame.fixed}u | token_bits;\n")
        for signal in sorted(frame.signals, key=lambda signal: bool(signal.saturated_by)):
            lines.append(f"    bits |= {packed(signal, _value(request, frame, signal))};\n")
        lines.append(f"    brace_bits_store(bits, parts[{number}]);\n")
    return "".join(lines) + "}\n"


def _value(request: Request, frame: Frame, signal: Signal) -> str:
    """A field of the answer. Flags that tell what was limited are packed when all else has been."""
    where, member = f"{request.name}.{signal.name}", f"answer->{signal.member}"
    if not signal.saturated_by:
        return member
    if signal.saturated_by != (WHOLE,) or frame is not request.answers[-1]:
        raise DictionaryError(f"{where}: saturated_by = [{WHOLE!r}] is for flags of the last part")
    constant = saturated_constant(where, signal)
    return f"{member} | (limited > 0u ? (uint32_t){constant} : 0u)"
