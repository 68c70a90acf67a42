/* What a node says unasked over CAN: an emergency for every change of its faults, a heartbeat at its rate and for every
 * change of its mode. */
#include "wire/can/announce.h"

#include "can_bench.h"

static announce_t announce;
static brace_app_counters_t counted;
static wire_tick_t tick;

void setUp(void)
{
    brace_parameters_t p = bench_parameters();
    p.controller.heartbeat_hz = 8;
    bench_start(&p);
    ticks(10);
    memset(&announce, 0, sizeof announce);
    tick = (wire_tick_t){.hal = &fake.hal, .app = &app, .counters = &counted, .now_us = fake.now_us};
    announce_skip(&announce, &tick);
    announce.beat_us = tick.now_us;
}

void tearDown(void) {}

static brace_can_emergency_t emergency(void)
{
    brace_can_frame_t frame;
    brace_can_emergency_t reported = {0};
    TEST_ASSERT_TRUE(announce_next(&announce, &tick, &frame));
    TEST_ASSERT_EQUAL_HEX32(BRACE_CAN_ID_EMERGENCY, frame.id);
    TEST_ASSERT_EQUAL(8, frame.length);
    TEST_ASSERT_FALSE(frame.fd);
    brace_can_unpack_emergency(frame.data, &reported);
    return reported;
}

static bool is_silent(void)
{
    brace_can_frame_t frame;
    return !announce_next(&announce, &tick, &frame);
}

/* Each fault has a code of its own; of several new ones the lowest is named; none new: 0x1000; none at all: 0. */
static void test_every_change_of_the_faults_is_reported_once(void)
{
    uint32_t seen[BRACE_FAULT_COUNT];
    for (uint32_t bit = 0; bit < (uint32_t)BRACE_FAULT_COUNT; bit++) {
        const uint32_t fault = 1u << bit, higher = bit + 1u < (uint32_t)BRACE_FAULT_COUNT ? fault << 1 : 0u;
        TEST_ASSERT_TRUE(is_silent());
        app.controller.faults.now = fault | higher;
        const brace_can_emergency_t both = emergency();
        seen[bit] = both.error_code;
        TEST_ASSERT_NOT_EQUAL(0, both.error_code);
        TEST_ASSERT_NOT_EQUAL(0x1000, both.error_code);
        TEST_ASSERT_EQUAL(1, both.error_register);
        TEST_ASSERT_EQUAL_HEX32(fault | higher, both.faults);
        TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, both.mode);
        announce_sent(&announce, &tick, BRACE_CAN_ID_EMERGENCY);
        TEST_ASSERT_TRUE(is_silent());
        if (higher != 0u) {
            app.controller.faults.now = higher;
            TEST_ASSERT_EQUAL_HEX32(0x1000, emergency().error_code);
            announce_sent(&announce, &tick, BRACE_CAN_ID_EMERGENCY);
        }
        app.controller.faults.now = 0;
        const brace_can_emergency_t over = emergency();
        TEST_ASSERT_EQUAL_HEX32(0, over.error_code);
        TEST_ASSERT_EQUAL(0, over.error_register);
        announce_sent(&announce, &tick, BRACE_CAN_ID_EMERGENCY);
    }
    int apart = 0;
    for (int i = 1; i < (int)BRACE_FAULT_COUNT; i++) {
        apart += seen[i] != seen[0];
    }
    TEST_ASSERT_GREATER_THAN(BRACE_FAULT_COUNT / 2, apart);
}

/* Each heartbeat has the condition behind it, which lists all faults that there are. */
static brace_can_condition_t condition(void)
{
    brace_can_frame_t frame;
    brace_can_condition_t reported;
    TEST_ASSERT_TRUE(announce_next(&announce, &tick, &frame));
    TEST_ASSERT_EQUAL_HEX32(BRACE_CAN_ID_DETAILS, frame.id);
    TEST_ASSERT_EQUAL(8, frame.length);
    brace_can_unpack_condition(frame.data, &reported);
    announce_sent(&announce, &tick, BRACE_CAN_ID_DETAILS);
    return reported;
}

static void test_a_heart_beats_at_its_rate(void)
{
    brace_can_frame_t frame;
    tick.now_us = announce.beat_us + 124999u; /* 8 Hz */
    TEST_ASSERT_TRUE(is_silent());
    tick.now_us = announce.beat_us + 125000u;
    TEST_ASSERT_TRUE(announce_next(&announce, &tick, &frame));
    TEST_ASSERT_EQUAL_HEX32(BRACE_CAN_ID_HEARTBEAT, frame.id);
    announce_sent(&announce, &tick, BRACE_CAN_ID_HEARTBEAT);
    (void)condition();
    TEST_ASSERT_TRUE(is_silent());
    tick.now_us = announce.beat_us + 4000000000u; /* however long it was silent */
    TEST_ASSERT_TRUE(announce_next(&announce, &tick, &frame));
}

static void test_every_change_of_the_mode_is_reported_once(void)
{
    static const struct {
        brace_mode_t mode;
        uint32_t state;
    } row[] = {{BRACE_MODE_START, 0x00},     {BRACE_MODE_CONFIGURATION, 0x7f}, {BRACE_MODE_FAULT, 0x04},
               {BRACE_MODE_TAKING_UP, 0x05}, {BRACE_MODE_LOADING_TEST, 0x05},  {BRACE_MODE_MONITOR, 0x05}};
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        brace_can_frame_t frame;
        brace_can_heartbeat_t reported;
        app.controller.mode.now = row[i].mode;
        TEST_ASSERT_TRUE(announce_next(&announce, &tick, &frame));
        TEST_ASSERT_EQUAL_HEX32(BRACE_CAN_ID_HEARTBEAT, frame.id);
        TEST_ASSERT_EQUAL(8, frame.length);
        brace_can_unpack_heartbeat(frame.data, &reported);
        TEST_ASSERT_EQUAL_HEX32(row[i].state, reported.state);
        TEST_ASSERT_EQUAL(row[i].mode, reported.mode);
        TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, reported.setting);
        announce_sent(&announce, &tick, BRACE_CAN_ID_HEARTBEAT);
        const brace_can_condition_t has = condition();
        TEST_ASSERT_EQUAL_HEX32(0, has.faults);
        TEST_ASSERT_EQUAL(row[i].mode, has.mode);
        TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, has.setting);
        TEST_ASSERT_TRUE(is_silent());
    }
    app.controller.mode.now = BRACE_MODE_FAULT;
    app.controller.faults.now = BRACE_FAULT_MEMORY; /* faults first */
    (void)emergency();
    announce_sent(&announce, &tick, BRACE_CAN_ID_EMERGENCY);
    brace_can_frame_t frame;
    brace_can_heartbeat_t reported;
    TEST_ASSERT_TRUE(announce_next(&announce, &tick, &frame)); /* then the heartbeat, and the faults that there are */
    brace_can_unpack_heartbeat(frame.data, &reported);
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, reported.mode);
    announce_sent(&announce, &tick, BRACE_CAN_ID_HEARTBEAT);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FAULT_MEMORY, condition().faults);
    app.controller.faults.now = 0;
    announce_skip(&announce, &tick); /* a channel that has just opened does not get earlier changes */
    TEST_ASSERT_TRUE(is_silent());
}

/* The emergency message of a drift names the likeliest cause. A new one goes out when the cause changes, and
 * one when the fault ends. */
static void test_every_cause_of_a_drift_is_reported_once(void)
{
    brace_drift_report_t *report = &app.controller.drift.report;
    app.controller.faults.now = BRACE_FAULT_MODEL_DRIFT | BRACE_FAULT_MEMORY;
    report->state = BRACE_DRIFT_DRIFTED;
    uint32_t code = 0;
    for (int cause = 0; cause < (int)BRACE_DRIFT_CAUSE_COUNT; cause++) {
        report->cause = (brace_drift_cause_t)cause;
        const brace_can_emergency_t reported = emergency();
        TEST_ASSERT_EQUAL(cause + 1, reported.drift_cause);
        if (cause == 0) {
            app.controller.faults.now = BRACE_FAULT_MODEL_DRIFT;
            code = emergency().error_code;
            app.controller.faults.now |= BRACE_FAULT_MEMORY;
        } else { /* of the faults, it is the drift that has changed */
            TEST_ASSERT_EQUAL_HEX32(code, reported.error_code);
        }
        if (cause == 1) {
            announce_skip(&announce, &tick);
        } else {
            announce_sent(&announce, &tick, BRACE_CAN_ID_EMERGENCY);
        }
        TEST_ASSERT_TRUE(is_silent());
    }
    app.controller.faults.now = BRACE_FAULT_MEMORY;
    TEST_ASSERT_EQUAL(BRACE_DRIFT_CAUSE_NONE, emergency().drift_cause);
    announce_skip(&announce, &tick);
    TEST_ASSERT_TRUE(is_silent());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_change_of_the_faults_is_reported_once);
    RUN_TEST(test_every_cause_of_a_drift_is_reported_once);
    RUN_TEST(test_a_heart_beats_at_its_rate);
    RUN_TEST(test_every_change_of_the_mode_is_reported_once);
    return UNITY_END();
}
