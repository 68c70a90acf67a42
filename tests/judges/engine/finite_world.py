"""The simulator's world at finite displacements: its limbs, tests, hidden effects and outsiders, played by the engine.

A tibia stays the paper's ellipsoid and a femur keeps the moment transfer it is believed to have, as in the simulator;
only the simulator's assumption that nothing turns is gone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import engine_world
from designs import Rng, believed_limb, loading_test, trust
from engine_plant import play
from worlds import SIMULATOR, Setting


def setting(rng: Rng, _names: Sequence[str]) -> Setting:
    """As the simulator's; its tests are planned for the limb as the engine plays it."""
    believed = believed_limb(rng)
    given = trust(rng)
    return believed, given, *loading_test(rng, believed, play), ()


WORLD = replace(
    SIMULATOR,
    name="finite",
    play=play,
    setting=setting,
    bench=engine_world.bench,
    sources=engine_world.WORLD.sources,
    development_seed=130_021,
    test_seed=423_966,
    development_cases=60,
    test_cases="single@8=168,single@12=336,single@25=252,none=1500,pair=420,outside=210,data_fault=23",
    page="blind-finite",
    prefix="finite-",
    displacements="finite",
    reported_cases=60,
)
