/* The controller as a Modbus server: every function, every exception, its limits; frames that are broken, halved, too long,
 * for others; floods; writing parameters. Register addresses are those of docs/modbus.md. */
#include <math.h>

#include "modbus_master.h"

enum { CONFIGURE = 16384, COMMIT = 16386, ROLLBACK = 16388, CLEAR = 16390, TAKE_UP = 16392, LET_GO = 16394, ASKED = 16396 };
enum { TO_CONFIGURATION = 0, TO_MONITOR = 1 };
static const uint32_t mode_word[] = {0xc0de0002u, 0xc0de0001u}, go = 0xc0de0001u;

void setUp(void)
{
    brace_parameters_t p = bench_parameters();
    p.controller.modbus_address = UNIT;
    bench_start(&p);
    ticks(20);
}

void tearDown(void) {}

static uint32_t bits(float value)
{
    uint32_t word;
    memcpy(&word, &value, 4);
    return word;
}

static uint32_t broken(void)
{
    return brace_app_counters(&app)->modbus_broken;
}

static void accepted(reply_t reply, uint8_t function)
{
    TEST_ASSERT_EQUAL(5, reply.count);
    TEST_ASSERT_EQUAL_HEX8(function, reply.byte[0]);
}

static void configure(void)
{
    accepted(write_value(CONFIGURE, mode_word[TO_CONFIGURATION]), 16);
    TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, app.mode);
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

/* ------------------------------------------------------------------------------------------- reading -- */

static void test_the_line_is_set_up_as_the_standard_wants_it(void)
{
    TEST_ASSERT_EQUAL(115200, fake.baud[BRACE_SERIAL_MODBUS]);
    TEST_ASSERT_EQUAL(BRACE_PARITY_EVEN, fake.parity[BRACE_SERIAL_MODBUS]);
}

static void test_probes_tell_the_word_order(void)
{
    const reply_t reply = read_asks(4, 0, 4);
    const uint8_t expected[] = {4, 8, 0x46, 0x40, 0xe6, 0x00, 0x01, 0x02, 0x03, 0x04};
    TEST_ASSERT_EQUAL(sizeof expected, reply.count);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, reply.byte, sizeof expected);
}

static void test_k_is_the_snapshots(void)
{
    const reply_t reply = read_asks(4, 0, 116);
    TEST_ASSERT_EQUAL(2 + 232, reply.count);
    TEST_ASSERT_EQUAL(232, reply.byte[1]);
    TEST_ASSERT_EQUAL_HEX32(BRACE_DICTIONARY_HASH, value_at(&reply, 2));
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, value_at(&reply, 6));
    TEST_ASSERT_EQUAL(1, value_at(&reply, 8));
    TEST_ASSERT_EQUAL_FLOAT(now()->stiffness.now.k_xx_n_per_mm, float_at(&reply, 10));
    TEST_ASSERT_EQUAL_FLOAT(now()->stiffness.now.k_xz_n_per_mm, float_at(&reply, 11));
    TEST_ASSERT_EQUAL_FLOAT(now()->stiffness.now.k_zz_n_per_mm, float_at(&reply, 12));
    TEST_ASSERT_EQUAL_FLOAT(1.0f, float_at(&reply, 21));
    TEST_ASSERT_EQUAL_FLOAT(1.4f, float_at(&reply, 22));
    TEST_ASSERT_EQUAL(0, value_at(&reply, 57));
}

static void test_what_is_not_known_is_nan_and_all_ones_never_zero(void)
{
    reply_t reply = read_asks(4, 4096, 14);
    for (uint32_t i = 0; i < 6u; i++) {
        TEST_ASSERT_EQUAL_HEX32(0x7fc00000u, value_at(&reply, i));
    }
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX, value_at(&reply, 6));
    fake.joint[BRACE_TIBIA].not_newer = true;
    ticks(100);
    reply = read_asks(4, 16, 8);
    TEST_ASSERT_EQUAL(0, value_at(&reply, 0));
    for (uint32_t i = 2; i < 4u; i++) {
        TEST_ASSERT_EQUAL_HEX32(0x7fc00000u, value_at(&reply, i));
    }
}

/* K, its eigenvalues and the angle must be of one tick, whatever part of the block and whenever the answer leaves. */
static void test_a_block_is_one_snapshot(void)
{
    for (int i = 0; i < 300; i++) {
        fake.joint[BRACE_FEMUR].sample.motor_rad = 0.6f + 0.002f * (float)i;
        const uint8_t pdu[] = {4, 0, 8, 0, 108};
        uint8_t frame[8] = {UNIT};
        memcpy(frame + 1, pdu, sizeof pdu);
        const uint32_t crc = crc_by_bits(frame, 6);
        frame[6] = (uint8_t)crc;
        frame[7] = (uint8_t)(crc >> 8);
        line_says(frame, sizeof frame);
        reply_t reply = {.count = 0};
        for (int tick = 0; tick < 60; tick++) {
            fake.joint[BRACE_FEMUR].sample.motor_rad += 1e-4f;
            ticks(1);
            reply.count += brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS, reply.byte + reply.count, 260u - reply.count);
        }
        TEST_ASSERT_EQUAL(3 + 216 + 2, reply.count);
        TEST_ASSERT_EQUAL_HEX16(0, crc_by_bits(reply.byte, reply.count));
        memmove(reply.byte, reply.byte + 1, reply.count - 1u);
        const float k_xx = float_at(&reply, 6), k_zz = float_at(&reply, 8);
        const float low = float_at(&reply, 9), high = float_at(&reply, 10);
        TEST_ASSERT_FLOAT_WITHIN(1e-5f * (k_xx + k_zz), k_xx + k_zz, low + high);
        TEST_ASSERT_EQUAL_FLOAT(float_at(&reply, 17), float_at(&reply, 29)); /* no play: theta1 is the motor's angle */
    }
}

static void test_every_part_of_a_block_is_the_same_block(void)
{
    reply_t whole = read_asks(3, 0, 125);
    TEST_ASSERT_EQUAL(252, whole.count);
    for (uint32_t start = 0; start < 8u; start++) {
        for (uint32_t count = 1; count < 30u; count += 3) {
            const reply_t part = read_asks(3, start, count);
            TEST_ASSERT_EQUAL(2u + 2u * count, part.count);
            TEST_ASSERT_EQUAL_HEX8_ARRAY(whole.byte + 2 + 2u * start, part.byte + 2, 2u * count);
        }
    }
    TEST_ASSERT_EQUAL_HEX32(bits(app.parameters.limb.coxa_mm), value_at(&whole, 0));
    const reply_t last = read_asks(3, 2 * (BRACE_PARAMETER_COUNT - 2), 4);
    TEST_ASSERT_EQUAL(UNIT, value_at(&last, 0));
    TEST_ASSERT_EQUAL(115200, value_at(&last, 1));
}

static void test_reads_have_their_limits(void)
{
    TEST_ASSERT_EQUAL(232 + 2, read_asks(4, 0, 116).count);
    refused(read_asks(4, 0, 117), 4, 2);
    refused(read_asks(4, 116, 1), 4, 2);
    refused(read_asks(4, 115, 2), 4, 2);
    TEST_ASSERT_EQUAL(4, read_asks(4, 115, 1).count);
    refused(read_asks(4, 0, 0), 4, 3);
    refused(read_asks(4, 0, 126), 4, 3);
    refused(read_asks(4, 0, 0xffff), 4, 3);
    refused(read_asks(4, 0xffff, 2), 4, 2);
    refused(read_asks(4, 4095, 2), 4, 2);
    TEST_ASSERT_EQUAL(30, read_asks(4, 4096, 14).count);
    refused(read_asks(4, 4096, 15), 4, 2);
    TEST_ASSERT_EQUAL(34, read_asks(3, 16384, 16).count);
    refused(read_asks(3, 16384, 17), 3, 2);
    refused(read_asks(3, 16383, 2), 3, 2);
    TEST_ASSERT_EQUAL(4, read_asks(3, 2 * BRACE_PARAMETER_COUNT - 1, 1).count);
    refused(read_asks(3, 2 * BRACE_PARAMETER_COUNT - 1, 2), 3, 2);
    const uint8_t too_long[] = {4, 0, 0, 0, 2, 0}, too_short[] = {4, 0, 0, 0};
    refused(line_asks(UNIT, too_long, sizeof too_long), 4, 3);
    refused(line_asks(UNIT, too_short, sizeof too_short), 4, 3);
    TEST_ASSERT_EQUAL(14, brace_app_counters(&app)->modbus_refused);
}

/* -------------------------------------------------------------------------------------------- writing -- */

static void test_parameters_are_written_staged_committed_and_read_back(void)
{
    const uint32_t before = bits(app.parameters.limb.tibia_mm);
    const uint32_t values[] = {bits(181.5f), bits(204.25f)};
    configure();
    accepted(write_values(2, values, 2), 16);
    reply_t reply = read_asks(3, 2, 4);
    TEST_ASSERT_EQUAL_HEX32(values[0], value_at(&reply, 0));
    TEST_ASSERT_EQUAL_HEX32(values[1], value_at(&reply, 1));
    TEST_ASSERT_EQUAL_HEX32(before, bits(app.parameters.limb.tibia_mm));
    const uint32_t crc = app.parameter_crc;
    commit();
    ticks(20);
    TEST_ASSERT_EQUAL_HEX32(values[1], bits(app.parameters.limb.tibia_mm));
    TEST_ASSERT_NOT_EQUAL(crc, app.parameter_crc);
    accepted(write_value(CONFIGURE, mode_word[TO_MONITOR]), 16);
    ticks(20);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, app.mode);
    configure();
    accepted(write_value(ROLLBACK, go), 16);
    ticks(400);
    TEST_ASSERT_EQUAL_HEX32(before, bits(app.parameters.limb.tibia_mm));
    reply = read_asks(3, 4, 2);
    TEST_ASSERT_EQUAL_HEX32(before, value_at(&reply, 0));
}

static void test_nothing_is_written_outside_configuration(void)
{
    const brace_parameters_t before = app.parameters;
    refused(write_value(2, bits(100.0f)), 16, 1);
    refused(write_one(2, 0x42c8), 6, 1);
    refused(write_value(COMMIT, go), 16, 1);
    refused(write_value(ROLLBACK, go), 16, 1);
    TEST_ASSERT_FALSE(app.staging.begun);
    TEST_ASSERT_EQUAL_MEMORY(&before, &app.parameters, sizeof before);
}

static void test_what_is_staged_is_forgotten_when_configuration_is_left(void)
{
    const uint32_t before = bits(app.parameters.limb.femur_mm);
    configure();
    accepted(write_value(2, bits(100.0f)), 16);
    accepted(write_value(CONFIGURE, mode_word[TO_MONITOR]), 16);
    ticks(20);
    configure();
    const reply_t reply = read_asks(3, 2, 2);
    TEST_ASSERT_EQUAL_HEX32(before, value_at(&reply, 0));
}

static void test_a_block_is_written_whole_or_not_at_all(void)
{
    uint32_t values[60];
    configure();
    for (uint32_t i = 0; i < 60u; i++) {
        memcpy(&values[i], (const uint8_t *)&app.parameters + 4u * i, 4);
    }
    values[0] = bits(33.0f);
    values[59] = bits(__builtin_nanf(""));
    refused(write_values(0, values, 60), 16, 3);
    reply_t reply = read_asks(3, 0, 2);
    TEST_ASSERT_EQUAL_HEX32(bits(app.parameters.limb.coxa_mm), value_at(&reply, 0));
    memcpy(&values[59], (const uint8_t *)&app.parameters + 4u * 59u, 4);
    accepted(write_values(0, values, 60), 16);
    reply = read_asks(3, 0, 2);
    TEST_ASSERT_EQUAL_HEX32(bits(33.0f), value_at(&reply, 0));
}

static void test_values_out_of_their_range_are_refused(void)
{
    configure();
    refused(write_value(2, bits(-1.0f)), 16, 3);
    refused(write_value(2, bits(INFINITY)), 16, 3);
    refused(write_value(2 * BRACE_PARAMETER_CONTROLLER_MODBUS_ADDRESS, 248), 16, 3);
    refused(write_value(2 * BRACE_PARAMETER_CONTROLLER_CAN_BIT_RATE, 300000), 16, 3);
    /* what members say together is the commit's */
    accepted(write_value(2 * BRACE_PARAMETER_CONTROLLER_AGE_LIMIT_US, 1000), 16);
    accepted(write_value(2 * BRACE_PARAMETER_CONTROLLER_TICK_US, 5000), 16);
    refused(write_value(COMMIT, go), 16, 3);
    const reply_t reply = read_asks(3, COMMIT, 2);
    TEST_ASSERT_EQUAL(0, value_at(&reply, 0));
    TEST_ASSERT_EQUAL(1000, app.parameters.controller.tick_us);
}

static void test_writes_have_their_limits(void)
{
    configure();
    uint32_t values[61];
    for (uint32_t i = 0; i < 61u; i++) {
        memcpy(&values[i], (const uint8_t *)&app.parameters + 4u * i, 4);
    }
    const uint8_t too_many[] = {16, 0, 0, 0, 124, 248, 0, 0};
    accepted(write_values(0, values, 61), 16); /* 122 registers; 123 is odd */
    refused(line_asks(UNIT, too_many, sizeof too_many), 16, 3);
    refused(write_values(1, values, 1), 16, 2);
    refused(write_values(2 * BRACE_PARAMETER_COUNT - 2, values, 2), 16, 2);
    refused(write_values(2 * BRACE_PARAMETER_COUNT, values, 1), 16, 2);
    refused(write_value(16400, 0), 16, 2);
    const uint8_t none[] = {16, 0, 0, 0, 0, 0}, one[] = {16, 0, 0, 0, 1, 2, 0, 0}, miscounted[] = {16, 0, 0, 0, 2, 2, 0, 0};
    const uint8_t missing[] = {16, 0, 0, 0, 2, 4, 0, 0, 0}, more[] = {16, 0, 0, 0, 2, 4, 0, 0, 0, 0, 0};
    refused(line_asks(UNIT, none, sizeof none), 16, 3);
    refused(line_asks(UNIT, one, sizeof one), 16, 3);
    refused(line_asks(UNIT, miscounted, sizeof miscounted), 16, 3);
    refused(line_asks(UNIT, missing, sizeof missing), 16, 3);
    refused(line_asks(UNIT, more, sizeof more), 16, 3);
    refused(write_one(2 * BRACE_PARAMETER_COUNT, 0), 6, 2);
    TEST_ASSERT_EQUAL_MEMORY(&app.parameters, &app.staging.set, sizeof app.parameters);
}

static void test_function_6_writes_a_value_in_two_halves_in_order(void)
{
    configure();
    const uint32_t value = bits(123.456f);
    refused(write_one(3, value & 0xffffu), 6, 3);
    accepted(write_one(2, value >> 16), 6);
    TEST_ASSERT_FALSE(app.staging.begun);
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
    TEST_ASSERT_NOT_EQUAL(BRACE_MODE_CONFIGURATION, app.mode);
}

static void test_while_a_set_is_stored_the_answer_is_busy(void)
{
    configure();
    accepted(write_value(2, bits(150.0f)), 16);
    accepted(write_value(COMMIT, go), 16);
    TEST_ASSERT_TRUE(app.storing);
    refused(write_value(2, bits(151.0f)), 16, 6);
    refused(write_value(COMMIT, go), 16, 6);
    refused(write_value(CONFIGURE, mode_word[TO_MONITOR]), 16, 6);
    const reply_t reply = read_asks(3, COMMIT, 4);
    TEST_ASSERT_EQUAL(1, value_at(&reply, 0));
    TEST_ASSERT_EQUAL(1, value_at(&reply, 1));
    ticks(1000);
    TEST_ASSERT_EQUAL_FLOAT(150.0f, app.parameters.limb.femur_mm);
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
    TEST_ASSERT_NOT_EQUAL(150.0f, app.parameters.limb.femur_mm);
}

/* ------------------------------------------------------------------------------------------- commands -- */

static void test_k_at_a_posture(void)
{
    const uint32_t posture[] = {bits(0.7f), bits(1.1f)};
    accepted(write_values(ASKED, posture, 2), 16);
    const reply_t reply = read_asks(4, 4096, 14);
    fake.joint[BRACE_FEMUR].sample.motor_rad = 0.7f;
    fake.joint[BRACE_TIBIA].sample.motor_rad = 1.1f;
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

static void test_a_posture_needs_both_angles_and_they_must_be_angles(void)
{
    const uint32_t not[] = {bits(__builtin_nanf("")), bits(1.0f)}, far[] = {bits(1.0f), bits(1e6f)};
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
    refused(write_value(TAKE_UP, 1), 16, 3);
    refused(write_value(TAKE_UP, 256 + 512 + 1), 16, 3);
    refused(write_value(TAKE_UP, 256), 16, 3);
    const uint32_t two[] = {mode_word[TO_CONFIGURATION], go};
    refused(write_values(CONFIGURE, two, 2), 16, 3);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, app.mode);
}

/* ------------------------------------------------------------------------------- who is it, how is it -- */

static void test_who_answers(void)
{
    const uint8_t ask[] = {17}, more[] = {17, 0};
    const reply_t reply = line_asks(UNIT, ask, 1);
    char expected[64];
    static const char hex[] = "0123456789abcdef";
    memcpy(expected, "Brace 0.1.0 dictionary ", 23);
    for (int i = 0; i < 8; i++) {
        expected[23 + i] = hex[BRACE_DICTIONARY_HASH >> (28 - 4 * i) & 15u];
    }
    TEST_ASSERT_EQUAL(4 + 31, reply.count);
    TEST_ASSERT_EQUAL(33, reply.byte[1]);
    TEST_ASSERT_EQUAL_HEX8(0xff, reply.byte[3]);
    TEST_ASSERT_EQUAL_MEMORY(expected, reply.byte + 4, 31);
    refused(line_asks(UNIT, more, 2), 17, 3);
}

static void test_device_identification(void)
{
    const uint8_t stream[] = {43, 14, 1, 0}, single[] = {43, 14, 4, 2}, none[] = {43, 14, 4, 3}, other[] = {43, 13, 0, 0};
    const uint8_t bad[] = {43, 14, 5, 0}, later[] = {43, 14, 2, 1};
    reply_t reply = line_asks(UNIT, stream, 4);
    const uint8_t head[] = {43, 14, 1, 0x81, 0, 0, 3, 0, 5, 'B', 'r', 'a', 'c', 'e', 1, 15};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(head, reply.byte, sizeof head);
    TEST_ASSERT_EQUAL(7 + 7 + 17 + 7, reply.count);
    reply = line_asks(UNIT, single, 4);
    const uint8_t version[] = {43, 14, 4, 0x81, 0, 0, 1, 2, 5, '0', '.', '1', '.', '0'};
    TEST_ASSERT_EQUAL(sizeof version, reply.count);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(version, reply.byte, sizeof version);
    TEST_ASSERT_EQUAL(7 + 17 + 7, line_asks(UNIT, later, 4).count);
    refused(line_asks(UNIT, none, 4), 43, 2);
    refused(line_asks(UNIT, other, 4), 43, 1);
    refused(line_asks(UNIT, bad, 4), 43, 3);
    refused(line_asks(UNIT, stream, 3), 43, 3);
    refused(line_asks(UNIT, stream, 1), 43, 1);
}

static uint32_t diagnostic(uint8_t code)
{
    const uint8_t pdu[] = {8, 0, code, 0, 0};
    const reply_t reply = line_asks(UNIT, pdu, sizeof pdu);
    TEST_ASSERT_EQUAL(5, reply.count);
    return (uint32_t)reply.byte[3] << 8 | reply.byte[4];
}

static void test_diagnostics_count(void)
{
    const uint8_t echo[] = {8, 0, 0, 0xa5, 0x37, 1, 2}, odd[] = {8, 0, 0, 1}, unknown[] = {8, 0, 1, 0, 0};
    const uint8_t data[] = {8, 0, 0x0b, 0, 1};
    const reply_t reply = line_asks(UNIT, echo, sizeof echo);
    TEST_ASSERT_EQUAL(sizeof echo, reply.count);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(echo, reply.byte, sizeof echo);
    TEST_ASSERT_EQUAL(0, diagnostic(0x0a));
    refused(line_asks(UNIT, odd, sizeof odd), 8, 3);
    refused(line_asks(UNIT, unknown, sizeof unknown), 8, 1);
    refused(line_asks(UNIT, data, sizeof data), 8, 3);
    const uint8_t bad[] = {UNIT, 4, 0, 0, 0, 2, 0xff, 0xff};
    line_says(bad, sizeof bad);
    ticks(60);
    TEST_ASSERT_EQUAL(0, line_asks(UNIT + 1, echo, sizeof echo).count);
    TEST_ASSERT_EQUAL(0, line_asks(0, echo, sizeof echo).count);
    TEST_ASSERT_EQUAL(6, diagnostic(0x0b)); /* three refused, another's, everybody's, this one */
    TEST_ASSERT_EQUAL(1, diagnostic(0x0c));
    TEST_ASSERT_EQUAL(3, diagnostic(0x0d));
    TEST_ASSERT_EQUAL(8, diagnostic(0x0e));
    TEST_ASSERT_EQUAL(1, diagnostic(0x0f));
    TEST_ASSERT_EQUAL(0, diagnostic(0x12));
}

static void test_unknown_functions_are_refused(void)
{
    for (uint32_t function = 0; function < 256u; function++) {
        const uint8_t pdu[] = {(uint8_t)function, 0, 0, 0, 1};
        const bool known = function == 3u || function == 4u || function == 6u || function == 8u || function == 16u ||
                           function == 17u || function == 43u;
        const reply_t reply = line_asks(UNIT, pdu, sizeof pdu);
        if (function >= 128u) { /* on a line it is somebody's answer, perhaps one's own come back */
            TEST_ASSERT_EQUAL(0, reply.count);
            refused(tcp_asks(UNIT, pdu, sizeof pdu), (uint8_t)function, 1);
        } else if (!known) {
            refused(reply, (uint8_t)function, 1);
        }
    }
}

/* --------------------------------------------------------------------------------------- broken frames -- */

static const uint8_t good[] = {UNIT, 4, 0, 0, 0, 2, 0x73, 0x5b};

static bool answers(void)
{
    const reply_t reply = read_asks(4, 0, 2);
    return reply.count == 6u && value_at(&reply, 0) == 0x4640e600u;
}

static void test_the_sample_frame_is_good(void)
{
    TEST_ASSERT_EQUAL_HEX16(0, crc_by_bits(good, sizeof good));
}

static void test_any_bit_wrong_is_no_request(void)
{
    for (uint32_t bit = 8; bit < 64u; bit++) { /* but the address': then it is for somebody else, and broken too */
        uint8_t frame[8];
        memcpy(frame, good, sizeof frame);
        frame[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
        const uint32_t before = broken();
        line_says(frame, sizeof frame);
        TEST_ASSERT_EQUAL(0, heard(BRACE_SERIAL_MODBUS).count);
        TEST_ASSERT_EQUAL(before + 1u, broken());
    }
    TEST_ASSERT_TRUE(answers());
}

static void test_part_of_a_frame_is_dropped_and_counted(void)
{
    for (uint32_t count = 1; count < sizeof good; count++) {
        const uint32_t before = broken();
        line_says(good, count);
        ticks(60);
        TEST_ASSERT_EQUAL(before + 1u, broken());
        TEST_ASSERT_TRUE(answers());
    }
}

static void test_a_frame_may_come_in_parts_that_an_adapter_holds_back(void)
{
    for (uint32_t count = 1; count < sizeof good; count++) {
        line_says(good, count);
        ticks(15);
        line_says(good + count, (uint32_t)sizeof good - count);
        TEST_ASSERT_EQUAL(9, heard(BRACE_SERIAL_MODBUS).count);
    }
    TEST_ASSERT_EQUAL(0, broken());
}

static void test_frames_too_long_are_dropped_whole(void)
{
    uint8_t bytes[400];
    memset(bytes, UNIT, sizeof bytes);
    line_says(bytes, 257);
    ticks(200);
    TEST_ASSERT_EQUAL(1, broken());
    line_says(bytes, 400);
    ticks(200);
    TEST_ASSERT_EQUAL(2, broken());
    TEST_ASSERT_TRUE(answers());
}

static void test_two_frames_without_silence_are_none(void)
{
    line_says(good, sizeof good);
    line_says(good, sizeof good);
    TEST_ASSERT_EQUAL(0, heard(BRACE_SERIAL_MODBUS).count);
    TEST_ASSERT_EQUAL(1, broken());
    TEST_ASSERT_TRUE(answers());
}

static void test_others_requests_and_their_answers_pass(void)
{
    const uint8_t ask[] = {4, 0, 0, 0, 2}, answer[] = {4, 4, 0x46, 0x40, 0xe6, 0};
    TEST_ASSERT_EQUAL(0, line_asks(UNIT - 1, ask, sizeof ask).count);
    TEST_ASSERT_EQUAL(0, line_asks(UNIT - 1, answer, sizeof answer).count);
    TEST_ASSERT_EQUAL(0, broken());
    TEST_ASSERT_TRUE(answers());
}

static void test_everybody_obeys_and_nobody_answers(void)
{
    uint8_t pdu[] = {16, 0x40, 0, 0, 2, 4, 0xc0, 0xde, 0, 2};
    TEST_ASSERT_EQUAL(0, line_asks(0, pdu, sizeof pdu).count);
    TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, app.mode);
}

static void test_a_line_that_takes_nothing_does_not_hold_it(void)
{
    brace_fake_fail_next(&fake, BRACE_FAKE_SERIAL_WRITE, 10000, BRACE_HAL_E_DEVICE);
    line_says(good, sizeof good);
    ticks(2500);
    fake.failure_count = 0;
    TEST_ASSERT_TRUE(answers());
    brace_fake_fail_next(&fake, BRACE_FAKE_SERIAL_READ, 100, BRACE_HAL_E_DEVICE);
    ticks(50);
    fake.failure_count = 0;
    TEST_ASSERT_TRUE(answers());
}

static void test_a_flood_stops_nothing(void)
{
    uint8_t noise[64];
    uint32_t state = 1;
    const uint32_t before = now()->sequence;
    for (int i = 0; i < 5000; i++) {
        for (uint32_t k = 0; k < sizeof noise; k++) {
            state = state * 1664525u + 1013904223u;
            noise[k] = (uint8_t)(state >> 24);
        }
        (void)brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS, noise, sizeof noise);
        ticks(1);
    }
    TEST_ASSERT_GREATER_OR_EQUAL(before + 4990u, now()->sequence);
    ticks(200);
    TEST_ASSERT_GREATER_THAN(0, broken());
    TEST_ASSERT_TRUE(answers());
}

/* ------------------------------------------------------------------------------------------------ TCP -- */

static void test_tcp_answers_the_same(void)
{
    const uint8_t read[] = {4, 0, 0, 0, 116}, who[] = {17}, bad[] = {4, 0, 0, 0, 126};
    const reply_t reply = tcp_asks(UNIT, read, sizeof read);
    TEST_ASSERT_EQUAL(234, reply.count);
    TEST_ASSERT_EQUAL_HEX32(0x4640e600u, value_at(&reply, 0));
    TEST_ASSERT_EQUAL(234, tcp_asks(0, read, sizeof read).count);
    TEST_ASSERT_EQUAL(234, tcp_asks(255, read, sizeof read).count);
    TEST_ASSERT_EQUAL(35, tcp_asks(UNIT, who, 1).count);
    refused(tcp_asks(UNIT, bad, sizeof bad), 4, 3);
    refused(tcp_asks(UNIT + 1, read, sizeof read), 4, 11); /* no such unit behind this door */
}

static void test_tcp_and_line_at_once_do_not_mix(void)
{
    for (int i = 0; i < 40; i++) {
        uint8_t adu[12] = {0, 1, 0, 0, 0, 6, UNIT, 4, 0, 0, 0, 116};
        ticks(i % 5);
        line_says(good, sizeof good);
        ticks(i % 7);
        (void)brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS_TCP, adu, sizeof adu);
        reply_t line = {.count = 0}, tcp = {.count = 0};
        for (int tick = 0; tick < 100; tick++) {
            ticks(1);
            line.count += brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS, line.byte + line.count, 260u - line.count);
            tcp.count += brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS_TCP, tcp.byte + tcp.count, 260u - tcp.count);
        }
        TEST_ASSERT_EQUAL(9, line.count);
        TEST_ASSERT_EQUAL_HEX16(0, crc_by_bits(line.byte, line.count));
        TEST_ASSERT_EQUAL(7 + 234, tcp.count);
    }
}

static void test_what_is_no_modbus_on_tcp_is_dropped(void)
{
    const uint8_t other_protocol[] = {0, 1, 0, 9, 0, 6, UNIT, 4, 0, 0, 0, 2};
    const uint8_t half[] = {0, 1, 0, 0, 0, 6, UNIT, 4, 0};
    const uint8_t read[] = {4, 0, 0, 0, 2};
    (void)brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS_TCP, other_protocol, sizeof other_protocol);
    TEST_ASSERT_EQUAL(0, heard(BRACE_SERIAL_MODBUS_TCP).count);
    TEST_ASSERT_EQUAL(1, broken());
    (void)brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS_TCP, half, sizeof half);
    ticks(1200);
    TEST_ASSERT_EQUAL(2, broken());
    TEST_ASSERT_EQUAL(6, tcp_asks(UNIT, read, sizeof read).count);
}

static void test_a_slow_line_waits_its_silence(void)
{
    brace_parameters_t p = bench_parameters();
    p.controller.modbus_address = UNIT;
    p.controller.modbus_baud = 1200;
    bench_start(&p);
    ticks(20);
    line_says(good, 4);
    ticks(25); /* 3.5 characters are 32 ms */
    line_says(good + 4, 4);
    TEST_ASSERT_EQUAL(9, heard(BRACE_SERIAL_MODBUS).count);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_line_is_set_up_as_the_standard_wants_it);
    RUN_TEST(test_probes_tell_the_word_order);
    RUN_TEST(test_k_is_the_snapshots);
    RUN_TEST(test_what_is_not_known_is_nan_and_all_ones_never_zero);
    RUN_TEST(test_a_block_is_one_snapshot);
    RUN_TEST(test_every_part_of_a_block_is_the_same_block);
    RUN_TEST(test_reads_have_their_limits);
    RUN_TEST(test_parameters_are_written_staged_committed_and_read_back);
    RUN_TEST(test_nothing_is_written_outside_configuration);
    RUN_TEST(test_what_is_staged_is_forgotten_when_configuration_is_left);
    RUN_TEST(test_a_block_is_written_whole_or_not_at_all);
    RUN_TEST(test_values_out_of_their_range_are_refused);
    RUN_TEST(test_writes_have_their_limits);
    RUN_TEST(test_function_6_writes_a_value_in_two_halves_in_order);
    RUN_TEST(test_while_a_set_is_stored_the_answer_is_busy);
    RUN_TEST(test_a_store_that_fails_says_so_where_it_was_asked);
    RUN_TEST(test_k_at_a_posture);
    RUN_TEST(test_a_posture_needs_both_angles_and_they_must_be_angles);
    RUN_TEST(test_commands_need_their_key_and_their_mode);
    RUN_TEST(test_who_answers);
    RUN_TEST(test_device_identification);
    RUN_TEST(test_diagnostics_count);
    RUN_TEST(test_unknown_functions_are_refused);
    RUN_TEST(test_the_sample_frame_is_good);
    RUN_TEST(test_any_bit_wrong_is_no_request);
    RUN_TEST(test_part_of_a_frame_is_dropped_and_counted);
    RUN_TEST(test_a_frame_may_come_in_parts_that_an_adapter_holds_back);
    RUN_TEST(test_frames_too_long_are_dropped_whole);
    RUN_TEST(test_two_frames_without_silence_are_none);
    RUN_TEST(test_others_requests_and_their_answers_pass);
    RUN_TEST(test_everybody_obeys_and_nobody_answers);
    RUN_TEST(test_a_line_that_takes_nothing_does_not_hold_it);
    RUN_TEST(test_a_flood_stops_nothing);
    RUN_TEST(test_tcp_answers_the_same);
    RUN_TEST(test_tcp_and_line_at_once_do_not_mix);
    RUN_TEST(test_what_is_no_modbus_on_tcp_is_dropped);
    RUN_TEST(test_a_slow_line_waits_its_silence);
    return UNITY_END();
}
