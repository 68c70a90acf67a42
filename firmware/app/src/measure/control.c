#include "measure/control.h"

#include "measure/force.h"
#include "measure/model.h"
#include "motion/joints.h"

static void tell_no_k(brace_gap_stiffness_t *k)
{
    const float unknown = __builtin_nanf("");
    const brace_stiffness_t none = {unknown, unknown, unknown, unknown, unknown, unknown, 0};
    k->now = k->engaged = none;
}

void control_blank(const brace_app_t *app, brace_snapshot_t *snapshot)
{
    const float unknown = __builtin_nanf("");
    *snapshot = (brace_snapshot_t){.taken_us = app->last_us, .tip_mm = {unknown, unknown},
                                   .play_shift_mm = {unknown, unknown}, .force_x_n = unknown, .force_z_n = unknown,
                                   .temp_degc = unknown};
    tell_no_k(&snapshot->stiffness);
    snapshot->stiffness.now.flags = snapshot->stiffness.engaged.flags = BRACE_FLAG_STALE;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        snapshot->theta_rad[i] = snapshot->motor_rad[i] = snapshot->torque_n_mm[i] = unknown;
    }
}

/* The yaw joint bears no part of the plane's K; its angle is told where there is one. */
static void read_coxa(brace_app_t *app, brace_snapshot_t *snapshot)
{
    brace_hal_joint_t coxa;
    const int32_t answer = app->hal->joint_read(app->hal->context, BRACE_COXA, &coxa);
    const bool known = answer == BRACE_HAL_OK || answer == BRACE_HAL_AGAIN;
    const float unknown = __builtin_nanf("");
    snapshot->motor_rad[BRACE_COXA] = known ? coxa.motor_rad : unknown;
    snapshot->torque_n_mm[BRACE_COXA] = known ? coxa.torque_n_mm : unknown;
    snapshot->theta_rad[BRACE_COXA] =
        known ? brace_limb_true_angle(&app->parameters.limb, BRACE_COXA, coxa.motor_rad) : unknown;
}

void control_sense(brace_app_t *app, uint32_t now_us, brace_snapshot_t *snapshot)
{
    read_coxa(app, snapshot);
    joints_read(app, now_us);
    force_sense(app);
    joints_play(app, now_us, snapshot);
    const uint32_t femur_us = app->joint[0].sample.taken_us, tibia_us = app->joint[1].sample.taken_us;
    snapshot->taken_us = (int32_t)(femur_us - tibia_us) < 0 ? femur_us : tibia_us;
}

void control_temperatures(const brace_app_t *app, float temp_degc[BRACE_APP_JOINTS])
{
    const float femur = app->joint[0].sample.temp_degc, tibia = app->joint[1].sample.temp_degc;
    temp_degc[0] = femur == femur ? femur : tibia;
    temp_degc[1] = tibia == tibia ? tibia : femur;
}

static void posture(brace_app_t *app, brace_snapshot_t *snapshot)
{
    const float *theta_rad = snapshot->theta_rad;
    const float unknown = __builtin_nanf("");
    const float theta1_rad = theta_rad[BRACE_FEMUR], theta2_rad = theta_rad[BRACE_TIBIA];
    const brace_limb_t *limb = &app->parameters.limb;
    app->posed = __builtin_fabsf(theta1_rad) <= BRACE_ANGLE_LIMIT_RAD &&
                 __builtin_fabsf(theta2_rad) <= BRACE_ANGLE_LIMIT_RAD && limb->femur_mm > 0.0f && limb->tibia_mm > 0.0f;
    if (app->posed) {
        brace_kinematics_pose(limb, theta1_rad, theta2_rad, &app->pose);
        snapshot->tip_mm = app->pose.tip;
        (void)brace_backlash_tip_shift(&app->pose, snapshot->play[BRACE_FEMUR].offset_rad,
                                       snapshot->play[BRACE_TIBIA].offset_rad, &snapshot->play_shift_mm);
        force_tell(app, snapshot);
    } else {
        snapshot->tip_mm = snapshot->play_shift_mm = (brace_point_t){unknown, unknown};
        snapshot->force_x_n = snapshot->force_z_n = unknown;
        snapshot->force_is_sensed = false;
    }
}

static uint32_t open_gaps(const brace_app_t *app, const brace_snapshot_t *snapshot)
{
    uint32_t open = BRACE_GAP_NONE;
    for (int i = 0; i < BRACE_APP_JOINTS; i++) {
        const bool has_play = app->play[i].watched || app->play[i].unwatchable;
        open |= has_play && !snapshot->play[BRACE_FEMUR + i].valid ? 1u << (BRACE_FEMUR + i) : 0u;
    }
    return open;
}

void control_stiffness(brace_app_t *app, brace_snapshot_t *snapshot)
{
    const bool inside = joints_angles(app, snapshot);
    const bool sound = app->joint[0].sound && app->joint[1].sound;
    brace_gap_stiffness_t *k = &snapshot->stiffness;
    float temp_degc[BRACE_APP_JOINTS];
    control_temperatures(app, temp_degc);
    snapshot->temp_degc = temp_degc[0] > temp_degc[1] ? temp_degc[0] : temp_degc[1];
    posture(app, snapshot);
    bool computed = false;
    if (sound && app->posed) {
        const float load_n_mm[BRACE_APP_JOINTS] = {joints_load(app, snapshot, 0), joints_load(app, snapshot, 1)};
        brace_stiffness_t engaged;
        computed = model_stiffness(&app->model, snapshot->theta_rad[BRACE_FEMUR], snapshot->theta_rad[BRACE_TIBIA],
                                   load_n_mm, temp_degc, &engaged) == BRACE_OK &&
                   brace_gap_stiffness_known(&engaged, &app->pose, open_gaps(app, snapshot), k) == BRACE_OK;
    }
    if (!computed) {
        tell_no_k(k);
        k->now.flags = k->engaged.flags = sound && inside ? (uint32_t)BRACE_FLAG_NEAR_SINGULAR : 0u; /* no K there */
    }
    const uint32_t flags = (app->origin == BRACE_PARAMETERS_DEFAULT ? (uint32_t)BRACE_FLAG_UNCALIBRATED : 0u) |
                           (sound ? 0u : (uint32_t)BRACE_FLAG_STALE) |
                           (inside ? 0u : (uint32_t)BRACE_FLAG_OUT_OF_RANGE);
    k->now.flags |= flags;
    k->engaged.flags |= flags;
    snapshot->k_is_valid = computed && inside;
}

void control_seal(brace_app_t *app, brace_snapshot_t *snapshot)
{
    const bool tells = app->mode == BRACE_MODE_MONITOR || app->mode == BRACE_MODE_TAKING_UP ||
                       app->mode == BRACE_MODE_LOADING_TEST;
    if (!tells) { /* what there may be of K is not for use */
        snapshot->k_is_valid = false;
        snapshot->stiffness.now.flags |= BRACE_FLAG_STALE;
        snapshot->stiffness.engaged.flags |= BRACE_FLAG_STALE;
    }
    snapshot->mode = app->mode;
    snapshot->faults = app->faults;
    snapshot->parameter_crc = app->parameter_crc;
    snapshot->parameter_origin = app->origin;
    snapshot->sequence = ++app->sequence;
    app->newest ^= 1u;
}
