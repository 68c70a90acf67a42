"""`brace monitor --web`: the same as a page in a browser on this computer."""

from __future__ import annotations

import argparse
import asyncio
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from brace.cli import common
from brace.cli.bus_options import ended_by_signal
from brace.ground.errors import EXIT_OK, UsageError

if TYPE_CHECKING:
    from brace.bus.url import BusUrl
    from brace.live.stance_view import StanceFeed
    from brace.model import LimbModel

_NODE_MOST = 127


def monitor_web(arguments: argparse.Namespace, url: BusUrl) -> int:
    """Until --seconds, Ctrl-C or SIGTERM."""
    try:
        from brace.live.feed import Feed
        from brace.live.server import HOST, Server
    except ModuleNotFoundError as error:
        raise UsageError(
            "the page cannot be served", where="brace monitor --web", why=str(error), next_step="pip install aiohttp"
        ) from None
    feed = Feed(url, arguments.bit_rate, arguments.node, models(arguments.model), _stance(arguments, url))
    until = time.monotonic() + (arguments.seconds if arguments.seconds is not None else float("inf"))
    try:
        with ended_by_signal() as ended:
            server = Server(feed, arguments.web)
            asyncio.run(server.run(_say_address, lambda: ended.is_set() or time.monotonic() >= until))
    except OSError as error:
        raise UsageError(
            f"port {arguments.web} of {HOST} cannot be opened",
            where="--web",
            why=error.strerror or str(error),
            next_step="--web 0 takes any free port, and prints which",
        ) from None
    return EXIT_OK


def _stance(arguments: argparse.Namespace, url: BusUrl) -> StanceFeed | None:
    if arguments.stance is None:
        return None
    if url.is_modbus or arguments.node is not None:
        raise UsageError(
            "--stance with " + ("one controller over Modbus" if url.is_modbus else "--node"),
            why="a stance listens to all of its limbs",
            next_step="--bus URL of their CAN bus, without --node",
        )
    from brace.live.stance_view import StanceFeed
    from brace.stance.stance_file import load_stance

    return StanceFeed(load_stance(arguments.stance), url.text)


def models(given: list[str]) -> dict[int, LimbModel]:
    """Limb models by node; 0: of every node that has none of its own."""
    from brace.model import load_limb

    found: dict[int, LimbModel] = {}
    for one in given:
        node, equals, path = one.partition("=")
        if not equals or not node.isdigit():
            node, path = "0", one
        if int(node) > _NODE_MOST:
            raise UsageError(
                f"there is no node {node}", where=f"--model {one}", why="nodes are 1 to 127",
                next_step="--model 1=LIMB.toml",
            )
        found[int(node)] = load_limb(Path(path))
    return found


def _say_address(address: str) -> None:
    common.emit(f"open {address} in a browser on this computer; Ctrl-C ends it")
    if sys.stdout is not None:
        sys.stdout.flush()
