/* One reading of a loading test, each of its numbers with a value of its own: what of the samples goes into the row,
 * the slope and the drift check, and under which name. */
#include <string.h>

#include "jobs/loading/reading.h"
#include "loading_bench.h"

static brace_loading_t test;
static brace_snapshot_t snapshot;
static joints_t joints;
static posture_t posture;
static brace_recorder_t recorder;
static loading_inputs_t inputs;

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    stand(&p);
    snapshot = *now();
    joints = app.controller.joints;
    posture = app.controller.posture;
    inputs = controller_loading_inputs(&app.controller, &snapshot);
    inputs.joints = &joints;
    inputs.posture = &posture;
    memset(&recorder, 0, sizeof recorder);
    memset(&test, 0, sizeof test);
    test.result.setup = along_x;
    test.result.run = 3, test.result.config = 4, test.result.rep = 5;
    test.start_motor_rad[0] = 1.0f, test.start_motor_rad[1] = 2.0f;
    test.start_link_rad[0] = 0.001f, test.start_link_rad[1] = 0.004f;
    test.lever_femur = (brace_point_t){-70.0f, 310.0f};
    test.lever_knee = (brace_point_t){110.0f, -290.0f};
    test.behind_rad[BRACE_FEMUR] = 0.05f, test.behind_rad[BRACE_TIBIA] = 0.07f;
    reading_begin(&test);
}

void tearDown(void) {}

/* A sample of both joints, forces and temperature. */
static void add(float femur_rad, float tibia_rad, float link1_rad, float link2_rad, float x_n, float z_n, float degc)
{
    brace_hal_joint_t *femur = &joints.joint[BRACE_FEMUR].sample, *tibia = &joints.joint[BRACE_TIBIA].sample;
    femur->motor_rad = 1.0f + femur_rad, tibia->motor_rad = 2.0f + tibia_rad;
    femur->link_rad = femur->motor_rad + link1_rad, tibia->link_rad = tibia->motor_rad + link2_rad;
    snapshot.force_x_n = x_n, snapshot.force_z_n = z_n, snapshot.temp_degc = degc;
    reading_add(&test, &inputs);
}

static void test_the_first_reading_is_what_all_counts_from(void)
{
    posture.unbent_rad[BRACE_FEMUR] = 1.11f, posture.unbent_rad[BRACE_TIBIA] = 1.22f;
    snapshot.theta_rad[BRACE_FEMUR] = 1.33f, snapshot.theta_rad[BRACE_TIBIA] = 1.44f;
    test.dx_mm = test.dz_mm = 9.0f;
    test.test_us = 250000;
    test.result.setup.axis = BRACE_AXIS_Z;
    add(0.010f, 0.030f, 0.002f, 0.005f, 4.0f, 7.0f, 30.0f);
    add(0.020f, 0.050f, 0.004f, 0.009f, 6.0f, 10.0f, 34.0f);
    TEST_ASSERT_TRUE(reading_take(&test, &inputs, &recorder));
    ASSERT_CLOSE(1.015, test.start_motor_rad[0], 1e-6);
    ASSERT_CLOSE(2.040, test.start_motor_rad[1], 1e-6);
    ASSERT_CLOSE(0.003, test.start_link_rad[0], 1e-6);
    ASSERT_CLOSE(0.007, test.start_link_rad[1], 1e-6);
    ASSERT_CLOSE(1.33, test.standing_rad[0], 1e-6);
    ASSERT_CLOSE(1.44, test.standing_rad[1], 1e-6);
    ASSERT_CLOSE(1.06, test.result.theta1_rad, 1e-6); /* as the motors stand, without what the load turns */
    ASSERT_CLOSE(1.15, test.result.theta2_rad, 1e-6);
    ASSERT_CLOSE(32.0, test.result.temp_degc, 1e-5);
    ASSERT_CLOSE(5.0, test.result.preload_x_n, 1e-6);
    ASSERT_CLOSE(8.5, test.result.preload_z_n, 1e-6);
    TEST_ASSERT_EQUAL_FLOAT(snapshot.stiffness.engaged.k_xx_n_per_mm, test.model.k_xx_n_per_mm);
    TEST_ASSERT_EQUAL(1, test.result.rows);
    brace_row_t row;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_recorder_row(&recorder, 0, &row));
    const float reported[] = {row.run,  row.config,     row.axis,       row.rep,      row.step,
                              row.t_s,  row.temp_degc,  row.dx_mm,      row.dz_mm,    row.fx_n,
                              row.fz_n, row.theta1_rad, row.theta2_rad, row.enc1_rad, row.enc2_rad};
    const double wanted[] = {3, 4, BRACE_AXIS_Z, 5, 0, 0.25, 32.0, 0.0, 0.0, 5.0, 8.5, 1.06, 1.15, 0.0, 0.0};
    for (int i = 0; i < 15; i++) {
        ASSERT_CLOSE(wanted[i], reported[i], 1e-5);
    }
    snapshot.k_is_valid = false; /* nothing to compare with */
    reading_begin(&test);
    add(0.0f, 0.0f, 0.0f, 0.0f, 4.0f, 7.0f, 30.0f);
    TEST_ASSERT_FALSE(reading_take(&test, &inputs, &recorder));
    TEST_ASSERT_EQUAL(1, test.result.rows);
}

/* A later one: the tip is displaced by the opposite of what the motors move it, x and z by both joints. */
static void a_later_reading(brace_loading_source_t source, double femur_rad, double tibia_rad)
{
    add(0.0f, 0.0f, 0.001f, 0.004f, 5.0f, 8.0f, 30.0f);
    TEST_ASSERT_TRUE(reading_take(&test, &inputs, &recorder));
    test.start_motor_rad[0] = 1.0f, test.start_motor_rad[1] = 2.0f;
    test.result.setup.source = source;
    test.per_mm[0] = 0.004f, test.per_mm[1] = -0.003f, test.along_mm = 2.0f;
    test.step = 2;
    reading_begin(&test);
    add(0.003f, 0.011f, 0.0015f, 0.0060f, 11.0f, 14.0f, 31.0f);
    add(0.005f, 0.013f, 0.0025f, 0.0070f, 13.0f, 17.0f, 33.0f);
    TEST_ASSERT_TRUE(reading_take(&test, &inputs, &recorder));
    const double dx = 70.0 * femur_rad - 110.0 * tibia_rad, dz = -310.0 * femur_rad + 290.0 * tibia_rad;
    brace_row_t row;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_recorder_row(&recorder, 1, &row));
    ASSERT_CLOSE(dx, row.dx_mm, 1e-4);
    ASSERT_CLOSE(dz, row.dz_mm, 1e-4);
    ASSERT_CLOSE(dx, test.dx_mm, 1e-4);
    ASSERT_CLOSE(dz, test.dz_mm, 1e-4);
    ASSERT_CLOSE(12.0, row.fx_n, 1e-5);
    ASSERT_CLOSE(15.5, row.fz_n, 1e-5);
    ASSERT_CLOSE(32.0, row.temp_degc, 1e-5);
    ASSERT_CLOSE(0.001, row.enc1_rad, 1e-6);  /* counter-clockwise, from the preload on */
    ASSERT_CLOSE(-0.0025, row.enc2_rad, 1e-6); /* a positive one opens the knee */
    TEST_ASSERT_EQUAL(2, row.step);
    ASSERT_CLOSE(30.0, test.result.temp_degc, 1e-5); /* the result has the preload point's */
    ASSERT_CLOSE(5.0, test.result.preload_x_n, 1e-6);
}

static void test_a_later_reading_is_of_the_motors(void)
{
    a_later_reading(BRACE_LOADING_ENCODED, 0.004, 0.012);
}

static void test_a_later_reading_is_of_the_commands_where_that_was_asked_for(void)
{
    a_later_reading(BRACE_LOADING_COMMANDED, 0.008, -0.006);
}

static void test_without_a_sample_there_is_no_reading(void)
{
    test.result.preload_x_n = 3.0f, test.result.temp_degc = 31.0f;
    TEST_ASSERT_FALSE(reading_take(&test, &inputs, &recorder));
    TEST_ASSERT_EQUAL_FLOAT(3.0f, test.result.preload_x_n); /* and what was read before stays */
    TEST_ASSERT_EQUAL_FLOAT(31.0f, test.result.temp_degc);
    TEST_ASSERT_EQUAL(0, test.result.rows);
    TEST_ASSERT_EQUAL(0, recorder.count);
}

/* One encoder cannot measure what the gear gives way by: neither joint takes the other's for its own. */
static void test_a_joint_of_one_encoder_has_no_deflection(void)
{
    for (int i = 0; i < 2; i++) {
        setUp();
        joints.joint[BRACE_FEMUR + i].is_link_only = true;
        add(0.0f, 0.0f, 0.002f, 0.003f, 5.0f, 8.0f, 30.0f);
        TEST_ASSERT_TRUE(reading_take(&test, &inputs, &recorder));
        TEST_ASSERT_TRUE(isnan(test.start_link_rad[i]));
        ASSERT_CLOSE(i == 0 ? 0.003 : 0.002, test.start_link_rad[1 - i], 1e-6);
    }
}

/* A reading whose force was not sensed in each of its samples is none of a sensor's. */
static void test_a_force_is_sensed_if_all_of_it_is(void)
{
    for (int missing = -1; missing < 3; missing++) {
        for (int before = 0; before < 2; before++) {
            setUp();
            test.result.force_is_sensed = before != 0; /* of the reading before */
            for (int i = 0; i < 3; i++) {
                snapshot.force_is_sensed = i != missing;
                add(0.0f, 0.0f, 0.0f, 0.0f, 5.0f, 8.0f, 30.0f);
            }
            TEST_ASSERT_EQUAL(missing < 0, test.result.force_is_sensed);
        }
    }
}

/* --- what the drift check gets ----------------------------------------------------------------------------------- */

static loading_reading_t for_drift(void)
{
    loading_reading_t reading = {.is_there = false};
    reading_for_drift(&test, &inputs, &reading);
    return reading;
}

static void test_the_drift_check_gets_each_number(void)
{
    test.step = 1;
    test.standing_rad[0] = 1.1f, test.standing_rad[1] = 1.2f;
    test.dx_mm = 0.3f, test.dz_mm = 0.4f, test.fx_n = 5.0f, test.fz_n = 6.0f;
    test.result.temp_degc = 29.0f;
    test.result.force_is_sensed = true;
    test.at_reference = (brace_stiffness_t){.k_xx_n_per_mm = 7.0f};
    const float reference_degc = inputs.parameters->slow.reference_degc;
    const loading_reading_t r = for_drift();
    TEST_ASSERT_TRUE(r.is_there);
    TEST_ASSERT_TRUE(r.is_fit);
    TEST_ASSERT_EQUAL_FLOAT(7.0f, r.model.k_xx_n_per_mm);
    const float reported[] = {r.reading.theta1_rad, r.reading.theta2_rad, r.reading.dx_mm,      r.reading.dz_mm,
                              r.reading.fx_n,       r.reading.fz_n,       r.reading.warmer_degc};
    const float wanted[] = {1.1f, 1.2f, 0.3f, 0.4f, 5.0f, 6.0f, 29.0f - reference_degc};
    TEST_ASSERT_EQUAL_FLOAT_ARRAY(wanted, reported, 7);
}

/* The drift check's K is that of joints at the reference temperature: under the preload where a load is counted, else
 * without one. Where the springs never change it is the K of now. */
static void test_the_drift_check_s_K(void)
{
    static model_t model;
    static model_work_t work;
    brace_parameters_t p = bench_parameters();
    p.slow.joint_compliance_per_degc = 0.01f;
    bench_model(&model, &p, false);
    inputs.parameters = &p, inputs.model = &model, inputs.work = &work;
    joints.joint[BRACE_FEMUR].sample.temp_degc = joints.joint[BRACE_TIBIA].sample.temp_degc =
        p.slow.reference_degc + 50.0f;
    test.result.theta1_rad = 0.9f, test.result.theta2_rad = 1.3f;
    test.result.preload_x_n = -6.0f, test.result.preload_z_n = 15.0f;
    posture.unbent_rad[BRACE_FEMUR] = 0.8f, posture.unbent_rad[BRACE_TIBIA] = 1.2f;
    brace_planar_t planar;
    brace_stiffness_t unloaded;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&p.limb, &planar));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_stiffness(&planar, 0.9f, 1.3f, &unloaded));
    const brace_stiffness_t loaded =
        equilibrium(&p, 0.8f, 1.2f, (brace_force_t){-6.0f, 15.0f}, (brace_vec_t){0.0f, -1.0f}).stiffness;
    for (int is_counted = 0; is_counted < 2; is_counted++) {
        const brace_stiffness_t *wanted = is_counted != 0 ? &loaded : &unloaded;
        const double off = 1e-4 * (double)wanted->lambda_max_n_per_mm;
        snapshot.load.is_counted = is_counted != 0;
        for (int i = 0; i < 5 && !reading_model_at_reference(&test, &inputs); i++) {
        }
        ASSERT_CLOSE(wanted->k_xx_n_per_mm, test.at_reference.k_xx_n_per_mm, off);
        ASSERT_CLOSE(wanted->k_xz_n_per_mm, test.at_reference.k_xz_n_per_mm, off);
        ASSERT_CLOSE(wanted->k_zz_n_per_mm, test.at_reference.k_zz_n_per_mm, off);
        for (int i = 0; i < 5 && !reading_model_now(&test, &inputs); i++) { /* half as stiff joints */
        }
        TEST_ASSERT_TRUE(is_counted == 0 || test.model.k_xx_n_per_mm < wanted->k_xx_n_per_mm);
        TEST_ASSERT_EQUAL_FLOAT(test.model.k_xx_n_per_mm, test.at_reference.k_xx_n_per_mm);
    }
    p.slow.joint_compliance_per_degc = 0.0f;
    bench_model(&model, &p, false);
    test.at_reference.k_xx_n_per_mm = 77.0f;
    TEST_ASSERT_TRUE(reading_model_at_reference(&test, &inputs));
    TEST_ASSERT_EQUAL_FLOAT(77.0f, test.at_reference.k_xx_n_per_mm);
}

/* A thermometer that is none, or that reports more than the drift check takes (brace/drift_types.h: 200 degrees to
 * either side), says that it is as warm as the reference. */
static void test_a_temperature_that_is_none_counts_as_the_reference(void)
{
    const float reference_degc = inputs.parameters->slow.reference_degc;
    const float warmer_degc[] = {NAN, INFINITY, -INFINITY, 201.0f, -201.0f, 200.0f, -200.0f};
    test.step = 1;
    for (int i = 0; i < 7; i++) {
        test.result.temp_degc = reference_degc + warmer_degc[i];
        ASSERT_CLOSE(i < 5 ? 0.0 : (double)warmer_degc[i], for_drift().reading.warmer_degc, 1e-4);
    }
}

/* It turns round at the ends of either side; the preload point shows no displacement. */
static void test_a_run_ends_where_the_motion_turns_round(void)
{
    test.result.setup.steps_per_side = 3;
    for (uint16_t step = 0; step <= 12; step++) {
        test.step = step;
        const loading_reading_t r = for_drift();
        TEST_ASSERT_EQUAL(step != 0, r.is_there);
        TEST_ASSERT_TRUE(step == 0 || r.run_ends == (step == 3 || step == 9));
    }
}

/* Sensed, calibrated, and with closed gaps: other flags do not spoil it. */
static void test_which_readings_are_fit(void)
{
    test.step = 1;
    for (uint32_t bit = 0; bit < 16u; bit++) {
        const uint32_t flag = 1u << bit;
        const bool spoils = flag == (uint32_t)BRACE_FLAG_GAP_OPEN || flag == (uint32_t)BRACE_FLAG_UNCALIBRATED;
        snapshot.stiffness.now.flags = flag;
        test.result.force_is_sensed = true;
        TEST_ASSERT_EQUAL(!spoils, for_drift().is_fit);
        test.result.force_is_sensed = false;
        TEST_ASSERT_FALSE(for_drift().is_fit);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_first_reading_is_what_all_counts_from);
    RUN_TEST(test_a_later_reading_is_of_the_motors);
    RUN_TEST(test_a_later_reading_is_of_the_commands_where_that_was_asked_for);
    RUN_TEST(test_without_a_sample_there_is_no_reading);
    RUN_TEST(test_a_joint_of_one_encoder_has_no_deflection);
    RUN_TEST(test_a_force_is_sensed_if_all_of_it_is);
    RUN_TEST(test_the_drift_check_gets_each_number);
    RUN_TEST(test_the_drift_check_s_K);
    RUN_TEST(test_a_temperature_that_is_none_counts_as_the_reference);
    RUN_TEST(test_a_run_ends_where_the_motion_turns_round);
    RUN_TEST(test_which_readings_are_fit);
    return UNITY_END();
}
