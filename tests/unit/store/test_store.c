#include <string.h>

#include "brace/store.h"
#include "unity.h"

/* A memory of the simplest kind, with the ways in which it may not do what it is asked. */
static struct {
    uint8_t bytes[2][4096];
    bool write_refused, read_refused, erase_refused, write_lost, erase_lost;
    bool refuses_what_it_writes; /* the one write that is refused */
    int32_t stuck_slot;
    uint32_t stuck_at, writes_until_refused, reads_until_refused;
    uint32_t calls, bytes_moved;
    uint32_t worn_at; /* a byte that no erase makes blank, less one; 0: none */
    uint32_t erased_whole; /* how often a block was still there when its slot was erased */
} memory;

static brace_hal_t hal;
static brace_store_t store;
static brace_parameters_t parameters;

static int32_t memory_read(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count)
{
    (void)context;
    memory.calls++;
    memory.bytes_moved += count;
    if (memory.read_refused || (memory.reads_until_refused != 0 && --memory.reads_until_refused == 0)) {
        return BRACE_HAL_E_DEVICE;
    }
    memcpy(bytes, memory.bytes[slot] + offset, count);
    return BRACE_HAL_OK;
}

static int32_t memory_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    memory.calls++;
    memory.bytes_moved += count;
    const bool is_refused = memory.writes_until_refused != 0 && --memory.writes_until_refused == 0;
    if (memory.write_refused || (is_refused && !memory.refuses_what_it_writes)) {
        return BRACE_HAL_E_DEVICE;
    }
    TEST_ASSERT_LESS_OR_EQUAL(BRACE_STORE_MARKS_AT + BRACE_STORE_MARK_COUNT * BRACE_STORE_MARK_BYTES, offset + count);
    for (uint32_t i = 0; i < count && !memory.write_lost; i++) {
        memory.bytes[slot][offset + i] &= bytes[i];
    }
    if ((int32_t)slot == memory.stuck_slot) {
        memory.bytes[slot][memory.stuck_at] |= 1u;
    }
    return is_refused ? BRACE_HAL_E_DEVICE : BRACE_HAL_OK;
}

static int32_t memory_erase(void *context, uint32_t slot)
{
    (void)context;
    memory.calls++;
    if (memory.erase_refused) {
        return BRACE_HAL_E_DEVICE;
    }
    memory.erased_whole += memcmp(memory.bytes[slot], "BRCE", 4) == 0;
    if (!memory.erase_lost) {
        memset(memory.bytes[slot], 0xff, sizeof memory.bytes[slot]);
    }
    if (memory.worn_at != 0u) {
        memory.bytes[slot][memory.worn_at - 1u] = 0xfeu;
    }
    return BRACE_HAL_OK;
}

void setUp(void)
{
    memset(&memory, 0, sizeof memory);
    memset(memory.bytes, 0xff, sizeof memory.bytes);
    memory.stuck_slot = -1;
    hal = (brace_hal_t){.nvm_shape = {.slot_bytes = 4096, .write_bytes = 4},
                        .nvm_read = memory_read,
                        .nvm_write = memory_write,
                        .nvm_erase = memory_erase};
    (void)brace_store_start(&store, &hal, &parameters);
}

void tearDown(void) {}

static brace_parameters_t set_of(uint32_t node_id)
{
    brace_parameters_t set;
    brace_parameters_default(&set);
    set.controller.node_id = node_id;
    return set;
}

/* Steps to the end; each a bounded piece: one call to the memory, at most 32 bytes. */
static brace_store_state_t finish(void)
{
    brace_store_state_t state = BRACE_STORE_BUSY;
    for (int i = 0; i < 200 && state == BRACE_STORE_BUSY; i++) {
        memory.calls = memory.bytes_moved = 0;
        state = brace_store_step(&store);
        TEST_ASSERT_LESS_OR_EQUAL(1, memory.calls);
        TEST_ASSERT_LESS_OR_EQUAL(BRACE_STORE_PIECE_BYTES, memory.bytes_moved);
    }
    return state;
}

static brace_store_state_t update(uint32_t node_id)
{
    const brace_parameters_t set = set_of(node_id);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_store_begin(&store, &set, NULL));
    return finish();
}

static brace_store_state_t roll_back(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_store_rollback(&store));
    return finish();
}

static void expect_after_start(brace_parameter_origin_t origin, uint32_t node_id)
{
    TEST_ASSERT_EQUAL(origin, brace_store_start(&store, &hal, &parameters));
    TEST_ASSERT_EQUAL(node_id, parameters.controller.node_id);
}

static brace_store_status_t status_now(void)
{
    brace_store_status_t status;
    brace_store_status(&store, &status);
    return status;
}

static void test_an_empty_memory_gives_the_defaults(void)
{
    expect_after_start(BRACE_PARAMETERS_DEFAULT, 0);
    TEST_ASSERT_EQUAL(BRACE_SLOT_EMPTY, status_now().slot[0].condition);
    TEST_ASSERT_EQUAL(BRACE_SLOT_EMPTY, status_now().slot[1].condition);
    TEST_ASSERT_FALSE(status_now().memory_fault);
    TEST_ASSERT_EQUAL(BRACE_STORE_IDLE, brace_store_step(&store));
    TEST_ASSERT_EQUAL(BRACE_STORE_FAILED, roll_back());
    TEST_ASSERT_EQUAL(BRACE_STORE_E_NOTHING, status_now().failure);
    TEST_ASSERT_FALSE(status_now().memory_fault);
}

static void test_updates_take_turns_and_say_so(void)
{
    for (uint32_t i = 1; i <= 5; i++) {
        TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(i));
        uint32_t crc = 0;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_store_take(&store, &parameters, i == 5 ? NULL : &crc));
        TEST_ASSERT_EQUAL(i, parameters.controller.node_id);
        TEST_ASSERT_EQUAL_HEX32(i == 5 ? 0u : brace_parameters_crc(&parameters), crc);
        TEST_ASSERT_EQUAL(i, status_now().sequence);
        TEST_ASSERT_EQUAL(i > 1, status_now().can_roll_back);
        TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_store_take(&store, &parameters, NULL));
        if (i % 2 == 0) { /* in the same session, or in the next */
            expect_after_start(BRACE_PARAMETERS_SLOT_B, i);
        }
    }
    expect_after_start(BRACE_PARAMETERS_SLOT_A, 5);
}

static void test_roll_back_and_no_further(void)
{
    update(1);
    update(2);
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, roll_back());
    uint32_t crc = 0;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_store_take(&store, &parameters, &crc));
    TEST_ASSERT_EQUAL(1, parameters.controller.node_id);
    TEST_ASSERT_EQUAL_HEX32(brace_parameters_crc(&parameters), crc);
    expect_after_start(BRACE_PARAMETERS_SLOT_A, 1);
    TEST_ASSERT_EQUAL(BRACE_SLOT_VOID, status_now().slot[1].condition);
    TEST_ASSERT_EQUAL(BRACE_STORE_FAILED, roll_back());
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(3));
    TEST_ASSERT_EQUAL(3, status_now().sequence); /* never the number of the set that was left */
    expect_after_start(BRACE_PARAMETERS_SLOT_B, 3);
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, roll_back());
    expect_after_start(BRACE_PARAMETERS_SLOT_A, 1);
}

static void test_a_reload_reads_the_set_in_force_and_writes_nothing(void)
{
    update(1);
    update(2);
    const uint32_t sequence = status_now().sequence;
    uint8_t before[2][4096];
    memcpy(before, memory.bytes, sizeof before);
    for (int i = 0; i < 2; i++) {
        uint32_t crc = 0;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_store_reload(&store));
        TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_store_reload(&store));
        TEST_ASSERT_EQUAL(BRACE_STORE_DONE, finish());
        TEST_ASSERT_EQUAL(BRACE_OK, brace_store_take(&store, &parameters, &crc));
        TEST_ASSERT_EQUAL(2, parameters.controller.node_id);
        TEST_ASSERT_EQUAL_HEX32(brace_parameters_crc(&parameters), crc);
        TEST_ASSERT_EQUAL(sequence, status_now().sequence);
        TEST_ASSERT_TRUE(status_now().can_roll_back);
    }
    TEST_ASSERT_EQUAL_MEMORY(before, memory.bytes, sizeof before);
    for (uint32_t at = 0; at < BRACE_BLOCK_BYTES; at++) { /* in every byte one bit; of the check every bit */
        const bool is_check = at >= BRACE_BLOCK_BYTES - 4u;
        for (uint32_t bit = is_check ? 0u : at % 8u; bit < (is_check ? 8u : at % 8u + 1u); bit++) {
            memory.bytes[1][at] ^= (uint8_t)(1u << bit);
            TEST_ASSERT_EQUAL(BRACE_OK, brace_store_reload(&store));
            TEST_ASSERT_EQUAL(BRACE_STORE_FAILED, finish());
            TEST_ASSERT_EQUAL(BRACE_STORE_E_READ_BACK, status_now().failure);
            memory.bytes[1][at] ^= (uint8_t)(1u << bit);
        }
    }
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, roll_back());
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_store_reload(NULL));
}

static void test_without_a_set_there_is_nothing_to_reload(void)
{
    expect_after_start(BRACE_PARAMETERS_DEFAULT, 0);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_store_reload(&store));
    TEST_ASSERT_EQUAL(BRACE_STORE_E_NOTHING, status_now().failure);
}

static void put_block(uint32_t slot, uint32_t node_id, uint32_t sequence, bool keep)
{
    const brace_parameters_t set = set_of(node_id);
    uint8_t *block = memory.bytes[slot];
    TEST_ASSERT_EQUAL(BRACE_OK, brace_parameters_pack(&set, sequence, block, BRACE_BLOCK_BYTES));
    if (keep) {
        memcpy(block + BRACE_STORE_MARKS_AT, "KEEP", 4);
        memcpy(block + BRACE_STORE_MARKS_AT + 4, block + BRACE_BLOCK_BYTES - 4, 4);
    }
}

static void test_sequences_wrap_around(void)
{
    put_block(0, 1, 0xffffffffu, true);
    put_block(1, 2, 0xfffffffeu, true);
    expect_after_start(BRACE_PARAMETERS_SLOT_A, 1);
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(3));
    TEST_ASSERT_EQUAL(0, status_now().sequence);
    expect_after_start(BRACE_PARAMETERS_SLOT_B, 3);
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(4));
    expect_after_start(BRACE_PARAMETERS_SLOT_A, 4);
}

static void test_a_block_without_its_mark_does_not_count(void)
{
    put_block(0, 1, 7, true);
    put_block(1, 2, 8, false);
    expect_after_start(BRACE_PARAMETERS_SLOT_A, 1);
    TEST_ASSERT_EQUAL(BRACE_SLOT_NOT_COMMITTED, status_now().slot[1].condition);
    /* another block's mark */
    memcpy(memory.bytes[1] + BRACE_STORE_MARKS_AT, memory.bytes[0] + BRACE_STORE_MARKS_AT, 8);
    expect_after_start(BRACE_PARAMETERS_SLOT_A, 1);
    TEST_ASSERT_EQUAL(BRACE_SLOT_NOT_COMMITTED, status_now().slot[1].condition);
}

/* Another firmware's block, of another length too: refused as such and left alone until a set is kept elsewhere. */
static void test_a_block_of_another_dictionary(void)
{
    for (uint32_t slot = 0; slot < 2; slot++) {
        setUp();
        uint8_t *block = memory.bytes[slot];
        put_block(slot, 1, 7, true);
        block[8] ^= 1u;
        block[12] = (uint8_t)((4 * BRACE_PARAMETER_COUNT + 40) & 0xff);
        block[13] = (uint8_t)((4 * BRACE_PARAMETER_COUNT + 40) >> 8);
        const uint32_t covered = BRACE_BLOCK_BYTES - 4 + 40;
        const uint32_t crc = brace_crc32(0, block, covered);
        memcpy(block + covered, &crc, 4);
        memcpy(block + BRACE_STORE_MARKS_AT + 4, &crc, 4);
        uint8_t kept[4096];
        memcpy(kept, block, sizeof kept);
        expect_after_start(BRACE_PARAMETERS_DEFAULT, 0);
        TEST_ASSERT_EQUAL(BRACE_SLOT_OTHER_SCHEMA, status_now().slot[slot].condition);
        TEST_ASSERT_EQUAL_HEX32(BRACE_SCHEMA_HASH ^ 1u, status_now().slot[slot].schema_hash);
        TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(3));
        TEST_ASSERT_EQUAL_MEMORY(kept, block, sizeof kept);
        expect_after_start(slot == 0 ? BRACE_PARAMETERS_SLOT_B : BRACE_PARAMETERS_SLOT_A, 3);
        block[30] ^= 1u;
        expect_after_start(slot == 0 ? BRACE_PARAMETERS_SLOT_B : BRACE_PARAMETERS_SLOT_A, 3);
        TEST_ASSERT_EQUAL(BRACE_SLOT_DAMAGED, status_now().slot[slot].condition);
    }
}

/* A set with a node number that no node has, kept. */
static void put_refused_block(uint32_t slot, uint32_t sequence)
{
    put_block(slot, 1, sequence, true);
    uint8_t *block = memory.bytes[slot];
    block[20 + 4 * BRACE_PARAMETER_CONTROLLER_NODE_ID] = 200;
    const uint32_t crc = brace_crc32(0, block, BRACE_BLOCK_BYTES - 4);
    memcpy(block + BRACE_BLOCK_BYTES - 4, &crc, 4);
    memcpy(block + BRACE_STORE_MARKS_AT + 4, &crc, 4);
}

static void expect_unreported(const brace_slot_report_t *reported)
{
    TEST_ASSERT_EQUAL(0, reported->sequence);
    TEST_ASSERT_EQUAL(0, reported->schema_hash);
    TEST_ASSERT_EQUAL(0, reported->block_crc);
    TEST_ASSERT_EQUAL(0, reported->wrong_index);
}

/* What a slot's condition leaves unknown is reported as 0, whatever a start before has found there. */
static void test_what_a_slot_does_not_report_is_zero(void)
{
    static const brace_slot_condition_t condition[] = {BRACE_SLOT_EMPTY, BRACE_SLOT_DAMAGED, BRACE_SLOT_UNREADABLE};
    for (uint32_t i = 0; i < 3u; i++) {
        setUp();
        put_refused_block(0, 7);
        put_block(1, 1, 8, true);
        expect_after_start(BRACE_PARAMETERS_SLOT_B, 1);
        TEST_ASSERT_EQUAL(7, status_now().slot[0].sequence);
        if (condition[i] == BRACE_SLOT_EMPTY) {
            memset(memory.bytes[0], 0xff, sizeof memory.bytes[0]);
        }
        memory.bytes[0][30] ^= condition[i] == BRACE_SLOT_DAMAGED;
        memory.reads_until_refused = condition[i] == BRACE_SLOT_UNREADABLE; /* the first of a start */
        expect_after_start(BRACE_PARAMETERS_SLOT_B, 1);
        const brace_store_status_t status = status_now();
        TEST_ASSERT_EQUAL(condition[i], status.slot[0].condition);
        expect_unreported(&status.slot[0]);
        TEST_ASSERT_EQUAL(0, status.slot[1].wrong_index);
        TEST_ASSERT_NOT_EQUAL(0, status.slot[1].block_crc);
    }
}

/* A slot is empty where no block begins. Where one does whose header no firmware reads, it is damaged, not empty. */
static void test_a_header_that_nobody_reads_is_damaged(void)
{
    static const uint32_t places[] = {4, 6, 12}; /* of the format, the header's bytes, the members' bytes */
    for (uint32_t i = 0; i < 3u; i++) {
        setUp();
        put_block(0, 1, 7, true);
        memory.bytes[0][places[i]] ^= 1u;
        expect_after_start(BRACE_PARAMETERS_DEFAULT, 0);
        TEST_ASSERT_EQUAL(BRACE_SLOT_DAMAGED, status_now().slot[0].condition);
        TEST_ASSERT_EQUAL(BRACE_SLOT_EMPTY, status_now().slot[1].condition);
    }
}

static void test_a_value_out_of_range_is_named(void)
{
    put_refused_block(0, 7);
    expect_after_start(BRACE_PARAMETERS_DEFAULT, 0);
    TEST_ASSERT_EQUAL(BRACE_SLOT_REFUSED, status_now().slot[0].condition);
    TEST_ASSERT_EQUAL(BRACE_PARAMETER_CONTROLLER_NODE_ID, status_now().slot[0].wrong_index);
}

/* Its mark says that it was kept; it is refused all the same, and nothing of it comes in force. */
static void test_a_refused_set_leaves_the_other_in_force(void)
{
    for (uint32_t slot = 0; slot < 2u; slot++) {
        put_block(1u - slot, 2, 7, true);
        put_refused_block(slot, 8);
        expect_after_start(slot == 0u ? BRACE_PARAMETERS_SLOT_B : BRACE_PARAMETERS_SLOT_A, 2);
        TEST_ASSERT_EQUAL(BRACE_SLOT_REFUSED, status_now().slot[slot].condition);
    }
}

/* Sixty sessions in a row are broken off after their first mark: there is always room for what matters. */
static void test_marks_never_run_out(void)
{
    update(1);
    update(2);
    for (uint32_t i = 0; i < 60; i++) {
        expect_after_start(BRACE_PARAMETERS_SLOT_B, 2);
        const brace_parameters_t set = set_of(3);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_store_begin(&store, &set, NULL));
        for (int step = 0; step < 3; step++) {
            brace_store_step(&store);
        }
    }
    expect_after_start(BRACE_PARAMETERS_SLOT_B, 2);
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(3));
    expect_after_start(BRACE_PARAMETERS_SLOT_A, 3);
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, roll_back()); /* to a slot full of marks */
    expect_after_start(BRACE_PARAMETERS_SLOT_B, 2);
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(4));
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(5));
    expect_after_start(BRACE_PARAMETERS_SLOT_B, 5);
}

static void begin_with_marks(uint32_t taken)
{
    setUp();
    for (uint32_t slot = 0; slot < 2u; slot++) {
        uint8_t *marks = memory.bytes[slot] + BRACE_STORE_MARKS_AT;
        put_block(slot, 1u + slot, 7u + slot, true);
        memmove(marks + (taken - 1u) * BRACE_STORE_MARK_BYTES, marks, BRACE_STORE_MARK_BYTES);
    }
    expect_after_start(BRACE_PARAMETERS_SLOT_B, 2);
}

/* Nor is one written behind the last place (memory_write), however many are taken when a session begins. A roll-back
 * needs three: two that a mark may have been lost in, and its own. */
static void test_marks_keep_to_their_places(void)
{
    for (uint32_t taken = 1; taken <= BRACE_STORE_MARK_COUNT; taken++) {
        const bool has_room = taken + 3u <= BRACE_STORE_MARK_COUNT;
        begin_with_marks(taken);
        TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(3));
        expect_after_start(BRACE_PARAMETERS_SLOT_A, 3);
        begin_with_marks(taken);
        TEST_ASSERT_EQUAL(has_room ? BRACE_STORE_DONE : BRACE_STORE_FAILED, roll_back());
        expect_after_start(has_room ? BRACE_PARAMETERS_SLOT_A : BRACE_PARAMETERS_SLOT_B, has_room ? 1 : 2);
    }
}

static void expect_failure(brace_store_state_t state, brace_store_failure_t failure)
{
    TEST_ASSERT_EQUAL(BRACE_STORE_FAILED, state);
    TEST_ASSERT_EQUAL(failure, status_now().failure);
    TEST_ASSERT_TRUE(status_now().memory_fault);
    TEST_ASSERT_EQUAL(BRACE_PARAMETERS_SLOT_B, status_now().in_force);
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_store_take(&store, &parameters, NULL));
}

static void test_a_memory_that_does_not_keep(void)
{
    update(1);
    update(2);
    memory.write_refused = true;
    expect_failure(update(3), BRACE_STORE_E_DEVICE);
    expect_failure(roll_back(), BRACE_STORE_E_DEVICE);
    memory.write_refused = false;
    memory.write_lost = true;
    expect_failure(update(3), BRACE_STORE_E_READ_BACK);
    memory.write_lost = false;
    memory.erase_refused = true;
    expect_failure(update(3), BRACE_STORE_E_DEVICE);
    memory.erase_refused = false;
    memory.erase_lost = true;
    memory.bytes[0][100] = 0x5a;
    expect_failure(update(3), BRACE_STORE_E_ERASE);
    memory.erase_lost = false;
    expect_after_start(BRACE_PARAMETERS_SLOT_B, 2);
    for (uint32_t at = 0; at < BRACE_BLOCK_BYTES; at += 53) { /* a bit that stays 1, wherever the block has a 0 */
        const brace_parameters_t set = set_of(3);
        uint8_t block[BRACE_BLOCK_BYTES];
        TEST_ASSERT_EQUAL(BRACE_OK, brace_parameters_pack(&set, status_now().sequence + 1, block, sizeof block));
        memory.stuck_slot = 0;
        memory.stuck_at = at;
        if ((block[at] & 1u) == 0) {
            expect_failure(update(3), BRACE_STORE_E_READ_BACK);
            expect_after_start(BRACE_PARAMETERS_SLOT_B, 2);
        }
    }
    memory.stuck_at = BRACE_STORE_MARKS_AT + 3; /* 'P' */
    expect_failure(update(3), BRACE_STORE_E_READ_BACK);
    expect_after_start(BRACE_PARAMETERS_SLOT_B, 2);
    memory.stuck_slot = -1;
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(3));
    TEST_ASSERT_FALSE(status_now().memory_fault);
    expect_after_start(BRACE_PARAMETERS_SLOT_A, 3);
}

/* A set that is not the one that was named is not stored; the refusal says so, and of no entry. */
static void test_a_set_that_is_not_the_one_named(void)
{
    const brace_parameters_t set = set_of(3);
    update(1);
    update(2);
    const uint32_t erases = store.erases;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_store_begin(&store, &set, NULL));
    brace_store_expect(&store, brace_parameters_crc(&set) ^ 1u);
    TEST_ASSERT_EQUAL(BRACE_STORE_FAILED, finish());
    TEST_ASSERT_EQUAL(BRACE_STORE_E_REFUSED, status_now().failure);
    TEST_ASSERT_EQUAL(BRACE_E_CHECKSUM, status_now().refusal);
    TEST_ASSERT_EQUAL(BRACE_PARAMETER_COUNT, status_now().wrong_index);
    TEST_ASSERT_EQUAL(erases, store.erases);
    expect_after_start(BRACE_PARAMETERS_SLOT_B, 2);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_store_begin(&store, &set, NULL));
    brace_store_expect(&store, brace_parameters_crc(&set));
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, finish());
    expect_after_start(BRACE_PARAMETERS_SLOT_A, 3);
}

/* Where the block and the marks will stand, each byte has to be blank after an erase. */
static void test_a_byte_that_does_not_become_blank(void)
{
    const uint32_t marks_bytes = BRACE_STORE_MARK_COUNT * BRACE_STORE_MARK_BYTES;
    for (uint32_t at = 0; at < (uint32_t)BRACE_BLOCK_BYTES + marks_bytes; at += 7u) {
        setUp();
        TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(1));
        memory.worn_at =
            1u + (at < (uint32_t)BRACE_BLOCK_BYTES ? at : at - (uint32_t)BRACE_BLOCK_BYTES + BRACE_STORE_MARKS_AT);
        TEST_ASSERT_EQUAL(BRACE_STORE_FAILED, update(2));
        TEST_ASSERT_EQUAL(BRACE_STORE_E_ERASE, status_now().failure);
        memory.worn_at = 0;
        expect_after_start(BRACE_PARAMETERS_SLOT_A, 1);
    }
    setUp();
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(1));
    memory.worn_at = BRACE_STORE_MARKS_AT; /* the byte before the marks holds nothing */
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(2));
}

/* An erase that power cuts short may leave anything; so no block is there when it begins. */
static void test_a_block_is_spoilt_before_its_slot_is_erased(void)
{
    for (uint32_t i = 1; i <= 6u; i++) {
        TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(i));
    }
    TEST_ASSERT_EQUAL(6, store.erases);
    TEST_ASSERT_EQUAL(0, memory.erased_whole);
}

/* Erases are counted, up to the greatest number. */
static void test_erases_are_counted(void)
{
    update(1);
    const uint32_t before = store.erases;
    update(2);
    TEST_ASSERT_EQUAL(before + 1u, store.erases);
    store.erases = UINT32_MAX;
    update(3);
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX, store.erases);
}

/* A mark that is not kept takes a place each time. When no place is left, an update goes on without: the old set
 * counts as long as the memory keeps nothing, and the new one when it does. */
static void test_marks_that_are_not_kept_use_up_their_places(void)
{
    update(1);
    update(2);
    expect_after_start(BRACE_PARAMETERS_SLOT_B, 2); /* each start keeps its set with a mark */
    memory.write_lost = true;
    for (uint32_t i = 0; i < 3u * BRACE_STORE_MARK_COUNT; i++) {
        expect_failure(update(3), BRACE_STORE_E_READ_BACK);
    }
    memory.write_lost = false;
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(4));
    expect_after_start(status_now().in_force, 4);
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(5));
    expect_after_start(status_now().in_force, 5);
}

/* Wherever a write is refused, power staying on, the old set stays in force and the next start has it too. */
static void test_each_write_refused_in_turn(void)
{
    for (int rolling_back = 0; rolling_back < 2; rolling_back++) {
        for (uint32_t refused = 1;; refused++) {
            setUp();
            update(1);
            update(2);
            expect_after_start(BRACE_PARAMETERS_SLOT_B, 2);
            memory.writes_until_refused = refused;
            const brace_store_state_t state = rolling_back != 0 ? roll_back() : update(3);
            if (memory.writes_until_refused != 0) {
                TEST_ASSERT_EQUAL(BRACE_STORE_DONE, state);
                TEST_ASSERT_GREATER_THAN(rolling_back != 0 ? 3 : 17, refused);
                break;
            }
            if (state == BRACE_STORE_DONE) { /* refused is only the mark that is one more than needed */
                TEST_ASSERT_TRUE(status_now().memory_fault);
                expect_after_start(BRACE_PARAMETERS_SLOT_A, rolling_back != 0 ? 1 : 3);
                TEST_ASSERT_FALSE(status_now().is_old);
                TEST_ASSERT_GREATER_THAN(rolling_back != 0 ? 3 : 17, refused);
                continue;
            }
            expect_failure(state, BRACE_STORE_E_DEVICE);
            expect_after_start(BRACE_PARAMETERS_SLOT_B, 2);
        }
    }
}

/* Whichever read is refused, of an update, a roll-back or a reload: the set of before stays in force. */
static void test_each_read_refused_in_turn(void)
{
    for (int kind = 0; kind < 3; kind++) {
        for (uint32_t refused = 1;; refused++) {
            setUp();
            update(1);
            update(2);
            expect_after_start(BRACE_PARAMETERS_SLOT_B, 2);
            memory.reads_until_refused = refused;
            brace_store_state_t state;
            if (kind == 2) {
                TEST_ASSERT_EQUAL(BRACE_OK, brace_store_reload(&store));
                state = finish();
            } else {
                state = kind == 1 ? roll_back() : update(3);
            }
            if (memory.reads_until_refused != 0) {
                TEST_ASSERT_EQUAL(BRACE_STORE_DONE, state);
                TEST_ASSERT_GREATER_THAN(kind == 1 ? 15 : 10, refused);
                break;
            }
            if (state == BRACE_STORE_DONE) { /* refused is only the reading of the mark that is one more than needed */
                TEST_ASSERT_TRUE(kind != 2 && status_now().memory_fault);
                expect_after_start(BRACE_PARAMETERS_SLOT_A, kind == 1 ? 1 : 3);
                TEST_ASSERT_FALSE(status_now().is_old);
                continue;
            }
            TEST_ASSERT_EQUAL(BRACE_STORE_FAILED, state);
            TEST_ASSERT_EQUAL(BRACE_STORE_E_DEVICE, status_now().failure);
            TEST_ASSERT_EQUAL(BRACE_PARAMETERS_SLOT_B, status_now().in_force);
            TEST_ASSERT_EQUAL(kind != 2, status_now().memory_fault);
            expect_after_start(BRACE_PARAMETERS_SLOT_B, 2);
        }
    }
}

/* A start that may not read a slot's block, or one of its marks, goes by the other slot. */
static void test_each_read_of_a_start_refused_in_turn(void)
{
    update(1);
    update(2);
    for (uint32_t refused = 1;; refused++) {
        memory.reads_until_refused = refused;
        const brace_parameter_origin_t origin = brace_store_start(&store, &hal, &parameters);
        if (memory.reads_until_refused != 0) {
            TEST_ASSERT_GREATER_THAN(100, refused); /* two blocks, and the marks of both */
            break;
        }
        const uint32_t lost = status_now().slot[0].condition == BRACE_SLOT_UNREADABLE ? 0u : 1u;
        TEST_ASSERT_EQUAL(BRACE_SLOT_UNREADABLE, status_now().slot[lost].condition);
        TEST_ASSERT_EQUAL(2u - lost, (uint32_t)origin);
        TEST_ASSERT_EQUAL(2u - lost, parameters.controller.node_id);
        TEST_ASSERT_TRUE(status_now().memory_fault);
    }
    memory.reads_until_refused = 0;
}

/* A block of another firmware that cannot be read to its end is damaged, as far as this start can see. */
static void test_another_dictionary_s_block_that_cannot_be_read_to_its_end(void)
{
    put_block(0, 1, 7, true);
    memory.bytes[0][8] ^= 1u;
    memory.reads_until_refused = 3; /* the block, and a piece of it for its CRC */
    TEST_ASSERT_EQUAL(BRACE_PARAMETERS_DEFAULT, brace_store_start(&store, &hal, &parameters));
    TEST_ASSERT_EQUAL(BRACE_SLOT_DAMAGED, status_now().slot[0].condition);
}

/* Both slots hold another firmware's blocks: the older one goes. */
static void test_of_two_other_dictionaries_the_older_block_goes(void)
{
    for (uint32_t older = 0; older < 2; older++) {
        setUp();
        for (uint32_t slot = 0; slot < 2; slot++) {
            put_block(slot, 1, slot == older ? 7 : 8, true);
            memory.bytes[slot][8] ^= 1u;
            const uint32_t crc = brace_crc32(0, memory.bytes[slot], BRACE_BLOCK_BYTES - 4);
            memcpy(memory.bytes[slot] + BRACE_BLOCK_BYTES - 4, &crc, 4);
        }
        expect_after_start(BRACE_PARAMETERS_DEFAULT, 0);
        TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(3));
        TEST_ASSERT_EQUAL(older == 0 ? BRACE_PARAMETERS_SLOT_A : BRACE_PARAMETERS_SLOT_B, status_now().in_force);
        TEST_ASSERT_EQUAL(BRACE_SLOT_OTHER_SCHEMA, status_now().slot[1u - older].condition);
    }
}

/* Neither block counts, and one of them is ours: it must not come back once another set is in force. */
static void test_a_set_that_did_not_count_does_not_come_back(void)
{
    for (uint32_t slot = 0; slot < 2; slot++) {
        setUp();
        put_block(slot, 1, 7, false); /* written, not committed */
        put_block(1u - slot, 2, 8, false);
        expect_after_start(BRACE_PARAMETERS_DEFAULT, 0);
        TEST_ASSERT_EQUAL(BRACE_STORE_DONE, update(3));
        const uint32_t written = (uint32_t)status_now().in_force - 1u;
        TEST_ASSERT_EQUAL(BRACE_SLOT_VOID, status_now().slot[1u - written].condition);
        TEST_ASSERT_FALSE(status_now().can_roll_back);
        expect_after_start((brace_parameter_origin_t)(written + 1u), 3);
        TEST_ASSERT_EQUAL(BRACE_SLOT_VOID, status_now().slot[1u - written].condition);
    }
}

static void test_a_memory_that_does_not_answer(void)
{
    update(1);
    memory.read_refused = true;
    expect_after_start(BRACE_PARAMETERS_DEFAULT, 0);
    TEST_ASSERT_EQUAL(BRACE_SLOT_UNREADABLE, status_now().slot[0].condition);
    TEST_ASSERT_TRUE(status_now().memory_fault);
    memory.read_refused = false;
    hal.nvm_shape.slot_bytes = 2048;
    expect_after_start(BRACE_PARAMETERS_DEFAULT, 0);
    TEST_ASSERT_TRUE(status_now().memory_fault);
    TEST_ASSERT_EQUAL(BRACE_SLOT_UNREADABLE, status_now().slot[0].condition);
    TEST_ASSERT_EQUAL(BRACE_SLOT_UNREADABLE, status_now().slot[1].condition);
    TEST_ASSERT_EQUAL(BRACE_STORE_FAILED, update(2));
    TEST_ASSERT_EQUAL(BRACE_STORE_E_SHAPE, status_now().failure);
    hal.nvm_shape.slot_bytes = 4096;
    hal.nvm_shape.write_bytes = 16;
    expect_after_start(BRACE_PARAMETERS_DEFAULT, 0);
    hal.nvm_shape.write_bytes = 1;
    expect_after_start(BRACE_PARAMETERS_SLOT_A, 1);
    const brace_hal_t whole = hal;
    hal.nvm_read = NULL;
    expect_after_start(BRACE_PARAMETERS_DEFAULT, 0);
    hal = whole;
    hal.nvm_write = NULL;
    expect_after_start(BRACE_PARAMETERS_DEFAULT, 0);
    hal = whole;
    hal.nvm_erase = NULL;
    expect_after_start(BRACE_PARAMETERS_DEFAULT, 0);
    hal = whole;
    expect_after_start(BRACE_PARAMETERS_SLOT_A, 1);
}

/* A roll-back whose mark is written though the memory denies it, and whose undoing the memory refuses: the set in force
 * stays in force, and is affirmed anew before the other slot is touched. So whenever the power fails, one of two sets
 * is there. */
static void test_a_set_is_affirmed_anew_after_a_mark_that_may_stand(void)
{
    update(1);
    update(2);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_store_rollback(&store));
    memory.refuses_what_it_writes = true;
    brace_store_state_t state = BRACE_STORE_BUSY;
    for (int i = 0; i < 200 && state == BRACE_STORE_BUSY; i++) {
        uint8_t before[4096];
        memcpy(before, memory.bytes[1], sizeof before);
        memory.writes_until_refused = memory.write_refused ? 0u : 1u;
        state = brace_store_step(&store);
        memory.write_refused = memory.write_refused || memcmp(before, memory.bytes[1], sizeof before) != 0;
    }
    TEST_ASSERT_EQUAL(BRACE_STORE_FAILED, state);
    memory.write_refused = false;
    memory.writes_until_refused = 0;
    TEST_ASSERT_EQUAL(BRACE_PARAMETERS_SLOT_B, status_now().in_force);
    const brace_parameters_t set = set_of(3);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_store_begin(&store, &set, NULL));
    bool is_erased = false;
    for (int i = 0; i < 200 && !is_erased; i++) {
        (void)brace_store_step(&store);
        is_erased = memory.bytes[0][0] == 0xffu;
    }
    TEST_ASSERT_TRUE(is_erased);
    expect_after_start(BRACE_PARAMETERS_SLOT_B, 2);
}

static void test_what_is_refused_at_once(void)
{
    brace_parameters_t wrong = set_of(1);
    uint32_t index = 0;
    wrong.sensor.gain = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_store_begin(&store, &wrong, &index));
    TEST_ASSERT_EQUAL(BRACE_PARAMETER_SENSOR_GAIN, index);
    TEST_ASSERT_EQUAL(BRACE_STORE_IDLE, status_now().state);
    wrong = set_of(1);
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_store_begin(NULL, &wrong, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_store_begin(&store, NULL, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_store_rollback(NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_store_take(&store, NULL, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_store_take(NULL, &wrong, NULL));
    TEST_ASSERT_EQUAL(BRACE_STORE_IDLE, brace_store_step(NULL));
    brace_store_status(NULL, NULL);
    brace_store_status(&store, NULL);
    brace_store_expect(NULL, 1);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_store_begin(&store, &wrong, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_store_begin(&store, &wrong, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_store_rollback(&store));
    wrong.sensor.gain = 0.0f; /* while it works, a store judges no other set */
    index = 0;
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_store_begin(&store, &wrong, &index));
    TEST_ASSERT_EQUAL(0, index);
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, finish());
}

/* The first steps of an update that is offered check it, and touch nothing. */
static void test_a_set_that_is_offered_is_judged_on_the_way(void)
{
    update(1);
    for (int fault = 0; fault < 3; fault++) {
        brace_parameters_t wrong = set_of(2);
        uint32_t index = 0;
        if (fault == 0) {
            wrong.limb.coxa_mm = -1.0f;
        } else if (fault == 1) {
            wrong.sensor.gain = __builtin_nanf("");
        } else { /* what members say together */
            wrong.drive[BRACE_TIBIA].angle_max_rad = wrong.drive[BRACE_TIBIA].angle_min_rad;
        }
        const brace_status_t status = brace_parameters_check(&wrong, &index);
        const uint8_t first = memory.bytes[1][0];
        TEST_ASSERT_EQUAL(BRACE_OK, brace_store_offer(&store, &wrong));
        uint32_t calls = 0;
        while (brace_store_step(&store) == BRACE_STORE_BUSY) {
            calls++;
            TEST_ASSERT_LESS_THAN(BRACE_CHECK_PIECES, calls);
        }
        TEST_ASSERT_EQUAL(BRACE_STORE_FAILED, status_now().state);
        TEST_ASSERT_EQUAL(BRACE_STORE_E_REFUSED, status_now().failure);
        TEST_ASSERT_EQUAL(status, status_now().refusal);
        TEST_ASSERT_EQUAL(index, status_now().wrong_index);
        TEST_ASSERT_FALSE(status_now().memory_fault);
        TEST_ASSERT_EQUAL(first, memory.bytes[1][0]);
        expect_after_start(BRACE_PARAMETERS_SLOT_A, 1);
    }
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_store_offer(NULL, &parameters));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_store_offer(&store, NULL));
    const brace_parameters_t right = set_of(2);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_store_offer(&store, &right));
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_store_offer(&store, &right));
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, finish());
    TEST_ASSERT_EQUAL(BRACE_OK, status_now().refusal);
    uint8_t block[BRACE_BLOCK_BYTES];
    TEST_ASSERT_EQUAL(BRACE_OK, brace_parameters_pack(&right, 2, block, sizeof block));
    TEST_ASSERT_EQUAL_MEMORY(block, memory.bytes[1], sizeof block);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_empty_memory_gives_the_defaults);
    RUN_TEST(test_updates_take_turns_and_say_so);
    RUN_TEST(test_roll_back_and_no_further);
    RUN_TEST(test_a_reload_reads_the_set_in_force_and_writes_nothing);
    RUN_TEST(test_without_a_set_there_is_nothing_to_reload);
    RUN_TEST(test_sequences_wrap_around);
    RUN_TEST(test_a_block_without_its_mark_does_not_count);
    RUN_TEST(test_a_block_of_another_dictionary);
    RUN_TEST(test_what_a_slot_does_not_report_is_zero);
    RUN_TEST(test_a_header_that_nobody_reads_is_damaged);
    RUN_TEST(test_a_value_out_of_range_is_named);
    RUN_TEST(test_a_refused_set_leaves_the_other_in_force);
    RUN_TEST(test_marks_never_run_out);
    RUN_TEST(test_marks_keep_to_their_places);
    RUN_TEST(test_a_memory_that_does_not_keep);
    RUN_TEST(test_a_set_that_is_not_the_one_named);
    RUN_TEST(test_a_byte_that_does_not_become_blank);
    RUN_TEST(test_a_block_is_spoilt_before_its_slot_is_erased);
    RUN_TEST(test_erases_are_counted);
    RUN_TEST(test_marks_that_are_not_kept_use_up_their_places);
    RUN_TEST(test_each_write_refused_in_turn);
    RUN_TEST(test_each_read_refused_in_turn);
    RUN_TEST(test_each_read_of_a_start_refused_in_turn);
    RUN_TEST(test_another_dictionary_s_block_that_cannot_be_read_to_its_end);
    RUN_TEST(test_of_two_other_dictionaries_the_older_block_goes);
    RUN_TEST(test_a_set_that_did_not_count_does_not_come_back);
    RUN_TEST(test_a_memory_that_does_not_answer);
    RUN_TEST(test_a_set_is_affirmed_anew_after_a_mark_that_may_stand);
    RUN_TEST(test_what_is_refused_at_once);
    RUN_TEST(test_a_set_that_is_offered_is_judged_on_the_way);
    return UNITY_END();
}
