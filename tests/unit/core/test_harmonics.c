#include <math.h>

#include "chain/elements.h"
#include "chain/harmonics.h"
#include "reference_planar.h"
#include "sample_limbs.h"
#include "unity.h"

#define PI 3.14159265358979324

/* An emulated board has to show that its arithmetic agrees; a host tries more limbs. */
#ifdef __arm__
enum { LIMBS = 10 };
#else
enum { LIMBS = 500 };
#endif

void setUp(void) {}

void tearDown(void) {}

static double at(const brace_harmonic_t *h, double half)
{
    const double c = cos(half), s = sin(half);
    return (double)h->at_fold + (double)h->per_cos2 * c * c + (double)h->per_sincos * s * c;
}

/* What every direction yields is in the reference and not in the harmonics: C + iso I has the mean plus iso, and
 * det (C + iso I) = det C + 2 iso mean + iso^2. The base yields equally in both directions. */
static void expect_the_sum(const brace_limb_t *limb)
{
    brace_element_t element[BRACE_ELEMENT_COUNT];
    brace_harmonics_t h;
    const double iso = (double)brace_elements_of_limb(limb, element) + (double)limb->base.x_mm_per_n;
    brace_harmonics_of(element, &h);
    for (int j = -20; j <= 20; j++) {
        const double theta1 = 0.4, knee = j * PI / 20.0, half = 0.5 * knee, turn = 2.0 * theta1 - knee;
        const reference_planar_t r = reference_planar(limb, theta1, knee);
        const double mean = at(&h.mean, half), x = at(&h.dev_x, half), z = at(&h.dev_z, half);
        const double rest = at(&h.rest, half), cross = at(&h.cross, half);
        const double det = r.c_xx * r.c_zz - r.c_xz * r.c_xz, scale = mean + iso;
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * scale, 0.5 * (r.c_xx + r.c_zz), mean + iso);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * scale, 0.5 * (r.c_xx - r.c_zz), x * cos(turn) - z * sin(turn));
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * scale, r.c_xz, x * sin(turn) + z * cos(turn));
        TEST_ASSERT_DOUBLE_WITHIN(3e-6 * det, det, rest + cross * cross + iso * (2.0 * mean + iso));
        TEST_ASSERT_TRUE(rest > -1e-7 * det);
    }
}

static void test_harmonics_say_what_the_sum_says(void)
{
    for (int sample = 0; sample < SAMPLE_COUNT; sample++) {
        expect_the_sum(&sample_limb[sample]);
    }
}

static uint32_t state = 3u;

/* Any number of a range, each size as likely as another. */
static float any(double least, double most)
{
    state = state * 1664525u + 1013904223u;
    return (float)(least * pow(most / least, (double)(state >> 8) / 16777216.0));
}

static void test_of_any_limb(void)
{
    for (int i = 0; i < LIMBS; i++) {
        brace_limb_t limb = sample_limb[SAMPLE_PAPER];
        limb.femur_mm = any(50, 400), limb.tibia_mm = any(50, 400);
        for (int link = BRACE_FEMUR; link <= BRACE_TIBIA; link++) {
            limb.link[link] = (brace_link_t){.axial_mm_per_n = any(1e-4, 1),
                                             .bending_mm_per_n = any(1e-4, 1),
                                             .tilt_rad = any(0.1, 1.0) - 0.3f,
                                             .moment_transfer = any(0.1, 1)};
            limb.joint[link].compliance_rad_per_n_mm = any(1e-8, 1e-4);
        }
        limb.base = (brace_base_t){0, 0, any(1e-8, 1e-5)};
        expect_the_sum(&limb);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_harmonics_say_what_the_sum_says);
    RUN_TEST(test_of_any_limb);
    return UNITY_END();
}
