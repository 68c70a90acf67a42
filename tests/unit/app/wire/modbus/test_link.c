/* Bytes of a Modbus port: what comes is gathered, what is broken is forgotten, and a peer that does not read for a
 * second loses its answer, however slowly others read. */
#include "wire/modbus/link.h"

#include <string.h>

#include "unity.h"

static modbus_link_t link;
static modbus_server_t server;
static brace_app_counters_t counters;
static uint8_t sent[32];
static uint32_t sent_count, takes, brings;

static int32_t port_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room)
{
    (void)context;
    (void)port;
    const uint32_t count = brings < room ? brings : room;
    memset(bytes, 0x5a, count);
    return (int32_t)count;
}

static int32_t port_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    (void)port;
    const uint32_t taken = takes < count ? takes : count;
    memcpy(sent + sent_count, bytes, taken);
    sent_count += taken;
    return (int32_t)taken;
}

static const brace_hal_t hal = {.serial_read = port_read, .serial_write = port_write};
static wire_tick_t tick = {.hal = &hal, .counters = &counters};

void setUp(void)
{
    memset(&link, 0, sizeof link);
    memset(&server, 0, sizeof server);
    memset(&counters, 0, sizeof counters);
    sent_count = takes = brings = 0;
    tick.now_us = 0xfff00000u; /* the clock wraps round soon */
}

void tearDown(void) {}

static void answer_of(uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        link.bytes[i] = (uint8_t)(i + 1u);
    }
    modbus_link_answer(&link, &tick, count);
    TEST_ASSERT_TRUE(link.is_sending);
}

static void test_what_comes_is_gathered(void)
{
    brings = 3;
    TEST_ASSERT_EQUAL_UINT32(3, modbus_link_receive(&link, &tick, BRACE_SERIAL_MODBUS, 20));
    TEST_ASSERT_EQUAL_UINT32(tick.now_us, link.active_us);
    const uint32_t before_us = tick.now_us;
    tick.now_us += 5000u;
    TEST_ASSERT_EQUAL_UINT32(2, modbus_link_receive(&link, &tick, BRACE_SERIAL_MODBUS, 2)); /* the buffer is full */
    TEST_ASSERT_EQUAL(5, link.count);
    TEST_ASSERT_EQUAL_UINT32(before_us + 5000u, link.active_us);
    brings = 0;
    tick.now_us += 5000u;
    TEST_ASSERT_EQUAL_UINT32(0, modbus_link_receive(&link, &tick, BRACE_SERIAL_MODBUS, 2));
    TEST_ASSERT_EQUAL_UINT32(before_us + 5000u, link.active_us);
    modbus_link_break(&link, &server, &tick);
    TEST_ASSERT_EQUAL(0, link.count);
    TEST_ASSERT_EQUAL(1, server.broken);
    TEST_ASSERT_EQUAL_UINT32(1, counters.modbus_broken);
}

static void test_a_slow_reader_gets_all_of_its_answer(void)
{
    tick.now_us -= 3000000u; /* long after its request */
    link.active_us = tick.now_us - 2000000u;
    answer_of(10);
    takes = 1;
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_TRUE(link.is_sending);
        tick.now_us += 999000u;
        modbus_link_send(&link, &tick, BRACE_SERIAL_MODBUS);
    }
    TEST_ASSERT_FALSE(link.is_sending);
    TEST_ASSERT_EQUAL_UINT32(10, sent_count);
    for (uint32_t i = 0; i < 10u; i++) {
        TEST_ASSERT_EQUAL_HEX8(i + 1u, sent[i]);
    }
    TEST_ASSERT_EQUAL(0, link.count);
}

static void gives_up_after_a_second(void)
{
    tick.now_us += 1000000u;
    modbus_link_send(&link, &tick, BRACE_SERIAL_MODBUS);
    TEST_ASSERT_TRUE(link.is_sending);
    tick.now_us += 1u;
    modbus_link_send(&link, &tick, BRACE_SERIAL_MODBUS);
    TEST_ASSERT_FALSE(link.is_sending);
}

static void test_a_peer_that_does_not_read_loses_its_answer(void)
{
    answer_of(10);
    takes = 4;
    modbus_link_send(&link, &tick, BRACE_SERIAL_MODBUS);
    takes = 0;
    gives_up_after_a_second();
    TEST_ASSERT_EQUAL(0, link.count);
    TEST_ASSERT_EQUAL_UINT32(4, sent_count);
}

/* An answer begins with its first byte, whatever was sent of another. */
static void test_an_answer_is_sent_from_its_beginning(void)
{
    link.sent = 4;
    answer_of(10);
    takes = 10;
    modbus_link_send(&link, &tick, BRACE_SERIAL_MODBUS);
    TEST_ASSERT_EQUAL_UINT32(10, sent_count);
}

/* The second counts from the answer, however long the request has waited for it. */
static void test_the_second_begins_with_the_answer(void)
{
    link.active_us = tick.now_us;
    tick.now_us += 600000u;
    answer_of(10);
    gives_up_after_a_second();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_comes_is_gathered);
    RUN_TEST(test_a_slow_reader_gets_all_of_its_answer);
    RUN_TEST(test_a_peer_that_does_not_read_loses_its_answer);
    RUN_TEST(test_an_answer_is_sent_from_its_beginning);
    RUN_TEST(test_the_second_begins_with_the_answer);
    return UNITY_END();
}
