/* The search for a limb's buckling load in space, a step in two ticks: how old its result may be, and who goes
 * first. */
#include <string.h>

#include "stiffness/softening.h"

#include "app_bench.h"

static softening_t softening;
static model_t model;
static brace_parameters_t parameters;
static const float unbent_rad[BRACE_LINK_COUNT] = {0.0f, 1.0f, 1.4f};

/* The limb comes to rest under some times (-8, 1, 20) N. */
static void rest_under(float times)
{
    const float load_n_mm[BRACE_LINK_COUNT] = {0.0f, 0.0f, 0.0f}, temp_degc[BRACE_LINK_COUNT] = {25.0f, 25.0f, 25.0f};
    const brace_vec3_t tip_n = {-8.0f * times, 1.0f * times, 20.0f * times}, down = {0.0f, 0.0f, -1.0f};
    brace_loaded_joint_t springs[BRACE_LINK_COUNT];
    model_rest_t rest;
    rest.buckling_factor = 7.0f; /* for a limb in space the search finds the factor later */
    model_springs(&model, &parameters, load_n_mm, temp_degc, springs);
    TEST_ASSERT_EQUAL(BRACE_OK,
                      model_loaded(&model, &parameters.limb, unbent_rad, springs, tip_n, down, &softening.now, &rest));
    TEST_ASSERT_TRUE(isnan(rest.buckling_factor));
}

void setUp(void)
{
    parameters = bench_parameters();
    parameters.limb = sample_limb[SAMPLE_BEAM];
    bench_model(&model, &parameters, true);
    softening_start(&softening);
    rest_under(1.0f);
}

void tearDown(void) {}

static void step(bool is_counted, bool may_work)
{
    softening_age(&softening, is_counted);
    if (may_work && (softening_is_due(&softening) || softening_is_overdue(&softening))) {
        softening_work(&softening, &model, &parameters.limb, unbent_rad);
    }
}

/* Before the first search nothing is known, and nothing that is not known is a number. */
static void test_a_start_knows_nothing(void)
{
    memset(&softening, 0x5a, sizeof softening);
    softening_start(&softening);
    TEST_ASSERT_TRUE(isnan(softening.factor));
    TEST_ASSERT_EQUAL_HEX32(0, softening.unloaded.flags); /* there is nothing that a flag could doubt */
    TEST_ASSERT_TRUE(isnan(softening.unloaded.k_xx_n_per_mm));
    TEST_ASSERT_TRUE(isnan(softening.unloaded.stiff_axis_rad));
    TEST_ASSERT_TRUE(isnan(softening.unloaded_across_n_per_mm));
}

/* Runs the search until it has found a factor. returns how many steps that took */
static int until_reported(void)
{
    int count = 0;
    for (; count < 500 && isnan(softening.factor); count++) {
        step(true, true);
    }
    TEST_ASSERT_TRUE(count < 500);
    return count;
}

static void test_a_search_ends_and_is_repeated(void)
{
    TEST_ASSERT_TRUE(isnan(softening.factor));
    TEST_ASSERT_TRUE(isnan(softening.unloaded.k_xx_n_per_mm));
    TEST_ASSERT_EQUAL_HEX32(0, softening_flags(&softening));
    const int first = until_reported();
    TEST_ASSERT_TRUE(softening.factor > 1.0f);
    TEST_ASSERT_FALSE(isnan(softening.unloaded.k_xx_n_per_mm) || isnan(softening.unloaded_across_n_per_mm));
    const float factor = softening.factor;
    softening.factor = 1.0f; /* what a next search finds replaces it */
    int more = 0;
    for (; more < 500 && softening.factor == 1.0f; more++) {
        step(true, true);
    }
    TEST_ASSERT_EQUAL_FLOAT(factor, softening.factor);
    TEST_ASSERT_TRUE(first <= 43 && more <= 43 && more >= first - 6);
}

/* Each search is of the load that is there when it begins. Half of the force has a larger factor, at most twice: the
 * weight stays, and the limb stands more upright. */
static void test_a_search_is_of_its_own_load(void)
{
    (void)until_reported();
    const float whole = softening.factor;
    rest_under(0.5f);
    softening.factor = __builtin_nanf("");
    (void)until_reported();
    TEST_ASSERT_TRUE(softening.factor > 1.3f * whole && softening.factor < 2.0f * whole);
}

/* While the search may not work, the factor found last counts for 240 ticks, and K without load stays. When the load
 * goes, the factor goes at once. */
static void test_a_factor_grows_old(void)
{
    (void)until_reported();
    const float factor = softening.factor;
    for (int i = 1; i < 240; i++) {
        step(true, false);
        TEST_ASSERT_EQUAL_FLOAT(factor, softening.factor);
    }
    step(true, false);
    TEST_ASSERT_TRUE(isnan(softening.factor));
    for (int i = 0; i < 300; i++) {
        step(true, false);
        TEST_ASSERT_TRUE(isnan(softening.factor));
    }
    (void)until_reported();
    step(false, true);
    TEST_ASSERT_TRUE(isnan(softening.factor));
    TEST_ASSERT_FALSE(softening.runs || softening.is_needed);
}

/* The search takes three of eight ticks, K without load one of them; whoever asks goes first for seven more. */
static void test_a_step_comes_every_second_tick(void)
{
    static const uint8_t step_of_round[] = {1, 2, 3, 0, 1};
    for (int i = 0; i < 5; i++) {
        step(true, true); /* the first tick has it */
        TEST_ASSERT_EQUAL(0, softening.ticks_since_step);
        TEST_ASSERT_EQUAL(i > 0, softening.runs);
        TEST_ASSERT_EQUAL(step_of_round[i], softening.step_of_round);
        step(true, true);
        TEST_ASSERT_FALSE(softening_is_due(&softening));
    }
    softening_work(&softening, &model, &parameters.limb, unbent_rad);
    for (int i = 0; i < 8; i++) {
        step(true, false);
        TEST_ASSERT_FALSE(softening_is_overdue(&softening));
    }
    step(true, false);
    TEST_ASSERT_TRUE(softening_is_overdue(&softening));
    step(true, true);
    TEST_ASSERT_EQUAL(0, softening.ticks_since_step);
    for (int i = 0; i < 300; i++) {
        step(true, false);
    }
    TEST_ASSERT_EQUAL(UINT8_MAX, softening.ticks_since_step);
    TEST_ASSERT_TRUE(softening_is_overdue(&softening));
    step(false, false);
    TEST_ASSERT_FALSE(softening_is_overdue(&softening));
}

/* What has no tick to spare waits for the next even one, until it is overdue. */
static void test_a_step_that_was_put_off_is_due_every_second_tick(void)
{
    softening_work(&softening, &model, &parameters.limb, unbent_rad);
    for (int i = 1; i <= 8; i++) {
        step(true, false);
        TEST_ASSERT_EQUAL(i % 2 == 0, softening_is_due(&softening));
    }
}

static void test_near_its_buckling_the_limb_is_flagged(void)
{
    softening.factor = 2.9f;
    TEST_ASSERT_EQUAL_HEX32(BRACE_FLAG_SOFTENED, softening_flags(&softening));
    softening.factor = 3.1f;
    TEST_ASSERT_EQUAL_HEX32(0, softening_flags(&softening));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_start_knows_nothing);
    RUN_TEST(test_a_search_ends_and_is_repeated);
    RUN_TEST(test_a_search_is_of_its_own_load);
    RUN_TEST(test_a_factor_grows_old);
    RUN_TEST(test_a_step_comes_every_second_tick);
    RUN_TEST(test_a_step_that_was_put_off_is_due_every_second_tick);
    RUN_TEST(test_near_its_buckling_the_limb_is_flagged);
    return UNITY_END();
}
