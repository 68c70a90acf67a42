"""K of a robot's chain with elastic joints and rigid links, by MuJoCo's Jacobian: J^-T k J^-1 at the foot's link."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree

import mujoco
import numpy as np
from chain import Array, Robot, at


class Engine:
    """A robot as MuJoCo compiles it, every link a body of its own."""

    def __init__(self, robot: Robot) -> None:
        tree = ElementTree.parse(robot.path).getroot()
        for link in tree.iter("link"):  # no mesh is read, and a weight changes no Jacobian
            for part in link.findall("*"):
                link.remove(part)
            inertial = ElementTree.SubElement(link, "inertial")
            ElementTree.SubElement(inertial, "mass", value="1")
            ElementTree.SubElement(inertial, "inertia", ixx="1", iyy="1", izz="1", ixy="0", ixz="0", iyz="0")
        for joint in tree.findall("joint"):  # of mimics and of equal limits the engine warns, into a file
            for part in [*joint.findall("mimic"), *joint.findall("limit")]:
                joint.remove(part)
            if joint.get("type") == "revolute":
                joint.set("type", "continuous")
        ElementTree.SubElement(ElementTree.SubElement(tree, "mujoco"), "compiler", fusestatic="false")
        for old in tree.findall("mujoco")[:-1]:
            tree.remove(old)
        self.model = mujoco.MjModel.from_xml_string(ElementTree.tostring(tree, encoding="unicode"))
        self.data = mujoco.MjData(self.model)

    def jacobian(self, robot: Robot, link: str, angles_rad: dict[str, float]) -> Array:
        """3 rows of the foot's place [mm], one column for each hinge of the chain; checked against plain rotations."""
        self.data.qpos[:] = self.model.qpos0
        names = [joint.name for joint in robot.moving_up_to(link)]
        for name in names:
            self.data.qpos[self.model.joint(name).qposadr[0]] = angles_rad[name]
        mujoco.mj_forward(self.model, self.data)
        full, body = np.zeros((3, self.model.nv)), self.model.body(link).id
        mujoco.mj_jacBody(self.model, self.data, full, None, body)
        by_hand = at(robot.joints_up_to(link), angles_rad)[1]
        assert np.allclose(1e3 * self.data.xpos[body], by_hand, atol=1e-6), (robot.path.name, link)
        columns: Array = 1e3 * full[:, [self.model.joint(name).dofadr[0] for name in names]]
        return columns


def stiffness(jacobian: Array, joint_n_mm_per_rad: Array) -> Array:
    """K [N/mm] of as many directions as joints."""
    inverse = np.linalg.inv(jacobian)
    k: Array = inverse.T @ np.diag(joint_n_mm_per_rad) @ inverse
    return k
