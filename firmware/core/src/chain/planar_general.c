#include <stddef.h>

#include "brace/chain.h"
#include "base/off_tick.h"
#include "chain/tensor.h"

/* An element at a posture, seen from the bisector. What is left of it at the straight and at the folded knee comes first:
 * what vanishes there does so before anything is added. */
static inline brace_vec_t element_at(const brace_element_t *element, const brace_posture_t *at)
{
    const brace_vec_t f = element->femur, t = element->tibia, still = brace_seen_from(element->base, at->bisector);
    const brace_vec_t straight = {f.x + t.x, f.z + t.z}, folded = {t.z - f.z, f.x - t.x};
    return (brace_vec_t){__builtin_fmaf(straight.x, at->half.x, folded.x * at->half.z) + still.x,
                         __builtin_fmaf(straight.z, at->half.x, folded.z * at->half.z) + still.z};
}

/* C seen from the bisector at a posture; result is whoever asks's output, not null. */
BRACE_OFF_TICK
static brace_status_t tensor_at(const brace_chain_t *chain, float theta1_rad, float theta2_rad, const void *result,
                                brace_tensor_t *c, brace_posture_t *at)
{
    if (chain == NULL || result == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = brace_check_reach(theta1_rad, theta2_rad);
    if (status != BRACE_OK) {
        return status;
    }
    brace_posture(theta1_rad, theta2_rad, at);
    const float iso = chain->iso_mm_per_n;
    brace_tensor_t sum = {iso + FLT_MIN, 0.0f, iso + FLT_MIN, iso * iso};
    for (const brace_element_t *e = chain->element; e < chain->element + chain->count; e++) {
        sum = brace_tensor_plus(sum, element_at(e, at));
    }
    *c = sum;
    return BRACE_OK;
}

BRACE_OFF_TICK
brace_status_t brace_chain_compliance(const brace_chain_t *chain, float theta1_rad, float theta2_rad,
                                      brace_compliance_t *compliance, float *det)
{
    brace_tensor_t c;
    brace_posture_t at;
    const brace_status_t status = tensor_at(chain, theta1_rad, theta2_rad, compliance, &c, &at);
    if (status == BRACE_OK) {
        const brace_circle_t circle = brace_circle_in_world(c, brace_doubled(at.bisector));
        *compliance = (brace_compliance_t){circle.mean + circle.dev.x, circle.dev.z, circle.mean - circle.dev.x};
        if (det != NULL) {
            *det = c.det;
        }
    }
    return status;
}

BRACE_OFF_TICK
brace_status_t brace_chain_stiffness(const brace_chain_t *chain, float theta1_rad, float theta2_rad,
                                     brace_stiffness_t *stiffness)
{
    brace_tensor_t c;
    brace_posture_t at;
    const brace_status_t status = tensor_at(chain, theta1_rad, theta2_rad, stiffness, &c, &at);
    return status == BRACE_OK ? brace_tensor_inverse(c, brace_doubled(at.bisector), stiffness) : status;
}
