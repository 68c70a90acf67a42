#include "brace/chain.h"
/* K of limbs whose springs change with temperature and load, whose base yields, whose links do not. */
#include "loading_bench.h"

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    stand(&p);
}

void tearDown(void) {}

static void test_springs_follow_temperature_and_load(void)
{
    brace_parameters_t p = bench_parameters();
    p.slow.joint_compliance_per_degc = 0.01f;
    p.slow.reference_degc = 22.0f;
    bench_start(&p);
    ticks(3);
    const float cold = now()->stiffness.now.k_xx_n_per_mm; /* no thermometer: at the reference */
    ASSERT_CLOSE(3.96389818, cold, 2e-5);
    fake.joint[BRACE_FEMUR].sample.temp_degc = 42.0f; /* the tibia's joint takes it too */
    ticks(3);
    ASSERT_CLOSE(42.0, now()->temp_degc, 0.0);
    brace_limb_t warm = p.limb;
    warm.joint[BRACE_FEMUR].compliance_rad_per_n_mm *= 1.2f;
    warm.joint[BRACE_TIBIA].compliance_rad_per_n_mm *= 1.2f;
    brace_planar_t planar;
    brace_stiffness_t expected;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&warm, &planar));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_stiffness(&planar, 1.0f, 1.4f, &expected));
    ASSERT_CLOSE(expected.k_xx_n_per_mm, now()->stiffness.now.k_xx_n_per_mm, 1e-5);
    ASSERT_CLOSE(expected.k_zz_n_per_mm, now()->stiffness.now.k_zz_n_per_mm, 1e-5);

    p.slow.joint_compliance_per_degc = 0.0f;
    p.drive[BRACE_FEMUR].hardening_n_mm_per_rad3 = 1e8f;
    bench_start(&p);
    /* q = 0.02 rad: torque = q / 1e-5 + 1e8 q^3 = 2800 N mm, slope 1e5 + 3e8 q^2 = 2.2e5 */
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = 2800.0f;
    ticks(300);
    brace_limb_t hard = p.limb;
    hard.joint[BRACE_FEMUR].compliance_rad_per_n_mm = (float)(1.0 / 2.2e5);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&hard, &planar));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_stiffness(&planar, 1.0f, 1.4f, &expected));
    ASSERT_CLOSE(expected.k_xx_n_per_mm, now()->stiffness.now.k_xx_n_per_mm, 1e-4);
}

static void test_a_base_that_yields_unequally_takes_the_general_path(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb.base = (brace_base_t){0.02f, 0.005f, 3e-6f};
    bench_start(&p);
    ticks(3);
    brace_chain_t chain;
    brace_stiffness_t expected;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_build(&p.limb, &chain));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_stiffness(&chain, 1.0f, 1.4f, &expected));
    ASSERT_CLOSE(expected.k_xx_n_per_mm, now()->stiffness.now.k_xx_n_per_mm, 1e-5);
    ASSERT_CLOSE(expected.k_xz_n_per_mm, now()->stiffness.now.k_xz_n_per_mm, 1e-5);
    ASSERT_CLOSE(expected.k_zz_n_per_mm, now()->stiffness.now.k_zz_n_per_mm, 1e-5);
}

static void test_a_limb_that_only_its_joints_let_yield_works_too(void)
{
    brace_parameters_t p = bench_parameters();
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        p.limb.link[i] = (brace_link_t){0};
    }
    p.slow.joint_compliance_per_degc = 0.001f; /* so that the springs change, and the links are built alone */
    bench_start(&p);
    ticks(3);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    brace_chain_t chain;
    brace_stiffness_t expected;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_build(&p.limb, &chain));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_stiffness(&chain, 1.0f, 1.4f, &expected));
    ASSERT_CLOSE(expected.k_zz_n_per_mm, now()->stiffness.now.k_zz_n_per_mm,
                 1e-5 * (double)expected.lambda_max_n_per_mm);
}

/* At the ends of the parameters' ranges: compliances up to 1 rad/(N mm), hardening up to 1e30, torques up to the
 * range. Where the cube carries all of the load, q = (torque / hardening)^(1/3) and the slope is 3 hardening q^2. */
static void test_a_spring_that_hardens_beyond_measure_stays_a_spring(void)
{
    static const float hardening[] = {1e12f, 1e24f, 1e30f}, torque_n_mm[] = {1e3f, -1e6f, 20.0f};
    for (size_t i = 0; i < sizeof hardening / sizeof *hardening; i++) {
        brace_parameters_t p = bench_parameters();
        p.limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = 1.0f;
        p.drive[BRACE_FEMUR].torque_range_n_mm = 1e6f;
        p.drive[BRACE_FEMUR].hardening_n_mm_per_rad3 = hardening[i];
        bench_start(&p);
        for (size_t j = 0; j < sizeof torque_n_mm / sizeof *torque_n_mm; j++) {
            /* it moves: a motor that stands while its torque swings seems stuck */
            const float theta1_rad = 1.0f + 0.001f * (float)j;
            fake.joint[BRACE_FEMUR].sample.torque_n_mm = torque_n_mm[j];
            ticks(200);
            fake.joint[BRACE_FEMUR].sample.motor_rad = theta1_rad;
            ticks(200);
            TEST_ASSERT_TRUE(now()->k_is_valid);
            const double load = fabs((double)torque_n_mm[j]), h = (double)hardening[i];
            const double q = cbrt(load / h), slope = 1.0 + 3.0 * h * q * q;
            brace_limb_t hard = p.limb;
            hard.joint[BRACE_FEMUR].compliance_rad_per_n_mm = (float)(1.0 / slope);
            brace_chain_t chain;
            brace_stiffness_t expected;
            TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_build(&hard, &chain));
            TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_stiffness(&chain, theta1_rad, 1.4f, &expected));
            ASSERT_CLOSE(expected.lambda_min_n_per_mm, now()->stiffness.now.lambda_min_n_per_mm,
                         1e-3 * (double)expected.lambda_min_n_per_mm);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_springs_follow_temperature_and_load);
    RUN_TEST(test_a_base_that_yields_unequally_takes_the_general_path);
    RUN_TEST(test_a_limb_that_only_its_joints_let_yield_works_too);
    RUN_TEST(test_a_spring_that_hardens_beyond_measure_stays_a_spring);
    return UNITY_END();
}
