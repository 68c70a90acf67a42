#include <stddef.h>

#include "brace/planar.h"
#include "chain/chain_list.h"
#include "base/off_tick.h"
#include "planar/planar_constants.h"

BRACE_OFF_TICK brace_status_t brace_planar_collapse(const brace_limb_t *limb, brace_planar_t *planar)
{
    if (limb == NULL || planar == NULL) {
        return BRACE_E_NULL;
    }
    const float base = limb->base.x_mm_per_n;
    if (base != limb->base.z_mm_per_n) {
        return BRACE_E_UNSUPPORTED;
    }
    brace_harmonics_t h;
    brace_swing_t element[BRACE_CHAIN_FIRM];
    h.iso_mm_per_n = brace_chain_at_rest(limb, element) + base;
    brace_harmonics_sum(element, element + BRACE_CHAIN_FIRM, &h);
    return brace_planar_constants(&h, planar);
}
