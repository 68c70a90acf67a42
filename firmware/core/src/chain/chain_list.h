/* A limb's elements as bare lists, for those who have no room on their stack for a whole brace_chain_t. */
#ifndef BRACE_CHAIN_LIST_H
#define BRACE_CHAIN_LIST_H

#include "brace/chain.h"

/* Writes the five without base part, halved, zero where nothing yields, and returns their iso. limb has passed
 * brace_limb_check; the springs are the caller's. */
float brace_chain_firm(const brace_limb_t *limb, float hip_rad_per_n_mm, float knee_rad_per_n_mm,
                       brace_swing_t element[BRACE_CHAIN_FIRM]);

/* The same with the limb's own springs. */
static inline float brace_chain_at_rest(const brace_limb_t *limb, brace_swing_t element[BRACE_CHAIN_FIRM])
{
    return brace_chain_firm(limb, limb->joint[BRACE_FEMUR].compliance_rad_per_n_mm + limb->base.rotation_rad_per_n_mm,
                            limb->joint[BRACE_TIBIA].compliance_rad_per_n_mm, element);
}

/* What stands still: the coxa link, and where the base yields more in one direction. Each returns its iso. */
float brace_chain_coxa(const brace_limb_t *limb, brace_coxa_t *coxa);
float brace_chain_base(const brace_limb_t *limb, brace_vec_t *excess);

/* From femur and tibia parts to straight and folded ones, and back. */
static inline brace_swing_t brace_halved(brace_vec_t f, brace_vec_t t)
{
    return (brace_swing_t){.straight = {f.x + t.x, f.z + t.z}, .folded = {t.z - f.z, f.x - t.x}};
}

static inline brace_swing_t brace_whole(const brace_swing_t *halved)
{
    const brace_vec_t p = halved->straight, q = halved->folded;
    return (brace_swing_t){.femur = {0.5f * (p.x + q.z), 0.5f * (p.z - q.x)},
                           .tibia = {0.5f * (p.x - q.z), 0.5f * (p.z + q.x)}};
}

/* Harmonics of halved elements: iso is neither in nor written. */
void brace_harmonics_sum(const brace_swing_t element[BRACE_CHAIN_FIRM], brace_harmonics_t *harmonics);

#endif
