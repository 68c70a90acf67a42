"""Every key of limb.toml: unit, range, default (the zero effect), meaning. The one list of them."""

from __future__ import annotations

import math

from brace.toml import Key

LINKS = ("coxa", "femur", "tibia")
JOINT_ANGLE = {"coxa": "theta0", "femur": "theta1", "tibia": "theta2"}
_RIGHT_ANGLE_RAD = math.pi / 2


def _link(link: str) -> list[Key]:
    at = f"link.{link}."
    return [
        Key(at + "axial_mm_per_n", 0.0, f"the {link}'s compliance along itself", "mm/N", 0.0, 1e3),
        Key(
            at + "bending_mm_per_n",
            0.0,
            f"the {link}'s compliance across itself, in the limb's plane",
            "mm/N",
            0.0,
            1e3,
        ),
        Key(
            at + "tilt_rad",
            0.0,
            "the turn of the compliance ellipsoid from the link's axis",
            "rad",
            -_RIGHT_ANGLE_RAD,
            _RIGHT_ANGLE_RAD,
        ),
        Key(
            at + "moment_transfer",
            0.0,
            "the strength of the uniform-beam coupling of force and moment",
            "",
            0.0,
            1.0,
            kind="ratio",
        ),
        Key(
            at + "lateral_mm_per_n", 0.0, f"the {link}'s compliance out of the limb's plane", "mm/N", 0.0, 1e3
        ),
        Key(at + "torsion_rad_per_n_mm", 0.0, f"the {link}'s twist about itself", "rad/(N mm)", 0.0, 1.0),
    ]


def _joint(joint: str) -> list[Key]:
    at, angle = f"joint.{joint}.", JOINT_ANGLE[joint]
    return [
        Key(
            at + "compliance_rad_per_n_mm",
            0.0,
            f"the compliance of gearbox and servo at {angle}",
            "rad/(N mm)",
            0.0,
            1.0,
        ),
        Key(at + "gap_rad", 0.0, f"the full play at {angle}", "rad", 0.0, 0.5),
        Key(at + "coulomb_n_mm", 0.0, f"the dry friction at {angle}", "N mm", 0.0, 1e9),
        Key(at + "hardening_n_mm_per_rad3", 0.0, f"the cubic stiffening at {angle}", "N mm/rad^3", 0.0),
        Key(
            at + "zero_offset_rad",
            0.0,
            f"what is added to the commanded {angle} to get the true one",
            "rad",
            -0.5,
            0.5,
        ),
    ]


LIMB_KEYS: tuple[Key, ...] = (
    Key("format", None, "the version of the file's format, 1", "", 1, 1, kind="integer"),
    Key("name", "", "a name for the limb", kind="text"),
    Key("geometry.coxa_mm", 0.0, "the distance from the yaw axis to the femur axis", "mm", 0.0, 1e4),
    Key("geometry.femur_mm", None, "the femur's length", "mm", 1.0, 1e4),
    Key("geometry.tibia_mm", None, "the tibia's length", "mm", 1.0, 1e4),
    *_link("coxa"),
    *_link("femur"),
    *_link("tibia"),
    *_joint("coxa"),
    *_joint("femur"),
    *_joint("tibia"),
    Key("base.x_mm_per_n", 0.0, "how the base yields along x", "mm/N", 0.0, 1e3),
    Key("base.z_mm_per_n", 0.0, "how the base yields along z", "mm/N", 0.0, 1e3),
    Key("base.rotation_rad_per_n_mm", 0.0, "how the base turns about the femur axis", "rad/(N mm)", 0.0, 1.0),
    Key("gravity.femur_n", 0.0, "the femur's weight, at mid-length", "N", 0.0, 1e6),
    Key("gravity.tibia_n", 0.0, "the tibia's weight, at mid-length", "N", 0.0, 1e6),
    Key("gravity.knee_n", 0.0, "the weight at the knee joint", "N", 0.0, 1e6),
    Key("sensor.bias_x_n", 0.0, "a constant added to every reading along x", "N", -1e6, 1e6),
    Key("sensor.bias_z_n", 0.0, "a constant added to every reading along z", "N", -1e6, 1e6),
    Key("sensor.gain", 1.0, "the factor on every force", "", 0.0, 1e3, open_low=True),
    Key(
        "sensor.rotation_rad",
        0.0,
        "how far the sensor is turned in the limb's plane",
        "rad",
        -math.pi,
        math.pi,
    ),
    Key("sensor.crosstalk_xz", 0.0, "what of f_z is read on x", "", -1.0, 1.0),
    Key("sensor.crosstalk_zx", 0.0, "what of f_x is read on z", "", -1.0, 1.0),
    Key("sensor.drift_x_n_per_s", 0.0, "the drift of the reading along x", "N/s", -1e3, 1e3),
    Key("sensor.drift_z_n_per_s", 0.0, "the drift of the reading along z", "N/s", -1e3, 1e3),
    Key(
        "sensor.saturation_n",
        math.inf,
        "where each reading is clipped",
        "N",
        0.0,
        open_low=True,
        infinite=True,
    ),
    Key("creep.ratio", 0.0, "each joint's delayed deflection over its elastic one", "", 0.0, 1e3),
    Key("creep.time_constant_s", 1.0, "the time constant of the delayed deflection", "s", 0.0, open_low=True),
    Key(
        "thermal.joint_compliance_per_degc",
        0.0,
        "the relative change of the joints' compliance",
        "1/degC",
        -1.0,
        1.0,
    ),
    Key(
        "thermal.reference_degc",
        22.0,
        "the temperature that the compliances are given for",
        "degC",
        -273.15,
        1e3,
    ),
    Key("contact.play_mm", 0.0, "the full clearance of the tip's ball joint, per axis", "mm", 0.0, 1e3),
    Key("change.at_s", math.inf, "when a link's bending changes", "s", infinite=True),
    Key("change.link", "tibia", "which link changes", kind="text", choices=LINKS),
    Key("change.bending_factor", 1.0, "the factor on its bending from then on", "", 0.0, 1e3, open_low=True),
    Key("uncertainty.length_mm", 0.0, "one sigma of the lengths", "mm", 0.0, 100.0),
    Key("uncertainty.angle_rad", 0.0, "one sigma of the joints' zeros", "rad", 0.0, 0.5),
    Key("uncertainty.compliance_rel", 0.0, "one relative sigma of every compliance", "", 0.0, 1.0),
    Key("uncertainty.gain_rel", 0.0, "one relative sigma of the sensor's gain", "", 0.0, 1.0),
)

KEY_BY_NAME = {key.name: key for key in LIMB_KEYS}

# Something must yield: at least one of these is positive in a limb that can be pushed.
PLANAR_COMPLIANCES = tuple(
    key.name
    for key in LIMB_KEYS
    if key.name.endswith(("_mm_per_n", "_rad_per_n_mm"))
    and "coxa" not in key.name
    and not key.name.endswith(("lateral_mm_per_n", "torsion_rad_per_n_mm"))
)
