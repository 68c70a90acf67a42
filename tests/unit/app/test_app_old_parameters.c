/* A set that was stored and is not whole any more: the set before it is in force, and every wire reports that. */
#include <string.h>

#include "app_bench.h"

static brace_parameters_t first, second;
static float k_first_n_per_mm, k_second_n_per_mm;

/* A start, until there is a K. */
static void start_again(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(5);
    TEST_ASSERT_TRUE(now()->k_is_valid);
}

static float k_now(void)
{
    return now()->stiffness.now.k_xx_n_per_mm;
}

/* Two sets were stored, one after the other; the second is in slot B. */
void setUp(void)
{
    first = second = bench_parameters();
    second.limb.link[BRACE_TIBIA].bending_mm_per_n *= 2.0f;
    bench_board();
    bench_store(&first);
    start_again();
    k_first_n_per_mm = k_now();
    bench_store(&second);
    start_again();
    k_second_n_per_mm = k_now();
    TEST_ASSERT_TRUE(k_first_n_per_mm > 1.01f * k_second_n_per_mm);
    TEST_ASSERT_EQUAL(BRACE_PARAMETERS_SLOT_B, now()->parameter_origin);
}

void tearDown(void) {}

static void rot(void)
{
    fake.nvm[1][200] ^= 8u;
}

static void expect_old(bool is_reported)
{
    TEST_ASSERT_EQUAL_FLOAT(k_first_n_per_mm, k_now());
    TEST_ASSERT_EQUAL_HEX32(is_reported ? BRACE_FAULT_OLD_PARAMETERS : 0u, now()->faults);
    TEST_ASSERT_EQUAL_HEX32(is_reported ? BRACE_FLAG_UNCALIBRATED : 0u, engaged_flags() & BRACE_FLAG_UNCALIBRATED);
    TEST_ASSERT_EQUAL_HEX32(engaged_flags(), now()->stiffness.now.flags);
    TEST_ASSERT_EQUAL(BRACE_PARAMETERS_SLOT_A, now()->parameter_origin);
    TEST_ASSERT_EQUAL(1, now()->parameter_sequence);
    TEST_ASSERT_EQUAL(2, now()->parameter_sequence_wanted);
}

static void expect_no_fault(float k_n_per_mm, uint32_t sequence)
{
    TEST_ASSERT_EQUAL_FLOAT(k_n_per_mm, k_now());
    TEST_ASSERT_EQUAL_HEX32(0, now()->faults);
    TEST_ASSERT_EQUAL_HEX32(0, engaged_flags() & BRACE_FLAG_UNCALIBRATED);
    TEST_ASSERT_EQUAL(sequence, now()->parameter_sequence);
    TEST_ASSERT_EQUAL(sequence, now()->parameter_sequence_wanted);
}

static void test_two_whole_sets_are_no_fault(void)
{
    expect_no_fault(k_second_n_per_mm, 2);
}

/* From the first tick on, K carries the flag: there is no tick before it. */
static void test_a_rotten_set_is_a_fault_at_once_and_after_every_start(void)
{
    rot();
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
        TEST_ASSERT_EQUAL_HEX32(BRACE_FAULT_OLD_PARAMETERS, now()->faults);
        for (int tick = 0; tick < 20; tick++) {
            ticks(1);
            TEST_ASSERT_BITS_HIGH(BRACE_FAULT_OLD_PARAMETERS, now()->faults);
            TEST_ASSERT_BITS_HIGH(now()->k_is_valid ? BRACE_FLAG_UNCALIBRATED : 0u, now()->stiffness.now.flags);
        }
        expect_old(true);
    }
    ticks(2000);
    expect_old(true);
}

static void test_k_elsewhere_carries_the_flag_too(void)
{
    const brace_k_question_t there = {.where = BRACE_K_AT_POSTURE, .theta_rad = {0.0f, 0.8f, 1.2f}};
    brace_k_answer_t answer;
    for (int is_cleared = 0; is_cleared < 2; is_cleared++) {
        rot();
        start_again();
        if (is_cleared != 0) {
            TEST_ASSERT_EQUAL(BRACE_OK, brace_app_clear(&app, BRACE_FAULT_OLD_PARAMETERS));
        }
        int32_t status = brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, &there, &answer);
        for (int i = 0; i < 20 && status != BRACE_OK; i++) {
            ticks(1);
            status = brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, &there, &answer);
        }
        TEST_ASSERT_EQUAL(BRACE_OK, status);
        TEST_ASSERT_EQUAL_HEX32(is_cleared != 0 ? 0u : BRACE_FLAG_UNCALIBRATED,
                                answer.k.flags & BRACE_FLAG_UNCALIBRATED);
        rot(); /* whole again */
    }
}

/* Who clears it takes the set in force, until the next start. Both sequences stay visible. */
static void test_cleared_it_is_gone_until_the_next_start(void)
{
    rot();
    start_again();
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_clear(&app, BRACE_FAULT_OLD_PARAMETERS));
    ticks(200);
    expect_old(false);
    start_again();
    expect_old(true);
}

static void push(const brace_parameters_t *set)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_commit(&app, set));
    for (int i = 0; i < 3000 && (i == 0 || brace_app_is_storing(&app)); i++) {
        ticks(1);
    }
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_leave(&app));
    ticks(5);
}

/* A set that is pushed again ends it for good, and no number is given twice. */
static void test_pushed_again_it_is_gone_for_good(void)
{
    rot();
    start_again();
    push(&second);
    expect_no_fault(k_second_n_per_mm, 3);
    start_again();
    expect_no_fault(k_second_n_per_mm, 3);
    fake.nvm[1][200] ^= 8u; /* and the next one that rots is one again */
    start_again();
    TEST_ASSERT_EQUAL_HEX32(BRACE_FAULT_OLD_PARAMETERS, now()->faults);
    TEST_ASSERT_EQUAL(3, now()->parameter_sequence_wanted);
}

/* Who has cleared one and stores sets afterwards hears of the next one that rots. */
static void test_a_push_that_fails_leaves_it(void)
{
    brace_parameters_t impossible = second;
    impossible.limb.femur_mm = -1.0f;
    rot();
    start_again();
    push(&impossible);
    expect_old(true);
}

static void test_a_roll_back_is_no_rot(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_rollback(&app));
    ticks(1000);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_leave(&app));
    ticks(5);
    expect_no_fault(k_first_n_per_mm, 1);
    start_again();
    expect_no_fault(k_first_n_per_mm, 1);
    rot(); /* what was left for good may rot */
    start_again();
    expect_no_fault(k_first_n_per_mm, 1);
}

/* The set to go back to may rot: what is in force is still the newest. */
static void test_the_older_set_may_rot(void)
{
    fake.nvm[0][200] ^= 8u;
    start_again();
    expect_no_fault(k_second_n_per_mm, 2);
}

/* With no set whole it is the fault of old: defaults. */
static void test_both_rotten_are_defaults(void)
{
    rot();
    fake.nvm[0][200] ^= 8u;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(5);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FAULT_PARAMETERS, now()->faults);
    TEST_ASSERT_EQUAL(0, now()->parameter_sequence);
    TEST_ASSERT_EQUAL(0, now()->parameter_sequence_wanted);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_two_whole_sets_are_no_fault);
    RUN_TEST(test_a_rotten_set_is_a_fault_at_once_and_after_every_start);
    RUN_TEST(test_k_elsewhere_carries_the_flag_too);
    RUN_TEST(test_cleared_it_is_gone_until_the_next_start);
    RUN_TEST(test_pushed_again_it_is_gone_for_good);
    RUN_TEST(test_a_push_that_fails_leaves_it);
    RUN_TEST(test_a_roll_back_is_no_rot);
    RUN_TEST(test_the_older_set_may_rot);
    RUN_TEST(test_both_rotten_are_defaults);
    return UNITY_END();
}
