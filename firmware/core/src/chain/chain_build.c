#include "brace/chain.h"

#include <stdbool.h>

#include "chain/chain_list.h"
#include "base/off_tick.h"
#include "base/vec.h"

/* Only what yields is in the list. */
BRACE_OFF_TICK static void append(brace_chain_t *chain, brace_vec_t femur, brace_vec_t tibia, brace_vec_t base)
{
    if (vec_dot(femur, femur) + vec_dot(tibia, tibia) + vec_dot(base, base) > 0.0f) {
        chain->element[chain->count++] = (brace_element_t){femur, tibia, base};
    }
}

BRACE_OFF_TICK static brace_status_t build(const brace_limb_t *limb, bool with_coxa, brace_chain_t *chain)
{
    static const brace_vec_t none = {0.0f, 0.0f};
    const brace_status_t status = chain == NULL ? BRACE_E_NULL : brace_limb_check(limb);
    if (status != BRACE_OK) {
        return status;
    }
    brace_swing_t swing[BRACE_CHAIN_FIRM];
    chain->iso_mm_per_n = brace_chain_at_rest(limb, swing);
    chain->count = 0;
    for (int i = 0; i < BRACE_CHAIN_FIRM; i++) {
        const brace_swing_t whole = brace_whole(&swing[i]);
        append(chain, whole.femur, whole.tibia, none);
    }
    if (with_coxa) {
        brace_coxa_t coxa;
        chain->iso_mm_per_n += brace_chain_coxa(limb, &coxa);
        append(chain, none, none, coxa.excess);
        append(chain, (brace_vec_t){0.0f, coxa.bent_per_mm * limb->femur_mm},
               (brace_vec_t){0.0f, coxa.bent_per_mm * limb->tibia_mm}, coxa.bent);
    }
    brace_vec_t base;
    chain->iso_mm_per_n += brace_chain_base(limb, &base);
    append(chain, none, none, base);
    return BRACE_OK;
}

BRACE_OFF_TICK brace_status_t brace_chain_build(const brace_limb_t *limb, brace_chain_t *chain)
{
    return build(limb, false, chain);
}

BRACE_OFF_TICK brace_status_t brace_chain_build_with_coxa(const brace_limb_t *limb, brace_chain_t *chain)
{
    return build(limb, true, chain);
}
