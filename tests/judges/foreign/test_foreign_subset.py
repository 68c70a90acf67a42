"""A small fixed set of foreign joint tests through the tool: those that every version so far has named right, and that
no case ends without a verdict."""

from __future__ import annotations

from pathlib import Path

import foreign
import plans
import pytest
import sets
from verdicts import Word

PLAIN = ("play", "lugre", "hardening", "play_friction", "play_hardening")
# This test asks of all other kinds only that the diagnosis ends in a verdict, not which verdict that is. A record of
# 300 rows goes through the same searches as the whole record, in half the time. Nine of ten such records end in the
# verdict of the whole record. ./dev blind --foreign judges whole records, and many of each kind.
FEW_ROWS = 300


@pytest.fixture(scope="module")
def words(tmp_path_factory: pytest.TempPathFactory) -> list[Word]:
    """Made and diagnosed."""
    root: Path = tmp_path_factory.mktemp("foreign")
    wanted = sets.cases(plans.SUBSET_SEED, plans.SUBSET)
    sets.make(wanted, root)
    for case in wanted:
        if case.kind not in PLAIN:
            thin_out(root / "cases" / case.name / "data.csv")
        foreign.job((str(root), str(root), case.name))
    return foreign.judged(root, root, [case.name for case in wanted])


def thin_out(table: Path) -> None:
    """Leaves about FEW_ROWS, evenly spread."""
    head, *rows = table.read_text().splitlines(keepends=True)
    table.write_text("".join([head, *rows[:: max(1, len(rows) // FEW_ROWS)]]))


def test_every_record_ends_in_a_verdict(words: list[Word]) -> None:
    """Or in a refusal that says why; never in a traceback."""
    assert not [(w.truth["id"], w.note) for w in words if "Traceback" in w.note or w.verdict == "nothing"]


def test_plain_joints_are_named(words: list[Word]) -> None:
    """Of five joints with one or two effects at most one has a wrong name with 0.9 or more, or lacks one."""
    plain = [w for w in words if w.truth["kind"] in PLAIN]
    assert len(plain) == len(PLAIN)
    assert sum(bool(w.wrong(0.9)) or not w.found for w in plain) <= 1
