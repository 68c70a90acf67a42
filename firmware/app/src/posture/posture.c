#include "posture/posture.h"

#include <stddef.h>

#define LEAST_KNEE_SINE 0.1f
#define LEAST_REACH_RATIO 0.1f /* of the limb's length: a shorter lever measures no force across the plane */

void posture_start(posture_t *posture)
{
    *posture = (posture_t){.has_levers = false};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        posture->unbent_rad[i] = posture->theta_rad[i] = __builtin_nanf("");
    }
}

bool posture_is_inside_travel(const brace_drive_t *drive, float theta_rad)
{
    return theta_rad >= drive->angle_min_rad && theta_rad <= drive->angle_max_rad;
}

/* Levers count from the axes where they stand without load: what the base yields is small beside them. */
static void go_to_bent(posture_t *posture)
{
    const brace_pose_t *unbent = &posture->unbent;
    const brace_vec_t tip = posture->tip_moved_mm, knee = posture->knee_moved_mm;
    posture->pose.tip = (brace_point_t){unbent->tip.x_mm + tip.x, unbent->tip.z_mm + tip.z};
    posture->pose.knee = (brace_point_t){unbent->knee.x_mm + knee.x, unbent->knee.z_mm + knee.z};
    posture->pose.lever_femur = (brace_point_t){unbent->lever_femur.x_mm - tip.z, unbent->lever_femur.z_mm + tip.x};
    posture->pose.lever_tibia =
        (brace_point_t){unbent->lever_tibia.x_mm - (tip.z - knee.z), unbent->lever_tibia.z_mm + (tip.x - knee.x)};
}

void posture_take(posture_t *posture, const brace_parameters_t *parameters, const float motor_rad[BRACE_LINK_COUNT],
                  const float offset_rad[BRACE_LINK_COUNT], const float link_rad[BRACE_LINK_COUNT])
{
    const brace_limb_t *limb = &parameters->limb;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        posture->is_measured[i] = link_rad[i] == link_rad[i];
        posture->unbent_rad[i] =
            posture->is_measured[i] ? link_rad[i] : brace_limb_true_angle(limb, i, motor_rad[i] + offset_rad[i]);
        posture->theta_rad[i] = posture->unbent_rad[i];
    }
    const float theta1_rad = posture->unbent_rad[BRACE_FEMUR], theta2_rad = posture->unbent_rad[BRACE_TIBIA];
    posture->is_inside_travel = posture_is_inside_travel(&parameters->drive[BRACE_FEMUR], theta1_rad) &&
                                posture_is_inside_travel(&parameters->drive[BRACE_TIBIA], theta2_rad);
    posture->has_levers = __builtin_fabsf(theta1_rad) <= BRACE_ANGLE_LIMIT_RAD &&
                          __builtin_fabsf(theta2_rad) <= BRACE_ANGLE_LIMIT_RAD && limb->femur_mm > 0.0f &&
                          limb->tibia_mm > 0.0f;
    if (posture->has_levers) {
        brace_kinematics_pose(limb, theta1_rad, theta2_rad, &posture->unbent);
        go_to_bent(posture);
    }
}

void posture_settle(posture_t *posture, const posture_bend_t *bend)
{
    posture->tip_moved_mm = posture->knee_moved_mm = (brace_vec_t){0.0f, 0.0f};
    posture->tip_across_mm = posture->knee_across_mm = posture->yaw_turn_rad = 0.0f;
    if (bend != NULL) {
        const brace_pose_t *unbent = &posture->unbent;
        posture->tip_moved_mm = bend->tip_mm;
        posture->knee_moved_mm =
            (brace_vec_t){unbent->tip.x_mm + bend->tip_mm.x - bend->tibia_mm.x - unbent->knee.x_mm,
                          unbent->tip.z_mm + bend->tip_mm.z - bend->tibia_mm.z - unbent->knee.z_mm};
        posture->tip_across_mm = bend->tip_across_mm;
        posture->knee_across_mm = bend->tip_across_mm - bend->tibia_across_mm;
        posture->yaw_turn_rad = bend->joint_turn_rad[BRACE_COXA];
        for (int i = 0; i < BRACE_LINK_COUNT; i++) {
            posture->theta_rad[i] = posture->unbent_rad[i] + bend->joint_turn_rad[i];
        }
    }
    go_to_bent(posture);
}

float posture_gravity_n_mm(const posture_t *posture, const brace_gravity_t *weight, brace_vec3_t down, int joint_index)
{
    const brace_point_t knee = posture->pose.knee, tip = posture->pose.tip;
    /* levers of a pull along down */
    const float knee_mm = knee.z_mm * down.x - knee.x_mm * down.z;
    const float shank_mm = 0.5f * (tip.z_mm * down.x - tip.x_mm * down.z - knee_mm);
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

void posture_force_of_loads(const posture_t *posture, const brace_parameters_t *parameters, brace_vec3_t down,
                            float femur_n_mm, float tibia_n_mm, float *x_n, float *z_n)
{
    const brace_gravity_t *weight = &parameters->gravity;
    const brace_point_t femur = posture->pose.lever_femur, tibia = posture->pose.lever_tibia;
    const float cross_mm2 = femur.x_mm * tibia.z_mm - femur.z_mm * tibia.x_mm;
    const float least_mm2 = LEAST_KNEE_SINE * parameters->limb.femur_mm * parameters->limb.tibia_mm;
    *x_n = *z_n = __builtin_nanf("");
    if (posture->has_levers && __builtin_fabsf(cross_mm2) >= least_mm2) {
        const float about_femur_n_mm = posture_gravity_n_mm(posture, weight, down, BRACE_FEMUR) - femur_n_mm;
        const float about_tibia_n_mm = tibia_n_mm - posture_gravity_n_mm(posture, weight, down, BRACE_TIBIA);
        *x_n = (about_femur_n_mm * tibia.z_mm - about_tibia_n_mm * femur.z_mm) / cross_mm2;
        *z_n = (about_tibia_n_mm * femur.x_mm - about_femur_n_mm * tibia.x_mm) / cross_mm2;
    }
}

/* Sum of the weights times their places along one axis, counted from the coxa joint's. root, knee, tip: places of the
 * femur's ends and of the tip. */
static float weigh(const brace_gravity_t *weight, float root_mm, float knee_mm, float tip_mm)
{
    return weight->femur_n * 0.5f * (root_mm + knee_mm) + weight->knee_n * knee_mm +
           weight->tibia_n * 0.5f * (knee_mm + tip_mm);
}

float posture_force_across_n(const posture_t *posture, const brace_parameters_t *parameters, brace_vec3_t down,
                             float coxa_n_mm, bool is_turned, float *x_n)
{
    const brace_limb_t *limb = &parameters->limb;
    const float knee_mm = limb->coxa_mm + posture->pose.knee.x_mm, tip_mm = limb->coxa_mm + posture->pose.tip.x_mm;
    const float across_mm = posture->tip_across_mm;
    const float least_mm = LEAST_REACH_RATIO * (limb->coxa_mm + limb->femur_mm + limb->tibia_mm);
    if (!posture->has_levers || __builtin_fabsf(tip_mm) < least_mm) {
        return __builtin_nanf("");
    }
    /* The motor carries the opposite of what ground and weight turn. */
    const float weighs_n_mm = down.y * weigh(&parameters->gravity, limb->coxa_mm, knee_mm, tip_mm) -
                              down.x * weigh(&parameters->gravity, 0.0f, posture->knee_across_mm, across_mm);
    const float x_known_n = *x_n == *x_n ? *x_n : 0.0f;
    /* The turned plane's outward force is x + turn * y: small turns. */
    const float turn_rad = is_turned ? posture->yaw_turn_rad : 0.0f;
    const float y_n = (across_mm * x_known_n - coxa_n_mm - weighs_n_mm) / (tip_mm + across_mm * turn_rad);
    *x_n -= turn_rad * y_n;
    return y_n;
}
