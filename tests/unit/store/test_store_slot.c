/* What a start finds in a slot that another firmware has written. */
#include <string.h>

#include "brace/store.h"
#include "brace_hal_fake.h"
#include "unity.h"

static brace_fake_t fake;
static brace_store_t store;

void setUp(void)
{
    brace_fake_start(&fake);
}

void tearDown(void) {}

/* The condition of slot A with a whole block of another dictionary in it, so many bytes long. */
static brace_slot_condition_t condition_of(uint32_t block_bytes)
{
    brace_parameters_t set;
    brace_store_status_t status;
    uint8_t *block = fake.nvm[0];
    const uint32_t covered = block_bytes - 4u, member_bytes = covered - BRACE_BLOCK_HEADER_BYTES;
    brace_parameters_default(&set);
    memset(fake.nvm, 0xff, sizeof fake.nvm);
    brace_block_compose(&set, 7, block);
    block[8] ^= 1u; /* the dictionary's hash */
    memcpy(block + 12, &member_bytes, 4);
    const uint32_t crc = brace_crc32(0, block, covered);
    memcpy(block + covered, &crc, 4);
    TEST_ASSERT_EQUAL(BRACE_PARAMETERS_DEFAULT, brace_store_start(&store, &fake.hal, &set));
    brace_store_status(&store, &status);
    TEST_ASSERT_EQUAL(BRACE_SLOT_EMPTY, status.slot[1].condition);
    return status.slot[0].condition;
}

/* It may be longer than any of ours, but no block reaches into the marks. */
static void test_a_block_ends_before_the_marks(void)
{
    TEST_ASSERT_EQUAL(BRACE_SLOT_OTHER_SCHEMA, condition_of(BRACE_BLOCK_BYTES));
    TEST_ASSERT_EQUAL(0, store.next_mark[0]); /* none is there: the first one comes to the first place */
    TEST_ASSERT_EQUAL(BRACE_SLOT_OTHER_SCHEMA, condition_of(BRACE_STORE_MARKS_AT));
    TEST_ASSERT_EQUAL(BRACE_SLOT_DAMAGED, condition_of(BRACE_STORE_MARKS_AT + 4));
}

/* Of a block of ours everything is reported, whether it counts or not. */
static void test_what_a_block_of_ours_reports(void)
{
    for (uint32_t slot = 0; slot < 2u; slot++) {
        brace_parameters_t set;
        brace_store_status_t status;
        uint32_t crc;
        brace_fake_start(&fake);
        brace_parameters_default(&set);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_parameters_pack(&set, 9 + slot, fake.nvm[slot], BRACE_BLOCK_BYTES));
        memcpy(&crc, fake.nvm[slot] + BRACE_BLOCK_BYTES - 4, 4);
        TEST_ASSERT_EQUAL(BRACE_PARAMETERS_DEFAULT, brace_store_start(&store, &fake.hal, &set));
        brace_store_status(&store, &status);
        const brace_slot_report_t *reported = &status.slot[slot];
        TEST_ASSERT_EQUAL(BRACE_SLOT_NOT_COMMITTED, reported->condition);
        TEST_ASSERT_EQUAL_HEX32(BRACE_SCHEMA_HASH, reported->schema_hash);
        TEST_ASSERT_EQUAL_UINT32(9 + slot, reported->sequence);
        TEST_ASSERT_EQUAL_HEX32(crc, reported->block_crc);
        TEST_ASSERT_EQUAL_UINT32(0, reported->wrong_index);
    }
}

static brace_store_state_t steps(uint32_t count)
{
    brace_store_state_t state = BRACE_STORE_BUSY;
    for (uint32_t i = 0; i < count && state == BRACE_STORE_BUSY; i++) {
        state = brace_store_step(&store);
    }
    return state;
}

/* A slot that holds no set of this firmware needs no mark against it: nothing is written before it is erased. One that
 * holds such a set gets a mark first. */
static void test_only_a_set_of_ours_is_marked_before_its_erase(void)
{
    for (uint32_t update = 0; update < 3u; update++) {
        brace_parameters_t set;
        uint32_t steps_taken = 0;
        brace_parameters_default(&set);
        if (update == 0u) {
            TEST_ASSERT_EQUAL(BRACE_PARAMETERS_DEFAULT, brace_store_start(&store, &fake.hal, &set));
        }
        const uint32_t erases = fake.calls[BRACE_FAKE_NVM_ERASE], writes = fake.calls[BRACE_FAKE_NVM_WRITE];
        TEST_ASSERT_EQUAL(BRACE_OK, brace_store_offer(&store, &set));
        while (fake.calls[BRACE_FAKE_NVM_ERASE] == erases && steps_taken++ < 1000u) {
            TEST_ASSERT_EQUAL(BRACE_STORE_BUSY, brace_store_step(&store));
        }
        TEST_ASSERT_EQUAL(erases + 1u, fake.calls[BRACE_FAKE_NVM_ERASE]);
        TEST_ASSERT_EQUAL(update == 2u, fake.calls[BRACE_FAKE_NVM_WRITE] != writes);
        TEST_ASSERT_EQUAL(BRACE_STORE_DONE, steps(1000));
        TEST_ASSERT_EQUAL(BRACE_OK, brace_store_take(&store, &set, NULL));
    }
}

/* What has failed is forgotten when something else begins. */
static void test_a_failure_is_reported_until_the_next_request(void)
{
    brace_parameters_t set;
    brace_store_status_t status;
    (void)brace_store_start(&store, &fake.hal, &set);
    set.limb.femur_mm = -1.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_store_offer(&store, &set));
    TEST_ASSERT_EQUAL(BRACE_STORE_FAILED, steps(1000));
    brace_store_status(&store, &status);
    TEST_ASSERT_EQUAL(BRACE_STORE_E_REFUSED, status.failure);
    brace_parameters_default(&set);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_store_offer(&store, &set));
    for (int is_done = 0; is_done < 2; is_done++) {
        brace_store_status(&store, &status);
        TEST_ASSERT_EQUAL(BRACE_STORE_FINE, status.failure);
        TEST_ASSERT_EQUAL(BRACE_OK, status.refusal);
        TEST_ASSERT_EQUAL(BRACE_STORE_DONE, steps(1000));
    }
}

/* A slot holds a block's room and all its marks, to the last byte, and is written in units of 1, 2, 4 or 8 bytes. On
 * any other memory there is no store, and a request says so. */
static void test_a_memory_that_fits(void)
{
    static const struct {
        uint32_t slot_bytes, write_bytes;
        bool fits;
    } row[] = {{4096, 1, true},  {4096, 2, true},  {4096, 4, true},  {4096, 8, true},  {4095, 8, false},
               {3584, 8, false}, {4096, 0, false}, {4096, 3, false}, {4096, 16, false}};
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        brace_parameters_t set;
        brace_store_status_t status;
        fake.hal.nvm_shape.slot_bytes = row[i].slot_bytes;
        fake.hal.nvm_shape.write_bytes = row[i].write_bytes;
        TEST_ASSERT_EQUAL(BRACE_PARAMETERS_DEFAULT, brace_store_start(&store, &fake.hal, &set));
        brace_store_status(&store, &status);
        TEST_ASSERT_EQUAL(!row[i].fits, status.memory_fault);
        for (uint32_t slot = 0; slot < 2u; slot++) {
            TEST_ASSERT_EQUAL(row[i].fits ? BRACE_SLOT_EMPTY : BRACE_SLOT_UNREADABLE, status.slot[slot].condition);
        }
        TEST_ASSERT_EQUAL(BRACE_OK, brace_store_offer(&store, &set));
        brace_store_status(&store, &status);
        TEST_ASSERT_EQUAL(row[i].fits ? BRACE_STORE_FINE : BRACE_STORE_E_SHAPE, status.failure);
    }
}

/* After a roll-back the slot that was in force is void, as a start would find it, and there is no way back to it. */
static void test_what_a_roll_back_leaves(void)
{
    brace_parameters_t set;
    brace_store_status_t now, after_start;
    (void)brace_store_start(&store, &fake.hal, &set);
    for (int update = 0; update < 2; update++) {
        TEST_ASSERT_EQUAL(BRACE_OK, brace_store_offer(&store, &set));
        TEST_ASSERT_EQUAL(BRACE_STORE_DONE, steps(1000));
        TEST_ASSERT_EQUAL(BRACE_OK, brace_store_take(&store, &set, NULL));
    }
    brace_store_status(&store, &now);
    TEST_ASSERT_EQUAL(BRACE_PARAMETERS_SLOT_B, now.in_force);
    TEST_ASSERT_TRUE(now.can_roll_back);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_store_rollback(&store));
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, steps(1000));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_store_take(&store, &set, NULL));
    brace_store_status(&store, &now);
    (void)brace_store_start(&store, &fake.hal, &set);
    brace_store_status(&store, &after_start);
    TEST_ASSERT_EQUAL(BRACE_PARAMETERS_SLOT_A, now.in_force);
    TEST_ASSERT_FALSE(now.can_roll_back);
    TEST_ASSERT_EQUAL(BRACE_SLOT_VOID, now.slot[1].condition);
    for (uint32_t slot = 0; slot < 2u; slot++) {
        TEST_ASSERT_EQUAL(after_start.slot[slot].condition, now.slot[slot].condition);
        TEST_ASSERT_EQUAL_UINT32(after_start.slot[slot].sequence, now.slot[slot].sequence);
        TEST_ASSERT_EQUAL_HEX32(after_start.slot[slot].block_crc, now.slot[slot].block_crc);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_block_ends_before_the_marks);
    RUN_TEST(test_what_a_block_of_ours_reports);
    RUN_TEST(test_only_a_set_of_ours_is_marked_before_its_erase);
    RUN_TEST(test_a_memory_that_fits);
    RUN_TEST(test_what_a_roll_back_leaves);
    RUN_TEST(test_a_failure_is_reported_until_the_next_request);
    return UNITY_END();
}
