/* How long a joint with play stays in each state and each phase, to the tick, and which sample is too late. */
#include "backlash/backlash_table.h"
#include "brace/backlash.h"
#include "close.h"

enum { TICK_US = 1000, FAULT_TICKS = 20, CROSSING_TICKS = 2000, REMEMBERED_TICKS = 250, VERIFY_TICKS = 100 };
#define GAP_RAD 0.01

static brace_backlash_t joint;
static brace_backlash_out_t out;
static uint32_t now_us, tick_us;

static void start(uint32_t with_tick_us)
{
    const brace_backlash_params_t params = {.tick_us = with_tick_us,
                                            .gap_rad = (float)GAP_RAD,
                                            .friction_n_mm = 200.0f,
                                            .friction_tolerance_ratio = 0.2f,
                                            .inertia_n_mm_s2_per_rad = 20.0f,
                                            .torque_range_n_mm = 8000.0f,
                                            .torque_noise_n_mm = 40.0f,
                                            .torque_bias_n_mm = 80.0f,
                                            .angle_step_rad = 2e-5f,
                                            .takeup = {.torque_max_n_mm = 4500.0f,
                                                       .preload_n_mm = 800.0f,
                                                       .travel_max_rad = 0.06f,
                                                       .reach_max_rad = 0.15f,
                                                       .rate_rad_per_s = 0.1f,
                                                       .time_max_us = 3000000,
                                                       .verify_us = VERIFY_TICKS * TICK_US}};
    now_us = 0;
    tick_us = with_tick_us;
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_backlash_init(&joint, &params));
}

void setUp(void)
{
    start(TICK_US);
}

void tearDown(void) {}

static brace_status_t sample_after(uint32_t after_us, double motor_rad, double torque_n_mm)
{
    now_us += after_us;
    const brace_backlash_sample_t sample = {
        .now_us = now_us, .motor_rad = (float)motor_rad, .torque_n_mm = (float)torque_n_mm};
    return brace_backlash_tick(&joint, &sample, &out);
}

static void stand(double motor_rad, double torque_n_mm, int ticks)
{
    for (int i = 0; i < ticks; i++) {
        TEST_ASSERT_EQUAL_INT(BRACE_OK, sample_after(tick_us, motor_rad, torque_n_mm));
    }
}

/* For so many ticks the joint stays in its state; with the next one it has left it. */
static void stays_for(int ticks, double motor_rad, double torque_n_mm)
{
    const brace_backlash_state_t state = out.state;
    for (int i = 0; i < ticks; i++) {
        stand(motor_rad, torque_n_mm, 1);
        TEST_ASSERT_EQUAL_INT(state, out.state);
    }
    stand(motor_rad, torque_n_mm, 1);
    TEST_ASSERT_NOT_EQUAL(state, out.state);
}

/* A fault heals after 20 ms of good samples in a row. */
static void a_fault_lasts_for_twenty_milliseconds(void)
{
    stand(0.0, 3000.0, 300);
    TEST_ASSERT_EQUAL_INT(BRACE_E_NOT_FINITE, sample_after(TICK_US, (double)NAN, 3000.0));
    TEST_ASSERT_EQUAL_INT(BRACE_BACKLASH_FAULT, out.state);
    stand(0.0, 3000.0, FAULT_TICKS);
    TEST_ASSERT_EQUAL_INT(BRACE_E_NOT_FINITE, sample_after(TICK_US, (double)NAN, 3000.0));
    stays_for(FAULT_TICKS, 0.0, 3000.0);
    TEST_ASSERT_EQUAL_INT(BRACE_BACKLASH_UNKNOWN, out.state);
}

/* Its time is up after twenty milliseconds, and not a microsecond before: seven of these ticks are 19,999 us. */
static void a_fault_lasts_to_the_microsecond(void)
{
    start(2857);
    stand(0.0, 3000.0, 100);
    TEST_ASSERT_EQUAL_INT(BRACE_E_NOT_FINITE, sample_after(tick_us, (double)NAN, 3000.0));
    stays_for(8, 0.0, 3000.0);
    start(2858);
    stand(0.0, 3000.0, 100);
    TEST_ASSERT_EQUAL_INT(BRACE_E_NOT_FINITE, sample_after(tick_us, (double)NAN, 3000.0));
    stays_for(7, 0.0, 3000.0);
}

/* A sample may come four ticks after the one before, and no microsecond later. */
static void a_sample_may_be_late_by_three_ticks(void)
{
    for (uint32_t late_us = 0; late_us < 2u; late_us++) {
        setUp();
        stand(0.0, 3000.0, 300);
        TEST_ASSERT_TRUE(out.valid);
        TEST_ASSERT_EQUAL_INT(BRACE_OK, sample_after(4u * TICK_US + late_us, 0.0, 3000.0));
        TEST_ASSERT_EQUAL(late_us != 0u, out.state == BRACE_BACKLASH_FAULT);
        TEST_ASSERT_EQUAL(late_us == 0u, out.valid);
    }
}

/* A flank that no load shows any more is remembered for a quarter of a second, on either side. */
static void a_flank_is_remembered_for_a_quarter_of_a_second(void)
{
    for (int flank = -1; flank <= 1; flank += 2) {
        setUp();
        stand(0.0, flank * 2500.0, 300);
        TEST_ASSERT_EQUAL_INT(flank, out.flank);
        while (joint.undecided_us == 0u) { /* the mean takes its time to forget the load */
            stand(0.0, 0.0, 1);
        }
        TEST_ASSERT_EQUAL_INT(flank, out.flank);
        stays_for(REMEMBERED_TICKS - 2, 0.0, 0.0);
        TEST_ASSERT_EQUAL_INT(BRACE_BACKLASH_UNKNOWN, out.state);
    }
}

/* A motor that stands on its way through the gap counts as crossing it for two seconds. */
static void a_crossing_lasts_for_two_seconds(void)
{
    for (int flank = -1; flank <= 1; flank += 2) {
        const double away_rad = -flank * 0.5 * GAP_RAD;
        setUp();
        stand(0.0, flank * 2500.0, 300);
        stand(0.0, 0.0, 100);
        TEST_ASSERT_EQUAL_INT(flank, out.flank);
        for (int i = 1; i <= 50 && out.state != BRACE_BACKLASH_CROSSING; i++) {
            stand(away_rad * i / 50.0, -flank * 200.0, 1);
        }
        TEST_ASSERT_EQUAL_INT(BRACE_BACKLASH_CROSSING, out.state);
        stays_for(CROSSING_TICKS, (double)joint.motor_rad, 0.0);
        TEST_ASSERT_EQUAL_INT(BRACE_BACKLASH_UNKNOWN, out.state);
    }
}

/* A preload that stands is verified for as long as the parameters say. Half of that time the motor may come to rest. */
static void a_preload_is_verified_for_its_time(void)
{
    for (int moves = 0; moves < 2; moves++) {
        double motor_rad = 0.0;
        int count = 0;
        setUp();
        stand(0.0, 3000.0, 300);
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_takeup_request(&joint, 1));
        stand(0.0, 3000.0, 1);
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_APPROACH, out.phase);
        stand(0.0, 3000.0, 1);
        for (; out.phase == BRACE_TAKEUP_VERIFY; count++) {
            const int last_settling = VERIFY_TICKS / 2 - 1 + moves; /* the motor goes a long way in this tick */
            motor_rad = count >= last_settling ? 0.3 * GAP_RAD : 0.0;
            stand(motor_rad, 3000.0, 1);
        }
        TEST_ASSERT_EQUAL_INT(moves == 0 ? BRACE_TAKEUP_HOLD : BRACE_TAKEUP_LET_GO, out.phase);
        TEST_ASSERT_EQUAL_INT(moves == 0 ? BRACE_TAKEUP_DONE : BRACE_TAKEUP_E_VERIFY, out.takeup);
        TEST_ASSERT_EQUAL_INT(moves == 0 ? VERIFY_TICKS + 1 : VERIFY_TICKS / 2 + 1, count);
    }
}

/* Its time is up to the microsecond, too: 41 of the first of these ticks are 99,999 us. */
static void a_preload_is_verified_to_the_microsecond(void)
{
    for (int more_us = 0; more_us < 2; more_us++) {
        int count = 0;
        start(2439u + (uint32_t)more_us);
        stand(0.0, 3000.0, 150);
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_takeup_request(&joint, 1));
        stand(0.0, 3000.0, 2);
        for (; out.phase == BRACE_TAKEUP_VERIFY; count++) {
            stand(0.0, 3000.0, 1);
        }
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_DONE, out.takeup);
        TEST_ASSERT_EQUAL_INT(43 - more_us, count);
    }
}

/* Whatever a sample shows has its effect in the tick that shows it. Only where nothing is shown does a state end by its
 * time. What a take-up came to is said by its own phases alone. */
static void what_is_shown_counts_at_once(void)
{
    int timed = 0, results = 0;
    for (int state = 0; state < BRACE_BACKLASH_STATE_COUNT + BRACE_TAKEUP_PHASE_COUNT; state++) {
        const bool is_state = state < BRACE_BACKLASH_STATE_COUNT;
        const transitions_t *from =
            is_state ? &backlash_states[state] : &takeup_phases[state - BRACE_BACKLASH_STATE_COUNT];
        for (int i = 0; i < from->count; i++) {
            const transition_t *row = &from->rows[i];
            TEST_ASSERT_EQUAL(row->facts == (uint32_t)FACT_ALWAYS, row->after_us != 0u);
            TEST_ASSERT_FALSE(is_state && row->result != 0);
            timed += row->after_us != 0u;
            results += row->result != 0;
        }
    }
    TEST_ASSERT_EQUAL(3, timed);
    TEST_ASSERT_TRUE(results > 10);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_fault_lasts_for_twenty_milliseconds);
    RUN_TEST(a_fault_lasts_to_the_microsecond);
    RUN_TEST(a_sample_may_be_late_by_three_ticks);
    RUN_TEST(a_flank_is_remembered_for_a_quarter_of_a_second);
    RUN_TEST(a_crossing_lasts_for_two_seconds);
    RUN_TEST(a_preload_is_verified_for_its_time);
    RUN_TEST(a_preload_is_verified_to_the_microsecond);
    RUN_TEST(what_is_shown_counts_at_once);
    return UNITY_END();
}
