"""`brace identify`: a limb's parameters from measurements, with intervals and what cannot be distinguished."""

from __future__ import annotations

import argparse

from brace.cli import common
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS
from brace.ground.errors import UsageError

STEPS = 20


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "identify",
        help=SUBCOMMANDS["identify"],
        description="Fits the model to a loading record, a stiffness table or a joint test; prints each parameter with "
        "its 90 % interval (not identifiable: infinite), correlations, the classes that the record "
        "cannot tell apart, and the share of joints and structure. Writes the fitted model.",
    )
    parser.add_argument("dataset", type=common.path, metavar="DATASET", help="folder with meta.toml and data.csv")
    common.add_model(parser, "the start, and the trust put in it")
    parser.add_argument("--out", type=common.path, required=True, metavar="FITTED.toml", help="the fitted model")
    mode = parser.add_mutually_exclusive_group()
    mode.add_argument(
        "--prior",
        dest="mode",
        action="store_const",
        const="prior",
        help="within the trust of [uncertainty] (default for loading records)",
    )
    mode.add_argument(
        "--free",
        dest="mode",
        action="store_const",
        const="free",
        help="compliances free, lengths, zeros and gain within their trust (default for tables)",
    )
    parser.add_argument(
        "--fit", action="append", default=[], metavar="KEY", help="also fit this key of limb.toml, free; repeatable"
    )
    parser.add_argument(
        "--only", action="append", default=[], metavar="KEY", help="fit this key and no others, free; repeatable"
    )
    parser.add_argument(
        "--faults",
        choices=("repair", "drop", "refuse"),
        default="repair",
        help="faulty entries: take the one repair that follows from the record and say so (default), "
        "leave their rows out, or refuse",
    )
    parser.add_argument(
        "--sigma",
        type=common.positive_stiffness,
        default=0.3,
        metavar="N_PER_MM",
        help="tables: one sigma of an entry of K, absolute part (default 0.3 N/mm)",
    )
    parser.add_argument(
        "--sigma-rel",
        type=common.ratio,
        default=0.1,
        metavar="RATIO",
        help="tables: relative part (default 0.1)",
    )
    parser.add_argument("--knee", choices=("up", "down"), default="up", help="tables that give r alone")
    common.add_json(parser)
    parser.set_defaults(run=run, mode="")


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.dataset import load_dataset
    from brace.ground.files import check_file, marked, refuse_written, write_file
    from brace.identify import report
    from brace.identify.run import Options, identify
    from brace.identify.table import Weight
    from brace.model import load_limb

    inputs = [arguments.model, arguments.dataset / "data.csv", arguments.dataset / "meta.toml"]
    check_file(arguments.out, inputs)  # before the work, not after
    refuse_written(arguments.out)
    options = Options(
        mode=arguments.mode or "",
        extra_keys=tuple(_keys_of("--fit", arguments.fit)),
        only_keys=tuple(_keys_of("--only", arguments.only)),
        faults=arguments.faults,
        knee=arguments.knee,
        weight=Weight(arguments.sigma, max(0.0, arguments.sigma_rel)),
    )
    model = load_limb(arguments.model)
    dataset = load_dataset(arguments.dataset)
    for fault in dataset.faults:
        common.say(f"data: {fault.sentence(dataset.csv_path)}")
    with common.progress("fitting", STEPS) as advance:
        result = identify(dataset, model, options, advance)
    for text in result.done_to_data:
        common.say(f"data: {text}")
    write_file(arguments.out, marked(result.model.to_toml(report.header(result))), inputs)
    if arguments.json:
        common.print_json({**report.as_json(result), "out": arguments.out})
    else:
        common.emit(report.as_text(result))
        common.say(f"fitted model -> {arguments.out}")
    return 0


def _keys_of(option: str, keys: list[str]) -> list[str]:
    """Keys to fit; a refusal names the option that gave them."""
    from brace.identify.parameters import checked_keys

    try:
        return checked_keys(keys)
    except UsageError as error:
        error.what = error.what.replace("--fit", option)
        error.next_step = error.next_step.replace("--fit", option)
        raise
