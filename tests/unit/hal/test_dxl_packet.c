/* Packets of Dynamixel Protocol 2.0: the manual's own examples, stuffing, and what damage does to them. */
#include <string.h>

#include "brace_dxl_packet.h"
#include "unity.h"

static dxl_out_t out;
static dxl_receiver_t receiver;

void setUp(void)
{
    out = (dxl_out_t){.count = 0};
    dxl_receiver_start(&receiver);
}

void tearDown(void) {}

/* A status packet of a servo: its error byte and data. */
static void make_status(uint8_t id, uint8_t error, const uint8_t *data, uint32_t count)
{
    dxl_begin(&out, id, DXL_STATUS);
    dxl_add(&out, error, 1);
    for (uint32_t i = 0; i < count; i++) {
        dxl_add(&out, data[i], 1);
    }
    TEST_ASSERT_TRUE(dxl_end(&out));
}

static void take_all(const uint8_t *bytes, uint32_t count)
{
    TEST_ASSERT_EQUAL(count, dxl_receiver_take(&receiver, bytes, count));
}

/* ------------------------------------------------------------------------------------------------ making -- */

static void test_the_manuals_examples_of_packets(void)
{
    static const uint8_t ping[] = {0xff, 0xff, 0xfd, 0x00, 0x01, 0x03, 0x00, 0x01, 0x19, 0x4e};
    static const uint8_t read[] = {0xff, 0xff, 0xfd, 0x00, 0x01, 0x07, 0x00, 0x02, 0x84, 0x00, 0x04, 0x00, 0x1d, 0x15};
    static const uint8_t write[] = {0xff, 0xff, 0xfd, 0x00, 0x01, 0x09, 0x00, 0x03,
                                    0x74, 0x00, 0x00, 0x02, 0x00, 0x00, 0xca, 0x89};
    static const uint8_t reboot[] = {0xff, 0xff, 0xfd, 0x00, 0x01, 0x03, 0x00, 0x08, 0x2f, 0x4e};
    TEST_ASSERT_TRUE(dxl_ask_ping(&out, 1));
    TEST_ASSERT_EQUAL_UINT8_ARRAY(ping, out.bytes, sizeof ping);
    setUp();
    TEST_ASSERT_TRUE(dxl_ask_read(&out, 1, 132, 4));
    TEST_ASSERT_EQUAL_UINT8_ARRAY(read, out.bytes, sizeof read);
    setUp();
    TEST_ASSERT_TRUE(dxl_ask_write(&out, 1, 116, 512, 4));
    TEST_ASSERT_EQUAL_UINT8_ARRAY(write, out.bytes, sizeof write);
    setUp();
    TEST_ASSERT_TRUE(dxl_ask_reboot(&out, 1));
    TEST_ASSERT_EQUAL_UINT8_ARRAY(reboot, out.bytes, sizeof reboot);
}

static void test_a_header_within_the_parameters_is_stuffed_and_comes_back(void)
{
    static const uint8_t data[] = {0xff, 0xff, 0xfd, 0xfd, 0x00, 0xff, 0xff, 0xff, 0xfd, 0x01};
    uint8_t back[16];
    dxl_packet_t packet;
    make_status(7, 0, data, sizeof data);
    TEST_ASSERT_EQUAL(DXL_HEAD_BYTES + 1 + sizeof data + 2 + DXL_CRC_BYTES, out.count); /* two headers were in it */
    take_all(out.bytes, out.count);
    TEST_ASSERT_TRUE(dxl_receiver_next(&receiver, &packet));
    TEST_ASSERT_EQUAL(1 + sizeof data, dxl_unstuff(&packet, back, sizeof back));
    TEST_ASSERT_EQUAL_UINT8_ARRAY(data, &back[1], sizeof data);
    TEST_ASSERT_EQUAL(5, dxl_unstuff(&packet, back, 4)); /* more than there is room for */
}

static void test_what_finds_no_room_is_reported(void)
{
    dxl_begin(&out, 1, DXL_WRITE);
    for (uint32_t i = 0; i < DXL_OUT_BYTES; i++) {
        dxl_add(&out, 0xff, 1);
    }
    TEST_ASSERT_FALSE(dxl_end(&out));
    TEST_ASSERT_FALSE(dxl_ask_ping(&out, 1));
    TEST_ASSERT_LESS_OR_EQUAL(DXL_OUT_BYTES, out.count);
}

/* ----------------------------------------------------------------------------------------------- reading -- */

static void test_packets_come_byte_by_byte_and_in_one_piece(void)
{
    static const uint8_t data[] = {1, 2, 3};
    dxl_packet_t packet;
    make_status(1, 0, data, sizeof data);
    make_status(2, DXL_ERROR_ALERT, data, sizeof data);
    for (uint32_t i = 0; i < out.count; i++) {
        take_all(&out.bytes[i], 1);
        const bool is_end = i + 1u == out.count / 2u || i + 1u == out.count;
        TEST_ASSERT_EQUAL(is_end, dxl_receiver_next(&receiver, &packet));
    }
    TEST_ASSERT_EQUAL(2, packet.id);
    TEST_ASSERT_FALSE(dxl_receiver_next(&receiver, &packet));
    take_all(out.bytes, out.count);
    TEST_ASSERT_TRUE(dxl_receiver_next(&receiver, &packet));
    TEST_ASSERT_EQUAL(1, packet.id);
    TEST_ASSERT_TRUE(dxl_receiver_next(&receiver, &packet));
    TEST_ASSERT_EQUAL(2, packet.id);
    TEST_ASSERT_EQUAL(DXL_ERROR_ALERT, packet.parameters[0]);
    TEST_ASSERT_FALSE(dxl_receiver_next(&receiver, &packet));
    TEST_ASSERT_EQUAL(0, receiver.damaged + receiver.skipped);
}

static void test_it_finds_the_next_packet_behind_noise_and_damage(void)
{
    static const uint8_t data[] = {1, 2, 3};
    static const uint8_t noise[] = {0x00, 0xff, 0xff, 0xff, 0xfd, 0xff, 0x12};
    dxl_packet_t packet;
    make_status(1, 0, data, sizeof data);
    for (uint32_t lost = 0; lost < out.count; lost++) { /* one byte of the first packet is missing */
        dxl_receiver_start(&receiver);
        take_all(noise, sizeof noise);
        take_all(out.bytes, lost);
        take_all(&out.bytes[lost + 1], out.count - lost - 1);
        take_all(out.bytes, out.count);
        TEST_ASSERT_TRUE(dxl_receiver_next(&receiver, &packet));
        TEST_ASSERT_EQUAL_UINT8_ARRAY(data, &packet.parameters[1], sizeof data);
        TEST_ASSERT_FALSE(dxl_receiver_next(&receiver, &packet));
        TEST_ASSERT_EQUAL(0, receiver.count);
        TEST_ASSERT_EQUAL(sizeof noise + out.count - 1, receiver.skipped);
    }
}

static void test_a_length_beyond_all_room_does_not_stop_it(void)
{
    static const uint8_t huge[] = {0xff, 0xff, 0xfd, 0x00, 0x01, 0xff, 0xff, 0x55};
    static const uint8_t none[] = {0xff, 0xff, 0xfd, 0x00, 0x01, 0x02, 0x00, 0x55};
    dxl_packet_t packet;
    take_all(huge, sizeof huge);
    take_all(none, sizeof none);
    TEST_ASSERT_TRUE(dxl_ask_ping(&out, 1));
    take_all(out.bytes, out.count);
    TEST_ASSERT_TRUE(dxl_receiver_next(&receiver, &packet));
    TEST_ASSERT_EQUAL(DXL_PING, packet.instruction);
    TEST_ASSERT_EQUAL(2, receiver.damaged);
    TEST_ASSERT_EQUAL(0, dxl_receiver_take(&receiver, huge, 0));
}

static void test_an_answer_to_a_fast_sync_read_falls_into_its_servos_parts(void)
{
    /* Two servos, two bytes each: the first part's CRC is over all before it, the last one is the packet's. */
    uint8_t bytes[20] = {0xff, 0xff, 0xfd, 0x00, DXL_ID_ALL, 13, 0, DXL_STATUS, 0x80, 5, 0x11, 0x22};
    uint16_t crc = dxl_crc(0, bytes, 12);
    bytes[12] = (uint8_t)crc;
    bytes[13] = (uint8_t)(crc >> 8);
    bytes[14] = 0;
    bytes[15] = 6;
    bytes[16] = 0x33;
    bytes[17] = 0x44;
    crc = dxl_crc(0, bytes, 18);
    bytes[18] = (uint8_t)crc;
    bytes[19] = (uint8_t)(crc >> 8);
    dxl_packet_t packet;
    dxl_answer_t answer;
    take_all(bytes, sizeof bytes);
    TEST_ASSERT_TRUE(dxl_receiver_next(&receiver, &packet));
    TEST_ASSERT_TRUE(dxl_fast_answer(&packet, 2, 2, 0, &answer));
    TEST_ASSERT_EQUAL(5, answer.id);
    TEST_ASSERT_EQUAL(0x80, answer.error);
    TEST_ASSERT_EQUAL(0x22, answer.data[1]);
    TEST_ASSERT_TRUE(dxl_fast_answer(&packet, 2, 2, 1, &answer));
    TEST_ASSERT_EQUAL(6, answer.id);
    TEST_ASSERT_EQUAL(0x33, answer.data[0]);
    TEST_ASSERT_FALSE(dxl_fast_answer(&packet, 2, 2, 2, &answer));
    TEST_ASSERT_FALSE(dxl_fast_answer(&packet, 3, 2, 0, &answer));
    TEST_ASSERT_FALSE(dxl_fast_answer(&packet, 2, 3, 0, &answer));
}

/* ------------------------------------------------------------------------------------------------ damage -- */

static uint8_t sound[DXL_OUT_BYTES];
static uint32_t sound_count;

static void remember_status(uint8_t last)
{
    const uint8_t data[] = {0xff, 0xff, 0xfd, last, 0x00};
    setUp();
    make_status(3, 0, data, sizeof data);
    memcpy(sound, out.bytes, out.count);
    sound_count = out.count;
}

static void flip(uint8_t *bytes, uint32_t bit)
{
    bytes[bit / 8u] ^= (uint8_t)(1u << (bit % 8u));
}

/* Is a damaged packet taken for one that was asked for: five bytes of servo 3? The line is silent behind it. */
static bool is_believed(const uint8_t *bytes)
{
    uint8_t data[DXL_IN_BYTES];
    dxl_packet_t packet;
    dxl_receiver_start(&receiver);
    (void)dxl_receiver_take(&receiver, bytes, sound_count);
    while (dxl_receiver_next(&receiver, &packet)) { /* ends: every call takes bytes away */
        if (packet.instruction == DXL_STATUS && packet.id == 3 && dxl_unstuff(&packet, data, sizeof data) == 6u) {
            return true;
        }
    }
    return false;
}

static void test_up_to_two_flipped_bits_anywhere_are_seen(void)
{
    remember_status(0x80);
    TEST_ASSERT_TRUE(is_believed(sound));
    for (uint32_t a = 0; a < 8u * sound_count; a++) {
        flip(sound, a);
        TEST_ASSERT_FALSE(is_believed(sound));
        for (uint32_t b = a + 1u; b < 8u * sound_count; b++) {
            flip(sound, b);
            TEST_ASSERT_FALSE(is_believed(sound));
            flip(sound, b);
        }
        flip(sound, a);
    }
}

/* The CRC is linear: damage is missed when the flipped bits' own remainders cancel. Three cancel when two make a third.
 * So the remainders of all single bits stand for all packets of this length, whatever is in them. */
static void test_up_to_three_flipped_bits_in_any_packet_of_ours_are_seen(void)
{
    enum { BITS = 8 * 96 };
    static uint16_t of_bit[BITS];
    static uint8_t is_one[65536 / 8];
    static uint8_t bytes[BITS / 8];
    memset(is_one, 0, sizeof is_one);
    memset(bytes, 0, sizeof bytes);
    for (uint32_t bit = 0; bit < BITS; bit++) {
        flip(bytes, bit);
        /* The last two bytes are the CRC itself, low byte first. */
        of_bit[bit] = (uint16_t)(dxl_crc(0, bytes, sizeof bytes - 2u) ^
                                 (bytes[sizeof bytes - 2u] | (uint32_t)bytes[sizeof bytes - 1u] << 8));
        flip(bytes, bit);
        TEST_ASSERT_NOT_EQUAL(0, of_bit[bit]);
        TEST_ASSERT_EQUAL(0, is_one[of_bit[bit] / 8u] >> (of_bit[bit] % 8u) & 1u); /* two would cancel */
        is_one[of_bit[bit] / 8u] |= (uint8_t)(1u << (of_bit[bit] % 8u));
    }
    for (uint32_t a = 0; a < BITS; a++) {
        for (uint32_t b = a + 1u; b < BITS; b++) {
            const uint16_t third = of_bit[a] ^ of_bit[b];
            if ((is_one[third / 8u] >> (third % 8u) & 1u) != 0u) {
                TEST_FAIL_MESSAGE("three bits cancel");
            }
        }
    }
}

/* With the length damaged the CRC lies elsewhere: three bits, at least one of them in the length. */
static void test_three_flipped_bits_that_touch_the_length_are_seen(void)
{
    remember_status(0x01);
    for (uint32_t a = 40; a < 56u; a++) {
        flip(sound, a);
        for (uint32_t b = 0; b < 8u * sound_count; b++) {
            flip(sound, b);
            for (uint32_t c = b + 1u; c < 8u * sound_count; c++) {
                flip(sound, c);
                if (b != a && c != a && is_believed(sound)) {
                    TEST_FAIL_MESSAGE("believed");
                }
                flip(sound, c);
            }
            flip(sound, b);
        }
        flip(sound, a);
    }
}

/* A line sends the lowest bit of each byte first, the CRC counts from the highest. So a burst of the line is none of
 * the CRC's, and the CRC misses some of 11 and more bits: one at each byte, and a few that reach into the CRC itself.
 * Those are for whoever knows what the data can be. */
static void test_the_bursts_that_the_crc_misses_are_these(void)
{
    enum { BYTES = 24, BITS = 8 * BYTES, BURST = 16 };
    static uint8_t bytes[BYTES];
    uint16_t of_bit[BITS + BURST] = {0};
    uint32_t missed = 0, missed_before_crc = 0, shortest = BURST;
    for (uint32_t bit = 0; bit < BITS; bit++) {
        flip(bytes, bit);
        of_bit[bit] = (uint16_t)(dxl_crc(0, bytes, BYTES - 2u) ^ (bytes[BYTES - 2] | (uint32_t)bytes[BYTES - 1] << 8));
        flip(bytes, bit);
    }
    for (uint32_t at = 0; at < BITS; at++) { /* bursts that begin at this bit, in Gray code's order */
        uint16_t remainder = of_bit[at];
        const uint32_t further = BITS - 1u - at < BURST - 1u ? BITS - 1u - at : BURST - 1u;
        for (uint32_t i = 1; i < 1u << further; i++) {
            remainder ^= of_bit[at + 1u + (uint32_t)__builtin_ctz(i)];
            const uint32_t pattern = i ^ i >> 1;
            const uint32_t length = 33u - (uint32_t)__builtin_clz(pattern);
            if (remainder == 0u) {
                missed++;
                missed_before_crc += at + length <= BITS - 16u ? 1u : 0u;
                shortest = length < shortest ? length : shortest;
            }
        }
    }
    TEST_ASSERT_EQUAL(11, shortest);
    TEST_ASSERT_EQUAL(BYTES - 4, missed_before_crc); /* one that begins in each byte */
    TEST_ASSERT_EQUAL(115, missed);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_manuals_examples_of_packets);
    RUN_TEST(test_a_header_within_the_parameters_is_stuffed_and_comes_back);
    RUN_TEST(test_what_finds_no_room_is_reported);
    RUN_TEST(test_packets_come_byte_by_byte_and_in_one_piece);
    RUN_TEST(test_it_finds_the_next_packet_behind_noise_and_damage);
    RUN_TEST(test_a_length_beyond_all_room_does_not_stop_it);
    RUN_TEST(test_an_answer_to_a_fast_sync_read_falls_into_its_servos_parts);
    RUN_TEST(test_up_to_two_flipped_bits_anywhere_are_seen);
    RUN_TEST(test_up_to_three_flipped_bits_in_any_packet_of_ours_are_seen);
    RUN_TEST(test_three_flipped_bits_that_touch_the_length_are_seen);
    RUN_TEST(test_the_bursts_that_the_crc_misses_are_these);
    return UNITY_END();
}
