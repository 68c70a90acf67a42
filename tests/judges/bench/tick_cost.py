"""What the controller's whole tick costs: random ticks of the firmware on the emulated Cortex-M4F, each counted.

The image (tests/judges/bench/tick) drives one controller through random limbs, modes, requests, samples, faults and traffic.
Calls of the hardware layer count as one instruction each, the call: what is behind the door is the board's.
"""

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

BENCH = Path(__file__).resolve().parent
sys.path.insert(0, str(BENCH))

from emulate import RUN_IMAGE, build_plugin  # noqa: E402
from extra import Extra  # noqa: E402
from limits import Check  # noqa: E402
from fetch import ROOT, Missing  # noqa: E402
from toolchain import (BOARDS, BUILD, CORE, M3, M4F, PREFIX, Processor, compile_source, link_image, run,  # noqa: E402
                       symbol_address)

TICK_LIMIT = 14_000  # instructions, of a limb in its plane,
SPACE_LIMIT = 20_000  # and of one in space
M3_LIMIT = 120_000  # of a limb in its plane on the Cortex-M3, whose floats are software,
M3_LOADED_LIMIT = 7_000  # and of its K under a load, by the fixed point
TICK_COUNT = 1_000_000
FUNCTION = "brace_app_tick"
LOADED = "model_loaded"  # finds the tick's own K under a load
BUILDS = {M4F.name: "m4f", M3.name: "m3"}

KINDS = {"M": "monitor", "T": "taking up", "L": "loading test", "R": "loading test: the drift check takes a reading in",
         "J": "loading test: its slopes", "K": "loading test: slopes against the model",
         "C": "configuration", "W": "keeping what the drift check knows",
         "S": "storing parameters, putting them in force",
         "A": "start", "F": "fault", "Q": "every port flooded"}


@dataclass(frozen=True)
class TickKind:
    """Ticks of one kind: how many, and their instructions."""

    name: str
    count: int
    mean: float
    maximum: int


@dataclass(frozen=True)
class TickCost:
    """All ticks of a run; the worst of limbs in their plane, and of those in space. Of both the worst K under a load, a
    part of its tick."""

    count: int
    mean: float
    median: int
    maximum: int
    space_maximum: int
    loaded_maximum: int
    space_loaded_maximum: int
    quantile_99: int
    kinds: tuple[TickKind, ...]

    @property
    def is_within(self) -> bool:
        """Whether both limits are kept."""
        return self.maximum <= TICK_LIMIT and self.space_maximum <= SPACE_LIMIT

    @property
    def is_within_on_m3(self) -> bool:
        """Whether both limits of a limb in its plane on the Cortex-M3 are kept."""
        return self.maximum <= M3_LIMIT and self.loaded_maximum <= M3_LOADED_LIMIT


def build_image(ticks: int, processor: Processor = M4F) -> Path:
    """The image: the harness, and the firmware's own libraries as ./dev setup builds them."""
    built = ROOT / "build" / BUILDS[processor.name]
    libraries = [built / "firmware" / name / f"libbrace_{name}.a" for name in ("app", "store", "interface", "core")]
    if lacking := [library for library in libraries if not library.is_file()]:
        raise Missing(f"{lacking[0].relative_to(ROOT)} is not built; try ./dev setup")
    firmware = CORE.parent
    includes = tuple(f"-I{folder}" for folder in (
        firmware / "app" / "include", firmware / "app" / "src", firmware / "store" / "include",
        firmware / "interface" / "include",
        firmware / "interface" / "generated", firmware / "interface" / "src", ROOT / "hal" / "include"))
    flags = ("-O2", f"-DTICKS={ticks}", "-fno-function-sections", "-fno-tree-loop-distribute-patterns", *includes)
    harness = [path for path in sorted((BENCH / "tick").glob("*.c")) if path.name != "count_ticks.c"]
    folder = BUILD / "objects" / f"tick {processor.name}"
    objects = [compile_source(source, folder / f"{source.stem}.o", processor, flags)
               for source in (*harness, BOARDS / "common" / "startup.c")]
    (BUILD / "images").mkdir(parents=True, exist_ok=True)
    return link_image([*objects, *libraries], BUILD / "images" / f"tick_{processor.name}.elf", processor)


def _door(image: Path) -> tuple[int, int]:
    """The stretch of code that is hardware: from the first to the last of the door's functions."""
    rows = [line.split() for line in run([PREFIX + "nm", "-S", image]).splitlines()]
    door = [(int(row[0], 16), int(row[1], 16)) for row in rows if len(row) == 4 and row[3].startswith("door_")]
    strangers = [row[3] for row in rows if len(row) == 4 and row[2] in "tT" and not row[3].startswith("door_")
                 and min(door)[0] <= int(row[0], 16) < max(door)[0]]
    if strangers:
        raise RuntimeError(f"{image.name}: not of the door, and within it: {', '.join(strangers)}")
    return min(door)[0], sum(max(door))


def measure_ticks(ticks: int = TICK_COUNT, processor: Processor = M4F) -> TickCost:
    """Build, run, count."""
    image, plugin = build_image(ticks, processor), build_plugin(BENCH / "tick" / "count_ticks.c")
    record = image.with_suffix(".counts")
    low, high = _door(image)
    entry, inner = (symbol_address(image, name) & ~1 for name in (FUNCTION, LOADED))
    done = subprocess.run([RUN_IMAGE, processor.machine, image, "-plugin",
                           f"{plugin},entry={entry:#x},inner={inner:#x},skip={low:#x}-{high:#x},out={record}"],
                          capture_output=True, text=True, check=False,
                          env={"PATH": "/usr/bin:/bin", "BRACE_IMAGE_TIMEOUT_S": "1500"})
    if done.returncode != 0:
        raise RuntimeError(f"{image.name}: exit code {done.returncode}\n{done.stdout[-300:]}{done.stderr[-300:]}")
    counts, loaded = np.fromfile(record, dtype="<u4").reshape(-1, 2).T
    letters = np.frombuffer("".join(done.stdout.split()).encode(), dtype="S1").astype(str)
    if len(counts) != ticks or len(letters) != ticks:
        raise RuntimeError(f"{image.name}: {ticks} ticks, {len(counts)} counted, {len(letters)} named")
    return _summary(counts, loaded, letters)


def _summary(counts: np.ndarray, loaded: np.ndarray, letters: np.ndarray) -> TickCost:
    names = KINDS | {letter.lower(): f"{name}, in space" for letter, name in KINDS.items()}
    kinds = tuple(TickKind(name, int(mine.size), float(mine.mean()), int(mine.max()))
                  for letter, name in names.items() if (mine := counts[letters == letter]).size)
    seen = set(np.char.upper(np.unique(letters)))
    missing = [name for letter, name in KINDS.items() if letter not in seen]
    if missing and len(counts) >= TICK_COUNT:
        raise RuntimeError(f"the random ticks never came to: {', '.join(missing)}")
    in_space = np.char.islower(letters)
    return TickCost(int(counts.size), float(counts.mean()), int(np.median(counts)), int(counts[~in_space].max()),
                    int(counts[in_space].max()), int(loaded[~in_space].max()), int(loaded[in_space].max()),
                    int(np.quantile(counts, 0.99)), kinds)


NOTE = """\
One whole tick of the controller, from samples to snapshot to answers: K with its eigenvalues in every tick, the \
joints' state machines, jobs, faults, wires. Counted over random ticks on the emulated Cortex-M4F: planar limbs that \
collapse and that take the general path, limbs in space, every mode, take-ups and loading tests, parameters stored \
and put in force, bad samples, late ticks, a full bus, requests over CAN, SLCAN and both Modbus ports, in some runs \
on every port as often as its line allows. A call of the hardware layer counts as the call alone."""


def extra() -> Extra:
    """Everything of it for the bench."""
    cost = measure_ticks()
    rows = [[kind.name, f"{kind.count:,}", f"{kind.mean:,.0f}", f"{kind.maximum:,}"] for kind in cost.kinds]
    data: dict[str, object] = {
        "ticks": cost.count, "instructions_mean": round(cost.mean, 1), "instructions_median": cost.median,
        "instructions_p99": cost.quantile_99,
        "instructions_max": cost.maximum, "limit": TICK_LIMIT,
        "space_instructions_max": cost.space_maximum, "space_limit": SPACE_LIMIT,
        "kinds": {kind.name: {"ticks": kind.count, "mean": round(kind.mean, 1), "max": kind.maximum}
                  for kind in cost.kinds}}
    checks = [Check(f"controller's tick, limb {where}, instructions, worst of {cost.count:,} random ones of both kinds",
                    f"{worst:,}", f"at most {limit:,}", worst <= limit)
              for where, worst, limit in (("in its plane", cost.maximum, TICK_LIMIT),
                                          ("in space", cost.space_maximum, SPACE_LIMIT))]
    table = ("The controller's tick: instructions", ["kind of tick", "ticks", "mean", "worst"], rows)
    return Extra("tick", NOTE, [table], checks, data)


def as_text(cost: TickCost) -> str:
    """For a terminal."""
    lines = [f"{cost.count:,} random ticks: median {cost.median:,}, mean {cost.mean:,.0f}, "
             f"99th percentile {cost.quantile_99:,}; worst {cost.maximum:,} instructions in the plane, "
             f"{cost.space_maximum:,} in space; of K under a load {cost.loaded_maximum:,} and "
             f"{cost.space_loaded_maximum:,}"]
    lines += [f"  {kind.name:52} {kind.count:9,}  mean {kind.mean:8,.0f}  worst {kind.maximum:7,}"
              for kind in cost.kinds]
    return "\n".join(lines)


def main() -> int:
    """python tests/judges/bench/tick_cost.py [TICKS] [m3]: print; exit code 1 when a limit is passed. m3: on the
    Cortex-M3, whose floats are software; limbs in space have no limit there."""
    ticks = int(sys.argv[1]) if len(sys.argv) > 1 else TICK_COUNT
    is_m3 = sys.argv[2:] == ["m3"]
    cost = measure_ticks(ticks, M3 if is_m3 else M4F)
    print(as_text(cost))
    return int(not (cost.is_within_on_m3 if is_m3 else cost.is_within))


if __name__ == "__main__":
    sys.exit(main())
