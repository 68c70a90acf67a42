"""Host throughput in batches: builds host/throughput.cpp with the core and the peers, runs it, judges its numbers."""

import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from measure import SAME_JOB_ERROR, Error, planar_error
from postures import paper_limb, postures, tilted_limb
from toolchain import BENCH, BUILD, CORE_FLAGS, INCLUDES, run
from versions import EIGEN_FLAGS, core_sources

PEER_FLAGS = ("-O3", "-march=native", *EIGEN_FLAGS)


PROCESSES = 3  # where a process's memory lies changes a rate by a tenth; the best of each version counts


@dataclass(frozen=True)
class Rate:
    """One version on this host."""

    name: str
    postures_per_s: float
    error: Error


def _compile(source: Path, flags: tuple[str, ...]) -> Path:
    output = BUILD / "host" / f"{source.name}.o"
    output.parent.mkdir(parents=True, exist_ok=True)
    run(["g++" if source.suffix == ".cpp" else "gcc", *flags, *INCLUDES, "-c", source, "-o", output])
    return output


def measure_rates() -> list[Rate]:
    """Every version of host/throughput.cpp, Eigen first."""
    core = [_compile(source, CORE_FLAGS) for source in core_sources()]
    peers = [_compile(BENCH / "peers" / "plain.c", PEER_FLAGS), _compile(BENCH / "peers" / "eigen.cpp", PEER_FLAGS)]
    driver = _compile(BENCH / "host" / "throughput.cpp", ("-std=c++17", "-O2", "-Wall", "-Wextra"))
    program = BUILD / "host" / "throughput"
    run(["g++", driver, *peers, *core, "-lm", "-o", program])
    runs = [_parse(run([program])) for _ in range(PROCESSES)]
    return [max(same, key=lambda rate: rate.postures_per_s) for same in zip(*runs, strict=True)]


def _parse(output: str) -> list[Rate]:
    rates: list[Rate] = []
    name = ""
    rows: list[list[float]] = []
    angles = postures().astype(np.float64)
    for line in output.splitlines():
        kind, _, rest = line.partition(" ")
        if kind == "version":
            name, rows = rest, []
        elif kind == "run":
            rows.append([struct.unpack(">f", bytes.fromhex(word))[0] for word in rest.split()])
        elif kind == "rate":
            limb = tilted_limb() if "tilted" in name else paper_limb()
            error = planar_error(limb, np.array(rows, dtype=np.float64), angles)
            if not (error.k <= SAME_JOB_ERROR and error.axis_rad <= SAME_JOB_ERROR):
                raise RuntimeError(f"{name}: not the same job as the others: {error}")
            rates.append(Rate(name, float(rest), error))
    return rates
