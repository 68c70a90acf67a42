"""Requests and answers with one node of a CAN bus: tokens, repeats, and why nothing came."""

from __future__ import annotations

import contextlib
import random
import secrets
import time
from collections.abc import Iterator, Mapping

from brace.bus.controller import check_dictionary
from brace.bus.entries import index_of
from brace.bus.frame import NODE_MASK, Bus, EndOfLog, Frame
from brace.bus.ownership import BEGIN_S, COMMANDS, EARLY, LATE, LIFE_S, UNKNOWN, Owner, Reopening, entry_of
from brace.bus.refusal import BUSY, ORDER, error_of
from brace.bus.snapshot import Heartbeat, Joiner, Snapshot, heartbeat_of
from brace.ground.errors import DeviceFaultError, NoDeviceError, UsageError
from brace.wire.frames import (
    ANSWER_ID,
    ANSWERS,
    FD_GROUPS,
    FD_MESSAGES,
    GROUPS,
    MESSAGES,
    REFUSAL,
    REFUSED,
    REQUEST_ID,
    REQUESTS,
)
from brace.wire.layout import Value

ANSWER_S = 0.25
TRIES = 3
HEARTBEAT_S = 1.15  # a heartbeat comes each second
BUSY_S = 4.0  # a set that is being stored, a limb that goes back from a loading test: waited for
BUSY_POLL_S = 0.02
CHALLENGES, CHALLENGE_S = 5, 0.002  # a session that has ended gets its next challenge in a tick of the controller
EARLY_POLL_S = 1.0  # a commit that comes too soon after another: waited for
CONTESTED_S = 2.5  # other clients' forces come between ours and its question for so long at most
APART_S = 0.03  # between two questions that another client's came between
GATHER_S = 0.25  # for the other nodes of a bus, once one is heard
_SENT_BY_NODES = {
    ANSWER_ID,
    *(layout.identifier for layout in (*MESSAGES.values(), *FD_MESSAGES.values())),
    *(parts[0].identifier for parts in (*GROUPS.values(), *FD_GROUPS.values())),
}
_NOT_REPEATED = frozenset({"commit", "rollback"})  # whose second time is not the first
_LIFE = "sign_of_life"
_LIFE_TOKEN, _BEGIN_TOKEN, _COMMAND_TOKENS = 0, 15, 14  # lower four bits of tokens: signs of life, commands between
_FORCE, _FORCE_IN_SPACE, _IN_SPACE = "tip_force", "tip_force_in_space", "k_in_space_at_posture"
_ABOUT_FORCE = frozenset(  # a controller counts the force that was sent last, whoever sent it, and once
    layout.command
    for name, layout in REQUESTS.items()
    if name in (_FORCE, _FORCE_IN_SPACE, _IN_SPACE) or name.startswith("k_under_load_")
)


class _Refused(Exception):
    """The answer is a refusal."""

    def __init__(self, status: int, detail: int) -> None:
        super().__init__(status)
        self.status, self.detail = status, detail


class Session:
    """One node, all of whose frames are looked at while an answer is waited for."""

    def __init__(self, bus: Bus, node: int | None = None, key: bytes | None = None) -> None:
        self.bus = bus
        self.owner = Owner(key)
        self._is_bench = False
        self._master = secrets.randbelow(16) << 4  # the upper bits of tokens distinguish masters
        self._lives = False
        self._next_life_s = 0.0
        self._has_begun = False
        self.node = node or 0
        self.joiner = Joiner()
        self.heard: dict[int, float] = {}  # node -> when last
        self.heartbeats: dict[int, Heartbeat] = {}
        self.newest: dict[int, Snapshot] = {}
        self._token = secrets.randbelow(256)
        self._force_is_taken = False  # another client has asked about K under a force
        self.node = node if node is not None else self._find()

    @property
    def where(self) -> str:
        """For messages."""
        return f"{self.bus.url}, node {self.node}"

    # ---------------------------------------------------------------------------------------- listening

    def receive(self, timeout_s: float) -> Frame | None:
        """The next frame, looked at; None when none came in time. Signs of life go out meanwhile."""
        frame = self._next_frame(timeout_s)
        if frame is None:
            return None
        if frame.node and frame.identifier & ~NODE_MASK in _SENT_BY_NODES:
            self.heard[frame.node] = frame.time_s
        if frame.identifier & ~NODE_MASK == REQUEST_ID and frame.data[:1]:  # another's: our own do not come back
            self._force_is_taken |= frame.data[0] in _ABOUT_FORCE
        snapshot = self.joiner.add(frame)
        if snapshot is not None:
            self.newest[frame.node] = snapshot
        if frame.identifier == ANSWER_ID + self.node:
            self._hear_number(frame)
        beat = heartbeat_of(frame)
        if beat is not None:
            self.heartbeats[frame.node] = beat
        return frame

    def _hear_number(self, frame: Frame) -> None:
        """The answer to a sign of life, whoever gave it, brings the controller's number; a refused sign brings it, too."""
        answer = ANSWERS[_LIFE][0]
        if len(frame.data) != 8 or frame.data[0] not in (REFUSED, answer.command):
            return
        is_refused = frame.data[0] == REFUSED
        fields = (REFUSAL if is_refused else answer).decode(frame.data)
        if is_refused and fields["code"] != REQUESTS[_LIFE].command:
            return
        if not is_refused or fields["status"] == LATE:
            self.owner.hears(int(fields["detail" if is_refused else "number"] or 0))
        if frame.data[1] == self._master | _BEGIN_TOKEN and self.owner.begin_number is not None:
            self.owner.begin_number = None
            self._has_begun = not is_refused

    def _next_frame(self, timeout_s: float) -> Frame | None:
        until = time.monotonic() + timeout_s
        while self._lives:
            now = time.monotonic()
            if now >= self._next_life_s:
                self._give_sign_of_life()
            frame = self.bus.receive(max(0.0, min(until, self._next_life_s) - time.monotonic()))
            if frame is not None or time.monotonic() >= until:
                return frame
        return self.bus.receive(timeout_s)

    def listen(self, seconds: float) -> None:
        """Takes what comes for a time."""
        until = time.monotonic() + seconds
        try:
            while (left := until - time.monotonic()) > 0:
                self.receive(left)
        except EndOfLog:
            return

    def _find(self) -> int:
        """The one node of the bus."""
        until = time.monotonic() + HEARTBEAT_S
        try:
            while not self.heard and (left := until - time.monotonic()) > 0:
                self.receive(left)
        except EndOfLog:
            pass
        self.listen(GATHER_S if self.heard else 0.0)
        if not self.heard:
            why, way = self.bus.silence()
            raise NoDeviceError("no controller is heard", where=self.bus.url, why=why, next_step=way)
        nodes = sorted(self.heard)
        if len(nodes) > 1:
            raise UsageError(
                f"{len(nodes)} controllers are on this bus",
                where=self.bus.url,
                why=f"nodes {', '.join(map(str, nodes))} are heard",
                next_step=f"--node {nodes[0]}",
            )
        return nodes[0]

    # ------------------------------------------------------------------------------------------- owning

    @contextlib.contextmanager
    def living(self) -> Iterator[None]:
        """While the limb moves: signs of life go out whenever a frame is waited for. Without them it stands."""
        self._become_owner()
        self._lives = True
        self._give_sign_of_life()
        try:
            yield
        finally:
            self._lives = False

    def _become_owner(self) -> None:
        """Opens a session on a guarded board."""
        if self._is_bench or self.owner.is_open:
            return
        setting, low, high = (self._entry(name) for name in ("setting", "challenge_low", "challenge_high"))
        for _ in range(CHALLENGES):
            if low != UNKNOWN or high != UNKNOWN:
                break
            self.listen(CHALLENGE_S)
            low, high = self._entry("challenge_low"), self._entry("challenge_high")
        has_to_open = self.owner.begin(setting, low, high, self.where)
        self._is_bench = not self.owner.is_open
        if has_to_open:
            self.owner.hears(self._entry("life_number"))
            self._give_sign_of_life()

    def _entry(self, name: str) -> int:
        return int(self.ask("read_entry", {"index": index_of(name)})["value"] or 0)

    def _give_sign_of_life(self) -> None:
        self._next_life_s = time.monotonic() + LIFE_S
        life = self.owner.life()
        if life is None:
            return
        number, check = life
        token = self._master | (_LIFE_TOKEN if self.owner.begin_number is None else _BEGIN_TOKEN)
        data = REQUESTS[_LIFE].encode({"heard": number & 0xFFFF, "check": check}, token)
        self.bus.send(REQUEST_ID + self.node, data)

    def _begins(self, name: str, values: Mapping[str, Value], answer: Mapping[str, Value]) -> bool:
        """Whether what was asked for has begun, where it is a motion: our sign of life has to carry back the number of its
        answer while the controller waits for it."""
        is_end = name == "write_entry" and values.get("index") == entry_of("end_test")
        begin = answer.get("value" if is_end else "begin")
        if not self._lives or begin is None or (name == "write_entry" and not is_end):
            return True
        self._has_begun = False
        self.owner.begin_number = int(begin)
        self._give_sign_of_life()
        until = time.monotonic() + BEGIN_S
        while self.owner.begin_number is not None and (left := until - time.monotonic()) > 0:
            self.receive(left)
        self.owner.begin_number = None
        return self._has_begun

    def _sealed(self, name: str, values: Mapping[str, Value]) -> list[bytes]:
        """The frames of a command: its seal first, where there is one."""
        request = REQUESTS[name]
        if not self.owner.is_open:
            return [request.encode(values, self._token)]
        self._token = self.owner.next_counter() & 0xFF
        data = request.encode(values, self._token)
        seal = {"index": entry_of("seal_mac"), "value": self.owner.seal(data)}
        return [REQUESTS["write_entry"].encode(seal, self._token), data]

    # ------------------------------------------------------------------------------------------- asking

    def ask(
        self, name: str, values: Mapping[str, Value] | None = None, timeout_s: float = ANSWER_S
    ) -> dict[str, Value]:
        """The answer's fields, all parts together; repeated when nothing comes, where that does no harm."""
        try:
            return self._ask(name, values, timeout_s)
        except _Refused as refused:
            raise error_of(name, refused.status, refused.detail, self.where) from None

    def ask_under_force(
        self, force_n: Mapping[str, Value], name: str, values: Mapping[str, Value]
    ) -> dict[str, Value]:
        """Sends the controller a force, asks about K under it and returns the answer. Does both again when another
        client sent its own force in between, or when an answer was lost and the controller has forgotten the force."""
        until = time.monotonic() + CONTESTED_S
        while time.monotonic() < until:
            self._force_is_taken = False
            self.ask(_FORCE_IN_SPACE if name == _IN_SPACE else _FORCE, force_n)
            try:
                answer = self._ask(name, values, ANSWER_S)
                if not self._force_is_taken and answer.get("force_is_told") != 0:
                    return answer
            except _Refused as refused:
                if refused.status != ORDER and not self._force_is_taken:
                    raise error_of(name, refused.status, refused.detail, self.where) from None
            self.listen(random.uniform(0.0, APART_S))  # the other asks again too: not in step with it
        raise DeviceFaultError(
            "other clients asked for K under other forces all the time",
            where=self.where,
            why="a controller counts the force that was sent last, whoever sent it",
            next_step="once more",
        )

    def _ask(self, name: str, values: Mapping[str, Value] | None, timeout_s: float) -> dict[str, Value]:
        busy_until = time.monotonic() + BUSY_S
        tries = 1 if name in _NOT_REPEATED else TRIES
        reopening = Reopening()
        if name in COMMANDS:
            self._become_owner()
        while tries > 0:
            try:
                answer = self._ask_once(name, values or {}, timeout_s)
            except _Refused as refused:
                wait_s = reopening.wait_s(refused.status) if name in COMMANDS and self.owner.is_open else None
                if wait_s is not None:
                    self.listen(wait_s)
                    self.owner.forget()
                    self._become_owner()
                    continue
                if refused.status == EARLY:
                    self.listen(min(EARLY_POLL_S, refused.detail / 1000 + BUSY_POLL_S))
                    continue
                if refused.status != BUSY or time.monotonic() > busy_until:
                    raise
                self.listen(BUSY_POLL_S)
                continue
            tries -= 1
            if answer is None:
                continue
            if name in COMMANDS:
                self.owner.accepted()
            if self._begins(name, values or {}, answer):
                return answer
            if tries == 0:
                raise self._not_begun(name)
        raise self._no_answer(name)

    def _ask_once(self, name: str, values: Mapping[str, Value], timeout_s: float) -> dict[str, Value] | None:
        self._token = self._master | 1 + (self._token & 0xF) % _COMMAND_TOKENS
        request = REQUESTS[name]
        try:
            frames = self._sealed(name, values) if name in COMMANDS else [request.encode(values, self._token)]
        except ValueError as error:
            raise UsageError(
                f"{name}: {error}",
                where=self.where,
                why="the frame has no room for it",
                next_step="a value in this range",
            ) from None
        for data in frames:
            self.bus.send(REQUEST_ID + self.node, data)
        parts = {layout.command or 0: layout for layout in ANSWERS[name]}
        came: dict[int, dict[str, Value]] = {}
        until = time.monotonic() + timeout_s
        while (left := until - time.monotonic()) > 0:
            frame = self.receive(left)
            if frame is None or frame.identifier != ANSWER_ID + self.node or len(frame.data) != 8:
                continue
            if frame.data[1] != self._token:
                continue
            number = frame.data[0]
            if number == REFUSED:
                refused = REFUSAL.decode(frame.data)
                if refused["code"] == request.command:
                    raise _Refused(int(refused["status"] or 0), int(refused["detail"] or 0))
            if number in parts:
                fields = parts[number].decode(frame.data)
                if fields.get("index", values.get("index")) != values.get("index"):
                    continue  # the answer to the seal, a write_entry too: it has the command's token
                came[number] = fields
            if len(came) == len(parts):
                return {key: value for number in parts for key, value in came[number].items()}
        return None

    def _not_begun(self, name: str) -> DeviceFaultError:
        return DeviceFaultError(
            f"{name} was answered, and has not begun",
            where=self.where,
            why="the controller heard no sign of life within 130 ms of its answer",
            next_step="a link whose round trip is shorter than 80 ms; docs/security.md says what an owner does",
        )

    def _no_answer(self, name: str) -> NoDeviceError:
        """Nothing heard at all, others heard, or this node heard and silent on this: three different things.
        VersionMismatchError: its heartbeat reports another dictionary, so its answers have other numbers."""
        if self.node not in self.heartbeats:
            self.listen(HEARTBEAT_S - ANSWER_S)
        beat = self.heartbeats.get(self.node)
        if beat is not None:
            check_dictionary(beat.dictionary_hash, self.where)
        others = sorted(set(self.heard) - {self.node})
        if self.node in self.heard:
            why = f"it sends, and does not answer {name!r}"
            way = (
                "another firmware, or a bus so full that the request got no place: brace monitor shows rates"
            )
        elif others:
            why = f"nothing of node {self.node} is heard; nodes on this bus: {', '.join(map(str, others))}"
            way = f"--node {others[0]}"
        else:
            why, way = self.bus.silence()
        return NoDeviceError(f"node {self.node} does not answer", where=self.bus.url, why=why, next_step=way)
