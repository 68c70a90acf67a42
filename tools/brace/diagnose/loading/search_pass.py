"""The result of one search over a loading record. The diagnosis is written from it."""

from __future__ import annotations

from dataclasses import dataclass

from brace.diagnose.loading.choose import LabelSet
from brace.diagnose.loading.troubles.likeliest import Trouble
from brace.identify.record import Record
from brace.diagnose.loading.search import Hypothesis
from brace.diagnose.loading.space import Trust
from brace.diagnose.loading.structure import Structure
from brace.diagnose.loading.verdict import Decision


@dataclass(frozen=True)
class Pass:
    """One search over some rows of the record, from nothing to a decision. `troubles` of the instruments are out of
    the record; `rival` is one that stands nearly as well as what was chosen."""

    record: Record
    trust: Trust
    base: Hypothesis
    sets: list[LabelSet]
    structure: Structure
    decision: Decision
    troubles: tuple[Trouble, ...] = ()
    rival: Trouble | None = None
