"""`brace diagnose A B C ...`: many records at once, a folder each and one page over all."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from typing import TYPE_CHECKING

from brace.cli import common

if TYPE_CHECKING:
    from brace.diagnose.fleet.job import Job, Outcome


def run_fleet(arguments: argparse.Namespace) -> int:
    """Every record that can be diagnosed is; exit code 3 when one could not be, or is a data fault."""
    from brace.diagnose.fleet import overview
    from brace.diagnose.fleet.job import jobs_of
    from brace.diagnose.options import Options
    from brace.diagnose.write import check_folder
    from brace.ground.errors import EXIT_INTERRUPTED, EXIT_OK
    from brace.ground.files import OutputSet

    options = Options(seed=arguments.seed, faults=arguments.faults, take=arguments.take)
    jobs = jobs_of(arguments.datasets, arguments.model, options)
    inputs = {
        job.name: (job.folder / "meta.toml", job.folder / "data.csv", job.model or job.folder) for job in jobs
    }
    for job in jobs:
        check_folder(arguments.out / job.name, inputs[job.name])
    outcomes: list[Outcome] = []
    try:
        with common.progress("diagnosing", len(jobs)) as advance:
            for outcome in _outcomes(arguments, jobs):
                with OutputSet(inputs[outcome.name]) as outputs:  # each whole, as soon as it is there
                    for name, content in outcome.files.items():
                        outputs.add(arguments.out / outcome.name / name, content)
                    outputs.commit()
                outcomes.append(outcome)
                if not outcome.done:
                    common.say(f"{outcome.name}: not diagnosed\n{outcome.error}")
                advance(len(outcomes), outcome.name)
    except KeyboardInterrupt:
        common.say(
            f"interrupted; {sum(o.done for o in outcomes)} of {len(jobs)} are in {arguments.out}, no summary"
        )
        return EXIT_INTERRUPTED
    for caution in dict.fromkeys(one for outcome in outcomes for one in outcome.cautions):
        names = ", ".join(outcome.name for outcome in outcomes if caution in outcome.cautions)
        common.say(f"{names}: {caution}")
    summary = overview.as_json(outcomes)
    with OutputSet() as outputs:
        outputs.add(arguments.out / "fleet.json", json.dumps(summary, indent=1, ensure_ascii=False) + "\n")
        outputs.add(arguments.out / "fleet.html", overview.page(outcomes))
        outputs.commit()
    if arguments.json:
        common.print_json({**summary, "out": arguments.out})
    else:
        for line in overview.as_lines(outcomes):
            common.emit(line)
        common.say(f"-> {arguments.out / 'fleet.html'}, fleet.json, and a folder a limb")
    return max((outcome.code for outcome in outcomes), default=EXIT_OK)


def _outcomes(arguments: argparse.Namespace, jobs: list[Job]) -> Iterator[Outcome]:
    if arguments.scheduler is not None:
        from brace.diagnose.fleet.cluster import run_on_cluster

        return run_on_cluster(jobs, arguments.scheduler)
    from brace.diagnose.beside import cores
    from brace.diagnose.fleet.local import run_local

    return run_local(jobs, arguments.jobs or cores())
