/* The board's CAN controller as the application minds it: set-up with and without CAN FD, health, and the way back. */
#include "wire/can/bus.h"

#include <string.h>

#include "unity.h"

enum { TICK_US = 1000 };

static can_bus_t bus;
static brace_hal_t hal;
static brace_can_setup_t last_setup;
static int32_t setup_status, classic_status, health_status, send_status;
static uint32_t setups, recoveries, looks;
static brace_can_health_t health;
static brace_app_counters_t counted;

static int32_t port_setup(void *context, const brace_can_setup_t *setup)
{
    (void)context;
    setups++;
    last_setup = *setup;
    return setup->fd_bit_rate != 0u ? setup_status : classic_status;
}

static int32_t port_health(void *context, brace_can_health_t *reported)
{
    (void)context;
    looks++;
    if (health_status != BRACE_HAL_OK) {
        memset(reported, 0xff, sizeof *reported);
        return health_status;
    }
    *reported = health;
    return BRACE_HAL_OK;
}

static int32_t port_send(void *context, const brace_can_frame_t *frame)
{
    (void)context;
    (void)frame;
    return send_status;
}

static int32_t port_receive(void *context, brace_can_frame_t *frame)
{
    (void)context;
    frame->id = 0x123;
    return 1;
}

static int32_t port_recover(void *context)
{
    (void)context;
    recoveries++;
    return BRACE_HAL_OK;
}

static void start(uint32_t fd_bit_rate, uint32_t node_id)
{
    const brace_controller_t controller = {.node_id = node_id, .can_bit_rate = 500000, .can_fd_bit_rate = fd_bit_rate};
    can_bus_start(&bus, &hal, &controller);
}

void setUp(void)
{
    hal = (brace_hal_t){.can_setup = port_setup,
                        .can_send = port_send,
                        .can_receive = port_receive,
                        .can_health = port_health,
                        .can_recover = port_recover};
    setup_status = classic_status = health_status = send_status = BRACE_HAL_OK;
    health = (brace_can_health_t){.bus_off = false};
    setups = recoveries = looks = 0;
    memset(&counted, 0, sizeof counted);
    start(0, 5);
}

void tearDown(void) {}

static void watch(uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        can_bus_watch(&bus, &hal, TICK_US);
    }
}

static bool sends(void)
{
    const wire_tick_t tick = {.hal = &hal, .counters = &counted};
    const brace_can_frame_t frame = {.id = 1};
    return can_bus_send(&bus, &tick, &frame);
}

static void test_it_is_set_up_for_requests_to_this_node(void)
{
    TEST_ASSERT_TRUE(bus.is_fitted && bus.is_there);
    TEST_ASSERT_FALSE(bus.is_off);
    TEST_ASSERT_EQUAL(1, setups);
    TEST_ASSERT_EQUAL(500000, last_setup.bit_rate);
    TEST_ASSERT_EQUAL(0, last_setup.fd_bit_rate);
    TEST_ASSERT_EQUAL_HEX32(0x605, last_setup.filter_id);
    TEST_ASSERT_EQUAL_HEX32(0x7ff, last_setup.filter_mask);
    TEST_ASSERT_FALSE(last_setup.listen_only);
    start(0, 0);
    TEST_ASSERT_TRUE(last_setup.listen_only); /* without a number nothing is sent */
}

static void test_without_a_part_of_the_door_there_is_no_bus(void)
{
    const brace_hal_t whole = hal;
    for (int part = 0; part < 5; part++) {
        hal = whole;
        switch (part) {
        case 0: hal.can_setup = NULL; break;
        case 1: hal.can_send = NULL; break;
        case 2: hal.can_receive = NULL; break;
        case 3: hal.can_health = NULL; break;
        default: hal.can_recover = NULL; break;
        }
        brace_can_frame_t frame;
        start(0, 5);
        TEST_ASSERT_FALSE(bus.is_fitted || bus.is_there);
        watch(5000);
        TEST_ASSERT_FALSE(can_bus_receive(&bus, &hal, &frame));
        TEST_ASSERT_EQUAL(1, setups);
    }
}

static void test_classic_frames_rather_than_silence(void)
{
    start(2000000, 5);
    TEST_ASSERT_EQUAL(2000000, bus.setup.fd_bit_rate);
    TEST_ASSERT_EQUAL(2, setups);
    setup_status = BRACE_HAL_E_UNSUPPORTED;
    start(2000000, 5);
    TEST_ASSERT_TRUE(bus.is_fitted && bus.is_there);
    TEST_ASSERT_EQUAL(0, bus.setup.fd_bit_rate);
    TEST_ASSERT_EQUAL(500000, last_setup.bit_rate);
    TEST_ASSERT_EQUAL_HEX32(0x605, last_setup.filter_id);
}

/* A controller that is not ready yet is asked again every 2 s, for all that was wanted. */
static void test_a_set_up_that_failed_is_tried_again(void)
{
    setup_status = classic_status = BRACE_HAL_E_DEVICE;
    start(2000000, 5);
    TEST_ASSERT_TRUE(bus.is_fitted);
    TEST_ASSERT_FALSE(bus.is_there);
    TEST_ASSERT_EQUAL(2000000, bus.setup.fd_bit_rate);
    const uint32_t before = setups;
    watch(1999);
    TEST_ASSERT_EQUAL(before, setups);
    watch(1);
    TEST_ASSERT_EQUAL(before + 2u, setups);
    watch(1999);
    TEST_ASSERT_EQUAL(before + 2u, setups);
    setup_status = BRACE_HAL_OK;
    watch(1);
    TEST_ASSERT_TRUE(bus.is_there);
    TEST_ASSERT_EQUAL(2000000, bus.setup.fd_bit_rate);
    watch(5000);
    TEST_ASSERT_EQUAL(before + 3u, setups);
}

/* Two seconds lie between two tries, to the microsecond. */
static void test_a_set_up_is_not_tried_a_microsecond_early(void)
{
    setup_status = classic_status = BRACE_HAL_E_DEVICE;
    start(0, 5);
    const uint32_t before = setups;
    for (uint32_t i = 0; i < 3u; i++) {
        can_bus_watch(&bus, &hal, 1999999);
        TEST_ASSERT_EQUAL(before + i, setups);
        can_bus_watch(&bus, &hal, 1);
        TEST_ASSERT_EQUAL(before + 1u + i, setups);
    }
}

static void test_a_board_without_can_is_asked_once(void)
{
    classic_status = BRACE_HAL_E_UNSUPPORTED;
    start(0, 5);
    TEST_ASSERT_FALSE(bus.is_fitted || bus.is_there);
    watch(10000);
    TEST_ASSERT_EQUAL(2, setups);
}

/* Health is asked for every 10 ms. An answer that fails says nothing. */
static void test_health_is_reported_every_ten_milliseconds(void)
{
    health.bus_off = true;
    health.frames_lost = 7;
    watch(9);
    TEST_ASSERT_FALSE(bus.is_off);
    watch(1);
    TEST_ASSERT_TRUE(bus.is_off);
    TEST_ASSERT_EQUAL(7, bus.frames_lost);
    health.bus_off = false;
    health.frames_lost = 9;
    health_status = BRACE_HAL_E_DEVICE;
    watch(20);
    TEST_ASSERT_TRUE(bus.is_off);
    TEST_ASSERT_EQUAL(7, bus.frames_lost);
    health_status = BRACE_HAL_AGAIN;
    watch(20);
    TEST_ASSERT_TRUE(bus.is_off);
    TEST_ASSERT_EQUAL(7, bus.frames_lost);
    health_status = BRACE_HAL_OK;
    watch(10);
    TEST_ASSERT_FALSE(bus.is_off);
    TEST_ASSERT_EQUAL(9, bus.frames_lost);
}

/* With a tick that three times over is a microsecond short of 10 ms, each look takes four. */
static void test_health_is_not_asked_for_a_microsecond_early(void)
{
    for (uint32_t i = 1; i <= 40u; i++) {
        can_bus_watch(&bus, &hal, 3333);
        TEST_ASSERT_EQUAL(i / 4u, looks);
    }
}

/* The first look after its time comes, then after twice as long each time, at most 2 s. */
static void recovers_after(const uint32_t *wait_ms, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t before = recoveries;
        watch(wait_ms[i] - 1u);
        TEST_ASSERT_EQUAL(before, recoveries);
        watch(1);
        TEST_ASSERT_EQUAL(before + 1u, recoveries);
    }
}

static void test_the_way_back_is_tried_ever_more_rarely(void)
{
    static const uint32_t wait_ms[] = {125, 250, 500, 1000, 2000, 2000};
    health.bus_off = true;
    watch(9);
    recovers_after(wait_ms, 6);
    /* back on the bus, but what it sends still fails: it waits as long the next time */
    health.bus_off = false;
    health.tx_errors = 8;
    watch(20);
    health.bus_off = true;
    watch(9 - bus.health_us / TICK_US);
    const uint32_t long_ms = 2000;
    recovers_after(&long_ms, 1);
    /* A controller that comes back has error counters of 0 (ISO 11898-1), whether or not it can send. */
    health.bus_off = false;
    health.tx_errors = 0;
    watch(500);
    TEST_ASSERT_FALSE(bus.is_off);
    health.bus_off = true;
    watch(9 - bus.health_us / TICK_US);
    recovers_after(&long_ms, 1);
    /* once it has been there for 2 s, the first wait counts again */
    health.bus_off = false;
    watch(2010);
    TEST_ASSERT_FALSE(bus.is_off);
    health.bus_off = true;
    watch(9 - bus.health_us / TICK_US);
    recovers_after(wait_ms, 2);
}

/* Ticks that do not divide a wait: the first one at its end or after it. */
static void test_the_way_back_does_not_wait_for_an_even_tick(void)
{
    health.bus_off = true;
    watch(9);
    for (uint32_t wait_us = 125000; wait_us <= 1000000u; wait_us *= 2u) {
        const uint32_t before = recoveries;
        uint32_t us = 0;
        while (recoveries == before && us < 2u * wait_us) {
            can_bus_watch(&bus, &hal, 700);
            us += 700u;
        }
        TEST_ASSERT_TRUE(us >= wait_us && us <= wait_us + 1400u); /* it has to see first that it is off */
    }
}

static void test_what_is_not_taken_is_tried_again_and_what_is_refused_is_counted(void)
{
    TEST_ASSERT_TRUE(sends());
    send_status = BRACE_HAL_AGAIN;
    TEST_ASSERT_FALSE(sends());
    TEST_ASSERT_EQUAL(0, counted.frames_refused);
    send_status = BRACE_HAL_E_DEVICE;
    TEST_ASSERT_FALSE(sends());
    TEST_ASSERT_EQUAL(1, counted.frames_refused);
    TEST_ASSERT_FALSE(bus.is_off);
    send_status = BRACE_HAL_E_BUS_OFF;
    TEST_ASSERT_FALSE(sends());
    TEST_ASSERT_EQUAL(2, counted.frames_refused);
    TEST_ASSERT_TRUE(bus.is_off);
    send_status = BRACE_HAL_E_DEVICE; /* it stays off until its health says otherwise */
    TEST_ASSERT_FALSE(sends());
    TEST_ASSERT_TRUE(bus.is_off);
}

static int32_t nothing_came(void *context, brace_can_frame_t *frame)
{
    (void)context;
    (void)frame;
    return BRACE_HAL_OK;
}

static int32_t reading_fails(void *context, brace_can_frame_t *frame)
{
    (void)context;
    (void)frame;
    return BRACE_HAL_E_DEVICE;
}

static void test_a_frame_has_come_or_none(void)
{
    brace_can_frame_t frame = {.id = 0};
    TEST_ASSERT_TRUE(can_bus_receive(&bus, &hal, &frame));
    TEST_ASSERT_EQUAL_HEX32(0x123, frame.id);
    hal.can_receive = nothing_came;
    TEST_ASSERT_FALSE(can_bus_receive(&bus, &hal, &frame));
    hal.can_receive = reading_fails;
    TEST_ASSERT_FALSE(can_bus_receive(&bus, &hal, &frame));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_it_is_set_up_for_requests_to_this_node);
    RUN_TEST(test_without_a_part_of_the_door_there_is_no_bus);
    RUN_TEST(test_classic_frames_rather_than_silence);
    RUN_TEST(test_a_set_up_that_failed_is_tried_again);
    RUN_TEST(test_a_set_up_is_not_tried_a_microsecond_early);
    RUN_TEST(test_a_board_without_can_is_asked_once);
    RUN_TEST(test_health_is_reported_every_ten_milliseconds);
    RUN_TEST(test_health_is_not_asked_for_a_microsecond_early);
    RUN_TEST(test_the_way_back_is_tried_ever_more_rarely);
    RUN_TEST(test_the_way_back_does_not_wait_for_an_even_tick);
    RUN_TEST(test_what_is_not_taken_is_tried_again_and_what_is_refused_is_counted);
    RUN_TEST(test_a_frame_has_come_or_none);
    return UNITY_END();
}
