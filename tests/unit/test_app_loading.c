/* The loading test through the controller, against a linear limb of known stiffness.
 *
 * The limb here stands with its tip on the ground. With the joints' movement m from rest, the levers'
 * matrix L and the true stiffness K, the ground pushes with f = f0 - K L m and the motors carry -L'f;
 * servos of stiffness P give way, so commanded offsets c lead to m = (I + L'K L / P)^-1 c. Worked out in
 * double, apart from the firmware. */
#include "app_bench.h"
#include "measure/force.h"
#include "measure/loading_read.h"

typedef struct {
    double xx, xz, zz;
} symmetric_t;

static symmetric_t truth;       /* N/mm */
static double servo_n_mm_per_rad, preload_x_n, preload_z_n, weight_n;
static bool tip_is_free;
static float noise_n;
static uint32_t noise_state;

static double theta1 = 1.0, theta2 = 1.4;
static const double femur_mm = 185.0, tibia_mm = 313.5;

static float noise(void) /* uniform, one sigma noise_n */
{
    noise_state = noise_state * 1664525u + 1013904223u;
    return noise_n * 3.4641016f * ((float)(noise_state >> 8) / 16777216.0f - 0.5f);
}

static void play(void *user, brace_fake_t *board, int32_t joint)
{
    (void)user;
    (void)joint;
    const double tip_x = femur_mm * cos(theta1) + tibia_mm * cos(theta1 - theta2);
    const double tip_z = femur_mm * sin(theta1) + tibia_mm * sin(theta1 - theta2);
    const double knee_x = femur_mm * cos(theta1), knee_z = femur_mm * sin(theta1);
    /* tip's movement for theta1 and for theta2, which is flexion */
    const double l[2][2] = {{-tip_z, tip_z - knee_z}, {tip_x, -(tip_x - knee_x)}};
    const double k[2][2] = {{truth.xx, truth.xz}, {truth.xz, truth.zz}};
    double a[2][2] = {{1.0, 0.0}, {0.0, 1.0}};
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2 && !tip_is_free; j++) {
            for (int p = 0; p < 2; p++) {
                for (int q = 0; q < 2; q++) {
                    a[i][j] += l[p][i] * k[p][q] * l[q][j] / servo_n_mm_per_rad;
                }
            }
        }
    }
    const double c[2] = {(double)board->joint[1].command.offset_rad, (double)board->joint[2].command.offset_rad};
    const double det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    const double m[2] = {(a[1][1] * c[0] - a[0][1] * c[1]) / det, (a[0][0] * c[1] - a[1][0] * c[0]) / det};
    const double dx = l[0][0] * m[0] + l[0][1] * m[1], dz = l[1][0] * m[0] + l[1][1] * m[1];
    const double fx = tip_is_free ? 0.0 : preload_x_n - truth.xx * dx - truth.xz * dz;
    const double fz = tip_is_free ? 0.0 : preload_z_n - truth.xz * dx - truth.zz * dz;
    board->joint[1].sample.motor_rad = (float)(theta1 + m[0]);
    board->joint[2].sample.motor_rad = (float)(theta2 + m[1]);
    /* the tibia weighs at its middle */
    const double w1 = weight_n * 0.5 * (knee_x + tip_x), w2 = -weight_n * 0.5 * (tip_x - knee_x);
    board->joint[1].sample.torque_n_mm = (float)(w1 - (l[0][0] * fx + l[1][0] * fz));
    board->joint[2].sample.torque_n_mm = (float)(w2 - (l[0][1] * fx + l[1][1] * fz));
    board->force_x_n = (float)fx + noise();
    board->force_z_n = (float)fz + noise();
}

static const brace_loading_setup_t along_x = {.axis = BRACE_AXIS_X, .steps_per_side = 4, .step_mm = 0.635f,
                                              .dwell_us = 400000, .rate_mm_per_s = 10.0f, .force_max_n = 100.0f,
                                              .torque_max_n_mm = 8000.0f, .source = BRACE_LOADING_ENCODED};

static void stand(const brace_parameters_t *p)
{
    bench_start(p);
    truth = (symmetric_t){3.5, -0.5, 0.6};
    theta1 = 1.0;
    theta2 = 1.4;
    servo_n_mm_per_rad = 60000.0;
    preload_x_n = 1.0;
    preload_z_n = 6.0;
    weight_n = 0.0;
    tip_is_free = false;
    noise_n = 0.0f;
    noise_state = 1;
    fake.play = play;
    ticks(50);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
}

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    stand(&p);
}

void tearDown(void) {}

static const brace_loading_result_t *result(void)
{
    return brace_app_loading_result(&app);
}

static void run(const brace_loading_setup_t *setup)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, setup));
    ticks(1);
    TEST_ASSERT_EQUAL(BRACE_MODE_LOADING_TEST, now()->mode);
    for (int i = 0; i < 60000 && app.mode == BRACE_MODE_LOADING_TEST; i++) {
        ticks(1);
    }
    ticks(2);
}

/* ----------------------------------------------------------------------------------------------- slopes -- */

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

static void test_the_model_is_compared_in_sigmas(void)
{
    truth = (symmetric_t){3.96389818, -0.63872477, 0.42806022}; /* the model's own K */
    run(&along_x);
    ASSERT_CLOSE(3.96389818, result()->model_k_x_n_per_mm, 1e-3);
    ASSERT_CLOSE(-0.63872477, result()->model_k_z_n_per_mm, 1e-3);
    TEST_ASSERT_TRUE(fabsf(result()->z_x) < 0.5f);
    TEST_ASSERT_TRUE(fabsf(result()->z_z) < 0.5f);
    TEST_ASSERT_TRUE(result()->sigma_model_k_x_n_per_mm > 0.05f);
    truth.xx = 2.0;
    run(&along_x);
    TEST_ASSERT_TRUE(result()->z_x < -3.0f);
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

static void test_without_a_sensor_the_joints_tell_the_force_less_gravity(void)
{
    brace_parameters_t p = bench_parameters();
    p.gravity.tibia_n = 2.0f;
    stand(&p);
    weight_n = 2.0;
    brace_fake_without_force(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(200);
    TEST_ASSERT_FALSE(now()->force_is_sensed);
    ASSERT_CLOSE(1.0, now()->force_x_n, 0.01);
    ASSERT_CLOSE(6.0, now()->force_z_n, 0.01);
    run(&along_x);
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
    TEST_ASSERT_FALSE(result()->force_is_sensed);
    ASSERT_CLOSE(3.5, result()->least_squares.k_x_n_per_mm, 3.5 * 1e-2); /* levers are those of motors 8 mrad away */
}

static void test_the_sensed_force_says_what_the_joints_should_carry(void)
{
    brace_parameters_t p = bench_parameters();
    p.gravity.tibia_n = 2.0f;
    stand(&p);
    weight_n = 2.0;
    ticks(3);
    for (int i = 0; i < BRACE_APP_JOINTS; i++) {
        brace_backlash_sample_t sample = {.load_is_expected = false};
        force_expect(&app, i, &sample);
        TEST_ASSERT_TRUE(sample.load_is_expected);
        ASSERT_CLOSE(fake.joint[BRACE_FEMUR + i].sample.torque_n_mm, sample.expected_n_mm, 1.0);
        TEST_ASSERT_TRUE(sample.expected_off_n_mm > 0.0f);
    }
    brace_fake_fail_next(&fake, BRACE_FAKE_TIP_FORCE_READ, 1, BRACE_HAL_E_DEVICE);
    ticks(1);
    brace_backlash_sample_t sample = {.load_is_expected = false};
    force_expect(&app, 0, &sample);
    TEST_ASSERT_FALSE(sample.load_is_expected);
}

static void test_what_is_off_the_axis_is_taken_off_by_the_model(void)
{
    truth = (symmetric_t){3.96389818, -0.63872477, 0.42806022};
    run(&along_x);
    brace_loading_t *test = &app.loading;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_slope_start(&test->slope, 0.0f, 0.0f, 0.0f));
    for (int i = 1; i <= 4; i++) { /* steps with a third of them across */
        test->dx_mm = 0.6f * (float)i;
        test->dz_mm = 0.2f * (float)i * (i % 2 == 0 ? 1.0f : -1.0f);
        const double x = (double)test->dx_mm, z = (double)test->dz_mm;
        TEST_ASSERT_TRUE(loading_add_to_slope(test, (float)(truth.xx * x + truth.xz * z),
                                              (float)(truth.xz * x + truth.zz * z)));
    }
    brace_slope_column_t column;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_slope_column(&test->slope, BRACE_SLOPE_LEAST_SQUARES, &column));
    ASSERT_CLOSE(truth.xx, column.k_x_n_per_mm, 2e-3);
    ASSERT_CLOSE(truth.xz, column.k_z_n_per_mm, 2e-3);
}

static void test_the_sensor_model_is_undone(void)
{
    brace_parameters_t p = bench_parameters();
    p.sensor.bias_x_n = 0.4f;
    p.sensor.bias_z_n = -0.3f;
    p.sensor.gain = 1.1f;
    p.sensor.rotation_rad = 0.2f;
    p.sensor.crosstalk_xz = 0.05f;
    p.sensor.crosstalk_zx = -0.03f;
    bench_start(&p);
    const double fx = 2.0, fz = 7.0, mx = fx + 0.05 * fz, mz = -0.03 * fx + fz;
    fake.force_x_n = (float)(0.4 + 1.1 * (cos(0.2) * mx - sin(0.2) * mz));
    fake.force_z_n = (float)(-0.3 + 1.1 * (sin(0.2) * mx + cos(0.2) * mz));
    ticks(3);
    TEST_ASSERT_TRUE(now()->force_is_sensed);
    ASSERT_CLOSE(2.0, now()->force_x_n, 1e-5);
    ASSERT_CLOSE(7.0, now()->force_z_n, 1e-5);
}

static void test_a_saturated_or_silent_sensor_is_not_used(void)
{
    brace_parameters_t p = bench_parameters();
    p.sensor.saturation_n = 20.0f;
    bench_start(&p);
    fake.force_z_n = 20.0f;
    ticks(3);
    TEST_ASSERT_FALSE(now()->force_is_sensed);
    fake.force_z_n = 19.0f;
    ticks(1);
    TEST_ASSERT_TRUE(now()->force_is_sensed);
    fake.force_x_n = (float)NAN;
    ticks(1);
    TEST_ASSERT_FALSE(now()->force_is_sensed);
    fake.force_x_n = 0.0f;
    brace_fake_fail_next(&fake, BRACE_FAKE_TIP_FORCE_READ, 5, BRACE_HAL_E_DEVICE);
    ticks(1);
    TEST_ASSERT_FALSE(now()->force_is_sensed);
}

/* ------------------------------------------------------------------------------------------------- rows -- */

static void test_rows_are_a_pass_in_the_columns_of_a_dataset(void)
{
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
        TEST_ASSERT_TRUE(row.t_s > before_s);
        before_s = row.t_s;
        TEST_ASSERT_TRUE(isnan(row.enc1_rad));
        TEST_ASSERT_EQUAL(BRACE_OK, brace_row_value(&row, 9, &value));
        ASSERT_CLOSE(row.dx_mm, value, 0.0);
    }
    TEST_ASSERT_EQUAL_STRING("dx_mm", brace_row_column_name(9));
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
    ticks(5);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &quick));
    TEST_ASSERT_EQUAL(2, result()->config);
}

static void test_the_recorder_keeps_the_newest_rows(void)
{
    static brace_recorder_t recorder;
    brace_row_t row = {0};
    brace_recorder_clear(&recorder);
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
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_recorder_row(&recorder, 0, NULL));
    float value = 7.0f;
    for (uint32_t column = 0; column < BRACE_ROW_COLUMNS; column++) {
        TEST_ASSERT_EQUAL(BRACE_OK, brace_row_value(&row, column, &value));
        TEST_ASSERT_NOT_NULL(brace_row_column_name(column));
    }
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_row_value(&row, BRACE_ROW_COLUMNS, &value));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_row_value(&row, 0, NULL));
    TEST_ASSERT_NULL(brace_row_column_name(BRACE_ROW_COLUMNS));
}

/* ----------------------------------------------------------------------------------------------- bounds -- */

static void ends_with(brace_loading_outcome_t wanted)
{
    TEST_ASSERT_EQUAL(wanted, result()->outcome);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    ASSERT_CLOSE(0.0, fake.joint[BRACE_FEMUR].command.offset_rad, 0.0);
    ASSERT_CLOSE(0.0, fake.joint[BRACE_TIBIA].command.offset_rad, 0.0);
    TEST_ASSERT_TRUE(isinf(fake.joint[BRACE_FEMUR].command.torque_limit_n_mm));
}

static void test_the_force_is_bounded(void)
{
    brace_loading_setup_t setup = along_x;
    setup.force_max_n = 5.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &setup));
    for (int i = 0; i < 20000 && app.mode == BRACE_MODE_LOADING_TEST; i++) {
        ticks(1);
        TEST_ASSERT_TRUE(fabsf(fake.force_x_n - 1.0f) < 5.2f);
    }
    ticks(2);
    ends_with(BRACE_LOADING_E_FORCE);
}

static void test_the_torque_is_bounded(void)
{
    brace_loading_setup_t setup = along_x;
    setup.torque_max_n_mm = fabsf(fake.joint[BRACE_FEMUR].sample.torque_n_mm) + 300.0f;
    run(&setup);
    ends_with(BRACE_LOADING_E_TORQUE);
}

static void test_a_tip_that_nothing_holds_gives_no_slope_but_no_harm(void)
{
    tip_is_free = true;
    run(&along_x);
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
    ASSERT_CLOSE(0.0, result()->least_squares.k_x_n_per_mm, 1e-3);
    TEST_ASSERT_TRUE(result()->z_x < -3.0f);
}

static void test_motors_that_do_not_follow_are_told(void)
{
    fake.play = NULL;
    run(&along_x);
    TEST_ASSERT_TRUE(result()->outcome == BRACE_LOADING_E_FLAT);
}

static void pushed(void *user, brace_fake_t *board, int32_t joint)
{
    play(user, board, joint);
    board->joint[1].sample.motor_rad += 0.05f;
}

static void test_a_motor_that_goes_where_it_was_not_sent_ends_the_test(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    ticks(500);
    fake.play = pushed;
    for (int i = 0; i < 20000 && app.mode == BRACE_MODE_LOADING_TEST; i++) {
        ticks(1);
    }
    ticks(2);
    ends_with(BRACE_LOADING_E_TRAVEL);
}

static void test_the_drives_hold_the_torque_s_bound_themselves(void)
{
    brace_loading_setup_t setup = along_x;
    const float asked_n_mm[] = {3000.0f, 20000.0f}, told_n_mm[] = {3000.0f, 10000.0f}; /* the drives' range */
    for (int i = 0; i < 2; i++) {
        setup.torque_max_n_mm = asked_n_mm[i];
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &setup));
        ticks(100);
        TEST_ASSERT_EQUAL_FLOAT(told_n_mm[i], fake.joint[BRACE_FEMUR].command.torque_limit_n_mm);
        TEST_ASSERT_EQUAL_FLOAT(told_n_mm[i], fake.joint[BRACE_TIBIA].command.torque_limit_n_mm);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_stop(&app));
        ticks(200);
        TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    }
}

static void test_a_posture_at_the_end_of_its_travel_ends_the_test(void)
{
    brace_parameters_t p = bench_parameters();
    p.drive[BRACE_FEMUR].angle_min_rad = 0.998f;
    p.drive[BRACE_FEMUR].angle_max_rad = 1.002f;
    p.drive[BRACE_TIBIA].angle_min_rad = 1.398f;
    p.drive[BRACE_TIBIA].angle_max_rad = 1.402f;
    stand(&p);
    run(&along_x);
    ends_with(BRACE_LOADING_E_TRAVEL);
}

static void test_the_time_is_bounded(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    ticks(10);
    /* four steps a side: 17 readings of twice 0.4 s and a step's way, 3 s each for the servos; and 2 s */
    ASSERT_CLOSE(17.0 * (2.0 * (0.4 + 0.0635) + 3.0) + 2.0, 1e-6 * (double)app.loading.limit_us, 1e-3);
    app.loading.limit_us = app.loading.test_us + 100000u;
    ticks(101);
    TEST_ASSERT_EQUAL(BRACE_LOADING_E_TIME, result()->outcome);
    ticks(200);
    ends_with(BRACE_LOADING_E_TIME);
}

static void test_a_test_that_ends_early_goes_back_at_its_rate(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    for (int i = 0; i < 20000 && result()->rows < 4; i++) {
        ticks(1);
    }
    TEST_ASSERT_EQUAL(4, result()->rows);
    const float along_mm = fabsf(app.loading.along_mm);
    TEST_ASSERT_TRUE(along_mm > 1.8f);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_stop(&app));
    const float step_mm = 1e-3f * along_x.rate_mm_per_s; /* in a tick */
    int count = 0;
    for (; count < 1000 && app.mode == BRACE_MODE_LOADING_TEST; count++) {
        const float before[2] = {fake.joint[1].command.offset_rad, fake.joint[2].command.offset_rad};
        ticks(1);
        for (int i = 0; i < 2; i++) {
            const float most_rad = step_mm * fabsf(app.loading.per_mm[i] + app.loading.give_rad_per_mm[i]);
            TEST_ASSERT_TRUE(fabsf(fake.joint[1 + i].command.offset_rad - before[i]) <= 1.01f * most_rad);
        }
    }
    TEST_ASSERT_TRUE((float)count >= along_mm / step_mm - 1.0f);
    ends_with(BRACE_LOADING_STOPPED);
}

static void test_it_can_be_stopped(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    TEST_ASSERT_EQUAL(BRACE_E_MODE, brace_app_loading_start(&app, &along_x));
    ticks(1500);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_stop(&app));
    for (int i = 0; i < 20000 && app.mode == BRACE_MODE_LOADING_TEST; i++) {
        ticks(1);
    }
    ticks(2);
    ends_with(BRACE_LOADING_STOPPED);
    TEST_ASSERT_EQUAL(BRACE_E_MODE, brace_app_loading_stop(&app));
    TEST_ASSERT_TRUE(brace_app_row_count(&app) > 0);
}

static void test_a_fault_ends_it(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    ticks(1500);
    fake.joint[BRACE_TIBIA].not_newer = true;
    ticks(100);
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, now()->mode);
    TEST_ASSERT_EQUAL(BRACE_LOADING_E_LOST, result()->outcome);
    ticks(2000);
    ASSERT_CLOSE(0.0, fake.joint[BRACE_FEMUR].command.offset_rad, 0.0);
}

static void test_a_force_that_is_lost_ends_it(void)
{
    brace_parameters_t p = bench_parameters();
    stand(&p);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    ticks(1500);
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = 0.0f;
    app.parameters.limb.femur_mm = -1.0f; /* no posture, no levers, no force */
    ticks(100);
    TEST_ASSERT_EQUAL(BRACE_LOADING_E_NO_FORCE, result()->outcome);
}

static void test_setups_that_cannot_be_are_refused(void)
{
    brace_loading_setup_t s = along_x;
    s.steps_per_side = 1;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.step_mm = (float)NAN;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.dwell_us = 1000;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.axis = (brace_axis_t)2;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.force_max_n = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.source = (brace_loading_source_t)7;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    fake.play = NULL;
    fake.joint[BRACE_TIBIA].sample.motor_rad = 0.01f; /* nearly straight */
    ticks(3);
    TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, brace_app_loading_start(&app, &along_x));
    brace_fake_without_commands(&fake);
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_app_loading_start(&app, &along_x));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    TEST_ASSERT_EQUAL(BRACE_E_MODE, brace_app_loading_start(&app, &along_x));
}

/* -------------------------------------------------------------------------------------- model and springs -- */

static void test_springs_follow_temperature_and_load(void)
{
    brace_parameters_t p = bench_parameters();
    p.slow.joint_compliance_per_degc = 0.01f;
    p.slow.reference_degc = 22.0f;
    bench_start(&p);
    ticks(3);
    const float cold = now()->stiffness.now.k_xx_n_per_mm; /* no thermometer: at the reference */
    ASSERT_CLOSE(3.96389818, cold, 2e-5);
    fake.joint[BRACE_FEMUR].sample.temp_degc = 42.0f; /* the tibia's joint takes it too */
    ticks(3);
    ASSERT_CLOSE(42.0, now()->temp_degc, 0.0);
    brace_limb_t warm = p.limb;
    warm.joint[BRACE_FEMUR].compliance_rad_per_n_mm *= 1.2f;
    warm.joint[BRACE_TIBIA].compliance_rad_per_n_mm *= 1.2f;
    brace_planar_t planar;
    brace_stiffness_t expected;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&warm, &planar));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_stiffness(&planar, 1.0f, 1.4f, &expected));
    ASSERT_CLOSE(expected.k_xx_n_per_mm, now()->stiffness.now.k_xx_n_per_mm, 1e-5);
    ASSERT_CLOSE(expected.k_zz_n_per_mm, now()->stiffness.now.k_zz_n_per_mm, 1e-5);

    p.slow.joint_compliance_per_degc = 0.0f;
    p.drive[BRACE_FEMUR].hardening_n_mm_per_rad3 = 1e8f;
    bench_start(&p);
    /* q = 0.02 rad: torque = q / 1e-5 + 1e8 q^3 = 2800 N mm, slope 1e5 + 3e8 q^2 = 2.2e5 */
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = 2800.0f;
    ticks(300);
    brace_limb_t hard = p.limb;
    hard.joint[BRACE_FEMUR].compliance_rad_per_n_mm = (float)(1.0 / 2.2e5);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&hard, &planar));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_stiffness(&planar, 1.0f, 1.4f, &expected));
    ASSERT_CLOSE(expected.k_xx_n_per_mm, now()->stiffness.now.k_xx_n_per_mm, 1e-4);
}

static void test_a_base_that_yields_unequally_takes_the_general_path(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb.base = (brace_base_t){0.02f, 0.005f, 3e-6f};
    bench_start(&p);
    ticks(3);
    brace_chain_t chain;
    brace_stiffness_t expected;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_build(&p.limb, &chain));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_stiffness(&chain, 1.0f, 1.4f, &expected));
    ASSERT_CLOSE(expected.k_xx_n_per_mm, now()->stiffness.now.k_xx_n_per_mm, 1e-5);
    ASSERT_CLOSE(expected.k_xz_n_per_mm, now()->stiffness.now.k_xz_n_per_mm, 1e-5);
    ASSERT_CLOSE(expected.k_zz_n_per_mm, now()->stiffness.now.k_zz_n_per_mm, 1e-5);
}

static void test_a_limb_that_only_its_joints_let_yield_works_too(void)
{
    brace_parameters_t p = bench_parameters();
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        p.limb.link[i] = (brace_link_t){0};
    }
    p.slow.joint_compliance_per_degc = 0.001f; /* so that the springs change, and the links are built alone */
    bench_start(&p);
    ticks(3);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    brace_chain_t chain;
    brace_stiffness_t expected;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_build(&p.limb, &chain));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_stiffness(&chain, 1.0f, 1.4f, &expected));
    ASSERT_CLOSE(expected.k_zz_n_per_mm, now()->stiffness.now.k_zz_n_per_mm, 1e-5 * (double)expected.lambda_max_n_per_mm);
}

/* -------------------------------------------------------------------------------------------- model drift -- */

/* Stands at one of four postures, the truth being this limb's K there, and runs a test. */
static void test_at(int turn, const brace_limb_t *limb, const brace_loading_setup_t *setup)
{
    static const double posture[4][2] = {{1.0, 1.4}, {0.7, 1.8}, {1.3, 1.0}, {0.5, 1.2}};
    brace_planar_t planar;
    brace_stiffness_t k;
    theta1 = posture[turn % 4][0];
    theta2 = posture[turn % 4][1];
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(limb, &planar));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_stiffness(&planar, (float)theta1, (float)theta2, &k));
    truth = (symmetric_t){(double)k.k_xx_n_per_mm, (double)k.k_xz_n_per_mm, (double)k.k_zz_n_per_mm};
    brace_loading_setup_t next = *setup;
    next.axis = turn / 4 % 2 == 0 ? BRACE_AXIS_X : BRACE_AXIS_Z;
    ticks(2);
    run(&next);
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
}

static void test_a_link_that_cracks_is_noticed_and_the_alarm_is_cleared_on_request(void)
{
    brace_loading_setup_t quick = along_x;
    quick.dwell_us = 20000;
    quick.rate_mm_per_s = 200.0f;
    quick.source = BRACE_LOADING_COMMANDED; /* stiff servos follow at once */
    servo_n_mm_per_rad = 1e9;
    noise_n = 0.02f;
    brace_limb_t limb = app.parameters.limb;
    int turn = 0;
    for (; turn < BRACE_DRIFT_LEARN_MOST / 16 + 4 && app.drift.state == BRACE_DRIFT_LEARNING; turn++) {
        test_at(turn, &limb, &quick);
    }
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, app.drift.state);
    TEST_ASSERT_EQUAL(0, now()->faults);
    limb.link[BRACE_TIBIA].bending_mm_per_n *= 1.5f;
    for (int i = 0; i < 8 && now()->faults == 0; i++) {
        test_at(turn++, &limb, &quick);
    }
    TEST_ASSERT_EQUAL(BRACE_FAULT_MODEL_DRIFT, now()->faults);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_clear(&app, BRACE_FAULT_MODEL_DRIFT));
    ticks(1);
    TEST_ASSERT_EQUAL(0, now()->faults);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_slope_along_x_is_the_first_column_of_K);
    RUN_TEST(test_the_slope_along_z_is_the_second_column);
    RUN_TEST(test_the_model_is_compared_in_sigmas);
    RUN_TEST(test_noise_is_in_the_sigma_of_the_slope);
    RUN_TEST(test_commanded_displacement_has_the_servo_in_it);
    RUN_TEST(test_without_a_sensor_the_joints_tell_the_force_less_gravity);
    RUN_TEST(test_the_sensed_force_says_what_the_joints_should_carry);
    RUN_TEST(test_what_is_off_the_axis_is_taken_off_by_the_model);
    RUN_TEST(test_the_sensor_model_is_undone);
    RUN_TEST(test_a_saturated_or_silent_sensor_is_not_used);
    RUN_TEST(test_rows_are_a_pass_in_the_columns_of_a_dataset);
    RUN_TEST(test_runs_repetitions_and_postures_are_counted);
    RUN_TEST(test_the_recorder_keeps_the_newest_rows);
    RUN_TEST(test_the_force_is_bounded);
    RUN_TEST(test_the_torque_is_bounded);
    RUN_TEST(test_a_tip_that_nothing_holds_gives_no_slope_but_no_harm);
    RUN_TEST(test_motors_that_do_not_follow_are_told);
    RUN_TEST(test_a_motor_that_goes_where_it_was_not_sent_ends_the_test);
    RUN_TEST(test_the_drives_hold_the_torque_s_bound_themselves);
    RUN_TEST(test_a_posture_at_the_end_of_its_travel_ends_the_test);
    RUN_TEST(test_the_time_is_bounded);
    RUN_TEST(test_a_test_that_ends_early_goes_back_at_its_rate);
    RUN_TEST(test_it_can_be_stopped);
    RUN_TEST(test_a_fault_ends_it);
    RUN_TEST(test_a_force_that_is_lost_ends_it);
    RUN_TEST(test_setups_that_cannot_be_are_refused);
    RUN_TEST(test_springs_follow_temperature_and_load);
    RUN_TEST(test_a_base_that_yields_unequally_takes_the_general_path);
    RUN_TEST(test_a_limb_that_only_its_joints_let_yield_works_too);
    RUN_TEST(test_a_link_that_cracks_is_noticed_and_the_alarm_is_cleared_on_request);
    return UNITY_END();
}
