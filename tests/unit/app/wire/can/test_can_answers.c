/* Answers that wait to leave: in order, round the ring, to its last place, and no further. */
#include "wire/can/answers.h"

#include <string.h>

#include "brace/answering.h"
#include "brace/can_messages.h"
#include "unity.h"

static can_answers_t answers;

void setUp(void)
{
    memset(&answers, 0, sizeof answers);
}

void tearDown(void) {}

static void add(uint32_t first, uint32_t count)
{
    uint8_t parts[BRACE_CAN_ANSWER_PARTS_MOST][8];
    for (uint32_t i = 0; i < count; i++) {
        memset(parts[i], (int)(first + i), 8);
    }
    can_answers_add(&answers, parts, count);
}

static void leaves(uint32_t wanted)
{
    const uint8_t *next = can_answers_next(&answers);
    TEST_ASSERT_NOT_NULL(next);
    for (int i = 0; i < 8; i++) {
        TEST_ASSERT_EQUAL(wanted, next[i]);
    }
    can_answers_sent(&answers);
}

static void test_there_is_room_to_the_last_place(void)
{
    for (uint32_t count = 0; count < (uint32_t)CAN_ANSWERS_ROOM; count++) {
        for (uint32_t more = 0; more <= (uint32_t)CAN_ANSWERS_ROOM + 1u; more++) {
            TEST_ASSERT_EQUAL(count + more <= (uint32_t)CAN_ANSWERS_ROOM, can_answers_have_room(&answers, more));
        }
        add(count, 1);
    }
    TEST_ASSERT_TRUE(can_answers_have_room(&answers, 0));
    TEST_ASSERT_FALSE(can_answers_have_room(&answers, 1));
    add(99, 1); /* who does not ask for room takes the last place, and none beyond it */
    TEST_ASSERT_EQUAL(CAN_ANSWERS_ROOM, answers.count);
    for (uint32_t i = 0; i + 1u < (uint32_t)CAN_ANSWERS_ROOM; i++) {
        leaves(i);
    }
    leaves(99);
    TEST_ASSERT_NULL(can_answers_next(&answers));
}

static void test_they_leave_in_order_round_the_ring(void)
{
    uint32_t next_in = 0, next_out = 0;
    for (int round = 0; round < 60; round++) {
        const uint32_t count = 1u + (uint32_t)round % 3u;
        add(next_in, count);
        next_in += count;
        while (next_out + 2u < next_in) {
            leaves(next_out & 0xffu);
            next_out++;
        }
    }
    while (next_out < next_in) {
        leaves(next_out & 0xffu);
        next_out++;
    }
    can_answers_sent(&answers); /* nothing more to send */
    TEST_ASSERT_EQUAL(0, answers.count);
    TEST_ASSERT_NULL(can_answers_next(&answers));
}

static void test_a_refusal_says_of_which_request_and_why(void)
{
    brace_can_refusal_t refusal;
    can_answers_refuse(&answers, BRACE_REQUEST_TAKE_UP, 0x5a, -7, 123);
    const uint8_t *next = can_answers_next(&answers);
    TEST_ASSERT_EQUAL_HEX8(BRACE_ANSWER_REFUSED, next[0]);
    brace_can_unpack_refusal(next, &refusal);
    TEST_ASSERT_EQUAL_HEX8(0x5a, refusal.token);
    TEST_ASSERT_EQUAL(BRACE_REQUEST_TAKE_UP, refusal.code);
    TEST_ASSERT_EQUAL(-7, refusal.status);
    TEST_ASSERT_EQUAL(123, refusal.detail);
    can_answers_sent(&answers);
    can_answers_refuse(&answers, 255, 1, -1, 0); /* of a code that is none */
    brace_can_unpack_refusal(can_answers_next(&answers), &refusal);
    TEST_ASSERT_EQUAL(255, refusal.code);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_there_is_room_to_the_last_place);
    RUN_TEST(test_they_leave_in_order_round_the_ring);
    RUN_TEST(test_a_refusal_says_of_which_request_and_why);
    return UNITY_END();
}
