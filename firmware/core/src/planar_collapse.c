#include <stddef.h>

#include "brace/planar.h"
#include "chain_list.h"
#include "planar_constants.h"

brace_status_t brace_planar_collapse(const brace_limb_t *limb, brace_planar_t *planar)
{
    if (limb == NULL || planar == NULL) {
        return BRACE_E_NULL;
    }
    if (limb->base.x_mm_per_n != limb->base.z_mm_per_n) {
        return BRACE_E_UNSUPPORTED;
    }
    brace_harmonics_t h;
    brace_element_t element[BRACE_CHAIN_FIRM];
    h.iso_mm_per_n = limb->base.x_mm_per_n;
    brace_harmonics_list(brace_chain_firm(limb, element) + h.iso_mm_per_n, element, BRACE_CHAIN_FIRM, &h);
    return brace_planar_constants(&h, planar);
}
