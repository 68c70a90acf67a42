/* Taking up the play of both joints through the controller: order, letting go in reverse, what if one
 * fails; K meanwhile.
 *
 * The limb here: links held by the ground, each motor behind its gap pulled by a servo. The servo's spring
 * and the joint's are in line, so with a setpoint c off the middle of the gap the motor stands at
 *     m = c within the gap, else (P c + k (+-g/2)) / (P + k), and carries k (m -+ g/2). */
#include "app_bench.h"

#define GAP_RAD 0.01f
#define SERVO_N_MM_PER_RAD 50000.0f
#define SPRING_N_MM_PER_RAD 80000.0f

static bool link_is_free[BRACE_LINK_COUNT];
static float middle_rad[BRACE_LINK_COUNT]; /* motor angle in the middle of the gap */

static void play(void *user, brace_fake_t *board, int32_t joint)
{
    (void)user;
    brace_fake_joint_t *ours = &board->joint[joint];
    const float asked = ours->command.offset_rad, half = 0.5f * GAP_RAD;
    float moved = asked, torque = 0.0f;
    if (!link_is_free[joint] && (asked > half || asked < -half)) {
        const float edge = asked > 0.0f ? half : -half;
        moved = (SERVO_N_MM_PER_RAD * asked + SPRING_N_MM_PER_RAD * edge) / (SERVO_N_MM_PER_RAD + SPRING_N_MM_PER_RAD);
        torque = SPRING_N_MM_PER_RAD * (moved - edge);
        const float most = ours->command.torque_limit_n_mm;
        torque = torque > most ? most : torque < -most ? -most : torque;
    }
    ours->sample.motor_rad = middle_rad[joint] + moved;
    ours->sample.torque_n_mm = torque;
}

static brace_parameters_t with_play(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_FEMUR].gap_rad = p.limb.joint[BRACE_TIBIA].gap_rad = GAP_RAD;
    return p;
}

void setUp(void)
{
    const brace_parameters_t p = with_play();
    bench_start(&p);
    brace_fake_without_force(&fake);
    fake.play = play;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        link_is_free[i] = false;
        fake.joint[i].command = (brace_hal_joint_command_t){0.0f, INFINITY};
    }
    middle_rad[BRACE_FEMUR] = 1.0f;
    middle_rad[BRACE_TIBIA] = 1.4f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal)); /* again: the sensor is gone */
    ticks(50);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
}

void tearDown(void) {}

static brace_takeup_phase_t phase(int joint)
{
    return now()->play[joint].phase;
}

static void until_phase(int joint, brace_takeup_phase_t wanted)
{
    for (int i = 0; i < 10000 && phase(joint) != wanted; i++) {
        ticks(1);
    }
    TEST_ASSERT_EQUAL(wanted, phase(joint));
}

static void until_mode(brace_mode_t wanted)
{
    for (int i = 0; i < 10000 && now()->mode != wanted; i++) {
        ticks(1);
    }
    TEST_ASSERT_EQUAL(wanted, now()->mode);
}

static void test_with_its_gaps_open_K_is_valid_flagged_and_bounded(void)
{
    const brace_gap_stiffness_t *k = &now()->stiffness;
    TEST_ASSERT_EQUAL(TICK_US, app.controller.flank.joint[BRACE_FEMUR + 0].machine.params.tick_us);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_BITS(BRACE_FLAG_GAP_OPEN, BRACE_FLAG_GAP_OPEN, k->now.flags);
    TEST_ASSERT_BITS(BRACE_FLAG_GAP_OPEN, 0, k->engaged.flags);
    ASSERT_CLOSE(0.0, k->now.lambda_max_n_per_mm, 0.0); /* both open: no force is left */
    ASSERT_CLOSE(3.96389818, k->engaged.k_xx_n_per_mm, 1e-4);
}

static void test_one_joint_is_taken_up_held_and_let_go(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_take_up(&app, BRACE_FEMUR, 1));
    ticks(1);
    TEST_ASSERT_EQUAL(BRACE_MODE_TAKING_UP, now()->mode);
    until_phase(BRACE_FEMUR, BRACE_TAKEUP_HOLD);
    const brace_backlash_out_t *femur = &now()->play[BRACE_FEMUR];
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_DONE, femur->takeup);
    TEST_ASSERT_EQUAL(1, femur->flank);
    TEST_ASSERT_TRUE(femur->preload_n_mm > 100.0f);
    ASSERT_CLOSE(fake.joint[BRACE_FEMUR].sample.torque_n_mm, femur->preload_n_mm, 60.0);
    ASSERT_CLOSE(4000.0, fake.joint[BRACE_FEMUR].command.torque_limit_n_mm, 0.5);
    TEST_ASSERT_TRUE(fake.joint[BRACE_FEMUR].command.offset_rad > 0.5f * GAP_RAD);
    ASSERT_CLOSE(0.0, fake.joint[BRACE_TIBIA].command.offset_rad, 0.0);
    /* the femur carries, the tibia does not: one direction is left stiff */
    TEST_ASSERT_TRUE(now()->stiffness.now.lambda_max_n_per_mm > 0.0f);
    TEST_ASSERT_BITS(BRACE_FLAG_GAP_OPEN, BRACE_FLAG_GAP_OPEN, now()->stiffness.now.flags);

    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_let_go(&app));
    until_mode(BRACE_MODE_MONITOR);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_DONE, now()->play[BRACE_FEMUR].takeup);
    ticks(2);
    ASSERT_CLOSE(0.0, fake.joint[BRACE_FEMUR].command.offset_rad, 0.0);
    TEST_ASSERT_TRUE(isinf(fake.joint[BRACE_FEMUR].command.torque_limit_n_mm));
    const uint32_t commands = fake.calls[BRACE_FAKE_JOINT_COMMAND];
    ticks(10);
    TEST_ASSERT_EQUAL(commands, fake.calls[BRACE_FAKE_JOINT_COMMAND]); /* nothing left to command */
}

/* Where a link stands whose motor carries its load through the joint's spring: it stays behind. The controller works
 * the load out as a force on the tip and the force's moment as a turn of the joint: two of Newton's steps, which leave
 * a thousandth of a turn of some hundredths. */
static double behind_the_spring(int joint)
{
    const double yields_rad_per_n_mm = (double)bench_parameters().limb.joint[joint].compliance_rad_per_n_mm;
    return (double)now()->motor_rad[joint] - yields_rad_per_n_mm * (double)now()->play[joint].load_n_mm;
}

static void take_both_up(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_take_up(&app, BRACE_TIBIA, -1));
    ticks(5);
    TEST_ASSERT_EQUAL(BRACE_E_MODE, brace_app_take_up(&app, BRACE_FEMUR, 1)); /* not before the tibia holds */
    until_phase(BRACE_TIBIA, BRACE_TAKEUP_HOLD);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_take_up(&app, BRACE_FEMUR, 1));
    until_phase(BRACE_FEMUR, BRACE_TAKEUP_HOLD);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_HOLD, phase(BRACE_TIBIA));
}

static void test_both_joints_taken_up_K_is_whole(void)
{
    take_both_up();
    ticks(30);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_EQUAL(0, now()->stiffness.now.flags);
    TEST_ASSERT_EQUAL(-1, now()->play[BRACE_TIBIA].flank);
    /* the tip is where the links are, not where the motors are */
    ASSERT_CLOSE(behind_the_spring(BRACE_FEMUR) - 0.5 * (double)GAP_RAD, now()->theta_rad[BRACE_FEMUR], 2e-5);
    ASSERT_CLOSE(behind_the_spring(BRACE_TIBIA) + 0.5 * (double)GAP_RAD, now()->theta_rad[BRACE_TIBIA], 2e-5);
    TEST_ASSERT_TRUE(fabsf(now()->play_shift_mm.x_mm) + fabsf(now()->play_shift_mm.z_mm) > 1.0f);
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_take_up(&app, BRACE_FEMUR, 1)); /* it is */
}

static void test_joints_are_let_go_in_the_reverse_order(void)
{
    take_both_up();
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_let_go(&app));
    bool femur_was_back = false;
    for (int i = 0; i < 10000 && now()->mode == BRACE_MODE_TAKING_UP; i++) {
        ticks(1);
        femur_was_back = femur_was_back || phase(BRACE_FEMUR) == BRACE_TAKEUP_IDLE;
        if (!femur_was_back) {
            TEST_ASSERT_EQUAL(BRACE_TAKEUP_HOLD, phase(BRACE_TIBIA));
        }
    }
    TEST_ASSERT_TRUE(femur_was_back);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_IDLE, phase(BRACE_TIBIA));
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_take_up(&app, BRACE_FEMUR, -1)); /* and may be taken up again */
}

static void test_no_request_while_letting_go(void)
{
    take_both_up();
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_let_go(&app));
    ticks(2);
    TEST_ASSERT_EQUAL(BRACE_E_MODE, brace_app_take_up(&app, BRACE_FEMUR, 1));
    TEST_ASSERT_EQUAL(BRACE_E_MODE, brace_app_configuration_enter(&app));
}

static void test_a_joint_that_fails_takes_the_other_with_it(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_take_up(&app, BRACE_TIBIA, 1));
    until_phase(BRACE_TIBIA, BRACE_TAKEUP_HOLD);
    link_is_free[BRACE_FEMUR] = true; /* nothing holds it */
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_take_up(&app, BRACE_FEMUR, 1));
    until_mode(BRACE_MODE_MONITOR);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_E_TRAVEL, now()->play[BRACE_FEMUR].takeup);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_DONE, now()->play[BRACE_TIBIA].takeup);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_IDLE, phase(BRACE_TIBIA));
    ticks(1);
    ASSERT_CLOSE(0.0, fake.joint[BRACE_FEMUR].command.offset_rad, 0.0);
    ASSERT_CLOSE(0.0, fake.joint[BRACE_TIBIA].command.offset_rad, 0.0);
    TEST_ASSERT_EQUAL(0, now()->faults);
}

static void test_a_flank_lost_while_held_lets_the_other_go(void)
{
    take_both_up();
    link_is_free[BRACE_TIBIA] = true;
    until_mode(BRACE_MODE_MONITOR);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_E_LOST, now()->play[BRACE_TIBIA].takeup);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_IDLE, phase(BRACE_FEMUR));
}

static void test_a_sensor_fault_ends_a_take_up_and_the_limb_goes_back(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_take_up(&app, BRACE_FEMUR, 1));
    until_phase(BRACE_FEMUR, BRACE_TAKEUP_HOLD);
    fake.joint[BRACE_TIBIA].not_newer = true;
    until_mode(BRACE_MODE_FAULT);
    for (int i = 0; i < 3000; i++) {
        ticks(1);
    }
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, now()->mode);
    ASSERT_CLOSE(0.0, fake.joint[BRACE_FEMUR].command.offset_rad, 0.0);
    fake.joint[BRACE_TIBIA].not_newer = false;
    until_mode(BRACE_MODE_MONITOR);
    ticks(100);
    TEST_ASSERT_TRUE(now()->k_is_valid);
}

static void test_requests_that_cannot_be(void)
{
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_app_take_up(&app, BRACE_COXA, 1)); /* this limb has none */
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_take_up(&app, -1, 1));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_take_up(&app, 3, 1));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_take_up(&app, BRACE_FEMUR, 0));
    TEST_ASSERT_EQUAL(BRACE_E_MODE, brace_app_let_go(&app));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    TEST_ASSERT_EQUAL(BRACE_E_MODE, brace_app_take_up(&app, BRACE_FEMUR, 1));
}

static void test_a_limb_that_cannot_be_moved_or_has_no_play_refuses(void)
{
    brace_fake_without_commands(&fake);
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_app_take_up(&app, BRACE_FEMUR, 1));
    const brace_parameters_t p = bench_parameters();
    bench_start(&p);
    ticks(5);
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_app_take_up(&app, BRACE_FEMUR, 1));
    TEST_ASSERT_EQUAL(0, now()->stiffness.now.flags); /* without play nothing is open */
}

static void test_a_drive_too_weak_for_a_take_up_counts_as_open(void)
{
    brace_parameters_t p = with_play();
    p.drive[BRACE_FEMUR].takeup_torque_n_mm = 1.0f; /* below noise and friction */
    bench_start(&p);
    ticks(50);
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_app_take_up(&app, BRACE_FEMUR, 1));
    TEST_ASSERT_BITS(BRACE_FLAG_GAP_OPEN, BRACE_FLAG_GAP_OPEN, now()->stiffness.now.flags);
}

static void test_a_load_that_decides_the_flank_closes_the_gap_without_a_take_up(void)
{
    fake.play = NULL;
    for (int i = 0; i < 300; i++) {
        fake.joint[BRACE_FEMUR].sample.torque_n_mm = -1500.0f;
        fake.joint[BRACE_TIBIA].sample.torque_n_mm = 900.0f;
        ticks(1);
    }
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_EQUAL(0, now()->stiffness.now.flags);
    ASSERT_CLOSE(behind_the_spring(BRACE_FEMUR) + 0.5 * (double)GAP_RAD, now()->theta_rad[BRACE_FEMUR], 2e-5);
    ASSERT_CLOSE(behind_the_spring(BRACE_TIBIA) - 0.5 * (double)GAP_RAD, now()->theta_rad[BRACE_TIBIA], 2e-5);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_with_its_gaps_open_K_is_valid_flagged_and_bounded);
    RUN_TEST(test_one_joint_is_taken_up_held_and_let_go);
    RUN_TEST(test_both_joints_taken_up_K_is_whole);
    RUN_TEST(test_joints_are_let_go_in_the_reverse_order);
    RUN_TEST(test_no_request_while_letting_go);
    RUN_TEST(test_a_joint_that_fails_takes_the_other_with_it);
    RUN_TEST(test_a_flank_lost_while_held_lets_the_other_go);
    RUN_TEST(test_a_sensor_fault_ends_a_take_up_and_the_limb_goes_back);
    RUN_TEST(test_requests_that_cannot_be);
    RUN_TEST(test_a_limb_that_cannot_be_moved_or_has_no_play_refuses);
    RUN_TEST(test_a_drive_too_weak_for_a_take_up_counts_as_open);
    RUN_TEST(test_a_load_that_decides_the_flank_closes_the_gap_without_a_take_up);
    return UNITY_END();
}
