#include "wire/measured.h"

#include "brace/can_messages.h"
#include "brace/codes.h"
#include "brace/words.h"
#include "wire/version.h"

/* A K that is not valid is NaN in the snapshot, and so it is here. */
static void take_stiffness(const brace_snapshot_t *snapshot, brace_measured_t *m)
{
    const brace_stiffness_t *now = &snapshot->stiffness.now, *engaged = &snapshot->stiffness.engaged;
    m->k_is_valid = snapshot->k_is_valid;
    m->flags = now->flags;
    m->k_xx_n_per_mm = now->k_xx_n_per_mm;
    m->k_xz_n_per_mm = now->k_xz_n_per_mm;
    m->k_zz_n_per_mm = now->k_zz_n_per_mm;
    m->lambda_min_n_per_mm = now->lambda_min_n_per_mm;
    m->lambda_max_n_per_mm = now->lambda_max_n_per_mm;
    m->stiff_axis_rad = now->stiff_axis_rad;
    m->engaged_k_xx_n_per_mm = engaged->k_xx_n_per_mm;
    m->engaged_k_xz_n_per_mm = engaged->k_xz_n_per_mm;
    m->engaged_k_zz_n_per_mm = engaged->k_zz_n_per_mm;
    m->engaged_lambda_min_n_per_mm = engaged->lambda_min_n_per_mm;
    m->engaged_lambda_max_n_per_mm = engaged->lambda_max_n_per_mm;
}

/* One sigma that is infinite says no more than one that is not known. */
static float sigma_of(const brace_snapshot_t *snapshot, float sigma)
{
    return snapshot->sigma_is_known && __builtin_isfinite(sigma) ? sigma : __builtin_nanf("");
}

static void take_sigma(const brace_snapshot_t *snapshot, brace_measured_t *m)
{
    const brace_stiffness_sigma_t *sigma = &snapshot->sigma;
    m->sigma_k_xx_n_per_mm = sigma_of(snapshot, sigma->k_xx_n_per_mm);
    m->sigma_k_xz_n_per_mm = sigma_of(snapshot, sigma->k_xz_n_per_mm);
    m->sigma_k_zz_n_per_mm = sigma_of(snapshot, sigma->k_zz_n_per_mm);
    m->sigma_lambda_min_n_per_mm = sigma_of(snapshot, sigma->lambda_min_n_per_mm);
    m->sigma_lambda_max_n_per_mm = sigma_of(snapshot, sigma->lambda_max_n_per_mm);
    m->sigma_stiff_axis_rad = sigma_of(snapshot, sigma->stiff_axis_rad);
}

static void take_sigma_of_space(const brace_snapshot_t *snapshot, brace_measured_t *m)
{
    const brace_space_sigma_t *sigma = &snapshot->sigma_space;
    m->sigma_space_k_xx_n_per_mm = sigma_of(snapshot, sigma->k_xx_n_per_mm);
    m->sigma_space_k_xy_n_per_mm = sigma_of(snapshot, sigma->k_xy_n_per_mm);
    m->sigma_space_k_xz_n_per_mm = sigma_of(snapshot, sigma->k_xz_n_per_mm);
    m->sigma_space_k_yy_n_per_mm = sigma_of(snapshot, sigma->k_yy_n_per_mm);
    m->sigma_space_k_yz_n_per_mm = sigma_of(snapshot, sigma->k_yz_n_per_mm);
    m->sigma_space_k_zz_n_per_mm = sigma_of(snapshot, sigma->k_zz_n_per_mm);
    m->sigma_space_lambda_1_n_per_mm = sigma_of(snapshot, sigma->lambda_n_per_mm[0]);
    m->sigma_space_lambda_2_n_per_mm = sigma_of(snapshot, sigma->lambda_n_per_mm[1]);
    m->sigma_space_lambda_3_n_per_mm = sigma_of(snapshot, sigma->lambda_n_per_mm[2]);
    m->sigma_k_across_n_per_mm = sigma_of(snapshot, sigma->across_n_per_mm);
}

static void take_load(const brace_snapshot_t *snapshot, brace_measured_t *m)
{
    const brace_snapshot_load_t *load = &snapshot->load;
    m->unloaded_k_xx_n_per_mm = load->unloaded.k_xx_n_per_mm;
    m->unloaded_k_xz_n_per_mm = load->unloaded.k_xz_n_per_mm;
    m->unloaded_k_zz_n_per_mm = load->unloaded.k_zz_n_per_mm;
    m->counted_force_x_n = load->force_x_n;
    m->counted_force_z_n = load->force_z_n;
    m->moved_x_mm = load->moved_x_mm;
    m->moved_z_mm = load->moved_z_mm;
    m->buckling_factor = load->buckling_factor;
    m->counted_force_y_n = load->force_y_n;
    m->moved_y_mm = load->moved_y_mm;
    m->unloaded_k_across_n_per_mm = load->unloaded_across_n_per_mm;
    m->gravity_direction_rad = snapshot->gravity_direction_rad;
    m->gravity_lean_rad = snapshot->gravity_lean_rad;
}

static void take_posture(const brace_snapshot_t *snapshot, brace_measured_t *m)
{
    const brace_backlash_out_t *femur = &snapshot->play[BRACE_FEMUR], *tibia = &snapshot->play[BRACE_TIBIA];
    m->theta1_rad = snapshot->theta_rad[BRACE_FEMUR];
    m->theta2_rad = snapshot->theta_rad[BRACE_TIBIA];
    m->tip_x_mm = snapshot->tip_mm.x_mm;
    m->tip_z_mm = snapshot->tip_mm.z_mm;
    m->force_x_n = snapshot->force_x_n;
    m->force_z_n = snapshot->force_z_n;
    m->force_is_sensed = snapshot->force_is_sensed;
    m->play_shift_x_mm = snapshot->play_shift_mm.x_mm;
    m->play_shift_z_mm = snapshot->play_shift_mm.z_mm;
    m->play_femur = femur->state;
    m->play_femur_offset_rad = femur->offset_rad;
    m->load_femur_n_mm = femur->load_n_mm;
    m->motor_femur_rad = snapshot->motor_rad[BRACE_FEMUR];
    m->torque_femur_n_mm = snapshot->torque_n_mm[BRACE_FEMUR];
    m->play_tibia = tibia->state;
    m->play_tibia_offset_rad = tibia->offset_rad;
    m->load_tibia_n_mm = tibia->load_n_mm;
    m->motor_tibia_rad = snapshot->motor_rad[BRACE_TIBIA];
    m->torque_tibia_n_mm = snapshot->torque_n_mm[BRACE_TIBIA];
    m->temperature_degc = snapshot->temp_degc;
}

static void take_intervals(const brace_snapshot_t *snapshot, brace_measured_t *m)
{
    const brace_interval_t *load = snapshot->load_interval_n_mm;
    m->force_x_low_n = snapshot->force_x_interval_n.low;
    m->force_x_high_n = snapshot->force_x_interval_n.high;
    m->force_z_low_n = snapshot->force_z_interval_n.low;
    m->force_z_high_n = snapshot->force_z_interval_n.high;
    m->force_y_low_n = snapshot->force_y_interval_n.low;
    m->force_y_high_n = snapshot->force_y_interval_n.high;
    m->load_coxa_low_n_mm = load[BRACE_COXA].low;
    m->load_coxa_high_n_mm = load[BRACE_COXA].high;
    m->load_femur_low_n_mm = load[BRACE_FEMUR].low;
    m->load_femur_high_n_mm = load[BRACE_FEMUR].high;
    m->load_tibia_low_n_mm = load[BRACE_TIBIA].low;
    m->load_tibia_high_n_mm = load[BRACE_TIBIA].high;
}

/* K in space; as above. Without a coxa joint there is none whose quality could be reported. */
static void take_space(const brace_snapshot_t *snapshot, brace_measured_t *m)
{
    const brace_space_stiffness_t *space = &snapshot->space;
    const brace_stiffness_spatial_t *now = &space->now, *engaged = &space->engaged;
    m->k_is_in_space = space->is_valid;
    m->space_flags = space->is_fitted ? now->flags : UINT32_MAX;
    m->k_across_n_per_mm = space->across_n_per_mm;
    m->space_k_xx_n_per_mm = now->k_xx_n_per_mm;
    m->space_k_xy_n_per_mm = now->k_xy_n_per_mm;
    m->space_k_xz_n_per_mm = now->k_xz_n_per_mm;
    m->space_k_yy_n_per_mm = now->k_yy_n_per_mm;
    m->space_k_yz_n_per_mm = now->k_yz_n_per_mm;
    m->space_k_zz_n_per_mm = now->k_zz_n_per_mm;
    m->space_lambda_1_n_per_mm = now->lambda_n_per_mm[0];
    m->space_lambda_2_n_per_mm = now->lambda_n_per_mm[1];
    m->space_lambda_3_n_per_mm = now->lambda_n_per_mm[2];
    m->space_stiff_axis_x = now->stiff_axis[0];
    m->space_stiff_axis_y = now->stiff_axis[1];
    m->space_stiff_axis_z = now->stiff_axis[2];
    m->engaged_space_k_xx_n_per_mm = engaged->k_xx_n_per_mm;
    m->engaged_space_k_xy_n_per_mm = engaged->k_xy_n_per_mm;
    m->engaged_space_k_xz_n_per_mm = engaged->k_xz_n_per_mm;
    m->engaged_space_k_yy_n_per_mm = engaged->k_yy_n_per_mm;
    m->engaged_space_k_yz_n_per_mm = engaged->k_yz_n_per_mm;
    m->engaged_space_k_zz_n_per_mm = engaged->k_zz_n_per_mm;
    m->engaged_space_lambda_1_n_per_mm = engaged->lambda_n_per_mm[0];
    m->engaged_space_lambda_2_n_per_mm = engaged->lambda_n_per_mm[1];
    m->engaged_space_lambda_3_n_per_mm = engaged->lambda_n_per_mm[2];
}

static void take_coxa_joint(const brace_snapshot_t *snapshot, brace_measured_t *m)
{
    const brace_backlash_out_t *coxa = &snapshot->play[BRACE_COXA];
    m->theta0_rad = snapshot->theta_rad[BRACE_COXA];
    m->play_coxa = coxa->state;
    m->play_coxa_offset_rad = coxa->offset_rad;
    m->load_coxa_n_mm = coxa->load_n_mm;
    m->motor_coxa_rad = snapshot->motor_rad[BRACE_COXA];
    m->torque_coxa_n_mm = snapshot->torque_n_mm[BRACE_COXA];
}

static void take_take_ups(const brace_snapshot_t *snapshot, brace_measured_t *m)
{
    m->take_up_coxa = (uint32_t)snapshot->play[BRACE_COXA].takeup & 0xffu;
    m->take_up_femur = (uint32_t)snapshot->play[BRACE_FEMUR].takeup & 0xffu;
    m->take_up_tibia = (uint32_t)snapshot->play[BRACE_TIBIA].takeup & 0xffu;
}

/* The core always names a cause; it means something while there is evidence, or once the limb has drifted. A baseline
 * that walks away raises the alarm without evidence. */
static bool has_cause(const brace_drift_report_t *report)
{
    return report->evidence > 0.0f || report->state == BRACE_DRIFT_DRIFTED;
}

uint32_t measured_drift_cause(const brace_drift_report_t *report)
{
    return has_cause(report) ? (uint32_t)report->cause + 1u : (uint32_t)BRACE_DRIFT_CAUSE_NONE;
}

static void take_drift(const brace_app_t *app, brace_measured_t *m)
{
    const brace_drift_report_t *report = brace_app_drift_report(app);
    const bool is_caused = has_cause(report);
    const float unknown = __builtin_nanf("");
    m->drift_state = report->state;
    m->drift_cause = measured_drift_cause(report);
    m->drift_could_be = is_caused ? report->could_be : 0u;
    m->drift_evidence = report->evidence;
    m->drift_loss_ratio = is_caused ? report->loss_ratio : unknown;
    m->drift_loss_sigma_ratio = is_caused ? report->loss_sigma_ratio : unknown;
    m->drift_since_readings = is_caused ? report->since_steps : UINT32_MAX;
    m->drift_readings = report->steps;
    m->drift_next_step = brace_app_drift_next_step(app);
}

static void take_loading(const brace_app_t *app, brace_measured_t *m)
{
    const brace_loading_result_t *result = brace_app_loading_result(app);
    const bool done = result->outcome == BRACE_LOADING_DONE;
    const float unknown = __builtin_nanf("");
    m->loading_outcome = (uint32_t)result->outcome & 0xffu;
    m->loading_rows = brace_app_row_count(app);
    m->loading_k_x_n_per_mm = done ? result->least_squares.k_x_n_per_mm : unknown;
    m->loading_k_z_n_per_mm = done ? result->least_squares.k_z_n_per_mm : unknown;
    m->loading_ratio_k_x_n_per_mm = done ? result->mean_of_ratios.k_x_n_per_mm : unknown;
    m->loading_ratio_k_z_n_per_mm = done ? result->mean_of_ratios.k_z_n_per_mm : unknown;
    m->loading_score_x = done ? result->z_x : unknown;
    m->loading_score_z = done ? result->z_z : unknown;
}

static void take_parameters(const brace_snapshot_t *snapshot, brace_measured_t *m)
{
    m->parameter_crc = snapshot->parameter_crc;
    m->parameter_origin = snapshot->parameter_origin;
    m->parameter_sequence = snapshot->parameter_sequence;
    m->parameter_sequence_wanted = snapshot->parameter_sequence_wanted;
}

static void take_counters(const brace_app_counters_t *counters, brace_measured_t *m)
{
    m->ticks_late = counters->ticks_late;
    m->samples_bad = counters->samples_bad;
    m->frames_refused = counters->frames_refused;
    m->frames_unknown = counters->frames_unknown;
    m->modbus_broken = counters->modbus_broken;
    m->modbus_refused = counters->modbus_refused;
    m->frames_lost = counters->frames_lost;
    m->questions_busy = counters->questions_busy;
    m->requests_lost = counters->requests_lost;
    m->commands_failed = counters->commands_failed;
}

static void take_session(const brace_app_t *app, brace_measured_t *m)
{
    brace_session_report_t session;
    brace_app_session(app, &session);
    m->setting = session.setting;
    m->owner = session.owner;
    m->is_held = session.is_held;
    m->challenge_low = session.has_challenge ? (uint32_t)session.challenge : UINT32_MAX;
    m->challenge_high = session.has_challenge ? (uint32_t)(session.challenge >> 32) : UINT32_MAX;
    m->strangers_refused = session.strangers;
    m->replays_refused = session.replays;
    m->silences = session.silences;
    m->commits_refused = session.commits_refused;
    m->erases = session.erases;
    m->last_refusal = (uint32_t)session.last_refusal & 0xffu;
    m->life_number = session.number;
    m->begin_number = session.has_begin ? session.begin : UINT32_MAX;
}

void measured_take(const brace_app_t *app, const brace_app_counters_t *counters, uint32_t now_us, brace_measured_t *m)
{
    const brace_snapshot_t *snapshot = brace_app_snapshot(app);
    const int32_t age_us = (int32_t)(now_us - snapshot->taken_us); /* samples may come after the tick's own time */
    m->probe_f32 = 12345.5f;
    m->probe_u32 = 0x01020304u;
    m->dictionary_hash = BRACE_DICTIONARY_HASH;
    m->firmware_version = BRACE_FIRMWARE_VERSION;
    m->sequence = snapshot->sequence;
    m->age_us = age_us > 0 ? (uint32_t)age_us : 0u;
    m->mode = snapshot->mode;
    m->faults = snapshot->faults;
    take_stiffness(snapshot, m);
    take_sigma(snapshot, m);
    take_sigma_of_space(snapshot, m);
    take_load(snapshot, m);
    take_space(snapshot, m);
    take_posture(snapshot, m);
    take_intervals(snapshot, m);
    take_coxa_joint(snapshot, m);
    take_take_ups(snapshot, m);
    take_parameters(snapshot, m);
    take_loading(app, m);
    take_drift(app, m);
    take_counters(counters, m);
    take_session(app, m);
}

brace_status_t measured_entry(const brace_measured_t *measured, uint32_t entry, uint32_t *value)
{
    if (entry - BRACE_ENTRY_MEASURED >= BRACE_MEASURED_COUNT) {
        return BRACE_E_RANGE;
    }
    *value = brace_word_at(measured, entry - BRACE_ENTRY_MEASURED);
    return BRACE_OK;
}

brace_status_t parameter_entry(const brace_parameters_t *parameters, uint32_t number, uint32_t *value)
{
    const uint32_t index = brace_parameter_index(number);
    if (index >= BRACE_PARAMETER_COUNT) {
        return BRACE_E_RANGE;
    }
    *value = parameter_member(parameters, index);
    return BRACE_OK;
}

uint32_t parameter_member(const brace_parameters_t *parameters, uint32_t index)
{
    return brace_word_at(parameters, index);
}
