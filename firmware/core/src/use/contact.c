#include "brace/contact.h"

#include <math.h>
#include <stddef.h>

#include "base/check.h"
#include "base/trig.h"
#include "base/vec.h"
#include "use/stiffness_check.h"

#define FORCE_LIMIT_N 1e6f
#define DISPLACEMENT_LIMIT_MM 1e4f
#define FRICTION_LIMIT 10.0f
#define NORMAL_LIMIT 10.0f
#define NORMAL_TOLERANCE 0.01f

brace_status_t brace_contact_sag(const brace_stiffness_t *stiffness, brace_force_t load, brace_displacement_t *sag)
{
    if (stiffness == NULL || sag == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status =
        brace_first_refusal(brace_check_two(load.x_n, load.z_n, FORCE_LIMIT_N), brace_check_stiffness(stiffness));
    if (status == BRACE_OK) {
        const float det = stiffness->lambda_min_n_per_mm * stiffness->lambda_max_n_per_mm;
        sag->x_mm = (stiffness->k_zz_n_per_mm * load.x_n - stiffness->k_xz_n_per_mm * load.z_n) / det;
        sag->z_mm = (stiffness->k_xx_n_per_mm * load.z_n - stiffness->k_xz_n_per_mm * load.x_n) / det;
    }
    return status;
}

brace_status_t brace_contact_force(const brace_stiffness_t *stiffness, brace_displacement_t displacement,
                                   brace_contact_force_t *contact)
{
    if (stiffness == NULL || contact == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = brace_first_refusal(
        brace_check_two(displacement.x_mm, displacement.z_mm, DISPLACEMENT_LIMIT_MM), brace_check_stiffness(stiffness));
    if (status == BRACE_OK) {
        const float x = displacement.x_mm, z = displacement.z_mm, size_mm = vec_length((brace_vec_t){x, z});
        const float force_x = stiffness->k_xx_n_per_mm * x + stiffness->k_xz_n_per_mm * z;
        const float force_z = stiffness->k_xz_n_per_mm * x + stiffness->k_zz_n_per_mm * z;
        const float low_n = stiffness->lambda_min_n_per_mm * size_mm;
        const float high_n = stiffness->lambda_max_n_per_mm * size_mm;
        float magnitude_n = vec_length((brace_vec_t){force_x, force_z});
        magnitude_n = magnitude_n > low_n ? magnitude_n : low_n;
        magnitude_n = magnitude_n < high_n ? magnitude_n : high_n;
        *contact = (brace_contact_force_t){{force_x, force_z}, magnitude_n, low_n, high_n};
    }
    return status;
}

brace_status_t brace_contact_grip(brace_force_t force, float normal_x, float normal_z, float friction_ratio,
                                  brace_contact_grip_t *grip)
{
    if (grip == NULL) {
        return BRACE_E_NULL;
    }
    brace_status_t status = brace_check_two(force.x_n, force.z_n, FORCE_LIMIT_N);
    status = brace_first_refusal(status, brace_check_two(normal_x, normal_z, NORMAL_LIMIT));
    status = brace_first_refusal(status, brace_check_range(friction_ratio, 0.0f, FRICTION_LIMIT));
    if (status != BRACE_OK) {
        return status;
    }
    const float length = vec_length((brace_vec_t){normal_x, normal_z});
    if (fabsf(length - 1.0f) > NORMAL_TOLERANCE) {
        return BRACE_E_RANGE;
    }
    const float pressing_n = (force.x_n * normal_x + force.z_n * normal_z) / length;
    const float sliding_n = fabsf(force.z_n * normal_x - force.x_n * normal_z) / length;
    const float excess_n = sliding_n - friction_ratio * pressing_n;
    grip->normal_n = pressing_n;
    grip->tangent_n = sliding_n;
    grip->margin_n = -excess_n;
    grip->state = pressing_n <= 0.0f ? BRACE_CONTACT_LIFTS
                  : excess_n <= 0.0f ? BRACE_CONTACT_HOLDS
                                     : BRACE_CONTACT_SLIDES;
    /* The angle from the cone's edge (1, mu) to the force (pressing, sliding), by their cross and dot products. */
    grip->angle_left_rad = -brace_atan2(excess_n, pressing_n + friction_ratio * sliding_n);
    return BRACE_OK;
}
