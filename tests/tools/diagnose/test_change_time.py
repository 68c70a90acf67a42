"""When a link changed: from a reading of the limb as it was to one of the limb as it is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from handmade import loading_record

from brace.dataset import load_dataset
from brace.diagnose.loading.fit import fit
from brace.diagnose.loading.intervals import intervals
from brace.diagnose.loading.space import space_of, trust_of
from brace.effects.variant import all_variants
from brace.identify.record import load_record, setting_of
from brace.model import load_limb

LIMB = Path(__file__).resolve().parents[3] / "tools" / "brace" / "data" / "paper-limb.toml"
BENDING, FACTOR, AT = "link.tibia.bending_mm_per_n", "change.bending_factor", "change.at_s"


def test_the_time_of_a_change_is_between_its_neighbours(tmp_path: Path) -> None:
    """The tibia's bending changes between two configurations, in the middle of the record. The interval holds both
    neighbours of that moment, and less than three runs: each run bends the limb by far more than the noise."""
    believed = load_limb(LIMB)
    probe = load_dataset(loading_record(tmp_path / "probe", LIMB, values={}))
    clock, config = probe["t_s"], probe["config"]
    first_after = int(np.argmax(config == config[clock.size // 2]))
    at_s = float(0.5 * (clock[first_after - 1] + clock[first_after]))
    soft = 2.5 * believed.number(BENDING)
    truth = {BENDING: soft, FACTOR: 1.0 / 2.5, AT: at_s, "change.link": "tibia"}
    record = load_record(load_dataset(loading_record(tmp_path / "data", LIMB, values=truth)))
    (variant,) = (one for one in all_variants(setting_of(record, believed)) if one.label == "link_change@link.tibia")
    space = space_of(trust_of(believed, turns=True), (variant,))
    start = space.mean.copy()
    start[space.keys.index(FACTOR)], start[space.keys.index(AT)] = 2.0, at_s
    found = intervals(record, fit(record, space, start), (FACTOR, AT))
    assert found[FACTOR].low < 1.0 / 2.5 < found[FACTOR].high
    assert found[AT].low <= clock[first_after - 1] and clock[first_after] <= found[AT].high
    run_s = float(np.ptp(clock)) / np.unique(record.dataset["run"]).size
    assert found[AT].high - found[AT].low < 3.0 * run_s, (found[AT], run_s)
