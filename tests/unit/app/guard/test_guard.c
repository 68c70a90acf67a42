/* The sums over what must not change: every single bit that flips is found within one round, and nothing else is. */
#include <string.h>

#include "guard/guard.h"
#include "unity.h"

enum { SPANS = 3, WORDS_MOST = 7 };

static uint32_t memory[SPANS][WORDS_MOST];
static const uint32_t words_in[SPANS] = {5, 1, 7};
static guard_t guard;

static guard_span_t span_of(uint32_t index)
{
    return (guard_span_t){memory[index], words_in[index]};
}

void setUp(void)
{
    memset(&guard, 0, sizeof guard);
    for (uint32_t i = 0; i < SPANS; i++) {
        for (uint32_t w = 0; w < WORDS_MOST; w++) {
            memory[i][w] = 0x9e3779b9u * (7u * i + w + 1u);
        }
        const guard_span_t span = span_of(i);
        guard_take(&guard, i, &span);
    }
}

void tearDown(void) {}

/* returns how many steps said that something is wrong */
static int wrong_in(int steps, uint32_t words_most)
{
    int wrong = 0;
    for (int i = 0; i < steps; i++) {
        const guard_span_t span = span_of(guard.span);
        wrong += guard_step(&guard, &span, SPANS, words_most) ? 0 : 1;
    }
    return wrong;
}

/* Steps of a round: as many as the spans' slices. */
static int round_of(uint32_t words_most)
{
    uint32_t steps = 0;
    for (int i = 0; i < SPANS; i++) {
        steps += (words_in[i] + words_most - 1u) / words_most;
    }
    return (int)steps;
}

static void test_every_bit_that_flips_is_found_once_a_round(void)
{
    for (uint32_t words_most = 1; words_most <= 8u; words_most++) {
        const int round = round_of(words_most);
        TEST_ASSERT_EQUAL(0, wrong_in(3 * round, words_most));
        TEST_ASSERT_EQUAL_UINT32(0u, guard.span);
        TEST_ASSERT_EQUAL_UINT32(0u, guard.word);
        for (uint32_t i = 0; i < SPANS; i++) {
            for (uint32_t bit = 0; bit < 32u * words_in[i]; bit++) {
                memory[i][bit / 32u] ^= 1u << bit % 32u;
                TEST_ASSERT_EQUAL(2, wrong_in(2 * round, words_most));
                memory[i][bit / 32u] ^= 1u << bit % 32u;
                TEST_ASSERT_EQUAL(0, wrong_in(round, words_most));
            }
        }
    }
}

/* A span that is made anew while its sum is worked out is looked over from its beginning; another one does not disturb
 * that. */
static void test_what_is_made_anew_is_right(void)
{
    for (uint32_t changed = 0; changed < SPANS; changed++) {
        for (uint32_t word = 0; word < words_in[changed]; word++) {
            for (int at = 0; at < round_of(2); at++) {
                TEST_ASSERT_EQUAL(0, wrong_in(1, 2));
                memory[changed][word] += 12345u;
                const guard_span_t span = span_of(changed);
                guard_take(&guard, changed, &span);
                TEST_ASSERT_EQUAL(0, wrong_in(2 * round_of(2), 2));
            }
        }
    }
}

/* Spans that change again and again do not hold up the look at the others. */
static void test_another_span_made_anew_leaves_the_look_where_it_is(void)
{
    for (uint32_t changed = 1; changed < SPANS; changed++) {
        setUp();
        for (uint32_t word = 0; word < words_in[0]; word++) {
            TEST_ASSERT_EQUAL_UINT32(0u, guard.span);
            TEST_ASSERT_EQUAL_UINT32(word, guard.word);
            TEST_ASSERT_EQUAL(0, wrong_in(1, 1));
            const guard_span_t span = span_of(changed);
            guard_take(&guard, changed, &span);
        }
        TEST_ASSERT_EQUAL_UINT32(1u, guard.span);
    }
}

/* The bytes behind a span do not belong to it. */
static void test_words_behind_a_span_do_not_count(void)
{
    memory[1][1] ^= 1u;
    memory[0][5] ^= 1u;
    TEST_ASSERT_EQUAL(0, wrong_in(3 * round_of(3), 3));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_bit_that_flips_is_found_once_a_round);
    RUN_TEST(test_what_is_made_anew_is_right);
    RUN_TEST(test_another_span_made_anew_leaves_the_look_where_it_is);
    RUN_TEST(test_words_behind_a_span_do_not_count);
    return UNITY_END();
}
