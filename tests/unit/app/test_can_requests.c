/* Requests over CAN: every one answered or refused, K elsewhere, parameters changed by nothing but a commit. */
#include <stddef.h>

#include "brace/answering.h"
#include "brace/codes.h"
#include "can_bench.h"
#include "controller.h"

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    bench_start(&p);
    ticks(10);
    drain();
}

void tearDown(void) {}

static answer_t ask_k(float theta1_rad, float theta2_rad, int within)
{
    uint8_t data[8];
    brace_can_pack_k_at_posture_request(&(brace_can_k_at_posture_request_t){0x5a, theta1_rad, theta2_rad}, data);
    return ask_within(data, within);
}

static void check_k(const answer_t *answer, uint32_t code, const brace_stiffness_t *k)
{
    brace_can_k_at_posture_answer_0_t a;
    brace_can_k_at_posture_answer_1_t b;
    brace_can_k_at_posture_answer_2_t c;
    brace_can_k_at_posture_answer_3_t d;
    TEST_ASSERT_EQUAL(4, answer->count);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_HEX8(answer_number(code, (uint32_t)i), answer->part[i][0]);
        TEST_ASSERT_EQUAL_HEX8(0x5a, answer->part[i][1]);
    }
    brace_can_unpack_k_at_posture_answer_0(answer->part[0], &a);
    brace_can_unpack_k_at_posture_answer_1(answer->part[1], &b);
    brace_can_unpack_k_at_posture_answer_2(answer->part[2], &c);
    brace_can_unpack_k_at_posture_answer_3(answer->part[3], &d);
    /* half a step, and what the angles' own half step of 5e-7 rad makes of a K of some 10 N/mm */
    TEST_ASSERT_FLOAT_WITHIN(4e-4f, k->k_xx_n_per_mm, a.k_xx_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(4e-4f, k->k_xz_n_per_mm, a.k_xz_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(4e-4f, k->k_zz_n_per_mm, b.k_zz_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(4e-4f, k->lambda_min_n_per_mm, b.lambda_min_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(4e-4f, k->lambda_max_n_per_mm, c.lambda_max_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(1e-4f, k->stiff_axis_rad, c.stiff_axis_rad);
    TEST_ASSERT_EQUAL_HEX32(k->flags, d.flags);
}

static void test_K_asked_where_the_limb_is_is_the_K_reported_two_ticks_later(void)
{
    const brace_stiffness_t k = now()->stiffness.now;
    const answer_t answer = ask_k(now()->theta_rad[BRACE_FEMUR], now()->theta_rad[BRACE_TIBIA], K_TICKS);
    check_k(&answer, BRACE_REQUEST_K_AT_POSTURE, &k);
}

static void test_K_at_the_tip_is_K_at_its_posture_both_knees(void)
{
    for (int down = 0; down < 2; down++) {
        fake.joint[BRACE_TIBIA].sample.motor_rad = down ? -1.4f : 1.4f;
        bench_believe();
        ticks(20);
        drain();
        const brace_stiffness_t k = now()->stiffness.now;
        uint8_t data[8];
        brace_can_pack_k_at_tip_knee_up_request(
            &(brace_can_k_at_tip_knee_up_request_t){0x5a, now()->tip_mm.x_mm, now()->tip_mm.z_mm}, data);
        data[0] = (uint8_t)(down ? BRACE_REQUEST_K_AT_TIP_KNEE_DOWN : BRACE_REQUEST_K_AT_TIP_KNEE_UP);
        const answer_t answer = ask_within(data, K_TICKS);
        brace_can_k_at_posture_answer_0_t a;
        TEST_ASSERT_EQUAL(4, answer.count);
        brace_can_unpack_k_at_posture_answer_0(answer.part[0], &a);
        TEST_ASSERT_EQUAL_HEX8(answer_number(data[0], 0), answer.part[0][0]);
        TEST_ASSERT_FLOAT_WITHIN(2e-3f, k.k_xx_n_per_mm, a.k_xx_n_per_mm); /* a tip known to 5e-4 mm */
        TEST_ASSERT_FLOAT_WITHIN(2e-3f, k.k_xz_n_per_mm, a.k_xz_n_per_mm);
    }
}

static void test_K_elsewhere_leaves_the_limbs_own_alone(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb.base.x_mm_per_n = 0.01f; /* the general path, whose model has a memory */
    p.drive[BRACE_FEMUR].hardening_n_mm_per_rad3 = 1e8f;
    bench_start(&p);
    ticks(50);
    drain();
    const brace_stiffness_t before = now()->stiffness.now;
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_EQUAL(4, ask_k(0.3f, 0.1f * (float)i + 0.2f, PATIENCE_TICKS).count);
        ticks(2);
        TEST_ASSERT_EQUAL_FLOAT(before.k_xx_n_per_mm, now()->stiffness.now.k_xx_n_per_mm);
        TEST_ASSERT_EQUAL_FLOAT(before.lambda_min_n_per_mm, now()->stiffness.now.lambda_min_n_per_mm);
    }
    const answer_t answer = ask_k(now()->theta_rad[BRACE_FEMUR], now()->theta_rad[BRACE_TIBIA], K_TICKS);
    TEST_ASSERT_EQUAL(4, answer.count);
}

static void test_K_where_there_is_none_is_refused(void)
{
    uint8_t data[8];
    const float unknown = __builtin_nanf("");
    answer_t answer = ask_k(unknown, 0.5f, PATIENCE_TICKS);
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, refusal_of(&answer, BRACE_REQUEST_K_AT_POSTURE).status);
    brace_can_pack_k_at_tip_knee_up_request(&(brace_can_k_at_tip_knee_up_request_t){1, 8000.0f, 0.0f}, data);
    answer = ask(data);
    TEST_ASSERT_EQUAL(BRACE_E_UNREACHABLE, refusal_of(&answer, BRACE_REQUEST_K_AT_TIP_KNEE_UP).status);
    TEST_ASSERT_EQUAL_HEX8(1, answer.part[0][1]);
    answer = ask_k(-2.5f, 0.5f, PATIENCE_TICKS); /* outside the travel: answered, and flagged */
    brace_can_k_at_posture_answer_3_t d;
    brace_can_unpack_k_at_posture_answer_3(answer.part[3], &d);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FLAG_OUT_OF_RANGE, d.flags & BRACE_FLAG_OUT_OF_RANGE);
}

static void test_sag_undoes_contact_force(void)
{
    uint8_t data[8];
    brace_can_contact_force_answer_0_t force;
    brace_can_sag_for_load_answer_0_t sag;
    brace_can_pack_contact_force_request(&(brace_can_contact_force_request_t){2, 0.5f, -1.25f}, data);
    answer_t answer = ask(data);
    TEST_ASSERT_EQUAL(2, answer.count);
    brace_can_unpack_contact_force_answer_0(answer.part[0], &force);
    const brace_stiffness_t *k = &now()->stiffness.now;
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, 0.5f * k->k_xx_n_per_mm - 1.25f * k->k_xz_n_per_mm, force.fx_n);
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, 0.5f * k->k_xz_n_per_mm - 1.25f * k->k_zz_n_per_mm, force.fz_n);
    brace_can_pack_sag_for_load_request(&(brace_can_sag_for_load_request_t){2, force.fx_n, force.fz_n}, data);
    answer = ask(data);
    TEST_ASSERT_EQUAL(1, answer.count);
    brace_can_unpack_sag_for_load_answer_0(answer.part[0], &sag);
    /* forces were rounded to 5e-4 N, and yield by at most that over lambda_min */
    TEST_ASSERT_FLOAT_WITHIN(1e-4f + 1e-3f / k->lambda_min_n_per_mm, 0.5f, sag.dx_mm);
    TEST_ASSERT_FLOAT_WITHIN(1e-4f + 1e-3f / k->lambda_min_n_per_mm, -1.25f, sag.dz_mm);
}

static void test_friction_margin_is_of_the_force_of_now(void)
{
    uint8_t data[8];
    brace_can_friction_margin_answer_0_t grip;
    fake.force_x_n = 3.0f;
    fake.force_z_n = 10.0f;
    ticks(5);
    drain();
    brace_can_pack_friction_margin_request(&(brace_can_friction_margin_request_t){2, 1.5708f, 0.5f}, data);
    const answer_t answer = ask(data);
    TEST_ASSERT_EQUAL(1, answer.count);
    brace_can_unpack_friction_margin_answer_0(answer.part[0], &grip);
    TEST_ASSERT_FLOAT_WITHIN(2e-3f, 0.5f * 10.0f - 3.0f, grip.margin_n);
    TEST_ASSERT_EQUAL(0, grip.contact);
}

static void test_entries_are_read_and_those_that_are_none_refused(void)
{
    uint8_t data[8];
    float value;
    uint32_t word = read_entry(BRACE_ENTRY_MEASURED);
    TEST_ASSERT_EQUAL_HEX32(0x4640e600, word);
    TEST_ASSERT_EQUAL_HEX32(0x01020304, read_entry(BRACE_ENTRY_MEASURED + 1));
    TEST_ASSERT_EQUAL_HEX32(BRACE_DICTIONARY_HASH, read_entry(BRACE_ENTRY_MEASURED + 2));
    TEST_ASSERT_EQUAL(NODE, read_entry(brace_parameter_number(BRACE_PARAMETER_CONTROLLER_NODE_ID)));
    word = read_entry(brace_parameter_number(BRACE_PARAMETER_GEOMETRY_FEMUR_MM));
    memcpy(&value, &word, 4);
    TEST_ASSERT_EQUAL_FLOAT(bench_parameters().limb.femur_mm, value);
    static const uint32_t none[] = {BRACE_PARAMETER_NUMBERS, 0xfff, BRACE_ENTRY_MEASURED + BRACE_MEASURED_COUNT,
                                    0xffff};
    for (int i = 0; i < 4; i++) {
        brace_can_pack_read_entry_request(&(brace_can_read_entry_request_t){1, none[i]}, data);
        const answer_t answer = ask(data);
        const brace_can_refusal_t refusal = refusal_of(&answer, BRACE_REQUEST_READ_ENTRY);
        TEST_ASSERT_EQUAL(BRACE_E_RANGE, refusal.status);
        TEST_ASSERT_EQUAL(none[i], refusal.detail);
    }
}

static void test_identify_reports_version_hashes_node(void)
{
    const uint8_t data[8] = {BRACE_REQUEST_IDENTIFY, 0x33};
    brace_can_identify_answer_0_t who;
    brace_can_identify_answer_1_t dictionary;
    brace_can_identify_answer_2_t schema;
    brace_can_identify_answer_3_t set;
    brace_can_identify_answer_4_t condition;
    fake.joint[BRACE_TIBIA].not_newer = true;
    ticks(50);
    drain();
    const answer_t answer = ask(data);
    TEST_ASSERT_EQUAL(5, answer.count);
    brace_can_unpack_identify_answer_0(answer.part[0], &who);
    brace_can_unpack_identify_answer_1(answer.part[1], &dictionary);
    brace_can_unpack_identify_answer_2(answer.part[2], &schema);
    brace_can_unpack_identify_answer_3(answer.part[3], &set);
    brace_can_unpack_identify_answer_4(answer.part[4], &condition);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FAULT_SENSOR_TIBIA, condition.faults);
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, condition.mode);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, condition.setting);
    TEST_ASSERT_EQUAL(0x33, who.token);
    TEST_ASSERT_EQUAL(BRACE_PROTOCOL, who.protocol);
    TEST_ASSERT_EQUAL(NODE, who.node);
    TEST_ASSERT_EQUAL_HEX32(BRACE_DICTIONARY_HASH, dictionary.dictionary_hash);
    TEST_ASSERT_EQUAL_HEX32(BRACE_SCHEMA_HASH, schema.schema_hash);
    TEST_ASSERT_EQUAL_HEX32(now()->parameter_crc, set.parameter_crc);
    TEST_ASSERT_EQUAL(now()->parameter_origin, set.origin);
}

/* A limb without a coxa joint, that has learned nothing yet and has never taken up play. */
static void test_space_drift_and_take_up_are_reported_or_refused(void)
{
    uint8_t data[8];
    brace_can_drift_answer_0_t drift;
    brace_can_drift_answer_1_t loss;
    brace_can_drift_answer_2_t readings;
    brace_can_take_up_result_answer_0_t result;
    brace_can_pack_k_in_space_at_posture_request(&(brace_can_k_in_space_at_posture_request_t){1, 0.1f, 0.5f, 1.0f},
                                                 data);
    answer_t answer = ask(data);
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, refusal_of(&answer, BRACE_REQUEST_K_IN_SPACE_AT_POSTURE).status);
    const uint8_t ask_drift[8] = {BRACE_REQUEST_DRIFT, 1};
    answer = ask(ask_drift);
    TEST_ASSERT_EQUAL(3, answer.count);
    brace_can_unpack_drift_answer_0(answer.part[0], &drift);
    brace_can_unpack_drift_answer_1(answer.part[1], &loss);
    brace_can_unpack_drift_answer_2(answer.part[2], &readings);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_LEARNING, drift.state);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_CAUSE_NONE, drift.cause);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_NEXT_LEARN, drift.next_step);
    TEST_ASSERT_TRUE(loss.loss_ratio != loss.loss_ratio); /* of no cause no loss is known */
    TEST_ASSERT_EQUAL(0, readings.readings);
    TEST_ASSERT_EQUAL(0xffff, readings.since_readings);
    brace_can_pack_take_up_result_request(&(brace_can_take_up_result_request_t){1, BRACE_TIBIA}, data);
    answer = ask(data);
    TEST_ASSERT_EQUAL(1, answer.count);
    brace_can_unpack_take_up_result_answer_0(answer.part[0], &result);
    TEST_ASSERT_EQUAL(BRACE_TIBIA, result.joint);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_NONE, result.outcome);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_IDLE, result.phase);
    brace_can_pack_take_up_result_request(&(brace_can_take_up_result_request_t){1, 3}, data);
    answer = ask(data);
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, refusal_of(&answer, BRACE_REQUEST_TAKE_UP_RESULT).status);
}

static void test_what_is_no_request_is_counted_and_not_answered(void)
{
    const uint8_t data[8] = {BRACE_REQUEST_IDENTIFY, 1, 0, 0, 0, 0, 0, 0};
    answer_t answer = {0};
    const uint32_t before = counters().frames_unknown;
    for (uint8_t length = 0; length < 8; length++) {
        arrives(0x600 + NODE, data, length);
    }
    ticks(30);
    collect(&answer);
    TEST_ASSERT_EQUAL(0, answer.count);
    TEST_ASSERT_EQUAL(before + 8, counters().frames_unknown);
    arrives(0x600 + NODE + 1, data, 8); /* a neighbour's: neither answered nor strange */
    ticks(5);
    collect(&answer);
    TEST_ASSERT_EQUAL(0, answer.count);
    TEST_ASSERT_EQUAL(before + 8, counters().frames_unknown);
    static const uint8_t none[] = {0, BRACE_REQUEST_IDENTIFY + 128, 254, 255}; /* no request has these codes */
    for (uint32_t i = 0; i < sizeof none; i++) {
        const uint8_t asked[8] = {none[i], 0x77};
        answer = ask(asked);
        const brace_can_refusal_t refusal = refusal_of(&answer, none[i]);
        TEST_ASSERT_EQUAL(BRACE_REFUSED_UNKNOWN, refusal.status);
        TEST_ASSERT_EQUAL(0x77, refusal.token);
        TEST_ASSERT_EQUAL(before + 9 + i, counters().frames_unknown);
    }
}

static void test_configuration_needs_its_key(void)
{
    uint8_t data[8];
    brace_can_pack_set_mode_request(&(brace_can_set_mode_request_t){7, BRACE_MODE_CONFIGURATION, 0xc0df}, data);
    answer_t answer = ask(data);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_KEY, refusal_of(&answer, BRACE_REQUEST_SET_MODE).status);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    answer = set_mode(BRACE_MODE_CONFIGURATION);
    TEST_ASSERT_EQUAL(1, answer.count);
    TEST_ASSERT_EQUAL_HEX8(BRACE_SET_MODE_ANSWER_0, answer.part[0][0]);
    TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, answer.part[0][2]);
    answer = set_mode(BRACE_MODE_CONFIGURATION); /* it is there already */
    TEST_ASSERT_EQUAL_HEX8(BRACE_SET_MODE_ANSWER_0, answer.part[0][0]);
    answer = set_mode(BRACE_MODE_MONITOR);
    TEST_ASSERT_EQUAL_HEX8(BRACE_SET_MODE_ANSWER_0, answer.part[0][0]);
    ticks(5);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    answer = set_mode(BRACE_MODE_FAULT);
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, refusal_of(&answer, BRACE_REQUEST_SET_MODE).status);
}

static answer_t write_entry(uint32_t index, uint32_t value)
{
    uint8_t data[8];
    brace_can_pack_write_entry_request(&(brace_can_write_entry_request_t){4, index, value}, data);
    return ask(data);
}

static answer_t commit(uint32_t crc)
{
    uint8_t data[8];
    brace_can_pack_commit_request(&(brace_can_commit_request_t){3, crc}, data);
    return ask_within(data, 500);
}

static void test_a_written_entry_is_in_force_only_after_its_commit(void)
{
    const float longer = 190.0f;
    uint32_t word;
    memcpy(&word, &longer, 4);
    answer_t answer = write_entry(brace_parameter_number(BRACE_PARAMETER_GEOMETRY_FEMUR_MM), word);
    TEST_ASSERT_EQUAL(BRACE_E_MODE, refusal_of(&answer, BRACE_REQUEST_WRITE_ENTRY).status);
    (void)set_mode(BRACE_MODE_CONFIGURATION);
    answer = write_entry(brace_parameter_number(BRACE_PARAMETER_GEOMETRY_FEMUR_MM), word);
    TEST_ASSERT_EQUAL_HEX8(BRACE_WRITE_ENTRY_ANSWER_0, answer.part[0][0]);
    TEST_ASSERT_EQUAL_MEMORY(&word, &answer.part[0][4], 4);
    TEST_ASSERT_NOT_EQUAL(word, read_entry(brace_parameter_number(BRACE_PARAMETER_GEOMETRY_FEMUR_MM)));
    answer = write_entry(brace_parameter_number(BRACE_PARAMETER_GEOMETRY_FEMUR_MM), 0x7fc00000);
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, refusal_of(&answer, BRACE_REQUEST_WRITE_ENTRY).status);
    answer = write_entry(BRACE_ENTRY_MEASURED + 4, 1);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_READ_ONLY, refusal_of(&answer, BRACE_REQUEST_WRITE_ENTRY).status);
    answer = commit(0);
    TEST_ASSERT_EQUAL(2, answer.count);
    TEST_ASSERT_EQUAL_HEX8(BRACE_COMMIT_ANSWER_0, answer.part[0][0]);
    TEST_ASSERT_EQUAL_HEX8(BRACE_COMMIT_ANSWER_1, answer.part[1][0]);
    brace_can_commit_answer_1_t done;
    brace_can_unpack_commit_answer_1(answer.part[1], &done);
    TEST_ASSERT_EQUAL_HEX32(brace_parameters_crc(brace_app_parameters(&app)), done.crc);
    TEST_ASSERT_EQUAL_HEX32(word, read_entry(brace_parameter_number(BRACE_PARAMETER_GEOMETRY_FEMUR_MM)));
    const uint8_t rollback[8] = {BRACE_REQUEST_ROLLBACK, 1};
    answer = ask_within(rollback, 500);
    TEST_ASSERT_EQUAL(2, answer.count);
    TEST_ASSERT_NOT_EQUAL(word, read_entry(brace_parameter_number(BRACE_PARAMETER_GEOMETRY_FEMUR_MM)));
    answer = ask_within(rollback, 500); /* nothing is left to go back to */
    TEST_ASSERT_EQUAL(BRACE_REFUSED_STORE + BRACE_STORE_E_NOTHING, refusal_of(&answer, BRACE_REQUEST_ROLLBACK).status);
}

static void test_a_memory_that_fails_keeps_the_old_set_and_says_so(void)
{
    const uint32_t before = now()->parameter_crc;
    (void)set_mode(BRACE_MODE_CONFIGURATION);
    (void)write_entry(brace_parameter_number(BRACE_PARAMETER_CONTROLLER_MODBUS_ADDRESS), 17);
    fake.nvm_forgets = true;
    const answer_t answer = commit(0);
    const int32_t status = refusal_of(&answer, BRACE_REQUEST_COMMIT).status;
    TEST_ASSERT_TRUE(status < BRACE_REFUSED_STORE && status >= BRACE_REFUSED_STORE + BRACE_STORE_E_SHAPE);
    TEST_ASSERT_EQUAL_HEX32(before, now()->parameter_crc);
    TEST_ASSERT_NOT_EQUAL(17, read_entry(brace_parameter_number(BRACE_PARAMETER_CONTROLLER_MODBUS_ADDRESS)));
}

static void other_block(uint8_t block[BRACE_BLOCK_BYTES])
{
    brace_parameters_t p = bench_parameters();
    p.limb.femur_mm = 190.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_parameters_pack(&p, 99, block, BRACE_BLOCK_BYTES));
}

static void test_a_push_is_in_force_once_answered(void)
{
    uint8_t block[BRACE_BLOCK_BYTES], data[8];
    other_block(block);
    (void)set_mode(BRACE_MODE_CONFIGURATION);
    for (int step = 0; step < PUSH_STEPS; step++) {
        push_request(block, step, data);
        const answer_t answer = ask_within(data, 500);
        TEST_ASSERT_EQUAL(step == PUSH_STEPS - 1 ? 2 : 1, answer.count);
        TEST_ASSERT_EQUAL_HEX8(answer_number(data[0], 0), answer.part[0][0]);
        if (data[0] == BRACE_REQUEST_UPLOAD_WORD) {
            TEST_ASSERT_EQUAL_MEMORY(data + 1, answer.part[0] + 1, 7);
        }
        if (step < PUSH_STEPS - 1) {
            TEST_ASSERT_TRUE(brace_app_parameters(&app)->limb.femur_mm != 190.0f);
        }
    }
    TEST_ASSERT_EQUAL_FLOAT(190.0f, brace_app_parameters(&app)->limb.femur_mm);
    /* word by word it reads back as a block of its own */
    uint8_t read[BRACE_BLOCK_BYTES];
    brace_parameters_t got;
    for (uint32_t word = 0; word < BRACE_BLOCK_BYTES / 4; word++) {
        brace_can_pack_download_word_request(&(brace_can_download_word_request_t){1, word}, data);
        const answer_t answer = ask(data);
        TEST_ASSERT_EQUAL_HEX8(BRACE_DOWNLOAD_WORD_ANSWER_0, answer.part[0][0]);
        memcpy(&read[4 * word], &answer.part[0][4], 4);
    }
    TEST_ASSERT_EQUAL(BRACE_OK, brace_parameters_unpack(read, sizeof read, &got, NULL, NULL));
    TEST_ASSERT_EQUAL_MEMORY(brace_app_parameters(&app), &got, sizeof got);
}

/* Power off, or the line cut, before each of its frames in turn: after the next start the old set is in force. */
static void test_a_push_interrupted_at_any_frame_leaves_the_old_set(void)
{
    uint8_t block[BRACE_BLOCK_BYTES], data[8];
    other_block(block);
    const uint32_t before = now()->parameter_crc;
    for (int cut = 0; cut < PUSH_STEPS; cut++) {
        const brace_parameters_t p = bench_parameters();
        bench_start(&p);
        ticks(5);
        drain();
        (void)set_mode(BRACE_MODE_CONFIGURATION);
        for (int step = 0; step < cut; step++) {
            push_request(block, step, data);
            TEST_ASSERT_EQUAL(1, ask(data).count);
        }
        ticks(20);
        TEST_ASSERT_EQUAL_HEX32(before, now()->parameter_crc);
        (void)set_mode(BRACE_MODE_MONITOR); /* the line was cut, and somebody else comes */
        (void)set_mode(BRACE_MODE_CONFIGURATION);
        push_request(block, PUSH_STEPS - 1, data);
        const answer_t answer = ask_within(data, 500);
        TEST_ASSERT_EQUAL(BRACE_REFUSED_ORDER, refusal_of(&answer, BRACE_REQUEST_COMMIT).status);
        brace_fake_reset(&fake, BRACE_RESET_POWER);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
        TEST_ASSERT_EQUAL_HEX32(before, now()->parameter_crc);
    }
}

static void test_a_push_with_a_word_missing_twice_or_changed_is_refused(void)
{
    uint8_t block[BRACE_BLOCK_BYTES], data[8];
    other_block(block);
    const uint32_t before = now()->parameter_crc;
    for (int wrong = 1; wrong < PUSH_STEPS - 1; wrong += 13) {
        (void)set_mode(BRACE_MODE_CONFIGURATION);
        for (int step = 0; step < PUSH_STEPS; step++) {
            push_request(block, step, data);
            if (step == wrong) {
                data[5] ^= 0x10;
            } else if (step == PUSH_STEPS - 1) {
                const answer_t answer = ask_within(data, 500);
                const int32_t status = refusal_of(&answer, BRACE_REQUEST_COMMIT).status;
                TEST_ASSERT_TRUE(status == BRACE_E_CHECKSUM || status == BRACE_E_MAGIC || status == BRACE_E_FORMAT ||
                                 status == BRACE_E_LENGTH);
                break;
            }
            (void)ask(data);
        }
        TEST_ASSERT_EQUAL_HEX32(before, now()->parameter_crc);
    }
    push_request(block, 0, data);
    (void)ask(data);
    push_request(block, 2, data); /* word 1 before word 0 */
    answer_t answer = ask(data);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_ORDER, refusal_of(&answer, BRACE_REQUEST_UPLOAD_WORD).status);
    TEST_ASSERT_EQUAL(0, refusal_of(&answer, BRACE_REQUEST_UPLOAD_WORD).detail);
}

static void test_take_up_and_loading_test_over_the_bus(void)
{
    uint8_t data[8];
    brace_can_pack_take_up_request(&(brace_can_take_up_request_t){1, 1, 1}, data);
    answer_t answer = ask(data); /* this limb has no play */
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, refusal_of(&answer, BRACE_REQUEST_TAKE_UP).status);
    brace_can_pack_take_up_request(&(brace_can_take_up_request_t){1, 9, 1}, data);
    answer = ask(data);
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, refusal_of(&answer, BRACE_REQUEST_TAKE_UP).status);
    brace_can_pack_loading_test_start_request(&(brace_can_loading_test_start_request_t){1, 0, 2, 0.5f, 20}, data);
    begin_to_live();
    answer = ask(data);
    TEST_ASSERT_EQUAL(1, answer.count);
    TEST_ASSERT_EQUAL_HEX8(BRACE_LOADING_TEST_START_ANSWER_0, answer.part[0][0]);
    TEST_ASSERT_EQUAL(9, answer.part[0][2]);
    ticks(5);
    TEST_ASSERT_EQUAL(BRACE_MODE_LOADING_TEST, now()->mode);
    drain();
    ticks(140);
    drain();
    const uint8_t stop[8] = {BRACE_REQUEST_LOADING_TEST_STOP, 1};
    answer = ask(stop);
    TEST_ASSERT_EQUAL_HEX8(BRACE_LOADING_TEST_STOP_ANSWER_0, answer.part[0][0]);
    const uint32_t rows = (uint32_t)answer.part[0][2] | (uint32_t)answer.part[0][3] << 8;
    TEST_ASSERT_EQUAL(brace_app_row_count(&app), rows);
    TEST_ASSERT_TRUE(rows >= 1);
    brace_row_t row;
    brace_can_fetch_row_answer_0_t cell;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_row(&app, 0, &row));
    brace_can_pack_fetch_row_request(&(brace_can_fetch_row_request_t){1, 0, 7}, data);
    answer = ask(data);
    brace_can_unpack_fetch_row_answer_0(answer.part[0], &cell);
    float wanted;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_row_value(&row, 7, &wanted));
    TEST_ASSERT_EQUAL_FLOAT(wanted, cell.value);
    brace_can_pack_fetch_row_request(&(brace_can_fetch_row_request_t){1, rows, 7}, data);
    answer = ask(data);
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, refusal_of(&answer, BRACE_REQUEST_FETCH_ROW).status);
    brace_can_loading_test_result_answer_0_t result;
    brace_can_pack_loading_test_result_request(&(brace_can_loading_test_result_request_t){1, 1}, data);
    answer = ask(data);
    brace_can_unpack_loading_test_result_answer_0(answer.part[0], &result);
    TEST_ASSERT_EQUAL(BRACE_LOADING_STOPPED, result.outcome);
    TEST_ASSERT_EQUAL_FLOAT((float)rows, result.value);
    ticks(2000);
    TEST_ASSERT_EQUAL(BRACE_MODE_LOADING_TEST, now()->mode); /* it stands where it was stopped */
    const uint8_t let_go[8] = {BRACE_REQUEST_LET_GO, 1};
    answer = ask(let_go);
    TEST_ASSERT_EQUAL_HEX8(BRACE_LET_GO_ANSWER_0, answer.part[0][0]);
    ticks(2000);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
}

/* Stop is an entry that is written, so that every wire has it. */
static void test_stop_is_heard_while_something_moves(void)
{
    const uint32_t stop = BRACE_ENTRY_COMMANDS + offsetof(brace_commands_t, stop) / 4u;
    uint8_t data[8];
    answer_t answer = write_entry(stop, 1);
    TEST_ASSERT_EQUAL(BRACE_E_MODE, refusal_of(&answer, BRACE_REQUEST_WRITE_ENTRY).status);
    brace_can_pack_loading_test_start_request(&(brace_can_loading_test_start_request_t){1, 0, 2, 0.5f, 20}, data);
    begin_to_live();
    (void)ask(data);
    ticks(140);
    drain();
    TEST_ASSERT_EQUAL(BRACE_MODE_LOADING_TEST, now()->mode);
    answer = write_entry(stop, 1);
    TEST_ASSERT_EQUAL_HEX8(BRACE_WRITE_ENTRY_ANSWER_0, answer.part[0][0]);
    TEST_ASSERT_EQUAL(BRACE_LOADING_STOPPED, brace_app_loading_result(&app)->outcome);
    answer = write_entry(BRACE_ENTRY_COMMANDS + sizeof(brace_commands_t) / 4u, 1); /* there is none behind the last */
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, refusal_of(&answer, BRACE_REQUEST_WRITE_ENTRY).status);
}

/* The way back takes its time: who asks for the next test meanwhile is asked to wait and ask again, and then has it. */
static void test_the_next_loading_test_waits_for_the_way_back(void)
{
    uint8_t data[8];
    const uint8_t stop[8] = {BRACE_REQUEST_LOADING_TEST_STOP, 1}, let_go[8] = {BRACE_REQUEST_LET_GO, 1};
    brace_can_pack_loading_test_start_request(&(brace_can_loading_test_start_request_t){1, 0, 2, 0.5f, 20}, data);
    begin_to_live();
    (void)ask(data);
    ticks(200);
    drain();
    answer_t answer = ask(data);
    TEST_ASSERT_EQUAL(BRACE_E_MODE, refusal_of(&answer, BRACE_REQUEST_LOADING_TEST_START).status);
    (void)ask(stop);
    (void)ask(let_go);
    answer = ask(data);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_BUSY, refusal_of(&answer, BRACE_REQUEST_LOADING_TEST_START).status);
    uint32_t asked = 1;
    while (answer.part[0][0] != BRACE_LOADING_TEST_START_ANSWER_0) {
        TEST_ASSERT_EQUAL(BRACE_REFUSED_BUSY, refusal_of(&answer, BRACE_REQUEST_LOADING_TEST_START).status);
        TEST_ASSERT_TRUE(asked++ < 4000u); /* trims go back at 0.1 rad/s, from 0.3 rad at most */
        answer = ask(data);
    }
    ticks(3); /* it has begun with its owner's sign of life */
    TEST_ASSERT_EQUAL(BRACE_LOADING_RUNNING, brace_app_loading_result(&app)->outcome);
}

static answer_t download(uint32_t word)
{
    uint8_t data[8];
    brace_can_pack_download_word_request(&(brace_can_download_word_request_t){2, word}, data);
    return ask(data);
}

static void test_a_download_is_of_one_set_in_order(void)
{
    for (uint32_t word = 0; word < 4u; word++) {
        TEST_ASSERT_EQUAL_HEX8(BRACE_DOWNLOAD_WORD_ANSWER_0, download(word).part[0][0]);
    }
    TEST_ASSERT_EQUAL_HEX8(BRACE_DOWNLOAD_WORD_ANSWER_0, download(3).part[0][0]); /* its answer was lost */
    static const uint32_t out_of_order[] = {2, 5, BRACE_BLOCK_BYTES / 4};
    for (int i = 0; i < 3; i++) {
        const answer_t answer = download(out_of_order[i]);
        TEST_ASSERT_EQUAL(BRACE_REFUSED_ORDER, refusal_of(&answer, BRACE_REQUEST_DOWNLOAD_WORD).status);
    }
    (void)set_mode(BRACE_MODE_CONFIGURATION);
    (void)write_entry(brace_parameter_number(BRACE_PARAMETER_CONTROLLER_MODBUS_ADDRESS), 17);
    TEST_ASSERT_EQUAL(2, commit(0).count);
    ticks(200);
    drain();
    const answer_t answer = download(4); /* of another set than the words before */
    TEST_ASSERT_EQUAL(BRACE_REFUSED_CHANGED, refusal_of(&answer, BRACE_REQUEST_DOWNLOAD_WORD).status);
    for (uint32_t word = 0; word < BRACE_BLOCK_BYTES / 4; word++) {
        TEST_ASSERT_EQUAL_HEX8(BRACE_DOWNLOAD_WORD_ANSWER_0, download(word).part[0][0]);
    }
    const answer_t beyond = download(BRACE_BLOCK_BYTES / 4);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_ORDER, refusal_of(&beyond, BRACE_REQUEST_DOWNLOAD_WORD).status);
}

static void test_faults_that_stay_are_cleared(void)
{
    uint8_t data[8];
    fake.reset_cause = BRACE_RESET_FAULT;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(20);
    drain();
    TEST_ASSERT_EQUAL_HEX32(BRACE_FAULT_CRASHED, now()->faults);
    brace_can_pack_clear_request(&(brace_can_clear_request_t){1, BRACE_FAULT_SENSOR_FEMUR}, data);
    answer_t answer = ask(data);
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, refusal_of(&answer, BRACE_REQUEST_CLEAR).status);
    brace_can_pack_clear_request(&(brace_can_clear_request_t){1, BRACE_FAULT_CRASHED}, data);
    answer = ask(data);
    TEST_ASSERT_EQUAL_HEX8(BRACE_CLEAR_ANSWER_0, answer.part[0][0]);
    ticks(2);
    TEST_ASSERT_EQUAL_HEX32(0, now()->faults);
}

static void arrives_commit(uint32_t token)
{
    uint8_t data[8];
    brace_can_pack_commit_request(&(brace_can_commit_request_t){token, 0}, data);
    arrives(0x600u + NODE, data, 8);
}

/* Two push at once: whenever the second one's commit comes, the first hears of its own in two parts, and the second
 * that it is refused. */
static void test_two_commits_are_two_answers_whenever_the_second_comes(void)
{
    enum { FIRST = 21, SECOND = 22, STORED_WITHIN = 150 };
    uint32_t busy = 0, stored = 0;
    for (int at = 0; at < STORED_WITHIN; at++) {
        uint32_t parts[2] = {0, 0}, refusals[2] = {0, 0};
        brace_can_frame_t frame;
        setUp();
        (void)set_mode(BRACE_MODE_CONFIGURATION);
        drain();
        arrives_commit(FIRST);
        for (int i = 0; i < 3 * STORED_WITHIN; i++) {
            if (i == at) {
                arrives_commit(SECOND);
            }
            ticks(1);
            while (brace_fake_frame_take(&fake, &frame)) {
                const uint32_t whose = frame.data[1] == SECOND;
                if (frame.id == 0x580u + NODE) {
                    TEST_ASSERT_EQUAL(BRACE_REQUEST_COMMIT, answered_code(frame.data));
                    parts[whose] += !is_refusal(frame.data);
                    refusals[whose] += is_refusal(frame.data);
                }
            }
        }
        TEST_ASSERT_EQUAL(2, parts[0]);
        TEST_ASSERT_EQUAL(0, refusals[0]);
        TEST_ASSERT_EQUAL(refusals[1] > 0u ? 0 : 2, parts[1]);
        TEST_ASSERT_TRUE(refusals[1] <= 1u);
        busy += refusals[1];
        stored += parts[1] / 2u;
    }
    TEST_ASSERT_EQUAL(STORED_WITHIN, busy); /* while a set is stored, and within 10 s of it */
    TEST_ASSERT_EQUAL(0, stored);
}

/* Only a client over Modbus TCP can hang up, and it does so by closing its connection. */
static void test_who_hangs_up(void)
{
    for (int port = 0; port < (int)BRACE_ASKER_COUNT; port++) {
        setUp();
        TEST_ASSERT_FALSE(controller_has_hung_up(&app.controller, (brace_who_t){(brace_asker_t)port, 5}));
        brace_fake_with_peers(&fake);
        fake.open_from = 5;
        TEST_ASSERT_FALSE(controller_has_hung_up(&app.controller, (brace_who_t){(brace_asker_t)port, 5}));
        TEST_ASSERT_EQUAL(port == (int)BRACE_ASKER_MODBUS_TCP,
                          controller_has_hung_up(&app.controller, (brace_who_t){(brace_asker_t)port, 4}));
    }
}

/* Requests that come together are answered one a tick, each with its own token, in their order. */
static void test_one_request_is_answered_in_a_tick(void)
{
    enum { ASKED = 6 };
    int answered = 0;
    for (uint8_t token = 1; token <= ASKED; token++) {
        const uint8_t data[8] = {BRACE_REQUEST_IDENTIFY, token};
        arrives(0x600u + NODE, data, 8);
    }
    for (int i = 0; i < 4 * ASKED && answered < ASKED; i++) {
        brace_can_frame_t frame;
        int begun = 0;
        ticks(1);
        while (brace_fake_frame_take(&fake, &frame)) {
            if (frame.id == 0x580u + NODE && frame.data[0] == BRACE_IDENTIFY_ANSWER_0) {
                begun++;
                TEST_ASSERT_EQUAL(++answered, frame.data[1]);
            }
        }
        TEST_ASSERT_TRUE(begun <= 1);
    }
    TEST_ASSERT_EQUAL(ASKED, answered);
}

/* Questions in every tick leave no room for process data, but for one frame in seventeen ticks. */
static void test_process_data_go_on_while_each_tick_answers(void)
{
    int sent = 0;
    for (int i = 0; i < 400; i++) {
        brace_can_frame_t frame;
        const uint8_t data[8] = {BRACE_REQUEST_IDENTIFY, 1};
        arrives(0x600u + NODE, data, 8);
        ticks(1);
        while (brace_fake_frame_take(&fake, &frame)) {
            sent += frame.id >= 0x180u && frame.id < 0x580u ? 1 : 0;
        }
    }
    TEST_ASSERT_GREATER_OR_EQUAL(400 / 17 - 1, sent);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_K_asked_where_the_limb_is_is_the_K_reported_two_ticks_later);
    RUN_TEST(test_K_at_the_tip_is_K_at_its_posture_both_knees);
    RUN_TEST(test_K_elsewhere_leaves_the_limbs_own_alone);
    RUN_TEST(test_K_where_there_is_none_is_refused);
    RUN_TEST(test_sag_undoes_contact_force);
    RUN_TEST(test_friction_margin_is_of_the_force_of_now);
    RUN_TEST(test_entries_are_read_and_those_that_are_none_refused);
    RUN_TEST(test_identify_reports_version_hashes_node);
    RUN_TEST(test_space_drift_and_take_up_are_reported_or_refused);
    RUN_TEST(test_what_is_no_request_is_counted_and_not_answered);
    RUN_TEST(test_configuration_needs_its_key);
    RUN_TEST(test_a_written_entry_is_in_force_only_after_its_commit);
    RUN_TEST(test_a_memory_that_fails_keeps_the_old_set_and_says_so);
    RUN_TEST(test_a_push_is_in_force_once_answered);
    RUN_TEST(test_a_push_interrupted_at_any_frame_leaves_the_old_set);
    RUN_TEST(test_a_push_with_a_word_missing_twice_or_changed_is_refused);
    RUN_TEST(test_take_up_and_loading_test_over_the_bus);
    RUN_TEST(test_the_next_loading_test_waits_for_the_way_back);
    RUN_TEST(test_stop_is_heard_while_something_moves);
    RUN_TEST(test_a_download_is_of_one_set_in_order);
    RUN_TEST(test_faults_that_stay_are_cleared);
    RUN_TEST(test_two_commits_are_two_answers_whenever_the_second_comes);
    RUN_TEST(test_who_hangs_up);
    RUN_TEST(test_one_request_is_answered_in_a_tick);
    RUN_TEST(test_process_data_go_on_while_each_tick_answers);
    return UNITY_END();
}
