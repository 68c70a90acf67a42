/* What every elastic limb under a load obeys, asked of the four paths, in the plane and in space, of floats and of
 * integers: K is the slope of the force over the tip's place; what a weight at the knee does to the tip, a force at the
 * tip does to the knee; limbs of hinges stand where their moments balance; a straight limb buckles at the load that its
 * energy names, whatever load it is asked at. None of it knows how the paths reckon. */
#include <math.h>
#include <string.h>

#include "brace/loaded.h"
#include "brace/loaded_fixed.h"
#include "brace/loaded_space.h"
#include "brace/loaded_space_fixed.h"
#include "sample_limbs.h"
#include "unity.h"

typedef enum { FLOATS, INTEGERS, PATHS } path_t;

static brace_limb_t limb;
static brace_gravity_t weights;
static brace_load_t load;
static brace_space_load_t space_load;
static double theta1_rad, theta2_rad;

void setUp(void)
{
    limb = sample_limb[SAMPLE_PAPER];
    memset(&weights, 0, sizeof weights);
    load = (brace_load_t){.down = {0.0f, -1.0f}};
    space_load = (brace_space_load_t){.down = {0.0f, 0.0f, -1.0f}};
    theta1_rad = theta2_rad = 0.0;
}

void tearDown(void) {}

static brace_loaded_joint_t spring_of(int joint)
{
    const float yields = limb.joint[joint].compliance_rad_per_n_mm;
    return (brace_loaded_joint_t){yields, yields};
}

/* In the plane. */
static brace_status_t status_in_plane(path_t path, double x_n, double z_n, brace_loaded_stiffness_t *result)
{
    brace_loaded_t loaded;
    brace_loaded_fixed_t fixed;
    load.tip = (brace_force_t){(float)x_n, (float)z_n};
    load.hip = spring_of(BRACE_FEMUR);
    load.knee = spring_of(BRACE_TIBIA);
    brace_loaded_collapse(&limb, &weights, &loaded);
    if (path == FLOATS) {
        return brace_loaded_stiffness(&loaded, (float)theta1_rad, (float)theta2_rad, &load, result);
    }
    brace_loaded_fixed_collapse(&loaded, &fixed);
    return brace_loaded_fixed_stiffness(&fixed, (float)theta1_rad, (float)theta2_rad, &load, result);
}

static brace_loaded_stiffness_t in_plane(path_t path, double x_n, double z_n)
{
    brace_loaded_stiffness_t result;
    memset(&result, 0, sizeof result);
    TEST_ASSERT_EQUAL(BRACE_OK, status_in_plane(path, x_n, z_n, &result));
    return result;
}

/* In space. factor may be NULL. */
static brace_status_t status_in_space(path_t path, const double force_n[3], brace_space_result_t *result, float *factor)
{
    brace_loaded_space_t loaded;
    space_load.tip_n = (brace_vec3_t){(float)force_n[0], (float)force_n[1], (float)force_n[2]};
    space_load.yaw = spring_of(BRACE_COXA);
    space_load.hip = spring_of(BRACE_FEMUR);
    space_load.knee = spring_of(BRACE_TIBIA);
    brace_loaded_space_collapse(&limb, &weights, &loaded);
    if (path == FLOATS) {
        brace_space_rest_t rest;
        brace_status_t status =
            brace_loaded_space_settle(&loaded, (float)theta1_rad, (float)theta2_rad, &space_load, &rest);
        status = status == BRACE_OK ? brace_loaded_space_stiffness(&loaded, &rest, result) : status;
        if (status == BRACE_OK && factor != NULL) {
            *factor = brace_loaded_space_buckling_factor(&loaded, &rest);
        }
        return status;
    }
    brace_loaded_space_fixed_t fixed;
    brace_space_fixed_rest_t rest;
    brace_loaded_space_fixed_collapse(&loaded, &fixed);
    brace_status_t status =
        brace_loaded_space_fixed_settle(&fixed, (float)theta1_rad, (float)theta2_rad, &space_load, &rest);
    status = status == BRACE_OK ? brace_loaded_space_fixed_stiffness(&fixed, &rest, result) : status;
    if (status == BRACE_OK && factor != NULL) {
        brace_buckling_search_t search;
        brace_loaded_space_fixed_buckling_begin(&search);
        while (!brace_loaded_space_fixed_buckling_step(&fixed, &rest, &search, factor)) {
        }
    }
    return status;
}

static brace_space_result_t in_space(path_t path, const double force_n[3], float *factor)
{
    brace_space_result_t result;
    memset(&result, 0, sizeof result);
    TEST_ASSERT_EQUAL(BRACE_OK, status_in_space(path, force_n, &result, factor));
    return result;
}

/* --- K is a slope --------------------------------------------------------------------------------------------- */

/* Step of the differences. Their formula is exact up to the fourth power of the step. */
static const double step_n = 2.0;

static double slope_of(const double at[4])
{
    return (8.0 * (at[0] - at[1]) - (at[2] - at[3])) / (12.0 * step_n);
}

static const double steps[4] = {1.0, -1.0, 2.0, -2.0};

/* One of the sample limbs, with everything that a limb may have, at one of many postures. */
static void any_limb(int sample, int i)
{
    limb = sample_limb[sample];
    limb.base = (brace_base_t){0.02f, 0.01f, 2e-6f};
    limb.link[BRACE_TIBIA].moment_transfer_ratio = i % 3 == 0 ? 0.7f : 0.0f;
    weights = (brace_gravity_t){.femur_n = 1.0f, .knee_n = 0.5f, .tibia_n = 0.7f};
    load.down = (brace_vec_t){0.3f, -0.9f};
    space_load.down = (brace_vec3_t){0.3f, 0.4f, -0.8f};
    theta1_rad = -1.2 + 0.3 * i;
    theta2_rad = 0.5 + 0.4 * (i % 5);
}

/* Places are floats of up to 600 mm: rounded to 3e-5 mm, they make 3e-5 mm/N of a difference over 2 N at worst, where
 * the limbs yield by 0.2 mm/N and more in all. */
static void test_in_the_plane_K_is_the_slope_of_the_force(void)
{
    for (int i = 0; i < 12 * SAMPLE_COUNT * PATHS; i++) {
        const path_t path = (path_t)(i % PATHS);
        any_limb(i / PATHS % SAMPLE_COUNT, i / PATHS / SAMPLE_COUNT);
        const double x_n = 8.0 * cos(0.7 * i), z_n = 8.0 * sin(0.7 * i);
        const brace_stiffness_t k = in_plane(path, x_n, z_n).stiffness;
        const double xx = (double)k.k_xx_n_per_mm, xz = (double)k.k_xz_n_per_mm, zz = (double)k.k_zz_n_per_mm;
        const double det = xx * zz - xz * xz, c[2][2] = {{zz / det, -xz / det}, {-xz / det, xx / det}};
        for (int axis = 0; axis < 2; axis++) {
            double x_mm[4], z_mm[4];
            for (int s = 0; s < 4; s++) {
                const double by_n = step_n * steps[s];
                const brace_displacement_t d =
                    in_plane(path, x_n + (axis == 0 ? by_n : 0.0), z_n + (axis == 1 ? by_n : 0.0)).displacement;
                x_mm[s] = (double)d.x_mm, z_mm[s] = (double)d.z_mm;
            }
            const double within = 1.5e-4 * (c[0][0] + c[1][1]);
            TEST_ASSERT_DOUBLE_WITHIN(within, c[0][axis], slope_of(x_mm));
            TEST_ASSERT_DOUBLE_WITHIN(within, c[1][axis], slope_of(z_mm));
        }
    }
}

static void inverse_of(const brace_k3_t *k, double c[3][3])
{
    const double a[3][3] = {{(double)k->xx_n_per_mm, (double)k->xy_n_per_mm, (double)k->xz_n_per_mm},
                            {(double)k->xy_n_per_mm, (double)k->yy_n_per_mm, (double)k->yz_n_per_mm},
                            {(double)k->xz_n_per_mm, (double)k->yz_n_per_mm, (double)k->zz_n_per_mm}};
    double det = 0.0;
    for (int p = 0; p < 3; p++) {
        for (int q = 0; q < 3; q++) {
            const int p1 = (p + 1) % 3, p2 = (p + 2) % 3, q1 = (q + 1) % 3, q2 = (q + 2) % 3;
            c[p][q] = a[p1][q1] * a[p2][q2] - a[p1][q2] * a[p2][q1];
        }
        det += p == 0 ? a[0][0] * c[0][0] + a[0][1] * c[0][1] + a[0][2] * c[0][2] : 0.0;
    }
    for (int p = 0; p < 9; p++) {
        c[p / 3][p % 3] /= det;
    }
}

/* In space two steps leave more of what bends and turns at once: the square of a turn of some hundredths. */
static void test_in_space_K_is_the_slope_of_the_force(void)
{
    for (int i = 0; i < 12 * SAMPLE_COUNT * PATHS; i++) {
        const path_t path = (path_t)(i % PATHS);
        any_limb(i / PATHS % SAMPLE_COUNT, i / PATHS / SAMPLE_COUNT);
        const double force_n[3] = {2.4 * cos(0.7 * i), 1.5 * sin(1.3 * i), 2.4 * sin(0.7 * i)};
        const brace_k3_t k = in_space(path, force_n, NULL).k;
        double c[3][3];
        inverse_of(&k, c);
        const double within = 6e-4 * (c[0][0] + c[1][1] + c[2][2]);
        for (int axis = 0; axis < 3; axis++) {
            double moved_mm[3][4];
            for (int s = 0; s < 4; s++) {
                double near_n[3] = {force_n[0], force_n[1], force_n[2]};
                near_n[axis] += step_n * steps[s];
                const brace_vec3_t d = in_space(path, near_n, NULL).displacement_mm;
                moved_mm[0][s] = (double)d.x, moved_mm[1][s] = (double)d.y, moved_mm[2][s] = (double)d.z;
            }
            for (int p = 0; p < 3; p++) {
                TEST_ASSERT_DOUBLE_WITHIN(within, c[p][axis], slope_of(moved_mm[p]));
            }
        }
    }
}

/* --- a weight at the knee ------------------------------------------------------------------------------------- */

static double along_down(double x_mm, double y_mm, double z_mm)
{
    const brace_vec3_t down = space_load.down;
    return (double)down.x * x_mm + (double)down.y * y_mm + (double)down.z * z_mm;
}

/* Maxwell: a newton more at the knee moves the tip along an axis as far as a newton more at the tip along that axis
 * moves the knee where the knee's weight pulls. */
static void test_in_the_plane_the_knee_s_weight_is_a_force_there(void)
{
    for (int i = 0; i < 12 * PATHS; i++) {
        const path_t path = (path_t)(i % PATHS);
        any_limb(i / PATHS % SAMPLE_COUNT, i / PATHS);
        space_load.down = (brace_vec3_t){load.down.x, 0.0f, load.down.z};
        weights.knee_n = 5.0f;
        const double x_n = 5.0 * cos(0.9 * i), z_n = 5.0 * sin(0.9 * i);
        double by_weight_mm[2][4];
        for (int s = 0; s < 4; s++) {
            weights.knee_n = 5.0f + (float)(step_n * steps[s]);
            const brace_displacement_t d = in_plane(path, x_n, z_n).displacement;
            by_weight_mm[0][s] = (double)d.x_mm, by_weight_mm[1][s] = (double)d.z_mm;
        }
        weights.knee_n = 5.0f;
        const brace_stiffness_t k = in_plane(path, x_n, z_n).stiffness;
        const double within = 2e-4 * (1.0 / (double)k.lambda_min_n_per_mm);
        for (int axis = 0; axis < 2; axis++) {
            double knee_mm[4];
            for (int s = 0; s < 4; s++) {
                const double by_n = step_n * steps[s];
                const brace_loaded_stiffness_t r =
                    in_plane(path, x_n + (axis == 0 ? by_n : 0.0), z_n + (axis == 1 ? by_n : 0.0));
                knee_mm[s] = along_down((double)r.displacement.x_mm - (double)r.tibia_mm.x, 0.0,
                                        (double)r.displacement.z_mm - (double)r.tibia_mm.z);
            }
            TEST_ASSERT_DOUBLE_WITHIN(within, slope_of(knee_mm), slope_of(by_weight_mm[axis]));
        }
    }
}

static void test_in_space_the_knee_s_weight_is_a_force_there(void)
{
    for (int i = 0; i < 12 * PATHS; i++) {
        const path_t path = (path_t)(i % PATHS);
        any_limb(i / PATHS % SAMPLE_COUNT, i / PATHS);
        const double force_n[3] = {2.4 * cos(0.7 * i), 1.5 * sin(1.3 * i), 2.4 * sin(0.7 * i)};
        double by_weight_mm[3][4], size = 0.0;
        for (int s = 0; s < 4; s++) {
            weights.knee_n = 5.0f + (float)(step_n * steps[s]);
            const brace_vec3_t d = in_space(path, force_n, NULL).displacement_mm;
            by_weight_mm[0][s] = (double)d.x, by_weight_mm[1][s] = (double)d.y, by_weight_mm[2][s] = (double)d.z;
        }
        weights.knee_n = 5.0f;
        const brace_k3_t k = in_space(path, force_n, NULL).k;
        double c[3][3];
        inverse_of(&k, c);
        size = c[0][0] + c[1][1] + c[2][2];
        for (int axis = 0; axis < 3; axis++) {
            double knee_mm[4];
            for (int s = 0; s < 4; s++) {
                double near_n[3] = {force_n[0], force_n[1], force_n[2]};
                near_n[axis] += step_n * steps[s];
                const brace_space_result_t r = in_space(path, near_n, NULL);
                knee_mm[s] = along_down((double)r.displacement_mm.x - (double)r.tibia_mm.x,
                                        (double)r.displacement_mm.y - (double)r.tibia_mm.y,
                                        (double)r.displacement_mm.z - (double)r.tibia_mm.z);
            }
            TEST_ASSERT_DOUBLE_WITHIN(6e-4 * size, slope_of(knee_mm), slope_of(by_weight_mm[axis]));
        }
    }
}

/* --- limbs of two hinges -------------------------------------------------------------------------------------- */

/* Rigid links whose joints yield, with a weight at the knee and one in each link's middle: its equilibrium, K and
 * buckling factor in double precision, from its energy. */
typedef struct {
    double turn[2], tip_mm[2], tibia_mm[2], k[3], factor;
} hinged_t;

static hinged_t hinged(double hip_c, double knee_c, double x_n, double z_n)
{
    const double l1 = (double)limb.femur_mm, l2 = (double)limb.tibia_mm;
    const double down_x = (double)load.down.x, down_z = (double)load.down.z;
    const double on_tibia = 0.5 * (double)weights.tibia_n, at_knee = (double)weights.knee_n + (double)weights.tibia_n;
    const double on_femur = at_knee + 0.5 * (double)weights.femur_n;
    /* forces that act at the ends of the femur and of the tibia, each times its link's length */
    const double f1x = l1 * (x_n + on_femur * down_x), f1z = l1 * (z_n + on_femur * down_z);
    const double f2x = l2 * (x_n + on_tibia * down_x), f2z = l2 * (z_n + on_tibia * down_z);
    double q1 = 0.0, q2 = 0.0, h11 = 0.0, h12 = 0.0, h22 = 0.0, g1 = 0.0, g2 = 0.0;
    hinged_t r;
    for (int step = 0; step < 60; step++) {
        const double a = theta1_rad + q1, b = theta1_rad - theta2_rad + q1 + q2;
        g1 = f1x * cos(a) + f1z * sin(a), g2 = f2x * cos(b) + f2z * sin(b); /* what resists */
        const double d1 = f1z * cos(a) - f1x * sin(a), d2 = f2z * cos(b) - f2x * sin(b);
        h11 = 1.0 / hip_c + g1 + g2, h12 = g2, h22 = 1.0 / knee_c + g2;
        const double off1 = d1 + d2 - q1 / hip_c, off2 = d2 - q2 / knee_c, det = h11 * h22 - h12 * h12;
        q1 += (h22 * off1 - h12 * off2) / det, q2 += (h11 * off2 - h12 * off1) / det;
    }
    const double a = theta1_rad + q1, b = theta1_rad - theta2_rad + q1 + q2, start = theta1_rad - theta2_rad;
    r.turn[0] = q1, r.turn[1] = q2;
    r.tibia_mm[0] = l2 * cos(b), r.tibia_mm[1] = l2 * sin(b);
    r.tip_mm[0] = l1 * (cos(a) - cos(theta1_rad)) + l2 * (cos(b) - cos(start));
    r.tip_mm[1] = l1 * (sin(a) - sin(theta1_rad)) + l2 * (sin(b) - sin(start));
    const double j1x = -l1 * sin(a) - l2 * sin(b), j1z = l1 * cos(a) + l2 * cos(b), j2x = -l2 * sin(b);
    const double j2z = l2 * cos(b), det_j = j1x * j2z - j1z * j2x;
    /* K = J^-T H J^-1 */
    const double u1 = j2z / det_j, u2 = -j1z / det_j, v1 = -j2x / det_j, v2 = j1x / det_j;
    r.k[0] = u1 * u1 * h11 + 2.0 * u1 * u2 * h12 + u2 * u2 * h22;
    r.k[1] = u1 * v1 * h11 + (u1 * v2 + u2 * v1) * h12 + u2 * v2 * h22;
    r.k[2] = v1 * v1 * h11 + 2.0 * v1 * v2 * h12 + v2 * v2 * h22;
    /* (1 + s hip_c (g1 + g2)) (1 + s knee_c g2) = s^2 hip_c knee_c g2^2 */
    const double linear = hip_c * (g1 + g2) + knee_c * g2, square = hip_c * knee_c * g1 * g2;
    const double root = sqrt(fmax(linear * linear - 4.0 * square, 0.0));
    const double one = 2.0 / (-linear + root), other = 2.0 / (-linear - root);
    r.factor = one > 0.0 && (other <= 0.0 || one < other) ? one : other > 0.0 ? other : (double)INFINITY;
    return r;
}

static void be_hinged(float hip_c, float knee_c)
{
    limb.base = (brace_base_t){0.0f, 0.0f, 0.0f};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        limb.link[i] = (brace_link_t){.moment_transfer_ratio = (float)(i % 2)};
    }
    limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = hip_c;
    limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = knee_c;
}

/* The first step leaves half of the square of what the limb turns, the second half of the square of that. */
static void test_limbs_of_two_hinges(void)
{
    int told = 0, factors = 0;
    for (int i = 0; i < 400; i++) {
        const path_t path = (path_t)(i % PATHS);
        be_hinged(1e-5f * (float)(1 + i % 5), 1.6e-5f * (float)(1 + i % 3));
        limb.femur_mm = 100.0f + 20.0f * (float)(i % 7), limb.tibia_mm = 120.0f + 25.0f * (float)(i % 4);
        weights = (brace_gravity_t){
            .femur_n = 6.0f * (float)(i % 3), .knee_n = 3.0f * (float)(i % 4), .tibia_n = 5.0f * (float)(i % 5)};
        load.down = (brace_vec_t){cosf(0.61f * (float)i), sinf(0.61f * (float)i)};
        theta1_rad = (double)(-1.5f + 0.3f * (float)(i % 11)), theta2_rad = (double)(0.4f + 0.35f * (float)(i % 6));
        const double force_n = 2.0 + i % 17;
        brace_loaded_stiffness_t r;
        if (status_in_plane(path, force_n * cos(0.37 * i), force_n * sin(0.37 * i), &r) != BRACE_OK) {
            continue;
        }
        told++;
        const hinged_t h = hinged((double)limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm,
                                  (double)limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm, (double)load.tip.x_n,
                                  (double)load.tip.z_n);
        const double turned = fabs(h.turn[0]) + fabs(h.turn[1]), left = 0.125 * pow(turned, 4.0) + 1e-6;
        const double left_mm = left * (double)(limb.femur_mm + limb.tibia_mm);
        TEST_ASSERT_DOUBLE_WITHIN(left, h.turn[0], (double)r.hip_turn_rad);
        TEST_ASSERT_DOUBLE_WITHIN(left, h.turn[1], (double)r.knee_turn_rad);
        TEST_ASSERT_DOUBLE_WITHIN(left_mm, h.tip_mm[0], (double)r.displacement.x_mm);
        TEST_ASSERT_DOUBLE_WITHIN(left_mm, h.tip_mm[1], (double)r.displacement.z_mm);
        TEST_ASSERT_DOUBLE_WITHIN(left_mm, h.tibia_mm[0], (double)r.tibia_mm.x);
        TEST_ASSERT_DOUBLE_WITHIN(left_mm, h.tibia_mm[1], (double)r.tibia_mm.z);
        const double slender = (double)(r.stiffness.lambda_max_n_per_mm / r.stiffness.lambda_min_n_per_mm);
        const double within = (left + 2e-7 * slender) * (h.k[0] + h.k[2]);
        TEST_ASSERT_DOUBLE_WITHIN(within, h.k[0], (double)r.stiffness.k_xx_n_per_mm);
        TEST_ASSERT_DOUBLE_WITHIN(within, h.k[1], (double)r.stiffness.k_xz_n_per_mm);
        TEST_ASSERT_DOUBLE_WITHIN(within, h.k[2], (double)r.stiffness.k_zz_n_per_mm);
        if (h.factor < 10.0) { /* a parabola in the load: only the last step of the search is off */
            factors++;
            TEST_ASSERT_DOUBLE_WITHIN(5e-3 * h.factor, h.factor, (double)r.buckling_factor);
        } else if (h.factor > 16.5) {
            TEST_ASSERT_TRUE(isinf(r.buckling_factor));
        }
    }
    TEST_ASSERT_TRUE(told > 300 && factors > 40);
}

/* --- straight limbs pressed along themselves ------------------------------------------------------------------ */

/* A column from the tip to the base, under a force along it: how far it is aside there, and its slope. */
typedef struct {
    double aside_mm, slope;
} column_t;

/* The spring at a link's end moves the end across the link; then the beam, of this tip compliance; a rigid link where
 * that is none. Both of it at once, as a share of the bending is the beam's. */
static void add_link(column_t *at, double force_n, double length_mm, double bending_mm_per_n, double share)
{
    const double beam = share * bending_mm_per_n, ends = bending_mm_per_n - beam;
    at->aside_mm += ends * force_n * at->slope;
    if (length_mm <= 0.0) {
        return;
    }
    if (beam <= 0.0) {
        at->aside_mm += length_mm * at->slope;
        return;
    }
    const double wave = sqrt(force_n * 3.0 * beam / (length_mm * length_mm * length_mm)), turn = wave * length_mm;
    const column_t was = *at;
    at->aside_mm = was.aside_mm * cos(turn) + was.slope / wave * sin(turn);
    at->slope = was.slope * cos(turn) - was.aside_mm * wave * sin(turn);
}

static void add_hinge(column_t *at, double force_n, double rad_per_n_mm)
{
    at->slope -= rad_per_n_mm * force_n * at->aside_mm;
}

/* Slope at the base, of a unit's slope at the tip: a column stands while it is above zero. In the plane the limb ends
 * at the hip, with the base's rotation; in space the coxa link goes on to the base. */
static double slope_in_plane(double force_n)
{
    column_t at = {0.0, 1.0};
    const float length_mm[BRACE_LINK_COUNT] = {limb.coxa_mm, limb.femur_mm, limb.tibia_mm};
    for (int i = BRACE_TIBIA; i >= BRACE_FEMUR; i--) {
        const brace_link_t *link = &limb.link[i];
        add_link(&at, force_n, (double)length_mm[i], (double)link->bending_mm_per_n,
                 (double)link->moment_transfer_ratio);
        add_hinge(&at, force_n, (double)limb.joint[i].compliance_rad_per_n_mm);
    }
    add_hinge(&at, force_n, (double)limb.base.rotation_rad_per_n_mm);
    return at.slope;
}

static double slope_up(double force_n)
{
    column_t at = {0.0, 1.0};
    const float length_mm[BRACE_LINK_COUNT] = {limb.coxa_mm, limb.femur_mm, limb.tibia_mm};
    for (int i = BRACE_TIBIA; i >= BRACE_COXA; i--) {
        const brace_link_t *link = &limb.link[i];
        add_link(&at, force_n, (double)length_mm[i], (double)link->bending_mm_per_n,
                 (double)link->moment_transfer_ratio);
        add_hinge(&at, force_n, i == BRACE_COXA ? 0.0 : (double)limb.joint[i].compliance_rad_per_n_mm);
    }
    return at.slope;
}

static double slope_aside(double force_n)
{
    column_t at = {0.0, 1.0};
    const float length_mm[BRACE_LINK_COUNT] = {limb.coxa_mm, limb.femur_mm, limb.tibia_mm};
    for (int i = BRACE_TIBIA; i >= BRACE_COXA; i--) {
        const brace_link_t *link = &limb.link[i];
        add_link(&at, force_n, (double)length_mm[i], (double)link->lateral_mm_per_n,
                 (double)link->moment_transfer_ratio);
    }
    add_hinge(&at, force_n, (double)limb.joint[BRACE_COXA].compliance_rad_per_n_mm);
    return at.slope;
}

static const double force_most_n = 5000.0; /* a limb that bears more does not buckle here */

/* Force [N] under which a column first has no slope at its base. */
static double buckles_at(double (*slope)(double))
{
    double below = 0.0, above = 0.1;
    while (slope(above) > 0.0 && above < force_most_n) {
        below = above, above *= 1.01;
    }
    for (int halving = 0; halving < 50; halving++) {
        const double middle = 0.5 * (below + above);
        *(slope(middle) > 0.0 ? &below : &above) = middle;
    }
    return below;
}

/* What yields of a column, and how far its factors may be off. Of hinges the determinant is a parabola in the load or
 * less, which the search ends on: rounding is left, in integers 2^-12 of the largest number that is met. Else the
 * parabola is near the root only; and two curvatures are not yet a sine: a beam that yields alone is off most. In space
 * femur and tibia are one part each. */
typedef struct {
    float yaw, hip, knee;       /* rad/(N mm) */
    float bending[3], lateral[3], share[3], rotation;
    double in_plane[PATHS], in_space[PATHS];
} yields_t;

static const yields_t columns[] = {
    {.hip = 1e-5f, .in_plane = {2e-5, 5e-4}, .in_space = {1e-5, 0.031}},
    {.knee = 2e-5f, .in_plane = {2e-5, 5e-4}, .in_space = {1e-5, 0.031}},
    {.hip = 1e-5f, .knee = 2e-5f, .in_plane = {2e-5, 5e-4}, .in_space = {1e-5, 5e-4}},
    {.hip = 1e-5f, .knee = 2e-5f, .rotation = 5e-6f, .in_plane = {2e-5, 5e-4}},
    {.yaw = 1e-5f, .in_space = {1e-5, 0.031}},
    {.bending = {0.0f, 0.5f, 0.0f}, .share = {0.0f, 1.0f, 0.0f}, .in_plane = {1e-3, 1e-3}, .in_space = {2e-3, 0.031}},
    {.bending = {0.0f, 0.0f, 1.0f}, .share = {0.0f, 0.0f, 1.0f}, .in_plane = {8e-3, 8e-3}, .in_space = {0.05, 0.05}},
    {.bending = {0.0f, 0.5f, 1.0f}, .share = {0.0f, 1.0f, 1.0f}, .in_plane = {1e-3, 1e-3}, .in_space = {3e-3, 3e-3}},
    {.hip = 1e-5f, .knee = 1e-5f, .bending = {0.0f, 0.5f, 1.0f}, .in_plane = {2e-3, 2e-3}, .in_space = {1e-4, 2e-3}},
    {.hip = 1e-5f, .knee = 1e-5f, .bending = {0.0f, 0.2f, 0.3f}, .share = {0.0f, 0.5f, 0.8f}, .rotation = 2e-6f,
     .in_plane = {5e-4, 5e-4}},
    {.lateral = {0.01f, 0.5f, 0.8f}, .share = {1.0f, 1.0f, 1.0f}, .in_space = {2e-3, 2e-3}},
    {.yaw = 1e-5f, .lateral = {0.01f, 0.2f, 0.3f}, .share = {0.5f, 0.4f, 0.7f}, .in_space = {5e-4, 1e-3}},
    {.hip = 1e-5f, .knee = 1e-5f, .bending = {0.02f, 0.2f, 0.3f}, .share = {0.0f, 1.0f, 1.0f},
     .in_plane = {5e-4, 5e-4}, .in_space = {1e-3, 2e-3}},
    {.yaw = 1e-5f, .hip = 1e-5f, .knee = 1e-5f, .bending = {0.02f, 0.2f, 0.3f}, .lateral = {0.0f, 0.2f, 0.3f},
     .share = {1.0f, 0.5f, 0.8f}, .in_plane = {5e-4, 5e-4}, .in_space = {5e-4, 4e-3}},
};

enum { ENDS_SLIDE = 8 };

static void be_column(const yields_t *of)
{
    const float nearly_rigid = 1e-5f; /* what yields nowhere in some direction has no K */
    limb.base = (brace_base_t){0.0f, 0.0f, of->rotation};
    limb.joint[BRACE_COXA].compliance_rad_per_n_mm = of->yaw;
    limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = of->hip;
    limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = of->knee;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        limb.link[i] = (brace_link_t){.axial_mm_per_n = nearly_rigid,
                                      .bending_mm_per_n = of->bending[i] + nearly_rigid,
                                      .lateral_mm_per_n = of->lateral[i] + nearly_rigid,
                                      .moment_transfer_ratio = of->share[i]};
    }
}

/* The factor is the load that buckles it over the present one, at whatever load it is asked. Integers need not hold
 * what lies within half of it. */
static void expect_factor(double factor, double told, double within)
{
    if (factor < 10.5) {
        TEST_ASSERT_DOUBLE_WITHIN(within * factor, factor, told);
    } else if (factor > 17.0) {
        TEST_ASSERT_TRUE(isinf(told));
    }
}

static void test_columns_buckle_as_their_energy_says(void)
{
    for (uint32_t n = 0; n < sizeof columns / sizeof *columns; n++) {
        const yields_t *of = &columns[n];
        be_column(of);
        const double plane_n = buckles_at(slope_in_plane);
        const double space_n = fmin(buckles_at(slope_up), buckles_at(slope_aside));
        for (int i = 0; i < 60 * PATHS; i++) {
            const path_t path = (path_t)(i % PATHS);
            const double factor = 1.02 * pow(1.05, i / PATHS);
            const bool is_held = path == FLOATS || factor > 2.1;
            brace_loaded_stiffness_t r;
            brace_space_result_t s;
            float told;
            if (of->in_plane[path] > 0.0) {
                const brace_status_t status = status_in_plane(path, -plane_n / factor, 0.0, &r);
                TEST_ASSERT_TRUE(status == BRACE_OK || !is_held);
                if (status == BRACE_OK) {
                    expect_factor(factor, (double)r.buckling_factor, of->in_plane[path]);
                }
            }
            if (of->in_space[path] > 0.0) {
                const double force_n[3] = {-space_n / factor, 0.0, 0.0};
                const brace_status_t status = status_in_space(path, force_n, &s, &told);
                TEST_ASSERT_TRUE(status == BRACE_OK || !is_held);
                if (status == BRACE_OK) {
                    expect_factor(factor, (double)told, of->in_space[path]);
                }
            }
        }
        /* Beyond it nothing stands in the plane, and in space nothing is promised. */
        for (int i = 0; i < 20 * PATHS; i++) {
            const double beyond = 1.01 + 0.05 * (i / PATHS), force_n[3] = {-space_n * beyond, 0.0, 0.0};
            const path_t path = (path_t)(i % PATHS);
            brace_loaded_stiffness_t r;
            brace_space_result_t s;
            float told = 0.0f;
            TEST_ASSERT_TRUE(of->in_plane[path] <= 0.0 ||
                             status_in_plane(path, -plane_n * beyond, 0.0, &r) == BRACE_E_SINGULAR);
            TEST_ASSERT_TRUE(of->in_space[path] <= 0.0 || status_in_space(path, force_n, &s, &told) != BRACE_OK ||
                             told < BRACE_PROMISED_FACTOR);
        }
    }
}

/* Pulled, they all stand and never buckle, but the one whose ends slide: it turns across the pull. */
static void test_columns_that_are_pulled(void)
{
    for (uint32_t n = 0; n < sizeof columns / sizeof *columns; n++) {
        be_column(&columns[n]);
        for (int i = 0; i < 8 * PATHS && n != ENDS_SLIDE; i++) {
            const path_t path = (path_t)(i % PATHS);
            const double force_n[3] = {10.0 * (1 + i / PATHS), 0.0, 0.0};
            float told;
            TEST_ASSERT_TRUE(isinf(in_plane(path, force_n[0], 0.0).buckling_factor));
            (void)in_space(path, force_n, &told);
            TEST_ASSERT_TRUE(isinf(told));
        }
    }
}

/* --- floats and integers -------------------------------------------------------------------------------------- */

static uint32_t state;

static double any(double least, double most)
{
    state = state * 1664525u + 1013904223u;
    return least + (most - least) * ((double)(state >> 8) / 16777216.0);
}

/* A limb of which every part yields by much the same under a load, so that no part hides behind another. Its links turn
 * by up to `turn_rad` each. */
static void be_even(double turn_rad, double force_n)
{
    limb = sample_limb[SAMPLE_BEAM];
    limb.coxa_mm = (float)any(40.0, 120.0);
    limb.femur_mm = (float)any(90.0, 240.0), limb.tibia_mm = (float)any(90.0, 240.0);
    const double reach_mm = (double)(limb.coxa_mm + limb.femur_mm + limb.tibia_mm);
    const double per_n_mm = turn_rad / (force_n * reach_mm);
    const float length_mm[BRACE_LINK_COUNT] = {limb.coxa_mm, limb.femur_mm, limb.tibia_mm};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        const double square = (double)length_mm[i] * (double)length_mm[i];
        limb.link[i] = (brace_link_t){.axial_mm_per_n = (float)(any(0.02, 0.2) * per_n_mm * square),
                                      .bending_mm_per_n = (float)(any(0.1, 0.4) * per_n_mm * square),
                                      .lateral_mm_per_n = (float)(any(0.1, 0.4) * per_n_mm * square),
                                      .torsion_rad_per_n_mm = (float)(any(0.2, 1.0) * per_n_mm),
                                      .tilt_rad = (float)any(-0.5, 0.5),
                                      .moment_transfer_ratio = (float)any(0.0, 1.0)};
        limb.joint[i].compliance_rad_per_n_mm = (float)(any(0.2, 1.0) * per_n_mm);
    }
    limb.base = (brace_base_t){(float)(any(0.01, 0.05) * per_n_mm * 1e4), (float)(any(0.01, 0.05) * per_n_mm * 1e4),
                               (float)(any(0.1, 0.5) * per_n_mm)};
    weights = (brace_gravity_t){.femur_n = (float)(any(0.0, 0.2) * force_n),
                                .knee_n = (float)(any(0.0, 0.2) * force_n),
                                .tibia_n = (float)(any(0.0, 0.2) * force_n)};
    theta1_rad = any(-3.0, 3.0), theta2_rad = any(-2.5, 2.5);
}

static double apart(float a, float b)
{
    return fabs((double)a - (double)b);
}

/* They share no line. In the plane they take the same steps, so that they are apart by the rounding of words alone,
 * whatever the load: 2^-26 of the limb's size, some hundreds of times that in K. The end of the search for the factor
 * is a parabola on determinants of other loads. */
static void test_in_the_plane_floats_and_integers_agree(void)
{
    int told = 0, factors = 0;
    state = 77u;
    for (int i = 0; i < 2000; i++) {
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
    TEST_ASSERT_TRUE(told > 1800 && factors > 40);
}

/* In space each leaves out other terms of the third order in what it bends. */
static void test_in_space_floats_and_integers_agree(void)
{
    int told = 0;
    state = 78u;
    for (int i = 0; i < 2000; i++) {
        const double force_n = any(1.0, 60.0), turn_rad = i % 2 == 0 ? 0.05 : 0.15;
        be_even(turn_rad, force_n);
        const double down_rad = any(-3.2, 3.2), force_rad = any(-3.2, 3.2), up = any(-1.0, 1.0);
        const double out = sqrt(1.0 - up * up);
        space_load.down = (brace_vec3_t){(float)(0.6 * cos(down_rad)), 0.8f, (float)(0.6 * sin(down_rad))};
        const double at_n[3] = {force_n * out * cos(force_rad), force_n * up, force_n * out * sin(force_rad)};
        brace_space_result_t a, b;
        float factor;
        if (status_in_space(FLOATS, at_n, &a, &factor) != BRACE_OK || factor < 2.0f) {
            continue;
        }
        TEST_ASSERT_EQUAL(BRACE_OK, status_in_space(INTEGERS, at_n, &b, NULL));
        told++;
        const float of_a[6] = {a.k.xx_n_per_mm, a.k.xy_n_per_mm, a.k.xz_n_per_mm,
                               a.k.yy_n_per_mm, a.k.yz_n_per_mm, a.k.zz_n_per_mm};
        const float of_b[6] = {b.k.xx_n_per_mm, b.k.xy_n_per_mm, b.k.xz_n_per_mm,
                               b.k.yy_n_per_mm, b.k.yz_n_per_mm, b.k.zz_n_per_mm};
        const double left = 0.25 * turn_rad * turn_rad * turn_rad + 3e-5, reach_mm = 600.0;
        const double most = (double)(of_a[0] + of_a[3] + of_a[5]);
        for (int e = 0; e < 6; e++) {
            TEST_ASSERT_DOUBLE_WITHIN(left * most, 0.0, apart(of_a[e], of_b[e]));
        }
        TEST_ASSERT_DOUBLE_WITHIN(left * reach_mm, 0.0, apart(a.displacement_mm.x, b.displacement_mm.x));
        TEST_ASSERT_DOUBLE_WITHIN(left * reach_mm, 0.0, apart(a.displacement_mm.y, b.displacement_mm.y));
        TEST_ASSERT_DOUBLE_WITHIN(left * reach_mm, 0.0, apart(a.displacement_mm.z, b.displacement_mm.z));
        TEST_ASSERT_DOUBLE_WITHIN(left * reach_mm, 0.0, apart(a.tibia_mm.x, b.tibia_mm.x));
        TEST_ASSERT_DOUBLE_WITHIN(left * reach_mm, 0.0, apart(a.tibia_mm.y, b.tibia_mm.y));
        TEST_ASSERT_DOUBLE_WITHIN(left * reach_mm, 0.0, apart(a.tibia_mm.z, b.tibia_mm.z));
        TEST_ASSERT_DOUBLE_WITHIN(left, 0.0, apart(a.yaw_turn_rad, b.yaw_turn_rad));
        TEST_ASSERT_DOUBLE_WITHIN(left, 0.0, apart(a.hip_turn_rad, b.hip_turn_rad));
        TEST_ASSERT_DOUBLE_WITHIN(left, 0.0, apart(a.knee_turn_rad, b.knee_turn_rad));
    }
    TEST_ASSERT_TRUE(told > 1800);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_in_the_plane_K_is_the_slope_of_the_force);
    RUN_TEST(test_in_space_K_is_the_slope_of_the_force);
    RUN_TEST(test_in_the_plane_the_knee_s_weight_is_a_force_there);
    RUN_TEST(test_in_space_the_knee_s_weight_is_a_force_there);
    RUN_TEST(test_limbs_of_two_hinges);
    RUN_TEST(test_columns_buckle_as_their_energy_says);
    RUN_TEST(test_columns_that_are_pulled);
    RUN_TEST(test_in_the_plane_floats_and_integers_agree);
    RUN_TEST(test_in_space_floats_and_integers_agree);
    return UNITY_END();
}
