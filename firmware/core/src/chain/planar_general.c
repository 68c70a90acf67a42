#include <stddef.h>

#include "brace/chain.h"
#include "brace/planar.h"
#include "base/off_tick.h"
#include "base/trig.h"
#include "base/turn.h"
#include "base/vec.h"
#include "chain/tensor.h"

/* Off the tick, which takes brace/general.h: the same sum, element by element, for whoever has a list. */

/* An element seen from the femur. */
typedef struct {
    brace_vec_t femur, tibia, base;
} parts_t;

static inline parts_t seen_from_femur(const brace_element_t *element, brace_vec_t tibia, brace_vec_t base)
{
    return (parts_t){element->femur, brace_turned(element->tibia, tibia), brace_turned(element->base, base)};
}

/* v_a x v_b, part by part: what lies on one line in one part adds exactly nothing. */
static float cross_parts(const parts_t *a, const parts_t *b)
{
    const float own = vec_cross(a->femur, b->femur) + vec_cross(a->tibia, b->tibia);
    const float femur_tibia = vec_cross(a->femur, b->tibia) + vec_cross(a->tibia, b->femur);
    const float with_base = vec_cross((brace_vec_t){a->femur.x + a->tibia.x, a->femur.z + a->tibia.z}, b->base);
    return own + femur_tibia + with_base;
}

/* The same with an element that has a part on the base; few have. */
static float cross_base(const parts_t *a, const parts_t *b)
{
    return vec_cross(a->base, (brace_vec_t){b->femur.x + b->tibia.x + b->base.x, b->femur.z + b->tibia.z + b->base.z});
}

/* Sums over the chain in the femur's frame, then turned into the world's. */
static inline brace_tensor_t tensor(const brace_chain_t *chain, float theta1_rad, float theta2_rad)
{
    const uint32_t femur_turn = brace_turn(theta1_rad);
    const brace_vec_t tibia = brace_direction(0u - brace_turn(theta2_rad));
    const brace_vec_t base = brace_direction(0u - femur_turn);
    const brace_vec_t to_world = {__builtin_fmaf(-2.0f * base.z, base.z, 1.0f), -2.0f * base.z * base.x};
    float trace = 0.0f, squares = 0.0f;
    brace_vec_t dev = {0.0f, 0.0f};
    brace_vec_t turned_tibia[BRACE_CHAIN_MAX];
    for (uint32_t i = 0; i < chain->count; i++) {
        const parts_t a = seen_from_femur(&chain->element[i], tibia, base);
        turned_tibia[i] = a.tibia;
        const brace_vec_t v = {a.femur.x + a.tibia.x + a.base.x, a.femur.z + a.tibia.z + a.base.z};
        trace += vec_dot(v, v);
        dev.x += vec_dot(v, (brace_vec_t){v.x, -v.z});
        dev.z += 2.0f * v.x * v.z;
        for (uint32_t j = 0; j < i; j++) {
            const brace_element_t *other = &chain->element[j];
            parts_t b = {other->femur, turned_tibia[j], {0.0f, 0.0f}};
            float cross = cross_parts(&b, &a);
            if (other->base.x != 0.0f || other->base.z != 0.0f) {
                b.base = brace_turned(other->base, base);
                cross += cross_base(&b, &a);
            }
            squares = __builtin_fmaf(cross, cross, squares);
        }
    }
    const float iso = chain->iso_mm_per_n;
    dev = brace_turned(dev, to_world);
    return (brace_tensor_t){iso + 0.5f * trace, 0.5f * dev.x, 0.5f * dev.z, iso * (iso + trace) + squares};
}

/* The tensor at a posture that the general path takes; result is whoever asks's output, not null. */
static brace_status_t tensor_at(const brace_chain_t *chain, float theta1_rad, float theta2_rad,
                                               const void *result, brace_tensor_t *c)
{
    if (chain == NULL || result == NULL) {
        return BRACE_E_NULL;
    }
    const float reach = theta1_rad * theta1_rad + theta2_rad * theta2_rad;
    if (reach <= BRACE_PLANAR_REACH_RAD2) {
        *c = tensor(chain, theta1_rad, theta2_rad);
        return BRACE_OK;
    }
    return reach <= 3.4028234e38f ? BRACE_E_RANGE : BRACE_E_NOT_FINITE;
}

BRACE_OFF_TICK brace_status_t brace_chain_compliance(const brace_chain_t *chain, float theta1_rad, float theta2_rad,
                                      brace_compliance_t *compliance, float *det)
{
    brace_tensor_t c;
    const brace_status_t status = tensor_at(chain, theta1_rad, theta2_rad, compliance, &c);
    if (status == BRACE_OK) {
        *compliance = (brace_compliance_t){c.mean + c.dev_x, c.dev_y, c.mean - c.dev_x};
        if (det != NULL) {
            *det = c.det;
        }
    }
    return status;
}

brace_status_t brace_chain_stiffness(const brace_chain_t *chain, float theta1_rad, float theta2_rad,
                                     brace_stiffness_t *stiffness)
{
    brace_tensor_t c;
    const brace_status_t status = tensor_at(chain, theta1_rad, theta2_rad, stiffness, &c);
    if (status != BRACE_OK) {
        return status;
    }
    return brace_tensor_inverse(c, stiffness);
}
