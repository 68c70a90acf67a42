#include <math.h>
#include <string.h>

#include "brace/chain.h"
#include "reference_planar.h"
#include "sample_limbs.h"
#include "unity.h"

#define PI 3.14159265358979324

/* Half of what the header promises; the sweeps found 1e-6 at the worst of hundreds of limbs. */
#define ERROR_LIMIT 1e-6
#define AXIS_LIMIT_RAD 5e-7

static brace_chain_t chain;

void setUp(void)
{
    memset(&chain, 0, sizeof chain);
}

void tearDown(void) {}

static brace_limb_t on_a_yielding_base(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_TILTED];
    limb.base = (brace_base_t){0.03f, 0.002f, 3e-6f};
    return limb;
}

static void against_reference(const brace_limb_t *limb)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_build(limb, &chain));
    for (int i = -8; i <= 8; i++) {
        for (int j = -16; j <= 16; j++) {
            const float theta1 = (float)(i * PI / 8.0), theta2 = (float)(j * PI / 16.0 + 1e-3 * (j % 3));
            const reference_planar_t r = reference_planar(limb, (double)theta1, (double)theta2);
            brace_stiffness_t k;
            TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_stiffness(&chain, theta1, theta2, &k));
            TEST_ASSERT_EQUAL(0, k.flags);
            TEST_ASSERT_DOUBLE_WITHIN(ERROR_LIMIT, 0.0, reference_error(&r, &k));
            TEST_ASSERT_DOUBLE_WITHIN(AXIS_LIMIT_RAD, 0.0, reference_axis_error(&r, &k));

            brace_compliance_t c;
            float det;
            TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_compliance(&chain, theta1, theta2, &c, &det));
            const double scale = r.c_xx + r.c_zz;
            TEST_ASSERT_DOUBLE_WITHIN(ERROR_LIMIT * scale, r.c_xx, (double)c.c_xx_mm_per_n);
            TEST_ASSERT_DOUBLE_WITHIN(ERROR_LIMIT * scale, r.c_xz, (double)c.c_xz_mm_per_n);
            TEST_ASSERT_DOUBLE_WITHIN(ERROR_LIMIT * scale, r.c_zz, (double)c.c_zz_mm_per_n);
            TEST_ASSERT_DOUBLE_WITHIN(2.0 * ERROR_LIMIT, 1.0, (double)det / (r.c_xx * r.c_zz - r.c_xz * r.c_xz));
        }
    }
}

static void test_every_sample_over_the_workspace(void)
{
    for (int sample = 0; sample < SAMPLE_COUNT; sample++) {
        against_reference(&sample_limb[sample]);
    }
}

static void test_a_base_that_yields_unequally(void)
{
    const brace_limb_t limb = on_a_yielding_base();
    against_reference(&limb);
}

static void test_check_value_of_the_physics_page(void)
{
    brace_stiffness_t k;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_build(&sample_limb[SAMPLE_PAPER], &chain));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_stiffness(&chain, 1.0f, 1.4f, &k));
    TEST_ASSERT_FLOAT_WITHIN(4e-6f, 3.96389818f, k.k_xx_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(4e-6f, -0.63872477f, k.k_xz_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(4e-6f, 0.42806022f, k.k_zz_n_per_mm);
}

static void test_springs_alone_are_singular_when_straight(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_PAPER];
    brace_stiffness_t k, before;
    memset(limb.link, 0, sizeof limb.link);
    memset(&k, 0x5a, sizeof k);
    before = k;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_build(&limb, &chain));
    TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, brace_chain_stiffness(&chain, 0.3f, 0.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, brace_chain_stiffness(&chain, 0.3f, 1e-7f, &k)); /* noise, not yield */
    TEST_ASSERT_EQUAL_MEMORY(&before, &k, sizeof k);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_stiffness(&chain, 0.3f, 1e-3f, &k));
    TEST_ASSERT_EQUAL(BRACE_FLAG_NEAR_SINGULAR, k.flags);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_stiffness(&chain, 0.3f, 0.5f, &k));
    TEST_ASSERT_EQUAL(0, k.flags);
}

static void test_what_is_refused_leaves_outputs_alone(void)
{
    brace_stiffness_t k, k_before;
    brace_compliance_t c, c_before;
    float det = -1.0f;
    brace_limb_t broken = sample_limb[SAMPLE_PAPER];
    broken.femur_mm = 0.0f;
    memset(&chain, 0x5a, sizeof chain);
    const brace_chain_t chain_before = chain;
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_chain_build(&broken, &chain));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_chain_build(NULL, &chain));
    TEST_ASSERT_EQUAL_MEMORY(&chain_before, &chain, sizeof chain);
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_chain_build(&broken, NULL));

    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_build(&sample_limb[SAMPLE_PAPER], &chain));
    memset(&k, 0x5a, sizeof k);
    memset(&c, 0x5a, sizeof c);
    k_before = k;
    c_before = c;
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_chain_stiffness(NULL, 0.0f, 1.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_chain_stiffness(&chain, 0.0f, 1.0f, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_chain_stiffness(&chain, 0.0f, 6.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_chain_stiffness(&chain, 1e6f, 0.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, brace_chain_stiffness(&chain, NAN, 1.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, brace_chain_stiffness(&chain, 0.0f, -INFINITY, &k));
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, brace_chain_compliance(&chain, 0.0f, NAN, &c, &det));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_chain_compliance(&chain, 0.0f, 1.0f, NULL, &det));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_chain_compliance(NULL, 0.0f, 1.0f, &c, &det));
    TEST_ASSERT_EQUAL_MEMORY(&k_before, &k, sizeof k);
    TEST_ASSERT_EQUAL_MEMORY(&c_before, &c, sizeof c);
    TEST_ASSERT_EQUAL_FLOAT(-1.0f, det);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_sample_over_the_workspace);
    RUN_TEST(test_a_base_that_yields_unequally);
    RUN_TEST(test_check_value_of_the_physics_page);
    RUN_TEST(test_springs_alone_are_singular_when_straight);
    RUN_TEST(test_what_is_refused_leaves_outputs_alone);
    return UNITY_END();
}
