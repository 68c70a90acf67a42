/* K in space under a load, as this controller computes it: in floats, or in integers where floats are computed in
 * software. brace/loaded_space.h says what each step does, brace/loaded_space_fixed.h how the integers differ. */
#ifndef BRACE_STIFFNESS_SPACE_PATH_H
#define BRACE_STIFFNESS_SPACE_PATH_H

#include <stdbool.h>

#include "brace/loaded_space.h"
#include "brace/loaded_space_fixed.h"

#ifdef __SOFTFP__

typedef brace_loaded_space_fixed_t space_path_limb_t;
typedef brace_space_fixed_rest_t space_path_rest_t;
typedef brace_space_fixed_rest_t space_path_shape_t; /* what the search for the buckling factor needs of it */
typedef brace_buckling_search_t space_path_search_t;
typedef brace_space_fixed_rest_t space_path_work_t;  /* begin settles, and one step finds K there */

static inline void space_path_collapse(const brace_limb_t *limb, const brace_gravity_t *weights,
                                       space_path_limb_t *collapsed)
{
    brace_loaded_space_t loaded;
    brace_loaded_space_collapse(limb, weights, &loaded);
    brace_loaded_space_fixed_collapse(&loaded, collapsed);
}

static inline brace_status_t space_path_settle(const space_path_limb_t *limb, float theta1_rad, float theta2_rad,
                                               const brace_space_load_t *load, space_path_rest_t *rest)
{
    return brace_loaded_space_fixed_settle(limb, theta1_rad, theta2_rad, load, rest);
}

static inline brace_status_t space_path_stiffness(const space_path_limb_t *limb, const space_path_rest_t *rest,
                                                  brace_space_result_t *result)
{
    return brace_loaded_space_fixed_stiffness(limb, rest, result);
}

static inline brace_status_t space_path_begin(const space_path_limb_t *limb, float theta1_rad, float theta2_rad,
                                              const brace_space_load_t *load, space_path_work_t *work)
{
    return brace_loaded_space_fixed_settle(limb, theta1_rad, theta2_rad, load, work);
}

static inline bool space_path_step(const space_path_limb_t *limb, space_path_work_t *work,
                                   brace_space_result_t *result, brace_status_t *status)
{
    *status = brace_loaded_space_fixed_stiffness(limb, work, result);
    return true;
}

static inline brace_status_t space_path_in_plane(const brace_k3_t *k, brace_stiffness_t *plane)
{
    return brace_loaded_space_fixed_in_plane(k, plane);
}

static inline brace_status_t space_path_turn(float theta0_rad, const brace_k3_t *k,
                                             brace_stiffness_spatial_t *stiffness)
{
    return brace_loaded_space_fixed_turn(theta0_rad, k, stiffness);
}

static inline void space_path_buckling_begin(const space_path_limb_t *limb, const space_path_rest_t *rest,
                                             space_path_shape_t *shape, space_path_search_t *search)
{
    (void)limb;
    *shape = *rest;
    brace_loaded_space_fixed_buckling_begin(search);
}

static inline bool space_path_buckling_step(const space_path_limb_t *limb, const space_path_shape_t *shape,
                                            space_path_search_t *search, float *factor)
{
    return brace_loaded_space_fixed_buckling_step(limb, shape, search, factor);
}

#else

typedef brace_loaded_space_t space_path_limb_t;
typedef brace_space_rest_t space_path_rest_t;
typedef brace_space_search_t space_path_search_t;
typedef brace_space_work_t space_path_work_t;
typedef brace_space_shape_t space_path_shape_t; /* what the search for the buckling factor needs of it */

static inline void space_path_collapse(const brace_limb_t *limb, const brace_gravity_t *weights,
                                       space_path_limb_t *collapsed)
{
    brace_loaded_space_collapse(limb, weights, collapsed);
}

static inline brace_status_t space_path_settle(const space_path_limb_t *limb, float theta1_rad, float theta2_rad,
                                               const brace_space_load_t *load, space_path_rest_t *rest)
{
    return brace_loaded_space_settle(limb, theta1_rad, theta2_rad, load, rest);
}

static inline brace_status_t space_path_stiffness(const space_path_limb_t *limb, const space_path_rest_t *rest,
                                                  brace_space_result_t *result)
{
    return brace_loaded_space_stiffness(limb, rest, result);
}

static inline brace_status_t space_path_begin(const space_path_limb_t *limb, float theta1_rad, float theta2_rad,
                                              const brace_space_load_t *load, space_path_work_t *work)
{
    return brace_loaded_space_begin(limb, theta1_rad, theta2_rad, load, work);
}

static inline bool space_path_step(const space_path_limb_t *limb, space_path_work_t *work,
                                   brace_space_result_t *result, brace_status_t *status)
{
    return brace_loaded_space_step(limb, work, result, status);
}

static inline brace_status_t space_path_in_plane(const brace_k3_t *k, brace_stiffness_t *plane)
{
    return brace_loaded_space_in_plane(k, plane);
}

static inline brace_status_t space_path_turn(float theta0_rad, const brace_k3_t *k,
                                             brace_stiffness_spatial_t *stiffness)
{
    return brace_loaded_space_turn(theta0_rad, k, stiffness);
}

static inline void space_path_buckling_begin(const space_path_limb_t *limb, const space_path_rest_t *rest,
                                             space_path_shape_t *shape, space_path_search_t *search)
{
    brace_loaded_space_buckling_begin(limb, rest, shape, search);
}

static inline bool space_path_buckling_step(const space_path_limb_t *limb, const space_path_shape_t *shape,
                                            space_path_search_t *search, float *factor)
{
    return brace_loaded_space_buckling_step(limb, shape, search, factor);
}

#endif

#endif
