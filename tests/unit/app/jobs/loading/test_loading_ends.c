/* What a loading test reports when it cannot be what was asked for: the limb folds or straightens meanwhile, play is
 * lost, the force of the ground is no longer known, or nothing is displaced. */
#include "loading_bench.h"

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    stand(&p);
}

void tearDown(void) {}

static void to_the_end(void)
{
    for (int i = 0; i < 60000 && app.controller.mode.now == BRACE_MODE_LOADING_TEST; i++) {
        ticks(1);
    }
    ticks(2);
}

static void stands_as_before(brace_loading_outcome_t wanted)
{
    TEST_ASSERT_EQUAL(wanted, result()->outcome);
    ASSERT_CLOSE(0.0, fake.joint[BRACE_FEMUR].command.offset_rad, 0.0);
    ASSERT_CLOSE(0.0, fake.joint[BRACE_TIBIA].command.offset_rad, 0.0);
}

/* --- a load near what folds the limb --------------------------------------------------------------------------- */

/* Joints that stand, and report a torque with some noise. */
static void stand_noisily(void *user, brace_fake_t *board, int32_t joint)
{
    (void)user;
    noise_n = 1.0f;
    board->joint[joint].sample.torque_n_mm = noise();
}

/* A limb that stands still, pressed towards its hip by a force on its sensor. */
static bool stands_pressed_by(float force_n)
{
    fake.force_x_n = -force_n * cosf(0.3f);
    fake.force_z_n = -force_n * sinf(0.3f);
    ticks(2);
    return now()->k_is_valid;
}

static float least_that_folds_n(void)
{
    float stands_n = 1.0f, folds_n = 9000.0f;
    TEST_ASSERT_FALSE(stands_pressed_by(folds_n));
    while (folds_n - stands_n > 1e-4f * folds_n) {
        const float force_n = 0.5f * (stands_n + folds_n);
        if (stands_pressed_by(force_n)) {
            stands_n = force_n;
        } else {
            folds_n = force_n;
        }
    }
    TEST_ASSERT_TRUE(stands_pressed_by(stands_n));
    return stands_n;
}

static brace_parameters_t soft_parameters(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = p.limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = 1e-5f;
    return p;
}

static void press_nearly_folding(float theta2_rad)
{
    const brace_parameters_t p = soft_parameters();
    stand(&p);
    fake.play = stand_noisily;
    fake.joint[BRACE_FEMUR].sample.motor_rad = 0.3f + 0.3f * theta2_rad;
    fake.joint[BRACE_TIBIA].sample.motor_rad = theta2_rad;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    (void)stands_pressed_by(1.0f);
    ticks(50);
    (void)least_that_folds_n();
}

/* Where a side of the posture folds, the levers are those of straight links, and the test goes on. */
static void test_levers_where_a_side_of_the_posture_folds(void)
{
    press_nearly_folding(0.2f);
    const float force_x_n = fake.force_x_n, force_z_n = fake.force_z_n;
    brace_loading_setup_t small = along_x;
    small.step_mm = 0.002f, small.steps_per_side = 2, small.source = BRACE_LOADING_COMMANDED;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &small));
    const brace_loading_t *test = &app.controller.loading;
    for (int i = 0; i < 300 && test->phase == LOADING_LEVERS; i++) {
        ticks(1);
    }
    TEST_ASSERT_NOT_EQUAL(LOADING_LEVERS, test->phase);
    TEST_ASSERT_EQUAL_FLOAT(force_x_n, fake.force_x_n);
    TEST_ASSERT_EQUAL_FLOAT(force_z_n, fake.force_z_n);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    const brace_pose_t *straight = &app.controller.posture.unbent;
    TEST_ASSERT_EQUAL_FLOAT(straight->lever_femur.x_mm, test->lever_femur.x_mm);
    TEST_ASSERT_EQUAL_FLOAT(straight->lever_femur.z_mm, test->lever_femur.z_mm);
    TEST_ASSERT_EQUAL_FLOAT(-straight->lever_tibia.x_mm, test->lever_knee.x_mm);
    TEST_ASSERT_EQUAL_FLOAT(-straight->lever_tibia.z_mm, test->lever_knee.z_mm);
    to_the_end();
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
}

static void test_a_limb_that_folds_before_it_is_read_has_no_force_to_start_from(void)
{
    press_nearly_folding(0.2f);
    (void)stands_pressed_by(10.0f);
    ticks(100);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    for (int i = 0; i < 1000 && app.controller.loading.phase != LOADING_DWELL; i++) {
        ticks(1);
    }
    TEST_ASSERT_EQUAL(LOADING_DWELL, app.controller.loading.phase);
    TEST_ASSERT_FALSE(stands_pressed_by(9000.0f));
    to_the_end();
    stands_as_before(BRACE_LOADING_E_NO_FORCE);
    TEST_ASSERT_EQUAL(0, result()->rows);
}

/* The load straightens the knee until its levers lie along one another: no step along x would be safe. */
static void test_a_limb_that_its_load_straightens_is_too_flat(void)
{
    const brace_parameters_t p = soft_parameters();
    int flat = 0;
    for (float theta2_rad = 0.056f; theta2_rad > 0.0502f && flat == 0; theta2_rad -= 0.001f) {
        stand(&p);
        fake.play = NULL;
        fake.joint[BRACE_FEMUR].sample.motor_rad = 0.3f;
        fake.joint[BRACE_TIBIA].sample.motor_rad = theta2_rad;
        fake.joint[BRACE_FEMUR].sample.torque_n_mm = fake.joint[BRACE_TIBIA].sample.torque_n_mm = 0.0f;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
        fake.force_x_n = -1.5f * sinf(0.3f);
        fake.force_z_n = 1.5f * cosf(0.3f);
        ticks(60);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
        to_the_end();
        flat = result()->outcome == BRACE_LOADING_E_FLAT;
    }
    TEST_ASSERT_EQUAL(1, flat);
    stands_as_before(BRACE_LOADING_E_FLAT);
    TEST_ASSERT_EQUAL(0, result()->rows);
}

/* --- what the test stands on is lost ----------------------------------------------------------------------------- */

static void test_play_that_opens_in_a_test_ends_it(void)
{
    const int32_t flank[2] = {-1, 1}; /* as the loads are */
    brace_parameters_t p = bench_parameters();
    p.drive[BRACE_FEMUR].takeup_torque_n_mm = p.drive[BRACE_TIBIA].takeup_torque_n_mm = 8000.0f;
    p.limb.joint[BRACE_FEMUR].gap_rad = p.limb.joint[BRACE_TIBIA].gap_rad = 0.005f;
    stand(&p);
    weight_n = 20.0;
    preload_z_n = 25.0;
    ticks(20);
    theta1 = 1.001, theta2 = 1.401;
    ticks(300);
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_take_up(&app, BRACE_FEMUR + i, flank[i]));
        for (int j = 0; j < 9000 && now()->play[BRACE_FEMUR + i].phase != BRACE_TAKEUP_HOLD; j++) {
            ticks(1);
        }
        TEST_ASSERT_EQUAL(BRACE_TAKEUP_HOLD, now()->play[BRACE_FEMUR + i].phase);
    }
    brace_loading_setup_t small = along_x;
    small.step_mm = 0.05f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &small));
    ticks(300);
    TEST_ASSERT_EQUAL(BRACE_LOADING_RUNNING, result()->outcome);
    weight_n = preload_x_n = preload_z_n = 0.0; /* lifted off, and nothing pulls its links down */
    to_the_end();
    TEST_ASSERT_EQUAL(BRACE_LOADING_E_LOST, result()->outcome);
}

/* The joints of a nearly straight limb cannot measure the force. When the sensor at its tip falls silent, the loading
 * test has nothing to measure, and ends. */
static void test_a_sensor_that_falls_silent_on_a_straight_limb_ends_the_test(void)
{
    brace_parameters_t p = bench_parameters();
    p.slow.joint_compliance_per_degc = 0.003f;
    stand(&p);
    fake.play = NULL;
    fake.joint[BRACE_TIBIA].sample.motor_rad = 0.08f;
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = fake.joint[BRACE_TIBIA].sample.torque_n_mm = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    fake.force_x_n = 0.2f, fake.force_z_n = 0.1f;
    ticks(60);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    for (int i = 0; i < 2000 && app.controller.loading.phase != LOADING_REFERENCE; i++) {
        ticks(1);
    }
    TEST_ASSERT_EQUAL(LOADING_REFERENCE, app.controller.loading.phase);
    brace_fake_fail_next(&fake, BRACE_FAKE_TIP_FORCE_READ, 2000, BRACE_HAL_E_DEVICE);
    to_the_end();
    stands_as_before(BRACE_LOADING_E_NO_FORCE);
    TEST_ASSERT_EQUAL(1, result()->rows);
}

/* --- nothing to judge by ----------------------------------------------------------------------------------------- */

/* Steps below what an encoder resolves, of motors that do not follow: no displacement, and so no slope. */
static void test_motors_that_displace_nothing_give_no_slope(void)
{
    brace_parameters_t p = bench_parameters();
    p.drive[BRACE_FEMUR].angle_step_rad = p.drive[BRACE_TIBIA].angle_step_rad = 1.5e-3f; /* 4096 a turn */
    stand(&p);
    fake.play = NULL;
    brace_loading_setup_t least = along_x;
    least.step_mm = 0.001f;
    least.steps_per_side = 2;
    run(&least);
    stands_as_before(BRACE_LOADING_E_FLAT);
    TEST_ASSERT_EQUAL(9, result()->rows);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_levers_where_a_side_of_the_posture_folds);
    RUN_TEST(test_a_limb_that_folds_before_it_is_read_has_no_force_to_start_from);
    RUN_TEST(test_a_limb_that_its_load_straightens_is_too_flat);
    RUN_TEST(test_play_that_opens_in_a_test_ends_it);
    RUN_TEST(test_a_sensor_that_falls_silent_on_a_straight_limb_ends_the_test);
    RUN_TEST(test_motors_that_displace_nothing_give_no_slope);
    return UNITY_END();
}
