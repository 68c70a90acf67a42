/* The drift check's job alone: when a record is worth writing (jobs/drift/drift_job.h), what a start goes on from, what
 * a later reading overtakes. */
#include <string.h>

#include "app_bench.h"
#include "jobs/drift/drift_job.h"

static drift_job_t job;
static drift_inputs_t inputs;

static void work(int steps)
{
    for (int i = 0; i < steps; i++) {
        (void)drift_job_work(&job, &inputs);
    }
}

/* As the controller starts it: learns the limb, opens its journal, searches that. */
static void start(bool is_fresh)
{
    memset(&job, 0, sizeof job);
    drift_job_configure(&job, is_fresh);
    for (int i = 0; i < 3 + BRACE_JOURNAL_SCANS && drift_job_is_starting(&job); i++) {
        TEST_ASSERT_TRUE(drift_job_work(&job, &inputs));
    }
    TEST_ASSERT_FALSE(drift_job_is_starting(&job));
}

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    bench_start(&p);
    inputs = (drift_inputs_t){.hal = &fake.hal,
                              .parameters = brace_app_parameters(&app),
                              .parameter_crc = now()->parameter_crc,
                              .origin = BRACE_PARAMETERS_SLOT_A,
                              .may_write = true};
    start(true);
}

void tearDown(void) {}

/* Is a record written when the job looks? */
static bool is_kept(void)
{
    const uint32_t room = brace_journal_room(&job.journal);
    job.looks = true;
    work(8 * (BRACE_JOURNAL_PIECES + 4)); /* a piece in eight ticks, and another look */
    TEST_ASSERT_FALSE(job.looks);
    TEST_ASSERT_EQUAL(BRACE_JOURNAL_READY, job.journal.state);
    const uint32_t left = brace_journal_room(&job.journal);
    TEST_ASSERT_TRUE(left == room || left + 1u == room);
    return left != room;
}

static void watch(void)
{
    job.drift.state = BRACE_DRIFT_WATCHING;
    TEST_ASSERT_TRUE(is_kept());
}

static void test_a_change_of_state_is_kept_once(void)
{
    TEST_ASSERT_FALSE(is_kept());
    static const uint8_t states[] = {BRACE_DRIFT_WATCHING, BRACE_DRIFT_DRIFTED, BRACE_DRIFT_LEARNING};
    for (int i = 0; i < 3; i++) {
        job.drift.state = states[i];
        TEST_ASSERT_TRUE(is_kept());
        TEST_ASSERT_FALSE(is_kept());
    }
}

/* Evidence of each cause, and of none, that has moved by 4, either way. */
static void test_evidence_that_has_moved_is_kept(void)
{
    static const float evidence[] = {3.9f, 4.1f, 0.2f, 0.0f};
    for (int i = 0; i <= BRACE_DRIFT_CAUSE_COUNT; i++) {
        setUp();
        watch();
        for (int k = 0; k < 4; k++) {
            job.drift.evidence[i] = evidence[k];
            TEST_ASSERT_EQUAL(k % 2 == 1, is_kept()); /* up by 4.1, and down by as much */
        }
        TEST_ASSERT_FALSE(is_kept());
    }
}

/* 512 readings while it learns, 4,096 while it watches. */
static void test_many_readings_are_kept(void)
{
    job.drift.steps += 511u;
    TEST_ASSERT_FALSE(is_kept());
    job.drift.steps += 1u;
    TEST_ASSERT_TRUE(is_kept());
    TEST_ASSERT_FALSE(is_kept());
    watch();
    job.drift.steps += 4095u;
    TEST_ASSERT_FALSE(is_kept());
    job.drift.steps += 1u;
    TEST_ASSERT_TRUE(is_kept());
    TEST_ASSERT_FALSE(is_kept());
}

/* A start goes on from the newest record, and does not write it again: it is what the next look compares with. */
static void test_a_start_goes_on_from_the_record_and_knows_it(void)
{
    job.drift.state = BRACE_DRIFT_WATCHING;
    job.drift.steps = 5000;
    job.drift.evidence[1] = 7.0f;
    job.drift.run_count = 9;
    TEST_ASSERT_TRUE(is_kept());
    start(false);
    TEST_ASSERT_EQUAL(0, job.drift.run_count); /* the sensors were off meanwhile: its readings belong to no run */
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, job.drift.state);
    TEST_ASSERT_EQUAL(5000, job.drift.steps);
    TEST_ASSERT_EQUAL_FLOAT(7.0f, job.drift.evidence[1]);
    TEST_ASSERT_TRUE(drift_job_work(&job, &inputs)); /* reports it */
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, job.report.state);
    TEST_ASSERT_FALSE(is_kept());
    job.drift.evidence[1] = 11.5f;
    TEST_ASSERT_TRUE(is_kept());
    inputs.parameter_crc ^= 1u; /* another set's record is none of this limb's */
    start(false);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_LEARNING, job.drift.state);
    TEST_ASSERT_EQUAL(0, job.drift.steps);
}

/* When the set in force is another, what was reported of the one before goes. */
static void test_a_report_is_of_the_set_in_force(void)
{
    job.report = (brace_drift_report_t){.state = BRACE_DRIFT_DRIFTED, .evidence = 30.0f};
    job.drift.state = BRACE_DRIFT_DRIFTED;
    TEST_ASSERT_TRUE(drift_job_alarms(&job));
    drift_job_configure(&job, true);
    work(3); /* learns, opens, reports */
    TEST_ASSERT_FALSE(drift_job_alarms(&job));
    TEST_ASSERT_EQUAL(BRACE_DRIFT_LEARNING, job.report.state);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, job.report.evidence);
    TEST_ASSERT_EQUAL(0, job.report.steps);
}

/* The check is set up by the limb's own numbers; a force without noise is one that nobody has measured. */
static void test_the_check_has_the_limb_s_numbers(void)
{
    static brace_parameters_t p;
    p = bench_parameters();
    p.sensor.noise_n = 0.07f;
    p.slow.joint_compliance_per_degc = 0.004f;
    inputs.parameters = &p;
    start(true);
    TEST_ASSERT_EQUAL_FLOAT(0.07f, job.drift.setup.noise_n);
    TEST_ASSERT_EQUAL_FLOAT(0.004f, job.drift.setup.joint_compliance_per_degc);
    TEST_ASSERT_EQUAL_FLOAT(0.2f, job.drift.setup.joint_compliance_trust_ratio);
    TEST_ASSERT_EQUAL_FLOAT(0.0005f, job.drift.setup.model_error_ratio);
    p.sensor.noise_n = 0.0f;
    start(true);
    TEST_ASSERT_EQUAL_FLOAT(0.001f, job.drift.setup.noise_n);
}

/* The controller's own job: a record belongs to one set of parameters, whatever of it has changed. */
static void test_each_set_has_its_own_records(void)
{
    const uint32_t identity = app.controller.drift.journal.identity;
    brace_parameters_t p = bench_parameters();
    bench_start(&p);
    TEST_ASSERT_EQUAL_HEX32(identity, app.controller.drift.journal.identity);
    p.limb.femur_mm = 190.0f;
    bench_start(&p);
    TEST_ASSERT_TRUE(identity != app.controller.drift.journal.identity);
}

static float widest_after(float dx_mm, float dz_mm)
{
    const brace_drift_reading_t reading = {.theta1_rad = 1.0f, .theta2_rad = 1.4f, .dx_mm = dx_mm, .dz_mm = dz_mm};
    drift_job_take(&job, &reading, &now()->stiffness.engaged, false);
    work(4);
    return job.widest.dx_mm + job.widest.dz_mm;
}

/* What readings at a posture can show is found from the one displaced furthest, along whichever axis. */
static void test_the_widest_reading_of_a_posture(void)
{
    TEST_ASSERT_EQUAL_FLOAT(1.0f, widest_after(1.0f, 0.0f));
    TEST_ASSERT_EQUAL_FLOAT(-2.0f, widest_after(0.0f, -2.0f));
    TEST_ASSERT_EQUAL_FLOAT(-2.0f, widest_after(1.5f, 0.0f));
    TEST_ASSERT_EQUAL_FLOAT(-2.0f, widest_after(0.5f, 1.9f));
    TEST_ASSERT_EQUAL_FLOAT(-3.0f, widest_after(-1.5f, -1.5f));
}

/* Nothing is written while the memory is another's, and never twice within eight ticks. */
static void test_when_it_may_write(void)
{
    job.drift.state = BRACE_DRIFT_WATCHING;
    job.looks = true;
    work(3); /* the job writes its first record */
    inputs.may_write = false;
    const uint32_t before = fake.calls[BRACE_FAKE_NVM_WRITE];
    TEST_ASSERT_FALSE(drift_job_work(&job, &inputs));
    work(100);
    TEST_ASSERT_EQUAL(before, fake.calls[BRACE_FAKE_NVM_WRITE]);
    inputs.may_write = true;
    uint32_t written = before, last = 0, pieces = 0;
    for (uint32_t i = 1; i < 200u; i++) {
        work(1);
        if (fake.calls[BRACE_FAKE_NVM_WRITE] != written) {
            TEST_ASSERT_EQUAL(written + 1u, fake.calls[BRACE_FAKE_NVM_WRITE]);
            TEST_ASSERT_TRUE(last == 0u || i - last >= 8u);
            written++;
            last = i;
            pieces++;
        }
    }
    TEST_ASSERT_EQUAL(BRACE_JOURNAL_PIECES, pieces);
}

/* The job reports a memory that refuses, and does not read it again until something happens. Only a set that lies in a
 * slot has a journal. */
static void test_a_memory_that_fails_is_reported(void)
{
    job.drift.state = BRACE_DRIFT_WATCHING;
    job.looks = true;
    brace_fake_fail_next(&fake, BRACE_FAKE_NVM_WRITE, 1, BRACE_HAL_E_DEVICE);
    for (int i = 0; i < 40 && !job.memory_failed; i++) {
        work(1);
    }
    TEST_ASSERT_TRUE(job.memory_failed);
    TEST_ASSERT_FALSE(job.looks);
    for (int i = 0; i < 40; i++) {
        TEST_ASSERT_FALSE(drift_job_work(&job, &inputs));
    }
    drift_job_configure(&job, true); /* another set, and its own memory */
    work(3);
    TEST_ASSERT_FALSE(job.memory_failed);
    inputs.origin = BRACE_PARAMETERS_DEFAULT;
    start(true);
    TEST_ASSERT_EQUAL(0, brace_journal_room(&job.journal));
    inputs.origin = BRACE_PARAMETERS_SLOT_B;
    start(true);
    TEST_ASSERT_EQUAL(1, job.journal.slot);
    TEST_ASSERT_GREATER_THAN(0, brace_journal_room(&job.journal));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_change_of_state_is_kept_once);
    RUN_TEST(test_evidence_that_has_moved_is_kept);
    RUN_TEST(test_many_readings_are_kept);
    RUN_TEST(test_a_start_goes_on_from_the_record_and_knows_it);
    RUN_TEST(test_a_report_is_of_the_set_in_force);
    RUN_TEST(test_the_check_has_the_limb_s_numbers);
    RUN_TEST(test_each_set_has_its_own_records);
    RUN_TEST(test_the_widest_reading_of_a_posture);
    RUN_TEST(test_when_it_may_write);
    RUN_TEST(test_a_memory_that_fails_is_reported);
    return UNITY_END();
}
