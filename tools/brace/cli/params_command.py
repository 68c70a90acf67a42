"""`brace params`: a limb model as the controller's parameter block, and back; in files and on a controller."""

from __future__ import annotations

import argparse
import math

from brace.cli import common, params_bus
from brace.cli.bus_options import add_bus
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS

_SEQUENCE_MAX = (1 << 32) - 1


def add(commands: Subcommands) -> None:
    """Declares the subcommand and its actions."""
    parser = commands.add_parser(
        "params",
        help=SUBCOMMANDS["params"],
        description="The parameter block is what a controller keeps: every number of limb.toml (docs/limb-keys.md) in "
        "32 bits, with a schema hash, a sequence number and a CRC. Packed and unpacked by the firmware's own C.",
    )
    actions = parser.add_subparsers(metavar="ACTION", dest="action")
    _add_pack(actions)
    _add_unpack(actions)
    _add_diff(actions)
    params_bus.add(actions)
    parser.set_defaults(run=lambda _arguments: _help(parser))


def _help(parser: argparse.ArgumentParser) -> int:
    import sys

    from brace.ground.errors import EXIT_USAGE

    parser.print_help(sys.stderr)
    return EXIT_USAGE


def _add_pack(actions: Subcommands) -> None:
    parser = actions.add_parser("pack", help="limb.toml to block", description="Writes the block of a limb model.")
    common.add_model(parser)
    parser.add_argument("--out", type=common.path, required=True, metavar="BLOCK.bin", help="file of the block")
    parser.add_argument(
        "--sequence",
        type=common.count(0, _SEQUENCE_MAX),
        default=1,
        metavar="N",
        help="the set's number (default 1); a controller that stores it counts on from its own",
    )
    common.add_json(parser)
    parser.set_defaults(run=_pack)


def _add_unpack(actions: Subcommands) -> None:
    parser = actions.add_parser(
        "unpack",
        help="block to limb.toml",
        description="Writes a block as limb.toml, to --out or to stdout: what differs from the format's defaults, in "
        "the fewest decimals that the controller reads as the same float. Packing it again gives the same "
        "bytes. A block has no room for the limb's name.",
    )
    parser.add_argument("block", type=common.path, metavar="BLOCK.bin", help="file of the block")
    parser.add_argument("--out", type=common.path, metavar="LIMB.toml", help="default: stdout")
    common.add_json(parser)
    parser.set_defaults(run=_unpack)


def _add_diff(actions: Subcommands) -> None:
    parser = actions.add_parser(
        "diff",
        help="where two sets differ",
        description="Compares two sets as a controller would hold them; each is a limb.toml or a block. With --bus the "
        "second is what a controller has in force. Exit code 0 whether they differ or not, unless --check "
        "is given.",
    )
    parser.add_argument("first", type=common.path, metavar="A", help="limb.toml or block")
    parser.add_argument("second", type=common.path, nargs="?", metavar="B", help="limb.toml or block; or --bus")
    add_bus(parser, required=False)
    parser.add_argument("--check", action="store_true", help="exit code 1 when they differ")
    common.add_json(parser)
    parser.set_defaults(run=_diff)


def _pack(arguments: argparse.Namespace) -> int:
    from brace.ground.files import write_file
    from brace.model import load_limb
    from brace.params import pack
    from brace.wire.names import SCHEMA_HASH

    model = load_limb(arguments.model)
    block = pack(model, arguments.sequence)
    write_file(arguments.out, block.content, [arguments.model])
    for change in block.rounded:
        common.say(
            f"note: {change.key} = {change.given:g} is held as {change.held:g}: below what a 32-bit float can resolve"
        )
    if arguments.json:
        common.print_json(
            {
                "out": arguments.out,
                "bytes": len(block.content),
                "sequence": block.sequence,
                "schema_hash": f"{SCHEMA_HASH:08x}",
                "parameter_crc": f"{block.identity:08x}",
                "rounded": [{"key": c.key, "given": c.given, "held": c.held} for c in block.rounded],
            }
        )
    else:
        common.say(
            f"{model.name} -> {arguments.out}: {len(block.content)} bytes, sequence {block.sequence}, parameter CRC "
            f"{block.identity:08x}; values are rounded to 32-bit floats, 6e-8 of each at most"
        )
    return 0


def _unpack(arguments: argparse.Namespace) -> int:
    from brace.ground.files import write_file
    from brace.params import read_block

    block = read_block(arguments.block)
    header = [f"from a parameter block: sequence {block.sequence}, parameter CRC {block.identity:08x}"]
    text = block.model.to_toml(header)
    if arguments.out is not None:
        write_file(arguments.out, text, [arguments.block])
    if arguments.json:
        common.print_json(
            {
                "sequence": block.sequence,
                "parameter_crc": f"{block.identity:08x}",
                "out": arguments.out,
                "parameters": {
                    key: _shown(value) for key, value in block.model.values.items() if key not in ("format", "name")
                },
            }
        )
    elif arguments.out is None:
        common.emit(text.rstrip("\n"))
    else:
        common.say(
            f"{arguments.block} -> {arguments.out}: sequence {block.sequence}, parameter CRC {block.identity:08x}"
        )
    return 0


def _diff(arguments: argparse.Namespace) -> int:
    from brace.ground.errors import EXIT_CHECK_FAILED, UsageError
    from brace.params import differences, read_either

    if (arguments.second is None) == (arguments.bus is None):
        raise UsageError(
            "one set against one other",
            where="params diff",
            why="the second set is a file B or the controller on --bus, one of the two",
            next_step="brace params diff A B, or brace params diff A --bus can0",
        )
    first = read_either(arguments.first)
    if arguments.second is None:
        second = params_bus.block_of(arguments)
        node = int(second.model.number("controller.node_id"))
        if int(first.model.number("controller.node_id")) == 0 and node != 0:
            first = params_bus.with_node(first, node)  # as a push would
    else:
        second = read_either(arguments.second)
    found = differences(first, second)
    if arguments.json:
        common.print_json(
            {
                "differences": [
                    {"key": d.key, "unit": d.unit, "a": _shown(d.first), "b": _shown(d.second)} for d in found
                ]
            }
        )
    elif found:
        width = max(len(d.key) for d in found)
        for d in found:
            common.emit(f"{d.key:{width}}  {_shown(d.first)!s:>14}  {_shown(d.second)!s:>14}  {d.unit}".rstrip())
    else:
        common.say("nothing differs, as a controller would hold them")
    return EXIT_CHECK_FAILED if found and arguments.check else 0


def _shown(value: object) -> object:
    """JSON has no word for what is not finite; the format's own is a text."""
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value
