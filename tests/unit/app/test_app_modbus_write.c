/* The controller as a Modbus server: parameters written, staged, committed; commands. Register addresses are those of
 * docs/modbus.md. */
#include <math.h>

#include "brace/words.h"
#include "modbus_master.h"

enum {
    CONFIGURE = 16384,
    COMMIT = 16386,
    ROLLBACK = 16388,
    CLEAR = 16390,
    TAKE_UP = 16392,
    LET_GO = 16394,
    ASKED = 16396,
    END_TEST = 16464
};
enum { TO_CONFIGURATION = 0, TO_MONITOR = 1 };
static const uint32_t mode_word[] = {0xc0de0002u, 0xc0de0001u}, go = 0xc0de0001u;

void setUp(void)
{
    start_unit();
}

void tearDown(void) {}

static void accepted(reply_t reply, uint8_t function)
{
    TEST_ASSERT_EQUAL(5, reply.count);
    TEST_ASSERT_EQUAL_HEX8(function, reply.byte[0]);
}

static void configure(void)
{
    accepted(write_value(CONFIGURE, mode_word[TO_CONFIGURATION]), 16);
    TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, app.controller.mode.now);
}

static void commit(void)
{
    accepted(write_value(COMMIT, go), 16);
    for (int i = 0; i < 50; i++) {
        const reply_t reply = read_asks(3, COMMIT, 2);
        if (value_at(&reply, 0) != 1u) {
            TEST_ASSERT_EQUAL(0, value_at(&reply, 0));
            return;
        }
    }
    TEST_FAIL_MESSAGE("never stored");
}

static void test_parameters_are_written_staged_committed_and_read_back(void)
{
    const uint32_t before = bits(app.controller.parameters.in_force.limb.tibia_mm);
    const uint32_t values[] = {bits(181.5f), bits(204.25f)};
    configure();
    accepted(write_values(2, values, 2), 16);
    reply_t reply = read_asks(3, 2, 4);
    TEST_ASSERT_EQUAL_HEX32(values[0], value_at(&reply, 0));
    TEST_ASSERT_EQUAL_HEX32(values[1], value_at(&reply, 1));
    TEST_ASSERT_EQUAL_HEX32(before, bits(app.controller.parameters.in_force.limb.tibia_mm));
    const uint32_t crc = app.controller.parameters.crc;
    commit();
    ticks(20);
    TEST_ASSERT_EQUAL_HEX32(values[1], bits(app.controller.parameters.in_force.limb.tibia_mm));
    TEST_ASSERT_NOT_EQUAL(crc, app.controller.parameters.crc);
    accepted(write_value(CONFIGURE, mode_word[TO_MONITOR]), 16);
    ticks(20);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, app.controller.mode.now);
    configure();
    accepted(write_value(ROLLBACK, go), 16);
    ticks(400);
    TEST_ASSERT_EQUAL_HEX32(before, bits(app.controller.parameters.in_force.limb.tibia_mm));
    reply = read_asks(3, 4, 2);
    TEST_ASSERT_EQUAL_HEX32(before, value_at(&reply, 0));
}

static void test_nothing_is_written_outside_configuration(void)
{
    const brace_parameters_t before = app.controller.parameters.in_force;
    refused(write_value(2, bits(100.0f)), 16, 1);
    refused(write_one(2, 0x42c8), 6, 1);
    refused(write_value(COMMIT, go), 16, 1);
    refused(write_value(ROLLBACK, go), 16, 1);
    TEST_ASSERT_FALSE(app.controller.parameters.has_staged);
    TEST_ASSERT_EQUAL_MEMORY(&before, &app.controller.parameters.in_force, sizeof before);
}

static void test_what_is_staged_is_forgotten_when_configuration_is_left(void)
{
    const uint32_t before = bits(app.controller.parameters.in_force.limb.femur_mm);
    configure();
    accepted(write_value(2, bits(100.0f)), 16);
    accepted(write_value(CONFIGURE, mode_word[TO_MONITOR]), 16);
    ticks(20);
    configure();
    const reply_t reply = read_asks(3, 2, 2);
    TEST_ASSERT_EQUAL_HEX32(before, value_at(&reply, 0));
}

/* The bits of the parameter with this number on the wires. */
static uint32_t in_force(uint32_t number)
{
    return brace_word_at(&app.controller.parameters.in_force, brace_parameter_index(number));
}

static void test_a_block_is_written_whole_or_not_at_all(void)
{
    uint32_t values[60];
    configure();
    for (uint32_t i = 0; i < 60u; i++) {
        values[i] = in_force(i);
    }
    values[0] = bits(33.0f);
    values[59] = bits(__builtin_nanf(""));
    refused(write_values(0, values, 60), 16, 3);
    reply_t reply = read_asks(3, 0, 2);
    TEST_ASSERT_EQUAL_HEX32(bits(app.controller.parameters.in_force.limb.coxa_mm), value_at(&reply, 0));
    values[59] = in_force(59);
    accepted(write_values(0, values, 60), 16);
    reply = read_asks(3, 0, 2);
    TEST_ASSERT_EQUAL_HEX32(bits(33.0f), value_at(&reply, 0));
}

static void test_values_out_of_their_range_are_refused(void)
{
    configure();
    refused(write_value(2, bits(-1.0f)), 16, 3);
    refused(write_value(2, bits(INFINITY)), 16, 3);
    refused(write_value(2 * brace_parameter_number(BRACE_PARAMETER_CONTROLLER_MODBUS_ADDRESS), 248), 16, 3);
    refused(write_value(2 * brace_parameter_number(BRACE_PARAMETER_CONTROLLER_CAN_BIT_RATE), 300000), 16, 3);
    /* what members say together is the commit's */
    accepted(write_value(2 * brace_parameter_number(BRACE_PARAMETER_CONTROLLER_AGE_LIMIT_US), 1000), 16);
    accepted(write_value(2 * brace_parameter_number(BRACE_PARAMETER_CONTROLLER_TICK_US), 5000), 16);
    refused(write_value(COMMIT, go), 16, 3);
    const reply_t reply = read_asks(3, COMMIT, 2);
    TEST_ASSERT_EQUAL(0, value_at(&reply, 0));
    TEST_ASSERT_EQUAL(1000, app.controller.parameters.in_force.controller.tick_us);
}

static void test_writes_have_their_limits(void)
{
    configure();
    uint32_t values[61];
    for (uint32_t i = 0; i < 61u; i++) {
        values[i] = in_force(i);
    }
    const uint8_t too_many[] = {16, 0, 0, 0, 124, 248, 0, 0};
    accepted(write_values(0, values, 61), 16); /* 122 registers; 123 is odd */
    refused(line_asks(UNIT, too_many, sizeof too_many), 16, 3);
    refused(write_values(1, values, 1), 16, 2);
    refused(write_values(2 * BRACE_PARAMETER_NUMBERS - 2, values, 2), 16, 2);
    refused(write_values(2 * BRACE_PARAMETER_NUMBERS, values, 1), 16, 2);
    refused(write_value(BRACE_REGISTER_COMMANDS + 2 * BRACE_COMMANDS_COUNT, 0), 16, 2);
    const uint8_t none[] = {16, 0, 0, 0, 0, 0}, one[] = {16, 0, 0, 0, 1, 2, 0, 0},
                  miscounted[] = {16, 0, 0, 0, 2, 2, 0, 0};
    const uint8_t missing[] = {16, 0, 0, 0, 2, 4, 0, 0, 0}, more[] = {16, 0, 0, 0, 2, 4, 0, 0, 0, 0, 0};
    refused(line_asks(UNIT, none, sizeof none), 16, 3);
    refused(line_asks(UNIT, one, sizeof one), 16, 3);
    refused(line_asks(UNIT, miscounted, sizeof miscounted), 16, 3);
    refused(line_asks(UNIT, missing, sizeof missing), 16, 3);
    refused(line_asks(UNIT, more, sizeof more), 16, 3);
    refused(write_one(2 * BRACE_PARAMETER_NUMBERS, 0), 6, 2);
    const parameter_job_t *job = &app.controller.parameters;
    TEST_ASSERT_EQUAL_MEMORY(&job->in_force, &job->staged, sizeof job->in_force);
}

static void test_function_6_writes_a_value_in_two_halves_in_order(void)
{
    configure();
    const uint32_t value = bits(123.456f);
    refused(write_one(3, value & 0xffffu), 6, 3);
    accepted(write_one(2, value >> 16), 6);
    TEST_ASSERT_FALSE(app.controller.parameters.has_staged);
    accepted(write_one(3, value & 0xffffu), 6);
    reply_t reply = read_asks(3, 2, 2);
    TEST_ASSERT_EQUAL_HEX32(value, value_at(&reply, 0));
    refused(write_one(3, 0), 6, 3); /* the first half has been used */
    accepted(write_one(4, 0x4300), 6);
    (void)read_asks(3, 0, 2);
    refused(write_one(5, 0), 6, 3); /* something came between */
    accepted(write_one(4, 0x4300), 6);
    refused(write_one(7, 0), 6, 3); /* another value's */
    accepted(write_one(CONFIGURE, 0xc0de), 6);
    accepted(write_one(CONFIGURE + 1, 1), 6);
    TEST_ASSERT_NOT_EQUAL(BRACE_MODE_CONFIGURATION, app.controller.mode.now);
}

static void test_while_a_set_is_stored_the_answer_is_busy(void)
{
    configure();
    accepted(write_value(2, bits(150.0f)), 16);
    accepted(write_value(COMMIT, go), 16);
    TEST_ASSERT_TRUE(parameter_job_is_busy(&app.controller.parameters));
    refused(write_value(2, bits(151.0f)), 16, 6);
    refused(write_value(COMMIT, go), 16, 6);
    refused(write_value(CONFIGURE, mode_word[TO_MONITOR]), 16, 6);
    const reply_t reply = read_asks(3, COMMIT, 4);
    TEST_ASSERT_EQUAL(1, value_at(&reply, 0));
    TEST_ASSERT_EQUAL(1, value_at(&reply, 1));
    ticks(1000);
    TEST_ASSERT_EQUAL_FLOAT(150.0f, app.controller.parameters.in_force.limb.femur_mm);
}

static void test_a_store_that_fails_says_so_where_it_was_asked(void)
{
    configure();
    fake.nvm_forgets = true;
    accepted(write_value(2, bits(150.0f)), 16);
    accepted(write_value(COMMIT, go), 16);
    ticks(1000);
    const reply_t reply = read_asks(3, COMMIT, 2);
    TEST_ASSERT_GREATER_THAN(249, value_at(&reply, 0));
    TEST_ASSERT_LESS_THAN(256, value_at(&reply, 0));
    TEST_ASSERT_NOT_EQUAL(150.0f, app.controller.parameters.in_force.limb.femur_mm);
}

/* An order to end a loading test ends none where none can run, and stores nothing. */
static void test_an_order_to_end_a_test_is_nothing_else(void)
{
    refused(write_value(END_TEST, 0), 16, 1);
    refused(write_value(END_TEST, 1), 16, 1);
    configure();
    refused(write_value(END_TEST, 1), 16, 1);
    TEST_ASSERT_FALSE(brace_app_is_storing(&app));
}

static void test_k_at_a_posture(void)
{
    const uint32_t posture[] = {bits(0.7f), bits(1.1f)};
    accepted(write_values(ASKED, posture, 2), 16);
    const reply_t reply = read_asks(4, 4096, 14);
    fake.joint[BRACE_FEMUR].sample.motor_rad = 0.7f;
    fake.joint[BRACE_TIBIA].sample.motor_rad = 1.1f;
    bench_believe();
    ticks(5);
    const brace_stiffness_t *k = &now()->stiffness.engaged;
    TEST_ASSERT_EQUAL_FLOAT(k->k_xx_n_per_mm, float_at(&reply, 0));
    TEST_ASSERT_EQUAL_FLOAT(k->k_xz_n_per_mm, float_at(&reply, 1));
    TEST_ASSERT_EQUAL_FLOAT(k->k_zz_n_per_mm, float_at(&reply, 2));
    TEST_ASSERT_EQUAL_FLOAT(k->lambda_min_n_per_mm, float_at(&reply, 3));
    TEST_ASSERT_EQUAL_FLOAT(k->lambda_max_n_per_mm, float_at(&reply, 4));
    TEST_ASSERT_EQUAL_FLOAT(k->stiff_axis_rad, float_at(&reply, 5));
    TEST_ASSERT_EQUAL(0, value_at(&reply, 6));
    const reply_t asked = read_asks(3, ASKED, 4);
    TEST_ASSERT_EQUAL_HEX32(posture[0], value_at(&asked, 0));
    TEST_ASSERT_EQUAL_HEX32(posture[1], value_at(&asked, 1));
}

/* Answers, as floats; 4096 is the first. */
static float answer_at(uint32_t index)
{
    const reply_t reply = read_asks(4, 4096 + 2 * index, 2);
    return float_at(&reply, 0);
}

static void test_k_at_a_tip_is_k_at_its_posture(void)
{
    const uint32_t posture[] = {bits(0.7f), bits(1.1f)};
    accepted(write_values(ASKED, posture, 2), 16);
    const reply_t there = read_asks(4, 4096, 14);
    brace_pose_t pose;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_kinematics_forward(&app.controller.parameters.in_force.limb, 0.7f, 1.1f, &pose));
    uint32_t tip[] = {bits(pose.tip.x_mm), bits(pose.tip.z_mm), 0};
    accepted(write_values(ASKED + 4, tip, 3), 16);
    const reply_t same = read_asks(4, 4096, 14);
    for (uint32_t i = 0; i < 6u; i++) {
        TEST_ASSERT_FLOAT_WITHIN(1e-3f, float_at(&there, i), float_at(&same, i));
    }
    tip[2] = 1; /* knee down: another posture, another K */
    accepted(write_values(ASKED + 4, tip, 3), 16);
    TEST_ASSERT_TRUE(__builtin_fabsf(answer_at(0) - float_at(&there, 0)) > 1e-3f);
    const reply_t asked = read_asks(3, ASKED + 4, 6);
    TEST_ASSERT_EQUAL_HEX32(tip[0], value_at(&asked, 0));
    TEST_ASSERT_EQUAL_HEX32(1, value_at(&asked, 2));
    reply_t of_both = read_asks(3, ASKED, 10); /* whose answer it is: the tip's, and no posture's any more */
    TEST_ASSERT_TRUE(isnan(float_at(&of_both, 0)) && isnan(float_at(&of_both, 1)));
    accepted(write_values(ASKED, posture, 2), 16);
    of_both = read_asks(3, ASKED, 10);
    TEST_ASSERT_EQUAL_HEX32(posture[1], value_at(&of_both, 1));
    TEST_ASSERT_TRUE(isnan(float_at(&of_both, 2)) && isnan(float_at(&of_both, 3)));
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX, value_at(&of_both, 4));
    tip[2] = 2;
    refused(write_values(ASKED + 4, tip, 3), 16, 3);
    const uint32_t far[] = {bits(5000.0f), bits(0.0f), 0};
    refused(write_values(ASKED + 4, far, 3), 16, 3);
    refused(write_values(ASKED + 4, tip, 2), 16, 3); /* knee is part of it */
    refused(write_values(ASKED + 2, posture, 2), 16, 3); /* parts of two questions */
}

static void test_what_the_k_of_now_means_at_the_contact(void)
{
    TEST_ASSERT_TRUE(isnan(answer_at(7)) && isnan(answer_at(11)) && isnan(answer_at(13)));
    const brace_stiffness_t *k = &now()->stiffness.now;
    const uint32_t displacement[] = {bits(0.25f), bits(-0.5f)};
    accepted(write_values(ASKED + 10, displacement, 2), 16);
    const float fx = answer_at(7), fz = answer_at(8);
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, k->k_xx_n_per_mm * 0.25f - k->k_xz_n_per_mm * 0.5f, fx);
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, k->k_xz_n_per_mm * 0.25f - k->k_zz_n_per_mm * 0.5f, fz);
    const float size = sqrtf(0.25f * 0.25f + 0.5f * 0.5f);
    TEST_ASSERT_FLOAT_WITHIN(1e-4f, k->lambda_min_n_per_mm * size, answer_at(9));
    TEST_ASSERT_FLOAT_WITHIN(1e-4f, k->lambda_max_n_per_mm * size, answer_at(10));
    const uint32_t load[] = {bits(fx), bits(fz)}; /* the sag under it is that displacement */
    accepted(write_values(ASKED + 14, load, 2), 16);
    TEST_ASSERT_FLOAT_WITHIN(1e-4f, 0.25f, answer_at(11));
    TEST_ASSERT_FLOAT_WITHIN(1e-4f, -0.5f, answer_at(12));
    const uint32_t surface[] = {bits(1.5707963f), bits(0.5f)};
    const float force_x = now()->force_x_n, force_z = now()->force_z_n;
    accepted(write_values(ASKED + 18, surface, 2), 16);
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, 0.5f * force_z - __builtin_fabsf(force_x), answer_at(13));
    const uint32_t broken[] = {bits(__builtin_nanf("")), bits(1.0f)};
    refused(write_values(ASKED + 10, broken, 2), 16, 3);
    refused(write_values(ASKED + 14, broken, 2), 16, 3);
    refused(write_values(ASKED + 18, broken, 2), 16, 3);
    refused(write_value(ASKED + 10, 0), 16, 3);
}

static void test_without_a_k_there_is_no_answer_from_it(void)
{
    fake.joint[BRACE_TIBIA].absent = true;
    ticks(200);
    TEST_ASSERT_FALSE(now()->k_is_valid);
    const uint32_t two[] = {bits(0.25f), bits(0.5f)};
    refused(write_values(ASKED + 10, two, 2), 16, 4);
    refused(write_values(ASKED + 14, two, 2), 16, 4);
    TEST_ASSERT_TRUE(isnan(answer_at(7)) && isnan(answer_at(11)));
    fake.joint[BRACE_TIBIA].absent = false;
}

static void test_a_posture_needs_both_angles_and_they_must_be_angles(void)
{
    const uint32_t not [] = {bits(__builtin_nanf("")), bits(1.0f)}, far[] = {bits(1.0f), bits(1e6f)};
    refused(write_value(ASKED, bits(1.0f)), 16, 3);
    refused(write_value(ASKED + 2, bits(1.0f)), 16, 3);
    refused(write_values(ASKED, not, 2), 16, 3);
    refused(write_values(ASKED, far, 2), 16, 3);
    const reply_t reply = read_asks(4, 4096, 2);
    TEST_ASSERT_EQUAL_HEX32(0x7fc00000u, value_at(&reply, 0));
    const uint32_t outside[] = {bits(-2.5f), bits(1.0f)};
    accepted(write_values(ASKED, outside, 2), 16);
    const reply_t flagged = read_asks(4, 4108, 2);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FLAG_OUT_OF_RANGE, value_at(&flagged, 0));
}

static void test_commands_need_their_key_and_their_mode(void)
{
    refused(write_value(CONFIGURE, 2), 16, 3);
    refused(write_value(CONFIGURE, 0xc0de0003u), 16, 3);
    accepted(write_value(CONFIGURE, mode_word[TO_MONITOR]), 16);
    configure();
    accepted(write_value(CONFIGURE, mode_word[TO_CONFIGURATION]), 16);
    refused(write_value(COMMIT, 1), 16, 3);
    refused(write_value(LET_GO, 1), 16, 1);
    refused(write_value(TAKE_UP, 257), 16, 1);
    refused(write_value(CLEAR, 1), 16, 3);
    accepted(write_value(CLEAR, BRACE_FAULT_MODEL_DRIFT), 16);
    accepted(write_value(CONFIGURE, mode_word[TO_MONITOR]), 16);
    ticks(20);
    refused(write_value(TAKE_UP, 257), 16, 4); /* this limb has no play */
    reply_t reply = read_asks(3, TAKE_UP, 2);
    TEST_ASSERT_EQUAL_HEX32(0, value_at(&reply, 0)); /* refused, so not what reads back */
    refused(write_value(TAKE_UP, 1), 16, 3);
    refused(write_value(TAKE_UP, 256 + 512 + 1), 16, 3);
    refused(write_value(TAKE_UP, 256), 16, 4); /* it has no coxa joint */
    refused(write_value(TAKE_UP, 256 + 3), 16, 3);
    const uint32_t two[] = {mode_word[TO_CONFIGURATION], go};
    refused(write_values(CONFIGURE, two, 2), 16, 3);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, app.controller.mode.now);
}

/* Function 06 writes a value in two requests; what somebody else does on the other port meanwhile is no part of it. */
/* And whoever has entered CONFIGURATION writes alone. */
static void test_halves_of_two_masters_do_not_meet(void)
{
    const uint32_t ours = bits(181.5f), theirs = bits(204.25f);
    const uint8_t high[] = {6, 0, 2, (uint8_t)(theirs >> 24), (uint8_t)(theirs >> 16)};
    const uint8_t low[] = {6, 0, 3, (uint8_t)(theirs >> 8), (uint8_t)theirs}, asks[] = {4, 0, 0, 0, 2};
    configure();
    accepted(write_one(2, ours >> 16), 6);
    TEST_ASSERT_GREATER_THAN(2, tcp_asks(UNIT, asks, sizeof asks).count); /* a question is no end of it */
    accepted(tcp_asks(UNIT, high, sizeof high), 6);
    accepted(write_one(3, ours & 0xffffu), 6);
    reply_t reply = read_asks(3, 2, 2);
    TEST_ASSERT_EQUAL_HEX32(ours, value_at(&reply, 0));
    refused(tcp_asks(UNIT, low, sizeof low), 6, 7);
    reply = read_asks(3, 2, 2);
    TEST_ASSERT_EQUAL_HEX32(ours, value_at(&reply, 0));
}

/* Two connections whose halves are kept in one place: what the one has begun, the other does not end. */
static void test_halves_of_two_connections_do_not_meet(void)
{
    const uint8_t high[] = {6, 0, 2, 0x43, 0x35}, low[] = {6, 0, 3, 0x80, 0};
    brace_fake_with_peers(&fake);
    configure();
    fake.peer = 11;
    accepted(tcp_asks(UNIT, high, sizeof high), 6);
    fake.peer = 3;
    refused(tcp_asks(UNIT, low, sizeof low), 6, 3);
    accepted(tcp_asks(UNIT, high, sizeof high), 6);
    refused(tcp_asks(UNIT, low, sizeof low), 6, 7); /* whole, but another writes */
}

/* A set beyond what the board allows is a wrong value to a Modbus master, and is not stored. */
static void test_the_board_s_ceilings_hold_over_modbus(void)
{
    static const brace_hal_ceiling_t ceiling[3] = {
        {12000.0f, -2.5f, 3.2f, 0.2f}, {12000.0f, -2.5f, 3.2f, 0.2f}, {12000.0f, -2.5f, 3.2f, 0.2f}};
    fake.hal.ceiling = ceiling;
    enum { FEMUR_ANGLE_MAX = 122 };
    const uint32_t before = app.controller.parameters.crc;
    configure();
    accepted(write_value(FEMUR_ANGLE_MAX, bits(3.3f)), 16);
    refused(write_value(COMMIT, go), 16, 3);
    ticks(200);
    TEST_ASSERT_EQUAL_HEX32(before, app.controller.parameters.crc);
    accepted(write_value(FEMUR_ANGLE_MAX, bits(3.1f)), 16);
    commit();
    TEST_ASSERT_NOT_EQUAL(before, app.controller.parameters.crc);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_parameters_are_written_staged_committed_and_read_back);
    RUN_TEST(test_the_board_s_ceilings_hold_over_modbus);
    RUN_TEST(test_nothing_is_written_outside_configuration);
    RUN_TEST(test_what_is_staged_is_forgotten_when_configuration_is_left);
    RUN_TEST(test_a_block_is_written_whole_or_not_at_all);
    RUN_TEST(test_values_out_of_their_range_are_refused);
    RUN_TEST(test_writes_have_their_limits);
    RUN_TEST(test_function_6_writes_a_value_in_two_halves_in_order);
    RUN_TEST(test_while_a_set_is_stored_the_answer_is_busy);
    RUN_TEST(test_a_store_that_fails_says_so_where_it_was_asked);
    RUN_TEST(test_an_order_to_end_a_test_is_nothing_else);
    RUN_TEST(test_k_at_a_posture);
    RUN_TEST(test_a_posture_needs_both_angles_and_they_must_be_angles);
    RUN_TEST(test_k_at_a_tip_is_k_at_its_posture);
    RUN_TEST(test_what_the_k_of_now_means_at_the_contact);
    RUN_TEST(test_without_a_k_there_is_no_answer_from_it);
    RUN_TEST(test_commands_need_their_key_and_their_mode);
    RUN_TEST(test_halves_of_two_masters_do_not_meet);
    RUN_TEST(test_halves_of_two_connections_do_not_meet);
    return UNITY_END();
}
