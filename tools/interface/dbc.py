"""brace.dbc and brace_fd.dbc: the frames of node 1 as CAN databases. brace.wire.dbc moves them to other nodes."""

from __future__ import annotations

from collections.abc import Sequence

from interface.messages import FRAME_BITS, Frame, Multiplexed, Signal, Wire

_CONTROLLER, _COMPUTER = "LIMB", "ROBOT"
_NODE = 1
# The attribute's meanings, by their numbers.
_FORMATS = ("StandardCAN", "ExtendedCAN", *("reserved",) * 12, "StandardCAN_FD", "ExtendedCAN_FD")


class _Database:
    """The sections of a database, as they grow."""

    def __init__(self, what: str, dictionary_hash: int) -> None:
        self.messages: list[str] = []
        self.comments = [f'CM_ "Brace: {what}. Written from messages.toml. Dictionary 0x{dictionary_hash:08x}.";']
        self.attributes: list[str] = []
        self.values: list[str] = []
        self.floats: list[str] = []

    def add(self, frame: Frame) -> None:
        """A message that is one frame."""
        self._add(frame.identifier, frame.name, frame.description, frame.bytes,
                  [(signal, signal.name, "") for signal in frame.signals])

    def add_parts(self, message: Multiplexed) -> None:
        """A message whose frames share an identifier: signals are called <group>_<signal>."""
        signals = [(signal, signal.name, "M " if signal is message.selector else "") for signal in message.common]
        signals += [
            (signal, f"{group.name.removesuffix('_fd')}_{signal.name}", f"m{part.part} ")
            for group in message.groups for part in group.parts for signal in message.own(part)
        ]
        self._add(message.identifier, message.name, message.description, message.bytes, signals)
        meanings = " ".join(f'{part.part} "{part.name.upper()}"' for part in message.parts)
        self.values.append(f"VAL_ {message.identifier + _NODE} {message.selector.name} {meanings} ;")

    def add_exchange(self, name: str, identifier: int, frames: Sequence[tuple[Frame, str]], selector: str) -> None:
        """Requests, or answers: frames whose first byte says which one it is."""
        asks = name == "request"
        from_, to = (_COMPUTER, _CONTROLLER) if asks else (_CONTROLLER, _COMPUTER)
        lines = [f' SG_ {selector} M : 0|8@1+ (1,0) [0|255] "" {to}', f' SG_ token : 8|8@1+ (1,0) [0|255] "" {to}']
        meanings: list[str] = []
        for frame, stem in frames:
            meanings.append(f'{frame.command} "{stem.upper()}"')
            for signal in frame.signals:
                full = f"{stem.replace('_answer_', '_')}_{signal.name}"
                lines.append(_signal_line(signal, full, f"m{frame.command} ", to))
                self.comments.append(f'CM_ SG_ {identifier + _NODE} {full} "{_words(signal)}";')
                self._meanings(identifier + _NODE, signal, full)
        self.messages.append(_message(identifier + _NODE, name, from_, lines))
        self.values.append(f"VAL_ {identifier + _NODE} {selector} {' '.join(meanings)} ;")

    def _add(
        self, identifier: int, name: str, words: str, size: int, signals: Sequence[tuple[Signal, str, str]]
    ) -> None:
        identifier += _NODE
        lines = [_signal_line(signal, called, how, _COMPUTER) for signal, called, how in signals]
        self.messages.append(_message(identifier, name, _CONTROLLER, lines, size))
        self.comments.append(f'CM_ BO_ {identifier} "{words}";')
        if size > FRAME_BITS // 8:
            self.attributes.append(f'BA_ "VFrameFormat" BO_ {identifier} {_FORMATS.index("StandardCAN_FD")};')
            self.attributes.append(f'BA_ "CANFD_BRS" BO_ {identifier} 1;')
        for signal, called, _ in signals:
            self.comments.append(f'CM_ SG_ {identifier} {called} "{_words(signal)}";')
            self._meanings(identifier, signal, called)

    def _meanings(self, identifier: int, signal: Signal, called: str) -> None:
        self.values += _value_table(identifier, signal, called)
        if signal.kind == "f32":
            self.floats.append(f"SIG_VALTYPE_ {identifier} {called} : 1;")

    def text(self, definitions: Sequence[str] = ()) -> str:
        """The whole file."""
        head = f'VERSION ""\n\nNS_ :\n\nBS_:\n\nBU_: {_CONTROLLER} {_COMPUTER}\n'
        lines = [head, *self.messages, *self.comments, *definitions, *self.attributes, *self.values, *self.floats]
        return "\n".join(lines) + "\n"


def dbc(wire: Wire, dictionary_hash: int) -> str:
    """Text of the database."""
    database = _Database("stiffness on the limb", dictionary_hash)
    for frame in wire.messages:
        database.add(frame)
    for message in wire.classic:
        database.add_parts(message)
    requests = [(request.question, request.name) for request in wire.requests]
    answers = [(frame, frame.name) for request in wire.requests for frame in request.answers]
    database.add_exchange("request", wire.request_id, requests, "code")
    database.add_exchange("answer", wire.answer_id, [*answers, (wire.refusal, "refused")], "number")
    codes = " ".join(f'{request.code} "{request.name.upper()}"' for request in wire.requests)
    database.values.append(f"VAL_ {wire.answer_id + _NODE} refused_code {codes} ;")
    return database.text()


def dbc_fd(wire: Wire, dictionary_hash: int) -> str:
    """Text of the database of CAN FD frames alone; read it beside brace.dbc."""
    database = _Database("stiffness on the limb, CAN FD", dictionary_hash)
    for frame in wire.fd_messages:
        database.add(frame)
    for message in wire.fd:
        database.add_parts(message)
    formats = ",".join(f'"{name}"' for name in _FORMATS)
    return database.text([
        'BA_DEF_ "BusType" STRING ;', f'BA_DEF_ BO_ "VFrameFormat" ENUM {formats};',
        'BA_DEF_ BO_ "CANFD_BRS" ENUM "0","1";',
        'BA_DEF_DEF_ "BusType" "CAN FD";', 'BA_DEF_DEF_ "VFrameFormat" "StandardCAN";', 'BA_DEF_DEF_ "CANFD_BRS" "1";',
        'BA_ "BusType" "CAN FD";',
    ])


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
