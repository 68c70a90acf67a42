"""A limb's lengths, zero offsets, travel, friction and weights as a URDF; its compliances, which a URDF has no words
for, as a comment."""

from __future__ import annotations

import xml.etree.ElementTree as ET

from brace.model import LimbModel
from brace.model.travel import travel_rad

G_M_PER_S2 = 9.80665
_AXIS = {"femur": ("theta1", "0 -1 0", -1.0), "tibia": ("theta2", "0 1 0", 1.0)}  # name, axis, sign of a pitch


def model_xml(model: LimbModel) -> str:
    """The URDF text. Joint angles are the commanded ones; x outwards, z up. A coxa of no length is left out."""
    root = ET.Element("robot", name=model.name)
    keys = [key for key in sorted(model.given) if key.endswith(("_per_n", "_per_n_mm"))]
    compliances = [f"{key} = {model.number(key):.9g}" for key in keys]
    root.append(ET.Comment(" compliances, for brace and MuJoCo: " + "; ".join(compliances) + " "))
    ET.SubElement(root, "link", name="base")
    parent, at_m = "base", 0.0
    if model.number("geometry.coxa_mm") > 0.0:
        _joint(
            root, model, "coxa", "theta0", "0 0 1", parent, 0.0, f"0 0 {model.number('joint.coxa.zero_offset_rad')!r}"
        )
        parent, at_m = "coxa", model.number("geometry.coxa_mm") * 1e-3
    for joint, (name, axis, sign) in _AXIS.items():
        offset = sign * model.number(f"joint.{joint}.zero_offset_rad")
        _joint(root, model, joint, name, axis, parent, at_m, f"0 {offset!r} 0")
        parent, at_m = joint, model.number(f"geometry.{joint}_mm") * 1e-3
    ET.SubElement(root, "link", name="foot")
    tip = ET.SubElement(root, "joint", name="tip", type="fixed")
    ET.SubElement(tip, "parent", link=parent)
    ET.SubElement(tip, "child", link="foot")
    ET.SubElement(tip, "origin", xyz=f"{at_m!r} 0 0", rpy="0 0 0")
    ET.indent(root)
    return '<?xml version="1.0"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _joint(
    root: ET.Element, model: LimbModel, joint: str, name: str, axis: str, parent: str, at_m: float, turn: str
) -> None:
    link = ET.SubElement(root, "link", name=joint)
    weight = model.number(f"gravity.{joint}_n") if joint != "coxa" else 0.0
    if weight > 0.0:
        mass, half = weight / G_M_PER_S2, model.number(f"geometry.{joint}_mm") * 0.5e-3
        inertial = ET.SubElement(link, "inertial")
        ET.SubElement(inertial, "origin", xyz=f"{half!r} 0 0")
        ET.SubElement(inertial, "mass", value=f"{mass!r}")
        turning = f"{mass * half**2 / 3.0!r}"  # a slender bar about its middle
        ET.SubElement(inertial, "inertia", ixx="1e-6", iyy=turning, izz=turning, ixy="0", ixz="0", iyz="0")
    low, high = travel_rad(model, joint)
    hinge = ET.SubElement(root, "joint", name=name, type="revolute")
    ET.SubElement(hinge, "parent", link=parent)
    ET.SubElement(hinge, "child", link=joint)
    ET.SubElement(hinge, "origin", xyz=f"{at_m!r} 0 0", rpy=turn)
    ET.SubElement(hinge, "axis", xyz=axis)
    effort = model.number(f"motor.{joint}.torque_range_n_mm") * 1e-3
    ET.SubElement(hinge, "limit", lower=f"{low!r}", upper=f"{high!r}", effort=f"{effort!r}", velocity="10")
    friction = model.number(f"joint.{joint}.coulomb_n_mm") * 1e-3
    ET.SubElement(hinge, "dynamics", friction=f"{friction!r}", damping="0")
