/* The supervisor: starting, faults and their ends, time, what the snapshot promises. */
#include <string.h>

#include "app_bench.h"

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    bench_start(&p);
}

void tearDown(void) {}

/* ------------------------------------------------------------------------------------------- starting -- */

static void test_start_needs_a_whole_door(void)
{
    brace_hal_t hal = fake.hal;
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_start(NULL, &hal));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_start(&app, NULL));
#define WITHOUT(entry) (hal = fake.hal, hal.entry = NULL, brace_app_start(&app, &hal))
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, WITHOUT(now_us));
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, WITHOUT(joint_read));
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, WITHOUT(nvm_read));
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, WITHOUT(nvm_write));
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, WITHOUT(nvm_erase));
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, WITHOUT(watchdog_feed));
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, WITHOUT(reset_cause));
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, WITHOUT(crash_clear));
}

/* What is asked of an entry that stands alone: nothing. */
static void runs_without_asking(brace_fake_entry_t first, brace_fake_entry_t last)
{
    ticks(50);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    TEST_ASSERT_EQUAL(0, now()->faults);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    for (int entry = first; entry <= (int)last; entry++) {
        TEST_ASSERT_EQUAL(0, fake.calls[entry]);
    }
}

static void test_a_wire_of_which_an_entry_is_absent_is_none(void)
{
    brace_hal_t hal;
    for (int i = 0; i < 8; i++) {
        setUp();
        memset(fake.calls, 0, sizeof fake.calls);
        hal = fake.hal;
        switch (i) {
        case 0: hal.can_setup = NULL; break;
        case 1: hal.can_send = NULL; break;
        case 2: hal.can_receive = NULL; break;
        case 3: hal.can_health = NULL; break;
        case 4: hal.can_recover = NULL; break;
        case 5: hal.serial_setup = NULL; break;
        case 6: hal.serial_read = NULL; break;
        default: hal.serial_write = NULL; break;
        }
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &hal));
        runs_without_asking(i < 5 ? BRACE_FAKE_CAN_SETUP : BRACE_FAKE_SERIAL_SETUP,
                            i < 5 ? BRACE_FAKE_CAN_RECOVER : BRACE_FAKE_SERIAL_READ);
    }
}

/* A board that keeps a key but has no source of random numbers, or has no key yet, lets nobody move it. */
static void test_a_board_without_all_that_a_key_needs_refuses_motion(void)
{
    static const uint8_t key[BRACE_HAL_KEY_BYTES] = {1, 2, 3};
    static const brace_setting_t wanted[] = {BRACE_SETTING_NO_KEY, BRACE_SETTING_NO_KEY, BRACE_SETTING_GUARDED};
    for (int i = 0; i < 3; i++) {
        setUp();
        brace_fake_guarded(&fake, i == 1 ? NULL : key);
        fake.hal.random_read = i == 0 ? NULL : fake.hal.random_read;
        fake.hal.silence_us = 130000u;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
        TEST_ASSERT_EQUAL(wanted[i], brace_app_setting(&app));
        brace_app_become_bench(&app);
        TEST_ASSERT_EQUAL(BRACE_SETTING_BENCH, brace_app_setting(&app));
    }
}

static uint32_t random_low, random_high;
static bool is_low;

static int32_t two_words(void *context, uint32_t *word)
{
    (void)context;
    is_low = !is_low;
    *word = is_low ? random_low : random_high;
    return BRACE_HAL_OK;
}

static uint64_t challenge_of(uint32_t low, uint32_t high)
{
    static const uint8_t key[BRACE_HAL_KEY_BYTES] = {1, 2, 3};
    setUp();
    brace_fake_guarded(&fake, key);
    random_low = low, random_high = high, is_low = false;
    fake.hal.random_read = two_words;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(1);
    brace_session_report_t session;
    brace_app_session(&app, &session);
    TEST_ASSERT_TRUE(session.has_challenge);
    return session.challenge;
}

/* Two random words make a challenge, and every bit of both counts. */
static void test_a_challenge_is_another_one_for_each_bit_of_both_words(void)
{
    const uint64_t first = challenge_of(5u, 9u);
    TEST_ASSERT_TRUE(first == challenge_of(5u, 9u));
    for (int bit = 0; bit < 32; bit++) {
        TEST_ASSERT_TRUE(first != challenge_of(5u ^ 1u << bit, 9u));
        TEST_ASSERT_TRUE(first != challenge_of(5u, 9u ^ 1u << bit));
    }
}

static void test_before_the_first_tick_nothing_is_known(void)
{
    TEST_ASSERT_EQUAL(BRACE_MODE_START, now()->mode);
    TEST_ASSERT_FALSE(now()->k_is_valid);
    TEST_ASSERT_TRUE(now()->theta_rad[BRACE_FEMUR] != now()->theta_rad[BRACE_FEMUR]);
}

static void test_sound_samples_lead_to_monitor(void)
{
    ticks(1);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_EQUAL(0, now()->faults);
    TEST_ASSERT_EQUAL(BRACE_PARAMETERS_SLOT_A, now()->parameter_origin);
    /* docs/physics.md, check values */
    ASSERT_CLOSE(3.96389818, now()->stiffness.now.k_xx_n_per_mm, 2e-5);
    ASSERT_CLOSE(-0.63872477, now()->stiffness.now.k_xz_n_per_mm, 2e-5);
    ASSERT_CLOSE(0.42806022, now()->stiffness.now.k_zz_n_per_mm, 2e-5);
    TEST_ASSERT_EQUAL(0, engaged_flags());
}

static void test_no_samples_at_start_is_a_fault_that_names_the_joints(void)
{
    fake.joint[BRACE_TIBIA].not_newer = true;
    ticks(99);
    TEST_ASSERT_EQUAL(BRACE_MODE_START, now()->mode);
    ticks(2);
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, now()->mode);
    TEST_ASSERT_EQUAL(BRACE_FAULT_SENSOR_TIBIA, now()->faults);
    TEST_ASSERT_FALSE(now()->k_is_valid);
}

static void test_without_stored_parameters_K_is_uncalibrated_and_says_so(void)
{
    bench_board();
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(2);
    TEST_ASSERT_EQUAL(BRACE_FAULT_PARAMETERS, now()->faults);
    TEST_ASSERT_EQUAL(BRACE_PARAMETERS_DEFAULT, now()->parameter_origin);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_BITS(BRACE_FLAG_UNCALIBRATED, BRACE_FLAG_UNCALIBRATED, engaged_flags());
    TEST_ASSERT_BITS(BRACE_FLAG_UNCALIBRATED, BRACE_FLAG_UNCALIBRATED, now()->stiffness.now.flags);
}

static void test_a_start_after_a_crash_is_remembered_until_cleared(void)
{
    fake.reset_cause = BRACE_RESET_FAULT;
    fake.crashed = true;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(200);
    TEST_ASSERT_EQUAL(BRACE_FAULT_CRASHED, now()->faults);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_clear(&app, BRACE_FAULT_CRASHED | BRACE_FAULT_STORE));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_clear(&app, BRACE_FAULT_CRASHED));
    ticks(1);
    TEST_ASSERT_EQUAL(0, now()->faults);
    TEST_ASSERT_FALSE(fake.crashed);
}

/* ----------------------------------------------------------------------------------------------- time -- */

static void test_a_late_tick_is_a_fault_for_a_second_and_K_stays_valid(void)
{
    ticks(5);
    fake.now_us += 2 * TICK_US;
    ticks(1);
    TEST_ASSERT_EQUAL(0, now()->faults);
    fake.now_us += 2 * TICK_US + 1;
    ticks(1);
    TEST_ASSERT_EQUAL(BRACE_FAULT_TICK_LATE, now()->faults);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    ticks(999);
    TEST_ASSERT_EQUAL(BRACE_FAULT_TICK_LATE, now()->faults);
    ticks(1);
    TEST_ASSERT_EQUAL(0, now()->faults);
    TEST_ASSERT_EQUAL(1, counters().ticks_late);
}

static void test_the_clock_may_wrap(void)
{
    fake.now_us = 0xffffffffu - 20u * TICK_US;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    for (int i = 0; i < 60; i++) {
        ticks(1);
        TEST_ASSERT_EQUAL(0, now()->faults);
        TEST_ASSERT_TRUE(now()->k_is_valid);
    }
}

static void test_every_tick_feeds_the_watchdog(void)
{
    const uint32_t before = fake.calls[BRACE_FAKE_WATCHDOG_FEED];
    ticks(50);
    TEST_ASSERT_EQUAL(50, fake.calls[BRACE_FAKE_WATCHDOG_FEED] - before);
}

static void test_a_snapshot_stays_as_it_was_while_the_next_is_made(void)
{
    ticks(5);
    const brace_snapshot_t *const held = now();
    const brace_snapshot_t copy = *held;
    fake.joint[BRACE_FEMUR].sample.motor_rad = 0.7f;
    ticks(1);
    TEST_ASSERT_EQUAL_MEMORY(&copy, held, sizeof copy);
    TEST_ASSERT_TRUE(now() != held);
    TEST_ASSERT_EQUAL(copy.sequence + 1u, now()->sequence);
}

static void test_null_is_refused_everywhere(void)
{
    const brace_parameters_t p = bench_parameters();
    const uint32_t word = 0;
    brace_row_t row;
    const brace_k_question_t question = {.where = BRACE_K_AT_POSTURE};
    brace_k_answer_t k;
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_take_up(NULL, 1, 1));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_let_go(NULL));
    const brace_loading_setup_t setup = {.axis = BRACE_AXIS_X};
    brace_store_status_t status;
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_loading_start(&app, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_loading_start(NULL, &setup));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_stop(NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_store_status(NULL, &status));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_loading_stop(NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_configuration_enter(NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_configuration_leave(NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_parameters_commit(&app, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_parameters_commit(NULL, &p));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_parameters_rollback(NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_parameters_commit_staged(NULL, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_parameters_stage(NULL, 0, 1, &word));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_parameters_stage(&app, 0, 1, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_store_status(&app, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_ask_k(NULL, BRACE_ASKER_PROGRAM, &question, &k));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, NULL, &k));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, &question, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_set_gravity(NULL, 0.0f, 0.0f));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_contact_force(NULL, (brace_displacement_t){1.0f, 0.0f}, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_sag(NULL, (brace_force_t){1.0f, 0.0f}, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_grip(NULL, 0.0f, 0.5f, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_clear(NULL, 0));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_row(NULL, 0, &row));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_row(&app, 0, &row));
    TEST_ASSERT_EQUAL(0, brace_app_row_count(NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_app_row(&app, 0, NULL));
    float value;
    row = (brace_row_t){0};
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_row_value(NULL, 0, &value));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_row_value(&row, 0, NULL));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_start_needs_a_whole_door);
    RUN_TEST(test_a_wire_of_which_an_entry_is_absent_is_none);
    RUN_TEST(test_a_board_without_all_that_a_key_needs_refuses_motion);
    RUN_TEST(test_a_challenge_is_another_one_for_each_bit_of_both_words);
    RUN_TEST(test_before_the_first_tick_nothing_is_known);
    RUN_TEST(test_sound_samples_lead_to_monitor);
    RUN_TEST(test_no_samples_at_start_is_a_fault_that_names_the_joints);
    RUN_TEST(test_without_stored_parameters_K_is_uncalibrated_and_says_so);
    RUN_TEST(test_a_start_after_a_crash_is_remembered_until_cleared);
    RUN_TEST(test_a_late_tick_is_a_fault_for_a_second_and_K_stays_valid);
    RUN_TEST(test_the_clock_may_wrap);
    RUN_TEST(test_every_tick_feeds_the_watchdog);
    RUN_TEST(test_a_snapshot_stays_as_it_was_while_the_next_is_made);
    RUN_TEST(test_null_is_refused_everywhere);
    return UNITY_END();
}
