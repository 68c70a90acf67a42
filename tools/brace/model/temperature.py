"""A limb whose joints are warmer or colder than its compliances are given for."""

from __future__ import annotations

from brace.ground.errors import UsageError
from brace.model.limb import LimbModel

WARMER_MOST_DEGC = 200.0  # as the controller: it takes a reading that is further off for none
_LEAST_FACTOR = 1e-3  # no temperature makes a spring push the wrong way
_JOINTS = ("coxa", "femur", "tibia")


def at_temperature(model: LimbModel, temp_degc: float) -> LimbModel:
    """The limb with its joints' compliance at a temperature, by [thermal]."""
    warmer_degc = temp_degc - model.number("thermal.reference_degc")
    if abs(warmer_degc) > WARMER_MOST_DEGC:
        raise UsageError(
            f"{temp_degc:g} degC is no joint's temperature",
            why=f"it is {abs(warmer_degc):g} degC from thermal.reference_degc; a controller takes no reading beyond "
            f"{WARMER_MOST_DEGC:g}",
            next_step="degrees Celsius, nearer to the reference",
        )
    factor = max(1.0 + model.number("thermal.joint_compliance_per_degc") * warmer_degc, _LEAST_FACTOR)
    keys = [f"joint.{joint}.compliance_rad_per_n_mm" for joint in _JOINTS]
    return model.with_values({key: factor * model.number(key) for key in keys})
