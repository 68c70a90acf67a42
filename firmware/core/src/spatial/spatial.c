#include "brace/spatial.h"

#include <math.h>
#include <stddef.h>

#include "base/check.h"
#include "base/trig.h"
#include "chain/general.h"

void brace_spatial_set_springs(brace_spatial_t *spatial, float yaw_rad_per_n_mm, float hip_rad_per_n_mm,
                               float knee_rad_per_n_mm)
{
    spatial->yaw_rad_per_n_mm = yaw_rad_per_n_mm;
    spatial->hip_root = sqrtf(hip_rad_per_n_mm);
    spatial->knee_root = sqrtf(knee_rad_per_n_mm);
}

static inline float aside(const brace_aside_t *link, float along_mm, float beside_mm)
{
    return brace_fma(along_mm, brace_fma(along_mm, link->per_mm2, link->per_mm),
                     link->torsion_rad_per_n_mm * beside_mm * beside_mm);
}

/* The compliance across the plane [mm/N]. tip_mm: vector from the hip to the tip, in the plane. */
static inline float across(const brace_spatial_t *spatial, brace_vec_t tip_mm, brace_vec_t half)
{
    const brace_vec_t knee = vec_doubled(half); /* direction of the tibia seen from the femur, mirrored */
    const float from_yaw_mm = spatial->coxa_mm + tip_mm.x;
    return brace_fma(spatial->yaw_rad_per_n_mm * from_yaw_mm, from_yaw_mm, spatial->across_mm_per_n) +
           aside(&spatial->coxa_aside, tip_mm.x, tip_mm.z) +
           aside(&spatial->femur_aside, spatial->plane.tibia_mm * knee.x, spatial->plane.tibia_mm * knee.z);
}

brace_status_t brace_spatial_in_plane(const brace_spatial_t *spatial, float theta1_rad, float theta2_rad,
                                      brace_stiffness_t *plane, float *across_n_per_mm)
{
    if (spatial == NULL || plane == NULL || across_n_per_mm == NULL) {
        return BRACE_E_NULL;
    }
    brace_status_t status = brace_check_two(theta1_rad, theta2_rad, BRACE_ANGLE_LIMIT_RAD);
    if (status != BRACE_OK) {
        return status;
    }
    const brace_posture_t at = brace_posture(theta1_rad, theta2_rad);
    const brace_vec_t tip_mm = brace_general_tip_seen(&spatial->plane, at.half);
    brace_tensor_t c = brace_general_sum(&spatial->plane, &at, tip_mm, spatial->hip_root, spatial->knee_root);
    brace_tensor_add(&c, vec_plus_scaled(vec_turned_back(spatial->coxa_moment, at.bisector), vec_quarter(tip_mm),
                                         spatial->coxa_moment_per_lever_mm));
    status = brace_tensor_inverse(&c, vec_doubled(at.bisector), plane);
    if (status == BRACE_OK) {
        const float across_mm_per_n = across(spatial, vec_turned(tip_mm, at.bisector), at.half);
        *across_n_per_mm = across_mm_per_n > 0.0f ? 1.0f / across_mm_per_n : NAN;
    }
    return status;
}

/* Sorts the two eigenvalues in the plane and the one across it, which may be least, middle or largest. */
static inline void sort(float least, float most, float across_n_per_mm, float ascending[3])
{
    ascending[0] = across_n_per_mm < least ? across_n_per_mm : least;
    ascending[1] = across_n_per_mm < least ? least : across_n_per_mm > most ? most : across_n_per_mm;
    ascending[2] = across_n_per_mm > most ? across_n_per_mm : most;
}

brace_status_t brace_spatial_turn(float theta0_rad, const brace_stiffness_t *plane, float across_n_per_mm,
                                  brace_stiffness_spatial_t *stiffness)
{
    if (plane == NULL || stiffness == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = brace_check_magnitude(theta0_rad, BRACE_ANGLE_LIMIT_RAD);
    if (status != BRACE_OK) {
        return status;
    }
    if (!brace_is_finite(across_n_per_mm) || across_n_per_mm < 0.0f) {
        return BRACE_E_SINGULAR;
    }
    const brace_vec_t yaw = brace_direction(theta0_rad); /* seen from above, so z stands for y here */
    const float more_outwards = plane->k_xx_n_per_mm - across_n_per_mm;
    stiffness->k_xx_n_per_mm = brace_fma(more_outwards * yaw.x, yaw.x, across_n_per_mm);
    stiffness->k_xy_n_per_mm = more_outwards * yaw.x * yaw.z;
    stiffness->k_xz_n_per_mm = plane->k_xz_n_per_mm * yaw.x;
    stiffness->k_yy_n_per_mm = brace_fma(more_outwards * yaw.z, yaw.z, across_n_per_mm);
    stiffness->k_yz_n_per_mm = plane->k_xz_n_per_mm * yaw.z;
    stiffness->k_zz_n_per_mm = plane->k_zz_n_per_mm;
    sort(plane->lambda_min_n_per_mm, plane->lambda_max_n_per_mm, across_n_per_mm, stiffness->lambda_n_per_mm);

    if (across_n_per_mm > plane->lambda_max_n_per_mm) {
        stiffness->stiff_axis[0] = -yaw.z;
        stiffness->stiff_axis[1] = yaw.x;
        stiffness->stiff_axis[2] = 0.0f;
    } else {
        const float outwards = brace_cosine_coarse(plane->stiff_axis_rad);
        stiffness->stiff_axis[0] = outwards * yaw.x;
        stiffness->stiff_axis[1] = outwards * yaw.z;
        stiffness->stiff_axis[2] = brace_sine(plane->stiff_axis_rad);
    }
    stiffness->flags = plane->flags;
    return BRACE_OK;
}

brace_status_t brace_spatial_stiffness(const brace_spatial_t *spatial, float theta0_rad, float theta1_rad,
                                       float theta2_rad, brace_stiffness_spatial_t *stiffness)
{
    brace_stiffness_t plane;
    float across_n_per_mm;
    const brace_status_t status = brace_spatial_in_plane(spatial, theta1_rad, theta2_rad, &plane, &across_n_per_mm);
    return status == BRACE_OK ? brace_spatial_turn(theta0_rad, &plane, across_n_per_mm, stiffness) : status;
}
