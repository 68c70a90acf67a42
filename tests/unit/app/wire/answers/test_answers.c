/* Answers as a whole, whichever wire they go by: every member is filled, a refusal reports its detail and touches
 * nothing. */
#include "wire/answers/answer.h"

#include <string.h>

#include "loading_bench.h"

static const brace_who_t who = {BRACE_ASKER_CAN, 3};
static upload_t uploaded;
static download_t downloaded;
static asked_force_t asked_force;
static brace_seal_t seal, brought;
static request_t request;
static brace_request_t asked;
static brace_answer_t answer, untouched;

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    stand(&p);
    living_master = NULL;
    memset(&uploaded, 0, sizeof uploaded);
    memset(&downloaded, 0, sizeof downloaded);
    memset(&asked_force, 0, sizeof asked_force);
    memset(&seal, 0, sizeof seal);
    memset(&brought, 0, sizeof brought);
    memset(&asked, 0, sizeof asked);
}

void tearDown(void) {}

/* Puts a request, as a port does. returns its status; answer keeps a pattern wherever nothing was answered */
static int32_t put(uint32_t code)
{
    static const uint8_t bytes[8];
    request = (request_t){.app = &app,
                          .measured = &app.wires.measured,
                          .asker = BRACE_ASKER_CAN,
                          .who = who,
                          .seal = &seal,
                          .brings = &brought,
                          .token = 0x31,
                          .bytes = bytes,
                          .count = sizeof bytes,
                          .asked_force = &asked_force,
                          .upload = &uploaded,
                          .download = &downloaded,
                          .node_id = 5};
    memset(&answer, 0x5a, sizeof answer);
    untouched = answer;
    app.controller.ownership.is_by_wire = true; /* as while the wires are served */
    const int32_t status = answer_request(&request, code, &asked, &answer);
    app.controller.ownership.is_by_wire = false;
    return status;
}

static void refuses(int32_t status, uint32_t detail, uint32_t code)
{
    TEST_ASSERT_EQUAL(status, put(code));
    TEST_ASSERT_EQUAL(detail, request.detail);
    TEST_ASSERT_EQUAL_MEMORY(&untouched, &answer, sizeof answer);
}

static void takes(uint32_t code)
{
    TEST_ASSERT_EQUAL(BRACE_OK, put(code));
}

/* Of what waits. */
static uint32_t begin_now(void)
{
    brace_session_report_t reported;
    brace_app_session(&app, &reported);
    TEST_ASSERT_TRUE(reported.has_begin);
    return reported.begin;
}

static void to_configuration(void)
{
    asked.set_mode = (brace_set_mode_request_t){.mode = BRACE_MODE_CONFIGURATION, .key = 0xc0de};
    takes(BRACE_REQUEST_SET_MODE);
    TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, answer.set_mode.mode);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, answer.set_mode.setting);
}

/* ------------------------------------------------------------------------------------------ the limb -- */

static void test_who_this_is(void)
{
    takes(BRACE_REQUEST_IDENTIFY);
    TEST_ASSERT_EQUAL(5, answer.identify.node);
    TEST_ASSERT_EQUAL(BRACE_PROTOCOL, answer.identify.protocol);
    TEST_ASSERT_EQUAL_HEX32(BRACE_DICTIONARY_HASH, answer.identify.dictionary_hash);
    TEST_ASSERT_EQUAL_HEX32(BRACE_SCHEMA_HASH, answer.identify.schema_hash);
    TEST_ASSERT_EQUAL_HEX32(now()->parameter_crc, answer.identify.parameter_crc);
    TEST_ASSERT_EQUAL(BRACE_PARAMETERS_SLOT_A, answer.identify.origin);
}

static void test_where_down_is(void)
{
    asked.set_gravity = (brace_set_gravity_request_t){.direction_rad = -1.2f, .lean_rad = 0.1f};
    takes(BRACE_REQUEST_SET_GRAVITY);
    TEST_ASSERT_EQUAL_FLOAT(-1.2f, answer.set_gravity.direction_rad);
    TEST_ASSERT_EQUAL_FLOAT(0.1f, answer.set_gravity.lean_rad);
    asked.set_gravity.direction_rad = NAN;
    TEST_ASSERT_NOT_EQUAL(BRACE_OK, put(BRACE_REQUEST_SET_GRAVITY));
    TEST_ASSERT_EQUAL_MEMORY(&untouched, &answer, sizeof answer);
}

static void test_a_loading_test_from_its_start_to_its_rows(void)
{
    asked.loading_test_start =
        (brace_loading_test_start_request_t){.axis = 1, .steps_per_side = 2, .step_mm = 0.5f, .dwell_ms = 20};
    asked.loading_test_start.axis = 2;
    refuses(BRACE_E_RANGE, BRACE_MODE_MONITOR, BRACE_REQUEST_LOADING_TEST_START);
    asked.loading_test_start.axis = 1;
    takes(BRACE_REQUEST_LOADING_TEST_START);
    TEST_ASSERT_EQUAL(9, answer.loading_test_start.rows);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, answer.loading_test_start.setting);
    TEST_ASSERT_EQUAL_HEX32(begin_now(), answer.loading_test_start.begin);
    living_master = &who;
    ticks(3);
    const brace_loading_setup_t *setup = &result()->setup;
    TEST_ASSERT_EQUAL(BRACE_AXIS_Z, setup->axis);
    TEST_ASSERT_EQUAL(2, setup->steps_per_side);
    TEST_ASSERT_EQUAL_FLOAT(0.5f, setup->step_mm);
    TEST_ASSERT_EQUAL(20000, setup->dwell_us);
    TEST_ASSERT_EQUAL_FLOAT(10.0f, setup->rate_mm_per_s);
    TEST_ASSERT_EQUAL_FLOAT(200.0f, setup->force_max_n);
    TEST_ASSERT_EQUAL_FLOAT(10000.0f, setup->torque_max_n_mm);
    TEST_ASSERT_EQUAL(BRACE_LOADING_ENCODED, setup->source);
    for (int i = 0; i < 20000 && result()->rows < 3; i++) {
        ticks(1);
    }
    refuses(BRACE_E_MODE, BRACE_MODE_LOADING_TEST, BRACE_REQUEST_LOADING_TEST_START);
    takes(BRACE_REQUEST_LOADING_TEST_STOP);
    TEST_ASSERT_EQUAL(3, answer.loading_test_stop.rows);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, answer.loading_test_stop.setting);
    asked.fetch_row = (brace_fetch_row_request_t){.row = 2, .column = 4};
    brace_row_t row;
    float value = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_row(&app, 2, &row));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_row_value(&row, 4, &value));
    takes(BRACE_REQUEST_FETCH_ROW);
    TEST_ASSERT_EQUAL(2, answer.fetch_row.row);
    TEST_ASSERT_EQUAL(4, answer.fetch_row.column);
    TEST_ASSERT_EQUAL_FLOAT(value, answer.fetch_row.value);
    for (asked.fetch_row.row = 3; asked.fetch_row.row < 6u; asked.fetch_row.row++) {
        refuses(BRACE_E_RANGE, 3, BRACE_REQUEST_FETCH_ROW);
    }
    asked.fetch_row = (brace_fetch_row_request_t){.row = 0, .column = 100};
    refuses(BRACE_E_RANGE, 3, BRACE_REQUEST_FETCH_ROW);
    takes(BRACE_REQUEST_LET_GO);
    TEST_ASSERT_EQUAL(BRACE_MODE_LOADING_TEST, answer.let_go.mode);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, answer.let_go.setting);
    ticks(3000);
    refuses(BRACE_E_MODE, BRACE_MODE_MONITOR, BRACE_REQUEST_LET_GO);
    refuses(BRACE_E_MODE, BRACE_MODE_MONITOR, BRACE_REQUEST_LOADING_TEST_STOP);
}

/* The motor that pulls harder bounds a test; each drive gets its own bound beside. */
static void test_the_torque_of_a_test_is_the_stronger_motor_s(void)
{
    for (int i = 0; i < 2; i++) {
        brace_parameters_t p = bench_parameters();
        p.drive[BRACE_FEMUR + i].torque_range_n_mm = 12000.0f;
        stand(&p);
        asked.loading_test_start =
            (brace_loading_test_start_request_t){.axis = 0, .steps_per_side = 2, .step_mm = 0.5f, .dwell_ms = 20};
        takes(BRACE_REQUEST_LOADING_TEST_START);
        living_master = &who;
        ticks(3);
        TEST_ASSERT_EQUAL(BRACE_AXIS_X, result()->setup.axis);
        TEST_ASSERT_EQUAL_FLOAT(12000.0f, result()->setup.torque_max_n_mm);
    }
}

/* The items are the dictionary's entries in their order, as measured.c reports them. */
static void test_each_item_of_a_loading_test_s_result(void)
{
    run(&along_x);
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
    const brace_measured_t *reported = &app.wires.measured;
    const float wanted[] = {
        reported->loading_k_x_n_per_mm,       reported->loading_k_z_n_per_mm, reported->loading_ratio_k_x_n_per_mm,
        reported->loading_ratio_k_z_n_per_mm, reported->loading_score_x,      reported->loading_score_z};
    const uint32_t first = (uint32_t)(offsetof(brace_measured_t, loading_outcome) / 4u);
    const uint32_t at = (uint32_t)(offsetof(brace_measured_t, loading_k_x_n_per_mm) / 4u) - first;
    for (uint32_t i = 0; i < 2u; i++) {
        asked.loading_test_result = (brace_loading_test_result_request_t){.item = i};
        takes(BRACE_REQUEST_LOADING_TEST_RESULT);
        TEST_ASSERT_EQUAL(i, answer.loading_test_result.item);
        TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, answer.loading_test_result.outcome);
        TEST_ASSERT_EQUAL_FLOAT(i == 0u ? (float)BRACE_LOADING_DONE : 17.0f, answer.loading_test_result.value);
    }
    for (uint32_t i = 0; i < 6u; i++) {
        asked.loading_test_result = (brace_loading_test_result_request_t){.item = at + i};
        takes(BRACE_REQUEST_LOADING_TEST_RESULT);
        TEST_ASSERT_EQUAL(at + i, answer.loading_test_result.item);
        TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, answer.loading_test_result.outcome);
        TEST_ASSERT_EQUAL_FLOAT(wanted[i], answer.loading_test_result.value);
    }
    const uint32_t items = (uint32_t)(offsetof(brace_measured_t, loading_score_z) / 4u) - first + 1u;
    asked.loading_test_result.item = items - 1u;
    takes(BRACE_REQUEST_LOADING_TEST_RESULT);
    asked.loading_test_result.item = items;
    refuses(BRACE_E_RANGE, items, BRACE_REQUEST_LOADING_TEST_RESULT);
    asked.loading_test_result.item = items + 1u;
    refuses(BRACE_E_RANGE, items, BRACE_REQUEST_LOADING_TEST_RESULT);
}

static void test_faults_are_cleared_and_what_is_left_is_reported(void)
{
    asked.clear = (brace_clear_request_t){.faults = BRACE_FAULT_CRASHED};
    app.controller.has_crashed = true;
    ticks(3);
    TEST_ASSERT_BITS_HIGH(BRACE_FAULT_CRASHED, now()->faults);
    takes(BRACE_REQUEST_CLEAR);
    TEST_ASSERT_EQUAL_HEX32(0, answer.clear.faults);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, answer.clear.setting);
    asked.clear.faults = BRACE_FAULT_SENSOR_FEMUR; /* not by hand */
    refuses(BRACE_E_RANGE, 0, BRACE_REQUEST_CLEAR);
    app.controller.faults.now = BRACE_FAULT_STORE | BRACE_FAULT_CRASHED;
    refuses(BRACE_E_RANGE, BRACE_FAULT_STORE | BRACE_FAULT_CRASHED, BRACE_REQUEST_CLEAR);
}

static void test_each_number_of_a_drift(void)
{
    brace_measured_t *m = &app.wires.measured;
    m->drift_state = 1, m->drift_cause = 2, m->drift_could_be = 3, m->drift_next_step = 4;
    m->drift_evidence = 5.0f, m->drift_loss_ratio = 6.0f, m->drift_loss_sigma_ratio = 7.0f;
    m->drift_since_readings = 8, m->drift_readings = 9;
    takes(BRACE_REQUEST_DRIFT);
    const brace_drift_answer_t *a = &answer.drift;
    const float reported[] = {(float)a->state,   (float)a->cause, (float)a->could_be,  (float)a->next_step,
                              a->evidence,       a->loss_ratio,   a->loss_sigma_ratio, (float)a->since_readings,
                              (float)a->readings};
    for (int i = 0; i < 9; i++) {
        TEST_ASSERT_EQUAL_FLOAT(1.0f + (float)i, reported[i]);
    }
}

static void test_play_and_its_take_up(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_TIBIA].gap_rad = 0.005f;
    stand(&p);
    asked.take_up = (brace_take_up_request_t){.joint = BRACE_FEMUR, .flank = 1};
    refuses(BRACE_E_UNSUPPORTED, BRACE_MODE_MONITOR, BRACE_REQUEST_TAKE_UP);
    asked.take_up.joint = BRACE_TIBIA;
    takes(BRACE_REQUEST_TAKE_UP);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_IDLE, answer.take_up.phase);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, answer.take_up.setting);
    TEST_ASSERT_EQUAL_HEX32(begin_now(), answer.take_up.begin);
    living_master = &who;
    ticks(20);
    asked.take_up_result = (brace_take_up_result_request_t){.joint = BRACE_TIBIA};
    takes(BRACE_REQUEST_TAKE_UP_RESULT);
    TEST_ASSERT_EQUAL(BRACE_TIBIA, answer.take_up_result.joint);
    TEST_ASSERT_EQUAL(now()->play[BRACE_TIBIA].phase, answer.take_up_result.phase);
    TEST_ASSERT_NOT_EQUAL(BRACE_TAKEUP_IDLE, answer.take_up_result.phase);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_RUNNING, answer.take_up_result.outcome);
    TEST_ASSERT_EQUAL_FLOAT(now()->torque_n_mm[BRACE_TIBIA], answer.take_up_result.torque_n_mm);
    asked.take_up = (brace_take_up_request_t){.joint = BRACE_FEMUR, .flank = 1};
    refuses(BRACE_E_UNSUPPORTED, BRACE_MODE_TAKING_UP, BRACE_REQUEST_TAKE_UP);
    for (uint32_t none = 3; none != 0u; none <<= 1) {
        asked.take_up_result.joint = none;
        refuses(BRACE_E_RANGE, none, BRACE_REQUEST_TAKE_UP_RESULT);
    }
    takes(BRACE_REQUEST_LET_GO);
    TEST_ASSERT_EQUAL(BRACE_MODE_TAKING_UP, answer.let_go.mode);
    TEST_ASSERT_EQUAL_HEX32(begin_now(), answer.let_go.begin);
}

/* On a bench the whole number comes back as the check. What the owner is refused brings the number of now. */
static void test_a_sign_of_life(void)
{
    brace_session_report_t reported;
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_TIBIA].gap_rad = 0.005f;
    stand(&p);
    asked.take_up = (brace_take_up_request_t){.joint = BRACE_TIBIA, .flank = 1};
    takes(BRACE_REQUEST_TAKE_UP);
    brace_app_session(&app, &reported);
    asked.sign_of_life = (brace_sign_of_life_request_t){.heard = reported.number & 0xffffu, .check = reported.number};
    takes(BRACE_REQUEST_SIGN_OF_LIFE);
    TEST_ASSERT_EQUAL(BRACE_OWNER_CAN, answer.sign_of_life.owner);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, answer.sign_of_life.setting);
    TEST_ASSERT_EQUAL_HEX32(reported.number, answer.sign_of_life.number);
    ticks(30);
    brace_session_report_t later;
    brace_app_session(&app, &later);
    TEST_ASSERT_TRUE(later.number != reported.number);
    asked.sign_of_life.check = reported.begin;
    takes(BRACE_REQUEST_SIGN_OF_LIFE);
    TEST_ASSERT_EQUAL_HEX32(later.number, answer.sign_of_life.number);
    ticks(2);
    TEST_ASSERT_EQUAL(BRACE_MODE_TAKING_UP, now()->mode);
    ticks(160);
    brace_app_session(&app, &later);
    refuses(BRACE_REFUSED_LATE, later.number, BRACE_REQUEST_SIGN_OF_LIFE);
}

/* Somebody asks for a take-up and stops it before the first sign of life: it is taken back, and does not begin
 * later. */
static void test_stop_takes_back_what_has_not_begun(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_TIBIA].gap_rad = 0.005f;
    stand(&p);
    asked.take_up = (brace_take_up_request_t){.joint = BRACE_TIBIA, .flank = 1};
    takes(BRACE_REQUEST_TAKE_UP);
    ticks(2);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    const uint32_t begin = begin_now();
    asked.write_entry =
        (brace_write_entry_request_t){BRACE_ENTRY_COMMANDS + (uint32_t)(offsetof(brace_commands_t, stop) / 4u), 1};
    takes(BRACE_REQUEST_WRITE_ENTRY);
    TEST_ASSERT_EQUAL(asked.write_entry.index, answer.write_entry.index);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, answer.write_entry.value);
    asked.sign_of_life = (brace_sign_of_life_request_t){.check = begin};
    TEST_ASSERT_EQUAL(BRACE_REFUSED_LATE, put(BRACE_REQUEST_SIGN_OF_LIFE));
    ticks(200);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, fake.joint[BRACE_TIBIA].command.offset_rad);
}

/* A question needs no seal, and leaves one that has come for the command behind it. So does a command: a stranger's may
 * have come first. */
static void test_a_seal_is_for_a_command(void)
{
    seal = (brace_seal_t){.is_there = true, .counter = 3};
    takes(BRACE_REQUEST_IDENTIFY);
    TEST_ASSERT_TRUE(seal.is_there);
    (void)put(BRACE_REQUEST_LET_GO);
    TEST_ASSERT_TRUE(seal.is_there);
}

/* Commands that are no entry to be written take no part of CONFIGURATION, and move nothing. */
static void test_an_entry_that_is_none_is_no_command(void)
{
    static const uint32_t none[] = {BRACE_ENTRY_COMMANDS, BRACE_ENTRY_COMMANDS + 1u, UINT32_MAX};
    for (uint32_t i = 0; i < 3u; i++) {
        asked.write_entry = (brace_write_entry_request_t){none[i], 1};
        refuses(BRACE_E_RANGE, none[i], BRACE_REQUEST_WRITE_ENTRY);
        TEST_ASSERT_FALSE(app.controller.ownership.has_configurer);
        TEST_ASSERT_FALSE(app.controller.ownership.session.is_open);
    }
    asked.write_entry.index = BRACE_ENTRY_COMMANDS + (uint32_t)(offsetof(brace_commands_t, end_test) / 4u);
    refuses(BRACE_E_MODE, now()->mode, BRACE_REQUEST_WRITE_ENTRY); /* no test runs */
}

/* On a bench, who asks or informs becomes nobody's owner; who commands does. */
static void test_a_question_owns_nothing(void)
{
    takes(BRACE_REQUEST_IDENTIFY);
    asked.set_gravity = (brace_set_gravity_request_t){.direction_rad = -1.2f, .lean_rad = 0.1f};
    takes(BRACE_REQUEST_SET_GRAVITY);
    TEST_ASSERT_FALSE(app.controller.ownership.session.is_open);
    TEST_ASSERT_FALSE(app.controller.ownership.has_configurer);
    (void)put(BRACE_REQUEST_LET_GO);
    TEST_ASSERT_TRUE(app.controller.ownership.session.is_open);
}

static void test_what_no_request_stands_for(void)
{
    refuses(BRACE_REFUSED_UNKNOWN, BRACE_REQUEST_CODE_MOST, BRACE_REQUEST_CODE_MOST + 1u);
    refuses(BRACE_REFUSED_UNKNOWN, BRACE_REQUEST_CODE_MOST, 0);
}

/* ---------------------------------------------------------------------------------------------- of K -- */

/* A question is put again in each tick until its answer is there. */
static int32_t put_until_answered(uint32_t code)
{
    int32_t status = put(code);
    for (int i = 0; i < 5 && status == ANSWER_AGAIN; i++) {
        TEST_ASSERT_EQUAL_MEMORY(&untouched, &answer, sizeof answer);
        ticks(1);
        status = put(code);
    }
    return status;
}

static void test_a_force_is_used_up_by_its_answer(void)
{
    asked.k_under_load_at_posture = (brace_k_under_load_at_posture_request_t){.theta1_rad = 0.8f, .theta2_rad = 1.1f};
    refuses(BRACE_REFUSED_ORDER, 0, BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE);
    asked.tip_force = (brace_tip_force_request_t){.fx_n = -5.0f, .fz_n = 12.0f};
    takes(BRACE_REQUEST_TIP_FORCE);
    TEST_ASSERT_EQUAL_FLOAT(-5.0f, answer.tip_force.fx_n);
    TEST_ASSERT_EQUAL_FLOAT(12.0f, answer.tip_force.fz_n);
    asked.k_under_load_at_posture = (brace_k_under_load_at_posture_request_t){.theta1_rad = 0.8f, .theta2_rad = 1.1f};
    TEST_ASSERT_EQUAL(BRACE_OK, put_until_answered(BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE));
    const brace_loaded_stiffness_t wanted =
        equilibrium(brace_app_parameters(&app), 0.8f, 1.1f, (brace_force_t){-5.0f, 12.0f}, (brace_vec_t){0.0f, -1.0f});
    const brace_k_under_load_at_posture_answer_t *k = &answer.k_under_load_at_posture;
    const float off = 1e-4f * wanted.stiffness.lambda_max_n_per_mm;
    TEST_ASSERT_FLOAT_WITHIN(off, wanted.stiffness.k_xx_n_per_mm, k->k_xx_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(off, wanted.stiffness.k_xz_n_per_mm, k->k_xz_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(off, wanted.stiffness.k_zz_n_per_mm, k->k_zz_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(off, wanted.stiffness.lambda_min_n_per_mm, k->lambda_min_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(off, wanted.stiffness.lambda_max_n_per_mm, k->lambda_max_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, wanted.stiffness.stiff_axis_rad, k->stiff_axis_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-2f, wanted.displacement.x_mm, k->dx_mm);
    TEST_ASSERT_FLOAT_WITHIN(1e-2f, wanted.displacement.z_mm, k->dz_mm);
    TEST_ASSERT_FLOAT_WITHIN(2e-3f * wanted.buckling_factor, wanted.buckling_factor, k->buckling_factor);
    TEST_ASSERT_EQUAL_HEX32(wanted.stiffness.flags, k->flags);
    refuses(BRACE_REFUSED_ORDER, 0, BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE);
}

static void test_both_knees_under_a_load(void)
{
    static const uint32_t code[2] = {BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP,
                                     BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_DOWN};
    for (int down = 0; down < 2; down++) {
        const float theta2_rad = down ? -1.1f : 1.1f;
        brace_pose_t pose;
        brace_kinematics_pose(&brace_app_parameters(&app)->limb, 0.3f, theta2_rad, &pose);
        asked.tip_force = (brace_tip_force_request_t){.fx_n = 2.0f, .fz_n = 7.0f};
        takes(BRACE_REQUEST_TIP_FORCE);
        asked.k_under_load_at_tip_knee_up =
            (brace_k_under_load_at_tip_knee_up_request_t){.x_mm = pose.tip.x_mm, .z_mm = pose.tip.z_mm};
        TEST_ASSERT_EQUAL(BRACE_OK, put_until_answered(code[down]));
        const brace_loaded_stiffness_t wanted = equilibrium(brace_app_parameters(&app), 0.3f, theta2_rad,
                                                            (brace_force_t){2.0f, 7.0f}, (brace_vec_t){0.0f, -1.0f});
        const brace_k_under_load_at_posture_answer_t *k = &answer.k_under_load_at_posture;
        TEST_ASSERT_FLOAT_WITHIN(1e-3f * wanted.stiffness.lambda_max_n_per_mm, wanted.stiffness.k_xx_n_per_mm,
                                 k->k_xx_n_per_mm);
        TEST_ASSERT_FLOAT_WITHIN(1e-3f * wanted.stiffness.lambda_max_n_per_mm, wanted.stiffness.k_xz_n_per_mm,
                                 k->k_xz_n_per_mm);
    }
}

static void test_what_has_no_K_says_what_the_K_of_now_is_worth(void)
{
    fake.play = NULL;
    fake.joint[BRACE_FEMUR].not_newer = true;
    ticks(60);
    TEST_ASSERT_FALSE(now()->k_is_valid);
    static const uint32_t code[] = {BRACE_REQUEST_CONTACT_FORCE, BRACE_REQUEST_SAG_FOR_LOAD};
    for (int i = 0; i < 2; i++) {
        refuses(BRACE_E_MODE, now()->stiffness.now.flags, code[i]);
        TEST_ASSERT_NOT_EQUAL(0, request.detail);
        TEST_ASSERT_TRUE(request.is_of_now);
    }
    fake.joint[BRACE_FEMUR].not_newer = false;
    ticks(200);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    asked.contact_force = (brace_contact_force_request_t){.dx_mm = NAN};
    refuses(BRACE_E_NOT_FINITE, now()->stiffness.now.flags, BRACE_REQUEST_CONTACT_FORCE);
    TEST_ASSERT_FALSE(request.is_of_now);
}

static void test_what_the_K_of_now_means_at_the_contact(void)
{
    const brace_stiffness_t *k = &now()->stiffness.now;
    asked.contact_force = (brace_contact_force_request_t){.dx_mm = 0.5f, .dz_mm = -0.25f};
    takes(BRACE_REQUEST_CONTACT_FORCE);
    brace_contact_force_t contact;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_contact_force(k, (brace_displacement_t){0.5f, -0.25f}, &contact));
    TEST_ASSERT_EQUAL_FLOAT(contact.force.x_n, answer.contact_force.fx_n);
    TEST_ASSERT_EQUAL_FLOAT(contact.force.z_n, answer.contact_force.fz_n);
    TEST_ASSERT_EQUAL_FLOAT(contact.low_n, answer.contact_force.low_n);
    TEST_ASSERT_EQUAL_FLOAT(contact.high_n, answer.contact_force.high_n);
    asked.sag_for_load = (brace_sag_for_load_request_t){.fx_n = 3.0f, .fz_n = -9.0f};
    takes(BRACE_REQUEST_SAG_FOR_LOAD);
    brace_displacement_t sag;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_contact_sag(k, (brace_force_t){3.0f, -9.0f}, &sag));
    TEST_ASSERT_EQUAL_FLOAT(sag.x_mm, answer.sag_for_load.dx_mm);
    TEST_ASSERT_EQUAL_FLOAT(sag.z_mm, answer.sag_for_load.dz_mm);
    asked.friction_margin = (brace_friction_margin_request_t){.normal_rad = 1.5f, .friction_ratio = 0.6f};
    takes(BRACE_REQUEST_FRICTION_MARGIN);
    brace_contact_grip_t grip;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_grip(&app, 1.5f, 0.6f, &grip));
    TEST_ASSERT_EQUAL_FLOAT(grip.margin_n, answer.friction_margin.margin_n);
    TEST_ASSERT_EQUAL_FLOAT(grip.angle_left_rad, answer.friction_margin.angle_left_rad);
    TEST_ASSERT_EQUAL(grip.state, answer.friction_margin.contact);
    TEST_ASSERT_FALSE(request.is_of_now);
}

/* ---------------------------------------------------------------------------------------- parameters -- */

static void test_modes_are_reported_and_refused(void)
{
    asked.set_mode = (brace_set_mode_request_t){.mode = BRACE_MODE_CONFIGURATION, .key = 0xc0df};
    refuses(BRACE_REFUSED_KEY, BRACE_MODE_MONITOR, BRACE_REQUEST_SET_MODE);
    asked.set_mode.key = 0xc0dd;
    refuses(BRACE_REFUSED_KEY, BRACE_MODE_MONITOR, BRACE_REQUEST_SET_MODE);
    asked.set_mode = (brace_set_mode_request_t){.mode = BRACE_MODE_MONITOR, .key = 0xc0de}; /* where it is */
    takes(BRACE_REQUEST_SET_MODE);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, answer.set_mode.mode);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, answer.set_mode.setting);
    asked.set_mode.mode = BRACE_MODE_LOADING_TEST;
    refuses(BRACE_E_RANGE, BRACE_MODE_MONITOR, BRACE_REQUEST_SET_MODE);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    ticks(2);
    asked.set_mode.mode = BRACE_MODE_MONITOR;
    refuses(BRACE_E_MODE, BRACE_MODE_LOADING_TEST, BRACE_REQUEST_SET_MODE);
    asked.set_mode.mode = BRACE_MODE_LOADING_TEST; /* where it is */
    takes(BRACE_REQUEST_SET_MODE);
    TEST_ASSERT_EQUAL(BRACE_MODE_LOADING_TEST, answer.set_mode.mode);
}

/* From CONFIGURATION a request leads back, through a new start, and nowhere else. */
static void test_configuration_leads_back_alone(void)
{
    to_configuration();
    for (uint32_t mode = BRACE_MODE_START; mode <= BRACE_MODE_FAULT + 1u; mode++) {
        asked.set_mode.mode = mode;
        if (mode != BRACE_MODE_MONITOR && mode != BRACE_MODE_CONFIGURATION) {
            refuses(BRACE_E_RANGE, BRACE_MODE_CONFIGURATION, BRACE_REQUEST_SET_MODE);
        }
    }
    asked.set_mode.mode = BRACE_MODE_MONITOR;
    takes(BRACE_REQUEST_SET_MODE);
    TEST_ASSERT_EQUAL(BRACE_MODE_START, answer.set_mode.mode);
}

static void test_entries_are_staged_and_read(void)
{
    const uint32_t femur = brace_parameter_number(BRACE_PARAMETER_GEOMETRY_FEMUR_MM);
    const uint32_t longer = 0x433e0000u; /* 190.0f */
    asked.write_entry = (brace_write_entry_request_t){femur, longer};
    refuses(BRACE_E_MODE, femur, BRACE_REQUEST_WRITE_ENTRY);
    to_configuration();
    asked.write_entry = (brace_write_entry_request_t){femur, longer};
    takes(BRACE_REQUEST_WRITE_ENTRY);
    TEST_ASSERT_EQUAL(femur, answer.write_entry.index);
    TEST_ASSERT_EQUAL_HEX32(longer, answer.write_entry.value);
    asked.read_entry = (brace_read_entry_request_t){femur};
    takes(BRACE_REQUEST_READ_ENTRY); /* what is in force, not what is staged */
    TEST_ASSERT_EQUAL(femur, answer.read_entry.index);
    TEST_ASSERT_EQUAL_HEX32(0x43390000u, answer.read_entry.value); /* 185.0f */
    asked.write_entry = (brace_write_entry_request_t){BRACE_ENTRY_MEASURED, 1};
    refuses(BRACE_REFUSED_READ_ONLY, BRACE_ENTRY_MEASURED, BRACE_REQUEST_WRITE_ENTRY);
    asked.write_entry.index = BRACE_ENTRY_MEASURED + BRACE_MEASURED_COUNT - 1u;
    refuses(BRACE_REFUSED_READ_ONLY, asked.write_entry.index, BRACE_REQUEST_WRITE_ENTRY);
    asked.write_entry.index = BRACE_ENTRY_MEASURED + BRACE_MEASURED_COUNT;
    TEST_ASSERT_NOT_EQUAL(BRACE_REFUSED_READ_ONLY, put(BRACE_REQUEST_WRITE_ENTRY));
    /* a seal that comes by a way on which none can come is taken, and forgotten */
    asked.write_entry = (brace_write_entry_request_t){
        BRACE_ENTRY_COMMANDS + (uint32_t)(offsetof(brace_commands_t, seal_mac) / 4u), 0x1234u};
    takes(BRACE_REQUEST_WRITE_ENTRY);
    TEST_ASSERT_FALSE(seal.is_there); /* what has come before stays as it is */
    TEST_ASSERT_TRUE(brought.is_there);
    TEST_ASSERT_EQUAL_HEX32(0x31, brought.counter);
    TEST_ASSERT_EQUAL(8, brought.counter_bits);
    TEST_ASSERT_EQUAL_HEX32(0x1234, brought.mac);
    request.brings = NULL;
    TEST_ASSERT_EQUAL(BRACE_OK, answer_request(&request, BRACE_REQUEST_WRITE_ENTRY, &asked, &answer));
    asked.read_entry.index = BRACE_ENTRY_MEASURED + BRACE_MEASURED_COUNT + 1u;
    refuses(BRACE_E_RANGE, asked.read_entry.index, BRACE_REQUEST_READ_ENTRY);
    asked.read_entry.index = BRACE_ENTRY_MEASURED + BRACE_MEASURED_COUNT;
    refuses(BRACE_E_RANGE, asked.read_entry.index, BRACE_REQUEST_READ_ENTRY);
}

/* Values that no entry may have are refused at once; values that do not go together are, with the whole set. */
static void test_what_no_limb_has_is_refused(void)
{
    const uint32_t femur = brace_parameter_number(BRACE_PARAMETER_GEOMETRY_FEMUR_MM);
    const uint32_t least = brace_parameter_number(BRACE_PARAMETER_MOTOR_FEMUR_ANGLE_MIN_RAD);
    static const uint32_t none[] = {0x7fc00000u, 0x7f800000u, 0xc3390000u}; /* NaN, infinite, -185.0f */
    to_configuration();
    for (int i = 0; i < 3; i++) {
        asked.write_entry = (brace_write_entry_request_t){femur, none[i]};
        TEST_ASSERT_NOT_EQUAL(BRACE_OK, put(BRACE_REQUEST_WRITE_ENTRY));
        TEST_ASSERT_EQUAL(femur, request.detail);
    }
    asked.write_entry = (brace_write_entry_request_t){least, 0x40e00000u}; /* 7.0f: above its greatest */
    takes(BRACE_REQUEST_WRITE_ENTRY);
    asked.commit = (brace_commit_request_t){.crc = 0};
    const int32_t status = put(BRACE_REQUEST_COMMIT);
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, status);
    TEST_ASSERT_TRUE(request.detail == least || request.detail == least + 1u);
    TEST_ASSERT_EQUAL_FLOAT(-2.0f, brace_app_parameters(&app)->drive[BRACE_FEMUR].angle_min_rad);
}

static void test_an_upload_needs_its_mode_its_size_and_its_order(void)
{
    asked.upload_begin = (brace_upload_begin_request_t){.bytes = BRACE_BLOCK_BYTES, .crc = 7};
    refuses(BRACE_E_MODE, BRACE_MODE_MONITOR, BRACE_REQUEST_UPLOAD_BEGIN);
    asked.upload_word = (brace_upload_word_request_t){.word = 0, .data = 1};
    refuses(BRACE_E_MODE, BRACE_MODE_MONITOR, BRACE_REQUEST_UPLOAD_WORD);
    asked.commit = (brace_commit_request_t){.crc = 1};
    refuses(BRACE_E_MODE, BRACE_MODE_MONITOR, BRACE_REQUEST_COMMIT);
    refuses(BRACE_E_MODE, BRACE_MODE_MONITOR, BRACE_REQUEST_ROLLBACK);
    to_configuration();
    asked.upload_word = (brace_upload_word_request_t){.word = 0, .data = 1};
    refuses(BRACE_REFUSED_ORDER, 0, BRACE_REQUEST_UPLOAD_WORD); /* nothing has begun */
    asked.upload_begin = (brace_upload_begin_request_t){.bytes = BRACE_BLOCK_BYTES - 4, .crc = 7};
    refuses(BRACE_E_LENGTH, BRACE_BLOCK_BYTES, BRACE_REQUEST_UPLOAD_BEGIN);
    asked.upload_begin.bytes = BRACE_BLOCK_BYTES;
    takes(BRACE_REQUEST_UPLOAD_BEGIN);
    TEST_ASSERT_EQUAL(BRACE_BLOCK_BYTES / 4, answer.upload_begin.words);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, answer.upload_begin.setting);
    asked.upload_word = (brace_upload_word_request_t){.word = 1, .data = 1};
    refuses(BRACE_REFUSED_ORDER, 0, BRACE_REQUEST_UPLOAD_WORD);
    asked.upload_word.word = 0;
    takes(BRACE_REQUEST_UPLOAD_WORD);
    TEST_ASSERT_EQUAL(0, answer.upload_word.word);
    TEST_ASSERT_EQUAL(1, answer.upload_word.data);
    asked.upload_word = (brace_upload_word_request_t){.word = 2, .data = 1};
    refuses(BRACE_REFUSED_ORDER, 1, BRACE_REQUEST_UPLOAD_WORD);
    asked.commit = (brace_commit_request_t){.crc = 7};
    refuses(BRACE_REFUSED_ORDER, 1, BRACE_REQUEST_COMMIT);
}

static void upload_block(const uint8_t block[BRACE_BLOCK_BYTES])
{
    uint32_t crc = 0;
    memcpy(&crc, block + BRACE_BLOCK_BYTES - 4, 4);
    asked.upload_begin = (brace_upload_begin_request_t){.bytes = BRACE_BLOCK_BYTES, .crc = crc};
    takes(BRACE_REQUEST_UPLOAD_BEGIN);
    for (uint32_t word = 0; word < BRACE_BLOCK_BYTES / 4u; word++) {
        asked.upload_word = (brace_upload_word_request_t){.word = word};
        memcpy(&asked.upload_word.data, block + 4u * word, 4);
        takes(BRACE_REQUEST_UPLOAD_WORD);
    }
    asked.commit = (brace_commit_request_t){.crc = crc};
}

static void upload(const brace_parameters_t *set)
{
    uint8_t block[BRACE_BLOCK_BYTES];
    TEST_ASSERT_EQUAL(BRACE_OK, brace_parameters_pack(set, 1, block, sizeof block));
    upload_block(block);
}

/* The block is whole and its CRC is right, but its dictionary has other members, or fewer. */
static void test_a_block_of_another_dictionary_is_refused(void)
{
    enum { SCHEMA_AT = 8, MEMBERS_AT = 12 };
    to_configuration();
    for (int fewer = 0; fewer < 2; fewer++) {
        uint8_t block[BRACE_BLOCK_BYTES];
        TEST_ASSERT_EQUAL(BRACE_OK, brace_parameters_pack(brace_app_parameters(&app), 1, block, sizeof block));
        const uint32_t other = fewer != 0 ? 4u * (BRACE_PARAMETER_COUNT - 1u) : 7u;
        memcpy(block + (fewer != 0 ? MEMBERS_AT : SCHEMA_AT), &other, sizeof other);
        const uint32_t crc = brace_crc32(0, block, BRACE_BLOCK_BYTES - 4);
        memcpy(block + BRACE_BLOCK_BYTES - 4, &crc, sizeof crc);
        upload_block(block);
        refuses(fewer != 0 ? BRACE_E_LENGTH : BRACE_E_SCHEMA, BRACE_SCHEMA_HASH, BRACE_REQUEST_COMMIT);
        refuses(BRACE_REFUSED_ORDER, 0, BRACE_REQUEST_COMMIT); /* it was committed, and is gone */
    }
}

/* What is no block is refused as such, though its CRC fits. */
static void test_what_is_no_block_is_refused(void)
{
    to_configuration();
    for (int i = 0; i < 2; i++) {
        uint8_t block[BRACE_BLOCK_BYTES];
        TEST_ASSERT_EQUAL(BRACE_OK, brace_parameters_pack(brace_app_parameters(&app), 1, block, sizeof block));
        block[i == 0 ? 0 : 4] ^= 2u; /* its name; its format */
        const uint32_t crc = brace_crc32(0, block, BRACE_BLOCK_BYTES - 4);
        memcpy(block + BRACE_BLOCK_BYTES - 4, &crc, sizeof crc);
        upload_block(block);
        refuses(i == 0 ? BRACE_E_MAGIC : BRACE_E_FORMAT, BRACE_SCHEMA_HASH, BRACE_REQUEST_COMMIT);
    }
}

/* The board's ceiling holds for a whole block and for what is staged one by one; the refusal reports which entry. */
static void test_the_board_s_ceiling_refuses_a_block_and_reports_which_entry(void)
{
    static const brace_hal_ceiling_t ceiling[BRACE_LINK_COUNT] = {
        {.torque_most_n_mm = 2e4f, .angle_least_rad = -2.5f, .angle_most_rad = 3.5f, .speed_most_rad_per_s = 5.0f},
        {.torque_most_n_mm = 2e4f, .angle_least_rad = -2.5f, .angle_most_rad = 3.5f, .speed_most_rad_per_s = 5.0f},
        {.torque_most_n_mm = 2e4f, .angle_least_rad = -2.5f, .angle_most_rad = 3.5f, .speed_most_rad_per_s = 5.0f}};
    brace_parameters_t p = *brace_app_parameters(&app);
    fake.hal.ceiling = ceiling;
    to_configuration();
    p.drive[BRACE_TIBIA].torque_range_n_mm = 3e4f;
    upload(&p);
    refuses(BRACE_REFUSED_CEILING, brace_parameter_number(brace_app_beyond_board(&app, &p)), BRACE_REQUEST_COMMIT);
    const uint32_t number = brace_parameter_number(brace_app_beyond_board(&app, &p));
    asked.write_entry = (brace_write_entry_request_t){number, 0x46ea6000u}; /* 30000.0f */
    takes(BRACE_REQUEST_WRITE_ENTRY);
    asked.commit = (brace_commit_request_t){.crc = 0};
    refuses(BRACE_REFUSED_CEILING, number, BRACE_REQUEST_COMMIT);
}

/* Values that come as a block are judged on the way to the store: the one at fault is named then. */
static void test_a_set_that_the_store_refuses_names_its_member(void)
{
    to_configuration();
    brace_parameters_t set = *brace_app_parameters(&app);
    set.controller.node_id = 200; /* no node has it */
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_commit(&app, &set));
    for (int i = 0; i < 500 && brace_app_is_storing(&app); i++) {
        ticks(1);
    }
    brace_commit_answer_t stored;
    request = (request_t){.app = &app};
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, answer_of_storing(&request, &stored));
    TEST_ASSERT_EQUAL(brace_parameter_number(BRACE_PARAMETER_CONTROLLER_NODE_ID), request.detail);
    TEST_ASSERT_EQUAL(5, brace_app_parameters(&app)->controller.node_id);
}

static void test_a_set_that_is_stored_answers_with_what_is_in_force(void)
{
    brace_parameters_t p = *brace_app_parameters(&app);
    p.limb.femur_mm = 190.0f;
    to_configuration();
    upload(&p);
    TEST_ASSERT_EQUAL(ANSWER_LATER, put(BRACE_REQUEST_COMMIT));
    asked.upload_begin = (brace_upload_begin_request_t){.bytes = BRACE_BLOCK_BYTES, .crc = 7};
    refuses(BRACE_REFUSED_BUSY, BRACE_MODE_CONFIGURATION, BRACE_REQUEST_UPLOAD_BEGIN);
    asked.download_word = (brace_download_word_request_t){.word = 0};
    refuses(BRACE_REFUSED_BUSY, 0, BRACE_REQUEST_DOWNLOAD_WORD);
    asked.write_entry = (brace_write_entry_request_t){1, 0x433e0000u};
    refuses(BRACE_REFUSED_BUSY, 1, BRACE_REQUEST_WRITE_ENTRY);
    asked.set_mode = (brace_set_mode_request_t){.mode = BRACE_MODE_MONITOR, .key = 0xc0de};
    refuses(BRACE_REFUSED_BUSY, BRACE_MODE_CONFIGURATION, BRACE_REQUEST_SET_MODE);
    for (int i = 0; i < 1000 && brace_app_is_storing(&app); i++) {
        ticks(1);
    }
    ticks(2);
    brace_commit_answer_t stored;
    TEST_ASSERT_EQUAL(BRACE_OK, answer_of_storing(&request, &stored));
    TEST_ASSERT_EQUAL_HEX32(brace_parameters_crc(&p), stored.crc);
    TEST_ASSERT_EQUAL(now()->parameter_sequence, stored.sequence);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, stored.setting);
    TEST_ASSERT_EQUAL_FLOAT(190.0f, brace_app_parameters(&app)->limb.femur_mm);
    upload(&p); /* at most one in ten seconds; the answer says how long to wait */
    const int32_t status = put(BRACE_REQUEST_COMMIT);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_EARLY, status);
    TEST_ASSERT_TRUE(request.detail > 5000u && request.detail <= 10000u);
    ticks(2);
    TEST_ASSERT_EQUAL(1, app.wires.measured.commits_refused);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_EARLY, (int32_t)app.controller.ownership.last_refusal);
}

/* The whole set word by word is the block that it was packed to. */
static void test_a_download_is_the_block(void)
{
    uint8_t block[BRACE_BLOCK_BYTES];
    TEST_ASSERT_EQUAL(
        BRACE_OK, brace_parameters_pack(brace_app_parameters(&app), now()->parameter_sequence, block, sizeof block));
    asked.download_word = (brace_download_word_request_t){.word = 0xffff};
    takes(BRACE_REQUEST_DOWNLOAD_WORD);
    TEST_ASSERT_EQUAL_HEX32(BRACE_BLOCK_BYTES | (uint32_t)now()->parameter_origin << 16, answer.download_word.data);
    for (uint32_t word = 0; word < BRACE_BLOCK_BYTES / 4u; word++) {
        uint32_t wanted;
        memcpy(&wanted, block + 4u * word, 4);
        for (int again = 0; again < 2; again++) { /* an answer may be lost */
            asked.download_word.word = word;
            takes(BRACE_REQUEST_DOWNLOAD_WORD);
            TEST_ASSERT_EQUAL(word, answer.download_word.word);
            TEST_ASSERT_EQUAL_HEX32(wanted, answer.download_word.data);
        }
    }
    asked.download_word.word = BRACE_BLOCK_BYTES / 4u;
    refuses(BRACE_REFUSED_ORDER, BRACE_BLOCK_BYTES / 4u, BRACE_REQUEST_DOWNLOAD_WORD);
    asked.download_word.word = 5;
    refuses(BRACE_REFUSED_ORDER, BRACE_BLOCK_BYTES / 4u, BRACE_REQUEST_DOWNLOAD_WORD);
    for (asked.download_word.word = 0; asked.download_word.word < 3u; asked.download_word.word++) {
        takes(BRACE_REQUEST_DOWNLOAD_WORD);
    }
    app.controller.snapshot[app.controller.newest].parameter_crc ^= 1u; /* another set: it has to begin anew */
    refuses(BRACE_REFUSED_CHANGED, 3, BRACE_REQUEST_DOWNLOAD_WORD);
    refuses(BRACE_REFUSED_ORDER, 0, BRACE_REQUEST_DOWNLOAD_WORD);
    asked.download_word.word = 0;
    takes(BRACE_REQUEST_DOWNLOAD_WORD);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_who_this_is);
    RUN_TEST(test_where_down_is);
    RUN_TEST(test_a_loading_test_from_its_start_to_its_rows);
    RUN_TEST(test_the_torque_of_a_test_is_the_stronger_motor_s);
    RUN_TEST(test_each_item_of_a_loading_test_s_result);
    RUN_TEST(test_faults_are_cleared_and_what_is_left_is_reported);
    RUN_TEST(test_each_number_of_a_drift);
    RUN_TEST(test_play_and_its_take_up);
    RUN_TEST(test_a_sign_of_life);
    RUN_TEST(test_stop_takes_back_what_has_not_begun);
    RUN_TEST(test_a_seal_is_for_a_command);
    RUN_TEST(test_an_entry_that_is_none_is_no_command);
    RUN_TEST(test_a_question_owns_nothing);
    RUN_TEST(test_what_no_request_stands_for);
    RUN_TEST(test_a_force_is_used_up_by_its_answer);
    RUN_TEST(test_both_knees_under_a_load);
    RUN_TEST(test_what_has_no_K_says_what_the_K_of_now_is_worth);
    RUN_TEST(test_what_the_K_of_now_means_at_the_contact);
    RUN_TEST(test_modes_are_reported_and_refused);
    RUN_TEST(test_configuration_leads_back_alone);
    RUN_TEST(test_entries_are_staged_and_read);
    RUN_TEST(test_what_no_limb_has_is_refused);
    RUN_TEST(test_an_upload_needs_its_mode_its_size_and_its_order);
    RUN_TEST(test_a_block_of_another_dictionary_is_refused);
    RUN_TEST(test_what_is_no_block_is_refused);
    RUN_TEST(test_the_board_s_ceiling_refuses_a_block_and_reports_which_entry);
    RUN_TEST(test_a_set_that_the_store_refuses_names_its_member);
    RUN_TEST(test_a_set_that_is_stored_answers_with_what_is_in_force);
    RUN_TEST(test_a_download_is_the_block);
    return UNITY_END();
}
