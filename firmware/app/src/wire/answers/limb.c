/* Requests that move the limb, what a loading test has left, what the drift check knows, who this node is, faults. */
#include <stddef.h>
#include <string.h>

#include "wire/answers/answer.h"
#include "wire/measured.h"
#include "wire/version.h"

/* A loading test over the bus goes at this pace and within these bounds; the drives' own bounds stay. */
#define RATE_MM_PER_S 10.0f
#define FORCE_MOST_N 200.0f

int32_t answer_set_gravity(request_t *request, const brace_set_gravity_request_t *asked,
                           brace_set_gravity_answer_t *answer)
{
    const brace_status_t status = brace_app_set_gravity(request->app, asked->direction_rad, asked->lean_rad);
    if (status == BRACE_OK) {
        brace_app_gravity(request->app, &answer->direction_rad, &answer->lean_rad);
    }
    return status;
}

/* The number that begins what has just been asked for. */
static uint32_t begin_number(const brace_app_t *app)
{
    brace_session_report_t session;
    brace_app_session(app, &session);
    return session.begin;
}

int32_t answer_sign_of_life(request_t *request, const brace_sign_of_life_request_t *asked,
                            brace_sign_of_life_answer_t *answer)
{
    const bool is_bench = brace_app_setting(request->app) == BRACE_SETTING_BENCH;
    const brace_sign_t sign = {
        .heard = is_bench ? asked->check : asked->heard, .heard_bits = is_bench ? 32u : 16u, .check = asked->check};
    const int32_t status = brace_app_life(request->app, request->who, &sign);
    brace_session_report_t session;
    brace_app_session(request->app, &session);
    request->detail = session.number;
    if (status == BRACE_OK) {
        *answer =
            (brace_sign_of_life_answer_t){.owner = session.owner, .setting = session.setting, .number = session.number};
    }
    return status;
}

int32_t answer_take_up(request_t *request, const brace_take_up_request_t *asked, brace_take_up_answer_t *answer)
{
    brace_app_t *app = request->app;
    request->detail = brace_app_mode(app);
    const brace_status_t status = brace_app_take_up(app, (int32_t)asked->joint, asked->flank);
    if (status == BRACE_OK) {
        answer->phase = brace_app_snapshot(app)->play[asked->joint].phase;
        answer->setting = brace_app_setting(app);
        answer->begin = begin_number(app);
    }
    return status;
}

int32_t answer_take_up_result(request_t *request, const brace_take_up_result_request_t *asked,
                              brace_take_up_result_answer_t *answer)
{
    const brace_snapshot_t *snapshot = brace_app_snapshot(request->app);
    request->detail = asked->joint;
    if (asked->joint >= (uint32_t)BRACE_LINK_COUNT) {
        return BRACE_E_RANGE;
    }
    const brace_backlash_out_t *play = &snapshot->play[asked->joint];
    *answer = (brace_take_up_result_answer_t){.joint = asked->joint,
                                              .outcome = play->takeup,
                                              .phase = play->phase,
                                              .torque_n_mm = snapshot->torque_n_mm[asked->joint]};
    return BRACE_OK;
}

int32_t answer_let_go(request_t *request, const brace_let_go_request_t *asked, brace_let_go_answer_t *answer)
{
    brace_app_t *app = request->app;
    (void)asked;
    request->detail = brace_app_mode(app);
    const brace_status_t status = brace_app_let_go(app);
    if (status == BRACE_OK) {
        answer->mode = brace_app_mode(app);
        answer->setting = brace_app_setting(app);
        answer->begin = begin_number(app);
    }
    return status;
}

int32_t answer_loading_test_start(request_t *request, const brace_loading_test_start_request_t *asked,
                                  brace_loading_test_start_answer_t *answer)
{
    brace_app_t *app = request->app;
    const brace_drive_t *drive = brace_app_parameters(app)->drive;
    const float femur_n_mm = drive[BRACE_FEMUR].torque_range_n_mm;
    const float tibia_n_mm = drive[BRACE_TIBIA].torque_range_n_mm;
    const brace_loading_setup_t setup = {.axis = asked->axis == 0u ? BRACE_AXIS_X : BRACE_AXIS_Z,
                                         .steps_per_side = asked->steps_per_side,
                                         .step_mm = asked->step_mm,
                                         .dwell_us = 1000u * asked->dwell_ms,
                                         .rate_mm_per_s = RATE_MM_PER_S,
                                         .force_max_n = FORCE_MOST_N,
                                         .torque_max_n_mm = femur_n_mm > tibia_n_mm ? femur_n_mm : tibia_n_mm,
                                         .source = BRACE_LOADING_ENCODED};
    request->detail = brace_app_mode(app);
    if (brace_app_loading_is_returning(app)) {
        return BRACE_REFUSED_BUSY; /* the last test is over by itself in a moment */
    }
    const brace_status_t status = asked->axis > 1u ? BRACE_E_RANGE : brace_app_loading_start(app, &setup);
    if (status == BRACE_OK) {
        answer->rows = 4u * asked->steps_per_side + 1u;
        answer->setting = brace_app_setting(app);
        answer->begin = begin_number(app);
    }
    return status;
}

int32_t answer_loading_test_stop(request_t *request, const brace_loading_test_stop_request_t *asked,
                                 brace_loading_test_stop_answer_t *answer)
{
    brace_app_t *app = request->app;
    (void)asked;
    request->detail = brace_app_mode(app);
    const brace_status_t status = brace_app_stop(app);
    if (status == BRACE_OK) {
        answer->rows = brace_app_row_count(app);
        answer->setting = brace_app_setting(app);
    }
    return status;
}

int32_t answer_fetch_row(request_t *request, const brace_fetch_row_request_t *asked, brace_fetch_row_answer_t *answer)
{
    const brace_app_t *app = request->app;
    brace_row_t row;
    float value = 0.0f;
    request->detail = brace_app_row_count(app);
    brace_status_t status = brace_app_row(app, asked->row, &row);
    if (status == BRACE_OK) {
        status = brace_row_value(&row, asked->column, &value);
    }
    if (status == BRACE_OK) {
        *answer = (brace_fetch_row_answer_t){asked->row, asked->column, value};
    }
    return status;
}

/* Items are the dictionary's entries from loading_outcome to loading_score_z. Outcome and rows, which are whole
 * numbers, come as floats too. */
int32_t answer_loading_test_result(request_t *request, const brace_loading_test_result_request_t *asked,
                                   brace_loading_test_result_answer_t *answer)
{
    enum {
        FIRST = offsetof(brace_measured_t, loading_outcome) / 4, /* an entry's number is its place: brace/measured.h */
        ITEMS = offsetof(brace_measured_t, loading_score_z) / 4 - FIRST + 1
    };
    const brace_loading_result_t *result = brace_app_loading_result(request->app);
    uint32_t word = 0;
    request->detail = ITEMS;
    if (asked->item >= ITEMS) {
        return BRACE_E_RANGE;
    }
    answer->item = asked->item;
    answer->outcome = result->outcome;
    switch (asked->item) {
    case 0: answer->value = (float)result->outcome; break;
    case 1: answer->value = (float)request->measured->loading_rows; break;
    default:
        (void)measured_entry(request->measured, BRACE_ENTRY_MEASURED + FIRST + asked->item, &word);
        memcpy(&answer->value, &word, sizeof word); /* a float's bits */
    }
    return BRACE_OK;
}

int32_t answer_identify(request_t *request, const brace_identify_request_t *asked, brace_identify_answer_t *answer)
{
    const brace_snapshot_t *snapshot = brace_app_snapshot(request->app);
    (void)asked;
    *answer = (brace_identify_answer_t){.major = BRACE_FIRMWARE_MAJOR,
                                        .minor = BRACE_FIRMWARE_MINOR,
                                        .patch = BRACE_FIRMWARE_PATCH,
                                        .protocol = BRACE_PROTOCOL,
                                        .node = request->node_id,
                                        .dictionary_hash = BRACE_DICTIONARY_HASH,
                                        .schema_hash = BRACE_SCHEMA_HASH,
                                        .parameter_crc = snapshot->parameter_crc,
                                        .origin = snapshot->parameter_origin,
                                        .faults = brace_app_faults(request->app),
                                        .mode = brace_app_mode(request->app),
                                        .setting = brace_app_setting(request->app)};
    return BRACE_OK;
}

int32_t answer_drift(request_t *request, const brace_drift_request_t *asked, brace_drift_answer_t *answer)
{
    const brace_measured_t *measured = request->measured;
    (void)asked;
    *answer = (brace_drift_answer_t){.state = measured->drift_state,
                                     .cause = measured->drift_cause,
                                     .could_be = measured->drift_could_be,
                                     .next_step = measured->drift_next_step,
                                     .evidence = measured->drift_evidence,
                                     .loss_ratio = measured->drift_loss_ratio,
                                     .loss_sigma_ratio = measured->drift_loss_sigma_ratio,
                                     .since_readings = measured->drift_since_readings,
                                     .readings = measured->drift_readings};
    return BRACE_OK;
}

int32_t answer_clear(request_t *request, const brace_clear_request_t *asked, brace_clear_answer_t *answer)
{
    brace_app_t *app = request->app;
    request->detail = brace_app_faults(app);
    const brace_status_t status = brace_app_clear(app, asked->faults);
    if (status == BRACE_OK) {
        answer->faults = brace_app_faults(app);
        answer->setting = brace_app_setting(app);
    }
    return status;
}
