"""K in space under a load: what it costs on the Cortex-M4F, judged by the double-precision reference of host_sim (which
agrees with a physics engine, tests/judges/engine)."""

from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np

from emulate import count
from extra import Extra
from limits import Check, at_most
from loaded import LEAST_FACTOR, MOST_MOVED, WEIGHTS_N
from measure import object_of
from postures import COUNT, Limb, Link, beam_limb, coxa_limb, postures, tilted_limb, workspace
from toolchain import BENCH, BOARDS, BUILD, HARNESS_FLAGS, M4F, link_image
from versions import core_sources

STIFFNESS, TURN, BUCKLING = "rest and K", "turned, eigenvalues", "buckling factor"
FUNCTIONS = {STIFFNESS: ("settle", "stiffness"), TURN: ("turn",), BUCKLING: ("buckling_factor",)}
MOST_INSTRUCTIONS = {STIFFNESS: 7200, TURN: 550, BUCKLING: 13000}
LIMBS = {"beams": (beam_limb, "BEAM"), "coxa link yields": (coxa_limb, "COXA"), "tilted": (tilted_limb, "TILTED")}

NOTE = """\
K in space at the limb's rest under a force of up to 13 N on the tip and its own weight \
(docs/kernel.md), the same 200 postures and as many from the whole workspace: rest, K, \
displacement of the tip and turns of the joints; then K turned to the robot's frame with eigenvalues and stiff axis; \
then the buckling factor, on demand. Errors: as for the plane."""


@dataclass(frozen=True)
class _Measured:
    instructions: dict[str, tuple[int, ...]]
    paths: int  # of the functions of the rest and K, over all postures
    k_median: float
    k_worst: float
    moved_worst_mm: float


def _measure(constant: str, limb: Limb, plugin: Path) -> _Measured:
    objects = [object_of(source, M4F, ()) for source in core_sources()]
    job_flags = (*HARNESS_FLAGS, f"-DBENCH_LIMB=BENCH_{constant}_LIMB")
    objects += [object_of(BENCH / "ours" / "loaded_space_job.c", M4F, job_flags)]
    objects += [object_of(path, M4F, HARNESS_FLAGS) for path in
                (BENCH / "image" / "harness.c", BOARDS / "common" / "startup.c")]
    image = link_image(objects, BUILD / "images" / f"loaded_space_{constant.lower()}.elf", M4F)
    counted = {work: [count(image, M4F, plugin, f"brace_loaded_space_{function}") for function in functions]
               for work, functions in FUNCTIONS.items()}
    instructions = {work: tuple(map(sum, zip(*(c.instructions for c in parts)))) for work, parts in counted.items()}
    rest_and_k = counted[STIFFNESS]
    return _Measured(instructions, max(len(set(c.paths)) for c in rest_and_k), *_errors(limb, rest_and_k[0].results))


def _single(value: float) -> float:
    return float(np.float32(value))


def _keys(limb: Limb) -> dict[str, float]:
    keys = {"geometry.coxa_mm": limb.coxa_mm, "geometry.femur_mm": limb.femur_mm, "geometry.tibia_mm": limb.tibia_mm}
    keys |= {f"gravity.{part}": weight_n for part, weight_n in WEIGHTS_N.items()}
    for name, link, joint in zip(("coxa", "femur", "tibia"), limb.links, limb.joint_rad_per_n_mm):
        for field in fields(Link):
            keys[f"link.{name}.{field.name.removesuffix('_ratio')}"] = getattr(link, field.name)
        keys[f"joint.{name}.compliance_rad_per_n_mm"] = joint
    return {key: _single(value) for key, value in keys.items()}


def _forces_n() -> np.ndarray:
    """As load_of() and sideways_of() of image/loaded_case.h give them to the images."""
    index = np.arange(2 * COUNT)
    return 2.0 * np.stack([index % 7 - 3.0, index % 5 - 2.0, index % 11 - 5.0], 1)


def _errors(limb: Limb, rows: np.ndarray) -> tuple[float, float, float]:
    """Median and worst of K, worst of the displacement [mm]; in the limb's plane's frame."""
    from brace.model import load_limb  # the tools' library, built by ./dev before the bench runs
    from brace.native import loaded

    paper = load_limb(BENCH.parents[2] / "tools" / "brace" / "data" / "paper-limb.toml")
    angles = np.vstack([postures(), workspace()]).astype(float) * (0.0, 1.0, 1.0)
    exact = loaded.space_under_force(paper.with_values(_keys(limb)), angles, _forces_n())
    moved_mm, true = exact.displacement_mm, exact.k_n_per_mm
    reach_mm = limb.femur_mm + limb.tibia_mm
    judged = (exact.status == 0) & (exact["buckling_factor"] >= LEAST_FACTOR)
    judged &= np.linalg.norm(moved_mm, axis=1) <= MOST_MOVED * reach_mm
    k = rows[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(-1, 3, 3)
    off = np.linalg.norm(k - true, axis=(1, 2))[judged] / np.linalg.norm(true, axis=(1, 2))[judged]
    return float(np.median(off)), float(off.max()), float(np.abs(rows[judged, 6:9] - moved_mm[judged]).max())


def _rows(measured: dict[str, _Measured]) -> list[list[str]]:
    return [[name, *(f"{min(n):,} / {max(n):,}" for n in m.instructions.values()), f"{m.k_median:.1e}",
             f"{m.k_worst:.1e}", f"{m.moved_worst_mm:.3f}"] for name, m in measured.items()]


def _checks(measured: dict[str, _Measured]) -> list[Check]:
    what, every = "K in space under a load", measured.values()
    checks = [at_most(f"{what}, {work}, instructions at every posture",
                      max(max(m.instructions[work]) for m in every), limit)
              for work, limit in MOST_INSTRUCTIONS.items()]
    paths = max(m.paths for m in every)
    checks.append(Check(f"{what}: paths over all postures", f"{paths}", "one", paths == 1))
    error = f"{what}: error of K, as a fraction of its norm"
    checks.append(at_most(f"{error}, median", max(m.k_median for m in every), 1e-3, text="{:.1e}".format))
    checks.append(at_most(f"{error}, worst", max(m.k_worst for m in every), 1e-2, text="{:.1e}".format))
    return checks


def _data(measured: dict[str, _Measured]) -> list[dict[str, object]]:
    return [{"name": name, "instructions_max": {work: max(n) for work, n in m.instructions.items()},
             "error_k_median": m.k_median, "error_k_worst": m.k_worst, "error_displacement_mm": m.moved_worst_mm}
            for name, m in measured.items()]


def extra(plugin: Path) -> Extra:
    """All limbs, counted and judged."""
    measured = {name: _measure(constant, limb(), plugin) for name, (limb, constant) in LIMBS.items()}
    heads = ["limb", "K: instructions min / max", "turned, eigenvalues", "buckling factor", "K error, median",
             "K error, worst", "displacement [mm], worst"]
    tables = [("K in space under a load, Cortex-M4F", heads, _rows(measured))]
    return Extra("loaded_space", NOTE, tables, _checks(measured), {"limbs": _data(measured)})
