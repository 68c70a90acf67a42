/* What is reported while there is no K to use, and for how long what can no longer be known is still reported. */
#include "app_bench.h"

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    bench_start(&p);
}

void tearDown(void) {}

/* Numbers nobody can mistake for a stiffness of zero, and a flag that says why. */
static void expect_no_k(uint32_t flag)
{
    const brace_stiffness_t *both[] = {&now()->stiffness.now, &now()->stiffness.engaged};
    TEST_ASSERT_FALSE(now()->k_is_valid);
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_TRUE(isnan(both[i]->k_xx_n_per_mm) && isnan(both[i]->k_xz_n_per_mm) &&
                         isnan(both[i]->k_zz_n_per_mm));
        TEST_ASSERT_TRUE(isnan(both[i]->lambda_min_n_per_mm) && isnan(both[i]->lambda_max_n_per_mm));
        TEST_ASSERT_TRUE(isnan(both[i]->stiff_axis_rad));
        TEST_ASSERT_BITS(flag, flag, both[i]->flags);
    }
}

static void test_before_the_first_tick_and_without_samples_there_is_no_number(void)
{
    expect_no_k(BRACE_FLAG_STALE);
    fake.joint[BRACE_FEMUR].absent = true;
    ticks(150);
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, now()->mode);
    expect_no_k(BRACE_FLAG_STALE);
}

/* What a snapshot reports before the first tick: when, of which set, in which mode; every number is none. */
static void test_the_first_snapshot_knows_its_set_and_no_number(void)
{
    brace_parameters_t p = bench_parameters();
    p.gravity.direction_rad = -1.2f, p.gravity.lean_rad = 0.2f;
    bench_start(&p);
    const brace_snapshot_t *first = now();
    TEST_ASSERT_EQUAL_HEX32(brace_parameters_crc(&p), first->parameter_crc);
    TEST_ASSERT_EQUAL(BRACE_PARAMETERS_SLOT_A, first->parameter_origin);
    TEST_ASSERT_EQUAL_HEX32(0, first->faults);
    TEST_ASSERT_EQUAL(fake.now_us, first->taken_us);
    TEST_ASSERT_EQUAL_FLOAT(-1.2f, first->gravity_direction_rad);
    TEST_ASSERT_EQUAL_FLOAT(0.2f, first->gravity_lean_rad);
    const float none[] = {first->tip_mm.x_mm,
                          first->tip_mm.z_mm,
                          first->play_shift_mm.x_mm,
                          first->play_shift_mm.z_mm,
                          first->force_x_n,
                          first->force_y_n,
                          first->force_z_n,
                          first->temp_degc,
                          first->load.force_x_n,
                          first->load.moved_z_mm,
                          first->load.buckling_factor,
                          first->space.across_n_per_mm};
    for (uint32_t i = 0; i < sizeof none / sizeof *none; i++) {
        TEST_ASSERT_TRUE(isnan(none[i]));
    }
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        TEST_ASSERT_TRUE(isnan(first->theta_rad[i]) && isnan(first->motor_rad[i]) && isnan(first->torque_n_mm[i]));
    }
    bench_board(); /* nothing stored: the defaults are a fault, and reported from the start */
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    TEST_ASSERT_EQUAL(BRACE_PARAMETERS_DEFAULT, now()->parameter_origin);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FAULT_PARAMETERS, now()->faults);
}

static void test_configuration_reports_no_k_and_why(void)
{
    ticks(5);
    TEST_ASSERT_EQUAL(0, now()->stiffness.now.flags);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    ticks(1);
    expect_no_k(BRACE_FLAG_STALE);
}

static void test_a_fault_with_sound_samples_is_flagged_too(void)
{
    ticks(5);
    for (int i = 0; i < 600; i++) { /* torque works and the encoder stands */
        fake.joint[BRACE_FEMUR].sample.torque_n_mm = i % 200 < 100 ? 4000.0f : -4000.0f;
        ticks(1);
    }
    TEST_ASSERT_EQUAL(BRACE_FAULT_ENCODER_STUCK, now()->faults);
    TEST_ASSERT_FALSE(now()->k_is_valid);
    TEST_ASSERT_BITS(BRACE_FLAG_STALE, BRACE_FLAG_STALE, now()->stiffness.now.flags);
    TEST_ASSERT_BITS(BRACE_FLAG_STALE, BRACE_FLAG_STALE, now()->stiffness.engaged.flags);
}

static void test_a_posture_where_there_is_no_k_is_flagged(void)
{
    ticks(5);
    app.controller.parameters.in_force.limb.femur_mm = -1.0f; /* no posture */
    ticks(1);
    expect_no_k(BRACE_FLAG_NEAR_SINGULAR);
}

/* A drive that has nothing newer: its joint is sound until its sample is too old, but nothing proves its flank. */
static void test_no_flank_is_proven_by_old_samples(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_TIBIA].gap_rad = 0.01f;
    p.controller.age_limit_us = 500000;
    bench_start(&p);
    brace_fake_without_force(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = 2000.0f;
    ticks(200);
    TEST_ASSERT_TRUE(now()->play[BRACE_TIBIA].valid);
    TEST_ASSERT_EQUAL(0, now()->stiffness.now.flags);
    fake.joint[BRACE_TIBIA].not_newer = true;
    ticks(4);
    TEST_ASSERT_TRUE(now()->play[BRACE_TIBIA].valid); /* as with drives that are sampled every few ticks */
    for (int i = 0; i < 300; i++) {
        ticks(1);
        TEST_ASSERT_FALSE(now()->play[BRACE_TIBIA].valid);
        TEST_ASSERT_TRUE(now()->k_is_valid);
        TEST_ASSERT_BITS(BRACE_FLAG_GAP_OPEN, BRACE_FLAG_GAP_OPEN, now()->stiffness.now.flags);
    }
    fake.joint[BRACE_TIBIA].not_newer = false;
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = 0.0f; /* the gap has opened meanwhile */
    for (int i = 0; i < 100; i++) {
        ticks(1);
        TEST_ASSERT_FALSE(now()->play[BRACE_TIBIA].valid);
    }
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = 2000.0f;
    ticks(200);
    TEST_ASSERT_TRUE(now()->play[BRACE_TIBIA].valid);
    for (int i = 0; i < 300; i++) { /* every third tick only */
        fake.joint[BRACE_TIBIA].not_newer = i % 3 != 0;
        ticks(1);
        TEST_ASSERT_TRUE(now()->play[BRACE_TIBIA].valid);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_before_the_first_tick_and_without_samples_there_is_no_number);
    RUN_TEST(test_the_first_snapshot_knows_its_set_and_no_number);
    RUN_TEST(test_configuration_reports_no_k_and_why);
    RUN_TEST(test_a_fault_with_sound_samples_is_flagged_too);
    RUN_TEST(test_a_posture_where_there_is_no_k_is_flagged);
    RUN_TEST(test_no_flank_is_proven_by_old_samples);
    return UNITY_END();
}
