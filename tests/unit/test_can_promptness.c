/* K at a posture is answered in the tick that finds the question, whatever else goes on. */
#include "can_bench.h"
#include "modbus_master.h"

enum { QUESTIONS = 4000 };

static uint64_t dice;

void setUp(void)
{
    dice = 0x2545f4914f6cdd1du;
}

void tearDown(void)
{
}

static uint32_t below(uint32_t n)
{
    dice ^= dice << 13;
    dice ^= dice >> 7;
    dice ^= dice << 17;
    return (uint32_t)((dice >> 32) * n >> 32);
}

static float between(float low, float high)
{
    return low + (high - low) * (float)below(65536) / 65536.0f;
}

/* A read, a write that asks for K, or noise; now and then, on either port. */
static void modbus_traffic(void)
{
    uint8_t frame[300] = {UNIT, 4, 0, 0, 0, (uint8_t)(2u + below(100))}, adu[300] = {0, 1, 0, 0, 0, 6, UNIT};
    if (below(6) == 0u) {
        const uint32_t crc = crc_by_bits(frame, 6);
        frame[6] = (uint8_t)crc;
        frame[7] = (uint8_t)((crc >> 8) ^ (below(10) == 0u));
        (void)brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS, frame, 8);
    }
    if (below(6) == 0u) {
        memcpy(adu + 7, frame + 1, 5);
        (void)brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS_TCP, adu, 12);
    }
    uint8_t sink[300];
    (void)brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS, sink, sizeof sink);
    (void)brace_fake_bytes_take(&fake, BRACE_SERIAL_MODBUS_TCP, sink, sizeof sink);
}

/* Others' frames, three at most: with the question there are no more than a tick looks at. */
static void others_talk(void)
{
    const uint8_t data[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    for (uint32_t i = below(4); i > 0u; i--) {
        arrives(0x181u + below(100), data, 8);
    }
}

/* Another's request: what else may be asked at any time. */
static void something_is_asked(void)
{
    uint8_t data[8] = {BRACE_REQUEST_IDENTIFY, 1};
    switch (below(4)) {
    case 0: brace_can_pack_read_entry_request(&(brace_can_read_entry_request_t){1, 0x1000u + below(50)}, data); break;
    case 1: brace_can_pack_friction_margin_request(&(brace_can_friction_margin_request_t){1, 1.5f, 0.6f}, data); break;
    case 2: brace_can_pack_k_at_tip_knee_up_request(&(brace_can_k_at_tip_knee_up_request_t){1, 300.0f, -100.0f}, data); break;
    default: break;
    }
    arrives(0x600u + NODE, data, 8);
}

typedef struct {
    uint32_t k_parts, others;
} heard_t;

static heard_t answers_of_tick(uint8_t token)
{
    heard_t heard = {0, 0};
    brace_can_frame_t frame;
    ticks(1);
    while (brace_fake_frame_take(&fake, &frame)) {
        if (frame.id == 0x580u + NODE) {
            const bool k = (frame.data[0] & 31u) == BRACE_REQUEST_K_AT_POSTURE && frame.data[0] < 0xe0u && frame.data[1] == token;
            heard.k_parts += k;
            heard.others += !k;
        }
    }
    return heard;
}

/* What the worst of many questions waits for, in ticks; each comes alone, right after the last answer or some ticks later.
 *   in_a_row: of the ticks that something is asked in, these questions and others, so many follow each other at most */
static uint32_t worst_wait(void (*between_ticks)(void), uint32_t in_a_row)
{
    uint32_t worst = 0, row = 0;
    for (uint32_t i = 0; i < QUESTIONS; i++) {
        uint8_t data[8];
        const uint8_t token = (uint8_t)i;
        for (uint32_t pause = below(4) + (row >= in_a_row); pause > 0u; pause--) {
            const bool asks = row + 1u < in_a_row && below(2) == 0u;
            row = asks ? row + 1u : 0u;
            modbus_traffic();
            between_ticks();
            if (asks) {
                something_is_asked();
            }
            (void)answers_of_tick(0);
        }
        row++;
        modbus_traffic();
        others_talk();
        brace_can_pack_k_at_posture_request(
            &(brace_can_k_at_posture_request_t){token, between(-1.5f, 2.5f), between(-1.5f, 2.5f)}, data);
        arrives(0x600u + NODE, data, 8);
        uint32_t waited = 1;
        while (answers_of_tick(token).k_parts < 3u) {
            waited++;
            TEST_ASSERT_TRUE(waited < 20u);
        }
        worst = waited > worst ? waited : worst;
    }
    return worst;
}

static void nothing(void)
{
}

static const brace_loading_setup_t test_along_x = {
    .axis = BRACE_AXIS_X, .steps_per_side = 2, .step_mm = 0.2f, .dwell_us = 20000, .rate_mm_per_s = 100.0f,
    .force_max_n = 1000.0f, .torque_max_n_mm = 8000.0f, .source = BRACE_LOADING_COMMANDED};

static uint32_t tests_run;

/* One loading test after another, whatever comes of it. */
static void tests_go_on(void)
{
    if (brace_app_loading_start(&app, &test_along_x) == BRACE_OK) {
        tests_run++;
    }
}

static brace_parameters_t general_limb(void)
{
    brace_parameters_t p = bench_parameters();
    p.controller.modbus_address = UNIT;
    p.limb.base.x_mm_per_n = 0.01f;
    p.slow.joint_compliance_per_degc = 0.004f;
    return p;
}

static void start(const brace_parameters_t *p)
{
    bench_start(p);
    ticks(50);
    drain();
}

static void test_on_a_limb_that_collapses(void)
{
    brace_parameters_t p = bench_parameters();
    p.controller.modbus_address = UNIT;
    start(&p);
    const uint32_t first = now()->sequence, started = fake.now_us;
    TEST_ASSERT_EQUAL(1, worst_wait(nothing, QUESTIONS));
    /* K of every tick, but where Modbus has its turn beside an answer */
    TEST_ASSERT_TRUE(now()->sequence - first >= (fake.now_us - started) / TICK_US * 7u / 8u);
    TEST_ASSERT_EQUAL(1, worst_wait(nothing, 1));
}

static void test_on_the_general_path(void)
{
    const brace_parameters_t p = general_limb();
    start(&p);
    TEST_ASSERT_FALSE(app.model.collapsed);
    const uint32_t first = now()->sequence, started = fake.now_us;
    TEST_ASSERT_EQUAL(1, worst_wait(nothing, QUESTIONS));
    TEST_ASSERT_TRUE(now()->sequence - first >= (fake.now_us - started) / TICK_US / 2u);
    TEST_ASSERT_EQUAL(1, worst_wait(nothing, 1));
}

static void test_beside_a_loading_test(void)
{
    brace_parameters_t p = bench_parameters();
    p.controller.modbus_address = UNIT;
    start(&p);
    tests_run = 0;
    TEST_ASSERT_EQUAL(1, worst_wait(tests_go_on, QUESTIONS));
    TEST_ASSERT_TRUE(tests_run >= 3u);
    p = general_limb();
    start(&p);
    tests_run = 0;
    TEST_ASSERT_EQUAL(1, worst_wait(tests_go_on, 3));
    TEST_ASSERT_TRUE(tests_run >= 3u);
}

/* Where K yields to an answer it comes in one of five ticks all the same: what comes after
 * three questions in a row may wait for it. */
static void test_K_goes_on_where_it_yields(void)
{
    brace_parameters_t p = general_limb();
    p.limb.joint[BRACE_FEMUR].gap_rad = p.limb.joint[BRACE_TIBIA].gap_rad = 0.01f;
    start(&p);
    TEST_ASSERT_TRUE(app.play[0].watched && app.play[1].watched);
    TEST_ASSERT_EQUAL(1, worst_wait(nothing, 3));
    const uint32_t first = now()->sequence, started = fake.now_us;
    TEST_ASSERT_EQUAL(2, worst_wait(nothing, QUESTIONS));
    TEST_ASSERT_TRUE(now()->sequence - first >= (fake.now_us - started) / TICK_US / 6u);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_on_a_limb_that_collapses);
    RUN_TEST(test_on_the_general_path);
    RUN_TEST(test_beside_a_loading_test);
    RUN_TEST(test_K_goes_on_where_it_yields);
    return UNITY_END();
}
