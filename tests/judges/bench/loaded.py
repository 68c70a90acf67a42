"""K under a load: what it costs on the Cortex-M4F, beside CasADi's and Eigen's Newton doing the same job, each judged
by the double-precision reference of host_sim (which agrees with a physics engine, tests/judges/engine)."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from emulate import count
from extra import Extra
from limits import at_least, at_most
from measure import object_of
from postures import COUNT, Limb, beam_limb, postures, tilted_limb, workspace
from toolchain import BENCH, BOARDS, BUILD, HARNESS_FLAGS, M3, M4F, Processor, link_image
from versions import EIGEN_FLAGS, FLOAT_FUNCTIONS, core_sources

MOST_INSTRUCTIONS, MOST_FIXED_INSTRUCTIONS, LEAST_RATIO = 2500, 6000, 3.0
WEIGHTS_N = {"femur_n": 2.0, "knee_n": 1.0, "tibia_n": 1.5}  # image/loaded_case.h has the same
LEAST_FACTOR, MOST_MOVED = 2.0, 0.2  # where accuracy is promised: buckling factor, displacement over reach

NOTE = """\
K at the limb's rest under a force of up to 12 N on the tip and its own weight (docs/kernel.md), the \
same 200 postures and as many from the whole workspace. All do the same job for the same limbs (tilt, any strength of moment \
transfer, base): two steps of Newton's method, K, eigenvalues, stiff axis, displacement of the tip, buckling factor. Errors: \
against the reference, of K as a fraction of its norm, where the buckling factor is at least 2 and the tip moves by at most a \
fifth of the reach."""


@dataclass(frozen=True)
class _Version:
    name: str
    function: str
    sources: tuple[Path, ...]
    flags: tuple[str, ...]
    job: Path
    job_flags: tuple[str, ...]
    limb: Limb
    ours: bool = False
    processor: Processor = M4F


@dataclass(frozen=True)
class _Measured:
    version: _Version
    instructions: tuple[int, ...]
    k_median: float
    k_worst: float
    factor_worst: float
    moved_worst_mm: float

    @property
    def median(self) -> int:
        """Of the instructions."""
        return sorted(self.instructions)[len(self.instructions) // 2]


def _versions(casadi_code: Path) -> list[_Version]:
    ours, job = BENCH / "ours" / "loaded_job.c", BENCH / "peers"
    beam, tilted = ("-DBENCH_LIMB=BENCH_BEAM_LIMB",), ("-DBENCH_LIMB=BENCH_TILTED_LIMB",)
    function = "brace_loaded_stiffness"
    return [
        _Version("Brace", function, core_sources(), (), ours, beam, beam_limb(), True),
        _Version("Brace, tilted limb", function, core_sources(), (), ours, tilted, tilted_limb(), True),
        _Version("CasADi C, float functions", "casadi_loaded", (casadi_code / "casadi_loaded.c",),
                 ("-O2", *FLOAT_FUNCTIONS), job / "casadi_loaded_job.c", beam, beam_limb()),
        _Version("Eigen fixed size, -O2", "eigen_loaded", (), (), job / "eigen_loaded.cpp",
                 (*EIGEN_FLAGS, *beam), beam_limb()),
    ]


def _fixed_versions() -> list[_Version]:
    """The path of controllers without an FPU."""
    job, function = BENCH / "ours" / "loaded_job.c", "brace_loaded_fixed_stiffness"
    beam, tilted = (("-DBENCH_FIXED", f"-DBENCH_LIMB=BENCH_{limb}_LIMB") for limb in ("BEAM", "TILTED"))
    return [
        _Version("Brace, fixed point", function, core_sources(), (), job, beam, beam_limb(), True, M3),
        _Version("Brace, fixed point, tilted limb", function, core_sources(), (), job, tilted, tilted_limb(), True, M3),
    ]


def _forces_n() -> np.ndarray:
    """As load_of() of image/loaded_case.h gives them to the images."""
    index = np.arange(2 * COUNT)
    return 2.0 * np.stack([index % 7 - 3.0, index % 11 - 5.0], 1)


def _measure(version: _Version, plugin: Path) -> _Measured:
    objects = [object_of(source, version.processor, version.flags) for source in version.sources]
    objects += [object_of(version.job, version.processor, (*HARNESS_FLAGS, *version.job_flags))]
    objects += [object_of(path, version.processor, HARNESS_FLAGS) for path in
                (BENCH / "image" / "harness.c", BOARDS / "common" / "startup.c")]
    name = "".join(c if c.isalnum() else "_" for c in f"loaded {version.name}".lower())
    image = link_image(objects, BUILD / "images" / f"{name}.elf", version.processor)
    counted = count(image, version.processor, plugin, version.function)
    return _Measured(version, counted.instructions, *_errors(version.limb, counted.results))


def _errors(limb: Limb, rows: np.ndarray) -> tuple[float, float, float, float]:
    """Median and worst of K, worst of the buckling factor (below 10) and of the displacement [mm]."""
    from brace.model import load_limb  # the tools' library, built by ./dev before the bench runs
    from brace.native import loaded

    def single(value: float) -> float:
        return float(np.float32(value))

    keys = {"geometry.femur_mm": limb.femur_mm, "geometry.tibia_mm": limb.tibia_mm}
    keys |= {f"gravity.{part}": weight_n for part, weight_n in WEIGHTS_N.items()}
    for name, link, joint in (("femur", limb.femur, 1), ("tibia", limb.tibia, 2)):
        keys |= {f"link.{name}.{key}": getattr(link, key) for key in ("axial_mm_per_n", "bending_mm_per_n", "tilt_rad")}
        keys |= {f"link.{name}.moment_transfer": link.moment_transfer,
                 f"joint.{name}.compliance_rad_per_n_mm": limb.joint_rad_per_n_mm[joint]}
    paper = load_limb(BENCH.parents[2] / "tools" / "brace" / "data" / "paper-limb.toml")
    angles = np.vstack([postures(), workspace()]).astype(float)
    exact = loaded.under_force(paper.with_values({key: single(value) for key, value in keys.items()}), angles[:, 1],
                               angles[:, 2], _forces_n())
    factor, moved_mm = exact["buckling_factor"], exact.displacement_mm
    reach_mm = limb.femur_mm + limb.tibia_mm
    judged = (exact.status == 0) & (factor >= LEAST_FACTOR) & (np.hypot(*moved_mm.T) <= MOST_MOVED * reach_mm)
    k = rows[:, [0, 1, 1, 2]].reshape(-1, 2, 2)
    true = exact.k_n_per_mm
    off = np.linalg.norm(k - true, axis=(1, 2))[judged] / np.linalg.norm(true, axis=(1, 2))[judged]
    low = judged & (factor < 10.0)
    return (float(np.median(off)), float(off.max()), float(np.abs(rows[low, 8] / factor[low] - 1.0).max()),
            float(np.abs(rows[judged, 6:8] - moved_mm[judged]).max()))


def _row(m: _Measured, least: int) -> list[str]:
    return [m.version.name, f"{min(m.instructions):,} / {m.median:,} / {max(m.instructions):,}",
            f"{m.median / least:.2f}", f"{m.k_median:.1e}", f"{m.k_worst:.1e}", f"{m.factor_worst:.1e}",
            f"{m.moved_worst_mm:.4f}"]


def extra(casadi_code: Path, plugin: Path) -> Extra:
    """All versions, counted and judged."""
    measured = [_measure(version, plugin) for version in _versions(casadi_code)]
    ours = [m for m in measured if m.version.ours]
    best = min((m for m in measured if not m.version.ours), key=lambda m: m.median)
    most = max(max(m.instructions) for m in ours)
    rows = [_row(m, ours[0].median) for m in measured]
    fixed = [_measure(version, plugin) for version in _fixed_versions()]
    fixed_rows = [_row(m, fixed[0].median) for m in fixed]
    heads = ["version", "instructions min / median / max", "ratio", "K error, median", "K error, worst",
             "buckling factor, worst", "displacement [mm], worst"]
    error = "K under a load: error of K, as a fraction of its norm"
    checks = [
        at_most("K under a load, instructions at every posture", most, MOST_INSTRUCTIONS),
        at_least(f"K under a load, times fewer instructions than the best peer ({best.version.name}, median)",
                 best.median / most, LEAST_RATIO),
        at_most(f"{error}, median", max(m.k_median for m in ours), 5e-4, text="{:.1e}".format),
        at_most(f"{error}, worst", max(m.k_worst for m in ours), 6e-3, text="{:.1e}".format),
        at_most("K under a load in fixed point, instructions on a Cortex-M3",
                max(max(m.instructions) for m in fixed), MOST_FIXED_INSTRUCTIONS),
        at_most(f"{error}, worst in fixed point", max(m.k_worst for m in fixed), 1e-2, text="{:.1e}".format),
    ]
    data: dict[str, object] = {"versions": [{"name": m.version.name, "ours": m.version.ours, "instructions_median": m.median,
                          "instructions_max": max(m.instructions), "error_k_median": m.k_median,
                          "error_k_worst": m.k_worst, "error_buckling_factor": m.factor_worst,
                          "error_displacement_mm": m.moved_worst_mm} for m in [*measured, *fixed]]}
    return Extra("loaded", NOTE, [("K under a load, Cortex-M4F", heads, rows),
                                  ("K under a load, Cortex-M3 without FPU", heads, fixed_rows)], checks, data)
