"""`brace predict`: a dataset's own load sequence played on a model."""

from __future__ import annotations

import argparse

from brace.cli import common
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "predict",
        help=SUBCOMMANDS["predict"],
        description="Writes one row per row of the dataset, in order, predicted columns only: fx_n,fz_n for loading "
        "sets (and encoder and gauge columns where the dataset has them), torque_n_mm for joint tests, K's "
        "columns in N/mm for stiffness tables.",
    )
    parser.add_argument("dataset", type=common.path, metavar="DATASET", help="folder with meta.toml and data.csv")
    common.add_model(parser)
    parser.add_argument(
        "--out", type=common.path, required=True, metavar="PRED.csv", help="file of the predicted columns"
    )
    parser.add_argument(
        "--tip-height-mm",
        type=common.length,
        metavar="MM",
        help="stiffness tables that give r alone: height of the tip; default: the one that fits best",
    )
    parser.add_argument(
        "--knee", choices=("up", "down"), default="up", help="stiffness tables that give r alone"
    )
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    import numpy as np

    from brace.dataset import load_dataset
    from brace.ground.files import check_file, write_file
    from brace.model import load_limb
    from brace.rig.predict import predict, require_sound_inputs

    inputs = [arguments.model, arguments.dataset / "data.csv", arguments.dataset / "meta.toml"]
    check_file(arguments.out, inputs)  # before the work, not after
    model = load_limb(arguments.model)
    dataset = load_dataset(arguments.dataset)
    for fault in require_sound_inputs(dataset):
        common.say(f"note: {fault.sentence(dataset.csv_path)} (not used here)")
    prediction = predict(dataset, model, knee=arguments.knee, tip_height_mm=arguments.tip_height_mm)
    for note in prediction.notes:
        common.say(f"note: {note}")
    columns = prediction.columns
    texts = [[f"{value:.9g}" for value in (values + 0.0).tolist()] for values in columns.values()]
    lines = [",".join(columns), *(",".join(row) for row in zip(*texts))]
    write_file(arguments.out, "\n".join(lines) + "\n", inputs)
    gap = {
        f"rms_gap_{name}": float(np.sqrt(np.nanmean((values - dataset[name]) ** 2)))
        for name, values in columns.items()
        if name in dataset and not np.isnan(dataset[name]).all()
    }
    if arguments.json:
        common.print_json(
            {
                "rows": dataset.rows,
                "columns": list(columns),
                "out": arguments.out,
                **gap,
                "notes": list(prediction.notes),
            }
        )
    else:
        shown = ", ".join(f"{name.removeprefix('rms_gap_')} {value:.4g}" for name, value in gap.items())
        common.say(f"{dataset.rows} rows -> {arguments.out}; rms gap to the measured: {shown}")
    return 0
