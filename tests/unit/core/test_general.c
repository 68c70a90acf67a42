#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "brace/general.h"
#include "reference_planar.h"
#include "sample_limbs.h"
#include "times.h"
#include "unity.h"

#define PI 3.14159265358979324

/* What the header promises. */
#define ERROR_LIMIT 2e-6
#define AXIS_LIMIT_RAD 1e-6
#define SLENDER 1e-3
#define SLENDER_LIMIT 2e-5

static brace_general_t general;
static uint64_t dice;

void setUp(void)
{
    memset(&general, 0, sizeof general);
    dice = 0x9e3779b97f4a7c15u;
}

void tearDown(void) {}

static float between(float low, float high)
{
    dice ^= dice << 13;
    dice ^= dice >> 7;
    dice ^= dice << 17;
    return low + (high - low) * (float)(dice >> 40) / 16777216.0f;
}

static bool one_in(int n)
{
    return between(0.0f, (float)n) < 1.0f;
}

static brace_status_t stiffness_of(const brace_limb_t *limb, float theta1, float theta2, brace_stiffness_t *k)
{
    const float hip = limb->joint[BRACE_FEMUR].compliance_rad_per_n_mm + limb->base.rotation_rad_per_n_mm;
    return brace_general_stiffness(&general, theta1, theta2, hip, limb->joint[BRACE_TIBIA].compliance_rad_per_n_mm, k);
}

static void judged_at(const brace_limb_t *limb, float theta1, float theta2, bool may_be_slender)
{
    const reference_planar_t r = reference_planar(limb, (double)theta1, (double)theta2);
    brace_stiffness_t k;
    TEST_ASSERT_EQUAL(BRACE_OK, stiffness_of(limb, theta1, theta2, &k));
    const double mean = 0.5 * (r.c_xx + r.c_zz), det = r.c_xx * r.c_zz - r.c_xz * r.c_xz;
    if (may_be_slender && det < SLENDER * mean * mean) {
        TEST_ASSERT_DOUBLE_WITHIN(k.flags == 0u ? SLENDER_LIMIT : 1.0, 0.0, reference_error(&r, &k));
        return;
    }
    TEST_ASSERT_EQUAL(0, k.flags);
    TEST_ASSERT_DOUBLE_WITHIN(ERROR_LIMIT, 0.0, reference_error(&r, &k));
    TEST_ASSERT_DOUBLE_WITHIN(AXIS_LIMIT_RAD, 0.0, reference_axis_error(&r, &k));
}

static void over_the_workspace(const brace_limb_t *limb)
{
    brace_general_collapse(limb, &general);
    for (int i = -8; i <= 8; i++) {
        for (int j = -16; j <= 16; j++) {
            judged_at(limb, (float)(i * PI / 8.0), (float)(j * PI / 16.0 + 1e-3 * (j % 3)), false);
        }
    }
}

static void test_every_sample_over_the_workspace(void)
{
    for (int sample = 0; sample < SAMPLE_COUNT; sample++) {
        over_the_workspace(&sample_limb[sample]);
        brace_limb_t limb = sample_limb[sample];
        limb.base = (brace_base_t){0.03f, 0.002f, 3e-6f};
        over_the_workspace(&limb);
        limb.base = (brace_base_t){0.0f, 0.04f, 0.0f};
        over_the_workspace(&limb);
    }
}

static brace_limb_t random_limb(void)
{
    brace_limb_t limb = {.femur_mm = between(40.0f, 400.0f)};
    limb.tibia_mm = one_in(3) ? limb.femur_mm : between(40.0f, 500.0f);
    for (int i = BRACE_FEMUR; i <= BRACE_TIBIA; i++) {
        limb.link[i].axial_mm_per_n = one_in(5) ? 0.0f : between(1e-4f, 5e-3f);
        limb.link[i].bending_mm_per_n = one_in(5) ? 0.0f : between(1e-3f, 0.4f);
        limb.link[i].tilt_rad = one_in(2) ? 0.0f : between(-1.5f, 1.5f);
        limb.joint[i].compliance_rad_per_n_mm = one_in(4) ? 0.0f : between(1e-7f, 6e-5f);
    }
    limb.link[BRACE_FEMUR].moment_transfer = one_in(2) ? 0.0f : between(0.0f, 1.0f);
    if (one_in(2)) {
        limb.base = (brace_base_t){between(0.0f, 0.1f), between(0.0f, 0.1f), between(0.0f, 1e-5f)};
    }
    return limb;
}

static void test_random_limbs(void)
{
    int judged = 0;
    while (judged < 2000 * TIMES) {
        const brace_limb_t limb = random_limb();
        if (brace_limb_check(&limb) != BRACE_OK ||
            limb.link[BRACE_FEMUR].bending_mm_per_n + limb.link[BRACE_TIBIA].bending_mm_per_n < 1e-3f) {
            continue;
        }
        brace_general_collapse(&limb, &general);
        for (int i = 0; i < 20; i++, judged++) {
            const float theta2 = one_in(4)   ? between(-0.02f, 0.02f)
                                 : one_in(4) ? between(3.12f, 3.16f)
                                             : between(-3.9f, 3.9f);
            judged_at(&limb, between(-3.9f, 3.9f), theta2, true);
        }
    }
}

/* The springs are those of the moment, not of the limb that was collapsed. */
static void test_springs_of_the_moment(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_TILTED];
    brace_general_collapse(&limb, &general);
    for (int i = 0; i < 200; i++) {
        limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = between(0.0f, 1e-4f);
        limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = between(0.0f, 1e-4f);
        judged_at(&limb, between(-2.0f, 2.0f), between(-2.5f, 2.5f), false);
    }
}

static void test_springs_alone_are_singular_when_straight(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_PAPER];
    brace_stiffness_t k, before;
    memset(limb.link, 0, sizeof limb.link);
    memset(&k, 0x5a, sizeof k);
    before = k;
    brace_general_collapse(&limb, &general);
    TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, stiffness_of(&limb, 0.3f, 0.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, stiffness_of(&limb, 0.3f, 1e-7f, &k)); /* noise, not yield */
    TEST_ASSERT_EQUAL_MEMORY(&before, &k, sizeof k);
    TEST_ASSERT_EQUAL(BRACE_OK, stiffness_of(&limb, 0.3f, 1e-3f, &k));
    TEST_ASSERT_EQUAL(BRACE_FLAG_NEAR_SINGULAR, k.flags);
    TEST_ASSERT_EQUAL(BRACE_OK, stiffness_of(&limb, 0.3f, 0.5f, &k));
    TEST_ASSERT_EQUAL(0, k.flags);
}

static void test_what_is_refused_leaves_the_output_alone(void)
{
    brace_stiffness_t k, before;
    memset(&k, 0x5a, sizeof k);
    before = k;
    const brace_limb_t *limb = &sample_limb[SAMPLE_PAPER];
    brace_general_collapse(limb, &general);
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, stiffness_of(limb, 0.0f, 6.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, stiffness_of(limb, 1e6f, 0.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, stiffness_of(limb, NAN, 1.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, stiffness_of(limb, 0.0f, -INFINITY, &k));
    TEST_ASSERT_EQUAL_MEMORY(&before, &k, sizeof k);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_sample_over_the_workspace);
    RUN_TEST(test_random_limbs);
    RUN_TEST(test_springs_of_the_moment);
    RUN_TEST(test_springs_alone_are_singular_when_straight);
    RUN_TEST(test_what_is_refused_leaves_the_output_alone);
    return UNITY_END();
}
