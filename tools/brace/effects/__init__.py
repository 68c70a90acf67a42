"""The effects that a diagnosis can name: one catalogue for loading records, joint tests and tables of K."""

from brace.effects.catalogue import BY_NAME, EFFECTS
from brace.effects.record import JointTestBench, JointTestSize, LoadingSize
from brace.effects.row import Effect
from brace.effects.variant import Freedom, Variant, all_variants

__all__ = [
    "BY_NAME",
    "EFFECTS",
    "Effect",
    "Freedom",
    "JointTestBench",
    "JointTestSize",
    "LoadingSize",
    "Variant",
    "all_variants",
]
