"""The page of several runs: what a case leaves behind is all that the page is made of."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import foreign_report
import kept
from test_verdicts import judged, said, truth
from verdicts import Word

SEED = 7


def words(part: str) -> list[Word]:
    """A right name, a wrong one, an outsider, and a position left out."""
    about = {"part": part, "id": "f0", "group": "named", "kind": "play", "evidence": ""}
    sizes = {"joint.femur.gap_rad": 0.01}
    found = said("backlash@joint.femur")
    found["effects"][0]["parameters"] = {"joint.femur.gap_rad": {"value": 0.03, "low": 0.02, "high": 0.04}}
    return [
        judged(truth(**about), said("backlash@joint.femur")),
        judged(truth(**about, effects=[], trouble="lag"), said("joint_hardening@joint.femur")),
        judged(truth(**about, effects=[], outside="cogging"), said(verdict="unknown")),
        judged(truth(**about, left_out=sizes, size=sizes), found),
    ]


def part(name: str, seed: int = SEED) -> dict[str, Any]:
    made = {"command": "run", "seed": seed, "tool": "t", "set": "test", "seal_sha256": "s", "cases": 4, "of_plan": 9}
    return kept.part_of(words(name), words(name)[:1], made)


def test_a_row_gives_the_page_what_the_case_does() -> None:
    """All figures and tables of rows are those of the cases."""
    cases = words("joint")
    again = [kept.word_of("joint", json.loads(json.dumps(kept.row_of(w)))) for w in cases]
    assert foreign_report.figures(again, {}) == foreign_report.figures(cases, {})
    assert foreign_report.besides(again) == foreign_report.besides(cases)
    assert foreign_report.by_kind(again) == foreign_report.by_kind(cases)
    assert foreign_report.coverage_rows(again) == foreign_report.coverage_rows(cases)


def test_a_part_that_is_run_leaves_the_others(tmp_path: Path) -> None:
    """Joint tests first, loading records later, on another seed: the page has both and gives both seeds."""
    path = tmp_path / "foreign.json"
    path.write_text(kept.text(foreign_report.made({"joint": part("joint")})[2]))
    parts = kept.read(path) | {"loading": part("loading", SEED + 1)}
    table, page, content = foreign_report.made(parts)
    path.write_text(kept.text(content))
    assert set(kept.read(path)) == {"joint", "loading"}
    assert len(kept.words_of(kept.read(path), "cases")) == 8
    assert "joint: named/play" in page and "loading: named/play" in page
    assert "- joint: `run`, 4 cases of the plan's 9" in page
    assert "- measured: not run" in page
    assert table in page
    assert f"seed {SEED}," in page and f"seed {SEED + 1}," in page
