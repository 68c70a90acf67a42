"""The whole of `brace diagnose` for one record; its kind decides the steps."""

from __future__ import annotations

from dataclasses import replace

from brace.dataset import Dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.options import Advance, Options, silent
from brace.model import LimbModel
from brace.model.assumed_trust import ASSUMED, assumption

# The keys of [uncertainty] that each kind of record is judged by.
TRUSTS = {"loading": tuple(ASSUMED), "joint_test": ("uncertainty.compliance_rel",), "stiffness_table": ()}


def diagnose(
    dataset: Dataset, believed: LimbModel | None, options: Options, advance: Advance = silent
) -> Diagnosis:
    """Finds and names what `believed` lacks of `dataset`; `believed` may be None for joint tests only, which then start
    from a spring alone."""
    found = _diagnosed(dataset, believed, options, advance)
    assumed = "" if believed is None else assumption(believed, TRUSTS[dataset.kind])
    return replace(found, cautions=(*found.cautions, assumed)) if assumed else found


def _diagnosed(dataset: Dataset, believed: LimbModel | None, options: Options, advance: Advance) -> Diagnosis:
    if dataset.kind == "joint_test":
        from brace.diagnose.joint_test import diagnose_joint_test

        return diagnose_joint_test(dataset, believed, options, advance)
    if dataset.kind == "stiffness_table":
        from brace.diagnose.stiffness_table import diagnose_table

        return diagnose_table(dataset, believed, options, advance)
    from brace.diagnose.loading import diagnose_loading

    return diagnose_loading(dataset, believed, options, advance)
