/* Whatever is asked on whatever port, every tick in MONITOR, TAKING_UP and LOADING_TEST reports K of its own samples,
 * and every request is answered: K in its turn, all else in the tick that takes it. Prints one line for each limb and
 * flood; `./dev bench` makes a table of them.
 *
 * The limb is that of test_app_takeup.c: links held by the ground, each motor behind its gap pulled by a servo. One
 * joint's motor moves a little in every tick, so that a K of older samples shows: it is that of a snapshot before. */
#include <stdlib.h>

#include "can_bench.h"
#include "mode/mode.h"
#include "modbus_master.h"

#define GAP_RAD 0.01f
#define STEP_RAD 2e-6f
#define SERVO_N_MM_PER_RAD 50000.0f
#define SPRING_N_MM_PER_RAD 80000.0f

enum {
    TICKS = ON_BOARD ? 2400 : 2000, /* under one flood; without FPU a test in space takes more */
    TICKS_BETWEEN = 100,     /* in MONITOR, from one loading test or take-up to the next */
    TURNS_LEAST = ON_BOARD ? 1 : 2, /* loading tests and take-ups that end meanwhile */
    TICKS_HELD = 30,         /* with the backlash taken up, before the joints are let go */
    REGISTERS_MOST = 125,
    ASKED_THETA1 = 0x400c,   /* docs/modbus.md */
    COLLAPSED = 0,
    GENERAL,
    HARDENING,
    IN_SPACE,
    LIMB_COUNT,
    FLOOD_CAN = 1,
    FLOOD_SLCAN = 2,
    FLOOD_LINE = 4,
    FLOOD_TCP = 8,
    FLOOD_PORTS = 4,
    K_MOST_TICKS = 4 * 2 + 3,    /* four ports, two steps each, */
    SPACE_MOST_TICKS = 4 * 9 + 15, /* and nine of a limb in space; K's uncertainty has each fourth tick of all */
    JOBS_TICKS = 1 + 1 + 1, /* other jobs have a step after eight, a tick that sends much has none, nor the watch's, */
    SPACE_JOBS_TICKS = 4 + 4, /* and a step towards the buckling factor is due in each ninth tick */
    SIGMA_TICKS = 4 * 80, /* a round of K's uncertainty: 2 to 3 steps a K, 23 K, each fourth tick has a step, */
    SPACE_SIGMA_TICKS = 4 * 300, /* and nine steps, 32 K */
    LINE_TICKS = 4 + 5, /* on the line: bytes and the silence that ends them, read in every other tick; and a long
                                answer, which leaves in five */
};

static const char *const limb_name[LIMB_COUNT] = {"collapsed", "general", "hardening", "in space"};

static const struct {
    const char *name;
    uint32_t ports;
} flood[] = {{"CAN", FLOOD_CAN},
             {"SLCAN", FLOOD_SLCAN},
             {"Modbus RTU", FLOOD_LINE},
             {"Modbus TCP", FLOOD_TCP},
             {"all at once", FLOOD_CAN | FLOOD_SLCAN | FLOOD_LINE | FLOOD_TCP}};

typedef struct {
    uint32_t ticks, with_k;
} share_t;

static share_t monitor, taking_up, loading_test;
static float gap_rad;
static struct {
    brace_stiffness_t k;
    float theta1_rad, theta2_rad;
} before[2]; /* the snapshot before, and the one before that */
static uint32_t sequence_before;
static reply_t on_line; /* as much of the answer on the line as has come */
static uint32_t asked_ticks[FLOOD_PORTS]; /* how long the port's question waits for its answer; 0: none does */
static bool asks_k[FLOOD_PORTS]; /* all else is answered in the tick that takes it */
static uint32_t turn; /* the number of the loading test or take-up */
static brace_mode_t mode_before;
static uint32_t ticks_in_mode; /* or since the last take-up began in it */

void setUp(void) {}

void tearDown(void) {}

static void play(void *user, brace_fake_t *board, int32_t joint)
{
    static const float middle_rad[BRACE_LINK_COUNT] = {0.3f, 1.0f, 1.4f};
    (void)user;
    brace_fake_joint_t *ours = &board->joint[joint];
    const float asked = ours->command.offset_rad, half = 0.5f * gap_rad;
    float moved = asked, torque = 0.0f;
    if (asked > half || asked < -half) {
        const float edge = asked > 0.0f ? half : -half;
        moved = (SERVO_N_MM_PER_RAD * asked + SPRING_N_MM_PER_RAD * edge) / (SERVO_N_MM_PER_RAD + SPRING_N_MM_PER_RAD);
        torque = SPRING_N_MM_PER_RAD * (moved - edge);
    }
    const float steps = joint == BRACE_TIBIA ? (float)(board->now_us / TICK_US % 3u) : 0.0f;
    ours->sample.motor_rad = middle_rad[joint] + moved + steps * STEP_RAD;
    ours->sample.torque_n_mm = torque;
}

static void start(int limb, bool has_play)
{
    brace_parameters_t p = bench_parameters();
    gap_rad = has_play ? GAP_RAD : 0.0f;
    p.controller.modbus_address = UNIT;
    p.controller.bus_load_ratio = 1.0f;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        p.limb.joint[i].gap_rad = gap_rad;
        p.drive[i].hardening_n_mm_per_rad3 = limb == HARDENING ? 1e7f : 0.0f;
    }
    p.slow.joint_compliance_per_degc = limb == HARDENING ? 0.004f : 0.0f;
    p.limb.base.x_mm_per_n = limb == GENERAL ? 0.01f : 0.0f;
    bench_board();
    bench_store(&p);
    brace_fake_without_force(&fake);
    fake.joint[BRACE_COXA].absent = limb != IN_SPACE;
    fake.play = play;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        fake.joint[i].command = (brace_hal_joint_command_t){0.0f, INFINITY};
    }
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(50);
    drain();
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    TEST_ASSERT_EQUAL(limb == COLLAPSED, app.controller.model.is_collapsed);
    TEST_ASSERT_EQUAL(limb == IN_SPACE, app.controller.model.is_spatial);
}

/* ------------------------------------------------------------------------------------------------ floods -- */

/* The questions whose answers cost most, in turn. returns whether it asks for K */
static bool question(uint32_t tick, uint8_t data[8])
{
    switch (tick % 4u) {
    case 0:
        brace_can_pack_k_at_tip_knee_up_request(&(brace_can_k_at_tip_knee_up_request_t){1, 300.0f, -100.0f}, data);
        return true;
    case 1: brace_can_pack_k_at_posture_request(&(brace_can_k_at_posture_request_t){1, 0.8f, 1.1f}, data); return true;
    case 2:
        if (app.controller.model.is_spatial) {
            brace_can_pack_k_in_space_at_posture_request(
                &(brace_can_k_in_space_at_posture_request_t){1, -0.5f, 0.8f, 1.1f}, data);
            return true;
        }
        break;
    default: break;
    }
    brace_can_pack_read_entry_request(&(brace_can_read_entry_request_t){1, 0x1000u + tick % 50u}, data);
    return false;
}

static void ask_as_text(const uint8_t data[8])
{
    char line[40];
    uint32_t at = (uint32_t)snprintf(line, sizeof line, "t%03X8", 0x600u + NODE);
    for (uint32_t i = 0; i < 8u; i++) {
        at += (uint32_t)snprintf(line + at, sizeof line - at, "%02X", data[i]);
    }
    line[at++] = '\r';
    TEST_ASSERT_EQUAL(at, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_SLCAN, (const uint8_t *)line, at));
}

/* As many registers as a read may have, of a snapshot or of the parameters; or a question for K.
 * returns its length */
static uint32_t modbus_question(uint32_t tick, uint8_t pdu[16])
{
    static const uint8_t read_snapshot[] = {4, 0, 0, 0, REGISTERS_MOST};
    static const uint8_t read_parameters[] = {3, 0, 0, 0, REGISTERS_MOST};
    static const float theta_rad[] = {0.8f, 1.1f};
    if (tick % 3u != 0u) {
        memcpy(pdu, tick % 3u == 1u ? read_snapshot : read_parameters, sizeof read_snapshot);
        return sizeof read_snapshot;
    }
    const uint8_t head[] = {16, ASKED_THETA1 >> 8, ASKED_THETA1 & 0xff, 0, 4, 8};
    memcpy(pdu, head, sizeof head);
    for (uint32_t i = 0; i < 8u; i++) {
        pdu[sizeof head + i] = (uint8_t)(bits(theta_rad[i / 4u]) >> (24u - 8u * (i % 4u)));
    }
    return sizeof head + 8u;
}

static void ask_on_line(uint32_t tick)
{
    uint8_t frame[20] = {UNIT};
    const uint32_t length = 1u + modbus_question(tick, frame + 1);
    const uint32_t crc = crc_by_bits(frame, length);
    frame[length] = (uint8_t)crc;
    frame[length + 1u] = (uint8_t)(crc >> 8);
    line_says(frame, length + 2u);
}

static void ask_over_tcp(uint32_t tick)
{
    uint8_t adu[24] = {0, 1, 0, 0, 0, 0, UNIT};
    const uint32_t length = modbus_question(tick, adu + 7);
    adu[5] = (uint8_t)(length + 1u);
    TEST_ASSERT_EQUAL(7u + length, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS_TCP, adu, 7u + length));
}

static void ask_every_port(uint32_t ports, uint32_t tick)
{
    static const uint8_t others[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    uint8_t data[8];
    const bool asks_k_over_can = question(tick, data);
    if ((ports & FLOOD_CAN) != 0u) {
        arrives(0x181, others, 8); /* other nodes talk too */
        arrives(0x281, others, 8);
    }
    for (uint32_t port = 0; port < (uint32_t)FLOOD_PORTS; port++) {
        if ((ports & 1u << port) == 0u || asked_ticks[port] > 0u) {
            continue;
        }
        asked_ticks[port] = 1;
        asks_k[port] = (1u << port & (FLOOD_CAN | FLOOD_SLCAN)) != 0u ? asks_k_over_can : tick % 3u == 0u;
        switch (1u << port) {
        case FLOOD_CAN: arrives(0x600u + NODE, data, 8); break;
        case FLOOD_SLCAN: ask_as_text(data); break;
        case FLOOD_LINE: ask_on_line(tick); break;
        default: ask_over_tcp(tick); break;
        }
    }
}

/* A refusal is no answer here: every question can be answered. */
static bool is_answered_on_bus(void)
{
    brace_can_frame_t frame;
    bool answered = false;
    while (brace_fake_frame_take(&fake, &frame)) {
        answered = answered || (frame.id == 0x580u + NODE && !is_refusal(frame.data));
    }
    return answered;
}

static bool is_answered_as_text(void)
{
    char text[4000];
    const uint32_t count = brace_fake_bytes_take(&fake, BRACE_SERIAL_SLCAN, (uint8_t *)text, sizeof text - 1u);
    text[count] = '\0';
    for (const char *answer = strstr(text, "t5858"); answer != NULL; answer = strstr(answer + 5, "t5858")) {
        const char digits[] = {answer[5], answer[6], '\0'};
        const brace_can_answer_frame_t *is = &brace_can_answer_frames[strtoul(digits, NULL, 16)];
        if (is->parts > 0u && is->part == 0u) {
            return true;
        }
    }
    return false;
}

static bool is_answered_over_tcp(void)
{
    uint8_t bytes[300];
    const uint32_t count = brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS_TCP, bytes, sizeof bytes);
    return count > 7u && (bytes[7] & 0x80u) == 0u; /* the highest bit marks an exception */
}

/* How long the answer is that begins so. */
static uint32_t answer_bytes(const uint8_t *byte)
{
    const bool is_read = byte[1] == 3u || byte[1] == 4u, is_exception = (byte[1] & 0x80u) != 0u;
    return is_exception ? 5u : is_read ? 5u + byte[2] : 8u;
}

/* A long answer comes in parts: it is there when it is whole. A part's check may be right by chance. */
static bool is_answered_on_line(void)
{
    on_line.count += brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS, on_line.byte + on_line.count,
                                           (uint32_t)sizeof on_line.byte - on_line.count);
    if (on_line.count < 5u || on_line.count < answer_bytes(on_line.byte) ||
        crc_by_bits(on_line.byte, on_line.count) != 0u) {
        return false;
    }
    on_line.count = 0;
    return (on_line.byte[1] & 0x80u) == 0u;
}

static void every_port_answers_in_time(uint32_t ports)
{
    const uint32_t most_ticks =
        now()->space.is_fitted ? SPACE_MOST_TICKS + SPACE_JOBS_TICKS : K_MOST_TICKS + JOBS_TICKS;
    const bool answered[FLOOD_PORTS] = {is_answered_on_bus(), is_answered_as_text(), is_answered_on_line(),
                                        is_answered_over_tcp()};
    for (uint32_t port = 0; port < (uint32_t)FLOOD_PORTS; port++) {
        TEST_ASSERT_TRUE(!answered[port] || (ports & 1u << port) != 0u);
        asked_ticks[port] = answered[port] || asked_ticks[port] == 0u ? 0u : asked_ticks[port] + 1u;
        TEST_ASSERT_LESS_OR_EQUAL((asks_k[port] ? most_ticks : 0u) + (1u << port == FLOOD_LINE ? LINE_TICKS : 0u),
                                  asked_ticks[port]);
    }
}

/* ------------------------------------------------------------------------------------- what goes on beside -- */

static const brace_loading_setup_t along_x = {.axis = BRACE_AXIS_X,
                                              .steps_per_side = 2,
                                              .step_mm = 0.2f,
                                              .dwell_us = 20000,
                                              .rate_mm_per_s = 100.0f,
                                              .force_max_n = 1000.0f,
                                              .torque_max_n_mm = 8000.0f,
                                              .source = BRACE_LOADING_COMMANDED};

/* Loading tests, and where there is play take-ups of every joint: one after the other, for ever. */
static void go_on(bool is_spatial)
{
    const brace_mode_t mode = now()->mode;
    ticks_in_mode = mode == mode_before ? ticks_in_mode + 1u : 0u;
    mode_before = mode;
    if (mode == BRACE_MODE_TAKING_UP && ticks_in_mode >= TICKS_HELD) {
        const int32_t first = is_spatial ? BRACE_COXA : BRACE_FEMUR;
        for (int32_t joint = first; joint < BRACE_LINK_COUNT; joint++) {
            if (brace_app_take_up(&app, joint, 1) == BRACE_OK) { /* the next one, once those before hold */
                ticks_in_mode = 0;
                return;
            }
        }
    }
    if (mode == BRACE_MODE_TAKING_UP && ticks_in_mode >= 10 * TICKS_HELD) {
        (void)brace_app_let_go(&app);
        ticks_in_mode = 0;
    }
    if (mode == BRACE_MODE_MONITOR && ticks_in_mode >= TICKS_BETWEEN) {
        ticks_in_mode = 0;
        turn++;
        if (gap_rad > 0.0f && turn % 2u == 0u) {
            TEST_ASSERT_EQUAL(BRACE_OK, brace_app_take_up(&app, is_spatial ? BRACE_COXA : BRACE_FEMUR, 1));
        } else {
            TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
        }
    }
}

static bool is_same_k(const brace_stiffness_t *a, const brace_stiffness_t *b)
{
    return a->k_xx_n_per_mm == b->k_xx_n_per_mm && a->k_xz_n_per_mm == b->k_xz_n_per_mm &&
           a->k_zz_n_per_mm == b->k_zz_n_per_mm;
}

/* Is K that of an earlier snapshot, though the limb stands elsewhere? Where an open gap takes the motor's movement up,
 * the limb stands where it stood, and K stays. A load that changes by noise turns the joints by less than a step. */
static bool is_old(const brace_snapshot_t *snapshot)
{
    bool old = false;
    for (int i = 0; i < 2; i++) {
        const bool has_moved = fabsf(snapshot->theta_rad[BRACE_FEMUR] - before[i].theta1_rad) > 0.5f * STEP_RAD ||
                               fabsf(snapshot->theta_rad[BRACE_TIBIA] - before[i].theta2_rad) > 0.5f * STEP_RAD;
        old = old || (has_moved && is_same_k(&snapshot->stiffness.engaged, &before[i].k));
    }
    return old;
}

static void remember(const brace_snapshot_t *snapshot)
{
    before[1] = before[0];
    before[0].k = snapshot->stiffness.engaged;
    before[0].theta1_rad = snapshot->theta_rad[BRACE_FEMUR];
    before[0].theta2_rad = snapshot->theta_rad[BRACE_TIBIA];
    sequence_before = snapshot->sequence;
}

/* Is K of the samples of this tick? A limb in space has two of them. */
static void watch(void)
{
    const brace_snapshot_t *snapshot = now();
    share_t *share = snapshot->mode == BRACE_MODE_MONITOR     ? &monitor
                     : snapshot->mode == BRACE_MODE_TAKING_UP ? &taking_up
                                                              : &loading_test;
    const bool is_of_these_samples = snapshot->taken_us == fake.now_us &&
                                     snapshot->motor_rad[BRACE_FEMUR] == fake.joint[BRACE_FEMUR].sample.motor_rad &&
                                     snapshot->motor_rad[BRACE_TIBIA] == fake.joint[BRACE_TIBIA].sample.motor_rad;
    const bool is_whole = snapshot->k_is_valid && snapshot->space.is_valid == snapshot->space.is_fitted;
    TEST_ASSERT_TRUE(mode_reports_k(snapshot->mode));
    share->ticks++;
    share->with_k += is_whole && is_of_these_samples && !is_old(snapshot) && snapshot->sequence == sequence_before + 1u;
    TEST_ASSERT_LESS_OR_EQUAL(snapshot->space.is_fitted ? SPACE_SIGMA_TICKS : SIGMA_TICKS,
                              app.controller.sigma.round.ticks_old); /* no flood keeps K's sigma from being renewed */
    remember(snapshot);
}

static void flood_limb(int limb, bool has_play)
{
    for (uint32_t i = 0; i < sizeof flood / sizeof *flood; i++) {
        monitor = taking_up = loading_test = (share_t){0, 0};
        memset(asked_ticks, 0, sizeof asked_ticks);
        on_line.count = 0;
        start(limb, has_play);
        if ((flood[i].ports & FLOOD_SLCAN) != 0u) {
            TEST_ASSERT_EQUAL(2, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_SLCAN, (const uint8_t *)"O\r", 2));
            ticks(1);
            (void)is_answered_as_text();
        }
        remember(now());
        ticks_in_mode = turn = 0;
        for (uint32_t tick = 0; tick < TICKS; tick++) {
            ask_every_port(flood[i].ports, tick);
            go_on(limb == IN_SPACE);
            ticks(1);
            watch();
            every_port_answers_in_time(flood[i].ports);
        }
        printf("flood,%s%s,%s,%u,%u,%u,%u,%u,%u\n", limb_name[limb], has_play ? " with play" : "", flood[i].name,
               (unsigned)monitor.ticks, (unsigned)monitor.with_k, (unsigned)taking_up.ticks, (unsigned)taking_up.with_k,
               (unsigned)loading_test.ticks, (unsigned)loading_test.with_k);
        TEST_ASSERT_TRUE(monitor.ticks > 100u && loading_test.ticks > 100u);
        TEST_ASSERT_EQUAL(has_play, taking_up.ticks > 100u);
        TEST_ASSERT_GREATER_OR_EQUAL(TURNS_LEAST, turn); /* no flood stops a job: tests come to their ends, */
        TEST_ASSERT_EQUAL(limb == IN_SPACE && now()->load.is_counted, !isnan(app.controller.softening.factor));
        TEST_ASSERT_EQUAL(monitor.ticks, monitor.with_k);
        TEST_ASSERT_EQUAL(taking_up.ticks, taking_up.with_k);
        TEST_ASSERT_EQUAL(loading_test.ticks, loading_test.with_k);
    }
}

static void test_a_limb_that_collapses(void)
{
    flood_limb(COLLAPSED, false);
    flood_limb(COLLAPSED, true);
}

static void test_a_limb_of_the_general_path(void)
{
    flood_limb(GENERAL, false);
    flood_limb(GENERAL, true);
}

static void test_a_limb_whose_springs_harden_and_warm(void)
{
    flood_limb(HARDENING, false);
    flood_limb(HARDENING, true);
}

static void test_a_limb_in_space(void)
{
    flood_limb(IN_SPACE, false);
    flood_limb(IN_SPACE, true);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_limb_that_collapses);
    RUN_TEST(test_a_limb_of_the_general_path);
    RUN_TEST(test_a_limb_whose_springs_harden_and_warm);
    RUN_TEST(test_a_limb_in_space);
    return UNITY_END();
}
