/* The last step of a loading test: the slopes beside the model's, in sigmas of both. */
#include <math.h>

#include "brace/uncertainty.h"
#include "jobs/loading/loading.h"
#include "loading_bench.h"

static brace_loading_t test;
static loading_inputs_t inputs;

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    stand(&p);
    inputs = controller_loading_inputs(&app.controller, now());
    memset(&test, 0, sizeof test);
    test.result.theta1_rad = 1.0f, test.result.theta2_rad = 1.4f;
    test.model = now()->stiffness.engaged;
    test.result.least_squares.k_x_n_per_mm = 21.0f, test.result.least_squares.k_z_n_per_mm = -3.0f;
    test.result.least_squares.sigma_k_x_n_per_mm = 0.4f, test.result.least_squares.sigma_k_z_n_per_mm = 0.3f;
}

void tearDown(void) {}

static const brace_loading_result_t *compared(brace_axis_t axis)
{
    static brace_recorder_t recorder;
    loading_reading_t reading;
    test.result.setup.axis = axis;
    test.result.outcome = BRACE_LOADING_RUNNING;
    test.phase = LOADING_COMPARE;
    TEST_ASSERT_TRUE(loading_work(&test, &inputs, &recorder, &reading));
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, test.result.outcome);
    return &test.result;
}

static void assert_score(double slope, double sigma_slope, float model, float sigma_model, float score)
{
    const double sigma = sqrt(sigma_slope * sigma_slope + (double)sigma_model * (double)sigma_model);
    ASSERT_CLOSE((slope - (double)model) / sigma, score, 1e-4 * fabs((slope - (double)model) / sigma));
}

/* A push along x measures the column of x, one along z that of z. */
static void test_each_slope_beside_its_entry_of_the_model(void)
{
    const brace_stiffness_t *k = &test.model;
    brace_stiffness_sigma_t sigma;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_uncertainty_known(&inputs.parameters->limb, 1.0f, 1.4f, k, &sigma));
    const brace_loading_result_t *r = compared(BRACE_AXIS_X);
    TEST_ASSERT_EQUAL_FLOAT(k->k_xx_n_per_mm, r->model_k_x_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(k->k_xz_n_per_mm, r->model_k_z_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(sigma.k_xx_n_per_mm, r->sigma_model_k_x_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(sigma.k_xz_n_per_mm, r->sigma_model_k_z_n_per_mm);
    assert_score(21.0, 0.4, k->k_xx_n_per_mm, sigma.k_xx_n_per_mm, r->z_x);
    assert_score(-3.0, 0.3, k->k_xz_n_per_mm, sigma.k_xz_n_per_mm, r->z_z);
    r = compared(BRACE_AXIS_Z);
    TEST_ASSERT_EQUAL_FLOAT(k->k_xz_n_per_mm, r->model_k_x_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(k->k_zz_n_per_mm, r->model_k_z_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(sigma.k_xz_n_per_mm, r->sigma_model_k_x_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(sigma.k_zz_n_per_mm, r->sigma_model_k_z_n_per_mm);
    assert_score(21.0, 0.4, k->k_xz_n_per_mm, sigma.k_xz_n_per_mm, r->z_x);
    assert_score(-3.0, 0.3, k->k_zz_n_per_mm, sigma.k_zz_n_per_mm, r->z_z);
}

/* Where the sigma of the model is not known, the score is not a number. */
static void test_a_model_of_unknown_sigma_has_no_score(void)
{
    for (int axis = BRACE_AXIS_X; axis <= BRACE_AXIS_Z; axis++) {
        test.result.theta1_rad = 1.0f;
        const brace_loading_result_t *r = compared((brace_axis_t)axis);
        TEST_ASSERT_FALSE(isnan(r->sigma_model_k_x_n_per_mm) || isnan(r->z_x));
        test.result.theta1_rad = NAN;
        r = compared((brace_axis_t)axis);
        TEST_ASSERT_TRUE(isnan(r->sigma_model_k_x_n_per_mm) && isnan(r->sigma_model_k_z_n_per_mm));
        TEST_ASSERT_TRUE(isnan(r->z_x) && isnan(r->z_z));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_slope_beside_its_entry_of_the_model);
    RUN_TEST(test_a_model_of_unknown_sigma_has_no_score);
    return UNITY_END();
}
