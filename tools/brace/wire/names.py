"""Numbers of limb.toml by name. Written by tools/interface from dictionary.toml; do not edit."""

from __future__ import annotations

from math import inf

from brace.wire.parameter import Parameter

SCHEMA_HASH = 0xCF89D6DA

PARAMETERS: tuple[Parameter, ...] = (
    Parameter(
        0, 0, "geometry.coxa_mm", "limb.coxa_mm",
        unit="mm", low=0.0, high=10000.0, default=0.0, safe=57.0,
        description="the distance from the yaw axis to the femur axis",
    ),
    Parameter(
        1, 1, "geometry.femur_mm", "limb.femur_mm",
        unit="mm", low=1.0, high=10000.0, default=None, safe=185.0,
        description="the femur's length",
    ),
    Parameter(
        2, 2, "geometry.tibia_mm", "limb.tibia_mm",
        unit="mm", low=1.0, high=10000.0, default=None, safe=313.5,
        description="the tibia's length",
    ),
    Parameter(
        3, 3, "link.coxa.axial_mm_per_n", "limb.link[0].axial_mm_per_n",
        unit="mm/N", low=0.0, high=1000.0, default=0.0, safe=0.0,
        description="the coxa's compliance along itself",
    ),
    Parameter(
        4, 4, "link.coxa.bending_mm_per_n", "limb.link[0].bending_mm_per_n",
        unit="mm/N", low=0.0, high=1000.0, default=0.0, safe=0.0,
        description="the coxa's compliance across itself, in the limb's plane",
    ),
    Parameter(
        5, 5, "link.coxa.tilt_rad", "limb.link[0].tilt_rad",
        unit="rad", low=-1.5707963267948966, high=1.5707963267948966, default=0.0, safe=0.0,
        description="the turn of the compliance ellipsoid from the link's axis",
    ),
    Parameter(
        6, 6, "link.coxa.lateral_mm_per_n", "limb.link[0].lateral_mm_per_n",
        unit="mm/N", low=0.0, high=1000.0, default=0.0, safe=0.0,
        description="the coxa's compliance out of the limb's plane",
    ),
    Parameter(
        7, 7, "link.coxa.torsion_rad_per_n_mm", "limb.link[0].torsion_rad_per_n_mm",
        unit="rad/(N mm)", low=0.0, high=1.0, default=0.0, safe=0.0,
        description="the coxa's torsional compliance about itself",
    ),
    Parameter(
        8, 8, "link.coxa.moment_transfer", "limb.link[0].moment_transfer",
        unit="", low=0.0, high=1.0, default=0.0, safe=0.0, ratio=True,
        description="the strength of the uniform-beam coupling of force and moment",
    ),
    Parameter(
        9, 9, "link.femur.axial_mm_per_n", "limb.link[1].axial_mm_per_n",
        unit="mm/N", low=0.0, high=1000.0, default=0.0, safe=0.001,
        description="the femur's compliance along itself",
    ),
    Parameter(
        10, 10, "link.femur.bending_mm_per_n", "limb.link[1].bending_mm_per_n",
        unit="mm/N", low=0.0, high=1000.0, default=0.0, safe=0.06,
        description="the femur's compliance across itself, in the limb's plane",
    ),
    Parameter(
        11, 11, "link.femur.tilt_rad", "limb.link[1].tilt_rad",
        unit="rad", low=-1.5707963267948966, high=1.5707963267948966, default=0.0, safe=0.0,
        description="the turn of the compliance ellipsoid from the link's axis",
    ),
    Parameter(
        12, 12, "link.femur.lateral_mm_per_n", "limb.link[1].lateral_mm_per_n",
        unit="mm/N", low=0.0, high=1000.0, default=0.0, safe=0.0,
        description="the femur's compliance out of the limb's plane",
    ),
    Parameter(
        13, 13, "link.femur.torsion_rad_per_n_mm", "limb.link[1].torsion_rad_per_n_mm",
        unit="rad/(N mm)", low=0.0, high=1.0, default=0.0, safe=0.0,
        description="the femur's torsional compliance about itself",
    ),
    Parameter(
        14, 14, "link.femur.moment_transfer", "limb.link[1].moment_transfer",
        unit="", low=0.0, high=1.0, default=0.0, safe=0.0, ratio=True,
        description="the strength of the uniform-beam coupling of force and moment",
    ),
    Parameter(
        15, 15, "link.tibia.axial_mm_per_n", "limb.link[2].axial_mm_per_n",
        unit="mm/N", low=0.0, high=1000.0, default=0.0, safe=0.002,
        description="the tibia's compliance along itself",
    ),
    Parameter(
        16, 16, "link.tibia.bending_mm_per_n", "limb.link[2].bending_mm_per_n",
        unit="mm/N", low=0.0, high=1000.0, default=0.0, safe=0.25,
        description="the tibia's compliance across itself, in the limb's plane",
    ),
    Parameter(
        17, 17, "link.tibia.tilt_rad", "limb.link[2].tilt_rad",
        unit="rad", low=-1.5707963267948966, high=1.5707963267948966, default=0.0, safe=0.0,
        description="the turn of the compliance ellipsoid from the link's axis",
    ),
    Parameter(
        18, 18, "link.tibia.lateral_mm_per_n", "limb.link[2].lateral_mm_per_n",
        unit="mm/N", low=0.0, high=1000.0, default=0.0, safe=0.0,
        description="the tibia's compliance out of the limb's plane",
    ),
    Parameter(
        19, 19, "link.tibia.torsion_rad_per_n_mm", "limb.link[2].torsion_rad_per_n_mm",
        unit="rad/(N mm)", low=0.0, high=1.0, default=0.0, safe=0.0,
        description="the tibia's torsional compliance about itself",
    ),
    Parameter(
        20, 20, "link.tibia.moment_transfer", "limb.link[2].moment_transfer",
        unit="", low=0.0, high=1.0, default=0.0, safe=0.0, ratio=True,
        description="the strength of the uniform-beam coupling of force and moment",
    ),
    Parameter(
        21, 21, "joint.coxa.compliance_rad_per_n_mm", "limb.joint[0].compliance_rad_per_n_mm",
        unit="rad/(N mm)", low=0.0, high=1.0, default=0.0, safe=0.0,
        description="the compliance of gearbox and servo at theta0",
    ),
    Parameter(
        22, 22, "joint.coxa.gap_rad", "limb.joint[0].gap_rad",
        unit="rad", low=0.0, high=0.5, default=0.0, safe=0.0,
        description="the full play at theta0",
    ),
    Parameter(
        23, 23, "joint.coxa.zero_offset_rad", "limb.joint[0].zero_offset_rad",
        unit="rad", low=-0.5, high=0.5, default=0.0, safe=0.0,
        description="the true angle less the commanded one at theta0",
    ),
    Parameter(
        24, 24, "joint.femur.compliance_rad_per_n_mm", "limb.joint[1].compliance_rad_per_n_mm",
        unit="rad/(N mm)", low=0.0, high=1.0, default=0.0, safe=1e-05,
        description="the compliance of gearbox and servo at theta1",
    ),
    Parameter(
        25, 25, "joint.femur.gap_rad", "limb.joint[1].gap_rad",
        unit="rad", low=0.0, high=0.5, default=0.0, safe=0.0,
        description="the full play at theta1",
    ),
    Parameter(
        26, 26, "joint.femur.zero_offset_rad", "limb.joint[1].zero_offset_rad",
        unit="rad", low=-0.5, high=0.5, default=0.0, safe=0.0,
        description="the true angle less the commanded one at theta1",
    ),
    Parameter(
        27, 27, "joint.tibia.compliance_rad_per_n_mm", "limb.joint[2].compliance_rad_per_n_mm",
        unit="rad/(N mm)", low=0.0, high=1.0, default=0.0, safe=1.6e-05,
        description="the compliance of gearbox and servo at theta2",
    ),
    Parameter(
        28, 28, "joint.tibia.gap_rad", "limb.joint[2].gap_rad",
        unit="rad", low=0.0, high=0.5, default=0.0, safe=0.0,
        description="the full play at theta2",
    ),
    Parameter(
        29, 29, "joint.tibia.zero_offset_rad", "limb.joint[2].zero_offset_rad",
        unit="rad", low=-0.5, high=0.5, default=0.0, safe=0.0,
        description="the true angle less the commanded one at theta2",
    ),
    Parameter(
        30, 30, "base.x_mm_per_n", "limb.base.x_mm_per_n",
        unit="mm/N", low=0.0, high=1000.0, default=0.0, safe=0.0,
        description="the compliance of the base along x",
    ),
    Parameter(
        31, 31, "base.z_mm_per_n", "limb.base.z_mm_per_n",
        unit="mm/N", low=0.0, high=1000.0, default=0.0, safe=0.0,
        description="the compliance of the base along z",
    ),
    Parameter(
        32, 32, "base.rotation_rad_per_n_mm", "limb.base.rotation_rad_per_n_mm",
        unit="rad/(N mm)", low=0.0, high=1.0, default=0.0, safe=0.0,
        description="the compliance of the base in rotation about the femur axis",
    ),
    Parameter(
        33, 33, "uncertainty.length_mm", "limb.uncertainty.length_mm",
        unit="mm", low=0.0, high=100.0, default=0.0, safe=0.0,
        description="how far the lengths are trusted, as one sigma",
    ),
    Parameter(
        34, 34, "uncertainty.angle_rad", "limb.uncertainty.angle_rad",
        unit="rad", low=0.0, high=0.5, default=0.0, safe=0.0,
        description="how far the joints' zeros are trusted, as one sigma",
    ),
    Parameter(
        35, 35, "uncertainty.compliance_rel", "limb.uncertainty.compliance_rel",
        unit="", low=0.0, high=1.0, default=0.0, safe=0.0,
        description="how far every compliance is trusted, as one sigma relative to it",
    ),
    Parameter(
        36, 36, "uncertainty.gain_rel", "limb.uncertainty.gain_rel",
        unit="", low=0.0, high=1.0, default=0.0, safe=0.0,
        description="how far the sensor's gain is trusted, as one sigma relative to it",
    ),
    Parameter(
        37, 37, "joint.coxa.coulomb_n_mm", "drive[0].coulomb_n_mm",
        unit="N mm", low=0.0, high=1000000000.0, default=0.0, safe=0.0,
        description="the dry friction at theta0",
    ),
    Parameter(
        38, 38, "joint.coxa.coulomb_per_load_ratio", "drive[0].coulomb_per_load_ratio",
        unit="", low=0.0, high=0.9, default=0.0, safe=0.0,
        description="the share of the spring's torque that is added to the dry friction at theta0",
    ),
    Parameter(
        39, 39, "joint.coxa.hardening_n_mm_per_rad3", "drive[0].hardening_n_mm_per_rad3",
        unit="N mm/rad^3", low=0.0, high=1e+30, default=0.0, safe=0.0,
        description="the cubic stiffening at theta0",
    ),
    Parameter(
        40, 40, "motor.coxa.friction_n_mm", "drive[0].motor_friction_n_mm",
        unit="N mm", low=0.0, high=1000000.0, default=200.0, safe=200.0,
        description="the Coulomb friction of the coxa's motor and gears, before the play, at the joint",
    ),
    Parameter(
        41, 41, "motor.coxa.friction_tolerance_ratio", "drive[0].motor_friction_tolerance_ratio",
        unit="", low=0.0, high=1.0, default=1.0, safe=1.0,
        description="how far the motor's friction may be off, relative to itself, as it sticks, creeps and changes with load and place; measured gears have 1",
    ),
    Parameter(
        42, 42, "motor.coxa.inertia_n_mm_s2_per_rad", "drive[0].motor_inertia_n_mm_s2_per_rad",
        unit="N mm s^2/rad", low=0.0, high=1000000.0, default=20.0, safe=20.0,
        description="the inertia of the coxa's motor and gears, at the joint",
    ),
    Parameter(
        43, 43, "motor.coxa.torque_range_n_mm", "drive[0].torque_range_n_mm",
        unit="N mm", low=0.0, high=1000000.0, default=8000.0, safe=8000.0, open_low=True,
        description="the greatest torque of the coxa's motor, at the joint",
    ),
    Parameter(
        44, 44, "motor.coxa.torque_noise_n_mm", "drive[0].torque_noise_n_mm",
        unit="N mm", low=0.0, high=1000000.0, default=400.0, safe=400.0,
        description="one sigma of a sample of the motor's torque; at most the torque range",
    ),
    Parameter(
        45, 45, "motor.coxa.torque_bias_n_mm", "drive[0].torque_bias_n_mm",
        unit="N mm", low=0.0, high=1000000.0, default=80.0, safe=80.0,
        description="the bound of the torque sample's offset; at most the torque range",
    ),
    Parameter(
        46, 46, "motor.coxa.angle_step_rad", "drive[0].angle_step_rad",
        unit="rad", low=1e-07, high=0.01, default=2e-05, safe=2e-05,
        description="the resolution of the motor's angle, at the joint",
    ),
    Parameter(
        47, 47, "motor.coxa.angle_min_rad", "drive[0].angle_min_rad",
        unit="rad", low=-7.9, high=7.9, default=-3.2, safe=-3.2,
        description="the least commanded angle of the travel at theta0",
    ),
    Parameter(
        48, 48, "motor.coxa.angle_max_rad", "drive[0].angle_max_rad",
        unit="rad", low=-7.9, high=7.9, default=3.2, safe=3.2,
        description="the greatest commanded angle of the travel at theta0",
    ),
    Parameter(
        49, 49, "motor.coxa.takeup_torque_n_mm", "drive[0].takeup_torque_n_mm",
        unit="N mm", low=0.0, high=1000000.0, default=4000.0, safe=4000.0, open_low=True,
        description="the bound of the coxa's motor torque while play is taken up; at most the torque range",
    ),
    Parameter(
        50, 114, "motor.coxa.friction_per_torque_ratio", "drive[0].motor_friction_per_torque_ratio",
        unit="", low=0.0, high=0.9, default=0.0, safe=0.0,
        description="the share of the motor's torque that is added to the coxa's motor friction, because gears rub harder under load; docs/joints.md has published values",
    ),
    Parameter(
        51, 115, "motor.coxa.friction_per_load_ratio", "drive[0].motor_friction_per_load_ratio",
        unit="", low=0.0, high=0.9, default=0.0, safe=0.0,
        description="the share of the load behind the coxa's gear that is added to its motor friction",
    ),
    Parameter(
        52, 116, "motor.coxa.friction_sliding_ratio", "drive[0].motor_friction_sliding_ratio",
        unit="", low=0.0, high=1.0, default=0.5, safe=0.5,
        description="the least share of the coxa's motor friction that is left while the joint moves; published fits of geared servos have 0.4 to 0.9",
    ),
    Parameter(
        53, 117, "motor.coxa.torque_gain_rel", "drive[0].torque_gain_rel",
        unit="", low=0.0, high=1.0, default=0.28, safe=0.28,
        description="how far the coxa's torque by current is trusted, as one sigma relative to it; makers' constants and published fits of the same servos are apart by this much",
    ),
    Parameter(
        54, 50, "joint.femur.coulomb_n_mm", "drive[1].coulomb_n_mm",
        unit="N mm", low=0.0, high=1000000000.0, default=0.0, safe=0.0,
        description="the dry friction at theta1",
    ),
    Parameter(
        55, 51, "joint.femur.coulomb_per_load_ratio", "drive[1].coulomb_per_load_ratio",
        unit="", low=0.0, high=0.9, default=0.0, safe=0.0,
        description="the share of the spring's torque that is added to the dry friction at theta1",
    ),
    Parameter(
        56, 52, "joint.femur.hardening_n_mm_per_rad3", "drive[1].hardening_n_mm_per_rad3",
        unit="N mm/rad^3", low=0.0, high=1e+30, default=0.0, safe=0.0,
        description="the cubic stiffening at theta1",
    ),
    Parameter(
        57, 53, "motor.femur.friction_n_mm", "drive[1].motor_friction_n_mm",
        unit="N mm", low=0.0, high=1000000.0, default=200.0, safe=200.0,
        description="the Coulomb friction of the femur's motor and gears, before the play, at the joint",
    ),
    Parameter(
        58, 54, "motor.femur.friction_tolerance_ratio", "drive[1].motor_friction_tolerance_ratio",
        unit="", low=0.0, high=1.0, default=1.0, safe=1.0,
        description="how far the motor's friction may be off, relative to itself, as it sticks, creeps and changes with load and place; measured gears have 1",
    ),
    Parameter(
        59, 55, "motor.femur.inertia_n_mm_s2_per_rad", "drive[1].motor_inertia_n_mm_s2_per_rad",
        unit="N mm s^2/rad", low=0.0, high=1000000.0, default=20.0, safe=20.0,
        description="the inertia of the femur's motor and gears, at the joint",
    ),
    Parameter(
        60, 56, "motor.femur.torque_range_n_mm", "drive[1].torque_range_n_mm",
        unit="N mm", low=0.0, high=1000000.0, default=8000.0, safe=8000.0, open_low=True,
        description="the greatest torque of the femur's motor, at the joint",
    ),
    Parameter(
        61, 57, "motor.femur.torque_noise_n_mm", "drive[1].torque_noise_n_mm",
        unit="N mm", low=0.0, high=1000000.0, default=400.0, safe=400.0,
        description="one sigma of a sample of the motor's torque; at most the torque range",
    ),
    Parameter(
        62, 58, "motor.femur.torque_bias_n_mm", "drive[1].torque_bias_n_mm",
        unit="N mm", low=0.0, high=1000000.0, default=80.0, safe=80.0,
        description="the bound of the torque sample's offset; at most the torque range",
    ),
    Parameter(
        63, 59, "motor.femur.angle_step_rad", "drive[1].angle_step_rad",
        unit="rad", low=1e-07, high=0.01, default=2e-05, safe=2e-05,
        description="the resolution of the motor's angle, at the joint",
    ),
    Parameter(
        64, 60, "motor.femur.angle_min_rad", "drive[1].angle_min_rad",
        unit="rad", low=-7.9, high=7.9, default=-3.2, safe=-3.2,
        description="the least commanded angle of the travel at theta1",
    ),
    Parameter(
        65, 61, "motor.femur.angle_max_rad", "drive[1].angle_max_rad",
        unit="rad", low=-7.9, high=7.9, default=3.2, safe=3.2,
        description="the greatest commanded angle of the travel at theta1",
    ),
    Parameter(
        66, 62, "motor.femur.takeup_torque_n_mm", "drive[1].takeup_torque_n_mm",
        unit="N mm", low=0.0, high=1000000.0, default=4000.0, safe=4000.0, open_low=True,
        description="the bound of the femur's motor torque while play is taken up; at most the torque range",
    ),
    Parameter(
        67, 118, "motor.femur.friction_per_torque_ratio", "drive[1].motor_friction_per_torque_ratio",
        unit="", low=0.0, high=0.9, default=0.0, safe=0.0,
        description="the share of the motor's torque that is added to the femur's motor friction, because gears rub harder under load; docs/joints.md has published values",
    ),
    Parameter(
        68, 119, "motor.femur.friction_per_load_ratio", "drive[1].motor_friction_per_load_ratio",
        unit="", low=0.0, high=0.9, default=0.0, safe=0.0,
        description="the share of the load behind the femur's gear that is added to its motor friction",
    ),
    Parameter(
        69, 120, "motor.femur.friction_sliding_ratio", "drive[1].motor_friction_sliding_ratio",
        unit="", low=0.0, high=1.0, default=0.5, safe=0.5,
        description="the least share of the femur's motor friction that is left while the joint moves; published fits of geared servos have 0.4 to 0.9",
    ),
    Parameter(
        70, 121, "motor.femur.torque_gain_rel", "drive[1].torque_gain_rel",
        unit="", low=0.0, high=1.0, default=0.28, safe=0.28,
        description="how far the femur's torque by current is trusted, as one sigma relative to it; makers' constants and published fits of the same servos are apart by this much",
    ),
    Parameter(
        71, 63, "joint.tibia.coulomb_n_mm", "drive[2].coulomb_n_mm",
        unit="N mm", low=0.0, high=1000000000.0, default=0.0, safe=0.0,
        description="the dry friction at theta2",
    ),
    Parameter(
        72, 64, "joint.tibia.coulomb_per_load_ratio", "drive[2].coulomb_per_load_ratio",
        unit="", low=0.0, high=0.9, default=0.0, safe=0.0,
        description="the share of the spring's torque that is added to the dry friction at theta2",
    ),
    Parameter(
        73, 65, "joint.tibia.hardening_n_mm_per_rad3", "drive[2].hardening_n_mm_per_rad3",
        unit="N mm/rad^3", low=0.0, high=1e+30, default=0.0, safe=0.0,
        description="the cubic stiffening at theta2",
    ),
    Parameter(
        74, 66, "motor.tibia.friction_n_mm", "drive[2].motor_friction_n_mm",
        unit="N mm", low=0.0, high=1000000.0, default=200.0, safe=200.0,
        description="the Coulomb friction of the tibia's motor and gears, before the play, at the joint",
    ),
    Parameter(
        75, 67, "motor.tibia.friction_tolerance_ratio", "drive[2].motor_friction_tolerance_ratio",
        unit="", low=0.0, high=1.0, default=1.0, safe=1.0,
        description="how far the motor's friction may be off, relative to itself, as it sticks, creeps and changes with load and place; measured gears have 1",
    ),
    Parameter(
        76, 68, "motor.tibia.inertia_n_mm_s2_per_rad", "drive[2].motor_inertia_n_mm_s2_per_rad",
        unit="N mm s^2/rad", low=0.0, high=1000000.0, default=20.0, safe=20.0,
        description="the inertia of the tibia's motor and gears, at the joint",
    ),
    Parameter(
        77, 69, "motor.tibia.torque_range_n_mm", "drive[2].torque_range_n_mm",
        unit="N mm", low=0.0, high=1000000.0, default=8000.0, safe=8000.0, open_low=True,
        description="the greatest torque of the tibia's motor, at the joint",
    ),
    Parameter(
        78, 70, "motor.tibia.torque_noise_n_mm", "drive[2].torque_noise_n_mm",
        unit="N mm", low=0.0, high=1000000.0, default=400.0, safe=400.0,
        description="one sigma of a sample of the motor's torque; at most the torque range",
    ),
    Parameter(
        79, 71, "motor.tibia.torque_bias_n_mm", "drive[2].torque_bias_n_mm",
        unit="N mm", low=0.0, high=1000000.0, default=80.0, safe=80.0,
        description="the bound of the torque sample's offset; at most the torque range",
    ),
    Parameter(
        80, 72, "motor.tibia.angle_step_rad", "drive[2].angle_step_rad",
        unit="rad", low=1e-07, high=0.01, default=2e-05, safe=2e-05,
        description="the resolution of the motor's angle, at the joint",
    ),
    Parameter(
        81, 73, "motor.tibia.angle_min_rad", "drive[2].angle_min_rad",
        unit="rad", low=-7.9, high=7.9, default=-3.2, safe=-3.2,
        description="the least commanded angle of the travel at theta2",
    ),
    Parameter(
        82, 74, "motor.tibia.angle_max_rad", "drive[2].angle_max_rad",
        unit="rad", low=-7.9, high=7.9, default=3.2, safe=3.2,
        description="the greatest commanded angle of the travel at theta2",
    ),
    Parameter(
        83, 75, "motor.tibia.takeup_torque_n_mm", "drive[2].takeup_torque_n_mm",
        unit="N mm", low=0.0, high=1000000.0, default=4000.0, safe=4000.0, open_low=True,
        description="the bound of the tibia's motor torque while play is taken up; at most the torque range",
    ),
    Parameter(
        84, 122, "motor.tibia.friction_per_torque_ratio", "drive[2].motor_friction_per_torque_ratio",
        unit="", low=0.0, high=0.9, default=0.0, safe=0.0,
        description="the share of the motor's torque that is added to the tibia's motor friction, because gears rub harder under load; docs/joints.md has published values",
    ),
    Parameter(
        85, 123, "motor.tibia.friction_per_load_ratio", "drive[2].motor_friction_per_load_ratio",
        unit="", low=0.0, high=0.9, default=0.0, safe=0.0,
        description="the share of the load behind the tibia's gear that is added to its motor friction",
    ),
    Parameter(
        86, 124, "motor.tibia.friction_sliding_ratio", "drive[2].motor_friction_sliding_ratio",
        unit="", low=0.0, high=1.0, default=0.5, safe=0.5,
        description="the least share of the tibia's motor friction that is left while the joint moves; published fits of geared servos have 0.4 to 0.9",
    ),
    Parameter(
        87, 125, "motor.tibia.torque_gain_rel", "drive[2].torque_gain_rel",
        unit="", low=0.0, high=1.0, default=0.28, safe=0.28,
        description="how far the tibia's torque by current is trusted, as one sigma relative to it; makers' constants and published fits of the same servos are apart by this much",
    ),
    Parameter(
        88, 76, "gravity.femur_n", "gravity.femur_n",
        unit="N", low=0.0, high=1000000.0, default=0.0, safe=0.0,
        description="the femur's weight, at mid-length",
    ),
    Parameter(
        89, 77, "gravity.tibia_n", "gravity.tibia_n",
        unit="N", low=0.0, high=1000000.0, default=0.0, safe=0.0,
        description="the tibia's weight, at mid-length",
    ),
    Parameter(
        90, 78, "gravity.knee_n", "gravity.knee_n",
        unit="N", low=0.0, high=1000000.0, default=0.0, safe=0.0,
        description="the weight at the knee joint",
    ),
    Parameter(
        91, 108, "gravity.direction_rad", "gravity.direction_rad",
        unit="rad", low=-3.141592653589793, high=3.141592653589793, default=-1.5707963267948966, safe=-1.5707963267948966,
        description="the direction of down in the limb's plane, from +x, until the main computer says another one",
    ),
    Parameter(
        92, 109, "gravity.lean_rad", "gravity.lean_rad",
        unit="rad", low=-1.5707963267948966, high=1.5707963267948966, default=0.0, safe=0.0,
        description="how far down leans out of the limb's plane, to the left: its part in the plane is shortened by the cosine",
    ),
    Parameter(
        93, 79, "sensor.bias_x_n", "sensor.bias_x_n",
        unit="N", low=-1000000.0, high=1000000.0, default=0.0, safe=0.0,
        description="a constant added to every reading along x",
    ),
    Parameter(
        94, 80, "sensor.bias_z_n", "sensor.bias_z_n",
        unit="N", low=-1000000.0, high=1000000.0, default=0.0, safe=0.0,
        description="a constant added to every reading along z",
    ),
    Parameter(
        95, 81, "sensor.gain", "sensor.gain",
        unit="", low=0.0, high=1000.0, default=1.0, safe=1.0, open_low=True,
        description="the factor on every force",
    ),
    Parameter(
        96, 82, "sensor.rotation_rad", "sensor.rotation_rad",
        unit="rad", low=-3.141592653589793, high=3.141592653589793, default=0.0, safe=0.0,
        description="how far the sensor is turned in the limb's plane",
    ),
    Parameter(
        97, 83, "sensor.crosstalk_xz", "sensor.crosstalk_xz",
        unit="", low=-1.0, high=1.0, default=0.0, safe=0.0,
        description="the share of the force along z that the sensor reads on x",
    ),
    Parameter(
        98, 84, "sensor.crosstalk_zx", "sensor.crosstalk_zx",
        unit="", low=-1.0, high=1.0, default=0.0, safe=0.0,
        description="the share of the force along x that the sensor reads on z",
    ),
    Parameter(
        99, 85, "sensor.drift_x_n_per_s", "sensor.drift_x_n_per_s",
        unit="N/s", low=-1000.0, high=1000.0, default=0.0, safe=0.0,
        description="the drift of the reading along x",
    ),
    Parameter(
        100, 86, "sensor.drift_z_n_per_s", "sensor.drift_z_n_per_s",
        unit="N/s", low=-1000.0, high=1000.0, default=0.0, safe=0.0,
        description="the drift of the reading along z",
    ),
    Parameter(
        101, 87, "sensor.saturation_n", "sensor.saturation_n",
        unit="N", low=0.0, high=inf, default=inf, safe=inf, open_low=True, infinite=True,
        description="the magnitude at which the sensor clips each reading",
    ),
    Parameter(
        102, 88, "sensor.noise_n", "sensor.noise_n",
        unit="N", low=0.0, high=1000000.0, default=0.1, safe=0.1,
        description="one sigma of a reading, its resolution included",
    ),
    Parameter(
        103, 89, "creep.ratio", "slow.creep_ratio",
        unit="", low=0.0, high=1000.0, default=0.0, safe=0.0,
        description="the delayed deflection of each joint relative to its elastic one",
    ),
    Parameter(
        104, 90, "creep.time_constant_s", "slow.creep_time_constant_s",
        unit="s", low=0.0, high=inf, default=1.0, safe=1.0, open_low=True,
        description="the time constant of the delayed deflection",
    ),
    Parameter(
        105, 91, "thermal.joint_compliance_per_degc", "slow.joint_compliance_per_degc",
        unit="1/degC", low=-1.0, high=1.0, default=0.0, safe=0.0,
        description="the relative change of the joints' compliance",
    ),
    Parameter(
        106, 92, "thermal.reference_degc", "slow.reference_degc",
        unit="degC", low=-273.15, high=1000.0, default=22.0, safe=22.0,
        description="the temperature that the compliances are given for",
    ),
    Parameter(
        107, 93, "contact.play_mm", "slow.contact_play_mm",
        unit="mm", low=0.0, high=1000.0, default=0.0, safe=0.0,
        description="the full clearance of the tip's ball joint, per axis",
    ),
    Parameter(
        108, 94, "change.at_s", "slow.change_at_s",
        unit="s", low=-inf, high=inf, default=inf, safe=inf, infinite=True,
        description="the time at which a link's bending changed; inf: it did not change",
    ),
    Parameter(
        109, 95, "change.link", "slow.change_link",
        unit="", low=0, high=2, default="tibia", safe=2, type="u32", texts=("coxa", "femur", "tibia",),
        description="the link that changed",
    ),
    Parameter(
        110, 96, "change.bending_factor", "slow.change_bending_factor",
        unit="", low=0.0, high=1000.0, default=1.0, safe=1.0, open_low=True,
        description="the factor on that link's bending compliance before then: [link] has today's",
    ),
    Parameter(
        111, 97, "controller.node_id", "controller.node_id",
        unit="", low=0, high=127, default=0, safe=0, type="u32",
        description="the limb's number on the CAN bus; 0 means unset: the controller listens and sends nothing",
    ),
    Parameter(
        112, 98, "controller.can_bit_rate", "controller.can_bit_rate",
        unit="bit/s", low=125000, high=1000000, default=1000000, safe=1000000, type="u32", numbers=(125000, 250000, 500000, 1000000,),
        description="the CAN bus's bit rate",
    ),
    Parameter(
        113, 99, "controller.tick_us", "controller.tick_us",
        unit="us", low=500, high=5000, default=1000, safe=1000, type="u32",
        description="the period of the controller's tick",
    ),
    Parameter(
        114, 100, "controller.age_limit_us", "controller.age_limit_us",
        unit="us", low=1000, high=10000000, default=20000, safe=20000, type="u32",
        description="the age above which K is called stale; at least the tick",
    ),
    Parameter(
        115, 101, "controller.stiffness_hz", "controller.stiffness_hz",
        unit="Hz", low=0, high=1000, default=200, safe=200, type="u32",
        description="how often K goes out on CAN; 0 means never",
    ),
    Parameter(
        116, 102, "controller.posture_hz", "controller.posture_hz",
        unit="Hz", low=0, high=1000, default=20, safe=20, type="u32",
        description="how often eigenvalues and posture go out on CAN, together with a K; 0 means never",
    ),
    Parameter(
        117, 110, "controller.load_hz", "controller.load_hz",
        unit="Hz", low=0, high=1000, default=0, safe=0, type="u32",
        description="how often the load that K counts and K without it go out on CAN, together with a K; 0 means never",
    ),
    Parameter(
        118, 113, "controller.sigma_hz", "controller.sigma_hz",
        unit="Hz", low=0, high=1000, default=10, safe=10, type="u32",
        description="how often K's uncertainty goes out on CAN, together with a K; 0 means never",
    ),
    Parameter(
        119, 103, "controller.heartbeat_hz", "controller.heartbeat_hz",
        unit="Hz", low=1, high=10, default=1, safe=1, type="u32",
        description="how often the heartbeat goes out",
    ),
    Parameter(
        120, 104, "controller.bus_load_ratio", "controller.bus_load_ratio",
        unit="", low=0.0, high=1.0, default=0.0625, safe=0.0625, open_low=True,
        description="the share of the bus that K, its uncertainty, eigenvalues, posture and load of this controller may take; the controller sends them less often where they would take more",
    ),
    Parameter(
        121, 105, "controller.can_fd_bit_rate", "controller.can_fd_bit_rate",
        unit="bit/s", low=0, high=8000000, default=0, safe=0, type="u32",
        description="the bit rate of a CAN FD snapshot's data; 0 means that classic frames are sent",
    ),
    Parameter(
        122, 111, "controller.let_go_after_ms", "controller.let_go_after_ms",
        unit="", low=0, high=600000, default=0, safe=0, type="u32",
        description="how many milliseconds after its owner has fallen silent the limb lets go by itself; 0 means never: it holds its set-points",
    ),
    Parameter(
        123, 112, "controller.stop_id", "controller.stop_id",
        unit="", low=1, high=127, default=1, safe=1, type="u32",
        description="the identifier of the CAN frame that stops every limb of the bus, whatever the frame carries; it wins over all other identifiers of a controller, and holds from the next start on",
    ),
    Parameter(
        124, 106, "controller.modbus_address", "controller.modbus_address",
        unit="", low=1, high=247, default=1, safe=1, type="u32",
        description="the controller's address on Modbus",
    ),
    Parameter(
        125, 107, "controller.modbus_baud", "controller.modbus_baud",
        unit="bit/s", low=1200, high=230400, default=115200, safe=115200, type="u32", numbers=(1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200, 230400,),
        description="the baud rate of Modbus RTU",
    ),
)
# Of the simulated limb alone: no controller keeps them.
OF_THE_MODEL: tuple[Parameter, ...] = (
    Parameter(
        0, -1, "joint.coxa.coulomb_load_fade_per_n_mm", "",
        unit="1/(N mm)", low=0.0, high=1.0, default=0.0, safe=0.0,
        description="how fast the share of the load that is added to the dry friction at theta0 fades: it is divided by the cube root of one plus this times the spring's torque",
    ),
    Parameter(
        1, -1, "joint.femur.coulomb_load_fade_per_n_mm", "",
        unit="1/(N mm)", low=0.0, high=1.0, default=0.0, safe=0.0,
        description="how fast the share of the load that is added to the dry friction at theta1 fades: it is divided by the cube root of one plus this times the spring's torque",
    ),
    Parameter(
        2, -1, "joint.tibia.coulomb_load_fade_per_n_mm", "",
        unit="1/(N mm)", low=0.0, high=1.0, default=0.0, safe=0.0,
        description="how fast the share of the load that is added to the dry friction at theta2 fades: it is divided by the cube root of one plus this times the spring's torque",
    ),
)
