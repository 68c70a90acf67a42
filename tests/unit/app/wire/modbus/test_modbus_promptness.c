/* Modbus by itself, with a controller that only notes what it is asked: every request is answered in the tick that
 * finds it whole, whatever the other port is flooded with. A long answer leaves the line's port in parts, ahead of what
 * the line carries. */
#include <stdio.h>
#include <string.h>

#include "brace_hal_fake.h"
#include "modbus_crc.h"
#include "unity.h"
#include "wire/answers/answer.h"
#include "wire/modbus/modbus.h"

enum { UNIT = 17, TICK_US = 1000, SILENT_TICKS = 2 /* 1.75 ms */, BLOCK = 61, ADU_BYTES = 260 };

struct brace_app {
    brace_parameters_t staged;
    brace_snapshot_t snapshot;
    brace_mode_t mode;
    uint32_t blocks; /* staged */
};

static brace_fake_t fake;
static brace_app_t controller;
static brace_app_counters_t counters;
static brace_measured_t measured;
static modbus_t modbus;

/* ------------------------------------------------------------------------------------- the controller -- */

const brace_snapshot_t *brace_app_snapshot(const brace_app_t *asked)
{
    return &asked->snapshot;
}
brace_mode_t brace_app_mode(const brace_app_t *asked)
{
    return asked->mode;
}
uint32_t brace_app_faults(const brace_app_t *asked)
{
    return (void)asked, 0;
}
const brace_parameters_t *brace_app_parameters_staged(const brace_app_t *asked)
{
    return &asked->staged;
}
const brace_parameters_t *brace_app_parameters(const brace_app_t *asked)
{
    return &asked->staged;
}
bool brace_app_is_storing(const brace_app_t *asked)
{
    return (void)asked, false;
}
brace_setting_t brace_app_setting(const brace_app_t *asked)
{
    return (void)asked, BRACE_SETTING_BENCH;
}

int32_t brace_app_life(brace_app_t *asked, brace_who_t who, const brace_sign_t *sign)
{
    (void)asked;
    (void)who;
    return (void)sign, BRACE_OK;
}

int32_t brace_app_may_command(brace_app_t *asked, brace_command_t command, brace_who_t who, const brace_seal_t *seal,
                              const uint8_t *bytes, uint32_t count)
{
    (void)asked;
    (void)command;
    (void)who;
    (void)seal;
    (void)bytes;
    return (void)count, BRACE_OK;
}

static uint32_t stops;

brace_status_t brace_app_stop(brace_app_t *asked)
{
    (void)asked;
    stops++;
    return BRACE_OK;
}

bool brace_app_k_is_coming(brace_app_t *asked, brace_asker_t asker)
{
    return (void)asked, (void)asker, false;
}

brace_status_t brace_app_store_status(const brace_app_t *asked, brace_store_status_t *status)
{
    (void)asked;
    *status = (brace_store_status_t){.state = BRACE_STORE_IDLE};
    return BRACE_OK;
}

brace_status_t brace_app_may_write(brace_app_t *asked)
{
    return asked->mode == BRACE_MODE_CONFIGURATION ? BRACE_OK : BRACE_E_MODE;
}

brace_status_t brace_app_parameters_stage(brace_app_t *asked, uint32_t first, uint32_t count, const uint32_t *words)
{
    TEST_ASSERT_LESS_OR_EQUAL(BRACE_PARAMETER_COUNT, first + count);
    memcpy((uint8_t *)&asked->staged + 4u * first, words, 4u * count);
    asked->blocks++;
    return BRACE_OK;
}

int32_t answer_request(request_t *request, uint32_t code, const brace_request_t *asked, brace_answer_t *answer)
{
    switch (code) {
    case BRACE_REQUEST_SET_MODE: request->app->mode = BRACE_MODE_CONFIGURATION; return BRACE_OK;
    case BRACE_REQUEST_CLEAR: return BRACE_OK;
    case BRACE_REQUEST_K_AT_POSTURE:
        answer->k_at_posture = (brace_k_at_posture_answer_t){.k_xx_n_per_mm = asked->k_at_posture.theta1_rad,
                                                             .k_zz_n_per_mm = asked->k_at_posture.theta2_rad};
        return BRACE_OK;
    case BRACE_REQUEST_K_AT_TIP_KNEE_UP:
    case BRACE_REQUEST_K_AT_TIP_KNEE_DOWN: return BRACE_E_UNREACHABLE;
    case BRACE_REQUEST_COMMIT: return BRACE_E_PARAMETER;
    case BRACE_REQUEST_LET_GO: return BRACE_E_MODE;
    default: return BRACE_E_UNSUPPORTED;
    }
}

/* --------------------------------------------------------------------------------------------- ports -- */

typedef struct {
    uint8_t byte[ADU_BYTES];
    uint32_t count;
} bytes_t;

void setUp(void)
{
    brace_parameters_t parameters;
    brace_parameters_default(&parameters);
    parameters.controller.modbus_address = UNIT;
    parameters.controller.modbus_baud = 115200;
    brace_fake_start(&fake);
    controller = (brace_app_t){.mode = BRACE_MODE_MONITOR, .staged = parameters};
    counters = (brace_app_counters_t){0};
    measured = (brace_measured_t){.probe_u32 = 0x01020304u};
    modbus_start(&modbus, &fake.hal, &parameters);
}

void tearDown(void) {}

static void tick(void)
{
    fake.now_us += TICK_US;
    const wire_tick_t now = {&fake.hal, &controller, &counters, &measured, fake.now_us};
    uint32_t done = 0;
    (void)modbus_hear(&modbus, &now, &done);
    (void)modbus_answer(&modbus, &now, true);
}

static bytes_t heard(brace_serial_port_t port)
{
    bytes_t bytes;
    bytes.count = brace_fake_bytes_take(&fake, port, bytes.byte, sizeof bytes.byte);
    return bytes;
}

static void line_asks(const uint8_t *pdu, uint32_t count)
{
    uint8_t frame[ADU_BYTES] = {UNIT};
    memcpy(frame + 1, pdu, count);
    const uint32_t crc = crc_by_bits(frame, count + 1u);
    frame[count + 1u] = (uint8_t)crc;
    frame[count + 2u] = (uint8_t)(crc >> 8);
    TEST_ASSERT_EQUAL(count + 3u, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS, frame, count + 3u));
}

static void tcp_asks(uint8_t transaction, const uint8_t *pdu, uint32_t count)
{
    uint8_t adu[ADU_BYTES] = {0, transaction, 0, 0, (uint8_t)((count + 1u) >> 8), (uint8_t)(count + 1u), UNIT};
    memcpy(adu + 7, pdu, count);
    TEST_ASSERT_EQUAL(count + 7u, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS_TCP, adu, count + 7u));
}

static void line_answers(uint8_t function, uint32_t pdu_bytes)
{
    bytes_t answer = heard(BRACE_SERIAL_MODBUS);
    const uint32_t line_bytes = 115200u / 11u / 1000u + 1u; /* in a tick */
    for (uint32_t ticks = 1; answer.count < pdu_bytes + 3u && ticks < 6u; ticks++) {
        TEST_ASSERT_GREATER_THAN(ticks * line_bytes, answer.count);
        tick();
        const bytes_t more = heard(BRACE_SERIAL_MODBUS);
        memcpy(answer.byte + answer.count, more.byte, more.count);
        answer.count += more.count;
    }
    TEST_ASSERT_EQUAL(pdu_bytes + 3u, answer.count);
    TEST_ASSERT_EQUAL_HEX8(function, answer.byte[1]);
    TEST_ASSERT_EQUAL_HEX16(0, crc_by_bits(answer.byte, answer.count));
}

static void tcp_answers(uint8_t transaction, uint8_t function, uint32_t pdu_bytes)
{
    const bytes_t answer = heard(BRACE_SERIAL_MODBUS_TCP);
    TEST_ASSERT_EQUAL(pdu_bytes + 7u, answer.count);
    TEST_ASSERT_EQUAL_HEX8(transaction, answer.byte[1]);
    TEST_ASSERT_EQUAL_HEX8(function, answer.byte[7]);
}

/* ------------------------------------------------------------------------------------------- requests -- */

static uint32_t block_of(uint8_t *pdu, uint32_t value)
{
    const uint8_t head[] = {16, 0, 0, 0, 2 * BLOCK, 4 * BLOCK};
    memcpy(pdu, head, sizeof head);
    for (uint32_t i = 0; i < BLOCK; i++) {
        const uint8_t word[] = {(uint8_t)(value >> 24), (uint8_t)(value >> 16), (uint8_t)(value >> 8), (uint8_t)value};
        memcpy(pdu + sizeof head + 4u * i, word, sizeof word);
    }
    return sizeof head + 4u * BLOCK;
}

static const uint8_t longest_read[] = {3, 0, 0, 0, 125};

/* ---------------------------------------------------------------------------------------------- tests -- */

/* Four questions of a connection wait, one is answered in each tick. Those behind are refused as busy at once. */
static void test_tcp_answers_a_question_a_tick_and_refuses_what_finds_no_room(void)
{
    enum { ASKED = 10, REFUSAL_BYTES = 9 };
    for (uint8_t i = 0; i < ASKED; i++) {
        tcp_asks(i, longest_read, sizeof longest_read);
    }
    for (uint8_t i = 0; i < MODBUS_QUESTIONS_EACH; i++) {
        tick();
        for (uint8_t k = MODBUS_QUESTIONS_EACH; i == 0u && k < ASKED; k++) {
            uint8_t refusal[REFUSAL_BYTES];
            TEST_ASSERT_EQUAL(REFUSAL_BYTES,
                              brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS_TCP, refusal, REFUSAL_BYTES));
            TEST_ASSERT_EQUAL_HEX8(k, refusal[1]);
            TEST_ASSERT_EQUAL_HEX8(0x83, refusal[7]);
            TEST_ASSERT_EQUAL_HEX8(6, refusal[8]);
        }
        tcp_answers(i, 3, 252);
    }
    tick();
    TEST_ASSERT_EQUAL(0, heard(BRACE_SERIAL_MODBUS_TCP).count);
    TEST_ASSERT_EQUAL(ASKED - MODBUS_QUESTIONS_EACH, counters.questions_busy);
}

static void test_the_line_answers_in_the_tick_in_which_silence_ends_a_request(void)
{
    for (uint32_t i = 0; i < 20u; i++) {
        line_asks(longest_read, sizeof longest_read);
        for (uint32_t silent = 0; silent < SILENT_TICKS; silent++) {
            tick();
            TEST_ASSERT_EQUAL(0, heard(BRACE_SERIAL_MODBUS).count);
        }
        tick();
        line_answers(3, 252);
    }
}

static void test_a_flood_by_tcp_does_not_delay_the_line_nor_the_reverse(void)
{
    uint8_t pdu[ADU_BYTES];
    const uint8_t configure[] = {16, 0x40, 0, 0, 2, 4, 0xc0, 0xde, 0, 2};
    tcp_asks(0, configure, sizeof configure);
    tick();
    tcp_answers(0, 16, 5);
    uint32_t blocks = 0;
    for (uint8_t i = 1; i < 200u; i++) {
        const uint32_t at = i % (SILENT_TICKS + 1u);
        const uint32_t length = block_of(pdu, 0x3f800000u + i);
        tcp_asks(i, pdu, length);
        if (at == 0u) {
            line_asks(pdu, length);
        }
        tick();
        blocks++;
        tcp_answers(i, 16, 5);
        if (at == SILENT_TICKS && i > SILENT_TICKS) {
            blocks++;
            line_answers(16, 5);
        } else {
            TEST_ASSERT_EQUAL(0, heard(BRACE_SERIAL_MODBUS).count);
        }
        TEST_ASSERT_EQUAL(blocks, controller.blocks);
    }
    TEST_ASSERT_EQUAL(0, counters.modbus_refused + counters.modbus_broken);
}

/* 61 parameters come in one request and are all there when it is answered. */
static void test_a_block_is_written_in_one_tick(void)
{
    uint8_t pdu[ADU_BYTES];
    const uint32_t length = block_of(pdu, 0x40490fdbu);
    tcp_asks(1, pdu, length);
    tick();
    tcp_answers(1, 0x90, 2);
    TEST_ASSERT_EQUAL(0, controller.blocks);
    controller.mode = BRACE_MODE_CONFIGURATION;
    tcp_asks(2, pdu, length);
    tick();
    tcp_answers(2, 16, 5);
    for (uint32_t i = 0; i < BLOCK; i++) {
        uint32_t word;
        memcpy(&word, (const uint8_t *)&controller.staged + 4u * i, sizeof word);
        TEST_ASSERT_EQUAL_HEX32(0x40490fdbu, word);
    }
}

static void test_a_question_is_answered_before_the_next_request(void)
{
    const uint8_t ask[] = {16, 0x40, 12, 0, 4, 8, 0x3f, 0x80, 0, 0, 0x40, 0, 0, 0}, read[] = {4, 0x10, 0, 0, 6};
    tcp_asks(1, ask, sizeof ask);
    tcp_asks(2, read, sizeof read);
    tick();
    tcp_answers(1, 16, 5);
    tick();
    const bytes_t answer = heard(BRACE_SERIAL_MODBUS_TCP);
    const uint8_t k[] = {4, 12, 0x3f, 0x80, 0, 0, 0, 0, 0, 0, 0x40, 0, 0, 0};
    TEST_ASSERT_EQUAL(7u + sizeof k, answer.count);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(k, answer.byte + 7, sizeof k);
}

/* A long answer that the port takes in parts goes on leaving, and the other port answers meanwhile. */
/* An answer that its connection does not take is lost and counted: nobody waits for it. */
static void test_a_port_that_takes_nothing_holds_up_nobody(void)
{
    tcp_asks(1, longest_read, sizeof longest_read);
    brace_fake_fail_next(&fake, BRACE_FAKE_SERIAL_WRITE, 1, BRACE_HAL_E_DEVICE);
    tick();
    TEST_ASSERT_EQUAL(0, heard(BRACE_SERIAL_MODBUS_TCP).count);
    tcp_asks(2, longest_read, sizeof longest_read);
    tick();
    tcp_answers(2, 3, 252);
    TEST_ASSERT_EQUAL(1, counters.requests_lost);
}

static void test_noise_on_the_line_does_not_delay_tcp(void)
{
    uint8_t noise[64];
    uint32_t state = 1;
    for (uint8_t i = 0; i < 200u; i++) {
        for (uint32_t k = 0; k < sizeof noise; k++) {
            state = state * 1664525u + 1013904223u;
            noise[k] = (uint8_t)(state >> 24);
        }
        (void)brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS, noise, sizeof noise);
        tcp_asks(i, longest_read, sizeof longest_read);
        tick();
        tcp_answers(i, 3, 252);
    }
    for (int i = 0; i < 5; i++) {
        tick();
    }
    line_asks(longest_read, sizeof longest_read);
    tick(), tick(), tick();
    line_answers(3, 252);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_tcp_answers_a_question_a_tick_and_refuses_what_finds_no_room);
    RUN_TEST(test_the_line_answers_in_the_tick_in_which_silence_ends_a_request);
    RUN_TEST(test_a_flood_by_tcp_does_not_delay_the_line_nor_the_reverse);
    RUN_TEST(test_a_block_is_written_in_one_tick);
    RUN_TEST(test_a_question_is_answered_before_the_next_request);
    RUN_TEST(test_a_port_that_takes_nothing_holds_up_nobody);
    RUN_TEST(test_noise_on_the_line_does_not_delay_tcp);
    return UNITY_END();
}
