"""The firmware images, as ./dev setup builds them, from the release's sources."""

from __future__ import annotations

import shutil
from pathlib import Path

from release.source import Source, run

KINDS = (".elf", ".hex", ".bin", ".size.json")


def images(source: Source, work: Path, dist: Path) -> None:
    """dist/firmware: each image in its forms, and SHA256SUMS, by which `brace flash` knows them."""
    build = work / "m4f"
    toolchain = source.folder / "firmware" / "boards" / "toolchain" / "cortex-m4f.cmake"
    cache = (f"-DCMAKE_TOOLCHAIN_FILE={toolchain}", "-DCMAKE_BUILD_TYPE=Release", "-DBRACE_TESTS=OFF")
    commit = f"-DBRACE_SOURCE_HASH={source.commit[:12]}"
    run("cmake", "-G", "Ninja", "-S", source.folder, "-B", build, *cache, commit, environment=source.environment)
    run("cmake", "--build", build, "--target", "brace_images", environment=source.environment)
    out = dist / "firmware"
    out.mkdir()
    for path in sorted((build / "images").iterdir()):
        if path.name == "SHA256SUMS" or path.name.endswith(KINDS):
            shutil.copy(path, out)
