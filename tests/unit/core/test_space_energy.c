/* A limb in space in parts, softened by a multiple of its load, beside the energy of its load. The limb is gone through
 * here from its base to its tip in double precision: what each coordinate turns and moves, where the forces act. The
 * second derivatives of their work W are differences. At t times the load the limb's determinant is
 * det(I - t C W''), C the compliances: the product of all pivots of loaded/space_parts.h, which has none of this. */
#include <math.h>

#pragma GCC diagnostic ignored "-Wunused-function" /* this suite does not call all functions of the headers */
#define in_plane vec_in_plane /* loaded_paths.h has a function of this name, too */
#include "loaded/space_parts.h"
#undef in_plane

#include "even_limb.h"

enum { OF_PART = 5, OF_END = 4, COORDINATES = BRACE_SPACE_PARTS * OF_PART + BRACE_LINK_COUNT * OF_END + 4 };
enum { ALONG_ACROSS, ALONG_SIDEWAYS, ABOUT_X, ABOUT_Y, ABOUT_Z }; /* of a part */
enum { END_TWIST, END_ACROSS, END_SIDEWAYS, END_STRETCH }; /* of a link's end */
enum { ENDS = BRACE_SPACE_PARTS * OF_PART, JOINTS = ENDS + BRACE_LINK_COUNT * OF_END, BASE = JOINTS + 3 };

static brace_loaded_space_t loaded;
static brace_space_rest_t rest;
static brace_space_shape_t shape;

void setUp(void)
{
    start_anew();
}

void tearDown(void) {}

/* --- the limb, gone through from its base --------------------------------------------------------------------- */

typedef struct {
    double x, y, z;
} vec_t;

/* Where the walk is, the axes there, and the work of the forces met so far. */
typedef struct {
    vec_t at, axis[3];
    double work_n_mm;
} walk_t;

static vec_t plus_scaled(vec_t a, vec_t b, double by)
{
    return (vec_t){a.x + by * b.x, a.y + by * b.y, a.z + by * b.z};
}

static double dot(vec_t a, brace_vec3_t b)
{
    return a.x * (double)b.x + a.y * (double)b.y + a.z * (double)b.z;
}

/* The axes turn about one of them. */
static void turn(walk_t *walk, int about, double cosine, double sine)
{
    vec_t *a = &walk->axis[(about + 1) % 3], *b = &walk->axis[(about + 2) % 3];
    const vec_t was = *a, none = {0.0, 0.0, 0.0};
    *a = plus_scaled(plus_scaled(none, was, cosine), *b, sine);
    *b = plus_scaled(plus_scaled(none, *b, cosine), was, -sine);
}

/* by a turn of the shape, and a coordinate more */
static void turn_as(walk_t *walk, int about, brace_vec_t as, double more_rad)
{
    turn(walk, about, (double)as.x, (double)as.z);
    turn(walk, about, cos(more_rad), sin(more_rad));
}

static vec_t moved(const walk_t *walk, vec_t by)
{
    const vec_t in_plane_mm = plus_scaled(plus_scaled(walk->at, walk->axis[0], by.x), walk->axis[1], by.y);
    return plus_scaled(in_plane_mm, walk->axis[2], by.z);
}

/* Over one part of a link: half of its turns about z and y, its chord, its twist, and the other halves. Its bow grows
 * with the square of its turns, its springs move its end across in parts of its length, and a beam whose end is moved
 * across twists as it turns. */
static void over_part(walk_t *walk, const brace_space_link_t *link, const brace_space_part_t *part, double share,
                      const double q[OF_PART])
{
    const double y = 3.0 * (double)part->third_y_rad, z = 3.0 * (double)part->third_z_rad;
    const double dy = q[ABOUT_Y], dz = q[ABOUT_Z];
    const double length_mm = share * (double)link->length_mm, twelfth_mm = share * (double)link->twelfth_mm;
    const double a_mm = q[ALONG_ACROSS] * length_mm, s_mm = q[ALONG_SIDEWAYS] * length_mm;
    const vec_t chord = {(double)part->chord_mm.x + (double)part->by_bend_mm.x * dz +
                             (double)part->by_sideways_mm * dy + share * (double)link->bow_mm.x * dz * dz -
                             0.5 * twelfth_mm * dy * dy + a_mm * (double)link->across.x,
                         (double)part->chord_mm.y + (double)part->by_bend_mm.z * dz +
                             share * (double)link->bow_mm.z * dz * dz + a_mm * (double)link->across.z,
                         (double)part->chord_mm.z + s_mm};
    const vec_t half = {0.5 * (double)part->chord_mm.x, 0.5 * (double)part->chord_mm.y, 0.5 * (double)part->chord_mm.z};
    const double curl_y = (double)part->across_curl, curl_z = (double)part->sideways_curl;
    const double curls = (curl_y + q[ALONG_ACROSS]) * (y + dy) - curl_y * y + (curl_z + q[ALONG_SIDEWAYS]) * (z + dz) -
                         curl_z * z; /* more than the shape has */
    turn(walk, 2, cos(0.5 * dz), sin(0.5 * dz));
    turn_as(walk, 1, part->about_y, 0.5 * dy);
    walk->work_n_mm += dot(moved(walk, half), rest.down) * share * (double)link->weight_n;
    walk->at = moved(walk, chord);
    turn_as(walk, 0, part->about_x, q[ABOUT_X] - curls);
    turn_as(walk, 1, part->about_y, 0.5 * dy);
    turn_as(walk, 2, part->about_z, 0.5 * dz);
}

/* Over the springs at a link's end: across it, beside it and along it, and then a twist. */
static void over_end(walk_t *walk, const brace_space_link_t *link, brace_vec3_t end_mm, const double q[OF_END])
{
    const double across = q[END_ACROSS], along = q[END_STRETCH];
    const vec_t by = {(double)end_mm.x + across * (double)link->across.x + along * (double)link->stretch_root.x,
                      (double)end_mm.y + across * (double)link->across.z + along * (double)link->stretch_root.z,
                      (double)end_mm.z + q[END_SIDEWAYS]};
    walk->at = moved(walk, by);
    turn(walk, 0, cos(q[END_TWIST]), sin(q[END_TWIST]));
}

static walk_t walk_over(const double q[COORDINATES])
{
    const brace_space_link_t *const links[] = {&loaded.coxa, &loaded.femur, &loaded.tibia};
    walk_t walk = {.axis = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
    turn_as(&walk, 2, shape.base, q[BASE]); /* the base turns about the hip */
    walk.at = plus_scaled(walk.at, walk.axis[0], -(double)loaded.coxa.length_mm);
    turn_as(&walk, 1, shape.yaw, q[JOINTS]);
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        const int from = first_part[i], parts = first_part[i + 1] - from;
        turn_as(&walk, 2, shape.about_joint[i], i > 0 ? q[JOINTS + i] : 0.0);
        for (int k = from; k < from + parts; k++) {
            over_part(&walk, links[i], &shape.part[k], 1.0 / parts, q + OF_PART * k);
        }
        over_end(&walk, links[i], shape.end_mm[i], q + ENDS + OF_END * i);
        if (i == BRACE_FEMUR) {
            const double knee_n = (double)loaded.beyond_femur_n - (double)loaded.tibia.weight_n;
            walk.work_n_mm += dot(walk.at, rest.down) * knee_n;
        }
    }
    walk.work_n_mm += dot(walk.at, rest.tip_n);
    return walk;
}

/* How far each coordinate yields to what drives it. */
static void take_yields(double c[COORDINATES])
{
    const brace_space_link_t *const links[] = {&loaded.coxa, &loaded.femur, &loaded.tibia};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        const brace_space_link_t *link = links[i];
        const double parts = first_part[i + 1] - first_part[i];
        const double beam = (double)link->curl_per_mm * (double)link->length_mm;
        const double twist = (double)link->twist_rad_per_n_mm, at_end = 0.5 + (double)link->stretch_end_share;
        for (int k = first_part[i]; k < first_part[i + 1]; k++) {
            double *of = c + OF_PART * k;
            of[ALONG_ACROSS] = (double)link->bend_rad_per_n_mm / (12.0 * parts);
            of[ALONG_SIDEWAYS] = (double)link->sideways_rad_per_n_mm / (12.0 * parts);
            of[ABOUT_X] = (1.0 - at_end) * twist / parts;
            of[ABOUT_Y] = (double)link->sideways_rad_per_n_mm / parts;
            of[ABOUT_Z] = (double)link->bend_rad_per_n_mm / parts;
        }
        double *end = c + ENDS + OF_END * i;
        end[END_TWIST] = at_end * twist;
        end[END_ACROSS] = (1.0 - beam) * (double)link->across_mm_per_n;
        end[END_SIDEWAYS] = (1.0 - beam) * (double)link->sideways_mm_per_n;
        end[END_STRETCH] = 1.0;
        c[JOINTS + i] = (double)shape.joint_rad_per_n_mm[i];
    }
    c[BASE] = (double)loaded.base_rotation_rad_per_n_mm;
}

/* Of the work, scaled by the roots of what yields, so that the matrix is symmetric: det(I - t C W'') stays. */
static double matrix[COORDINATES][COORDINATES];

static void take_matrix(void)
{
    double c[COORDINATES], q[COORDINATES] = {0.0};
    take_yields(c);
    for (int i = 0; i < COORDINATES; i++) {
        for (int j = 0; j <= i; j++) {
            const double size_i = i >= ENDS && i < JOINTS && i % OF_END != 0 ? 0.1 : 1e-3; /* [mm] or [rad] */
            const double size_j = j >= ENDS && j < JOINTS && j % OF_END != 0 ? 0.1 : 1e-3;
            double sum = 0.0;
            for (int corner = 0; corner < 4 && c[i] > 0.0 && c[j] > 0.0; corner++) {
                const double sign_i = corner / 2 == 0 ? 1.0 : -1.0, sign_j = corner % 2 == 0 ? 1.0 : -1.0;
                q[i] += sign_i * size_i, q[j] += sign_j * size_j;
                sum += sign_i * sign_j * walk_over(q).work_n_mm;
                q[i] = q[j] = 0.0;
            }
            matrix[i][j] = matrix[j][i] = sqrt(c[i]) * sqrt(c[j]) * sum / (4.0 * size_i * size_j);
        }
    }
}

/* det(I - times matrix); is_stable: whether it is positive definite */
static double determinant_at(double times, bool *is_stable_)
{
    static double m[COORDINATES][COORDINATES];
    double det = 1.0;
    *is_stable_ = true;
    for (int i = 0; i < COORDINATES; i++) {
        for (int j = 0; j < COORDINATES; j++) {
            m[i][j] = (i == j ? 1.0 : 0.0) - times * matrix[i][j];
        }
    }
    for (int i = 0; i < COORDINATES; i++) {
        *is_stable_ = *is_stable_ && m[i][i] > 0.0;
        det *= m[i][i];
        for (int row = i + 1; row < COORDINATES; row++) {
            const double by = m[row][i] / m[i][i];
            for (int column = i; column < COORDINATES; column++) {
                m[row][column] -= by * m[i][column];
            }
        }
    }
    return det;
}

/* --- the same by loaded/space_parts.h ------------------------------------------------------------------------- */

static double pivots_at(float times, bool *is_stable_)
{
    held_t held = {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    pivots_t pivots = {0u, 1.0f};
    for (int i = BRACE_LINK_COUNT - 1; i >= 0; i--) {
        hold_link(&loaded, &shape, i, times, &held, &pivots);
    }
    hold_base(&loaded, &shape, times, &held, &pivots);
    *is_stable_ = is_stable(&pivots);
    return (double)pivots.product;
}

static bool take_any_limb(double turn_rad)
{
    const double force_n = any(5.0, 60.0);
    be_even(turn_rad, force_n);
    be_pressed(force_n);
    brace_loaded_space_collapse(&limb, &weights, &loaded);
    if (brace_loaded_space_settle(&loaded, (float)theta1_rad, (float)theta2_rad, &space_load, &rest) != BRACE_OK) {
        return false;
    }
    shape_limb(&loaded, &rest, &shape);
    return true;
}

/* --- what is compared ----------------------------------------------------------------------------------------- */

enum { LIMBS = 5 * TIMES };

/* A limb turns by so much for its whole length. The core leaves out the third order of that. */
static double turn_of(int limb_index)
{
    static const double turns_rad[] = {0.005, 0.02, 0.06};
    return turns_rad[limb_index % 3];
}

static double third_order(double turn_rad)
{
    return turn_rad * turn_rad * turn_rad;
}

/* The solver returns the tip's place twice: as the end of the stretched parts, and as the place for which it returns K.
 * Both must be the same place. */
static void test_the_parts_end_at_the_tip(void)
{
    state = 21u;
    int answered = 0;
    for (int n = 0; n < LIMBS; n++) {
        const double turn_rad = turn_of(n);
        if (!take_any_limb(turn_rad)) {
            continue;
        }
        answered++;
        const brace_space_link_t *const links[] = {&loaded.coxa, &loaded.femur, &loaded.tibia};
        double q[COORDINATES] = {0.0};
        for (int i = 0; i < BRACE_LINK_COUNT; i++) {
            q[ENDS + OF_END * i + END_STRETCH] =
                (double)(links[i]->stretch_root.x * shape.end_n[i].x + links[i]->stretch_root.z * shape.end_n[i].y);
        }
        brace_space_result_t r;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_loaded_space_stiffness(&loaded, &rest, &r));
        const vec_t at = walk_over(q).at;
        const double tibia_rad = theta1_rad - theta2_rad, femur_mm = (double)limb.femur_mm;
        const double tibia_mm = (double)limb.tibia_mm, reach_mm = (double)limb.coxa_mm + femur_mm + tibia_mm;
        const double x_mm = femur_mm * cos(theta1_rad) + tibia_mm * cos(tibia_rad);
        const double z_mm = femur_mm * sin(theta1_rad) + tibia_mm * sin(tibia_rad);
        const double base_x_mm = (double)(limb.base.x_mm_per_n * shape.whole_n.x);
        const double base_z_mm = (double)(limb.base.z_mm_per_n * shape.whole_n.y);
        const double within_mm = (0.4 * third_order(turn_rad) + 1.5e-5) * reach_mm;
        TEST_ASSERT_DOUBLE_WITHIN(within_mm, x_mm + (double)r.displacement_mm.x, at.x + base_x_mm);
        TEST_ASSERT_DOUBLE_WITHIN(within_mm, z_mm + (double)r.displacement_mm.z, at.y + base_z_mm);
        TEST_ASSERT_DOUBLE_WITHIN(within_mm, (double)r.displacement_mm.y, -at.z);
    }
    TEST_ASSERT_GREATER_OR_EQUAL(LIMBS - 1, answered);
}

/* At multiples of the load, up to the one at which the limb folds. */
static void test_the_determinant_is_that_of_the_load_s_work(void)
{
    state = 22u;
    int answered = 0;
    for (int n = 0; n < LIMBS; n++) {
        const double turn_rad = turn_of(n);
        if (!take_any_limb(turn_rad)) {
            continue;
        }
        take_matrix();
        for (double times = 1.0; times < 100.0; times *= 2.0) {
            if (turn_rad * times > 0.4) {
                continue; /* it is far beyond its load, and the third order is no longer small */
            }
            bool stands, stands_by_parts;
            const double wanted = determinant_at(times, &stands), is = pivots_at((float)times, &stands_by_parts);
            const double left = third_order(turn_rad) * times * times;
            TEST_ASSERT_DOUBLE_WITHIN(2.0 * left + 3e-6 * times, wanted, is);
            if (fabs(wanted) > 0.1) {
                TEST_ASSERT_EQUAL(stands, stands_by_parts);
            }
            answered++;
        }
    }
    TEST_ASSERT_TRUE(answered > 2 * LIMBS);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_parts_end_at_the_tip);
    RUN_TEST(test_the_determinant_is_that_of_the_load_s_work);
    return UNITY_END();
}
