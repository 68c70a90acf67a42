"""What the controller's images weigh, as the linker left them beside each image."""

import json

from extra import Extra
from fetch import ROOT

NOTE = """The whole controller: start-up, hardware layer, application, stores and core. No heap; the stack is a part of the RAM."""


def extra() -> Extra:
    """The images that `./dev setup` builds; those that only tests want are left out."""
    images = [json.loads(path.read_text()) for path in sorted((ROOT / "build" / "m4f" / "images").glob("*.size.json"))]
    kept = [image for image in images if not image["image"].endswith("-crash-test")]
    rows = [[image["image"], f"{image['flash_bytes']:,}", f"{image['flash_of_bytes']:,}", f"{image['ram_bytes']:,}",
             f"{image['ram_of_bytes']:,}", f"{image['stack_bytes']:,}"] for image in kept]
    return Extra("images", NOTE, [("Images", ["image", "flash [B]", "of", "RAM [B]", "of", "stack [B]"], rows)], [],
                 {image["image"]: image for image in kept})
