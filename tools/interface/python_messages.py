"""The Python side of the frames: tools/brace/wire/frames.py."""

from __future__ import annotations

from interface.messages import REFUSED, Frame, Group, Signal, Wire


def frames_module(wire: Wire, dictionary_hash: int) -> str:
    """One `Layout(...)` for each frame."""
    lines = [
        '"""Frames of the wire by name. Written by tools/interface from messages.toml; do not edit."""',
        "",
        "from __future__ import annotations",
        "",
        "from brace.wire import codes",
        "from brace.wire.layout import Field, Layout",
        "",
        f"DICTIONARY_HASH = 0x{dictionary_hash:08X}",
        f"PROTOCOL = {wire.protocol}",
        f"REQUEST_ID = 0x{wire.request_id:03X}",
        f"ANSWER_ID = 0x{wire.answer_id:03X}",
        f"REFUSED = {REFUSED}  # the number of an answer that is a refusal",
        "",
        "MESSAGES: dict[str, Layout] = {",
        *(line for frame in wire.messages for line in _entry(frame)),
        "}",
        "",
        "# Groups of frames that share an identifier.",
        "GROUPS: dict[str, tuple[Layout, ...]] = {",
        *(line for message in wire.classic for group in message.groups for line in _group(group)),
        "}",
        "",
        "FD_GROUPS: dict[str, tuple[Layout, ...]] = {",
        *(line for message in wire.fd for group in message.groups for line in _group(group)),
        "}",
        "",
        "FD_MESSAGES: dict[str, Layout] = {",
        *(line for frame in wire.fd_messages for line in _entry(frame)),
        "}",
        "",
        "REQUESTS: dict[str, Layout] = {",
        *(line for request in wire.requests for line in _entry(request.question, request.name)),
        "}",
        "",
        "ANSWERS: dict[str, tuple[Layout, ...]] = {",
    ]
    for request in wire.requests:
        lines.append(f'    "{request.name}": (')
        for frame in request.answers:
            lines += ["    " + line for line in _layout(frame)]
        lines.append("    ),")
    lines += ["}", "", "REFUSAL = (", *_layout(wire.refusal), ")[0]"]
    return "\n".join(lines) + "\n"


def _group(group: Group) -> list[str]:
    layouts = [f"    {line}" for frame in group.parts for line in _layout(frame)]
    return [f'    "{group.name}": (', *layouts, "    ),"]


def _entry(frame: Frame, name: str | None = None) -> list[str]:
    first, *rest = _layout(frame)
    return [f'    "{name or frame.name}": {first.strip()}', *rest]


def _layout(frame: Frame) -> list[str]:
    command = "None" if frame.command is None else str(frame.command)
    return [
        f'    Layout("{frame.name}", 0x{frame.identifier:03X}, {command}, (',
        *(f"        {_field(signal)}," for signal in frame.signals),
        f"    ){_further(frame)}),",
    ]


def _further(frame: Frame) -> str:
    size = f", {frame.bytes}" if frame.is_fd else ""
    return size if frame.part is None else f"{size}, part={frame.part}, part_at={frame.part_at}"


def _field(signal: Signal) -> str:
    parts = [f'"{signal.name}"', str(signal.start), str(signal.bits)]
    if signal.kind != "number":
        parts.append(f'kind="{signal.kind}"')
    if signal.signed:
        parts.append("signed=True")
    if signal.kind == "value":
        parts.append(f"step={signal.step!r}")
    if signal.unit:
        parts.append(f'unit="{signal.unit}"')
    if signal.codes is not None:
        parts.append(f"codes=codes.{signal.codes.name.upper()}")
    return f"Field({', '.join(parts)})"
