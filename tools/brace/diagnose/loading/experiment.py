"""What to measure next."""

from __future__ import annotations

from typing import TYPE_CHECKING

from brace.diagnose.diagnosis import NextExperiment
from brace.diagnose.loading.record import Record
from brace.diagnose.options import Options
from brace.model import LimbModel

if TYPE_CHECKING:
    from brace.diagnose.loading.run import Pass


def next_experiment(record: Record, final: Pass, believed: LimbModel, options: Options) -> NextExperiment | None:
    return None
