/* CONFIGURATION: entering and leaving it, sets of parameters stored, put in force and taken back. */
#include <string.h>

#include "app_bench.h"

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    bench_start(&p);
}

void tearDown(void) {}

static void test_configuration_is_entered_from_rest_and_left_to_start(void)
{
    TEST_ASSERT_EQUAL(BRACE_E_MODE, brace_app_configuration_enter(&app)); /* still in START */
    ticks(5);
    TEST_ASSERT_EQUAL(BRACE_E_MODE, brace_app_configuration_leave(&app));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    ticks(5);
    TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, now()->mode);
    TEST_ASSERT_FALSE(now()->k_is_valid);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_leave(&app));
    ticks(1);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    TEST_ASSERT_TRUE(now()->k_is_valid);
}

static void test_parameters_are_stored_in_configuration_only(void)
{
    brace_parameters_t p = bench_parameters();
    ticks(5);
    TEST_ASSERT_EQUAL(BRACE_E_MODE, brace_app_parameters_commit(&app, &p));
    TEST_ASSERT_EQUAL(BRACE_E_MODE, brace_app_parameters_rollback(&app));
}

/* A set that is in force no longer waits as a copy. A set that was refused stays in waiting. */
static void test_what_was_staged_ends_when_it_comes_in_force(void)
{
    const float femur_mm = 191.0f;
    uint32_t word;
    memcpy(&word, &femur_mm, 4);
    ticks(5);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_stage(&app, 1, 1, &word));
    TEST_ASSERT_TRUE(brace_app_has_staged(&app));
    const brace_parameters_t set = *brace_app_parameters_staged(&app);
    TEST_ASSERT_EQUAL_FLOAT(191.0f, set.limb.femur_mm);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_commit(&app, &set));
    ticks(1000);
    TEST_ASSERT_EQUAL_FLOAT(191.0f, brace_app_parameters(&app)->limb.femur_mm);
    TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, now()->mode);
    TEST_ASSERT_FALSE(brace_app_has_staged(&app));
    TEST_ASSERT_EQUAL_PTR(brace_app_parameters(&app), brace_app_parameters_staged(&app));
}

/* The job counts how long nobody has asked for anything. A store at work counts as asked for. */
static void test_idle_time_counts_from_the_start_and_from_each_request(void)
{
    static parameter_job_t job;
    memset(&job, 0xa5, sizeof job);
    parameter_job_start(&job, &fake.hal);
    TEST_ASSERT_EQUAL_UINT32(5, parameter_job_idle_us(&job, 5));
    TEST_ASSERT_EQUAL_UINT32(12, parameter_job_idle_us(&job, 7));
    parameter_job_keep_open(&job);
    TEST_ASSERT_EQUAL_UINT32(3, parameter_job_idle_us(&job, 3));
    parameter_job_open(&job);
    TEST_ASSERT_EQUAL_UINT32(2, parameter_job_idle_us(&job, 2));
    job.storing = true;
    TEST_ASSERT_EQUAL_UINT32(0, parameter_job_idle_us(&job, 9));
    job.storing = false;
    TEST_ASSERT_EQUAL_UINT32(9, parameter_job_idle_us(&job, 9));
    /* ten seconds lie between two erases; from the start on a commit need not wait */
    TEST_ASSERT_EQUAL_UINT32(0, parameter_job_wait_ms(&job));
    job.apart_us = 0;
    TEST_ASSERT_EQUAL_UINT32(10000, parameter_job_wait_ms(&job));
    parameter_job_age(&job, 1);
    TEST_ASSERT_EQUAL_UINT32(10000, parameter_job_wait_ms(&job)); /* rounded up */
    parameter_job_age(&job, 999);
    TEST_ASSERT_EQUAL_UINT32(9999, parameter_job_wait_ms(&job));
    parameter_job_age(&job, UINT32_MAX);
    TEST_ASSERT_EQUAL_UINT32(0, parameter_job_wait_ms(&job));
}

/* The set in force is taken from the store once more: it is as stored again. While the store is at work that is not
 * asked for a second time, and what it does goes on. */
static void test_a_set_that_has_changed_in_memory_is_taken_from_the_store(void)
{
    static parameter_job_t job;
    const brace_parameters_t stored = bench_parameters();
    brace_parameters_t other = stored;
    parameter_job_start(&job, &fake.hal);
    job.in_force.limb.femur_mm = 1.0f;
    job.comes_in_force = false;
    parameter_job_reload(&job);
    TEST_ASSERT_TRUE(parameter_job_is_busy(&job));
    TEST_ASSERT_FALSE(parameter_job_is_fresh(&job));
    int count = 0;
    while (!parameter_job_step(&job) && count++ < 1000) {
        parameter_job_reload(&job);
    }
    TEST_ASSERT_TRUE(count < 1000 && job.comes_in_force);
    TEST_ASSERT_EQUAL_MEMORY(&stored, &job.in_force, sizeof stored);
    TEST_ASSERT_EQUAL_HEX32(brace_parameters_crc(&stored), job.crc);
    other.limb.femur_mm = 190.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, parameter_job_commit(&job, &other));
    parameter_job_reload(&job);
    TEST_ASSERT_TRUE(parameter_job_is_fresh(&job));
    for (count = 0; !parameter_job_step(&job) && count < 1000; count++) {
    }
    TEST_ASSERT_EQUAL_MEMORY(&other, &job.in_force, sizeof other);
}

/* A master may be silent for 130 ms, or for as long as the board's HAL says. */
static void test_how_long_a_master_may_be_silent(void)
{
    TEST_ASSERT_EQUAL_UINT32(130000, app.controller.ownership.session.life_us);
    fake.hal.silence_us = 250000;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    TEST_ASSERT_EQUAL_UINT32(250000, app.controller.ownership.session.life_us);
    fake.hal.silence_us = 0;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    TEST_ASSERT_EQUAL_UINT32(130000, app.controller.ownership.session.life_us);
}

/* A controller reports what it read from the store even before its first tick. */
static void test_faults_are_reported_before_the_first_tick(void)
{
    brace_fake_start(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    TEST_ASSERT_EQUAL_HEX32(BRACE_FAULT_PARAMETERS, now()->faults);
    TEST_ASSERT_EQUAL(BRACE_PARAMETERS_DEFAULT, now()->parameter_origin);
    TEST_ASSERT_FALSE(now()->k_is_valid);
    TEST_ASSERT_TRUE(isnan(now()->force_x_n) && isnan(now()->tip_mm.x_mm) && isnan(now()->theta_rad[BRACE_FEMUR]));
}

static void settle(void)
{
    for (int i = 0; i < 2000 && brace_app_configuration_leave(&app) != BRACE_OK; i++) {
        ticks(1);
    }
    TEST_ASSERT_EQUAL(BRACE_MODE_START, app.controller.mode.now);
    ticks(2);
}

static void test_a_committed_set_is_in_force_and_survives_a_restart_and_can_be_taken_back(void)
{
    brace_parameters_t p = bench_parameters();
    ticks(5);
    const uint32_t crc_before = now()->parameter_crc;
    const float k_before = now()->stiffness.now.k_xx_n_per_mm;
    p.limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm *= 2.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_commit(&app, &p));
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_app_parameters_commit(&app, &p));
    TEST_ASSERT_EQUAL(BRACE_E_MODE, brace_app_configuration_leave(&app));
    settle();
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_EQUAL(BRACE_PARAMETERS_SLOT_B, now()->parameter_origin);
    TEST_ASSERT_EQUAL_HEX32(brace_parameters_crc(&p), now()->parameter_crc);
    const float k_after = now()->stiffness.now.k_xx_n_per_mm;
    TEST_ASSERT_TRUE(k_after < 0.95f * k_before);

    brace_fake_reset(&fake, BRACE_RESET_POWER);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(2);
    ASSERT_CLOSE(k_after, now()->stiffness.now.k_xx_n_per_mm, 0.0);

    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_rollback(&app));
    settle();
    TEST_ASSERT_EQUAL_HEX32(crc_before, now()->parameter_crc);
    ASSERT_CLOSE(k_before, now()->stiffness.now.k_xx_n_per_mm, 0.0);
}

static void test_a_set_that_cannot_be_is_refused(void)
{
    brace_parameters_t p = bench_parameters();
    ticks(5);
    p.limb.femur_mm = -1.0f;
    const uint32_t crc = now()->parameter_crc;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_commit(&app, &p));
    ticks(5); /* more than the store needs to check it */
    brace_store_status_t store;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_store_status(&app, &store));
    TEST_ASSERT_EQUAL(BRACE_STORE_FAILED, store.state);
    TEST_ASSERT_EQUAL(BRACE_STORE_E_REFUSED, store.failure);
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, store.refusal);
    TEST_ASSERT_EQUAL_STRING("geometry.femur_mm", brace_parameter_key(store.wrong_index));
    TEST_ASSERT_EQUAL_HEX32(crc, now()->parameter_crc);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_leave(&app));
}

/* A commit of another set than was named is counted as refused. Whatever else a store is asked for is not, however it
 * ends, also when such a commit came before it. */
static void test_only_a_set_that_is_not_the_one_named_is_counted(void)
{
    brace_parameters_t p = bench_parameters();
    const uint32_t *refused = &app.controller.parameters.commits_refused;
    uint32_t word, wrong_index;
    p.limb.femur_mm = 190.0f;
    memcpy(&word, &p.limb.femur_mm, sizeof word);
    for (int before = 0; before < 2; before++) {
        const uint32_t count = (uint32_t)before;
        setUp();
        ticks(5);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
        if (before != 0) {
            TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_stage(
                                            &app, brace_parameter_number(BRACE_PARAMETER_GEOMETRY_FEMUR_MM), 1, &word));
            TEST_ASSERT_EQUAL(BRACE_OK,
                              brace_app_parameters_commit_named(&app, brace_parameters_crc(&p) ^ 1u, &wrong_index));
            ticks(1000);
            TEST_ASSERT_EQUAL(BRACE_E_CHECKSUM, app.controller.parameters.store.refusal);
            TEST_ASSERT_EQUAL_UINT32(count, *refused);
        }
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_rollback(&app)); /* there is nothing to go back to */
        ticks(5);
        TEST_ASSERT_EQUAL_UINT32(count, *refused);
        fake.nvm_stuck = 0x04; /* the memory does not keep it */
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_commit(&app, &p));
        ticks(1000);
        TEST_ASSERT_EQUAL_UINT32(count, *refused);
        fake.nvm_stuck = 0;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_commit(&app, &p)); /* it comes in force */
        ticks(1000);
        TEST_ASSERT_EQUAL_HEX32(brace_parameters_crc(&p), app.controller.parameters.crc);
        TEST_ASSERT_EQUAL_UINT32(count, *refused);
        p.limb.tibia_mm = -1.0f; /* no limb is like that */
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_commit(&app, &p));
        ticks(5);
        TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, app.controller.parameters.store.refusal);
        TEST_ASSERT_EQUAL_UINT32(count, *refused);
        p = bench_parameters();
        p.limb.femur_mm = 190.0f;
    }
}

static void test_a_memory_that_does_not_keep_is_a_fault_and_the_old_set_stays(void)
{
    brace_parameters_t p = bench_parameters();
    ticks(5);
    const uint32_t crc = now()->parameter_crc;
    p.limb.femur_mm = 190.0f;
    fake.nvm_stuck = 0x04;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_commit(&app, &p));
    settle();
    TEST_ASSERT_EQUAL(BRACE_FAULT_STORE, now()->faults);
    TEST_ASSERT_EQUAL_HEX32(crc, now()->parameter_crc);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    fake.nvm_stuck = 0;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_commit(&app, &p));
    settle();
    TEST_ASSERT_EQUAL(0, now()->faults);
    TEST_ASSERT_EQUAL_HEX32(brace_parameters_crc(&p), now()->parameter_crc);
}

static void test_a_faulty_controller_can_still_be_configured(void)
{
    fake.joint[BRACE_FEMUR].absent = true;
    ticks(150);
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, now()->mode);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    ticks(2);
    TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, now()->mode);
}

static void test_an_erase_in_configuration_is_no_late_tick(void)
{
    ticks(5);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    ticks(1);
    fake.now_us += 2000000u;
    ticks(1);
    TEST_ASSERT_BITS(BRACE_FAULT_TICK_LATE, 0, now()->faults);
}

/* A member of the set that is being written. */
static uint32_t staged_word(uint32_t index)
{
    uint32_t word;
    memcpy(&word, (const uint8_t *)parameter_job_staged(&app.controller.parameters) + 4u * index, sizeof word);
    return word;
}

/* Somebody asks for a member to be written. */
static brace_status_t stage(uint32_t index, uint32_t word)
{
    return brace_app_parameters_stage(&app, brace_parameter_number(index), 1, &word);
}

/* So much later; a tick at the end of it. In CONFIGURATION none is late. */
static void later(uint32_t us)
{
    fake.now_us += us - TICK_US;
    ticks(1);
}

/* Whoever asked for it may be gone. */
static void test_configuration_that_nobody_feeds_is_left_and_nothing_has_changed(void)
{
    const uint32_t patience_us = BRACE_CONFIGURATION_PATIENCE_US, near_us = 100 * TICK_US;
    brace_parameters_t p = bench_parameters();
    ticks(5);
    const uint32_t crc = now()->parameter_crc;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    later(patience_us - near_us);
    TEST_ASSERT_EQUAL(BRACE_OK, stage(BRACE_PARAMETER_CONTROLLER_NODE_ID, 9)); /* half of a push */
    later(patience_us - near_us);
    TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, now()->mode);
    TEST_ASSERT_EQUAL(9, staged_word(BRACE_PARAMETER_CONTROLLER_NODE_ID));
    ticks(200);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_EQUAL_HEX32(crc, now()->parameter_crc);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    TEST_ASSERT_EQUAL(p.controller.node_id, staged_word(BRACE_PARAMETER_CONTROLLER_NODE_ID)); /* forgotten */
    p.limb.femur_mm = 190.0f;
    later(patience_us - near_us);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_commit(&app, &p));
    for (int i = 0; i < 1000 && parameter_job_is_busy(&app.controller.parameters); i++) { /* as long as it takes */
        fake.now_us += BRACE_CONFIGURATION_PATIENCE_US / 4;
        ticks(1);
        TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, now()->mode);
    }
    TEST_ASSERT_EQUAL_HEX32(brace_parameters_crc(&p), app.controller.parameters.crc);
    later(patience_us / 2);
    TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, now()->mode);
    later(patience_us / 2);
    ticks(5);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    fake.joint[BRACE_FEMUR].absent = true; /* from FAULT back to FAULT */
    ticks(150);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    later(patience_us);
    ticks(150);
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, now()->mode);
}

/* A joint that is away as CONFIGURATION is left, and comes back at any moment of START or after it. */
static void test_a_fault_from_before_configuration_has_no_K_after_it(void)
{
    for (int back = 0; back <= 150; back += 5) {
        setUp();
        fake.joint[BRACE_FEMUR].not_newer = true;
        ticks(150);
        TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, now()->mode);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
        ticks(2);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_leave(&app));
        bool was_valid = false;
        for (int i = 0; i < 400; i++) {
            fake.joint[BRACE_FEMUR].not_newer = i < back;
            ticks(1);
            TEST_ASSERT_FALSE(now()->k_is_valid && (now()->faults & BRACE_FAULTS_NO_K) != 0u);
            TEST_ASSERT_FALSE(was_valid && !now()->k_is_valid); /* nor is there one that goes again */
            was_valid = now()->k_is_valid;
        }
        TEST_ASSERT_TRUE(was_valid);
        TEST_ASSERT_EQUAL(0, now()->faults);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_configuration_is_entered_from_rest_and_left_to_start);
    RUN_TEST(test_parameters_are_stored_in_configuration_only);
    RUN_TEST(test_a_committed_set_is_in_force_and_survives_a_restart_and_can_be_taken_back);
    RUN_TEST(test_a_set_that_cannot_be_is_refused);
    RUN_TEST(test_only_a_set_that_is_not_the_one_named_is_counted);
    RUN_TEST(test_a_memory_that_does_not_keep_is_a_fault_and_the_old_set_stays);
    RUN_TEST(test_a_faulty_controller_can_still_be_configured);
    RUN_TEST(test_an_erase_in_configuration_is_no_late_tick);
    RUN_TEST(test_configuration_that_nobody_feeds_is_left_and_nothing_has_changed);
    RUN_TEST(test_a_fault_from_before_configuration_has_no_K_after_it);
    RUN_TEST(test_what_was_staged_ends_when_it_comes_in_force);
    RUN_TEST(test_idle_time_counts_from_the_start_and_from_each_request);
    RUN_TEST(test_a_set_that_has_changed_in_memory_is_taken_from_the_store);
    RUN_TEST(test_how_long_a_master_may_be_silent);
    RUN_TEST(test_faults_are_reported_before_the_first_tick);
    return UNITY_END();
}
