/* The drift check in the controller: what reaches it, what it says, what a restart keeps of it. */
#include "configure/keeping.h"
#include "loading_bench.h"
#include "measure/loading.h"

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    stand(&p);
}

void tearDown(void) {}

/* Stands at one of four postures, the truth being this limb's K there, and runs a test. */
static void test_at(int turn, const brace_limb_t *limb, const brace_loading_setup_t *setup)
{
    static const double posture[4][2] = {{1.0, 1.4}, {0.7, 1.8}, {1.3, 1.0}, {0.5, 1.2}};
    brace_planar_t planar;
    brace_stiffness_t k;
    theta1 = posture[turn % 4][0];
    theta2 = posture[turn % 4][1];
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(limb, &planar));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_stiffness(&planar, (float)theta1, (float)theta2, &k));
    truth = (symmetric_t){(double)k.k_xx_n_per_mm, (double)k.k_xz_n_per_mm, (double)k.k_zz_n_per_mm};
    brace_loading_setup_t next = *setup;
    next.axis = turn / 4 % 2 == 0 ? BRACE_AXIS_X : BRACE_AXIS_Z;
    ticks(2);
    run(&next);
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
}

static brace_loading_setup_t quick_setup(void)
{
    brace_loading_setup_t quick = along_x;
    quick.dwell_us = 20000;
    quick.rate_mm_per_s = 200.0f;
    quick.source = BRACE_LOADING_COMMANDED; /* stiff servos follow at once */
    return quick;
}

/* Learns the limb of the parameters. returns the next turn */
static int learn(void)
{
    const brace_loading_setup_t quick = quick_setup();
    servo_n_mm_per_rad = 1e9;
    noise_n = 0.02f;
    int turn = 0;
    for (; turn < BRACE_DRIFT_LEARN_MOST / 16 + 4 && app.drift.state == BRACE_DRIFT_LEARNING; turn++) {
        test_at(turn, &app.parameters.limb, &quick);
    }
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, app.drift.state);
    return turn;
}

/* As if the check had been at it for long: what it keeps does not care. */
static void as_if(brace_drift_state_t state, uint32_t steps)
{
    app.drift.state = (uint8_t)state;
    app.drift.steps = steps;
    keeping_look(&app);
    ticks(300);
}

static void crack(int turn)
{
    const brace_loading_setup_t quick = quick_setup();
    brace_limb_t limb = app.parameters.limb;
    limb.link[BRACE_TIBIA].bending_mm_per_n *= 1.5f;
    for (int i = 0; i < 8 && now()->faults == 0; i++) {
        test_at(turn++, &limb, &quick);
    }
    TEST_ASSERT_EQUAL(BRACE_FAULT_MODEL_DRIFT, now()->faults);
}

static void restart(void)
{
    ticks(300); /* a record is written in pieces */
    brace_fake_reset(&fake, BRACE_RESET_POWER);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(5);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
}

static void store(const brace_parameters_t *p)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    TEST_ASSERT_EQUAL(BRACE_OK, p != NULL ? brace_app_parameters_commit(&app, p) : brace_app_parameters_rollback(&app));
    for (int i = 0; i < 4000 && brace_app_configuration_leave(&app) != BRACE_OK; i++) {
        ticks(1);
    }
    ticks(5);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
}

static void test_what_was_learned_outlives_a_restart_and_so_does_the_alarm_of_a_crack_until_cleared(void)
{
    const int turn = learn();
    ticks(300);
    const brace_drift_t learned = app.drift;
    restart();
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, app.drift.state);
    TEST_ASSERT_EQUAL(learned.steps, app.drift.steps);
    TEST_ASSERT_EQUAL_MEMORY(learned.offset, app.drift.offset, sizeof learned.offset);
    TEST_ASSERT_EQUAL_MEMORY(learned.covariance, app.drift.covariance, sizeof learned.covariance);
    TEST_ASSERT_EQUAL_MEMORY(learned.held, app.drift.held, sizeof learned.held);
    TEST_ASSERT_EQUAL(0, now()->faults);
    crack(turn); /* what broke while it was switched off, or after, shows against the baseline of before */
    TEST_ASSERT_TRUE(now()->k_is_valid);
    restart();
    TEST_ASSERT_EQUAL(BRACE_FAULT_MODEL_DRIFT, now()->faults);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_DRIFTED, app.drift.state);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_clear(&app, BRACE_FAULT_MODEL_DRIFT));
    ticks(1);
    TEST_ASSERT_EQUAL(0, now()->faults);
    restart();
    TEST_ASSERT_EQUAL(0, now()->faults);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, app.drift.state);
}

static void test_half_learned_goes_on_where_it_was(void)
{
    const brace_loading_setup_t quick = quick_setup();
    servo_n_mm_per_rad = 1e9;
    for (int turn = 0; app.drift.steps < 600u; turn++) {
        test_at(turn, &app.parameters.limb, &quick);
    }
    restart();
    TEST_ASSERT_EQUAL(BRACE_DRIFT_LEARNING, app.drift.state);
    TEST_ASSERT_TRUE(app.drift.steps >= 512u && app.drift.steps <= 600u);
}

static void test_a_set_that_is_stored_is_learned_anew_and_a_roll_back_comes_back_to_what_was_known(void)
{
    const uint32_t steps = 3000;
    as_if(BRACE_DRIFT_WATCHING, steps);
    brace_parameters_t p = app.parameters;
    p.limb.femur_mm = 186.0f;
    store(&p);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_LEARNING, app.drift.state);
    TEST_ASSERT_EQUAL(0, app.drift.steps);
    restart();
    TEST_ASSERT_EQUAL(BRACE_DRIFT_LEARNING, app.drift.state);
    store(NULL);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, app.drift.state);
    TEST_ASSERT_EQUAL(steps, app.drift.steps);
    p = app.parameters;
    store(&p); /* the very same values: a commissioning */
    TEST_ASSERT_EQUAL(BRACE_DRIFT_LEARNING, app.drift.state);
}

/* Ten records fit the fake's slot: what is written is what has changed, and the last ones are for alarms. */
static void test_records_are_few_and_alarms_find_room(void)
{
    as_if(BRACE_DRIFT_WATCHING, 3000);
    const uint32_t room = brace_journal_room(&app.keeping.journal);
    TEST_ASSERT_EQUAL(9, room);
    as_if(BRACE_DRIFT_WATCHING, 3000 + 4095);
    app.drift.evidence[BRACE_DRIFT_FEMUR] = 3.9f;
    as_if(BRACE_DRIFT_WATCHING, 3000 + 4095);
    TEST_ASSERT_EQUAL(room, brace_journal_room(&app.keeping.journal));
    app.drift.evidence[BRACE_DRIFT_FEMUR] = 4.1f;
    as_if(BRACE_DRIFT_WATCHING, 3000 + 4095);
    TEST_ASSERT_EQUAL(room - 1, brace_journal_room(&app.keeping.journal));
    app.drift.evidence[BRACE_DRIFT_FEMUR] = 0.0f; /* what has fallen is kept too */
    as_if(BRACE_DRIFT_WATCHING, 3000 + 4095);
    TEST_ASSERT_EQUAL(room - 2, brace_journal_room(&app.keeping.journal));
    as_if(BRACE_DRIFT_WATCHING, 3000 + 4095 + 4096);
    TEST_ASSERT_EQUAL(room - 3, brace_journal_room(&app.keeping.journal));
    while (brace_journal_room(&app.keeping.journal) > 2u) { /* as if years had passed */
        TEST_ASSERT_TRUE(brace_journal_begin(&app.keeping.journal, &app.drift));
        while (brace_journal_step(&app.keeping.journal) == BRACE_JOURNAL_BUSY) {
        }
    }
    as_if(BRACE_DRIFT_WATCHING, 90000);
    TEST_ASSERT_EQUAL(2, brace_journal_room(&app.keeping.journal));
    as_if(BRACE_DRIFT_DRIFTED, 90000);
    TEST_ASSERT_EQUAL(1, brace_journal_room(&app.keeping.journal));
    restart();
    TEST_ASSERT_EQUAL(BRACE_FAULT_MODEL_DRIFT, now()->faults);
}

static void test_a_memory_that_does_not_keep_is_a_fault(void)
{
    const brace_loading_setup_t quick = quick_setup();
    servo_n_mm_per_rad = 1e9;
    fake.nvm_stuck = 0x04;
    for (int turn = 0; app.drift.steps < 600u && (now()->faults & BRACE_FAULT_STORE) == 0; turn++) {
        test_at(turn, &app.parameters.limb, &quick);
        ticks(20); /* the first pieces of a record */
    }
    TEST_ASSERT_EQUAL(BRACE_FAULT_STORE, now()->faults);
    TEST_ASSERT_TRUE(app.drift.steps >= 512u);
    TEST_ASSERT_TRUE(now()->k_is_valid);
}

/* Runs a test tick by tick; run_at: how many readings the check's run has after each step.
 * returns the steps it took in */
static uint32_t watched_run(const brace_loading_setup_t *setup, uint8_t run_at[32])
{
    const uint32_t before = app.drift.steps;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, setup));
    for (int i = 0; i < 60000 && app.mode == BRACE_MODE_LOADING_TEST; i++) {
        const bool checks = app.loading.phase == LOADING_DRIFT;
        const uint32_t step = app.loading.step;
        ticks(1);
        if (checks) {
            run_at[step] = app.drift.run_count;
        }
    }
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
    return app.drift.steps - before;
}

/* Friction turns round with the motion: what came before a reversal is no mean for what comes after. */
static void test_a_run_of_the_check_ends_at_each_reversal(void)
{
    uint8_t run_at[32] = {0};
    TEST_ASSERT_EQUAL(16, watched_run(&along_x, run_at));
    static const uint8_t expected[17] = {0, 1, 2, 3, 0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4};
    TEST_ASSERT_EQUAL_UINT8_ARRAY(expected, run_at, 17);
}

static void test_readings_with_a_gap_open_do_not_reach_the_check(void)
{
    uint8_t run_at[32] = {0};
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_TIBIA].gap_rad = 0.01f;
    stand(&p);
    tip_is_free = true; /* nothing loads the joint: no flank carries */
    ticks(300);
    TEST_ASSERT_BITS(BRACE_FLAG_GAP_OPEN, BRACE_FLAG_GAP_OPEN, now()->stiffness.now.flags);
    TEST_ASSERT_EQUAL(0, watched_run(&along_x, run_at));
    TEST_ASSERT_EQUAL(0, app.drift.run_count);
    p.limb.joint[BRACE_TIBIA].gap_rad = 0.0f;
    stand(&p);
    tip_is_free = true;
    ticks(300);
    TEST_ASSERT_EQUAL(16, watched_run(&along_x, run_at));
}

static void test_readings_without_a_sensor_do_not_reach_the_check(void)
{
    uint8_t run_at[32] = {0};
    brace_fake_without_force(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(200);
    TEST_ASSERT_EQUAL(0, watched_run(&along_x, run_at));
}

static void test_a_tick_that_is_late_is_told_whatever_it_works_at(void)
{
    static const uint8_t phases[] = {LOADING_MOVE, LOADING_READ, LOADING_DRIFT, LOADING_JUDGE};
    for (uint32_t i = 0; i < sizeof phases; i++) {
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
        for (int tick = 0; tick < 60000 && app.loading.phase != phases[i]; tick++) {
            ticks(1);
        }
        TEST_ASSERT_EQUAL(phases[i], app.loading.phase);
        const uint32_t late = brace_app_counters(&app)->ticks_late;
        fake.now_us += 5 * TICK_US;
        ticks(1);
        TEST_ASSERT_EQUAL(late + 1, brace_app_counters(&app)->ticks_late);
        ticks(8); /* the pieces that follow compute no snapshot */
        TEST_ASSERT_BITS(BRACE_FAULT_TICK_LATE, BRACE_FAULT_TICK_LATE, now()->faults);
        (void)brace_app_loading_stop(&app);
        for (int tick = 0; tick < 3000 && (app.mode != BRACE_MODE_MONITOR || now()->faults != 0); tick++) {
            ticks(1);
        }
        TEST_ASSERT_EQUAL(0, now()->faults);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_run_of_the_check_ends_at_each_reversal);
    RUN_TEST(test_readings_with_a_gap_open_do_not_reach_the_check);
    RUN_TEST(test_readings_without_a_sensor_do_not_reach_the_check);
    RUN_TEST(test_what_was_learned_outlives_a_restart_and_so_does_the_alarm_of_a_crack_until_cleared);
    RUN_TEST(test_half_learned_goes_on_where_it_was);
    RUN_TEST(test_a_set_that_is_stored_is_learned_anew_and_a_roll_back_comes_back_to_what_was_known);
    RUN_TEST(test_records_are_few_and_alarms_find_room);
    RUN_TEST(test_a_memory_that_does_not_keep_is_a_fault);
    RUN_TEST(test_a_tick_that_is_late_is_told_whatever_it_works_at);
    return UNITY_END();
}
