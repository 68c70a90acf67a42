"""The catalogue: every effect that a diagnosis can name, one plug-in a file, instruments before physics."""

from __future__ import annotations

from brace.diagnose.effects import (
    backlash,
    base_compliance,
    contact_play,
    coulomb_friction,
    creep,
    gravity,
    joint_compliance,
    joint_hardening,
    joint_zero_offset,
    link_change,
    link_compliance_error,
    link_length_error,
    moment_transfer,
    sensor_bias,
    sensor_crosstalk,
    sensor_drift,
    sensor_gain,
    sensor_rotation,
    sensor_saturation,
    thermal_softening,
)
from brace.diagnose.effects.variant import Setting, Variant

__all__ = ["PLUG_INS", "Setting", "Variant", "all_variants"]

PLUG_INS = (
    sensor_bias,
    sensor_drift,
    sensor_gain,
    sensor_rotation,
    sensor_crosstalk,
    sensor_saturation,
    joint_zero_offset,
    link_length_error,
    contact_play,
    joint_compliance,
    moment_transfer,
    base_compliance,
    link_compliance_error,
    link_change,
    backlash,
    coulomb_friction,
    joint_hardening,
    creep,
    thermal_softening,
    gravity,
)


def all_variants(setting: Setting) -> list[Variant]:
    """Every way in which an effect of the catalogue may show in this record."""
    return [variant for plug_in in PLUG_INS for variant in plug_in.variants(setting)]
