/* Each joint's own spring: as it yields at its own load and temperature, and as K takes it. */
#include <math.h>
#include <string.h>

#include "app_bench.h"
#include "stiffness/model.h"

static brace_parameters_t parameters;
static model_t model;

/* Three joints that have nothing in common. */
void setUp(void)
{
    static const float compliance[] = {3e-6f, 1e-6f, 2e-6f}, hardening[] = {2e9f, 5e9f, 1e9f};
    parameters = bench_parameters();
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        parameters.limb.joint[i].compliance_rad_per_n_mm = compliance[i];
        parameters.drive[i].hardening_n_mm_per_rad3 = hardening[i];
    }
    memset(&model, 0, sizeof model);
    bench_model(&model, &parameters, false);
    TEST_ASSERT_TRUE(model.springs_change);
}

void tearDown(void) {}

/* torque = d / compliance + hardening d^3, by bisection in double. */
static double deflection(int joint, double load_n_mm)
{
    const double compliance = (double)parameters.limb.joint[joint].compliance_rad_per_n_mm;
    const double hardening = (double)parameters.drive[joint].hardening_n_mm_per_rad3;
    double low = 0.0, high = load_n_mm * compliance;
    for (int i = 0; i < 80; i++) {
        const double middle = 0.5 * (low + high);
        if (middle / compliance + hardening * middle * middle * middle < load_n_mm) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

static void test_each_joint_yields_at_its_own_load(void)
{
    const float load_n_mm[] = {1000.0f, 4000.0f, 2500.0f}, unknown[] = {NAN, NAN, NAN};
    brace_loaded_joint_t springs[BRACE_LINK_COUNT];
    for (int i = 0; i < 30; i++) { /* it is followed from tick to tick */
        model_springs(&model, &parameters, load_n_mm, unknown, springs);
    }
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        const double d = deflection(i, (double)load_n_mm[i]);
        const double compliance = (double)parameters.limb.joint[i].compliance_rad_per_n_mm;
        const double per_rad = 1.0 / compliance + 3.0 * (double)parameters.drive[i].hardening_n_mm_per_rad3 * d * d;
        ASSERT_CLOSE(d / (double)load_n_mm[i], springs[i].yields_by_rad_per_n_mm, 1e-4);
        ASSERT_CLOSE(1.0 / per_rad, springs[i].slope_rad_per_n_mm, 1e-4);
    }
}

static void test_without_a_load_and_beyond_any_a_spring_is_as_at_rest(void)
{
    const float unknown[] = {NAN, NAN, NAN}, absurd[] = {1e30f, -1e30f, INFINITY};
    brace_loaded_joint_t springs[BRACE_LINK_COUNT], rest[BRACE_LINK_COUNT];
    model_springs_at_rest(&parameters, unknown, rest);
    model_springs(&model, &parameters, unknown, unknown, springs);
    TEST_ASSERT_EQUAL_MEMORY(rest, springs, sizeof rest);
    model_springs(&model, &parameters, absurd, unknown, springs);
    TEST_ASSERT_EQUAL_MEMORY(rest, springs, sizeof rest);
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        TEST_ASSERT_EQUAL_FLOAT(parameters.limb.joint[i].compliance_rad_per_n_mm, rest[i].slope_rad_per_n_mm);
        TEST_ASSERT_EQUAL_FLOAT(parameters.limb.joint[i].compliance_rad_per_n_mm, rest[i].yields_by_rad_per_n_mm);
    }
}

/* A rigid joint stays rigid, however it would harden. And no spring is wound further than a joint turns: with so soft a
 * one the load winds it up to 8 rad, either way. */
static void test_rigid_and_endlessly_soft_springs(void)
{
    const float unknown[] = {NAN, NAN, NAN};
    brace_loaded_joint_t springs[BRACE_LINK_COUNT];
    parameters.limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = 0.0f;
    parameters.limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = 1.0f;
    parameters.drive[BRACE_TIBIA].hardening_n_mm_per_rad3 = 1e-3f;
    bench_model(&model, &parameters, false);
    for (int way = -1; way <= 1; way += 2) {
        const float load_n_mm[] = {1000.0f, 1000.0f, (float)way * 1e6f};
        for (int i = 0; i < 10; i++) {
            model_springs(&model, &parameters, load_n_mm, unknown, springs);
        }
        TEST_ASSERT_EQUAL_FLOAT(0.0f, springs[BRACE_FEMUR].slope_rad_per_n_mm);
        TEST_ASSERT_EQUAL_FLOAT(0.0f, springs[BRACE_FEMUR].yields_by_rad_per_n_mm);
        TEST_ASSERT_EQUAL_FLOAT((float)way * 8.0f, model.deflection_rad[BRACE_TIBIA]);
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, 1.0f / (1.0f + 1e-3f * 64.0f), springs[BRACE_TIBIA].yields_by_rad_per_n_mm);
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, 1.0f / (1.0f + 3e-3f * 64.0f), springs[BRACE_TIBIA].slope_rad_per_n_mm);
    }
}

/* K takes the hip's spring at the hip and the knee's at the knee: as the path for springs that never change does. */
static void test_k_takes_each_spring_at_its_joint(void)
{
    const brace_loaded_joint_t springs[] = {{9e-6f, 9e-6f}, {4e-7f, 4e-7f}, {1.7e-6f, 1.7e-6f}};
    brace_parameters_t other = parameters;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        other.limb.joint[i].compliance_rad_per_n_mm = springs[i].slope_rad_per_n_mm;
        other.drive[i].hardening_n_mm_per_rad3 = 0.0f;
    }
    static model_t linear;
    bench_model(&linear, &other, false);
    TEST_ASSERT_TRUE(linear.is_collapsed);
    brace_stiffness_t changing, fixed;
    float across_n_per_mm = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_OK,
                      model_stiffness(&model, &parameters.limb, 1.0f, 1.4f, springs, &changing, &across_n_per_mm));
    TEST_ASSERT_TRUE(across_n_per_mm != across_n_per_mm); /* a limb in its plane has none */
    TEST_ASSERT_EQUAL(BRACE_OK, model_stiffness(&linear, &other.limb, 1.0f, 1.4f, springs, &fixed, &across_n_per_mm));
    ASSERT_CLOSE(fixed.k_xx_n_per_mm, changing.k_xx_n_per_mm, 1e-4);
    ASSERT_CLOSE(fixed.k_xz_n_per_mm, changing.k_xz_n_per_mm, 1e-4);
    ASSERT_CLOSE(fixed.k_zz_n_per_mm, changing.k_zz_n_per_mm, 1e-4);
}

/* --- where a load takes the limb ------------------------------------------------------------------------------ */

static const float no_load_n_mm[] = {0.0f, 0.0f, 0.0f}, at_25_degc[] = {25.0f, 25.0f, 25.0f};

static void be_soft(bool is_spatial)
{
    parameters.limb = sample_limb[SAMPLE_BEAM];
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        parameters.limb.joint[i].compliance_rad_per_n_mm = 1e-5f * (float)(i + 1);
        parameters.drive[i].hardening_n_mm_per_rad3 = 0.0f;
    }
    bench_model(&model, &parameters, is_spatial);
}

/* The application reports the core's equilibrium by its own conventions: its knee turns with the sense of theta2, the
 * core's with the opposite one. Nothing is promised of a limb that moves far. Without an FPU the application asks the
 * integers, which differ by the third order of the bend. */
static void test_a_limb_in_space_is_reported_as_the_core_finds_it(void)
{
    static const float unbent_rad[] = {0.0f, 1.0f, 1.4f};
    static const brace_vec3_t forces_n[] = {{-3.0f, 2.0f, 5.0f}, {4.0f, -6.0f, 8.0f}, {10.0f, 30.0f, 25.0f}};
    const brace_vec3_t down = {0.36f, 0.48f, -0.8f};
    int far = 0;
    be_soft(true);
    for (int i = 0; i < 3; i++) {
        brace_loaded_joint_t springs[BRACE_LINK_COUNT];
        model_place_t place = {0};
        model_rest_t rest;
        brace_loaded_space_t loaded;
        brace_space_rest_t at;
        brace_space_result_t found;
        memset(&rest, 0x55, sizeof rest);
        model_springs(&model, &parameters, no_load_n_mm, at_25_degc, springs);
        for (int tick = 0; tick < 3; tick++) {
            TEST_ASSERT_EQUAL(BRACE_OK, model_loaded(&model, &parameters.limb, unbent_rad, springs, forces_n[i], down,
                                                     &place, &rest));
        }
        const brace_space_load_t load = {
            .tip_n = forces_n[i], .down = down, .yaw = springs[0], .hip = springs[1], .knee = springs[2]};
        brace_loaded_space_collapse(&parameters.limb, &parameters.gravity, &loaded);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_loaded_space_settle(&loaded, 1.0f, 1.4f, &load, &at));
        TEST_ASSERT_EQUAL(BRACE_OK, brace_loaded_space_stiffness(&loaded, &at, &found));
        const brace_vec3_t moved = found.displacement_mm;
        ASSERT_CLOSE(moved.x, rest.bend.tip_mm.x, 0.5);
        ASSERT_CLOSE(moved.z, rest.bend.tip_mm.z, 0.5);
        ASSERT_CLOSE(moved.y, rest.bend.tip_across_mm, 0.5);
        ASSERT_CLOSE(moved.y, rest.moved_across_mm, 0.5);
        ASSERT_CLOSE(found.tibia_mm.x, rest.bend.tibia_mm.x, 0.5);
        ASSERT_CLOSE(found.tibia_mm.z, rest.bend.tibia_mm.z, 0.5);
        ASSERT_CLOSE(found.tibia_mm.y, rest.bend.tibia_across_mm, 0.5);
        ASSERT_CLOSE(found.yaw_turn_rad, rest.bend.joint_turn_rad[BRACE_COXA], 3e-3);
        ASSERT_CLOSE(found.hip_turn_rad, rest.bend.joint_turn_rad[BRACE_FEMUR], 3e-3);
        ASSERT_CLOSE(-found.knee_turn_rad, rest.bend.joint_turn_rad[BRACE_TIBIA], 3e-3);
        ASSERT_CLOSE(found.k.xx_n_per_mm, rest.space.xx_n_per_mm, 3e-2);
        ASSERT_CLOSE(found.k.xy_n_per_mm, rest.space.xy_n_per_mm, 3e-2);
        ASSERT_CLOSE(found.k.zz_n_per_mm, rest.space.zz_n_per_mm, 3e-2);
        ASSERT_CLOSE(found.k.xx_n_per_mm, rest.plane.k_xx_n_per_mm, 3e-2);
        ASSERT_CLOSE(found.k.xz_n_per_mm, rest.plane.k_xz_n_per_mm, 3e-2);
        const float most_mm = 0.2f * (parameters.limb.femur_mm + parameters.limb.tibia_mm);
        const bool is_far = moved.x * moved.x + moved.y * moved.y + moved.z * moved.z > most_mm * most_mm;
        TEST_ASSERT_EQUAL_HEX32(found.flags | (is_far ? (uint32_t)BRACE_FLAG_MOVED_FAR : 0u), rest.plane.flags);
        TEST_ASSERT_TRUE(isnan(rest.buckling_factor));
        far += is_far;
    }
    TEST_ASSERT_TRUE(far >= 1 && far < 3);
}

enum { FORCES = 34, TICKS_TO_REST = 8 };

static brace_vec3_t towards_hip(int i)
{
    const float force_n = 20.0f * powf(1.2f, (float)i);
    return (brace_vec3_t){-0.9f * force_n, 0.0f, -0.4f * force_n};
}

/* A force that folds the limb is refused, tick by tick and in steps, and what was found before stays. Ticks go on from
 * one another, and may come to a rest that the steps of one question do not reach. */
static void test_a_limb_that_its_load_folds_is_refused(void)
{
    static const float unbent_rad[] = {0.0f, 1.0f, 1.4f};
    const brace_vec3_t down = {0.0f, 0.0f, -1.0f};
    for (int is_spatial = 0; is_spatial < 2; is_spatial++) {
        brace_loaded_joint_t springs[BRACE_LINK_COUNT];
        brace_status_t whole[FORCES];
        model_place_t place = {0};
        model_rest_t rest, untouched;
        static model_work_t work;
        be_soft(is_spatial != 0);
        model_springs(&model, &parameters, no_load_n_mm, at_25_degc, springs);
        memset(&untouched, 0x55, sizeof untouched);
        int answered = 0, refused_late = 0;
        for (int i = 0; i < FORCES; i++) {
            rest = untouched;
            place = (model_place_t){0};
            whole[i] = BRACE_E_SINGULAR;
            for (int tick = 0; tick < TICKS_TO_REST && whole[i] != BRACE_OK; tick++) {
                whole[i] =
                    model_loaded(&model, &parameters.limb, unbent_rad, springs, towards_hip(i), down, &place, &rest);
                TEST_ASSERT_TRUE(whole[i] == BRACE_OK || memcmp(&untouched, &rest, sizeof rest) == 0);
            }
            answered += whole[i] == BRACE_OK;
        }
        for (int i = 0; i < FORCES; i++) {
            rest = untouched;
            int32_t status = model_loaded_begin(&model, unbent_rad, springs, towards_hip(i), down, &work);
            while (status == MODEL_LATER) {
                status = model_loaded_go_on(&model, &parameters.limb, &work, &rest);
                refused_late += status < BRACE_OK;
            }
            TEST_ASSERT_TRUE(whole[i] == status || whole[i] == BRACE_OK);
            TEST_ASSERT_FALSE(work.is_under_way);
            TEST_ASSERT_TRUE(status == BRACE_OK || memcmp(&untouched, &rest, sizeof rest) == 0);
        }
        TEST_ASSERT_TRUE(answered > 0 && answered < FORCES);
#ifndef __SOFTFP__ /* the integers may see at the first step that their words do not hold such a load */
        TEST_ASSERT_TRUE(is_spatial == 0 || refused_late > 0);
#endif
    }
}

static void test_a_limb_in_its_plane_is_reported_as_the_core_finds_it(void)
{
    static const float unbent_rad[] = {0.0f, 1.0f, 1.4f};
    static const brace_vec3_t forces_n[] = {{-3.0f, 0.0f, 5.0f}, {4.0f, 0.0f, -8.0f}, {20.0f, 0.0f, 20.0f}};
    const brace_vec3_t down = {0.6f, 0.0f, -0.8f};
    be_soft(false);
    for (int i = 0; i < 3; i++) {
        brace_loaded_joint_t springs[BRACE_LINK_COUNT];
        model_place_t place = {0};
        model_rest_t rest;
        memset(&rest, 0x55, sizeof rest);
        model_springs(&model, &parameters, no_load_n_mm, at_25_degc, springs);
        TEST_ASSERT_EQUAL(
            BRACE_OK, model_loaded(&model, &parameters.limb, unbent_rad, springs, forces_n[i], down, &place, &rest));
        const brace_loaded_stiffness_t found = equilibrium(
            &parameters, 1.0f, 1.4f, (brace_force_t){forces_n[i].x, forces_n[i].z}, (brace_vec_t){down.x, down.z});
        const brace_displacement_t moved = found.displacement;
        ASSERT_CLOSE(moved.x_mm, rest.bend.tip_mm.x, 0.1);
        ASSERT_CLOSE(moved.z_mm, rest.bend.tip_mm.z, 0.1);
        ASSERT_CLOSE(found.tibia_mm.x, rest.bend.tibia_mm.x, 0.1);
        ASSERT_CLOSE(found.tibia_mm.z, rest.bend.tibia_mm.z, 0.1);
        TEST_ASSERT_TRUE(isnan(rest.moved_across_mm));
        TEST_ASSERT_EQUAL_FLOAT(0.0f, rest.bend.tip_across_mm);
        TEST_ASSERT_EQUAL_FLOAT(0.0f, rest.bend.tibia_across_mm);
        TEST_ASSERT_EQUAL_FLOAT(0.0f, rest.bend.joint_turn_rad[BRACE_COXA]);
        ASSERT_CLOSE(-found.knee_turn_rad, rest.bend.joint_turn_rad[BRACE_TIBIA], 1e-3);
        ASSERT_CLOSE(found.stiffness.k_xx_n_per_mm, rest.plane.k_xx_n_per_mm, 1e-2);
        ASSERT_CLOSE(found.stiffness.k_zz_n_per_mm, rest.plane.k_zz_n_per_mm, 1e-2);
        const float most_mm = 0.2f * (parameters.limb.femur_mm + parameters.limb.tibia_mm);
        const float moved_mm2 = moved.x_mm * moved.x_mm + moved.z_mm * moved.z_mm;
        const uint32_t flags = brace_loaded_flags(found.buckling_factor, moved_mm2, 5.0f * most_mm);
        TEST_ASSERT_EQUAL_HEX32(flags | found.stiffness.flags, rest.plane.flags);
        TEST_ASSERT_EQUAL(i == 2, moved_mm2 > most_mm * most_mm);
    }
}

/* Encoders behind two gears that answer in turn: with its encoder a joint stands where it is measured, without it where
 * its spring lets it. The rests are far apart, and each tick has its own K. */
static void test_joints_that_are_measured_in_turn_have_K_in_each_tick(void)
{
    static const float unbent_rad[] = {0.0f, 1.0f, 1.4f};
    const brace_vec3_t force_n = {-6.0f, 0.0f, 10.0f}, down = {0.0f, 0.0f, -1.0f};
    for (int is_spatial = 0; is_spatial < 2; is_spatial++) {
        model_place_t place = {0};
        float turn_rad[2];
        be_soft(is_spatial != 0);
        for (int tick = 0; tick < 10; tick++) {
            brace_loaded_joint_t springs[BRACE_LINK_COUNT];
            model_rest_t rest;
            model_springs(&model, &parameters, no_load_n_mm, at_25_degc, springs);
            springs[tick % 2 == 0 ? BRACE_FEMUR : BRACE_TIBIA].yields_by_rad_per_n_mm = 0.0f;
            TEST_ASSERT_EQUAL(
                BRACE_OK, model_loaded(&model, &parameters.limb, unbent_rad, springs, force_n, down, &place, &rest));
            TEST_ASSERT_EQUAL_HEX32(0u, rest.plane.flags);
            turn_rad[tick % 2] = rest.bend.joint_turn_rad[BRACE_TIBIA];
        }
        TEST_ASSERT_TRUE(fabsf(turn_rad[1] - turn_rad[0]) > 0.05f);
    }
}

/* Whatever the tick before has left: the next ticks do not go on from it for ever. */
static void test_a_place_that_leads_nowhere_is_left(void)
{
    static const float unbent_rad[] = {0.0f, 1.0f, 1.4f};
    const brace_vec3_t force_n = {-6.0f, 0.0f, 10.0f}, down = {0.0f, 0.0f, -1.0f};
    for (int is_spatial = 0; is_spatial < 2; is_spatial++) {
        brace_loaded_joint_t springs[BRACE_LINK_COUNT];
        model_place_t place = {0};
        model_rest_t rest;
        be_soft(is_spatial != 0);
        model_springs(&model, &parameters, no_load_n_mm, at_25_degc, springs);
        TEST_ASSERT_EQUAL(BRACE_OK,
                          model_loaded(&model, &parameters.limb, unbent_rad, springs, force_n, down, &place, &rest));
        if (is_spatial != 0) {
            place.at.space.pose.hip = NAN;
        } else {
#ifdef __SOFTFP__
            place.at.plane.femur_shape.root = INT32_MAX;
#else
            place.at.plane.femur_shape.root = NAN;
#endif
        }
        int without = 0;
        while (without < 20 &&
               model_loaded(&model, &parameters.limb, unbent_rad, springs, force_n, down, &place, &rest) != BRACE_OK) {
            without++;
        }
        TEST_ASSERT_TRUE(without > 0 && without <= 8);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_joint_yields_at_its_own_load);
    RUN_TEST(test_without_a_load_and_beyond_any_a_spring_is_as_at_rest);
    RUN_TEST(test_rigid_and_endlessly_soft_springs);
    RUN_TEST(test_k_takes_each_spring_at_its_joint);
    RUN_TEST(test_a_limb_in_space_is_reported_as_the_core_finds_it);
    RUN_TEST(test_a_limb_that_its_load_folds_is_refused);
    RUN_TEST(test_a_limb_in_its_plane_is_reported_as_the_core_finds_it);
    RUN_TEST(test_joints_that_are_measured_in_turn_have_K_in_each_tick);
    RUN_TEST(test_a_place_that_leads_nowhere_is_left);
    return UNITY_END();
}
