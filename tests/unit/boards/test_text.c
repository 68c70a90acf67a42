/* Text on the console: before the first tick it waits for room, afterwards it is kept and nobody waits. */
#include <string.h>

#include "brace_hal_fake.h"
#include "text.h"
#include "unity.h"

static brace_fake_t fake;
static brace_hal_t hal;
static text_t text;
static uint32_t room; /* of the line; UINT32_MAX: it fails */
static uint32_t looks;
static char line[4096];
static uint32_t count;

static int32_t write_some(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t asked)
{
    (void)context;
    TEST_ASSERT_EQUAL(BRACE_SERIAL_CONSOLE, port);
    if (room == UINT32_MAX) {
        return BRACE_HAL_E_DEVICE;
    }
    const uint32_t taken = asked < room ? asked : room;
    memcpy(&line[count], bytes, taken);
    count += taken;
    room -= taken;
    return (int32_t)taken;
}

static uint32_t now_us(void *context)
{
    (void)context;
    looks++;
    return 10u * looks;
}

void setUp(void)
{
    brace_fake_start(&fake);
    hal = fake.hal;
    hal.serial_write = write_some;
    hal.now_us = now_us;
    text = (text_t){.hal = &hal};
    memset(line, 0, sizeof line);
    count = looks = 0u;
    room = sizeof line - 1u;
}

void tearDown(void) {}

static void test_numbers_and_words(void)
{
    text_string(&text, "a ");
    text_unsigned(&text, 0u);
    text_string(&text, " ");
    text_unsigned(&text, UINT32_MAX);
    text_string(&text, " ");
    text_signed(&text, INT32_MIN);
    text_string(&text, " ");
    text_signed(&text, 7);
    text_string(&text, " ");
    text_hex(&text, 0x0123abcdu);
    text_line(&text);
    TEST_ASSERT_EQUAL_STRING("# a 0 4294967295 -2147483648 7 0x0123abcd\r\n", line);
}

/* A line that takes nothing: the text is dropped after 0.1 s, and what follows at once. */
static void test_it_waits_for_a_tenth_of_a_second_before_the_first_tick(void)
{
    room = 3u;
    text_string(&text, "abcdef");
    TEST_ASSERT_TRUE(text.gone);
    TEST_ASSERT_INT_WITHIN(2, 10001, looks);
    looks = 0u;
    room = 100u;
    text_string(&text, "more");
    TEST_ASSERT_LESS_THAN(3u, looks);
    TEST_ASSERT_EQUAL_STRING("# a", line);
    text_again(&text);
    text_string(&text, "ghi");
    TEST_ASSERT_EQUAL_STRING("# a\r\n# ghi", line); /* what was cut ends, and the next line has its prefix */
}

static void test_a_line_that_fails_is_not_waited_for(void)
{
    room = UINT32_MAX;
    text_string(&text, "abc");
    TEST_ASSERT_TRUE(text.gone);
    TEST_ASSERT_LESS_THAN(4u, looks);
}

/* Every call takes one look at the line at most, and none at the clock. */
static void test_kept_text_goes_out_as_the_line_has_room(void)
{
    text_keep(&text);
    TEST_ASSERT_TRUE(text_serve(&text));
    text_string(&text, "abcdef");
    text_line(&text);
    TEST_ASSERT_EQUAL(0u, count);
    room = 5u;
    TEST_ASSERT_FALSE(text_serve(&text));
    TEST_ASSERT_FALSE(text_serve(&text)); /* no room */
    TEST_ASSERT_EQUAL_STRING("# abc", line);
    room = 100u;
    TEST_ASSERT_TRUE(text_serve(&text));
    TEST_ASSERT_EQUAL_STRING("# abcdef\r\n", line);
    text_string(&text, "ghi");
    TEST_ASSERT_TRUE(text_serve(&text));
    TEST_ASSERT_EQUAL_STRING("# abcdef\r\n# ghi", line);
    TEST_ASSERT_EQUAL(0u, looks);
}

/* A piece that finds no room is dropped whole, and so is what follows. */
static void test_more_than_is_kept_is_dropped(void)
{
    text_keep(&text);
    static char piece[1024];
    memset(piece, 'x', sizeof piece - 1u);
    text_string(&text, piece); /* and two characters of the prefix */
    text_string(&text, piece);
    TEST_ASSERT_FALSE(text.gone);
    text_string(&text, "y");
    TEST_ASSERT_TRUE(text.gone);
    text_string(&text, "");
    TEST_ASSERT_TRUE(text_serve(&text));
    TEST_ASSERT_EQUAL((uint32_t)TEXT_BYTES, count);
    text_string(&text, "z");
    TEST_ASSERT_TRUE(text_serve(&text));
    TEST_ASSERT_NULL(strpbrk(line, "yz"));
}

static void test_kept_text_that_the_line_refuses_is_dropped(void)
{
    text_keep(&text);
    text_string(&text, "abc");
    room = UINT32_MAX;
    TEST_ASSERT_TRUE(text_serve(&text));
    room = 100u;
    TEST_ASSERT_TRUE(text_serve(&text));
    TEST_ASSERT_EQUAL(0u, count);
}

static void test_what_stops_the_ticks_sends_the_rest_and_waits(void)
{
    text_keep(&text);
    text_string(&text, "abcdef");
    room = 2u;
    TEST_ASSERT_FALSE(text_serve(&text));
    room = 100u;
    text_wait(&text);
    text_string(&text, "ghi");
    TEST_ASSERT_EQUAL_STRING("# abcdefghi", line);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_numbers_and_words);
    RUN_TEST(test_it_waits_for_a_tenth_of_a_second_before_the_first_tick);
    RUN_TEST(test_a_line_that_fails_is_not_waited_for);
    RUN_TEST(test_kept_text_goes_out_as_the_line_has_room);
    RUN_TEST(test_more_than_is_kept_is_dropped);
    RUN_TEST(test_kept_text_that_the_line_refuses_is_dropped);
    RUN_TEST(test_what_stops_the_ticks_sends_the_rest_and_waits);
    return UNITY_END();
}
