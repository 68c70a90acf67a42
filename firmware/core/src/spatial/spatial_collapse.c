#include "brace/spatial.h"

#include <float.h>
#include <stddef.h>

#include "chain/chain_list.h"
#include "base/off_tick.h"
#include "base/trig.h"
#include "base/vec.h"

static void collapse_across(const brace_limb_t *limb, brace_spatial_t *spatial)
{
    const brace_link_t *coxa = &limb->link[BRACE_COXA], *femur = &limb->link[BRACE_FEMUR];
    const float coxa_transfer =
        limb->coxa_mm > 0.0f ? 3.0f * coxa->moment_transfer_ratio / limb->coxa_mm : 0.0f;
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

/* Coxa and base: what stands still in the plane. Returns what of it yields equally in every direction. */
static float collapse_still(const brace_limb_t *limb, brace_spatial_t *spatial)
{
    brace_element_t coxa[2];
    const float iso = brace_chain_coxa(limb, coxa) + brace_chain_base(limb, &spatial->still[1]);
    spatial->coxa_per_mm = coxa[1].femur.z / limb->femur_mm;
    spatial->coxa = coxa[1].base;
    spatial->still[0] = coxa[0].base;
    return iso;
}

BRACE_OFF_TICK brace_status_t brace_spatial_collapse(const brace_limb_t *limb, brace_spatial_t *spatial)
{
    const brace_status_t status = spatial == NULL ? BRACE_E_NULL : brace_limb_check(limb);
    if (status != BRACE_OK) {
        return status;
    }
    collapse_across(limb, spatial);
    float iso = collapse_still(limb, spatial) + FLT_MIN; /* never quite nothing: brace_tensor_plus divides by the trace */
    brace_swing_t element[BRACE_CHAIN_FIRM];
    iso += brace_chain_at_rest(limb, element);
    brace_harmonics_sum(element, element + BRACE_CHAIN_FIRM, &spatial->plane);
    brace_harmonics_plus(&spatial->plane, iso);
    return BRACE_OK;
}
