"""The stiffness choice of the paper's Fig. 2: which posture of a sagging limb keeps its foot in the friction cone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from brace.stiffness.at_rest import PlanarLimb, PostureError

SAG_MM = 2.0
FRICTION_RATIO = 0.5


@dataclass(frozen=True)
class Stand:
    """A foot on a level ledge: angles [rad], force of the ledge on the foot [N], margin of the friction cone [N]."""

    r_mm: float
    theta_rad: tuple[float, float]
    force_n: np.ndarray
    margin_n: float
    holds: bool


def stand(limb: PlanarLimb, r_mm: float, height_mm: float) -> Stand:
    """The firmware's answer for a body that sags SAG_MM while the foot stays at (r, height)."""
    ffi, lib = limb.native.ffi, limb.native.lib
    theta1, theta2 = limb.posture(r_mm, float(np.arcsin(height_mm / r_mm)), "up")
    k = limb.stiffness(np.array([theta1]), np.array([theta2]))[0]
    stiffness = ffi.new("brace_stiffness_t *", {name: float(k[name]) for name in k.dtype.names
                                                if name[0] in "kls"} | {"flags": int(k["flags"])})
    contact = ffi.new("brace_contact_force_t *")
    grip = ffi.new("brace_contact_grip_t *")
    status = lib.brace_contact_force(stiffness, ffi.new("brace_displacement_t *", (0.0, SAG_MM))[0], contact) \
        or lib.brace_contact_grip(contact.force, 0.0, 1.0, FRICTION_RATIO, grip)
    if status:
        raise PostureError(0, status, ffi.string(lib.brace_status_text(status)).decode())
    force = np.array([contact.force.x_n, contact.force.z_n])
    return Stand(r_mm, (theta1, theta2), force, float(grip.margin_n), grip.state == lib.BRACE_CONTACT_HOLDS)


def firmest_and_loosest(limb: PlanarLimb, r_mm: np.ndarray, height_mm: float) -> tuple[Stand, Stand]:
    """Of the reaches r_mm at one foot height, the one with the most and the one with the least friction to spare,
    per newton of normal force."""
    stands = [stand(limb, float(r), height_mm) for r in r_mm]
    spare = [s.margin_n / s.force_n[1] for s in stands]
    return stands[int(np.argmax(spare))], stands[int(np.argmin(spare))]

