#include <stddef.h>

#include "brace/chain.h"
#include "base/off_tick.h"
#include "chain/tensor.h"

/* C at a posture; result is whoever asks's output, not null. */
BRACE_OFF_TICK static brace_status_t tensor_at(const brace_chain_t *chain, float theta1_rad, float theta2_rad,
                                               const void *result, brace_tensor_t *c)
{
    if (chain == NULL || result == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = brace_check_reach(theta1_rad, theta2_rad);
    if (status != BRACE_OK) {
        return status;
    }
    brace_posture_t at;
    brace_posture(theta1_rad, theta2_rad, &at);
    brace_tensor_t sum = brace_tensor_iso(chain->iso_mm_per_n);
    for (const brace_element_t *e = chain->element; e < chain->element + chain->count; e++) {
        const brace_vec_t v = brace_bent_at(brace_bent(e), at.half), still = brace_seen_from(e->base, at.bisector);
        sum = brace_tensor_plus(sum, (brace_vec_t){v.x + still.x, v.z + still.z});
    }
    *c = brace_tensor_to_world(sum, at.bisector);
    return BRACE_OK;
}

BRACE_OFF_TICK brace_status_t brace_chain_compliance(const brace_chain_t *chain, float theta1_rad, float theta2_rad,
                                                     brace_compliance_t *compliance, float *det)
{
    brace_tensor_t c;
    const brace_status_t status = tensor_at(chain, theta1_rad, theta2_rad, compliance, &c);
    if (status == BRACE_OK) {
        *compliance = (brace_compliance_t){c.xx, c.xz, c.zz};
        if (det != NULL) {
            *det = c.det;
        }
    }
    return status;
}

BRACE_OFF_TICK brace_status_t brace_chain_stiffness(const brace_chain_t *chain, float theta1_rad, float theta2_rad,
                                                    brace_stiffness_t *stiffness)
{
    brace_tensor_t c;
    const brace_status_t status = tensor_at(chain, theta1_rad, theta2_rad, stiffness, &c);
    return status == BRACE_OK ? brace_tensor_inverse(c, stiffness) : status;
}
