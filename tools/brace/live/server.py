"""The page's server: this computer only, one page, one stream of messages."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import files
from typing import TYPE_CHECKING

from aiohttp import WSMsgType, web

if TYPE_CHECKING:
    from brace.live.feed import Feed

HOST = "127.0.0.1"
UPDATES_PER_S = 30.0  # the time between two is shorter than that within which a snapshot's frames are put together
_WAITING_BYTES_MOST = 20_000  # of a reader: below the mark at which sending would wait for it
_PAGE = {
    "/": ("index.html", "text/html"),
    "/page.css": ("page.css", "text/css"),
    "/page.js": ("page.js", "text/javascript"),
    "/limb.js": ("limb.js", "text/javascript"),
    "/stance.js": ("stance.js", "text/javascript"),
}
_HEADERS = {
    "Content-Security-Policy":
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src data:",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
}


@dataclass
class _Reader:
    """One browser."""

    transport: asyncio.WriteTransport
    words: str = ""  # the words that were sent to this browser last


class Server:
    """Serves until `run`'s caller ends it. A browser on another computer, and a page of another site, get nothing."""

    def __init__(self, feed: Feed, port: int) -> None:
        self._feed = feed
        self._port = port
        self._readers: dict[web.WebSocketResponse, _Reader] = {}

    async def run(self, tell: Callable[[str], None], is_over: Callable[[], bool]) -> None:
        """tell: is given the page's address once it can be opened. OSError: the port is taken."""
        application = web.Application()
        for path in _PAGE:
            application.router.add_get(path, self._page)
        application.router.add_get("/live", self._live)
        runner = web.AppRunner(application, access_log=None)
        await runner.setup()
        try:
            site = web.TCPSite(runner, HOST, self._port)
            await site.start()
            self._port = runner.addresses[0][1]
            tell(f"http://{HOST}:{self._port}/")
            following = asyncio.create_task(self._feed.follow())
            due_s = asyncio.get_running_loop().time()
            while not is_over():
                now_s = asyncio.get_running_loop().time()
                due_s = max(due_s + 1.0 / UPDATES_PER_S, now_s)  # after a pause nothing is caught up with
                await asyncio.sleep(due_s - now_s)
                self._feed.step()
                await self._update()
                if following.done():
                    following.result()  # raises what nobody has thought of
        finally:
            for reader in list(self._readers):
                await reader.close()
            await runner.cleanup()

    def _check(self, request: web.Request) -> None:
        """A name that is not this computer's own comes from a page that only pretends to be here."""
        names = {f"{name}:{self._port}" for name in (HOST, "localhost")}
        origin = request.headers.get("Origin")
        if request.host not in names or (origin is not None and origin.removeprefix("http://") not in names):
            raise web.HTTPForbidden(text="this page is for a browser on the same computer")

    async def _page(self, request: web.Request) -> web.Response:
        self._check(request)
        name, kind = _PAGE[request.path]
        text = (files("brace.live") / "page" / name).read_text(encoding="utf-8")
        return web.Response(text=text, content_type=kind, headers=_HEADERS)

    async def _live(self, request: web.Request) -> web.WebSocketResponse:
        self._check(request)
        reader = web.WebSocketResponse(compress=False, heartbeat=20.0)
        await reader.prepare(request)
        if not isinstance(request.transport, asyncio.WriteTransport):
            return reader  # it has gone already
        self._readers[reader] = _Reader(request.transport)
        try:
            async for message in reader:  # nothing is asked of us; this notices that the reader has gone
                if message.type == WSMsgType.ERROR:
                    break
        finally:
            self._readers.pop(reader, None)
        return reader

    async def _update(self) -> None:
        """Puts all limbs into text once, for all readers. A reader gets the words only if they have changed since it
        got them last. A slow reader misses some numbers; the others do not wait for it."""
        if not self._readers:
            return
        words, numbers = self._feed.messages()
        for stream, reader in list(self._readers.items()):
            if stream.closed or reader.transport.get_write_buffer_size() >= _WAITING_BYTES_MOST:
                continue
            with contextlib.suppress(ConnectionError):
                if reader.words != words:
                    await stream.send_str(words)
                    reader.words = words
                await stream.send_str(numbers)
