#include "report/measured.h"

#include <string.h>

#include "brace/can_messages.h"
#include "report/version.h"

static void take_stiffness(const brace_snapshot_t *snapshot, brace_measured_t *m)
{
    const brace_stiffness_t *now = &snapshot->stiffness.now, *engaged = &snapshot->stiffness.engaged;
    const float unknown = __builtin_nanf("");
    m->k_is_valid = snapshot->k_is_valid;
    m->flags = now->flags;
    m->k_xx_n_per_mm = m->k_xz_n_per_mm = m->k_zz_n_per_mm = unknown;
    m->lambda_min_n_per_mm = m->lambda_max_n_per_mm = m->stiff_axis_rad = unknown;
    m->engaged_k_xx_n_per_mm = m->engaged_k_xz_n_per_mm = m->engaged_k_zz_n_per_mm = unknown;
    m->engaged_lambda_min_n_per_mm = m->engaged_lambda_max_n_per_mm = unknown;
    if (!snapshot->k_is_valid) {
        return;
    }
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

static void take_loading(const brace_app_t *app, brace_measured_t *m)
{
    const brace_loading_result_t *result = &app->loading.result;
    const bool done = result->outcome == BRACE_LOADING_DONE;
    const float unknown = __builtin_nanf("");
    m->loading_outcome = (uint32_t)result->outcome & 0xffu;
    m->loading_rows = app->recorder.count;
    m->loading_k_x_n_per_mm = done ? result->least_squares.k_x_n_per_mm : unknown;
    m->loading_k_z_n_per_mm = done ? result->least_squares.k_z_n_per_mm : unknown;
    m->loading_ratio_k_x_n_per_mm = done ? result->mean_of_ratios.k_x_n_per_mm : unknown;
    m->loading_ratio_k_z_n_per_mm = done ? result->mean_of_ratios.k_z_n_per_mm : unknown;
    m->loading_score_x = done ? result->z_x : unknown;
    m->loading_score_z = done ? result->z_z : unknown;
}

void brace_measured_take(const brace_app_t *app, uint32_t now_us, brace_measured_t *m)
{
    const brace_snapshot_t *snapshot = brace_app_snapshot(app);
    m->probe_f32 = 12345.5f;
    m->probe_u32 = 0x01020304u;
    m->dictionary_hash = BRACE_DICTIONARY_HASH;
    m->firmware_version = BRACE_FIRMWARE_VERSION;
    m->sequence = snapshot->sequence;
    const int32_t age_us = (int32_t)(now_us - snapshot->taken_us); /* samples may come after the tick's own time */
    m->age_us = age_us > 0 ? (uint32_t)age_us : 0u;
    m->mode = snapshot->mode;
    m->faults = snapshot->faults;
    take_stiffness(snapshot, m);
    take_posture(snapshot, m);
    m->parameter_crc = snapshot->parameter_crc;
    m->parameter_origin = snapshot->parameter_origin;
    brace_store_status_t store;
    brace_store_status(&app->store, &store);
    m->parameter_sequence = store.sequence;
    take_loading(app, m);
    m->ticks_late = app->counters.ticks_late;
    m->samples_bad = app->counters.samples_bad;
    m->frames_refused = app->counters.frames_refused;
    m->frames_unknown = app->counters.frames_unknown;
    m->modbus_broken = app->counters.modbus_broken;
    m->modbus_refused = app->counters.modbus_refused;
}

brace_status_t measured_entry(const brace_measured_t *measured, uint32_t entry, uint32_t *value)
{
    if (entry - BRACE_ENTRY_MEASURED >= BRACE_MEASURED_COUNT) {
        return BRACE_E_RANGE;
    }
    memcpy(value, (const uint8_t *)measured + 4u * (entry - BRACE_ENTRY_MEASURED), 4);
    return BRACE_OK;
}
