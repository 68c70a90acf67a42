/* Whole sessions that are held up on their way and come in one piece or in many, long after their sender gave up: by a
 * stalled connection, a radio link, a gateway. No set-point may move by them, on a guarded board or on a bench.
 *
 * The enemy is stronger than a link can be. Each session is recorded from a controller that it does move, and the
 * controller is set back to where the session began, so that every number and every check in it would have been right.
 * The link may break off anywhere in it: what came before has come in time. Everything behind comes later, twice in
 * places, and perhaps into the session of somebody else or of the same master.
 *
 *   test_late        a few hundred bursts
 *   test_late 1000   so many for a bench and as many for a guarded board */
#include <stdlib.h>

#include "attack.h"

enum {
    MESSAGES_MOST = 700,
    MESSAGE_BYTES = 32,
    PIECES_MOST = 50,
    LIFE_MS = 40,
    SHORT_ROUNDS = 96,
    OTHER_TOKEN = 0x50,
    PEER = 7
};

typedef enum { BY_CAN, BY_TEXT, BY_TCP, BY_LINE, WAYS } way_t;
static const char *const way_name[WAYS] = {"CAN", "SLCAN", "Modbus TCP", "Modbus RTU"};

typedef enum { FRESH, HELD, STOPPED, TEST_STOPPED } start_t;
typedef enum { TAKE_FEMUR, TAKE_TIBIA, TEST, END_TEST, LET_GO, ORDERS_END } order_t;

/* From where a session begins, and what it asks for. */
typedef struct {
    start_t start;
    order_t order[6];
} script_t;

static const script_t scripts[] = {{FRESH, {TAKE_FEMUR, ORDERS_END}},
                                   {FRESH, {TEST, ORDERS_END}},
                                   {FRESH, {TAKE_FEMUR, TAKE_TIBIA, LET_GO, ORDERS_END}},
                                   {FRESH, {TAKE_FEMUR, TAKE_TIBIA, TEST, END_TEST, LET_GO, ORDERS_END}},
                                   {HELD, {LET_GO, ORDERS_END}},
                                   {HELD, {TAKE_TIBIA, LET_GO, ORDERS_END}},
                                   {STOPPED, {LET_GO, TAKE_FEMUR, ORDERS_END}},
                                   {TEST_STOPPED, {END_TEST, LET_GO, ORDERS_END}}};
enum { SCRIPTS = sizeof scripts / sizeof scripts[0] };

typedef struct {
    uint32_t at_ms, count;
    uint8_t byte[MESSAGE_BYTES];
} message_t;

static message_t message[MESSAGES_MOST];
static uint32_t messages, now_ms, token, moved, bursts;
static way_t way;

/* ---------------------------------------------------------------------------------------- randomness -- */

static uint32_t random_state = 1;

static uint32_t random_below(uint32_t end)
{
    random_state = random_state * 1664525u + 1013904223u;
    return (uint32_t)((uint64_t)(random_state >> 8) * end >> 24);
}

/* From 0.2 s to 1 h, as many below the middle of the decades as above it. */
static uint64_t random_delay_us(void)
{
    uint64_t us = 200000;
    for (uint32_t half = random_below(28); half > 0u; half--) {
        us += us / 2u;
    }
    us += us * random_below(50) / 100u;
    return us < 3600000000u ? us : 3600000000u;
}

/* --------------------------------------------------------------------------------- the limb's start -- */

typedef struct {
    brace_app_t app;
    brace_fake_t fake;
} world_t;

static world_t begun;

static void keep(world_t *world)
{
    world->app = app;
    world->fake = fake;
}

static void back_to(const world_t *world)
{
    app = world->app;
    fake = world->fake;
}

static void pass_and_drain(uint32_t ms)
{
    for (uint32_t i = 0; i < ms; i++) {
        pass(1);
        drain();
    }
}

static bool has_moved(const float before_rad[BRACE_LINK_COUNT])
{
    bool moves = false;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        moves = moves || fake.joint[i].command.offset_rad != before_rad[i];
    }
    return moves;
}

static void note(float rad[BRACE_LINK_COUNT])
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        rad[i] = fake.joint[i].command.offset_rad;
    }
}

static void operator_takes_up(uint32_t joint)
{
    uint8_t data[8];
    make_take_up(joint, data);
    accepted_command(data);
    for (int i = 0; i < 5000 && now()->play[joint].phase != BRACE_TAKEUP_HOLD; i++) {
        pass_and_drain(1);
    }
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_HOLD, now()->play[joint].phase);
}

/* The operator brings the limb there, and goes. */
static void bring_to(start_t start, bool guarded)
{
    uint8_t data[8];
    start_limb(guarded, guarded ? the_key : NULL);
    if (start != FRESH) {
        if (guarded) {
            open_session();
        }
        operator_lives = true;
    }
    if (start == HELD) {
        operator_takes_up(BRACE_FEMUR);
    } else if (start == STOPPED) {
        make_take_up(BRACE_FEMUR, data);
        accepted_command(data);
        pass_and_drain(100);
    } else if (start == TEST_STOPPED) {
        brace_can_pack_loading_test_start_request(&(brace_can_loading_test_start_request_t){0, 0, 4, 0.5f, 20}, data);
        accepted_command(data);
        pass_and_drain(150);
    }
    if (start == STOPPED || start == TEST_STOPPED) {
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_stop(&app));
    }
    operator_lives = false;
    pass_and_drain(1500);
    fake.peer = PEER;
    if (way == BY_TEXT) {
        TEST_ASSERT_EQUAL(2, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_SLCAN, (const uint8_t *)"O\r", 2));
        pass_and_drain(10);
    }
}

/* ---------------------------------------------------------------------------------------- messages -- */

static void drop_answers(void)
{
    uint8_t bytes[BRACE_FAKE_SERIAL_BYTES];
    drain();
    (void)brace_fake_bytes_take(&fake, BRACE_SERIAL_SLCAN, bytes, sizeof bytes);
    (void)brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS, bytes, sizeof bytes);
    (void)brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS_TCP, bytes, sizeof bytes);
}

/* returns whether the port had room for it */
static bool deliver(const message_t *m)
{
    static const brace_serial_port_t port[WAYS] = {0, BRACE_SERIAL_SLCAN, BRACE_SERIAL_MODBUS_TCP, BRACE_SERIAL_MODBUS};
    if (way == BY_CAN) {
        if (fake.can_received.count >= 40u) {
            return false; /* the rest of the ring is for somebody who lives meanwhile */
        }
        arrives(0x600u + NODE, m->byte, 8);
        return true;
    }
    if (fake.serial_received[port[way]].count + m->count > (uint32_t)BRACE_FAKE_SERIAL_BYTES) {
        return false;
    }
    return brace_fake_bytes_arrive(&fake, port[way], m->byte, m->count) == m->count;
}

static void send(const message_t *m)
{
    TEST_ASSERT_TRUE(messages < (uint32_t)MESSAGES_MOST);
    message[messages] = *m;
    message[messages].at_ms = now_ms;
    TEST_ASSERT_TRUE(deliver(&message[messages]));
    messages++;
}

static void step(uint32_t ms)
{
    for (uint32_t i = 0; i < ms; i++) {
        ticks(1);
        now_ms++;
        drop_answers();
    }
}

static void send_frame(const uint8_t data[8])
{
    message_t m = {.count = 8};
    memcpy(m.byte, data, 8);
    if (way == BY_TEXT) {
        char text[MESSAGE_BYTES];
        m.count = (uint32_t)snprintf(text, sizeof text, "t%03X8%02X%02X%02X%02X%02X%02X%02X%02X\r", 0x600u + NODE,
                                     data[0], data[1], data[2], data[3], data[4], data[5], data[6], data[7]);
        memcpy(m.byte, text, m.count);
    }
    send(&m);
}

static void send_pdu(const uint8_t *pdu, uint32_t count)
{
    message_t m = {.count = count + 7u, .byte = {0xab, (uint8_t)messages, 0, 0, 0, (uint8_t)(count + 1u), UNIT}};
    memcpy(m.byte + 7, pdu, count);
    if (way == BY_LINE) {
        m.byte[0] = UNIT;
        memcpy(m.byte + 1, pdu, count);
        const uint32_t crc = crc_by_bits(m.byte, count + 1u);
        m.byte[count + 1u] = (uint8_t)crc;
        m.byte[count + 2u] = (uint8_t)(crc >> 8);
        m.count = count + 3u;
    }
    send(&m);
    step(way == BY_LINE ? 12 : 3); /* the master waits for the answer */
}

static uint32_t make_values(uint32_t start, const uint32_t *values, uint32_t count, uint8_t *pdu)
{
    const uint8_t head[6] = {16, (uint8_t)(start >> 8), (uint8_t)start,
                             0,  (uint8_t)(2u * count), (uint8_t)(4u * count)};
    memcpy(pdu, head, sizeof head);
    for (uint32_t i = 0; i < 4u * count; i++) {
        pdu[6u + i] = (uint8_t)(values[i / 4u] >> (24u - 8u * (i % 4u)));
    }
    return 6u + 4u * count;
}

/* ----------------------------------------------------------------------------------- a whole session -- */

static void give_sign(void)
{
    const uint32_t number = sign_now().heard; /* it has heard its answers */
    uint8_t bytes[MESSAGE_BYTES];
    if (way == BY_CAN || way == BY_TEXT) {
        make_sign(is_guarded() ? the_key : NULL, number, token, bytes);
        send_frame(bytes);
    } else {
        const uint32_t values[] = {number, is_guarded() ? check_of(the_key, number, 1, NULL, 0) : 0u};
        send_pdu(bytes, make_values(COMMAND_REGISTER(life_heard), values, 2, bytes));
    }
}

static void make_frame(order_t order, uint8_t data[8])
{
    switch (order) {
    case TAKE_FEMUR: make_take_up(BRACE_FEMUR, data); break;
    case TAKE_TIBIA: make_take_up(BRACE_TIBIA, data); break;
    case TEST:
        brace_can_pack_loading_test_start_request(&(brace_can_loading_test_start_request_t){0, 0, 4, 0.5f, 20}, data);
        break;
    case END_TEST: make_write(COMMAND_ENTRY(end_test), 1, 0, data); break;
    default: make_let_go(data); break;
    }
}

static void order_by_frame(order_t order)
{
    uint8_t data[8], sealing[8];
    make_frame(order, data);
    data[1] = (uint8_t)(is_guarded() ? ++counter : token | 1u);
    if (is_guarded()) {
        make_write(COMMAND_ENTRY(seal_mac), check_of(the_key, counter, 2, data, 8), data[1], sealing);
        send_frame(sealing);
    }
    send_frame(data);
}

static void order_by_register(order_t order)
{
    static const uint32_t registers[] = {COMMAND_REGISTER(take_up), COMMAND_REGISTER(take_up), 0,
                                         COMMAND_REGISTER(end_test), COMMAND_REGISTER(let_go)};
    static const uint32_t value[] = {0x101, 0x102, 0, 1, 1};
    uint8_t pdu[MESSAGE_BYTES], sealing[MESSAGE_BYTES];
    const uint32_t count = make_values(registers[order], &value[order], 1, pdu);
    if (is_guarded()) {
        const uint32_t seals[] = {counter + 1u, check_of(the_key, counter + 1u, 2, pdu, count)};
        counter++;
        send_pdu(sealing, make_values(COMMAND_REGISTER(seal_counter), seals, 2, sealing));
    }
    send_pdu(pdu, count);
}

/* Signs of life for a time, and at once where a motion waits. */
static void live(uint32_t ms)
{
    for (uint32_t i = 0; i < ms; i++) {
        step(1);
        if (i % (uint32_t)LIFE_MS == 0u || something_waits()) {
            give_sign();
        }
    }
}

static void carry_out(order_t order)
{
    if (way == BY_CAN || way == BY_TEXT) {
        order_by_frame(order);
    } else {
        order_by_register(order);
    }
    step(3);
    const int joint = order == TAKE_FEMUR ? BRACE_FEMUR : BRACE_TIBIA;
    live(5);
    for (int i = 0;
         i < 40 && (order == TAKE_FEMUR || order == TAKE_TIBIA) && now()->play[joint].phase != BRACE_TAKEUP_HOLD; i++) {
        live(50);
    }
    live(order == TEST ? 250 : 100);
}

/* returns whether the session has moved the limb */
static bool record(const script_t *script)
{
    float before_rad[BRACE_LINK_COUNT], after_rad[BRACE_LINK_COUNT];
    brace_session_report_t reported;
    messages = now_ms = counter = 0;
    note(before_rad);
    brace_app_session(&app, &reported);
    challenge = reported.challenge;
    if (is_guarded()) {
        give_sign();
        step(3);
    }
    bool moves = false;
    for (const order_t *order = script->order; *order != ORDERS_END; order++) {
        if (*order != TEST || way == BY_CAN || way == BY_TEXT) {
            carry_out(*order);
            moves = moves || has_moved(before_rad);
        }
    }
    note(after_rad);
    return moves;
}

/* ------------------------------------------------------------------------------------- held back -- */

/* Time passes in which nothing comes. Of a long time only the session's part is played: the rest of an idle controller
 * is the same afterwards. */
static void hold_back(uint64_t us)
{
    enum { PLAYED_MS = 1500, STEP_US = 20000 };
    const uint64_t ms = us / 1000u;
    if (ms <= 2u * PLAYED_MS) {
        pass_and_drain((uint32_t)ms);
        return;
    }
    pass_and_drain(PLAYED_MS);
    for (uint64_t left = (ms - 2u * PLAYED_MS) * 1000u; left > 0u;) {
        const uint32_t step_us = left < (uint64_t)STEP_US ? (uint32_t)left : (uint32_t)STEP_US;
        session_pass(&app.controller.ownership.session, step_us);
        fake.now_us += step_us;
        app.controller.now_us += step_us;
        left -= step_us;
    }
    pass_and_drain(PLAYED_MS);
}

/* Messages that come in time, as they did when they were recorded; and the time until the last one was sent.
 * returns how many have come */
static uint32_t come_in_time(void)
{
    const uint32_t in_time = random_below(2) == 0u ? 0u : random_below(messages);
    uint32_t at = 0;
    for (uint32_t ms = 0; ms < message[messages - 1u].at_ms; ms++) {
        for (; at < in_time && message[at].at_ms <= ms; at++) {
            TEST_ASSERT_TRUE(deliver(&message[at]));
        }
        ticks(1);
        drop_answers();
    }
    return in_time;
}

/* Somebody's session by CAN, which holds what it has taken up. */
static void somebody_lives(start_t start, bool guarded)
{
    if (guarded) {
        open_session();
    }
    operator_lives = true;
    if (start == FRESH || start == HELD) {
        uint8_t data[8];
        make_take_up(BRACE_TIBIA, data);
        (void)command(data); /* it is refused where the limb is held elsewhere */
        pass_and_drain(2500);
    }
}

static void watch(uint32_t ms, const float before_rad[BRACE_LINK_COUNT])
{
    for (uint32_t i = 0; i < ms; i++) {
        pass(1);
        drop_answers();
        moved += has_moved(before_rad);
    }
}

static void come_late(uint32_t from)
{
    float before_rad[BRACE_LINK_COUNT];
    const uint32_t pieces = 1u + random_below(PIECES_MOST), apart_ms = 1u + random_below(60);
    const bool is_doubled = random_below(3) == 0u;
    note(before_rad);
    for (uint32_t i = from; i < messages; i++) {
        for (uint32_t times = is_doubled && random_below(5) == 0u ? 2u : 1u; times > 0u; times--) {
            while (!deliver(&message[i])) {
                watch(1, before_rad);
            }
            if (way == BY_LINE) {
                watch(8, before_rad); /* the silence between two requests on a line, and the answer */
            }
        }
        if (random_below(messages - from) < pieces - 1u) {
            watch(apart_ms, before_rad);
        }
    }
    watch(600, before_rad);
}

static void burst(const script_t *script, bool guarded)
{
    const uint32_t moved_before = moved;
    const uint32_t situation = random_below(4);
    back_to(&begun);
    operator_lives = false;
    const uint32_t from = come_in_time();
    const uint64_t delay_us = random_delay_us();
    if (situation == 0u) {
        pass_and_drain(1200);
        somebody_lives(from == 0u ? script->start : STOPPED, guarded);
        pass_and_drain(200);
    }
    hold_back(situation == 0u && delay_us > 3000000u ? 3000000u : delay_us);
    come_late(from);
    operator_lives = false;
    bursts++;
    if (moved != moved_before) {
        (void)printf("moved: %s, %s, script %u, held back %.3f s from message %u of %u on, situation %u\n",
                     guarded ? "guarded" : "bench", way_name[way], (unsigned)(script - scripts),
                     (double)delay_us * 1e-6, (unsigned)from, (unsigned)messages, (unsigned)situation);
    }
}

/* So many bursts of all scripts and ways. */
static void play_bursts(bool guarded, uint32_t rounds)
{
    uint32_t kinds = 0;
    bursts = moved = 0;
    for (uint32_t i = 0; i < (uint32_t)SCRIPTS * WAYS * 2u; i++) {
        const script_t *script = &scripts[i / 2u % (uint32_t)SCRIPTS];
        way = (way_t)(i / 2u / (uint32_t)SCRIPTS);
        token = i % 2u == 0u ? OPERATOR_TOKEN : OTHER_TOKEN;
        const bool has_order = way == BY_CAN || way == BY_TEXT || script->order[0] != TEST;
        if (!has_order || (i % 2u == 1u && way != BY_CAN)) {
            continue;
        }
        kinds++;
    }
    uint32_t kind = 0;
    for (uint32_t i = 0; i < (uint32_t)SCRIPTS * WAYS * 2u; i++) {
        const script_t *script = &scripts[i / 2u % (uint32_t)SCRIPTS];
        way = (way_t)(i / 2u / (uint32_t)SCRIPTS);
        token = i % 2u == 0u ? OPERATOR_TOKEN : OTHER_TOKEN;
        const bool has_order = way == BY_CAN || way == BY_TEXT || script->order[0] != TEST;
        if (!has_order || (i % 2u == 1u && way != BY_CAN)) {
            continue;
        }
        bring_to(script->start, guarded);
        keep(&begun);
        TEST_ASSERT_TRUE_MESSAGE(record(script), "on time, the session moves the limb");
        const uint32_t until = rounds * ++kind / kinds;
        while (bursts < until) {
            burst(script, guarded);
        }
    }
    (void)printf("%s: %u bursts, set-points moved %u times\n", guarded ? "guarded" : "bench", (unsigned)bursts,
                 (unsigned)moved);
    TEST_ASSERT_EQUAL(rounds, bursts);
    TEST_ASSERT_EQUAL(0, moved);
}

static uint32_t rounds = SHORT_ROUNDS;

void setUp(void) {}

void tearDown(void)
{
    operator_lives = false;
}

static void test_what_comes_late_moves_nothing_on_a_bench(void)
{
    play_bursts(false, rounds);
}

static void test_what_comes_late_moves_nothing_on_a_guarded_board(void)
{
    play_bursts(true, rounds);
}

int main(int argc, char **argv)
{
    rounds = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : rounds;
    UNITY_BEGIN();
    RUN_TEST(test_what_comes_late_moves_nothing_on_a_bench);
    RUN_TEST(test_what_comes_late_moves_nothing_on_a_guarded_board);
    return UNITY_END();
}
