/* C of a collapsed limb at a posture: shared by the general path and by K in space. */
#ifndef BRACE_CORE_GENERAL_H
#define BRACE_CORE_GENERAL_H

#include "brace/general.h"
#include "chain/tensor.h"

/* From the hip to the tip, seen from the bisector [mm]. */
static inline brace_vec_t brace_general_tip_seen(const brace_general_t *general, brace_vec_t half)
{
    return (brace_vec_t){(general->femur_mm + general->tibia_mm) * half.x,
                         (general->femur_mm - general->tibia_mm) * half.z};
}

/* C seen from the bisector. tip_mm: from brace_general_tip_seen; hip_root, knee_root: roots of the springs'
 * compliances. */
static inline brace_tensor_t brace_general_sum(const brace_general_t *general, const brace_posture_t *at,
                                               brace_vec_t tip_mm, float hip_root, float knee_root)
{
    const brace_element_t *element = general->element;
    const brace_vec_t tibia = {at->half.x, -at->half.z}; /* it points half the knee angle behind the bisector */
    brace_tensor_t c = brace_tensor_of(general->iso_mm_per_n, vec_turned_back(general->base, at->bisector));
    brace_tensor_add(&c, brace_element_at(&element[BRACE_FEMUR_ELLIPSOID], at->half));
    brace_tensor_add(&c, brace_element_at(&element[BRACE_FEMUR_MOMENT], at->half));
    brace_tensor_add(&c, brace_element_at(&element[BRACE_TIBIA_ELLIPSOID], at->half));
    brace_tensor_add(&c, vec_scaled(vec_quarter(tip_mm), hip_root));
    brace_tensor_add(&c, vec_scaled(vec_quarter(tibia), general->tibia_mm * knee_root));
    return c;
}

#endif
