/* What the parts of the integer path in space refuse: each word that a load may drive out of its range is driven
 * there alone, to the bound that its header names, just within it and just beyond. Nothing else is out of range, so
 * that no other check can refuse it. Values are judged by the same sums in double precision. */
#include <math.h>

#pragma GCC diagnostic ignored "-Wunused-function" /* this suite does not call all functions of the headers */
#include "fixed_space/invert.h"
#include "fixed_words.h"
#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

/* --- in space: rows, levers, turns ---------------------------------------------------------------------------- */

typedef void noting_t(fixed3_t v, noted_t *noted);

static void a_row(fixed3_t v, noted_t *noted)
{
    note_row(v, RANGES, noted);
}

static void an_overload_s_row(fixed3_t v, noted_t *noted)
{
    note_row(v, OVERLOAD_RANGES, noted);
}

static void levers_by_x(fixed3_t v, noted_t *noted)
{
    const fixed_axes_t levers = {v, {0, 0, 0}, {0, 0, 0}};
    note_levers(&levers, noted);
}

static void levers_by_y(fixed3_t v, noted_t *noted)
{
    const fixed_axes_t levers = {{0, 0, 0}, v, {0, 0, 0}};
    note_levers(&levers, noted);
}

static void levers_by_z(fixed3_t v, noted_t *noted)
{
    const fixed_axes_t levers = {{0, 0, 0}, {0, 0, 0}, v};
    note_levers(&levers, noted);
}

static void a_move(fixed3_t v, noted_t *noted)
{
    fixed_sum_t sum = {.c = {0, 0, 0, 0, 0, 0}};
    fixed_add_move(&sum, v, 0, noted);
}

/* What a link is turned about itself counts, and what it curls. */
static void twists(fixed3_t v, noted_t *noted)
{
    (void)fixed_twist_of(v.x, 0, noted);
    (void)fixed_twist_of(0, v.y, noted);
    (void)fixed_twist_of(v.z, 0, noted);
}

static void own_entries(fixed3_t v, ranges_t ranges, noted_t *noted)
{
    note_own(v.x, ranges, noted);
    note_own(v.y, ranges, noted);
    note_own(v.z, ranges, noted);
}

static void a_link_s_own(fixed3_t v, noted_t *noted)
{
    own_entries(v, RANGES, noted);
}

static void an_overload_s_own(fixed3_t v, noted_t *noted)
{
    own_entries(v, OVERLOAD_RANGES, noted);
}

/* A link's own turns, of which nothing yields: they go on as they are. */
static void a_link_s_turns(fixed3_t v, noted_t *noted)
{
    const fixed_link_factor_t rigid = {.between_q24 = 0};
    const fixed3_t none = {0, 0, 0}, turned = fixed_link_outwards(&rigid, v, none, noted);
    TEST_ASSERT_EQUAL_INT32(v.x, turned.x);
    TEST_ASSERT_EQUAL_INT32(v.y, turned.y);
    TEST_ASSERT_EQUAL_INT32(v.z, turned.z);
}

static void test_each_word_of_a_vector_is_noted(void)
{
    static const struct {
        noting_t *of;
        double most;
        int format;
    } row[] = {{a_row, 8.0, 24},       {an_overload_s_row, 1.0, 24}, {note_lever, 2.0, 26},    {levers_by_x, 2.0, 26},
               {levers_by_y, 2.0, 26}, {levers_by_z, 2.0, 26},       {a_move, 2.0, 26},        {note_turned, 1.0, 29},
               {a_link_s_turns, 1.0, 29}, {twists, 1.0, 29},         {a_link_s_own, 16.0, 24},
               {an_overload_s_own, 2.0, 24}};
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        const int32_t beyond = word(row[i].most, row[i].format), within = beyond - 1;
        for (int axis = 0; axis < 6; axis++) {
            const int32_t sign = axis % 2 == 0 ? 1 : -1;
            for (int is_beyond = 0; is_beyond < 2; is_beyond++) {
                const int32_t size = is_beyond != 0 ? beyond + 1 : within, at = axis / 2;
                const fixed3_t v = {at == 0 ? sign * size : 5, at == 1 ? sign * size : -5, at == 2 ? sign * size : 0};
                noted_t noted = 0u;
                row[i].of(v, &noted);
                TEST_ASSERT_EQUAL(is_beyond != 0, is_refused(noted));
            }
        }
    }
}

/* --- in space: entries ---------------------------------------------------------------------------------------- */

static int32_t *entry_of_matrix(fixed_sym3_t *m, int entry)
{
    int32_t *const entries[] = {&m->xx, &m->xy, &m->xz, &m->yy, &m->yz, &m->zz};
    return entries[entry];
}

static int32_t part_of(fixed3_t v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static const int first_axis[6] = {0, 0, 0, 1, 1, 2}, second_axis[6] = {0, 1, 2, 1, 2, 2};

/* m + a b', each entry below 4: what was there counts, and what is added. */
static void test_entries_of_a_matrix(void)
{
    for (int n = 0; n < 60 * TIMES; n++) {
        const bool is_overload = n % 2 != 0;
        const ranges_t ranges = is_overload ? OVERLOAD_RANGES : RANGES;
        const int entry = n / 2 % 6;
        const fixed3_t a = {word(any(-1.0, 1.0), 24), word(any(-1.0, 1.0), 24), word(any(-1.0, 1.0), 24)};
        const fixed3_t b = {word(any(-1.0, 1.0), ranges.ratio), word(any(-1.0, 1.0), ranges.ratio),
                            word(any(-1.0, 1.0), ranges.ratio)};
        fixed_sym3_t m = {word(any(-1.0, 1.0), 24), word(any(-1.0, 1.0), 24), word(any(-1.0, 1.0), 24),
                          word(any(-1.0, 1.0), 24), word(any(-1.0, 1.0), 24), word(any(-1.0, 1.0), 24)};
        *entry_of_matrix(&m, entry) = word(any(-5.0, 5.0), 24);
        double wanted[6];
        for (int e = 0; e < 6; e++) {
            wanted[e] = number(*entry_of_matrix(&m, e), 24) +
                        number(part_of(a, first_axis[e]), 24) * number(part_of(b, second_axis[e]), ranges.ratio);
        }
        noted_t noted = 0u;
        fixed_sym3_add(&m, a, b, ranges, &noted);
        for (int e = 0; e < 6; e++) { /* coarse products leave out three bits */
            TEST_ASSERT_DOUBLE_WITHIN(9.0 * 0x1p-24, wanted[e], number(*entry_of_matrix(&m, e), 24));
        }
        if (fabs(fabs(wanted[entry]) - 4.0) > 1e-6) {
            TEST_ASSERT_EQUAL(fabs(wanted[entry]) > 4.0, is_refused(noted));
        }
    }
}

/* --- in space: turns that a load makes ------------------------------------------------------------------------ */

/* A coordinate alone: its compliance times what drives it, less what it has turned over its pivot. Neither part is
 * above 2 rad, and together they are at most 1. What drives those before is less by its row. */
static void test_a_coordinate_that_is_driven(void)
{
    int within = 0, beyond = 0;
    for (int n = 0; n < 300 * TIMES; n++) {
        const double yields = any(0.0, 2.5), driven = any(-1.0, 1.0), per_pivot = any(0.2, 2.5), now = any(-1.0, 1.0);
        const fixed_factor_t factor = {{word(any(-7.0, 7.0), 24), word(any(-7.0, 7.0), 24), word(any(-7.0, 7.0), 24)},
                                       word(yields, 26), word(per_pivot, 27)};
        const fixed3_t before = {word(any(-8.0, 8.0), 24), word(any(-8.0, 8.0), 24), word(any(-8.0, 8.0), 24)};
        fixed3_t drives = before;
        noted_t noted = 0u;
        const int32_t is = fixed_inwards(&factor, word(driven, 24), word(now, 29), &drives, &noted);
        const double forth = yields * driven, back = per_pivot * now, by = forth - back;
        const double off = fmax(fmax(fabs(forth) / 2.0, fabs(back) / 2.0), fabs(by)) - 1.0;
        if (fabs(off) > 1e-5) {
            TEST_ASSERT_EQUAL(off > 0.0, is_refused(noted));
        }
        if (off > 0.0) {
            beyond++;
            continue;
        }
        within++;
        TEST_ASSERT_DOUBLE_WITHIN(2e-7, by, number(is, 29));
        for (int axis = 0; axis < 3; axis++) {
            const double left = number(part_of(before, axis), 24) - number(part_of(factor.row_q24, axis), 24) * by;
            TEST_ASSERT_DOUBLE_WITHIN(2e-6, left, number(part_of(drives, axis), 24));
        }
    }
    TEST_ASSERT_TRUE(within > 100 * TIMES && beyond > 30 * TIMES);
}

/* On the way back a link's turn about z turns it about y too. */
static void test_a_link_s_turns_on_the_way_out(void)
{
    int within = 0, beyond = 0;
    for (int n = 0; n < 300 * TIMES; n++) {
        const double row_y = any(-2.0, 2.0), row_z = any(-2.0, 2.0), between = any(-2.0, 2.0);
        const double y_yields = any(0.0, 0.8), z_yields = any(0.0, 0.8), turned_rad = any(-0.9, 0.9);
        const fixed_link_factor_t factor = {.y = {.row_q24 = {word(row_y, 24), 0, 0}, .yields_q26 = word(y_yields, 26)},
                                            .z = {.row_q24 = {word(row_z, 24), 0, 0}, .yields_q26 = word(z_yields, 26)},
                                            .between_q24 = word(between, 24)};
        const double alone_y = any(-1.0, 1.0), alone_z = any(-1.0, 1.0);
        const fixed3_t alone = {1, word(alone_y, 29), word(alone_z, 29)}, turned = {word(turned_rad, 29), 0, 0};
        noted_t noted = 0u;
        const fixed3_t is = fixed_link_outwards(&factor, alone, turned, &noted);
        const double z = alone_z - z_yields * row_z * turned_rad, y_at_first = alone_y - y_yields * row_y * turned_rad;
        const double y = y_at_first - y_yields * between * z;
        const double off = fmax(fmax(fabs(z), fabs(y_at_first)), fabs(y)) - 1.0;
        if (fabs(off) > 1e-5) {
            TEST_ASSERT_EQUAL(off > 0.0, is_refused(noted));
        }
        beyond += off > 0.0 ? 1 : 0;
        if (off < 0.0) {
            within++;
            TEST_ASSERT_DOUBLE_WITHIN(2e-7, y, number(is.y, 29));
            TEST_ASSERT_DOUBLE_WITHIN(2e-7, z, number(is.z, 29));
        }
    }
    TEST_ASSERT_TRUE(within > 60 * TIMES && beyond > 60 * TIMES);
}

/* The base turns by at most 1 rad, also where the coxa turns back so far that what is turned behind it is less. */
static void test_the_base_turns_by_a_radian_at_most(void)
{
    const fixed_commanded_t commanded = {{1 << 30, 0}, {1 << 30, 0}};
    const fixed_factors_t factors = {.coxa.z.per_pivot_q27 = 1 << 27, .base_yields_q26 = word(1.5, 26)};
    const brace_space_fixed_pose_t now = {.coxa = {0, 0, word(0.2, 29)}};
    for (int sign = -1; sign <= 1; sign += 2) {
        for (int is_beyond = 0; is_beyond < 2; is_beyond++) {
            const double turn_rad = sign * (is_beyond != 0 ? 1.0001 : 0.9999);
            const brace_space_fixed_pose_t drives = {.base = word(turn_rad / 1.5, 27)},
                                           turned_back = {.coxa = {0, 0, sign * now.coxa.z}};
            brace_space_fixed_pose_t by;
            noted_t noted = 0u;
            fixed_solve_straight(&factors, &drives, &turned_back, &commanded, &by, &noted);
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, turn_rad, number(by.base, 29));
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, -0.2 * sign, number(by.coxa.z, 29));
            TEST_ASSERT_EQUAL(is_beyond != 0, is_refused(noted));
        }
    }
}

/* The springs at a link's end: each turns its arm by a quarter at most, and the link's axial spring gives a quarter of
 * the unit of length. The spring yields by a quarter for a force of 1. */
static void test_the_springs_at_a_link_s_end(void)
{
    for (int spring = 0; spring < 3; spring++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            for (int is_beyond = 0; is_beyond < 2; is_beyond++) {
                const double force = sign * (is_beyond != 0 ? 1.00001 : 0.99999);
                const int32_t along = spring == 2 ? (1 << 30) - 1 : 0;
                const fixed_link3_t link = {.length_q28 = 1 << 26, .along_q30 = {along, spring == 0 ? 1 << 30 : 0},
                                            .across_arm_q31 = spring == 0 ? 1 << 24 : 0,
                                            .sideways_arm_q31 = spring == 1 ? 1 << 24 : 0,
                                            .stretch_q31 = spring == 2 ? INT32_MAX : 0};
                const fixed_rest3_t rest = {.turn_shift = 0, .spring_shift = 0};
                const int32_t f = word(force, 30);
                fixed_bent3_t bent = {.beyond_q30 = {spring == 1 ? 0 : f, 0, spring == 1 ? f : 0}};
                noted_t noted = 0u;
                fixed_bend_link(&link, &rest, fixed3(0, 0, 0), 0, &bent, &noted);
                TEST_ASSERT_EQUAL(is_beyond != 0, is_refused(noted));
            }
        }
    }
}

/* --- in space: the load taken many times ---------------------------------------------------------------------- */

/* A hinge under the load taken many times: its compliance over its pivot, and the pivot in the determinant. Refused
 * where a product is 1024 or more, or the compliance 65536. A pivot below a 64th counts as that. */
static void test_compliances_under_the_load_taken_many_times(void)
{
    int within = 0, beyond = 0, buckled = 0;
    for (int n = 0; n < 600 * TIMES; n++) {
        const double yields = pow(10.0, any(-2.0, 4.5)), size = pow(10.0, any(-2.0, 3.3)) / yields;
        const int32_t y = word(yields, 14), e = word(fmin(size, 120.0) * (n % 2 == 0 ? 1.0 : -1.0), 24);
        fixed_overload_t overload = {.mantissa_q31 = 1 << 30, .exponent = 1};
        noted_t noted = 0u;
        const int32_t is = overload_softened(y, e, &overload, &noted);
        const double product = number(y, 14) * number(e, 24), pivot = 1.0 + product;
        const double counts = copysign(fmax(fabs(pivot), 0x1p-6), pivot), softened = number(y, 14) / counts;
        const double off = fmax(fabs(product) / 1024.0, fabs(softened) / 65536.0) - 1.0;
        if (fabs(off) > 1e-4) {
            TEST_ASSERT_EQUAL(off > 0.0, is_refused(noted));
        }
        if (off > 0.0) {
            beyond++;
            continue;
        }
        within++;
        const double told = ldexp((double)overload.mantissa_q31, overload.exponent - 31);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * fabs(counts) + 0x1p-19, fabs(counts), told);
        TEST_ASSERT_TRUE(overload.mantissa_q31 >= 1 << 30);
        TEST_ASSERT_DOUBLE_WITHIN((1e-6 + 0x1p-19 / fabs(counts)) * fabs(softened) + 0x1p-13, softened, number(is, 14));
        if (fabs(pivot) > 1e-5) {
            TEST_ASSERT_EQUAL(pivot < 0.0, overload.is_negative);
            TEST_ASSERT_EQUAL(pivot < 0.0, overload.has_buckled);
            buckled += pivot < 0.0 ? 1 : 0;
        }
    }
    TEST_ASSERT_TRUE(within > 300 * TIMES && beyond > 10 * TIMES && buckled > 30 * TIMES);
}

/* A pivot of exactly 0 counts as a 64th in the determinant, and so in the compliance: both of the same sign. */
static void test_a_pivot_of_nothing_counts_alike_in_both(void)
{
    fixed_overload_t overload = {.mantissa_q31 = 1 << 30, .exponent = 1};
    noted_t noted = 0u;
    TEST_ASSERT_EQUAL_INT32(64 << 14, overload_softened(1 << 14, -(1 << 24), &overload, &noted));
    TEST_ASSERT_FALSE(overload.is_negative || overload.has_buckled || is_refused(noted));
    TEST_ASSERT_DOUBLE_WITHIN(0.0, 0x1p-6, ldexp((double)overload.mantissa_q31, overload.exponent - 31));
}

/* The determinant is the product of all pivots, its sign that of them. Once one is negative the limb has buckled. After
 * a refusal it stays as it is. */
static void test_a_determinant_is_the_product_of_its_pivots(void)
{
    fixed_overload_t overload = {.mantissa_q31 = 1 << 30, .exponent = 1};
    double wanted = 1.0, within = 0.0;
    bool has_buckled = false;
    for (int n = 0; n < 60; n++) {
        const double pivot = pow(10.0, any(-1.5, 3.0)) * (n % 7 == 5 ? -1.0 : 1.0);
        multiply_determinant(&overload, (uint32_t)word(fabs(pivot), 20), pivot < 0.0);
        wanted *= number(word(fabs(pivot), 20), 20) * (pivot < 0.0 ? -1.0 : 1.0);
        has_buckled = has_buckled || pivot < 0.0;
        within += 0x1p-19 / fabs(pivot); /* a mantissa of 30 bits times a pivot of q20 is rounded down */
        const double told = ldexp((double)overload.mantissa_q31, overload.exponent - 31);
        TEST_ASSERT_DOUBLE_WITHIN(within, 1.0, told / fabs(wanted));
        TEST_ASSERT_EQUAL(wanted < 0.0, overload.is_negative);
        TEST_ASSERT_EQUAL(has_buckled, overload.has_buckled);
    }
    overload = (fixed_overload_t){.mantissa_q31 = 1 << 30, .exponent = 1, .is_refused = true};
    multiply_determinant(&overload, 3u << 20, true);
    TEST_ASSERT_EQUAL_INT32(1 << 30, overload.mantissa_q31);
    TEST_ASSERT_EQUAL_INT32(1, overload.exponent);
    TEST_ASSERT_FALSE(overload.is_negative || overload.has_buckled);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_word_of_a_vector_is_noted);
    RUN_TEST(test_entries_of_a_matrix);
    RUN_TEST(test_a_coordinate_that_is_driven);
    RUN_TEST(test_a_link_s_turns_on_the_way_out);
    RUN_TEST(test_the_base_turns_by_a_radian_at_most);
    RUN_TEST(test_the_springs_at_a_link_s_end);
    RUN_TEST(test_compliances_under_the_load_taken_many_times);
    RUN_TEST(test_a_pivot_of_nothing_counts_alike_in_both);
    RUN_TEST(test_a_determinant_is_the_product_of_its_pivots);
    return UNITY_END();
}
