/* The integer path in the plane beside the limb's whole matrix in double precision. Two links with two curvatures each
 * and two joints are six coordinates: I + c (t G - t^2 S), where c yields, G resists and S softens at t times the load.
 * Its leading minors, its inverse and its determinant share no step with the eliminations and expansions of the
 * integers. What leaves a word is judged in test_fixed_solve.c. */
#include <math.h>
#include <string.h>

#pragma GCC diagnostic ignored "-Wunused-function" /* this suite does not call all functions of the headers */
#include "brace/status.h"
#include "loaded/fixed_buckling.h"
#include "loaded/fixed_compliance.h"
#include "fixed_words.h"
#include "unity.h"

enum { KNEE_A, KNEE_B, KNEE, HIP_A, HIP_B, HIP, COORDINATES }; /* from the tip to the hip */

typedef struct {
    fixed_rest_t femur, tibia;
    fixed_stance_t stance;
} limb_t;

static limb_t limb;

void setUp(void)
{
    state = 7u;
}

void tearDown(void) {}

/* --- limbs by chance ------------------------------------------------------------------------------------------ */

static fixed_vec_t any_vec(double most, int format)
{
    return (fixed_vec_t){word(any(-most, most), format), word(any(-most, most), format)};
}

/* What a link resists at any load, up to `most`; each word may be large or small beside the others. */
static void any_rest(double most, fixed_rest_t *rest)
{
    int32_t w[8];
    for (int i = 0; i < 8; i++) {
        w[i] = word(any(-most, most) * pow(10.0, any(-1.5, 0.0)), 27);
    }
    *rest = (fixed_rest_t){.resists = {w[0], w[1], w[2], w[3], w[4], w[5]},
                           .end_resists = w[6],
                           .root_softens = word(any(0.0, 0.2) * most, 27),
                           .end_softens = word(any(0.0, 0.2) * most, 27),
                           .tip = any_vec(0.9, 28),
                           .a = any_vec(0.7, 28),
                           .b = any_vec(0.7, 28),
                           .end = any_vec(0.2, 28),
                           .aside = any_vec(0.2, 28),
                           .root_spring = any_vec(0.3, 30),
                           .end_spring = any_vec(0.3, 30)};
}

static void take_any_limb(double resists_most)
{
    any_rest(resists_most, &limb.femur);
    any_rest(resists_most, &limb.tibia);
    limb.stance = (fixed_stance_t){&limb.femur,
                                   &limb.tibia,
                                   word(any(0.1, 1.0), 29),
                                   word(any(0.1, 1.0), 29),
                                   word(any(0.1, 1.5), 29),
                                   word(any(0.1, 1.5), 29)};
}

/* --- the matrix ----------------------------------------------------------------------------------------------- */

/* A link's root and curvatures, at `times` the load. */
static void link_matrix(const fixed_rest_t *rest, double times, double m[3][3])
{
    const fixed_matrix_t *r = &rest->resists;
    const double end = times * number(rest->end_resists, 27) - times * times * number(rest->end_softens, 27);
    const int32_t words[3][3] = {{r->rr, r->ra, r->rb}, {r->ra, r->aa, r->ab}, {r->rb, r->ab, r->bb}};
    for (int i = 0; i < 9; i++) {
        m[i / 3][i % 3] = times * number(words[i / 3][i % 3], 27) + end;
    }
    m[0][0] -= times * times * number(rest->root_softens, 27);
}

/* Which of a link's root and curvatures each coordinate turns. The femur's turn the tibia's root. */
enum { ROOT, CURVATURE_A, CURVATURE_B, NOTHING };
static const int turns_tibia[COORDINATES] = {CURVATURE_A, CURVATURE_B, ROOT, ROOT, ROOT, ROOT};
static const int turns_femur[COORDINATES] = {NOTHING, NOTHING, NOTHING, CURVATURE_A, CURVATURE_B, ROOT};

static double yields_of(int coordinate)
{
    const fixed_stance_t *s = &limb.stance;
    const int32_t words[COORDINATES] = {s->tibia_bend, s->tibia_bend, s->knee, s->femur_bend, s->femur_bend, s->hip};
    return number(words[coordinate], 29);
}

static void whole_matrix(double times, double m[COORDINATES][COORDINATES])
{
    double tibia[3][3], femur[3][3];
    link_matrix(&limb.tibia, times, tibia);
    link_matrix(&limb.femur, times, femur);
    for (int i = 0; i < COORDINATES; i++) {
        for (int j = 0; j < COORDINATES; j++) {
            double sum = tibia[turns_tibia[i]][turns_tibia[j]];
            if (turns_femur[i] != NOTHING && turns_femur[j] != NOTHING) {
                sum += femur[turns_femur[i]][turns_femur[j]];
            }
            m[i][j] = (i == j ? 1.0 : 0.0) + yields_of(i) * sum;
        }
    }
}

typedef struct {
    double determinant, magnitudes, least_minor;
} minors_t;

/* Laplace's expansion, for the first rows and every choice of as many columns. magnitudes: the same sum of magnitudes,
 * which bounds what rounding does. least_minor: of all leading minors, each over the sum of its magnitudes. */
static minors_t minors_at(double times)
{
    double m[COORDINATES][COORDINATES], minor[1 << COORDINATES] = {1.0}, sizes[1 << COORDINATES] = {1.0};
    minors_t minors = {.least_minor = 1.0};
    whole_matrix(times, m);
    for (uint32_t columns = 1; columns < 1u << COORDINATES; columns++) {
        const int row = __builtin_popcount(columns) - 1;
        double sign = 1.0;
        minor[columns] = sizes[columns] = 0.0;
        for (int column = COORDINATES - 1; column >= 0; column--) {
            if ((columns >> column & 1u) != 0u) {
                const uint32_t others = columns & ~(1u << column);
                const double one = column == row ? 1.0 : 0.0;
                minor[columns] += sign * m[row][column] * minor[others];
                sizes[columns] += (one + fabs(m[row][column] - one)) * sizes[others];
                sign = -sign;
            }
        }
        if (columns == (2u << row) - 1u) {
            minors.determinant = minor[columns], minors.magnitudes = sizes[columns];
            minors.least_minor = fmin(minors.least_minor, minor[columns] / sizes[columns]);
        }
    }
    return minors;
}

static double value_of(fixed_wide_t wide)
{
    return ldexp((double)wide.mantissa_q31, wide.exponent - 31);
}

/* --- at the present load -------------------------------------------------------------------------------------- */

/* Solves m x = b by Gauss's elimination with pivots. */
static void solve(double m[COORDINATES][COORDINATES], double x[COORDINATES])
{
    for (int i = 0; i < COORDINATES; i++) {
        int pivot = i;
        for (int row = i + 1; row < COORDINATES; row++) {
            pivot = fabs(m[row][i]) > fabs(m[pivot][i]) ? row : pivot;
        }
        for (int column = 0; column < COORDINATES; column++) {
            const double kept_ = m[i][column];
            m[i][column] = m[pivot][column], m[pivot][column] = kept_;
        }
        const double kept_ = x[i];
        x[i] = x[pivot], x[pivot] = kept_;
        for (int row = 0; row < COORDINATES; row++) {
            const double by = row == i ? 0.0 : m[row][i] / m[i][i];
            for (int column = i; column < COORDINATES; column++) {
                m[row][column] -= by * m[i][column];
            }
            x[row] -= by * x[i];
        }
    }
    for (int i = 0; i < COORDINATES; i++) {
        x[i] /= m[i][i];
    }
}

/* How a coordinate moves the tip along an axis: what it turns, times the levers of that. */
static double lever_of(int coordinate, int axis)
{
    const fixed_rest_t *const rests[] = {&limb.tibia, &limb.femur};
    const int turned[] = {turns_tibia[coordinate], turns_femur[coordinate]};
    double sum = 0.0;
    for (int link = 0; link < 2; link++) {
        const fixed_rest_t *rest = rests[link];
        const fixed_vec_t root = fixed_minus(fixed_quarter(rest->tip), rest->aside);
        const fixed_vec_t levers[3] = {root, fixed_plus(rest->a, rest->end), fixed_plus(rest->b, rest->end)};
        if (turned[link] != NOTHING) {
            sum += number(axis == 0 ? levers[turned[link]].x : levers[turned[link]].z, 28);
        }
    }
    return sum;
}

static double tensor_of(uint64_t entry, int format)
{
    return ldexp((double)(int64_t)entry, -format);
}

/* The pivots' product is the determinant. What the coordinates yield, seen at the tip, is C = L' (I + c G)^-1 c L, and
 * the springs' ends add their own. */
static void test_what_a_limb_s_matrix_shows_of_the_tip(void)
{
    int answered = 0;
    for (int n = 0; n < 300 * TIMES; n++) {
        take_any_limb(n % 2 == 0 ? 0.1 : 0.5);
        const minors_t minors = minors_at(1.0);
        fixed_pivots_t p;
        if (minors.least_minor < 0.1 || !fixed_pivots_of(&limb.stance, &p)) {
            continue;
        }
        const double within = 3e-7 / (minors.least_minor * minors.least_minor);
        TEST_ASSERT_DOUBLE_WITHIN(within, 1.0, value_of(fixed_product(&p)) / minors.determinant);

        lost_t lost = 0u;
        const fixed_vec_t none = {0, 0};
        fixed_tensor_t c = {0, 0, 0}, springs = {0, 0, 0};
        const fixed_vec_t by_knee = add_link(&c, &springs, &limb.tibia, &p.tibia, 0u, none, &lost);
        add_scaled(&c, by_knee, kept((int64_t)limb.stance.knee * p.per_knee, 27, ROOM_COMPLIANCE, &lost));
        const fixed_vec_t beyond = {times(by_knee.x, p.per_knee, 27), times(by_knee.z, p.per_knee, 27)};
        const fixed_vec_t by_hip = add_link(&c, &springs, &limb.femur, &p.femur, 0u, beyond, &lost);
        add_scaled(&c, by_hip, kept((int64_t)limb.stance.hip * p.per_hip, 27, ROOM_COMPLIANCE, &lost));
        if (lost >= LOST) {
            continue;
        }
        answered++;
        double wanted[2][2] = {{0.0}};
        for (int axis = 0; axis < 2; axis++) {
            double m[COORDINATES][COORDINATES], x[COORDINATES];
            whole_matrix(1.0, m);
            for (int i = 0; i < COORDINATES; i++) {
                x[i] = yields_of(i) * lever_of(i, axis);
            }
            solve(m, x);
            for (int i = 0; i < COORDINATES; i++) {
                wanted[axis][0] += lever_of(i, 0) * x[i];
                wanted[axis][1] += lever_of(i, 1) * x[i];
            }
        }
        const double off = within * (1.0 + wanted[0][0] + wanted[1][1]);
        TEST_ASSERT_DOUBLE_WITHIN(off, wanted[0][0], tensor_of(c.xx, 54));
        TEST_ASSERT_DOUBLE_WITHIN(off, wanted[0][1], tensor_of(c.xz, 54));
        TEST_ASSERT_DOUBLE_WITHIN(off, wanted[1][1], tensor_of(c.zz, 54));

        double moved[3] = {0.0};
        const fixed_vec_t ends[] = {limb.tibia.root_spring, limb.tibia.end_spring, limb.femur.root_spring,
                                    limb.femur.end_spring};
        for (int i = 0; i < 4; i++) {
            const double x = number(ends[i].x, 30), z = number(ends[i].z, 30);
            moved[0] += x * x, moved[1] += x * z, moved[2] += z * z;
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, moved[0], tensor_of(springs.xx, 60));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, moved[1], tensor_of(springs.xz, 60));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, moved[2], tensor_of(springs.zz, 60));
    }
    TEST_ASSERT_TRUE(answered > 100 * TIMES);
}

/* --- at a multiple of the load -------------------------------------------------------------------------------- */

/* The largest of all words by its power of two. */
static int power_of(const int32_t words[], int count, int format)
{
    double most = 0.0;
    int power;
    for (int i = 0; i < count; i++) {
        most = fmax(most, fabs(number(words[i], format)));
    }
    (void)frexp(most, &power);
    return power;
}

/* The matrix is taken as 2^-scale of itself, so that the sum of three moments times a compliance stays below 1 in q30.
 * What grows with the square of the load may be 16 times as large in the end. Three factors of 2^-scale are in a link's
 * determinant with its joint, the smallest number that is rounded by 2^-30: some ten times, and more often what is
 * shifted up by octaves. scale: written. */
static double rounding_at(int octaves, int *scale)
{
    const fixed_rest_t *f = &limb.femur, *t = &limb.tibia;
    const fixed_stance_t *s = &limb.stance;
    const int32_t moments[] = {f->resists.rr,        f->resists.ra,      f->resists.rb,  f->resists.aa,
                               f->resists.ab,        f->resists.bb,      f->end_resists, 16 * f->root_softens,
                               16 * f->end_softens,  t->resists.rr,      t->resists.ra,  t->resists.rb,
                               t->resists.aa,        t->resists.ab,      t->resists.bb,  t->end_resists,
                               16 * t->root_softens, 16 * t->end_softens};
    const int32_t compliances[] = {s->femur_bend, s->tibia_bend, s->hip, s->knee};
    *scale = power_of(moments, 18, 27) + power_of(compliances, 4, 29) + 4 + octaves;
    return *scale > 1 ? 8.0 * *scale * ldexp(1.0, 3 * *scale - 30) : 16.0 * 0x1p-27;
}

enum { SCALE_MOST = 5 }; /* beyond it the determinant's bits are few; such limbs have buckled long before */

/* The limb at so many half octaves above its load. */
typedef struct {
    double determinant, off; /* by rounding */
    bool is_known, is_stable;
} softer_t;

static softer_t softer(int half_octaves)
{
    int scale;
    const minors_t minors = minors_at(pow(2.0, 0.5 * half_octaves));
    const double rounding = rounding_at((half_octaves + 1) / 2, &scale);
    return (softer_t){minors.determinant, rounding * minors.magnitudes,
                      scale <= SCALE_MOST && fabs(minors.least_minor) > rounding, minors.least_minor > 0.0};
}

/* At every half octave that the search may look at: the determinant, and whether all leading minors are above zero. */
static void test_the_determinant_at_a_multiple_of_the_load(void)
{
    int stable = 0, unstable = 0;
    for (int n = 0; n < 150 * TIMES; n++) {
        take_any_limb(pow(10.0, any(-2.5, -0.8)));
        const fixed_search_t search = fixed_search_of(&limb.stance);
        for (int half_octaves = 1; half_octaves <= 7; half_octaves++) {
            const softer_t wanted = softer(half_octaves);
            const fixed_softened_t is = fixed_softened(&search, half_octaves);
            if (wanted.is_known) {
                TEST_ASSERT_DOUBLE_WITHIN(wanted.off, wanted.determinant, value_of(is.determinant));
                TEST_ASSERT_EQUAL(wanted.is_stable, is.is_stable);
                stable += wanted.is_stable ? 1 : 0;
                unstable += wanted.is_stable ? 0 : 1;
            }
        }
    }
    TEST_ASSERT_TRUE(stable > 200 * TIMES && unstable > 100 * TIMES);
}

/* The root of the parabola through three determinants: one step of Newton's method from the chord's root, as
 * loaded/buckling.h has it, with the loads themselves. off: how far rounding moves it. */
static double root_of_parabola(const double at[3], const softer_t d[3], double *off)
{
    const double span = at[2] - at[1], chord = (d[2].determinant - d[1].determinant) / span;
    const double bend = ((d[0].determinant - d[1].determinant) / (at[0] - at[1]) - chord) / (at[0] - at[2]);
    const double from_chord = -d[1].determinant / chord, root = at[1] + from_chord;
    const double slope = chord + bend * (root - at[1] + root - at[2]);
    const double fall = fabs(chord * span), kept_ = fmax(slope / chord, 0.0625);
    const double rho = fabs(d[0].determinant - d[1].determinant) / fall;
    *off = (d[0].off + d[1].off + d[2].off + 4.0 * 0x1p-28) * (1.0 + rho) / (fall * kept_ * kept_) + 1e-6;
    if (slope / chord < 0.0625) { /* the parabola does not fall there: its chord counts */
        *off += fabs(slope / chord - 0.0625) < *off ? 1.0 : 0.0;
        return root;
    }
    *off += rho > 7.9 ? 1.0 : 0.0;
    return fmin(at[2], fmax(at[1], root - bend * from_chord * (root - at[2]) / slope));
}

/* A tibia that buckles in both curvatures at much the same load: the determinant falls below zero and rises again. */
static void buckle_twice(void)
{
    const double bend = any(0.3, 0.9), resists = any(0.15, 0.9) / bend;
    fixed_stance_t *s = &limb.stance;
    take_any_limb(0.003);
    s->femur_bend = s->tibia_bend = s->hip = s->knee = word(bend, 29);
    limb.tibia.resists.aa = word(-resists, 27), limb.tibia.resists.bb = word(-1.05 * resists, 27);
}

/* The search takes four, two and one half octaves, each if the limb is stable there. It ends between the last load that
 * the limb bears and the next half octave, by the parabola through these and the load that it has borne before; without
 * one that is no load at all, where every pivot is 1. */
static void test_the_search_for_the_buckling_factor(void)
{
    int factors = 0, chances = 0, endless = 0;
    for (int n = 0; n < 400 * TIMES; n++) {
        if (n % 4 == 3) {
            buckle_twice();
        } else {
            take_any_limb(pow(10.0, any(-2.5, -0.6)));
        }
        softer_t of[8];
        for (int half_octaves = 0; half_octaves < 8; half_octaves++) {
            of[half_octaves] = softer(half_octaves);
        }
        if (!of[0].is_known || !of[0].is_stable) {
            continue;
        }
        int exponent, at = 0, before = -1;
        const double mantissa = frexp(of[0].determinant, &exponent);
        const fixed_wide_t now = {(int32_t)(mantissa * 0x1p31), exponent};
        bool is_known = true;
        for (int step = 4; step != 0; step /= 2) {
            is_known = is_known && of[at + step].is_known;
            if (of[at + step].is_stable) {
                before = at, at += step;
            }
        }
        if (!is_known) {
            continue;
        }
        const float factor = fixed_buckling_factor(&limb.stance, now);
        if (at == 7) {
            TEST_ASSERT_TRUE(isinf(factor) && factor > 0.0f);
            endless++;
            continue;
        }
        const double low = pow(2.0, 0.5 * at), high = pow(2.0, 0.5 * (at + 1));
        if (fabs(of[at + 1].determinant) < of[at + 1].off) {
            continue;
        }
        if (of[at + 1].determinant > 0.0) { /* a second pivot is below zero, too */
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.5 * (1.0 + high / low), (double)factor / low);
            chances++;
            continue;
        }
        const softer_t none = {.determinant = 1.0};
        const softer_t d[3] = {before < 0 ? none : of[before], of[at], of[at + 1]};
        const double loads[3] = {before < 0 ? 0.0 : pow(2.0, 0.5 * before) / low, 1.0, high / low};
        double off;
        const double root = root_of_parabola(loads, d, &off);
        TEST_ASSERT_DOUBLE_WITHIN(off, root, (double)factor / low);
        factors += off < 2e-3 ? 1 : 0;
    }
    TEST_ASSERT_TRUE(factors > 10 * TIMES && chances > TIMES && endless > 10 * TIMES);
}

/* --- K -------------------------------------------------------------------------------------------------------- */

/* C of any size and slenderness, as far as its word holds it, turned by any angle: K is its inverse, seen from the
 * world. A C that is more slender than 2e-5 is flagged, beyond 3e-8 and outside its word it is refused. */
static void test_K_is_C_inverted_and_turned(void)
{
    const double turn = 6.283185307179586;
    int answered = 0, flagged = 0, refused = 0;
    for (int n = 0; n < 500 * TIMES; n++) {
        const double size = pow(2.0, any(-36.0, 11.0)), slender = pow(10.0, any(-9.0, 0.0)), axis = any(-3.2, 3.2);
        const double x = cos(axis), z = sin(axis), theta1 = any(-0.5, 0.5) * turn, least = 0.25 * size * slender;
        const fixed_tensor_t c = {(uint64_t)(int64_t)ldexp(size * x * x + least * z * z, 54),
                                  (uint64_t)(int64_t)ldexp((size - least) * x * z, 54),
                                  (uint64_t)(int64_t)ldexp(size * z * z + least * x * x, 54)};
        const int exponent = (int)any(-20.0, 20.0);
        brace_stiffness_t is;
        memset(&is, 0x5a, sizeof is);
        const uint32_t theta1_turn = (uint32_t)(int64_t)floor(theta1 / turn * 0x1p32);
        const brace_status_t status = size < 256.0 ? stiffness_of(&c, theta1_turn, exponent, &is) : BRACE_E_SINGULAR;
        const double xx = tensor_of(c.xx, 54), xz = tensor_of(c.xz, 54), zz = tensor_of(c.zz, 54), trace = xx + zz;
        const double det = xx * zz - xz * xz, largest = 0.5 * trace + hypot(0.5 * (xx - zz), xz);
        const double ratio = 4.0 * det / (trace * trace);
        if (trace < 0x1p-34 || ratio < 1.4e-8 || size >= 256.0) {
            TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, status);
            refused++;
            continue;
        }
        if (ratio < 7e-8 || fabs(ratio / 2e-5 - 1.0) < 1e-3) {
            continue;
        }
        TEST_ASSERT_EQUAL(BRACE_OK, status);
        TEST_ASSERT_EQUAL(ratio < 2e-5 ? BRACE_FLAG_NEAR_SINGULAR : 0u, is.flags);
        answered++;
        flagged += ratio < 2e-5 ? 1 : 0;
        const double k_xx = zz / det, k_zz = xx / det, k_xz = -xz / det;
        const double unit = ldexp(1.0, -exponent), most = largest / det, p = cos(theta1), q = sin(theta1);
        const double within = 2.5e-7 * most;
        const double world_xx = p * p * k_xx - 2.0 * p * q * k_xz + q * q * k_zz;
        const double world_xz = p * q * (k_xx - k_zz) + (p * p - q * q) * k_xz;
        TEST_ASSERT_DOUBLE_WITHIN(within, world_xx, (double)is.k_xx_n_per_mm * unit);
        TEST_ASSERT_DOUBLE_WITHIN(within, k_xx + k_zz - world_xx, (double)is.k_zz_n_per_mm * unit);
        TEST_ASSERT_DOUBLE_WITHIN(within, world_xz, (double)is.k_xz_n_per_mm * unit);
        TEST_ASSERT_DOUBLE_WITHIN(within, most, (double)is.lambda_max_n_per_mm * unit);
        TEST_ASSERT_DOUBLE_WITHIN(2e-7, 1.0, (double)is.lambda_min_n_per_mm * unit * largest);
        if (slender < 0.5) { /* K is stiffest across what yields most */
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.0, sin(axis + 0.25 * turn + theta1 - (double)is.stiff_axis_rad));
            TEST_ASSERT_TRUE(fabs((double)is.stiff_axis_rad) < 0.25 * turn + 1e-6);
        }
    }
    TEST_ASSERT_TRUE(answered > 200 * TIMES && flagged > 50 * TIMES && refused > 50 * TIMES);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_a_limb_s_matrix_shows_of_the_tip);
    RUN_TEST(test_the_determinant_at_a_multiple_of_the_load);
    RUN_TEST(test_the_search_for_the_buckling_factor);
    RUN_TEST(test_K_is_C_inverted_and_turned);
    return UNITY_END();
}
