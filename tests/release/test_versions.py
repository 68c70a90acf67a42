"""One version everywhere, and docs/versions.md's promise: blocks of every released version load."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from blocks import FOLDER, LIMB
from targets import PROJECT

from brace import __version__
from brace.model import load_limb
from brace.params import pack, read_block
from brace.wire.names import SCHEMA_HASH

MENTIONS = {
    "firmware/core/cmake/version.cmake": r"BRACE_VERSION (\S+)\)",
    "tools/pyproject.toml": r'^version = "(\S+)"',
    "CHANGELOG.md": r"^## (\d+\.\d+\.\d+)",
}
CHANGELOG = (PROJECT / "CHANGELOG.md").read_text()


@pytest.mark.parametrize("name", MENTIONS)
def test_one_version(name: str) -> None:
    found = re.search(MENTIONS[name], (PROJECT / name).read_text(), re.MULTILINE)
    assert found and found[1] == __version__


def test_one_version_in_the_firmware() -> None:
    text = (PROJECT / "firmware/app/src/wire/version.h").read_text()
    assert re.findall(r"(?:MAJOR|MINOR|PATCH) (\d+)u$", text, re.MULTILINE) == __version__.split(".")


def test_each_version_has_its_block() -> None:
    versions = re.findall(r"^## (\d+\.\d+\.\d+)", CHANGELOG, re.MULTILINE)
    assert versions and sorted(path.stem for path in FOLDER.glob("*.bin")) == sorted(versions)


@pytest.mark.parametrize("kept", sorted(FOLDER.glob("*.bin")), ids=lambda path: path.stem)
def test_blocks_of_released_versions_load(kept: Path) -> None:
    schema = int.from_bytes(kept.read_bytes()[8:12], "little")
    if schema != SCHEMA_HASH and f"## {kept.stem}, not yet released" in CHANGELOG:
        pytest.skip(f"{kept.stem} is not released, and its list of parameters has changed: run tests/release/blocks.py")
    block = read_block(kept)
    wanted = pack(load_limb(LIMB), sequence=7)
    assert block.sequence == 7
    assert list(block.words) == list(wanted.words)
