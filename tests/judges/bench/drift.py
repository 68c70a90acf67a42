"""What a step of the drift check costs on the emulated Cortex-M4F: instructions, stack, flash and RAM.

`python tests/judges/bench/drift.py` prints it; `cost(plugin)` is for the bench.
"""

import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median_low

import postures
from emulate import build_plugin, count
from extra import Extra
from limits import Check
from measure import object_of
from stack import worst_stack_bytes
from toolchain import BENCH, BOARDS, BUILD, HARNESS_FLAGS, M4F, flash_bytes, link_image, type_sizes
from versions import OURS, core_sources

STEP, REPORT = "brace_drift_step", "brace_drift_report"
MOST_INSTRUCTIONS, MOST_REPORT_INSTRUCTIONS, MOST_RAM_BYTES = 2400, 1500, 344


@dataclass(frozen=True)
class DriftCost:
    """Loading runs at changing postures, learning and watching, with and without an alarm."""

    median: int
    maximum: int
    report_maximum: int  # of reporting the state, at any of these readings
    stack_bytes: int
    flash_bytes: int  # of all its public functions and what they call
    ram_bytes: int

    @property
    def kept(self) -> bool:
        """Within what the header promises."""
        return (self.maximum <= MOST_INSTRUCTIONS and self.report_maximum <= MOST_REPORT_INSTRUCTIONS
                and self.ram_bytes <= MOST_RAM_BYTES)


def cost(plugin: Path) -> DriftCost:
    """Build, count and weigh."""
    sources = [object_of(source, M4F, ("-O2",)) for source in core_sources()]
    job = object_of(OURS / "drift_job.c", M4F, (*HARNESS_FLAGS, "-DBENCH_LIMB=BENCH_PAPER_LIMB"))
    frame = [object_of(path, M4F, HARNESS_FLAGS) for path in
             (BENCH / "image" / "harness.c", BOARDS / "common" / "startup.c")]
    image = link_image([*sources, job, *frame], BUILD / "images" / "drift.elf", M4F)
    counted = count(image, M4F, plugin, STEP)
    reported = count(image, M4F, plugin, REPORT)
    functions = tuple(f"brace_drift_{name}" for name in ("learn", "reset", "run", "step", "report", "outlook"))
    return DriftCost(median_low(counted.instructions), max(counted.instructions),
                     max(reported.instructions), worst_stack_bytes(sources, STEP)[0],
                     flash_bytes(sources, functions, BUILD / "images" / "drift_flash.elf", M4F),
                     type_sizes(("brace_drift_t",), ("brace/drift.h",), M4F)["brace_drift_t"])


NOTE = """One reading of a loading run, learning and watching, with and without an alarm. What it sees:
[drift](drift.md), printed by `python tests/property/drift_figures.py`."""


def extra(plugin: Path) -> Extra:
    """Everything of it for the bench."""
    found = cost(plugin)
    rows = [["a reading, instructions (median / worst)", f"{found.median:,} / {found.maximum:,}"],
            ["reporting the state, instructions (worst)", f"{found.report_maximum:,}"],
            ["flash with what it calls [B]", f"{found.flash_bytes:,}"],
            ["RAM [B]", f"{found.ram_bytes}"], ["stack of a reading [B]", f"{found.stack_bytes}"]]
    checks = [Check("drift check, a reading's instructions", f"{found.maximum:,}", f"at most {MOST_INSTRUCTIONS:,}",
                    found.maximum <= MOST_INSTRUCTIONS),
              Check("drift check, instructions of reporting the state", f"{found.report_maximum:,}",
                    f"at most {MOST_REPORT_INSTRUCTIONS:,}", found.report_maximum <= MOST_REPORT_INSTRUCTIONS),
              Check("drift check, RAM", f"{found.ram_bytes} B", f"at most {MOST_RAM_BYTES} B",
                    found.ram_bytes <= MOST_RAM_BYTES)]
    return Extra("drift", NOTE, [("The drift check, Cortex-M4F", ["what", "measured"], rows)], checks, asdict(found))


def main() -> int:
    """Print it; 1 when a promise is not kept."""
    (BUILD / "generated").mkdir(parents=True, exist_ok=True)
    (BUILD / "images").mkdir(parents=True, exist_ok=True)
    (BUILD / "generated" / "bench_data.h").write_text(postures.header())
    found = cost(build_plugin())
    print(f"drift check, Cortex-M4F: {found.median:,} instructions a step (median), {found.maximum:,} at most (limit "
          f"{MOST_INSTRUCTIONS:,}), {found.report_maximum:,} to report the state (limit {MOST_REPORT_INSTRUCTIONS:,}); stack {found.stack_bytes} B, flash {found.flash_bytes:,} B with what it calls, "
          f"RAM {found.ram_bytes} B (limit {MOST_RAM_BYTES})")
    return 0 if found.kept else 1


if __name__ == "__main__":
    sys.exit(main())
