/* Tests of the bounds of the three paths under a load, each at the bound, just within and just beyond: angles, force,
 * how far a force may turn the limb, the least resistance, and the smallest ratio of K's eigenvalues.
 * The three paths refuse the same inputs. */
#include <math.h>
#include <string.h>

#include "brace/loaded.h"
#include "brace/loaded_fixed.h"
#include "brace/loaded_space.h"
#include "sample_limbs.h"
#include "unity.h"

typedef enum { PLANE, PLANE_INTEGERS, SPACE, PATHS } path_t;

static brace_limb_t limb;
static brace_gravity_t weights;
static brace_vec3_t tip_n, down;
static float theta1_rad, theta2_rad, hip_turn_rad;
static uint32_t flags;

void setUp(void)
{
    limb = sample_limb[SAMPLE_BEAM];
    memset(&weights, 0, sizeof weights);
    tip_n = (brace_vec3_t){0.0f, 0.0f, 0.0f};
    down = (brace_vec3_t){0.0f, 0.0f, -1.0f};
    theta1_rad = 1.0f, theta2_rad = 1.4f;
}

void tearDown(void) {}

static brace_loaded_joint_t spring_of(int joint)
{
    const float yields = limb.joint[joint].compliance_rad_per_n_mm;
    return (brace_loaded_joint_t){yields, yields};
}

static brace_status_t status_in_plane(bool is_fixed)
{
    brace_loaded_t loaded;
    brace_loaded_fixed_t fixed;
    brace_loaded_stiffness_t result;
    const brace_load_t load = {.tip = {tip_n.x, tip_n.z},
                               .down = {down.x, down.z},
                               .hip = spring_of(BRACE_FEMUR),
                               .knee = spring_of(BRACE_TIBIA)};
    brace_loaded_collapse(&limb, &weights, &loaded);
    brace_loaded_fixed_collapse(&loaded, &fixed);
    const brace_status_t status = is_fixed
                                      ? brace_loaded_fixed_stiffness(&fixed, theta1_rad, theta2_rad, &load, &result)
                                      : brace_loaded_stiffness(&loaded, theta1_rad, theta2_rad, &load, &result);
    if (status == BRACE_OK) {
        hip_turn_rad = result.hip_turn_rad, flags = result.stiffness.flags;
    }
    return status;
}

static brace_status_t status_in_space(void)
{
    brace_loaded_space_t loaded;
    brace_space_rest_t rest;
    brace_space_result_t result;
    const brace_space_load_t load = {.tip_n = tip_n,
                                     .down = down,
                                     .yaw = spring_of(BRACE_COXA),
                                     .hip = spring_of(BRACE_FEMUR),
                                     .knee = spring_of(BRACE_TIBIA)};
    brace_loaded_space_collapse(&limb, &weights, &loaded);
    brace_status_t status = brace_loaded_space_settle(&loaded, theta1_rad, theta2_rad, &load, &rest);
    if (status == BRACE_OK) {
        status = brace_loaded_space_stiffness(&loaded, &rest, &result);
    }
    if (status == BRACE_OK) {
        hip_turn_rad = result.hip_turn_rad;
    }
    return status;
}

static brace_status_t status_of(path_t path)
{
    return path == SPACE ? status_in_space() : status_in_plane(path == PLANE_INTEGERS);
}

/* So stiff that a force of 10 kN moves it by a tenth of a millimetre. */
static void be_stiff(void)
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        brace_link_t *link = &limb.link[i];
        link->axial_mm_per_n *= 1e-4f, link->bending_mm_per_n *= 1e-4f, link->lateral_mm_per_n *= 1e-4f;
        link->torsion_rad_per_n_mm *= 1e-4f;
        limb.joint[i].compliance_rad_per_n_mm = 1e-10f;
    }
    limb.base = (brace_base_t){1e-6f, 1e-6f, 1e-10f};
}

static void test_angles_up_to_their_bound(void)
{
    /* at 5 and the root of 6 the sum of the squares is 31 */
    static const float at[][3] = {{5.0f, 2.4494f, 2.4496f}, {2.0f, 5.1961f, 5.1963f}, {0.0f, 5.5677f, 5.5679f}};
    be_stiff();
    for (int path = 0; path < PATHS; path++) {
        for (uint32_t i = 0; i < 3u * 8u; i++) {
            const float *angle = at[i / 8u], first = (i & 1u) != 0u ? -angle[0] : angle[0];
            const float sign = (i & 2u) != 0u ? -1.0f : 1.0f;
            const bool is_swapped = (i & 4u) != 0u;
            for (int beyond = 0; beyond < 2; beyond++) {
                const float second = sign * angle[1 + beyond];
                theta1_rad = is_swapped ? second : first, theta2_rad = is_swapped ? first : second;
                const brace_status_t status = status_of((path_t)path);
                TEST_ASSERT_EQUAL(beyond != 0, status == BRACE_E_RANGE);
            }
        }
    }
}

/* The magnitudes of the force's parts add up to 10 kN. The next float above is 2^-10 N more. */
static void test_forces_up_to_their_bound(void)
{
    be_stiff();
    for (int path = 0; path < PATHS; path++) {
        const bool is_space = path == SPACE;
        for (uint32_t sign = 0; sign < 8u; sign++) {
            for (int beyond = 0; beyond < 2; beyond++) {
                float *const part[] = {&tip_n.x, &tip_n.y, &tip_n.z};
                static const float share_n[] = {5000.0f, 1500.0f, 3500.0f};
                for (uint32_t axis = 0; axis < 3u; axis++) {
                    const float whole_n = share_n[axis] + (axis == 0u && !is_space ? 1500.0f : 0.0f);
                    *part[axis] = (sign >> axis & 1u) != 0u ? -whole_n : whole_n;
                }
                tip_n.y = is_space ? tip_n.y : 0.0f;
                tip_n.x += beyond != 0 ? copysignf(0.001f, tip_n.x) : 0.0f;
                TEST_ASSERT_EQUAL(beyond != 0 ? BRACE_E_RANGE : BRACE_OK, status_of((path_t)path));
            }
        }
    }
}

/* The integer path also checks the direction, which must not be longer than a unit vector. It allows a thousandth for
 * rounding. */
static void test_directions_up_to_their_bound(void)
{
    const float most = 1.0f + 0x1p-10f, beyond = 1.0f + 0x1p-10f + 0x1p-23f;
    be_stiff();
    for (int i = 0; i < 4; i++) {
        float *const part[] = {&down.x, &down.z};
        const float sign = i % 2 == 0 ? 1.0f : -1.0f;
        down = (brace_vec3_t){0.0f, 0.0f, 0.0f};
        *part[i / 2] = sign * most;
        TEST_ASSERT_EQUAL(BRACE_OK, status_of(PLANE_INTEGERS));
        *part[i / 2] = sign * beyond;
        TEST_ASSERT_EQUAL(BRACE_E_RANGE, status_of(PLANE_INTEGERS));
    }
}

/* A limb of rigid links, stretched out; only its hip joint yields, by c. returns the lever */
static float only_the_hip_yields(float c)
{
    limb.base = (brace_base_t){0.0f, 0.0f, 0.0f};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        limb.link[i] = (brace_link_t){.axial_mm_per_n = 1e-4f, .bending_mm_per_n = 1e-4f, .lateral_mm_per_n = 1e-4f};
        limb.joint[i].compliance_rad_per_n_mm = i == BRACE_FEMUR ? c : 0.0f;
    }
    theta1_rad = theta2_rad = 0.0f;
    return limb.femur_mm + limb.tibia_mm;
}

/* One hinge under a force that would turn it by `whole` if the force stayed across the link. It does not: the hinge
 * turns by q = whole cos q, up to a quarter turn. Two steps of Newton's method from no turn find the small turns, four
 * the large ones. In integers the compliance with the load has to fit its word. */
static void test_in_the_plane_the_steps_find_how_far_a_force_turns_a_hinge(void)
{
    const float c = 1e-5f, lever = only_the_hip_yields(c);
    for (int is_fixed = 0; is_fixed < 2; is_fixed++) {
        for (int i = 1; i <= 60; i++) {
            const double whole = (is_fixed != 0 ? 0.01 : 0.05) * i;
            double less = 0.0, more = 1.6; /* whole cos q - q falls */
            for (int halving = 0; halving < 40; halving++) {
                const double q = 0.5 * (less + more);
                *(whole * cos(q) > q ? &less : &more) = q;
            }
            tip_n.z = (float)whole / (c * lever);
            TEST_ASSERT_EQUAL(BRACE_OK, status_in_plane(is_fixed != 0));
            TEST_ASSERT_FLOAT_WITHIN(5e-3f, (float)less, hip_turn_rad);
        }
    }
}

/* A hinge is pressed along its link by a share of its buckling force. It keeps the rest, 1 - share, of its stiffness.
 * The float paths refuse a rest below a thousandth. The integer path refuses where the inverse of the rest does not fit
 * into its word, at the latest below a sixteenth. */
static void test_what_resists_no_more_is_refused(void)
{
    const float c = 1e-5f, lever = only_the_hip_yields(c), buckles_n = 1.0f / (c * lever);
    for (int path = 0; path < PATHS; path++) {
        const bool is_fixed = path == PLANE_INTEGERS;
        tip_n.x = -buckles_n * (1.0f - (is_fixed ? 0.5f : 0.0015f));
        TEST_ASSERT_EQUAL(BRACE_OK, status_of((path_t)path));
        tip_n.x = -buckles_n * (1.0f - (is_fixed ? 0.06f : 0.0005f));
        TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, status_of((path_t)path));
        tip_n.x = -buckles_n * 1.5f;
        TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, status_of((path_t)path));
    }
}

/* K whose eigenvalues are 1, 1 and a small one, in turn along each axis. */
static brace_k3_t slender_k(int axis, float least)
{
    return (brace_k3_t){axis == 0 ? least : 1.0f, 0.0f, 0.0f, axis == 1 ? least : 1.0f, 0.0f, axis == 2 ? least : 1.0f};
}

static brace_status_t turned(float theta0_rad, const brace_k3_t *k)
{
    brace_stiffness_spatial_t s;
    const brace_status_t status = brace_loaded_space_turn(theta0_rad, k, &s);
    flags = status == BRACE_OK ? s.flags : 0u;
    return status;
}

static brace_status_t put_in_plane(const brace_k3_t *k)
{
    brace_stiffness_t s;
    const brace_status_t status = brace_loaded_space_in_plane(k, &s);
    flags = status == BRACE_OK ? s.flags : 0u;
    return status;
}

/* In space the bound is on the least eigenvalue over the largest one, 1e-4. In the plane the bound is on the
 * determinant over the squared mean, 2e-5, which is an eigenvalue of 5e-6 here. */
static void test_slender_K_is_flagged_from_its_bound_on(void)
{
    for (int axis = 0; axis < 3; axis++) {
        const brace_k3_t sound = slender_k(axis, 1.003e-4f), slender = slender_k(axis, 0.997e-4f);
        TEST_ASSERT_EQUAL(BRACE_OK, turned(0.3f, &sound));
        TEST_ASSERT_EQUAL_UINT32(0u, flags);
        TEST_ASSERT_EQUAL(BRACE_OK, turned(0.3f, &slender));
        TEST_ASSERT_EQUAL_UINT32(BRACE_FLAG_NEAR_SINGULAR, flags);
    }
    for (int axis = 0; axis < 3; axis += 2) {
        const float near = 0.02e-6f;
        const brace_k3_t sound = slender_k(axis, 5e-6f + near), slender = slender_k(axis, 5e-6f - near);
        TEST_ASSERT_EQUAL(BRACE_OK, put_in_plane(&sound));
        TEST_ASSERT_EQUAL_UINT32(0u, flags);
        TEST_ASSERT_EQUAL(BRACE_OK, put_in_plane(&slender));
        TEST_ASSERT_EQUAL_UINT32(BRACE_FLAG_NEAR_SINGULAR, flags);
    }
}

/* K that is nothing in one direction of the plane, or less, has no eigenvalues to tell there. */
static void test_K_that_is_flat_in_the_plane_is_refused(void)
{
    for (int axis = 0; axis < 3; axis += 2) {
        const brace_k3_t told = slender_k(axis, 1e-8f), flat = slender_k(axis, 0.0f), unstable = slender_k(axis, -0.5f);
        TEST_ASSERT_EQUAL(BRACE_OK, put_in_plane(&told));
        TEST_ASSERT_EQUAL_UINT32(BRACE_FLAG_NEAR_SINGULAR, flags);
        TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, put_in_plane(&flat));
        TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, put_in_plane(&unstable));
    }
}

/* K in the plane, the tip held across it: its own entries, and their eigenvalues and stiff axis. */
static void test_K_in_the_plane_is_what_space_has_there(void)
{
    for (int i = 0; i < 60; i++) {
        const double stiff = 3.0 + 0.1 * i, soft = stiff * pow(10.0, -0.05 * (i % 40)), axis_rad = -1.5 + 0.05 * i;
        const double c = cos(axis_rad), s = sin(axis_rad);
        const brace_k3_t k = {.xx_n_per_mm = (float)(stiff * c * c + soft * s * s),
                              .xz_n_per_mm = (float)((stiff - soft) * c * s),
                              .zz_n_per_mm = (float)(stiff * s * s + soft * c * c),
                              .xy_n_per_mm = 0.3f,
                              .yy_n_per_mm = 7.0f,
                              .yz_n_per_mm = -0.2f};
        brace_stiffness_t plane;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_loaded_space_in_plane(&k, &plane));
        TEST_ASSERT_EQUAL_FLOAT(k.xx_n_per_mm, plane.k_xx_n_per_mm);
        TEST_ASSERT_EQUAL_FLOAT(k.xz_n_per_mm, plane.k_xz_n_per_mm);
        TEST_ASSERT_EQUAL_FLOAT(k.zz_n_per_mm, plane.k_zz_n_per_mm);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * stiff, stiff, (double)plane.lambda_max_n_per_mm);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * stiff, soft, (double)plane.lambda_min_n_per_mm);
        if (soft < 0.9 * stiff) {
            TEST_ASSERT_DOUBLE_WITHIN(5e-6, 0.0, sin((double)plane.stiff_axis_rad - axis_rad));
        }
        TEST_ASSERT_EQUAL_UINT32(0u, plane.flags);
    }
}

static void test_turning_up_to_its_bound(void)
{
    const brace_k3_t k = slender_k(0, 0.5f);
    for (float sign = -1.0f; sign <= 1.0f; sign += 2.0f) {
        TEST_ASSERT_EQUAL(BRACE_OK, turned(sign * 7.8999f, &k));
        TEST_ASSERT_EQUAL(BRACE_E_RANGE, turned(sign * 7.9001f, &k));
        TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, turned(sign * INFINITY, &k));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_angles_up_to_their_bound);
    RUN_TEST(test_forces_up_to_their_bound);
    RUN_TEST(test_directions_up_to_their_bound);
    RUN_TEST(test_in_the_plane_the_steps_find_how_far_a_force_turns_a_hinge);
    RUN_TEST(test_what_resists_no_more_is_refused);
    RUN_TEST(test_slender_K_is_flagged_from_its_bound_on);
    RUN_TEST(test_K_that_is_flat_in_the_plane_is_refused);
    RUN_TEST(test_K_in_the_plane_is_what_space_has_there);
    RUN_TEST(test_turning_up_to_its_bound);
    return UNITY_END();
}
