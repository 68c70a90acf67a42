/* Tests of K in the plane followed from tick to tick, by floats and by integers: where ticks lead, what they do at
 * jumps of load, and what a tick that has not come to a rest leaves. */
#include <math.h>

#include "loaded_paths.h"

typedef struct {
    brace_loaded_t loaded;
    brace_loaded_fixed_t fixed;
    brace_loaded_place_t place;
    brace_loaded_fixed_place_t fixed_place;
    brace_loaded_stiffness_t found;
    path_t path;
} followed_t;

static followed_t followed;

void setUp(void)
{
    start_anew();
    limb = sample_limb[SAMPLE_BEAM];
    theta1_rad = 1.0, theta2_rad = 1.4;
}

void tearDown(void) {}

static void begin(path_t path)
{
    memset(&followed, 0x5a, sizeof followed); /* the first tick must not read it */
    followed.path = path;
    brace_loaded_collapse(&limb, &weights, &followed.loaded);
    brace_loaded_fixed_collapse(&followed.loaded, &followed.fixed);
    load.hip = spring_of(BRACE_FEMUR);
    load.knee = spring_of(BRACE_TIBIA);
}

static brace_status_t tick(bool is_bent)
{
    const float one_rad = (float)theta1_rad, two_rad = (float)theta2_rad;
    return followed.path == INTEGERS ? brace_loaded_fixed_follow(&followed.fixed, one_rad, two_rad, &load, is_bent,
                                                                 &followed.fixed_place, &followed.found)
                                     : brace_loaded_follow(&followed.loaded, one_rad, two_rad, &load, is_bent,
                                                           &followed.place, &followed.found);
}

/* Only the hip yields. returns the lever of a force across the stretched limb */
static double be_a_hinge(double c)
{
    limb.base = (brace_base_t){0.0f, 0.0f, 0.0f};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        limb.link[i] = (brace_link_t){.axial_mm_per_n = 1e-4f, .bending_mm_per_n = 1e-4f, .lateral_mm_per_n = 1e-4f};
        limb.joint[i].compliance_rad_per_n_mm = i == BRACE_FEMUR ? (float)c : 0.0f;
    }
    theta1_rad = theta2_rad = 0.0;
    return (double)limb.femur_mm + (double)limb.tibia_mm;
}

/* A hinge under a force that would turn it by `whole` turns by q = whole cos q (test_loaded_bounds.c). returns q */
static double hinge_turn(double whole)
{
    double less = 0.0, more = 1.6;
    for (int halving = 0; halving < 50; halving++) {
        const double q = 0.5 * (less + more);
        *(whole * cos(q) > q ? &less : &more) = q;
    }
    return 0.5 * (less + more);
}

/* A tick that has not come to a rest is refused and goes on in the next one. A rest leaves the square of the last step;
 * at most 0.05 rad of it leaves 0.003 rad here. The links' own compliance leaves 2e-5 rad and less. */
static void test_ticks_lead_to_where_the_hinge_rests(void)
{
    const double c = 1e-5, lever = be_a_hinge(c);
    for (int path = 0; path < PATHS; path++) {
        int later = 0;
        for (int i = 1; i <= 60; i++) {
            const double whole = (path == INTEGERS ? 0.015 : 0.05) * i, q = hinge_turn(whole);
            load.tip = (brace_force_t){0.0f, (float)(whole / (c * lever))};
            begin((path_t)path);
            brace_status_t status = tick(false);
            later += status != BRACE_OK;
            for (int n = 1; n < 6; n++) {
                if (status == BRACE_OK) {
                    TEST_ASSERT_DOUBLE_WITHIN(3e-3, q, (double)followed.found.hip_turn_rad);
                }
                status = tick(true);
            }
            TEST_ASSERT_EQUAL(BRACE_OK, status);
            TEST_ASSERT_DOUBLE_WITHIN(3e-5, q, (double)followed.found.hip_turn_rad);
        }
        TEST_ASSERT_TRUE(later > 0 && later < 60);
    }
}

static void test_a_tick_without_a_rest_writes_no_K(void)
{
    const double c = 1e-5, lever = be_a_hinge(c);
    for (int path = 0; path < PATHS; path++) {
        load.tip = (brace_force_t){0.0f, (float)((path == INTEGERS ? 0.8 : 1.5) / (c * lever))};
        begin((path_t)path);
        const brace_loaded_stiffness_t untouched = followed.found;
        TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, tick(false));
        TEST_ASSERT_EQUAL_MEMORY(&untouched, &followed.found, sizeof untouched);
    }
}

static double off_from(const brace_stiffness_t *is, const brace_stiffness_t *wanted)
{
    const double xx = (double)(is->k_xx_n_per_mm - wanted->k_xx_n_per_mm);
    const double xz = (double)(is->k_xz_n_per_mm - wanted->k_xz_n_per_mm);
    const double zz = (double)(is->k_zz_n_per_mm - wanted->k_zz_n_per_mm);
    return sqrt(xx * xx + 2.0 * xz * xz + zz * zz) / (double)wanted->lambda_max_n_per_mm;
}

/* Every tick of a limb that swings by 10 rad/s under a load that swings twenty times a second has the K that the whole
 * search finds, within the 0.3 % that each of the two leaves. */
static void test_a_moving_limb_is_followed(void)
{
    static const int samples[] = {SAMPLE_PAPER, SAMPLE_BEAM, SAMPLE_TILTED, SAMPLE_ROUND};
    weights = (brace_gravity_t){.femur_n = 1.0f, .knee_n = 0.5f, .tibia_n = 0.7f};
    for (int n = 0; n < 4 * PATHS; n++) {
        int compared = 0;
        limb = sample_limb[samples[n / PATHS]];
        load.tip = (brace_force_t){0.0f, 0.0f};
        begin((path_t)(n % PATHS));
        for (int t_ms = 0; t_ms < 200; t_ms++) {
            const double phase = 6.283185307 * 20.0 * 1e-3 * t_ms, size_n = 8.0 + 7.0 * cos(phase);
            theta1_rad = 0.8 + 0.5 * sin(20.0 * 1e-3 * t_ms);
            load.tip = (brace_force_t){(float)(-0.8 * size_n), (float)(0.6 * size_n)};
            brace_loaded_stiffness_t wanted;
            const brace_status_t status = tick(t_ms > 0);
            TEST_ASSERT_EQUAL(
                BRACE_OK, status_in_plane((path_t)(n % PATHS), (double)load.tip.x_n, (double)load.tip.z_n, &wanted));
            TEST_ASSERT_EQUAL(BRACE_OK, status);
            TEST_ASSERT_DOUBLE_WITHIN(6e-3, 0.0, off_from(&followed.found.stiffness, &wanted.stiffness));
            compared++;
        }
        TEST_ASSERT_EQUAL(200, compared);
    }
}

/* Where ticks of a standing limb lead is the same by floats and by integers, however few steps each of them takes. */
static void test_a_standing_limb_comes_to_one_rest_on_both_paths(void)
{
    static const int samples[] = {SAMPLE_PAPER, SAMPLE_BEAM, SAMPLE_TILTED, SAMPLE_ROUND};
    for (uint32_t i = 0; i < sizeof samples / sizeof *samples; i++) {
        brace_loaded_stiffness_t found[PATHS];
        limb = sample_limb[samples[i]];
        load.tip = (brace_force_t){-40.0f, 25.0f};
        for (int path = 0; path < PATHS; path++) {
            begin((path_t)path);
            for (int n = 0; n < 6; n++) {
                (void)tick(n > 0);
            }
            TEST_ASSERT_EQUAL(BRACE_OK, tick(true));
            found[path] = followed.found;
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.0, off_from(&found[INTEGERS].stiffness, &found[FLOATS].stiffness));
        TEST_ASSERT_FLOAT_WITHIN(1e-5f, found[FLOATS].hip_turn_rad, found[INTEGERS].hip_turn_rad);
        TEST_ASSERT_FLOAT_WITHIN(1e-5f, found[FLOATS].knee_turn_rad, found[INTEGERS].knee_turn_rad);
    }
}

/* How far two ticks turn the hip: the first from the straight limb, the second from there, or anew. */
static double hip_after(path_t path, brace_force_t before_n, brace_force_t force_n, bool is_bent)
{
    begin(path);
    load.tip = before_n;
    (void)tick(false);
    load.tip = force_n;
    (void)tick(is_bent);
    return path == INTEGERS ? 0x1p-29 * followed.fixed_place.femur_shape.root : (double)followed.place.femur_shape.root;
}

static void expect_followed(bool is_followed, brace_force_t before_n, brace_force_t force_n)
{
    for (int path = 0; path < PATHS; path++) {
        const double gone_on_rad = hip_after((path_t)path, before_n, force_n, true);
        const double anew_rad = hip_after((path_t)path, before_n, force_n, false);
        TEST_ASSERT_EQUAL(is_followed, gone_on_rad != anew_rad);
    }
}

/* A load that has changed by more than half of itself is taken from the straight limb; one that has changed by less
 * goes on from the rest before. */
static void test_a_jump_of_the_load_is_not_followed(void)
{
    static const struct {
        brace_force_t before_n, force_n;
        bool is_followed;
    } jumps[] = {{{-6.0f, 3.0f}, {6.0f, -3.0f}, false}, {{-9.0f, 1.0f}, {-5.9f, 0.0f}, false},
                 {{-2.0f, 0.5f}, {-9.0f, 0.5f}, false}, {{-8.9f, 0.0f}, {-6.1f, 0.0f}, true},
                 {{-6.1f, 0.0f}, {-8.9f, 0.0f}, true},  {{-40.0f, 0.0f}, {-6.0f, 0.0f}, false},
                 {{-6.0f, 0.0f}, {-40.0f, 0.0f}, false}};
    for (uint32_t i = 0; i < sizeof jumps / sizeof *jumps; i++) {
        expect_followed(jumps[i].is_followed, jumps[i].before_n, jumps[i].force_n);
    }
}

/* The same where the integers' unit of force changes: for this hinge, between 128 and 129 N. */
static void test_units_that_change_hide_no_jump(void)
{
    (void)be_a_hinge(1e-5);
    expect_followed(true, (brace_force_t){0.0f, 66.0f}, (brace_force_t){0.0f, 130.0f});
    expect_followed(false, (brace_force_t){0.0f, 64.0f}, (brace_force_t){0.0f, 130.0f});
    expect_followed(true, (brace_force_t){0.0f, 185.0f}, (brace_force_t){0.0f, 124.0f});
    expect_followed(false, (brace_force_t){0.0f, 187.0f}, (brace_force_t){0.0f, 124.0f});
}

/* Inputs that are refused leave the place as it is: the next tick goes on from there. */
static void test_what_is_refused_leaves_the_place(void)
{
    for (int path = 0; path < PATHS; path++) {
        load.tip = (brace_force_t){-5.0f, 4.0f};
        begin((path_t)path);
        TEST_ASSERT_EQUAL(BRACE_OK, tick(false));
        const followed_t before = followed;
        load.tip.x_n = NAN;
        TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, tick(true));
        load.tip.x_n = 1.1e4f;
        TEST_ASSERT_EQUAL(BRACE_E_RANGE, tick(true));
        TEST_ASSERT_EQUAL_MEMORY(&before.place, &followed.place, sizeof before.place);
        TEST_ASSERT_EQUAL_MEMORY(&before.fixed_place, &followed.fixed_place, sizeof before.fixed_place);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_ticks_lead_to_where_the_hinge_rests);
    RUN_TEST(test_a_tick_without_a_rest_writes_no_K);
    RUN_TEST(test_a_moving_limb_is_followed);
    RUN_TEST(test_a_standing_limb_comes_to_one_rest_on_both_paths);
    RUN_TEST(test_a_jump_of_the_load_is_not_followed);
    RUN_TEST(test_units_that_change_hide_no_jump);
    RUN_TEST(test_what_is_refused_leaves_the_place);
    return UNITY_END();
}
