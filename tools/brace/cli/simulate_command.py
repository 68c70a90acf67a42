"""`brace simulate`: a loading test on the simulated limb, written as a dataset."""

from __future__ import annotations

import argparse
from pathlib import Path

from brace.cli import common
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS
from brace.ground.errors import BraceError, UsageError


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "simulate",
        help=SUBCOMMANDS["simulate"],
        description="Plays the loading test of rig.toml on the limb of limb.toml (gaps, friction, creep, gravity, "
        "sensor and all) and writes meta.toml and data.csv. The same files and seed give the same bytes.",
    )
    common.add_model(parser, "the true limb")
    parser.add_argument(
        "--rig",
        type=common.path,
        required=True,
        metavar="RIG.toml",
        help="poses, axes, steps, noise; brace/data/paper-rig.toml is an example",
    )
    parser.add_argument("--out", type=common.path, required=True, metavar="DIR", help="folder of the dataset")
    parser.add_argument(
        "--after",
        type=common.path,
        metavar="DATASET",
        help="a record that this test comes after: --out holds the rows of both, as one record",
    )
    parser.add_argument("--seed", type=common.count(0, 2**63 - 1), help="instead of the rig file's seed")
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from dataclasses import replace

    from brace.dataset import load_dataset
    from brace.dataset.write import write_dataset
    from brace.ground.files import check_folder
    from brace.model import load_limb
    from brace.rig.rig import load_rig
    from brace.rig.simulate import behind, joined, simulate

    model = load_limb(arguments.model)
    rig = load_rig(arguments.rig)
    if arguments.seed is not None:
        rig = replace(rig, values={**rig.values, "seed": arguments.seed})
    _refuse_measured(arguments.out)
    inputs = [arguments.model, arguments.rig]
    before = None
    if arguments.after is not None:
        before = load_dataset(arguments.after)
        before.require_sound()
        rig = behind(before, rig)
        inputs += [arguments.after / "meta.toml", arguments.after / "data.csv"]
    check_folder(arguments.out, ("meta.toml", "data.csv"), inputs)
    meta, columns = simulate(model, rig)
    if before is not None:
        meta, columns = joined(before, meta, columns)
    write_dataset(arguments.out, meta, columns)
    rows = len(columns["run"])
    if arguments.json:
        common.print_json(
            {
                "out": arguments.out,
                "rows": rows,
                "configurations": len(rig.poses),
                "columns": list(columns),
                "seed": rig.values["seed"],
            }
        )
    else:
        common.say(f"{rows} rows, {len(rig.poses)} configurations -> {arguments.out}")
    return 0


def _refuse_measured(folder: Path) -> None:
    """A dataset that `simulate` wrote may be written anew; a measured one is never replaced."""
    present = [folder / name for name in ("meta.toml", "data.csv") if (folder / name).is_file()]
    if present and not _is_simulated(folder / "meta.toml"):
        raise UsageError(
            "the output would replace a dataset that was not simulated",
            where=str(present[0]),
            why='its meta.toml does not say [source] what = "simulated"',
            next_step="choose another --out",
        )


def _is_simulated(meta: Path) -> bool:
    from brace import toml

    try:
        source = toml.read(meta, "dataset's meta.toml").content.get("source")
    except BraceError:
        return False
    return isinstance(source, dict) and source.get("what") == "simulated"
