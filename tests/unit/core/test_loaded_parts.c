/* In the plane, floats and integers share no line but are the same sums. Here each part of the one is asked beside that
 * of the other: the links as a load sees them, what they tell on the way to the equilibrium, and at it. Both get the
 * same numbers, so only words' rounding is between them. Whole results are compared in test_loaded_agree.c; whether the
 * sums are right, the laws and the reference say. */
#include <math.h>

#pragma GCC diagnostic ignored "-Wunused-function" /* this suite does not call all functions of the headers */
#include "loaded/fixed_inputs.h"
#include "loaded/solve.h"

#include "even_limb.h"

/* In the units of length and force all numbers here are below 4. Floats of them have last places of 2.4e-7 and are
 * rounded some ten times; coarse products leave out three bits of q27. */
#define WITHIN 4e-7

static brace_loaded_t loaded;
static brace_loaded_fixed_t fixed;
static brace_loaded_rest_t rest;
static fixed_inputs_t in;
static fixed_link_t femur_words, tibia_words;
static double force_unit_n, length_unit_mm;

void setUp(void)
{
    start_anew();
}

void tearDown(void) {}

static void expect(float wanted, int32_t is, int format)
{
    TEST_ASSERT_DOUBLE_WITHIN(WITHIN, (double)wanted, ldexp((double)is, -format));
}

static void expect2(brace_vec_t wanted, fixed_vec_t is, int format)
{
    expect(wanted.x, is.x, format);
    expect(wanted.z, is.z, format);
}

/* wanted: in units of `unit` */
static void expect_seen(brace_vec_t wanted, double unit, fixed_vec_t is, int format)
{
    TEST_ASSERT_DOUBLE_WITHIN(WITHIN, (double)wanted.x / unit, ldexp((double)is.x, -format));
    TEST_ASSERT_DOUBLE_WITHIN(WITHIN, (double)wanted.z / unit, ldexp((double)is.z, -format));
}

/* A limb under a load, its links as the integers see them. */
static void take_any_limb(int i)
{
    const double force_n = any(1.0, 60.0), down_rad = any(-3.2, 3.2), force_rad = any(-3.2, 3.2);
    be_even(i % 2 == 0 ? 0.1 : 0.3, force_n * pow(10.0, (double)(i % 3)));
    load.tip = (brace_force_t){(float)(force_n * cos(force_rad)), (float)(force_n * sin(force_rad))};
    load.down = (brace_vec_t){(float)cos(down_rad), (float)sin(down_rad)};
    load.hip = spring_of(BRACE_FEMUR);
    load.knee = spring_of(BRACE_TIBIA);
    load.knee.yields_by_rad_per_n_mm *= 0.7f; /* a spring that yields otherwise to what comes on top */
    load.hip.slope_rad_per_n_mm *= 0.6f;
    brace_loaded_collapse(&limb, &weights, &loaded);
    brace_loaded_fixed_collapse(&loaded, &fixed);
    const float theta1 = (float)theta1_rad, theta2 = (float)theta2_rad;
    (void)brace_loaded_settle(&loaded, theta1, theta2, &load, &rest);
    TEST_ASSERT_EQUAL(BRACE_OK, inputs_of(&fixed, theta1, theta2, &load, &in));
    force_unit_n = ldexp(1.0, in.force_exponent);
    length_unit_mm = ldexp(1.0, fixed.length_exponent);
    const fixed_vec_t femur = fixed_direction(brace_turn_from_q28(in.theta1_q28));
    const fixed_vec_t tibia = fixed_direction(0u - brace_turn_from_q28(in.theta2_q28));
    const fixed_vec_t tip = fixed_turned_back(in.tip_q30, femur), down = fixed_turned_back(in.down_q30, femur);
    const fixed_vec_t knee_carries = fixed_plus(tip, fixed_scaled(down, fixed.knee_q31 >> in.weight_shift, 30));
    femur_words = link_seen(&fixed.femur, &in, NULL, knee_carries, down);
    tibia_words = link_seen(&fixed.tibia, &in, &tibia, tip, down);
}

static void expect_link(const link_t *wanted, const fixed_link_t *is)
{
    const double root = sqrt(length_unit_mm / force_unit_n), moment = force_unit_n * length_unit_mm;
    expect_seen(wanted->to_beam_mm, length_unit_mm, is->to_beam, 28);
    expect_seen(wanted->beam_mm, length_unit_mm, is->beam, 28);
    expect_seen(wanted->rigid_mm, length_unit_mm, is->rigid, 28);
    expect_seen(wanted->root_root, root, is->root_root, 30);
    expect_seen(wanted->end_root, root, is->end_root, 30);
    expect_seen(wanted->beyond_n, force_unit_n, is->beyond, 30);
    expect_seen(wanted->own_n, force_unit_n, is->own, 30);
    expect_seen(wanted->on_rigid_n, force_unit_n, is->on_rigid, 30);
    expect((float)((double)wanted->end_mm_per_n * force_unit_n / length_unit_mm), is->end_q30, 30);
    expect((float)((double)wanted->bend_rad_per_n_mm * moment), is->bend, 29);
}

/* The units, the load, and the two links in the femur's frame. */
static void test_links_as_a_load_sees_them(void)
{
    state = 15u;
    for (int i = 0; i < 60 * TIMES; i++) {
        take_any_limb(i);
        const double moment = force_unit_n * length_unit_mm;
        const float base = loaded.base_rotation_rad_per_n_mm;
        const float joints[4] = {load.hip.yields_by_rad_per_n_mm + base, load.hip.slope_rad_per_n_mm + base,
                                 load.knee.yields_by_rad_per_n_mm, load.knee.slope_rad_per_n_mm};
        const int32_t words[4] = {in.hip_yields, in.hip, in.knee_yields, in.knee};
        for (int j = 0; j < 4; j++) {
            expect((float)((double)joints[j] * moment), words[j], 29);
        }
        expect_link(&rest.femur, &femur_words);
        expect_link(&rest.tibia, &tibia_words);

        /* A unit of force is a power of two above the loads, or as large as a compliance's word allows. */
        const double loads_n = hypot((double)load.tip.x_n, (double)load.tip.z_n) + 1.5 * (double)loaded.weight_n;
        TEST_ASSERT_TRUE(loads_n < force_unit_n);
        const double largest = fmax(fmax(fabs((double)joints[0]), fabs((double)joints[1])),
                                    fmax(fabs((double)joints[2]), fabs((double)joints[3])));
        TEST_ASSERT_TRUE(moment * largest < 4.0);
    }
}

static float number(int32_t word, int format)
{
    return (float)ldexp((double)word, -format);
}

static brace_vec_t numbers(fixed_vec_t words, int format)
{
    return (brace_vec_t){number(words.x, format), number(words.z, format)};
}

/* The same link in floats, in the integers' units. */
static link_t floats_of(const fixed_link_t *link)
{
    return (link_t){.to_beam_mm = numbers(link->to_beam, 28),
                    .beam_mm = numbers(link->beam, 28),
                    .rigid_mm = numbers(link->rigid, 28),
                    .root_root = numbers(link->root_root, 30),
                    .end_root = numbers(link->end_root, 30),
                    .end_mm_per_n = number(link->end_q30, 30),
                    .bend_rad_per_n_mm = number(link->bend, 29),
                    .beyond_n = numbers(link->beyond, 30),
                    .own_n = numbers(link->own, 30),
                    .on_rigid_n = numbers(link->on_rigid, 30)};
}

static void expect_matrix(const matrix_t *wanted, const fixed_matrix_t *is)
{
    expect(wanted->rr, is->rr, 27);
    expect(wanted->ra, is->ra, 27);
    expect(wanted->rb, is->rb, 27);
    expect(wanted->aa, is->aa, 27);
    expect(wanted->ab, is->ab, 27);
    expect(wanted->bb, is->bb, 27);
}

static void expect_pull(const pull_t *wanted, const fixed_pull_t *is)
{
    expect_matrix(&wanted->resists, &is->resists);
    expect(wanted->drives.root, is->drives.root, 27);
    expect(wanted->drives.a, is->drives.a, 27);
    expect(wanted->drives.b, is->drives.b, 27);
    expect(wanted->end_resists, is->end_resists, 27);
    expect(wanted->end_drives, is->end_drives, 27);
}

static void expect_rest(const rest_t *wanted, const fixed_rest_t *is)
{
    expect_matrix(&wanted->resists, &is->resists);
    expect(wanted->end_resists, is->end_resists, 27);
    expect(wanted->root_softens, is->root_softens, 27);
    expect(wanted->end_softens, is->end_softens, 27);
    expect2(wanted->tip_mm, is->tip, 28);
    expect2(wanted->a, is->a, 28);
    expect2(wanted->b, is->b, 28);
    expect2(wanted->end, is->end, 28);
    expect2(wanted->aside, is->aside, 28);
    expect2(wanted->root_spring, is->root_spring, 30);
    expect2(wanted->end_spring, is->end_spring, 30);
}

/* A link at any shape, and its springs and weight of any size: they count as much as the rest. */
static void expect_alike(fixed_link_t words)
{
    const int32_t word_30 = 1 << 30;
    words.root_root = (fixed_vec_t){(int32_t)(any(-0.6, 0.6) * word_30), (int32_t)(any(-0.6, 0.6) * word_30)};
    words.end_root = (fixed_vec_t){(int32_t)(any(-0.6, 0.6) * word_30), (int32_t)(any(-0.6, 0.6) * word_30)};
    words.own = (fixed_vec_t){(int32_t)(any(-0.4, 0.4) * word_30), (int32_t)(any(-0.4, 0.4) * word_30)};
    words.end_q30 = (int32_t)(any(0.0, 0.5) * word_30);
    const link_t link = floats_of(&words);
    const fixed_shape_t shape_words = {(int32_t)(any(-1.5, 1.5) * 0x1p29), (int32_t)(any(-0.8, 0.8) * 0x1p29),
                                       (int32_t)(any(-0.8, 0.8) * 0x1p29)};
    const shape_t shape = {number(shape_words.root, 29), number(shape_words.a, 29), number(shape_words.b, 29)};
    pull_t pull;
    fixed_pull_t pull_words;
    pull_straight(&link, &pull);
    fixed_pull_straight(&words, &pull_words);
    expect_pull(&pull, &pull_words);
    pull_bent(&link, &shape, &pull);
    fixed_pull_bent(&words, &shape_words, &pull_words);
    expect_pull(&pull, &pull_words);
    rest_t at;
    fixed_rest_t at_words;
    rest_of(&link, &shape, &at);
    fixed_rest_of(&words, &shape_words, &at_words);
    expect_rest(&at, &at_words);
}

static void test_a_link_at_any_shape(void)
{
    state = 16u;
    for (int i = 0; i < 100 * TIMES; i++) {
        take_any_limb(i);
        expect_alike(femur_words);
        expect_alike(tibia_words);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_links_as_a_load_sees_them);
    RUN_TEST(test_a_link_at_any_shape);
    return UNITY_END();
}
