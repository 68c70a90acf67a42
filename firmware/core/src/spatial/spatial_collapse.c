#include "brace/spatial.h"

#include <float.h>
#include <stddef.h>

#include "chain/chain_list.h"
#include "base/off_tick.h"

BRACE_OFF_TICK static void collapse_aside(const brace_link_t *link, float length_mm, brace_aside_t *aside)
{
    const float length = length_mm + FLT_MIN; /* a coxa of no length passes nothing on */
    aside->per_mm = 3.0f * link->moment_transfer_ratio * link->lateral_mm_per_n / length;
    aside->per_mm2 = aside->per_mm / length;
    aside->torsion = link->torsion_rad_per_n_mm;
}

static void collapse_across(const brace_limb_t *limb, brace_spatial_t *spatial)
{
    const brace_link_t *link = limb->link;
    spatial->coxa_mm = limb->coxa_mm;
    spatial->femur_mm = limb->femur_mm;
    spatial->tibia_mm = limb->tibia_mm;
    spatial->yaw_rad_per_n_mm = limb->joint[BRACE_COXA].compliance_rad_per_n_mm;
    spatial->across_mm_per_n = link[BRACE_COXA].lateral_mm_per_n + link[BRACE_FEMUR].lateral_mm_per_n +
                               link[BRACE_TIBIA].lateral_mm_per_n;
    collapse_aside(&link[BRACE_COXA], limb->coxa_mm, &spatial->aside[0]);
    collapse_aside(&link[BRACE_FEMUR], limb->femur_mm, &spatial->aside[1]);
}

BRACE_OFF_TICK brace_status_t brace_spatial_collapse(const brace_limb_t *limb, brace_spatial_t *spatial)
{
    const brace_status_t status = spatial == NULL ? BRACE_E_NULL : brace_limb_check(limb);
    if (status != BRACE_OK) {
        return status;
    }
    collapse_across(limb, spatial);
    brace_swing_t element[BRACE_CHAIN_FIRM];
    float iso = FLT_MIN; /* never quite nothing: brace_tensor_plus divides by the trace */
    iso += brace_chain_coxa(limb, &spatial->coxa);
    iso += brace_chain_base(limb, &spatial->base);
    iso += brace_chain_at_rest(limb, element);
    brace_harmonics_sum(element, &spatial->plane);
    spatial->plane.iso_mm_per_n = iso;
    return BRACE_OK;
}
