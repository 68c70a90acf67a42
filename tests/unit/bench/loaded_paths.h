/* The three paths under a load (in the plane by floats and by integers, and in space), asked of one limb alike. */
#ifndef LOADED_PATHS_H
#define LOADED_PATHS_H

#include <string.h>

#include "brace/loaded.h"
#include "brace/loaded_fixed.h"
#include "brace/loaded_space.h"
#include "sample_limbs.h"
#include "times.h"
#include "unity.h"

typedef enum { FLOATS, INTEGERS, PATHS } path_t; /* in the plane */

static brace_limb_t limb;
static brace_gravity_t weights;
static brace_load_t load;
static brace_space_load_t space_load;
static double theta1_rad, theta2_rad;

/* For a suite's setUp. */
static inline void start_anew(void)
{
    limb = sample_limb[SAMPLE_PAPER];
    memset(&weights, 0, sizeof weights);
    load = (brace_load_t){.down = {0.0f, -1.0f}};
    space_load = (brace_space_load_t){.down = {0.0f, 0.0f, -1.0f}};
    theta1_rad = theta2_rad = 0.0;
}

static inline brace_loaded_joint_t spring_of(int joint)
{
    const float yields = limb.joint[joint].compliance_rad_per_n_mm;
    return (brace_loaded_joint_t){yields, yields};
}

/* In the plane. */
static inline brace_status_t status_in_plane(path_t path, double x_n, double z_n, brace_loaded_stiffness_t *result)
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

static inline brace_loaded_stiffness_t in_plane(path_t path, double x_n, double z_n)
{
    brace_loaded_stiffness_t result;
    memset(&result, 0, sizeof result);
    TEST_ASSERT_EQUAL(BRACE_OK, status_in_plane(path, x_n, z_n, &result));
    return result;
}

/* In space. factor may be NULL. */
static inline brace_status_t status_in_space(const double force_n[3], brace_space_result_t *result, float *factor)
{
    brace_loaded_space_t loaded;
    space_load.tip_n = (brace_vec3_t){(float)force_n[0], (float)force_n[1], (float)force_n[2]};
    space_load.yaw = spring_of(BRACE_COXA);
    space_load.hip = spring_of(BRACE_FEMUR);
    space_load.knee = spring_of(BRACE_TIBIA);
    brace_loaded_space_collapse(&limb, &weights, &loaded);
    brace_space_rest_t rest;
    brace_status_t status =
        brace_loaded_space_settle(&loaded, (float)theta1_rad, (float)theta2_rad, &space_load, &rest);
    status = status == BRACE_OK ? brace_loaded_space_stiffness(&loaded, &rest, result) : status;
    if (status == BRACE_OK && factor != NULL) {
        *factor = brace_loaded_space_buckling_factor(&loaded, &rest);
    }
    return status;
}

static inline brace_space_result_t in_space(const double force_n[3], float *factor)
{
    brace_space_result_t result;
    memset(&result, 0, sizeof result);
    TEST_ASSERT_EQUAL(BRACE_OK, status_in_space(force_n, &result, factor));
    return result;
}

#endif
