"""What a sheet's cells do not show: hidden rows and merged cells. openpyxl reads neither as it streams."""

from __future__ import annotations

import io
import posixpath
import re
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from xml.etree import ElementTree

_BLOCK_BYTES = 1 << 20
_TAG_MOST_BYTES = 4096  # of a <row ...> or <mergeCell .../>
_FOUND = re.compile(rb"<(?:\w+:)?(row|mergeCell)(?:\s([^<>]*))?>")
_ATTRIBUTE = re.compile(rb'(?<![\w:])(\w+)\s*=\s*["\']([^"\']*)["\']')
_CELLS = re.compile(r"([A-Z]{1,3})(\d+):([A-Z]{1,3})(\d+)")
_RELATION = "{http://schemas.openxmlformats.org/officeDocument/2006/relationships}id"


@dataclass(frozen=True)
class Layout:
    """hidden: numbers of rows, from 1. merged: first and last row, from 1, and first column, from 0."""

    hidden: frozenset[int]
    merged: tuple[tuple[int, int, int], ...]


def layout_of(data: bytes, sheet: str) -> Layout:
    """Of one sheet of a workbook; empty where its parts are not found."""
    hidden: set[int] = set()
    merged: list[tuple[int, int, int]] = []
    row = 0
    for kind, attributes in _tags(data, sheet):
        if kind == b"row":
            row = int(attributes.get(b"r", b"") or row + 1)
            if attributes.get(b"hidden") in (b"1", b"true"):
                hidden.add(row)
        elif found := _CELLS.fullmatch(attributes.get(b"ref", b"").decode("ascii", "replace")):
            merged.append((int(found[2]), int(found[4]), _column(found[1])))
    return Layout(frozenset(hidden), tuple(merged))


def _tags(data: bytes, sheet: str) -> Iterator[tuple[bytes, dict[bytes, bytes]]]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        name = _place_of(archive, sheet)
        if not name:
            return
        with archive.open(name) as file:
            rest = b""
            while block := file.read(_BLOCK_BYTES):
                rest += block
                end = 0
                for found in _FOUND.finditer(rest):
                    yield found[1], dict(_ATTRIBUTE.findall(found[2] or b""))
                    end = found.end()
                rest = rest[max(end, len(rest) - _TAG_MOST_BYTES) :]


def _place_of(archive: zipfile.ZipFile, sheet: str) -> str:
    """The sheet's file within the workbook; empty where it is not found."""
    try:
        book = ElementTree.fromstring(archive.read("xl/workbook.xml"))
        relations = ElementTree.fromstring(archive.read("xl/_rels/workbook.xml.rels"))
    except (KeyError, ElementTree.ParseError):
        return ""
    named = (each for each in book.iter() if each.get("name") == sheet)
    wanted = next((relation for each in named if (relation := each.get(_RELATION))), "")
    target = next((each.get("Target", "") for each in relations if wanted and each.get("Id") == wanted), "")
    name = posixpath.normpath(posixpath.join("/xl", target)).lstrip("/")
    return name if target and name in archive.namelist() else ""


def _column(letters: str) -> int:
    """From 0: A is 0, AA is 26."""
    number = 0
    for letter in letters:
        number = 26 * number + ord(letter) - ord("A") + 1
    return number - 1
