#include "posture/posture.h"

#define LEAST_KNEE_SINE 0.1f

void posture_start(posture_t *posture)
{
    *posture = (posture_t){.has_levers = false};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        posture->theta_rad[i] = __builtin_nanf("");
    }
}

bool posture_is_inside_travel(const brace_drive_t *drive, float theta_rad)
{
    return theta_rad >= drive->angle_min_rad && theta_rad <= drive->angle_max_rad;
}

void posture_take(posture_t *posture, const brace_parameters_t *parameters, const float motor_rad[BRACE_LINK_COUNT],
                  const float offset_rad[BRACE_LINK_COUNT])
{
    const brace_limb_t *limb = &parameters->limb;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        posture->theta_rad[i] = brace_limb_true_angle(limb, i, motor_rad[i] + offset_rad[i]);
    }
    const float theta1_rad = posture->theta_rad[BRACE_FEMUR], theta2_rad = posture->theta_rad[BRACE_TIBIA];
    posture->is_inside_travel = posture_is_inside_travel(&parameters->drive[BRACE_FEMUR], theta1_rad) &&
                                posture_is_inside_travel(&parameters->drive[BRACE_TIBIA], theta2_rad);
    posture->has_levers = __builtin_fabsf(theta1_rad) <= BRACE_ANGLE_LIMIT_RAD &&
                          __builtin_fabsf(theta2_rad) <= BRACE_ANGLE_LIMIT_RAD && limb->femur_mm > 0.0f &&
                          limb->tibia_mm > 0.0f;
    if (posture->has_levers) {
        brace_kinematics_pose(limb, theta1_rad, theta2_rad, &posture->pose);
    }
}

float posture_gravity_n_mm(const posture_t *posture, const brace_gravity_t *weight, int joint_index)
{
    const float knee_mm = posture->pose.knee.x_mm, shank_mm = 0.5f * (posture->pose.tip.x_mm - knee_mm);
    /* theta2 is flexion: it turns the tibia clockwise, so its motor holds the other way. */
    return joint_index == BRACE_FEMUR
               ? (0.5f * weight->femur_n + weight->knee_n + weight->tibia_n) * knee_mm + weight->tibia_n * shank_mm
               : -weight->tibia_n * shank_mm;
}

float posture_tip_load_n_mm(const posture_t *posture, float x_n, float z_n, int joint_index)
{
    const brace_point_t lever = joint_index == BRACE_FEMUR ? posture->pose.lever_femur : posture->pose.lever_tibia;
    const float counter_clockwise_n_mm = lever.x_mm * x_n + lever.z_mm * z_n;
    /* The motor carries the opposite of what the ground turns; theta2's sense is clockwise. */
    return joint_index == BRACE_FEMUR ? -counter_clockwise_n_mm : counter_clockwise_n_mm;
}

void posture_force_of_loads(const posture_t *posture, const brace_parameters_t *parameters, float femur_n_mm,
                            float tibia_n_mm, float *x_n, float *z_n)
{
    const brace_point_t femur = posture->pose.lever_femur, tibia = posture->pose.lever_tibia;
    const float cross_mm2 = femur.x_mm * tibia.z_mm - femur.z_mm * tibia.x_mm;
    const float least_mm2 = LEAST_KNEE_SINE * parameters->limb.femur_mm * parameters->limb.tibia_mm;
    *x_n = *z_n = __builtin_nanf("");
    if (posture->has_levers && __builtin_fabsf(cross_mm2) >= least_mm2) {
        const float about_femur_n_mm = posture_gravity_n_mm(posture, &parameters->gravity, BRACE_FEMUR) - femur_n_mm;
        const float about_tibia_n_mm = tibia_n_mm - posture_gravity_n_mm(posture, &parameters->gravity, BRACE_TIBIA);
        *x_n = (about_femur_n_mm * tibia.z_mm - about_tibia_n_mm * femur.z_mm) / cross_mm2;
        *z_n = (about_tibia_n_mm * femur.x_mm - about_femur_n_mm * tibia.x_mm) / cross_mm2;
    }
}
