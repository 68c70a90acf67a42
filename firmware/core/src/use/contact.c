#include "brace/contact.h"

#include <stddef.h>

#include "base/check.h"
#include "base/off_tick.h"
#include "base/trig.h"

#define NORMAL_TOLERANCE 0.01f

BRACE_OFF_TICK
brace_status_t brace_contact_sag(const brace_stiffness_t *stiffness, brace_force_t load,
                                 brace_displacement_t *sag)
{
    const brace_status_t status = brace_check_stiffness(stiffness, sag, &load.x_n, BRACE_INPUT_FORCE);
    if (status == BRACE_OK) {
        const float det = stiffness->lambda_min_n_per_mm * stiffness->lambda_max_n_per_mm;
        sag->x_mm = (stiffness->k_zz_n_per_mm * load.x_n - stiffness->k_xz_n_per_mm * load.z_n) / det;
        sag->z_mm = (stiffness->k_xx_n_per_mm * load.z_n - stiffness->k_xz_n_per_mm * load.x_n) / det;
    }
    return status;
}

BRACE_OFF_TICK
brace_status_t brace_contact_force(const brace_stiffness_t *stiffness, brace_displacement_t displacement,
                                   brace_contact_force_t *contact)
{
    const brace_status_t status = brace_check_stiffness(stiffness, contact, &displacement.x_mm, BRACE_INPUT_DISPLACEMENT);
    if (status == BRACE_OK) {
        const float x = displacement.x_mm, z = displacement.z_mm, size_mm = brace_length(x, z);
        const float force_x = stiffness->k_xx_n_per_mm * x + stiffness->k_xz_n_per_mm * z;
        const float force_z = stiffness->k_xz_n_per_mm * x + stiffness->k_zz_n_per_mm * z;
        const float low_n = stiffness->lambda_min_n_per_mm * size_mm;
        const float high_n = stiffness->lambda_max_n_per_mm * size_mm;
        float magnitude_n = brace_length(force_x, force_z);
        magnitude_n = magnitude_n > low_n ? magnitude_n : low_n;
        magnitude_n = magnitude_n < high_n ? magnitude_n : high_n;
        *contact = (brace_contact_force_t){{force_x, force_z}, magnitude_n, low_n, high_n};
    }
    return status;
}

BRACE_OFF_TICK
brace_status_t brace_contact_grip(brace_force_t force, float normal_x, float normal_z, float friction_ratio,
                                  brace_contact_grip_t *grip)
{
    const struct {
        float force_x, force_z, normal_x, normal_z, friction_ratio;
    } at = {force.x_n, force.z_n, normal_x, normal_z, friction_ratio};
    const brace_status_t status = brace_check(grip, &at.force_x, BRACE_INPUT_GRIP);
    if (status != BRACE_OK) {
        return status;
    }
    const float length = brace_length(at.normal_x, at.normal_z);
    if (brace_magnitude_bits(length - 1.0f) > brace_magnitude_bits(NORMAL_TOLERANCE) ||
        brace_is_negative(at.friction_ratio)) {
        return BRACE_E_RANGE;
    }
    const float pressing_n = (at.force_x * at.normal_x + at.force_z * at.normal_z) / length;
    const float sliding_n = __builtin_fabsf(at.force_z * at.normal_x - at.force_x * at.normal_z) / length;
    const float excess_n = sliding_n - at.friction_ratio * pressing_n;
    grip->normal_n = pressing_n;
    grip->tangent_n = sliding_n;
    grip->margin_n = -excess_n;
    grip->state = brace_bits(pressing_n) <= 0 ? BRACE_CONTACT_LIFTS
                  : brace_bits(excess_n) <= 0 ? BRACE_CONTACT_HOLDS
                                              : BRACE_CONTACT_SLIDES;
    /* from the cone's edge (1, mu) to the force (pressing, sliding): their cross product over their dot */
    grip->angle_left_rad = -brace_atan2(excess_n, pressing_n + at.friction_ratio * sliding_n);
    return BRACE_OK;
}
