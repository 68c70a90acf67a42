#include <string.h>

#include "brace/drift.h"
#include "brace/journal.h"
#include "unity.h"

enum { SLOT_BYTES = 8192, IDENTITY = 0x1234 };

/* A memory that a unit is written into once; and the ways in which it may not do what it is asked. */
static struct {
    uint8_t bytes[2][SLOT_BYTES];
    bool read_refused, write_refused, write_lost;
    uint32_t calls, misuse, writes_until_refused, reads_until_refused;
} memory;

static brace_hal_t hal;
static brace_journal_t journal;
static brace_drift_t state;

static int32_t memory_read(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count)
{
    (void)context;
    memory.calls++;
    if (memory.read_refused || (memory.reads_until_refused != 0u && --memory.reads_until_refused == 0u)) {
        return BRACE_HAL_E_DEVICE;
    }
    memcpy(bytes, memory.bytes[slot] + offset, count);
    return BRACE_HAL_OK;
}

static int32_t memory_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    memory.calls++;
    TEST_ASSERT_GREATER_OR_EQUAL(BRACE_JOURNAL_AT, offset); /* the store's part is never touched */
    TEST_ASSERT_LESS_OR_EQUAL(SLOT_BYTES, offset + count);
    if (memory.write_refused || (memory.writes_until_refused != 0u && --memory.writes_until_refused == 0u)) {
        return BRACE_HAL_E_DEVICE;
    }
    for (uint32_t i = 0; i < count && !memory.write_lost; i++) {
        memory.misuse += bytes[i] != 0u && memory.bytes[slot][offset + i] != 0xffu;
        memory.bytes[slot][offset + i] &= bytes[i];
    }
    return BRACE_HAL_OK;
}

void setUp(void)
{
    memset(&memory, 0, sizeof memory);
    memset(memory.bytes, 0xff, sizeof memory.bytes);
    hal = (brace_hal_t){
        .nvm_shape = {.slot_bytes = SLOT_BYTES, .write_bytes = 8}, .nvm_read = memory_read, .nvm_write = memory_write};
    brace_journal_open_erased(&journal, &hal, 0, IDENTITY);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL(0, memory.misuse);
}

static void fill(brace_drift_t *drift, uint8_t with)
{
    memset(drift, with, sizeof *drift);
}

static brace_journal_state_t keep(uint8_t with)
{
    fill(&state, with);
    const brace_journal_state_t rests = brace_journal_step(&journal); /* nothing is being written */
    TEST_ASSERT_NOT_EQUAL(BRACE_JOURNAL_BUSY, rests);
    TEST_ASSERT_TRUE(brace_journal_begin(&journal, &state));
    TEST_ASSERT_FALSE(brace_journal_begin(&journal, &state)); /* one at a time */
    brace_journal_state_t now = BRACE_JOURNAL_BUSY;
    for (int i = 0; i < BRACE_JOURNAL_PIECES + 1 && now == BRACE_JOURNAL_BUSY; i++) {
        memory.calls = 0;
        now = brace_journal_step(&journal);
        TEST_ASSERT_LESS_OR_EQUAL(2, memory.calls);
    }
    TEST_ASSERT_NOT_EQUAL(BRACE_JOURNAL_BUSY, now);
    return now;
}

/* A start. returns what the newest record was filled with; -1: none */
static int restart(uint32_t slot, uint32_t identity)
{
    fill(&state, 0);
    brace_journal_open(&journal, &hal, slot, identity);
    for (int i = 0; i < BRACE_JOURNAL_SCANS && brace_journal_scan(&journal, &state); i++) {
    }
    TEST_ASSERT_FALSE(brace_journal_scan(&journal, &state));
    brace_drift_t same;
    fill(&same, *(const uint8_t *)&state);
    TEST_ASSERT_EQUAL_MEMORY(&same, &state, sizeof same); /* whole */
    return journal.found ? *(const uint8_t *)&state : -1;
}

static void test_the_newest_record_is_found_again(void)
{
    TEST_ASSERT_EQUAL(-1, restart(0, IDENTITY));
    for (uint8_t i = 1; i <= 5; i++) {
        TEST_ASSERT_EQUAL(BRACE_JOURNAL_READY, keep(i));
        if (i % 2 == 0) {
            TEST_ASSERT_EQUAL(i, restart(0, IDENTITY));
        }
    }
    TEST_ASSERT_EQUAL(5, restart(0, IDENTITY));
    TEST_ASSERT_EQUAL(-1, restart(1, IDENTITY));
    TEST_ASSERT_EQUAL(-1, restart(0, IDENTITY + 1));
    for (uint32_t none = BRACE_NVM_SLOT_COUNT; none < 5u; none++) {
        TEST_ASSERT_EQUAL(-1, restart(none, IDENTITY));
        TEST_ASSERT_EQUAL_UINT32(0, brace_journal_room(&journal));
    }
    TEST_ASSERT_FALSE(brace_journal_begin(&journal, &state));
}

/* A controller with newer firmware reads what an older one has written. So a record begins with the same bytes for
 * ever: its name, the size of the state, the format, whose records they are. */
static void test_a_record_says_what_it_is(void)
{
    static const uint8_t header[] = {'D', 'R', 'F', 'T', 344 % 256, 344 / 256, 1, 0, 0x34, 0x12, 0, 0};
    TEST_ASSERT_EQUAL(BRACE_JOURNAL_READY, keep(7));
    TEST_ASSERT_EQUAL_MEMORY(header, memory.bytes[0] + BRACE_JOURNAL_AT, sizeof header);
    TEST_ASSERT_EQUAL_HEX8(7, memory.bytes[0][BRACE_JOURNAL_AT + sizeof header]);
}

static void test_it_fills_up_and_says_how_far(void)
{
    uint32_t room = brace_journal_room(&journal);
    TEST_ASSERT_EQUAL((SLOT_BYTES - BRACE_JOURNAL_AT) / BRACE_JOURNAL_RECORD_BYTES, room);
    for (uint8_t i = 1; room > 0; i++, room--) {
        TEST_ASSERT_EQUAL(room, brace_journal_room(&journal));
        TEST_ASSERT_EQUAL(BRACE_JOURNAL_READY, keep(i));
    }
    TEST_ASSERT_FALSE(brace_journal_begin(&journal, &state));
    TEST_ASSERT_EQUAL((SLOT_BYTES - BRACE_JOURNAL_AT) / BRACE_JOURNAL_RECORD_BYTES, restart(0, IDENTITY));
    TEST_ASSERT_EQUAL(0, brace_journal_room(&journal));
    hal.nvm_shape.slot_bytes = BRACE_JOURNAL_AT; /* the least that a slot may have */
    TEST_ASSERT_EQUAL(-1, restart(0, IDENTITY));
    TEST_ASSERT_FALSE(brace_journal_begin(&journal, &state));
}

static void test_a_record_with_any_bit_wrong_is_none(void)
{
    TEST_ASSERT_EQUAL(BRACE_JOURNAL_READY, keep(1));
    TEST_ASSERT_EQUAL(BRACE_JOURNAL_READY, keep(2));
    for (uint32_t bit = 0; bit < 8u * (BRACE_JOURNAL_COVERED_BYTES + 4); bit++) {
        uint8_t *byte = &memory.bytes[0][BRACE_JOURNAL_AT + BRACE_JOURNAL_RECORD_BYTES + bit / 8u];
        *byte ^= (uint8_t)(1u << bit % 8u);
        TEST_ASSERT_EQUAL(1, restart(0, IDENTITY));
        *byte ^= (uint8_t)(1u << bit % 8u);
    }
    TEST_ASSERT_EQUAL(2, restart(0, IDENTITY));
}

static void test_half_a_record_does_not_hide_the_one_behind_it(void)
{
    for (int pieces = 1; pieces < BRACE_JOURNAL_PIECES; pieces++) {
        setUp();
        TEST_ASSERT_EQUAL(BRACE_JOURNAL_READY, keep(1));
        fill(&state, 2);
        TEST_ASSERT_TRUE(brace_journal_begin(&journal, &state));
        for (int i = 0; i < pieces; i++) {
            TEST_ASSERT_EQUAL(BRACE_JOURNAL_BUSY, brace_journal_step(&journal));
        }
        TEST_ASSERT_EQUAL(1, restart(0, IDENTITY));
        TEST_ASSERT_EQUAL(BRACE_JOURNAL_READY, keep(3));
        TEST_ASSERT_EQUAL(3, restart(0, IDENTITY));
        tearDown();
    }
}

static void test_a_memory_that_refuses_or_does_not_keep(void)
{
    TEST_ASSERT_EQUAL(BRACE_JOURNAL_READY, keep(1));
    memory.write_refused = true;
    TEST_ASSERT_EQUAL(BRACE_JOURNAL_FAILED, keep(2));
    memory.write_refused = false;
    memory.write_lost = true;
    TEST_ASSERT_EQUAL(BRACE_JOURNAL_FAILED, keep(3));
    memory.write_lost = false;
    TEST_ASSERT_EQUAL(BRACE_JOURNAL_READY, keep(4));
    TEST_ASSERT_EQUAL(4, restart(0, IDENTITY));
    memory.read_refused = true;
    TEST_ASSERT_EQUAL(-1, restart(0, IDENTITY));
    TEST_ASSERT_FALSE(brace_journal_begin(&journal, &state));
}

/* Whatever write is refused, the next try writes nothing over what stands, and both sessions find the right record. */
static void test_each_write_refused_in_turn(void)
{
    for (uint32_t refused = 1; refused <= (uint32_t)BRACE_JOURNAL_PIECES + 1u; refused++) {
        for (int is_restarted = 0; is_restarted < 2; is_restarted++) {
            setUp();
            TEST_ASSERT_EQUAL(BRACE_JOURNAL_READY, keep(1));
            if (is_restarted != 0) {
                TEST_ASSERT_EQUAL(1, restart(0, IDENTITY));
            }
            memory.writes_until_refused = refused;
            const brace_journal_state_t state_then = keep(2);
            const bool all_were_written = is_restarted == 0 && refused > (uint32_t)BRACE_JOURNAL_PIECES;
            TEST_ASSERT_EQUAL(all_were_written ? BRACE_JOURNAL_READY : BRACE_JOURNAL_FAILED, state_then);
            memory.writes_until_refused = 0;
            TEST_ASSERT_EQUAL(BRACE_JOURNAL_READY, keep(3));
            TEST_ASSERT_EQUAL(BRACE_JOURNAL_READY, keep(4));
            TEST_ASSERT_EQUAL(4, restart(0, IDENTITY));
            TEST_ASSERT_EQUAL(BRACE_JOURNAL_READY, keep(5));
            TEST_ASSERT_EQUAL(5, restart(0, IDENTITY));
            tearDown();
        }
    }
}

/* A scan ends at the first read that the memory refuses, be it once only: what it has found so far counts, and nothing
 * more is written there. */
static void test_each_read_refused_in_turn(void)
{
    const uint32_t pieces = BRACE_JOURNAL_PIECES;
    for (uint32_t refused = 1; refused <= 3u * pieces; refused++) {
        const uint32_t whole = (refused - 1u) / pieces;
        setUp();
        for (uint8_t i = 1; i <= 3u; i++) {
            TEST_ASSERT_EQUAL(BRACE_JOURNAL_READY, keep(i));
        }
        memory.reads_until_refused = refused;
        TEST_ASSERT_EQUAL(whole == 0u ? -1 : (int)whole, restart(0, IDENTITY));
        TEST_ASSERT_EQUAL_UINT32(0, brace_journal_room(&journal));
        tearDown();
    }
}

/* It says with its last piece that it is at its end, and reads each piece once. */
static void test_a_scan_says_when_it_is_done(void)
{
    uint32_t scans = 1;
    brace_journal_open(&journal, &hal, 0, IDENTITY);
    memory.calls = 0;
    while (brace_journal_scan(&journal, &state)) {
        scans++;
    }
    TEST_ASSERT_EQUAL_UINT32((SLOT_BYTES - BRACE_JOURNAL_AT) / BRACE_JOURNAL_PIECE_BYTES, scans);
    TEST_ASSERT_EQUAL_UINT32(scans, memory.calls);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_newest_record_is_found_again);
    RUN_TEST(test_a_record_says_what_it_is);
    RUN_TEST(test_it_fills_up_and_says_how_far);
    RUN_TEST(test_a_record_with_any_bit_wrong_is_none);
    RUN_TEST(test_half_a_record_does_not_hide_the_one_behind_it);
    RUN_TEST(test_a_memory_that_refuses_or_does_not_keep);
    RUN_TEST(test_each_write_refused_in_turn);
    RUN_TEST(test_each_read_refused_in_turn);
    RUN_TEST(test_a_scan_says_when_it_is_done);
    return UNITY_END();
}
