/* A key typed at the console of a guarded board: kept when it was typed twice alike, and never else. */
#include <string.h>

#include "brace_hal_fake.h"
#include "key_entry.h"
#include "unity.h"

#define KEY "000102030405060708090a0b0c0d0e0f"
#define OTHER "000102030405060708090a0b0c0d0e0e"

static brace_fake_t fake;
static text_t text;
static key_entry_t entry;
static char said[512];

void setUp(void)
{
    brace_fake_start(&fake);
    brace_fake_guarded(&fake, NULL);
    text = (text_t){.hal = &fake.hal};
    entry = (key_entry_t){0};
}

void tearDown(void) {}

static void type(const char *characters)
{
    for (; *characters != '\0'; characters++) {
        TEST_ASSERT_TRUE(entry.is_open);
        key_entry_take(&entry, &text, (uint8_t)*characters);
    }
}

static void assert_said(const char *words)
{
    const uint32_t count =
        brace_fake_bytes_take(&fake, BRACE_SERIAL_CONSOLE, (uint8_t *)said, (uint32_t)sizeof said - 1u);
    said[count] = '\0';
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, words), said);
}

static void assert_forgotten(void)
{
    static const key_entry_t nothing;
    TEST_ASSERT_FALSE(entry.is_open);
    TEST_ASSERT_EQUAL_MEMORY(nothing.key, entry.key, sizeof entry.key);
    TEST_ASSERT_EQUAL(0, entry.digits);
}

static void test_a_key_typed_twice_is_kept(void)
{
    key_entry_begin(&entry, &text);
    assert_said("twice");
    type(KEY "\r\n");
    TEST_ASSERT_FALSE(fake.has_key);
    type("00 01 02 03 04 05 06 07 08 09 0A 0B 0C 0D 0E 0F");
    assert_said("kept. The board is guarded");
    TEST_ASSERT_TRUE(fake.has_key);
    for (uint8_t i = 0; i < BRACE_HAL_KEY_BYTES; i++) {
        TEST_ASSERT_EQUAL_HEX8(i, fake.key[i]);
    }
    assert_forgotten();
}

static void test_two_that_differ_are_not_kept(void)
{
    key_entry_begin(&entry, &text);
    type(KEY OTHER);
    assert_said("differ");
    TEST_ASSERT_FALSE(fake.has_key);
    assert_forgotten();
}

static void test_a_slip_ends_the_entry(void)
{
    static const char slips[] = {'g', 'G', '/', ':', '@', '`', 'x', '\x1b', '\x7f', '\0'};
    for (uint32_t i = 0; i < sizeof slips; i++) {
        key_entry_begin(&entry, &text);
        type("0102");
        key_entry_take(&entry, &text, (uint8_t)slips[i]);
        assert_said("no hexadecimal digit");
        assert_forgotten();
    }
    key_entry_begin(&entry, &text);
    type(KEY KEY);
    TEST_ASSERT_EQUAL_HEX8(1, fake.key[1]); /* what was typed before the slip does not count */
}

static void test_a_board_with_a_key_keeps_it(void)
{
    static const uint8_t key[BRACE_HAL_KEY_BYTES] = {9};
    brace_fake_guarded(&fake, key);
    key_entry_begin(&entry, &text);
    assert_said("has one");
    assert_forgotten();
    TEST_ASSERT_EQUAL_HEX8(9, fake.key[0]);
}

static void test_a_board_that_keeps_none_says_so(void)
{
    fake.hal.key_read = NULL;
    key_entry_begin(&entry, &text);
    assert_said("a bench");
    assert_forgotten();
}

static int32_t no_answer(void *context, uint8_t key[BRACE_HAL_KEY_BYTES])
{
    (void)context;
    (void)key;
    return BRACE_HAL_E_DEVICE;
}

static void test_memory_that_does_not_answer_is_told(void)
{
    fake.hal.key_read = no_answer;
    key_entry_begin(&entry, &text);
    assert_said("does not answer");
    assert_forgotten();
}

static int32_t refuse(void *context, const uint8_t key[BRACE_HAL_KEY_BYTES])
{
    (void)context;
    (void)key;
    return BRACE_HAL_E_DEVICE;
}

static void test_memory_that_refuses_is_told(void)
{
    fake.hal.key_write = refuse;
    key_entry_begin(&entry, &text);
    type(KEY KEY);
    assert_said("did not take it");
    assert_forgotten();
}

static void test_the_key_is_not_shown(void)
{
    key_entry_begin(&entry, &text);
    type(KEY KEY);
    assert_said("kept");
    TEST_ASSERT_NULL(strstr(said, "0e0f"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_key_typed_twice_is_kept);
    RUN_TEST(test_two_that_differ_are_not_kept);
    RUN_TEST(test_a_slip_ends_the_entry);
    RUN_TEST(test_a_board_with_a_key_keeps_it);
    RUN_TEST(test_a_board_that_keeps_none_says_so);
    RUN_TEST(test_memory_that_does_not_answer_is_told);
    RUN_TEST(test_memory_that_refuses_is_told);
    RUN_TEST(test_the_key_is_not_shown);
    return UNITY_END();
}
