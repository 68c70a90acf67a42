/* What a joint's motor shows about its load: filters, friction by the direction of motion, and an expected load. */
#include "backlash/backlash_load.h"

#include <math.h>

#include "brace/backlash.h"
#include "brace/ranges.h"
#include "close.h"
#include "noise.h"

enum { TICK_US = 1000 };
#define STEP_RAD 2e-5
#define FRICTION_N_MM 200.0
#define TOLERANCE 0.2
#define BIAS_N_MM 80.0
#define NOISE_N_MM 40.0

static brace_backlash_t joint;
static uint32_t now_us;

void setUp(void)
{
    const brace_backlash_params_t params = {.tick_us = TICK_US,
                                            .gap_rad = 0.01f,
                                            .friction_n_mm = (float)FRICTION_N_MM,
                                            .friction_tolerance_ratio = (float)TOLERANCE,
                                            .inertia_n_mm_s2_per_rad = 20.0f,
                                            .torque_range_n_mm = 8000.0f,
                                            .torque_noise_n_mm = (float)NOISE_N_MM,
                                            .torque_bias_n_mm = (float)BIAS_N_MM,
                                            .angle_step_rad = (float)STEP_RAD,
                                            .takeup = {.torque_max_n_mm = 4500.0f,
                                                       .preload_n_mm = 800.0f,
                                                       .travel_max_rad = 0.06f,
                                                       .reach_max_rad = 0.15f,
                                                       .rate_rad_per_s = 0.1f,
                                                       .time_max_us = 3000000,
                                                       .verify_us = 100000}};
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_backlash_init(&joint, &params));
    now_us = 0;
}

void tearDown(void) {}

static brace_backlash_sample_t sample_of(double motor_rad, double torque_n_mm)
{
    return (brace_backlash_sample_t){
        .now_us = now_us, .motor_rad = (float)motor_rad, .torque_n_mm = (float)torque_n_mm};
}

static void begin(double motor_rad, double torque_n_mm)
{
    const brace_backlash_sample_t sample = sample_of(motor_rad, torque_n_mm);
    backlash_load_start(&joint, &sample);
}

static void observe(double motor_rad, double torque_n_mm)
{
    now_us += TICK_US;
    const brace_backlash_sample_t sample = sample_of(motor_rad, torque_n_mm);
    backlash_load_observe(&joint, &sample);
}

/* The slow mean of a load that stays is as quiet as its gain says, and what is known of it narrows to that. A load that
 * changes starts it anew from the fast one. */
static void the_slow_mean_is_the_quiet_one(void)
{
    const double gain = 1.0 / 81.0, sigma = NOISE_N_MM * sqrt(gain / (2.0 - gain));
    double squares = 0.0;
    noise_state = 5u;
    begin(0.0, 1000.0);
    for (int i = 0; i < 4000; i++) {
        observe(0.0, 1000.0 + NOISE_N_MM * noise_normal());
        const double off = (double)joint.slow_n_mm - 1000.0;
        squares += i >= 1000 ? off * off / 3000.0 : 0.0;
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.4 * sigma, sigma, sqrt(squares)); /* of some forty independent ones */
    ASSERT_CLOSE(sigma, joint.slow_spread_n_mm, 1e-3 * sigma);
    for (int i = 0; i < 12; i++) {
        observe(0.0, 3000.0);
    }
    ASSERT_CLOSE(joint.fast_n_mm, joint.slow_n_mm, 4.0 * sigma);
    TEST_ASSERT_TRUE((double)joint.slow_spread_n_mm > 2.0 * sigma);
}

/* The slow mean that starts anew takes over all that the fast one knows: the load, its spread, and how far friction may
 * hide it. */
static void a_slow_mean_begins_anew_as_the_fast_one_stands(void)
{
    int times = 0, with_another_width = 0;
    double motor_rad = 0.0;
    begin(0.0, 1000.0);
    for (int i = 0; i < 600; i++) {
        const float before_n_mm = joint.slow_width_n_mm;
        motor_rad += i > 300 ? 1e-4 : 0.0;
        observe(motor_rad, i < 320 ? 1000.0 : 3000.0); /* the motor turns, and a load comes */
        if (joint.slow_spread_n_mm == joint.fast_sigma_n_mm) {
            ASSERT_CLOSE(joint.fast_n_mm, joint.slow_n_mm, 0.0);
            ASSERT_CLOSE(joint.fast_width_n_mm, joint.slow_width_n_mm, 0.0);
            times++;
            with_another_width += fabsf(joint.slow_width_n_mm - before_n_mm) > 20.0f;
        }
    }
    TEST_ASSERT_TRUE(times >= 2 && with_another_width >= 2);
}

/* What has not been seen to move has no direction, whatever was there before. */
static void a_start_has_no_direction(void)
{
    for (int way = -1; way <= 1; way += 2) {
        begin(0.0, 0.0);
        for (int i = 1; i < 40; i++) {
            observe(way * 0.001 * i, 0.0);
        }
        TEST_ASSERT_EQUAL_INT(way, joint.direction);
        begin(0.0, 0.0);
        TEST_ASSERT_EQUAL_INT(0, joint.direction);
    }
}

static double proof_n_mm(void) /* six sigmas of the fast mean, and the bias */
{
    const double gain = 1.0 / 11.0;
    return 6.0 * NOISE_N_MM * sqrt(gain / (2.0 - gain)) + BIAS_N_MM;
}

static void a_first_sample_is_the_load_and_proves_nothing(void)
{
    joint.speed_rad_per_s = 2.0f; /* of before; nobody knows how fast the motor is now */
    begin(0.3, 1500.0);
    ASSERT_CLOSE(0.0, joint.speed_rad_per_s, 0.0);
    ASSERT_CLOSE(1500.0, joint.fast_n_mm, 0.0);
    ASSERT_CLOSE(1500.0, joint.slow_n_mm, 0.0);
    ASSERT_CLOSE(1500.0, joint.torque_n_mm, 0.0);
    TEST_ASSERT_TRUE(backlash_load_off_n_mm(&joint) > 8000.0f); /* as wide as any torque */
    TEST_ASSERT_EQUAL_UINT32(0, joint.positive_us);
    TEST_ASSERT_EQUAL_UINT32(0, joint.negative_us);
    TEST_ASSERT_EQUAL_INT(0, backlash_load_proven(&joint));
    const brace_backlash_sample_t sample = sample_of(0.3, 1500.0);
    TEST_ASSERT_EQUAL_INT(0, backlash_load_decided(&joint, &sample, 0.7f));
    observe(0.3, 1500.0);
    TEST_ASSERT_TRUE(backlash_load_standing(&joint)); /* it has not been seen to move */
}

/* Of a motor that stands friction may have either sign; of one that turns it is known but for its tolerance. */
static void friction_is_known_while_the_motor_turns(void)
{
    for (int way = -1; way <= 1; way += 2) {
        setUp();
        begin(0.0, 1000.0);
        for (int i = 0; i < 400; i++) {
            observe(0.0, 1000.0);
        }
        ASSERT_CLOSE(1000.0, joint.fast_n_mm, 0.01);
        ASSERT_CLOSE(FRICTION_N_MM * (1.0 + TOLERANCE) + proof_n_mm(), backlash_load_off_n_mm(&joint), 0.5);
        for (int i = 1; i <= 400; i++) {
            observe(way * 1e-4 * i, 1000.0 + way * FRICTION_N_MM);
        }
        TEST_ASSERT_FALSE(backlash_load_standing(&joint));
        ASSERT_CLOSE(1000.0, joint.fast_n_mm, 1.0);
        ASSERT_CLOSE(1000.0, joint.slow_n_mm, 3.0);
        ASSERT_CLOSE(FRICTION_N_MM * TOLERANCE + proof_n_mm(), backlash_load_off_n_mm(&joint), 1.0);
    }
}

/* It counts as standing when it has not advanced for more than 8 ms, to the tick. */
static void a_motor_stands_after_eight_ticks(void)
{
    begin(0.0, 0.0);
    for (int i = 1; i <= 30; i++) {
        observe(1e-4 * i, FRICTION_N_MM);
    }
    for (int i = 1; i <= 8; i++) {
        observe(1e-4 * 30, FRICTION_N_MM);
        TEST_ASSERT_FALSE(backlash_load_standing(&joint));
    }
    observe(1e-4 * 30, FRICTION_N_MM);
    TEST_ASSERT_TRUE(backlash_load_standing(&joint));
}

/* The width that the fast mean goes to in a tick: its gain is one eleventh. */
static double width_of_tick(double motor_rad)
{
    const double before = (double)joint.fast_width_n_mm;
    observe(motor_rad, 0.0);
    return before + 11.0 * ((double)joint.fast_width_n_mm - before);
}

/* A motor that begins, or that turns round, has friction of either sign until it has gone one way for 6 ms. One that
 * steps less than its hysteresis has not moved. */
static void a_direction_is_sure_after_six_ticks(void)
{
    const double unsure = FRICTION_N_MM * (1.0 + TOLERANCE), sure = FRICTION_N_MM * TOLERANCE;
    joint.params.inertia_n_mm_s2_per_rad = 0.0f;
    begin(0.0, 0.0);
    for (int i = 0; i < 400; i++) {
        observe(0.0, 0.0);
    }
    double motor_rad = 0.0;
    for (int turn = 0; turn < 4; turn++) {
        for (int i = 1; i <= 20; i++) {
            motor_rad += turn % 2 == 0 ? 1e-4 : -1e-4;
            ASSERT_CLOSE(i <= 6 ? unsure : sure, width_of_tick(motor_rad), 1.0);
        }
    }
    for (int i = 0; i < 9; i++) {
        (void)width_of_tick(motor_rad);
    }
    for (int i = 0; i < 50; i++) {
        ASSERT_CLOSE(unsure, width_of_tick(motor_rad + (i % 2) * 1.4 * STEP_RAD), 1.0);
        TEST_ASSERT_TRUE(backlash_load_standing(&joint));
    }
    for (int i = 0; i < 50; i++) { /* nor has one that goes on by less than half a step: rounding alone may look so */
        ASSERT_CLOSE(unsure, width_of_tick(motor_rad - (i % 2) * 0.3 * STEP_RAD), 1.0);
        TEST_ASSERT_TRUE(backlash_load_standing(&joint));
    }
    for (int i = 1; i <= 20; i++) { /* once it has stood, the same way has to be shown anew */
        motor_rad -= 1e-4;
        ASSERT_CLOSE(i <= 6 ? unsure : sure, width_of_tick(motor_rad), 1.0);
    }
}

/* The fast interval has to be clear of zero for 12 ms. */
static void a_proof_takes_twelve_ticks(void)
{
    for (int flank = -1; flank <= 1; flank += 2) {
        setUp();
        begin(0.0, flank * 4000.0);
        int clear = 0;
        for (int i = 0; i < 400 && backlash_load_proven(&joint) == 0; i++) {
            observe(0.0, flank * 4000.0);
            clear += fabsf(joint.fast_n_mm) > backlash_load_off_n_mm(&joint);
        }
        TEST_ASSERT_EQUAL_INT(flank, backlash_load_proven(&joint));
        TEST_ASSERT_EQUAL_INT(12, clear);
        for (int i = 0; i < 400 && backlash_load_proven(&joint) != 0; i++) {
            observe(0.0, 0.0);
        }
        TEST_ASSERT_EQUAL_INT(0, backlash_load_proven(&joint));
    }
}

/* What the joint should carry narrows what the motor shows, from either side; where both exclude one another, the motor
 * is believed. */
static void an_expected_load_narrows_what_is_shown(void)
{
    begin(0.0, 0.0);
    for (int i = 0; i < 600; i++) {
        observe(0.0, 100.0); /* within friction: shows nothing */
    }
    static const struct {
        float expected_n_mm, off_n_mm;
        int flank;
    } row[] = {{150.0f, 100.0f, 1},    {-150.0f, 100.0f, -1}, {0.0f, 100.0f, 0},    {90.0f, 100.0f, 0},
               {-90.0f, 100.0f, 0},    {1e4f, 10.0f, 0},      {-1e4f, 10.0f, 0},    {100.05f, 100.0f, 1},
               {-100.05f, 100.0f, -1}, {99.95f, 100.0f, 0},   {-99.95f, 100.0f, 0}, {100.0f, 100.0f, 0},
               {-100.0f, 100.0f, 0}}; /* a load that may be zero shows no flank */
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        brace_backlash_sample_t sample = sample_of(0.0, 100.0);
        TEST_ASSERT_EQUAL_INT(0, backlash_load_decided(&joint, &sample, 0.7f));
        sample.load_is_expected = true;
        sample.expected_n_mm = row[i].expected_n_mm;
        sample.expected_off_n_mm = row[i].off_n_mm;
        TEST_ASSERT_EQUAL_INT(row[i].flank, backlash_load_decided(&joint, &sample, 0.7f));
    }
}

/* A motor that accelerates carries its own inertia: the load behind it stays the same. */
static void inertia_is_taken_off(void)
{
    begin(0.0, 1000.0);
    double motor_rad = 0.0, speed_rad_per_s = 0.0;
    for (int i = 0; i < 300; i++) {
        speed_rad_per_s += 1e-3 * 5.0; /* 5 rad/s2: 100 N mm */
        motor_rad += 1e-3 * speed_rad_per_s;
        observe(motor_rad, 1000.0 + FRICTION_N_MM + 20.0 * 5.0);
    }
    ASSERT_CLOSE(1000.0, joint.fast_n_mm, 3.0);
    ASSERT_CLOSE(1000.0 + FRICTION_N_MM + 100.0, joint.torque_n_mm, 1.0);
}

/* A motor that moves on in the same direction within 8 ms has not turned round in between. A motor that stood longer
 * may have. */
static void a_short_stop_leaves_the_direction_sure(void)
{
    const double unsure = FRICTION_N_MM * (1.0 + TOLERANCE), sure = FRICTION_N_MM * TOLERANCE;
    for (int stops = 7; stops <= 8; stops++) {
        setUp();
        joint.params.inertia_n_mm_s2_per_rad = 0.0f;
        begin(0.0, 0.0);
        for (int i = 1; i <= 30; i++) {
            observe(1e-4 * i, 0.0);
        }
        for (int i = 0; i < stops; i++) {
            observe(1e-4 * 30, 0.0);
        }
        ASSERT_CLOSE(stops == 7 ? sure : unsure, width_of_tick(1e-4 * 31), 0.5);
    }
}

/* The link is at most half the gap away from the motor. Wherever in the gap the link began, it stands between a link
 * that began at the one end and a link that began at the other. */
static void where_the_link_may_be_in_its_gap(void)
{
    const double half = 0.005;
    ASSERT_CLOSE(-half, joint.play_low_rad, 1e-9); /* before anything is seen, anywhere */
    ASSERT_CLOSE(half, joint.play_high_rad, 1e-9);
    double low = -half, high = half, motor_rad = 0.3;
    begin(motor_rad, 0.0);
    joint.play_low_rad = (float)low, joint.play_high_rad = (float)high;
    for (int i = 0; i < 400; i++) {
        const double to_rad = 0.3 + 0.004 * sin(0.05 * i) + (i > 200 ? 0.009 * sin(0.11 * i) : 0.0);
        low = fmax(-half, fmin(half, low + to_rad - motor_rad));
        high = fmax(-half, fmin(half, high + to_rad - motor_rad));
        motor_rad = to_rad;
        observe(motor_rad, 0.0);
        ASSERT_CLOSE(low, joint.play_low_rad, 1e-5);
        ASSERT_CLOSE(high, joint.play_high_rad, 1e-5);
    }
    TEST_ASSERT_TRUE(high - low < 1e-6); /* after a motion through the whole gap the place is certain */
}

/* A take-up must reach the least preload and overcome friction with less than its greatest torque. The least preload is
 * the sum of the worst friction, the bias, and the error that noise may cause in the fast mean. */
static void a_takeup_needs_more_torque_than_friction_hides(void)
{
    brace_backlash_params_t params = joint.params;
    const double least = (double)joint.least_preload_n_mm, friction = FRICTION_N_MM * (1.0 + TOLERANCE) + BIAS_N_MM;
    TEST_ASSERT_TRUE(least > friction);
    params.takeup.preload_n_mm = 0.0f;
    params.takeup.torque_max_n_mm = (float)(least + FRICTION_N_MM + 0.1);
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_backlash_init(&joint, &params));
    const brace_backlash_t before = joint;
    params.takeup.torque_max_n_mm = (float)(least + FRICTION_N_MM - 0.1);
    TEST_ASSERT_EQUAL_INT(BRACE_E_PARAMETER, brace_backlash_init(&joint, &params));
    TEST_ASSERT_EQUAL_MEMORY(&before, &joint, sizeof joint);
}

/* Each time and each size is tried at its least and its most, and just beyond both. */
static void every_parameter_has_its_bounds(void)
{
    const brace_backlash_params_t sound = joint.params;
    brace_backlash_params_t p;
    const struct {
        uint32_t *time_us, least, most;
    } times[] = {
        {&p.tick_us, 100u, 5000u}, {&p.takeup.time_max_us, 1u, 60000000u}, {&p.takeup.verify_us, 20000u, 10000000u}};
    for (int i = 0; i < 3; i++) {
        const uint32_t values[4] = {times[i].least, times[i].most, times[i].least - 1u, times[i].most + 1u};
        for (int v = 0; v < 4; v++) {
            p = sound;
            *times[i].time_us = values[v];
            TEST_ASSERT_EQUAL_INT(v < 2 ? BRACE_OK : BRACE_E_RANGE, brace_backlash_init(&joint, &p));
        }
    }
    const struct {
        float *value, least, most;
    } sizes[] = {{&p.gap_rad, 1e-5f, BRACE_RANGE_JOINT_GAP_RAD_MAX},
                 {&p.takeup.travel_max_rad, 1e-6f, 1.0f},
                 {&p.takeup.reach_max_rad, 1e-6f, 2.0f},
                 {&p.takeup.rate_rad_per_s, 1e-6f, 10.0f},
                 {&p.takeup.preload_n_mm, 0.0f, sound.takeup.torque_max_n_mm},
                 {&p.takeup.torque_max_n_mm, sound.takeup.torque_max_n_mm, sound.torque_range_n_mm}};
    for (int i = 0; i < 6; i++) {
        for (int v = 0; v < 5; v++) {
            const float values[5] = {sizes[i].least, sizes[i].most, nextafterf(sizes[i].least, -1.0f),
                                     nextafterf(sizes[i].most, 1e9f), NAN};
            p = sound;
            *sizes[i].value = values[v];
            const brace_status_t status = brace_backlash_init(&joint, &p);
            if (v == 4) {
                TEST_ASSERT_EQUAL_INT(BRACE_E_NOT_FINITE, status);
            } else if (v == 3 || (v == 2 && i < 5)) {
                TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, status);
            } else if (i < 4) {
                TEST_ASSERT_EQUAL_INT(BRACE_OK, status);
            } else {
                TEST_ASSERT_NOT_EQUAL(BRACE_E_RANGE, status); /* a combination that cannot work has another status */
            }
        }
    }
}

static brace_backlash_out_t tick_at(double motor_rad, double torque_n_mm)
{
    brace_backlash_out_t out;
    now_us += TICK_US;
    const brace_backlash_sample_t sample = sample_of(motor_rad, torque_n_mm);
    (void)brace_backlash_tick(&joint, &sample, &out);
    return out;
}

/* Ticks until a take-up of a motor that meets nothing is given up for its time. */
static int ticks_of_takeup(uint32_t time_max_us)
{
    int count = 0;
    setUp();
    joint.params.takeup.time_max_us = time_max_us;
    (void)tick_at(0.0, 0.0);
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_takeup_request(&joint, 1));
    while (tick_at(0.0, 0.0).takeup == BRACE_TAKEUP_RUNNING) {
        count++;
    }
    TEST_ASSERT_EQUAL_INT(BRACE_TAKEUP_E_TIME, tick_at(0.0, 0.0).takeup);
    return count;
}

static void a_takeup_has_its_time_to_the_microsecond(void)
{
    const int count = ticks_of_takeup(50u * TICK_US);
    TEST_ASSERT_EQUAL_INT(count, ticks_of_takeup(49u * TICK_US + 1u));
    TEST_ASSERT_EQUAL_INT(count + 1, ticks_of_takeup(50u * TICK_US + 1u));
    TEST_ASSERT_INT_WITHIN(1, 50, count);
}

/* The link's place in its gap stays known in every state but FAULT. After FAULT the link may be anywhere. */
static void only_a_fault_forgets_where_the_link_is(void)
{
    int states = 0, last = -1;
    double motor_rad = 0.3;
    for (int i = 0; i < 600; i++) {
        motor_rad += i < 200 ? 1e-4 : 0.0;
        const brace_backlash_out_t out = tick_at(motor_rad, i < 400 ? 2500.0 : 2500.0 - 12.0 * (i - 400));
        TEST_ASSERT_NOT_EQUAL(BRACE_BACKLASH_FAULT, out.state);
        ASSERT_CLOSE(-0.5 * (double)(joint.play_high_rad + joint.play_low_rad), out.offset_rad, 1e-8);
        ASSERT_CLOSE(0.5 * (double)(joint.play_high_rad - joint.play_low_rad), out.offset_off_rad, 1e-8);
        states += (int)out.state != last ? 1 : 0;
        last = (int)out.state;
        if (i > 110) { /* the motor has gone through the gap of 10 mrad, so the link lies at its end */
            ASSERT_CLOSE(0.005, joint.play_low_rad, 1e-5);
            ASSERT_CLOSE(0.005, joint.play_high_rad, 1e-5);
        }
    }
    TEST_ASSERT_TRUE(states >= 2);
    for (int i = 0; i < 50; i++) {
        last = (int)tick_at(NAN, 2500.0).state;
    }
    TEST_ASSERT_EQUAL(BRACE_BACKLASH_FAULT, last);
    ASSERT_CLOSE(-0.005, joint.play_low_rad, 1e-6);
    ASSERT_CLOSE(0.005, joint.play_high_rad, 1e-6);
}

/* The machine takes the motor's inertial torque off, and allows for a quarter of it being wrong. */
static void acceleration_widens_the_doubt(void)
{
    const double accel = 40.0, inertial = 20.0 * accel, dt = 1e-3; /* N mm: 20 N mm s2/rad */
    double motor_rad = 0.0, speed = 0.0;
    begin(0.0, inertial + 1000.0 + FRICTION_N_MM);
    for (int i = 0; i < 600; i++) {
        speed += accel * dt;
        motor_rad += speed * dt;
        observe(motor_rad, inertial + 1000.0 + FRICTION_N_MM);
    }
    ASSERT_CLOSE(1000.0, joint.fast_n_mm, 0.02 * inertial);
    ASSERT_CLOSE(FRICTION_N_MM * TOLERANCE + 0.25 * inertial, joint.fast_width_n_mm, 0.02 * inertial);
    const double steady = motor_rad;
    for (int i = 0; i < 600; i++) {
        motor_rad += speed * dt;
        observe(motor_rad, 1000.0 + FRICTION_N_MM);
    }
    TEST_ASSERT_TRUE(motor_rad > steady);
    ASSERT_CLOSE(1000.0, joint.fast_n_mm, 5.0);
    ASSERT_CLOSE(FRICTION_N_MM * TOLERANCE, joint.fast_width_n_mm, 2.0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_first_sample_is_the_load_and_proves_nothing);
    RUN_TEST(the_slow_mean_is_the_quiet_one);
    RUN_TEST(a_slow_mean_begins_anew_as_the_fast_one_stands);
    RUN_TEST(a_start_has_no_direction);
    RUN_TEST(friction_is_known_while_the_motor_turns);
    RUN_TEST(a_motor_stands_after_eight_ticks);
    RUN_TEST(a_direction_is_sure_after_six_ticks);
    RUN_TEST(a_proof_takes_twelve_ticks);
    RUN_TEST(an_expected_load_narrows_what_is_shown);
    RUN_TEST(inertia_is_taken_off);
    RUN_TEST(a_short_stop_leaves_the_direction_sure);
    RUN_TEST(where_the_link_may_be_in_its_gap);
    RUN_TEST(a_takeup_needs_more_torque_than_friction_hides);
    RUN_TEST(every_parameter_has_its_bounds);
    RUN_TEST(a_takeup_has_its_time_to_the_microsecond);
    RUN_TEST(only_a_fault_forgets_where_the_link_is);
    RUN_TEST(acceleration_widens_the_doubt);
    return UNITY_END();
}
