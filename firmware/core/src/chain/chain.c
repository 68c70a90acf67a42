#include "brace/chain.h"

#include <float.h>

#include "chain/chain_list.h"
#include "base/off_tick.h"
#include "base/trig.h"
#include "base/vec.h"

/* Root of the bending that goes with moment transfer: 0.75 kappa of it. */
static inline float moment_root(const brace_link_t *link)
{
    return __builtin_sqrtf(0.75f * link->moment_transfer_ratio * link->bending_mm_per_n);
}

/* Splits a link's ellipsoid, less that bending, into iso, which it returns [mm/N], and its longer axis; both vectors
 * sqrt(mm/N), in the link's frame. with_moment->x is the bending's root when called. */
BRACE_OFF_TICK static float bend(const brace_link_t *link, brace_vec_t *excess, brace_vec_t *with_moment)
{
    const float root = with_moment->x;
    const brace_vec_t along = brace_direction(brace_turn(link->tilt_rad)), across = vec_quarter(along);
    const float axial = link->axial_mm_per_n, bending = __builtin_fmaf(-root, root, link->bending_mm_per_n);
    const float more = bending - axial, length = __builtin_sqrtf(__builtin_fabsf(more));
    *with_moment = vec_scaled(across, root);
    *excess = vec_scaled(more > 0.0f ? across : along, length);
    return more > 0.0f ? axial : bending;
}

BRACE_OFF_TICK BRACE_LOOPS_STAY
float brace_chain_firm(const brace_limb_t *limb, float hip_rad_per_n_mm, float knee_rad_per_n_mm,
                       brace_swing_t element[BRACE_CHAIN_FIRM])
{
    const brace_link_t *femur = &limb->link[BRACE_FEMUR];
    const float femur_mm = limb->femur_mm, tibia_mm = limb->tibia_mm;
    const float hip = __builtin_sqrtf(hip_rad_per_n_mm), knee = __builtin_sqrtf(knee_rad_per_n_mm);
    const float root = moment_root(femur);
    const brace_swing_t *end = element + BRACE_CHAIN_FIRM;
    for (float *field = &element->femur.x; field < &end->femur.x; field++) { /* at most twenty */
        *field = 0.0f;
    }
    element[1].femur.x = root;
    element[1].tibia.z = 2.0f * root * tibia_mm / femur_mm;
    element[3].femur.z = hip * femur_mm;
    element[3].tibia.z = hip * tibia_mm;
    element[4].tibia.z = knee * tibia_mm;
    /* The tibia has nothing beyond it to pass a moment to: zero goes to the knee, which has no femur part. */
    const float iso = bend(femur, &element[0].femur, &element[1].femur) +
                      bend(femur + 1, &element[2].tibia, &element[4].femur);
    for (brace_swing_t *e = element; e < end; e++) { /* at most BRACE_CHAIN_FIRM */
        *e = brace_halved(e->femur, e->tibia);
    }
    return iso;
}

BRACE_OFF_TICK float brace_chain_coxa(const brace_limb_t *limb, brace_coxa_t *coxa)
{
    const brace_link_t *link = &limb->link[BRACE_COXA];
    coxa->bent.x = moment_root(link);
    coxa->bent_per_mm = 2.0f * coxa->bent.x / (limb->coxa_mm + FLT_MIN); /* a coxa of no length passes nothing on */
    return bend(link, &coxa->excess, &coxa->bent);
}

BRACE_OFF_TICK float brace_chain_base(const brace_limb_t *limb, brace_vec_t *excess)
{
    const float x = limb->base.x_mm_per_n, z = limb->base.z_mm_per_n, root = __builtin_sqrtf(__builtin_fabsf(x - z));
    *excess = x > z ? (brace_vec_t){root, 0.0f} : (brace_vec_t){0.0f, root};
    return x > z ? z : x;
}
