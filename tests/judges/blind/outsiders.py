"""What no entry of the catalogue describes: each bends the rows before the plant plays them, the plant, or the
readings afterwards. Sizes are set as for the others."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from designs import Play, Rng
from plant import INDEX, ROW, Array

T1, T2, TIME, TEMP, DX, DZ = (ROW.index(n) for n in ("theta1_rad", "theta2_rad", "t_s", "temp_degc", "dx_mm", "dz_mm"))

Bend = Callable[[Array, float], Array]  # rows, size -> rows
Read = Callable[[Array, Array, float], Array]  # rows, readings, size -> readings


def _same_rows(rows: Array, _size: float) -> Array:
    return rows


def _same_readings(_rows: Array, out: Array, _size: float) -> Array:
    return out


@dataclass(frozen=True)
class Outsider:
    """One effect from outside the catalogue."""

    name: str
    largest: float
    numbers: dict[str, float] = field(default_factory=dict)
    bend: Bend = _same_rows
    read: Read = _same_readings
    keys: tuple[tuple[str, float], ...] = ()  # parameters of the plant that follow the size
    fixed: tuple[tuple[str, float], ...] = ()

    def play(self, p: Array, rows: Array, size: float, by: Play) -> Array:
        """Readings before noise, with this effect at a size, of a limb that a world plays."""
        limb = p.copy()
        for key, value in self.fixed:
            limb[INDEX[key]] = value
        for key, scale in self.keys:
            limb[INDEX[key]] += scale * size
        bent = self.bend(rows.copy(), size)
        return self.read(rows, by(limb, bent).copy(), size)


def draw(
    rng: Rng, name: str, p: Array, whole_s: float, peak_n: float, deepest: dict[str, float], step_mm: float
) -> Outsider:
    """An outsider with its numbers drawn at random."""
    angle = rng.uniform(0.0, 2.0 * math.pi)
    ux, uz = math.cos(angle), math.sin(angle)
    phase, phase2 = rng.uniform(0.0, 2.0 * math.pi, 2)

    if name == "encoder_ripple":  # the pose is not what the encoder says: n waves a turn
        waves, share = int(rng.integers(3, 12)), rng.uniform(0.3, 1.0)

        def ripple(rows: Array, size: float) -> Array:
            rows[:, T1] += size * np.sin(waves * rows[:, T1] + phase)
            rows[:, T2] += share * size * np.sin(waves * rows[:, T2] + phase2)
            return rows

        return Outsider(name, 0.3, {"waves": waves}, bend=ripple)
    if name == "leadscrew":  # the rig's screw: imposed displacement off by a wave of its pitch
        pitch = step_mm * rng.uniform(2.2, 7.0)

        def screw(rows: Array, size: float) -> Array:
            for c in (DX, DZ):
                on = rows[:, c] != 0.0
                rows[on, c] += size * (np.sin(2 * math.pi * rows[on, c] / pitch + phase) - math.sin(phase))
            return rows

        return Outsider(name, 2.0 * step_mm, {"pitch_mm": pitch}, bend=screw)
    if name == "slip":  # the base slips once: everything after is displaced
        when = rng.uniform(0.2, 0.8) * whole_s

        def slip(rows: Array, size: float) -> Array:
            after = rows[:, TIME] >= when
            rows[after, DX] += size * ux
            rows[after, DZ] += size * uz
            return rows

        return Outsider(name, 5.0, {"t_s": when}, bend=slip)
    if name == "thermal_growth":  # the frame grows with temperature and displaces the tip

        def grow(rows: Array, size: float) -> Array:
            rows[:, DX] += size * ux * (rows[:, TEMP] - rows[0, TEMP])
            rows[:, DZ] += size * uz * (rows[:, TEMP] - rows[0, TEMP])
            return rows

        return Outsider(name, 0.5, bend=grow)
    if name == "seating":  # each run is clamped a little elsewhere
        seed = int(rng.integers(2**31))

        def seat(rows: Array, size: float) -> Array:
            shifts = np.random.default_rng(seed).standard_normal((int(rows[:, 0].max()) + 1, 2))
            rows[:, DX] += size * shifts[rows[:, 0].astype(int), 0]
            rows[:, DZ] += size * shifts[rows[:, 0].astype(int), 1]
            return rows

        return Outsider(name, 2.0, bend=seat)
    if name == "asymmetric_joint":  # stiffer when pushed one way than the other
        return Outsider(name, 1.5, keys=(("outside.asymmetry", 1.0),))
    if name == "growing_backlash":  # wear within the record
        return Outsider(name, 0.02, keys=(("outside.gap_growth_rad_per_s", 1.0 / whole_s),))
    if name == "off_centre_play":  # play that lies to one side at rest
        joint = str(rng.choice(["femur", "tibia"]))
        return Outsider(
            name,
            0.02,
            keys=((f"joint.{joint}.gap_rad", 1.0),),
            fixed=(("outside.gap_offset", rng.uniform(0.5, 0.95) * float(rng.choice([-1.0, 1.0]))),),
        )
    if name == "cogging":  # torque ripple over the joint's deflection
        deep = min(deepest["femur_rad"], deepest["tibia_rad"])
        most = (
            0.8
            * deep
            / 2
            / math.pi
            / max(
                p[INDEX["joint.femur.compliance_rad_per_n_mm"]],
                p[INDEX["joint.tibia.compliance_rad_per_n_mm"]],
            )
        )
        return Outsider(
            name,
            most,
            keys=(("outside.cogging_n_mm", 1.0),),
            fixed=(("outside.cogging_period_rad", deep * rng.uniform(0.6, 1.6)),),
        )
    if name == "cable_pull":  # a hose or cable that pulls by posture, in no way a weight does
        waves = int(rng.integers(4, 8))

        def pull(rows: Array, out: Array, size: float) -> Array:
            out[:, 0] += size * np.sin(waves * rows[:, T1] + phase)
            out[:, 1] += size * np.sin(waves * rows[:, T2] + phase2)
            return out

        return Outsider(name, 10.0, {"waves": waves}, read=pull)
    if name == "sensor_warmth":  # the sensor's zero swings with a period
        period = whole_s / rng.uniform(3.0, 9.0)

        def swing(rows: Array, out: Array, size: float) -> Array:
            wave = np.sin(2 * math.pi * rows[:, TIME] / period + phase)
            out[:, 0] += size * ux * wave
            out[:, 1] += size * uz * wave
            return out

        return Outsider(name, 10.0, {"period_s": period}, read=swing)
    if name == "glitch_bursts":  # interference: short stretches that are off
        starts = rng.uniform(0.05, 0.95, int(rng.integers(4, 9))) * whole_s
        length = whole_s * rng.uniform(0.004, 0.012)
        heights = rng.standard_normal((len(starts), 2))

        def burst(rows: Array, out: Array, size: float) -> Array:
            for at, height in zip(starts, heights, strict=True):
                on = (rows[:, TIME] >= at) & (rows[:, TIME] < at + length)
                out[on, :2] += size * height
            return out

        return Outsider(name, 20.0, {"bursts": len(starts)}, read=burst)
    if name == "sensor_curve":  # an even term: the reading bends with the force

        def curve(_rows: Array, out: Array, size: float) -> Array:
            out[:, 0] += size * out[:, 0] ** 2 / peak_n
            out[:, 1] += size * out[:, 1] ** 2 / peak_n
            return out

        return Outsider(name, 0.5, read=curve)
    if name == "warm_gain":  # the sensor's gain follows temperature

        def gain(rows: Array, out: Array, size: float) -> Array:
            out[:, :2] *= 1.0 + size * (rows[:, TEMP : TEMP + 1] - rows[0, TEMP])
            return out

        return Outsider(name, 0.1, read=gain)
    raise ValueError(name)


KINDS = (
    "encoder_ripple",
    "leadscrew",
    "slip",
    "thermal_growth",
    "seating",
    "asymmetric_joint",
    "growing_backlash",
    "off_centre_play",
    "cogging",
    "cable_pull",
    "sensor_warmth",
    "glitch_bursts",
    "sensor_curve",
    "warm_gain",
)
