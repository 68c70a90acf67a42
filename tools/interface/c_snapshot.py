"""The frames of process data from measured values: can_snapshot.h and can_snapshot.c."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from interface.c_messages import most_of
from interface.dictionary import DictionaryError
from interface.measured import Measured, Values
from interface.messages import Frame, Signal, Wire, saturated_constant

AGE = "age"  # the signal that is no measured value: who sends the frame gives it
_MADE = "/* Written by tools/interface from messages.toml; do not edit. */\n"
_HEAD = """
/* Frames of process data from the measured values of one snapshot. A signal carries the measured value that has its
 * name, or that messages.toml names.
 *   age_ms: of the snapshot's samples, at the moment when the frame is sent
 *   data (out): 8 bytes; of CAN FD 64
 * cost on a Cortex-M4F: at most 130 instructions; of CAN FD 260. */
"""


def snapshot_header(wire: Wire) -> str:
    """generated/brace/can_snapshot.h"""
    heads = "".join(f"{_make_head(frame)};\n" for frame in _frames(wire))
    return (
        f"{_MADE}#ifndef BRACE_CAN_SNAPSHOT_H\n#define BRACE_CAN_SNAPSHOT_H\n{_HEAD}"
        f'#include <stdint.h>\n\n#include "brace/measured.h"\n\n{heads}\n#endif\n'
    )


def snapshot_source(wire: Wire, values: Values) -> str:
    """generated/can_snapshot.c"""
    measured = {value.name: value for value in values.measured}
    frames = {frame.name: frame for frame in _frames(wire)}
    parts = [
        _MADE, '#include "brace/can_snapshot.h"\n\n#include <stdbool.h>\n\n',
        '#include "brace/can_messages.h"\n#include "brace/status.h"\n\n',
        "/* NaN is beyond nothing. */\nstatic bool is_beyond(float value, float most)\n{\n"
        "    return __builtin_fabsf(value) > most;\n}\n",
        "\n/* What is beyond is not known. */\nstatic float known_to(float value, float most)\n{\n"
        '    return is_beyond(value, most) ? __builtin_nanf("") : value;\n}\n',
    ]
    for frame in frames.values():
        parts += [f"\n{_flags(frame, signal, frames, measured)}" for signal in frame.signals if signal.saturated_by]
        parts.append(f"\n{_make(frame, measured)}")
    return "".join(parts)


def _frames(wire: Wire) -> Iterator[Frame]:
    return (frame for frame in wire.process_frames if frame.is_measured)


def _make_head(frame: Frame) -> str:
    return f"void brace_can_make_{frame.name}(const brace_measured_t *measured, float age_ms, uint8_t *data)"


def _make(frame: Frame, measured: Mapping[str, Measured]) -> str:
    unused = "" if any(signal.name == AGE for signal in frame.signals) else "    (void)age_ms;\n"
    members = "".join(f"        .{signal.member} = {_value(frame, signal, measured)},\n" for signal in frame.signals)
    return (
        f"{_make_head(frame)}\n{{\n{unused}    const brace_can_{frame.name}_t message = {{\n{members}    }};\n"
        f"    (void)brace_can_pack_{frame.name}(&message, data);\n}}\n"
    )


def _value(frame: Frame, signal: Signal, measured: Mapping[str, Measured]) -> str:
    """What the frame's member is set to."""
    if signal.name == AGE:
        return "age_ms"
    if signal.saturated_by:
        return f"{frame.name}_{signal.name}(measured)"
    member = _member(frame, signal, measured)
    if signal.unknown_beyond:
        return f"known_to({member}, {most_of(frame, signal)})"
    return f"{member} & {(1 << signal.bits) - 1:#x}u" if signal.wraps and signal.bits < 32 else member


def _member(frame: Frame, signal: Signal, measured: Mapping[str, Measured]) -> str:
    where, source = f"{frame.name}.{signal.name}", measured.get(signal.source)
    if source is None:
        raise DictionaryError(f"{where}: no measured value is named {signal.source!r}; name one with `from`, or give "
                              "the message `by_hand`")
    if source.unit != signal.unit or (source.type == "f32") != (signal.kind != "number"):
        raise DictionaryError(f"{where}: {source.name} is {source.type} in {source.unit!r}; write that unit here, and for "
                              "u32 no kind, as nothing converts it")
    return f"measured->{source.member}"


def _flags(frame: Frame, signal: Signal, frames: Mapping[str, Frame], measured: Mapping[str, Measured]) -> str:
    """The function that gives a frame's flags."""
    where = f"{frame.name}.{signal.name}"
    unknown = set(signal.saturated_by) - set(frames)
    if unknown:
        raise DictionaryError(f"{where}: saturated_by names frames of measured values, not {', '.join(sorted(unknown))}")
    limited = " ||\n        ".join(
        f"is_beyond({_member(other, value, measured)}, {most_of(other, value)})"
        for other in (frames[name] for name in signal.saturated_by)
        for value in other.signals if value.kind == "value" and value.name != AGE
    )
    return (
        f"static uint32_t {frame.name}_{signal.name}(const brace_measured_t *measured)\n{{\n"
        f"    const bool is_limited =\n        {limited};\n"
        f"    return {_member(frame, signal, measured)} | (is_limited ? (uint32_t){saturated_constant(where, signal)} : 0u);\n}}\n"
    )
