/* The statics of a posture, against levers written out here in double. */
#include <math.h>
#include <string.h>

#include "app_bench.h"
#include "posture/posture.h"

static brace_parameters_t parameters;
static posture_t posture;
static const brace_vec3_t down = {0.0f, 0.0f, -1.0f};
static float outwards_n;

static void stand(float theta1_rad, float theta2_rad)
{
    const float motor_rad[] = {0.0f, theta1_rad, theta2_rad}, none[] = {0.0f, 0.0f, 0.0f}, link_rad[] = {NAN, NAN, NAN};
    posture_take(&posture, &parameters, motor_rad, none, link_rad);
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
static void test_weights_hang_where_they_are(void)
{
    const double theta1 = 0.4, theta2 = 1.1, femur = (double)parameters.limb.femur_mm;
    const double tibia = (double)parameters.limb.tibia_mm;
    stand((float)theta1, (float)theta2);
    const double knee_x = femur * cos(theta1), tip_x = knee_x + tibia * cos(theta1 - theta2);
    const double about_hip = 2.0 * 0.5 * knee_x + 1.5 * knee_x + 1.0 * 0.5 * (knee_x + tip_x);
    const double about_knee = 1.0 * 0.5 * (tip_x - knee_x);
    ASSERT_CLOSE(about_hip, posture_gravity_n_mm(&posture, &parameters.gravity, down, BRACE_FEMUR), 1e-3);
    ASSERT_CLOSE(-about_knee, posture_gravity_n_mm(&posture, &parameters.gravity, down, BRACE_TIBIA), 1e-3);
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
static void test_a_force_across_is_told_by_the_coxa_joint(void)
{
    stand(1.0f, 1.4f);
    const float tip_mm = parameters.limb.coxa_mm + posture.pose.tip.x_mm;
    const float across_n = posture_force_across_n(&posture, &parameters, down, 100.0f, false, &outwards_n);
    ASSERT_CLOSE(-100.0 / (double)tip_mm, across_n, 1e-5);
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
    RUN_TEST(test_a_tip_force_and_the_loads_that_it_makes_are_one);
    RUN_TEST(test_weights_hang_where_they_are);
    RUN_TEST(test_where_the_levers_do_not_allow_it_no_force_is_told);
    RUN_TEST(test_a_force_across_is_told_by_the_coxa_joint);
    RUN_TEST(test_angles_that_are_none_give_no_levers);
    return UNITY_END();
}
