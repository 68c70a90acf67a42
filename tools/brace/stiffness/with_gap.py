"""K while a joint's backlash is open, by the firmware's own C (brace/gap_stiffness.h): that joint carries nothing."""

from __future__ import annotations

from collections.abc import Mapping

from brace.model import LimbModel
from brace.native import library
from brace.native.limb import firmware_limb, status_text
from brace.stiffness.at_rest import PostureError
from brace.stiffness.names import PLANAR_K, PLANAR_REST

JOINTS = ("femur", "tibia")


def gaps_rad(model: LimbModel, in_space: bool = False) -> dict[str, float]:
    """The backlash of each joint that has some: of the plane's joints, in space of the coxa joint too."""
    joints = ("coxa", *JOINTS) if in_space else JOINTS
    gaps = {joint: model.number(f"joint.{joint}.gap_rad") for joint in joints}
    return {joint: gap for joint, gap in gaps.items() if gap > 0.0}


def stiffness_while_open(
    model: LimbModel, theta1_rad: float, theta2_rad: float, engaged: Mapping[str, float], joint: str
) -> dict[str, float]:
    """K, eigenvalues, stiff axis and flags while the gap of `joint` is open; true angles [rad].

    engaged: the same numbers with every gap closed. Raises PostureError where the tip lies on the joint's axis."""
    native = library()
    ffi, lib = native.ffi, native.lib
    pose, k, found = ffi.new("brace_pose_t *"), ffi.new("brace_stiffness_t *"), ffi.new("brace_gap_stiffness_t *")
    for name in (*PLANAR_K, *PLANAR_REST):
        setattr(k, name, engaged[name])
    k.flags = int(engaged["flags"])
    lib.brace_kinematics_pose(firmware_limb(native, model), theta1_rad, theta2_rad, pose)
    open_gap = {"femur": lib.BRACE_GAP_FEMUR, "tibia": lib.BRACE_GAP_TIBIA}[joint]
    if status := lib.brace_gap_stiffness_known(k, pose, open_gap, found):
        raise PostureError(0, status, status_text(native, status))
    values = {name: float(getattr(found.now, name)) + 0.0 for name in (*PLANAR_K, *PLANAR_REST)}
    return {**values, "flags": int(found.now.flags)}
