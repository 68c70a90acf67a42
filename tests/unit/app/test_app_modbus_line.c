/* The controller as a Modbus server: frames that are broken, halved, too long, for others; floods;
 * TCP beside the line. */
#include "modbus_master.h"

void setUp(void)
{
    start_unit();
}

void tearDown(void) {}

static uint32_t broken(void)
{
    return counters().modbus_broken;
}

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
    TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, app.controller.mode.now);
    uint8_t first[] = {6, 0x40, 0, 0xc0, 0xde}, second[] = {6, 0x40, 1, 0, 1}; /* the way back, in two halves */
    TEST_ASSERT_EQUAL(0, line_asks(0, first, sizeof first).count);
    TEST_ASSERT_EQUAL(0, line_asks(0, second, sizeof second).count);
    TEST_ASSERT_NOT_EQUAL(BRACE_MODE_CONFIGURATION, app.controller.mode.now);
    /* Nobody could know who has read: what everybody is asked for is not even looked up. */
    const uint8_t nowhere[] = {4, 0xff, 0xf0, 0, 2};
    const uint16_t refused = app.wires.modbus.server.refused, unanswered = app.wires.modbus.server.unanswered;
    TEST_ASSERT_EQUAL(0, line_asks(0, nowhere, sizeof nowhere).count);
    TEST_ASSERT_EQUAL(refused, app.wires.modbus.server.refused);
    TEST_ASSERT_EQUAL(unanswered + 1, app.wires.modbus.server.unanswered);
}

/* A unit on a line of so many bits a second. */
static void is_asked_for_sixty_values(uint32_t baud, uint32_t tick_us)
{
    brace_parameters_t p = bench_parameters();
    p.controller.modbus_address = UNIT;
    p.controller.modbus_baud = baud;
    p.controller.tick_us = tick_us;
    bench_start(&p);
    uint8_t ask[8] = {UNIT, 4, 0, 0, 0, 120};
    const uint32_t crc = crc_by_bits(ask, 6);
    ask[6] = (uint8_t)crc, ask[7] = (uint8_t)(crc >> 8);
    line_says(ask, sizeof ask);
}

/* However slow the ticks are, the port has always more of an answer than the line carries until the next one: a gap of
 * one and a half characters would tear the frame. */
static void test_an_answer_leaves_without_a_gap(void)
{
    enum { SLOW_TICK_US = 5000, BAUD = 115200, BITS = 11, WHOLE = 1 + 2 + 4 * 60 + 2 };
    is_asked_for_sixty_values(BAUD, SLOW_TICK_US);
    const double a_tick = (double)SLOW_TICK_US * 1e-6 * BAUD / BITS;
    uint32_t in_port = 0;
    double on_line = 0.0;
    for (int i = 0; i < 60 && in_port < (uint32_t)WHOLE; i++) {
        uint8_t sink[300];
        fake.now_us += SLOW_TICK_US;
        brace_app_tick(&app, fake.now_us);
        in_port += brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS, sink, sizeof sink);
        on_line = in_port > 0u ? on_line + a_tick : 0.0; /* until the next tick */
        TEST_ASSERT_TRUE(in_port == 0u || in_port == (uint32_t)WHOLE || (double)in_port > on_line);
    }
    TEST_ASSERT_EQUAL(WHOLE, in_port);
}

/* What a tick works on is bounded: 48 bytes more than the line carries until the next one, and one for rounding. */
static void test_a_tick_makes_no_more_of_an_answer_ready_than_it_needs(void)
{
    enum { BAUD = 9600, BITS = 11 };
    is_asked_for_sixty_values(BAUD, TICK_US);
    uint32_t came = 0;
    for (int i = 0; i < 60 && came == 0u; i++) {
        uint8_t sink[300];
        fake.now_us += TICK_US;
        brace_app_tick(&app, fake.now_us);
        came = brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS, sink, sizeof sink);
    }
    TEST_ASSERT_TRUE(came > 0u && came <= 48u + BAUD / (1000u * BITS) + 1u);
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

/* Lengths that no request has, below and above, on their own and behind a good one. */
static void test_lengths_that_no_request_has_are_dropped_on_tcp(void)
{
    static const uint32_t lengths[] = {0, 1, 255, 0xffff};
    const uint8_t read[] = {4, 0, 0, 0, 2};
    for (uint32_t i = 0; i < 4u; i++) {
        const uint8_t odd[] = {0, 1, 0, 0, (uint8_t)(lengths[i] >> 8), (uint8_t)lengths[i], UNIT, 4, 0, 0, 0, 2};
        (void)brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS_TCP, odd, sizeof odd);
        TEST_ASSERT_EQUAL(0, heard(BRACE_SERIAL_MODBUS_TCP).count);
        TEST_ASSERT_EQUAL(i + 1u, broken());
        TEST_ASSERT_EQUAL(6, tcp_asks(UNIT, read, sizeof read).count);
    }
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

/* -------------------------------------------------------------------- a receiver that hears its own controller -- */

static uint32_t with_crc(uint8_t *frame, uint32_t count)
{
    const uint32_t crc = crc_by_bits(frame, count);
    frame[count] = (uint8_t)crc;
    frame[count + 1u] = (uint8_t)(crc >> 8);
    return count + 2u;
}

/* Plays `count` ticks; what the controller sends comes back to it, as on a transceiver whose receiver stays on.
 * returns how many bytes it has sent */
static uint32_t sent_on_a_line_with_echo(const uint8_t *frame, uint32_t count, int tick_count)
{
    uint32_t sent = 0;
    line_says(frame, count);
    for (int i = 0; i < tick_count; i++) {
        uint8_t bytes[64];
        ticks(1);
        const uint32_t got = brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS, bytes, sizeof bytes);
        line_says(bytes, got);
        sent += got;
    }
    return sent;
}

static void test_an_answer_that_comes_back_is_not_answered(void)
{
    uint8_t first_half[8] = {UNIT, 6, 0x40, 0, 0xc0, 0xde}, ping[8] = {UNIT, 8, 0, 0, 0xa5, 0x37};
    (void)with_crc(first_half, 6);
    (void)with_crc(ping, 6);
    for (int round = 0; round < 3; round++) { /* at first the controller does not know the line's echo */
        TEST_ASSERT_EQUAL(8, sent_on_a_line_with_echo(ping, 8, 300));
        TEST_ASSERT_EQUAL(8, sent_on_a_line_with_echo(ping, 8, 300));
        TEST_ASSERT_EQUAL(8, sent_on_a_line_with_echo(first_half, 8, 300));
        TEST_ASSERT_EQUAL(9, sent_on_a_line_with_echo(good, sizeof good, 300));
    }
    TEST_ASSERT_EQUAL(0, broken());
    TEST_ASSERT_EQUAL(0, counters().modbus_refused);
}

/* A line that had no echo is wired otherwise: whatever was answered last, the next answer that comes back is not taken
 * for a request. Only a request that may look the same is answered once more. */
static void test_a_line_may_begin_to_echo(void)
{
    uint8_t block[15] = {UNIT, 16, 0, 2, 0, 2, 4, 0x43, 0x3e, 0, 0}, read[8] = {UNIT, 4, 0, 0, 0, 2};
    uint8_t who[4] = {UNIT, 17}, device[7] = {UNIT, 43, 14, 1, 0};
    const struct {
        uint8_t *frame;
        uint32_t count;
    } asked[] = {{block, with_crc(block, 11)},
                 {read, with_crc(read, 6)},
                 {who, with_crc(who, 2)},
                 {device, with_crc(device, 5)}};
    for (uint32_t i = 0; i < sizeof asked / sizeof *asked; i++) {
        setUp();
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
        TEST_ASSERT_TRUE(answers()); /* and nothing came back: this line has no echo */
        TEST_ASSERT_TRUE(answers());
        line_says(asked[i].frame, asked[i].count);
        const uint32_t once = heard(BRACE_SERIAL_MODBUS).count;
        TEST_ASSERT_GREATER_THAN(5, once); /* no exception */
        TEST_ASSERT_EQUAL(once, sent_on_a_line_with_echo(asked[i].frame, asked[i].count, 120));
        TEST_ASSERT_EQUAL(0, sent_on_a_line_with_echo(read, 0, 50)); /* and it is silent then */
        uint8_t ping[8] = {UNIT, 8, 0, 0, 0xa5, 0x37};
        (void)with_crc(ping, 6);
        TEST_ASSERT_EQUAL(8, sent_on_a_line_with_echo(ping, 8, 120)); /* now it knows the echo */
    }
}

/* A port that cannot be set up is not read. */
static void test_a_port_that_does_not_start_is_none(void)
{
    brace_fake_fail_next(&fake, BRACE_FAKE_SERIAL_SETUP, 100, BRACE_HAL_E_DEVICE);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    TEST_ASSERT_FALSE(app.wires.modbus.line.link.is_fitted);
    TEST_ASSERT_FALSE(app.wires.modbus.tcp.link.is_fitted);
    const uint32_t reads = fake.calls[BRACE_FAKE_SERIAL_READ];
    ticks(50);
    TEST_ASSERT_EQUAL(reads, fake.calls[BRACE_FAKE_SERIAL_READ]);
}

static void test_a_request_that_is_repeated_is_answered_each_time(void)
{
    TEST_ASSERT_TRUE(answers()); /* and nothing came back: this line has no echo */
    TEST_ASSERT_TRUE(answers());
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL(5, write_one(0x4000, 0xc0de).count);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_sample_frame_is_good);
    RUN_TEST(test_any_bit_wrong_is_no_request);
    RUN_TEST(test_part_of_a_frame_is_dropped_and_counted);
    RUN_TEST(test_a_frame_may_come_in_parts_that_an_adapter_holds_back);
    RUN_TEST(test_frames_too_long_are_dropped_whole);
    RUN_TEST(test_two_frames_without_silence_are_none);
    RUN_TEST(test_others_requests_and_their_answers_pass);
    RUN_TEST(test_everybody_obeys_and_nobody_answers);
    RUN_TEST(test_an_answer_leaves_without_a_gap);
    RUN_TEST(test_a_tick_makes_no_more_of_an_answer_ready_than_it_needs);
    RUN_TEST(test_a_line_that_takes_nothing_does_not_hold_it);
    RUN_TEST(test_a_flood_stops_nothing);
    RUN_TEST(test_tcp_answers_the_same);
    RUN_TEST(test_tcp_and_line_at_once_do_not_mix);
    RUN_TEST(test_what_is_no_modbus_on_tcp_is_dropped);
    RUN_TEST(test_lengths_that_no_request_has_are_dropped_on_tcp);
    RUN_TEST(test_a_slow_line_waits_its_silence);
    RUN_TEST(test_an_answer_that_comes_back_is_not_answered);
    RUN_TEST(test_a_line_may_begin_to_echo);
    RUN_TEST(test_a_port_that_does_not_start_is_none);
    RUN_TEST(test_a_request_that_is_repeated_is_answered_each_time);
    return UNITY_END();
}
