/* How one mode follows another: from every mode, with sound joints and without, with and without faults. */
#include "mode/faults.h"
#include "mode/mode.h"

#include "unity.h"

enum { TICK_US = 1000 };

static mode_state_t mode;
static mode_inputs_t inputs;

void setUp(void)
{
    inputs = (mode_inputs_t){.joints_are_sound = true, .tick_us = TICK_US};
    mode_start(&mode);
}

void tearDown(void) {}

static bool update_from(brace_mode_t from)
{
    mode.now = from;
    return mode_update(&mode, &inputs);
}

static void test_a_start_waits_for_sound_joints_for_100_ms(void)
{
    TEST_ASSERT_EQUAL(BRACE_MODE_START, mode.now);
    inputs.joints_are_sound = false;
    for (int i = 1; i < 100; i++) {
        TEST_ASSERT_FALSE(mode_update(&mode, &inputs));
        TEST_ASSERT_EQUAL(BRACE_MODE_START, mode.now);
    }
    TEST_ASSERT_FALSE(mode_update(&mode, &inputs));
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, mode.now);
    mode_start(&mode);
    inputs.tick_us = 3000; /* no whole number of them is 100 ms */
    for (int i = 1; i <= 34; i++) {
        TEST_ASSERT_EQUAL(BRACE_MODE_START, mode.now);
        TEST_ASSERT_FALSE(mode_update(&mode, &inputs));
    }
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, mode.now);
    inputs.tick_us = TICK_US;
    mode_start(&mode);
    inputs.joints_are_sound = true;
    TEST_ASSERT_FALSE(mode_update(&mode, &inputs));
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, mode.now);
    mode_start(&mode);
    inputs.takes_up = true; /* a start ends in MONITOR, whatever the next tick finds */
    TEST_ASSERT_FALSE(mode_update(&mode, &inputs));
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, mode.now);
    inputs.takes_up = false;
    mode_start(&mode);
    inputs.faults = BRACE_FAULT_ENCODER_STUCK; /* brought along */
    TEST_ASSERT_FALSE(mode_update(&mode, &inputs));
    TEST_ASSERT_EQUAL(BRACE_MODE_START, mode.now);
}

static void test_what_moves_the_limb_names_the_mode(void)
{
    static const brace_mode_t working[] = {BRACE_MODE_MONITOR, BRACE_MODE_TAKING_UP, BRACE_MODE_LOADING_TEST,
                                           BRACE_MODE_FAULT};
    for (int i = 0; i < 4; i++) {
        for (uint32_t moves = 0; moves < 4u; moves++) {
            inputs.tests = (moves & 1u) != 0u, inputs.takes_up = (moves & 2u) != 0u;
            TEST_ASSERT_FALSE(update_from(working[i]));
            TEST_ASSERT_EQUAL(inputs.tests      ? BRACE_MODE_LOADING_TEST
                              : inputs.takes_up ? BRACE_MODE_TAKING_UP
                                                : BRACE_MODE_MONITOR,
                              mode.now);
        }
    }
}

static void test_without_K_whatever_moves_ends(void)
{
    static const brace_mode_t working[] = {BRACE_MODE_MONITOR, BRACE_MODE_TAKING_UP, BRACE_MODE_LOADING_TEST};
    inputs.tests = true;
    for (int i = 0; i < 3; i++) {
        inputs.faults = BRACE_FAULT_SENSOR_FEMUR;
        TEST_ASSERT_TRUE(update_from(working[i]));
        TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, mode.now);
        inputs.faults = BRACE_FAULT_DRIVE_REFUSES; /* the controller still reports K, but moves nothing */
        TEST_ASSERT_TRUE(update_from(working[i]));
        TEST_ASSERT_EQUAL(BRACE_MODE_LOADING_TEST, mode.now);
        inputs.faults = BRACE_FAULT_MODEL_DRIFT; /* no reason to stop */
        TEST_ASSERT_FALSE(update_from(working[i]));
        TEST_ASSERT_EQUAL(BRACE_MODE_LOADING_TEST, mode.now);
    }
    inputs.faults = BRACE_FAULT_SENSOR_FEMUR;
    TEST_ASSERT_FALSE(update_from(BRACE_MODE_FAULT)); /* it has ended already */
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, mode.now);
    inputs.faults = 0;
    inputs.joints_are_sound = false;
    TEST_ASSERT_FALSE(update_from(BRACE_MODE_FAULT));
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, mode.now);
}

static void test_configuration_ends_by_hand(void)
{
    inputs.tests = inputs.takes_up = true;
    for (int i = 0; i < 2; i++) {
        inputs.faults = i == 0 ? 0u : (uint32_t)BRACE_FAULT_SENSOR_FEMUR;
        TEST_ASSERT_FALSE(update_from(BRACE_MODE_CONFIGURATION));
        TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, mode.now);
    }
}

static void test_in_which_modes_k_is_reported(void)
{
    TEST_ASSERT_TRUE(mode_reports_k(BRACE_MODE_MONITOR));
    TEST_ASSERT_TRUE(mode_reports_k(BRACE_MODE_TAKING_UP));
    TEST_ASSERT_TRUE(mode_reports_k(BRACE_MODE_LOADING_TEST));
    TEST_ASSERT_FALSE(mode_reports_k(BRACE_MODE_START));
    TEST_ASSERT_FALSE(mode_reports_k(BRACE_MODE_CONFIGURATION));
    TEST_ASSERT_FALSE(mode_reports_k(BRACE_MODE_FAULT));
}

/* --- how long a fault lasts ----------------------------------------------------------------------------------- */

/* Each fault that comes and goes stands for 100 ms after its cause, TICK_LATE for 1 s; a cause that comes back begins
 * that anew. Faults do not touch one another. */
static void test_a_fault_lasts_a_while_after_its_cause(void)
{
    const uint32_t stands = BRACE_FAULT_PARAMETERS | BRACE_FAULT_STORE | BRACE_FAULT_MODEL_DRIFT | BRACE_FAULT_CRASHED |
                            BRACE_FAULT_OLD_PARAMETERS | BRACE_FAULT_JUMP_COXA | BRACE_FAULT_JUMP_FEMUR |
                            BRACE_FAULT_JUMP_TIBIA;
    for (uint32_t bit = 0; bit < (uint32_t)BRACE_FAULT_COUNT; bit++) {
        const uint32_t fault = 1u << bit, another = 1u << (bit == 0u ? 1u : 0u);
        const int over = fault == (uint32_t)BRACE_FAULT_TICK_LATE ? 1000 : 100;
        if ((fault & stands) != 0u) {
            continue;
        }
        faults_t faults = {.now = 0u};
        faults_update(&faults, fault, 0u, false, TICK_US);
        TEST_ASSERT_EQUAL_HEX32(0u, faults.now); /* no fault stands yet */
        for (int round = 0; round < 2; round++) {
            faults_update(&faults, fault | another, 0u, true, TICK_US);
            TEST_ASSERT_EQUAL_HEX32(fault | another, faults.now);
            for (int i = 1; i < over; i++) {
                faults_update(&faults, another, 0u, i % 2 == 0, TICK_US);
                TEST_ASSERT_EQUAL_HEX32(fault | another, faults.now);
            }
            if (round == 0) { /* the cause comes back in time */
                faults_update(&faults, fault | another, 0u, false, TICK_US);
            }
        }
        faults_update(&faults, another, 0u, true, TICK_US);
        TEST_ASSERT_EQUAL_HEX32(another, faults.now);
    }
}

/* Ticks that do not divide the 100 ms: the first one beyond ends it. */
static void test_a_fault_ends_with_the_first_tick_beyond(void)
{
    faults_t faults = {.now = 0u};
    faults_update(&faults, BRACE_FAULT_MEMORY, 0u, true, 3000u);
    for (int i = 1; i <= 33; i++) {
        faults_update(&faults, 0u, 0u, true, 3000u);
        TEST_ASSERT_EQUAL_HEX32(BRACE_FAULT_MEMORY, faults.now);
    }
    faults_update(&faults, 0u, 0u, true, 3000u);
    TEST_ASSERT_EQUAL_HEX32(0u, faults.now);
}

static void test_some_faults_stand_as_long_as_somebody_says_so(void)
{
    static const uint32_t stands[] = {BRACE_FAULT_PARAMETERS, BRACE_FAULT_STORE,          BRACE_FAULT_MODEL_DRIFT,
                                      BRACE_FAULT_CRASHED,    BRACE_FAULT_OLD_PARAMETERS, BRACE_FAULT_JUMP_COXA,
                                      BRACE_FAULT_JUMP_FEMUR, BRACE_FAULT_JUMP_TIBIA};
    for (int i = 0; i < 8; i++) {
        faults_t faults = {.now = 0u};
        faults_update(&faults, 0u, stands[i], false, TICK_US);
        TEST_ASSERT_EQUAL_HEX32(stands[i], faults.now);
        faults_update(&faults, BRACE_FAULT_MEMORY, stands[i], true, 10u * TICK_US);
        TEST_ASSERT_EQUAL_HEX32(stands[i] | BRACE_FAULT_MEMORY, faults.now);
        faults_update(&faults, BRACE_FAULT_MEMORY, 0u, true, TICK_US);
        TEST_ASSERT_EQUAL_HEX32(BRACE_FAULT_MEMORY, faults.now);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_start_waits_for_sound_joints_for_100_ms);
    RUN_TEST(test_what_moves_the_limb_names_the_mode);
    RUN_TEST(test_without_K_whatever_moves_ends);
    RUN_TEST(test_configuration_ends_by_hand);
    RUN_TEST(test_in_which_modes_k_is_reported);
    RUN_TEST(test_a_fault_lasts_a_while_after_its_cause);
    RUN_TEST(test_a_fault_ends_with_the_first_tick_beyond);
    RUN_TEST(test_some_faults_stand_as_long_as_somebody_says_so);
    return UNITY_END();
}
