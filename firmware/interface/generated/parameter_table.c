/* Written by tools/interface from dictionary.toml; do not edit. */
#include "parameter_table.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

_Static_assert(sizeof(brace_parameters_t) == 4 * 126, "the dictionary lists every member");
_Static_assert(offsetof(brace_parameters_t, limb.coxa_mm) == 0, "order");
_Static_assert(offsetof(brace_parameters_t, limb.femur_mm) == 4, "order");
_Static_assert(offsetof(brace_parameters_t, limb.tibia_mm) == 8, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[0].axial_mm_per_n) == 12, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[0].bending_mm_per_n) == 16, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[0].tilt_rad) == 20, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[0].lateral_mm_per_n) == 24, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[0].torsion_rad_per_n_mm) == 28, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[0].moment_transfer) == 32, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[1].axial_mm_per_n) == 36, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[1].bending_mm_per_n) == 40, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[1].tilt_rad) == 44, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[1].lateral_mm_per_n) == 48, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[1].torsion_rad_per_n_mm) == 52, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[1].moment_transfer) == 56, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[2].axial_mm_per_n) == 60, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[2].bending_mm_per_n) == 64, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[2].tilt_rad) == 68, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[2].lateral_mm_per_n) == 72, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[2].torsion_rad_per_n_mm) == 76, "order");
_Static_assert(offsetof(brace_parameters_t, limb.link[2].moment_transfer) == 80, "order");
_Static_assert(offsetof(brace_parameters_t, limb.joint[0].compliance_rad_per_n_mm) == 84, "order");
_Static_assert(offsetof(brace_parameters_t, limb.joint[0].gap_rad) == 88, "order");
_Static_assert(offsetof(brace_parameters_t, limb.joint[0].zero_offset_rad) == 92, "order");
_Static_assert(offsetof(brace_parameters_t, limb.joint[1].compliance_rad_per_n_mm) == 96, "order");
_Static_assert(offsetof(brace_parameters_t, limb.joint[1].gap_rad) == 100, "order");
_Static_assert(offsetof(brace_parameters_t, limb.joint[1].zero_offset_rad) == 104, "order");
_Static_assert(offsetof(brace_parameters_t, limb.joint[2].compliance_rad_per_n_mm) == 108, "order");
_Static_assert(offsetof(brace_parameters_t, limb.joint[2].gap_rad) == 112, "order");
_Static_assert(offsetof(brace_parameters_t, limb.joint[2].zero_offset_rad) == 116, "order");
_Static_assert(offsetof(brace_parameters_t, limb.base.x_mm_per_n) == 120, "order");
_Static_assert(offsetof(brace_parameters_t, limb.base.z_mm_per_n) == 124, "order");
_Static_assert(offsetof(brace_parameters_t, limb.base.rotation_rad_per_n_mm) == 128, "order");
_Static_assert(offsetof(brace_parameters_t, limb.uncertainty.length_mm) == 132, "order");
_Static_assert(offsetof(brace_parameters_t, limb.uncertainty.angle_rad) == 136, "order");
_Static_assert(offsetof(brace_parameters_t, limb.uncertainty.compliance_rel) == 140, "order");
_Static_assert(offsetof(brace_parameters_t, limb.uncertainty.gain_rel) == 144, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].coulomb_n_mm) == 148, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].coulomb_per_load_ratio) == 152, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].hardening_n_mm_per_rad3) == 156, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].motor_friction_n_mm) == 160, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].motor_friction_tolerance_ratio) == 164, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].motor_inertia_n_mm_s2_per_rad) == 168, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].torque_range_n_mm) == 172, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].torque_noise_n_mm) == 176, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].torque_bias_n_mm) == 180, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].angle_step_rad) == 184, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].angle_min_rad) == 188, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].angle_max_rad) == 192, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].takeup_torque_n_mm) == 196, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].motor_friction_per_torque_ratio) == 200, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].motor_friction_per_load_ratio) == 204, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].motor_friction_sliding_ratio) == 208, "order");
_Static_assert(offsetof(brace_parameters_t, drive[0].torque_gain_rel) == 212, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].coulomb_n_mm) == 216, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].coulomb_per_load_ratio) == 220, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].hardening_n_mm_per_rad3) == 224, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].motor_friction_n_mm) == 228, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].motor_friction_tolerance_ratio) == 232, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].motor_inertia_n_mm_s2_per_rad) == 236, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].torque_range_n_mm) == 240, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].torque_noise_n_mm) == 244, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].torque_bias_n_mm) == 248, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].angle_step_rad) == 252, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].angle_min_rad) == 256, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].angle_max_rad) == 260, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].takeup_torque_n_mm) == 264, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].motor_friction_per_torque_ratio) == 268, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].motor_friction_per_load_ratio) == 272, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].motor_friction_sliding_ratio) == 276, "order");
_Static_assert(offsetof(brace_parameters_t, drive[1].torque_gain_rel) == 280, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].coulomb_n_mm) == 284, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].coulomb_per_load_ratio) == 288, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].hardening_n_mm_per_rad3) == 292, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].motor_friction_n_mm) == 296, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].motor_friction_tolerance_ratio) == 300, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].motor_inertia_n_mm_s2_per_rad) == 304, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].torque_range_n_mm) == 308, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].torque_noise_n_mm) == 312, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].torque_bias_n_mm) == 316, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].angle_step_rad) == 320, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].angle_min_rad) == 324, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].angle_max_rad) == 328, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].takeup_torque_n_mm) == 332, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].motor_friction_per_torque_ratio) == 336, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].motor_friction_per_load_ratio) == 340, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].motor_friction_sliding_ratio) == 344, "order");
_Static_assert(offsetof(brace_parameters_t, drive[2].torque_gain_rel) == 348, "order");
_Static_assert(offsetof(brace_parameters_t, gravity.femur_n) == 352, "order");
_Static_assert(offsetof(brace_parameters_t, gravity.tibia_n) == 356, "order");
_Static_assert(offsetof(brace_parameters_t, gravity.knee_n) == 360, "order");
_Static_assert(offsetof(brace_parameters_t, gravity.direction_rad) == 364, "order");
_Static_assert(offsetof(brace_parameters_t, gravity.lean_rad) == 368, "order");
_Static_assert(offsetof(brace_parameters_t, sensor.bias_x_n) == 372, "order");
_Static_assert(offsetof(brace_parameters_t, sensor.bias_z_n) == 376, "order");
_Static_assert(offsetof(brace_parameters_t, sensor.gain) == 380, "order");
_Static_assert(offsetof(brace_parameters_t, sensor.rotation_rad) == 384, "order");
_Static_assert(offsetof(brace_parameters_t, sensor.crosstalk_xz) == 388, "order");
_Static_assert(offsetof(brace_parameters_t, sensor.crosstalk_zx) == 392, "order");
_Static_assert(offsetof(brace_parameters_t, sensor.drift_x_n_per_s) == 396, "order");
_Static_assert(offsetof(brace_parameters_t, sensor.drift_z_n_per_s) == 400, "order");
_Static_assert(offsetof(brace_parameters_t, sensor.saturation_n) == 404, "order");
_Static_assert(offsetof(brace_parameters_t, sensor.noise_n) == 408, "order");
_Static_assert(offsetof(brace_parameters_t, slow.creep_ratio) == 412, "order");
_Static_assert(offsetof(brace_parameters_t, slow.creep_time_constant_s) == 416, "order");
_Static_assert(offsetof(brace_parameters_t, slow.joint_compliance_per_degc) == 420, "order");
_Static_assert(offsetof(brace_parameters_t, slow.reference_degc) == 424, "order");
_Static_assert(offsetof(brace_parameters_t, slow.contact_play_mm) == 428, "order");
_Static_assert(offsetof(brace_parameters_t, slow.change_at_s) == 432, "order");
_Static_assert(offsetof(brace_parameters_t, slow.change_link) == 436, "order");
_Static_assert(offsetof(brace_parameters_t, slow.change_bending_factor) == 440, "order");
_Static_assert(offsetof(brace_parameters_t, controller.node_id) == 444, "order");
_Static_assert(offsetof(brace_parameters_t, controller.can_bit_rate) == 448, "order");
_Static_assert(offsetof(brace_parameters_t, controller.tick_us) == 452, "order");
_Static_assert(offsetof(brace_parameters_t, controller.age_limit_us) == 456, "order");
_Static_assert(offsetof(brace_parameters_t, controller.stiffness_hz) == 460, "order");
_Static_assert(offsetof(brace_parameters_t, controller.posture_hz) == 464, "order");
_Static_assert(offsetof(brace_parameters_t, controller.load_hz) == 468, "order");
_Static_assert(offsetof(brace_parameters_t, controller.sigma_hz) == 472, "order");
_Static_assert(offsetof(brace_parameters_t, controller.heartbeat_hz) == 476, "order");
_Static_assert(offsetof(brace_parameters_t, controller.bus_load_ratio) == 480, "order");
_Static_assert(offsetof(brace_parameters_t, controller.can_fd_bit_rate) == 484, "order");
_Static_assert(offsetof(brace_parameters_t, controller.let_go_after_ms) == 488, "order");
_Static_assert(offsetof(brace_parameters_t, controller.stop_id) == 492, "order");
_Static_assert(offsetof(brace_parameters_t, controller.modbus_address) == 496, "order");
_Static_assert(offsetof(brace_parameters_t, controller.modbus_baud) == 500, "order");

const float brace_f32_range[25][2] = {
    {0.0f, 10000.0f},
    {1.0f, 10000.0f},
    {0.0f, 1000.0f},
    {-1.5707963267948966f, 1.5707963267948966f},
    {0.0f, 1.0f},
    {0.0f, 0.5f},
    {-0.5f, 0.5f},
    {0.0f, 100.0f},
    {0.0f, 1000000000.0f},
    {0.0f, 0.9f},
    {0.0f, 1e+30f},
    {0.0f, 1000000.0f},
    {0x1p-149f, 1000000.0f},
    {1e-07f, 0.01f},
    {-7.9f, 7.9f},
    {-3.141592653589793f, 3.141592653589793f},
    {-1000000.0f, 1000000.0f},
    {0x1p-149f, 1000.0f},
    {-1.0f, 1.0f},
    {-1000.0f, 1000.0f},
    {0x1p-149f, INFINITY},
    {0x1p-149f, FLT_MAX},
    {-273.15f, 1000.0f},
    {-INFINITY, INFINITY},
    {0x1p-149f, 1.0f},
};

const uint32_t brace_u32_range[10][2] = {
    {0u, 2u},
    {0u, 127u},
    {500u, 5000u},
    {1000u, 10000000u},
    {0u, 1000u},
    {1u, 10u},
    {0u, 8000000u},
    {0u, 600000u},
    {1u, 127u},
    {1u, 247u},
};

const uint32_t brace_u32_choices[2][9] = {
    {125000u, 250000u, 500000u, 1000000u},
    {1200u, 2400u, 4800u, 9600u, 19200u, 38400u, 57600u, 115200u, 230400u},
};

/* For each member: its range of floats, or of whole numbers after these, or its choices after those. */
const uint8_t brace_parameter_rule[126] = {
    0, 1, 1, 2, 2, 3, 2, 4, 4, 2, 2, 3, 2, 4, 4, 2, 2, 3, 2, 4, 4, 4, 5, 6, 4, 5, 6, 4, 5, 6, 2, 2, 4, 7, 5,
    4, 4, 8, 9, 10, 11, 4, 11, 12, 11, 11, 13, 14, 14, 12, 9, 9, 4, 4, 8, 9, 10, 11, 4, 11, 12, 11, 11, 13,
    14, 14, 12, 9, 9, 4, 4, 8, 9, 10, 11, 4, 11, 12, 11, 11, 13, 14, 14, 12, 9, 9, 4, 4, 11, 11, 11, 15, 3,
    16, 16, 17, 15, 18, 18, 19, 19, 20, 11, 2, 21, 18, 22, 2, 23, 25, 17, 26, 35, 27, 28, 29, 29, 29, 29, 30,
    24, 31, 32, 33, 34, 36,
};

const brace_parameters_t brace_parameters_safe = {
    .limb.coxa_mm = 57.0f,
    .limb.femur_mm = 185.0f,
    .limb.tibia_mm = 313.5f,
    .limb.link[1].axial_mm_per_n = 0.001f,
    .limb.link[1].bending_mm_per_n = 0.06f,
    .limb.link[2].axial_mm_per_n = 0.002f,
    .limb.link[2].bending_mm_per_n = 0.25f,
    .limb.joint[1].compliance_rad_per_n_mm = 1e-05f,
    .limb.joint[2].compliance_rad_per_n_mm = 1.6e-05f,
    .drive[0].motor_friction_n_mm = 200.0f,
    .drive[0].motor_friction_tolerance_ratio = 1.0f,
    .drive[0].motor_inertia_n_mm_s2_per_rad = 20.0f,
    .drive[0].torque_range_n_mm = 8000.0f,
    .drive[0].torque_noise_n_mm = 400.0f,
    .drive[0].torque_bias_n_mm = 80.0f,
    .drive[0].angle_step_rad = 2e-05f,
    .drive[0].angle_min_rad = -3.2f,
    .drive[0].angle_max_rad = 3.2f,
    .drive[0].takeup_torque_n_mm = 4000.0f,
    .drive[0].motor_friction_sliding_ratio = 0.5f,
    .drive[0].torque_gain_rel = 0.28f,
    .drive[1].motor_friction_n_mm = 200.0f,
    .drive[1].motor_friction_tolerance_ratio = 1.0f,
    .drive[1].motor_inertia_n_mm_s2_per_rad = 20.0f,
    .drive[1].torque_range_n_mm = 8000.0f,
    .drive[1].torque_noise_n_mm = 400.0f,
    .drive[1].torque_bias_n_mm = 80.0f,
    .drive[1].angle_step_rad = 2e-05f,
    .drive[1].angle_min_rad = -3.2f,
    .drive[1].angle_max_rad = 3.2f,
    .drive[1].takeup_torque_n_mm = 4000.0f,
    .drive[1].motor_friction_sliding_ratio = 0.5f,
    .drive[1].torque_gain_rel = 0.28f,
    .drive[2].motor_friction_n_mm = 200.0f,
    .drive[2].motor_friction_tolerance_ratio = 1.0f,
    .drive[2].motor_inertia_n_mm_s2_per_rad = 20.0f,
    .drive[2].torque_range_n_mm = 8000.0f,
    .drive[2].torque_noise_n_mm = 400.0f,
    .drive[2].torque_bias_n_mm = 80.0f,
    .drive[2].angle_step_rad = 2e-05f,
    .drive[2].angle_min_rad = -3.2f,
    .drive[2].angle_max_rad = 3.2f,
    .drive[2].takeup_torque_n_mm = 4000.0f,
    .drive[2].motor_friction_sliding_ratio = 0.5f,
    .drive[2].torque_gain_rel = 0.28f,
    .gravity.direction_rad = -1.5707963267948966f,
    .sensor.gain = 1.0f,
    .sensor.saturation_n = INFINITY,
    .sensor.noise_n = 0.1f,
    .slow.creep_time_constant_s = 1.0f,
    .slow.reference_degc = 22.0f,
    .slow.change_at_s = INFINITY,
    .slow.change_link = 2u,
    .slow.change_bending_factor = 1.0f,
    .controller.can_bit_rate = 1000000u,
    .controller.tick_us = 1000u,
    .controller.age_limit_us = 20000u,
    .controller.stiffness_hz = 200u,
    .controller.posture_hz = 20u,
    .controller.sigma_hz = 10u,
    .controller.heartbeat_hz = 1u,
    .controller.bus_load_ratio = 0.0625f,
    .controller.stop_id = 1u,
    .controller.modbus_address = 1u,
    .controller.modbus_baud = 115200u,
};

static const char *const keys[] = {
    "geometry.coxa_mm",
    "geometry.femur_mm",
    "geometry.tibia_mm",
    "link.coxa.axial_mm_per_n",
    "link.coxa.bending_mm_per_n",
    "link.coxa.tilt_rad",
    "link.coxa.lateral_mm_per_n",
    "link.coxa.torsion_rad_per_n_mm",
    "link.coxa.moment_transfer",
    "link.femur.axial_mm_per_n",
    "link.femur.bending_mm_per_n",
    "link.femur.tilt_rad",
    "link.femur.lateral_mm_per_n",
    "link.femur.torsion_rad_per_n_mm",
    "link.femur.moment_transfer",
    "link.tibia.axial_mm_per_n",
    "link.tibia.bending_mm_per_n",
    "link.tibia.tilt_rad",
    "link.tibia.lateral_mm_per_n",
    "link.tibia.torsion_rad_per_n_mm",
    "link.tibia.moment_transfer",
    "joint.coxa.compliance_rad_per_n_mm",
    "joint.coxa.gap_rad",
    "joint.coxa.zero_offset_rad",
    "joint.femur.compliance_rad_per_n_mm",
    "joint.femur.gap_rad",
    "joint.femur.zero_offset_rad",
    "joint.tibia.compliance_rad_per_n_mm",
    "joint.tibia.gap_rad",
    "joint.tibia.zero_offset_rad",
    "base.x_mm_per_n",
    "base.z_mm_per_n",
    "base.rotation_rad_per_n_mm",
    "uncertainty.length_mm",
    "uncertainty.angle_rad",
    "uncertainty.compliance_rel",
    "uncertainty.gain_rel",
    "joint.coxa.coulomb_n_mm",
    "joint.coxa.coulomb_per_load_ratio",
    "joint.coxa.hardening_n_mm_per_rad3",
    "motor.coxa.friction_n_mm",
    "motor.coxa.friction_tolerance_ratio",
    "motor.coxa.inertia_n_mm_s2_per_rad",
    "motor.coxa.torque_range_n_mm",
    "motor.coxa.torque_noise_n_mm",
    "motor.coxa.torque_bias_n_mm",
    "motor.coxa.angle_step_rad",
    "motor.coxa.angle_min_rad",
    "motor.coxa.angle_max_rad",
    "motor.coxa.takeup_torque_n_mm",
    "motor.coxa.friction_per_torque_ratio",
    "motor.coxa.friction_per_load_ratio",
    "motor.coxa.friction_sliding_ratio",
    "motor.coxa.torque_gain_rel",
    "joint.femur.coulomb_n_mm",
    "joint.femur.coulomb_per_load_ratio",
    "joint.femur.hardening_n_mm_per_rad3",
    "motor.femur.friction_n_mm",
    "motor.femur.friction_tolerance_ratio",
    "motor.femur.inertia_n_mm_s2_per_rad",
    "motor.femur.torque_range_n_mm",
    "motor.femur.torque_noise_n_mm",
    "motor.femur.torque_bias_n_mm",
    "motor.femur.angle_step_rad",
    "motor.femur.angle_min_rad",
    "motor.femur.angle_max_rad",
    "motor.femur.takeup_torque_n_mm",
    "motor.femur.friction_per_torque_ratio",
    "motor.femur.friction_per_load_ratio",
    "motor.femur.friction_sliding_ratio",
    "motor.femur.torque_gain_rel",
    "joint.tibia.coulomb_n_mm",
    "joint.tibia.coulomb_per_load_ratio",
    "joint.tibia.hardening_n_mm_per_rad3",
    "motor.tibia.friction_n_mm",
    "motor.tibia.friction_tolerance_ratio",
    "motor.tibia.inertia_n_mm_s2_per_rad",
    "motor.tibia.torque_range_n_mm",
    "motor.tibia.torque_noise_n_mm",
    "motor.tibia.torque_bias_n_mm",
    "motor.tibia.angle_step_rad",
    "motor.tibia.angle_min_rad",
    "motor.tibia.angle_max_rad",
    "motor.tibia.takeup_torque_n_mm",
    "motor.tibia.friction_per_torque_ratio",
    "motor.tibia.friction_per_load_ratio",
    "motor.tibia.friction_sliding_ratio",
    "motor.tibia.torque_gain_rel",
    "gravity.femur_n",
    "gravity.tibia_n",
    "gravity.knee_n",
    "gravity.direction_rad",
    "gravity.lean_rad",
    "sensor.bias_x_n",
    "sensor.bias_z_n",
    "sensor.gain",
    "sensor.rotation_rad",
    "sensor.crosstalk_xz",
    "sensor.crosstalk_zx",
    "sensor.drift_x_n_per_s",
    "sensor.drift_z_n_per_s",
    "sensor.saturation_n",
    "sensor.noise_n",
    "creep.ratio",
    "creep.time_constant_s",
    "thermal.joint_compliance_per_degc",
    "thermal.reference_degc",
    "contact.play_mm",
    "change.at_s",
    "change.link",
    "change.bending_factor",
    "controller.node_id",
    "controller.can_bit_rate",
    "controller.tick_us",
    "controller.age_limit_us",
    "controller.stiffness_hz",
    "controller.posture_hz",
    "controller.load_hz",
    "controller.sigma_hz",
    "controller.heartbeat_hz",
    "controller.bus_load_ratio",
    "controller.can_fd_bit_rate",
    "controller.let_go_after_ms",
    "controller.stop_id",
    "controller.modbus_address",
    "controller.modbus_baud",
};

static const char *const units[] = {
    "mm", "mm", "mm", "mm/N", "mm/N", "rad", "mm/N", "rad/(N mm)", "", "mm/N", "mm/N", "rad", "mm/N",
    "rad/(N mm)", "", "mm/N", "mm/N", "rad", "mm/N", "rad/(N mm)", "", "rad/(N mm)", "rad", "rad",
    "rad/(N mm)", "rad", "rad", "rad/(N mm)", "rad", "rad", "mm/N", "mm/N", "rad/(N mm)", "mm", "rad", "", "",
    "N mm", "", "N mm/rad^3", "N mm", "", "N mm s^2/rad", "N mm", "N mm", "N mm", "rad", "rad", "rad", "N mm",
    "", "", "", "", "N mm", "", "N mm/rad^3", "N mm", "", "N mm s^2/rad", "N mm", "N mm", "N mm", "rad",
    "rad", "rad", "N mm", "", "", "", "", "N mm", "", "N mm/rad^3", "N mm", "", "N mm s^2/rad", "N mm",
    "N mm", "N mm", "rad", "rad", "rad", "N mm", "", "", "", "", "N", "N", "N", "rad", "rad", "N", "N", "",
    "rad", "", "", "N/s", "N/s", "N", "N", "", "s", "1/degC", "degC", "mm", "s", "", "", "", "bit/s", "us",
    "us", "Hz", "Hz", "Hz", "Hz", "Hz", "", "bit/s", "", "", "", "bit/s",
};

const char *brace_parameter_key(uint32_t index)
{
    return index < BRACE_PARAMETER_COUNT ? keys[index] : "the limb as a whole";
}

const char *brace_parameter_unit(uint32_t index)
{
    return index < BRACE_PARAMETER_COUNT ? units[index] : "";
}

const uint16_t brace_parameter_indices[BRACE_PARAMETER_NUMBERS] = {
    0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28,
    29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42, 43, 44, 45, 46, 47, 48, 49, 54, 55, 56, 57, 58,
    59, 60, 61, 62, 63, 64, 65, 66, 71, 72, 73, 74, 75, 76, 77, 78, 79, 80, 81, 82, 83, 88, 89, 90, 93, 94,
    95, 96, 97, 98, 99, 100, 101, 102, 103, 104, 105, 106, 107, 108, 109, 110, 111, 112, 113, 114, 115, 116,
    119, 120, 121, 124, 125, 91, 92, 117, 122, 123, 118, 50, 51, 52, 53, 67, 68, 69, 70, 84, 85, 86, 87,
};

uint32_t brace_parameter_number(uint32_t index)
{
    static const uint16_t number[BRACE_PARAMETER_COUNT] = {
        0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28,
        29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42, 43, 44, 45, 46, 47, 48, 49, 114, 115, 116, 117,
        50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 118, 119, 120, 121, 63, 64, 65, 66, 67, 68, 69, 70,
        71, 72, 73, 74, 75, 122, 123, 124, 125, 76, 77, 78, 108, 109, 79, 80, 81, 82, 83, 84, 85, 86, 87, 88, 89,
        90, 91, 92, 93, 94, 95, 96, 97, 98, 99, 100, 101, 102, 110, 113, 103, 104, 105, 111, 112, 106, 107,
    };
    return index < BRACE_PARAMETER_COUNT ? number[index] : (uint32_t)BRACE_PARAMETER_NUMBERS;
}
