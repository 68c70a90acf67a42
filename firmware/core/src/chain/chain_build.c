#include "brace/chain.h"

#include <stdbool.h>

#include "chain/chain_list.h"
#include "base/off_tick.h"
#include "base/vec.h"

/* Only what yields is in the list. */
static void append(brace_chain_t *chain, const brace_element_t *element)
{
    if (vec_dot(element->femur, element->femur) + vec_dot(element->tibia, element->tibia) +
            vec_dot(element->base, element->base) > 0.0f) {
        chain->element[chain->count++] = *element;
    }
}

BRACE_OFF_TICK static brace_status_t build(const brace_limb_t *limb, bool with_coxa, brace_chain_t *chain)
{
    const brace_status_t status = chain == NULL ? BRACE_E_NULL : brace_limb_check(limb);
    if (status != BRACE_OK) {
        return status;
    }
    brace_swing_t swing[BRACE_CHAIN_FIRM];
    chain->iso_mm_per_n = brace_chain_at_rest(limb, swing);
    chain->count = 0;
    for (int i = 0; i < BRACE_CHAIN_FIRM; i++) {
        append(chain, &(brace_element_t){.femur = swing[i].femur, .tibia = swing[i].tibia});
    }
    if (with_coxa) {
        brace_coxa_t coxa;
        chain->iso_mm_per_n += brace_chain_coxa(limb, &coxa);
        append(chain, &(brace_element_t){.base = coxa.excess});
        append(chain, &(brace_element_t){.femur = {0.0f, coxa.bent_per_mm * limb->femur_mm},
                                         .tibia = {0.0f, coxa.bent_per_mm * limb->tibia_mm}, .base = coxa.bent});
    }
    brace_element_t base = {0};
    chain->iso_mm_per_n += brace_chain_base(limb, &base.base);
    append(chain, &base);
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
