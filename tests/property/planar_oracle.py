"""K of a planar limb in extended precision, from physics.md's lever formula, and the limbs to judge with.

Shares no code and no algebra with the firmware: C is summed as a11 p1 p1' + a12 (p1 p2' + p2 p1') + ... with
explicit sines, and inverted by its cofactors, all in numpy's long double (64-bit mantissa on x86).
"""
from __future__ import annotations

import ctypes
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.longdouble]


@dataclass
class Link:
    """Compliances in mm/N (torsion in rad/(N mm)), tilt in rad; the order is the firmware's brace_link_t."""

    axial: float = 0.0
    bending: float = 0.0
    tilt: float = 0.0
    lateral: float = 0.0
    torsion: float = 0.0
    moment_transfer: float = 0.0

    def values(self) -> list[float]:
        return [self.axial, self.bending, self.tilt, self.lateral, self.torsion, self.moment_transfer]


@dataclass
class Limb:
    """A limb as the firmware's brace_limb_t holds it: mm, mm/N, rad/(N mm)."""

    name: str
    coxa_mm: float = 57.0
    femur_mm: float = 185.0
    tibia_mm: float = 313.5
    coxa: Link = field(default_factory=Link)
    femur: Link = field(default_factory=Link)
    tibia: Link = field(default_factory=Link)
    joints: tuple[float, float, float] = (0.0, 0.0, 0.0)
    base_x: float = 0.0
    base_z: float = 0.0
    base_rotation: float = 0.0

    def floats(self) -> ctypes.Array[ctypes.c_float]:
        """The 37 floats of brace_limb_t, in its order."""
        values = [self.coxa_mm, self.femur_mm, self.tibia_mm]
        for link in (self.coxa, self.femur, self.tibia):
            values += link.values()
        for compliance in self.joints:
            values += [compliance, 0.0, 0.0]
        values += [self.base_x, self.base_z, self.base_rotation, 0.5, 0.003, 0.05, 0.005]
        return (ctypes.c_float * 37)(*values)


def _exact(value: float) -> np.longdouble:
    """The value the firmware sees: rounded to float once."""
    return np.longdouble(np.float32(value))


@dataclass
class Planar:
    """C, K, eigenvalues and stiff axis at many postures; arrays of long double, shape (n,)."""

    c_xx: Reals
    c_xz: Reals
    c_zz: Reals
    k_xx: Reals
    k_xz: Reals
    k_zz: Reals
    lambda_min: Reals
    lambda_max: Reals
    axis: Reals


def planar(limb: Limb, theta1: NDArray[np.float32], theta2: NDArray[np.float32]) -> Planar:
    """The oracle at postures [rad], shape (n,)."""
    th1, th2 = theta1.astype(np.longdouble), theta2.astype(np.longdouble)
    l1, l2 = _exact(limb.femur_mm), _exact(limb.tibia_mm)
    c1, s1, c12, s12 = np.cos(th1), np.sin(th1), np.cos(th1 - th2), np.sin(th1 - th2)
    p2x, p2z = -l2 * s12, l2 * c12
    p1x, p1z = -l1 * s1 + p2x, l1 * c1 + p2z

    c_xx = np.full_like(th1, _exact(limb.base_x))
    c_xz = np.zeros_like(th1)
    c_zz = np.full_like(th1, _exact(limb.base_z))

    def add(s: np.longdouble, ax: Reals, az: Reals, bx: Reals, bz: Reals) -> None:
        nonlocal c_xx, c_xz, c_zz
        c_xx = c_xx + s * ax * bx
        c_xz = c_xz + s * (ax * bz + az * bx) / 2
        c_zz = c_zz + s * az * bz

    along = {}  # of each link's stiff direction: cosine, sine
    for link, angle in (("femur", th1), ("tibia", th1 - th2)):
        own: Link = getattr(limb, link)
        at = angle + _exact(own.tilt)
        c, s = along[link] = np.cos(at), np.sin(at)
        add(_exact(own.axial), c, s, c, s)
        add(_exact(own.bending), -s, c, -s, c)
    c, s = along["femur"]
    bent = _exact(limb.femur.bending) * _exact(limb.femur.moment_transfer)
    add(3 * bent / l1, -s, c, p2x, p2z)
    add(3 * bent / l1**2, p2x, p2z, p2x, p2z)
    add(_exact(limb.joints[1]) + _exact(limb.base_rotation), p1x, p1z, p1x, p1z)
    add(_exact(limb.joints[2]), p2x, p2z, p2x, p2z)

    det = c_xx * c_zz - c_xz * c_xz
    mean, dev = (c_xx + c_zz) / 2, np.hypot((c_xx - c_zz) / 2, c_xz)
    lambda_min: Any = 1 / (mean + dev)  # NumPy's stubs take these two for float64
    lambda_max: Any = (mean + dev) / det
    return Planar(c_xx, c_xz, c_zz, c_zz / det, -c_xz / det, c_xx / det, lambda_min, lambda_max,
                  np.arctan2(-2 * c_xz, c_zz - c_xx) / 2)


def limbs() -> list[Limb]:
    """Different limbs within the fast path's promise: slender, tilted, soft, stiff, equal legs."""
    steel = Link(axial=0.001, bending=0.06)
    shank = Link(axial=0.002, bending=0.25)
    return [
        Limb("check", femur=steel, tibia=shank, joints=(0, 1.0e-5, 1.6e-5)),
        Limb("beam", femur=Link(0.001, 0.06, moment_transfer=1), tibia=shank, joints=(0, 1.0e-5, 1.6e-5)),
        Limb("ellipsoids", femur=steel, tibia=shank),
        Limb("tilted", femur=Link(0.001, 0.06, 0.3), tibia=Link(0.002, 0.25, -0.4), joints=(0, 1e-5, 1.6e-5)),
        Limb("tilted beam", femur=Link(0.003, 0.09, -0.5, moment_transfer=1), tibia=Link(0.004, 0.2, 0.5),
             joints=(0, 6e-6, 9e-6)),
        Limb("equal legs", femur_mm=250, tibia_mm=250, femur=steel, tibia=shank, joints=(0, 1e-5, 1.6e-5)),
        Limb("slender", femur=Link(6e-5, 0.06), tibia=Link(2.5e-4, 0.25)),
        Limb("slender tilted", femur=Link(6e-5, 0.06, 0.2), tibia=Link(2.5e-4, 0.25, -0.5)),
        Limb("round", femur=Link(0.05, 0.05), tibia=Link(0.1, 0.1, 0.2), joints=(0, 1e-6, 1e-6)),
        Limb("soft servos", femur=steel, tibia=shank, joints=(0, 6e-5, 9e-5)),
        Limb("partial beam", femur=Link(0.002, 0.1, 0.1, moment_transfer=0.4), tibia=Link(0.001, 0.05),
             joints=(0, 3e-6, 5e-5), base_rotation=4e-6),
        Limb("small stiff", coxa_mm=10, femur_mm=40, tibia_mm=55, femur=Link(2e-5, 1e-3), tibia=Link(4e-5, 2e-3),
             joints=(0, 2e-6, 2e-6)),
        Limb("axial longest", femur=Link(0.08, 0.004, 0.2), tibia=Link(0.05, 0.01), joints=(0, 1e-6, 2e-6)),
        # the crosses of its elements vary hardly more in one direction than in another
        Limb("round crosses", femur_mm=210.5356, tibia_mm=22.307497,
             femur=Link(0.00019863536, 0.0023855101, 0.75385618, moment_transfer=0.33090669),
             tibia=Link(0.0112077, 0), joints=(0, 1.0915657e-6, 2.2507449e-5)),
        Limb("floating base", femur=steel, tibia=shank, joints=(0, 1e-5, 1.6e-5), base_x=0.02, base_z=0.02),
    ]


def random_limb(rng: np.random.Generator) -> Limb:
    """Any sane limb: slenderness 1e-3..1, tilt within 0.5 rad, springs from none to dominating."""
    def link() -> Link:
        bending = 10 ** rng.uniform(-3, 0)
        return Link(axial=bending * 10 ** rng.uniform(-3, 0), bending=bending,
                    tilt=rng.choice([0.0, rng.uniform(-0.5, 0.5)]),
                    moment_transfer=rng.choice([0.0, 1.0, rng.uniform(0, 1)]))

    def spring() -> float:
        return float(rng.choice([0.0, 10 ** rng.uniform(-7, -4)]))

    femur_mm = rng.uniform(50, 400)
    tibia_mm = rng.choice([femur_mm, rng.uniform(50, 400)])
    return Limb("random", femur_mm=femur_mm, tibia_mm=tibia_mm, femur=link(), tibia=link(),
                joints=(0.0, spring(), spring()))


def postures(rng: np.random.Generator, n: int) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """About 2 n postures [rad] over [-pi, pi]^2: a grid, random ones, and clusters at straight and folded."""
    side = max(4, int(np.sqrt(n)))
    edge = np.float32(np.pi)
    line = np.linspace(-edge, edge, side, dtype=np.float32)
    grid1, grid2 = (a.ravel() for a in np.meshgrid(line, line))
    near = 10 ** rng.uniform(-7, -0.5, n // 2) * rng.choice([-1, 1], n // 2)
    bend = np.concatenate([near[: n // 4], edge - np.abs(near[n // 4:]), rng.uniform(-edge, edge, n // 2)])
    theta2 = np.concatenate([grid2, np.clip(bend, -edge, edge), [0, edge, -edge]]).astype(np.float32)
    theta1 = np.concatenate([grid1, rng.uniform(-edge, edge, theta2.size - grid1.size)]).astype(np.float32)
    return theta1, theta2
