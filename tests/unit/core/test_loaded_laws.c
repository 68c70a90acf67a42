/* Laws that every elastic limb under a load obeys, checked on the three paths. K is the slope of the force over the
 * tip's place. A weight at the knee moves the tip as a force at the tip moves the knee (Maxwell). A limb of hinges
 * stands where its moments balance. No law uses the paths' own formulas. */
#include <math.h>
#include <string.h>

#include "loaded_paths.h"
#include "sample_limbs.h"
#include "unity.h"

void setUp(void)
{
    start_anew();
}

void tearDown(void) {}

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
    limb.link[BRACE_TIBIA].moment_transfer = i % 3 == 0 ? 0.7f : 0.0f;
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
    for (int i = 0; i < 12 * SAMPLE_COUNT * PATHS; i += STRIDE) {
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
    for (int i = 0; i < 12 * SAMPLE_COUNT; i += STRIDE) {
        any_limb(i % SAMPLE_COUNT, i / SAMPLE_COUNT);
        const double force_n[3] = {2.4 * cos(0.7 * i), 1.5 * sin(1.3 * i), 2.4 * sin(0.7 * i)};
        const brace_k3_t k = in_space(force_n, NULL).k;
        double c[3][3];
        inverse_of(&k, c);
        const double within = 6e-4 * (c[0][0] + c[1][1] + c[2][2]);
        for (int axis = 0; axis < 3; axis++) {
            double moved_mm[3][4];
            for (int s = 0; s < 4; s++) {
                double near_n[3] = {force_n[0], force_n[1], force_n[2]};
                near_n[axis] += step_n * steps[s];
                const brace_vec3_t d = in_space(near_n, NULL).displacement_mm;
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
    for (int i = 0; i < 12; i++) {
        any_limb(i % SAMPLE_COUNT, i);
        const double force_n[3] = {2.4 * cos(0.7 * i), 1.5 * sin(1.3 * i), 2.4 * sin(0.7 * i)};
        double by_weight_mm[3][4], size = 0.0;
        for (int s = 0; s < 4; s++) {
            weights.knee_n = 5.0f + (float)(step_n * steps[s]);
            const brace_vec3_t d = in_space(force_n, NULL).displacement_mm;
            by_weight_mm[0][s] = (double)d.x, by_weight_mm[1][s] = (double)d.y, by_weight_mm[2][s] = (double)d.z;
        }
        weights.knee_n = 5.0f;
        const brace_k3_t k = in_space(force_n, NULL).k;
        double c[3][3];
        inverse_of(&k, c);
        size = c[0][0] + c[1][1] + c[2][2];
        for (int axis = 0; axis < 3; axis++) {
            double knee_mm[4];
            for (int s = 0; s < 4; s++) {
                double near_n[3] = {force_n[0], force_n[1], force_n[2]};
                near_n[axis] += step_n * steps[s];
                const brace_space_result_t r = in_space(near_n, NULL);
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
    for (int step = 0; step < 12; step++) {
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
        limb.link[i] = (brace_link_t){.moment_transfer = (float)(i % 2)};
    }
    limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = hip_c;
    limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = knee_c;
}

/* The first step leaves half of the square of what the limb turns, the second half of the square of that. */
static void test_limbs_of_two_hinges(void)
{
    int told = 0, factors = 0;
    for (int i = 0; i < 40 * TIMES; i++) {
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
        const hinged_t h =
            hinged((double)limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm,
                   (double)limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm, (double)load.tip.x_n, (double)load.tip.z_n);
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
    TEST_ASSERT_TRUE(told > 30 * TIMES && factors > 4 * TIMES);
}

/* --- limbs of three hinges, in space -------------------------------------------------------------------------- */

typedef struct {
    double turn[3], tip_mm[3], k[3][3], factor;
} hinged_in_space_t;

/* Places of knee and tip, of rigid links. */
static void places_of(const double turn[3], double knee_mm[3], double tip_mm[3])
{
    const double a = theta1_rad + turn[1], b = theta1_rad - theta2_rad + turn[1] + turn[2];
    const double knee = (double)limb.coxa_mm + (double)limb.femur_mm * cos(a);
    const double tip = knee + (double)limb.tibia_mm * cos(b);
    knee_mm[0] = cos(turn[0]) * knee, knee_mm[1] = sin(turn[0]) * knee, knee_mm[2] = (double)limb.femur_mm * sin(a);
    tip_mm[0] = cos(turn[0]) * tip, tip_mm[1] = sin(turn[0]) * tip;
    tip_mm[2] = knee_mm[2] + (double)limb.tibia_mm * sin(b);
}

/* What the tip's force and the weights have as potential energy. Each link weighs in its middle. */
static double load_energy(const double turn[3], const double force_n[3])
{
    const double down[3] = {(double)space_load.down.x, (double)space_load.down.y, (double)space_load.down.z};
    const double root_mm[3] = {(double)limb.coxa_mm * cos(turn[0]), (double)limb.coxa_mm * sin(turn[0]), 0.0};
    double knee_mm[3], tip_mm[3], energy = 0.0;
    places_of(turn, knee_mm, tip_mm);
    for (int axis = 0; axis < 3; axis++) {
        const double weighed = (double)weights.femur_n * 0.5 * (root_mm[axis] + knee_mm[axis]) +
                               (double)weights.knee_n * knee_mm[axis] +
                               (double)weights.tibia_n * 0.5 * (knee_mm[axis] + tip_mm[axis]);
        energy -= force_n[axis] * tip_mm[axis] + down[axis] * weighed;
    }
    return energy;
}

static double energy_at(const double turn[3], const double force_n[3], int i, double by, int j, double and_by)
{
    double near[3] = {turn[0], turn[1], turn[2]};
    near[i] += by, near[j] += and_by;
    return load_energy(near, force_n);
}

static void slopes_of(const double turn[3], const double force_n[3], double slope[3], double bend[3][3])
{
    const double h = 1e-4;
    for (int i = 0; i < 3; i++) {
        slope[i] = (energy_at(turn, force_n, i, h, i, 0.0) - energy_at(turn, force_n, i, -h, i, 0.0)) / (2.0 * h);
        for (int j = 0; j < 3; j++) {
            bend[i][j] = (energy_at(turn, force_n, i, h, j, h) - energy_at(turn, force_n, i, h, j, -h) -
                          energy_at(turn, force_n, i, -h, j, h) + energy_at(turn, force_n, i, -h, j, -h)) /
                         (4.0 * h * h);
        }
    }
}

static double det_of(const double m[3][3])
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/* The springs' determinant with so many times the load. */
static double softened(const double yields[3], const double bend[3][3], double times)
{
    double m[3][3];
    for (int i = 0; i < 9; i++) {
        m[i / 3][i % 3] = times * bend[i / 3][i % 3] * yields[i / 3] + (i / 3 == i % 3 ? 1.0 : 0.0);
    }
    return det_of((const double(*)[3])m);
}

/* x of m x = right, by Cramer. */
static void solved(const double m[3][3], const double right[3], double x[3])
{
    const double det = det_of(m);
    for (int column = 0; column < 3; column++) {
        double with[3][3];
        memcpy(with, m, sizeof with);
        for (int row = 0; row < 3; row++) {
            with[row][column] = right[row];
        }
        x[column] = det_of((const double(*)[3])with) / det;
    }
}

static hinged_in_space_t hinged_in_space(const double yields[3], const double force_n[3])
{
    hinged_in_space_t r = {.turn = {0.0, 0.0, 0.0}, .factor = (double)INFINITY};
    double slope[3], bend[3][3], whole[3][3], jacobian[3][3], knee_mm[3], straight_mm[3];
    const double none[3] = {0.0, 0.0, 0.0};
    for (int step = 0; step < 8; step++) {
        double off[3], by[3];
        slopes_of(r.turn, force_n, slope, bend);
        for (int i = 0; i < 3; i++) {
            off[i] = -slope[i] - r.turn[i] / yields[i];
            for (int j = 0; j < 3; j++) {
                whole[i][j] = bend[i][j] + (i == j ? 1.0 / yields[i] : 0.0);
            }
        }
        solved((const double(*)[3])whole, off, by);
        for (int i = 0; i < 3; i++) {
            r.turn[i] += by[i];
        }
    }
    places_of(r.turn, knee_mm, r.tip_mm);
    places_of(none, knee_mm, straight_mm);
    for (int j = 0; j < 3; j++) { /* how the tip moves with each turn, one a row */
        double ahead_mm[3], behind_mm[3], near[3] = {r.turn[0], r.turn[1], r.turn[2]};
        near[j] += 1e-5;
        places_of(near, knee_mm, ahead_mm);
        near[j] -= 2e-5;
        places_of(near, knee_mm, behind_mm);
        for (int axis = 0; axis < 3; axis++) {
            jacobian[j][axis] = (ahead_mm[axis] - behind_mm[axis]) / 2e-5;
        }
        r.tip_mm[j] -= straight_mm[j];
    }
    /* A move d turns the joints by q, where J' q = d; the force against it is J^-1 H q. */
    for (int axis = 0; axis < 3; axis++) {
        double moved[3] = {0.0, 0.0, 0.0}, turn[3], moment[3] = {0.0, 0.0, 0.0}, transposed[3][3];
        moved[axis] = 1.0;
        for (int i = 0; i < 9; i++) {
            transposed[i % 3][i / 3] = jacobian[i / 3][i % 3];
        }
        solved((const double(*)[3])transposed, moved, turn);
        for (int i = 0; i < 9; i++) {
            moment[i / 3] += whole[i / 3][i % 3] * turn[i % 3];
        }
        solved((const double(*)[3])jacobian, moment, r.k[axis]);
    }
    for (double times = 0.0; times < 20.0 && isinf(r.factor); times += 0.05) {
        if (softened(yields, (const double(*)[3])bend, times + 0.05) <= 0.0) {
            double below = times, above = times + 0.05;
            for (int halving = 0; halving < 30; halving++) {
                const double middle = 0.5 * (below + above);
                *(softened(yields, (const double(*)[3])bend, middle) > 0.0 ? &below : &above) = middle;
            }
            r.factor = below;
        }
    }
    return r;
}

/* The second step is made with the matrix of the straight limb: it leaves the cube of what the limb turns. */
static void test_limbs_of_three_hinges(void)
{
    int told = 0, factors = 0;
    for (int i = 0; i < 30 * TIMES; i++) {
        be_hinged(1e-5f * (float)(1 + i % 5), 1.6e-5f * (float)(1 + i % 3));
        limb.joint[BRACE_COXA].compliance_rad_per_n_mm = 1.2e-5f * (float)(1 + i % 4);
        limb.coxa_mm = 30.0f + 10.0f * (float)(i % 5);
        limb.femur_mm = 100.0f + 20.0f * (float)(i % 7), limb.tibia_mm = 120.0f + 25.0f * (float)(i % 4);
        weights = (brace_gravity_t){
            .femur_n = 3.0f * (float)(i % 3), .knee_n = 1.5f * (float)(i % 4), .tibia_n = 2.5f * (float)(i % 5)};
        const double lean_rad = 0.5 * sin(i), down_rad = 0.61 * i, size_n = 1.0 + i % 13, up = sin(1.1 * i);
        space_load.down = (brace_vec3_t){(float)(cos(lean_rad) * cos(down_rad)), (float)sin(lean_rad),
                                         (float)(cos(lean_rad) * sin(down_rad))};
        theta1_rad = (double)(-1.5f + 0.3f * (float)(i % 11)), theta2_rad = (double)(0.4f + 0.35f * (float)(i % 6));
        const double out_n = size_n * sqrt(1.0 - up * up);
        const double force_n[3] = {out_n * cos(0.37 * i), size_n * up, out_n * sin(0.37 * i)};
        const double yields[3] = {(double)limb.joint[0].compliance_rad_per_n_mm,
                                  (double)limb.joint[1].compliance_rad_per_n_mm,
                                  (double)limb.joint[2].compliance_rad_per_n_mm};
        const hinged_in_space_t h = hinged_in_space(yields, force_n);
        float factor;
        const brace_space_result_t r = in_space(force_n, &factor);
        const double turned = fabs(h.turn[0]) + fabs(h.turn[1]) + fabs(h.turn[2]);
        const double left = 2.0 * (turned * turned * turned + 5e-5);
        const double is_turn[3] = {(double)r.yaw_turn_rad, (double)r.hip_turn_rad, (double)r.knee_turn_rad};
        const double is_mm[3] = {(double)r.displacement_mm.x, (double)r.displacement_mm.y, (double)r.displacement_mm.z};
        const double is_k[6] = {(double)r.k.xx_n_per_mm, (double)r.k.xy_n_per_mm, (double)r.k.xz_n_per_mm,
                                (double)r.k.yy_n_per_mm, (double)r.k.yz_n_per_mm, (double)r.k.zz_n_per_mm};
        const double k[6] = {h.k[0][0], h.k[0][1], h.k[0][2], h.k[1][1], h.k[1][2], h.k[2][2]};
        const double trace = k[0] + k[3] + k[5];
        double c[3][3];
        inverse_of(&r.k, c);
        const bool is_slender = trace * (c[0][0] + c[1][1] + c[2][2]) > 100.0;
        for (int e = 0; e < 6; e++) {
            TEST_ASSERT_DOUBLE_WITHIN(left, h.turn[e % 3], is_turn[e % 3]);
            TEST_ASSERT_DOUBLE_WITHIN(500.0 * left, h.tip_mm[e % 3], is_mm[e % 3]);
            TEST_ASSERT_TRUE(is_slender || fabs(k[e] - is_k[e]) < 2.0 * left * trace);
        }
        told += is_slender ? 0 : 1;
        if (h.factor > 1.3 && h.factor < 10.0) { /* a cubic in the load: the parabola that ends the search is off */
            factors++;
            TEST_ASSERT_DOUBLE_WITHIN(2e-3 * h.factor, h.factor, (double)factor);
        } else if (h.factor > 17.0) {
            TEST_ASSERT_TRUE(isinf(factor));
        }
    }
    TEST_ASSERT_TRUE(told > 15 * TIMES && factors > 2 * TIMES);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_in_the_plane_K_is_the_slope_of_the_force);
    RUN_TEST(test_in_space_K_is_the_slope_of_the_force);
    RUN_TEST(test_in_the_plane_the_knee_s_weight_is_a_force_there);
    RUN_TEST(test_in_space_the_knee_s_weight_is_a_force_there);
    RUN_TEST(test_limbs_of_two_hinges);
    RUN_TEST(test_limbs_of_three_hinges);
    return UNITY_END();
}
