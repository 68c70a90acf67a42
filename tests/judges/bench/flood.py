"""K while every port is flooded: the table that tests/unit/app/test_app_flood.c prints, on the host."""

from pathlib import Path

from extra import Extra
from limits import Check
from toolchain import BENCH, run

TEST = BENCH.parents[2] / "build" / "host" / "tests" / "test_app_flood"
NOTE = """\
Each limb under each flood for 2,000 ticks, with loading tests and take-ups in turn. A tick counts when its snapshot's \
K is that of the samples of this very tick (age 0). The test fails as well when a request is not answered in the tick \
that finds it. Printed by `tests/unit/app/test_app_flood.c`."""
MODES = ("MONITOR", "TAKING_UP", "LOADING_TEST")


def rows(test: Path = TEST) -> list[list[str]]:
    """limb, flood, then ticks and ticks with their own K in each mode."""
    return [line.split(",")[1:] for line in run([test]).splitlines() if line.startswith("flood,")]


def extra() -> Extra:
    """Everything of it for the bench."""
    found = rows()
    table = [[limb, port, *(f"{own} of {ticks}" for ticks, own in zip(counts[::2], counts[1::2]))]
             for limb, port, *counts in found]
    ticks = sum(int(count) for row in found for count in row[2::2])
    own = sum(int(count) for row in found for count in row[3::2])
    check = Check("ports flooded: ticks with K of their own samples", f"{own:,} of {ticks:,}", "all",
                  own == ticks and ticks > 0)
    heads = ["limb", "flooded port", *MODES]
    return Extra("flood", NOTE, [("K of the tick's own samples, ports flooded", heads, table)], [check],
                 {"ticks": ticks, "with_own_k": own, "rows": found})
