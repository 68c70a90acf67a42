/* The loading test through the controller: its slopes, its comparison with the model, its rows. */
#include "loading_bench.h"
#include "jobs/loading/levers.h"
#include "jobs/loading/reading.h"

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    stand(&p);
}

void tearDown(void) {}

/* The motors come within 1 % of a step of where they are wanted. Along the axis that is measured; across
 * it the model takes its force off, and the model here is a tenth of K_xx off the truth: 1e-3 of it. The
 * encoders' last place, 6e-8 rad at levers of 450 mm against steps of 0.6 mm, is 5e-5. */
#define SLOPE_ERROR 1.5e-3

static void test_the_slope_along_x_is_the_first_column_of_K(void)
{
    run(&along_x);
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
    TEST_ASSERT_EQUAL(17, result()->rows);
    TEST_ASSERT_TRUE(result()->force_is_sensed);
    ASSERT_CLOSE(3.5, result()->least_squares.k_x_n_per_mm, 3.5 * SLOPE_ERROR);
    ASSERT_CLOSE(-0.5, result()->least_squares.k_z_n_per_mm, 3.5 * SLOPE_ERROR);
    ASSERT_CLOSE(3.5, result()->mean_of_ratios.k_x_n_per_mm, 3.5 * SLOPE_ERROR);
    ASSERT_CLOSE(1.0, result()->preload_x_n, 1e-3);
    ASSERT_CLOSE(6.0, result()->preload_z_n, 1e-3);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    ASSERT_CLOSE(0.0, fake.joint[BRACE_FEMUR].command.offset_rad, 0.0);
}

static void test_the_slope_along_z_is_the_second_column(void)
{
    brace_loading_setup_t along_z = along_x;
    along_z.axis = BRACE_AXIS_Z;
    run(&along_z);
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
    ASSERT_CLOSE(-0.5, result()->least_squares.k_x_n_per_mm, 3.5 * SLOPE_ERROR);
    ASSERT_CLOSE(0.6, result()->least_squares.k_z_n_per_mm, 3.5 * SLOPE_ERROR);
}

/* The model's own K, under the preload. */
static symmetric_t model_k(void)
{
    const brace_parameters_t p = bench_parameters();
    const brace_force_t preload = {(float)preload_x_n, (float)preload_z_n};
    const brace_stiffness_t k =
        equilibrium(&p, (float)theta1, (float)theta2, preload, (brace_vec_t){0.0f, -1.0f}).stiffness;
    return (symmetric_t){(double)k.k_xx_n_per_mm, (double)k.k_xz_n_per_mm, (double)k.k_zz_n_per_mm};
}

static void test_the_model_is_compared_in_sigmas(void)
{
    truth = model_k();
    run(&along_x);
    ASSERT_CLOSE(truth.xx, result()->model_k_x_n_per_mm, 1e-3);
    ASSERT_CLOSE(truth.xz, result()->model_k_z_n_per_mm, 1e-3);
    TEST_ASSERT_TRUE(fabsf(result()->z_x) < 0.5f);
    TEST_ASSERT_TRUE(fabsf(result()->z_z) < 0.5f);
    TEST_ASSERT_TRUE(result()->sigma_model_k_x_n_per_mm > 0.05f);
    truth.xx = 2.0;
    run(&along_x);
    TEST_ASSERT_TRUE(result()->z_x < -3.0f);
}

/* The model's K is worked out under the mean of the forces, which has less noise than a single force. */
static void test_the_model_is_that_under_the_mean_force(void)
{
    const brace_parameters_t p = bench_parameters();
    truth = model_k();
    noise_n = 0.5f;
    for (int axis = 0; axis < 2; axis++) {
        brace_loading_setup_t setup = along_x;
        setup.axis = axis == 0 ? BRACE_AXIS_X : BRACE_AXIS_Z;
        run(&setup);
        TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
        const brace_force_t mean = {result()->preload_x_n, result()->preload_z_n};
        const brace_stiffness_t k =
            equilibrium(&p, (float)theta1, (float)theta2, mean, (brace_vec_t){0.0f, -1.0f}).stiffness;
        ASSERT_CLOSE(axis == 0 ? k.k_xx_n_per_mm : k.k_xz_n_per_mm, result()->model_k_x_n_per_mm, 2e-3);
        ASSERT_CLOSE(axis == 0 ? k.k_xz_n_per_mm : k.k_zz_n_per_mm, result()->model_k_z_n_per_mm, 2e-3);
    }
}

static void test_noise_is_in_the_sigma_of_the_slope(void)
{
    noise_n = 0.5f;
    run(&along_x);
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
    const double sigma = (double)result()->least_squares.sigma_k_x_n_per_mm;
    TEST_ASSERT_TRUE(sigma > 1e-3 && sigma < 0.1);
    ASSERT_CLOSE(3.5, result()->least_squares.k_x_n_per_mm, 5.0 * sigma + 3.5 * SLOPE_ERROR);
}

static void test_commanded_displacement_has_the_servo_in_it(void)
{
    brace_loading_setup_t commanded = along_x;
    commanded.source = BRACE_LOADING_COMMANDED;
    run(&commanded);
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
    TEST_ASSERT_TRUE(result()->least_squares.k_x_n_per_mm < 3.0f); /* in line with the servos it is softer */
}

static void test_what_is_off_the_axis_is_taken_off_by_the_model(void)
{
    truth = model_k();
    run(&along_x);
    brace_loading_t *test = &app.controller.loading;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_slope_start(&test->slope, 0.0f, 0.0f, 0.0f));
    for (int i = 1; i <= 4; i++) { /* steps with a third of them across */
        test->dx_mm = 0.6f * (float)i;
        test->dz_mm = 0.2f * (float)i * (i % 2 == 0 ? 1.0f : -1.0f);
        const double x = (double)test->dx_mm, z = (double)test->dz_mm;
        TEST_ASSERT_TRUE(
            reading_add_to_slope(test, (float)(truth.xx * x + truth.xz * z), (float)(truth.xz * x + truth.zz * z)));
    }
    brace_slope_column_t column;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_slope_column(&test->slope, BRACE_SLOPE_LEAST_SQUARES, &column));
    ASSERT_CLOSE(truth.xx, column.k_x_n_per_mm, 2e-3);
    ASSERT_CLOSE(truth.xz, column.k_z_n_per_mm, 2e-3);
}

static void test_rows_are_a_pass_in_the_columns_of_a_dataset(void)
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        fake.joint[i].sample.temp_degc = 31.5f;
    }
    run(&along_x);
    TEST_ASSERT_EQUAL(17, brace_app_row_count(&app));
    static const int place[17] = {0, 1, 2, 3, 4, 3, 2, 1, 0, -1, -2, -3, -4, -3, -2, -1, 0};
    float before_s = 0.0f;
    for (uint32_t i = 0; i < 17; i++) {
        brace_row_t row;
        float value;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_row(&app, i, &row));
        TEST_ASSERT_EQUAL(i, row.step);
        TEST_ASSERT_EQUAL(1, row.run);
        TEST_ASSERT_EQUAL(1, row.config);
        TEST_ASSERT_EQUAL(0, row.rep);
        /* steps are where they were asked for, across the axis nothing: the servos are corrected */
        ASSERT_CLOSE(0.635 * place[i], row.dx_mm, 0.01);
        ASSERT_CLOSE(0.0, row.dz_mm, 0.02);
        /* the same displacement, the same force: f = f0 + K d */
        ASSERT_CLOSE(1.0 + 3.5 * (double)row.dx_mm - 0.5 * (double)row.dz_mm, row.fx_n, 2e-3);
        ASSERT_CLOSE(6.0 - 0.5 * (double)row.dx_mm + 0.6 * (double)row.dz_mm, row.fz_n, 2e-3);
        ASSERT_CLOSE(1.0, row.theta1_rad, 2e-3);
        ASSERT_CLOSE(31.5, row.temp_degc, 1e-3);
        TEST_ASSERT_TRUE(row.t_s > before_s);
        before_s = row.t_s;
        TEST_ASSERT_TRUE(isnan(row.enc1_rad));
        TEST_ASSERT_EQUAL(BRACE_OK, brace_row_value(&row, 9, &value));
        ASSERT_CLOSE(row.dx_mm, value, 0.0);
    }
}

/* Counter-clockwise by the tip force's moments about the joints, as physics has them, and counted from the preload. */
static void test_link_encoders_give_deflections_of_a_dataset(void)
{
    drive_rad_per_n_mm = 1.5e-5;
    ticks(50);
    run(&along_x);
    TEST_ASSERT_EQUAL(17, brace_app_row_count(&app));
    const double shank_x = tibia_mm * cos(theta1 - theta2), shank_z = tibia_mm * sin(theta1 - theta2);
    const double tip_x = femur_mm * cos(theta1) + shank_x, tip_z = femur_mm * sin(theta1) + shank_z;
    for (uint32_t i = 0; i < 17; i++) {
        brace_row_t row;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_row(&app, i, &row));
        const double fx = (double)row.fx_n - preload_x_n, fz = (double)row.fz_n - preload_z_n;
        /* an angle near 1.4 rad in float, twice */
        ASSERT_CLOSE(drive_rad_per_n_mm * (tip_x * fz - tip_z * fx), row.enc1_rad, 1e-6);
        ASSERT_CLOSE(drive_rad_per_n_mm * (shank_x * fz - shank_z * fx), row.enc2_rad, 1e-6);
        TEST_ASSERT_TRUE(i % 8u != 4u || fabs((double)row.enc2_rad) > 1e-4);
    }
}

/* The drift check's K, at the reference temperature, is K of now where the joints have it. Encoders behind the gears
 * measure the angles, so that no load turns them further for the one K nor for the other. */
static void test_the_drift_check_s_K_is_at_the_measured_posture(void)
{
    brace_parameters_t p = bench_parameters();
    p.slow.joint_compliance_per_degc = 0.01f;
    p.slow.reference_degc = 22.0f;
    stand(&p);
    drive_rad_per_n_mm = 1.5e-5;
    fake.joint[BRACE_FEMUR].sample.temp_degc = fake.joint[BRACE_TIBIA].sample.temp_degc = 22.0f;
    ticks(50);
    run(&along_x);
    const brace_stiffness_t *k = &app.controller.loading.model, *reference = &app.controller.loading.at_reference;
    TEST_ASSERT_TRUE(now()->load.is_counted);
    const double rounding = 1e-5 * (double)k->lambda_max_n_per_mm;
    ASSERT_CLOSE(k->k_xx_n_per_mm, reference->k_xx_n_per_mm, rounding);
    ASSERT_CLOSE(k->k_xz_n_per_mm, reference->k_xz_n_per_mm, rounding);
    ASSERT_CLOSE(k->k_zz_n_per_mm, reference->k_zz_n_per_mm, rounding);
}

/* What costs much comes one step of one job in a tick: while the drift check has the last reading to work on, the test
 * waits with its judgement. */
static void test_one_job_works_in_a_tick(void)
{
    const drift_job_t *drift = &app.controller.drift;
    int waited = 0;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    ticks(1);
    for (int i = 0; i < 60000 && app.controller.mode.now == BRACE_MODE_LOADING_TEST; i++) {
        const bool is_due = drift->has_reading || drift->reports || drift->foresees;
        const bool is_to_judge = app.controller.loading.phase == LOADING_JUDGE;
        ticks(1);
        if (is_due && is_to_judge) {
            waited++;
            TEST_ASSERT_EQUAL(LOADING_JUDGE, app.controller.loading.phase);
        }
    }
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
    TEST_ASSERT_GREATER_THAN(0, waited);
}

static void test_runs_repetitions_and_postures_are_counted(void)
{
    brace_loading_setup_t quick = along_x;
    quick.steps_per_side = 2;
    quick.dwell_us = 20000;
    run(&quick);
    run(&quick);
    TEST_ASSERT_EQUAL(2, result()->run);
    TEST_ASSERT_EQUAL(1, result()->config);
    TEST_ASSERT_EQUAL(1, result()->rep);
    quick.axis = BRACE_AXIS_Z;
    run(&quick);
    TEST_ASSERT_EQUAL(3, result()->run);
    TEST_ASSERT_EQUAL(0, result()->rep);
    fake.play = NULL;
    fake.joint[BRACE_FEMUR].sample.motor_rad = 0.8f;
    bench_believe();
    ticks(5);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &quick));
    TEST_ASSERT_EQUAL(2, result()->config);
}

static void test_a_row_s_columns_are_those_of_a_dataset(void)
{
    const brace_row_t row = {.run = 1,
                             .config = 2,
                             .theta1_rad = 3.0f,
                             .theta2_rad = 4.0f,
                             .axis = 5,
                             .rep = 6,
                             .step = 7,
                             .t_s = 8.0f,
                             .temp_degc = 9.0f,
                             .dx_mm = 10.0f,
                             .dz_mm = 11.0f,
                             .fx_n = 12.0f,
                             .fz_n = 13.0f,
                             .enc1_rad = 14.0f,
                             .enc2_rad = 15.0f};
    float value = 0.0f;
    for (uint32_t column = 0; column < (uint32_t)BRACE_ROW_COLUMNS; column++) {
        TEST_ASSERT_EQUAL(BRACE_OK, brace_row_value(&row, column, &value));
        TEST_ASSERT_EQUAL_FLOAT((float)(column + 1u), value);
    }
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_row_value(&row, BRACE_ROW_COLUMNS, &value));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_row_value(NULL, 0, &value));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_row_value(&row, 0, NULL));
    TEST_ASSERT_EQUAL_FLOAT(15.0f, value);
}

/* So many radians at the motors move the tip by a millimetre along the axis, and not across it. */
static void test_offsets_move_the_tip_along_the_axis(void)
{
    static brace_loading_t test;
    const brace_parameters_t p = bench_parameters();
    for (int i = 0; i < 40; i++) {
        float per_mm[2];
        const brace_axis_t axis = i % 2 == 0 ? BRACE_AXIS_X : BRACE_AXIS_Z;
        test.lever_femur = (brace_point_t){300.0f * cosf((float)i), 300.0f * sinf((float)i)};
        test.lever_knee = (brace_point_t){150.0f * cosf(2.3f * (float)i), 150.0f * sinf(2.3f * (float)i)};
        const float cross_mm2 =
            test.lever_femur.x_mm * test.lever_knee.z_mm - test.lever_femur.z_mm * test.lever_knee.x_mm;
        const bool is_there = levers_offsets_per_mm(&test, &p.limb, axis, per_mm);
        TEST_ASSERT_EQUAL(fabsf(cross_mm2) >= 0.05f * p.limb.femur_mm * p.limb.tibia_mm, is_there);
        if (is_there) {
            const float x_mm = per_mm[0] * test.lever_femur.x_mm + per_mm[1] * test.lever_knee.x_mm;
            const float z_mm = per_mm[0] * test.lever_femur.z_mm + per_mm[1] * test.lever_knee.z_mm;
            ASSERT_CLOSE(axis == BRACE_AXIS_X ? 1.0 : 0.0, x_mm, 1e-4);
            ASSERT_CLOSE(axis == BRACE_AXIS_Z ? 1.0 : 0.0, z_mm, 1e-4);
        }
    }
}

static void test_the_recorder_keeps_the_newest_rows(void)
{
    static brace_recorder_t recorder;
    brace_row_t row = {0};
    for (uint16_t i = 0; i < BRACE_RECORDER_ROWS + 10; i++) {
        row.step = i;
        brace_recorder_add(&recorder, &row);
    }
    TEST_ASSERT_EQUAL(BRACE_RECORDER_ROWS, recorder.count);
    TEST_ASSERT_EQUAL(10, recorder.lost);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_recorder_row(&recorder, 0, &row));
    TEST_ASSERT_EQUAL(10, row.step);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_recorder_row(&recorder, BRACE_RECORDER_ROWS - 1, &row));
    TEST_ASSERT_EQUAL(BRACE_RECORDER_ROWS + 9, row.step);
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_recorder_row(&recorder, BRACE_RECORDER_ROWS, &row));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_recorder_row(&recorder, BRACE_RECORDER_ROWS + 1, &row));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_recorder_row(&recorder, UINT32_MAX, &row));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_recorder_row(&recorder, 0, NULL));
    float value = 7.0f;
    for (uint32_t column = 0; column < BRACE_ROW_COLUMNS; column++) {
        TEST_ASSERT_EQUAL(BRACE_OK, brace_row_value(&row, column, &value));
    }
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_row_value(&row, BRACE_ROW_COLUMNS, &value));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_row_value(&row, 0, NULL));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_slope_along_x_is_the_first_column_of_K);
    RUN_TEST(test_the_slope_along_z_is_the_second_column);
    RUN_TEST(test_the_model_is_compared_in_sigmas);
    RUN_TEST(test_the_model_is_that_under_the_mean_force);
    RUN_TEST(test_noise_is_in_the_sigma_of_the_slope);
    RUN_TEST(test_commanded_displacement_has_the_servo_in_it);
    RUN_TEST(test_what_is_off_the_axis_is_taken_off_by_the_model);
    RUN_TEST(test_rows_are_a_pass_in_the_columns_of_a_dataset);
    RUN_TEST(test_link_encoders_give_deflections_of_a_dataset);
    RUN_TEST(test_the_drift_check_s_K_is_at_the_measured_posture);
    RUN_TEST(test_one_job_works_in_a_tick);
    RUN_TEST(test_runs_repetitions_and_postures_are_counted);
    RUN_TEST(test_a_row_s_columns_are_those_of_a_dataset);
    RUN_TEST(test_offsets_move_the_tip_along_the_axis);
    RUN_TEST(test_the_recorder_keeps_the_newest_rows);
    return UNITY_END();
}
