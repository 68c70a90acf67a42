"""The blind benchmark's second world: limbs of a physics engine, at finite displacements.

Every link is a beam. Strokes go up to 2.54 mm, at bent postures or at all; some limbs are believed to have weight, some
rigs take hold of a hanging limb, some sensors are zeroed before each run, and half of the limb.toml leave out that the
tibia is a beam, which no calibration at small loads could show."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import engine_k
import engine_outsiders
import engine_report
import numpy as np
from designs import Design, Rng, Trust, believed_limb, poses, stiffest_n_per_mm, tests_at, trust
from engine_bench import FEMUR_BEAM, TIBIA_BEAM, EngineBench
from engine_plant import play
from plant import INDEX, Array
from worlds import Setting, World

HERE = Path(__file__).resolve().parent
BENT_RAD, ALL_RAD = (0.9, 2.4), (0.45, 2.75)  # of the knee
STEPS_MM = (0.25, 0.35, 0.635)
MOST_N = 110.0  # of a stroke's force as planned; the sensor reads 145 N


def believed_beams(rng: Rng) -> Array:
    """A limb of beams as its calibration has it; few have tilted ones."""
    p = believed_limb(rng)
    if rng.random() < 0.75:
        for link in ("femur", "tibia"):
            p[INDEX[f"link.{link}.tilt_rad"]] = 0.0
    p[INDEX[FEMUR_BEAM]] = p[INDEX[TIBIA_BEAM]] = 1.0
    if rng.random() < 0.2:
        for part in ("femur", "tibia", "knee"):
            p[INDEX[f"gravity.{part}_n"]] = round(rng.uniform(0.2, 3.0), 2)
    return p


def lacking(p: Array, names: Sequence[str]) -> Array:
    """A moment transfer is hidden where the femur is believed to be none."""
    out = p.copy()
    if "moment_transfer" in names:
        out[INDEX[FEMUR_BEAM]] = 0.0
    return out


def setting(rng: Rng, names: Sequence[str], small: bool = False) -> Setting:
    """A limb, and tests as one would plan them for it; small: with fewer poses and no repeats."""
    believed = lacking(believed_beams(rng), names)
    left_out = (TIBIA_BEAM,) if rng.random() < 0.5 else ()
    at_rest = rng.random() < 0.2
    believed[INDEX["outside.held_at_rest"]] = float(at_rest)
    given = trust(rng)
    configs, repeats = int(rng.integers(8, 12)), int(rng.choice([1, 2], p=[0.25, 0.75]))
    steps = int(rng.choice([3, 4, 5], p=[0.2, 0.7, 0.1]))
    if small:
        configs, repeats = 7, 1
    at = poses(rng, configs + 5, ALL_RAD if rng.random() < 0.5 else BENT_RAD)
    step_mm = float(rng.choice(STEPS_MM)) if rng.random() < 0.7 else round(rng.uniform(0.1, 0.635), 3)
    most_mm = MOST_N / stiffest_n_per_mm(believed, at, play) / steps
    shown, held = tests_at(rng, at, configs, repeats, steps, min(step_mm, round(most_mm, 3)))
    for design in (shown, held):
        design.held_at_rest = at_rest
    shown.zeroed = rng.random() < 0.15
    return believed, given, shown, held, left_out


def bench(design: Design, believed: Array, given: Trust) -> EngineBench:
    """Detectability on this limb."""
    return EngineBench(design, believed, given)


def besides(rng: Rng, p: Array, names: Sequence[str]) -> tuple[Array, dict[str, Any]]:
    """Friction that keeps over to the next run what a run leaves of it: so do a third of the drives that rub."""
    if "coulomb_friction" not in names or rng.random() > 1.0 / 3.0:
        return p, {}
    out = np.array(p)
    out[INDEX["outside.friction_carried"]] = 1.0
    return out, {"friction_carried": True}


WORLD = World(
    "engine",
    play,
    setting,
    bench,
    engine_outsiders.KINDS,
    engine_outsiders.draw,
    tuple(HERE / f"{name}.py" for name in (
        "engine_chain", "engine_limb", "many_rests", "engine_plant", "engine_bench", "engine_outsiders", "engine_world",
    )),
    development_seed=220_003,
    test_seed=732_463,
    development_cases="none=26,single@25=27,single@12=14,single@100=6,pair=12,outside=20,disguised=8",
    test_cases="none=200,single@12=81,single@25=81,single@60=84,single@150=54,pair=60,outside=130,disguised=24",
    page="engine",
    prefix="engine-",
    lacking=lacking,
    besides=besides,
    disguised=engine_outsiders.DISGUISED,
    whole_beams=1.0,
    least_whole_beam_s=11.5,
    reported_cases=60,
    follows_up=False,
    judge_besides=engine_k.judge,
    report=engine_report.made,
)  # fmt: skip
SUBSET_SEED = 440_009
