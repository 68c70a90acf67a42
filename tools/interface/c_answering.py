"""What a controller is asked and answers, each request and each whole answer as one struct, and their frames on CAN:
answering.h, can_asking.c and can_answering.c."""

from __future__ import annotations

from collections.abc import Sequence

from interface.c_messages import c_type, packed, unpacked
from interface.dictionary import DictionaryError
from interface.messages import Request, Signal, Wire, saturated_constant

WHOLE = "answer"  # what saturated_by names here: all values of the answer
_MADE = "/* Written by tools/interface from messages.toml; do not edit. */\n"
_HEAD = """
/* Every request of messages.toml and its whole answer, whichever wire carries them: members of 32 bits, in the order of
 * the fields of all parts. What they are is said at the frames (brace/can_messages.h): brace_can_<name>_request_t and
 * brace_can_<name>_answer_<part>_t.
 *
 * BRACE_REQUESTS(X)    X(code, name) for each of them. A controller makes its table from it, so a new request needs no
 *                      hand-written line besides the function that answers it.
 */
#include <stdint.h>

#include "brace/can_messages.h"

"""
_FRAMES = """
/* The fields of a request over CAN; all zero where the dictionary has no request of its code (data[0]). Below 120
 * instructions on a Cortex-M4F. */
void brace_can_unpack_request(const uint8_t data[8], brace_request_t *asked);

/* The frames of an answer. Where it has flags for it, they get SATURATED when one of its values is limited.
 *   code: of a request that the dictionary has
 *   parts (out): brace_can_answer_parts[code] frames of eight bytes
 * Below 120 instructions for each part. */
void brace_can_pack_answer(uint32_t code, const brace_answer_t *answer, uint32_t token, uint8_t (*parts)[8]);
"""


def answering_header(wire: Wire) -> str:
    """generated/brace/answering.h"""
    requests = wire.requests
    rows = " \\\n    ".join(f"X({_code(request)}, {request.name})" for request in requests)
    parts = [
        _MADE, "#ifndef BRACE_ANSWERING_H\n#define BRACE_ANSWERING_H\n", _HEAD,
        f"#define BRACE_REQUESTS(X) \\\n    {rows}\n\n",
        f"enum {{\n    BRACE_REQUEST_CODE_MOST = {max(request.code for request in requests)},\n"
        f"    BRACE_CAN_ANSWER_PARTS_MOST = {max(len(request.answers) for request in requests)}"
        " /* frames of one answer */\n};\n",
    ]
    for request in requests:
        parts += ["\n", _struct(request, "request", request.question.signals), _answer_struct(request)]
    parts += [_union(wire, "request", "What is asked, by the request's name, or word by word."),
              _union(wire, "answer", "What is answered, likewise."), _FRAMES]
    return "".join(parts) + "\n#endif\n"


def asking_source(wire: Wire) -> str:
    """generated/can_asking.c"""
    parts = [_MADE, '#include "brace/answering.h"\n\n#include "can_bits.h"\n',
             "\nvoid brace_can_unpack_request(const uint8_t data[8], brace_request_t *asked)\n{\n"
             "    const uint64_t bits = brace_bits_load(data);\n    *asked = (brace_request_t){.word = {0}};\n"
             "    switch (data[0]) {\n",
             *(_unpack(request) for request in wire.requests if request.question.signals),
             "    default: break;\n    }\n}\n"]
    return "".join(parts)


def answering_source(wire: Wire) -> str:
    """generated/can_answering.c"""
    parts = [_MADE, '#include "brace/answering.h"\n\n#include "brace/status.h"\n#include "can_bits.h"\n',
             *(_pack(request) for request in wire.requests if not request.answers_as),
             "\nvoid brace_can_pack_answer(uint32_t code, const brace_answer_t *answer, uint32_t token, "
             "uint8_t (*parts)[8])\n{\n    switch (code) {\n",
             *(_packing(request) for request in wire.requests),
             "    default: break;\n    }\n}\n"]
    return "".join(parts)


def answer_signals(request: Request) -> tuple[Signal, ...]:
    """The fields of all parts of an answer."""
    return tuple(signal for frame in request.answers for signal in frame.signals)


def _code(request: Request) -> str:
    return f"BRACE_REQUEST_{request.name.upper()}"


def _shape(request: Request) -> str:
    """The request that describes this one's answer."""
    return request.answers_as or request.name


def _struct(request: Request, kind: str, signals: Sequence[Signal]) -> str:
    if len({signal.name for signal in signals}) != len(signals):
        raise DictionaryError(f"{request.name}: two fields of its {kind} have one name")
    members = "".join(f"    {c_type(signal)} {signal.member};\n" for signal in signals)
    return f"typedef struct {{\n{members or '    uint32_t nothing;' + chr(10)}}} brace_{request.name}_{kind}_t;\n"


def _answer_struct(request: Request) -> str:
    if request.answers_as:
        return f"typedef brace_{request.answers_as}_answer_t brace_{request.name}_answer_t;\n"
    return _struct(request, "answer", answer_signals(request))


def _union(wire: Wire, kind: str, words: str) -> str:
    signals = [request.question.signals if kind == "request" else answer_signals(request) for request in wire.requests]
    members = "".join(f"    brace_{request.name}_{kind}_t {request.name};\n" for request in wire.requests)
    return (f"\n/* {words} */\ntypedef union {{\n{members}    uint32_t word[{max(map(len, signals))}];\n"
            f"}} brace_{kind}_t;\n")


def _unpack(request: Request) -> str:
    lines = [f"        asked->{request.name}.{signal.member} = {unpacked(signal)};\n"
             for signal in request.question.signals]
    return f"    case {_code(request)}:\n" + "".join(lines) + "        break;\n"


def _pack(request: Request) -> str:
    lines = [f"\nstatic void pack_{request.name}(const brace_{request.name}_answer_t *answer, const uint8_t *number,\n"
             "    uint32_t token, uint8_t (*parts)[8])\n{\n    const uint32_t head = (token & 0xffu) << 8;\n"
             "    uint32_t limited = 0u;\n    uint64_t bits;\n"]
    packed_last = [frame for frame in request.answers if any(signal.saturated_by for signal in frame.signals)]
    if len(packed_last) > 1:
        raise DictionaryError(f"{request.name}: flags of one part alone have saturated_by = [{WHOLE!r}]")
    for place, frame in sorted(enumerate(request.answers), key=lambda part: part[1] in packed_last):
        lines.append(f"    bits = head | number[{place}];\n")
        for signal in sorted(frame.signals, key=lambda signal: bool(signal.saturated_by)):
            lines.append(f"    bits |= {packed(signal, _value(request, signal))};\n")
        lines.append(f"    brace_bits_store(bits, parts[{place}]);\n")
    return "".join(lines) + "}\n"


def _packing(request: Request) -> str:
    """The case that packs an answer with the numbers of its own frames."""
    numbers = ", ".join(f"BRACE_{frame.name.upper()}" for frame in request.answers)
    return (f"    case {_code(request)}: {{\n        static const uint8_t number[] = {{{numbers}}};\n"
            f"        pack_{_shape(request)}(&answer->{request.name}, number, token, parts);\n        break;\n    }}\n")


def _value(request: Request, signal: Signal) -> str:
    """A field of the answer. Flags that report what was limited are packed when all else has been."""
    where, member = f"{request.name}.{signal.name}", f"answer->{signal.member}"
    if not signal.saturated_by:
        return member
    if signal.saturated_by != (WHOLE,):
        raise DictionaryError(f"{where}: saturated_by of an answer's flags is [{WHOLE!r}]")
    constant = saturated_constant(where, signal)
    return f"{member} | (limited > 0u ? (uint32_t){constant} : 0u)"
