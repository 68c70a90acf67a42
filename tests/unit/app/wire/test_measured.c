/* Each measured value reaches the wires under its own name. Every number of the snapshot and every counter gets a
 * value of its own here, so that two exchanged names are noticed. */
#include "wire/measured.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "app_bench.h"

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    bench_board();
    bench_store(&p);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
}

void tearDown(void) {}

static float next; /* a number that none before was */

static void any_k(brace_stiffness_t *k)
{
    *k = (brace_stiffness_t){next + 0.1f, next + 0.2f, next + 0.3f, next + 0.4f, next + 0.5f, next + 0.6f, 0u};
    next += 1.0f;
}

static void any_k_in_space(brace_stiffness_spatial_t *k)
{
    *k = (brace_stiffness_spatial_t){next + 0.01f,
                                     next + 0.02f,
                                     next + 0.03f,
                                     next + 0.04f,
                                     next + 0.05f,
                                     next + 0.06f,
                                     {next + 0.07f, next + 0.08f, next + 0.09f},
                                     {next + 0.10f, next + 0.11f, next + 0.12f},
                                     0u};
    next += 1.0f;
}

static brace_snapshot_t *newest(void)
{
    return &app.controller.snapshot[app.controller.newest];
}

static brace_measured_t reported_of(const brace_app_counters_t *counters)
{
    brace_measured_t m;
    memset(&m, 0x5a, sizeof m);
    measured_take(&app, counters, newest()->taken_us + 7u, &m);
    return m;
}

static void test_k_in_the_plane_and_its_load(void)
{
    const brace_app_counters_t counters = {0};
    brace_snapshot_t *s = newest();
    next = 1.0f;
    any_k(&s->stiffness.now);
    any_k(&s->stiffness.engaged);
    any_k(&s->load.unloaded);
    s->k_is_valid = true;
    s->sequence = 4711;
    s->load.force_x_n = 31.0f, s->load.force_y_n = 32.0f, s->load.force_z_n = 33.0f;
    s->load.moved_x_mm = 34.0f, s->load.moved_y_mm = 35.0f, s->load.moved_z_mm = 36.0f;
    s->load.buckling_factor = 37.0f, s->load.unloaded_across_n_per_mm = 38.0f;
    s->gravity_direction_rad = 39.0f, s->gravity_lean_rad = 40.0f;
    const brace_measured_t m = reported_of(&counters);
    TEST_ASSERT_EQUAL_UINT32(4711, m.sequence);
    TEST_ASSERT_EQUAL_UINT32(7, m.age_us);
    TEST_ASSERT_EQUAL_UINT32(1, m.k_is_valid);
    TEST_ASSERT_EQUAL_FLOAT(1.1f, m.k_xx_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(1.2f, m.k_xz_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(1.3f, m.k_zz_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(1.4f, m.lambda_min_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(1.5f, m.lambda_max_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(1.6f, m.stiff_axis_rad);
    TEST_ASSERT_EQUAL_FLOAT(2.1f, m.engaged_k_xx_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(2.2f, m.engaged_k_xz_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(2.3f, m.engaged_k_zz_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(2.4f, m.engaged_lambda_min_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(2.5f, m.engaged_lambda_max_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(3.1f, m.unloaded_k_xx_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(3.2f, m.unloaded_k_xz_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(3.3f, m.unloaded_k_zz_n_per_mm);
    const float load[] = {m.counted_force_x_n,
                          m.counted_force_y_n,
                          m.counted_force_z_n,
                          m.moved_x_mm,
                          m.moved_y_mm,
                          m.moved_z_mm,
                          m.buckling_factor,
                          m.unloaded_k_across_n_per_mm,
                          m.gravity_direction_rad,
                          m.gravity_lean_rad};
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_FLOAT(31.0f + (float)i, load[i]);
    }
}

static void test_k_in_space(void)
{
    const brace_app_counters_t counters = {0};
    brace_space_stiffness_t *space = &newest()->space;
    next = 1.0f;
    any_k_in_space(&space->now);
    any_k_in_space(&space->engaged);
    space->is_fitted = space->is_valid = true;
    space->now.flags = 0xau;
    space->across_n_per_mm = 9.0f;
    const brace_measured_t m = reported_of(&counters);
    const float now[] = {m.space_k_xx_n_per_mm,     m.space_k_xy_n_per_mm,     m.space_k_xz_n_per_mm,
                         m.space_k_yy_n_per_mm,     m.space_k_yz_n_per_mm,     m.space_k_zz_n_per_mm,
                         m.space_lambda_1_n_per_mm, m.space_lambda_2_n_per_mm, m.space_lambda_3_n_per_mm,
                         m.space_stiff_axis_x,      m.space_stiff_axis_y,      m.space_stiff_axis_z};
    const float engaged[] = {
        m.engaged_space_k_xx_n_per_mm,     m.engaged_space_k_xy_n_per_mm,     m.engaged_space_k_xz_n_per_mm,
        m.engaged_space_k_yy_n_per_mm,     m.engaged_space_k_yz_n_per_mm,     m.engaged_space_k_zz_n_per_mm,
        m.engaged_space_lambda_1_n_per_mm, m.engaged_space_lambda_2_n_per_mm, m.engaged_space_lambda_3_n_per_mm};
    for (int i = 0; i < 12; i++) {
        TEST_ASSERT_EQUAL_FLOAT(1.01f + 0.01f * (float)i, now[i]);
    }
    for (int i = 0; i < 9; i++) {
        TEST_ASSERT_EQUAL_FLOAT(2.01f + 0.01f * (float)i, engaged[i]);
    }
    TEST_ASSERT_EQUAL_UINT32(1, m.k_is_in_space);
    TEST_ASSERT_EQUAL_UINT32(0xa, m.space_flags);
    TEST_ASSERT_EQUAL_FLOAT(9.0f, m.k_across_n_per_mm);
    space->is_fitted = false;
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, reported_of(&counters).space_flags);
}

static void expect_sigma(const brace_measured_t *m, float first)
{
    const float sigma[] = {
        m->sigma_k_xx_n_per_mm,           m->sigma_k_xz_n_per_mm,           m->sigma_k_zz_n_per_mm,
        m->sigma_lambda_min_n_per_mm,     m->sigma_lambda_max_n_per_mm,     m->sigma_stiff_axis_rad,
        m->sigma_space_k_xx_n_per_mm,     m->sigma_space_k_xy_n_per_mm,     m->sigma_space_k_xz_n_per_mm,
        m->sigma_space_k_yy_n_per_mm,     m->sigma_space_k_yz_n_per_mm,     m->sigma_space_k_zz_n_per_mm,
        m->sigma_space_lambda_1_n_per_mm, m->sigma_space_lambda_2_n_per_mm, m->sigma_space_lambda_3_n_per_mm,
        m->sigma_k_across_n_per_mm};
    for (int i = 0; i < 16; i++) {
        TEST_ASSERT_TRUE(isnan(first) ? isnan(sigma[i]) : sigma[i] == first + (float)i);
    }
}

/* Infinite or not known is reported as not known, never as a number. */
static void test_one_sigma_of_k(void)
{
    const brace_app_counters_t counters = {0};
    brace_snapshot_t *s = newest();
    s->sigma = (brace_stiffness_sigma_t){1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 0u};
    s->sigma_space = (brace_space_sigma_t){7.0f, 8.0f, 9.0f, 10.0f, 11.0f, 12.0f, {13.0f, 14.0f, 15.0f}, 16.0f};
    s->sigma_is_known = true;
    brace_measured_t m = reported_of(&counters);
    expect_sigma(&m, 1.0f);
    s->sigma_is_known = false;
    m = reported_of(&counters);
    expect_sigma(&m, NAN);
    s->sigma_is_known = true;
    s->sigma.k_zz_n_per_mm = s->sigma_space.across_n_per_mm = INFINITY;
    m = reported_of(&counters);
    TEST_ASSERT_TRUE(isnan(m.sigma_k_zz_n_per_mm) && isnan(m.sigma_k_across_n_per_mm));
}

static void test_joints_and_what_is_around_them(void)
{
    const brace_app_counters_t counters = {0};
    brace_snapshot_t *s = newest();
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        const float joint = 10.0f * (float)(i + 1);
        s->theta_rad[i] = joint + 1.0f;
        s->motor_rad[i] = joint + 2.0f;
        s->torque_n_mm[i] = joint + 3.0f;
        s->play[i].state = (brace_backlash_state_t)i;
        s->play[i].offset_rad = joint + 4.0f;
        s->play[i].load_n_mm = joint + 5.0f;
        s->play[i].takeup = (brace_takeup_result_t) - (i + 1);
    }
    s->tip_mm = (brace_point_t){51.0f, 52.0f};
    s->play_shift_mm = (brace_point_t){53.0f, 54.0f};
    s->force_x_n = 55.0f, s->force_z_n = 56.0f, s->force_is_sensed = true;
    s->temp_degc = 57.0f;
    const brace_measured_t m = reported_of(&counters);
    const float joints[BRACE_LINK_COUNT][5] = {
        {m.theta0_rad, m.motor_coxa_rad, m.torque_coxa_n_mm, m.play_coxa_offset_rad, m.load_coxa_n_mm},
        {m.theta1_rad, m.motor_femur_rad, m.torque_femur_n_mm, m.play_femur_offset_rad, m.load_femur_n_mm},
        {m.theta2_rad, m.motor_tibia_rad, m.torque_tibia_n_mm, m.play_tibia_offset_rad, m.load_tibia_n_mm}};
    const uint32_t play[] = {m.play_coxa, m.play_femur, m.play_tibia};
    const uint32_t taken[] = {m.take_up_coxa, m.take_up_femur, m.take_up_tibia};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        for (int k = 0; k < 5; k++) {
            TEST_ASSERT_EQUAL_FLOAT(10.0f * (float)(i + 1) + 1.0f + (float)k, joints[i][k]);
        }
        TEST_ASSERT_EQUAL_UINT32(i, play[i]);
        TEST_ASSERT_EQUAL_UINT32(255 - i, taken[i]);
    }
    const float around[] = {m.tip_x_mm,  m.tip_z_mm,  m.play_shift_x_mm, m.play_shift_z_mm,
                            m.force_x_n, m.force_z_n, m.temperature_degc};
    for (int i = 0; i < 7; i++) {
        TEST_ASSERT_EQUAL_FLOAT(51.0f + (float)i, around[i]);
    }
    TEST_ASSERT_EQUAL_UINT32(1, m.force_is_sensed);
}

static void test_counters_and_who_owns_it(void)
{
    const brace_app_counters_t counters = {.ticks_late = 1,
                                           .samples_bad = 2,
                                           .frames_refused = 3,
                                           .frames_unknown = 4,
                                           .frames_lost = 5,
                                           .commands_failed = 6,
                                           .modbus_broken = 7,
                                           .modbus_refused = 8};
    session_t *session = &app.controller.ownership.session;
    session->counts = (session_counts_t){11, 12, 13};
    session->setting = BRACE_SETTING_GUARDED;
    session->has_challenge = true;
    session->challenge = 0x1122334455667788u;
    app.controller.ownership.is_held = true;
    app.controller.ownership.last_refusal = -3;
    const brace_measured_t m = reported_of(&counters);
    const uint32_t reported[] = {m.ticks_late,  m.samples_bad,     m.frames_refused, m.frames_unknown,
                                 m.frames_lost, m.commands_failed, m.modbus_broken,  m.modbus_refused};
    for (uint32_t i = 0; i < 8u; i++) {
        TEST_ASSERT_EQUAL_UINT32(i + 1u, reported[i]);
    }
    TEST_ASSERT_EQUAL_UINT32(11, m.strangers_refused);
    TEST_ASSERT_EQUAL_UINT32(12, m.replays_refused);
    TEST_ASSERT_EQUAL_UINT32(13, m.silences);
    TEST_ASSERT_EQUAL_UINT32(BRACE_SETTING_GUARDED, m.setting);
    TEST_ASSERT_EQUAL_UINT32(BRACE_OWNER_NONE, m.owner);
    TEST_ASSERT_EQUAL_UINT32(1, m.is_held);
    TEST_ASSERT_EQUAL_HEX32(0x55667788u, m.challenge_low);
    TEST_ASSERT_EQUAL_HEX32(0x11223344u, m.challenge_high);
    TEST_ASSERT_EQUAL_HEX32(0xfdu, m.last_refusal);
    session->has_challenge = false;
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX, reported_of(&counters).challenge_low);
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX, reported_of(&counters).challenge_high);
}

static void test_a_loading_test_that_is_done(void)
{
    const brace_app_counters_t counters = {0};
    brace_loading_result_t *result = &app.controller.loading.result;
    result->outcome = BRACE_LOADING_DONE;
    result->least_squares.k_x_n_per_mm = 1.0f, result->least_squares.k_z_n_per_mm = 2.0f;
    result->mean_of_ratios.k_x_n_per_mm = 3.0f, result->mean_of_ratios.k_z_n_per_mm = 4.0f;
    result->z_x = 5.0f, result->z_z = 6.0f;
    brace_measured_t m = reported_of(&counters);
    const float reported[] = {m.loading_k_x_n_per_mm,       m.loading_k_z_n_per_mm, m.loading_ratio_k_x_n_per_mm,
                              m.loading_ratio_k_z_n_per_mm, m.loading_score_x,      m.loading_score_z};
    for (int i = 0; i < 6; i++) {
        TEST_ASSERT_EQUAL_FLOAT(1.0f + (float)i, reported[i]);
    }
    static const brace_loading_outcome_t others[] = {BRACE_LOADING_STOPPED, BRACE_LOADING_RUNNING,
                                                     BRACE_LOADING_E_FORCE, BRACE_LOADING_E_FLAT};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        result->outcome = others[i];
        m = reported_of(&counters);
        TEST_ASSERT_TRUE(isnan(m.loading_score_x) && isnan(m.loading_k_z_n_per_mm));
    }
}

static void test_the_set_in_force(void)
{
    const brace_app_counters_t counters = {0};
    brace_snapshot_t *s = newest();
    s->parameter_crc = 21u, s->parameter_origin = BRACE_PARAMETERS_SLOT_B, s->parameter_sequence = 23u;
    s->mode = BRACE_MODE_FAULT, s->faults = 24u, s->stiffness.now.flags = 25u;
    const brace_measured_t m = reported_of(&counters);
    TEST_ASSERT_EQUAL_UINT32(21, m.parameter_crc);
    TEST_ASSERT_EQUAL_UINT32(BRACE_PARAMETERS_SLOT_B, m.parameter_origin);
    TEST_ASSERT_EQUAL_UINT32(23, m.parameter_sequence);
    TEST_ASSERT_EQUAL_UINT32(BRACE_MODE_FAULT, m.mode);
    TEST_ASSERT_EQUAL_UINT32(24, m.faults);
    TEST_ASSERT_EQUAL_UINT32(25, m.flags);
}

static void test_a_drift_and_its_cause(void)
{
    const brace_app_counters_t counters = {0};
    brace_drift_report_t *report = &app.controller.drift.report;
    report->state = BRACE_DRIFT_WATCHING, report->cause = (brace_drift_cause_t)2, report->could_be = 31u;
    report->evidence = 32.0f, report->loss_ratio = 33.0f, report->loss_sigma_ratio = 34.0f;
    report->since_steps = 35u, report->steps = 36u;
    brace_measured_t m = reported_of(&counters);
    TEST_ASSERT_EQUAL_UINT32(BRACE_DRIFT_WATCHING, m.drift_state);
    TEST_ASSERT_EQUAL_UINT32(3, m.drift_cause);
    TEST_ASSERT_EQUAL_UINT32(31, m.drift_could_be);
    TEST_ASSERT_EQUAL_FLOAT(32.0f, m.drift_evidence);
    TEST_ASSERT_EQUAL_FLOAT(33.0f, m.drift_loss_ratio);
    TEST_ASSERT_EQUAL_FLOAT(34.0f, m.drift_loss_sigma_ratio);
    TEST_ASSERT_EQUAL_UINT32(35, m.drift_since_readings);
    TEST_ASSERT_EQUAL_UINT32(36, m.drift_readings);
    report->evidence = FLT_MIN; /* however little there is */
    TEST_ASSERT_NOT_EQUAL(BRACE_DRIFT_CAUSE_NONE, measured_drift_cause(report));
    report->evidence = 0.0f; /* no cause is reported without evidence */
    m = reported_of(&counters);
    TEST_ASSERT_EQUAL_UINT32(BRACE_DRIFT_CAUSE_NONE, m.drift_cause);
    TEST_ASSERT_EQUAL_UINT32(0, m.drift_could_be);
    TEST_ASSERT_TRUE(isnan(m.drift_loss_ratio) && isnan(m.drift_loss_sigma_ratio));
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, m.drift_since_readings);
    report->state = BRACE_DRIFT_DRIFTED; /* a baseline that walked away */
    TEST_ASSERT_EQUAL_UINT32(3, reported_of(&counters).drift_cause);
}

/* Nothing of what was there before stays: every value is written, whatever it is. */
static void test_every_value_is_written(void)
{
    const brace_app_counters_t counters = {0};
    brace_measured_t over_ones, over_others;
    memset(&over_ones, 0xff, sizeof over_ones);
    memset(&over_others, 0x5a, sizeof over_others);
    measured_take(&app, &counters, newest()->taken_us, &over_ones);
    measured_take(&app, &counters, newest()->taken_us, &over_others);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(&over_ones, &over_others, BRACE_MEASURED_COUNT);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_k_in_the_plane_and_its_load);
    RUN_TEST(test_k_in_space);
    RUN_TEST(test_one_sigma_of_k);
    RUN_TEST(test_joints_and_what_is_around_them);
    RUN_TEST(test_counters_and_who_owns_it);
    RUN_TEST(test_a_loading_test_that_is_done);
    RUN_TEST(test_the_set_in_force);
    RUN_TEST(test_a_drift_and_its_cause);
    RUN_TEST(test_every_value_is_written);
    return UNITY_END();
}
