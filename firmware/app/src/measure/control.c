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
    force_sense(app, snapshot);
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

/* Angles and joints' springs. */
static void angles(brace_app_t *app, brace_snapshot_t *snapshot)
{
    const float *theta_rad = snapshot->theta_rad;
    brace_app_k_t *k = &app->k;
    const brace_limb_t *limb = &app->parameters.limb;
    const float load_n_mm[BRACE_APP_JOINTS] = {joints_load(snapshot, 0), joints_load(snapshot, 1)};
    float temp_degc[BRACE_APP_JOINTS];
    k->inside = joints_angles(app, snapshot);
    k->sound = app->joint[0].sound && app->joint[1].sound;
    control_temperatures(app, temp_degc);
    snapshot->temp_degc = temp_degc[0] > temp_degc[1] ? temp_degc[0] : temp_degc[1];
    model_springs(&app->model, load_n_mm, temp_degc, k->spring_rad_per_n_mm);
    const float theta1_rad = theta_rad[BRACE_FEMUR], theta2_rad = theta_rad[BRACE_TIBIA];
    k->posed = __builtin_fabsf(theta1_rad) <= BRACE_ANGLE_LIMIT_RAD &&
               __builtin_fabsf(theta2_rad) <= BRACE_ANGLE_LIMIT_RAD && limb->femur_mm > 0.0f && limb->tibia_mm > 0.0f;
}

/* Levers, tip, force. */
static void posture(brace_app_t *app, brace_snapshot_t *snapshot)
{
    const float unknown = __builtin_nanf("");
    app->posed = app->k.posed;
    if (app->posed) {
        brace_kinematics_pose(&app->parameters.limb, snapshot->theta_rad[BRACE_FEMUR], snapshot->theta_rad[BRACE_TIBIA],
                              &app->pose);
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

/* K now and engaged, and what is to be said of it. */
static void tell_stiffness(const brace_app_t *app, brace_snapshot_t *snapshot)
{
    const bool inside = app->k.inside, sound = app->k.sound;
    brace_gap_stiffness_t *k = &snapshot->stiffness;
    const bool computed =
        app->k.status == BRACE_OK &&
        brace_gap_stiffness_known(&app->k.engaged, &app->pose, open_gaps(app, snapshot), k) == BRACE_OK;
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

bool control_piece(brace_app_t *app)
{
    brace_snapshot_t *snapshot = &app->snapshot[app->next];
    const float *theta_rad = snapshot->theta_rad;
    brace_app_k_t *k = &app->k;
    switch (k->done++) {
    case 0: angles(app, snapshot); return false;
    case 1:
        k->status = k->sound && k->posed ? model_stiffness(&app->model, theta_rad[BRACE_FEMUR], theta_rad[BRACE_TIBIA],
                                                           k->spring_rad_per_n_mm, &k->engaged)
                                         : BRACE_E_MODE;
        return false;
    case 2: posture(app, snapshot); return false;
    default:
        tell_stiffness(app, snapshot);
        k->done = 0;
        return true;
    }
}

void control_stamp(const brace_app_t *app, brace_snapshot_t *snapshot)
{
    snapshot->mode = app->mode;
    snapshot->faults = app->faults;
    snapshot->parameter_crc = app->parameter_crc;
    snapshot->parameter_origin = app->origin;
}

void control_publish(brace_app_t *app)
{
    brace_snapshot_t *snapshot = &app->snapshot[app->next];
    const brace_mode_t mode = snapshot->mode;
    const bool tells = mode == BRACE_MODE_MONITOR || mode == BRACE_MODE_TAKING_UP || mode == BRACE_MODE_LOADING_TEST;
    if (!tells) { /* what there may be of K is not for use */
        snapshot->k_is_valid = false;
        snapshot->stiffness.now.flags |= BRACE_FLAG_STALE;
        snapshot->stiffness.engaged.flags |= BRACE_FLAG_STALE;
    }
    snapshot->sequence = ++app->sequence;
    const uint8_t spare = control_spare(app);
    app->newest = app->next;
    app->next = spare;
}
