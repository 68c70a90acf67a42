"""Friction whose law the record does not show, where its loop is plain.

A joint that rings shakes friction off, and friction may depend on speed, load and rest. No law that a record of
readings at rest can hold explains all of that, and the verdict would be unknown. But what a joint's friction leaves is
plain where a sum of sliding springs in one joint explains most of the misfit, and nothing without friction comes near.
Then friction is named, the rest is shown as unexplained, and the model stays as it was given."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from brace.diagnose.loading.choose import LabelSet
from brace.diagnose.loading.extensions import Outside
from brace.diagnose.loading.search import Hypothesis
from brace.diagnose.loading.search_pass import Pass
from brace.diagnose.loading.structure import structure_of
from brace.diagnose.loading.troubles.likeliest import MUST_LEAD, rubs
from brace.diagnose.loading.verdict import Decision

PLAIN = 0.75  # of what the refitted limb leaves beyond noise: what one joint's friction must explain alone


def with_plain_loop(found: Pass) -> Pass:
    """A pass that ended as unknown, with a joint's friction named where its loop is plain; as it was elsewhere."""
    if found.decision.verdict != "unknown":
        return found
    base = next(item for item in found.sets if not item.labels)
    trouble, lead = rubs(found.record, found.sets)
    if trouble is None or lead < MUST_LEAD:
        return found
    left = trouble.rest.best.fit
    if base.best.fit.cost - left.cost < PLAIN * (base.best.fit.cost - found.record.readings):
        return found
    record = found.record.beside(trouble.columns)
    alone = LabelSet(frozenset(), Hypothesis(left, 0.0), 1.0)
    structure = structure_of(record, left)
    decision = Decision("none", (), (), alone, structure, Outside(-np.inf, ""))
    return replace(
        found, record=record, base=alone.best, sets=[alone], structure=structure, decision=decision,
        troubles=(*found.troubles, trouble), rival=None,
    )  # fmt: skip
