"""What the controller's images weigh, as the linker left them, and what of that is the estimator."""

import json
from pathlib import Path
from typing import Any

from extra import Extra
from fetch import ROOT
from measure import object_of
from toolchain import BUILD, M4F, compiled_symbols, flash_bytes
from versions import core_sources
from weights import HOST_ONLY, NO_FPU_ONLY, WATCHING, public_functions

IMAGES = ROOT / "build" / "m4f" / "images"

NOTE = """\
The whole controller: start-up, hardware layer, application, stores and core. No heap; the stack is a part of the \
RAM. The estimator: every function of the core that the image has to know K and to use it, whatever the limb, linked \
alone: limb check, kinematics, both planar paths to K, parameter change, uncertainty, contact, slopes; without what \
watches the limb (play, drift)."""


def estimator_functions(image: Path) -> tuple[str, ...]:
    """The estimator's public functions that an image has."""
    there = compiled_symbols(image)
    return tuple(name for name in public_functions((*NO_FPU_ONLY, *HOST_ONLY, *WATCHING)) if name in there)


def _weigh(size_file: Path) -> dict[str, Any]:
    name = size_file.name.removesuffix(".size.json")
    functions = estimator_functions(size_file.with_name(name + ".elf"))
    objects = [object_of(source, M4F, ()) for source in core_sources()]
    estimator = flash_bytes(objects, functions, BUILD / "images" / f"estimator_of_{name}.elf", M4F)
    return {**json.loads(size_file.read_text()), "estimator_functions": functions, "estimator_bytes": estimator}


def extra() -> Extra:
    """The images that `./dev setup` builds; those that only tests want are left out."""
    images = [_weigh(path) for path in sorted(IMAGES.glob("*.size.json")) if "-crash-test" not in path.name]
    fields = ("flash_bytes", "flash_of_bytes", "estimator_bytes", "ram_bytes", "ram_of_bytes", "stack_bytes")
    heads = ["image", "flash [B]", "of", "estimator [B]", "RAM [B]", "of", "stack [B]"]
    rows = [[str(image["image"]), *(f"{image[field]:,}" for field in fields)] for image in images]
    return Extra("images", NOTE, [("Images", heads, rows)], [], {str(image["image"]): image for image in images})
