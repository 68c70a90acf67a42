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

/* Of a block of ours everything is told, whether it counts or not. */
static void test_what_a_block_of_ours_tells(void)
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
        const brace_slot_report_t *told = &status.slot[slot];
        TEST_ASSERT_EQUAL(BRACE_SLOT_NOT_COMMITTED, told->condition);
        TEST_ASSERT_EQUAL_HEX32(BRACE_SCHEMA_HASH, told->schema_hash);
        TEST_ASSERT_EQUAL_UINT32(9 + slot, told->sequence);
        TEST_ASSERT_EQUAL_HEX32(crc, told->block_crc);
        TEST_ASSERT_EQUAL_UINT32(0, told->wrong_index);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_block_ends_before_the_marks);
    RUN_TEST(test_what_a_block_of_ours_tells);
    return UNITY_END();
}
