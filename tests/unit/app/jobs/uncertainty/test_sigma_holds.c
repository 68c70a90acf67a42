/* How long a round's sigma holds. A round takes some twenty ticks in the plane and a hundred in space, and the limb may
 * move meanwhile: what the snapshot then has is within a fifth of the sigma of that very tick, or is not known. */
#include "app_bench.h"
#include "brace/uncertainty_causes.h"

#define SAME_RATIO 0.2
#define TICK_S ((float)TICK_US * 1e-6f)

enum {
    ROUND_TICKS = 60, /* at most, where nobody asks for anything */
    SPACE_ROUND_TICKS = 300,
    MOVED_TICKS = ON_BOARD ? 400 : 3000,
};

static brace_parameters_t parameters;

void setUp(void)
{
    parameters = bench_parameters();
    parameters.gravity = (brace_gravity_t){.direction_rad = -1.57079633f};
    parameters.limb.uncertainty =
        (brace_uncertainty_t){.length_mm = 0.5f, .angle_rad = 0.003f, .compliance_rel = 0.05f, .gain_rel = 0.0f};
}

void tearDown(void) {}

static void start_in_plane(void)
{
    bench_start(&parameters);
    fake.force_x_n = 4.0f;
    fake.force_z_n = 9.0f;
    ticks(2 * ROUND_TICKS);
    TEST_ASSERT_TRUE(now()->sigma_is_known && now()->force_is_sensed);
}

static void start_in_space(void)
{
    bench_board();
    bench_store(&parameters);
    fake.joint[BRACE_COXA].absent = false;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    fake.force_x_n = 4.0f;
    fake.force_z_n = 9.0f;
    ticks(2 * SPACE_ROUND_TICKS);
    TEST_ASSERT_TRUE(now()->sigma_is_known && now()->load.is_counted);
}

/* Of this tick's posture and load. */
static brace_stiffness_sigma_t sigma_of_now(void)
{
    const float *theta_rad = app.controller.posture.unbent_rad;
    const float hip = parameters.limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm;
    const float knee = parameters.limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm;
    const brace_load_t load = {{now()->load.force_x_n, now()->load.force_z_n}, {0.0f, -1.0f}, {hip, hip}, {knee, knee}};
    brace_stiffness_sigma_t sigma;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_uncertainty_loaded(&parameters.limb, &parameters.gravity, theta_rad[BRACE_FEMUR],
                                                         theta_rad[BRACE_TIBIA], &load, &sigma));
    return sigma;
}

/* An entry that hardly changes with anything has a sigma near zero, where a ratio says nothing: a hundredth of the
 * largest entry's sigma is allowed for. */
static void expect_near(float expected, float sigma, float largest)
{
    ASSERT_CLOSE(expected, sigma, SAME_RATIO * (double)expected + 0.01 * (double)largest);
}

static void expect_of_now(void)
{
    const brace_stiffness_sigma_t of_now = sigma_of_now(), *reported = &now()->sigma;
    expect_near(of_now.k_xx_n_per_mm, reported->k_xx_n_per_mm, of_now.lambda_max_n_per_mm);
    expect_near(of_now.k_xz_n_per_mm, reported->k_xz_n_per_mm, of_now.lambda_max_n_per_mm);
    expect_near(of_now.k_zz_n_per_mm, reported->k_zz_n_per_mm, of_now.lambda_max_n_per_mm);
    expect_near(of_now.lambda_min_n_per_mm, reported->lambda_min_n_per_mm, 0.0f);
    expect_near(of_now.lambda_max_n_per_mm, reported->lambda_max_n_per_mm, 0.0f);
}

/* Both joints turn to and fro at such a speed. returns the share of the ticks in which sigma is known */
static float share_known_at(float rad_per_s)
{
    const int count = MOVED_TICKS;
    int known = 0;
    start_in_plane();
    float step_rad = rad_per_s * TICK_S;
    for (int i = 0; i < count; i++) {
        const float theta2_rad = fake.joint[BRACE_TIBIA].sample.motor_rad;
        step_rad =
            (theta2_rad > 2.0f && step_rad > 0.0f) || (theta2_rad < 0.8f && step_rad < 0.0f) ? -step_rad : step_rad;
        fake.joint[BRACE_TIBIA].sample.motor_rad += step_rad;
        fake.joint[BRACE_FEMUR].sample.motor_rad -= 0.5f * step_rad;
        ticks(1);
        TEST_ASSERT_TRUE(now()->k_is_valid);
        if (now()->sigma_is_known) {
            known++;
            expect_of_now();
        }
    }
    return (float)known / (float)count;
}

static void test_a_limb_that_moves_has_the_sigma_of_its_tick_or_none(void)
{
    TEST_ASSERT_TRUE(share_known_at(0.0f) == 1.0f);
    TEST_ASSERT_TRUE(share_known_at(0.3f) > 0.95f);
    TEST_ASSERT_TRUE(share_known_at(1.0f) > 0.3f);
    TEST_ASSERT_TRUE(share_known_at(10.0f) < 0.3f);
}

static void test_a_load_that_grows_has_the_sigma_of_its_tick_or_none(void)
{
    int known = 0;
    start_in_plane();
    for (int i = 0; i < MOVED_TICKS; i++) {
        fake.force_x_n = 4.0f + 20.0f * sinf(0.01f * (float)i);
        fake.joint[BRACE_FEMUR].sample.motor_rad = 1.0f + 1e-4f * (float)(i % 7); /* or it would be stuck */
        fake.joint[BRACE_TIBIA].sample.motor_rad = 1.4f + 1e-4f * (float)(i % 5);
        ticks(1);
        TEST_ASSERT_TRUE(now()->k_is_valid);
        if (now()->sigma_is_known) {
            known++;
            expect_of_now();
        }
    }
    TEST_ASSERT_GREATER_THAN(9 * MOVED_TICKS / 10, known);
}

static void test_after_a_jump_sigma_is_not_known_until_a_round_has_ended(void)
{
    start_in_plane();
    fake.joint[BRACE_TIBIA].sample.motor_rad += 0.049f; /* nearly at the bound on speed: it is believed */
    fake.joint[BRACE_FEMUR].sample.motor_rad -= 0.049f;
    ticks(1);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_FALSE(now()->sigma_is_known);
    ticks(2 * ROUND_TICKS);
    TEST_ASSERT_TRUE(now()->sigma_is_known);
    expect_of_now();
}

/* How old sigma is where nobody asks: no older than two rounds, and never without an age. */
static void expect_young(uint32_t round_ticks)
{
    uint32_t oldest_us = 0;
    for (uint32_t i = 0; i < 2u * round_ticks; i++) {
        ticks(1);
        TEST_ASSERT_TRUE(now()->sigma_is_known);
        oldest_us = now()->sigma_age_us > oldest_us ? now()->sigma_age_us : oldest_us;
        TEST_ASSERT_TRUE(now()->sigma_age_us > 0u);
    }
    TEST_ASSERT_LESS_OR_EQUAL(2u * round_ticks * TICK_US, oldest_us);
    printf("sigma at most %u us old\n", (unsigned)oldest_us);
}

static void test_sigma_is_renewed_all_the_time(void)
{
    start_in_plane();
    expect_young(ROUND_TICKS);
    start_in_space();
    expect_young(SPACE_ROUND_TICKS);
}

/* Sigma belongs to the parameters in force. */
static void test_other_parameters_have_another_sigma(void)
{
    start_in_plane();
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    parameters.limb.uncertainty.compliance_rel = 0.25f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_commit(&app, &parameters));
    bool was_reported = false;
    for (int i = 0; i < 300; i++) {
        ticks(1);
        if (now()->parameter_crc == brace_parameters_crc(&parameters) && now()->sigma_is_known) {
            expect_of_now();
            was_reported = true;
        }
        if (!brace_app_is_storing(&app) && now()->mode == BRACE_MODE_CONFIGURATION) {
            (void)brace_app_configuration_leave(&app);
        }
    }
    TEST_ASSERT_TRUE(was_reported);
}

/* Of a joint whose flank is lost, the angle is less known: sigma of before is over in the same tick. */
static void test_a_flank_that_is_lost_ends_what_was_known(void)
{
    parameters.limb.joint[BRACE_FEMUR].gap_rad = 0.01f;
    bench_start(&parameters);
    brace_fake_without_force(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = 3000.0f;
    ticks(4 * ROUND_TICKS);
    TEST_ASSERT_TRUE(now()->play[BRACE_FEMUR].valid && now()->sigma_is_known);
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = -3000.0f;
    fake.joint[BRACE_FEMUR].sample.motor_rad -= 0.015f; /* across the gap */
    int losses = 0;
    for (int i = 0; i < 6 * ROUND_TICKS; i++) {
        const bool was_valid = now()->play[BRACE_FEMUR].valid;
        fake.joint[BRACE_FEMUR].sample.motor_rad += i % 2 == 0 ? 1e-4f : -1e-4f; /* or it would be stuck */
        ticks(1);
        if (now()->play[BRACE_FEMUR].valid != was_valid) {
            losses++;
            TEST_ASSERT_TRUE(now()->k_is_valid);
            TEST_ASSERT_FALSE(now()->sigma_is_known);
        }
    }
    TEST_ASSERT_GREATER_THAN(0, losses);
    TEST_ASSERT_TRUE(now()->sigma_is_known);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_limb_that_moves_has_the_sigma_of_its_tick_or_none);
    RUN_TEST(test_a_load_that_grows_has_the_sigma_of_its_tick_or_none);
    RUN_TEST(test_after_a_jump_sigma_is_not_known_until_a_round_has_ended);
    RUN_TEST(test_sigma_is_renewed_all_the_time);
    RUN_TEST(test_other_parameters_have_another_sigma);
    RUN_TEST(test_a_flank_that_is_lost_ends_what_was_known);
    return UNITY_END();
}
