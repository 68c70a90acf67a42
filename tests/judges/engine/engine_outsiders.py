"""Limbs and rigs of the engine that no entry of the catalogue describes."""

from __future__ import annotations

import math

import outsiders
from designs import Rng
from outsiders import Outsider
from plant import INDEX, Array

KINDS = ("encoder_ripple", "slip", "asymmetric_joint", "growing_backlash", "off_centre_play", "sensor_curve",
         "warm_gain", "cable", "cogging", "end_stop")  # fmt: skip
# A knee's axis beside the femur's line is a femur a little longer and turned, and a tibia turned back; a bow tilts the
# directions in which a link yields. A rig that moves
# along turned axes is a turned sensor and a femur offset; one that yields along both axes is a base that does.
DISGUISED = (
    ("rig_turned", ("sensor_rotation@sensor", "joint_zero_offset@joint.femur")),
    ("rig_yields", ("base_compliance@base",)),
    ("knee_offset", ("joint_zero_offset@joint.femur", "joint_zero_offset@joint.tibia", "link_length_error@geometry")),
    ("bowed_tibia", ("link_compliance_error@link.tibia",)),
)


def draw(
    rng: Rng, name: str, p: Array, whole_s: float, peak_n: float, deepest: dict[str, float], step_mm: float
) -> Outsider:
    """An outsider with its numbers drawn at random."""
    sign = float(rng.choice([-1.0, 1.0]))
    reach_mm = float(p[INDEX["geometry.femur_mm"]] + p[INDEX["geometry.tibia_mm"]])
    link = str(rng.choice(["femur", "tibia"]))
    soft = float(p[INDEX[f"joint.{link}.compliance_rad_per_n_mm"]])
    if name == "cable":  # from beside the base to the tibia: slack where the limb is folded, taut where it is stretched
        return Outsider(
            name, 5.0, keys=(("outside.cable_n_per_mm", 1.0),),
            fixed=(
                ("outside.tibia_cable_at", rng.uniform(0.2, 0.8)),
                ("outside.cable_from_x_mm", rng.uniform(-40.0, 40.0)),
                ("outside.cable_from_z_mm", rng.uniform(20.0, 80.0)),
                ("outside.cable_mm", reach_mm * rng.uniform(0.3, 0.55)),
            ),
        )  # fmt: skip
    if name == "end_stop":  # beyond some deflection a second, stiffer spring
        share = rng.uniform(0.1, 0.6)
        return Outsider(
            name, 20.0 / soft, keys=((f"outside.{link}_stop_n_mm_per_rad", 1.0),),
            fixed=((f"outside.{link}_stop_rad", share * deepest[f"{link}_rad"]),),
        )  # fmt: skip
    if name == "cogging":  # torque ripple over the deflection, never steeper than the spring: one rest a row
        period = max(deepest[f"{link}_rad"] * rng.uniform(0.4, 1.6), 1e-5)
        stiff = min(1.0 / float(p[INDEX[f"joint.{x}.compliance_rad_per_n_mm"]]) for x in ("femur", "tibia"))
        return Outsider(
            name, 0.9 * stiff * period / (2.0 * math.pi), keys=(("outside.cogging_n_mm", 1.0),),
            fixed=(("outside.cogging_period_rad", period),),
        )  # fmt: skip
    if name == "bowed_tibia":
        return Outsider(name, 80.0, keys=(("outside.tibia_bow_mm", sign),))
    if name == "knee_offset":  # the knee's axis beside the femur's line
        return Outsider(name, 40.0, keys=(("outside.knee_offset_mm", sign),))
    if name == "rig_turned":
        return Outsider(name, 0.05, keys=(("outside.rig_turn_rad", sign),))
    if name == "rig_yields":
        return Outsider(name, 0.06, keys=(("outside.rig_mm_per_n", 1.0),))
    return outsiders.draw(rng, name, p, whole_s, peak_n, deepest, step_mm)
