"""A controller over Modbus RTU or TCP."""

from __future__ import annotations

import contextlib
import random
import struct
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, TypeVar

from brace.bus.controller import (
    NO_FORCE,
    Advance,
    Force,
    Identity,
    SpaceForce,
    StiffnessAnswer,
    Stored,
    check_dictionary,
)
from brace.bus.drift import TAKE_UPS, Drift, drift_of, take_up_of
from brace.bus.interval import Interval, interval_of
from brace.bus.load import Load, load_of
from brace.bus.modbus_line import connected
from brace.bus.modbus_values import (
    ASKED,
    AT_ONCE,
    BY_NAME,
    DRIFT,
    ENGAGED,
    LOAD,
    INTERVAL,
    SIGMA,
    SPACE,
    TAKE_UP_OF,
    bit_names,
    code_word,
    decoded,
)
from brace.bus.ownership import LATE, LIFE_S, NOT_OPEN, UNKNOWN, Owner, Reopening, register_of
from brace.bus.refusal import STORE, error_of, no_coxa_joint, no_equilibrium
from brace.bus.sigma import Sigma, sigma_of
from brace.bus.snapshot import Snapshot
from brace.bus.space import SpaceAnswer, SpaceSnapshot, space_answer, space_snapshot
from brace.bus.url import BusUrl
from brace.ground.errors import BraceError, DeviceFaultError, NoDeviceError
from brace.wire.codes import FLAG
from brace.wire.layout import Value
from brace.wire.names import PARAMETERS
from brace.wire.register import Register
from brace.wire.registers import REGISTERS

if TYPE_CHECKING:
    from pymodbus.pdu import ModbusPDU

    from brace.params import Block

_Answer = TypeVar("_Answer")

COMMIT_S = 2.5
BUSY_S = 2.5  # as long as a commit may take
APART_S = 0.03  # between two questions that another client's came between
_BLOCK = 120  # registers in a request; 125 may be read, 123 written
_KEY = 0xC0DE0000
_POSITIVE, _NEGATIVE = 256, 512  # sides of the play, in take_up's register
_INDEX = {parameter.key: parameter.index for parameter in PARAMETERS}
_PARAMETERS = sorted((r for r in REGISTERS if r.table == "holding" and r.access == "rw"), key=lambda r: r.address)
_PLACES = [_INDEX[r.name] for r in _PARAMETERS]  # by register: a parameter's place in the block
_FORCES = (("fx_n", "x"), ("fz_n", "z"), ("low_n", "low"), ("high_n", "high"))
_EXCEPTIONS = {
    1: "not in its mode of now, or no such function",
    2: "no such registers",
    3: "a value that is refused",
    4: "the controller failed at it",
    5: "it is at work on it",
    6: "busy",
}
_STORING, _STORE_REFUSED = 1, 256  # what `commit` and `rollback` read: at work; this less the store's refusal
_BUSY, _NOT_OURS = 6, 7
_WRITE_BLOCK = 16
_COMMITS = ("commit", "commit_crc")
EARLY_S = 30.0  # the controller takes a commit each 10 s of its time, which an emulated one may stretch
_BEGIN_TRIES = 3
_NO_SUCH_UNIT = (10, 11)  # a gateway's words: no path to it, no answer from it


class _BusyError(DeviceFaultError):
    """Exception 6: the same request may be asked again."""


class _NotTakenError(DeviceFaultError):
    """Exception 7 for want of a session or of a seal: the session may have ended."""

    status = 0

    @classmethod
    def of(cls, rejection: BraceError, status: int) -> _NotTakenError:
        error = cls(rejection.what, where=rejection.where, why=rejection.why, next_step=rejection.next_step)
        error.status = status
        return error


class ModbusController:
    """One unit. The dictionary is compared before anything else is asked."""

    def __init__(self, url: BusUrl, key: bytes | None = None) -> None:
        self.url = url.text
        self._owner = Owner(key)
        self._is_bench = False
        self._lives = False
        self._next_life_s = 0.0
        self._url = url
        self._line = connected(url)
        try:
            self.node = url.unit
            self._check_words()
            self.identify()
            self.node = self._holding("controller.node_id")
        except BaseException:
            self.close()
            raise

    def _check_words(self) -> None:
        """The two registers whose values are known: is it a controller of ours, and are its words in order?"""
        words = self._read("input", 0, 4)
        if words != struct.unpack(">4H", struct.pack(">fI", 12345.5, 0x01020304)):
            raise NoDeviceError(
                "it answers, and is no controller of ours",
                where=self.url,
                why=f"the probe registers hold {' '.join(f'{word:04x}' for word in words)}, not 4640 e600 0102 0304",
                next_step="check host, port and unit",
            )

    def identify(self) -> Identity:
        """From the input registers."""
        values = self._input()
        version = int(values["firmware_version"] or 0)
        text = f"{version >> 16}.{version >> 8 & 0xFF}.{version & 0xFF}"
        check_dictionary(int(values["dictionary_hash"] or 0), self.url, text)
        origin = code_word("parameter_origin", values)
        return Identity(
            self.node, text, int(values["dictionary_hash"] or 0), int(values["parameter_crc"] or 0), origin
        )

    def live(self) -> Snapshot:
        """One read is one snapshot. A read does not hold K in space too: that is read next, and is of one snapshot, its
        own."""
        v = self._input()
        valid = bool(v["k_is_valid"])
        age = v["age_us"]
        faults = tuple(name.lower() for name in bit_names("faults", v))
        has_coxa_joint = bool(v["k_is_in_space"]) or v["theta0"] is not None or "sensor_coxa" in faults
        return Snapshot(
            node=self.node,
            time_s=time.time(),
            sequence=int(v["sequence"] or 0),
            k_xx=v["k_xx"] if valid else None,
            k_xz=v["k_xz"] if valid else None,
            k_zz=v["k_zz"] if valid else None,
            flags=bit_names("flags", v),
            age_ms=None if age is None else age / 1000,
            play=(code_word("play_femur", v), code_word("play_tibia", v)),
            mode=code_word("mode", v),
            has_posture=True,
            lambda_min=v["lambda_min"],
            lambda_max=v["lambda_max"],
            stiff_axis=v["stiff_axis"],
            theta1=v["theta1"],
            theta2=v["theta2"],
            parameter_tag=int(v["parameter_crc"] or 0) & 0xFFFF,
            faults=faults,
            space=self._space() if has_coxa_joint else None,
            adds="posture",
        )

    def _space(self) -> SpaceSnapshot:
        v = self._values_of(SPACE)
        if not v["k_is_in_space"]:
            v |= {name: None for name in v if name.startswith("space_k_")}
        return space_snapshot(v, "space_")

    def k_in_space_at_posture(
        self, theta0_rad: float, theta1_rad: float, theta2_rad: float, force_n: SpaceForce = NO_FORCE
    ) -> SpaceAnswer:
        """Written, then read."""
        v = self._ask("asked_space_force_x", ">ffffff", *force_n, theta0_rad, theta1_rad, theta2_rad)
        if v["asked_space_k_xx"] is None and v["asked_space_flags"] is None:
            if self._values_of(SPACE)["theta0"] is None:
                raise no_coxa_joint(self.url, "theta0 reads as not known")
            raise no_equilibrium(self.url, "the answer's registers hold no K")
        return space_answer(v, "asked_space_", "moved_")

    def drift(self) -> Drift:
        """What the check of model against measurement knows."""
        return drift_of(self._values_of(DRIFT), "drift_", "_ratio")

    def take_ups(self) -> dict[str, str]:
        """How each joint's last take-up went."""
        v = self._values_of(TAKE_UP_OF)
        return {joint: take_up_of(int(v[f"take_up_{joint}"] or 0)) for joint in TAKE_UPS}

    def k_at_posture(self, theta1_rad: float, theta2_rad: float, force_n: Force | None = None) -> StiffnessAnswer:
        """Written, then read."""
        if force_n is None:
            return self._stiffness(self._ask("asked_theta1", ">ff", theta1_rad, theta2_rad))
        return self._under_load(self._ask("asked_posture_force_x", ">ffff", *force_n, theta1_rad, theta2_rad))

    def k_at_tip(self, x_mm: float, z_mm: float, knee_up: bool, force_n: Force | None = None) -> StiffnessAnswer:
        """From the femur axis."""
        if force_n is None:
            return self._stiffness(self._ask("asked_tip_x", ">ffI", x_mm, z_mm, int(not knee_up)))
        return self._under_load(self._ask("asked_tip_force_x", ">ffffI", *force_n, x_mm, z_mm, int(not knee_up)))

    def engaged_k(self) -> tuple[Value, Value, Value] | None:
        """Of one read."""
        v = self._values_of(ENGAGED)
        return v["engaged_k_xx"], v["engaged_k_xz"], v["engaged_k_zz"]

    def load(self) -> Load:
        """Of one read."""
        return load_of(self._values_of(LOAD))

    def interval(self) -> Interval:
        """Of one read."""
        return interval_of(self._values_of(INTERVAL))

    def sigma(self) -> Sigma:
        """Of one read."""
        return sigma_of(self._values_of(SIGMA), "sigma_")

    def set_gravity(self, direction_rad: float, lean_rad: float) -> tuple[Value, Value]:
        """Volatile."""
        v = self._owning(lambda: self._ask("asked_gravity_direction", ">ff", direction_rad, lean_rad))
        return v["taken_gravity_direction"], v["taken_gravity_lean"]

    def sag_for_load(self, fx_n: float, fz_n: float) -> dict[str, Value]:
        """Displacement of the tip [mm] under a force on it, with the K of now."""
        v = self._ask("asked_load_x", ">ff", fx_n, fz_n)
        return {"dx_mm": v["asked_sag_x"], "dz_mm": v["asked_sag_z"]}

    def contact_force(self, dx_mm: float, dz_mm: float) -> dict[str, Value]:
        """Force [N] that holds the tip at a displacement, and what any displacement of its size meets."""
        v = self._ask("asked_dx", ">ff", dx_mm, dz_mm)
        return {name: v[f"asked_force_{of}"] for name, of in _FORCES}

    def _ask(self, first: str, form: str, *values: float) -> dict[str, Value]:
        """What belongs to one question is written at once; all answers. They are to it if it still reads back."""
        data = struct.pack(form, *values)
        address, words = BY_NAME[first].address, struct.unpack(f">{len(data) // 2}H", data)
        until = time.monotonic() + BUSY_S
        while True:
            self._write(address, words)
            answers = self._read("input", ASKED[0].address, 2 * len(ASKED))
            if self._read("holding", address, len(words)) == words:
                return decoded(ASKED, answers)
            if time.monotonic() > until:
                raise DeviceFaultError(
                    "other clients asked other questions all the time",
                    where=self.url,
                    why="answers are to the question that was asked last, whoever asked it",
                    next_step="once more, or over CAN, where each has its own answer",
                )
            time.sleep(random.uniform(0.0, APART_S))  # the other asks again too: not in step with it

    @staticmethod
    def _stiffness(v: dict[str, Value], of: str = "asked_") -> StiffnessAnswer:
        names = ("k_xx", "k_xz", "k_zz", "lambda_min", "lambda_max", "stiff_axis")
        flags = FLAG.names_of_bits(int(v[f"{of}flags"] or 0))
        return StiffnessAnswer(**{name: v[f"{of}{name}"] for name in names}, flags=flags)

    def _under_load(self, v: dict[str, Value]) -> StiffnessAnswer:
        if v["asked_loaded_k_xx"] is None:
            raise no_equilibrium(self.url, "the answer's registers hold no K")
        moved_x, moved_z, factor = (v[f"asked_{name}"] for name in ("moved_x", "moved_z", "buckling_factor"))
        return replace(self._stiffness(v, "asked_loaded_"), moved_x=moved_x, moved_z=moved_z, buckling_factor=factor)

    def read_entry(self, name: str) -> int:
        """32 bits."""
        register = BY_NAME[name]
        high, low = self._read(register.table, register.address, 2)
        return high << 16 | low

    def clear(self, faults: int) -> int:
        """Read back, the register has what is there now."""
        self._command("clear_faults", faults)
        return self._holding("clear_faults")

    def _holding(self, name: str) -> int:
        return self.read_entry(name)

    def take_up(self, joint: str, flank: int) -> None:
        """It has begun when this returns."""
        self._move("take_up", TAKE_UPS.index(joint) | (_POSITIVE if flank > 0 else _NEGATIVE))

    def let_go(self) -> None:
        """It has begun when this returns."""
        self._move("let_go", 1)

    def _move(self, name: str, value: int) -> None:
        """A command whose motion begins with a sign of life that carries begin_number back."""
        for _ in range(_BEGIN_TRIES):
            self._command(name, value)
            begin = self.read_entry("begin_number")
            if begin == UNKNOWN:
                continue
            self._owner.begin_number = begin
            try:
                self._show_sign_of_life()
            except _NotTakenError:
                continue
            finally:
                self._owner.begin_number = None
            return
        raise DeviceFaultError(
            f"{name} was taken, and has not begun",
            where=self.url,
            why="the controller heard no sign of life within 130 ms",
            next_step="a link whose round trip is shorter than 40 ms; docs/security.md says what an owner does",
        )

    # ------------------------------------------------------------------------------------------- owning

    @contextlib.contextmanager
    def living(self) -> Iterator[None]:
        """Signs of life before each request, and within `stay`."""
        self._become_owner()
        self._lives = True
        self._give_sign_of_life()
        try:
            yield
        finally:
            self._lives = False

    def stay(self, seconds: float) -> None:
        """Waits."""
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            time.sleep(min(left, LIFE_S / 2))
            self._tend()

    def _become_owner(self) -> None:
        """Opens a session on a guarded board."""
        if self._is_bench or self._owner.is_open:
            return
        setting, low, high = (self.read_entry(name) for name in ("setting", "challenge_low", "challenge_high"))
        has_to_open = self._owner.begin(setting, low, high, self.url)
        self._is_bench = not self._owner.is_open
        if has_to_open:
            self._give_sign_of_life()

    def _tend(self) -> None:
        if self._lives and time.monotonic() >= self._next_life_s:
            self._give_sign_of_life()

    def _give_sign_of_life(self) -> None:
        """One that is refused is no failure: the session goes on, or the next command finds that it does not."""
        self._next_life_s = time.monotonic() + LIFE_S
        register = BY_NAME["life_number"]
        answer = self._taken(self._line.read(register.table, register.address, 2), "reading life_number")
        self._owner.hears(answer.registers[0] << 16 | answer.registers[1])
        with contextlib.suppress(_NotTakenError):
            self._show_sign_of_life()

    def _show_sign_of_life(self) -> None:
        life = self._owner.life()
        if life is not None:
            self._show("life_heard", *life)

    def _show(self, first: str, number: int, check: int) -> None:
        """A sign of life or a seal: number and check in one request."""
        words = struct.unpack(">4H", struct.pack(">II", number, check))
        address = register_of(first)
        self._taken(self._line.write(address, list(words)), f"writing {first}")

    # --------------------------------------------------------------------------------------- parameters

    def enter_configuration(self) -> None:
        """From MONITOR or FAULT."""
        self._command("set_mode", _KEY | 2)

    def leave_configuration(self) -> None:
        """Back to MONITOR, by way of START."""
        self._command("set_mode", _KEY | 1)

    def upload(self, block: Block, advance: Advance) -> None:
        """Into the holding registers, where it is staged."""
        words = [half for at in _PLACES for half in divmod(block.words[at], 1 << 16)]
        for start in range(0, len(words), _BLOCK):
            self._owning(partial(self._write, start, words[start : start + _BLOCK]))
            advance(min(start + _BLOCK, len(words)) // 2)

    def commit(self, block: Block) -> Stored:
        """Until the CRC in force is the block's."""
        before = self._input()["parameter_sequence"]
        self._command("commit_crc", block.identity)
        return self._stored("commit_crc", before, block.identity)

    def rollback(self) -> Stored:
        """The set before."""
        before = self._input()
        self._command("rollback", _KEY | 1)
        return self._stored("rollback", before["parameter_sequence"], None)

    def _stored(self, command: str, sequence_before: Value, crc: int | None) -> Stored:
        """Waits until another set is in force; a store that refused says so in the command's own register."""
        until = time.monotonic() + COMMIT_S
        while time.monotonic() < until:
            state = self._holding(command)
            if state > _STORING:
                raise error_of(command, STORE + state - _STORE_REFUSED, 0, self.url)
            v = self._input()
            found = int(v["parameter_crc"] or 0)
            if v["parameter_sequence"] != sequence_before and (crc is None or found == crc):
                return Stored(int(v["parameter_sequence"] or 0), found)
            time.sleep(0.02)
        raise NoDeviceError(
            f"{command} does not come to an end",
            where=self.url,
            why=f"no other set is in force after {COMMIT_S:g} s",
            next_step="brace query shows which set is in force, and its faults",
        )

    def download(self, advance: Advance) -> Block:
        """The holding registers as a block."""
        from brace.params.block import pack
        from brace.params.values import model_of

        halves: list[int] = []
        total = 2 * len(_PARAMETERS)
        for start in range(0, total, _BLOCK):
            halves += self._read("holding", start, min(_BLOCK, total - start))
            advance(len(halves) // 2)
        words = [0] * len(_PLACES)
        for at, high, low in zip(_PLACES, halves[::2], halves[1::2], strict=True):
            words[at] = high << 16 | low
        sequence = int(self._input()["parameter_sequence"] or 0)
        return pack(model_of(words), sequence)

    def close(self) -> None:
        """The connection."""
        self._line.close()

    # ---------------------------------------------------------------------------------------- registers

    def _input(self) -> dict[str, Value]:
        return decoded(AT_ONCE, self._read("input", 0, 2 * len(AT_ONCE)))

    def _values_of(self, registers: Sequence[Register]) -> dict[str, Value]:
        """Of one read."""
        return decoded(registers, self._read("input", registers[0].address, 2 * len(registers)))

    def _read(self, table: str, address: int, count: int) -> tuple[int, ...]:
        self._tend()
        answer = self._taken(self._line.read(table, address, count), f"reading {table} {address}")
        return tuple(answer.registers)

    def _write(self, address: int, words: Sequence[int]) -> None:
        """Sealed where a session is open: over the request from its function on."""
        self._tend()
        if self._owner.is_open:
            head = struct.pack(">BHHB", _WRITE_BLOCK, address, len(words), 2 * len(words))
            counter = self._owner.next_counter()
            self._show("seal_counter", counter, self._owner.seal(head + struct.pack(f">{len(words)}H", *words)))
        self._taken(self._line.write(address, list(words)), f"writing holding {address}")

    def _command(self, name: str, value: int) -> None:
        """A controller that is still storing says busy, which is to be asked again (Modbus exception 6)."""
        until = time.monotonic() + (EARLY_S if name in _COMMITS else BUSY_S)
        address, words = BY_NAME[name].address, (value >> 16, value & 0xFFFF)
        while True:
            try:
                return self._owning(partial(self._write, address, words))
            except _BusyError:
                if time.monotonic() > until:
                    raise
                self.stay(0.02)

    def _owning(self, command: Callable[[], _Answer]) -> _Answer:
        """A command of an owner. Where it is not taken, its session may have to be opened anew."""
        self._become_owner()
        reopening = Reopening()
        while True:
            try:
                answer = command()
            except _NotTakenError as error:
                wait_s = reopening.wait_s(error.status) if self._owner.is_open else None
                if wait_s is None:
                    raise
                self.stay(wait_s)
                self._owner.forget()
                self._become_owner()
                continue
            self._owner.accepted()
            return answer

    def _taken(self, answer: ModbusPDU, what: str) -> ModbusPDU:
        """The answer; raises the error that a Modbus exception stands for."""
        if answer.isError():
            raise self._refused(what, getattr(answer, "exception_code", 0))
        return answer

    def _refused(self, what: str, code: int) -> BraceError:
        if code in _NO_SUCH_UNIT:
            return NoDeviceError(
                f"unit {self._url.unit} does not answer",
                where=self.url,
                why=f"the other end knows no such unit (Modbus exception {code})",
                next_step="modbus-tcp://HOST:PORT/UNIT with the controller's controller.modbus_address, 1 unless set",
            )
        if code == _NOT_OURS:
            status = self.read_entry("last_refusal") - _STORE_REFUSED
            rejection = error_of(what, status, 0, self.url)
            return _NotTakenError.of(rejection, status) if status in (*NOT_OPEN, LATE) else rejection
        kind = _BusyError if code == _BUSY else DeviceFaultError
        return kind(
            f"the controller refuses {what}: {_EXCEPTIONS.get(code, 'no reason given')}",
            where=self.url,
            why=f"Modbus exception {code}",
            next_step="brace query shows its mode; parameters are written in CONFIGURATION only, which "
            "a loading test or "
            "play being taken up prevents",
        )
