"""`brace dbc`: the frames of the nodes on a bus as a CAN database."""

from __future__ import annotations

import argparse

from brace.cli import common
from brace.cli.options import Subcommands, refused
from brace.cli.subcommands import SUBCOMMANDS


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    from brace.wire.dbc import NODE_MOST

    parser = commands.add_parser(
        "dbc",
        help=SUBCOMMANDS["dbc"],
        description="Writes a DBC that decodes the frames of these controllers. With several nodes, the names of "
        "messages and senders end in the node's number: stiffness_a_3.",
    )
    parser.add_argument(
        "--nodes", type=_node, nargs="+", default=[1], metavar="N",
        help=f"their numbers, 1 to {NODE_MOST}; default 1",
    )  # fmt: skip
    parser.add_argument("--fd", action="store_true", help="the frames of CAN FD; read it beside the one without")
    parser.add_argument("--out", type=common.path, metavar="FILE.dbc", help="default: standard output")
    common.add_json(parser)
    parser.set_defaults(run=run)


def _node(text: str) -> int:
    from brace.wire.dbc import NODE_MOST

    if "," in text:
        raise refused(f"{text!r} is not one number", "blanks separate numbers", f"OPTION {text.replace(',', ' ')}")
    return common.count(1, NODE_MOST)(text)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.ground.errors import UsageError
    from brace.ground.files import OutputSet
    from brace.wire.dbc import CLASSIC, FD, for_nodes

    twice = sorted({node for node in arguments.nodes if arguments.nodes.count(node) > 1})
    if twice:
        raise UsageError(
            f"--nodes names {', '.join(map(str, twice))} twice",
            why="two controllers of one bus have different numbers",
            next_step="give each number once",
        )
    text = for_nodes((FD if arguments.fd else CLASSIC).read_text(), arguments.nodes)
    reported = {"nodes": arguments.nodes, "fd": arguments.fd}
    if arguments.out is None:
        if arguments.json:
            common.print_json({**reported, "dbc": text})
        else:
            common.emit(text.rstrip("\n"))
        return 0
    with OutputSet() as outputs:
        outputs.add(arguments.out, text)
        outputs.commit()
    if arguments.json:
        common.print_json({**reported, "written": [arguments.out]})
    else:
        common.say(f"-> {arguments.out}")
    return 0
