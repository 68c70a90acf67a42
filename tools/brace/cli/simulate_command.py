"""`brace simulate`: a loading test on the simulated limb, written as a dataset."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from brace.cli import common


def add(commands: Any) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "simulate",
        help="a loading test on the simulated limb, written as a dataset",
        description="Plays the loading test of rig.toml on the limb of limb.toml (gaps, friction, creep, gravity, sensor "
        "and all) and writes meta.toml and data.csv. The same files and seed give the same bytes.",
    )
    common.add_model(parser, "the true limb")
    parser.add_argument(
        "--rig",
        type=Path,
        required=True,
        metavar="RIG.toml",
        help="poses, axes, steps, noise; brace/data/paper-rig.toml is an example",
    )
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder of the dataset")
    parser.add_argument("--seed", type=common.count(0, 2**63 - 1), help="instead of the rig file's seed")
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from dataclasses import replace

    from brace.dataset.write import write_dataset
    from brace.model import load_limb
    from brace.rig import load_rig
    from brace.simulate import simulate

    model = load_limb(arguments.model)
    rig = load_rig(arguments.rig)
    if arguments.seed is not None:
        rig = replace(rig, values={**rig.values, "seed": arguments.seed})
    meta, columns = simulate(model, rig)
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
