"""Reads messages.toml into frames: signals with their place in the eight bytes."""

from __future__ import annotations

import tomllib
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from interface.dictionary import DictionaryError

FRAME_BITS = 64
_PAYLOAD_START = 16  # of requests and answers: behind command and token
_SIGNAL_KEYS = {"name", "bits", "signed", "kind", "step", "unit", "names", "bit_names", "description"}
_UNIT_SUFFIX = {"": "", "1": "_ratio", "N/mm": "_n_per_mm", "rad": "_rad", "ms": "_ms", "mm": "_mm", "N": "_n"}


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
    names: Mapping[int, str]
    bit_names: tuple[str, ...]
    description: str

    @property
    def member(self) -> str:
        """Name with its unit: k_xx_n_per_mm."""
        return self.name + _UNIT_SUFFIX[self.unit]

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
    command: int | None = None  # first byte of a request or an answer: code + 32 * part
    bytes: int = 8  # more: CAN FD

    @property
    def is_fd(self) -> bool:
        """Does classic CAN know no such frame?"""
        return self.bytes > FRAME_BITS // 8


@dataclass(frozen=True)
class Request:
    """A question and the parts of its answer."""

    code: int
    name: str
    description: str
    question: Frame
    answers: tuple[Frame, ...]


@dataclass(frozen=True)
class Wire:
    """Everything that travels over CAN."""

    protocol: int
    request_id: int
    answer_id: int
    refused_part: int
    messages: tuple[Frame, ...]
    fd_messages: tuple[Frame, ...]
    requests: tuple[Request, ...]
    refusal: Frame

    @property
    def frames(self) -> tuple[Frame, ...]:
        """All layouts, each once."""
        exchanged = [frame for request in self.requests for frame in (request.question, *request.answers)]
        return (*self.messages, *self.fd_messages, *exchanged, self.refusal)

    @property
    def schema(self) -> str:
        """Canonical list of all that two ends must agree on."""
        lines = [f"protocol {self.protocol}"]
        for frame in self.frames:
            lines.append(f"{frame.name} {frame.identifier:#x} {frame.command}")
            lines += [f" {s.name} {s.start} {s.bits} {s.signed} {s.kind} {s.step!r} {s.unit}" for s in frame.signals]
        return "\n".join(lines) + "\n"


def dictionary_hash(wire: Wire, value_schema: str) -> int:
    """CRC-32 over the canonical lists of the wire and of all values."""
    return zlib.crc32((wire.schema + value_schema).encode())


def load_wire(path: Path) -> Wire:
    """Reads and checks the file."""
    content = tomllib.loads(path.read_text())
    messages = tuple(
        Frame(
            raw["name"], raw["id"], raw.get("rate", ""), _signals(raw["signal"], 0, raw["name"]), raw["description"]
        )
        for raw in content["message"]
    )
    fd_messages = tuple(
        Frame(
            raw["name"], raw["id"], raw.get("rate", ""),
            _signals(raw["signal"], 0, raw["name"], 8 * raw["bytes"]), raw["description"], bytes=raw["bytes"],
        )
        for raw in content.get("fd_message", [])
    )
    request_id, answer_id = content["request_id"], content["answer_id"]
    requests = tuple(_request(raw, request_id, answer_id) for raw in content["request"])
    codes = [request.code for request in requests]
    if len(set(codes)) != len(codes) or not all(1 <= code <= 31 for code in codes):
        raise DictionaryError("codes of requests are different numbers of 1-31")
    refusal = Frame(
        "refusal", answer_id, "",
        _signals(
            [
                {"name": "status", "bits": 8, "signed": True,
                 "description": "why: docs/errors.md, statuses and refusals"},
                {"name": "detail", "bits": 32, "description": "what more there is to say: an index, a mode, a hash"},
            ],
            _PAYLOAD_START, "refusal",
        ),
        "a request is refused; code + 32 * part 7", content["refused_part"] * 32,
    )
    wire = Wire(
        content["protocol"], request_id, answer_id, content["refused_part"], messages, fd_messages, requests, refusal
    )
    names = [frame.name for frame in wire.frames]
    if len(set(names)) != len(names):
        raise DictionaryError("two frames have one name")
    return wire


def _request(raw: Mapping[str, Any], request_id: int, answer_id: int) -> Request:
    name, code = raw["name"], raw["code"]
    question = Frame(
        f"{name}_request", request_id, "", _signals(raw.get("field", []), _PAYLOAD_START, name), raw["description"],
        code
    )
    answers = tuple(
        Frame(
            f"{name}_answer_{part}", answer_id, "", _signals(answer["field"], _PAYLOAD_START, name),
            raw["description"], code + 32 * part,
        )
        for part, answer in enumerate(raw["answer"])
    )
    return Request(code, name, raw["description"], question, answers)


def _signals(
    raws: Sequence[Mapping[str, Any]], start: int, where: str, room: int = FRAME_BITS
) -> tuple[Signal, ...]:
    signals: list[Signal] = []
    for raw in raws:
        at = f"{where}.{raw['name']}"
        unknown = set(raw) - _SIGNAL_KEYS
        if unknown:
            raise DictionaryError(f"{at}: unknown {', '.join(sorted(unknown))}")
        kind = raw.get("kind", "number")
        names = raw.get("names", {})
        numbered = enumerate(names) if isinstance(names, list) else ((int(n), text) for n, text in names.items())
        signal = Signal(
            raw["name"], start, raw["bits"], raw.get("signed", False), kind, raw.get("step", 1.0), raw.get("unit", ""),
            dict(numbered), tuple(raw.get("bit_names", ())), raw["description"],
        )
        if kind not in ("value", "number", "f32") or (kind == "f32" and signal.bits != 32):
            raise DictionaryError(f"{at}: kind {kind} of {signal.bits} bits")
        if (kind == "value") != ("step" in raw) or signal.unit not in _UNIT_SUFFIX:
            raise DictionaryError(f"{at}: a value has a step and a known unit, nothing else has a step")
        if kind == "value" and signal.bits > 24:
            raise DictionaryError(f"{at}: a value of more than 24 bits is more than a float can tell apart")
        if start // FRAME_BITS != (start + signal.bits - 1) // FRAME_BITS and start + signal.bits <= room:
            raise DictionaryError(f"{at}: reaches over bit {(start // FRAME_BITS + 1) * FRAME_BITS}")
        signals.append(signal)
        start += signal.bits
    if start > room:
        raise DictionaryError(f"{where}: {start} bits do not go into {room}")
    return tuple(signals)
