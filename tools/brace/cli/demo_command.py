"""`brace demo`: the paper's table and a simulated limb, with nothing attached."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from brace.cli import common
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS

STEPS = 20


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "demo", help=SUBCOMMANDS["demo"],
        description="Takes the paper's table as printed, finds its faults, identifies the limb, and draws the paper's "
                    "figures: eigenvalues over r, ellipses, the cyclic test with its zero-force shift, the choice of "
                    "stiffness; then has a simulated controller's own loading tests tell what its model lacks, and "
                    "mends it. Writes pictures, table.csv, limb.toml, wire/ and facts.json into --out.")
    parser.add_argument("--out", type=common.path, default=Path("brace-demo"), metavar="DIR",
                        help="default: brace-demo")
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.demo.story import Story, tell
    from brace.files import OutputSet, check_folder

    check_folder(arguments.out, ["facts.json"])
    story = Story()
    show = common.say if arguments.json else common.emit
    with common.progress("fitting the table", STEPS) as advance:
        for line in tell(story, advance):
            show(line)
    with OutputSet() as outputs:
        for name, content in story.files.items():
            outputs.add(arguments.out / name, content)
        outputs.add(arguments.out / "facts.json", json.dumps(common.json_ready(story.facts), indent=1) + "\n")
        outputs.commit()
    if arguments.json:
        common.print_json({**story.facts, "out": arguments.out})
        return 0
    model = arguments.out / "limb.toml"
    names = [name for name in story.files if "/" not in name]
    common.emit(f"-> {arguments.out}/: {', '.join([*names, 'facts.json'])}, wire/wire-diagnosis/report.html")
    common.emit("Next, three commands to try:")
    common.emit(f"   .venv/bin/brace k --model {model} --r 300 --phi -0.4")
    common.emit(f"   .venv/bin/brace map --model {model} --out {arguments.out}/map")
    common.emit("   .venv/bin/brace simulate --model tools/brace/data/paper-limb.toml "
                f"--rig tools/brace/data/paper-rig.toml --out {arguments.out}/loading-test")
    return 0
