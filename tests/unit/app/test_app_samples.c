/* What joints and sensor say: absent, old, absurd, stuck; when K is valid of it. */
#include "app_bench.h"

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    bench_start(&p);
}

void tearDown(void) {}

/* -------------------------------------------------------------------------------------------- samples -- */

static void test_a_short_gap_in_the_samples_keeps_the_last_K(void)
{
    ticks(5);
    TEST_ASSERT_TRUE(brace_fake_fail_next(&fake, BRACE_FAKE_JOINT_READ, 3 * 15, BRACE_HAL_E_DEVICE));
    ticks(15);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_EQUAL(15000, fake.now_us - now()->taken_us);
    TEST_ASSERT_EQUAL(30, counters().samples_bad);
}

static void test_samples_too_old_are_stale_and_a_fault_until_they_have_been_back_for_a_while(void)
{
    ticks(5);
    fake.joint[BRACE_FEMUR].not_newer = true;
    ticks(20);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    ticks(1);
    TEST_ASSERT_FALSE(now()->k_is_valid);
    TEST_ASSERT_BITS(BRACE_FLAG_STALE, BRACE_FLAG_STALE, engaged_flags());
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, now()->mode);
    TEST_ASSERT_EQUAL(BRACE_FAULT_SENSOR_FEMUR, now()->faults);
    fake.joint[BRACE_FEMUR].not_newer = false;
    ticks(99);
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, now()->mode);
    TEST_ASSERT_FALSE(now()->k_is_valid);
    ticks(2);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_EQUAL(0, now()->faults);
}

static void test_a_sample_that_never_ages_in_name_is_not_believed(void)
{
    ticks(5);
    fake.joint[BRACE_TIBIA].keeps_taken_us = true; /* answers OK with an old time stamp */
    ticks(30);
    TEST_ASSERT_EQUAL(BRACE_FAULT_SENSOR_TIBIA, now()->faults);
    for (int i = 0; i < 3; i++) { /* nor after the clock has gone round */
        fake.now_us += 0x55000000u;
        ticks(150);
        TEST_ASSERT_BITS(BRACE_FAULT_SENSOR_TIBIA, BRACE_FAULT_SENSOR_TIBIA, now()->faults);
        TEST_ASSERT_FALSE(now()->k_is_valid);
    }
}

/* A board's tick takes its time before it reads the joints: their samples are a few us younger than the tick. */
static void test_a_sample_taken_within_the_tick_is_not_stale(void)
{
    for (int joint = BRACE_FEMUR; joint <= BRACE_TIBIA; joint++) {
        fake.joint[joint].keeps_taken_us = true;
    }
    for (int i = 0; i < 50; i++) {
        fake.joint[BRACE_FEMUR].sample.taken_us = fake.joint[BRACE_TIBIA].sample.taken_us = fake.now_us + TICK_US + 20u;
        ticks(1);
    }
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_BITS(BRACE_FLAG_STALE, 0, now()->stiffness.now.flags);
}

static void test_a_snapshot_is_as_old_as_its_older_sample_across_the_clock_s_wrap(void)
{
    fake.now_us = 0xffffff00u - 5u * TICK_US;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    for (int joint = BRACE_FEMUR; joint <= BRACE_TIBIA; joint++) {
        fake.now_us = 0xffffff00u - 5u * TICK_US;
        ticks(5);
        fake.joint[joint].not_newer = true;
        ticks(1);
        TEST_ASSERT_EQUAL_HEX32(0xffffff00u, now()->taken_us);
        TEST_ASSERT_TRUE(now()->k_is_valid);
        fake.joint[joint].not_newer = false;
    }
}

static void test_play_that_no_load_can_show_is_always_open(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_FEMUR].gap_rad = 0.005f;
    p.drive[BRACE_FEMUR].takeup_torque_n_mm = 30.0f; /* less than friction and noise hide */
    bench_start(&p);
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = 5000.0f;
    ticks(500);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_FALSE(now()->play[BRACE_FEMUR].valid);
    TEST_ASSERT_BITS(BRACE_FLAG_GAP_OPEN, BRACE_FLAG_GAP_OPEN, now()->stiffness.now.flags);
    TEST_ASSERT_TRUE(now()->stiffness.now.lambda_max_n_per_mm < now()->stiffness.engaged.lambda_max_n_per_mm);
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_app_take_up(&app, BRACE_FEMUR, 1));
}

static void test_absurd_samples_are_never_used(void)
{
    static const float absurd[] = {(float)NAN, (float)INFINITY, -(float)INFINITY, 1e6f, -3e38f};
    for (size_t i = 0; i < sizeof absurd / sizeof *absurd; i++) {
        setUp();
        ticks(5);
        fake.joint[BRACE_FEMUR].sample.motor_rad = absurd[i];
        ticks(1);
        TEST_ASSERT_TRUE(now()->k_is_valid);
        ASSERT_CLOSE(1.0, now()->theta_rad[BRACE_FEMUR], 1e-6);
        ticks(25);
        TEST_ASSERT_EQUAL(BRACE_FAULT_SENSOR_FEMUR, now()->faults);
        fake.joint[BRACE_FEMUR].sample.motor_rad = 0.9f;
        fake.joint[BRACE_FEMUR].sample.torque_n_mm = absurd[i];
        ticks(5);
        TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, now()->mode);
    }
}

/* No joint turns by 90 degrees in a millisecond: K stays that of the sample before. Where the next sample agrees, the
 * encoder has jumped: no K until somebody has looked at the joint and cleared the fault. */
static void test_one_wild_angle_changes_nothing(void)
{
    ticks(5);
    const float k_n_per_mm = now()->stiffness.now.k_xx_n_per_mm;
    const float wild_rad[] = {1.0f + 1.57f, 1.0f - 1.57f, 1.0f + 0.08f};
    for (size_t i = 0; i < sizeof wild_rad / sizeof *wild_rad; i++) {
        const uint32_t bad = counters().samples_bad;
        fake.joint[BRACE_FEMUR].sample.motor_rad = wild_rad[i];
        ticks(1);
        TEST_ASSERT_EQUAL_FLOAT(k_n_per_mm, now()->stiffness.now.k_xx_n_per_mm);
        TEST_ASSERT_EQUAL(bad + 1, counters().samples_bad);
        fake.joint[BRACE_FEMUR].sample.motor_rad = 1.0f;
        ticks(1);
        TEST_ASSERT_EQUAL_FLOAT(k_n_per_mm, now()->stiffness.now.k_xx_n_per_mm);
        TEST_ASSERT_EQUAL(bad + 1, counters().samples_bad);
    }
    fake.joint[BRACE_FEMUR].sample.motor_rad = 0.4f;
    for (int i = 1; i < 1000; i++) {
        ticks(1);
        TEST_ASSERT_TRUE(i < 2 ? now()->stiffness.now.k_xx_n_per_mm == k_n_per_mm : !now()->k_is_valid);
        TEST_ASSERT_EQUAL_HEX32(i < 2 ? 0u : BRACE_FAULT_JUMP_FEMUR, now()->faults);
    }
    ASSERT_CLOSE(0.4, now()->theta_rad[BRACE_FEMUR], 1e-6); /* where the encoder says, for whoever looks */
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, now()->mode);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_clear(&app, BRACE_FAULT_JUMP_FEMUR));
    ticks(2);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    TEST_ASSERT_TRUE(now()->k_is_valid && now()->faults == 0u);
}

/* Each joint of a limb in space has its fault, its clearing, and no K while it stands. */
static void test_each_joint_that_jumps_is_named(void)
{
    static const uint32_t fault[] = {[BRACE_COXA] = BRACE_FAULT_JUMP_COXA,
                                     [BRACE_FEMUR] = BRACE_FAULT_JUMP_FEMUR,
                                     [BRACE_TIBIA] = BRACE_FAULT_JUMP_TIBIA};
    fake.joint[BRACE_COXA].absent = false;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(300);
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        fake.joint[i].sample.motor_rad += 0.3f;
        ticks(3);
        TEST_ASSERT_EQUAL_HEX32(fault[i], now()->faults);
        TEST_ASSERT_FALSE(now()->k_is_valid || now()->space.is_valid);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_clear(&app, fault[(i + 1) % BRACE_LINK_COUNT]));
        ticks(3);
        TEST_ASSERT_EQUAL_HEX32(fault[i], now()->faults);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_clear(&app, fault[i]));
        ticks(3);
        TEST_ASSERT_EQUAL_HEX32(0, now()->faults);
        TEST_ASSERT_TRUE(now()->k_is_valid && now()->space.is_valid);
    }
}

/* A link's encoder that leaves the motor's: flagged in the tick, a fault when it lasts. */
static void test_a_link_that_contradicts_its_motor_is_flagged_at_once(void)
{
    for (int joint = BRACE_FEMUR; joint <= BRACE_TIBIA; joint++) {
        setUp();
        fake.joint[joint].sample.link_rad = fake.joint[joint].sample.motor_rad;
        ticks(5);
        TEST_ASSERT_TRUE(now()->k_is_valid && engaged_flags() == 0u);
        fake.joint[joint].sample.link_rad += 0.05f;
        for (int i = 1; i <= 60; i++) {
            ticks(1);
            TEST_ASSERT_BITS_HIGH(i < 50 ? BRACE_FLAG_OUT_OF_RANGE : BRACE_FLAG_STALE, engaged_flags());
            TEST_ASSERT_EQUAL(i < 50, now()->k_is_valid);
        }
        TEST_ASSERT_EQUAL_HEX32(joint == BRACE_FEMUR ? BRACE_FAULT_JUMP_FEMUR : BRACE_FAULT_JUMP_TIBIA, now()->faults);
    }
}

/* Springs that follow a temperature which nobody measures are not known. */
static void test_springs_of_an_unknown_temperature_are_flagged(void)
{
    static const float degc[] = {22.0f, (float)NAN, 151.0f, -61.0f, (float)INFINITY, 150.0f};
    for (int follows = 0; follows < 2; follows++) {
        brace_parameters_t p = bench_parameters();
        p.slow.joint_compliance_per_degc = follows != 0 ? 0.001f : 0.0f;
        bench_start(&p);
        for (uint32_t i = 0; i < sizeof degc / sizeof *degc; i++) {
            fake.joint[BRACE_FEMUR].sample.temp_degc = fake.joint[BRACE_TIBIA].sample.temp_degc = degc[i];
            ticks(2);
            TEST_ASSERT_TRUE(now()->k_is_valid);
            const bool known = i == 0u || i == 5u;
            TEST_ASSERT_EQUAL_HEX32(known || follows == 0 ? 0u : BRACE_FLAG_OUT_OF_RANGE,
                                    engaged_flags() & BRACE_FLAG_OUT_OF_RANGE);
        }
    }
}

static void test_the_fastest_joint_is_followed(void)
{
    ticks(5);
    for (int i = 0; i < 12; i++) {
        fake.joint[BRACE_FEMUR].sample.motor_rad -= 0.045f; /* 45 rad/s */
        ticks(1);
        ASSERT_CLOSE(fake.joint[BRACE_FEMUR].sample.motor_rad, now()->theta_rad[BRACE_FEMUR], 1e-6);
    }
}

static void test_every_tick_without_sound_joints_is_invalid(void)
{
    ticks(5);
    fake.joint[BRACE_FEMUR].not_newer = true;
    for (int i = 0; i < 300; i++) {
        fake.joint[BRACE_FEMUR].not_newer = (i / 60) % 2 == 0;
        ticks(1);
        const bool old = (int32_t)(fake.now_us - now()->taken_us) > 20000;
        TEST_ASSERT_FALSE(old && now()->k_is_valid);
    }
}

static void test_coxa_is_reported_and_not_needed(void)
{
    fake.joint[BRACE_COXA].absent = false;
    fake.joint[BRACE_COXA].sample.motor_rad = 0.25f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(5);
    ASSERT_CLOSE(0.25, now()->theta_rad[BRACE_COXA], 1e-6);
    TEST_ASSERT_TRUE(now()->space.is_fitted);
    fake.joint[BRACE_COXA].not_newer = true;
    ticks(100);
    TEST_ASSERT_BITS_HIGH(BRACE_FAULT_SENSOR_COXA, now()->faults);
    TEST_ASSERT_FALSE(now()->space.is_valid);
    TEST_ASSERT_TRUE(now()->k_is_valid);
}

static void test_a_posture_beyond_the_travel_is_out_of_range(void)
{
    ticks(5);
    for (int i = 0; i < 34; i++) {
        fake.joint[BRACE_TIBIA].sample.motor_rad += 0.05f;
        ticks(1);
    }
    ASSERT_CLOSE(3.1, now()->theta_rad[BRACE_TIBIA], 1e-5);
    TEST_ASSERT_FALSE(now()->k_is_valid);
    TEST_ASSERT_BITS(BRACE_FLAG_OUT_OF_RANGE, BRACE_FLAG_OUT_OF_RANGE, engaged_flags());
    for (int i = 0; i < 4; i++) {
        fake.joint[BRACE_TIBIA].sample.motor_rad -= 0.05f;
        ticks(1);
    }
    TEST_ASSERT_TRUE(now()->k_is_valid);
}

static void test_zero_offsets_are_added(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_FEMUR].zero_offset_rad = 0.01f;
    p.limb.joint[BRACE_TIBIA].zero_offset_rad = -0.02f;
    bench_start(&p);
    ticks(2);
    ASSERT_CLOSE(1.01, now()->theta_rad[BRACE_FEMUR], 1e-6);
    ASSERT_CLOSE(1.38, now()->theta_rad[BRACE_TIBIA], 1e-6);
    ASSERT_CLOSE(1.0, now()->motor_rad[BRACE_FEMUR], 1e-6);
}

/* ---------------------------------------------------------------------------------------- the encoder -- */

/* A servo that gives way by its droop while its torque swings; with the encoder stuck only the torque moves. */
static void swing(bool stuck, int from, int count)
{
    for (int i = from; i < from + count; i++) {
        const float torque = 3000.0f * (float)(i % 400 < 200 ? i % 200 : 200 - i % 200) / 200.0f;
        fake.joint[BRACE_FEMUR].sample.torque_n_mm = torque;
        if (!stuck) {
            fake.joint[BRACE_FEMUR].sample.motor_rad = 1.0f - torque / 1e6f;
        }
        ticks(1);
    }
}

static void test_an_encoder_that_follows_its_torque_is_alive(void)
{
    swing(false, 0, 2000);
    TEST_ASSERT_EQUAL(0, now()->faults);
}

static void test_an_encoder_that_stands_while_the_torque_swings_is_stuck(void)
{
    swing(false, 0, 400);
    swing(true, 0, 600);
    TEST_ASSERT_EQUAL(BRACE_FAULT_ENCODER_STUCK, now()->faults);
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, now()->mode);
    TEST_ASSERT_FALSE(now()->k_is_valid);
    swing(false, 0, 120);
    TEST_ASSERT_EQUAL(0, now()->faults);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
}

static void test_a_stuck_encoder_is_found_in_drives_that_are_sampled_every_other_tick(void)
{
    for (int joint = BRACE_FEMUR; joint <= BRACE_TIBIA; joint++) {
        for (int phase = 0; phase < 2; phase++) { /* the samples come in the even ticks, or in the odd ones */
            setUp();
            for (int i = 0; i < 600; i++) {
                const float torque = 3000.0f * (float)(i % 400 < 200 ? i % 200 : 200 - i % 200) / 200.0f;
                fake.joint[joint].sample.torque_n_mm = torque;
                fake.joint[BRACE_FEMUR].not_newer = fake.joint[BRACE_TIBIA].not_newer = i % 2 == phase;
                ticks(1);
            }
            TEST_ASSERT_EQUAL(BRACE_FAULT_ENCODER_STUCK, now()->faults);
        }
    }
}

static void test_a_link_that_moves_away_from_a_standing_encoder_shows_it_too(void)
{
    fake.joint[BRACE_TIBIA].sample.link_rad = 1.4f;
    ticks(300);
    TEST_ASSERT_EQUAL(0, now()->faults);
    for (int i = 0; i < 100; i++) {
        fake.joint[BRACE_TIBIA].sample.link_rad = 1.4f + 0.0002f * (float)i;
        ticks(1);
    }
    TEST_ASSERT_EQUAL(BRACE_FAULT_ENCODER_STUCK, now()->faults);
}

static void test_a_limb_at_rest_is_not_stuck(void)
{
    ticks(3000);
    TEST_ASSERT_EQUAL(0, now()->faults);
}

/* --------------------------------------------------------------------------------- the motor's current -- */

static void longer_ticks(uint32_t tick_us, int count)
{
    for (int i = 0; i < count; i++) {
        fake.now_us += tick_us;
        brace_app_tick(&app, fake.now_us);
    }
}

/* Whenever it comes, the first sample of all included, and however long a tick is. */
static void test_one_wild_torque_while_the_limb_stands_blames_no_encoder(void)
{
    static const float times_range[] = {1.0f, 1.9f, 2.0f, 9.0f, 10.0f, 1e4f};
    static const uint32_t tick_us[] = {500, 1000, 5000};
    for (size_t i = 0; i < 3u * sizeof times_range / sizeof *times_range; i++) {
        brace_parameters_t p = bench_parameters();
        p.controller.tick_us = tick_us[i % 3u];
        /* a board plays each size, each moment and each length of a tick, hosts all of them together */
        for (int before = ON_BOARD ? (int)((i + i / 3u) % 3u) : 0; before < 6; before += ON_BOARD ? 3 : 1) {
            const int joint = before % 2 == 0 ? BRACE_FEMUR : BRACE_TIBIA;
            bench_start(&p);
            fake.joint[joint].sample.torque_n_mm = -3000.0f;
            longer_ticks(p.controller.tick_us, before < 4 ? before : 400 + before);
            fake.joint[joint].sample.torque_n_mm = times_range[i / 3u] * p.drive[joint].torque_range_n_mm;
            longer_ticks(p.controller.tick_us, 1);
            fake.joint[joint].sample.torque_n_mm = -3000.0f;
            longer_ticks(p.controller.tick_us, 1000);
            TEST_ASSERT_EQUAL(0, now()->faults);
            TEST_ASSERT_TRUE(now()->k_is_valid);
            ASSERT_CLOSE(-3000.0, now()->play[joint].load_n_mm, 1.0);
        }
    }
}

static void test_wild_torques_that_go_on_are_the_sensor_s(void)
{
    static const uint32_t named[] = {
        [BRACE_FEMUR] = BRACE_FAULT_SENSOR_FEMUR, [BRACE_TIBIA] = BRACE_FAULT_SENSOR_TIBIA};
    for (int joint = BRACE_FEMUR; joint <= BRACE_TIBIA; joint++) {
        setUp();
        ticks(50);
        for (int i = 0; i < 600; i++) {
            fake.joint[joint].sample.torque_n_mm = i / 7 % 2 == 0 ? 25000.0f : -1e5f;
            ticks(1);
            TEST_ASSERT_EQUAL(i < 20 ? 0u : named[joint], now()->faults);
        }
        fake.joint[joint].sample.torque_n_mm = 100.0f;
        ticks(600);
        TEST_ASSERT_EQUAL(0, now()->faults);
        TEST_ASSERT_TRUE(now()->k_is_valid);
    }
}

/* Every other one is wild, or all are, and never two in a row agree. */
static void test_a_torque_that_flickers_blames_no_encoder(void)
{
    static const float between_n_mm[][2] = {{9900.0f, 100.0f}, {9900.0f, -7000.0f}, {-9900.0f, 7000.0f}};
    for (size_t i = 0; i < sizeof between_n_mm / sizeof *between_n_mm; i++) {
        setUp();
        ticks(50);
        for (int j = 0; j < 1000; j++) {
            fake.joint[BRACE_FEMUR].sample.torque_n_mm = between_n_mm[i][j % 2];
            ticks(1);
            TEST_ASSERT_EQUAL(0, now()->faults);
        }
    }
}

/* ----------------------------------------------------------------------------------------- the sensor -- */

static void test_a_force_that_stays_the_last_one_is_not_known_for_long(void)
{
    ticks(5);
    fake.force_z_n = 3.0f;
    ticks(1);
    fake.force_not_newer = true;
    ticks(20);
    TEST_ASSERT_TRUE(now()->force_is_sensed);
    ASSERT_CLOSE(3.0, now()->force_z_n, 1e-5);
    ticks(1);
    TEST_ASSERT_FALSE(now()->force_is_sensed);
    fake.force_not_newer = false;
    ticks(1);
    TEST_ASSERT_TRUE(now()->force_is_sensed);
}

static void test_a_force_sensor_that_never_had_a_reading_reports_none(void)
{
    const brace_parameters_t p = bench_parameters();
    bench_board();
    bench_store(&p);
    fake.force_not_newer = true;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(2);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_FALSE(now()->force_is_sensed);
}

/* A drive whose clock is ahead would be young for as long as that. */
static void test_a_sample_from_the_future_does_not_stay_young(void)
{
    static const uint32_t ahead_us[] = {25000, 1000000, 0x40000000, 0x7fffff00};
    for (size_t i = 0; i < sizeof ahead_us / sizeof *ahead_us; i++) {
        setUp();
        ticks(5);
        fake.joint[BRACE_TIBIA].keeps_taken_us = true;
        fake.joint[BRACE_TIBIA].sample.taken_us = fake.now_us + ahead_us[i];
        ticks(1);
        fake.joint[BRACE_TIBIA].not_newer = true; /* and that was its last */
        ticks(2);
        TEST_ASSERT_FALSE(now()->k_is_valid);
        TEST_ASSERT_EQUAL(BRACE_FAULT_SENSOR_TIBIA, now()->faults);
        fake.joint[BRACE_TIBIA].keeps_taken_us = fake.joint[BRACE_TIBIA].not_newer = false;
        ticks(150);
        TEST_ASSERT_TRUE(now()->k_is_valid);
    }
    setUp();
    ticks(5);
    for (int i = 0; i < 50; i++) { /* taken after the tick began: that is in order */
        fake.joint[BRACE_TIBIA].keeps_taken_us = true;
        fake.joint[BRACE_TIBIA].sample.taken_us = fake.now_us + TICK_US + 300u;
        ticks(1);
        TEST_ASSERT_TRUE(now()->k_is_valid);
        TEST_ASSERT_EQUAL(0, now()->faults);
    }
}

/* One wild reading behind the gearbox says nothing of the encoder before it. */
static void test_an_absurd_link_angle_is_none(void)
{
    static const float absurd[] = {(float)INFINITY, -(float)INFINITY, 1e6f};
    for (size_t i = 0; i < sizeof absurd / sizeof *absurd; i++) {
        setUp();
        fake.joint[BRACE_TIBIA].sample.link_rad = 1.4f;
        ticks(300);
        fake.joint[BRACE_TIBIA].sample.link_rad = absurd[i];
        ticks(2);
        fake.joint[BRACE_TIBIA].sample.link_rad = 1.4f;
        ticks(300);
        TEST_ASSERT_EQUAL(0, now()->faults);
    }
}

/* A servo whose one encoder is behind its gear: NaN for the motor, and K all the same. */
static void test_a_joint_without_a_motor_s_encoder_is_measured_behind_its_gear(void)
{
    ticks(5);
    const float k_xx = now()->stiffness.now.k_xx_n_per_mm;
    for (int joint = BRACE_FEMUR; joint <= BRACE_TIBIA; joint++) {
        fake.joint[joint].sample.link_rad = fake.joint[joint].sample.motor_rad;
        fake.joint[joint].sample.motor_rad = __builtin_nanf("");
    }
    ticks(5);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    ASSERT_CLOSE(k_xx, now()->stiffness.now.k_xx_n_per_mm, 1e-6);
    TEST_ASSERT_TRUE(now()->motor_rad[BRACE_FEMUR] != now()->motor_rad[BRACE_FEMUR]); /* absent, and reported so */
    TEST_ASSERT_EQUAL(0, now()->faults);
    TEST_ASSERT_EQUAL(0, counters().samples_bad);
    fake.joint[BRACE_FEMUR].sample.link_rad += 1.0f; /* no joint gets there in a millisecond */
    ticks(1);
    TEST_ASSERT_EQUAL(1, counters().samples_bad);
    fake.joint[BRACE_FEMUR].sample.link_rad = __builtin_nanf(""); /* no encoder at all */
    ticks(30);
    TEST_ASSERT_FALSE(now()->k_is_valid);
    TEST_ASSERT_EQUAL(BRACE_FAULT_SENSOR_FEMUR, now()->faults);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_short_gap_in_the_samples_keeps_the_last_K);
    RUN_TEST(test_samples_too_old_are_stale_and_a_fault_until_they_have_been_back_for_a_while);
    RUN_TEST(test_a_sample_that_never_ages_in_name_is_not_believed);
    RUN_TEST(test_a_sample_taken_within_the_tick_is_not_stale);
    RUN_TEST(test_a_snapshot_is_as_old_as_its_older_sample_across_the_clock_s_wrap);
    RUN_TEST(test_play_that_no_load_can_show_is_always_open);
    RUN_TEST(test_absurd_samples_are_never_used);
    RUN_TEST(test_one_wild_angle_changes_nothing);
    RUN_TEST(test_each_joint_that_jumps_is_named);
    RUN_TEST(test_a_link_that_contradicts_its_motor_is_flagged_at_once);
    RUN_TEST(test_springs_of_an_unknown_temperature_are_flagged);
    RUN_TEST(test_the_fastest_joint_is_followed);
    RUN_TEST(test_every_tick_without_sound_joints_is_invalid);
    RUN_TEST(test_coxa_is_reported_and_not_needed);
    RUN_TEST(test_a_posture_beyond_the_travel_is_out_of_range);
    RUN_TEST(test_zero_offsets_are_added);
    RUN_TEST(test_an_encoder_that_follows_its_torque_is_alive);
    RUN_TEST(test_an_encoder_that_stands_while_the_torque_swings_is_stuck);
    RUN_TEST(test_a_stuck_encoder_is_found_in_drives_that_are_sampled_every_other_tick);
    RUN_TEST(test_a_link_that_moves_away_from_a_standing_encoder_shows_it_too);
    RUN_TEST(test_a_limb_at_rest_is_not_stuck);
    RUN_TEST(test_one_wild_torque_while_the_limb_stands_blames_no_encoder);
    RUN_TEST(test_wild_torques_that_go_on_are_the_sensor_s);
    RUN_TEST(test_a_torque_that_flickers_blames_no_encoder);
    RUN_TEST(test_a_force_that_stays_the_last_one_is_not_known_for_long);
    RUN_TEST(test_a_force_sensor_that_never_had_a_reading_reports_none);
    RUN_TEST(test_a_sample_from_the_future_does_not_stay_young);
    RUN_TEST(test_an_absurd_link_angle_is_none);
    RUN_TEST(test_a_joint_without_a_motor_s_encoder_is_measured_behind_its_gear);
    return UNITY_END();
}
