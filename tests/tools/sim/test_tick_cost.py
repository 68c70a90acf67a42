"""The controller's whole tick on the emulated Cortex-M4F costs no more than it did; the bench counts a million ticks,
this fewer. The bench's limits, 14,000 and 20,000, are not kept yet: firmware/app/README.md says by how much."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "judges" / "bench"))

import fetch  # noqa: E402
import tick_cost  # noqa: E402
from toolchain import M3, M4F, Processor  # noqa: E402

TICKS = 40_000
PLANE_WORST, SPACE_WORST = 16_200, 22_600  # the counts of docs/trust.md, and what other random ticks add
M3_TICKS = 20_000  # among fewer no set is stored
M3_FEW_TICKS = 4_000  # among them K is computed under a load, which costs most of what a tick computes
M3_LOADED_WORST = 8_300  # of K under a load: the count of docs/kernel.md, and what other random ticks add


def _measured(ticks: int, processor: Processor = M4F) -> tick_cost.TickCost:
    for program in ("arm-none-eabi-gcc", "qemu-system-arm"):
        if shutil.which(program) is None:
            pytest.skip(f"no {program}")
    try:
        return tick_cost.measure_ticks(ticks, processor)
    except fetch.Missing as missing:
        pytest.skip(f"missing: {missing}")


@pytest.mark.minutes
def test_worst_of_random_ticks_within_limit() -> None:
    cost = _measured(TICKS)
    assert cost.count == TICKS
    assert cost.maximum <= PLANE_WORST and cost.space_maximum <= SPACE_WORST, tick_cost.as_text(cost)
    seen = {kind.name: kind for kind in cost.kinds}
    assert {"monitor", "taking up", "loading test", "configuration", "every port flooded",
            "every port flooded, in space"} <= seen.keys()
    assert min(kind.mean for kind in cost.kinds) > 100  # the counter counts


@pytest.mark.minutes
def test_worst_on_cortex_m3_within_limit() -> None:
    cost = _measured(M3_TICKS, M3)
    _within_limits_of_m3(cost)
    assert "storing parameters, putting them in force" in {kind.name for kind in cost.kinds}


def test_few_ticks_on_cortex_m3_within_limit() -> None:
    _within_limits_of_m3(_measured(M3_FEW_TICKS, M3))


def _within_limits_of_m3(cost: tick_cost.TickCost) -> None:
    """Its floats are software; K under a load is computed by the fixed point. Its limit, 7,000, is not kept yet."""
    assert cost.maximum <= tick_cost.M3_LIMIT, tick_cost.as_text(cost)
    assert 5_000 < cost.loaded_maximum <= M3_LOADED_WORST, tick_cost.as_text(cost)  # K under a load was counted
