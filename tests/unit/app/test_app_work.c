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
                                      .origin = BRACE_PARAMETERS_SLOT_A,
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

/* How many words of the memory a tick looks over; a span may end sooner. */
static uint32_t words_in_a_tick(bool works)
{
    uint32_t most = 0;
    for (int i = 0; i < 40; i++) {
        const guard_t before = app.controller.guard;
        app.controller.drift.reports = works; /* whose piece fits into a tick */
        fake.now_us += parameters.controller.tick_us;
        brace_app_tick(&app, fake.now_us);
        const guard_t *after = &app.controller.guard;
        const uint32_t words = after->span == before.span ? after->word - before.word : 0u;
        most = words > most ? words : most;
    }
    return most;
}

/* Eight words in a millisecond find a flip within a tenth of a second; 24 are the most that fit into a tick. */
static void test_the_memory_is_looked_over_at_its_pace(void)
{
    static const uint32_t tick_us[] = {1000, 2000, 3000, 4000, 5000}, words[] = {8, 16, 24, 24, 24};
    for (int i = 0; i < 5; i++) {
        parameters.controller.tick_us = tick_us[i];
        start(false);
        TEST_ASSERT_EQUAL(words[i], words_in_a_tick(false));
        TEST_ASSERT_EQUAL(words[i] / 2u, words_in_a_tick(true));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_tick_does_a_piece_of_one_job);
    RUN_TEST(test_jobs_have_a_tick_when_questions_do_not_end);
    RUN_TEST(test_questions_in_space_leave_room_too);
    RUN_TEST(test_the_memory_is_looked_over_at_its_pace);
    return UNITY_END();
}
