"""The node of brace_node.h: limbs made from models, run in a thread of C, read from Python."""

from __future__ import annotations

import math
import os
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TypedDict, TypeVar

from brace.ground.errors import BadFileError, BraceError, NoDeviceError, UsageError
from brace.model import LimbModel
from brace.native import node_library
from brace.native.c_data import CData
from brace.native.limb import fill_plant, plant_error, status_text
from brace.params import pack
from brace.sim.spec import JOINTS, Fault, Posture
from brace.stiffness.names import SPATIAL_K
from brace.wire import codes

MODES = tuple(name.lower() for name in codes.MODE.names)
FAULT_BITS = tuple(name.lower() for name in codes.FAULT.names)
ORIGINS = tuple(name.lower() for name in codes.PARAMETER_ORIGIN.names)
PLAY_STATES = tuple(name.lower() for name in codes.PLAY.names)
Same = TypeVar("Same", bound="Node")
SERIAL_PORTS = {"console": 0, "modbus": 1, "slcan": 2, "modbus_tcp": 3}
_SLICE_S = 0.001  # of the wall clock, where the limbs run at a speed of their own
E_URL, E_IN_USE, E_NO_DEVICE, E_NO_CAN, E_DENIED, E_SYSTEM, E_SIZE = range(-1, -8, -1)
_DRIVE_KEYS = (  # of [motor.*], and members of brace_node_drive_t
    "inertia_n_mm_s2_per_rad",
    "friction_n_mm",
    "friction_per_torque_ratio",
    "friction_per_load_ratio",
    "torque_range_n_mm",
    "torque_noise_n_mm",
    "angle_step_rad",
)


@dataclass
class LimbSetup:
    """One limb: what its controller believes, what is true, and its world. Units as in the names."""

    model: LimbModel  # believed
    plant: LimbModel  # true
    changes: dict[str, float] = field(default_factory=dict)  # of the parameters, by key
    theta_rad: tuple[float, float, float] = (0.0, 1.0, 1.4)
    hold_n_per_mm: float = math.inf
    press_mm: tuple[float, float] = (0.0, 0.0)  # x, z
    press_y_mm: float = 0.0  # across the plane; of a limb with a coxa joint
    force_noise_n: float | None = None  # None: the plant's sensor.noise_n
    has_force_sensor: bool = True
    has_link_encoder: bool = False
    temp_degc: float | None = None  # None: the plant's reference
    temp_rise_degc: float = 0.0
    temp_time_constant_s: float = 600.0
    nvm_path: str | None = None
    block_replaces: bool = False
    no_block: bool = False  # the controller finds an empty memory
    console: str = "none"
    modbus_line: str = "none"
    slcan_line: str = "none"
    modbus_tcp: str = "none"
    servos: str | None = None  # "sim", or a device: brace_node.h
    servo_ids: tuple[int, int, int] = (11, 12, 13)
    servos_hold: bool = False
    key: bytes | None = None  # of a guarded controller
    owner_silence_s: float = 0.0  # in the simulation's time; 0: as a board has it
    drive: dict[str, float] = field(default_factory=dict)  # members of brace_node_drive_t, of all joints


class _LimbInSpace(TypedDict, total=False):
    """What only a limb with a coxa joint has."""

    space: dict[str, object]  # K in space


class LimbState(_LimbInSpace):
    """A tick as the controller reports it; None: K is not valid."""

    limb: int  # from 1
    node: int
    sequence: int
    mode: str
    faults: list[str]
    k_is_valid: bool
    k_xx_n_per_mm: float | None
    k_xz_n_per_mm: float | None
    k_zz_n_per_mm: float | None
    lambda_min_n_per_mm: float | None
    lambda_max_n_per_mm: float | None
    stiff_axis_rad: float | None
    flag_names: list[str]
    load: dict[str, object]  # that K counts
    theta1_rad: float
    theta2_rad: float
    play: list[str]
    force_x_n: float
    force_z_n: float
    parameters: str
    parameter_crc: str


class PortBusy(NoDeviceError):
    """Somebody else has the port; which one is in `url`."""

    url = ""


class Node:
    """Limbs and their controllers. Close it, or use it in a `with`."""

    names: tuple[str, ...] = ()  # of the limbs, where they have some

    def __init__(self, limbs: Sequence[LimbSetup], can: str | None = "none", seed: int = 0) -> None:
        self.native = node_library()
        self._setups = list(limbs)
        # set at the end of a run; a Ctrl-C within Thread.join would have Python 3.11 call a running thread ended
        self._over: threading.Event | None = None
        self._ended = threading.Event()
        ffi = self.native.ffi
        keep: list[CData] = []
        structs = ffi.new("brace_node_limb_t[]", len(limbs))
        for struct, setup in zip(structs, limbs, strict=True):
            self._fill(struct, setup, keep)
        failure = ffi.new("brace_node_failure_t *")
        url = ffi.NULL if can is None else can.encode()
        self._node = self._create(structs, url, seed, failure)
        if self._node == ffi.NULL:
            raise self._refusal(failure, can)

    # ------------------------------------------------------------------------------------------- making

    def _create(self, structs: CData, can: CData, seed: int, failure: CData) -> CData:
        return self.native.lib.brace_node_create(structs, len(structs), can, seed, failure)

    def _fill(self, struct: CData, setup: LimbSetup, keep: list[CData]) -> None:
        ffi, lib = self.native.ffi, self.native.lib
        lib.brace_node_limb_default(ffi.addressof(struct))
        fill_plant(self.native, struct.plant, setup.plant)
        for index, joint in enumerate(JOINTS):
            for key in _DRIVE_KEYS:
                setattr(struct.drive[index], key, setup.plant.number(f"motor.{joint}.{key}"))
            for name, value in setup.drive.items():
                setattr(struct.drive[index], name, value)
        struct.theta_rad = setup.theta_rad
        struct.hold_n_per_mm = setup.hold_n_per_mm
        struct.press.x_mm, struct.press.z_mm = setup.press_mm
        struct.press.y_mm = setup.press_y_mm
        noise_n = setup.force_noise_n
        struct.force_noise_n = setup.plant.number("sensor.noise_n") if noise_n is None else noise_n
        struct.has_force_sensor = setup.has_force_sensor
        struct.has_link_encoder = setup.has_link_encoder
        reference = setup.plant.number("thermal.reference_degc")
        struct.temp_start_degc = reference if setup.temp_degc is None else setup.temp_degc
        struct.temp_rise_degc = setup.temp_rise_degc
        struct.temp_time_constant_s = setup.temp_time_constant_s
        struct.block_replaces = setup.block_replaces
        if not setup.no_block:
            block = pack(setup.model.with_values(setup.changes)).content
            keep.append(ffi.from_buffer("uint8_t[]", block))
            struct.block, struct.block_bytes = keep[-1], len(block)
        struct.servo_id = setup.servo_ids
        struct.servos_hold = setup.servos_hold
        struct.owner_silence_s = setup.owner_silence_s
        if setup.key is not None:
            keep.append(ffi.from_buffer("uint8_t[]", setup.key))
            struct.key = keep[-1]
        texts = ("console", "modbus_line", "slcan_line", "modbus_tcp", "nvm_path", "servos")
        for name in texts:
            if (text := getattr(setup, name)) is not None:
                keep.append(ffi.new("char[]", os.fsencode(text)))
                setattr(struct, name, keep[-1])

    def _refusal(self, failure: CData, can: str | None) -> BraceError:
        setup = self._setups[failure.limb]
        part, detail = int(failure.part), int(failure.detail)
        if part == 1:
            return plant_error(self.native, detail, setup.plant, "be simulated")
        if part == 2:
            return BadFileError(
                "the controller refuses the parameter block",
                where=setup.model.where(),
                why=status_text(self.native, detail),
                next_step="./dev setup builds tools and controller from the same dictionary",
            )
        url = {
            3: setup.nvm_path,
            4: can,
            5: setup.console,
            6: setup.modbus_line,
            7: setup.slcan_line,
            8: setup.modbus_tcp,
            9: setup.servos,
        }[part]
        text = self.native.ffi.string(self.native.lib.brace_node_posix_text(detail)).decode()
        return port_error(str(url), part, detail, text, int(failure.system))

    def close(self) -> None:
        """Stops the limbs and closes every port. Twice is once."""
        self.stop()
        if self._node != self.native.ffi.NULL:
            self.native.lib.brace_node_destroy(self._node)
            self._node = self.native.ffi.NULL

    def __enter__(self: Same) -> Same:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    # ------------------------------------------------------------------------------------------ running

    def step(self, seconds: float) -> float:
        """Advances by a time, as fast as possible; returns the simulation's time [s]."""
        left_us, now_us = round(seconds * 1e6), 0
        while True:
            part_us = min(left_us, 1_000_000_000)
            now_us = int(self.native.lib.brace_node_step(self._node, part_us))
            left_us -= part_us
            if left_us <= 0:
                return now_us * 1e-6

    def start(self, until_s: float = math.inf, speed: float = 1.0) -> None:
        """Runs in step with the wall clock (or so many times faster), in a thread, until a time of the simulation or
        stop()."""
        until_us = 2**63 if math.isinf(until_s) else round(until_s * 1e6)
        over, ended = threading.Event(), threading.Event()

        def run() -> None:
            try:
                if speed == 1.0:
                    self.native.lib.brace_node_run(self._node, until_us)
                else:
                    self._run_at(speed, until_s, ended)
            finally:
                over.set()

        self._over, self._ended = over, ended
        threading.Thread(target=run, name="limbs", daemon=True).start()

    def _run_at(self, speed: float, until_s: float, ended: threading.Event) -> None:
        """In slices; one that comes late is made up for, up to a tenth of a second."""
        began, done_s = time.monotonic(), 0.0
        while not ended.wait(_SLICE_S) and done_s < until_s:
            due_s = min((time.monotonic() - began) * speed, until_s, done_s + 0.1 * max(speed, 1.0))
            if due_s > done_s:
                self.step(due_s - done_s)
                done_s = due_s

    def wait(self, seconds: float) -> bool:
        """True when the run is over, at once or within a time."""
        return self._over is None or self._over.wait(seconds)

    def stop(self) -> None:
        """Ends a run; returns when it has ended."""
        if self._over is not None:
            self._ended.set()
            self.native.lib.brace_node_stop(self._node)
            self._over.wait()
            self._over = None

    def add_fault(self, fault: Fault) -> None:
        """At its time, in its limb or in all."""
        limbs = range(len(self._setups)) if fault.limb is None else (fault.limb,)
        for limb in limbs:
            status = self.native.lib.brace_node_fault(
                self._node, limb, fault.kind, fault.joint, fault.value, fault.at_s, fault.for_s
            )
            if status != 0:
                raise UsageError(
                    f"--fault for limb {limb + 1}",
                    why=f"there are {len(self._setups)} limbs; or its value is out of range; or it is the coxa joint's,"
                    " and the limb has none: nothing yields across its plane",
                    next_step="--limbs N, another limb, or joint.coxa.compliance_rad_per_n_mm in the limb's file",
                )

    def add_posture(self, posture: Posture) -> None:
        """For all limbs."""
        for limb in range(len(self._setups)):
            self.native.lib.brace_node_posture(
                self._node, limb, posture.at_s, posture.theta1_rad, posture.theta2_rad
            )

    def press(
        self, x_mm: float, z_mm: float, limb: int = 0, hold_n_per_mm: float = math.inf, y_mm: float = 0.0
    ) -> None:
        """The contact anew: it holds the tip so far from where the unloaded limb now has it."""
        press = self.native.ffi.new("brace_node_press_t *", {"x_mm": x_mm, "y_mm": y_mm, "z_mm": z_mm})
        self.native.lib.brace_node_contact(self._node, limb, hold_n_per_mm, press)

    def restart(self, limb: int = 0) -> None:
        """Power off and on; the memory stays."""
        self.native.lib.brace_node_restart(self._node, limb)

    # ------------------------------------------------------------------------------------------ reading

    @property
    def can_place(self) -> str:
        """What a CAN client connects to."""
        return self._text(self.native.lib.brace_node_can_place(self._node))

    def serial_place(self, limb: int, port: str) -> str:
        """What the client of a serial port, or of modbus_tcp, connects to."""
        return self._text(self.native.lib.brace_node_serial_place(self._node, limb, SERIAL_PORTS[port]))

    def _text(self, pointer: CData) -> str:
        return str(self.native.ffi.string(pointer).decode())

    def app(self, limb: int = 0) -> CData:
        """brace_app_t *, for requests while nothing runs."""
        return self.native.lib.brace_node_app(self._node, limb)

    def raw_snapshot(self, limb: int = 0) -> CData:
        """brace_snapshot_t *, a copy."""
        snapshot = self.native.ffi.new("brace_snapshot_t *")
        self.native.lib.brace_node_snapshot(self._node, limb, snapshot)
        return snapshot

    def raw_truth(self, limb: int = 0) -> CData:
        """brace_node_truth_t *, a copy."""
        truth = self.native.ffi.new("brace_node_truth_t *")
        self.native.lib.brace_node_truth(self._node, limb, truth)
        return truth

    def has_coxa_joint(self, limb: int = 0) -> bool:
        """Something yields across the limb's plane."""
        return bool(self.raw_truth(limb).has_coxa_joint)

    def state(self, limb: int = 0) -> LimbState:
        """The newest tick as the controller reports it; K is None unless it is valid."""
        s = self.raw_snapshot(limb)
        k = s.stiffness.now
        valid = bool(s.k_is_valid)
        state: LimbState = {
            "limb": limb + 1,
            "node": int(self.native.lib.brace_app_parameters(self.app(limb)).controller.node_id),
            "sequence": s.sequence,
            "mode": MODES[s.mode],
            "faults": [name for bit, name in enumerate(FAULT_BITS) if s.faults >> bit & 1],
            "k_is_valid": valid,
            "k_xx_n_per_mm": k.k_xx_n_per_mm if valid else None,
            "k_xz_n_per_mm": k.k_xz_n_per_mm if valid else None,
            "k_zz_n_per_mm": k.k_zz_n_per_mm if valid else None,
            "lambda_min_n_per_mm": k.lambda_min_n_per_mm if valid else None,
            "lambda_max_n_per_mm": k.lambda_max_n_per_mm if valid else None,
            "stiff_axis_rad": k.stiff_axis_rad if valid else None,
            "flag_names": list(codes.FLAG.names_of_bits(k.flags)),
            "load": _load_of(s),
            "theta1_rad": s.theta_rad[1],
            "theta2_rad": s.theta_rad[2],
            "play": [PLAY_STATES[s.play[joint].state] for joint in (1, 2)],
            "force_x_n": s.force_x_n,
            "force_z_n": s.force_z_n,
            "parameters": ORIGINS[s.parameter_origin],
            "parameter_crc": f"{s.parameter_crc:08x}",
        }
        if s.space.is_fitted:
            state["space"] = _space_of(s)
        return state

    def truth(self, limb: int = 0) -> dict[str, object]:
        """What no controller sees."""
        t = self.raw_truth(limb)
        return {
            "theta1_rad": t.link_rad[1],
            "theta2_rad": t.link_rad[2],
            "load_femur_n_mm": t.load_n_mm[1],
            "load_tibia_n_mm": t.load_n_mm[2],
            "flank": [t.flank[1], t.flank[2]],
            "force_x_n": t.force_x_n,
            "force_z_n": t.force_z_n,
            "temp_degc": t.temp_degc,
            **(_truth_across(t) if t.has_coxa_joint else {}),
        }

    def servo(self, limb: int, joint: int) -> dict[str, int]:
        """A servo as its driver knows it, and what the driver has counted: the members of brace_node_servo_t."""
        reported = self.native.ffi.new("brace_node_servo_t *")
        if self.native.lib.brace_node_servo(self._node, limb, joint, reported) != 0:
            raise ValueError(f"limb {limb} has no servos")
        return {name: int(getattr(reported, name)) for name, _ in self.native.ffi.typeof(reported[0]).fields}

    def stats(self) -> dict[str, int]:
        """Ticks, lateness, frames since the start."""
        stats = self.native.ffi.new("brace_node_stats_t *")
        self.native.lib.brace_node_stats(self._node, stats)
        return {name: int(getattr(stats, name)) for name, _ in self.native.ffi.typeof(stats[0]).fields}


def _load_of(s: CData) -> dict[str, object]:
    """The load that K counts, named as `brace query` names it; None: not known, or no buckling factor."""
    load, k = s.load, s.load.unloaded
    reported = {
        "force_x_n": load.force_x_n,
        "force_z_n": load.force_z_n,
        "moved_x_mm": load.moved_x_mm,
        "moved_z_mm": load.moved_z_mm,
        "buckling_factor": load.buckling_factor,
        "gravity_direction_rad": s.gravity_direction_rad,
        "gravity_lean_rad": s.gravity_lean_rad,
        **{f"unloaded_{name}": getattr(k, name) for name in ("k_xx_n_per_mm", "k_xz_n_per_mm", "k_zz_n_per_mm")},
    }
    if s.space.is_fitted:
        reported |= {"force_y_n": load.force_y_n, "moved_y_mm": load.moved_y_mm}
        reported["unloaded_k_across_n_per_mm"] = load.unloaded_across_n_per_mm
    known = {name: value if math.isfinite(value) else None for name, value in reported.items()}
    return {"is_counted": bool(load.is_counted), **known}


def _space_of(s: CData) -> dict[str, object]:
    """K in space, named as brace k names it; K is None unless it is valid."""
    space, k = s.space, s.space.now
    valid = bool(space.is_valid)
    entries: dict[str, object] = {"k_is_valid": valid}
    entries |= {name: getattr(k, name) if valid else None for name in SPATIAL_K}
    for place, name in enumerate(("min", "mid", "max")):
        entries[f"lambda_{name}_n_per_mm"] = k.lambda_n_per_mm[place] if valid else None
    for place, axis in enumerate("xyz"):
        entries[f"stiff_axis_{axis}"] = k.stiff_axis[place] if valid else None
    return entries | {
        "flag_names": list(codes.FLAG.names_of_bits(k.flags)),
        "k_across_n_per_mm": space.across_n_per_mm if valid else None,
        "theta0_rad": s.theta_rad[0],
        "play_coxa": PLAY_STATES[s.play[0].state],
    }


def _truth_across(t: CData) -> dict[str, float]:
    """What is true across the limb's plane."""
    return {
        "theta0_rad": t.link_rad[0],
        "load_coxa_n_mm": t.load_n_mm[0],
        "flank_coxa": t.flank[0],
        "force_y_n": t.force_y_n,
    }


_PARTS = {
    3: ("the controller's memory", "--nvm another file"),
    4: ("the CAN bus", "--can tcp://127.0.0.1:0 takes any free port"),
    5: ("the console", "--serial console=stderr"),
    6: ("the Modbus line", "--modbus modbus:pty makes a line of its own"),
    7: ("the SLCAN line", "--serial slcan=pty makes a line of its own"),
    8: ("Modbus TCP", "--modbus modbus-tcp://127.0.0.1:0 takes any free port"),
    9: ("servos", "--servos sim, or --servos /dev/ttyUSB0@3000000"),
}


def port_error(url: str, part: int, detail: int, text: str, system: int) -> BraceError:
    """Why a port, device or file cannot be opened, and what to do."""
    what, way = _PARTS[part]
    reason = f"{text} ({os.strerror(system)})" if system and detail not in (E_URL, E_SIZE) else text
    if detail == E_URL:
        return UsageError(f"{what}: {url!r} cannot be opened", where="sim", why=text, next_step=f"e.g. {way}")
    if detail == E_SIZE:
        return BadFileError(f"{url} is no controller's memory", why=text, next_step=way)
    if detail == E_NO_CAN:
        way = "--can tcp://127.0.0.1:0 (SLCAN) needs no CAN in the kernel"
    elif detail == E_NO_DEVICE and part == 4 and "/" not in url:
        way = f"ip link add dev {url} type vcan && ip link set {url} up, or --can tcp://127.0.0.1:0"
    elif detail == E_DENIED:
        way = "a port above 1023, or the rights to the device; " + way
    elif detail == E_IN_USE:
        way = "end the other program, or " + way
    kind = PortBusy if detail == E_IN_USE else NoDeviceError
    error = kind(f"{what} cannot be opened", where=url, why=reason, next_step=way)
    if isinstance(error, PortBusy):
        error.url = url
    return error
