/* The integers of a limb under load: the last look at what has been collapsed, and what levers and C do at the edges of
 * their words. */
#include <math.h>
#include <string.h>

#include "brace/loaded_fixed.h"
#include "loaded/fixed_compliance.h"
#include "loaded/fixed_units.h"
#include "sample_limbs.h"
#include "unity.h"

#ifdef __arm__
enum { LIMBS = 500 };
#else
enum { LIMBS = 100000 };
#endif

static brace_limb_t limb;
static brace_gravity_t weights;
static uint32_t state;

void setUp(void)
{
    limb = sample_limb[SAMPLE_PAPER];
    weights = (brace_gravity_t){.femur_n = 2.0f, .knee_n = 1.0f, .tibia_n = 1.5f};
    state = 4711u;
}

void tearDown(void) {}

static float any(float least, float most)
{
    state = state * 1664525u + 1013904223u;
    return least + (most - least) * ((float)(state >> 8) / 16777216.0f);
}

/* Over powers of ten from `least` to `most`, or one of the ends, or `edge`. */
static float any_size(float least_log10, float most_log10, float edge)
{
    const int kind = (int)any(0.0f, 8.0f);
    return kind == 0 ? edge : powf(10.0f, kind == 1 ? most_log10 : any(least_log10, most_log10));
}

static void any_limb(void)
{
    limb.femur_mm = any_size(0.0f, 4.0f, 1.0f), limb.tibia_mm = any_size(0.0f, 4.0f, 1.0f);
    for (int i = BRACE_FEMUR; i <= BRACE_TIBIA; i++) {
        const float tilt = any(0.0f, 1.0f) < 0.3f ? copysignf(1.5707963f, any(-1.0f, 1.0f)) : any(-1.57f, 1.57f);
        limb.link[i] = (brace_link_t){.axial_mm_per_n = any_size(-6.0f, 3.0f, 0.0f),
                                      .bending_mm_per_n = any_size(-6.0f, 3.0f, 0.0f),
                                      .tilt_rad = tilt,
                                      .moment_transfer = any_size(-2.0f, 0.0f, 0.0f)};
    }
    limb.base = (brace_base_t){any_size(-6.0f, 3.0f, 0.0f), any_size(-6.0f, 3.0f, 0.0f), any_size(-12.0f, 0.0f, 0.0f)};
    weights = (brace_gravity_t){.femur_n = any_size(-3.0f, 6.0f, 0.0f),
                                .knee_n = any_size(-3.0f, 6.0f, 0.0f),
                                .tibia_n = any_size(-3.0f, 6.0f, 0.0f)};
}

/* Parameters anywhere in their ranges, and at the ends of them. */
static void test_every_limb_passes_the_last_look(void)
{
    for (int i = 0; i < LIMBS; i++) {
        brace_loaded_t loaded;
        brace_loaded_fixed_t fixed;
        any_limb();
        brace_loaded_collapse(&limb, &weights, &loaded);
        brace_loaded_fixed_collapse(&loaded, &fixed);
        TEST_ASSERT_TRUE(is_within_units(&fixed));
    }
}

static brace_status_t status_of(const brace_loaded_t *loaded)
{
    const brace_load_t load = {
        .tip = {3.0f, 5.0f}, .down = {0.0f, -1.0f}, .hip = {1e-5f, 1e-5f}, .knee = {1e-5f, 1e-5f}};
    brace_loaded_fixed_t fixed;
    brace_loaded_stiffness_t result;
    brace_loaded_fixed_collapse(loaded, &fixed);
    return brace_loaded_fixed_stiffness(&fixed, 1.0f, 1.4f, &load, &result);
}

/* One number at a time is none, is without end, or belies the others. */
static void test_what_is_no_limb_takes_no_load(void)
{
    brace_loaded_t sound, loaded;
    brace_loaded_collapse(&limb, &weights, &sound);
    TEST_ASSERT_EQUAL(BRACE_OK, status_of(&sound));
    float *const number[] = {&loaded.femur.length_mm,
                             &loaded.tibia.length_mm,
                             &loaded.femur.beam_mm.x,
                             &loaded.tibia.beam_mm.z,
                             &loaded.femur.to_beam_mm.z,
                             &loaded.femur.root_root.x,
                             &loaded.tibia.end_root.z,
                             &loaded.femur.end_mm_per_n,
                             &loaded.femur.bend_rad_per_n_mm,
                             &loaded.femur.weight_n,
                             &loaded.tibia.weight_n,
                             &loaded.knee_n,
                             &loaded.weight_n,
                             &loaded.base_mm_per_n,
                             &loaded.base_root.x,
                             &loaded.base_rotation_rad_per_n_mm};
    for (uint32_t i = 0; i < sizeof number / sizeof *number; i++) {
        loaded = sound;
        *number[i] = NAN;
        TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, status_of(&loaded));
        loaded = sound;
        *number[i] = INFINITY;
        TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, status_of(&loaded));
        loaded = sound;
        *number[i] = -INFINITY;
        TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, status_of(&loaded));
    }
    float *const too_large[] = {&loaded.femur.beam_mm.x, &loaded.femur.to_beam_mm.z, &loaded.femur.weight_n,
                                &loaded.tibia.weight_n, &loaded.knee_n};
    for (uint32_t i = 0; i < sizeof too_large / sizeof *too_large; i++) {
        loaded = sound;
        *too_large[i] = *too_large[i] * 2.0f + 1000.0f;
        TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, status_of(&loaded));
    }
}

/* Each word is within its bounds alone: the least and the most are kept, what lies beyond is not. */
static void test_each_word_is_looked_at(void)
{
    brace_loaded_t loaded;
    brace_loaded_fixed_t fixed;
    brace_loaded_collapse(&limb, &weights, &loaded);
    brace_loaded_fixed_collapse(&loaded, &fixed);
    TEST_ASSERT_TRUE(is_within_units(&fixed));
    const struct {
        int32_t *exponent, least, most;
    } bound[] = {{&fixed.length_exponent, UNIT_LENGTH_EXPONENT_LEAST, UNIT_LENGTH_EXPONENT_MOST},
                 {&fixed.bend_exponent, UNIT_EXPONENT_LEAST, UNIT_EXPONENT_MOST},
                 {&fixed.spring_exponent, UNIT_EXPONENT_LEAST, UNIT_EXPONENT_MOST},
                 {&fixed.weight_exponent, UNIT_EXPONENT_LEAST, fixed.weight_exponent}}; /* as the weight is */
    for (uint32_t i = 0; i < sizeof bound / sizeof *bound; i++) {
        const int32_t was = *bound[i].exponent;
        const int32_t tried[] = {bound[i].least - 1, bound[i].least, bound[i].most, bound[i].most + 1};
        for (int t = i == 3u ? 2 : 0; t < 4; t++) {
            *bound[i].exponent = tried[t];
            TEST_ASSERT_EQUAL(t == 1 || t == 2, is_within_units(&fixed));
        }
        *bound[i].exponent = was;
    }
    int32_t *const from_0[] = {&fixed.femur.length_q28, &fixed.femur.bend_q31,   &fixed.femur.end_q31,
                               &fixed.tibia.length_q28, &fixed.tibia.bend_q31,   &fixed.tibia.end_q31,
                               &fixed.base_q31,         &fixed.base_rotation_q31};
    for (uint32_t i = 0; i < sizeof from_0 / sizeof *from_0; i++) {
        const int32_t was = *from_0[i];
        *from_0[i] = -1;
        TEST_ASSERT_FALSE(is_within_units(&fixed));
        *from_0[i] = was;
    }
    TEST_ASSERT_TRUE(is_within_units(&fixed));
}

static int32_t q28(double number)
{
    return (int32_t)(number * 0x1p28);
}

/* A lever fits up to 8 units, whatever it was made of. */
static void test_a_lever_beyond_its_word_is_noted(void)
{
    static const struct {
        double lever, other, ratio;
        bool fits;
    } row[] = {{7.0, 1.0, -0.999, true}, {7.0, 1.0, -1.001, false}, {-7.0, 1.0, 0.999, true}, {-7.0, 1.0, 1.001, false},
               {5.0, 3.9, 3.3, true},    {-4.1, 3.9, 1.1, false},   {0.0, 4.5, 1.7, true},    {0.0, 4.5, 1.8, false},
               {7.9, 7.9, -3.99, false}, {-7.9, 7.9, 3.99, false}};
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        const fixed_vec_t lever = {q28(row[i].lever), 0}, other = {q28(row[i].other), 0}, none = {0, 0};
        for (int part = 0; part < 4; part++) {
            lost_t lost = 0u;
            const fixed_vec_t v = (part & 1) == 0 ? lever : fixed_quarter(lever);
            const fixed_vec_t a = (part & 1) == 0 ? other : fixed_quarter(other);
            const int32_t by = (int32_t)(row[i].ratio * 0x1p27);
            const fixed_vec_t left =
                (part & 2) == 0 ? less_scaled(v, a, by, none, 0, &lost) : less_scaled(v, none, 0, a, by, &lost);
            TEST_ASSERT_EQUAL(row[i].fits, lost < LOST);
            if (row[i].fits) {
                const double is = (double)((part & 1) == 0 ? left.x : left.z) / 0x1p28;
                TEST_ASSERT_DOUBLE_WITHIN(1e-7, row[i].lever - row[i].ratio * row[i].other, is);
            }
        }
    }
}

/* The largest levers and yields that words hold: their sum is seen before it can wrap. */
static void test_C_beyond_its_word_is_noted_and_refused(void)
{
    const fixed_vec_t longest = {INT32_MAX, INT32_MIN + 1};
    lost_t lost = 0u;
    fixed_tensor_t c = {0u, 0u, 0u};
    for (int i = 0; i < 3; i++) {
        add_scaled(&c, longest, INT32_MAX);
    }
    TEST_ASSERT_TRUE(c.xx > 3ull << 61 && c.zz > 3ull << 61);
    look_at(&c, &lost);
    TEST_ASSERT_TRUE(lost >= LOST);
    for (int part = 0; part < 2; part++) {
        for (int beyond = 0; beyond < 2; beyond++) {
            const uint64_t entry = (1ull << 62) - (beyond == 0 ? 1u : 0u);
            const fixed_tensor_t edge = {part == 0 ? entry : 1u, 0u, part == 0 ? 1u : entry};
            lost = 0u;
            look_at(&edge, &lost);
            TEST_ASSERT_EQUAL(beyond != 0, lost >= LOST);
        }
    }
    brace_stiffness_t k;
    const fixed_tensor_t largest = {(1ull << 62) - 1u, 0u, (1ull << 62) - 1u}, too_large = {1ull << 62, 0u, 1ull << 62};
    TEST_ASSERT_EQUAL(BRACE_OK, stiffness_of(&largest, 0u, 0, &k));
    TEST_ASSERT_FLOAT_WITHIN(1e-9f, 1.0f / 256.0f, k.k_xx_n_per_mm);
    TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, stiffness_of(&too_large, 0u, 0, &k));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_limb_passes_the_last_look);
    RUN_TEST(test_what_is_no_limb_takes_no_load);
    RUN_TEST(test_each_word_is_looked_at);
    RUN_TEST(test_a_lever_beyond_its_word_is_noted);
    RUN_TEST(test_C_beyond_its_word_is_noted_and_refused);
    return UNITY_END();
}
