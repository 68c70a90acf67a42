/* What takes longer than a tick is done in pieces: one piece of one job in a tick, in an order that serves everybody;
 * and beside it the memory is looked over, less of it in a tick in which a job has worked. */
#include "app_bench.h"

static brace_parameters_t parameters;

static void start(bool in_space)
{
    bench_board();
    bench_store(&parameters);
    fake.joint[BRACE_COXA].absent = !in_space;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(60);
}

void setUp(void)
{
    parameters = bench_parameters();
    start(false);
}

void tearDown(void) {}

static int32_t ask(float theta1_rad)
{
    const brace_k_question_t question = {.where = BRACE_K_AT_POSTURE, .theta_rad = {0.0f, theta1_rad, 1.2f}};
    brace_k_answer_t answer;
    return brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, &question, &answer);
}

/* A question goes before the drift check's report, and both do not share a tick. */
static void test_a_tick_does_a_piece_of_one_job(void)
{
    drift_job_t *drift = &app.controller.drift;
    TEST_ASSERT_EQUAL(BRACE_APP_LATER, ask(0.8f));
    drift->reports = true;
    ticks(1);
    TEST_ASSERT_TRUE(drift->reports);
    TEST_ASSERT_EQUAL(BRACE_OK, ask(0.8f));
    ticks(1);
    TEST_ASSERT_FALSE(drift->reports);
}

/* What the drift check does is a tick's piece too: the question that comes meanwhile has the next. */
static void test_jobs_have_a_tick_when_questions_do_not_end(void)
{
    drift_job_t *drift = &app.controller.drift;
    int32_t answered = 0;
    drift->reports = true;
    for (int i = 0; i < 10 && drift->reports; i++) {
        const int32_t status = ask(0.01f * (float)i); /* another one in each tick */
        answered += status == BRACE_OK;
        ticks(1);
        TEST_ASSERT_TRUE(i < 9);
    }
    TEST_ASSERT_FALSE(drift->reports);
}

/* However long one question's K takes: after eight pieces in a row none is begun, and what is begun is ended. */
static void test_questions_in_space_leave_room_too(void)
{
    question_job_t *job = &app.controller.question;
    const brace_k_question_t question = {.where = BRACE_K_IN_SPACE, .theta_rad = {0.1f, 0.8f, 1.2f}};
    brace_k_answer_t answer;
    int pieces = 0;
    start(true);
    const question_inputs_t inputs = {.model = &app.controller.model,
                                      .parameters = brace_app_parameters(&app),
                                      .is_calibrated = true,
                                      .joints = &app.controller.joints,
                                      .down = app.controller.gravity.down};
    for (int asker = 0; asker < (int)BRACE_ASKER_COUNT; asker++) {
        TEST_ASSERT_EQUAL(BRACE_APP_LATER, question_job_ask(job, (brace_asker_t)asker, &question, &answer));
    }
    for (int asker = 0; asker < (int)BRACE_ASKER_COUNT; asker++) {
        for (pieces = 0; question_job_work(job, &inputs, 1); pieces++) {
            TEST_ASSERT_LESS_THAN(8 + 9, pieces); /* a K in space is nine pieces, in integers fewer */
        }
        TEST_ASSERT_TRUE(pieces >= 8 || asker > 0);
        TEST_ASSERT_TRUE(pieces >= 8 || !question_job_work(job, &inputs, 1)); /* or nobody waits any more */
    }
    TEST_ASSERT_FALSE(question_job_work(job, &inputs, 1));
}

/* How long the longest look over all of the memory takes [us]: from one end of the last span to the next. */
static uint32_t longest_round_us(bool works)
{
    uint32_t longest = 0, since = 0;
    int rounds = -1;
    for (int i = 0; i < 2000 && rounds < 4; i++) {
        const uint8_t span = (uint8_t)app.controller.guard.span;
        app.controller.drift.reports = works; /* whose piece fits into a tick */
        fake.now_us += parameters.controller.tick_us;
        brace_app_tick(&app, fake.now_us);
        since += parameters.controller.tick_us;
        if (app.controller.guard.span < span) {
            longest = rounds >= 0 && since > longest ? since : longest;
            since = 0;
            rounds++;
        }
    }
    TEST_ASSERT_EQUAL(4, rounds);
    return longest;
}

/* A flipped bit is found within a tenth of a second, however long the ticks are, and also where a job works in each. No
 * more is looked over than that asks for: every word costs instructions of each tick. */
static void test_the_memory_is_looked_over_in_a_tenth_of_a_second(void)
{
    static const uint32_t tick_us[] = {500, 1000, 2000, 3000, 4000, 5000};
    for (int i = 0; i < 6; i++) {
        for (int is_spatial = 0; is_spatial < 2; is_spatial++) {
            parameters.controller.tick_us = tick_us[i];
            start(is_spatial != 0);
            const uint32_t alone_us = longest_round_us(false), beside_us = longest_round_us(true);
            TEST_ASSERT_TRUE(alone_us <= 80000u && beside_us <= 100000u);
            TEST_ASSERT_TRUE(alone_us >= 40000u && beside_us >= alone_us);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_tick_does_a_piece_of_one_job);
    RUN_TEST(test_jobs_have_a_tick_when_questions_do_not_end);
    RUN_TEST(test_questions_in_space_leave_room_too);
    RUN_TEST(test_the_memory_is_looked_over_in_a_tenth_of_a_second);
    return UNITY_END();
}
