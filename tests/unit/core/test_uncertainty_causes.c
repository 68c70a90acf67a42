/* K's uncertainty by changing one input at a time: which inputs count where, what it agrees with, what is refused. That
 * three sigmas hold K, under loads too: tests/judges/engine/test_core_uncertainty.py. */
#include <string.h>

#include "brace/general.h"
#include "brace/uncertainty_causes.h"
#include "close.h"
#include "noise.h"

static const brace_gravity_t weightless = {0};
static brace_limb_t limb;

void setUp(void)
{
    noise_state = 362436069u;
    limb = (brace_limb_t){.coxa_mm = 50.0f, .femur_mm = 110.0f, .tibia_mm = 140.0f};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        limb.link[i] = (brace_link_t){0.002f, 0.08f, 0.1f, 0.06f, 1e-6f, 0.7f};
        limb.joint[i].compliance_rad_per_n_mm = 9e-6f;
    }
    limb.base = (brace_base_t){0.003f, 0.004f, 2e-7f};
    limb.uncertainty = (brace_uncertainty_t){0.3f, 0.003f, 0.04f, 0.02f};
}

void tearDown(void) {}

static brace_loaded_joint_t spring_of(int index)
{
    const float compliance_rad_per_n_mm = limb.joint[index].compliance_rad_per_n_mm;
    return (brace_loaded_joint_t){compliance_rad_per_n_mm, compliance_rad_per_n_mm};
}

static brace_load_t load_of(float x_n, float z_n)
{
    return (brace_load_t){{x_n, z_n}, {0.0f, -1.0f}, spring_of(BRACE_FEMUR), spring_of(BRACE_TIBIA)};
}

static brace_space_load_t space_load_of(float x_n, float y_n, float z_n)
{
    return (brace_space_load_t){
        {x_n, y_n, z_n}, {0.0f, 0.0f, -1.0f}, spring_of(BRACE_COXA), spring_of(BRACE_FEMUR), spring_of(BRACE_TIBIA)};
}

/* The formula of brace/uncertainty.h is a derivative; here it is a quarter of a sigma's change, to first order the
 * same. The second order of a cause of 4 % is 1 % of it. */
static void test_at_no_load_it_agrees_with_the_formula(void)
{
    for (int i = 0; i < 200; i++) {
        const float theta1_rad = 2.0f * (float)noise_uniform(), theta2_rad = 0.4f + 1.8f * (float)noise_uniform();
        const float hip = limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm + limb.base.rotation_rad_per_n_mm;
        const brace_load_t load = load_of(0.0f, 0.0f);
        brace_general_t general;
        brace_stiffness_t k;
        brace_stiffness_sigma_t formula, changed;
        brace_general_collapse(&limb, &general);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_general_stiffness(&general, theta1_rad, theta2_rad, hip,
                                                            limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm, &k));
        TEST_ASSERT_EQUAL(BRACE_OK, brace_uncertainty_stiffness(&limb, theta1_rad, theta2_rad, &k, &formula));
        TEST_ASSERT_EQUAL(BRACE_OK,
                          brace_uncertainty_loaded(&limb, &weightless, theta1_rad, theta2_rad, &load, &changed));
        ASSERT_CLOSE(1.0, changed.k_xx_n_per_mm / formula.k_xx_n_per_mm, 0.03);
        ASSERT_CLOSE(1.0, changed.k_xz_n_per_mm / formula.k_xz_n_per_mm, 0.03);
        ASSERT_CLOSE(1.0, changed.k_zz_n_per_mm / formula.k_zz_n_per_mm, 0.03);
        ASSERT_CLOSE(1.0, changed.lambda_min_n_per_mm / formula.lambda_min_n_per_mm, 0.03);
        ASSERT_CLOSE(1.0, changed.lambda_max_n_per_mm / formula.lambda_max_n_per_mm, 0.03);
        ASSERT_CLOSE(1.0, changed.stiff_axis_rad / formula.stiff_axis_rad, 0.05);
    }
}

/* How many causes change something. */
static uint32_t causes(bool is_spatial)
{
    uint32_t count = 0;
    for (uint32_t cause = 0; cause < BRACE_CAUSE_COUNT; cause++) {
        brace_k_inputs_t inputs = {.limb = limb, .tip_n = {1.0f, 0.0f, 2.0f}}, before;
        for (int i = 0; i < BRACE_LINK_COUNT; i++) {
            inputs.spring[i] = spring_of(i);
            inputs.angle_sigma_rad[i] = limb.uncertainty.angle_rad;
        }
        inputs.sensor_gain_rel = limb.uncertainty.gain_rel;
        before = inputs;
        const bool changes = brace_cause_change(cause, is_spatial, &inputs);
        TEST_ASSERT_EQUAL(changes, memcmp(&before, &inputs, sizeof inputs) != 0);
        count += changes ? 1u : 0u;
    }
    return count;
}

static void test_only_what_is_uncertain_and_plays_a_part_is_changed(void)
{
    TEST_ASSERT_EQUAL(2 + 2 + 4 + 2 + 3 + 2, causes(false)); /* angles, lengths, links, joints, base, gains */
    TEST_ASSERT_EQUAL(2 + 3 + 12 + 3 + 3 + 2, causes(true));
    limb.base = (brace_base_t){0.0f, 0.0f, 0.0f};
    TEST_ASSERT_EQUAL(2 + 2 + 4 + 2 + 2, causes(false));
    limb.uncertainty = (brace_uncertainty_t){0.0f, 0.0f, 0.0f, 0.0f};
    TEST_ASSERT_EQUAL(0, causes(true));
}

static void test_a_limb_known_exactly_has_no_sigma(void)
{
    const brace_load_t load = load_of(3.0f, -8.0f);
    brace_stiffness_sigma_t sigma;
    limb.uncertainty = (brace_uncertainty_t){0.0f, 0.0f, 0.0f, 0.0f};
    TEST_ASSERT_EQUAL(BRACE_OK, brace_uncertainty_loaded(&limb, &weightless, 0.4f, 1.2f, &load, &sigma));
    TEST_ASSERT_TRUE(sigma.k_xx_n_per_mm == 0.0f && sigma.lambda_max_n_per_mm == 0.0f && sigma.stiff_axis_rad == 0.0f);
}

/* Without a load, a sensor that read 2 % too much in the calibration makes K 2 % too large. */
static void test_the_calibration_s_gain_scales_all_of_K(void)
{
    const float theta_rad[] = {0.0f, 0.4f, 1.2f};
    const brace_space_load_t load = space_load_of(0.0f, 0.0f, 0.0f);
    brace_loaded_space_t loaded;
    brace_space_rest_t rest;
    brace_space_result_t found;
    brace_k_sigma_t sigma;
    limb.uncertainty = (brace_uncertainty_t){0.0f, 0.0f, 0.0f, 0.02f};
    brace_loaded_space_collapse(&limb, &weightless, &loaded);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_loaded_space_settle(&loaded, 0.4f, 1.2f, &load, &rest));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_loaded_space_stiffness(&loaded, &rest, &found));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_uncertainty_loaded_space(&limb, &weightless, theta_rad, &load, &sigma));
    const double most = 1e-3 * (double)found.k.xx_n_per_mm; /* rounding of a difference of half a per cent */
    ASSERT_CLOSE(0.02 * (double)found.k.xx_n_per_mm, sigma.space.k_xx_n_per_mm, most);
    ASSERT_CLOSE(0.02 * (double)found.k.yy_n_per_mm, sigma.space.k_yy_n_per_mm, most);
    ASSERT_CLOSE(0.02 * (double)found.k.yy_n_per_mm, sigma.space.across_n_per_mm, most);
    ASSERT_CLOSE(0.02 * fabs((double)found.k.xz_n_per_mm), sigma.space.k_xz_n_per_mm, most);
}

static void test_what_has_no_K_or_is_no_limb_has_no_sigma(void)
{
    const brace_load_t good = load_of(3.0f, -8.0f), folds = load_of(-4000.0f, 0.0f), absurd = load_of(NAN, 0.0f);
    const brace_space_load_t good_in_space = space_load_of(3.0f, 1.0f, -8.0f);
    const float theta_rad[] = {0.1f, 0.4f, 1.2f}, too_far_rad[] = {9.0f, 0.4f, 1.2f};
    brace_stiffness_sigma_t sigma, before;
    brace_k_sigma_t in_space;
    memset(&sigma, 0x5a, sizeof sigma);
    before = sigma;
    TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, brace_uncertainty_loaded(&limb, &weightless, 0.4f, 1.2f, &folds, &sigma));
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, brace_uncertainty_loaded(&limb, &weightless, 0.4f, 1.2f, &absurd, &sigma));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_uncertainty_loaded(&limb, &weightless, 9.0f, 1.2f, &good, &sigma));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_uncertainty_loaded(NULL, &weightless, 0.4f, 1.2f, &good, &sigma));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_uncertainty_loaded(&limb, NULL, 0.4f, 1.2f, &good, &sigma));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_uncertainty_loaded(&limb, &weightless, 0.4f, 1.2f, NULL, &sigma));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_uncertainty_loaded(&limb, &weightless, 0.4f, 1.2f, &good, NULL));
    TEST_ASSERT_EQUAL(0, memcmp(&before, &sigma, sizeof sigma));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE,
                      brace_uncertainty_loaded_space(&limb, &weightless, too_far_rad, &good_in_space, &in_space));
    TEST_ASSERT_EQUAL(BRACE_E_NULL,
                      brace_uncertainty_loaded_space(&limb, &weightless, NULL, &good_in_space, &in_space));
    limb.femur_mm = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_uncertainty_loaded(&limb, &weightless, 0.4f, 1.2f, &good, &sigma));
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER,
                      brace_uncertainty_loaded_space(&limb, &weightless, theta_rad, &good_in_space, &in_space));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_at_no_load_it_agrees_with_the_formula);
    RUN_TEST(test_only_what_is_uncertain_and_plays_a_part_is_changed);
    RUN_TEST(test_a_limb_known_exactly_has_no_sigma);
    RUN_TEST(test_the_calibration_s_gain_scales_all_of_K);
    RUN_TEST(test_what_has_no_K_or_is_no_limb_has_no_sigma);
    return UNITY_END();
}
