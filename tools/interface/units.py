"""The units of values on the wires, and how a C member's name says them. What is counted in us
has the unit in its own name."""

from __future__ import annotations

UNIT_SUFFIX = {
    "": "", "1": "_ratio", "us": "", "ms": "_ms", "N/mm": "_n_per_mm", "rad": "_rad", "mm": "_mm", "N": "_n",
    "N mm": "_n_mm", "degC": "_degc",
}
