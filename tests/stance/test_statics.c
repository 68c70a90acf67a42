/* The statics of a body on limbs where they have a closed form: who carries what, which foot slides, what a slip leaves
 * behind, what cannot be borne. Every limb here is a spring that yields alike in all directions. */
#include <math.h>
#include <stddef.h>
#include <string.h>
#include <unity.h>

#include "brace/stance.h"

#define EXACT 1e-8 /* of forces of some 10 N: rounding of a 6 x 6 elimination, and the law of sliding left at 1e-10 */

void setUp(void) {}
void tearDown(void) {}

static const double corners_mm[4][2] = {{100.0, 100.0}, {-100.0, 100.0}, {-100.0, -100.0}, {100.0, -100.0}};

static void stand_limb(brace_stance_t *stance, double x_mm, double y_mm, double k_n_per_mm, double friction_ratio)
{
    brace_stance_limb_t *limb = &stance->limb[stance->limb_count++];
    *limb = (brace_stance_limb_t){
        .foot_mm = {x_mm, y_mm, 0.0}, .normal = {0.0, 0.0, 1.0}, .friction_ratio = friction_ratio};
    for (int i = 0; i < 3; i++) {
        limb->k_n_per_mm[4 * i] = k_n_per_mm;
    }
}

/* On four corners, the first and the third with one stiffness, the others with another. */
static brace_stance_t on_corners(double k_n_per_mm, double other_k_n_per_mm, double friction_ratio)
{
    brace_stance_t stance = {.limb_count = 0};
    for (int i = 0; i < 4; i++) {
        stand_limb(&stance, corners_mm[i][0], corners_mm[i][1], i % 2 == 0 ? k_n_per_mm : other_k_n_per_mm,
                   friction_ratio);
    }
    return stance;
}

/* At the height of the feet, so that a push along the ground turns nothing. */
static brace_stance_load_t load_of(double x_n, double z_n, double at_x_mm)
{
    brace_stance_load_t load = {.force_n = {0.0}};
    const double force_n[3] = {x_n, 0.0, z_n}, at_mm[3] = {at_x_mm, 0.0, 0.0};
    brace_stance_load_add(&load, force_n, at_mm);
    return load;
}

static brace_stance_state_t placed(const brace_stance_t *stance)
{
    brace_stance_state_t state;
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, brace_stance_place(stance, NULL, &state));
    return state;
}

static int32_t settle(const brace_stance_t *stance, double x_n, double z_n, brace_stance_state_t *state)
{
    const brace_stance_load_t load = load_of(x_n, z_n, 0.0);
    return brace_stance_settle(stance, &load, 8, state, NULL);
}

/* ------------------------------------------------------------------------------------------- who carries -- */

static void test_the_stiffer_limbs_carry_more(void)
{
    const brace_stance_t stance = on_corners(3.0, 1.0, 0.5);
    brace_stance_state_t state = placed(&stance);
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, settle(&stance, 0.0, -32.0, &state));
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(EXACT, i % 2 == 0 ? 12.0 : 4.0, state.foot[i].force_n[2]);
        TEST_ASSERT_EQUAL_INT(BRACE_FOOT_STICKS, state.foot[i].contact);
    }
    TEST_ASSERT_DOUBLE_WITHIN(EXACT, -4.0, state.displacement_mm[2]);
}

/* A load aside of the middle: a rigid beam on springs, and the body turns. */
static void test_a_load_aside_turns_the_body(void)
{
    const brace_stance_t stance = on_corners(2.0, 2.0, 0.9);
    brace_stance_state_t state = placed(&stance);
    brace_stance_load_t load = load_of(0.0, -20.0, 50.0);
    memset(load.turning_n_mm, 0, sizeof load.turning_n_mm); /* to first order alone */
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, brace_stance_settle(&stance, &load, 8, &state, NULL));
    TEST_ASSERT_DOUBLE_WITHIN(EXACT, 7.5, state.foot[0].force_n[2]);
    TEST_ASSERT_DOUBLE_WITHIN(EXACT, 2.5, state.foot[1].force_n[2]);
    TEST_ASSERT_DOUBLE_WITHIN(EXACT, (2.5 / 2.0) / 100.0, state.rotation_rad[1]);
}

/* A limb that stands a millimetre higher than it should bears more, and so does the one across. */
static void test_a_foothold_that_is_off_loads_its_limb(void)
{
    const brace_stance_t stance = on_corners(2.0, 2.0, 5.0);
    const double offset_mm[12] = {0.0, 0.0, 1.0};
    brace_stance_state_t state;
    const brace_stance_load_t load = load_of(0.0, -20.0, 0.0);
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, brace_stance_place(&stance, offset_mm, &state));
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, brace_stance_settle(&stance, &load, 1, &state, NULL));
    /* only the twist of the four feet is not followed by the body: a quarter of the offset on each */
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(2e-3, 5.0 + (i % 2 == 0 ? 0.5 : -0.5), state.foot[i].force_n[2]);
    }
}

/* A body on high legs that lean under its weight: the weight's own moment makes it softer. */
static void test_preloaded_legs_are_softer_along_the_ground(void)
{
    brace_stance_t stance = on_corners(2.0, 2.0, 5.0);
    brace_stance_state_t state = placed(&stance);
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, settle(&stance, 0.0, -40.0, &state));
    for (int i = 0; i < 4; i++) { /* K at this force: the same spring, its force of now */
        stance.limb[i].force_n[2] = 10.0;
        stance.limb[i].moved_mm[2] = 5.0;
    }
    brace_stance_load_t load = {.force_n = {0.0}};
    const double weight_n[3] = {0.0, 0.0, -40.0}, high_mm[3] = {0.0, 0.0, 200.0};
    brace_stance_load_add(&load, weight_n, high_mm);
    state = placed(&stance);
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, brace_stance_settle(&stance, &load, 1, &state, NULL));
    load.moment_n_mm[1] += 1000.0;
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, brace_stance_settle(&stance, &load, 1, &state, NULL));
    /* turning about y: four springs of 2 N/mm on arms of 100 mm, less 40 N that lean from 200 mm above; the feet's own
     * forces turn with the limbs and stand on arms that stay */
    const double held_n_mm = 4.0 * 2.0 * 100.0 * 100.0 - 40.0 * 200.0;
    TEST_ASSERT_DOUBLE_WITHIN(0.01 * 1000.0 / held_n_mm, 1000.0 / held_n_mm, state.rotation_rad[1]);
}

/* ------------------------------------------------------------------------------------- what slides, what goes -- */

static void test_feet_slide_at_friction_times_weight(void)
{
    const brace_stance_t stance = on_corners(2.0, 2.0, 0.4);
    brace_stance_state_t state = placed(&stance);
    brace_stance_slip_t slip;
    const brace_stance_load_t push = load_of(1.0, 0.0, 0.0);
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, settle(&stance, 0.0, -20.0, &state));
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, brace_stance_first_slip(&stance, &push, 100.0, &state, &slip));
    TEST_ASSERT_DOUBLE_WITHIN(EXACT, 8.0, slip.factor);
    TEST_ASSERT_EQUAL_INT(BRACE_FOOT_SLIDES, slip.contact);
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, brace_stance_first_slip(&stance, &push, 7.9, &state, &slip));
    TEST_ASSERT_EQUAL_INT(-1, slip.limb);

    const brace_stance_load_t too_much = load_of(10.0, -20.0, 0.0);
    double share = 0.0;
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_E_NO_REST, brace_stance_settle(&stance, &too_much, 8, &state, &share));
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.8, share);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 8.0, state.load.force_n[0]);
}

/* Four feet that hold and one in the middle that slides: loading and unloading differ by what slid. */
static void test_a_slip_leaves_forces_behind(void)
{
    const double k_n_per_mm = 2.0, friction = 0.1, weight_n = 50.0, most_n = 15.0;
    brace_stance_t stance = on_corners(k_n_per_mm, k_n_per_mm, 9.0);
    stand_limb(&stance, 0.0, 0.0, k_n_per_mm, friction);
    brace_stance_state_t state = placed(&stance);
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, settle(&stance, 0.0, -weight_n, &state));
    const double held_n = friction * weight_n / 5.0;
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, settle(&stance, most_n, -weight_n, &state));
    TEST_ASSERT_EQUAL_INT(BRACE_FOOT_SLIDES, state.foot[4].contact);
    TEST_ASSERT_DOUBLE_WITHIN(EXACT, -held_n, state.foot[4].force_n[0]);
    const double moved_mm = (most_n - held_n) / (4.0 * k_n_per_mm);
    TEST_ASSERT_DOUBLE_WITHIN(EXACT, moved_mm, state.displacement_mm[0]);
    const double slid_mm = moved_mm - held_n / k_n_per_mm;
    TEST_ASSERT_DOUBLE_WITHIN(EXACT, slid_mm, state.foot[4].place_mm[0]);

    /* back again, as far as the foot sticks: its spring pulls the body after it */
    const double back_n = most_n - 5.0 * held_n;
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, settle(&stance, back_n, -weight_n, &state));
    TEST_ASSERT_EQUAL_INT(BRACE_FOOT_STICKS, state.foot[4].contact);
    TEST_ASSERT_DOUBLE_WITHIN(EXACT, 0.0, state.foot[4].force_n[0]);
    TEST_ASSERT_DOUBLE_WITHIN(EXACT, slid_mm, state.displacement_mm[0]);
    /* with no push at all the foot has slid back until its friction holds it */
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, settle(&stance, 0.0, -weight_n, &state));
    TEST_ASSERT_DOUBLE_WITHIN(EXACT, held_n, state.foot[4].force_n[0]);
    TEST_ASSERT_DOUBLE_WITHIN(EXACT, held_n / (4.0 * k_n_per_mm), state.displacement_mm[0]);
}

static void test_a_foot_opens_and_comes_down_again(void)
{
    const brace_stance_t stance = on_corners(2.0, 2.0, 0.9);
    brace_stance_state_t state = placed(&stance);
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, settle(&stance, 0.0, -20.0, &state));
    /* over the diagonal of two feet and a little further to the first: the third foot leaves the ground */
    brace_stance_load_t aside = {.force_n = {0.0}};
    const double weight_n[3] = {0.0, 0.0, -20.0}, at_mm[3] = {55.0, 55.0, 0.0};
    brace_stance_load_add(&aside, weight_n, at_mm);
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, brace_stance_settle(&stance, &aside, 8, &state, NULL));
    TEST_ASSERT_EQUAL_INT(BRACE_FOOT_OPEN, state.foot[2].contact);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_DOUBLE(0.0, state.foot[2].force_n[i]);
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.05, 11.0,
                              state.foot[0].force_n[2]); /* 20 N at 55 of 100 mm, the lever grown a little */
    TEST_ASSERT_TRUE(state.foot[2].place_mm[2] > state.foot[2].ground_mm);
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, settle(&stance, 0.0, -20.0, &state));
    TEST_ASSERT_EQUAL_INT(BRACE_FOOT_STICKS, state.foot[2].contact);
    TEST_ASSERT_DOUBLE_WITHIN(0.05, 5.0, state.foot[2].force_n[2]);
}

/* Under a ceiling: each foot holds by its grip, until one pull is too much, and then all. */
static void test_grips_hold_a_body_under_a_ceiling(void)
{
    brace_stance_t stance = on_corners(2.0, 2.0, 0.5);
    for (int i = 0; i < 4; i++) {
        stance.limb[i].normal[2] = -1.0;
        stance.limb[i].grip_n = 10.0;
    }
    brace_stance_state_t state = placed(&stance);
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, settle(&stance, 0.0, -39.0, &state));
    TEST_ASSERT_DOUBLE_WITHIN(EXACT, 9.75, state.foot[1].force_n[2]);
    TEST_ASSERT_DOUBLE_WITHIN(EXACT, 0.5 * 0.25, brace_stance_margin_n(&stance.limb[1], state.foot[1].force_n));
    brace_stance_slip_t slip;
    const brace_stance_load_t more = load_of(0.0, -1.0, 0.0);
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, brace_stance_first_slip(&stance, &more, 100.0, &state, &slip));
    TEST_ASSERT_DOUBLE_WITHIN(EXACT, 1.0, slip.factor);
    TEST_ASSERT_EQUAL_INT(BRACE_FOOT_LET_GO, slip.contact);
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_E_NO_REST, settle(&stance, 0.0, -41.0, &state));
}

static void test_what_is_left_when_a_foot_is_lifted(void)
{
    const brace_stance_t stance = on_corners(2.0, 2.0, 5.0);
    brace_stance_state_t state = placed(&stance);
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, settle(&stance, 0.0, -20.0, &state));
    brace_stance_lift(&state, 1);
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_OK, settle(&stance, 0.0, -20.0, &state));
    /* the middle lies on the line of two of the three that are left */
    TEST_ASSERT_DOUBLE_WITHIN(0.2, 10.0, state.foot[0].force_n[2]);
    TEST_ASSERT_DOUBLE_WITHIN(0.2, 0.0, state.foot[3].force_n[2]);
    TEST_ASSERT_EQUAL_INT(BRACE_FOOT_LET_GO, state.foot[1].contact);
}

/* --------------------------------------------------------------------------------------------- what is refused -- */

static void test_two_feet_hold_no_body(void)
{
    brace_stance_t stance = {.limb_count = 0};
    stand_limb(&stance, 100.0, 0.0, 2.0, 0.5);
    stand_limb(&stance, -100.0, 0.0, 2.0, 0.5);
    brace_stance_state_t state = placed(&stance);
    const brace_stance_state_t before = state;
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_E_LOOSE, settle(&stance, 0.0, -10.0, &state));
    TEST_ASSERT_EQUAL_MEMORY(&before, &state, sizeof state);
}

static void test_numbers_that_are_none_are_refused(void)
{
    const double bad[] = {NAN, INFINITY, -INFINITY, 1e300};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        brace_stance_t stance = on_corners(2.0, 2.0, 0.5);
        brace_stance_state_t state = placed(&stance);
        const brace_stance_state_t before = state;
        TEST_ASSERT_EQUAL_INT(BRACE_STANCE_E_INPUT, settle(&stance, bad[i], -10.0, &state));
        stance.limb[2].k_n_per_mm[4] = bad[i];
        TEST_ASSERT_EQUAL_INT(BRACE_STANCE_E_INPUT, settle(&stance, 0.0, -10.0, &state));
        TEST_ASSERT_EQUAL_MEMORY(&before, &state, sizeof state);
        TEST_ASSERT_EQUAL_INT(BRACE_STANCE_E_INPUT, brace_stance_place(&stance, NULL, &state));
    }
    brace_stance_t stance = on_corners(2.0, 2.0, 0.5);
    brace_stance_state_t state = placed(&stance);
    stance.limb[0].normal[2] = 2.0;
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_E_INPUT, settle(&stance, 0.0, -10.0, &state));
    stance.limb_count = BRACE_STANCE_LIMBS + 1;
    TEST_ASSERT_EQUAL_INT(BRACE_STANCE_E_INPUT, settle(&stance, 0.0, -10.0, &state));
    for (int status = -3; status <= 0; status++) {
        TEST_ASSERT_NOT_NULL(brace_stance_status_text(status));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_stiffer_limbs_carry_more);
    RUN_TEST(test_a_load_aside_turns_the_body);
    RUN_TEST(test_a_foothold_that_is_off_loads_its_limb);
    RUN_TEST(test_preloaded_legs_are_softer_along_the_ground);
    RUN_TEST(test_feet_slide_at_friction_times_weight);
    RUN_TEST(test_a_slip_leaves_forces_behind);
    RUN_TEST(test_a_foot_opens_and_comes_down_again);
    RUN_TEST(test_grips_hold_a_body_under_a_ceiling);
    RUN_TEST(test_what_is_left_when_a_foot_is_lifted);
    RUN_TEST(test_two_feet_hold_no_body);
    RUN_TEST(test_numbers_that_are_none_are_refused);
    return UNITY_END();
}
