"""A joint on a bench, played by actuator.c: parameters and tests in, readings out."""

from __future__ import annotations

import ctypes
import math
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from plant import Array, compiled

SOURCE = Path(__file__).with_name("actuator.c")
STATES = 14  # of actuator.c
LARGEST_STEP_S = 4e-5  # of the inertia against the spring and the bristles


@dataclass(frozen=True)
class Joint:
    """In the order of actuator.c's enum. N mm, rad, s."""

    stiffness: float
    gap: float = 0.0
    zero: float = 0.0
    hardening: float = 0.0
    soft_at: float = 0.0
    one_sided: float = 0.0
    stop_at: float = 0.0
    stop: float = 0.0
    creep: float = 0.0
    creep_s: float = 1.0
    cogging: float = 0.0
    cogging_period: float = 1.0
    cogging_phase: float = 0.0
    viscous: float = 0.0
    inertia: float = 10.0
    coulomb: float = 0.0
    per_load: float = 0.0
    bristle: float = 1e6
    bristle_damping: float = 0.0
    peak: float = 0.0
    stribeck: float = 0.05
    slip: float = 0.0
    slip_torque: float = 0.0
    slip_stiffness: float = 1.0
    maxwell: float = 0.0


@dataclass(frozen=True)
class Test:
    """Some cycles of one amplitude: of torque [N mm] where the drive follows torque, else of angle [rad]. `hold_s`: the
    drive stands so long at each reversal; `middle` is where it goes up and down about."""

    __test__ = False  # no test of pytest's

    amplitude: float
    rate_hz: float
    cycles: int = 2
    wave: str = "ramp"
    hold_s: float = 0.0
    middle: float = 0.0

    def command(self, interval_s: float) -> Array:
        """One value a reading."""
        quarter = 0.25 / self.rate_hz
        times, values = [0.0], [0.0]
        for _ in range(self.cycles):
            for turn in (1.0, -1.0):
                times.append(times[-1] + (quarter if len(times) == 1 else 2 * quarter))
                values.append(turn)
                if self.hold_s:
                    times.append(times[-1] + self.hold_s)
                    values.append(turn)
        times.append(times[-1] + quarter)
        values.append(0.0)
        at = np.interp(np.arange(0.0, times[-1], interval_s), times, values)
        if self.wave == "sine":
            at = np.sin(0.5 * math.pi * at)
        return np.asarray(self.middle + self.amplitude * at)


@dataclass(frozen=True)
class Bench:
    """How the joint is driven and read. `count_rad`: the encoder's step; `late_s`: by how much the
    torque is read late."""

    torque_driven: bool
    interval_s: float
    count_rad: float
    torque_noise: float
    torque_step: float
    late_s: float = 0.0
    with_command: bool = False
    angle_noise: float = 0.0


@dataclass
class Record:
    """Columns of a joint test."""

    columns: dict[str, Array] = field(default_factory=dict)

    def add(self, **columns: npt.NDArray[Any]) -> None:
        """Rows behind the others."""
        for name, values in columns.items():
            self.columns[name] = np.concatenate([self.columns.get(name, np.empty(0)), values])


_LIBRARY: list[ctypes.CDLL] = []
_DOUBLES = ctypes.POINTER(ctypes.c_double)


def _library() -> ctypes.CDLL:
    if not _LIBRARY:
        loaded = compiled(SOURCE)
        loaded.actuator_play.argtypes = [
            _DOUBLES, _DOUBLES, _DOUBLES, ctypes.c_int, ctypes.c_double, ctypes.c_int, ctypes.c_int, _DOUBLES, _DOUBLES
        ]  # fmt: skip
        loaded.actuator_play.restype = None
        _LIBRARY.append(loaded)
    return _LIBRARY[0]


def play(joint: Joint, test: Test, bench: Bench, state: Array | None = None) -> tuple[Array, Array, Array]:
    """Command, angle and torque at each reading, without noise. `state` goes on from an earlier test."""
    given = np.array([getattr(joint, f.name) for f in fields(joint)])
    command = np.ascontiguousarray(test.command(bench.interval_s))
    if not bench.torque_driven:
        command = command + joint.zero
    if state is None:
        state = at_rest(joint)
    angle, torque = np.empty(len(command)), np.empty(len(command))
    substeps = max(1, math.ceil(bench.interval_s / LARGEST_STEP_S))
    pointers = [a.ctypes.data_as(_DOUBLES) for a in (given, state, command, angle, torque)]
    _library().actuator_play(
        *pointers[:3], len(command), bench.interval_s, substeps, int(bench.torque_driven), *pointers[3:]
    )
    if not (np.all(np.isfinite(angle)) and np.all(np.isfinite(torque))):
        raise ArithmeticError("the joint's play does not settle")
    return command, angle, torque


def at_rest(joint: Joint) -> Array:
    """A joint that stands unloaded in the middle of its play."""
    state = np.zeros(STATES)
    state[0] = joint.zero
    return state


def read(
    rng: np.random.Generator, joints: list[Joint], tests: list[Test], bench: Bench, pause_s: float = 2.0
) -> Record:
    """A record: each test on its joint (the same at another gear position), with noise, resolution and lateness."""
    record, start_s = Record(), 0.0
    state: Array | None = None
    for number, (joint, test) in enumerate(zip(joints, tests, strict=True)):
        if number == 0 or joint is not joints[number - 1]:
            state = at_rest(joint)
        command, angle, torque = play(joint, test, bench, state)
        t = np.arange(len(angle)) * bench.interval_s
        torque = np.interp(t - bench.late_s, t, torque)
        torque = torque + bench.torque_noise * rng.standard_normal(len(t))
        angle = angle + bench.angle_noise * rng.standard_normal(len(t))
        if bench.torque_step:
            torque = np.round(torque / bench.torque_step) * bench.torque_step
        if bench.count_rad:
            angle = np.round(angle / bench.count_rad) * bench.count_rad
        record.add(t_s=start_s + t, angle_rad=angle, torque_n_mm=torque, test=np.full(len(t), float(number)))
        if bench.with_command and bench.torque_driven:
            record.add(command_n_mm=command)
        start_s += float(t[-1]) + pause_s
    return record


def write(folder: Path, title: str, record: Record, extra: str = "") -> None:
    """As a dataset without limb.toml."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "meta.toml").write_text(f'format = 1\nkind = "joint_test"\ntitle = "{title}"\n{extra}')
    form = {"t_s": "%.5f", "angle_rad": "%.8f", "torque_n_mm": "%.6f", "test": "%d", "command_n_mm": "%.6f"}
    names = [name for name in form if name in record.columns]
    lines = [",".join(names)]
    table = np.column_stack([record.columns[name] for name in names])
    row_form = ",".join(form[name] for name in names)
    lines += [row_form % tuple(row) for row in table]
    (folder / "data.csv").write_text("\n".join(lines) + "\n")
