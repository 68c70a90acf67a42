/* K under a load in the plane: floats and integers, which share no line, against one another. In space: against rows of
 * the double-precision reference. */
#include <math.h>
#include <string.h>

#include "even_limb.h"
#include "loaded_space_rows.h"
#include "unity.h"

void setUp(void)
{
    start_anew();
}

void tearDown(void) {}

/* --- floats and integers -------------------------------------------------------------------------------------- */

static double apart(float a, float b)
{
    return fabs((double)a - (double)b);
}

/* They share no line, but take the same steps, so that they are apart by the rounding of words alone,
 * whatever the load: 2^-26 of the limb's size, some hundreds of times that in K. The end of the search for the factor
 * is a parabola on determinants of other loads. */
static void test_in_the_plane_floats_and_integers_agree(void)
{
    int told = 0, factors = 0;
    state = 77u;
    for (int i = 0; i < 200 * TIMES; i++) {
        const double force_n = any(1.0, 60.0);
        be_even(i % 2 == 0 ? 0.1 : 0.3, force_n);
        const double down_rad = any(-3.2, 3.2), force_rad = any(-3.2, 3.2);
        load.down = (brace_vec_t){(float)cos(down_rad), (float)sin(down_rad)};
        brace_loaded_stiffness_t a, b;
        const brace_status_t status = status_in_plane(FLOATS, force_n * cos(force_rad), force_n * sin(force_rad), &a);
        if (status != BRACE_OK || a.buckling_factor < 2.0f || a.stiffness.flags != 0u) {
            continue;
        }
        TEST_ASSERT_EQUAL(BRACE_OK, status_in_plane(INTEGERS, force_n * cos(force_rad), force_n * sin(force_rad), &b));
        told++;
        const brace_stiffness_t *k = &a.stiffness, *l = &b.stiffness;
        const double within = 5e-6 * (double)k->lambda_max_n_per_mm, reach_mm = (double)(limb.femur_mm + limb.tibia_mm);
        TEST_ASSERT_DOUBLE_WITHIN(within, 0.0, apart(k->k_xx_n_per_mm, l->k_xx_n_per_mm));
        TEST_ASSERT_DOUBLE_WITHIN(within, 0.0, apart(k->k_xz_n_per_mm, l->k_xz_n_per_mm));
        TEST_ASSERT_DOUBLE_WITHIN(within, 0.0, apart(k->k_zz_n_per_mm, l->k_zz_n_per_mm));
        TEST_ASSERT_DOUBLE_WITHIN(within, 0.0, apart(k->lambda_min_n_per_mm, l->lambda_min_n_per_mm));
        TEST_ASSERT_DOUBLE_WITHIN(within, 0.0, apart(k->lambda_max_n_per_mm, l->lambda_max_n_per_mm));
        TEST_ASSERT_EQUAL_UINT32(k->flags, l->flags);
        TEST_ASSERT_DOUBLE_WITHIN(4e-6 * reach_mm, 0.0, apart(a.displacement.x_mm, b.displacement.x_mm));
        TEST_ASSERT_DOUBLE_WITHIN(4e-6 * reach_mm, 0.0, apart(a.displacement.z_mm, b.displacement.z_mm));
        TEST_ASSERT_DOUBLE_WITHIN(4e-6 * reach_mm, 0.0, apart(a.tibia_mm.x, b.tibia_mm.x));
        TEST_ASSERT_DOUBLE_WITHIN(4e-6 * reach_mm, 0.0, apart(a.tibia_mm.z, b.tibia_mm.z));
        TEST_ASSERT_DOUBLE_WITHIN(3e-6, 0.0, apart(a.hip_turn_rad, b.hip_turn_rad));
        TEST_ASSERT_DOUBLE_WITHIN(3e-6, 0.0, apart(a.knee_turn_rad, b.knee_turn_rad));
        if (i % 2 == 0 && a.buckling_factor < 10.0f) {
            factors++;
            TEST_ASSERT_DOUBLE_WITHIN(1e-3, 1.0, (double)(b.buckling_factor / a.buckling_factor));
        }
    }
    TEST_ASSERT_TRUE(told > 180 * TIMES && factors > 4 * TIMES);
}

/* --- limbs in space, by the reference ------------------------------------------------------------------------- */

static void be_row(const double *row)
{
    limb = sample_limb[SAMPLE_PAPER];
    limb.coxa_mm = (float)row[0], limb.femur_mm = (float)row[1], limb.tibia_mm = (float)row[2];
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        const double *of = row + 3 + 6 * i;
        limb.link[i] = (brace_link_t){.axial_mm_per_n = (float)of[0],
                                      .bending_mm_per_n = (float)of[1],
                                      .tilt_rad = (float)of[2],
                                      .lateral_mm_per_n = (float)of[3],
                                      .torsion_rad_per_n_mm = (float)of[4],
                                      .moment_transfer = (float)of[5]};
        limb.joint[i].compliance_rad_per_n_mm = (float)row[21 + i];
    }
    limb.base = (brace_base_t){(float)row[24], (float)row[25], (float)row[26]};
    weights = (brace_gravity_t){.femur_n = (float)row[27], .knee_n = (float)row[28], .tibia_n = (float)row[29]};
    space_load.down = (brace_vec3_t){(float)row[30], (float)row[31], (float)row[32]};
    theta1_rad = row[33], theta2_rad = row[34];
}

/* Links that bend, twist and stretch in parts, with weights, at one equilibrium: K and factor within what the headers
 * promise, and of four limbs in five within a tenth of that. */
static void test_limbs_in_space_are_those_of_the_reference(void)
{
    int near_k = 0, near_factor = 0;
    for (int i = 0; i < LOADED_SPACE_ROWS; i++) {
        const double *row = loaded_space_rows[i], *k = row + 38, *moved_mm = row + 44, trace = k[0] + k[3] + k[5];
        brace_space_result_t r;
        float factor;
        be_row(row);
        TEST_ASSERT_EQUAL(BRACE_OK, status_in_space(row + 35, &r, &factor));
        const double is_k[6] = {(double)r.k.xx_n_per_mm, (double)r.k.xy_n_per_mm, (double)r.k.xz_n_per_mm,
                                (double)r.k.yy_n_per_mm, (double)r.k.yz_n_per_mm, (double)r.k.zz_n_per_mm};
        double off = 0.0;
        for (int e = 0; e < 6; e++) {
            off = fmax(off, fabs(is_k[e] - k[e]) / trace);
        }
        TEST_ASSERT_DOUBLE_WITHIN(2e-3, 0.0, off);
        TEST_ASSERT_DOUBLE_WITHIN(0.25, moved_mm[0], (double)r.displacement_mm.x);
        TEST_ASSERT_DOUBLE_WITHIN(0.25, moved_mm[1], (double)r.displacement_mm.y);
        TEST_ASSERT_DOUBLE_WITHIN(0.25, moved_mm[2], (double)r.displacement_mm.z);
        TEST_ASSERT_DOUBLE_WITHIN(0.02 * row[47], row[47], (double)factor);
        near_k += off < 7e-4 ? 1 : 0;
        near_factor += fabs((double)factor / row[47] - 1.0) < 1e-3 ? 1 : 0;
    }
    TEST_ASSERT_GREATER_OR_EQUAL(LOADED_SPACE_ROWS * 4 / 5, near_k);
    TEST_ASSERT_GREATER_OR_EQUAL(LOADED_SPACE_ROWS * 4 / 5, near_factor);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_in_the_plane_floats_and_integers_agree);
    RUN_TEST(test_limbs_in_space_are_those_of_the_reference);
    return UNITY_END();
}
