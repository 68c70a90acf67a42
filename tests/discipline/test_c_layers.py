"""Includes follow docs/layers.toml and have no circle; and the check sees includes that do not."""

from __future__ import annotations

from pathlib import Path

import layers
import pytest
from sources import ROOT, Finding

PARTS = ("firmware/app", "firmware/core", "firmware/interface", "firmware/store", "firmware/boards", "hal", "host_sim")


@pytest.fixture(scope="module")
def findings() -> list[Finding]:
    return layers.check()


@pytest.mark.parametrize("part", PARTS)
def test_includes_follow_the_list(findings: list[Finding], part: str) -> None:
    own = [finding for finding in findings if finding.path.is_relative_to(ROOT / part)]
    assert not own, "\n" + "\n".join(map(str, own))


def test_every_finding_belongs_to_a_part(findings: list[Finding]) -> None:
    assert all(any(finding.path.is_relative_to(ROOT / part) for part in PARTS) for finding in findings)


def test_the_list_itself_has_no_circle() -> None:
    rooms = {Path(room.name): {Path(name) for name in room.knows} for room in layers.read_rooms(layers.LIST)}
    assert all(len(group) == 1 for group in layers.strongly_connected(rooms))


SAMPLE = {
    "firmware/app/src/low/low.h": "",
    "firmware/app/src/low/low.c": '#include "low/low.h"\n',
    "firmware/app/src/high/high.h": '#include "low/low.h"\n',
    "firmware/app/src/high/high.c": '#include "high/high.h"\n',
}
SAMPLE_LIST = """
[room.low]
files = ["firmware/app/src/low"]
knows = []
[room.high]
files = ["firmware/app/src/high"]
knows = ["low"]
"""


def found_in(folder: Path, **changed: str) -> list[tuple[str, int, str]]:
    """(file, line, rule) of the findings in the sample, with files by stem and suffix replaced."""
    for name, text in SAMPLE.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(changed.get(path.name.replace(".", "_"), text))
    (folder / "layers.toml").write_text(SAMPLE_LIST)
    return [(f.path.name, f.line, f.rule) for f in layers.check(folder, folder / "layers.toml")]


def test_a_sound_sample_has_no_findings(tmp_path: Path) -> None:
    assert found_in(tmp_path) == []


def test_a_forbidden_include_is_found_at_its_line(tmp_path: Path) -> None:
    assert ("low.c", 2, layers.LAYER) in found_in(tmp_path, low_c='#include "low/low.h"\n#include "high/high.h"\n')


def test_a_circle_through_sources_is_found(tmp_path: Path) -> None:
    """No header includes the other here: only each source the other's header."""
    found = found_in(tmp_path, high_h="", high_c='#include "high/high.h"\n#include "low/low.h"\n',
                     low_c='#include "low/low.h"\n#include "high/high.h"\n')
    assert [rule for _, _, rule in found].count(layers.CIRCLE) == 1


def test_an_unknown_header_and_a_file_without_a_room_are_found(tmp_path: Path) -> None:
    (tmp_path / "hal").mkdir()
    (tmp_path / "hal" / "stray.h").write_text('#include "nowhere.h"\n')
    assert sorted(found_in(tmp_path)) == [("stray.h", 1, layers.LAYER), ("stray.h", 1, layers.LAYER)]


def test_a_room_cannot_know_one_that_is_not_listed(tmp_path: Path) -> None:
    listed = tmp_path / "layers.toml"
    listed.write_text('[room.low]\nfiles = ["low"]\nknows = ["nobody"]\n')
    with pytest.raises(ValueError, match="low knows nobody"):
        layers.read_rooms(listed)
