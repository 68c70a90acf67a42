"""What can be hidden: every effect of the catalogue at each of its places, direction drawn at random and a size
that is set afterwards, so that it is as detectable as wanted."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from designs import Rng
from plant import INDEX, Array

CATALOGUE = (
    ("joint_compliance", "joint.femur"),
    ("joint_compliance", "joint.tibia"),
    ("moment_transfer", "link.femur"),
    ("base_compliance", "base"),
    ("link_compliance_error", "link.femur"),
    ("link_compliance_error", "link.tibia"),
    ("link_change", "link.femur"),
    ("link_change", "link.tibia"),
    ("backlash", "joint.femur"),
    ("backlash", "joint.tibia"),
    ("coulomb_friction", "joint.femur"),
    ("coulomb_friction", "joint.tibia"),
    ("joint_hardening", "joint.femur"),
    ("joint_hardening", "joint.tibia"),
    ("creep", "creep"),
    ("thermal_softening", "thermal"),
    ("gravity", "gravity"),
    ("joint_zero_offset", "joint.femur"),
    ("joint_zero_offset", "joint.tibia"),
    ("link_length_error", "geometry"),
    ("sensor_bias", "sensor"),
    ("sensor_drift", "sensor"),
    ("sensor_gain", "sensor"),
    ("sensor_rotation", "sensor"),
    ("sensor_crosstalk", "sensor"),
    ("sensor_saturation", "sensor"),
    ("contact_play", "contact"),
)


@dataclass(frozen=True)
class Change:
    """How one parameter follows the size: added (`scale` x size), multiplied ((1 + size) to the power `scale`);
    `peak` divides by 1 + size what was infinite before."""

    key: str
    how: str
    scale: float


@dataclass(frozen=True)
class Hidden:
    """One effect with its direction: what its size moves, what is set besides, the sensible range of sizes."""

    name: str
    where: str
    changes: tuple[Change, ...]
    largest: float
    fixed: tuple[tuple[str, float], ...] = ()
    smallest: float = 1e-6

    @property
    def label(self) -> str:
        """As the class lists it."""
        return f"{self.name}@{self.where}"

    def applied(self, p: Array, size: float) -> Array:
        """The limb with this effect at this size."""
        out = p.copy()
        for key, value in self.fixed:
            out[INDEX[key]] = value
        for change in self.changes:
            i = INDEX[change.key]
            if change.how == "add":
                out[i] += change.scale * size
            elif change.how == "multiply":
                out[i] *= (1.0 + size) ** change.scale
            else:
                out[i] = change.scale / (1.0 + size)
        return out

    def free(self) -> list[str]:
        """What a fit of this effect may move."""
        smooth = [key for key, _ in self.fixed if key == "creep.time_constant_s"]
        return [change.key for change in self.changes] + smooth


def _sign(rng: Rng, positive: float = 0.5) -> float:
    return 1.0 if rng.random() < positive else -1.0


def draw(rng: Rng, name: str, where: str, believed: Array, whole_s: float, peak_n: float) -> Hidden:
    """An effect with a random direction."""
    add, multiply = "add", "multiply"
    joint = where if where.startswith("joint.") else ""

    def at(key: str) -> float:
        return float(believed[INDEX[key]])

    angle = rng.uniform(0.0, 2.0 * math.pi)
    if name == "joint_compliance":
        sign = _sign(rng, 0.75)
        return Hidden(name, where, (Change(f"{joint}.compliance_rad_per_n_mm", multiply, sign),), 7.0)
    if name == "moment_transfer":
        return Hidden(name, where, (Change("link.femur.moment_transfer", add, 1.0),), 1.0)
    if name == "base_compliance":
        mix = [(1, 0, 0), (0, 1, 0), (1, 0.6, 0), (0.6, 1, 0), (0, 0, 1), (0.5, 0.5, 1), (1, 1, 0.5)]
        x, z, turn = mix[int(rng.integers(len(mix)))]
        lever = 0.5 * (at("geometry.femur_mm") + at("geometry.tibia_mm"))
        shares = (
            ("base.x_mm_per_n", x),
            ("base.z_mm_per_n", z),
            ("base.rotation_rad_per_n_mm", turn / lever**2),
        )
        return Hidden(name, where, tuple(Change(key, add, s) for key, s in shares if s), 0.5)
    if name == "link_compliance_error":
        kind = str(rng.choice(["bending", "both", "tilt", "bending_tilt", "axial"], p=[0.45, 0.2, 0.15, 0.1, 0.1]))
        changes = []
        if kind in ("bending", "both", "bending_tilt"):
            changes.append(Change(f"{where}.bending_mm_per_n", multiply, _sign(rng, 0.7)))
        if kind in ("both", "axial"):
            changes.append(Change(f"{where}.axial_mm_per_n", multiply, rng.uniform(0.5, 1.5) * _sign(rng, 0.8)))
        if kind in ("tilt", "bending_tilt"):
            changes.append(Change(f"{where}.tilt_rad", add, (0.6 if kind == "tilt" else 0.3) * _sign(rng)))
        return Hidden(name, where, tuple(changes), 1.0 if kind == "tilt" else 8.0)
    if name == "link_change":
        moment_s = round(rng.uniform(0.12, 0.88) * whole_s, 3)
        fixed = (("change.at_s", moment_s), ("change.link", float(where == "link.tibia")))
        return Hidden(name, where, (Change("change.bending_factor", multiply, _sign(rng, 0.8)),), 6.0, fixed)
    if name == "backlash":
        return Hidden(name, where, (Change(f"{joint}.gap_rad", add, 1.0),), 0.02)
    if name == "coulomb_friction":
        return Hidden(name, where, (Change(f"{joint}.coulomb_n_mm", add, 1.0),), 2000.0, (), 1e-3)
    if name == "joint_hardening":
        lever = 0.7 * (at("geometry.femur_mm") if joint.endswith("femur") else 0.0) + 0.7 * at("geometry.tibia_mm")
        bent = at(f"{joint}.compliance_rad_per_n_mm") * lever * 0.5 * peak_n
        stiff = 1.0 / at(f"{joint}.compliance_rad_per_n_mm") / bent**2
        return Hidden(name, where, (Change(f"{joint}.hardening_n_mm_per_rad3", add, stiff),), 10.0)
    if name == "creep":
        time_s = round(math.exp(rng.uniform(math.log(5.0), math.log(200.0))), 2)
        return Hidden(name, where, (Change("creep.ratio", add, 1.0),), 1.0, (("creep.time_constant_s", time_s),))
    if name == "thermal_softening":
        return Hidden(name, where, (Change("thermal.joint_compliance_per_degc", add, _sign(rng, 0.85)),), 0.08)
    if name == "gravity":
        weights = zip(("femur", "tibia", "knee"), rng.dirichlet([1.5, 1.5, 1.0]), strict=True)
        return Hidden(name, where, tuple(Change(f"gravity.{part}_n", add, float(s)) for part, s in weights), 30.0)
    if name == "joint_zero_offset":
        return Hidden(name, where, (Change(f"{joint}.zero_offset_rad", add, _sign(rng)),), 0.2)
    if name == "link_length_error":
        lengths = zip(("femur", "tibia"), [(1, 0), (0, 1), (1, 1), (1, -1)][int(rng.integers(4))], strict=True)
        sign = _sign(rng)
        return Hidden(
            name,
            where,
            tuple(Change(f"geometry.{link}_mm", add, sign * s * rng.uniform(0.7, 1.3)) for link, s in lengths if s),
            35.0,
        )
    if name in ("sensor_bias", "sensor_drift"):
        keys = ("bias_x_n", "bias_z_n") if name == "sensor_bias" else ("drift_x_n_per_s", "drift_z_n_per_s")
        unit = 1.0 if name == "sensor_bias" else 1.0 / whole_s
        return Hidden(
            name,
            where,
            (
                Change(f"sensor.{keys[0]}", add, unit * math.cos(angle)),
                Change(f"sensor.{keys[1]}", add, unit * math.sin(angle)),
            ),
            6.0,
        )
    if name == "sensor_gain":
        return Hidden(name, where, (Change("sensor.gain", multiply, _sign(rng)),), 0.7)
    if name == "sensor_rotation":
        return Hidden(name, where, (Change("sensor.rotation_rad", add, _sign(rng)),), 0.35)
    if name == "sensor_crosstalk":
        talk = [(1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.5), (0.5, 1.0)][int(rng.integers(5))]
        return Hidden(
            name,
            where,
            tuple(
                Change(f"sensor.crosstalk_{key}", add, s * _sign(rng))
                for key, s in zip(("xz", "zx"), talk, strict=True)
                if s
            ),
            0.3,
        )
    if name == "sensor_saturation":
        return Hidden(name, where, (Change("sensor.saturation_n", "peak", peak_n),), 1.5, (), 1e-4)
    if name == "contact_play":
        return Hidden(name, where, (Change("contact.play_mm", add, 1.0),), 1.0)
    raise ValueError(name)


def scales(believed: Array, whole_s: float) -> dict[str, float]:
    """A small but visible amount of every parameter of the catalogue, for derivatives."""
    out = {
        "link.femur.moment_transfer": 0.05,
        "base.x_mm_per_n": 1e-4,
        "base.z_mm_per_n": 1e-4,
        "base.rotation_rad_per_n_mm": 1e-8,
        "creep.ratio": 0.01,
        "creep.time_constant_s": 1.0,
        "thermal.joint_compliance_per_degc": 1e-3,
        "gravity.femur_n": 0.1,
        "gravity.tibia_n": 0.1,
        "gravity.knee_n": 0.1,
        "sensor.bias_x_n": 0.01,
        "sensor.bias_z_n": 0.01,
        "sensor.drift_x_n_per_s": 0.1 / whole_s,
        "sensor.drift_z_n_per_s": 0.1 / whole_s,
        "sensor.gain": 0.005,
        "sensor.rotation_rad": 0.002,
        "sensor.crosstalk_xz": 0.002,
        "sensor.crosstalk_zx": 0.002,
        "sensor.saturation_n": 0.01,
        "contact.play_mm": 1e-4,
        "change.bending_factor": 0.02,
        "geometry.femur_mm": 0.3,
        "geometry.tibia_mm": 0.3,
    }
    for part in ("femur", "tibia"):
        joint = float(believed[INDEX[f"joint.{part}.compliance_rad_per_n_mm"]])
        out |= {
            f"joint.{part}.compliance_rad_per_n_mm": 0.02 * joint,
            f"joint.{part}.gap_rad": 1e-6,
            f"joint.{part}.coulomb_n_mm": 0.01,
            f"joint.{part}.zero_offset_rad": 0.001,
            f"joint.{part}.hardening_n_mm_per_rad3": 1e3 / joint,
            f"link.{part}.axial_mm_per_n": 0.02 * float(believed[INDEX[f"link.{part}.axial_mm_per_n"]]),
            f"link.{part}.bending_mm_per_n": 0.02 * float(believed[INDEX[f"link.{part}.bending_mm_per_n"]]),
            f"link.{part}.tilt_rad": 0.005,
        }
    return out


@dataclass(frozen=True)
class Candidate:
    """An effect as something to fit: its parameters, and starts for those in which it is not linear."""

    name: str
    where: str
    keys: tuple[str, ...]
    starts: tuple[tuple[tuple[str, float], ...], ...] = ((),)
    frozen: tuple[str, ...] = ()

    @property
    def label(self) -> str:
        """As the class lists it."""
        return f"{self.name}@{self.where}"


def candidates(believed: Array, rows: Array, peak_n: float, deepest: dict[str, float]) -> list[Candidate]:
    """Every effect to fit. `deepest`: each joint's largest deflection [rad] and torque [N mm] in this test."""
    t = rows[:, 3]
    whole_s = float(t[-1])
    out = []
    for name, where in CATALOGUE:
        starts: tuple[tuple[tuple[str, float], ...], ...] = ((),)
        frozen: tuple[str, ...] = ()
        key = {
            "joint_compliance": f"{where}.compliance_rad_per_n_mm",
            "moment_transfer": "link.femur.moment_transfer",
            "backlash": f"{where}.gap_rad",
            "coulomb_friction": f"{where}.coulomb_n_mm",
            "joint_hardening": f"{where}.hardening_n_mm_per_rad3",
            "joint_zero_offset": f"{where}.zero_offset_rad",
            "thermal_softening": "thermal.joint_compliance_per_degc",
            "sensor_gain": "sensor.gain",
            "sensor_rotation": "sensor.rotation_rad",
            "sensor_saturation": "sensor.saturation_n",
            "contact_play": "contact.play_mm",
            "link_change": "change.bending_factor",
        }.get(name)
        keys: tuple[str, ...] = (
            (key,)
            if key
            else {
                "base_compliance": ("base.x_mm_per_n", "base.z_mm_per_n", "base.rotation_rad_per_n_mm"),
                "link_compliance_error": tuple(
                    f"{where}.{k}" for k in ("axial_mm_per_n", "bending_mm_per_n", "tilt_rad")
                ),
                "creep": ("creep.ratio",),
                "gravity": ("gravity.femur_n", "gravity.tibia_n", "gravity.knee_n"),
                "link_length_error": ("geometry.femur_mm", "geometry.tibia_mm"),
                "sensor_bias": ("sensor.bias_x_n", "sensor.bias_z_n"),
                "sensor_drift": ("sensor.drift_x_n_per_s", "sensor.drift_z_n_per_s"),
                "sensor_crosstalk": ("sensor.crosstalk_xz", "sensor.crosstalk_zx"),
            }[name]
        )
        joint = where.removeprefix("joint.")
        if name == "backlash":
            starts = tuple(((keys[0], share * deepest[f"{joint}_rad"]),) for share in (0.02, 0.1, 0.4))
        elif name == "coulomb_friction":
            starts = tuple(((keys[0], share * deepest[f"{joint}_n_mm"]),) for share in (0.005, 0.03, 0.15))
        elif name == "contact_play":
            deep = float(np.max(np.abs(rows[:, 5:7])))
            starts = tuple(((keys[0], share * deep),) for share in (0.005, 0.03, 0.15))
        elif name == "sensor_saturation":
            starts = tuple(((keys[0], share * peak_n),) for share in (0.97, 0.85, 0.6))
        elif name == "creep":
            starts = tuple((("creep.time_constant_s", time),) for time in (4.0, 15.0, 50.0, 150.0, 500.0))
        elif name == "link_change":
            link = float(where == "link.tibia")
            starts = tuple(
                (("change.at_s", share * whole_s), ("change.link", link)) for share in np.linspace(0.08, 0.92, 15)
            )
            frozen = ("change.at_s", "change.link")
        if name == "creep":
            keys = ("creep.ratio", "creep.time_constant_s")
        out.append(Candidate(name, where, keys, starts, frozen))
    return out
