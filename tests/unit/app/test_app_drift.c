/* The drift check in the controller: what reaches it, what it says, what a restart keeps of it. */
#include "can_bench.h"
#include "loading_bench.h"
#include "modbus_master.h"

void setUp(void)
{
    brace_parameters_t p = bench_parameters();
    p.controller.modbus_address = UNIT;
    stand(&p);
}

void tearDown(void) {}

/* Stands at one of four postures, the truth being this limb's K there under the preload, and runs a test. */
static void test_at(int turn, const brace_limb_t *limb, const brace_loading_setup_t *setup)
{
    static const double posture[4][2] = {{1.0, 1.4}, {0.7, 1.8}, {1.3, 1.0}, {0.5, 1.2}};
    theta1 = posture[turn % 4][0];
    theta2 = posture[turn % 4][1];
    const brace_parameters_t p = {.limb = *limb};
    const brace_force_t preload = {(float)preload_x_n, (float)preload_z_n};
    const brace_stiffness_t k =
        equilibrium(&p, (float)theta1, (float)theta2, preload, (brace_vec_t){0.0f, -1.0f}).stiffness;
    truth = (symmetric_t){(double)k.k_xx_n_per_mm, (double)k.k_xz_n_per_mm, (double)k.k_zz_n_per_mm};
    brace_loading_setup_t next = *setup;
    next.axis = turn / 4 % 2 == 0 ? BRACE_AXIS_X : BRACE_AXIS_Z;
    bench_believe();
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

/* Learns the limb of the parameters, once: whoever asks again goes on where that ended. returns the next turn */
static int learn(void)
{
    static struct {
        brace_app_t app;
        brace_fake_t fake;
        double theta1, theta2;
        symmetric_t truth;
        uint32_t noise_state;
        int turn;
    } learned;
    brace_loading_setup_t quick = quick_setup();
    quick.step_mm *= ON_BOARD ? 4.0f : 1.0f; /* so that the noise counts less, and fewer readings will do */
    servo_n_mm_per_rad = 1e9;
    noise_n = 0.02f;
    if (learned.turn > 0) {
        app = learned.app;
        fake = learned.fake;
        theta1 = learned.theta1;
        theta2 = learned.theta2;
        truth = learned.truth;
        noise_state = learned.noise_state;
        return learned.turn;
    }
    int turn = 0;
    for (; turn < BRACE_DRIFT_LEARN_MOST / 16 + 4 && app.controller.drift.drift.state == BRACE_DRIFT_LEARNING; turn++) {
        test_at(turn, &app.controller.parameters.in_force.limb, &quick);
    }
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, app.controller.drift.drift.state);
    learned.app = app;
    learned.fake = fake;
    learned.theta1 = theta1;
    learned.theta2 = theta2;
    learned.truth = truth;
    learned.noise_state = noise_state;
    learned.turn = turn;
    return turn;
}

/* As if the check had been at it for long: what it keeps does not care. */
static void as_if(brace_drift_state_t state, uint32_t steps)
{
    app.controller.drift.drift.state = (uint8_t)state;
    app.controller.drift.drift.steps = steps;
    app.controller.drift.looks = true;
    ticks(300);
}

/* Learns a little more than BEFORE_A_RECORD readings. A board begins near there: the first are like the last. */
enum { BEFORE_A_RECORD = 512 };
static void learn_up_to_a_record(void)
{
    const brace_loading_setup_t quick = quick_setup();
    servo_n_mm_per_rad = 1e9;
    if (ON_BOARD) {
        as_if(BRACE_DRIFT_LEARNING, BEFORE_A_RECORD - 64);
    }
    for (int turn = 0; app.controller.drift.drift.steps < 600u && (now()->faults & BRACE_FAULT_STORE) == 0; turn++) {
        test_at(turn, &app.controller.parameters.in_force.limb, &quick);
        ticks(20); /* the first pieces of a record */
    }
}

static brace_limb_t cracked_limb(void)
{
    brace_limb_t limb = app.controller.parameters.in_force.limb;
    limb.link[BRACE_TIBIA].bending_mm_per_n *= 1.5f;
    return limb;
}

/* returns the next turn */
static int crack(int turn)
{
    const brace_loading_setup_t quick = quick_setup();
    const brace_limb_t limb = cracked_limb();
    for (int i = 0; i < 8 && now()->faults == 0; i++) {
        test_at(turn++, &limb, &quick);
    }
    TEST_ASSERT_EQUAL(BRACE_FAULT_MODEL_DRIFT, now()->faults);
    return turn;
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
    /* The journal is being searched. */
    for (int i = 0; i < 20000 && drift_job_is_starting(&app.controller.drift); i++) {
        ticks(1);
    }
}

/* Asks for the next step as if evidence had grown for each cause. returns how many a further test here would show */
static uint32_t shown_here(void)
{
    drift_job_t *job = &app.controller.drift;
    uint32_t here = 0;
    TEST_ASSERT_TRUE(job->has_outlook);
    job->report.state = BRACE_DRIFT_WATCHING;
    job->report.evidence = 12.0f;
    for (int cause = 0; cause < BRACE_DRIFT_CAUSE_COUNT; cause++) {
        job->report.cause = (brace_drift_cause_t)cause;
        const bool shows = job->outlook.steps_needed[cause] <= 64u;
        TEST_ASSERT_EQUAL(shows ? BRACE_DRIFT_NEXT_REPEAT_TEST : BRACE_DRIFT_NEXT_TEST_ANOTHER_POSTURE,
                          drift_job_next_step(job));
        here += shows;
    }
    job->report.cause = BRACE_DRIFT_UNEXPLAINED;
    TEST_ASSERT_EQUAL(BRACE_DRIFT_NEXT_REPEAT_TEST, drift_job_next_step(job));
    return here;
}

/* The next step while evidence grows follows what a further test at this posture can show. */
static void assert_a_suspicion_is_tested_where_it_shows(int turn)
{
    const brace_limb_t *limb = &app.controller.parameters.in_force.limb;
    brace_loading_setup_t quick = quick_setup();
    turn += (14 - turn % 8) % 8; /* the third posture, along z: there each cause shows */
    test_at(turn, limb, &quick);
    ticks(10);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_CAUSE_COUNT, shown_here());
    quick.step_mm *= 0.1f; /* so little shows nothing within a test */
    test_at(turn + 1, limb, &quick);
    ticks(10);
    TEST_ASSERT_LESS_THAN(BRACE_DRIFT_CAUSE_COUNT, shown_here());
}

static void test_what_was_learned_outlives_a_restart_and_so_does_the_alarm_of_a_crack_until_cleared(void)
{
    const int turn = learn();
    ticks(300);
    const brace_drift_t learned = app.controller.drift.drift;
    restart();
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, app.controller.drift.drift.state);
    TEST_ASSERT_EQUAL(learned.steps, app.controller.drift.drift.steps);
    TEST_ASSERT_EQUAL_MEMORY(learned.offset, app.controller.drift.drift.offset, sizeof learned.offset);
    TEST_ASSERT_EQUAL_MEMORY(learned.covariance, app.controller.drift.drift.covariance, sizeof learned.covariance);
    TEST_ASSERT_EQUAL_MEMORY(learned.held, app.controller.drift.drift.held, sizeof learned.held);
    TEST_ASSERT_EQUAL(0, now()->faults);
    crack(turn); /* what broke while it was switched off, or after, shows against the baseline of before */
    TEST_ASSERT_TRUE(now()->k_is_valid);
    restart();
    TEST_ASSERT_EQUAL(BRACE_FAULT_MODEL_DRIFT, now()->faults);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_DRIFTED, app.controller.drift.drift.state);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_clear(&app, BRACE_FAULT_MODEL_DRIFT));
    ticks(1);
    TEST_ASSERT_EQUAL(0, now()->faults);
    restart();
    TEST_ASSERT_EQUAL(0, now()->faults);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, app.controller.drift.drift.state);
    assert_a_suspicion_is_tested_where_it_shows(turn);
}

enum { ENTRY_DRIFT = 0x1000 + 88, REGISTER_DRIFT = 176, DRIFT_VALUES = 9 };

static int32_t (*whole_send)(void *context, const brace_can_frame_t *frame);
static brace_can_emergency_t emergency;
static uint32_t emergencies;

/* The bus always has room; emergencies are looked at. */
static int32_t watched_send(void *context, const brace_can_frame_t *frame)
{
    if (frame->id == 0x080u + NODE) {
        brace_can_unpack_emergency(frame->data, &emergency);
        emergencies++;
        if ((emergency.faults & BRACE_FAULT_MODEL_DRIFT) != 0u) {
            TEST_ASSERT_EQUAL_HEX16(0xff01, emergency.error_code);
            TEST_ASSERT_EQUAL(BRACE_DRIFT_DRIFTED, brace_app_drift_report(&app)->state);
            TEST_ASSERT_EQUAL(brace_app_drift_report(&app)->cause + 1, emergency.drift_cause);
        }
    }
    if (fake.can_sent.count > 20u) {
        drain();
    }
    return whole_send(context, frame);
}

static void assert_every_wire_reports(const uint32_t reported[DRIFT_VALUES])
{
    uint8_t data[8] = {BRACE_REQUEST_DRIFT, 7};
    brace_can_drift_answer_0_t first;
    brace_can_drift_answer_1_t loss;
    brace_can_drift_answer_2_t readings;
    const reply_t reply = read_asks(4, REGISTER_DRIFT, 2 * DRIFT_VALUES);
    drain(); /* else watched_send throws an answer away with what nobody has read */
    for (uint32_t i = 0; i < DRIFT_VALUES; i++) {
        TEST_ASSERT_EQUAL_HEX32(reported[i], value_at(&reply, i));
        TEST_ASSERT_EQUAL_HEX32(reported[i], read_entry(ENTRY_DRIFT + i));
    }
    const answer_t answer = ask(data);
    TEST_ASSERT_EQUAL(3, answer.count);
    brace_can_unpack_drift_answer_0(answer.part[0], &first);
    brace_can_unpack_drift_answer_1(answer.part[1], &loss);
    brace_can_unpack_drift_answer_2(answer.part[2], &readings);
    TEST_ASSERT_EQUAL(reported[0], first.state);
    TEST_ASSERT_EQUAL(reported[1], first.cause);
    TEST_ASSERT_EQUAL(reported[2], first.could_be);
    TEST_ASSERT_FLOAT_WITHIN(6e-4f, float_at(&reply, 3), first.evidence);
    TEST_ASSERT_TRUE(isnan(float_at(&reply, 4)) ? isnan(loss.loss_ratio)
                                                : fabsf(float_at(&reply, 4) - loss.loss_ratio) < 1e-5f);
    TEST_ASSERT_EQUAL(reported[6] > 0xffffu ? 0xffffu : reported[6], readings.since_readings);
    TEST_ASSERT_EQUAL(reported[7], readings.readings);
    TEST_ASSERT_EQUAL(reported[8], first.next_step);
}

/* Whoever hears of the alarm hears of the likeliest cause, and hears again when that is another one. The first readings
 * may point at the wrong part; tests at other postures show that it is the tibia. */
static void test_every_wire_names_the_cause_of_a_drift(void)
{
    const brace_loading_setup_t quick = quick_setup();
    int turn = learn();
    const brace_limb_t cracked = cracked_limb();
    whole_send = fake.hal.can_send;
    fake.hal.can_send = watched_send;
    emergencies = 0;
    turn = crack(turn);
    ticks(2);
    TEST_ASSERT_TRUE(emergencies >= 1u);
    for (int i = 0; i < 6; i++) {
        test_at(turn++, &cracked, &quick);
        ticks(2);
    }
    const brace_drift_report_t *report = brace_app_drift_report(&app);
    const uint32_t reported = emergencies;
    TEST_ASSERT_TRUE(reported <= 3u);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_CAUSE_TIBIA_LINK_OR_KNEE_JOINT, emergency.drift_cause);
    TEST_ASSERT_TRUE(report->evidence >= BRACE_DRIFT_ALARM);
    ASSERT_CLOSE(1.0 - 1.0 / 1.5, report->loss_ratio, 0.1);
    const uint32_t drifted[DRIFT_VALUES] = {BRACE_DRIFT_DRIFTED,
                                            BRACE_DRIFT_CAUSE_TIBIA_LINK_OR_KNEE_JOINT,
                                            1u << BRACE_DRIFT_TIBIA_OR_KNEE,
                                            bits(report->evidence),
                                            bits(report->loss_ratio),
                                            bits(report->loss_sigma_ratio),
                                            report->since_steps,
                                            report->steps,
                                            BRACE_DRIFT_NEXT_INSPECT_TIBIA_LINK_AND_KNEE_JOINT};
    assert_every_wire_reports(drifted);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_clear(&app, BRACE_FAULT_MODEL_DRIFT));
    ticks(5);
    TEST_ASSERT_EQUAL(reported + 1u, emergencies);
    TEST_ASSERT_EQUAL_HEX32(0, emergency.faults);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_CAUSE_NONE, emergency.drift_cause);
    const uint32_t unknown = bits(__builtin_nanf(""));
    const uint32_t watching[DRIFT_VALUES] = {
        BRACE_DRIFT_WATCHING, BRACE_DRIFT_CAUSE_NONE,  0, 0, unknown, unknown, UINT32_MAX,
        report->steps,        BRACE_DRIFT_NEXT_NOTHING};
    assert_every_wire_reports(watching);
}

/* A baseline that walks away is an alarm without evidence, and has a cause all the same. */
static void test_an_alarm_without_evidence_has_a_cause(void)
{
    learn();
    memset(app.controller.drift.drift.evidence, 0, sizeof app.controller.drift.drift.evidence);
    app.controller.drift.drift.cause = BRACE_DRIFT_FEMUR_JOINT_OR_BASE;
    app.controller.drift.reports = true;
    as_if(BRACE_DRIFT_DRIFTED, app.controller.drift.drift.steps);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FAULT_MODEL_DRIFT, now()->faults);
    drain();
    TEST_ASSERT_EQUAL(bits(0.0f), read_entry(ENTRY_DRIFT + 3));
    TEST_ASSERT_EQUAL(BRACE_DRIFT_CAUSE_FEMUR_JOINT_OR_BASE, read_entry(ENTRY_DRIFT + 1));
    TEST_ASSERT_EQUAL(BRACE_DRIFT_NEXT_INSPECT_FEMUR_JOINT_AND_BASE, read_entry(ENTRY_DRIFT + 8));
}

static void test_half_learned_goes_on_where_it_was(void)
{
    learn_up_to_a_record();
    restart();
    TEST_ASSERT_EQUAL(BRACE_DRIFT_LEARNING, app.controller.drift.drift.state);
    TEST_ASSERT_TRUE(app.controller.drift.drift.steps >= 512u && app.controller.drift.drift.steps <= 600u);
}

static void test_a_set_that_is_stored_is_learned_anew_and_a_roll_back_comes_back_to_what_was_known(void)
{
    const uint32_t steps = 3000;
    as_if(BRACE_DRIFT_WATCHING, steps);
    brace_parameters_t p = app.controller.parameters.in_force;
    p.limb.femur_mm = 186.0f;
    store(&p);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_LEARNING, app.controller.drift.drift.state);
    TEST_ASSERT_EQUAL(0, app.controller.drift.drift.steps);
    restart();
    TEST_ASSERT_EQUAL(BRACE_DRIFT_LEARNING, app.controller.drift.drift.state);
    store(NULL);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, app.controller.drift.drift.state);
    TEST_ASSERT_EQUAL(steps, app.controller.drift.drift.steps);
    p = app.controller.parameters.in_force;
    store(&p); /* the very same values: a commissioning */
    TEST_ASSERT_EQUAL(BRACE_DRIFT_LEARNING, app.controller.drift.drift.state);
}

/* Ten records fit the fake's slot: what is written is what has changed, and the last ones are for alarms. */
static void test_records_are_few_and_alarms_find_room(void)
{
    as_if(BRACE_DRIFT_WATCHING, 3000);
    const uint32_t room = brace_journal_room(&app.controller.drift.journal);
    TEST_ASSERT_EQUAL(9, room);
    as_if(BRACE_DRIFT_WATCHING, 3000 + 4095);
    app.controller.drift.drift.evidence[BRACE_DRIFT_FEMUR] = 3.9f;
    as_if(BRACE_DRIFT_WATCHING, 3000 + 4095);
    TEST_ASSERT_EQUAL(room, brace_journal_room(&app.controller.drift.journal));
    app.controller.drift.drift.evidence[BRACE_DRIFT_FEMUR] = 4.1f;
    as_if(BRACE_DRIFT_WATCHING, 3000 + 4095);
    TEST_ASSERT_EQUAL(room - 1, brace_journal_room(&app.controller.drift.journal));
    app.controller.drift.drift.evidence[BRACE_DRIFT_FEMUR] = 0.0f; /* what has fallen is kept too */
    as_if(BRACE_DRIFT_WATCHING, 3000 + 4095);
    TEST_ASSERT_EQUAL(room - 2, brace_journal_room(&app.controller.drift.journal));
    as_if(BRACE_DRIFT_WATCHING, 3000 + 4095 + 4096);
    TEST_ASSERT_EQUAL(room - 3, brace_journal_room(&app.controller.drift.journal));
    while (brace_journal_room(&app.controller.drift.journal) > 2u) { /* as if years had passed */
        TEST_ASSERT_TRUE(brace_journal_begin(&app.controller.drift.journal, &app.controller.drift.drift));
        while (brace_journal_step(&app.controller.drift.journal) == BRACE_JOURNAL_BUSY) {
        }
    }
    as_if(BRACE_DRIFT_WATCHING, 90000);
    TEST_ASSERT_EQUAL(2, brace_journal_room(&app.controller.drift.journal));
    as_if(BRACE_DRIFT_DRIFTED, 90000);
    TEST_ASSERT_EQUAL(1, brace_journal_room(&app.controller.drift.journal));
    restart();
    TEST_ASSERT_EQUAL(BRACE_FAULT_MODEL_DRIFT, now()->faults);
}

static void test_a_memory_that_does_not_keep_is_a_fault(void)
{
    fake.nvm_stuck = 0x04;
    learn_up_to_a_record();
    TEST_ASSERT_EQUAL(BRACE_FAULT_STORE, now()->faults);
    TEST_ASSERT_TRUE(app.controller.drift.drift.steps >= 512u);
    TEST_ASSERT_TRUE(now()->k_is_valid);
}

/* Runs a test tick by tick; run_at: how many readings the check's run has after each step. The check takes a reading in
 * in the tick after it.
 * returns the steps it took in */
static uint32_t watched_run(const brace_loading_setup_t *setup, uint8_t run_at[32])
{
    const uint32_t before = app.controller.drift.drift.steps;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, setup));
    for (int i = 0; i < 60000 && app.controller.mode.now == BRACE_MODE_LOADING_TEST; i++) {
        const uint32_t step = app.controller.loading.step;
        ticks(1);
        if (app.controller.loading.step > step) {
            ticks(1);
            run_at[step] = app.controller.drift.drift.run_count;
        }
    }
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
    return app.controller.drift.drift.steps - before;
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
    TEST_ASSERT_EQUAL(0, app.controller.drift.drift.run_count);
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

static void test_a_tick_that_is_late_is_reported_whatever_it_works_at(void)
{
    static const uint8_t phases[] = {LOADING_MOVE, LOADING_DWELL, LOADING_MODEL, LOADING_JUDGE};
    for (uint32_t i = 0; i < sizeof phases; i++) {
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
        for (int tick = 0; tick < 60000 && app.controller.loading.phase != phases[i]; tick++) {
            ticks(1);
        }
        TEST_ASSERT_EQUAL(phases[i], app.controller.loading.phase);
        const uint32_t late = counters().ticks_late;
        fake.now_us += 5 * TICK_US;
        ticks(1);
        TEST_ASSERT_EQUAL(late + 1, counters().ticks_late);
        TEST_ASSERT_BITS(BRACE_FAULT_TICK_LATE, BRACE_FAULT_TICK_LATE, now()->faults);
        (void)brace_app_loading_stop(&app);
        for (int tick = 0; tick < 3000 && (now()->mode != BRACE_MODE_MONITOR || now()->faults != 0); tick++) {
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
    RUN_TEST(test_every_wire_names_the_cause_of_a_drift);
    RUN_TEST(test_an_alarm_without_evidence_has_a_cause);
    RUN_TEST(test_half_learned_goes_on_where_it_was);
    RUN_TEST(test_a_set_that_is_stored_is_learned_anew_and_a_roll_back_comes_back_to_what_was_known);
    RUN_TEST(test_records_are_few_and_alarms_find_room);
    RUN_TEST(test_a_memory_that_does_not_keep_is_a_fault);
    RUN_TEST(test_a_tick_that_is_late_is_reported_whatever_it_works_at);
    return UNITY_END();
}
