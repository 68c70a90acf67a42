#include "brace/chain.h"

#include <stdbool.h>

#include "chain_list.h"
#include "turn.h"
#include "vec.h"

static const brace_vec_t NONE = {0.0f, 0.0f};

/* Along an ellipsoid's first axis, in its link's frame. |tilt| < 2 rad. */
static brace_vec_t direction(float tilt_rad)
{
    const brace_sincos_t at = brace_turn_sincos(brace_turn_from_q28((int32_t)(tilt_rad * 0x1p28f)));
    return (brace_vec_t){(float)at.cos * (1.0f / BRACE_TURN_ONE), (float)at.sin * (1.0f / BRACE_TURN_ONE)};
}

/* Splits an ellipsoid into what it shares in every direction, returned, and its longer axis, written. */
static float split_ellipsoid(float along, float across, brace_vec_t axis, brace_vec_t *excess)
{
    const float shared = across > along ? along : across;
    *excess = across > along ? vec_scaled(vec_quarter(axis), __builtin_sqrtf(across - shared))
                             : vec_scaled(axis, __builtin_sqrtf(along - shared));
    return shared;
}

typedef struct {
    brace_element_t *element;
    uint32_t count;
    float iso;
} list_t;

static void append(list_t *list, brace_vec_t femur, brace_vec_t tibia, brace_vec_t base)
{
    if (vec_dot(femur, femur) + vec_dot(tibia, tibia) + vec_dot(base, base) > 0.0f) {
        list->element[list->count++] = (brace_element_t){femur, tibia, base};
    }
}

/* A link's ellipsoid, and the link's moment transfer per unit of knee lever: what a tip force with unit
 * lever about the link's far end bends. Of b = bending, 0.75 kappa b acts together with the moment. */
typedef struct {
    brace_vec_t excess;         /* sqrt(mm/N), link's frame */
    brace_vec_t with_moment;    /* sqrt(mm/N), link's frame */
    float per_lever;            /* sqrt(mm/N)/mm */
} bent_link_t;

static bent_link_t bend(list_t *list, const brace_link_t *link, float length_mm, float moment_ratio)
{
    bent_link_t bent;
    const brace_vec_t axis = direction(link->tilt_rad);
    const float coupled = 0.75f * moment_ratio * link->bending_mm_per_n;
    const float amplitude = __builtin_sqrtf(coupled);
    list->iso += split_ellipsoid(link->axial_mm_per_n, link->bending_mm_per_n - coupled, axis, &bent.excess);
    bent.with_moment = vec_scaled(vec_quarter(axis), amplitude);
    bent.per_lever = coupled > 0.0f ? 2.0f * amplitude / length_mm : 0.0f;
    return bent;
}

float brace_chain_list(const brace_limb_t *limb, int with_coxa, brace_element_t *element, uint32_t *count)
{
    const float femur_mm = limb->femur_mm, tibia_mm = limb->tibia_mm;
    const brace_link_t *link = limb->link;
    list_t list = {element, 0, 0.0f};

    const bent_link_t femur = bend(&list, &link[BRACE_FEMUR], femur_mm, link[BRACE_FEMUR].moment_transfer_ratio);
    append(&list, femur.excess, NONE, NONE);
    append(&list, femur.with_moment, (brace_vec_t){0.0f, femur.per_lever * tibia_mm}, NONE);

    append(&list, NONE, bend(&list, &link[BRACE_TIBIA], tibia_mm, 0.0f).excess, NONE);

    const float turn = __builtin_sqrtf(limb->joint[BRACE_FEMUR].compliance_rad_per_n_mm +
                                       limb->base.rotation_rad_per_n_mm);
    append(&list, (brace_vec_t){0.0f, turn * femur_mm}, (brace_vec_t){0.0f, turn * tibia_mm}, NONE);

    const float knee = __builtin_sqrtf(limb->joint[BRACE_TIBIA].compliance_rad_per_n_mm);
    append(&list, NONE, (brace_vec_t){0.0f, knee * tibia_mm}, NONE);

    if (with_coxa) {
        const bent_link_t coxa =
            bend(&list, &link[BRACE_COXA], limb->coxa_mm, link[BRACE_COXA].moment_transfer_ratio);
        append(&list, NONE, NONE, coxa.excess);
        append(&list, (brace_vec_t){0.0f, coxa.per_lever * femur_mm},
               (brace_vec_t){0.0f, coxa.per_lever * tibia_mm}, coxa.with_moment);
    }
    brace_vec_t base_excess;
    list.iso += split_ellipsoid(limb->base.x_mm_per_n, limb->base.z_mm_per_n, (brace_vec_t){1.0f, 0.0f},
                                &base_excess);
    append(&list, NONE, NONE, base_excess);

    *count = list.count;
    return list.iso;
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
