/* CAN frames as text: every command, frames both ways, lines that are none, and a line that takes few bytes. */
#include <string.h>

#include "unity.h"
#include "wire/slcan/slcan.h"

static uint8_t to_node[512], from_node[2048];
static uint32_t to_count, to_read, from_count;
static uint32_t takes_most; /* bytes that the port takes in a call */
static int32_t refuses_with; /* what a port that fails answers; 0: it does not */
static slcan_t slcan;

static int32_t port_setup(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity)
{
    (void)context;
    (void)parity;
    TEST_ASSERT_EQUAL(SLCAN_BAUD, baud);
    return port == BRACE_SERIAL_SLCAN ? BRACE_HAL_OK : BRACE_HAL_E_UNSUPPORTED;
}

static int32_t port_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    (void)context;
    (void)port;
    if (refuses_with != 0) {
        return refuses_with;
    }
    const uint32_t left = to_count - to_read, count = left < room ? left : room;
    memcpy(bytes, to_node + to_read, count);
    to_read += count;
    return (int32_t)count;
}

static int32_t port_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    (void)port;
    if (refuses_with != 0) {
        return refuses_with;
    }
    const uint32_t taken = count < takes_most ? count : takes_most;
    TEST_ASSERT_TRUE(from_count + taken <= sizeof from_node);
    memcpy(from_node + from_count, bytes, taken);
    from_count += taken;
    return (int32_t)taken;
}

static const brace_hal_t hal = {.serial_setup = port_setup, .serial_read = port_read, .serial_write = port_write};

void setUp(void)
{
    to_count = to_read = from_count = 0;
    refuses_with = 0;
    takes_most = sizeof from_node;
    slcan_start(&slcan, &hal, 1);
    TEST_ASSERT_TRUE(slcan.is_fitted);
}

void tearDown(void) {}

/* Sends text, lets the node read it, and compares what it says. returns whether a frame came, in frame */
static bool say(const char *text, const char *answer, brace_can_frame_t *frame)
{
    const uint32_t count = (uint32_t)strlen(text);
    memcpy(to_node, text, count);
    to_count = count;
    to_read = from_count = 0;
    bool came = false;
    for (int i = 0; i < 40; i++) {
        came = slcan_receive(&slcan, &hal, frame) || came;
        slcan_flush(&slcan, &hal);
    }
    TEST_ASSERT_EQUAL(strlen(answer), from_count);
    TEST_ASSERT_EQUAL(0, memcmp(answer, from_node, from_count));
    return came;
}

/* A frame ends a look: those behind it come with the next ones, in their order. */
static void test_frames_that_come_together_are_taken_one_by_one(void)
{
    static const char text[] = "O\rt1230\rt1240\rt1250\r";
    memcpy(to_node, text, sizeof text - 1u);
    to_count = sizeof text - 1u;
    for (uint32_t id = 0x123; id <= 0x125u; id++) {
        brace_can_frame_t frame = {.id = 0};
        TEST_ASSERT_TRUE(slcan_receive(&slcan, &hal, &frame));
        TEST_ASSERT_EQUAL_HEX32(id, frame.id);
    }
    brace_can_frame_t none;
    TEST_ASSERT_FALSE(slcan_receive(&slcan, &hal, &none));
}

/* Whatever stands before it, a frame is found in the look that finds its line; a look ends after 64 lines. */
static void test_a_look_finds_the_frame_behind_other_lines(void)
{
    static const char text[] = "O\r\r\r\r\r\rV\rS8\rt1230\r";
    brace_can_frame_t frame = {.id = 0};
    memcpy(to_node, text, sizeof text - 1u);
    to_count = sizeof text - 1u;
    TEST_ASSERT_TRUE(slcan_receive(&slcan, &hal, &frame));
    TEST_ASSERT_EQUAL_HEX32(0x123, frame.id);
    memset(to_node, '\r', 100);
    to_count = 100;
    to_read = 0;
    TEST_ASSERT_FALSE(slcan_receive(&slcan, &hal, &frame));
    TEST_ASSERT_GREATER_OR_EQUAL(60, to_read);
    TEST_ASSERT_LESS_THAN(100, to_read);
}

/* A stop is taken whatever the channel is, as t0010 from a terminal; every other frame only by an open one. */
static void test_an_urgent_frame_needs_no_open_channel(void)
{
    static const char *const said[][2] = {
        {"t0010\r", "z\r"}, {"t001255AA\r", "z\r"}, {"t0020\r", "\a"}, {"T000000010\r", "\a"}, {"r0010\r", "\a"}};
    static const char *const before[] = {"", "L\r"};
    for (uint32_t i = 0; i < 2u; i++) {
        for (uint32_t j = 0; j < sizeof said / sizeof *said; j++) {
            char text[40], heard[40];
            brace_can_frame_t frame = {.id = 0};
            setUp();
            to_count = (uint32_t)snprintf(text, sizeof text, "%s%s", before[i], said[j][0]);
            memcpy(to_node, text, to_count);
            TEST_ASSERT_EQUAL(j < 2u, slcan_receive(&slcan, &hal, &frame));
            TEST_ASSERT_EQUAL(j < 2u ? 1u : 0u, j < 2u ? frame.id : 0u);
            slcan_flush(&slcan, &hal);
            (void)snprintf(heard, sizeof heard, "%s%s", i == 1u ? "\r" : "", said[j][1]);
            TEST_ASSERT_EQUAL(strlen(heard), from_count);
            TEST_ASSERT_EQUAL_MEMORY(heard, from_node, from_count);
        }
    }
}

static void test_commands_are_answered_as_an_adapter_answers_them(void)
{
    static const char *const said[][2] = {
        {"\r", "\r"},      {"V\r", "V1013\r"}, {"v\r", "v0100\r"}, {"N\r", "NBRC1\r"}, {"F\r", "\a"},
        {"S8\r", "\r"},    {"S9\r", "\a"},     {"S\r", "\a"},      {"S/\r", "\a"},     {"S88\r", "\a"},
        {"s0312\r", "\r"}, {"Z0\r", "\r"},     {"Z1\r", "\a"},     {"Q\r", "\a"},      {"C\r", "\r"},
        {"t1230\r", "\a"}, {"OO\r", "\a"},     {"O\r", "\r"},      {"O\r", "\a"},      {"L\r", "\a"},
        {"S8\r", "\a"},    {"s0312\r", "\a"},  {"Z0\r", "\a"},     {"F\r", "F00\r"},   {"\nV\r", "V1013\r"},
        {"CC\r", "\a"},    {"C\r", "\r"},      {"L\r", "\r"},      {"t1230\r", "\a"},  {"C\r", "\r"},
    };
    brace_can_frame_t frame;
    for (size_t i = 0; i < sizeof said / sizeof *said; i++) {
        TEST_ASSERT_FALSE_MESSAGE(say(said[i][0], said[i][1], &frame), said[i][0]);
    }
}

static void test_a_frame_comes_as_it_was_sent(void)
{
    brace_can_frame_t frame;
    (void)say("O\r", "\r", &frame);
    TEST_ASSERT_TRUE(say("t7ff80123456789aBCdeF\r", "z\r", &frame));
    static const uint8_t data[8] = {0x01, 0x23, 0x45, 0x67, 0x89, 0xab, 0xcd, 0xef};
    TEST_ASSERT_EQUAL_HEX32(0x7ff, frame.id);
    TEST_ASSERT_EQUAL(8, frame.length);
    TEST_ASSERT_FALSE(frame.fd);
    TEST_ASSERT_EQUAL_MEMORY(data, frame.data, 8);
    TEST_ASSERT_TRUE(say("t0000\r", "z\r", &frame));
    TEST_ASSERT_EQUAL(0, frame.length);
}

static void test_frames_that_are_none_are_refused(void)
{
    static const char *const said[][2] = {
        {"t8000\r", "\a"},       {"t12g0\r", "\a"},       {"t1239\r", "\a"},         {"t12310\r", "\a"},
        {"t1231012\r", "\a"},    {"t12310g\r", "\a"},     {"t123\r", "\a"},          {"t12/0\r", "\a"},
        {"t1231 0\r", "\a"},     {"T000000000\r", "Z\r"}, {"T1fffffff10a\r", "Z\r"}, {"r1238\r", "z\r"},
        {"R000001238\r", "Z\r"}, {"r12381\r", "\a"},      {"T00000000\r", "\a"},     {"t123:\r", "\a"},
        {"t123@\r", "\a"},       {"t1231@0\r", "\a"},     {"t1231`0\r", "\a"},       {"t1231G0\r", "\a"},
    };
    brace_can_frame_t frame;
    (void)say("O\r", "\r", &frame);
    for (size_t i = 0; i < sizeof said / sizeof *said; i++) {
        TEST_ASSERT_FALSE_MESSAGE(say(said[i][0], said[i][1], &frame), said[i][0]);
    }
}

static void test_a_line_that_is_too_long_is_refused_once_and_as_a_whole(void)
{
    brace_can_frame_t frame;
    (void)say("O\r", "\r", &frame);
    TEST_ASSERT_TRUE(say("0123456789012345678901234567890123456789t1230\rt1230\r", "\az\r", &frame));
}

/* A line that takes few bytes at a time: all comes, in order, and what finds no room is refused, not garbled. */
static void test_a_slow_line_gets_every_frame_that_found_room(void)
{
    brace_can_frame_t ignored;
    (void)say("O\r", "\r", &ignored);
    from_count = 0;
    takes_most = 5;
    char expected[2048];
    uint32_t expected_count = 0, refused = 0;
    for (uint32_t i = 0; i < 60; i++) {
        const brace_can_frame_t frame = {.id = 0x100u + i, .length = 8, .data = {1, 2, 3, 4, 5, 6, 7, (uint8_t)i}};
        if (slcan_send(&slcan, &frame)) {
            static const char digits[] = "0123456789ABCDEF";
            char *line = expected + expected_count;
            memcpy(line, "t1008", 5);
            line[2] = digits[i / 16u];
            line[3] = digits[i % 16u];
            memcpy(line + 5, "01020304050607", 14);
            line[19] = digits[i / 16u];
            line[20] = digits[i % 16u];
            line[21] = '\r';
            expected_count += 22;
        } else {
            refused++;
        }
        for (int call = 0; call < 3; call++) {
            slcan_flush(&slcan, &hal);
        }
    }
    for (int i = 0; i < 200; i++) {
        slcan_flush(&slcan, &hal);
    }
    TEST_ASSERT_GREATER_THAN(0, refused);
    TEST_ASSERT_GREATER_THAN(20 * 22, expected_count);
    TEST_ASSERT_EQUAL(expected_count, from_count);
    TEST_ASSERT_EQUAL_MEMORY(expected, from_node, expected_count);
}

static void test_a_frame_of_can_fd_has_no_text(void)
{
    brace_can_frame_t frame = {.id = 1, .length = 12, .fd = true};
    TEST_ASSERT_FALSE(slcan_send(&slcan, &frame));
    TEST_ASSERT_EQUAL(0, slcan.out_count);
}

static int32_t setup_fails(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity)
{
    (void)context;
    (void)port;
    (void)baud;
    (void)parity;
    return BRACE_HAL_E_DEVICE;
}

static void test_without_the_port_nothing_comes(void)
{
    brace_can_frame_t frame;
    for (int part = 0; part < 4; part++) {
        brace_hal_t none = hal;
        switch (part) {
        case 0: none.serial_setup = NULL; break;
        case 1: none.serial_read = NULL; break;
        case 2: none.serial_write = NULL; break;
        default: none.serial_setup = setup_fails; break;
        }
        slcan_start(&slcan, &none, 1);
        TEST_ASSERT_FALSE(slcan.is_fitted);
        TEST_ASSERT_FALSE(slcan_receive(&slcan, &none, &frame));
    }
}

/* A port that fails, or that says it has moved more bytes than there are: nothing is lost, and nothing made up. */
static void test_a_port_that_fails_loses_nothing(void)
{
    static const int32_t answers[] = {BRACE_HAL_E_DEVICE, BRACE_HAL_AGAIN, 1000000};
    const brace_can_frame_t sent = {.id = 0x123, .length = 1, .data = {0xab}};
    brace_can_frame_t frame;
    (void)say("O\r", "\r", &frame);
    from_count = 0;
    TEST_ASSERT_TRUE(slcan_send(&slcan, &sent));
    for (int i = 0; i < 3; i++) {
        refuses_with = answers[i];
        slcan_flush(&slcan, &hal);
        TEST_ASSERT_FALSE(slcan_receive(&slcan, &hal, &frame));
    }
    refuses_with = 0;
    slcan_flush(&slcan, &hal);
    slcan_flush(&slcan, &hal);
    TEST_ASSERT_EQUAL(8, from_count);
    TEST_ASSERT_EQUAL_MEMORY("t1231AB\r", from_node, 8);
    TEST_ASSERT_TRUE(say("t7ff10c\r", "z\r", &frame));
    TEST_ASSERT_EQUAL_HEX8(0x0c, frame.data[0]);
}

/* A line that comes in pieces, and one so long that it fills the room more than once. */
static void test_lines_come_in_pieces(void)
{
    brace_can_frame_t frame;
    (void)say("O\r", "\r", &frame);
    TEST_ASSERT_FALSE(say("t7ff2", "", &frame));
    TEST_ASSERT_TRUE(say("0c0d\r", "z\r", &frame));
    TEST_ASSERT_EQUAL(2, frame.length);
    TEST_ASSERT_EQUAL_HEX8(0x0d, frame.data[1]);
    static const char digits[] = "0123456789012345678901234567890123456789"
                                 "0123456789012345678901234567890123456789";
    TEST_ASSERT_FALSE(say(digits, "", &frame));
    TEST_ASSERT_FALSE(say("0123456789", "", &frame));
    TEST_ASSERT_TRUE(say("t1230\rt1230\r", "\az\r", &frame));
}

/* What waits fills the room to its last byte; a reply that finds none is lost whole, and frames go on afterwards. */
static void test_replies_that_find_no_room_are_lost_whole(void)
{
    brace_can_frame_t ignored;
    const brace_can_frame_t sent = {.id = 0x7ff, .length = 8};
    (void)say("O\r", "\r", &ignored);
    takes_most = 0;
    uint32_t wait = 0;
    while (slcan_send(&slcan, &sent)) {
        wait += 22u;
    }
    TEST_ASSERT_EQUAL(SLCAN_OUT_BYTES / 22u * 22u, wait);
    while (wait < (uint32_t)SLCAN_OUT_BYTES) { /* one byte at a time, to the last */
        (void)say("Q\r", "", &ignored);
        wait++;
    }
    (void)say("V\r", "", &ignored); /* no room for its six bytes, nor for one */
    TEST_ASSERT_EQUAL(SLCAN_OUT_BYTES, slcan.out_count);
    takes_most = sizeof from_node;
    from_count = 0;
    slcan_flush(&slcan, &hal);
    TEST_ASSERT_EQUAL(wait, from_count);
    TEST_ASSERT_EQUAL(0, slcan.out_count);
    (void)say("V\r", "V1013\r", &ignored);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_frames_that_come_together_are_taken_one_by_one);
    RUN_TEST(test_a_look_finds_the_frame_behind_other_lines);
    RUN_TEST(test_an_urgent_frame_needs_no_open_channel);
    RUN_TEST(test_commands_are_answered_as_an_adapter_answers_them);
    RUN_TEST(test_a_frame_comes_as_it_was_sent);
    RUN_TEST(test_frames_that_are_none_are_refused);
    RUN_TEST(test_a_line_that_is_too_long_is_refused_once_and_as_a_whole);
    RUN_TEST(test_a_slow_line_gets_every_frame_that_found_room);
    RUN_TEST(test_a_frame_of_can_fd_has_no_text);
    RUN_TEST(test_without_the_port_nothing_comes);
    RUN_TEST(test_a_port_that_fails_loses_nothing);
    RUN_TEST(test_lines_come_in_pieces);
    RUN_TEST(test_replies_that_find_no_room_are_lost_whole);
    return UNITY_END();
}
