"""A limb in its plane as a MuJoCo model (MJCF): springs where the limb yields, servos that hold their commanded angles.

A joint is a hinge with a servo of its stiffness: torque = (command + zero offset - angle) / compliance. A link's
ellipsoid is two slides at its end; a beam is two hinges at the Gauss points L (1/2 -+ 1/(2 sqrt 3)), each of compliance
3 b/(2 L^2), which have the uniform beam's three tip compliances exactly, and a slide along it at its root. The base has
slides and a hinge.
Each spring is damped so that alone it comes to rest with a time constant of two time steps. The engine counts damping
at the end of its step, so springs without mass stay stable; damped less, those of a limb without weights diverge.
SI units (m, N, N m/rad), x outwards, z up. Backlash, hardening, creep and temperature are not in it."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET

from brace.ground.errors import UsageError
from brace.model import LimbModel
from brace.model.travel import has_travel, travel_rad

RIGID_N_M_PER_RAD = 1e7
LEAST_KG, LEAST_KG_M2 = 1e-5, 1e-8
TIME_STEP_S = 0.0005
REST_S = 2.0 * TIME_STEP_S  # damping over stiffness; without mass the engine diverges below half a time step
SERVO_DAMPING_N_M_S = 0.5
G_M_PER_S2 = 9.80665
_ACROSS = {"theta1": "0 -1 0", "theta2": "0 1 0"}  # about these the angles grow as ours do


def model_xml(model: LimbModel, theta1_rad: float, theta2_rad: float) -> str:
    """The MJCF text; its keyframe `posture` stands at these commanded angles. Refuses a tilted link that is a beam."""
    root = ET.Element("mujoco", model=model.name)
    ET.SubElement(root, "compiler", angle="radian", autolimits="true")
    ET.SubElement(root, "option", gravity=f"0 0 {-G_M_PER_S2}", integrator="implicitfast", timestep=f"{TIME_STEP_S}")
    at = ET.SubElement(ET.SubElement(root, "worldbody"), "body", name="base")
    _mass(at, 0.0)
    for axis, name in (("1 0 0", "x_mm_per_n"), ("0 0 1", "z_mm_per_n")):
        _slide(at, f"base_{name[0]}", axis, model.number(f"base.{name}"))
    _hinge_spring(at, "base_rotation", model.number("base.rotation_rad_per_n_mm"), "0 -1 0")
    at = _link(ET.SubElement(at, "body", name="femur"), model, "femur", "theta1")
    at = _link(ET.SubElement(at, "body", name="tibia"), model, "tibia", "theta2")
    ET.SubElement(at, "site", name="tip", pos="0 0 0", size="0.004")
    actuators = ET.SubElement(root, "actuator")
    angles = {"theta1": theta1_rad, "theta2": theta2_rad}
    for joint, name in (("femur", "theta1"), ("tibia", "theta2")):
        stiffness = _servo_n_m_per_rad(model, joint)
        offset = model.number(f"joint.{joint}.zero_offset_rad")
        ET.SubElement(
            actuators,
            "general",
            name=name,
            joint=name,
            biastype="affine",
            gainprm=f"{stiffness!r}",
            biasprm=f"{stiffness * offset!r} {-stiffness!r} 0",
        )
    moving = [each.get("name") for each in root.iter("joint")]
    offsets = {
        "theta1": model.number("joint.femur.zero_offset_rad"),
        "theta2": model.number("joint.tibia.zero_offset_rad"),
    }
    qpos = " ".join(repr(angles[name] + offsets[name]) if name in angles else "0" for name in moving if name)
    keys = ET.SubElement(root, "keyframe")
    ET.SubElement(keys, "key", name="posture", qpos=qpos, ctrl=f"{theta1_rad!r} {theta2_rad!r}")
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def _link(body: ET.Element, model: LimbModel, link: str, angle: str) -> ET.Element:
    """The link's parts under `body`, which begins at its joint; the body at its end."""
    length = model.number(f"geometry.{link}_mm") * 1e-3
    axial, bending = (model.number(f"link.{link}.{name}_mm_per_n") for name in ("axial", "bending"))
    tilt, beam = model.number(f"link.{link}.tilt_rad"), model.number(f"link.{link}.moment_transfer")
    if beam > 0.0 and tilt != 0.0:
        raise UsageError(
            f"link.{link} is a beam and tilted",
            where=model.where(f"link.{link}.tilt_rad"),
            why="the MuJoCo model has no such part",
            next_step="moment_transfer = false, or tilt_rad = 0",
        )
    side = {"theta1": "femur", "theta2": "tibia"}[angle]
    damping = repr(max(SERVO_DAMPING_N_M_S, _servo_n_m_per_rad(model, side) * REST_S))
    joint = ET.SubElement(body, "joint", name=angle, type="hinge", axis=_ACROSS[angle], damping=damping)
    if has_travel(model, side):
        low, high = travel_rad(model, side)
        offset = model.number(f"joint.{side}.zero_offset_rad")
        joint.set("range", f"{low + offset!r} {high + offset!r}")
    friction = model.number(f"joint.{side}.coulomb_n_mm")
    if friction > 0.0:
        joint.set("frictionloss", repr(friction * 1e-3))
    weight = model.number(f"gravity.{link}_n")
    if beam > 0.0:
        _slide(body, f"{link}_axial", "1 0 0", axial)
        _mass(body, 0.0)
        first = length * (0.5 - 0.5 / math.sqrt(3.0))
        part, places = body, (first, length / math.sqrt(3.0), first)
        soft = 1.5 * beam * bending / (length * 1e3) ** 2  # of each hinge [rad/(N mm)]
        for number, place in enumerate(places[:2]):
            part = ET.SubElement(part, "body", name=f"{link}_{number + 1}", pos=f"{place!r} 0 0")
            _hinge_spring(part, f"{link}_bend_{number + 1}", soft, "0 -1 0")
            _mass(part, weight if number == 0 else 0.0, places[1] / 2.0)
        axial, bending, rest = 0.0, (1.0 - beam) * bending, places[2]
    else:
        _mass(body, weight, length / 2.0)
        part, rest = body, length
    _bar(body, f"{link}_shape", length)
    end = ET.SubElement(part, "body", name=f"{link}_end", pos=f"{rest!r} 0 0")
    _slide(end, f"{link}_end_along", f"{math.cos(tilt)!r} 0 {math.sin(tilt)!r}", axial)
    _slide(end, f"{link}_end_across", f"{-math.sin(tilt)!r} 0 {math.cos(tilt)!r}", bending)
    _mass(end, model.number("gravity.knee_n") if link == "femur" else 0.0)
    return end


def _mass(body: ET.Element, weight_n: float, place_m: float = 0.0) -> None:
    mass = max(weight_n / G_M_PER_S2, LEAST_KG)
    turning = f"{max(mass * 1e-4, LEAST_KG_M2)!r}"
    ET.SubElement(body, "inertial", pos=f"{place_m!r} 0 0", mass=f"{mass!r}", diaginertia=" ".join([turning] * 3))


def _bar(body: ET.Element, name: str, length_m: float) -> None:
    """To be seen; it weighs nothing and touches nothing."""
    ET.SubElement(
        body,
        "geom",
        name=name,
        type="capsule",
        fromto=f"0 0 0 {length_m!r} 0 0",
        size="0.006",
        contype="0",
        conaffinity="0",
        mass="0",
    )


def _servo_n_m_per_rad(model: LimbModel, joint: str) -> float:
    compliance = model.number(f"joint.{joint}.compliance_rad_per_n_mm")
    return min(1e-3 / compliance, RIGID_N_M_PER_RAD) if compliance > 0.0 else RIGID_N_M_PER_RAD


def _slide(body: ET.Element, name: str, axis: str, compliance_mm_per_n: float) -> None:
    if compliance_mm_per_n > 0.0:
        _spring(body, name, "slide", axis, 1e3 / compliance_mm_per_n)


def _hinge_spring(body: ET.Element, name: str, compliance_rad_per_n_mm: float, axis: str) -> None:
    if compliance_rad_per_n_mm > 0.0:
        _spring(body, name, "hinge", axis, 1e-3 / compliance_rad_per_n_mm)


def _spring(body: ET.Element, name: str, kind: str, axis: str, stiffness: float) -> None:
    ET.SubElement(
        body, "joint", name=name, type=kind, axis=axis, stiffness=repr(stiffness), damping=repr(stiffness * REST_S)
    )
