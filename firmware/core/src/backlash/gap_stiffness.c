#include "brace/gap_stiffness.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/trig.h"
#include "base/vec.h"

/* A tip closer than this to a free joint's axis has no direction that the joint still carries. */
#define LEAST_LEVER_MM 1e-3f

/* Two arms count as one line when the sine of their angle is below this. */
#define ALIGNED 1e-3f

/* The arm from the joint to the tip: the lever turned back by a quarter turn. */
static brace_vec_t arm(brace_point_t lever)
{
    return (brace_vec_t){lever.z_mm, -lever.x_mm};
}

/* u u' / (u' C u) for a force along an arm. */
static void carried_along(const brace_stiffness_t *engaged, brace_vec_t along, float length, brace_stiffness_t *free)
{
    const brace_vec_t u = vec_scaled(along, 1.0f / length);
    const brace_vec_t stiff = brace_direction(engaged->stiff_axis_rad);
    const float cosine = vec_dot(stiff, u);
    const float sine = vec_cross(stiff, u);
    const float yields_mm_per_n =
        cosine * cosine / engaged->lambda_max_n_per_mm + sine * sine / engaged->lambda_min_n_per_mm;
    const float k_n_per_mm = 1.0f / yields_mm_per_n;
    /* an axis has no direction: take the half with x >= 0 */
    const float side = u.x < 0.0f || (u.x == 0.0f && u.z < 0.0f) ? -1.0f : 1.0f;
    free->k_xx_n_per_mm = k_n_per_mm * u.x * u.x;
    free->k_xz_n_per_mm = k_n_per_mm * u.x * u.z;
    free->k_zz_n_per_mm = k_n_per_mm * u.z * u.z;
    free->lambda_max_n_per_mm = k_n_per_mm;
    free->stiff_axis_rad = brace_atan2(side * u.z, side * u.x);
}

static void both_free(brace_vec_t femur, brace_vec_t tibia, float femur_mm, float tibia_mm, brace_stiffness_t *now)
{
    const bool aligned = fabsf(vec_cross(femur, tibia)) < ALIGNED * femur_mm * tibia_mm;
    *now = (brace_stiffness_t){.flags = now->flags | (aligned ? BRACE_FLAG_NEAR_SINGULAR : 0u)};
}

brace_status_t brace_gap_stiffness_known(const brace_stiffness_t *engaged, const brace_pose_t *pose, uint32_t open,
                                         brace_gap_stiffness_t *result)
{
    const brace_vec_t femur = arm(pose->lever_femur), tibia = arm(pose->lever_tibia);
    const bool femur_free = (open & BRACE_GAP_FEMUR) != 0u, tibia_free = (open & BRACE_GAP_TIBIA) != 0u;
    const float femur_mm = vec_length(femur), tibia_mm = vec_length(tibia);
    if ((femur_free && femur_mm < LEAST_LEVER_MM) || (tibia_free && tibia_mm < LEAST_LEVER_MM)) {
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
