#include <math.h>
#include <string.h>

#include "brace/chain_batch.h"
#include "sample_limbs.h"
#include "unity.h"

#define PI 3.14159265358979324

enum { COUNT = 700, K_COLUMNS = 6, COLUMNS = 9 };

static float theta1[COUNT], theta2[COUNT], column[COLUMNS][COUNT];
static uint32_t flags[COUNT];
static brace_chain_t chain;

static const brace_stiffness_soa_t k_columns = {column[0], column[1], column[2], column[3], column[4], column[5]};
static const brace_compliance_soa_t c_columns = {column[6], column[7], column[8]};

void setUp(void)
{
    memset(column, 0x5a, sizeof column);
    memset(flags, 0x5a, sizeof flags);
    for (int i = 0; i < COUNT; i++) {
        theta1[i] = (float)(PI * sin(0.7 * i));
        theta2[i] = (float)(PI * sin(0.31 * i));
    }
}

void tearDown(void) {}

/* Bits, not values: -0 is not 0 here. */
static void same_bits(float expected, float found)
{
    TEST_ASSERT_EQUAL_MEMORY(&expected, &found, sizeof expected);
}

static void nowhere(int first, int end, int i)
{
    for (int j = first; j < end; j++) {
        TEST_ASSERT_FLOAT_IS_NAN(column[j][i]);
    }
}

static void as_one_by_one(const brace_limb_t *limb)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_build(limb, &chain));
    size_t refused = 0;
    const size_t said = brace_chain_batch(&chain, COUNT, theta1, theta2, &k_columns, &c_columns, flags);
    for (int i = 0; i < COUNT; i++) {
        brace_stiffness_t k;
        brace_compliance_t c;
        if (brace_chain_compliance(&chain, theta1[i], theta2[i], &c, NULL) == BRACE_OK) {
            same_bits(c.c_xx_mm_per_n, column[6][i]);
            same_bits(c.c_xz_mm_per_n, column[7][i]);
            same_bits(c.c_zz_mm_per_n, column[8][i]);
        } else {
            nowhere(K_COLUMNS, COLUMNS, i);
        }
        if (brace_chain_stiffness(&chain, theta1[i], theta2[i], &k) != BRACE_OK) {
            refused++;
            nowhere(0, K_COLUMNS, i);
            TEST_ASSERT_EQUAL(0, flags[i]);
            continue;
        }
        same_bits(k.k_xx_n_per_mm, column[0][i]);
        same_bits(k.k_xz_n_per_mm, column[1][i]);
        same_bits(k.k_zz_n_per_mm, column[2][i]);
        same_bits(k.lambda_min_n_per_mm, column[3][i]);
        same_bits(k.lambda_max_n_per_mm, column[4][i]);
        same_bits(k.stiff_axis_rad, column[5][i]);
        TEST_ASSERT_EQUAL(k.flags, flags[i]);
    }
    TEST_ASSERT_EQUAL(refused, said);
}

static void test_every_sample_on_a_base_that_yields_unequally(void)
{
    for (int sample = 0; sample < SAMPLE_COUNT; sample++) {
        brace_limb_t limb = sample_limb[sample];
        limb.base = (brace_base_t){0.03f, 0.002f, 3e-6f};
        as_one_by_one(&limb);
    }
}

static void test_refused_postures_are_counted_and_marked(void)
{
    theta2[3] = 6.0f;
    theta1[COUNT - 1] = NAN;
    theta1[COUNT / 2] = INFINITY;
    as_one_by_one(&sample_limb[SAMPLE_TILTED]);
    TEST_ASSERT_EQUAL(3, brace_chain_batch(&chain, COUNT, theta1, theta2, &k_columns, NULL, NULL));
}

static void test_singular_postures_and_their_neighbours(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_PAPER];
    memset(limb.link, 0, sizeof limb.link); /* springs alone: no K when straight, a flagged one next to it */
    theta1[0] = 0.3f;
    theta2[0] = 0.0f;
    theta1[1] = 0.3f;
    theta2[1] = 1e-3f;
    as_one_by_one(&limb);
    TEST_ASSERT_FLOAT_IS_NAN(column[0][0]);
    TEST_ASSERT_TRUE(column[K_COLUMNS][0] > 0.0f);
    TEST_ASSERT_EQUAL(BRACE_FLAG_NEAR_SINGULAR, flags[1]);
}

static void test_what_is_not_wanted_is_not_written(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_build(&sample_limb[SAMPLE_PAPER], &chain));
    const float c_before = column[K_COLUMNS][0];
    const float beyond_before = column[0][10];
    const uint32_t flags_before = flags[0];
    TEST_ASSERT_EQUAL(0, brace_chain_batch(&chain, 10, theta1, theta2, &k_columns, NULL, NULL));
    same_bits(c_before, column[K_COLUMNS][0]);
    same_bits(beyond_before, column[0][10]);
    TEST_ASSERT_EQUAL(flags_before, flags[0]);
    TEST_ASSERT_EQUAL(0, brace_chain_batch(&chain, 0, theta1, theta2, &k_columns, &c_columns, flags));
    TEST_ASSERT_EQUAL(flags_before, flags[0]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_sample_on_a_base_that_yields_unequally);
    RUN_TEST(test_refused_postures_are_counted_and_marked);
    RUN_TEST(test_singular_postures_and_their_neighbours);
    RUN_TEST(test_what_is_not_wanted_is_not_written);
    return UNITY_END();
}
