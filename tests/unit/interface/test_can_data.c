/* Process data on CAN: rates, one snapshot in all frames, load of the bus, floods; and the same over SLCAN text. */
#include "can_bench.h"

#include "brace/can_frames.h"

enum { NODES = 4 };

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    bench_start(&p);
}

void tearDown(void) {}

typedef struct {
    uint32_t function[16]; /* frames by identifier >> 7 */
    uint32_t all;
} count_t;

static uint32_t of(const count_t *count, uint32_t function)
{
    return count->function[function >> 7];
}

static uint32_t all_conditions; /* that have come in all runs */

static count_t run(int count)
{
    count_t seen = {0};
    brace_can_frame_t frame;
    for (int i = 0; i < count; i++) {
        ticks(1);
        while (brace_fake_frame_take(&fake, &frame)) {
            TEST_ASSERT_EQUAL(NODE, frame.id & 0x7fu);
            seen.function[frame.id >> 7]++;
            seen.all++;
            all_conditions += frame.id == (uint32_t)BRACE_CAN_ID_DETAILS + NODE &&
                              brace_can_details_part(frame.data) == BRACE_CAN_PART_CONDITION;
        }
    }
    return seen;
}

static void without_rates(brace_parameters_t *p)
{
    p->controller.stiffness_hz = p->controller.posture_hz = p->controller.load_hz = p->controller.sigma_hz = 0;
}

static void test_rates_are_the_parameters(void)
{
    ticks(50);
    drain();
    const count_t seen = run(10000);
    TEST_ASSERT_UINT32_WITHIN(1, 2000, of(&seen, 0x180));
    TEST_ASSERT_UINT32_WITHIN(1, 2000, of(&seen, 0x280));
    TEST_ASSERT_UINT32_WITHIN(1, 200, of(&seen, 0x380));
    TEST_ASSERT_UINT32_WITHIN(1, 200, of(&seen, 0x480));
    TEST_ASSERT_UINT32_WITHIN(1, 10, of(&seen, 0x700));
    /* sigma in two parts, a condition with each heartbeat */
    TEST_ASSERT_UINT32_WITHIN(3, 2 * 100 + 10, of(&seen, 0x200));
    TEST_ASSERT_EQUAL(0, of(&seen, 0x080));
}

static void test_rates_of_zero_are_silence_but_for_the_heartbeat(void)
{
    brace_parameters_t p = bench_parameters();
    without_rates(&p);
    p.controller.heartbeat_hz = 5;
    bench_start(&p);
    ticks(50);
    drain();
    const count_t seen = run(2000);
    TEST_ASSERT_UINT32_WITHIN(1, 10, of(&seen, 0x700));
    TEST_ASSERT_UINT32_WITHIN(1, of(&seen, 0x700), of(&seen, 0x200)); /* its condition follows each */
    TEST_ASSERT_EQUAL(of(&seen, 0x700) + of(&seen, 0x200), seen.all);
    p.controller.posture_hz = 50;
    bench_start(&p);
    ticks(50);
    drain();
    const count_t posture = run(2000);
    TEST_ASSERT_EQUAL(0, of(&posture, 0x180));
    TEST_ASSERT_UINT32_WITHIN(1, 100, of(&posture, 0x480));
}

/* Where no rate is set no snapshot is taken for the bus either: the ticks stay free for the jobs. */
static void test_without_a_rate_no_snapshot_is_taken(void)
{
    brace_parameters_t p = bench_parameters();
    without_rates(&p);
    bench_start(&p);
    ticks(50);
    const process_t *process = &app.wires.can.bus_port.process;
    const uint32_t taken_us = process->taken_us;
    ticks(2500);
    TEST_ASSERT_TRUE(process->is_configured);
    TEST_ASSERT_EQUAL_UINT32(taken_us, process->taken_us);
}

/* Bits of a frame of eight bytes as long as stuffing can make it: 34 + 64 bits may be stuffed, one in four after the
 * first; 10 fixed bits, 3 between frames. */
static uint32_t worst_bits(void)
{
    return 34u + 64u + (34u + 64u - 1u) / 4u + 10u + 3u;
}

static void test_process_data_are_thinned_to_the_share_of_the_bus(void)
{
    brace_parameters_t p = bench_parameters();
    p.controller.stiffness_hz = 1000;
    p.controller.posture_hz = 1000;
    p.controller.load_hz = 1000;
    p.controller.can_bit_rate = 250000;
    p.controller.bus_load_ratio = 0.10f;
    bench_start(&p);
    ticks(50);
    drain();
    const count_t seen = run(4000);
    const float load = (float)(seen.all * worst_bits()) / (4.0f * 250000.0f);
    TEST_ASSERT_TRUE(load <= 0.101f);
    TEST_ASSERT_TRUE(load > 0.09f);
}

/* Heartbeats alone may take more than the share: then a snapshot leaves now and then all the same, and no more. */
static void test_a_share_that_heartbeats_use_up_leaves_little(void)
{
    brace_parameters_t p = bench_parameters();
    p.controller.stiffness_hz = p.controller.posture_hz = p.controller.load_hz = 100;
    p.controller.heartbeat_hz = 10;
    p.controller.can_bit_rate = 125000;
    p.controller.bus_load_ratio = 0.001f;
    bench_start(&p);
    drain();
    const count_t seen = run(2000);
    TEST_ASSERT_UINT32_WITHIN(1, 20, of(&seen, 0x700));
    /* A condition follows each; one snapshot, of what a limb without a coxa joint sends. */
#define ONE(ID, name, rate, coxa) +(uint32_t) !(coxa)
    const uint32_t frames_of_snapshot = 0u BRACE_CAN_PROCESS(ONE);
#undef ONE
    TEST_ASSERT_LESS_OR_EQUAL(2u * of(&seen, 0x700) + frames_of_snapshot, seen.all);
}

/* Where nothing else is to be sent, two frames leave in each tick until a snapshot is sent. A port that nobody has
 * opened takes none of them away. */
static void test_a_snapshot_leaves_two_frames_at_a_time(void)
{
    brace_parameters_t p = bench_parameters();
    p.controller.stiffness_hz = p.controller.posture_hz = 37; /* at even ticks and at odd ones */
    p.controller.load_hz = p.controller.sigma_hz = 37;
    p.controller.bus_load_ratio = 1.0f;
    bench_start(&p);
    ticks(50);
    drain();
    int ended = 0, before = 0;
    for (int i = 0; i < 600; i++) {
        const uint32_t before_conditions = all_conditions;
        const count_t seen = run(1);
        const uint32_t conditions = all_conditions - before_conditions;
        const int frames = (int)seen.all - (int)of(&seen, 0x700) - (int)conditions;
        TEST_ASSERT_LESS_OR_EQUAL(2, frames);
        TEST_ASSERT_TRUE(before == 0 || before == 2 || frames == 0); /* fewer only at the end */
        ended += before != 0 && frames == 0;
        before = frames;
    }
    TEST_ASSERT_GREATER_THAN(20, ended);
}

static void test_all_frames_of_a_snapshot_are_of_one_tick(void)
{
    enum { KEPT = 256 };
    static float k_xx[KEPT], k_zz[KEPT], low[KEPT], theta1[KEPT];
    static uint32_t taken_us[KEPT];
    brace_can_frame_t frame;
    uint32_t begun = 0, pairs = 0, delayed = 0, last = 256;
    brace_can_stiffness_a_t a = {.sequence = 999};
    for (int i = 0; i < 5000 * TIMES_ON_HOST; i++) {
        fake.joint[BRACE_FEMUR].sample.motor_rad = 0.5f + 4e-4f * (float)(i % 1500);
        fake.joint[BRACE_TIBIA].sample.motor_rad = 1.7f - 3e-4f * (float)(i % 1700);
        if (i % 1500 == 0 || i % 1700 == 0) {
            bench_believe();
        }
        /* Half of the time the bus takes a frame in four ticks: fewer than the rates want. */
        fake.can_room = i % 500 < 250 ? 64 : i % 4 == 0 ? 1 : 0;
        if (i % 3 == 0 && fake.can_room == 64) {
            const uint8_t asked[8] = {BRACE_REQUEST_K_AT_POSTURE, (uint8_t)i, 0x40, 0x42, 0x0f, 0x40, 0x42, 0x0f};
            arrives(0x600 + NODE, asked, 8);
        }
        ticks(1);
        const uint32_t at = now()->sequence % KEPT;
        k_xx[at] = now()->stiffness.now.k_xx_n_per_mm;
        k_zz[at] = now()->stiffness.now.k_zz_n_per_mm;
        low[at] = now()->stiffness.now.lambda_min_n_per_mm;
        theta1[at] = now()->theta_rad[BRACE_FEMUR];
        taken_us[at] = now()->taken_us;
        while (brace_fake_frame_take(&fake, &frame)) {
            if (frame.id == 0x180 + NODE) {
                brace_can_unpack_stiffness_a(frame.data, &a);
                TEST_ASSERT_FLOAT_WITHIN(2.6e-4f, k_xx[a.sequence], a.k_xx_n_per_mm);
                TEST_ASSERT_FLOAT_WITHIN(0.3f, 1e-3f * (float)(fake.now_us - taken_us[a.sequence]), a.age_ms);
                delayed += a.age_ms > 1.5f;
                TEST_ASSERT_NOT_EQUAL(last, a.sequence);
                TEST_ASSERT_EQUAL(pairs, begun); /* no snapshot is left half sent for a newer one */
                begun++;
                last = a.sequence;
            } else if (frame.id == 0x280 + NODE) {
                brace_can_stiffness_b_t b;
                brace_can_unpack_stiffness_b(frame.data, &b);
                TEST_ASSERT_EQUAL(a.sequence, b.sequence);
                TEST_ASSERT_FLOAT_WITHIN(2.6e-4f, k_zz[b.sequence], b.k_zz_n_per_mm);
                TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, b.mode);
                pairs++;
            } else if (frame.id == 0x380 + NODE) {
                brace_can_eigenvalues_t e;
                brace_can_unpack_eigenvalues(frame.data, &e);
                TEST_ASSERT_FLOAT_WITHIN(2.6e-4f, low[e.sequence], e.lambda_min_n_per_mm);
            } else if (frame.id == 0x480 + NODE) {
                brace_can_posture_t p;
                brace_can_unpack_posture(frame.data, &p);
                TEST_ASSERT_FLOAT_WITHIN(1.1e-5f, theta1[p.sequence], p.theta1_rad);
                TEST_ASSERT_EQUAL_HEX32(now()->parameter_crc & 0xffff, p.parameter_tag);
            }
        }
    }
    TEST_ASSERT_TRUE(pairs > 500 * TIMES_ON_HOST);
    TEST_ASSERT_TRUE(delayed > 25 * TIMES_ON_HOST);
}

static void test_K_that_is_not_valid_is_never_a_number(void)
{
    brace_can_frame_t frame;
    brace_can_stiffness_a_t a = {0};
    brace_can_stiffness_b_t b = {0};
    brace_can_eigenvalues_t e = {0};
    fake.joint[BRACE_TIBIA].not_newer = true;
    ticks(200);
    drain();
    for (int i = 0; i < 100; i++) {
        ticks(1);
        while (brace_fake_frame_take(&fake, &frame)) {
            if (frame.id == 0x180 + NODE) {
                brace_can_unpack_stiffness_a(frame.data, &a);
                TEST_ASSERT_TRUE(a.k_xx_n_per_mm != a.k_xx_n_per_mm && a.k_xz_n_per_mm != a.k_xz_n_per_mm);
            } else if (frame.id == 0x280 + NODE) {
                brace_can_unpack_stiffness_b(frame.data, &b);
                TEST_ASSERT_EQUAL_HEX32(BRACE_FLAG_STALE, b.flags & BRACE_FLAG_STALE);
                TEST_ASSERT_TRUE(b.k_zz_n_per_mm != b.k_zz_n_per_mm);
            } else if (frame.id == 0x380 + NODE) {
                brace_can_unpack_eigenvalues(frame.data, &e);
                TEST_ASSERT_TRUE(e.lambda_min_n_per_mm != e.lambda_min_n_per_mm);
            }
        }
    }
    TEST_ASSERT_NOT_EQUAL(0, a.sequence + e.sequence);
    TEST_ASSERT_NOT_EQUAL(0, b.sequence);
}

/* Four limbs as they come out of the box but for their numbers, on one bus of 1 Mbit/s, switched on together. */
static void test_four_limbs_take_less_than_a_quarter_of_the_bus_and_begin_apart(void)
{
    static brace_fake_t board[NODES];
    static brace_app_t limb[NODES];
    uint32_t frames = 0, in_tick_most = 0;
    for (uint32_t n = 0; n < NODES; n++) {
        brace_parameters_t p = bench_parameters();
        brace_parameters_t fresh;
        brace_parameters_default(&fresh);
        p.controller = fresh.controller;
        p.controller.node_id = n + 1u;
        p.controller.can_bit_rate = 1000000;
        bench_start(&p);
        board[n] = fake;
        board[n].hal.context = &board[n];
        TEST_ASSERT_EQUAL(200, p.controller.stiffness_hz);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&limb[n], &board[n].hal));
    }
    for (uint32_t t = 0; t < 1100; t++) {
        uint32_t stiffness_in_tick = 0;
        for (int n = 0; n < NODES; n++) {
            brace_can_frame_t frame;
            board[n].now_us += TICK_US;
            brace_app_tick(&limb[n], board[n].now_us);
            while (brace_fake_frame_take(&board[n], &frame)) {
                frames += t >= 100u; /* one second, after the start */
                stiffness_in_tick += t >= 100u && frame.id >> 7 == 0x180u >> 7;
            }
        }
        in_tick_most = stiffness_in_tick > in_tick_most ? stiffness_in_tick : in_tick_most;
    }
    TEST_ASSERT_UINT32_WITHIN(8, NODES * (2u * 200u + 2u * 20u + 2u * 10u + 2u), frames);
    const float load = (float)(frames * worst_bits()) / 1e6f;
    TEST_ASSERT_TRUE(load < 0.25f);
    TEST_ASSERT_TRUE(load > 0.24f);
    TEST_ASSERT_TRUE(in_tick_most <= 2);
}

enum { FLOOD_S = ON_BOARD ? 1 : 3, FLOOD_TICKS = 1000 * FLOOD_S };

/* Every tick reports K of its own samples, and all process data leave. */
static void flood(const uint8_t *data, uint8_t length, uint32_t id)
{
    count_t seen = {0};
    brace_can_frame_t frame = {.id = id, .length = length}, sent;
    memcpy(frame.data, data, length);
    ticks(50);
    drain();
    const uint32_t first = now()->sequence;
    for (int i = 0; i < FLOOD_TICKS; i++) {
        /* as many as 1 Mbit/s carries without stuff bits */
        for (uint32_t n = 0; n < 1000u / (47u + 8u * length); n++) {
            (void)brace_fake_frame_arrives(&fake, &frame);
        }
        ticks(1);
        while (brace_fake_frame_take(&fake, &sent)) {
            seen.function[sent.id >> 7]++;
        }
        TEST_ASSERT_TRUE(now()->k_is_valid);
        TEST_ASSERT_EQUAL(fake.now_us, now()->taken_us);
    }
    TEST_ASSERT_EQUAL_UINT32(FLOOD_TICKS, now()->sequence - first);
    TEST_ASSERT_UINT32_WITHIN(1, FLOOD_S, of(&seen, 0x700));
    TEST_ASSERT_UINT32_WITHIN(1, 200 * FLOOD_S, of(&seen, 0x180));
    TEST_ASSERT_UINT32_WITHIN(1, 200 * FLOOD_S, of(&seen, 0x280));
    TEST_ASSERT_EQUAL(FLOOD_TICKS, fake.calls[BRACE_FAKE_WATCHDOG_FEED] - 50u);
}

static void test_floods_leave_tick_heartbeat_and_process_data(void)
{
    static const uint8_t question[8] = {BRACE_REQUEST_K_AT_POSTURE, 1, 0x40, 0x42, 0x0f, 0x40, 0x42, 0x0f};
    flood(question, 0, 0x123);
    setUp();
    flood(question, 8, 0x600 + NODE);
    brace_parameters_t p = bench_parameters();
    p.limb.base.x_mm_per_n = 0.01f; /* the general path */
    bench_start(&p);
    flood(question, 8, 0x600 + NODE);
}

static void test_a_bus_that_stays_off_is_tried_less_and_less_often(void)
{
    ticks(20);
    const uint32_t before = fake.calls[BRACE_FAKE_CAN_RECOVER];
    fake.can_health.bus_off = true;
    ticks(20000);
    const uint32_t tried = fake.calls[BRACE_FAKE_CAN_RECOVER] - before;
    TEST_ASSERT_TRUE(tried >= 11 && tried <= 14); /* 0.125 + 0.25 + 0.5 + 1 + 2 + 2 ... seconds */
    fake.can_health.bus_off = false;
    ticks(200);
    drain();
    const count_t seen = run(1000);
    TEST_ASSERT_UINT32_WITHIN(1, 200, of(&seen, 0x180));
}

/* ------------------------------------------------------------------------------------------------- SLCAN -- */

static void says(const char *text)
{
    const uint32_t length = (uint32_t)strlen(text);
    TEST_ASSERT_EQUAL(length, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_SLCAN, (const uint8_t *)text, length));
}

/* Ticks, and all that has come back meanwhile as a string. */
static const char *hears(int count)
{
    static char text[4096];
    uint32_t length = 0;
    for (int i = 0; i < count; i++) {
        ticks(1);
        length += brace_fake_bytes_take(&fake, BRACE_SERIAL_SLCAN, (uint8_t *)&text[length],
                                        (uint32_t)sizeof text - 1u - length);
    }
    text[length] = '\0';
    return text;
}

static void without_transceiver(uint32_t node_id)
{
    brace_parameters_t p = bench_parameters();
    p.controller.node_id = node_id;
    bench_board();
    bench_store(&p);
    brace_fake_without_can(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(20);
}

static void test_slcan_opens_answers_and_closes(void)
{
    without_transceiver(NODE);
    TEST_ASSERT_EQUAL_STRING("", hears(20));
    says("\r\r\rV\rN\rS8\rF\r");
    TEST_ASSERT_EQUAL_STRING("\r\r\rV1013\rNBRC1\r\r\a", hears(5));
    says("t12300\r"); /* closed */
    TEST_ASSERT_EQUAL_STRING("\a", hears(3));
    says("O\rO\rS6\r");
    const char *opened = hears(3);
    TEST_ASSERT_EQUAL_STRING_LEN("\r\a\a", opened, 3);
    (void)hears(20);
    says("t605814AA000000000000\r"); /* identify, token 0xaa */
    const char *answer = hears(1); /* read and answered in one tick */
    TEST_ASSERT_NOT_NULL(strstr(answer, "z\r"));
    TEST_ASSERT_NOT_NULL(strstr(answer, "t585820AA00010002"));
    TEST_ASSERT_NOT_NULL(strstr(answer, "t585821AA"));
    TEST_ASSERT_NOT_NULL(strstr(answer, "t585824AA"));
    TEST_ASSERT_NOT_NULL(strstr(hears(30), "t1858"));
    says("C\r");
    (void)hears(5);
    TEST_ASSERT_EQUAL_STRING("", hears(50));
}

static void test_slcan_refuses_what_is_no_command(void)
{
    static const char *const wrong[] = {"t60\r",
                                        "t6059\r",
                                        "t605814AA00000000000\r",
                                        "t605814AA0000000000000\r",
                                        "t6058G4AA000000000000\r",
                                        "tFFF0\r",
                                        "x\r",
                                        "Z2\r",
                                        "t605814AA000000000000000000000000000000000\r"};
    without_transceiver(NODE);
    says("L\r");
    (void)hears(10);
    says("t605814AA000000000000\r"); /* it only listens */
    TEST_ASSERT_NOT_NULL(strchr(hears(3), '\a'));
    says("C\rO\r");
    (void)hears(10);
    const uint32_t unknown = counters().frames_unknown;
    for (uint32_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        says(wrong[i]);
        const char *answer = hears(6);
        TEST_ASSERT_NOT_NULL_MESSAGE(strchr(answer, '\a'), wrong[i]);
        TEST_ASSERT_NULL_MESSAGE(strstr(answer, "t585"), wrong[i]);
    }
    says("T0000060580102030405060708\r"); /* taken, and for nobody here */
    TEST_ASSERT_NOT_NULL(strstr(hears(6), "Z\r"));
    TEST_ASSERT_EQUAL(unknown, counters().frames_unknown);
}

static void test_a_fresh_board_answers_as_node_0_over_slcan_and_is_silent_otherwise(void)
{
    without_transceiver(0);
    says("O\r");
    TEST_ASSERT_EQUAL_STRING("\r", hears(1500));
    says("t600814AA000000000000\r");
    TEST_ASSERT_NOT_NULL(strstr(hears(4), "t580820AA"));
}

/* Process data, heartbeat and emergency leave through both ports; an answer through the one that was asked. */
static void test_both_ports_carry_the_same_and_neither_waits_for_the_other(void)
{
    brace_can_frame_t frame;
    ticks(20);
    says("O\r");
    (void)hears(10);
    drain();
    fake.can_room = 0; /* nobody acknowledges on the wire: the text goes on */
    says("t605814AA000000000000\r");
    const char *text = hears(1);
    TEST_ASSERT_NOT_NULL(strstr(text, "t585820AA"));
    TEST_ASSERT_NOT_NULL(strstr(text, "t585824AA"));
    TEST_ASSERT_NOT_NULL(strstr(hears(60), "t1858"));
    fake.can_room = 64;
    (void)hears(4);
    drain();
    const uint8_t identify[8] = {BRACE_REQUEST_IDENTIFY, 0xab};
    arrives(0x600 + NODE, identify, 8); /* both in one tick */
    says("t605814AC000000000000\r");
    text = hears(1);
    TEST_ASSERT_NOT_NULL(strstr(text, "t585820AC"));
    TEST_ASSERT_NOT_NULL(strstr(text, "t585824AC"));
    TEST_ASSERT_NULL(strstr(text, "AB00"));
    uint32_t parts = 0;
    while (brace_fake_frame_take(&fake, &frame)) {
        parts += frame.id == 0x580u + NODE && frame.data[1] == 0xab;
        TEST_ASSERT_FALSE(frame.id == 0x580u + NODE && frame.data[1] != 0xab);
    }
    TEST_ASSERT_EQUAL(5, parts);
    fake.joint[BRACE_TIBIA].not_newer = true; /* a fault is is_sent on both */
    text = hears(40);
    TEST_ASSERT_NOT_NULL(strstr(text, "t0858"));
    TEST_ASSERT_NOT_NULL(strstr(text, "t7058"));
    bool is_sent = false;
    while (brace_fake_frame_take(&fake, &frame)) {
        is_sent = is_sent || frame.id == 0x080u + NODE;
    }
    TEST_ASSERT_TRUE(is_sent);
}

static int32_t (*whole_write)(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count);

static int32_t slow_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    return whole_write(context, port, bytes, count < 7u ? count : 7u);
}

/* A line that takes a few bytes a tick: every line of an answer leaves whole, in order, before later ones. */
static void test_text_leaves_as_fast_as_the_line_takes_it(void)
{
    brace_parameters_t p = bench_parameters();
    without_rates(&p);
    bench_start(&p);
    ticks(20);
    says("O\r");
    (void)hears(1100); /* the heartbeat of the opening has gone by */
    whole_write = fake.hal.serial_write;
    fake.hal.serial_write = slow_write;
    says("t605814AA000000000000\r");
    const char *text = hears(40);
    const char *parts[5] = {strstr(text, "t585820AA"), strstr(text, "t585821AA"), strstr(text, "t585822AA"),
                            strstr(text, "t585823AA"), strstr(text, "t585824AA")};
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_NOT_NULL(parts[i]);
        TEST_ASSERT_TRUE(i == 0 || parts[i] == parts[i - 1] + 22);
    }
}

/* --------------------------------------------------------------------------------------- CAN FD -- */

static void start_fd(bool board_can)
{
    brace_parameters_t p = bench_parameters();
    p.controller.can_fd_bit_rate = 2000000;
    p.controller.stiffness_hz = 100;
    p.controller.posture_hz = 20;
    p.controller.load_hz = p.controller.sigma_hz = 0;
    p.controller.bus_load_ratio = 1.0f;
    bench_board();
    fake.can_takes_fd = board_can;
    bench_store(&p);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(50);
    drain();
}

static void test_a_snapshot_is_one_frame_of_can_fd(void)
{
    start_fd(true);
    TEST_ASSERT_EQUAL(2000000, fake.can_setup.fd_bit_rate);
    uint32_t whole = 0, others = 0;
    for (int i = 0; i < 2000; i++) {
        brace_can_frame_t frame;
        ticks(1);
        while (brace_fake_frame_take(&fake, &frame)) {
            if (frame.id != 0x500u + NODE) {
                others++;
                TEST_ASSERT_FALSE(frame.fd);
                TEST_ASSERT_TRUE(frame.id == 0x700u + NODE || frame.id == 0x200u + NODE); /* with its condition */
                continue;
            }
            brace_can_snapshot_fd_t got;
            const brace_snapshot_t *wanted = now();
            TEST_ASSERT_TRUE(frame.fd);
            TEST_ASSERT_EQUAL(64, frame.length);
            brace_can_unpack_snapshot_fd(frame.data, &got);
            TEST_ASSERT_EQUAL_UINT32(wanted->sequence, got.sequence);
            TEST_ASSERT_EQUAL_UINT32(wanted->parameter_crc & 0xffffu, got.parameter_tag);
            TEST_ASSERT_EQUAL_UINT32(wanted->stiffness.now.flags, got.flags);
            TEST_ASSERT_EQUAL(wanted->mode, got.mode);
            TEST_ASSERT_EQUAL_FLOAT(wanted->stiffness.now.k_xx_n_per_mm, got.k_xx_n_per_mm);
            TEST_ASSERT_EQUAL_FLOAT(wanted->stiffness.now.k_xz_n_per_mm, got.k_xz_n_per_mm);
            TEST_ASSERT_EQUAL_FLOAT(wanted->stiffness.now.k_zz_n_per_mm, got.k_zz_n_per_mm);
            TEST_ASSERT_EQUAL_FLOAT(wanted->stiffness.now.lambda_min_n_per_mm, got.lambda_min_n_per_mm);
            TEST_ASSERT_EQUAL_FLOAT(wanted->stiffness.now.lambda_max_n_per_mm, got.lambda_max_n_per_mm);
            TEST_ASSERT_EQUAL_FLOAT(wanted->stiffness.now.stiff_axis_rad, got.stiff_axis_rad);
            TEST_ASSERT_EQUAL_FLOAT(wanted->theta_rad[BRACE_FEMUR], got.theta1_rad);
            TEST_ASSERT_EQUAL_FLOAT(wanted->theta_rad[BRACE_TIBIA], got.theta2_rad);
            TEST_ASSERT_EQUAL_FLOAT(wanted->tip_mm.x_mm, got.tip_x_mm);
            TEST_ASSERT_EQUAL_FLOAT(wanted->tip_mm.z_mm, got.tip_z_mm);
            TEST_ASSERT_EQUAL_FLOAT(wanted->force_x_n, got.force_x_n);
            TEST_ASSERT_FLOAT_WITHIN(0.5f, 0.0f, got.age_ms);
            whole++;
        }
    }
    TEST_ASSERT_UINT32_WITHIN(1, 200, whole);
    TEST_ASSERT_UINT32_WITHIN(2, 4, others);
}

/* By ISO 11898-1 a CAN FD frame of 64 bytes has 30 bits at the bus's rate and 4 for stuffing; at the faster rate 542
 * bits and up to 136 for stuffing. */
static void test_can_fd_is_thinned_to_the_share_of_the_bus(void)
{
    static const uint32_t fd_bit_rate[] = {1000000, 5000000};
    for (int i = 0; i < 2; i++) {
        brace_parameters_t p = bench_parameters();
        p.controller.can_bit_rate = 500000;
        p.controller.can_fd_bit_rate = fd_bit_rate[i];
        p.controller.stiffness_hz = 1000;
        p.controller.posture_hz = p.controller.load_hz = p.controller.sigma_hz = 0;
        p.controller.bus_load_ratio = 0.10f;
        bench_board();
        fake.can_takes_fd = true;
        bench_store(&p);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
        ticks(50);
        drain();
        const count_t seen = run(1000);
        const float whole_s = 34.0f / 500000.0f + (542.0f + 136.0f) / (float)fd_bit_rate[i];
        const float beat_s = (float)worst_bits() / 500000.0f;
        const float taken_s = (float)of(&seen, 0x500) * whole_s + (float)(of(&seen, 0x700) + of(&seen, 0x200)) * beat_s;
        TEST_ASSERT_TRUE(taken_s <= 0.101f);
        TEST_ASSERT_TRUE(taken_s > 0.09f);
    }
}

static void test_where_can_is_classic_only_it_stays_so(void)
{
    start_fd(false);
    TEST_ASSERT_EQUAL(0, fake.can_setup.fd_bit_rate);
    count_t seen = {0};
    brace_can_frame_t frame;
    for (int i = 0; i < 1000; i++) {
        ticks(1);
        while (brace_fake_frame_take(&fake, &frame)) {
            TEST_ASSERT_FALSE(frame.fd);
            seen.function[frame.id >> 7]++;
        }
    }
    TEST_ASSERT_UINT32_WITHIN(1, 100, of(&seen, 0x180));
    TEST_ASSERT_UINT32_WITHIN(1, 100, of(&seen, 0x280));
    TEST_ASSERT_EQUAL(0, of(&seen, 0x500));
}

/* Who listens over SLCAN gets classic frames, and the bus has its CAN FD meanwhile. */
static void test_text_is_classic_beside_can_fd(void)
{
    start_fd(true);
    says("O\r");
    (void)hears(5);
    drain();
    TEST_ASSERT_NOT_NULL(strstr(hears(60), "t185"));
    uint32_t whole = 0;
    brace_can_frame_t frame;
    while (brace_fake_frame_take(&fake, &frame)) {
        whole += frame.fd;
        TEST_ASSERT_TRUE(frame.fd || frame.id == 0x700u + NODE || frame.id == 0x200u + NODE);
    }
    TEST_ASSERT_TRUE(whole >= 2u);
}

/* What concerns the bus takes effect at the next start; until then it goes on as it was set up. */
static void test_can_fd_goes_on_until_the_next_start_whatever_is_put_in_force(void)
{
    start_fd(true);
    brace_parameters_t p = *brace_app_parameters(&app);
    p.controller.can_fd_bit_rate = 0;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_commit(&app, &p));
    for (int i = 0; i < 2000 && brace_app_configuration_leave(&app) != BRACE_OK; i++) {
        ticks(1);
    }
    ticks(50);
    TEST_ASSERT_EQUAL(0, brace_app_parameters(&app)->controller.can_fd_bit_rate);
    drain();
    uint32_t whole = 0;
    brace_can_frame_t frame;
    for (int i = 0; i < 1000; i++) {
        ticks(1);
        while (brace_fake_frame_take(&fake, &frame)) {
            whole += frame.fd;
        }
    }
    TEST_ASSERT_UINT32_WITHIN(1, 100, whole);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_rates_are_the_parameters);
    RUN_TEST(test_rates_of_zero_are_silence_but_for_the_heartbeat);
    RUN_TEST(test_without_a_rate_no_snapshot_is_taken);
    RUN_TEST(test_process_data_are_thinned_to_the_share_of_the_bus);
    RUN_TEST(test_a_share_that_heartbeats_use_up_leaves_little);
    RUN_TEST(test_a_snapshot_leaves_two_frames_at_a_time);
    RUN_TEST(test_all_frames_of_a_snapshot_are_of_one_tick);
    RUN_TEST(test_K_that_is_not_valid_is_never_a_number);
    RUN_TEST(test_four_limbs_take_less_than_a_quarter_of_the_bus_and_begin_apart);
    RUN_TEST(test_floods_leave_tick_heartbeat_and_process_data);
    RUN_TEST(test_a_bus_that_stays_off_is_tried_less_and_less_often);
    RUN_TEST(test_slcan_opens_answers_and_closes);
    RUN_TEST(test_slcan_refuses_what_is_no_command);
    RUN_TEST(test_a_fresh_board_answers_as_node_0_over_slcan_and_is_silent_otherwise);
    RUN_TEST(test_both_ports_carry_the_same_and_neither_waits_for_the_other);
    RUN_TEST(test_text_leaves_as_fast_as_the_line_takes_it);
    RUN_TEST(test_a_snapshot_is_one_frame_of_can_fd);
    RUN_TEST(test_can_fd_is_thinned_to_the_share_of_the_bus);
    RUN_TEST(test_where_can_is_classic_only_it_stays_so);
    RUN_TEST(test_text_is_classic_beside_can_fd);
    RUN_TEST(test_can_fd_goes_on_until_the_next_start_whatever_is_put_in_force);
    return UNITY_END();
}
