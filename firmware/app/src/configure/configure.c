#include "configure/configure.h"

#include "configure/keeping.h"
#include "measure/force.h"
#include "measure/model.h"
#include "motion/joints.h"

#define LEAST_GAP_RAD 1e-5f /* below it there is no play to watch */
#define TAKEUP_RATE_RAD_PER_S 0.1f
#define TAKEUP_TIME_US 8000000u
#define TAKEUP_VERIFY_US 100000u
#define TAKEUP_SPARE_RAD 0.004f
#define TAKEUP_DROOP_RAD 0.2f /* of a servo at the take-up's torque: what a soft one gives way by */

enum { PIECE_COLLAPSE = 1, PIECE_GENERAL, PIECE_FEMUR, PIECE_TIBIA, PIECE_SENSOR, PIECE_DRIFT, PIECE_OPEN, PIECE_KEPT,
       PIECES_DONE };

void configure_begin(brace_app_t *app, bool fresh)
{
    app->configure_piece = PIECE_COLLAPSE;
    app->configures_fresh = fresh;
}

/* The take-up's bounds: a quarter more than the gap, and what gives way under its torque. */
static brace_takeup_bounds_t bounds_of(const brace_drive_t *drive, const brace_joint_t *joint)
{
    const float yields_rad = drive->takeup_torque_n_mm * joint->compliance_rad_per_n_mm;
    float travel_rad = 1.3f * joint->gap_rad + yields_rad + TAKEUP_SPARE_RAD;
    travel_rad = travel_rad < 1.0f ? travel_rad : 1.0f;
    return (brace_takeup_bounds_t){.torque_max_n_mm = drive->takeup_torque_n_mm,
                                   .travel_max_rad = travel_rad,
                                   .reach_max_rad = travel_rad + TAKEUP_DROOP_RAD,
                                   .rate_rad_per_s = TAKEUP_RATE_RAD_PER_S,
                                   .time_max_us = TAKEUP_TIME_US,
                                   .verify_us = TAKEUP_VERIFY_US};
}

static void configure_play(brace_app_t *app, int index)
{
    const brace_drive_t *drive = &app->parameters.drive[BRACE_FEMUR + index];
    const brace_joint_t *joint = &app->parameters.limb.joint[BRACE_FEMUR + index];
    brace_app_play_t *play = &app->play[index];
    const brace_backlash_params_t params = {.tick_us = app->parameters.controller.tick_us,
                                            .gap_rad = joint->gap_rad,
                                            .friction_n_mm = drive->motor_friction_n_mm,
                                            .friction_tolerance_ratio = drive->motor_friction_tolerance_ratio,
                                            .inertia_n_mm_s2_per_rad = drive->motor_inertia_n_mm_s2_per_rad,
                                            .torque_range_n_mm = drive->torque_range_n_mm,
                                            .torque_noise_n_mm = drive->torque_noise_n_mm,
                                            .torque_bias_n_mm = drive->torque_bias_n_mm,
                                            .angle_step_rad = drive->angle_step_rad,
                                            .takeup = bounds_of(drive, joint)};
    const bool has_play = joint->gap_rad >= LEAST_GAP_RAD;
    play->watched = has_play && brace_backlash_init(&play->backlash, &params) == BRACE_OK;
    /* its take-up torque is too small to be told from noise and friction */
    play->unwatchable = has_play && !play->watched;
}

static void configure_drift(brace_app_t *app)
{
    const brace_parameters_t *parameters = &app->parameters;
    const brace_drift_setup_t setup = {
        .noise_n = parameters->sensor.noise_n > 1e-3f ? parameters->sensor.noise_n : 1e-3f,
        /* more would hide a tenth of the tibia: 0.7 % of the force where it is stretched */
        .model_error_ratio = 0.0005f,
        .joint_compliance_per_degc = parameters->slow.joint_compliance_per_degc,
        .joint_compliance_trust_ratio = 0.2f};
    (void)brace_drift_learn(&app->drift, &parameters->limb, &setup);
    app->supervisor.latched &= ~(uint32_t)BRACE_FAULT_MODEL_DRIFT;
}

bool configure_piece(brace_app_t *app)
{
    switch (app->configure_piece) {
    case PIECE_COLLAPSE:
        model_configure_collapse(&app->model, &app->parameters);
        app->tick_us = app->parameters.controller.tick_us;
        joints_configure(app);
        break;
    case PIECE_GENERAL: model_configure_general(&app->model, &app->parameters); break;
    case PIECE_FEMUR: configure_play(app, 0); break;
    case PIECE_TIBIA: configure_play(app, 1); break;
    case PIECE_SENSOR: force_configure(app); break;
    case PIECE_DRIFT: configure_drift(app); break;
    case PIECE_OPEN: keeping_open(app, app->configures_fresh); break;
    case PIECE_KEPT:
        if (keeping_scan(app)) {
            return true;
        }
        break;
    default: return false;
    }
    app->configure_piece = app->configure_piece + 1u < PIECES_DONE ? (uint8_t)(app->configure_piece + 1u) : 0u;
    return true;
}
