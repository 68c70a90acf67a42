"""The frames of one or several nodes as a CAN database (DBC). tools/interface writes the database of node 1; here its
identifiers are moved to other nodes."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path

NODE_MOST = 127
FOLDER = Path(__file__).resolve().parents[1] / "data" / "can"
CLASSIC, FD = FOLDER / "brace.dbc", FOLDER / "brace_fd.dbc"

_CONTROLLER = "LIMB"
_OF_NODE = re.compile(r'(?P<kind>BO_|CM_ BO_|CM_ SG_|VAL_|SIG_VALTYPE_|BA_ "\w+" BO_) (?P<identifier>\d+)')
_NAME = re.compile(r"^(BO_ \d+ \w+)")
_SENDER = re.compile(rf"\b{_CONTROLLER}\b")


def for_nodes(template: str, nodes: Sequence[int]) -> str:
    """The database of `nodes` (1-127, each once). With several, the names of their messages and senders end in
    _<node>.
      template: the database of node 1"""
    out: list[str] = []
    for of_node, lines in groupby(_sections(template), key=lambda section: section[0]):
        texts = [text for _, text in lines]
        for node in nodes if of_node else (1,):
            suffix = f"_{node}" if of_node and len(nodes) > 1 else ""
            out += [_moved(text, node - 1, suffix) if of_node else _senders(text, nodes) for text in texts]
    return "\n".join(out) + "\n"


def _sections(template: str) -> Iterator[tuple[str, str]]:
    """Each line with what it is part of: "" for what belongs to no node, else what stands together in a database."""
    kind = ""
    for line in template.splitlines():
        found = _OF_NODE.match(line)
        if found is not None:
            kind = found["kind"].split()[0]
        elif line and not line.startswith(" "):  # a blank line and a signal belong to the message before
            kind = ""
        yield kind, line


def _moved(line: str, by: int, suffix: str) -> str:
    found = _OF_NODE.match(line)
    if found is not None:
        line = f"{found['kind']} {int(found['identifier']) + by}{line[found.end() :]}"
        if found["kind"] != "BO_":
            return line
    return _SENDER.sub(_CONTROLLER + suffix, _NAME.sub(rf"\1{suffix}", line))


def _senders(line: str, nodes: Sequence[int]) -> str:
    if not line.startswith("BU_:") or len(nodes) == 1:
        return line
    return _SENDER.sub(" ".join(f"{_CONTROLLER}_{node}" for node in nodes), line)
