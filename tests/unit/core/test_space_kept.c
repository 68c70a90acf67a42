/* The last look of the collapse in space: a collapsed limb is kept as long as each word of it is within the bound that
 * space_kept.h names, and no longer. Each word is set to its bounds and just beyond, alone. */
#include <string.h>

#include "brace/loaded_space.h"
#include "brace/loaded_space_fixed.h"
#include "fixed_space/space_kept.h"
#include "sample_limbs.h"
#include "unity.h"

static brace_loaded_space_fixed_t fixed, sound;

void setUp(void)
{
    static const brace_gravity_t weights = {.femur_n = 3.0f, .knee_n = 2.0f, .tibia_n = 1.0f};
    brace_loaded_space_t loaded;
    brace_loaded_space_collapse(&sample_limb[SAMPLE_TILTED], &weights, &loaded);
    brace_loaded_space_fixed_collapse(&loaded, &sound);
    fixed = sound;
    TEST_ASSERT_TRUE(is_space_kept(&fixed));
}

void tearDown(void) {}

/* A word from least to most is kept; one less and one more are not, if a word holds them. */
static void expect_bounds(int32_t *word, int64_t least, int64_t most)
{
    const int32_t was = *word;
    const int64_t tried[] = {least - 1, least, least + 1, most - 1, most, most + 1};
    for (int i = 0; i < 6; i++) {
        if (tried[i] >= INT32_MIN && tried[i] <= INT32_MAX) {
            *word = (int32_t)tried[i];
            TEST_ASSERT_EQUAL(i != 0 && i != 5, is_space_kept(&fixed));
        }
    }
    *word = was;
}

/* A vector may be so long, in whatever direction. */
static void expect_length(brace_fixed_vec_t *vector, int32_t most)
{
    const brace_fixed_vec_t was = *vector;
    const int32_t part = (int32_t)(0.6 * most), other = (int32_t)(0.8 * most);
    const brace_fixed_vec_t within[] = {{most, 0}, {-most, 0}, {0, most}, {0, -most}, {part - 1, other - 1},
                                        {-part + 1, other - 1}, {0, 0}};
    const brace_fixed_vec_t beyond[] = {{most + 1, 0}, {-most - 1, 0}, {0, most + 1}, {0, -most - 1},
                                        {part + 2, other + 2}, {-part - 2, -other - 2}, {INT32_MIN, INT32_MIN}};
    for (int i = 0; i < 7; i++) {
        *vector = within[i];
        TEST_ASSERT_TRUE(is_space_kept(&fixed));
        *vector = beyond[i];
        TEST_ASSERT_FALSE(is_space_kept(&fixed));
    }
    *vector = was;
}

static void test_each_word_of_a_link(void)
{
    brace_space_fixed_link_t *const links[] = {&fixed.coxa, &fixed.femur, &fixed.tibia};
    for (int i = 0; i < 3; i++) {
        brace_space_fixed_link_t *link = links[i];
        const int64_t length = link->length_q28, unit_q30 = 1 << 30;
        expect_bounds(&link->twelfth_q28, 0, length / 12 + 2);
        expect_length(&link->along_q30, ALONG_MOST_Q30);
        expect_length(&link->tilt_q28, (int32_t)(length * TILT_MOST_Q30 / unit_q30 + 2));
        expect_length(&link->bow_q28, (int32_t)(length * BOW_MOST_Q30 / unit_q30 + 2));
        expect_bounds(&link->twist_q31, 0, TWIST_MOST_Q31);
        int32_t *const not_negative[] = {&link->sideways_q31, &link->bend_q31, &link->across_arm_q31,
                                         &link->sideways_arm_q31, &link->stretch_q31};
        for (int word = 0; word < 5; word++) {
            expect_bounds(not_negative[word], 0, INT32_MAX);
        }
        expect_bounds(&link->across_spread_q31, 0, SPREAD_MOST_Q31);
        expect_bounds(&link->sideways_spread_q31, 0, SPREAD_MOST_Q31);
        expect_bounds(&link->end_share_q30, 0, SHARE_MOST_Q30);
        expect_bounds(&link->stretch_end_share_q30, -unit_q30 / 2, unit_q30 / 2);
        expect_bounds(&link->own_share_q30, 0, unit_q30 / 2);
        expect_bounds(&link->curl_q30, 0, unit_q30);
        expect_bounds(&link->shortens_q30, 0, SHORTENS_MOST_Q30);
        const uint32_t shift = link->arm_shift;
        link->arm_shift = ARM_SHIFT_MOST;
        TEST_ASSERT_TRUE(is_space_kept(&fixed));
        link->arm_shift = ARM_SHIFT_MOST + 1u;
        TEST_ASSERT_FALSE(is_space_kept(&fixed));
        link->arm_shift = shift;
    }
}

/* All links together are no longer than the unit of length, and none is of less than no length. */
static void test_lengths(void)
{
    brace_space_fixed_link_t *const links[] = {&fixed.coxa, &fixed.femur, &fixed.tibia};
    const int64_t whole = (int64_t)fixed.coxa.length_q28 + fixed.femur.length_q28 + fixed.tibia.length_q28;
    for (int i = 0; i < 3; i++) {
        links[i]->twelfth_q28 = 0; /* fits a link of no length */
        links[i]->tilt_q28 = links[i]->bow_q28 = (brace_fixed_vec_t){0, 0};
    }
    for (int i = 0; i < 3; i++) {
        expect_bounds(&links[i]->length_q28, 0, LENGTHS_MOST_Q28 - (whole - links[i]->length_q28));
    }
    expect_bounds(&fixed.length_exponent, UNIT_LENGTH_EXPONENT_LEAST, UNIT_LENGTH_EXPONENT_MOST);
}

static void test_the_base(void)
{
    expect_bounds(&fixed.base_x_q31, 0, INT32_MAX);
    expect_bounds(&fixed.base_z_q31, 0, INT32_MAX);
    expect_bounds(&fixed.base_rotation_q31, 0, INT32_MAX);
}

/* What a link's end carries is the weight of all beyond it, but for the rounding of each. */
static void test_weights_add_up(void)
{
    const int64_t apart = WEIGHTS_APART_Q31;
    expect_bounds(&fixed.coxa.weight_q31, 0, INT32_MAX); /* the base bears it: it bends nothing */
    expect_bounds(&fixed.femur.weight_q31, 0, fixed.beyond_coxa_q31 - (int64_t)fixed.beyond_femur_q31 + apart);
    expect_bounds(&fixed.tibia.weight_q31, 0, fixed.beyond_femur_q31 + apart);
    expect_bounds(&fixed.beyond_femur_q31, fixed.tibia.weight_q31 - apart,
                  fixed.beyond_coxa_q31 - (int64_t)fixed.femur.weight_q31 + apart);
    fixed.tibia.weight_q31 = 0;
    expect_bounds(&fixed.beyond_femur_q31, 0, fixed.beyond_coxa_q31 - (int64_t)fixed.femur.weight_q31 + apart);
}

/* No weights at all, at whatever exponent: then only the sign counts. */
static void test_no_weights(void)
{
    fixed.femur.weight_q31 = fixed.tibia.weight_q31 = fixed.beyond_femur_q31 = fixed.beyond_coxa_q31 = 0;
    fixed.weight_q8 = 0u;
    fixed.weight_exponent = -40;
    expect_bounds(&fixed.beyond_coxa_q31, 0, INT32_MAX); /* 2^-40 N counts as nothing */
    fixed.weight_exponent = -32;
    expect_bounds(&fixed.beyond_coxa_q31, 0, INT32_MAX);
}

/* The weights in 384ths of a newton, and in the words' unit. */
static void test_weights_are_told_alike_twice(void)
{
    const int32_t right = 31 - fixed.weight_exponent;
    const int64_t whole_q8 = ((int64_t)fixed.beyond_coxa_q31 * 384) >> right;
    TEST_ASSERT_TRUE(whole_q8 > 1000 && whole_q8 < 1 << 20);
    fixed.weight_q8 = (uint32_t)whole_q8;
    TEST_ASSERT_TRUE(is_space_kept(&fixed));
    fixed.weight_q8 = (uint32_t)whole_q8 - 1u;
    TEST_ASSERT_FALSE(is_space_kept(&fixed));

    /* A unit of weight is at most the power of two above two thirds of that, with two counts more. */
    int power = 0;
    while ((1u << power) <= sound.weight_q8 + 2u) {
        power++;
    }
    fixed = sound;
    fixed.femur.weight_q31 = fixed.tibia.weight_q31 = fixed.beyond_femur_q31 = fixed.beyond_coxa_q31 = 0;
    for (int exponent = -100; exponent < 24; exponent++) {
        fixed.weight_exponent = exponent;
        TEST_ASSERT_EQUAL(exponent <= power - 8, is_space_kept(&fixed));
    }
    fixed.weight_exponent = -40;
    fixed.weight_q8 = 1u << 31;
    TEST_ASSERT_TRUE(is_space_kept(&fixed));
    fixed.weight_q8 = (1u << 31) + 1u;
    TEST_ASSERT_FALSE(is_space_kept(&fixed));
}

/* 2^20 counts and more may be short by one in 2^20: a float rounds. */
static void test_large_weights_are_told_alike_but_for_rounding(void)
{
    fixed.femur.weight_q31 = fixed.tibia.weight_q31 = fixed.beyond_femur_q31 = 0;
    fixed.weight_exponent = 14;
    fixed.beyond_coxa_q31 = 1 << 30; /* 2^13 N */
    const uint32_t whole_q8 = 384u << 13;
    fixed.weight_q8 = whole_q8 - 2u;
    TEST_ASSERT_TRUE(is_space_kept(&fixed));
    fixed.weight_q8 = whole_q8 - 3u;
    TEST_ASSERT_FALSE(is_space_kept(&fixed));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_word_of_a_link);
    RUN_TEST(test_lengths);
    RUN_TEST(test_the_base);
    RUN_TEST(test_weights_add_up);
    RUN_TEST(test_no_weights);
    RUN_TEST(test_weights_are_told_alike_twice);
    RUN_TEST(test_large_weights_are_told_alike_but_for_rounding);
    return UNITY_END();
}
