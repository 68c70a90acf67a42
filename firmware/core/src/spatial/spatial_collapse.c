#include <float.h>
#include <math.h>
#include <stddef.h>

#include "base/trig.h"
#include "base/vec.h"
#include "brace/spatial.h"
#include "chain/elements.h"

static brace_aside_t aside_of(const brace_link_t *link, float length_mm)
{
    const float length = length_mm + FLT_MIN; /* a coxa of no length passes no moment on */
    const float per_mm = 3.0f * link->moment_transfer * link->lateral_mm_per_n / length;
    return (brace_aside_t){per_mm, per_mm / length, link->torsion_rad_per_n_mm};
}

/* Splits a a' + b b' into the compliance that is equal in every direction, which it returns, and one vector along the
 * longer axis. */
static float merged(brace_vec_t a, brace_vec_t b, brace_vec_t *longer)
{
    const float cross = vec_cross(a, b);
    const float mean = 0.5f * (vec_dot(a, a) + vec_dot(b, b));
    const float dev_x = 0.5f * ((a.x - a.z) * (a.x + a.z) + (b.x - b.z) * (b.x + b.z));
    const float dev_z = a.x * a.z + b.x * b.z;
    const float radius = vec_length((brace_vec_t){dev_x, dev_z});
    *longer = vec_scaled(brace_direction(0.5f * brace_atan2(dev_z, dev_x)), sqrtf(2.0f * radius));
    return cross * cross / (mean + radius + FLT_MIN);
}

brace_status_t brace_spatial_collapse(const brace_limb_t *limb, brace_spatial_t *spatial)
{
    const brace_status_t status = spatial == NULL ? BRACE_E_NULL : brace_limb_check(limb);
    if (status != BRACE_OK) {
        return status;
    }
    const brace_link_t *link = limb->link;
    brace_general_collapse(limb, &spatial->plane);
    brace_coxa_elements_t coxa;
    spatial->plane.iso_mm_per_n += brace_elements_of_coxa(limb, &coxa);
    spatial->plane.iso_mm_per_n += merged(spatial->plane.base, coxa.ellipsoid, &spatial->plane.base);
    spatial->coxa_moment = coxa.moment;
    spatial->coxa_moment_per_lever_mm = coxa.moment_per_lever_mm;

    spatial->coxa_mm = limb->coxa_mm;
    spatial->across_mm_per_n =
        link[BRACE_COXA].lateral_mm_per_n + link[BRACE_FEMUR].lateral_mm_per_n + link[BRACE_TIBIA].lateral_mm_per_n;
    spatial->coxa_aside = aside_of(&link[BRACE_COXA], limb->coxa_mm);
    spatial->femur_aside = aside_of(&link[BRACE_FEMUR], limb->femur_mm);
    brace_spatial_set_springs(spatial, limb->joint[BRACE_COXA].compliance_rad_per_n_mm, brace_hip_rad_per_n_mm(limb),
                              brace_knee_rad_per_n_mm(limb));
    return BRACE_OK;
}
