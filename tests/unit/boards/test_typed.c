/* What is typed becomes lines; what the console itself has said becomes silence. */
#include <string.h>

#include "typed.h"
#include "unity.h"

static typed_t typed;
static uint32_t now_us;

void setUp(void)
{
    typed = (typed_t){0};
    now_us = UINT32_MAX - 1000000u; /* the clock wraps while it is deaf */
}

void tearDown(void) {}

/* Takes bytes; the last event that is one. */
static typed_event_t take(const char *bytes)
{
    typed_event_t last = TYPED_NOTHING;
    for (; *bytes != '\0'; bytes++) {
        const typed_event_t event = typed_take(&typed, (uint8_t)*bytes, now_us);
        last = event != TYPED_NOTHING ? event : last;
    }
    return last;
}

static void test_lines_end_with_either_byte_or_both(void)
{
    static const char *const ends[] = {"\r", "\n", "\r\n", "\n\r", "\r\n\r\n"};
    for (uint32_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        TEST_ASSERT_EQUAL(TYPED_NOTHING, take(" a word \t"));
        TEST_ASSERT_EQUAL(TYPED_LINE, typed_take(&typed, (uint8_t)ends[i][0], now_us));
        TEST_ASSERT_EQUAL_STRING("a word", typed.line);
        TEST_ASSERT_TRUE(typed_is(&typed, "a word"));
        TEST_ASSERT_FALSE(typed_is(&typed, "a wor"));
        TEST_ASSERT_FALSE(typed_is(&typed, "a words"));
        TEST_ASSERT_EQUAL(TYPED_NOTHING, take(ends[i] + 1));
    }
}

static void test_what_is_empty_is_no_line(void)
{
    static const char *const lines[] = {"\r", "   \r", "\t\n", "a\b\r", "^M\n", "^M\r\n"};
    for (uint32_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(TYPED_NOTHING, take(lines[i]), lines[i]);
    }
    TEST_ASSERT_EQUAL(TYPED_LINE, take("^C\r"));
}

/* Such a line is reported, but holds nothing that could be a word. */
static void test_what_no_key_types_is_no_word(void)
{
    static const char *const lines[] = {"rest\x01"
                                        "art\r",
                                        "\x1b[A\r", "restart\x80\r",
                                        "\xff"
                                        "restart\r"};
    for (uint32_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(TYPED_LINE, take(lines[i]), lines[i]);
        TEST_ASSERT_EQUAL_STRING("", typed.line);
    }
    TEST_ASSERT_EQUAL(TYPED_LINE, take("restart\r"));
    TEST_ASSERT_EQUAL_STRING("restart", typed.line);
}

static void test_a_line_may_be_as_long_as_it_says_and_no_longer(void)
{
    for (uint32_t i = 0; i < (uint32_t)TYPED_MOST; i++) {
        (void)typed_take(&typed, (uint8_t)'x', now_us);
    }
    TEST_ASSERT_EQUAL(TYPED_LINE, take("\r"));
    TEST_ASSERT_EQUAL(TYPED_MOST, strlen(typed.line));
    for (uint32_t i = 0; i <= (uint32_t)TYPED_MOST; i++) {
        (void)typed_take(&typed, (uint8_t)'x', now_us);
    }
    TEST_ASSERT_EQUAL(TYPED_LINE, take("\r"));
    TEST_ASSERT_EQUAL_STRING("", typed.line);
}

static void test_its_own_prefix_makes_it_deaf_until_it_has_been_quiet(void)
{
    static const char *const own[] = {"#", " # ", "\xff# k", "^M\n#", "x\b# "};
    for (uint32_t i = 0; i < sizeof own / sizeof own[0]; i++) {
        setUp();
        TEST_ASSERT_EQUAL_MESSAGE(TYPED_ECHO, take(own[i]), own[i]);
        for (uint32_t part = 0; part < 10u; part++) {
            now_us += (uint32_t)TYPED_QUIET_US - 1u;
            /* each byte begins the 2 s anew */
            TEST_ASSERT_EQUAL(TYPED_NOTHING, take(part == 5u ? "# again\r" : "restart\r"));
        }
        now_us += (uint32_t)TYPED_QUIET_US;
        TEST_ASSERT_EQUAL(TYPED_LINE, take("k\r"));
        TEST_ASSERT_EQUAL_STRING("k", typed.line);
    }
    setUp();
    TEST_ASSERT_EQUAL(TYPED_LINE, take("a # within\r")); /* not at the beginning */
}

static void test_what_was_typed_is_forgotten(void)
{
    (void)take("0123456789abcdef\r");
    typed_forget(&typed);
    TEST_ASSERT_EACH_EQUAL_HEX8(0, typed.line, sizeof typed.line);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_lines_end_with_either_byte_or_both);
    RUN_TEST(test_what_is_empty_is_no_line);
    RUN_TEST(test_what_no_key_types_is_no_word);
    RUN_TEST(test_a_line_may_be_as_long_as_it_says_and_no_longer);
    RUN_TEST(test_its_own_prefix_makes_it_deaf_until_it_has_been_quiet);
    RUN_TEST(test_what_was_typed_is_forgotten);
    return UNITY_END();
}
