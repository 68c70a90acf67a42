"""What comes from a bus, kept as the newest of every limb."""

from __future__ import annotations

import asyncio
import json
import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

from brace.bus.can_controller import CanController
from brace.bus.controller import Controller
from brace.bus.frame import Bus, EndOfLog, Frame
from brace.bus.log import LogBus
from brace.bus.modbus_controller import ModbusController
from brace.bus.open import open_bus
from brace.bus.session import Session
from brace.bus.url import BusUrl
from brace.bus.watch import NodeState, Watch
from brace.ground.errors import BraceError
from brace.live.card import Card, card_from, card_of
from brace.live.limb_view import limb_numbers, limb_words
from brace.live.stance_view import StanceFeed
from brace.bus.thinning import thinned
from brace.model import LimbModel

_AS_TEXT = json.JSONEncoder(allow_nan=False, check_circular=False, separators=(",", ":")).encode
_MODBUS_S = 0.033
_AGAIN_S = 2.0  # after a bus that went away, or a controller that did not answer


@dataclass
class Feed:
    """One bus, by `follow` and `step`. Errors are shown on the page, not raised: the bus may come back."""

    url: BusUrl
    bit_rate: int
    node: int | None = None
    models: dict[int, LimbModel] = field(default_factory=dict)  # by node; 0: of every node without one of its own
    stance: StanceFeed | None = None  # the body that these limbs carry; None: nobody has named one
    trouble: str = ""
    ended: str = ""  # why nothing comes any more: the end of a log

    def __post_init__(self) -> None:
        self.watch = Watch(self.url.text, self.node)
        self.cards: dict[int, Card] = {}
        self._words: dict[str, object] = {}
        self._words_text = ""
        self._ask_at_s: dict[int, float] = {}  # who was asked for a card and did not answer is asked again then
        self._held: list[Frame] = []  # of snapshots that have begun and may go on
        self._lent: tuple[Bus, asyncio.Future[int]] | None = None  # to `step`, which gives it back with a node to ask

    def messages(self) -> tuple[str, str]:
        """All limbs, for the page: first what seldom changes, which stays the same text until it does; then the
        numbers of now."""
        now_s = time.time() if self.url.kind != "log" else self.watch.last_s
        limbs = [(node, state, self.cards[node]) for node, state in sorted(self.watch.nodes.items())]
        words: dict[str, object] = {
            "bus": self.url.text, "trouble": self.trouble, "ended": self.ended,
            "words": [limb_words(*limb) for limb in limbs],
        }  # fmt: skip
        if words != self._words:
            self._words, self._words_text = words, _AS_TEXT(words)
        numbers: dict[str, object] = {"numbers": [limb_numbers(*limb, now_s) for limb in limbs]}
        if self.stance is not None:
            numbers["stance"] = self.stance.numbers
        return self._words_text, _AS_TEXT(numbers)

    def step(self) -> None:
        """Takes what has come since the last step, without waiting. Called by who serves the page, once for each
        update: the fewer wakeups, the less a page costs."""
        if self._lent is None:
            return
        bus, given_back = self._lent
        try:
            self._take_frames(bus)
            asked = self._whom_to_ask()
            if asked is None:
                return
            given_back.set_result(asked)
        except BraceError as error:
            given_back.set_exception(error)
        self._lent = None

    async def follow(self) -> None:
        """Opens the bus and asks what has to be asked, for as long as it is not cancelled. Whatever may take long is
        done in a thread."""
        while True:
            try:
                await (self._follow_modbus() if self.url.is_modbus else self._follow_can())
            except EndOfLog:
                self.ended = "the log has ended; this is its last picture"
                return
            except BraceError as error:
                self.trouble = error.render()
                await asyncio.sleep(_AGAIN_S)

    async def _follow_can(self) -> None:
        bus = await asyncio.to_thread(open_bus, self.url, self.bit_rate)
        try:
            self.trouble = ""
            while isinstance(bus, LogBus):
                self._take_frames(bus)
                await asyncio.sleep(0.0)
            while True:
                self._lent = bus, asyncio.get_running_loop().create_future()
                node = await self._lent[1]
                await asyncio.to_thread(self._ask, node, partial(_controller_on, bus, node))
        finally:
            self._lent = None
            bus.close()

    def _take_frames(self, bus: Bus) -> None:
        new, is_log = bus.receive_all(), isinstance(bus, LogBus)
        thin = thinned([*self._held, *new], may_hold=bool(new) and not is_log)
        self._held = thin.held
        for frame in thin.needed:
            self.watch.add(frame)
        self.watch.count(thin.counted)
        if self.stance is not None:
            self.stance.take(new, self.watch.last_s if is_log else time.time())
        for node in self.watch.nodes.keys() - self.cards.keys():
            self._look_up(node)

    async def _follow_modbus(self) -> None:
        device = await asyncio.to_thread(ModbusController, self.url)
        try:
            self._look_up(device.node)
            if self._whom_to_ask() is not None:
                await asyncio.to_thread(self._ask, device.node, lambda: device)
            state = self.watch.nodes.setdefault(device.node, NodeState())
            self.trouble = ""
            while True:
                snapshot = await asyncio.to_thread(
                    lambda: device.live()._replace(load=device.load(), sigma=device.sigma())
                )
                state.last_s = self.watch.last_s = snapshot.time_s
                self.watch.take(state, snapshot)
                await asyncio.sleep(_MODBUS_S)
        finally:
            device.close()

    def _look_up(self, node: int) -> None:
        """A limb's card, from a file; where there is none, the controller will be asked."""
        model = self.models.get(node, self.models.get(0))
        if model is not None:
            self.cards[node] = card_of(model)
        elif self.url.kind == "log":
            self.cards[node] = Card(why_not="a log answers no questions: give --model LIMB.toml")
        else:
            self.cards[node] = Card()
            self._ask_at_s[node] = 0.0

    def _whom_to_ask(self) -> int | None:
        return next((node for node, at_s in self._ask_at_s.items() if at_s <= time.monotonic()), None)

    def _ask(self, node: int, controller: Callable[[], Controller]) -> None:
        """The controller for its limb's card."""
        self.cards[node] = card_from(lambda: controller().download(lambda words: None).model)
        is_known = self.cards[node].lengths_mm is not None
        self._ask_at_s[node] = math.inf if is_known else time.monotonic() + _AGAIN_S


def _controller_on(bus: Bus, node: int) -> Controller:
    return CanController(Session(bus, node))
