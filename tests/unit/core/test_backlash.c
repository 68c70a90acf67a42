/* The preload state machine, transition by transition, on a quasi-static joint written out here. */
#include <stddef.h>
#include <string.h>

#include "brace/backlash.h"
#include "brace/gap_stiffness.h"
#include "close.h"
#include "noise.h"
#include "sample_limbs.h"

#define GAP_RAD 0.01f

static brace_backlash_t joint;
static brace_backlash_out_t out;
static uint32_t now_us;
static double noise_n_mm;

static brace_backlash_params_t sound_params(void)
{
    return (brace_backlash_params_t){.tick_us = 1000,
                                     .gap_rad = GAP_RAD,
                                     .friction_n_mm = 200.0f,
                                     .friction_tolerance_ratio = 0.2f,
                                     .inertia_n_mm_s2_per_rad = 20.0f,
                                     .torque_range_n_mm = 8000.0f,
                                     .torque_noise_n_mm = 400.0f,
                                     .torque_bias_n_mm = 80.0f,
                                     .angle_step_rad = 2e-5f,
                                     .takeup = {.torque_max_n_mm = 4500.0f,
                                                .preload_n_mm = 800.0f,
                                                .travel_max_rad = 0.06f,
                                                .reach_max_rad = 0.15f,
                                                .rate_rad_per_s = 0.1f,
                                                .time_max_us = 3000000,
                                                .verify_us = 100000}};
}

void setUp(void)
{
    const brace_backlash_params_t params = sound_params();
    noise_state = 2463534242u;
    now_us = 4294900000u; /* wraps on the way */
    noise_n_mm = 400.0;
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_backlash_init(&joint, &params));
}
void tearDown(void) {}

static void tick(double motor_rad, double torque_n_mm)
{
    now_us += 1000u;
    const brace_backlash_sample_t sample = {
        .now_us = now_us,
        .motor_rad = (float)motor_rad,
        .torque_n_mm = (float)(torque_n_mm + noise_n_mm * noise_normal()),
    };
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_backlash_tick(&joint, &sample, &out));
}

static void stand(double motor_rad, double torque_n_mm, int ticks)
{
    for (int i = 0; i < ticks; i++) {
        tick(motor_rad, torque_n_mm);
    }
}

static void a_load_engages_its_flank_whatever_the_motion(void)
{
    for (int flank = -1; flank <= 1; flank += 2) {
        for (int way = -1; way <= 1; way += 2) {
            setUp();
            for (int i = 0; i < 300; i++) {
                tick(way * 1e-3 * i, flank * 2500.0 + way * 200.0);
            }
            TEST_ASSERT_EQUAL_INT(flank > 0 ? BRACE_BACKLASH_ENGAGED_POSITIVE : BRACE_BACKLASH_ENGAGED_NEGATIVE,
                                  out.state);
            TEST_ASSERT_EQUAL_INT(flank, out.flank);
            TEST_ASSERT_TRUE(out.valid);
            ASSERT_CLOSE(-flank * 0.5 * (double)GAP_RAD, out.offset_rad, 1e-8);
            ASSERT_CLOSE(flank * 2500.0, out.load_n_mm, 6.0 * 90.0); /* six sigma of the fast filter */
            TEST_ASSERT_TRUE(fabs((double)out.load_n_mm - flank * 2500.0) < (double)out.load_off_n_mm);
        }
    }
}

static void nothing_is_decided_of_a_load_within_friction(void)
{
    stand(0.0, 150.0, 2000);
    TEST_ASSERT_EQUAL_INT(BRACE_BACKLASH_UNKNOWN, out.state);
    TEST_ASSERT_EQUAL_INT(0, out.flank);
    TEST_ASSERT_FALSE(out.valid);
}

static void a_lost_load_is_not_valid_past_the_detection_time(void)
{
    for (int trial = 0; trial < 50; trial++) {
        stand(0.0, 8000.0, 300);
        TEST_ASSERT_TRUE(out.valid);
        const int ticks = (int)(brace_backlash_detection_us(&joint) / 1000u);
        stand(0.0, 0.0, ticks);
        for (int i = 0; i < 600; i++) {
            tick(0.0, 0.0);
            TEST_ASSERT_FALSE(out.valid);
        }
        TEST_ASSERT_EQUAL_INT(0, out.flank); /* memory has run out too */
    }
    TEST_ASSERT_TRUE(brace_backlash_detection_us(&joint) <= 60000u);
}

static void a_reversal_crosses_with_the_motors_travel(void)
{
    for (int flank = -1; flank <= 1; flank += 2) {
        setUp();
        noise_n_mm = 40.0; /* at the full noise the slow mean leans to either side of no load */
        stand(flank * 0.1, flank * 3000.0, 300);
        TEST_ASSERT_EQUAL_INT(flank, out.flank);
        bool crossed = false;
        for (int i = 1; i <= 600; i++) { /* back through the gap at 0.02 rad/s, friction only */
            tick(flank * (0.1 - 2e-5 * i), -flank * 200.0);
            if (out.state == BRACE_BACKLASH_CROSSING) {
                crossed = true;
                TEST_ASSERT_EQUAL_INT(0, out.flank);
                TEST_ASSERT_FALSE(out.valid);
            }
        }
        TEST_ASSERT_TRUE(crossed);
        TEST_ASSERT_TRUE((float)flank * out.offset_rad > 0.2f * GAP_RAD); /* on its way from one end to the other */
        for (int i = 1; i <= 200; i++) {
            tick(flank * (0.088 - 1e-4 * i), -flank * 2500.0);
        }
        TEST_ASSERT_EQUAL_INT(-flank, out.flank);
        TEST_ASSERT_TRUE(out.valid);
    }
}

/* Nothing but noise on a joint said to be without friction or bias: six sigma are not passed in 20,000 ticks. */
static void noise_alone_proves_nothing(void)
{
    brace_backlash_params_t params = sound_params();
    params.friction_n_mm = params.torque_bias_n_mm = 0.0f;
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_backlash_init(&joint, &params));
    for (int i = 0; i < 20000; i++) {
        tick(0.0, 0.0);
        TEST_ASSERT_FALSE(out.valid);
    }
}

static void a_load_reversal_of_a_standing_motor_is_seen(void)
{
    stand(0.0, 3000.0, 300);
    stand(0.0, -3000.0, 60);
    TEST_ASSERT_EQUAL_INT(BRACE_BACKLASH_ENGAGED_NEGATIVE, out.state);
    TEST_ASSERT_TRUE(out.valid);
}

static void an_expected_load_decides_but_never_proves(void)
{
    for (int i = 0; i < 300; i++) {
        now_us += 1000u;
        const brace_backlash_sample_t sample = {.now_us = now_us,
                                                .torque_n_mm = (float)(400.0 * noise_normal()),
                                                .load_is_expected = true,
                                                .expected_n_mm = -180.0f,
                                                .expected_off_n_mm = 50.0f};
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_backlash_tick(&joint, &sample, &out));
        TEST_ASSERT_FALSE(out.valid);
    }
    TEST_ASSERT_EQUAL_INT(-1, out.flank);
    for (int i = 0; i < 300; i++) { /* and what contradicts the motor is not believed */
        now_us += 1000u;
        const brace_backlash_sample_t sample = {.now_us = now_us,
                                                .torque_n_mm = (float)(3000.0 + 400.0 * noise_normal()),
                                                .load_is_expected = true,
                                                .expected_n_mm = -180.0f,
                                                .expected_off_n_mm = 50.0f};
        brace_backlash_tick(&joint, &sample, &out);
    }
    TEST_ASSERT_EQUAL_INT(1, out.flank);
    TEST_ASSERT_TRUE(out.valid);
}

static void bad_and_late_samples_are_a_fault_that_heals(void)
{
    const float bad[][2] = {{NAN, 0.0f}, {0.0f, INFINITY}, {2e3f, 0.0f}, {0.0f, 1e5f}};
    for (int i = 0; i < 5; i++) {
        setUp();
        stand(0.0, 3000.0, 300);
        TEST_ASSERT_TRUE(out.valid);
        if (i < 4) {
            now_us += 1000u;
            const brace_backlash_sample_t sample = {.now_us = now_us, .motor_rad = bad[i][0], .torque_n_mm = bad[i][1]};
            TEST_ASSERT_EQUAL_INT(i < 2 ? BRACE_E_NOT_FINITE : BRACE_E_RANGE,
                                  brace_backlash_tick(&joint, &sample, &out));
        } else {
            now_us += 5000u;
            tick(0.0, 3000.0);
        }
        TEST_ASSERT_EQUAL_INT(BRACE_BACKLASH_FAULT, out.state);
        TEST_ASSERT_FALSE(out.valid);
        TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_takeup_request(&joint, 1));
        stand(0.0, 3000.0, 15);
        TEST_ASSERT_EQUAL_INT(BRACE_BACKLASH_FAULT, out.state);
        stand(0.0, 3000.0, 200);
        TEST_ASSERT_TRUE(out.valid && out.flank == 1);
    }
}

/* A servo with droop, friction and a gap before a spring of stiffness k [N mm/rad] to the ground; no inertia. */
static const double servo_n_mm_per_rad = 60000.0, friction_n_mm = 200.0, half_gap_rad = 0.005;
static double motor_rad, load_n_mm;
static double lags_ms, reached_rad; /* how late the servo follows, and the set-point that it has come to */

/* The motor's angle at which the servo's torque is the spring's load plus more_n_mm. */
static double motor_at(double setpoint_rad, double k, double more_n_mm)
{
    const double pull_n_mm = servo_n_mm_per_rad * setpoint_rad - more_n_mm, free_rad = pull_n_mm / servo_n_mm_per_rad;
    if (fabs(free_rad) <= half_gap_rad) {
        return free_rad;
    }
    return (pull_n_mm + copysign(k * half_gap_rad, pull_n_mm)) / (servo_n_mm_per_rad + k);
}

static void follow(double setpoint_rad, double k)
{
    reached_rad += (setpoint_rad - reached_rad) / (1.0 + lags_ms);
    const double lowest_rad = motor_at(reached_rad, k, friction_n_mm);
    const double highest_rad = motor_at(reached_rad, k, -friction_n_mm);
    motor_rad = fmin(fmax(motor_rad, lowest_rad), highest_rad); /* between them friction holds the motor */
    load_n_mm = k * (motor_rad - fmin(fmax(motor_rad, -half_gap_rad), half_gap_rad));
    tick(motor_rad, servo_n_mm_per_rad * (reached_rad - motor_rad));
}

static void take_up(int flank, double k, int ticks)
{
    motor_rad = reached_rad = 0.0;
    for (int i = 0; i < 100; i++) {
        follow(0.0, k);
    }
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_takeup_request(&joint, flank));
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_takeup_request(&joint, flank));
    for (int i = 0; i < ticks && out.phase != BRACE_TAKEUP_HOLD; i++) {
        follow((double)out.command_rad, k);
        if (out.phase == BRACE_TAKEUP_APPROACH || out.phase == BRACE_TAKEUP_VERIFY) {
            TEST_ASSERT_EQUAL_INT(BRACE_BACKLASH_TAKING_UP, out.state);
            TEST_ASSERT_TRUE(out.limit_torque);
            TEST_ASSERT_EQUAL_INT(0, out.flank);
        }
    }
}

static void a_takeup_preloads_verifies_and_lets_go(void)
{
    for (int flank = -1; flank <= 1; flank += 2) {
        setUp();
        memset(&out, 0, sizeof out);
        take_up(flank, 1e5, 4000);
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_HOLD, out.phase);
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_DONE, out.takeup);
        for (int i = 0; i < 500; i++) {
            follow((double)out.command_rad, 1e5);
            TEST_ASSERT_TRUE(out.valid && out.flank == flank);
        }
        /* the standing motor's friction may hide that much, and the slow mean six of its sigma */
        ASSERT_CLOSE(load_n_mm, out.preload_n_mm, friction_n_mm * 1.2 + 6.0 * 32.0);
        TEST_ASSERT_TRUE(flank * load_n_mm > 800.0);
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_takeup_let_go(&joint));
        double before = (double)out.command_rad;
        for (int i = 0; i < 4000 && out.phase != BRACE_TAKEUP_IDLE; i++) {
            follow((double)out.command_rad, 1e5);
            TEST_ASSERT_TRUE(fabs((double)out.command_rad - before) < 1.01e-4); /* never faster than its rate */
            before = (double)out.command_rad;
        }
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_IDLE, out.phase);
        TEST_ASSERT_TRUE(out.command_rad == 0.0f && !out.limit_torque && out.preload_n_mm == 0.0f);
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_DONE, out.takeup);
    }
}

/* At the take-up's rate the motor is 4 mrad behind, which is more than may move while the load is verified. */
static void a_servo_that_lags_takes_up(void)
{
    memset(&out, 0, sizeof out);
    lags_ms = 70.0;
    take_up(1, 5e4, 4000);
    lags_ms = 0.0;
    TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_HOLD, out.phase);
    TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_DONE, out.takeup);
}

/* Without a load a flank is remembered for 250 ms, and while the motor stays within a fifth of the gap. */
static void a_flank_without_a_load_is_remembered_for_a_while(void)
{
    for (int flank = -1; flank <= 1; flank += 2) {
        const int engaged = flank > 0 ? BRACE_BACKLASH_ENGAGED_POSITIVE : BRACE_BACKLASH_ENGAGED_NEGATIVE;
        for (int moves = 0; moves < 3; moves++) {
            setUp();
            noise_n_mm = 0.0;
            stand(0.0, flank * 2500.0, 300);
            TEST_ASSERT_EQUAL_INT(engaged, out.state);
            stand(0.0, 0.0, 200); /* the mean takes some 30 ms to forget the load */
            TEST_ASSERT_EQUAL_INT(engaged, out.state);
            if (moves == 0) {
                stand(0.0, 0.0, 120);
                TEST_ASSERT_EQUAL_INT(BRACE_BACKLASH_UNKNOWN, out.state);
                continue;
            }
            const double back_rad = -flank * (moves == 1 ? 0.17 : 0.23) * (double)GAP_RAD;
            for (int i = 1; i <= 20; i++) { /* friction is all that the motor bears */
                tick(back_rad * i / 20.0, -flank * 200.0);
            }
            TEST_ASSERT_EQUAL_INT(moves == 1 ? engaged : BRACE_BACKLASH_CROSSING, out.state);
        }
    }
}

/* The motor moves evenly. */
static void advance_to(double from_rad, double to_rad, int ticks)
{
    for (int i = 1; i <= ticks; i++) {
        tick(from_rad + (to_rad - from_rad) * i / ticks, 0.0);
    }
}

/* Travel and time of a take-up count from where and when it begins. What was said to the one before is forgotten. */
static void each_takeup_begins_anew(void)
{
    noise_n_mm = 0.0;
    for (int n = 0; n < 4; n++) {
        const double at_rad = 0.3 * n - 0.2;
        stand(at_rad, 0.0, 50);
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_takeup_request(&joint, 1));
        stand(at_rad, 0.0, 1);
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_APPROACH, out.phase);
        advance_to(at_rad, at_rad + 0.0595, 1200); /* four of these are longer than a take-up may last */
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_APPROACH, out.phase);
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_RUNNING, out.takeup);
        if (n < 3) {
            TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_takeup_let_go(&joint));
            stand(at_rad + 0.0595, 0.0, 1);
            TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_NONE, out.takeup);
        } else {
            advance_to(at_rad + 0.0595, at_rad + 0.0605, 20);
            TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_E_TRAVEL, out.takeup);
        }
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_LET_GO, out.phase);
        stand(at_rad + 0.0595, 0.0, 1300);
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_IDLE, out.phase);
    }
}

static void expect_given_up(brace_takeup_result_t expected, const brace_takeup_bounds_t *bounds, double k)
{
    for (int flank = -1; flank <= 1; flank += 2) {
        brace_backlash_params_t params = sound_params();
        params.takeup = *bounds;
        memset(&out, 0, sizeof out);
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_backlash_init(&joint, &params));
        take_up(flank, k, 3000);
        TEST_ASSERT_EQUAL_INT(expected, out.takeup);
        TEST_ASSERT_NOT_EQUAL(BRACE_TAKEUP_HOLD, out.phase);
        for (int i = 0; i < 3000; i++) {
            follow((double)out.command_rad, k);
        }
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_IDLE, out.phase);
        TEST_ASSERT_EQUAL_INT(expected, out.takeup);
    }
}

/* A take-up that has just begun to verify, at rest. returns the motor's torque */
static double begin_to_verify(int flank)
{
    setUp();
    noise_n_mm = 0.0;
    memset(&out, 0, sizeof out);
    motor_rad = reached_rad = 0.0;
    for (int i = 0; i < 100; i++) {
        follow(0.0, 1e5);
    }
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_takeup_request(&joint, flank));
    for (int i = 0; i < 3000 && out.phase != BRACE_TAKEUP_VERIFY; i++) {
        follow((double)out.command_rad, 1e5);
    }
    TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_VERIFY, out.phase);
    return servo_n_mm_per_rad * ((double)out.command_rad - motor_rad);
}

/* The load has to stay for 100 ms, and in the second half of that time the motor too, within a quarter of the gap. */
static void load_and_motor_stay_while_they_are_verified(void)
{
    for (int flank = -1; flank <= 1; flank += 2) {
        double torque_n_mm = begin_to_verify(flank);
        stand(motor_rad, 0.0, 60);
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_E_VERIFY, out.takeup);
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_LET_GO, out.phase);

        torque_n_mm = begin_to_verify(flank);
        stand(motor_rad, torque_n_mm, 98);
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_VERIFY, out.phase);
        stand(motor_rad, torque_n_mm, 4);
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_HOLD, out.phase);
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_DONE, out.takeup);
        stand(motor_rad, 0.0, 100);
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_E_LOST, out.takeup);
        TEST_ASSERT_FALSE(out.valid);

        for (int i = 0; i < 6; i++) { /* the motor moves early or late, on or back, and less or more */
            const bool is_late = i % 2 != 0, is_more = i / 2 % 3 == 0;
            const double share = is_more ? 0.27 : i / 2 == 1 ? 0.23 : -0.23, moves_rad = share * (double)GAP_RAD;
            torque_n_mm = begin_to_verify(flank);
            stand(motor_rad, torque_n_mm, is_late ? 60 : 20);
            for (int j = 1; j <= 20; j++) {
                tick(motor_rad + moves_rad * j / 20.0, torque_n_mm);
            }
            stand(motor_rad + moves_rad, torque_n_mm, is_late ? 25 : 65);
            TEST_ASSERT_EQUAL_INT(is_late && is_more ? BRACE_TAKEUP_E_VERIFY : BRACE_TAKEUP_DONE, out.takeup);
        }
    }
}

/* The parameters at their bounds, just within and just beyond, as backlash_types.h and ranges.h name them. */
static void each_parameter_has_its_bounds(void)
{
    static const struct {
        size_t offset;
        float least, most; /* INFINITY: another parameter's bound comes first */
    } row[] = {{offsetof(brace_backlash_params_t, gap_rad), 1e-5f, 0.5f},
               {offsetof(brace_backlash_params_t, friction_n_mm), 0.0f, INFINITY},
               {offsetof(brace_backlash_params_t, friction_tolerance_ratio), 0.0f, 1.0f},
               {offsetof(brace_backlash_params_t, inertia_n_mm_s2_per_rad), 0.0f, 1e6f},
               {offsetof(brace_backlash_params_t, torque_range_n_mm), 4500.0f, 1e6f},
               {offsetof(brace_backlash_params_t, torque_noise_n_mm), 0.0f, INFINITY},
               {offsetof(brace_backlash_params_t, torque_bias_n_mm), 0.0f, INFINITY},
               {offsetof(brace_backlash_params_t, angle_step_rad), 1e-7f, 0.01f},
               {offsetof(brace_backlash_params_t, takeup.torque_max_n_mm), INFINITY, 8000.0f},
               {offsetof(brace_backlash_params_t, takeup.preload_n_mm), 0.0f, 4500.0f},
               {offsetof(brace_backlash_params_t, takeup.travel_max_rad), 1e-6f, 1.0f},
               {offsetof(brace_backlash_params_t, takeup.reach_max_rad), 1e-6f, 2.0f},
               {offsetof(brace_backlash_params_t, takeup.rate_rad_per_s), 1e-6f, 10.0f}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        for (int side = 0; side < 2; side++) {
            brace_backlash_params_t p = sound_params();
            float *member = (float *)(void *)((char *)&p + row[i].offset);
            const float bound = side == 0 ? row[i].least : row[i].most;
            if (isfinite(bound)) {
                *member = bound;
                TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_backlash_init(&joint, &p));
                *member = nextafterf(bound, side == 0 ? -INFINITY : INFINITY);
                TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_backlash_init(&joint, &p));
            }
            *member = NAN;
            TEST_ASSERT_EQUAL_INT(BRACE_E_NOT_FINITE, brace_backlash_init(&joint, &p));
        }
    }
}

static void every_bound_has_its_own_result(void)
{
    brace_takeup_bounds_t b = sound_params().takeup;
    expect_given_up(BRACE_TAKEUP_E_TRAVEL, &b, 0.0); /* nothing holds the link */
    b.travel_max_rad = 1.0f;
    expect_given_up(BRACE_TAKEUP_E_REACH, &b, 0.0);
    b.reach_max_rad = 2.0f;
    b.time_max_us = 300000;
    expect_given_up(BRACE_TAKEUP_E_TIME, &b, 0.0);
    b = sound_params().takeup;
    /* asked for more than the noise lets pass below the bound of torque */
    b.torque_max_n_mm = 2200.0f;
    b.preload_n_mm = 2200.0f;
    expect_given_up(BRACE_TAKEUP_E_TORQUE, &b, 1e5);
}

static void a_load_that_goes_away_ends_the_takeup(void)
{
    memset(&out, 0, sizeof out);
    take_up(1, 1e5, 4000);
    TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_HOLD, out.phase);
    stand(motor_rad, 0.0, 100);
    TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_E_LOST, out.takeup);
    TEST_ASSERT_FALSE(out.valid);

    setUp();
    memset(&out, 0, sizeof out);
    take_up(1, 1e5, 4000);
    const brace_backlash_sample_t sample = {.now_us = now_us += 1000u, .motor_rad = NAN};
    TEST_ASSERT_EQUAL_INT(BRACE_E_NOT_FINITE, brace_backlash_tick(&joint, &sample, &out));
    TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_E_FAULT, out.takeup);
    TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_LET_GO, out.phase);
}

static void what_a_joint_promises_is_reported(void)
{
    TEST_ASSERT_EQUAL_FLOAT(0.0f, brace_takeup_preload_min_n_mm(NULL));
    TEST_ASSERT_TRUE(brace_takeup_preload_min_n_mm(&joint) > 200.0f); /* more than friction */
    TEST_ASSERT_TRUE(brace_takeup_preload_min_n_mm(&joint) < 4500.0f);
    TEST_ASSERT_EQUAL(0, brace_backlash_detection_us(NULL));
}

static void an_expectation_that_is_none_is_a_bad_sample(void)
{
    brace_backlash_sample_t sample = {.now_us = now_us + 1000u, .load_is_expected = true, .expected_off_n_mm = -1.0f};
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_backlash_tick(&joint, &sample, &out));
    sample.expected_off_n_mm = (float)NAN;
    sample.now_us += 1000u;
    TEST_ASSERT_EQUAL_INT(BRACE_E_NOT_FINITE, brace_backlash_tick(&joint, &sample, &out));
}

static void a_takeup_that_has_not_begun_is_taken_back(void)
{
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_takeup_request(NULL, 1));
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_takeup_request(&joint, 0));
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_takeup_request(&joint, 1));
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_takeup_request(&joint, 1)); /* one at a time */
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_takeup_let_go(NULL));
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_takeup_let_go(&joint));
    stand(0.0, 0.0, 50);
    TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_IDLE, out.phase);
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_takeup_request(&joint, -1));
    stand(0.0, 0.0, 50);
    TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_APPROACH, out.phase);
}

static void parameters_out_of_range_are_refused(void)
{
    brace_backlash_t fresh, before;
    memset(&fresh, 0x5a, sizeof fresh);
    before = fresh;
    brace_backlash_params_t p = sound_params();
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_backlash_init(NULL, &p));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_backlash_init(&fresh, NULL));
    p.gap_rad = 0.0f;
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_backlash_init(&fresh, &p));
    p.gap_rad = NAN;
    TEST_ASSERT_EQUAL_INT(BRACE_E_NOT_FINITE, brace_backlash_init(&fresh, &p));
    p = sound_params();
    p.tick_us = 50;
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_backlash_init(&fresh, &p));
    p = sound_params();
    p.takeup.verify_us = 0;
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_backlash_init(&fresh, &p));
    static const uint32_t times_us[][3] = { /* tick, whole take-up, verifying; one of them beyond its range */
                                           {5001, 3000000, 100000},
                                           {1000, 0, 100000},
                                           {1000, 60000001, 100000},
                                           {1000, 3000000, 19999},
                                           {1000, 3000000, 10000001}};
    for (size_t i = 0; i < sizeof times_us / sizeof *times_us; i++) {
        p = sound_params();
        p.tick_us = times_us[i][0], p.takeup.time_max_us = times_us[i][1], p.takeup.verify_us = times_us[i][2];
        TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_backlash_init(&fresh, &p));
    }
    p = sound_params();
    p.takeup.reach_max_rad = 2.1f;
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_backlash_init(&fresh, &p));
    p = sound_params();
    p.takeup.torque_max_n_mm = 900.0f; /* could not be distinguished from friction and noise */
    TEST_ASSERT_EQUAL_INT(BRACE_E_PARAMETER, brace_backlash_init(&fresh, &p));
    TEST_ASSERT_EQUAL_INT(0, memcmp(&before, &fresh, sizeof fresh));
    const brace_backlash_sample_t sample = {.now_us = 1000};
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_backlash_tick(NULL, &sample, &out));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_backlash_tick(&joint, NULL, &out));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_backlash_tick(&joint, &sample, NULL));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_takeup_request(NULL, 1));
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_takeup_request(&joint, 0));
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_takeup_request(&joint, 1));
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_takeup_request(&joint, -1)); /* the first stands */
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_takeup_let_go(NULL));
    TEST_ASSERT_EQUAL_UINT32(0, brace_backlash_detection_us(NULL));
}

/* The tip where the corrected angles put it, by the kinematics themselves: linear to offset^2 times the reach. */
static void the_tip_shifts_by_gap_times_lever(void)
{
    const brace_limb_t *limb = &sample_limb[SAMPLE_PAPER];
    brace_pose_t at, shifted;
    brace_point_t shift;
    const float one = 0.004f, two = -0.003f;
    brace_kinematics_forward(limb, 1.0f, 1.4f, &at);
    brace_kinematics_forward(limb, 1.0f + one, 1.4f + two, &shifted);
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_backlash_tip_shift(&at, one, two, &shift));
    ASSERT_CLOSE((double)shifted.tip.x_mm - (double)at.tip.x_mm, shift.x_mm, 0.02);
    ASSERT_CLOSE((double)shifted.tip.z_mm - (double)at.tip.z_mm, shift.z_mm, 0.02);
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_backlash_tip_shift(NULL, one, two, &shift));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_backlash_tip_shift(&at, one, two, NULL));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NOT_FINITE, brace_backlash_tip_shift(&at, NAN, two, &shift));
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_backlash_tip_shift(&at, one, 0.6f, &shift));
}

/* A command stops at its reach, either way, whatever a tick's step would add. */
static void a_take_up_that_meets_nothing_ends_at_its_reach(void)
{
    for (int flank = -1; flank <= 1; flank += 2) {
        brace_backlash_params_t params = sound_params();
        params.takeup.reach_max_rad = 0.02f;
        params.takeup.rate_rad_per_s = 7.0f; /* 7 mrad in a tick: three steps pass the reach */
        params.torque_noise_n_mm = 0.0f;
        noise_n_mm = 0.0;
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_backlash_init(&joint, &params));
        stand(0.0, 0.0, 5);
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_takeup_request(&joint, flank));
        float furthest_rad = 0.0f;
        for (int i = 0; i < 20; i++) {
            tick(0.0, 0.0);
            furthest_rad = fabsf(out.command_rad) > furthest_rad ? fabsf(out.command_rad) : furthest_rad;
        }
        TEST_ASSERT_EQUAL_FLOAT(0.02f, furthest_rad);
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_E_REACH, out.takeup);
        TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_IDLE, out.phase);
        TEST_ASSERT_EQUAL_FLOAT(0.0f, out.command_rad);
    }
}

/* A flank that is none, and a joint that is asked twice. */
static void what_is_no_take_up_is_refused(void)
{
    static const int none[] = {0, 2, -2};
    stand(0.0, 0.0, 5);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_NOT_EQUAL(BRACE_OK, brace_takeup_request(&joint, none[i]));
    }
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_takeup_request(&joint, 1));
    TEST_ASSERT_NOT_EQUAL(BRACE_OK, brace_takeup_request(&joint, 1));
    tick(0.0, 0.0);
    TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_APPROACH, out.phase);
    TEST_ASSERT_NOT_EQUAL(BRACE_OK, brace_takeup_request(&joint, -1));
}

/* The time in which a lost load shows is bounded whatever the noise and the tick. */
static void detection_takes_a_bounded_time(void)
{
    static const uint32_t tick_us[] = {100, 1000, 5000};
    static const float noise_n_mm_of[] = {0.0f, 40.0f, 400.0f};
    for (int i = 0; i < 3; i++) {
        uint32_t last_us = UINT32_MAX;
        for (int j = 0; j < 3; j++) { /* the more noise, the sooner a load drowns in it */
            brace_backlash_params_t params = sound_params();
            params.tick_us = tick_us[i];
            params.torque_noise_n_mm = noise_n_mm_of[j];
            TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_backlash_init(&joint, &params));
            const uint32_t detection_us = brace_backlash_detection_us(&joint);
            TEST_ASSERT_TRUE(detection_us <= last_us && detection_us >= 5000u && detection_us <= 120000u);
            /* 5 ms and the ticks until the fast filter has fallen from the full range to a thousandth and a sigma */
            const double gain = (double)tick_us[i] / (10000.0 + (double)tick_us[i]);
            const double quiet = (double)noise_n_mm_of[j] * sqrt(gain / (2.0 - gain)) + 8.0;
            const double count = ceil(log(quiet / 8000.0) / log(1.0 - gain));
            ASSERT_CLOSE(5000.0 + count * (double)tick_us[i], detection_us, 1.0 * (double)tick_us[i]);
            last_us = detection_us;
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_load_engages_its_flank_whatever_the_motion);
    RUN_TEST(nothing_is_decided_of_a_load_within_friction);
    RUN_TEST(a_lost_load_is_not_valid_past_the_detection_time);
    RUN_TEST(a_reversal_crosses_with_the_motors_travel);
    RUN_TEST(noise_alone_proves_nothing);
    RUN_TEST(a_load_reversal_of_a_standing_motor_is_seen);
    RUN_TEST(an_expected_load_decides_but_never_proves);
    RUN_TEST(bad_and_late_samples_are_a_fault_that_heals);
    RUN_TEST(a_takeup_preloads_verifies_and_lets_go);
    RUN_TEST(a_servo_that_lags_takes_up);
    RUN_TEST(a_flank_without_a_load_is_remembered_for_a_while);
    RUN_TEST(each_takeup_begins_anew);
    RUN_TEST(load_and_motor_stay_while_they_are_verified);
    RUN_TEST(each_parameter_has_its_bounds);
    RUN_TEST(every_bound_has_its_own_result);
    RUN_TEST(a_load_that_goes_away_ends_the_takeup);
    RUN_TEST(what_a_joint_promises_is_reported);
    RUN_TEST(an_expectation_that_is_none_is_a_bad_sample);
    RUN_TEST(a_takeup_that_has_not_begun_is_taken_back);
    RUN_TEST(parameters_out_of_range_are_refused);
    RUN_TEST(the_tip_shifts_by_gap_times_lever);
    RUN_TEST(a_take_up_that_meets_nothing_ends_at_its_reach);
    RUN_TEST(what_is_no_take_up_is_refused);
    RUN_TEST(detection_takes_a_bounded_time);
    return UNITY_END();
}
