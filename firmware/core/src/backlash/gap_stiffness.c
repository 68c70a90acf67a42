#include "brace/gap_stiffness.h"

#include <stdbool.h>
#include <stddef.h>

#include "base/check.h"
#include "base/trig.h"
#include "base/vec.h"

#define LEAST_LEVER_MM 1e-3f
#define LENGTH_LIMIT_MM 1e5f
#define ALIGNED 1e-3f

/* From the joint to the tip: the lever turned back by a quarter. */
static brace_vec_t arm(brace_point_t lever)
{
    return (brace_vec_t){lever.z_mm, -lever.x_mm};
}

/* u u' / (u' C u) for a force along an arm. */
static void carried_along(const brace_stiffness_t *engaged, brace_vec_t along, float length, brace_stiffness_t *free)
{
    const brace_vec_t u = vec_scaled(along, 1.0f / length);
    const brace_vec_t stiff = brace_direction(brace_turn(engaged->stiff_axis_rad));
    const float cosine = vec_dot(stiff, u);
    const float sine = vec_cross(stiff, u);
    const float yields_mm_per_n = cosine * cosine / engaged->lambda_max_n_per_mm +
                                  sine * sine / engaged->lambda_min_n_per_mm;
    const float k_n_per_mm = 1.0f / yields_mm_per_n;
    /* an axis, not an arrow: its half with x >= 0 */
    const float side = u.x < 0.0f || (u.x == 0.0f && u.z < 0.0f) ? -1.0f : 1.0f;
    free->k_xx_n_per_mm = k_n_per_mm * u.x * u.x;
    free->k_xz_n_per_mm = k_n_per_mm * u.x * u.z;
    free->k_zz_n_per_mm = k_n_per_mm * u.z * u.z;
    free->lambda_max_n_per_mm = k_n_per_mm;
    free->stiff_axis_rad = brace_atan2(side * u.z, side * u.x);
}

static void both_free(brace_vec_t femur, brace_vec_t tibia, float femur_mm, float tibia_mm, brace_stiffness_t *now)
{
    const bool aligned = __builtin_fabsf(vec_cross(femur, tibia)) < ALIGNED * femur_mm * tibia_mm;
    *now = (brace_stiffness_t){.flags = now->flags | (aligned ? BRACE_FLAG_NEAR_SINGULAR : 0u)};
}

brace_status_t brace_gap_stiffness_known(const brace_stiffness_t *engaged, const brace_pose_t *pose, uint32_t open,
                                         brace_gap_stiffness_t *result)
{
    const brace_vec_t femur = arm(pose->lever_femur), tibia = arm(pose->lever_tibia);
    const bool femur_free = (open & BRACE_GAP_FEMUR) != 0u, tibia_free = (open & BRACE_GAP_TIBIA) != 0u;
    const float femur_mm = femur_free ? brace_length(femur.x, femur.z) : LENGTH_LIMIT_MM;
    const float tibia_mm = tibia_free ? brace_length(tibia.x, tibia.z) : LENGTH_LIMIT_MM;
    if (femur_mm < LEAST_LEVER_MM || tibia_mm < LEAST_LEVER_MM) {
        return BRACE_E_SINGULAR;
    }
    result->now = result->engaged = *engaged;
    if (!femur_free && !tibia_free) {
        return BRACE_OK;
    }
    if (femur_free && tibia_free) {
        both_free(femur, tibia, femur_mm, tibia_mm, &result->now);
    } else if (femur_free) {
        carried_along(engaged, femur, femur_mm, &result->now);
    } else {
        carried_along(engaged, tibia, tibia_mm, &result->now);
    }
    result->now.lambda_min_n_per_mm = 0.0f;
    result->now.flags |= BRACE_FLAG_GAP_OPEN;
    return BRACE_OK;
}

brace_status_t brace_gap_stiffness(const brace_stiffness_t *engaged, const brace_pose_t *pose, uint32_t open,
                                   brace_gap_stiffness_t *result)
{
    if (pose == NULL || result == NULL) {
        return BRACE_E_NULL;
    }
    brace_status_t status = brace_check(pose, &pose->lever_femur.x_mm, BRACE_INPUT_POINT);
    if (status == BRACE_OK) {
        status = brace_check_stiffness(engaged, pose, &pose->lever_tibia.x_mm, BRACE_INPUT_POINT);
    }
    if (status == BRACE_OK && (open & ~(uint32_t)(BRACE_GAP_FEMUR | BRACE_GAP_TIBIA)) != 0u) {
        status = BRACE_E_RANGE;
    }
    if (status != BRACE_OK) {
        return status;
    }
    return brace_gap_stiffness_known(engaged, pose, open, result);
}
