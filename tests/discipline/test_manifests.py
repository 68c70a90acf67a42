"""The manifests of packaging/: each is what its build system reads, of this version, and names files that are there."""

from __future__ import annotations

import json
import re
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

import pytest
from sources import ROOT

sys.path.insert(0, str(ROOT / "tools"))
from release import library  # noqa: E402
from release.about import about  # noqa: E402

OURS = about(ROOT)
CORE = {"src/brace_core.h", "src/brace_core.c"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("brace-core")
    library.write(ROOT, out)
    return out


def test_nothing_is_left_to_fill_in(folder: Path) -> None:
    texts = {path.relative_to(folder): path.read_text() for path in folder.rglob("*") if path.is_file()}
    manifests = {name: text for name, text in texts.items() if name.parts[0] not in ("src", "examples", "LICENSE")}
    assert len(manifests) == 9
    assert not any(re.search(r"@\w+@", text) for text in manifests.values())
    with pytest.raises(KeyError):
        library.filled_in("@nobody_knows@", OURS)


def test_each_has_the_version(folder: Path) -> None:
    properties = dict(
        line.split("=", 1) for line in (folder / "library.properties").read_text().splitlines() if "=" in line
    )
    pack = xml.parse(folder / "Brace.brace_core.pdsc").getroot()
    said = {
        "PlatformIO": json.loads((folder / "library.json").read_text())["version"],
        "Arduino": properties["version"],
        "ESP-IDF": re.search(r'^version: "(.*)"$', (folder / "idf_component.yml").read_text(), re.M)[1],
        "Conan": re.search(r'^    version = "(.*)"$', (folder / "conanfile.py").read_text(), re.M)[1],
        "CMSIS": pack.find("releases/release").get("version"),
        "CMSIS component": pack.find("components/component").get("Cversion"),
        "CMake": re.search(r"VERSION (\S+)", (folder / "CMakeLists.txt").read_text().partition("project(")[2])[1],
    }
    assert set(said.values()) == {OURS.version}, said


def test_each_names_the_same_files(folder: Path) -> None:
    assert all((folder / name).is_file() for name in CORE)
    pack = xml.parse(folder / "Brace.brace_core.pdsc").getroot()
    assert {file.get("name") for file in pack.iter("file")} == CORE
    for name in ("CMakeLists.txt", "zephyr/CMakeLists.txt"):
        named = set(re.findall(r"src/[\w.]+\.c\b", (folder / name).read_text()))
        assert named == {"src/brace_core.c"}, name
    assert json.loads((folder / "library.json").read_text())["headers"] == "brace_core.h"
    assert "includes=brace_core.h\n" in (folder / "library.properties").read_text()
