/* What moves the limb, what a loading test has left, who speaks, faults. */
#include <string.h>

#include "brace/measured.h"
#include "can/request.h"
#include "measure/loading.h"
#include "report/measured.h"
#include "report/version.h"

/* A loading test over the bus goes at this pace and within these bounds; the drives' own bounds stay. */
#define RATE_MM_PER_S 10.0f
#define FORCE_MOST_N 200.0f

int32_t request_take_up(brace_app_t *app, request_t *request)
{
    brace_can_take_up_request_t asked;
    uint8_t data[8];
    brace_can_unpack_take_up_request(request->data, &asked);
    request->detail = app->mode;
    const brace_status_t status = brace_app_take_up(app, (int32_t)asked.joint, asked.flank);
    if (status != BRACE_OK) {
        return status;
    }
    (void)brace_can_pack_take_up_answer_0(
        &(brace_can_take_up_answer_0_t){request->token, brace_app_snapshot(app)->play[asked.joint].phase},
        data);
    answer_put(app, data);
    return BRACE_OK;
}

int32_t request_let_go(brace_app_t *app, request_t *request)
{
    uint8_t data[8];
    request->detail = app->mode;
    const brace_status_t status = brace_app_let_go(app);
    if (status != BRACE_OK) {
        return status;
    }
    (void)brace_can_pack_let_go_answer_0(&(brace_can_let_go_answer_0_t){request->token, app->mode}, data);
    answer_put(app, data);
    return BRACE_OK;
}

int32_t request_loading_start(brace_app_t *app, request_t *request)
{
    const brace_drive_t *drive = app->parameters.drive;
    const float femur_n_mm = drive[BRACE_FEMUR].torque_range_n_mm;
    const float tibia_n_mm = drive[BRACE_TIBIA].torque_range_n_mm;
    brace_can_loading_test_start_request_t asked;
    uint8_t data[8];
    brace_can_unpack_loading_test_start_request(request->data, &asked);
    const brace_loading_setup_t setup = {
        .axis = asked.axis == 0u ? BRACE_AXIS_X : BRACE_AXIS_Z,
        .steps_per_side = asked.steps_per_side,
        .step_mm = asked.step_mm,
        .dwell_us = 1000u * asked.dwell_ms,
        .rate_mm_per_s = RATE_MM_PER_S,
        .force_max_n = FORCE_MOST_N,
        .torque_max_n_mm = femur_n_mm > tibia_n_mm ? femur_n_mm : tibia_n_mm,
        .source = BRACE_LOADING_ENCODED};
    request->detail = app->mode;
    if (app->loading.phase == LOADING_RETURN) {
        return BRACE_REFUSED_BUSY; /* the last test is over by itself in a moment */
    }
    const brace_status_t status = asked.axis > 1u ? BRACE_E_RANGE : brace_app_loading_start(app, &setup);
    if (status != BRACE_OK) {
        return status;
    }
    (void)brace_can_pack_loading_test_start_answer_0(
        &(brace_can_loading_test_start_answer_0_t){request->token, 4u * asked.steps_per_side + 1u}, data);
    answer_put(app, data);
    return BRACE_OK;
}

int32_t request_loading_stop(brace_app_t *app, request_t *request)
{
    uint8_t data[8];
    request->detail = app->mode;
    const brace_status_t status = brace_app_loading_stop(app);
    if (status != BRACE_OK) {
        return status;
    }
    (void)brace_can_pack_loading_test_stop_answer_0(
        &(brace_can_loading_test_stop_answer_0_t){request->token, brace_app_row_count(app)}, data);
    answer_put(app, data);
    return BRACE_OK;
}

int32_t request_fetch_row(brace_app_t *app, request_t *request)
{
    brace_can_fetch_row_request_t asked;
    brace_can_fetch_row_answer_0_t answer;
    brace_row_t row;
    uint8_t data[8];
    brace_can_unpack_fetch_row_request(request->data, &asked);
    answer.token = request->token;
    answer.row = asked.row;
    answer.column = asked.column;
    request->detail = brace_app_row_count(app);
    brace_status_t status = brace_app_row(app, asked.row, &row);
    if (status == BRACE_OK) {
        status = brace_row_value(&row, asked.column, &answer.value);
    }
    if (status != BRACE_OK) {
        return status;
    }
    (void)brace_can_pack_fetch_row_answer_0(&answer, data);
    answer_put(app, data);
    return BRACE_OK;
}

/* Items count from loading_outcome on, as the dictionary's entries do; whole numbers come as floats too. */
int32_t request_loading_result(brace_app_t *app, request_t *request)
{
    enum {
        OUTCOME = offsetof(brace_measured_t, loading_outcome) / 4,
        ITEMS = offsetof(brace_measured_t, loading_score_z) / 4 - OUTCOME + 1
    };
    const brace_loading_result_t *result = brace_app_loading_result(app);
    brace_can_loading_test_result_request_t asked;
    brace_measured_t measured;
    uint8_t data[8];
    brace_can_unpack_loading_test_result_request(request->data, &asked);
    brace_can_loading_test_result_answer_0_t answer = {request->token, asked.item, result->outcome, 0.0f};
    request->detail = ITEMS;
    if (asked.item >= ITEMS) {
        return BRACE_E_RANGE;
    }
    brace_measured_take(app, app->last_us, &measured);
    if (asked.item == 0u) {
        answer.value = (float)result->outcome;
    } else if (asked.item == 1u) {
        answer.value = (float)measured.loading_rows;
    } else {
        memcpy(&answer.value, (const uint8_t *)&measured + 4u * (OUTCOME + asked.item), sizeof answer.value);
    }
    (void)brace_can_pack_loading_test_result_answer_0(&answer, data);
    answer_put(app, data);
    return BRACE_OK;
}

int32_t request_identify(brace_app_t *app, request_t *request)
{
    const uint32_t token = request->token;
    uint8_t data[8];
    (void)brace_can_pack_identify_answer_0(
        &(brace_can_identify_answer_0_t){token, BRACE_FIRMWARE_MAJOR, BRACE_FIRMWARE_MINOR,
                                         BRACE_FIRMWARE_PATCH, BRACE_PROTOCOL, app->bus.node_id}, data);
    answer_put(app, data);
    (void)brace_can_pack_identify_answer_1(
        &(brace_can_identify_answer_1_t){token, BRACE_DICTIONARY_HASH}, data);
    answer_put(app, data);
    (void)brace_can_pack_identify_answer_2(&(brace_can_identify_answer_2_t){token, BRACE_SCHEMA_HASH}, data);
    answer_put(app, data);
    (void)brace_can_pack_identify_answer_3(
        &(brace_can_identify_answer_3_t){token, app->parameter_crc, app->origin}, data);
    answer_put(app, data);
    return BRACE_OK;
}

int32_t request_clear(brace_app_t *app, request_t *request)
{
    brace_can_clear_request_t asked;
    uint8_t data[8];
    brace_can_unpack_clear_request(request->data, &asked);
    request->detail = app->faults;
    const brace_status_t status = brace_app_clear(app, asked.faults);
    if (status != BRACE_OK) {
        return status;
    }
    (void)brace_can_pack_clear_answer_0(&(brace_can_clear_answer_0_t){request->token, app->faults}, data);
    answer_put(app, data);
    return BRACE_OK;
}
