"""`brace demo`: the paper's table and a simulated limb, with nothing attached."""

from __future__ import annotations

import argparse
import itertools
import json
import shlex
import shutil
import sys
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
                    "stiffness; then has a simulated controller's own loading tests show what its model lacks, and "
                    "mends it; and hangs a payload on a simulated robot of four limbs until the foot slips that was "
                    "named before; and lets one of its knees go soft until the forces name it. Writes pictures, "
                    "tables, limb.toml, wire/, soft/ and facts.json into --out.")
    parser.add_argument("--out", type=common.path, default=Path("brace-demo"), metavar="DIR",
                        help="default: brace-demo")
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.demo.story import Story, narrate
    from brace.ground.files import OutputSet, check_folder

    check_folder(arguments.out, ["facts.json"])
    story = Story()
    show = common.say if arguments.json else common.emit
    with common.progress("fitting the table", STEPS) as advance:
        lines = narrate(story, advance)
        first = next(lines)  # narrate() fits the table before its first line; later lines say what runs
    for line in itertools.chain([first], lines):
        show(line)
    with OutputSet() as outputs:
        for name, content in story.files.items():
            outputs.add(arguments.out / name, content)
        outputs.add(arguments.out / "facts.json", json.dumps(common.json_ready(story.facts), indent=1) + "\n")
        outputs.commit()
    if arguments.json:
        common.print_json({**story.facts, "out": arguments.out})
        return 0
    names = [name for name in story.files if "/" not in name]
    reports = ("wire/wire-diagnosis/report.html", "soft/diagnosis/report.html")
    common.emit(f"-> {arguments.out}/: {', '.join([*names, 'facts.json', *reports])}")
    common.emit("Next, three commands to try:")
    for words in next_steps(arguments.out):
        common.emit(f"   {shlex.join(words)}")
    return 0


def next_steps(out: Path) -> list[list[str]]:
    """Commands that work where the demo was called, from the sources and from a release."""
    from brace.demo.paper_table import DATA

    called = sys.argv[0]
    brace = called if Path(called).name == "brace" and shutil.which("brace") != called else "brace"
    files = (out / "limb.toml", DATA / "paper-limb.toml", DATA / "paper-rig.toml")
    model, limb, rig = (_from_here(path) for path in files)
    return [
        [brace, "k", "--model", model, "--r", "300", "--phi", "-0.4"],
        [brace, "map", "--model", model, "--out", str(out / "map")],
        [brace, "simulate", "--model", limb, "--rig", rig, "--out", str(out / "loading-test")],
    ]


def _from_here(path: Path) -> str:
    here = Path.cwd()
    return str(path.relative_to(here) if path.is_relative_to(here) else path)
