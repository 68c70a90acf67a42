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

static void type(const char *line)
{
    TEST_ASSERT_TRUE(entry.is_open);
    key_entry_take(&entry, &text, line);
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
    TEST_ASSERT_EQUAL(0, entry.lines);
}

static void test_a_key_typed_twice_is_kept(void)
{
    TEST_ASSERT_TRUE(key_entry_is_possible(&text));
    key_entry_begin(&entry, &text);
    assert_said("not shown");
    type(KEY);
    assert_said("once more");
    TEST_ASSERT_FALSE(fake.has_key);
    type("00 01 02 03 04 05 06 07 08 09 0A 0B 0C 0D 0E 0F");
    assert_said("kept, and its memory is locked. The board is guarded");
    TEST_ASSERT_TRUE(fake.has_key);
    for (uint8_t i = 0; i < BRACE_HAL_KEY_BYTES; i++) {
        TEST_ASSERT_EQUAL_HEX8(i, fake.key[i]);
    }
    assert_forgotten();
}

static void test_two_that_differ_are_not_kept(void)
{
    key_entry_begin(&entry, &text);
    type(KEY);
    type(OTHER);
    assert_said("differ");
    TEST_ASSERT_FALSE(fake.has_key);
    assert_forgotten();
}

static void test_a_slip_ends_the_entry(void)
{
    static const char *const slips[] = {"",
                                        KEY "0",
                                        "00010203",
                                        "g00102030405060708090a0b0c0d0e0f",
                                        KEY "g",
                                        "/00102030405060708090a0b0c0d0e0f",
                                        ":00102030405060708090a0b0c0d0e0f",
                                        "@00102030405060708090a0b0c0d0e0f",
                                        "`00102030405060708090a0b0c0d0e0f"};
    for (uint32_t i = 0; i < sizeof slips / sizeof slips[0]; i++) {
        key_entry_begin(&entry, &text);
        type(slips[i]);
        assert_said("not 32 hexadecimal digits");
        assert_forgotten();
        key_entry_begin(&entry, &text);
        type(KEY);
        type(slips[i]);
        assert_said("not 32 hexadecimal digits");
        assert_forgotten();
    }
    TEST_ASSERT_FALSE(fake.has_key);
    key_entry_begin(&entry, &text);
    type(KEY);
    type(KEY);
    TEST_ASSERT_EQUAL_HEX8(1, fake.key[1]); /* what was typed before the slip does not count */
}

static void test_a_board_with_a_key_keeps_it(void)
{
    static const uint8_t key[BRACE_HAL_KEY_BYTES] = {9};
    brace_fake_guarded(&fake, key);
    TEST_ASSERT_FALSE(key_entry_is_possible(&text));
    assert_said("has one");
    TEST_ASSERT_EQUAL_HEX8(9, fake.key[0]);
}

static void test_a_board_that_keeps_none_says_so(void)
{
    fake.hal.key_read = NULL;
    TEST_ASSERT_FALSE(key_entry_is_possible(&text));
    assert_said("a bench");
    TEST_ASSERT_EQUAL_STRING("", key_entry_words(&fake.hal));
}

static int32_t found; /* by key_read, and what key_write answers */

static int32_t find(void *context, uint8_t key[BRACE_HAL_KEY_BYTES])
{
    (void)context;
    (void)key;
    return found;
}

static int32_t answer(void *context, const uint8_t key[BRACE_HAL_KEY_BYTES])
{
    (void)context;
    (void)key;
    return found;
}

static void test_what_the_memory_holds_is_reported(void)
{
    static const struct {
        int32_t found;
        bool takes_key;
        const char *words;
    } all[] = {
        {BRACE_HAL_KEY_NONE, true, "none yet"},
        {BRACE_HAL_KEY_LOCKED, false, "kept, and its memory is locked"},
        {BRACE_HAL_KEY_OPEN, false, "another image can replace it"},
        {BRACE_HAL_E_DAMAGED, true, "holds a piece of one"},
        {BRACE_HAL_E_DEVICE, false, "does not answer"},
    };
    fake.hal.key_read = find;
    for (uint32_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        found = all[i].found;
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(key_entry_words(&fake.hal), all[i].words), all[i].words);
        TEST_ASSERT_EQUAL_MESSAGE(all[i].takes_key, key_entry_is_possible(&text), all[i].words);
    }
}

static void test_memory_that_refuses_is_reported(void)
{
    fake.hal.key_write = answer;
    found = BRACE_HAL_E_DEVICE;
    key_entry_begin(&entry, &text);
    type(KEY);
    type(KEY);
    assert_said("did not take it");
    assert_forgotten();
    found = BRACE_HAL_AGAIN;
    key_entry_begin(&entry, &text);
    type(KEY);
    type(KEY);
    assert_said("kept, but its memory is not locked yet");
    assert_forgotten();
}

static void test_an_echo_ends_the_entry(void)
{
    key_entry_refuse_echo(&entry, &text);
    assert_said("");
    TEST_ASSERT_EQUAL_STRING("", said);
    key_entry_begin(&entry, &text);
    type(KEY);
    key_entry_refuse_echo(&entry, &text);
    assert_said("a key is not taken from it");
    assert_forgotten();
}

static void test_an_entry_that_nobody_goes_on_with_ends(void)
{
    key_entry_begin(&entry, &text);
    fake.now_us += (uint32_t)KEY_ENTRY_PATIENCE_US - 1u;
    type(KEY);
    fake.now_us += (uint32_t)KEY_ENTRY_PATIENCE_US - 1u;
    key_entry_serve(&entry, &text);
    TEST_ASSERT_TRUE(entry.is_open);
    fake.now_us++;
    key_entry_serve(&entry, &text);
    assert_said("nobody typed it");
    assert_forgotten();
}

static void test_the_key_is_not_shown(void)
{
    key_entry_begin(&entry, &text);
    type(KEY);
    type(KEY);
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
    RUN_TEST(test_what_the_memory_holds_is_reported);
    RUN_TEST(test_memory_that_refuses_is_reported);
    RUN_TEST(test_an_echo_ends_the_entry);
    RUN_TEST(test_an_entry_that_nobody_goes_on_with_ends);
    RUN_TEST(test_the_key_is_not_shown);
    return UNITY_END();
}
