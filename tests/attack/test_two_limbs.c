/* Two limbs on one bus: a request stops the limb that it is sent to, the stop's own frame stops both. Each controller's
 * filter lets in what a filter of hardware would. */
#include "attack.h"

enum { LIMBS = 2, TICKS_OF_MOTION = 40 };

static brace_fake_t board[LIMBS];
static brace_app_t limb[LIMBS];

void setUp(void) {}
void tearDown(void) {}

static void pass_both(int count)
{
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < LIMBS; k++) {
            brace_can_frame_t frame;
            board[k].now_us += TICK_US;
            brace_app_tick(&limb[k], board[k].now_us);
            while (brace_fake_frame_take(&board[k], &frame)) {
            }
        }
    }
}

static void start_both(void)
{
    for (uint32_t k = 0; k < (uint32_t)LIMBS; k++) {
        brace_parameters_t p = bench_parameters();
        p.limb.joint[BRACE_FEMUR].gap_rad = p.limb.joint[BRACE_TIBIA].gap_rad = GAP_RAD;
        p.controller.node_id = 1u + k;
        bench_start(&p); /* into the memory of the bench's own board, */
        brace_fake_start(&board[k]);
        memcpy(board[k].nvm, fake.nvm, sizeof board[k].nvm); /* and from there into this limb's */
        brace_fake_without_force(&board[k]);
        board[k].joint[BRACE_COXA].absent = true;
        board[k].play = held_link;
        board[k].can_filters = true;
        for (int i = 0; i < BRACE_LINK_COUNT; i++) {
            board[k].joint[i].command = (brace_hal_joint_command_t){0.0f, __builtin_inff()};
        }
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&limb[k], &board[k].hal));
    }
    pass_both(50);
    for (int k = 0; k < LIMBS; k++) {
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_take_up(&limb[k], BRACE_FEMUR, 1));
    }
    pass_both(TICKS_OF_MOTION);
}

static void everybody_hears(uint32_t id, const uint8_t *data, uint8_t length)
{
    brace_can_frame_t frame = {.id = id, .length = length};
    if (length > 0u) {
        memcpy(frame.data, data, length);
    }
    for (int k = 0; k < LIMBS; k++) {
        TEST_ASSERT_TRUE(brace_fake_frame_arrives(&board[k], &frame));
    }
}

/* Whether each limb still moves, in the third tick and later. */
static void expect_moving(bool first, bool second)
{
    const bool expected[LIMBS] = {first, second};
    float before[LIMBS];
    pass_both(2);
    for (int k = 0; k < LIMBS; k++) {
        before[k] = board[k].joint[BRACE_FEMUR].command.offset_rad;
    }
    pass_both(10);
    for (int k = 0; k < LIMBS; k++) {
        TEST_ASSERT_EQUAL(expected[k], before[k] != board[k].joint[BRACE_FEMUR].command.offset_rad);
    }
}

static void test_a_request_stops_one_limb_and_the_frame_stops_both(void)
{
    const uint8_t request[8] = {BRACE_REQUEST_LOADING_TEST_STOP, 0x11};
    start_both();
    expect_moving(true, true);
    everybody_hears(0x601, request, 8);
    expect_moving(false, true);
    everybody_hears(0x001, NULL, 0);
    expect_moving(false, false);
    start_both();
    everybody_hears(0x001, NULL, 0);
    expect_moving(false, false);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_request_stops_one_limb_and_the_frame_stops_both);
    return UNITY_END();
}
