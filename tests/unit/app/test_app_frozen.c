/* A sensor that reports the same again and again, with a new time stamp: seen by what the limb does meanwhile. And a
 * watchdog that only a whole tick feeds. */
#include <math.h>

#include "app_bench.h"

enum {
    SEEN_WITHIN_TICKS = 500, /* 250 ms, after what proves it has grown large enough */
    LOOK_EACH_TICKS = 54     /* at a joint, where all ask for a K in every tick */
};

static const double femur_mm = 185.0, tibia_mm = 313.5;
static brace_parameters_t parameters;
static float frozen_rad, frozen_n_mm;
static int frozen_joint;
static bool freezes_torque;

void setUp(void)
{
    parameters = bench_parameters();
    parameters.sensor.noise_n = 0.05f;
    bench_start(&parameters);
    ticks(50);
}

void tearDown(void) {}

/* Plays some ticks. returns after how many ENCODER_STUCK was set, or 0 */
static int seen_after(int most, void (*step)(int tick))
{
    for (int i = 1; i <= most; i++) {
        step(i);
        ticks(1);
        if ((now()->faults & (uint32_t)BRACE_FAULT_ENCODER_STUCK) != 0u) {
            TEST_ASSERT_FALSE(now()->k_is_valid);
            return i;
        }
    }
    return 0;
}

/* What the motors would carry in this posture, by the tip's force: levers of straight links. */
static void carry(float force_z_n)
{
    const double theta1_rad = 1.0, theta2_rad = 1.4, b = theta1_rad - theta2_rad;
    const double knee_x = femur_mm * cos(theta1_rad), tip_x = knee_x + tibia_mm * cos(b);
    fake.force_z_n = force_z_n;
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = (float)(-tip_x * (double)force_z_n);
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = (float)((tip_x - knee_x) * (double)force_z_n);
}

/* ------------------------------------------------------------------------------- angle and torque frozen -- */

static float rising_n(int tick) /* to 6 N within 0.3 s: 1,600 N mm at the femur joint */
{
    return 0.02f * (float)(tick < 300 ? tick : 300);
}

static void press_more(int tick)
{
    carry(rising_n(tick));
    fake.joint[frozen_joint].sample.torque_n_mm = frozen_n_mm;
}

static void test_a_joint_that_does_not_feel_the_tip_s_force_is_frozen(void)
{
    for (frozen_joint = BRACE_FEMUR; frozen_joint <= BRACE_TIBIA; frozen_joint++) {
        setUp();
        carry(0.0f);
        ticks(5);
        frozen_n_mm = fake.joint[frozen_joint].sample.torque_n_mm;
        const int after = seen_after(SEEN_WITHIN_TICKS, press_more);
        TEST_ASSERT_NOT_EQUAL(0, after);
        for (int i = 0; i < 300; i++) { /* it measures again */
            carry(rising_n(300 - i));
            fake.joint[frozen_joint].sample.motor_rad += 1e-5f;
            ticks(1);
        }
        TEST_ASSERT_EQUAL(0, now()->faults);
        TEST_ASSERT_TRUE(now()->k_is_valid);
    }
}

/* Every asker asks for K at a posture of its own in every tick: most ticks are dear then. */
static void press_more_while_all_ask(int tick)
{
    const bool is_spatial = !fake.joint[BRACE_COXA].absent;
    for (int asker = 0; asker < (int)BRACE_ASKER_COUNT; asker++) {
        brace_k_answer_t answer;
        const brace_k_question_t question = {
            .where = is_spatial ? BRACE_K_IN_SPACE : BRACE_K_AT_POSTURE,
            .theta_rad = {0.3f, 0.5f + 0.1f * (float)asker, 1.0f + 1e-4f * (float)tick}};
        (void)brace_app_ask_k(&app, (brace_asker_t)asker, &question, &answer);
    }
    press_more(tick);
}

static void fit_the_coxa_joint(void)
{
    fake.joint[BRACE_COXA].absent = false;
    fake.joint[BRACE_COXA].sample.motor_rad = 0.3f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal)); /* again: now the joint is there */
    ticks(50);
}

static void test_questions_in_every_tick_hide_no_frozen_joint(void)
{
    for (int turn = 0; turn < 4; turn++) {
        setUp();
        if (turn >= 2) {
            fit_the_coxa_joint();
        }
        carry(0.0f);
        ticks(5);
        frozen_joint = turn % 2 == 0 ? BRACE_FEMUR : BRACE_TIBIA;
        frozen_n_mm = fake.joint[frozen_joint].sample.torque_n_mm;
        TEST_ASSERT_NOT_EQUAL(0, seen_after(SEEN_WITHIN_TICKS + 2 * LOOK_EACH_TICKS, press_more_while_all_ask));
    }
}

static void press_and_feel(int tick)
{
    carry(rising_n(tick));
}

static void test_joints_that_feel_it_are_not(void)
{
    carry(0.0f);
    ticks(5);
    TEST_ASSERT_EQUAL(0, seen_after(1000, press_and_feel));
    TEST_ASSERT_EQUAL(0, now()->faults);
}

static void press_within_friction(int tick)
{
    (void)tick;
    carry(tick % 200 < 100 ? 0.0f : 0.1f); /* 23 N mm at most; friction is 20 */
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = frozen_n_mm;
}

static void test_what_friction_hides_is_no_proof(void)
{
    frozen_n_mm = 0.0f;
    TEST_ASSERT_EQUAL(0, seen_after(1500, press_within_friction));
}

static void rest(int tick)
{
    (void)tick;
}

static void test_a_limb_at_rest_is_not_frozen(void)
{
    carry(3.0f);
    TEST_ASSERT_EQUAL(0, seen_after(5000, rest));
}

static void press_late(int tick)
{
    carry(tick < 150 ? 0.0f : 6.0f); /* the motors feel it 150 ms after the sensor */
    fake.force_z_n = 6.0f;
}

static void test_a_joint_that_has_long_stood_may_take_its_time_to_answer(void)
{
    carry(0.0f);
    ticks(2000);
    TEST_ASSERT_EQUAL(0, seen_after(1000, press_late));
}

/* ---------------------------------------------------------------------------------- frozen while it moves -- */

/* Motors follow their commands; one of them reports what it reported when it froze. */
static void follow(void *user, brace_fake_t *board, int32_t joint)
{
    static const float stands_rad[] = {0.0f, 1.0f, 1.4f};
    (void)user;
    brace_hal_joint_t *sample = &board->joint[joint].sample;
    sample->motor_rad = stands_rad[joint] + board->joint[joint].command.offset_rad;
    if (joint == frozen_joint) {
        sample->motor_rad = frozen_rad;
        sample->torque_n_mm = freezes_torque ? frozen_n_mm : sample->torque_n_mm;
    }
}

/* A take-up moves the tibia. */
static void start_take_up(bool has_sensor)
{
    parameters.drive[BRACE_TIBIA].takeup_torque_n_mm = 2000.0f;
    parameters.limb.joint[BRACE_TIBIA].gap_rad = 0.05f;
    bench_start(&parameters);
    if (!has_sensor) {
        brace_fake_without_force(&fake);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    }
    frozen_joint = -1;
    fake.play = follow;
    ticks(50);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_take_up(&app, BRACE_TIBIA, 1));
    ticks(100);
    TEST_ASSERT_EQUAL(BRACE_MODE_TAKING_UP, now()->mode);
}

static void test_a_joint_that_is_commanded_to_move_and_reports_the_same_is_frozen(void)
{
    start_take_up(true);
    frozen_joint = BRACE_TIBIA;
    freezes_torque = true;
    frozen_rad = fake.joint[BRACE_TIBIA].sample.motor_rad;
    frozen_n_mm = fake.joint[BRACE_TIBIA].sample.torque_n_mm;
    const int after = seen_after(SEEN_WITHIN_TICKS, rest);
    TEST_ASSERT_NOT_EQUAL(0, after);
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, now()->mode);
}

static void test_a_joint_that_follows_is_not(void)
{
    start_take_up(true);
    TEST_ASSERT_EQUAL(0, seen_after(SEEN_WITHIN_TICKS, rest));
}

/* A motor that has no torque left stands, and that is no fault of its sensor. */
static void test_a_joint_at_the_end_of_its_torque_is_not(void)
{
    start_take_up(false);
    frozen_joint = BRACE_TIBIA;
    freezes_torque = true;
    frozen_rad = fake.joint[BRACE_TIBIA].sample.motor_rad;
    frozen_n_mm = 0.95f * parameters.drive[BRACE_TIBIA].takeup_torque_n_mm;
    for (int i = 0; i < SEEN_WITHIN_TICKS; i++) {
        ticks(1);
        TEST_ASSERT_BITS_LOW(BRACE_FAULT_ENCODER_STUCK, now()->faults);
    }
}

/* -------------------------------------------------------------------------------------- the angle alone -- */

/* The torque swings by 1000 N mm to either side, a fifth of the motor's range, and the tip's force does not. */
static void swing(int tick)
{
    fake.joint[frozen_joint].sample.torque_n_mm = frozen_n_mm + 1000.0f * sinf(0.02f * (float)tick);
}

static void test_a_standing_angle_under_a_torque_that_nothing_holds_is_frozen(void)
{
    for (frozen_joint = BRACE_FEMUR; frozen_joint <= BRACE_TIBIA; frozen_joint++) {
        setUp();
        carry(3.0f);
        ticks(100);
        frozen_n_mm = fake.joint[frozen_joint].sample.torque_n_mm;
        const int after = seen_after(SEEN_WITHIN_TICKS, swing);
        TEST_ASSERT_NOT_EQUAL(0, after);
    }
}

/* Without a sensor at the tip nobody on the limb knows what the joint carries. */
static void test_without_the_tip_s_sensor_nothing_is_claimed(void)
{
    brace_fake_without_force(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(100);
    frozen_joint = BRACE_TIBIA;
    frozen_n_mm = 0.0f;
    TEST_ASSERT_EQUAL(0, seen_after(SEEN_WITHIN_TICKS, swing));
}

/* ------------------------------------------------------------------ an angle that stands, by its own joint alone -- */

static float range_n_mm, swing_ratio, dither_rad;

/* A limb without a sensor at its tip, whose tibia encoder stands. */
static void start_alone(float motor_friction_n_mm)
{
    parameters = bench_parameters();
    parameters.drive[BRACE_TIBIA].angle_step_rad = 0.001f;
    parameters.drive[BRACE_TIBIA].motor_friction_n_mm = motor_friction_n_mm;
    range_n_mm = parameters.drive[BRACE_TIBIA].torque_range_n_mm;
    bench_start(&parameters);
    brace_fake_without_force(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(600);
    TEST_ASSERT_EQUAL(0, now()->faults);
}

/* From none to a share of the torque's range and back, in 0.4 s, which the torque's mean over 20 ms follows. */
static void swing_alone(int tick)
{
    const float from_none = (float)(tick % 400 < 200 ? tick % 200 : 200 - tick % 200) / 200.0f;
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = swing_ratio * range_n_mm * from_none;
    fake.joint[BRACE_TIBIA].sample.motor_rad = 1.4f + (tick % 2 == 0 ? dither_rad : 0.0f);
}

static void test_a_quarter_of_the_torque_s_range_moves_any_encoder(void)
{
    dither_rad = 0.0f;
    swing_ratio = 0.22f;
    start_alone(0.0f);
    TEST_ASSERT_EQUAL(0, seen_after(1000, swing_alone));
    swing_ratio = 0.32f;
    start_alone(0.0f);
    TEST_ASSERT_NOT_EQUAL(0, seen_after(SEEN_WITHIN_TICKS, swing_alone));
}

static void test_a_swing_that_friction_hides_moves_none(void)
{
    dither_rad = 0.0f;
    swing_ratio = 0.32f;
    start_alone(0.1f * range_n_mm);
    TEST_ASSERT_EQUAL(0, seen_after(1000, swing_alone));
    start_alone(0.05f * range_n_mm);
    TEST_ASSERT_NOT_EQUAL(0, seen_after(SEEN_WITHIN_TICKS, swing_alone));
}

/* An encoder between two of its steps reports both in turns, and stands all the same. */
static void test_an_angle_stands_within_half_a_step(void)
{
    swing_ratio = 0.32f;
    dither_rad = 0.0004f;
    start_alone(0.0f);
    TEST_ASSERT_NOT_EQUAL(0, seen_after(SEEN_WITHIN_TICKS, swing_alone));
    dither_rad = 0.0011f;
    start_alone(0.0f);
    TEST_ASSERT_EQUAL(0, seen_after(1000, swing_alone));
}

/* A drive takes its time to give way: the torque jumps, and the angle has a quarter of a second to follow. */
static void jump_alone(int tick)
{
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = tick < 10 ? 0.0f : 0.4f * range_n_mm;
    fake.joint[BRACE_TIBIA].sample.motor_rad = tick < 10 ? 1.4f + 0.002f * (float)tick : 1.42f;
}

static void test_an_angle_may_stand_for_a_quarter_of_a_second(void)
{
    start_alone(0.0f);
    const int after = seen_after(SEEN_WITHIN_TICKS, jump_alone);
    TEST_ASSERT_GREATER_THAN(240, after);
    TEST_ASSERT_LESS_THAN(400, after);
}

/* The link's encoder leaves the motor's behind; three of its samples are absurd, which says nothing. */
static void leave_alone(int tick)
{
    const float moved_rad = tick < 300 ? 0.0f : 0.0002f * (float)(tick - 300);
    fake.joint[BRACE_TIBIA].sample.link_rad = tick == 318 || tick == 319 || tick == 320 ? 1e6f : 1.4f + moved_rad;
}

static void test_absurd_samples_of_the_link_hide_no_frozen_motor(void)
{
    start_alone(0.0f);
    leave_alone(0);
    fake.joint[BRACE_TIBIA].sample.motor_rad += 0.01f; /* stands anew from here, with a link's encoder */
    const int after = seen_after(SEEN_WITHIN_TICKS, leave_alone);
    TEST_ASSERT_GREATER_THAN(320, after);
}

/* ------------------------------------------------------------------------------------------ how it ends -- */

/* The torque alone cannot say whether it lied or the encoder stood: the claim stays as long as the joint does. */
static void test_a_standing_joint_stays_frozen_until_somebody_has_looked_at_it(void)
{
    dither_rad = 0.0f;
    swing_ratio = 0.32f;
    start_alone(0.0f);
    TEST_ASSERT_NOT_EQUAL(0, seen_after(SEEN_WITHIN_TICKS, swing_alone));
    ticks(5000);
    TEST_ASSERT_EQUAL(BRACE_FAULT_ENCODER_STUCK, now()->faults);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_clear(&app, BRACE_FAULT_ENCODER_STUCK));
    TEST_ASSERT_EQUAL(0, seen_after(5000, rest));
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    TEST_ASSERT_TRUE(now()->k_is_valid);
}

static void test_a_frozen_joint_that_was_cleared_is_seen_again(void)
{
    dither_rad = 0.0f;
    swing_ratio = 0.32f;
    start_alone(0.0f);
    for (int times = 0; times < 3; times++) {
        TEST_ASSERT_NOT_EQUAL(0, seen_after(SEEN_WITHIN_TICKS, swing_alone));
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_clear(&app, BRACE_FAULT_ENCODER_STUCK));
    }
}

static void test_a_joint_that_moves_is_not_frozen_any_more(void)
{
    dither_rad = 0.0f;
    swing_ratio = 0.32f;
    start_alone(0.0f);
    TEST_ASSERT_NOT_EQUAL(0, seen_after(SEEN_WITHIN_TICKS, swing_alone));
    fake.joint[BRACE_TIBIA].sample.motor_rad += 0.0011f;
    ticks(150);
    TEST_ASSERT_EQUAL(0, now()->faults);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
}

/* Nothing is known of a joint before its first sample, and zero is an angle like others. */
static void test_a_joint_that_stands_at_zero_without_torque_is_not_frozen(void)
{
    carry(3.0f);
    fake.joint[BRACE_FEMUR].sample.motor_rad = fake.joint[BRACE_FEMUR].sample.torque_n_mm = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    TEST_ASSERT_EQUAL(0, seen_after(1000, rest));
}

/* ----------------------------------------------------------------------------------------- the watchdog -- */

static uint32_t feeds;

static void count_feeds(void *context)
{
    (void)context;
    feeds++;
}

/* A joint's read that spoils the tick's record, as a jump past a part of the tick would. */
static uint32_t spoils;

static int32_t read_and_spoil(void *context, float *force_x_n, float *force_z_n)
{
    (void)context;
    *force_x_n = *force_z_n = 0.0f;
    app.controller.parts_done ^= spoils;
    return BRACE_HAL_OK;
}

static void test_only_a_whole_tick_feeds_the_watchdog(void)
{
    fake.hal.watchdog_feed = count_feeds;
    fake.hal.tip_force_read = read_and_spoil;
    feeds = spoils = 0;
    ticks(10);
    TEST_ASSERT_EQUAL(10, feeds);
    spoils = 1;
    ticks(10);
    TEST_ASSERT_EQUAL(10, feeds);
    spoils = 0;
    ticks(10);
    TEST_ASSERT_EQUAL(20, feeds);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_joint_that_does_not_feel_the_tip_s_force_is_frozen);
    RUN_TEST(test_questions_in_every_tick_hide_no_frozen_joint);
    RUN_TEST(test_joints_that_feel_it_are_not);
    RUN_TEST(test_what_friction_hides_is_no_proof);
    RUN_TEST(test_a_limb_at_rest_is_not_frozen);
    RUN_TEST(test_a_joint_that_has_long_stood_may_take_its_time_to_answer);
    RUN_TEST(test_a_joint_that_is_commanded_to_move_and_reports_the_same_is_frozen);
    RUN_TEST(test_a_joint_that_follows_is_not);
    RUN_TEST(test_a_joint_at_the_end_of_its_torque_is_not);
    RUN_TEST(test_a_standing_angle_under_a_torque_that_nothing_holds_is_frozen);
    RUN_TEST(test_without_the_tip_s_sensor_nothing_is_claimed);
    RUN_TEST(test_a_quarter_of_the_torque_s_range_moves_any_encoder);
    RUN_TEST(test_a_swing_that_friction_hides_moves_none);
    RUN_TEST(test_an_angle_stands_within_half_a_step);
    RUN_TEST(test_an_angle_may_stand_for_a_quarter_of_a_second);
    RUN_TEST(test_absurd_samples_of_the_link_hide_no_frozen_motor);
    RUN_TEST(test_a_standing_joint_stays_frozen_until_somebody_has_looked_at_it);
    RUN_TEST(test_a_frozen_joint_that_was_cleared_is_seen_again);
    RUN_TEST(test_a_joint_that_moves_is_not_frozen_any_more);
    RUN_TEST(test_a_joint_that_stands_at_zero_without_torque_is_not_frozen);
    RUN_TEST(test_only_a_whole_tick_feeds_the_watchdog);
    return UNITY_END();
}
