/* Taking up several joints: one after the other, held, and let go in the reverse order, whatever a joint said of the
 * take-up before. */
#include <string.h>

#include "flank/takeup.h"
#include "unity.h"

static takeup_t takeup;
static flank_t flank;

void setUp(void)
{
    memset(&takeup, 0, sizeof takeup);
    memset(&flank, 0, sizeof flank);
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        flank.joint[i].has_play = flank.joint[i].watched = true;
        flank.joint[i].machine.phase = BRACE_TAKEUP_IDLE;
        flank.joint[i].out.phase = BRACE_TAKEUP_IDLE;
    }
}

void tearDown(void) {}

/* What the machine of a joint does in a tick: it begins what was requested. */
static void goes_to(int joint, brace_takeup_phase_t phase, brace_takeup_result_t result)
{
    flank_joint_t *ours = &flank.joint[joint];
    ours->machine.requested = false;
    ours->machine.phase = (uint8_t)phase;
    ours->out.phase = phase;
    ours->out.takeup = result;
}

static void holds(int joint)
{
    goes_to(joint, BRACE_TAKEUP_HOLD, BRACE_TAKEUP_DONE);
    takeup_step(&takeup, &flank);
    TEST_ASSERT_TRUE(takeup_holds(&takeup, &flank));
}

static void test_joints_are_taken_up_one_at_a_time_and_once(void)
{
    TEST_ASSERT_FALSE(takeup_runs(&takeup));
    TEST_ASSERT_EQUAL(BRACE_OK, takeup_request(&takeup, &flank, BRACE_TIBIA, 1));
    TEST_ASSERT_TRUE(takeup_runs(&takeup));
    TEST_ASSERT_FALSE(takeup_holds(&takeup, &flank));
    TEST_ASSERT_EQUAL(BRACE_E_MODE, takeup_request(&takeup, &flank, BRACE_FEMUR, 1)); /* the first does not hold yet */
    holds(BRACE_TIBIA);
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, takeup_request(&takeup, &flank, BRACE_TIBIA, 1));
    TEST_ASSERT_EQUAL(BRACE_OK, takeup_request(&takeup, &flank, BRACE_FEMUR, -1));
    TEST_ASSERT_FALSE(takeup_holds(&takeup, &flank));
    holds(BRACE_FEMUR);
}

/* The second joint's last take-up failed. That says nothing of the one that has just been requested. */
static void test_a_failure_of_before_does_not_end_a_takeup_that_has_not_begun(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, takeup_request(&takeup, &flank, BRACE_TIBIA, 1));
    holds(BRACE_TIBIA);
    flank.joint[BRACE_FEMUR].out.takeup = BRACE_TAKEUP_E_TRAVEL;
    TEST_ASSERT_EQUAL(BRACE_OK, takeup_request(&takeup, &flank, BRACE_FEMUR, 1));
    takeup_step(&takeup, &flank);
    TEST_ASSERT_FALSE(takeup.letting_go);
    goes_to(BRACE_FEMUR, BRACE_TAKEUP_APPROACH, BRACE_TAKEUP_RUNNING);
    takeup_step(&takeup, &flank);
    TEST_ASSERT_FALSE(takeup.letting_go);
    goes_to(BRACE_FEMUR, BRACE_TAKEUP_LET_GO, BRACE_TAKEUP_E_TRAVEL); /* now it is this one's */
    takeup_step(&takeup, &flank);
    TEST_ASSERT_TRUE(takeup.letting_go);
}

/* The first joint loses what it holds while the second is on its way. */
static void test_a_joint_that_is_lost_lets_all_go(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, takeup_request(&takeup, &flank, BRACE_TIBIA, 1));
    holds(BRACE_TIBIA);
    TEST_ASSERT_EQUAL(BRACE_OK, takeup_request(&takeup, &flank, BRACE_FEMUR, 1));
    goes_to(BRACE_TIBIA, BRACE_TAKEUP_HOLD, BRACE_TAKEUP_E_TRAVEL);
    takeup_step(&takeup, &flank);
    TEST_ASSERT_TRUE(takeup.letting_go);
    TEST_ASSERT_EQUAL(BRACE_E_MODE, takeup_request(&takeup, &flank, BRACE_COXA, 1));
}

static void test_the_last_joint_is_let_go_first(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, takeup_request(&takeup, &flank, BRACE_TIBIA, 1));
    holds(BRACE_TIBIA);
    TEST_ASSERT_EQUAL(BRACE_OK, takeup_request(&takeup, &flank, BRACE_FEMUR, 1));
    holds(BRACE_FEMUR);
    takeup_let_go(&takeup);
    TEST_ASSERT_FALSE(takeup_holds(&takeup, &flank));
    takeup_step(&takeup, &flank);
    TEST_ASSERT_TRUE(flank.joint[BRACE_FEMUR].machine.let_go);
    TEST_ASSERT_FALSE(flank.joint[BRACE_TIBIA].machine.let_go);
    goes_to(BRACE_FEMUR, BRACE_TAKEUP_IDLE, BRACE_TAKEUP_DONE);
    takeup_step(&takeup, &flank);
    TEST_ASSERT_TRUE(takeup.letting_go);
    TEST_ASSERT_EQUAL(1, takeup.count);
    takeup_step(&takeup, &flank);
    TEST_ASSERT_TRUE(flank.joint[BRACE_TIBIA].machine.let_go);
    goes_to(BRACE_TIBIA, BRACE_TAKEUP_IDLE, BRACE_TAKEUP_DONE);
    takeup_step(&takeup, &flank);
    TEST_ASSERT_FALSE(takeup.letting_go);
    TEST_ASSERT_FALSE(takeup_runs(&takeup));
    takeup_let_go(&takeup); /* there is nothing to let go */
    TEST_ASSERT_FALSE(takeup.letting_go);
    TEST_ASSERT_EQUAL(BRACE_OK, takeup_request(&takeup, &flank, BRACE_FEMUR, 1));
}

/* To ask whether a joint may be taken up changes nothing. */
static void test_a_question_requests_nothing(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, takeup_may_request(&takeup, &flank, BRACE_TIBIA, 1));
    TEST_ASSERT_FALSE(takeup_runs(&takeup));
    TEST_ASSERT_FALSE(flank.joint[BRACE_TIBIA].machine.requested);
    TEST_ASSERT_EQUAL(BRACE_OK, takeup_request(&takeup, &flank, BRACE_TIBIA, 1));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, takeup_may_request(&takeup, &flank, BRACE_TIBIA, 1));
    TEST_ASSERT_EQUAL(BRACE_E_MODE, takeup_may_request(&takeup, &flank, BRACE_FEMUR, 1));
    holds(BRACE_TIBIA);
    flank.joint[BRACE_FEMUR].machine.state = BRACE_BACKLASH_FAULT;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, takeup_may_request(&takeup, &flank, BRACE_FEMUR, 1));
    TEST_ASSERT_EQUAL(1, takeup.count);
}

/* A joint on its way back no longer holds, although nobody has let it go. */
static void test_only_holding_is_holding(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, takeup_request(&takeup, &flank, BRACE_TIBIA, 1));
    holds(BRACE_TIBIA);
    static const brace_takeup_phase_t others[] = {BRACE_TAKEUP_IDLE, BRACE_TAKEUP_APPROACH, BRACE_TAKEUP_VERIFY,
                                                  BRACE_TAKEUP_LET_GO};
    for (int i = 0; i < 4; i++) {
        flank.joint[BRACE_TIBIA].machine.phase = (uint8_t)others[i];
        TEST_ASSERT_FALSE(takeup_holds(&takeup, &flank));
        TEST_ASSERT_EQUAL(BRACE_E_MODE, takeup_request(&takeup, &flank, BRACE_FEMUR, 1));
    }
}

static void test_what_is_no_joint_or_flank_is_refused(void)
{
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, takeup_request(&takeup, &flank, BRACE_COXA - 1, 1));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, takeup_request(&takeup, &flank, BRACE_TIBIA + 1, 1));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, takeup_request(&takeup, &flank, BRACE_TIBIA, 0));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, takeup_request(&takeup, &flank, BRACE_TIBIA, 2));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, takeup_request(&takeup, &flank, BRACE_TIBIA, -2));
    flank.joint[BRACE_TIBIA].watched = false;
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, takeup_request(&takeup, &flank, BRACE_TIBIA, 1));
    TEST_ASSERT_EQUAL(0, takeup.count);
    TEST_ASSERT_EQUAL(BRACE_OK, takeup_request(&takeup, &flank, BRACE_COXA, -1));
    TEST_ASSERT_EQUAL(-1, flank.joint[BRACE_COXA].machine.chosen_flank);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_joints_are_taken_up_one_at_a_time_and_once);
    RUN_TEST(test_a_failure_of_before_does_not_end_a_takeup_that_has_not_begun);
    RUN_TEST(test_a_joint_that_is_lost_lets_all_go);
    RUN_TEST(test_the_last_joint_is_let_go_first);
    RUN_TEST(test_a_question_requests_nothing);
    RUN_TEST(test_only_holding_is_holding);
    RUN_TEST(test_what_is_no_joint_or_flank_is_refused);
    return UNITY_END();
}
