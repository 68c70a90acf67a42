"""`brace diagnose`: where model and measurement disagree, what is missing, the model with it, the gap before
and after."""

from __future__ import annotations

import argparse

from brace.cli import common
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS
from brace.ground.errors import EXIT_CHECK_FAILED

_PERCENT = 100


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "diagnose",
        help=SUBCOMMANDS["diagnose"],
        description="Finds where a limb's model and a record disagree, names the effect that is missing or "
        "says which "
        "ones it cannot tell apart, adds it to the model, and shows the gap on data that took no part. "
        "Writes "
        "diagnosis.json, limb.toml and report.html into --out. Several datasets: a folder each, and "
        "fleet.html.",
        epilog="Exit code 0 for the verdicts effect, none, ambiguous and unknown. Exit code 3 for the verdict "
        "data_fault, whose report is written all the same, and when a dataset or model cannot be read. Of several "
        "datasets the readable ones are written all the same. Exit code 1 where --take names no member; the report "
        "is written.",
    )
    parser.add_argument(
        "datasets", type=common.path, nargs="+", metavar="DATASET", help="folder with meta.toml and data.csv"
    )
    parser.add_argument(
        "--model",
        type=common.path,
        metavar="LIMB.toml",
        help="what is believed of the limb; default the limb.toml in the dataset's folder; a joint test "
        "needs none",
    )
    parser.add_argument("--out", type=common.path, required=True, metavar="DIR", help="folder of the results")
    parser.add_argument(
        "--seed",
        type=common.count(0, 2**63 - 1),
        default=0,
        metavar="N",
        help="of every random draw; default 0",
    )
    parser.add_argument(
        "--faults",
        choices=("repair", "stop"),
        default="repair",
        help="faulty entries that the record itself corrects: say so and go on (default), or stop at them",
    )
    parser.add_argument(
        "--take",
        metavar="NAME",
        help="where the verdict leaves several explanations that give different K: export this one, as members of "
        "diagnosis.json name it (rig_compliance@rig, or rig_compliance)",
    )
    parser.add_argument(
        "--jobs",
        type=common.count(1, 256),
        metavar="N",
        help="processes at once; default one a core; a single dataset uses two at most",
    )
    parser.add_argument(
        "--scheduler", metavar="ADDRESS", help="several datasets: a Dask cluster's, tcp://HOST:8786, instead"
    )
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    if len(arguments.datasets) > 1 or arguments.scheduler is not None:
        from brace.cli.diagnose_fleet import run_fleet

        return run_fleet(arguments)
    return _run_one(arguments)


def _run_one(arguments: argparse.Namespace) -> int:
    from brace.diagnose.beside import cores
    from brace.diagnose.one import diagnosed, load, model_of
    from brace.diagnose.options import Options
    from brace.diagnose.write import REPORT, check_folder, write

    folder = arguments.datasets[0]
    model = model_of(folder, arguments.model)
    inputs = (folder / "meta.toml", folder / "data.csv", *([model] if model else []))
    check_folder(arguments.out, inputs)  # before the work, not after
    given = load(folder, model)
    processes = arguments.jobs or cores()
    options = Options(seed=arguments.seed, faults=arguments.faults, take=arguments.take, processes=processes)
    with common.progress("diagnosing", _PERCENT) as advance:
        found, written = diagnosed(
            given, options, lambda share, doing: advance(round(_PERCENT * share), doing)
        )
    write(arguments.out, written, inputs)
    for caution in found.cautions:
        common.say(caution)
    if arguments.json:
        common.print_json({**written.json_ready, "out": arguments.out})
    else:
        from brace.diagnose.summary import lines

        for line in lines(found, given.believed):
            common.emit(line)
        common.say(f"-> {arguments.out / REPORT}, diagnosis.json, limb.toml")
    if arguments.take is not None and not found.took:
        open_to = ", ".join(one.label for one in found.members) or "none: this record leaves no choice"
        common.say(f"--take {arguments.take}: no such member, nothing was taken; members are {open_to}")
        return found.exit_code or EXIT_CHECK_FAILED
    return found.exit_code
