"""Reads messages.toml into frames: signals with their place in the eight bytes."""

from __future__ import annotations

import re
import tomllib
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from interface.codes import Codes, Table
from interface.dictionary import DictionaryError, check_keys
from interface.units import UNIT_SUFFIX, unit_fault

FRAME_BITS = 64
_PAYLOAD_START = 16  # of requests and answers: behind code or number, and token
CODES = 256  # of requests, and numbers of answers
REFUSED = CODES - 1  # the number of an answer that is a refusal
# What each table must have, and what it may have.
_KEYS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "signal": (("name", "bits", "description"),
               ("signed", "kind", "step", "unit", "names", "bit_names", "from", "wraps", "saturated_by",
                "unknown_beyond")),
    "message": (("name", "id", "description", "signal"), ("rate", "by_hand")),
    "fd_message": (("name", "id", "bytes", "description", "signal"), ("rate", "by_hand")),
    "multiplexed": (("name", "id", "description", "signal", "group"), ("bytes",)),
    "group": (("name", "description", "part"), ("rate", "by_hand", "coxa")),
    "part": (("number", "signal"), ()),
    "request": (("code", "name", "description"), ("field", "answer", "answers_as", "answer_numbers")),
    "answer": (("number", "field"), ()),
}  # fmt: skip
_TYPES = {  # of the values of these keys, in any table
    "a text": ("name", "description", "rate", "kind", "unit", "names", "bit_names", "from"),
    "a whole number": ("bits", "id", "bytes", "number", "code"),
    "a number": ("step",),
    "true or false": ("signed", "wraps", "unknown_beyond", "by_hand", "coxa"),
}
_TYPE_OF = {key: word for word, keys in _TYPES.items() for key in keys}
_NAME = re.compile(r"[a-z][a-z0-9_]*")  # of C, of Python and of the databases
NODES = 0x80  # identifiers of one message: one for each node, and 0
BASIC_IDS = 0x800  # of 11 bits
_SATURATED = "SATURATED"  # the bit of flags: a value was limited
SEQUENCE = "sequence"  # the signal of a frame of measured values that is the same in all frames of one snapshot
SEQUENCE_BITS, WORD_BITS = 8, 32  # at least, where it wraps; as the controller counts
PART = "part"  # the common signal of a multiplexed message that says which part a frame carries


@dataclass(frozen=True)
class Signal:
    """A run of bits in a frame, least significant first."""

    name: str
    start: int
    bits: int
    signed: bool
    kind: str  # value, number, f32
    step: float  # of a value; 1 for a number
    unit: str
    codes: Table | None  # what the number or its bits mean
    description: str
    source: str = ""  # of process data: the measured value that it carries
    wraps: bool = False  # of a source that is too large the low bits are sent, instead of the greatest number
    saturated_by: tuple[str, ...] = ()  # of flags: the frames whose limited values set SATURATED
    unknown_beyond: bool = False  # a value that is too large is sent as not known

    @property
    def names(self) -> Mapping[int, str]:
        """The number's meanings; empty: it has none, or they are its bits'."""
        if self.codes is None or self.codes.is_bits:
            return {}
        return self.codes.names if self.signed else self.codes.unsigned_names

    @property
    def bit_names(self) -> tuple[str, ...]:
        """The names of the bits, from bit 0 on; empty: they have none."""
        return tuple(code.name for code in self.codes.codes) if self.codes is not None and self.codes.is_bits else ()

    @property
    def member(self) -> str:
        """Name with its unit: k_xx_n_per_mm."""
        return self.name + UNIT_SUFFIX[self.unit]

    @property
    def least(self) -> int:
        """Smallest code that is a value."""
        if not self.signed:
            return 0
        return -(1 << (self.bits - 1)) + (1 if self.kind == "value" else 0)

    @property
    def greatest(self) -> int:
        """Largest code that is a value."""
        if self.signed:
            return (1 << (self.bits - 1)) - 1
        return (1 << self.bits) - (2 if self.kind == "value" else 1)

    @property
    def invalid(self) -> int | None:
        """The code of 'not known'."""
        if self.kind != "value":
            return None
        return -(1 << (self.bits - 1)) if self.signed else (1 << self.bits) - 1


@dataclass(frozen=True)
class Frame:
    """One layout of the eight bytes."""

    name: str  # stiffness_a; for requests and answers k_at_posture_request, k_at_posture_answer_0
    identifier: int  # of node 0
    rate: str  # key of limb.toml, or ""
    signals: tuple[Signal, ...]
    description: str
    command: int | None = None  # first byte: the code of a request, the number of an answer
    bytes: int = 8  # more: CAN FD
    part: int | None = None  # of a multiplexed message
    part_at: int = 0  # the first bit of the part's number
    by_hand: bool = False  # hand-written code fills or sends it
    needs_coxa: bool = False  # only a limb whose coxa joint is fitted sends it

    @property
    def is_measured(self) -> bool:
        """Is it filled from measured values, at its rate?"""
        return self.rate != "" and not self.by_hand

    @property
    def fixed(self) -> int:
        """The bits that every frame of this layout has."""
        return (self.command or 0) | (self.part or 0) << self.part_at

    @property
    def is_fd(self) -> bool:
        """Does classic CAN know no such frame?"""
        return self.bytes > FRAME_BITS // 8


@dataclass(frozen=True)
class Group:
    """Frames of one identifier that belong together."""

    name: str
    rate: str
    description: str
    parts: tuple[Frame, ...]  # the common signals but the part's number, then their own


@dataclass(frozen=True)
class Multiplexed:
    """One identifier for many frames, each with a number of its own."""

    name: str
    identifier: int  # of node 0
    bytes: int
    description: str
    common: tuple[Signal, ...]  # in every part, the part's number too
    groups: tuple[Group, ...]

    @property
    def parts(self) -> tuple[Frame, ...]:
        """The frames of all groups."""
        return tuple(frame for group in self.groups for frame in group.parts)

    @property
    def is_fd(self) -> bool:
        """Does classic CAN know no such frames?"""
        return self.bytes > FRAME_BITS // 8

    def own(self, frame: Frame) -> tuple[Signal, ...]:
        """The signals of a part that not every part has."""
        return tuple(signal for signal in frame.signals if signal not in self.common)

    @property
    def selector(self) -> Signal:
        """The signal that says which part a frame carries."""
        return next(signal for signal in self.common if signal.name == PART)


@dataclass(frozen=True)
class Request:
    """A question and the parts of its answer."""

    code: int
    name: str
    description: str
    question: Frame
    answers: tuple[Frame, ...]
    answers_as: str = ""  # the request whose answer has the same fields


@dataclass(frozen=True)
class Wire:
    """Everything that travels over CAN."""

    protocol: int
    request_id: int
    answer_id: int
    messages: tuple[Frame, ...]
    multiplexed: tuple[Multiplexed, ...]
    fd_messages: tuple[Frame, ...]
    requests: tuple[Request, ...]
    refusal: Frame

    @property
    def frames(self) -> tuple[Frame, ...]:
        """All layouts, each once."""
        exchanged = [frame for request in self.requests for frame in (request.question, *request.answers)]
        return (*self.process_frames, *exchanged, self.refusal)

    @property
    def classic(self) -> tuple[Multiplexed, ...]:
        """The identifiers of many frames, without those of CAN FD."""
        return tuple(message for message in self.multiplexed if not message.is_fd)

    @property
    def fd(self) -> tuple[Multiplexed, ...]:
        """The identifiers of many frames of CAN FD."""
        return tuple(message for message in self.multiplexed if message.is_fd)

    @property
    def process(self) -> tuple[Frame | Multiplexed, ...]:
        """What a controller sends by itself."""
        return (*self.messages, *self.multiplexed, *self.fd_messages)

    @property
    def process_frames(self) -> tuple[Frame, ...]:
        """The frames of `process`: each part of a multiplexed message stands by itself."""
        classic, fd = ([part for message in some for part in message.parts] for some in (self.classic, self.fd))
        return (*self.messages, *classic, *self.fd_messages, *fd)

    @property
    def schema(self) -> str:
        """Canonical list of all that two ends must agree on."""
        lines = [f"protocol {self.protocol}"]
        for frame in self.frames:
            part = "" if frame.part is None else f" part {frame.part} at {frame.part_at}"
            lines.append(f"{frame.name} {frame.identifier:#x} {frame.command}{part}")
            lines += [f" {s.name} {s.start} {s.bits} {s.signed} {s.kind} {s.step!r} {s.unit}" for s in frame.signals]
        return "\n".join(lines) + "\n"


def saturated_constant(where: str, flags: Signal) -> str:
    """The C constant of the bit that says that a value was limited."""
    bits = flags.codes.codes if flags.codes is not None and flags.codes.is_bits else ()
    constants = [code.constant for code in bits if code.name == _SATURATED]
    if not constants:
        raise DictionaryError(f"{where}: saturated_by is for bits that have {_SATURATED}")
    return constants[0]


def dictionary_hash(wire: Wire, value_schema: str) -> int:
    """CRC-32 over the canonical lists of the wire and of all values."""
    return zlib.crc32((wire.schema + value_schema).encode())


def load_wire(path: Path, codes: Codes) -> Wire:
    """Reads and checks the file."""
    content = tomllib.loads(path.read_text())
    _check_tables(content)
    messages = tuple(
        Frame(
            raw["name"],
            raw["id"],
            raw.get("rate", ""),
            _signals(raw["signal"], 0, raw["name"], codes),
            raw["description"],
            by_hand=raw.get("by_hand", False),
        )
        for raw in content["message"]
    )
    fd_messages = tuple(
        Frame(
            raw["name"],
            raw["id"],
            raw.get("rate", ""),
            _signals(raw["signal"], 0, raw["name"], codes, 8 * raw["bytes"]),
            raw["description"],
            bytes=raw["bytes"],
        )
        for raw in content.get("fd_message", [])
    )
    multiplexed = tuple(_multiplexed(raw, codes) for raw in content.get("multiplexed", []))
    request_id, answer_id = content["request_id"], content["answer_id"]
    answers = {raw["name"]: raw["answer"] for raw in content["request"] if "answer" in raw}
    requests = tuple(_request(raw, answers, request_id, answer_id, codes) for raw in content["request"])
    refusal = Frame(
        "refusal",
        answer_id,
        "",
        _signals(
            [
                {"name": "code", "bits": 8, "description": "the code of the request"},
                {
                    "name": "status",
                    "bits": 8,
                    "signed": True,
                    "description": "why: docs/errors.md, statuses and refusals",
                },
                {"name": "detail", "bits": 32, "description": "what more there is to say: an index, a mode, a hash"},
            ],
            _PAYLOAD_START,
            "refusal",
            codes,
        ),
        "a request is refused",
        REFUSED,
    )
    wire = Wire(content["protocol"], request_id, answer_id, messages, multiplexed, fd_messages, requests, refusal)
    names = [frame.name for frame in wire.frames]
    if len(set(names)) != len(names):
        twice = next(name for place, name in enumerate(names) if name in names[:place])
        raise DictionaryError(f"{twice}: two frames have this name; give one of them another")
    _refuse_numbers("codes of requests", [(request.code, request.name) for request in requests], 1, CODES)
    _refuse_numbers(
        "numbers of answers",
        [(frame.command or 0, frame.name) for request in requests for frame in request.answers],
        1,
        REFUSED,
    )
    _refuse_fd_alone(multiplexed)
    for message in multiplexed:
        _refuse_numbers(
            f"numbers of the parts of {message.name}",
            [(frame.part or 0, frame.name) for frame in message.parts],
            0,
            1 << message.selector.bits,
        )
        _refuse_twice_in_dbc(message)
    for frame in wire.process_frames:
        _refuse_process(frame)
    _refuse_identifiers(wire)
    return wire


def _check_tables(content: Mapping[str, Any]) -> None:
    """No table lacks a key, and none has one that nobody reads."""

    def check(kind: str, raw: Mapping[str, Any], where: str) -> None:
        check_keys(raw, *_KEYS[kind], where)
        _refuse_wrong_types(raw, where)
        _refuse_name(raw.get("name"), where)

    for kind in ("message", "fd_message", "multiplexed", "request"):
        for raw in content.get(kind, []):
            where = f"{kind} {raw.get('name')}"
            check(kind, raw, where)
            for group in raw.get("group", []):
                check("group", group, f"{where}, group {group.get('name')}")
                for part in group["part"]:
                    check("part", part, f"{where}, group {group['name']}, part {part.get('number')}")
            for answer in raw.get("answer", []):
                check("answer", answer, f"{where}, answer {answer.get('number')}")


def _refuse_wrong_types(raw: Mapping[str, Any], where: str) -> None:
    """A text where a number belongs, or a number where true or false does."""
    words = {str: ("a text",), bool: ("true or false",), int: ("a whole number", "a number"), float: ("a number",)}
    for key, value in raw.items():
        if key in _TYPE_OF and _TYPE_OF[key] not in words.get(type(value), ()):
            raise DictionaryError(f"{where}: {key} = {value!r} is not {_TYPE_OF[key]}")


def _refuse_name(name: str | None, where: str) -> None:
    """A name that is none in C."""
    if name is not None and not _NAME.fullmatch(name):
        raise DictionaryError(f"{where}: a name begins with a small letter, and has small letters, digits and _ only")


def _refuse_no_sign(signal: Signal, where: str) -> None:
    """A value that may be below 0, and would be limited to 0."""
    if signal.kind == "value" and signal.unit == "degC" and not signal.signed:
        raise DictionaryError(
            f"{where}: a temperature in degC may be below 0 and would be sent as 0; write signed = true"
        )


def _refuse_process(frame: Frame) -> None:
    """What goes out at a rate: the rate is the controller's, and receivers put frames of one snapshot together."""
    if frame.rate and not frame.rate.startswith("controller."):
        raise DictionaryError(f"{frame.name}: its rate is a key of limb.toml's table [controller], not {frame.rate!r}")
    sequences = [signal for signal in frame.signals if signal.name == SEQUENCE]
    if frame.is_measured and not sequences:
        raise DictionaryError(
            f"{frame.name}: what goes out at a rate has the signal {SEQUENCE!r}, by which receivers "
            "put the frames of one snapshot together"
        )
    for signal in sequences:
        is_whole = signal.bits == WORD_BITS or (signal.bits >= SEQUENCE_BITS and signal.wraps)
        if signal.kind != "number" or signal.signed or (frame.is_measured and not is_whole):
            raise DictionaryError(
                f"{frame.name}.{SEQUENCE}: it is an unsigned number, of {WORD_BITS} bits or of at "
                f"least {SEQUENCE_BITS} with wraps = true: else it would stand still at its greatest"
            )
    if not frame.rate and not frame.by_hand:
        raise DictionaryError(f"{frame.name}: it has neither a rate nor by_hand = true, so nobody would send it")


HEARTBEAT_RATE = "controller.heartbeat_hz"


def check_rates(wire: Wire, keys: Mapping[str, str]) -> None:
    """Each rate is a parameter in Hz; the heartbeat's is for what is sent by hand. keys: the unit of each parameter."""
    rates = sorted(key for key, unit in keys.items() if unit == "Hz" and key != HEARTBEAT_RATE)
    for frame in wire.process_frames:
        if frame.rate and frame.rate not in rates and not (frame.by_hand and frame.rate == HEARTBEAT_RATE):
            listed = ", ".join(rates)
            raise DictionaryError(f"{frame.name}: {frame.rate} is no rate of process data; rates are {listed}")


def _refuse_numbers(what: str, numbered: Sequence[tuple[int, str]], least: int, below: int) -> None:
    """Two frames with one number, or a number that the byte does not hold."""
    used: dict[int, str] = {}
    free = next((number for number in range(least, below) if number not in dict(numbered)), None)
    for number, name in numbered:
        where = f"{name}: {number} "
        if not least <= number < below:
            raise DictionaryError(f"{where}does not fit: {what} are {least} to {below - 1}")
        if number in used:
            raise DictionaryError(f"{where}is that of {used[number]}; {what}: the first that is free is {free}")
        used[number] = name


def _refuse_twice_in_dbc(message: Multiplexed) -> None:
    """Two signals that the database of CAN frames would call by one name."""
    used: dict[str, str] = {}
    for group in message.groups:
        for frame in group.parts:
            for signal in message.own(frame):
                name = f"{group.name}_{signal.name}"
                if name in used:
                    raise DictionaryError(
                        f"{frame.name}.{signal.name}: the database calls it {name}, as it does that of {used[name]}"
                    )
                used[name] = frame.name


def _refuse_fd_alone(multiplexed: Sequence[Multiplexed]) -> None:
    """A group of CAN FD that is not one of classic CAN once more: whoever has classic CAN would never get it."""
    classic = [message for message in multiplexed if not message.is_fd]
    names = {f"{group.name}_fd" for message in classic for group in message.groups}
    for message in multiplexed:
        for group in message.groups:
            if message.is_fd and group.name not in names:
                whole = group.name.removesuffix("_fd")
                raise DictionaryError(
                    f"{group.name}: it stands in {message.name}, which is CAN FD alone; put the group "
                    f"{whole} into {' or '.join(one.name for one in classic)}, and call it {whole}_fd "
                    "here, if it is to stand here too"
                )


def _refuse_identifiers(wire: Wire) -> None:
    """Two messages with one identifier, or one to which no node number can be added."""
    used = {wire.request_id: "the requests", wire.answer_id: "the answers"}
    taken = {*used, *(message.identifier for message in wire.process)}
    free = ", ".join(f"0x{one:03x}" for one in range(NODES, BASIC_IDS, NODES) if one not in taken)
    for message in wire.process:
        where = f"{message.name}: its identifier 0x{message.identifier:03x}"
        if message.identifier % NODES:
            raise DictionaryError(f"{where} is no multiple of 0x80, to which a controller adds its node number")
        if not 0 <= message.identifier < BASIC_IDS:
            raise DictionaryError(f"{where} is more than the 11 bits of a frame; free identifiers: {free or 'none'}")
        if message.identifier in used:
            raise DictionaryError(f"{where} is that of {used[message.identifier]}; free identifiers: {free or 'none'}")
        used[message.identifier] = message.name


def _multiplexed(raw: Mapping[str, Any], codes: Codes) -> Multiplexed:
    name, size = raw["name"], raw.get("bytes", FRAME_BITS // 8)
    common = _signals(raw["signal"], 0, name, codes)
    selectors = [signal for signal in common if signal.name == PART]
    if len(selectors) != 1 or selectors[0].kind != "number" or selectors[0].bits > 8:
        raise DictionaryError(f"{name}: it has one signal named {PART!r}, a number of at most 8 bits")
    start = sum(signal.bits for signal in common)
    shared = tuple(signal for signal in common if signal.name != PART)

    def part(group: Mapping[str, Any], place: int, one: Mapping[str, Any]) -> Frame:
        several = len(group["part"]) > 1
        called = f"{group['name']}_{place}" if several else group["name"]
        own = _signals(one["signal"], start, called, codes, 8 * size)
        for signal in own:
            if signal.name in {other.name for other in common}:
                raise DictionaryError(
                    f"{called}.{signal.name}: every frame of {name} has a signal of this name already; "
                    "leave it out, or give it another name"
                )
        return Frame(
            called,
            raw["id"],
            group.get("rate", ""),
            (*shared, *own),
            group["description"] + (f": frame {place + 1} of {len(group['part'])}" if several else ""),
            bytes=size,
            part=one["number"],
            part_at=selectors[0].start,
            by_hand=group.get("by_hand", False),
            needs_coxa=group.get("coxa", False),
        )

    groups = tuple(
        Group(
            group["name"],
            group.get("rate", ""),
            group["description"],
            tuple(part(group, place, one) for place, one in enumerate(group["part"])),
        )
        for group in raw["group"]
    )
    names = [group.name for group in groups]
    for place, group_name in enumerate(names):
        if group_name in names[:place]:
            raise DictionaryError(f"{group_name}: two groups of {name} have this name; give one of them another")
    return Multiplexed(name, raw["id"], size, raw["description"], common, groups)


def _request(
    raw: Mapping[str, Any],
    answers_of: Mapping[str, Sequence[Mapping[str, Any]]],
    request_id: int,
    answer_id: int,
    codes: Codes,
) -> Request:
    name, code, answers_as = raw["name"], raw["code"], raw.get("answers_as", "")
    if ("answer" in raw) == bool(answers_as) or (answers_as or name) not in answers_of:
        raise DictionaryError(f"{name}: a request has either [[request.answer]] or answers_as a request that has them")
    parts = answers_of[answers_as or name]
    numbers = raw.get("answer_numbers", []) if answers_as else [part["number"] for part in parts]
    if len(numbers) != len(parts) or (not answers_as and "answer_numbers" in raw):
        raise DictionaryError(
            f"{name}: with answers_as a request has answer_numbers, one for each of the "
            f"{len(parts)} frames of its answer"
        )
    question = Frame(
        f"{name}_request",
        request_id,
        "",
        _signals(raw.get("field", []), _PAYLOAD_START, name, codes),
        raw["description"],
        code,
    )
    answers = tuple(
        Frame(
            f"{name}_answer_{part}",
            answer_id,
            "",
            _signals(answer["field"], _PAYLOAD_START, name, codes),
            raw["description"],
            number,
        )
        for part, (number, answer) in enumerate(zip(numbers, parts, strict=True))
    )
    return Request(code, name, raw["description"], question, answers, answers_as)


def _signals(
    raws: Sequence[Mapping[str, Any]], start: int, where: str, codes: Codes, room: int = FRAME_BITS
) -> tuple[Signal, ...]:
    signals: list[Signal] = []
    first = start
    for raw in raws:
        at = f"{where}.{raw.get('name')}"
        check_keys(raw, *_KEYS["signal"], at)
        _refuse_wrong_types(raw, at)
        _refuse_name(raw["name"], at)
        kind = raw.get("kind", "number")
        table = (
            codes.enum(raw["names"], at)
            if "names" in raw
            else codes.bits(raw["bit_names"], at)
            if "bit_names" in raw
            else None
        )
        signal = Signal(
            raw["name"],
            start,
            raw["bits"],
            raw.get("signed", False),
            kind,
            raw.get("step", 1.0),
            raw.get("unit", ""),
            table,
            raw["description"].replace("{emergencies}", codes.emergencies),
            raw.get("from", raw["name"]),
            raw.get("wraps", False),
            tuple(raw.get("saturated_by", [])),
            raw.get("unknown_beyond", False),
        )
        if kind not in ("value", "number", "f32") or (kind == "f32" and signal.bits != 32):
            raise DictionaryError(f"{at}: kind {kind} of {signal.bits} bits")
        if (kind == "value") != ("step" in raw):
            raise DictionaryError(f"{at}: a value has a step, and nothing else has one")
        if signal.bits < 1 or not 0.0 < signal.step < float("inf"):
            raise DictionaryError(f"{at}: bits and step are above 0")
        if any(signal.name == other.name for other in signals):
            raise DictionaryError(f"{at} stands there twice; give one of them another name")
        if fault := unit_fault(signal.unit):
            raise DictionaryError(f"{at}: {fault}")
        _refuse_no_sign(signal, at)
        if table is not None and max(signal.names, default=len(signal.bit_names) - 1) > (
            signal.greatest if signal.names else signal.bits - 1
        ):
            raise DictionaryError(f"{at}: {signal.bits} bits do not hold every value of {table.name}")
        if kind == "value" and signal.bits > 24:
            raise DictionaryError(f"{at}: a value of more than 24 bits is more than a float can distinguish")
        if start // FRAME_BITS != (start + signal.bits - 1) // FRAME_BITS and start + signal.bits <= room:
            raise DictionaryError(f"{at}: reaches over bit {(start // FRAME_BITS + 1) * FRAME_BITS}")
        signals.append(signal)
        start += signal.bits
    if start > room:
        raise DictionaryError(f"{where}: its signals have {start - first} bits, its frame has room for {room - first}")
    return tuple(signals)
