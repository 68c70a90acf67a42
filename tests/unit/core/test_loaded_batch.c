/* K under a load in batches: each row as the single function gives it, NaN where that refuses. */
#include <math.h>
#include <string.h>

#include "brace/loaded_batch.h"
#include "sample_limbs.h"
#include "unity.h"

enum { ROWS = 5 };

static const float theta1_rad[ROWS] = {1.0f, 0.3f, -0.4f, -0.4f, NAN};
static const float theta2_rad[ROWS] = {1.4f, 0.6f, 2.0f, 2.0f, 1.0f};
static const float x_n[ROWS] = {0.0f, -20.0f, 3.0f, 0.0f, 0.0f};
static const float z_n[ROWS] = {10.0f, 0.0f, -5.0f, 5000.0f, 0.0f}; /* the fourth folds the limb */

void setUp(void) {}

void tearDown(void) {}

static void test_rows_are_the_single_function_s(void)
{
    const brace_gravity_t weights = {.femur_n = 2.0f, .knee_n = 1.0f, .tibia_n = 1.5f};
    const brace_limb_t *limb = &sample_limb[SAMPLE_BEAM];
    brace_loaded_t loaded;
    brace_loaded_collapse(limb, &weights, &loaded);
    const float hip = limb->joint[BRACE_FEMUR].compliance_rad_per_n_mm;
    const float knee = limb->joint[BRACE_TIBIA].compliance_rad_per_n_mm;
    brace_load_t load = {.tip = {1e3f, 1e3f}, .down = {0.0f, -1.0f}, .hip = {hip, hip}, .knee = {knee, knee}};
    brace_loaded_stiffness_t rows[ROWS], single;
    TEST_ASSERT_EQUAL(2, brace_loaded_batch(&loaded, &load, ROWS, theta1_rad, theta2_rad, x_n, z_n, rows));
    for (int i = 0; i < 3; i++) {
        load.tip = (brace_force_t){x_n[i], z_n[i]};
        TEST_ASSERT_EQUAL(BRACE_OK, brace_loaded_stiffness(&loaded, theta1_rad[i], theta2_rad[i], &load, &single));
        TEST_ASSERT_EQUAL_MEMORY(&single, &rows[i], sizeof single);
    }
    for (int i = 3; i < ROWS; i++) {
        TEST_ASSERT_TRUE(isnan(rows[i].stiffness.k_xx_n_per_mm) && isnan(rows[i].stiffness.stiff_axis_rad));
        TEST_ASSERT_TRUE(isnan(rows[i].stiffness.k_xz_n_per_mm) && isnan(rows[i].stiffness.k_zz_n_per_mm));
        TEST_ASSERT_TRUE(isnan(rows[i].stiffness.lambda_min_n_per_mm) && isnan(rows[i].stiffness.lambda_max_n_per_mm));
        TEST_ASSERT_TRUE(isnan(rows[i].displacement.x_mm) && isnan(rows[i].displacement.z_mm));
        TEST_ASSERT_TRUE(isnan(rows[i].tibia_mm.x) && isnan(rows[i].tibia_mm.z));
        TEST_ASSERT_TRUE(isnan(rows[i].hip_turn_rad) && isnan(rows[i].knee_turn_rad));
        TEST_ASSERT_TRUE(isnan(rows[i].buckling_factor));
        /* No rest, as a controller flags it; and an input that is none. */
        TEST_ASSERT_EQUAL_HEX32(i == 3 ? BRACE_FLAG_NEAR_SINGULAR | BRACE_FLAG_SOFTENED : 0u, rows[i].stiffness.flags);
    }
}

/* A row near its buckling, and one whose tip has moved by more than a tenth of the limb, say so; the rest do not. */
static void test_rows_are_flagged_as_the_controller_does(void)
{
    const brace_gravity_t weightless = {.femur_n = 0.0f};
    brace_limb_t limb = sample_limb[SAMPLE_PAPER];
    limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = 1e-5f;
    brace_loaded_t loaded;
    brace_loaded_collapse(&limb, &weightless, &loaded);
    brace_load_t load = {.down = {0.0f, -1.0f}, .hip = {1e-5f, 1e-5f}, .knee = {1e-5f, 1e-5f}};
    enum { FORCES = 60 };
    brace_loaded_stiffness_t rows[FORCES], single;
    float one_rad[FORCES], two_rad[FORCES], along_n[FORCES], up_n[FORCES];
    uint32_t flagged = 0, plain = 0, moved_only = 0;
    for (int i = 0; i < FORCES; i++) {
        /* The force pushes a stretched limb, or it pulls a bent limb, which does not soften the limb. */
        const bool is_pushed = i < 30;
        one_rad[i] = is_pushed ? 0.3f : 0.5f, two_rad[i] = is_pushed ? 0.6f : 2.0f;
        along_n[i] = is_pushed ? -4.0f * (float)i : 3.0f * (float)(i - 30);
        up_n[i] = 0.0f;
    }
    (void)brace_loaded_batch(&loaded, &load, FORCES, one_rad, two_rad, along_n, up_n, rows);
    for (int i = 0; i < FORCES; i++) {
        load.tip = (brace_force_t){along_n[i], up_n[i]};
        if (brace_loaded_stiffness(&loaded, one_rad[i], two_rad[i], &load, &single) == BRACE_OK) {
            const float x_mm = single.displacement.x_mm, z_mm = single.displacement.z_mm;
            const uint32_t wanted =
                single.stiffness.flags |
                brace_loaded_flags(single.buckling_factor, x_mm * x_mm + z_mm * z_mm, 185.0f + 313.5f);
            TEST_ASSERT_EQUAL_HEX32(wanted, rows[i].stiffness.flags);
            flagged += wanted != 0u, plain += wanted == 0u;
            moved_only += wanted != 0u && brace_loaded_flags(single.buckling_factor, 0.0f, 185.0f + 313.5f) == 0u &&
                          single.stiffness.flags == 0u;
        }
    }
    TEST_ASSERT_TRUE(flagged > 2u && plain > 2u && moved_only > 2u);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_rows_are_the_single_function_s);
    RUN_TEST(test_rows_are_flagged_as_the_controller_does);
    return UNITY_END();
}
