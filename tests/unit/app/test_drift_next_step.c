/* What the drift check advises, for everything that its report may say. */
#include <string.h>

#include "app_bench.h"
#include "jobs/drift/drift_job.h"

static drift_job_t job;

void setUp(void)
{
    memset(&job, 0, sizeof job);
}

void tearDown(void) {}

static void test_while_it_learns_it_wants_to_learn(void)
{
    job.report.state = BRACE_DRIFT_LEARNING;
    job.report.evidence = 100.0f;
    TEST_ASSERT_EQUAL(BRACE_DRIFT_NEXT_LEARN, drift_job_next_step(&job));
}

static void test_while_it_watches_growing_evidence_asks_for_a_test(void)
{
    job.report.state = BRACE_DRIFT_WATCHING;
    job.report.cause = BRACE_DRIFT_FEMUR;
    job.report.evidence = 9.9f;
    TEST_ASSERT_EQUAL(BRACE_DRIFT_NEXT_NOTHING, drift_job_next_step(&job));
    job.report.evidence = 10.0f;
    TEST_ASSERT_EQUAL(BRACE_DRIFT_NEXT_TEST_ANOTHER_POSTURE, drift_job_next_step(&job));
    job.has_outlook = true;
    job.outlook.steps_needed[BRACE_DRIFT_FEMUR] = 1;
    TEST_ASSERT_EQUAL(BRACE_DRIFT_NEXT_REPEAT_TEST, drift_job_next_step(&job));
    job.outlook.steps_needed[BRACE_DRIFT_FEMUR] = 64; /* as many as a long test has */
    TEST_ASSERT_EQUAL(BRACE_DRIFT_NEXT_REPEAT_TEST, drift_job_next_step(&job));
    job.outlook.steps_needed[BRACE_DRIFT_FEMUR] = 65;
    TEST_ASSERT_EQUAL(BRACE_DRIFT_NEXT_TEST_ANOTHER_POSTURE, drift_job_next_step(&job));
    job.outlook.steps_needed[BRACE_DRIFT_FEMUR] = 100000;
    TEST_ASSERT_EQUAL(BRACE_DRIFT_NEXT_TEST_ANOTHER_POSTURE, drift_job_next_step(&job));
    job.report.cause = BRACE_DRIFT_UNEXPLAINED; /* shows anywhere */
    TEST_ASSERT_EQUAL(BRACE_DRIFT_NEXT_REPEAT_TEST, drift_job_next_step(&job));
}

static void test_a_drift_names_what_to_look_at(void)
{
    static const struct {
        brace_drift_cause_t cause;
        brace_drift_next_t next;
    } reported[] = {
        {BRACE_DRIFT_FEMUR, BRACE_DRIFT_NEXT_INSPECT_FEMUR_LINK},
        {BRACE_DRIFT_TIBIA_OR_KNEE, BRACE_DRIFT_NEXT_INSPECT_TIBIA_LINK_AND_KNEE_JOINT},
        {BRACE_DRIFT_FEMUR_JOINT_OR_BASE, BRACE_DRIFT_NEXT_INSPECT_FEMUR_JOINT_AND_BASE},
        {BRACE_DRIFT_UNEXPLAINED, BRACE_DRIFT_NEXT_CHECK_SENSOR_AND_MOUNTING},
    };
    job.report.state = BRACE_DRIFT_DRIFTED;
    for (int i = 0; i < 4; i++) {
        job.report.cause = reported[i].cause;
        job.report.could_be = 1u << reported[i].cause;
        TEST_ASSERT_EQUAL(reported[i].next, drift_job_next_step(&job));
        job.report.could_be = 3; /* two causes explain it */
        TEST_ASSERT_EQUAL(BRACE_DRIFT_NEXT_TEST_ANOTHER_POSTURE, drift_job_next_step(&job));
    }
}

static void test_a_run_that_ends_behind_a_reading_waits_for_it(void)
{
    job.drift.run_count = 3;
    job.has_reading = true;
    drift_job_end_run(&job);
    TEST_ASSERT_TRUE(job.run_ends);
    TEST_ASSERT_EQUAL(3, job.drift.run_count);
    job.has_reading = false;
    drift_job_end_run(&job);
    TEST_ASSERT_EQUAL(0, job.drift.run_count);
}

/* What a limb's journal said of another set is forgotten with it: else the first record of the new one would wait for
 * the old one's count. */
static void test_learning_anew_forgets_what_was_kept(void)
{
    const brace_parameters_t parameters = bench_parameters();
    bench_board();
    const drift_inputs_t inputs = {.hal = &fake.hal, .parameters = &parameters, .origin = BRACE_PARAMETERS_DEFAULT};
    job.kept_state = BRACE_DRIFT_DRIFTED;
    job.kept_steps = 1234;
    job.kept_evidence[0] = job.kept_evidence[BRACE_DRIFT_CAUSE_COUNT] = 17.0f;
    drift_job_configure(&job, true);
    (void)drift_job_work(&job, &inputs);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_LEARNING, job.kept_state);
    TEST_ASSERT_EQUAL(0, job.kept_steps);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, job.kept_evidence[0]);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, job.kept_evidence[BRACE_DRIFT_CAUSE_COUNT]);
}

/* Behind a set that has just been written the journal is empty, so the job does not search it. It searches the journal
 * behind any other set. */
static void test_the_journal_of_a_fresh_set_is_not_searched(void)
{
    const brace_parameters_t p = bench_parameters();
    bench_start(&p);
    const drift_inputs_t inputs = {.hal = &fake.hal,
                                   .parameters = &p,
                                   .parameter_crc = brace_parameters_crc(&p),
                                   .origin = BRACE_PARAMETERS_SLOT_A,
                                   .may_write = false};
    for (int is_fresh = 0; is_fresh < 2; is_fresh++) {
        memset(&job, 0, sizeof job);
        job.is_erased = is_fresh == 0; /* this belongs to the set before, like all that waits */
        job.opens = job.scans = job.has_reading = job.looks = job.foresees = job.has_outlook = true;
        drift_job_configure(&job, is_fresh != 0);
        TEST_ASSERT_TRUE(job.learns_anew);
        TEST_ASSERT_FALSE(job.opens || job.scans || job.has_reading || job.looks || job.foresees || job.has_outlook);
        (void)drift_job_work(&job, &inputs);
        TEST_ASSERT_TRUE(job.opens && !job.learns_anew);
        (void)drift_job_work(&job, &inputs);
        TEST_ASSERT_FALSE(job.opens);
        TEST_ASSERT_EQUAL(is_fresh == 0, job.scans);
        for (int i = 0; i < 2000 && job.scans; i++) {
            (void)drift_job_work(&job, &inputs);
        }
        TEST_ASSERT_FALSE(job.scans);
        (void)drift_job_work(&job, &inputs);
        TEST_ASSERT_EQUAL(BRACE_DRIFT_LEARNING, job.report.state);
    }
}

/* A write may take a whole tick, so the job asks the memory for one write in eight ticks at most. */
static void test_the_journal_is_written_in_one_tick_of_eight(void)
{
    const brace_parameters_t p = bench_parameters();
    int last = -100, kept = 0;
    bench_start(&p);
    drift_inputs_t inputs = {.hal = &fake.hal,
                             .parameters = &p,
                             .parameter_crc = brace_parameters_crc(&p),
                             .origin = BRACE_PARAMETERS_SLOT_A,
                             .may_write = false};
    memset(&job, 0, sizeof job);
    drift_job_configure(&job, true);
    for (int i = 0; i < 10; i++) {
        (void)drift_job_work(&job, &inputs);
    }
    inputs.may_write = true;
    for (int i = 0; i < 80; i++) {
        job.looks = true;
        if (drift_job_work(&job, &inputs)) {
            TEST_ASSERT_GREATER_OR_EQUAL(8, i - last);
            last = i;
            kept++;
        }
    }
    TEST_ASSERT_EQUAL(10, kept);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_while_it_learns_it_wants_to_learn);
    RUN_TEST(test_while_it_watches_growing_evidence_asks_for_a_test);
    RUN_TEST(test_a_drift_names_what_to_look_at);
    RUN_TEST(test_learning_anew_forgets_what_was_kept);
    RUN_TEST(test_a_run_that_ends_behind_a_reading_waits_for_it);
    RUN_TEST(test_the_journal_of_a_fresh_set_is_not_searched);
    RUN_TEST(test_the_journal_is_written_in_one_tick_of_eight);
    return UNITY_END();
}
