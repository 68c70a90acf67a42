/* What a Modbus PDU is made of: how long each request is at least, which exception stands for which refusal, what the
 * server says of itself, and what it counts over TCP. */
#include <stddef.h>

#include "modbus_master.h"
#include "brace/questions.h"
#include "wire/modbus/command.h"
#include "wire/modbus/pdu.h"
#include "wire/modbus/refusal.h"
#include "wire/modbus/write.h"

void setUp(void)
{
    start_unit();
}

void tearDown(void) {}

static void test_how_long_each_request_is_at_least(void)
{
    static const struct {
        uint8_t function;
        uint32_t least;
    } fixed[] = {{3, 5}, {4, 5}, {6, 5}, {8, 5}, {43, 4}, {17, 1}, {1, 1}, {99, 1}, {0, 1}};
    for (uint32_t i = 0; i < sizeof fixed / sizeof *fixed; i++) {
        const uint8_t pdu[8] = {fixed[i].function, 0xff, 0xff, 0xff, 0xff, 0xff};
        TEST_ASSERT_EQUAL(fixed[i].least, modbus_pdu_least_length(pdu, sizeof pdu));
        TEST_ASSERT_EQUAL(fixed[i].least, modbus_pdu_least_length(pdu, 1));
    }
    for (uint32_t bytes = 0; bytes < 250u; bytes += 4u) { /* a block states its length in its sixth byte */
        const uint8_t pdu[6] = {16, 0, 2, 0, (uint8_t)(bytes / 2u), (uint8_t)bytes};
        TEST_ASSERT_EQUAL(6u + bytes, modbus_pdu_least_length(pdu, 6));
        TEST_ASSERT_EQUAL(6u, modbus_pdu_least_length(pdu, 5));
    }
}

static void test_which_exception_stands_for_which_refusal(void)
{
    static const struct {
        int32_t status;
        modbus_exception_t why;
    } row[] = {{BRACE_OK, MODBUS_FINE},
               {ANSWER_LATER, MODBUS_FINE},
               {BRACE_E_MODE, MODBUS_E_FUNCTION},
               {BRACE_E_CHECKSUM, MODBUS_E_VALUE},
               {BRACE_E_RANGE, MODBUS_E_VALUE},
               {BRACE_E_PARAMETER, MODBUS_E_VALUE},
               {BRACE_E_NOT_FINITE, MODBUS_E_VALUE},
               {BRACE_E_UNREACHABLE, MODBUS_E_VALUE},
               {BRACE_REFUSED_CEILING, MODBUS_E_VALUE},
               {BRACE_REFUSED_EARLY, MODBUS_E_BUSY},
               {BRACE_REFUSED_BUSY, MODBUS_E_BUSY},
               {BRACE_REFUSED_STRANGER, MODBUS_E_OWNER},
               {BRACE_REFUSED_REPLAY, MODBUS_E_OWNER},
               {BRACE_REFUSED_OWNED, MODBUS_E_OWNER},
               {BRACE_REFUSED_NO_KEY, MODBUS_E_OWNER},
               {BRACE_E_UNSUPPORTED, MODBUS_E_DEVICE},
               {BRACE_E_SINGULAR, MODBUS_E_DEVICE},
               {BRACE_REFUSED_ORDER, MODBUS_E_DEVICE},
               {-12345, MODBUS_E_DEVICE}};
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        TEST_ASSERT_EQUAL(row[i].why, modbus_refusal_of(row[i].status));
    }
    TEST_ASSERT_EQUAL(MODBUS_E_FUNCTION, modbus_refusal_to_write(&app)); /* not in CONFIGURATION */
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    TEST_ASSERT_EQUAL(MODBUS_FINE, modbus_refusal_to_write(&app));
    brace_parameters_t p = *brace_app_parameters(&app);
    p.limb.femur_mm = 190.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_commit(&app, &p));
    TEST_ASSERT_EQUAL(MODBUS_E_BUSY, modbus_refusal_to_write(&app));
}

/* Function 17: a number of ours, that it runs, and its name with version and dictionary as text. */
static void test_the_server_says_who_it_is(void)
{
    const uint8_t pdu[] = {17}, odd[] = {17, 0};
    const reply_t reply = line_asks(UNIT, pdu, sizeof pdu);
    TEST_ASSERT_GREATER_THAN(20, reply.count);
    TEST_ASSERT_EQUAL_HEX8(17, reply.byte[0]);
    TEST_ASSERT_EQUAL(reply.count - 2u, reply.byte[1]);
    TEST_ASSERT_EQUAL_HEX8(0xb2, reply.byte[2]);
    TEST_ASSERT_EQUAL_HEX8(0xff, reply.byte[3]);
    char text[64] = {0}, hash[9] = {0};
    memcpy(text, reply.byte + 4, reply.count - 4u < 63u ? reply.count - 4u : 63u);
    static const char digits[] = "0123456789abcdef";
    for (uint32_t i = 0; i < 8u; i++) {
        hash[i] = digits[(uint32_t)BRACE_DICTIONARY_HASH >> (28u - 4u * i) & 15u];
    }
    TEST_ASSERT_NOT_NULL(strstr(text, " dictionary "));
    TEST_ASSERT_EQUAL_STRING(hash, strstr(text, " dictionary ") + 12);
    TEST_ASSERT_EQUAL_HEX8(0x91, line_asks(UNIT, odd, sizeof odd).byte[0]);
}

static uint32_t reported_by(uint32_t byte_of_member)
{
    const reply_t reply = read_asks(3, BRACE_REGISTER_COMMANDS + byte_of_member / 2u, 2);
    return value_at(&reply, 0);
}

/* Commands read what has come of them. */
static void test_what_a_command_s_register_reads(void)
{
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, reported_by(offsetof(brace_commands_t, set_mode)));
    TEST_ASSERT_EQUAL(0, reported_by(offsetof(brace_commands_t, clear_faults)));
    TEST_ASSERT_EQUAL(0, reported_by(offsetof(brace_commands_t, commit)));
    TEST_ASSERT_EQUAL(0, reported_by(offsetof(brace_commands_t, let_go)));
    TEST_ASSERT_EQUAL(0, reported_by(offsetof(brace_commands_t, stop)));
    TEST_ASSERT_EQUAL(0, reported_by(offsetof(brace_commands_t, life_heard)));
    TEST_ASSERT_EQUAL(0, reported_by(offsetof(brace_commands_t, seal_mac)));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    ticks(1);
    TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, reported_by(offsetof(brace_commands_t, set_mode)));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_leave(&app));
    ticks(20);
    fake.joint[BRACE_FEMUR].not_newer = true;
    ticks(60);
    TEST_ASSERT_EQUAL_HEX32(now()->faults, reported_by(offsetof(brace_commands_t, clear_faults)));
    TEST_ASSERT_NOT_EQUAL(0, now()->faults);
}

static uint32_t counted_over_tcp(uint8_t code)
{
    const uint8_t pdu[] = {8, 0, code, 0, 0};
    const reply_t reply = tcp_asks(UNIT, pdu, sizeof pdu);
    TEST_ASSERT_EQUAL(5, reply.count);
    return (uint32_t)reply.byte[3] << 8 | reply.byte[4];
}

static void test_what_comes_over_tcp_is_counted_once(void)
{
    const uint8_t k[] = {4, 0, 0, 0, 2}, unknown[] = {99};
    const uint32_t messages = counted_over_tcp(0x0b), served = counted_over_tcp(0x0e);
    TEST_ASSERT_EQUAL(6, tcp_asks(UNIT, k, sizeof k).count);
    TEST_ASSERT_EQUAL(6, tcp_asks(0, k, sizeof k).count);   /* the device itself, */
    TEST_ASSERT_EQUAL(6, tcp_asks(255, k, sizeof k).count); /* either way */
    TEST_ASSERT_EQUAL(2, tcp_asks(UNIT + 1, k, sizeof k).count);
    TEST_ASSERT_EQUAL(2, tcp_asks(UNIT, unknown, sizeof unknown).count);
    /* five, and the two that asked */
    TEST_ASSERT_EQUAL(messages + 7u, counted_over_tcp(0x0b));
    TEST_ASSERT_EQUAL(served + 7u - 1u, counted_over_tcp(0x0e)); /* but that for another unit */
}

/* Each counter of function 08 counts its own events one by one, and one request clears all counters. */
static void test_every_counter_counts_its_own(void)
{
    enum { MESSAGES = 0x0b, BROKEN = 0x0c, REFUSED = 0x0d, SERVED = 0x0e, UNANSWERED = 0x0f, BUSY = 0x11 };
    modbus_server_t *server = &app.wires.modbus.server;
    const uint8_t clear[] = {8, 0, 0x0a, 0, 0};
    TEST_ASSERT_EQUAL(5, tcp_asks(UNIT, clear, sizeof clear).count);
    static const uint8_t codes[] = {MESSAGES, BROKEN, REFUSED, SERVED, UNANSWERED, BUSY, 0x10, 0x12};
    for (uint32_t i = 0; i < sizeof codes; i++) {
        server->messages = 100, server->broken = 200, server->refused = 300;
        server->served = 400, server->unanswered = 500, server->busy = 600;
        const uint32_t reported = counted_over_tcp(codes[i]); /* the request that reads a counter may be counted too */
        TEST_ASSERT_EQUAL(i < 6u ? 100u * (i + 1u) : 0u, reported / 10u * 10u);
    }
    server->busy = 6, server->refused = 5;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app)); /* while the store works it refuses as busy */
    brace_parameters_t p = *brace_app_parameters(&app);
    p.limb.femur_mm = 190.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_commit(&app, &p));
    const uint8_t write[] = {16, 0, 2, 0, 2, 4, 0x43, 0, 0, 0};
    const reply_t reply = tcp_asks(UNIT, write, sizeof write);
    TEST_ASSERT_EQUAL_HEX8(0x90, reply.byte[0]);
    TEST_ASSERT_EQUAL(MODBUS_E_BUSY, reply.byte[1]);
    TEST_ASSERT_EQUAL(7, counted_over_tcp(BUSY));
    TEST_ASSERT_EQUAL(6, counted_over_tcp(REFUSED));
    server->messages = server->broken = server->refused = server->served = server->unanswered = server->busy = 700;
    TEST_ASSERT_EQUAL(5, tcp_asks(UNIT, clear, sizeof clear).count);
    for (uint32_t i = 0; i < sizeof codes; i++) {
        TEST_ASSERT_LESS_THAN(10, counted_over_tcp(codes[i]));
    }
}

/* Function 08 needs at least one whole word after its sub-function. */
static void test_a_diagnosis_has_its_length(void)
{
    static const uint8_t pdu[] = {8, 0, 0, 1, 2, 3, 4, 5, 6};
    for (uint32_t length = 1; length <= sizeof pdu; length++) {
        const reply_t reply = tcp_asks(UNIT, pdu, length);
        if (length >= 5u && length % 2u == 1u) { /* function 08/00 echoes whole words */
            TEST_ASSERT_EQUAL(length, reply.count);
            TEST_ASSERT_EQUAL_HEX8_ARRAY(pdu, reply.byte, length);
        } else {
            TEST_ASSERT_EQUAL(2, reply.count);
            TEST_ASSERT_EQUAL_HEX8(0x88, reply.byte[0]);
            TEST_ASSERT_EQUAL(MODBUS_E_VALUE, reply.byte[1]);
        }
    }
}

/* A request whose function has one length is refused at every other length. */
static void test_a_request_of_another_length_is_none(void)
{
    static const uint8_t functions[] = {3, 4, 6, 8};
    for (uint32_t f = 0; f < sizeof functions; f++) {
        for (uint32_t length = 1; length <= 9u; length++) {
            const uint8_t counter = functions[f] == 8u ? 11u : 0u, one = functions[f] == 8u ? 0u : 1u;
            const uint8_t pdu[9] = {functions[f], 0, counter, 0, one, 0, one, 0, one};
            const reply_t reply = tcp_asks(UNIT, pdu, length);
            if (length != 5u) {
                TEST_ASSERT_EQUAL(2, reply.count);
                TEST_ASSERT_EQUAL_HEX8(functions[f] | 0x80, reply.byte[0]);
                TEST_ASSERT_EQUAL(MODBUS_E_VALUE, reply.byte[1]);
            }
        }
    }
}

/* However a request over TCP is cut, it is answered once when it is whole, and so is the one behind it. */
static void test_a_request_over_tcp_may_come_in_pieces(void)
{
    static const uint8_t adu[] = {0, 1, 0, 0, 0, 6, UNIT, 4, 0, 0, 0, 2};
    for (uint32_t piece = 1; piece <= sizeof adu; piece++) {
        for (int round = 0; round < 2; round++) {
            for (uint32_t at = 0; at < sizeof adu; at += piece) {
                const uint32_t count = sizeof adu - at < piece ? (uint32_t)sizeof adu - at : piece;
                uint8_t sink[16];
                TEST_ASSERT_EQUAL(0, brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS_TCP, sink, sizeof sink));
                TEST_ASSERT_EQUAL(count, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS_TCP, adu + at, count));
                ticks(1);
            }
            TEST_ASSERT_EQUAL(13, heard(BRACE_SERIAL_MODBUS_TCP).count);
        }
    }
}

/* The take-up that has begun last reads as it was written; one that is refused leaves it. */
/* A command's value that stands for none, and a parameter while nothing may be written. */
static void test_a_refused_write_leaves_the_answer_s_length(void)
{
    const wire_tick_t tick = {.app = &app, .hal = &fake.hal, .now_us = fake.now_us};
    static const uint32_t at[] = {BRACE_REGISTER_COMMANDS, 2};
    static const modbus_exception_t why[] = {MODBUS_E_VALUE, MODBUS_E_FUNCTION};
    for (int i = 0; i < 2; i++) {
        modbus_server_t server = app.wires.modbus.server;
        brace_seal_t seal = {.is_there = false};
        uint8_t pdu[MODBUS_PDU_BYTES] = {16, (uint8_t)(at[i] >> 8), (uint8_t)at[i], 0, 2, 4, 0, 0, 0, 0};
        uint32_t answer = 77;
        server.seal = &seal, server.pdu = pdu, server.length = 10;
        TEST_ASSERT_EQUAL(why[i], modbus_write_block(&server, &tick, pdu, 10, &answer));
        TEST_ASSERT_EQUAL(77, answer);
    }
}

/* The check of a long answer is worked out while it leaves: of 255 bytes no more than 48 and a few leave at once. */
static void test_a_long_answer_leaves_in_parts(void)
{
    const uint8_t pdu[] = {UNIT, 4, 0, 0, 0, 124};
    uint8_t frame[8], all[260];
    memcpy(frame, pdu, sizeof pdu);
    const uint32_t crc = crc_by_bits(frame, sizeof pdu);
    frame[6] = (uint8_t)crc, frame[7] = (uint8_t)(crc >> 8);
    line_says(frame, sizeof frame);
    uint32_t count = 0;
    for (int i = 0; i < ANSWER_TICKS && count < 253u; i++) {
        ticks(1);
        const uint32_t more =
            brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS, all + count, (uint32_t)sizeof all - count);
        TEST_ASSERT_LESS_OR_EQUAL(60, more);
        count += more;
    }
    TEST_ASSERT_EQUAL(253, count);
    TEST_ASSERT_EQUAL_HEX16(0, crc_by_bits(all, count));
}

static void test_a_take_up_that_began_reads_back(void)
{
    const uint32_t place = (uint32_t)offsetof(brace_commands_t, take_up), tibia_positive = 0x102u;
    brace_parameters_t p = bench_parameters();
    p.controller.modbus_address = UNIT;
    p.limb.joint[BRACE_TIBIA].gap_rad = 0.005f;
    bench_start(&p);
    ticks(50);
    const uint32_t before = reported_by(place);
    refused(write_value(BRACE_REGISTER_COMMANDS + place / 2u, 0x302u), 16, MODBUS_E_VALUE); /* no such flank */
    TEST_ASSERT_EQUAL_HEX32(before, reported_by(place));
    TEST_ASSERT_EQUAL(5, write_value(BRACE_REGISTER_COMMANDS + place / 2u, tibia_positive).count);
    TEST_ASSERT_EQUAL_HEX32(tibia_positive, reported_by(place));
    TEST_ASSERT_EQUAL(2, write_value(BRACE_REGISTER_COMMANDS + place / 2u, 0x201u).count); /* no play there */
    TEST_ASSERT_EQUAL_HEX32(tibia_positive, reported_by(place));
}

/* A question puts out those that are answered in the same registers, and no others. */
static void test_a_question_puts_out_its_own_kind(void)
{
    int taken = 0;
    for (uint32_t q = 0; q < (uint32_t)BRACE_QUESTION_COUNT; q++) {
        const brace_question_t *question = &brace_questions[q];
        uint32_t words[16], *written = (uint32_t *)&app.wires.modbus.server.written;
        setUp();
        for (uint32_t i = 0; i < sizeof app.wires.modbus.server.written / 4u; i++) {
            written[i] = 0x5a5a5a5au;
        }
        for (uint32_t i = 0; i < question->count; i++) { /* a posture, a tip within reach, small forces */
            words[i] = bits(question->codes > 1u ? 200.0f : 0.5f);
        }
        words[question->count - 1u] = question->codes > 1u ? 0u : words[question->count - 1u];
        const reply_t reply = write_values(BRACE_REGISTER_COMMANDS + 2u * question->first, words, question->count);
        if (reply.count != 5u) {
            continue; /* refused */
        }
        taken++;
        for (uint32_t o = 0; o < (uint32_t)BRACE_QUESTION_COUNT; o++) {
            const brace_question_t *other = &brace_questions[o];
            const bool stays = other->answer_first != question->answer_first;
            for (uint32_t i = 0; i < other->count && o != q; i++) {
                TEST_ASSERT_EQUAL(stays, written[other->first + i] == 0x5a5a5a5au);
            }
        }
        TEST_ASSERT_EQUAL_HEX32_ARRAY(words, written + question->first, question->count);
    }
    TEST_ASSERT_GREATER_THAN(5, taken);
}

/* Before anybody has asked, every register of the question and of the answer says: not known. */
static void test_questions_that_nobody_asked_read_as_not_known(void)
{
    for (uint32_t q = 0; q < (uint32_t)BRACE_QUESTION_COUNT; q++) {
        const brace_question_t *question = &brace_questions[q];
        for (uint32_t i = 0; i < question->count; i++) {
            uint32_t wanted;
            memcpy(&wanted, (const uint8_t *)&brace_commands_unknown + 4u * (question->first + i), 4);
            TEST_ASSERT_EQUAL_HEX32(wanted, reported_by(4u * (question->first + i)));
        }
    }
}

/* What nobody must write by mistake needs its key above and its value below; neither is enough. */
static void test_keyed_commands_need_key_and_value(void)
{
    static const struct {
        uint32_t place, value;
    } row[] = {{offsetof(brace_commands_t, set_mode), BRACE_MODE_CONFIGURATION},
               {offsetof(brace_commands_t, commit), 1},
               {offsetof(brace_commands_t, rollback), 1}};
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        const uint32_t at = BRACE_REGISTER_COMMANDS + row[i].place / 2u;
        refused(write_value(at, row[i].value), 16, MODBUS_E_VALUE);
        refused(write_value(at, 0xc0de0000u), 16, MODBUS_E_VALUE);
        refused(write_value(at, 0xc0de0000u | 9u), 16, MODBUS_E_VALUE);
        refused(write_value(at, 0xc0df0000u | row[i].value), 16, MODBUS_E_VALUE);
        TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, brace_app_mode(&app));
    }
    TEST_ASSERT_EQUAL(5, write_value(BRACE_REGISTER_COMMANDS + row[0].place / 2u, 0xc0de0000u | row[0].value).count);
    TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, brace_app_mode(&app));
    brace_store_status_t store;
    TEST_ASSERT_EQUAL(5, write_value(BRACE_REGISTER_COMMANDS + row[2].place / 2u, 0xc0de0001u).count);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_store_status(&app, &store));
    TEST_ASSERT_EQUAL(BRACE_STORE_E_NOTHING, store.failure); /* it was asked to go back, and there is nothing */
}

/* One register of a value may be read alone: its upper or its lower half, in every area. */
static void test_half_a_value_is_read_alone(void)
{
    static const struct {
        uint8_t function;
        uint32_t first, values;
    } area[] = {
        {4, 0, 20}, {3, BRACE_REGISTER_COMMANDS, sizeof(brace_commands_t) / 4u}, {3, 0, BRACE_PARAMETER_NUMBERS}};
    for (uint32_t i = 0; i < sizeof area / sizeof *area; i++) {
        uint32_t differs = 0;
        for (uint32_t place = 0; place < area[i].values; place++) {
            const uint32_t at = area[i].first + 2u * place;
            const reply_t whole = read_asks(area[i].function, at, 2), upper = read_asks(area[i].function, at, 1),
                          lower = read_asks(area[i].function, at + 1u, 1);
            if (whole.count != 6u) {
                continue; /* none is there */
            }
            TEST_ASSERT_EQUAL(4, upper.count);
            TEST_ASSERT_EQUAL(4, lower.count);
            if (area[i].function == 3) { /* what is measured may change meanwhile */
                TEST_ASSERT_EQUAL_HEX8_ARRAY(whole.byte + 2, upper.byte + 2, 2);
                TEST_ASSERT_EQUAL_HEX8_ARRAY(whole.byte + 4, lower.byte + 2, 2);
            }
            differs += memcmp(whole.byte + 2, whole.byte + 4, 2) != 0;
        }
        TEST_ASSERT_GREATER_THAN(0, differs);
    }
}

/* A request over Modbus is of this tick and of the master that asks, and a seal is checked over all its bytes. */
static void test_what_a_request_carries(void)
{
    const uint8_t pdu[] = {6, 0x40, 0, 0xc0, 0xde};
    brace_seal_t seal = {.is_there = true};
    brace_measured_t measured;
    const modbus_server_t server = {.asker = BRACE_ASKER_MODBUS_TCP,
                                    .who = {BRACE_ASKER_MODBUS_TCP, 3},
                                    .seal = &seal,
                                    .pdu = pdu,
                                    .length = sizeof pdu};
    const wire_tick_t tick = {.hal = &fake.hal, .app = &app, .measured = &measured, .now_us = 7};
    const request_t request = modbus_request(&server, &tick);
    TEST_ASSERT_EQUAL_PTR(&app, request.app);
    TEST_ASSERT_EQUAL_PTR(&measured, request.measured);
    TEST_ASSERT_EQUAL(BRACE_ASKER_MODBUS_TCP, request.asker);
    TEST_ASSERT_EQUAL(BRACE_ASKER_MODBUS_TCP, request.who.port);
    TEST_ASSERT_EQUAL(3, request.who.master);
    TEST_ASSERT_EQUAL_PTR(&seal, request.seal);
    TEST_ASSERT_EQUAL_PTR(pdu, request.bytes);
    TEST_ASSERT_EQUAL(sizeof pdu, request.count);
    TEST_ASSERT_NULL(request.asked_force); /* these are of CAN */
    TEST_ASSERT_NULL(request.upload);
    TEST_ASSERT_NULL(request.download);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_how_long_each_request_is_at_least);
    RUN_TEST(test_which_exception_stands_for_which_refusal);
    RUN_TEST(test_the_server_says_who_it_is);
    RUN_TEST(test_what_a_command_s_register_reads);
    RUN_TEST(test_what_comes_over_tcp_is_counted_once);
    RUN_TEST(test_every_counter_counts_its_own);
    RUN_TEST(test_a_diagnosis_has_its_length);
    RUN_TEST(test_a_request_of_another_length_is_none);
    RUN_TEST(test_a_request_over_tcp_may_come_in_pieces);
    RUN_TEST(test_a_refused_write_leaves_the_answer_s_length);
    RUN_TEST(test_a_long_answer_leaves_in_parts);
    RUN_TEST(test_a_take_up_that_began_reads_back);
    RUN_TEST(test_a_question_puts_out_its_own_kind);
    RUN_TEST(test_questions_that_nobody_asked_read_as_not_known);
    RUN_TEST(test_keyed_commands_need_key_and_value);
    RUN_TEST(test_half_a_value_is_read_alone);
    RUN_TEST(test_what_a_request_carries);
    return UNITY_END();
}
