/* Tests of the tip's sensor alone: the force comes back from its readings through any sensor model; readings at
 * saturation are refused; an old reading counts for a limited time. */
#include <math.h>
#include <string.h>

#include "sense/tip_force.h"
#include "unity.h"

enum { TICK_US = 1000 };

static tip_force_t force;
static brace_parameters_t parameters;
static float x_n, z_n;
static int32_t answer;

static int32_t tip_force_read_fake(void *context, float *reported_x_n, float *reported_z_n)
{
    (void)context;
    *reported_x_n = x_n, *reported_z_n = z_n;
    return answer;
}

static const brace_hal_t hal = {.tip_force_read = tip_force_read_fake};
static const brace_hal_t none = {.tip_force_read = NULL};

void setUp(void)
{
    memset(&parameters, 0, sizeof parameters);
    parameters.sensor = (brace_sensor_t){.gain = 1.0f, .saturation_n = INFINITY};
    parameters.controller.tick_us = TICK_US;
    parameters.controller.age_limit_us = 5000;
    x_n = 3.0f, z_n = -4.0f, answer = BRACE_HAL_OK;
    tip_force_configure(&force, &hal, &parameters.sensor);
}

void tearDown(void) {}

/* After a reading that cannot be used, the force keeps its last known value. */
static void test_a_reading_that_is_not_used_changes_nothing(void)
{
    parameters.sensor.saturation_n = 50.0f;
    tip_force_configure(&force, &hal, &parameters.sensor);
    tip_force_read(&force, &hal, &parameters, TICK_US);
    TEST_ASSERT_TRUE(force.known);
    x_n = 60.0f, z_n = 1.0f;
    tip_force_read(&force, &hal, &parameters, TICK_US);
    TEST_ASSERT_FALSE(force.known);
    TEST_ASSERT_EQUAL_FLOAT(3.0f, force.x_n);
    TEST_ASSERT_EQUAL_FLOAT(-4.0f, force.z_n);
}

/* reading = bias + gain R [[1, xz], [zx, 1]] force, where R is a rotation (docs/physics.md). */
static void test_the_sensor_s_model_is_undone(void)
{
    for (int i = 0; i < 200; i++) {
        const float turn = -3.0f + 0.03f * (float)i;
        const float xz = 0.3f * sinf(1.7f * (float)i), zx = 0.3f * cosf(2.9f * (float)i);
        parameters.sensor = (brace_sensor_t){.bias_x_n = 2.0f * sinf((float)i),
                                             .bias_z_n = -1.5f + 0.02f * (float)i,
                                             .gain = 0.5f + 0.01f * (float)i,
                                             .rotation_rad = turn,
                                             .crosstalk_xz = xz,
                                             .crosstalk_zx = zx,
                                             .saturation_n = INFINITY};
        tip_force_configure(&force, &hal, &parameters.sensor);
        TEST_ASSERT_TRUE(force.fitted && !force.known);
        const double is_x = 7.0 * cos(0.3 * i), is_z = 7.0 * sin(0.3 * i);
        const double mixed_x = is_x + (double)xz * is_z, mixed_z = (double)zx * is_x + is_z;
        const double c = cos((double)turn), s = sin((double)turn), gain = (double)parameters.sensor.gain;
        x_n = (float)((double)parameters.sensor.bias_x_n + gain * (c * mixed_x - s * mixed_z));
        z_n = (float)((double)parameters.sensor.bias_z_n + gain * (s * mixed_x + c * mixed_z));
        tip_force_read(&force, &hal, &parameters, TICK_US);
        TEST_ASSERT_TRUE(force.known);
        TEST_ASSERT_DOUBLE_WITHIN(2e-5, is_x, (double)force.x_n);
        TEST_ASSERT_DOUBLE_WITHIN(2e-5, is_z, (double)force.z_n);
    }
}

static void test_without_a_sensor_or_an_inverse_there_is_no_force(void)
{
    tip_force_configure(&force, &none, &parameters.sensor);
    TEST_ASSERT_FALSE(force.fitted);
    tip_force_read(&force, &none, &parameters, TICK_US);
    TEST_ASSERT_FALSE(force.known);
    /* both axes read the same, so the model has no inverse */
    parameters.sensor.crosstalk_xz = parameters.sensor.crosstalk_zx = 1.0f;
    tip_force_configure(&force, &hal, &parameters.sensor);
    TEST_ASSERT_FALSE(force.fitted);
    parameters.sensor = (brace_sensor_t){.gain = 1.0f, .saturation_n = INFINITY, .rotation_rad = NAN};
    tip_force_configure(&force, &hal, &parameters.sensor);
    TEST_ASSERT_FALSE(force.fitted);
    tip_force_read(&force, &hal, &parameters, TICK_US);
    TEST_ASSERT_FALSE(force.known);
    /* The determinant must be at least 1e-3. A gain of 0.04 has 1.6e-3, a gain of 0.03 has 9e-4. */
    parameters.sensor = (brace_sensor_t){.gain = -0.04f, .saturation_n = INFINITY};
    tip_force_configure(&force, &hal, &parameters.sensor);
    TEST_ASSERT_TRUE(force.fitted);
    parameters.sensor.gain = 0.03f;
    tip_force_configure(&force, &hal, &parameters.sensor);
    TEST_ASSERT_FALSE(force.fitted);
}

static void test_a_saturated_reading_is_not_known(void)
{
    float *const axes[] = {&x_n, &z_n};
    for (int i = 0; i < 8; i++) {
        const float sign = i % 2 == 0 ? 1.0f : -1.0f, saturation_n = i < 4 ? 50.0f : INFINITY;
        setUp();
        parameters.sensor.saturation_n = saturation_n;
        const float most_n = i < 4 ? 50.0f : 1e6f;
        float *const axis = axes[i / 2 % 2];
        *axis = sign * nextafterf(most_n, 0.0f);
        tip_force_read(&force, &hal, &parameters, TICK_US);
        TEST_ASSERT_TRUE(force.known);
        *axis = sign * most_n;
        tip_force_read(&force, &hal, &parameters, TICK_US);
        TEST_ASSERT_FALSE(force.known);
        *axis = sign * 2.0f * most_n;
        tip_force_read(&force, &hal, &parameters, TICK_US);
        TEST_ASSERT_FALSE(force.known);
        *axis = NAN;
        tip_force_read(&force, &hal, &parameters, TICK_US);
        TEST_ASSERT_FALSE(force.known);
    }
}

/* A sensor that has nothing new repeats its reading, which counts for as long as the limit says. One that fails reports
 * nothing in that tick. */
static void test_how_long_an_old_reading_counts(void)
{
    answer = BRACE_HAL_AGAIN;
    tip_force_read(&force, &hal, &parameters, TICK_US);
    TEST_ASSERT_FALSE(force.known); /* the sensor has reported nothing yet */
    answer = BRACE_HAL_OK;
    tip_force_read(&force, &hal, &parameters, TICK_US);
    TEST_ASSERT_TRUE(force.known);
    TEST_ASSERT_EQUAL_UINT32(0, force.age_us);
    answer = BRACE_HAL_AGAIN;
    for (uint32_t tick = 1; tick <= 7u; tick++) {
        tip_force_read(&force, &hal, &parameters, TICK_US);
        TEST_ASSERT_EQUAL(tick <= 5u, force.known);
        TEST_ASSERT_EQUAL_UINT32(tick * TICK_US, force.age_us);
    }
    answer = BRACE_HAL_OK;
    tip_force_read(&force, &hal, &parameters, TICK_US);
    TEST_ASSERT_TRUE(force.known);
    answer = BRACE_HAL_E_DEVICE;
    tip_force_read(&force, &hal, &parameters, TICK_US);
    TEST_ASSERT_FALSE(force.known);
    TEST_ASSERT_EQUAL_UINT32(TICK_US, force.age_us);
    answer = BRACE_HAL_AGAIN; /* the reading before is still young enough */
    tip_force_read(&force, &hal, &parameters, TICK_US);
    TEST_ASSERT_TRUE(force.known);
}

/* The reading that a late tick repeats is as old as the clock says, and no age wraps round. */
static void test_a_late_tick_makes_an_old_reading(void)
{
    answer = BRACE_HAL_OK;
    tip_force_read(&force, &hal, &parameters, TICK_US);
    answer = BRACE_HAL_AGAIN;
    tip_force_read(&force, &hal, &parameters, 6u * TICK_US);
    TEST_ASSERT_FALSE(force.known);
    TEST_ASSERT_EQUAL_UINT32(6u * TICK_US, force.age_us);
    for (int i = 0; i < 3; i++) {
        tip_force_read(&force, &hal, &parameters, UINT32_MAX - TICK_US);
        TEST_ASSERT_FALSE(force.known);
        TEST_ASSERT_EQUAL_HEX32(0x40000000u, force.age_us);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_reading_that_is_not_used_changes_nothing);
    RUN_TEST(test_the_sensor_s_model_is_undone);
    RUN_TEST(test_without_a_sensor_or_an_inverse_there_is_no_force);
    RUN_TEST(test_a_saturated_reading_is_not_known);
    RUN_TEST(test_how_long_an_old_reading_counts);
    RUN_TEST(test_a_late_tick_makes_an_old_reading);
    return UNITY_END();
}
