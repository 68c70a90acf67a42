"""One version built, run on the emulated controller, judged against the reference and weighed."""

import hashlib
from dataclasses import dataclass
from pathlib import Path
from statistics import median_low

import numpy as np

import reference
from emulate import Counted, count, trace
from postures import COUNT, Limb, postures, q28, workspace
from stack import worst_stack_bytes
from timing import Cycles, estimate
from toolchain import (BENCH, BOARDS, BUILD, HARNESS_FLAGS, Processor, compile_source, flash_bytes, link_image,
                       section_sizes)
from versions import COLLAPSE, PLANAR_NO_FPU, SPATIAL, Version

SAME_JOB_ERROR = 1.0e-4  # a version further off than this in K or axis does not compute what the others do

_objects: dict[tuple[Processor, Path, tuple[str, ...]], Path] = {}


@dataclass(frozen=True)
class Error:
    """Largest errors against the reference over the postures: K as a fraction of lambda_max, eigenvalues relative
    to themselves (ascending), stiff axis [rad]."""

    k: float
    eigenvalues: tuple[float, ...]
    axis_rad: float


@dataclass(frozen=True)
class Measured:
    """What was found about one version."""

    version: Version
    minimum: int
    median: int
    maximum: int
    minimum_anywhere: int  # over the whole workspace as well, where the version is run there
    maximum_anywhere: int
    one_path: bool  # the same instructions, address by address, at every posture of the whole workspace
    cycles: Cycles | None
    flash_bytes: int
    static_ram_bytes: int
    stack_bytes: int  # of the counted function and its callees
    stack_chain: tuple[str, ...]
    refused: int  # parameter change: limbs that it leaves to the general path
    error: Error | None
    workspace_error: Error | None


def object_of(source: Path, processor: Processor, flags: tuple[str, ...]) -> Path:
    """The source compiled, once a run."""
    key = (processor, source, flags)
    if key not in _objects:
        digest = hashlib.sha256(" ".join((processor.name, str(source), *flags)).encode()).hexdigest()[:12]
        output = BUILD / "objects" / f"{source.name}.{digest}.o"
        _objects[key] = compile_source(source, output, processor, flags)
    return _objects[key]


def _axis_error(mine: np.ndarray, exact: np.ndarray) -> float:
    return float(np.max(np.abs(np.sin(mine - exact))))


def planar_error(limb: Limb, rows: np.ndarray, angles: np.ndarray) -> Error:
    """Errors of rows (n, 6) of planar results at angles (n, 3) [rad]."""
    exact = reference.planar(limb, angles[:, 1], angles[:, 2])
    k = np.stack([exact.k[:, 0, 0], exact.k[:, 0, 1], exact.k[:, 1, 1]], -1)
    largest = exact.eigenvalues[:, 1:]
    return Error(float(np.max(np.abs(rows[:, :3] - k) / largest)),
                 tuple(np.max(np.abs(rows[:, 3:5] / exact.eigenvalues - 1.0), axis=0).tolist()),
                 _axis_error(rows[:, 5], exact.axis_rad))


def spatial_error(limb: Limb, rows: np.ndarray, angles: np.ndarray) -> Error:
    """Errors of rows (n, 12) of spatial results at angles (n, 3) [rad]."""
    exact = reference.spatial(limb, *angles.T)
    upper = np.triu_indices(3)
    k = exact.k[:, upper[0], upper[1]]
    largest = exact.eigenvalues[:, 2:]
    off_axis = np.linalg.norm(np.cross(rows[:, 9:], exact.axis), axis=1)
    return Error(float(np.max(np.abs(rows[:, :6] - k) / largest)),
                 tuple(np.max(np.abs(rows[:, 6:9] / exact.eigenvalues - 1.0), axis=0).tolist()),
                 float(np.max(off_axis)))


def _error(version: Version, rows: np.ndarray, angles: np.ndarray) -> Error:
    seen = angles.astype(np.float64)
    if version.group == PLANAR_NO_FPU and version.ours:
        seen = q28(angles).astype(np.float64) / 2.0**28
    assert version.limb is not None
    return (spatial_error if version.group == SPATIAL else planar_error)(version.limb, rows, seen)


def _stack(version: Version, counted: Counted, sources: list[Path], job: Path) -> tuple[int, tuple[str, ...]]:
    """Ours: the compiler's figures. Peers, whose library functions have none: the depth seen, less the job's own."""
    if version.ours:
        return worst_stack_bytes(sources, version.function)
    frame, _ = worst_stack_bytes([job], "job_run")
    return counted.stack_bytes - frame, ()


def measure(version: Version, plugin: Path) -> Measured:
    """Build, count, judge and weigh one version."""
    sources = [object_of(source, version.processor, version.flags) for source in version.sources]
    job = object_of(version.job, version.processor, (*HARNESS_FLAGS, *version.job_flags))
    frame = [object_of(path, version.processor, HARNESS_FLAGS) for path in
             (BENCH / "image" / "harness.c", BOARDS / "common" / "startup.c")]
    image = link_image([*sources, job, *frame], BUILD / "images" / f"{version.key}.elf", version.processor)
    counted = count(image, version.processor, plugin, version.function)

    first = counted.instructions[:COUNT]
    middle = median_low(first)
    cycles = None
    if version.group != PLANAR_NO_FPU:
        call = first.index(max(first) if version.group == COLLAPSE else middle)
        addresses = trace(image, version.processor, plugin, version.function, counted.calls_before + call)
        cycles = estimate(image, addresses, version.processor)

    error = whole = None
    refused = int(np.count_nonzero(counted.results)) if version.group == COLLAPSE else 0
    if version.group != COLLAPSE:
        error = _error(version, counted.results[:COUNT], postures())
        if not (error.k <= SAME_JOB_ERROR and error.axis_rad <= SAME_JOB_ERROR):
            raise RuntimeError(f"{version.name}: not the same job as the others: {error}")
        if len(counted.results) > COUNT:
            whole = _error(version, counted.results[COUNT:], workspace())

    linked = BUILD / "images" / f"{version.key}.flash.elf"
    flash = flash_bytes(sources, (version.function, *version.flash_with), linked, version.processor)
    sections = section_sizes(linked)
    stack, chain = _stack(version, counted, sources, job)
    return Measured(version, min(first), middle, max(first), min(counted.instructions), max(counted.instructions),
                    len(set(counted.paths)) == 1, cycles, flash,
                    sections.get(".data", 0) + sections.get(".bss", 0), stack, chain, refused, error, whole)
