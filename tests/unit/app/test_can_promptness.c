/* A question for K is answered in turn, any other request in the tick that takes it, and every tick reports K of its
 * own samples, whatever else goes on. */
#include "can_bench.h"
#include "modbus_master.h"

enum { QUESTIONS = ON_BOARD ? 500 : 4000 }; /* waits are counted in ticks */

/* A K takes three ticks: taken, worked out, answered. Masters of a port take turns, so one other question may stand
 * before it, and moves it on by two where it is about K. Other jobs have a step after eight, and a tick that sends much
 * has none. While a set is put in force, no K is worked out: the model may still be that of the set before. */
enum { JOBS_TICKS = 2, K_MOST_TICKS = K_TICKS + 2 + JOBS_TICKS, IN_FORCE_TICKS = 9 };

static uint64_t dice;

void setUp(void)
{
    dice = 0x2545f4914f6cdd1du;
}

void tearDown(void) {}

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
    case 2:
        brace_can_pack_k_at_tip_knee_up_request(&(brace_can_k_at_tip_knee_up_request_t){1, 300.0f, -100.0f}, data);
        break;
    default: break;
    }
    arrives(0x600u + NODE, data, 8);
}

/* Nothing but the dearest question. */
static void the_tip_is_asked(void)
{
    uint8_t data[8];
    brace_can_pack_k_at_tip_knee_up_request(&(brace_can_k_at_tip_knee_up_request_t){1, 300.0f, -100.0f}, data);
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
            const bool ours = answered_code(frame.data) == BRACE_REQUEST_K_AT_POSTURE && frame.data[1] == token;
            heard.k_parts += ours && !is_refusal(frame.data);
            heard.others += !ours;
        }
    }
    return heard;
}

/* What goes on between the questions for K. */
typedef struct {
    void (*between)(void); /* in each tick */
    void (*asks)(void);    /* what else is asked, in half of the ticks */
} traffic_t;

static uint32_t last_sequence;
/* Ticks in MONITOR, TAKING_UP and LOADING_TEST; and those of them that report K of their own samples. */
static uint32_t ticks_watched, ticks_with_k;

/* After every tick: a new snapshot, of the tick's own samples. */
static void watch_k(void)
{
    const brace_snapshot_t *snapshot = now();
    const bool reports_k = snapshot->mode == BRACE_MODE_MONITOR || snapshot->mode == BRACE_MODE_TAKING_UP ||
                           snapshot->mode == BRACE_MODE_LOADING_TEST;
    ticks_watched += reports_k;
    ticks_with_k += reports_k && snapshot->k_is_valid && snapshot->taken_us == fake.now_us &&
                    snapshot->sequence == last_sequence + 1u;
    last_sequence = snapshot->sequence;
}

/* What the worst of many questions waits for, in ticks; each comes alone, right after the last answer or some ticks
 * later, and in the ticks between something else is asked: any number of ticks in a row has a request. */
static uint32_t worst_wait(const traffic_t *traffic)
{
    uint32_t worst = 0;
    ticks_watched = ticks_with_k = 0;
    last_sequence = now()->sequence;
    for (uint32_t i = 0; i < QUESTIONS; i++) {
        uint8_t data[8];
        const uint8_t token = (uint8_t)(0x10u + i % 0xf0u); /* whoever else asks is master 0 */
        for (uint32_t pause = below(4); pause > 0u; pause--) {
            modbus_traffic();
            traffic->between();
            if (below(2) == 0u) {
                traffic->asks();
            }
            (void)answers_of_tick(0);
            watch_k();
        }
        modbus_traffic();
        others_talk();
        traffic->between();
        brace_can_pack_k_at_posture_request(
            &(brace_can_k_at_posture_request_t){token, between(-1.5f, 2.5f), between(-1.5f, 2.5f)}, data);
        arrives(0x600u + NODE, data, 8);
        for (uint32_t waited = 1;; waited++) {
            const heard_t heard = answers_of_tick(token);
            watch_k();
            worst = waited > worst ? waited : worst;
            if (heard.k_parts == 4u) {
                break;
            }
            TEST_ASSERT_TRUE(waited < 20u);
        }
    }
    return worst;
}

static void nothing(void) {}

static const traffic_t some = {nothing, something_is_asked};

static const brace_loading_setup_t test_along_x = {.axis = BRACE_AXIS_X,
                                                   .steps_per_side = 2,
                                                   .step_mm = 0.2f,
                                                   .dwell_us = 20000,
                                                   .rate_mm_per_s = 100.0f,
                                                   .force_max_n = 1000.0f,
                                                   .torque_max_n_mm = 8000.0f,
                                                   .source = BRACE_LOADING_COMMANDED};

static uint32_t tests_run;

/* One loading test after another, whatever comes of it. */
static void tests_go_on(void)
{
    if (brace_app_loading_start(&app, &test_along_x) == BRACE_OK) {
        tests_run++;
    }
}

static brace_parameters_t plain_limb(void)
{
    brace_parameters_t p = bench_parameters();
    p.controller.modbus_address = UNIT;
    return p;
}

static brace_parameters_t general_limb(void)
{
    brace_parameters_t p = plain_limb();
    p.limb.base.x_mm_per_n = 0.01f;
    p.slow.joint_compliance_per_degc = 0.004f;
    return p;
}

static brace_parameters_t with_play(brace_parameters_t p)
{
    p.limb.joint[BRACE_FEMUR].gap_rad = p.limb.joint[BRACE_TIBIA].gap_rad = 0.01f;
    return p;
}

/* Motors go where they are commanded. */
static void follow(void *user, brace_fake_t *board, int32_t joint)
{
    static const float stands_rad[] = {0.0f, 1.0f, 1.4f};
    (void)user;
    board->joint[joint].sample.motor_rad = stands_rad[joint] + board->joint[joint].command.offset_rad;
}

static void start(const brace_parameters_t *p)
{
    bench_start(p);
    fake.play = follow;
    ticks(50);
    drain();
}

/* Under all this traffic a question is answered in time, and every tick has its K. */
static void answers_and_computes(const traffic_t *traffic, uint32_t most_ticks)
{
    TEST_ASSERT_LESS_OR_EQUAL(most_ticks, worst_wait(traffic));
    printf("K of the tick's own samples in %u of %u ticks\n", (unsigned)ticks_with_k, (unsigned)ticks_watched);
    TEST_ASSERT_TRUE(ticks_watched > QUESTIONS);
    TEST_ASSERT_EQUAL(ticks_watched, ticks_with_k);
}

static void test_on_a_limb_that_collapses(void)
{
    const brace_parameters_t p = plain_limb(), q = with_play(p);
    start(&p);
    answers_and_computes(&some, K_MOST_TICKS);
    start(&q);
    answers_and_computes(&some, K_MOST_TICKS);
}

static void test_on_the_general_path(void)
{
    const brace_parameters_t p = general_limb();
    start(&p);
    answers_and_computes(&some, K_MOST_TICKS);
}

static void test_with_play_in_both_joints(void)
{
    const brace_parameters_t p = with_play(general_limb());
    start(&p);
    answers_and_computes(&some, K_MOST_TICKS);
}

/* Nothing but the dearest question, in every tick. */
static void test_behind_questions_for_the_tip(void)
{
    const traffic_t tips = {nothing, the_tip_is_asked};
    const brace_parameters_t p = with_play(general_limb());
    start(&p);
    answers_and_computes(&tips, K_MOST_TICKS);
    last_sequence = now()->sequence;
    ticks_watched = ticks_with_k = 0;
    for (uint32_t i = 0; i < 750u * TIMES_ON_HOST; i++) {
        modbus_traffic();
        the_tip_is_asked();
        uint32_t parts = 0;
        for (uint32_t waited = 0; waited < (uint32_t)K_TICKS && parts == 0u; waited++) {
            parts = answers_of_tick(0).others;
            watch_k();
        }
        TEST_ASSERT_EQUAL(4, parts);
    }
    TEST_ASSERT_EQUAL(ticks_watched, ticks_with_k);
}

static void test_beside_a_loading_test(void)
{
    const traffic_t tests = {tests_go_on, something_is_asked};
    const brace_parameters_t limbs[] = {plain_limb(), with_play(plain_limb()), general_limb(),
                                        with_play(general_limb())};
    for (uint32_t i = 0; i < 4u; i++) {
        start(&limbs[i]);
        tests_run = 0;
        answers_and_computes(&tests, K_MOST_TICKS + JOBS_TICKS);
        TEST_ASSERT_TRUE(tests_run >= 3u);
    }
}

static uint32_t sets_stored;
static brace_parameters_t sets[2];

/* One set after another is stored and put in force; K is answered by the one in force. */
static void sets_go_on(void)
{
    if (now()->mode == BRACE_MODE_MONITOR) {
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    }
    if (brace_app_parameters_commit(&app, &sets[sets_stored & 1u]) == BRACE_OK) {
        sets_stored++;
    }
}

static void test_while_parameters_are_stored_and_put_in_force(void)
{
    const traffic_t storing = {sets_go_on, something_is_asked};
    sets[0] = with_play(general_limb());
    sets[1] = plain_limb();
    start(&sets[1]);
    sets_stored = 0;
    TEST_ASSERT_LESS_OR_EQUAL(K_MOST_TICKS + JOBS_TICKS + IN_FORCE_TICKS, worst_wait(&storing));
    TEST_ASSERT_TRUE(sets_stored >= 10u);
}

static void say(const char *text)
{
    const uint32_t length = (uint32_t)strlen(text);
    TEST_ASSERT_EQUAL(length, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_SLCAN, (const uint8_t *)text, length));
}

/* Parts of K's answer to a token among the lines of a tick; what else is said comes between them. */
static uint32_t parts_as_text(uint32_t token)
{
    char text[600], part[16];
    uint32_t parts = 0;
    const uint32_t length = brace_fake_bytes_take(&fake, BRACE_SERIAL_SLCAN, (uint8_t *)text, sizeof text - 1u);
    text[length] = '\0';
    for (uint32_t i = 0; i < 4u; i++) {
        (void)snprintf(part, sizeof part, "t5858%02X%02X", (unsigned)answer_number(BRACE_REQUEST_K_AT_POSTURE, i),
                       (unsigned)token);
        parts += strstr(text, part) != NULL;
    }
    return parts;
}

/* A question as text, with a token. */
static void k_is_asked_as_text(uint8_t token)
{
    char line[40];
    uint8_t data[8];
    brace_can_pack_k_at_posture_request(
        &(brace_can_k_at_posture_request_t){token, between(-1.5f, 2.5f), between(-1.5f, 2.5f)}, data);
    uint32_t at = (uint32_t)snprintf(line, sizeof line, "t6058");
    for (uint32_t j = 0; j < 8u; j++) {
        at += (uint32_t)snprintf(line + at, sizeof line - at, "%02x", data[j]);
    }
    (void)snprintf(line + at, sizeof line - at, "\r");
    say(line);
}

/* Text is answered in turn with the bus, and both Modbus ports as busy as they can be: each K moves the other by
 * two. */
static void test_over_slcan(void)
{
    const brace_parameters_t p = with_play(general_limb());
    start(&p);
    say("O\r");
    ticks(2);
    (void)parts_as_text(0);
    last_sequence = now()->sequence;
    ticks_watched = ticks_with_k = 0;
    for (uint32_t i = 0; i < 250u * TIMES_ON_HOST; i++) {
        const uint8_t token = (uint8_t)i;
        modbus_traffic();
        the_tip_is_asked();
        k_is_asked_as_text(token);
        uint32_t on_bus = 0, as_text = 0;
        for (uint32_t waited = 0; waited < (uint32_t)K_TICKS + 2u + JOBS_TICKS; waited++) {
            on_bus += answers_of_tick(0).others;
            as_text += parts_as_text(token);
            watch_k();
        }
        TEST_ASSERT_EQUAL(4, on_bus);
        TEST_ASSERT_EQUAL(4, as_text);
    }
    TEST_ASSERT_EQUAL(ticks_watched, ticks_with_k);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_on_a_limb_that_collapses);
    RUN_TEST(test_on_the_general_path);
    RUN_TEST(test_with_play_in_both_joints);
    RUN_TEST(test_behind_questions_for_the_tip);
    RUN_TEST(test_beside_a_loading_test);
    RUN_TEST(test_over_slcan);
    RUN_TEST(test_while_parameters_are_stored_and_put_in_force);
    return UNITY_END();
}
