/* Straight limbs pressed along themselves buckle at the load that their energy gives, whatever load they bear now. The
 * column is worked out from tip to base in closed form; the three paths have none of its formulas. */
#include <math.h>
#include <string.h>

#include "loaded_paths.h"
#include "unity.h"

void setUp(void)
{
    start_anew();
}

void tearDown(void) {}

/* A column from the tip to the base, under a force along it: how far it is aside there, and its slope. */
typedef struct {
    double aside_mm, slope;
} column_t;

/* Goes over one link. `share` of its bending compliance is the beam's; the rest is the spring at the link's end, which
 * moves the end across the link. A link without a beam is rigid. */
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

/* What bends a column in one direction: compliances of the links and of the hinges at their ends towards the base, and
 * the link that stands on the base. */
typedef struct {
    double bending_mm_per_n[BRACE_LINK_COUNT], hinge_rad_per_n_mm[BRACE_LINK_COUNT];
    int last;
} direction_t;

/* Slope at the base when the slope at the tip is 1. The column stands while this is above zero. */
static double slope_at_base(const direction_t *direction, double force_n)
{
    column_t at = {0.0, 1.0};
    const float length_mm[BRACE_LINK_COUNT] = {limb.coxa_mm, limb.femur_mm, limb.tibia_mm};
    for (int i = BRACE_TIBIA; i >= direction->last; i--) {
        add_link(&at, force_n, (double)length_mm[i], direction->bending_mm_per_n[i],
                 (double)limb.link[i].moment_transfer);
        add_hinge(&at, force_n, direction->hinge_rad_per_n_mm[i]);
    }
    return at.slope;
}

/* In the plane the limb ends at the hip, whose hinge turns with the base's rotation. */
static direction_t in_the_plane(void)
{
    direction_t direction = {.last = BRACE_FEMUR};
    for (int i = BRACE_FEMUR; i <= BRACE_TIBIA; i++) {
        direction.bending_mm_per_n[i] = (double)limb.link[i].bending_mm_per_n;
        direction.hinge_rad_per_n_mm[i] = (double)limb.joint[i].compliance_rad_per_n_mm;
    }
    direction.hinge_rad_per_n_mm[BRACE_FEMUR] += (double)limb.base.rotation_rad_per_n_mm;
    return direction;
}

/* In space the coxa link goes on to the base, on which it does not turn up or down. */
static direction_t upwards(void)
{
    direction_t direction = in_the_plane();
    direction.last = BRACE_COXA;
    direction.bending_mm_per_n[BRACE_COXA] = (double)limb.link[BRACE_COXA].bending_mm_per_n;
    direction.hinge_rad_per_n_mm[BRACE_FEMUR] = (double)limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm;
    return direction;
}

/* Across its plane the limb turns about the coxa joint alone. */
static direction_t sideways(void)
{
    direction_t direction = {.last = BRACE_COXA};
    for (int i = BRACE_COXA; i <= BRACE_TIBIA; i++) {
        direction.bending_mm_per_n[i] = (double)limb.link[i].lateral_mm_per_n;
    }
    direction.hinge_rad_per_n_mm[BRACE_COXA] = (double)limb.joint[BRACE_COXA].compliance_rad_per_n_mm;
    return direction;
}

static const double force_most_n = 5000.0; /* a limb that bears more does not buckle here */

/* Force [N] under which a column first has no slope at its base. */
static double buckles_at(direction_t direction)
{
    double below = 0.0, above = 0.1;
    while (slope_at_base(&direction, above) > 0.0 && above < force_most_n) {
        below = above, above *= 1.1; /* the second such force is far beyond the first */
    }
    for (int halving = 0; halving < 30; halving++) {
        const double middle = 0.5 * (below + above);
        *(slope_at_base(&direction, middle) > 0.0 ? &below : &above) = middle;
    }
    return below;
}

/* What yields in a column, and how far its factors may be off. With hinges alone the determinant is at most a parabola
 * in the load, on which the search ends. Then only rounding is left; in integers it is 2^-12 of the largest number in
 * the search. With beams the parabola holds near the root only, and the core follows a beam's sine by two curvatures:
 * a beam that yields alone is off most. In space femur and tibia are one part each. */
typedef struct {
    float yaw, hip, knee;       /* rad/(N mm) */
    float bending[3], lateral[3], share[3], rotation;
    double in_plane[PATHS], in_space;
} yields_t;

static const yields_t columns[] = {
    {.hip = 1e-5f, .in_plane = {2e-5, 5e-4}, .in_space = 1e-5},
    {.knee = 2e-5f, .in_plane = {2e-5, 5e-4}, .in_space = 1e-5},
    {.hip = 1e-5f, .knee = 2e-5f, .in_plane = {2e-5, 5e-4}, .in_space = 1e-5},
    {.hip = 1e-5f, .knee = 2e-5f, .rotation = 5e-6f, .in_plane = {2e-5, 5e-4}},
    {.yaw = 1e-5f, .in_space = 1e-5},
    {.bending = {0.0f, 0.5f, 0.0f}, .share = {0.0f, 1.0f, 0.0f}, .in_plane = {1e-3, 1e-3}, .in_space = 2e-3},
    {.bending = {0.0f, 0.0f, 1.0f}, .share = {0.0f, 0.0f, 1.0f}, .in_plane = {8e-3, 8e-3}, .in_space = 0.05},
    {.bending = {0.0f, 0.5f, 1.0f}, .share = {0.0f, 1.0f, 1.0f}, .in_plane = {1e-3, 1e-3}, .in_space = 3e-3},
    {.hip = 1e-5f, .knee = 1e-5f, .bending = {0.0f, 0.5f, 1.0f}, .in_plane = {2e-3, 2e-3}, .in_space = 1e-4},
    {.hip = 1e-5f,
     .knee = 1e-5f,
     .bending = {0.0f, 0.2f, 0.3f},
     .share = {0.0f, 0.5f, 0.8f},
     .rotation = 2e-6f,
     .in_plane = {5e-4, 5e-4}},
    {.lateral = {0.01f, 0.5f, 0.8f}, .share = {1.0f, 1.0f, 1.0f}, .in_space = 2e-3},
    {.yaw = 1e-5f, .lateral = {0.01f, 0.2f, 0.3f}, .share = {0.5f, 0.4f, 0.7f}, .in_space = 5e-4},
    {.hip = 1e-5f,
     .knee = 1e-5f,
     .bending = {0.02f, 0.2f, 0.3f},
     .share = {0.0f, 1.0f, 1.0f},
     .in_plane = {5e-4, 5e-4},
     .in_space = 1e-3},
    {.yaw = 1e-5f,
     .hip = 1e-5f,
     .knee = 1e-5f,
     .bending = {0.02f, 0.2f, 0.3f},
     .lateral = {0.0f, 0.2f, 0.3f},
     .share = {1.0f, 0.5f, 0.8f},
     .in_plane = {5e-4, 5e-4},
     .in_space = 5e-4},
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
                                      .moment_transfer = of->share[i]};
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

/* Beyond its buckling load nothing stands. */
static void test_columns_in_the_plane_buckle_as_their_energy_says(void)
{
    for (uint32_t n = 0; n < sizeof columns / sizeof *columns; n++) {
        const yields_t *of = &columns[n];
        be_column(of);
        const double buckles_n = buckles_at(in_the_plane());
        for (int i = 0; i < 60 * PATHS && of->in_plane[FLOATS] > 0.0; i += STRIDE) {
            const path_t path = (path_t)(i % PATHS);
            const double factor = 1.02 * pow(1.05, i / PATHS);
            brace_loaded_stiffness_t r;
            const brace_status_t status = status_in_plane(path, -buckles_n / factor, 0.0, &r);
            TEST_ASSERT_TRUE(status == BRACE_OK || (path == INTEGERS && factor < 2.1));
            if (status == BRACE_OK) {
                expect_factor(factor, (double)r.buckling_factor, of->in_plane[path]);
            }
        }
        for (int i = 0; i < 20 * PATHS && of->in_plane[FLOATS] > 0.0; i += STRIDE) {
            const double beyond = 1.01 + 0.05 * (i / PATHS);
            brace_loaded_stiffness_t r;
            TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, status_in_plane((path_t)(i % PATHS), -buckles_n * beyond, 0.0, &r));
        }
    }
}

/* Beyond its buckling load nothing is promised. */
static void test_columns_in_space_buckle_as_their_energy_says(void)
{
    for (uint32_t n = 0; n < sizeof columns / sizeof *columns; n++) {
        const yields_t *of = &columns[n];
        be_column(of);
        const double buckles_n = fmin(buckles_at(upwards()), buckles_at(sideways()));
        brace_space_result_t r;
        for (int i = 0; i < 60 && of->in_space > 0.0; i += STRIDE) {
            const double factor = 1.02 * pow(1.05, i), force_n[3] = {-buckles_n / factor, 0.0, 0.0};
            float told;
            TEST_ASSERT_EQUAL(BRACE_OK, status_in_space(force_n, &r, &told));
            expect_factor(factor, (double)told, of->in_space);
        }
        for (int i = 0; i < 20 && of->in_space > 0.0; i += STRIDE) {
            const double force_n[3] = {-buckles_n * (1.01 + 0.05 * i), 0.0, 0.0};
            float told = 0.0f;
            TEST_ASSERT_TRUE(status_in_space(force_n, &r, &told) != BRACE_OK || told < BRACE_PROMISED_FACTOR);
        }
    }
}

/* Pulled, they all stand and never buckle, but the one whose ends slide: it turns across the pull. */
static void test_columns_that_are_pulled(void)
{
    for (uint32_t n = 0; n < sizeof columns / sizeof *columns; n++) {
        be_column(&columns[n]);
        for (int i = 1; i <= 8 && n != ENDS_SLIDE; i++) {
            const double force_n[3] = {10.0 * i, 0.0, 0.0};
            float told;
            TEST_ASSERT_TRUE(isinf(in_plane(FLOATS, force_n[0], 0.0).buckling_factor));
            TEST_ASSERT_TRUE(isinf(in_plane(INTEGERS, force_n[0], 0.0).buckling_factor));
            (void)in_space(force_n, &told);
            TEST_ASSERT_TRUE(isinf(told));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_columns_in_the_plane_buckle_as_their_energy_says);
    RUN_TEST(test_columns_in_space_buckle_as_their_energy_says);
    RUN_TEST(test_columns_that_are_pulled);
    return UNITY_END();
}
