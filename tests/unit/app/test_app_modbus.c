/* The controller as a Modbus server: what is read, who answers, identification, diagnostics. Register addresses are
 * those of docs/modbus.md. */
#include "modbus_master.h"
#include "wire/measured.h"

void setUp(void)
{
    start_unit();
}

void tearDown(void) {}

static void test_the_line_is_set_up_as_the_standard_wants_it(void)
{
    TEST_ASSERT_EQUAL(115200, fake.baud[BRACE_SERIAL_MODBUS]);
    TEST_ASSERT_EQUAL(BRACE_PARITY_EVEN, fake.parity[BRACE_SERIAL_MODBUS]);
}

static void test_probes_show_the_word_order(void)
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
            reply.count +=
                brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS, reply.byte + reply.count, 260u - reply.count);
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
    for (uint32_t start = 0; start < 8u; start += 2u) {
        for (uint32_t count = 1; count < 30u; count += 3) {
            const reply_t part = read_asks(3, start, count);
            TEST_ASSERT_EQUAL(2u + 2u * count, part.count);
            TEST_ASSERT_EQUAL_HEX8_ARRAY(whole.byte + 2 + 2u * start, part.byte + 2, 2u * count);
        }
    }
    TEST_ASSERT_EQUAL_HEX32(bits(app.controller.parameters.in_force.limb.coxa_mm), value_at(&whole, 0));
    const reply_t last = read_asks(3, 2 * brace_parameter_number(BRACE_PARAMETER_CONTROLLER_MODBUS_ADDRESS), 4);
    TEST_ASSERT_EQUAL(UNIT, value_at(&last, 0));
    TEST_ASSERT_EQUAL(115200, value_at(&last, 1));
}

/* A master that counts registers from 1 would get the second half of one value and the first of the next, which is a
 * number like any other. One register alone is no number of 32 bits, and may be asked for. */
static void test_a_read_that_begins_within_a_value_is_refused(void)
{
    static const struct {
        uint8_t function;
        uint32_t first;
    } area[] = {{4, 0}, {4, 4096}, {3, 0}, {3, 16384}};
    for (uint32_t i = 0; i < sizeof area / sizeof *area; i++) {
        for (uint32_t start = area[i].first + 1u; start < area[i].first + 30u; start += 2u) {
            for (uint32_t count = 2; count < 10u; count++) {
                refused(read_asks(area[i].function, start, count), area[i].function, 2);
            }
            TEST_ASSERT_EQUAL(4, read_asks(area[i].function, start, 1).count);
        }
    }
    refused(read_asks(4, 21, 2), 4, 2); /* k_xx lies at 20 */
    refused(read_asks(4, 21, 10), 4, 2);
    TEST_ASSERT_EQUAL(8, read_asks(4, 20, 3).count);
}

static void test_reads_have_their_limits(void)
{
    TEST_ASSERT_EQUAL(232 + 2, read_asks(4, 0, 116).count);
    const uint32_t measured = 2 * BRACE_MEASURED_COUNT;
    refused(read_asks(4, measured - 115, 116), 4, 2);
    refused(read_asks(4, measured, 1), 4, 2);
    refused(read_asks(4, measured - 1, 2), 4, 2);
    TEST_ASSERT_EQUAL(4, read_asks(4, measured - 1, 1).count);
    refused(read_asks(4, 0, 0), 4, 3);
    refused(read_asks(4, 0, 126), 4, 3);
    refused(read_asks(4, 0, 0xffff), 4, 3);
    refused(read_asks(4, 0xffff, 2), 4, 2);
    refused(read_asks(4, 4095, 2), 4, 2);
    TEST_ASSERT_EQUAL(170, read_asks(4, 4096, 84).count);
    refused(read_asks(4, 4096, 85), 4, 2);
    TEST_ASSERT_EQUAL(166, read_asks(3, 16384, 82).count);
    refused(read_asks(3, 16384, 83), 3, 2);
    refused(read_asks(3, 16383, 2), 3, 2);
    TEST_ASSERT_EQUAL(4, read_asks(3, 2 * BRACE_PARAMETER_NUMBERS - 1, 1).count);
    refused(read_asks(3, 2 * BRACE_PARAMETER_NUMBERS - 1, 2), 3, 2);
    const uint8_t too_long[] = {4, 0, 0, 0, 2, 0}, too_short[] = {4, 0, 0, 0};
    refused(line_asks(UNIT, too_long, sizeof too_long), 4, 3);
    refused(line_asks(UNIT, too_short, sizeof too_short), 4, 3);
    TEST_ASSERT_EQUAL(14, counters().modbus_refused);
}

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
    const uint8_t stream[] = {43, 14, 1, 0}, single[] = {43, 14, 4, 2}, none[] = {43, 14, 4, 3},
                  other[] = {43, 13, 0, 0}, longer[] = {43, 14, 1, 0, 0};
    const uint8_t bad[] = {43, 14, 5, 0}, zero[] = {43, 14, 0, 0}, later[] = {43, 14, 2, 1};
    reply_t reply = line_asks(UNIT, stream, 4);
    static const char all[] = "\x2b\x0e\x01\x81\0\0\x03"
                              "\0\x05"
                              "Brace"
                              "\x01\x0f"
                              "limb controller"
                              "\x02\x05"
                              "0.1.0";
    TEST_ASSERT_EQUAL(sizeof all - 1u, reply.count);
    TEST_ASSERT_EQUAL_MEMORY(all, reply.byte, sizeof all - 1u);
    reply = line_asks(UNIT, single, 4);
    const uint8_t version[] = {43, 14, 4, 0x81, 0, 0, 1, 2, 5, '0', '.', '1', '.', '0'};
    TEST_ASSERT_EQUAL(sizeof version, reply.count);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(version, reply.byte, sizeof version);
    TEST_ASSERT_EQUAL(7 + 17 + 7, line_asks(UNIT, later, 4).count);
    refused(line_asks(UNIT, none, 4), 43, 2);
    refused(line_asks(UNIT, other, 4), 43, 1);
    refused(line_asks(UNIT, bad, 4), 43, 3);
    refused(line_asks(UNIT, zero, 4), 43, 3);
    refused(line_asks(UNIT, stream, 3), 43, 3);
    refused(line_asks(UNIT, longer, 5), 43, 3);
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

/* A drive's sample may be younger than the tick that reads it. */
static void test_an_age_is_never_negative(void)
{
    brace_measured_t measured;
    ticks(3);
    const brace_app_counters_t counted = counters();
    measured_take(&app, &counted, now()->taken_us - 3u, &measured);
    TEST_ASSERT_EQUAL_UINT32(0, measured.age_us);
    for (uint32_t age_us = 0; age_us < 4u; age_us++) {
        measured_take(&app, &counted, now()->taken_us + age_us, &measured);
        TEST_ASSERT_EQUAL_UINT32(age_us, measured.age_us);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_age_is_never_negative);
    RUN_TEST(test_the_line_is_set_up_as_the_standard_wants_it);
    RUN_TEST(test_probes_show_the_word_order);
    RUN_TEST(test_k_is_the_snapshots);
    RUN_TEST(test_what_is_not_known_is_nan_and_all_ones_never_zero);
    RUN_TEST(test_a_block_is_one_snapshot);
    RUN_TEST(test_every_part_of_a_block_is_the_same_block);
    RUN_TEST(test_a_read_that_begins_within_a_value_is_refused);
    RUN_TEST(test_reads_have_their_limits);
    RUN_TEST(test_who_answers);
    RUN_TEST(test_device_identification);
    RUN_TEST(test_diagnostics_count);
    RUN_TEST(test_unknown_functions_are_refused);
    return UNITY_END();
}
