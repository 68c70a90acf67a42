"""Checks the instruments on a function counted by hand, before anything is measured with them."""

from pathlib import Path

from emulate import count, trace
from measure import object_of
from stack import worst_stack_bytes
from timing import by_manual, disassemble
from toolchain import BENCH, BOARDS, BUILD, HARNESS_FLAGS, M4F, link_image

LOOPS = 3
STACK_BYTES = 8 + 24
CYCLES_ONE_LOOP = 3 + 1 + 1 + 2 + (1 + 1 + 1 + 1 + 1) + 1 + (1 + 2) + 1 + (1 + 2) + (3 + 2)


def expected_instructions(loops: int) -> int:
    """By hand, from image/calibration_job.c."""
    return 4 + 5 * loops + 3 + 2


def calibrate(plugin: Path) -> None:
    """Raises RuntimeError when counter, stack paint or the manual's timings do not give what they must."""
    job = object_of(BENCH / "image" / "calibration_job.c", M4F, HARNESS_FLAGS)
    frame = [object_of(path, M4F, HARNESS_FLAGS) for path in
             (BENCH / "image" / "harness.c", BOARDS / "common" / "startup.c")]
    image = link_image([job, *frame], BUILD / "images" / "calibration.elf", M4F)
    counted = count(image, M4F, plugin, "calibration")
    job_frame, _ = worst_stack_bytes([job], "job_run")
    listing = disassemble(image, M4F)
    executed = [listing[address] for address in trace(image, M4F, plugin, "calibration", 0)]
    found = (counted.instructions, counted.stack_bytes - job_frame, by_manual(executed)[0], len(set(counted.paths)))
    wanted = (tuple(expected_instructions(n) for n in range(1, LOOPS + 1)), STACK_BYTES, CYCLES_ONE_LOOP, LOOPS)
    if found != wanted:
        raise RuntimeError(f"calibration: instructions, stack, cycles, paths are {found}, must be {wanted}")
