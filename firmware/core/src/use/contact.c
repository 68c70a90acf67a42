#include "brace/contact.h"

#include <stdbool.h>
#include <stddef.h>

#include "base/check.h"
#include "base/off_tick.h"
#include "base/trig.h"

#define FORCE_LIMIT_N 1e6f
#define DISPLACEMENT_LIMIT_MM 1e4f
#define FRICTION_LIMIT 10.0f
#define NORMAL_TOLERANCE 0.01f

/* C, with its principal stiffnesses inverted, or K, applied to (x, z). */
BRACE_OFF_TICK
static brace_status_t apply(const brace_stiffness_t *stiffness, bool inverted, float x, float z, float limit,
                            brace_vec_t *result)
{
    brace_status_t status = brace_check_stiffness(stiffness);
    if (status == BRACE_OK) {
        status = brace_check_two(x, z, limit);
    }
    if (status == BRACE_OK) {
        const brace_vec_t axis = brace_direction(brace_turn(stiffness->stiff_axis_rad));
        float along = axis.x * x + axis.z * z;
        float across = axis.x * z - axis.z * x;
        if (inverted) {
            along /= stiffness->lambda_max_n_per_mm;
            across /= stiffness->lambda_min_n_per_mm;
        } else {
            along *= stiffness->lambda_max_n_per_mm;
            across *= stiffness->lambda_min_n_per_mm;
        }
        result->x = axis.x * along - axis.z * across;
        result->z = axis.z * along + axis.x * across;
    }
    return status;
}

BRACE_OFF_TICK
brace_status_t brace_contact_sag(const brace_stiffness_t *stiffness, brace_force_t load,
                                 brace_displacement_t *sag)
{
    if (sag == NULL) {
        return BRACE_E_NULL;
    }
    brace_vec_t result;
    const brace_status_t status = apply(stiffness, true, load.x_n, load.z_n, FORCE_LIMIT_N, &result);
    if (status == BRACE_OK) {
        *sag = (brace_displacement_t){result.x, result.z};
    }
    return status;
}

BRACE_OFF_TICK
brace_status_t brace_contact_force(const brace_stiffness_t *stiffness, brace_displacement_t displacement,
                                   brace_contact_force_t *contact)
{
    if (contact == NULL) {
        return BRACE_E_NULL;
    }
    brace_vec_t force;
    const brace_status_t status =
        apply(stiffness, false, displacement.x_mm, displacement.z_mm, DISPLACEMENT_LIMIT_MM, &force);
    if (status == BRACE_OK) {
        const float size_mm = brace_length(displacement.x_mm, displacement.z_mm);
        contact->force = (brace_force_t){force.x, force.z};
        contact->magnitude_n = brace_length(force.x, force.z);
        contact->low_n = stiffness->lambda_min_n_per_mm * size_mm;
        contact->high_n = stiffness->lambda_max_n_per_mm * size_mm;
    }
    return status;
}

BRACE_OFF_TICK
brace_status_t brace_contact_grip(brace_force_t force, float normal_x, float normal_z, float friction_ratio,
                                  brace_contact_grip_t *grip)
{
    if (grip == NULL) {
        return BRACE_E_NULL;
    }
    brace_status_t status = brace_check_two(force.x_n, force.z_n, FORCE_LIMIT_N);
    if (status == BRACE_OK) {
        status = brace_check_two(normal_x, normal_z, FRICTION_LIMIT);
    }
    if (status == BRACE_OK) {
        status = brace_check_magnitude(friction_ratio, FRICTION_LIMIT);
    }
    const float length = brace_length(normal_x, normal_z);
    if (status == BRACE_OK && (__builtin_fabsf(length - 1.0f) > NORMAL_TOLERANCE || friction_ratio < 0.0f)) {
        status = BRACE_E_RANGE;
    }
    if (status != BRACE_OK) {
        return status;
    }
    const float pressing_n = (force.x_n * normal_x + force.z_n * normal_z) / length;
    const float sliding_n = __builtin_fabsf(force.z_n * normal_x - force.x_n * normal_z) / length;
    const float excess_n = sliding_n - friction_ratio * pressing_n;
    grip->normal_n = pressing_n;
    grip->tangent_n = sliding_n;
    grip->margin_n = -excess_n;
    /* from the cone's edge (1, mu) to the force (pressing, sliding): their cross product over their dot */
    grip->angle_left_rad = -brace_atan2(excess_n, pressing_n + friction_ratio * sliding_n);
    grip->state = !(pressing_n > 0.0f) ? BRACE_CONTACT_LIFTS
                  : excess_n > 0.0f    ? BRACE_CONTACT_SLIDES
                                       : BRACE_CONTACT_HOLDS;
    return BRACE_OK;
}
