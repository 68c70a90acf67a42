/* Heartbeat and emergency on CAN: who speaks, what and when; a bus that goes off, a bus that is flooded. */
#include "app_bench.h"
#include "brace/can_messages.h"
#include "brace/refusals.h"

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    bench_start(&p);
}

void tearDown(void) {}

static uint32_t u32(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

/* The next frame with an identifier within `count` ticks. */
static bool frame_with(uint32_t id, int count, brace_can_frame_t *frame)
{
    for (int i = 0; i < count; i++) {
        while (brace_fake_frame_take(&fake, frame)) {
            if (frame->id == id) {
                return true;
            }
        }
        ticks(1);
    }
    return false;
}

static int frames(uint32_t id, int count)
{
    brace_can_frame_t frame;
    int seen = 0;
    for (int i = 0; i < count; i++) {
        ticks(1);
        while (brace_fake_frame_take(&fake, &frame)) {
            seen += frame.id == id;
        }
    }
    return seen;
}

static void test_a_heartbeat_each_second_reports_mode_faults_and_dictionary(void)
{
    brace_can_frame_t frame;
    TEST_ASSERT_TRUE(frame_with(0x705, 10, &frame)); /* the mode has changed */
    TEST_ASSERT_EQUAL(8, frame.length);
    TEST_ASSERT_EQUAL_HEX8(0x05, frame.data[0]);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, frame.data[1]);
    TEST_ASSERT_EQUAL_HEX8(BRACE_SETTING_BENCH, frame.data[2]);
    TEST_ASSERT_EQUAL(2, frame.data[3]); /* the protocol */
    TEST_ASSERT_EQUAL_HEX32(BRACE_DICTIONARY_HASH, u32(&frame.data[4]));
    TEST_ASSERT_EQUAL(10, frames(0x705, 10005));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    TEST_ASSERT_TRUE(frame_with(0x705, 10, &frame));
    TEST_ASSERT_EQUAL_HEX8(0x7f, frame.data[0]);
}

/* Whoever begins to listen knows every fault within a second, though nothing changes. */
static void test_a_newcomer_knows_the_faults_within_a_second(void)
{
    brace_can_frame_t frame;
    ticks(10);
    fake.joint[BRACE_TIBIA].not_newer = true;
    ticks(1500);
    while (brace_fake_frame_take(&fake, &frame)) { /* nobody has heard that */
    }
    TEST_ASSERT_TRUE(frame_with(0x705, 1000, &frame));
    do { /* in the tick behind it */
        TEST_ASSERT_TRUE(frame_with(0x205, 2, &frame));
    } while (brace_can_details_part(frame.data) != BRACE_CAN_PART_CONDITION);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FAULT_SENSOR_TIBIA, u32(&frame.data[2]));
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, frame.data[6]);
    TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, frame.data[7]);
}

static void test_a_fault_is_reported_at_once_and_so_is_its_end(void)
{
    brace_can_frame_t frame;
    ticks(10);
    TEST_ASSERT_FALSE(frame_with(0x085, 20, &frame));
    fake.joint[BRACE_TIBIA].not_newer = true;
    TEST_ASSERT_TRUE(frame_with(0x085, 25, &frame));
    TEST_ASSERT_EQUAL_HEX16(0x7300, frame.data[0] | frame.data[1] << 8);
    TEST_ASSERT_EQUAL(1, frame.data[2]);
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, frame.data[3]);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FAULT_SENSOR_TIBIA, u32(&frame.data[4]));
    TEST_ASSERT_TRUE(frame_with(0x705, 5, &frame));
    TEST_ASSERT_EQUAL_HEX8(0x04, frame.data[0]);
    fake.joint[BRACE_TIBIA].not_newer = false;
    TEST_ASSERT_TRUE(frame_with(0x085, 120, &frame));
    TEST_ASSERT_EQUAL_HEX16(0, frame.data[0] | frame.data[1] << 8);
    TEST_ASSERT_EQUAL_HEX32(0, u32(&frame.data[4]));
    TEST_ASSERT_EQUAL(0, frames(0x085, 500));
}

static void test_a_node_without_a_number_listens_and_is_silent(void)
{
    brace_parameters_t p = bench_parameters();
    p.controller.node_id = 0;
    bench_start(&p);
    TEST_ASSERT_TRUE(fake.can_setup.listen_only);
    ticks(3000);
    TEST_ASSERT_EQUAL(0, fake.calls[BRACE_FAKE_CAN_SEND]);
}

static void test_the_bit_rate_is_the_parameters(void)
{
    brace_parameters_t p = bench_parameters();
    p.controller.can_bit_rate = 250000;
    bench_start(&p);
    TEST_ASSERT_EQUAL(250000, fake.can_setup.bit_rate);
    TEST_ASSERT_FALSE(fake.can_setup.listen_only);
}

static void test_a_board_without_can_or_whose_can_does_not_start_works(void)
{
    brace_fake_without_can(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(1500);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    setUp();
    brace_fake_fail_next(&fake, BRACE_FAKE_CAN_SETUP, 1, BRACE_HAL_E_DEVICE);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    const uint32_t sent = fake.calls[BRACE_FAKE_CAN_SEND];
    ticks(1500);
    TEST_ASSERT_EQUAL(sent, fake.calls[BRACE_FAKE_CAN_SEND]);
    TEST_ASSERT_TRUE(now()->k_is_valid);
}

static void test_a_set_up_that_failed_is_a_fault_and_is_tried_again(void)
{
    brace_can_frame_t frame;
    brace_fake_fail_next(&fake, BRACE_FAKE_CAN_SETUP, 2, BRACE_HAL_E_DEVICE);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(1900);
    TEST_ASSERT_EQUAL(BRACE_FAULT_CAN_BUS_OFF, now()->faults);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    ticks(2000); /* tried again in vain */
    TEST_ASSERT_EQUAL(BRACE_FAULT_CAN_BUS_OFF, now()->faults);
    ticks(300); /* and once more */
    TEST_ASSERT_EQUAL(0, now()->faults);
    TEST_ASSERT_TRUE(frame_with(0x705, 1100, &frame));
}

static void test_only_requests_to_this_node_are_let_in(void)
{
    TEST_ASSERT_EQUAL_HEX32(0x605, fake.can_setup.filter_id);
    TEST_ASSERT_EQUAL_HEX32(0x7ff, fake.can_setup.filter_mask);
}

static void test_requests_that_found_no_room_are_counted_and_reported(void)
{
    const brace_can_frame_t request = {.id = 0x605, .length = 8, .data = {1}};
    ticks(10);
    while (brace_fake_frame_arrives(&fake, &request)) {
    }
    ticks(20);
    TEST_ASSERT_EQUAL(1, counters().frames_lost);
    TEST_ASSERT_EQUAL(1, app.wires.measured.frames_lost);
}

static void test_a_full_mailbox_delays_a_frame_and_does_not_lose_it(void)
{
    ticks(10);
    brace_can_frame_t frame;
    while (brace_fake_frame_take(&fake, &frame)) {
    }
    fake.can_room = 0;
    fake.joint[BRACE_FEMUR].not_newer = true;
    ticks(200);
    TEST_ASSERT_FALSE(brace_fake_frame_take(&fake, &frame));
    fake.can_room = 1;
    ticks(1);
    TEST_ASSERT_TRUE(brace_fake_frame_take(&fake, &frame));
    TEST_ASSERT_EQUAL_HEX32(0x085, frame.id);
    TEST_ASSERT_EQUAL(0, counters().frames_refused);
}

static void test_bus_off_is_a_fault_recovery_is_tried_and_K_stays_valid(void)
{
    ticks(10);
    fake.can_health.bus_off = true;
    ticks(1000);
    TEST_ASSERT_EQUAL(BRACE_FAULT_CAN_BUS_OFF, now()->faults);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_TRUE(fake.calls[BRACE_FAKE_CAN_RECOVER] >= 3 && fake.calls[BRACE_FAKE_CAN_RECOVER] <= 4);
    fake.can_health.bus_off = false;
    ticks(120);
    TEST_ASSERT_EQUAL(0, now()->faults);
    brace_can_frame_t frame;
    TEST_ASSERT_TRUE(frame_with(0x705, 1100, &frame));
}

/* Whoever owns the limb over a bus that is off, or over a channel that is closed, is gone; others stay. */
static void test_a_port_that_is_closed_has_no_owner(void)
{
    static const uint8_t ports[] = {BRACE_ASKER_CAN, BRACE_ASKER_SLCAN, BRACE_ASKER_MODBUS_LINE};
    session_t *session = &app.controller.ownership.session;
    for (int is_off = 0; is_off < 2; is_off++) {
        fake.can_health.bus_off = is_off != 0;
        ticks(100); /* its health is asked for now and then */
        for (int i = 0; i < 3; i++) { /* nobody has opened the channel of text */
            session->is_open = session->is_alive = true;
            session->owner = (brace_who_t){ports[i], 0};
            session->silent_us = 0;
            app.controller.takeup.count = 0;
            brace_app_t *const same = &app;
            const wire_tick_t tick = {.hal = &fake.hal,
                                      .app = same,
                                      .counters = &app.controller.counters,
                                      .measured = &app.wires.measured,
                                      .now_us = fake.now_us};
            (void)can_speak(&app.wires.can, &tick, 2);
            const bool is_gone = i == 1 || (i == 0 && is_off != 0);
            TEST_ASSERT_EQUAL(!is_gone, session->is_open);
        }
    }
}

static void test_frames_for_nobody_are_counted_and_a_flood_is_borne(void)
{
    const brace_can_frame_t stranger = {.id = 0x7a3, .length = 8};
    ticks(10);
    uint32_t arrived = 0;
    for (int i = 0; i < 1000; i++) {
        for (int n = 0; n < 10; n++) {
            arrived += brace_fake_frame_arrives(&fake, &stranger);
        }
        ticks(1);
        TEST_ASSERT_TRUE(now()->k_is_valid);
    }
    ticks(20);
    TEST_ASSERT_EQUAL(arrived, counters().frames_unknown);
    brace_can_frame_t frame;
    TEST_ASSERT_TRUE(frame_with(0x705, 1100, &frame)); /* its heart beats on */
}

/* A request that is refused is known nevertheless, whatever the reason is; and so is one that is answered. */
static void test_only_a_request_that_does_not_exist_is_unknown(void)
{
    static const struct {
        brace_can_frame_t frame;
        int32_t status;
    } row[] = {{{.id = 0x605, .length = 8, .data = {BRACE_REQUEST_IDENTIFY, 1}}, BRACE_OK},
               {{.id = 0x605, .length = 8, .data = {BRACE_REQUEST_K_AT_POSTURE, 1, 0, 0, 0x80, 0, 0, 0x80}},
                BRACE_E_NOT_FINITE},
               {{.id = 0x605, .length = 8, .data = {BRACE_REQUEST_SET_MODE, 1}}, BRACE_REFUSED_KEY},
               {{.id = 0x605, .length = 8, .data = {0, 1}}, BRACE_REFUSED_UNKNOWN}};
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        brace_can_frame_t answer = {.id = 0};
        const uint32_t before = counters().frames_unknown;
        TEST_ASSERT_TRUE(brace_fake_frame_arrives(&fake, &row[i].frame));
        TEST_ASSERT_TRUE(frame_with(0x585, 10, &answer));
        TEST_ASSERT_EQUAL(row[i].status == BRACE_OK, answer.data[0] != BRACE_ANSWER_REFUSED);
        if (row[i].status != BRACE_OK) {
            brace_can_refusal_t refusal;
            brace_can_unpack_refusal(answer.data, &refusal);
            TEST_ASSERT_EQUAL(row[i].status, refusal.status);
        }
        TEST_ASSERT_EQUAL_UINT32(before + (row[i].status == BRACE_REFUSED_UNKNOWN), counters().frames_unknown);
        ticks(10);
        while (brace_fake_frame_take(&fake, &answer)) { /* an answer's other parts */
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_heartbeat_each_second_reports_mode_faults_and_dictionary);
    RUN_TEST(test_a_newcomer_knows_the_faults_within_a_second);
    RUN_TEST(test_a_fault_is_reported_at_once_and_so_is_its_end);
    RUN_TEST(test_a_node_without_a_number_listens_and_is_silent);
    RUN_TEST(test_the_bit_rate_is_the_parameters);
    RUN_TEST(test_a_board_without_can_or_whose_can_does_not_start_works);
    RUN_TEST(test_a_set_up_that_failed_is_a_fault_and_is_tried_again);
    RUN_TEST(test_only_requests_to_this_node_are_let_in);
    RUN_TEST(test_requests_that_found_no_room_are_counted_and_reported);
    RUN_TEST(test_a_full_mailbox_delays_a_frame_and_does_not_lose_it);
    RUN_TEST(test_bus_off_is_a_fault_recovery_is_tried_and_K_stays_valid);
    RUN_TEST(test_a_port_that_is_closed_has_no_owner);
    RUN_TEST(test_frames_for_nobody_are_counted_and_a_flood_is_borne);
    RUN_TEST(test_only_a_request_that_does_not_exist_is_unknown);
    return UNITY_END();
}
