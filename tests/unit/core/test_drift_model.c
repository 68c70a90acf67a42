/* Tests of the force that the drift check expects, and of how that force shifts with each estimate. The reference is K
 * of the changed limb by the formulas of docs/physics.md in double precision. */
#include <math.h>
#include <string.h>

#include "reference_planar.h"
#include "sample_limbs.h"
#include "unity.h"
#include "use/drift_model.h"

void setUp(void) {}

void tearDown(void) {}

static brace_limb_t limb;
static brace_drift_reading_t reading;

/* A limb with everything that the check knows: a tilted femur that passes moments on, a base that turns. */
static void be(int sample, float tilt_rad, float moment_transfer)
{
    limb = sample_limb[sample];
    limb.link[BRACE_FEMUR].tilt_rad = tilt_rad;
    limb.link[BRACE_FEMUR].moment_transfer = moment_transfer;
    limb.link[BRACE_TIBIA].tilt_rad = 0.0f;
    limb.base = (brace_base_t){0.0f, 0.0f, 3e-6f};
}

static brace_stiffness_t model_k(void)
{
    const reference_planar_t r = reference_planar(&limb, (double)reading.theta1_rad, (double)reading.theta2_rad);
    return (brace_stiffness_t){
        .k_xx_n_per_mm = (float)r.k_xx, .k_xz_n_per_mm = (float)r.k_xz, .k_zz_n_per_mm = (float)r.k_zz};
}

static void force_of(const brace_limb_t *changed, double theta1_rad, double theta2_rad, double force_n[2])
{
    const reference_planar_t r = reference_planar(changed, theta1_rad, theta2_rad);
    const double dx = (double)reading.dx_mm, dz = (double)reading.dz_mm;
    force_n[0] = r.k_xx * dx + r.k_xz * dz, force_n[1] = r.k_xz * dx + r.k_zz * dz;
}

/* The limb with one estimate off by a share. */
static brace_limb_t changed_by(int cause, float share)
{
    brace_limb_t changed = limb;
    const float by = 1.0f + share;
    if (cause == BRACE_DRIFT_FEMUR) {
        changed.link[BRACE_FEMUR].bending_mm_per_n *= by;
    } else if (cause == BRACE_DRIFT_TIBIA_OR_KNEE) {
        changed.link[BRACE_TIBIA].bending_mm_per_n *= by;
        changed.joint[BRACE_TIBIA].compliance_rad_per_n_mm *= by;
    } else if (cause == BRACE_DRIFT_FEMUR_JOINT_OR_BASE) {
        changed.joint[BRACE_FEMUR].compliance_rad_per_n_mm *= by;
        changed.base.rotation_rad_per_n_mm *= by;
    } else if (cause == DRIFT_AXIAL) {
        changed.link[BRACE_FEMUR].axial_mm_per_n *= by;
        changed.link[BRACE_TIBIA].axial_mm_per_n *= by;
    }
    return changed;
}

static void test_the_force_shifts_as_the_limb_s_own_K_does(void)
{
    static const float postures[][2] = {{0.74f, 1.0f}, {1.51f, 2.23f}, {0.28f, 0.51f}, {2.15f, 2.69f}, {-0.5f, -1.1f}};
    static const float tilts[] = {0.0f, 0.35f, -0.6f}, ratios[] = {0.0f, 1.0f, 0.4f};
    const double step = 1e-3;
    for (int i = 0; i < 45; i++) {
        be(i % 2 == 0 ? SAMPLE_PAPER : SAMPLE_BEAM, tilts[i % 3], ratios[i / 3 % 3]);
        reading = (brace_drift_reading_t){.theta1_rad = postures[i % 5][0],
                                          .theta2_rad = postures[i % 5][1],
                                          .dx_mm = 0.7f * cosf((float)i),
                                          .dz_mm = 0.7f * sinf((float)i)};
        const brace_stiffness_t k = model_k();
        const float none[DRIFT_OFFSETS] = {0.0f};
        drift_expected_t at;
        drift_expect(&limb, &k, &reading, none, 0.0f, &at);
        const double theta1 = (double)reading.theta1_rad, theta2 = (double)reading.theta2_rad;
        double force_n[2], more_n[2], less_n[2];
        force_of(&limb, theta1, theta2, force_n);
        const double size_n = hypot(force_n[0], force_n[1]) + 1.0;
        for (int axis = 0; axis < 2; axis++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-4 * size_n, force_n[axis], (double)at.force_n[axis]);
        }
        for (int estimate = 0; estimate < DRIFT_OFFSETS; estimate++) {
            if (estimate == DRIFT_THERMAL) {
                continue;
            }
            const brace_limb_t more = changed_by(estimate, (float)step), less = changed_by(estimate, -(float)step);
            const double by_limb = estimate == DRIFT_TURN_LIMB ? step : 0.0;
            const double by_knee = estimate == DRIFT_TURN_KNEE ? step : 0.0;
            force_of(&more, theta1 + by_limb, theta2 + by_knee, more_n);
            force_of(&less, theta1 - by_limb, theta2 - by_knee, less_n);
            for (int axis = 0; axis < 2; axis++) {
                const double slope = (more_n[axis] - less_n[axis]) / (2.0 * step);
                TEST_ASSERT_DOUBLE_WITHIN(5e-4 * (size_n + fabs(slope)), slope, (double)at.per_offset[axis][estimate]);
            }
        }
    }
}

/* The estimate of a femur that has changed by a third is that limb: its bend alone and what its moment makes of it. */
static void test_a_softer_femur_is_that_limb(void)
{
    static const float ratios[] = {0.0f, 1.0f, 0.4f};
    for (int i = 0; i < 18; i++) {
        be(i % 2 == 0 ? SAMPLE_PAPER : SAMPLE_BEAM, 0.35f, ratios[i / 2 % 3]);
        reading = (brace_drift_reading_t){
            .theta1_rad = 0.74f, .theta2_rad = 1.0f, .dx_mm = 0.7f * cosf((float)i), .dz_mm = 0.7f * sinf((float)i)};
        const float share = i / 6 % 2 == 0 ? 0.33f : -0.33f;
        const brace_limb_t softer = changed_by(BRACE_DRIFT_FEMUR, share);
        const brace_stiffness_t k = model_k();
        float offset[DRIFT_OFFSETS] = {0.0f};
        offset[BRACE_DRIFT_FEMUR] = share;
        drift_expected_t at;
        double force_n[2];
        drift_expect(&limb, &k, &reading, offset, 0.0f, &at);
        force_of(&softer, 0.74, 1.0, force_n);
        for (int axis = 0; axis < 2; axis++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-4 * (hypot(force_n[0], force_n[1]) + 1.0), force_n[axis],
                                      (double)at.force_n[axis]);
        }
    }
}

/* What the knee and the tibia yield across the tibia is the tibia's by its share; all of it, where none of it is. */
static void test_the_tibia_s_share(void)
{
    be(SAMPLE_PAPER, 0.0f, 0.0f);
    const drift_compliances_t whole = drift_compliances(&limb);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f * whole.shank_mm_per_n, limb.link[BRACE_TIBIA].bending_mm_per_n,
                             whole.tibia_share * whole.shank_mm_per_n);
    limb.link[BRACE_TIBIA].bending_mm_per_n = 0.0f;
    TEST_ASSERT_EQUAL_FLOAT(1.0f, drift_compliances(&limb).tibia_share);
    TEST_ASSERT_TRUE(drift_compliances(&limb).shank_mm_per_n > 0.0f);
}

/* At a rate and a temperature for which a compliance would be negative, the force does not depend on the rate. */
static void test_joints_colder_than_any_show_no_rate(void)
{
    be(SAMPLE_PAPER, 0.3f, 0.5f);
    reading = (brace_drift_reading_t){
        .theta1_rad = 0.74f, .theta2_rad = 1.0f, .dx_mm = 0.5f, .dz_mm = 0.4f, .warmer_degc = -200.0f};
    const brace_stiffness_t k = model_k();
    const float none[DRIFT_OFFSETS] = {0.0f};
    drift_expected_t at;
    drift_expect(&limb, &k, &reading, none, 0.05f, &at);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, at.per_offset[0][DRIFT_THERMAL]);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, at.per_offset[1][DRIFT_THERMAL]);
}

/* Warm joints are softer, both by the same rate; the estimate is how far that rate is off. */
static void test_warmth_softens_both_joints(void)
{
    const float per_degc = 0.01f;
    for (int i = 0; i < 12; i++) {
        be(i % 2 == 0 ? SAMPLE_PAPER : SAMPLE_BEAM, 0.3f, 0.5f);
        reading = (brace_drift_reading_t){.theta1_rad = 0.74f,
                                          .theta2_rad = 1.0f,
                                          .dx_mm = 0.7f * cosf((float)i),
                                          .dz_mm = 0.7f * sinf((float)i),
                                          .warmer_degc = (float)(3 * (i % 5) - 6)};
        const brace_stiffness_t k = model_k();
        float offset[DRIFT_OFFSETS] = {0.0f};
        const float off[3] = {0.0f, 0.2f, -0.2f};
        double force_n[3][2];
        drift_expected_t at[3];
        for (int o = 0; o < 3; o++) {
            brace_limb_t warm = limb;
            const float softer = 1.0f + per_degc * reading.warmer_degc * (1.0f + off[o]);
            warm.joint[BRACE_FEMUR].compliance_rad_per_n_mm *= softer;
            warm.joint[BRACE_TIBIA].compliance_rad_per_n_mm *= softer;
            offset[DRIFT_THERMAL] = off[o];
            drift_expect(&limb, &k, &reading, offset, per_degc, &at[o]);
            force_of(&warm, 0.74, 1.0, force_n[o]);
            for (int axis = 0; axis < 2; axis++) {
                TEST_ASSERT_DOUBLE_WITHIN(1e-3, force_n[o][axis], (double)at[o].force_n[axis]);
            }
        }
        for (int axis = 0; axis < 2; axis++) {
            const double slope = (force_n[1][axis] - force_n[2][axis]) / 0.4;
            TEST_ASSERT_DOUBLE_WITHIN(3e-3 * (1.0 + fabs(slope)), slope, (double)at[0].per_offset[axis][DRIFT_THERMAL]);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_force_shifts_as_the_limb_s_own_K_does);
    RUN_TEST(test_a_softer_femur_is_that_limb);
    RUN_TEST(test_the_tibia_s_share);
    RUN_TEST(test_joints_colder_than_any_show_no_rate);
    RUN_TEST(test_warmth_softens_both_joints);
    return UNITY_END();
}
