#include "brace/chain.h"

#include <stdbool.h>

#include "chain_list.h"
#include "turn.h"
#include "vec.h"

/* Splits a link's ellipsoid, less the 0.75 kappa of its bending that comes with moment transfer, into iso,
 * returned, and its longer axis; both vectors sqrt(mm/N), in the link's frame. */
static float bend(const brace_link_t *link, float kappa, brace_vec_t *excess, brace_vec_t *with_moment)
{
    const brace_sincos_t at = brace_turn_sincos(brace_turn_from_q28((int32_t)(link->tilt_rad * 0x1p28f)));
    const brace_vec_t axis = {(float)at.cos * (1.0f / BRACE_TURN_ONE), (float)at.sin * (1.0f / BRACE_TURN_ONE)};
    const brace_vec_t across = vec_quarter(axis);
    const float coupled = 0.75f * kappa * link->bending_mm_per_n;
    const float bending = link->bending_mm_per_n - coupled;
    const float more = bending - link->axial_mm_per_n;
    *with_moment = vec_scaled(across, __builtin_sqrtf(coupled));
    *excess = vec_scaled(more > 0.0f ? across : axis, __builtin_sqrtf(__builtin_fabsf(more)));
    return more > 0.0f ? link->axial_mm_per_n : bending;
}

/* sqrt(mm/N) per mm of lever about a link's far end, of the bending that comes with moment transfer. */
static float per_lever(const brace_link_t *link, float kappa, float length_mm)
{
    const float coupled = 0.75f * kappa * link->bending_mm_per_n;
    return coupled > 0.0f ? 2.0f * __builtin_sqrtf(coupled) / length_mm : 0.0f;
}

float brace_chain_firm(const brace_limb_t *limb, brace_element_t element[BRACE_CHAIN_FIRM])
{
    const brace_vec_t none = {0.0f, 0.0f};
    const brace_link_t *femur = &limb->link[BRACE_FEMUR];
    const float kappa = femur->moment_transfer_ratio, tibia_mm = limb->tibia_mm;
    brace_vec_t excess, with_moment;

    float iso = bend(femur, kappa, &excess, &with_moment);
    element[0] = (brace_element_t){excess, none, none};
    element[1] =
        (brace_element_t){with_moment, {0.0f, per_lever(femur, kappa, limb->femur_mm) * tibia_mm}, none};

    iso += bend(&limb->link[BRACE_TIBIA], 0.0f, &excess, &with_moment);
    element[2] = (brace_element_t){none, excess, none};

    const float hip = __builtin_sqrtf(limb->joint[BRACE_FEMUR].compliance_rad_per_n_mm +
                                      limb->base.rotation_rad_per_n_mm);
    const float knee = __builtin_sqrtf(limb->joint[BRACE_TIBIA].compliance_rad_per_n_mm);
    element[3] = (brace_element_t){{0.0f, hip * limb->femur_mm}, {0.0f, hip * tibia_mm}, none};
    element[4] = (brace_element_t){none, {0.0f, knee * tibia_mm}, none};
    return iso;
}

float brace_chain_coxa(const brace_limb_t *limb, brace_element_t element[2])
{
    const brace_link_t *link = &limb->link[BRACE_COXA];
    const float kappa = link->moment_transfer_ratio;
    const float lever = per_lever(link, kappa, limb->coxa_mm);
    element[0] = element[1] = (brace_element_t){0};
    element[1].femur.z = lever * limb->femur_mm;
    element[1].tibia.z = lever * limb->tibia_mm;
    return bend(link, kappa, &element[0].base, &element[1].base);
}

float brace_chain_base(const brace_limb_t *limb, brace_element_t *element)
{
    const float x = limb->base.x_mm_per_n, z = limb->base.z_mm_per_n;
    *element = (brace_element_t){0};
    element->base.x = x > z ? __builtin_sqrtf(x - z) : 0.0f;
    element->base.z = z > x ? __builtin_sqrtf(z - x) : 0.0f;
    return x > z ? z : x;
}

static bool yields(const brace_element_t *element)
{
    return vec_dot(element->femur, element->femur) + vec_dot(element->tibia, element->tibia) +
               vec_dot(element->base, element->base) > 0.0f;
}

float brace_chain_list(const brace_limb_t *limb, int with_coxa, brace_element_t *element, uint32_t *count)
{
    uint32_t used = BRACE_CHAIN_FIRM, kept = 0;
    float iso = brace_chain_firm(limb, element);
    if (with_coxa) {
        iso += brace_chain_coxa(limb, &element[used]);
        used += 2;
    }
    iso += brace_chain_base(limb, &element[used++]);
    for (uint32_t i = 0; i < used; i++) {
        if (yields(&element[i])) {
            element[kept++] = element[i];
        }
    }
    *count = kept;
    return iso;
}

static brace_status_t build(const brace_limb_t *limb, int with_coxa, brace_chain_t *chain)
{
    const brace_status_t status = chain == NULL ? BRACE_E_NULL : brace_limb_check(limb);
    if (status == BRACE_OK) {
        chain->iso_mm_per_n = brace_chain_list(limb, with_coxa, chain->element, &chain->count);
    }
    return status;
}

brace_status_t brace_chain_build(const brace_limb_t *limb, brace_chain_t *chain)
{
    return build(limb, false, chain);
}

brace_status_t brace_chain_build_with_coxa(const brace_limb_t *limb, brace_chain_t *chain)
{
    return build(limb, true, chain);
}
