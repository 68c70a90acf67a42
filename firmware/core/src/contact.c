#include "brace/contact.h"

#include <stdbool.h>
#include <stddef.h>

#include "check.h"
#include "trig.h"

#define FORCE_LIMIT_N 1e6f
#define DISPLACEMENT_LIMIT_MM 1e4f
#define FRICTION_LIMIT 10.0f
#define NORMAL_LIMIT 1.01f

/* (x, z) stretched by one factor along the stiff axis and by another across it. */
static void stretch(float axis_rad, float along, float across, float *x, float *z)
{
    const brace_vec_t axis = brace_direction(brace_turn(axis_rad));
    const float stiff = along * (axis.x * *x + axis.z * *z);
    const float soft = across * (axis.x * *z - axis.z * *x);
    *x = axis.x * stiff - axis.z * soft;
    *z = axis.z * stiff + axis.x * soft;
}

brace_status_t brace_contact_sag(const brace_stiffness_t *stiffness, brace_force_t load,
                                 brace_displacement_t *sag)
{
    if (sag == NULL) {
        return BRACE_E_NULL;
    }
    brace_status_t status = brace_check_stiffness(stiffness);
    if (status == BRACE_OK) {
        status = brace_check_two(load.x_n, load.z_n, FORCE_LIMIT_N);
    }
    if (status == BRACE_OK) {
        *sag = (brace_displacement_t){load.x_n, load.z_n};
        stretch(stiffness->stiff_axis_rad, 1.0f / stiffness->lambda_max_n_per_mm,
                1.0f / stiffness->lambda_min_n_per_mm, &sag->x_mm, &sag->z_mm);
    }
    return status;
}

brace_status_t brace_contact_force(const brace_stiffness_t *stiffness, brace_displacement_t displacement,
                                   brace_contact_force_t *contact)
{
    if (contact == NULL) {
        return BRACE_E_NULL;
    }
    brace_status_t status = brace_check_stiffness(stiffness);
    if (status == BRACE_OK) {
        status = brace_check_two(displacement.x_mm, displacement.z_mm, DISPLACEMENT_LIMIT_MM);
    }
    if (status == BRACE_OK) {
        brace_force_t force = {displacement.x_mm, displacement.z_mm};
        const float size_mm = brace_length(displacement.x_mm, displacement.z_mm);
        stretch(stiffness->stiff_axis_rad, stiffness->lambda_max_n_per_mm, stiffness->lambda_min_n_per_mm,
                &force.x_n, &force.z_n);
        contact->force = force;
        contact->magnitude_n = brace_length(force.x_n, force.z_n);
        contact->low_n = stiffness->lambda_min_n_per_mm * size_mm;
        contact->high_n = stiffness->lambda_max_n_per_mm * size_mm;
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
    if (status == BRACE_OK) {
        status = brace_check_two(normal_x, normal_z, NORMAL_LIMIT);
    }
    if (status == BRACE_OK) {
        status = brace_check_magnitude(friction_ratio, FRICTION_LIMIT);
    }
    const float length = brace_length(normal_x, normal_z);
    if (status == BRACE_OK &&
        (length < 2.0f - NORMAL_LIMIT || length > NORMAL_LIMIT || friction_ratio < 0.0f)) {
        status = BRACE_E_RANGE;
    }
    if (status != BRACE_OK) {
        return status;
    }
    const float pressing_n = (force.x_n * normal_x + force.z_n * normal_z) / length;
    const float along_n = (force.z_n * normal_x - force.x_n * normal_z) / length;
    const float sliding_n = __builtin_fabsf(along_n);
    const float margin_n = friction_ratio * pressing_n - sliding_n;
    const bool any = brace_length(pressing_n, sliding_n) > 0.0f;
    grip->normal_n = pressing_n;
    grip->tangent_n = sliding_n;
    grip->margin_n = margin_n;
    grip->angle_left_rad =
        any ? brace_atan2(friction_ratio, 1.0f) - brace_atan2(sliding_n, pressing_n) : 0.0f;
    grip->state = !(pressing_n > 0.0f) ? BRACE_CONTACT_LIFTS
                  : margin_n < 0.0f    ? BRACE_CONTACT_SLIDES
                                       : BRACE_CONTACT_HOLDS;
    return BRACE_OK;
}
