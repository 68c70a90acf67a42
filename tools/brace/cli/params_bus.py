"""`brace params push, pull, rollback`: the parameter block of a controller on a bus."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from brace.cli import common
from brace.cli.bus_options import add_bus, controller, undone_by_signal
from brace.cli.options import Subcommands

if TYPE_CHECKING:
    from brace.bus.controller import Controller
    from brace.params import Block


def add(actions: Subcommands) -> None:
    """Declares the actions."""
    parser = actions.add_parser(
        "push",
        help="a limb.toml or block to a controller",
        description="Writes a set of parameters to a controller: handed over, stored, read back and "
        "compared. If it is not "
        "the same afterwards, the set before is put back (exit code 7). A push that is interrupted leaves the set "
        "before in force. Node and bit rates take effect at the next start; a file without controller.node_id "
        "leaves the controller's own.",
    )
    parser.add_argument("file", type=common.path, metavar="FILE", help="limb.toml or block")
    add_bus(parser)
    common.add_json(parser)
    parser.set_defaults(run=_push)

    parser = actions.add_parser(
        "pull",
        help="a controller's set to limb.toml or " "block",
        description="Reads the set in force. --out FILE.bin is the block as it is, any other ending limb.toml; "
        "without --out "
        "limb.toml goes to stdout.",
    )
    add_bus(parser)
    parser.add_argument("--out", type=common.path, metavar="FILE", help="default: stdout")
    common.add_json(parser)
    parser.set_defaults(run=_pull)

    parser = actions.add_parser(
        "rollback",
        help="the set before the one in force",
        description="Puts the set before back in force. A second roll-back is refused: push the other set again.",
    )
    add_bus(parser)
    common.add_json(parser)
    parser.set_defaults(run=_rollback)


def block_of(arguments: argparse.Namespace) -> Block:
    """The set in force of the controller on --bus."""
    with controller(arguments) as device:
        return _download(device)


def with_node(block: Block, node: int) -> Block:
    """The same set for another node."""
    from brace.params.block import pack

    return pack(block.model.with_values({"controller.node_id": node}), block.sequence)


def _download(device: Controller) -> Block:
    with common.progress("reading back") as advance:
        return device.download(advance)


def _push(arguments: argparse.Namespace) -> int:
    from brace.bus.push import push
    from brace.params import read_either

    block = read_either(arguments.file)
    with undone_by_signal(), controller(arguments) as device:
        node = _own_node(device, block)
        if node is not None:
            block = with_node(block, node)
        with common.progress(f"pushing {arguments.file}") as advance:
            stored = push(device, block, advance)
        if arguments.json:
            common.print_json(
                {
                    "file": arguments.file,
                    "node": device.node,
                    "bytes": len(block.content),
                    "sequence": stored.sequence,
                    "parameter_crc": f"{stored.crc:08x}",
                    "verified": True,
                }
            )
        else:
            common.say(
                f"{arguments.file} -> {device.url}, node {device.node}: in force, read back the same; set number "
                f"{stored.sequence}, CRC {stored.crc:08x}"
            )
            if node is not None:
                common.say(f"note: the file gives no controller.node_id; the controller keeps {node}")
    return 0


def _own_node(device: Controller, block: Block) -> int | None:
    """The controller's number, where the set would take it away."""
    if int(block.model.number("controller.node_id")) != 0:
        return None
    own = int(device.read_entry("controller.node_id"))
    return own or None


def _pull(arguments: argparse.Namespace) -> int:
    from brace.ground.files import write_file

    with controller(arguments) as device:
        block = _download(device)
        where = f"{device.url}, node {device.node}"
    out: Path | None = arguments.out
    header = [f"from {where}: set number {block.sequence}, parameter CRC {block.identity:08x}"]
    text = block.model.to_toml(header)
    if out is not None:
        write_file(out, block.content if out.suffix == ".bin" else text)
    if arguments.json:
        parameters = {
            key: str(value) if value in (float("inf"),) else value
            for key, value in block.model.values.items()
        }
        common.print_json(
            {
                "out": out,
                "sequence": block.sequence,
                "parameter_crc": f"{block.identity:08x}",
                "parameters": {
                    key: value for key, value in parameters.items() if key not in ("format", "name")
                },
            }
        )
    elif out is None:
        common.emit(text.rstrip("\n"))
    else:
        common.say(f"{where} -> {out}: set number {block.sequence}, CRC {block.identity:08x}")
    return 0


def _rollback(arguments: argparse.Namespace) -> int:
    from brace.bus.push import configuration

    with undone_by_signal(), controller(arguments) as device:
        before = device.identify().parameter_crc
        with configuration(device):
            stored = device.rollback()
        if arguments.json:
            common.print_json(
                {
                    "node": device.node,
                    "sequence": stored.sequence,
                    "parameter_crc": f"{stored.crc:08x}",
                    "parameter_crc_before": f"{before:08x}",
                }
            )
        else:
            common.say(
                f"{device.url}, node {device.node}: CRC {before:08x} -> {stored.crc:08x}, set number {stored.sequence}"
            )
    return 0
