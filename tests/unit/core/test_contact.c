/* Contact against K and its inverse written out in double precision. */
#include <float.h>
#include <stdbool.h>
#include <string.h>

#include "base/check.h"
#include "brace/chain.h"
#include "brace/contact.h"
#include "brace/planar.h"
#include "close.h"
#include "reference_planar.h"
#include "sample_limbs.h"

static const double PI = 3.14159265358979323846;

void setUp(void) {}
void tearDown(void) {}

/* K with given eigenvalues and axis, as the core hands it over: entries and eigenform rounded to float. */
static brace_stiffness_t stiffness_of(double smaller, double larger, double axis_rad)
{
    const double c = cos(axis_rad), s = sin(axis_rad);
    return (brace_stiffness_t){
        .k_xx_n_per_mm = (float)(larger * c * c + smaller * s * s),
        .k_xz_n_per_mm = (float)((larger - smaller) * c * s),
        .k_zz_n_per_mm = (float)(larger * s * s + smaller * c * c),
        .lambda_min_n_per_mm = (float)smaller,
        .lambda_max_n_per_mm = (float)larger,
        .stiff_axis_rad = (float)axis_rad,
    };
}

/* Round limbs and slender ones, soft and hard, axes all round. */
static const double eigenvalues[][2] = {{0.6235, 5.2765}, {1.0, 1.0}, {0.0385, 15.35}, {1e-3, 1e3}, {0.1, 1e6}};
enum { LIMBS = sizeof eigenvalues / sizeof eigenvalues[0], AXES = 25 };
static double axis_of(int i)
{
    return -PI / 2.0 + i * PI / (AXES - 1);
}

static void force_is_k_times_deflection(void)
{
    const brace_displacement_t deflections[] = {{1.0f, 0.0f}, {0.0f, 2.5f}, {-0.3f, 0.4f}, {1e-3f, -7.0f}};
    for (int k = 0; k < LIMBS; k++) {
        for (int i = 0; i < AXES; i++) {
            const double smaller = eigenvalues[k][0], larger = eigenvalues[k][1];
            const double c = cos(axis_of(i)), s = sin(axis_of(i));
            const brace_stiffness_t stiffness = stiffness_of(smaller, larger, axis_of(i));
            for (int j = 0; j < 4; j++) {
                const double x = (double)deflections[j].x_mm, z = (double)deflections[j].z_mm;
                const double size = sqrt(x * x + z * z);
                const double f_x = (larger * c * c + smaller * s * s) * x + (larger - smaller) * c * s * z;
                const double f_z = (larger - smaller) * c * s * x + (larger * s * s + smaller * c * c) * z;
                brace_contact_force_t contact;
                TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_contact_force(&stiffness, deflections[j], &contact));
                ASSERT_CLOSE(f_x, contact.force.x_n, 5e-7 * larger * size);
                ASSERT_CLOSE(f_z, contact.force.z_n, 5e-7 * larger * size);
                ASSERT_CLOSE(sqrt(f_x * f_x + f_z * f_z), contact.magnitude_n, 5e-7 * larger * size);
                /* eq. 2, at the bounds themselves to rounding */
                ASSERT_CLOSE(smaller * size, contact.low_n, 3e-7 * smaller * size);
                ASSERT_CLOSE(larger * size, contact.high_n, 3e-7 * larger * size);
                TEST_ASSERT_TRUE(contact.low_n <= contact.magnitude_n && contact.magnitude_n <= contact.high_n);
            }
        }
    }
}

/* A deflection along the soft axis of a slender K: the entries alone, rounded, know nothing of so small a force. */
static void the_bounds_hold_along_the_axes(void)
{
    for (int k = 0; k < LIMBS; k++) {
        for (int i = 0; i < 2 * AXES; i++) {
            const double axis = axis_of(i / 2), along = axis + (i % 2) * PI / 2.0;
            const brace_stiffness_t stiffness = stiffness_of(eigenvalues[k][0], eigenvalues[k][1], axis);
            brace_contact_force_t contact;
            TEST_ASSERT_EQUAL_INT(
                BRACE_OK, brace_contact_force(&stiffness, (brace_displacement_t){(float)cos(along), (float)sin(along)},
                                              &contact));
            TEST_ASSERT_TRUE(contact.low_n <= contact.magnitude_n && contact.magnitude_n <= contact.high_n);
            ASSERT_CLOSE(eigenvalues[k][1 - i % 2], contact.magnitude_n, 5e-7 * eigenvalues[k][1]);
        }
    }
}

/* The core's own K, tick and general path, at postures of all sorts of limbs, against C in double precision. */
static void sag_and_force_of_the_cores_own_k(void)
{
    for (int s = 0; s < SAMPLE_COUNT; s++) {
        brace_planar_t planar;
        brace_chain_t chain;
        const bool has_tick = brace_planar_collapse(&sample_limb[s], &planar) == BRACE_OK;
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_chain_build(&sample_limb[s], &chain));
        for (int i = 0; i < 2 * 13 * 17; i++) {
            const float theta1 = -3.0f + 0.25f * (float)(i / 2 % 13), theta2 = -3.1f + 0.37f * (float)(i / 26);
            const reference_planar_t r = reference_planar(&sample_limb[s], (double)theta1, (double)theta2);
            brace_stiffness_t k;
            const brace_status_t status = i % 2 == 0 ? brace_chain_stiffness(&chain, theta1, theta2, &k)
                                          : has_tick ? brace_planar_stiffness(&planar, theta1, theta2, &k)
                                                     : BRACE_E_UNSUPPORTED;
            if (status != BRACE_OK || k.flags != 0u) {
                continue;
            }
            const double x = cos(0.7 * i), z = sin(0.7 * i), give = 5e-6 / r.lambda_min, hold = 5e-6 * r.lambda_max;
            brace_displacement_t sag;
            brace_contact_force_t contact;
            TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_contact_sag(&k, (brace_force_t){(float)x, (float)z}, &sag));
            ASSERT_CLOSE(r.c_xx * x + r.c_xz * z, sag.x_mm, give);
            ASSERT_CLOSE(r.c_xz * x + r.c_zz * z, sag.z_mm, give);
            brace_contact_force(&k, (brace_displacement_t){(float)x, (float)z}, &contact);
            ASSERT_CLOSE(r.k_xx * x + r.k_xz * z, contact.force.x_n, hold);
            ASSERT_CLOSE(r.k_xz * x + r.k_zz * z, contact.force.z_n, hold);
            ASSERT_CLOSE(hypot(r.k_xx * x + r.k_xz * z, r.k_xz * x + r.k_zz * z), contact.magnitude_n, hold);
        }
    }
}

/* A deflection along an eigenvector meets its bound. */
static void the_bounds_are_reached(void)
{
    const brace_stiffness_t stiffness = stiffness_of(0.5, 8.0, 0.0);
    brace_contact_force_t contact;
    brace_contact_force(&stiffness, (brace_displacement_t){2.0f, 0.0f}, &contact);
    ASSERT_CLOSE(16.0, contact.magnitude_n, 1e-5);
    ASSERT_CLOSE(16.0, contact.high_n, 1e-5);
    brace_contact_force(&stiffness, (brace_displacement_t){0.0f, -2.0f}, &contact);
    ASSERT_CLOSE(1.0, contact.magnitude_n, 1e-6);
    ASSERT_CLOSE(1.0, contact.low_n, 1e-6);
    ASSERT_CLOSE(-1.0, contact.force.z_n, 1e-6);
}

static void sag_is_the_inverse(void)
{
    const brace_force_t loads[] = {{0.0f, -30.0f}, {12.0f, 0.0f}, {-3.0f, 4.0f}};
    for (int k = 0; k < LIMBS; k++) {
        for (int i = 0; i < AXES; i++) {
            const double smaller = eigenvalues[k][0], larger = eigenvalues[k][1];
            const double c = cos(axis_of(i)), s = sin(axis_of(i));
            const brace_stiffness_t stiffness = stiffness_of(smaller, larger, axis_of(i));
            for (int j = 0; j < 3; j++) {
                const double x = (double)loads[j].x_n, z = (double)loads[j].z_n;
                const double c_xx = c * c / larger + s * s / smaller;
                const double c_xz = c * s * (1.0 / larger - 1.0 / smaller);
                const double c_zz = s * s / larger + c * c / smaller;
                const double tolerance = 6e-7 * sqrt(x * x + z * z) / smaller;
                brace_displacement_t sag;
                TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_contact_sag(&stiffness, loads[j], &sag));
                ASSERT_CLOSE(c_xx * x + c_xz * z, sag.x_mm, tolerance);
                ASSERT_CLOSE(c_xz * x + c_zz * z, sag.z_mm, tolerance);
            }
        }
    }
}

/* A payload on the paper's row 9: C = K^-1 by hand, [5, -1.1; -1.1, 0.9], det 3.29. */
static void sag_of_the_papers_row_9(void)
{
    const double radius = sqrt(2.05 * 2.05 + 1.1 * 1.1);
    const brace_stiffness_t row_9 = stiffness_of(2.95 - radius, 2.95 + radius, 0.5 * atan2(-1.1, 2.05));
    ASSERT_CLOSE(5.0, row_9.k_xx_n_per_mm, 1e-6);
    brace_displacement_t sag;
    brace_contact_sag(&row_9, (brace_force_t){0.0f, -2.0f}, &sag);
    ASSERT_CLOSE(-2.0 * 1.1 / 3.29, sag.x_mm, 2e-6);
    ASSERT_CLOSE(-2.0 * 5.0 / 3.29, sag.z_mm, 5e-6);
}

static brace_contact_grip_t grip_of(double x, double z, double normal_rad, double mu)
{
    brace_contact_grip_t grip;
    const brace_force_t force = {(float)x, (float)z};
    TEST_ASSERT_EQUAL_INT(BRACE_OK,
                          brace_contact_grip(force, (float)cos(normal_rad), (float)sin(normal_rad), (float)mu, &grip));
    return grip;
}

/* Forces at known angles from the normal of surfaces at any slope. */
static void margin_and_angle_in_the_cone(void)
{
    for (int i = 0; i < AXES; i++) {
        const double normal = 2.0 * axis_of(i);
        for (double off = -1.5; off <= 1.5; off += 0.125) {
            const double size = 20.0, mu = 0.7;
            const brace_contact_grip_t grip = grip_of(size * cos(normal + off), size * sin(normal + off), normal, mu);
            const double margin = size * (mu * cos(off) - fabs(sin(off)));
            ASSERT_CLOSE(size * cos(off), grip.normal_n, 5e-7 * size);
            ASSERT_CLOSE(size * fabs(sin(off)), grip.tangent_n, 5e-7 * size);
            ASSERT_CLOSE(margin, grip.margin_n, 5e-7 * (1.0 + mu) * size);
            ASSERT_CLOSE(atan(mu) - fabs(off), grip.angle_left_rad, 7e-7);
            TEST_ASSERT_EQUAL_INT(margin >= 0.0 ? BRACE_CONTACT_HOLDS : BRACE_CONTACT_SLIDES, grip.state);
        }
        for (double off = 1.625; off <= 3.125; off += 0.25) {
            const brace_contact_grip_t away = grip_of(9.0 * cos(normal + off), 9.0 * sin(normal + off), normal, 0.7);
            TEST_ASSERT_EQUAL_INT(BRACE_CONTACT_LIFTS, away.state);
            TEST_ASSERT_TRUE(away.normal_n < 0.0f && away.margin_n < 0.0f);
            ASSERT_CLOSE(atan(0.7) - off, away.angle_left_rad, 7e-7);
        }
    }
}

static void the_cone_has_edges(void)
{
    TEST_ASSERT_EQUAL_INT(BRACE_CONTACT_HOLDS, grip_of(-1.0, 2.0, PI / 2.0, 0.5625).state);
    TEST_ASSERT_EQUAL_INT(BRACE_CONTACT_SLIDES, grip_of(-1.0, 2.0, PI / 2.0, 0.4375).state);
    TEST_ASSERT_EQUAL_INT(BRACE_CONTACT_SLIDES, grip_of(1e-3, 2.0, PI / 2.0, 0.0).state);
    const brace_contact_grip_t light = grip_of(-1e-4, 1e-3, PI / 2.0, 0.5); /* a tenth of a gram still presses */
    TEST_ASSERT_EQUAL_INT(BRACE_CONTACT_HOLDS, light.state);
    ASSERT_CLOSE(atan(0.5) - atan(0.1), light.angle_left_rad, 7e-7);
    brace_contact_grip_t grip;
    brace_contact_grip((brace_force_t){-1.0f, 2.0f}, 0.0f, 1.0f, 0.5f, &grip); /* on the edge, exactly */
    TEST_ASSERT_EQUAL_INT(BRACE_CONTACT_HOLDS, grip.state);
    TEST_ASSERT_TRUE(grip.margin_n == 0.0f);
    brace_contact_grip((brace_force_t){0.0f, 0.0f}, 0.0f, 1.0f, 0.5f, &grip);
    TEST_ASSERT_EQUAL_INT(BRACE_CONTACT_LIFTS, grip.state);
    TEST_ASSERT_TRUE(grip.margin_n == 0.0f && grip.angle_left_rad == 0.0f && grip.normal_n == 0.0f);
    brace_contact_grip((brace_force_t){3.0f, 0.0f}, 0.0f, 1.0f, 0.5f, &grip); /* along the surface: no press */
    TEST_ASSERT_EQUAL_INT(BRACE_CONTACT_LIFTS, grip.state);
    ASSERT_CLOSE(-3.0, grip.margin_n, 1e-6);
    brace_contact_grip((brace_force_t){0.0f, -2.0f}, 0.0f, 1.0f, 0.0f, &grip); /* straight off, no friction */
    TEST_ASSERT_EQUAL_INT(BRACE_CONTACT_LIFTS, grip.state);
    ASSERT_CLOSE(-PI, grip.angle_left_rad, 7e-7);
}

/* A normal given to two digits is made a unit vector, so the forces' squares still sum to |f|^2. */
static void the_normal_is_made_one(void)
{
    brace_contact_grip_t grip;
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_contact_grip((brace_force_t){-3.0f, 4.0f}, 0.71f, 0.71f, 0.5f, &grip));
    ASSERT_CLOSE(sqrt(0.5), grip.normal_n, 1e-6);
    ASSERT_CLOSE(7.0 * sqrt(0.5), grip.tangent_n, 3e-6);
}

/* The paper's Fig. 2: the body sags by 1 mm on two planted feet of equal K_zz. The foot with the small K_xz
 * keeps inside its cone, the one with the large K_xz slides. */
static void the_choice_of_stiffness(void)
{
    const double mu = 0.4;
    const double cross[] = {-0.2, -2.0};
    const brace_contact_state_t expected[] = {BRACE_CONTACT_HOLDS, BRACE_CONTACT_SLIDES};
    for (int i = 0; i < 2; i++) {
        const double mean = 2.5, deviation = -0.5, radius = sqrt(deviation * deviation + cross[i] * cross[i]);
        const brace_stiffness_t stiffness =
            stiffness_of(mean - radius, mean + radius, 0.5 * atan2(cross[i], deviation));
        brace_contact_force_t contact;
        brace_contact_grip_t grip;
        brace_contact_force(&stiffness, (brace_displacement_t){0.0f, 1.0f}, &contact);
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_contact_grip(contact.force, 0.0f, 1.0f, (float)mu, &grip));
        ASSERT_CLOSE(3.0, grip.normal_n, 5e-6);
        ASSERT_CLOSE(mu * 3.0 - fabs(cross[i]), grip.margin_n, 5e-6);
        TEST_ASSERT_EQUAL_INT(expected[i], grip.state);
    }
}

static void expect_refused_stiffness(brace_stiffness_t stiffness, brace_status_t expected)
{
    brace_displacement_t sag = {11.0f, 12.0f};
    brace_contact_force_t contact, before;
    memset(&contact, 0x5a, sizeof contact);
    before = contact;
    TEST_ASSERT_EQUAL_INT(expected, brace_contact_sag(&stiffness, (brace_force_t){1.0f, 1.0f}, &sag));
    TEST_ASSERT_EQUAL_INT(expected, brace_contact_force(&stiffness, (brace_displacement_t){1.0f, 1.0f}, &contact));
    TEST_ASSERT_TRUE(sag.x_mm == 11.0f && sag.z_mm == 12.0f);
    TEST_ASSERT_EQUAL_INT(0, memcmp(&before, &contact, sizeof contact));
}

static void bad_stiffness_is_refused(void)
{
    const brace_stiffness_t good = stiffness_of(0.5, 2.0, 0.3);
    brace_stiffness_t bad = good;
    bad.lambda_min_n_per_mm = 0.0f;
    expect_refused_stiffness(bad, BRACE_E_RANGE);
    bad.lambda_min_n_per_mm = -0.5f;
    expect_refused_stiffness(bad, BRACE_E_RANGE);
    bad.lambda_min_n_per_mm = FLT_MIN; /* its inverse is not a displacement */
    expect_refused_stiffness(bad, BRACE_E_RANGE);
    bad.lambda_min_n_per_mm = 2.5f;
    expect_refused_stiffness(bad, BRACE_E_RANGE);
    bad.lambda_min_n_per_mm = NAN;
    expect_refused_stiffness(bad, BRACE_E_NOT_FINITE);
    bad = good;
    bad.lambda_max_n_per_mm = INFINITY;
    expect_refused_stiffness(bad, BRACE_E_NOT_FINITE);
    bad.lambda_max_n_per_mm = 1e20f;
    expect_refused_stiffness(bad, BRACE_E_RANGE);
    bad = good;
    bad.stiff_axis_rad = NAN;
    expect_refused_stiffness(bad, BRACE_E_NOT_FINITE);
    bad.stiff_axis_rad = 100.0f;
    expect_refused_stiffness(bad, BRACE_E_RANGE);
    bad = good;
    bad.k_xz_n_per_mm = NAN;
    expect_refused_stiffness(bad, BRACE_E_NOT_FINITE);
    bad.k_xz_n_per_mm = -2e12f;
    expect_refused_stiffness(bad, BRACE_E_RANGE);
}

/* A K may be as soft as 1e-12 N/mm, and that is taken. Where K is round, rounding may put its eigenvalues in the wrong
 * order by a millionth of themselves, and no more. */
static void the_eigenvalues_have_their_bounds(void)
{
    const float least = 1e-12f, more = 1.0f + 1e-6f;
    const struct {
        float lambda_min, lambda_max;
        brace_status_t status;
    } row[] = {{least, 2.0f, BRACE_OK},
               {nextafterf(least, 0.0f), 2.0f, BRACE_E_RANGE},
               {2.0f * more, 2.0f, BRACE_OK},
               {nextafterf(2.0f * more, 3.0f), 2.0f, BRACE_E_RANGE},
               {2.1f, 2.0f, BRACE_E_RANGE}};
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        brace_stiffness_t k = stiffness_of(0.5, 2.0, 0.3);
        brace_displacement_t sag;
        k.lambda_min_n_per_mm = row[i].lambda_min;
        k.lambda_max_n_per_mm = row[i].lambda_max;
        TEST_ASSERT_EQUAL_INT(row[i].status, brace_contact_sag(&k, (brace_force_t){1.0f, 1.0f}, &sag));
    }
}

static void bad_input_is_refused_and_touches_nothing(void)
{
    const brace_stiffness_t good = stiffness_of(0.5, 2.0, 0.3);
    const float bad[] = {NAN, INFINITY, 2e6f};
    const brace_status_t expected[] = {BRACE_E_NOT_FINITE, BRACE_E_NOT_FINITE, BRACE_E_RANGE};
    brace_displacement_t sag = {11.0f, 12.0f};
    brace_contact_force_t contact, contact_before;
    brace_contact_grip_t grip, grip_before;
    memset(&contact, 0x5a, sizeof contact);
    memset(&grip, 0x5a, sizeof grip);
    contact_before = contact;
    grip_before = grip;
    for (int i = 0; i < 3; i++) {
        const float b = bad[i];
        TEST_ASSERT_EQUAL_INT(expected[i], brace_contact_sag(&good, (brace_force_t){b, 0.0f}, &sag));
        TEST_ASSERT_EQUAL_INT(expected[i], brace_contact_sag(&good, (brace_force_t){0.0f, b}, &sag));
        TEST_ASSERT_EQUAL_INT(expected[i], brace_contact_force(&good, (brace_displacement_t){b, 0.0f}, &contact));
        TEST_ASSERT_EQUAL_INT(expected[i], brace_contact_force(&good, (brace_displacement_t){0.0f, -b}, &contact));
        TEST_ASSERT_EQUAL_INT(expected[i], brace_contact_grip((brace_force_t){b, 0.0f}, 0.0f, 1.0f, 0.5f, &grip));
        TEST_ASSERT_EQUAL_INT(expected[i], brace_contact_grip((brace_force_t){0.0f, b}, 0.0f, 1.0f, 0.5f, &grip));
        TEST_ASSERT_EQUAL_INT(expected[i], brace_contact_grip((brace_force_t){0.0f, 1.0f}, b, 1.0f, 0.5f, &grip));
        TEST_ASSERT_EQUAL_INT(expected[i], brace_contact_grip((brace_force_t){0.0f, 1.0f}, 0.0f, b, 0.5f, &grip));
        TEST_ASSERT_EQUAL_INT(expected[i], brace_contact_grip((brace_force_t){0.0f, 1.0f}, 0.0f, 1.0f, b, &grip));
    }
    const float normals[][2] = {{0.0f, 0.0f}, {0.0f, 0.98f}, {0.0f, -1.02f}, {0.8f, 0.8f}};
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_INT(
            BRACE_E_RANGE, brace_contact_grip((brace_force_t){0.0f, 1.0f}, normals[i][0], normals[i][1], 0.5f, &grip));
    }
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_contact_grip((brace_force_t){0.0f, 1.0f}, 0.0f, 1.0f, -0.1f, &grip));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_contact_sag(NULL, (brace_force_t){0.0f, 1.0f}, &sag));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_contact_sag(&good, (brace_force_t){0.0f, 1.0f}, NULL));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_contact_force(NULL, (brace_displacement_t){0.0f, 1.0f}, &contact));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_contact_force(&good, (brace_displacement_t){0.0f, 1.0f}, NULL));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NULL, brace_contact_grip((brace_force_t){0.0f, 1.0f}, 0.0f, 1.0f, 0.5f, NULL));
    TEST_ASSERT_TRUE(sag.x_mm == 11.0f && sag.z_mm == 12.0f);
    TEST_ASSERT_EQUAL_INT(0, memcmp(&contact_before, &contact, sizeof contact));
    TEST_ASSERT_EQUAL_INT(0, memcmp(&grip_before, &grip, sizeof grip));
}

/* Every limit is inclusive, and whatever is no number is refused as that. */
static void limits_are_inclusive(void)
{
    const float most = 7.5f, beyond = nextafterf(most, INFINITY), least = -2.5f;
    for (float sign = -1.0f; sign <= 1.0f; sign += 2.0f) {
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_check_magnitude(sign * most, most));
        TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_check_magnitude(sign * beyond, most));
        TEST_ASSERT_EQUAL_INT(BRACE_E_NOT_FINITE, brace_check_magnitude(sign * INFINITY, most));
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_check_two(sign * most, -sign * most, most));
        TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_check_two(sign * beyond, 0.0f, most));
        TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_check_two(0.0f, sign * beyond, most));
        TEST_ASSERT_EQUAL_INT(BRACE_E_NOT_FINITE, brace_check_two(beyond, sign * INFINITY, most));
        TEST_ASSERT_EQUAL_INT(BRACE_E_NOT_FINITE, brace_check_two((float)NAN, beyond, most));
    }
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_check_range(least, least, most));
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_check_range(most, least, most));
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_check_range(nextafterf(least, -INFINITY), least, most));
    TEST_ASSERT_EQUAL_INT(BRACE_E_RANGE, brace_check_range(beyond, least, most));
    TEST_ASSERT_EQUAL_INT(BRACE_E_NOT_FINITE, brace_check_range((float)NAN, least, most));
}

/* Of several refusals the first is reported, as check.h says. */
static void the_first_refusal_is_reported(void)
{
    static const brace_status_t status[] = {BRACE_OK, BRACE_E_RANGE, BRACE_E_NOT_FINITE, BRACE_E_SINGULAR};
    for (int i = 0; i < 16; i++) {
        const brace_status_t first = status[i / 4], second = status[i % 4];
        TEST_ASSERT_EQUAL_INT(i / 4 == 0 ? second : first, brace_first_refusal(first, second));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(force_is_k_times_deflection);
    RUN_TEST(the_bounds_hold_along_the_axes);
    RUN_TEST(sag_and_force_of_the_cores_own_k);
    RUN_TEST(the_bounds_are_reached);
    RUN_TEST(sag_is_the_inverse);
    RUN_TEST(sag_of_the_papers_row_9);
    RUN_TEST(margin_and_angle_in_the_cone);
    RUN_TEST(the_cone_has_edges);
    RUN_TEST(the_normal_is_made_one);
    RUN_TEST(the_choice_of_stiffness);
    RUN_TEST(bad_stiffness_is_refused);
    RUN_TEST(the_eigenvalues_have_their_bounds);
    RUN_TEST(bad_input_is_refused_and_touches_nothing);
    RUN_TEST(limits_are_inclusive);
    RUN_TEST(the_first_refusal_is_reported);
    return UNITY_END();
}
