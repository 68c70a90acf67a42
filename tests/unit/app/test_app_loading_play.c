/* A loading test of a limb with play: every tick of it watches the play and reports K. */
#include "can_bench.h"
#include "loading_bench.h"

/* Both flanks carry: what the ground pushes and the limb weighs. The motors have moved, so that nothing seems stuck. */
void setUp(void)
{
    brace_parameters_t p = bench_parameters();
    p.drive[BRACE_FEMUR].takeup_torque_n_mm = p.drive[BRACE_TIBIA].takeup_torque_n_mm = 8000.0f;
    p.limb.joint[BRACE_FEMUR].gap_rad = p.limb.joint[BRACE_TIBIA].gap_rad = 0.005f;
    stand(&p);
    weight_n = 20.0;
    preload_z_n = 25.0;
    ticks(20);
    theta1 = 1.001, theta2 = 1.401;
    ticks(300);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    TEST_ASSERT_EQUAL(0, now()->stiffness.now.flags);
}

void tearDown(void) {}

static void ask_for_the_dearest(void)
{
    uint8_t data[8];
    const brace_point_t tip = now()->tip_mm;
    brace_can_pack_k_at_tip_knee_up_request(&(brace_can_k_at_tip_knee_up_request_t){7, tip.x_mm, tip.z_mm}, data);
    arrives(0x600u + NODE, data, 8);
}

/* To the end of a test, with or without somebody who asks whenever the answer before has come. Every tick senses,
 * commands the drives, and reports K of its own samples. */
static void run_and_watch_every_tick(bool asked)
{
    for (int i = 0; i < 60000 && app.controller.mode.now == BRACE_MODE_LOADING_TEST; i++) {
        const uint32_t reads = fake.calls[BRACE_FAKE_JOINT_READ], commands = fake.calls[BRACE_FAKE_JOINT_COMMAND];
        if (asked && i % K_TICKS == 0) {
            ask_for_the_dearest();
        }
        ticks(1);
        drain();
        TEST_ASSERT_NOT_EQUAL(BRACE_BACKLASH_FAULT, now()->play[BRACE_FEMUR].state);
        TEST_ASSERT_NOT_EQUAL(BRACE_BACKLASH_FAULT, now()->play[BRACE_TIBIA].state);
        TEST_ASSERT_NOT_EQUAL(reads, fake.calls[BRACE_FAKE_JOINT_READ]);
        TEST_ASSERT_NOT_EQUAL(commands, fake.calls[BRACE_FAKE_JOINT_COMMAND]);
        TEST_ASSERT_TRUE(now()->k_is_valid);
        TEST_ASSERT_EQUAL(fake.now_us, now()->taken_us);
    }
}

static void test_every_tick_senses_commands_and_reports_k(void)
{
    for (int asked = 0; asked < 2; asked++) {
        setUp();
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
        run_and_watch_every_tick(asked == 1);
        TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
        TEST_ASSERT_EQUAL(17, result()->rows);
        ASSERT_CLOSE(3.5, result()->least_squares.k_x_n_per_mm, 0.05); /* test_app_loading.c says how near it is */
    }
}

static void test_flanks_that_carry_are_known_through_and_after_it(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    for (int i = 0; i < 60000 && app.controller.mode.now == BRACE_MODE_LOADING_TEST; i++) {
        ticks(1);
        TEST_ASSERT_TRUE(now()->k_is_valid);
        TEST_ASSERT_EQUAL(0, now()->stiffness.now.flags);
    }
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
    ticks(50);
    TEST_ASSERT_EQUAL(0, now()->stiffness.now.flags);
}

static void test_play_that_was_taken_up_is_held_when_it_is_done(void)
{
    const int32_t flank[2] = {-1, 1}; /* as the loads are, so that there is nothing to be taken up */
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_take_up(&app, BRACE_FEMUR + i, flank[i]));
        for (int j = 0; j < 9000 && now()->play[BRACE_FEMUR + i].phase != BRACE_TAKEUP_HOLD; j++) {
            ticks(1);
        }
        TEST_ASSERT_EQUAL(BRACE_TAKEUP_HOLD, now()->play[BRACE_FEMUR + i].phase);
    }
    brace_loading_setup_t small = along_x; /* within what the take-up's torque leaves */
    small.step_mm = 0.05f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &small));
    run_and_watch_every_tick(false);
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
    TEST_ASSERT_EQUAL(BRACE_MODE_TAKING_UP, app.controller.mode.now);
    ticks(100);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_HOLD, now()->play[BRACE_FEMUR].phase);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_HOLD, now()->play[BRACE_TIBIA].phase);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_tick_senses_commands_and_reports_k);
    RUN_TEST(test_flanks_that_carry_are_known_through_and_after_it);
    RUN_TEST(test_play_that_was_taken_up_is_held_when_it_is_done);
    return UNITY_END();
}
