"""brace.dbc and brace_fd.dbc: the frames of node 1 as CAN databases. brace.wire.dbc moves them to other nodes."""

from __future__ import annotations

from collections.abc import Sequence

from interface.messages import Signal, Wire

_CONTROLLER, _COMPUTER = "LIMB", "ROBOT"
_NODE = 1
# The attribute's meanings, by their numbers.
_FORMATS = ("StandardCAN", "ExtendedCAN", *("reserved",) * 12, "StandardCAN_FD", "ExtendedCAN_FD")


def dbc(wire: Wire, dictionary_hash: int) -> str:
    """Text of the database."""
    messages: list[str] = []
    comments: list[str] = ['CM_ "Brace: stiffness on the limb. Written from messages.toml. Dictionary '
                           f'0x{dictionary_hash:08x}.";']
    values: list[str] = []
    floats: list[str] = []
    for frame in wire.messages:
        identifier = frame.identifier + _NODE
        lines = [_signal_line(signal, signal.name, "", _COMPUTER) for signal in frame.signals]
        messages.append(_message(identifier, frame.name, _CONTROLLER, lines))
        comments.append(f'CM_ BO_ {identifier} "{frame.description}";')
        for signal in frame.signals:
            comments.append(f'CM_ SG_ {identifier} {signal.name} "{_words(signal)}";')
            values += _value_table(identifier, signal, signal.name)
    for multiplexed in wire.multiplexed:
        identifier = multiplexed.identifier + _NODE
        signals = [(signal, "M " if signal is multiplexed.selector else "") for signal in multiplexed.common]
        signals += [
            (signal, f"m{part.part} ")
            for part in multiplexed.parts for signal in part.signals if signal not in multiplexed.common
        ]
        lines = [_signal_line(signal, signal.name, how, _COMPUTER) for signal, how in signals]
        messages.append(_message(identifier, multiplexed.name, _CONTROLLER, lines))
        comments.append(f'CM_ BO_ {identifier} "{multiplexed.description}";')
        for signal, _ in signals:
            comments.append(f'CM_ SG_ {identifier} {signal.name} "{_words(signal)}";')
            values += _value_table(identifier, signal, signal.name)
            if signal.kind == "f32":
                floats.append(f"SIG_VALTYPE_ {identifier} {signal.name} : 1;")
    questions = [request.question for request in wire.requests]
    answers = [frame for request in wire.requests for frame in request.answers]
    refusals = [(wire.refusal, request.code + 32 * wire.refused_part) for request in wire.requests]
    for identifier, name, from_, to, frames in (
        (wire.request_id + _NODE, "request", _COMPUTER, _CONTROLLER, [(f, f.command or 0) for f in questions]),
        (wire.answer_id + _NODE, "answer", _CONTROLLER, _COMPUTER, [(f, f.command or 0) for f in answers] + refusals),
    ):
        lines = [
            f' SG_ command M : 0|8@1+ (1,0) [0|255] "" {to}',
            f' SG_ token : 8|8@1+ (1,0) [0|255] "" {to}',
        ]
        meanings: list[str] = []
        for frame, command in frames:
            refused = frame is wire.refusal
            stem = f"refused_{command % 32}" if refused else frame.name.removesuffix("_request")
            meanings.append(f'{command} "{stem.upper()}"')
            for signal in frame.signals:
                full = f"{stem.replace('_answer_', '_')}_{signal.name}"
                lines.append(_signal_line(signal, full, f"m{command} ", to))
                values += _value_table(identifier, signal, full)
                if signal.kind == "f32":
                    floats.append(f"SIG_VALTYPE_ {identifier} {full} : 1;")
        messages.append(_message(identifier, name, from_, lines))
        values.append(f"VAL_ {identifier} command {' '.join(meanings)} ;")
    head = 'VERSION ""\n\nNS_ :\n\nBS_:\n\nBU_: ' + f"{_CONTROLLER} {_COMPUTER}" + "\n"
    return "\n".join([head, *messages, *comments, *values, *floats]) + "\n"


def dbc_fd(wire: Wire, dictionary_hash: int) -> str:
    """Text of the database of CAN FD frames alone; read it beside brace.dbc."""
    messages: list[str] = []
    comments: list[str] = [
        f'CM_ "Brace: stiffness on the limb, CAN FD. Written from messages.toml. Dictionary 0x{dictionary_hash:08x}.";'
    ]
    attributes: list[str] = []
    values: list[str] = []
    floats: list[str] = []
    for frame in wire.fd_messages:
        identifier = frame.identifier + _NODE
        lines = [_signal_line(signal, signal.name, "", _COMPUTER) for signal in frame.signals]
        messages.append(_message(identifier, frame.name, _CONTROLLER, lines, frame.bytes))
        comments.append(f'CM_ BO_ {identifier} "{frame.description}";')
        attributes.append(f'BA_ "VFrameFormat" BO_ {identifier} {_FORMATS.index("StandardCAN_FD")};')
        attributes.append(f'BA_ "CANFD_BRS" BO_ {identifier} 1;')
        for signal in frame.signals:
            comments.append(f'CM_ SG_ {identifier} {signal.name} "{_words(signal)}";')
            values += _value_table(identifier, signal, signal.name)
            if signal.kind == "f32":
                floats.append(f"SIG_VALTYPE_ {identifier} {signal.name} : 1;")
    head = 'VERSION ""\n\nNS_ :\n\nBS_:\n\nBU_: ' + f"{_CONTROLLER} {_COMPUTER}" + "\n"
    formats = ",".join(f'"{name}"' for name in _FORMATS)
    definitions = [
        'BA_DEF_ "BusType" STRING ;', f'BA_DEF_ BO_ "VFrameFormat" ENUM {formats};',
        'BA_DEF_ BO_ "CANFD_BRS" ENUM "0","1";',
        'BA_DEF_DEF_ "BusType" "CAN FD";', 'BA_DEF_DEF_ "VFrameFormat" "StandardCAN";', 'BA_DEF_DEF_ "CANFD_BRS" "1";',
        'BA_ "BusType" "CAN FD";',
    ]
    return "\n".join([head, *messages, *comments, *definitions, *attributes, *values, *floats]) + "\n"


def _message(identifier: int, name: str, sender: str, lines: Sequence[str], length: int = 8) -> str:
    return f"BO_ {identifier} {name}: {length} {sender}\n" + "\n".join(lines) + "\n"


def _signal_line(signal: Signal, name: str, multiplexed: str, receiver: str) -> str:
    sign = "-" if signal.signed or signal.kind == "f32" else "+"
    if signal.kind == "f32":
        low, high = "0", "0"
    else:
        low, high = _number(signal.least * signal.step), _number(signal.greatest * signal.step)
    return (
        f" SG_ {name} {multiplexed}: {signal.start}|{signal.bits}@1{sign} ({_number(signal.step)},0) "
        f'[{low}|{high}] "{"" if signal.unit == "1" else signal.unit}" {receiver}'
    )


def _number(value: float) -> str:
    return f"{value:.10g}"


def _words(signal: Signal) -> str:
    words = signal.description
    if signal.bit_names:
        words += "; bits from 0: " + ", ".join(signal.bit_names)
    if signal.invalid is not None:
        words += f"; {signal.invalid} steps: not known"
    return words


def _value_table(identifier: int, signal: Signal, name: str) -> list[str]:
    meanings = dict(signal.names)
    if signal.invalid is not None:
        meanings[signal.invalid] = "NOT_KNOWN"
    if not meanings:
        return []
    return [f"VAL_ {identifier} {name} " + " ".join(f'{n} "{text}"' for n, text in sorted(meanings.items())) + " ;"]
