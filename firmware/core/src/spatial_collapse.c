#include "brace/spatial.h"

#include <stddef.h>

#include "chain_list.h"
#include "trig.h"
#include "vec.h"

/* a a' + b b' = equal I + v v': equal in every direction, and one direction more. */
static float merged(brace_vec_t a, brace_vec_t b, brace_vec_t *v)
{
    const float dev_x = 0.5f * (a.x * a.x - a.z * a.z + b.x * b.x - b.z * b.z);
    const float dev_y = a.x * a.z + b.x * b.z;
    const float mean = 0.5f * (vec_dot(a, a) + vec_dot(b, b));
    const float radius = brace_length(dev_x, dev_y);
    const float cross = vec_cross(a, b);
    /* long axis of the deviator: of its two forms, the one in which nothing cancels */
    const brace_vec_t axis = dev_x > 0.0f ? (brace_vec_t){radius + dev_x, dev_y} : (brace_vec_t){dev_y, radius - dev_x};
    const float length = brace_length(axis.x, axis.z);
    *v = vec_scaled(axis, length > 0.0f ? brace_sqrt(2.0f * radius) / length : 0.0f);
    return mean > 0.0f ? cross * cross / (mean + radius) : 0.0f;
}

static void collapse_across(const brace_limb_t *limb, brace_spatial_t *spatial)
{
    const brace_link_t *coxa = &limb->link[BRACE_COXA], *femur = &limb->link[BRACE_FEMUR];
    const float coxa_transfer = limb->coxa_mm > 0.0f ? 3.0f * coxa->moment_transfer_ratio / limb->coxa_mm : 0.0f;
    const float femur_transfer = 3.0f * femur->moment_transfer_ratio / limb->femur_mm;
    spatial->coxa_mm = limb->coxa_mm;
    spatial->femur_mm = limb->femur_mm;
    spatial->tibia_mm = limb->tibia_mm;
    spatial->yaw_rad_per_n_mm = limb->joint[BRACE_COXA].compliance_rad_per_n_mm;
    spatial->across_mm_per_n =
        coxa->lateral_mm_per_n + femur->lateral_mm_per_n + limb->link[BRACE_TIBIA].lateral_mm_per_n;
    spatial->across_per_reach[0] = coxa_transfer * coxa->lateral_mm_per_n;
    spatial->across_per_reach[1] = coxa_transfer > 0.0f ? spatial->across_per_reach[0] / limb->coxa_mm : 0.0f;
    spatial->across_per_height2 = coxa->torsion_rad_per_n_mm;
    spatial->across_per_along[0] = femur_transfer * femur->lateral_mm_per_n;
    spatial->across_per_along[1] = spatial->across_per_along[0] / limb->femur_mm;
    spatial->across_per_aside2 = femur->torsion_rad_per_n_mm;
}

/* Sorts the list's elements: those that move with the knee stay, in front; the rest goes to still and coxa. Returns
 * what of the rest yields equally in every direction. */
static float part_still(brace_element_t *element, uint32_t *count, float femur_mm, brace_spatial_t *spatial)
{
    brace_vec_t still[2] = {{0.0f, 0.0f}, {0.0f, 0.0f}};
    uint32_t moving = 0, stills = 0;
    spatial->coxa = (brace_vec_t){0.0f, 0.0f};
    spatial->coxa_per_mm = 0.0f;
    for (uint32_t i = 0; i < *count; i++) {
        const brace_element_t e = element[i];
        if (!(vec_dot(e.base, e.base) > 0.0f)) {
            element[moving++] = e;
        } else if (e.femur.z > 0.0f) {
            spatial->coxa = e.base;
            spatial->coxa_per_mm = e.femur.z / femur_mm;
        } else {
            still[stills++ & 1u] = e.base;
        }
    }
    *count = moving;
    return merged(still[0], still[1], &spatial->still);
}

brace_status_t brace_spatial_collapse(const brace_limb_t *limb, brace_spatial_t *spatial)
{
    brace_status_t status = spatial == NULL ? BRACE_E_NULL : brace_limb_check(limb);
    if (status != BRACE_OK) {
        return status;
    }
    brace_spatial_t collapsed = {0};
    brace_element_t element[BRACE_CHAIN_MAX];
    uint32_t count;
    float iso = brace_chain_list(limb, 1, element, &count);
    iso += part_still(element, &count, limb->femur_mm, &collapsed);
    status = brace_harmonics_list(iso, element, count, &collapsed.plane);
    collapse_across(limb, &collapsed);
    if (status == BRACE_OK && !(collapsed.across_mm_per_n > 0.0f && count + (iso > 0.0f) > 0u)) {
        status = BRACE_E_SINGULAR;
    }
    if (status == BRACE_OK) {
        *spatial = collapsed;
    }
    return status;
}
