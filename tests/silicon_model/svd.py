"""Registers of a chip as its SVD file describes them: addresses, offsets, field masks, interrupt numbers."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Register:
    offset: int
    fields: dict[str, int] = field(default_factory=dict)  # name -> mask


@dataclass
class Peripheral:
    base: int
    registers: dict[str, Register]


@dataclass
class Chip:
    peripherals: dict[str, Peripheral]
    interrupts: dict[str, int]


def _text(node: ElementTree.Element, tag: str) -> str:
    found = node.findtext(tag)
    assert found is not None, f"{tag} is missing"
    return found.strip()


def _number(text: str) -> int:
    return int(text, 0)


def _fields(node: ElementTree.Element) -> dict[str, int]:
    masks = {}
    for item in node.iter("field"):
        width = _number(_text(item, "bitWidth"))
        masks[_text(item, "name")] = ((1 << width) - 1) << _number(_text(item, "bitOffset"))
    whole: dict[str, int] = {}
    for name, mask in masks.items():  # PLLN0, PLLN1, ...: the bits of one field
        if numbered := re.fullmatch(r"(\w+?)\d+", name):
            whole[numbered[1]] = whole.get(numbered[1], 0) | mask
    return whole | masks


def read(path: Path) -> Chip:
    root = ElementTree.parse(path).getroot()
    nodes = {_text(node, "name"): node for node in root.iter("peripheral")}
    peripherals: dict[str, Peripheral] = {}
    interrupts: dict[str, int] = {}
    for name, node in nodes.items():
        template = nodes[node.get("derivedFrom", name)]
        registers = {
            _text(item, "name"): Register(_number(_text(item, "addressOffset")), _fields(item))
            for item in template.iter("register")
        }
        peripherals[name] = Peripheral(_number(_text(node, "baseAddress")), registers)
        for item in node.iter("interrupt"):
            interrupts[_text(item, "name")] = _number(_text(item, "value"))
    return Chip(peripherals, interrupts)
