/* The statics of a posture, against levers written out here in double; where a load takes it, and which way down is. */
#include <math.h>
#include <string.h>

#include "app_bench.h"
#include "brace/ranges.h"
#include "posture/gravity.h"
#include "posture/posture.h"

static brace_parameters_t parameters;
static posture_t posture;
static const brace_vec3_t down = {0.0f, 0.0f, -1.0f};
static float outwards_n;

static void take(float theta1_rad, float theta2_rad)
{
    const float motor_rad[] = {0.0f, theta1_rad, theta2_rad}, none[] = {0.0f, 0.0f, 0.0f}, link_rad[] = {NAN, NAN, NAN};
    posture_take(&posture, &parameters, motor_rad, none, link_rad);
}

static void stand(float theta1_rad, float theta2_rad)
{
    take(theta1_rad, theta2_rad);
    posture_settle(&posture, NULL);
}

void setUp(void)
{
    parameters = bench_parameters();
    parameters.gravity.femur_n = 2.0f;
    parameters.gravity.knee_n = 1.5f;
    parameters.gravity.tibia_n = 1.0f;
    posture_start(&posture);
    outwards_n = 0.0f;
}

void tearDown(void) {}

/* Before the first sample nobody knows where the limb stands. */
static void test_a_start_knows_no_posture(void)
{
    memset(&posture, 1, sizeof posture);
    posture_start(&posture);
    TEST_ASSERT_FALSE(posture.has_levers);
    TEST_ASSERT_FALSE(posture.is_inside_travel);
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        TEST_ASSERT_TRUE(isnan(posture.theta_rad[i]) && isnan(posture.unbent_rad[i]));
        TEST_ASSERT_FALSE(posture.is_measured[i]);
    }
}

static void test_a_tip_force_and_the_loads_that_it_makes_are_one(void)
{
    static const float angles[][2] = {{1.0f, 1.4f}, {0.2f, 0.6f}, {-0.5f, 2.0f}, {1.5f, -1.0f}};
    for (int i = 0; i < 4; i++) {
        stand(angles[i][0], angles[i][1]);
        TEST_ASSERT_TRUE(posture.has_levers);
        float loads[BRACE_LINK_COUNT], x_n, z_n;
        for (int joint = BRACE_FEMUR; joint <= BRACE_TIBIA; joint++) {
            loads[joint] = posture_gravity_n_mm(&posture, &parameters.gravity, down, joint) +
                           posture_tip_load_n_mm(&posture, 3.0f, -7.0f, joint);
        }
        posture_force_of_loads(&posture, &parameters, down, loads[BRACE_FEMUR], loads[BRACE_TIBIA], &x_n, &z_n);
        ASSERT_CLOSE(3.0, x_n, 1e-4);
        ASSERT_CLOSE(-7.0, z_n, 1e-4);
    }
}

/* A motor carries what hangs beyond its axis, with half of its own link. */
static void expect_weights_at(double theta1, double theta2)
{
    const double femur = (double)parameters.limb.femur_mm, tibia = (double)parameters.limb.tibia_mm;
    const double knee_x = femur * cos(theta1), tip_x = knee_x + tibia * cos(theta1 - theta2);
    const double about_hip = 2.0 * 0.5 * knee_x + 1.5 * knee_x + 1.0 * 0.5 * (knee_x + tip_x);
    const double about_knee = 1.0 * 0.5 * (tip_x - knee_x);
    ASSERT_CLOSE(about_hip, posture_gravity_n_mm(&posture, &parameters.gravity, down, BRACE_FEMUR), 1e-3);
    ASSERT_CLOSE(-about_knee, posture_gravity_n_mm(&posture, &parameters.gravity, down, BRACE_TIBIA), 1e-3);
}

static void test_weights_hang_where_they_are(void)
{
    stand(0.4f, 1.1f);
    expect_weights_at(0.4, 1.1);
}

/* The load of a tick follows from the levers of that tick's angles, before anybody knows where the load moved them. */
static void test_levers_are_those_of_the_newest_angles(void)
{
    take(1.0f, 1.4f);
    expect_weights_at(1.0, 1.4);
    posture_settle(&posture, NULL);
    take(0.4f, 1.1f);
    expect_weights_at(0.4, 1.1);
}

static void test_where_the_levers_do_not_allow_it_no_force_is_told(void)
{
    float x_n, z_n;
    stand(1.0f, 0.02f); /* a straight knee */
    posture_force_of_loads(&posture, &parameters, down, 100.0f, 50.0f, &x_n, &z_n);
    TEST_ASSERT_TRUE(x_n != x_n && z_n != z_n);
    stand(1.0f, 1.4f);
    TEST_ASSERT_FALSE(isnan(posture_force_across_n(&posture, &parameters, down, 100.0f, false, &outwards_n)));
    posture.has_levers = false;
    TEST_ASSERT_TRUE(isnan(posture_force_across_n(&posture, &parameters, down, 100.0f, false, &outwards_n)));
    posture_force_of_loads(&posture, &parameters, down, 100.0f, 50.0f, &x_n, &z_n);
    TEST_ASSERT_TRUE(isnan(x_n) && isnan(z_n));
    posture.has_levers = true;
    posture.pose.tip.x_mm = -parameters.limb.coxa_mm; /* the tip is on the coxa joint's axis */
    TEST_ASSERT_TRUE(isnan(posture_force_across_n(&posture, &parameters, down, 100.0f, false, &outwards_n)));
    posture.has_levers = false;
    posture_force_of_loads(&posture, &parameters, down, 100.0f, 50.0f, &x_n, &z_n);
    TEST_ASSERT_TRUE(x_n != x_n && z_n != z_n);
}

/* The coxa's motor carries the force across by the tip's lever, and what leans over, by its own. */
static void test_a_force_across_is_measured_by_the_coxa_joint(void)
{
    stand(1.0f, 1.4f);
    const float tip_mm = parameters.limb.coxa_mm + posture.pose.tip.x_mm;
    const float across_n = posture_force_across_n(&posture, &parameters, down, 100.0f, false, &outwards_n);
    ASSERT_CLOSE(-100.0 / (double)tip_mm, across_n, 1e-5);
    posture.tip_across_mm = 12.0f; /* a tip beside the plane, and no force outwards that were known */
    float unknown_n = NAN;
    ASSERT_CLOSE(-100.0 / (double)tip_mm,
                 posture_force_across_n(&posture, &parameters, down, 100.0f, false, &unknown_n), 1e-5);
}

/* Without a length a link has no lever, and beyond the greatest angle there is none either; at it there is. */
static void test_what_has_levers(void)
{
    static const struct {
        float theta1_rad, theta2_rad, femur_mm, tibia_mm;
        bool has_levers;
    } row[] = {{1.0f, 1.4f, 185.0f, 313.5f, true},
               {1.0f, 1.4f, 0.0f, 313.5f, false},
               {1.0f, 1.4f, 185.0f, 0.0f, false},
               {1.0f, 1.4f, -1.0f, 313.5f, false},
               {BRACE_ANGLE_LIMIT_RAD, 1.4f, 185.0f, 313.5f, true},
               {1.0f, -BRACE_ANGLE_LIMIT_RAD, 185.0f, 313.5f, true},
               {1.001f * BRACE_ANGLE_LIMIT_RAD, 1.4f, 185.0f, 313.5f, false},
               {1.0f, -1.001f * BRACE_ANGLE_LIMIT_RAD, 185.0f, 313.5f, false},
               {NAN, 1.4f, 185.0f, 313.5f, false},
               {1.0f, NAN, 185.0f, 313.5f, false}};
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        parameters.limb.femur_mm = row[i].femur_mm;
        parameters.limb.tibia_mm = row[i].tibia_mm;
        stand(row[i].theta1_rad, row[i].theta2_rad);
        TEST_ASSERT_EQUAL(row[i].has_levers, posture.has_levers);
    }
}

/* The posture contains how far the load moves the limb. When the load is no longer known, the posture drops that. */
static void test_a_load_takes_the_limb_where_it_says(void)
{
    const posture_bend_t bend = {.tip_mm = {3.0f, -2.0f},
                                 .tibia_mm = {250.0f, -60.0f},
                                 .tip_across_mm = 5.0f,
                                 .tibia_across_mm = 1.5f,
                                 .joint_turn_rad = {0.03f, -0.02f, 0.05f}};
    stand(1.0f, 1.4f);
    const posture_t before = posture;
    posture_settle(&posture, &bend);
    ASSERT_CLOSE((double)before.pose.tip.x_mm + 3.0, posture.pose.tip.x_mm, 1e-3);
    ASSERT_CLOSE((double)before.pose.tip.z_mm - 2.0, posture.pose.tip.z_mm, 1e-3);
    ASSERT_CLOSE(250.0, posture.pose.tip.x_mm - posture.pose.knee.x_mm, 1e-3);
    ASSERT_CLOSE(-60.0, posture.pose.tip.z_mm - posture.pose.knee.z_mm, 1e-3);
    TEST_ASSERT_EQUAL_FLOAT(5.0f, posture.tip_across_mm);
    TEST_ASSERT_EQUAL_FLOAT(3.5f, posture.knee_across_mm);
    TEST_ASSERT_EQUAL_FLOAT(0.03f, posture.yaw_turn_rad);
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        ASSERT_CLOSE((double)before.unbent_rad[i] + (double)bend.joint_turn_rad[i], posture.theta_rad[i], 1e-6);
        TEST_ASSERT_EQUAL_FLOAT(before.unbent_rad[i], posture.unbent_rad[i]);
    }
    /* The motor holds the moment on its joint. Its lever is the bent limb's, turned by a quarter. */
    ASSERT_CLOSE(-(double)posture.pose.tip.z_mm, posture.pose.lever_femur.x_mm, 1e-3);
    ASSERT_CLOSE(posture.pose.tip.x_mm, posture.pose.lever_femur.z_mm, 1e-3);
    posture_settle(&posture, NULL);
    ASSERT_CLOSE(before.pose.tip.x_mm, posture.pose.tip.x_mm, 1e-4);
    ASSERT_CLOSE(before.pose.knee.z_mm, posture.pose.knee.z_mm, 1e-4);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, posture.tip_across_mm);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, posture.knee_across_mm);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, posture.yaw_turn_rad);
}

/* The limb leans over, and its tip stands beside its plane. All moments about the coxa joint's axis must balance the
 * force that the posture gives. When the load has turned the plane, the direction outwards turns with it. */
static void test_moments_about_the_coxa_joint_are_in_balance(void)
{
    static const float leans[] = {0.0f, 0.4f, -0.7f}, coxas_n_mm[] = {100.0f, -350.0f}, x_ns[] = {4.0f, -9.0f};
    const posture_bend_t bend = {
        .tip_across_mm = 12.0f, .tibia_across_mm = 7.0f, .joint_turn_rad = {0.05f, 0.0f, 0.0f}};
    for (int i = 0; i < 24; i++) {
        const float lean = leans[i % 3], coxa_n_mm = coxas_n_mm[i / 3 % 2];
        const bool is_turned = i / 12 != 0;
        const brace_vec3_t leaning = {0.6f * cosf(lean), sinf(lean), -0.8f * cosf(lean)};
        float x_n = x_ns[i / 6 % 2];
        posture_bend_t here = bend;
        stand(0.6f, 1.1f);
        here.tip_mm = (brace_vec_t){0.0f, 0.0f};
        here.tibia_mm = (brace_vec_t){posture.pose.tip.x_mm - posture.pose.knee.x_mm,
                                      posture.pose.tip.z_mm - posture.pose.knee.z_mm};
        posture_settle(&posture, &here);
        const float reported_n = posture_force_across_n(&posture, &parameters, leaning, coxa_n_mm, is_turned, &x_n);
        const double coxa = (double)parameters.limb.coxa_mm, knee = coxa + (double)posture.pose.knee.x_mm;
        const double tip = coxa + (double)posture.pose.tip.x_mm, knee_aside = 5.0, tip_aside = 12.0;
        /* each weight acts at the middle of its link: how far that is outwards and aside */
        const double weight[3] = {2.0, 1.5, 1.0}, out[3] = {0.5 * (coxa + knee), knee, 0.5 * (knee + tip)};
        const double aside[3] = {0.5 * knee_aside, knee_aside, 0.5 * (knee_aside + tip_aside)};
        double about = (double)coxa_n_mm + tip * (double)reported_n - tip_aside * (double)x_n;
        for (int w = 0; w < 3; w++) {
            about += weight[w] * (out[w] * (double)leaning.y - aside[w] * (double)leaning.x);
        }
        TEST_ASSERT_DOUBLE_WITHIN(2e-2, 0.0, about);
        ASSERT_CLOSE((double)x_ns[i / 6 % 2] - (is_turned ? 0.05 * (double)reported_n : 0.0), x_n, 1e-5);
    }
}

/* --- which way down is ---------------------------------------------------------------------------------------- */

static void expect_down(const gravity_t *gravity, double direction_rad, double lean_rad)
{
    ASSERT_CLOSE(cos(lean_rad) * cos(direction_rad), gravity->down.x, 1e-6);
    ASSERT_CLOSE(sin(lean_rad), gravity->down.y, 1e-6);
    ASSERT_CLOSE(cos(lean_rad) * sin(direction_rad), gravity->down.z, 1e-6);
    ASSERT_CLOSE(direction_rad, gravity->direction_rad, 1e-6);
    ASSERT_CLOSE(lean_rad, gravity->lean_rad, 1e-6);
}

static void test_down_is_as_sent_until_it_is_sent_no_more(void)
{
    gravity_t gravity = {.is_sent = false};
    brace_gravity_t said = {.direction_rad = -1.2f, .lean_rad = 0.3f};
    gravity_configure(&gravity, &said);
    expect_down(&gravity, -1.2, 0.3);
    said.direction_rad = -1.0f;
    gravity_configure(&gravity, &said);
    expect_down(&gravity, -1.0, 0.3);
    TEST_ASSERT_EQUAL(BRACE_OK, gravity_set(&gravity, &said, 2.0f, -0.5f));
    expect_down(&gravity, 2.0, -0.5);
    gravity_configure(&gravity, &said); /* new parameters leave the direction that was sent */
    expect_down(&gravity, 2.0, -0.5);
    TEST_ASSERT_EQUAL(BRACE_OK, gravity_set(&gravity, &said, NAN, NAN));
    expect_down(&gravity, -1.0, 0.3);
    said.lean_rad = -0.1f;
    gravity_configure(&gravity, &said);
    expect_down(&gravity, -1.0, -0.1);
}

static void test_down_out_of_range_changes_nothing(void)
{
    const float direction = BRACE_RANGE_GRAVITY_DIRECTION_RAD_MAX, lean = BRACE_RANGE_GRAVITY_LEAN_RAD_MAX;
    const brace_gravity_t said = {.direction_rad = -1.2f, .lean_rad = 0.3f};
    gravity_t gravity = {.is_sent = false};
    gravity_configure(&gravity, &said);
    for (float sign = -1.0f; sign <= 1.0f; sign += 2.0f) {
        TEST_ASSERT_EQUAL(BRACE_E_RANGE, gravity_set(&gravity, &said, sign * nextafterf(direction, 4.0f), 0.0f));
        TEST_ASSERT_EQUAL(BRACE_E_RANGE, gravity_set(&gravity, &said, 0.0f, sign * nextafterf(lean, 4.0f)));
        TEST_ASSERT_EQUAL(BRACE_E_RANGE, gravity_set(&gravity, &said, sign * INFINITY, 0.0f));
    }
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, gravity_set(&gravity, &said, NAN, 0.0f));
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, gravity_set(&gravity, &said, 0.0f, NAN));
    expect_down(&gravity, -1.2, 0.3);
    gravity_configure(&gravity, &said);
    expect_down(&gravity, -1.2, 0.3);
    for (float sign = -1.0f; sign <= 1.0f; sign += 2.0f) {
        TEST_ASSERT_EQUAL(BRACE_OK, gravity_set(&gravity, &said, sign * direction, sign * lean));
        expect_down(&gravity, (double)(sign * direction), (double)(sign * lean));
    }
}

static void test_angles_that_are_none_give_no_levers(void)
{
    stand(NAN, 1.4f);
    TEST_ASSERT_FALSE(posture.has_levers);
    stand(1.0f, 1e4f);
    TEST_ASSERT_FALSE(posture.has_levers);
    TEST_ASSERT_FALSE(posture.is_inside_travel);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_start_knows_no_posture);
    RUN_TEST(test_a_tip_force_and_the_loads_that_it_makes_are_one);
    RUN_TEST(test_weights_hang_where_they_are);
    RUN_TEST(test_levers_are_those_of_the_newest_angles);
    RUN_TEST(test_where_the_levers_do_not_allow_it_no_force_is_told);
    RUN_TEST(test_what_has_levers);
    RUN_TEST(test_a_force_across_is_measured_by_the_coxa_joint);
    RUN_TEST(test_a_load_takes_the_limb_where_it_says);
    RUN_TEST(test_moments_about_the_coxa_joint_are_in_balance);
    RUN_TEST(test_down_is_as_sent_until_it_is_sent_no_more);
    RUN_TEST(test_down_out_of_range_changes_nothing);
    RUN_TEST(test_angles_that_are_none_give_no_levers);
    return UNITY_END();
}
