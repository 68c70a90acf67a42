"""What the core's flash is made of: jobs added one after the other, each with what it alone pulls in."""

from dataclasses import dataclass

from extra import Extra
from flash_kinds import CONSTANTS, KINDS, kinds_of
from measure import object_of
from toolchain import BUILD, CORE, M4F, flash_bytes
from versions import core_sources
from weights import functions_of, without_space


def _functions_of(header: str) -> tuple[str, ...]:
    """The functions of one header, "name" without its ".h"."""
    return functions_of((CORE / "include" / "brace" / f"{header}.h").read_text())


# A job and its functions, in the order in which a limb comes to need them. Up to LAST_OF_A_LIMB: a planar limb's.
JOBS = (
    ("K at the tick", ("brace_planar_stiffness",)),
    ("parameter change", ("brace_planar_collapse",)),
    ("the general path: any base, springs of the moment", _functions_of("general")),
    ("is this a limb", _functions_of("limb")),
    ("kinematics", without_space(_functions_of("kinematics"))),
    ("contact: sag, force, friction cone", _functions_of("contact")),
    ("slopes of a loading test", _functions_of("slope")),
    ("K's uncertainty", _functions_of("uncertainty")),
    ("kinematics in space", _functions_of("kinematics")),
    ("K in space", _functions_of("spatial")),
    ("the general path with its arguments checked, for hosts", _functions_of("chain")),
)
LAST_OF_A_LIMB = "K's uncertainty"


@dataclass(frozen=True)
class Job:
    """Flash that a job adds and flash up to it [B], the added by kinds of instructions [B]."""

    name: str
    adds: int
    total: int
    kinds: dict[str, int]


def weigh_jobs() -> list[Job]:
    """All jobs, Cortex-M4F."""
    objects = [object_of(source, M4F, ()) for source in core_sources()]
    image = BUILD / "images" / "core_job.elf"
    functions: tuple[str, ...] = ()
    jobs: list[Job] = []
    before, kinds_before = 0, dict.fromkeys(KINDS, 0)
    for name, added in JOBS:
        functions += added
        total = flash_bytes(objects, functions, image, M4F)
        kinds = kinds_of(image, total)
        own = {kind: kinds[kind] - kinds_before[kind] for kind in KINDS}
        jobs.append(Job(name, total - before, total, own))
        before, kinds_before = total, kinds
    return jobs


def _row(job: Job) -> list[str]:
    return [job.name, f"{job.adds:,}", f"{job.total:,}", *(f"{job.kinds[kind]:,}" for kind in KINDS)]


def extra() -> Extra:
    """For the report."""
    jobs = weigh_jobs()
    rows = []
    for index, job in enumerate(jobs):
        rows.append(_row(job))
        if job.name == LAST_OF_A_LIMB:
            sums = {kind: sum(each.kinds[kind] for each in jobs[:index + 1]) for kind in KINDS}
            rows.append(_row(Job("**a planar limb's jobs**", job.total, job.total, sums)))
    heads = ["job", "adds [B]", "up to here [B]", *(f"{kind} [B]" for kind in KINDS)]
    return Extra("flash_bytes_of_jobs",
                 "Linked one after the other, so each row holds only what no row before has brought in. A controller "
                 "links what it calls: nothing of the rows that it does not use. By kinds of instructions as "
                 f"disassembled; \"{CONSTANTS}\" are literals, their loads and tables. What that says: "
                 "docs/kernel.md.",
                 [("What the flash is made of, Cortex-M4F", heads, rows)], [],
                 {job.name: {"adds": job.adds, "up_to_here": job.total, **job.kinds} for job in jobs})
