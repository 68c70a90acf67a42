"""What a planar limb's flash is made of: jobs added one after the other, each with what it alone pulls in."""

from extra import Extra
from measure import object_of
from toolchain import BUILD, CORE, M4F, flash_bytes
from versions import core_sources
from weights import functions_of

# A job and the header whose functions it is, in the order in which a limb comes to need them.
JOBS = (
    ("status texts", "status"),
    ("is this a limb", "limb"),
    ("kinematics, planar and spatial", "kinematics"),
    ("the general path: any chain, coxa and base included; harmonics", "chain"),
    ("contact: sag, force, friction cone", "contact"),
    ("slopes of a loading test", "slope"),
    ("K's uncertainty", "uncertainty"),
)
FIRST = (("K at the tick", ("brace_planar_stiffness",)),
         ("parameter change, and the tick's tables, whose addresses it sets", ("brace_planar_collapse",)))


def _functions_of(header: str) -> tuple[str, ...]:
    """The functions of one header, "name" without its ".h"."""
    return functions_of((CORE / "include" / "brace" / f"{header}.h").read_text())


def weigh_jobs() -> dict[str, tuple[int, int]]:
    """Job -> flash it adds and flash up to it [B], Cortex-M4F."""
    objects = [object_of(source, M4F, ()) for source in core_sources()]
    functions: tuple[str, ...] = ()
    found: dict[str, tuple[int, int]] = {}
    before = 0
    for job, added in (*FIRST, *((name, _functions_of(header)) for name, header in JOBS)):
        functions += added
        total = flash_bytes(objects, functions, BUILD / "images" / "core_job.elf", M4F)
        found[job] = (total - before, total)
        before = total
    return found


def extra() -> Extra:
    """For the report."""
    jobs = weigh_jobs()
    rows = [[name, f"{own:,}", f"{total:,}"] for name, (own, total) in jobs.items()]
    return Extra("planar_limb_flash_bytes",
                 "Linked one after the other, so each row holds only what no row before has brought in. A controller "
                 "links what it calls: nothing of the rows that it does not use.",
                 [("What a planar limb's flash is made of, Cortex-M4F", ["job", "adds [B]", "up to here [B]"], rows)], [],
                 {name: own for name, (own, _) in jobs.items()})
