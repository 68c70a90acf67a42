"""What comes from a bus, kept as the newest of every limb, by a thread of its own."""

from __future__ import annotations

import json
import math
import threading
import time
from collections.abc import Callable
from contextlib import suppress
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
from brace.errors import BraceError
from brace.live.card import Card, card_from, card_of
from brace.live.limb_view import limb_view
from brace.live.thinning import thinned
from brace.model import LimbModel

_AS_TEXT = json.JSONEncoder(allow_nan=False, separators=(",", ":")).encode
_POLL_S = 0.1
_PERIOD_S = 1.0 / 30.0  # a page's own, and shorter than the time within which a snapshot's frames are put together
_AT_ONCE_MOST = 500
_MODBUS_S = 0.033
_AGAIN_S = 2.0  # after a bus that went away, or a controller that did not answer


@dataclass
class Feed:
    """One bus, followed until `stop`. Errors are told on the page, not raised: the bus may come back."""

    url: BusUrl
    bit_rate: int
    node: int | None = None
    models: dict[int, LimbModel] = field(default_factory=dict)  # by node; 0: of every node without one of its own
    trouble: str = ""
    ended: str = ""  # why nothing comes any more: the end of a log

    def __post_init__(self) -> None:
        self.watch = Watch(self.url.text, self.node)
        self.cards: dict[int, Card] = {}
        self._ask_at_s: dict[int, float] = {}  # who was asked for a card and did not answer is asked again then
        self._lock = threading.Lock()
        self._held: list[Frame] = []  # of snapshots that have begun and may go on
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._run, name="brace bus", daemon=True)

    def start(self) -> None:
        """Begins to listen."""
        self._thread.start()

    def stop(self) -> None:
        """Ends within a second or two."""
        self._stopped.set()
        self._thread.join(timeout=5.0)

    def as_json(self) -> str:
        """All limbs, for the page."""
        now_s = time.time() if self.url.kind != "log" else self.watch.last_s
        with self._lock:
            limbs = [
                limb_view(node, state, self.cards.get(node, Card()), now_s)
                for node, state in sorted(self.watch.nodes.items())
            ]
        message = {"bus": self.url.text, "trouble": self.trouble, "ended": self.ended, "limbs": limbs}
        return _AS_TEXT(message)

    # ---------------------------------------------------------------------------------------- in the thread

    def _run(self) -> None:
        follow: Callable[[], None] = self._follow_modbus if self.url.is_modbus else self._follow_can
        while not self._stopped.is_set():
            try:
                follow()
            except EndOfLog:
                self.ended = "the log has ended; this is its last picture"
                return
            except BraceError as error:
                self.trouble = error.render()
                self._stopped.wait(_AGAIN_S)

    def _follow_can(self) -> None:
        bus = open_bus(self.url, self.bit_rate)
        try:
            self.trouble = ""
            is_log = isinstance(bus, LogBus)
            while not self._stopped.wait(0.0 if is_log else _PERIOD_S):
                self._take_frames(bus)
        finally:
            bus.close()

    def _take_frames(self, bus: Bus) -> None:
        """Those of one period together: the fewer wakeups, the less a page costs."""
        new, is_log = _waiting(bus), isinstance(bus, LogBus)
        thin = thinned([*self._held, *new], may_hold=bool(new) and not is_log)
        self._held = thin.held
        with self._lock:
            for frame, is_needed in thin.frames:
                if is_needed:
                    self.watch.add(frame)
                else:
                    self.watch.count(frame)
        for node in list(self.watch.nodes):
            if time.monotonic() >= self._ask_at_s.get(node, 0.0):
                self._learn(node, partial(_controller_on, bus, node), is_log)

    def _follow_modbus(self) -> None:
        device = ModbusController(self.url)
        try:
            self._learn(device.node, lambda: device, False)
            state = self.watch.nodes.setdefault(device.node, NodeState())
            self.trouble = ""
            while not self._stopped.wait(_MODBUS_S):
                snapshot = device.live()._replace(load=device.load())
                with self._lock:
                    state.last_s = self.watch.last_s = snapshot.time_s
                    self.watch.take(state, snapshot)
        finally:
            device.close()

    def _learn(self, node: int, controller: Callable[[], Controller], is_log: bool) -> None:
        """The limb's card: from a file, else from the controller."""
        model = self.models.get(node, self.models.get(0))
        if model is not None:
            self.cards[node] = card_of(model)
        elif is_log:
            self.cards[node] = Card(why_not="a log answers no questions: give --model LIMB.toml")
        else:
            self.cards[node] = card_from(lambda: controller().download(lambda words: None).model)
        is_known = self.cards[node].lengths_mm is not None
        self._ask_at_s[node] = math.inf if is_known or is_log else time.monotonic() + _AGAIN_S


def _waiting(bus: Bus) -> list[Frame]:
    """All frames that are there; where none is, the next one within a while. EndOfLog once there is none before it."""
    frames: list[Frame] = []
    wait_s = _POLL_S
    with suppress(EndOfLog):
        while len(frames) < _AT_ONCE_MOST and (frame := bus.receive(wait_s)) is not None:
            frames.append(frame)
            wait_s = 0.0
        return frames
    if not frames:
        raise EndOfLog
    return frames


def _controller_on(bus: Bus, node: int) -> Controller:
    return CanController(Session(bus, node))
