"""What the controller's images weigh, as the linker left them beside each image, and what of that computes K."""

import json
import re
from pathlib import Path
from typing import Any

from extra import Extra
from fetch import ROOT
from limits import at_most
from weights import WATCHING

IMAGES = ROOT / "build" / "m4f" / "images"
MEMORY_MAP = "Linker script and memory map"
# a section that was kept, its name on the same line or the one before: address, size, library(object of the source)
PLACED = re.compile(r"^ \.(?:text|rodata|data)(?:\.\S+)?\s+0x([0-9a-f]+)\s+0x([0-9a-f]+)\s+\S*libbrace_core\.a\((\w+)\.c\.\w+\)$",
                    re.MULTILINE)

NOTE = """The whole controller: start-up, hardware layer, application, stores and core. No heap; the stack is a part of the RAM. The estimator: what of it the core brings in, by the linker's map, to know K and to use it, whatever the limb: limb check, kinematics, both planar paths to K, parameter change, uncertainty, contact, slopes; without what watches the limb (play, drift)."""


def estimator_bytes(memory_map: str) -> dict[str, int]:
    """Source of the estimator -> bytes of code and constants that a linker's map shows in the image."""
    bytes_of: dict[str, int] = {}
    for address, size, source in PLACED.findall(memory_map[memory_map.index(MEMORY_MAP):]):
        if int(address, 16) and not source.startswith(WATCHING):
            bytes_of[source] = bytes_of.get(source, 0) + int(size, 16)
    return bytes_of


def _weigh(size_file: Path) -> dict[str, Any]:
    name = size_file.name.removesuffix(".size.json")
    estimator = estimator_bytes(size_file.with_name(name + ".map").read_text())
    return {**json.loads(size_file.read_text()), "estimator_bytes": sum(estimator.values())}


def extra() -> Extra:
    """The images that `./dev setup` builds; those that only tests want are left out."""
    images = [_weigh(path) for path in sorted(IMAGES.glob("*.size.json")) if "-crash-test" not in path.name]
    fields = ("flash_bytes", "flash_of_bytes", "estimator_bytes", "ram_bytes", "ram_of_bytes", "stack_bytes")
    heads = ["image", "flash [B]", "of", "estimator [B]", "RAM [B]", "of", "stack [B]"]
    rows = [[str(image["image"]), *(f"{image[field]:,}" for field in fields)] for image in images]
    most = max(image["estimator_bytes"] for image in images)
    check = at_most("flash, Cortex-M4F, the estimator as linked into the images", most, 6 * 1024, " B")
    return Extra("images", NOTE, [("Images", heads, rows)], [check], {str(image["image"]): image for image in images})
